!> Derivatives of the accelerations of a scene with respect to its state, for implicit integration.
submodule (scene_problem) scene_tangent
  use ode_problem, only: difference_jacobian
  use chain_bodies, only: drive_t
  use load_element, only: n_motions, by_pin_speed
  use clearance_joint, only: most_joint_states, n_joint_slopes
  use crank_rod_tangent, only: rod_slopes, acceleration_slopes, torque_slopes
  implicit none

contains

  module procedure jacobian
    type(evaluation_t) :: now
    type(drive_t) :: drive
    real(dp), parameter :: by_nothing(most_joint_states, 4) = 0
    real(dp) :: by_motion(3, 4), by_loads(3, 3), rod_angle(2), rod_speed(2)
    real(dp) :: of_loads(3, n_joint_slopes), of_rates(most_joint_states, n_joint_slopes)
    real(dp) :: slope(3 + most_joint_states, 6 + most_joint_states)   !! of all rates, with respect to q, e, q', e' and the states
    logical :: has_closed_form
    type(drive_t) :: of_case
    real(dp) :: by_torque(3)
    integer :: skip, n, i

    has_closed_form = self%chain%is_loose(piston_pin) .and. .not. (self%chain%is_loose(crank_pin) .or. allocated(self%guide) &
      .or. allocated(self%chain%elastic) .or. size(self%carried) > 0)
    if (has_closed_form) has_closed_form = self%joints(1)%place == piston_pin .and. self%joints(1)%has_slopes
    if (has_closed_form) then
      call self%evaluate(t, y, now, has_closed_form)
      if (has_closed_form) has_closed_form = .not. now%joint(1)%sticks
    end if
    if (.not. has_closed_form) then
      call difference_jacobian(self, t, y, a_p, a_v)
      return
    end if
    n = self%joints(1)%n_states
    call self%joints(1)%slopes(now%joint(1), of_loads, of_rates)
    drive = self%chain%drive
    if (allocated(self%chain%varying)) &
      drive%damping = drive%damping - self%chain%varying%torque_slope(self%chain%driven_speed(now%motion))
    if (allocated(self%chain%train)) then
      of_case = drive
      drive = self%chain%train%drive_of_crank(of_case, now%motion)
    end if
    call rod_slopes(self%chain%bodies, now%motion, rod_angle, rod_speed)
    call acceleration_slopes(self%chain%bodies, drive, now%loads, now%motion, now%accelerations, by_motion, by_loads)
    call follow_state(3, matmul(by_loads, of_loads(:, :by_pin_speed)), by_motion, rod_angle, rod_speed, slope(:3, :6))
    if (allocated(self%gas)) &
      slope(2, 1) = slope(2, 1) + self%chain%bodies%per_piston_mass*self%gas%force_slope(now%motion%crank_angle)
    if (n > 0) then
      slope(:3, 7:6 + n) = matmul(by_loads, of_loads(:, n_motions + 1:n_motions + n))
      call follow_state(n, of_rates(:, :by_pin_speed), by_nothing, rod_angle, rod_speed, slope(4:3 + n, :6))
      slope(4:3 + n, 7:6 + n) = of_rates(:n, n_motions + 1:n_motions + n)
    end if
    skip = merge(0, 1, drive%free_crank)   ! a prescribed crank angle is not an unknown
    if (allocated(self%chain%train)) then
      call place_slopes(self, n, skip, slope, a_p, a_v)
      call torque_slopes(self%chain%bodies, drive, now%motion, by_torque)
      call self%chain%train%add_slopes(of_case, now%motion%train%inertia, self%crank, [(i, i=1, 3 - skip)], &
        by_torque(1 + skip:), a_p, a_v)
    else
      a_p = slope(1 + skip:3 + n, 1 + skip:3)
      a_v = slope(1 + skip:3 + n, 4 + skip:6 + n)
    end if
  end procedure jacobian

  !> Put the derivatives of the accelerations of crank and pin and of the rates of the joint's states to their places among those of
  !> a whole state; the others are 0.
  pure subroutine place_slopes(scene, n, skip, slope, a_p, a_v)
    class(scene_t), intent(in) :: scene
    integer, intent(in) :: n, skip            !! number of the joint's states; 1 if the crank angle is not a state, else 0
    real(dp), intent(in) :: slope(:, :)
    real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    integer :: kept, states
    kept = 3 - skip
    states = size(a_p, 2)   ! the joint's states are the first behind the rates
    a_p = 0
    a_v = 0
    a_p(:kept, :kept) = slope(1 + skip:3, 1 + skip:3)
    a_v(:kept, :kept) = slope(1 + skip:3, 4 + skip:6)
    a_v(:kept, states + 1:states + n) = slope(1 + skip:3, 7:6 + n)
    a_p(states + 1:states + n, :kept) = slope(4:3 + n, 1 + skip:3)
    a_v(states + 1:states + n, :kept) = slope(4:3 + n, 4 + skip:6)
    a_v(states + 1:states + n, states + 1:states + n) = slope(4:3 + n, 7:6 + n)
  end subroutine place_slopes

  !> Total derivatives of n quantities with respect to q, e and their rates, from those due to e, e' and A' through the joint, and
  !> to q, A, q' and A' otherwise.
  pure subroutine follow_state(n, by_joint, by_motion, rod_angle, rod_speed, total)
    integer, intent(in) :: n
    real(dp), intent(in) :: by_joint(:, :), by_motion(:, :), rod_angle(2), rod_speed(2)
    real(dp), intent(out) :: total(:, :)
    real(dp) :: by_rod_speed
    integer :: i
    do i = 1, n
      by_rod_speed = by_motion(i, 4) - by_joint(i, 5)   ! the pin turns with -A'
      total(i, 1) = by_motion(i, 1) + by_motion(i, 2)*rod_angle(1) + by_rod_speed*rod_speed(1)
      total(i, 2) = by_joint(i, 1)
      total(i, 3) = by_joint(i, 2) + by_motion(i, 2)*rod_angle(2) + by_rod_speed*rod_speed(2)
      total(i, 4) = by_motion(i, 3) + by_rod_speed*rod_angle(1)
      total(i, 5) = by_joint(i, 3)
      total(i, 6) = by_joint(i, 4) + by_rod_speed*rod_angle(2)
    end do
  end subroutine follow_state
end submodule scene_tangent
