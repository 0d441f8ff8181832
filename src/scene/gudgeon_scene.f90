!> A scene: the chain with the joints and the gas that its case asks for, as a system of differential equations.
module gudgeon_scene
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  use ode_problem, only: ode_problem_t, max_events
  use state_layout, only: layout_t, coordinates_t, slice_t
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, n_pins, turn_crank
  use chain_loads, only: loads_t, force_size
  use gudgeon_chain, only: chain_t
  use joint_motion, only: joint_motion_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, most_joints, n_phases, phase_free, phase_film, phase_contact
  use joint_events, only: penetration_and_rate
  use sticking, only: hold_surfaces
  use piston_guide, only: piston_guide_t, guide_loads_t
  use working_gas, only: working_gas_t
  use crank_turns, only: crank_turns_t
  implicit none
  private
  public :: scene_t, evaluation_t
  public :: phase_free, phase_film, phase_contact
  public :: event_none, event_contact_begins, event_contact_ends

  !> Events that a trace tells of.
  integer, parameter :: event_none = 0, event_contact_begins = 1, event_contact_ends = 2

  !> An ideal pin, in the terms of a joint with clearance.
  type(joint_motion_t), parameter :: centred_pin = joint_motion_t([0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], 0.0_dp, 0.0_dp, &
    [1.0_dp, 0.0_dp], 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp])
  type(joint_loads_t), parameter :: no_loads = joint_loads_t([0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], 0.0_dp, 0.0_dp, 0.0_dp, &
    0.0_dp, 0.0_dp, .false.)

  !> Everything that one evaluation of a scene finds: of each of its joints, or of one centred pin without loads where it has none.
  !> A right-hand side does not set what it does not need.
  type :: evaluation_t
    type(motion_t) :: motion
    type(accelerations_t) :: accelerations
    type(loads_t) :: loads
    type(joint_motion_t) :: relative(most_joints)
    type(joint_loads_t) :: joint(most_joints)
    type(guide_loads_t) :: guide    !! of a guide that is not ideal
    real(dp) :: crank_moment        !! moment of the drive on the crank [N m]
    real(dp) :: cylinder_pressure   !! [Pa]
    real(dp) :: power               !! of all non-conservative forces and the drive [W]
  end type evaluation_t

  !> Whose event an event function of the integrator is.
  type :: event_owner_t
    integer :: joint = 0            !! 0: the gas's, -1: that of the crank's turns, -2: the guide's
    integer :: event = 0            !! by the owner's own count
  end type event_owner_t

  !> A scene as an ode_problem. Of the state it claims the crank angle, unless the crank speed is held; the joints claim their
  !> eccentricities; quadratures are the work of all non-conservative forces and the drive [J] and, where they are requested,
  !> the measures of the joints: the integrals of the sizes of the forces on the piston pin and on a loose crank pin [N s] and,
  !> where the work does not tell it, what the joints take from the bodies [J].
  type, extends(ode_problem_t) :: scene_t
    type(chain_t) :: chain
    integer :: n_joints = 0         !! with clearance: 0, 1 or 2
    type(clearance_joint_t), allocatable :: joints(:)
    integer :: joint_of_pin(n_pins) = 0   !! which of them is at each pin; 0: it is ideal
    type(piston_guide_t), allocatable :: guide   !! not allocated: an ideal one
    type(working_gas_t), allocatable :: gas
    type(crank_turns_t), allocatable :: turns   !! of a free crank, where they end the run
    real(dp) :: start_angle = 0     !! crank angle at t = 0 [rad]
    real(dp) :: start_speed = 0     !! crank speed at t = 0, and always if it is held [rad/s]
    real(dp) :: span = 1            !! of the simulation [s]
    type(layout_t) :: layout        !! of the state
    type(coordinates_t) :: crank    !! where the crank angle stands in it
    logical :: runs_up = .false.    !! the held speed is run up to start_speed
    logical :: crank_moves = .true. !! it stands there: its speed is not held
    integer :: work_at = 0          !! where the work of the forces stands
    type(slice_t) :: measures       !! quadratures of the joints
    logical :: measures_loss = .false.   !! the last of them is what the joints take
    logical :: has_more_bodies = .false.   !! elastic members or a guide that is not ideal
    logical :: may_stick = .false.  !! a joint has set-valued friction
    logical :: has_more_rates = .false.   !! of measures, of elastic members, of a guide, or of the law of a joint
    real(dp) :: entry_time = -huge(1.0_dp)          !! when a joint has begun to touch last [s]
    type(event_owner_t) :: event_of(max_events)     !! owners of the event functions
  contains
    procedure :: claim
    procedure :: derivatives
    procedure :: evaluate
    procedure :: jacobian
    procedure :: initial_state
    procedure :: prepare_start
    procedure :: events => all_events
    procedure :: handle_event
    procedure :: reported_event
    procedure :: is_of_guide
    procedure :: judge_step
    procedure :: lands_on_step_end
    procedure :: rough_time
    procedure :: is_singular
    procedure :: crank_angle
    procedure :: crank_speed
    procedure :: work
    procedure :: measure_joint
    procedure :: force_integrals
    procedure :: joint_loss
    procedure :: energy
    procedure :: energy_scale
    procedure :: speed_scale
    procedure :: twist_frequency
    procedure :: joint_at
    procedure :: phase_at
    procedure :: forcing_revolutions
    procedure :: exchange
  end type scene_t

  interface
    !> Derivatives of the accelerations by positions and rates: in closed form where the piston pin alone has clearance and does not
    !> stick.
    module subroutine jacobian(self, t, y, a_p, a_v)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
      real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    end subroutine jacobian

    !> Those of the joints one by one, then those of the gas and of the crank's turns.
    pure module subroutine all_events(self, t, y, g, g_rate)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(self%n)
      real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    end subroutine all_events

    module subroutine handle_event(self, index, t, y, action)
      class(scene_t), intent(inout) :: self
      integer, intent(in) :: index
      real(dp), intent(in) :: t
      real(dp), intent(inout) :: y(:)
      integer, intent(out) :: action
    end subroutine handle_event

    !> Which event of the trace event `index` of the integrator is, before it is handled.
    pure integer module function reported_event(self, index)
      class(scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function reported_event

    !> Whether event `index` of the integrator is the guide's: that of a corner of the skirt.
    pure logical module function is_of_guide(self, index)
      class(scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function is_of_guide

    !> A step goes no deeper into contact than each joint allows.
    pure module subroutine judge_step(self, t_old, y_old, t, y, verdict, fraction)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t_old, y_old(:), t, y(:)
      integer, intent(out) :: verdict
      real(dp), intent(out) :: fraction
    end subroutine judge_step

    pure logical module function lands_on_step_end(self, index)
      class(scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function lands_on_step_end

    !> When the next contact ends.
    pure real(dp) module function rough_time(self, t, y)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
    end function rough_time

    !> Find the discrete state at t = 0 when all else is set. A journal touches where it is beyond the clearance; exactly there it
    !> does if it continues outwards, or, at rest, is pressed outwards.
    module subroutine prepare_start(self)
      class(scene_t), intent(inout) :: self
    end subroutine prepare_start

    !> Where the piston in its bore, the shapes of the rod and the flywheel are, in a scene with elastic members or a guide.
    !> `inside` is false where they cannot be.
    pure module subroutine place_more_bodies(self, t, y, now, inside)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(self%n)
      type(evaluation_t), intent(inout) :: now
      logical, intent(out) :: inside
    end subroutine place_more_bodies

    !> Add the loads of the guide to those of joints and gas: friction only as far as the loads of the piston pin are known.
    pure module subroutine load_guide(self, now)
      class(scene_t), intent(in) :: self
      type(evaluation_t), intent(inout) :: now
    end subroutine load_guide

    !> Add the friction of an ideal guide that depends on the accelerations which it changes, when these are known without it and
    !> without the friction of surfaces that stick. `inside` is false where it would jam the piston.
    pure module subroutine add_guide_friction(self, joints, now, inside)
      class(scene_t), intent(in) :: self
      type(clearance_joint_t), intent(in) :: joints(:)
      type(evaluation_t), intent(inout) :: now
      logical, intent(out) :: inside
    end subroutine add_guide_friction

    !> Add to the power of the joints that of drive, gas, guide and elastic members, in a scene with elastic members or a guide.
    pure module subroutine add_power(self, now)
      class(scene_t), intent(in) :: self
      type(evaluation_t), intent(inout) :: now
    end subroutine add_power

    !> Let the elastic members claim their part of the state.
    module subroutine claim_elastic(self)
      class(scene_t), intent(inout) :: self
    end subroutine claim_elastic

    !> Frequency with which crank and flywheel of an elastic crankshaft swing against each other about the starting angle [rad/s],
    !> with ideal joints and a rigid rod.
    pure real(dp) module function twist_frequency(self)
      class(scene_t), intent(in) :: self
    end function twist_frequency
  end interface

contains

  pure subroutine derivatives(self, t, y, dydt, inside)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: inside
    type(evaluation_t) :: now
    call find_accelerations(self, self%n_joints, self%joints, t, y, now, inside)
    if (.not. inside) return
    if (self%crank_moves) then
      dydt(self%crank%position) = now%motion%crank_speed
      dydt(self%crank%rate) = now%accelerations%crank
    end if
    call put_rates(self%n_joints, self%joints, now, dydt)
    dydt(self%work_at) = now%power
    if (.not. self%has_more_rates) return
    if (allocated(self%guide)) call self%guide%put_rates(now%motion%tilting, now%accelerations%offset, now%accelerations%tilt, &
      dydt)
    if (allocated(self%chain%elastic)) call self%chain%elastic%put_rates(now%motion, now%accelerations, dydt)
    call put_own_rates(self%n_joints, self%joints, now, dydt)
    if (self%measures%last < self%measures%first) return
    if (self%measures_loss) dydt(self%measures%last) = -sum(now%joint(:self%n_joints)%power)
    dydt(self%measures%first) = force_size(now%loads%force(:, piston_pin))
    if (self%joint_of_pin(crank_pin) > 0) dydt(self%measures%first + 1) = force_size(now%loads%force(:, crank_pin))
  end subroutine derivatives

  !> Rates of what the joints claimed.
  pure subroutine put_rates(n, joints, now, dydt)
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    type(evaluation_t), intent(in) :: now
    real(dp), intent(inout) :: dydt(*)
    integer :: i
    do i = 1, n
      associate (at => joints(i)%at, place => joints(i)%place)
        dydt(at%position) = now%relative(i)%eccentricity_rate(1)
        dydt(at%position + 1) = now%relative(i)%eccentricity_rate(2)
        dydt(at%rate) = now%accelerations%pin(1, place)
        dydt(at%rate + 1) = now%accelerations%pin(2, place)
      end associate
    end do
  end subroutine put_rates

  !> Rates of what the laws of the joints claimed.
  pure subroutine put_own_rates(n, joints, now, dydt)
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    type(evaluation_t), intent(in) :: now
    real(dp), intent(inout) :: dydt(*)
    integer :: i
    do i = 1, n
      if (joints(i)%has_own_rates) call joints(i)%put_own_rates(now%relative(i), now%joint(i), dydt)
    end do
  end subroutine put_own_rates

  !> Everything at (t, y). `inside` is false where a model is not defined: then there are only the crank angle and how the joints
  !> move, without their sliding speeds.
  pure subroutine evaluate(self, t, y, evaluation, inside)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(out) :: evaluation
    logical, intent(out) :: inside
    integer :: i
    evaluation%cylinder_pressure = 0
    evaluation%loads%force = 0
    evaluation%loads%moment = 0
    evaluation%motion%crank_pin = 0
    evaluation%motion%crank_pin_rate = 0
    if (self%n_joints == 0) then
      evaluation%relative(1) = centred_pin
      evaluation%joint(1) = no_loads
    end if
    call find_accelerations(self, self%n_joints, self%joints, t, y, evaluation, inside)
    if (inside) call self%chain%move_piston(evaluation%motion)
    do i = 1, self%n_joints
      call self%joints(i)%complete(evaluation%motion, inside, evaluation%relative(i), evaluation%joint(i))
    end do
  end subroutine evaluate

  !> Motion, loads, accelerations and power. `inside` is false where a journal cannot be. (The joints are handed on by themselves,
  !> which spares looking up their bounds and stride.)
  pure subroutine find_accelerations(self, n, joints, t, y, now, inside)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: inside
    logical :: has_more, solvable
    integer :: i

    call read_crank(self, t, y, now%motion)
    call place_journals(n, joints, y, now, inside)
    if (.not. inside) return
    has_more = self%has_more_bodies
    if (has_more) then
      call place_more_bodies(self, t, y, now, inside)
      if (.not. inside) return
    end if
    call self%chain%move_rod(now%motion, inside)
    if (.not. inside) return
    now%power = 0
    do i = 1, n
      call joints(i)%loads(self%chain%bodies, now%motion, y, now%relative(i), now%joint(i), now%loads)
      now%power = now%power + now%joint(i)%power
    end do
    now%loads%axial_force = 0
    if (allocated(self%gas)) then
      now%cylinder_pressure = self%gas%pressure(now%motion%crank_angle)
      now%loads%axial_force = self%gas%force(now%cylinder_pressure)
    end if
    if (has_more) call load_guide(self, now)
    call self%chain%accelerate(now%motion, now%loads, now%accelerations, now%crank_moment, solvable)
    if (has_more .and. solvable) call add_guide_friction(self, joints, now, solvable)
    if (.not. solvable) then
      inside = .false.
      return
    end if
    if (self%may_stick) call hold_surfaces(self%chain, joints, now%motion, now%relative, now%joint, now%loads, now%accelerations, &
      now%crank_moment, now%power)
    if (has_more) then
      call add_power(self, now)
      return
    end if
    associate (crank_speed => now%motion%crank_speed)
      now%power = (now%crank_moment - self%chain%drive%damping*crank_speed)*crank_speed + now%power
    end associate
    if (.not. allocated(self%gas)) return
    call self%chain%move_piston(now%motion)
    now%power = now%power - now%loads%axial_force*now%motion%piston_velocity
  end subroutine find_accelerations

  !> The crank.
  pure subroutine read_crank(self, t, y, motion)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(motion_t), intent(inout) :: motion
    if (self%crank_moves) then
      call turn_crank(motion, y(self%crank%position), y(self%crank%rate))
    else
      call hold_crank(self, t, motion)
    end if
  end subroutine read_crank

  !> The crank of a held speed.
  pure subroutine hold_crank(self, t, motion)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t
    type(motion_t), intent(inout) :: motion
    if (self%runs_up) then
      call turn_crank(motion, self%start_angle + self%chain%varying%turned(t), self%chain%varying%speed(t))
      motion%held_acceleration = self%chain%varying%acceleration(t)
    else
      call turn_crank(motion, self%start_angle + self%start_speed*t, self%start_speed)
    end if
  end subroutine hold_crank

  !> The eccentricities of the joints, and what they are for the chain. `inside` is false where a joint does not admit its own.
  pure subroutine place_journals(n, joints, y, now, inside)
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    real(dp), intent(in) :: y(*)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: inside
    real(dp) :: offset(2), offset_rate(2)
    logical :: admitted
    integer :: i
    admitted = .true.
    offset = 0
    offset_rate = 0
    do i = 1, n
      associate (joint => joints(i), relative => now%relative(i))
        call joint%read_state(y, relative)
        admitted = admitted .and. joint%admits(relative)
        offset = offset + relative%eccentricity
        offset_rate = offset_rate + relative%eccentricity_rate
        if (joint%place == piston_pin) cycle
        now%motion%crank_pin = relative%eccentricity
        now%motion%crank_pin_rate = relative%eccentricity_rate
      end associate
    end do
    now%motion%offset = offset
    now%motion%offset_rate = offset_rate
    inside = admitted
  end subroutine place_journals

  !> Let everybody claim their part of the state and find it, when all else is set; and number the events.
  subroutine claim(self)
    class(scene_t), intent(inout) :: self
    type(slice_t) :: work
    integer :: i
    self%n_joints = size(self%joints)
    self%joint_of_pin = 0
    do i = 1, self%n_joints
      self%joint_of_pin(self%joints(i)%place) = i
    end do
    self%highest_mode = n_phases**self%n_joints - 1
    if (allocated(self%guide)) self%highest_mode = 2*(self%highest_mode + 1) - 1
    self%crank_moves = self%chain%drive%free_crank .or. self%chain%has_crankshaft()
    if (self%crank_moves) &
      call self%layout%claim_positions(1, 1.0_dp, self%speed_scale(self%span), self%crank, grows=.true.)
    do i = 1, self%n_joints
      call self%joints(i)%claim(self%layout, self%speed_scale(self%span), self%span)
    end do
    if (allocated(self%guide)) call self%guide%claim(self%layout, self%speed_scale(self%span), self%span)
    if (allocated(self%chain%elastic)) call claim_elastic(self)
    call self%layout%claim_quadratures(1, self%energy_scale(self%span), work)
    call self%layout%settle(self%crank)
    if (allocated(self%chain%elastic)) call self%chain%elastic%settle(self%layout)
    do i = 1, self%n_joints
      call self%joints(i)%settle(self%layout)
    end do
    if (allocated(self%guide)) call self%guide%settle(self%layout)
    self%has_more_bodies = allocated(self%chain%elastic) .or. allocated(self%guide)
    self%has_more_rates = any(self%joints%has_own_rates) .or. self%has_more_bodies
    call self%layout%settle(work)
    self%work_at = work%first
    call take_layout(self)
  end subroutine claim

  !> What the integrator needs to know of the layout.
  subroutine take_layout(self)
    class(scene_t), intent(inout) :: self
    self%n = self%layout%n()
    self%n_positions = self%layout%n_positions
    self%n_quadratures = self%layout%n_quadratures
  end subroutine take_layout

  !> Integrate the measures of the joints too; before the run. They do not change its steps where there is clearance. A scene
  !> without has one measure, the integral of the force's size, and it has part in the control of the error: nothing else makes
  !> steps short enough for it.
  subroutine measure_joint(self)
    class(scene_t), intent(inout) :: self
    integer :: n
    real(dp) :: scale
    n = 1
    if (self%joint_of_pin(crank_pin) > 0) n = 2
    scale = 0
    if (self%n_joints > 0) then
      self%measures_loss = .not. work_tells(self)
      if (self%measures_loss) n = n + 1
    else
      scale = self%energy_scale(self%span)/(self%chain%bodies%crank%length*self%speed_scale(self%span))
    end if
    call self%layout%claim_quadratures(n, scale, self%measures)
    call self%layout%settle(self%measures)
    self%has_more_rates = .true.
    call take_layout(self)
  end subroutine measure_joint

  !> Whether the work of all forces tells what the joints take: nothing else but a constant torque does work.
  pure logical function work_tells(self)
    class(scene_t), intent(in) :: self
    work_tells = self%chain%drive%free_crank .and. .not. (self%chain%drive%damping > 0 .or. allocated(self%gas) &
      .or. allocated(self%chain%varying) &
                                                         .or. allocated(self%guide) .or. allocated(self%chain%elastic))
  end function work_tells

  !> Integrals of the sizes of the forces on the pins so far, in a scene that measures them [N s]; 0 of an ideal crank pin.
  pure function force_integrals(self, y) result(integrals)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp) :: integrals(n_pins)
    integrals(piston_pin) = y(self%measures%first)
    integrals(crank_pin) = 0
    if (self%joint_of_pin(crank_pin) > 0) integrals(crank_pin) = y(self%measures%first + 1)
  end function force_integrals

  !> Energy that the joints have taken from the bodies, in a scene that measures it [J]; where it is not integrated itself, the
  !> work of the drive's torque less that of all forces.
  pure real(dp) function joint_loss(self, t, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    joint_loss = 0
    if (self%n_joints == 0) return
    if (self%measures_loss) then
      joint_loss = y(self%measures%last)
    else
      joint_loss = self%chain%drive%torque*(self%crank_angle(t, y) - self%start_angle) - self%work(y)
    end if
  end function joint_loss

  !> State at t = 0.
  pure function initial_state(self) result(y)
    class(scene_t), intent(in) :: self
    real(dp) :: y(self%n)
    integer :: i
    y = 0
    if (allocated(self%chain%elastic)) call self%chain%elastic%put_start(y)
    if (self%crank_moves) then
      y(self%crank%position) = self%start_angle
      y(self%crank%rate) = self%start_speed
    end if
    do i = 1, self%n_joints
      call self%joints(i)%put_start(y)
    end do
    if (allocated(self%guide)) call self%guide%put_start(y)
  end function initial_state

  !> Whether the forces of a film have no bound next to this state.
  pure logical function is_singular(self, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    integer :: i
    is_singular = .false.
    do i = 1, self%n_joints
      is_singular = is_singular .or. self%joints(i)%is_singular(y)
    end do
  end function is_singular

  !> Crank angle at (t, y) [rad].
  pure real(dp) function crank_angle(self, t, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    if (self%crank_moves) then
      crank_angle = y(self%crank%position)
    else
      crank_angle = self%start_angle + self%start_speed*t
      if (self%runs_up) crank_angle = self%start_angle + self%chain%varying%turned(t)
    end if
  end function crank_angle

  !> Crank speed at (t, y) [rad/s].
  pure real(dp) function crank_speed(self, t, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    if (self%crank_moves) then
      crank_speed = y(self%crank%rate)
    else
      crank_speed = self%start_speed
      if (self%runs_up) crank_speed = self%chain%varying%speed(t)
    end if
  end function crank_speed

  !> Work of all non-conservative forces and the drive so far [J].
  pure real(dp) function work(self, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    work = y(self%work_at)
  end function work

  !> Kinetic and potential energy of the bodies [J].
  pure real(dp) function energy(self, motion)
    class(scene_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    energy = self%chain%energy(motion)
  end function energy

  !> Size of the crank speed [rad/s]: the start speed; from rest, one radian in the time simulated.
  pure real(dp) function speed_scale(self, span)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: span
    speed_scale = abs(self%start_speed)
    if (.not. speed_scale > 0) speed_scale = 1/span
  end function speed_scale

  !> Size of the energy [J]: the bodies at the speed scale, the weights lifted by a crank length, and rod and piston at the joints'
  !> own speeds.
  pure real(dp) function energy_scale(self, span)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: span
    integer :: i
    associate (b => self%chain%bodies)
      energy_scale = 0.5_dp*(b%crank_term + b%piston%mass*b%crank%length**2)*self%speed_scale(span)**2 &
        + (b%crank%mass + b%rod%mass + b%piston%mass)*norm2(b%gravity)*b%crank%length
      if (self%chain%has_crankshaft()) energy_scale = energy_scale &
        + 0.5_dp*self%chain%elastic%crankshaft%flywheel_inertia*self%speed_scale(span)**2
      do i = 1, self%n_joints
        energy_scale = energy_scale + 0.5_dp*(b%rod%mass + b%piston%mass)*self%joints(i)%own_speed(span)**2
      end do
      if (allocated(self%guide)) energy_scale = energy_scale + 0.5_dp*(b%rod%mass + b%piston%mass)*self%guide%own_speed(span)**2
    end associate
  end function energy_scale

  !> Which of the joints is at a pin; 0: it is ideal.
  pure integer function joint_at(self, place)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: place
    joint_at = self%joint_of_pin(place)
  end function joint_at

  !> What the joint at a pin is doing; an ideal pin is free.
  pure integer function phase_at(self, place)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: place
    integer :: i
    i = self%joint_at(place)
    phase_at = phase_free
    if (i > 0) phase_at = self%joints(i)%phase
  end function phase_at

  !> After how many revolutions what drives the motion repeats: that of the gas, or one.
  pure integer function forcing_revolutions(self)
    class(scene_t), intent(in) :: self
    forcing_revolutions = 1
    if (allocated(self%gas)) forcing_revolutions = self%gas%revolutions()
  end function forcing_revolutions

  !> The discrete state, to or from an archive.
  subroutine exchange(self, archive)
    class(scene_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    integer :: i
    call self%exchange_mode(archive)
    call archive%exchange(self%entry_time)
    do i = 1, self%n_joints
      call self%joints(i)%exchange(archive)
    end do
    if (allocated(self%guide)) call self%guide%exchange(archive)
    if (allocated(self%gas)) call self%gas%exchange(archive)
    if (allocated(self%turns)) call self%turns%exchange(archive)
  end subroutine exchange
end module gudgeon_scene
