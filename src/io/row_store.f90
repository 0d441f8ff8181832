!> A sink that stores rows and events in memory, and ends the run when the user interrupts.
module row_store
  use gudgeon_kinds, only: dp
  use trace_sink, only: trace_sink_t, trace_event_t
  use gudgeon_posix, only: interrupted
  implicit none
  private
  public :: row_store_t, take_store

  type, extends(trace_sink_t) :: row_store_t
    integer :: rows = 0, events = 0
    real(dp), allocatable :: values(:, :)           !! (columns, rows), larger than necessary
    type(trace_event_t), allocatable :: event(:)    !! larger than necessary
  contains
    procedure :: take_row
    procedure :: take_event
    procedure :: take_progress
  end type row_store_t

contains

  !> Take the rows and events from a sink of this type, without the unused memory.
  subroutine take_store(sink, columns, values, event)
    class(trace_sink_t), allocatable, intent(inout) :: sink
    integer, intent(in) :: columns                               !! number of columns
    real(dp), allocatable, intent(out) :: values(:, :)           !! (columns, rows)
    type(trace_event_t), allocatable, intent(out) :: event(:)
    allocate (values(columns, 0), event(0))
    select type (sink)
    class is (row_store_t)
      if (allocated(sink%values)) values = sink%values(:, :sink%rows)
      if (allocated(sink%event)) event = sink%event(:sink%events)
    end select
    deallocate (sink)
  end subroutine take_store

  subroutine take_row(self, values)
    class(row_store_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
    real(dp), allocatable :: larger(:, :)
    if (.not. allocated(self%values)) allocate (self%values(size(values), 1000))
    if (self%rows == size(self%values, 2)) then
      allocate (larger(size(values), 2*self%rows))
      larger(:, :self%rows) = self%values
      call move_alloc(larger, self%values)
    end if
    self%rows = self%rows + 1
    self%values(:, self%rows) = values
  end subroutine take_row

  subroutine take_event(self, event)
    class(row_store_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    type(trace_event_t), allocatable :: larger(:)
    if (.not. allocated(self%event)) allocate (self%event(100))
    if (self%events == size(self%event)) then
      allocate (larger(2*self%events))
      larger(:self%events) = self%event
      call move_alloc(larger, self%event)
    end if
    self%events = self%events + 1
    self%event(self%events) = event
  end subroutine take_event

  subroutine take_progress(self, time)
    class(row_store_t), intent(inout) :: self
    real(dp), intent(in) :: time
    associate (unused => time)
    end associate
    if (interrupted()) self%wants_to_stop = .true.
  end subroutine take_progress
end module row_store
