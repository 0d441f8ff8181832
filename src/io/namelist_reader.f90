!> Reads the syntax of Fortran namelists into groups, keys and values, without knowledge of their meaning. It is stricter than the
!> reader of a compiler, which accepts some mistakes: only comments may stand outside a group, every group must be closed by / or
!> &end, every key must have values, and no value may be missing between commas. A word behind a number is its unit.
module namelist_reader
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: printable, is_clean, integer_text, whole_number
  use text_scanner, only: scanner_t, name_here, skip_blanks, bare_length, at_end, next_is, piece, rest_of_line, word_is_next, &
    slash_of_unit, skip_text_behind_end, digits, shown
  use physical_units, only: split_number
  implicit none
  private
  public :: namelist_t, entry_t, token_t, read_namelist, read_values

  !> One value as written, `repeat` times.
  type :: token_t
    character(len=:), allocatable :: text   !! without quotes; doubled quotes inside are single; with the unit of a number
    logical :: quoted = .false.
    integer :: repeat = 1
    logical :: follows_comma = .false.   !! follows a comma without a blank
  end type token_t

  !> The beginning of a group.
  type :: named_group_t
    character(len=:), allocatable :: name
    integer :: line = 0
  end type named_group_t

  !> One `key = values` of a group.
  type :: entry_t
    character(len=:), allocatable :: group, key
    integer :: group_number = 0              !! index among the groups of the file
    integer :: index = 0                     !! n of key(n); 0 for a key without index
    integer :: line = 0
    type(token_t), allocatable :: tokens(:)
  end type entry_t

  !> All groups and entries of a file; names in lower case.
  type :: namelist_t
    character(len=:), allocatable :: file          !! name of the file in messages
    type(named_group_t), allocatable :: groups(:)
    type(entry_t), allocatable :: entries(:)
    integer, private :: n_groups = 0, n_entries = 0   !! while the file is read
  contains
    procedure :: at
  end type namelist_t

  integer, parameter :: most = 1000          !! largest number of groups and of keys
  integer, parameter :: most_values = 4000   !! largest number of values of a key

