!> Writes the result files of a running case: NAME.csv, row by row, and NAME.events.csv.
module trace_files
  use kinds, only: dp
  use error_handling, only: error_t, keep_first
  use trace_columns, only: column_list_t, column_name
  use scene_problem, only: event_contact_begins
  use trace_sink, only: trace_sink_t, trace_event_t, joint_names
  use result_file, only: result_file_t
  use row_text, only: row_text_t
  use number_text, only: number_writer_t, longest_number
  implicit none
  private
  public :: trace_files_t

  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: trace = 1, event_list = 2   !! indices of the files
  character(len=*), parameter :: suffixes(2) = [character(len=11) :: '.csv', '.events.csv']

  !> A sink that writes files. Failures are reported by `has_failed` of the files, and by `close`.
  type, extends(trace_sink_t) :: trace_files_t
    type(result_file_t) :: file(2)      !! trace and list of events; a file that was not opened stays without effect
    type(number_writer_t), private :: numbers
    integer, private :: phase_column = 1   !! index of the phase's column; the last index plus one if there is none
    type(row_text_t), private :: event   !! row of the last event
  contains
    procedure :: open
    procedure :: tell_error
    procedure :: close
    procedure :: accept_row
    procedure :: accept_event
  end type trace_files_t

contains

  !> Begin PATH.csv and, with events, PATH.events.csv; numbers have `digits` significant digits.
  subroutine open(self, path, list, digits, with_events, error)
    class(trace_files_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: digits
    logical, intent(in) :: with_events
    type(error_t), allocatable, intent(out) :: error
    integer :: i

    self%phase_column = findloc([list%names(list%id) == 'phase[-]', .true.], .true., 1)
    call self%numbers%prepare(digits)
    call self%file(trace)%open(path//trim(suffixes(trace)), error)
    if (allocated(error)) return
    do i = 1, size(list%id)
      if (i > 1) call self%file(trace)%append(',')
      call self%file(trace)%append(column_name(list, i))
    end do
    call self%file(trace)%append(newline)
    if (.not. with_events) return
    call self%file(event_list)%open(path//suffixes(event_list), error)
    if (allocated(error)) then
      call self%file(trace)%abandon()
      return
    end if
    call self%file(event_list)%append('time[s],crank_angle[rad],event,normal_speed[m/s],duration[s],max_penetration[m],'// &
      'max_normal_force[N],joint'//newline)
  end subroutine open

  !> The reason why one of the files could not be written, if so.
  subroutine tell_error(self, error)
    class(trace_files_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error
    call self%file(trace)%tell_error(error)
    if (.not. allocated(error)) call self%file(event_list)%tell_error(error)
  end subroutine tell_error

  !> Conclude both files unless that has been done. The first error is reported.
  subroutine close(self, error)
    class(trace_files_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: second
    call self%file(trace)%close(error)
    call self%file(event_list)%close(second)
    call keep_first(second, error)
  end subroutine close

  subroutine accept_row(self, values)
    class(trace_files_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
    call write_row(self%numbers, self%phase_column, values, self%file(trace))
  end subroutine accept_row

  !> Add a row to a file, written directly into its buffer; the phase is one digit.
  subroutine write_row(numbers, phase, values, file)
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: phase   !! index of the phase's column
    real(dp), intent(in), contiguous :: values(:)
    type(result_file_t), intent(inout) :: file
    call file%require_space((longest_number + 1)*size(values))
    associate (text => file%buffer, used => file%used)
      call numbers%append_list(text, used, values(:phase - 1))
      if (phase <= size(values)) then
        text(used + 1:used + 2) = achar(iachar('0') + int(values(phase)))//','
        used = used + 2
        call numbers%append_list(text, used, values(phase + 1:))
      end if
      text(used:used) = achar(10)
    end associate
  end subroutine write_row

  subroutine accept_event(self, event)
    class(trace_files_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    associate (row => self%event, numbers => self%numbers, has_ended => event%kind /= event_contact_begins)
      call row%clear()
      call row%add_number(numbers, event%time)
      call row%add_number(numbers, event%crank_angle)
      call row%add_text(merge('contact_ends  ', 'contact_begins', has_ended))
      call row%add_number(numbers, event%normal_speed)
      call row%add_number(numbers, event%duration, has_ended)
      call row%add_number(numbers, event%max_penetration, has_ended)
      call row%add_number(numbers, event%max_normal_force, has_ended)
      call row%add_text(joint_names(event%pin))
      call row%end_row()
      call self%file(event_list)%append(row%text(:row%used))
    end associate
  end subroutine accept_event
end module trace_files
