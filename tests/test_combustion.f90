!> The gas cycle against published and independently computed values.
module test_combustion
  use kinds, only: dp
  use constants, only: pi, degree
  use error_handling, only: error_t
  use checks, only: checks_t
  use ideal_linkage, only: linkage_t
  use cylinder, only: cylinder_t, new_cylinder
  use hermite_table, only: hermite_table_t, new_hermite_table
  use working_gas, only: working_gas_t
  use gas_cycle, only: gas_cycle_t, heat_release_t, new_gas_cycle, part_compression, part_combustion, part_expansion, &
    part_open
  implicit none
  private
  public :: run_test_combustion

contains

  subroutine run_test_combustion(check)
    class(checks_t), intent(inout) :: check
    call volume_is_consistent(check)
    call table_is_a_quintic(check)
    call wiebe_reference(check, -20.0_dp, 87.782260_dp, 10.8130_dp, 11.840319_dp)
    call wiebe_reference(check, -40.0_dp, 112.794938_dp, 0.0_dp, 11.139123_dp)
    call wiebe_reference(check, 0.0_dp, 53.532635_dp, 27.6949_dp, 11.035783_dp)
    call thesis_engine(check, 165.0_dp, 31.047153894_dp, 367.2992_dp, 94.73_dp)
    call thesis_engine(check, 650.0_dp, 62.506498280_dp, 370.1195_dp, 373.16_dp)
    call parts_join(check)
    call energy_of_the_gas(check, 3.0_dp)
    call energy_of_the_gas(check, 2.37_dp)
    call energy_of_the_gas(check, 0.4_dp)
    call short_release(check, 1.0_dp, 5.0_dp)
    call short_release(check, 14.0_dp, 470.0_dp)
    call short_release(check, 20.0_dp, 5.0_dp)
    call short_release(check, 87.3_dp, 0.01_dp)
    call short_release(check, 100.0_dp, 1000.0_dp)
  end subroutine run_test_combustion

  subroutine volume_is_consistent(check)
    class(checks_t), intent(inout) :: check
    type(cylinder_t) :: c
    real(dp) :: q, h, x, d, across, top, stroke
    integer :: i, k
    h = 1e-4_dp
    do k = -1, 1
      d = 0.013_dp*k
      c = new_cylinder(0.07_dp, linkage_t(0.0508_dp, 0.2032_dp, d), 9.0_dp)
      top = sqrt(0.254_dp**2 - d**2)
      stroke = top - sqrt(0.1524_dp**2 - d**2)
      call check%relative(c%volume(c%bottom)/c%volume(2*pi), 9.0_dp, 1e-14_dp, 'compression ratio')
      call check%relative(c%displacement, pi*0.035_dp**2*stroke, 1e-14_dp, 'displacement')
      do i = 1, 10
        q = 0.6_dp*i
        call check%close_to(c%volume_slope(q), (c%volume(q + h) - c%volume(q - h))/(2*h), 1e-11_dp, 'dV/dq')
        call check%close_to(c%volume_curvature(q), (c%volume_slope(q + h) - c%volume_slope(q - h))/(2*h), 1e-11_dp, 'd2V/dq2')
        ! the dead volume is an eighth of the stroke high; the pin is at x
        across = 0.0508_dp*sin(q + asin(d/0.254_dp)) - d
        x = 0.0508_dp*cos(q + asin(d/0.254_dp)) + sqrt((0.2032_dp + across)*(0.2032_dp - across))
        call check%relative(c%volume(q), pi*0.035_dp**2*(stroke/8 + (top - x)), 1e-13_dp, 'V(q) from the position of the piston')
      end do
    end do
  end subroutine volume_is_consistent

  subroutine table_is_a_quintic(check)
    class(checks_t), intent(inout) :: check
    type(hermite_table_t) :: table
    real(dp) :: x(0:4)
    integer :: i
    x = [(0.25_dp*i, i=0, 4)]
    table = new_hermite_table(x**5 - x**3 + 2, 5*x**4 - 3*x**2, 20*x**3 - 6*x)
    do i = -1, 11
      call check%close_to(table%value(0.1_dp*i), (0.1_dp*i)**5 - (0.1_dp*i)**3 + 2, 1e-13_dp, 'a quintic polynomial is reproduced')
    end do
  end subroutine table_is_a_quintic

  !> Largest pressure [Pa], its angle [deg] and net work of the closed part [J] by fine sampling, Simpson's rule and a parabola.
  subroutine scan(gas, peak, peak_angle, work)
    type(gas_cycle_t), intent(in) :: gas
    real(dp), intent(out) :: peak, peak_angle, work
    integer, parameter :: n = 4000
    real(dp) :: q, h, p, w, best(3), curvature
    integer :: part, i

    peak = 0
    peak_angle = 0
    work = 0
    do part = part_compression, part_expansion
      h = (gas%bound(part) - gas%bound(part - 1))/n
      do i = 0, n
        q = gas%bound(part - 1) + i*h
        p = gas%pressure(q, part, 0.0_dp)
        w = merge(4.0_dp, 2.0_dp, mod(i, 2) == 1)
        if (i == 0 .or. i == n) w = 1
        work = work + w*h/3*(p - gas%intake_pressure)*gas%cylinder%volume_slope(q)
        if (.not. p > peak) cycle
        peak = p
        peak_angle = q/degree
        if (i == 0 .or. i == n) cycle
        best = [gas%pressure(q - h, part, 0.0_dp), p, gas%pressure(q + h, part, 0.0_dp)]
        curvature = best(1) - 2*best(2) + best(3)
        if (max(best(1), best(3)) > p .or. .not. curvature < 0) cycle
        peak = p - 0.125_dp*(best(1) - best(3))**2/curvature
        peak_angle = (q + 0.5_dp*h*(best(1) - best(3))/curvature)/degree
      end do
    end do
  end subroutine scan

  !> Infinite rod, r = 10, gamma = 1.4, Q/(p1 V1) = 20, duration 40 deg, a = 5, n = 3 (physics: six digits).
  subroutine wiebe_reference(check, start, peak, angle, work)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: start, peak, angle, work
    type(gas_cycle_t) :: gas
    type(error_t), allocatable :: error
    real(dp) :: got_peak, got_angle, got_work, unit

    gas%cylinder = new_cylinder(0.1_dp, linkage_t(0.05_dp, 0.05e9_dp), 10.0_dp)
    unit = gas%intake_pressure*gas%cylinder%volume(pi)
    gas%release = heat_release_t(20*unit, 5.0_dp, 3.0_dp, (360 + start)*degree, 40*degree)
    call new_gas_cycle(gas, 1e-12_dp, error)
    call check%that(.not. allocated(error), 'integration of the cycle')
    call scan(gas, got_peak, got_angle, got_work)
    call check%relative(got_peak/gas%intake_pressure, peak, 1e-7_dp, 'Wiebe reference: peak pressure')
    call check%close_to(got_angle, 360 + angle, 1e-3_dp, 'Wiebe reference: angle of the peak')
    call check%relative(got_work/unit, work, 1e-6_dp, 'Wiebe reference: work')
  end subroutine wiebe_reference

  pure function engine(heat, form) result(gas)
    real(dp), intent(in) :: heat, form
    type(gas_cycle_t) :: gas
    gas%cylinder = new_cylinder(0.07_dp, linkage_t(0.0508_dp, 0.2032_dp), 9.0_dp)
    gas%release = heat_release_t(heat, 5.0_dp, form, 340*degree, 40*degree)
  end function engine

  !> Table 6.6: peak pressure [bar] and its angle [deg] from an independent Runge-Kutta integration of (A.9) in 40,000 steps,
  !> the net work of a cycle [J] to the digits known.
  subroutine thesis_engine(check, heat, peak, angle, work)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: heat, peak, angle, work
    type(gas_cycle_t) :: gas
    type(error_t), allocatable :: error
    real(dp) :: got_peak, got_angle, got_work
    gas = engine(heat, 3.0_dp)
    call new_gas_cycle(gas, 1e-10_dp, error)
    call scan(gas, got_peak, got_angle, got_work)
    call check%close_to(got_peak/1e5_dp, peak, 1e-7_dp, 'engine: peak pressure [bar]')
    call check%close_to(got_angle, angle, 1e-3_dp, 'engine: angle of the peak [deg]')
    call check%close_to(got_work, work, 0.01_dp, 'engine: net work of a cycle [J]')
  end subroutine thesis_engine

  !> The parts of the cycle follow each other in both directions, and the pressure is continuous except at the blow-down.
  subroutine parts_join(check)
    class(checks_t), intent(inout) :: check
    type(gas_cycle_t) :: gas
    type(working_gas_t) :: working
    type(error_t), allocatable :: error
    real(dp) :: start
    integer :: part, i
    real(dp), parameter :: angle(4) = [180.0_dp, 340.0_dp, 380.0_dp, 540.0_dp]
    gas = engine(165.0_dp, 3.0_dp)
    call new_gas_cycle(gas, 1e-10_dp, error)
    do i = 1, 3
      call check%relative(gas%pressure(gas%bound(i), i, 0.0_dp), &
        gas%pressure(gas%bound(i), i + 1, 0.0_dp), merge(1e-12_dp, 2.0_dp, i < 3), 'pressure is continuous between the parts')
    end do
    do i = 1, 4
      call gas%part_at(angle(i)*degree, .false., part, start)
      call check%that(part == i .and. start <= 0 .and. start >= 0, 'with forward rotation a part begins at its first angle')
      call gas%part_at(angle(i)*degree, .true., part, start)
      call check%that(part == merge(4, i - 1, i == 1), 'with backward rotation the previous part begins there')
      call gas%part_at(angle(i)*degree + 3*gas%period + 1e-9_dp, .false., part, start)
      call check%that(part == i .and. nint(start/gas%period) == 3, 'a part of the fourth cycle begins at its first angle')
    end do
    call gas%part_at(0.0_dp, .false., part, start)
    call check%that(part == part_open .and. start < 0, 'the cycle at q = 0 is open')
    call check%relative(gas%pressure(0.0_dp, part, start), 101325.0_dp, 1e-15_dp, 'the open cycle is at intake pressure')
    working%cylinder = gas%cylinder
    working%crankcase_pressure = 101325
    call check%close_to(working%force(201325.0_dp), 1e5_dp*pi*0.07_dp**2/4, 1e-10_dp, 'gas force')
  end subroutine parts_join

  !> First law over the combustion: change of p V/(gamma-1) + work = heat released, 1 - e^-a of Q_in, also where the
  !> release begins with an infinite rate (n < 1).
  subroutine energy_of_the_gas(check, form)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: form
    type(gas_cycle_t) :: gas
    type(error_t), allocatable :: error
    integer, parameter :: n = 20000
    real(dp) :: q, xi, xi_step, work, slope, w, inner
    integer :: i

    gas = engine(165.0_dp, form)
    call new_gas_cycle(gas, 1e-11_dp, error)
    call check%that(.not. allocated(error), 'integration of the cycle')
    call tables_are_accurate(check, gas)
    xi_step = 1.0_dp/n
    work = 0
    do i = 0, n
      xi = i*xi_step
      q = gas%bound(1) + xi**8*(gas%bound(2) - gas%bound(1))
      slope = 8*xi**7*(gas%bound(2) - gas%bound(1))
      w = merge(4.0_dp, 2.0_dp, mod(i, 2) == 1)
      if (i == 0 .or. i == n) w = 1
      work = work + w*xi_step/3*gas%pressure(q, part_combustion, 0.0_dp)*gas%cylinder%volume_slope(q)*slope
    end do
    inner = (gas%pressure(gas%bound(2), part_combustion, 0.0_dp)*gas%cylinder%volume(gas%bound(2)) &
      - gas%pressure(gas%bound(1), part_combustion, 0.0_dp)*gas%cylinder%volume(gas%bound(1))) &
      /(gas%heat_capacity_ratio - 1)
    call check%relative(inner + work, 165*(1 - exp(-5.0_dp)), 1e-9_dp, 'first law over the combustion')
  end subroutine energy_of_the_gas

  !> A release within a thousandth of a degree about the dead centre is one at constant volume, also if nearly all of it comes in a
  !> small part of its duration (exponents up to 100).
  subroutine short_release(check, form, efficiency)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: form, efficiency
    type(gas_cycle_t) :: gas
    type(error_t), allocatable :: error
    real(dp) :: compressed, released
    gas = engine(165.0_dp, form)
    gas%release = heat_release_t(165.0_dp, efficiency, form, (360 - 5e-4_dp)*degree, 1e-3_dp*degree)
    call new_gas_cycle(gas, 1e-10_dp, error)
    call check%that(.not. allocated(error), 'integration of a short release')
    compressed = 101325*(gas%cylinder%volume(pi)/gas%cylinder%volume(2*pi))**1.4_dp
    released = 0.4_dp*165*(1 - exp(-efficiency))/gas%cylinder%volume(2*pi)
    call check%relative(gas%pressure(gas%bound(2), part_expansion, 0.0_dp), compressed + released, 1e-8_dp, &
      'a short release of heat')
  end subroutine short_release

  !> Tables for four tolerances against the most accurate one, at angles between the points of both; and the most accurate table
  !> against p V^gamma, which is constant without heat release. The tables' own error estimates are not used.
  subroutine tables_are_accurate(check, best)
    class(checks_t), intent(inout) :: check
    type(gas_cycle_t), intent(in) :: best   !! made with a tolerance of 1e-11
    type(gas_cycle_t) :: gas
    type(error_t), allocatable :: error
    integer, parameter :: points = 997
    real(dp) :: q, worst, constancy
    integer :: i, k, part

    constancy = 0
    do i = 1, points - 1
      q = best%bound(0) + i*(best%bound(1) - best%bound(0))/points
      constancy = max(constancy, abs(best%pressure(q, part_compression, 0.0_dp)/101325 &
        *(best%cylinder%volume(q)/best%cylinder%volume(pi))**1.4_dp - 1))
    end do
    call check%close_to(constancy, 0.0_dp, 1e-11_dp, 'p V^gamma is constant during compression')
    do k = 3, 9, 2
      gas = best
      call new_gas_cycle(gas, 10.0_dp**(-k), error)
      if (allocated(error)) error stop 'a cycle is not integrated'
      worst = 0
      do part = part_compression, part_expansion
        do i = 1, points - 1
          q = gas%bound(part - 1) + i*(gas%bound(part) - gas%bound(part - 1))/points
          worst = max(worst, abs(gas%pressure(q, part, 0.0_dp)/best%pressure(q, part, 0.0_dp) - 1))
        end do
      end do
      call check%close_to(worst, 0.0_dp, 2*10.0_dp**(-k), 'error of a table is within its tolerance')
    end do
  end subroutine tables_are_accurate
end module test_combustion
