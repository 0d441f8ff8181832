!> Newton's method for the stages of a Radau step.
submodule (collocation) collocation_newton
  use small_lu, only: decompose
  implicit none

  !> Newton steps larger than this, in tolerances, are not made: forces and their squares may overflow there.
  real(dp), parameter :: farthest = 1e30_dp
contains

  module procedure decompose_matrices
    real(dp) :: x, y, per_x, per_y
    integer :: i, j, l, k, m

    k = self%k
    m = self%m
    do i = 1, k
      self%step_weight(i) = self%inverse_weight(m + i)
      if (i <= m) self%step_weight(i) = max(self%step_weight(i), self%h*self%inverse_weight(i))
    end do
    associate (formula => self%formula(self%level), h => self%h)
      x = formula%gamma/h
      per_x = h/formula%gamma
      do l = 1, k
        do i = 1, k
          self%e1(i, l) = -self%a_v(i, l)
          if (l <= m) self%e1(i, l) = self%e1(i, l) - per_x*self%a_p(i, l)
        end do
        self%e1(l, l) = self%e1(l, l) + x
      end do
      call decompose(self%e1, self%pivot1, singular)
      if (singular) return
      do j = 1, formula%stages/2
        x = formula%alpha(j)/h   ! the shift is x - i y
        y = formula%beta(j)/h
        per_x = formula%alpha(j)*h/(formula%alpha(j)**2 + formula%beta(j)**2)
        per_y = formula%beta(j)*h/(formula%alpha(j)**2 + formula%beta(j)**2)
        do l = 1, k
          do i = 1, k
            self%e2(i, l, 2*j - 1) = -self%a_v(i, l)
            self%e2(i, l, 2*j) = 0
            if (l > m) cycle
            self%e2(i, l, 2*j - 1) = self%e2(i, l, 2*j - 1) - per_x*self%a_p(i, l)
            self%e2(i, l, 2*j) = -per_y*self%a_p(i, l)
          end do
          self%e2(l, l, 2*j - 1) = self%e2(l, l, 2*j - 1) + x
          self%e2(l, l, 2*j) = self%e2(l, l, 2*j) - y
        end do
        call decompose(self%e2(:, :, 2*j - 1), self%e2(:, :, 2*j), self%pivot2(:, j), singular)
        if (singular) return
      end do
    end associate
  end procedure decompose_matrices

  module procedure iterate
    real(dp) :: change, defect, last_defect, last_change, ratio, last_ratio, rest
    integer :: iteration, halvings
    logical :: inside

    last_change = 0
    last_ratio = 0
    self%contraction = 0
    outcome = newton_outside
    call evaluate_stages(self, problem, inside)
    if (.not. inside) return
    do iteration = 1, most_iterations
      self%iterations = iteration
      call newton_step(self, change, defect)
      rest = defect
      outcome = newton_diverged
      if (.not. change < farthest) return
      if (change <= self%rounding) then
        rest = 0
      else if (last_change > 0) then
        ratio = max(change/last_change, defect/last_defect)
        self%contraction = ratio
        if (last_ratio > 0) self%contraction = sqrt(ratio*last_ratio)
        last_ratio = ratio
        if (self%contraction >= 0.99_dp) return
        rest = change*self%contraction/(1 - self%contraction)
        if (rest*self%contraction**(most_iterations - 1 - iteration) > self%goal) return
      end if
      last_change = change
      last_defect = defect
      if (rest <= self%goal) then
        call expand_stages(self, .true.)
        outcome = newton_converged
        return
      end if
      call evaluate_stages(self, problem, inside)
      do halvings = 1, most_halvings
        if (inside) exit
        self%dw = 0.5_dp*self%dw   ! take back half of the last step
        self%w = self%w - self%dw
        last_change = 0
        last_ratio = 0
        call evaluate_stages(self, problem, inside)
      end do
      outcome = newton_outside
      if (.not. inside) return
    end do
    outcome = newton_diverged
  end procedure iterate

  !> One Newton step: self%dw is added to self%w; `change` is its size relative to the inner tolerance, including its effect on the
  !> positions, and `defect` is h times the residual of the equations before it, in the same norm. The right-hand sides at the
  !> stages belong to self%w. A step that is too large is not made.
  subroutine newton_step(self, change, defect)
    class(collocation_t), intent(inout) :: self
    real(dp), intent(out) :: change, defect
    integer :: j, m, k, s

    m = self%m
    k = self%k
    s = self%formula(self%level)%stages
    associate (formula => self%formula(self%level), h => self%h)
      call combine(k, s, 1.0_dp, formula%t_inverse, self%f_stage(m + 1, 1), size(self%f_stage, 1), self%dw, k)
      call subtract_shifted(k, s, formula%gamma/h, formula%alpha, formula%beta, 1/h, self%w, self%dw)
      defect = h*mean_size(k, s, self%step_weight, self%dw)
      call solve(self%e1, self%pivot1, self%dw(:, 1))
      do j = 1, s/2
        call solve(self%e2(:, :, 2*j - 1), self%e2(:, :, 2*j), self%pivot2(:, j), self%dw(:, 2*j), self%dw(:, 2*j + 1))
      end do
    end associate
    change = mean_size(k, s, self%step_weight, self%dw)
    if (change < farthest) self%w(:, :s) = self%w(:, :s) + self%dw(:, :s)
  end subroutine newton_step

  !> Subtract the terms with w from the right-hand sides: the real eigenvalue times the first column, the complex ones times pairs
  !> of columns, as (alpha - i beta) (w + i w').
  pure subroutine subtract_shifted(k, s, gamma, alpha, beta, factor, w, dw)
    integer, intent(in) :: k, s
    real(dp), intent(in) :: gamma, alpha(*), beta(*), factor, w(k, s)
    real(dp), intent(inout) :: dw(k, s)
    real(dp) :: x, y
    integer :: i, j
    do i = 1, k
      dw(i, 1) = dw(i, 1) - gamma*w(i, 1)
    end do
    do j = 1, s/2
      x = factor*alpha(j)
      y = factor*beta(j)
      do i = 1, k
        dw(i, 2*j) = dw(i, 2*j) - (x*w(i, 2*j) + y*w(i, 2*j + 1))
        dw(i, 2*j + 1) = dw(i, 2*j + 1) - (x*w(i, 2*j + 1) - y*w(i, 2*j))
      end do
    end do
  end subroutine subtract_shifted

  !> Root mean square of the weighted components at all stages; `farthest` if one of them is larger.
  pure real(dp) function mean_size(k, s, weight, x)
    integer, intent(in) :: k, s
    real(dp), intent(in) :: weight(k), x(k, s)
    real(dp) :: total, part
    integer :: i, j
    mean_size = farthest
    total = 0
    do j = 1, s
      do i = 1, k
        part = abs(x(i, j)*weight(i))
        if (.not. part < farthest) return
        total = total + part**2
      end do
    end do
    mean_size = sqrt(total/(s*max(k, 1)))
  end function mean_size

  !> Increments of all components at the stages: rates from w, positions by collocation, quadratures from the last evaluation.
  subroutine expand_stages(self, with_quadratures)
    class(collocation_t), intent(inout) :: self
    logical, intent(in) :: with_quadratures
    integer :: n, m, k

    n = self%n
    m = self%m
    k = self%k
    associate (formula => self%formula(self%level), h => self%h, s => self%formula(self%level)%stages, z => self%z_new)
      call combine(k, s, 1.0_dp, formula%t, self%w, k, z(m + 1, 1), n)
      call combine(m, s, h, formula%a, z(m + 1, 1), n, z, n)
      call add_drift(n, m, s, h, formula%c, self%base, z)
      if (with_quadratures .and. n > m + k) &
        call combine(n - m - k, s, h, formula%a, self%f_stage(m + k + 1, 1), size(self%f_stage, 1), z(m + k + 1, 1), n)
    end associate
  end subroutine expand_stages

  !> Add the effect of the initial rates on the positions.
  pure subroutine add_drift(n, m, s, h, c, base, z)
    integer, intent(in) :: n, m, s
    real(dp), intent(in) :: h, c(s), base(n)
    real(dp), intent(inout) :: z(n, s)
    real(dp) :: time
    integer :: i, j
    do i = 1, s
      time = h*c(i)
      do j = 1, m
        z(j, i) = z(j, i) + time*base(m + j)
      end do
    end do
  end subroutine add_drift

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
    select case (stages)
    case (3)
      call combine_3(rows, factor, matrix, x, first_x, y, first_y)
    case (5)
      call combine_5(rows, factor, matrix, x, first_x, y, first_y)
    case default
      do i = 1, stages
        do r = 1, rows
          total = 0
          do j = 1, stages
            total = total + matrix(i, j)*x(r, j)
          end do
          y(r, i) = factor*total
        end do
      end do
    end select
  end procedure combine

  !> The three usual numbers of stages, without loops over the stages.
  pure subroutine combine_3(rows, factor, m, x, first_x, y, first_y)
    integer, intent(in) :: rows, first_x, first_y
    real(dp), intent(in) :: factor, m(3, 3), x(first_x, *)
    real(dp), intent(inout) :: y(first_y, *)
    integer :: i, r
    do r = 1, rows
      associate (a => x(r, 1), b => x(r, 2), c => x(r, 3))
        do i = 1, 3
          y(r, i) = factor*(m(i, 1)*a + m(i, 2)*b + m(i, 3)*c)
        end do
      end associate
    end do
  end subroutine combine_3

  pure subroutine combine_5(rows, factor, m, x, first_x, y, first_y)
    integer, intent(in) :: rows, first_x, first_y
    real(dp), intent(in) :: factor, m(5, 5), x(first_x, *)
    real(dp), intent(inout) :: y(first_y, *)
    integer :: i, r
    do r = 1, rows
      associate (a => x(r, 1), b => x(r, 2), c => x(r, 3), d => x(r, 4), e => x(r, 5))
        do i = 1, 5
          y(r, i) = factor*(m(i, 1)*a + m(i, 2)*b + m(i, 3)*c + m(i, 4)*d + m(i, 5)*e)
        end do
      end associate
    end do
  end subroutine combine_5

  !> Right-hand sides at the stages of self%w. The states of all stages are computed before the first evaluation, so that
  !> evaluations do not depend on each other.
  subroutine evaluate_stages(self, problem, inside)
    class(collocation_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(out) :: inside
    integer :: i, s
    s = self%formula(self%level)%stages
    call expand_stages(self, .false.)
    call add_base(self%n, s, self%base, self%z_new, self%y_stage)
    inside = .true.
    do i = 1, s
      self%evaluations = self%evaluations + 1
      call problem%derivatives(self%t + self%formula(self%level)%c(i)*self%h, self%y_stage(:, i), self%f_stage(:, i), inside)
      if (.not. inside) return
    end do
  end subroutine evaluate_stages

  pure subroutine add_base(n, s, base, z, y)
    integer, intent(in) :: n, s
    real(dp), intent(in) :: base(n), z(n, s)
    real(dp), intent(out) :: y(n, s)
    integer :: i
    do i = 1, s
      y(:, i) = base + z(:, i)
    end do
  end subroutine add_base
end submodule collocation_newton
