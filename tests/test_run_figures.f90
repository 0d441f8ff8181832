!> The figures of a run: the time that each method has, and peaks between the steps.
module test_run_figures
  use kinds, only: dp
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case
  implicit none
  private
  public :: run_test_run_figures

  integer, parameter :: long = 60

contains

  subroutine run_test_run_figures(check)
    class(checks_t), intent(inout) :: check
    call all_time_is_counted_once(check, 'cases/sim_IV.nml', '0.95')
    call all_time_is_counted_once(check, 'cases/sim_IV_oscillating.nml', '0.95')
    call all_time_is_counted_once(check, 'cases/wiebe/wiebe_320.nml', '1.9')
    call all_time_is_counted_once(check, 'cases/flores/dry_0500um.nml', '0.7')
  end subroutine run_test_run_figures

  !> Steps are cut by contacts, by bounds of the gas cycle and by the end of the run: the times by method, and those by what
  !> limited the steps of Adams, sum to the time simulated, which is that of so many revolutions.
  subroutine all_time_is_counted_once(check, file, revolutions)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, revolutions
    type(trace_t) :: trace
    real(dp), parameter :: rounding = 1e-12_dp
    trace = run_case(file, [character(len=long) :: 'integrator.method=auto', 'integrator.revolutions='//revolutions])
    call check%that(.not. allocated(trace%error), file//' runs with auto')
    associate (s => trace%report%statistics, time => trace%report%figures%time)
      call check%that(s%restarts > 0, file//': some steps are cut by events')
      call check%relative(sum(s%time_with), time, rounding, file//': times by method and phase')
      call check%that(sum(s%time_with/time) <= 1 + rounding, file//': their fractions sum to no more than 1')
      call check%that(all(s%time_with >= 0), file//': and none is negative')
    end associate
    if (index(file, 'sim_IV.nml') > 0) return   ! 10^6 steps of Adams
    trace = run_case(file, [character(len=long) :: 'integrator.method=adams', 'integrator.revolutions='//revolutions])
    associate (s => trace%report%statistics, time => trace%report%figures%time)
      call check%relative(sum(s%time_limited_by), time, rounding, file//': times by what limited the steps')
    end associate
  end subroutine all_time_is_counted_once
end module test_run_figures
