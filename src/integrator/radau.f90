!> Radau IIA collocation of 3, 5 and 7 stages (orders 5, 9, 13) for stiff phases (Hairer & Wanner 1996, IV.8; variable
!> order: Hairer & Wanner 1999).
!>
!> Each step is solved by `collocation`. Where that does not converge, or leaves the model, the step is halved.
module radau
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, step_admitted, step_too_deep
  use ode_method, only: ode_method_t, step_done, step_too_small, tolerance_too_small, start_outside, left_domain, &
    step_statistics_t
  use archive, only: archive_t
  use collocation, only: collocation_t, most_iterations, n_formulas, newton_converged, newton_diverged, newton_outside
  implicit none
  private
  public :: radau_t

  !> Reasons to try a step again, besides those of Newton's method.
  integer, parameter :: try_accepted = newton_converged, try_outside = newton_outside
  integer, parameter :: try_error = 11, try_too_deep = 12

  real(dp), parameter :: tight_tolerance = 5e-9_dp   !! from here on 7 stages
  real(dp), parameter :: safety = 0.9_dp
  real(dp), parameter :: largest_growth = 8, largest_cut = 5   !! of the step size, as factors
  integer, parameter :: cautious_steps = 8           !! after a step without convergence, and
  real(dp), parameter :: cautious_growth = 1.3_dp    !! how fast the steps may then grow
  real(dp), parameter :: keep_jacobian_below = 1e-3_dp   !! contraction of Newton's method

  type, extends(ode_method_t) :: radau_t
    private
    type(collocation_t) :: stages
    integer :: highest = n_formulas        !! highest formula allowed
    integer :: weighted = 1                !! components that take part in the error control
    real(dp) :: h = 0                      !! size of the next step
    real(dp) :: h_last = 0                 !! size of the last accepted step
    real(dp) :: error_done = 0             !! its error
    integer :: since_change = 0            !! steps since the formula was changed
    logical :: fresh_jacobian = .false.    !! the Jacobian is that of the present point
    logical :: failed = .false.            !! the last try was rejected
    integer :: cautious = 0                !! steps for which the step size grows slowly, after one without convergence
    logical :: first = .true.              !! no step since the start
    real(dp), allocatable :: y_try(:), y_new(:), f_new(:), error(:)
  contains
    procedure :: prepare
    procedure :: spectral_bound
    procedure :: damping_rate
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: bernstein_form
    procedure :: land_on
    procedure :: exchange
  end type radau_t

