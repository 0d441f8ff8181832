!> Derivatives of the accelerations of a crankshaft with several cylinders with respect to the state, for implicit integration. The
!> stiffness and the damping of segments and rings are exact; the slopes of inertias and torques of the other cylinders over the
!> angle, which are small beside them, are left out: Newton's method only needs more iterations.
submodule (crank_train) train_tangent
  implicit none

contains

  module procedure add_slopes
    real(dp) :: by_twist(self%n, self%n), by_speed(self%n, self%n)   ! of the torques, with respect to twists and speeds of stations
    real(dp) :: p(self%n, size(a_p, 2)), v(self%n, size(a_v, 2)), own_p(size(a_p, 2)), own_v(size(a_v, 2))
    integer :: i, j, m
    m = size(a_p, 2)
    call find_torque_slopes(self, drive, by_twist, by_speed)
    p = 0   ! derivatives of the torques, then of the accelerations of the stations
    v = 0
    do j = 1, self%n
      call add_state(j, by_twist(:, j), by_speed(:, j))
    end do
    do i = 1, size(self%rings)
      associate (ring => self%rings(i))
        if (.not. ring%is_viscous) then
          p(ring%station, ring%at%position) = p(ring%station, ring%at%position) + ring%stiffness
          v(ring%station, ring%at%rate - m) = v(ring%station, ring%at%rate - m) + ring%damping
        else
          v(ring%station, ring%speed_at%first - m) = v(ring%station, ring%speed_at%first - m) + ring%damping
        end if
      end associate
    end do
    do i = 1, size(rows)
      a_p(rows(i), :) = a_p(rows(i), :) + by_torque(i)*p(self%full, :)
      a_v(rows(i), :) = a_v(rows(i), :) + by_torque(i)*v(self%full, :)
    end do
    do j = 1, self%n
      if (j == self%full) cycle
      p(j, :) = p(j, :)/inertia(j)
      v(j, :) = v(j, :)/inertia(j)
    end do
    if (self%holds_station) p(self%driven, :) = 0
    if (self%holds_station) v(self%driven, :) = 0
    p(self%full, :) = 0
    v(self%full, :) = 0
    if (crank%n > 0) p(self%full, :) = a_p(crank%rate - m, :)
    if (crank%n > 0) v(self%full, :) = a_v(crank%rate - m, :)
    do j = 1, self%n
      if (self%at(j)%n == 0) cycle
      a_p(self%at(j)%rate - m, :) = p(j, :) - p(self%full, :)
      a_v(self%at(j)%rate - m, :) = v(j, :) - v(self%full, :)
    end do
    do i = 1, size(self%rings)
      associate (ring => self%rings(i), s => self%rings(i)%station)
        own_p = -p(s, :)
        own_v = -v(s, :)
        if (ring%is_viscous) then
          j = ring%speed_at%first - m
        else
          j = ring%at%rate - m
          own_p(ring%at%position) = own_p(ring%at%position) - ring%stiffness/ring%inertia
        end if
        own_v(j) = own_v(j) - ring%damping/ring%inertia
        a_p(j, :) = own_p
        a_v(j, :) = own_v
      end associate
    end do

  contains

    !> Add the derivatives with respect to the states on which twist and speed of a station depend.
    subroutine add_state(j, by_twist, by_speed)
      integer, intent(in) :: j
      real(dp), intent(in) :: by_twist(:), by_speed(:)
      if (self%holds_station .and. j == self%driven) then   ! its angle and its speed are prescribed
        p(:, crank%position) = p(:, crank%position) - by_twist
        return
      end if
      if (crank%n > 0) v(:, crank%rate - m) = v(:, crank%rate - m) + by_speed
      if (self%at(j)%n == 0) return
      p(:, self%at(j)%position) = p(:, self%at(j)%position) + by_twist
      v(:, self%at(j)%rate - m) = v(:, self%at(j)%rate - m) + by_speed
    end subroutine add_state
  end procedure add_slopes

  !> Derivatives of the torques of all stations with respect to their twists and speeds.
  pure subroutine find_torque_slopes(train, drive, by_twist, by_speed)
    type(crank_train_t), intent(in) :: train
    type(drive_t), intent(in) :: drive
    real(dp), intent(out) :: by_twist(:, :), by_speed(:, :)   !! (station, station)
    integer :: j
    by_twist = 0
    by_speed = 0
    do j = 1, train%n
      by_speed(j, j) = -train%drag(j)
    end do
    do j = 1, train%n - 1
      call couple(by_twist, train%stiffness(j))
      call couple(by_speed, train%damping(j))
    end do
    if (train%driven /= train%full) by_speed(train%driven, train%driven) = by_speed(train%driven, train%driven) - drive%damping

  contains

    pure subroutine couple(slopes, factor)
      real(dp), intent(inout) :: slopes(:, :)
      real(dp), intent(in) :: factor
      slopes(j:j + 1, j:j + 1) = slopes(j:j + 1, j:j + 1) + factor*reshape([-1, 1, 1, -1], [2, 2])
    end subroutine couple
  end subroutine find_torque_slopes
end submodule train_tangent
