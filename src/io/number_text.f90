!> Single numbers as text. Tables of results are made by `number_writer`.
module number_text
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: dp
  implicit none
  private
  public :: real_text, exact_text, short_text

contains

  !> A real for a summary: 10 significant digits, as 1.234567890E-05.
  pure function real_text(value) result(text)
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    text = scientific(value, '(es16.9e2)', '(es17.9e3)')
  end function real_text

  !> A real that reads back as the same bits: 17 significant digits.
  pure function exact_text(value) result(text)
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    text = scientific(value, '(es23.16e2)', '(es24.16e3)')
  end function exact_text

  !> A real for people: 6 significant digits, without the zeros at their end; as 0.0125 or 36000.5 where that is short.
  pure function short_text(value) result(text)
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    character(len=24) :: plain, form
    integer :: exponent, power, status
    text = scientific(value, '(es12.5e2)', '(es13.5e3)')
    exponent = index(text, 'E')
    if (exponent == 0) return
    read (text(exponent + 1:), *, iostat=status) power
    if (status == 0 .and. power >= -4 .and. power <= 5) then
      write (form, '(a,i0,a)') '(f24.', 5 - power, ')'
      write (plain, form) value
      text = without_zeros(trim(adjustl(plain)))
    else
      text = without_zeros(text(:exponent - 1))//text(exponent:)
    end if
  end function short_text

  !> A number with a point, without zeros at its end, or the point.
  pure function without_zeros(number) result(text)
    character(len=*), intent(in) :: number
    character(len=:), allocatable :: text
    integer :: last
    last = verify(number, '0', back=.true.)
    if (number(last:last) == '.') last = last - 1
    text = number(:last)
  end function without_zeros

  !> `wide` is the format for exponents of three digits.
  pure function scientific(value, usual, wide) result(text)
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: usual, wide
    character(len=:), allocatable :: text
    character(len=32) :: digits
    if (ieee_is_nan(value)) then
      text = 'nan'
    else if (abs(value) > huge(value)) then
      text = merge('-inf', 'inf ', value < 0)
      text = trim(text)
    else
      if (abs(value) < 1e90_dp .and. .not. (abs(value) > 0 .and. abs(value) < 1e-90_dp)) then
        write (digits, usual) value
      else
        write (digits, wide) value
      end if
      text = trim(adjustl(digits))
    end if
  end function scientific
end module number_text
