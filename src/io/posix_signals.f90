!> Signals that would end the program are held until the program asks for them; see posix.c.
module posix_signals
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  implicit none
  private
  public :: signal_set_t, hold_interrupts, restore_interrupts, interrupted, ignore_write_signals

  !> Memory for a sigset_t, which has up to 128 bytes.
  type, bind(c) :: signal_set_t
    integer(c_long) :: words(16) = 0
  end type signal_set_t

  interface
    !> Hold SIGINT, SIGTERM and SIGHUP from now on, and what clusters send before they end a job: SIGUSR1, SIGUSR2 and SIGXCPU.
    !> Instead of ending the program they are reported by `interrupted`. A signal that the program was started to ignore remains
    !> ignored. Must be called before any thread is started. `before` receives the previous mask, for `restore_interrupts`.
    subroutine hold_interrupts(before) bind(c, name='system_hold_signals')
      import :: signal_set_t
      type(signal_set_t), intent(inout) :: before
    end subroutine hold_interrupts

    !> Restore the signal mask of this thread. A signal that has arrived in the meantime ends the program here.
    subroutine restore_interrupts(before) bind(c, name='system_restore_signals')
      import :: signal_set_t
      type(signal_set_t), intent(in) :: before
    end subroutine restore_interrupts

    !> Ignore the signals for writing to a closed pipe or beyond the limit of the file size, so that the write returns an error
    !> number instead of ending the program.
    subroutine ignore_write_signals() bind(c, name='system_ignore_write_signals')
    end subroutine ignore_write_signals

    integer(c_int) function c_interrupted() bind(c, name='system_interrupted') result(answer)
      import :: c_int
    end function c_interrupted
  end interface

contains

  !> Whether a held signal has arrived. A copy of this program ends here if the program itself has ended.
  logical function interrupted() result(answer)
    answer = c_interrupted() /= 0
  end function interrupted
end module posix_signals
