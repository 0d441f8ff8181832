!> Closed form for a chain with clearance at the crank pin and an ideal piston pin: crank on one side, rod with piston on the other.
!>
!> The rod's centre of mass is at (h, k) from the piston pin, h = (U - L) cos A + V sin A and k = -(U - L) sin A + V cos A, with
!> dh/dA = k and dk/dA = -h. B is the force on the rod's big end, opposite to that on the crank pin; M_b is the moment on it.
!>
!>     (I_crank + m_crank |U_c|^2) q'' = -J_x R sin q + J_y R cos q + M_j + tau - D q' + gravity,    J = -B
!>     (m_rod + m_piston) x'' + m_rod k A'' = m_rod h A'^2 + B_x - F_gas + (m_rod + m_piston) g_x
!>     m_rod k x'' + (I_rod + m_rod (h^2 + k^2)) A'' = B_x L sin A + B_y L cos A - M_b + m_rod (g_x k - g_y h)
module rod_piston
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t, bearing_moment
  use free_crank, only: accelerate_crank, crank_pin_acceleration
  implicit none
  private
  public :: accelerate_rod_piston

contains

  !> Accelerations, the force of the piston pin's joint from the balance of the rod, and the moment on the crank (see
  !> `accelerate_crank_rod`).
  pure subroutine accelerate_rod_piston(bodies, drive, motion, loads, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads   !! in: the crank pin and the gas; out: the piston pin
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    real(dp) :: h, k, mass, coupling, inertia, on_piston, on_rod, per_determinant, chord(2), b(2), speed_square

    call accelerate_crank(bodies, drive, motion, loads, accelerations%crank, crank_moment)
    associate (rod => bodies%rod, g => bodies%gravity, sin_a => motion%sin_rod, cos_a => motion%cos_rod, &
               piston_mass => bodies%piston%mass, c => motion%crank_pin, j => loads%force(:, crank_pin))
      b = -j
      chord = rod%length*[cos_a, sin_a]
      h = (rod%com(1) - rod%length)*cos_a + rod%com(2)*sin_a
      k = rod%com(2)*cos_a - (rod%com(1) - rod%length)*sin_a
      speed_square = motion%rod_speed**2
      mass = rod%mass + piston_mass
      coupling = rod%mass*k
      inertia = rod%inertia + rod%mass*(h**2 + k**2)
      on_piston = rod%mass*h*speed_square + b(1) - loads%axial_force + mass*g(1)
      on_rod = b(1)*chord(2) + b(2)*chord(1) - bearing_moment(c, j, loads%moment(crank_pin)) + rod%mass*(g(1)*k - g(2)*h)
      per_determinant = 1/(mass*inertia - coupling**2)
      accelerations%piston = (on_piston*inertia - on_rod*coupling)*per_determinant
      accelerations%rod = (on_rod*mass - on_piston*coupling)*per_determinant
      accelerations%pin(:, piston_pin) = 0
      accelerations%pin(:, crank_pin) = crank_pin_acceleration(bodies, motion, accelerations%crank) &
        - [accelerations%piston + chord(2)*accelerations%rod + chord(1)*speed_square, &
        chord(1)*accelerations%rod - chord(2)*speed_square]
      loads%moment(piston_pin) = 0
      loads%force(1, piston_pin) = piston_mass*(g(1) - accelerations%piston) - loads%axial_force
      loads%force(2, piston_pin) = -rod%mass*(h*accelerations%rod + k*speed_square + g(2)) - b(2)
    end associate
  end subroutine accelerate_rod_piston
end module rod_piston
