!> The mechanism with an ideal pin joint: sin A = (R/L) sin q, x = R cos q + L cos A, one degree of freedom.
module ideal_joint
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t, accelerations_t
  use dynamics, only: drive_t, loads_t
  implicit none
  private
  public :: ideal_motion, ideal_accelerations, ideal_rod_acceleration

contains

  !> Positions and speeds of all bodies at crank angle q [rad] and crank speed [rad/s].
  pure function ideal_motion(mechanism, q, crank_speed) result(motion)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed
    type(motion_t) :: motion
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      motion%crank_angle = q
      motion%sin_crank = sin(q)
      motion%cos_crank = cos(q)
      motion%sin_rod = r*motion%sin_crank/l
      motion%cos_rod = sqrt((1 - motion%sin_rod)*(1 + motion%sin_rod))
      motion%crank_speed = crank_speed
      motion%rod_speed = r*motion%cos_crank*crank_speed/(l*motion%cos_rod)
      motion%piston_position = r*motion%cos_crank + l*motion%cos_rod
      motion%piston_velocity = -r*motion%sin_crank*crank_speed - l*motion%sin_rod*motion%rod_speed
    end associate
  end function ideal_motion

  !> A'' of the ideal joint at zero crank acceleration [rad/s^2].
  pure real(dp) function ideal_rod_acceleration(mechanism, motion)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(in) :: motion
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      ideal_rod_acceleration = (l*motion%sin_rod*motion%rod_speed**2 - r*motion%sin_crank*motion%crank_speed**2) &
        /(l*motion%cos_rod)
    end associate
  end function ideal_rod_acceleration

  !> Accelerations from the one equation in q that remains (virtual work of the three bodies: the joint does none),
  !> the force of the joint on the pin from the piston equation and (3.80), and the moment on the crank (see
  !> `accelerations_under`). `loads%gas_force` is given; `loads%pin_force` is found.
  pure subroutine ideal_accelerations(mechanism, drive, motion, loads, accelerations, crank_moment)
    type(mechanism_t), intent(in) :: mechanism
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m12, m22, slope, on_crank, on_rod, on_piston
    real(dp) :: rod_ratio, rod_rest, piston_ratio, piston_rest, inertia, total

    call mechanism%coupling(motion, m12, slope)
    call mechanism%gravity_moments(motion, on_crank, on_rod)
    m22 = mechanism%rod_term()
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      ! A'' = rod_ratio q'' + rod_rest, x'' = piston_ratio q'' + piston_rest
      rod_ratio = r*motion%cos_crank/(l*motion%cos_rod)
      rod_rest = ideal_rod_acceleration(mechanism, motion)
      piston_ratio = -r*motion%sin_crank - l*motion%sin_rod*rod_ratio
      piston_rest = -r*motion%cos_crank*motion%crank_speed**2 - l*motion%cos_rod*motion%rod_speed**2 &
        - l*motion%sin_rod*rod_rest
      on_crank = on_crank - slope*motion%rod_speed**2 - drive%damping*motion%crank_speed
      on_rod = on_rod - slope*motion%crank_speed**2
      on_piston = -loads%gas_force - mechanism%gravity*mechanism%piston_mass
      inertia = mechanism%crank_term() + rod_ratio*(2*m12 + rod_ratio*m22) + mechanism%piston_mass*piston_ratio**2
      total = (on_crank - m12*rod_rest) + rod_ratio*(on_rod - m22*rod_rest) &
        + piston_ratio*(on_piston - mechanism%piston_mass*piston_rest)
      if (drive%free_crank) then
        crank_moment = drive%torque
        accelerations%crank = (total + crank_moment)/inertia
      else
        accelerations%crank = 0
        crank_moment = -total
      end if
      accelerations%rod = rod_ratio*accelerations%crank + rod_rest
      accelerations%piston = piston_ratio*accelerations%crank + piston_rest
      loads%pin_moment = 0
      loads%pin_force(1) = on_piston - mechanism%piston_mass*accelerations%piston
      loads%pin_force(2) = (on_rod - m12*accelerations%crank - m22*accelerations%rod &
        - l*motion%sin_rod*loads%pin_force(1))/(l*motion%cos_rod)
    end associate
  end subroutine ideal_accelerations
end module ideal_joint
