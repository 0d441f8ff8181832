!> Interface between an integrator and a system of ordinary differential equations with events.
!>
!> The system is y' = f(t, y) with a discrete state that changes only in `handle_event`; between events f is smooth. All procedures
!> that an integrator may call with trial states (`derivatives`, `events`, `judge_step`) are pure: a rejected step does not change
!> the problem.
module ode_problem
  use kinds, only: dp
  implicit none
  private
  public :: ode_problem_t, difference_jacobian, difference_by_parts
  public :: step_admitted, step_too_deep, step_too_far
  public :: event_continue, event_stop, max_events

  integer, parameter :: max_events = 24   !! largest number of event functions

  !> Verdicts of `judge_step`.
  integer, parameter :: step_admitted = 0   !! the step is accepted
  integer, parameter :: step_too_deep = 1   !! the penetration is larger than allowed: shorten the step
  integer, parameter :: step_too_far = 2    !! forces that no evaluation of the step shows lie within it: shorten the step

  !> Actions after an event.
  integer, parameter :: event_continue = 0  !! restart the method at the event
  integer, parameter :: event_stop = 1      !! end the integration at the event

  !> A system of ordinary differential equations with the state y = (positions | their rates, in the same order | first-order states
  !> | quadratures). A problem without positions has first-order states only.
  type, abstract :: ode_problem_t
    integer :: n = 0             !! number of equations
    integer :: n_positions = 0   !! number of positions; their derivatives are taken from the rates and not from f
    integer :: n_quadratures = 0 !! number of quadratures; nothing depends on them
    integer :: mode = 0          !! present discrete state for the choice of a method, 0..highest_mode
    integer :: highest_mode = 0  !! must be set before the integration
    integer :: n_events = 0   !! number of event functions in the present discrete state
    logical :: refuses_steps = .true.   !! `judge_step` may refuse steps; otherwise it is not called
    logical :: smooth_in_root = .false. !! since the last (re)start f is smooth in sqrt(t - t_start), not in t
  contains
    procedure, non_overridable :: n_states
    procedure(derivatives), deferred :: derivatives
    procedure :: jacobian => difference_jacobian
    procedure :: events => no_events
    procedure :: judge_step => admit_every_step
    procedure :: handle_event => stop_at_event
    procedure :: lands_on_step_end => never_on_step_end
    procedure :: next_kink_time => no_kink
  end type ode_problem_t

  abstract interface
    !> Right-hand side f(t, y). `in_domain` is false if the model is not defined at y; dydt must not be used then. The arrays have
    !> explicit shapes, which avoids passing and checking strides in every call.
    pure subroutine derivatives(self, t, y, dydt, in_domain)
      import :: ode_problem_t, dp
      class(ode_problem_t), intent(in) :: self
      real(dp), intent(in) :: t
      real(dp), intent(in) :: y(self%n)
      real(dp), intent(out) :: dydt(self%n)
      logical, intent(out) :: in_domain
    end subroutine derivatives
  end interface

