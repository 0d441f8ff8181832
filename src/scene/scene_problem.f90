!> A scene: the chain of crank, rod and piston with the joints and the gas of a case, as a system of differential equations.
module scene_problem
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, max_events
  use state_layout, only: layout_t, coordinates_t, slice_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, small_end, turn_crank, follow_rod, follow_piston
  use train_motion, only: most_cylinders
  use joint_places, only: places, n_places, n_spots
  use chain_loads, only: loads_t, force_size
  use mechanism_chain, only: chain_t
  use crank_rod, only: accelerate_crank_rod
  use ideal_chain, only: accelerate_ideal_chain
  use joint_evaluation, only: joint_evaluation_t, clear_loads
  use clearance_joint, only: clearance_joint_t, most_bearings, n_phases, phase_film, phase_contact
  use joint_events, only: penetration_and_rate
  use sticking, only: hold_surfaces
  use carried_bearing, only: carried_bearing_t
  use bearing_load, only: bearing_load_t
  use piston_guide, only: piston_guide_t, guide_loads_t
  use face_film, only: no_tangent
  use working_gas, only: working_gas_t
  use other_cylinders, only: other_cylinders_t
  use cylinder_charge, only: charge_motion_t, n_charge_sums
  use crank_turns, only: crank_turns_t, wear_cycle_t
  implicit none
  private
  public :: scene_t, evaluation_t, work_part_t
  public :: by_gas, by_drive, by_damping, by_guide, by_elastic
  public :: phase_film, phase_contact
  public :: event_none, event_contact_begins, event_contact_ends, of_guide, of_wear, of_reeds

  !> Events reported in the trace.
  integer, parameter :: event_none = 0, event_contact_begins = 1, event_contact_ends = 2

  !> The results of one evaluation of a scene. Arrays have one element for each joint that is not ideal. The right-hand side sets
  !> only the components that it needs.
  type :: evaluation_t
    type(motion_t) :: motion
    type(accelerations_t) :: accelerations
    type(loads_t) :: loads
    type(joint_evaluation_t) :: joint(most_bearings)
    type(guide_loads_t) :: guide    !! of a guide that is not ideal
    real(dp) :: crank_moment        !! moment of the drive on the crank [N m]
    real(dp) :: cylinder_pressure   !! [Pa]
    type(charge_motion_t) :: charge !! gas of the cylinder, where it has a mass
    real(dp) :: power               !! of all non-conservative forces and the drive [W]
  end type evaluation_t

  !> Owners of events other than joints.
  integer, parameter :: of_gas = 0, of_turns = -1, of_guide = -2, of_wear = -3, of_other_gas = -4, of_load = -5, &
    of_reeds = -6
  integer, parameter :: first_owner = of_reeds

  !> The owner of an event function of the integrator.
  type :: event_owner_t
    integer :: joint = 0            !! or of_gas, of_turns, of_guide, of_wear, of_other_gas, of_load, of_reeds
    integer :: event = 0            !! number of the event within its owner
  end type event_owner_t

  !> What does work on the bodies besides the kinds of load in the joints.
  integer, parameter :: by_gas = -1, by_drive = -2, by_damping = -3, by_guide = -4, by_elastic = -5

  !> A part of the work on the bodies.
  type :: work_part_t
    integer :: what = 0             !! kind of load in a joint, or one of the above
    integer :: joint = 0            !! that joint; 0: none
    integer :: at = 0               !! index of its quadrature; 0: its work follows otherwise
  end type work_part_t

  !> A scene as an ode_problem. It claims the crank angle in the state vector, unless the crank speed is prescribed; the joints
  !> claim their eccentricities. Quadratures are the work of all non-conservative forces and the drive [J] and, on request, the
  !> integrals of the magnitudes of the forces at the reported places [N s] and, if it does not follow
  !> from the work, the energy that the joints take from the bodies [J].
  type, extends(ode_problem_t) :: scene_t
    type(chain_t) :: chain
    integer :: n_joints = 0         !! number of joints with clearance
    type(clearance_joint_t), allocatable :: joints(:)      !! these, and then the joints of the carried bearings
    type(carried_bearing_t), allocatable :: carried(:)     !! bearings without influence on the mechanism
    type(bearing_load_t), allocatable :: given_load        !! of a bearing by itself; there is no mechanism
    integer :: joint_at(n_spots) = 0    !! index of the joint at each spot; 0: an ideal pin, or none
    integer, allocatable :: reported(:) !! spots with results: the first one, and those with a joint
    logical :: has_numbers = .false.    !! some of the carried bearings are numbered
    type(piston_guide_t), allocatable :: guide   !! not allocated: the guide is ideal
    type(working_gas_t), allocatable :: gas
    type(other_cylinders_t), allocatable :: other_gas   !! in the other cylinders of an engine with gas
    type(crank_turns_t), allocatable :: turns   !! turns of a free crank that end the run
    type(wear_cycle_t), allocatable :: wear_cycle   !! turns of the crank after which the shape of a worn bore changes
    real(dp) :: start_angle = 0     !! crank angle at t = 0 [rad]
    real(dp) :: start_speed = 0     !! crank speed at t = 0; constant if it is prescribed without run-up [rad/s]
    real(dp) :: span = 1            !! duration of the simulation [s]
    real(dp) :: torque_work = 0     !! `work_of_torque` beyond that of the present torque since the start [J]
    type(layout_t) :: layout        !! layout of the state vector
    type(coordinates_t) :: crank    !! indices of the crank angle in the state vector
    logical :: runs_up = .false.    !! the prescribed speed is run up to start_speed
    logical :: crank_moves = .true. !! the crank angle is a state: its speed is not prescribed
    integer :: work_at = 0          !! index of the work of the forces
    type(slice_t) :: measures       !! indices of the integrals on request
    logical :: measures_loss = .false.   !! the last of them is the energy taken by the joints
    type(work_part_t), allocatable :: parts(:)   !! parts of the work, if they are told apart
    integer :: n_works = 0          !! number of them; the following ones are works in carried bearings, which no body feels
    logical :: has_heat = .false.   !! the film of a joint heats up
    logical :: has_charge = .false. !! pressure and mass of the gas are states
    logical :: clears_loads = .false.       !! the right-hand side needs all loads of a joint, also those that do not act
    integer :: other_part = 0       !! the part that is the whole work without that of the others; 0: none
    logical :: is_plain = .true.    !! rigid bodies, an ideal guide and a drive that does not vary
    logical :: may_stick = .false.  !! a joint has set-valued friction
    logical :: enters_at_step_end = .false.   !! contacts begin at the ends of steps, and steps that enter too deep are rejected
    logical :: has_more_rates = .false.  !! there are rates of integrals on request, of elastic members, of a guide, or of the law
                                         !! of a joint
    real(dp) :: entry_time = -huge(1.0_dp)          !! beginning of the last contact [s]
    type(event_owner_t) :: event_of(max_events)     !! owners of the event functions
    type(slice_t) :: events_of(first_owner:most_bearings)   !! and the event functions of each owner, a joint or one of the above
  contains
    procedure :: claim
    procedure, non_overridable :: read_crank
    procedure, non_overridable :: place_pins
    procedure, non_overridable :: read_temperatures
    procedure, non_overridable :: find_loads
    procedure, non_overridable :: load_gas
    procedure :: derivatives
    procedure, non_overridable :: find_rates
    procedure :: evaluate
    procedure :: jacobian
    procedure :: initial_state
    procedure :: prepare_start
    procedure :: declare
    procedure :: complete_state
    procedure :: events => all_events
    procedure :: handle_event
    procedure :: reported_event
    procedure :: judge_step
    procedure :: lands_on_step_end
    procedure :: next_kink_time
    procedure :: is_singular
    procedure :: crank_angle
    procedure :: crank_speed
    procedure :: forced_revolutions
    procedure :: work
    procedure :: work_of_torque
    procedure :: measure_joint
    procedure, non_overridable :: set_layout
    procedure :: measure_works
    procedure :: works
    procedure :: pin_force
    procedure :: turned
    procedure :: force_integrals
    procedure :: joint_loss
    procedure :: energy
    procedure :: energy_scale
    procedure :: speed_scale
    procedure :: twist_frequency
    procedure :: charge_totals
    procedure :: charge_residual
    procedure :: compared_states
  end type scene_t

  interface
    !> Derivatives of the accelerations with respect to positions and rates; in closed form if only the piston pin has clearance and
    !> its surfaces do not stick.
    module subroutine jacobian(self, t, y, a_p, a_v)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
      real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    end subroutine jacobian

    !> Event functions of the joints, one after the other, then of the gas and of the turns of the crank.
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

    !> The kind of trace event that event `index` of the integrator is, before it is handled.
    pure integer module function reported_event(self, index)
      class(scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function reported_event

    !> Reject a step whose penetration at its end exceeds the limit of a joint, or in which a pin reverses its sliding and passes
    !> over the static friction.
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

    !> Predicted end of a contact.
    pure real(dp) module function next_kink_time(self, t, y)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
    end function next_kink_time

    !> Find the discrete state at t = 0 after everything else has been set. A pin beyond the clearance is in contact. A pin
    !> exactly at the wall is in contact if it moves outwards or, at rest, is pressed outwards.
    module subroutine prepare_start(self)
      class(scene_t), intent(inout) :: self
    end subroutine prepare_start

    !> Declare the state at (t, y) to a list that records it, or set it from a list; then call `complete_state`.
    module subroutine declare(self, list, t, y)
      class(scene_t), intent(inout) :: self
      type(run_state_t), intent(inout) :: list
      real(dp), intent(inout) :: t, y(:)
    end subroutine declare

    !> Find the part of the discrete state that follows from a state that has been set.
    module subroutine complete_state(self, t, y)
      class(scene_t), intent(inout) :: self
      real(dp), intent(in) :: t, y(:)
    end subroutine complete_state

    !> `find_accelerations` of a scene that is not plain: with elastic members, a guide that is not ideal or a drive that varies.
    pure module subroutine find_general_accelerations(self, joints, t, y, now, in_domain)
      class(scene_t), intent(in) :: self
      type(clearance_joint_t), intent(in) :: joints(:)
      real(dp), intent(in) :: t, y(self%n)
      type(evaluation_t), intent(inout) :: now
      logical, intent(out) :: in_domain
    end subroutine find_general_accelerations

    !> Set the motion of the bodies and of the pins in their bearings, as far as it follows from the state. `in_domain` is false if
    !> it is not admissible.
    pure module subroutine move_bodies(self, joints, t, y, now, in_domain)
      class(scene_t), intent(in) :: self
      type(clearance_joint_t), intent(in) :: joints(:)
      real(dp), intent(in) :: t, y(self%n)
      type(evaluation_t), intent(inout) :: now
      logical, intent(out) :: in_domain
    end subroutine move_bodies

    !> Motion and loads of the carried bearings, from the forces in the chain. `in_domain` is false if a pin is at the wall.
    pure module subroutine look_at_carried(self, y, now, in_domain)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: y(self%n)
      type(evaluation_t), intent(inout) :: now
      logical, intent(out) :: in_domain
    end subroutine look_at_carried

    !> Angles by which pin and bearing of a joint have turned, from x to y [rad].
    pure module function turned(self, now, joint)
      class(scene_t), intent(in) :: self
      type(evaluation_t), intent(in) :: now
      integer, intent(in) :: joint
      real(dp) :: turned(2)
    end function turned

    !> Set the motion of crank and rod in a scene without mechanism. `in_domain` is false if there is no rod angle.
    pure module subroutine move_without_mechanism(self, t, y, now, in_domain)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(self%n)
      type(evaluation_t), intent(inout) :: now
      logical, intent(out) :: in_domain
    end subroutine move_without_mechanism

    !> Let all parts claim their states, after everything else has been set.
    module subroutine claim(self)
      class(scene_t), intent(inout) :: self
    end subroutine claim

    !> Pass the parts of the layout that the integrator needs to it.
    module subroutine set_layout(self)
      class(scene_t), intent(inout) :: self
    end subroutine set_layout

    !> Request the integrals of the joints; must be called before the run. In a scene with clearance they do not influence the
    !> steps. In a mechanism without clearance the only one, the integral of the force, takes part in the error control, since
    !> otherwise the steps would be too long for it.
    module subroutine measure_joint(self)
      class(scene_t), intent(inout) :: self
    end subroutine measure_joint

    !> State at t = 0.
    pure module function initial_state(self) result(y)
      class(scene_t), intent(in) :: self
      real(dp) :: y(self%n)
    end function initial_state

    !> Indices of the states by which motions are compared: all except quadratures, the crank angle, and the angle of a floating
    !> pin, on which nothing depends and which drifts.
    pure module function compared_states(self) result(at)
      class(scene_t), intent(in) :: self
      integer, allocatable :: at(:)
    end function compared_states

    !> Crank angles of the other cylinders from their axes [rad] and speeds of their stations [rad/s] at (t, y).
    pure module subroutine other_cranks(self, t, y, angle, speed)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
      real(dp), intent(out) :: angle(most_cylinders), speed(most_cylinders)
    end subroutine other_cranks

    !> Tell the parts of the work apart; must be called before the run. One part follows from the whole work, the others are
    !> quadratures without influence on the steps.
    module subroutine measure_works(self)
      class(scene_t), intent(inout) :: self
    end subroutine measure_works

    !> Rates of the quadratures of the parts of the work.
    pure module subroutine set_work_rates(self, y, now, dydt)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: y(self%n)
      type(evaluation_t), intent(in) :: now
      real(dp), intent(inout) :: dydt(*)
    end subroutine set_work_rates

    !> Work of each part on the bodies since t = 0 [J], in a scene that tells them apart.
    pure module function works(self, t, y)
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(:)
      real(dp) :: works(size(self%parts))
    end function works

    !> Natural frequency of crank and flywheel on an elastic crankshaft [rad/s], with ideal joints, a rigid rod and the mean inertia
    !> of rod and piston over a turn.
    pure real(dp) module function twist_frequency(self)
      class(scene_t), intent(in) :: self
    end function twist_frequency
  end interface

contains

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    type(evaluation_t) :: now
    if (allocated(self%guide)) now%guide%tangent%role = no_tangent
    call self%find_rates(t, y, now, dydt, in_domain)
  end subroutine derivatives

  !> The same, with the evaluation: on entry its tangent of the guide's film, which may be wanted or act.
  pure subroutine find_rates(self, t, y, now, dydt, in_domain)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(inout) :: now
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    integer :: i
    if (self%clears_loads) then
      do i = 1, self%n_joints
        call clear_loads(now%joint(i))
      end do
    end if
    if (size(self%carried) > 0) call clear_chain(now)
    call find_accelerations(self, self%n_joints, self%joints, t, y, now, in_domain)
    if (.not. in_domain) return
    if (size(self%carried) > 0) call look_at_carried(self, y, now, in_domain)
    if (.not. in_domain) return
    if (self%crank_moves) then
      dydt(self%crank%position) = now%motion%crank_speed
      dydt(self%crank%rate) = now%accelerations%crank
    end if
    call set_rates(self%n_joints, self%joints, now, dydt)
    dydt(self%work_at) = now%power
    if (.not. self%has_more_rates) return
    do i = 1, size(self%carried)
      associate (it => self%carried(i))
        dydt(it%place%first:it%place%last) = now%joint(it%joint)%eccentricity_rate
        if (allocated(self%joints(it%joint)%heat)) call self%joints(it%joint)%set_heat_rates(now%joint(it%joint), y, dydt)
      end associate
    end do
    if (allocated(self%guide)) call self%guide%set_rates(now%motion%tilting, now%accelerations%offset, now%accelerations%tilt, &
      now%guide, dydt)
    if (allocated(self%chain%floating)) call self%chain%floating%set_rates(now%motion, now%accelerations, dydt)
    if (allocated(self%chain%elastic)) call self%chain%elastic%set_rates(now%motion, now%accelerations, dydt)
    if (allocated(self%chain%train)) call self%chain%train%set_rates(now%motion, now%accelerations, dydt)
    do i = 1, self%n_joints
      if (self%joints(i)%has_own_rates) call self%joints(i)%set_own_rates(now%joint(i), y, dydt)
    end do
    if (self%has_charge) call set_charge_rates(self, now, y, dydt)
    if (allocated(self%parts)) call set_work_rates(self, y, now, dydt)
    if (self%measures%last < self%measures%first) return
    if (self%measures_loss) dydt(self%measures%last) = -sum(now%joint(:self%n_joints)%power)
    do i = 1, size(self%reported)
      dydt(self%measures%first + i - 1) = force_size(self%pin_force(now, self%reported(i)))
    end do
  end subroutine find_rates

  !> Rates of pressure and mass of the gas in all cylinders.
  pure subroutine set_charge_rates(self, now, y, dydt)
    class(scene_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    real(dp), intent(in) :: y(self%n)
    real(dp), intent(inout) :: dydt(self%n)
    real(dp) :: speed(most_cylinders)
    integer :: i, n
    associate (charge => self%gas%charge)
      call charge%set_rates(1, now%charge, y, dydt)
      dydt(charge%sums%first:charge%sums%last) = now%charge%rates(:charge%sums%last - charge%sums%first + 1)
    end associate
    if (.not. allocated(self%other_gas)) return
    n = size(self%chain%train%cylinders)
    do i = 1, n
      speed(i) = now%motion%train%speed(self%chain%train%cylinders(i)%station)
    end do
    call self%other_gas%set_rates(self%gas, now%motion%train%angle(:n), speed(:n), y, dydt)
  end subroutine set_charge_rates

  !> Rates of the states of the joints.
  pure subroutine set_rates(n, joints, now, dydt)
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    type(evaluation_t), intent(in) :: now
    real(dp), intent(inout) :: dydt(*)
    integer :: i
    do i = 1, n
      associate (at => joints(i)%at, pin => joints(i)%site%pin)
        dydt(at%position) = now%joint(i)%eccentricity_rate(1)
        dydt(at%position + 1) = now%joint(i)%eccentricity_rate(2)
        dydt(at%rate) = joints(i)%site%sense*now%accelerations%pin(1, pin)
        dydt(at%rate + 1) = joints(i)%site%sense*now%accelerations%pin(2, pin)
      end associate
    end do
  end subroutine set_rates

  !> Evaluate all quantities at (t, y). `in_domain` is false if a model is not defined there; then only the crank angle and the
  !> motion of the joints are set, without sliding speeds.
  pure subroutine evaluate(self, t, y, evaluation, in_domain)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(out) :: evaluation
    logical, intent(out) :: in_domain
    integer :: i
    evaluation%cylinder_pressure = 0
    evaluation%guide%tangent%role = no_tangent
    call clear_chain(evaluation)
    do i = 1, self%n_joints
      call clear_loads(evaluation%joint(i))
    end do
    call find_accelerations(self, self%n_joints, self%joints, t, y, evaluation, in_domain)
    if (in_domain .and. .not. allocated(self%given_load)) call self%chain%move_piston(evaluation%motion)
    do i = 1, self%n_joints
      call self%joints(i)%complete(evaluation%motion, in_domain, y, evaluation%joint(i))
    end do
    if (in_domain .and. size(self%carried) > 0) call look_at_carried(self, y, evaluation, in_domain)
    if (self%has_charge .or. .not. (in_domain .and. allocated(self%gas))) return
    if (allocated(self%gas%charge)) &
      call self%gas%find_charge(evaluation%motion%crank_angle, evaluation%motion%crank_speed, y, evaluation%charge)
  end subroutine evaluate

  !> Set what forces between the bodies depend on, and what a chain without clearance leaves as it is.
  pure subroutine clear_chain(now)
    type(evaluation_t), intent(inout) :: now
    now%loads%force = 0
    now%loads%moment = 0
    now%motion%crank_pin = 0
    now%motion%crank_pin_rate = 0
  end subroutine clear_chain

  !> Compute motion, loads, accelerations and power. `in_domain` is false if an eccentricity is not admissible. (The joints are
  !> passed as an argument of fixed size, which avoids looking up bounds and strides. The equations of the two most common chains
  !> are called directly, so that the compiler includes them here.)
  pure subroutine find_accelerations(self, n, joints, t, y, now, in_domain)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: in_domain

    if (.not. self%is_plain) then
      call find_general_accelerations(self, joints, t, y, now, in_domain)
      return
    end if
    call read_plain_crank(self, t, y, now%motion)
    call self%place_pins(n, joints, y, now, in_domain)
    if (self%has_heat) call self%read_temperatures(n, joints, y, now, in_domain)
    if (.not. in_domain) return
    associate (bodies => self%chain%bodies, drive => self%chain%drive, motion => now%motion)
      call follow_rod(bodies%crank%length, bodies%per_rod_length, bodies%piston%axis_offset, motion, in_domain)
      if (.not. in_domain) return
      call self%find_loads(n, joints, y, now)
      if (allocated(self%gas)) call self%load_gas(y, now, in_domain)
      if (.not. in_domain) return
      if (n == 0) then
        call accelerate_ideal_chain(bodies, drive, motion, now%loads, now%accelerations, now%crank_moment)
      else if (.not. self%chain%is_loose(crank_pin)) then
        call accelerate_crank_rod(bodies, drive, now%loads, motion, now%accelerations, now%crank_moment)
      else
        call self%chain%accelerate_rigid(drive, motion, now%loads, now%accelerations, now%crank_moment)
      end if
      if (self%may_stick) then
        now%accelerations%rod_end = -now%accelerations%rod
        if (any(now%joint(:n)%sticks)) call hold_surfaces(self%chain, joints, motion, now%joint, now%loads, &
          now%accelerations, now%crank_moment, now%power)
      end if
      now%power = (now%crank_moment - drive%damping*motion%crank_speed)*motion%crank_speed + now%power
      if (.not. allocated(self%gas)) return
      call follow_piston(bodies%crank%length, bodies%rod%length, motion)
      now%power = now%power - now%loads%axial_force*motion%piston_velocity
    end associate
  end subroutine find_accelerations

  !> Set angle and speed of the crank.
  pure subroutine read_crank(self, t, y, motion)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(motion_t), intent(inout) :: motion
    if (self%runs_up .and. .not. self%crank_moves) then
      call turn_crank(motion, crank_angle(self, t, y), crank_speed(self, t, y))
      motion%held_acceleration = self%chain%varying%acceleration(t)
    else
      call read_plain_crank(self, t, y, motion)
    end if
  end subroutine read_crank

  !> The same without a run-up.
  pure subroutine read_plain_crank(self, t, y, motion)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(motion_t), intent(inout) :: motion
    if (self%crank_moves) then
      call turn_crank(motion, y(self%crank%position), y(self%crank%rate))
    else
      call turn_crank(motion, self%start_angle + self%start_speed*t, self%start_speed)
    end if
  end subroutine read_plain_crank

  !> Set the eccentricities of the joints, also in the motion of the chain. `in_domain` is false if one is not admissible.
  pure subroutine place_pins(self, n, joints, y, now, in_domain)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    real(dp), intent(in) :: y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: in_domain
    real(dp) :: offset(2), offset_rate(2)
    logical :: admitted
    integer :: i
    admitted = .true.
    offset = 0
    offset_rate = 0
    do i = 1, n
      associate (joint => joints(i), relative => now%joint(i))
        call joint%read_place(y, relative)
        admitted = admitted .and. joint%admits(y, relative)
        offset = offset + joint%site%sense*relative%eccentricity
        offset_rate = offset_rate + joint%site%sense*relative%eccentricity_rate
        if (joint%site%pin /= crank_pin) cycle
        now%motion%crank_pin = joint%site%sense*relative%eccentricity
        now%motion%crank_pin_rate = joint%site%sense*relative%eccentricity_rate
      end associate
    end do
    now%motion%offset = offset
    now%motion%offset_rate = offset_rate
    in_domain = admitted
  end subroutine place_pins

  !> Set the temperatures of the films of the joints. `in_domain` becomes false if one is not admissible.
  pure subroutine read_temperatures(self, n, joints, y, now, in_domain)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    real(dp), intent(in) :: y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(inout) :: in_domain
    integer :: i
    do i = 1, n
      if (.not. allocated(joints(i)%heat)) cycle
      call joints(i)%read_temperature(y, now%joint(i))
      in_domain = in_domain .and. joints(i)%admits_temperature(now%joint(i))
    end do
  end subroutine read_temperatures

  !> The loads and the power of the joints; the gas has none yet.
  pure subroutine find_loads(self, n, joints, y, now)
    class(scene_t), intent(in) :: self
    integer, intent(in) :: n
    type(clearance_joint_t), intent(in) :: joints(n)
    real(dp), intent(in) :: y(self%n)
    type(evaluation_t), intent(inout) :: now
    integer :: i
    now%power = 0
    do i = 1, n
      call joints(i)%loads(self%chain%bodies, now%motion, y, now%joint(i), now%loads)
      now%power = now%power + now%joint(i)%power
    end do
    now%loads%axial_force = 0
  end subroutine find_loads

  !> The load of the gas. `in_domain` becomes false if its pressure or its mass is not positive.
  pure subroutine load_gas(self, y, now, in_domain)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(inout) :: in_domain
    if (self%has_charge) then
      in_domain = self%gas%charge%admits(y)
      if (.not. in_domain) return
      call self%gas%find_charge(now%motion%crank_angle, now%motion%crank_speed, y, now%charge)
      now%cylinder_pressure = now%charge%pressure
    else
      now%cylinder_pressure = self%gas%pressure(now%motion%crank_angle)
    end if
    now%loads%axial_force = self%gas%force(now%cylinder_pressure)
  end subroutine load_gas

  !> Force of the joint at a spot on its pin [N]; at a place without joint that on the pin of its ideal pin.
  pure function pin_force(self, now, spot) result(force)
    class(scene_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    integer, intent(in) :: spot
    real(dp) :: force(2)
    if (self%joint_at(spot) > 0) then
      force = now%joint(self%joint_at(spot))%force
    else
      force = now%loads%force(:, places(spot)%pin)
    end if
  end function pin_force

  !> Integrals of the magnitudes of the forces on the pins so far [N s], in a scene that computes them; 0 at spots without results.
  pure function force_integrals(self, y) result(integrals)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp) :: integrals(n_spots)
    integrals = 0
    if (self%measures%last < self%measures%first) return
    integrals(self%reported) = y(self%measures%first:self%measures%first + size(self%reported) - 1)
  end function force_integrals

  !> Energy that the joints have taken from the bodies so far [J], in a scene that computes it. If it is not integrated itself, it
  !> is the work of the driving torque minus the work of all forces.
  pure real(dp) function joint_loss(self, t, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    joint_loss = 0
    if (self%n_joints == 0 .or. self%measures%last < self%measures%first) return
    if (self%measures_loss) then
      joint_loss = y(self%measures%last)
    else
      joint_loss = self%work_of_torque(t, y) - self%work(y)
    end if
  end function joint_loss

  !> Integrals of the gas so far, see `totals` of `charge_t`; 0 where its pressure and mass are no states.
  pure function charge_totals(self, t, y) result(totals)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp) :: totals(n_charge_sums)
    totals = 0
    if (self%has_charge) totals = self%gas%charge_totals(self%crank_angle(t, y), y)
  end function charge_totals

  !> Error of the energy of the gas so far, relative; negative where there is none to know.
  pure real(dp) function charge_residual(self, t, y) result(residual)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    residual = -1
    if (self%has_charge) residual = self%gas%charge_residual(self%crank_angle(t, y), y)
  end function charge_residual

  !> Whether the force of a film has no bound near this state.
  pure logical function is_singular(self, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    integer :: i
    is_singular = .false.
    do i = 1, size(self%joints)
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

  !> Number of revolutions after which the gas pressure, or the given load of a bearing, repeats; else 1.
  pure integer function forced_revolutions(self) result(revolutions)
    class(scene_t), intent(in) :: self
    revolutions = 1
    if (allocated(self%gas)) revolutions = self%gas%revolutions
    if (allocated(self%given_load)) revolutions = self%given_load%revolutions()
  end function forced_revolutions

  !> Work of all non-conservative forces and the drive so far [J].
  pure real(dp) function work(self, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    work = y(self%work_at)
  end function work

  !> Work of a torque that is constant between the changes of an input [J].
  pure real(dp) function work_of_torque(self, t, y) result(work)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    work = self%chain%drive%torque*(self%crank_angle(t, y) - self%start_angle) + self%torque_work
  end function work_of_torque

  !> Natural size of the crank speed [rad/s]: the starting speed; from rest, one radian in the time simulated. If a run ends during
  !> its run-up, the largest speed that it reaches.
  pure real(dp) function speed_scale(self)
    class(scene_t), intent(in) :: self
    speed_scale = abs(self%start_speed)
    if (self%runs_up) then
      associate (drive => self%chain%varying)
        if (self%span < drive%ramp_time) speed_scale = max(abs(drive%first_speed), abs(drive%speed(self%span)))
      end associate
    end if
    if (.not. speed_scale > 0) speed_scale = 1/self%span
  end function speed_scale

  !> Kinetic and potential energy of the bodies, with that of elastic parts [J].
  pure real(dp) function energy(self, now)
    class(scene_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    energy = self%chain%energy(now%motion)
    if (.not. allocated(self%guide)) return
    if (self%guide%filmed > 0) energy = energy + now%guide%spring_energy
  end function energy

  !> Natural size of the energy [J]: the kinetic energy at the speed scale, the potential energy of a lift by the crank length, and
  !> the energy of rod and piston at the natural speeds of the joints.
  pure real(dp) function energy_scale(self)
    class(scene_t), intent(in) :: self
    integer :: i
    associate (b => self%chain%bodies)
      energy_scale = 0.5_dp*(b%crank_term + b%piston%mass*b%crank%length**2)*self%speed_scale()**2 &
        + (b%crank%mass + b%rod%mass + b%piston%mass)*norm2(b%gravity)*b%crank%length
      if (self%chain%has_crankshaft()) energy_scale = energy_scale &
        + 0.5_dp*self%chain%elastic%crankshaft%flywheel_inertia*self%speed_scale()**2
      if (allocated(self%chain%train)) energy_scale = energy_scale + self%chain%train%energy_scale(self%speed_scale())
      do i = 1, self%n_joints
        energy_scale = energy_scale + 0.5_dp*(b%rod%mass + b%piston%mass)*self%joints(i)%own_speed(self%span)**2
      end do
      if (allocated(self%guide)) &
        energy_scale = energy_scale + 0.5_dp*(b%rod%mass + b%piston%mass)*self%guide%own_speed(self%span)**2
    end associate
  end function energy_scale
end module scene_problem
