!> The impact of a free mass under a contact law as a problem for the program's integrators, from the beginning to the end of the
!> contact.
module impact_problem
  use kinds, only: dp
  use error_handling, only: error_t
  use ode_problem, only: ode_problem_t, event_continue, event_stop
  use ode_method, only: ode_method_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, silent_observer_t, integration_stopped
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: impact_t, run_impact

  !> The result of an impact.
  type :: impact_t
    real(dp) :: restitution = -1   !! speed after over speed before; -1: the mass did not leave the wall
    real(dp) :: depth = 0          !! deepest penetration [m]
    real(dp) :: duration = 0       !! [s]
  end type impact_t

  !> y = (penetration, its rate).
  type, extends(ode_problem_t) :: impact_problem_t
    class(contact_law_t), allocatable :: law
    real(dp) :: mass = 1, speed = 1, depth = 0
  contains
    procedure :: derivatives
    procedure :: events
    procedure :: handle_event
    procedure :: next_kink_time
  end type impact_problem_t

contains

  !> The impact of a mass [kg] at a speed [m/s], by a method at a relative tolerance. `duration` is its approximate duration [s].
  function run_impact(law, mass, speed, duration, method_name, tolerance) result(impact)
    class(contact_law_t), intent(in) :: law
    real(dp), intent(in) :: mass, speed, duration, tolerance
    character(len=*), intent(in) :: method_name
    type(impact_t) :: impact
    type(impact_problem_t) :: problem
    class(ode_method_t), allocatable :: method
    type(silent_observer_t) :: observer
    type(error_t), allocatable :: error
    real(dp) :: t, y(2)
    integer :: status
    allocate (problem%law, source=law)
    problem%mass = mass
    problem%speed = speed
    problem%n = 2
    problem%n_positions = 1
    problem%n_events = 2
    problem%refuses_steps = .false.
    problem%smooth_in_root = .true.
    call new_method(method_name, method, error)
    method%settings%tolerance = tolerance
    method%settings%relative = [0.0_dp, 0.0_dp]
    method%settings%absolute = tolerance*[speed*duration, speed]
    method%settings%span = 100*duration
    method%settings%first_step = 0.01_dp*duration
    t = 0
    y = [0.0_dp, speed]
    call integrate(problem, method, t, y, 100*duration, 0, observer, status)
    if (status /= integration_stopped) return
    impact = impact_t(-y(2)/speed, problem%depth, t)
  end function run_impact

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(impact_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    in_domain = .true.
    dydt(1) = y(2)
    dydt(2) = -self%law%normal_force(y(1), y(2), self%speed)/self%mass
  end subroutine derivatives

  !> Events: the mass reverses its motion; the mass leaves the wall.
  pure subroutine events(self, t, y, g, g_rate)
    class(impact_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = [-y(2), -y(1)]
    g_rate = [self%law%normal_force(y(1), y(2), self%speed)/self%mass, -y(2)]
  end subroutine events

  subroutine handle_event(self, index, t, y, action)
    class(impact_problem_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    action = merge(event_continue, event_stop, index == 1)
    if (index == 1) self%depth = y(1)
    if (index == 1) self%smooth_in_root = .false.
  end subroutine handle_event

  !> The end of the contact, where the force varies like a power of the penetration.
  pure real(dp) function next_kink_time(self, t, y)
    class(impact_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    next_kink_time = huge(next_kink_time)
    if (y(2) < 0) next_kink_time = t - y(1)/y(2)
  end function next_kink_time
end module impact_problem
