!> Radau IIA collocation of 3, 5 and 7 stages (orders 5, 9, 13) for stiff phases (Hairer & Wanner 1996, IV.8; variable
!> order: Hairer & Wanner 1999).
!>
!> The system has the structure p' = v, v' = a(t, p, v), w' = P(t, p, v): positions are eliminated from Newton's
!> equations, and quadratures w take no part in them. The unknowns are the stage increments Z of v; in the basis that
!> diagonalises A^-1 each real eigenvalue g needs (g/h - a_v - (h/g) a_p) and each complex pair one such complex matrix,
!> all of the size of v.
!>
!> Where a trial state leaves the model, Newton's step is halved until it stays inside; where that does not help the step
!> is.
module radau
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, step_admitted, step_too_deep
  use ode_method, only: ode_method_t, step_done, step_too_small, tolerance_too_small, start_outside, step_statistics_t
  use radau_coefficients, only: radau_formula_t, radau_formula, most_stages
  use small_lu, only: decompose, solve
  implicit none
  private
  public :: radau_t

  !> Reasons to try a step again.
  integer, parameter :: try_accepted = 0, try_error = 1, try_outside = 2, try_too_deep = 3, try_diverged = 4

  integer, parameter :: most_pairs = 3               !! of complex eigenvalues
  integer, parameter :: n_formulas = 3               !! of 3, 5 and 7 stages
  integer, parameter :: most_iterations = 10         !! of Newton's method in a step
  integer, parameter :: most_halvings = 8            !! of one Newton step that leaves the model
  real(dp), parameter :: safety = 0.9_dp
  real(dp), parameter :: largest_growth = 8, largest_cut = 5   !! of the step size, as factors
  integer, parameter :: cautious_steps = 8           !! after a step without convergence, and
  real(dp), parameter :: cautious_growth = 1.3_dp    !! how fast the steps may then grow
  real(dp), parameter :: keep_jacobian_below = 1e-3_dp         !! contraction of Newton's method

  type, extends(ode_method_t) :: radau_t
    private
    type(radau_formula_t) :: formula(n_formulas)
    integer :: level = 1                   !! formula in use
    integer :: highest = n_formulas        !! highest formula allowed
    integer :: n = 0                       !! equations
    integer :: m = 0                       !! positions: y(1:m)
    integer :: k = 0                       !! rates: y(m+1:m+k); the first m are those of the positions
    real(dp) :: h = 0                      !! size of the next step
    real(dp) :: h_done = 0                 !! size of the last accepted step
    real(dp) :: error_done = 0             !! its error
    integer :: stages_done = 0             !! stages of the last accepted step, 0 after a start
    integer :: since_change = 0            !! steps since the formula was changed
    logical :: fresh_jacobian = .false.    !! the Jacobian is that of the present point
    logical :: failed = .false.            !! the last try was rejected
    integer :: cautious = 0                !! steps for which the step size grows slowly, after one without convergence
    logical :: first = .true.              !! no step since the start
    real(dp) :: contraction = 0            !! of Newton's method in the last try
    real(dp) :: trust = 1                  !! contraction/(1 - contraction): what is left of a Newton step
    integer :: iterations = 0              !! in the last try
    real(dp), allocatable :: z(:, :)       !! increments of y at the stages, (n, most_stages); of the last step
    real(dp), allocatable :: z_new(:, :)   !! of the try
    real(dp), allocatable :: w(:, :), dw(:, :), rates(:, :)      !! (k, most_stages)
    real(dp), allocatable :: f_stage(:, :) !! right-hand side at the stages, (n + n_outputs, most_stages)
    real(dp), allocatable :: y_stage(:), y_new(:), f_new(:), error(:)
    real(dp), allocatable :: a_p(:, :), a_v(:, :)                !! Jacobian, (k, m) and (k, k)
    real(dp), allocatable :: e1(:, :)                            !! real matrix, (k, k)
    complex(dp), allocatable :: e2(:, :, :)                      !! complex matrices, (k, k, pairs)
    complex(dp), allocatable :: right(:)
    integer, allocatable :: pivot1(:), pivot2(:, :)
    real(dp), allocatable :: inverse_weight(:)                   !! (n)
  contains
    procedure :: prepare
    procedure :: spectral_bound
    procedure :: damping_rate
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: land_on
  end type radau_t

