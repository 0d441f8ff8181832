!> The table of modified divided differences of the Adams method: phi_i, i = 1..k+2 (Shampine & Gordon 1975, ch. 5). Work
!> on plain arrays, which the compiler knows to be apart.
!>
!> The components of a state are held in blocks of `lanes`, the last one filled up with zeros, so that every loop over the
!> components of a block becomes a few vector instructions without any test of what is left over.
!>
!> A step of order k that stands adds its highest difference, f at its end less the f extrapolated there, to the columns 1..k+1
!> of the table (the last of which was zero). That is put off to the next pass over the table: until then the columns lack
!> what is `owed`.
module adams_differences
  use kinds, only: dp
  implicit none
  private
  public :: lanes, extrapolate, restore_differences, correct, advance, add_weighted, change_clock, differences_of

  integer, parameter :: lanes = 4   !! components in a block

contains

  !> Predict y at the end of a step of size h and order k; phi becomes the differences that the prediction extrapolates, in
  !> which nothing is missing. `carry` is what the rounding of y left out, `carry_predicted` what it leaves out of the prediction.
  pure subroutine extrapolate(blocks, k, k_old, h, g, beta, beta_next, y, carry, owed, phi, predicted, carry_predicted)
    integer, intent(in) :: blocks, k, k_old
    real(dp), intent(in) :: h, g(k), beta(k), beta_next
    real(dp), dimension(lanes, blocks), intent(in) :: y, carry
    real(dp), intent(inout) :: owed(lanes, blocks), phi(lanes, blocks, k + 2)
    real(dp), dimension(lanes, blocks), intent(out) :: predicted, carry_predicted
    real(dp), dimension(lanes) :: column, sum, next, change
    real(dp) :: share
    integer :: b, j
    share = merge(0, 1, k > k_old)   ! column k_old+2 lacks nothing
    do b = 1, blocks
      phi(:, b, k + 2) = beta_next*(phi(:, b, k + 1) + share*owed(:, b))
      phi(:, b, k + 1) = 0
      sum = 0
      next = 0
      do j = k, 1, -1   ! where the step size has not changed beta_j is 1
        column = beta(j)*(phi(:, b, j) + owed(:, b))
        sum = sum + g(j)*column
        next = next + column
        phi(:, b, j) = next
      end do
      predicted(:, b) = sum
    end do
    do b = 1, blocks
      owed(:, b) = 0
      change = h*predicted(:, b) - carry(:, b)
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

  !> A step of order k stands: what its columns are now owed, from the first of them and f at the end of the step, and the
  !> difference of order k+1 there, in column k+2.
  pure subroutine advance(blocks, f_new, first, next_higher, owed)
    integer, intent(in) :: blocks
    real(dp), dimension(lanes, blocks), intent(in) :: f_new, first
    real(dp), intent(inout) :: next_higher(lanes, blocks)
    real(dp), intent(out) :: owed(lanes, blocks)
    integer :: b
    do b = 1, blocks
      owed(:, b) = f_new(:, b) - first(:, b)
      next_higher(:, b) = owed(:, b) - next_higher(:, b)
    end do
  end subroutine advance

  !> Add weights_j phi_j, j = m..1, to `total`.
  pure subroutine add_weighted(blocks, m, weights, phi, owed, total)
    integer, intent(in) :: blocks, m
    real(dp), intent(in) :: weights(m), phi(lanes, blocks, m), owed(lanes, blocks)
    real(dp), intent(inout) :: total(lanes, blocks)
    real(dp) :: sum(lanes)
    integer :: b, j
    do b = 1, blocks
      sum = total(:, b)
      do j = m, 1, -1
        sum = sum + weights(j)*(phi(:, b, j) + owed(:, b))
      end do
      total(:, b) = sum
    end do
  end subroutine add_weighted

  !> Multiply f by what it takes to be the rate by another clock.
  pure subroutine change_clock(blocks, factor, f)
    integer, intent(in) :: blocks
    real(dp), intent(in) :: factor
    real(dp), intent(inout) :: f(lanes, blocks)
    integer :: b
    do b = 1, blocks
      f(:, b) = factor*f(:, b)
    end do
  end subroutine change_clock

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
