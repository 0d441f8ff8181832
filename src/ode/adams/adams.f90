!> The Adams PECE method of Shampine & Gordon, *Computer Solution of Ordinary Differential Equations* (1975):
!> Adams-Bashforth predictor of order k, Adams-Moulton corrector of order k+1 (local extrapolation), variable step and
!> order 1-12 in modified divided differences. phi, psi, alpha, beta, sigma and g keep their names.
!>
!> Deliberate differences from the published code:
!> - the first step is chosen from the size of y'', by one more evaluation, not from |f| alone;
!> - after a start where the problem says that f is smooth in sqrt(t - t_start) (at the beginning of a contact the force varies as
!>   the power 1.5 of the penetration) the independent variable is x = sqrt(t - t_start), with dy/dx = 2 x f: order and step size
!>   then rise as from a smooth start;
!> - while order and step size rise after a start, a step may grow as far as its error at the present order allows, up to 64 times,
!>   instead of only twice;
!> - later a step may also grow by a quarter instead of only by doubling; the order may rise at varying step size too, except while
!>   stability limits the step, where the higher order only reduces the limit (gain and cost of both: data/manual/choices.md);
!> - steps are shortened where the problem says that f is about to lose its smoothness;
!> - trial states outside the model, and steps that the problem refuses, are rejected like errors;
!> - the interpolant also matches y at the beginning of the step, so that it and its derivative are continuous;
!> - y is summed with compensation at every tolerance.
!>
!> The error of a step is its weighted Euclidean norm, as in the published code.
module adams
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, step_admitted, step_too_far
  use ode_method, only: ode_method_t, highest_order, step_done, step_rejected, step_too_small, tolerance_too_small, left_domain, &
    limit_start
  use adams_coefficients, only: adams_coefficients_t
  use adams_differences, only: extrapolate, correct
  implicit none
  private
  public :: adams_t

  !> Reasons to repeat a step.
  integer, parameter :: try_accepted = 0, try_error = 1, try_outside = 2, try_too_deep = 3, try_too_far = 4

  !> Squares of the estimated errors of the present trial at neighbouring orders, relative to the tolerance.
  type :: error_estimates_t
    real(dp) :: step = 0       !! of the step itself (order k with local extrapolation)
    real(dp) :: same = 0       !! at order k
    real(dp) :: lower = 0      !! at order k-1
    real(dp) :: lowest = 0     !! at order k-2
    integer :: order = 1       !! order that these errors suggest: k or k-1
    real(dp) :: correction = 0 !! square of the norm of the correction of y
    real(dp) :: change = 0     !! square of the norm of the resulting change of f
  end type error_estimates_t

  !> The state of the method between two steps.
  type, extends(ode_method_t) :: adams_t
    private
    logical, public :: goes_on = .false.   !! the next start continues inside a phase, after another method
    type(adams_coefficients_t) :: coefficients
    real(dp) :: moulton(highest_order + 1) = 0    !! |gamma*_i|
    integer :: n = 0                    !! number of equations
    integer :: blocks = 0  !! number of blocks of `lanes` components, padded with zeros; arrays of (blocks*lanes) are called wide
    integer :: k = 1                    !! order of the next step
    integer :: k_old = 0                !! order of the last accepted step, 0 at a start
    logical :: closed = .false.         !! `closing` belongs to the last accepted step
    logical :: rooted = .false.         !! the independent variable is x = sqrt(t - t_origin), otherwise the time
    real(dp) :: t_origin = 0            !! time at which such a variable begins
    real(dp) :: x = 0                   !! independent variable at the end of the last accepted step
    real(dp) :: x_old = 0               !! at its beginning
    real(dp) :: h = 0                   !! size of the next step in the independent variable
    real(dp) :: h_old = 0               !! size of the last accepted step
    integer :: failures = 0             !! number of trials of the next step that failed by error or by leaving the model
    integer :: limit = limit_start      !! reason why the next step is not longer
    logical :: bound = .false.          !! stability limited the last accepted step, in a wide sense
    logical :: higher_known = .false.   !! phi_k+2 gives the error at order k+1
    real(dp) :: rounding_square = 0     !! square of the weighted norm of the rounding error of y
    logical :: opening = .true.         !! order and step size are still rising after the start
    real(dp), allocatable :: phi(:, :)  !! modified divided differences, (wide, highest_order+2)
    real(dp), allocatable :: owed(:)    !! difference not yet added to the first columns of phi, wide
    real(dp), allocatable :: closing(:) !! coefficient of the last polynomial of the interpolant, wide
    real(dp), allocatable :: slope(:)   !! work array, wide
    real(dp), allocatable :: f(:)       !! derivative of y with respect to the independent variable, 0 at the start of x
    real(dp), allocatable :: predicted(:), f_predicted(:), f_new(:), y_new(:)
    real(dp), allocatable :: inverse_weight(:)       !! 1/(relative |y| + absolute), 0: no error control
    real(dp), allocatable :: carry(:), carry_new(:)  !! rounding errors of y, for the compensated summation
  contains
    procedure :: prepare
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: start_with_history
  end type adams_t

  interface
    module subroutine start(self, problem, t, y, first, status)
      class(adams_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t, y(:)
      logical, intent(in) :: first
      integer, intent(out) :: status
    end subroutine start

    !> Begin at (x(m), y) with known right-hand sides f(:, 1..m) at m <= 12 instants x(1) < x(2) < ... x(m). The first step is of
    !> order m and size `h`.
    module subroutine start_with_history(self, problem, x, f, y, h, status)
      class(adams_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: x(:), f(:, :), y(:), h
      integer, intent(out) :: status
    end subroutine start_with_history

    !> Allocate all arrays, once for a whole integration.
    module subroutine prepare(self, problem)
      class(adams_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
    end subroutine prepare

    !> Weights of the error norm for the present state, and the norm of its rounding error.
    pure module subroutine weigh(self)
      class(adams_t), intent(inout) :: self
    end subroutine weigh

    !> Change of the independent variable while the time changes by dt from the end of the last accepted step.
    pure real(dp) module function clock_step(self, dt)
      class(adams_t), intent(in) :: self
      real(dp), intent(in) :: dt
    end function clock_step

    !> Restore phi and psi to the beginning of the step and shorten it. After three failures in a row by error, or because the state
    !> leaves the model, the order is reduced to one: earlier points are then far away compared with the step, formulas of
    !> neighbouring orders are nearly equal to the trapezoidal rule, and their difference is no error estimate.
    pure module subroutine retreat(self, errors, outcome, fraction)
      class(adams_t), intent(inout) :: self
      type(error_estimates_t), intent(in) :: errors
      integer, intent(in) :: outcome
      real(dp), intent(in) :: fraction
    end subroutine retreat

    !> Errors at orders k, k-1, k-2, and whether the order should be reduced (Shampine & Gordon, ch. 6).
    pure module subroutine estimate_errors(self, squares, errors)
      class(adams_t), intent(in) :: self
      real(dp), intent(in) :: squares(3)   !! from `correct`
      type(error_estimates_t), intent(out) :: errors
    end subroutine estimate_errors

    !> Shorten a step that ends near the instant at which f loses its smoothness. Error estimates of high order do not detect a
    !> branch point ahead. The force of dry contact ends with the power 1.5 of the remaining time: a step is limited to a sixth of
    !> that time (data/manual/choices.md).
    pure module subroutine shorten_before_kink(self)
      class(adams_t), intent(inout) :: self
    end subroutine shorten_before_kink

    !> Count what limited the step. It was stability if h rho is near the limit of the order although the fastest mode, with the
    !> rate rho, has decayed. rho is |f_new - f_predicted|/|y_new - y_predicted| (as in Hairer & Wanner 1996, IV.2), or 0 if the
    !> correction is within rounding. `bound`, with a wider criterion, prevents the order from rising (gain, and the exactness of
    !> rho: data/manual/choices.md).
    pure module subroutine count_limit(self, errors)
      class(adams_t), intent(inout) :: self
      type(error_estimates_t), intent(in) :: errors
    end subroutine count_limit

    !> Order and size of the next step (Shampine & Gordon, ch. 7): the order is raised while the method is starting, later if the
    !> errors decrease with the order; the step is doubled, raised by a quarter, kept, or reduced to what the tolerance allows.
    pure module subroutine choose_order_and_step(self, errors)
      class(adams_t), intent(inout) :: self
      type(error_estimates_t), intent(in) :: errors
    end subroutine choose_order_and_step

    !> The time for a value of the independent variable.
    pure real(dp) module function time_at(self, x)
      class(adams_t), intent(in) :: self
      real(dp), intent(in) :: x
    end function time_at

    !> The polynomial of degree k+2 whose derivative has the values f_n+1, f_n, ... f_n+1-k and which passes through y_n+1 and y_n.
    !> It and its derivative continue those of the step before (compare Watts & Shampine 1986).
    pure module subroutine interpolate(self, t, y)
      class(adams_t), intent(inout) :: self
      real(dp), intent(in) :: t
      real(dp), intent(out) :: y(:)
    end subroutine interpolate
  end interface

contains

  subroutine step(self, problem, status)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    type(error_estimates_t) :: errors
    real(dp) :: x_new, t_new, fraction
    integer :: outcome

    if (.not. self%rejected) then
      call weigh(self)
      call shorten_before_kink(self)
      self%failures = 0
      status = step_too_small
      if (0.5_dp**2 < 2**2*self%rounding_square .and. .not. self%settings%fixed_step > 0) status = tolerance_too_small
      if (status == tolerance_too_small .or. self%h < shortest_step(self)) return
    end if
    x_new = self%x + self%h
    t_new = time_at(self, x_new)
    call self%coefficients%update(self%h, self%h_old, self%k, self%k_old)
    call predict(self)
    call attempt(self, problem, x_new, t_new, errors, outcome, fraction)
    self%rejected = outcome /= try_accepted
    if (self%rejected) then
      call retreat(self, errors, outcome, fraction)
      status = step_rejected
      if (self%h < shortest_step(self)) status = merge(left_domain, step_too_small, outcome == try_outside)
      return
    end if
    call accept(self, errors, x_new, t_new)
    call choose_order_and_step(self, errors)
    status = step_done
  end subroutine step

  !> The shortest step that the independent variable resolves. (x = sqrt(t - t_origin) has a finer resolution than the time, which
  !> may not change in the first steps.)
  pure real(dp) function shortest_step(self)
    class(adams_t), intent(in) :: self
    shortest_step = 4*epsilon(1.0_dp)*max(abs(self%t), 1e-9_dp*self%settings%span)
    if (self%rooted) shortest_step = 4*epsilon(1.0_dp)*max(self%x, 1e-9_dp*sqrt(self%settings%span))
  end function shortest_step

  !> Predict y at the end of the step; phi is replaced by the differences used for the prediction.
  pure subroutine predict(self)
    class(adams_t), intent(inout) :: self
    associate (c => self%coefficients)
      call extrapolate(self%n, self%blocks, self%k, self%h, c%g, c%beta, c%beta_next, self%y, self%carry, self%owed, &
        self%phi, self%slope, self%predicted, self%carry_new)
    end associate
  end subroutine predict

  !> Evaluate, correct, estimate the error, ask the problem for its verdict, evaluate again.
  subroutine attempt(self, problem, x_new, t_new, errors, outcome, fraction)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: x_new, t_new
    type(error_estimates_t), intent(out) :: errors
    integer, intent(out) :: outcome
    real(dp), intent(out) :: fraction   !! fraction of the step to be tried next, if the problem refused it
    real(dp) :: squares(3), time_rate
    integer :: k, k_before, verdict
    logical :: in_domain

    fraction = 0.5_dp
    outcome = try_outside
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t_new, self%predicted, self%f_predicted, in_domain)
    if (.not. in_domain) return
    k = self%k
    k_before = max(k - 1, 1)
    time_rate = merge(2*x_new, 1.0_dp, self%rooted)
    call correct(self%n, self%h*self%coefficients%g(k + 1), time_rate, self%f_predicted, self%phi(:, 1), self%phi(:, k), &
      self%phi(:, k_before), self%inverse_weight, self%predicted, self%y_new, self%carry_new, squares)
    call estimate_errors(self, squares, errors)
    if (.not. errors%step <= 1 .and. .not. self%settings%fixed_step > 0) then   ! a NaN is an error too
      outcome = try_error
      return
    end if
    if (problem%refuses_steps) then
      call problem%judge_step(self%t, self%y, t_new, self%y_new, verdict, fraction)
      outcome = merge(try_too_far, try_too_deep, verdict == step_too_far)
      if (verdict /= step_admitted) return
    end if
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t_new, self%y_new, self%f_new, in_domain)
    if (.not. in_domain) then
      fraction = 0.5_dp
      return
    end if
    call rates_by_clock(self%n, time_rate, self%f_predicted, self%inverse_weight, self%f_new, errors%change)
    outcome = try_accepted
  end subroutine attempt

  !> Accept the step: update the differences with the second evaluation.
  pure subroutine accept(self, errors, x_new, t_new)
    class(adams_t), intent(inout) :: self
    type(error_estimates_t), intent(in) :: errors
    real(dp), intent(in) :: x_new, t_new
    integer :: k

    call count_limit(self, errors)
    k = self%k
    self%higher_known = k < self%coefficients%ns .or. self%k_old >= k .and. .not. self%bound
    self%k_old = k
    self%h_old = self%h
    self%t_old = self%t
    self%t = t_new
    self%x_old = self%x
    self%x = x_new
    call keep(self%n, self%y_new, self%carry_new, self%f_new, self%phi(:, 1), self%y, self%y_old, self%carry, self%f, self%owed)
    self%order = k
    self%closed = .false.
    associate (count => self%statistics)
      count%accepted = count%accepted + 1
      count%order_count(k) = count%order_count(k) + 1
      count%smallest_step = min(count%smallest_step, self%t - self%t_old)
    end associate
  end subroutine accept

  !> Replace the solution at the beginning of the step by that at its end, and store the difference not yet added to phi.
  pure subroutine keep(n, y_new, carry_new, f_new, f_extrapolated, y, y_old, carry, f, owed)
    integer, intent(in) :: n
    real(dp), dimension(n), intent(in) :: y_new, carry_new, f_new, f_extrapolated
    real(dp), intent(inout) :: y(n)
    real(dp), dimension(n), intent(out) :: y_old, carry, f, owed
    integer :: i
    !GCC$ novector
    do i = 1, n
      y_old(i) = y(i)
      y(i) = y_new(i)
      carry(i) = carry_new(i)
      f(i) = f_new(i)
      owed(i) = f_new(i) - f_extrapolated(i)
    end do
  end subroutine keep

  !> Convert f from the derivative with respect to time to that with respect to the independent variable; `square` is the square of
  !> the norm of its change from `before`.
  pure subroutine rates_by_clock(n, time_rate, before, inverse_weight, f, square)
    integer, intent(in) :: n
    real(dp), intent(in) :: time_rate, before(n), inverse_weight(n)
    real(dp), intent(inout) :: f(n)
    real(dp), intent(out) :: square
    integer :: i
    square = 0
    !GCC$ novector
    do i = 1, n
      f(i) = time_rate*f(i)
      square = square + ((f(i) - before(i))*inverse_weight(i))**2
    end do
  end subroutine rates_by_clock
end module adams
