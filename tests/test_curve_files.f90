!> Files of measured curves: valid and invalid ones, and a run with a measured pressure.
module test_curve_files
  use kinds, only: dp
  use constants, only: pi
  use curve_file, only: parse_curve, crank_angle, pressure, turning_speed, torque
  use case_curves, only: period_fault
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, values_of
  implicit none
  private
  public :: run_test_curve_files

  character(len=*), parameter :: n = achar(10), head = 'crank_angle[deg],pressure[bar]'//n
  integer, parameter :: long = 60

contains

  subroutine run_test_curve_files(check)
    class(checks_t), intent(inout) :: check
    call good_files(check)
    call bad_files(check)
    call bad_periods(check)
    call table_of_a_cycle(check)
  end subroutine run_test_curve_files

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
    call parse_curve('theta [deg CA],p [atm]'//n//'0,1e-40'//n//'1,-2.5e-124', crank_angle, pressure, x, y, lines, message, line)
    call check%equal_text(message, '', 'numbers as small as rounding leaves them')
    call check%relative(y(1), 101325e-40_dp, 1e-14_dp, 'an atmosphere times 1e-40')
    call check%relative(y(2), -253312.5e-124_dp, 1e-14_dp, 'an atmosphere times -2.5e-124')
  end subroutine good_files

  subroutine bad_files(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: units = 'the header must name this column with its unit, the '
    call refused('', 1, 'needs a header and at least two rows')
    call refused(head//'1,2'//n, 2, 'needs a header and at least two rows')
    call refused('0,1'//n//'1,2'//n, 1, '0: '//units//'crank angle in one of deg, degrees, degCA, rad, as in crank_angle[deg]')
    call refused('crank_angle[deg],pressure[torr]'//n, 1, 'pressure[torr]: '//units// &
      'pressure in one of Pa, hPa, kPa, MPa, GPa, mbar, bar, atm, psi, as in pressure[Pa]')
    call refused('crank_angle[deg];pressure[bar]'//n, 1, 'crank_angle[deg];pressure[bar]: needs two columns '// &
      'separated by a comma')
    call refused(head//'0,1,5', 2, '0,1,5: needs two columns separated by a comma')
    call refused(head//'0,1'//n//'1,nan', 3, 'pressure = nan: must be a finite number')
    call refused(head//'0,1'//n//'inf,1', 3, 'crank angle = inf: must be a finite number')
    call refused(head//'0,1'//n//'1,1e31', 3, 'pressure = 1e31: must be 0 or of a size from 1e-30 to 1e30')
    call refused(head//'0,1'//n//'1e-31,1', 3, 'crank angle = 1e-31: must be 0 or of a size from 1e-30 to 1e30')
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
end module test_curve_files
