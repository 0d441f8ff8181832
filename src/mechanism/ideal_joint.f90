!> The mechanism with an ideal pin joint: sin A = (R/L) sin q, x = R cos q + L cos A, one degree of freedom.
module ideal_joint
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t, accelerations_t, turn_crank
  use dynamics, only: drive_t, loads_t
  implicit none
  private
  public :: ideal_motion, follow_crank, ideal_accelerations, ideal_rod_acceleration

contains

  !> Positions and speeds of all bodies at crank angle q [rad] and crank speed [rad/s].
  pure function ideal_motion(mechanism, q, crank_speed) result(motion)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed
    type(motion_t) :: motion
    call turn_crank(motion, q, crank_speed)
    call follow_crank(mechanism, motion)
  end function ideal_motion

  !> The rod and the piston of a motion whose crank is known: its angle with sine and cosine, and its speed.
  pure subroutine follow_crank(mechanism, motion)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(inout) :: motion
    real(dp) :: sin_a
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      sin_a = r*motion%sin_crank*mechanism%per_rod_length
      motion%sin_rod = sin_a
      motion%cos_rod = sqrt((1 - sin_a)*(1 + sin_a))
      motion%rod_speed = rod_ratio(mechanism, motion)*motion%crank_speed
      motion%piston_position = r*motion%cos_crank + l*motion%cos_rod
      motion%piston_velocity = -r*motion%sin_crank*(motion%crank_speed + motion%rod_speed)
    end associate
  end subroutine follow_crank

  !> dA/dq = R cos q/(L cos A).
  pure real(dp) function rod_ratio(mechanism, motion)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(in) :: motion
    rod_ratio = mechanism%crank_length*motion%cos_crank*per_arm(mechanism, motion)
  end function rod_ratio

  !> 1/(L cos A) [1/m].
  pure real(dp) function per_arm(mechanism, motion)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(in) :: motion
    ! over cos A = cos A/cos^2 A: the division need not wait for the root
    per_arm = mechanism%per_rod_length/((1 - motion%sin_rod)*(1 + motion%sin_rod))*motion%cos_rod
  end function per_arm

  !> A'' of the ideal joint at zero crank acceleration [rad/s^2].
  pure real(dp) function ideal_rod_acceleration(mechanism, motion)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(in) :: motion
    ideal_rod_acceleration = rod_ratio_slope(mechanism, motion, rod_ratio(mechanism, motion))*motion%crank_speed**2
  end function ideal_rod_acceleration

  !> d2A/dq2 = tan A ((dA/dq)^2 - 1).
  pure real(dp) function rod_ratio_slope(mechanism, motion, ratio)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(in) :: motion
    real(dp), value, intent(in) :: ratio   !! dA/dq
    rod_ratio_slope = mechanism%rod_length*motion%sin_rod*per_arm(mechanism, motion)*((ratio - 1)*(ratio + 1))
  end function rod_ratio_slope

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
    real(dp) :: m12, slope, on_crank, on_rod, on_piston, rod, rod_slope, piston, piston_slope, inertia, total, speed_square

    call mechanism%coupling(motion, m12, slope)
    associate (m => mechanism, arm => mechanism%crank_length*motion%sin_crank, m22 => mechanism%rod_term)
      ! with k = dA/dq and p = dx/dq: A'' = k q'' + k' q'^2, x'' = p q'' + p' q'^2
      rod = rod_ratio(m, motion)
      rod_slope = rod_ratio_slope(m, motion, rod)
      piston = -arm*(1 + rod)
      piston_slope = -(arm*rod_slope + m%crank_length*motion%cos_crank*(1 + rod))
      speed_square = motion%crank_speed**2
      on_crank = drive%torque - drive%damping*motion%crank_speed &
        + (m%crank_weight(1)*motion%sin_crank + m%crank_weight(2)*motion%cos_crank)
      on_rod = m%rod_weight(1)*motion%sin_rod - m%rod_weight(2)*motion%cos_rod
      on_piston = -loads%gas_force - m%gravity*m%piston_mass
      inertia = m%crank_term + rod*(2*m12 + rod*m22) + m%piston_mass*piston**2
      total = on_crank + rod*on_rod + piston*on_piston &
        - speed_square*(slope*rod*(1 + rod) + (m12 + rod*m22)*rod_slope + m%piston_mass*piston*piston_slope)
      if (drive%free_crank) then
        crank_moment = drive%torque
        accelerations%crank = total/inertia
      else
        accelerations%crank = 0
        crank_moment = drive%torque - total
      end if
      accelerations%rod = rod*accelerations%crank + rod_slope*speed_square
      accelerations%piston = piston*accelerations%crank + piston_slope*speed_square
      accelerations%eccentricity = 0
      loads%pin_moment = 0
      loads%pin_force(1) = on_piston - m%piston_mass*accelerations%piston
      loads%pin_force(2) = (on_rod - slope*speed_square - m12*accelerations%crank - m22*accelerations%rod &
        - m%rod_length*motion%sin_rod*loads%pin_force(1))*per_arm(m, motion)
    end associate
  end subroutine ideal_accelerations
end module ideal_joint
