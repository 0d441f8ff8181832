!> The observer of a run. It records samples on a fixed grid of time or crank angle, the events of contact, the values for the
!> summary and, on request, the results of each revolution.
!>
!> Results that belong to a pin are in its `pin_record`: one for each of the scene's reported places. Peaks are
!> searched also between accepted points, and no peak is below the largest value of a row. The energy is checked at accepted points.
module run_recorder
  use kinds, only: dp
  use constants, only: two_pi
  use ode_problem, only: ode_problem_t
  use run_state, only: run_state_t
  use ode_method, only: ode_method_t
  use ode_solver, only: observer_t
  use joint_places, only: n_places
  use scene_problem, only: scene_t, evaluation_t, event_none, event_contact_begins, of_guide, of_wear, phase_contact
  use inside_step, only: evaluate_inside
  use joint_events, only: penetration_and_rate, may_lose_force, find_lost_force
  use trace_columns, only: column_list_t, row_values
  use angle_grid, only: angle_grid_t
  use crank_passage, only: find_turning
  use crank_turns, only: turn_limit_t
  use period_watch, only: period_watch_t
  use cycle_statistics, only: skirt
  use cycle_watch, only: cycle_watch_t
  use pin_record, only: pin_record_t
  use guide_record, only: guide_record_t
  use trace_sink, only: trace_sink_t, trace_event_t
  use elastic_record, only: elastic_record_t
  use run_figures, only: run_figures_t
  use film_snapshots, only: film_snapshots_t
  use wear_record, only: wear_profile_t
  implicit none
  private
  public :: recorder_t

  type, extends(observer_t) :: recorder_t
    type(column_list_t) :: list       !! columns of a row; empty: no rows are written
    type(run_figures_t) :: figures
    type(film_snapshots_t), allocatable :: films   !! pressure fields, if they are requested
    class(trace_sink_t), pointer :: sink => null()
    type(cycle_watch_t), allocatable :: cycles   !! results of each revolution, if they are requested
    type(period_watch_t) :: periods   !! search for a periodic motion that ends the run
    type(scene_t), allocatable :: scene_at_end   !! the scene at the end of that period
    type(turn_limit_t) :: turn_limit   !! time limit for a turn, if turns of the crank end the run
    real(dp) :: first_sample = 0      !! time of the first row [s]
    real(dp) :: interval = 0          !! time between rows [s]
    type(angle_grid_t) :: angles      !! crank angles of the rows, if rows are spaced by crank angle
    real(dp) :: end_time = 0          !! latest end of the run [s]
    logical :: every_step = .false.   !! write a row at every accepted step
    integer :: max_evaluations_per_revolution = 0  !! largest number of evaluations in one revolution, or in the time of the first
                                                   !! revolution; 0: no limit
    real(dp) :: revolution_time = huge(1.0_dp)      !! duration of a revolution at the starting speed [s]
    logical :: over_budget = .false.                !! the run is to end because that number was exceeded
    logical :: goes_on = .false.                    !! the run goes on with the totals of another one
    logical :: has_left = .false.                   !! the run is to end because the state of a row is outside the model
    real(dp), private :: initial_energy = 0, start_angle = 0
    integer, private :: next_row = 0
    integer, private :: evaluations_then = 0        !! number of evaluations at the beginning of the present revolution
    real(dp), private :: time_then = 0, angle_then = 0   !! time [s] and crank angle [rad] at that beginning
    integer, private :: n_pins = 0                 !! number of pins that have a record
    type(pin_record_t), private :: pins(n_places)
    type(guide_record_t), private :: guide         !! record of a piston with clearance in its bore
    type(elastic_record_t), private :: elastic     !! record of elastic members
    real(dp), allocatable, private :: y(:), values(:)
  contains
    procedure :: prepare
    procedure :: declare
    procedure :: begin
    procedure :: step_accepted
    procedure :: event_accepted
    procedure :: event_handled
    procedure :: finish
    procedure :: row
    procedure :: wear
  end type recorder_t

