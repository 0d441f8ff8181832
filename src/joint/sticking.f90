!> Friction forces of surfaces that stick.
module sticking
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, piston_pin
  use chain_loads, only: loads_t, unloaded
  use mechanism_chain, only: chain_t
  use clearance_joint, only: clearance_joint_t, most_joints
  use joint_evaluation, only: joint_evaluation_t, sliding_acceleration
  implicit none
  private
  public :: hold_surfaces

contains

  !> Add to joints whose surfaces stick the friction forces that keep their sliding speeds constant. The accelerations must be known
  !> without these forces; everything is linear in them. `power` is the power of all joints.
  pure subroutine hold_surfaces(chain, joints, motion, own, loads, accelerations, crank_moment, power)
    type(chain_t), intent(in) :: chain
    type(clearance_joint_t), intent(in) :: joints(:)
    type(motion_t), intent(in) :: motion
    type(joint_evaluation_t), intent(inout) :: own(:)
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(inout) :: accelerations
    real(dp), intent(inout) :: crank_moment, power
    type(accelerations_t) :: change(most_joints)
    type(loads_t) :: unit(most_joints)
    real(dp) :: moment(most_joints), by_friction(most_joints, most_joints), wanted(most_joints), force(most_joints), &
      tangent(2, most_joints)
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
      tangent(:, k) = [-own(k)%normal(2), own(k)%normal(1)]
      call joints(k)%load_chain(own(k), tangent(:, k), joints(k)%pin_radius, unit(k))
      call chain%response(motion, unit(k), change(k), moment(k))
      wanted(k) = -sliding_acceleration(joints(k)%pin_radius, own(k), joints(k)%relative_rates(accelerations), at_rest=.false.)
      do i = 1, size(joints)
        if (own(i)%sticks) by_friction(i, k) = &
          sliding_acceleration(joints(i)%pin_radius, own(i), joints(i)%relative_rates(change(k)), at_rest=.true.)
      end do
    end do
    force(1) = wanted(1)*by_friction(2, 2) - wanted(2)*by_friction(1, 2)
    force(2) = wanted(2)*by_friction(1, 1) - wanted(1)*by_friction(2, 1)
    force = force/(by_friction(1, 1)*by_friction(2, 2) - by_friction(1, 2)*by_friction(2, 1))
    do k = 1, size(joints)
      if (.not. own(k)%sticks) cycle
      associate (f => force(k), pin => joints(k)%site%pin)
        own(k)%friction_force = f
        own(k)%contact = own(k)%contact + f*tangent(:, k)
        own(k)%force = own(k)%force + f*tangent(:, k)
        own(k)%moment = own(k)%moment + f*joints(k)%pin_radius
        own(k)%power = own(k)%power + f*own(k)%sliding_speed
        power = power + f*own(k)%sliding_speed
        loads%force(:, pin) = loads%force(:, pin) + f*unit(k)%force(:, pin)
        loads%moment(pin) = loads%moment(pin) + f*unit(k)%moment(pin)
        crank_moment = crank_moment + f*moment(k)
        call chain%add_response(f, change(k), accelerations)
      end associate
    end do
    if (.not. chain%is_loose(piston_pin)) call chain%complete_loads(motion, accelerations, loads)
  end subroutine hold_surfaces
end module sticking
