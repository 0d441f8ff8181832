!> Real numbers as decimal text, the same digits as a formatted write and many times faster: for tables of results.
module number_writer
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use powers_of_ten, only: power_of_ten_t, power_of_ten, make_powers, first_power, last_power, last_exact_power, limb_bits, &
    floor_log
  use ten_digits, only: ten_digits_t, digit
  implicit none
  private
  public :: number_writer_t, append_formatted, longest_number, fewest_digits, most_digits

  integer, parameter :: fewest_digits = 6, most_digits = 17   !! significant digits
  integer, parameter :: longest_number = most_digits + 7      !! characters, as -1.2345678901234567E-100
  integer, parameter :: not_finite = 972                      !! binary exponent of NaN and infinities

  !> The numbers 00 to 99.
  character(len=200), parameter :: pairs = &
    '00010203040506070809'//'10111213141516171819'//'20212223242526272829'//'30313233343536373839'// &
    '40414243444546474849'//'50515253545556575859'//'60616263646566676869'//'70717273747576777879'// &
    '80818283848586878889'//'90919293949596979899'

  !> Writes reals with a fixed number of significant digits: 1.234567890E-05, -1.234567890E+100, NaN, Infinity.
  type :: number_writer_t
    private
    integer :: digits = 10
    integer(int64) :: too_large = 10_int64**10   !! 10**digits
    type(power_of_ten_t), allocatable :: powers(:)   !! first_power to last_power, for many numbers
    type(ten_digits_t), allocatable :: ten_digits    !! in their place where there are ten digits
  contains
    procedure :: prepare
    procedure :: prepare_for_few
    procedure :: append
    procedure :: append_list
    procedure :: decides
  end type number_writer_t

