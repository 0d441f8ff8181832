!> A drive that varies: a torque that depends on the speed, or a prescribed speed with a run-up or one that is steered from outside.
!>
!> The prescribed speed changes within the time T according to w = w_0 + (w_1 - w_0) s^3 (10 - 15 s + 6 s^2), s = t/T, so that its
!> acceleration and the rate of its acceleration are 0 at both ends.
module varying_drive
  use kinds, only: dp
  use monotone_cubic, only: monotone_cubic_t
  use chain_motion, only: motion_t
  use chain_bodies, only: drive_t
  implicit none
  private
  public :: varying_drive_t

  type :: varying_drive_t
    type(monotone_cubic_t), allocatable :: torque   !! [N m] over the speed [rad/s], in addition to the torque of the drive
    real(dp) :: ramp_time = 0                       !! T [s]; 0: there is no run-up
    real(dp) :: first_speed = 0, last_speed = 0     !! w_0, w_1 [rad/s]
    real(dp) :: steered_since = huge(1.0_dp)        !! from this time on the speed is steered [s]
    real(dp) :: steered_turn = 0                    !! angle by which the crank has turned then [rad]
    real(dp) :: steered_speed = 0                   !! speed then [rad/s]
    real(dp) :: steered_rate = 0                    !! constant acceleration since then [rad/s^2]
  contains
    procedure :: at
    procedure :: turned
    procedure :: speed
    procedure :: acceleration
    procedure :: torque_slope
    procedure :: steer
  end type varying_drive_t

contains

  !> The drive at a speed of the driven part [rad/s]; a crank with prescribed speed has the acceleration of `motion`.
  pure type(drive_t) function at(self, drive, speed, motion)
    class(varying_drive_t), intent(in) :: self
    type(drive_t), intent(in) :: drive
    real(dp), intent(in) :: speed
    type(motion_t), intent(in) :: motion
    at = drive
    if (allocated(self%torque)) at%torque = drive%torque + self%torque%value(speed)
    if (self%ramp_time > 0 .or. self%steered_since < huge(1.0_dp)) at%acceleration = motion%held_acceleration
  end function at

  !> Angle by which a crank with prescribed speed has turned at time t [rad].
  pure real(dp) function turned(self, t)
    class(varying_drive_t), intent(in) :: self
    real(dp), intent(in) :: t   !! [s]
    real(dp) :: s
    if (t >= self%steered_since) then
      s = t - self%steered_since
      turned = self%steered_turn + s*(self%steered_speed + 0.5_dp*self%steered_rate*s)
      return
    end if
    s = min(t/self%ramp_time, 1.0_dp)
    turned = self%first_speed*min(t, self%ramp_time) + (self%last_speed - self%first_speed)*self%ramp_time &
      *s**4*(2.5_dp - s*(3 - s)) + self%last_speed*max(t - self%ramp_time, 0.0_dp)
  end function turned

  !> Prescribed speed of the crank [rad/s].
  pure real(dp) function speed(self, t)
    class(varying_drive_t), intent(in) :: self
    real(dp), intent(in) :: t
    real(dp) :: s
    if (t >= self%steered_since) then
      speed = self%steered_speed + self%steered_rate*(t - self%steered_since)
      return
    end if
    s = min(t/self%ramp_time, 1.0_dp)
    speed = self%first_speed + (self%last_speed - self%first_speed)*s**3*(10 - s*(15 - 6*s))
  end function speed

  !> Acceleration of the prescribed speed [rad/s^2].
  pure real(dp) function acceleration(self, t)
    class(varying_drive_t), intent(in) :: self
    real(dp), intent(in) :: t
    real(dp) :: s
    if (t >= self%steered_since) then
      acceleration = self%steered_rate
      return
    end if
    s = min(t/self%ramp_time, 1.0_dp)
    acceleration = (self%last_speed - self%first_speed)/self%ramp_time*30*(s*(1 - s))**2
  end function acceleration

  !> From time t on, where the crank has turned by an angle and has a speed, the speed changes at a constant rate.
  pure subroutine steer(self, t, turned, speed, rate)
    class(varying_drive_t), intent(inout) :: self
    real(dp), intent(in) :: t, turned, speed, rate   !! [s], [rad], [rad/s], [rad/s^2]
    self%steered_since = t
    self%steered_turn = turned
    self%steered_speed = speed
    self%steered_rate = rate
  end subroutine steer

  !> Derivative of the torque with respect to the speed [N m s/rad].
  pure real(dp) function torque_slope(self, speed)
    class(varying_drive_t), intent(in) :: self
    real(dp), intent(in) :: speed
    torque_slope = 0
    if (allocated(self%torque)) torque_slope = self%torque%slope(speed)
  end function torque_slope
end module varying_drive
