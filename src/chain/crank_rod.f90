!> Closed form for a chain with clearance at the piston pin and an ideal crank pin: crank with rod on one side, piston on the other
!> (Reis 2013, 3.67-3.69, corrected: the printed third term has wrong signs, and multiplies angles instead of speeds).
!>
!>     m11 q'' + m12 A'' = Q_q - c A'^2
!>     m12 q'' + m22 A'' = Q_A - c q'^2
!>     Q_q = -F_x R sin q + F_y R cos q + tau - D q' + gravity
!>     Q_A = -F_x L sin A - F_y L cos A - M_pin + gravity
!>     m_piston x'' = -F_gas - F_x + m_piston g_x
module crank_rod
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  implicit none
  private
  public :: accelerate_crank_rod, respond_crank_rod

contains

  !> Accelerations, and the moment on the crank [N m]: the torque of the drive if the crank is free, otherwise the moment required
  !> for the prescribed speed.
  pure subroutine accelerate_crank_rod(bodies, drive, loads, motion, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m12, slope, on_crank, on_rod, crank(2), rod(2), per_determinant

    call bodies%coupling(motion, m12, slope)
    associate (b => bodies, f_x => loads%force(1, piston_pin), f_y => loads%force(2, piston_pin))
      crank(1) = b%crank%length*motion%cos_crank
      crank(2) = b%crank%length*motion%sin_crank
      rod(1) = b%rod%length*motion%cos_rod
      rod(2) = b%rod%length*motion%sin_rod
      on_crank = drive%torque - drive%damping*motion%crank_speed &
        + (b%crank_weight(1)*motion%sin_crank + b%crank_weight(2)*motion%cos_crank) &
        + (f_y*crank(1) - f_x*crank(2)) - slope*motion%rod_speed**2
      on_rod = (b%rod_weight(1)*motion%sin_rod - b%rod_weight(2)*motion%cos_rod) &
        - (loads%moment(piston_pin) + f_x*rod(2) + f_y*rod(1)) - slope*motion%crank_speed**2
      if (drive%free_crank) then
        crank_moment = drive%torque
        per_determinant = 1/(drive%inertia*b%rod_term + (b%inertia_product - m12**2))
        accelerations%crank = (on_crank*b%rod_term - on_rod*m12)*per_determinant
        accelerations%rod = (on_rod*(b%crank_term + drive%inertia) - on_crank*m12)*per_determinant
      else
        accelerations%crank = drive%acceleration
        accelerations%rod = (on_rod - m12*drive%acceleration)/b%rod_term
        crank_moment = (b%crank_term + drive%inertia)*drive%acceleration + m12*accelerations%rod - (on_crank - drive%torque)
      end if
      accelerations%piston = b%gravity(1) - (loads%axial_force + f_x)*b%per_piston_mass
      accelerations%pin(:, crank_pin) = 0
      accelerations%pin(1, piston_pin) = -(crank(1)*motion%crank_speed**2 + rod(1)*motion%rod_speed**2 + accelerations%piston) &
        - (crank(2)*accelerations%crank + rod(2)*accelerations%rod)
      accelerations%pin(2, piston_pin) = (rod(2)*motion%rod_speed**2 - crank(2)*motion%crank_speed**2) &
        + (crank(1)*accelerations%crank - rod(1)*accelerations%rod)
    end associate
  end subroutine accelerate_crank_rod

  !> Changes of the accelerations and of the moment on the crank due to a load of the piston pin and of the gas.
  pure subroutine respond_crank_rod(bodies, drive, loads, motion, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m12, slope, on_crank, on_rod, crank(2), rod(2)

    call bodies%coupling(motion, m12, slope)
    crank = bodies%crank%length*[motion%cos_crank, motion%sin_crank]
    rod = bodies%rod%length*[motion%cos_rod, motion%sin_rod]
    associate (f => loads%force(:, piston_pin))
      on_crank = f(2)*crank(1) - f(1)*crank(2)
      on_rod = -(loads%moment(piston_pin) + f(1)*rod(2) + f(2)*rod(1))
      accelerations%crank = 0
      crank_moment = 0
      if (drive%free_crank) accelerations%crank = (on_crank*bodies%rod_term - on_rod*m12) &
        /(drive%inertia*bodies%rod_term + (bodies%inertia_product - m12**2))
      accelerations%rod = (on_rod - m12*accelerations%crank)/bodies%rod_term
      if (.not. drive%free_crank) crank_moment = m12*accelerations%rod - on_crank
      accelerations%piston = -(loads%axial_force + f(1))*bodies%per_piston_mass
      accelerations%pin(:, crank_pin) = 0
      accelerations%pin(1, piston_pin) = -(crank(2)*accelerations%crank + rod(2)*accelerations%rod) - accelerations%piston
      accelerations%pin(2, piston_pin) = crank(1)*accelerations%crank - rod(1)*accelerations%rod
    end associate
  end subroutine respond_crank_rod
end module crank_rod
