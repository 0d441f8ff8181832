!> States of a scene from given values.
module state_making
  use kinds, only: dp
  use scene_problem, only: scene_t
  use chain_motion, only: piston_pin
  use clearance_joint, only: clearance_joint_t, phase_contact
  implicit none
  private
  public :: set_crank, set_pin, pin_of, set_contact

contains

  !> Set the crank angle [rad] and speed [rad/s] in a state, where they are unknowns.
  pure subroutine set_crank(scene, y, angle, speed)
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: angle, speed
    if (.not. scene%chain%drive%free_crank) return
    y(scene%crank%position) = angle
    y(scene%crank%rate) = speed
  end subroutine set_crank

  !> Set the eccentricity [m] of the piston pin and its rate [m/s] in a state.
  pure subroutine set_pin(scene, y, eccentricity, rate)
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: eccentricity(2), rate(2)
    associate (at => scene%joints(scene%joint_at(piston_pin))%at)
      y(at%position:at%position + 1) = eccentricity
      y(at%rate:at%rate + 1) = rate
    end associate
  end subroutine set_pin

  !> Bring a joint into contact, with surfaces that slide in a direction or stick (0) if its friction is set-valued.
  pure subroutine set_contact(joint, impact_speed, sliding)
    type(clearance_joint_t), intent(inout) :: joint
    real(dp), intent(in) :: impact_speed   !! [m/s]
    integer, intent(in) :: sliding
    call joint%begin_contact(impact_speed)
    joint%slots(joint%acting(phase_contact))%element%sliding = sliding
  end subroutine set_contact

  !> The eccentricity of the piston pin in a state [m].
  pure function pin_of(scene, y) result(eccentricity)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    real(dp) :: eccentricity(2)
    associate (at => scene%joints(scene%joint_at(piston_pin))%at)
      eccentricity = y(at%position:at%position + 1)
    end associate
  end function pin_of
end module state_making
