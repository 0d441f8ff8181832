!> Where a run puts what it finds: implemented by whoever writes files, or by tests.
module trace_sink
  use kinds, only: dp
  implicit none
  private
  public :: trace_sink_t, trace_event_t

  !> One event of the trace.
  type :: trace_event_t
    integer :: kind = 0                    !! event_contact_begins or event_contact_ends
    real(dp) :: time = 0                   !! [s]
    real(dp) :: crank_angle = 0            !! [rad]
    real(dp) :: normal_speed = 0           !! d|e|/dt [m/s]
    real(dp) :: duration = 0               !! of the contact that ends [s]
    real(dp) :: max_penetration = 0        !! in it [m]
    real(dp) :: max_normal_force = 0       !! in it [N]
  end type trace_event_t

  !> Takes rows and events as they come.
  type, abstract :: trace_sink_t
    logical :: wants_to_stop = .false.   !! set where the run should end (interrupted, cannot write)
  contains
    procedure(take_row), deferred :: take_row
    procedure(take_event), deferred :: take_event
    procedure(take_progress), deferred :: take_progress
  end type trace_sink_t

  abstract interface
    !> One row of the trace, in the order of its columns.
    subroutine take_row(self, values)
      import :: trace_sink_t, dp
      class(trace_sink_t), intent(inout) :: self
      real(dp), intent(in) :: values(:)
    end subroutine take_row

    subroutine take_event(self, event)
      import :: trace_sink_t, trace_event_t
      class(trace_sink_t), intent(inout) :: self
      type(trace_event_t), intent(in) :: event
    end subroutine take_event

    !> Called now and then with the time simulated so far [s].
    subroutine take_progress(self, time)
      import :: trace_sink_t, dp
      class(trace_sink_t), intent(inout) :: self
      real(dp), intent(in) :: time
    end subroutine take_progress
  end interface
end module trace_sink
