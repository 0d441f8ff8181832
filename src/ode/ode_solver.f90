!> Integrates from one time to another with events: take a step, search it for events, report it to the observer, handle the event,
!> restart. An integration can pause at any time without an influence on its steps.
module ode_solver
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, event_stop, max_events
  use ode_method, only: ode_method_t, step_done, step_rejected
  use event_search, only: event_watch_t
  implicit none
  private
  public :: integrate, integration_t, observer_t, silent_observer_t
  public :: integration_done, integration_stopped, step_limit_reached, integration_interrupted, chattering, &
    evaluation_limit_reached

  !> Outcomes of an integration, in addition to failures of a step (status codes of `ode_method`).
  integer, parameter :: integration_done = 0          !! the end time was reached
  integer, parameter :: integration_stopped = -1      !! an event ended the run
  integer, parameter :: step_limit_reached = 11       !! more steps than allowed
  integer, parameter :: integration_interrupted = 12  !! the observer or the caller ended the run
  integer, parameter :: chattering = 13               !! many events without progress in time
  integer, parameter :: evaluation_limit_reached = 14 !! more evaluations of the right-hand side than the settings allow

  integer, parameter :: most_events_in_place = 100    !! number of events within the chatter time that count as chatter

  !> An observer of accepted steps and events. During `step_accepted` it may call the interpolant of the method.
  type, abstract :: observer_t
    logical :: wants_to_stop = .false.
  contains
    procedure :: event_handled => change_nothing
    procedure(step_accepted), deferred :: step_accepted
    procedure(event_accepted), deferred :: event_accepted
  end type observer_t

  !> An integration under way: everything besides problem, method and observer. The part of the last step up to the next event is
  !> final. It is reported to the observer when the integration goes on beyond it; at a pause within it, it is kept.
  type :: integration_t
    real(dp) :: t = 0                  !! end of the part that is final: the last step, the next event, or the end
    real(dp), allocatable :: y(:)      !! state at t; set only by events and at the end
    integer :: status = integration_done
    logical :: is_over = .false.       !! the integration has ended, with this status
    logical :: is_kept = .false.       !! the final part of the last step has not been reported
    logical, private :: has_begun = .false.
    real(dp), private :: t_end = 0
    integer, private :: max_steps = 0
    integer, private :: event = 0               !! event at t, 0: none
    logical, private :: falls = .false.         !! its function fell
    type(event_watch_t), private :: watch
    real(dp), private :: t_place = 0            !! time of the first of several events without progress in time
    integer, private :: in_place = 0            !! number of these events
  contains
    procedure :: begin
    procedure :: go_to
    procedure :: cut
    procedure :: restart
    procedure :: go_on_from
    procedure :: state
    procedure :: finish
  end type integration_t

  !> An observer that ignores everything.
  type, extends(observer_t) :: silent_observer_t
  contains
    procedure :: step_accepted => ignore_step
    procedure :: event_accepted => ignore_event
  end type silent_observer_t

  abstract interface
    !> Report that the solution is final from method%t_old to t_to (method%t, or less if an event or the end cuts the step).
    subroutine step_accepted(self, method, problem, t_to)
      import :: observer_t, ode_method_t, ode_problem_t, dp
      class(observer_t), intent(inout) :: self
      class(ode_method_t), intent(inout) :: method
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t_to
    end subroutine step_accepted

    !> Report event `index` at (t, y), before the discrete state of the problem is changed.
    subroutine event_accepted(self, problem, index, t, y)
      import :: observer_t, ode_problem_t, dp
      class(observer_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      integer, intent(in) :: index
      real(dp), intent(in) :: t, y(:)
    end subroutine event_accepted
  end interface

contains

  !> Integrate from (t, y) to t_end without a pause. On return (t, y) is the end of the integration. max_steps = 0: no limit.
  subroutine integrate(problem, method, t, y, t_end, max_steps, observer, status)
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(inout) :: t, y(:)
    real(dp), intent(in) :: t_end
    integer, intent(in) :: max_steps
    class(observer_t), intent(inout) :: observer
    integer, intent(out) :: status
    type(integration_t) :: integration
    call integration%begin(problem, method, t, y, t_end, max_steps)
    call integration%go_to(problem, method, observer, t_end, 0)
    call integration%finish(method)
    status = integration%status
    t = integration%t
    y = integration%y
  end subroutine integrate

  !> Begin at (t, y). The integration will end at t_end, or after max_steps accepted steps (0: no limit).
  subroutine begin(self, problem, method, t, y, t_end, max_steps)
    class(integration_t), intent(out) :: self
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: t, y(:), t_end
    integer, intent(in) :: max_steps
    self%t = t
    self%y = y
    self%t_end = t_end
    self%max_steps = max_steps
    self%t_place = t
    self%is_over = .not. t < t_end
    if (self%is_over) return
    self%has_begun = .true.
    method%settings%stop_time = t_end
    call method%start(problem, t, self%y, .true., self%status)
    self%is_over = self%status /= step_done
    if (.not. self%is_over) call self%watch%begin(problem, t, self%y, 0, .false.)
  end subroutine begin

  !> Go on to t_pause, or through `most_steps` more steps (0: no limit; a rejected trial counts as one), unless the integration ends
  !> before. Steps are not shortened for a pause: a step that reaches beyond it is kept. A pause within rounding of the end is the
  !> end.
  subroutine go_to(self, problem, method, observer, t_pause, most_steps)
    class(integration_t), intent(inout) :: self
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(inout) :: observer
    real(dp), intent(in) :: t_pause
    integer, intent(in) :: most_steps
    real(dp) :: until
    integer :: steps
    until = t_pause
    if (is_at_end(t_pause, self%t_end)) until = self%t_end
    steps = 0
    do while (.not. self%is_over)
      if (.not. self%is_kept) then
        if (.not. self%t < until .or. most_steps > 0 .and. steps >= most_steps) exit
        steps = steps + 1
        call take_step(self, problem, method, observer)
        if (.not. self%is_kept) cycle
      end if
      if (self%t > until) exit
      self%is_kept = .false.
      call method%count_time(self%t)
      call observer%step_accepted(method, problem, self%t)
      if (self%event == 0) then
        self%is_over = method%t >= self%t_end
      else
        call handle_event(self, problem, method, observer)
      end if
      if (.not. self%is_over) call look_around(self, method, observer)
    end do
  end subroutine go_to

  !> Try a step, and search it for events. If it is rejected, nothing is kept; nor if the state at an event cannot be computed
  !> accurately: the step is then taken back. Shorter steps follow.
  subroutine take_step(self, problem, method, observer)
    type(integration_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(in) :: observer
    logical :: landed
    method%next_kink_time = problem%next_kink_time(method%t, method%y)
    call method%step(problem, self%status)
    if (self%status == step_rejected) then
      self%status = step_done
      call look_around(self, method, observer)
      return
    end if
    self%is_over = self%status /= step_done
    if (self%is_over) return
    self%is_kept = .true.
    call self%watch%search(method, problem, self%t_end, self%event, self%t)
    if (self%event == 0) return
    if (.not. self%t < method%t) then
      call method%interpolate(self%t, self%y)
      return
    end if
    call land(problem, method, self%event, self%t, self%y, landed)
    if (landed) return
    call method%withdraw(problem, 0.5_dp*(self%t - method%t_old), self%status)
    call self%watch%step_back(problem, method%t, method%y)
    self%event = 0
    self%t = method%t
    self%is_kept = .false.
    self%is_over = self%status /= step_done
    if (.not. self%is_over) call look_around(self, method, observer)
  end subroutine take_step

  !> Handle the event at which the last step ends, and restart.
  subroutine handle_event(self, problem, method, observer)
    type(integration_t), intent(inout) :: self
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(inout) :: observer
    real(dp) :: chatter_time, g(max_events), rate(max_events)
    integer :: action
    call observer%event_accepted(problem, self%event, self%t, self%y)
    call problem%events(self%t, self%y, g, rate)
    self%falls = rate(self%event) < 0
    call problem%handle_event(self%event, self%t, self%y, action)
    call observer%event_handled(problem, self%event, self%t, self%y)
    if (action == event_stop) self%status = integration_stopped
    self%is_over = action == event_stop
    if (self%is_over) return
    chatter_time = method%settings%chatter_time
    if (.not. chatter_time > 0) chatter_time = 1e-9_dp*method%settings%span
    if (self%t - self%t_place > chatter_time) self%in_place = 0
    if (self%in_place == 0) self%t_place = self%t
    self%in_place = self%in_place + 1
    if (self%in_place > most_events_in_place) self%status = chattering
    self%is_over = is_at_end(self%t, self%t_end) .or. self%status /= step_done
    if (self%is_over) return
    call method%start(problem, self%t, self%y, .false., self%status)
    call self%watch%begin(problem, self%t, self%y, self%event, self%falls)
    self%is_over = self%status /= step_done
  end subroutine handle_event

  !> End a kept step at a time inside its final part. After this, or where no step is kept, (t, y) is the state reached, and the
  !> problem may be changed; then call `restart`.
  subroutine cut(self, problem, method, observer, t)
    class(integration_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    class(observer_t), intent(inout) :: observer
    real(dp), intent(in) :: t
    logical :: landed
    if (.not. self%is_kept) then
      self%y = self%state(method)
      return
    end if
    self%t = t
    call method%land_on(problem, t, self%y, landed)
    if (.not. landed) call method%interpolate(t, self%y)
    self%event = 0
    self%is_kept = .false.
    call method%count_time(t)
    call observer%step_accepted(method, problem, t)
    call look_around(self, method, observer)
  end subroutine cut

  !> Start again at (t, y), after `cut`.
  subroutine restart(self, problem, method)
    class(integration_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    if (self%is_over) return
    call method%start(problem, self%t, self%y, .false., self%status)
    call self%watch%begin(problem, self%t, self%y, self%event, self%falls)
    self%is_over = self%status /= step_done
  end subroutine restart

  !> Start again from (t, y), not after the last reported time, at which the observer has stopped the integration.
  subroutine go_on_from(self, problem, method, t, y)
    class(integration_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: t, y(:)
    call method%count_time(method%t_old - (self%t - t))   ! the time after t is counted again
    self%t = t
    self%y = y
    self%event = 0
    self%in_place = 0
    self%status = step_done
    self%is_over = .false.
    call self%restart(problem, method)
  end subroutine go_on_from

  !> The state at time t while nothing is kept.
  pure function state(self, method) result(y)
    class(integration_t), intent(in) :: self
    class(ode_method_t), intent(in) :: method
    real(dp) :: y(size(self%y))
    y = self%y
    if (self%event == 0 .and. self%has_begun .and. .not. self%is_over) y = method%y
  end function state

  !> Set (t, y) to the last final state that has been reported: at the end of the integration, or at a pause. A kept step is
  !> dropped.
  subroutine finish(self, method)
    class(integration_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    if (self%is_kept) then
      self%t = method%t_old
      self%y = method%y_old
    else if (self%event == 0 .and. self%has_begun) then
      if (self%is_over .and. self%status == integration_done) then
        call method%interpolate(self%t, self%y)
      else
        self%t = method%t
        self%y = method%y
      end if
    end if
  end subroutine finish

  !> Whether an event is so close to the end that no step fits between them.
  pure logical function is_at_end(t, t_end)
    real(dp), intent(in) :: t, t_end
    is_at_end = .not. t_end - t > 8*epsilon(t)*abs(t_end)
  end function is_at_end

  !> Check the conditions to end the integration between two steps.
  subroutine look_around(self, method, observer)
    type(integration_t), intent(inout) :: self
    class(ode_method_t), intent(in) :: method
    class(observer_t), intent(in) :: observer
    if (observer%wants_to_stop) then
      self%status = integration_interrupted
    else if (self%max_steps > 0 .and. method%statistics%accepted >= self%max_steps) then
      self%status = step_limit_reached
    else if (method%settings%max_evaluations > 0 .and. method%statistics%evaluations >= method%settings%max_evaluations) then
      self%status = evaluation_limit_reached
    end if
    self%is_over = self%status /= step_done
  end subroutine look_around

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
    logical :: in_domain
    hardly_moves = method%difference(y, method%y_old) <= 1
    if (.not. hardly_moves) return
    method%statistics%evaluations = method%statistics%evaluations + 1
    call problem%derivatives(method%t_old, method%y_old, f, in_domain)
    hardly_moves = in_domain .and. method%difference(method%y_old + (t - method%t_old)*f, method%y_old) <= 1
  end function hardly_moves

  subroutine ignore_step(self, method, problem, t_to)
    class(silent_observer_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
  end subroutine ignore_step

  !> Called when the problem has handled an event. An observer may then change the discrete state of the problem, or y.
  subroutine change_nothing(self, problem, index, t, y)
    class(observer_t), intent(inout) :: self
    class(ode_problem_t), intent(inout) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
  end subroutine change_nothing

  subroutine ignore_event(self, problem, index, t, y)
    class(silent_observer_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
  end subroutine ignore_event
end module ode_solver
