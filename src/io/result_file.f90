!> A result file that never stands half-written under its final name: rows gather in a buffer, go out to NAME.part in
!> calls that end between rows, and the file gets its final name when it is closed. (A kill -9 in the middle of such a call cuts
!> the last row of NAME.part.)
module result_file
  use, intrinsic :: iso_c_binding, only: c_long
  use gudgeon_errors, only: error_t, fail, status_output
  use text_tools, only: printable
  use gudgeon_posix, only: open_for_writing, open_for_appending, write_bytes, truncate_file, reserve_file, &
    synchronise_file, close_file, rename_file, remove_file, error_text, error_interrupted, &
    error_no_entry, error_is_directory
  implicit none
  private
  public :: result_file_t, write_text, remove_result, fail_with_file

  integer, parameter :: buffer_size = 65536   !! bytes; larger ones take longer, by the first use of their pages

  !> One file being written. A failed write ends the writing: rows put after it are dropped, `conclude` keeps what went
  !> out whole, `close` reports the failure.
  type :: result_file_t
    character(len=:), allocatable :: buffer             !! who has asked for room may add whole rows here, and to `used`
    integer :: used = 0                                 !! bytes waiting in the buffer
    character(len=:), allocatable, private :: path      !! final name
    integer, private :: descriptor = -1
    integer(c_long), private :: written = 0             !! bytes of whole rows in the file
    logical, private :: is_reserved = .false.           !! the disk keeps more room for it than it has bytes
    integer, private :: status = 0                      !! error number of the first write that failed
  contains
    procedure :: open => open_result
    procedure :: reopen
    procedure :: put
    procedure :: make_room
    procedure :: reserve
    procedure :: flush => flush_rows
    procedure :: synchronise
    procedure :: length
    procedure :: has_failed
    procedure :: tell_error
    procedure :: conclude
    procedure :: close => close_result
    procedure :: leave
    procedure :: abandon
  end type result_file_t

