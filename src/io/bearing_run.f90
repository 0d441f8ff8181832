!> Runs a bearing case: the film with memory over the cycle of a table. Results are NAME.film_history.csv, one row for each interval
!> of the last cycle, NAME.summary.csv and NAME.resolved.nml.
module bearing_run
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_command_line
  use film_cells, only: film_cells_t, new_film_cells
  use bearing_size, only: bearing_t
  use film_history, only: film_history_t, film_duty_t
  use bearing_definition, only: bearing_case_t
  use case_curves, only: provide_history
  use case_loader, only: load_model
  use case_schema, only: find_group
  use case_text, only: resolved_text
  use case_values, only: case_values_t
  use duty_file, only: read_duty
  use film_files, only: progress_watch_t
  use history_files, only: write_history, add_history
  use history_rules, only: check_history, check_shape, read_positions
  use posix_files, only: absolute_path
  use number_text, only: short_text
  use result_file, only: write_text
  use result_notes, only: history_remarks
  use result_table, only: result_table_t
  use text_tools, only: integer_text, path_beside, printable, replaced
  use value_reader, only: read_times
  implicit none
  private
  public :: bearing_run_t

  character(len=*), parameter :: newline = achar(10)

  type :: bearing_run_t
    character(len=:), allocatable :: line, notice      !! texts for the user: the outcome, and remarks
    character(len=:), allocatable :: resolved          !! the case with all keys
    character(len=:), allocatable, private :: file, base
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

    self%file = printable(path, 200)
    self%base = base
    self%line = self%file//': correct'
    self%notice = ''
    call values%check()
    if (.not. values%problems%is_structural) then
      call values%problems%settle()
      call load(values, case)
      call provide_history(values, path, case%history, 'supply', 'bore', 'shape', 'piston_pin')
      call check_case(values, case)
    end if
    call values%problems%report(error)
    if (allocated(error)) return
    table = path_beside(path, case%history%march%table)
    call read_duty(table, case%history%march%drive == 'load', self%duty, error)
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
    call case%history%make(bearing_t(radius=case%joint%bearing_radius, length=case%joint%bearing_length, &
      clearance=case%joint%clearance), case%oil%viscosity, case%oil%pressure_viscosity, case%oil%ambient_over_cavitation, &
      case%oil%cavitation == 'mass_conserving', self%history)
    if (allocated(case%output%snapshot_times)) self%history%field_times = case%output%snapshot_times
    call new_film_cells(self%history%bearing, self%history%supply, self%history%around, self%history%along, cells, error, &
      self%history%shape)
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
    call load_model(values, 'output', case%output)
    associate (history => case%history)
      allocate (history%march)
      call load_model(values, 'film_history', history%march)
      if (values%is_present(find_group(values%groups, 'supply'))) then
        allocate (history%supply)
        call load_model(values, 'supply', history%supply)
      end if
      if (values%is_present(find_group(values%groups, 'bore'))) then
        allocate (history%bore)
        call load_model(values, 'bore', history%bore)
      end if
      if (values%is_present(find_group(values%groups, 'shape'))) then
        allocate (history%shape)
        call load_model(values, 'shape', history%shape)
      end if
      call read_positions(history)
    end associate
    call read_times(case%output%film_times, case%output%snapshot_times)
  end subroutine load

  !> Check that the values fit together.
  subroutine check_case(values, case)
    type(case_values_t), intent(inout) :: values
    type(bearing_case_t), intent(in) :: case
    call values%forbid(case%joint%bearing_radius <= case%joint%clearance, 'joint', 'bearing_radius', &
      'must be > clearance: the pin''s radius is the difference')
    call values%demand(case%history%march%table /= '', 'film_history', 'table', 'without &mechanism')
    call values%forbid(case%output%film_times /= '' .and. .not. allocated(case%output%snapshot_times), 'output', 'film_times', &
      'must be times >= 0 in rising order with commas, or from:to:count')
    call check_history(values, case%history, case%joint%bearing_radius, case%joint%bearing_length, case%oil%pressure_viscosity, &
      case%oil%ambient_over_cavitation, 'supply', 'bore')
    if (allocated(case%history%shape)) call check_shape(values, case%history, case%joint%clearance, case%joint%bearing_radius, &
      case%joint%bearing_length, 'shape')
    if (.not. allocated(case%history%supply)) return
    call values%forbid(case%history%supply%feed%is_wanted(), 'supply', 'pressure_table', &
      'is for a run of a mechanism: here it is the column supply_pressure[Pa] of the table')
  end subroutine check_case

  !> Check that a given eccentricity leaves a gap in a rigid bore.
  subroutine check_orbit(values, case, duty)
    type(case_values_t), intent(inout) :: values
    type(bearing_case_t), intent(in) :: case
    type(film_duty_t), intent(in) :: duty
    integer :: i
    if (case%history%march%drive == 'load' .or. allocated(case%history%bore)) return
    do i = 1, size(duty%time)
      if (norm2(duty%eccentricity(:, i)) < case%joint%clearance) cycle
      call values%refuse('film_history', 'table', 'the eccentricity at '//short_text(duty%time(i))// &
        ' s must be < clearance with drive = ''orbit''')
      return
    end do
  end subroutine check_orbit

  !> March, and write the results. The rows until an error are written too.
  subroutine go(self, error)
    class(bearing_run_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: file_error
    character(len=:), allocatable :: status
    type(progress_watch_t) :: watch
    call self%history%march(self%duty, error, watch)
    status = 'done'
    if (allocated(error)) then
      status = error%message
      error%message = self%file//': '//error%message
    end if
    call write_text(self%base//'.resolved.nml', self%resolved, file_error)
    if (.not. allocated(file_error)) call write_history(self%base, self%history, self%digits, file_error)
    if (.not. allocated(file_error)) call write_text(self%base//'.summary.csv', summary_of(self, status), file_error)
    if (allocated(file_error)) call move_alloc(file_error, error)
    if (allocated(error)) return
    associate (found => self%history%summary)
      self%line = self%file//': '//integer_text(found%cycles)//' cycles, thinnest film '// &
        short_text(1e6_dp*found%min_thickness)//' um, largest pressure '//short_text(1e-6_dp*found%max_pressure)//' MPa -> '// &
        printable(self%base, 1000)//'.film_history.csv'
    end associate
    self%notice = history_remarks(self%history, size(self%duty%time) > 1)
    if (self%notice /= '') self%notice = self%file//': '//replaced(self%notice, newline, &
      newline//self%file//': ')
  end subroutine go

  !> The rows `quantity,value,unit`.
  function summary_of(self, status) result(text)
    class(bearing_run_t), intent(in) :: self
    character(len=*), intent(in) :: status
    character(len=:), allocatable :: text
    type(result_table_t) :: table
    table%digits = self%digits
    call table%clear()
    call table%append('quantity,value,unit'//achar(10))
    call table%add('status', status)
    call table%add_notes(history_remarks(self%history, size(self%duty%time) > 1))
    call add_history(table, self%history, self%duty, '')
    text = table%text(:table%used)
  end function summary_of
end module bearing_run
