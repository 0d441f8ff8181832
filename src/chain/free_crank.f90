!> The crank alone, for a crank pin with clearance.
module free_crank
  use kinds, only: dp
  use chain_motion, only: motion_t, crank_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  implicit none
  private
  public :: accelerate_crank, crank_pin_acceleration

contains

  !> Acceleration from (I_crank + m_crank |U_c|^2) q'' = -J_x R sin q + J_y R cos q + M_j + tau - D q' + gravity, where J and M_j
  !> are force and moment on the crank pin, and the moment on the crank (see `accelerate_crank_rod`).
  pure subroutine accelerate_crank(bodies, drive, motion, loads, acceleration, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    real(dp), intent(out) :: acceleration   !! q'' [rad/s^2]
    real(dp), intent(out) :: crank_moment
    real(dp) :: on_crank
    on_crank = drive%torque - drive%damping*motion%crank_speed + loads%moment(crank_pin) &
      + (bodies%crank_own_weight(1)*motion%sin_crank + bodies%crank_own_weight(2)*motion%cos_crank) &
      + bodies%crank%length*(loads%force(2, crank_pin)*motion%cos_crank - loads%force(1, crank_pin)*motion%sin_crank)
    if (drive%free_crank) then
      crank_moment = drive%torque
      acceleration = on_crank/(bodies%crank_inertia + drive%inertia)
    else
      crank_moment = drive%torque - on_crank + (bodies%crank_inertia + drive%inertia)*drive%acceleration
      acceleration = drive%acceleration
    end if
  end subroutine accelerate_crank

  !> Acceleration (x, y) of the centre of the crank pin [m/s^2].
  pure function crank_pin_acceleration(bodies, motion, acceleration) result(a)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: acceleration   !! q'' [rad/s^2]
    real(dp) :: a(2)
    a(1) = -bodies%crank%length*(motion%sin_crank*acceleration + motion%cos_crank*motion%crank_speed**2)
    a(2) = bodies%crank%length*(motion%cos_crank*acceleration - motion%sin_crank*motion%crank_speed**2)
  end function crank_pin_acceleration
end module free_crank
