!> Newton's method for the stages of a Radau step. The usual numbers of unknowns and stages are passed as constants and by value, so
!> that the compiler writes out the loops over them.
submodule (collocation) collocation_newton
  use small_lu, only: decompose
  implicit none

  !> Newton steps larger than this, in tolerances, are not made: forces and their squares may overflow there.
  real(dp), parameter :: farthest = 1e30_dp
  !> Largest defect that is explained by rounding of the state, over the Newton step that it causes; a stiffer Jacobian, times the
  !> step size, belongs to another state.
  real(dp), parameter :: stiffest = 1e10_dp
contains

  module procedure decompose_matrices
    if (self%k == 3 .and. self%m == 3) then
      call decompose_for(self, 3, 3, singular)
    else if (self%k == 2 .and. self%m == 2) then
      call decompose_for(self, 2, 2, singular)
    else
      call decompose_for(self, self%k, self%m, singular)
    end if
  end procedure decompose_matrices

  !> The same for given numbers of unknowns and positions.
  pure subroutine decompose_for(self, k, m, singular)
    type(collocation_t), intent(inout) :: self
    integer, value :: k, m
    logical, intent(out) :: singular
    integer :: j
    do j = 1, k
      self%step_weight(j) = self%inverse_weight(m + j)
      if (j <= m) self%step_weight(j) = max(self%step_weight(j), self%h*self%inverse_weight(j))
    end do
    associate (formula => self%formula(self%level), h => self%h, e2 => self%e2)
      call newton_matrix(k, m, formula%gamma/h, 0.0_dp, self%a_p, self%a_v, self%e1, e2)
      call decompose(k, self%e1, self%pivot1, singular)
      do j = 1, formula%stages/2
        if (singular) return
        call newton_matrix(k, m, formula%alpha(j)/h, formula%beta(j)/h, self%a_p, self%a_v, e2(:, :, 2*j - 1), e2(:, :, 2*j))
        call decompose(k, e2(:, :, 2*j - 1), e2(:, :, 2*j), self%pivot2(:, j), singular)
      end do
    end associate
  end subroutine decompose_for

  !> Real and imaginary part of g - a_v - a_p/g for the eigenvalue g = x - i y.
  pure subroutine newton_matrix(k, m, x, y, a_p, a_v, real_part, imaginary_part)
    integer, value :: k, m
    real(dp), intent(in) :: x, y, a_p(k, m), a_v(k, k)
    real(dp), intent(out) :: real_part(k, k), imaginary_part(k, k)
    real(dp) :: per_square
    integer :: i
    per_square = 1/(x**2 + y**2)
    real_part(:, :m) = -a_v(:, :m) - (x*per_square)*a_p
    imaginary_part(:, :m) = -(y*per_square)*a_p
    real_part(:, m + 1:) = -a_v(:, m + 1:)
    imaginary_part(:, m + 1:) = 0
    do i = 1, k
      real_part(i, i) = real_part(i, i) + x
      imaginary_part(i, i) = imaginary_part(i, i) - y
    end do
  end subroutine newton_matrix

  module procedure improve
    real(dp) :: tau
    logical :: singular
    change = 0
    tau = self%h_done*min(x, 1/self%formula(self%stages_done/2)%gamma)
    associate (n => self%m + self%k, d => self%defect, e => self%correction)
      if (abs(tau - self%tau) > 0) then
        call newton_matrix(self%k, self%m, 1/tau, 0.0_dp, self%a_p, self%a_v, self%e1, self%e2)
        call decompose(self%k, self%e1, self%pivot1, singular)
        if (singular) return
        self%tau = tau
      end if
      call polynomial_slope(self, x, d)
      d(:) = tau*(d/self%h_done - f(:n))
      call filter(self%k, self%m, tau, 1/tau, self%a_p, self%e1, self%pivot1, d)
      e(:) = d
      call filter(self%k, self%m, tau, 1/tau, self%a_p, self%e1, self%pivot1, e)
      e(:) = d - e
      if (.not. all(abs(e(:self%m)*self%inverse_weight(:self%m)) < 1)) return
      change = maxval(abs(e(self%m + 1:)*self%inverse_weight(self%m + 1:n)))
      y(self%m + 1:n) = y(self%m + 1:n) - e(self%m + 1:)
    end associate
  end procedure improve

  module procedure filter
    integer :: i
    x(m + 1:) = per_tau*x(m + 1:)
    do i = 1, m
      x(m + 1:) = x(m + 1:) + a_p(:, i)*x(i)
    end do
    call solve(k, matrix, pivot, x(m + 1:))
    x(:m) = x(:m) + tau*x(m + 1:2*m)
  end procedure filter

  module procedure iterate
    real(dp) :: change, defect, last_defect, last_change, ratio, last_ratio, rest
    integer :: iteration, halvings
    logical :: in_domain

    last_change = 0
    last_ratio = 0
    self%contraction = 0
    outcome = newton_outside
    call evaluate_stages(self, problem, in_domain)
    if (.not. in_domain) return
    do iteration = 1, most_iterations
      self%iterations = iteration
      call newton_step(self, change, defect)
      rest = defect
      outcome = newton_diverged
      if (.not. change < farthest) return
      if (change <= self%rounding) then
        if (.not. defect <= stiffest*self%rounding) return
        rest = 0
      else if (last_change > 0) then
        ratio = max(change/last_change, defect/last_defect)
        self%contraction = ratio
        if (last_ratio > 0) self%contraction = sqrt(ratio*last_ratio)
        last_ratio = ratio
        if (self%contraction >= 0.99_dp) return
        rest = change*self%contraction/(1 - self%contraction)
        if (rest > self%goal) then
          if (rest*self%contraction**(most_iterations - 1 - iteration) > self%goal) return
        end if
      end if
      last_change = change
      last_defect = defect
      if (rest <= self%goal) then
        call expand_stages(self)
        call integrate_quadratures(self)
        outcome = newton_converged
        return
      end if
      call evaluate_stages(self, problem, in_domain)
      do halvings = 1, most_halvings
        if (in_domain) exit
        self%dw = 0.5_dp*self%dw   ! take back half of the last step
        self%w = self%w - self%dw
        last_change = 0
        last_ratio = 0
        call evaluate_stages(self, problem, in_domain)
      end do
      outcome = newton_outside
      if (.not. in_domain) return
    end do
    outcome = newton_diverged
  end procedure iterate

  !> One Newton step: self%dw is added to self%w; `change` is its size relative to the inner tolerance, including its effect on the
  !> positions, and `defect` is h times the residual of the equations before it, in the same norm. The right-hand sides at the
  !> stages belong to self%w. A step that is too large is not made.
  subroutine newton_step(self, change, defect)
    class(collocation_t), intent(inout) :: self
    real(dp), intent(out) :: change, defect
    associate (k => self%k, m => self%m, s => self%formula(self%level)%stages)
      if (k == 3 .and. s == 3) then
        call step_for(self, 3, 3, change, defect)
      else if (k == 3 .and. s == 5) then
        call step_for(self, 3, 5, change, defect)
      else if (k == 2 .and. s == 3) then
        call step_for(self, 2, 3, change, defect)
      else
        call step_for(self, k, s, change, defect)
      end if
    end associate
  end subroutine newton_step

  !> The same for given numbers of unknowns and stages.
  subroutine step_for(self, k, s, change, defect)
    type(collocation_t), intent(inout) :: self
    integer, value :: k, s
    real(dp), intent(out) :: change, defect
    integer :: j

    associate (formula => self%formula(self%level), h => self%h)
      call combine(k, s, 1.0_dp, formula%t_inverse, self%f_stage(self%m + 1, 1), self%n, self%dw, k)
      call subtract_shifted(k, s, formula%gamma/h, formula%alpha, formula%beta, 1/h, self%w, self%dw)
      defect = h*mean_size(k, s, self%step_weight, self%dw)
      call solve(k, self%e1, self%pivot1, self%dw(:, 1))
      do j = 1, s/2
        call solve(k, self%e2(:, :, 2*j - 1), self%e2(:, :, 2*j), self%pivot2(:, j), self%dw(:, 2*j), self%dw(:, 2*j + 1))
      end do
    end associate
    change = mean_size(k, s, self%step_weight, self%dw)
    if (change < farthest) call add(k*s, self%dw, self%w)
  end subroutine step_for

  pure subroutine add(n, x, y)
    integer, value :: n
    real(dp), intent(in) :: x(n)
    real(dp), intent(inout) :: y(n)
    y = y + x
  end subroutine add

  !> Subtract the terms with w from the right-hand sides: the real eigenvalue times the first column, the complex ones times pairs
  !> of columns, as (alpha - i beta) (w + i w').
  pure subroutine subtract_shifted(k, s, gamma, alpha, beta, factor, w, dw)
    integer, value :: k, s
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
    integer, value :: k, s
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

  !> States at the stages of self%w and their increments: rates and first-order states from w, positions by collocation.
  !> Quadratures at the stages are not needed.
  subroutine expand_stages(self)
    class(collocation_t), intent(inout) :: self
    associate (k => self%k, m => self%m, s => self%formula(self%level)%stages)
      if (k == 3 .and. m == 3 .and. s == 3) then
        call expand_for(self, 3, 3, 3)
      else if (k == 3 .and. m == 3 .and. s == 5) then
        call expand_for(self, 3, 3, 5)
      else if (k == 2 .and. m == 2 .and. s == 3) then
        call expand_for(self, 2, 2, 3)
      else
        call expand_for(self, k, m, s)
      end if
    end associate
  end subroutine expand_stages

  !> The same for given numbers of unknowns, positions and stages.
  subroutine expand_for(self, k, m, s)
    type(collocation_t), intent(inout) :: self
    integer, value :: k, m, s
    associate (formula => self%formula(self%level), n => self%n, z => self%z_new, y => self%y_stage)
      call combine(k, s, 1.0_dp, formula%t, self%w, k, z(m + 1, 1), n)
      call add_base(k, s, n, self%base(m + 1), z(m + 1, 1), y(m + 1, 1))
      call combine(m, s, self%h, formula%a, y(m + 1, 1), n, z, n)
      call add_base(m, s, n, self%base, z, y)
    end associate
  end subroutine expand_for

  pure subroutine add_base(rows, s, n, base, z, y)
    integer, value :: rows, s, n
    real(dp), intent(in) :: base(rows), z(n, *)
    real(dp), intent(inout) :: y(n, *)
    integer :: i
    do i = 1, s
      y(:rows, i) = base + z(:rows, i)
    end do
  end subroutine add_base

  !> Increments of the quadratures, from the last evaluation.
  subroutine integrate_quadratures(self)
    class(collocation_t), intent(inout) :: self
    associate (s => self%formula(self%level)%stages, n => self%n, first => self%m + self%k + 1)
      if (first <= n) call combine(n - first + 1, s, self%h, self%formula(self%level)%a, self%f_stage(first, 1), n, &
        self%z_new(first, 1), n)
    end associate
  end subroutine integrate_quadratures

  module procedure settle_quadratures
    real(dp), parameter :: most_rest = 0.03_dp
    real(dp) :: rest
    integer :: i, s
    logical :: in_domain
    s = self%stages()
    rest = 0
    do i = self%m + self%k + 1, self%n
      rest = rest + (self%h*(f_end(i) - self%f_stage(i, s))*self%inverse_weight(i))**2
    end do
    if (rest <= most_rest**2) return
    call evaluate_stages(self, problem, in_domain)
    if (in_domain) call integrate_quadratures(self)
  end procedure settle_quadratures

  module procedure combine
    select case (stages)
    case (3)
      call combine_for(3, rows, factor, matrix, x, first_x, y, first_y)
    case (5)
      call combine_for(5, rows, factor, matrix, x, first_x, y, first_y)
    case default
      call combine_for(stages, rows, factor, matrix, x, first_x, y, first_y)
    end select
  end procedure combine

  !> The same for a given number of stages.
  pure subroutine combine_for(stages, rows, factor, matrix, x, first_x, y, first_y)
    integer, value :: stages, rows, first_x, first_y
    real(dp), intent(in) :: factor, matrix(stages, stages), x(first_x, *)
    real(dp), intent(inout) :: y(first_y, *)
    real(dp) :: total
    integer :: i, j, r
    do r = 1, rows
      do i = 1, stages
        total = matrix(i, 1)*x(r, 1)
        do j = 2, stages
          total = total + matrix(i, j)*x(r, j)
        end do
        y(r, i) = factor*total
      end do
    end do
  end subroutine combine_for

  !> Right-hand sides at the stages of self%w. The states of all stages are computed before the first evaluation, so that
  !> evaluations do not depend on each other.
  subroutine evaluate_stages(self, problem, in_domain)
    class(collocation_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(out) :: in_domain
    integer :: done
    call expand_stages(self)
    associate (formula => self%formula(self%level))
      call evaluate(problem, self%n, formula%stages, self%t, self%h, formula%c, self%y_stage, self%f_stage, done, in_domain)
    end associate
    self%evaluations = self%evaluations + done
  end subroutine evaluate_stages

  !> Right-hand sides at the first stages, `done` in number, up to one that is not inside the model.
  subroutine evaluate(problem, n, stages, t, h, c, y, f, done, in_domain)
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: n, stages
    real(dp), intent(in) :: t, h, c(stages), y(n, stages)
    real(dp), intent(inout) :: f(n, stages)
    integer, intent(out) :: done
    logical, intent(out) :: in_domain
    in_domain = .true.
    do done = 1, stages
      call problem%derivatives(t + c(done)*h, y(:, done), f(:, done), in_domain)
      if (.not. in_domain) return
    end do
    done = stages
  end subroutine evaluate
end submodule collocation_newton
