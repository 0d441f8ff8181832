!> Derivatives of the accelerations of a scene with respect to its state, for implicit integration.
submodule (scene_problem) scene_tangent
  use ode_problem, only: difference_jacobian, difference_by_parts
  use chain_bodies, only: drive_t
  use chain_loads, only: bearing_moment
  use load_element, only: n_motions, by_pin_speed, by_bearing_speed
  use clearance_joint, only: most_joint_states, n_joint_slopes
  use face_film, only: tangent_found, tangent_acts
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
    if (has_closed_form) has_closed_form = all(self%joints(:self%n_joints)%has_slopes) .and. &
      count([allocated(self%chain%floating), allocated(self%chain%train), self%has_charge]) <= 1
    if (has_closed_form) then
      call self%evaluate(t, y, now, has_closed_form)
      if (has_closed_form) has_closed_form = .not. any(now%joint(:self%n_joints)%sticks)
    end if
    if (.not. has_closed_form) then
      if (has_skirt_film(self)) then
        call difference_beside_film(self, t, y, a_p, a_v)
      else if (size(self%carried) > 1) then
        call difference_by_parts(self, t, y, carried_parts(self, size(a_p, 2) + size(a_v, 1)), a_p, a_v)
      else
        call difference_jacobian(self, t, y, a_p, a_v)
      end if
      return
    else if (allocated(self%chain%floating)) then
      call floating_jacobian(self, now, a_p, a_v)
      return
    end if
    n = self%joints(1)%n_states
    call self%joints(1)%slopes(now%joint(1), of_loads, of_rates)
    if (self%joints(1)%site%sense < 0) call turn_round(now%joint(1), of_loads, of_rates)
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
    if (allocated(self%gas) .and. .not. self%has_charge) &
      slope(2, 1) = slope(2, 1) + self%chain%bodies%per_piston_mass*self%gas%force_slope(now%motion%crank_angle)
    if (n > 0) then
      slope(:3, 7:6 + n) = matmul(by_loads, of_loads(:, n_motions + 1:n_motions + n))
      call follow_state(n, of_rates(:, :by_pin_speed), by_nothing, rod_angle, rod_speed, slope(4:3 + n, :6))
      slope(4:3 + n, 7:6 + n) = of_rates(:n, n_motions + 1:n_motions + n)
    end if
    if (self%joints(1)%site%sense < 0) then   ! the state is the eccentricity of the joint, not that of the chain
      slope(2:3, :) = -slope(2:3, :)
      slope(:, 2:3) = -slope(:, 2:3)
      slope(:, 5:6) = -slope(:, 5:6)
    end if
    skip = merge(0, 1, drive%free_crank)   ! a prescribed crank angle is not an unknown
    if (allocated(self%chain%train)) then
      call place_slopes(self, n, skip, slope, a_p, a_v)
      call torque_slopes(self%chain%bodies, drive, now%motion, by_torque)
      call self%chain%train%add_slopes(of_case, now%motion%train%inertia, self%crank, [(i, i=1, 3 - skip)], &
        by_torque(1 + skip:), a_p, a_v)
    else if (self%has_charge) then
      call place_slopes(self, n, skip, slope, a_p, a_v)
      call add_gas_slopes(self, now, 2 - skip, y, a_p, a_v)
    else
      a_p = slope(1 + skip:3 + n, 1 + skip:3)
      a_v = slope(1 + skip:3 + n, 4 + skip:6 + n)
    end if
  end procedure jacobian

  !> Whether the skirt has a film.
  pure logical function has_skirt_film(self)
    type(scene_t), intent(in) :: self
    has_skirt_film = .false.
    if (allocated(self%guide)) has_skirt_film = self%guide%filmed > 0
  end function has_skirt_film

  !> The derivatives by differences of the rates, while the film of the skirt follows its tangent: that has closed form, and a film
  !> costs more than everything else.
  pure subroutine difference_beside_film(self, t, y, a_p, a_v)
    type(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    type(evaluation_t) :: now, next
    real(dp) :: f(self%n), moved(self%n), state(self%n), step
    logical :: in_domain
    integer :: i, m, k, way
    m = size(a_p, 2)
    k = size(a_v, 1)
    a_p = 0
    a_v = 0
    now%guide%tangent%role = tangent_found
    call self%find_rates(t, y, now, f, in_domain)
    if (.not. in_domain) return
    next%guide%tangent = now%guide%tangent
    next%guide%tangent%role = tangent_acts
    do i = 1, m + k
      do way = 1, -1, -2
        step = way*sqrt(epsilon(1.0_dp))*max(abs(y(i)), 1e-5_dp)
        state = y
        state(i) = y(i) + step
        call self%find_rates(t, state, next, moved, in_domain)
        if (in_domain) exit
      end do
      if (.not. in_domain) cycle
      moved(m + 1:m + k) = (moved(m + 1:m + k) - f(m + 1:m + k))/step
      if (i <= m) then
        a_p(:, i) = moved(m + 1:m + k)
      else
        a_v(:, i - m) = moved(m + 1:m + k)
      end if
    end do
  end subroutine difference_beside_film

  !> Which states belong to which carried bearing: nothing else depends on them.
  pure function carried_parts(scene, n) result(part)
    class(scene_t), intent(in) :: scene
    integer, intent(in) :: n   !! number of positions, rates and states
    integer :: part(n)
    integer :: i
    part = 0
    do i = 1, size(scene%carried)
      associate (it => scene%carried(i))
        part(it%place%first:it%place%last) = i
        if (allocated(scene%joints(it%joint)%heat)) part(scene%joints(it%joint)%heat%at%first) = i
      end associate
    end do
  end function carried_parts

  !> Make the slopes of a joint whose pin belongs to the piston those of the chain's pin: of the load on the rod, which takes what
  !> the bearing takes, with respect to the opposite of the eccentricity and to the angular speed of the rod.
  pure subroutine turn_round(joint, of_loads, of_rates)
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(inout) :: of_loads(3, n_joint_slopes), of_rates(most_joint_states, n_joint_slopes)
    call on_bearing(joint, of_loads)
    of_loads(:, :by_pin_speed - 1) = -of_loads(:, :by_pin_speed - 1)
    of_loads(:, by_pin_speed) = of_loads(:, by_bearing_speed)
    of_rates(:, :by_pin_speed - 1) = -of_rates(:, :by_pin_speed - 1)
    of_rates(:, by_pin_speed) = of_rates(:, by_bearing_speed)
  end subroutine turn_round

  !> Make the slopes of a load on the pin those of the load on its bearing: the force -F and the moment -M - e x F.
  pure subroutine on_bearing(joint, of_loads)
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(inout) :: of_loads(3, n_joint_slopes)
    integer :: k
    do k = 1, n_joint_slopes
      of_loads(:, k) = [-of_loads(:2, k), bearing_moment(joint%eccentricity, of_loads(:2, k), of_loads(3, k))]
    end do
    of_loads(3, 1) = of_loads(3, 1) - joint%force(2)
    of_loads(3, 2) = of_loads(3, 2) + joint%force(1)
  end subroutine on_bearing

  !> The Jacobian of a scene with a floating pin between a rigid rod and a piston in an ideal guide.
  subroutine floating_jacobian(scene, now, a_p, a_v)
    class(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    ! columns: q, both e and phi, their rates, the states of the joints; rows of loads: F_x, F_y, moment
    integer, parameter :: m = 6, most = 2*m + 2*most_joint_states
    type(loads_t) :: acting
    type(drive_t) :: drive
    real(dp) :: of_loads(3, n_joint_slopes), of_rates(most_joint_states, n_joint_slopes)
    real(dp) :: by_motion(3, 4), by_loads(3, 3), angle(2), speed(2)
    real(dp) :: rod_angle(most), rod_speed(most), on_pin(3, most), on_rod(3, most), on_piston(3, most), chain(3, most), &
      slope(m + 2*most_joint_states, most)
    integer :: i, e, states, skip, n

    drive = scene%chain%drive
    if (allocated(scene%chain%varying)) drive%damping = drive%damping - scene%chain%varying%torque_slope(now%motion%crank_speed)
    call rod_slopes(scene%chain%bodies, now%motion, angle, speed)
    call scene%chain%floating%chain_loads(scene%chain%bodies, now%motion, now%loads, acting)
    call acceleration_slopes(scene%chain%bodies, drive, acting, now%motion, now%accelerations, by_motion, by_loads)
    by_loads(2, 1) = by_loads(2, 1) - scene%chain%bodies%per_piston_mass   ! the piston takes another load than the rod
    rod_angle = 0
    rod_speed = 0
    do i = 1, scene%n_joints
      e = column_of(i)
      rod_angle([1, e + 1]) = angle*[1.0_dp, scene%joints(i)%site%sense]
      rod_speed([1, e + 1]) = speed*[1.0_dp, scene%joints(i)%site%sense]
      rod_speed(m + [1, e + 1]) = rod_angle([1, e + 1])
    end do
    states = 0
    do i = 1, scene%n_joints
      call scene%joints(i)%slopes(now%joint(i), of_loads, of_rates)
      if (scene%joints(i)%place == piston_pin) then
        call spread_columns(i, 3, of_loads, on_piston)
      else
        call spread_columns(i, 3, of_loads, on_pin)
        call on_bearing(now%joint(i), of_loads)
        call spread_columns(i, 3, of_loads, on_rod)
      end if
      n = scene%joints(i)%n_states
      call spread_columns(i, n, of_rates, slope(m + states + 1:m + states + n, :))
      states = states + n
    end do
    on_pin = on_pin + on_piston
    if (allocated(scene%gas)) on_piston(1, 1) = on_piston(1, 1) + scene%gas%force_slope(now%motion%crank_angle)
    chain = matmul(by_loads, on_rod)
    do i = 1, 3
      chain(i, :) = chain(i, :) + by_motion(i, 2)*rod_angle + by_motion(i, 4)*rod_speed
      chain(i, [1, m + 1]) = chain(i, [1, m + 1]) + by_motion(i, [1, 3])
    end do
    associate (pin => scene%chain%floating, recoil => scene%chain%bodies%per_piston_mass*on_piston(1, :))
      slope(1, :) = chain(1, :)
      slope(2, :) = on_pin(1, :)/pin%mass + recoil
      slope(3, :) = on_pin(2, :)/pin%mass
      slope(4, :) = on_pin(1, :)/pin%mass - chain(2, :)   ! e_s'' = e_b'' - (S - C)''
      slope(5, :) = slope(3, :) - chain(3, :)
      slope(6, :) = on_pin(3, :)/pin%inertia
    end associate
    skip = merge(0, 1, drive%free_crank)   ! a prescribed crank angle is not an unknown
    a_p = slope(1 + skip:m + states, 1 + skip:m)
    a_v(:, :m - skip) = slope(1 + skip:m + states, m + 1 + skip:2*m)
    a_v(:, m - skip + 1:) = slope(1 + skip:m + states, 2*m + 1:2*m + states)

  contains

    !> The first column of the eccentricity of a joint.
    pure integer function column_of(i)
      integer, intent(in) :: i
      column_of = merge(2, 4, scene%joints(i)%place == piston_pin)
    end function column_of

    !> Put the slopes of a joint to the columns of the motions on which they depend.
    subroutine spread_columns(i, rows, own, all)
      integer, intent(in) :: i, rows
      real(dp), intent(in) :: own(:, :)
      real(dp), intent(out) :: all(:, :)   !! (rows, most)
      integer :: e, n
      e = column_of(i)
      n = scene%joints(i)%n_states
      all = 0
      all(:, e:e + 1) = own(:rows, 1:2)
      all(:, m + e:m + e + 1) = own(:rows, 3:4)
      all(:, 2*m) = own(:rows, by_pin_speed)
      all(:, 2*m + states + 1:2*m + states + n) = own(:rows, n_motions + 1:n_motions + n)
      if (scene%joints(i)%place == piston_pin) return
      do n = 1, most   ! the bearing turns with the rod, -A'
        all(:, n) = all(:, n) - own(:rows, by_bearing_speed)*rod_speed(n)
      end do
    end subroutine spread_columns
  end subroutine floating_jacobian

  !> Add the derivatives of the rates of pressure and mass of the gas and of the accelerations of valves that have a mass, by
  !> differences of the gas alone, and those of the acceleration of the pin by the pressure.
  subroutine add_gas_slopes(scene, now, piston_row, y, a_p, a_v)
    class(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    integer, intent(in) :: piston_row     !! row of the acceleration that follows the force on the piston
    real(dp), intent(in) :: y(:)
    real(dp), intent(inout) :: a_p(:, :), a_v(:, :)
    real(dp), parameter :: small = 1e-7_dp
    type(charge_motion_t) :: moved
    real(dp) :: state(size(y)), step, change(4)
    integer :: rows(4), port(4), n, i, m, lift   ! of pressure, mass, and the valves that have a mass
    m = size(a_p, 2)
    associate (gas => scene%gas, q => now%motion%crank_angle, speed => now%motion%crank_speed)
      rows(:2) = [gas%charge%pressures%first, gas%charge%masses%first] - m
      n = 2
      if (allocated(gas%charge%reeds)) then
        do i = 1, size(gas%charge%reeds%at)
          if (gas%charge%reeds%at(i)%n == 0) cycle
          n = n + 1
          rows(n) = gas%charge%reeds%at(i)%rate - m
          port(n) = i
        end do
      end if
      do i = 1, n
        step = small   ! of a speed, in which the accelerations are linear
        if (i <= 2) step = small*y(m + rows(i))
        call move(q, speed, m + rows(i), step)
        a_v(rows(:n), rows(i)) = change(:n)/step
        if (i == 1) a_v(piston_row, rows(1)) = scene%joints(1)%site%sense*scene%chain%bodies%per_piston_mass* &
          (gas%force(moved%pressure) - gas%force(now%charge%pressure))/step
      end do
      do i = 3, n
        lift = gas%charge%reeds%at(port(i))%position
        step = small*gas%charge%valves(port(i))%lift
        call move(q, speed, lift, step)
        a_p(rows(:n), lift) = change(:n)/step
      end do
      if (.not. scene%chain%drive%free_crank) return
      call move(q + small, speed, 1, 0.0_dp)
      a_p(rows(:n), scene%crank%position) = change(:n)/small
      step = small*max(abs(speed), 1.0_dp)
      call move(q, speed + step, 1, 0.0_dp)
      a_v(rows(:n), scene%crank%rate - m) = change(:n)/step
    end associate

  contains

    !> The gas at a crank angle [rad] and a speed [rad/s], with another state i, and by how much its rates differ from the present
    !> ones.
    subroutine move(q, speed, i, by_state)
      real(dp), intent(in) :: q, speed, by_state
      integer, intent(in) :: i
      integer :: k
      state = y
      state(i) = y(i) + by_state
      call scene%gas%find_charge(q, speed, state, moved)
      change(:2) = [moved%pressure_rate - now%charge%pressure_rate, moved%mass_rate - now%charge%mass_rate]
      do k = 3, n
        change(k) = moved%valve_acceleration(port(k)) - now%charge%valve_acceleration(port(k))
      end do
    end subroutine move
  end subroutine add_gas_slopes

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
