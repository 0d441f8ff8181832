!> Copies of this program that work beside it and write into a pipe; see posix.c.
module posix_processes
  use, intrinsic :: iso_c_binding, only: c_int
  implicit none
  private
  public :: fork_worker, wait_for_worker, ask_to_end, leave_worker, open_pipe, available_processors, end_program

  interface
    integer(c_int) function c_fork() bind(c, name='system_fork') result(process)
      import :: c_int
    end function c_fork

    !> Wait for the end of a copy: the signal that killed it, 0 if it has left by itself.
    integer(c_int) function wait_for_worker(process) bind(c, name='system_wait') result(killed_by)
      import :: c_int
      integer(c_int), value :: process
    end function wait_for_worker

    !> Send a copy the signal that asks it to end.
    subroutine ask_to_end(process) bind(c, name='system_ask_to_end')
      import :: c_int
      integer(c_int), value :: process
    end subroutine ask_to_end

    !> End the program without a word of Fortran's.
    subroutine end_program(status) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: status
    end subroutine end_program

    subroutine c_exit_now(status) bind(c, name='_exit')
      import :: c_int
      integer(c_int), value :: status
    end subroutine c_exit_now
    integer(c_int) function c_pipe(ends) bind(c, name='pipe') result(status)
      import :: c_int
      integer(c_int), intent(out) :: ends(2)
    end function c_pipe
  end interface

contains

  !> Copy this process. In the copy `process` is 0; here it is its number, or negative if there can be no copy. The copy ends soon
  !> after this process, in whatever way that ends: see `interrupted`. OpenMP uses one thread in it: the threads of this process are
  !> not copied.
  subroutine fork_worker(process)
    !$ use omp_lib, only: omp_set_num_threads
    integer, intent(out) :: process
    process = c_fork()
    !$ if (process == 0) call omp_set_num_threads(1)
  end subroutine fork_worker

  !> End this process, which is a copy, at once.
  subroutine leave_worker()
    call c_exit_now(0_c_int)
  end subroutine leave_worker

  !> Open a pipe: what is written into the second descriptor can be read from the first. `is_open` is false if there is none.
  subroutine open_pipe(ends, is_open)
    integer, intent(out) :: ends(2)
    logical, intent(out) :: is_open
    is_open = c_pipe(ends) == 0
  end subroutine open_pipe

  !> Number of processors that this program may use.
  integer function available_processors() result(number)
    !$ use omp_lib, only: omp_get_num_procs
    number = 1
    !$ number = omp_get_num_procs()
  end function available_processors
end module posix_processes
