!> The energy in long runs, in runs with large tolerance and in unusual runs: errors that accumulate in the crank or in the work of
!> the forces.
module test_energy_kept
  use kinds, only: dp
  use checks, only: checks_t
  use case_definition, only: case_t
  use result_notes, only: energy_warning
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_energy_kept

  integer, parameter :: long = 60

contains

  subroutine run_test_energy_kept(check)
    class(checks_t), intent(inout) :: check
    call a_long_ideal_run_ends_where_it_should(check)
    call a_film_that_collapses(check)
    call a_thrown_pin_where_the_crank_hardly_turns(check)
    call no_step_over_revolutions(check)
    call poor_energy_is_told(check)
  end subroutine run_test_energy_kept

  !> The ideal twin of simulation VI after 100 revolutions, against another method at a hundredth of the tolerance.
  subroutine a_long_ideal_run_ends_where_it_should(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: span(4) = [character(len=long) :: 'integrator.revolutions=100', &
      'output.samples_per_revolution=2', 'integrator.method=adams', 'integrator.relative_tolerance=1e-6']
    character(len=long) :: finer(4)
    type(trace_t) :: trace, fine
    real(dp), allocatable :: speed(:), fine_speed(:)
    finer = span
    finer(3:4) = [character(len=long) :: 'integrator.method=radau', 'integrator.relative_tolerance=1e-8']
    trace = run_case('cases/sim_VI.nml', span, .true.)
    fine = run_case('cases/sim_VI.nml', finer, .true.)
    call check%equal_text(trace%report%status, 'done', 'the ideal twin of simulation VI runs 100 revolutions')
    speed = trace%values(column(trace, 'crank_speed[rad/s]'), :)
    fine_speed = fine%values(column(fine, 'crank_speed[rad/s]'), :)
    call check%that(size(speed) == 201, 'a row each half revolution')
    call check%close_to(maxval(abs(speed - fine_speed)/fine_speed), 0.0_dp, 1e-4_dp, &   ! 100 revolutions of 1e-6
      'crank speed of the ideal twin after 100 revolutions')
  end subroutine a_long_ideal_run_ends_where_it_should

  !> In a bearing with 1.7 mm of clearance the pin falls onto its film until the film thickness is a millionth of the clearance.
  !> Steps are shortened because trial states lie beyond the wall, where there is no film; the shortened steps must not be taken for
  !> accurate.
  subroutine a_film_that_collapses(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: collapse(8) = [character(len=long) :: 'joint.clearance=0.0017', &
      'integrator.revolutions=0', 'integrator.end_time=1.2e-3', 'output.interval=1.2e-3', 'integrator.relative_tolerance=1e-4', &
      'integrator.method=adams', 'combustion.heat=165', 'output.ideal_twin=F']
    type(trace_t) :: trace
    trace = run_case('cases/sim_V.nml', collapse)
    call check%equal_text(trace%report%status, 'done', 'a film that collapses')
    call check%that(trace%report%figures%max_energy_residual < 3e-3_dp*trace%report%figures%max_energy, &
      'energy of a film that collapses is the work done')
  end subroutine a_film_that_collapses

  !> The pin starts with 0.5 m/s across a clearance of 0.1 mm, and the crank hardly turns: the pin moves straight and comes into
  !> contact after 0.2 ms. Its speed and energy need scales that do not come from the crank.
  subroutine a_thrown_pin_where_the_crank_hardly_turns(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: thrown(7)
    character(len=5), parameter :: speeds(3) = ['1e-3 ', '1e-5 ', '1e-12']
    character(len=5), parameter :: tolerances(2) = ['1e-6 ', '1e-10']
    type(trace_t) :: trace
    integer :: i, k
    thrown = [character(len=long) :: 'initial.eccentricity_rate=0.5,0', 'integrator.revolutions=0', &
      'integrator.end_time=5e-4', 'output.interval=1e-4', '', '', '']
    do i = 1, size(speeds)
      do k = 1, size(tolerances)
        thrown(5) = 'initial.crank_speed='//speeds(i)
        thrown(6) = 'integrator.relative_tolerance='//tolerances(k)
        thrown(7) = 'integrator.method=auto'
        trace = run_case('cases/flores/dry_0100um.nml', thrown)
        call check%equal_text(trace%report%status, 'done', 'a pin in free flight: '//speeds(i)//' rad/s, tolerance '//tolerances(k))
        if (size(trace%event) > 0) call check%relative(trace%event(1)%time, 2e-4_dp, 1e-5_dp, 'time of the contact')
      end do
    end do
  end subroutine a_thrown_pin_where_the_crank_hardly_turns

  !> The first step examines a thousandth of the run, here one revolution, after which all forces are the same again.
  subroutine no_step_over_revolutions(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/flores/ideal.nml', [character(len=long) :: 'integrator.revolutions=1000', &
      'integrator.relative_tolerance=1e-4', 'output.samples_per_revolution=1'])
    call check%that(trace%report%statistics%accepted > 10000, 'a thousand revolutions take more than ten steps each')
  end subroutine no_step_over_revolutions

  !> A residual of more than a hundred tolerances, because the given absolute tolerance is far larger than the relative one.
  subroutine poor_energy_is_told(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    type(case_t) :: case
    character(len=long) :: loose(2)
    loose = [character(len=long) :: 'integrator.relative_tolerance=1e-7', 'integrator.absolute_tolerance=3e-3']
    trace = run_case('cases/flores/ideal.nml', loose)
    call check%equal_text(trace%report%status, 'done', 'a run with a large residual is done')
    call check%that(trace%report%energy_is_poor, 'a run with a large residual reports it')
    case%integrator%relative_tolerance = 1e-7_dp
    call check%that(index(energy_warning(case, trace%report), 'relative tolerances') > 0, 'warning of a large residual')
    trace = run_case('cases/flores/ideal.nml', loose(:1))
    call check%that(.not. trace%report%energy_is_poor, 'a run at its tolerance reports no large residual')
  end subroutine poor_energy_is_told
end module test_energy_kept
