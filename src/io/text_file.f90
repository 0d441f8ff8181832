!> Reads whole files.
module text_file
  use error_handling, only: error_t, fail, status_case_file, status_integration
  use text_tools, only: printable, integer_text
  use growing_text, only: growing_text_t
  use posix_files, only: open_file, to_read, open_standard_input, wait_for_input, interrupted, read_bytes, close_file, &
    error_text, error_interrupted, error_no_entry, file_length
  implicit none
  private
  public :: read_text_file, read_whole

  integer, parameter :: buffer_size = 65536   !! bytes

contains

  !> Read a text file given by the user: a regular file, or standard input under the name /dev/stdin. A file of more than `most` MB
  !> is refused as not being of the expected `kind`.
  subroutine read_text_file(path, most, kind, text, error)
    character(len=*), intent(in) :: path, kind
    integer, intent(in) :: most                        !! [MB], up to 2000
    character(len=:), allocatable, intent(out) :: text
    type(error_t), allocatable, intent(out) :: error
    integer :: descriptor, status
    logical :: is_input, was_interrupted
    is_input = path == '/dev/stdin'
    if (is_input) then
      call open_standard_input(descriptor, status)
    else
      call open_file(path, to_read, descriptor, status)
    end if
    call read_all(descriptor, is_input, most*1000000, text, status, was_interrupted)
    if (status /= 0) then
      call fail(error, printable(path, 200)//': '//error_text(status), status_case_file)
      if (status == error_no_entry) then
        if (file_length(path//'.nml') >= 0) error%message = error%message//'; did you mean '//printable(path, 200)//'.nml?'
      end if
    else if (was_interrupted) then
      call fail(error, path//': interrupted before it began', status_integration)
    else if (len(text) > most*1000000) then
      call fail(error, printable(path, 200)//': larger than '//integer_text(most)//' MB: not a '//kind, &
        status_case_file)
    else if (is_utf_16(text)) then
      call fail(error, printable(path, 200)//': encoded in UTF-16 ("Unicode" in Windows, > in its PowerShell): save it in UTF-8', &
        status_case_file)
    end if
  end subroutine read_text_file

  !> Whether a text begins as one of UTF-16: with its byte order mark, or with a character of ASCII and its empty byte.
  pure logical function is_utf_16(text) result(found)
    character(len=*), intent(in) :: text
    character(len=*), parameter :: mark = char(255)//char(254)
    found = .false.
    if (len(text) < 2) return
    found = text(:2) == mark .or. text(:2) == mark(2:2)//mark(1:1) .or. (ichar(text(1:1)) == 0 .neqv. ichar(text(2:2)) == 0)
  end function is_utf_16

  !> All bytes of a file; `status` is 0 or the error number.
  subroutine read_whole(path, bytes, status)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: bytes
    integer, intent(out) :: status
    integer :: descriptor
    logical :: never
    call open_file(path, to_read, descriptor, status)
    call read_all(descriptor, .false., huge(0) - buffer_size, bytes, status, never)
  end subroutine read_whole

  !> Read a file that has just been opened, up to a little more than `most` bytes, and close it. Nothing is read if `status` is not
  !> 0.
  subroutine read_all(descriptor, waits, most, bytes, status, was_interrupted)
    integer, intent(in) :: descriptor, most
    logical, intent(in) :: waits   !! the file is a pipe or a terminal, and the user may interrupt
    character(len=:), allocatable, intent(out) :: bytes
    integer, intent(inout) :: status
    logical, intent(out) :: was_interrupted
    type(growing_text_t) :: all
    integer :: done, ignored
    was_interrupted = .false.
    call all%reserve(buffer_size)
    if (status == 0) then
      do while (all%used <= most)
        if (waits) call await_input(descriptor, was_interrupted)
        if (was_interrupted) exit
        call all%reserve(buffer_size)
        call read_bytes(descriptor, all%text(all%used + 1:all%used + buffer_size), done, status)
        if (status == error_interrupted) cycle
        if (status /= 0 .or. done == 0) exit
        all%used = all%used + done
      end do
      call close_file(descriptor, ignored)
    end if
    bytes = all%text(:all%used)
  end subroutine read_all

  !> Wait until standard input has data, or the user interrupts.
  subroutine await_input(descriptor, was_interrupted)
    integer, intent(in) :: descriptor
    logical, intent(out) :: was_interrupted
    integer, parameter :: timeout = 50   ! ms
    logical :: has_input
    do
      was_interrupted = interrupted()
      if (was_interrupted) return
      call wait_for_input(descriptor, timeout, has_input)
      if (has_input) return
    end do
  end subroutine await_input
end module text_file
