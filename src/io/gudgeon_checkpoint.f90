!> A checkpoint: everything that a stopped run needs to continue with identical results, in one file that is either complete or not
!> there; and the search for an earlier run of the same case for `--resume`.
!>
!> The file contains a line that identifies its format, an archive, and a checksum of both.
module gudgeon_checkpoint
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, status_case_file
  use gudgeon_archive, only: archive_t
  use gudgeon_checksum, only: checksum_t, mark_of, mark_length
  use gudgeon_posix, only: open_file, to_read, read_at, close_file, synchronise_folder, file_length, error_text, &
    error_no_entry, error_interrupted
  use result_file, only: write_text
  use run_identity, only: compare_cases
  use gudgeon_summary, only: summary_value
  use text_file, only: read_whole
  use text_tools, only: printable, integer_text
  implicit none
  private
  public :: checkpoint_t, file_mark_t, continuation_t, restart_hint

  character(len=*), parameter :: newline = achar(10), title = 'gudgeon checkpoint'//newline
  integer, parameter :: format_version = 5
  character(len=*), parameter :: restart_hint = '; without --resume the run starts from the beginning'

  integer, parameter :: buffer_size = 65536   !! [bytes]; fits into the processor's cache

  !> The length of a file and a checksum of all its bytes. A mark from an archive can be compared with others, but not extended.
  type :: file_mark_t
    integer(int64) :: length = 0
    integer(int64) :: checksum = 0
    type(checksum_t), private :: sum = checksum_t()
  contains
    procedure :: move_to
  end type file_mark_t

  type :: checkpoint_t
    character(len=:), allocatable :: path        !! of the file
    character(len=:), allocatable :: identity    !! identity of the run
    character(len=:), allocatable :: case_text   !! the resolved case
    real(dp) :: wall_time = 0                    !! used by the run so far [s]
    type(file_mark_t) :: mark(2)                 !! length and checksum of the trace and of the list of events
    character(len=:), allocatable :: state       !! state of the run: the content of an archive
  contains
    procedure :: save => save_checkpoint
    procedure :: load
  end type checkpoint_t

  !> Where a run begins: at its start, unless one of the first two components is true.
  type :: continuation_t
    logical :: goes_on = .false.     !! continue from the checkpoint
    logical :: is_done = .false.     !! the run is complete already
    real(dp) :: interval = 0         !! between checkpoints [s]; 0: none
    type(checkpoint_t) :: checkpoint   !! its path, and identity and resolved case of the run; with `goes_on` all that it holds
  contains
    procedure :: look_for
  end type continuation_t

