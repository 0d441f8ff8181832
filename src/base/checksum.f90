!> A checksum that tells texts apart: CRC-64 with the polynomial of ECMA-182, reflected (CRC-64/XZ), eight bytes at a time.
module checksum
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: checksum_t

  integer(int64), parameter :: polynomial = ior(shiftl(int(z'C96C5795', int64), 32), int(z'D7870F42', int64))
  integer, parameter :: width = 8   !! bytes taken together

  !> The checksum of the texts added so far, as if they were one.
  type :: checksum_t
    integer(int64), private :: sum = 0
    integer(int64), private :: table(0:255, 0:width - 1) = 0   !! of a byte, and of one with 1 to 7 zero bytes behind it
    logical, private :: is_ready = .false.
  contains
    procedure :: add
    procedure :: value
    procedure :: hexadecimal
  end type checksum_t

contains

  pure subroutine add(self, text)
    class(checksum_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer(int64) :: sum, next
    integer :: i, j, whole
    if (.not. self%is_ready) call make_table(self%table)
    self%is_ready = .true.
    sum = not(self%sum)
    whole = len(text) - mod(len(text), width)
    do i = 1, whole, width
      next = 0
      do j = 0, width - 1
        next = ieor(next, self%table(int(iand(ieor(shiftr(sum, 8*j), ichar(text(i + j:i + j), int64)), 255_int64)), &
                                     width - 1 - j))
      end do
      sum = next
    end do
    do i = whole + 1, len(text)
      sum = ieor(shiftr(sum, 8), self%table(int(iand(ieor(sum, ichar(text(i:i), int64)), 255_int64)), 0))
    end do
    self%sum = not(sum)
  end subroutine add

  !> What each byte does to the sum.
  pure subroutine make_table(table)
    integer(int64), intent(out) :: table(0:, 0:)
    integer :: i, bit
    do i = 0, 255
      table(i, 0) = i
      do bit = 1, 8
        if (btest(table(i, 0), 0)) then
          table(i, 0) = ieor(shiftr(table(i, 0), 1), polynomial)
        else
          table(i, 0) = shiftr(table(i, 0), 1)
        end if
      end do
    end do
    do bit = 1, width - 1
      do i = 0, 255
        table(i, bit) = ieor(shiftr(table(i, bit - 1), 8), table(int(iand(table(i, bit - 1), 255_int64)), 0))
      end do
    end do
  end subroutine make_table

  !> The 64 bits.
  pure integer(int64) function value(self)
    class(checksum_t), intent(in) :: self
    value = self%sum
  end function value

  !> 16 hexadecimal digits.
  pure function hexadecimal(self) result(text)
    class(checksum_t), intent(in) :: self
    character(len=16) :: text
    write (text, '(z16.16)') self%sum
  end function hexadecimal
end module checksum
