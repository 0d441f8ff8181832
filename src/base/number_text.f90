!> Reals as decimal text: single numbers, and tables of results, written by a `number_writer_t` with the same digits as a formatted
!> write, about a hundred times faster.
!>
!> The digits of a number between 10**k and 10**(k + 1) are the whole part of its product with 10**(digits - 1 - k), rounded. The
!> product is computed from the number's significand, shifted left by the difference of the binary exponents of the number and of
!> 10**k, and a factor for the decade, as a fixed-point number with `fraction_bits` fractional bits. If the error of the product
!> leaves the rounding of the last digit open, as in a tie, a formatted write is used; it is also used for numbers below 10**(-307)
!> and for values that are not finite.
module number_text
  use, intrinsic :: iso_fortran_env, only: int64
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: dp
  use text_tools, only: whole_number, integer_text
  implicit none
  private
  public :: real_text, short_text, exact_text, quantity_text, number_writer_t, append_formatted, longest_number, &
    fewest_digits, most_digits

  integer, parameter :: fewest_digits = 6, most_digits = 17   !! significant digits
  integer, parameter :: longest_number = most_digits + 9      !! characters, as -1.2345678901234567E-100, with trailing blanks
  integer, parameter :: first_decade = -307, last_decade = 309   !! the last decade with numbers, plus one
  integer, parameter :: fraction_bits = 60
  integer, parameter :: wide = selected_int_kind(38)          !! holds the product of two int64

  !> The constants for numbers of one decade k.
  type :: decade_t
    integer(int64) :: least          !! bits of the smallest number of the decade
    integer(int64) :: high, low      !! its factor is high 2**63 + low, truncated
    character(len=8) :: ending       !! E-05, with a third digit if necessary, and a comma
    integer :: ending_length
  end type decade_t

  !> Writes reals with a fixed number of significant digits: 1.234567890E-05, -1.234567890E+100, NaN, Infinity.
  type :: number_writer_t
    private
    integer :: digits = 0
    integer(int64) :: too_large = 0       !! 10**digits
    integer(int64) :: to_sixteen = 1      !! 10**(16 - digits), if that is a whole number
    type(decade_t) :: decades(first_decade:last_decade)
  contains
    procedure :: prepare
    procedure :: append
    procedure :: append_list
  end type number_writer_t

