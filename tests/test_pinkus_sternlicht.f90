!> The Pinkus-Sternlicht film: table, limits, continuity, invariance, dissipation, factory.
module test_pinkus_sternlicht
  use, intrinsic :: iso_fortran_env, only: qp => real128
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t
  use checks, only: checks_t
  use film_law, only: film_law_t, film_motion_t
  use bearing_size, only: bearing_t
  use laws, only: film_law_of
  use half_film, only: half_film_t
  implicit none
  private
  public :: run_test_pinkus_sternlicht

  real(dp), parameter :: bearing_radius = 10e-3_dp, bearing_length = 15e-3_dp, clearance = 20e-6_dp
  real(dp), parameter :: viscosity = 0.0117_dp
  real(dp), parameter :: unit_force = viscosity*bearing_length*(bearing_radius - clearance)**3/clearance**2

  !> eps, W, eps_dot of the tabulated values.
  real(dp), parameter :: states(3, 6) = reshape([0.5_dp, 1.0_dp, -0.001_dp, 0.5_dp, 1.0_dp, 0.3_dp, &
    0.5_dp, 1.0_dp, -0.3_dp, 0.9_dp, 1.0_dp, 0.3_dp, 0.9_dp, 1.0_dp, -0.3_dp, 0.99_dp, 1.0_dp, -0.3_dp], [3, 6])

