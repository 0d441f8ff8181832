!> One value of a case file, from its text to a number, and whether it lies in a range. A value that cannot be read
!> gives a message that says what is wanted; nothing here can overflow.
module value_reader
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use text_tools, only: lowercase, whole_number
  implicit none
  private
  public :: read_real, read_integer, read_logical, is_within

  character(len=*), parameter :: digits = '0123456789'
  integer, parameter :: largest_exponent = 30   !! reals are 0 or of a size from 1e-30 to 1e30: products stay finite

contains

  !> A real as Fortran writes them: 2, .5, 1d-5, 1.5E3.
  pure subroutine read_real(text, value, wanted)
    character(len=*), intent(in) :: text
    real(dp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    character(len=:), allocatable :: mantissa
    integer :: letter, exponent, whole, first, iostat
    logical :: is_read
    call read_short_real(text, value, is_read)
    if (is_read) return
    value = 0
    mantissa = lowercase(text)
    letter = scan(mantissa, 'edq')
    exponent = 0
    if (letter > 0) then
      if (.not. is_whole(mantissa(letter + 1:))) wanted = 'must be a number'
      if (len(mantissa) - letter > 8) wanted = out_of_reach()
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
    exponent = exponent + whole - first + merge(0, 1, first > whole)
    if (len(text) > 100 .or. exponent >= largest_exponent .or. exponent < -largest_exponent) then
      wanted = out_of_reach()
      return
    end if
    mantissa = lowercase(text)
    if (letter > 0) mantissa(letter:letter) = 'e'
    read (mantissa, *, iostat=iostat) value
    if (iostat /= 0) wanted = 'must be a number'
  end subroutine read_real

  !> The real that a text of few digits says, as nearly all are: both its significand and the power of ten are exact numbers, so
  !> their product or quotient is rounded as it should be (Clinger 1990). `is_read` is false of every other text.
  pure subroutine read_short_real(text, value, is_read)
    character(len=*), intent(in) :: text
    real(dp), intent(out) :: value
    logical, intent(out) :: is_read
    integer(int64), parameter :: fifteen_digits = 10_int64**14   !! the least number that has them
    integer, parameter :: largest_power = 22                     !! 5**22 < 2**53
    real(dp), parameter :: too_large = 10.0_dp**largest_exponent
    integer(int64) :: significand
    integer :: i, at, digit, behind_point, power
    real(dp), parameter :: powers(0:largest_power) = [(10.0_dp**i, i=0, largest_power)]
    logical :: has_digits, has_point, has_sign

    value = 0
    is_read = .false.
    has_digits = .false.
    has_point = .false.
    behind_point = 0
    power = 0
    significand = 0
    has_sign = scan(text, '+-') == 1
    do at = merge(2, 1, has_sign), len(text)
      digit = iachar(text(at:at)) - iachar('0')
      if (digit >= 0 .and. digit <= 9) then
        if (significand >= fifteen_digits) return
        significand = 10*significand + digit
        has_digits = .true.
        if (has_point) behind_point = behind_point + 1
      else if (text(at:at) == '.' .and. .not. has_point) then
        has_point = .true.
      else
        if (index('edqEDQ', text(at:at)) == 0 .or. len(text) - at > 8) return
        if (.not. is_whole(text(at + 1:))) return
        power = int(whole_number(text(at + 1:)))
        exit
      end if
    end do
    power = power - behind_point
    if (.not. has_digits .or. abs(power) > largest_power) return
    value = real(significand, dp)*powers(max(power, 0))/powers(max(-power, 0))
    if (value >= too_large) return
    if (has_sign .and. text(1:1) == '-' .and. significand > 0) value = -value
    is_read = .true.
  end subroutine read_short_real

  pure function out_of_reach() result(wanted)
    character(len=:), allocatable :: wanted
    wanted = 'must be 0 or of a size from 1e-30 to 1e30'
  end function out_of_reach

  pure subroutine read_integer(text, value, wanted)
    character(len=*), intent(in) :: text
    integer, intent(out) :: value
    character(len=:), allocatable, intent(out) :: wanted
    integer(int64) :: wide
    value = 0
    if (.not. is_whole(text)) then
      wanted = 'must be a whole number'
    else if (len(text) > 18) then
      wanted = 'must be a whole number up to 2147483647'
    else
      wide = whole_number(text)
      if (abs(wide) > huge(value)) then
        wanted = 'must be a whole number up to 2147483647'
      else
        value = int(wide)
      end if
    end if
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

  !> Whether a value lies in a range written as `> 0`, or `>= 0 and <= 0.5`.
  pure function is_within(value, range) result(within)
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: range
    logical :: within
    integer :: last
    within = .true.
    if (range == '') return
    last = index(range, ' and ')
    if (last > 0) then
      within = meets(value, range(:last - 1))
      if (within) within = meets(value, trim(range(last + 5:)))
    else
      within = meets(value, trim(range))
    end if
  end function is_within

  !> Whether a value meets one condition, an operator and a number with a blank between.
  pure function meets(value, condition) result(met)
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: condition
    logical :: met
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

  !> Digits, perhaps with a sign before them.
  pure function is_whole(text) result(whole)
    character(len=*), intent(in) :: text
    logical :: whole
    integer :: first
    first = 1
    if (scan(text, '+-') == 1) first = 2
    whole = len(text) >= first .and. verify(text(first:), digits) == 0
  end function is_whole
end module value_reader
