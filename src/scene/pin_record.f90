!> Records what happens at one pin: its contacts, its turning and its wear.
module pin_record
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use run_state, only: run_state_t
  use chain_motion, only: body_pin
  use joint_places, only: spot_prefix, name_prefix
  use machine_record, only: turning_point
  use scene_problem, only: scene_t, evaluation_t, phase_contact, event_contact_begins
  use result_ledger, only: ledger_t
  use joint_events, only: may_touch
  use cycle_watch, only: cycle_watch_t
  use wear_record, only: wear_record_t
  use trace_sink, only: trace_event_t
  use run_figures, only: run_figures_t
  implicit none
  private
  public :: pin_record_t

  type :: pin_record_t
    integer :: pin = 0                         !! spot, see `joint_places`
    integer :: joint = 0                       !! index of the scene's joint at this pin; 0: the pin is ideal
    real(dp) :: validity_limit = huge(1.0_dp)  !! largest impact speed for which the contact law is valid [m/s]
    real(dp) :: deepest = huge(1.0_dp)         !! largest penetration for which the contact geometry is valid [m]
    type(trace_event_t), private :: contact    !! present or last contact
    logical, private :: floats = .false.       !! it is one end of a floating pin
    real(dp), private :: turn(3) = 0           !! time [s], angle [rad] and speed [rad/s] of the pin relative to its bearing there
    class(wear_record_t), allocatable :: wear  !! not allocated: wear is not counted (as a `type` it gets a false warning)
  contains
    procedure, non_overridable :: prepare
    procedure, non_overridable :: declare
    procedure, non_overridable :: count_from
    procedure, non_overridable :: follow_turn
    procedure, non_overridable :: follow
    procedure, non_overridable :: is_too_deep
    procedure, non_overridable :: record_contact
    procedure, non_overridable :: is_touching
  end type pin_record_t

