!> Receiver of the results of a run. The code that writes files and tests extend it by what they need of the results.
module trace_sink
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  use ode_method, only: step_statistics_t
  use chain_motion, only: piston_pin, pin_names, n_pins
  use piston_guide, only: corner_names, n_corners
  implicit none
  private
  public :: trace_sink_t, trace_event_t, joint_names

  !> Names of the places of contacts: the pins, and the corners of the skirt in the bore.
  character(len=*), parameter :: joint_names(n_pins + n_corners) = [character(len=10) :: pin_names, corner_names]

  !> One event in the trace.
  type :: trace_event_t
    integer :: kind = 0                    !! event_contact_begins or event_contact_ends
    real(dp) :: time = 0                   !! [s]
    real(dp) :: crank_angle = 0            !! [rad]
    real(dp) :: normal_speed = 0           !! d|e|/dt [m/s]
    real(dp) :: duration = 0               !! duration of the contact that ends [s]
    real(dp) :: max_penetration = 0        !! largest penetration during it [m]
    real(dp) :: max_normal_force = 0       !! largest normal force during it [N]
    integer :: pin = piston_pin            !! index of the place in `joint_names`
  contains
    procedure :: change
    procedure :: exchange
  end type trace_event_t

  !> Takes rows and events in the order of time. This type itself ignores them.
  type :: trace_sink_t
    logical :: wants_to_stop = .false.   !! set by the sink if the run should end (interrupted, or files cannot be written)
    logical :: wants_archive = .false.   !! set by the sink if it wants the state of the run
    logical :: keeps_archives = .false.  !! the sink also wants the state of the run if the run stops early
    real(dp) :: expected_end = 1         !! expected end of the run, set before `take_progress` is called [s]
  contains
    procedure :: take_row
    procedure :: take_event
    procedure :: take_progress
    procedure :: take_archive
    procedure :: take_cost
  end type trace_sink_t

contains

  !> A contact begins or ends at this place.
  pure subroutine change(self, kind, begins, time, crank_angle, normal_speed)
    class(trace_event_t), intent(inout) :: self   !! present or last contact of the place
    integer, intent(in) :: kind
    logical, intent(in) :: begins
    real(dp), intent(in) :: time, crank_angle, normal_speed
    if (begins) then
      self%duration = 0
      self%max_penetration = 0
      self%max_normal_force = 0
    else
      self%duration = time - self%time
    end if
    self%kind = kind
    self%time = time
    self%crank_angle = crank_angle
    self%normal_speed = normal_speed
  end subroutine change

  !> Write the event to an archive, or read it from it.
  subroutine exchange(self, archive)
    class(trace_event_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%kind)
    call archive%exchange(self%time, self%crank_angle, self%normal_speed, self%duration, self%max_penetration, &
      self%max_normal_force)
    call archive%exchange(self%pin)
  end subroutine exchange

  !> Take one row of the trace, with values in the order of its columns.
  subroutine take_row(self, values)
    class(trace_sink_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
    associate (unused_self => self, unused_values => values)
    end associate
  end subroutine take_row

  subroutine take_event(self, event)
    class(trace_sink_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    associate (unused_self => self, unused_event => event)
    end associate
  end subroutine take_event

  !> Called at intervals with the time simulated so far [s].
  subroutine take_progress(self, time)
    class(trace_sink_t), intent(inout) :: self
    real(dp), intent(in) :: time
    associate (unused_self => self, unused_time => time)
    end associate
  end subroutine take_progress

  !> Called at intervals while the steps of the Adams method were limited by stability for most of the time simulated so far.
  subroutine take_cost(self, time, statistics)
    class(trace_sink_t), intent(inout) :: self
    real(dp), intent(in) :: time                        !! simulated so far [s]
    type(step_statistics_t), intent(in) :: statistics   !! so far
    associate (unused_self => self, unused_time => time, unused_statistics => statistics)
    end associate
  end subroutine take_cost

  !> Take the state of the run after the rows and events taken so far.
  subroutine take_archive(self, archive)
    class(trace_sink_t), intent(inout) :: self
    type(archive_t), intent(in) :: archive
    associate (unused => archive)
    end associate
    self%wants_archive = .false.
  end subroutine take_archive
end module trace_sink
