!> The errors in a file of the user, collected so that all of them are reported, one line each, in the order of the file; keys that
!> are missing come last.
module problem_list
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: integer_text
  implicit none
  private
  public :: problem_list_t, behind_file, missing_key

  integer, parameter :: behind_file = 1000000000   !! line of a problem without a place in the file: a group that is missing
  integer, parameter :: missing_key = 2*behind_file   !! line of a key that is missing: told behind what may be the cause
  integer, parameter :: most_reported = 20

  type :: problem_t
    character(len=:), allocatable :: text    !! message without the name of the program
    character(len=:), allocatable :: group   !! group that the message blames; empty: none that exists
    integer :: line = 0                      !! line of the file, or beyond it for an override
    logical :: is_settled = .false.          !! its group is not blamed again
  end type problem_t

  type :: problem_list_t
    logical :: is_incomplete = .false.    !! a part of the file could not be read, so that nothing more can be demanded of the file
    logical :: is_structural = .false.    !! it is not known which models are wanted
    integer :: n = 0                      !! number of problems
    integer, private :: status = status_case_file
    type(problem_t), allocatable, private :: found(:)
  contains
    procedure :: add
    procedure :: add_error
    procedure :: absorb
    procedure :: concerns
    procedure :: settle
    procedure :: clear
    procedure :: report
  end type problem_list_t

contains

  !> Add a problem, unless the same one is there, or its group was blamed before `settle`.
  pure subroutine add(self, text, group, line)
    class(problem_list_t), intent(inout) :: self
    character(len=*), intent(in) :: text, group
    integer, intent(in) :: line
    type(problem_t), allocatable :: larger(:)
    integer :: i
    do i = 1, self%n
      if (self%found(i)%text == text) return
      if (self%found(i)%is_settled .and. self%found(i)%group == group) return
    end do
    if (.not. allocated(self%found)) allocate (self%found(4))
    if (self%n == size(self%found)) then
      allocate (larger(2*self%n))
      larger(:self%n) = self%found
      call move_alloc(larger, self%found)
    end if
    self%n = self%n + 1
    do i = self%n, 2, -1   ! in the order of the lines
      if (self%found(i - 1)%line <= line) exit
      self%found(i) = self%found(i - 1)
    end do
    self%found(i)%text = text
    self%found(i)%group = group
    self%found(i)%line = line
    self%found(i)%is_settled = .false.
  end subroutine add

  !> Add an error, if there is one, which is then deallocated.
  pure subroutine add_error(self, error, group, line)
    class(problem_list_t), intent(inout) :: self
    type(error_t), allocatable, intent(inout) :: error
    character(len=*), intent(in) :: group
    integer, intent(in) :: line
    if (.not. allocated(error)) return
    self%status = max(self%status, error%status)
    call self%add(error%message, group, line)
    deallocate (error)
  end subroutine add_error

  !> Add all problems of another list.
  pure subroutine absorb(self, other)
    class(problem_list_t), intent(inout) :: self
    type(problem_list_t), intent(in) :: other
    integer :: i
    do i = 1, other%n
      call self%add(other%found(i)%text, other%found(i)%group, other%found(i)%line)
    end do
  end subroutine absorb

  !> Whether a problem of this group was found; with an empty name, one of an unknown group.
  pure logical function concerns(self, group)
    class(problem_list_t), intent(in) :: self
    character(len=*), intent(in) :: group
    integer :: i
    concerns = .false.
    do i = 1, self%n
      if (self%found(i)%group == group) concerns = .true.
    end do
  end function concerns

  !> Do not blame the groups again that are blamed now: what follows may follow from these problems.
  pure subroutine settle(self)
    class(problem_list_t), intent(inout) :: self
    if (self%n > 0) self%found(:self%n)%is_settled = .true.
  end subroutine settle

  pure subroutine clear(self)
    class(problem_list_t), intent(inout) :: self
    self%n = 0
    self%is_incomplete = .false.
    self%is_structural = .false.
    self%status = status_case_file
  end subroutine clear

  !> The error with all messages, one line each; not allocated if there is no problem.
  pure subroutine report(self, error)
    class(problem_list_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    integer :: i
    if (self%n == 0) return
    text = self%found(1)%text
    do i = 2, min(self%n, most_reported)
      text = text//achar(10)//self%found(i)%text
    end do
    if (self%n > most_reported) text = text//achar(10)//'and '//integer_text(self%n - most_reported)//' more errors'
    call fail(error, text, self%status)
  end subroutine report
end module problem_list
