!> The observer of a run: it leads each accepted step through the search for ends of revolutions and of the run, for rows that are
!> due and for extremes, and hands rows and events to a sink. The energy is checked at accepted points.
module run_recorder
  use kinds, only: dp
  use constants, only: two_pi
  use ode_problem, only: ode_problem_t
  use run_state, only: run_state_t
  use ode_method, only: ode_method_t
  use ode_solver, only: observer_t
  use scene_problem, only: scene_t, evaluation_t, event_none, event_contact_begins, of_guide, of_wear, of_reeds, &
    phase_contact
  use inside_step, only: evaluate_inside
  use trace_columns, only: column_list_t, row_values
  use row_times, only: row_times_t
  use revolutions, only: revolutions_t
  use period_watch, only: period_watch_t
  use cycle_watch, only: cycle_watch_t
  use temperature_jumps, only: temperature_jumps_t
  use run_extremes, only: run_extremes_t
  use run_limits, only: run_limits_t
  use result_ledger, only: ledger_t
  use trace_sink, only: trace_sink_t, trace_event_t
  use film_snapshots, only: film_snapshots_t
  use history_record, only: history_record_t
  implicit none
  private
  public :: recorder_t

  type, extends(observer_t) :: recorder_t
    type(column_list_t) :: list       !! columns of a row; empty: no rows are written
    class(trace_sink_t), pointer :: sink => null()
    type(row_times_t) :: rows         !! when they are due
    type(run_extremes_t) :: extremes
    type(ledger_t) :: ledger          !! results that are kept of columns
    type(ledger_t), allocatable :: asked   !! those that a study asks for, by themselves: they change no other
    type(run_limits_t) :: limits
    type(film_snapshots_t), allocatable :: films   !! pressure fields, if they are requested
    type(history_record_t), allocatable :: histories(:)   !! of films with memory, if they are requested
    type(revolutions_t) :: crank      !! revolutions, if they are followed
    type(cycle_watch_t), allocatable :: cycles     !! results of each revolution, if they are requested
    type(period_watch_t) :: periods   !! search for a periodic motion that ends the run
    type(temperature_jumps_t) :: jumps             !! of films that heat up, in such a run
    type(scene_t), allocatable :: scene_at_end     !! the scene at the end of that period, or at a jump
    real(dp), allocatable :: state_at_end(:)       !! the state then
    logical :: goes_on = .false.      !! the run goes on with the totals of another one
    logical :: has_left = .false.     !! the run is to end because the state of a row is outside the model
    real(dp), private :: initial_energy = 0, start_angle = 0
    real(dp), allocatable, private :: y(:), values(:)
  contains
    procedure :: prepare
    procedure :: declare
    procedure :: begin
    procedure :: step_accepted
    procedure :: event_accepted
    procedure :: event_handled
    procedure :: jump
    procedure :: finish
    procedure :: row
  end type recorder_t

