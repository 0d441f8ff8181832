!> One step of a Radau IIA formula: the collocation stages, Newton's method for them, the filtered error estimate, and the
!> polynomial through the stages of the last step.
!>
!> The system has the structure p' = v, v' = a(t, p, v), w' = P(t, p, v). Positions p are eliminated from Newton's equations, and
!> quadratures w do not enter them. v are the rates of the positions followed by the first-order states. The unknowns are the stage
!> increments of v. In the basis that diagonalises A^-1 each real eigenvalue g requires the matrix (g/h - a_v - (h/g) a_p), and each
!> complex pair one such complex matrix, all of the size of v (Hairer & Wanner 1996, IV.8).
!>
!> If a trial state leaves the model, Newton's step is halved until it is inside.
module collocation
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use radau_coefficients, only: radau_formula_t, radau_formula, most_stages
  use small_lu, only: solve
  implicit none
  private
  public :: collocation_t, most_iterations, n_formulas
  public :: newton_converged, newton_diverged, newton_outside
  public :: guess_none, guess_ahead, guess_within

  !> Outcomes of Newton's method.
  integer, parameter :: newton_converged = 0   !! the stages are known
  integer, parameter :: newton_diverged = 1    !! no contraction, or a singular matrix
  integer, parameter :: newton_outside = 2     !! a trial state is outside the model

  !> Initial guesses of the stages.
  integer, parameter :: guess_none = 0     !! no change
  integer, parameter :: guess_ahead = 1    !! the polynomial of the last step, beyond its end
  integer, parameter :: guess_within = 2   !! the same inside the last step, which is repeated in part

  integer, parameter :: most_pairs = 3         !! largest number of pairs of complex eigenvalues
  integer, parameter :: n_formulas = 3         !! formulas of 3, 5 and 7 stages
  integer, parameter :: most_iterations = 10   !! largest number of iterations in a step
  integer, parameter :: most_halvings = 8      !! largest number of halvings of a Newton step that leaves the model

  type :: collocation_t
    type(radau_formula_t) :: formula(n_formulas)
    real(dp) :: per_node(0:most_stages, n_formulas) = 0   !! reciprocal denominators of the Lagrange polynomials of its nodes
    integer :: level = 1                   !! index of the formula in use
    integer :: n = 0                       !! number of equations
    integer :: m = 0                       !! number of positions: y(1:m)
    integer :: k = 0  !! number of rates and first-order states: y(m+1:m+k); the first m are the rates of the positions
    real(dp) :: t = 0                      !! beginning of the step
    real(dp) :: h = 0                      !! its size
    real(dp) :: goal = 0                   !! required remainder of Newton's iteration, in the norm of the weights
    real(dp) :: rounding = 0               !! size of a Newton step that is only rounding, in the same norm
    real(dp), allocatable :: base(:)       !! y at the beginning of the step, (n)
    real(dp), allocatable :: inverse_weight(:)   !! weights of the error norm, (n)
    integer :: evaluations = 0             !! evaluations of the right-hand side, to be collected by the owner
    real(dp) :: contraction = 0            !! contraction of Newton's method in the last trial
    integer :: iterations = 0              !! number of iterations in the last trial
    integer :: stages_done = 0             !! number of stages of the last accepted step, 0 after a start
    real(dp) :: h_done = 0                 !! its size
    real(dp), allocatable :: z(:, :)       !! increments of y at the stages of the last accepted step, (n, most_stages)
    real(dp), allocatable :: z_new(:, :)   !! the same for the present trial
    real(dp), allocatable :: a_p(:, :), a_v(:, :)   !! Jacobian, (k, m) and (k, k)
    real(dp), allocatable, private :: w(:, :), dw(:, :), rates(:, :)   !! (k, most_stages)
    real(dp), allocatable, private :: f_stage(:, :) !! right-hand side at the stages, (n, most_stages)
    real(dp), allocatable, private :: y_stage(:, :) !! (n, most_stages)
    real(dp), private :: tau = 0                    !! time constant of the matrix in e1 after a step; 0: it belongs to the step
    real(dp), allocatable, private :: defect(:), correction(:)   !! in `improve`, (m + k)
    real(dp), allocatable, private :: step_weight(:) !! weights of a Newton step, including its effect on the positions, (k)
    real(dp), allocatable, private :: e1(:, :)      !! real matrix, (k, k)
    real(dp), allocatable, private :: e2(:, :, :)   !! complex matrices, real and imaginary parts alternating, (k, k, 2 pairs)
    integer, allocatable, private :: pivot1(:), pivot2(:, :)
  contains
    procedure :: prepare
    procedure :: stages
    procedure :: solve_stages
    procedure :: settle_quadratures
    procedure :: keep
    procedure :: filtered_error
    procedure :: polynomial
    procedure :: improve
    procedure :: fastest_rate
  end type collocation_t

  interface
    !> Increment of y along the last step at its fraction x: the collocation polynomial.
    pure module subroutine polynomial(self, x, change)
      class(collocation_t), intent(in) :: self
      real(dp), intent(in) :: x
      real(dp), intent(out) :: change(:)   !! (n)
    end subroutine polynomial

    !> Rate of change of the first components of y along it, per step.
    pure module subroutine polynomial_slope(self, x, slope)
      class(collocation_t), intent(in) :: self
      real(dp), intent(in) :: x
      real(dp), intent(out) :: slope(:)
    end subroutine polynomial_slope

    !> Improve a state y of this polynomial u between the ends of the step, where f is the right-hand side. Between its nodes u'
    !> differs from f(u) by d, and the error e of u obeys e' = J e + d. Its stiff part follows d at once, e = -J^-1 d. The other
    !> part is the integral of d, which nearly vanishes from node to node; it remains. Both are
    !>
    !>     e = (I - F) F tau d,   F = (I - tau J)^-1,   tau = min(x h, h/gamma),
    !>
    !> with the Jacobian of the step. Positions, whose errors matter little, remain. So does the whole state if the error of a
    !> position would exceed the inner tolerance: then J does not describe the defect.
    pure module subroutine improve(self, x, f, y, change)
      class(collocation_t), intent(inout) :: self
      real(dp), intent(in) :: x
      real(dp), intent(in) :: f(:)         !! (n)
      real(dp), intent(inout) :: y(:)      !! (n)
      real(dp), intent(out) :: change      !! largest change of a rate or state, in tolerances; 0: y remains
    end subroutine improve

    !> Replace x by (I - tau J)^-1 x, from the decomposed matrix 1/tau - a_v - tau a_p.
    pure module subroutine filter(k, m, tau, per_tau, a_p, matrix, pivot, x)
      integer, value :: k, m
      real(dp), intent(in) :: tau, per_tau   !! and 1/tau
      real(dp), intent(in) :: a_p(k, m), matrix(k, k)
      integer, intent(in) :: pivot(k)
      real(dp), intent(inout) :: x(m + k)
    end subroutine filter

    !> Compute and factorise the matrices of Newton's equations for the present step size.
    pure module subroutine decompose_matrices(self, singular)
      class(collocation_t), intent(inout) :: self
      logical, intent(out) :: singular
    end subroutine decompose_matrices

    !> Initial guess of the rate increments at the stages from the last step's polynomial. The step begins at the end of the last
    !> step if it is `ahead`, otherwise at its beginning.
    pure module subroutine guess_stages(self, ahead)
      class(collocation_t), intent(inout) :: self
      logical, intent(in) :: ahead
    end subroutine guess_stages

    !> Simplified Newton iteration for the stage increments. It contracts as slowly as the slower of two norms, of its steps and of
    !> the defects: steps are small also where the equations are far from solved, if the Jacobian is much stiffer than the
    !> forces (a corner of a skirt whose strong damping ends, since it never pulls). A single iteration, which does not measure
    !> the contraction, is believed only if the defect before it is small.
    module subroutine iterate(self, problem, outcome)
      class(collocation_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      integer, intent(out) :: outcome
    end subroutine iterate

    !> The increments of quadratures are computed from rates before the last Newton step, which changes only the remainder of the
    !> iteration. If the rate at the end of the step, now known in `f_end`, shows that this changes them by more than a fraction of
    !> the inner tolerance (in a film so thin that its force doubles within the tolerance of the eccentricity), they are computed
    !> again.
    module subroutine settle_quadratures(self, problem, f_end)
      class(collocation_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: f_end(:)   !! (n)
    end subroutine settle_quadratures

    !> y(:, i) = factor sum_j matrix(i, j) x(:, j) over the stages, for the first `rows` rows.
    pure module subroutine combine(rows, stages, factor, matrix, x, first_x, y, first_y)
      integer, value :: rows, stages, first_x, first_y
      real(dp), intent(in) :: factor, matrix(stages, stages), x(first_x, *)
      real(dp), intent(inout) :: y(first_y, *)
    end subroutine combine
  end interface

contains

  !> Allocate all arrays, once for a whole integration.
  subroutine prepare(self, problem)
    class(collocation_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer :: n, m, k, i

    n = problem%n
    m = problem%n_positions
    k = m + problem%n_states()
    self%n = n
    self%m = m
    self%k = k
    do i = 1, n_formulas
      self%formula(i) = radau_formula(2*i + 1)
      self%per_node(:, i) = inverse_node_products(self%formula(i))
    end do
    if (allocated(self%z)) deallocate (self%z, self%z_new, self%w, self%dw, self%rates, self%f_stage, self%y_stage, &
      self%step_weight, self%base, self%a_p, self%a_v, self%e1, self%e2, self%pivot1, self%pivot2, self%inverse_weight, &
      self%defect, self%correction)
    allocate (self%z(n, most_stages), self%z_new(n, most_stages), self%w(k, most_stages), self%dw(k, most_stages), &
      self%rates(k, most_stages), self%f_stage(n, most_stages), self%y_stage(n, most_stages), self%step_weight(k), self%base(n), &
      self%a_p(k, m), self%a_v(k, k), self%e1(k, k), self%e2(k, k, 2*most_pairs), self%pivot1(k), &
      self%pivot2(k, most_pairs), self%inverse_weight(n), self%defect(m + k), self%correction(m + k))
    self%tau = 0
    self%z = 0
    self%z_new = 0     ! quadratures are computed at the end of a step only
    self%y_stage = 0
    self%w = 0    ! columns beyond the stages in use are included in halvings
    self%dw = 0
  end subroutine prepare

  !> Number of stages of the formula in use.
  pure integer function stages(self)
    class(collocation_t), intent(in) :: self
    stages = self%formula(self%level)%stages
  end function stages

  !> Solve for the stages of the step of size h from (t, base), with the Jacobian in a_p and a_v, and one of the initial guesses.
  subroutine solve_stages(self, problem, guess, outcome)
    class(collocation_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: guess
    integer, intent(out) :: outcome
    logical :: singular

    outcome = newton_diverged
    call decompose_matrices(self, singular)
    if (singular) return
    if (guess /= guess_none .and. self%stages_done > 0) then
      call guess_stages(self, guess == guess_ahead)
      call iterate(self, problem, outcome)
      if (outcome /= newton_outside) return   ! otherwise the initial guess may be outside
    end if
    self%w = 0
    call iterate(self, problem, outcome)
  end subroutine solve_stages

  !> Accept the trial: its stages become those of the last step.
  pure subroutine keep(self)
    class(collocation_t), intent(inout) :: self
    real(dp), allocatable :: earlier(:, :)
    call move_alloc(self%z, earlier)
    call move_alloc(self%z_new, self%z)
    call move_alloc(earlier, self%z_new)
    self%stages_done = self%stages()
    self%h_done = self%h
    self%tau = 0
  end subroutine keep

  !> An upper bound of the rate of the fastest mode of the last Jacobian: the row-sum norm of a_v and the square root of that of
  !> a_p, with the weights of the rates.
  pure real(dp) function fastest_rate(self)
    class(collocation_t), intent(in) :: self
    real(dp) :: most_v, most_p, size_of(self%m + self%k)
    integer :: i
    size_of = 1/max(self%inverse_weight(:self%m + self%k), tiny(most_v))
    size_of(:self%m) = size_of(self%m + 1:2*self%m)   ! positions are scaled as rates, since a_p has the dimension of a rate squared
    most_v = 0
    most_p = 0
    do i = 1, self%k
      associate (weight => self%inverse_weight(self%m + i))
        most_v = max(most_v, weight*sum(abs(self%a_v(i, :))*size_of(self%m + 1:)))
        most_p = max(most_p, weight*sum(abs(self%a_p(i, :))*size_of(:self%m)))
      end associate
    end do
    fastest_rate = max(most_v, sqrt(most_p))
  end function fastest_rate

  !> Reciprocal product of the distances of each node 0, c_1, ..., c_s from the others.
  pure function inverse_node_products(formula) result(per_node)
    type(radau_formula_t), intent(in) :: formula
    real(dp) :: per_node(0:most_stages), node(0:most_stages)
    integer :: i, j
    node(0) = 0
    node(1:formula%stages) = formula%c
    per_node = 1
    do i = 0, formula%stages
      do j = 0, formula%stages
        if (j /= i) per_node(i) = per_node(i)/(node(i) - node(j))
      end do
    end do
  end function inverse_node_products

  !> (I - h/gamma J)^-1 (h/gamma f_0 + sum e_i z_i): the filtered difference from an embedded formula of order s.
  pure subroutine filtered_error(self, f_0, error)
    class(collocation_t), intent(in) :: self
    real(dp), intent(in) :: f_0(:)
    real(dp), intent(out), contiguous :: error(:)   !! (n)
    integer :: i
    associate (formula => self%formula(self%level))
      error = (self%h/formula%gamma)*f_0(:self%n)
      do i = 1, formula%stages
        error = error + formula%e(i)*self%z_new(:, i)
      end do
      call filter(self%k, self%m, self%h/formula%gamma, formula%gamma/self%h, self%a_p, self%e1, self%pivot1, error)
    end associate
  end subroutine filtered_error
end module collocation