contains

  !> Begin the file that is to be called `path`.
  subroutine open_result(self, path, error)
    class(result_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    self%path = path
    self%used = 0
    self%written = 0
    self%status = 0
    self%is_reserved = .false.
    do
      call open_for_writing(path//'.part', self%descriptor, status)
      if (status /= error_interrupted) exit
    end do
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine open_result

  !> Go on with the file that is to be called `path` from its first `length` bytes. What there is of it has the name `present`.
  subroutine reopen(self, path, present, length, error)
    class(result_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path, present
    integer(c_long), intent(in) :: length
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    self%path = path
    self%used = 0
    self%written = length
    self%status = 0
    call open_for_appending(present, self%descriptor, status)
    if (status == 0) call truncate_file(self%descriptor, length, status)
    if (status == 0 .and. present /= path//'.part') call rename_file(present, path//'.part', status)
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine reopen

  !> Add whole rows; `text` ends with an end of line.
  subroutine put(self, text)
    class(result_file_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    if (self%descriptor < 0 .or. self%status /= 0) return
    call self%make_room(len(text))
    if (len(text) > buffer_size) then
      call write_rows(self, text)
    else if (self%status == 0) then
      self%buffer(self%used + 1:self%used + len(text)) = text
      self%used = self%used + len(text)
    end if
  end subroutine put

  !> Room in the buffer for so many bytes, `buffer_size` at most.
  subroutine make_room(self, length)
    class(result_file_t), intent(inout) :: self
    integer, intent(in) :: length
    if (self%used + length > buffer_size) call self%flush()
    if (.not. allocated(self%buffer)) allocate (character(len=buffer_size) :: self%buffer)
  end subroutine make_room

  !> Have the disk keep room for so many bytes, before any is written: they can be written even when it is full then. Error: it
  !> is full already.
  subroutine reserve(self, length, error)
    class(result_file_t), intent(inout) :: self
    integer, intent(in) :: length
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    if (self%descriptor < 0) return
    call reserve_file(self%descriptor, int(length, c_long), status)
    self%is_reserved = status == 0
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine reserve

  !> Write out what waits in the buffer.
  subroutine flush_rows(self)
    class(result_file_t), intent(inout) :: self
    if (self%used > 0) call write_rows(self, self%buffer(:self%used))
    self%used = 0
  end subroutine flush_rows

  !> Write out what waits, down to the disk. A failure ends the writing: the system may have thrown away what it could not write.
  !> `tell_error` says which. This makes no text.
  subroutine synchronise(self)
    class(result_file_t), intent(inout) :: self
    integer :: status
    if (self%descriptor < 0) return
    call self%flush()
    status = 0
    if (self%is_reserved) call truncate_file(self%descriptor, self%written, status)   ! what is beyond goes back to the disk
    self%is_reserved = .false.
    if (self%status == 0) call synchronise_file(self%descriptor, status)
    if (self%status == 0 .and. status /= 0) then
      !$omp atomic write
      self%status = status
    end if
  end subroutine synchronise

  !> Bytes of whole rows that are in the file.
  pure function length(self)
    class(result_file_t), intent(in) :: self
    integer(c_long) :: length
    length = self%written
  end function length

  !> Whether a write has failed, so that nothing more can be kept; also while another thread writes.
  logical function has_failed(self) result(failed)
    class(result_file_t), intent(in) :: self
    integer :: status
    !$omp atomic read
    status = self%status
    failed = status /= 0
  end function has_failed

  !> The first failure, if there was one.
  subroutine tell_error(self, error)
    class(result_file_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error
    if (self%status /= 0) call fail_with_file(self%path, self%status, error)
  end subroutine tell_error

  !> Write out the rest and give the file its final name. After a failed write it holds the whole rows that fitted (there
  !> is no file if none did, or if it is of no use in part: `whole_only`). `close` reports the failure; this makes no text.
  subroutine conclude(self, whole_only)
    class(result_file_t), intent(inout) :: self
    logical, intent(in), optional :: whole_only
    integer :: status, ignored
    logical :: needs_all
    needs_all = .false.
    if (present(whole_only)) needs_all = whole_only
    if (self%descriptor < 0) return
    call self%flush()
    call close_file(self%descriptor, status)
    self%descriptor = -1
    if (self%status == 0 .and. status /= error_interrupted) self%status = status
    if (self%status == 0 .or. self%written > 0 .and. .not. needs_all) then
      call rename_file(self%path//'.part', self%path, status)
      if (self%status == 0) self%status = status
      if (status /= 0 .and. needs_all) call remove_file(self%path//'.part', ignored)
    else
      call remove_file(self%path//'.part', ignored)
    end if
  end subroutine conclude

  !> Conclude the file, if that is not done yet; `error` names it and the cause of a failure.
  subroutine close_result(self, error, whole_only)
    class(result_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: whole_only
    call self%conclude(whole_only)
    call self%tell_error(error)
  end subroutine close_result

  !> Leave what is written under the temporary name; a file without any of it is removed.
  subroutine leave(self)
    class(result_file_t), intent(inout) :: self
    integer :: ignored
    if (self%descriptor < 0) return
    call self%flush()
    call close_file(self%descriptor, ignored)
    self%descriptor = -1
    if (.not. self%written > 0) call remove_file(self%path//'.part', ignored)
  end subroutine leave

  !> Give the file up: nothing of it stays.
  subroutine abandon(self)
    class(result_file_t), intent(inout) :: self
    integer :: ignored
    if (self%descriptor < 0) return
    call close_file(self%descriptor, ignored)
    call remove_file(self%path//'.part', ignored)
    self%descriptor = -1
    self%used = 0
  end subroutine abandon

  !> A small file, written whole down to the disk, or not at all.
  subroutine write_text(path, text, error)
    character(len=*), intent(in) :: path, text
    type(error_t), allocatable, intent(out) :: error
    type(result_file_t) :: file
    call file%open(path, error)
    if (allocated(error)) return
    call write_rows(file, text)
    call file%synchronise()
    call file%close(error, whole_only=.true.)
  end subroutine write_text

  !> Remove a result, finished or not. `status` is 0 also where there was none, or where a folder has its name, else the error
  !> number; `was_there` turns true where something was removed. This makes no text.
  subroutine remove_result(path, was_there, status)
    character(len=*), intent(in) :: path
    logical, intent(inout) :: was_there
    integer, intent(out) :: status
    integer :: ignored
    call remove_file(path//'.part', ignored)
    call remove_file(path, status)
    if (status == 0) was_there = .true.
    if (status == error_no_entry .or. status == error_is_directory) status = 0
  end subroutine remove_result

  !> All of `text`, in as many calls as it takes. When one fails the file is cut back to its last whole row.
  subroutine write_rows(self, text)
    class(result_file_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer :: at, done, status, last
    if (self%status /= 0) return
    at = 0
    do while (at < len(text))
      call write_bytes(self%descriptor, text(at + 1:), done, status)
      if (status == error_interrupted) cycle
      if (status /= 0) exit
      at = at + done
    end do
    last = at
    if (at < len(text)) then
      !$omp atomic write
      self%status = status
      last = index(text(:at), achar(10), back=.true.)
    end if
    self%written = self%written + last
    if (last < at) call truncate_file(self%descriptor, self%written, status)
  end subroutine write_rows

  !> The error for an error number of the system, met with a result.
  subroutine fail_with_file(path, status, error)
    character(len=*), intent(in) :: path
    integer, intent(in) :: status
    type(error_t), allocatable, intent(out) :: error
    call fail(error, printable(path, 200)//': '//error_text(status), status_output)
  end subroutine fail_with_file
end module result_file
