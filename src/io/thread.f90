!> A thread for one piece of work, as a thin binding for Linux. An OpenMP region would serve too, but who waits at its end keeps
!> a processor busy for milliseconds, as long as a whole short run takes; here who waits sleeps.
module thread
  use, intrinsic :: iso_c_binding, only: c_funptr, c_int, c_intptr_t, c_null_ptr, c_ptr, c_int64_t
  implicit none
  private
  public :: thread_t, semaphore_t

  type :: thread_t
    private
    integer(c_intptr_t) :: handle = 0
    logical :: runs = .false.
  contains
    procedure :: start
    procedure :: join
  end type thread_t

  !> A number of permits that threads give and take; who takes one where there is none waits, asleep.
  type :: semaphore_t
    private
    integer(c_int64_t) :: words(4) = 0   !! a sem_t of Linux with glibc or musl
  contains
    procedure :: prepare
    procedure :: give
    procedure :: take
  end type semaphore_t

  interface
    function c_pthread_create(handle, attributes, routine, argument) bind(c, name='pthread_create') result(status)
      import :: c_funptr, c_int, c_intptr_t, c_ptr
      integer(c_intptr_t), intent(out) :: handle
      type(c_ptr), value :: attributes
      type(c_funptr), value :: routine
      type(c_ptr), value :: argument
      integer(c_int) :: status
    end function c_pthread_create
    function c_pthread_join(handle, answer) bind(c, name='pthread_join') result(status)
      import :: c_int, c_intptr_t, c_ptr
      integer(c_intptr_t), value :: handle
      type(c_ptr), value :: answer
      integer(c_int) :: status
    end function c_pthread_join
    function c_sem_init(semaphore, between_processes, value) bind(c, name='sem_init') result(status)
      import :: c_int, c_int64_t
      integer(c_int64_t), intent(inout) :: semaphore(*)
      integer(c_int), value :: between_processes, value
      integer(c_int) :: status
    end function c_sem_init
    function c_sem_post(semaphore) bind(c, name='sem_post') result(status)
      import :: c_int, c_int64_t
      integer(c_int64_t), intent(inout) :: semaphore(*)
      integer(c_int) :: status
    end function c_sem_post
    function c_sem_wait(semaphore) bind(c, name='sem_wait') result(status)
      import :: c_int, c_int64_t
      integer(c_int64_t), intent(inout) :: semaphore(*)
      integer(c_int) :: status
    end function c_sem_wait
  end interface

contains

  !> Begin with so many permits, before another thread knows of them. It stays where it is from here on.
  subroutine prepare(self, permits)
    class(semaphore_t), intent(inout) :: self
    integer, intent(in) :: permits
    integer(c_int) :: unimportant
    unimportant = c_sem_init(self%words, 0_c_int, int(permits, c_int))
  end subroutine prepare

  subroutine give(self)
    class(semaphore_t), intent(inout) :: self
    integer(c_int) :: unimportant
    unimportant = c_sem_post(self%words)
  end subroutine give

  !> What the givers have written before is then there to be read.
  subroutine take(self)
    class(semaphore_t), intent(inout) :: self
    do while (c_sem_wait(self%words) /= 0)   ! a signal may wake who waits
    end do
  end subroutine take

  !> Call the function `routine`, in C void *(void *), with `argument` in a thread of its own. `has_started` is false where the
  !> system gives none: nothing has been done then.
  subroutine start(self, routine, argument, has_started)
    class(thread_t), intent(inout) :: self
    type(c_funptr), intent(in) :: routine
    type(c_ptr), intent(in) :: argument
    logical, intent(out) :: has_started
    self%runs = c_pthread_create(self%handle, c_null_ptr, routine, argument) == 0
    has_started = self%runs
  end subroutine start

  !> Wait for its end, if it runs.
  subroutine join(self)
    class(thread_t), intent(inout) :: self
    integer(c_int) :: unimportant
    if (self%runs) unimportant = c_pthread_join(self%handle, c_null_ptr)
    self%runs = .false.
  end subroutine join
end module thread
