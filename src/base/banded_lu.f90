!> LU decomposition of band matrices without row exchanges, and solutions for several right-hand sides.
!>
!> Rows are not exchanged: this is stable for a matrix whose columns are diagonally dominant, as those of balances are. Elements stay
!> at most twice as large as the largest element of the matrix (Wilkinson 1961), half as many diagonals are stored as with row
!> exchanges, and a third of the work is done.
module banded_lu
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: decompose_band, solve_band

contains

  !> Replace a matrix by its factors, with reciprocal pivots. `singular` is true if a pivot is 0 or not a number; the factors must
  !> not be used then.
  pure subroutine decompose_band(n, band, a, singular)
    integer, intent(in) :: n, band              !! number of rows, number of diagonals on each side
    real(dp), intent(inout) :: a(-band:band, n) !! element (i, l) is row l + i, column l of the matrix
    logical, intent(out) :: singular
    real(dp) :: factor
    integer :: i, k, l, last
    singular = .true.
    do l = 1, n
      if (.not. abs(a(0, l)) > 0) return
      a(0, l) = 1/a(0, l)
      last = min(band, n - l)
      do i = 1, last
        a(i, l) = a(i, l)*a(0, l)
      end do
      do k = 1, last
        factor = a(-k, l + k)
        if (.not. abs(factor) > 0) cycle   ! where a film has ruptured most elements are 0
        !$omp simd
        do i = 1, last
          a(i - k, l + k) = a(i - k, l + k) - factor*a(i, l)
        end do
      end do
    end do
    singular = .false.
  end subroutine decompose_band

  !> Replace right-hand sides, the columns of x, by the solutions.
  pure subroutine solve_band(n, band, a, sides, x)
    integer, intent(in) :: n, band
    real(dp), intent(in) :: a(-band:band, n)    !! factors of `decompose_band`
    integer, intent(in) :: sides                !! number of right-hand sides
    real(dp), intent(inout) :: x(n, sides)
    real(dp) :: factor
    integer :: i, l, side, last
    do l = 1, n
      last = min(band, n - l)
      do side = 1, sides
        factor = x(l, side)
        if (.not. abs(factor) > 0) cycle
        !$omp simd
        do i = 1, last
          x(l + i, side) = x(l + i, side) - factor*a(i, l)
        end do
      end do
    end do
    do l = n, 1, -1
      last = min(band, l - 1)
      do side = 1, sides
        x(l, side) = x(l, side)*a(0, l)
        factor = x(l, side)
        if (.not. abs(factor) > 0) cycle
        !$omp simd
        do i = 1, last
          x(l - i, side) = x(l - i, side) - factor*a(-i, l)
        end do
      end do
    end do
  end subroutine solve_band
end module banded_lu
