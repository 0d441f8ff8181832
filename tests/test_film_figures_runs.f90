!> Results of films besides their force, in whole runs: with the energy that the bodies lose, as columns, in a mixed film.
module test_film_figures_runs
  use kinds, only: dp
  use checks, only: checks_t
  use simulation, only: run_report_t
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_film_figures_runs

  character(len=80), parameter :: small(3) = [character(len=60) :: 'lubrication.table_points=33', 'lubrication.film_points=64', &
    'lubrication.cavitation=gumbel']

contains

  subroutine run_test_film_figures_runs(check)
    class(checks_t), intent(inout) :: check
    call energy_lost_by_the_bodies(check)
    call energy_lost_without_moment(check)
    call columns_on_request(check)
    call mixed_film_and_crank_pin(check)
  end subroutine run_test_film_figures_runs

  !> If nothing else dissipates energy, the bodies lose the energy that the film dissipates.
  subroutine energy_lost_by_the_bodies(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/film/sim_I_finite.nml', [character(len=80) :: 'lubrication.report=.true.', &
      'integrator.revolutions=0.6', 'output.columns=standard,film_power,max_film_pressure,film_side_flow', small])
    call check%that(.not. allocated(trace%error), 'a run with the figures of its film')
    if (allocated(trace%error)) return
    associate (energy => trace%values(column(trace, 'energy[J]'), :), report => trace%report)
      call check%relative(kept(report, 'film_energy_lost'), energy(1) - energy(size(energy)), 1e-4_dp, &
        'loss of the film is that of the bodies')
      call check%relative(sum(trace%values(column(trace, 'film_power[W]'), :))*trace%values(1, 2), &
        kept(report, 'film_energy_lost'), 2e-2_dp, 'integral of the power in the rows')
      call check%relative(sum(trace%values(column(trace, 'film_side_flow[m3/s]'), :))*trace%values(1, 2), &
        kept(report, 'mean_film_side_flow')*report%figures%time, 2e-2_dp, 'integral of the flow in the rows')
      call check%that(kept(report, 'max_film_pressure') >= maxval(trace%values(column(trace, 'max_film_pressure[Pa]'), :)), &
        'no row is above the largest pressure')
      call check%relative(kept(report, 'max_film_pressure'), maxval(trace%values(column(trace, 'max_film_pressure[Pa]'), :)), &
        2e-2_dp, 'a row is near the largest pressure')
      call check%that(minval(trace%values(column(trace, 'film_power[W]'), :)) > 0, 'the film always dissipates power')
    end associate
  end subroutine energy_lost_by_the_bodies

  !> Without the film moment the film takes the work of its pressure alone; the shear that does not act has names of its own. Both
  !> together never give energy.
  subroutine energy_lost_without_moment(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_I.nml', [character(len=100) :: 'lubrication.report=.true.', 'integrator.method=auto', &
      'integrator.revolutions=0.5', 'output.ideal_twin=.false.', &
      'output.columns=standard,film_power,neglected_shear_moment,neglected_shear_power,max_film_pressure'])
    call check%that(.not. allocated(trace%error), 'a long film with its figures')
    if (allocated(trace%error)) return
    associate (energy => trace%values(column(trace, 'energy[J]'), :), report => trace%report, &
               moment => trace%values(column(trace, 'neglected_shear_moment[N.m]'), :), &
               power => trace%values(column(trace, 'film_power[W]'), :), &
               neglected => trace%values(column(trace, 'neglected_shear_power[W]'), :), &
               rod_speed => trace%values(column(trace, 'rod_speed[rad/s]'), :))
      call check%relative(kept(report, 'film_energy_lost'), energy(1) - energy(size(energy)), 1e-4_dp, &
        'loss of a film without moment is that of the bodies')
      call check%relative(sum(power)*trace%values(1, 2), kept(report, 'film_energy_lost'), 2e-2_dp, &
        'integral of the power in the rows, without moment')
      call check%relative(kept(report, 'neglected_shear_loss'), sum(moment*rod_speed)*trace%values(1, 2), 2e-2_dp, &
        'loss by shear that does not act')
      call check%that(all(abs(neglected - moment*rod_speed) <= 1e-12_dp*maxval(neglected)), 'power of shear that does not act')
      call check%that(kept(report, 'neglected_shear_loss') > 0.01_dp*kept(report, 'film_energy_lost'), &
        'the shear would have a share of the loss')
      call check%that(minval(power + neglected) > 0, 'pressure and shear of the long film together always dissipate power')
      call check%that(kept(report, 'max_film_pressure') > 1e6_dp, 'the long film has a pressure')
    end associate
    trace = run_case('cases/joints/both_pins_lubricated.nml', [character(len=80) :: 'lubrication.report=.true.', &
      'integrator.revolutions=2'])
    call check%that(.not. allocated(trace%error), 'two films without moment')
    if (allocated(trace%error)) return
    associate (energy => trace%values(column(trace, 'energy[J]'), :), report => trace%report)
      call check%relative(kept(report, 'film_energy_lost') + kept(report, 'crank_pin_film_energy_lost'), &
        energy(1) - energy(size(energy)), 1e-4_dp, 'loss of two films without moment is that of the bodies')
    end associate
    trace = run_case('cases/film/sim_I_finite.nml', [character(len=80) :: 'output.columns=neglected_shear_power'])
    call check%that(allocated(trace%error), 'shear that acts is not neglected')
  end subroutine energy_lost_without_moment

  !> Columns that need additional computation exist only if they are requested.
  subroutine columns_on_request(check)
    class(checks_t), intent(inout) :: check
    character(len=80), parameter :: run(3) = [character(len=60) :: 'integrator.revolutions=0.01', 'lubrication.variant=short', &
      'output.samples_per_revolution=200']
    type(trace_t) :: standard, more, one
    standard = run_case('cases/film/sim_I_finite.nml', run)
    more = run_case('cases/film/sim_I_finite.nml', [character(len=80) :: run, 'output.columns=standard,film_power'])
    one = run_case('cases/film/sim_I_finite.nml', [character(len=80) :: run, 'output.columns=film_side_flow,time'])
    call check%that(.not. any(standard%names == 'film_power[W]') .and. any(standard%names == 'film_moment[N.m]'), &
      'power is not a standard column')
    call check%that(size(more%names) == size(standard%names) + 1 .and. &
      any(more%names == 'film_power[W]'), 'power is a column if it is named')
    call check%that(size(one%names) == 2 .and. any(one%names == 'film_side_flow[m3/s]'), &
      'power can be a column without the standard ones')
    more = run_case('cases/sim_I.nml', [character(len=80) :: 'output.columns=film_side_flow'])
    call check%that(allocated(more%error), 'a side flow of a long bearing is refused')
    more = run_case('cases/sim_I_oscillating.nml', [character(len=80) :: 'output.columns=max_film_pressure'])
    call check%that(allocated(more%error), 'a pressure of the oscillating film is refused')
  end subroutine columns_on_request

  !> The film between rough surfaces is that of their mean gap; at a crank pin both bodies rotate.
  subroutine mixed_film_and_crank_pin(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/film/sim_IV_mixed.nml', [character(len=80) :: 'lubrication.report=.true.', &
      'integrator.revolutions=0.2', 'initial.crank_angle_deg=330', 'lubrication.variant=short', &
      'output.columns=standard,film_power,max_film_pressure'])
    call check%that(.not. allocated(trace%error), 'a mixed film with its figures')
    if (allocated(trace%error)) return
    call check%that(minval(trace%values(column(trace, 'film_power[W]'), :)) > 0, 'a film of rough surfaces dissipates power')
    trace = run_case('cases/film/sim_IV_mixed.nml', [character(len=80) :: 'lubrication.report=.true.', &
      'integrator.revolutions=0.01', 'initial.eccentricity=20.1e-6,0', 'lubrication.variant=short'])
    call check%that(.not. allocated(trace%error), 'a mixed film beyond the clearance')
    if (allocated(trace%error)) return
    call check%that(trace%report%figures%pin(2)%max_film_pressure < 1e12_dp, &
      'a mixed film beyond the clearance has a finite pressure')
    trace = run_case('cases/joints/both_pins_lubricated.nml', [character(len=80) :: 'lubrication.report=.true.', &
      'integrator.revolutions=0.3', 'lubrication.film_moment=.true.', 'integrator.method=auto'])
    call check%that(.not. allocated(trace%error), 'two films with their figures')
    if (allocated(trace%error)) return
    associate (energy => trace%values(column(trace, 'energy[J]'), :), report => trace%report)
      call check%relative(kept(report, 'film_energy_lost') + kept(report, 'crank_pin_film_energy_lost'), &
        energy(1) - energy(size(energy)), 1e-4_dp, 'loss of two films is that of the bodies')
    end associate
  end subroutine mixed_film_and_crank_pin

  !> A result that is kept of a column.
  real(dp) function kept(report, name)
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: name
    logical :: is_known
    call report%value_of(name, kept, is_known)
  end function kept
end module test_film_figures_runs
