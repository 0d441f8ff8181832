!> The suites of a test program: all of them, or those named on the command line.
module suites
  use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
  use checks, only: checks_t
  implicit none
  private
  public :: suites_t

  type :: suites_t
    type(checks_t), private :: check
    character(len=80), allocatable, private :: wanted(:)   !! names of suites; empty: all suites
    logical, allocatable, private :: found(:)              !! which of them exist
    logical, private :: prints_times = .false.
  contains
    procedure :: begin
    procedure :: run
    procedure :: finish
  end type suites_t

contains

  !> Read the command line: names of suites, and `--times` to print the processor time of each.
  subroutine begin(self)
    class(suites_t), intent(out) :: self
    character(len=80) :: word
    integer :: i
    allocate (self%wanted(0))
    do i = 1, command_argument_count()
      call get_command_argument(i, word)
      if (word == '--times') then
        self%prints_times = .true.
      else
        self%wanted = [character(len=80) :: self%wanted, word]
      end if
    end do
    allocate (self%found(size(self%wanted)), source=.false.)
  end subroutine begin

  !> Run a suite if it is selected.
  subroutine run(self, name, suite)
    class(suites_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    interface
      subroutine suite(check)
        import :: checks_t
        class(checks_t), intent(inout) :: check
      end subroutine suite
    end interface
    real :: began, ended
    where (self%wanted == name) self%found = .true.
    if (size(self%wanted) > 0 .and. .not. any(self%wanted == name)) return
    call self%check%begin_suite(name)
    call cpu_time(began)
    call suite(self%check)
    call cpu_time(ended)
    if (self%prints_times) write (output_unit, '(f8.2,2a)') ended - began, ' s ', name
  end subroutine run

  !> Print `N passed, N failed` as the last line; the program stops with exit status 1 if anything failed or was not found.
  subroutine finish(self)
    class(suites_t), intent(inout) :: self
    integer :: i
    call self%check%say_unprinted()
    do i = 1, size(self%wanted)
      if (.not. self%found(i)) write (error_unit, '(2a)') 'there is no suite ', trim(self%wanted(i))
    end do
    write (output_unit, '(i0,a,i0,a)') self%check%passed(), ' passed, ', self%check%failed(), ' failed'
    if (self%check%failed() > 0 .or. self%check%passed() == 0 .or. .not. all(self%found)) error stop 1
  end subroutine finish
end module suites
