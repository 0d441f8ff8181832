!> Detection of events inside a step: the first passage of an event function from negative to non-negative values.
!>
!> All functions are evaluated together with their rates. A cubic through values and rates at both ends of the step, with a margin
!> for its curvature, excludes steps in which no event is possible; otherwise the interpolant is sampled, so that a function that
!> passes zero and returns within one step is usually found. The same is done for all functions in the first step after a restart,
!> until they have become negative. If a function whose event has been taken is becoming negative (such as the penetration after the
!> end of a contact) and turns before it is negative, its event occurs again where it turns.
module event_search
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, max_events
  use ode_method, only: ode_method_t
  use root_search, only: bracket_t, next_abscissa, narrow, abscissa_by_rates
  implicit none
  private
  public :: event_watch_t

  !> One event function at one instant.
  type :: sample_t
    real(dp) :: t = 0, g = 0, rate = 0
  end type sample_t

  !> The event functions at the end of the interval searched so far.
  type :: event_watch_t
    private
    integer :: n = 0                      !! number of functions
    logical :: low(max_events) = .false.  !! negative at some time since the last restart: a passage is an event
    logical :: leaving(max_events) = .false.       !! its event has been taken, and it is becoming negative; its sign is rounding
    logical :: on_step_end(max_events) = .false.   !! its event is taken at the end of the step
    integer :: last_event = 0             !! event that caused the last restart
    logical :: fresh = .true.             !! no step since the restart
    real(dp) :: t = 0                     !! end of the interval searched so far
    real(dp) :: g(max_events) = 0, rate(max_events) = 0   !! values and rates at that time
    real(dp), allocatable :: y(:)         !! work
  contains
    procedure :: begin
    procedure :: step_back
    procedure :: search
  end type event_watch_t

