!> Friction forces of surfaces that stick, in several joints at once.
module sticking
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, piston_pin
  use chain_loads, only: loads_t, unloaded
  use mechanism_chain, only: chain_t
  use clearance_joint, only: clearance_joint_t, most_joints
  use joint_evaluation, only: joint_evaluation_t, sliding_acceleration
  implicit none
  private
  public :: hold_surfaces, find_released

  !> What a friction force of 1 N between the surfaces of a joint that stick changes.
  type :: response_t
    type(loads_t) :: unit             !! that force in the loads of the chain
    real(dp) :: tangent(2)            !! its direction
    type(accelerations_t) :: change
    real(dp) :: moment                !! change of the moment on the crank [m]
    real(dp) :: sliding(most_joints)  !! of the rates of the sliding speeds of all joints that stick [1/kg]
  end type response_t

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
    type(response_t) :: by(most_joints)
    real(dp) :: force(most_joints), w(most_joints, most_joints)
    logical :: sticks(most_joints)
    integer :: k

    if (.not. any(own(:size(joints))%sticks)) return
    call find_responses(chain, joints, motion, own, by)
    force = 0
    sticks = .false.
    do k = 1, size(joints)
      sticks(k) = own(k)%sticks
      if (sticks(k)) force(k) = &
        -sliding_acceleration(joints(k)%pin_radius, own(k), joints(k)%relative_rates(accelerations), at_rest=.false.)
    end do
    call find_matrix(by, w)
    call solve(sticks, w, force)
    do k = 1, size(joints)
      if (.not. own(k)%sticks) cycle
      associate (f => force(k), pin => joints(k)%site%pin)
        own(k)%friction_force = f
        own(k)%contact = own(k)%contact + f*by(k)%tangent
        own(k)%force = own(k)%force + f*by(k)%tangent
        own(k)%moment = own(k)%moment + f*joints(k)%pin_radius
        own(k)%power = own(k)%power + f*own(k)%sliding_speed
        power = power + f*own(k)%sliding_speed
        loads%force(:, pin) = loads%force(:, pin) + f*by(k)%unit%force(:, pin)
        loads%moment(pin) = loads%moment(pin) + f*by(k)%unit%moment(pin)
        crank_moment = crank_moment + f*by(k)%moment
        call chain%add_response(f, by(k)%change, accelerations)
      end associate
    end do
    if (.not. chain%is_loose(piston_pin)) call chain%complete_loads(motion, accelerations, loads)
  end subroutine hold_surfaces

  !> Responses to the friction forces of the joints whose surfaces stick.
  pure subroutine find_responses(chain, joints, motion, own, by)
    type(chain_t), intent(in) :: chain
    type(clearance_joint_t), intent(in) :: joints(:)
    type(motion_t), intent(in) :: motion
    type(joint_evaluation_t), intent(in) :: own(:)
    type(response_t), intent(inout) :: by(most_joints)
    integer :: i, k
    do k = 1, most_joints
      by(k)%sliding = 0
    end do
    do k = 1, size(joints)
      if (.not. own(k)%sticks) cycle
      by(k)%unit = unloaded
      by(k)%tangent = [-own(k)%normal(2), own(k)%normal(1)]
      call joints(k)%load_chain(own(k), by(k)%tangent, joints(k)%pin_radius, by(k)%unit)
      call chain%response(motion, by(k)%unit, by(k)%change, by(k)%moment)
      do i = 1, size(joints)
        if (own(i)%sticks) by(k)%sliding(i) = &
          sliding_acceleration(joints(i)%pin_radius, own(i), joints(i)%relative_rates(by(k)%change), at_rest=.true.)
      end do
    end do
  end subroutine find_responses

  !> W [1/kg], with a row for each sliding speed and a column for each friction force; symmetric and positive definite.
  pure subroutine find_matrix(by, w)
    type(response_t), intent(in) :: by(most_joints)
    real(dp), intent(out) :: w(most_joints, most_joints)
    integer :: k
    do k = 1, most_joints
      w(:, k) = by(k)%sliding
    end do
  end subroutine find_matrix

  !> Solve W x = b for the unknowns that are free; the others keep their values, and their rows are left out. (Elimination without
  !> exchange of rows: W is positive definite.)
  pure subroutine solve(is_free, w, x)
    logical, intent(in) :: is_free(most_joints)
    real(dp), intent(in) :: w(most_joints, most_joints)
    real(dp), intent(inout) :: x(most_joints)   !! in: b; out: x
    real(dp) :: a(most_joints, most_joints), factor
    integer :: i, k
    a = w
    do k = 1, size(is_free)
      if (.not. is_free(k)) cycle
      do i = k + 1, size(is_free)
        if (.not. is_free(i)) cycle
        factor = a(i, k)/a(k, k)
        a(i, k:) = a(i, k:) - factor*a(k, k:)
        x(i) = x(i) - factor*x(k)
      end do
    end do
    do k = size(is_free), 1, -1
      if (.not. is_free(k)) cycle
      do i = k + 1, size(is_free)
        if (is_free(i)) x(k) = x(k) - a(k, i)*x(i)
      end do
      x(k) = x(k)/a(k, k)
    end do
  end subroutine solve

  !> Of the joints whose surfaces stick in an evaluation, those that friction cannot hold: sense in which each begins to slide, 0
  !> where it holds. With the bounds B of the friction forces F it is the only solution of
  !>
  !>     v' = W F + b,    v'_k = 0 and |F_k| <= B_k,    or F_k = -sgn(v'_k) B_k
  !>
  !> (minimum of F.W F/2 + b.F in the box |F_k| <= B_k). The 3^k cases of k joints are tried.
  pure function find_released(chain, joints, motion, own) result(sense)
    type(chain_t), intent(in) :: chain
    type(clearance_joint_t), intent(in) :: joints(:)
    type(motion_t), intent(in) :: motion
    type(joint_evaluation_t), intent(in) :: own(:)   !! with the forces that would hold all of them
    integer :: sense(most_joints)
    type(response_t) :: by(most_joints)
    real(dp) :: w(most_joints, most_joints), rate(most_joints), bound(most_joints), force(most_joints), &
      pressed(most_joints)
    logical :: holds(most_joints)
    integer :: k, trial, rest
    sense = 0
    bound = 0
    force = 0
    do k = 1, size(joints)
      if (.not. own(k)%sticks) cycle
      bound(k) = joints(k)%holding_ratio()*own(k)%normal_force
      force(k) = own(k)%friction_force
    end do
    if (all(abs(force) <= bound)) return
    call find_responses(chain, joints, motion, own, by)
    call find_matrix(by, w)
    rate = -matmul(w, force)   ! b: of the sliding speeds without friction
    do trial = 1, 3**size(joints) - 1
      rest = trial
      holds = .false.
      do k = 1, size(joints)
        sense(k) = mod(rest + 1, 3) - 1
        rest = rest/3
        holds(k) = own(k)%sticks .and. sense(k) == 0
        if (sense(k) /= 0 .and. .not. own(k)%sticks) exit
      end do
      if (k <= size(joints)) cycle
      force = -sense*bound
      pressed = matmul(w, force)
      where (holds) force = -rate - pressed
      call solve(holds, w, force)
      if (any(holds .and. abs(force) > bound)) cycle
      pressed = rate + matmul(w, force)   ! v'
      if (all(sense == 0 .or. sense*pressed > 0)) return
    end do
    sense = 0
    do k = 1, size(joints)   ! rounding decides: all let go
      if (own(k)%sticks) sense(k) = -nint(sign(1.0_dp, own(k)%friction_force))
    end do
  end function find_released
end module sticking
