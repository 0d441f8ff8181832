!> Processes, as thin bindings for Linux: copies of this program that work beside it and write into a pipe.
module posix_processes
  use, intrinsic :: iso_c_binding, only: c_int, c_int64_t, c_long, c_size_t
  implicit none
  private
  public :: fork_worker, wait_for_worker, ask_to_end, leave_worker, open_pipe, available_processors

  integer(c_int), parameter :: signal_kill = 9, signal_terminate = 15, die_with_parent = 1, o_cloexec = 524288

  interface
    integer(c_int) function c_fork() bind(c, name='fork') result(process)
      import :: c_int
    end function c_fork
    integer(c_int) function c_waitpid(process, status, options) bind(c, name='waitpid') result(found)
      import :: c_int
      integer(c_int), value :: process, options
      integer(c_int), intent(out) :: status
    end function c_waitpid
    integer(c_int) function c_kill(process, number) bind(c, name='kill') result(status)
      import :: c_int
      integer(c_int), value :: process, number
    end function c_kill
    integer(c_int) function c_getppid() bind(c, name='getppid') result(process)
      import :: c_int
    end function c_getppid
    integer(c_int) function c_getpid() bind(c, name='getpid') result(process)
      import :: c_int
    end function c_getpid
    integer(c_int) function c_prctl(option, value) bind(c, name='prctl') result(status)
      import :: c_int, c_long
      integer(c_int), value :: option
      integer(c_long), value :: value
    end function c_prctl
    integer(c_int) function c_pipe(ends, flags) bind(c, name='pipe2') result(status)
      import :: c_int
      integer(c_int), intent(out) :: ends(2)
      integer(c_int), value :: flags
    end function c_pipe
    integer(c_int) function c_affinity(process, length, mask) bind(c, name='sched_getaffinity') result(status)
      import :: c_int, c_int64_t, c_size_t
      integer(c_int), value :: process
      integer(c_size_t), value :: length
      integer(c_int64_t), intent(out) :: mask(*)
    end function c_affinity
    subroutine c_exit_now(status) bind(c, name='_exit')
      import :: c_int
      integer(c_int), value :: status
    end subroutine c_exit_now
  end interface

contains

  !> Copy this process. In the copy `process` is 0; here it is its number, or negative if there can be no copy. The copy is killed
  !> when this process ends, in whatever way. OpenMP uses one thread in it: the threads of this process are not copied.
  subroutine fork_worker(process)
    !$ use omp_lib, only: omp_set_num_threads
    integer, intent(out) :: process
    integer(c_int) :: parent, unused
    parent = c_getpid()
    process = c_fork()
    if (process /= 0) return
    unused = c_prctl(die_with_parent, int(signal_kill, c_long))
    if (c_getppid() /= parent) call c_exit_now(1_c_int)   ! it ended before
    !$ call omp_set_num_threads(1)
  end subroutine fork_worker

  !> Wait for the end of a copy: the signal that killed it, 0 if it has left by itself.
  integer function wait_for_worker(process) result(killed_by)
    integer, intent(in) :: process
    integer(c_int) :: status
    do
      if (c_waitpid(process, status, 0_c_int) == process) exit
    end do
    killed_by = iand(status, 127)
  end function wait_for_worker

  !> Send a copy the signal that asks it to end.
  subroutine ask_to_end(process)
    integer, intent(in) :: process
    integer(c_int) :: unused
    unused = c_kill(process, signal_terminate)
  end subroutine ask_to_end

  !> End this process, which is a copy, at once.
  subroutine leave_worker()
    call c_exit_now(0_c_int)
  end subroutine leave_worker

  !> Open a pipe: what is written into the second descriptor can be read from the first. `is_open` is false if there is none.
  subroutine open_pipe(ends, is_open)
    integer, intent(out) :: ends(2)
    logical, intent(out) :: is_open
    is_open = c_pipe(ends, o_cloexec) == 0
  end subroutine open_pipe

  !> Number of processors that this program may use.
  integer function available_processors() result(number)
    integer(c_int64_t) :: mask(128)
    integer(c_int) :: unused
    mask = 0
    unused = c_affinity(0_c_int, int(8*size(mask), c_size_t), mask)
    number = max(1, sum(popcnt(mask)))
  end function available_processors
end module posix_processes
