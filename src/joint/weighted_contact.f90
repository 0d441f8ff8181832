!> Load element: contact and film that share the load over a range of penetrations. It acts with and without contact.
module weighted_contact
  use kinds, only: dp
  use trace_row, only: trace_row_t
  use friction_law, only: most_friction_states
  use film_law, only: film_motion_t
  use film_transition, only: film_transition_t
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, most_element_states
  use load_element, only: n_slopes, by_pin_speed
  use film_figures, only: add_film_force, add_film_figures
  use dry_contact, only: dry_contact_t
  use oil_film, only: film_motion_of, add_bearing_speed
  implicit none
  private
  public :: weighted_contact_t

  type, extends(dry_contact_t) :: weighted_contact_t
    type(film_transition_t) :: transition
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: normal_force
    procedure :: find_slopes
    procedure :: add_columns
    procedure :: see_film
  end type weighted_contact_t

  integer, parameter :: held = 1, gone = 2   !! the kinks: beyond them the film is held, or does not act

contains

  subroutine prepare(self, wanted, tolerance, makes_tables)
    class(weighted_contact_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    call self%dry_contact_t%prepare(wanted, tolerance, makes_tables)
    call self%prepare_film(wanted, tolerance, makes_tables)
    self%transition = wanted%transition
    call self%transition%prepare(self%bearing, self%film%least_film_ratio)
    self%has_slopes = self%has_slopes .and. .not. self%film%thinning_ratio < 1
    self%kinks = [self%transition%film_reach, self%transition%contact_reach]
  end subroutine prepare

  !> The contact, computed as if there were no film, and the film, weighted with their shares of the load.
  pure subroutine find_loads(self, y, joint)
    class(weighted_contact_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp) :: w, force(2), moment
    if (.not. joint%touches) then
      joint%rates = 0
      call self%film%loads(held_motion(self, joint), joint%viscosity_ratio, joint%film, joint%moment)
      joint%force = joint%film
      return
    end if
    call self%dry_contact_t%find_loads(y, joint)
    joint%film = 0
    if (.not. self%is_beyond(gone)) then
      w = contact_weight(self, joint)
      call self%film%loads(held_motion(self, joint), joint%viscosity_ratio, force, moment)
      joint%film = (1 - w)*force
      joint%contact = w*joint%contact
      joint%moment = w*joint%moment + (1 - w)*moment
      joint%normal_force = w*joint%normal_force
      joint%friction_force = w*joint%friction_force
    end if
    joint%force = joint%film + joint%contact
  end subroutine find_loads

  !> The motion on which the film depends, held where its force would grow without bound.
  pure type(film_motion_t) function held_motion(self, joint)
    type(weighted_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    held_motion = self%transition%held_motion(film_motion_of(self%film, joint), self%is_beyond(held))
  end function held_motion

  !> Share of the contact in the load.
  pure real(dp) function contact_weight(self, joint) result(w)
    type(weighted_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    w = 0
    if (joint%touches) call self%transition%weight(joint%penetration, self%is_beyond(gone), w)
  end function contact_weight

  pure real(dp) function normal_force(self, joint)
    class(weighted_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    normal_force = self%dry_contact_t%normal_force(joint)*contact_weight(self, joint)
  end function normal_force

  !> The slopes of the loads of contact and film, weighted, and those of the weights.
  pure subroutine find_slopes(self, joint, of_loads, of_rates)
    class(weighted_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes)
    type(joint_evaluation_t) :: dry
    real(dp) :: w, slope, of_film(3, n_slopes), change(3), force(2), moment, ratio
    real(dp) :: unused(1 + most_friction_states, 1 + most_friction_states)
    integer :: i
    of_film = 0
    of_rates = 0
    call self%transition%film_derivatives(self%film, film_motion_of(self%film, joint), self%is_beyond(held), &
      of_film(:, :by_pin_speed))
    call add_bearing_speed(self%film, held_motion(self, joint), of_film)
    of_film = joint%viscosity_ratio*of_film
    of_loads = of_film
    if (.not. joint%touches) return
    dry = joint
    dry%normal_force = self%dry_contact_t%normal_force(joint)
    call self%find_friction_slopes(joint, ratio, unused)
    dry%friction_force = ratio*dry%normal_force
    call self%dry_contact_t%find_slopes(dry, of_loads, of_rates)
    if (self%is_beyond(gone)) return
    call self%transition%weight(joint%penetration, .false., w, slope)
    call self%film%loads(held_motion(self, joint), joint%viscosity_ratio, force, moment)
    associate (n => joint%normal, pressing => dry%normal_force, friction => dry%friction_force)
      change = [-pressing*n(1) - friction*n(2), friction*n(1) - pressing*n(2), friction*self%pin_radius] - [force, moment]
      of_loads = w*of_loads + (1 - w)*of_film
      do i = 1, 2
        of_loads(:, i) = of_loads(:, i) + slope*n(i)*change
      end do
    end associate
  end subroutine find_slopes

  pure subroutine add_columns(self, joint, row)
    class(weighted_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    call self%dry_contact_t%add_columns(joint, row)
    call add_film_force(joint, row)
    call row%add('contact_weight[-]', contact_weight(self, joint), &
      'share of the contact in the load of a weighted transition: 0 film alone, 1 contact alone')
    call add_film_figures(self, joint, row)
  end subroutine add_columns

  pure subroutine see_film(self, joint, seen, rate, share, thickening)
    class(weighted_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: rate(2), share, thickening
    seen = held_motion(self, joint)
    rate = joint%eccentricity_rate
    share = 1 - contact_weight(self, joint)
    if (joint%touches .and. self%is_beyond(gone)) share = 0
    thickening = joint%viscosity_ratio*self%film%thinning(seen)
  end subroutine see_film
end module weighted_contact
