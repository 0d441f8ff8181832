!> A piston with clearance in its bore: position, acceleration, energy.
!>
!> Its coordinates are y of its centre of mass and its tilt b, positive from x to y. The loads of the bore follow from them: a force
!> along x, which is part of `axial_force`, `bore_force` along y, and `bore_moment` about the centre of mass. The gas force acts
!> along x on the piston's axis, through the centre of mass.
!>
!>     m x_c'' = -F_axial - F_x + m g_x,    m y_c'' = F_bore - F_y + m g_y
!>     I b'' = M_bearing + p_x F_y - p_y F_x + M_bore
!>
!> F is the force on the piston pin; the opposite force acts at the pin's bearing, at -p from the centre of mass c.
module loose_piston
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, piston_pin, body_piston
  use chain_bodies, only: bodies_t, piston_t
  use chain_loads, only: loads_t, bearing_moment
  implicit none
  private
  public :: place_piston, move_centre, centre_acceleration, bearing_acceleration, pin_eccentricity, free_piston, add_energy_beside

contains

  !> Position of the pin's bearing and rotation of the piston, from its coordinates and their rates; the position is added to the
  !> offset of the chain.
  pure subroutine place_piston(piston, motion)
    type(piston_t), intent(in) :: piston
    type(motion_t), intent(inout) :: motion
    real(dp) :: sine, cosine
    associate (at => motion%tilting)
      sine = sin(at%tilt)
      cosine = cos(at%tilt)
      at%com = [piston%com(1)*cosine - piston%com(2)*sine, piston%com(1)*sine + piston%com(2)*cosine]
      at%across = at%offset - at%com(2)
      at%across_rate = at%offset_rate - at%com(1)*at%tilt_rate
      motion%offset(2) = motion%offset(2) + at%across
      motion%offset_rate(2) = motion%offset_rate(2) + at%across_rate
      motion%turning(body_piston) = at%tilt_rate
    end associate
  end subroutine place_piston

  !> Velocity of the centre of mass along x, from that of the pin's bearing.
  pure subroutine move_centre(motion)
    type(motion_t), intent(inout) :: motion
    motion%tilting%com_velocity = motion%piston_velocity - motion%tilting%com(2)*motion%tilting%tilt_rate
  end subroutine move_centre

  !> Acceleration of the centre of mass (x, y) [m/s^2].
  pure function centre_acceleration(motion, accelerations) result(a)
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2)
    associate (at => motion%tilting)
      a(1) = accelerations%piston - at%com(2)*accelerations%tilt - at%com(1)*at%tilt_rate**2
      a(2) = accelerations%offset
    end associate
  end function centre_acceleration

  !> Acceleration of the pin's bearing (x, y) [m/s^2].
  pure function bearing_acceleration(motion, accelerations) result(a)
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2)
    associate (at => motion%tilting)
      a(1) = accelerations%piston
      a(2) = accelerations%offset - at%com(1)*accelerations%tilt + at%com(2)*at%tilt_rate**2
    end associate
  end function bearing_acceleration

  !> Eccentricity e of the piston pin [m].
  pure function pin_eccentricity(motion) result(e)
    type(motion_t), intent(in) :: motion
    real(dp) :: e(2)
    e = motion%offset - motion%crank_pin
    e(2) = e(2) - motion%tilting%across
  end function pin_eccentricity

  !> Accelerations of a separate piston, whose pin has clearance so that the force on it is known. They replace those of a piston in
  !> an ideal guide.
  pure subroutine free_piston(bodies, motion, loads, accelerations)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    type(accelerations_t), intent(inout) :: accelerations   !! in: of a piston in an ideal guide
    real(dp) :: centre(2), bearing(2)
    associate (at => motion%tilting, f => loads%force(:, piston_pin), piston => bodies%piston)
      centre = bodies%gravity + [-(loads%axial_force + f(1)), loads%bore_force - f(2)]*bodies%per_piston_mass
      accelerations%tilt = (bearing_moment(pin_eccentricity(motion), f, loads%moment(piston_pin)) + at%com(1)*f(2) &
        - at%com(2)*f(1) + loads%bore_moment)/piston%inertia
      accelerations%offset = centre(2)
      bearing = centre + [at%com(2), -at%com(1)]*accelerations%tilt + at%com*at%tilt_rate**2
      accelerations%pin(1, piston_pin) = accelerations%pin(1, piston_pin) + (accelerations%piston - bearing(1))
      accelerations%pin(2, piston_pin) = accelerations%pin(2, piston_pin) - bearing(2)
      accelerations%piston = bearing(1)
    end associate
  end subroutine free_piston

  !> Add to an energy [J] that of the piston beside that of its mass moving along the cylinder's axis with the pin's bearing.
  pure subroutine add_energy_beside(bodies, motion, energy)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(inout) :: energy
    real(dp) :: turn
    associate (at => motion%tilting, piston => bodies%piston)
      turn = at%com(2)*at%tilt_rate   ! x' of the bearing minus that of the centre of mass
      energy = energy + 0.5_dp*(piston%mass*(at%offset_rate**2 + turn*(turn - 2*motion%piston_velocity)) &
        + piston%inertia*at%tilt_rate**2) - piston%mass*dot_product(bodies%gravity, [at%com(1), at%offset])
    end associate
  end subroutine add_energy_beside
end module loose_piston
