!> Rows of a table being put together, in memory that is kept from one to the next. No text function is used: threads may
!> work side by side.
!>
!> Spreadsheet programs run a field that begins with = + - @, a tab or a carriage return as a formula. A text that does gets an
!> apostrophe in front, and so does one whose apostrophes stand before such a beginning: who reads a field takes one apostrophe
!> away there. Numbers stay as they are.
module row_text
  use gudgeon_kinds, only: dp
  use value_reader, only: read_real
  use number_writer, only: number_writer_t, longest_number
  implicit none
  private
  public :: row_text_t, begins_formula

  type :: row_text_t
    character(len=:), allocatable :: text   !! its first `used` characters count
    integer :: used = 0
    logical, private :: is_open = .false.   !! a row has begun
  contains
    procedure :: clear
    procedure :: add_text
    procedure :: add_whole
    procedure :: add_number
    procedure :: end_row
    procedure, private :: make_room
  end type row_text_t

contains

  pure subroutine clear(self)
    class(row_text_t), intent(inout) :: self
    call self%make_room(0)
    self%used = 0
    self%is_open = .false.
  end subroutine clear

  !> Whether a field begins as a formula does, perhaps behind apostrophes.
  pure logical function begins_formula(text)
    character(len=*), intent(in) :: text
    integer :: first
    first = verify(text, "'")
    begins_formula = first > 0
    if (begins_formula) begins_formula = index('=+-@'//achar(9)//achar(13), text(first:first)) > 0
  end function begins_formula

  !> A field; in quotes where it needs them (RFC 4180), behind an apostrophe where it is a text that begins as a formula does.
  !> Trailing blanks are left out.
  pure subroutine add_text(self, text)
    class(row_text_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: wanted
    real(dp) :: unimportant
    integer :: i
    logical :: needs_quotes, needs_apostrophe
    call self%make_room(2*len(text) + 4)
    needs_quotes = scan(text, '",'//achar(10)//achar(13)) > 0
    needs_apostrophe = begins_formula(text)
    if (needs_apostrophe) then
      call read_real(trim(text), unimportant, wanted)
      needs_apostrophe = allocated(wanted)
    end if
    call append(self, ',', self%is_open)
    call append(self, '"', needs_quotes)
    call append(self, "'", needs_apostrophe)
    do i = 1, len_trim(text)
      call append(self, '"', text(i:i) == '"')
      call append(self, text(i:i), .true.)
    end do
    call append(self, '"', needs_quotes)
    self%is_open = .true.
  end subroutine add_text

  pure subroutine add_whole(self, number)
    class(row_text_t), intent(inout) :: self
    integer, intent(in) :: number
    character(len=11) :: digits
    write (digits, '(i0)') number
    call self%add_text(digits)
  end subroutine add_whole

  pure subroutine add_number(self, numbers, value)
    class(row_text_t), intent(inout) :: self
    type(number_writer_t), intent(in) :: numbers
    real(dp), intent(in) :: value
    call self%make_room(longest_number + 1)
    call append(self, ',', self%is_open)
    call numbers%append(self%text, self%used, value)
    self%is_open = .true.
  end subroutine add_number

  pure subroutine end_row(self)
    class(row_text_t), intent(inout) :: self
    call self%make_room(1)
    call append(self, achar(10), .true.)
    self%is_open = .false.
  end subroutine end_row

  pure subroutine append(self, character, wanted)
    class(row_text_t), intent(inout) :: self
    character(len=1), intent(in) :: character
    logical, intent(in) :: wanted
    if (.not. wanted) return
    self%used = self%used + 1
    self%text(self%used:self%used) = character
  end subroutine append

  !> Room for so many characters more.
  pure subroutine make_room(self, more)
    class(row_text_t), intent(inout) :: self
    integer, intent(in) :: more
    character(len=:), allocatable :: longer
    if (.not. allocated(self%text)) allocate (character(len=1024) :: self%text)
    if (self%used + more <= len(self%text)) return
    allocate (character(len=2*(self%used + more)) :: longer)
    longer(:self%used) = self%text(:self%used)
    call move_alloc(longer, self%text)
  end subroutine make_room
end module row_text
