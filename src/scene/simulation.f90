!> A run of one case, which can pause: builds its scene, integrates it, hands rows and events to a sink, and reports its results.
module simulation
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_integration
  use run_state, only: run_state_t
  use case_definition, only: case_t
  use ode_method, only: ode_method_t, step_statistics_t, left_domain
  use ode_methods, only: new_method
  use ode_solver, only: integration_t, integration_done, integration_stopped, &
    integration_interrupted, step_limit_reached, evaluation_limit_reached
  use scene_problem, only: scene_t, evaluation_t
  use scene_inputs, only: inputs, inputs_of, input_value, change_input
  use inside_step, only: evaluate_inside
  use stop_reason, only: reason, place, interrupted_text, revolution_budget_spent, crank_turned_back, turns_not_made, crank_creeps
  use scene_builder, only: build_scene, simulated_time, settings_for
  use crank_turns, only: all_made, turned_back
  use trace_columns, only: column_list_t, all_columns
  use cycle_watch, only: cycle_watch_t
  use cycle_answers, only: answer_t, find_answers, cycle_quantities
  use period_watch, only: period_watch_t
  use lyapunov, only: exponent_t, measurement_t
  use run_recorder, only: recorder_t
  use run_start, only: find_start
  use run_figures, only: run_figures_t
  use film_snapshots, only: film_field_t, skirt_field_t
  use history_record, only: history_record_t
  use joint_places, only: n_places, in_order, spot_prefix
  use wear_record, only: wear_profile_t
  use train_record, only: train_result_t
  use result_ledger, only: kept_result_t, find_result
  use trace_sink, only: trace_sink_t
  use constants, only: two_pi
  implicit none
  private
  public :: simulate, run_t, run_report_t, interrupted_text

  !> The results of a run that are known when it has ended.
  type :: run_report_t
    character(len=:), allocatable :: status      !! 'done', or a text that says why and where the run ended
    type(step_statistics_t) :: statistics
    type(run_figures_t) :: figures
    type(film_field_t), allocatable :: films(:)  !! pressure fields, if the case asks for them
    type(skirt_field_t), allocatable :: skirt(:) !! those of the skirt
    type(history_record_t), allocatable :: histories(:)  !! films with memory, to be marched, if the case asks for them
    type(wear_profile_t), allocatable :: wear(:) !! worn surfaces, if the case asks for them
    real(dp), allocatable :: time_with(:, :)  !! method auto: time with Adams and with Radau, for each mode, (2, 0:highest mode) [s]
    logical :: can_go_on = .false.  !! the run was stopped from outside or by a limit
    logical :: energy_is_poor = .false.          !! the run is done, but the user must be told of its energy residual
    logical :: heat_is_poor = .false.            !! the same of the heat of a film
    logical :: gas_is_poor = .false.             !! the same of the energy of the gas
    type(period_watch_t) :: periods              !! search for a periodic motion that ends the run
    type(answer_t), allocatable :: answers(:)    !! of the last whole cycle, if the case asks for them
    type(train_result_t), allocatable :: train(:)    !! of several cylinders on one crankshaft
    type(kept_result_t), allocatable :: kept(:)      !! results that are kept of columns
    type(exponent_t) :: exponent                 !! Lyapunov exponent, if it is requested
  contains
    procedure :: value_of
    procedure :: text_of
  end type run_report_t

  !> A run under way. Call `begin`, `advance` until `is_over` or as far as wanted, and `finish`. Copies continue independently of
  !> each other once `recorder%sink` of each has been set to a sink of its own.
  type :: run_t
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    type(recorder_t) :: recorder
    type(integration_t) :: integration
    real(dp) :: t = 0                     !! time reached [s]
    logical :: is_over = .false.          !! the run has ended
    type(case_t), private :: case
    logical, private :: ideal_joint = .false., has_cycles = .false.
    logical, private :: has_ended = .false.   !! the integration has ended; perhaps the exponent is being measured
    integer, private :: status = integration_done
    integer, allocatable :: inputs(:)          !! inputs of the scene, as indices into `inputs` of scene_inputs
    real(dp), allocatable, private :: input(:)      !! their values from the next advance on
    logical, private :: has_new_input = .false.
    real(dp), private :: ramp_end = huge(1.0_dp)    !! an input changes linearly until this time [s]
    type(run_report_t), private :: report
    type(measurement_t), allocatable, private :: measurement   !! of the Lyapunov exponent, after the integration
  contains
    procedure :: begin
    procedure :: advance
    procedure :: evaluate_row
    procedure :: state
    procedure :: stop
    procedure :: set_input
    procedure :: wanted_input
    procedure :: is_complete
    procedure :: expected_end
    procedure :: finish
  end type run_t

