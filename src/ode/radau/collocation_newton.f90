!> Newton's method for the stages of a Radau step.
submodule (collocation) collocation_newton
  use small_lu, only: decompose
  implicit none

  !> A Newton step so large, in tolerances, leads nowhere: what lies there is not evaluated, since forces and their squares may be
  !> beyond all numbers.
  real(dp), parameter :: farthest = 1e30_dp
contains

  module procedure decompose_matrices
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
  end procedure decompose_matrices

  module procedure iterate
    real(dp) :: change, last_change, ratio, last_ratio
    integer :: iteration, halvings
    logical :: inside

    last_change = 0
    last_ratio = 0
    self%trust = max(self%trust, epsilon(1.0_dp))**0.8_dp
    self%contraction = least_contraction
    outcome = newton_outside
    call evaluate_stages(self, problem, inside)
    if (.not. inside) return
    do iteration = 1, most_iterations
      self%iterations = iteration
      call newton_step(self)
      change = change_norm(self)
      outcome = newton_diverged
      if (.not. change < farthest) return
      if (last_change > 0) then
        ratio = change/last_change
        self%contraction = ratio
        if (last_ratio > 0) self%contraction = sqrt(ratio*last_ratio)
        last_ratio = ratio
        if (self%contraction >= 0.99_dp) return
        self%trust = self%contraction/(1 - self%contraction)
        if (self%trust*change*self%contraction**(most_iterations - 1 - iteration) > self%goal) return
      end if
      last_change = change
      if (self%trust*change <= self%goal) then
        call expand_stages(self, .true.)
        outcome = newton_converged
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
      outcome = newton_outside
      if (.not. inside) return
    end do
    outcome = newton_diverged
  end procedure iterate

  !> One Newton step: self%dw, added to self%w. The right-hand sides at the stages are those of self%w.
  subroutine newton_step(self)
    class(collocation_t), intent(inout) :: self
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
    class(collocation_t), intent(in) :: self
    real(dp) :: total, weight
    integer :: i, s
    s = self%formula(self%level)%stages
    change_norm = huge(change_norm)
    do i = 1, self%k
      if (.not. maxval(abs(self%dw(i, :s)))*self%inverse_weight(self%m + i) < farthest) return
    end do
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
    class(collocation_t), intent(inout) :: self
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
            z(j, i) = z(j, i) + h*formula%c(i)*self%base(m + j)
          end do
        end do
      end if
      if (with_quadratures .and. n > m + k) &
        call combine(n - m - k, s, h, formula%a, self%f_stage(m + k + 1, 1), size(self%f_stage, 1), z(m + k + 1, 1), n)
    end associate
  end subroutine expand_stages

  module procedure settle_quadratures
    real(dp), parameter :: most_rest = 0.03_dp
    real(dp) :: rest
    integer :: i, s
    logical :: inside
    s = self%stages()
    rest = 0
    do i = self%m + self%k + 1, self%n
      rest = rest + (self%h*(f_end(i) - self%f_stage(i, s))*self%inverse_weight(i))**2
    end do
    if (rest <= most_rest**2) return
    call evaluate_stages(self, problem, inside)
    if (inside) call expand_stages(self, .true.)
  end procedure settle_quadratures

  module procedure combine
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
  end procedure combine

  !> Right-hand sides at the stages of self%w.
  subroutine evaluate_stages(self, problem, inside)
    class(collocation_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(out) :: inside
    integer :: i, j
    call expand_stages(self, .false.)
    inside = .true.
    do i = 1, self%formula(self%level)%stages
      do j = 1, self%n
        self%y_stage(j) = self%base(j) + self%z_new(j, i)
      end do
      self%evaluations = self%evaluations + 1
      call problem%derivatives(self%t + self%formula(self%level)%c(i)*self%h, self%y_stage, self%f_stage(:, i), inside)
      if (.not. inside) return
    end do
  end subroutine evaluate_stages
end submodule collocation_newton
