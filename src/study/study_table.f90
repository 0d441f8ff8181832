!> A table of runs: CSV after RFC 4180, a header of GROUP.KEY, a row for each run.
module study_table
  use errors, only: error_t, fail, status_case_file
  use text_tools, only: printable, integer_text, lowercase
  use text_file, only: read_text_file
  implicit none
  private
  public :: study_table_t, read_table, parse_table

  character(len=*), parameter :: newline = achar(10), return = achar(13), quote = '"'
  integer, parameter :: largest_table = 1000   !! [MB]
  integer, parameter :: most_columns = 200

  !> Fields as written, without their quotes.
  type :: study_table_t
    character(len=:), allocatable :: keys(:)        !! (columns), in lower case
    character(len=:), allocatable :: fields(:, :)   !! (columns, rows)
    integer, allocatable :: lines(:)                !! of the file where each row begins
  end type study_table_t

  !> A place in the text.
  type :: place_t
    integer :: at = 1, line = 1
  end type place_t

contains

  subroutine read_table(path, table, error)
    character(len=*), intent(in) :: path
    type(study_table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    call read_text_file(path, largest_table, 'table', text, error)
    if (.not. allocated(error)) call parse_table(text, path, table, error)
  end subroutine read_table

  !> The table in a text; `path` names it in messages. Lines end with CR LF or LF; empty lines are passed over.
  subroutine parse_table(text, path, table, error)
    character(len=*), intent(in) :: text, path
    type(study_table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error
    integer :: columns, rows, longest

    call walk(text, path, columns, rows, longest, error=error)
    if (allocated(error)) return
    if (columns == 0) then
      call fail(error, printable(path, 200)//': the table is empty: a header of GROUP.KEY and a row for each run are wanted', &
                status_case_file)
    else if (rows == 0) then
      call fail(error, printable(path, 200)//': the table has a header but no run', status_case_file)
    end if
    if (allocated(error)) return
    allocate (character(len=longest) :: table%keys(columns), table%fields(columns, rows))
    allocate (table%lines(rows))
    call walk(text, path, columns, rows, longest, table, error)
    if (.not. allocated(error)) call check_header(path, table, error)
  end subroutine parse_table

  !> Go through the records: count them, or fill the table.
  subroutine walk(text, path, columns, rows, longest, table, error)
    character(len=*), intent(in) :: text, path
    integer, intent(out) :: columns, rows, longest
    type(study_table_t), intent(inout), optional :: table
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: field, message
    type(place_t) :: place
    integer :: column, records, length, line, room
    logical :: is_last

    columns = 0
    records = 0
    longest = 1
    rows = 0
    room = longest_field(text)
    allocate (character(len=room) :: field)
    if (index(text, char(239)//char(187)//char(191)) == 1) place%at = 4
    do
      call skip_empty_lines(text, place)
      if (place%at > len(text)) exit
      records = records + 1
      line = place%line
      column = 0
      is_last = .false.
      do while (.not. is_last)
        column = column + 1
        call take_field(text, place, field, length, is_last, message)
        if (allocated(message)) exit
        longest = max(longest, length)
        if (records > 1 .and. column > columns .or. column > most_columns) exit
        if (.not. present(table)) cycle
        if (records == 1) table%keys(column) = lowercase(trim(adjustl(field(:length))))
        if (records > 1) table%fields(column, records - 1) = trim(adjustl(field(:length)))
      end do
      if (.not. allocated(message)) then
        if (records == 1) columns = column
        if (column > most_columns) then
          message = 'more than 200 columns'
        else if (column /= columns) then
          message = 'the header has '//integer_text(columns)//' fields, this row '// &
            trim(merge('more ', 'fewer', column > columns))
        end if
      end if
      if (allocated(message)) then
        call fail(error, printable(path, 200)//':'//integer_text(line)//': column '//integer_text(column)//': '//message, &
                  status_case_file)
        return
      end if
      if (present(table) .and. records > 1) table%lines(records - 1) = line
    end do
    rows = max(0, records - 1)
  end subroutine walk

  !> Room enough for any field: the longest line, or all of the text where a quoted field may hold ends of lines.
  pure integer function longest_field(text)
    character(len=*), intent(in) :: text
    integer :: i, first
    longest_field = len(text)
    if (index(text, quote) > 0) return
    longest_field = 0
    first = 1
    do i = 1, len(text)
      if (text(i:i) /= newline) cycle
      longest_field = max(longest_field, i - first)
      first = i + 1
    end do
    longest_field = max(longest_field, len(text) - first + 1)
  end function longest_field

  pure subroutine skip_empty_lines(text, place)
    character(len=*), intent(in) :: text
    type(place_t), intent(inout) :: place
    do while (place%at <= len(text))
      if (text(place%at:place%at) == newline) place%line = place%line + 1
      if (index(newline//return, text(place%at:place%at)) == 0) return
      place%at = place%at + 1
    end do
  end subroutine skip_empty_lines

  !> One field and the comma or the end of line behind it.
  subroutine take_field(text, place, field, length, is_last, message)
    character(len=*), intent(in) :: text
    type(place_t), intent(inout) :: place
    character(len=*), intent(inout) :: field
    integer, intent(out) :: length
    logical, intent(out) :: is_last
    character(len=:), allocatable, intent(out) :: message
    character(len=1) :: c
    logical :: is_quoted

    length = 0
    is_quoted = .false.
    is_last = .false.
    if (place%at <= len(text)) is_quoted = text(place%at:place%at) == quote
    if (is_quoted) then
      place%at = place%at + 1
      do
        if (place%at > len(text)) then
          message = 'the quote " is not closed'
          return
        end if
        c = text(place%at:place%at)
        place%at = place%at + 1
        if (c == quote) then
          if (place%at > len(text)) exit
          if (text(place%at:place%at) /= quote) exit
          place%at = place%at + 1
        end if
        if (c == newline) place%line = place%line + 1
        length = length + 1
        field(length:length) = c
      end do
    end if
    do while (place%at <= len(text))
      c = text(place%at:place%at)
      place%at = place%at + 1
      if (c == ',') return
      if (c == newline) exit
      if (c == return) then
        if (place%at > len(text)) exit
        if (text(place%at:place%at) == newline) cycle
      end if
      if (is_quoted) then
        if (c == ' ') cycle
        message = 'text behind a closing quote'
        return
      else if (c == quote) then
        message = 'a quote inside a field that does not begin with one'
        return
      end if
      length = length + 1
      field(length:length) = c
    end do
    is_last = .true.
    if (place%at > 1) then
      if (text(min(place%at, len(text) + 1) - 1:min(place%at, len(text) + 1) - 1) == newline) place%line = place%line + 1
    end if
  end subroutine take_field

  !> Every column has a name of its own.
  subroutine check_header(path, table, error)
    character(len=*), intent(in) :: path
    type(study_table_t), intent(in) :: table
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: at
    integer :: i, k
    do i = 1, size(table%keys)
      at = printable(path, 200)//':1: column '//integer_text(i)//': '
      if (index(table%keys(i), '.') == 0) then
        call fail(error, at//'"'//printable(trim(table%keys(i)), 60)//'" must have the form GROUP.KEY', status_case_file)
        return
      end if
      do k = 1, i - 1
        if (table%keys(k) /= table%keys(i)) cycle
        call fail(error, at//printable(trim(table%keys(i)), 60)//' stands here twice', status_case_file)
        return
      end do
    end do
  end subroutine check_header
end module study_table
