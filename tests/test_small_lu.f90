!> Small dense systems, which need row exchanges, real and complex.
module test_small_lu
  use gudgeon_kinds, only: dp
  use checks, only: checks_t
  use small_lu, only: decompose, solve
  implicit none
  private
  public :: run_test_small_lu

contains

  subroutine run_test_small_lu(check)
    class(checks_t), intent(inout) :: check
    call solves_random_systems(check)
    call finds_singular_matrices(check)
  end subroutine run_test_small_lu

  !> Every row exchange there can be: permutations of the rows of a matrix that is strong on its diagonal, of each order to 5.
  subroutine solves_random_systems(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n = 5
    real(dp) :: a(n, n), strong(n, n), x(n), b(n), factors(n, n), worst, complex_worst
    complex(dp) :: complex_a(n, n), complex_x(n), complex_b(n)
    integer :: order(n), pivot(n), i, j, k, code
    logical :: singular

    do i = 1, n
      x(i) = i - 2.5_dp
      do j = 1, n
        strong(i, j) = sin(3.0_dp*i + 7.0_dp*j) + merge(6, 0, i == j)
      end do
    end do
    worst = 0
    complex_worst = 0
    do code = 0, 119
      k = code
      order = [(i, i=1, n)]
      do i = n, 2, -1   ! the permutation of this number, by Fisher and Yates
        j = mod(k, i) + 1
        k = k/i
        order([i, j]) = order([j, i])
      end do
      a = strong(order, :)
      b = matmul(a, x)
      factors = a
      call decompose(factors, pivot, singular)
      call solve(factors, pivot, b)
      worst = max(worst, maxval(abs(b - x)))
      complex_a = cmplx(a, 0.5_dp*transpose(strong), dp)
      complex_x = cmplx(x, 1.0_dp, dp)
      complex_b = matmul(complex_a, complex_x)
      call decompose(complex_a, pivot, singular)
      call solve(complex_a, pivot, complex_b)
      complex_worst = max(complex_worst, maxval(abs(complex_b - complex_x)))
    end do
    call check%close_to(worst, 0.0_dp, 1e-13_dp, 'permuted real systems')
    call check%close_to(complex_worst, 0.0_dp, 1e-12_dp, 'permuted complex systems')
  end subroutine solves_random_systems

  subroutine finds_singular_matrices(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: a(3, 3)
    integer :: pivot(3)
    logical :: singular
    a = 1
    call decompose(a, pivot, singular)
    call check%that(singular, 'a matrix of ones is singular')
  end subroutine finds_singular_matrices
end module test_small_lu
