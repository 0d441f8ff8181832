!> Finding events inside a step: the first passage of an event function from negative to not negative.
!>
!> Where the problem gives an event function as a polynomial in the state, it is a polynomial along the step, and its first
!> passage is found or proven absent (`event_proof`), however short the function stays above zero.
!>
!> All others are followed with their rate. A cubic through values and rates at both ends of the step, with a margin for
!> its own curvature, tells the steps in which nothing is to be expected; the rest is sampled on the interpolant, so that a
!> function that passes zero and comes back within one step is found in general. So it is, for any function, in the first step
!> after a restart until it has become negative.
module events
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, event_form_t, max_events
  use ode_method, only: ode_method_t
  use archive, only: archive_t
  use event_proof, only: stays_negative_for_certain, isolate_passage
  use roots, only: bracket_t, next_abscissa, narrow
  implicit none
  private
  public :: event_watch_t

  !> One event function at one instant.
  type :: sample_t
    real(dp) :: t = 0, g = 0, rate = 0
  end type sample_t

  !> The event functions at the end of what has been searched.
  type :: event_watch_t
    private
    integer :: n = 0
    type(sample_t) :: last(max_events)   !! at the beginning of the next step
    logical :: low(max_events) = .false. !! the function has been negative since the last restart: a passage counts
    integer :: just_taken = 0            !! the event that led to the last restart
    logical :: fresh = .true.            !! no step since the restart
    real(dp), allocatable :: y(:)        !! work
  contains
    procedure :: begin
    procedure :: search
    procedure :: rough_time
    procedure :: exchange
  end type event_watch_t

