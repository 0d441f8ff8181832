!> How far a file has come: its length and a checksum of all bytes up to there, found fast enough for traces of gigabytes.
module file_mark
  use, intrinsic :: iso_fortran_env, only: int64
  use archive, only: archive_t
  use posix, only: open_for_reading, read_at, close_file, error_interrupted
  implicit none
  private
  public :: file_mark_t

  integer, parameter :: width = 8               !! bytes of a word
  integer, parameter :: buffer_size = 65536     !! bytes, a multiple of it: it stays in the cache

  !> The checksum is linear like a CRC: the register goes through the 2^64 - 1 states of Marsaglia's xorshift (2003), a word of
  !> the file added at each step.
  type :: file_mark_t
    integer(int64) :: length = 0
    integer(int64) :: checksum = 0
    integer(int64), private :: register = 1
    integer(int64), private :: taken = 0   !! bytes in the register, a multiple of the width
  contains
    procedure :: move_to
    procedure :: exchange
  end type file_mark_t

contains

  !> Move on to `length`, reading the file in between. `is_there` is false where it cannot be read so far; the mark is then
  !> of no use any more.
  subroutine move_to(self, path, length, is_there)
    class(file_mark_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(int64), intent(in) :: length
    logical, intent(out) :: is_there
    character(len=buffer_size) :: buffer
    character(len=width) :: rest
    integer :: descriptor, status, wanted, done, whole, ignored

    call open_for_reading(path, descriptor, status)
    is_there = status == 0
    if (.not. is_there) return
    rest = ''
    do while (self%taken < length)
      wanted = int(min(int(buffer_size, int64), length - self%taken))
      call read_at(descriptor, self%taken, buffer(:wanted), done, status)
      if (status == error_interrupted) cycle
      is_there = status == 0 .and. done == wanted
      if (.not. is_there) exit
      whole = wanted - mod(wanted, width)
      call take_words(self%register, buffer(:whole))
      self%taken = self%taken + whole
      rest = buffer(whole + 1:wanted)   ! not empty only at the end
      if (self%taken > length - width) exit
    end do
    call close_file(descriptor, ignored)
    self%length = length
    self%checksum = self%register
    call take_words(self%checksum, rest)
  end subroutine move_to

  !> Add whole words to a register.
  pure subroutine take_words(register, bytes)
    integer(int64), intent(inout) :: register
    character(len=*), intent(in) :: bytes
    integer(int64) :: sum
    integer :: i
    sum = register
    do i = 1, len(bytes), width
      sum = ieor(sum, shiftl(sum, 13))
      sum = ieor(sum, shiftr(sum, 7))
      sum = ieor(sum, shiftl(sum, 17))
      sum = ieor(sum, transfer(bytes(i:i + width - 1), sum))
    end do
    register = sum
  end subroutine take_words

  !> Length and checksum to or from an archive. What is read is a mark to compare with, not one to move on.
  subroutine exchange(self, archive)
    class(file_mark_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%length)
    call archive%exchange(self%checksum)
  end subroutine exchange
end module file_mark
