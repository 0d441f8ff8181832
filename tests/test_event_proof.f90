!> Passages of event functions that are polynomials in the state: found wherever they are in a step, with any method; proven
!> absent elsewhere; at no evaluation of the right-hand side.
module test_event_proof
  use kinds, only: dp
  use checks, only: checks_t
  use ode_problem, only: ode_problem_t, event_form_t
  use ode_method, only: ode_method_t
  use adams, only: adams_t
  use radau, only: radau_t
  use bernstein, only: from_newton, integrate_polynomial, add_product, first_rise, rise_between
  use event_proof, only: stays_negative_for_certain
  use events, only: event_watch_t
  implicit none
  private
  public :: run_test_event_proof

  integer, parameter :: degree = 11

  !> y' is a polynomial in t less pull*y; the event is y_1^2 + y_2^2 = 1, from within, with or without its form told.
  type, extends(ode_problem_t) :: polynomial_t
    real(dp) :: c(0:degree, 2) = 0   !! y_i is the sum of c(j, i) t^j
    real(dp) :: pull = 0
    logical :: tells = .true.
  contains
    procedure :: derivatives
    procedure :: events => leaves_circle
    procedure :: event_form => circle
  end type polynomial_t

contains

  subroutine run_test_event_proof(check)
    class(checks_t), intent(inout) :: check
    call bernstein_algebra(check)
    call touched_and_left(check)
    call random_steps(check)
    call straying_is_bounded(check)
    call proof_is_sharp(check)
    call radau_too(check)
  end subroutine run_test_event_proof

  pure real(dp) function bernstein_value(b, x)
    real(dp), intent(in) :: b(0:), x
    real(dp) :: row(0:size(b) - 1)
    integer :: m
    row = b
    do m = size(b) - 1, 1, -1
      row(:m - 1) = (1 - x)*row(:m - 1) + x*row(1:m)
    end do
    bernstein_value = row(0)
  end function bernstein_value

  subroutine bernstein_algebra(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: b(0:2), p(0:4), sum(0:3), x, lower, upper
    logical :: found
    integer :: i
    call from_newton([1.0_dp, -2.0_dp, 3.0_dp], [-0.5_dp, 0.25_dp], [0.5_dp, -1.0_dp], b)   ! factors x - 1/2, 1/4 - 5 x/4
    call integrate_polynomial(7.0_dp, 2.0_dp, [0.0_dp, 0.5_dp, 1.0_dp], sum)
    p = 0
    call add_product(2.0_dp, b, b, p)
    do i = 0, 10
      x = i/10.0_dp
      associate (value => 1 + (x - 0.5_dp)*(-2 + (0.25_dp - 1.25_dp*x)*3))
        call check%close_to(bernstein_value(b, x), value, 1e-14_dp, 'a polynomial from its Newton form')
        call check%close_to(bernstein_value(p, x), 2*value**2, 1e-14_dp, 'its square')
      end associate
      call check%close_to(bernstein_value(sum, x), 7 + x**2, 1e-14_dp, 'an integral')
    end do
    call first_rise([-1.0_dp, 2.0_dp, -1.0_dp], found, lower, upper)   ! -1 + 6 x (1 - x), above 0 from 0.2113 to 0.7887
    call check%that(found .and. lower <= 0.2113_dp .and. upper > 0.2114_dp .and. upper < 0.7887_dp, 'the first of two passages')
    call check%close_to(rise_between([-1.0_dp, 2.0_dp, -1.0_dp], lower, upper), (3 - sqrt(3.0_dp))/6, 1e-12_dp, 'and where it is')
    call first_rise([-1.0_dp, 0.9_dp, -1.0_dp], found, lower, upper)   ! at most -0.05
    call check%that(.not. found, 'no passage below zero, coefficients above it or not')
  end subroutine bernstein_algebra

  !> One step of order 12 and size 1 from an exact history; the first passage in it, 0 if none is found.
  subroutine one_step(problem, t_event, unproven)
    type(polynomial_t), intent(in) :: problem
    real(dp), intent(out) :: t_event
    logical, intent(out) :: unproven   !! the bound by straight lines left it open
    type(adams_t) :: method
    type(event_watch_t) :: watch
    real(dp) :: x(12), f(2, 12), y(2), straying(2), t_last
    integer :: i, status, index, before
    logical :: inside
    method%settings%fixed_step = 1
    allocate (method%settings%relative(2), method%settings%absolute(2))
    method%settings%relative = 1
    method%settings%absolute = 1
    x = [(i - 12.0_dp, i=1, 12)]
    do i = 1, 12
      call problem%derivatives(x(i), [0.0_dp, 0.0_dp], f(:, i), inside)
    end do
    y = problem%c(0, :)
    call method%start_with_history(problem, x, f, y, 1.0_dp, status)
    call watch%begin(problem, 0.0_dp, y, 0)
    call method%step(problem, status)
    call method%find_straying(1, straying)
    unproven = .not. stays_negative_for_certain(problem%event_form(1), method, straying)
    before = method%statistics%evaluations
    t_last = 2
    call watch%search(method, problem, t_last, index, t_event)
    if (index == 0) t_event = 0
    if (method%statistics%evaluations > before) t_event = -1
  end subroutine one_step

  !> The circle is touched and left half way through a step at whose ends the radius has no rate: its cubic is constant.
  subroutine touched_and_left(check)
    class(checks_t), intent(inout) :: check
    type(polynomial_t) :: problem
    real(dp) :: t_event
    logical :: unproven
    problem%n = 2
    problem%n_events = 1
    problem%c(0, 1) = 0.99_dp
    problem%c(2:4, 1) = 0.16002_dp*[1, -2, 1]   ! 16 t^2 (1 - t)^2 is 1 half way
    call one_step(problem, t_event, unproven)
    call check%that(t_event > 0.45_dp .and. t_event < 0.5_dp, 'a contact touched and left within one step is found')
    problem%tells = .false.
    call one_step(problem, t_event, unproven)
    call check%that(.not. t_event > 0, 'which a cubic through both ends cannot see')
    problem%tells = .true.
    problem%c(2:4, 1) = 0.15999_dp*[1, -2, 1]
    call one_step(problem, t_event, unproven)
    call check%that(unproven .and. .not. abs(t_event) > 0, 'a near miss is no event')
  end subroutine touched_and_left

  !> Random motions within a step, against 4000 samples.
  subroutine random_steps(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: samples = 4000, runs = 400
    type(polynomial_t) :: problem
    real(dp) :: t_event, largest, radius, t, y(2), first
    integer :: i, j, seed_size, missed, invented, events, late, proven
    logical :: unproven
    call random_seed(size=seed_size)
    call random_seed(put=[(17*i, i=1, seed_size)])
    problem%n = 2
    problem%n_events = 1
    missed = 0
    invented = 0
    events = 0
    late = 0
    proven = 0
    do i = 1, runs
      call draw(problem, i)
      largest = 0
      first = 0
      do j = 0, samples
        t = real(j, dp)/samples
        y = position(problem, t)
        radius = norm2(y)
        if (radius > largest) largest = radius
        if (radius >= 1 .and. .not. first > 0) first = t
      end do
      if (norm2(problem%c(0, :)) >= 1 .or. abs(largest - 1) < 1e-6_dp) cycle
      call one_step(problem, t_event, unproven)
      if (largest > 1) events = events + 1
      if (largest > 1 .and. .not. t_event > 0) missed = missed + 1
      if (largest < 1 .and. abs(t_event) > 0) invented = invented + 1
      if (largest > 1 .and. abs(t_event - first) > 1.1_dp/samples) late = late + 1
      if (.not. unproven) proven = proven + 1
      if (largest > 1 .and. .not. unproven) missed = missed + 1
    end do
    call check%that(events > 80, 'enough of the random motions leave the circle')
    call check%that(proven > 40, 'enough of them are proven inside by straight lines')
    call check%that(missed == 0, 'none is missed')
    call check%that(invented == 0, 'none is invented')
    call check%that(late == 0, 'the first passage is taken')
  end subroutine random_steps

  !> After a history of right-hand sides at random, at distances equal to the step or much shorter, the interpolant strays from
  !> the straight lines between its ends by no more than the bound, which is not too far off.
  subroutine straying_is_bounded(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: shares = 40
    type(polynomial_t) :: problem
    type(adams_t) :: method
    real(dp) :: x(12), f(2, 12), y(2), bound(2), share, largest
    integer :: i, j, order, status
    problem%n = 2
    largest = 0
    do i = 1, 240
      order = 1 + mod(i, 12)
      call draw(problem, i)
      call random_number(f)
      f = merge(1.0_dp, 1e-3_dp, mod(i, 2) == 0)*(2*f - 1)
      problem%pull = merge(2.0_dp, 0.0_dp, mod(i, 5) > 1)   ! with it the interpolant has a last correction to make good
      x = [(j - order, j=1, 12)]/merge(1.0_dp, 50.0_dp, mod(i, 3) == 0)
      method = adams_t()
      method%settings%fixed_step = 1
      allocate (method%settings%relative(2), method%settings%absolute(2), source=1.0_dp)
      call method%start_with_history(problem, x(:order), f(:, :order), problem%c(0, :), 1.0_dp, status)
      call method%step(problem, status)
      call method%find_straying(1, bound)
      do j = 1, shares - 1
        share = real(j, dp)/shares
        call method%interpolate(share, y)
        y = abs(y - (method%y_old + share*(method%y - method%y_old)))
        largest = max(largest, maxval(y/(4*share*(1 - share)*bound)))
      end do
    end do
    call check%that(largest < 1 + 1e-9_dp .and. largest > 0.9_dp, 'components stray no further than their bound')
  end subroutine straying_is_bounded

  !> From 0.9 and back to it along a parabola, in one step: up to its top at the circle the proof holds, beyond it does not.
  subroutine proof_is_sharp(check)
    class(checks_t), intent(inout) :: check
    type(polynomial_t) :: problem
    type(adams_t) :: method
    real(dp) :: top, straying(2)
    integer :: i, status
    problem%n = 2
    problem%c(0, 1) = 0.9_dp
    do i = 1, 2
      top = merge(0.0999_dp, 0.1001_dp, i == 1)   ! above 0.9
      problem%c(1:2, 1) = 4*top*[1, -1]
      method = adams_t()
      method%settings%fixed_step = 1
      allocate (method%settings%relative(2), method%settings%absolute(2), source=1.0_dp)
      call method%start_with_history(problem, [0.0_dp], reshape([4*top, 0.0_dp], [2, 1]), problem%c(0, :), 1.0_dp, status)
      call method%step(problem, status)
      call method%find_straying(1, straying)
      call check%that(stays_negative_for_certain(problem%event_form(1), method, straying) .eqv. i == 1, &
        'the proof holds up to the circle')
    end do
  end subroutine proof_is_sharp

  !> Coefficients at random, of one size or falling with the power.
  subroutine draw(problem, number)
    type(polynomial_t), intent(inout) :: problem
    integer, intent(in) :: number
    real(dp) :: random(0:degree, 2), size
    integer :: j
    call random_number(random)
    size = 1.5_dp**(-mod(number, 8))
    do j = 0, degree
      problem%c(j, :) = (2*random(j, :) - 1)*merge(0.9_dp, size**merge(j, 1, mod(number, 3) == 0), j == 0)
    end do
  end subroutine draw

  pure function position(problem, t) result(y)
    type(polynomial_t), intent(in) :: problem
    real(dp), intent(in) :: t
    real(dp) :: y(2)
    integer :: j
    y = 0
    do j = degree, 0, -1
      y = y*t + problem%c(j, :)
    end do
  end function position

  !> Radau gives its polynomial in the same form.
  subroutine radau_too(check)
    class(checks_t), intent(inout) :: check
    type(polynomial_t) :: problem
    type(radau_t) :: method
    real(dp) :: b(0:14), y(2), worst
    integer :: status, m, i, step
    problem%n = 2
    problem%c(1:4, 1) = [1.0_dp, -0.5_dp, 0.3_dp, -0.2_dp]
    problem%c(1:3, 2) = [0.3_dp, 0.7_dp, -0.3_dp]
    allocate (method%settings%relative(2), method%settings%absolute(2))
    method%settings%relative = 1e-6_dp
    method%settings%absolute = 1e-6_dp
    call method%start(problem, 0.0_dp, [0.0_dp, 0.0_dp], .true., status)
    worst = 0
    do step = 1, 5
      call method%step(problem, status)
      call method%bernstein_form(1, b, m)
      call check%that(m >= 3, 'Radau tells the degree of its polynomial')
      do i = 0, 8
        call method%interpolate(method%time_at_share(i/8.0_dp), y)
        worst = max(worst, abs(y(1) - bernstein_value(b(:m), i/8.0_dp))/(1 + abs(y(1))))
      end do
    end do
    call check%close_to(worst, 0.0_dp, 1e-13_dp, 'the polynomial of Radau in Bernstein form')
  end subroutine radau_too

  pure subroutine derivatives(self, t, y, dydt, inside)
    class(polynomial_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: inside
    integer :: j
    dydt = 0
    do j = degree, 1, -1
      dydt(:2) = dydt(:2)*t + j*self%c(j, :)
    end do
    dydt(:2) = dydt(:2) - self%pull*y(:2)
    inside = .true.
  end subroutine derivatives

  pure subroutine leaves_circle(self, t, y, g, g_rate)
    class(polynomial_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: g(:), g_rate(:)
    real(dp) :: dydt(2)
    logical :: inside
    call self%derivatives(t, y, dydt, inside)
    g = norm2(y(:2)) - 1
    g_rate = dot_product(y(:2), dydt)/norm2(y(:2))
  end subroutine leaves_circle

  pure function circle(self, index) result(form)
    class(polynomial_t), intent(in) :: self
    integer, intent(in) :: index
    type(event_form_t) :: form
    form%known = self%tells .and. index == 1
    form%first = 1
    form%square = 1
  end function circle
end module test_event_proof
