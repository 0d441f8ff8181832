!> The Adams method: coefficients, accuracy, order, interpolant, events, restarts.
module test_adams
  use kinds, only: dp
  use constants, only: pi
  use checks, only: checks_t
  use ode_method, only: ode_settings_t, step_done
  use adams_coefficients, only: moulton_constants
  use adams, only: adams_t
  use error_handling, only: error_t
  use ode_method, only: ode_method_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, integration_t, silent_observer_t, integration_done, evaluation_limit_reached
  use standard_problems, only: number_of
  use conditioning, only: condition_of
  use test_problems, only: oscillator_t, refusing_t, two_body_t, bouncing_ball_t, hopper_t, root_t, whole_step
  implicit none
  private
  public :: run_test_adams

contains

  subroutine run_test_adams(check)
    class(checks_t), intent(inout) :: check
    call constants_are_exact(check)
    call tolerance_is_kept(check)
    call interpolant_is_smooth(check)
    call root_at_start(check)
    call late_start_at_zero(check)
    call ball_impacts(check)
    call double_passages_are_found(check)
    call limits_end_trials(check)
  end subroutine run_test_adams

  !> Where every step is refused, the limit of evaluations ends the integration between two trials, and it can pause there.
  subroutine limits_end_trials(check)
    class(checks_t), intent(inout) :: check
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    integer, parameter :: most = 20, in_a_trial = 30
    type(refusing_t) :: problem
    class(ode_method_t), allocatable :: method
    type(silent_observer_t) :: observer
    type(integration_t) :: integration
    type(error_t), allocatable :: error
    real(dp) :: t, y(2)
    integer :: status, i
    problem%n = 2
    do i = 1, size(methods)
      call new_method(trim(methods(i)), method, error)
      method%settings = settings(2, 1e-6_dp, 1.0_dp)
      method%settings%max_evaluations = most
      t = 0
      y = [0, 1]
      call integrate(problem, method, t, y, 1.0_dp, 0, observer, status)
      call check%that(status == evaluation_limit_reached .and. method%statistics%evaluations < most + in_a_trial, &
        trim(methods(i))//': the limit of evaluations ends the trials of a step')
      call integration%begin(problem, method, 0.0_dp, y, 1.0_dp, 0)
      call integration%go_to(problem, method, observer, 1.0_dp, 1)
      call check%that(.not. integration%is_over .and. method%statistics%evaluations < most, &
        trim(methods(i))//': an integration pauses after a trial')
    end do
  end subroutine limits_end_trials

  !> Settings with one tolerance for n components.
  function settings(n, tolerance, span) result(s)
    integer, intent(in) :: n
    real(dp), intent(in) :: tolerance, span
    type(ode_settings_t) :: s
    allocate (s%relative(n), s%absolute(n))
    s%relative = tolerance
    s%absolute = tolerance
    s%span = span
  end function settings

  subroutine constants_are_exact(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: exact(13) = [1/2.0_dp, 1/12.0_dp, 1/24.0_dp, 19/720.0_dp, 3/160.0_dp, 863/60480.0_dp, &
      275/24192.0_dp, 33953/3628800.0_dp, 8183/1036800.0_dp, 3250433/479001600.0_dp, 4671/788480.0_dp, &
      13695779093.0_dp/2615348736000.0_dp, 2224234463.0_dp/475517952000.0_dp]
    real(dp) :: got(13)
    got = moulton_constants()
    call check%close_to(maxval(abs(got/exact - 1)), 0.0_dp, 1e-13_dp, 'Adams-Moulton constants are the exact rational numbers')
  end subroutine constants_are_exact

  subroutine tolerance_is_kept(check)
    class(checks_t), intent(inout) :: check
    type(two_body_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(4), t, error, tolerance, condition
    integer :: status, i, previous
    character(len=16) :: label

    problem%n = 4
    previous = 0
    condition = condition_of(number_of('D2'))   ! the same orbit over 20 instead of 18.8
    do i = 3, 12, 3
      tolerance = 10.0_dp**(-i)
      method%settings = settings(4, tolerance, 6*pi)
      t = 0
      y = [0.7_dp, 0.0_dp, 0.0_dp, sqrt(1.3_dp/0.7_dp)]   ! eccentricity 0.3, period 2 pi
      call integrate(problem, method, t, y, 6*pi, 0, observer, status)
      error = norm2(y - [0.7_dp, 0.0_dp, 0.0_dp, sqrt(1.3_dp/0.7_dp)])
      write (label, '(a,i0)') ' at 1e-', i
      call check%that(status == integration_done, 'integration of two bodies reaches its end'//trim(label))
      call check%close_to(error, 0.0_dp, 20*condition*tolerance, 'three orbits end at their start'//trim(label))
      call check%that(method%statistics%evaluations > previous, 'a smaller tolerance needs more evaluations'//trim(label))
      previous = method%statistics%evaluations
    end do
    call check%that(previous < 1100, 'three orbits at 1e-12 take less than 1100 evaluations')
  end subroutine tolerance_is_kept

  !> Value and derivative of the interpolant agree on both sides of every mesh point, and its error is that of the steps.
  subroutine interpolant_is_smooth(check)
    class(checks_t), intent(inout) :: check
    type(oscillator_t) :: problem
    type(adams_t) :: method
    real(dp) :: y(2), before(2), after(2), worst, jump, slope_jump, step_error, h
    integer :: status, i, j

    problem%n = 2
    method%settings = settings(2, 1e-8_dp, 20.0_dp)
    call method%start(problem, 0.0_dp, [0.0_dp, 1.0_dp], .true., status)
    worst = 0
    jump = 0
    slope_jump = 0
    step_error = 0
    before = 1   ! slope of y(1) at t = 0
    do i = 1, 150
      call whole_step(method, problem, status)
      if (status /= step_done) exit
      h = method%t - method%t_old
      call method%interpolate(method%t_old, y)
      jump = max(jump, maxval(abs(y - method%y_old)))
      call method%interpolate(method%t_old + 1e-4_dp*h, after)
      slope_jump = max(slope_jump, abs((after(1) - y(1))/(1e-4_dp*h) - &
        (y(2) - 0.5e-4_dp*h*y(1))))
      do j = 1, 9
        call method%interpolate(method%t_old + j*h/10, y)
        worst = max(worst, abs(y(1) - sin(method%t_old + j*h/10)))
      end do
      step_error = max(step_error, abs(method%y(1) - sin(method%t)))
    end do
    call check%that(status == step_done, 'integration of the oscillator reaches its end')
    call check%close_to(jump, 0.0_dp, 1e-14_dp, 'the interpolant has the value y at the beginning of the step')
    call check%close_to(slope_jump, 0.0_dp, 1e-7_dp, 'the interpolant has the slope f at the beginning of the step')
    call check%that(worst <= 1.5_dp*step_error + 1e-9_dp, 'the interpolant is as accurate as the steps')
  end subroutine interpolant_is_smooth

  !> A start at which f is smooth in the square root of the time, as at the beginning of a contact. If the problem declares this,
  !> the method needs a fraction of the evaluations, keeps the tolerance inside its steps, and respects the largest step.
  subroutine root_at_start(check)
    class(checks_t), intent(inout) :: check
    type(root_t) :: problem
    type(adams_t) :: method
    real(dp) :: y(1), t, worst, longest
    integer :: status, i, j, evaluations(2)

    problem%n = 1
    do i = 1, 2
      problem%smooth_in_root = i == 2
      method = adams_t()
      method%settings = settings(1, 1e-10_dp, 1.0_dp)
      method%settings%max_step = 0.1_dp
      call method%start(problem, 1.0_dp, [1.0_dp], .true., status)
      worst = 0
      longest = 0
      do
        call whole_step(method, problem, status)
        if (status /= step_done) exit
        longest = max(longest, method%t - method%t_old)
        do j = 0, 8
          t = method%t_old + (method%t - method%t_old)*j/8.0_dp
          call method%interpolate(t, y)
          worst = max(worst, abs(y(1) - exp((t - 1)**1.5_dp)))
        end do
        if (method%t >= 2) exit
      end do
      call check%that(status == step_done, 'integration from a square root reaches its end')
      call check%close_to(worst, 0.0_dp, 1e-8_dp, 'error after a square root at the start')
      call check%that(longest <= 0.1_dp*(1 + 1e-12_dp), 'the largest step is measured in time')
      evaluations(i) = method%statistics%evaluations
    end do
    call check%that(3*evaluations(2) < evaluations(1), 'steps in the square root of the time save two evaluations of three')
  end subroutine root_at_start

  subroutine ball_impacts(check)
    class(checks_t), intent(inout) :: check
    type(bouncing_ball_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t, exact, worst
    integer :: status, i

    problem%n = 2
    problem%n_events = 1
    problem%restitution = 0.9_dp
    method%settings = settings(2, 1e-10_dp, 20.0_dp)
    t = 0
    y = [1.0_dp, 0.0_dp]
    call integrate(problem, method, t, y, 20.0_dp, 0, observer, status)
    call check%that(status == integration_done, 'integration of the ball reaches its end')
    exact = sqrt(2.0_dp)
    worst = 0
    do i = 1, problem%impacts
      worst = max(worst, abs(problem%times(i) - exact))
      exact = exact + 2*sqrt(2.0_dp)*0.9_dp**i
    end do
    call check%that(exact > 20, 'no impact of the ball is missed')
    call check%that(problem%impacts == method%statistics%restarts, 'one restart for each impact')
    call check%close_to(worst, 0.0_dp, 1e-8_dp, 'impact times of the ball')
  end subroutine ball_impacts

  subroutine double_passages_are_found(check)
    class(checks_t), intent(inout) :: check
    type(hopper_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t, worst
    integer :: status, i

    problem%n = 2
    problem%n_events = 1
    problem%level = 1 - 1e-6_dp
    method%settings = settings(2, 1e-9_dp, 40.0_dp)
    t = 0
    y = [0.0_dp, 1.0_dp]
    call integrate(problem, method, t, y, 40.0_dp, 0, observer, status)
    call check%that(problem%passages == 7, 'seven intervals of 3 ms above the level are found within 6 s')
    worst = 0
    do i = 1, min(7, problem%passages)
      worst = max(worst, abs(problem%times(i) - (asin(problem%level) + 2*pi*(i - 1))))
    end do
    call check%close_to(worst, 0.0_dp, 1e-4_dp, 'times of the short intervals above the level')
  end subroutine double_passages_are_found
  !> A start long after t = 0 with a component equal to zero: its tolerance is so small that the component changes by it in less
  !> than the resolution of the time. The first step must be longer, and the integration must continue.
  subroutine late_start_at_zero(check)
    class(checks_t), intent(inout) :: check
    type(oscillator_t) :: problem
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t
    integer :: status
    problem%n = 2
    method%settings = settings(2, 1e-12_dp, 1.0_dp)
    method%settings%absolute = 1e-17_dp
    t = 1000
    y = [0.0_dp, 1.0_dp]
    call integrate(problem, method, t, y, 1001.0_dp, 0, observer, status)
    call check%that(status == integration_done, 'integration from a late start at zero reaches its end')
    call check%close_to(norm2(y - [sin(1.0_dp), cos(1.0_dp)]), 0.0_dp, 1e-10_dp, 'error after a late start at zero')
  end subroutine late_start_at_zero
end module test_adams
