!> Measured curves: the cubic polynomials through their points, and the work of a measured pressure.
module test_measured_curves
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use error_handling, only: error_t
  use monotone_cubic, only: monotone_cubic_t, new_monotone_cubic, new_periodic_cubic
  use ideal_linkage, only: linkage_t
  use measured_pressure, only: measured_pressure_t
  use working_gas, only: working_gas_t
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_measured_curves

contains

  subroutine run_test_measured_curves(check)
    class(checks_t), intent(inout) :: check
    call known_cubic(check)
    call straight_lines(check)
    call periodic_cubic(check)
    call work_of_a_sine(check)
    call offset_of_a_table(check)
  end subroutine run_test_measured_curves

  !> An offset is added to every pressure of a table.
  subroutine offset_of_a_table(check)
    class(checks_t), intent(inout) :: check
    type(measured_pressure_t) :: table
    type(working_gas_t) :: gas
    type(error_t), allocatable :: error
    integer :: i
    table%bore = 0.07_dp
    table%period_deg = 360
    table%curve%x = [(30.0_dp*i, i=0, 11)]
    table%curve%y = [(1e5_dp + 2e4_dp*i, i=0, 11)]
    table%pressure_offset = -3e4_dp
    call table%prepare(linkage_t(0.04_dp, 0.13_dp), 1.0_dp, 1e-9_dp, gas, error)
    do i = 0, 11
      call check%close_to(gas%pressure(30*i*degree), 7e4_dp + 2e4_dp*i, 1e-6_dp, 'a table with an offset of its pressures')
    end do
  end subroutine offset_of_a_table

  !> Steffen's slopes computed by hand: for the points (0,0) (1,1) (3,2) (4,2) they are 5/6 at 1 and 0 at 3.
  subroutine known_cubic(check)
    class(checks_t), intent(inout) :: check
    type(monotone_cubic_t) :: curve
    real(dp) :: x
    integer :: i
    curve = new_monotone_cubic([0.0_dp, 1.0_dp, 3.0_dp, 4.0_dp], [0.0_dp, 1.0_dp, 2.0_dp, 2.0_dp])
    call check%close_to(curve%slope(1.0_dp), 5/6.0_dp, 1e-15_dp, 'slope at a point')
    call check%close_to(curve%slope(3.0_dp), 0.0_dp, 1e-15_dp, 'slope at a maximum is 0')
    ! at the middle of the interval from 1 to 3: mean of the values plus an eighth of width times difference of the slopes
    call check%close_to(curve%value(2.0_dp), 1.5_dp + 2*(5/6.0_dp)/8, 1e-15_dp, 'value between two points')
    call check%close_to(curve%value(9.0_dp), 2.0_dp, 1e-15_dp, 'constant after the last point')
    call check%close_to(curve%value(-9.0_dp), 0.0_dp, 1e-15_dp, 'constant before the first point')
    do i = 1, 399
      x = 0.01_dp*i
      call check%that(curve%value(x) >= curve%value(x - 0.01_dp) - 1e-15_dp .and. curve%value(x) <= 2, 'monotone, no overshoot')
      if (modulo(i, 100) > 0) call check%close_to(curve%slope(x), (curve%value(x + 1e-6_dp) - curve%value(x - 1e-6_dp))/2e-6_dp, &
        1e-8_dp, 'slope is the derivative of the value')
    end do
    call check%close_to(curve%finest(), 1.0_dp, 0.0_dp, 'smallest distance of two points')
  end subroutine known_cubic

  !> A straight line is reproduced, with points at equal or unequal distances.
  subroutine straight_lines(check)
    class(checks_t), intent(inout) :: check
    type(monotone_cubic_t) :: curve
    real(dp) :: points(30)
    integer :: i
    points = [(1.7_dp**i, i=1, 30)]
    curve = new_monotone_cubic(points, 3 - 2*points)
    do i = 0, 1000
      associate (x => points(1) + (points(30) - points(1))*(i/1000.0_dp)**9)
        call check%relative(curve%value(x), 3 - 2*x, 1e-13_dp, 'a straight line')
      end associate
    end do
    curve = new_monotone_cubic([1.0_dp, 2.0_dp], [5.0_dp, 1.0_dp])
    call check%close_to(curve%value(1.25_dp), 4.0_dp, 1e-15_dp, 'two points are a straight line')
  end subroutine straight_lines

  !> Values and slopes are continuous across the end of the period, wherever the table begins, and the error decreases with the
  !> distance of the points.
  subroutine periodic_cubic(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: errors(2)
    type(monotone_cubic_t) :: curve
    real(dp), parameter :: begins = -1.3_dp
    integer :: i, k, m
    do k = 1, 2
      m = 100*k
      curve = new_periodic_cubic([(begins + two_pi*i/m, i=0, m - 1)], [(sin(begins + two_pi*i/m), i=0, m - 1)], two_pi)
      errors(k) = 0
      do i = 1, 5000
        errors(k) = max(errors(k), abs(curve%value(0.01_dp*i - 20) - sin(0.01_dp*i - 20)))
      end do
      call check%close_to(curve%value(begins - 1e-9_dp), curve%value(begins + 1e-9_dp), 1e-8_dp, 'no jump at the end of the period')
      call check%close_to(curve%slope(begins - 1e-9_dp), curve%slope(begins + 1e-9_dp), 1e-6_dp, 'no kink at the end of the period')
    end do
    call check%that(errors(1) < 1e-3_dp .and. errors(2) < errors(1)/3, 'error of a sine decreases with the number of points')
  end subroutine periodic_cubic

  !> The work of p = p0 + p1 sin q in a revolution is pi p1 V_d/2 exactly; that of a table of it is nearly the same.
  subroutine work_of_a_sine(check)
    class(checks_t), intent(inout) :: check
    type(measured_pressure_t) :: law
    type(working_gas_t) :: gas
    type(error_t), allocatable :: error
    real(dp) :: work, q
    integer :: i
    real(dp), parameter :: displacement = 2*0.05_dp*pi*0.08_dp**2/4
    integer, parameter :: steps = 72000
    law%bore = 0.08_dp
    law%period_deg = 360
    law%offset_deg = 30
    law%curve%x = [(0.5_dp*i, i=0, 719)]
    law%curve%y = 5e5_dp + 4e5_dp*sin((law%curve%x + 30)*degree)
    call law%prepare(linkage_t(0.05_dp, 0.2_dp), 1.0_dp, 1e-6_dp, gas, error)
    work = 0
    do i = 1, steps
      q = two_pi*(i - 0.5_dp)/steps
      work = work + gas%pressure(q)*gas%cylinder%volume_slope(q)*two_pi/steps
    end do
    call check%relative(work, pi*4e5_dp*displacement/2, 2e-6_dp, 'work of a table of a sine')
    call check%close_to(gas%cylinder%volume(0.0_dp), 0.0_dp, 1e-20_dp, 'the volume is the swept volume')
    q = 1.234_dp
    call check%relative(gas%force_slope(q), (gas%force(gas%pressure(q + 1e-6_dp)) - gas%force(gas%pressure(q - 1e-6_dp)))/2e-6_dp, &
      1e-6_dp, 'slope of the force')
  end subroutine work_of_a_sine
end module test_measured_curves
