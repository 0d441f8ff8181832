!> Prevents two runs from writing to the same result files at the same time.
module case_lock
  use gudgeon_errors, only: error_t, fail, status_output
  use text_tools, only: printable
  use result_file, only: fail_with_file
  use gudgeon_posix, only: open_to_lock, lock_file, is_file, close_file, remove_file, error_interrupted, error_locked, &
    error_exists, error_no_entry
  implicit none
  private
  public :: case_lock_t

  !> A lock on the file BASE.lock, which exists while the run does. If a run is killed its file remains, but not its lock.
  type :: case_lock_t
    private
    character(len=:), allocatable :: path
    integer :: descriptor = -1
  contains
    procedure :: take
    procedure :: release
  end type case_lock_t

contains

  !> Take the lock for the results BASE.csv etc. Errors: another run holds the lock; the file cannot be created. On a file system
  !> without locks no lock is taken.
  subroutine take(self, base, error)
    class(case_lock_t), intent(inout) :: self
    character(len=*), intent(in) :: base   !! path of the results without suffix
    type(error_t), allocatable, intent(out) :: error
    integer, parameter :: most_tries = 1000
    integer :: status, ignored, try

    self%path = base//'.lock'
    do try = 1, most_tries
      call open_to_lock(self%path, self%descriptor, status)
      if (status == error_interrupted) cycle
      if ((status == error_exists .or. status == error_no_entry) .and. try < most_tries) cycle   ! another run is just starting
      if (status /= 0) then
        self%descriptor = -1
        call fail_with_file(self%path, status, error)
        return
      end if
      call lock_file(self%descriptor, status)
      if (status == error_locked) then
        call close_file(self%descriptor, ignored)
        self%descriptor = -1
        call fail(error, printable(base, 200)//'.csv: another run is writing it; wait for it or choose another folder with --out', &
                  status_output)
        return
      end if
      if (is_file(self%path, self%descriptor) .or. try == most_tries) return
      call close_file(self%descriptor, ignored)   ! the run that held the lock has just ended and removed the file
    end do
  end subroutine take

  !> Release the lock, if it was taken.
  subroutine release(self)
    class(case_lock_t), intent(inout) :: self
    integer :: ignored
    if (self%descriptor < 0) return
    call remove_file(self%path, ignored)  ! removed before the lock is released, so that a waiting run finds that the file has no
                                          ! name any more
    call close_file(self%descriptor, ignored)
    self%descriptor = -1
  end subroutine release
end module case_lock
