!> Cholesky factorisation of small symmetric positive definite matrices, without pivoting.
module small_cholesky
  use kinds, only: dp
  implicit none
  private
  public :: factorise_cholesky, solve_cholesky

contains

  !> Compute the lower triangle L of matrix = L L^T, in place; the upper triangle is neither read nor changed. `definite` is false
  !> if the matrix is not positive definite; the factor must not be used then.
  pure subroutine factorise_cholesky(n, matrix, definite)
    integer, intent(in) :: n
    real(dp), intent(inout) :: matrix(:, :)   !! at least (n, n)
    logical, intent(out) :: definite
    integer :: i, j
    real(dp) :: square
    definite = .true.
    do j = 1, n
      square = matrix(j, j) - dot_product(matrix(j, :j - 1), matrix(j, :j - 1))
      definite = square > 0
      if (.not. definite) return
      matrix(j, j) = sqrt(square)
      do i = j + 1, n
        matrix(i, j) = (matrix(i, j) - dot_product(matrix(i, :j - 1), matrix(j, :j - 1)))/matrix(j, j)
      end do
    end do
  end subroutine factorise_cholesky

  !> Solve L L^T x = b; x replaces b.
  pure subroutine solve_cholesky(n, factor, b)
    integer, intent(in) :: n
    real(dp), intent(in) :: factor(:, :)
    real(dp), intent(inout) :: b(:)
    integer :: i
    do i = 1, n
      b(i) = (b(i) - dot_product(factor(i, :i - 1), b(:i - 1)))/factor(i, i)
    end do
    do i = n, 1, -1
      b(i) = (b(i) - dot_product(factor(i + 1:n, i), b(i + 1:n)))/factor(i, i)
    end do
  end subroutine solve_cholesky
end module small_cholesky
