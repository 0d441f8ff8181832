!> LU decomposition with partial pivoting of the small dense matrices of an implicit step, real and complex.
module small_lu
  use kinds, only: dp
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
    real(dp) :: row(size(a, 1))
    integer :: i, j, n
    n = size(a, 1)
    singular = .false.
    do j = 1, n
      pivot(j) = j - 1 + maxloc(abs(a(j:, j)), 1)
      if (.not. abs(a(pivot(j), j)) > 0) then
        singular = .true.
        return
      end if
      row = a(j, :)
      a(j, :) = a(pivot(j), :)
      a(pivot(j), :) = row
      do i = j + 1, n
        a(i, j) = a(i, j)/a(j, j)
        a(i, j + 1:) = a(i, j + 1:) - a(i, j)*a(j, j + 1:)
      end do
    end do
  end subroutine decompose_real

  !> Replace b (n) by the solution.
  pure subroutine solve_real(a, pivot, b)
    real(dp), intent(in) :: a(:, :)
    integer, intent(in) :: pivot(:)
    real(dp), intent(inout) :: b(:)
    real(dp) :: swap
    integer :: i, n
    n = size(b)
    do i = 1, n
      swap = b(i)
      b(i) = b(pivot(i))
      b(pivot(i)) = swap
      b(i + 1:) = b(i + 1:) - a(i + 1:, i)*b(i)
    end do
    do i = n, 1, -1
      b(i) = (b(i) - dot_product(a(i, i + 1:), b(i + 1:)))/a(i, i)
    end do
  end subroutine solve_real

  !> The same for complex matrices.
  pure subroutine decompose_complex(a, pivot, singular)
    complex(dp), intent(inout) :: a(:, :)
    integer, intent(out) :: pivot(:)
    logical, intent(out) :: singular
    complex(dp) :: row(size(a, 1))
    integer :: i, j, n
    n = size(a, 1)
    singular = .false.
    do j = 1, n
      pivot(j) = j - 1 + maxloc(abs(real(a(j:, j))) + abs(aimag(a(j:, j))), 1)
      if (.not. abs(a(pivot(j), j)) > 0) then
        singular = .true.
        return
      end if
      row = a(j, :)
      a(j, :) = a(pivot(j), :)
      a(pivot(j), :) = row
      do i = j + 1, n
        a(i, j) = a(i, j)/a(j, j)
        a(i, j + 1:) = a(i, j + 1:) - a(i, j)*a(j, j + 1:)
      end do
    end do
  end subroutine decompose_complex

  pure subroutine solve_complex(a, pivot, b)
    complex(dp), intent(in) :: a(:, :)
    integer, intent(in) :: pivot(:)
    complex(dp), intent(inout) :: b(:)
    complex(dp) :: swap
    integer :: i, n
    n = size(b)
    do i = 1, n
      swap = b(i)
      b(i) = b(pivot(i))
      b(pivot(i)) = swap
      b(i + 1:) = b(i + 1:) - a(i + 1:, i)*b(i)
    end do
    do i = n, 1, -1
      b(i) = (b(i) - sum(a(i, i + 1:)*b(i + 1:)))/a(i, i)
    end do
  end subroutine solve_complex
end module small_lu
