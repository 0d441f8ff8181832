!> Rough surfaces: the integral of Greenwood and Tripp and the mean gap against tables, the force on the pin against another
!> quadrature; mixed lubrication against its limits.
module test_asperities
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use asperities, only: asperities_t, pressure_integral
  use mixed_film, only: mixed_forces, mixed_derivatives, mixed_velocity
  use film_law, only: film_law_t, film_motion_t
  use laws, only: film_law_of
  implicit none
  private
  public :: run_test_asperities

  real(dp), parameter :: c = 20e-6_dp

contains

  subroutine run_test_asperities(check)
    class(checks_t), intent(inout) :: check
    call integral_of_the_table(check)
    call force_of_the_table(check)
    call table_meets_quadrature(check)
    call smooth_where_far(check)
    call derivatives_by_steps(check)
    call rubs(check)
    call carries_a_load(check)
  end subroutine run_test_asperities

  !> The exact integral (parabolic cylinder function, 25 digits) and its fit, with the mean gap and its slope.
  subroutine integral_of_the_table(check)
    class(checks_t), intent(inout) :: check
    type(asperities_t) :: rough
    character(len=200) :: line
    real(dp) :: h, exact, fit, rest, gap, slope, got, got_slope
    integer :: unit, status, rows
    rough%roughness = 0.3e-6_dp
    rows = 0
    open (newunit=unit, file='data/film/greenwood_tripp_f52.csv', status='old', action='read')
    read (unit, '(a)') line
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      read (line, *) h, exact, fit, rest, gap, slope
      rows = rows + 1
      call check%relative(pressure_integral(h, .false.), exact, 1e-6_dp, 'F52')
      if (fit > 0) call check%relative(pressure_integral(h, .true.), fit, 1e-9_dp, 'the fit of F52')
      call rough%mean_gap(h*rough%roughness, got, got_slope)
      call check%relative(got, gap*rough%roughness, 1e-9_dp, 'mean gap')
      call check%relative(got_slope, slope, 1e-9_dp, 'slope of the mean gap')
    end do
    close (unit)
    call check%that(rows >= 8, 'the table was read')
    call check%relative(pressure_integral(-4 - 1e-12_dp, .false.), pressure_integral(-4.0_dp, .false.), 2e-6_dp, &
      'F52 is continuous where its series ends')
    got = 0   ! the mean of (u + 10)^2.5 by the trapezoidal rule
    do unit = -1000, 1000
      got = got + 0.01_dp*(10 + 0.01_dp*unit)**2.5_dp*exp(-0.5_dp*(0.01_dp*unit)**2)/sqrt(2*pi)
    end do
    call check%relative(pressure_integral(-10.0_dp, .false.), got, 1e-9_dp, 'F52 for deep penetration')
  end subroutine integral_of_the_table

  !> Force on the pin by the fit; and by the exact integral where cutting the arc at 4 s has no influence.
  subroutine force_of_the_table(check)
    class(checks_t), intent(inout) :: check
    type(asperities_t) :: fit, exact
    character(len=200) :: line
    real(dp) :: ratio, by_fit, by_exact, quadrature, seen, factor, gap, slope
    integer :: unit, status
    fit = rough_bearing('fit', 0.8e-6_dp)
    exact = rough_bearing('exact', 0.8e-6_dp)
    open (newunit=unit, file='data/film/asperity_force.csv', status='old', action='read')
    read (unit, '(a)') line
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      read (line, *) ratio, by_fit, by_exact, quadrature, seen, factor
      if (by_fit > 1) call check%relative(fit%integrated_force(ratio*c), by_fit, 1e-8_dp, 'force of the fit')
      if (ratio > 0.91_dp) call check%relative(exact%integrated_force(ratio*c), by_exact, 2e-4_dp, 'exact force')
      call exact%mean_gap(c*(1 - ratio), gap, slope)
      call check%close_to(1 - gap/c, seen, 1e-11_dp, 'eccentricity ratio used by the film')
      call check%close_to(slope, factor, 1e-11_dp, 'share of the radial rate')
    end do
    close (unit)
  end subroutine force_of_the_table

  !> The spline of the forces against the quadrature itself, and beyond its last value.
  subroutine table_meets_quadrature(check)
    class(checks_t), intent(inout) :: check
    type(asperities_t) :: rough
    real(dp) :: distance, want
    integer :: i, j
    do j = 1, 2
      rough = rough_bearing(merge('exact', 'fit  ', j == 1), 0.5e-6_dp)
      do i = 1, 200
        distance = c - rough%roughness*(7.0_dp - 0.15_dp*i)
        want = rough%integrated_force(distance)
        if (want < 1e-2_dp) cycle
        call check%relative(rough%force(distance), want, 2e-6_dp, 'force from the table and by quadrature')
      end do
      call check%that(abs(rough%force(0.0_dp)) <= 0, 'no asperity force on a centred pin')
    end do
  end subroutine table_meets_quadrature

  !> If the surfaces are far apart, the film is that of smooth surfaces.
  subroutine smooth_where_far(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(asperities_t) :: rough
    type(film_motion_t) :: motion
    real(dp) :: smooth(2), force(2), moment, pressing, friction
    call new_film(check, film)
    rough = rough_bearing('exact', 0.1e-6_dp)
    motion = motion_of([9e-6_dp, -4e-6_dp], [3e-3_dp, 1e-3_dp])
    call film%film_force(motion, smooth, moment)
    call mixed_forces(film, rough, 1e-2_dp, motion, 1.0_dp, force, moment, pressing, friction)
    call check%that(norm2(force - smooth) <= 1e-12_dp*norm2(smooth) .and. pressing <= 0, &
      'film of distant rough surfaces is that of smooth ones')
  end subroutine smooth_where_far

  !> The derivatives for implicit integration against finite differences with another step, inside and beyond the clearance.
  subroutine derivatives_by_steps(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(asperities_t) :: rough
    type(film_motion_t) :: motion, other
    real(dp) :: derivatives(3, 6), above(3), below(3), step
    integer :: i, k
    call new_film(check, film)
    rough = rough_bearing('exact', 0.4e-6_dp)
    do k = 1, 2
      motion = motion_of([0.97_dp, 1.01_dp]*c*[cos(0.4_dp*k), sin(0.4_dp*k)], [1e-3_dp, -2e-3_dp])
      call mixed_derivatives(film, rough, 1e-2_dp, motion, 1.0_dp, derivatives)
      do i = 1, 2
        step = 1e-10_dp
        other = motion
        other%eccentricity(i) = motion%eccentricity(i) + step
        call whole(film, rough, other, above)
        other%eccentricity(i) = motion%eccentricity(i) - step
        call whole(film, rough, other, below)
        call check%that(maxval(abs(derivatives(:2, i) - (above(:2) - below(:2))/(2*step))) <= 1e-4_dp*maxval(abs(derivatives)), &
          'derivatives by the eccentricity')
      end do
    end do
  end subroutine derivatives_by_steps

  subroutine whole(film, rough, motion, values)
    class(film_law_t), intent(in) :: film
    type(asperities_t), intent(in) :: rough
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: values(3)
    real(dp) :: pressing, friction, n(2)
    call mixed_forces(film, rough, 1e-2_dp, motion, 1.0_dp, values(:2), values(3), pressing, friction)
    n = motion%eccentricity/norm2(motion%eccentricity)
    values(:2) = values(:2) - pressing*n + friction*[-n(2), n(1)]
    values(3) = values(3) + 1e-2_dp*friction
  end subroutine whole

  !> Boundary friction opposes the sliding of the surfaces and does not exceed coefficient times force.
  subroutine rubs(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(asperities_t) :: rough
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment, pressing, friction
    integer :: way
    call new_film(check, film)
    rough = rough_bearing('exact', 0.4e-6_dp)
    do way = -1, 1, 2
      motion = motion_of([0.0_dp, 0.99_dp*c], [0.0_dp, 0.0_dp])
      motion%pin_speed = way*50.0_dp
      motion%turning_speed = motion%pin_speed
      call mixed_forces(film, rough, 1e-2_dp, motion, 1.0_dp, force, moment, pressing, friction)
      call check%that(pressing > 100 .and. way*friction < 0, 'boundary friction opposes the sliding')
      call check%relative(abs(friction), 0.1_dp*pressing, 1e-6_dp, 'boundary friction at high sliding speed')
    end do
  end subroutine rubs

  !> The velocity with which film and asperities carry a load: with it their forces are opposite to the load, from the centre to
  !> beyond the clearance, at fast and slow sliding, where the friction has any value below its largest.
  subroutine carries_a_load(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratios(6) = [0.0_dp, 1e-4_dp, 0.5_dp, 0.95_dp, 0.99_dp, 1.01_dp], speeds(4) = [50.0_dp, -50.0_dp, &
      0.3_dp, 0.0_dp]
    class(film_law_t), allocatable :: film
    type(asperities_t) :: rough
    type(film_motion_t) :: motion
    real(dp) :: load(2), velocity(2), force(2), moment, pressing, friction, pressed, rubbed, n(2), worst
    integer :: i, j, k, partial
    call new_film(check, film)
    rough = rough_bearing('exact', 0.4e-6_dp)
    worst = 0
    partial = 0
    do i = 1, size(ratios)
      do j = 1, size(speeds)
        do k = 1, 12
          n = [cos(0.7_dp), sin(0.7_dp)]
          motion = motion_of(ratios(i)*c*n, [0.0_dp, 0.0_dp])
          motion%pin_speed = speeds(j)
          motion%turning_speed = speeds(j)
          load = 3e3_dp*[cos(0.5_dp*k), sin(0.5_dp*k)]
          call mixed_velocity(film, rough, 1e-2_dp, motion, 1.0_dp, load, velocity, pressing, friction)
          motion%eccentricity_rate = velocity
          call mixed_forces(film, rough, 1e-2_dp, motion, 1.0_dp, force, moment, pressed, rubbed)
          if (.not. ratios(i) > 0) n = [1.0_dp, 0.0_dp]
          worst = max(worst, norm2(force - pressed*n + rubbed*[-n(2), n(1)] + load)/norm2(load), &
            abs(rubbed - friction)/max(pressing, 1.0_dp))
          if (abs(friction) < 0.09_dp*pressing .and. pressing > 1) partial = partial + 1
        end do
      end do
    end do
    call check%close_to(worst, 0.0_dp, 1e-8_dp, 'film and asperities carry the load')
    call check%that(partial > 10, 'some surfaces slide slowly')
  end subroutine carries_a_load

  function rough_bearing(integral, roughness) result(rough)
    character(len=*), intent(in) :: integral
    real(dp), intent(in) :: roughness
    type(asperities_t) :: rough
    rough%integral = trim(integral)
    rough%roughness = roughness
    rough%density_product = 0.05_dp
    rough%sharpness = 1e-2_dp
    rough%youngs_modulus = 207e9_dp
    rough%poissons_ratio = 0.3_dp
    rough%coefficient = 0.1_dp
    rough%transition_speed = 0.01_dp
    call rough%prepare(bearing_t(1e-2_dp, 15e-3_dp, c, 0.2_dp))
    call rough%make_table()
  end function rough_bearing

  subroutine new_film(check, film)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable, intent(out) :: film
    type(error_t), allocatable :: error
    call film_law_of("viscosity=0.0117 variant='closed_form'", 1e-6_dp, film, error)
    call check%that(.not. allocated(error), 'a film')
  end subroutine new_film

  pure function motion_of(eccentricity, rate) result(motion)
    real(dp), intent(in) :: eccentricity(2), rate(2)
    type(film_motion_t) :: motion
    motion%eccentricity = eccentricity
    motion%eccentricity_rate = rate
    motion%pin_speed = 100
    motion%turning_speed = 100
  end function motion_of
end module test_asperities