contains

  !> Set the number of significant digits and compute the table. Must be called first.
  pure subroutine prepare(self, digits)
    class(number_writer_t), intent(inout) :: self
    integer, intent(in) :: digits   !! fewest_digits to most_digits
    integer, parameter :: first = first_decade, last = most_digits - 1 - first_decade
    integer(wide), parameter :: one = 1
    integer(wide) :: powers(first:last)   !! the first 126 bits of 10**k; the first bit has the value 2**exponents(k)
    integer(wide) :: factor
    integer :: exponents(first:last), k

    powers(0) = shiftl(one, 125)
    exponents(0) = 0
    do k = 1, last
      powers(k) = powers(k - 1) + shiftr(powers(k - 1), 2)
      exponents(k) = exponents(k - 1) + 3
      call normalise(powers(k), exponents(k))
    end do
    do k = -1, first, -1
      powers(k) = powers(k + 1) + 3*(powers(k + 1)/5)
      exponents(k) = exponents(k + 1) - 4
      call normalise(powers(k), exponents(k))
    end do
    self%digits = digits
    self%too_large = 10_int64**digits
    self%to_sixteen = 10_int64**max(0, 16 - digits)
    self%decades(last_decade)%least = huge(0_int64)   ! larger than any number
    do k = first_decade, last_decade - 1
      associate (decade => self%decades(k))
        decade%least = shiftl(int(exponents(k) + 1022, int64), 52) + int(shiftr(powers(k), 73), int64)  ! the first bit adds 1
                                                                                                        ! the exponent
        if (iand(powers(k), shiftl(one, 73) - 1) > 0) decade%least = decade%least + 1
        factor = shiftr(powers(digits - 1 - k), 125 + 52 - 63 - fraction_bits - exponents(k) - exponents(digits - 1 - k))
        decade%high = int(shiftr(factor, 63), int64)
        decade%low = int(iand(factor, shiftl(one, 63) - 1), int64)
        decade%ending = merge('E-', 'E+', k < 0)//achar(48 + abs(k)/100)//achar(48 + mod(abs(k)/10, 10))// &
          achar(48 + mod(abs(k), 10))//','
        if (abs(k) < 100) decade%ending(3:) = decade%ending(4:)
        decade%ending_length = len_trim(decade%ending)
      end associate
    end do
  end subroutine prepare

  !> Halve a power that has grown beyond its number of bits.
  pure subroutine normalise(power, exponent)
    integer(wide), intent(inout) :: power
    integer, intent(inout) :: exponent
    if (.not. btest(power, 126)) return
    power = shiftr(power, 1)
    exponent = exponent + 1
  end subroutine normalise

  !> Append a real to the first `used` characters of a line that has room for `longest_number` more. Negative zero is written
  !> without sign.
  pure subroutine append(self, line, used, value)
    class(number_writer_t), intent(in) :: self
    character(len=*), intent(inout) :: line
    integer, intent(inout) :: used
    real(dp), intent(in) :: value
    character(len=longest_number + 1) :: field
    integer :: length
    length = 0
    call self%append_list(field, length, [value])
    line(used + 1:used + length - 1) = field(:length - 1)
    used = used + length - 1
  end subroutine append

  !> Append values, each followed by a comma, to the first `used` characters of a text that has room for `longest_number` + 1 more
  !> characters for each of them.
  !>
  !> Everything that depends on the value is computed or taken from tables without branches, since a mispredicted branch costs as
  !> much as all the rest. The product is too small by less than 2: the error of the powers of ten is less than 2**(-117) of them,
  !> which is less than 0.8 for a product below 10**17 2**60, and truncation adds less than 1.1.
  pure subroutine append_list(self, text, used, values)
    class(number_writer_t), intent(in) :: self
    character(len=*), intent(inout) :: text
    integer, intent(inout) :: used
    real(dp), intent(in), contiguous :: values(:)
    integer(int64), parameter :: hidden_bit = 2_int64**52, half = 2_int64**(fraction_bits - 1), short_by = 3  !! bound of that
                                                                                                              !! error, plus one
    integer(int64) :: bits, significand, whole
    integer(wide) :: product
    integer :: i, k, binade, at
    logical :: is_decided

    at = used
    do i = 1, size(values)
      bits = iand(transfer(values(i), bits), huge(bits))
      binade = int(shiftr(bits, 52)) - 1023
      whole = 0
      k = 0
      is_decided = bits == 0
      if (bits >= self%decades(first_decade)%least .and. binade < 1024) then
        k = shifta(binade*78913, 18) + 1   ! floor(log10(2**binade)) + 1
        k = k + int(shifta(bits - self%decades(k)%least, 63))
        associate (decade => self%decades(k))
          significand = ior(iand(bits, hidden_bit - 1), hidden_bit)
          significand = shiftl(significand, binade + 1023 - int(shiftr(decade%least, 52)))
          product = int(significand, wide)*decade%high + shiftr(int(significand, wide)*decade%low, 63) + (half + short_by)
          whole = int(shiftr(product, fraction_bits), int64)
          is_decided = iand(product, int(2*half - 1, wide)) > short_by .and. whole < self%too_large
        end associate
      end if
      if (is_decided) then
        if (bits > 0) then
          text(at + 1:at + 1) = '-'
          at = at - int(shifta(transfer(values(i), bits), 63))
        end if
        if (self%digits < 17) then
          call write_sixteen(whole*self%to_sixteen, text(at + 1:at + 18))
        else
          call write_sixteen(whole/10, text(at + 1:at + 18))
          text(at + 18:at + 18) = achar(48 + int(mod(whole, 10_int64)))
        end if
        at = at + self%digits + 1
        text(at + 1:at + 8) = self%decades(k)%ending
        at = at + self%decades(k)%ending_length
      else
        call append_formatted(text, at, values(i), self%digits)
        at = at + 1
        text(at:at) = ','
      end if
    end do
    used = at
  end subroutine append_list

  !> Write sixteen digits with a point after the first, and a blank, from the number as a fraction of 53 bits that is too large by
  !> less than 1.1 units of the last bit. Its whole part is the first digit; each multiplication by a thousand gives three more.
  pure subroutine write_sixteen(number, text)
    integer(int64), value :: number
    character(len=18), intent(inout) :: text
    integer(wide), parameter :: scale = 5192296858534827629_int64   !! 2**112/10**15, rounded up
    integer(int64), parameter :: mask = 2_int64**53 - 1
    integer(int64) :: fraction
    integer :: i, j, k
    character(len=4), parameter :: triples(0:999) = &   !! the numbers 000 to 999, each followed by a blank
      [(((achar(48 + i)//achar(48 + j)//achar(48 + k)//' ', k=0, 9), j=0, 9), i=0, 9)]
    fraction = int(shiftr(scale*number, 59), int64) + 1
    text(1:1) = achar(48 + int(shiftr(fraction, 53)))
    text(2:2) = '.'
    do i = 3, 15, 3
      fraction = 1000*iand(fraction, mask)
      text(i:i + 3) = triples(shiftr(fraction, 53))
    end do
  end subroutine write_sixteen

  !> Append a real in the form of `append` with a formatted write. Negative zero keeps its sign.
  pure subroutine append_formatted(line, used, value, digits)
    character(len=*), intent(inout) :: line
    integer, intent(inout) :: used
    real(dp), intent(in) :: value
    integer, intent(in) :: digits
    character(len=11) :: form
    character(len=longest_number) :: text
    integer, parameter :: hundreds = longest_number - 2   !! position of the three digits of the exponent
    integer :: first
    form = '(es'//two_digits(longest_number)//'.'//two_digits(digits - 1)//'e3)'
    write (text, form) value
    if (text(hundreds:hundreds) == '0') text = ' '//text(:hundreds - 1)//text(hundreds + 1:)
    first = verify(text, ' ')
    line(used + 1:used + 1 + longest_number - first) = text(first:)
    used = used + 1 + longest_number - first
  end subroutine append_formatted

  !> A number from 0 to 99 with two digits.
  pure character(len=2) function two_digits(number)
    integer, intent(in) :: number
    two_digits = achar(48 + number/10)//achar(48 + mod(number, 10))
  end function two_digits

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

  !> A real for messages: at most 6 (or `digits`) significant digits, without trailing zeros, as 0.0125, 36000.5 or 1.5e-7.
  pure function short_text(value, digits) result(text)
    real(dp), intent(in) :: value
    integer, intent(in), optional :: digits
    character(len=:), allocatable :: text
    integer :: wanted
    wanted = fewest_digits
    if (present(digits)) wanted = digits
    text = plain_text(real_text(value, wanted))
  end function short_text

  !> A value with a unit that makes it readable, in three (or `digits`) digits: 4.22 um, 3.61 kN, 100 ms.
  pure function quantity_text(value, unit, digits) result(text)
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: unit   !! of the value
    integer, intent(in), optional :: digits
    character(len=:), allocatable :: text
    character(len=1), parameter :: prefixes(-4:4) = ['p', 'n', 'u', 'm', ' ', 'k', 'M', 'G', 'T']
    integer :: power, wanted
    wanted = 3
    if (present(digits)) wanted = digits
    power = 0
    if (abs(value) > 0) power = floor(log10(abs(value)*(1 + 0.5_dp*10.0_dp**(-wanted)))/3)
    if (power < lbound(prefixes, 1) .or. power > ubound(prefixes, 1)) power = 0
    text = short_text(value/10.0_dp**(3*power), wanted)//' '//trim(prefixes(power))//unit
  end function quantity_text

  !> A real with as few digits as read back as the same bits: 0.0508, 250, 2e-5.
  pure function exact_text(value) result(text)
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    real(dp), parameter :: may_round_up = 1e308_dp   ! above, fewer digits may be those of a number beyond the largest one
    real(dp) :: back
    integer :: digits
    do digits = merge(most_digits, 1, abs(value) > may_round_up), most_digits
      text = real_text(value, digits)
      if (scan(text, '0123456789') == 0) return   ! not finite
      read (text, *) back
      if (.not. abs(back - value) > 0) exit
    end do
    text = plain_text(text)
  end function exact_text

  !> A number of `real_text` as people write it: with an exponent only if it is small or large, without trailing zeros.
  pure function plain_text(number) result(text)
    character(len=*), intent(in) :: number
    character(len=:), allocatable :: text
    character(len=:), allocatable :: digits
    integer, parameter :: least_power = -4, largest_power = 5
    integer :: first, exponent, power
    text = number
    exponent = index(number, 'E')
    if (exponent == 0) return
    power = int(whole_number(number(exponent + 1:)))
    if (power < least_power .or. power > largest_power) then
      text = without_zeros(number(:exponent - 1))//'e'//integer_text(power)
      return
    end if
    first = scan(number, '0123456789')
    digits = number(first:first)//number(first + 2:exponent - 1)
    if (power < 0) then
      text = number(:first - 1)//without_zeros('0.'//repeat('0', -power - 1)//digits)
    else
      digits = digits//repeat('0', max(0, power + 1 - len(digits)))
      text = number(:first - 1)//without_zeros(digits(:power + 1)//'.'//digits(power + 2:))
    end if
  end function plain_text

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
