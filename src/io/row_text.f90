!> Rows of a table in memory that is reused from row to row. No text function is used, so that several threads may work at the same
!> time.
!>
!> Spreadsheet programs execute a field that begins with = + - @, a tab or a carriage return as a formula. A text of this form is
!> written with an apostrophe in front; so is a text that begins with apostrophes followed by such a character. A reader removes one
!> apostrophe from such fields. Numbers are not changed.
module row_text
  use kinds, only: dp
  use value_reader, only: read_real
  use number_text, only: number_writer_t, longest_number
  use growing_text, only: growing_text_t
  implicit none
  private
  public :: row_text_t, begins_formula

  type, extends(growing_text_t) :: row_text_t
    logical, private :: is_open = .false.   !! the row has at least one field
  contains
    procedure :: clear
    procedure :: add_text
    procedure :: add_whole
    procedure :: add_number
    procedure :: end_row
  end type row_text_t

contains

  pure subroutine clear(self)
    class(row_text_t), intent(inout) :: self
    call self%reserve(0)
    self%used = 0
    self%is_open = .false.
  end subroutine clear

  !> Whether a field begins like a formula, possibly after apostrophes.
  pure logical function begins_formula(text)
    character(len=*), intent(in) :: text
    integer :: first
    first = verify(text, "'")
    begins_formula = first > 0
    if (begins_formula) begins_formula = index('=+-@'//achar(9)//achar(13), text(first:first)) > 0
  end function begins_formula

  !> Append a text field, in quotes if necessary (RFC 4180), with an apostrophe in front if it begins like a formula. Trailing
  !> blanks are removed.
  pure subroutine add_text(self, text)
    class(row_text_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: wanted
    real(dp) :: unimportant
    integer :: i
    logical :: needs_quotes, needs_apostrophe
    needs_quotes = scan(text, '",'//achar(10)//achar(13)) > 0
    needs_apostrophe = begins_formula(text)
    if (needs_apostrophe) then
      call read_real(trim(text), unimportant, wanted)
      needs_apostrophe = allocated(wanted)
    end if
    if (self%is_open) call self%append(',')
    if (needs_quotes) call self%append('"')
    if (needs_apostrophe) call self%append("'")
    if (needs_quotes) then
      do i = 1, len_trim(text)
        if (text(i:i) == '"') call self%append('"')
        call self%append(text(i:i))
      end do
      call self%append('"')
    else
      call self%append(text(:len_trim(text)))
    end if
    self%is_open = .true.
  end subroutine add_text

  pure subroutine add_whole(self, number)
    class(row_text_t), intent(inout) :: self
    integer, intent(in) :: number
    character(len=11) :: digits
    if (self%is_open) call self%append(',')
    write (digits, '(i0)') number
    call self%append(digits(:len_trim(digits)))
    self%is_open = .true.
  end subroutine add_whole

  !> Append a number, or an empty field if `is_known` is false.
  pure subroutine add_number(self, numbers, value, is_known)
    class(row_text_t), intent(inout) :: self
    type(number_writer_t), intent(in) :: numbers
    real(dp), intent(in) :: value
    logical, intent(in), optional :: is_known
    if (self%is_open) call self%append(',')
    self%is_open = .true.
    if (present(is_known)) then
      if (.not. is_known) return
    end if
    call self%reserve(longest_number)
    call numbers%append(self%text, self%used, value)
  end subroutine add_number

  pure subroutine end_row(self)
    class(row_text_t), intent(inout) :: self
    call self%append(achar(10))
    self%is_open = .false.
  end subroutine end_row
end module row_text
