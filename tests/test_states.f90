!> First-order states in addition to positions, with all integrators.
module test_states
  use kinds, only: dp
  use checks, only: checks_t
  use error_handling, only: error_t
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t
  use adams, only: adams_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, silent_observer_t, integration_done
  implicit none
  private
  public :: run_test_states

  !> A unit mass at p, held by a unit spring whose other end z is in a dashpot (Maxwell's element):
  !> p'' = -(p - z), z' = (p - z)/tau, and the work w lost in it, w' = (p - z)^2/tau. y = (p, p', z, w).
  type, extends(ode_problem_t) :: maxwell_t
    real(dp) :: tau = 1
  contains
    procedure :: derivatives
  end type maxwell_t

  real(dp), parameter :: t_end = 8
  character(len=5), parameter :: names(3) = ['adams', 'radau', 'auto ']

contains

  subroutine run_test_states(check)
    class(checks_t), intent(inout) :: check
    call states_are_counted(check)
    call closed_form(check)
    call order_of_adams(check)
    call order_of_radau(check)
  end subroutine run_test_states

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(maxwell_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    in_domain = .true.
    dydt(1) = y(2)
    dydt(2) = y(3) - y(1)
    dydt(3) = (y(1) - y(3))/self%tau
    dydt(4) = (y(1) - y(3))**2/self%tau
  end subroutine derivatives

  !> From p = z = w = 0 and p' = 1. v = p' obeys v'' + v'/tau + v = 0, v'(0) = 0; the spring's length is p - z = -v', it is
  !> p = -v' + (1 - v)/tau, and the energy (v^2 + v'^2)/2 + w is 1/2.
  pure function exact(tau, t) result(y)
    real(dp), intent(in) :: tau, t
    real(dp) :: y(4), v, v_rate
    complex(dp) :: root, a, b
    root = sqrt(cmplx(1/tau**2 - 4, 0.0_dp, dp))
    b = 0.5_dp*(-1/tau - root)
    a = 1/b   ! their product is 1
    v = real((a*exp(b*t) - b*exp(a*t))/(a - b), dp)
    v_rate = real((exp(b*t) - exp(a*t))/(a - b), dp)
    y(1) = -v_rate + (1 - v)/tau
    y(2) = v
    y(3) = y(1) + v_rate
    y(4) = 0.5_dp*(1 - v**2 - v_rate**2)
  end function exact

  function maxwell(tau) result(problem)
    real(dp), intent(in) :: tau
    type(maxwell_t) :: problem
    problem%tau = tau
    problem%n = 4
    problem%n_positions = 1
    problem%n_quadratures = 1
    problem%refuses_steps = .false.
  end function maxwell

  subroutine prepare(method, tolerance)
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: tolerance
    method%settings%relative = [tolerance, tolerance, tolerance, 0.0_dp]
    method%settings%absolute = [tolerance, tolerance, tolerance, tolerance]
    method%settings%span = t_end
  end subroutine prepare

  subroutine states_are_counted(check)
    class(checks_t), intent(inout) :: check
    type(maxwell_t) :: problem
    problem = maxwell(1.0_dp)
    call check%that(problem%n_states() == 1, 'one state is neither position, rate nor quadrature')
  end subroutine states_are_counted

  !> Three methods, three tolerances, and three dashpots: with the time scale of the spring, stiff, and nearly critically damped.
  subroutine closed_form(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: tau(3) = [1.0_dp, 1e-3_dp, 0.4_dp]
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    type(silent_observer_t) :: observer
    type(maxwell_t) :: problem
    real(dp) :: t, y(4), tolerance
    integer :: status, i, j, k
    do i = 1, size(names)
      do j = 1, size(tau)
        do k = 5, 11, 3
          tolerance = 10.0_dp**(-k)
          problem = maxwell(tau(j))
          call new_method(trim(names(i)), method, error)
          call prepare(method, tolerance)
          t = 0
          y = [0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp]
          call integrate(problem, method, t, y, t_end, 0, observer, status)
          call check%that(status == integration_done, 'a Maxwell element by '//names(i))
          call check%that(maxval(abs(y - exact(tau(j), t_end))) < 100*tolerance, 'closed form of a Maxwell element: '//names(i))
          if (i == 3 .and. j == 2) call check%that(method%statistics%accepted < 400, &
            'a stiff Maxwell element needs few steps by auto')
        end do
      end do
    end do
  end subroutine closed_form

  !> With fixed steps the error of order k decreases by 2^(k+1) if the step is halved, because of local extrapolation.
  subroutine order_of_adams(check)
    class(checks_t), intent(inout) :: check
    type(adams_t) :: method
    type(silent_observer_t) :: observer
    type(maxwell_t) :: problem
    real(dp) :: t, y(4), error(2), order
    integer :: status, k, half
    problem = maxwell(1.0_dp)
    do k = 2, 6, 2
      do half = 1, 2
        call prepare(method, 1e-6_dp)
        method%settings%max_order = k
        method%settings%fixed_step = t_end/(100*half)
        t = 0
        y = [0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp]
        call integrate(problem, method, t, y, t_end, 0, observer, status)
        error(half) = maxval(abs(y - exact(1.0_dp, t_end)))
      end do
      order = log(error(1)/error(2))/log(2.0_dp)
      call check%that(order > min(k + 1, 3) - 0.3_dp, 'order of Adams with states')
    end do
  end subroutine order_of_adams

  !> Radau chooses its steps: their number must increase with the tolerance as its order 9 requires, and not faster.
  subroutine order_of_radau(check)
    class(checks_t), intent(inout) :: check
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    type(silent_observer_t) :: observer
    type(maxwell_t) :: problem
    real(dp) :: t, y(4), power
    integer :: status, k, steps(2)
    problem = maxwell(1.0_dp)
    do k = 1, 2
      call new_method('radau', method, error)
      call prepare(method, 10.0_dp**(-5 - 3*(k - 1)))
      t = 0
      y = [0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp]
      call integrate(problem, method, t, y, t_end, 0, observer, status)
      steps(k) = method%statistics%accepted
    end do
    power = log10(real(steps(2), dp)/steps(1))/3
    call check%that(power < 0.2_dp, 'the steps of Radau with states grow with a tenth to a fifth power of the accuracy')
  end subroutine order_of_radau
end module test_states
