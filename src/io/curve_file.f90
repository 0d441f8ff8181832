!> Reads measured curves from CSV files: a header that names two columns with their units, such as crank_angle[deg],pressure[bar],
!> and a row of two numbers for each point; curves of vectors have three. Empty lines and lines that begin with # are ignored.
module curve_file
  use kinds, only: dp
  use text_tools, only: printable, integer_text, replaced, next_row
  use physical_units, only: find_head_unit, head_units
  use value_reader, only: read_real
  implicit none
  private
  public :: parse_curve, quantity_t, crank_angle, pressure, turning_speed, torque, load, height, relief, &
    place_angle, deviation

  integer, parameter :: most_rows = 1000000

  !> A quantity that a column may contain.
  type :: quantity_t
    character(len=12) :: name = ''
    character(len=8) :: unit = ''     !! of the values that are read
    character(len=8) :: shown = ''    !! the same in the head of a table
    logical :: may_be_tiny = .true.   !! smaller than 1e-30; the first columns may not, since rows must not be that close
  end type quantity_t

  type(quantity_t), parameter :: crank_angle = quantity_t('crank angle', 'degrees', 'deg', .false.), &
    pressure = quantity_t('pressure', 'Pa', 'Pa'), turning_speed = quantity_t('speed', 'rad/s', 'rad/s', .false.), &
    torque = quantity_t('torque', 'N m', 'N.m'), load = quantity_t('load', 'N', 'N'), &
    height = quantity_t('height', 'm', 'm', .false.), relief = quantity_t('relief', 'm', 'm'), &
    place_angle = quantity_t('angle', 'degrees', 'deg', .false.), deviation = quantity_t('deviation', 'm', 'm')