contains

  !> Read the text of the file at `path`. Error: a mistake in the syntax (status_case_file); `list` has what comes before it.
  subroutine read_namelist(text, path, list, error)
    character(len=*), intent(in) :: text, path
    type(namelist_t), intent(out) :: list
    type(error_t), allocatable, intent(out) :: error
    type(scanner_t) :: scan
    integer :: closed   ! line on which the last group ends
    list%file = printable(path, 200)
    allocate (list%groups(most), list%entries(most))
    scan%text = text
    if (index(text, char(239)//char(187)//char(191)) == 1) scan%at = 4
    do
      call skip_blanks(scan)
      if (at_end(scan)) exit
      if (scan%text(scan%at:scan%at) == '&') then
        call read_group(scan, list)
        closed = scan%line
      else
        scan%message = 'text outside a group: '//piece(scan)
        if (list%n_groups > 0) scan%message = scan%message//'; &'//printable(list%groups(list%n_groups)%name, shown)// &
          ' ends in line '//integer_text(closed)
      end if
      if (allocated(scan%message)) exit
    end do
    list%groups = list%groups(:list%n_groups)
    list%entries = list%entries(:list%n_entries)
    if (allocated(scan%message)) call fail(error, list%at(scan%line)//scan%message, status_case_file)
  end subroutine read_namelist

  !> `path:line: `, where a message says what is wrong there.
  function at(self, line)
    class(namelist_t), intent(in) :: self
    integer, intent(in) :: line
    character(len=:), allocatable :: at
    at = self%file//':'//integer_text(line)//': '
  end function at

  !> Read the values of one key from a text that contains nothing else.
  subroutine read_values(text, tokens, message)
    character(len=*), intent(in) :: text
    type(token_t), allocatable, intent(out) :: tokens(:)
    character(len=:), allocatable, intent(out) :: message
    type(scanner_t) :: scan
    scan%text = text
    call read_tokens(scan, tokens)
    if (.not. allocated(scan%message)) then
      call skip_blanks(scan)
      if (.not. at_end(scan)) scan%message = 'unexpected '//piece(scan)
    end if
    if (allocated(scan%message)) call move_alloc(scan%message, message)
  end subroutine read_values

  !> Read a group from its & to the closing / or &end.
  subroutine read_group(scan, list)
    type(scanner_t), intent(inout) :: scan
    type(namelist_t), intent(inout) :: list
    type(named_group_t) :: group
    character(len=:), allocatable :: next
    scan%at = scan%at + 1
    group%line = scan%line
    group%name = name_here(scan)
    if (group%name == '' .or. group%name == 'end') then
      scan%message = 'a group''s name must follow &'
      if (group%name == 'end') scan%message = '&end closes no group'
      return
    end if
    if (list%n_groups == most) scan%message = 'too many groups'
    if (allocated(scan%message)) return
    list%n_groups = list%n_groups + 1
    list%groups(list%n_groups) = group
    do
      call skip_blanks(scan)
      if (at_end(scan)) then
        call not_closed(scan, group, 'the end of the file')
        return
      end if
      select case (scan%text(scan%at:scan%at))
      case ('/')
        if (.not. slash_of_unit(scan, scan%at)) then
          scan%at = scan%at + 1
          call skip_text_behind_end(scan)
          return
        end if
      case ('&')
        scan%at = scan%at + 1
        next = name_here(scan)
        if (next /= 'end') call not_closed(scan, group, '&'//printable(next, shown))
        return
      case default   ! a key
      end select
      if (list%n_entries == most) scan%message = 'too many keys'
      if (allocated(scan%message)) return
      list%n_entries = list%n_entries + 1
      associate (entry => list%entries(list%n_entries))
        entry%group = group%name
        entry%group_number = list%n_groups
        call read_entry(scan, entry)
      end associate
      if (allocated(scan%message)) list%n_entries = list%n_entries - 1   ! not understood
      if (allocated(scan%message)) return
    end do
  end subroutine read_group

  subroutine not_closed(scan, group, next)
    type(scanner_t), intent(inout) :: scan
    type(named_group_t), intent(in) :: group
    character(len=*), intent(in) :: next
    scan%message = '&'//printable(group%name, shown)//': not closed: / is missing before '//next
    scan%line = group%line
  end subroutine not_closed

  !> `key = values`, `key(n) = values` or `key(m:n) = values`.
  subroutine read_entry(scan, entry)
    type(scanner_t), intent(inout) :: scan
    type(entry_t), intent(inout) :: entry
    character(len=:), allocatable :: place
    integer :: last, given
    entry%line = scan%line
    place = '&'//printable(entry%group, shown)
    entry%key = name_here(scan)
    if (entry%key == '') then
      scan%message = place//': a key or / was expected, not '//piece(scan)
      return
    end if
    place = place//' '//printable(entry%key, shown)
    call skip_blanks(scan)
    last = 0
    if (next_is(scan, '(')) then
      call read_index(scan, entry%index, last)
      if (entry%index < 1) then
        scan%message = place//': the index must be a whole number in parentheses, as in key(1), or two, as in key(1:2)'
        return
      end if
      call skip_blanks(scan)
    end if
    if (.not. next_is(scan, '=')) then
      scan%message = place//': = is missing'
      return
    end if
    scan%at = scan%at + 1
    call read_tokens(scan, entry%tokens)
    if (.not. allocated(scan%message) .and. last > 0) then
      given = sum(entry%tokens%repeat)
      if (given /= last - entry%index + 1) then
        scan%message = 'takes '//integer_text(last - entry%index + 1)//' values from '//integer_text(entry%index)//' to '// &
          integer_text(last)//', not '//integer_text(given)
        scan%line = entry%line
      end if
    end if
    if (allocated(scan%message)) scan%message = place//': '//scan%message
  end subroutine read_entry

  !> The first and last number of (first) or (first:last), and move behind it. `first` is 0 if they are not that, and `last` if
  !> there is none.
  subroutine read_index(scan, first, last)
    type(scanner_t), intent(inout) :: scan
    integer, intent(out) :: first, last
    character(len=:), allocatable :: content
    integer :: length, colon
    length = index(scan%text(scan%at:scan%at + rest_of_line(scan) - 1), ')')
    content = scan%text(scan%at + 1:scan%at + length - 2)
    scan%at = scan%at + length
    colon = index(content//':', ':')
    first = whole(content(:colon - 1))
    last = whole(content(colon + 1:))
    if (colon < len(content) .and. last < first) first = 0
  end subroutine read_index

  !> A text as a whole number from 1 to 9999; 0 if it is none.
  pure integer function whole(text)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: bare
    bare = trim(adjustl(text))
    whole = 0
    if (len(bare) >= 1 .and. len(bare) <= 4 .and. verify(bare, digits) == 0) whole = int(whole_number(bare))
  end function whole

  !> Read the values of a key, up to the next key, / or &.
  subroutine read_tokens(scan, tokens)
    type(scanner_t), intent(inout) :: scan
    type(token_t), allocatable, intent(out) :: tokens(:)
    type(token_t), allocatable :: found(:), more(:)
    logical :: comma
    integer :: behind_comma, n
    allocate (found(8))
    n = 0
    comma = .true.
    behind_comma = 0
    do
      call skip_blanks(scan)
      if (at_end(scan)) exit
      if (scan%text(scan%at:scan%at) == ',') then
        if (comma) then
          scan%message = 'a value is missing before the comma'
          return
        end if
        comma = .true.
        scan%at = scan%at + 1
        behind_comma = scan%at
        cycle
      end if
      if (scan%text(scan%at:scan%at) == '/' .or. scan%text(scan%at:scan%at) == '&') exit
      if (key_is_next(scan)) exit
      if (n == most_values) scan%message = 'too many values'
      if (allocated(scan%message)) return
      if (n == size(found)) then
        allocate (more(2*n))
        more(:n) = found
        call move_alloc(more, found)
      end if
      n = n + 1
      found(n)%follows_comma = scan%at == behind_comma
      call read_token(scan, found(n))
      if (.not. (found(n)%quoted .or. allocated(scan%message))) call read_unit(scan, found(n)%text)
      if (allocated(scan%message)) return
      comma = .false.
    end do
    tokens = found(:n)
    if (n == 0) scan%message = 'a value is missing'
  end subroutine read_tokens

  !> Read one value: a quoted string, a word or a number, with its repeat count.
  subroutine read_token(scan, token)
    type(scanner_t), intent(inout) :: scan
    type(token_t), intent(inout) :: token
    integer :: length, star
    if (.not. next_is(scan, '''') .and. .not. next_is(scan, '"')) then
      length = bare_length(scan)
      if (length == 0) then
        scan%message = 'unexpected '//piece(scan)
        return
      end if
      token%text = scan%text(scan%at:scan%at + length - 1)
      call refuse_typography(scan, token%text)
      if (allocated(scan%message)) return
      scan%at = scan%at + length
      star = index(token%text, '*')
      if (star < 2) return
      if (verify(token%text(:star - 1), digits) > 0) return
      token%repeat = 0
      if (star <= 5) read (token%text(:star - 1), *) token%repeat
      if (token%repeat == 0) then
        scan%message = 'repeat count out of range: '//printable(token%text, shown)
        return
      end if
      token%text = token%text(star + 1:)
      if (token%text /= '') return
      if (.not. next_is(scan, '''') .and. .not. next_is(scan, '"')) then
        scan%message = 'a value is missing after the repeat count'
        return
      end if
    end if
    call read_string(scan, token)
  end subroutine read_token

  !> Refuse quotation marks and dashes of word processors, and bytes that are not UTF-8, in a value without quotes.
  pure subroutine refuse_typography(scan, text)
    type(scanner_t), intent(inout) :: scan
    character(len=*), intent(in) :: text
    character(len=*), parameter :: general = char(226)//char(128)   ! U+2010 to U+203F but for the last byte
    integer :: at, i
    at = index(text, general) + len(general)
    if (at > len(general) .and. at <= len(text)) then
      select case (ichar(text(at:at)))
      case (144:149)
        scan%message = printable(text, shown)//' has a dash: write -'
      case (152:159)
        scan%message = printable(text, shown)//' has a typographic quotation mark: write '' or "'
      case default   ! no mark that is mistaken for one of ASCII
      end select
    else if (index(text, char(226)//char(136)//char(146)) > 0) then
      scan%message = printable(text, shown)//' has a minus sign of typography: write -'
    else if (.not. is_clean(text) .and. maxval(ichar([(text(i:i), i=1, len(text))])) > 127) then
      scan%message = printable(text, shown)//': not UTF-8: save the file in this encoding'
    end if
  end subroutine refuse_typography

  !> Read the unit of a number that is not glued to it, and the further words of a unit, as in N m, each behind one blank.
  subroutine read_unit(scan, text)
    type(scanner_t), intent(inout) :: scan
    character(len=:), allocatable, intent(inout) :: text
    character(len=:), allocatable :: number, unit, word
    if (verify(text, '+-.0123456789') == 1 .or. verify(text, '+-.') == 0) return
    call split_number(text, number, unit)
    if (unit == '' .and. verify(text, '+-.0123456789eEdDqQ') > 0) return   ! not a number
    do while (word_is_next(scan))
      if (key_is_next(scan)) return
      word = scan%text(scan%at:scan%at + bare_length(scan) - 1)
      if (index(word, '_') > 0) then
        scan%message = printable(text, shown)//': unexpected '//printable(word, shown)
        return
      end if
      text = text//' '//word
      scan%at = scan%at + len(word)
    end do
  end subroutine read_unit

  !> Read a string in single or double quotes; a doubled quote stands for one. It must end on the line on which it begins.
  subroutine read_string(scan, token)
    type(scanner_t), intent(inout) :: scan
    type(token_t), intent(inout) :: token
    character(len=1) :: quote
    integer :: start, last, length
    start = scan%at
    last = start + rest_of_line(scan) - 1
    quote = scan%text(start:start)
    token%quoted = .true.
    token%text = ''
    do
      scan%at = scan%at + 1
      length = index(scan%text(scan%at:last), quote) - 1
      if (length < 0) exit
      token%text = token%text//scan%text(scan%at:scan%at + length - 1)
      scan%at = scan%at + length + 1
      if (.not. next_is(scan, quote)) return
      token%text = token%text//quote
    end do
    scan%at = start
    scan%message = 'the string is not closed on its line: '//piece(scan)
  end subroutine read_string

  !> Whether a key begins here and not a value: a name, possibly with an index in parentheses, followed by =.
  logical function key_is_next(scan) result(found)
    type(scanner_t), intent(inout) :: scan
    integer :: at, line
    at = scan%at
    line = scan%line
    found = .false.
    if (name_here(scan) /= '') then
      call skip_blanks(scan)
      if (next_is(scan, '(')) scan%at = scan%at + index(scan%text(scan%at:scan%at + rest_of_line(scan) - 1), ')')
      call skip_blanks(scan)
      found = next_is(scan, '=')
    end if
    scan%at = at
    scan%line = line
  end function key_is_next
end module namelist_reader
