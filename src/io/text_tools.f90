!> Small procedures for texts: letter case, lists of words, safe output to a terminal.
module text_tools
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: lowercase, printable, is_clean, integer_text, whole_number, quoted, nearest_word, case_name, &
    path_beside, replaced, next_line

contains

  pure function lowercase(text) result(lower)
    character(len=*), intent(in) :: text
    character(len=len(text)) :: lower
    integer :: i, code
    do i = 1, len(text)
      code = iachar(text(i:i))
      if (code >= iachar('A') .and. code <= iachar('Z')) code = code + 32
      lower(i:i) = achar(code)
    end do
  end function lowercase

  pure function integer_text(number) result(text)
    integer, intent(in) :: number
    character(len=:), allocatable :: text
    character(len=11) :: digits
    integer :: rest, i
    rest = merge(number, -number, number < 0)   ! negative, since the most negative number has no positive one
    do i = len(digits), 1, -1
      digits(i:i) = achar(iachar('0') - mod(rest, 10))
      rest = rest/10
      if (rest == 0) exit
    end do
    text = digits(i:)
    if (number < 0) text = '-'//text
  end function integer_text

  !> The number in a text: at most 18 digits, possibly with a sign.
  pure integer(int64) function whole_number(text) result(number)
    character(len=*), intent(in) :: text
    integer :: i
    number = 0
    do i = merge(2, 1, scan(text, '+-') == 1), len(text)
      number = 10*number + (iachar(text(i:i)) - iachar('0'))
    end do
    if (text(1:1) == '-') number = -number
  end function whole_number

  !> A text between two quotation marks; those inside it are doubled.
  pure function quoted(text, mark) result(string)
    character(len=*), intent(in) :: text
    character(len=1), intent(in) :: mark
    character(len=:), allocatable :: string
    string = mark//replaced(text, mark, mark//mark)//mark
  end function quoted

  !> The text as one safe line: control characters, invisible characters, characters that change the direction of writing, and bytes
  !> that are not UTF-8 are shown as \xHH; a text longer than `limit` bytes is shortened and ends in '...'.
  pure function printable(text, limit) result(shown)
    character(len=*), intent(in) :: text
    integer, intent(in) :: limit
    character(len=:), allocatable :: shown
    character(len=4) :: escaped
    integer :: i, bytes
    shown = ''
    i = 1
    do while (i <= len(text))
      bytes = clean_length(text, i)
      if (bytes > 1) bytes = merge(0, bytes, is_invisible(text(i:i + bytes - 1)))
      if (len(shown) + max(bytes, 4) > limit .and. len(shown) + len(text) - i + 1 > limit) then
        shown = shown//'...'
        return
      end if
      if (bytes > 0) then
        shown = shown//text(i:i + bytes - 1)
      else
        write (escaped, '(a,z2.2)') '\x', ichar(text(i:i))
        shown = shown//escaped
      end if
      i = i + max(bytes, 1)
    end do
  end function printable

  !> Whether a character of UTF-8 beyond ASCII is a blank, has no width or changes the direction of writing: U+00A0, U+00AD,
  !> U+2000-200F, U+2028-202F, U+205F-206F, U+3000, U+FEFF.
  pure logical function is_invisible(character) result(answer)
    character(len=*), intent(in) :: character
    integer :: last
    last = ichar(character(len(character):))
    select case (character(:len(character) - 1))
    case (char(194))
      answer = last == 160 .or. last == 173
    case (char(226)//char(128))
      answer = last <= 143 .or. last >= 168 .and. last <= 175
    case (char(226)//char(129))
      answer = last >= 159 .and. last <= 175
    case (char(227)//char(128))
      answer = last == 128
    case (char(239)//char(187))
      answer = last == 191
    case default
      answer = .false.
    end select
  end function is_invisible

  !> Whether the text is UTF-8 without control characters.
  pure logical function is_clean(text) result(clean)
    character(len=*), intent(in) :: text
    integer :: i, bytes
    clean = .true.
    i = 1
    do while (i <= len(text) .and. clean)
      bytes = clean_length(text, i)
      clean = bytes > 0
      i = i + bytes
    end do
  end function is_clean

  !> Number of bytes of the UTF-8 character that begins at `i`; 0 if there is none or it is a control character.
  pure function clean_length(text, i) result(bytes)
    character(len=*), intent(in) :: text
    integer, intent(in) :: i
    integer :: bytes, lead, k, next
    lead = ichar(text(i:i))
    bytes = 0
    if (lead >= 32 .and. lead < 127) bytes = 1
    if (lead >= 194 .and. lead < 224) bytes = 2
    if (lead >= 224 .and. lead < 240) bytes = 3
    if (lead >= 240 .and. lead < 245) bytes = 4
    if (i + bytes - 1 > len(text)) bytes = 0
    do k = 1, bytes - 1
      next = ichar(text(i + k:i + k))
      if (next < 128 .or. next > 191) then
        bytes = 0
        return
      end if
      if (k > 1) cycle
      if (lead == 194 .and. next < 160 .or. lead == 224 .and. next < 160 .or. lead == 237 .and. next > 159 .or. &
          lead == 240 .and. next < 144 .or. lead == 244 .and. next > 143) then
        bytes = 0
        return
      end if
    end do
  end function clean_length

  !> The word of a list that is most similar to a misspelt one; empty if none is similar.
  pure function nearest_word(word, list) result(nearest)
    character(len=*), intent(in) :: word, list(:)
    character(len=:), allocatable :: nearest
    integer :: i, distance, least
    nearest = ''
    least = max(1, min(3, len_trim(word)/2)) + 1
    do i = 1, size(list)
      distance = edits(trim(word), trim(list(i)))
      if (distance < least) then
        least = distance
        nearest = trim(list(i))
      end if
    end do
  end function nearest_word

  !> Number of letters to insert, remove or replace to turn one word into the other (Levenshtein); large for long words.
  pure function edits(a, b) result(distance)
    character(len=*), intent(in) :: a, b
    integer :: distance, i, j, diagonal, above, row(0:len(b))
    distance = huge(distance)
    if (len(a) > 64) return
    row = [(j, j=0, len(b))]
    do i = 1, len(a)
      diagonal = row(0)
      row(0) = i
      do j = 1, len(b)
        above = row(j)
        row(j) = min(above + 1, row(j - 1) + 1, diagonal + merge(0, 1, a(i:i) == b(j:j)))
        diagonal = above
      end do
    end do
    distance = row(len(b))
  end function edits

  !> The NAME of a case: the name of its file without folder and .nml.
  pure function case_name(path) result(name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name
    name = path(index(path, '/', back=.true.) + 1:)
    if (len(name) < 4) return
    if (lowercase(name(len(name) - 3:)) == '.nml') name = name(:len(name) - 4)
  end function case_name

  !> The path of a file that another file names. It is relative to the folder of that file, or to the current folder if that is
  !> standard input; empty for an empty name.
  pure function path_beside(file, name) result(path)
    character(len=*), intent(in) :: file, name
    character(len=:), allocatable :: path
    path = name
    if (name == '' .or. index(name, '/') == 1 .or. file == '/dev/stdin') return
    path = file(:index(file, '/', back=.true.))//name
  end function path_beside

  !> The text with every `old` replaced by `new`.
  pure function replaced(text, old, new) result(out)
    character(len=*), intent(in) :: text, old, new
    character(len=:), allocatable :: out
    integer :: from, length
    out = ''
    from = 1
    do
      length = index(text(from:), old) - 1
      if (length < 0) exit
      out = out//text(from:from + length - 1)//new
      from = from + length + len(old)
    end do
    out = out//text(from:)
  end function replaced

  !> The line at position `at` of a text; `at` is moved behind it.
  pure subroutine next_line(text, at, line)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at
    character(len=:), allocatable, intent(out) :: line
    integer :: first, length
    first = min(at, len(text) + 1)
    length = index(text(first:), achar(10)) - 1
    if (length < 0) length = len(text) - first + 1
    line = text(first:first + length - 1)
    at = first + length + 1
  end subroutine next_line
end module text_tools
