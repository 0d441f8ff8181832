!> The Adams PECE method of Shampine & Gordon, *Computer Solution of Ordinary Differential Equations* (1975):
!> Adams-Bashforth predictor of order k, Adams-Moulton corrector of order k+1 (local extrapolation), variable step and
!> order 1-12 in modified divided differences. phi, psi, alpha, beta, sigma and g keep their names.
!>
!> Differences from the published code, each deliberate:
!> - the first step is chosen from the size of y'' by one more evaluation, not from |f| alone;
!> - after a start where the problem says that f is smooth in sqrt(t - t_start) (a contact that begins: the force goes
!>   with the power 1.5 of the penetration) the method steps in x = sqrt(t - t_start), y' = 2 x f: order and step rise
!>   as from a smooth start;
!> - while order and step rise from a start, a step grows by what its error at the present order allows, up to 64 times,
!>   not only twice: the published doubling takes 20 steps from the first step of order 1 to the step of the flight;
!> - later a step may also grow by a quarter, not only double; the order may rise at varying step too (not while
!>   stability limits the step: there the higher order only narrows the limit).
!>   Measured together (scripts/compare_adams.sh, evaluations at 1e-6 ... 1e-12): dry contact -23 ... -36 %, film scenes
!>   -12 ... -18 %, the standard battery +13 % at 1e-3, -22 % at 1e-12;
!> - steps are shortened where the problem says that f is about to lose its smoothness;
!> - trial states outside the model and steps that a problem refuses are rejected like errors;
!> - the interpolant also matches y at the beginning of the step, so it is continuous with its derivative;
!> - y is summed with compensation at every tolerance.
!> The error of a step is its weighted Euclidean norm, as in the published code.
module adams
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, step_admitted, step_too_deep
  use ode_method, only: ode_method_t, highest_order, step_done, step_too_small, tolerance_too_small, start_outside, left_domain, &
    step_statistics_t, limit_error, limit_stability, limit_max_step, limit_start, limit_refusal
  use adams_coefficients, only: adams_coefficients_t, moulton_constants, interpolation_weights, stability_limit
  use adams_differences, only: extrapolate, restore_differences, raise_differences, differences_of
  use step_rates, only: fastest_mode
  use bernstein, only: from_newton, integral
  use archive, only: archive_t
  implicit none
  private
  public :: adams_t

  !> Reasons to try a step again.
  integer, parameter :: try_accepted = 0, try_error = 1, try_outside = 2, try_too_deep = 3

  !> Estimated errors of the present try at the neighbouring orders, relative to the tolerance.
  type :: error_estimates_t
    real(dp) :: step = 0       !! of the step as taken (order k with local extrapolation)
    real(dp) :: same = 0       !! at order k
    real(dp) :: lower = 0      !! at order k-1
    real(dp) :: lowest = 0     !! at order k-2
    integer :: order = 1       !! order proposed by them: k or k-1
  end type error_estimates_t

  !> The state of the method between two steps.
  type, extends(ode_method_t) :: adams_t
    private
    logical, public :: goes_on = .false.   !! the next start goes on inside a phase, after another method
    type(adams_coefficients_t) :: coefficients
    real(dp) :: moulton(highest_order + 1) = 0    !! |gamma*_i|
    integer :: n = 0                    !! equations
    integer :: k = 1                    !! order of the next step
    integer :: k_old = 0                !! order of the last accepted step, 0 at a start
    logical :: closed = .false.         !! `closing` belongs to the last accepted step
    logical :: rooted = .false.         !! the clock is x = sqrt(t - t_origin), else the time itself
    real(dp) :: t_origin = 0            !! where a rooted clock began
    real(dp) :: x = 0                   !! the clock at the end of the last accepted step
    real(dp) :: x_old = 0               !! at its beginning
    real(dp) :: h = 0                   !! size of the next step, by the clock
    real(dp) :: h_old = 0               !! size of the last accepted step
    integer :: limit = limit_start      !! what made the next step no longer
    logical :: bound = .false.          !! stability limited the last accepted step, in a wide sense
    logical :: higher_known = .false.   !! phi_k+2 tells the error at order k+1
    real(dp) :: rounding = 0            !! weighted norm of the rounding of y
    logical :: opening = .true.         !! order and step are still being raised from the start
    real(dp), allocatable :: phi(:, :)  !! modified divided differences, (n, highest_order+2)
    real(dp), allocatable :: predicted(:), f_predicted(:), f_new(:), y_new(:)
    real(dp), allocatable :: inverse_weight(:)       !! 1/(relative |y| + absolute), 0: not controlled
    real(dp), allocatable :: carry(:), carry_predicted(:)  !! what the rounding of y left out
    real(dp), allocatable :: closing(:) !! coefficient of the last polynomial of the interpolant
  contains
    procedure :: prepare
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: straying
    procedure :: bernstein_form
    procedure :: time_at_share
    procedure :: start_with_history
    procedure :: exchange
  end type adams_t

