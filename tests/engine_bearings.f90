!> The bearings of data/film/engine: cases in the syntax of the program, what they are given, and tables of results.
module engine_bearings
  use kinds, only: dp
  use bearing_size, only: bearing_t
  use film_cells, only: supply_none, supply_grooves, supply_circumferential
  use film_history, only: film_history_t, film_duty_t
  use film_results, only: film_row_t
  use ring_compliance, only: new_ring
  implicit none
  private
  public :: word_length, read_bearing, read_duty, read_table, words_of, result_names, results_of

  integer, parameter :: word_length = 40

  character(len=*), parameter :: folder = 'data/film/engine/'

  !> The columns of results that all bearings have.
  character(len=word_length), parameter :: result_names(11) = [character(len=word_length) :: 'time[s]', &
    'eccentricity_x[m]', 'eccentricity_y[m]', &
    'film_force_x[N]', 'film_force_y[N]', 'min_film_thickness[m]', 'max_film_pressure[Pa]', 'film_fill[-]', 'supply_flow[m3/s]', &
    'side_flow[m3/s]', 'film_moment[N.m]']

contains

  !> The bearing of NAME.nml.
  subroutine read_bearing(name, history)
    character(len=*), intent(in) :: name
    type(film_history_t), intent(out) :: history
    character(len=60) :: kind, law, cavitation, fixed_to, drive, table
    real(dp) :: clearance, bearing_radius, bearing_length, viscosity, pressure_viscosity, pressure, position_deg(8), width_deg, &
      length, groove_width, outer_radius, youngs_modulus, poissons_ratio
    integer :: unit, status, modes, around, along, most_cycles
    namelist /joint/ kind, clearance, bearing_radius, bearing_length
    namelist /lubrication/ law, cavitation, viscosity, pressure_viscosity
    namelist /supply/ kind, pressure, position_deg, width_deg, length, fixed_to, groove_width
    namelist /bore/ outer_radius, youngs_modulus, poissons_ratio, modes
    namelist /film_history/ drive, table, around, along, most_cycles

    open (newunit=unit, file=folder//name//'.nml', status='old', action='read')
    read (unit, joint)
    history%bearing = bearing_t(radius=bearing_radius, clearance=clearance, length=bearing_length)
    rewind (unit)
    pressure_viscosity = 0
    read (unit, lubrication)
    history%viscosity = viscosity
    history%pressure_viscosity = pressure_viscosity
    rewind (unit)
    position_deg = huge(1.0_dp)
    width_deg = 0
    length = 0
    groove_width = 0
    read (unit, supply)
    history%supply%kind = merge(supply_circumferential, supply_grooves, kind == 'circumferential_groove')
    history%supply%position_deg = pack(position_deg, position_deg < huge(1.0_dp))
    history%supply%width_deg = width_deg
    history%supply%length = length
    history%supply%groove_width = groove_width
    history%supply_pressure = pressure
    rewind (unit)
    read (unit, bore, iostat=status)
    if (status == 0) history%bore = new_ring(bearing_radius, outer_radius, youngs_modulus, poissons_ratio, modes)
    rewind (unit)
    read (unit, film_history)
    history%around = around
    history%along = along
    history%most_cycles = most_cycles
    close (unit)
  end subroutine read_bearing

  !> What NAME.table.csv gives.
  subroutine read_duty(name, duty)
    character(len=*), intent(in) :: name
    type(film_duty_t), intent(out) :: duty
    character(len=word_length), allocatable :: heads(:)
    real(dp), allocatable :: values(:, :)
    call read_table(name//'.table.csv', heads, values)
    duty%time = values(:, 1)
    duty%pin_speed = values(:, 2)
    duty%eccentricity = transpose(values(:, 3:4))
    if (size(heads) < 5) return
    if (heads(5) == 'load_x[N]') duty%load = transpose(values(:, 5:6))
    if (heads(5) == 'supply_pressure[Pa]') duty%supply_pressure = values(:, 5)
  end subroutine read_duty

  !> A table of numbers (rows, columns) and its heads.
  subroutine read_table(file, heads, values)
    character(len=*), intent(in) :: file
    character(len=word_length), allocatable, intent(out) :: heads(:)
    real(dp), allocatable, intent(out) :: values(:, :)
    character(len=400) :: line
    integer :: unit, status, rows, i
    open (newunit=unit, file=folder//file, status='old', action='read')
    read (unit, '(a)') line
    heads = words_of(line)
    rows = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      rows = rows + 1
    end do
    allocate (values(rows, size(heads)))
    rewind (unit)
    read (unit, '(a)') line
    do i = 1, rows
      read (unit, *) values(i, :)
    end do
    close (unit)
  end subroutine read_table

  !> The texts between the commas of a line. (To read them as a list would end at the slash of a unit.)
  pure function words_of(line) result(words)
    character(len=*), intent(in) :: line
    character(len=word_length), allocatable :: words(:)
    integer :: first, last, k
    allocate (words(count(transfer(line, ['a'], len(line)) == ',') + 1))
    first = 1
    do k = 1, size(words)
      last = first + index(line(first:)//',', ',') - 2
      words(k) = line(first:last)
      first = last + 2
    end do
  end function words_of

  !> The columns of results of rows, as in `result_names`.
  pure function results_of(rows) result(values)
    type(film_row_t), intent(in) :: rows(:)
    real(dp) :: values(size(rows), size(result_names))
    integer :: i
    do i = 1, size(rows)
      associate (row => rows(i))
        values(i, :) = [row%time, row%eccentricity, row%force, row%min_thickness, row%max_pressure, row%fill, row%supply_flow, &
          row%side_flow, row%moment]
      end associate
    end do
  end function results_of
end module engine_bearings
