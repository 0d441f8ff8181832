!> A sink that stores rows and events in memory.
module row_store
  use kinds, only: dp
  use trace_sink, only: trace_sink_t, trace_event_t
  implicit none
  private
  public :: row_store_t

  type, extends(trace_sink_t) :: row_store_t
    integer :: rows = 0, events = 0
    real(dp), allocatable :: values(:, :)           !! (columns, rows), larger than necessary
    type(trace_event_t), allocatable :: event(:)    !! larger than necessary
  contains
    procedure :: hand_over
    procedure :: accept_row
    procedure :: accept_event
  end type row_store_t

contains

  !> The rows and events without the unused memory.
  subroutine hand_over(self, columns, values, event)
    class(row_store_t), intent(in) :: self
    integer, intent(in) :: columns                               !! number of columns
    real(dp), allocatable, intent(out) :: values(:, :)           !! (columns, rows)
    type(trace_event_t), allocatable, intent(out) :: event(:)
    allocate (values(columns, 0), event(0))
    if (allocated(self%values)) values = self%values(:, :self%rows)
    if (allocated(self%event)) event = self%event(:self%events)
  end subroutine hand_over

  subroutine accept_row(self, values)
    class(row_store_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
    if (.not. allocated(self%values)) allocate (self%values(size(values), 1000))
    if (self%rows == size(self%values, 2)) self%values = reshape(self%values, [size(values), 2*self%rows], pad=[0.0_dp])
    self%rows = self%rows + 1
    self%values(:, self%rows) = values
  end subroutine accept_row

  subroutine accept_event(self, event)
    class(row_store_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    if (.not. allocated(self%event)) allocate (self%event(100))
    if (self%events == size(self%event)) self%event = [self%event, self%event]   ! more room
    self%events = self%events + 1
    self%event(self%events) = event
  end subroutine accept_event
end module row_store
