!> A checksum of texts: CRC-64 with the reflected polynomial of ECMA-182 (CRC-64/XZ).
module checksums
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: checksum_t, checksum_of, checksum_length

  integer, parameter :: checksum_length = 8   !! number of bytes of a checksum behind its text

  integer(int64), parameter :: polynomial = ior(shiftl(int(z'C96C5795', int64), 32), int(z'D7870F42', int64))
  integer(int64), parameter :: byte = 255

  !> Change of the checksum by a byte: its bits are shifted out at the right, one in each iteration.
  integer(int64), parameter :: digits(0:15) = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]
  integer(int64), parameter :: byte_values(0:255) = reshape(spread(digits, 2, 16) + 16*spread(digits, 1, 16), [256])
  integer(int64), parameter :: bit_1(0:255) = ieor(shiftr(byte_values, 1), iand(-iand(byte_values, 1_int64), polynomial))
  integer(int64), parameter :: bit_2(0:255) = ieor(shiftr(bit_1, 1), iand(-iand(bit_1, 1_int64), polynomial))
  integer(int64), parameter :: bit_3(0:255) = ieor(shiftr(bit_2, 1), iand(-iand(bit_2, 1_int64), polynomial))
  integer(int64), parameter :: bit_4(0:255) = ieor(shiftr(bit_3, 1), iand(-iand(bit_3, 1_int64), polynomial))
  integer(int64), parameter :: bit_5(0:255) = ieor(shiftr(bit_4, 1), iand(-iand(bit_4, 1_int64), polynomial))
  integer(int64), parameter :: bit_6(0:255) = ieor(shiftr(bit_5, 1), iand(-iand(bit_5, 1_int64), polynomial))
  integer(int64), parameter :: bit_7(0:255) = ieor(shiftr(bit_6, 1), iand(-iand(bit_6, 1_int64), polynomial))
  integer(int64), parameter :: last(0:255) = ieor(shiftr(bit_7, 1), iand(-iand(bit_7, 1_int64), polynomial))

  !> The checksum of the texts added so far, as one text.
  type :: checksum_t
    integer(int64) :: sum = 0   !! its 64 bits
  contains
    procedure :: add
    procedure :: hexadecimal
  end type checksum_t

contains

  pure subroutine add(self, text)
    class(checksum_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer(int64) :: sum
    integer :: i
    sum = not(self%sum)
    do i = 1, len(text)
      sum = ieor(shiftr(sum, 8), last(iand(ieor(sum, ichar(text(i:i), int64)), byte)))
    end do
    self%sum = not(sum)
  end subroutine add

  !> The checksum as 16 hexadecimal digits.
  pure function hexadecimal(self) result(text)
    class(checksum_t), intent(in) :: self
    character(len=16) :: text
    write (text, '(z16.16)') self%sum
  end function hexadecimal

  !> The checksum of some bytes, as bytes.
  pure function checksum_of(bytes) result(mark)
    character(len=*), intent(in) :: bytes
    character(len=checksum_length) :: mark
    type(checksum_t) :: sum
    call sum%add(bytes)
    mark = transfer(sum%sum, mark)
  end function checksum_of
end module checksums
