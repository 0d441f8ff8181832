!> A result file that is never incomplete under its final name: rows are collected in a buffer and written to NAME.part in calls
!> that end between rows; when the file is closed it gets its final name. (A kill -9 during such a call truncates the last row of
!> NAME.part.)
module result_file
  use, intrinsic :: iso_c_binding, only: c_long
  use error_handling, only: error_t, fail, status_output
  use text_tools, only: printable
  use posix_files, only: open_for_writing, write_all, truncate_file, reserve_file, &
    synchronise_file, close_file, rename_file, remove_file, error_text, error_interrupted, error_locked, error_no_entry, &
    error_is_directory
  implicit none
  private
  public :: result_file_t, write_text, remove_result, fail_with_file

  integer, parameter :: buffer_size = 65536   !! bytes; larger buffers are slower, due to the first use of their memory pages

  !> A file that is being written. After a failed write nothing more is written: further rows are discarded, `conclude` keeps the
  !> rows that were written completely, and `close` reports the failure.
  type :: result_file_t
    character(len=:), allocatable :: buffer  !! after `require_space` whole rows may be added here, and their length to `used`
    integer :: used = 0                                 !! number of bytes in the buffer
    character(len=:), allocatable, private :: path      !! final name
    integer, private :: descriptor = -1
    integer(c_long) :: written = 0                      !! number of bytes of whole rows in the file
    logical, private :: whole_only = .false.            !! a part of the file is useless
    logical, private :: is_reserved = .false.           !! more disk space has been reserved than the file has bytes
    integer, private :: status = 0                      !! error number of the first write that failed
  contains
    procedure :: open => open_result
    procedure :: append
    procedure :: require_space
    procedure :: reserve
    procedure :: flush => flush_rows
    procedure :: synchronise
    procedure :: has_failed
    procedure :: tell_error
    procedure :: conclude
    procedure :: close => close_result
    procedure :: leave
    procedure :: abandon
  end type result_file_t