contains

  subroutine start(self, problem, t, y, first, status)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: first
    integer, intent(out) :: status
    logical :: inside

    if (first .or. .not. allocated(self%z)) call prepare(self, problem)
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
    self%stages_done = 0
    self%first = .true.
    self%failed = .false.
    self%fresh_jacobian = .false.
    self%since_change = 0
    self%cautious = 0
    self%trust = 1
    self%level = first_level(self)
    call weigh(self)
    call choose_first_step(self, problem)
  end subroutine start

  !> Allocate everything, once for a whole integration.
  subroutine prepare(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer :: n, m, k, i

    n = problem%n
    m = problem%n_positions
    k = n - m - problem%n_quadratures
    self%n = n
    self%m = m
    self%k = k
    do i = 1, n_formulas
      self%formula(i) = radau_formula(2*i + 1)
    end do
    self%highest = 1
    if (self%settings%max_order >= 9) self%highest = 2
    if (self%settings%max_order >= 12) self%highest = 3
    if (allocated(self%z)) deallocate (self%z, self%z_new, self%w, self%dw, self%rates, self%f_stage, self%y_stage, &
      self%y_new, self%f_new, self%error, self%a_p, self%a_v, self%e1, self%e2, self%right, self%pivot1, self%pivot2, &
      self%inverse_weight, self%y, self%y_old, self%f)
    allocate (self%z(n, most_stages), self%z_new(n, most_stages), self%w(k, most_stages), self%dw(k, most_stages), &
      self%rates(k, most_stages), self%f_stage(n + problem%n_outputs, most_stages), self%y_stage(n), self%y_new(n), &
      self%f_new(n + problem%n_outputs), self%error(n), self%a_p(k, m), self%a_v(k, k), self%e1(k, k), &
      self%e2(k, k, most_pairs), self%right(k), self%pivot1(k), self%pivot2(k, most_pairs), &
      self%inverse_weight(n), self%y(n), self%y_old(n), self%f(n + problem%n_outputs))
    self%z = 0
  end subroutine prepare

  !> An upper bound of the rate of the fastest mode of the last Jacobian: the norm of a_v and the root of that of a_p, in the
  !> weights of the error.
  pure real(dp) function spectral_bound(self)
    class(radau_t), intent(in) :: self
    real(dp) :: most_v, most_p
    call jacobian_norms(self, most_v, most_p)
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
    call problem%jacobian(t, y, self%a_p, self%a_v)
    call jacobian_norms(self, rate, unused)
  end subroutine damping_rate

  !> Row-sum norms of a_v and a_p in the weights of the error of the rates.
  pure subroutine jacobian_norms(self, most_v, most_p)
    class(radau_t), intent(in) :: self
    real(dp), intent(out) :: most_v, most_p
    real(dp) :: row_v, row_p
    integer :: i, j
    most_v = 0
    most_p = 0
    do i = 1, self%k
      row_v = 0
      row_p = 0
      associate (weight => self%inverse_weight(self%m + i))
        do j = 1, self%k
          row_v = row_v + abs(self%a_v(i, j))*weight/max(self%inverse_weight(self%m + j), tiny(weight))
        end do
        do j = 1, self%m   ! measured as a rate, since a_p is the square of one
          row_p = row_p + abs(self%a_p(i, j))*weight/max(self%inverse_weight(self%m + j), tiny(weight))
        end do
      end associate
      most_v = max(most_v, row_v)
      most_p = max(most_p, row_p)
    end do
  end subroutine jacobian_norms

  !> The formula to start with: the looser the tolerance the lower.
  pure integer function first_level(self)
    class(radau_t), intent(in) :: self
    real(dp) :: tolerance
    tolerance = working_tolerance(self)
    first_level = 2
    if (tolerance > 1e-4_dp) first_level = 1
    if (tolerance < 1e-9_dp) first_level = 3
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
  !> estimate is 0.1 tolerance^((s+1)/2s) (Hairer & Wanner).
  pure real(dp) function inner_tolerance(tolerance, stages)
    real(dp), intent(in) :: tolerance
    integer, intent(in) :: stages
    inner_tolerance = 0.1_dp*tolerance**((stages + 1)/(2.0_dp*stages))
  end function inner_tolerance

  pure subroutine weigh(self)
    class(radau_t), intent(inout) :: self
    real(dp) :: factor, weight
    integer :: i
    factor = inner_tolerance(working_tolerance(self), self%formula(self%level)%stages)/self%nominal_tolerance()
    do i = 1, self%n
      weight = factor*(self%settings%relative(i)*abs(self%y(i)) + self%settings%absolute(i))
      self%inverse_weight(i) = 0
      if (weight > 0) self%inverse_weight(i) = 1/weight
    end do
  end subroutine weigh

  !> Root mean square over the components.
  pure real(dp) function scaled_norm(self, x)
    class(radau_t), intent(in) :: self
    real(dp), intent(in) :: x(:)
    scaled_norm = sqrt(sum((x*self%inverse_weight)**2)/self%n)
  end function scaled_norm

  !> First step from the sizes of y, y' and y'' (Hairer, Norsett & Wanner 1993, II.4).
  subroutine choose_first_step(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp) :: longest, h, size_y, slope, curvature
    logical :: inside
    integer :: tries, order

    order = self%formula(self%level)%stages
    longest = min(self%settings%max_step, self%settings%span)
    size_y = scaled_norm(self, self%y)
    slope = scaled_norm(self, self%f(:self%n))
    h = 1e-6_dp*longest
    if (slope > 0 .and. size_y > 0) h = min(0.01_dp*size_y/slope, longest)
    do tries = 1, 60
      self%y_stage = self%y + h*self%f(:self%n)
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + h, self%y_stage, self%f_new, inside)
      if (inside) exit
      h = 0.1_dp*h
    end do
    curvature = 0
    if (inside) curvature = scaled_norm(self, self%f_new(:self%n) - self%f(:self%n))/h
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

    call weigh(self)
    call meet_stop_time(self)
    if (inner_tolerance(working_tolerance(self), self%formula(self%level)%stages) < 20*epsilon(1.0_dp)) then
      status = tolerance_too_small
      return
    end if
    do
      if (self%h < 4*epsilon(1.0_dp)*max(abs(self%t), 1e-9_dp*self%settings%span)) then
        status = step_too_small
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
    logical :: singular, inside

    error = 0
    fraction = 0.5_dp
    if (.not. self%fresh_jacobian .and. (self%first .or. self%failed .or. self%contraction > keep_jacobian_below)) then
      call problem%jacobian(self%t, self%y, self%a_p, self%a_v)
      self%statistics%jacobians = self%statistics%jacobians + 1
      self%fresh_jacobian = .true.
    end if
    outcome = try_diverged
    call decompose_matrices(self, singular)
    if (singular) return
    call guess_stages(self)
    call iterate(self, problem, outcome)
    if (outcome == try_outside .and. self%stages_done > 0) then   ! the extrapolated guess may be what is outside
      self%stages_done = 0
      call guess_stages(self)
      call iterate(self, problem, outcome)
    end if
    if (outcome == try_diverged) call try_other_jacobian(self, problem, outcome)
    if (outcome /= try_accepted) return
    associate (s => self%formula(self%level)%stages)
      self%y_new = self%y + self%z_new(:, s)
    end associate
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
    logical :: singular, inside

    self%fresh_jacobian = .false.
    self%y_stage = self%y + self%z_new(:, self%formula(self%level)%stages)
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t + self%h, self%y_stage, self%f_new, inside)
    if (.not. inside) return
    call problem%jacobian(self%t + self%h, self%y_stage, self%a_p, self%a_v)
    self%statistics%jacobians = self%statistics%jacobians + 1
    call decompose_matrices(self, singular)
    if (singular) return
    self%trust = 1
    call guess_stages(self)
    call iterate(self, problem, outcome)
  end subroutine try_other_jacobian

  !> The matrices of Newton's equations for the present step size.
  pure subroutine decompose_matrices(self, singular)
    class(radau_t), intent(inout) :: self
    logical, intent(out) :: singular
    complex(dp) :: shift
    integer :: i, j, m

    m = self%m
    associate (formula => self%formula(self%level), h => self%h)
      self%e1 = -self%a_v
      self%e1(:, :m) = self%e1(:, :m) - (h/formula%gamma)*self%a_p
      do i = 1, self%k
        self%e1(i, i) = self%e1(i, i) + formula%gamma/h
      end do
      call decompose(self%e1, self%pivot1, singular)
      if (singular) return
      do j = 1, formula%stages/2
        shift = cmplx(formula%alpha(j), -formula%beta(j), dp)/h
        self%e2(:, :, j) = -self%a_v
        self%e2(:, :m, j) = self%e2(:, :m, j) - self%a_p/shift
        do i = 1, self%k
          self%e2(i, i, j) = self%e2(i, i, j) + shift
        end do
        call decompose(self%e2(:, :, j), self%pivot2(:, j), singular)
        if (singular) return
      end do
    end associate
  end subroutine decompose_matrices

  !> Increments of the rates at the stages, from the last step's polynomial continued; 0 after a start.
  pure subroutine guess_stages(self)
    class(radau_t), intent(inout) :: self
    real(dp) :: weights(0:most_stages)
    integer :: i, j, l, s, m, k

    m = self%m
    k = self%k
    s = self%formula(self%level)%stages
    if (self%stages_done == 0) then
      self%w = 0
      return
    end if
    do i = 1, s
      call lagrange(self, self%stages_done, 1 + self%formula(self%level)%c(i)*self%h/self%h_done, weights)
      weights(self%stages_done) = weights(self%stages_done) - 1
      do l = 1, k
        self%rates(l, i) = 0
        do j = 1, self%stages_done
          self%rates(l, i) = self%rates(l, i) + weights(j)*self%z(m + l, j)
        end do
      end do
    end do
    call combine(k, s, 1.0_dp, self%formula(self%level)%t_inverse, self%rates, k, self%w, k)
  end subroutine guess_stages

  !> Lagrange polynomials at x over the nodes 0, c_1, ..., c_s of a formula.
  pure subroutine lagrange(self, stages, x, weights)
    class(radau_t), intent(in) :: self
    integer, intent(in) :: stages
    real(dp), intent(in) :: x
    real(dp), intent(out) :: weights(0:)
    real(dp) :: node(0:most_stages)
    integer :: i, j
    node(0) = 0
    node(1:stages) = self%formula(stages/2)%c
    do i = 0, stages
      weights(i) = 1
      do j = 0, stages
        if (j /= i) weights(i) = weights(i)*(x - node(j))/(node(i) - node(j))
      end do
    end do
  end subroutine lagrange

  !> Simplified Newton iteration for the stage increments. The contraction that it shows is trusted for the first
  !> iteration of the next step too.
  subroutine iterate(self, problem, outcome)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: outcome
    real(dp) :: change, last_change, ratio, last_ratio
    integer :: iteration, halvings
    logical :: inside

    last_change = 0
    last_ratio = 0
    self%trust = max(self%trust, epsilon(1.0_dp))**0.8_dp
    self%contraction = keep_jacobian_below
    outcome = try_outside
    call evaluate_stages(self, problem, inside)
    if (.not. inside) return
    do iteration = 1, most_iterations
      self%iterations = iteration
      call newton_step(self)
      change = change_norm(self)
      outcome = try_diverged
      if (.not. change < huge(change)) return
      if (last_change > 0) then
        ratio = change/last_change
        self%contraction = ratio
        if (last_ratio > 0) self%contraction = sqrt(ratio*last_ratio)
        last_ratio = ratio
        if (self%contraction >= 0.99_dp) return
        self%trust = self%contraction/(1 - self%contraction)
        if (self%trust*change*self%contraction**(most_iterations - 1 - iteration) > newton_goal(self)) return
      end if
      last_change = change
      if (self%trust*change <= newton_goal(self)) then
        call expand_stages(self, .true.)
        outcome = try_accepted
        return
      end if
      call evaluate_stages(self, problem, inside)
      do halvings = 1, most_halvings
        if (inside) exit
        self%dw = 0.5_dp*self%dw   ! half of the step just made is taken back
        self%w = self%w - self%dw
        last_change = 0
        last_ratio = 0
        self%trust = 1
        call evaluate_stages(self, problem, inside)
      end do
      outcome = try_outside
      if (.not. inside) return
    end do
    outcome = try_diverged
  end subroutine iterate

  !> How small the rest of Newton's iteration must be, relative to the inner tolerance.
  pure real(dp) function newton_goal(self)
    class(radau_t), intent(in) :: self
    real(dp) :: tolerance, s
    s = self%formula(self%level)%stages
    tolerance = inner_tolerance(working_tolerance(self), self%formula(self%level)%stages)
    newton_goal = max(10*epsilon(1.0_dp)/tolerance, min(0.03_dp, tolerance**(2*s/(s + 1) - 1)))
  end function newton_goal

  !> One Newton step: self%dw, added to self%w. The right-hand sides at the stages are those of self%w.
  subroutine newton_step(self)
    class(radau_t), intent(inout) :: self
    complex(dp) :: shift
    integer :: i, j, m, k

    m = self%m
    k = self%k
    associate (formula => self%formula(self%level), h => self%h, s => self%formula(self%level)%stages)
      call combine(k, s, 1.0_dp, formula%t_inverse, self%f_stage(m + 1, 1), size(self%f_stage, 1), self%dw, k)
      do i = 1, k
        self%dw(i, 1) = self%dw(i, 1) - (formula%gamma/h)*self%w(i, 1)
      end do
      call solve(self%e1, self%pivot1, self%dw(:, 1))
      do j = 1, s/2
        shift = cmplx(formula%alpha(j), -formula%beta(j), dp)/h
        do i = 1, k
          self%right(i) = cmplx(self%dw(i, 2*j), self%dw(i, 2*j + 1), dp) - shift*cmplx(self%w(i, 2*j), self%w(i, 2*j + 1), dp)
        end do
        call solve(self%e2(:, :, j), self%pivot2(:, j), self%right)
        do i = 1, k
          self%dw(i, 2*j) = real(self%right(i), dp)
          self%dw(i, 2*j + 1) = aimag(self%right(i))
        end do
      end do
      do j = 1, s
        do i = 1, k
          self%w(i, j) = self%w(i, j) + self%dw(i, j)
        end do
      end do
    end associate
  end subroutine newton_step

  !> Size of a Newton step relative to the inner tolerance, with what it moves the positions.
  pure real(dp) function change_norm(self)
    class(radau_t), intent(in) :: self
    real(dp) :: total, weight
    integer :: i, s
    s = self%formula(self%level)%stages
    total = 0
    do i = 1, self%k
      weight = self%inverse_weight(self%m + i)
      if (i <= self%m) weight = max(weight, self%h*self%inverse_weight(i))
      total = total + sum((self%dw(i, :s)*weight)**2)
    end do
    change_norm = sqrt(total/(s*max(self%k, 1)))
  end function change_norm

  !> Increments of all components at the stages: rates from w, positions by collocation, quadratures from the last
  !> evaluation.
  subroutine expand_stages(self, with_quadratures)
    class(radau_t), intent(inout) :: self
    logical, intent(in) :: with_quadratures
    integer :: i, j, n, m, k

    n = self%n
    m = self%m
    k = self%k
    associate (formula => self%formula(self%level), h => self%h, s => self%formula(self%level)%stages, z => self%z_new)
      call combine(k, s, 1.0_dp, formula%t, self%w, k, self%rates, k)
      do i = 1, s
        do j = 1, k
          z(m + j, i) = self%rates(j, i)
        end do
      end do
      if (m > 0) then
        call combine(m, s, h, formula%a, self%rates, k, z, n)
        do i = 1, s
          do j = 1, m
            z(j, i) = z(j, i) + h*formula%c(i)*self%y(m + j)
          end do
        end do
      end if
      if (with_quadratures .and. n > m + k) &
        call combine(n - m - k, s, h, formula%a, self%f_stage(m + k + 1, 1), size(self%f_stage, 1), z(m + k + 1, 1), n)
    end associate
  end subroutine expand_stages

  !> y(:, i) = factor sum_j matrix(i, j) x(:, j) over the stages, for the first `rows` rows.
  pure subroutine combine(rows, stages, factor, matrix, x, first_x, y, first_y)
    integer, intent(in) :: rows, stages, first_x, first_y
    real(dp), intent(in) :: factor, matrix(stages, stages), x(first_x, *)
    real(dp), intent(inout) :: y(first_y, *)
    real(dp) :: total
    integer :: i, j, r
    do i = 1, stages
      do r = 1, rows
        total = 0
        do j = 1, stages
          total = total + matrix(i, j)*x(r, j)
        end do
        y(r, i) = factor*total
      end do
    end do
  end subroutine combine

  !> Right-hand sides at the stages of self%w.
  subroutine evaluate_stages(self, problem, inside)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(out) :: inside
    integer :: i, j
    call expand_stages(self, .false.)
    inside = .true.
    do i = 1, self%formula(self%level)%stages
      do j = 1, self%n
        self%y_stage(j) = self%y(j) + self%z_new(j, i)
      end do
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + self%formula(self%level)%c(i)*self%h, self%y_stage, self%f_stage(:, i), inside)
      if (.not. inside) return
    end do
  end subroutine evaluate_stages

  !> (I - h/gamma J)^-1 (h/gamma f_0 + sum e_i z_i), the difference to an embedded formula of order s, filtered. After
  !> a start or a rejection it is filtered once more where it is too large.
  subroutine estimate_error(self, problem, error)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(out) :: error
    logical :: inside

    call filter(self, self%f)
    error = scaled_norm(self, self%error)
    if (error < 1 .or. .not. (self%first .or. self%failed)) return
    self%y_stage = self%y + self%error
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(self%t, self%y_stage, self%f_new, inside)
    if (.not. inside) return
    call filter(self, self%f_new)
    error = scaled_norm(self, self%error)
  end subroutine estimate_error

  pure subroutine filter(self, f_0)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: f_0(:)
    real(dp) :: rate(self%k)
    integer :: i, m, k
    m = self%m
    k = self%k
    associate (formula => self%formula(self%level), error => self%error)
      error = (self%h/formula%gamma)*f_0(:self%n)
      do i = 1, formula%stages
        error = error + formula%e(i)*self%z_new(:, i)
      end do
      rate = (formula%gamma/self%h)*error(m + 1:m + k)
      do i = 1, m
        rate = rate + self%a_p(:, i)*error(i)
      end do
      call solve(self%e1, self%pivot1, rate)
      error(m + 1:m + k) = rate
      error(:m) = error(:m) + (self%h/formula%gamma)*rate(:m)
    end associate
  end subroutine filter

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
      if (self%contraction > 0.8_dp .and. self%level > 1 .and. .not. self%first) self%level = self%level - 1
    end select
    if (outcome /= try_error .and. outcome /= try_too_deep) then
      self%trust = 1
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
    s = self%formula(self%level)%stages
    margin = safety*min(1.0_dp, (2*most_iterations + 1.0_dp)/(2*most_iterations + self%iterations))
    step_factor = margin*max(error, 1e-30_dp)**(-1.0_dp/(s + 1))
    step_factor = min(largest_growth, max(1/largest_cut, step_factor))
  end function step_factor

  pure subroutine accept(self)
    class(radau_t), intent(inout) :: self
    integer :: s
    s = self%formula(self%level)%stages
    self%t_old = self%t
    self%t = self%t + self%h
    if (abs(self%t - self%settings%stop_time) <= 4*spacing(self%t)) self%t = self%settings%stop_time
    self%y_old = self%y
    self%y = self%y_new
    self%f = self%f_new
    self%z(:, :s) = self%z_new(:, :s)
    self%stages_done = s
    self%order = s
    self%fresh_jacobian = .false.
    associate (count => self%statistics)
      count%accepted = count%accepted + 1
      count%stage_count(self%level) = count%stage_count(self%level) + 1
      count%smallest_step = min(count%smallest_step, self%h)
    end associate
  end subroutine accept

  !> The next step size: from the error, and from its change since the last step (Gustafsson).
  pure subroutine choose_step(self, error)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: error
    real(dp) :: factor, predicted
    integer :: s

    s = self%formula(self%level)%stages
    factor = step_factor(self, error)
    if (.not. self%first .and. error > 0) then
      predicted = safety*(self%h/self%h_done)*(self%error_done/error**2)**(1.0_dp/(s + 1))
      factor = min(factor, max(1/largest_cut, predicted))
    end if
    if (self%failed) factor = min(factor, 1.0_dp)
    if (self%cautious > 0) factor = min(factor, cautious_growth)
    self%cautious = max(0, self%cautious - 1)
    self%h_done = self%h
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
    if (self%contraction < raise_below .and. self%level < first_level(self)) then
      self%level = self%level + 1
    else if (self%contraction > lower_above .and. self%level > 1) then
      self%level = self%level - 1
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
    real(dp) :: h, t_new
    integer :: outcome, s
    logical :: singular

    call self%interpolate(t, y)
    if (self%stages_done == 0 .or. .not. t > self%t_old) return
    h = self%h
    s = self%stages_done
    self%h = t - self%t_old
    self%level = s/2
    self%y_new = self%y
    t_new = self%t
    self%y = self%y_old
    self%t = self%t_old
    call decompose_matrices(self, singular)
    outcome = try_diverged
    self%stages_done = 0
    if (.not. singular) then
      call guess_stages(self)
      call iterate(self, problem, outcome)
    end if
    self%stages_done = s
    self%y = self%y_new
    self%t = t_new
    self%h = h
    if (outcome /= try_accepted) return
    y = self%y_old + self%z_new(:, s)
    self%z(:, :s) = self%z_new(:, :s)
    self%t = t
    self%y = y
  end subroutine land_on

  !> The collocation polynomial of the last step.
  pure subroutine interpolate(self, t, y)
    class(radau_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    real(dp) :: weights(0:most_stages)
    integer :: j
    if (self%stages_done == 0 .or. t >= self%t) then
      y = self%y
      return
    end if
    call lagrange(self, self%stages_done, (t - self%t_old)/(self%t - self%t_old), weights)
    y = self%y_old
    do j = 1, self%stages_done
      y = y + weights(j)*self%z(:, j)
    end do
  end subroutine interpolate
end module radau
