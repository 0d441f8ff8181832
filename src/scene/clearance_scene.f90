!> The scene with clearance in the pin joint: free flight or film while apart, contact while touching.
module clearance_scene
  use kinds, only: dp
  use ode_problem, only: difference_jacobian
  use mechanism, only: motion_t, turn_crank
  use dynamics, only: loads_t, pin_force_size, accelerations_under
  use ideal_joint, only: follow_crank, ideal_rod_acceleration
  use clearance_joint, only: joint_geometry_t, joint_motion_t, find_joint_motion, sliding_speed, find_rod, find_piston
  use linearisation, only: motion_change_t, motion_change, acceleration_change
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  use archive, only: archive_t
  use state_layout, only: coordinates_t
  use film_law, only: film_law_t, film_motion_t
  use scene, only: scene_t, evaluation_t, phase_free, phase_film, phase_contact
  implicit none
  private
  public :: clearance_scene_t

  !> It claims the eccentricity as well.
  !> A law that the case does not ask for is not allocated.
  type, extends(scene_t) :: clearance_scene_t
    type(joint_geometry_t) :: joint
    type(coordinates_t) :: pin    !! where the eccentricity stands in the state
    class(contact_law_t), allocatable :: contact
    class(friction_law_t), allocatable :: friction
    class(film_law_t), allocatable :: film
    real(dp) :: max_penetration = 0         !! deepest entry where steps are refused: contact begins at the end of a step [m]
    real(dp) :: start_eccentricity(2) = 0, start_eccentricity_rate(2) = 0   !! at t = 0 [m], [m/s]
    real(dp) :: impact_speed = 0            !! penetration rate at which the present contact began [m/s]
    integer :: n_joint_events = 0           !! event functions of contact and friction
    integer :: sliding = 0                  !! set-valued friction: sign of sliding, 0 sticking
  contains
    procedure :: derivatives
    procedure :: evaluate
    procedure :: jacobian
    procedure :: initial_state
    procedure :: prepare_start
    procedure :: is_singular
    procedure :: has_clearance
    procedure :: find_pin
    procedure :: claim
    procedure :: reported_event
    procedure :: events => all_events
    procedure :: judge_step
    procedure :: handle_event
    procedure :: lands_on_step_end
    procedure :: rough_time
    procedure :: exchange
    procedure :: measure_joint
    procedure :: joint_loss
  end type clearance_scene_t

  interface
    !> Those of the joint, then those of the gas.
    pure module subroutine all_events(self, t, y, g, g_rate)
      class(clearance_scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
      real(dp), intent(out) :: g(:), g_rate(:)
    end subroutine all_events

    !> A step that begins apart may go no deeper into contact than `max_penetration` (4.12-4.13), nor pass through it. The
    !> penetration inside the step is taken as the cubic through its values and rates at both ends.
    pure module subroutine judge_step(self, t_old, y_old, t, y, verdict, fraction)
      class(clearance_scene_t), intent(in) :: self
      real(dp), intent(in) :: t_old, y_old(:), t, y(:)
      integer, intent(out) :: verdict
      real(dp), intent(out) :: fraction
    end subroutine judge_step

    pure logical module function lands_on_step_end(self, index)
      class(clearance_scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function lands_on_step_end

    !> When the contact ends, where the pin is on its way there: the force ends with the power 1.5 of the penetration.
    pure real(dp) module function rough_time(self, t, y)
      class(clearance_scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
    end function rough_time

    module subroutine handle_event(self, index, t, y, action)
      class(clearance_scene_t), intent(inout) :: self
      integer, intent(in) :: index
      real(dp), intent(in) :: t
      real(dp), intent(inout) :: y(:)
      integer, intent(out) :: action
    end subroutine handle_event

    pure integer module function reported_event(self, index)
      class(clearance_scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function reported_event

    !> Whether the pin touches: beyond the clearance it does. Exactly there it does if it goes on outwards, or, at rest,
    !> is pressed outwards.
    module subroutine prepare_start(self)
      class(clearance_scene_t), intent(inout) :: self
    end subroutine prepare_start

    !> v_T' = t . e'' - gamma' n . e' + omega_rod' R_pin, with gamma' = t . e'/|e| [m/s^2].
    pure real(dp) module function sliding_acceleration(self, now)
      class(clearance_scene_t), intent(in) :: self
      type(evaluation_t), intent(in) :: now
    end function sliding_acceleration
  end interface

contains

  pure subroutine derivatives(self, t, y, dydt, inside)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: inside
    type(evaluation_t) :: now
    call find_accelerations(self, t, y, .false., now, inside)
    if (.not. inside) return
    associate (rate => now%joint%eccentricity_rate, acceleration => now%accelerations%eccentricity)
      if (self%drive%free_crank) then
        dydt(self%crank%position) = now%motion%crank_speed
        dydt(self%crank%rate) = now%accelerations%crank
      end if
      dydt(self%pin%position) = rate(1)
      dydt(self%pin%position + 1) = rate(2)
      dydt(self%pin%rate) = acceleration(1)
      dydt(self%pin%rate + 1) = acceleration(2)
    end associate
    dydt(self%work_at) = now%power
    if (self%measures%last < self%measures%first) return
    dydt(self%measures%first) = pin_force_size(now%loads)
    if (self%measures%last > self%measures%first) dydt(self%measures%last) = -joint_power(now)
  end subroutine derivatives

  !> Power of the joint on the bodies [W]: of its force along the eccentricity and of its moment along the turning pin.
  pure real(dp) function joint_power(now)
    type(evaluation_t), intent(in) :: now
    associate (force => now%loads%pin_force, rate => now%joint%eccentricity_rate)
      joint_power = (force(1)*rate(1) + force(2)*rate(2)) - now%loads%pin_moment*now%motion%rod_speed
    end associate
  end function joint_power

  !> The integral of the force's size [N s] and, unless the work of all forces tells it, what the joint takes from the bodies.
  subroutine measure_joint(self)
    class(clearance_scene_t), intent(inout) :: self
    logical :: work_tells
    work_tells = self%drive%free_crank .and. .not. (self%drive%damping > 0 .or. allocated(self%gas))
    call self%claim_measures(merge(1, 2, work_tells), 0.0_dp)   ! they take no part in the error control
  end subroutine measure_joint

  !> Energy that the joint has taken from the bodies [J]; where it is not integrated itself, the work of the drive's torque
  !> less that of all forces.
  pure real(dp) function joint_loss(self, t, y)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    if (self%measures%last > self%measures%first) then
      joint_loss = y(self%measures%last)
    else
      joint_loss = self%drive%torque*(self%crank_angle(t, y) - self%start_angle) - self%work(y)
    end if
  end function joint_loss

  pure subroutine evaluate(self, t, y, evaluation, inside)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(out) :: evaluation
    logical, intent(out) :: inside
    evaluation%cylinder_pressure = 0
    evaluation%normal_force = 0
    evaluation%friction_force = 0
    call find_accelerations(self, t, y, .true., evaluation, inside)
    if (.not. inside) return
    evaluation%joint%sliding_speed = sliding_speed(self%joint, evaluation%joint%tangential_rate, -evaluation%motion%rod_speed)
  end subroutine evaluate

  !> Motion, loads, accelerations and power; the joint in polar terms and the piston only as far as the present phase needs
  !> them, unless it is to be `complete`. `inside` is false where the pin cannot be.
  !>
  !> The order is for speed: a processor has room for half of this ahead. What waits for the sine and cosine comes last, and
  !> what needs neither comes right after them.
  pure subroutine find_accelerations(self, t, y, complete, now, inside)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    logical, value, intent(in) :: complete
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: inside
    real(dp) :: crank_angle, crank_speed
    logical :: sticks

    call read_state(self, t, y, crank_angle, crank_speed, now%joint)
    call turn_crank(now%motion, crank_angle, crank_speed)
    if (complete .or. self%phase == phase_contact) call find_joint_motion(self%joint, now%joint)
    if (self%phase == phase_contact) now%normal_force = &
      self%contact%normal_force(now%joint%penetration, now%joint%penetration_rate, self%impact_speed)
    now%loads%gas_force = 0
    if (allocated(self%gas)) call self%add_gas(crank_angle, now)
    call find_rod(self%mechanism, now%joint%eccentricity, now%joint%eccentricity_rate, now%motion, inside)
    inside = inside .and. may_be_at(self, now%joint%eccentricity)
    if (.not. inside) return
    if (complete .or. allocated(self%gas)) &
      call find_piston(self%mechanism, now%joint%eccentricity, now%joint%eccentricity_rate, now%motion)
    sticks = .false.
    select case (self%phase)
    case (phase_contact)
      call add_contact(self, now, sticks)
    case (phase_film)
      call self%film%film_force(film_motion(self, now), now%loads%pin_force, now%loads%pin_moment)
    case default
      now%loads%pin_force = 0
      now%loads%pin_moment = 0
    end select
    do
      call accelerations_under(self%mechanism, self%drive, now%loads, now%motion, now%accelerations, now%crank_moment)
      if (.not. sticks) exit
      call hold_pin(self, now)   ! found without friction: once more with the one that holds the pin
      sticks = .false.
    end do
    now%power = (now%crank_moment - self%drive%damping*crank_speed)*crank_speed
    if (self%phase /= phase_free) now%power = now%power + joint_power(now)
    if (allocated(self%gas)) now%power = now%power - now%loads%gas_force*now%motion%piston_velocity
  end subroutine find_accelerations

  !> Crank and eccentricity from the state.
  pure subroutine read_state(self, t, y, crank_angle, crank_speed, joint)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: crank_angle, crank_speed
    type(joint_motion_t), intent(inout) :: joint
    if (self%drive%free_crank) then
      crank_angle = y(self%crank%position)
      crank_speed = y(self%crank%rate)
    else
      crank_angle = self%start_angle + self%start_speed*t
      crank_speed = self%start_speed
    end if
    joint%eccentricity(1) = y(self%pin%position)
    joint%eccentricity(2) = y(self%pin%position + 1)
    joint%eccentricity_rate(1) = y(self%pin%rate)
    joint%eccentricity_rate(2) = y(self%pin%rate + 1)
  end subroutine read_state

  !> Whether the pin may be there: inside the bearing's wall and, where a film is singular, inside the clearance.
  pure logical function may_be_at(self, e)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: e(2)
    real(dp) :: distance_squared
    distance_squared = e(1)**2 + e(2)**2
    may_be_at = distance_squared < self%joint%bearing_radius**2
    if (self%phase == phase_film) &
      may_be_at = may_be_at .and. (distance_squared < self%joint%clearance**2 .or. .not. self%film%singular_at_wall)
  end function may_be_at

  !> Derivatives of the accelerations by positions and rates, in closed form but for films that have none, and for a pin
  !> that sticks.
  subroutine jacobian(self, t, y, a_p, a_v)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    type(evaluation_t) :: now
    type(motion_change_t) :: change
    type(loads_t) :: load_change
    real(dp) :: force(3, 5), direction(6), loads(3), a(4)
    logical :: inside
    integer :: i, skip

    call self%evaluate(t, y, now, inside)
    if (self%phase == phase_contact .and. allocated(self%friction)) then
      if (self%friction%set_valued .and. self%sliding == 0) inside = .false.
    end if
    if (.not. inside) then
      call difference_jacobian(self, t, y, a_p, a_v)
      return
    end if
    force = 0
    if (self%phase == phase_contact) call contact_derivatives(self, now, force)
    if (self%phase == phase_film) call self%film%force_derivatives(film_motion(self, now), force)
    skip = merge(0, 1, self%drive%free_crank)   ! the held crank angle is no unknown
    do i = 1 + skip, 6
      if (i == 4 .and. skip == 1) cycle
      direction = 0
      direction(i) = 1   ! of q, e_x, e_y, q', e_x', e_y'
      change = motion_change(self%mechanism, now%motion, direction(1), direction(4), direction(3), direction(6))
      loads = matmul(force(:, 1:2), direction(2:3)) + matmul(force(:, 3:4), direction(5:6)) - force(:, 5)*change%rod_speed
      load_change%pin_force = loads(1:2)
      load_change%pin_moment = loads(3)
      load_change%gas_force = 0
      if (allocated(self%gas) .and. i == 1) load_change%gas_force = self%gas_force_slope(now%motion%crank_angle)
      a = acceleration_change(self%mechanism, self%drive, now%loads, now%motion, now%accelerations, change, load_change)
      if (i <= 3) then
        a_p(:, i - skip) = a(1 + skip:3)
      else
        a_v(:, i - 3 - skip) = a(1 + skip:3)
      end if
    end do
  end subroutine jacobian

  !> Derivatives of contact and friction forces and of their moment by e_x, e_y, e_x', e_y' and the pin speed (see
  !> `difference_derivatives` of the films).
  pure subroutine contact_derivatives(self, now, derivatives)
    class(clearance_scene_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    real(dp), intent(out) :: derivatives(3, 5)
    real(dp) :: stiffness, damping, ratio, ratio_slope, turn(5), depth(5), rate(5), sliding(5), normal(5), friction(5)
    integer :: i

    associate (joint => now%joint, n => now%joint%normal)
      call self%contact%normal_force_slopes(joint%penetration, joint%penetration_rate, self%impact_speed, stiffness, damping)
      ratio = 0
      ratio_slope = 0
      if (allocated(self%friction)) then
        ratio = self%friction%friction_ratio(joint%sliding_speed, self%sliding)
        ratio_slope = self%friction%friction_ratio_slope(joint%sliding_speed)
      end if
      turn = [-n(2), n(1), 0.0_dp, 0.0_dp, 0.0_dp]/joint%distance
      depth = [n(1), n(2), 0.0_dp, 0.0_dp, 0.0_dp]
      rate = turn*joint%tangential_rate + [0.0_dp, 0.0_dp, n(1), n(2), 0.0_dp]
      sliding = -turn*joint%penetration_rate + [0.0_dp, 0.0_dp, -n(2), n(1), self%joint%pin_radius]
      normal = stiffness*depth + damping*rate
      friction = ratio*normal + ratio_slope*now%normal_force*sliding
      do i = 1, 5
        associate (along => -normal(i) - now%friction_force*turn(i), across => friction(i) - now%normal_force*turn(i))
          derivatives(:, i) = [along*n(1) - across*n(2), along*n(2) + across*n(1), self%joint%pin_radius*friction(i)]
        end associate
      end do
    end associate
  end subroutine contact_derivatives

  !> The motion as a film sees it.
  pure function film_motion(self, now) result(film)
    class(clearance_scene_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    type(film_motion_t) :: film
    type(motion_t) :: ideal
    film%eccentricity = now%joint%eccentricity
    film%eccentricity_rate = now%joint%eccentricity_rate
    film%pin_speed = -now%motion%rod_speed
    if (self%film%needs_ideal_motion) then
      ideal%sin_crank = now%motion%sin_crank
      ideal%cos_crank = now%motion%cos_crank
      ideal%crank_speed = now%motion%crank_speed
      call follow_crank(self%mechanism, ideal)
      film%ideal_pin_speed = -ideal%rod_speed
      film%ideal_pin_acceleration = -ideal_rod_acceleration(self%mechanism, ideal)
      film%frequency = abs(now%motion%crank_speed)
    end if
  end function film_motion

  !> Friction and the joint's loads. Where the pin `sticks` there is none yet: `hold_pin` finds it.
  pure subroutine add_contact(self, now, sticks)
    class(clearance_scene_t), intent(in) :: self
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: sticks
    sticks = .false.
    now%friction_force = 0
    if (allocated(self%friction)) then
      now%joint%sliding_speed = sliding_speed(self%joint, now%joint%tangential_rate, -now%motion%rod_speed)
      sticks = self%friction%set_valued .and. self%sliding == 0
      if (.not. sticks) now%friction_force = now%normal_force*self%friction%friction_ratio(now%joint%sliding_speed, self%sliding)
    end if
    call put_contact_loads(self, now)
  end subroutine add_contact

  !> The joint's loads in contact: force -F_N n + F_T t on the pin, moment F_T R_pin.
  pure subroutine put_contact_loads(self, now)
    class(clearance_scene_t), intent(in) :: self
    type(evaluation_t), intent(inout) :: now
    associate (n => now%joint%normal, pressing => now%normal_force, friction => now%friction_force)
      now%loads%pin_force(1) = -pressing*n(1) - friction*n(2)
      now%loads%pin_force(2) = friction*n(1) - pressing*n(2)
      now%loads%pin_moment = friction*self%joint%pin_radius
    end associate
  end subroutine put_contact_loads

  !> Add the friction force that keeps the sliding speed constant: v_T' is linear in it. `now` is found without it.
  pure subroutine hold_pin(self, now)
    class(clearance_scene_t), intent(in) :: self
    type(evaluation_t), intent(inout) :: now
    type(motion_change_t) :: none
    type(loads_t) :: unit
    real(dp) :: a(4)
    unit = loads_t([-now%joint%normal(2), now%joint%normal(1)], self%joint%pin_radius, 0.0_dp)
    a = acceleration_change(self%mechanism, self%drive, now%loads, now%motion, now%accelerations, none, unit)
    now%friction_force = -sliding_acceleration(self, now)/(dot_product(unit%pin_force, a(2:3)) - a(4)*unit%pin_moment)
    call put_contact_loads(self, now)
  end subroutine hold_pin

  !> The discrete state, to or from an archive.
  subroutine exchange(self, archive)
    class(clearance_scene_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call self%exchange_phase(archive)
    call archive%exchange(self%impact_speed)
    call archive%exchange(self%sliding)
  end subroutine exchange

  pure function initial_state(self) result(y)
    class(clearance_scene_t), intent(in) :: self
    real(dp) :: y(self%n)
    y = 0
    if (self%drive%free_crank) then
      y(self%crank%position) = self%start_angle
      y(self%crank%rate) = self%start_speed
    end if
    y(self%pin%position:self%pin%position + 1) = self%start_eccentricity
    y(self%pin%rate:self%pin%rate + 1) = self%start_eccentricity_rate
  end function initial_state

  pure logical function has_clearance(self)
    class(clearance_scene_t), intent(in) :: self
    associate (unused_self => self)
    end associate
    has_clearance = .true.
  end function has_clearance

  pure subroutine find_pin(self, t, y, joint, normal_force)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    type(joint_motion_t), intent(out) :: joint
    real(dp), intent(out) :: normal_force
    real(dp) :: crank_angle, crank_speed
    call read_state(self, t, y, crank_angle, crank_speed, joint)
    call find_joint_motion(self%joint, joint)
    joint%sliding_speed = 0
    normal_force = 0
    if (self%phase == phase_contact) &
      normal_force = self%contact%normal_force(joint%penetration, joint%penetration_rate, self%impact_speed)
  end subroutine find_pin

  !> A film that grows without bound at the wall, and has next to no thickness.
  pure logical function is_singular(self, y)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp), parameter :: thin = 1e-6_dp   !! of the clearance
    is_singular = .false.
    if (self%phase == phase_film) is_singular = self%film%singular_at_wall .and. &
      norm2(y(self%pin%position:self%pin%position + 1)) > (1 - thin)*self%joint%clearance
  end function is_singular

  !> The eccentricity is measured by the clearance, its rate by the clearance in the time of one radian. Measured
  !> (scripts/compare_adams.sh, simulation IV, c = 20 um): at the relative tolerance 1e-4 the pin is off by 4e-5 c at the
  !> end, at 1e-6 by 4e-9 c, at 1e-12 by 1e-14 c; in (q, A, x) rounding alone makes 4e-12 c.
  !>
  !> A pin may have a speed of its own where the crank hardly turns: the one that it starts with, or that in which it crosses the
  !> clearance in the time simulated (where this time is so short that it is more than `most_crossing_speed`, that). The rate is
  !> measured by a hundredth of the latter: at first a pin at rest is slow, and it may stay so.
  subroutine claim(self)
    class(clearance_scene_t), intent(inout) :: self
    real(dp), parameter :: most_crossing_speed = 1   !! [m/s]
    real(dp) :: thrown, crossing
    thrown = norm2(self%start_eccentricity_rate)
    crossing = min(self%joint%clearance/self%span, most_crossing_speed)
    self%pin_speed = max(thrown, crossing)
    call self%claim_crank()
    call self%layout%claim_positions(2, self%joint%clearance, max(self%joint%clearance*self%speed_scale(self%span), &
      thrown, 0.01_dp*crossing), self%pin, grows=.false.)
    call self%layout%settle(self%pin)
    call self%claim_work()
  end subroutine claim
end module clearance_scene
