!> Radau IIA collocation of 3, 5 and 7 stages (orders 5, 9, 13) for stiff phases (Hairer & Wanner 1996, IV.8; variable
!> order: Hairer & Wanner 1999).
!>
!> Each step is solved by `collocation`. If that does not converge, or leaves the model, the step is halved.
module radau
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, step_admitted, step_too_far
  use ode_method, only: ode_method_t, step_done, step_rejected, step_too_small, tolerance_too_small, left_domain
  use collocation, only: collocation_t, n_formulas, newton_converged, newton_diverged, newton_outside, guess_ahead
  implicit none
  private
  public :: radau_t

  !> Reasons to repeat a step, besides those of Newton's method.
  integer, parameter :: try_accepted = newton_converged, try_outside = newton_outside
  integer, parameter :: try_error = 11, try_too_deep = 12, try_too_far = 13

  real(dp), parameter :: tight_tolerance = 5e-9_dp   !! at smaller tolerances the formula of 7 stages is used
  real(dp), parameter :: safety = 0.9_dp
  real(dp), parameter :: largest_growth = 8, largest_cut = 5   !! factors of the step size
  integer, parameter :: cautious_steps = 8           !! number of steps after one without convergence in which
  real(dp), parameter :: cautious_growth = 1.3_dp    !! the step size may grow only by this factor
  real(dp), parameter :: keep_jacobian_below = 1e-3_dp   !! contraction of Newton's method below which the Jacobian is kept

  type, extends(ode_method_t) :: radau_t
    private
    type(collocation_t) :: stages
    integer :: highest = n_formulas        !! index of the highest formula allowed
    real(dp) :: inner_tolerance(n_formulas) = 0   !! tolerance of the error estimate of each formula
    real(dp) :: newton_goal(n_formulas) = 0       !! required remainder of Newton's iteration, relative to it
    integer :: weighted = 1                !! number of components in the error control
    real(dp) :: h = 0                      !! size of the next step
    real(dp) :: h_last = 0                 !! size of the last accepted step
    real(dp) :: error_done = 0             !! error of that step
    integer :: since_change = 0            !! number of steps since the formula was changed
    logical :: fresh_jacobian = .false.    !! the Jacobian was computed for this trial or the one before it
    integer :: cautious = 0                !! number of steps in which the step size still grows slowly
    logical :: first = .true.              !! no step since the start
    real(dp), allocatable :: f(:)                 !! right-hand side at (t, y), (n)
    real(dp), allocatable :: f_old(:)             !! the same at (t_old, y_old)
    real(dp), allocatable :: y_try(:), y_new(:), f_new(:), error(:)
  contains
    procedure :: prepare
    procedure :: fastest_rate
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: may_improve
    procedure :: improve
    procedure :: land_on
    procedure :: withdraw
  end type radau_t

  interface
    module subroutine start(self, problem, t, y, first, status)
      class(radau_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t, y(:)
      logical, intent(in) :: first
      integer, intent(out) :: status
    end subroutine start

    !> Allocate all arrays and find the tolerances, once for a whole integration.
    module subroutine prepare(self, problem)
      class(radau_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
    end subroutine prepare

    !> Repeat the last step with the size that ends at t. `landed` is false if Newton's method does not converge, also with other
    !> Jacobians, or if the error estimate is above the tolerance; y is then the interpolant.
    module subroutine land_on(self, problem, t, y, landed)
      class(radau_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t
      real(dp), intent(inout) :: y(:)
      logical, intent(out) :: landed
    end subroutine land_on

    !> Take back the last step, which then counts as one without convergence.
    module subroutine withdraw(self, problem, longest, status)
      class(radau_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: longest
      integer, intent(out) :: status
    end subroutine withdraw

    !> The first formula: fewer stages for larger tolerances.
    pure integer module function first_level(self)
      class(radau_t), intent(in) :: self
    end function first_level

    pure module subroutine weigh(self)
      class(radau_t), intent(inout) :: self
    end subroutine weigh

    !> Root mean square over the components in the error control.
    pure real(dp) module function scaled_norm(self, x)
      class(radau_t), intent(in) :: self
      real(dp), intent(in) :: x(:)
    end function scaled_norm

    !> Norm of (I - h/gamma J)^-1 (h/gamma f_0 + sum e_i z_i), the filtered difference between a trial from (t, y) and an embedded
    !> formula of order s, relative to the tolerance. If it is too large and `may_repeat`, it is filtered once more.
    module subroutine estimate_error(self, problem, t, y, f, may_repeat, error)
      class(radau_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t, y(:), f(:)   !! beginning of the trial, and the right-hand side there
      logical, intent(in) :: may_repeat
      real(dp), intent(out) :: error
    end subroutine estimate_error

    !> Prepare a step of size h from (t, y).
    pure module subroutine set_out(self, t, y, h)
      class(radau_t), intent(inout) :: self
      real(dp), intent(in) :: t, y(:), h
    end subroutine set_out

    !> Add the evaluations of the stages to the statistics.
    pure module subroutine collect(self)
      class(radau_t), intent(inout) :: self
    end subroutine collect

    !> Shorten the step after a failed trial.
    pure module subroutine retreat(self, outcome, error, fraction)
      class(radau_t), intent(inout) :: self
      integer, intent(in) :: outcome
      real(dp), intent(in) :: error, fraction
    end subroutine retreat

    !> The next step size, from the error and its change since the last step (Gustafsson).
    pure module subroutine choose_step(self, error)
      class(radau_t), intent(inout) :: self
      real(dp), intent(in) :: error
    end subroutine choose_step

    !> More stages if Newton's method contracts fast, fewer if it hardly does.
    pure module subroutine choose_formula(self)
      class(radau_t), intent(inout) :: self
    end subroutine choose_formula
  end interface

contains

  !> See `fastest_rate` of collocation_t.
  pure real(dp) function fastest_rate(self)
    class(radau_t), intent(in) :: self
    fastest_rate = self%stages%fastest_rate()
  end function fastest_rate

  subroutine step(self, problem, status)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    real(dp) :: error, fraction
    integer :: outcome

    if (.not. self%rejected) then
      call weigh(self)
      call meet_stop_time(self)
      status = step_too_small
      if (self%inner_tolerance(self%stages%level) < 20*epsilon(1.0_dp)) status = tolerance_too_small
      if (status == tolerance_too_small .or. self%h < shortest_step(self)) return
    end if
    call attempt(self, problem, error, outcome, fraction)
    if (outcome /= try_accepted) then
      call retreat(self, outcome, error, fraction)
      status = step_rejected
      if (self%h < shortest_step(self)) status = merge(left_domain, step_too_small, outcome == try_outside)
      return
    end if
    call accept(self)
    call choose_step(self, error)
    call choose_formula(self)
    status = step_done
  end subroutine step

  !> The shortest step that the time resolves.
  pure real(dp) function shortest_step(self)
    class(radau_t), intent(in) :: self
    shortest_step = 4*epsilon(1.0_dp)*max(abs(self%t), 1e-9_dp*self%settings%span)
  end function shortest_step

  !> Adjust the step size so that the last step, or the last two, end at the end of the integration.
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

  !> Jacobian, factorisations, Newton's method, error estimate, verdict of the problem, f at the end of the step.
  subroutine attempt(self, problem, error, outcome, fraction)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(out) :: error
    integer, intent(out) :: outcome
    real(dp), intent(out) :: fraction
    integer :: verdict, first
    logical :: in_domain

    error = 0
    fraction = 0.5_dp
    if (.not. self%fresh_jacobian .and. (self%first .or. self%rejected .or. self%stages%contraction > keep_jacobian_below)) &
      call find_jacobian(self, problem)
    call set_out(self, self%t, self%y, self%h)
    call self%stages%solve_stages(problem, guess_ahead, outcome)
    if (outcome == newton_diverged) call try_other_jacobian(self, problem, outcome)
    call collect(self)
    if (outcome /= try_accepted) return
    self%y_new = self%y + self%stages%z_new(:, self%stages%stages())
    call estimate_error(self, problem, self%t, self%y, self%f, self%first .or. self%rejected, error)
    if (.not. error < 1) then
      outcome = try_error
      return
    end if
    verdict = step_admitted
    if (problem%refuses_steps) call problem%judge_step(self%t, self%y, self%t + self%h, self%y_new, verdict, fraction)
    if (verdict /= step_admitted) then
      outcome = merge(try_too_far, try_too_deep, verdict == step_too_far)
      return
    end if
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t + self%h, self%y_new, self%f_new, in_domain)
    if (.not. in_domain) then
      outcome = try_outside
      return
    end if
    call self%stages%settle_quadratures(problem, self%f_new)
    call collect(self)
    first = problem%n - problem%n_quadratures + 1
    self%y_new(first:) = self%y(first:) + self%stages%z_new(first:, self%stages%stages())
  end subroutine attempt

  !> The Jacobian of a trial is evaluated at three quarters of the step, on the extrapolated polynomial of the last step: the
  !> stiffness of a film changes within a step, and with a Jacobian among the stages Newton's method contracts faster than with that
  !> of the beginning (gain: data/manual/choices.md). After a start, and if f is not defined at that point (all derivatives are
  !> 0), the Jacobian at the beginning is used.
  subroutine find_jacobian(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), parameter :: place = 0.75_dp   !! fraction of the step
    self%fresh_jacobian = .true.
    if (self%stages%stages_done > 0) then
      call self%stages%polynomial(1 + place*self%h/self%stages%h_done, self%y_try)
      self%y_try = self%y_old + self%y_try
      call problem%jacobian(self%t + place*self%h, self%y_try, self%stages%a_p, self%stages%a_v)
      self%statistics%jacobians = self%statistics%jacobians + 1
      if (any(abs(self%stages%a_v) > 0) .or. any(abs(self%stages%a_p) > 0)) return
    end if
    call problem%jacobian(self%t, self%y, self%stages%a_p, self%stages%a_v)
    self%statistics%jacobians = self%statistics%jacobians + 1
  end subroutine find_jacobian

  !> If Newton's method diverged, the force may be far stiffer at its last iterate than at the point of the Jacobian (a film hardly
  !> resists a separating pin, but an approaching one). Try again with the Jacobian at that iterate, with which the iteration
  !> contracts on both sides.
  subroutine try_other_jacobian(self, problem, outcome)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(inout) :: outcome
    logical :: in_domain

    self%fresh_jacobian = .false.
    self%y_try = self%y + self%stages%z_new(:, self%stages%stages())
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t + self%h, self%y_try, self%f_new, in_domain)
    if (.not. in_domain) return
    call problem%jacobian(self%t + self%h, self%y_try, self%stages%a_p, self%stages%a_v)
    self%statistics%jacobians = self%statistics%jacobians + 1
    call self%stages%solve_stages(problem, guess_ahead, outcome)
  end subroutine try_other_jacobian

  pure subroutine accept(self)
    class(radau_t), intent(inout) :: self
    integer :: s
    s = self%stages%stages()
    self%t_old = self%t
    self%t = self%t + self%h
    if (abs(self%t - self%settings%stop_time) <= 4*epsilon(1.0_dp)*abs(self%t)) self%t = self%settings%stop_time
    call rotate(self%y_old, self%y, self%y_new)
    call rotate(self%f_old, self%f, self%f_new)
    call self%stages%keep()
    self%order = s
    self%fresh_jacobian = .false.
    associate (count => self%statistics)
      count%accepted = count%accepted + 1
      count%stage_count(self%stages%level) = count%stage_count(self%stages%level) + 1
      count%smallest_step = min(count%smallest_step, self%h)
    end associate
  end subroutine accept

  !> Move the second array to the first, the third to the second and the first to the third, without copies of their elements.
  pure subroutine rotate(first, second, third)
    real(dp), allocatable, intent(inout) :: first(:), second(:), third(:)
    real(dp), allocatable :: oldest(:)
    call move_alloc(first, oldest)
    call move_alloc(second, first)
    call move_alloc(third, second)
    call move_alloc(oldest, third)
  end subroutine rotate

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

  pure logical function may_improve(self, t)
    class(radau_t), intent(in) :: self
    real(dp), intent(in) :: t
    may_improve = self%stages%stages_done > 0 .and. t > self%t_old .and. t < self%t
  end function may_improve

  !> See `improve` of collocation_t.
  pure subroutine improve(self, t, f, y, change)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: t, f(:)
    real(dp), intent(inout) :: y(:)
    real(dp), intent(out) :: change
    call self%stages%improve((t - self%t_old)/(self%t - self%t_old), f, y, change)
  end subroutine improve
end module radau
