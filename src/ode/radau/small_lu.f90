!> LU decomposition with partial pivoting of the small dense matrices of an implicit step, real and complex.
!>
!> Complex numbers are stored as pairs of reals: library divisions, and products that check for NaN, would cost more than the
!> arithmetic. Substitution of order 3, for one joint with clearance, is written without loops.
module small_lu
  use gudgeon_kinds, only: dp
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

  pure subroutine decompose_real(a, pivot, singular)
    real(dp), intent(inout), contiguous :: a(:, :)
    integer, intent(out), contiguous :: pivot(:)
    logical, intent(out) :: singular
    real(dp) :: swap
    integer :: i, j, l, n, p
    n = size(a, 1)
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

  pure subroutine solve_real(a, pivot, b)
    real(dp), intent(in), contiguous :: a(:, :)
    integer, intent(in), contiguous :: pivot(:)
    real(dp), intent(inout), contiguous :: b(:)
    integer :: i, j, n
    n = size(b)
    do i = 1, n - 1
      call swap_elements(b, i, pivot(i))
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

  pure subroutine swap_elements(x, i, j)
    real(dp), intent(inout), contiguous :: x(:)
    integer, intent(in) :: i, j
    real(dp) :: swap
    swap = x(j)
    x(j) = x(i)
    x(i) = swap
  end subroutine swap_elements

  pure subroutine decompose_complex(a, b, pivot, singular)
    real(dp), intent(inout), contiguous :: a(:, :), b(:, :)   !! real and imaginary parts
    integer, intent(out), contiguous :: pivot(:)
    logical, intent(out) :: singular
    real(dp) :: swap, real_part
    integer :: i, j, l, n, p
    n = size(a, 1)
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

  pure subroutine solve_complex(a, b, pivot, x, y)
    real(dp), intent(in), contiguous :: a(:, :), b(:, :)
    integer, intent(in), contiguous :: pivot(:)
    real(dp), intent(inout), contiguous :: x(:), y(:)         !! real and imaginary parts
    real(dp) :: real_part
    integer :: i, j, n
    n = size(x)
    if (n == 3) then
      call solve_three(a, b, pivot, x, y)
      return
    end if
    do i = 1, n - 1
      call swap_elements(x, i, pivot(i))
      call swap_elements(y, i, pivot(i))
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

  !> Substitution for three complex unknowns.
  pure subroutine solve_three(a, b, pivot, x, y)
    real(dp), intent(in) :: a(3, 3), b(3, 3)
    integer, intent(in) :: pivot(3)
    real(dp), intent(inout), contiguous :: x(:), y(:)
    real(dp) :: u(3), v(3)
    call swap_elements(x, 1, pivot(1))
    call swap_elements(y, 1, pivot(1))
    x(2) = x(2) - (a(2, 1)*x(1) - b(2, 1)*y(1))
    y(2) = y(2) - (a(2, 1)*y(1) + b(2, 1)*x(1))
    x(3) = x(3) - (a(3, 1)*x(1) - b(3, 1)*y(1))
    y(3) = y(3) - (a(3, 1)*y(1) + b(3, 1)*x(1))
    call swap_elements(x, 2, pivot(2))
    call swap_elements(y, 2, pivot(2))
    u = x
    v = y
    u(3) = u(3) - (a(3, 2)*u(2) - b(3, 2)*v(2))
    v(3) = v(3) - (a(3, 2)*v(2) + b(3, 2)*u(2))
    x(3) = u(3)*a(3, 3) - v(3)*b(3, 3)
    y(3) = u(3)*b(3, 3) + v(3)*a(3, 3)
    u(2) = u(2) - (a(2, 3)*x(3) - b(2, 3)*y(3))
    v(2) = v(2) - (a(2, 3)*y(3) + b(2, 3)*x(3))
    x(2) = u(2)*a(2, 2) - v(2)*b(2, 2)
    y(2) = u(2)*b(2, 2) + v(2)*a(2, 2)
    u(1) = u(1) - (a(1, 2)*x(2) - b(1, 2)*y(2)) - (a(1, 3)*x(3) - b(1, 3)*y(3))
    v(1) = v(1) - (a(1, 2)*y(2) + b(1, 2)*x(2)) - (a(1, 3)*y(3) + b(1, 3)*x(3))
    x(1) = u(1)*a(1, 1) - v(1)*b(1, 1)
    y(1) = u(1)*b(1, 1) + v(1)*a(1, 1)
  end subroutine solve_three
end module small_lu
