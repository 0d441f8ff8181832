!> The value of one key of a case: conversion from text, comparison with its default and its range.
module case_value
  use gudgeon_kinds, only: dp
  use text_tools, only: lowercase, printable, is_clean
  use case_schema, only: key_t, is_listed, real_kind, integer_kind, logical_kind, word_kind
  use namelist_reader, only: token_t
  use value_reader, only: read_real, read_integer, read_logical
  implicit none
  private
  public :: value_t, set_to_default, convert, find_decimal_comma, is_default, unit_of, most_reals

  integer, parameter :: most_reals = 2   !! longest array of reals in the schema
  integer, parameter :: longest_text = 4000

  !> The value of one key, in the component of the key's kind.
  type :: value_t
    logical :: given(most_reals) = .false.   !! set in the file or by an override, not by default
    logical :: is_override = .false.         !! set by an override
    logical :: replaces = .false.            !! an override that replaces a different value of the file
    real(dp) :: reals(most_reals) = 0
    integer :: whole = 0
    logical :: switch = .false.
    character(len=:), allocatable :: text
    character(len=48) :: written(most_reals) = ''   !! as the user wrote it, for messages
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
    do element = 1, min(key%count, most_reals)
      call convert(key, token, value, element, wanted)
    end do
  end subroutine set_to_default

  !> Convert a text to a value of the key's kind; if that is not possible, `wanted` says what is allowed.
  subroutine convert(key, token, value, element, wanted)
    type(key_t), intent(in) :: key
    type(token_t), intent(in) :: token
    type(value_t), intent(inout) :: value
    integer, intent(in) :: element
    character(len=:), allocatable, intent(out) :: wanted
    select case (key%kind)
    case (real_kind)
      call read_real(token%text, value%reals(element), wanted)
      if (token%quoted) wanted = 'must be a number, without quotes'
    case (integer_kind)
      call read_integer(token%text, value%whole, wanted)
      if (token%quoted) wanted = 'must be a whole number, without quotes'
    case (logical_kind)
      call read_logical(token%text, value%switch, wanted)
      if (token%quoted) wanted = 'must be .true. or .false., without quotes'
    case (word_kind)
      value%text = trim(lowercase(token%text))
      if (.not. is_listed(value%text, key%words) .and. value%text /= key%default) wanted = 'must be one of '// &
        key%words
    case default
      if (.not. is_clean(token%text)) wanted = 'must not contain control characters or bytes that are not UTF-8'
      if (element > 1 .and. key%count > 1 .and. token%quoted) then
        value%text = value%text//','//token%text
      else
        value%text = token%text
      end if
      if (len(value%text) > longest_text) wanted = 'must be at most 4000 bytes'
    end select
  end subroutine convert

  !> Detect decimal commas: texts such as 0,05 are read as two values. `wanted` is set if a key that takes `count` values has twice
  !> as many that look like this.
  pure subroutine find_decimal_comma(tokens, count, wanted)
    type(token_t), intent(in) :: tokens(:)
    integer, intent(in) :: count
    character(len=:), allocatable, intent(inout) :: wanted
    character(len=*), parameter :: digits = '0123456789'
    integer :: i
    if (size(tokens) /= 2*count .and. size(tokens) /= 2) return
    do i = 1, size(tokens), 2
      if (.not. tokens(i + 1)%follows_comma .or. tokens(i)%repeat > 1) return
      if (verify(tokens(i)%text, '+-'//digits) > 0 .or. verify(tokens(i + 1)%text, digits//'edED+-') > 0) return
      if (scan(tokens(i + 1)%text, digits) /= 1) return
    end do
    if (size(tokens) == count) then
      if (index(tokens(2)%text, '0') /= 1 .or. verify(tokens(2)%text//'.', digits) == 2) return
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
end module case_value
