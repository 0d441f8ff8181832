!> Small dense systems that need row exchanges, real and complex.
module test_small_lu
  use kinds, only: dp
  use checks, only: checks_t
  use small_lu, only: decompose, solve
  implicit none
  private
  public :: run_test_small_lu

contains

  subroutine run_test_small_lu(check)
    class(checks_t), intent(inout) :: check
    call solves_random_systems(check)
    call solves_three(check)
    call finds_singular_matrices(check)
  end subroutine run_test_small_lu

  !> All possible row exchanges: permutations of the rows of a diagonally dominant matrix, for each order up to 5.
  subroutine solves_random_systems(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n = 5
    real(dp) :: a(n, n), strong(n, n), x(n), b(n), factors(n, n), worst, complex_worst
    complex(dp) :: complex_a(n, n), complex_x(n), complex_b(n)
    real(dp) :: real_part(n, n), imaginary_part(n, n), y(n)
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
      do i = n, 2, -1   ! the permutation with this number, by Fisher and Yates
        j = mod(k, i) + 1
        k = k/i
        order([i, j]) = order([j, i])
      end do
      a = strong(order, :)
      b = matmul(a, x)
      factors = a
      call decompose(n, factors, pivot, singular)
      call solve(n, factors, pivot, b)
      worst = max(worst, maxval(abs(b - x)))
      complex_a = cmplx(a, 0.5_dp*transpose(strong), dp)
      complex_x = cmplx(x, 1.0_dp, dp)
      complex_b = matmul(complex_a, complex_x)
      real_part = real(complex_a)
      imaginary_part = aimag(complex_a)
      call decompose(n, real_part, imaginary_part, pivot, singular)
      b = real(complex_b)
      y = aimag(complex_b)
      call solve(n, real_part, imaginary_part, pivot, b, y)
      complex_worst = max(complex_worst, maxval(abs(cmplx(b, y, dp) - complex_x)))
    end do
    call check%close_to(worst, 0.0_dp, 1e-13_dp, 'permuted real systems')
    call check%close_to(complex_worst, 0.0_dp, 1e-12_dp, 'permuted complex systems')
  end subroutine solves_random_systems

  !> Three complex unknowns in every order of the rows.
  subroutine solves_three(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: orders(3, 6) = reshape([1, 2, 3, 1, 3, 2, 2, 1, 3, 2, 3, 1, 3, 1, 2, 3, 2, 1], [3, 6])
    complex(dp) :: a(3, 3), x(3), b(3)
    real(dp) :: real_part(3, 3), imaginary_part(3, 3), u(3), v(3), worst
    integer :: pivot(3), i, j
    logical :: singular
    worst = 0
    do i = 1, 6
      a = reshape([((cmplx(sin(3.0_dp*j) + merge(4, 0, mod(j, 4) == 1), cos(5.0_dp*j), dp)), j=1, 9)], [3, 3])
      a = a(orders(:, i), :)
      x = [(1.5_dp, -2.0_dp), (0.25_dp, 3.0_dp), (-1.0_dp, 0.5_dp)]
      b = matmul(a, x)
      real_part = real(a)
      imaginary_part = aimag(a)
      call decompose(3, real_part, imaginary_part, pivot, singular)
      u = real(b)
      v = aimag(b)
      call solve(3, real_part, imaginary_part, pivot, u, v)
      worst = max(worst, maxval(abs(cmplx(u, v, dp) - x)))
    end do
    call check%close_to(worst, 0.0_dp, 1e-14_dp, 'three complex unknowns')
  end subroutine solves_three

  subroutine finds_singular_matrices(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: a(3, 3)
    integer :: pivot(3)
    logical :: singular
    a = 1
    call decompose(3, a, pivot, singular)
    call check%that(singular, 'a matrix of ones is singular')
  end subroutine finds_singular_matrices
end module test_small_lu
