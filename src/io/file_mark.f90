!> How far a file has come: its length and a checksum of all bytes up to there.
module file_mark
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_archive, only: archive_t
  use gudgeon_checksum, only: checksum_t
  use gudgeon_posix, only: open_for_reading, read_at, close_file, error_interrupted
  implicit none
  private
  public :: file_mark_t

  integer, parameter :: buffer_size = 65536   !! bytes: it stays in the cache

  type :: file_mark_t
    integer(int64) :: length = 0
    integer(int64) :: checksum = 0
    type(checksum_t), private :: sum
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
    integer :: descriptor, status, wanted, done, ignored

    call open_for_reading(path, descriptor, status)
    is_there = status == 0
    if (.not. is_there) return
    do while (self%length < length)
      wanted = int(min(int(buffer_size, int64), length - self%length))
      call read_at(descriptor, self%length, buffer(:wanted), done, status)
      if (status == error_interrupted) cycle
      is_there = status == 0 .and. done > 0
      if (.not. is_there) exit
      call self%sum%add(buffer(:done))
      self%length = self%length + done
    end do
    call close_file(descriptor, ignored)
    self%checksum = self%sum%value()
  end subroutine move_to

  !> Length and checksum to or from an archive. What is read is a mark to compare with, not one to move on.
  subroutine exchange(self, archive)
    class(file_mark_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%length)
    call archive%exchange(self%checksum)
  end subroutine exchange
end module file_mark