contains

  !> Prepare for a scene that is ready to run. Must be called before the other procedures.
  subroutine prepare(self, scene)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    integer :: i
    self%n_pins = size(scene%reported)
    do i = 1, self%n_pins
      call self%pins(i)%prepare(scene%reported(i), scene)
    end do
    call self%guide%prepare(scene)
    call self%elastic%prepare(scene, self%figures%elastic)
    allocate (self%y(scene%n), self%values(size(self%list%id)))
    if (self%periods%keeps_one_more) self%first_sample = huge(self%first_sample)        ! no rows until the window begins
  end subroutine prepare

  !> Declare the totals so far, which belong to the summary of the run. With those of a list the run goes on.
  subroutine declare(self, list, scene)
    class(recorder_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(scene_t), intent(inout) :: scene
    integer :: i
    list%of_totals = .true.
    call list%add('initial_energy', self%initial_energy, 'J', 'energy of the bodies at the start of the run')
    call self%figures%declare(list)
    do i = 1, self%n_pins
      call self%pins(i)%declare(list, self%figures, scene)
    end do
    call self%guide%declare(list, self%figures)
    if (self%elastic%is_present) call self%figures%elastic%declare(list)
    list%of_totals = .false.
    self%goes_on = list%sets .and. list%goes_on
  end subroutine declare

  !> Record the state (t, y) with which the run begins, and write the first row if it is due.
  subroutine begin(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain, is_first_row
    integer :: i

    call evaluate_scene(self, scene, t, y, now, in_domain)
    if (self%goes_on) then
      self%start_angle = scene%crank_angle(t, y) - self%figures%crank_travel
      self%figures%time = t
      call self%turn_limit%begin(t, abs(self%figures%crank_travel)/two_pi)
    else if (in_domain) then
      self%initial_energy = scene%chain%energy(now%motion)
      self%start_angle = now%motion%crank_angle
    end if
    if (self%periods%is_on .or. allocated(self%cycles)) call self%periods%begin(scene, t, y)
    if (in_domain) call self%elastic%begin(scene, t, now)
    if (allocated(self%cycles)) then
      call self%cycles%begin(scene, t, y, now, in_domain, self%initial_energy)
      call self%guide%begin_revolution()
    end if
    do i = 1, self%n_pins
      if (in_domain .and. self%pins(i)%is_touching(scene) .and. .not. self%goes_on) &
        call record_contact(self, self%pins(i), event_contact_begins, t, now)
      call self%pins(i)%begin(scene, t, now)
      call self%pins(i)%count_from(t)
      if (in_domain) call self%pins(i)%record_values(scene, now, self%figures, self%cycles)
    end do
    if (in_domain .and. self%guide%is_present) then
      call self%guide%stand_at(t, now)
      do i = 1, size(scene%guide%touches)
        if (scene%guide%touches(i) .and. .not. self%goes_on) call record_corner_contact(self, i, event_contact_begins, t, now)
      end do
      call self%guide%record_values(scene, now, self%figures)
    end if
    call find_first_row(self, t, scene%crank_angle(t, y), is_first_row)
    call record_point(self, scene, t, y, now, in_domain, is_first_row)
  end subroutine begin

  !> Find out whether a row is due at the start, at a time and a crank angle [rad], and which one comes next.
  subroutine find_first_row(self, t, crank_angle, is_first_row)
    class(recorder_t), intent(inout) :: self
    real(dp), intent(in) :: t, crank_angle
    logical, intent(out) :: is_first_row
    real(dp), parameter :: same = 1e-9_dp   !! share of an interval that counts as rounding
    real(dp) :: intervals
    is_first_row = .true.
    if (self%angles%per_revolution > 0) then
      call self%angles%begin(crank_angle, is_first_row)
    else if (self%interval > 0 .and. self%first_sample <= t .and. .not. self%every_step) then
      intervals = (t - self%first_sample)/self%interval
      self%next_row = ceiling(intervals - same)
      is_first_row = self%next_row <= intervals + same
      if (is_first_row) self%next_row = self%next_row + 1
    end if
    is_first_row = is_first_row .and. self%first_sample <= t
  end subroutine find_first_row

  subroutine step_accepted(self, method, problem, t_to)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: t_end

    select type (problem)
    class is (scene_t)
      t_end = t_to
      call self%turn_limit%limit_end(t_end)
      if (self%periods%is_on .or. allocated(self%cycles)) call watch_periods(self, method, problem, t_end)
      if (.not. self%every_step .and. size(self%values) > 0) call write_samples(self, method, problem, t_end)
      if (allocated(self%films)) call self%films%record(method, problem, t_end, self%figures%evaluations)
      if (t_end < method%t) then
        call method%interpolate(t_end, self%y)
        call record_end(self, method, problem, t_end, self%y)
      else
        call record_end(self, method, problem, method%t, method%y)
      end if
    end select
    call keep_budget(self, method%statistics%evaluations)
    call self%turn_limit%follow(self%figures%time, abs(self%figures%crank_travel)/two_pi)
    self%wants_to_stop = self%over_budget .or. self%has_left .or. self%periods%has_ended .or. self%turn_limit%is_over
  end subroutine step_accepted

  !> Check whether the motion is periodic. If so, t_end may be moved to an earlier time, or the window of the output begins.
  subroutine watch_periods(self, method, scene, t_end)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: t_end   !! on entry: end of the part of the last step that is final
    integer :: i
    call self%periods%follow(method, scene, t_end)
    if (self%periods%has_ended) then
      t_end = self%periods%t
      allocate (self%scene_at_end)
      self%scene_at_end = scene
    end if
    if (t_end < method%t) then
      call method%interpolate(t_end, self%y)
      call self%periods%record_point(self%y, scene%crank_angle(t_end, self%y))
    else
      call self%periods%record_point(method%y, scene%crank_angle(method%t, method%y))
    end if
    if (self%periods%window_after < 0 .or. self%first_sample <= self%periods%window_start) return
    self%first_sample = self%periods%window_start
    do i = 1, self%n_pins
      if (allocated(self%pins(i)%wear)) call self%pins(i)%wear%begin_at(self%periods%window_start)
    end do
    if (allocated(self%cycles)) call self%cycles%count_from(self%periods%window_after)
  end subroutine watch_periods

  !> Write the rows that are due in the last step, up to t_to.
  subroutine write_samples(self, method, scene, t_to)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to
    real(dp) :: t, t_from, ends(2)
    integer :: part
    logical :: turns, is_found

    if (.not. self%angles%per_revolution > 0) then
      do
        t = self%first_sample + self%next_row*self%interval
        if (t > t_to .or. t > self%end_time*(1 + 4*epsilon(t))) exit
        call write_sample(self, method, scene, t)
        self%next_row = self%next_row + 1
      end do
      return
    end if
    ends = t_to
    if (scene%crank_moves) call find_turning(method, scene, method%t_old, t_to, turns, ends(1), self%y)
    t_from = method%t_old
    do part = 1, 2
      do
        call self%angles%next_passage(method, scene, t_from, ends(part), t, self%y, is_found)
        if (.not. is_found) exit
        if (t >= self%first_sample) call write_sample(self, method, scene, t)
        t_from = t
      end do
      t_from = ends(part)
    end do
  end subroutine write_samples

  !> Write the row of a time inside the last step.
  subroutine write_sample(self, method, scene, t)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t) :: now
    logical :: in_domain
    call evaluate_inside(scene, method, t, self%y, now, in_domain, self%figures%evaluations)
    if (in_domain) call self%elastic%record_values(scene, now, self%figures%elastic)
    call record_row(self, scene, t, self%y, now, in_domain)
  end subroutine write_sample

  !> Record the end of a step, or of its final part, after the ends of revolutions inside it.
  subroutine record_end(self, method, scene, t, y)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t) :: now
    logical :: in_domain, ends
    real(dp) :: t_cycle

    if (allocated(self%cycles)) then
      do
        call self%cycles%find_end(method, scene, t, y, t_cycle, ends)
        if (.not. ends) exit
        call evaluate_scene(self, scene, t_cycle, self%cycles%y, now, in_domain)
        if (in_domain) call search_peaks(self, method, scene, t_cycle, now, is_end=.false.)
        call self%guide%end_revolution(self%cycles)
        call self%cycles%end_cycle(scene, t_cycle, now)
        call self%guide%begin_revolution()
      end do
      call self%cycles%record_strobes(method, scene, t, y)
    end if
    call evaluate_scene(self, scene, t, y, now, in_domain)
    if (in_domain) call search_peaks(self, method, scene, t, now, is_end=.true.)
    call record_point(self, scene, t, y, now, in_domain, self%every_step .and. t >= self%first_sample)
  end subroutine record_end

  !> Search for peaks between the last point recorded (or the beginning of a step after an event) and t, where the scene is
  !> evaluated.
  subroutine search_peaks(self, method, scene, t, now, is_end)
    class(recorder_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: is_end   !! t is the end of the step, or of its final part
    integer :: i
    do i = 1, self%n_pins
      call self%pins(i)%search(method, scene, t, now, is_end, self%figures, self%cycles)
    end do
    call self%guide%search(method, scene, t, now, self%figures)
    call self%elastic%search(method, scene, t, now, self%figures%elastic)
    if (allocated(self%cycles)) call self%cycles%search_machine(method, scene, t, now)
  end subroutine search_peaks

  !> Check the number of evaluations in the present revolution. A revolution that takes longer than the first would have taken is
  !> counted as ended there: a crank at rest must not use an unlimited number of evaluations.
  subroutine keep_budget(self, evaluations)
    class(recorder_t), intent(inout) :: self
    integer, intent(in) :: evaluations   !! number so far
    if (self%max_evaluations_per_revolution <= 0) return
    associate (f => self%figures)
      if (abs(f%crank_travel - self%angle_then) >= two_pi .or. f%time - self%time_then >= self%revolution_time) then
        self%angle_then = f%crank_travel
        self%time_then = f%time
        self%evaluations_then = evaluations
      end if
    end associate
    self%over_budget = evaluations - self%evaluations_then >= self%max_evaluations_per_revolution
  end subroutine keep_budget

  !> Evaluate the scene for the trace or the summary. These evaluations are counted.
  subroutine evaluate_scene(self, scene, t, y, now, in_domain)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(out) :: now
    logical, intent(out) :: in_domain
    self%figures%evaluations = self%figures%evaluations + 1
    call scene%evaluate(t, y, now, in_domain)
    if (in_domain) call self%elastic%record_values(scene, now, self%figures%elastic)
  end subroutine evaluate_scene

  !> Record an accepted point at which the scene has been evaluated, and write a row if one is due.
  subroutine record_point(self, scene, t, y, now, in_domain, has_row)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain, has_row
    real(dp) :: energy
    integer :: i

    if (.not. in_domain) return
    energy = scene%chain%energy(now%motion)
    associate (f => self%figures)
      f%max_energy = max(f%max_energy, abs(energy))
      f%max_energy_residual = max(f%max_energy_residual, abs(energy - self%initial_energy - scene%work(y)))
      f%crank_travel = now%motion%crank_angle - self%start_angle
      do i = 1, self%n_pins
        if (self%pins(i)%joint == 0) cycle
        associate (figures => f%pin(self%pins(i)%pin), joint => scene%joints(self%pins(i)%joint))
          if (self%pins(i)%is_touching(scene)) figures%contact_time = figures%contact_time + (t - f%time)
          if (joint%integrates_friction) figures%friction_work = joint%work_of_friction(y)
          call self%pins(i)%settling%record(f%crank_travel, -now%joint(self%pins(i)%joint)%penetration)
          figures%film_change = self%pins(i)%settling%change()
        end associate
      end do
      call self%guide%add_time(scene, t - f%time, f)
      f%time = t
    end associate
    if (allocated(self%cycles)) call self%cycles%record_point(scene, t)
    if (has_row) call pass_row(self, scene, t, y, now)
  end subroutine record_point

  subroutine event_accepted(self, problem, index, t, y)
    class(recorder_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain
    integer :: i

    if (self%periods%has_ended .or. self%turn_limit%is_over) return
    select type (problem)
    class is (scene_t)
      do i = 1, self%n_pins
        call self%pins(i)%change_phase()
      end do
      if (problem%reported_event(index) == event_none) return
      call evaluate_scene(self, problem, t, y, now, in_domain)
      do i = 1, self%n_pins
        if (self%pins(i)%joint == problem%event_of(index)%joint) &
          call record_contact(self, self%pins(i), problem%reported_event(index), t, now)
      end do
      if (problem%event_of(index)%joint == of_guide) &
        call record_corner_contact(self, problem%event_of(index)%event, problem%reported_event(index), t, now)
    end select
  end subroutine event_accepted

  !> Change the shape of a worn bore at the end of its cycle. If the pin does not touch the deeper bore, its contact ends; a
  !> contact law whose force may be lost may lose it, or act again.
  subroutine event_handled(self, problem, index, t, y)
    class(recorder_t), intent(inout) :: self
    class(ode_problem_t), intent(inout) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    type(evaluation_t) :: now
    real(dp) :: contact(2)
    logical :: in_domain
    integer :: i, k, action
    select type (problem)
    class is (scene_t)
      if (problem%event_of(index)%joint /= of_wear) return
      do i = 1, self%n_pins
        if (.not. allocated(self%pins(i)%wear)) cycle
        associate (joint => problem%joints(self%pins(i)%joint))
          if (.not. joint%has_worn_bore()) cycle
          call self%pins(i)%wear%change_bore(joint)
          if (joint%phase /= phase_contact) cycle
          contact = penetration_and_rate(joint, y)
          if (contact(1) > 0 .and. may_lose_force(joint)) then
            call evaluate_scene(self, problem, t, y, now, in_domain)
            if (in_domain) call find_lost_force(joint, now%joint(self%pins(i)%joint), joint%relative_rates(now%accelerations))
          end if
          if (contact(1) > 0) cycle
        end associate
        do k = 1, problem%n_events
          if (problem%event_of(k)%joint /= self%pins(i)%joint) cycle
          if (problem%reported_event(k) == event_none) cycle
          call self%event_accepted(problem, k, t, y)
          call problem%handle_event(k, t, y, action)
          exit
        end do
      end do
    end select
  end subroutine event_handled

  !> Record that a contact begins or ends at a pin at time t; `now` is evaluated before that event.
  subroutine record_contact(self, pin, kind, t, now)
    class(recorder_t), intent(inout) :: self
    type(pin_record_t), intent(inout) :: pin
    integer, intent(in) :: kind
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(trace_event_t) :: event
    call pin%record_contact(kind, t, now, self%figures, event, self%cycles)
    call pass_on(self, event)
  end subroutine record_contact

  !> Record that a contact of corner i of the skirt begins or ends at time t; `now` is evaluated before that event.
  subroutine record_corner_contact(self, i, kind, t, now)
    class(recorder_t), intent(inout) :: self
    integer, intent(in) :: i, kind
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(trace_event_t) :: event
    call self%guide%record_contact(i, kind, t, now, self%figures, event)
    if (allocated(self%cycles) .and. kind == event_contact_begins) call self%cycles%count_impact(skirt)
    call pass_on(self, event)
  end subroutine record_corner_contact

  !> Pass an event on, unless only those of a last period are wanted, which has not begun.
  subroutine pass_on(self, event)
    class(recorder_t), intent(inout) :: self
    type(trace_event_t), intent(in) :: event
    if (self%periods%keeps_one_more .and. self%periods%window_after < 0) return
    call self%sink%accept_event(event)
  end subroutine pass_on

  !> End the run at (t, y), and with it a cycle of wear that is complete. Writes the last row if rows are written at every step, or
  !> if rounding left out the last row of the grid.
  subroutine finish(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    integer :: i
    if (allocated(self%cycles)) then
      call self%guide%end_revolution(self%cycles)
      call self%cycles%finish(scene, t, y)
    end if
    if (allocated(scene%wear_cycle)) then
      do i = 1, self%n_pins
        if (.not. (allocated(self%pins(i)%wear) .and. scene%wear_cycle%is_over(scene%crank_angle(t, y)))) cycle
        if (scene%joints(self%pins(i)%joint)%has_worn_bore()) call self%pins(i)%wear%end_cycle(scene%joints(self%pins(i)%joint))
      end do
    end if
    if (self%every_step) return
    if (self%angles%per_revolution > 0) then
      call write_last_angle(self, scene, t, y)
    else if (abs(self%first_sample + self%next_row*self%interval - t) <= 1e-9_dp*self%interval) then
      call write_row(self, scene, t, y)
    end if
  end subroutine finish

  !> Write the row at the final crank angle, if rounding left it out.
  subroutine write_last_angle(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    real(dp), parameter :: rounding = 1e-9_dp   !! tolerance of the final crank angle [rad]
    real(dp) :: crank_angle
    logical :: is_due
    call self%angles%is_due(scene%crank_angle(t, y), rounding, is_due, crank_angle)
    if (.not. is_due .or. t < self%first_sample) return
    self%y = y
    if (scene%crank_moves) self%y(scene%crank%position) = crank_angle
    call write_row(self, scene, t, self%y)
  end subroutine write_last_angle

  !> The worn surfaces of the joints whose wear is counted.
  function wear(self, scene) result(worn)
    class(recorder_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(wear_profile_t), allocatable :: worn(:)
    integer :: i
    allocate (worn(0))
    do i = 1, self%n_pins
      if (allocated(self%pins(i)%wear)) worn = [worn, self%pins(i)%wear%profile(scene)]
    end do
  end function wear

  !> Write a row at a time at which nothing else is recorded.
  subroutine write_row(self, scene, t, y)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t) :: now
    logical :: in_domain
    if (size(self%values) == 0) return
    call evaluate_scene(self, scene, t, y, now, in_domain)
    call record_row(self, scene, t, y, now, in_domain)
  end subroutine write_row

  !> Account for the values of an evaluation and write its row. If its state is not `in_domain` the model there is no row, and the
  !> run is to end.
  subroutine record_row(self, scene, t, y, now, in_domain)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain
    integer :: i
    if (.not. in_domain) self%has_left = .true.
    if (.not. in_domain) return
    do i = 1, self%n_pins   ! without revolution counts: those must not depend on whether rows are written
      call self%pins(i)%record_values(scene, now, self%figures)
    end do
    call self%guide%record_values(scene, now, self%figures)
    call pass_row(self, scene, t, y, now)
  end subroutine record_row

  subroutine pass_row(self, scene, t, y, now)
    class(recorder_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    type(evaluation_t), intent(in) :: now
    if (size(self%values) == 0) return
    call self%row(scene, t, y, now, self%values)
    associate (f => self%figures)
      f%row_energy_residual = max(f%row_energy_residual, abs(scene%chain%energy(now%motion) - self%initial_energy - scene%work(y)))
    end associate
    call self%sink%accept_row(self%values)
  end subroutine pass_row

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