contains

  !> Number of first-order states.
  pure integer function n_states(self)
    class(ode_problem_t), intent(in) :: self
    n_states = self%n - 2*self%n_positions - self%n_quadratures
  end function n_states

  !> Derivatives for Newton's method: with m positions and k rates and first-order states, those of dydt(m+1:m+k) with respect to
  !> the positions, a_p (k, m), and to rates and states, a_v (k, k). The default is one-sided differences; elements are 0 where f is
  !> not defined at the state or next to it.
  subroutine difference_jacobian(self, t, y, a_p, a_v)
    class(ode_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    integer :: part(size(a_p, 2) + size(a_v, 1))
    part = 0
    call difference_by_parts(self, t, y, part, a_p, a_v)
  end subroutine difference_jacobian

  !> The same where states of one part have an influence on the rates of that part alone: the first states of all parts are moved at
  !> once, then the second ones, and so on.
  subroutine difference_by_parts(self, t, y, part, a_p, a_v)
    class(ode_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    integer, intent(in) :: part(:)   !! number of the part of each state, 1, 2, ...; 0: of none
    real(dp), intent(out) :: a_p(:, :), a_v(:, :)
    real(dp) :: f(self%n), moved(self%n), state(self%n), step
    logical :: in_domain
    integer :: i, m, k

    m = size(a_p, 2)
    k = size(a_v, 1)
    a_p = 0
    a_v = 0
    call self%derivatives(t, y, f, in_domain)
    if (.not. in_domain) return
    call move_parts(self, t, y, part, f, a_v)
    do i = 1, m + k
      if (part(i) > 0) cycle
      step = sqrt(epsilon(1.0_dp))*max(abs(y(i)), 1e-5_dp)
      state = y
      state(i) = y(i) + step
      call self%derivatives(t, state, moved, in_domain)
      if (.not. in_domain) then
        step = -step
        state(i) = y(i) + step
        call self%derivatives(t, state, moved, in_domain)
      end if
      if (.not. in_domain) cycle
      moved(m + 1:m + k) = (moved(m + 1:m + k) - f(m + 1:m + k))/step
      if (i <= m) then
        a_p(:, i) = moved(m + 1:m + k)
      else
        a_v(:, i - m) = moved(m + 1:m + k)
      end if
    end do
  end subroutine difference_by_parts

  !> The derivatives of the rates of states that belong to a part.
  subroutine move_parts(self, t, y, part, f, a_v)
    class(ode_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    integer, intent(in) :: part(:)
    real(dp), intent(in) :: f(:)             !! at (t, y)
    real(dp), intent(inout) :: a_v(:, :)
    real(dp) :: moved(self%n), state(self%n), step(self%n)
    integer :: place(size(part)), m, i, j, k   ! place: of a state in its part
    logical :: in_domain
    m = size(part) - size(a_v, 1)
    place = [(count(part(:i) == part(i)), i=1, size(part))]
    do k = 1, maxval(place, part > 0)
      step = 0
      do i = 1, size(part)
        if (part(i) > 0 .and. place(i) == k) step(i) = sqrt(epsilon(1.0_dp))*max(abs(y(i)), 1e-5_dp)
      end do
      state = y + step
      call self%derivatives(t, state, moved, in_domain)
      if (.not. in_domain) then
        step = -step
        state = y + step
        call self%derivatives(t, state, moved, in_domain)
      end if
      if (.not. in_domain) cycle
      do j = m + 1, size(part)
        do i = m + 1, size(part)
          if (abs(step(i)) > 0 .and. part(j) == part(i)) a_v(j - m, i - m) = (moved(j) - f(j))/step(i)
        end do
      end do
    end do
  end subroutine move_parts

  !> Event functions and their rates along the motion, with signs such that an event is a passage from negative to positive. g and
  !> g_rate have n_events elements. The default is for problems without events.
  pure subroutine no_events(self, t, y, g, g_rate)
    class(ode_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = -1
    g_rate = 0
  end subroutine no_events

  !> Judge a step that meets the error tolerance. If it is refused, `fraction` (0 < fraction < 1) of the step is proposed for the
  !> next trial. The default accepts every step.
  pure subroutine admit_every_step(self, t_old, y_old, t, y, verdict, fraction)
    class(ode_problem_t), intent(in) :: self
    real(dp), intent(in) :: t_old, y_old(:), t, y(:)
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    verdict = step_admitted
    fraction = 1
  end subroutine admit_every_step

  !> Handle event `index` at (t, y); the discrete state and y may be changed. The default ends the integration.
  subroutine stop_at_event(self, index, t, y, action)
    class(ode_problem_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    action = event_stop
  end subroutine stop_at_event

  !> Whether event `index` is taken at the end of the step in which it occurs, instead of at its root. The default is no.
  pure logical function never_on_step_end(self, index)
    class(ode_problem_t), intent(in) :: self
    integer, intent(in) :: index
    never_on_step_end = .false.
  end function never_on_step_end

  !> Predicted time, from the tangent at (t, y), of an event at which f varies as a non-integer power of the remaining time: steps
  !> are shortened before it. The default is never: the largest number.
  pure real(dp) function no_kink(self, t, y)
    class(ode_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    no_kink = huge(no_kink)
  end function no_kink
end module ode_problem