contains

  !> Set the number of significant digits, and make the tables for many numbers. Call it first.
  pure subroutine prepare(self, digits)
    class(number_writer_t), intent(inout) :: self
    integer, intent(in) :: digits   !! fewest_digits to most_digits
    call self%prepare_for_few(digits)
    if (digits == 10) then
      allocate (self%ten_digits)
      call self%ten_digits%prepare()
    else
      allocate (self%powers(first_power:last_power))
      call make_powers(first_power, last_power, self%powers)
    end if
  end subroutine prepare

  !> The same without tables, which take as long as some dozens of numbers do then.
  pure subroutine prepare_for_few(self, digits)
    class(number_writer_t), intent(inout) :: self
    integer, intent(in) :: digits   !! fewest_digits to most_digits
    self%digits = digits
    self%too_large = 10_int64**digits
    if (allocated(self%powers)) deallocate (self%powers)
    if (allocated(self%ten_digits)) deallocate (self%ten_digits)
  end subroutine prepare_for_few

  !> Append a real to the first `used` characters of a line that has room for `longest_number` more. Zero has no sign.
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

  !> The same for all numbers and digits, a little slower.
  pure subroutine append_any(self, line, used, value)
    type(number_writer_t), intent(in) :: self
    character(len=*), intent(inout) :: line
    integer, intent(inout) :: used
    real(dp), intent(in) :: value
    integer(int64) :: significand, whole
    integer :: exponent, decade
    logical :: is_decided

    whole = 0
    decade = 0
    call take_apart(value, significand, exponent)
    if (significand /= 0) then
      is_decided = exponent /= not_finite
      if (is_decided) call round(self, significand, exponent, whole, decade, is_decided)
      if (.not. is_decided) then
        call append_formatted(line, used, value, self%digits)
        return
      end if
      if (transfer(value, 0_int64) < 0) then
        used = used + 1
        line(used:used) = '-'
      end if
    end if
    call put_digits(line(used + 1:used + self%digits + 1), whole)
    used = used + self%digits + 1
    call append_exponent(line, used, decade)
  end subroutine append_any

  !> Append values, a comma behind each, to the first `used` characters of a text that has room for `longest_number` + 1 more
  !> for each of them.
  pure subroutine append_list(self, text, used, values)
    class(number_writer_t), intent(in) :: self
    character(len=*), intent(inout) :: text
    integer, intent(inout) :: used
    real(dp), intent(in), contiguous :: values(:)
    integer :: i
    i = 1
    do
      if (allocated(self%ten_digits)) call self%ten_digits%append(text, used, values, i)
      if (i > size(values)) exit
      call append_any(self, text, used, values(i))
      used = used + 1
      text(used:used) = ','
      i = i + 1
    end do
  end subroutine append_list

  !> Whether `append` finds the digits of a finite value itself, as it nearly always does.
  pure logical function decides(self, value)
    class(number_writer_t), intent(in) :: self
    real(dp), intent(in) :: value
    integer(int64) :: significand, whole
    integer :: exponent, decade
    call take_apart(value, significand, exponent)
    decides = .true.
    if (significand /= 0) call round(self, significand, exponent, whole, decade, decides)
  end function decides

  !> value = +-significand 2**exponent, with 2**52 <= significand < 2**53, or 0.
  pure subroutine take_apart(value, significand, exponent)
    real(dp), intent(in) :: value
    integer(int64), intent(out) :: significand
    integer, intent(out) :: exponent
    integer(int64) :: bits
    integer :: shift
    bits = transfer(value, bits)
    significand = ibits(bits, 0, 52)
    exponent = int(ibits(bits, 52, 11)) - 1075
    if (exponent > -1075) then
      significand = ibset(significand, 52)
    else if (significand > 0) then   ! denormal
      shift = leadz(significand) - 11
      significand = shiftl(significand, shift)
      exponent = -1074 - shift
    end if
  end subroutine take_apart

  !> Round significand 2**exponent to whole 10**(decade - digits + 1), 10**(digits - 1) <= whole < 10**digits: to the
  !> nearest, of two equally near to the even one.
  !>
  !> The product p of the significand and the power of ten has 142 or 143 bits: the last 30 are `rest`, the 51 before them
  !> `low`, the others `high`. The true product is p where the power is exact; elsewhere it is larger, by less than
  !> 2**53 + 2**30. Where this leaves open whether it passes the half it may be the half itself: if 5**(-k) divides the
  !> significand it is a multiple of 2**(-27), too coarse to be anything else near there. Otherwise, less than once in
  !> 10**9 numbers, `is_decided` is false.
  pure subroutine round(writer, significand, exponent, whole, decade, is_decided)
    type(number_writer_t), intent(in) :: writer
    integer(int64), intent(in) :: significand
    integer, intent(in) :: exponent
    integer(int64), intent(out) :: whole
    integer, intent(out) :: decade
    logical, intent(out) :: is_decided
    integer(int64), parameter :: margin = 2_int64**24   !! of `low`, more than (2**53 + 2**30)/2**30
    type(power_of_ten_t) :: power
    integer(int64) :: high, low, rest, part, half
    integer :: k, shift
    logical :: is_tie

    decade = floor_log(exponent + 52)   ! right or one too small
    do
      k = writer%digits - 1 - decade
      if (allocated(writer%powers)) then
        power = writer%powers(k)
      else
        power = power_of_ten(k)
      end if
      call multiply(significand, power, high, low, rest)
      shift = -81 - exponent - int(power%exponent)
      whole = shiftr(high, shift)
      if (whole < writer%too_large) exit
      decade = decade + 1
    end do
    part = high - shiftl(whole, shift)
    half = shiftl(1_int64, shift - 1)
    is_decided = .true.
    if (part < half - 1 .or. part == half - 1 .and. low < 2_int64**51 - margin) return
    if (k >= 0 .and. k <= last_exact_power) then
      if (part < half) return
      is_tie = part == half .and. low == 0 .and. rest == 0
    else
      is_tie = .false.
      if (part < half .and. k < 0 .and. k >= -22) is_tie = mod(significand, 5_int64**(-k)) == 0
      is_decided = part >= half .or. is_tie
    end if
    if (is_tie .and. .not. btest(whole, 0)) return
    whole = whole + 1
    if (whole < writer%too_large) return
    whole = whole/10
    decade = decade + 1
  end subroutine round

  pure subroutine multiply(significand, power, high, low, rest)
    integer(int64), intent(in) :: significand
    type(power_of_ten_t), intent(in) :: power
    integer(int64), intent(out) :: high, low, rest
    integer(int64) :: upper, lower, limb_1, limb_2, limb_3, limb_4
    lower = ibits(significand, 0, limb_bits)
    upper = shiftr(significand, limb_bits)
    limb_1 = lower*power%low
    limb_2 = lower*power%middle + upper*power%low + shiftr(limb_1, limb_bits)
    limb_3 = lower*power%high + upper*power%middle + shiftr(limb_2, limb_bits)
    limb_4 = upper*power%high + shiftr(limb_3, limb_bits)
    high = shiftl(limb_4, 9) + ibits(limb_3, 21, 9)
    low = shiftl(ibits(limb_3, 0, 21), limb_bits) + ibits(limb_2, 0, limb_bits)
    rest = ibits(limb_1, 0, limb_bits)
  end subroutine multiply

  !> The digits of a number, with a point after the first, fill `text`.
  pure subroutine put_digits(text, number)
    character(len=*), intent(inout) :: text
    integer(int64), intent(in) :: number
    integer(int64), parameter :: eight = 10_int64**8
    integer :: upper, rest, at

    if (len(text) < 10) then
      rest = int(number)
      do at = len(text), 3, -1
        text(at:at) = digit(mod(rest, 10))
        rest = rest/10
      end do
      text(1:1) = digit(rest)
      text(2:2) = '.'
      return
    end if
    upper = int(number/eight)
    at = len(text) - 7
    call put_eight(text(at:at + 7), int(number - upper*eight))
    do while (at > 4)
      rest = upper/100
      at = at - 2
      text(at:at + 1) = pair(upper - 100*rest)
      upper = rest
    end do
    if (at == 4) then
      text(1:1) = digit(upper/10)
      text(3:3) = digit(mod(upper, 10))
    else
      text(1:1) = digit(upper)
    end if
    text(2:2) = '.'
  end subroutine put_digits

  pure subroutine put_eight(text, number)
    character(len=8), intent(inout) :: text
    integer, intent(in) :: number
    integer :: four, two
    four = number/10000
    two = four/100
    text(1:2) = pair(two)
    text(3:4) = pair(four - 100*two)
    four = number - 10000*four
    two = four/100
    text(5:6) = pair(two)
    text(7:8) = pair(four - 100*two)
  end subroutine put_eight

  !> The two digits of a number below 100.
  pure character(len=2) function pair(number)
    integer, intent(in) :: number
    pair = pairs(2*number + 1:2*number + 2)
  end function pair

  !> E-05, with a third digit where it takes one.
  pure subroutine append_exponent(line, used, decade)
    character(len=*), intent(inout) :: line
    integer, intent(inout) :: used
    integer, intent(in) :: decade
    integer :: size, hundreds
    size = abs(decade)
    line(used + 1:used + 1) = 'E'
    line(used + 2:used + 2) = merge('-', '+', decade < 0)
    used = used + 2
    hundreds = size/100
    if (hundreds > 0) then
      used = used + 1
      line(used:used) = digit(hundreds)
    end if
    line(used + 1:used + 2) = pair(size - 100*hundreds)
    used = used + 2
  end subroutine append_exponent

  !> What `append` appends, by a formatted write. Zero keeps its sign.
  pure subroutine append_formatted(line, used, value, digits)
    character(len=*), intent(inout) :: line
    integer, intent(inout) :: used
    real(dp), intent(in) :: value
    integer, intent(in) :: digits
    character(len=12) :: form
    character(len=longest_number) :: text
    integer, parameter :: hundreds = longest_number - 2   !! where the three digits of the exponent begin
    integer :: first
    write (form, '(a,i0,a,i0,a)') '(es', longest_number, '.', digits - 1, 'e3)'
    write (text, form) value
    if (text(hundreds:hundreds) == '0') text = ' '//text(:hundreds - 1)//text(hundreds + 1:)
    first = verify(text, ' ')
    line(used + 1:used + 1 + longest_number - first) = text(first:)
    used = used + 1 + longest_number - first
  end subroutine append_formatted
end module number_writer
