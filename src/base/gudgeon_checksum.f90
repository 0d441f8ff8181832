!> A checksum that tells texts apart: CRC-64 with the polynomial of ECMA-182, reflected (CRC-64/XZ), eight bytes at a time.
module gudgeon_checksum
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: checksum_t

  integer(int64), parameter :: polynomial = ior(shiftl(int(z'C96C5795', int64), 32), int(z'D7870F42', int64))
  integer(int64), parameter :: byte = 255

  !> What a byte does to the sum: its bits leave at the right, one a line.
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

  !> The same with 1 to 7 zero bytes behind it, `last` being the last of eight.
  integer(int64), parameter :: seventh(0:255) = ieor(shiftr(last, 8), last(iand(last, byte)))
  integer(int64), parameter :: sixth(0:255) = ieor(shiftr(seventh, 8), last(iand(seventh, byte)))
  integer(int64), parameter :: fifth(0:255) = ieor(shiftr(sixth, 8), last(iand(sixth, byte)))
  integer(int64), parameter :: fourth(0:255) = ieor(shiftr(fifth, 8), last(iand(fifth, byte)))
  integer(int64), parameter :: third(0:255) = ieor(shiftr(fourth, 8), last(iand(fourth, byte)))
  integer(int64), parameter :: second(0:255) = ieor(shiftr(third, 8), last(iand(third, byte)))
  integer(int64), parameter :: first(0:255) = ieor(shiftr(second, 8), last(iand(second, byte)))

  !> The checksum of the texts added so far, as if they were one.
  type :: checksum_t
    integer(int64), private :: sum = 0
  contains
    procedure :: add
    procedure :: value
    procedure :: hexadecimal
  end type checksum_t

contains

  pure subroutine add(self, text)
    class(checksum_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer(int64) :: sum
    integer :: i, whole
    sum = not(self%sum)
    whole = len(text) - mod(len(text), 8)
    do i = 1, whole, 8
      sum = ieor(sum, transfer(text(i:i + 7), sum))   ! the first byte is the lowest
      sum = ieor(ieor(ieor(first(iand(sum, byte)), second(iand(shiftr(sum, 8), byte))), &
                      ieor(third(iand(shiftr(sum, 16), byte)), fourth(iand(shiftr(sum, 24), byte)))), &
                 ieor(ieor(fifth(iand(shiftr(sum, 32), byte)), sixth(iand(shiftr(sum, 40), byte))), &
                      ieor(seventh(iand(shiftr(sum, 48), byte)), last(shiftr(sum, 56)))))
    end do
    do i = whole + 1, len(text)
      sum = ieor(shiftr(sum, 8), last(iand(ieor(sum, ichar(text(i:i), int64)), byte)))
    end do
    self%sum = not(sum)
  end subroutine add

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
end module gudgeon_checksum
