!> Coefficients against exact values, the order of the formulas, their stability limits.
module test_adams_order
  use kinds, only: dp
  use checks, only: checks_t
  use adams_coefficients, only: adams_coefficients_t, stability_limit
  use adams_differences, only: lanes, extrapolate, restore_differences
  use adams, only: adams_t
  use test_problems, only: modulated_t
  implicit none
  private
  public :: run_test_adams_order

  character(len=2), parameter :: digits(12) = ['1 ', '2 ', '3 ', '4 ', '5 ', '6 ', '7 ', '8 ', '9 ', '10', '11', '12']

contains

  subroutine run_test_adams_order(check)
    class(checks_t), intent(inout) :: check
    call constant_step_coefficients(check)
    call variable_step_coefficients(check)
    call rejected_step_coefficients(check)
    call rejected_step_differences(check)
    call orders_at_fixed_step(check)
    call stability_limits(check)
  end subroutine run_test_adams_order

  !> g_i are the Adams-Bashforth constants, alpha_i = 1/i, beta_i = sigma_i = 1.
  subroutine constant_step_coefficients(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: exact(13) = [1.0_dp, 1/2.0_dp, 5/12.0_dp, 3/8.0_dp, 251/720.0_dp, 95/288.0_dp, &
      19087/60480.0_dp, 5257/17280.0_dp, 1070017/3628800.0_dp, 25713/89600.0_dp, 26842253/95800320.0_dp, &
      4777223/17418240.0_dp, 703604254357.0_dp/2615348736000.0_dp]
    type(adams_coefficients_t) :: coefficients
    integer :: i
    real(dp) :: worst
    call coefficients%reset()
    call coefficients%update(0.1_dp, 0.0_dp, 1, 0)
    do i = 2, 12   ! the order rises with every step, as after a start
      call coefficients%update(0.1_dp, 0.1_dp, i, i - 1)
    end do
    call coefficients%update(0.1_dp, 0.1_dp, 12, 12)
    worst = maxval(abs(coefficients%g/exact - 1))
    call check%close_to(worst, 0.0_dp, 1e-14_dp, 'g at constant step: exact rational numbers')
    worst = maxval(abs(coefficients%alpha*[(i, i=1, 12)] - 1))
    call check%close_to(worst, 0.0_dp, 1e-15_dp, 'alpha at constant step')
    worst = max(maxval(abs(coefficients%beta - 1)), maxval(abs(coefficients%sigma - 1)))
    call check%close_to(worst, 0.0_dp, 1e-15_dp, 'beta and sigma at constant step')
  end subroutine constant_step_coefficients

  !> On a mesh with variable steps: psi from the mesh, g by integration of the Newton basis, beta and sigma by their products.
  subroutine variable_step_coefficients(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: k = 8, steps = 11
    real(dp), parameter :: h(steps) = [0.1_dp, 0.2_dp, 0.4_dp, 0.4_dp, 0.3_dp, 0.15_dp, 0.15_dp, 0.15_dp, 0.2_dp, 0.25_dp, &
      0.25_dp]
    type(adams_coefficients_t) :: coefficients
    real(dp) :: mesh(0:steps), psi(k), old(k), basis(0:k), beta, sigma, shift, worst
    integer :: i, j
    call coefficients%reset()
    mesh(0) = 0
    do i = 1, steps
      mesh(i) = mesh(i - 1) + h(i)
      call coefficients%update(h(i), merge(h(max(1, i - 1)), 0.0_dp, i > 1), min(i, k), min(i - 1, k))
    end do
    psi = [(mesh(steps) - mesh(steps - i), i=1, k)]
    old = [(mesh(steps - 1) - mesh(steps - 1 - i), i=1, k)]
    call check%close_to(maxval(abs(coefficients%psi(:k)/psi - 1)), 0.0_dp, 1e-14_dp, 'psi on an uneven mesh')
    worst = 0
    basis = 0
    basis(0) = 1   ! coefficients in s = (t - t_n)/h of the product over j < i of (t - t_(n+1-j))/psi_j(n+1)
    beta = 1
    sigma = 1
    shift = 0
    do i = 1, k
      worst = max(worst, abs(sum(basis/[(j + 1, j=0, k)])/coefficients%g(i) - 1), abs(sigma/coefficients%sigma(i) - 1))
      if (i > 1) worst = max(worst, abs(beta/coefficients%beta(i) - 1))
      basis(1:k) = (basis(1:k)*shift + basis(0:k - 1)*h(steps))/psi(i)
      basis(0) = basis(0)*shift/psi(i)
      shift = old(i)
      beta = beta*psi(i)/old(i)
      sigma = sigma*i*h(steps)/psi(i)
    end do
    worst = max(worst, abs(sum(basis/[(j + 1, j=0, k)])/coefficients%g(k + 1) - 1))
    call check%close_to(worst, 0.0_dp, 1e-12_dp, 'g, beta and sigma on an uneven mesh')
  end subroutine variable_step_coefficients

  !> A step that is tried, rejected and repeated with a shorter length has the coefficients of the shorter step.
  subroutine rejected_step_coefficients(check)
    class(checks_t), intent(inout) :: check
    type(adams_coefficients_t) :: rejected, plain
    real(dp), parameter :: h(9) = [0.1_dp, 0.2_dp, 0.4_dp, 0.4_dp, 0.3_dp, 0.15_dp, 0.15_dp, 0.2_dp, 0.25_dp]
    real(dp) :: worst
    integer :: i, k, tries
    do k = 2, 6
      call plain%reset()
      call rejected%reset()
      worst = 0
      do i = 1, size(h)
        call plain%update(h(i), merge(h(max(1, i - 1)), 0.0_dp, i > 1), min(i, k), min(i - 1, k))
        if (i > k) then   ! the history is complete
          do tries = 1, 2
            call rejected%update(tries*2*h(i), h(max(1, i - 1)), k, k)
            call rejected%undo_update(tries*2*h(i), k)
          end do
        end if
        call rejected%update(h(i), merge(h(max(1, i - 1)), 0.0_dp, i > 1), min(i, k), min(i - 1, k))
        if (i <= k) cycle
        if (abs(h(i) - h(max(1, i - 1))) > 0) worst = max(worst, maxval(abs(rejected%g(:k + 1) - plain%g(:k + 1))), &
          maxval(abs(rejected%beta(:k) - plain%beta(:k))), abs(rejected%beta_next - plain%beta_next), &
          abs(rejected%sigma_next - plain%sigma_next))
        worst = max(worst, maxval(abs(rejected%psi(:k) - plain%psi(:k))))
      end do
      call check%close_to(worst, 0.0_dp, 1e-13_dp, 'a rejected step does not change the coefficients, k = '//trim(digits(k)))
    end do
  end subroutine rejected_step_coefficients

  !> Prediction and its withdrawal leave the differences unchanged, including the carried rounding errors and the padding with
  !> zeros.
  subroutine rejected_step_differences(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n = 5, blocks = (n + lanes - 1)/lanes, k = 4, width = lanes*blocks
    real(dp), parameter :: beta(k) = [1.0_dp, 1.5_dp, 0.75_dp, 2.0_dp], g(k) = [1.0_dp, 0.5_dp, 0.4_dp, 0.3_dp], next = 1.25_dp
    real(dp) :: phi(width, k + 2), before(width, k + 2), owed(width), slope(width), predicted(n), carry(n), left_out(n), y(n)
    integer :: i, j
    phi = 0
    owed = 0
    do i = 1, n
      phi(i, :) = [(cos(real(i*j, dp)), j=1, k + 2)]
      owed(i) = sin(real(i, dp))
      y(i) = i
    end do
    before = phi + spread(owed, 2, k + 2)
    carry = 0
    call extrapolate(n, blocks, k, 0.1_dp, g, beta, next, y, carry, owed, phi, slope, predicted, left_out)
    call check%close_to(maxval(abs(predicted - (y + 0.1_dp*matmul(before(:n, :k), beta*g)))), 0.0_dp, 1e-14_dp, &
      'the prediction is the sum of the differences')
    call restore_differences(width, k, beta, next, phi)
    call check%close_to(maxval(abs(phi(:, :k + 1) + spread(owed, 2, k + 1) - before(:, :k + 1))), 0.0_dp, 1e-14_dp, &
      'a rejected step does not change the differences')
    call check%that(.not. maxval(abs(phi(n + 1:, :))) > 0, 'the padding of the differences stays zero')
  end subroutine rejected_step_differences

  !> The largest error up to t = 4 of y' = y cos t with `n` steps of order k, from an exact history.
  function error_of(k, n) result(error)
    integer, intent(in) :: k, n
    real(dp) :: error, h, x(k), f(1, k)
    type(modulated_t) :: problem
    type(adams_t) :: method
    integer :: i, status
    problem%n = 1
    h = 4.0_dp/n
    allocate (method%settings%relative(1), method%settings%absolute(1))
    method%settings%relative = 1
    method%settings%absolute = 1
    method%settings%max_order = k
    method%settings%fixed_step = h
    x = [((i - k)*h, i=1, k)]
    f(1, :) = cos(x)*exp(sin(x))
    call method%start_with_history(problem, x, f, [1.0_dp], h, status)
    error = 0
    do i = 1, n
      call method%step(problem, status)
      error = max(error, abs(method%y(1) - exp(sin(method%t))))
    end do
  end function error_of

  !> With local extrapolation the method of order k converges with the power k+1 of the step length.
  subroutine orders_at_fixed_step(check)
    class(checks_t), intent(inout) :: check
    integer :: k, n
    real(dp) :: order
    do k = 1, 12
      n = merge(128, 48, k <= 6)
      order = log(error_of(k, n)/error_of(k, 2*n))/log(2.0_dp)
      call check%close_to(order, k + 1.0_dp, 0.5_dp, 'order of the error at fixed step, k = '//trim(digits(k)))
    end do
  end subroutine orders_at_fixed_step

  !> y' = lambda y with h lambda slightly below and above the stability limit: the solution decays, or grows.
  subroutine stability_limits(check)
    class(checks_t), intent(inout) :: check
    integer :: k
    do k = 1, 12
      call check%that(grows(k, 1.02_dp*stability_limit(k) + 0.01_dp), 'unstable above the limit, k = '//trim(digits(k)))
      call check%that(.not. grows(k, 0.98_dp*stability_limit(k) - 0.01_dp), 'stable below the limit, k = '//trim(digits(k)))
    end do
  end subroutine stability_limits

  logical function grows(k, rate)
    integer, intent(in) :: k
    real(dp), intent(in) :: rate
    type(modulated_t) :: problem
    type(adams_t) :: method
    real(dp) :: x(k), f(1, k)
    integer :: i, status
    problem%n = 1
    problem%decay = rate
    allocate (method%settings%relative(1), method%settings%absolute(1))
    method%settings%relative = 1
    method%settings%absolute = 1
    method%settings%max_order = k
    method%settings%fixed_step = 1
    x = [(real(i - k, dp), i=1, k)]
    f(1, :) = [(-rate*(-1)**i, i=1, k)]   ! an oscillating history excites every root
    call method%start_with_history(problem, x, f, [1.0_dp], 1.0_dp, status)
    do i = 1, 8000
      call method%step(problem, status)
      if (abs(method%y(1)) > 1e12_dp) exit
    end do
    grows = abs(method%y(1)) > 1
  end function grows
end module test_adams_order
