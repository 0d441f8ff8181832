!> A checkpoint: what a stopped run needs to go on as if it had never stopped, in one file that is written whole or not at
!> all.
!>
!> The file holds a line that says what it is, an archive and the CRC-64 of all that. It belongs to one build of the
!> program on one kind of processor (the rounding of others may differ) and to one case.
module checkpoint
  use, intrinsic :: iso_fortran_env, only: compiler_version, compiler_options
  use kinds, only: dp
  use errors, only: error_t, fail, status_case_file
  use archive, only: archive_t
  use checksum, only: checksum_t
  use file_mark, only: file_mark_t
  use posix, only: open_for_reading, read_bytes, close_file, remove_file, error_text, error_interrupted, error_no_entry
  use result_file, only: result_file_t
  use text_tools, only: printable
  use version, only: program_version
  implicit none
  private
  public :: checkpoint_t, program_build, compare_cases, read_whole, restart_hint

  character(len=*), parameter :: newline = achar(10), title = 'gudgeon checkpoint'//newline
  integer, parameter :: format_version = 1
  integer, parameter :: buffer_size = 65536     !! bytes
  character(len=*), parameter :: restart_hint = '; without --resume the run starts from the beginning'

  !> Keys of a case that only say when a run gives up: they may change between a run and its continuation.
  character(len=*), parameter :: free_keys(3) = [character(len=30) :: 'max_steps', 'max_evaluations', &
    'max_evaluations_per_revolution']

  type :: checkpoint_t
    character(len=:), allocatable :: path        !! of the file
    character(len=:), allocatable :: build       !! the program that wrote it
    character(len=:), allocatable :: case_text   !! the resolved case
    real(dp) :: wall_time = 0                    !! taken by the run so far [s]
    type(file_mark_t) :: trace, event_list       !! what was in the result files
    character(len=:), allocatable :: state       !! of the run: the contents of an archive
  contains
    procedure :: save => save_checkpoint
    procedure :: load
    procedure :: remove
    procedure, private :: exchange
  end type checkpoint_t

