!> Single numbers as text. For tables of results see `number_writer`.
module number_text
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use gudgeon_kinds, only: dp
  use number_writer, only: append_formatted, longest_number
  use text_tools, only: whole_number
  implicit none
  private
  public :: real_text, short_text

contains

  !> A real with `digits` significant digits (default 10, as in a summary), as 1.234567890E-05; with 17 it reads back as the same
  !> bits.
  pure function real_text(value, digits) result(text)
    real(dp), intent(in) :: value
    integer, intent(in), optional :: digits
    character(len=:), allocatable :: text
    character(len=longest_number) :: line
    integer :: wanted, used
    wanted = 10
    if (present(digits)) wanted = digits
    used = 0
    call append_formatted(line, used, value, wanted)
    text = line(:used)
    if (ieee_is_nan(value)) text = 'nan'
    if (abs(value) > huge(value)) text = trim(merge('-inf', 'inf ', value < 0))
  end function real_text

  !> A real for messages: 6 significant digits without trailing zeros, as 0.0125 or 36000.5 if that is short.
  pure function short_text(value) result(text)
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    character(len=:), allocatable :: digits
    integer :: first, exponent, power
    text = real_text(value, 6)
    exponent = index(text, 'E')
    if (exponent == 0) return
    power = int(whole_number(text(exponent + 1:)))
    if (power < -4 .or. power > 5) then
      text = without_zeros(text(:exponent - 1))//text(exponent:)
      return
    end if
    first = scan(text, '0123456789')
    digits = text(first:first)//text(first + 2:exponent - 1)
    if (power < 0) then
      text = text(:first - 1)//without_zeros('0.'//repeat('0', -power - 1)//digits)
    else
      text = text(:first - 1)//without_zeros(digits(:power + 1)//'.'//digits(power + 2:))
    end if
  end function short_text

  !> A number with a decimal point, without trailing zeros and without a trailing point.
  pure function without_zeros(number) result(text)
    character(len=*), intent(in) :: number
    character(len=:), allocatable :: text
    integer :: last
    last = verify(number, '0', back=.true.)
    if (number(last:last) == '.') last = last - 1
    text = number(:last)
  end function without_zeros
end module number_text
