!> Reads the table of a bearing case: a header of columns, and a row of numbers for each time.
module duty_file
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use film_history, only: film_duty_t
  use text_file, only: read_text_file
  use text_tools, only: printable, integer_text, next_row, joined
  use value_reader, only: read_real
  implicit none
  private
  public :: read_duty

  integer, parameter :: largest_file = 100   !! MB
  integer, parameter :: name_length = 24, most_columns = 7
  character(len=name_length), parameter :: names(most_columns) = [character(len=name_length) :: 'time[s]', 'pin_speed[rad/s]', &
    'eccentricity_x[m]', 'eccentricity_y[m]', 'load_x[N]', 'load_y[N]', 'supply_pressure[Pa]']
  integer, parameter :: of_load = 5, of_supply = 7

contains

  !> Read a table. Its columns are `names`, in any order: those of the load with `needs_load`, and that of the supply if it varies.
  !> Errors name the line.
  subroutine read_duty(path, needs_load, duty, error)
    character(len=*), intent(in) :: path
    logical, intent(in) :: needs_load
    type(film_duty_t), intent(out) :: duty
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text, row, message
    real(dp), allocatable :: values(:, :)
    integer :: column_of(most_columns), columns, line, at, n, i

    call read_text_file(path, largest_file, 'table', text, error)
    if (allocated(error)) return
    allocate (values(most_columns, count([(text(i:i) == achar(10), i=1, len(text))]) + 1), source=0.0_dp)
    message = ''
    columns = 0
    line = 0
    n = 0
    at = 1
    do while (message == '')
      call next_row(text, at, line, row)
      if (row == '') exit
      if (columns == 0) then
        call read_header(row, needs_load, column_of, columns, message)
      else
        n = n + 1
        call read_row(row, column_of, columns, values(:, n), message)
        if (message == '' .and. n > 1) then
          if (.not. values(1, n) > values(1, n - 1)) message = 'time = '//printable(row(:index(row//',', ',') - 1), 40)// &
            ': times must increase'
        end if
        if (message == '' .and. values(of_supply, n) < 0) message = 'supply_pressure must be >= 0'
      end if
    end do
    if (message == '' .and. n == 0) message = 'needs a header and at least one row'
    if (message /= '') then
      call fail(error, printable(path, 200)//':'//integer_text(max(1, line))//': '//message, status_case_file)
      return
    end if
    duty%time = values(1, :n)
    duty%pin_speed = values(2, :n)
    duty%eccentricity = values(3:4, :n)
    if (needs_load) duty%load = values(of_load:of_load + 1, :n)
    if (column_of(of_supply) > 0) duty%supply_pressure = values(of_supply, :n)
  end subroutine read_duty

  !> Find the columns by their names.
  subroutine read_header(row, needs_load, column_of, columns, message)
    character(len=*), intent(in) :: row
    logical, intent(in) :: needs_load
    integer, intent(out) :: column_of(:)   !! 0: there is no such column
    integer, intent(out) :: columns
    character(len=:), allocatable, intent(inout) :: message
    character(len=:), allocatable :: field
    integer :: first, k
    column_of = 0
    columns = 0
    first = 1
    do while (first <= len(row) + 1)
      call next_field(row, first, field)
      columns = columns + 1
      k = findloc(names == field, .true., 1)
      if (k == 0) then
        message = printable(field, 40)//': no column of this table; columns are '//joined(names)
      else if (column_of(k) > 0) then
        message = printable(field, 40)//': this column is given twice'
      end if
      if (message /= '') return
      column_of(k) = columns
    end do
    do k = 1, merge(of_load + 1, of_load - 1, needs_load)
      if (column_of(k) == 0 .and. message == '') message = 'the column '//trim(names(k))//' is missing'
    end do
  end subroutine read_header

  subroutine read_row(row, column_of, columns, values, message)
    character(len=*), intent(in) :: row
    integer, intent(in) :: column_of(:), columns
    real(dp), intent(inout) :: values(:)
    character(len=:), allocatable, intent(inout) :: message
    character(len=:), allocatable :: field, wanted
    integer :: first, column, k
    first = 1
    column = 0
    do while (first <= len(row) + 1)
      call next_field(row, first, field)
      column = column + 1
      k = findloc(column_of, column, 1)
      if (k == 0) exit
      call read_real(field, values(k), wanted, may_be_tiny=k > 1)   ! but not the times
      if (allocated(wanted)) then
        message = trim(names(k))//' = '//printable(field, 40)//': '//wanted
        return
      end if
    end do
    if (column /= columns) message = 'needs '//integer_text(columns)//' numbers separated by commas'
  end subroutine read_row

  !> The field from `first` on to the next comma; `first` is moved behind that.
  pure subroutine next_field(row, first, field)
    character(len=*), intent(in) :: row
    integer, intent(inout) :: first
    character(len=:), allocatable, intent(out) :: field
    integer :: length
    length = index(row(first:)//',', ',') - 1
    field = trim(adjustl(row(first:first + length - 1)))
    first = first + length + 1
  end subroutine next_field
end module duty_file
