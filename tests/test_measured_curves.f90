!> Measured curves: the cubic polynomials through their points, valid and invalid files, and a run with a measured pressure.
module test_measured_curves
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use error_handling, only: error_t
  use monotone_cubic, only: monotone_cubic_t, new_monotone_cubic, new_periodic_cubic
  use curve_file, only: parse_curve, crank_angle, pressure, turning_speed, torque
  use case_curves, only: period_fault
  use measured_pressure, only: measured_pressure_t
  use working_gas, only: working_gas_t
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, values_of
  implicit none
  private
  public :: run_test_measured_curves

  character(len=*), parameter :: n = achar(10), head = 'crank_angle[deg],pressure[bar]'//n
  integer, parameter :: long = 60

contains

  subroutine run_test_measured_curves(check)
    class(checks_t), intent(inout) :: check
    call known_cubic(check)
    call straight_lines(check)
    call periodic_cubic(check)
    call good_files(check)
    call bad_files(check)
    call bad_periods(check)
    call work_of_a_sine(check)
    call table_of_a_cycle(check)
  end subroutine run_test_measured_curves

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

  subroutine good_files(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: return = achar(13)
    real(dp), allocatable :: x(:), y(:)
    integer, allocatable :: lines(:)
    character(len=:), allocatable :: message
    integer :: line
    call parse_curve('# measured'//n//n//'"Crank angle [rad]" , "p [kPa]"'//return//n//' 0, 100'//return//n//n//'1,2e2', &
      crank_angle, pressure, x, y, lines, message, line)
    call check%equal_text(message, '', 'comments, empty lines, quotes, blanks and other ends of lines')
    call check%that(size(x) == 2 .and. all(lines == [4, 6]), 'line numbers of the rows')
    call check%relative(x(2), 180/pi, 1e-15_dp, 'an angle in radians')
    call check%relative(y(2), 2e5_dp, 1e-15_dp, 'a pressure in kilopascals')
    call parse_curve('a[deg],b[psi]'//n//'0,1'//n//'1,1', crank_angle, pressure, x, y, lines, message, line)
    call check%relative(y(1), 0.45359237_dp*9.80665_dp/0.0254_dp**2, 1e-14_dp, 'a pound of force on a square inch')
    call parse_curve('theta [°CA],p [bar]'//n//'0,1'//n//'1,1', crank_angle, pressure, x, y, lines, message, line)
    call check%that(message == '' .and. abs(x(2) - 1) <= 0, 'degrees of crank angle with the degree sign')
    call parse_curve('n[r/min],M[kN·m]'//n//'0,1'//n//'60,2', turning_speed, torque, x, y, lines, message, line)
    call check%that(message == '', 'revolutions in a minute, kilonewton times metre: '//message)
    call check%relative(x(2), 2*pi, 1e-14_dp, 'revolutions in a minute')
    call check%relative(y(2), 2000.0_dp, 1e-14_dp, 'kilonewton times metre')
  end subroutine good_files

  subroutine bad_files(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: units = 'the header must name this column with its unit, the '
    call refused('', 1, 'needs a header and at least two rows')
    call refused(head//'1,2'//n, 2, 'needs a header and at least two rows')
    call refused('0,1'//n//'1,2'//n, 1, '0: '//units//'crank angle in one of deg, degrees, degCA, rad, as in crank_angle[deg]')
    call refused('crank_angle[deg],pressure[atm]'//n, 1, 'pressure[atm]: '//units// &
      'pressure in one of Pa, hPa, kPa, MPa, GPa, mbar, bar, psi, as in pressure[Pa]')
    call refused('crank_angle[deg];pressure[bar]'//n, 1, 'crank_angle[deg];pressure[bar]: needs two columns '// &
      'separated by a comma')
    call refused(head//'0,1,5', 2, '0,1,5: needs two columns separated by a comma')
    call refused(head//'0,1'//n//'1,nan', 3, 'pressure = nan: must be a finite number')
    call refused(head//'0,1'//n//'inf,1', 3, 'crank angle = inf: must be a finite number')
    call refused(head//'0,1'//n//'1,', 3, 'pressure is missing')
    call refused(head//'0,1'//n//',1', 3, 'crank angle is missing')
    call refused(head//'0,1'//n//'1,2 bar', 3, 'pressure = 2 bar: must be a number')
    call refused(head//'0,1'//n//'1,2'//n//'1,3', 4, 'crank angle = 1: already given in line 3')
    call refused(head//'0,1'//n//'2,2'//n//n//'1,3', 5, 'crank angle = 1: must be larger than that of line 3: rows must be in '// &
      'increasing order')

  contains

    subroutine refused(text, at, wanted)
      character(len=*), intent(in) :: text, wanted
      integer, intent(in) :: at
      real(dp), allocatable :: x(:), y(:)
      integer, allocatable :: lines(:)
      character(len=:), allocatable :: message
      integer :: line
      call parse_curve(text, crank_angle, pressure, x, y, lines, message, line)
      call check%equal_text(message, wanted, 'a file that is refused')
      call check%that(line == at, 'in line '//achar(48 + at))
    end subroutine refused
  end subroutine bad_files

  !> Angles that do not cover a period: too short, too long, with gaps, with another pressure at the end.
  subroutine bad_periods(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: even(72)
    integer :: i
    even = [(5.0_dp*i, i=0, 71)]
    call expect(even, 360, '', 72, 'a period')
    call expect([even, 360.0_dp], 360, '', 72, 'a table with its first row repeated at the end')
    call expect(even - 180, 360, '', 72, 'a table that begins at another angle')
    call expect(even, 720, 'no row from 355 to 720 degrees: the table must cover the period of 720 without gaps of more than 30', &
      72, 'half a period')
    call expect([even, 365.0_dp], 360, 'the table spans 365 degrees, more than its period of 360', 73, 'more than a period')
    call expect([even(:30), even(36:)], 360, 'rows are missing from 145 to 175 degrees, more than 4 times as far as those on '// &
      'both sides', 30, 'a gap')
    call expect([even(:30), even(37:)], 360, 'no row from 145 to 180 degrees: the table must cover the period of 360 without '// &
      'gaps of more than 30', 30, 'a wider gap')
    call expect(even(:70), 360, '', 70, 'two rows missing at the end')

  contains

    subroutine expect(angle, period, wanted, at, name)
      real(dp), intent(in) :: angle(:)
      integer, intent(in) :: period, at
      character(len=*), intent(in) :: wanted, name
      character(len=:), allocatable :: message
      integer :: found
      call period_fault(angle, 1 + 0*angle, period, message, found)
      call check%equal_text(message, wanted, name)
      call check%that(wanted == '' .or. found == at, name//': line number')
    end subroutine expect
  end subroutine bad_periods

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
    call law%prepare(0.05_dp, 0.2_dp, 1e-6_dp, gas, error)
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

  !> A table of simulation IV's cycle, with a point at each degree, drives the ideal twin in the same way as the cycle itself.
  subroutine table_of_a_cycle(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: measured, computed
    real(dp), allocatable :: speed(:), other(:)
    character(len=long), parameter :: settings(2) = [character(len=long) :: 'integrator.revolutions=4', &
      'integrator.relative_tolerance=1e-9']
    measured = run_case('cases/gas/measured.nml', settings, .true.)
    computed = run_case('cases/sim_IV.nml', settings, .true.)
    call check%equal_text(measured%report%status, 'done', 'a run with a measured pressure')
    if (allocated(measured%error) .or. allocated(computed%error)) return
    speed = values_of(measured, 'crank_speed[rad/s]')
    other = values_of(computed, 'crank_speed[rad/s]')
    call check%that(maxval(abs(speed/other - 1)) < 2e-6_dp, 'crank speed with a measured pressure')
    call check%that(measured%report%figures%max_energy_residual < 1e-8_dp*measured%report%figures%max_energy, &
      'a run with a measured pressure: energy residual')
    measured = run_case('cases/gas/measured.nml', [character(len=long) :: 'cylinder_pressure.table_digest=0123456789ABCDEF'])
    call check%that(allocated(measured%error), 'a table of another quantity is refused')
    measured = run_case('cases/gas/measured.nml', [character(len=long) :: 'cylinder_pressure.period_deg=500'])
    call check%that(allocated(measured%error), 'a period of the wrong length is refused')
  end subroutine table_of_a_cycle
end module test_measured_curves
