!> Weighted norms over the components of a state, and the rates of change that a predictor-corrector step reveals. Work on
!> plain arrays in n of `lanes` components.
module step_rates
  use kinds, only: dp
  implicit none
  private
  public :: norm, sum_norm, fastest_mode, path_rate

contains

  !> The norm in which errors are measured: 1 is the tolerance.
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

  !> The norm of the sum of two vectors.
  pure real(dp) function sum_norm(n, first, second, inverse_weight)
    integer, intent(in) :: n
    real(dp), dimension(n), intent(in) :: first, second, inverse_weight
    integer :: i
    sum_norm = 0
    !GCC$ novector
    do i = 1, n
      sum_norm = sum_norm + ((first(i) + second(i))*inverse_weight(i))**2
    end do
    sum_norm = sqrt(sum_norm)
  end function sum_norm

  !> The rate of the fastest mode of the system, estimated as |f_new - f_predicted|/|y_new - y_predicted| (what Hairer &
  !> Wanner 1996, IV.2, use) in the weighted norm; 0 where the correction is within `noise`.
  pure real(dp) function fastest_mode(n, inverse_weight, f_predicted, f_new, y_predicted, y_new, noise)
    integer, intent(in) :: n
    real(dp), dimension(n), intent(in) :: inverse_weight, f_predicted, f_new, y_predicted, y_new
    real(dp), intent(in) :: noise
    real(dp) :: f_jump, y_jump
    integer :: i
    f_jump = 0
    y_jump = 0
    !GCC$ novector
    do i = 1, n
      f_jump = f_jump + ((f_new(i) - f_predicted(i))*inverse_weight(i))**2
      y_jump = y_jump + ((y_new(i) - y_predicted(i))*inverse_weight(i))**2
    end do
    fastest_mode = 0
    if (y_jump > noise**2) fastest_mode = sqrt(f_jump/y_jump)
  end function fastest_mode

  !> The rate at which f changes along the solution, |f_new - f_old|/|y_new - y_old|; 0 where the solution moves by no more than
  !> five tolerances in the step.
  pure real(dp) function path_rate(n, inverse_weight, f_old, f_new, y_old, y_new)
    integer, intent(in) :: n
    real(dp), dimension(n), intent(in) :: inverse_weight, f_old, f_new, y_old, y_new
    real(dp) :: f_path, y_path
    integer :: i
    f_path = 0
    y_path = 0
    !GCC$ novector
    do i = 1, n
      f_path = f_path + ((f_new(i) - f_old(i))*inverse_weight(i))**2
      y_path = y_path + ((y_new(i) - y_old(i))*inverse_weight(i))**2
    end do
    path_rate = 0
    if (y_path >= 25) path_rate = sqrt(f_path/y_path)
  end function path_rate
end module step_rates
