!> Interface of all integration methods, with their settings, statistics and status codes.
module ode_method
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  implicit none
  private
  public :: ode_method_t, ode_settings_t, step_statistics_t, start_again
  public :: step_done, step_rejected, step_too_small, tolerance_too_small, start_outside, left_domain
  public :: highest_order, with_adams, with_radau
  public :: limit_error, limit_stability, limit_max_step, limit_start, limit_refusal, n_limits, limit_names

  integer, parameter :: highest_order = 12   !! of the Adams formulas

  !> The methods between which `auto` chooses.
  integer, parameter :: with_adams = 1, with_radau = 2

  !> Reasons why a step was not longer.
  integer, parameter :: limit_error = 1       !! the error estimate
  integer, parameter :: limit_stability = 2   !! stability of the method: the fastest mode has decayed but still limits the step
  integer, parameter :: limit_max_step = 3    !! largest step of the settings
  integer, parameter :: limit_start = 4       !! order and step size were rising after a start
  integer, parameter :: limit_refusal = 5     !! the problem refused a longer step (penetration, reversal, domain)
  integer, parameter :: n_limits = 5
  character(len=9), parameter :: limit_names(n_limits) = [character(len=9) :: 'error', 'stability', 'max_step', 'start', &
    'refusal']

  !> Status of a step.
  integer, parameter :: step_done = 0            !! a step was accepted
  integer, parameter :: step_rejected = -2       !! a trial was rejected; the next call of `step` makes a shorter one
  integer, parameter :: step_too_small = 1       !! the step size reached the rounding error of the time
  integer, parameter :: tolerance_too_small = 2  !! the tolerance is below the rounding error of the state
  integer, parameter :: start_outside = 3        !! the initial state is outside the model
  integer, parameter :: left_domain = 4          !! the state leaves the model even with the shortest step

  !> Settings of a method. The error of a step in component i is compared with relative(i)*|y(i)| + absolute(i); a component for
  !> which both are zero is excluded from the error control.
  type :: ode_settings_t
    real(dp) :: tolerance = 0             !! relative tolerance from which the others are derived; 0: the largest of `relative`
    real(dp), allocatable :: relative(:)  !! relative tolerance of each component, (n)
    real(dp), allocatable :: absolute(:)  !! absolute tolerance of each component, in its unit, (n)
    real(dp) :: max_step = huge(1.0_dp)   !! longest step
    real(dp) :: first_step = huge(1.0_dp) !! longest first step, if the problem has a known time scale
    real(dp) :: span = 1                  !! duration of the whole integration, which sets the shortest step
    real(dp) :: stop_time = huge(1.0_dp)  !! end of the integration, which a one-step method reaches with a step
    integer :: max_order = highest_order  !! highest order, 1..highest_order
    integer :: max_evaluations = 0        !! of the right-hand side in an integration; 0: no limit
    real(dp) :: fixed_step = 0            !! > 0: constant step size without error control, for tests of the order
    real(dp) :: chatter_time = 0          !! a hundred events in less than this time count as chatter; 0: 1e-9 of the span
  end type ode_settings_t

  !> Statistics since the beginning of an integration. Only `rejected_*` and `evaluations` include rejected work. Times are counted
  !> by `count_time` and add up to the time integrated.
  type :: step_statistics_t
    integer :: accepted = 0
    integer :: rejected_error = 0        !! estimated error above the tolerance
    integer :: rejected_penetration = 0  !! contact entered too deeply
    integer :: rejected_domain = 0       !! trial state outside the model
    integer :: rejected_convergence = 0  !! Newton's method did not converge (implicit methods)
    integer :: jacobians = 0             !! Jacobians evaluated (implicit methods)
    integer :: stage_count(3) = 0        !! accepted steps of the Radau formulas of 3, 5 and 7 stages
    integer :: evaluations = 0           !! evaluations of the right-hand side
    integer :: restarts = 0              !! number of starts after the first one
    real(dp) :: smallest_step = huge(1.0_dp)    !! shortest accepted step
    integer :: order_count(highest_order) = 0   !! accepted steps of each order
    integer :: limited_by(n_limits) = 0         !! accepted steps for each reason of their limit
    integer :: switches = 0                     !! number of changes between Adams and Radau
    real(dp) :: stiffness = 0     !! integral of rho dt, where rho is the estimated rate of the fastest mode; 0: not estimated
  end type step_statistics_t

  !> A method that advances a problem step by step and provides the solution anywhere inside its last step.
  type, abstract :: ode_method_t
    type(ode_settings_t) :: settings
    type(step_statistics_t) :: statistics
    real(dp), allocatable :: time_with(:, :)   !! method auto: time with each method in each mode, (2, 0:highest mode)
    real(dp) :: t_old = 0                 !! beginning of the last accepted step
    real(dp) :: t = 0                     !! its end
    integer :: order = 0                  !! order of the last accepted step
    real(dp) :: next_kink_time = huge(1.0_dp) !! expected time at which f loses its smoothness, see `next_kink_time` of the problem
    real(dp), allocatable :: y_old(:)     !! state at t_old, (n)
    real(dp), allocatable :: y(:)         !! state at t, (n)
    logical :: rejected = .false.         !! the last trial was rejected
    integer :: limit_done = 0             !! reason why the last accepted step was not longer, 0: unknown
    real(dp) :: stiffness_done = 0        !! contribution of the last step to the integral of rho dt
  contains
    procedure :: nominal_tolerance
    procedure :: totals
    procedure :: count_time
    procedure(start), deferred :: start
    procedure(step), deferred :: step
    procedure(interpolate), deferred :: interpolate
    procedure :: may_improve => never
    procedure :: improve => leave_as_it_is
    procedure :: land_on
    procedure :: withdraw => start_again
    procedure, non_overridable :: difference
  end type ode_method_t

  abstract interface
    !> Begin at (t, y) without history, after any discontinuity of the right-hand side or of the state. `first` is true at the start
    !> of an integration, which resets the statistics, and false at a restart, which is counted.
    subroutine start(self, problem, t, y, first, status)
      import :: ode_method_t, ode_problem_t, dp
      class(ode_method_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t, y(:)
      logical, intent(in) :: first
      integer, intent(out) :: status
    end subroutine start

    !> Try a step, which is accepted or rejected: the caller can look at its limits between two trials.
    subroutine step(self, problem, status)
      import :: ode_method_t, ode_problem_t
      class(ode_method_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      integer, intent(out) :: status
    end subroutine step

    !> State at a time t_old <= t <= self%t, without evaluating the right-hand side; valid until the next step. `self` is changed
    !> only by preparations of the first call after a step.
    pure subroutine interpolate(self, t, y)
      import :: ode_method_t, dp
      class(ode_method_t), intent(inout) :: self
      real(dp), intent(in) :: t
      real(dp), intent(out) :: y(:)
    end subroutine interpolate
  end interface

contains

  !> The relative tolerance chosen by the user.
  pure real(dp) function nominal_tolerance(self)
    class(ode_method_t), intent(in) :: self
    nominal_tolerance = self%settings%tolerance
    if (.not. nominal_tolerance > 0) nominal_tolerance = maxval(self%settings%relative)
  end function nominal_tolerance

  !> Improve a state inside the last step, found by `interpolate`, where f is the right-hand side. `change` is 0 if y remains as it
  !> is. Methods whose steps are more accurate than their interpolant override this; the default changes nothing.
  pure subroutine leave_as_it_is(self, t, f, y, change)
    class(ode_method_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(in) :: f(:)         !! (n)
    real(dp), intent(inout) :: y(:)      !! (n)
    real(dp), intent(out) :: change      !! its largest change, in tolerances
    change = 0
  end subroutine leave_as_it_is

  !> Whether `improve` may improve a state at this time. The default is no.
  pure logical function never(self, t)
    class(ode_method_t), intent(in) :: self
    real(dp), intent(in) :: t
    never = .false.
  end function never

  !> State at a time inside the last step at which the integration is to be restarted. Methods with steps more accurate than their
  !> interpolant repeat the step up to that time, and `landed` is false where they cannot; the default interpolates.
  subroutine land_on(self, problem, t, y, landed)
    class(ode_method_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    logical, intent(out) :: landed
    call self%interpolate(t, y)
    landed = .true.
  end subroutine land_on

  !> Take back the last step, whose solution is not accurate inside it: start again at its beginning with a step of at most
  !> `longest`.
  subroutine start_again(self, problem, longest, status)
    class(ode_method_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: longest
    integer, intent(out) :: status
    real(dp) :: first_step, y(size(self%y))
    first_step = self%settings%first_step
    self%settings%first_step = min(first_step, longest)
    y = self%y_old
    call self%start(problem, self%t_old, y, .false., status)
    self%settings%first_step = first_step
  end subroutine start_again

  !> The difference of two states relative to the tolerance, as root mean square over the components in the error control.
  pure real(dp) function difference(self, y, other)
    class(ode_method_t), intent(in) :: self
    real(dp), intent(in) :: y(:), other(:)
    real(dp) :: allowed
    integer :: i, counted
    difference = 0
    counted = 0
    do i = 1, size(y)
      allowed = self%settings%relative(i)*abs(y(i)) + self%settings%absolute(i)
      if (.not. allowed > 0) cycle
      difference = difference + ((y(i) - other(i))/allowed)**2
      counted = counted + 1
    end do
    difference = sqrt(difference/max(counted, 1))
  end function difference

  !> Count the duration of the last accepted step, once it is known which part of it is final: up to t_to, which is self%t or the
  !> time at which an event or the end of the integration cuts the step. Nothing if the method has just been started.
  subroutine count_time(self, t_to)
    class(ode_method_t), intent(inout) :: self
    real(dp), intent(in) :: t_to   !! t_old <= t_to <= t
    real(dp) :: share
    if (.not. self%t > self%t_old) return
    share = 1
    if (t_to < self%t) share = (t_to - self%t_old)/(self%t - self%t_old)
    self%statistics%stiffness = self%statistics%stiffness + share*self%stiffness_done
  end subroutine count_time

  !> Statistics of the whole integration so far.
  pure type(step_statistics_t) function totals(self) result(statistics)
    class(ode_method_t), intent(in) :: self
    statistics = self%statistics
  end function totals
end module ode_method
