!> A table of runs: CSV after RFC 4180, a header of GROUP.KEY, a row for each run. A table may be large and its fields of any
!> length: they are kept one behind the other, without their quotes, in the place of the text that they are read from.
module study_table
  use gudgeon_errors, only: error_t, fail, status_case_file
  use text_tools, only: printable, integer_text, lowercase
  use text_file, only: read_text_file
  use row_text, only: begins_formula
  implicit none
  private
  public :: study_table_t, read_table, parse_table

  character(len=*), parameter :: newline = achar(10), return = achar(13), quote = '"'
  integer, parameter :: largest_table = 1000   !! [MB]
  integer, parameter :: most_columns = 200

  type :: study_table_t
    integer :: rows = 0
    integer :: longest = 1                          !! bytes of the longest field
    character(len=:), allocatable :: keys(:)        !! (columns), in lower case
    integer, allocatable :: lines(:)                !! of the file where each row begins
    character(len=:), allocatable, private :: text  !! the fields of all rows
    integer, allocatable, private :: ends(:)        !! where each of them ends
  contains
    procedure :: field
  end type study_table_t

  !> A place in the text, which is read from `at` on while its beginning is overwritten by fields.
  type :: place_t
    integer :: at = 1, line = 1
    integer :: used = 0   !! bytes of fields
  end type place_t

contains

  !> The field of a row in a column, without quotes, blanks around it and an apostrophe that was put before it.
  pure function field(self, column, row) result(text)
    class(study_table_t), intent(in) :: self
    integer, intent(in) :: column, row
    character(len=self%ends(size(self%keys)*(row - 1) + column) - self%ends(size(self%keys)*(row - 1) + column - 1)) :: text
    associate (last => self%ends(size(self%keys)*(row - 1) + column))
      text = self%text(last - len(text) + 1:last)
    end associate
  end function field

  subroutine read_table(path, table, error)
    character(len=*), intent(in) :: path
    type(study_table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    call read_text_file(path, largest_table, 'table', text, error)
    if (.not. allocated(error)) call parse_table(text, path, table, error)
  end subroutine read_table

  !> The table in a text, which is used up; `path` names it in messages. Lines end with CR LF or LF; empty lines are passed over.
  subroutine parse_table(text, path, table, error)
    character(len=:), allocatable, intent(inout) :: text
    character(len=*), intent(in) :: path
    type(study_table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error
    type(place_t) :: place
    integer :: columns, most_rows, most_fields, i, row

    call move_alloc(text, table%text)
    if (index(table%text, char(239)//char(187)//char(191)) == 1) place%at = 4
    call take_header(path, table, place, columns, error)
    if (allocated(error)) return
    most_rows = 1
    most_fields = columns   ! of a last row that is too short
    do i = place%at, len(table%text)
      if (table%text(i:i) == newline) most_rows = most_rows + 1
      if (index(','//newline, table%text(i:i)) > 0) most_fields = most_fields + 1
    end do
    allocate (table%lines(most_rows), table%ends(0:most_fields + columns))
    table%ends(0) = place%used
    do row = 1, most_rows
      call skip_empty_lines(table%text, place)
      if (place%at > len(table%text)) exit
      table%lines(row) = place%line
      call take_row(path, table%text, place, columns, table%ends(columns*(row - 1):columns*row), table%longest, error)
      if (allocated(error)) return
      table%rows = row
    end do
    if (table%rows == 0) then
      call fail(error, printable(path, 200)//': the table has a header but no run', status_case_file)
    else
      call check_header(path, table, error)
    end if
  end subroutine parse_table

  !> The keys of the header, and how many there are.
  subroutine take_header(path, table, place, columns, error)
    character(len=*), intent(in) :: path
    type(study_table_t), intent(inout) :: table
    type(place_t), intent(inout) :: place
    integer, intent(out) :: columns
    type(error_t), allocatable, intent(out) :: error
    integer :: ends(0:most_columns), i
    columns = 0
    call skip_empty_lines(table%text, place)
    if (place%at > len(table%text)) then
      call fail(error, printable(path, 200)//': the table is empty: a header of GROUP.KEY and a row for each run are wanted', &
                status_case_file)
      return
    end if
    call take_row(path, table%text, place, columns, ends, table%longest, error)
    if (allocated(error)) return
    allocate (character(len=table%longest) :: table%keys(columns))
    do i = 1, columns
      table%keys(i) = lowercase(table%text(ends(i - 1) + 1:ends(i)))
    end do
    table%longest = 1
  end subroutine take_header

  !> The fields of one row, of which there must be so many; 0: as many as there are, which is answered.
  subroutine take_row(path, text, place, columns, ends, longest, error)
    character(len=*), intent(in) :: path
    character(len=*), intent(inout) :: text
    type(place_t), intent(inout) :: place
    integer, intent(inout) :: columns, longest
    integer, intent(inout) :: ends(0:)   !! of each field
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: message
    integer :: column, line
    logical :: is_last
    line = place%line
    ends(0) = place%used
    column = 0
    is_last = .false.
    message = ''
    do while (.not. is_last .and. message == '')
      column = column + 1
      if (column > most_columns) then
        message = 'more than 200 columns'
      else if (column > ubound(ends, 1)) then
        message = 'the header has '//integer_text(columns)//' fields, this row more'
      else
        call take_field(text, place, is_last, message)
        ends(column) = place%used
        longest = max(longest, ends(column) - ends(column - 1))
      end if
    end do
    if (columns == 0) columns = column
    if (column < columns .and. message == '') &
      message = 'the header has '//integer_text(columns)//' fields, this row fewer'
    if (message /= '') call fail(error, printable(path, 200)//':'//integer_text(line)//': column '// &
                                      integer_text(column)//': '//message, status_case_file)
  end subroutine take_row

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
  subroutine take_field(text, place, is_last, message)
    character(len=*), intent(inout) :: text
    type(place_t), intent(inout) :: place
    logical, intent(out) :: is_last
    character(len=:), allocatable, intent(inout) :: message   !! what is wrong; unchanged where nothing is
    character(len=1) :: c
    logical :: is_quoted
    integer :: before

    before = place%used
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
        call keep(text, place, before, c)
      end do
    end if
    is_last = .true.
    do while (place%at <= len(text))
      c = text(place%at:place%at)
      place%at = place%at + 1
      is_last = c /= ','
      if (.not. is_last) exit
      if (c == newline) then
        place%line = place%line + 1
        exit
      end if
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
      call keep(text, place, before, c)
    end do
    place%used = before + len_trim(text(before + 1:place%used))
    if (text(before + 1:min(before + 1, place%used)) == "'") then
      if (begins_formula(text(before + 1:place%used))) then
        text(before + 1:place%used - 1) = text(before + 2:place%used)
        place%used = place%used - 1
      end if
    end if
  end subroutine take_field

  !> Add a character to a field that begins behind `before`, unless it is a blank at its beginning.
  pure subroutine keep(text, place, before, c)
    character(len=*), intent(inout) :: text
    type(place_t), intent(inout) :: place
    integer, intent(in) :: before
    character(len=1), intent(in) :: c
    if (c == ' ' .and. place%used == before) return
    place%used = place%used + 1
    text(place%used:place%used) = c
  end subroutine keep

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
