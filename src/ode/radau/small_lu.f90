!> LU decomposition with partial pivoting of the small dense matrices of an implicit step, real and complex.
!>
!> Complex numbers are stored as pairs of reals: library divisions, and products that check for NaN, would cost more than the
!> arithmetic.
module small_lu
  use kinds, only: dp
  implicit none
  private
  public :: decompose, solve

  !> Replace a matrix (n, n) by its factors, with reciprocal pivots; `pivot` (n) stores the row exchanges. `singular` is true if a
  !> pivot is 0 or not a number.
  interface decompose
    module procedure decompose_real, decompose_complex
  end interface decompose

  !> Replace a right-hand side (n) by the solution.
  interface solve
    module procedure solve_real, solve_complex
  end interface solve

contains

  pure subroutine decompose_real(n, a, pivot, singular)
    integer, value :: n
    real(dp), intent(inout) :: a(n, n)
    integer, intent(out) :: pivot(n)
    logical, intent(out) :: singular
    real(dp) :: swap
    integer :: i, j, l, p
    singular = .true.
    do j = 1, n
      p = j
      do i = j + 1, n
        if (abs(a(i, j)) > abs(a(p, j))) p = i
      end do
      pivot(j) = p
      if (.not. abs(a(p, j)) > 0) return
      if (p /= j) then
        do l = j, n   ! the factors to the left stay in the order of the substitution
          swap = a(j, l)
          a(j, l) = a(p, l)
          a(p, l) = swap
        end do
      end if
      a(j, j) = 1/a(j, j)
      do i = j + 1, n
        a(i, j) = a(i, j)*a(j, j)
        do l = j + 1, n
          a(i, l) = a(i, l) - a(i, j)*a(j, l)
        end do
      end do
    end do
    singular = .false.
  end subroutine decompose_real

  pure subroutine solve_real(n, a, pivot, b)
    integer, value :: n
    real(dp), intent(in) :: a(n, n)
    integer, intent(in) :: pivot(n)
    real(dp), intent(inout) :: b(n)
    integer :: i, j
    do i = 1, n - 1
      call swap_elements(n, b, i, pivot(i))
      do j = i + 1, n
        b(j) = b(j) - a(j, i)*b(i)
      end do
    end do
    do i = n, 1, -1
      b(i) = b(i)*a(i, i)
      do j = 1, i - 1
        b(j) = b(j) - a(j, i)*b(i)
      end do
    end do
  end subroutine solve_real

  pure subroutine swap_elements(n, x, i, j)
    integer, value :: n, i, j
    real(dp), intent(inout) :: x(n)
    real(dp) :: swap
    swap = x(j)
    x(j) = x(i)
    x(i) = swap
  end subroutine swap_elements

  pure subroutine decompose_complex(n, a, b, pivot, singular)
    integer, value :: n
    real(dp), intent(inout) :: a(n, n), b(n, n)   !! real and imaginary parts
    integer, intent(out) :: pivot(n)
    logical, intent(out) :: singular
    real(dp) :: swap, real_part
    integer :: i, j, l, p
    singular = .true.
    do j = 1, n
      p = j
      do i = j + 1, n
        if (abs(a(i, j)) + abs(b(i, j)) > abs(a(p, j)) + abs(b(p, j))) p = i
      end do
      pivot(j) = p
      if (.not. abs(a(p, j)) + abs(b(p, j)) > 0) return
      if (p /= j) then
        do l = j, n
          swap = a(j, l)
          a(j, l) = a(p, l)
          a(p, l) = swap
          swap = b(j, l)
          b(j, l) = b(p, l)
          b(p, l) = swap
        end do
      end if
      call invert(a(j, j), b(j, j))
      do i = j + 1, n
        real_part = a(i, j)*a(j, j) - b(i, j)*b(j, j)
        b(i, j) = a(i, j)*b(j, j) + b(i, j)*a(j, j)
        a(i, j) = real_part
        do l = j + 1, n
          a(i, l) = a(i, l) - (a(i, j)*a(j, l) - b(i, j)*b(j, l))
          b(i, l) = b(i, l) - (a(i, j)*b(j, l) + b(i, j)*a(j, l))
        end do
      end do
    end do
    singular = .false.
  end subroutine decompose_complex

  !> 1/(x + i y), in place; scaled first, since the squares may overflow.
  pure subroutine invert(x, y)
    real(dp), intent(inout) :: x, y
    real(dp) :: per_size, per_square
    per_size = 1/(abs(x) + abs(y))
    x = x*per_size
    y = y*per_size
    per_square = per_size/(x**2 + y**2)
    x = x*per_square
    y = -y*per_square
  end subroutine invert

  pure subroutine solve_complex(n, a, b, pivot, x, y)
    integer, value :: n
    real(dp), intent(in) :: a(n, n), b(n, n)
    integer, intent(in) :: pivot(n)
    real(dp), intent(inout) :: x(n), y(n)         !! real and imaginary parts
    real(dp) :: real_part
    integer :: i, j
    do i = 1, n - 1
      call swap_elements(n, x, i, pivot(i))
      call swap_elements(n, y, i, pivot(i))
      do j = i + 1, n
        x(j) = x(j) - (a(j, i)*x(i) - b(j, i)*y(i))
        y(j) = y(j) - (a(j, i)*y(i) + b(j, i)*x(i))
      end do
    end do
    do i = n, 1, -1
      real_part = x(i)*a(i, i) - y(i)*b(i, i)
      y(i) = x(i)*b(i, i) + y(i)*a(i, i)
      x(i) = real_part
      do j = 1, i - 1
        x(j) = x(j) - (a(j, i)*x(i) - b(j, i)*y(i))
        y(j) = y(j) - (a(j, i)*y(i) + b(j, i)*x(i))
      end do
    end do
  end subroutine solve_complex
end module small_lu
