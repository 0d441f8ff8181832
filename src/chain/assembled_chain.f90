!> Accelerations of any chain by a general assembly of its bodies. The results equal those of the closed forms; it is used for
!> chains that have none. Additional coordinates (modes of an elastic rod, the flywheel angle, a piston that moves across its bore)
!> are additional columns of the velocity maps below.
module assembled_chain
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, n_pins
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t, bearing_moment
  use loose_piston, only: pin_eccentricity
  use body_assembly, only: equations_t, body_t, most_coordinates
  use elastic_rod, only: elastic_rod_t
  use elastic_rod_body, only: set_own_equations, set_elastic_map, set_chord
  implicit none
  private
  public :: accelerate_assembled

  !> Index of each coordinate of the chain among all, 0 if it does not exist. The crank angle is the first.
  type :: coordinates_t
    integer :: n = 1
    integer :: pin(n_pins) = 0   !! first of the two coordinates of a pin with clearance
    integer :: piston = 0        !! offset of a piston with clearance in its bore; its tilt is the next one
    integer :: shape = 0         !! first shape of an elastic rod
  end type coordinates_t

contains

  !> Accelerations, and the moment on the crank (see `accelerate_crank_rod`). Loads of ideal pins are not used, since they do no
  !> work. An `elastic_rod` replaces the rigid one. `solvable` is false if the mass matrix is not positive definite.
  pure subroutine accelerate_assembled(bodies, drive, is_loose, loads, motion, accelerations, crank_moment, elastic_rod, solvable)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    logical, intent(in) :: is_loose(n_pins)   !! pins with clearance
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    type(elastic_rod_t), intent(in), optional :: elastic_rod
    logical, intent(out), optional :: solvable
    type(coordinates_t) :: at
    type(equations_t) :: equations
    type(body_t) :: crank, rod, piston
    type(loads_t) :: acting
    real(dp) :: z(most_coordinates), holding
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
    if (present(elastic_rod)) then
      at%shape = at%n + 1
      at%n = at%n + elastic_rod%n
    end if
    acting = loads
    do pin = 1, n_pins
      if (is_loose(pin)) cycle
      acting%force(:, pin) = 0
      acting%moment(pin) = 0
    end do
    call equations%begin(at%n)
    call make_crank(bodies, drive, acting, motion, at, crank)
    if (present(elastic_rod)) then
      call make_elastic_rod(elastic_rod, bodies, acting, motion, at, rod)
      call make_piston(bodies, acting, motion, at, rod, piston, motion%chord)
      call stretch_to_piston(elastic_rod, motion, at, piston)
    else
      call make_rod(bodies, acting, motion, at, rod)
      call make_piston(bodies, acting, motion, at, rod, piston, bodies%rod%length)
    end if
    call equations%add(crank)
    call equations%add(rod)
    call equations%add(piston)
    call equations%solve(.not. drive%free_crank, z(:at%n), holding, definite, drive%acceleration)
    if (present(solvable)) solvable = definite
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
    if (present(elastic_rod)) accelerations%shape(:elastic_rod%n) = z(at%shape:at%shape + elastic_rod%n - 1)
  end subroutine accelerate_assembled

  !> The crank; its velocity is q'.
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
      body%mass(1, 1) = crank%inertia + crank%mass*(crank%com(1)**2 + crank%com(2)**2) + drive%inertia
      com_by_angle = [-crank%com(1)*s - crank%com(2)*c, crank%com(1)*c - crank%com(2)*s]
      pin_by_angle = crank%length*[-s, c]
      body%load(1) = drive%torque - drive%damping*motion%crank_speed + loads%moment(crank_pin) &
        + crank%mass*dot_product(bodies%gravity, com_by_angle) + dot_product(loads%force(:, crank_pin), pin_by_angle)
    end associate
  end subroutine make_crank

  !> The rod; its velocities are (B_x', B_y', A') of its big end and its angle, B = R (cos q, sin q) - c.
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
      call move_big_end(bodies, motion, at, body)
      ! A follows from L sin A = R sin q - o_y
      per_arm = 1/(rod%length*ca)
      body%map(3, 1) = r*cq*per_arm
      body%bias(3) = (rod%length*sa*a_rate**2 - r*sq*q_rate**2)*per_arm
      do pin = 1, n_pins
        if (at%pin(pin) > 0) body%map(3, at%pin(pin) + 1) = -per_arm
      end do
      call move_by_bore(motion, at, per_arm, body)
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

  !> The rows of B_x' and B_y' of a rod's big end.
  pure subroutine move_big_end(bodies, motion, at, body)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(inout) :: body
    real(dp) :: radius(2)
    radius = bodies%crank%length*[motion%cos_crank, motion%sin_crank]
    body%map(:2, 1) = [-radius(2), radius(1)]
    body%bias(:2) = -radius*motion%crank_speed**2
    if (at%pin(crank_pin) == 0) return
    body%map(1, at%pin(crank_pin)) = -1
    body%map(2, at%pin(crank_pin) + 1) = -1
  end subroutine move_big_end

  !> Terms of A due to a piston with clearance in its bore: o_y'' contains y'' - p_x b'' + p_y b'^2.
  pure subroutine move_by_bore(motion, at, per_arm, body)
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    real(dp), intent(in) :: per_arm   !! 1/(rod length . cos A) [1/m]
    type(body_t), intent(inout) :: body
    if (at%piston == 0) return
    body%map(3, at%piston) = -per_arm
    body%map(3, at%piston + 1) = per_arm*motion%tilting%com(1)
    body%bias(3) = body%bias(3) - per_arm*motion%tilting%com(2)*motion%tilting%tilt_rate**2
  end subroutine move_by_bore

  !> An elastic rod; its velocities are (B_x', B_y', A') of its big end and its chord, and the rates of its shapes.
  pure subroutine make_elastic_rod(elastic_rod, bodies, loads, motion, at, body)
    type(elastic_rod_t), intent(in) :: elastic_rod
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(out) :: body
    call body%begin(3 + elastic_rod%n, at%n)
    call move_big_end(bodies, motion, at, body)
    call set_elastic_map(elastic_rod, bodies%crank%length, motion, at%pin, at%shape, body)
    call move_by_bore(motion, at, 1/(motion%chord*motion%cos_rod), body)
    call set_own_equations(elastic_rod, bodies, loads, motion, body)
  end subroutine make_elastic_rod

  !> Terms of a piston in its guide due to the change of length of an elastic rod.
  pure subroutine stretch_to_piston(elastic_rod, motion, at, piston)
    type(elastic_rod_t), intent(in) :: elastic_rod
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(inout) :: piston
    real(dp) :: by_chord(most_coordinates), bias
    by_chord = 0
    call set_chord(elastic_rod, motion, at%shape, by_chord, bias)
    piston%map(1, :at%n) = piston%map(1, :at%n) + motion%cos_rod*by_chord(:at%n)
    piston%bias(1) = piston%bias(1) + motion%cos_rod*bias - 2*motion%chord_rate*motion%sin_rod*motion%rod_speed
  end subroutine stretch_to_piston

  !> The piston. In an ideal guide its velocity is x', where x = B_x + L cos A - e_x; with clearance in its bore its velocities are
  !> (x', y', b') of its centre of mass.
  pure subroutine make_piston(bodies, loads, motion, at, rod, body, rod_length)
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(coordinates_t), intent(in) :: at
    type(body_t), intent(in) :: rod
    type(body_t), intent(out) :: body
    real(dp), intent(in) :: rod_length   !! between its pins [m]
    real(dp) :: across, along
    along = rod_length*motion%cos_rod
    across = rod_length*motion%sin_rod
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
