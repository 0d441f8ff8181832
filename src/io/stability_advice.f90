!> Advice for runs whose step size is limited by the stability of the Adams method and not by accuracy: during the run if it would
!> take long, otherwise at its end.
module stability_advice
  use gudgeon_kinds, only: dp
  use ode_method, only: step_statistics_t, limit_stability
  use case_definition, only: case_t
  use gudgeon_simulation, only: try_auto
  use gudgeon_progress, only: progress_t, duration_text
  use text_tools, only: integer_text, printable
  implicit none
  private
  public :: stability_advice_t, advice

  real(dp), parameter :: first_look = 0.3_dp   !! running time before the first test [s]
  real(dp), parameter :: patience = 5          !! no advice if the remaining time is shorter [s]
  real(dp), parameter :: worth_it = 3  !! smallest ratio of evaluations for which a change of method during the run is recommended

  !> The advice for one run.
  type :: stability_advice_t
    type(case_t), allocatable :: case   !! not allocated: no advice is given
    logical :: was_given = .false.
    logical, private :: has_looked = .false.
  contains
    procedure :: consider
  end type stability_advice_t

contains

  !> Report that a run has reached `time` of `end_time` [s] after `elapsed` seconds. Once, if stability has limited most of it and
  !> the remaining time is long, measure what method auto would need up to this time, and print the result on standard error.
  subroutine consider(self, time, end_time, elapsed, statistics, progress)
    class(stability_advice_t), intent(inout) :: self
    real(dp), intent(in) :: time, end_time, elapsed
    type(step_statistics_t), intent(in) :: statistics   !! for the run so far
    type(progress_t), intent(inout) :: progress         !! progress line of the run, which is cleared first
    real(dp) :: to_go
    integer :: needed
    if (self%has_looked .or. .not. allocated(self%case) .or. elapsed < first_look) return
    if (.not. statistics%time_limited_by(limit_stability) > 0.5_dp*time) return
    to_go = elapsed*(end_time/time - 1)
    if (to_go < patience) return
    self%has_looked = .true.
    call try_auto(self%case, time, statistics%accepted/10 + 1, needed)
    if (needed == 0 .or. statistics%evaluations < worth_it*needed) return
    self%was_given = .true.
    call progress%tell(printable(self%case%file, 200)//': about '//duration_text(to_go)//' left; '// &
      advice(real(statistics%evaluations, dp)/needed)//' so far (--set integrator.method=auto)')
  end subroutine consider

  !> Text for the user of a run that took `ratio` times the evaluations of method auto, or an empty text.
  function advice(ratio) result(text)
    real(dp), intent(in) :: ratio
    character(len=:), allocatable :: text
    text = ''
    if (ratio > 1.5_dp) text = "the stability of Adams, not its accuracy, limits the steps (stiff film, contact or friction): "// &
      "method = 'auto' needs 1/"//integer_text(nint(ratio))//" of the evaluations"
  end function advice
end module stability_advice
