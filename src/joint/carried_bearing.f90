!> A bearing of kind quasi_static: a film carries the load of a pin without inertia (Booker 1965).
!>
!> The mechanism does not feel the bearing. The position of the pin, or with elastic walls that of the film, is two first-order
!> states, whose rate is the velocity with which the film carries the load: e' = v*(e, W) + (omega/2) z x e.
module carried_bearing
  use kinds, only: dp
  use state_layout, only: layout_t, slice_t
  use run_state, only: run_state_t
  use joint_places, only: name_prefix, pin_title
  use clearance_joint, only: clearance_joint_t, phase_film
  use load_element, only: power_of
  use joint_evaluation, only: joint_evaluation_t, clear_loads, find_polar, find_sliding
  implicit none
  private
  public :: carried_bearing_t

  real(dp), parameter :: fastest = 1e30_dp   !! velocity of the pin, whose square is still finite [m/s]

  type :: carried_bearing_t
    integer :: joint = 0        !! index of its joint in the scene, which has one element, a film
    real(dp) :: load_share = 1  !! part of the load of its place that it carries
    type(slice_t) :: place      !! indices of the position in the state
  contains
    procedure :: claim
    procedure :: set_start
    procedure :: declare
    procedure :: look
  end type carried_bearing_t

contains

  !> Claim the position in the state vector; its natural size is the clearance.
  subroutine claim(self, layout, joint)
    class(carried_bearing_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    type(clearance_joint_t), intent(inout) :: joint
    call layout%claim_states(2, joint%bearing%clearance, self%place)
    joint%at%position = self%place%first
    if (joint%slots(1)%element%n_states > 0) joint%slots(1)%element%states = self%place
    if (allocated(joint%heat)) call joint%heat%claim(layout)
  end subroutine claim

  !> Set the initial position in the state vector.
  pure subroutine set_start(self, joint, y)
    class(carried_bearing_t), intent(in) :: self
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(inout) :: y(:)
    y(self%place%first:self%place%last) = joint%start_eccentricity
    if (allocated(joint%heat)) y(joint%heat%at%first) = joint%heat%start
  end subroutine set_start

  !> Declare the position. In a bearing of another clearance it keeps its ratio to that.
  subroutine declare(self, list, joint, y)
    class(carried_bearing_t), intent(in) :: self
    type(run_state_t), intent(inout) :: list
    type(clearance_joint_t), intent(inout) :: joint
    real(dp), intent(inout) :: y(:)
    character(len=:), allocatable :: pre
    real(dp) :: clearance
    pre = name_prefix(joint%spot)
    clearance = joint%bearing%clearance
    call list%add(pre//'clearance', clearance, 'm', 'clearance of this position')
    call list%add(pre//'carried_eccentricity', y(self%place%first:self%place%last), 'm', &
      'centre of the '//pin_title(joint%spot)//' from the centre of its bearing, where a film carries it (x, y)')
    if (allocated(joint%heat)) call joint%heat%declare(pre, list, y)
    if (list%sets .and. abs(clearance - joint%bearing%clearance) > 0) &
      y(self%place%first:self%place%last) = y(self%place%first:self%place%last)*(joint%bearing%clearance/clearance)
  end subroutine declare

  !> Motion and loads of the bearing under a load (force of the pin on its bearing); the rate of the position is that of the
  !> eccentricity. `in_domain` is false at the wall, where the film is not defined, for temperatures out of range, and where the
  !> velocity or the moment is beyond all bounds (deep in the roughness, or under an infinite load); then only the position is set.
  pure subroutine look(self, joint, load, speeds, y, now, in_domain)
    class(carried_bearing_t), intent(in) :: self
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: load(2)     !! [N]
    real(dp), intent(in) :: speeds(2)   !! angular speeds of pin and bearing [rad/s]
    real(dp), intent(in) :: y(*)        !! the whole state vector
    type(joint_evaluation_t), intent(inout) :: now
    logical, intent(out) :: in_domain
    call clear_loads(now)
    now%touches = .false.
    now%impact_speed = 0
    now%pin_angular_speed = speeds(1)
    now%bearing_speed = speeds(2)
    now%eccentricity_rate = 0
    if (allocated(joint%heat)) call joint%read_temperature(y, now)
    associate (place => y(self%place%first:self%place%last))
      now%eccentricity = place
      in_domain = sum(place**2) < joint%reach(phase_film)**2
      if (joint%limits_states) in_domain = sum(place**2) < joint%bearing%clearance**2
      in_domain = in_domain .and. joint%admits_temperature(now)
      if (in_domain) call joint%slots(1)%element%carry(place, load, now)
      in_domain = in_domain .and. all(abs(now%eccentricity_rate) <= fastest) .and. abs(now%moment) <= huge(now%moment)
      if (.not. in_domain) call clear_loads(now)
      now%power = power_of(now, now%force, now%eccentricity_rate, now%moment)
      call find_polar(joint%bearing%clearance, now)
      call find_sliding(joint%pin_radius, now)
      if (.not. joint%has_own_gap) return
      now%penetration = norm2(place) - joint%bearing%clearance
      now%penetration_rate = dot_product(place, now%eccentricity_rate)/max(norm2(place), tiny(1.0_dp))
    end associate
  end subroutine look
end module carried_bearing