contains

  !> Begin a file with the final name `path`. With `whole_only` a part of it is useless, and is removed after a failure.
  subroutine open_result(self, path, error, whole_only)
    class(result_file_t), intent(out) :: self
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: whole_only
    integer :: status
    if (present(whole_only)) self%whole_only = whole_only
    self%path = path
    call open_for_writing(path//'.part', self%descriptor, status)
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine open_result

  !> Add whole rows; `text` must end with an end of line.
  subroutine append(self, text)
    class(result_file_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    if (self%descriptor < 0 .or. self%status /= 0) return
    call self%require_space(len(text))
    if (len(text) > buffer_size) then
      call write_rows(self, text)
    else if (self%status == 0) then
      self%buffer(self%used + 1:self%used + len(text)) = text
      self%used = self%used + len(text)
    end if
  end subroutine append

  !> Make room in the buffer for `length` bytes, at most `buffer_size`.
  subroutine require_space(self, length)
    class(result_file_t), intent(inout) :: self
    integer, intent(in) :: length
    if (self%used + length > buffer_size) call self%flush()
    if (.not. allocated(self%buffer)) allocate (character(len=buffer_size) :: self%buffer)
  end subroutine require_space

  !> Reserve disk space before anything is written, so that the file can be written even if the disk is full later. Error: there is
  !> not enough space.
  subroutine reserve(self, length, error)
    class(result_file_t), intent(inout) :: self
    integer, intent(in) :: length
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    if (self%descriptor < 0) return
    call reserve_file(self%descriptor, length, status)
    self%is_reserved = status == 0
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine reserve

  !> Write the content of the buffer.
  subroutine flush_rows(self)
    class(result_file_t), intent(inout) :: self
    if (self%used > 0) call write_rows(self, self%buffer(:self%used))
    self%used = 0
  end subroutine flush_rows

  !> Write the content of the buffer to the file and to the disk. After a failure nothing more is written, since the system may have
  !> discarded data; `tell_error` reports it.
  impure elemental subroutine synchronise(self)
    class(result_file_t), intent(inout) :: self
    if (self%descriptor < 0) return
    call self%flush()
    if (self%is_reserved) call release(self)
    if (self%status == 0) call synchronise_file(self%descriptor, self%status)
  end subroutine synchronise

  !> Release the reserved space that has not been used.
  subroutine release(self)
    type(result_file_t), intent(inout) :: self
    integer :: status
    call truncate_file(self%descriptor, self%written, status)
    self%is_reserved = .false.
    if (self%status == 0) self%status = status
  end subroutine release

  !> Whether a write has failed.
  pure elemental logical function has_failed(self) result(failed)
    class(result_file_t), intent(in) :: self
    failed = self%status /= 0
  end function has_failed

  !> The first failure, if there was one.
  subroutine tell_error(self, error)
    class(result_file_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error
    if (self%status /= 0) call fail_with_file(self%path, self%status, error)
  end subroutine tell_error

  !> Write the remaining rows and give the file its final name. After a failed write the file keeps its complete rows; it is removed
  !> if it has none, or if a part of it is useless. `close` reports the failure.
  impure elemental subroutine conclude(self)
    class(result_file_t), intent(inout) :: self
    integer :: status, ignored
    if (self%descriptor < 0) return
    call self%flush()
    if (self%is_reserved) call release(self)
    if (self%status == 0 .or. self%written > 0 .and. .not. self%whole_only) then
      call rename_file(self%path//'.part', self%path, status)
      if (self%status == 0) self%status = status
      if (status /= 0 .and. self%whole_only) call remove_file(self%path//'.part', ignored)
    else
      call remove_file(self%path//'.part', ignored)
    end if
    call close_file(self%descriptor, status)   ! last, since this releases the lock on the temporary name
    self%descriptor = -1
    if (self%status == 0 .and. status /= error_interrupted) self%status = status
  end subroutine conclude

  !> Conclude the file unless that has been done; `error` contains its name and the cause of a failure.
  subroutine close_result(self, error)
    class(result_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    call self%conclude()
    call self%tell_error(error)
  end subroutine close_result

  !> Leave the file under its temporary name; an empty file is removed.
  impure elemental subroutine leave(self)
    class(result_file_t), intent(inout) :: self
    integer :: ignored
    if (self%descriptor < 0) return
    call self%flush()
    if (self%is_reserved) call release(self)
    call close_file(self%descriptor, ignored)
    self%descriptor = -1
    if (.not. self%written > 0) call remove_file(self%path//'.part', ignored)
  end subroutine leave

  !> Remove the file.
  subroutine abandon(self)
    class(result_file_t), intent(inout) :: self
    self%used = 0
    self%written = 0
    call self%leave()
  end subroutine abandon

  !> Write a small file to the disk, completely or not at all.
  subroutine write_text(path, text, error)
    character(len=*), intent(in) :: path, text
    type(error_t), allocatable, intent(out) :: error
    type(result_file_t) :: file
    call file%open(path, error, whole_only=.true.)
    if (allocated(error)) return
    call write_rows(file, text)
    call file%synchronise()
    call file%close(error)
  end subroutine write_text

  !> Remove a result file and its temporary file. `status` is set to the error number if it is the first, but not if there is no
  !> such file or if it is a folder. `was_there` becomes true if something was removed.
  subroutine remove_result(path, was_there, status, keeps_part)
    character(len=*), intent(in) :: path
    logical, intent(inout) :: was_there
    integer, intent(inout) :: status
    logical, intent(in) :: keeps_part   !! the temporary file is not removed
    integer :: failed
    if (.not. keeps_part) call remove_file(path//'.part', failed)
    call remove_file(path, failed)
    if (failed == 0) was_there = .true.
    if (status == 0 .and. failed /= error_no_entry .and. failed /= error_is_directory) status = failed
  end subroutine remove_result

  !> Write all of `text`. After a failure the file is truncated to whole rows.
  subroutine write_rows(self, text)
    class(result_file_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer :: done, status, last
    if (self%status /= 0) return
    call write_all(self%descriptor, text, done, status)
    last = done
    if (status /= 0) then
      self%status = status
      last = index(text(:done), achar(10), back=.true.)
    end if
    self%written = self%written + last
    if (last < done) call truncate_file(self%descriptor, self%written, status)
  end subroutine write_rows

  !> The error for an error number of the system, for a result file.
  subroutine fail_with_file(path, status, error)
    character(len=*), intent(in) :: path
    integer, intent(in) :: status
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: cause
    cause = error_text(status)
    if (status == error_locked) cause = 'another run is writing it; wait for it or choose another folder with --out'
    call fail(error, printable(path, 200)//': '//cause, status_output)
  end subroutine fail_with_file
end module result_file
