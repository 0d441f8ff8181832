!> Accelerations of any chain by the general assembly: the same as the closed forms of its pieces, and the way for chains that have
!> none. What a body adds to the state (modes of an elastic rod, the flywheel's angle, a piston that moves across its bore) is
!> one more coordinate and one more column of the maps below.
module assembled_chain
  use gudgeon_kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, n_pins
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t, bearing_moment
  use loose_piston, only: pin_eccentricity
  use gudgeon_assembly, only: equations_t, body_t
  implicit none
  private
  public :: accelerate_assembled

  !> Where each coordinate of the chain stands among all, 0: it is none. The crank angle is the first.
  type :: coordinates_t
    integer :: n = 1
    integer :: pin(n_pins) = 0   !! the first of the two of a pin with clearance
    integer :: piston = 0        !! the offset of a piston with clearance in its bore; its tilt follows
  end type coordinates_t

contains

  !> Accelerations, and the moment on the crank (see `accelerate_crank_rod`). Loads of ideal pins are not read: they do no work.
  pure subroutine accelerate_assembled(bodies, drive, is_loose, loads, motion, accelerations, crank_moment)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    logical, intent(in) :: is_loose(n_pins)   !! pins with clearance
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    type(coordinates_t) :: at
    type(equations_t) :: equations
    type(body_t) :: crank, rod, piston
    type(loads_t) :: acting
    real(dp) :: z(7), holding
    logical :: definite
    integer :: pin

    do pin = 1, n_pins
      if (.not. is_loose(pin)) cycle
      at%pin(pin) = at%n + 1
      at%n = at%n + 2
    end do
    if (bodies%piston%is_loose) then
      at%piston = at%n + 1
      at%n = at%n + 2
    end if
    acting = loads
    do pin = 1, n_pins
      if (is_loose(pin)) cycle
      acting%force(:, pin) = 0
      acting%moment(pin) = 0
    end do
    call equations%begin(at%n)
    call make_crank(bodies, drive, acting, motion, at, crank)
    call make_rod(bodies, acting, motion, at, rod)
    call make_piston(bodies, acting, motion, at, rod, piston)
    call equations%add(crank)
    call equations%add(rod)
    call equations%add(piston)
    call equations%solve(.not. drive%free_crank, z(:at%n), holding, definite)
    crank_moment = drive%torque + holding
    accelerations%crank = z(1)
    accelerations%rod = dot_product(rod%map(3, :at%n), z(:at%n)) + rod%bias(3)
    accelerations%piston = dot_product(piston%map(1, :at%n), z(:at%n)) + piston%bias(1)
    if (at%piston > 0) then
      accelerations%offset = z(at%piston)
      accelerations%tilt = z(at%piston + 1)
      associate (tilting => motion%tilting)   ! from the centre of mass to the pin's bearing
        accelerations%piston = accelerations%piston + tilting%com(2)*accelerations%tilt + tilting%com(1)*tilting%tilt_rate**2
      end associate
    end if
    accelerations%pin = 0
    do pin = 1, n_pins
      if (is_loose(pin)) accelerations%pin(:, pin) = z(at%pin(pin):at%pin(pin) + 1)
    end do
  end subroutine accelerate_assembled

  !> The crank: q'.
  pure subroutine make_crank(bodies, drive, loads, motion, at, body)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(out) :: body
    real(dp) :: com_by_angle(2), pin_by_angle(2)
    associate (crank => bodies%crank, s => motion%sin_crank, c => motion%cos_crank)
      call body%begin(1, at%n)
      body%map(1, 1) = 1
      body%mass(1, 1) = crank%inertia + crank%mass*(crank%com(1)**2 + crank%com(2)**2)
      com_by_angle = [-crank%com(1)*s - crank%com(2)*c, crank%com(1)*c - crank%com(2)*s]
      pin_by_angle = crank%length*[-s, c]
      body%load(1) = drive%torque - drive%damping*motion%crank_speed + loads%moment(crank_pin) &
        + crank%mass*dot_product(bodies%gravity, com_by_angle) + dot_product(loads%force(:, crank_pin), pin_by_angle)
    end associate
  end subroutine make_crank

  !> The rod: (B_x', B_y', A') of its big end and its angle, B = R (cos q, sin q) - c.
  pure subroutine make_rod(bodies, loads, motion, at, body)
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(out) :: body
    real(dp) :: per_arm, com(2), com_by_angle(2), tip_by_angle(2), q_rate, a_rate
    integer :: pin

    q_rate = motion%crank_speed
    a_rate = motion%rod_speed
    associate (r => bodies%crank%length, rod => bodies%rod, sq => motion%sin_crank, cq => motion%cos_crank, &
               sa => motion%sin_rod, ca => motion%cos_rod)
      call body%begin(3, at%n)
      ! A by L sin A = R sin q - o_y
      per_arm = 1/(rod%length*ca)
      body%map(:3, 1) = [-r*sq, r*cq, r*cq*per_arm]
      body%bias(:3) = [-r*cq*q_rate**2, -r*sq*q_rate**2, (rod%length*sa*a_rate**2 - r*sq*q_rate**2)*per_arm]
      do pin = 1, n_pins
        if (at%pin(pin) > 0) body%map(3, at%pin(pin) + 1) = -per_arm
      end do
      if (at%piston > 0) then   ! o_y'' has y'' - p_x b'' + p_y b'^2
        body%map(3, at%piston) = -per_arm
        body%map(3, at%piston + 1) = per_arm*motion%tilting%com(1)
        body%bias(3) = body%bias(3) - per_arm*motion%tilting%com(2)*motion%tilting%tilt_rate**2
      end if
      if (at%pin(crank_pin) > 0) then
        body%map(1, at%pin(crank_pin)) = -1
        body%map(2, at%pin(crank_pin) + 1) = -1
      end if
      com = [rod%com(1)*ca + rod%com(2)*sa, rod%com(2)*ca - rod%com(1)*sa]
      com_by_angle = [com(2), -com(1)]
      tip_by_angle = -rod%length*[sa, ca]
      body%mass(1, 1) = rod%mass
      body%mass(2, 2) = rod%mass
      body%mass(1:2, 3) = rod%mass*com_by_angle
      body%mass(3, 1:2) = rod%mass*com_by_angle
      body%mass(3, 3) = rod%inertia + rod%mass*(rod%com(1)**2 + rod%com(2)**2)
      body%load(1:2) = rod%mass*(bodies%gravity + com*a_rate**2) + loads%force(:, piston_pin) - loads%force(:, crank_pin)
      body%load(3) = rod%mass*dot_product(bodies%gravity, com_by_angle) &
        + dot_product(loads%force(:, piston_pin), tip_by_angle) - loads%moment(piston_pin) &
        - bearing_moment(motion%crank_pin, loads%force(:, crank_pin), loads%moment(crank_pin))
    end associate
  end subroutine make_rod

  !> The piston on its guide: x', x = B_x + L cos A - e_x. With clearance in its bore: (x', y', b') of its centre of mass.
  pure subroutine make_piston(bodies, loads, motion, at, rod, body)
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(in) :: rod
    type(body_t), intent(out) :: body
    real(dp) :: across, along
    along = bodies%rod%length*motion%cos_rod
    across = bodies%rod%length*motion%sin_rod
    call body%begin(merge(3, 1, at%piston > 0), at%n)
    body%map(1, :at%n) = rod%map(1, :at%n) - across*rod%map(3, :at%n)
    body%bias(1) = rod%bias(1) - across*rod%bias(3) - along*motion%rod_speed**2
    if (at%pin(piston_pin) > 0) body%map(1, at%pin(piston_pin)) = body%map(1, at%pin(piston_pin)) - 1
    body%mass(1, 1) = bodies%piston%mass
    body%load(1) = bodies%piston%mass*bodies%gravity(1) - loads%axial_force - loads%force(1, piston_pin)
    if (at%piston == 0) return
    associate (p => motion%tilting%com, f => loads%force(:, piston_pin))
      body%map(1, at%piston + 1) = body%map(1, at%piston + 1) - p(2)
      body%bias(1) = body%bias(1) - p(1)*motion%tilting%tilt_rate**2
      body%map(2, at%piston) = 1
      body%map(3, at%piston + 1) = 1
      body%mass(2, 2) = bodies%piston%mass
      body%mass(3, 3) = bodies%piston%inertia
      body%load(2) = bodies%piston%mass*bodies%gravity(2) + loads%bore_force - f(2)
      body%load(3) = loads%bore_moment + p(1)*f(2) - p(2)*f(1) &
        + bearing_moment(pin_eccentricity(motion), f, loads%moment(piston_pin))
    end associate
  end subroutine make_piston
end module assembled_chain