contains

  subroutine start(self, problem, t, y, first, status)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: first
    integer, intent(out) :: status
    logical :: inside

    if (first .or. .not. allocated(self%error)) call prepare(self, problem)
    if (first) self%statistics = step_statistics_t()
    self%t = t
    self%t_old = t
    self%y = y
    self%y_old = y
    self%order = 0
    self%statistics%evaluations = self%statistics%evaluations + 1
    if (.not. first) self%statistics%restarts = self%statistics%restarts + 1
    call problem%derivatives(t, self%y, self%f, inside)
    status = merge(step_done, start_outside, inside)
    if (.not. inside) return
    self%stages%stages_done = 0
    self%first = .true.
    self%failed = .false.
    self%fresh_jacobian = .false.
    self%since_change = 0
    self%cautious = 0
    self%stages%trust = 1
    self%stages%level = first_level(self)
    call weigh(self)
    call choose_first_step(self, problem)
  end subroutine start

  !> Allocate everything, once for a whole integration.
  subroutine prepare(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer :: n

    call self%stages%prepare(problem)
    n = problem%n
    self%highest = 1
    if (self%settings%max_order >= 9) self%highest = 2
    if (self%settings%max_order >= 12) self%highest = 3
    if (allocated(self%error)) deallocate (self%y_try, self%y_new, self%f_new, self%error, self%y, self%y_old, self%f)
    allocate (self%y_try(n), self%y_new(n), self%f_new(n), self%error(n), self%y(n), self%y_old(n), self%f(n))
  end subroutine prepare

  !> All components but those that `prepare` sets and those in which a step works.
  subroutine exchange(self, problem, archive)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    type(archive_t), intent(inout) :: archive
    if (archive%is_reading) call prepare(self, problem)
    call self%exchange_solution(problem, archive)
    call self%stages%exchange(archive)
    call archive%exchange(self%h)
    call archive%exchange(self%h_last)
    call archive%exchange(self%error_done)
    call archive%exchange(self%since_change)
    call archive%exchange(self%fresh_jacobian)
    call archive%exchange(self%failed)
    call archive%exchange(self%cautious)
    call archive%exchange(self%first)
  end subroutine exchange

  !> An upper bound of the rate of the fastest mode of the last Jacobian: the norm of a_v and the root of that of a_p, in the
  !> weights of the error.
  pure real(dp) function spectral_bound(self)
    class(radau_t), intent(in) :: self
    real(dp) :: most_v, most_p
    call self%stages%jacobian_norms(most_v, most_p)
    spectral_bound = max(most_v, sqrt(most_p))
  end function spectral_bound

  !> The same of the damping alone, a_v, at (t, y): how stiff a phase is that begins there. Takes one Jacobian.
  subroutine damping_rate(self, problem, t, y, rate)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: rate
    real(dp) :: unused
    self%y = y
    call weigh(self)
    self%statistics%jacobians = self%statistics%jacobians + 1
    call problem%jacobian(t, y, self%stages%a_p, self%stages%a_v)
    call self%stages%jacobian_norms(rate, unused)
  end subroutine damping_rate

  !> The formula to start with: the looser the tolerance the lower.
  pure integer function first_level(self)
    class(radau_t), intent(in) :: self
    real(dp) :: tolerance
    tolerance = working_tolerance(self)
    first_level = 2
    if (tolerance > 1e-4_dp) first_level = 1
    if (tolerance < tight_tolerance) first_level = 3
    first_level = min(first_level, self%highest)
  end function first_level

  !> The tolerance to work with: none looser than `loosest`, since the errors of the stages then throw Newton's method from
  !> one side of a film's bend to the other, and a looser tolerance costs more (simulation V: 14,000 to 240,000
  !> evaluations at 1e-2, 8,500 at 1e-3).
  pure real(dp) function working_tolerance(self)
    class(radau_t), intent(in) :: self
    real(dp), parameter :: loosest = 1e-3_dp
    working_tolerance = min(self%nominal_tolerance(), loosest)
  end function working_tolerance

  !> The error estimate of s stages is of order s, the formula of order 2s-1: what a tolerance asks of the
  !> estimate is 0.1 tolerance^((s+1)/2s) (Hairer & Wanner). In a stiff film the order is not reached, which shows at tight
  !> tolerances: there the exponent is 3/4 at least, which keeps the error of the smooth simulations near the tolerance.
  pure real(dp) function inner_tolerance(tolerance, stages)
    real(dp), intent(in) :: tolerance
    integer, intent(in) :: stages
    real(dp) :: exponent_of
    exponent_of = (stages + 1)/(2.0_dp*stages)
    if (tolerance < tight_tolerance) exponent_of = max(exponent_of, 0.75_dp)
    inner_tolerance = 0.1_dp*tolerance**exponent_of
  end function inner_tolerance

  pure subroutine weigh(self)
    class(radau_t), intent(inout) :: self
    real(dp) :: factor, weight
    integer :: i
    factor = inner_tolerance(working_tolerance(self), self%stages%stages())/self%nominal_tolerance()
    do i = 1, size(self%y)
      weight = factor*(self%settings%relative(i)*abs(self%y(i)) + self%settings%absolute(i))
      self%stages%inverse_weight(i) = 0
      if (weight > 0) self%stages%inverse_weight(i) = 1/weight
    end do
    self%weighted = max(1, count(self%stages%inverse_weight > 0))
  end subroutine weigh

  !> Root mean square over the components that take part in the error control.
  pure real(dp) function scaled_norm(self, x)
    class(radau_t), intent(in) :: self
    real(dp), intent(in) :: x(:)
    scaled_norm = sqrt(sum((x*self%stages%inverse_weight)**2)/self%weighted)
  end function scaled_norm

  !> First step from the sizes of y, y' and y'' (Hairer, Norsett & Wanner 1993, II.4).
  subroutine choose_first_step(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp) :: longest, h, size_y, slope, curvature
    logical :: inside
    integer :: tries, order

    order = self%stages%stages()
    longest = min(self%settings%max_step, self%settings%span)
    size_y = scaled_norm(self, self%y)
    slope = scaled_norm(self, self%f(:size(self%y)))
    h = 1e-6_dp*longest
    if (slope > 0 .and. size_y > 0) h = min(0.01_dp*size_y/slope, longest)
    do tries = 1, 60
      self%y_try = self%y + h*self%f(:size(self%y))
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + h, self%y_try, self%f_new, inside)
      if (inside) exit
      h = 0.1_dp*h
    end do
    curvature = 0
    if (inside) curvature = scaled_norm(self, self%f_new(:size(self%y)) - self%f(:size(self%y)))/h
    self%h = 100*h
    if (max(slope, curvature) > 0) self%h = min(self%h, (0.01_dp/max(slope, curvature))**(1.0_dp/(order + 1)))
    self%h = min(self%h, longest)
  end subroutine choose_first_step

  subroutine step(self, problem, status)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    real(dp) :: error, fraction
    integer :: outcome

    outcome = try_accepted
    call weigh(self)
    call meet_stop_time(self)
    if (inner_tolerance(working_tolerance(self), self%stages%stages()) < 20*epsilon(1.0_dp)) then
      status = tolerance_too_small
      return
    end if
    do
      if (self%h < 4*epsilon(1.0_dp)*max(abs(self%t), 1e-9_dp*self%settings%span)) then
        status = merge(left_domain, step_too_small, outcome == try_outside)
        return
      end if
      call attempt(self, problem, error, outcome, fraction)
      if (outcome == try_accepted) exit
      call retreat(self, outcome, error, fraction)
    end do
    call accept(self)
    call choose_step(self, error)
    call choose_formula(self)
    status = step_done
  end subroutine step

  !> Let the last step, or the last two, end where the integration does.
  pure subroutine meet_stop_time(self)
    class(radau_t), intent(inout) :: self
    real(dp) :: left
    left = self%settings%stop_time - self%t
    if (.not. left > 0) return
    if (self%h >= left*(1 - 1e-9_dp)) then
      self%h = left
    else if (self%h > 0.5_dp*left) then
      self%h = 0.5_dp*left
    end if
  end subroutine meet_stop_time

  !> Jacobian, decompositions, Newton's method, error estimate, the problem's verdict, f at the end.
  subroutine attempt(self, problem, error, outcome, fraction)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(out) :: error
    integer, intent(out) :: outcome
    real(dp), intent(out) :: fraction
    integer :: verdict
    logical :: inside

    error = 0
    fraction = 0.5_dp
    if (.not. self%fresh_jacobian .and. (self%first .or. self%failed .or. self%stages%contraction > keep_jacobian_below)) then
      call problem%jacobian(self%t, self%y, self%stages%a_p, self%stages%a_v)
      self%statistics%jacobians = self%statistics%jacobians + 1
      self%fresh_jacobian = .true.
    end if
    call set_out(self, self%t, self%y, self%h)
    call self%stages%solve_stages(problem, .true., outcome)
    if (outcome == newton_diverged) call try_other_jacobian(self, problem, outcome)
    call collect(self)
    if (outcome /= try_accepted) return
    self%y_new = self%y + self%stages%z_new(:, self%stages%stages())
    call estimate_error(self, problem, error)
    if (.not. error < 1) then
      outcome = try_error
      return
    end if
    call problem%judge_step(self%t, self%y, self%t + self%h, self%y_new, verdict, fraction)
    if (verdict /= step_admitted) then
      outcome = merge(try_too_deep, try_outside, verdict == step_too_deep)
      return
    end if
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t + self%h, self%y_new, self%f_new, inside)
    if (.not. inside) outcome = try_outside
  end subroutine attempt

  !> Newton's method diverged: the force may be far stiffer where it went than where its Jacobian is from (a film that the pin
  !> leaves hardly resists, one that it approaches does). Once more with the Jacobian from there, with which the
  !> iteration contracts on both sides.
  subroutine try_other_jacobian(self, problem, outcome)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(inout) :: outcome
    logical :: inside

    self%fresh_jacobian = .false.
    self%y_try = self%y + self%stages%z_new(:, self%stages%stages())
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t + self%h, self%y_try, self%f_new, inside)
    if (.not. inside) return
    call problem%jacobian(self%t + self%h, self%y_try, self%stages%a_p, self%stages%a_v)
    self%statistics%jacobians = self%statistics%jacobians + 1
    self%stages%trust = 1
    call self%stages%solve_stages(problem, .true., outcome)
  end subroutine try_other_jacobian

  !> Set out for a step of size h from (t, y).
  pure subroutine set_out(self, t, y, h)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: t, y(:), h
    self%stages%t = t
    self%stages%base = y
    self%stages%h = h
    self%stages%goal = newton_goal(self)
  end subroutine set_out

  !> Enter the evaluations of the stages into the statistics.
  pure subroutine collect(self)
    class(radau_t), intent(inout) :: self
    self%statistics%evaluations = self%statistics%evaluations + self%stages%evaluations
    self%stages%evaluations = 0
  end subroutine collect

  !> How small the rest of Newton's iteration must be, relative to the inner tolerance.
  pure real(dp) function newton_goal(self)
    class(radau_t), intent(in) :: self
    real(dp) :: tolerance, s
    s = self%stages%stages()
    tolerance = inner_tolerance(working_tolerance(self), self%stages%stages())
    newton_goal = max(10*epsilon(1.0_dp)/tolerance, min(0.03_dp, tolerance**(2*s/(s + 1) - 1)))
  end function newton_goal

  !> (I - h/gamma J)^-1 (h/gamma f_0 + sum e_i z_i), the difference to an embedded formula of order s, filtered. After
  !> a start or a rejection it is filtered once more where it is too large.
  subroutine estimate_error(self, problem, error)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(out) :: error
    logical :: inside

    call self%stages%filtered_error(self%f, self%error)
    error = scaled_norm(self, self%error)
    if (error < 1 .or. .not. (self%first .or. self%failed)) return
    self%y_try = self%y + self%error
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t, self%y_try, self%f_new, inside)
    if (.not. inside) return
    call self%stages%filtered_error(self%f_new, self%error)
    error = scaled_norm(self, self%error)
  end subroutine estimate_error

  !> Shorten the step after a try that failed.
  pure subroutine retreat(self, outcome, error, fraction)
    class(radau_t), intent(inout) :: self
    integer, intent(in) :: outcome
    real(dp), intent(in) :: error, fraction
    real(dp) :: factor

    factor = 0.5_dp
    select case (outcome)
    case (try_error)
      self%statistics%rejected_error = self%statistics%rejected_error + 1
      factor = step_factor(self, error)
      if (self%first) factor = 0.1_dp
    case (try_too_deep)
      self%statistics%rejected_penetration = self%statistics%rejected_penetration + 1
      factor = fraction
    case (try_outside)
      self%statistics%rejected_domain = self%statistics%rejected_domain + 1
    case default
      self%statistics%rejected_convergence = self%statistics%rejected_convergence + 1
      self%since_change = 0
      if (self%stages%contraction > 0.8_dp .and. .not. self%first) self%stages%level = max(1, self%stages%level - 1)
    end select
    if (outcome /= try_error .and. outcome /= try_too_deep) then
      self%stages%trust = 1
      self%cautious = cautious_steps
    end if
    self%failed = .true.
    self%h = factor*self%h
    call weigh(self)
  end subroutine retreat

  !> Factor of the step size that the error asks for: less room where Newton's method needed many iterations.
  pure real(dp) function step_factor(self, error)
    class(radau_t), intent(in) :: self
    real(dp), intent(in) :: error
    real(dp) :: margin
    integer :: s
    s = self%stages%stages()
    margin = safety*min(1.0_dp, (2*most_iterations + 1.0_dp)/(2*most_iterations + self%stages%iterations))
    step_factor = margin*max(error, 1e-30_dp)**(-1.0_dp/(s + 1))
    step_factor = min(largest_growth, max(1/largest_cut, step_factor))
  end function step_factor

  pure subroutine accept(self)
    class(radau_t), intent(inout) :: self
    integer :: s
    s = self%stages%stages()
    self%t_old = self%t
    self%t = self%t + self%h
    if (abs(self%t - self%settings%stop_time) <= 4*spacing(self%t)) self%t = self%settings%stop_time
    self%y_old = self%y
    self%y = self%y_new
    self%f = self%f_new
    call self%stages%keep()
    self%order = s
    self%fresh_jacobian = .false.
    associate (count => self%statistics)
      count%accepted = count%accepted + 1
      count%stage_count(self%stages%level) = count%stage_count(self%stages%level) + 1
      count%smallest_step = min(count%smallest_step, self%h)
    end associate
  end subroutine accept

  !> The next step size: from the error, and from its change since the last step (Gustafsson).
  pure subroutine choose_step(self, error)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: error
    real(dp) :: factor, predicted
    integer :: s

    s = self%stages%stages()
    factor = step_factor(self, error)
    if (.not. self%first .and. error > 0) then
      predicted = safety*(self%h/self%h_last)*(self%error_done/error**2)**(1.0_dp/(s + 1))
      factor = min(factor, max(1/largest_cut, predicted))
    end if
    if (self%failed) factor = min(factor, 1.0_dp)
    if (self%cautious > 0) factor = min(factor, cautious_growth)
    self%cautious = max(0, self%cautious - 1)
    self%h_last = self%h
    self%error_done = max(error, 1e-2_dp)
    self%first = .false.
    self%failed = .false.
    self%h = min(factor*self%h, self%settings%max_step)
  end subroutine choose_step

  !> More stages where Newton's method contracts fast, fewer where it hardly does.
  pure subroutine choose_formula(self)
    class(radau_t), intent(inout) :: self
    real(dp), parameter :: raise_below = 2e-3_dp, lower_above = 0.8_dp
    integer, parameter :: steps_between_changes = 10

    self%since_change = self%since_change + 1
    if (self%since_change < steps_between_changes) return
    if (self%stages%contraction < raise_below .and. self%stages%level < first_level(self)) then
      self%stages%level = self%stages%level + 1
    else if (self%stages%contraction > lower_above .and. self%stages%level > 1) then
      self%stages%level = self%stages%level - 1
    else
      return
    end if
    self%since_change = 0
  end subroutine choose_formula

  !> Repeat the last step with the size that ends at t. Where that fails the interpolant serves.
  subroutine land_on(self, problem, t, y)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer :: outcome, level

    call self%interpolate(t, y)
    if (self%stages%stages_done == 0 .or. .not. t > self%t_old) return
    level = self%stages%level
    self%stages%level = self%stages%stages_done/2
    call set_out(self, self%t_old, self%y_old, t - self%t_old)
    call self%stages%solve_stages(problem, .false., outcome)
    call collect(self)
    if (outcome == newton_converged) then
      call self%stages%keep()
      y = self%y_old + self%stages%z(:, self%stages%stages_done)
      self%t = t
      self%y = y
    end if
    self%stages%level = level
  end subroutine land_on

  !> The collocation polynomial of the last step.
  pure subroutine interpolate(self, t, y)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    if (self%stages%stages_done == 0 .or. t >= self%t) then
      y = self%y
      return
    end if
    call self%stages%polynomial((t - self%t_old)/(self%t - self%t_old), y)
    y = self%y_old + y
  end subroutine interpolate

  !> From the increments at the stages, by divided differences.
  pure subroutine bernstein_form(self, component, coefficients, degree)
    class(radau_t), intent(inout) :: self
    integer, intent(in) :: component
    real(dp), intent(out) :: coefficients(0:)
    integer, intent(out) :: degree
    degree = self%stages%stages_done
    coefficients(0) = self%y(component)
    if (degree > 0) coefficients(:degree) = self%y_old(component) + self%stages%bernstein_form(component)
  end subroutine bernstein_form
end module radau
