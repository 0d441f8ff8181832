!> LU decomposition with partial pivoting of the small dense matrices of an implicit step, real and complex.
module small_lu
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: decompose, solve

  interface decompose
    module procedure decompose_real, decompose_complex
  end interface decompose

  interface solve
    module procedure solve_real, solve_complex
  end interface solve

contains

  !> Replace a (n, n) by its factors; `pivot` (n) keeps the row exchanges. `singular` where a pivot is 0 or not a number.
  pure subroutine decompose_real(a, pivot, singular)
    real(dp), intent(inout) :: a(:, :)
    integer, intent(out) :: pivot(:)
    logical, intent(out) :: singular
    real(dp) :: swap
    integer :: i, j, l, n
    n = size(a, 1)
    singular = .false.
    do j = 1, n
      pivot(j) = j
      do i = j + 1, n
        if (abs(a(i, j)) > abs(a(pivot(j), j))) pivot(j) = i
      end do
      if (.not. abs(a(pivot(j), j)) > 0) then
        singular = .true.
        return
      end if
      do l = j, n   ! the factors to the left stay in the order in which `solve` takes them
        swap = a(j, l)
        a(j, l) = a(pivot(j), l)
        a(pivot(j), l) = swap
      end do
      do i = j + 1, n
        a(i, j) = a(i, j)/a(j, j)
        do l = j + 1, n
          a(i, l) = a(i, l) - a(i, j)*a(j, l)
        end do
      end do
    end do
  end subroutine decompose_real

  !> Replace b (n) by the solution.
  pure subroutine solve_real(a, pivot, b)
    real(dp), intent(in) :: a(:, :)
    integer, intent(in) :: pivot(:)
    real(dp), intent(inout) :: b(:)
    real(dp) :: swap
    integer :: i, j, n
    n = size(b)
    do i = 1, n
      swap = b(i)
      b(i) = b(pivot(i))
      b(pivot(i)) = swap
      do j = i + 1, n
        b(j) = b(j) - a(j, i)*b(i)
      end do
    end do
    do i = n, 1, -1
      do j = i + 1, n
        b(i) = b(i) - a(i, j)*b(j)
      end do
      b(i) = b(i)/a(i, i)
    end do
  end subroutine solve_real

  !> The same for complex matrices.
  pure subroutine decompose_complex(a, pivot, singular)
    complex(dp), intent(inout) :: a(:, :)
    integer, intent(out) :: pivot(:)
    logical, intent(out) :: singular
    complex(dp) :: swap
    integer :: i, j, l, n
    n = size(a, 1)
    singular = .false.
    do j = 1, n
      pivot(j) = j
      do i = j + 1, n
        if (size_of(a(i, j)) > size_of(a(pivot(j), j))) pivot(j) = i
      end do
      if (.not. abs(a(pivot(j), j)) > 0) then
        singular = .true.
        return
      end if
      do l = j, n   ! the factors to the left stay in the order in which `solve` takes them
        swap = a(j, l)
        a(j, l) = a(pivot(j), l)
        a(pivot(j), l) = swap
      end do
      do i = j + 1, n
        a(i, j) = a(i, j)/a(j, j)
        do l = j + 1, n
          a(i, l) = a(i, l) - a(i, j)*a(j, l)
        end do
      end do
    end do
  end subroutine decompose_complex

  pure subroutine solve_complex(a, pivot, b)
    complex(dp), intent(in) :: a(:, :)
    integer, intent(in) :: pivot(:)
    complex(dp), intent(inout) :: b(:)
    complex(dp) :: swap
    integer :: i, j, n
    n = size(b)
    do i = 1, n
      swap = b(i)
      b(i) = b(pivot(i))
      b(pivot(i)) = swap
      do j = i + 1, n
        b(j) = b(j) - a(j, i)*b(i)
      end do
    end do
    do i = n, 1, -1
      do j = i + 1, n
        b(i) = b(i) - a(i, j)*b(j)
      end do
      b(i) = b(i)/a(i, i)
    end do
  end subroutine solve_complex

  !> A cheap size of a complex number.
  pure real(dp) function size_of(z)
    complex(dp), intent(in) :: z
    size_of = abs(real(z)) + abs(aimag(z))
  end function size_of
end module small_lu
