!> Real numbers as decimal text of ten significant digits, for the many of a trace: what `number_writer` does for all numbers
!> and digits, by tables and without branches.
module ten_digits
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use powers_of_ten, only: power_of_ten_t, make_powers, floor_log
  implicit none
  private
  public :: ten_digits_t, digit

  integer, parameter :: last_binade = 133   !! numbers beyond, and their inverses, are left to others
  integer, parameter :: last_decade = 41    !! that it reaches into
  integer, parameter :: field_length = 19   !! of 1.234567890E-05, and three blanks
  character(len=16), parameter :: zero = '0.000000000E+00,'
  integer, parameter :: wide = selected_int_kind(38)   !! holds the product of two int64

  !> What makes the digits of the numbers from 2**e to 2**(e + 1), which may belong to two decades: from 10**k on, and from
  !> 10**(k + 1) on.
  type :: binade_t
    integer(int64) :: next             !! the bits of 10**(k + 1), cut off: what is as near to it has the digits 1000000000
    integer(int64) :: factor(0:1)      !! 2**(29 + e) 10**(9 - k) and a tenth of it, cut off
    character(len=8) :: ending(0:1)    !! E-05,
  end type binade_t

  type :: ten_digits_t
    private
    type(binade_t) :: binades(-last_binade:last_binade)
    character(len=4) :: triples(0:999)   !! three digits, and a blank
  contains
    procedure :: prepare
    procedure :: append
  end type ten_digits_t

contains

  !> Make the tables. Call it first. (Without concatenation, which takes ten times as long.)
  pure subroutine prepare(self)
    class(ten_digits_t), intent(inout) :: self
    integer, parameter :: first = -last_decade, last = last_decade + 9
    type(power_of_ten_t) :: powers(first:last)
    character(len=8) :: endings(-last_decade:last_decade)
    character(len=4) :: triple
    integer :: i, j, e, k
    call make_powers(first, last, powers)
    triple = ''
    do i = 0, 9
      triple(1:1) = digit(i)
      do j = 0, 9
        triple(2:2) = digit(j)
        do k = 0, 9
          triple(3:3) = digit(k)
          self%triples(100*i + 10*j + k) = triple
        end do
      end do
    end do
    do k = -last_decade, last_decade
      endings(k) = 'E+00,'
      if (k < 0) endings(k)(2:2) = '-'
      endings(k)(3:3) = digit(abs(k)/10)
      endings(k)(4:4) = digit(mod(abs(k), 10))
    end do
    do e = -last_binade, last_binade
      k = floor_log(e)
      self%binades(e)%next = bits_of(powers(k + 1))
      self%binades(e)%factor(0) = factor_of(powers(9 - k), e)
      self%binades(e)%factor(1) = factor_of(powers(8 - k), e)
      self%binades(e)%ending = endings(k:k + 1)
    end do
  end subroutine prepare

  !> The digit of a number below 10.
  pure character(len=1) function digit(number)
    integer, intent(in) :: number
    digit = achar(iachar('0') + number)
  end function digit

  !> The bits of the largest real not above a power of ten: 53 of its 90.
  pure integer(int64) function bits_of(power)
    type(power_of_ten_t), intent(in) :: power
    bits_of = shiftl(power%exponent + 37 + 1074, 52) + shiftl(power%high, 23) + shiftr(power%middle, 7)   ! a first bit adds 1
  end function bits_of

  !> 2**(29 + e) times a power of ten.
  pure integer(int64) function factor_of(power, e)
    type(power_of_ten_t), intent(in) :: power
    integer, intent(in) :: e
    factor_of = shiftl(power%high, 33) + shiftl(power%middle, 3) + shiftr(power%low, 27)   ! its first 63 bits
    factor_of = shiftr(factor_of, -56 - e - int(power%exponent))
  end function factor_of

  !> Append values from number `next` on, a comma behind each, to the first `used` characters of a text that has room for 25
  !> more for each of them. `next` ends behind the last, or at one whose digits are not found here: a very large or small
  !> one, NaN, and where 63 bits leave open how the last digit is to be rounded, one in ten million.
  !>
  !> The product of the significand, as 63 bits, and the factor has the digits and 27 bits behind the point in its upper
  !> half. That is too small by less than 2 because the factor and the lower half are cut off. What depends on the value is
  !> looked up or computed, not branched upon: a branch that goes now one way, now the other costs as much as all the rest.
  pure subroutine append(self, text, used, values, next)
    class(ten_digits_t), intent(in) :: self
    character(len=*), intent(inout) :: text
    integer, intent(inout) :: used, next
    real(dp), intent(in), contiguous :: values(:)
    integer(int64), parameter :: hidden_bit = 2_int64**52, too_large = 10_int64**10
    integer(int64), parameter :: half = 2_int64**26, short_by = 3   !! the product, and one more
    integer(int64) :: bits, exponent, decade, product, whole
    integer :: i, at

    at = used
    do i = next, size(values)
      bits = iand(transfer(values(i), bits), huge(bits))
      exponent = shiftr(bits, 52) - 1023
      if (abs(exponent) <= last_binade) then
        associate (binade => self%binades(exponent))
          decade = 1 + shifta(bits - binade%next, 63)
          product = upper_half(shiftl(ior(iand(bits, hidden_bit - 1), hidden_bit), 10), binade%factor(decade))
          product = product + half + short_by
          whole = shiftr(product, 27)
          if (iand(product, 2*half - 1) <= short_by .or. whole >= too_large) exit   ! it may be a tie, or the next decade
          text(at + 1:at + 1) = '-'
          at = at - int(shifta(transfer(values(i), bits), 63))
          call put_number(self%triples, whole, binade%ending(decade), text(at + 1:at + field_length))
        end associate
      else if (bits == 0) then
        text(at + 1:at + len(zero)) = zero
      else
        exit
      end if
      at = at + len(zero)
    end do
    next = i
    used = at
  end subroutine append

  !> Ten digits as a fraction of 53 bits, too large by less than 1.3 of the last: its whole part is the first digit, and
  !> three more after a multiplication by a thousand.
  pure subroutine put_number(triples, whole, ending, field)
    character(len=4), intent(in) :: triples(0:999)
    integer(int64), intent(in) :: whole
    character(len=8), intent(in) :: ending
    character(len=field_length), intent(inout) :: field
    integer(int64), parameter :: scale = 309485009821345069_int64   !! 2**88/10**9, rounded up
    integer(int64), parameter :: mask = 2_int64**53 - 1
    integer(int64) :: fraction
    integer :: i
    fraction = upper_half(shiftl(whole, 29), scale) + 1
    field(1:1) = achar(iachar('0') + shiftr(fraction, 53))
    field(2:2) = '.'
    do i = 3, 9, 3
      fraction = 1000*iand(fraction, mask)
      field(i:i + 3) = triples(shiftr(fraction, 53))
    end do
    field(12:19) = ending
  end subroutine put_number

  !> The upper half of the product of two numbers that are not negative.
  pure integer(int64) function upper_half(a, b)
    integer(int64), intent(in) :: a, b
    upper_half = int(shiftr(int(a, wide)*int(b, wide), 64), int64)
  end function upper_half
end module ten_digits
