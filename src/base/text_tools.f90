!> Small procedures for texts: letter case, lists of words, safe output to a terminal.
module text_tools
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: lowercase, printable, is_clean, integer_text, counted, whole_number, quoted, nearest_word, likely_word, allowed, &
    joined, case_name, path_beside, replaced, next_line, next_row

  !> Ranges of characters that are blanks beyond ASCII, have no width or change the direction of writing: U+00A0, U+00AD,
  !> U+2000-200F, U+2028-202F, U+205F-206F, U+3000, U+FEFF.
  integer, parameter :: first_invisible(7) = [160, 173, 8192, 8232, 8287, 12288, 65279], &
    last_invisible(7) = [160, 173, 8207, 8239, 8303, 12288, 65279]

  !> A whole number as text.
  interface integer_text
    procedure :: short_integer, long_integer
  end interface integer_text

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

  pure function short_integer(number) result(text)
    integer, intent(in) :: number
    character(len=:), allocatable :: text
    text = long_integer(int(number, int64))
  end function short_integer

  pure function long_integer(number) result(text)
    integer(int64), intent(in) :: number
    character(len=:), allocatable :: text
    character(len=20) :: digits
    write (digits, '(i0)') number
    text = trim(digits)
  end function long_integer

  !> A number of things: 1 contact, 2 contacts.
  pure function counted(number, thing) result(text)
    character(len=*), intent(in) :: number   !! as text
    character(len=*), intent(in) :: thing    !! one of them
    character(len=:), allocatable :: text
    text = number//' '//thing
    if (number /= '1') text = text//'s'
  end function counted

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
    integer :: i, code, bytes
    shown = ''
    i = 1
    do while (i <= len(text))
      call read_character(text, i, code, bytes)
      if (any(first_invisible <= code .and. code <= last_invisible)) bytes = 0
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

  !> Whether the text is UTF-8 without control characters.
  pure logical function is_clean(text) result(clean)
    character(len=*), intent(in) :: text
    integer :: i, code, bytes
    clean = .true.
    i = 1
    do while (i <= len(text) .and. clean)
      call read_character(text, i, code, bytes)
      clean = bytes > 0
      i = i + bytes
    end do
  end function is_clean

  !> The code of the UTF-8 character that begins at `i`, and its number of bytes; 0 bytes if there is none or it is a control
  !> character.
  pure subroutine read_character(text, i, code, bytes)
    character(len=*), intent(in) :: text
    integer, intent(in) :: i
    integer, intent(out) :: code, bytes
    integer, parameter :: lead(4) = [0, 192, 224, 240], least(4) = [32, 160, 2048, 65536]   ! for 1 to 4 bytes
    integer :: n, k, next
    bytes = 0
    code = ichar(text(i:i))
    n = count(code >= lead)
    code = code - lead(n)
    if (n == 1 .and. code > 126 .or. i + n - 1 > len(text)) return
    do k = 1, n - 1
      next = ichar(text(i + k:i + k)) - 128
      if (next < 0 .or. next > 63) return
      code = 64*code + next
    end do
    if (code >= least(n) .and. code <= 1114111 .and. code/2048 /= 27) bytes = n   ! 27: halves of a pair of UTF-16
  end subroutine read_character

  !> The word of a list that is most similar to a misspelt one, or else the shortest that begins with it; empty if there is none.
  pure function nearest_word(word, list) result(nearest)
    character(len=*), intent(in) :: word, list(:)
    character(len=:), allocatable :: nearest
    integer, parameter :: least_beginning = 3   !! letters
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
    if (nearest /= '' .or. len_trim(word) < least_beginning) return
    do i = 1, size(list)
      if (index(list(i), trim(word)) == 1 .and. (nearest == '' .or. len_trim(list(i)) < len(nearest))) nearest = trim(list(i))
    end do
  end function nearest_word

  !> For a misspelt word, `; did you mean x?`, if one in a list of words separated by commas and blanks is similar.
  pure function likely_word(word, list) result(text)
    character(len=*), intent(in) :: word, list
    character(len=:), allocatable :: text
    character(len=len(list)) :: words(len(list)/2 + 1)
    integer :: first, length, n
    n = 0
    first = 1
    do while (first <= len(list))
      length = scan(list(first:)//',', ', ') - 1
      if (length > 0) then
        n = n + 1
        words(n) = list(first:first + length - 1)
      end if
      first = first + length + 1
    end do
    text = nearest_word(word, words(:n))
    if (text /= '') text = '; did you mean '//text//'?'
  end function likely_word

  !> ` (allowed: x, y, z)`.
  pure function allowed(words) result(text)
    character(len=*), intent(in) :: words(:)
    character(len=:), allocatable :: text
    text = ' (allowed: '//joined(words)//')'
  end function allowed

  !> `x, y, z`, without words that are empty.
  pure function joined(words) result(text)
    character(len=*), intent(in) :: words(:)
    character(len=:), allocatable :: text
    integer :: i
    text = trim(words(1))
    do i = 2, size(words)
      if (words(i) /= '') text = text//', '//trim(words(i))
    end do
  end function joined

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

  !> The next row of a table at or behind position `at` of a text, without surrounding blanks: a line that is not empty and does not
  !> begin with #. `at` is moved behind it, and `line`, the number of the line before, to its number. Empty if there is none.
  pure subroutine next_row(text, at, line, row)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at, line
    character(len=:), allocatable, intent(out) :: row
    row = ''
    do while (at <= len(text))
      call next_line(text, at, row)
      line = line + 1
      if (index(row, achar(13), back=.true.) == len(row)) row = row(:len(row) - 1)
      row = trim(adjustl(row))
      if (index(row, '#') == 1) row = ''
      if (row /= '') return
    end do
  end subroutine next_row
end module text_tools
