!> The value of one key of a case: conversion from text, comparison with its default and with a range. If a text cannot be
!> converted, a message says what is required; no input can cause an overflow.
module value_reader
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use text_tools, only: lowercase, printable, is_clean, whole_number, likely_word
  use case_schema, only: key_t, is_listed, real_kind, integer_kind, logical_kind, word_kind
  use namelist_reader, only: token_t
  use number_text, only: exact_text
  use physical_units, only: unit_t, split_number, find_unit, shifted
  implicit none
  private
  public :: value_t, n_values, set_to_default, convert, convert_list, find_decimal_comma, is_default, unit_of, has_unit, most_reals
  public :: read_real, read_numbers, read_times, read_integer, is_within, read_bounds

  integer, parameter :: most_reals = 16  !! longest list of reals in the schema
  integer, parameter :: longest_text = 4000
  integer, parameter :: most_times = 10000   !! longest list of times
  character(len=*), parameter :: digits = '0123456789'
  integer, parameter :: largest_exponent = 30   !! reals are 0 or between 1e-30 and 1e30 in magnitude, so that products stay finite
  character(len=*), parameter :: out_of_reach = 'must be 0 or of a size from 1e-30 to 1e30'

  !> The value of one key, in the component of the key's kind.
  type :: value_t
    logical :: given(most_reals) = .false.   !! set in the file or by an override, not by default
    logical :: is_override = .false.         !! set by an override
    logical :: replaces = .false.            !! an override that replaces a different value of the file
    real(dp) :: reals(most_reals) = 0
    integer :: whole = 0                     !! of a list the number of its reals
    logical :: switch = .false.
    character(len=:), allocatable :: text
    character(len=70) :: written(most_reals) = ''   !! as the user wrote it, for messages
    logical :: has_unit = .false.            !! it was written with a unit
    integer :: line = 0                      !! line of the file on which it is given
  end type value_t