contains

  !> A result that is kept of a column, or an answer of the last cycle; `is_known` is false if the run does not have it.
  pure subroutine value_of(self, name, value, is_known)
    class(run_report_t), intent(in) :: self
    character(len=*), intent(in) :: name   !! with the prefix of its place
    real(dp), intent(out) :: value
    logical, intent(out) :: is_known
    integer :: i
    value = 0
    is_known = .false.
    if (.not. allocated(self%kept)) return
    call find_result(self%kept, name, value, is_known)
    if (is_known) return
    do i = 1, size(self%answers)
      associate (it => self%answers(i))
        if (it%text /= '') cycle
        if (it%place > 0) then
          if (trim(spot_prefix(it%place))//cycle_quantities(it%quantity)%name /= name) cycle
        else if (cycle_quantities(it%quantity)%name /= name) then
          cycle
        end if
        value = it%value
        is_known = .true.
      end associate
    end do
  end subroutine value_of

  !> An answer of the last cycle that is a text; empty if the run does not have it.
  pure function text_of(self, name) result(text)
    class(run_report_t), intent(in) :: self
    character(len=*), intent(in) :: name   !! of an answer of the machine
    character(len=len(self%answers%text)) :: text
    integer :: i
    text = ''
    if (.not. allocated(self%answers)) return
    do i = 1, size(self%answers)
      if (cycle_quantities(self%answers(i)%quantity)%name == name) text = self%answers(i)%text
    end do
  end function text_of

  !> Run a case, or its ideal twin, from its start to its end. `cycles`, the count of the revolutions of the crank, is moved into
  !> the run and returned at the end; if it is present, the impulse and the loss of the joint are integrated too. Errors: the scene
  !> cannot be built (status_case_file); the integration failed (status_integration; `report` and the sink then hold the results up
  !> to that instant).
  subroutine simulate(case, ideal_joint, list, sink, report, error, cycles)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(column_list_t), intent(in) :: list
    class(trace_sink_t), target, intent(inout) :: sink
    type(run_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(cycle_watch_t), allocatable, intent(inout), optional :: cycles
    type(run_t) :: run
    call run%begin(case, ideal_joint, list, sink, error, cycles)
    if (allocated(error)) return
    call run%advance(huge(1.0_dp), 0)
    call run%finish(report, error, cycles)
  end subroutine simulate

  !> Begin a run: the arguments are those of `simulate`. Error: the scene cannot be built (status_case_file).
  subroutine begin(self, case, ideal_joint, list, sink, error, cycles)
    class(run_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(column_list_t), intent(in) :: list
    class(trace_sink_t), target, intent(inout) :: sink
    type(error_t), allocatable, intent(out) :: error
    type(cycle_watch_t), allocatable, intent(inout), optional :: cycles
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: i

    self%case = case
    self%ideal_joint = ideal_joint
    call build_scene(case, ideal_joint, self%scene, error)
    if (.not. allocated(error)) call new_method(case%integrator%method, self%method, error)
    if (allocated(error)) return
    associate (recorder => self%recorder, scene => self%scene)
      recorder%list = list
      if (.not. allocated(list%names)) call all_columns(case, ideal_joint, recorder%list)   ! no rows are wanted
      call recorder%rows%choose(case)
      call recorder%periods%choose(case)
      call recorder%limits%choose(case, two_pi/scene%speed_scale())
      recorder%sink => sink
      if (present(cycles)) self%has_cycles = allocated(cycles)
      if (self%has_cycles) then
        call scene%measure_joint()
        if (cycles%wants_answers) call scene%measure_works()
        call move_alloc(cycles, recorder%cycles)
      else if (case%output%answers .and. .not. ideal_joint) then
        allocate (recorder%cycles)
        call scene%measure_works()
      end if
      self%method%settings = settings_for(case, scene)
      call recorder%prepare(scene)
      call find_start(case, ideal_joint, scene, t, y, error, recorder)
      if (allocated(error)) return
      if (case%output%film_times /= '' .and. .not. ideal_joint) then
        allocate (recorder%films)
        call recorder%films%prepare(pack(case%output%snapshot_times, case%output%snapshot_times >= t), scene)
      end if
      if (.not. ideal_joint) call prepare_histories(case, recorder%histories)
      call recorder%begin(scene, t, y)
      self%t = t
      call self%integration%begin(scene, self%method, t, y, recorder%rows%end_time, case%integrator%max_steps)
      call inputs_of(scene, self%inputs)
      self%input = [(input_value(scene, self%inputs(i), t, y), i=1, size(self%inputs))]
    end associate
  end subroutine begin

  !> Prepare the records of the films with memory that a case asks for; none: not allocated.
  subroutine prepare_histories(case, histories)
    type(case_t), intent(in) :: case
    type(history_record_t), allocatable, intent(out) :: histories(:)
    integer, allocatable :: at(:)
    integer :: i
    allocate (at(0))
    do i = 1, n_places
      if (allocated(case%joints(in_order(i))%history%march)) at = [at, case%spots(in_order(i))]
    end do
    if (size(at) == 0) return
    allocate (histories(size(at)))
    do i = 1, size(at)
      call histories(i)%prepare(case, at(i))
    end do
  end subroutine prepare_histories

  !> Go on to time t [s], or through `most_steps` more steps (0: no limit), or to the end of the run if that comes first. Results
  !> do not depend on where a run pauses. After the end of the motion, the exponent is measured.
  subroutine advance(self, t, most_steps)
    class(run_t), intent(inout) :: self
    real(dp), intent(in) :: t
    integer, intent(in) :: most_steps
    real(dp) :: until
    logical :: jumps
    if (.not. (self%has_ended .or. self%is_over)) then
      do
        call accept_inputs(self, t)
        until = min(t, self%ramp_end)
        call self%integration%go_to(self%scene, self%method, self%recorder, until, most_steps)
        jumps = self%recorder%jumps%is_due
        if (jumps) call jump(self)
        self%t = self%integration%t
        if (self%integration%is_kept) self%t = until
        if (jumps .and. most_steps == 0 .and. .not. self%integration%is_over) cycle
        if (self%integration%is_over .or. most_steps > 0 .or. .not. until < t .or. self%t < until) exit
      end do
      if (self%integration%is_over) call conclude(self)
      if (most_steps > 0) return
    end if
    do while (self%has_ended .and. .not. self%is_over)
      call self%measurement%advance(most_steps)
      self%is_over = self%measurement%is_over
      if (most_steps > 0) return
    end do
  end subroutine advance

  !> Let temperatures of films jump, and go on from there.
  subroutine jump(self)
    class(run_t), intent(inout) :: self
    real(dp) :: t, y(self%scene%n)
    call self%recorder%jump(self%scene, t, y)
    call self%integration%go_on_from(self%scene, self%method, t, y)
  end subroutine jump

  !> Set input i of the run, which changes at the beginning of the next advance: to this value and held there, or linearly to this
  !> value at the end of that advance. The value that it has changes nothing.
  subroutine set_input(self, i, value)
    class(run_t), intent(inout) :: self
    integer, intent(in) :: i          !! index into self%inputs
    real(dp), intent(in) :: value     !! in the unit of the input
    if (abs(value - self%input(i)) > 0) self%has_new_input = .true.
    self%input(i) = value
  end subroutine set_input

  !> The value of input i that it has from the next advance on.
  pure real(dp) function wanted_input(self, i)
    class(run_t), intent(in) :: self
    integer, intent(in) :: i
    wanted_input = self%input(i)
  end function wanted_input

  !> Change the inputs that have new values, and end a linear change that has reached its end, before an advance to time t.
  subroutine accept_inputs(self, t)
    class(run_t), intent(inout) :: self
    real(dp), intent(in) :: t   !! [s]
    real(dp) :: until
    integer :: i
    if (.not. self%has_new_input .and. self%t < self%ramp_end) return
    until = min(t, self%recorder%rows%end_time)
    call self%integration%cut(self%scene, self%method, self%recorder, self%t)
    if (self%integration%is_over) return
    self%ramp_end = huge(1.0_dp)
    associate (y => self%integration%y)
      do i = 1, size(self%inputs)
        call change_input(self%scene, self%inputs(i), self%input(i), self%t, y, until)
        if (inputs(self%inputs(i))%is_ramp .and. abs(input_value(self%scene, self%inputs(i), self%t, y) - self%input(i)) > 0) &
          self%ramp_end = until
      end do
    end associate
    self%has_new_input = .false.
    call self%integration%restart(self%scene, self%method)
  end subroutine accept_inputs

  !> Whether the run has reached its end, rather than being stopped by a limit, by a failure or from outside.
  pure logical function is_complete(self)
    class(run_t), intent(in) :: self
    is_complete = self%is_over .and. self%status == integration_done
  end function is_complete

  !> The values of a row at the time reached. If the state there is not in the domain of the model, there are none.
  subroutine evaluate_row(self, values, in_domain)
    class(run_t), intent(inout) :: self
    real(dp), intent(out) :: values(:)   !! in the order of the list
    logical, intent(out) :: in_domain
    type(evaluation_t) :: now
    real(dp) :: y(self%scene%n)
    integer :: unused
    unused = 0
    if (self%integration%is_kept) then
      call evaluate_inside(self%scene, self%method, self%t, y, now, in_domain, unused)
    else
      y = self%integration%state(self%method)
      call self%scene%evaluate(self%t, y, now, in_domain)
    end if
    if (in_domain) call self%recorder%row(self%scene, self%t, y, now, values)
  end subroutine evaluate_row

  !> The state that the run has reached, from which another one may start. The run must not pause inside a step.
  subroutine state(self, list)
    class(run_t), intent(inout) :: self
    type(run_state_t), intent(out) :: list
    real(dp) :: t, y(self%scene%n)
    t = self%integration%t
    y = self%integration%y
    if (.not. self%has_ended) y = self%integration%state(self%method)
    allocate (list%numbers(0))
    call self%scene%declare(list, t, y)
    call self%recorder%declare(list, self%scene)
  end subroutine state

  !> End the run here, as interrupted: at the time of the pause, also inside a step.
  subroutine stop(self)
    class(run_t), intent(inout) :: self
    if (self%is_over) return
    if (self%integration%is_kept) then
      call self%integration%cut(self%scene, self%method, self%recorder, self%t)
      call self%integration%restart(self%scene, self%method)
    end if
    if (.not. self%has_ended) call conclude(self)
    self%status = integration_interrupted
    self%is_over = .true.
  end subroutine stop

  !> Expected end of the run [s]. If it ends after a number of turns, it is estimated from the mean speed so far.
  real(dp) function expected_end(self)
    class(run_t), intent(in) :: self
    expected_end = simulated_time(self%case)
    associate (travel => abs(self%recorder%extremes%figures%crank_travel))
      if (allocated(self%scene%turns) .and. travel > 0) &
        expected_end = min(self%recorder%rows%end_time, self%t*self%scene%turns%wanted*two_pi/travel)
    end associate
  end function expected_end

  !> The integration has ended: find out why, end the recording, and begin to measure the exponent if it is wanted.
  subroutine conclude(self)
    class(run_t), intent(inout) :: self
    call self%integration%finish(self%method)
    associate (recorder => self%recorder, t => self%integration%t, y => self%integration%y, status => self%status)
      status = self%integration%status
      if (.not. self%integration%is_over) status = integration_interrupted
      if (recorder%has_left) then
        t = recorder%extremes%figures%time
        call self%method%interpolate(t, y)
      else if (recorder%periods%has_ended) then
        status = integration_done
        t = recorder%periods%t
        y = recorder%state_at_end
        call move_alloc(recorder%scene_at_end, self%scene)
      else if (recorder%limits%turn_limit%is_over) then
        status = crank_creeps
        t = recorder%extremes%figures%time
        call self%method%interpolate(t, y)
      else
        if (status == integration_interrupted .and. recorder%limits%over_budget) status = revolution_budget_spent
        call judge_turns(self%scene, t, y, status)
      end if
      call recorder%finish(self%scene, t, y)
      if (recorder%has_left) status = left_domain
      self%t = t
      self%has_ended = .true.
      self%report%can_go_on = any(status == [integration_interrupted, step_limit_reached, evaluation_limit_reached, &
        revolution_budget_spent])
      self%is_over = status /= integration_done .or. self%case%run%lyapunov_revolutions == 0 .or. self%ideal_joint
      if (self%is_over) return
      allocate (self%measurement)
      call self%measurement%begin(self%case, self%scene, t, y, recorder%periods%period)
    end associate
  end subroutine conclude

  !> The results of a run that is over. Error: see `simulate`.
  subroutine finish(self, report, error, cycles)
    class(run_t), intent(inout) :: self
    type(run_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(cycle_watch_t), allocatable, intent(inout), optional :: cycles
    integer :: ended, revolutions
    call self%stop()   ! no effect if it is over
    report = self%report
    report%periods = self%recorder%periods
    if (allocated(self%measurement)) then
      call self%measurement%explain()
      report%exponent = self%measurement%exponent
    end if
    report%statistics = self%method%totals()
    if (allocated(self%method%time_with)) report%time_with = self%method%time_with
    report%figures = self%recorder%extremes%figures_of_run(self%scene, self%recorder%ledger)
    call self%recorder%extremes%find_wear(self%scene, report%wear)
    call find_last_cycle(self%recorder, ended, revolutions)
    report%kept = self%recorder%ledger%results(ended, revolutions)
    if (allocated(self%recorder%asked)) report%kept = [report%kept, self%recorder%asked%results(ended, revolutions)]
    allocate (report%answers(0))
    if (allocated(self%scene%parts)) report%answers = find_answers(self%scene, self%recorder%cycles, &
      self%recorder%periods, self%recorder%extremes, report%kept)
    if (allocated(self%scene%chain%train)) report%train = self%recorder%extremes%train%results(self%scene, ended, revolutions)
    if (self%has_cycles) call move_alloc(self%recorder%cycles, cycles)
    if (allocated(self%recorder%films)) then
      report%films = self%recorder%films%fields(self%scene)
      report%skirt = self%recorder%films%skirt_fields(self%scene)
    end if
    if (allocated(self%recorder%histories)) report%histories = self%recorder%histories
    associate (case => self%case, scene => self%scene, t => self%integration%t, y => self%integration%y)
      report%status = 'done'
      if (self%status /= integration_done) then
        report%status = reason(self%status, scene, self%method%settings, t, y)//' at '//place(scene, t, y)
        call fail(error, report%status, status_integration)
      else if (.not. report%figures%max_energy_residual <= report%figures%max_energy* &
               residual_limit(case%integrator%relative_tolerance, report%figures%crank_travel)) then
        report%status = 'energy not kept: the residual is beyond its limit, so the results are wrong; run to '//place(scene, t, y)
        call fail(error, report%status, status_integration)
      else if (.not. all(report%figures%pin%heat%relative_residual() <= &
               residual_limit(case%integrator%relative_tolerance, report%figures%crank_travel))) then
        call fail(error, 'heat of a film not kept: the residual is beyond its limit, so the results are wrong; run to '// &
          place(scene, t, y), status_integration)
        report%status = error%message
      else if (.not. report%figures%gas_residual <= &
               residual_limit(case%integrator%relative_tolerance, report%figures%crank_travel)) then
        call fail(error, 'energy of the gas not kept: the residual is beyond its limit, so the results are wrong; run to '// &
          place(scene, t, y), status_integration)
        report%status = error%message
      else
        report%energy_is_poor = report%figures%max_energy_residual > report%figures%max_energy* &
          remarkable_residual(case%integrator%relative_tolerance)
        report%heat_is_poor = report%figures%heat_residual() > &
          remarkable_residual(case%integrator%relative_tolerance)
        report%gas_is_poor = report%figures%gas_residual > remarkable_residual(case%integrator%relative_tolerance)
      end if
    end associate
  end subroutine finish

  !> Energy residual, relative to the largest energy, from which the user of a completed run is told: 1e-3, which is visible in
  !> results, or a hundred tolerances, which hardly any scene reaches. A residual up to 1e-10 may be rounding.
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
    case default   ! why the run has ended otherwise
    end select
  end subroutine judge_turns

  !> Largest residual of the energy of a completed run, relative to the largest energy, and of the heat of a film: ten tolerances
  !> for each revolution, since local errors add up, and at least a thousand tolerances, which hardly any scene reaches
  !> (data/manual/choices.md). The limit is never above 5 %, which makes any result useless, and never below 1e-10, which may be
  !> rounding.
  pure real(dp) function residual_limit(tolerance, crank_travel)
    real(dp), intent(in) :: tolerance      !! relative
    real(dp), intent(in) :: crank_travel   !! [rad]
    residual_limit = min(0.05_dp, max(1e-10_dp, 1e3_dp*tolerance*max(1.0_dp, abs(crank_travel)/(100*two_pi))))
  end function residual_limit

  !> Revolutions of the last whole cycle, 0 if there is none, and the number of the last one.
  subroutine find_last_cycle(recorder, ended, revolutions)
    type(recorder_t), intent(in) :: recorder
    integer, intent(out) :: ended, revolutions
    ended = 0
    revolutions = 0
    if (.not. allocated(recorder%cycles)) return
    ended = recorder%cycles%ended
    if (recorder%cycles%has_cycle(recorder%periods%cycle_revolutions())) revolutions = recorder%periods%cycle_revolutions()
  end subroutine find_last_cycle
end module simulation
