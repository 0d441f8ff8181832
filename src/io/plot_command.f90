!> `gudgeon plot ...` is the command gudgeon-plot, which the Python package installs; it is looked for on the PATH.
module plot_command
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_ptr, c_null_char, c_null_ptr, c_loc
  use error_handling, only: error_t, fail, status_command_line
  implicit none
  private
  public :: plot_is_wanted, become_plot

  character(len=*), parameter :: program = 'gudgeon-plot'

  type :: argument_t
    character(kind=c_char), allocatable :: bytes(:)
  end type argument_t

  interface
    integer(c_int) function c_execvp(file, arguments) bind(c, name='execvp') result(failed)
      import :: c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: file(*)
      type(c_ptr), intent(in) :: arguments(*)
    end function c_execvp
  end interface

contains

  !> Whether the first argument of the program is `plot`.
  logical function plot_is_wanted()
    character(len=5) :: first   ! plot and a blank
    call get_command_argument(1, value=first)
    plot_is_wanted = first == 'plot'
  end function plot_is_wanted

  !> Become gudgeon-plot with the arguments after the first. Error: it cannot be started.
  subroutine become_plot(error)
    type(error_t), allocatable, intent(out) :: error
    type(argument_t), allocatable, target :: arguments(:)
    type(c_ptr), allocatable :: places(:)
    integer(c_int) :: unused
    integer :: i
    allocate (arguments(command_argument_count()), places(command_argument_count() + 1))
    arguments(1)%bytes = bytes(program)
    do i = 2, size(arguments)
      arguments(i)%bytes = bytes(argument(i))
    end do
    do i = 1, size(arguments)
      places(i) = c_loc(arguments(i)%bytes)
    end do
    places(size(places)) = c_null_ptr
    unused = c_execvp(arguments(1)%bytes, places)   ! returns only if it fails
    call fail(error, 'plot: '//program//' is not on the PATH: in a checkout, pip install ''./scripts/python[plots]'' or '// &
      'scripts/setup.sh --python installs it', status_command_line)
  end subroutine become_plot

  !> Argument i of the program, with its blanks.
  function argument(i) result(text)
    integer, intent(in) :: i
    character(len=:), allocatable :: text
    integer :: length
    call get_command_argument(i, length=length)
    allocate (character(len=length) :: text)
    call get_command_argument(i, value=text)
  end function argument

  !> A text with a final zero, byte by byte.
  pure function bytes(text)
    character(len=*), intent(in) :: text
    character(kind=c_char) :: bytes(len(text) + 1)
    integer :: i
    do i = 1, len(text)
      bytes(i) = text(i:i)
    end do
    bytes(len(text) + 1) = c_null_char
  end function bytes
end module plot_command
