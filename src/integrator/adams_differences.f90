!> The table of modified divided differences of the Adams method: phi_i, i = 1..k+2 (Shampine & Gordon 1975, ch. 5). Work
!> on plain arrays, which the compiler knows to be apart.
module adams_differences
  use kinds, only: dp
  implicit none
  private
  public :: extrapolate, restore_differences, raise_differences, differences_of

contains

  !> Predict y at the end of a step of size h and order k; phi becomes the differences that the prediction extrapolates.
  !> `carry` is what the rounding of y left out, `carry_predicted` what it leaves out of the prediction.
  pure subroutine extrapolate(n, k, ns, h, g, beta, beta_next, y, carry, phi, predicted, carry_predicted)
    integer, intent(in) :: n, k, ns
    real(dp), intent(in) :: h, g(k), beta(k), beta_next, y(n), carry(n)
    real(dp), intent(inout) :: phi(n, k + 2)
    real(dp), intent(out) :: predicted(n), carry_predicted(n)
    real(dp) :: sum, next, change
    integer :: i, j
    do i = 1, n
      phi(i, k + 2) = beta_next*phi(i, k + 1)
      phi(i, k + 1) = 0
    end do
    do j = ns + 1, k
      do i = 1, n
        phi(i, j) = beta(j)*phi(i, j)
      end do
    end do
    do i = 1, n
      sum = 0
      next = 0
      do j = k, 1, -1
        sum = sum + g(j)*phi(i, j)
        next = phi(i, j) + next
        phi(i, j) = next
      end do
      change = h*sum - carry(i)
      predicted(i) = y(i) + change
      carry_predicted(i) = (predicted(i) - y(i)) - change
    end do
  end subroutine extrapolate

  !> Undo `extrapolate` after a step that was rejected.
  pure subroutine restore_differences(n, k, beta, beta_next, phi)
    integer, intent(in) :: n, k
    real(dp), intent(in) :: beta(k), beta_next
    real(dp), intent(inout) :: phi(n, k + 2)
    integer :: i
    do i = 1, k
      phi(:, i) = (phi(:, i) - phi(:, i + 1))/beta(i)
    end do
    phi(:, k + 1) = phi(:, k + 2)/beta_next
  end subroutine restore_differences

  !> Differences at the end of the step, from the extrapolated ones and f there.
  pure subroutine raise_differences(n, k, f, phi)
    integer, intent(in) :: n, k
    real(dp), intent(in) :: f(n)
    real(dp), intent(inout) :: phi(n, k + 2)
    real(dp) :: highest
    integer :: i, j
    do i = 1, n
      highest = f(i) - phi(i, 1)
      phi(i, k + 2) = highest - phi(i, k + 2)
      phi(i, k + 1) = highest
      do j = 1, k
        phi(i, j) = phi(i, j) + highest
      end do
    end do
  end subroutine raise_differences

  !> Modified divided differences of values f(:, 1..m) at x(1) < ... < x(m), latest first, and psi_i = x(m) - x(m-i).
  pure subroutine differences_of(x, f, phi, psi)
    real(dp), intent(in) :: x(:), f(:, :)
    real(dp), intent(out) :: phi(:, :), psi(:)
    integer :: i, j, m
    m = size(x)
    do i = 1, m
      phi(:, i) = f(:, m + 1 - i)
    end do
    do j = 2, m   ! divided differences over the latest i points
      do i = m, j, -1
        phi(:, i) = (phi(:, i - 1) - phi(:, i))/(x(m + j - i) - x(m + 1 - i))
      end do
    end do
    do i = 1, m - 1
      psi(i) = x(m) - x(m - i)
      do j = i + 1, m
        phi(:, j) = phi(:, j)*psi(i)
      end do
    end do
  end subroutine differences_of
end module adams_differences
