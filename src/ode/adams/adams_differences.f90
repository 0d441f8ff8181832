!> The table of modified divided differences of the Adams method: phi_i, i = 1..k+2 (Shampine & Gordon 1975, ch. 5). The procedures
!> have plain arrays as arguments, which the compiler knows not to overlap.
!>
!> The table stores the components in blocks of `lanes`, the last one padded with zeros, so that the sums of a block stay in
!> registers while its columns are processed. Loops are not vectorised: vector loads of numbers that the right-hand side or an
!> earlier loop has just stored one by one stall the processor.
!>
!> An accepted step of order k adds its highest difference, f at its end minus the extrapolated f, to columns 1..k+2 of the table
!> (column k+1 was zero, and column k+2 the negative of the old difference of its order). This is postponed to the next pass over
!> the table; until then the columns lack the difference `owed`.
module adams_differences
  use kinds, only: dp
  implicit none
  private
  public :: lanes, extrapolate, restore_differences, correct, add_weighted, differences_of

  integer, parameter :: lanes = 2   !! number of components in a block; scenes have three to eight components

contains

  !> Predict y at the end of a step of size h and order k; phi is replaced by the differences used for the prediction, with `owed`
  !> added. `carry` is the rounding error of y, `carry_predicted` that of the prediction, `slope` the mean slope of y over the step.
  pure subroutine extrapolate(n, blocks, k, h, g, beta, beta_next, y, carry, owed, phi, slope, predicted, carry_predicted)
    integer, intent(in) :: n, blocks, k
    real(dp), intent(in) :: h, g(k), beta(k), beta_next, y(n), carry(n)
    real(dp), intent(inout) :: owed(lanes, blocks), phi(lanes, blocks, k + 2)
    real(dp), intent(out) :: slope(lanes*blocks), predicted(n), carry_predicted(n)
    real(dp) :: change
    integer :: i
    call extrapolate_table(blocks, k, g, beta, beta_next, owed, phi, slope)
    !GCC$ novector
    do i = 1, n
      change = h*slope(i) - carry(i)
      predicted(i) = y(i) + change
      carry_predicted(i) = (predicted(i) - y(i)) - change
    end do
  end subroutine extrapolate

  !> Update the table for `extrapolate`, and compute the mean slope of y over the step.
  pure subroutine extrapolate_table(blocks, k, g, beta, beta_next, owed, phi, slope)
    integer, intent(in) :: blocks, k
    real(dp), intent(in) :: g(k), beta(k), beta_next
    real(dp), intent(inout) :: owed(lanes, blocks), phi(lanes, blocks, k + 2)
    real(dp), intent(out) :: slope(lanes, blocks)
    real(dp), dimension(lanes) :: missing, column, sum, next
    integer :: b, j
    do b = 1, blocks
      missing = owed(:, b)
      column = -beta_next*(phi(:, b, k + 1) + missing)
      owed(:, b) = 0
      phi(:, b, k + 2) = column
      phi(:, b, k + 1) = 0
      sum = 0
      next = 0
      do j = k, 1, -1   ! beta_j is 1 if the step size has not changed
        column = beta(j)*(phi(:, b, j) + missing)
        sum = sum + g(j)*column
        next = next + column
        phi(:, b, j) = next
      end do
      slope(:, b) = sum
    end do
  end subroutine extrapolate_table

  !> Correct to order k+1 with f at the prediction, which is converted to the derivative with respect to the independent variable
  !> (factor `time_rate`). `factor` is h g_k+1; `first`, `lower` and `lowest` are the first column of the table and those for the
  !> errors at orders k-1 and k-2. `carry` becomes the rounding error of y_new. `squares` are those of the weighted norms of the
  !> correction of f and of its sums with the other two columns.
  pure subroutine correct(n, factor, time_rate, f_predicted, first, lower, lowest, inverse_weight, predicted, y_new, carry, squares)
    integer, intent(in) :: n
    real(dp), intent(in) :: factor, time_rate
    real(dp), intent(inout) :: f_predicted(n)
    real(dp), dimension(n), intent(in) :: first, lower, lowest, inverse_weight, predicted
    real(dp), intent(out) :: y_new(n), squares(3)
    real(dp), intent(inout) :: carry(n)
    real(dp) :: correction, change, weight, same_square, lower_square, lowest_square
    integer :: i
    same_square = 0
    lower_square = 0
    lowest_square = 0
    !GCC$ novector
    do i = 1, n
      f_predicted(i) = time_rate*f_predicted(i)
      correction = f_predicted(i) - first(i)
      weight = inverse_weight(i)
      same_square = same_square + (correction*weight)**2
      lower_square = lower_square + ((lower(i) + correction)*weight)**2
      lowest_square = lowest_square + ((lowest(i) + correction)*weight)**2
      change = factor*correction - carry(i)
      y_new(i) = predicted(i) + change
      carry(i) = (y_new(i) - predicted(i)) - change
    end do
    squares = [same_square, lower_square, lowest_square]
  end subroutine correct

  !> Undo `extrapolate` after a rejected step.
  pure subroutine restore_differences(width, k, beta, beta_next, phi)
    integer, intent(in) :: width, k
    real(dp), intent(in) :: beta(k), beta_next
    real(dp), intent(inout) :: phi(width, k + 2)
    real(dp) :: factor
    integer :: i
    do i = 1, k   ! one division for each column
      factor = 1/beta(i)
      phi(:, i) = factor*(phi(:, i) - phi(:, i + 1))
    end do
    factor = -1/beta_next
    phi(:, k + 1) = factor*phi(:, k + 2)
  end subroutine restore_differences

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

  !> Modified divided differences of values f(:, 1..m) at x(1) < ... < x(m), the latest first, and psi_i = x(m) - x(m-i).
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
