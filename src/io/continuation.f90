!> What `--resume` finds of an earlier run of a case.
module continuation
  use kinds, only: dp
  use errors, only: error_t, fail, status_case_file
  use checkpoint, only: checkpoint_t, program_build, compare_cases, read_whole, restart_hint
  use text_tools, only: printable
  implicit none
  private
  public :: continuation_t

  character(len=*), parameter :: newline = achar(10)

  !> Where a run is to begin: at its beginning, unless one of these holds.
  type :: continuation_t
    logical :: goes_on = .false.     !! from the checkpoint
    logical :: is_done = .false.     !! nothing is left to do
    real(dp) :: interval = 0         !! between checkpoints [s]; 0: none
    type(checkpoint_t) :: checkpoint
  contains
    procedure :: look_for
  end type continuation_t

contains

  !> Look for the checkpoint of the results BASE, else for a run that is done. Errors: the checkpoint is damaged, or belongs
  !> to another program or another case.
  subroutine look_for(self, base, file, case_text, error)
    class(continuation_t), intent(inout) :: self
    character(len=*), intent(in) :: base, file   !! path of the results without their endings; of the case
    character(len=*), intent(in) :: case_text    !! the resolved case
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: difference, text
    integer :: status

    self%checkpoint%path = base//'.checkpoint'
    call self%checkpoint%load(program_build(), self%goes_on, error)
    if (allocated(error)) return
    if (self%goes_on) then
      call compare_cases(case_text, self%checkpoint%case_text, difference)
      if (difference /= '') call fail(error, printable(file, 200)//': '//difference//restart_hint, status_case_file)
    else
      call read_whole(base//'.resolved.nml', text, status)
      call compare_cases(case_text, text, difference)
      if (status /= 0 .or. difference /= '') return
      call read_whole(base//'.summary.csv', text, status)
      self%is_done = index(text, newline//'status,"done",') > 0
    end if
  end subroutine look_for
end module continuation
