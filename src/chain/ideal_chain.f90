!> Closed form for a chain with two ideal pins, which has one degree of freedom.
module ideal_chain
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, turn_crank, follow_rod, follow_piston
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  implicit none
  private
  public :: accelerate_ideal_chain, respond_ideal_chain, ideal_motion, inertia_at, ideal_rod

contains

  !> Positions and speeds of all bodies at crank angle q [rad] and crank speed [rad/s].
  pure type(motion_t) function ideal_motion(bodies, q, crank_speed) result(motion)
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: q, crank_speed
    logical :: reachable
    call turn_crank(motion, q, crank_speed)
    motion%crank_pin = 0
    motion%crank_pin_rate = 0
    motion%offset = 0
    motion%offset_rate = 0
    call follow_rod(bodies%crank%length, bodies%per_rod_length, bodies%piston%axis_offset, motion, reachable)
    call follow_piston(bodies%crank%length, bodies%rod%length, motion)
  end function ideal_motion

  !> Inertia that moves with the crank at the angle q: of crank, rod and piston with ideal joints, twice their kinetic energy at
  !> 1 rad/s [kg m^2].
  pure real(dp) function inertia_at(bodies, q)
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: q   !! [rad]
    inertia_at = 2*bodies%kinetic_energy(ideal_motion(bodies, q, 1.0_dp))
  end function inertia_at

  !> A' [rad/s] of a rod with ideal pins, and its A'' [rad/s^2] at constant crank speed, for the crank of `motion`.
  pure subroutine ideal_rod(bodies, motion, speed, acceleration)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: speed, acceleration
    real(dp) :: sine, gap, per_arm, ratio
    sine = (bodies%crank%length*motion%sin_crank - bodies%piston%axis_offset)*bodies%per_rod_length
    gap = (1 - sine)*(1 + sine)
    per_arm = bodies%per_rod_length/gap*sqrt(gap)
    ratio = bodies%crank%length*motion%cos_crank*per_arm
    speed = ratio*motion%crank_speed
    acceleration = slope_of_ratio(bodies, sine, per_arm, ratio)*motion%crank_speed**2
  end subroutine ideal_rod

  !> Accelerations from the single equation for q (virtual work of the three bodies; ideal pins do none), the force of the piston
  !> pin's joint from the piston equation and (3.80), and the moment on the crank (see `accelerate_crank_rod`).
  pure subroutine accelerate_ideal_chain(bodies, drive, motion, loads, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads   !! in: the gas; out: the piston pin
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m12, slope, on_crank, on_rod, on_piston, per_arm, ratio, ratio_slope, rate, rate_slope, inertia, total, &
      speed_square

    call bodies%coupling(motion, m12, slope)
    associate (b => bodies, across => bodies%crank%length*motion%sin_crank - bodies%piston%axis_offset, m22 => bodies%rod_term)
      call find_ratios(b, drive, motion, m12, per_arm, ratio, rate, inertia)
      ratio_slope = slope_of_ratio(b, motion%sin_rod, per_arm, ratio)
      rate_slope = -(across*ratio_slope + b%crank%length*motion%cos_crank*(1 + ratio))
      speed_square = motion%crank_speed**2
      on_crank = drive%torque - drive%damping*motion%crank_speed &
        + (b%crank_weight(1)*motion%sin_crank + b%crank_weight(2)*motion%cos_crank)
      on_rod = b%rod_weight(1)*motion%sin_rod - b%rod_weight(2)*motion%cos_rod
      on_piston = b%gravity(1)*b%piston%mass - loads%axial_force
      total = on_crank + ratio*on_rod + rate*on_piston &
        - speed_square*(slope*ratio*(1 + ratio) + (m12 + ratio*m22)*ratio_slope + b%piston%mass*rate*rate_slope)
      if (drive%free_crank) then
        crank_moment = drive%torque
        accelerations%crank = total/inertia
      else
        accelerations%crank = drive%acceleration
        crank_moment = drive%torque - total + inertia*drive%acceleration
      end if
      accelerations%rod = ratio*accelerations%crank + ratio_slope*speed_square
      accelerations%piston = rate*accelerations%crank + rate_slope*speed_square
      accelerations%pin = 0
      loads%moment(piston_pin) = 0
      loads%force(1, piston_pin) = on_piston - b%piston%mass*accelerations%piston
      loads%force(2, piston_pin) = (on_rod - slope*speed_square - m12*accelerations%crank - m22*accelerations%rod &
        - b%rod%length*motion%sin_rod*loads%force(1, piston_pin))*per_arm
    end associate
  end subroutine accelerate_ideal_chain

  !> Changes of the accelerations and of the moment on the crank due to an axial force on the piston.
  pure subroutine respond_ideal_chain(bodies, drive, loads, motion, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m12, slope, per_arm, ratio, rate, inertia
    call bodies%coupling(motion, m12, slope)
    call find_ratios(bodies, drive, motion, m12, per_arm, ratio, rate, inertia)
    accelerations%crank = 0
    crank_moment = 0
    if (drive%free_crank) then
      accelerations%crank = -rate*loads%axial_force/inertia
    else
      crank_moment = rate*loads%axial_force
    end if
    accelerations%rod = ratio*accelerations%crank
    accelerations%piston = rate*accelerations%crank
    accelerations%pin = 0
  end subroutine respond_ideal_chain

  !> k = dA/dq = R cos q/(L cos A), p = dx/dq, and the generalised inertia for q. With them A'' = k q'' + k' q'^2, x'' = p q'' + p'
  !> q'^2. With the offset d of the cylinder axis
  !>
  !>     p = -R sin q (1 + k) + d k,    p' = -(R sin q - d) k' - R cos q (1 + k)
  pure subroutine find_ratios(bodies, drive, motion, m12, per_arm, ratio, rate, inertia)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: m12                !! coupling of crank and rod [kg m^2]
    real(dp), intent(out) :: per_arm           !! 1/(L cos A) [1/m]
    real(dp), intent(out) :: ratio, rate       !! k [-], p [m]
    real(dp), intent(out) :: inertia           !! [kg m^2]
    per_arm = bodies%per_rod_length/((1 - motion%sin_rod)*(1 + motion%sin_rod))*motion%cos_rod
    ratio = bodies%crank%length*motion%cos_crank*per_arm
    rate = -bodies%crank%length*motion%sin_crank*(1 + ratio) + bodies%piston%axis_offset*ratio
    inertia = drive%inertia + (bodies%crank_term + ratio*(2*m12 + ratio*bodies%rod_term) + bodies%piston%mass*rate**2)
  end subroutine find_ratios

  !> k' = tan A (k^2 - 1) - d/(L cos A).
  pure real(dp) function slope_of_ratio(bodies, sin_rod, per_arm, ratio) result(slope)
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: sin_rod, per_arm, ratio   !! sin A, 1/(L cos A) [1/m], k
    slope = bodies%rod%length*sin_rod*per_arm*((ratio - 1)*(ratio + 1)) - bodies%piston%axis_offset*per_arm
  end function slope_of_ratio
end module ideal_chain
