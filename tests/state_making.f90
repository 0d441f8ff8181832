!> States of a scene from given values.
module state_making
  use gudgeon_kinds, only: dp
  use gudgeon_scene, only: scene_t
  use chain_motion, only: piston_pin
  implicit none
  private
  public :: put_crank, put_pin, pin_of

contains

  !> Set the crank angle [rad] and speed [rad/s] in a state, where they are unknowns.
  pure subroutine put_crank(scene, y, angle, speed)
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: angle, speed
    if (.not. scene%chain%drive%free_crank) return
    y(scene%crank%position) = angle
    y(scene%crank%rate) = speed
  end subroutine put_crank

  !> Set the eccentricity [m] of the piston pin and its rate [m/s] in a state.
  pure subroutine put_pin(scene, y, eccentricity, rate)
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: eccentricity(2), rate(2)
    associate (at => scene%joints(scene%joint_of_pin(piston_pin))%at)
      y(at%position:at%position + 1) = eccentricity
      y(at%rate:at%rate + 1) = rate
    end associate
  end subroutine put_pin

  !> The eccentricity of the piston pin in a state [m].
  pure function pin_of(scene, y) result(eccentricity)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    real(dp) :: eccentricity(2)
    associate (at => scene%joints(scene%joint_of_pin(piston_pin))%at)
      eccentricity = y(at%position:at%position + 1)
    end associate
  end function pin_of
end module state_making
