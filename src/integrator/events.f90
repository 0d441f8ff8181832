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

  !> An event function that can pass zero before the next restart, and what the problem tells of it.
  type :: watched_t
    integer :: index = 0           !! of the problem
    type(event_form_t) :: form
    logical :: on_step_end = .false.
    logical :: low = .false.       !! it has been negative since the last restart: a passage counts
  end type watched_t

  !> The event functions at the end of what has been searched. Their values there are only asked for when they are needed.
  type :: event_watch_t
    private
    integer :: n = 0                     !! functions watched
    type(watched_t) :: watched(max_events)
    integer :: just_taken = 0            !! the event that led to the last restart
    logical :: fresh = .true.            !! no step since the restart
    logical :: is_sampled = .false.      !! the next three belong to the end of what has been searched
    real(dp) :: t = 0
    real(dp) :: g(max_events) = 0, rate(max_events) = 0   !! of all functions of the problem
    real(dp), allocatable :: y(:)        !! work
  contains
    procedure :: begin
    procedure :: search
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
    integer :: i
    self%just_taken = just_taken
    self%fresh = .true.
    if (.not. allocated(self%y)) allocate (self%y(size(y)))
    call choose_watched(self, problem)
    if (self%n == 0) return
    call look(self, problem, t, y)
    do i = 1, self%n
      self%watched(i)%low = self%g(self%watched(i)%index) < 0
    end do
  end subroutine begin

  !> Which functions are to be watched from now to the next restart: those that are not negative constants.
  subroutine choose_watched(self, problem)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    type(event_form_t) :: form
    integer :: i
    self%n = 0
    do i = 1, problem%n_events
      form = problem%event_form(i)
      if (form%known .and. form%first == 0 .and. form%constant < 0) cycle
      self%n = self%n + 1
      self%watched(self%n) = watched_t(i, form, problem%lands_on_step_end(i))
    end do
  end subroutine choose_watched

  !> Values and rates of the functions at (t, y), the end of what has been searched.
  subroutine look(self, problem, t, y)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    self%t = t
    call problem%events(t, y, self%g(:problem%n_events), self%rate(:problem%n_events))
    self%is_sampled = .true.
  end subroutine look

  !> To or from an archive, for a problem that has been in it before.
  subroutine exchange(self, problem, archive)
    class(event_watch_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    type(archive_t), intent(inout) :: archive
    integer :: i
    if (.not. allocated(self%y)) allocate (self%y(problem%n))
    if (archive%is_reading) call choose_watched(self, problem)
    do i = 1, self%n
      call archive%exchange(self%watched(i)%low)
    end do
    call archive%exchange(self%just_taken)
    call archive%exchange(self%fresh)
    call archive%exchange(self%is_sampled)
    call archive%exchange(self%t)
    call archive%exchange(self%g)
    call archive%exchange(self%rate)
  end subroutine exchange

  !> Search the last step of the method up to t_last. `index` is the first event, 0 if there is none; t_event is when it
  !> happened, on the not negative side, or where the search ended.
  subroutine search(self, method, problem, t_last, index, t_event)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_last
    integer, intent(out) :: index
    real(dp), intent(out) :: t_event
    real(dp) :: straying(2)
    integer :: i, first
    logical :: negative

    index = 0
    t_event = min(t_last, method%t)
    if (self%fresh) call take_passed(self, index, t_event)
    if (index > 0) return
    first = -1
    do i = 1, self%n
      associate (form => self%watched(i)%form)
        negative = form%known
        if (negative) then
          if (form%first /= first) call method%find_straying(form%first, straying)   ! else as for the function before
          first = form%first
          negative = stays_negative_for_certain(form, method, straying)
        end if
      end associate
      if (.not. negative) then
        call search_closely(self, method, problem, i, index, t_event)
        return
      end if
      self%watched(i)%low = .true.
    end do
    self%is_sampled = .false.
  end subroutine search

  !> In the first step after a restart: a function that was past zero already, and going on.
  pure subroutine take_passed(self, index, t_event)
    class(event_watch_t), intent(inout) :: self
    integer, intent(inout) :: index
    real(dp), intent(inout) :: t_event
    integer :: i
    do i = 1, self%n
      associate (candidate => self%watched(i)%index)
        if (candidate == self%just_taken) cycle
        if (self%g(candidate) > 0 .and. self%rate(candidate) >= 0 .or. &
            .not. self%g(candidate) < 0 .and. self%rate(candidate) > 0) then
          index = candidate
          t_event = self%t
          return
        end if
      end associate
    end do
    self%fresh = .false.
  end subroutine take_passed

  !> Search the last step up to t_event for the first passage of the functions from the one watched as number `first` on.
  subroutine search_closely(self, method, problem, first, index, t_event)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: first
    integer, intent(inout) :: index
    real(dp), intent(inout) :: t_event
    real(dp) :: t_before, g_before(max_events), rate_before(max_events)
    logical :: found
    real(dp) :: t_end, t_found
    integer :: i

    t_end = t_event
    if (.not. self%is_sampled) call look(self, problem, method%t_old, method%y_old)
    t_before = self%t
    g_before(:problem%n_events) = self%g(:problem%n_events)
    rate_before(:problem%n_events) = self%rate(:problem%n_events)
    if (t_end < method%t) then
      call method%interpolate(t_end, self%y)
      call look(self, problem, t_end, self%y)
    else
      call look(self, problem, method%t, method%y)
    end if
    do i = first, self%n
      associate (watched => self%watched(i))
        call search_one(self, method, problem, watched, sample_t(t_before, g_before(watched%index), &
          rate_before(watched%index)), sample_t(t_end, self%g(watched%index), self%rate(watched%index)), found, t_found)
        if (found .and. (index == 0 .or. t_found < t_event)) then
          index = watched%index
          t_event = t_found
        end if
        if (self%g(watched%index) < 0) watched%low = .true.
      end associate
    end do
  end subroutine search_closely

  !> Search one function from `before` to `here`, the end of the step or less.
  subroutine search_one(self, method, problem, watched, before, here, found, t_found)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    type(watched_t), intent(in) :: watched
    type(sample_t), intent(in) :: before, here
    logical, intent(out) :: found
    real(dp), intent(out) :: t_found
    type(sample_t) :: left, right
    integer :: i, pieces
    logical :: low, known

    found = .false.
    t_found = here%t
    low = watched%low
    if (low .and. here%g >= 0 .and. watched%on_step_end .and. .not. here%t < method%t) then
      found = .true.
      return
    end if
    if (low .and. before%g < 0) then
      known = watched%form%known
      if (known) call search_polynomial(self, method, problem, watched, before, here, known, found, t_found)
      if (known) return
      if (stays_negative(before, here)) return
    end if
    pieces = method%order + 2
    left = before
    do i = 1, pieces
      right = here
      if (i < pieces) right = sample(self, method, problem, watched%index, before%t + (here%t - before%t)*i/pieces)
      call search_piece(self, method, problem, watched%index, left, right, low, found, t_found)
      if (found) return
      left = right
    end do
  end subroutine search_one

  !> Search one function of known form, negative at `before`, if the method makes it a `known` polynomial.
  subroutine search_polynomial(self, method, problem, watched, before, here, known, found, t_found)
    class(event_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    type(watched_t), intent(in) :: watched
    type(sample_t), intent(in) :: before, here
    logical, intent(out) :: known, found
    real(dp), intent(out) :: t_found
    type(sample_t) :: left, right
    real(dp), parameter :: rounding = 1e-11_dp   !! of where in the step the polynomial passes zero
    real(dp) :: lower, upper, likely

    t_found = here%t
    call isolate_passage(watched%form, method, known, found, lower, upper, likely)
    if (.not. (known .and. found)) return
    left = before
    if (lower > 0) left = sample(self, method, problem, watched%index, method%time_at_share(lower))
    right = sample(self, method, problem, watched%index, method%time_at_share(upper))
    if (right%g < 0 .or. left%t > here%t) then   ! a touch within rounding, or beyond the end
      found = .false.
      return
    end if
    call approach(likely - rounding)
    call approach(likely + rounding)
    t_found = left%t
    if (left%g < 0) t_found = passage(self, method, problem, watched%index, left, right)
    found = t_found <= here%t

  contains

    !> Bring one end of what is to be searched to a share of the step.
    subroutine approach(share)
      real(dp), intent(in) :: share
      type(sample_t) :: middle
      if (.not. (share > lower .and. share < upper)) return
      middle = sample(self, method, problem, watched%index, method%time_at_share(share))
      if (.not. (middle%t > left%t .and. middle%t < right%t)) return
      if (middle%g < 0) then
        left = middle
      else
        right = middle
      end if
    end subroutine approach
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
    call problem%events(t, self%y, g(:problem%n_events), rate(:problem%n_events))
    sample = sample_t(t, g(index), rate(index))
  end function sample
end module events
