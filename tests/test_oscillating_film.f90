!> The oscillating film: published values, limits, flow field, quadrature, variants, direction, factory.
module test_oscillating_film
  use kinds, only: dp
  use constants, only: pi, two_pi
  use error_handling, only: error_t, status_case_file, status_internal
  use checks, only: checks_t
  use film_law, only: film_law_t, film_motion_t
  use bearing_size, only: bearing_t
  use laws, only: film_law_of
  use oscillating_response, only: oscillating_response_t, film_phasors_t, new_oscillating_response, inertia_function, &
    max_eccentricity_ratio
  use oscillating_film, only: oscillating_film_t
  use oscillating_flow, only: response_at, response_of, pressure_gradient, velocity
  implicit none
  private
  public :: run_test_oscillating_film

  real(dp), parameter :: bearing_radius = 10e-3_dp, bearing_length = 15e-3_dp, clearance = 40e-6_dp
  real(dp), parameter :: pin_radius = bearing_radius - clearance, rod_length = 0.2032_dp
  real(dp), parameter :: viscosity = 0.0117_dp, kinematic_viscosity = 1.38e-5_dp
  complex(dp), parameter :: i_unit = (0.0_dp, 1.0_dp)

contains

  subroutine run_test_oscillating_film(check)
    class(checks_t), intent(inout) :: check
    call test_values(check)
    call test_inertia_function(check)
    call test_definition(check)
    call test_sommerfeld_limit(check)
    call test_points(check)
    call test_chosen_points(check)
    call test_series(check)
    call test_flow(check)
    call test_force(check)
    call test_as_printed(check)
    call test_wall(check)
    call test_held_flow(check)
    call test_extremes(check)
    call test_factory(check)
  end subroutine run_test_oscillating_film

  !> Values from independent sums over the tanh form. The values as printed include the second acceleration term.
  subroutine test_values(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: wave_numbers(3) = [0.01_dp, 0.170_dp, 1.0_dp]
    complex(dp), parameter :: printed(3) = [(-9.6735966_dp, 0.00049270_dp), (-9.6734565_dp, 0.14239069_dp), &
      (-9.5063319_dp, 4.91821286_dp)]
    complex(dp), parameter :: frame(3) = [(-9.6735966_dp, 0.00007382_dp), (-9.67356114_dp, 0.02133481_dp), &
      (-9.63125302_dp, 0.73596503_dp)]
    type(oscillating_response_t) :: response
    integer :: i, k
    do k = 1, 2
      call new_oscillating_response(response, 1e-12_dp, 0, k == 2)
      do i = 1, size(printed)
        associate (got => response_at(response, 0.5_dp, wave_numbers(i)**2/4), want => merge(printed(i), frame(i), k == 2))
          call check%close_to(real(got%pressure), real(want), 0.6e-7_dp, 'Int P* sin th, real')
          call check%close_to(aimag(got%pressure), aimag(want), 0.6e-8_dp, 'Int P* sin th, imaginary')
        end associate
      end do
    end do
  end subroutine test_values

  !> B against u^2 t/(1 - t) with the intrinsic tangent, and at the boundary of its two ways of evaluation.
  subroutine test_inertia_function(check)
    class(checks_t), intent(inout) :: check
    complex(dp) :: u, t
    integer :: i
    do i = 1, 400
      u = sqrt(i_unit*0.05_dp*i)
      t = tanh(u)/u
      call check%that(abs(inertia_function(0.05_dp*i) - u**2*t/(1 - t)) <= 1e-13_dp/(0.05_dp*i) + 1e-13_dp, &
        'the inertia function')
    end do
    call check%that(abs(inertia_function(0.5_dp) - inertia_function(0.5_dp + 1e-15_dp)) <= 1e-14_dp, &
      'the inertia function is continuous')
    call check%that(abs(inertia_function(0.0_dp) - 3) <= 0, 'the inertia function at frequency 0')
  end subroutine test_inertia_function

  !> The equations of the theory with tanh, summed over many points.
  subroutine defined_phasors(eps, wave_number, as_printed, phasors)
    real(dp), intent(in) :: eps, wave_number
    logical, intent(in) :: as_printed
    type(film_phasors_t), intent(out) :: phasors
    integer, parameter :: points = 4000
    complex(dp) :: lambda, kappa, means(2), t, d, gradient, core, shear
    real(dp) :: eta, theta, offset
    integer :: j
    lambda = wave_number*sqrt(i_unit)
    offset = merge(1.0_dp, 0.0_dp, as_printed)
    means = 0
    do j = 1, points
      eta = 1 - eps*cos(two_pi*j/points)
      t = tanh(eta*lambda/2)
      d = eta*lambda - 2*t
      means = means + [t/d - offset, 1/d]
    end do
    kappa = means(1)/means(2)
    phasors%flow = 2*kappa/lambda
    phasors%pressure = 0
    phasors%shear = 0
    phasors%moment = 0
    do j = 1, points
      theta = two_pi*j/points
      eta = 1 - eps*cos(theta)
      t = tanh(eta*lambda/2)
      d = eta*lambda - 2*t
      gradient = lambda**2*((t - kappa)/d - offset)
      core = (kappa - t)/d
      shear = lambda*(-(1 - core)/tanh(eta*lambda) - core/sinh(eta*lambda))
      phasors%pressure = phasors%pressure + gradient*cos(theta)*two_pi/points
      phasors%shear = phasors%shear + shear*cos(theta)*two_pi/points
      phasors%moment = phasors%moment + shear*two_pi/points
    end do
  end subroutine defined_phasors

  subroutine test_definition(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(5) = [0.0_dp, 0.1_dp, 0.5_dp, 0.9_dp, 0.99_dp]
    real(dp), parameter :: wave_numbers(5) = [0.5_dp, 1.0_dp, 3.0_dp, 10.0_dp, 30.0_dp]
    type(oscillating_response_t) :: response
    type(film_phasors_t) :: got, want
    integer :: i, j, k
    do k = 1, 2
      call new_oscillating_response(response, 1e-13_dp, 0, k == 2)
      do i = 1, size(ratios)
        do j = 1, size(wave_numbers)
          call defined_phasors(ratios(i), wave_numbers(j), k == 2, want)
          got = response_at(response, ratios(i), wave_numbers(j)**2/4)
          call check%that(abs(got%pressure - want%pressure) <= 1e-10_dp*(abs(want%pressure) + abs(want%moment)), &
            'pressure by its definition')
          call check%that(abs(got%shear - want%shear) <= 1e-10_dp*(abs(want%shear) + abs(want%moment)), &
            'shear by its definition')
          call check%that(abs(got%moment - want%moment) <= 1e-10_dp*abs(want%moment), 'moment by its definition')
          call check%that(abs(got%flow - want%flow) <= 1e-10_dp*abs(want%flow), 'flow by its definition')
        end do
      end do
    end do
  end subroutine test_definition

  !> Without oscillation: Sommerfeld's full film for any eccentricity, which is also the limit of slow oscillation.
  subroutine test_sommerfeld_limit(check)
    class(checks_t), intent(inout) :: check
    type(oscillating_response_t) :: response
    type(film_phasors_t) :: phasors, slow
    real(dp) :: eps, s
    integer :: i
    call new_oscillating_response(response, 1e-10_dp, 0, .false.)
    do i = 0, 30
      eps = 1 - 10**(-0.2_dp*i)
      s = sqrt((1 - eps)*(1 + eps))
      phasors = response_at(response, eps, 0.0_dp)
      call check%relative(real(phasors%pressure), -12*pi*eps/((2 + eps**2)*s), 1e-13_dp, 'Sommerfeld pressure')
      call check%relative(real(phasors%moment), -4*pi*(1 + 2*eps**2)/((2 + eps**2)*s), 1e-13_dp, 'Sommerfeld moment')
      call check%that(abs(aimag(phasors%pressure)) <= 0, 'Sommerfeld pressure is in phase')
      slow = response_at(response, eps, 1e-9_dp)
      call check%that(abs(slow%pressure - phasors%pressure) <= 1e-8_dp*abs(phasors%moment), 'slow oscillation')
      call check%that(abs(slow%moment - phasors%moment) <= 1e-8_dp*abs(phasors%moment), 'slow oscillation, moment')
    end do
  end subroutine test_sommerfeld_limit

  !> The number of points needed for 1e-10 does not increase with the eccentricity.
  subroutine test_points(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(5) = [0.5_dp, 0.9_dp, 0.99_dp, 0.999_dp, 0.9999_dp]
    real(dp), parameter :: wave_numbers(5) = [0.01_dp, 0.17_dp, 1.0_dp, 4.0_dp, 10.0_dp]
    integer, parameter :: allowed(5) = [4, 6, 10, 24, 44]
    type(oscillating_response_t) :: reference, coarse
    integer :: i, j, points
    call new_oscillating_response(reference, 1e-15_dp, 1024, .false.)
    do j = 1, size(wave_numbers)
      do i = 1, size(ratios)
        do points = 2, 512, 2
          call new_oscillating_response(coarse, 1e-15_dp, points, .false.)
          if (distance(coarse, reference, ratios(i), wave_numbers(j)) <= 1e-10_dp) exit
        end do
        call check%that(points <= allowed(j), 'few points are enough at any eccentricity')
      end do
    end do
  end subroutine test_points

  !> Largest difference of two responses, relative to pressure and shear together, since either may vanish.
  pure function distance(one, other, eps, wave_number)
    type(oscillating_response_t), intent(in) :: one, other
    real(dp), intent(in) :: eps, wave_number
    real(dp) :: distance
    type(film_phasors_t) :: a, b
    a = response_at(one, eps, wave_number**2/4)
    b = response_at(other, eps, wave_number**2/4)
    distance = max(abs(a%pressure - b%pressure), abs(a%shear - b%shear), abs(a%moment - b%moment)) &
      /(abs(b%pressure) + abs(b%moment))
  end function distance

  !> The number of points chosen by the rule gives the required accuracy.
  subroutine test_chosen_points(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: accuracies(3) = [1e-6_dp, 1e-9_dp, 1e-12_dp]
    type(oscillating_response_t) :: chosen, reference
    real(dp) :: wave_number, eps, worst
    integer :: i, j, k
    call new_oscillating_response(reference, 1e-15_dp, 4096, .false.)
    do k = 1, size(accuracies)
      call new_oscillating_response(chosen, accuracies(k), 0, .false.)
      worst = 0
      do i = -20, 30
        wave_number = 10**(0.05_dp*i)
        do j = 1, 12
          eps = 1 - 10**(-0.5_dp*j)
          worst = max(worst, distance(chosen, reference, eps, wave_number))
        end do
      end do
      call check%that(worst <= accuracies(k), 'the chosen points are enough')
    end do
  end subroutine test_chosen_points

  !> The series in Q against sums over many points, up to its limit in Q, for any eccentricity: with the required accuracy and with
  !> rounding accuracy. If the case gives a number of points, sums are used instead of the series.
  subroutine test_series(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: accuracies(4) = [1e-8_dp, 1e-10_dp, 1e-13_dp, epsilon(1.0_dp)]
    real(dp), parameter :: ratios(8) = [0.0_dp, 1e-9_dp, 0.01_dp, 0.3_dp, 0.7_dp, 0.95_dp, 0.999_dp, 1 - 1e-6_dp]
    type(oscillating_response_t) :: series, reference, coarse
    real(dp) :: worst, q
    integer :: i, j, k, variant
    do variant = 1, 2
      call new_oscillating_response(reference, 1e-15_dp, 2048, variant == 2)
      do k = 1, size(accuracies)
        call new_oscillating_response(series, accuracies(k), 0, variant == 2)
        worst = 0
        do i = 0, 80
          q = series%series%limit*10**(-0.05_dp*i)
          do j = 1, size(ratios)
            worst = max(worst, distance(series, reference, ratios(j), 2*sqrt(q)))
          end do
        end do
        call check%that(worst <= max(accuracies(k), 1e-14_dp), 'the series agrees with the sum')
        call check%that(series%series%limit > 0.4_dp, 'the series holds far beyond the films of engines')
      end do
      call new_oscillating_response(coarse, 1e-15_dp, 4, variant == 2)
      call check%that(distance(coarse, reference, 0.9_dp, 1.0_dp) > 1e-7_dp, 'a given number of points is used')
    end do
  end subroutine test_series

  !> A film as used by the tests of the flow.
  subroutine make(film, as_printed)
    type(oscillating_film_t), intent(out) :: film
    logical, intent(in) :: as_printed
    film%viscosity = viscosity
    film%kinematic_viscosity = kinematic_viscosity
    call film%prepare(bearing_t(bearing_radius, bearing_length, clearance, 0.0_dp), 1e-6_dp)
    call new_oscillating_response(film%response, 1e-13_dp, 0, as_printed)
  end subroutine make

  pure function some_motion(eps, frequency) result(motion)
    real(dp), intent(in) :: eps, frequency
    type(film_motion_t) :: motion
    motion = film_motion_t(eccentricity=eps*clearance*[0.6_dp, -0.8_dp], eccentricity_rate=[1e-3_dp, 2e-3_dp], &
      pin_speed=55.0_dp, ideal_pin_speed=60.0_dp, ideal_pin_acceleration=7000.0_dp, frequency=frequency)
  end function some_motion

  !> The velocities obey the equation of motion, the conditions at the walls and continuity; their slope at the pin gives the wall
  !> shear.
  subroutine test_flow(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: frequencies(4) = [0.0_dp, 250.0_dp, 1e4_dp, 2e6_dp]
    integer, parameter :: angles = 16, steps = 600
    real(dp), parameter :: d = 1e-3_dp
    type(oscillating_film_t) :: film
    type(film_motion_t) :: motion
    type(film_phasors_t) :: phasors
    complex(dp) :: speed, v(-2:2), curvature, residual, driving, flow, first_flow, moment, shear
    real(dp) :: theta, h, y
    integer :: i, j, k, m
    call make(film, .false.)
    do i = 1, size(frequencies)
      motion = some_motion(0.6_dp, frequencies(i))
      speed = film%surface_speed(motion)
      moment = 0
      shear = 0
      do j = 1, angles
        theta = two_pi*j/angles
        h = clearance*(1 - 0.6_dp*cos(theta))
        call check%that(abs(velocity(film, motion, theta, 0.0_dp) - speed) <= 1e-14_dp*abs(speed), 'no slip at the pin')
        call check%that(abs(velocity(film, motion, theta, 1.0_dp)) <= 1e-14_dp*abs(speed), 'no slip at the bearing')
        driving = pressure_gradient(film, motion, theta)*kinematic_viscosity/(viscosity*pin_radius)
        do k = 1, 9
          y = 0.1_dp*k
          v = [(velocity(film, motion, theta, y + m*d), m=-2, 2)]
          curvature = (-v(-2) + 16*v(-1) - 30*v(0) + 16*v(1) - v(2))/(12*(d*h)**2)
          residual = i_unit*frequencies(i)*v(0) + driving - kinematic_viscosity*curvature
          call check%that(abs(residual) <= 1e-6_dp*(abs(driving) + kinematic_viscosity*abs(speed)/h**2), &
            'the flow obeys the equation of motion')
        end do
        flow = 0
        do k = 1, steps, 2
          flow = flow + h/(3*steps)*(velocity(film, motion, theta, (k - 1.0_dp)/steps) &
            + 4*velocity(film, motion, theta, k*1.0_dp/steps) + velocity(film, motion, theta, (k + 1.0_dp)/steps))
        end do
        if (j == 1) first_flow = flow
        call check%that(abs(flow - first_flow) <= 1e-6_dp*abs(first_flow), 'the same flow everywhere')
        v = [(velocity(film, motion, theta, m*d), m=0, 4)]
        v(-2) = (-25*v(-2) + 48*v(-1) - 36*v(0) + 16*v(1) - 3*v(2))/(12*d*h)
        moment = moment + v(-2)*clearance/speed*two_pi/angles
        shear = shear + v(-2)*clearance/speed*cos(theta)*two_pi/angles
      end do
      phasors = response_of(film, motion)
      call check%that(abs(moment - phasors%moment) <= 1e-4_dp*abs(phasors%moment), 'moment from the velocity slope at the pin')
      call check%that(abs(shear - phasors%shear) <= 1e-4_dp*(abs(phasors%shear) + abs(phasors%moment)), &
        'shear from the velocity slope at the pin')
    end do
  end subroutine test_flow

  !> Force and moment from the pressure gradient and the velocities in x and y, which determines the signs.
  subroutine test_force(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 400
    real(dp), parameter :: frequencies(3) = [0.0_dp, 250.0_dp, 1000.0_dp]
    type(oscillating_film_t) :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment, total(2), turning, p, tau, theta, angle, direction, d
    integer :: i, j, k
    call make(film, .false.)
    motion = some_motion(0.7_dp, 250.0_dp)
    call check%relative(real(film%surface_speed(motion)), 60*pin_radius, 1e-14_dp, 'the surface speed')
    call check%relative(real(i_unit*250*film%surface_speed(motion)), 7000*pin_radius, 1e-14_dp, 'rate of the surface speed')
    call check%that(film%needs_ideal_motion, 'the film needs the motion of the ideal mechanism')
    d = 1e-4_dp
    do k = 0, 1
      film%response%as_printed = k == 1
      film%arm_length = merge(rod_length, 0.0_dp, k == 1)
      do i = 1, size(frequencies)
        motion = some_motion(0.7_dp, frequencies(i))
        call film%film_force(motion, force, moment)
        direction = atan2(motion%eccentricity(2), motion%eccentricity(1))
        total = 0
        turning = 0
        p = 0
        do j = 1, points
          theta = two_pi*j/points
          p = p + real(pressure_gradient(film, motion, theta) &
            + pressure_gradient(film, motion, theta - two_pi/points))*pi/points
          tau = viscosity*real(4*velocity(film, motion, theta, d) - velocity(film, motion, theta, 2*d) &
            - 3*velocity(film, motion, theta, 0.0_dp))/(2*d*clearance*(1 - 0.7_dp*cos(theta)))
          angle = theta + direction
          total = total + (-p*[cos(angle), sin(angle)] + tau*[-sin(angle), cos(angle)])*two_pi/points
          turning = turning + tau*two_pi/points
        end do
        total = total*pin_radius*bearing_length
        turning = turning*pin_radius**2*bearing_length
        call check%that(norm2(total - force) <= 3e-4_dp*norm2(force), 'the force is that of pressure and shear')
        call check%relative(moment, turning, 1e-5_dp, 'the moment is that of the shear')
        call check%that(moment < 0, 'the shear slows the pin')
      end do
    end do
    film%response%as_printed = .false.
    film%arm_length = 0
    motion = film_motion_t(eccentricity=[0.5_dp*clearance, 0.0_dp], eccentricity_rate=0, pin_speed=0.0_dp, &
      ideal_pin_speed=2.0_dp)
    call film%film_force(motion, force, moment)
    call check%that(abs(force(1)) <= 0, 'no force along the line of centres')
    call check%relative(force(2), 12*pi*viscosity*bearing_length*pin_radius**2*(2*pin_radius)*0.5_dp &
      /(clearance**2*2.25_dp*sqrt(0.75_dp)), 0.5e-2_dp, 'Sommerfeld''s force, except for the shear')
  end subroutine test_force

  !> The two acceleration terms of (5.4): the second changes the response by about 1 % at L* = 0.17; the first is a radial
  !> force, the inertia of the oil displaced by the pin.
  subroutine test_as_printed(check)
    class(checks_t), intent(inout) :: check
    type(oscillating_film_t) :: film, printed
    type(film_phasors_t) :: own, other
    type(film_motion_t) :: motion
    real(dp) :: one(2), two(2), moment
    call make(film, .false.)
    call make(printed, .true.)
    motion = some_motion(0.5_dp, 250.0_dp)
    own = response_of(film, motion)
    other = response_of(printed, motion)
    call check%that(abs(other%pressure/own%pressure - 1) > 0.005_dp .and. abs(other%pressure/own%pressure - 1) < 0.02_dp, &
      'the second acceleration term is small')
    call printed%film_force(motion, one, moment)
    printed%arm_length = rod_length
    call printed%film_force(motion, two, moment)
    call check%that(norm2(two - one - [0.6_dp, -0.8_dp]*pi*(viscosity/kinematic_viscosity)*bearing_length*pin_radius &
      *250*rod_length*pin_radius*60) <= 1e-12_dp*norm2(two), 'the first acceleration term')
  end subroutine test_as_printed

  !> Near the wall the force grows like (1 - eps)^-1/2; beyond the largest ratio it is constant.
  subroutine test_wall(check)
    class(checks_t), intent(inout) :: check
    type(oscillating_film_t) :: film
    real(dp) :: held(2), force(2), other(2), moment, at_held
    integer :: i
    real(dp), parameter :: beyond(5) = [1 - 1e-7_dp, 1.0_dp, 1.0000001_dp, 1.5_dp, 1e5_dp]
    call make(film, .false.)
    call film%film_force(some_motion(max_eccentricity_ratio, 250.0_dp), held, at_held)
    do i = 1, size(beyond)
      call film%film_force(some_motion(beyond(i), 250.0_dp), force, moment)
      call check%that(norm2(force - held) <= 1e-9_dp*norm2(held), 'the force is limited at the wall')
      call check%relative(moment, at_held, 1e-9_dp, 'the moment is limited at the wall')
    end do
    call film%film_force(some_motion(1 - 1e-5_dp, 250.0_dp), force, moment)
    call film%film_force(some_motion(1 - 4e-5_dp, 250.0_dp), other, moment)
    call check%relative(norm2(force)/norm2(other), 2.0_dp, 1e-3_dp, 'the force near the wall')
  end subroutine test_wall

  !> Beyond the largest ratio the flow is also that of the limited film.
  subroutine test_held_flow(check)
    class(checks_t), intent(inout) :: check
    type(oscillating_film_t) :: film
    type(film_motion_t) :: inside, beyond
    real(dp), parameter :: theta = 0.2_dp
    call make(film, .false.)
    film%largest_ratio = 0.9_dp
    inside = some_motion(0.9_dp, 250.0_dp)
    beyond = some_motion(0.95_dp, 250.0_dp)
    call check%that(abs(pressure_gradient(film, beyond, theta)/pressure_gradient(film, inside, theta) - 1) <= 1e-12_dp, &
      'pressure of the limited film')
    call check%that(abs(velocity(film, beyond, theta, 0.3_dp)/velocity(film, inside, theta, 0.3_dp) - 1) <= 1e-12_dp, &
      'velocity of the limited film')
  end subroutine test_held_flow

  subroutine test_extremes(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(8) = [0.0_dp, 1e-300_dp, 1e-200_dp, 1e-20_dp, 0.5_dp, 0.9999999999_dp, 1.0_dp, 1e5_dp]
    real(dp), parameter :: frequencies(7) = [0.0_dp, 1e-300_dp, 1e-10_dp, 1.0_dp, 1e5_dp, 1e10_dp, 1e16_dp]
    type(oscillating_film_t) :: film
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment
    integer :: i, j
    call make(film, .true.)
    film%arm_length = rod_length
    do i = 1, size(ratios)
      do j = 1, size(frequencies)
        motion = some_motion(ratios(i), frequencies(j))
        motion%ideal_pin_acceleration = frequencies(j)**2
        call film%film_force(motion, force, moment)
        call check%that(all(abs(force) <= huge(1.0_dp)) .and. abs(moment) <= huge(1.0_dp), 'finite for extreme inputs')
      end do
    end do
    motion = some_motion(0.0_dp, 250.0_dp)
    film%arm_length = 0
    call film%film_force(motion, force, moment)
    call check%that(norm2(force) <= 1e-12_dp .and. moment < 0, 'only a moment acts on a centred pin')
  end subroutine test_extremes

  subroutine test_factory(check)
    class(checks_t), intent(inout) :: check
    character(len=25), parameter :: variants(3) = [character(len=25) :: '', "variant='bearing_frame'", "variant='as_printed'"]
    character(len=*), parameter :: oil = "law='oscillating_film' viscosity=0.0117 kinematic_viscosity=1.38e-5 "
    class(film_law_t), allocatable :: film
    type(error_t), allocatable :: error
    real(dp) :: force(2, 3), moment
    integer :: i
    do i = 1, size(variants)
      call film_law_of(oil//trim(variants(i)), 1e-6_dp, film, error)
      call check%that(allocated(film) .and. .not. allocated(error), 'a film for '//variants(i))
      if (.not. allocated(film)) cycle
      call check%that(film%needs_ideal_motion .and. .not. film%singular_at_wall, 'properties of the film')
      call film%film_force(some_motion(0.5_dp, 250.0_dp), force(:, i), moment)
    end do
    call check%that(norm2(force(:, 1) - force(:, 2)) <= 0, 'the default variant')
    call check%that(norm2(force(:, 1) - force(:, 3)) > 1e-3_dp*norm2(force(:, 1)), 'the printed variant')
  end subroutine test_factory
end module test_oscillating_film
