!> A sink that keeps rows, and the times at which contacts begin, in memory, and ends when the user interrupts.
module row_store
  use gudgeon_kinds, only: dp
  use trace_sink, only: trace_sink_t, trace_event_t
  use gudgeon_scene, only: event_contact_begins
  use gudgeon_posix, only: interrupted
  implicit none
  private
  public :: row_store_t

  type, extends(trace_sink_t) :: row_store_t
    integer :: rows = 0, impacts = 0
    real(dp), allocatable :: values(:, :)     !! (columns, rows)
    real(dp), allocatable :: impact_time(:)   !! [s]
    integer, allocatable :: impact_pin(:)
  contains
    procedure :: take_row
    procedure :: take_event
    procedure :: take_progress
  end type row_store_t

contains

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
    real(dp), allocatable :: times(:)
    integer, allocatable :: pins(:)
    if (event%kind /= event_contact_begins) return
    if (.not. allocated(self%impact_time)) allocate (self%impact_time(100), self%impact_pin(100))
    if (self%impacts == size(self%impact_time)) then
      allocate (times(2*self%impacts), pins(2*self%impacts))
      times(:self%impacts) = self%impact_time
      pins(:self%impacts) = self%impact_pin
      call move_alloc(times, self%impact_time)
      call move_alloc(pins, self%impact_pin)
    end if
    self%impacts = self%impacts + 1
    self%impact_time(self%impacts) = event%time
    self%impact_pin(self%impacts) = event%pin
  end subroutine take_event

  subroutine take_progress(self, time)
    class(row_store_t), intent(inout) :: self
    real(dp), intent(in) :: time
    associate (unused => time)
    end associate
    if (interrupted()) self%wants_to_stop = .true.
  end subroutine take_progress
end module row_store
