!> Small problems with known solutions for the tests of the integrator.
module test_problems
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, event_continue, step_too_deep
  use ode_method, only: ode_method_t, step_rejected
  implicit none
  private
  public :: whole_step, refusing_t, oscillator_t, two_body_t, bouncing_ball_t, hopper_t, modulated_t, root_t

  !> y'' = -y.
  type, extends(ode_problem_t) :: oscillator_t
  contains
    procedure :: derivatives => oscillator_derivatives
  end type oscillator_t

  !> The same, but every step is refused.
  type, extends(oscillator_t) :: refusing_t
  contains
    procedure :: judge_step => refuse_step
  end type refusing_t

  !> Kepler's problem in the plane (DETEST class D).
  type, extends(ode_problem_t) :: two_body_t
  contains
    procedure :: derivatives => two_body_derivatives
  end type two_body_t

  !> A ball under g = 1 that rebounds from y = 0 with restitution r; `impacts` is the number of impacts.
  type, extends(ode_problem_t) :: bouncing_ball_t
    real(dp) :: restitution = 0.5_dp
    integer :: impacts = 0
    real(dp) :: times(100) = 0
  contains
    procedure :: derivatives => ball_derivatives
    procedure :: events => ball_events
    procedure :: handle_event => ball_rebounds
  end type bouncing_ball_t

  !> A sine that exceeds a level only near its maxima: two crossings are close together inside one step.
  type, extends(oscillator_t) :: hopper_t
    real(dp) :: level = 0.9999_dp
    integer :: passages = 0
    real(dp) :: times(100) = 0
  contains
    procedure :: events => hopper_events
    procedure :: handle_event => hopper_passes
  end type hopper_t

  !> y' = y cos t; or y' = -decay y if `decay` is not 0.
  type, extends(ode_problem_t) :: modulated_t
    real(dp) :: decay = 0
  contains
    procedure :: derivatives => modulated_derivatives
  end type modulated_t

  !> y' = 1.5 sqrt(t - 1) y, y(1) = 1: y = exp((t - 1)^1.5).
  type, extends(ode_problem_t) :: root_t
  contains
    procedure :: derivatives => root_derivatives
  end type root_t

contains

  !> Advance by one step, with as many trials as necessary.
  subroutine whole_step(method, problem, status)
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    do
      call method%step(problem, status)
      if (status /= step_rejected) return
    end do
  end subroutine whole_step

  pure subroutine refuse_step(self, t_old, y_old, t, y, verdict, fraction)
    class(refusing_t), intent(in) :: self
    real(dp), intent(in) :: t_old, y_old(:), t, y(:)
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    verdict = step_too_deep
    fraction = 0.5_dp
  end subroutine refuse_step

  pure subroutine root_derivatives(self, t, y, dydt, in_domain)
    class(root_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    in_domain = t >= 1
    dydt = 0
    if (in_domain) dydt = 1.5_dp*sqrt(t - 1)*y
  end subroutine root_derivatives

  pure subroutine modulated_derivatives(self, t, y, dydt, in_domain)
    class(modulated_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt = y*cos(t)
    if (self%decay > 0) dydt = -self%decay*y
    in_domain = .true.
  end subroutine modulated_derivatives

  pure subroutine oscillator_derivatives(self, t, y, dydt, in_domain)
    class(oscillator_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt(1) = y(2)
    dydt(2) = -y(1)
    in_domain = .true.
  end subroutine oscillator_derivatives

  pure subroutine two_body_derivatives(self, t, y, dydt, in_domain)
    class(two_body_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    real(dp) :: r3
    r3 = norm2(y(1:2))**3
    dydt(1:2) = y(3:4)
    dydt(3:4) = -y(1:2)/r3
    in_domain = .true.
  end subroutine two_body_derivatives

  pure subroutine ball_derivatives(self, t, y, dydt, in_domain)
    class(bouncing_ball_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt(1) = y(2)
    dydt(2) = -1
    in_domain = .true.
  end subroutine ball_derivatives

  pure subroutine ball_events(self, t, y, g, g_rate)
    class(bouncing_ball_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = -y(1)
    g_rate = -y(2)
  end subroutine ball_events

  subroutine ball_rebounds(self, index, t, y, action)
    class(bouncing_ball_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    self%impacts = self%impacts + index
    if (self%impacts <= size(self%times)) self%times(self%impacts) = t
    y(1) = 0
    y(2) = -self%restitution*y(2)
    action = event_continue
  end subroutine ball_rebounds

  pure subroutine hopper_events(self, t, y, g, g_rate)
    class(hopper_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = y(1) - self%level
    g_rate = y(2)
  end subroutine hopper_events

  subroutine hopper_passes(self, index, t, y, action)
    class(hopper_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    self%passages = self%passages + index
    if (self%passages <= size(self%times)) self%times(self%passages) = t
    action = event_continue
  end subroutine hopper_passes
end module test_problems
