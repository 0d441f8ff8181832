!> Runs a bearing case: the film with memory over the cycle of a table. Results are NAME.film_history.csv, one row for each interval
!> of the last cycle, NAME.summary.csv and NAME.resolved.nml.
module bearing_run
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_command_line
  use film_cells, only: film_cells_t, supply_grooves, supply_holes, supply_circumferential, new_film_cells
  use bearing_size, only: bearing_t
  use film_history, only: film_history_t, film_duty_t
  use ring_compliance, only: new_ring
  use bearing_definition, only: bearing_case_t
  use case_loader, only: load_model
  use case_schema, only: find_group
  use case_text, only: resolved_text
  use case_values, only: case_values_t
  use duty_file, only: read_duty
  use growing_text, only: growing_text_t
  use posix_files, only: absolute_path
  use number_text, only: real_text, short_text
  use result_file, only: write_text
  use text_tools, only: integer_text, path_beside, printable, quoted
  use value_reader, only: read_real
  implicit none
  private
  public :: bearing_run_t

  integer, parameter :: most_positions = 8
  real(dp), parameter :: least_cells_per_gap = 4       !! with fewer cells the thinnest part of the film is not resolved
  character(len=*), parameter :: newline = achar(10)

  type :: bearing_run_t
    character(len=:), allocatable :: line, notice      !! texts for the user: the outcome, and remarks
    character(len=:), allocatable, private :: file, base, resolved
    type(film_history_t), private :: history
    type(film_duty_t), private :: duty
    integer, private :: digits = 0
  contains
    procedure :: prepare
    procedure :: go
  end type bearing_run_t

