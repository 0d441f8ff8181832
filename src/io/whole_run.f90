!> Goes on with a run to its end, unless the user interrupts.
module whole_run
  use kinds, only: dp
  use simulation, only: run_t
  use posix_files, only: interrupted
  use run_progress, only: clock
  implicit none
  private
  public :: go_to_end, go_on

contains

  subroutine go_to_end(run, was_interrupted)
    type(run_t), intent(inout) :: run
    logical, intent(out) :: was_interrupted   !! the run has been stopped before its end
    integer :: steps
    was_interrupted = .false.
    steps = 1
    do while (.not. run%is_over)
      call go_on(run, steps, was_interrupted)
    end do
  end subroutine go_to_end

  !> Go on through some steps, so few that the user hardly waits, and stop if the user has interrupted.
  subroutine go_on(run, steps, was_interrupted)
    type(run_t), intent(inout) :: run
    integer, intent(inout) :: steps            !! number of steps, on return that for the next call; at first 1
    logical, intent(out) :: was_interrupted    !! the run has been stopped before its end
    integer, parameter :: most_steps = 100
    real(dp), parameter :: longest = 0.1_dp   !! [s] of the clock
    real(dp) :: began
    began = clock()
    call run%advance(huge(1.0_dp), steps)
    steps = merge(1, min(2*steps, most_steps), clock() - began > longest)
    was_interrupted = .false.
    if (.not. run%is_over) was_interrupted = interrupted()
    if (was_interrupted) call run%stop()
  end subroutine go_on
end module whole_run
