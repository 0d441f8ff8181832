!> Signals, as thin bindings for Linux: signals that would end the program are held until the program asks for them.
module posix_signals
  use, intrinsic :: iso_c_binding, only: c_int, c_intptr_t, c_long
  implicit none
  private
  public :: signal_set_t, hold_interrupts, restore_interrupts, interrupted, ignore_write_signals

  integer(c_int), parameter :: signal_hangup = 1, signal_interrupt = 2, signal_user_1 = 10, signal_user_2 = 12, &
    signal_pipe = 13, signal_terminate = 15, signal_processor_time = 24, signal_file_size = 25
  integer(c_int), parameter :: held(6) = [signal_hangup, signal_interrupt, signal_user_1, signal_user_2, signal_terminate, &
    signal_processor_time]
  integer(c_int), parameter :: signal_block = 0, signal_set_mask = 2
  integer(c_intptr_t), parameter :: ignore_handler = 1, error_handler = -1

  !> Memory for a sigset_t of Linux, 128 bytes.
  type, bind(c) :: signal_set_t
    integer(c_long) :: words(16) = 0
  end type signal_set_t

  interface
    integer(c_int) function c_sigaddset(set, number) bind(c, name='sigaddset') result(status)
      import :: signal_set_t, c_int
      type(signal_set_t), intent(inout) :: set
      integer(c_int), value :: number
    end function c_sigaddset
    integer(c_int) function c_sigismember(set, number) bind(c, name='sigismember') result(answer)
      import :: signal_set_t, c_int
      type(signal_set_t), intent(in) :: set
      integer(c_int), value :: number
    end function c_sigismember
    integer(c_int) function c_sigpending(set) bind(c, name='sigpending') result(status)
      import :: signal_set_t, c_int
      type(signal_set_t), intent(inout) :: set
    end function c_sigpending
    integer(c_int) function c_sigmask(how, set, old) bind(c, name='pthread_sigmask') result(status)
      import :: signal_set_t, c_int
      integer(c_int), value :: how
      type(signal_set_t), intent(in) :: set
      type(signal_set_t), intent(inout) :: old
    end function c_sigmask
    integer(c_intptr_t) function c_signal(number, handler) bind(c, name='signal') result(old)
      import :: c_int, c_intptr_t
      integer(c_int), value :: number
      integer(c_intptr_t), value :: handler
    end function c_signal
  end interface

contains

  !> Hold SIGINT, SIGTERM and SIGHUP from now on, and what clusters send before they end a job: SIGUSR1, SIGUSR2 and SIGXCPU.
  !> Instead of ending the program they are reported by `interrupted`. A signal that the program was started to ignore remains
  !> ignored. Must be called before any thread is started. `before` receives the previous mask, for `restore_interrupts`.
  subroutine hold_interrupts(before)
    type(signal_set_t), intent(out), optional :: before
    type(signal_set_t) :: set, old
    integer(c_intptr_t) :: handler, unused
    integer(c_int) :: status
    integer :: i
    do i = 1, size(held)
      handler = c_signal(held(i), ignore_handler)
      if (handler == ignore_handler) cycle
      if (handler /= error_handler) unused = c_signal(held(i), handler)
      status = c_sigaddset(set, held(i))
    end do
    status = c_sigmask(signal_block, set, old)
    if (present(before)) before = old
  end subroutine hold_interrupts

  !> Restore the signal mask of this thread. A signal that has arrived in the meantime ends the program here.
  subroutine restore_interrupts(before)
    type(signal_set_t), intent(in) :: before
    type(signal_set_t) :: unused
    integer(c_int) :: status
    status = c_sigmask(signal_set_mask, before, unused)
  end subroutine restore_interrupts

  !> Whether a held signal has arrived.
  logical function interrupted() result(answer)
    type(signal_set_t) :: pending
    integer :: i
    answer = .false.
    if (c_sigpending(pending) /= 0) return
    do i = 1, size(held)
      if (c_sigismember(pending, held(i)) == 1) answer = .true.
    end do
  end function interrupted

  !> Ignore the signals for writing to a closed pipe or beyond the limit of the file size, so that the write returns an error number
  !> instead of ending the program.
  subroutine ignore_write_signals()
    integer(c_intptr_t) :: unused
    unused = c_signal(signal_pipe, ignore_handler)
    unused = c_signal(signal_file_size, ignore_handler)
  end subroutine ignore_write_signals
end module posix_signals
