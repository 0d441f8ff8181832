!> Load element: a film between rough surfaces in parallel with the contact of their asperities, at every eccentricity.
module rough_film
  use kinds, only: dp
  use trace_row, only: trace_row_t, mean
  use asperities, only: asperities_t
  use film_law, only: film_motion_t
  use mixed_film, only: mixed_forces, mixed_derivatives, mixed_velocity, motion_in_gap
  use contact_arc, only: contact_arc_t
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, most_element_states, find_polar
  use load_element, only: n_slopes, n_motions, of_asperities
  use film_figures, only: add_film_force, add_film_figures
  use dry_contact, only: add_friction_columns
  use oil_film, only: oil_film_t, film_motion_of
  implicit none
  private
  public :: rough_film_t

  type, extends(oil_film_t) :: rough_film_t
    type(asperities_t) :: asperities
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: find_slopes
    procedure :: add_columns
    procedure :: see_film
    procedure :: carry
    procedure :: spread
  end type rough_film_t

contains

  subroutine prepare(self, wanted, tolerance, makes_tables)
    class(rough_film_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    call self%prepare_film(wanted, tolerance, makes_tables)
    self%asperities = wanted%asperities
    call self%asperities%prepare(self%bearing)
    if (makes_tables) call self%asperities%make_table()
    self%is_unbounded = .false.
    self%change_length = self%asperities%roughness
    self%rubs = .true.
    self%normal_kind = of_asperities
    self%friction_kind = of_asperities
  end subroutine prepare

  pure subroutine find_loads(self, y, joint)
    class(rough_film_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    call mixed_forces(self%film, self%asperities, self%pin_radius, film_motion_of(self%film, joint), joint%viscosity_ratio, &
      joint%film, joint%moment, joint%normal_force, joint%friction_force)
    call find_polar(self%bearing%clearance, joint)
    associate (n => joint%normal)
      joint%contact = -joint%normal_force*n + joint%friction_force*[-n(2), n(1)]
    end associate
    joint%moment = joint%moment + joint%friction_force*self%pin_radius
    joint%force = joint%film + joint%contact
  end subroutine find_loads

  pure subroutine carry(self, place, load, joint)
    class(rough_film_t), intent(in) :: self
    real(dp), intent(in) :: place(2), load(2)
    type(joint_evaluation_t), intent(inout) :: joint
    type(film_motion_t) :: motion
    real(dp) :: factor
    joint%eccentricity = place
    joint%eccentricity_rate = 0
    call mixed_velocity(self%film, self%asperities, self%pin_radius, film_motion_of(self%film, joint), joint%viscosity_ratio, &
      load, joint%eccentricity_rate, joint%normal_force, joint%friction_force)
    call find_polar(self%bearing%clearance, joint)
    associate (n => joint%normal)
      joint%contact = -joint%normal_force*n + joint%friction_force*[-n(2), n(1)]
    end associate
    joint%film = -load - joint%contact
    joint%force = -load
    joint%moment = joint%friction_force*self%pin_radius
    if (.not. self%film%film_moment) return
    motion = motion_in_gap(self%film, self%asperities, film_motion_of(self%film, joint))
    factor = joint%viscosity_ratio*self%film%thinning(motion)
    joint%moment = joint%moment + factor*self%film%drag_moment(motion, joint%film/factor)
  end subroutine carry

  pure subroutine find_slopes(self, joint, of_loads, of_rates)
    class(rough_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes)
    of_loads = 0
    of_rates = 0
    call mixed_derivatives(self%film, self%asperities, self%pin_radius, film_motion_of(self%film, joint), joint%viscosity_ratio, &
      of_loads(:, :n_motions))
  end subroutine find_slopes

  pure subroutine add_columns(self, joint, row)
    class(rough_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    call add_film_force(joint, row)
    call row%add('asperity_force[N]', joint%normal_force, &
      'contact force of the asperities along the line of centres, positive where it presses')
    if (self%is_reported) call row%keep('mean_asperity_force', mean, &
      'mean over time of the contact force of the asperities, with `report`', is_sampled=.true.)
    call add_friction_columns(joint, row)
    call add_film_figures(self, joint, row)
  end subroutine add_columns

  pure subroutine see_film(self, joint, seen, rate, share, thickening)
    class(rough_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: rate(2), share, thickening
    call self%oil_film_t%see_film(joint, seen, rate, share, thickening)
    seen = motion_in_gap(self%film, self%asperities, seen)
    thickening = joint%viscosity_ratio*self%film%thinning(seen)
  end subroutine see_film

  pure subroutine spread(self, joint, ratio, width, arc)
    class(rough_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out), optional :: ratio
    real(dp), intent(in), optional :: width
    type(contact_arc_t), intent(inout), optional :: arc
    integer :: i
    if (present(ratio)) ratio = self%asperities%total_pressure(joint%distance)
    if (.not. present(arc)) return
    call arc%divide(self%asperities%half_angle(joint%distance), width)
    do i = 1, arc%n
      arc%loads(i) = arc%loads(i)*self%asperities%pressure(joint%distance, arc%middles(i))
    end do
  end subroutine spread
end module rough_film
