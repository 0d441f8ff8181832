!> Band matrices with diagonally dominant columns: solutions, growth of the elements, singular matrices.
module test_banded_lu
  use kinds, only: dp
  use checks, only: checks_t
  use banded_lu, only: decompose_band, solve_band
  implicit none
  private
  public :: run_test_banded_lu

contains

  subroutine run_test_banded_lu(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: sizes(2, 9) = reshape([1, 1, 2, 1, 3, 2, 7, 1, 8, 3, 9, 8, 12, 12, 40, 6, 41, 6], [2, 9])
    integer :: i
    do i = 1, size(sizes, 2)
      call solves(check, sizes(1, i), sizes(2, i))
    end do
    call finds_singular_matrices(check)
  end subroutine run_test_banded_lu

  !> Several right-hand sides of a matrix whose columns are barely dominant, some of whose elements are 0.
  subroutine solves(check, n, band)
    class(checks_t), intent(inout) :: check
    integer, intent(in) :: n, band
    integer, parameter :: sides = 3
    real(dp) :: a(-band:band, n), factors(-band:band, n), x(n, sides), b(n, sides), most
    logical :: singular
    integer :: i, l
    a = 0
    do l = 1, n
      do i = max(-band, 1 - l), min(band, n - l)
        if (mod(3*i + 5*l, 4) > 0) a(i, l) = sin(7.0_dp*i + 11.0_dp*l)
      end do
      a(0, l) = 0
      a(0, l) = max((1 + 1e-3_dp)*sum(abs(a(:, l))), 0.1_dp)
    end do
    x = reshape([(cos(2.0_dp*i), i=1, n*sides)], [n, sides])
    b = 0
    do l = 1, n
      do i = max(-band, 1 - l), min(band, n - l)
        b(l + i, :) = b(l + i, :) + a(i, l)*x(l, :)
      end do
    end do
    most = maxval(abs(a))
    factors = a
    call decompose_band(n, band, factors, singular)
    call check%that(.not. singular, 'a dominant band matrix is regular')
    call check%that(maxval(abs(factors(:-1, :))) <= 2*most .and. maxval(1/abs(factors(0, :))) <= 2*most, &
      'elements of the factors do not grow')
    call check%that(maxval(abs(factors(1:, :))) <= 1, 'multipliers are not above one')
    call solve_band(n, band, factors, sides, b)
    call check%close_to(maxval(abs(b - x)), 0.0_dp, 1e-11_dp, 'solutions of a band matrix')
  end subroutine solves

  !> A column of zeros, at an even and at an odd place.
  subroutine finds_singular_matrices(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: a(-2:2, 5)
    logical :: singular
    integer :: l
    do l = 1, 5
      a = 0
      a(0, :) = 1
      a(0, l) = 0
      call decompose_band(5, 2, a, singular)
      call check%that(singular, 'a column of zeros makes a band matrix singular')
    end do
  end subroutine finds_singular_matrices
end module test_banded_lu
