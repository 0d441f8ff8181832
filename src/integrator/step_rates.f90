!> Weighted norms over the components of a state, and the rates of change that a predictor-corrector step reveals. Work on
!> plain arrays in blocks of `lanes` components.
module step_rates
  use kinds, only: dp
  use adams_differences, only: lanes
  implicit none
  private
  public :: norm, fastest_mode, path_rate

contains

  !> The norm in which errors are measured: 1 is the tolerance.
  pure real(dp) function norm(blocks, values, inverse_weight)
    integer, intent(in) :: blocks
    real(dp), dimension(lanes, blocks), intent(in) :: values, inverse_weight
    integer :: i, b
    norm = 0
    do b = 1, blocks
      do i = 1, lanes
        norm = norm + (values(i, b)*inverse_weight(i, b))**2
      end do
    end do
    norm = sqrt(norm)
  end function norm

  !> The rate of the fastest mode of the system, estimated as |f_new - f_predicted|/|y_new - y_predicted| (what Hairer &
  !> Wanner 1996, IV.2, use) in the weighted norm; 0 where the correction is within `noise`.
  pure real(dp) function fastest_mode(blocks, inverse_weight, f_predicted, f_new, y_predicted, y_new, noise)
    integer, intent(in) :: blocks
    real(dp), dimension(lanes, blocks), intent(in) :: inverse_weight, f_predicted, f_new, y_predicted, y_new
    real(dp), intent(in) :: noise
    real(dp) :: f_jump, y_jump
    integer :: i, b
    f_jump = 0
    y_jump = 0
    do b = 1, blocks
      do i = 1, lanes
        f_jump = f_jump + ((f_new(i, b) - f_predicted(i, b))*inverse_weight(i, b))**2
        y_jump = y_jump + ((y_new(i, b) - y_predicted(i, b))*inverse_weight(i, b))**2
      end do
    end do
    fastest_mode = 0
    if (y_jump > noise**2) fastest_mode = sqrt(f_jump/y_jump)
  end function fastest_mode

  !> The rate at which f changes along the solution, |f_new - f_old|/|y_new - y_old|; 0 where the solution moves by no more than
  !> five tolerances in the step.
  pure real(dp) function path_rate(blocks, inverse_weight, f_old, f_new, y_old, y_new)
    integer, intent(in) :: blocks
    real(dp), dimension(lanes, blocks), intent(in) :: inverse_weight, f_old, f_new, y_old, y_new
    real(dp) :: f_path, y_path
    integer :: i, b
    f_path = 0
    y_path = 0
    do b = 1, blocks
      do i = 1, lanes
        f_path = f_path + ((f_new(i, b) - f_old(i, b))*inverse_weight(i, b))**2
        y_path = y_path + ((y_new(i, b) - y_old(i, b))*inverse_weight(i, b))**2
      end do
    end do
    path_rate = 0
    if (y_path >= 25) path_rate = sqrt(f_path/y_path)
  end function path_rate
end module step_rates
