!> Goes on with a run to its end, unless the user interrupts.
module whole_run
  use kinds, only: dp
  use simulation, only: run_t
  use posix_files, only: interrupted
  implicit none
  private
  public :: go_to_end, steps_between_looks

  integer, parameter :: steps_between_looks = 100   !! after so many steps of a run, interruptions are looked for

contains

  subroutine go_to_end(run, was_interrupted)
    type(run_t), intent(inout) :: run
    logical, intent(out) :: was_interrupted   !! the run has been stopped before its end
    was_interrupted = .false.
    do while (.not. run%is_over)
      call run%advance(huge(1.0_dp), steps_between_looks)
      if (.not. run%is_over) was_interrupted = interrupted()
      if (was_interrupted) call run%stop()
    end do
  end subroutine go_to_end
end module whole_run
