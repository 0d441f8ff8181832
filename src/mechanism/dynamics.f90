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
  public :: drive_t, loads_t, accelerations_under

  !> How the crank is driven.
  type :: drive_t
    logical :: free_crank = .true.   !! the crank moves under its loads; else its speed is held constant
    real(dp) :: torque = 0           !! tau on a free crank [N m]
    real(dp) :: damping = 0          !! D, moment per crank speed [N m s/rad]
  end type drive_t

  !> What acts on the bodies besides gravity and the drive.
  type :: loads_t
    real(dp) :: pin_force(2) = 0  !! force of the joint on the pin, (F_x, F_y) [N]; the piston receives the opposite
    real(dp) :: pin_moment = 0    !! moment of the joint on the rod about the pin centre, from x to y [N m]
    real(dp) :: gas_force = 0     !! on the piston along -x [N]
  end type loads_t

contains

  !> Accelerations of the bodies, and the moment on the crank [N m]: the drive's torque if the crank is free,
  !> the moment that holds its speed if not.
  pure subroutine accelerations_under(mechanism, drive, loads, motion, accelerations, crank_moment)
    type(mechanism_t), intent(in) :: mechanism
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: m11, m12, m22, slope, on_crank, on_rod

    call mechanism%coupling(motion, m12, slope)
    call mechanism%gravity_moments(motion, on_crank, on_rod)
    m22 = mechanism%rod_term()
    on_crank = on_crank - slope*motion%rod_speed**2 - drive%damping*motion%crank_speed &
      + mechanism%crank_length*(loads%pin_force(2)*motion%cos_crank - loads%pin_force(1)*motion%sin_crank)
    on_rod = on_rod - slope*motion%crank_speed**2 - loads%pin_moment &
      - mechanism%rod_length*(loads%pin_force(1)*motion%sin_rod + loads%pin_force(2)*motion%cos_rod)
    if (drive%free_crank) then
      crank_moment = drive%torque
      on_crank = on_crank + crank_moment
      m11 = mechanism%crank_term()
      accelerations%crank = (on_crank*m22 - on_rod*m12)/(m11*m22 - m12**2)
      accelerations%rod = (on_rod - m12*accelerations%crank)/m22
    else
      accelerations%crank = 0
      accelerations%rod = on_rod/m22
      crank_moment = m12*accelerations%rod - on_crank
    end if
    accelerations%piston = -(loads%gas_force + loads%pin_force(1))/mechanism%piston_mass - mechanism%gravity
  end subroutine accelerations_under
end module dynamics
