!> Single numbers as text and back, compared with formatted writes and reads of the compiler; long texts of many pieces.
module test_number_text
  use kinds, only: dp
  use number_text, only: real_text, short_text, exact_text
  use value_reader, only: read_real, read_integer, is_within
  use growing_text, only: growing_text_t
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_number_text

  integer, parameter :: n_random = 4000

contains

  subroutine run_test_number_text(check)
    class(checks_t), intent(inout) :: check
    call test_texts(check)
    call test_random_texts(check)
    call test_reading(check)
    call test_ranges(check)
    call test_growing(check)
  end subroutine run_test_number_text

  subroutine test_texts(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: zero
    zero = 0
    call check%equal_text(real_text(1.23456789e-5_dp), '1.234567890E-05', 'real')
    call check%equal_text(real_text(-2.0_dp), '-2.000000000E+00', 'negative')
    call check%equal_text(real_text(zero), '0.000000000E+00', 'zero')
    call check%equal_text(real_text(-zero), '-0.000000000E+00', 'negative zero')
    call check%equal_text(real_text(1e-120_dp), '1.000000000E-120', 'small')
    call check%equal_text(real_text(-1e150_dp), '-1.000000000E+150', 'large')
    call check%equal_text(short_text(0.5_dp), '0.5', 'short')
    call check%equal_text(short_text(4.0_dp), '4', 'short, whole')
    call check%equal_text(short_text(-123456.4_dp), '-123456', 'short, six digits before the point')
    call check%equal_text(short_text(9.9999996_dp), '10', 'short, rounded up to the next power')
    call check%equal_text(short_text(1.23e6_dp), '1.23e6', 'short, large')
    call check%equal_text(short_text(1.25e-4_dp), '0.000125', 'short, small')
    call check%equal_text(short_text(-1e-5_dp), '-1e-5', 'short, smaller')
    call check%equal_text(short_text(3e105_dp), '3e105', 'short, three digits of exponent')
    call check%equal_text(short_text(zero), '0', 'short, zero')
    call check%equal_text(short_text(253.612345678_dp, 9), '253.612346', 'short, nine digits')
    call check%equal_text(short_text(0.2536_dp), '0.2536', 'short, a digit before the point')
    call check%equal_text(exact_text(0.0508_dp), '0.0508', 'exact')
    call check%equal_text(exact_text(250.0_dp), '250', 'exact, whole')
    call check%equal_text(exact_text(-2e-5_dp), '-2e-5', 'exact, small')
    call check%equal_text(exact_text(2.07e11_dp), '2.07e11', 'exact, large')
    call check%equal_text(exact_text(523.5987755982989_dp), '523.5987755982989', 'exact, many digits')
    call check%equal_text(exact_text(0.1_dp + 0.2_dp), '0.30000000000000004', 'exact, 17 digits')
    call check%equal_text(exact_text(zero), '0', 'exact, zero')
    call check%equal_text(exact_text(-huge(zero)), '-1.7976931348623157e308', 'exact, largest: not rounded up to infinity')
  end subroutine test_texts

  subroutine test_random_texts(check)
    class(checks_t), intent(inout) :: check
    character(len=24) :: ten, seventeen, plain
    character(len=:), allocatable :: wanted
    real(dp) :: value, back
    integer :: i, wrong, wrong_short, altered
    wrong = 0
    wrong_short = 0
    altered = 0
    do i = 1, n_random
      value = random_number_of(i)
      write (ten, '(es16.9e2)') value
      write (seventeen, '(es23.16e2)') value
      if (real_text(value) /= adjustl(ten) .or. real_text(value, 17) /= adjustl(seventeen)) wrong = wrong + 1
      read (seventeen, *) back
      if (abs(back - value) > 0) altered = altered + 1
      call read_real(exact_text(value), back, wanted)
      if (allocated(wanted) .or. abs(back - value) > 0) altered = altered + 1
      if (abs(value) < 100 .or. abs(value) >= 999) cycle
      write (plain, '(f24.3)') value
      read (plain, *) back
      if (short_text(value) /= short_text(back)) wrong_short = wrong_short + 1
      if (verify(trim(short_text(value)), trim(adjustl(plain))) > 0) wrong_short = wrong_short + 1
    end do
    call check%that(wrong == 0, 'random numbers are those of a formatted write')
    call check%that(wrong_short == 0, 'random numbers in short form')
    call check%that(altered == 0, 'exact text reads back')
  end subroutine test_random_texts

  !> Texts with up to 15 digits and with more, with and without point and exponent, are read as a compiler reads them.
  subroutine test_reading(check)
    class(checks_t), intent(inout) :: check
    character(len=40) :: text
    character(len=16) :: form
    character(len=:), allocatable :: wanted
    real(dp) :: value, expected
    integer :: i, digits, wrong, whole
    wrong = 0
    do i = 1, n_random
      digits = 1 + mod(i, 18)
      write (form, '(a,i0,a,i0,a)') '(es', digits + 9, '.', digits, 'e2)'
      write (text, form) random_number_of(i)
      if (mod(i, 3) == 0) write (text, '(f0.3)') random_number_of(i)
      text = adjustl(text)
      if (mod(i, 5) == 0 .and. index(text, 'E') > 0) text(index(text, 'E'):index(text, 'E')) = 'd'
      read (text, *) expected
      call read_real(trim(text), value, wanted)
      if (allocated(wanted) .or. abs(value - expected) > 0) wrong = wrong + 1
    end do
    call check%that(wrong == 0, 'random texts are read as by the compiler')
    call expect('12', 12.0_dp)
    call expect('-.5', -0.5_dp)
    call expect('+2.', 2.0_dp)
    call expect('1Q-3', 1e-3_dp)
    call expect('9007199254740993', 9007199254740992.0_dp)
    call expect('-0.0', 0.0_dp)
    call expect('999999999999999e15', 0.999999999999999e30_dp)
    call expect('99999.9999999999999E+24', 0.999999999999999999e29_dp)
    call expect('0.0001e-26', 1e-30_dp)
    do i = 1, 11
      call read_real(trim(adjustl(wrong_text(i))), value, wanted)
      call check%that(allocated(wanted), 'not a real number, or too large: '//wrong_text(i))
    end do
    call read_integer('-2147483647', whole, wanted)
    call check%that(whole == -2147483647 .and. .not. allocated(wanted), 'the smallest integer')
    call read_integer('2147483648', whole, wanted)
    call check%that(allocated(wanted), 'an integer that is too large')

  contains

    subroutine expect(text, want)
      character(len=*), intent(in) :: text
      real(dp), intent(in) :: want
      call read_real(text, value, wanted)
      call check%that(.not. allocated(wanted) .and. .not. abs(value - want) > 0, 'real '//text)
    end subroutine expect

    function wrong_text(i) result(text)
      integer, intent(in) :: i
      character(len=8) :: text
      character(len=8), parameter :: texts(11) = [character(len=8) :: '.', '-', '1e', '1e+', '1.2.3', '1e5.', '1-5', '1e30', &
        '2 3', '.01e32', '9e-31']
      text = texts(i)
    end function wrong_text
  end subroutine test_reading

  subroutine test_ranges(check)
    class(checks_t), intent(inout) :: check
    call check%that(is_within(0.1_dp, '> 0 and <= 0.1     '), 'the end of a range')
    call check%that(.not. is_within(nearest(0.1_dp, 1.0_dp), '> 0 and <= 0.1'), 'just outside of a range')
    call check%that(.not. is_within(0.0_dp, '> 0'), 'the open end of a range')
    call check%that(is_within(1e-6_dp, '>= 1e-6 and <= 1e3'), 'the closed end of a range')
  end subroutine test_ranges

  subroutine test_growing(check)
    class(checks_t), intent(inout) :: check
    type(growing_text_t) :: growing
    integer :: i
    call growing%append('')
    call check%that(growing%used == 0, 'an empty text')
    do i = 1, 3000
      call growing%append(achar(97 + mod(i, 26)))
      call growing%append('')
      call growing%append('xyz')
    end do
    associate (text => growing%text(:growing%used))
      call check%that(len(text) == 12000 .and. text(:8) == 'bxyzcxyz' .and. text(11997:) == achar(97 + mod(3000, 26))//'xyz', &
                      'a text of many pieces')
    end associate
  end subroutine test_growing

  !> A number of either sign and a magnitude from 1e-20 to 1e20, always the same for the same i.
  pure real(dp) function random_number_of(i)
    integer, intent(in) :: i
    real(dp), parameter :: golden = 0.6180339887498949_dp, silver = 0.4142135623730951_dp
    random_number_of = (0.1_dp + 0.9_dp*mod(i*golden, 1.0_dp))*10.0_dp**(nint(40*mod(i*silver, 1.0_dp)) - 20)
    if (mod(i, 2) == 0) random_number_of = -random_number_of
  end function random_number_of
end module test_number_text
