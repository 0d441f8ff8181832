!> Errors as values: an unallocated `error_t` means success.
module error_handling
  implicit none
  private
  public :: error_t, fail, keep_first
  public :: status_ok, status_internal, status_command_line, status_case_file, status_integration, status_output

  !> Exit statuses of the program.
  integer, parameter :: status_ok = 0            !! every case done
  integer, parameter :: status_internal = 1      !! a defect of the program
  integer, parameter :: status_command_line = 2  !! the command line is wrong
  integer, parameter :: status_case_file = 3     !! a case file is unreadable or wrong
  integer, parameter :: status_integration = 4   !! the integration could not continue
  integer, parameter :: status_output = 5        !! a result could not be written

  !> An error: a message of one line without the program's name, and the resulting exit status.
  type :: error_t
    character(len=:), allocatable :: message
    integer :: status = status_internal
  end type error_t

contains

  !> Make an error: `error` is allocated with the message and the exit status.
  pure subroutine fail(error, message, status)
    type(error_t), allocatable, intent(out) :: error
    character(len=*), intent(in) :: message
    integer, intent(in) :: status
    allocate (error)
    error%message = message
    error%status = status
  end subroutine fail

  !> Keep an error unless an earlier one is kept already.
  pure subroutine keep_first(error, kept)
    type(error_t), allocatable, intent(inout) :: error, kept
    if (allocated(error) .and. .not. allocated(kept)) call move_alloc(error, kept)
  end subroutine keep_first
end module error_handling
