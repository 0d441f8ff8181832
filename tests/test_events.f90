!> Events: several functions and directions, roots to the last bits, double passages, grazing contacts, chatter, rejected steps.
module test_events
  use kinds, only: dp
  use constants, only: pi
  use checks, only: checks_t
  use test_problems, only: oscillator_t
  use ode_problem, only: ode_problem_t, event_continue, step_admitted, step_too_deep
  use ode_method, only: ode_method_t
  use adams, only: adams_t
  use ode_solver, only: integrate, observer_t, silent_observer_t, integration_done, chattering
  use event_search, only: event_watch_t
  use root_search, only: abscissa_by_rates
  use test_problems, only: hopper_t
  implicit none
  private
  public :: run_test_events

  integer, parameter :: most = 1000

  !> y = (sin t, cos t) with three events: sin rises through 1/2, sin falls through 1/2, cos rises through 0. If it
  !> `refuses`, two of three steps are rejected as too deep. Its rates are `rate_factor` times the right ones.
  type, extends(oscillator_t) :: crossings_t
    logical :: refuses = .false.
    real(dp) :: rate_factor = 1
    integer :: taken = 0, index(most) = 0
    real(dp) :: time(most) = 0
  contains
    procedure :: events => three_events
    procedure :: handle_event => note_event
    procedure :: judge_step => refuse_long_steps
  end type crossings_t

  !> y' = -1 above zero, 1 below: the solution slides along zero with one event after another.
  type, extends(ode_problem_t) :: chatterer_t
    integer :: side = 1, taken = 0
  contains
    procedure :: derivatives => towards_zero
    procedure :: events => passes_zero
    procedure :: handle_event => changes_side
  end type chatterer_t

  !> A ball above a moving floor: y = (height, speed). Its events are that it leaves a table, and then that it comes
  !> back; when it leaves, `handle_event` puts it below the table by `sunk`, as an inexact root does.
  type, extends(ode_problem_t) :: ball_t
    logical :: is_off = .false.
    real(dp) :: sunk = 0
    integer :: left = 0, came_back = 0
    real(dp) :: time_back = 0
  contains
    procedure :: derivatives => falls
    procedure :: events => leaves_or_comes
    procedure :: handle_event => leave_or_come
  end type ball_t

  !> Nothing moves, and the function of its event is (t - 1)(t - 2.1)(t - 5.9): it passes zero three times.
  type, extends(ode_problem_t) :: triple_t
    real(dp) :: first = -1   !! time of the first event
  contains
    procedure :: derivatives => stays
    procedure :: events => passes_thrice
    procedure :: handle_event => notes_first
  end type triple_t

  !> y = (function of an event, its rate).
  type, extends(triple_t) :: plain_t
  contains
    procedure :: events => is_state
  end type plain_t

  !> A method whose first steps are shorter than the time resolves: at the beginning of a step it interpolates `y_start`.
  type, extends(adams_t) :: short_steps_t
    real(dp) :: y_start(2) = 0
  contains
    procedure :: interpolate => of_rounded_time
  end type short_steps_t

  !> Checks each event root: the function is not negative there, and negative one rounding step of the time before.
  type, extends(observer_t) :: root_checker_t
    integer :: loose = 0
    integer :: events = 0
  contains
    procedure :: step_accepted => look_at_root
    procedure :: event_accepted => ignore_event
  end type root_checker_t

