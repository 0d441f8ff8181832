!> A position in a text that moves forward over blanks, comments and names of the namelist syntax.
module text_scanner
  use physical_units, only: no_break_space
  use text_tools, only: lowercase, printable
  implicit none
  private
  public :: scanner_t, name_here, skip_blanks, bare_length, at_end, next_is, piece, rest_of_line, word_is_next, slash_of_unit, &
    skip_text_behind_end
  public :: newline, return, digits, shown

  !> The position, and the error found there.
  type :: scanner_t
    character(len=:), allocatable :: text
    integer :: at = 1, line = 1
    character(len=:), allocatable :: message
  end type scanner_t

  character(len=*), parameter :: digits = '0123456789', letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_'
  character(len=*), parameter :: tab = achar(9), newline = achar(10), return = achar(13)
  integer, parameter :: shown = 40   !! longest part of a file quoted in a message

contains

  !> The name that begins here, in lower case, and move behind it; empty if there is none.
  function name_here(scan) result(name)
    type(scanner_t), intent(inout) :: scan
    character(len=:), allocatable :: name
    integer :: length
    length = verify(scan%text(scan%at:), letters//digits) - 1
    if (length < 0) length = len(scan%text) - scan%at + 1
    name = lowercase(scan%text(scan%at:scan%at + length - 1))
    if (index(digits, name(:min(1, len(name)))) > 0) name = ''   ! a number
    scan%at = scan%at + len(name)
  end function name_here

  !> Skip blanks, ends of lines (LF, CR LF or CR) and comments.
  subroutine skip_blanks(scan)
    type(scanner_t), intent(inout) :: scan
    integer :: length
    do while (.not. at_end(scan))
      call skip_blanks_of_line(scan)
      if (at_end(scan)) return
      select case (scan%text(scan%at:scan%at))
      case (newline)
        scan%line = scan%line + 1
        scan%at = scan%at + 1
      case (return)
        scan%at = scan%at + 1
        if (.not. next_is(scan, newline)) scan%line = scan%line + 1
      case ('!')
        length = rest_of_line(scan)
        scan%at = scan%at + length
      case default
        return
      end select
    end do
  end subroutine skip_blanks

  !> Skip blanks, tabs and no-break spaces on this line.
  subroutine skip_blanks_of_line(scan)
    type(scanner_t), intent(inout) :: scan
    do
      if (next_is(scan, ' ') .or. next_is(scan, tab)) then
        scan%at = scan%at + 1
      else if (next_is(scan, no_break_space)) then
        scan%at = scan%at + len(no_break_space)
      else
        return
      end if
    end do
  end subroutine skip_blanks_of_line

  !> Skip the text behind the end of a group, which is a comment as in Fortran if it begins with a letter and has none of = & / on
  !> its line: those could belong to a key, a group or a unit.
  subroutine skip_text_behind_end(self)
    type(scanner_t), intent(inout) :: self
    integer :: length
    call skip_blanks_of_line(self)
    length = bytes_before(self%text(self%at:), newline//return//'!')
    associate (text => self%text(self%at:self%at + length - 1))
      if (scan(text, '=&/') > 0 .or. scan(text, letters(:52)) /= 1 .and. text <= '~') return
    end associate
    self%at = self%at + length
  end subroutine skip_text_behind_end

  !> Number of bytes to the end of the line.
  pure integer function rest_of_line(scan) result(length)
    type(scanner_t), intent(in) :: scan
    length = bytes_before(scan%text(scan%at:), newline//return)
  end function rest_of_line

  !> Number of bytes to the next separator. A slash of a unit is none, nor are the parentheses behind it.
  pure integer function bare_length(scan) result(length)
    type(scanner_t), intent(in) :: scan
    character(len=:), allocatable :: line
    length = 0
    line = scan%text(scan%at:scan%at + rest_of_line(scan) - 1)//no_break_space
    do
      length = length + min(bytes_before(line(length + 1:), ' ,/!&=()''"'//tab), &
        index(line(length + 1:), no_break_space) - 1)
      if (.not. slash_of_unit(scan, scan%at + length)) return
      length = length + 1
      if (line(length + 1:length + 1) == '(') length = length + index(line(length + 1:), ')')
    end do
  end function bare_length

  !> Whether there is a slash at `at` with a letter or ( directly behind it, as in rad/s and J/(kg K), which closes no group.
  pure logical function slash_of_unit(self, at) result(found)
    type(scanner_t), intent(in) :: self
    integer, intent(in) :: at
    found = .false.
    if (at < len(self%text)) found = self%text(at:at) == '/' .and. scan(self%text(at + 1:at + 1), letters(:52)//'(') == 1
  end function slash_of_unit

  !> Skip blanks on this line, and tell whether a word follows as a unit begins: with a letter, a degree or micro sign, or 1/ and a
  !> letter.
  logical function word_is_next(self) result(found)
    type(scanner_t), intent(inout) :: self
    integer :: at
    call skip_blanks_of_line(self)
    at = self%at
    found = .false.
    if (at_end(self)) return
    found = scan(self%text(at:at), letters(:52)//char(194)//char(206)) == 1
    if (next_is(self, '1')) found = slash_of_unit(self, at + 1)
  end function word_is_next

  !> Number of bytes before the first of some characters; the length of the text if it contains none of them.
  pure integer function bytes_before(text, ends) result(length)
    character(len=*), intent(in) :: text, ends
    length = scan(text, ends) - 1
    if (length < 0) length = len(text)
  end function bytes_before

  pure logical function at_end(scan) result(ended)
    type(scanner_t), intent(in) :: scan
    ended = scan%at > len(scan%text)
  end function at_end

  pure logical function next_is(scan, word) result(same)
    type(scanner_t), intent(in) :: scan
    character(len=*), intent(in) :: word
    same = index(scan%text(scan%at:min(scan%at + len(word) - 1, len(scan%text))), word) == 1
  end function next_is

  !> The text at this position for a message: the rest of the line, shortened.
  pure function piece(scan) result(text)
    type(scanner_t), intent(in) :: scan
    character(len=:), allocatable :: text
    text = printable(scan%text(scan%at:scan%at + rest_of_line(scan) - 1), shown)
  end function piece
end module text_scanner
