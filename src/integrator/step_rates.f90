!> The fastest mode of a system, estimated from what a predictor-corrector step evaluates anyway.
module step_rates
  use kinds, only: dp
  implicit none
  private
  public :: fastest_mode

contains

  !> `reach` is h rho with rho = |f_new - f_predicted|/|y_new - y_predicted| (what Hairer & Wanner 1996, IV.2, use), in the
  !> weighted norm; 0 where the correction is within `noise`. `slow` is the rate at which f changes along the solution,
  !> |f_new - f|/|y_new - y|, over rho: 1 where the fastest mode is followed; 0 also where the solution moves by no more
  !> than five tolerances in the step. f at the beginning is `scale` times f_old.
  pure subroutine fastest_mode(n, h, inverse_weight, f_old, scale, f_predicted, f_new, y_old, y_predicted, y_new, noise, &
    reach, slow)
    integer, intent(in) :: n
    real(dp), intent(in) :: h, inverse_weight(n), f_old(n), scale, f_predicted(n), f_new(n), y_old(n), y_predicted(n), &
      y_new(n), noise
    real(dp), intent(out) :: reach, slow
    real(dp) :: f_jump, y_jump, f_path, y_path, w
    integer :: i
    f_jump = 0
    y_jump = 0
    f_path = 0
    y_path = 0
    do i = 1, n
      w = inverse_weight(i)
      f_jump = f_jump + ((f_new(i) - f_predicted(i))*w)**2
      y_jump = y_jump + ((y_new(i) - y_predicted(i))*w)**2
      f_path = f_path + ((f_new(i) - scale*f_old(i))*w)**2
      y_path = y_path + ((y_new(i) - y_old(i))*w)**2
    end do
    reach = 0
    slow = 1
    if (.not. y_jump > noise**2) return
    reach = h*sqrt(f_jump/y_jump)
    slow = 0
    if (y_path >= 25 .and. reach > 0) slow = h*sqrt(f_path/y_path)/reach
  end subroutine fastest_mode
end module step_rates
