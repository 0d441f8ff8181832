!> Compares `number_writer` with a formatted write: check_numbers [NUMBERS] (10000000). Half of the numbers are any bits,
!> half have ordinary magnitudes; the significant digits change from number to number. Then times both. Ends with `N passed,
!> N failed`.
program check_numbers
  use, intrinsic :: iso_fortran_env, only: int64, output_unit
  use kinds, only: dp
  use number_writer, only: number_writer_t, append_formatted, longest_number, fewest_digits, most_digits
  implicit none
  real(dp), parameter :: least_gain = 8
  integer :: n, wrong, undecided, passed
  real(dp) :: gain
  character(len=16) :: argument

  n = 10000000
  call get_command_argument(1, argument)
  if (argument /= '') read (argument, *) n
  call compare(n, wrong, undecided)
  write (output_unit, '(i0,a,i0,a,i0,a)') n, ' numbers: ', wrong, ' differ, ', undecided, ' left to a formatted write'
  call time_both(gain)
  passed = count([wrong == 0, undecided <= n/1000000, gain >= least_gain])
  write (output_unit, '(i0,a,i0,a)') passed, ' passed, ', 3 - passed, ' failed'
  if (passed < 3) error stop 1

contains

  subroutine compare(n, wrong, undecided)
    integer, intent(in) :: n
    integer, intent(out) :: wrong, undecided
    type(number_writer_t) :: writers(fewest_digits:most_digits)
    character(len=longest_number) :: line, expected
    integer(int64) :: random
    real(dp) :: value
    integer :: i, digits, used, length
    do digits = fewest_digits, most_digits
      call writers(digits)%prepare(digits)
    end do
    wrong = 0
    undecided = 0
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
      if (.not. writers(digits)%decides(value)) undecided = undecided + 1
      if (line(:used) == expected(:length)) cycle
      wrong = wrong + 1
      if (wrong <= 10) write (output_unit, '(4a)') line(:used), ' should be ', expected(:length)
    end do
  end subroutine compare

  !> Nanoseconds a number with 10 digits, in rows, the best of several rounds, and their ratio.
  subroutine time_both(gain)
    real(dp), intent(out) :: gain
    integer, parameter :: rounds = 15, n = 20000, row = 25
    character(len=n*(longest_number + 1)) :: text
    type(number_writer_t) :: writer
    real(dp) :: values(n), fast, slow
    integer(int64) :: random, began, ended, rate
    integer :: i, j, used

    random = 88172645463325252_int64
    do i = 1, n
      call draw(random)
      values(i) = ordinary(random)
    end do
    call writer%prepare(10)
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
        write (text(used + 1:used + 16), '(es16.9e2)') values(i)
        used = used + 16
      end do
      call system_clock(ended)
      slow = min(slow, 1e9_dp*real(ended - began, dp)/real(rate, dp)/n)
    end do
    gain = slow/fast
    write (output_unit, '(3(a,f0.1))') 'ns a number: ', fast, ', formatted write ', slow, ', ratio ', gain
  end subroutine time_both

  !> A number of either sign between some 1e-13 and 1e8.
  pure real(dp) function ordinary(random)
    integer(int64), intent(in) :: random
    ordinary = real(random, dp)*2.0_dp**(-63)*10.0_dp**(int(ibits(random, 0, 4)) - 8)
  end function ordinary

  !> The next of Marsaglia's xorshift numbers.
  subroutine draw(random)
    integer(int64), intent(inout) :: random
    random = ieor(random, shiftl(random, 13))
    random = ieor(random, shiftr(random, 7))
    random = ieor(random, shiftl(random, 17))
  end subroutine draw
end program check_numbers
