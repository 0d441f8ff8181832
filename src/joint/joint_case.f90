!> A joint as a case describes it: its kind and its bearing, and the laws that act in it. An ideal joint has no laws.
!>
!> The list of its groups is in the submodule `joint_groups`, so that a change of a law does not require the modules that use a case
!> to be compiled again.
module joint_case
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t, law_t
  use bearing_size, only: bearing_t
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  use film_law, only: film_law_t
  use film_transition, only: film_transition_t
  use oil_viscosity, only: oil_t
  use asperities, only: asperities_t
  use archard_wear, only: wear_law_t
  use history_case, only: history_case_t
  use film_history, only: film_history_t
  use film_heat, only: heat_case_t
  implicit none
  private
  public :: joint_case_t, visit_joint, drop_laws, select_contact, select_friction

  !> Elastic walls in series with the film: see `elastic_film`.
  type, extends(has_parameters_t) :: elastic_walls_t
    logical :: is_wanted = .false.
    real(dp) :: pressure_viscosity = 0     !! alpha [1/Pa]
  contains
    procedure :: parameters => wall_parameters
  end type elastic_walls_t

  type, extends(has_parameters_t) :: joint_case_t
    character(len=:), allocatable :: kind
    real(dp) :: clearance = 0, bearing_radius = 0, bearing_length = 0
    character(len=:), allocatable :: numbers   !! of the bearings of several cylinders: 'all', or with commas; empty: none
    real(dp) :: load_share = 1             !! of the load of the place, carried by a bearing of kind quasi_static
    class(contact_law_t), allocatable :: contact
    class(friction_law_t), allocatable :: friction
    logical :: reports_friction_work = .false.
    class(film_law_t), allocatable :: film
    type(film_transition_t) :: transition
    logical :: reports_film = .false.
    type(oil_t) :: oil
    type(elastic_walls_t) :: elastic
    type(asperities_t), allocatable :: asperities
    type(wear_law_t), allocatable :: wear
    real(dp) :: ambient_over_cavitation = 0   !! [Pa]
    type(history_case_t) :: history           !! the film with memory that is marched after the run
    type(heat_case_t), allocatable :: heat
  contains
    procedure :: parameters => joint_parameters
    procedure :: has_clearance
    procedure :: is_carried
    procedure :: has_bearing
    procedure :: can_touch
    procedure :: wants_number
    procedure :: has_elastic_film
    procedure :: has_weighted_film
    procedure :: has_worn_bore
    procedure :: is_too_short_for_its_film
    procedure :: make_film
    procedure :: make_history
    procedure :: bearing => bearing_of
  end type joint_case_t

  interface
    !> Declare the groups of a joint and of its laws to a visitor. If another joint has a bearing, the laws of an ideal joint are
    !> not set.
    module subroutine visit_joint(joint, place, another_has_bearing, list)
      type(joint_case_t), intent(inout) :: joint
      character(len=*), intent(in) :: place
      logical, intent(in) :: another_has_bearing
      class(parameter_list_t), intent(inout) :: list
    end subroutine visit_joint
  end interface

