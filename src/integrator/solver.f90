!> Integration from one time to another through events: step, search the step for events, show it to the observer,
!> take the event, restart.
module solver
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, event_stop, max_events
  use ode_method, only: ode_method_t, step_done
  use events, only: event_watch_t
  implicit none
  private
  public :: integrate, observer_t, silent_observer_t
  public :: integration_done, integration_stopped, step_limit_reached, integration_interrupted, chattering, &
    evaluation_limit_reached

  !> How an integration ended, besides the failures of a step (status codes of `ode_method`).
  integer, parameter :: integration_done = 0          !! the end time was reached
  integer, parameter :: integration_stopped = -1      !! an event asked for the end
  integer, parameter :: step_limit_reached = 11       !! more steps than allowed
  integer, parameter :: integration_interrupted = 12  !! the observer asked for the end
  integer, parameter :: chattering = 13               !! event after event without progress in time
  integer, parameter :: evaluation_limit_reached = 14 !! more evaluations of the right-hand side than the settings allow

  integer, parameter :: most_events_in_place = 100    !! events within the chatter time: chatter

  !> Somebody who looks at accepted steps and at events. While `step_taken` runs, the method interpolates.
  type, abstract :: observer_t
    logical :: wants_to_stop = .false.
  contains
    procedure(step_taken), deferred :: step_taken
    procedure(event_taken), deferred :: event_taken
  end type observer_t

  !> Looks at nothing.
  type, extends(observer_t) :: silent_observer_t
  contains
    procedure :: step_taken => ignore_step
    procedure :: event_taken => ignore_event
  end type silent_observer_t

  abstract interface
    !> The solution is final from method%t_old to t_to (method%t, or less where an event or the end cuts the step).
    subroutine step_taken(self, method, problem, t_to)
      import :: observer_t, ode_method_t, ode_problem_t, dp
      class(observer_t), intent(inout) :: self
      class(ode_method_t), intent(inout) :: method
      class(ode_problem_t), intent(in) :: problem
      real(dp), intent(in) :: t_to
    end subroutine step_taken

    !> Event `index` happened at (t, y); the problem's discrete state is still that before it.
    subroutine event_taken(self, problem, index, t, y)
      import :: observer_t, ode_problem_t, dp
      class(observer_t), intent(inout) :: self
      class(ode_problem_t), intent(in) :: problem
      integer, intent(in) :: index
      real(dp), intent(in) :: t, y(:)
    end subroutine event_taken
  end interface

contains

  !> Integrate from (t, y) to t_end. At return (t, y) is where it ended. max_steps = 0: no limit.
  subroutine integrate(problem, method, t, y, t_end, max_steps, observer, status)
    class(ode_problem_t), intent(inout) :: problem
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(inout) :: t, y(:)
    real(dp), intent(in) :: t_end
    integer, intent(in) :: max_steps
    class(observer_t), intent(inout) :: observer
    integer, intent(out) :: status
    type(event_watch_t) :: watch
    real(dp) :: t_event, t_place, chatter_time
    integer :: event, action, in_place

    status = integration_done
    if (.not. t < t_end) return
    method%settings%stop_time = t_end
    call method%start(problem, t, y, .true., status)
    call watch%begin(problem, t, y, 0)
    chatter_time = method%settings%chatter_time
    if (.not. chatter_time > 0) chatter_time = 1e-9_dp*method%settings%span
    t_place = t
    in_place = 0
    do while (status == step_done)
      call method%step(problem, status)
      if (status /= step_done) exit
      call watch%search(method, problem, t_end, event, t_event, y)
      t = min(method%t, t_end)
      if (event > 0) then
        t = t_event
        if (t < method%t) call land(problem, method, event, t, y)
      end if
      call observer%step_taken(method, problem, t)
      if (event > 0) then
        call observer%event_taken(problem, event, t, y)
        call problem%handle_event(event, t, y, action)
        if (action == event_stop) then
          status = integration_stopped
          exit
        end if
        if (t - t_place > chatter_time) in_place = 0
        if (in_place == 0) t_place = t
        in_place = in_place + 1
        if (in_place > most_events_in_place) status = chattering
        if (.not. t < t_end) exit
        if (status == step_done) call method%start(problem, t, y, .false., status)
        call watch%begin(problem, t, y, event)
      else if (method%t >= t_end) then
        exit
      end if
      if (observer%wants_to_stop) status = integration_interrupted
      if (max_steps > 0 .and. method%statistics%accepted >= max_steps .and. status == step_done) &
        status = step_limit_reached
      if (method%settings%max_evaluations > 0 .and. method%statistics%evaluations >= method%settings%max_evaluations &
          .and. status == step_done) status = evaluation_limit_reached
    end do
    if (status == step_done) then
      if (event == 0) call method%interpolate(t, y)
    else if (status /= integration_stopped .and. event == 0) then
      t = method%t
      y = method%y
    end if
  end subroutine integrate

  !> Land on an event inside the last step. Where the landing is more accurate than the interpolant on which the event was
  !> found, the instant is corrected by Newton's method.
  subroutine land(problem, method, event, t, y)
    class(ode_problem_t), intent(in) :: problem
    class(ode_method_t), intent(inout) :: method
    integer, intent(in) :: event
    real(dp), intent(inout) :: t, y(:)
    real(dp) :: g(max_events), rate(max_events), longest, correction
    integer :: i
    longest = 0.01_dp*(method%t - method%t_old)
    call method%land_on(problem, t, y)
    do i = 1, 3
      call problem%events(t, y, g(:problem%n_events), rate(:problem%n_events))
      if (.not. abs(rate(event)) > 0) return
      correction = -g(event)/rate(event)
      if (abs(correction) <= 1e-8_dp*longest .or. .not. abs(correction) < longest) return
      if (.not. t + correction > method%t_old) return
      t = t + correction
      call method%land_on(problem, t, y)
    end do
  end subroutine land

  subroutine ignore_step(self, method, problem, t_to)
    class(silent_observer_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    associate (unused_self => self, unused_method => method, unused_problem => problem, unused_t => t_to)
    end associate
  end subroutine ignore_step

  subroutine ignore_event(self, problem, index, t, y)
    class(silent_observer_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    associate (unused_self => self, unused_problem => problem, unused_index => index, unused_t => t, unused_y => y)
    end associate
  end subroutine ignore_event
end module solver
