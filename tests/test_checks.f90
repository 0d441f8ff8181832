!> The test harness itself: what counts as one assertion, and that every failure is counted.
module test_checks
  use, intrinsic :: iso_fortran_env, only: int64
  use checks, only: checks_t, without_figures
  use kinds, only: dp
  implicit none
  private
  public :: run_test_checks

contains

  subroutine run_test_checks(check)
    class(checks_t), intent(inout) :: check
    call test_names(check)
    call test_counts(check)
  end subroutine run_test_checks

  subroutine test_names(check)
    class(checks_t), intent(inout) :: check
    call check%equal_text(without_figures('at 1e-6'), 'at #', 'a tolerance is a number')
    call check%equal_text(without_figures('k = 12, x = -3.5E+02 m'), 'k = #, x = # m', 'an order and a value')
    call check%equal_text(without_figures('1.0'), '#', 'a name that is a number')
    call check%equal_text(without_figures('dry_0100um of sim_V: -x'), 'dry_0100um of sim_V: -x', &
      'digits in a word and a single sign are kept')
    call check%equal_text(without_figures('(3) m2 and 3m'), '(#) m2 and #m', 'parentheses and units')
    call check%equal_text(without_figures(''), '', 'an empty name')
  end subroutine test_names

  !> A separate silent harness, whose failures are intended.
  subroutine test_counts(check)
    class(checks_t), intent(inout) :: check
    type(checks_t) :: own
    real(dp) :: nan
    integer :: i
    character(len=12) :: label

    own%is_silent = .true.
    call own%begin_suite('intended failures')
    call check%that(own%passed() == 0 .and. own%failed() == 0, 'nothing is counted before anything is asserted')
    do i = 1, 3000
      write (label, '(a,i0)') 'turn ', i
      call own%that(.true., label)
    end do
    call check%that(own%passed() == 1 .and. own%failed() == 0, 'an assertion in a loop is one assertion')
    do i = 0, 700
      call own%that(.true., 'word '//achar(97 + modulo(i, 26))//achar(97 + i/26))
    end do
    call check%that(own%passed() == 702, 'different names are different assertions, whatever their number')
    do i = 1, 20
      write (label, '(a,i0)') 'turn ', i
      call own%that(i /= 7, label)
    end do
    if (own%failed() == 0) error stop 'the test harness loses failures'   ! it could not report this itself
    call check%that(own%passed() == 701 .and. own%failed() == 1, 'an assertion that fails once has failed')
    nan = 0
    nan = transfer(-1_int64, nan)
    call own%close_to(nan, 1.0_dp, 1.0_dp, 'NaN')
    call check%that(own%failed() == 2, 'a NaN is not close to any value')
    do i = 1, 50
      call own%equal_text('a ', 'a', 'text')
    end do
    call check%that(own%failed() == 3, 'texts with different numbers of blanks differ')
    call own%begin_suite('another')
    call own%that(.true., 'text')
    call check%that(own%failed() == 3 .and. own%passed() == 702, 'the same name in another suite is another assertion')
  end subroutine test_counts
end module test_checks
