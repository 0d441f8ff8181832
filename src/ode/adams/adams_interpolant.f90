!> The solution inside the last step of the Adams method.
submodule (adams) adams_interpolant
  use adams_coefficients, only: interpolation_weights
  use adams_differences, only: add_weighted
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

  !> Compute the coefficient of the last polynomial of the interpolant, so that it passes through y at the beginning of the step.
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
end submodule adams_interpolant