contains

  !> Set a value to the default of its key, and mark it as not given.
  subroutine set_to_default(key, value)
    type(key_t), intent(in) :: key
    type(value_t), intent(out) :: value
    character(len=:), allocatable :: wanted
    type(token_t) :: token
    integer :: element
    value%text = ''
    if (key%required) return
    token%text = trim(key%default)
    do element = 1, merge(1, min(key%count, most_reals), key%is_list)
      call convert(key, token, value, element, wanted)
    end do
  end subroutine set_to_default

  !> Number of the values of a key.
  pure integer function n_values(key, value)
    type(key_t), intent(in) :: key
    type(value_t), intent(in) :: value
    n_values = merge(value%whole, key%count, key%is_list)
  end function n_values

  !> Convert a text to a value of the key's kind; if that is not possible, `wanted` says what is allowed, with the unit of the key.
  subroutine convert(key, token, value, element, wanted)
    type(key_t), intent(in) :: key
    type(token_t), intent(in) :: token
    type(value_t), intent(inout) :: value
    integer, intent(in) :: element
    character(len=:), allocatable, intent(out) :: wanted
    select case (key%kind)
    case (real_kind)
      if (key%is_list) value%whole = element
      value%has_unit = has_unit(token%text) .and. .not. token%quoted
      if (token%quoted) then
        wanted = 'must be a number, without quotes'
      else if (value%has_unit) then
        call read_with_unit(token%text, key, value%reals(element), wanted)
        return
      else
        call read_real(token%text, value%reals(element), wanted)
      end if
    case (integer_kind)
      call read_integer(token%text, value%whole, wanted)
      if (token%quoted) wanted = 'must be a whole number, without quotes'
    case (logical_kind)
      call read_logical(token%text, value%switch, wanted)
      if (token%quoted) wanted = 'must be .true. or .false., without quotes'
    case (word_kind)
      value%text = trim(lowercase(token%text))
      if (.not. is_listed(value%text, key%words) .and. value%text /= key%default) wanted = 'must be one of '// &
        key%words//likely_word(value%text, key%words)
    case default
      if (.not. is_clean(token%text)) wanted = 'must not contain control characters or bytes that are not UTF-8'
      if (element > 1 .and. key%count > 1 .and. token%quoted) then
        value%text = value%text//','//token%text
      else
        value%text = token%text
      end if
      if (len(value%text) > longest_text) wanted = 'must be at most 4000 bytes'
    end select
    if (allocated(wanted)) wanted = wanted//unit_of(key)
  end subroutine convert

  !> Whether a text is a number with a unit.
  pure logical function has_unit(text)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: number, unit
    call split_number(text, number, unit)
    has_unit = unit /= ''
  end function has_unit

  !> Read a number with a unit that belongs to the key. If only the power of ten differs, the value has the bits of the number as it
  !> would be written in the unit of the key.
  pure subroutine read_with_unit(text, key, value, wanted)
    character(len=*), intent(in) :: text
    type(key_t), intent(in) :: key
    real(dp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    character(len=:), allocatable :: number, unit
    type(unit_t) :: found
    value = 0
    call split_number(text, number, unit)
    call find_unit(unit, trim(key%unit), trim(key%name), found, wanted)
    if (.not. allocated(wanted)) call read_real(shifted(number, found%power), value, wanted)
    value = (value + found%offset)*found%factor
    if (allocated(wanted) .or. .not. abs(value) > 0) return
    if (.not. (abs(value) >= 10.0_dp**(-largest_exponent) .and. abs(value) < 10.0_dp**largest_exponent)) wanted = out_of_reach
  end subroutine read_with_unit

  !> Replace the numbers with units in a list, which commas separate, by numbers in the unit of the key; other parts stay.
  pure subroutine convert_list(text, key, wanted)
    character(len=:), allocatable, intent(inout) :: text
    type(key_t), intent(in) :: key
    character(len=:), allocatable, intent(out) :: wanted
    character(len=:), allocatable :: list, part
    real(dp) :: value
    integer :: first, length
    list = ''
    first = 1
    do while (first <= len(text) + 1)
      length = index(text(first:)//',', ',') - 1
      part = text(first:first + length - 1)
      if (has_unit(trim(adjustl(part))) .and. key%kind == real_kind .and. key%count == 1) then
        call read_with_unit(trim(adjustl(part)), key, value, wanted)
        if (allocated(wanted)) wanted = printable(trim(adjustl(part)), 40)//': '//wanted
        if (allocated(wanted)) return
        part = exact_text(value)
      end if
      list = list//','//part
      first = first + length + 1
    end do
    text = list(2:)
  end subroutine convert_list

  !> Detect decimal commas: texts such as 0,05 are read as two values. `wanted` is set if a key that takes `count` values has twice
  !> as many that look like this.
  pure subroutine find_decimal_comma(tokens, count, wanted)
    type(token_t), intent(in) :: tokens(:)
    integer, intent(in) :: count
    character(len=:), allocatable, intent(inout) :: wanted
    character(len=:), allocatable :: number, unit
    integer :: i
    if (size(tokens) /= 2*count .and. size(tokens) /= 2) return
    do i = 1, size(tokens), 2
      if (.not. tokens(i + 1)%follows_comma .or. tokens(i)%repeat > 1) return
      call split_number(tokens(i + 1)%text, number, unit)
      if (verify(tokens(i)%text, '+-'//digits) > 0 .or. verify(number, digits//'edED+-') > 0) return
      if (scan(tokens(i + 1)%text, digits) /= 1) return
    end do
    if (size(tokens) == count) then
      if (index(tokens(2)%text, '0') /= 1 .or. verify(number//'.', digits) == 2) return
    end if
    wanted = printable(tokens(1)%text//','//tokens(2)%text, 40)//' has a decimal comma: write '// &
      printable(tokens(1)%text//'.'//tokens(2)%text, 40)
  end subroutine find_decimal_comma

  !> Whether a number equals the default of its key, however it is written.
  logical function is_default(key, value, element) result(same)
    type(key_t), intent(in) :: key
    type(value_t), intent(in) :: value
    integer, intent(in) :: element
    type(value_t) :: default
    type(token_t) :: token
    character(len=:), allocatable :: wanted
    same = .false.
    if (key%required) return
    token%text = trim(key%default)
    call convert(key, token, default, element, wanted)
    if (key%kind == real_kind) then
      same = .not. abs(value%reals(element) - default%reals(element)) > 0
    else
      same = value%whole == default%whole
    end if
  end function is_default

  !> ` (m)`, or an empty text for a key without unit.
  pure function unit_of(key) result(text)
    type(key_t), intent(in) :: key
    character(len=:), allocatable :: text
    text = ''
    if (key%unit /= '') text = ' ('//trim(key%unit)//')'
  end function unit_of

  !> Read a real in Fortran notation: 2, .5, 1d-5, 1.5E3.
  pure subroutine read_real(text, value, wanted, may_be_tiny)
    character(len=*), intent(in) :: text
    real(dp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    logical, intent(in), optional :: may_be_tiny   !! smaller than 1e-30, as computed forces in tables
    character(len=:), allocatable :: mantissa
    integer :: letter, exponent, whole, first, iostat
    logical :: is_tiny
    value = 0
    mantissa = lowercase(text)
    letter = scan(mantissa, 'edq')
    exponent = 0
    if (letter > 0) then
      if (.not. is_whole(mantissa(letter + 1:))) wanted = 'must be a number'
      if (len(mantissa) - letter > 8) wanted = out_of_reach
      if (allocated(wanted)) return
      exponent = int(whole_number(mantissa(letter + 1:)))
      mantissa = mantissa(:letter - 1)
    end if
    if (scan(mantissa, '+-') == 1) mantissa = mantissa(2:)
    whole = index(mantissa//'.', '.') - 1
    if (verify(mantissa(:whole)//mantissa(whole + 2:), digits) > 0 .or. scan(mantissa, digits) == 0) then
      wanted = 'must be a number'
      if (index('infinity', mantissa) == 1 .and. len(mantissa) >= 3 .or. index(mantissa, 'nan') == 1) &
        wanted = 'must be a finite number'
      return
    end if
    first = scan(mantissa, '123456789')
    if (first == 0) return
    exponent = exponent + whole - first + merge(1, 0, first > whole)   ! exponent of the first digit that is not 0
    is_tiny = exponent < -largest_exponent
    if (present(may_be_tiny)) is_tiny = is_tiny .and. .not. may_be_tiny
    if (len(text) > 100 .or. exponent >= largest_exponent .or. is_tiny) then
      wanted = out_of_reach
      return
    end if
    mantissa = lowercase(text)
    if (letter > 0) mantissa(letter:letter) = 'e'
    read (mantissa, *, iostat=iostat) value
    if (iostat /= 0) wanted = 'must be a number'
  end subroutine read_real

  !> Read times from a text: numbers separated by commas, in rising order, or first:last:count. Not allocated if the text is
  !> neither.
  pure subroutine read_times(text, times)
    character(len=*), intent(in) :: text
    real(dp), allocatable, intent(out) :: times(:)
    real(dp) :: numbers(most_times)
    logical :: all_read
    integer :: n, count, i
    if (scan(text, ':') > 0) then
      call read_numbers(text, ':', numbers, n, all_read)
      if (.not. all_read .or. n /= 3) return
      if (.not. (numbers(1) >= 0 .and. numbers(2) > numbers(1))) return
      if (.not. (numbers(3) >= 2 .and. numbers(3) <= most_times)) return
      count = nint(numbers(3))
      if (abs(numbers(3) - count) > 0) return
      times = [(numbers(1) + (numbers(2) - numbers(1))*(i - 1)/(count - 1), i=1, count)]
      return
    end if
    call read_numbers(text, ',', numbers, n, all_read)
    if (.not. all_read) return
    if (any(numbers(:n) < 0) .or. any(numbers(2:n) <= numbers(:n - 1))) return
    times = numbers(:n)
  end subroutine read_times

  !> Read the numbers of a text that a character separates, as many as `numbers` can hold.
  pure subroutine read_numbers(text, separator, numbers, n, all_read)
    character(len=*), intent(in) :: text
    character, intent(in) :: separator
    real(dp), intent(out) :: numbers(:)
    integer, intent(out) :: n
    logical, intent(out) :: all_read   !! each part of the text is one number, and there are not too many
    character(len=:), allocatable :: part, wanted
    integer :: first, after
    n = 0
    numbers = 0
    all_read = .false.
    first = 1
    do while (first <= len(text) + 1)
      after = index(text(first:), separator) + first - 1
      if (after < first) after = len(text) + 1
      part = trim(adjustl(text(first:after - 1)))
      if (n == size(numbers)) return
      n = n + 1
      call read_real(part, numbers(n), wanted)
      if (allocated(wanted)) return
      first = after + 1
    end do
    all_read = .true.
  end subroutine read_numbers

  pure subroutine read_integer(text, value, wanted)
    character(len=*), intent(in) :: text
    integer, intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    integer(int64) :: wide
    value = 0
    if (.not. is_whole(text)) then
      wanted = 'must be a whole number'
      return
    end if
    wide = huge(wide)   ! too large
    if (len(text) <= 18) wide = whole_number(text)
    if (abs(wide) <= huge(value)) value = int(wide)
    if (abs(wide) > huge(value)) wanted = 'must be a whole number up to 2147483647'
  end subroutine read_integer

  pure subroutine read_logical(text, value, wanted)
    character(len=*), intent(in) :: text
    logical, intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    value = .false.
    select case (lowercase(text))
    case ('.true.', 'true', '.t.', 't')
      value = .true.
    case ('.false.', 'false', '.f.', 'f')
    case default
      wanted = 'must be .true. or .false.'
    end select
  end subroutine read_logical

  !> Whether a value is in a range written as `> 0`, or `>= 0 and <= 0.5`.
  pure recursive logical function is_within(value, range) result(within)
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: range
    integer :: length
    within = range == ''
    if (within) return
    length = index(range//' and ', ' and ') - 1
    within = meets(value, trim(range(:length)))
    if (within) within = is_within(value, range(length + 6:))
  end function is_within

  !> The bounds in a text such as `1e-6 to 1e-3`.
  pure subroutine read_bounds(text, least, most)
    character(len=*), intent(in) :: text
    real(dp), intent(out) :: least, most
    character(len=*), parameter :: to = ' to '
    character(len=:), allocatable :: wanted
    integer :: at
    at = index(text, to)
    call read_real(text(:at - 1), least, wanted)
    call read_real(text(at + len(to):), most, wanted)
  end subroutine read_bounds

  !> Whether a value meets one condition: an operator and a number, separated by a blank.
  pure logical function meets(value, condition) result(met)
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: condition
    character(len=:), allocatable :: wanted
    real(dp) :: bound
    integer :: blank
    blank = index(condition, ' ')
    call read_real(condition(blank + 1:), bound, wanted)
    select case (condition(:blank - 1))
    case ('>')
      met = value > bound
    case ('>=')
      met = value >= bound
    case ('<')
      met = value < bound
    case default
      met = value <= bound
    end select
  end function meets

  !> Whether a text consists of digits, possibly with a sign.
  pure logical function is_whole(text) result(whole)
    character(len=*), intent(in) :: text
    integer :: first
    first = 1
    if (scan(text, '+-') == 1) first = 2
    whole = len(text) >= first .and. verify(text(first:), digits) == 0
  end function is_whole
end module value_reader
