!> The piston in its bore, where the scene has a guide that is not ideal.
submodule (gudgeon_scene) scene_guide
  use chain_motion, only: crank_pin, piston_pin
  use loose_piston, only: place_piston, move_centre
  use sticking, only: hold_surfaces
  implicit none

contains

  module procedure place_in_bore
    inside = .true.
    if (self%joint_of_pin(crank_pin) == 0) then   ! which not every closed form reads
      now%motion%crank_pin = 0
      now%motion%crank_pin_rate = 0
    end if
    if (.not. self%guide%is_loose) return
    call self%guide%read_state(y, now%motion%tilting)
    inside = self%guide%admits(now%motion%tilting)
    if (inside) call place_piston(self%chain%bodies%piston, now%motion)
  end procedure place_in_bore

  module procedure accelerate_on_guide
    inside = .true.
    call self%chain%move_piston(now%motion)
    if (self%guide%is_loose) then
      call move_centre(now%motion)
      call self%guide%slide(now%motion, now%guide, now%loads)
      call accelerate_once(self, joints, now, inside)
      if (.not. inside) return
      associate (at => now%motion%tilting, loads => now%loads)
        now%power = now%power + (loads%bore_force*at%offset_rate + loads%bore_moment*at%tilt_rate) &
          - loads%axial_force*at%com_velocity
      end associate
    else
      call find_guide_friction(self, joints, now, inside)
      if (.not. inside) return
      now%power = now%power - now%loads%axial_force*now%motion%piston_velocity
    end if
  end procedure accelerate_on_guide

  !> Accelerations with the present loads, and the friction of surfaces that stick. `inside` is false where the equations of elastic
  !> members cannot be solved.
  pure subroutine accelerate_once(scene, joints, now, inside)
    class(scene_t), intent(in) :: scene
    type(clearance_joint_t), intent(in) :: joints(:)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: inside
    inside = .true.
    if (allocated(scene%chain%elastic)) then
      call accelerate_elastic(scene, joints, now, inside)
      return
    end if
    call scene%chain%accelerate(now%motion, now%loads, now%accelerations, now%crank_moment)
    now%accelerations%rod_end = -now%accelerations%rod
    if (scene%may_stick) call hold_surfaces(scene%chain, joints, now%motion, now%relative, now%joint, now%loads, &
      now%accelerations, now%crank_moment, now%power)
  end subroutine accelerate_once

  !> Accelerations with the friction of an ideal guide, F = mu |N| + the rest. Where the piston pin has clearance N is known from its
  !> law. Else N = N_0 + N_1 F hangs on the accelerations, in which all is linear: N_0 and N_1 are found by two trials, and
  !> N = N_0/(1 - mu N_1 sign N_0). While |mu N_1| < 1 that is the one solution, and the other sign has none; from there on the piston
  !> would jam, and `inside` is false.
  pure subroutine find_guide_friction(scene, joints, now, inside)
    class(scene_t), intent(in) :: scene
    type(clearance_joint_t), intent(in) :: joints(:)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: inside
    type(evaluation_t) :: trial
    real(dp) :: ratio, rest, normal, probe, slope
    inside = .true.
    call scene%guide%friction_on_guide(now%motion%piston_velocity, ratio, rest)
    now%loads%axial_force = now%loads%axial_force - rest
    now%guide%friction_force = rest
    if (abs(ratio) > 0) then
      if (scene%chain%is_loose(piston_pin) .and. .not. scene%may_stick) then
        normal = guide_force(scene, now)
      else
        trial = now
        call accelerate_once(scene, joints, trial, inside)
        if (.not. inside) return
        normal = guide_force(scene, trial)
        probe = max(abs(normal), 1.0_dp)
        trial = now
        trial%loads%axial_force = now%loads%axial_force - probe
        call accelerate_once(scene, joints, trial, inside)
        if (.not. inside) return
        slope = (guide_force(scene, trial) - normal)/probe
        inside = abs(ratio*slope) < 1
        if (.not. inside) return
        normal = normal/(1 - ratio*slope*sign(1.0_dp, normal))
      end if
      now%loads%axial_force = now%loads%axial_force - ratio*abs(normal)
      now%guide%friction_force = now%guide%friction_force + ratio*abs(normal)
    end if
    call accelerate_once(scene, joints, now, inside)
  end subroutine find_guide_friction

  !> N of the piston on an ideal guide, from the force of the pin's joint [N].
  pure real(dp) function guide_force(scene, now)
    class(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    guide_force = scene%chain%bodies%piston%mass*scene%chain%bodies%gravity(2) - now%loads%force(2, piston_pin)
  end function guide_force
end submodule scene_guide
