!> Films with memory and supply against an independent program (data/film/engine) and published bearings.
module test_engine_films
  use kinds, only: dp
  use constants, only: pi, degree
  use error_handling, only: error_t
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use film_cells, only: supply_t, supply_grooves
  use film_history, only: film_history_t, film_duty_t
  use film_results, only: film_row_t, film_field_t
  use engine_bearings, only: read_table, word_length, words_of, result_names, results_of
  implicit none
  private
  public :: run_test_engine_films

contains

  subroutine run_test_engine_films(check)
    class(checks_t), intent(inout) :: check
    call given_orbits(check)
    call steady_groove_map(check)
    call lund_and_thomsen(check)
    call coefficients_of_lund_and_thomsen(check)
    call pfeil(check)
    call comsol(check)
  end subroutine run_test_engine_films

  !> The bearing of those cases with a groove at 90 degrees, along a given orbit: at rest in `steady_groove`, with a varying supply
  !> in `orbit_groove_feed`.
  subroutine give_orbit(name, history, duty)
    character(len=*), intent(in) :: name
    type(film_history_t), intent(out) :: history
    type(film_duty_t), intent(out) :: duty
    character(len=word_length), allocatable :: heads(:)
    real(dp), allocatable :: table(:, :)
    history%bearing = bearing_t(radius=0.02483_dp, clearance=30e-6_dp, length=0.03_dp)
    history%viscosity = 0.012_dp
    history%supply = supply_t(supply_grooves, [90.0_dp], 30.0_dp, 0.0225_dp)
    history%supply_pressure = 2e5_dp
    history%around = 192
    history%along = 16
    history%most_cycles = 1
    duty%time = [0.0_dp]
    duty%pin_speed = [300.0_dp]
    duty%eccentricity = reshape([18e-6_dp, 4.5e-6_dp], [2, 1])
    if (name == 'steady_groove') return
    call read_table(name//'.table.csv', heads, table)
    duty%time = table(:, 1)
    duty%pin_speed = table(:, 2)
    duty%eccentricity = transpose(table(:, 3:4))
    duty%supply_pressure = table(:, 5)
  end subroutine give_orbit

  !> A steady film on 192 by 16 cells, against values extrapolated from two finer grids; a cycle of 720 steps on 96 by 8 cells
  !> against one on 192 by 16, within the tolerances of the columns; the first rows of that on the same cells: equal but for the
  !> digits of the reference and the tolerance of a step.
  subroutine given_orbits(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: names(3) = [character(len=17) :: 'steady_groove', 'orbit_groove_feed', 'orbit_groove_feed']
    integer, parameter :: along(3) = [16, 8, 16], rows(3) = [1, 720, 20]
    type(film_history_t) :: history
    type(film_duty_t) :: duty
    type(error_t), allocatable :: error
    character(len=word_length), allocatable :: heads(:)
    real(dp), allocatable :: found(:, :), wanted(:, :)
    real(dp) :: value(size(result_names)), tolerance(size(result_names)), wrong
    integer :: i, k, n
    do i = 1, size(names)
      call give_orbit(trim(names(i)), history, duty)
      history%around = 12*along(i)
      history%along = along(i)
      n = min(size(duty%time), rows(i) + 1)
      duty%time = duty%time(:n)
      duty%pin_speed = duty%pin_speed(:n)
      duty%eccentricity = duty%eccentricity(:, :n)
      if (allocated(duty%supply_pressure)) duty%supply_pressure = duty%supply_pressure(:n)
      call history%march(duty, error)
      found = results_of(history%rows)
      call check%that(.not. allocated(error) .and. size(found, 1) == rows(i), 'rows of '//names(i))
      if (size(found, 1) /= rows(i)) cycle
      call check%that(history%summary%mass_residual < 1e-9_dp, 'mass of '//names(i))
      call read_table(trim(names(i))//'.film_history.csv', heads, wanted)
      wanted = wanted(:rows(i), :)
      call read_facts(trim(names(i)), value, tolerance)
      if (i == 1) wanted(1, :) = value
      if (i == 3) tolerance = 1e-7_dp
      do k = 2, size(result_names)
        wrong = sqrt(sum((found(:, k) - wanted(:, k))**2)/rows(i))
        if (i == 3) wrong = maxval(abs(found(:, k) - wanted(:, k)))
        call check%close_to(wrong/scale_of(wanted, k), 0.0_dp, tolerance(k), trim(names(i))//': '//result_names(k))
      end do
    end do
  end subroutine given_orbits

  !> Largest magnitude of a column; for eccentricities and forces that of the vector.
  pure real(dp) function scale_of(values, column) result(scale)
    real(dp), intent(in) :: values(:, :)
    integer, intent(in) :: column
    select case (column)
    case (2, 3)
      scale = sqrt(maxval(values(:, 2)**2 + values(:, 3)**2))
    case (4, 5)
      scale = sqrt(maxval(values(:, 4)**2 + values(:, 5)**2))
    case default
      scale = maxval(abs(values(:, column)))
    end select
  end function scale_of

  !> Values (0 for a series) and tolerances of a case.
  subroutine read_facts(name, value, tolerance)
    character(len=*), intent(in) :: name
    real(dp), intent(out) :: value(:), tolerance(:)
    character(len=200) :: line
    character(len=word_length) :: words(5)
    integer :: unit, status, k
    value = 0
    tolerance = 0
    open (newunit=unit, file='data/film/engine/facts.csv', status='old', action='read')
    read (unit, *)
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      words = words_of(line)
      if (words(1) /= name) cycle
      do k = 1, size(result_names)
        if (result_names(k) /= words(2)) cycle
        read (words(5), *) tolerance(k)
        if (words(3) /= 'rms') read (words(3), *) value(k)
      end do
    end do
    close (unit)
  end subroutine read_facts

  !> 48 steady films with one groove on 192 by 16 cells: forces along and across the line of centres, largest pressure, flow and
  !> fill. The reference is extrapolated to first order from these cells and from half their width, between which it changes by its
  !> last two columns: the error here is twice that.
  subroutine steady_groove_map(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: clearance = 20e-6_dp, radius = 0.01_dp, viscosity = 0.01_dp, speed = 100
    type(film_history_t) :: history
    type(film_duty_t) :: duty
    type(error_t), allocatable :: error
    character(len=word_length), allocatable :: heads(:)
    real(dp), allocatable :: map(:, :)
    real(dp) :: length, force_unit, pressure_unit, allowed
    integer :: i
    call read_table('steady_groove_map.csv', heads, map)
    duty%time = [0.0_dp]
    duty%pin_speed = [speed]
    history%viscosity = viscosity
    history%supply = supply_t(supply_grooves, [0.0_dp], 30.0_dp, 0.0_dp)
    history%around = 192
    history%along = 16
    do i = 1, size(map, 1)
      length = map(i, 1)*2*radius
      pressure_unit = viscosity*speed*(radius/clearance)**2
      force_unit = pressure_unit*length*radius
      history%bearing = bearing_t(radius=radius + clearance, clearance=clearance, length=length)
      history%supply%position_deg = [map(i, 3)]
      history%supply%length = 0.75_dp*length
      history%supply_pressure = map(i, 4)*pressure_unit
      duty%eccentricity = reshape([map(i, 2)*clearance, 0.0_dp], [2, 1])
      call history%march(duty, error)
      call check%that(.not. allocated(error), 'a film of the map is solved')
      if (allocated(error)) cycle
      associate (row => history%rows(1))
        allowed = (2.1_dp*map(i, 10) + 1e-3_dp)*norm2(map(i, 5:6))
        call check%close_to(row%force(1)/force_unit, map(i, 5), allowed, 'force along the line of centres')
        call check%close_to(row%force(2)/force_unit, map(i, 6), allowed, 'force across the line of centres')
        call check%relative(row%max_pressure/pressure_unit, map(i, 7), 3*map(i, 10) + 5e-3_dp, 'largest pressure with a groove')
        call check%relative(row%side_flow/(clearance*radius**2*speed), map(i, 8), 2.1_dp*map(i, 11) + 1e-3_dp, &
          'flow from a groove')
        call check%relative(row%fill, map(i, 9), 0.6_dp*map(i, 10) + 7e-3_dp, 'fill with a groove')
      end associate
    end do
  end subroutine steady_groove_map

  !> Lund and Thomsen (1978), two grooves of 20 degrees at right angles to the load, without pressure: S, eps and attitude [deg] of
  !> five bearings with L/D 0.5 and five with L/D 1; the load is given.
  subroutine lund_and_thomsen(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: printed(3, 10) = reshape([1.656_dp, 0.244_dp, 65.85_dp, 0.917_dp, 0.372_dp, 57.45_dp, &
      0.580_dp, 0.477_dp, 51.01_dp, 0.379_dp, 0.570_dp, 45.43_dp, 0.244_dp, 0.655_dp, 40.25_dp, &
      0.991_dp, 0.150_dp, 70.58_dp, 0.635_dp, 0.224_dp, 63.54_dp, 0.235_dp, 0.460_dp, 49.27_dp, &
      0.159_dp, 0.559_dp, 44.33_dp, 0.108_dp, 0.650_dp, 39.72_dp], [3, 10])
    type(film_row_t) :: row
    integer :: i
    do i = 1, size(printed, 2)
      call solve_pin(merge(0.5_dp, 1.0_dp, i <= 5), printed(1, i), row)
      call check%close_to(norm2(row%eccentricity)/100e-6_dp, printed(2, i), 3e-3_dp, 'eccentricity of Lund and Thomsen')
      call check%close_to(atan2(row%eccentricity(2), row%eccentricity(1))/degree, printed(3, i), 0.4_dp, &
        'attitude of Lund and Thomsen')
    end do
  end subroutine lund_and_thomsen

  !> A journal of 100 mm on 72 by 8 cells, loaded along x, for a Sommerfeld number S = mu N L D (R/c)^2/W. With an eccentricity [m]
  !> the load is what the film carries there.
  subroutine solve_pin(length_ratio, sommerfeld, row, eccentricity)
    real(dp), intent(in) :: length_ratio, sommerfeld
    type(film_row_t), intent(out) :: row
    real(dp), intent(in), optional :: eccentricity(2)
    type(film_history_t) :: history
    type(film_duty_t) :: duty
    type(error_t), allocatable :: error
    history%bearing = bearing_t(radius=0.0501_dp, clearance=100e-6_dp, length=length_ratio*0.1_dp)
    history%viscosity = 0.02_dp
    history%supply = supply_t(supply_grooves, [90.0_dp, 270.0_dp], 20.0_dp, history%bearing%length)
    history%around = 72
    duty%time = [0.0_dp]
    duty%pin_speed = [100*pi]
    if (present(eccentricity)) then
      duty%eccentricity = reshape(eccentricity, [2, 1])
    else
      duty%eccentricity = reshape([20e-6_dp, 20e-6_dp], [2, 1])
      duty%load = reshape([load_of(length_ratio, sommerfeld), 0.0_dp], [2, 1])
    end if
    call history%march(duty, error)
    if (.not. allocated(error)) row = history%rows(1)
  end subroutine solve_pin

  !> Load of that journal [N].
  pure real(dp) function load_of(length_ratio, sommerfeld)
    real(dp), intent(in) :: length_ratio, sommerfeld
    load_of = 0.02_dp*50*length_ratio*0.1_dp*0.1_dp*(0.05_dp/100e-6_dp)**2/sommerfeld
  end function load_of

  !> Stiffness of one of them over load and clearance (S = 0.235, L/D 1): K_xx 2.19, K_xy 3.57, K_yx -0.80, K_yy 1.55, by
  !> differences between steady films.
  subroutine coefficients_of_lund_and_thomsen(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: printed(2, 2) = reshape([2.19_dp, -0.80_dp, 3.57_dp, 1.55_dp], [2, 2])
    real(dp) :: step(2), stiffness(2, 2)
    type(film_row_t) :: middle, above, below
    integer :: i
    call solve_pin(1.0_dp, 0.235_dp, middle)
    do i = 1, 2
      step = 0
      step(i) = 1e-6_dp
      call solve_pin(1.0_dp, 0.235_dp, above, middle%eccentricity + step)
      call solve_pin(1.0_dp, 0.235_dp, below, middle%eccentricity - step)
      stiffness(:, i) = -(above%force - below%force)/2e-6_dp*100e-6_dp/load_of(1.0_dp, 0.235_dp)
    end do
    call check%close_to(maxval(abs(stiffness - printed)), 0.0_dp, 0.06_dp, 'stiffness of Lund and Thomsen')
  end subroutine coefficients_of_lund_and_thomsen

  !> Pfeil (2025), a groove of 15 degrees by 60 mm: integrals of p cos and p sin over the bearing, 1055.4 and -1383.3 N by his
  !> finite volumes, 1058.5 and -1388.9 by the independent program on 384 by 64 cells.
  subroutine pfeil(check)
    class(checks_t), intent(inout) :: check
    type(film_history_t) :: history
    type(film_duty_t) :: duty
    type(error_t), allocatable :: error
    history%bearing = bearing_t(radius=0.05015_dp, clearance=150e-6_dp, length=0.08_dp)
    history%viscosity = 0.01_dp
    history%supply = supply_t(supply_grooves, [90.0_dp], 15.0_dp, 0.06_dp)
    history%supply_pressure = 0.7e5_dp
    history%around = 192
    history%along = 32
    duty%time = [0.0_dp]
    duty%pin_speed = [100*pi]
    duty%eccentricity = reshape([75e-6_dp, 0.0_dp], [2, 1])
    call history%march(duty, error)
    call check%that(.not. allocated(error), 'the bearing of Pfeil is solved')
    if (allocated(error)) return
    associate (force => -history%rows(1)%force)
      call check%relative(force(1), 1055.4_dp, 5e-3_dp, 'force of Pfeil along the line of centres')
      call check%relative(force(2), -1383.3_dp, 5e-3_dp, 'force of Pfeil across the line of centres')
      call check%relative(force(1), 1058.5_dp, 3e-3_dp, 'force of the independent program along the line of centres')
      call check%relative(force(2), -1388.9_dp, 3e-3_dp, 'force of the independent program across the line of centres')
    end associate
  end subroutine pfeil

  !> The bearing of COMSOL's example at 10,000 rpm, rigid, with a viscosity that grows with the pressure: pressures in the middle
  !> plane read from its plot, 79 bar at 288 degrees, 18 at 320 and 40 at 240, within 5 % of the peak.
  subroutine comsol(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: plotted(2, 3) = reshape([288.0_dp, 79e5_dp, 320.0_dp, 18e5_dp, 240.0_dp, 40e5_dp], [2, 3])
    type(film_history_t) :: history
    type(film_duty_t) :: duty
    type(error_t), allocatable :: error
    real(dp) :: part
    integer :: i, below
    history%bearing = bearing_t(radius=0.1002_dp, clearance=200e-6_dp, length=0.067_dp)
    history%viscosity = 0.075_dp
    history%pressure_viscosity = 25e-9_dp
    history%supply = supply_t(supply_grooves, [0.0_dp, 180.0_dp], 10e-3_dp/0.1_dp/degree, 0.067_dp)
    history%supply_pressure = 2e5_dp
    history%around = 126   ! the edges of the grooves are next to faces
    history%field_times = [0.0_dp]
    duty%time = [0.0_dp]
    duty%pin_speed = [10000*pi/30]
    duty%eccentricity = reshape([0.0_dp, -50e-6_dp], [2, 1])
    duty%load = reshape([0.0_dp, -40e3_dp], [2, 1])
    call history%march(duty, error)
    call check%that(.not. allocated(error), 'the bearing of COMSOL is solved')
    if (allocated(error)) return
    associate (field => history%fields(1))
      do i = 1, size(plotted, 2)
        below = count(field%angle < plotted(1, i)*degree)
        part = (plotted(1, i)*degree - field%angle(below))/(field%angle(2) - field%angle(1))
        call check%close_to((1 - part)*field%pressure(1, below) + part*field%pressure(1, below + 1), plotted(2, i), 4e5_dp, &
          'pressures of COMSOL')
      end do
      call check%relative(maxval(field%pressure), 79e5_dp, 0.02_dp, 'largest pressure of COMSOL')
    end associate
  end subroutine comsol
end module test_engine_films
