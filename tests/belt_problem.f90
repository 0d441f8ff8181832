!> Stick-slip: a mass on a dry floor, pulled by a spring whose other end moves at constant speed. The friction law is one of the
!> program; for set-valued laws, sticking and slipping are determined by the procedures of a joint.
module belt_problem
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, event_continue
  use friction_law, only: friction_law_t
  use dry_contact, only: dry_contact_t
  use joint_evaluation, only: joint_evaluation_t, joint_rates_t
  use joint_events, only: sliding_event, choose_sliding
  implicit none
  private
  public :: belt_t, new_belt, mass, spring, draw_speed, load

  real(dp), parameter :: mass = 1            !! [kg]
  real(dp), parameter :: spring = 2          !! stiffness of the spring [N/m]
  real(dp), parameter :: draw_speed = 0.1_dp !! speed of the spring's end [m/s]
  real(dp), parameter :: load = 10           !! normal force of the mass on the floor [N]

  !> y = (x, x', deflection of the bristles of a law that has them, work of friction).
  type, extends(ode_problem_t) :: belt_t
    type(dry_contact_t) :: contact       !! friction law, and whether the mass sticks
    integer :: n_changes = 0
    real(dp) :: change(100) = 0          !! times at which the mass began to slip or to stick [s]
  contains
    procedure :: derivatives
    procedure :: events
    procedure :: handle_event
  end type belt_t

contains

  !> The mass at rest, with the spring unloaded.
  subroutine new_belt(law, belt)
    class(friction_law_t), intent(in) :: law
    type(belt_t), intent(out) :: belt
    allocate (belt%contact%friction, source=law)
    belt%contact%holding_ratio = law%holding_ratio()
    belt%n = 3 + law%n_states
    belt%n_positions = 1
    belt%n_quadratures = 1
    belt%n_events = merge(1, 0, law%set_valued)
    belt%refuses_steps = .false.
  end subroutine new_belt

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(belt_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    real(dp) :: friction, ratio
    in_domain = .true.
    friction = -pull(t, y)
    associate (law => self%contact%friction)
      if (law%n_states > 0) then
        call law%state_friction(y(2), y(3:2 + law%n_states), ratio, dydt(3:2 + law%n_states))
        friction = load*ratio
      else if (.not. sticks(self)) then
        friction = load*law%friction_ratio(y(2), self%contact%sliding)
      end if
    end associate
    dydt(1) = y(2)
    dydt(2) = (pull(t, y) + friction)/mass
    dydt(self%n) = friction*y(2)
  end subroutine derivatives

  !> Force of the spring [N].
  pure real(dp) function pull(t, y)
    real(dp), intent(in) :: t, y(:)
    pull = spring*(draw_speed*t - y(1))
  end function pull

  pure logical function sticks(self)
    class(belt_t), intent(in) :: self
    sticks = self%contact%friction%set_valued .and. self%contact%sliding == 0
  end function sticks

  !> The data that the procedures of a joint need about the mass: it slides along y on a wall normal to x.
  pure subroutine see_as_joint(self, t, y, now, rates)
    class(belt_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    type(joint_evaluation_t), intent(out) :: now
    type(joint_rates_t), intent(out) :: rates
    real(dp) :: dydt(self%n)
    logical :: in_domain
    call self%derivatives(t, y, dydt, in_domain)
    now%normal = [1.0_dp, 0.0_dp]
    now%distance = 1
    now%penetration_rate = 0
    now%tangential_rate = y(2)
    now%bearing_speed = 0
    now%sliding_speed = y(2)
    now%normal_force = load
    now%friction_force = -pull(t, y)
    rates = joint_rates_t([0.0_dp, dydt(2)], 0.0_dp, 0.0_dp)
  end subroutine see_as_joint

  pure subroutine events(self, t, y, g, g_rate)
    class(belt_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    type(joint_evaluation_t) :: now
    type(joint_rates_t) :: rates
    if (self%n_events == 0) return
    call see_as_joint(self, t, y, now, rates)
    call sliding_event(self%contact, now, rates, g(1), g_rate(1))
  end subroutine events

  subroutine handle_event(self, index, t, y, action)
    class(belt_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    type(joint_evaluation_t) :: now
    type(joint_rates_t) :: rates
    logical :: was_sliding
    was_sliding = self%contact%sliding /= 0
    self%contact%sliding = 0
    call see_as_joint(self, t, y, now, rates)
    call choose_sliding(self%contact, now, was_sliding, .false.)
    self%n_changes = self%n_changes + index
    self%change(self%n_changes) = t
    action = event_continue
  end subroutine handle_event
end module belt_problem