contains

  !> Whether a contact law acts in the joint. It does not where the contact is with the walls of an elastic film.
  elemental logical function can_touch(self)
    class(joint_case_t), intent(in) :: self
    can_touch = allocated(self%contact) .and. .not. self%has_elastic_film()
  end function can_touch

  !> Whether the bearing of a number is wanted: all are, unless numbers are given.
  pure logical function wants_number(self, number)
    class(joint_case_t), intent(in) :: self
    integer, intent(in) :: number
    integer, parameter :: largest = 10**6   ! no number of a bearing
    integer :: i, found
    wants_number = self%numbers == '' .or. self%numbers == 'all'
    found = 0
    do i = 1, len(self%numbers)
      if (self%numbers(i:i) == ',') then
        wants_number = wants_number .or. found == number
        found = 0
      else if (self%numbers(i:i) /= ' ') then
        found = min(largest, 10*found + index('123456789', self%numbers(i:i)))
      end if
    end do
    wants_number = wants_number .or. found == number
  end function wants_number

  !> Whether the joint has a film between elastic walls.
  elemental logical function has_elastic_film(self)
    class(joint_case_t), intent(in) :: self
    has_elastic_film = allocated(self%contact) .and. allocated(self%film) .and. self%elastic%is_wanted
  end function has_elastic_film

  !> Whether film and contact share the load over a range of penetrations.
  pure logical function has_weighted_film(self)
    class(joint_case_t), intent(in) :: self
    has_weighted_film = allocated(self%film) .and. self%can_touch() .and. self%transition%is_weighted()
  end function has_weighted_film

  !> Whether the worn shape of the bore acts in the contact.
  pure logical function has_worn_bore(self)
    class(joint_case_t), intent(in) :: self
    has_worn_bore = .false.
    if (allocated(self%wear)) has_worn_bore = self%wear%bore == 'worn'
  end function has_worn_bore

  !> Whether the film is that of a long bearing in a bearing that is not: its length is below twice its diameter.
  pure logical function is_too_short_for_its_film(self) result(is_so)
    class(joint_case_t), intent(in) :: self
    is_so = .false.
    if (allocated(self%film)) is_so = self%film%is_of_long_bearings() .and. self%bearing_length < 4*self%bearing_radius
  end function is_too_short_for_its_film

  !> The law of the film with the viscosity of its oil.
  subroutine make_film(self, film)
    class(joint_case_t), intent(in) :: self
    class(film_law_t), allocatable, intent(out) :: film
    allocate (film, source=self%film)
    film%thinning_ratio = self%oil%thinning_ratio
    film%thinning_speed = self%oil%thinning_rate*self%clearance/(self%bearing_radius - self%clearance)
    if (.not. self%oil%is_known()) return
    film%viscosity = self%oil%dynamic_viscosity()
    film%kinematic_viscosity = self%oil%kinematic_viscosity()
  end subroutine make_film

  !> The film with memory of the joint, which is marched after the run.
  subroutine make_history(self, history)
    class(joint_case_t), intent(in) :: self
    type(film_history_t), intent(out) :: history
    class(film_law_t), allocatable :: film
    call self%make_film(film)
    call self%history%make(self%bearing(rod_length=0.0_dp), film%viscosity, self%elastic%pressure_viscosity, &
      self%ambient_over_cavitation, film%conserves_oil(), history)
  end subroutine make_history

  !> Whether the pin has clearance in its bearing and its position is one of the mechanism's.
  elemental logical function has_clearance(self)
    class(joint_case_t), intent(in) :: self
    has_clearance = .false.
    if (allocated(self%kind)) has_clearance = self%kind == 'clearance'
  end function has_clearance

  !> Whether a film carries the load of the pin at every instant, while the pin stays ideal in the mechanism.
  elemental logical function is_carried(self)
    class(joint_case_t), intent(in) :: self
    is_carried = .false.
    if (allocated(self%kind)) is_carried = self%kind == 'quasi_static'
  end function is_carried

  !> Whether the joint has a bearing, with clearance: it is not ideal.
  elemental logical function has_bearing(self)
    class(joint_case_t), intent(in) :: self
    has_bearing = self%has_clearance() .or. self%is_carried()
  end function has_bearing

  !> The bearing of the joint; `rod_length` [m] is the length of the rod that carries its pin.
  pure type(bearing_t) function bearing_of(self, rod_length)
    class(joint_case_t), intent(in) :: self
    real(dp), intent(in) :: rod_length
    bearing_of = bearing_t(self%bearing_radius, self%bearing_length, self%clearance, rod_length)
  end function bearing_of

  subroutine joint_parameters(self, list)
    class(joint_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, 'ideal, clearance, quasi_static', 'ideal', 'ideal: no clearance; quasi_static: an '// &
      'ideal pin in the mechanism, whose load the film of its bearing carries at every instant', example='clearance')
    call list%add('clearance', self%clearance, 'radial clearance: bearing radius minus pin radius', 'm', '> 0', default='0.0', &
      example='2.0e-5', usual='1e-6 to 1e-3')
    call list%add('bearing_radius', self%bearing_radius, 'radius of the bearing', 'm', '> 0', default='0.0', example='0.010', &
      usual='5e-4 to 1')
    call list%add('bearing_length', self%bearing_length, &
      'width of the bearing; needed with a film and with contact geometries other than hertz_sphere', &
      'm', '> 0', default='0.0', example='0.015', usual='5e-4 to 1')
    call list%text('numbers', self%numbers, 'with &cylinder and quasi_static: which main bearings along the shaft (default: '// &
      'all), or the big ends of which cylinders (default: that of the full one alone): ''all'', or numbers with commas', '')
    call list%add('load_share', self%load_share, &
      'part of the load that this bearing carries, of main_bearing alone: 0.5 for two equal main bearings', &
      range='> 0 and <= 1', default='1.0', usual='0.05 to 1')
  end subroutine joint_parameters

  subroutine wall_parameters(self, list)
    class(elastic_walls_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('elastic_film', self%is_wanted, &
      'elastic walls in series with the film; &contact with law = ''hertz'' gives their stiffness', '.false.')
    call list%add('pressure_viscosity', self%pressure_viscosity, &
      'exponential growth of the viscosity with the pressure (Barus), in an elastic_film and in &film_history', &
      '1/Pa', '>= 0 and <= 1e-6', default='0.0', usual='1e-9 to 1e-7')
  end subroutine wall_parameters

  !> Remove laws that were given for all joints from an ideal joint.
  subroutine drop_laws(joint)
    type(joint_case_t), intent(inout) :: joint
    if (joint%has_bearing()) return
    if (allocated(joint%contact)) deallocate (joint%contact)
    if (allocated(joint%friction)) deallocate (joint%friction)
    if (allocated(joint%film)) deallocate (joint%film)
    if (allocated(joint%asperities)) deallocate (joint%asperities)
    if (allocated(joint%wear)) deallocate (joint%wear)
    joint%history = history_case_t()
    if (allocated(joint%heat)) deallocate (joint%heat)
  end subroutine drop_laws

  !> Select the contact law that a case names, if it names one.
  subroutine select_contact(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(contact_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (contact_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine select_contact

  !> Select the friction law that a case names, if it names one.
  subroutine select_friction(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(friction_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (friction_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine select_friction
end module joint_case
