!> Derivatives of the accelerations of a scene with respect to its state, for implicit integration.
submodule (gudgeon_scene) scene_tangent
  use ode_problem, only: difference_jacobian
  use chain_motion, only: crank_pin
  use chain_bodies, only: drive_t
  use joint_motion, only: most_joint_states
  use crank_rod_tangent, only: motion_change_t, load_change_t, motion_change, acceleration_change
  implicit none

contains

  module procedure jacobian
    type(evaluation_t) :: now
    type(drive_t) :: drive
    type(motion_change_t) :: change
    type(load_change_t) :: load_change
    real(dp) :: force(3, 5), direction(6), loads(3), a(3)
    real(dp) :: by_states(3, most_joint_states), of_rates(most_joint_states, 5 + most_joint_states)
    real(dp) :: rates(most_joint_states)
    logical :: has_closed_form
    integer :: i, skip, m, n

    has_closed_form = self%chain%is_loose(piston_pin) .and. .not. (self%chain%is_loose(crank_pin) .or. allocated(self%guide) &
      .or. allocated(self%chain%elastic))
    if (has_closed_form) has_closed_form = .not. allocated(self%joints(1)%worn)
    if (has_closed_form) then
      call self%evaluate(t, y, now, has_closed_form)
      if (has_closed_form) has_closed_form = .not. now%joint(1)%sticks
    end if
    if (.not. has_closed_form) then
      call difference_jacobian(self, t, y, a_p, a_v)
      return
    end if
    call self%joints(1)%slopes(self%chain%bodies, now%motion, now%relative(1), now%joint(1), force)
    skip = merge(0, 1, self%chain%drive%free_crank)   ! a prescribed crank angle is not an unknown
    m = 3 - skip
    n = self%joints(1)%n_states()
    if (n > 0) call self%joints(1)%state_slopes(self%chain%bodies, now%motion, now%relative(1), now%joint(1), by_states, of_rates)
    drive = self%chain%drive
    if (allocated(self%chain%varying)) drive%damping = drive%damping - self%chain%varying%torque_slope(now%motion%crank_speed)
    associate (bodies => self%chain%bodies)
      do i = 1 + skip, 6
        if (i == 4 .and. skip == 1) cycle
        direction = 0
        direction(i) = 1   ! of q, e_x, e_y, q', e_x', e_y'
        change = motion_change(bodies, now%motion, direction(1), direction(4), direction(3), direction(6))
        loads = matmul(force(:, 1:2), direction(2:3)) + matmul(force(:, 3:4), direction(5:6)) - force(:, 5)*change%rod_speed
        load_change = load_change_t(loads(1:2), loads(3))
        if (allocated(self%gas) .and. i == 1) load_change%axial_force = self%gas%force_slope(now%motion%crank_angle)
        a = acceleration_change(bodies, drive, now%loads, now%motion, now%accelerations, change, load_change)
        if (n > 0) rates = matmul(of_rates(:, 1:2), direction(2:3)) + matmul(of_rates(:, 3:4), direction(5:6)) &
          - of_rates(:, 5)*change%rod_speed
        if (i <= 3) then
          a_p(:m, i - skip) = a(1 + skip:3)
          a_p(m + 1:, i - skip) = rates(:n)
        else
          a_v(:m, i - 3 - skip) = a(1 + skip:3)
          a_v(m + 1:, i - 3 - skip) = rates(:n)
        end if
      end do
      do i = 1, n
        a = acceleration_change(bodies, drive, now%loads, now%motion, now%accelerations, motion_change_t(), &
          load_change_t(by_states(1:2, i), by_states(3, i)))
        a_v(:m, m + i) = a(1 + skip:3)
        a_v(m + 1:, m + i) = of_rates(:n, 5 + i)
      end do
    end associate
  end procedure jacobian
end submodule scene_tangent