contains

  !> Begin at (t, y), after a start or restart of the method. Event `last_event` (0: none) is not taken again before its function
  !> has been negative; any other function that is positive and increasing gives an event at once. `fell`: the function of event
  !> `last_event` was decreasing when the event was taken, which happens where the interpolant, on which it is found, is inexact. If
  !> the event has reversed the function, it now gives the opposite event at once.
  subroutine begin(self, problem, t, y, last_event, fell)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    integer, intent(in) :: last_event
    logical, intent(in) :: fell
    self%last_event = last_event
    self%fresh = .true.
    if (.not. allocated(self%y)) allocate (self%y(size(y)))
    call prepare(self, problem)
    if (self%n == 0) return
    call look(self, problem, t, y)
    self%low(:self%n) = self%g(:self%n) < 0
    self%leaving(:self%n) = self%leaving(:self%n) .and. .not. self%low(:self%n)
    if (last_event > 0) self%leaving(last_event) = self%rate(last_event) < 0
    if (fell) then
      if (self%rate(last_event) > 0) self%last_event = 0
    end if
  end subroutine begin

  !> Return to (t, y), the beginning of the last step, which the method has taken back.
  subroutine step_back(self, problem, t, y)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    call self%begin(problem, t, y, self%last_event, .false.)
    self%fresh = .false.   ! functions that were positive there have been looked at
  end subroutine step_back

  !> Ask the problem for properties of its functions that are constant until the next restart.
  subroutine prepare(self, problem)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer :: i
    self%n = problem%n_events
    do i = 1, self%n
      self%on_step_end(i) = problem%lands_on_step_end(i)
    end do
  end subroutine prepare

  !> Evaluate the functions and their rates at (t, y), the end of the interval searched so far.
  subroutine look(self, problem, t, y)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(problem%n)
    self%t = t
    call problem%events(t, y, self%g, self%rate)
  end subroutine look

  !> Search the last step of the method up to t_last. `index` is the first event, or 0. t_event is its time, at a non-negative value
  !> of the function, or the end of the search.
  subroutine search(self, method, problem, t_last, index, t_event)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_last
    integer, intent(out) :: index
    real(dp), intent(out) :: t_event
    real(dp) :: t_before, g_before(max_events), rate_before(max_events), t_end, t_found
    logical :: found
    integer :: i

    index = 0
    t_event = min(t_last, method%t)
    if (self%fresh) call find_passed(self, index, t_event)
    if (index > 0 .or. self%n == 0) return
    t_end = t_event
    t_before = self%t
    g_before(:self%n) = self%g(:self%n)
    rate_before(:self%n) = self%rate(:self%n)
    if (t_end < method%t) then
      call method%interpolate(t_end, self%y)
      call look(self, problem, t_end, self%y)
    else
      call look(self, problem, method%t, method%y)
    end if
    do i = 1, self%n
      if (self%low(i)) then
        if (stays_negative(t_end - t_before, g_before(i), rate_before(i), self%g(i), self%rate(i))) then
          self%leaving(i) = .false.
          cycle
        end if
      end if
      call search_one(self, method, problem, i, sample_t(t_before, g_before(i), rate_before(i)), &
        sample_t(t_end, self%g(i), self%rate(i)), found, t_found)
      if (found .and. (index == 0 .or. t_found < t_event)) then
        index = i
        t_event = t_found
      end if
      if (.not. self%g(i) < 0) cycle
      self%low(i) = .true.
      self%leaving(i) = .false.
    end do
  end subroutine search

  !> In the first step after a restart: an event of a function that was positive at its beginning and is increasing.
  pure subroutine find_passed(self, index, t_event)
    class(event_watch_t), intent(inout) :: self
    integer, intent(inout) :: index
    real(dp), intent(inout) :: t_event
    integer :: i
    do i = 1, self%n
      if (i == self%last_event) cycle
      if (self%g(i) > 0 .and. self%rate(i) >= 0 .or. .not. self%g(i) < 0 .and. self%rate(i) > 0) then
        index = i
        t_event = self%t
        return
      end if
    end do
    self%fresh = .false.
  end subroutine find_passed

  !> Search one function that may reach zero, from `before` to `here`, which is at most the end of the step.
  subroutine search_one(self, method, problem, index, before, here, found, t_found)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: before, here
    logical, intent(out) :: found
    real(dp), intent(out) :: t_found
    type(sample_t) :: left, right
    integer :: i, pieces
    logical :: low

    found = .false.
    t_found = here%t
    low = self%low(index) .and. .not. self%leaving(index)
    if (low .and. here%g >= 0 .and. self%on_step_end(index) .and. .not. here%t < method%t) then
      found = .true.
      return
    end if
    if (low .and. rises_once(before, here)) then
      found = .true.
      t_found = passage(self, method, problem, index, before, here)
      return
    end if
    pieces = method%order + 2
    left = before
    do i = 1, pieces
      right = here
      if (i < pieces) right = sample(self, method, problem, index, before%t + (here%t - before%t)*i/pieces)
      call search_piece(self, method, problem, index, left, right, low, found, t_found)
      if (found) return
      left = right
    end do
  end subroutine search_one

  !> Whether a function that is negative at both ends cannot reach zero between them: the cubic in Bernstein form, with twice its
  !> deviation from the straight line, is negative.
  pure logical function stays_negative(width, left, left_rate, right, right_rate)
    real(dp), intent(in) :: width                            !! time between them
    real(dp), intent(in) :: left, left_rate, right, right_rate
    real(dp) :: inner_left, inner_right, bend
    real(dp), parameter :: third = 1/3.0_dp
    stays_negative = left < 0 .and. right < 0
    if (.not. stays_negative) return
    inner_left = left + third*width*left_rate
    inner_right = right - third*width*right_rate
    bend = max(abs(inner_left - third*(2*left + right)), abs(inner_right - third*(left + 2*right)))
    stays_negative = max(inner_left, inner_right) + bend < 0
  end function stays_negative

  !> Whether a function that is negative at the left and not negative at the right passes zero once between them: the cubic in
  !> Bernstein form, with twice its deviation from the straight line, rises.
  pure logical function rises_once(left, right)
    type(sample_t), intent(in) :: left, right
    real(dp) :: slope
    rises_once = left%g < 0 .and. right%g >= 0
    if (.not. rises_once) return
    slope = (right%g - left%g)/(right%t - left%t)
    rises_once = abs(left%rate - slope) + abs(right%rate - slope) < 0.5_dp*slope
  end function rises_once

  !> Search between two samples. `low` says whether the function has been negative before, and is updated.
  subroutine search_piece(self, method, problem, index, left, right, low, found, t_found)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: left, right
    logical, intent(inout) :: low
    logical, intent(out) :: found
    real(dp), intent(out) :: t_found
    type(sample_t) :: start, peak

    found = .false.
    t_found = right%t
    start = left
    if (.not. low .and. right%g >= 0 .and. left%rate <= 0 .and. right%rate > 0) then
      start = extremum(self, method, problem, index, left, right)   ! it may become negative in between
      low = start%g < 0
      if (.not. low .and. self%leaving(index)) then
        found = .true.
        t_found = start%t
        return
      end if
    end if
    if (low .and. start%g < 0 .and. right%g >= 0 .and. .not. falls_in_resolution(start, right)) then
      found = .true.
      t_found = passage(self, method, problem, index, start, right)
    else if (low .and. start%g < 0 .and. start%rate > 0 .and. right%rate < 0) then
      if (.not. stays_negative(right%t - start%t, start%g, start%rate, right%g, right%rate)) then
        peak = extremum(self, method, problem, index, start, right)
        found = peak%g >= 0
        if (found) t_found = passage(self, method, problem, index, start, peak)
      end if
    end if
    low = low .or. right%g < 0
  end subroutine search_piece

  !> Whether a function falls at both ends, and its values there are no larger than its change while the time advances by a few
  !> roundings: steps may be shorter than these (after a contact has begun), and the sign is then rounding too.
  pure logical function falls_in_resolution(left, right)
    type(sample_t), intent(in) :: left, right
    real(dp) :: change
    change = -4*epsilon(right%t)*abs(right%t)*min(left%rate, right%rate)
    falls_in_resolution = left%rate < 0 .and. right%rate < 0 .and. -left%g <= change .and. right%g <= change
  end function falls_in_resolution

  !> The first instant, within the resolution of the time, at which the function is non-negative.
  real(dp) function passage(self, method, problem, index, left, right)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: left, right
    integer, parameter :: most_by_rates = 8   !! evaluations before a method that needs no rates takes over
    type(bracket_t) :: bracket
    type(sample_t) :: a, b, here
    real(dp) :: t
    integer :: i

    a = left
    b = right
    do i = 1, most_by_rates
      if (.not. (a%rate > 0 .and. b%rate > 0)) exit
      t = abscissa_by_rates(a%t, b%t, a%g, b%g, a%rate, b%rate)
      if (.not. (t > a%t .and. t < b%t)) exit
      here = sample(self, method, problem, index, t)
      if (here%g < 0) then
        a = here
      else
        b = here
      end if
    end do
    bracket = bracket_t(a%t, b%t, a%g, b%g, 0, abs(b%t - a%t))
    do
      t = next_abscissa(bracket)
      if (.not. (t > bracket%a .and. t < bracket%b)) exit
      here = sample(self, method, problem, index, t)
      call narrow(bracket, t, here%g)
    end do
    passage = bracket%b
  end function passage

  !> The extremum between two samples whose rates have opposite signs.
  type(sample_t) function extremum(self, method, problem, index, left, right) result(here)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: left, right
    type(bracket_t) :: bracket
    real(dp) :: t, direction

    direction = sign(1.0_dp, right%rate)
    bracket = bracket_t(left%t, right%t, direction*left%rate, direction*right%rate, 0, abs(right%t - left%t))
    here = right
    do
      t = next_abscissa(bracket)
      if (.not. (t > bracket%a .and. t < bracket%b)) exit
      here = sample(self, method, problem, index, t)
      call narrow(bracket, t, direction*here%rate)
      if (abs(bracket%b - bracket%a) <= 1e-9_dp*bracket%width) exit
    end do
  end function extremum

  !> One event function at a time inside the last step.
  function sample(self, method, problem, index, t)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    type(sample_t) :: sample
    real(dp) :: g(max_events), rate(max_events)
    call method%interpolate(t, self%y)
    call problem%events(t, self%y, g, rate)
    sample = sample_t(t, g(index), rate(index))
  end function sample
end module event_search