contains

  !> Prepare the record of a pin of a scene.
  subroutine prepare(self, pin, scene)
    class(pin_record_t), intent(out) :: self
    integer, intent(in) :: pin   !! spot
    type(scene_t), intent(in) :: scene
    self%pin = pin
    self%joint = scene%joint_at(pin)
    self%contact%pin = pin
    if (self%joint == 0) return
    self%floats = scene%joints(self%joint)%site%pin_body == body_pin
    if (allocated(scene%joints(self%joint)%wear)) then
      allocate (self%wear)
      call self%wear%prepare(self%joint, scene)
    end if
    if (.not. may_touch(scene%joints(self%joint))) return
    associate (joint => scene%joints(self%joint))
      self%validity_limit = joint%slots(joint%acting(phase_contact))%element%fastest_impact
      self%deepest = joint%slots(joint%acting(phase_contact))%element%deepest
    end associate
  end subroutine prepare

  !> Declare the totals of the pin, and with them the worn shape of its bore.
  subroutine declare(self, list, figures, scene)
    class(pin_record_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(run_figures_t), intent(inout) :: figures
    type(scene_t), intent(inout) :: scene
    logical :: touches
    touches = .false.
    if (self%joint > 0) touches = may_touch(scene%joints(self%joint))
    if (touches) call figures%pin(self%pin)%declare(name_prefix(self%pin), list)
    if (touches) call self%contact%declare(list)
    if (self%floats) then
      associate (f => figures%pin(self%pin))
        call list%add(name_prefix(self%pin)//'turning', f%turning, 'rad', &
          'angle that the pin has turned through in this bearing')
      end associate
    end if
    if (allocated(self%wear)) call self%wear%declare(name_prefix(self%pin), list, scene%joints(self%joint))
  end subroutine declare

  !> Count what is integrated from a time [s].
  pure subroutine count_from(self, t)
    class(pin_record_t), intent(inout) :: self
    real(dp), intent(in) :: t
    if (allocated(self%wear)) self%wear%time = t
  end subroutine count_from

  !> Whether the joint at the pin is in contact.
  pure logical function is_touching(self, scene)
    class(pin_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    is_touching = .false.
    if (self%joint > 0) is_touching = scene%joints(self%joint)%phase == phase_contact
  end function is_touching

  !> Follow the pin from the last point recorded (or the beginning of a step after an event) to t, where the scene is evaluated.
  subroutine follow(self, method, scene, t, now, is_end, figures, cycles)
    class(pin_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: is_end   !! t is the end of the step, or of its final part; else that of a revolution inside it
    type(run_figures_t), intent(inout) :: figures
    type(cycle_watch_t), intent(inout), optional :: cycles
    real(dp) :: angle
    integer :: before
    associate (f => figures%pin(self%pin))
      if (self%is_touching(scene)) f%longest_contact = max(f%longest_contact, t - self%contact%time)
      if (self%floats .or. present(cycles) .and. self%joint > 0) then
        call follow_turn(self, scene, t, now, angle, cycles)
        f%turning = f%turning + angle
      end if
    end associate
    if (.not. allocated(self%wear)) return
    before = self%wear%evaluations
    if (is_end) then
      call self%wear%follow(method, scene, t)
    else
      call self%wear%look_ahead(method, scene, t)
    end if
    figures%evaluations = figures%evaluations + (self%wear%evaluations - before)
  end subroutine follow

  !> Whether the present or last contact is deeper than the contact geometry is valid for.
  pure logical function is_too_deep(self, ledger)
    class(pin_record_t), intent(in) :: self
    type(ledger_t), intent(in) :: ledger
    real(dp) :: penetration, force
    call ledger%find_contact(spot_prefix(self%pin), penetration, force)
    is_too_deep = penetration > self%deepest
  end function is_too_deep

  !> The angle that the pin turns through in its bearing since the last call, in either sense [rad]; it is added to the present
  !> revolution.
  subroutine follow_turn(self, scene, t, now, angle, cycles)
    class(pin_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    real(dp), intent(out) :: angle
    type(cycle_watch_t), intent(inout), optional :: cycles
    real(dp) :: turn(3), angles(2), span, rise, farthest
    associate (it => now%joint(self%joint))
      angles = scene%turned(now, self%joint)
      turn = [t, angles(1) - angles(2), it%pin_angular_speed - it%bearing_speed]
    end associate
    span = turn(1) - self%turn(1)
    rise = turn(2) - self%turn(2)
    farthest = turning_point(span, rise, self%turn(3), turn(3))
    angle = 0
    if (span > 0) angle = abs(farthest) + abs(rise - farthest)
    if (present(cycles)) call cycles%record_turn(self%pin, angle)
    self%turn = turn
  end subroutine follow_turn

  !> A contact begins or ends at time t; `now` is evaluated before that event. `event` is its entry in the trace.
  subroutine record_contact(self, kind, scene, t, now, ledger, figures, event)
    class(pin_record_t), intent(inout) :: self
    integer, intent(in) :: kind
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(ledger_t), intent(inout) :: ledger
    type(run_figures_t), intent(inout) :: figures
    type(trace_event_t), intent(out) :: event

    associate (f => figures%pin(self%pin), relative => now%joint(self%joint))
      if (kind == event_contact_begins) then
        f%contacts = f%contacts + 1
        f%max_entry_penetration = max(f%max_entry_penetration, relative%penetration)
        if (relative%penetration_rate > self%validity_limit) f%impacts_beyond_validity = f%impacts_beyond_validity + 1
      end if
      call self%contact%change(kind, kind == event_contact_begins, t, now%motion%crank_angle, relative%penetration_rate)
      event = self%contact
      if (kind == event_contact_begins) then
        call ledger%begin_contact(spot_prefix(self%pin), scene, t, now)
      else
        if (self%is_too_deep(ledger)) f%contacts_beyond_validity = f%contacts_beyond_validity + 1
        call ledger%find_contact(spot_prefix(self%pin), event%max_penetration, event%max_normal_force)
        call ledger%end_contact(spot_prefix(self%pin))
      end if
    end associate
  end subroutine record_contact
end module pin_record
