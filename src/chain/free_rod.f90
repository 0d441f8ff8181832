!> Closed form for a chain with clearance at both pins: crank, rod and piston are separate, and no accelerations are coupled.
!>
!>     m_rod G'' = F - J + m_rod g
!>     I_rod A'' = F . d(S - G)/dA - J . d(B - G)/dA - M_pin - M_b
!>     m_piston x'' = -F_gas - F_x + m_piston g_x
!>
!> G is the rod's centre of mass, B the centre of its big end, S that of the piston pin. J is the force on the crank pin; the
!> opposite force acts at B. F is the force on the piston pin, at S.
module free_rod
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t, bearing_moment
  use free_crank, only: accelerate_crank, crank_pin_acceleration
  implicit none
  private
  public :: accelerate_free_rod

contains

  !> Accelerations, and the moment on the crank (see `accelerate_crank_rod`).
  pure subroutine accelerate_free_rod(bodies, drive, loads, motion, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: big(2), small(2), centre(2), speed_square

    call accelerate_crank(bodies, drive, motion, loads, accelerations%crank, crank_moment)
    associate (rod => bodies%rod, sin_a => motion%sin_rod, cos_a => motion%cos_rod, &
               j => loads%force(:, crank_pin), f => loads%force(:, piston_pin))
      ! B - G and S - G; the derivative of (X, Y) with respect to A is (Y, -X)
      big(1) = -rod%com(1)*cos_a - rod%com(2)*sin_a
      big(2) = rod%com(1)*sin_a - rod%com(2)*cos_a
      small(1) = rod%length*cos_a + big(1)
      small(2) = big(2) - rod%length*sin_a
      speed_square = motion%rod_speed**2
      centre = (f - j)/rod%mass + bodies%gravity
      accelerations%rod = (f(1)*small(2) - f(2)*small(1) - (j(1)*big(2) - j(2)*big(1)) - loads%moment(piston_pin) &
        - bearing_moment(motion%crank_pin, j, loads%moment(crank_pin)))/rod%inertia
      accelerations%piston = bodies%gravity(1) - (loads%axial_force + f(1))*bodies%per_piston_mass
      accelerations%pin(:, crank_pin) = crank_pin_acceleration(bodies, motion, accelerations%crank) &
        - (centre + accelerations%rod*[big(2), -big(1)] - speed_square*big)
      accelerations%pin(:, piston_pin) = centre + accelerations%rod*[small(2), -small(1)] - speed_square*small
      accelerations%pin(1, piston_pin) = accelerations%pin(1, piston_pin) - accelerations%piston
    end associate
  end subroutine accelerate_free_rod
end module free_rod
