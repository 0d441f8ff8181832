!> Runs one case: builds its scene, integrates it, and hands rows, events and results to a sink.
module gudgeon_simulation
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, status_integration
  use case_definition, only: case_t
  use ode_method, only: ode_method_t, step_statistics_t, limit_stability, left_domain
  use gudgeon_methods, only: new_method
  use gudgeon_solver, only: integrate, silent_observer_t, integration_done, integration_stopped, integration_interrupted, &
    step_limit_reached, evaluation_limit_reached, unreadable_archive
  use gudgeon_scene, only: scene_t
  use stop_reason, only: reason, place, interrupted_text, revolution_budget_spent, crank_turned_back, turns_not_made, crank_creeps
  use scene_builder, only: build_scene, simulated_time, latest_end, longest_turn, sample_interval, settings_for
  use crank_turns, only: all_made, turned_back
  use gudgeon_columns, only: column_list_t
  use cycle_watch, only: cycle_watch_t
  use period_watch, only: period_watch_t
  use lyapunov, only: exponent_t, measure_exponent
  use gudgeon_recorder, only: recorder_t
  use run_figures, only: run_figures_t
  use film_snapshots, only: film_field_t
  use wear_record, only: wear_profile_t
  use trace_sink, only: trace_sink_t
  use gudgeon_constants, only: two_pi, degree
  use gudgeon_archive, only: archive_t
  implicit none
  private
  public :: simulate, try_auto, run_report_t, interrupted_text

  !> The results of a run that are known when it has ended.
  type :: run_report_t
    character(len=:), allocatable :: status      !! 'done', or a text that says why and where the run ended
    type(step_statistics_t) :: statistics
    type(run_figures_t) :: figures
    type(film_field_t), allocatable :: films(:)  !! pressure fields, if the case asks for them
    type(wear_profile_t), allocatable :: wear(:) !! worn surfaces, if the case asks for them
    real(dp), allocatable :: time_with(:, :)  !! method auto: time with Adams and with Radau, for each mode, (2, 0:highest mode) [s]
    logical :: can_go_on = .false.  !! the run was stopped from outside or by a limit, and its state was given to the sink
    logical :: energy_is_poor = .false.          !! the run is done, but the user must be told of its energy residual
    type(period_watch_t) :: periods              !! search for a periodic motion that ends the run
    type(exponent_t) :: exponent                 !! Lyapunov exponent, if it is requested
    real(dp) :: auto_saves = 0  !! > 0: evaluations of this run divided by those that method auto needs, as measured
  end type run_report_t

