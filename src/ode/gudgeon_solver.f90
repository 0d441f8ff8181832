!> Integrates from one time to another with events: take a step, search it for events, report it to the observer, handle the event,
!> restart.
module gudgeon_solver
  use gudgeon_kinds, only: dp
  use ode_problem, only: ode_problem_t, event_stop, max_events
  use ode_method, only: ode_method_t, step_done
  use gudgeon_events, only: event_watch_t
  use gudgeon_archive, only: archive_t
  implicit none
  private
  public :: integrate, observer_t, silent_observer_t
  public :: integration_done, integration_stopped, step_limit_reached, integration_interrupted, chattering, &
    evaluation_limit_reached, unreadable_archive

  !> Outcomes of an integration, in addition to failures of a step (status codes of `ode_method`).
  integer, parameter :: integration_done = 0          !! the end time was reached
  integer, parameter :: integration_stopped = -1      !! an event ended the run
  integer, parameter :: step_limit_reached = 11       !! more steps than allowed
  integer, parameter :: integration_interrupted = 12  !! the observer ended the run
  integer, parameter :: chattering = 13               !! many events without progress in time
  integer, parameter :: evaluation_limit_reached = 14 !! more evaluations of the right-hand side than the settings allow

  integer, parameter :: unreadable_archive = 15       !! the archive does not match the problem and the method

  integer, parameter :: most_events_in_place = 100    !! number of events within the chatter time that count as chatter

  !> An observer of accepted steps and events. During `step_taken` it may call the interpolant of the method.
  type, abstract :: observer_t
    logical :: wants_to_stop = .false.
    logical :: wants_archive = .false.    !! the state is requested now
    logical :: keeps_archives = .false.   !! the state is also requested when the integration ends but could be continued
  contains
    procedure :: take_archive => ignore_archive
    procedure :: exchange => exchange_nothing
    procedure :: event_handled => change_nothing
    procedure(step_taken), deferred :: step_taken
    procedure(event_taken), deferred :: event_taken
  end type observer_t

  !> The state of an integration, besides problem, method and observer.
  type :: position_t
    real(dp) :: t = 0
    real(dp), allocatable :: y(:)      !! state at t; set only by events
    integer :: event = 0               !! event at t, 0: none
    type(event_watch_t) :: watch
    real(dp) :: t_place = 0            !! time of the first of several events without progress in time
    integer :: in_place = 0            !! number of these events
  end type position_t

  !> An observer that ignores everything.
  type, extends(observer_t) :: silent_observer_t
  contains
    procedure :: step_taken => ignore_step
    procedure :: event_taken => ignore_event
  end type silent_observer_t

  abstract interface
    !> Report that the solution is final from method%t_old to t_to (method%t, or less if an event or the end cuts the step).
    subroutine step_taken(self, method, problem, t_to)
      import :: observer_t, ode_method_t, ode_problem_t, dp
      class(observer_t), intent(inout) :: self
      class(ode_method_t), intent(inout) :: method
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t_to
    end subroutine step_taken

    !> Report event `index` at (t, y), before the discrete state of the problem is changed.
    subroutine event_taken(self, problem, index, t, y)
      import :: observer_t, ode_problem_t, dp
      class(observer_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      integer, intent(in) :: index
      real(dp), intent(in) :: t, y(:)
    end subroutine event_taken
  end interface

contains

  !> Integrate from (t, y) to t_end, or continue from an `archive`; with the same settings, problem and observer the results are
  !> then identical to those without interruption. On return (t, y) is the end of the integration. max_steps = 0: no limit.
  subroutine integrate(problem, method, t, y, t_end, max_steps, observer, status, archive)
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(inout) :: t, y(:)
    real(dp), intent(in) :: t_end
    integer, intent(in) :: max_steps
    class(observer_t), intent(inout) :: observer
    integer, intent(out) :: status
    type(archive_t), intent(inout), optional :: archive
    type(position_t) :: at

    status = integration_done
    if (.not. t < t_end) return
    method%settings%stop_time = t_end
    at%t = t
    at%y = y
    if (present(archive)) then
      call exchange_all(problem, method, observer, at, archive)
      if (archive%failed) status = unreadable_archive
      if (archive%failed) return
      call look_around(method, max_steps, observer, status)
    else
      call method%start(problem, at%t, at%y, .true., status)
      call at%watch%begin(problem, at%t, at%y, 0, .false.)
      at%t_place = t
    end if
    do while (status == step_done)
      method%rough_time = problem%rough_time(method%t, method%y)
      call method%step(problem, status)
      if (status /= step_done) exit
      call at%watch%search(method, problem, t_end, at%event, at%t)
      if (at%event == 0) then
        call method%count_time(at%t)
        call observer%step_taken(method, problem, at%t)
        if (method%t >= t_end) exit
      else
        call take_event(problem, method, observer, t_end, at, status)
        if (status == integration_stopped .or. is_at_end(at%t, t_end)) exit
      end if
      call look_around(method, max_steps, observer, status)
      if (observer%keeps_archives) call hand_over(problem, method, observer, at, status)
    end do
    if (status == step_done) then
      if (at%event == 0) call method%interpolate(at%t, at%y)
    else if (status /= integration_stopped .and. at%event == 0) then
      at%t = method%t
      at%y = method%y
    end if
    t = at%t
    y = at%y
  end subroutine integrate

  !> Move to the event found in an accepted step, report step and event to the observer, handle the event and restart. If the state
  !> at the event cannot be computed accurately, the step is taken back and shorter ones are made: at%event is then 0.
  subroutine take_event(problem, method, observer, t_end, at, status)
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(inout) :: observer
    real(dp), intent(in) :: t_end
    type(position_t), intent(inout) :: at
    integer, intent(inout) :: status
    real(dp) :: chatter_time, g(max_events), rate(max_events)
    integer :: action
    logical :: landed, falls

    if (at%t < method%t) then
      call land(problem, method, at%event, at%t, at%y, landed)
      if (.not. landed) then
        call method%withdraw(problem, 0.5_dp*(at%t - method%t_old), status)
        call at%watch%step_back(problem, method%t, method%y)
        at%event = 0
        at%t = method%t
        return
      end if
    else
      call method%interpolate(at%t, at%y)
    end if
    call method%count_time(at%t)
    call observer%step_taken(method, problem, at%t)
    call observer%event_taken(problem, at%event, at%t, at%y)
    call problem%events(at%t, at%y, g, rate)
    falls = rate(at%event) < 0
    call problem%handle_event(at%event, at%t, at%y, action)
    call observer%event_handled(problem, at%event, at%t, at%y)
    if (action == event_stop) then
      status = integration_stopped
      return
    end if
    chatter_time = method%settings%chatter_time
    if (.not. chatter_time > 0) chatter_time = 1e-9_dp*method%settings%span
    if (at%t - at%t_place > chatter_time) at%in_place = 0
    if (at%in_place == 0) at%t_place = at%t
    at%in_place = at%in_place + 1
    if (at%in_place > most_events_in_place) status = chattering
    if (is_at_end(at%t, t_end)) return
    if (status == step_done) call method%start(problem, at%t, at%y, .false., status)
    call at%watch%begin(problem, at%t, at%y, at%event, falls)
  end subroutine take_event

  !> Whether an event is so close to the end that no step fits between them.
  pure logical function is_at_end(t, t_end)
    real(dp), intent(in) :: t, t_end
    is_at_end = .not. t_end - t > 8*epsilon(t)*abs(t_end)
  end function is_at_end

  !> Check the conditions to end the integration between two steps.
  subroutine look_around(method, max_steps, observer, status)
    class(ode_method_t), intent(in) :: method
    integer, intent(in) :: max_steps
    class(observer_t), intent(in) :: observer
    integer, intent(inout) :: status
    if (observer%wants_to_stop) status = integration_interrupted
    if (max_steps > 0 .and. method%statistics%accepted >= max_steps .and. status == step_done) &
      status = step_limit_reached
    if (method%settings%max_evaluations > 0 .and. method%statistics%evaluations >= method%settings%max_evaluations &
        .and. status == step_done) status = evaluation_limit_reached
  end subroutine look_around

  !> Hand over the state, if the observer asks for it, or if the integration ends here although it could be continued.
  subroutine hand_over(problem, method, observer, at, status)
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(inout) :: observer
    type(position_t), intent(inout) :: at
    integer, intent(in) :: status
    type(archive_t) :: archive
    select case (status)
    case (step_done)
      if (.not. observer%wants_archive) return
    case (integration_interrupted, step_limit_reached, evaluation_limit_reached)
    case default
      return
    end select
    call archive%begin_writing()
    call exchange_all(problem, method, observer, at, archive)
    call observer%take_archive(archive)
    observer%wants_archive = .false.
  end subroutine hand_over

  !> Write the whole state between two steps to an archive, or read it from it.
  subroutine exchange_all(problem, method, observer, at, archive)
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(inout) :: observer
    type(position_t), intent(inout) :: at
    type(archive_t), intent(inout) :: archive
    call problem%exchange(archive)
    call method%exchange(problem, archive)
    call at%watch%exchange(problem, archive)
    call archive%exchange(at%t)
    call archive%exchange(at%y)
    call archive%exchange(at%event)
    call archive%exchange(at%t_place)
    call archive%exchange(at%in_place)
    call observer%exchange(archive)
    if (archive%is_reading .and. .not. archive%is_at_end()) archive%failed = .true.
  end subroutine exchange_all

  !> Move to an event inside the last step. If the method can compute the state there more accurately than its interpolant, on
  !> which the event was found, the instant is corrected by Newton's method. This may fail because the function hardly changes.
  !> Then the event is taken where it was found, if the state of the interpolant there is within the tolerance of the computed one;
  !> the former is used if the event has not happened in the latter. Otherwise the interpolant misses the motion, and `landed` is
  !> false.
  subroutine land(problem, method, event, t, y, landed)
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    integer, intent(in) :: event
    real(dp), intent(inout) :: t, y(:)
    logical, intent(out) :: landed
    real(dp) :: g(max_events), rate(max_events), longest, correction, t_found, y_found(size(y))
    logical :: is_near
    integer :: i
    t_found = t
    longest = 0.01_dp*(method%t - method%t_old)
    call method%interpolate(t, y_found)
    call method%land_on(problem, t, y, landed)
    is_near = landed
    if (landed) is_near = method%difference(y, y_found) <= 1
    do i = 1, 3
      if (.not. landed) exit
      call problem%events(t, y, g, rate)
      if (.not. abs(rate(event)) > 0) exit
      correction = -g(event)/rate(event)
      if (abs(correction) <= 1e-8_dp*longest) return
      if (.not. (abs(correction) < longest .and. t + correction > method%t_old)) exit
      t = t + correction
      call method%land_on(problem, t, y, landed)
    end do
    if (landed .and. is_near .and. (i > 3 .or. .not. g(event) < 0)) return
    landed = is_near
    if (.not. landed) landed = hardly_moves(problem, method, t_found, y_found)
    t = t_found
    y = y_found
  end subroutine land

  !> Whether the state changes from the beginning of the last step to (t, y) by less than the tolerance, also according to its
  !> rates.
  logical function hardly_moves(problem, method, t, y)
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: t, y(:)
    real(dp) :: f(problem%n)
    logical :: inside
    hardly_moves = method%difference(y, method%y_old) <= 1
    if (.not. hardly_moves) return
    method%statistics%evaluations = method%statistics%evaluations + 1
    call problem%derivatives(method%t_old, method%y_old, f, inside)
    hardly_moves = inside .and. method%difference(method%y_old + (t - method%t_old)*f, method%y_old) <= 1
  end function hardly_moves

  subroutine ignore_step(self, method, problem, t_to)
    class(silent_observer_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    associate (unused_self => self, unused_method => method, unused_problem => problem, unused_t => t_to)
    end associate
  end subroutine ignore_step

  subroutine ignore_archive(self, archive)
    class(observer_t), intent(inout) :: self
    type(archive_t), intent(in) :: archive
    associate (unused_self => self, unused_archive => archive)
    end associate
  end subroutine ignore_archive

  !> Called when the problem has handled an event. An observer may then change the discrete state of the problem, or y.
  subroutine change_nothing(self, problem, index, t, y)
    class(observer_t), intent(inout) :: self
    class(ode_problem_t), intent(inout) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    associate (unused_self => self, unused_problem => problem, unused_index => index, unused_t => t, unused_y => y)
    end associate
  end subroutine change_nothing

  !> Archive of an observer without state.
  subroutine exchange_nothing(self, archive)
    class(observer_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    associate (unused_self => self, unused_archive => archive)
    end associate
  end subroutine exchange_nothing

  subroutine ignore_event(self, problem, index, t, y)
    class(silent_observer_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    associate (unused_self => self, unused_problem => problem, unused_index => index, unused_t => t, unused_y => y)
    end associate
  end subroutine ignore_event
end module gudgeon_solver