contains

  !> Which program this is, to the byte, and how it rounds on this machine: version, compiler, options, checksum of the
  !> executable and of elementary functions (the C library has several of each and takes what the processor can).
  function program_build() result(text)
    character(len=:), allocatable :: text
    type(checksum_t) :: sum
    character(len=:), allocatable :: bytes
    integer :: status
    call read_whole('/proc/self/exe', bytes, status)
    call sum%add(bytes)
    call add_functions(sum)
    text = program_version//newline//compiler_version()//newline//compiler_options()//newline//sum%hexadecimal()
  end function program_build

  !> Elementary functions at a thousand points.
  pure subroutine add_functions(sum)
    type(checksum_t), intent(inout) :: sum
    real(dp) :: x, values(7)
    character(len=8*size(values)) :: bytes
    integer :: i
    do i = 1, 1000
      x = 0.0137_dp*i
      values = [sin(x), cos(x), tan(x), exp(-x), log(x), x**1.5_dp, atan2(x, 3.0_dp)]
      bytes = transfer(values, bytes)
      call sum%add(bytes)
    end do
  end subroutine add_functions

  !> Write the file: first under another name, then by renaming, so that a checkpoint is there at every time.
  subroutine save_checkpoint(self, error)
    class(checkpoint_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(archive_t) :: archive
    type(checksum_t) :: sum
    type(result_file_t) :: file
    character(len=:), allocatable :: bytes
    character(len=8) :: mark

    call archive%begin_writing()
    call self%exchange(archive)
    call archive%contents(bytes)
    bytes = title//bytes
    call sum%add(bytes)
    mark = transfer(sum%value(), mark)
    call file%open(self%path, error)
    if (allocated(error)) return
    call file%put(bytes//mark)
    call file%synchronise(error)
    if (allocated(error)) then
      call file%abandon()
    else
      call file%close(error, whole_only=.true.)
    end if
  end subroutine save_checkpoint

  !> Read the file of self%path, if there is one. Errors: it is damaged, or was written by another build.
  subroutine load(self, build, found, error)
    class(checkpoint_t), intent(inout) :: self
    character(len=*), intent(in) :: build
    logical, intent(out) :: found
    type(error_t), allocatable, intent(out) :: error
    type(archive_t) :: archive
    type(checksum_t) :: sum
    character(len=:), allocatable :: bytes, wrong
    integer :: status, last
    character(len=8) :: mark

    found = .false.
    call read_whole(self%path, bytes, status)
    if (status == error_no_entry) return
    last = len(bytes) - len(mark)
    if (status /= 0) then
      wrong = error_text(status)
    else if (last < len(title)) then
      wrong = 'damaged'//restart_hint
    else if (bytes(:len(title)) /= title) then
      wrong = 'not a checkpoint of gudgeon'//restart_hint
    else
      call sum%add(bytes(:last))
      mark = transfer(sum%value(), mark)
      if (bytes(last + 1:) /= mark) then
        wrong = 'damaged'//restart_hint
      else
        call archive%begin_reading(bytes(len(title) + 1:last))
        call self%exchange(archive)
        if (archive%failed .or. .not. archive%is_at_end()) then
          wrong = 'written by another version of gudgeon'//restart_hint
        else if (self%build /= build) then
          wrong = 'written by another build of gudgeon, or on another kind of processor: the rounding may differ'//restart_hint
        end if
      end if
    end if
    if (allocated(wrong)) call fail(error, printable(self%path, 200)//': '//wrong, status_case_file)
    found = .not. allocated(wrong)
  end subroutine load

  !> Remove the file, if it is there.
  subroutine remove(self)
    class(checkpoint_t), intent(in) :: self
    integer :: ignored
    call remove_file(self%path, ignored)
  end subroutine remove

  subroutine exchange(self, archive)
    class(checkpoint_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    integer :: version
    version = format_version
    call archive%exchange(version)
    if (version /= format_version) archive%failed = .true.
    call archive%exchange_text(self%build)
    call archive%exchange_text(self%case_text)
    call archive%exchange(self%wall_time)
    call self%trace%exchange(archive)
    call self%event_list%exchange(archive)
    call archive%exchange_text(self%state)
  end subroutine exchange

  !> Where two resolved cases differ, besides the keys that may: group and line of each. `difference` is empty where they do
  !> not.
  subroutine compare_cases(case_text, earlier, difference)
    character(len=*), intent(in) :: case_text, earlier
    character(len=:), allocatable, intent(out) :: difference
    character(len=:), allocatable :: line, other, group
    integer :: at, other_at
    difference = ''
    group = ''
    at = 1
    other_at = 1
    do while (difference == '' .and. (at <= len(case_text) .or. other_at <= len(earlier)))
      call next_line(case_text, at, line)
      call next_line(earlier, other_at, other)
      if (line == other) then
        if (index(line, '&') == 1) group = line
      else
        difference = group//' '//trim(adjustl(line))//', where the run to go on with has '//trim(adjustl(other))
        if (index(line//other, '&') > 0) difference = 'the groups '//line//' and '//other//' where the run to go on with differs'
      end if
    end do
  end subroutine compare_cases

  !> The next line from position `at` that is not one of a key that may change; `at` moves behind it.
  subroutine next_line(text, at, line)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at
    character(len=:), allocatable, intent(out) :: line
    integer :: length, i
    logical :: is_free
    do
      length = index(text(min(at, len(text) + 1):)//newline, newline) - 1
      line = text(min(at, len(text) + 1):min(at + length - 1, len(text)))
      at = at + length + 1
      is_free = .false.
      do i = 1, size(free_keys)
        if (index(adjustl(line), trim(free_keys(i))//' =') == 1) is_free = .true.
      end do
      if (.not. is_free) return
    end do
  end subroutine next_line

  !> All bytes of a file; `status` is 0 or the error number.
  subroutine read_whole(path, bytes, status)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: bytes
    integer, intent(out) :: status
    character(len=:), allocatable :: larger
    integer :: descriptor, done, used, ignored
    used = 0
    allocate (character(len=buffer_size) :: bytes)
    call open_for_reading(path, descriptor, status)
    if (status == 0) then
      do
        if (used == len(bytes)) then
          allocate (character(len=2*used) :: larger)
          larger(:used) = bytes
          call move_alloc(larger, bytes)
        end if
        call read_bytes(descriptor, bytes(used + 1:), done, status)
        if (status == error_interrupted) cycle
        if (status /= 0 .or. done == 0) exit
        used = used + done
      end do
      call close_file(descriptor, ignored)
    end if
    bytes = bytes(:used)
  end subroutine read_whole
end module checkpoint
