!> A thread for one piece of work, as a thin binding for Linux. An OpenMP region would serve too, but who waits at its end keeps
!> a processor busy for milliseconds, as long as a whole short run takes; here who waits sleeps.
module thread
  use, intrinsic :: iso_c_binding, only: c_funptr, c_int, c_intptr_t, c_null_ptr, c_ptr
  implicit none
  private
  public :: thread_t

  type :: thread_t
    private
    integer(c_intptr_t) :: handle = 0
    logical :: runs = .false.
  contains
    procedure :: start
    procedure :: join
  end type thread_t

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
  end interface

contains

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
