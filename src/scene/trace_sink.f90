!> Receiver of the results of a run. The code that writes files and tests extend it by what they need of the results.
module trace_sink
  use kinds, only: dp
  use run_state, only: run_state_t
  use joint_places, only: piston_pin, places, n_places
  use piston_guide, only: corner_names, n_corners
  implicit none
  private
  public :: trace_sink_t, trace_event_t, joint_names

  !> Names of the places of contacts: the pins, and the corners of the skirt in the bore.
  character(len=*), parameter :: joint_names(n_places + n_corners) = [character(len=12) :: places%name, corner_names]

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
    procedure :: declare
  end type trace_event_t

  !> Accepts rows and events in the order of time. This type itself ignores them.
  type :: trace_sink_t
  contains
    procedure :: accept_row
    procedure :: accept_event
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
    else
      self%duration = time - self%time
    end if
    self%kind = kind
    self%time = time
    self%crank_angle = crank_angle
    self%normal_speed = normal_speed
  end subroutine change

  !> Declare when the present contact began.
  subroutine declare(self, list)
    class(trace_event_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    character(len=:), allocatable :: pre
    pre = trim(joint_names(self%pin))//'_'
    call list%add(pre//'contact_since', self%time, 's', 'beginning of the present contact, or end of the last one')
  end subroutine declare

  !> Accept one row of the trace, with values in the order of its columns.
  subroutine accept_row(self, values)
    class(trace_sink_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
  end subroutine accept_row

  subroutine accept_event(self, event)
    class(trace_sink_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
  end subroutine accept_event
end module trace_sink
