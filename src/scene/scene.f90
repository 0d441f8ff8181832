!> A scene: the mechanism with the models that its case asks for, as a system of differential equations.
!>
!> What is common to scenes with an ideal joint and with clearance: bodies, drive, gas, the layout of the state and the
!> one evaluation that feeds both the equations and the trace.
module scene
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use mechanism, only: mechanism_t, motion_t, accelerations_t
  use dynamics, only: drive_t, loads_t
  use clearance_joint, only: joint_motion_t
  use archive, only: archive_t
  use state_layout, only: layout_t, coordinates_t, slice_t
  use gas_cycle, only: gas_cycle_t, cycle_angle, n_parts
  implicit none
  private
  public :: scene_t, evaluation_t
  public :: phase_free, phase_film, phase_contact
  public :: event_none, event_contact_begins, event_contact_ends, n_gas_events

  !> What the pin is doing: the values of the column `phase`.
  integer, parameter :: phase_free = 0, phase_film = 1, phase_contact = 2

  !> Events that a trace tells of.
  integer, parameter :: event_none = 0, event_contact_begins = 1, event_contact_ends = 2

  !> Passages of the crank from one part of the gas cycle to the next: forwards, backwards. Where there is gas they are
  !> the last event functions of a scene.
  integer, parameter :: n_gas_events = 2

  !> Everything that one evaluation of a scene finds. Fields of models that the scene does not have are 0 in what `evaluate`
  !> gives; a right-hand side does not set what it does not need.
  type :: evaluation_t
    type(motion_t) :: motion
    type(accelerations_t) :: accelerations
    type(loads_t) :: loads
    type(joint_motion_t) :: joint
    real(dp) :: crank_moment        !! moment of the drive on the crank [N m]
    real(dp) :: normal_force        !! of the contact, pressing [N]
    real(dp) :: friction_force      !! on the pin along t [N]
    real(dp) :: cylinder_pressure   !! [Pa]
    real(dp) :: power               !! of all non-conservative forces and the drive [W]
  end type evaluation_t

  !> A scene as an ode_problem. Of the state it claims the crank angle, unless the crank speed is held, and as quadratures
  !> the work of all non-conservative forces and the drive [J] and, where somebody asks for them, the measures of the joint: the
  !> integral of the size of its force [N s] and, where the work does not tell it, what it takes from the bodies [J].
  type, abstract, extends(ode_problem_t) :: scene_t
    type(mechanism_t) :: mechanism
    type(drive_t) :: drive
    real(dp) :: start_angle = 0     !! crank angle at t = 0 [rad]
    real(dp) :: start_speed = 0     !! crank speed at t = 0, and always if it is held [rad/s]
    integer :: phase = phase_free
    real(dp) :: span = 1            !! of the simulation [s]
    real(dp) :: pin_speed = 0       !! natural size of the pin's speed in its bearing, where the crank does not give it [m/s]
    type(layout_t) :: layout        !! of the state
    type(coordinates_t) :: crank    !! where the crank angle stands in it
    integer :: work_at = 0          !! where the work of the forces stands
    type(slice_t) :: measures       !! quadratures of the joint
    type(gas_cycle_t), allocatable :: gas
    integer :: gas_part = 0            !! part of the gas cycle that acts
    real(dp) :: gas_cycle_start = 0    !! crank angle at which its cycle began [rad]
  contains
    procedure(evaluate), deferred :: evaluate
    procedure(initial_state), deferred :: initial_state
    procedure(claim), deferred :: claim
    procedure(reported_event), deferred :: reported_event
    procedure :: prepare_start
    procedure :: is_singular
    procedure :: has_clearance
    procedure :: find_pin
    procedure :: crank_angle
    procedure :: work
    procedure :: measure_joint
    procedure :: joint_loss
    procedure :: claim_crank
    procedure :: claim_work
    procedure :: claim_measures
    procedure, private :: take_layout
    procedure :: energy
    procedure :: energy_scale
    procedure :: speed_scale
    procedure :: set_gas_part
    procedure, non_overridable :: add_gas
    procedure :: gas_force_slope
    procedure :: gas_events
    procedure :: pass_gas_bound
    procedure, non_overridable :: exchange_phase
    procedure :: exchange => exchange_phase
  end type scene_t

  abstract interface
    !> Everything at (t, y). `inside` is false where a model is not defined: then there are only the crank angle and the joint
    !> without its sliding speed.
    pure subroutine evaluate(self, t, y, evaluation, inside)
      import :: scene_t, evaluation_t, dp
      class(scene_t), intent(in) :: self
      real(dp), intent(in) :: t, y(self%n)
      type(evaluation_t), intent(out) :: evaluation
      logical, intent(out) :: inside
    end subroutine evaluate

    !> State at t = 0.
    pure function initial_state(self) result(y)
      import :: scene_t, dp
      class(scene_t), intent(in) :: self
      real(dp) :: y(self%n)
    end function initial_state

    !> Claim the components of the state, when all else is set.
    subroutine claim(self)
      import :: scene_t
      class(scene_t), intent(inout) :: self
    end subroutine claim

    !> Which event of the trace event `index` of the integrator is.
    pure integer function reported_event(self, index)
      import :: scene_t
      class(scene_t), intent(in) :: self
      integer, intent(in) :: index
    end function reported_event
  end interface

