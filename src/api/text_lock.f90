!> One lock for all that works with texts. gfortran keeps the length of every function result of deferred length in static memory:
!> two threads must not read, build or describe cases at the same time. The advance of a run calls no such function.
module text_lock
  use, intrinsic :: iso_c_binding, only: c_int, c_int64_t
  implicit none
  private
  public :: lock_texts, unlock_texts

  integer(c_int64_t) :: mutex(8) = 0   !! a mutex of the system; on Linux one of zeros is unlocked

  interface
    integer(c_int) function c_lock(mutex) bind(c, name='pthread_mutex_lock')
      import :: c_int, c_int64_t
      integer(c_int64_t), intent(inout) :: mutex(*)
    end function c_lock

    integer(c_int) function c_unlock(mutex) bind(c, name='pthread_mutex_unlock')
      import :: c_int, c_int64_t
      integer(c_int64_t), intent(inout) :: mutex(*)
    end function c_unlock
  end interface

contains

  !> Wait until no other thread works with texts.
  subroutine lock_texts()
    integer(c_int) :: unused
    unused = c_lock(mutex)
  end subroutine lock_texts

  subroutine unlock_texts()
    integer(c_int) :: unused
    unused = c_unlock(mutex)
  end subroutine unlock_texts
end module text_lock
