!> Interfaces of calls of the C library and their structures on Linux; posix_files provides procedures that use them.
module posix_calls
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_int32_t, c_long, c_short, c_ptr, c_size_t
  implicit none
  private
  public :: file_status_t, poll_t
  public :: c_open, c_read, c_realpath, c_write, c_fsync, c_ftruncate, c_flock, &
    c_fallocate, c_stat, c_lstat, c_fstat, c_poll, c_close, c_rename, c_unlink, c_mkdir, c_rmdir, c_opendir, c_readdir, &
    c_closedir, c_isatty, c_errno_location, c_strerror_r, c_exit

  !> The struct stat of 64-bit Linux, in halves of 8 bytes: the device is in the first two, the number of the file in the next two,
  !> its length in the 13th and 14th. Its mode is the 5th or 7th: see `kind_of`.
  type, bind(c) :: file_status_t
    integer(c_int32_t) :: halves(64) = 0
  end type file_status_t

  !> The struct pollfd of C.
  type, bind(c) :: poll_t
    integer(c_int) :: descriptor
    integer(c_short) :: wanted, found
  end type poll_t

  interface
    integer(c_int) function c_open(path, flags, mode) bind(c, name='open') result(descriptor)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags, mode
    end function c_open
    integer(c_long) function c_read(descriptor, buffer, count) bind(c, name='read') result(done)
      import :: c_int, c_ptr, c_size_t, c_long
      integer(c_int), value :: descriptor
      type(c_ptr), value :: buffer
      integer(c_size_t), value :: count
    end function c_read
    type(c_ptr) function c_realpath(path, resolved) bind(c, name='realpath') result(answer)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(out) :: resolved(*)
    end function c_realpath
    integer(c_long) function c_write(descriptor, buffer, count) bind(c, name='write') result(done)
      import :: c_int, c_ptr, c_size_t, c_long
      integer(c_int), value :: descriptor
      type(c_ptr), value :: buffer
      integer(c_size_t), value :: count
    end function c_write
    integer(c_int) function c_fsync(descriptor) bind(c, name='fsync') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_fsync
    integer(c_int) function c_ftruncate(descriptor, length) bind(c, name='ftruncate') result(status)
      import :: c_int, c_long
      integer(c_int), value :: descriptor
      integer(c_long), value :: length
    end function c_ftruncate
    integer(c_int) function c_flock(descriptor, operation) bind(c, name='flock') result(status)
      import :: c_int
      integer(c_int), value :: descriptor, operation
    end function c_flock
    integer(c_int) function c_fallocate(descriptor, mode, offset, length) bind(c, name='fallocate') result(status)
      import :: c_int, c_long
      integer(c_int), value :: descriptor, mode
      integer(c_long), value :: offset, length
    end function c_fallocate
    integer(c_int) function c_stat(path, file) bind(c, name='stat') result(status)
      import :: c_char, c_int, file_status_t
      character(kind=c_char), intent(in) :: path(*)
      type(file_status_t), intent(inout) :: file
    end function c_stat
    integer(c_int) function c_lstat(path, file) bind(c, name='lstat') result(status)
      import :: c_char, c_int, file_status_t
      character(kind=c_char), intent(in) :: path(*)
      type(file_status_t), intent(inout) :: file
    end function c_lstat
    integer(c_int) function c_fstat(descriptor, file) bind(c, name='fstat') result(status)
      import :: c_int, file_status_t
      integer(c_int), value :: descriptor
      type(file_status_t), intent(inout) :: file
    end function c_fstat
    integer(c_int) function c_poll(files, number, milliseconds) bind(c, name='poll') result(ready)
      import :: c_int, c_long, poll_t
      type(poll_t), intent(inout) :: files
      integer(c_long), value :: number
      integer(c_int), value :: milliseconds
    end function c_poll
    integer(c_int) function c_close(descriptor) bind(c, name='close') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_close
    integer(c_int) function c_rename(from, to) bind(c, name='rename') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: from(*), to(*)
    end function c_rename
    integer(c_int) function c_unlink(path) bind(c, name='unlink') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function c_unlink
    integer(c_int) function c_mkdir(path, mode) bind(c, name='mkdir') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
    end function c_mkdir
    integer(c_int) function c_rmdir(path) bind(c, name='rmdir') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function c_rmdir
    type(c_ptr) function c_opendir(path) bind(c, name='opendir') result(folder)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
    end function c_opendir
    type(c_ptr) function c_readdir(folder) bind(c, name='readdir') result(entry)
      import :: c_ptr
      type(c_ptr), value :: folder
    end function c_readdir
    integer(c_int) function c_closedir(folder) bind(c, name='closedir') result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: folder
    end function c_closedir
    integer(c_int) function c_isatty(descriptor) bind(c, name='isatty') result(answer)
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_isatty
    type(c_ptr) function c_errno_location() bind(c, name='__errno_location') result(location)
      import :: c_ptr
    end function c_errno_location
    integer(c_int) function c_strerror_r(number, buffer, length) bind(c, name='__xpg_strerror_r') result(status)
      import :: c_int, c_char, c_size_t
      integer(c_int), value :: number
      character(kind=c_char), intent(out) :: buffer(*)
      integer(c_size_t), value :: length
    end function c_strerror_r
    subroutine c_exit(status) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: status
    end subroutine c_exit
  end interface
end module posix_calls
