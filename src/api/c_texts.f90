!> Texts to and from C. The base of all handles keeps the last message.
module c_texts
  use, intrinsic :: iso_c_binding, only: c_ptr, c_char, c_size_t, c_null_char, c_associated, c_f_pointer
  use error_handling, only: error_t
  implicit none
  private
  public :: out_of_turn, handle_t, get_text, get_bytes, put_text

  integer, parameter :: out_of_turn = 2   !! status of a call out of turn, of one with a wrong index or without a handle

  !> What C holds. Every handle keeps the message of its last error.
  type :: handle_t
    character(len=:), allocatable :: message
  contains
    procedure :: keep
    procedure :: refuse
  end type handle_t

  interface
    pure integer(c_size_t) function c_strlen(text) bind(c, name='strlen')
      import :: c_size_t, c_ptr
      type(c_ptr), value, intent(in) :: text
    end function c_strlen
  end interface

contains

  !> Keep the message of an error, if there is one; its status is returned, or 0.
  subroutine keep(self, error, status)
    class(handle_t), intent(inout) :: self
    type(error_t), allocatable, intent(in) :: error
    integer, intent(out) :: status
    status = 0
    if (.not. allocated(error)) return
    status = error%status
    self%message = error%message
  end subroutine keep

  !> Keep the message of a call out of turn, or with a wrong index.
  subroutine refuse(self, message, status)
    class(handle_t), intent(inout) :: self
    character(len=*), intent(in) :: message
    integer, intent(out) :: status
    self%message = message
    status = out_of_turn
  end subroutine refuse

  !> The text at an address that ends with a zero; empty without an address.
  subroutine get_text(address, text)
    type(c_ptr), intent(in) :: address
    character(len=:), allocatable, intent(out) :: text
    if (c_associated(address)) then
      call get_bytes(address, c_strlen(address), text)
    else
      text = ''
    end if
  end subroutine get_text

  !> A number of bytes at an address.
  subroutine get_bytes(address, length, text)
    type(c_ptr), intent(in) :: address
    integer(c_size_t), intent(in) :: length
    character(len=:), allocatable, intent(out) :: text
    character(kind=c_char), pointer :: bytes(:)
    integer(c_size_t) :: i
    allocate (character(len=length) :: text)
    if (length == 0) return
    call c_f_pointer(address, bytes, [length])
    do i = 1, length
      text(i:i) = bytes(i)
    end do
  end subroutine get_bytes

  !> Copy a text to an address where there are `size` bytes, with a final zero; what does not fit is left out.
  subroutine put_text(text, address, size)
    character(len=*), intent(in) :: text
    type(c_ptr), intent(in) :: address
    integer(c_size_t), intent(in) :: size
    character(kind=c_char), pointer :: bytes(:)
    integer(c_size_t) :: i, n
    if (.not. c_associated(address) .or. size < 1) return
    call c_f_pointer(address, bytes, [size])
    n = min(len(text, c_size_t), size - 1)
    do i = 1, n
      bytes(i) = text(i:i)
    end do
    bytes(n + 1) = c_null_char
  end subroutine put_text
end module c_texts