contains

  !> Read the two columns of a text, converted to the units of their quantities; x increases, and there are at least two rows.
  !> If the text is not such a table, `message` says what is required and `line` where; otherwise the message is empty. `lines` are
  !> the line numbers of the rows. With `z` the text may have three columns, the last two of which are the components of a vector,
  !> NAME_x and NAME_y; of a text with two columns z is 0.
  subroutine parse_curve(text, x_is, y_is, x, y, lines, message, line, z)
    character(len=*), intent(in) :: text
    type(quantity_t), intent(in) :: x_is, y_is
    real(dp), allocatable, intent(out) :: x(:), y(:)
    integer, allocatable, intent(out) :: lines(:)
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: line
    real(dp), allocatable, intent(out), optional :: z(:)
    real(dp) :: factors(3), values(3)
    real(dp), allocatable :: second(:)
    character(len=:), allocatable :: row
    type(quantity_t) :: is(3)
    integer :: at, n, columns
    logical :: has_header

    message = ''
    line = 0
    at = 1
    n = min(most_rows, 1 + count([(text(n:n) == achar(10), n=1, len(text))]))
    allocate (x(n), y(n), second(n), lines(n))
    is = [x_is, y_is, y_is]
    columns = 2
    n = 0
    has_header = .false.
    do while (message == '')
      call next_row(text, at, line, row)
      if (row == '') exit
      if (.not. has_header) then
        if (present(z) .and. count([(row(n:n) == ',', n=1, len(row))]) == 2) columns = 3
        if (columns == 3) is(2:)%name = trim(y_is%name)//['_x', '_y']
        call read_fields(row, is(:columns), read_unit, factors, message)
        if (columns == 3 .and. message == '') call compare_heads(row, is, message)
        has_header = .true.
      else if (n == size(x)) then
        message = 'the table has more than '//integer_text(most_rows)//' rows'
      else
        n = n + 1
        lines(n) = line
        call read_fields(row, is(:columns), read_number, values, message)
        x(n) = values(1)*factors(1)
        y(n) = values(2)*factors(2)
        second(n) = values(3)*factors(3)
        if (message == '' .and. n > 1) call compare_rows(x_is, row, x(n - 1), lines(n - 1), x(n), message)
      end if
    end do
    if (message == '' .and. n < 2) message = 'needs a header and at least two rows'
    line = max(1, line)
    x = x(:n)
    y = y(:n)
    lines = lines(:n)
    if (present(z)) z = second(:n)
  end subroutine parse_curve

  !> Read the fields of a row, which commas separate: `read_field` is `read_unit` for the header, and `read_number` for the other
  !> rows. Values of further columns are 0.
  subroutine read_fields(row, is, read_field, values, message)
    character(len=*), intent(in) :: row
    type(quantity_t), intent(in) :: is(:)
    procedure(read_number) :: read_field
    real(dp), intent(out) :: values(:)
    character(len=:), allocatable, intent(inout) :: message
    integer :: i, first, length
    values = 0
    if (count([(row(i:i) == ',', i=1, len(row))]) /= size(is) - 1) then
      message = printable(row, 60)//': needs two columns separated by a comma'
      if (size(is) == 3) message = printable(row, 60)//': needs three columns separated by commas'
      return
    end if
    first = 1
    do i = 1, size(is)
      length = index(row(first:)//',', ',') - 1
      if (message == '') call read_field(bare(row(first:first + length - 1)), is(i), values(i), message)
      first = first + length + 1
    end do
  end subroutine read_fields

  !> Check that the heads of the components of a vector say which is which.
  subroutine compare_heads(row, is, message)
    character(len=*), intent(in) :: row
    type(quantity_t), intent(in) :: is(3)
    character(len=:), allocatable, intent(inout) :: message
    integer :: first, second
    first = index(row, trim(is(2)%name))
    second = index(row, trim(is(3)%name))
    if (first > index(row, ',') .and. second > index(row, ',', back=.true.)) return
    message = printable(row, 60)//': the second and third column must be '//trim(is(2)%name)//' and '//trim(is(3)%name)// &
      ', each with its unit'
  end subroutine compare_heads

  !> A field without surrounding blanks and quotes.
  pure function bare(field) result(text)
    character(len=*), intent(in) :: field
    character(len=:), allocatable :: text
    text = trim(adjustl(field))
    if (len(text) < 2) return
    if (text(1:1) == '"' .and. text(len(text):) == '"') text = trim(text(2:len(text) - 1))
  end function bare

  !> The value of a unit in that of its quantity, from the name of a column.
  subroutine read_unit(name, quantity, factor, message)
    character(len=*), intent(in) :: name
    type(quantity_t), intent(in) :: quantity
    real(dp), intent(out) :: factor
    character(len=:), allocatable, intent(inout) :: message
    integer :: first, last
    factor = 0
    first = scan(name, '[(')
    last = scan(name, '])', back=.true.)
    if (first > 0 .and. last > first) factor = find_head_unit(name(first + 1:last - 1), trim(quantity%unit))
    if (factor > 0) return
    message = printable(name, 40)//': the header must name this column with its unit, the '//trim(quantity%name)// &
      ' in one of '//head_units(trim(quantity%unit))//', as in '//replaced(trim(quantity%name), ' ', '_')//'['// &
      trim(quantity%shown)//']'
  end subroutine read_unit

  subroutine read_number(field, quantity, value, message)
    character(len=*), intent(in) :: field
    type(quantity_t), intent(in) :: quantity
    real(dp), intent(out) :: value
    character(len=:), allocatable, intent(inout) :: message
    character(len=:), allocatable :: wanted
    value = 0
    if (field == '') then
      message = trim(quantity%name)//' is missing'
      return
    end if
    call read_real(field, value, wanted, quantity%may_be_tiny)
    if (allocated(wanted)) message = trim(quantity%name)//' = '//printable(field, 40)//': '//wanted
  end subroutine read_number

  !> Check that the first column increases from row to row.
  subroutine compare_rows(x_is, row, before, line, here, message)
    type(quantity_t), intent(in) :: x_is
    character(len=*), intent(in) :: row
    real(dp), intent(in) :: before, here
    integer, intent(in) :: line   !! line number of the row before
    character(len=:), allocatable, intent(inout) :: message
    if (here > before) return
    message = trim(x_is%name)//' = '//printable(trim(row(:index(row, ',') - 1)), 40)
    if (here < before) then
      message = message//': must be larger than that of line '//integer_text(line)//': rows must be in increasing order'
    else
      message = message//': already given in line '//integer_text(line)
    end if
  end subroutine compare_rows
end module curve_file