contains

  subroutine start(self, problem, t, y, first, status)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: first
    integer, intent(out) :: status
    logical :: inside

    if (first .or. .not. allocated(self%phi)) call prepare(self, problem)
    self%t = t
    self%t_old = t
    self%y = y
    self%y_old = y
    self%order = 0
    self%closed = .false.
    self%carry = 0
    self%rooted = problem%smooth_in_root .and. .not. self%goes_on
    self%t_origin = t
    self%x = merge(0.0_dp, t, self%rooted)
    self%x_old = self%x
    self%statistics%evaluations = self%statistics%evaluations + 1
    if (.not. first) self%statistics%restarts = self%statistics%restarts + 1
    call problem%derivatives(t, self%y, self%f, inside)
    status = merge(step_done, start_outside, inside)
    if (.not. inside) return

    self%k = 1
    self%k_old = 0
    self%h_old = 0
    self%opening = .true.
    call self%coefficients%reset()
    self%phi = 0
    if (.not. self%rooted) self%phi(:, 1) = self%f(:self%n)
    call weigh(self)
    call choose_first_step(self, problem)
    self%limit = limit_start
  end subroutine start

  !> Begin at (x(m), y) with the right-hand sides f(:, 1..m) known at m <= 12 instants x(1) < x(2) < ... x(m): the first
  !> step is of order m and size `h`.
  subroutine start_with_history(self, problem, x, f, y, h, status)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: x(:), f(:, :), y(:), h
    integer, intent(out) :: status
    integer :: m

    m = size(x)
    call self%start(problem, x(m), y, .true., status)
    if (status /= step_done) return
    call differences_of(x, f(:self%n, :), self%phi(:, :m), self%coefficients%psi(:m - 1))
    self%k = m
    self%k_old = m - 1
    self%h_old = self%coefficients%psi(1)
    self%h = h
    self%opening = .false.
  end subroutine start_with_history

  !> Allocate everything, once for a whole integration.
  subroutine prepare(self, problem)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer :: n
    n = problem%n
    self%n = n
    self%moulton = moulton_constants()
    self%statistics = step_statistics_t()
    if (allocated(self%phi)) deallocate (self%phi, self%predicted, self%f_predicted, self%f_new, self%y_new, &
      self%inverse_weight, self%carry, self%carry_predicted, self%closing, self%y, self%y_old, self%f)
    allocate (self%phi(n, highest_order + 2), self%predicted(n), self%f_predicted(n), &
      self%f_new(n), self%y_new(n), self%inverse_weight(n), self%carry(n), &
      self%carry_predicted(n), self%closing(n), self%y(n), self%y_old(n), self%f(n))
  end subroutine prepare

  !> All components but those that `prepare` sets and those in which a step works.
  subroutine exchange(self, problem, archive)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    type(archive_t), intent(inout) :: archive
    if (archive%is_reading) call prepare(self, problem)
    call self%exchange_solution(problem, archive)
    call self%coefficients%exchange(archive)
    call archive%exchange(self%k)
    call archive%exchange(self%k_old)
    call archive%exchange(self%closed)
    call archive%exchange(self%rooted)
    call archive%exchange(self%t_origin)
    call archive%exchange(self%x)
    call archive%exchange(self%x_old)
    call archive%exchange(self%h)
    call archive%exchange(self%h_old)
    call archive%exchange(self%limit)
    call archive%exchange(self%bound)
    call archive%exchange(self%higher_known)
    call archive%exchange(self%rounding)
    call archive%exchange(self%opening)
    call archive%exchange(self%phi)
    call archive%exchange(self%inverse_weight)
    call archive%exchange(self%carry)
    call archive%exchange(self%closing)
  end subroutine exchange

  !> The norm in which errors are measured: 1 is the tolerance.
  pure real(dp) function weighted_norm(self, values)
    class(adams_t), intent(in) :: self
    real(dp), intent(in) :: values(:)
    integer :: i
    weighted_norm = 0
    do i = 1, self%n
      weighted_norm = weighted_norm + (values(i)*self%inverse_weight(i))**2
    end do
    weighted_norm = sqrt(weighted_norm)
  end function weighted_norm

  !> Weights of the error norm at the present state.
  pure subroutine weigh(self)
    class(adams_t), intent(inout) :: self
    real(dp) :: weight
    integer :: i
    do i = 1, self%n
      weight = self%settings%relative(i)*abs(self%y(i)) + self%settings%absolute(i)
      self%inverse_weight(i) = 0
      if (weight > 0) self%inverse_weight(i) = 1/weight
    end do
  end subroutine weigh

  !> The first step: a step of order 1 whose error, h^2 |y''|/2, is a quarter of the tolerance. y'' is taken from one
  !> Euler step short enough to stay near (Hairer, Norsett & Wanner 1993, II.4), but not shorter than the time resolves.
  subroutine choose_first_step(self, problem)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp) :: longest, h, slope, curvature, resolution
    logical :: inside
    integer :: tries

    longest = min(self%settings%max_step, self%settings%span)
    if (self%settings%fixed_step > 0) then
      self%h = self%settings%fixed_step
      return
    end if
    slope = weighted_norm(self, self%f)
    h = longest*1e-3_dp
    if (slope*h > 1) h = 1/slope
    resolution = epsilon(h)*max(abs(self%t), 1e-9_dp*self%settings%span)
    if (h < 10*resolution) h = 1e4_dp*resolution
    do tries = 1, 60
      self%predicted = self%y + h*self%f(:self%n)
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + h, self%predicted, self%f_predicted, inside)
      if (inside) exit
      h = 0.1_dp*h
    end do
    curvature = 0
    if (inside .and. self%rooted) then   ! by the clock, y'' is 2 f at the start
      curvature = 2*weighted_norm(self, self%f_predicted)
    else if (inside) then
      self%f_predicted = self%f_predicted - self%f
      curvature = weighted_norm(self, self%f_predicted)/h
    end if
    if (self%rooted) then
      longest = sqrt(longest)
      h = sqrt(h)
    end if
    if (curvature > 0) then
      self%h = min(sqrt(0.5_dp/curvature), 100*h, longest)
    else
      self%h = min(100*h, longest)
    end if
  end subroutine choose_first_step

  !> The time at clock x.
  pure real(dp) function time_at(self, x)
    class(adams_t), intent(in) :: self
    real(dp), intent(in) :: x
    time_at = x
    if (self%rooted) time_at = self%t_origin + x**2
  end function time_at

  !> How far the clock goes while the time goes by dt from the end of the last accepted step.
  pure real(dp) function clock_step(self, dt)
    class(adams_t), intent(in) :: self
    real(dp), intent(in) :: dt
    clock_step = dt
    if (self%rooted) clock_step = dt/(sqrt(self%x**2 + dt) + self%x)
  end function clock_step

  subroutine step(self, problem, status)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    type(error_estimates_t) :: errors
    real(dp) :: x_new, t_new, fraction
    integer :: outcome, failures

    call weigh(self)
    call respect_rough_time(self)
    failures = 0
    outcome = try_accepted
    self%rounding = epsilon(1.0_dp)*weighted_norm(self, self%y)
    if (0.5_dp < 2*self%rounding .and. .not. self%settings%fixed_step > 0) then
      status = tolerance_too_small
      return
    end if
    do
      if (self%h < shortest_step(self)) then
        status = merge(left_domain, step_too_small, outcome == try_outside)
        return
      end if
      x_new = self%x + self%h
      t_new = time_at(self, x_new)
      call self%coefficients%update(self%h, self%h_old, self%k, self%k_old)
      call predict(self)
      call attempt(self, problem, x_new, t_new, errors, outcome, fraction)
      if (outcome == try_accepted) exit
      call retreat(self, errors, outcome, fraction, failures)
    end do
    call accept(self, x_new, t_new)
    call choose_order_and_step(self, errors)
    status = step_done
  end subroutine step

  !> Shorten a step that ends near the instant at which f loses its smoothness. The error estimates of high orders miss
  !> what a branch point ahead does to them: measured on dry contact, whose force ends with the power 1.5 of the time left, a
  !> share of a sixth halves the rejections and costs 9 % less at equal error.
  pure subroutine respect_rough_time(self)
    class(adams_t), intent(inout) :: self
    real(dp), parameter :: share = 1/6.0_dp   !! of the way there, in one step
    real(dp) :: way
    if (.not. self%rough_time < huge(1.0_dp) .or. self%settings%fixed_step > 0) return
    way = clock_step(self, self%rough_time - self%t)
    if (self%h > share*way .and. self%h < 2*way) self%h = max(share*way, 0.5_dp*self%h)
  end subroutine respect_rough_time

  !> The shortest step that the clock can still resolve. (A rooted clock is finer than the time, which may stand still in
  !> the first steps.)
  pure real(dp) function shortest_step(self)
    class(adams_t), intent(in) :: self
    shortest_step = 4*epsilon(1.0_dp)*max(abs(self%t), 1e-9_dp*self%settings%span)
    if (self%rooted) shortest_step = 4*epsilon(1.0_dp)*max(self%x, 1e-9_dp*sqrt(self%settings%span))
  end function shortest_step

  !> Predict y at the end of the step; phi becomes the differences that the prediction extrapolates.
  pure subroutine predict(self)
    class(adams_t), intent(inout) :: self
    associate (c => self%coefficients)
      call extrapolate(self%n, self%k, c%ns, self%h, c%g, c%beta, c%beta_next, self%y, self%carry, self%phi, self%predicted, &
        self%carry_predicted)
    end associate
  end subroutine predict

  !> Evaluate, estimate the error, correct, let the problem judge, evaluate again.
  subroutine attempt(self, problem, x_new, t_new, errors, outcome, fraction)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: x_new, t_new
    type(error_estimates_t), intent(out) :: errors
    integer, intent(out) :: outcome
    real(dp), intent(out) :: fraction   !! part of the step to try next, where the problem refused it
    integer :: verdict
    logical :: inside

    fraction = 0.5_dp
    outcome = try_outside
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t_new, self%predicted, self%f_predicted, inside)
    if (.not. inside) return
    if (self%rooted) self%f_predicted(:self%n) = 2*x_new*self%f_predicted(:self%n)
    call estimate_errors(self, errors)
    if (.not. errors%step <= 1 .and. .not. self%settings%fixed_step > 0) then   ! a NaN is an error too
      outcome = try_error
      return
    end if
    call correct(self)
    call problem%judge_step(self%t, self%y, t_new, self%y_new, verdict, fraction)
    if (verdict == step_too_deep) outcome = try_too_deep
    if (verdict /= step_admitted) return
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t_new, self%y_new, self%f_new, inside)
    if (.not. inside) then
      fraction = 0.5_dp
      return
    end if
    if (self%rooted) self%f_new(:self%n) = 2*x_new*self%f_new(:self%n)
    outcome = try_accepted
  end subroutine attempt

  !> Errors at orders k, k-1, k-2 and whether the order should fall (Shampine & Gordon, ch. 6).
  pure subroutine estimate_errors(self, errors)
    class(adams_t), intent(in) :: self
    type(error_estimates_t), intent(out) :: errors
    real(dp) :: correction, weight, same, lower, lowest
    integer :: i, k

    k = self%k
    same = 0
    lower = 0
    lowest = 0
    do i = 1, self%n
      weight = self%inverse_weight(i)
      correction = self%f_predicted(i) - self%phi(i, 1)
      same = same + (correction*weight)**2
      if (k >= 2) lower = lower + ((self%phi(i, k) + correction)*weight)**2
      if (k >= 3) lowest = lowest + ((self%phi(i, k - 1) + correction)*weight)**2
    end do
    same = self%h*sqrt(same)
    errors%step = same*(self%coefficients%g(k) - self%coefficients%g(k + 1))
    errors%same = same*self%coefficients%sigma(k + 1)*self%moulton(k)
    errors%order = k
    if (k >= 2) errors%lower = self%h*self%coefficients%sigma(k)*self%moulton(k - 1)*sqrt(lower)
    if (k >= 3) errors%lowest = self%h*self%coefficients%sigma(k - 1)*self%moulton(k - 2)*sqrt(lowest)
    if (k == 2 .and. errors%lower <= 0.5_dp*errors%same) errors%order = k - 1
    if (k >= 3 .and. max(errors%lower, errors%lowest) <= errors%same) errors%order = k - 1
  end subroutine estimate_errors

  !> Correct to order k+1.
  pure subroutine correct(self)
    class(adams_t), intent(inout) :: self
    real(dp) :: factor
    factor = self%h*self%coefficients%g(self%k + 1)
    self%y_new = self%predicted + (factor*(self%f_predicted(:self%n) - self%phi(:, 1)) - self%carry_predicted)
  end subroutine correct

  !> Put phi and psi back to the beginning of the step and shorten it. On the third failure in a row by error
  !> the order falls to one.
  pure subroutine retreat(self, errors, outcome, fraction, failures)
    class(adams_t), intent(inout) :: self
    type(error_estimates_t), intent(in) :: errors
    integer, intent(in) :: outcome
    real(dp), intent(in) :: fraction
    integer, intent(inout) :: failures    !! failures by error so far in this step
    real(dp) :: factor

    call restore_differences(self%n, self%k, self%coefficients%beta, self%coefficients%beta_next, self%phi)
    call self%coefficients%take_back(self%h, self%k)
    self%opening = .false.
    factor = fraction
    select case (outcome)
    case (try_error)
      self%limit = limit_error
      self%statistics%rejected_error = self%statistics%rejected_error + 1
      failures = failures + 1
      factor = 0.5_dp
      if (failures > 3 .and. errors%same > 2) factor = sqrt(0.5_dp/errors%same)
      self%k = merge(1, errors%order, failures >= 3)
    case (try_too_deep)
      self%limit = limit_refusal
      self%statistics%rejected_penetration = self%statistics%rejected_penetration + 1
    case default
      self%limit = limit_refusal
      self%statistics%rejected_domain = self%statistics%rejected_domain + 1
    end select
    self%h = factor*self%h
  end subroutine retreat

  !> Count what limited the step. It was stability where h rho, rho the rate of the fastest mode, is near the limit of the
  !> order though the mode itself is not being followed any more. A wider sense of it, `bound`, keeps the order from rising:
  !> measured on the films, at 1e-6 it saves 40 % of the evaluations. On the films the integral of rho dt so estimated
  !> agrees with that of the eigenvalues (1.04e4, 2.14e5, 2.49e6) within 1 %.
  pure subroutine count_limit(self, x_new)
    class(adams_t), intent(inout) :: self
    real(dp), intent(in) :: x_new
    real(dp) :: scale, reach, slow, near
    integer :: limit
    scale = 1
    if (self%rooted) scale = 2*self%x
    call fastest_mode(self%n, self%h, self%inverse_weight, self%f, scale, self%f_predicted, self%f_new, self%y, &
      self%predicted, self%y_new, 100*self%rounding, reach, slow)
    self%statistics%stiffness = self%statistics%stiffness + reach
    near = reach/stability_limit(self%k)
    self%bound = near > 0.3_dp .and. slow < 0.6_dp
    limit = self%limit
    if (limit == limit_error .and. near > 0.5_dp .and. slow < 0.3_dp) limit = limit_stability
    associate (count => self%statistics)
      count%limited_by(limit) = count%limited_by(limit) + 1
      count%time_limited_by(limit) = count%time_limited_by(limit) + (time_at(self, x_new) - self%t)
    end associate
  end subroutine count_limit

  !> The step stands: update the differences with the second evaluation.
  pure subroutine accept(self, x_new, t_new)
    class(adams_t), intent(inout) :: self
    real(dp), intent(in) :: x_new, t_new
    real(dp) :: factor
    integer :: i, k

    call count_limit(self, x_new)
    k = self%k
    self%higher_known = k < self%coefficients%ns .or. self%k_old >= k .and. .not. self%bound
    self%k_old = k
    self%h_old = self%h
    self%t_old = self%t
    self%t = t_new
    self%x_old = self%x
    self%x = x_new
    factor = self%h*self%coefficients%g(k + 1)
    do i = 1, self%n
      self%carry(i) = (self%y_new(i) - self%predicted(i)) - &
        (factor*(self%f_predicted(i) - self%phi(i, 1)) - self%carry_predicted(i))
      self%y_old(i) = self%y(i)
      self%y(i) = self%y_new(i)
    end do
    call raise_differences(self%n, k, self%f_new, self%phi)
    self%f = self%f_new
    if (self%rooted) self%f(:self%n) = self%f_new(:self%n)/(2*x_new)
    self%order = k
    self%closed = .false.
    associate (count => self%statistics)
      count%accepted = count%accepted + 1
      count%order_count(k) = count%order_count(k) + 1
      count%smallest_step = min(count%smallest_step, self%t - self%t_old)
    end associate
  end subroutine accept

  !> The order and size of the next step (Shampine & Gordon, ch. 7): order raised while opening; else where the
  !> errors fall with the order; the step doubled, raised by a quarter, kept, or cut to what the tolerance allows.
  pure subroutine choose_order_and_step(self, errors)
    class(adams_t), intent(inout) :: self
    type(error_estimates_t), intent(in) :: errors
    real(dp) :: error, higher, factor
    integer :: k

    k = self%k
    error = errors%same
    if (self%settings%fixed_step > 0) then
      self%k = min(k + 1, self%settings%max_order)
      return
    end if
    if (errors%order < k .or. k >= self%settings%max_order) self%opening = .false.
    if (self%opening) then
      self%k = k + 1
      self%limit = limit_start
      factor = (0.1_dp/max(errors%same, tiny(1.0_dp)))**(1.0_dp/(k + 1))
      call grow(self, max(2.0_dp, min(64.0_dp, factor)))
      return
    end if
    if (errors%order < k) then
      self%k = k - 1
      error = errors%lower
    else if (self%higher_known) then
      higher = self%h*self%coefficients%sigma_next*self%moulton(k + 1)*weighted_norm(self, self%phi(:, k + 2))
      if (k == 1) then
        if (higher < 0.5_dp*error .and. k < self%settings%max_order) self%k = 2
      else if (errors%lower <= min(error, higher)) then
        self%k = k - 1
        error = errors%lower
      else if (higher < error .and. k < self%settings%max_order) then
        self%k = k + 1
      end if
      if (self%k > k) error = higher
    end if

    if (0.5_dp >= error*2.0_dp**(self%k + 1)) then
      factor = 2
    else if (0.5_dp >= error*1.25_dp**(self%k + 1) .and. self%coefficients%ns > 1) then
      factor = 1.25_dp
    else if (0.5_dp >= error) then
      factor = 1
    else
      factor = max(0.5_dp, min(0.9_dp, (0.5_dp/error)**(1.0_dp/(self%k + 1))))
    end if
    self%limit = limit_error
    call grow(self, factor)
  end subroutine choose_order_and_step

  !> Multiply the step size, within what the settings allow.
  pure subroutine grow(self, factor)
    class(adams_t), intent(inout) :: self
    real(dp), intent(in) :: factor
    real(dp) :: longest
    self%h = factor*self%h
    longest = clock_step(self, self%settings%max_step)
    if (self%h < longest) return
    self%h = longest
    self%limit = limit_max_step
  end subroutine grow

  !> The polynomial of degree k+2 whose derivative takes the values f_n+1, f_n, ... f_n+1-k and that passes through
  !> y_n+1 and y_n: with its derivative it continues that of the step before (compare Watts & Shampine 1986).
  pure subroutine interpolate(self, t, y)
    class(adams_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    real(dp) :: weights(highest_order + 2), s
    integer :: j, k

    k = self%k_old
    s = t - self%t
    if (self%rooted) s = sqrt(max(t - self%t_origin, 0.0_dp)) - self%x
    if (k == 0 .or. s >= 0) then
      y = self%y
      return
    end if
    if (.not. self%closed) call close_polynomial(self)
    call interpolation_weights(self%coefficients, k, s, weights)
    y = weights(k + 2)*self%closing
    do j = k + 1, 1, -1
      y = y + weights(j)*self%phi(:, j)
    end do
    y = self%y + s*y
  end subroutine interpolate

  !> The coefficient of the last polynomial of the interpolant, which makes it pass through y at the beginning of the step.
  pure subroutine close_polynomial(self)
    class(adams_t), intent(inout) :: self
    real(dp) :: weights(highest_order + 2)
    integer :: j
    associate (k => self%k_old)
      call interpolation_weights(self%coefficients, k, self%x_old - self%x, weights)
      self%closing = self%y_old - self%y
      self%closing = self%closing/(self%x_old - self%x)
      do j = 1, k + 1
        self%closing = self%closing - weights(j)*self%phi(:, j)
      end do
      self%closing = self%closing/weights(k + 2)
      self%closed = .true.
    end associate
  end subroutine close_polynomial

  !> In the interpolant's derivative, the sum of phi_i N_i, no Newton polynomial N_i is beyond 1 within the step, so that it
  !> is within the sum of the |phi_i|, i > 1, of a constant; what closes the polynomial changes y by less than the last
  !> correction, h g_k+1 (f_n+1 - f_predicted), which it makes good.
  pure real(dp) function straying(self, component)
    class(adams_t), intent(in) :: self
    integer, intent(in) :: component
    integer :: j
    straying = 0
    do j = 2, self%k_old + 1
      straying = straying + abs(self%phi(component, j))
    end do
    straying = (self%x - self%x_old)*(0.5_dp*straying + &
      abs(self%coefficients%g(self%k_old + 1)*(self%phi(component, 1) - self%f_predicted(component))))
  end function straying

  pure subroutine bernstein_form(self, component, coefficients, degree)
    class(adams_t), intent(inout) :: self
    integer, intent(in) :: component
    real(dp), intent(out) :: coefficients(0:)
    integer, intent(out) :: degree
    real(dp) :: low(highest_order + 1), high(highest_order + 1), h
    integer :: j, k

    if (.not. self%closed) call close_polynomial(self)
    k = self%k_old
    h = self%x - self%x_old
    high(1) = 0   ! factors of the Newton polynomials: (x - x_n+2-j)/psi_j
    low(1) = -h/self%coefficients%psi(1)
    do j = 2, k + 1
      associate (psi => self%coefficients%psi)
        high(j) = psi(j - 1)/psi(min(j, k))
        low(j) = (psi(j - 1) - h)/psi(min(j, k))
      end associate
    end do
    degree = k + 2
    coefficients(:degree) = integral(self%y_old(component), h, &
      from_newton([self%phi(component, :k + 1), self%closing(component)], low(:k + 1), high(:k + 1)))
  end subroutine bernstein_form

  pure real(dp) function time_at_share(self, share)
    class(adams_t), intent(in) :: self
    real(dp), intent(in) :: share
    time_at_share = time_at(self, self%x_old + share*(self%x - self%x_old))
  end function time_at_share
end module adams
