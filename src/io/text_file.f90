!> Files read whole.
module text_file
  use gudgeon_errors, only: error_t, fail, status_case_file, status_integration
  use text_tools, only: printable, integer_text
  use gudgeon_posix, only: open_for_reading, open_standard_input, wait_for_input, interrupted, read_bytes, close_file, error_text, &
    error_interrupted
  implicit none
  private
  public :: read_text_file, read_whole

  integer, parameter :: buffer_size = 65536   !! bytes

contains

  !> A text file of the user: all bytes of a regular file, or of the standard input under the name /dev/stdin. One of more than `most` MB is not the `kind`
  !> of file that it should be.
  subroutine read_text_file(path, most, kind, text, error)
    character(len=*), intent(in) :: path, kind
    integer, intent(in) :: most                        !! [MB], up to 2000
    character(len=:), allocatable, intent(out) :: text
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: buffer, longer
    integer :: descriptor, status, ignored, done, used
    logical :: is_input, was_interrupted
    used = 0
    was_interrupted = .false.
    is_input = path == '/dev/stdin'
    allocate (character(len=65536) :: buffer, text)
    if (is_input) then
      call open_standard_input(descriptor, status)
    else
      call open_for_reading(path, descriptor, status)
    end if
    if (status == 0) then
      do while (used <= most*1000000)
        if (is_input) call await_input(descriptor, was_interrupted)
        if (was_interrupted) exit
        call read_bytes(descriptor, buffer, done, status)
        if (status == error_interrupted) cycle
        if (status /= 0 .or. done == 0) exit
        if (used + done > len(text)) then
          allocate (character(len=2*used + done) :: longer)
          longer(:used) = text(:used)
          call move_alloc(longer, text)
        end if
        text(used + 1:used + done) = buffer(:done)
        used = used + done
      end do
      call close_file(descriptor, ignored)
    end if
    text = text(:used)
    if (status /= 0) then
      call fail(error, printable(path, 200)//': '//error_text(status), status_case_file)
    else if (was_interrupted) then
      call fail(error, path//': interrupted before it began', status_integration)
    else if (used > most*1000000) then
      call fail(error, printable(path, 200)//': larger than '//integer_text(most)//' MB: not a '//kind, &
        status_case_file)
    end if
  end subroutine read_text_file
  !> Wait until the standard input has something, or the user has enough.
  subroutine await_input(descriptor, was_interrupted)
    integer, intent(in) :: descriptor
    logical, intent(out) :: was_interrupted
    integer, parameter :: patience = 50   ! ms
    logical :: is_there
    do
      was_interrupted = interrupted()
      if (was_interrupted) return
      call wait_for_input(descriptor, patience, is_there)
      if (is_there) return
    end do
  end subroutine await_input

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
end module text_file
