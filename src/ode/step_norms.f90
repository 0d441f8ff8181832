!> Weighted norms over the n components of a state, as squares where only comparisons are needed, since a square root takes as long
!> as a dozen multiplications.
module step_norms
  use kinds, only: dp
  implicit none
  private
  public :: norm, square_of_sum

contains

  !> The norm of errors: 1 is the tolerance.
  pure real(dp) function norm(n, values, inverse_weight)
    integer, intent(in) :: n
    real(dp), dimension(n), intent(in) :: values, inverse_weight
    integer :: i
    norm = 0
    !GCC$ novector
    do i = 1, n
      norm = norm + (values(i)*inverse_weight(i))**2
    end do
    norm = sqrt(norm)
  end function norm

  !> The square of the norm of first + factor*second.
  pure real(dp) function square_of_sum(n, first, factor, second, inverse_weight)
    integer, intent(in) :: n
    real(dp), intent(in) :: factor
    real(dp), dimension(n), intent(in) :: first, second, inverse_weight
    integer :: i
    square_of_sum = 0
    !GCC$ novector
    do i = 1, n
      square_of_sum = square_of_sum + ((first(i) + factor*second(i))*inverse_weight(i))**2
    end do
  end function square_of_sum
end module step_norms
