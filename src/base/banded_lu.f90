!> LU decomposition of band matrices without row exchanges, and solutions for several right-hand sides.
!>
!> Rows are not exchanged: this is stable for a matrix whose columns are diagonally dominant, as those of balances are. Elements
!> stay at most twice as large as the largest element of the matrix (Wilkinson 1961), half as many diagonals are filled as with row
!> exchanges, and a third of the work is done. Two columns are eliminated in each pass, which halves the traffic with the cache.
module banded_lu
  use kinds, only: dp
  implicit none
  private
  public :: decompose_band, solve_band

contains

  !> Replace a matrix by its factors, with reciprocal pivots. `singular` is true if a pivot is 0 or not a number; the factors must
  !> not be used then.
  pure subroutine decompose_band(n, band, a, singular)
    integer, intent(in) :: n, band              !! number of rows, number of diagonals on each side (>= 1)
    real(dp), intent(inout) :: a(-band:band, n) !! element (i, l) is row l + i, column l of the matrix
    logical, intent(out) :: singular
    real(dp) :: first, second                   !! elements of the rows l and l + 1
    integer :: i, k, l, last

    do l = 1, n - 1, 2
      last = min(band, n - l)
      call divide_column(last, a(0:, l), singular)
      if (singular) return
      a(0:last - 1, l + 1) = a(0:last - 1, l + 1) - a(-1, l + 1)*a(1:last, l)
      call divide_column(min(band, n - l - 1), a(0:, l + 1), singular)
      if (singular) return
      do k = 2, last
        first = a(-k, l + k)
        second = a(1 - k, l + k) - first*a(1, l)
        if (.not. (abs(first) > 0 .or. abs(second) > 0)) cycle   ! many are 0 where a film has ruptured
        a(1 - k, l + k) = second
        !$omp simd
        do i = 2, last
          a(i - k, l + k) = a(i - k, l + k) - first*a(i, l) - second*a(i - 1, l + 1)
        end do
        if (l + band < n) a(band + 1 - k, l + k) = a(band + 1 - k, l + k) - second*a(band, l + 1)
      end do
      if (l + band >= n) cycle
      associate (column => a(:, l + 1 + band))   ! the first one with an element in the row l + 1 alone
        second = column(1)
        if (abs(second) > 0) column(2:band + 1) = column(2:band + 1) - second*a(1:band, l + 1)
      end associate
    end do
    if (mod(n, 2) == 1) call divide_column(0, a(0:, n), singular)
  end subroutine decompose_band

  !> Replace a pivot by its reciprocal and divide the elements below by it.
  pure subroutine divide_column(below, column, singular)
    integer, intent(in) :: below              !! number of elements below the pivot
    real(dp), intent(inout) :: column(0:)     !! from the pivot
    logical, intent(out) :: singular
    singular = .not. abs(column(0)) > 0
    if (singular) return
    column(0) = 1/column(0)
    column(1:below) = column(1:below)*column(0)
  end subroutine divide_column

  !> Replace right-hand sides, the columns of x, by the solutions.
  pure subroutine solve_band(n, band, a, sides, x)
    integer, intent(in) :: n, band
    real(dp), intent(in) :: a(-band:band, n)    !! factors of `decompose_band`
    integer, intent(in) :: sides                !! number of right-hand sides
    real(dp), intent(inout) :: x(n, sides)
    real(dp) :: first, second
    integer :: i, l, side, last

    do l = 1, n - 1, 2
      last = min(band, n - l)
      do side = 1, sides
        first = x(l, side)
        second = x(l + 1, side) - first*a(1, l)
        x(l + 1, side) = second
        !$omp simd
        do i = 2, last
          x(l + i, side) = x(l + i, side) - first*a(i, l) - second*a(i - 1, l + 1)
        end do
        if (l + band < n) x(l + 1 + band, side) = x(l + 1 + band, side) - second*a(band, l + 1)
      end do
    end do
    do l = n, 2, -2
      last = min(band, l - 1)
      do side = 1, sides
        first = x(l, side)*a(0, l)
        second = (x(l - 1, side) - first*a(-1, l))*a(0, l - 1)
        x(l, side) = first
        x(l - 1, side) = second
        !$omp simd
        do i = 2, last
          x(l - i, side) = x(l - i, side) - first*a(-i, l) - second*a(1 - i, l - 1)
        end do
        if (l - 1 > band) x(l - 1 - band, side) = x(l - 1 - band, side) - second*a(-band, l - 1)
      end do
    end do
    if (mod(n, 2) == 1) x(1, :) = x(1, :)*a(0, 1)
  end subroutine solve_band
end module banded_lu
