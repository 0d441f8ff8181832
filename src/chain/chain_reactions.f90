!> Reactions in the joints and on the frame, from the accelerations (Reis 2013, 3.83, with parentheses restored).
module chain_reactions
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin
  use chain_bodies, only: bodies_t
  use chain_loads, only: loads_t, bearing_moment
  use loose_piston, only: centre_acceleration
  implicit none
  private
  public :: reactions_t, reactions_of, elastic_reactions

  !> Forces [N] that follow from the accelerations of the bodies alone. F5 = -F_x and F6 = -F_y of the joint's law are therefore a
  !> check; with clearance at the crank pin so are F3 = -J_x and F4 = -J_y.
  type :: reactions_t
    real(dp) :: crank_bearing(2) = 0  !! F1, F2: force of the frame on the crank
    real(dp) :: crankpin(2) = 0       !! F3, F4: force of the crank on the rod
    real(dp) :: pin(2) = 0            !! F5, F6: force of the rod, or of a floating pin, on the piston
    real(dp) :: guide = 0             !! F7: force of the piston on the guide
    real(dp) :: frame(2) = 0          !! R_x, R_y: resultant force on the frame
    real(dp) :: small_end(2) = 0      !! force of the rod on a floating pin
  end type reactions_t

contains

  !> The reactions of a chain with a rigid rod. The moments of the pins' joints are given; those on the rod at an ideal pin are 0.
  pure type(reactions_t) function reactions_of(bodies, loads, motion, accelerations) result(reactions)
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: rod(2), crank(2), piston(2), u, v, f1, f2, f3, f4, f5, f6, f7, on_rod

    call centre_forces(bodies, motion, accelerations, crank, rod)
    piston = piston_force(bodies, motion, accelerations)
    u = bodies%rod%com(1)
    v = bodies%rod%com(2)
    associate (l => bodies%rod%length, sin_a => motion%sin_rod, cos_a => motion%cos_rod)
      on_rod = loads%moment(piston_pin) + bearing_moment(motion%crank_pin, loads%force(:, crank_pin), loads%moment(crank_pin))
      f5 = loads%axial_force + piston(1)
      f3 = f5 + rod(1)
      f1 = f3 + crank(1)
      f6 = (bodies%rod%inertia*accelerations%rod + on_rod - rod(2)*(u*cos_a + v*sin_a) &
        - f3*(u*sin_a - v*cos_a) - f5*((l - u)*sin_a + v*cos_a))/(l*cos_a)
      f4 = f6 + rod(2)
      f2 = f4 + crank(2)
      f7 = f6 - piston(2)
    end associate
    reactions = reactions_t([f1, f2], [f3, f4], [f5, f6], f7, [f1 - loads%axial_force, f2 - f7])
  end function reactions_of

  !> The reactions of a chain with an elastic rod, from the forces and moments that its motion requires at its ends
  !> (`elastic_end_forces`).
  pure type(reactions_t) function elastic_reactions(bodies, loads, motion, accelerations, on_ends, turning) result(reactions)
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(in) :: on_ends(2)   !! sum of the forces at its ends [N]
    real(dp), intent(in) :: turning      !! their moment about the big end, including moments at the ends, positive against A [N m]
    real(dp) :: crank(2), rod(2), piston(2), moments, across
    piston = piston_force(bodies, motion, accelerations)
    call centre_forces(bodies, motion, accelerations, crank, rod)
    moments = loads%moment(piston_pin) + bearing_moment(motion%crank_pin, loads%force(:, crank_pin), loads%moment(crank_pin))
    across = (turning - moments)/motion%chord   ! component of the piston pin's force
    reactions%pin(1) = loads%axial_force + piston(1)
    reactions%pin(2) = -(across + motion%sin_rod*reactions%pin(1))/motion%cos_rod
    reactions%crankpin = on_ends + reactions%pin
    reactions%crank_bearing = reactions%crankpin + crank
    reactions%guide = reactions%pin(2) - piston(2)
    reactions%frame = reactions%crank_bearing - [loads%axial_force, reactions%guide]
  end function elastic_reactions

  !> Mass times acceleration minus weight (x, y) of the piston [N].
  pure function piston_force(bodies, motion, accelerations) result(force)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: force(2)
    force = [accelerations%piston, 0.0_dp]
    if (bodies%piston%is_loose) force = centre_acceleration(motion, accelerations)
    force = bodies%piston%mass*(force - bodies%gravity)
  end function piston_force

  !> Mass times acceleration minus weight (x, y) of crank and rod [N].
  pure subroutine centre_forces(bodies, motion, accelerations, crank, rod)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: crank(2), rod(2)
    real(dp) :: along(2), pin(2)
    associate (c => bodies%crank%com, r => bodies%rod%com, q_2 => motion%crank_speed**2)
      along = [c(1)*motion%cos_crank - c(2)*motion%sin_crank, c(1)*motion%sin_crank + c(2)*motion%cos_crank]
      crank = bodies%crank%mass*([-along(2), along(1)]*accelerations%crank - along*q_2 - bodies%gravity)
      pin = bodies%crank%length*[motion%cos_crank, motion%sin_crank]
      along = [r(1)*motion%cos_rod + r(2)*motion%sin_rod, r(2)*motion%cos_rod - r(1)*motion%sin_rod]
      rod = bodies%rod%mass*([-pin(2), pin(1)]*accelerations%crank - pin*q_2 - accelerations%pin(:, crank_pin) &
        + [along(2), -along(1)]*accelerations%rod - along*motion%rod_speed**2 - bodies%gravity)
    end associate
  end subroutine centre_forces
end module chain_reactions