contains

  subroutine run_test_events(check)
    class(checks_t), intent(inout) :: check
    call several_events(check)
    call roots_by_rates(check)
    call close_passages(check)
    call first_of_three(check)
    call grazing(check)
    call turns_before_it_is_out(check)
    call chatter(check)
    call steps_below_resolution(check)
  end subroutine run_test_events

  !> A contact has begun, and the function of its end falls through zero in steps that the time does not resolve: its sign is
  !> rounding, so it does not end. (Numbers of a run with clearance at both pins, which ended with chatter.)
  subroutine steps_below_resolution(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: t = 0.89515756850926809_dp, rate = -3.345e-5_dp
    type(plain_t) :: problem
    type(short_steps_t) :: method
    type(event_watch_t) :: watch
    real(dp) :: t_event
    integer :: event
    problem%n = 2
    problem%n_events = 1
    method%order = 1
    method%y_start = [6.866e-23_dp, rate]
    call watch%begin(problem, t, method%y_start, 1, .false.)
    method%t_old = t
    method%t = t
    method%y = [-1.39e-22_dp, rate]
    call watch%search(method, problem, 1.0_dp, event, t_event)
    call check%that(event == 0, 'no event in a step without length')
    method%t = nearest(t, 1.0_dp)
    method%y = [-1.8e-21_dp, rate]
    call watch%search(method, problem, 1.0_dp, event, t_event)
    call check%that(event == 0, 'no event in a step as short as the time resolves')
    method%t_old = method%t
    method%t = t + 1e-6_dp
    method%y_start = method%y
    method%y = [1e-12_dp, -rate]   ! it rises through zero again
    call watch%search(method, problem, 1.0_dp, event, t_event)
    call check%that(event == 1, 'an event in a longer step')
  end subroutine steps_below_resolution

  pure subroutine is_state(self, t, y, g, g_rate)
    class(plain_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = y(1)
    g_rate = y(2)
  end subroutine is_state

  pure subroutine of_rounded_time(self, t, y)
    class(short_steps_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    real(dp) :: x
    x = 0
    if (t > self%t_old) x = (t - self%t_old)/(self%t - self%t_old)
    y = (1 - x)*self%y_start + x*self%y
  end subroutine of_rounded_time

  subroutine prepare(method, n, tolerance, span)
    type(adams_t), intent(inout) :: method
    integer, intent(in) :: n
    real(dp), intent(in) :: tolerance, span
    allocate (method%settings%relative(n), method%settings%absolute(n))
    method%settings%relative = tolerance
    method%settings%absolute = tolerance
    method%settings%span = span
  end subroutine prepare

  !> Each event is taken once, in order, at its time; also with rejected steps.
  subroutine several_events(check)
    class(checks_t), intent(inout) :: check
    type(crossings_t) :: problem
    type(adams_t) :: method
    type(root_checker_t) :: observer
    real(dp) :: y(2), t, worst
    integer :: status, i, way
    real(dp), parameter :: first(3) = [pi/6, 5*pi/6, 3*pi/2]

    do way = 1, 4   ! as it is; with refused steps; with rates that are too small or too large
      problem = crossings_t(n=2, n_events=3, refuses=way == 2)
      if (way > 2) problem%rate_factor = merge(0.6_dp, 1.5_dp, way == 3)
      method = adams_t()
      call prepare(method, 2, 1e-11_dp, 100*pi)
      observer%loose = 0
      t = 0.1_dp
      y = [sin(t), cos(t)]
      call integrate(problem, method, t, y, 100*pi, 0, observer, status)
      call check%that(status == integration_done, 'integration of the circle')
      call check%that(problem%taken == 150, 'three events in each of 50 revolutions, none twice')
      call check%that(method%statistics%restarts == problem%taken, 'one restart for each event')
      worst = 0
      do i = 1, min(150, problem%taken)
        if (problem%index(i) /= mod(i - 1, 3) + 1) worst = 1
        worst = max(worst, abs(problem%time(i) - first(mod(i - 1, 3) + 1) - 2*pi*((i - 1)/3)))
      end do
      call check%close_to(worst, 0.0_dp, 1e-8_dp, 'times of three kinds of events in order')
      call check%that(observer%loose == 0, 'every root is between two neighbouring numbers')
      if (way == 2) call check%that(method%statistics%rejected_penetration > 100, 'steps were rejected')
    end do
  end subroutine several_events

  !> The estimate of a root from values and rates at both ends: exact where the abscissa is a cubic of the value, always inside, and
  !> for log(x) in four evaluations between two neighbouring numbers.
  subroutine roots_by_rates(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: a, b, x
    integer :: i
    call check%close_to(abscissa_by_rates(abscissa(-0.2_dp), abscissa(0.7_dp), -0.2_dp, 0.7_dp, rate(-0.2_dp), rate(0.7_dp)), &
      abscissa(0.0_dp), 2e-15_dp, 'the abscissa is a cubic of the value')
    call check%that(abscissa_by_rates(1.0_dp, 2.0_dp, -1.0_dp, 0.0_dp, 1.0_dp, 1.0_dp) < 2, 'a root at the end: one spacing inside')
    call check%that(abscissa_by_rates(1.0_dp, 2.0_dp, -1.0_dp, 1.0_dp, 1e-9_dp, 9.0_dp) < 2, 'useless rates: inside all the same')
    a = 0.9_dp
    b = 1.2_dp
    do i = 1, 5
      x = abscissa_by_rates(a, b, log(a), log(b), 1/a, 1/b)
      if (.not. (x > a .and. x < b)) exit
      if (log(x) < 0) then
        a = x
      else
        b = x
      end if
    end do
    call check%that(a < 1 .and. b >= 1 .and. b - a <= 2*epsilon(1.0_dp), 'log(x) = 0 is enclosed in five evaluations')

  contains

    pure real(dp) function abscissa(value)
      real(dp), intent(in) :: value
      abscissa = 3 + value*(1 + value*(0.3_dp + 0.1_dp*value))
    end function abscissa

    pure real(dp) function rate(value)
      real(dp), intent(in) :: value
      rate = 1/(1 + value*(0.6_dp + 0.3_dp*value))
    end function rate
  end subroutine roots_by_rates

  !> Of three passages in one step the first one is the event, although a short way to the last one leads from the ends of the step.
  subroutine first_of_three(check)
    class(checks_t), intent(inout) :: check
    type(triple_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(1), t
    integer :: status
    problem%n = 1
    problem%n_events = 1
    call prepare(method, 1, 1e-6_dp, 6.0_dp)
    method%settings%fixed_step = 6
    t = 0
    y = 1
    call integrate(problem, method, t, y, 6.0_dp, 0, observer, status)
    call check%close_to(problem%first, 1.0_dp, 1e-14_dp, 'the first of three passages in one step')
  end subroutine first_of_three

  pure subroutine stays(self, t, y, dydt, in_domain)
    class(triple_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt = 0
    in_domain = .true.
  end subroutine stays

  pure subroutine passes_thrice(self, t, y, g, g_rate)
    class(triple_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = (t - 1)*(t - 2.1_dp)*(t - 5.9_dp)
    g_rate = (t - 2.1_dp)*(t - 5.9_dp) + (t - 1)*(t - 5.9_dp) + (t - 1)*(t - 2.1_dp)
  end subroutine passes_thrice

  subroutine notes_first(self, index, t, y, action)
    class(triple_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    if (self%first < 0) self%first = t
    action = event_continue
  end subroutine notes_first

  !> Short intervals above a level, down to 2e-5 of the period: both crossings are in one step.
  subroutine close_passages(check)
    class(checks_t), intent(inout) :: check
    type(hopper_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t
    integer :: status, i, j
    character(len=40) :: label
    do i = 4, 10, 2
      do j = 2, i - 1
        problem = hopper_t(n=2, n_events=1, level=1 - 10.0_dp**(-j))
        method = adams_t()
        call prepare(method, 2, 10.0_dp**(-i - 2), 40.0_dp)
        t = 0
        y = [0.0_dp, 1.0_dp]
        call integrate(problem, method, t, y, 40.0_dp, 0, observer, status)
        write (label, '(a,i0,a,i0)') ' 1e-', j, ' above the level, tolerance 1e-', i + 2
        call check%that(problem%passages == 7, 'tips'//trim(label))
      end do
    end do
  end subroutine close_passages

  !> A level that is reached within rounding: the event may be found or not, but not twice, and the run continues. With a slightly
  !> lower level every maximum is found, with a slightly higher one none.
  subroutine grazing(check)
    class(checks_t), intent(inout) :: check
    integer :: i
    do i = -3, 3
      call check%that(passages_of(check, 1 + i*1e-12_dp) <= 7, 'no grazing event is taken twice')
    end do
    call check%that(passages_of(check, 1 - 1e-6_dp) == 7, 'every maximum above a slightly lower level is found')
    call check%that(passages_of(check, 1 + 1e-6_dp) == 0, 'no maximum reaches a slightly higher level')
  end subroutine grazing

  !> Crossings of a level in seven hops of height 1.
  integer function passages_of(check, level)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: level
    type(hopper_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t
    integer :: status
    problem = hopper_t(n=2, n_events=1, level=level)
    call prepare(method, 2, 1e-9_dp, 40.0_dp)
    t = 0
    y = [0.0_dp, 1.0_dp]
    call integrate(problem, method, t, y, 40.0_dp, 0, observer, status)
    call check%that(status == integration_done, 'a run with grazing events ends')
    passages_of = problem%passages
  end function passages_of

  !> A ball that starts upwards at d below a table with the speed v: for d < v^2/(2 g) it rises above the table and returns;
  !> otherwise it reverses below the table, and its event occurs again there. It must never be lost below the table.
  subroutine turns_before_it_is_out(check)
    class(checks_t), intent(inout) :: check
    type(ball_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp), parameter :: sunk(5) = [0.0_dp, 1e-14_dp, 4e-9_dp, 6e-9_dp, 1e-6_dp]   ! v^2/(2 g) = 5e-9
    real(dp) :: y(2), t
    integer :: status, i
    do i = 1, size(sunk)
      problem = ball_t(n=2, n_events=1, sunk=sunk(i))
      method = adams_t()
      call prepare(method, 2, 1e-12_dp, 1.0_dp)
      t = 0
      y = [-1.0_dp, sqrt(2.0_dp + 1e-8_dp)]
      call integrate(problem, method, t, y, 3.0_dp, 0, observer, status)
      call check%that(status == integration_done .and. problem%left == 1, 'the ball leaves the table')
      call check%that(problem%came_back == 1, 'the ball comes back to the table')
      if (sunk(i) < 5e-9_dp) then
        call check%close_to(problem%time_back, sqrt(2 + 1e-8_dp) + sqrt(1e-8_dp - 2*sunk(i)), 1e-7_dp, &
          'time at which the ball comes back')
      else
        call check%close_to(problem%time_back, sqrt(2 + 1e-8_dp), 1e-6_dp, 'time at which the ball reverses below the table')
      end if
    end do
  end subroutine turns_before_it_is_out

  subroutine chatter(check)
    class(checks_t), intent(inout) :: check
    type(chatterer_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(1), t
    integer :: status
    problem%n = 1
    problem%n_events = 2
    call prepare(method, 1, 1e-6_dp, 10.0_dp)
    method%settings%chatter_time = 1e-6_dp
    t = 0
    y = 1
    call integrate(problem, method, t, y, 10.0_dp, 0, observer, status)
    call check%that(status == chattering, 'chatter has its own status')
    call check%close_to(t, 1.0_dp, 1e-5_dp, 'chatter ends the run where it begins')
    call check%that(problem%taken <= 110, 'chatter ends after a hundred events')
  end subroutine chatter

  pure subroutine three_events(self, t, y, g, g_rate)
    class(crossings_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = [y(1) - 0.5_dp, 0.5_dp - y(1), y(2)]
    g_rate = self%rate_factor*[y(2), -y(2), -y(1)]
  end subroutine three_events

  subroutine note_event(self, index, t, y, action)
    class(crossings_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    self%taken = min(self%taken + 1, most)
    self%index(self%taken) = index
    self%time(self%taken) = t
    action = event_continue
  end subroutine note_event

  pure subroutine refuse_long_steps(self, t_old, y_old, t, y, verdict, fraction)
    class(crossings_t), intent(in) :: self
    real(dp), intent(in) :: t_old, y_old(:), t, y(:)
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    fraction = 0.6_dp
    verdict = step_admitted
    if (self%refuses .and. t - t_old > 0.01_dp .and. mod(int(t*1e3_dp), 3) > 0) verdict = step_too_deep
  end subroutine refuse_long_steps

  pure subroutine towards_zero(self, t, y, dydt, in_domain)
    class(chatterer_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt = -self%side
    in_domain = .true.
  end subroutine towards_zero

  pure subroutine passes_zero(self, t, y, g, g_rate)
    class(chatterer_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = -1
    g(merge(1, 2, self%side > 0)) = -self%side*y(1)
    g_rate = 0
    g_rate(merge(1, 2, self%side > 0)) = 1
  end subroutine passes_zero

  !> y'' = -1.
  pure subroutine falls(self, t, y, dydt, in_domain)
    class(ball_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt = [y(2), -1.0_dp]
    in_domain = .true.
  end subroutine falls

  pure subroutine leaves_or_comes(self, t, y, g, g_rate)
    class(ball_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = merge(-1, 1, self%is_off)*y(1)
    g_rate = merge(-1, 1, self%is_off)*y(2)
    if (self%came_back > 0) g = -1
  end subroutine leaves_or_comes

  subroutine leave_or_come(self, index, t, y, action)
    class(ball_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    action = event_continue
    if (self%is_off) then
      self%came_back = self%came_back + 1
      self%time_back = t
    else
      self%left = self%left + 1
      y(1) = y(1) - self%sunk
    end if
    self%is_off = .true.
  end subroutine leave_or_come

  subroutine changes_side(self, index, t, y, action)
    class(chatterer_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    self%side = -self%side
    self%taken = self%taken + 1
    action = event_continue
  end subroutine changes_side

  !> `t_to` is an event if it is before the end of the step.
  subroutine look_at_root(self, method, problem, t_to)
    class(root_checker_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: y(2), g(3), before(3), rate(3)
    if (.not. t_to < method%t) return
    call method%interpolate(t_to, y)
    call problem%events(t_to, y, g, rate)
    call method%interpolate(t_to - spacing(t_to), y)
    call problem%events(t_to - spacing(t_to), y, before, rate)
    if (.not. any(g >= 0 .and. before < 0) .and. t_to < 99*pi) self%loose = self%loose + 1
  end subroutine look_at_root

  subroutine ignore_event(self, problem, index, t, y)
    class(root_checker_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    self%events = self%events + 1
  end subroutine ignore_event
end module test_events