contains

  !> Prepare for a scene that is ready to run. Must be called before the other procedures.
  subroutine prepare(self, scene)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    call self%extremes%prepare(scene)
    call self%ledger%prepare(self%list, self%list%kept)
    if (allocated(self%list%asked)) then
      allocate (self%asked)
      call self%asked%prepare(self%list, self%list%asked)
    end if
    allocate (self%y(scene%n), self%values(size(self%list%id)))
    if (self%periods%keeps_one_more) self%rows%first_sample = huge(1.0_dp)   ! no rows until the window begins
  end subroutine prepare

  !> Declare the totals so far, which belong to the summary of the run. With those of a list the run goes on.
  subroutine declare(self, list, scene)
    class(recorder_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(scene_t), intent(inout) :: scene
    list%of_totals = .true.
    call list%add('initial_energy', self%initial_energy, 'J', 'energy of the bodies at the start of the run')
    call self%extremes%declare(list, scene)
    call self%ledger%declare(list)
    list%of_totals = .false.
    self%goes_on = list%sets .and. list%goes_on
  end subroutine declare

  !> Record the state (t, y) with which the run begins, and write the first row if it is due.
  subroutine begin(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain, is_due

    call evaluate_scene(self, scene, t, y, now, in_domain)
    associate (f => self%extremes%figures)
      if (self%goes_on) then
        self%start_angle = scene%crank_angle(t, y) - f%crank_travel
        f%time = t
        call self%limits%turn_limit%begin(t, abs(f%crank_travel)/two_pi)
      else if (in_domain) then
        self%initial_energy = scene%energy(now)
        self%start_angle = now%motion%crank_angle
      end if
    end associate
    if (follows_revolutions(self)) then
      call self%crank%begin(scene, t, y, self%start_angle)
      call self%periods%begin(scene, t, y)
    end if
    if (allocated(self%cycles)) call self%cycles%begin(scene, t, y, now, in_domain, self%initial_energy, self%crank)
    if (in_domain .and. .not. self%goes_on) call record_first_contacts(self, scene, t, now)
    call self%extremes%begin(scene, t, now, in_domain, self%cycles)
    if (self%goes_on) call self%extremes%resume_contacts(scene, self%ledger)
    if (in_domain) call self%ledger%begin(scene, t, y, now, self%initial_energy)
    if (in_domain .and. allocated(self%asked)) call self%asked%begin(scene, t, y, now, self%initial_energy)
    call self%rows%begin(t, scene%crank_angle(t, y), is_due)
    call record_point(self, scene, t, y, now, in_domain, is_due)
  end subroutine begin

  !> Record the contacts with which the run begins.
  subroutine record_first_contacts(self, scene, t, now)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    integer :: i, joint
    do i = 1, size(scene%reported)
      joint = scene%joint_at(scene%reported(i))
      if (joint == 0) cycle
      if (scene%joints(joint)%phase == phase_contact) call record_event(self, joint, 0, event_contact_begins, scene, t, now)
    end do
    if (.not. allocated(scene%guide)) return
    do i = 1, merge(size(scene%guide%touches), 0, scene%guide%touching > 0)
      if (scene%guide%touches(i)) call record_event(self, of_guide, i, event_contact_begins, scene, t, now)
    end do
  end subroutine record_first_contacts

  !> Whether something is found out about each revolution.
  pure logical function follows_revolutions(self)
    class(recorder_t), intent(in) :: self
    follows_revolutions = self%periods%is_on .or. allocated(self%cycles)
  end function follows_revolutions

  subroutine step_accepted(self, method, problem, t_to)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: t_end

    select type (problem)
    class is (scene_t)
      t_end = t_to
      call self%limits%turn_limit%limit_end(t_end)
      if (follows_revolutions(self)) call follow_revolutions(self, method, problem, t_end)
      if (has_rows(self)) call write_rows(self, method, problem, t_end)
      if (allocated(self%films)) call self%films%record(method, problem, t_end, self%extremes%figures%evaluations)
      if (t_end < method%t) then
        call method%interpolate(t_end, self%y)
        call record_end(self, method, problem, t_end, self%y)
      else
        call record_end(self, method, problem, method%t, method%y)
      end if
    end select
    associate (f => self%extremes%figures)
      call self%limits%follow(f%time, f%crank_travel, method%statistics%evaluations)
    end associate
    self%wants_to_stop = self%limits%over_budget .or. self%has_left .or. self%periods%has_ended .or. self%jumps%is_due &
      .or. self%limits%turn_limit%is_over
  end subroutine step_accepted

  !> Find the ends of revolutions in the last step, up to t_end, and whether the motion is periodic. If so, t_end may be moved to an
  !> earlier time, or the window of the output begins.
  subroutine follow_revolutions(self, method, scene, t_end)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: t_end   !! on entry: end of the part of the last step that is final
    integer :: k
    associate (crank => self%crank)
      call crank%find_ends(method, scene, t_end)
      do k = 1, crank%n
        call self%periods%end_revolution(crank%t(k), crank%y(:, k), crank%angle(crank%ended - crank%n + k))
        if (self%periods%is_on .and. self%periods%window_after < 0 .and. .not. self%periods%has_ended) &
          call self%jumps%consider(scene, self%periods, crank%y(:, k), &
            method%settings%relative*abs(crank%y(:, k)) + method%settings%absolute)
        if (.not. (self%periods%has_ended .or. self%jumps%is_due)) cycle
        t_end = crank%t(k)
        self%scene_at_end = scene
        self%state_at_end = crank%y(:, k)
        crank%ended = crank%ended - crank%n + k
        crank%n = k
        exit
      end do
    end associate
    if (t_end < method%t) then
      call method%interpolate(t_end, self%y)
      call self%periods%record_point(self%y, scene%crank_angle(t_end, self%y))
    else
      call self%periods%record_point(method%y, scene%crank_angle(method%t, method%y))
    end if
    if (self%periods%window_after < 0 .or. self%rows%first_sample <= self%periods%window_start) return
    self%rows%first_sample = self%periods%window_start
    call self%extremes%begin_wear(self%periods%window_start)
    if (allocated(self%cycles)) call self%cycles%count_from(self%periods%window_after)
  end subroutine follow_revolutions

  !> Whether something is recorded at the times of the rows.
  pure logical function has_rows(self)
    class(recorder_t), intent(in) :: self
    has_rows = size(self%values) > 0 .or. allocated(self%histories)
  end function has_rows

  !> Write the rows that are due in the last step, up to t_end. If the state of one is outside the model, the run ends at the row
  !> before, to which t_end is moved.
  subroutine write_rows(self, method, scene, t_end)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: t_end
    type(evaluation_t) :: now
    real(dp) :: t, t_inside
    logical :: in_domain, is_found
    t_inside = method%t_old
    call self%rows%enter_step(method, scene, t_end, self%y)
    do
      call self%rows%find_next(method, scene, self%y, t, is_found)
      if (.not. is_found) exit
      call evaluate_inside(scene, method, t, self%y, now, in_domain, self%extremes%figures%evaluations)
      if (in_domain) call self%extremes%add_train(scene, now)
      call write_row(self, scene, t, self%y, now, in_domain)
      if (self%has_left) t_end = t_inside
      if (self%has_left) exit
      t_inside = t
    end do
  end subroutine write_rows

  !> Record the end of a step, or of its final part, after the ends of revolutions inside it.
  subroutine record_end(self, method, scene, t, y)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t) :: now
    logical :: in_domain
    integer :: k

    if (allocated(self%cycles)) then
      do k = 1, self%crank%n
        call evaluate_scene(self, scene, self%crank%t(k), self%crank%y(:, k), now, in_domain)
        if (in_domain) call search(self, method, scene, self%crank%t(k), self%crank%y(:, k), now, .false.)
        call end_revolution(self, scene, self%crank%t(k), self%crank%y(:, k), now, in_domain)
      end do
      call self%cycles%record_strobes(method, scene, t, y)
    end if
    call evaluate_scene(self, scene, t, y, now, in_domain)
    if (in_domain) call search(self, method, scene, t, y, now, .true.)
    call record_point(self, scene, t, y, now, in_domain, self%rows%every_step .and. t >= self%rows%first_sample)
  end subroutine record_end

  !> Search extremes up to (t, y), where the scene has been evaluated.
  subroutine search(self, method, scene, t, y, now, is_end)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: is_end   !! of the step, or of its final part
    integer :: before
    call self%extremes%search(method, scene, t, now, is_end, self%cycles)
    associate (f => self%extremes%figures)
      before = f%evaluations
      call self%ledger%follow(method, scene, t, y, now, f%evaluations)
      if (allocated(self%asked)) call self%asked%follow(method, scene, t, y, now, f%evaluations)
      f%peak_evaluations = f%peak_evaluations + (f%evaluations - before)
    end associate
  end subroutine search

  !> End a revolution at (t, y), where the scene has been evaluated if that is inside the model, and begin the next one.
  subroutine end_revolution(self, scene, t, y, now, in_domain)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain
    call self%extremes%end_revolution(scene, self%ledger, self%cycles)
    call self%cycles%end_cycle(scene, t, y, now)
    call self%ledger%end_revolution(self%cycles%ended)
    if (allocated(self%asked)) call self%asked%end_revolution(self%cycles%ended)
  end subroutine end_revolution

  !> Evaluate the scene for the trace or the summary. These evaluations are counted.
  subroutine evaluate_scene(self, scene, t, y, now, in_domain)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(out) :: now
    logical, intent(out) :: in_domain
    self%extremes%figures%evaluations = self%extremes%figures%evaluations + 1
    call scene%evaluate(t, y, now, in_domain)
    if (in_domain) call self%extremes%add_train(scene, now)
  end subroutine evaluate_scene

  !> Record an accepted point at which the scene has been evaluated, and write a row if one is due.
  subroutine record_point(self, scene, t, y, now, in_domain, has_row)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain, has_row
    real(dp) :: energy, speed
    if (.not. in_domain) return
    energy = scene%energy(now)
    associate (f => self%extremes%figures)
      f%max_energy = max(f%max_energy, abs(energy))
      f%max_energy_residual = max(f%max_energy_residual, abs(energy - self%initial_energy - scene%work(y)))
      f%crank_travel = now%motion%crank_angle - self%start_angle
      if (allocated(scene%chain%varying)) then
        speed = scene%chain%driven_speed(now%motion)
        f%driven_speeds = [min(f%driven_speeds(1), speed), max(f%driven_speeds(2), speed)]
      end if
    end associate
    call self%extremes%add_point(scene, t, y)
    if (allocated(self%cycles)) call self%cycles%record_point(scene, t)
    if (has_row) call hand_over_row(self, scene, t, y, now)
  end subroutine record_point

  subroutine event_accepted(self, problem, index, t, y)
    class(recorder_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain

    if (self%periods%has_ended .or. self%limits%turn_limit%is_over .or. self%jumps%is_due) return
    select type (problem)
    class is (scene_t)
      call self%extremes%change_phases()
      call self%ledger%change_phases()
      if (allocated(self%asked)) call self%asked%change_phases()
      if (problem%event_of(index)%joint == of_reeds .and. allocated(self%cycles)) &
        call self%cycles%record_valve(problem, problem%event_of(index)%event, y)
      if (problem%reported_event(index) == event_none) return
      call evaluate_scene(self, problem, t, y, now, in_domain)
      associate (owner => problem%event_of(index))
        call record_event(self, owner%joint, owner%event, problem%reported_event(index), problem, t, now)
      end associate
    end select
  end subroutine event_accepted

  !> Change the shape of worn bores at the end of their cycle. If the pin does not touch the deeper bore, its contact ends.
  subroutine event_handled(self, problem, index, t, y)
    class(recorder_t), intent(inout) :: self
    class(ode_problem_t), intent(inout) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    logical :: parts
    integer :: i, k, action
    select type (problem)
    class is (scene_t)
      if (problem%event_of(index)%joint /= of_wear) return
      do i = 1, problem%n_joints
        call self%extremes%change_bore(problem, i, t, y, parts)
        if (.not. parts) cycle
        do k = 1, problem%n_events
          if (problem%event_of(k)%joint /= i) cycle
          if (problem%reported_event(k) == event_none) cycle
          call self%event_accepted(problem, k, t, y)
          call problem%handle_event(k, t, y, action)
          exit
        end do
      end do
    end select
  end subroutine event_handled

  !> Record that a contact begins or ends at time t, at a joint or at a corner of the skirt; `now` is evaluated before that event.
  !> It is handed on, unless only events of a last period are wanted, which has not begun.
  subroutine record_event(self, joint, corner, kind, scene, t, now)
    class(recorder_t), intent(inout) :: self
    integer, intent(in) :: joint, corner, kind   !! see `run_extremes_t%record_event`
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(trace_event_t) :: event
    logical :: is_found
    call self%extremes%record_event(joint, corner, kind, scene, t, now, self%ledger, event, is_found)
    if (.not. is_found .or. (self%periods%keeps_one_more .and. self%periods%window_after < 0)) return
    call self%sink%accept_event(event)
  end subroutine record_event

  !> Make the jumps of temperatures that are due, at the end of a revolution: the integration goes on with this scene from (t, y).
  subroutine jump(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), allocatable, intent(inout) :: scene
    real(dp), intent(out) :: t, y(:)
    call move_alloc(self%scene_at_end, scene)
    t = self%crank%t(self%crank%n)
    y = self%state_at_end
    call self%jumps%make(scene, y)
    call self%periods%restate(y, scene%crank_angle(t, y))
    call self%extremes%change_phases()
    call self%ledger%change_phases()
    if (allocated(self%asked)) call self%asked%change_phases()
    self%wants_to_stop = .false.
  end subroutine jump

  !> End the run at (t, y), and with it a revolution and a cycle of wear that are complete but for rounding. Writes the last row if
  !> rows are written at every step, or if rounding left out the last row of the grid.
  subroutine finish(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain, is_due
    real(dp) :: crank_angle
    crank_angle = scene%crank_angle(t, y)
    if (allocated(self%cycles)) then
      if (self%crank%is_complete(crank_angle)) then
        call scene%evaluate(t, y, now, in_domain)
        call end_revolution(self, scene, t, y, now, in_domain)
      end if
      call self%cycles%finish(scene, t, y)
      call self%extremes%find_film_changes(scene, self%cycles)
      call self%extremes%find_pin_turns(self%cycles, self%ledger, self%periods%cycle_revolutions())
    end if
    if (allocated(scene%wear_cycle)) then
      if (scene%wear_cycle%is_over(crank_angle)) call self%extremes%end_wear_cycle(scene)
    end if
    call self%rows%find_last(t, crank_angle, is_due)
    if (.not. (is_due .and. has_rows(self))) return
    self%y = y
    if (scene%crank_moves .and. self%rows%angles%per_revolution > 0) self%y(scene%crank%position) = crank_angle
    call evaluate_scene(self, scene, t, self%y, now, in_domain)
    call write_row(self, scene, t, self%y, now, in_domain)
  end subroutine finish

  !> Account for the values of an evaluation and write its row. If its state is not `in_domain` the model there is no row, and the
  !> run is to end.
  subroutine write_row(self, scene, t, y, now, in_domain)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain
    if (.not. in_domain) self%has_left = .true.
    if (.not. in_domain) return
    call hand_over_row(self, scene, t, y, now)
  end subroutine write_row

  !> Hand over a row, unless one of its values is not a finite number: then the run is to end.
  subroutine hand_over_row(self, scene, t, y, now)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    integer :: i
    if (allocated(self%histories)) then
      do i = 1, size(self%histories)
        call self%histories(i)%add(scene, t, now)
      end do
    end if
    if (size(self%values) == 0) return
    call self%row(scene, t, y, now, self%values)
    if (.not. all(abs(self%values) <= huge(self%values))) self%has_left = .true.
    if (self%has_left) return
    associate (f => self%extremes%figures)
      f%row_energy_residual = max(f%row_energy_residual, abs(scene%energy(now) - self%initial_energy - scene%work(y)))
    end associate
    call self%ledger%add_row(self%values)
    call self%sink%accept_row(self%values)
  end subroutine hand_over_row

  !> The values of a row at (t, y), where the scene has been evaluated.
  subroutine row(self, scene, t, y, now, values)
    class(recorder_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    real(dp), intent(out) :: values(:)
    call row_values(self%list, scene, t, now, scene%work(y), self%initial_energy, values)
  end subroutine row
end module run_recorder
