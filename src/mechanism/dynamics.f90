!> Equations of motion of crank, rod and piston under the forces of the joint (Reis 2013, 3.67-3.69, corrected: the
!> printed third term has wrong signs and multiplies angles instead of speeds).
!>
!>     m11 q'' + m12 A'' = Q_q - c A'^2
!>     m12 q'' + m22 A'' = Q_A - c q'^2
!>     Q_q = -F_x R sin q + F_y R cos q + tau - D q' + gravity
!>     Q_A = -F_x L sin A - F_y L cos A - M_pin + gravity
!>     m_piston x'' = -F_gas - F_x - g m_piston
module dynamics
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t, accelerations_t
  implicit none
  private
  public :: drive_t, loads_t, pin_force_size, accelerations_under

  !> How the crank is driven.
  type :: drive_t
    logical :: free_crank = .true.   !! the crank moves under its loads; else its speed is held constant
    real(dp) :: torque = 0           !! tau on a free crank [N m]
    real(dp) :: damping = 0          !! D, moment per crank speed [N m s/rad]
  end type drive_t

  !> What acts on the bodies besides gravity and the drive.
  type :: loads_t
    real(dp) :: pin_force(2)  !! force of the joint on the pin, (F_x, F_y) [N]; the piston receives the opposite
    real(dp) :: pin_moment    !! moment of the joint on the rod about the pin centre, from x to y [N m]
    real(dp) :: gas_force     !! on the piston along -x [N]
  end type loads_t

contains

  !> Size of the joint's force [N].
  pure real(dp) function pin_force_size(loads)
    type(loads_t), intent(in) :: loads
    pin_force_size = sqrt(loads%pin_force(1)**2 + loads%pin_force(2)**2)   ! without the scaling of norm2
  end function pin_force_size

  !> Accelerations of the bodies, and the moment on the crank [N m]: the drive's torque if the crank is free,
  !> the moment that holds its speed if not.
  pure subroutine accelerations_under(mechanism, drive, loads, motion, accelerations, crank_moment)
    type(mechanism_t), intent(in) :: mechanism
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m12, slope, on_crank, on_rod, crank(2), rod(2), per_determinant

    call mechanism%coupling(motion, m12, slope)
    associate (m => mechanism, f => loads%pin_force)
      crank(1) = m%crank_length*motion%cos_crank
      crank(2) = m%crank_length*motion%sin_crank
      rod(1) = m%rod_length*motion%cos_rod
      rod(2) = m%rod_length*motion%sin_rod
      on_crank = drive%torque - drive%damping*motion%crank_speed &
        + (m%crank_weight(1)*motion%sin_crank + m%crank_weight(2)*motion%cos_crank) &
        + (f(2)*crank(1) - f(1)*crank(2)) - slope*motion%rod_speed**2
      on_rod = (m%rod_weight(1)*motion%sin_rod - m%rod_weight(2)*motion%cos_rod) &
        - (loads%pin_moment + f(1)*rod(2) + f(2)*rod(1)) - slope*motion%crank_speed**2
      if (drive%free_crank) then
        crank_moment = drive%torque
        per_determinant = 1/(m%inertia_product - m12**2)
        accelerations%crank = (on_crank*m%rod_term - on_rod*m12)*per_determinant
        accelerations%rod = (on_rod*m%crank_term - on_crank*m12)*per_determinant
      else
        accelerations%crank = 0
        accelerations%rod = on_rod/m%rod_term
        crank_moment = m12*accelerations%rod - (on_crank - drive%torque)
      end if
      accelerations%piston = -(loads%gas_force + f(1))*m%per_piston_mass - m%gravity
      accelerations%eccentricity(1) = -(crank(1)*motion%crank_speed**2 + rod(1)*motion%rod_speed**2 + accelerations%piston) &
        - (crank(2)*accelerations%crank + rod(2)*accelerations%rod)
      accelerations%eccentricity(2) = (rod(2)*motion%rod_speed**2 - crank(2)*motion%crank_speed**2) &
        + (crank(1)*accelerations%crank - rod(1)*accelerations%rod)
    end associate
  end subroutine accelerations_under
end module dynamics
