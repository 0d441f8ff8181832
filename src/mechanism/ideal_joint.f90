!> The mechanism with an ideal pin joint: sin A = (R/L) sin q, x = R cos q + L cos A, one degree of freedom.
module ideal_joint
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t, accelerations_t
  use dynamics, only: drive_t, loads_t
  implicit none
  private
  public :: ideal_motion, find_ideal_motion, follow_crank, ideal_accelerations, ideal_rod_acceleration

contains

  !> Positions and speeds of all bodies at crank angle q [rad] and crank speed [rad/s].
  pure function ideal_motion(mechanism, q, crank_speed) result(motion)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed
    type(motion_t) :: motion
    call find_ideal_motion(mechanism, q, crank_speed, motion)
  end function ideal_motion

  !> The same in place.
  pure subroutine find_ideal_motion(mechanism, q, crank_speed, motion)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed
    type(motion_t), intent(inout) :: motion
    motion%crank_angle = q
    motion%sin_crank = sin(q)
    motion%cos_crank = cos(q)
    motion%crank_speed = crank_speed
    call follow_crank(mechanism, motion)
  end subroutine find_ideal_motion

  !> The rod and the piston of a motion whose crank is known: its angle with sine and cosine, and its speed.
  pure subroutine follow_crank(mechanism, motion)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(inout) :: motion
    real(dp) :: sin_a, cos_a, gap
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      sin_a = r*motion%sin_crank*mechanism%per_rod_length
      gap = (1 - sin_a)*(1 + sin_a)
      cos_a = sqrt(gap)
      motion%sin_rod = sin_a
      motion%cos_rod = cos_a
      ! over cos A = cos A/gap: the division need not wait for the root
      motion%rod_speed = r*motion%cos_crank*motion%crank_speed*mechanism%per_rod_length/gap*cos_a
      motion%piston_position = r*motion%cos_crank + l*cos_a
      motion%piston_velocity = -r*motion%sin_crank*motion%crank_speed - l*sin_a*motion%rod_speed
    end associate
  end subroutine follow_crank

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
    real(dp) :: m12, slope, per_arm, on_crank, on_rod, on_piston
    real(dp) :: rod_ratio, rod_rest, piston_ratio, piston_rest, inertia, total

    call mechanism%coupling(motion, m12, slope)
    associate (m => mechanism, r => mechanism%crank_length, l => mechanism%rod_length, m22 => mechanism%rod_term, &
               sin_q => motion%sin_crank, cos_q => motion%cos_crank, sin_a => motion%sin_rod, cos_a => motion%cos_rod)
      ! A'' = rod_ratio q'' + rod_rest, x'' = piston_ratio q'' + piston_rest
      per_arm = m%per_rod_length/((1 - sin_a)*(1 + sin_a))*cos_a   ! 1/(L cos A)
      rod_ratio = r*cos_q*per_arm
      rod_rest = (l*sin_a*motion%rod_speed**2 - r*sin_q*motion%crank_speed**2)*per_arm
      piston_ratio = -r*sin_q - l*sin_a*rod_ratio
      piston_rest = -r*cos_q*motion%crank_speed**2 - l*cos_a*motion%rod_speed**2 - l*sin_a*rod_rest
      on_crank = m%crank_weight(1)*sin_q + m%crank_weight(2)*cos_q - slope*motion%rod_speed**2 &
        - drive%damping*motion%crank_speed
      on_rod = m%rod_weight(1)*sin_a - m%rod_weight(2)*cos_a - slope*motion%crank_speed**2
      on_piston = -loads%gas_force - m%gravity*m%piston_mass
      inertia = m%crank_term + rod_ratio*(2*m12 + rod_ratio*m22) + m%piston_mass*piston_ratio**2
      total = (on_crank - m12*rod_rest) + rod_ratio*(on_rod - m22*rod_rest) &
        + piston_ratio*(on_piston - m%piston_mass*piston_rest)
      if (drive%free_crank) then
        crank_moment = drive%torque
        accelerations%crank = (total + crank_moment)/inertia
      else
        accelerations%crank = 0
        crank_moment = -total
      end if
      accelerations%rod = rod_ratio*accelerations%crank + rod_rest
      accelerations%piston = piston_ratio*accelerations%crank + piston_rest
      accelerations%eccentricity = 0
      loads%pin_moment = 0
      loads%pin_force(1) = on_piston - m%piston_mass*accelerations%piston
      loads%pin_force(2) = (on_rod - m12*accelerations%crank - m22*accelerations%rod &
        - l*sin_a*loads%pin_force(1))*per_arm
    end associate
  end subroutine ideal_accelerations
end module ideal_joint
