!> States of a scene made by hand.
module state_making
  use kinds, only: dp
  use scene, only: scene_t
  use clearance_scene, only: clearance_scene_t
  implicit none
  private
  public :: put_crank, put_pin, pin_of

contains

  !> Set the crank angle [rad] and speed [rad/s] in a state, where they are unknowns.
  pure subroutine put_crank(scene, y, angle, speed)
    class(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: angle, speed
    if (.not. scene%drive%free_crank) return
    y(scene%crank%position) = angle
    y(scene%crank%rate) = speed
  end subroutine put_crank

  !> Set the eccentricity [m] and its rate [m/s] in a state.
  pure subroutine put_pin(scene, y, eccentricity, rate)
    class(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: eccentricity(2), rate(2)
    select type (scene)
    class is (clearance_scene_t)
      y(scene%pin%position:scene%pin%position + 1) = eccentricity
      y(scene%pin%rate:scene%pin%rate + 1) = rate
    end select
  end subroutine put_pin

  !> The eccentricity in a state [m].
  pure function pin_of(scene, y) result(eccentricity)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    real(dp) :: eccentricity(2)
    eccentricity = 0
    select type (scene)
    class is (clearance_scene_t)
      eccentricity = y(scene%pin%position:scene%pin%position + 1)
    end select
  end function pin_of
end module state_making
