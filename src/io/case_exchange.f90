!> The one list that ties keys of the schema to components of a case, read in both directions.
module case_exchange
  use kinds, only: dp
  use case_definition, only: case_t
  use case_schema, only: key_t, find_key, find_group
  use case_values, only: case_values_t
  implicit none
  private
  public :: values_to_case, value_to_case, case_to_values

  !> A move of values, to the case or from it.
  type :: exchange_t
    type(case_values_t), pointer :: values => null()
    type(key_t) :: only              !! the one key to move; without a name, all
    logical :: to_case = .true.
  contains
    procedure, private :: move_real, move_reals, move_integer, move_logical, move_word
    generic :: move => move_real, move_reals, move_integer, move_logical, move_word
    procedure :: move_text
    procedure :: move_presence
  end type exchange_t

contains

  subroutine values_to_case(values, into)
    type(case_values_t), intent(in), target :: values
    type(case_t), intent(inout) :: into
    type(exchange_t) :: exchange
    exchange%values => values
    call move_all(exchange, into)
  end subroutine values_to_case

  !> The value of the key at `place` alone, and that its group is present.
  subroutine value_to_case(values, place, into)
    type(case_values_t), intent(in), target :: values
    integer, intent(in) :: place
    type(case_t), intent(inout) :: into
    type(exchange_t) :: exchange
    exchange%values => values
    exchange%only = values%keys(place)
    call move_all(exchange, into)
  end subroutine value_to_case

  subroutine case_to_values(from, values)
    type(case_t), intent(in) :: from
    type(case_values_t), intent(inout), target :: values
    type(exchange_t) :: exchange
    type(case_t) :: copy
    exchange%values => values
    exchange%to_case = .false.
    copy = from
    call move_all(exchange, copy)
  end subroutine case_to_values

  subroutine move_all(exchange, c)
    type(exchange_t), intent(inout) :: exchange
    type(case_t), intent(inout) :: c
    call move_bodies(exchange, c)
    call move_joint(exchange, c)
    call move_film_and_gas(exchange, c)
    call move_run(exchange, c)
  end subroutine move_all

  subroutine move_bodies(x, c)
    type(exchange_t), intent(inout) :: x
    type(case_t), intent(inout) :: c
    call x%move_text('case', 'title', c%title)
    call x%move('mechanism', 'crank_length', c%mechanism%crank_length)
    call x%move('mechanism', 'crank_mass', c%mechanism%crank_mass)
    call x%move('mechanism', 'crank_inertia', c%mechanism%crank_inertia)
    call x%move('mechanism', 'crank_com', c%mechanism%crank_com)
    call x%move('mechanism', 'rod_length', c%mechanism%rod_length)
    call x%move('mechanism', 'rod_mass', c%mechanism%rod_mass)
    call x%move('mechanism', 'rod_inertia', c%mechanism%rod_inertia)
    call x%move('mechanism', 'rod_com', c%mechanism%rod_com)
    call x%move('mechanism', 'piston_mass', c%mechanism%piston_mass)
    call x%move('mechanism', 'gravity', c%mechanism%gravity)
    call x%move('drive', 'kind', c%drive%kind)
    call x%move('drive', 'torque', c%drive%torque)
    call x%move('drive', 'damping', c%drive%damping)
    call x%move('initial', 'crank_angle_deg', c%initial%crank_angle_deg)
    call x%move('initial', 'crank_speed', c%initial%crank_speed)
    call x%move('initial', 'eccentricity', c%initial%eccentricity)
    call x%move('initial', 'eccentricity_rate', c%initial%eccentricity_rate)
  end subroutine move_bodies

  subroutine move_joint(x, c)
    type(exchange_t), intent(inout) :: x
    type(case_t), intent(inout) :: c
    call x%move('joint', 'kind', c%joint%kind)
    call x%move('joint', 'clearance', c%joint%clearance)
    call x%move('joint', 'bearing_radius', c%joint%bearing_radius)
    call x%move('joint', 'bearing_length', c%joint%bearing_length)
    call x%move_presence('contact', c%contact%is_present)
    call x%move('contact', 'law', c%contact%law)
    call x%move('contact', 'restitution', c%contact%restitution)
    call x%move('contact', 'exponent', c%contact%exponent)
    call x%move('contact', 'youngs_modulus', c%contact%youngs_modulus)
    call x%move('contact', 'poissons_ratio', c%contact%poissons_ratio)
    call x%move('contact', 'density', c%contact%density)
    call x%move('contact', 'stiffness', c%contact%stiffness)
    call x%move('contact', 'least_impact_speed', c%contact%least_impact_speed)
    call x%move_presence('friction', c%friction%is_present)
    call x%move('friction', 'law', c%friction%law)
    call x%move('friction', 'coefficient', c%friction%coefficient)
    call x%move('friction', 'v0', c%friction%v0)
    call x%move('friction', 'v1', c%friction%v1)
  end subroutine move_joint

  subroutine move_film_and_gas(x, c)
    type(exchange_t), intent(inout) :: x
    type(case_t), intent(inout) :: c
    call x%move_presence('lubrication', c%lubrication%is_present)
    call x%move('lubrication', 'law', c%lubrication%law)
    call x%move('lubrication', 'variant', c%lubrication%variant)
    call x%move('lubrication', 'viscosity', c%lubrication%viscosity)
    call x%move('lubrication', 'kinematic_viscosity', c%lubrication%kinematic_viscosity)
    call x%move('lubrication', 'quadrature_points', c%lubrication%quadrature_points)
    call x%move('lubrication', 'least_film_ratio', c%lubrication%least_film_ratio)
    call x%move_presence('combustion', c%combustion%is_present)
    call x%move('combustion', 'bore', c%combustion%bore)
    call x%move('combustion', 'compression_ratio', c%combustion%compression_ratio)
    call x%move('combustion', 'heat_capacity_ratio', c%combustion%heat_capacity_ratio)
    call x%move('combustion', 'heat', c%combustion%heat)
    call x%move('combustion', 'wiebe_efficiency', c%combustion%wiebe_efficiency)
    call x%move('combustion', 'wiebe_form', c%combustion%wiebe_form)
    call x%move('combustion', 'start_deg', c%combustion%start_deg)
    call x%move('combustion', 'duration_deg', c%combustion%duration_deg)
    call x%move('combustion', 'intake_pressure', c%combustion%intake_pressure)
    call x%move('combustion', 'crankcase_pressure', c%combustion%crankcase_pressure)
  end subroutine move_film_and_gas

  subroutine move_run(x, c)
    type(exchange_t), intent(inout) :: x
    type(case_t), intent(inout) :: c
    call x%move('integrator', 'method', c%integrator%method)
    call x%move('integrator', 'revolutions', c%integrator%revolutions)
    call x%move('integrator', 'end_time', c%integrator%end_time)
    call x%move('integrator', 'relative_tolerance', c%integrator%relative_tolerance)
    call x%move('integrator', 'absolute_tolerance', c%integrator%absolute_tolerance)
    call x%move('integrator', 'max_step', c%integrator%max_step)
    call x%move('integrator', 'max_order', c%integrator%max_order)
    call x%move('integrator', 'contact_entry', c%integrator%contact_entry)
    call x%move('integrator', 'max_penetration', c%integrator%max_penetration)
    call x%move('integrator', 'max_steps', c%integrator%max_steps)
    call x%move('integrator', 'max_evaluations', c%integrator%max_evaluations)
    call x%move('integrator', 'max_evaluations_per_revolution', c%integrator%max_evaluations_per_revolution)
    call x%move('output', 'samples_per_revolution', c%output%samples_per_revolution)
    call x%move('output', 'interval', c%output%interval)
    call x%move('output', 'start_time', c%output%start_time)
    call x%move_text('output', 'columns', c%output%columns)
    call x%move('output', 'digits', c%output%digits)
    call x%move('output', 'every_step', c%output%every_step)
    call x%move('output', 'ideal_twin', c%output%ideal_twin)
  end subroutine move_run

  !> Whether a key is not to be moved.
  pure logical function is_left_out(self, group, name)
    class(exchange_t), intent(in) :: self
    character(len=*), intent(in) :: group, name
    is_left_out = .false.
    if (self%only%name == '') return
    is_left_out = name(1:1) /= self%only%name(1:1)   ! most differ here, and this comparison is cheap
    if (.not. is_left_out) is_left_out = name /= self%only%name .or. group /= self%only%group
  end function is_left_out

  subroutine move_real(self, group, name, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    real(dp), intent(inout) :: component
    if (is_left_out(self, group, name)) return
    associate (value => self%values%values(find_key(self%values%keys, group, name)))
      if (self%to_case) component = value%reals(1)
      if (.not. self%to_case) value%reals(1) = component
    end associate
  end subroutine move_real

  subroutine move_reals(self, group, name, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    real(dp), intent(inout) :: component(:)
    if (is_left_out(self, group, name)) return
    associate (value => self%values%values(find_key(self%values%keys, group, name)))
      if (self%to_case) component = value%reals(:size(component))
      if (.not. self%to_case) value%reals(:size(component)) = component
    end associate
  end subroutine move_reals

  subroutine move_integer(self, group, name, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    integer, intent(inout) :: component
    if (is_left_out(self, group, name)) return
    associate (value => self%values%values(find_key(self%values%keys, group, name)))
      if (self%to_case) component = value%whole
      if (.not. self%to_case) value%whole = component
    end associate
  end subroutine move_integer

  subroutine move_logical(self, group, name, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    logical, intent(inout) :: component
    if (is_left_out(self, group, name)) return
    associate (value => self%values%values(find_key(self%values%keys, group, name)))
      if (self%to_case) component = value%switch
      if (.not. self%to_case) value%switch = component
    end associate
  end subroutine move_logical

  subroutine move_word(self, group, name, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    character(len=*), intent(inout) :: component
    if (is_left_out(self, group, name)) return
    associate (value => self%values%values(find_key(self%values%keys, group, name)))
      if (self%to_case) component = value%text
      if (.not. self%to_case) value%text = trim(component)
    end associate
  end subroutine move_word

  !> A text not yet allocated in the case counts as its default.
  subroutine move_text(self, group, name, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    character(len=:), allocatable, intent(inout) :: component
    if (is_left_out(self, group, name)) return
    associate (value => self%values%values(find_key(self%values%keys, group, name)))
      if (self%to_case) component = value%text
      if (.not. self%to_case .and. allocated(component)) value%text = component
    end associate
  end subroutine move_text

  !> Whether the group of a model is there.
  subroutine move_presence(self, group, component)
    class(exchange_t), intent(inout) :: self
    character(len=*), intent(in) :: group
    logical, intent(inout) :: component
    integer :: place
    if (self%only%name /= '' .and. group /= self%only%group) return
    place = find_group(self%values%groups, group)
    if (self%to_case) component = self%values%is_present(place)
    if (.not. self%to_case) self%values%is_present(place) = component
  end subroutine move_presence
end module case_exchange
