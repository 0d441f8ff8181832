!> How the accelerations of a scene change with its state, for implicit integration.
submodule (gudgeon_scene) scene_tangent
  use ode_problem, only: difference_jacobian
  use chain_motion, only: crank_pin
  use crank_rod_tangent, only: motion_change_t, load_change_t, motion_change, acceleration_change
  implicit none

contains

  module procedure jacobian
    type(evaluation_t) :: now
    type(motion_change_t) :: change
    type(load_change_t) :: load_change
    real(dp) :: force(3, 5), direction(6), loads(3), a(3)
    logical :: has_closed_form
    integer :: i, skip

    has_closed_form = self%chain%is_loose(piston_pin) .and. .not. self%chain%is_loose(crank_pin)
    if (has_closed_form) then
      call self%evaluate(t, y, now, has_closed_form)
      if (has_closed_form) has_closed_form = .not. now%joint(1)%sticks
    end if
    if (.not. has_closed_form) then
      call difference_jacobian(self, t, y, a_p, a_v)
      return
    end if
    call self%joints(1)%slopes(self%chain%bodies, now%motion, now%relative(1), now%joint(1), force)
    skip = merge(0, 1, self%chain%drive%free_crank)   ! the held crank angle is no unknown
    associate (bodies => self%chain%bodies, drive => self%chain%drive)
      do i = 1 + skip, 6
        if (i == 4 .and. skip == 1) cycle
        direction = 0
        direction(i) = 1   ! of q, e_x, e_y, q', e_x', e_y'
        change = motion_change(bodies, now%motion, direction(1), direction(4), direction(3), direction(6))
        loads = matmul(force(:, 1:2), direction(2:3)) + matmul(force(:, 3:4), direction(5:6)) - force(:, 5)*change%rod_speed
        load_change = load_change_t(loads(1:2), loads(3))
        if (allocated(self%gas) .and. i == 1) load_change%gas_force = self%gas%force_slope(now%motion%crank_angle)
        a = acceleration_change(bodies, drive, now%loads, now%motion, now%accelerations, change, load_change)
        if (i <= 3) then
          a_p(:, i - skip) = a(1 + skip:3)
        else
          a_v(:, i - 3 - skip) = a(1 + skip:3)
        end if
      end do
    end associate
  end procedure jacobian
end submodule scene_tangent
