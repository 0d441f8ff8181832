!> Compares `number_writer_t` with formatted writes: check_numbers [NUMBERS] (default 10000000). Half of the numbers are random bit
!> patterns, half have ordinary magnitudes; the number of significant digits changes from number to number. Then measures the time
!> of both. Ends with `N passed, N failed`.
program check_numbers
  use, intrinsic :: iso_fortran_env, only: int64, output_unit
  use kinds, only: dp
  use number_text, only: number_writer_t, append_formatted, longest_number, fewest_digits, most_digits
  implicit none
  real(dp), parameter :: least_gain = 8
  integer, parameter :: timed(4) = [9, 10, 12, 17]   !! numbers of digits that are timed
  integer :: n, wrong, passed, i
  real(dp) :: gain, one
  character(len=16) :: argument

  n = 10000000
  call get_command_argument(1, argument)
  if (argument /= '') read (argument, *) n
  call compare(n, wrong)
  write (output_unit, '(i0,a,i0,a)') n, ' numbers: ', wrong, ' differ'
  gain = huge(gain)
  do i = 1, size(timed)
    call time_both(timed(i), one)
    gain = min(gain, one)
  end do
  passed = count([wrong == 0, gain >= least_gain])
  write (output_unit, '(i0,a,i0,a)') passed, ' passed, ', 2 - passed, ' failed'
  if (passed < 2) error stop 1

contains

  subroutine compare(n, wrong)
    integer, intent(in) :: n
    integer, intent(out) :: wrong
    type(number_writer_t) :: writers(fewest_digits:most_digits)
    character(len=longest_number) :: line, expected
    integer(int64) :: random
    real(dp) :: value
    integer :: i, digits, used, length
    do digits = fewest_digits, most_digits
      call writers(digits)%prepare(digits)
    end do
    wrong = 0
    random = 4101842887655102017_int64
    do i = 1, n
      call draw(random)
      value = ordinary(random)
      if (btest(i, 0) .and. ibits(random, 52, 11) < 2047) value = transfer(random, value)
      digits = fewest_digits + mod(i/2, most_digits - fewest_digits + 1)
      used = 0
      length = 0
      call writers(digits)%append(line, used, value)
      call append_formatted(expected, length, value, digits)
      if (line(:used) == expected(:length)) cycle
      wrong = wrong + 1
      if (wrong <= 10) write (output_unit, '(4a)') line(:used), ' should be ', expected(:length)
    end do
  end subroutine compare

  !> Time of a number [ns] by each method in whole rows, the shortest of several rounds, and the ratio of the times.
  subroutine time_both(digits, gain)
    integer, intent(in) :: digits
    real(dp), intent(out) :: gain
    integer, parameter :: rounds = 15, n = 20000, row = 25
    character(len=n*(longest_number + 1)) :: text
    type(number_writer_t) :: writer
    real(dp) :: values(n), fast, slow
    character(len=16) :: form
    integer(int64) :: random, began, ended, rate
    integer :: i, j, used

    random = 88172645463325252_int64
    do i = 1, n
      call draw(random)
      values(i) = ordinary(random)
    end do
    call writer%prepare(digits)
    write (form, '(2(a,i0),a)') '(es', digits + 6, '.', digits - 1, 'e2)'
    fast = huge(fast)
    slow = huge(slow)
    do j = 1, rounds
      used = 0
      call system_clock(began, rate)
      do i = 0, n - row, row
        call writer%append_list(text, used, values(i + 1:i + row))
      end do
      call system_clock(ended)
      fast = min(fast, 1e9_dp*real(ended - began, dp)/real(rate, dp)/n)
      used = 0
      call system_clock(began)
      do i = 1, n
        write (text(used + 1:used + digits + 6), form) values(i)
        used = used + digits + 6
      end do
      call system_clock(ended)
      slow = min(slow, 1e9_dp*real(ended - began, dp)/real(rate, dp)/n)
    end do
    gain = slow/fast
    write (output_unit, '(i0,3(a,f0.1))') digits, ' digits: ns a number: ', fast, ', formatted write ', slow, ', ratio ', gain
  end subroutine time_both

  !> A random number of either sign between about 1e-13 and 1e8.
  pure real(dp) function ordinary(random)
    integer(int64), intent(in) :: random
    ordinary = real(random, dp)*2.0_dp**(-63)*10.0_dp**(int(ibits(random, 0, 4)) - 8)
  end function ordinary

  !> The next number of Marsaglia's xorshift generator.
  subroutine draw(random)
    integer(int64), intent(inout) :: random
    random = ieor(random, shiftl(random, 13))
    random = ieor(random, shiftr(random, 7))
    random = ieor(random, shiftl(random, 17))
  end subroutine draw
end program check_numbers
