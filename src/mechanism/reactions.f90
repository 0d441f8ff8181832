!> Reactions in the joints and on the frame from the accelerations (Reis 2013, 3.83, parentheses restored).
module reactions
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t, accelerations_t
  use dynamics, only: loads_t
  implicit none
  private
  public :: reactions_t, reactions_of

  !> Forces [N] found from the bodies' accelerations alone, so F5 = -F_x and F6 = -F_y of the joint's law are a check.
  type :: reactions_t
    real(dp) :: crank_bearing(2) = 0  !! F1, F2: of the frame on the crank
    real(dp) :: crankpin(2) = 0       !! F3, F4: of the crank on the rod
    real(dp) :: pin(2) = 0            !! F5, F6: of the rod on the piston
    real(dp) :: guide = 0             !! F7: of the piston on the guide
    real(dp) :: frame(2) = 0          !! R_x, R_y: resultant on the frame
  end type reactions_t

contains

  pure function reactions_of(mechanism, loads, motion, accelerations) result(reactions)
    type(mechanism_t), intent(in) :: mechanism
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(reactions_t) :: reactions
    real(dp) :: rod(2), crank(2), u, v, f1, f2, f3, f4, f5, f6

    rod = mechanism%rod_com_acceleration(motion, accelerations)
    crank = mechanism%crank_com_acceleration(motion, accelerations)
    u = mechanism%rod_com(1)
    v = mechanism%rod_com(2)
    associate (g => mechanism%gravity, l => mechanism%rod_length, sin_a => motion%sin_rod, cos_a => motion%cos_rod)
      f5 = loads%gas_force + mechanism%piston_mass*(accelerations%piston + g)
      f3 = f5 + mechanism%rod_mass*(rod(1) + g)
      f1 = f3 + mechanism%crank_mass*(crank(1) + g)
      f6 = (mechanism%rod_inertia*accelerations%rod + loads%pin_moment &
        - mechanism%rod_mass*rod(2)*(u*cos_a + v*sin_a) - f3*(u*sin_a - v*cos_a) &
        - f5*((l - u)*sin_a + v*cos_a))/(l*cos_a)
      f4 = f6 + mechanism%rod_mass*rod(2)
      f2 = f4 + mechanism%crank_mass*crank(2)
    end associate
    reactions = reactions_t([f1, f2], [f3, f4], [f5, f6], f6, [f1 - loads%gas_force, f2 - f6])
  end function reactions_of
end module reactions