contains

  subroutine run_test_pinkus_sternlicht(check)
    class(checks_t), intent(inout) :: check
    call test_table(check)
    call test_printed_formula(check)
    call test_limits(check)
    call test_as_printed(check)
    call test_half_film_table(check)
    call test_half_film_integral(check)
    call test_half_film_rounding(check)
    call test_half_film_limits(check)
    call test_pressure(check)
    call test_invariance(check)
    call test_extremes(check)
  end subroutine run_test_pinkus_sternlicht

  !> The film of a variant, selected by name.
  subroutine make(variant, film)
    character(len=*), intent(in) :: variant
    class(film_law_t), allocatable, intent(out) :: film
    type(error_t), allocatable :: error
    call film_law_of('variant='''//trim(variant)//''' viscosity=0.0117', 1e-6_dp, film, error)
    if (allocated(error)) error stop 'test_pinkus_sternlicht: the film cannot be made'
  end subroutine make

  !> Radial and tangential force in the table's unit, for eps, W, eps_dot and any direction of the eccentricity.
  function reduced_force(film, eps, w, eps_dot, direction, pin_speed) result(force)
    class(film_law_t), intent(in) :: film
    real(dp), intent(in) :: eps, w, eps_dot, direction, pin_speed
    real(dp) :: force(2)
    type(film_motion_t) :: motion
    real(dp) :: n(2), t(2), f(2), moment
    n = [cos(direction), sin(direction)]
    t = [-n(2), n(1)]
    motion%eccentricity = clearance*eps*n
    motion%eccentricity_rate = clearance*(eps_dot*n + eps*(pin_speed - w)/2*t)
    motion%pin_speed = pin_speed
    call film%film_force(motion, f, moment)
    force = [dot_product(f, n), dot_product(f, t)]/unit_force
  end function reduced_force

  subroutine test_table(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: expected(2, 6) = reshape([-1.7489_dp, 4.8201_dp, -14.9614_dp, 6.7691_dp, 2.4511_dp, 2.9045_dp, &
      -133.3184_dp, 22.6048_dp, 3.2411_dp, 5.0958_dp, 80.1125_dp, 6.8756_dp], [2, 6])
    class(film_law_t), allocatable :: film
    real(dp) :: force(2)
    integer :: i
    call make('closed_form', film)
    call check%that(.not. film%needs_ideal_motion, 'the film does not need the motion of the ideal mechanism')
    do i = 1, size(states, 2)
      force = reduced_force(film, states(1, i), states(2, i), states(3, i), 0.7_dp, 0.4_dp)
      call check%close_to(force(1), expected(1, i), 0.6e-4_dp, 'closed form, radial')
      call check%close_to(force(2), expected(2, i), 0.6e-4_dp, 'closed form, tangential')
    end do
  end subroutine test_table

  !> The published formulas, which are singular if eps or eps_dot is 0.
  pure function formula(eps, w, eps_dot) result(force)
    real(dp), intent(in) :: eps, w, eps_dot
    real(dp) :: force(2)
    real(dp) :: k
    k = sqrt((1 - eps**2)*((w/(2*eps_dot))**2 + 1/eps**2))
    if (eps_dot >= 0) then
      force(1) = -6*eps_dot/((2 + eps**2)*(1 - eps**2)**1.5_dp)* &
        (4*k*eps**2 + (2 + eps**2)*pi*(k + 3)/(k + 1.5_dp))
      force(2) = 6*pi*eps*w/((2 + eps**2)*sqrt(1 - eps**2))*(k + 3)/(k + 1.5_dp)
    else
      force(1) = 6*eps_dot/((2 + eps**2)*(1 - eps**2)**1.5_dp)*(4*k*eps**2 - (2 + eps**2)*pi*k/(k + 1.5_dp))
      force(2) = 6*pi*eps*w/((2 + eps**2)*sqrt(1 - eps**2))*k/(k + 1.5_dp)
    end if
  end function formula

  subroutine test_printed_formula(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(6) = [0.01_dp, 0.2_dp, 0.5_dp, 0.8_dp, 0.95_dp, 0.999_dp]
    real(dp), parameter :: speeds(5) = [-100.0_dp, -1.0_dp, 0.0_dp, 0.3_dp, 50.0_dp]
    real(dp), parameter :: rates(6) = [-20.0_dp, -1.0_dp, -1e-3_dp, 1e-3_dp, 2.0_dp, 70.0_dp]
    class(film_law_t), allocatable :: film
    real(dp) :: want(2), got(2)
    integer :: i, j, k
    call make('', film)
    do i = 1, size(ratios)
      do j = 1, size(speeds)
        do k = 1, size(rates)
          want = formula(ratios(i), speeds(j), rates(k))
          got = reduced_force(film, ratios(i), speeds(j), rates(k), -2.0_dp, 3.0_dp)
          call check%that(norm2(got - want) <= 1e-11_dp*norm2(want), 'the regular form agrees with the formula')
        end do
      end do
    end do
  end subroutine test_printed_formula

  subroutine test_limits(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), other(2), moment, eps
    integer :: i
    call make('closed_form', film)
    do i = 1, 9
      eps = 0.11_dp*i
      force = reduced_force(film, eps, 2.0_dp, 0.0_dp, 1.0_dp, 1.0_dp)
      call check%relative(force(1), -24*eps**2/((2 + eps**2)*(1 - eps**2)), 1e-12_dp, 'steady radial force')
      call check%relative(force(2), 12*pi*eps/((2 + eps**2)*sqrt(1 - eps**2)), 1e-12_dp, 'steady tangential force')
      other = reduced_force(film, eps, 2.0_dp, -1e-12_dp, 1.0_dp, 1.0_dp)
      call check%that(norm2(other - force) <= 1e-10_dp*norm2(force), 'continuous from withdrawal')
      other = reduced_force(film, eps, 2.0_dp, 1e-12_dp, 1.0_dp, 1.0_dp)
      call check%that(norm2(other - force) <= 1e-10_dp*norm2(force), 'continuous from approach')
    end do

    motion = film_motion_t(eccentricity=0, eccentricity_rate=clearance*[0.3_dp, -2.0_dp], pin_speed=5.0_dp)
    call film%film_force(motion, force, moment)
    call check%that(norm2(force/unit_force + 6*pi*[0.3_dp, -2.0_dp]) <= 1e-13_dp, 'squeeze force at the centre')
    call check%that(abs(moment) <= 0, 'no moment without film_moment')
    do i = -300, -9
      eps = 10.0_dp**i
      motion%eccentricity = clearance*eps*[0.6_dp, 0.8_dp]
      call film%film_force(motion, other, moment)
      call check%that(norm2(other - force) <= 10*eps*norm2(force) + 1e-14_dp*norm2(force), 'continuous at the centre')
    end do
    motion%eccentricity_rate = 0
    motion%eccentricity = 1e-7_dp*clearance*[0.6_dp, 0.8_dp]
    call film%film_force(motion, force, moment)
    call check%that(norm2(force/unit_force - 3*pi*5*1e-7_dp*[-0.8_dp, 0.6_dp]) <= 1e-12_dp, 'wedge force near the centre')
  end subroutine test_limits

  !> In the variant as_printed the radial force has the opposite sign when the pin withdraws.
  subroutine test_as_printed(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: corrected, printed
    real(dp) :: one(2), other(2)
    call make('closed_form', corrected)
    call make('as_printed', printed)
    one = reduced_force(corrected, 0.6_dp, 2.0_dp, -0.4_dp, 1.0_dp, 1.0_dp)
    other = reduced_force(printed, 0.6_dp, 2.0_dp, -0.4_dp, 1.0_dp, 1.0_dp)
    call check%close_to(other(1), -one(1), 1e-13_dp, 'as printed, radial, withdrawing')
    call check%close_to(other(2), one(2), 1e-13_dp, 'as printed, tangential, withdrawing')
    one = reduced_force(corrected, 0.6_dp, 2.0_dp, 0.4_dp, 1.0_dp, 1.0_dp)
    other = reduced_force(printed, 0.6_dp, 2.0_dp, 0.4_dp, 1.0_dp, 1.0_dp)
    call check%that(norm2(one - other) <= 0, 'as printed is the same on approach')
  end subroutine test_as_printed

  subroutine test_half_film_table(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: expected(2, 6) = reshape([-1.7488_dp, 4.8261_dp, -14.7324_dp, 6.6629_dp, 2.6801_dp, 3.0107_dp, &
      -135.4481_dp, 23.1470_dp, 1.1114_dp, 4.5537_dp, 0.6850_dp, 4.9871_dp], [2, 6])
    class(film_law_t), allocatable :: film
    real(dp) :: force(2)
    integer :: i
    call make('half_film', film)
    do i = 1, size(states, 2)
      force = reduced_force(film, states(1, i), states(2, i), states(3, i), 0.7_dp, 0.4_dp)
      call check%close_to(force(1), expected(1, i), 0.6e-4_dp, 'half film, radial')
      call check%close_to(force(2), expected(2, i), 0.6e-4_dp, 'half film, tangential')
    end do
  end subroutine test_half_film_table

  !> The half film against adaptive quadrature of the positive pressure.
  subroutine test_half_film_integral(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(10) = &
      [0.001_dp, 0.01_dp, 0.1_dp, 0.3_dp, 0.5_dp, 0.8_dp, 0.95_dp, 0.99_dp, 0.999_dp, 0.9999_dp]
    real(dp), parameter :: speeds(9) = &
      [-1e3_dp, -10.0_dp, -1.0_dp, -1e-3_dp, 0.0_dp, 1e-3_dp, 1.0_dp, 10.0_dp, 1e3_dp]
    class(film_law_t), allocatable :: film
    real(dp) :: got(2), want(2)
    integer :: i, j, k
    call make('half_film', film)
    do i = 1, size(ratios)
      do j = 1, size(speeds)
        do k = 1, size(speeds)
          got = reduced_force(film, ratios(i), speeds(j), speeds(k), 0.0_dp, 0.0_dp)
          want = integrated_pressure(ratios(i), speeds(j), speeds(k))
          call check%that(norm2(got - want) <= 1e-10_dp*norm2(want), 'half film is the integral of its pressure')
        end do
      end do
    end do
  end subroutine test_half_film_integral

  !> Pressure (5.20) times (2 + eps^2)/6 at the angle a from the thickest place.
  pure function reduced_pressure(eps, w, eps_dot, a) result(p)
    real(dp), intent(in) :: eps, w, eps_dot, a
    real(dp) :: p
    p = (w*eps*sin(a)*(2 + eps*cos(a)) - eps_dot*(4*cos(a) + eps*cos(2*a)))/((1 + eps*cos(a))**2)
  end function reduced_pressure

  !> Radial and tangential force in the table's unit from the positive part of the pressure.
  pure function integrated_pressure(eps, w, eps_dot) result(force)
    real(dp), intent(in) :: eps, w, eps_dot
    real(dp) :: force(2)
    integer, parameter :: pieces = 64
    real(dp) :: a, b, low, high, middle
    integer :: i, j
    force = 0
    do i = 1, pieces
      a = 2*pi*(i - 1)/pieces
      b = 2*pi*i/pieces
      low = a
      high = b
      if (reduced_pressure(eps, w, eps_dot, a) > 0 .neqv. reduced_pressure(eps, w, eps_dot, b) > 0) then
        do j = 1, 60
          middle = (low + high)/2
          if (reduced_pressure(eps, w, eps_dot, middle) > 0 .eqv. reduced_pressure(eps, w, eps_dot, a) > 0) then
            low = middle
          else
            high = middle
          end if
        end do
      else
        low = b
      end if
      if (reduced_pressure(eps, w, eps_dot, (a + low)/2) > 0) then
        force = force + adaptive(eps, w, eps_dot, a, low, 0)
      else if (low < b) then
        force = force + adaptive(eps, w, eps_dot, low, b, 0)
      end if
    end do
    force = 6/(2 + eps**2)*force
  end function integrated_pressure

  !> Integral of the pressure times (cos, sin) over [a, b], halved until five-point Gauss rules agree.
  pure recursive function adaptive(eps, w, eps_dot, a, b, depth) result(total)
    real(dp), intent(in) :: eps, w, eps_dot, a, b
    integer, intent(in) :: depth
    real(dp) :: total(2)
    real(dp) :: whole(2), left(2), right(2), middle
    middle = (a + b)/2
    whole = gauss(eps, w, eps_dot, a, b)
    left = gauss(eps, w, eps_dot, a, middle)
    right = gauss(eps, w, eps_dot, middle, b)
    total = left + right
    if (depth == 0 .or. (depth < 12 .and. norm2(total - whole) > 1e-12_dp*norm2(total))) &
      total = adaptive(eps, w, eps_dot, a, middle, depth + 1) + adaptive(eps, w, eps_dot, middle, b, depth + 1)
  end function adaptive

  pure function gauss(eps, w, eps_dot, a, b) result(total)
    real(dp), intent(in) :: eps, w, eps_dot, a, b
    real(dp) :: total(2)
    real(dp) :: x(5), weight(5), angle
    integer :: i
    x(4:5) = sqrt(5 + 2*sqrt(10/7.0_dp)*[-1, 1])/3
    x(3) = 0
    x(1:2) = -x(4:5)
    weight(4:5) = (322 - 13*sqrt(70.0_dp)*[-1, 1])/900
    weight(3) = 128/225.0_dp
    weight(1:2) = weight(4:5)
    total = 0
    do i = 1, 5
      angle = (a + b)/2 + (b - a)/2*x(i)
      total = total + (b - a)/2*weight(i)*reduced_pressure(eps, w, eps_dot, angle)*[cos(angle), sin(angle)]
    end do
  end function gauss

  !> The half film against its integral in quadruple precision, in every direction of the motion: the only error is
  !> rounding.
  subroutine test_half_film_rounding(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(9) = [1e-40_dp, 1e-20_dp, 1e-6_dp, 0.01_dp, 0.3_dp, 0.7_dp, 0.95_dp, 0.999_dp, 1 - 1e-6_dp]
    class(film_law_t), allocatable :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment, angle
    real(qp) :: exact(2)
    integer :: i, j
    call make('half_film', film)
    do i = 1, size(ratios)
      do j = 0, 180
        angle = pi*j/90
        motion%eccentricity = clearance*ratios(i)*[cos(3*angle), sin(3*angle)]
        motion%pin_speed = 70*cos(angle)
        motion%eccentricity_rate = clearance*35*sin(angle)*[cos(3*angle + 0.02_dp), sin(3*angle + 0.02_dp)]
        call film%film_force(motion, force, moment)
        exact = exact_force(motion)
        call check%that(norm2(force - exact) <= 3e-15_dp/(1 - ratios(i))*norm2(exact), 'half film: rounding error')
      end do
    end do
  end subroutine test_half_film_rounding

  !> Booker's integrals (see half_film) between zeros of the pressure that are iterated to convergence, for e in units of c.
  pure function exact_force(motion) result(force)
    type(film_motion_t), intent(in) :: motion
    real(qp) :: force(2)
    real(qp) :: e(2), v(2), n(2), eps, a, b, gap, root, g, radial, tangential
    real(qp), dimension(2) :: angle, c, s, u
    integer :: i
    e = motion%eccentricity/real(clearance, qp)
    v = motion%eccentricity_rate/real(clearance, qp)
    eps = norm2(e)
    n = e/eps
    b = dot_product(n, v)
    a = eps*motion%pin_speed/2 - (n(1)*v(2) - n(2)*v(1))
    angle = atan2(b, a) + [0.0_qp, acos(-1.0_qp)]
    do i = 1, 40
      c = cos(angle)
      s = sin(angle)
      angle = angle - (a*(4*s + 2*eps*s*c) - b*(4*c + eps*(2*c**2 - 1))) &
        /(a*(4*c + 2*eps*(2*c**2 - 1)) + b*(4*s + 4*eps*s*c))
    end do
    c = cos(angle)
    s = sin(angle)
    u = 1 + eps*c
    gap = (1 - eps)*(1 + eps)
    root = sqrt(gap)
    g = atan2(root*(s(2)*(c(1) + eps) - s(1)*(c(2) + eps)), (c(1) + eps)*(c(2) + eps) + gap*s(1)*s(2))
    if (g < 0) g = g + 2*acos(-1.0_qp)
    radial = -2*a*(c(2)**2/u(2) - c(1)**2/u(1)) + b*(s(2)*(3*eps - 2*gap*c(2))/(u(2)*gap) &
      - s(1)*(3*eps - 2*gap*c(1))/(u(1)*gap) - (2 + eps**2)*g/(gap*root))
    tangential = 2*a*(g/root - s(2)*c(2)/u(2) + s(1)*c(1)/u(1)) + b*(c(2)*(2*c(2) - eps)/u(2) - c(1)*(2*c(1) - eps)/u(1))
    force = 6*unit_force/(2 + eps**2)*(radial*n + tangential*[-n(2), n(1)])
  end function exact_force

  subroutine test_half_film_limits(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), other(2), moment, eps
    integer :: i
    call make('half_film', film)
    do i = 1, 9
      eps = 0.11_dp*i
      force = reduced_force(film, eps, 2.0_dp, 0.0_dp, 1.0_dp, 1.0_dp)
      call check%relative(force(1), -24*eps**2/((2 + eps**2)*(1 - eps**2)), 1e-12_dp, 'half film, steady radial force')
      call check%relative(force(2), 12*pi*eps/((2 + eps**2)*sqrt(1 - eps**2)), 1e-12_dp, 'half film, steady tangential')
    end do
    motion = film_motion_t(eccentricity=0, eccentricity_rate=clearance*[0.3_dp, -2.0_dp], pin_speed=5.0_dp)
    call film%film_force(motion, force, moment)
    call check%that(norm2(force/unit_force + 6*pi*[0.3_dp, -2.0_dp]) <= 1e-13_dp, 'half film: squeeze force at the centre')
    do i = -100, -9
      eps = 10.0_dp**i
      motion%eccentricity = clearance*eps*[0.6_dp, 0.8_dp]
      call film%film_force(motion, other, moment)
      call check%that(norm2(other - force) <= 10*eps*norm2(force) + 1e-14_dp*norm2(force), 'half film: continuous at the centre')
    end do
    motion%eccentricity_rate = 0
    motion%pin_speed = 0
    call film%film_force(motion, force, moment)
    call check%that(norm2(force) <= 0 .and. abs(moment) <= 0, 'half film, no force at rest')
  end subroutine test_half_film_limits

  !> The integral of the pressure function is the force of the half film.
  subroutine test_pressure(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 20000
    type(half_film_t) :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), total(2), moment, angle, line_of_centres
    integer :: i
    film%viscosity = viscosity
    call film%prepare(bearing_t(bearing_radius, bearing_length, clearance, 0.0_dp), 1e-6_dp)
    motion = film_motion_t(eccentricity=clearance*[0.3_dp, -0.5_dp], eccentricity_rate=clearance*[3.0_dp, 20.0_dp], &
      pin_speed=70.0_dp)
    call film%film_force(motion, force, moment)
    line_of_centres = atan2(-0.5_dp, 0.3_dp)
    total = 0
    do i = 1, points
      angle = 2*pi*i/points
      total = total - film%pressure(motion, angle - line_of_centres)*[cos(angle), sin(angle)]
    end do
    total = total*2*pi/points*(bearing_radius - clearance)*bearing_length
    call check%that(norm2(total - force) <= 1e-6_dp*norm2(force), 'integral of the pressure is the force on the pin')
  end subroutine test_pressure

  !> Rotating the whole motion rotates the force; mirroring it mirrors the force; the force is linear in the speeds; it depends on
  !> the two rotations only through W.
  subroutine test_invariance(check)
    class(checks_t), intent(inout) :: check
    character(len=11), parameter :: variants(2) = ['closed_form', 'half_film  ']
    class(film_law_t), allocatable :: film
    real(dp) :: one(2), other(2)
    integer :: i
    do i = 1, size(variants)
      call make(trim(variants(i)), film)
      one = reduced_force(film, 0.7_dp, 2.0_dp, -0.4_dp, 0.0_dp, 0.0_dp)
      other = reduced_force(film, 0.7_dp, 2.0_dp, -0.4_dp, 2.5_dp, 0.0_dp)
      call check%that(norm2(one - other) <= 1e-12_dp*norm2(one), 'no direction is preferred')
      other = reduced_force(film, 0.7_dp, 2.0_dp, -0.4_dp, 2.5_dp, 9.0_dp)
      call check%that(norm2(one - other) <= 1e-12_dp*norm2(one), 'only the relative rotation counts')
      other = reduced_force(film, 0.7_dp, -2.0_dp, -0.4_dp, 0.0_dp, 0.0_dp)
      call check%that(norm2(one - [other(1), -other(2)]) <= 1e-12_dp*norm2(one), 'mirror image')
      other = reduced_force(film, 0.7_dp, 2e3_dp, -0.4e3_dp, 0.0_dp, 0.0_dp)/1e3_dp
      call check%that(norm2(one - other) <= 1e-12_dp*norm2(one), 'linear in the speeds')
    end do
  end subroutine test_invariance

  subroutine test_extremes(check)
    class(checks_t), intent(inout) :: check
    character(len=11), parameter :: variants(3) = ['closed_form', 'as_printed ', 'half_film  ']
    real(dp), parameter :: ratios(9) = &
      [0.0_dp, 1e-310_dp, 1e-100_dp, 1e-10_dp, 0.999999_dp, 1.0_dp, 1.0000001_dp, 2.0_dp, 1e10_dp]
    real(dp), parameter :: speeds(5) = [-1e10_dp, -1e-100_dp, 0.0_dp, 1e-20_dp, 1e10_dp]
    class(film_law_t), allocatable :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment
    integer :: v, i, j, k
    do v = 1, size(variants)
      call make(trim(variants(v)), film)
      do i = 1, size(ratios)
        do j = 1, size(speeds)
          do k = 1, size(speeds)
            motion%eccentricity = clearance*ratios(i)*[0.6_dp, 0.8_dp]
            motion%eccentricity_rate = clearance*speeds(k)*[0.8_dp, 0.6_dp]
            motion%pin_speed = speeds(j)
            call film%film_force(motion, force, moment)
            call check%that(all(abs(force) <= huge(1.0_dp)), 'finite for extreme inputs, '//variants(v))
          end do
        end do
      end do
    end do
  end subroutine test_extremes
end module test_pinkus_sternlicht
