!> A table of runs: CSV according to RFC 4180, with a header of GROUP.KEY and a row for each run. Since a table may be large and its
!> fields of any length, fields are stored as positions in the text.
module study_table
  use error_handling, only: error_t, fail, status_case_file
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
    integer :: longest = 1                          !! length of the longest field [bytes]
    character(len=:), allocatable :: keys(:)        !! (columns), in lower case
    integer, allocatable :: lines(:)                !! line of the file on which each row begins, (0:rows); 0 is the header
    character(len=:), allocatable, private :: text
    integer, allocatable, private :: first(:), last(:)  !! first and last byte of each field, including its quotes, beginning with
                                                        !! the header
  contains
    procedure :: field
  end type study_table_t

contains

  !> The field in a column of a row (0: the header), without quotes, leading blanks and an apostrophe added by a writer; padded with
  !> blanks.
  pure function field(self, column, row) result(text)
    class(study_table_t), intent(in) :: self
    integer, intent(in) :: column, row
    character(len=self%last(size(self%keys)*row + column) - self%first(size(self%keys)*row + column) + 1) :: text
    integer :: first, i, used
    first = self%first(size(self%keys)*row + column)
    text = self%text(first:first + len(text) - 1)
    if (index(text, quote) == 1) then
      used = 0
      i = 2
      do while (i < len(text))
        used = used + 1
        text(used:used) = text(i:i)
        i = i + merge(2, 1, text(i:i) == quote)   ! a doubled quote stands for one
      end do
      text(used + 1:) = ''
    end if
    text = adjustl(text)
    if (index(text, "'") /= 1) return
    if (begins_formula(text)) text = text(2:)
  end function field

  subroutine read_table(path, table, error)
    character(len=*), intent(in) :: path
    type(study_table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    call read_text_file(path, largest_table, 'table', text, error)
    if (.not. allocated(error)) call parse_table(text, path, table, error)
  end subroutine read_table

  !> Read the table from a text, which is then deallocated; `path` names it in messages. Lines end with CR LF or LF; empty lines are
  !> ignored.
  subroutine parse_table(text, path, table, error)
    character(len=:), allocatable, intent(inout) :: text
    character(len=*), intent(in) :: path
    type(study_table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: message
    integer :: at, line, columns, column, row, n, i
    logical :: is_last

    call move_alloc(text, table%text)
    n = count_of(table%text, newline)
    allocate (table%lines(0:n))
    n = n + count_of(table%text, ',') + 1
    allocate (table%first(n), table%last(n))
    at = 1
    if (index(table%text, char(239)//char(187)//char(191)) == 1) at = 4
    line = 1
    columns = 0
    n = 0
    row = -1
    message = ''
    do
      call skip_empty_lines(table%text, at, line)
      if (at > len(table%text)) exit
      row = row + 1
      table%lines(row) = line
      column = 0
      is_last = .false.
      do while (.not. is_last .and. message == '')
        column = column + 1
        if (column > most_columns) then
          message = 'more than 200 columns'
        else if (row > 0 .and. column > columns) then
          message = 'the header has '//integer_text(columns)//' fields, this row more'
        else
          n = n + 1
          call read_field(table%text, at, line, table%first(n), table%last(n), is_last, message)
          if (row > 0) table%longest = max(table%longest, table%last(n) - table%first(n) + 1)
        end if
      end do
      if (row == 0) columns = column
      if (column < columns .and. message == '') message = 'the header has '//integer_text(columns)//' fields, this row fewer'
      if (message /= '') then
        call fail(error, printable(path, 200)//':'//integer_text(table%lines(row))//': column '//integer_text(column)//': '// &
                  message, status_case_file)
        return
      end if
    end do
    table%rows = row
    if (row < 0) then
      message = 'the table is empty; it needs a header of GROUP.KEY and a row for each run'
    else if (row == 0) then
      message = 'the table has a header but no run'
    else
      allocate (character(len=max(1, maxval(table%last(:columns) - table%first(:columns)) + 1)) :: table%keys(columns))
      do i = 1, columns
        table%keys(i) = lowercase(table%field(i, 0))
      end do
      call check_header(path, table, error)
    end if
    if (message /= '') call fail(error, printable(path, 200)//': '//message, status_case_file)
  end subroutine parse_table

  !> Number of occurrences of a character in a text.
  pure integer function count_of(text, character) result(number)
    character(len=*), intent(in) :: text
    character(len=1), intent(in) :: character
    integer :: i
    number = 0
    do i = 1, len(text)
      if (text(i:i) == character) number = number + 1
    end do
  end function count_of

  pure subroutine skip_empty_lines(text, at, line)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at, line
    do while (at <= len(text))
      if (text(at:at) == newline) line = line + 1
      if (index(newline//return, text(at:at)) == 0) return
      at = at + 1
    end do
  end subroutine skip_empty_lines

  !> Find one field and the comma or end of line behind it.
  pure subroutine read_field(text, at, line, first, last, is_last, message)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at, line
    integer, intent(out) :: first, last
    logical, intent(out) :: is_last
    character(len=:), allocatable, intent(inout) :: message   !! error message; unchanged if there is no error
    integer :: ending, next
    logical :: is_quoted

    next = verify(text(at:), ' ')
    first = merge(at - 1 + next, len(text) + 1, next > 0)
    is_quoted = index(text(first:min(first, len(text))), quote) == 1
    is_last = .false.
    last = first
    at = first
    do while (is_quoted)
      next = index(text(at + 1:), quote)
      if (next == 0) then
        message = 'the quote " is not closed'
        return
      end if
      at = at + next + 1
      if (text(at:min(at, len(text))) /= quote) exit
    end do
    last = at - 1
    line = line + count_of(text(first:last), newline)
    next = scan(text(at:), ','//newline)
    ending = merge(at - 1 + next, len(text) + 1, next > 0)
    is_last = text(ending:min(ending, len(text))) /= ','
    next = ending - 1   ! the last byte of the field
    if (is_last .and. text(max(next, at):next) == return) next = next - 1
    if (.not. is_quoted) then
      if (index(text(at:next), quote) > 0) message = 'a quote inside a field that does not begin with one'
      last = at - 1 + len_trim(text(at:next))
    else if (text(at:next) /= '') then
      message = 'text behind a closing quote'
    end if
    if (is_last) line = line + 1
    at = ending + 1
  end subroutine read_field

  !> Check that all columns have different names.
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
        call fail(error, at//printable(trim(table%keys(i)), 60)//' is given twice', status_case_file)
        return
      end do
    end do
  end subroutine check_header
end module study_table