contains

  !> Set what is marched from the values of a file, and read its table.
  subroutine prepare(self, values, path, base, error)
    class(bearing_run_t), intent(inout) :: self
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: path, base   !! of the case; of its results, without suffix
    type(error_t), allocatable, intent(out) :: error
    type(bearing_case_t) :: case
    type(film_cells_t) :: cells
    character(len=:), allocatable :: table
    integer :: place

    self%file = path
    self%base = base
    self%line = path//': correct'
    self%notice = ''
    call values%check()
    if (.not. values%problems%is_structural) then
      call values%problems%settle()
      call load(values, case)
      call check_case(values, case)
    end if
    call values%problems%report(error)
    if (allocated(error)) return
    table = path_beside(path, case%march%table)
    call read_duty(table, case%march%drive == 'load', self%duty, error)
    if (allocated(error)) then
      error%message = values%file//': &film_history table: '//error%message
      return
    end if
    if (absolute_path(table) == absolute_path(self%base//'.film_history.csv')) then
      call fail(error, values%file//': &film_history table: would be replaced by the results: give another folder with --out, '// &
        'or the table another name', status_command_line)
      return
    end if
    call check_orbit(values, case, self%duty)
    call values%problems%report(error)
    if (allocated(error)) return
    call set_history(case, self%history)
    call new_film_cells(self%history%bearing, self%history%supply, self%history%around, self%history%along, cells, error)
    if (allocated(error)) error%message = values%file//': &supply: '//error%message
    place = values%place_of('film_history', 'table')
    values%values(place)%text = absolute_path(table)
    self%resolved = resolved_text(values)
    self%digits = case%output%digits
  end subroutine prepare

  subroutine load(values, case)
    type(case_values_t), intent(inout) :: values
    type(bearing_case_t), intent(out) :: case
    call load_model(values, 'joint', case%joint)
    call load_model(values, 'lubrication', case%oil)
    call load_model(values, 'film_history', case%march)
    call load_model(values, 'output', case%output)
    if (values%is_present(find_group(values%groups, 'supply'))) then
      allocate (case%supply)
      call load_model(values, 'supply', case%supply)
    end if
    if (values%is_present(find_group(values%groups, 'bore'))) then
      allocate (case%bore)
      call load_model(values, 'bore', case%bore)
    end if
  end subroutine load

  !> Check that the values fit together.
  subroutine check_case(values, case)
    type(case_values_t), intent(inout) :: values
    type(bearing_case_t), intent(in) :: case
    real(dp), parameter :: thinnest_ring = 1.02_dp, most_thickening = 20
    real(dp), allocatable :: positions(:)
    call values%forbid(case%joint%bearing_radius <= case%joint%clearance, 'joint', 'bearing_radius', &
      'must be > clearance: the pin''s radius is the difference')
    call values%forbid(case%march%table == '', 'film_history', 'table', 'must be the name of a file')
    if (allocated(case%bore)) call values%forbid(case%bore%outer_radius <= thinnest_ring*case%joint%bearing_radius, 'bore', &
      'outer_radius', 'must be > 1.02 bearing_radius')
    if (.not. allocated(case%supply)) return
    associate (supply => case%supply)
      call values%forbid(case%oil%pressure_viscosity*(supply%pressure + case%oil%ambient_over_cavitation) >= most_thickening, &
        'supply', 'pressure', 'must be < 20/pressure_viscosity')
      select case (supply%kind)
      case ('grooves')
        call values%demand(supply%width_deg > 0, 'supply', 'width_deg', 'with kind = ''grooves''')
        call values%demand(supply%length > 0, 'supply', 'length', 'with kind = ''grooves''')
        call values%forbid(supply%length > case%joint%bearing_length, 'supply', 'length', 'must be <= bearing_length')
      case ('holes')
        call values%demand(supply%diameter > 0, 'supply', 'diameter', 'with kind = ''holes''')
      case default
        call values%demand(supply%groove_width > 0, 'supply', 'groove_width', 'with kind = ''circumferential_groove''')
        call values%forbid(supply%groove_width >= case%joint%bearing_length, 'supply', 'groove_width', &
          'must be < bearing_length')
        call values%forbid(supply%fixed_to == 'pin', 'supply', 'fixed_to', &
          'must be bearing with kind = ''circumferential_groove''')
        return
      end select
      call find_positions(supply%position_deg, positions)
      call values%forbid(size(positions) == 0, 'supply', 'position_deg', 'must be 1 to 8 angles')
    end associate
  end subroutine check_case

  !> Check that a given eccentricity leaves a gap in a rigid bore.
  subroutine check_orbit(values, case, duty)
    type(case_values_t), intent(inout) :: values
    type(bearing_case_t), intent(in) :: case
    type(film_duty_t), intent(in) :: duty
    integer :: i
    if (case%march%drive == 'load' .or. allocated(case%bore)) return
    do i = 1, size(duty%time)
      if (norm2(duty%eccentricity(:, i)) < case%joint%clearance) cycle
      call values%refuse('film_history', 'table', 'the eccentricity at '//short_text(duty%time(i))// &
        ' s must be < clearance with drive = ''orbit''')
      return
    end do
  end subroutine check_orbit

  !> The angles of a text; none if it is not a list of 1 to 8 numbers.
  subroutine find_positions(text, positions)
    character(len=*), intent(in) :: text
    real(dp), allocatable, intent(out) :: positions(:)
    real(dp) :: found(most_positions)
    character(len=:), allocatable :: wanted
    integer :: n, first, length
    n = 0
    first = 1
    allocate (positions(0))
    do while (first <= len(text) + 1)
      length = index(text(first:)//',', ',') - 1
      if (n == most_positions) return
      n = n + 1
      call read_real(trim(adjustl(text(first:first + length - 1))), found(n), wanted)
      if (allocated(wanted)) return
      first = first + length + 1
    end do
    positions = found(:n)
  end subroutine find_positions

  subroutine set_history(case, history)
    type(bearing_case_t), intent(in) :: case
    type(film_history_t), intent(inout) :: history
    history%bearing = bearing_t(radius=case%joint%bearing_radius, length=case%joint%bearing_length, clearance=case%joint%clearance)
    history%has_memory = case%oil%cavitation == 'mass_conserving'
    history%viscosity = case%oil%viscosity
    history%pressure_viscosity = case%oil%pressure_viscosity
    history%ambient_over_cavitation = case%oil%ambient_over_cavitation
    history%around = case%march%around
    history%along = case%march%along
    history%substeps = case%march%substeps
    history%most_cycles = case%march%most_cycles
    history%cycle_tolerance = case%march%cycle_tolerance
    if (allocated(case%bore)) history%bore = new_ring(case%joint%bearing_radius, case%bore%outer_radius, case%bore%youngs_modulus, &
      case%bore%poissons_ratio, case%bore%modes)
    if (.not. allocated(case%supply)) return
    history%supply_pressure = case%supply%pressure
    associate (supply => history%supply)
      select case (case%supply%kind)
      case ('grooves')
        supply%kind = supply_grooves
      case ('holes')
        supply%kind = supply_holes
      case default
        supply%kind = supply_circumferential
      end select
      call find_positions(case%supply%position_deg, supply%position_deg)
      supply%width_deg = case%supply%width_deg
      supply%length = case%supply%length
      supply%diameter = case%supply%diameter
      supply%groove_width = case%supply%groove_width
      supply%fixed_to_pin = case%supply%fixed_to == 'pin'
    end associate
  end subroutine set_history

  !> March, and write the results. The rows until an error are written too.
  subroutine go(self, error)
    class(bearing_run_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: file_error
    character(len=:), allocatable :: status
    call self%history%march(self%duty, error)
    status = 'done'
    if (allocated(error)) then
      status = error%message
      error%message = printable(self%file, 200)//': '//error%message
    end if
    call write_text(self%base//'.resolved.nml', self%resolved, file_error)
    if (.not. allocated(file_error)) call write_rows(self, file_error)
    if (.not. allocated(file_error)) call write_text(self%base//'.summary.csv', summary_of(self, status), file_error)
    if (allocated(file_error)) call move_alloc(file_error, error)
    if (allocated(error)) return
    associate (found => self%history%summary)
      self%line = self%file//': '//integer_text(found%cycles)//' cycles, thinnest film '// &
        short_text(1e6_dp*found%min_thickness)//' um, largest pressure '//short_text(1e-6_dp*found%max_pressure)//' MPa -> '// &
        self%base//'.film_history.csv'
      if (found%cycles == self%history%most_cycles .and. size(self%duty%time) > 1 .and. &
        found%content_change >= self%history%cycle_tolerance) self%notice = 'the oil still changes by '// &
        short_text(found%content_change)//' from cycle to cycle: raise &film_history most_cycles'
      if (found%cells_per_gap < least_cells_per_gap) self%notice = 'the thinnest part of the film has '// &
        short_text(found%cells_per_gap)//' cells, fewer than 4: raise &film_history around'
    end associate
    if (self%notice /= '') self%notice = printable(self%file, 200)//': '//self%notice
  end subroutine go

  subroutine write_rows(self, error)
    class(bearing_run_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error
    type(growing_text_t) :: file
    real(dp), allocatable :: numbers(:)
    integer :: i, k
    logical :: has_bore
    has_bore = self%history%bore%shapes() > 0
    call file%append('time[s],eccentricity_x[m],eccentricity_y[m],film_force_x[N],film_force_y[N],min_film_thickness[m],'// &
      'max_film_pressure[Pa],film_fill[-],supply_flow[m3/s],side_flow[m3/s],film_moment[N.m]')
    if (has_bore) call file%append(',bore_deflection[m]')
    call file%append(newline)
    do i = 1, size(self%history%rows)
      associate (row => self%history%rows(i))
        numbers = [row%time, row%eccentricity, row%force, row%min_thickness, row%max_pressure, row%fill, row%supply_flow, &
          row%side_flow, row%moment]
        if (has_bore) numbers = [numbers, row%bore_deflection]
      end associate
      call file%append(real_text(numbers(1), self%digits))
      do k = 2, size(numbers)
        call file%append(','//real_text(numbers(k), self%digits))
      end do
      call file%append(newline)
    end do
    call write_text(self%base//'.film_history.csv', file%text(:file%used), error)
  end subroutine write_rows

  !> The rows `quantity,value,unit`.
  function summary_of(self, status) result(text)
    class(bearing_run_t), intent(in) :: self
    character(len=*), intent(in) :: status
    character(len=:), allocatable :: text
    text = 'quantity,value,unit'//newline//'status,'//quoted(status, '"')//','//newline
    associate (found => self%history%summary)
      text = text//'film_history_cycles,'//integer_text(found%cycles)//',1'//newline
      if (size(self%history%rows) == 0) return
      call add('cycle_change', found%content_change, '1')
      call add('min_film_thickness', found%min_thickness, 'm')
      call add('max_film_pressure', found%max_pressure, 'Pa')
      call add('mean_supply_flow', found%mean_supply_flow, 'm3/s')
      call add('mean_side_flow', found%mean_side_flow, 'm3/s')
      call add('least_fill', found%least_fill, '1')
      call add('mean_power_loss', mean_loss(self), 'W')
      call add('mass_residual', found%mass_residual, '1')
      call add('cells_per_gap', found%cells_per_gap, '1')
    end associate

  contains

    subroutine add(name, value, unit)
      character(len=*), intent(in) :: name, unit
      real(dp), intent(in) :: value
      text = text//'film_history_'//name//','//real_text(value, self%digits)//','//unit//newline
    end subroutine add
  end function summary_of

  !> Mean of the power that the shear of the film takes from the pin, over the time of the last cycle [W].
  pure real(dp) function mean_loss(self)
    class(bearing_run_t), intent(in) :: self
    real(dp) :: taken
    integer :: i
    associate (rows => self%history%rows, duty => self%duty)
      if (size(duty%time) == 1) then
        mean_loss = -rows(1)%moment*duty%pin_speed(1)
        return
      end if
      taken = 0
      do i = 1, size(rows)
        taken = taken - rows(i)%moment*duty%pin_speed(i + 1)*(duty%time(i + 1) - duty%time(i))
      end do
      mean_loss = taken/(duty%time(size(rows) + 1) - duty%time(1))
    end associate
  end function mean_loss
end module bearing_run
