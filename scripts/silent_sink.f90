!> A sink that discards everything, for measuring the cost of a recorder.
module silent_sink
  use gudgeon_kinds, only: dp
  use trace_sink, only: trace_sink_t, trace_event_t
  implicit none
  private
  public :: silent_sink_t

  type, extends(trace_sink_t) :: silent_sink_t
    integer :: rows = 0
  contains
    procedure :: take_row
    procedure :: take_event
    procedure :: take_progress
  end type silent_sink_t

contains

  subroutine take_row(self, values)
    class(silent_sink_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
    associate (unused => values)
    end associate
    self%rows = self%rows + 1
  end subroutine take_row

  subroutine take_event(self, event)
    class(silent_sink_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    associate (unused_self => self, unused => event)
    end associate
  end subroutine take_event

  subroutine take_progress(self, time)
    class(silent_sink_t), intent(inout) :: self
    real(dp), intent(in) :: time
    associate (unused_self => self, unused => time)
    end associate
  end subroutine take_progress
end module silent_sink