contains

  !> Start watching at (t, y), after a start or restart of the method. Event `just_taken` (0: none) is not taken again
  !> before its function has been negative; any other that is past zero already and goes on is taken at once.
  subroutine begin(self, problem, t, y, just_taken)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    integer, intent(in) :: just_taken
    real(dp) :: g(max_events), rate(max_events)
    integer :: i
    self%just_taken = just_taken
    self%n = problem%n_events
    self%fresh = .true.
    if (.not. allocated(self%y)) allocate (self%y(size(y)))
    if (self%n == 0) return
    call problem%events(t, y, g(:self%n), rate(:self%n))
    do i = 1, self%n
      self%last(i) = sample_t(t, g(i), rate(i))
      self%low(i) = g(i) < 0
    end do
  end subroutine begin

  !> To or from an archive, for states of n components.
  subroutine exchange(self, n, archive)
    class(event_watch_t), intent(inout) :: self
    integer, intent(in) :: n
    type(archive_t), intent(inout) :: archive
    integer :: i
    if (.not. allocated(self%y)) allocate (self%y(n))
    call archive%exchange(self%n)
    do i = 1, max_events
      call archive%exchange(self%last(i)%t)
      call archive%exchange(self%last(i)%g)
      call archive%exchange(self%last(i)%rate)
    end do
    call archive%exchange(self%low)
    call archive%exchange(self%just_taken)
    call archive%exchange(self%fresh)
  end subroutine exchange

  !> When the first event at which f is not smooth is to be expected, by the tangents of the event functions.
  pure real(dp) function rough_time(self, problem)
    class(event_watch_t), intent(in) :: self
    class(ode_problem_t), intent(in) :: problem
    integer :: i
    rough_time = huge(rough_time)
    do i = 1, self%n
      associate (last => self%last(i))
        if (.not. (last%g < 0 .and. last%rate > 0)) cycle
        if (problem%is_rough_at(i)) rough_time = min(rough_time, last%t - last%g/last%rate)
      end associate
    end do
  end function rough_time

  !> Search the last step of the method up to t_last. `index` is the first event, 0 if there is none; then (t_event,
  !> y_event) is where it happened, on the not negative side.
  subroutine search(self, method, problem, t_last, index, t_event, y_event)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_last
    integer, intent(out) :: index
    real(dp), intent(out) :: t_event
    real(dp), intent(inout) :: y_event(:)
    real(dp) :: g(max_events), rate(max_events), t_found, t_end
    type(sample_t) :: here
    logical :: found
    integer :: i

    index = 0
    t_event = t_last
    if (self%n == 0) return
    if (self%fresh) then
      do i = 1, self%n   ! already past at the restart, and going on
        if (i == self%just_taken) cycle
        if (self%last(i)%g > 0 .and. self%last(i)%rate >= 0 .or. &
            .not. self%last(i)%g < 0 .and. self%last(i)%rate > 0) then
          index = i
          t_event = self%last(i)%t
          y_event = method%y_old
          return
        end if
      end do
    end if
    t_end = min(t_last, method%t)
    if (t_end < method%t) then
      call method%interpolate(t_end, self%y)
      call problem%events(t_end, self%y, g(:self%n), rate(:self%n))
    else
      call problem%events(method%t, method%y, g(:self%n), rate(:self%n))
    end if
    do i = 1, self%n
      here = sample_t(t_end, g(i), rate(i))
      call search_one(self, method, problem, i, here, found, t_found)
      if (found .and. (index == 0 .or. t_found < t_event)) then
        index = i
        t_event = t_found
      end if
      if (.not. found) self%last(i) = here
      if (here%g < 0) self%low(i) = .true.
    end do
    self%fresh = .false.
    if (index > 0) call method%interpolate(t_event, y_event)
  end subroutine search

  !> Search one function from its last sample to `here`.
  subroutine search_one(self, method, problem, index, here, found, t_found)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: here
    logical, intent(out) :: found
    real(dp), intent(out) :: t_found
    type(sample_t) :: left, right
    integer :: i, pieces
    logical :: low, known

    found = .false.
    t_found = here%t
    left = self%last(index)
    low = self%low(index)
    if (low .and. here%g >= 0 .and. problem%lands_on_step_end(index) .and. .not. here%t < method%t) then
      found = .true.
      return
    end if
    if (low .and. left%g < 0) then
      call search_polynomial(self, method, problem, index, here, known, found, t_found)
      if (known) return
      if (stays_negative(left, here)) return
    end if
    pieces = method%order + 2
    do i = 1, pieces
      right = here
      if (i < pieces) right = sample(self, method, problem, index, &
        self%last(index)%t + (here%t - self%last(index)%t)*i/pieces)
      call search_piece(self, method, problem, index, left, right, low, found, t_found)
      if (found) return
      left = right
    end do
  end subroutine search_one

  !> Search one function that is negative at its last sample up to `here`, if the problem and the method make it a `known`
  !> polynomial.
  subroutine search_polynomial(self, method, problem, index, here, known, found, t_found)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: here
    logical, intent(out) :: known, found
    real(dp), intent(out) :: t_found
    type(event_form_t) :: form
    type(sample_t) :: left, right
    real(dp) :: lower, upper

    found = .false.
    t_found = here%t
    form = problem%event_form(index)
    known = form%known
    if (.not. known) return
    if (here%g < 0) then
      if (stays_negative_for_certain(form, method)) return
    end if
    call isolate_passage(form, method, known, found, lower, upper)
    if (.not. (known .and. found)) return
    left = self%last(index)
    if (lower > 0) left = sample(self, method, problem, index, method%time_at_share(lower))
    right = sample(self, method, problem, index, method%time_at_share(upper))
    if (right%g < 0 .or. left%t > here%t) then   ! a touch within rounding, or beyond the end
      found = .false.
      return
    end if
    t_found = left%t
    if (left%g < 0) t_found = passage(self, method, problem, index, left, right)
    found = t_found <= here%t
  end subroutine search_polynomial

  !> Whether a function that is negative at both ends cannot reach zero between them: its cubic, in Bernstein form and
  !> with its deviation from the straight line counted twice, stays negative.
  pure logical function stays_negative(left, right)
    type(sample_t), intent(in) :: left, right
    real(dp) :: h, inner_left, inner_right, bend
    h = (right%t - left%t)/3
    inner_left = left%g + h*left%rate
    inner_right = right%g - h*right%rate
    bend = max(abs(inner_left - (2*left%g + right%g)/3), abs(inner_right - (left%g + 2*right%g)/3))
    stays_negative = left%g < 0 .and. right%g < 0 .and. inner_left + bend < 0 .and. inner_right + bend < 0
  end function stays_negative

  !> Search between two samples. `low` tells whether the function has been negative before, and is updated.
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
    if (.not. low .and. right%g >= 0 .and. left%rate < 0 .and. right%rate > 0) then
      start = extremum(self, method, problem, index, left, right)   ! it may dip below zero in between
      low = start%g < 0
    end if
    if (low .and. start%g < 0 .and. right%g >= 0) then
      found = .true.
      t_found = passage(self, method, problem, index, start, right)
    else if (low .and. start%g < 0 .and. start%rate > 0 .and. right%rate < 0) then
      if (.not. stays_negative(start, right)) then
        peak = extremum(self, method, problem, index, start, right)
        found = peak%g >= 0
        if (found) t_found = passage(self, method, problem, index, start, peak)
      end if
    end if
    low = low .or. right%g < 0
  end subroutine search_piece

  !> The first instant, to the resolution of the time, at which the function is not negative.
  real(dp) function passage(self, method, problem, index, left, right)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: left, right
    type(bracket_t) :: bracket
    type(sample_t) :: here
    real(dp) :: t

    bracket = bracket_t(left%t, right%t, left%g, right%g, 0, abs(right%t - left%t))
    do
      t = next_abscissa(bracket)
      if (.not. (t > bracket%a .and. t < bracket%b)) exit
      here = sample(self, method, problem, index, t)
      call narrow(bracket, t, here%g)
    end do
    passage = bracket%b
  end function passage

  !> The extremum between two samples whose rates have opposite signs.
  function extremum(self, method, problem, index, left, right) result(here)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    type(sample_t), intent(in) :: left, right
    type(sample_t) :: here
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
    call problem%events(t, self%y, g(:self%n), rate(:self%n))
    sample = sample_t(t, g(index), rate(index))
  end function sample
end module events
