!> The solution inside the last step of the Adams method.
submodule (adams) adams_interpolant
  use adams_coefficients, only: interpolation_weights
  use adams_differences, only: add_weighted
  use bernstein, only: from_newton, integrate_polynomial
  implicit none
contains

  module procedure time_at
    time_at = x
    if (self%rooted) time_at = self%t_origin + x**2
  end procedure time_at

  module procedure interpolate
    real(dp) :: weights(highest_order + 2), s
    integer :: k

    k = self%k_old
    s = t - self%t
    if (self%rooted) s = sqrt(max(t - self%t_origin, 0.0_dp)) - self%x
    if (k == 0 .or. s >= 0) then
      y = self%y
      return
    end if
    if (.not. self%closed) call close_polynomial(self)
    call interpolation_weights(self%coefficients, k, s, weights)
    self%slope = weights(k + 2)*self%closing
    call add_weighted(self%blocks, k + 1, weights, self%phi, self%owed, self%slope)
    y = self%y + s*self%slope(:self%n)
  end procedure interpolate

  !> The coefficient of the last polynomial of the interpolant, which makes it pass through y at the beginning of the step.
  pure subroutine close_polynomial(self)
    class(adams_t), intent(inout) :: self
    real(dp) :: weights(highest_order + 2)
    integer :: j
    associate (k => self%k_old)
      call interpolation_weights(self%coefficients, k, self%x_old - self%x, weights)
      self%closing(:self%n) = (self%y_old - self%y)/(self%x_old - self%x)
      do j = 1, k + 1
        self%closing = self%closing - weights(j)*(self%phi(:, j) + self%owed)
      end do
      self%closing = self%closing/weights(k + 2)
      self%closed = .true.
    end associate
  end subroutine close_polynomial

  module procedure find_straying
    real(dp) :: owed(2), sums(2), correction(2)
    integer :: j, last
    last = first + 1
    owed = self%owed(first:last)
    sums = 0
    do j = 3, self%k_old + 1
      sums = sums + abs(self%phi(first:last, j) + owed)
    end do
    sums = abs(self%phi(first:last, 2) + owed)/8 + (3/64.0_dp)*sums
    correction = self%coefficients%g(self%k_old + 1)*((self%phi(first:last, 1) + owed) - self%f_predicted(first:last))
    straying = (self%x - self%x_old)*(sums + abs(correction))
  end procedure find_straying

  module procedure bernstein_form
    real(dp) :: low(highest_order + 1), high(highest_order + 1), rates(highest_order + 2), form(0:highest_order + 1), h
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
    rates(:k + 1) = self%phi(component, :k + 1) + self%owed(component)
    rates(k + 2) = self%closing(component)
    call from_newton(rates(:k + 2), low(:k + 1), high(:k + 1), form(:k + 1))
    call integrate_polynomial(self%y_old(component), h, form(:k + 1), coefficients(:degree))
  end procedure bernstein_form

  module procedure time_at_share
    time_at_share = time_at(self, self%x_old + share*(self%x - self%x_old))
  end procedure time_at_share
end submodule adams_interpolant
