!> Text files of the user, read whole.
module text_file
  use errors, only: error_t, fail, status_case_file, status_integration
  use text_tools, only: printable, integer_text
  use posix, only: open_for_reading, open_standard_input, wait_for_input, interrupted, read_bytes, close_file, error_text, &
    error_interrupted
  implicit none
  private
  public :: read_text_file

contains

  !> All bytes of a regular file, or of the standard input under the name /dev/stdin. One of more than `most` MB is not the `kind`
  !> of file that it should be.
  subroutine read_text_file(path, most, kind, text, error)
    character(len=*), intent(in) :: path, kind
    integer, intent(in) :: most                        !! [MB], up to 2000
    character(len=:), allocatable, intent(out) :: text
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: buffer, longer
    integer, parameter :: patience = 50   ! ms
    integer :: descriptor, status, ignored, done, used
    logical :: is_input, is_there
    used = 0
    is_input = path == '/dev/stdin'
    allocate (character(len=65536) :: buffer, text)
    if (is_input) then
      call open_standard_input(descriptor, status)
    else
      call open_for_reading(path, descriptor, status)
    end if
    if (status == 0) then
      do while (used <= most*1000000)
        if (is_input .and. interrupted()) exit
        if (is_input) then
          call wait_for_input(descriptor, patience, is_there)
          if (.not. is_there) cycle
        end if
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
    else if (is_input .and. interrupted()) then
      call fail(error, path//': interrupted before it began', status_integration)
    else if (used > most*1000000) then
      call fail(error, printable(path, 200)//': larger than '//integer_text(most)//' MB: not a '//kind, &
        status_case_file)
    end if
  end subroutine read_text_file
end module text_file
