!> The table of modified divided differences of the Adams method: phi_i, i = 1..k+2 (Shampine & Gordon 1975, ch. 5). Work
!> on plain arrays, which the compiler knows to be apart.
!>
!> The components of a state are held in blocks of `lanes`, the last one filled up with zeros, so that every loop over the
!> components of a block becomes a few vector instructions without any test of what is left over.
!>
!> A step that stands adds its highest difference, f at its end less the f extrapolated there, to all the extrapolated ones.
!> That is put off to the next pass over the table: the first `owing` columns lack what stands in column owing+1.
module adams_differences
  use kinds, only: dp
  use ode_method, only: highest_order
  implicit none
  private
  public :: lanes, extrapolate, restore_differences, correct, advance, add_weighted, differences_of

  integer, parameter :: lanes = 4   !! components in a block

contains

  !> Predict y at the end of a step of size h and order k; phi becomes the differences that the prediction extrapolates, which
  !> owe nothing.
  !> `carry` is what the rounding of y left out, `carry_predicted` what it leaves out of the prediction.
  pure subroutine extrapolate(blocks, k, owing, h, g, beta, beta_next, y, carry, phi, predicted, carry_predicted)
    integer, intent(in) :: blocks, k, owing
    real(dp), intent(in) :: h, g(k), beta(k), beta_next, y(lanes, blocks), carry(lanes, blocks)
    real(dp), intent(inout) :: phi(lanes, blocks, highest_order + 2)
    real(dp), intent(out) :: predicted(lanes, blocks), carry_predicted(lanes, blocks)
    real(dp), dimension(lanes) :: owed, column, sum, next, change
    integer :: b, j
    do b = 1, blocks
      owed = 0
      if (owing > 0) owed = phi(:, b, owing + 1)
      if (k > owing) phi(:, b, k) = phi(:, b, k) - owed   ! it is what the others are owed: exactly zero, or all is paid
      column = phi(:, b, k + 1)
      if (k < owing) column = column + owed
      phi(:, b, k + 2) = beta_next*column
      phi(:, b, k + 1) = 0
      sum = 0
      next = 0
      do j = k, 1, -1   ! beta_j = 1 up to the number of steps of one size
        column = beta(j)*(phi(:, b, j) + owed)
        sum = sum + g(j)*column
        next = next + column
        phi(:, b, j) = next
      end do
      change = h*sum - carry(:, b)
      predicted(:, b) = y(:, b) + change
      carry_predicted(:, b) = (predicted(:, b) - y(:, b)) - change
    end do
  end subroutine extrapolate

  !> Correct to order k+1: `factor` is h g_k+1. `carry` becomes what the rounding leaves out of y_new.
  pure subroutine correct(blocks, factor, f_predicted, phi, predicted, y_new, carry)
    integer, intent(in) :: blocks
    real(dp), intent(in) :: factor
    real(dp), dimension(lanes, blocks), intent(in) :: f_predicted, phi, predicted   !! of phi, the first column
    real(dp), intent(out) :: y_new(lanes, blocks)
    real(dp), intent(inout) :: carry(lanes, blocks)
    real(dp) :: change(lanes)
    integer :: b
    do b = 1, blocks
      change = factor*(f_predicted(:, b) - phi(:, b)) - carry(:, b)
      y_new(:, b) = predicted(:, b) + change
      carry(:, b) = (y_new(:, b) - predicted(:, b)) - change
    end do
  end subroutine correct

  !> Undo `extrapolate` after a step that was rejected.
  pure subroutine restore_differences(width, k, beta, beta_next, phi)
    integer, intent(in) :: width, k
    real(dp), intent(in) :: beta(k), beta_next
    real(dp), intent(inout) :: phi(width, k + 2)
    integer :: i
    do i = 1, k
      phi(:, i) = (phi(:, i) - phi(:, i + 1))/beta(i)
    end do
    phi(:, k + 1) = phi(:, k + 2)/beta_next
  end subroutine restore_differences

  !> A step of order k stands: its y and what the rounding left out of it, and the two highest differences at its end, from the
  !> extrapolated ones and f there. The first k columns then owe the first of the two.
  pure subroutine advance(blocks, k, f_new, y_new, carry_new, phi, y, carry)
    integer, intent(in) :: blocks, k
    real(dp), dimension(lanes, blocks), intent(in) :: f_new, y_new, carry_new
    real(dp), intent(inout) :: phi(lanes, blocks, k + 2)
    real(dp), dimension(lanes, blocks), intent(out) :: y, carry
    real(dp) :: highest(lanes)
    integer :: b
    do b = 1, blocks
      highest = f_new(:, b) - phi(:, b, 1)
      phi(:, b, k + 2) = highest - phi(:, b, k + 2)
      phi(:, b, k + 1) = highest
      y(:, b) = y_new(:, b)
      carry(:, b) = carry_new(:, b)
    end do
  end subroutine advance

  !> Add weights_j phi_j, j = k+1..1, to `total` after a step of order k.
  pure subroutine add_weighted(blocks, k, weights, phi, total)
    integer, intent(in) :: blocks, k
    real(dp), intent(in) :: weights(k + 1), phi(lanes, blocks, k + 1)
    real(dp), intent(inout) :: total(lanes, blocks)
    real(dp), dimension(lanes) :: owed, sum
    integer :: b, j
    do b = 1, blocks
      owed = phi(:, b, k + 1)
      sum = total(:, b) + weights(k + 1)*owed
      do j = k, 1, -1
        sum = sum + weights(j)*(phi(:, b, j) + owed)
      end do
      total(:, b) = sum
    end do
  end subroutine add_weighted

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
