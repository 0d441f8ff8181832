!> A checksum that tells texts apart: CRC-64 with the polynomial of ECMA-182, reflected (CRC-64/XZ).
module checksum
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: checksum_t

  integer(int64), parameter :: polynomial = ior(shiftl(int(z'C96C5795', int64), 32), int(z'D7870F42', int64))

  !> The checksum of the texts added so far, as if they were one.
  type :: checksum_t
    integer(int64), private :: sum = 0, table(0:255) = 0
    logical, private :: is_ready = .false.
  contains
    procedure :: add
    procedure :: hexadecimal
  end type checksum_t

contains

  pure subroutine add(self, text)
    class(checksum_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer :: i
    if (.not. self%is_ready) call make_table(self%table)
    self%is_ready = .true.
    self%sum = not(self%sum)
    do i = 1, len(text)
      self%sum = ieor(shiftr(self%sum, 8), self%table(int(iand(ieor(self%sum, ichar(text(i:i), int64)), 255_int64))))
    end do
    self%sum = not(self%sum)
  end subroutine add

  !> What each byte does to the sum.
  pure subroutine make_table(table)
    integer(int64), intent(out) :: table(0:255)
    integer :: i, bit
    do i = 0, 255
      table(i) = i
      do bit = 1, 8
        if (btest(table(i), 0)) then
          table(i) = ieor(shiftr(table(i), 1), polynomial)
        else
          table(i) = shiftr(table(i), 1)
        end if
      end do
    end do
  end subroutine make_table

  !> 16 hexadecimal digits.
  pure function hexadecimal(self) result(text)
    class(checksum_t), intent(in) :: self
    character(len=16) :: text
    write (text, '(z16.16)') self%sum
  end function hexadecimal
end module checksum
