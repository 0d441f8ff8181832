!> The Radau method: formulas, order, stiff problems, derivatives of laws, states inside steps.
module test_radau
  use kinds, only: dp
  use constants, only: pi
  use checks, only: checks_t
  use error_handling, only: error_t
  use ode_problem, only: ode_problem_t, event_continue
  use ode_method, only: ode_settings_t, step_done
  use radau_coefficients, only: radau_formula_t, radau_formula
  use radau, only: radau_t
  use film_law, only: film_motion_t
  use pinkus_sternlicht, only: pinkus_sternlicht_t
  use bearing_size, only: bearing_t
  use contact_law, only: contact_law_t
  use laws, only: contact_law_of
  use ode_solver, only: integrate, silent_observer_t, integration_done, step_limit_reached
  use test_problems, only: oscillator_t, whole_step
  implicit none
  private
  public :: run_test_radau

  !> A body that falls on a stiff wall with a restitution of about 0.05 and comes to rest there: y = (depth, speed). The event is
  !> that a contact begins or ends.
  type, extends(ode_problem_t) :: landing_t
    logical :: touches = .false.
    real(dp) :: impact_speed = 0
  contains
    procedure :: derivatives => falls_on_wall
    procedure :: events => reaches_wall
    procedure :: handle_event => touch
  end type landing_t

  !> Van der Pol's oscillator, mu (y'' ) = (1 - y^2) y' - y with small mu: stiff, of second order.
  type, extends(ode_problem_t) :: van_der_pol_t
    real(dp) :: mu = 1e-6_dp
  contains
    procedure :: derivatives
  end type van_der_pol_t

  !> y'' = -rate (y' - cos t) - sin t, whose solution from y = 0, y' = 1 is sin t.
  type, extends(ode_problem_t) :: relaxing_t
    real(dp) :: rate = 1
  contains
    procedure :: derivatives => relaxation
  end type relaxing_t

  !> v follows cos t with a rate proportional to its distance, and w is the integral of -v'; w + v is constant exactly.
  type, extends(ode_problem_t) :: stiff_follower_t
  contains
    procedure :: derivatives => follow_cosine
  end type stiff_follower_t

contains

  subroutine run_test_radau(check)
    class(checks_t), intent(inout) :: check
    call formulas_are_exact(check)
    call order_of_the_formulas(check)
    call van_der_pol_is_cheap(check)
    call film_derivatives_by_complex_step(check)
    call contact_slopes_by_complex_step(check)
    call states_inside_steps(check)
    call damped_contacts_last(check)
    call quadratures_belong_to_their_stages(check)
  end subroutine run_test_radau

  !> Contacts that the wall damps within a small part of the first step, in which the interpolant is inexact: none of them is lost.
  subroutine damped_contacts_last(check)
    class(checks_t), intent(inout) :: check
    type(landing_t) :: problem
    type(radau_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t
    integer :: status, i
    do i = 1, 2
      problem = landing_t(n=2, n_positions=1, n_events=1)
      method%settings = settings(2, 1e-4_dp, 1.0_dp)
      t = 0
      y = [-0.103_dp - 0.002_dp*i, 0.0_dp]
      call integrate(problem, method, t, y, 0.9_dp, 6000, observer, status)
      call check%that(status == step_limit_reached, 'contacts with a damped wall')
      call check%close_to(y(1), 0.0_dp, 1e-6_dp, 'the body stays at the wall')
    end do
  end subroutine damped_contacts_last

  pure subroutine falls_on_wall(self, t, y, dydt, in_domain)
    class(landing_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt = [y(2), 1.0_dp]
    if (self%touches) dydt(2) = 1 - 1e10_dp*max(y(1), 0.0_dp)*max(1 + 19*y(2)/self%impact_speed, 0.0_dp)
    in_domain = .true.
  end subroutine falls_on_wall

  pure subroutine reaches_wall(self, t, y, g, g_rate)
    class(landing_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = merge(-1, 1, self%touches)*y(1)
    g_rate = merge(-1, 1, self%touches)*y(2)
  end subroutine reaches_wall

  subroutine touch(self, index, t, y, action)
    class(landing_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    if (.not. self%touches) self%impact_speed = max(y(2), 1e-5_dp)
    self%touches = .not. self%touches
    action = event_continue
  end subroutine touch

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(van_der_pol_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt(1) = y(2)
    dydt(2) = ((1 - y(1)**2)*y(2) - y(1))/self%mu
    in_domain = .true.
  end subroutine derivatives

  pure subroutine relaxation(self, t, y, dydt, in_domain)
    class(relaxing_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    dydt(1) = y(2)
    dydt(2) = -self%rate*(y(2) - cos(t)) - sin(t)
    in_domain = .true.
  end subroutine relaxation

  !> Collocation conditions, decoupling of the stages, stiff accuracy.
  subroutine formulas_are_exact(check)
    class(checks_t), intent(inout) :: check
    type(radau_formula_t) :: f
    real(dp) :: worst
    real(dp), allocatable :: lambda(:, :), unit(:, :)
    integer :: level, i, q, s

    do level = 1, 3
      f = radau_formula(2*level + 1)
      s = f%stages
      worst = 0
      do q = 1, s
        worst = max(worst, maxval(abs(matmul(f%a, f%c**(q - 1)) - f%c**q/q)))
      end do
      call check%close_to(worst, 0.0_dp, 2e-15_dp, 'collocation conditions')
      worst = 0
      do q = 1, 2*s - 1
        worst = max(worst, abs(dot_product(f%a(s, :), f%c**(q - 1)) - 1.0_dp/q))
      end do
      call check%close_to(worst, 0.0_dp, 2e-15_dp, 'quadrature of order 2s-1')
      allocate (lambda(s, s), unit(s, s))
      lambda = 0
      unit = 0
      lambda(1, 1) = f%gamma
      do i = 1, s
        unit(i, i) = 1
      end do
      do i = 1, s/2
        lambda(2*i, 2*i:2*i + 1) = [f%alpha(i), f%beta(i)]
        lambda(2*i + 1, 2*i:2*i + 1) = [-f%beta(i), f%alpha(i)]
      end do
      call check%close_to(maxval(abs(matmul(f%t, f%t_inverse) - unit)), 0.0_dp, 1e-12_dp, 'T and its inverse')
      call check%close_to(maxval(abs(matmul(f%a, matmul(f%t, lambda)) - f%t)), 0.0_dp, 1e-13_dp, 'A T Lambda = T')
      ! the estimate vanishes for polynomials of degree s: z = c^q, f_0 = 0 except for q = 1
      worst = abs(1/f%gamma + dot_product(f%e, f%c))
      do q = 2, s
        worst = max(worst, abs(dot_product(f%e, f%c**q)))
      end do
      call check%close_to(worst, 0.0_dp, 1e-13_dp, 'error estimate of order s')
      deallocate (lambda, unit)
    end do
  end subroutine formulas_are_exact

  function settings(n, tolerance, span) result(s)
    integer, intent(in) :: n
    real(dp), intent(in) :: tolerance, span
    type(ode_settings_t) :: s
    allocate (s%relative(n), s%absolute(n))
    s%relative = tolerance
    s%absolute = tolerance
    s%span = span
  end function settings

  !> The oscillator over ten periods: the error is near the tolerance, with far fewer steps for higher orders.
  subroutine order_of_the_formulas(check)
    class(checks_t), intent(inout) :: check
    type(oscillator_t) :: problem
    type(radau_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t, error, tolerance
    integer :: status, i

    problem%n = 2
    problem%n_positions = 1
    do i = 2, 12, 2
      tolerance = 10.0_dp**(-i)
      method%settings = settings(2, tolerance, 20*pi)
      t = 0
      y = [0.0_dp, 1.0_dp]
      call integrate(problem, method, t, y, 20*pi, 0, observer, status)
      error = max(abs(y(1) - sin(20*pi)), abs(y(2) - cos(20*pi)))
      call check%that(status == integration_done, 'integration of the oscillator')
      call check%close_to(error, 0.0_dp, 30*tolerance, 'ten periods of the oscillator')
    end do
    call check%that(method%statistics%accepted < 200, 'ten periods at 1e-12 in fewer than 200 steps')
  end subroutine order_of_the_formulas

  !> Hairer & Wanner's reference: y = 1.706167732170483, y' = -0.8928097010248 at t = 2.
  subroutine van_der_pol_is_cheap(check)
    class(checks_t), intent(inout) :: check
    type(van_der_pol_t) :: problem
    type(radau_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: y(2), t
    integer :: status
    problem%n = 2
    problem%n_positions = 1
    method%settings = settings(2, 1e-8_dp, 2.0_dp)
    t = 0
    y = [2.0_dp, -0.66_dp]
    call integrate(problem, method, t, y, 2.0_dp, 0, observer, status)
    call check%that(status == integration_done, 'integration of van der Pol''s oscillator')
    call check%close_to(y(1), 1.706167732170483_dp, 1e-6_dp, 'van der Pol, y(2)')
    call check%close_to(y(2), -0.8928097010248_dp, 1e-5_dp, "van der Pol, y'(2)")
    call check%that(method%statistics%evaluations < 10000, 'van der Pol''s oscillator needs few evaluations')
  end subroutine van_der_pol_is_cheap

  !> The film's closed form, written again for complex numbers: its imaginary part for an imaginary change of 1e-30
  !> is the derivative with rounding accuracy.
  subroutine film_derivatives_by_complex_step(check)
    class(checks_t), intent(inout) :: check
    type(pinkus_sternlicht_t) :: film
    type(film_motion_t) :: motion
    complex(dp) :: x(5), force(2)
    real(dp) :: got(3, 5), angle, rate, worst, size_of
    real(dp), parameter :: step = 1e-30_dp
    integer :: i, j, sense

    film%viscosity = 0.0117_dp
    call film%prepare(bearing_t(0.01_dp, 0.015_dp, 2e-5_dp, 0.0_dp), 1e-6_dp)
    worst = 0
    do i = 1, 40
      do sense = -1, 1, 2
        angle = 0.7_dp*i
        rate = sense*0.01_dp*i
        motion%eccentricity = 2e-5_dp*(1 - 0.8_dp**i*0.99_dp)*[cos(angle), sin(angle)]
        motion%eccentricity_rate = rate*[cos(angle + 0.5_dp*sin(3.0_dp*i)), sin(angle + 0.5_dp*sin(3.0_dp*i))]
        motion%pin_speed = 60*cos(2.0_dp*i)
        call film%force_derivatives(motion, got)
        do j = 1, 5
          x = cmplx([motion%eccentricity, motion%eccentricity_rate, motion%pin_speed], 0.0_dp, dp)
          x(j) = x(j) + cmplx(0.0_dp, step, dp)
          force = complex_film(x)
          size_of = maxval(abs(got(1:2, j))) + tiny(1.0_dp)
          worst = max(worst, maxval(abs(aimag(force)/step - got(1:2, j)))/size_of)
        end do
      end do
    end do
    call check%close_to(worst, 0.0_dp, 1e-9_dp, 'derivatives of the film against the complex step')

  contains

    function complex_film(x) result(force)
      complex(dp), intent(in) :: x(5)
      complex(dp) :: force(2), n(2), distance, eps, rate, wedge, s, squeeze, quotient, p, radial, tangential
      real(dp), parameter :: c = 2e-5_dp, r = 0.01_dp - c
      distance = sqrt(x(1)**2 + x(2)**2)
      n = x(1:2)/distance
      eps = distance/c
      rate = (n(1)*x(3) + n(2)*x(4))/c
      wedge = eps*x(5) - 2*(n(1)*x(4) - n(2)*x(3))/c
      s = sqrt((1 - eps**2)*(wedge**2 + 4*rate**2))
      squeeze = 3*eps*rate
      if (real(rate) < 0) squeeze = -squeeze
      p = 0.0117_dp*0.015_dp*r**3/c**2
      quotient = s/(s + squeeze)
      if (real(rate) >= 0) quotient = (s + 2*squeeze)/(s + squeeze)
      radial = -6*p/((2 + eps**2)*(1 - eps**2)**1.5_dp)*(2*eps*s + (2 + eps**2)*pi*rate*quotient)
      tangential = 6*p*pi*wedge*quotient/((2 + eps**2)*sqrt(1 - eps**2))
      force = [radial*n(1) - tangential*n(2), radial*n(2) + tangential*n(1)]
    end function complex_film
  end subroutine film_derivatives_by_complex_step

  subroutine contact_slopes_by_complex_step(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(error_t), allocatable :: error
    complex(dp) :: force
    real(dp) :: stiffness, damping, depth, rate
    real(dp), parameter :: step = 1e-30_dp, impact = 0.7_dp
    integer :: i
    call contact_law_of('stiffness=6.61e10 restitution=0.6', law, error)
    do i = 1, 10
      depth = 3e-6_dp*i
      rate = 0.7_dp*cos(0.3_dp*i)
      call law%normal_force_slopes(depth, rate, impact, stiffness, damping)
      force = complex_contact(cmplx(depth, step, dp), cmplx(rate, 0.0_dp, dp))
      call check%relative(stiffness, aimag(force)/step, 1e-12_dp, 'contact stiffness against the complex step')
      force = complex_contact(cmplx(depth, 0.0_dp, dp), cmplx(rate, step, dp))
      call check%relative(damping, aimag(force)/step, 1e-12_dp, 'contact damping against the complex step')
    end do

  contains

    complex(dp) function complex_contact(delta, delta_dot)
      complex(dp), intent(in) :: delta, delta_dot
      complex_contact = 6.61e10_dp*delta**1.5_dp*(1 + 0.75_dp*(1 - 0.6_dp**2)*delta_dot/impact)
    end function complex_contact
  end subroutine contact_slopes_by_complex_step

  !> Between the ends of steps the error of the stiff part of a state is made smaller, the others are not made larger.
  subroutine states_inside_steps(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: rates(4) = 10.0_dp**[5, 3, 0, -2], most(4) = [0.02_dp, 0.3_dp, 1.5_dp, 1.5_dp]
    real(dp) :: largest(2), improved(2)
    integer :: i, k
    do i = 1, size(rates)
      do k = 4, 8, 2
        call worst_inside(rates(i), 10.0_dp**(-k), largest, improved)
        call check%that(improved(2) < most(i)*largest(2), 'error of an improved rate')
        call check%that(.not. improved(1) > largest(1), 'positions remain')
      end do
    end do
  end subroutine states_inside_steps

  !> Largest errors of y and y' inside the steps, as interpolated and improved; 0 as interpolated if the integration fails.
  subroutine worst_inside(rate, tolerance, largest, improved)
    real(dp), intent(in) :: rate, tolerance
    real(dp), intent(out) :: largest(2), improved(2)
    type(relaxing_t) :: problem
    type(radau_t) :: method
    real(dp) :: y(2), f(2), t
    logical :: in_domain
    real(dp) :: change
    integer :: status, i
    problem%n = 2
    problem%n_positions = 1
    problem%rate = rate
    method%settings = settings(2, tolerance, 10.0_dp)
    method%settings%stop_time = 10
    call method%start(problem, 0.0_dp, [0.0_dp, 1.0_dp], .true., status)
    largest = 0
    improved = 0
    do while (method%t < 10)
      call whole_step(method, problem, status)
      if (status /= step_done) then
        largest = 0
        return
      end if
      do i = 1, 19
        t = method%t_old + i*(method%t - method%t_old)/20
        call method%interpolate(t, y)
        largest = max(largest, abs(y - [sin(t), cos(t)]))
        call problem%derivatives(t, y, f, in_domain)
        call method%improve(t, f, y, change)
        improved = max(improved, abs(y - [sin(t), cos(t)]))
      end do
    end do
  end subroutine worst_inside

  !> A quadrature must use the stages at which Newton's iteration has ended, not those one iteration before.
  subroutine quadratures_belong_to_their_stages(check)
    class(checks_t), intent(inout) :: check
    type(stiff_follower_t) :: problem
    type(radau_t) :: method
    type(silent_observer_t) :: observer
    real(dp) :: t, y(3)
    integer :: status
    real(dp), parameter :: tolerance = 1e-5_dp
    problem%n = 3
    problem%n_positions = 1
    problem%n_quadratures = 1
    problem%refuses_steps = .false.
    method%settings%relative = [tolerance, tolerance, 0.0_dp]
    method%settings%absolute = [tolerance, tolerance, tolerance]
    method%settings%span = 20
    t = 0
    y = [0.0_dp, 1.0_dp, 0.0_dp]
    call integrate(problem, method, t, y, 20.0_dp, 10000, observer, status)
    call check%that(status == integration_done, 'integration of a stiff equation')
    ! about 30 with the final stages, depending on rounding, and 150 with those before
    call check%close_to(y(3) + y(2), 1.0_dp, 70*tolerance, 'a quadrature uses the final stages')
  end subroutine quadratures_belong_to_their_stages

  pure subroutine follow_cosine(self, t, y, dydt, in_domain)
    class(stiff_follower_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    real(dp) :: behind
    in_domain = .true.
    behind = y(2) - cos(t)
    dydt(1) = y(2)
    dydt(2) = -1e4_dp*(behind + 1e3_dp*behind**3)
    dydt(3) = -dydt(2)
  end subroutine follow_cosine
end module test_radau
