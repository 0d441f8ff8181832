!> Friction forces of surfaces that stick.
module sticking
  use gudgeon_kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, piston_pin
  use chain_loads, only: loads_t, unloaded
  use gudgeon_chain, only: chain_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, most_joints
  use joint_motion, only: joint_motion_t, sliding_acceleration
  implicit none
  private
  public :: hold_surfaces

contains

  !> Add to joints whose surfaces stick the friction forces that keep their sliding speeds constant. The accelerations must be known
  !> without these forces; everything is linear in them. `power` is the power of all joints.
  pure subroutine hold_surfaces(chain, joints, motion, relative, own, loads, accelerations, crank_moment, power)
    type(chain_t), intent(in) :: chain
    type(clearance_joint_t), intent(in) :: joints(:)
    type(motion_t), intent(in) :: motion
    type(joint_motion_t), intent(in) :: relative(:)
    type(joint_loads_t), intent(inout) :: own(:)
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(inout) :: accelerations
    real(dp), intent(inout) :: crank_moment, power
    type(accelerations_t) :: change(most_joints)
    type(loads_t) :: unit(most_joints)
    real(dp) :: moment(most_joints), by_friction(most_joints, most_joints), wanted(most_joints), force(most_joints)
    integer :: i, k

    if (.not. any(own(:size(joints))%sticks)) return
    by_friction = 0
    wanted = 0
    do k = 1, most_joints
      by_friction(k, k) = 1
    end do
    do k = 1, size(joints)
      if (.not. own(k)%sticks) cycle
      unit(k) = unloaded   ! but a friction force of 1 N
      unit(k)%force(:, joints(k)%place) = [-relative(k)%normal(2), relative(k)%normal(1)]
      unit(k)%moment(joints(k)%place) = joints(k)%pin_radius
      call chain%response(motion, unit(k), change(k), moment(k))
      wanted(k) = -sliding_acceleration(joints(k)%place, joints(k)%bearing_turns, joints(k)%pin_radius, relative(k), &
        accelerations, at_rest=.false.)
      do i = 1, size(joints)
        if (own(i)%sticks) by_friction(i, k) = sliding_acceleration(joints(i)%place, joints(i)%bearing_turns, &
          joints(i)%pin_radius, relative(i), change(k), at_rest=.true.)
      end do
    end do
    force(1) = wanted(1)*by_friction(2, 2) - wanted(2)*by_friction(1, 2)
    force(2) = wanted(2)*by_friction(1, 1) - wanted(1)*by_friction(2, 1)
    force = force/(by_friction(1, 1)*by_friction(2, 2) - by_friction(1, 2)*by_friction(2, 1))
    do k = 1, size(joints)
      if (.not. own(k)%sticks) cycle
      associate (f => force(k), place => joints(k)%place)
        own(k)%friction_force = f
        own(k)%contact = own(k)%contact + f*unit(k)%force(:, place)
        own(k)%moment = own(k)%moment + f*joints(k)%pin_radius
        own(k)%power = own(k)%power + f*relative(k)%sliding_speed
        power = power + f*relative(k)%sliding_speed
        loads%force(:, place) = loads%force(:, place) + f*unit(k)%force(:, place)
        loads%moment(place) = loads%moment(place) + f*joints(k)%pin_radius
        crank_moment = crank_moment + f*moment(k)
        call chain%add_response(f, change(k), accelerations)
      end associate
    end do
    if (.not. chain%is_loose(piston_pin)) call chain%complete_loads(motion, accelerations, loads)
  end subroutine hold_surfaces
end module sticking
