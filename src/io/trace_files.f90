!> Writes the result files of a running case: NAME.csv, row by row, and NAME.events.csv.
!>
!> Cases run in several threads, and gfortran stores the length of a function result of deferred length in static memory. During a
!> case texts must therefore be made by subroutines, or inside the critical section `texts`.
module trace_files
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, keep_first, status_case_file, status_output
  use gudgeon_archive, only: archive_t
  use gudgeon_columns, only: column_list_t, column_name
  use gudgeon_scene, only: event_contact_begins
  use trace_sink, only: trace_sink_t, trace_event_t, joint_names
  use result_file, only: result_file_t
  use gudgeon_checkpoint, only: checkpoint_t, file_mark_t, restart_hint
  use row_text, only: row_text_t
  use number_text, only: number_writer_t, longest_number
  use gudgeon_progress, only: progress_t, clock
  use stability_advice, only: stability_advice_t
  use ode_method, only: step_statistics_t
  use gudgeon_posix, only: interrupted
  use text_tools, only: printable
  implicit none
  private
  public :: trace_files_t

  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: trace = 1, event_list = 2   !! indices of the files
  character(len=*), parameter :: suffixes(2) = [character(len=11) :: '.csv', '.events.csv']

  !> A sink that writes files. It asks for the end of the run if the user interrupts or a file cannot be written.
  type, extends(trace_sink_t) :: trace_files_t
    type(result_file_t) :: file(2)      !! trace and list of events; a file that was not opened stays without effect
    type(number_writer_t), private :: numbers
    integer, private :: phase_column = 1   !! index of the phase's column; the last index plus one if there is none
    type(progress_t) :: progress
    type(stability_advice_t) :: advice
    type(checkpoint_t) :: checkpoint    !! path, identity and case; the rest is set when it is written
    type(error_t), allocatable :: checkpoint_error        !! reason why the last checkpoint could not be written
    real(dp), private :: checkpoint_interval = 0          !! [s]
    real(dp), private :: earlier_time = 0                 !! wall time of earlier parts of the run [s]
    real(dp), private :: began = 0, saved = 0             !! times of `clock` [s]
    character(len=:), allocatable, private :: path        !! of the files, without suffix
    integer, private :: rows = 0
    type(row_text_t), private :: event   !! row of the last event
  contains
    procedure :: open
    procedure :: tell_error
    procedure :: close
    procedure :: take_row
    procedure :: take_event
    procedure :: take_progress
    procedure :: take_cost
    procedure :: keep_checkpoints
    procedure :: reopen
    procedure :: take_archive
    procedure :: wall_time
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

    call prepare(self, path, list, digits)
    call self%file(trace)%open(path//trim(suffixes(trace)), error)
    if (allocated(error)) return
    do i = 1, size(list%id)
      if (i > 1) call self%file(trace)%put(',')
      call self%file(trace)%put(column_name(list, i))
    end do
    call self%file(trace)%put(newline)
    if (.not. with_events) return
    call self%file(event_list)%open(path//suffixes(event_list), error)
    if (allocated(error)) then
      call self%file(trace)%abandon()
      return
    end if
    call self%file(event_list)%put('time[s],crank_angle[rad],event,normal_speed[m/s],duration[s],max_penetration[m],'// &
      'max_normal_force[N],joint'//newline)
  end subroutine open

  !> Prepare the table before the first row.
  subroutine prepare(self, path, list, digits)
    class(trace_files_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: digits
    self%path = path
    self%phase_column = findloc([list%names(list%id) == 'phase[-]', .true.], .true., 1)
    call self%numbers%prepare(digits)
    self%began = clock()
    self%saved = self%began
  end subroutine prepare

  !> Continue the files of a stopped run, truncated to their content at its checkpoint. Error: they do not contain that any more;
  !> nothing has been changed then.
  subroutine reopen(self, path, list, digits, with_events, checkpoint, error)
    class(trace_files_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: digits
    logical, intent(in) :: with_events
    type(checkpoint_t), intent(in) :: checkpoint
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    character(len=len(path) + 16) :: names(2)
    integer :: i, last
    last = merge(event_list, trace, with_events)
    call prepare(self, path, list, digits)
    do i = trace, last
      call find_marked(path//trim(suffixes(i)), checkpoint%mark(i), self%checkpoint%mark(i), name, error)
      if (allocated(error)) return
      names(i) = name
    end do
    self%earlier_time = checkpoint%wall_time
    do i = trace, last
      if (.not. allocated(error)) &
        call self%file(i)%reopen(path//trim(suffixes(i)), trim(names(i)), checkpoint%mark(i)%length, error)
    end do
  end subroutine reopen

  !> Find under which of its two names the file exists that begins with the marked content.
  subroutine find_marked(path, wanted, mark, name, error)
    character(len=*), intent(in) :: path
    type(file_mark_t), intent(in) :: wanted
    type(file_mark_t), intent(out) :: mark
    character(len=:), allocatable, intent(out) :: name
    type(error_t), allocatable, intent(out) :: error
    logical :: is_there
    integer :: i
    do i = 1, 2
      name = path
      if (i == 1) name = path//'.part'
      mark = file_mark_t()
      call mark%move_to(name, wanted%length, is_there)
      if (is_there .and. mark%checksum == wanted%checksum) return
    end do
    call fail(error, printable(path, 200)//': differs from what the stopped run had written'//restart_hint, status_case_file)
  end subroutine find_marked

  !> From now on write a checkpoint every `interval` seconds (0: never), and when the run stops before its end. Path, identity and
  !> case are those of `checkpoint`.
  subroutine keep_checkpoints(self, checkpoint, interval)
    class(trace_files_t), intent(inout) :: self
    type(checkpoint_t), intent(in) :: checkpoint
    real(dp), intent(in) :: interval
    self%checkpoint%path = checkpoint%path
    self%checkpoint%identity = checkpoint%identity
    self%checkpoint%case_text = checkpoint%case_text
    self%checkpoint_interval = interval
    self%keeps_archives = interval > 0
  end subroutine keep_checkpoints

  !> Write a checkpoint with this state of the run. A failure does not stop the run; the previous checkpoint is kept.
  subroutine take_archive(self, archive)
    class(trace_files_t), intent(inout) :: self
    type(archive_t), intent(in) :: archive
    logical :: is_there
    integer :: i
    self%wants_archive = .false.
    self%saved = clock()
    call self%file%synchronise()
    if (any(self%file%has_failed())) then
      !$omp critical (texts)
      call self%tell_error(self%checkpoint_error)
      !$omp end critical (texts)
      return
    end if
    associate (checkpoint => self%checkpoint)
      is_there = .true.
      do i = trace, event_list
        if (is_there .and. self%file(i)%written > 0) &
          call checkpoint%mark(i)%move_to(self%path//trim(suffixes(i))//'.part', self%file(i)%written, is_there)
      end do
      call archive%contents(checkpoint%state)
      checkpoint%wall_time = self%wall_time()
      !$omp critical (texts)
      if (is_there) then
        call checkpoint%save(self%checkpoint_error)
      else
        call fail(self%checkpoint_error, printable(self%path, 200)//'.csv.part: cannot be read', status_output)
      end if
      !$omp end critical (texts)
    end associate
    self%saved = clock()
  end subroutine take_archive

  !> Time since the beginning of the run, without the time between its parts [s].
  real(dp) function wall_time(self)
    class(trace_files_t), intent(in) :: self
    wall_time = self%earlier_time + clock() - self%began
  end function wall_time

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
    call self%progress%finish()
    call self%file(trace)%close(error)
    call self%file(event_list)%close(second)
    call keep_first(second, error)
  end subroutine close

  subroutine take_row(self, values)
    class(trace_files_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: values(:)
    integer, parameter :: rows_between_looks = 100
    call put_row(self%numbers, self%phase_column, values, self%file(trace))
    self%rows = self%rows + 1
    if (mod(self%rows, rows_between_looks) == 0) call look(self)
  end subroutine take_row

  !> Add a row to a file, written directly into its buffer; the phase is one digit.
  subroutine put_row(numbers, phase, values, file)
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: phase   !! index of the phase's column
    real(dp), intent(in), contiguous :: values(:)
    type(result_file_t), intent(inout) :: file
    call file%make_room((longest_number + 1)*size(values))
    associate (text => file%buffer, used => file%used)
      call numbers%append_list(text, used, values(:phase - 1))
      if (phase <= size(values)) then
        text(used + 1:used + 2) = achar(iachar('0') + int(values(phase)))//','
        used = used + 2
        call numbers%append_list(text, used, values(phase + 1:))
      end if
      text(used:used) = achar(10)
    end associate
  end subroutine put_row

  subroutine take_event(self, event)
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
      call self%file(event_list)%put(row%text(:row%used))
    end associate
  end subroutine take_event

  subroutine take_progress(self, time)
    class(trace_files_t), intent(inout) :: self
    real(dp), intent(in) :: time
    !$omp critical (texts)
    call self%progress%update(time/self%expected_end, time)
    !$omp end critical (texts)
    call look(self)
  end subroutine take_progress

  subroutine take_cost(self, time, statistics)
    class(trace_files_t), intent(inout) :: self
    real(dp), intent(in) :: time
    type(step_statistics_t), intent(in) :: statistics
    call self%advice%consider(time, self%expected_end, self%wall_time(), statistics, self%progress)
  end subroutine take_cost

  !> Check whether the run must stop, or whether a checkpoint is due.
  subroutine look(self)
    class(trace_files_t), intent(inout) :: self
    if (interrupted()) self%wants_to_stop = .true.
    if (any(self%file%has_failed())) self%wants_to_stop = .true.
    if (.not. self%keeps_archives) return
    if (clock() - self%saved >= self%checkpoint_interval) self%wants_archive = .true.
  end subroutine look
end module trace_files
