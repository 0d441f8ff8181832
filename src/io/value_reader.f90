!> Converts a value of a case file from text to a number, and checks whether it is in a range. If a text cannot be converted, a
!> message says what is required; no input can cause an overflow.
module value_reader
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use text_tools, only: lowercase, whole_number
  implicit none
  private
  public :: read_real, read_integer, read_logical, is_within

  character(len=*), parameter :: digits = '0123456789'
  integer, parameter :: largest_exponent = 30   !! reals are 0 or between 1e-30 and 1e30 in magnitude, so that products stay finite
  character(len=*), parameter :: out_of_reach = 'must be 0 or of a size from 1e-30 to 1e30'

contains

  !> Read a real in Fortran notation: 2, .5, 1d-5, 1.5E3.
  pure subroutine read_real(text, value, wanted)
    character(len=*), intent(in) :: text
    real(dp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    character(len=:), allocatable :: mantissa
    integer :: letter, exponent, whole, first, iostat
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
    if (len(text) > 100 .or. exponent >= largest_exponent .or. exponent < -largest_exponent) then
      wanted = out_of_reach
      return
    end if
    mantissa = lowercase(text)
    if (letter > 0) mantissa(letter:letter) = 'e'
    read (mantissa, *, iostat=iostat) value
    if (iostat /= 0) wanted = 'must be a number'
  end subroutine read_real

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
