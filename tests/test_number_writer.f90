!> Numbers in a table: known texts, and the digits of a formatted write.
module test_number_writer
  use, intrinsic :: iso_fortran_env, only: int64
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_positive_inf, ieee_negative_inf
  use kinds, only: dp
  use number_text, only: number_writer_t, append_formatted, longest_number, fewest_digits, most_digits
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_number_writer

contains

  subroutine run_test_number_writer(check)
    class(checks_t), intent(inout) :: check
    type(number_writer_t) :: writer
    integer(int64) :: random
    integer :: digits
    call test_known(check)
    call test_near_ties(check)
    call test_list(check)
    random = 88172645463325252_int64
    do digits = fewest_digits, most_digits
      call writer%prepare(digits)
      call test_random(check, writer, digits, random)
      call test_decades(check, writer, digits)
      call test_ties(check, writer, digits, random)
      call test_bounds(check, writer, digits)
    end do
  end subroutine run_test_number_writer

  subroutine test_known(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: zero
    zero = 0
    call expect(check, 10, 1.23456789e-5_dp, '1.234567890E-05')
    call expect(check, 10, -2.0_dp, '-2.000000000E+00')
    call expect(check, 10, zero, '0.000000000E+00')
    call expect(check, 10, -zero, '0.000000000E+00')
    call expect(check, 10, 1e-120_dp, '1.000000000E-120')
    call expect(check, 10, -1e150_dp, '-1.000000000E+150')
    call expect(check, 10, 5e99_dp, '5.000000000E+99')
    call expect(check, 10, 9.9999999996e99_dp, '1.000000000E+100')
    call expect(check, 10, 9.9999999996e-100_dp, '1.000000000E-99')
    call expect(check, 10, 9.9999999994_dp, '9.999999999E+00')
    call expect(check, 10, 1234567890.5_dp, '1.234567890E+09')
    call expect(check, 10, 1234567891.5_dp, '1.234567892E+09')
    call expect(check, 10, 12345678905.0_dp, '1.234567890E+10')
    call expect(check, 10, 12345678915.0_dp, '1.234567892E+10')
    call expect(check, 10, nearest(1234567890.5_dp, 1.0_dp), '1.234567891E+09')
    call expect(check, 10, nearest(1234567891.5_dp, -1.0_dp), '1.234567891E+09')
    call expect(check, 9, 0.1_dp, '1.00000000E-01')
    call expect(check, 17, 0.1_dp, '1.0000000000000001E-01')
    call expect(check, 17, -huge(zero), '-1.7976931348623157E+308')
    call expect(check, 17, transfer(1_int64, zero), '4.9406564584124654E-324')
    call expect(check, 12, ieee_value(zero, ieee_quiet_nan), 'NaN')
    call expect(check, 12, ieee_value(zero, ieee_positive_inf), 'Infinity')
    call expect(check, 12, ieee_value(zero, ieee_negative_inf), '-Infinity')
  end subroutine test_known

  !> Numbers that differ from a tie by at most 1e-11 of the last digit, on either side; random numbers are hardly ever so close.
  subroutine test_near_ties(check)
    class(checks_t), intent(inout) :: check
    call expect(check, 17, 3.3973074513043686e-45_dp, '3.3973074513043686E-45')
    call expect(check, 17, 4.478429846747103e-286_dp, '4.4784298467471030E-286')
    call expect(check, 17, 3.955139782659578e+286_dp, '3.9551397826595780E+286')
    call expect(check, 17, 9.722603240137014e+105_dp, '9.7226032401370143E+105')
    call expect(check, 17, 5.466121909314921e-30_dp, '5.4661219093149210E-30')
    call expect(check, 17, 1.5445039215960358e+166_dp, '1.5445039215960358E+166')
    call expect(check, 10, 6.9597507115e-286_dp, '6.959750711E-286')
    call expect(check, 10, 5.8027745535e+286_dp, '5.802774553E+286')
    call expect(check, 10, 4.1410816915e-12_dp, '4.141081691E-12')
    call expect(check, 10, 4.9522827615e+27_dp, '4.952282761E+27')
  end subroutine test_near_ties

  subroutine expect(check, digits, value, text)
    class(checks_t), intent(inout) :: check
    integer, intent(in) :: digits
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: text
    type(number_writer_t) :: writer
    character(len=longest_number + 2) :: line
    integer :: used
    call writer%prepare(digits)
    line = 'a,'
    used = 2
    call writer%append(line, used, value)
    call check%equal_text(line(:used), 'a,'//text, 'number')
  end subroutine expect

  !> A list in which numbers that the tables cover alternate with others: a tie, a very small number, a NaN. It begins after the
  !> present text, and ends with a comma.
  subroutine test_list(check)
    class(checks_t), intent(inout) :: check
    type(number_writer_t) :: writer
    real(dp) :: values(7)
    character(len=200) :: line
    integer :: used, length
    values = [-2.5e-7_dp, 12345678905.0_dp, 0.0_dp, ieee_value(1.0_dp, ieee_quiet_nan), 9.99e96_dp, -1e-300_dp, -1e9_dp]
    line = 'a,'
    used = 2
    call writer%prepare(10)
    call writer%append_list(line, used, values)
    call check%equal_text(line(:used), 'a,-2.500000000E-07,1.234567890E+10,0.000000000E+00,NaN,9.990000000E+96,'// &
      '-1.000000000E-300,-1.000000000E+09,', 'list of numbers')
    length = used
    call writer%append_list(line, used, values(:0))
    call check%that(used == length, 'an empty list adds nothing')
    used = 0
    call writer%prepare(9)
    call writer%append_list(line, used, values(:3))
    call check%equal_text(line(:used), '-2.50000000E-07,1.23456789E+10,0.00000000E+00,', 'list of nine digits')
  end subroutine test_list

  !> Random bit patterns, and ordinary magnitudes. With 17 digits numbers are read back unchanged.
  subroutine test_random(check, writer, digits, random)
    class(checks_t), intent(inout) :: check
    type(number_writer_t), intent(in) :: writer
    integer, intent(in) :: digits
    integer(int64), intent(inout) :: random
    integer, parameter :: n = 20000, n_read = 500
    character(len=longest_number) :: line
    real(dp) :: value, back
    integer :: i, wrong, altered, used

    wrong = 0
    altered = 0
    do i = 1, n
      call draw(random)
      if (ibits(random, 52, 11) == 2047) cycle   ! NaN
      value = transfer(random, value)
      if (.not. agrees(writer, value, digits)) wrong = wrong + 1
      if (i > n_read .or. digits < most_digits) cycle
      used = 0
      call writer%append(line, used, value)
      read (line(:used), *) back
      if (transfer(back, random) /= random) altered = altered + 1
    end do
    call check%that(wrong == 0, 'random bit patterns are those of a formatted write')
    call check%that(altered == 0, 'numbers with 17 digits are read back')
    wrong = 0
    do i = 1, n
      call draw(random)
      value = real(random, dp)*2.0_dp**(-63)*10.0_dp**ibits(i, 0, 4)*1e-8_dp
      if (.not. agrees(writer, value, digits)) wrong = wrong + 1
    end do
    call check%that(wrong == 0, 'ordinary numbers are those of a formatted write')
  end subroutine test_random

  !> Powers of ten, and the numbers below and above them.
  subroutine test_decades(check, writer, digits)
    class(checks_t), intent(inout) :: check
    type(number_writer_t), intent(in) :: writer
    integer, intent(in) :: digits
    character(len=8) :: text
    real(dp) :: value
    integer :: i, k, wrong
    wrong = 0
    do k = -323, 308
      write (text, '(a,i0)') '1e', k
      read (text, *) value
      do i = -3, 3
        if (.not. agrees(writer, transfer(transfer(value, 0_int64) + i, value), digits)) wrong = wrong + 1
      end do
      do i = 2, 12
        if (abs(value) < 1e-300_dp .or. abs(value) > 1e290_dp) cycle
        if (.not. agrees(writer, value*(1 - 0.5_dp*10.0_dp**(-i)), digits)) wrong = wrong + 1
        if (.not. agrees(writer, value*(1 + 0.5_dp*10.0_dp**(-i)), digits)) wrong = wrong + 1
      end do
    end do
    call check%that(wrong == 0, 'powers of ten and numbers near them')
  end subroutine test_decades

  !> Numbers exactly between two decimals of the given length, and their neighbours: odd 2**(-p), whose last decimal is
  !> the digit after the last that is written, and whole numbers with a 5 at that place and zeros after it.
  subroutine test_ties(check, writer, digits, random)
    class(checks_t), intent(inout) :: check
    type(number_writer_t), intent(in) :: writer
    integer, intent(in) :: digits
    integer(int64), intent(inout) :: random
    integer(int64) :: odd, lowest, highest, significand
    integer :: p, i, n, wrong

    wrong = 0
    n = 0
    do p = 1, 25
      lowest = 10_int64**digits/5_int64**p + 1
      highest = 10_int64**(digits + 1)/5_int64**p
      if (highest < lowest) exit
      do i = 1, 50
        call draw(random)
        odd = ior(lowest + modulo(random, highest - lowest + 1), 1_int64)
        if (odd > min(highest, 2_int64**53)) cycle
        n = n + 1
        call count_around(real(odd, dp)*2.0_dp**(-p))
      end do
    end do
    lowest = 10_int64**(digits - 1)
    do p = 0, 8
      do i = 1, 50
        call draw(random)
        odd = 10*(lowest + modulo(random, 9*lowest)) + 5
        if (odd > 2_int64**53/5_int64**p) cycle
        significand = odd*5_int64**p
        n = n + 1
        call count_around(real(significand, dp)*2.0_dp**p)
      end do
    end do
    call check%that(wrong == 0 .and. n > 300, 'ties are rounded to the even digit')

  contains

    subroutine count_around(value)
      real(dp), intent(in) :: value
      if (.not. agrees(writer, value, digits)) wrong = wrong + 1
      if (.not. agrees(writer, nearest(value, 1.0_dp), digits)) wrong = wrong + 1
      if (.not. agrees(writer, nearest(value, -1.0_dp), digits)) wrong = wrong + 1
    end subroutine count_around
  end subroutine test_ties

  !> Denormal numbers, the smallest normal ones, the largest.
  subroutine test_bounds(check, writer, digits)
    class(checks_t), intent(inout) :: check
    type(number_writer_t), intent(in) :: writer
    integer, intent(in) :: digits
    integer(int64) :: bits
    integer :: i, wrong
    wrong = 0
    do i = 0, 52
      bits = 2_int64**i
      if (.not. agrees(writer, transfer(bits, 0.0_dp), digits)) wrong = wrong + 1
      if (.not. agrees(writer, transfer(bits + bits/3, 0.0_dp), digits)) wrong = wrong + 1
      if (.not. agrees(writer, transfer(2_int64**52 - bits + 1, 0.0_dp), digits)) wrong = wrong + 1
      if (.not. agrees(writer, transfer(2_int64**52 + bits, 0.0_dp), digits)) wrong = wrong + 1
      if (.not. agrees(writer, transfer(transfer(huge(1.0_dp), bits) - bits + 1, 0.0_dp), digits)) wrong = wrong + 1
    end do
    call check%that(wrong == 0, 'denormal, smallest and largest numbers')
  end subroutine test_bounds

  logical function agrees(writer, value, digits)
    type(number_writer_t), intent(in) :: writer
    real(dp), intent(in) :: value
    integer, intent(in) :: digits
    character(len=longest_number) :: line, expected
    integer :: used, length
    used = 0
    length = 0
    call writer%append(line, used, value)
    call append_formatted(expected, length, value, digits)
    agrees = used == length .and. line(:used) == expected(:length)
  end function agrees

  !> The next number of Marsaglia's xorshift generator.
  subroutine draw(random)
    integer(int64), intent(inout) :: random
    random = ieor(random, shiftl(random, 13))
    random = ieor(random, shiftr(random, 7))
    random = ieor(random, shiftl(random, 17))
  end subroutine draw
end module test_number_writer