contains

  !> Write the file under a temporary name and rename it, so that there is a valid checkpoint at any time.
  subroutine save_checkpoint(self, error)
    class(checkpoint_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(archive_t) :: archive
    character(len=:), allocatable :: bytes
    integer :: ignored

    call archive%begin_writing()
    call exchange(self, archive)
    call archive%contents(bytes)
    bytes = title//bytes
    call write_text(self%path, bytes//mark_of(bytes), error)
    if (.not. allocated(error)) call synchronise_folder(self%path, ignored)
  end subroutine save_checkpoint

  !> Read the file self%path, if it exists. Error: it is damaged, or has another format.
  subroutine load(self, found, error)
    class(checkpoint_t), intent(inout) :: self
    logical, intent(out) :: found
    type(error_t), allocatable, intent(out) :: error
    type(archive_t) :: archive
    character(len=:), allocatable :: bytes, wrong
    integer :: status, last

    found = .false.
    call read_whole(self%path, bytes, status)
    if (status == error_no_entry) return
    last = len(bytes) - mark_length
    if (status /= 0) then
      wrong = error_text(status)
    else if (last < len(title)) then
      wrong = 'damaged'//restart_hint
    else if (bytes(:len(title)) /= title) then
      wrong = 'not a checkpoint of gudgeon'//restart_hint
    else if (bytes(last + 1:) /= mark_of(bytes(:last))) then
      wrong = 'damaged'//restart_hint
    else
      call archive%begin_reading(bytes(len(title) + 1:last))
      call exchange(self, archive)
      if (archive%failed .or. .not. archive%is_at_end()) wrong = 'written by another version of gudgeon'//restart_hint
    end if
    if (allocated(wrong)) call fail(error, printable(self%path, 200)//': '//wrong, status_case_file)
    found = .not. allocated(wrong)
  end subroutine load

  subroutine exchange(self, archive)
    class(checkpoint_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    integer :: version, i
    version = format_version
    call archive%exchange(version)
    if (version /= format_version) archive%failed = .true.
    call archive%exchange_text(self%identity)
    call archive%exchange_text(self%case_text)
    call archive%exchange(self%wall_time)
    do i = 1, size(self%mark)
      call archive%exchange(self%mark(i)%length)
      call archive%exchange(self%mark(i)%checksum)
    end do
    call archive%exchange_text(self%state)
  end subroutine exchange

  !> Extend the mark to `length`, reading the file in between. If the file cannot be read that far, `is_there` is false and the mark
  !> must not be used any more.
  subroutine move_to(self, path, length, is_there)
    class(file_mark_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(int64), intent(in) :: length
    logical, intent(out) :: is_there
    character(len=buffer_size) :: buffer
    integer :: descriptor, status, wanted, done, ignored

    call open_file(path, to_read, descriptor, status)
    is_there = status == 0
    if (.not. is_there) return
    do while (self%length < length)
      wanted = int(min(int(buffer_size, int64), length - self%length))
      call read_at(descriptor, self%length, buffer(:wanted), done, status)
      if (status == error_interrupted) cycle
      is_there = status == 0 .and. done > 0
      if (.not. is_there) exit
      call self%sum%add(buffer(:done))
      self%length = self%length + done
    end do
    call close_file(descriptor, ignored)
    self%checksum = self%sum%sum
  end subroutine move_to

  !> Look for complete results of the same run under BASE, or for its checkpoint. Errors: the checkpoint is damaged, or belongs to
  !> another case or program.
  subroutine look_for(self, base, file, with_case, with_events, error)
    class(continuation_t), intent(inout) :: self
    character(len=*), intent(in) :: base, file   !! path of the results without suffix; path of the case file
    logical, intent(in) :: with_case             !! the resolved case belongs to the results
    logical, intent(in) :: with_events           !! a list of events belongs to the results
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_t) :: stopped
    character(len=:), allocatable :: earlier, difference
    logical :: found
    integer :: status

    self%is_done = are_whole(base, self%checkpoint%identity, with_events)
    if (self%is_done .and. with_case) then
      call read_whole(base//'.resolved.nml', earlier, status)
      call compare_cases(self%checkpoint%case_text, earlier, difference)
      self%is_done = status == 0 .and. difference == ''
    end if
    if (self%is_done) return
    stopped%path = self%checkpoint%path
    call stopped%load(found, error)
    if (allocated(error) .or. .not. found) return
    call compare_cases(self%checkpoint%case_text, stopped%case_text, difference)
    self%goes_on = stopped%identity == self%checkpoint%identity
    if (difference /= '') then
      call fail(error, printable(file, 200)//': '//difference//restart_hint, status_case_file)
    else if (.not. self%goes_on) then
      call fail(error, printable(stopped%path, 200)//': written by another build of gudgeon, or on another kind of '// &
                'processor: the rounding may differ'//restart_hint, status_case_file)
    else
      stopped%case_text = self%checkpoint%case_text   ! limits may differ; those of the continuation count
      self%checkpoint = stopped
    end if
  end subroutine look_for

  !> Whether the results BASE are complete and belong to a completed run of this identity: its summary says so, and the files have
  !> the lengths given there.
  logical function are_whole(base, identity, with_events) result(answer)
    character(len=*), intent(in) :: base, identity
    logical, intent(in) :: with_events
    character(len=:), allocatable :: table
    integer :: status
    call read_whole(base//'.summary.csv', table, status)
    answer = status == 0
    if (answer) answer = summary_value(table, 'identity') == identity
    if (answer) answer = summary_value(table, 'status') == '"done"'
    if (answer) answer = integer_text(file_length(base//'.csv')) == summary_value(table, 'trace_bytes')
    if (answer .and. with_events) answer = integer_text(file_length(base//'.events.csv')) == summary_value(table, 'events_bytes')
  end function are_whole
end module gudgeon_checkpoint
