!> The prescribed speed of a crank.
module test_varying_drive
  use kinds, only: dp
  use varying_drive, only: varying_drive_t
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_varying_drive

contains

  subroutine run_test_varying_drive(check)
    class(checks_t), intent(inout) :: check
    call speed_of_a_ramp(check)
  end subroutine run_test_varying_drive

  !> Angle, speed and acceleration are derivatives of each other, without a jump at the ends.
  subroutine speed_of_a_ramp(check)
    class(checks_t), intent(inout) :: check
    type(varying_drive_t) :: drive
    real(dp) :: t
    integer :: i
    real(dp), parameter :: h = 1e-5_dp
    drive%ramp_time = 0.4_dp
    drive%first_speed = -20
    drive%last_speed = 300
    do i = 1, 59
      t = 0.01_dp*i
      call check%close_to((drive%turned(t + h) - drive%turned(t - h))/(2*h), drive%speed(t), 1e-5_dp, &
        'the speed is the rate of the angle')
      call check%close_to((drive%speed(t + h) - drive%speed(t - h))/(2*h), drive%acceleration(t), 1e-3_dp, &
        'the acceleration is the rate of the speed')
    end do
    call check%close_to(drive%speed(0.0_dp), -20.0_dp, 1e-15_dp, 'first speed')
    call check%close_to(drive%speed(0.2_dp), 140.0_dp, 1e-12_dp, 'speed at half of the ramp is the mean')
    call check%close_to(drive%speed(7.0_dp), 300.0_dp, 1e-15_dp, 'last speed')
    call check%close_to(drive%turned(1.4_dp), 140*0.4_dp + 300, 1e-12_dp, 'angle after the ramp')
    call check%close_to(drive%acceleration(0.0_dp) + drive%acceleration(0.4_dp) + drive%acceleration(9.0_dp), 0.0_dp, 1e-15_dp, &
      'no acceleration at the ends')
  end subroutine speed_of_a_ramp
end module test_varying_drive
