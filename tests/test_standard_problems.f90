!> Some problems of the standard battery: the error at the end is proportional to the tolerance; runs in threads give identical
!> results; rejected steps change nothing; the interpolant is as accurate as the steps. (The whole battery:
!> scripts/bench/compare_adams.sh.)
module test_standard_problems
  use kinds, only: dp
  use checks, only: checks_t
  use ode_method, only: step_done, limit_stability
  use ode_problem, only: ode_problem_t, step_admitted, step_too_deep
  use adams, only: adams_t
  use test_problems, only: whole_step
  use ode_solver, only: integrate, silent_observer_t, integration_done
  use standard_problems, only: standard_problem_t, new_standard_problem, standard_settings, number_of
  implicit none
  private
  public :: run_test_standard_problems

  !> Like its parent, but two of three steps longer than a thousandth of the span are rejected.
  type, extends(standard_problem_t) :: refusing_problem_t
  contains
    procedure :: judge_step => refuse
  end type refusing_problem_t

contains

  subroutine run_test_standard_problems(check)
    class(checks_t), intent(inout) :: check
    call errors_follow_tolerances(check)
    call threads_agree(check)
    call refused_steps_leave_no_trace(check)
    call interpolants(check)
  end subroutine run_test_standard_problems

  !> The solution at the end of a problem, integrated in 80 bits (scripts/bench/compare_adams.sh); B5, E2, E3, F1 and F2 agree with
  !> DETEST.
  pure function end_of(name) result(y)
    character(len=*), intent(in) :: name
    real(dp), allocatable :: y(:)
    select case (name)
    case ('A1')
      y = [exp(-20.0_dp)]
    case ('A3')
      y = [exp(sin(20.0_dp))]
    case ('A4')
      y = [20/(1 + 19*exp(-5.0_dp))]
    case ('B4')
      y = [0.982695092800639871645_dp, 2.19844708169490743216_dp, 0.912945250727630571981_dp]
    case ('B5')
      y = [-0.939657079872920866130_dp, -0.342117775400074956827_dp, 0.741412659619995182238_dp]
    case ('E1')
      y = [0.145672360072826330608_dp, -0.0988350019557439336652_dp]
    case ('E2')
      y = [2.00814976217494861187_dp, -0.0425088752732020779642_dp]
    case ('E3')
      y = [-0.100417885864724316839_dp, 0.241140013209595637644_dp]
    case ('E5')
      y = [14.1179739054262414506_dp, 2.4_dp]
    case ('F2')
      y = [70.0373105700860666203_dp]
    case default   ! F3
      y = [-0.372695755308818029540_dp, -0.623013794923419352142_dp]
    end select
  end function end_of

  subroutine run(problem, y, tolerance, max_order, method, status)
    class(standard_problem_t), intent(inout) :: problem
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: tolerance
    integer, intent(in) :: max_order
    type(adams_t), intent(out) :: method
    integer, intent(out) :: status
    type(silent_observer_t) :: observer
    real(dp) :: t
    method%settings = standard_settings(problem, tolerance)
    method%settings%max_order = max_order
    t = 0
    call integrate(problem, method, t, y, problem%t_end, 0, observer, status)
  end subroutine run

  subroutine errors_follow_tolerances(check)
    class(checks_t), intent(inout) :: check
    character(len=2), parameter :: chosen(11) = ['A1', 'A3', 'A4', 'B4', 'B5', 'E1', 'E2', 'E3', 'E5', 'F2', 'F3']
    type(standard_problem_t) :: problem
    type(adams_t) :: method
    real(dp), allocatable :: y(:)
    real(dp) :: tolerance, ratio, log_error(3:12), mean
    integer :: i, j, status, evaluations
    character(len=6) :: label
    evaluations = 0
    do i = 1, size(chosen)
      do j = 3, 12
        tolerance = 10.0_dp**(-j)
        call new_standard_problem(number_of(chosen(i)), problem, y)
        call run(problem, y, tolerance, 12, method, status)
        ratio = maxval(abs(y - end_of(chosen(i)))/(1 + abs(y)))/tolerance
        write (label, '(a,i0)') '1e-', j
        call check%that(status == integration_done, chosen(i)//' reaches its end at '//label)
        call check%that(ratio <= 100, chosen(i)//': error within 100 tolerances at '//label)
        log_error(j) = log10(max(ratio*tolerance, 1e-16_dp))
        if (index('A3 B5 E1 E3 F2 F3', chosen(i)) > 0) call check%that(method%statistics%limited_by(limit_stability) <= &
          0.07_dp*method%statistics%accepted, chosen(i)//' is not regarded as stiff at '//label)
        evaluations = evaluations + method%statistics%evaluations
      end do
      mean = sum([((7.5_dp - j)*log_error(j), j=3, 12)])/sum([((7.5_dp - j)**2, j=3, 12)])
      call check%close_to(mean, 1.0_dp, 0.25_dp, chosen(i)//': the error is proportional to the tolerance')
    end do
    call check%that(evaluations < 65000, 'evaluations of the chosen problems at ten tolerances')
  end subroutine errors_follow_tolerances

  subroutine threads_agree(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: runs = 16
    integer, parameter :: chosen(4) = [10, 15, 19, 28]
    real(dp) :: final(30, runs), single(30, runs)
    integer :: i
    do i = 1, runs
      call one(chosen(mod(i, 4) + 1), single(:, i))
    end do
    !$omp parallel do schedule(dynamic) num_threads(4)
    do i = 1, runs
      call one(chosen(mod(i, 4) + 1), final(:, i))
    end do
    !$omp end parallel do
    call check%that(all(abs(final - single) <= 0), 'runs in threads are the same to the last bit')
  contains
    subroutine one(number, y_end)
      integer, intent(in) :: number
      real(dp), intent(out) :: y_end(:)
      type(standard_problem_t) :: problem
      type(adams_t) :: method
      real(dp), allocatable :: y(:)
      integer :: status
      call new_standard_problem(number, problem, y)
      call run(problem, y, 1e-9_dp, 12, method, status)
      y_end = status
      y_end(:size(y)) = y
    end subroutine one
  end subroutine threads_agree

  subroutine refused_steps_leave_no_trace(check)
    class(checks_t), intent(inout) :: check
    type(refusing_problem_t) :: problem
    type(standard_problem_t) :: plain
    type(adams_t) :: method
    real(dp), allocatable :: y(:)
    integer :: status
    call new_standard_problem(number_of('B5'), plain, y)
    problem%standard_problem_t = plain
    call run(problem, y, 1e-9_dp, 12, method, status)
    associate (s => method%statistics)
      call check%that(s%rejected_penetration > s%accepted/4, 'many steps are rejected')
      call check%close_to(maxval(abs(y - end_of('B5'))), 0.0_dp, 1e-7_dp, 'rejected steps do not change the solution')
      call check%that(sum(s%limited_by) == s%accepted .and. sum(s%order_count) == s%accepted, 'every step is counted once')
      call check%that(s%evaluations == 2 + 2*s%accepted + s%rejected_error + s%rejected_penetration, &
        'number of evaluations with rejected steps')
    end associate
  end subroutine refused_steps_leave_no_trace

  pure subroutine refuse(self, t_old, y_old, t, y, verdict, fraction)
    class(refusing_problem_t), intent(in) :: self
    real(dp), intent(in) :: t_old, y_old(:), t, y(:)
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    fraction = 0.5_dp
    verdict = step_admitted
    if (t - t_old > 1e-3_dp*self%t_end .and. mod(int(1e5_dp*t), 3) > 0) verdict = step_too_deep
  end subroutine refuse

  !> For A3: the error inside the steps is no larger than at their ends, and the interpolant agrees with y and f at both
  !> ends, at several tolerances and orders, also during the start and after rejected steps.
  subroutine interpolants(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: orders(4) = [2, 5, 8, 12]
    type(standard_problem_t) :: problem
    type(adams_t) :: method
    real(dp), allocatable :: y(:)
    real(dp) :: inner, outer, jump, kink, slope, a(1), b(1), t, h, tolerance
    integer :: i, j, k, step, status
    character(len=24) :: label
    do i = 4, 10, 2
      do j = 1, 4
        tolerance = 10.0_dp**(-i)
        call new_standard_problem(number_of('A3'), problem, y)
        method = adams_t()
        allocate (method%settings%relative(1), method%settings%absolute(1))
        method%settings%relative = tolerance
        method%settings%absolute = tolerance
        method%settings%span = 20
        method%settings%max_order = orders(j)
        call method%start(problem, 0.0_dp, y, .true., status)
        inner = 0
        outer = 0
        jump = 0
        kink = 0
        do step = 1, 40000
          call whole_step(method, problem, status)
          if (status /= step_done .or. method%t > 20) exit
          h = method%t - method%t_old
          outer = max(outer, abs(method%y(1) - exp(sin(method%t))))
          do k = 1, 7
            t = method%t_old + k*h/8
            call method%interpolate(t, a)
            inner = max(inner, abs(a(1) - exp(sin(t))))
          end do
          call method%interpolate(method%t_old, a)
          jump = max(jump, abs(a(1) - method%y_old(1)))
          if (h < 1e-3_dp) cycle
          call method%interpolate(method%t_old + 1e-4_dp*h, b)   ! f along the old end
          slope = method%y_old(1)*cos(method%t_old)
          kink = max(kink, abs((b(1) - a(1))/(1e-4_dp*h) - slope)/(1e-4_dp*h*10 + 1e-12_dp/h + 1e-10_dp))
        end do
        write (label, '(a,i0,a,i0)') ' order ', orders(j), ', 1e-', i
        call check%that(inner <= 1.5_dp*outer + 3*tolerance, 'error of the interpolant,'//trim(label))
        call check%close_to(jump, 0.0_dp, 1e-13_dp, 'the interpolant is continuous,'//trim(label))
        call check%that(kink <= 1, 'derivative of the interpolant at the beginning of the step,'//trim(label))
      end do
    end do
  end subroutine interpolants
end module test_standard_problems