contains

  !> Run a case, or its ideal twin. `cycles`, the count of the revolutions of the crank, is moved into the run and returned at the
  !> end; if it is present, the impulse and the loss of the joint are integrated too. Errors: the scene cannot be built
  !> (status_case_file); the integration failed (status_integration; `report` and the sink then hold the results up to that
  !> instant). With an `archive` that an earlier run of the same case gave to its sink, that run is continued.
  subroutine simulate(case, ideal_joint, list, sink, report, error, archive, cycles)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(column_list_t), intent(in) :: list
    class(trace_sink_t), target, intent(inout) :: sink
    type(run_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(archive_t), intent(inout), optional :: archive
    type(cycle_watch_t), allocatable, intent(inout), optional :: cycles
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    type(recorder_t) :: recorder
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: status
    logical :: has_come_to_its_end

    call build_scene(case, ideal_joint, scene, error)
    if (.not. allocated(error)) call new_method(case%integrator%method, method, error)
    if (allocated(error)) return
    recorder%list = list
    if (case%output%sampling == 'crank_angle') then
      recorder%angles%per_revolution = case%output%samples_per_revolution
      recorder%angles%origin = case%output%angle_origin_deg*degree
    else
      recorder%interval = sample_interval(case)
    end if
    recorder%first_sample = case%output%start_time
    recorder%periods%is_on = case%run%is_until_periodic()
    recorder%periods%longest = case%run%period_revolutions
    recorder%periods%tolerance = case%run%periodic_tolerance
    recorder%periods%most_revolutions = case%run%most_revolutions
    recorder%periods%keeps_one_more = recorder%periods%is_on .and. case%output%window == 'last_period'
    recorder%end_time = latest_end(case)
    recorder%expected_end = simulated_time(case)
    recorder%patience%longest = longest_turn(case)
    recorder%every_step = case%output%every_step
    recorder%max_evaluations_per_revolution = case%integrator%max_evaluations_per_revolution
    recorder%revolution_time = two_pi/scene%speed_scale()
    recorder%sink => sink
    if (present(cycles)) then
      call scene%measure_joint()
      call move_alloc(cycles, recorder%cycles)
    end if

    method%settings = settings_for(case, scene)
    y = scene%initial_state()
    t = 0
    call recorder%prepare(scene)
    if (case%output%film_times /= '' .and. .not. ideal_joint) then
      allocate (recorder%films)
      call recorder%films%prepare(case%output%snapshot_times, scene)
    end if
    if (.not. present(archive)) call recorder%begin(scene, y)
    call integrate(scene, method, t, y, recorder%end_time, case%integrator%max_steps, recorder, status, archive)
    if (recorder%periods%has_ended) then
      status = integration_done
      t = recorder%periods%t
      y = recorder%periods%y
      call move_alloc(recorder%scene_at_end, scene)
    else if (recorder%patience%is_over) then
      status = crank_creeps
      t = recorder%figures%time
      call method%interpolate(t, y)
    else
      if (status == integration_interrupted .and. recorder%over_budget) status = revolution_budget_spent
      call judge_turns(scene, t, y, status)
    end if
    if (status /= unreadable_archive) call recorder%finish(scene, t, y)
    if (recorder%has_left) status = left_domain
    report%periods = recorder%periods
    has_come_to_its_end = status == integration_done
    if (status == integration_done .and. case%run%lyapunov_revolutions > 0 .and. .not. ideal_joint) then
      call measure_exponent(case, scene, t, y, report%periods%period, sink, report%exponent)
      if (.not. report%exponent%is_known .and. sink%wants_to_stop) status = integration_interrupted
    end if
    if (present(cycles)) call move_alloc(recorder%cycles, cycles)
    report%statistics = method%totals()
    if (allocated(method%time_with)) report%time_with = method%time_with
    report%figures = recorder%figures
    report%wear = recorder%wear(scene)
    if (allocated(recorder%films)) report%films = recorder%films%fields(scene)
    report%can_go_on = any(status == [integration_interrupted, step_limit_reached, evaluation_limit_reached, &
      revolution_budget_spent]) .and. .not. has_come_to_its_end
    if (status == integration_done .and. case%integrator%method == 'adams' .and. .not. (ideal_joint .or. present(cycles))) &
      call measure_auto(case, report)
    !$omp critical (texts)
    report%status = 'done'
    if (status /= integration_done) then
      report%status = reason(status, scene, method%settings, t, y)//' at '//place(scene, t, y)
      call fail(error, report%status, status_integration)
    else if (.not. report%figures%max_energy_residual <= report%figures%max_energy* &
             energy_limit(case%integrator%relative_tolerance, report%figures%crank_travel)) then
      report%status = 'energy not kept: the residual is beyond its limit, so the results are wrong; run to '//place(scene, t, y)
      call fail(error, report%status, status_integration)
    else
      report%energy_is_poor = report%figures%max_energy_residual > report%figures%max_energy* &
        remarkable_residual(case%integrator%relative_tolerance)
    end if
    !$omp end critical (texts)
  end subroutine simulate

  !> Energy residual, relative to the largest energy, from which the user of a completed run is told: 1e-3, which is visible in
  !> results, or a hundred tolerances, which at most 1 in 1000 extreme scenes reach. A residual up to 1e-10 may be rounding.
  pure real(dp) function remarkable_residual(tolerance)
    real(dp), intent(in) :: tolerance      !! relative
    remarkable_residual = max(1e-10_dp, min(1e-3_dp, 100*tolerance))
  end function remarkable_residual

  !> Check whether the crank has made the turns that are to end the run.
  subroutine judge_turns(scene, t, y, status)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    integer, intent(inout) :: status
    real(dp), parameter :: rounding = 1e-12_dp   !! the latest end of the run may coincide with them
    if (.not. allocated(scene%turns)) return
    select case (status)
    case (integration_stopped)
      if (scene%turns%outcome == all_made) status = integration_done
      if (scene%turns%outcome == turned_back) status = crank_turned_back
    case (integration_done)
      if (scene%turns%made(scene%crank_angle(t, y)) < scene%turns%wanted*(1 - rounding)) status = turns_not_made
    end select
  end subroutine judge_turns

  !> Largest energy residual of a completed run, relative to the largest energy: ten tolerances for each revolution, since local
  !> errors add up, and at least a thousand tolerances. Of 1767 extreme scenes that ended, half stay below 0.003 tolerances and 99.5
  !> % below 46; 10^4 revolutions of simulation V reach 1250 (tests/README.md). The limit is never above 5 %, which makes any result
  !> useless, and never below 1e-10, which may be rounding.
  pure real(dp) function energy_limit(tolerance, crank_travel)
    real(dp), intent(in) :: tolerance      !! relative
    real(dp), intent(in) :: crank_travel   !! [rad]
    energy_limit = min(0.05_dp, max(1e-10_dp, 1e3_dp*tolerance*max(1.0_dp, abs(crank_travel)/(100*two_pi))))
  end function energy_limit

  !> After an Adams run that was limited by stability for most of its time: measure how many more evaluations it took than method
  !> auto.
  subroutine measure_auto(case, report)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(inout) :: report
    integer :: needed
    real(dp) :: time
    if (report%statistics%time_limited_by(limit_stability) < 0.5_dp*report%figures%time) return
    time = latest_end(case)
    if (report%periods%is_on) time = report%figures%time
    call try_auto(case, time, report%statistics%accepted/10 + 1, needed)
    if (needed > 0) report%auto_saves = real(report%statistics%evaluations, dp)/needed
  end subroutine measure_auto

  !> Number of evaluations that method auto needs to run a case up to a time [s], measured by a run without output; 0 if it does not
  !> reach that time in `max_steps` steps.
  subroutine try_auto(case, time, max_steps, evaluations)
    type(case_t), intent(in) :: case
    real(dp), intent(in) :: time
    integer, intent(in) :: max_steps
    integer, intent(out) :: evaluations
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    type(silent_observer_t) :: observer
    type(step_statistics_t) :: needed
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: status

    evaluations = 0
    call build_scene(case, .false., scene, error)
    if (.not. allocated(error)) call new_method('auto', method, error)
    if (allocated(error)) return
    method%settings = settings_for(case, scene)
    allocate (y(scene%n), source=scene%initial_state())
    t = 0
    call integrate(scene, method, t, y, time, max_steps, observer, status)
    needed = method%totals()
    if (status == integration_done .or. status == integration_stopped) evaluations = needed%evaluations
  end subroutine try_auto
end module gudgeon_simulation
