!> The files of a running case: NAME.csv, row by row, and NAME.events.csv.
!>
!> Cases run side by side in threads, and gfortran keeps the length of a deferred-length function result in static
!> storage: what runs during a case makes its text by subroutines, or inside the critical section `texts`.
module trace_files
  use kinds, only: dp
  use errors, only: error_t
  use columns, only: column_list_t, column_name
  use scene, only: event_contact_begins
  use trace_sink, only: trace_sink_t, trace_event_t
  use result_file, only: result_file_t
  use number_writer, only: number_writer_t, longest_number
  use progress, only: progress_t
  use posix, only: interrupted
  implicit none
  private
  public :: trace_files_t

  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: least_fields = 8   !! room in a line for an event

  !> A sink that writes. It asks for the end of the run when the user interrupts it or a file cannot be written.
  type, extends(trace_sink_t) :: trace_files_t
    type(result_file_t) :: trace
    type(result_file_t) :: event_list
    type(progress_t) :: progress
    real(dp) :: end_time = 1            !! of the run, for the progress [s]
    type(number_writer_t), private :: numbers
    integer, private :: phase_column = 0
    integer, private :: rows = 0
    character(len=:), allocatable, private :: line   !! the row being written
  contains
    procedure :: open
    procedure :: close
    procedure :: take_row
    procedure :: take_event
    procedure :: take_progress
  end type trace_files_t

contains

  !> Begin PATH.csv and, with events, PATH.events.csv, of numbers with so many significant digits.
  subroutine open(self, path, list, digits, with_events, error)
    class(trace_files_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: digits
    logical, intent(in) :: with_events
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: header
    integer :: i

    call self%trace%open(path//'.csv', error)
    if (allocated(error)) return
    header = ''
    do i = 1, size(list%id)
      if (i > 1) header = header//','
      header = header//column_name(list, i)
      if (column_name(list, i) == 'phase[-]') self%phase_column = i
    end do
    call self%trace%put(header//newline)
    call self%numbers%prepare(digits)
    allocate (character(len=(longest_number + 1)*max(size(list%id), least_fields)) :: self%line)
    if (.not. with_events) return
    call self%event_list%open(path//'.events.csv', error)
    if (allocated(error)) then
      call self%trace%abandon()
      return
    end if
    call self%event_list%put('time[s],crank_angle[rad],event,normal_speed[m/s],duration[s],max_penetration[m],'// &
      'max_normal_force[N]'//newline)
  end subroutine open

  !> Give both files their final names. The first error is told.
  subroutine close(self, error)
    class(trace_files_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: second
    call self%progress%finish()
    call self%trace%close(error)
    call self%event_list%close(second)
    if (.not. allocated(error)) call move_alloc(second, error)
  end subroutine close

  subroutine take_row(self, values)
    class(trace_files_t), intent(inout) :: self
    real(dp), intent(in) :: values(:)
    integer, parameter :: rows_between_looks = 100
    integer :: i, used

    used = 0
    do i = 1, size(values)
      if (i > 1) call append(self%line, used, ',')
      if (i == self%phase_column) then
        call append(self%line, used, achar(iachar('0') + nint(values(i))))
      else
        call self%numbers%append(self%line, used, values(i))
      end if
    end do
    call append(self%line, used, newline)
    call self%trace%put(self%line(:used))
    self%rows = self%rows + 1
    if (mod(self%rows, rows_between_looks) == 0) call look(self)
  end subroutine take_row

  subroutine take_event(self, event)
    class(trace_files_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    integer :: used

    used = 0
    call self%numbers%append(self%line, used, event%time)
    call append(self%line, used, ',')
    call self%numbers%append(self%line, used, event%crank_angle)
    call append(self%line, used, merge(',contact_begins,', ',contact_ends,  ', event%kind == event_contact_begins))
    if (event%kind /= event_contact_begins) used = used - 2   ! the blanks that merge needs
    call self%numbers%append(self%line, used, event%normal_speed)
    if (event%kind == event_contact_begins) then
      call append(self%line, used, ',,,')
    else
      call append(self%line, used, ',')
      call self%numbers%append(self%line, used, event%duration)
      call append(self%line, used, ',')
      call self%numbers%append(self%line, used, event%max_penetration)
      call append(self%line, used, ',')
      call self%numbers%append(self%line, used, event%max_normal_force)
    end if
    call append(self%line, used, newline)
    call self%event_list%put(self%line(:used))
  end subroutine take_event

  !> Append a text to the first `used` characters of a line.
  pure subroutine append(line, used, text)
    character(len=*), intent(inout) :: line
    integer, intent(inout) :: used
    character(len=*), intent(in) :: text
    line(used + 1:used + len(text)) = text
    used = used + len(text)
  end subroutine append

  subroutine take_progress(self, time)
    class(trace_files_t), intent(inout) :: self
    real(dp), intent(in) :: time
    !$omp critical (texts)
    call self%progress%update(time/self%end_time, time)
    !$omp end critical (texts)
    call look(self)
  end subroutine take_progress

  !> Whether there is a reason to stop.
  subroutine look(self)
    class(trace_files_t), intent(inout) :: self
    if (interrupted() .or. self%trace%has_failed() .or. self%event_list%has_failed()) self%wants_to_stop = .true.
  end subroutine look
end module trace_files