contains

  !> Whether the forces of the present phase have no bound next to this state. The default is a scene that has none such.
  pure logical function is_singular(self, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    associate (unused_self => self, unused_y => y)
    end associate
    is_singular = .false.
  end function is_singular

  !> Whether the pin has play in its bearing. The default is that it has none.
  pure logical function has_clearance(self)
    class(scene_t), intent(in) :: self
    associate (unused_self => self)
    end associate
    has_clearance = .false.
  end function has_clearance

  !> Where the pin is in its bearing at (t, y), without its sliding speed, and the normal force of the contact [N]: what takes no
  !> evaluation of the scene. The default is a pin in the centre.
  pure subroutine find_pin(self, t, y, joint, normal_force)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    type(joint_motion_t), intent(out) :: joint
    real(dp), intent(out) :: normal_force
    associate (unused_self => self, unused_t => t, unused_y => y)
    end associate
    joint = joint_motion_t([0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], [1.0_dp, 0.0_dp], 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp)
    normal_force = 0
  end subroutine find_pin

  !> Find the discrete state at t = 0 when all else is set. The default has nothing to find.
  subroutine prepare_start(self)
    class(scene_t), intent(inout) :: self
    associate (unused_self => self)
    end associate
  end subroutine prepare_start

  !> The discrete state that every scene has, to or from an archive.
  subroutine exchange_phase(self, archive)
    class(scene_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call self%exchange_mode(archive)
    call archive%exchange(self%phase)
    call archive%exchange(self%gas_part)
    call archive%exchange(self%gas_cycle_start)
  end subroutine exchange_phase

  !> Crank angle at (t, y) [rad].
  pure real(dp) function crank_angle(self, t, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    if (self%drive%free_crank) then
      crank_angle = y(self%crank%position)
    else
      crank_angle = self%start_angle + self%start_speed*t
    end if
  end function crank_angle

  !> Work of all non-conservative forces and the drive so far [J].
  pure real(dp) function work(self, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    work = y(self%work_at)
  end function work

  !> Integrate the measures of the joint too; before the run. They do not change its steps where the joint has clearance. One
  !> without has one measure, the integral of the force's size.
  subroutine measure_joint(self)
    class(scene_t), intent(inout) :: self
    ! the measured force has part in the error control: nothing else here makes steps short enough for it
    call self%claim_measures(1, self%energy_scale(self%span)/(self%mechanism%crank_length*self%speed_scale(self%span)))
  end subroutine measure_joint

  !> Energy that the joint has taken from the bodies, in a scene that measures it [J]: none without clearance.
  pure real(dp) function joint_loss(self, t, y)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    associate (unused_self => self, unused_t => t, unused_y => y)
    end associate
    joint_loss = 0
  end function joint_loss

  !> The crank angle, where it is an unknown. It is the first owner's, before those of the joint.
  subroutine claim_crank(self)
    class(scene_t), intent(inout) :: self
    if (self%drive%free_crank) &
      call self%layout%claim_positions(1, 1.0_dp, self%speed_scale(self%span), self%crank, grows=.true.)
  end subroutine claim_crank

  !> The work of the forces, after all positions.
  subroutine claim_work(self)
    class(scene_t), intent(inout) :: self
    type(slice_t) :: at
    call self%layout%settle(self%crank)
    call self%layout%claim_quadratures(1, self%energy_scale(self%span), at)
    call self%layout%settle(at)
    self%work_at = at%first
    call self%take_layout()
  end subroutine claim_work

  !> So many measures of the joint, each of this natural size, after all else.
  subroutine claim_measures(self, n_measures, scale)
    class(scene_t), intent(inout) :: self
    integer, intent(in) :: n_measures
    real(dp), intent(in) :: scale
    call self%layout%claim_quadratures(n_measures, scale, self%measures)
    call self%layout%settle(self%measures)
    call self%take_layout()
  end subroutine claim_measures

  !> What the integrator needs to know of the layout.
  subroutine take_layout(self)
    class(scene_t), intent(inout) :: self
    self%n = self%layout%n()
    self%n_positions = self%layout%n_positions
    self%n_quadratures = self%layout%n_quadratures
  end subroutine take_layout

  !> Kinetic and potential energy of the bodies [J].
  pure real(dp) function energy(self, motion)
    class(scene_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    energy = self%mechanism%kinetic_energy(motion) + self%mechanism%potential_energy(motion)
  end function energy

  !> Size of the crank speed [rad/s]: the start speed; from rest, one radian in the time simulated.
  pure real(dp) function speed_scale(self, span)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: span
    speed_scale = abs(self%start_speed)
    if (.not. speed_scale > 0) speed_scale = 1/span
  end function speed_scale

  !> Size of the energy [J]: the bodies at the speed scale, the weights lifted by a crank length, and rod and piston at the pin's
  !> own speed.
  pure real(dp) function energy_scale(self, span)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: span
    associate (m => self%mechanism)
      energy_scale = 0.5_dp*(m%crank_term + m%piston_mass*m%crank_length**2)*self%speed_scale(span)**2 &
        + (m%crank_mass + m%rod_mass + m%piston_mass)*m%gravity*m%crank_length &
        + 0.5_dp*(m%rod_mass + m%piston_mass)*self%pin_speed**2
    end associate
  end function energy_scale

  !> Find the part of the gas cycle that the crank is in, or about to enter.
  subroutine set_gas_part(self, crank_angle, crank_speed)
    class(scene_t), intent(inout) :: self
    real(dp), intent(in) :: crank_angle, crank_speed
    call self%gas%part_at(crank_angle, crank_speed < 0, self%gas_part, self%gas_cycle_start)
  end subroutine set_gas_part

  !> Pressure and force of the gas at a crank angle [rad], in a scene with gas.
  pure subroutine add_gas(self, crank_angle, now)
    class(scene_t), intent(in) :: self
    real(dp), value, intent(in) :: crank_angle
    type(evaluation_t), intent(inout) :: now
    now%cylinder_pressure = self%gas%pressure(crank_angle, self%gas_part, self%gas_cycle_start)
    now%loads%gas_force = self%gas%gas_force(now%cylinder_pressure)
  end subroutine add_gas

  !> Derivative of the gas force by the crank angle [N/rad].
  pure real(dp) function gas_force_slope(self, crank_angle)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle
    gas_force_slope = self%gas%cylinder%area*self%gas%pressure_slope(crank_angle, self%gas_part, self%gas_cycle_start)
  end function gas_force_slope

  !> Event functions of the bounds of the present part of the gas cycle, over the crank angle.
  pure subroutine gas_events(self, crank_angle, crank_speed, g, g_rate)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, crank_speed
    real(dp), intent(out) :: g(n_gas_events), g_rate(n_gas_events)
    real(dp) :: angle
    angle = crank_angle - self%gas_cycle_start
    g = [angle - self%gas%bound(self%gas_part), self%gas%bound(self%gas_part - 1) - angle]
    g_rate = [crank_speed, -crank_speed]
  end subroutine gas_events

  !> Enter the next part of the gas cycle that is not empty, forwards (1) or backwards (2).
  subroutine pass_gas_bound(self, direction)
    class(scene_t), intent(inout) :: self
    integer, intent(in) :: direction
    integer :: way
    way = merge(1, -1, direction == 1)
    do
      self%gas_part = self%gas_part + way
      if (self%gas_part > n_parts .or. self%gas_part < 1) then
        self%gas_part = merge(1, n_parts, way > 0)
        self%gas_cycle_start = self%gas_cycle_start + way*cycle_angle
      end if
      if (self%gas%bound(self%gas_part) > self%gas%bound(self%gas_part - 1)) exit
    end do
  end subroutine pass_gas_bound
end module scene
