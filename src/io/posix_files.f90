!> Thin bindings for Linux to calls of the C library that Fortran does not offer. Error numbers are returned and not stored, so that
!> they are safe in several threads.
module posix_files
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_short, c_null_char, c_ptr, &
    c_size_t, c_loc, c_f_pointer, c_associated
  use posix_calls, only: file_status_t, poll_t, c_open, c_read, c_realpath, c_write, c_fsync, c_ftruncate, c_flock, &
    c_fallocate, c_stat, c_lstat, c_fstat, c_poll, c_close, c_rename, c_unlink, c_mkdir, c_rmdir, &
    c_opendir, c_readdir, c_closedir, c_isatty, c_errno_location, c_strerror_r
  use posix_signals, only: signal_set_t, hold_interrupts, restore_interrupts, interrupted, ignore_write_signals
  implicit none
  private
  public :: open_file, to_read, to_append, open_standard_input, open_for_writing, file_length, absolute_path, &
    read_bytes, write_all, truncate_file, reserve_file, synchronise_file, synchronise_folder, close_file, rename_file, &
    remove_file, make_directory, remove_folder, list_folder, longest_name, is_terminal, wait_for_input, error_text, signal_set_t, &
    hold_interrupts, restore_interrupts, interrupted, fill_standard_descriptors, ignore_write_signals
  public :: error_no_entry, error_interrupted, error_locked, error_is_directory, error_no_space, &
    error_broken_pipe, error_not_regular, error_is_link

  !> Error numbers of Linux, and two of this module: the file is neither a regular file nor a folder, and a symbolic link that must
  !> not be followed.
  integer, parameter :: error_no_entry = 2, error_interrupted = 4, error_locked = 11, error_no_access = 13, error_exists = 17, &
    error_not_directory = 20, error_is_directory = 21, error_invalid = 22, error_no_space = 28, error_broken_pipe = 32, &
    error_no_call = 38, error_not_supported = 95, error_not_regular = -1, error_is_link = -2

  !> Flags of open, as far as they are equal on all processors.
  integer(c_int), parameter :: read_only = 0, write_only = 1, read_and_write = 2, o_creat = 64, o_excl = 128, o_append = 1024, &
    o_nonblock = 2048, o_cloexec = 524288, to_read = read_only, to_append = ior(write_only, o_append)

  integer, parameter :: longest_name = 255   !! bytes of a name in a folder

  !> Kinds of files, as in their mode.
  integer, parameter :: kind_mask = 61440, kind_folder = 16384, kind_regular = 32768, kind_link = 40960
  integer(c_int), parameter :: lock_exclusive = 2, lock_without_waiting = 4
  integer(c_int), parameter :: file_mode = 438, folder_mode = 511   !! rw-rw-rw-, rwxrwxrwx, before the umask

contains

  !> Open the standard input of the program, which may be a pipe or a terminal: see `wait_for_input`.
  subroutine open_standard_input(descriptor, status)
    integer, intent(out) :: descriptor, status
    descriptor = c_open('/dev/stdin'//c_null_char, ior(read_only, o_cloexec), 0_c_int)
    status = outcome(descriptor)
  end subroutine open_standard_input

  !> Create a new file for writing, and lock it until it is closed. An existing file of that name is removed first, unless another
  !> program is writing it: then `status` is `error_locked`. (Following a symbolic link would let anyone who can write into the
  !> folder overwrite any file of the user.)
  subroutine open_for_writing(path, descriptor, status)
    character(len=*), intent(in) :: path
    integer, intent(out) :: descriptor, status
    integer, parameter :: most_tries = 1000
    integer :: ignored, try
    do try = 1, most_tries
      call create_file(path, descriptor, status)
      if (status == 0) then
        call lock_file(descriptor, status)
        if (status == 0) then
          if (is_file(path, descriptor)) return
        end if
      else if (status == error_exists) then
        call open_file(path, to_append, descriptor, status)
        if (status == 0) call lock_file(descriptor, status)
        if (status /= error_locked) call remove_file(path, status)
        if (status == error_no_entry) status = 0   ! another program has just removed it
      end if
      if (descriptor >= 0) call close_file(descriptor, ignored)
      descriptor = -1
      if (all(status /= [0, error_interrupted])) return
    end do
    status = error_exists
  end subroutine open_for_writing

  !> Create a file that does not exist yet. A symbolic link counts as an existing file.
  subroutine create_file(path, descriptor, status)
    character(len=*), intent(in) :: path
    integer, intent(out) :: descriptor, status
    descriptor = c_open(path//c_null_char, ior(ior(read_and_write, o_cloexec), ior(o_creat, o_excl)), file_mode)
    status = outcome(descriptor)
  end subroutine create_file

  !> Open an existing regular file in the way `to_read` or `to_append`, without waiting for the other end of a pipe; only
  !> for reading a symbolic link is followed. `status` is 0 or the error number.
  subroutine open_file(path, way, descriptor, status)
    character(len=*), intent(in) :: path
    integer, intent(in) :: way
    integer, intent(out) :: descriptor, status
    type(file_status_t) :: file
    integer :: ignored
    descriptor = c_open(path//c_null_char, ior(way, ior(o_nonblock, o_cloexec)), 0_c_int)
    status = outcome(descriptor)
    if (status /= 0) return
    select case (kind_of(file, c_fstat(descriptor, file)))
    case (kind_regular)
      if (way == to_read) return
      if (is_file(path, descriptor)) return
      status = error_no_entry
      if (kind_of(file, c_lstat(path//c_null_char, file)) == kind_link) status = error_is_link
    case (kind_folder)
      status = error_is_directory
    case default
      status = error_not_regular
    end select
    call close_file(descriptor, ignored)
    descriptor = -1
  end subroutine open_file

  !> Lock an open file for this opening of it, until it is closed or the program ends. `status` is `error_locked` if another opening
  !> holds the lock; on a file system without locks there is none, and `status` is 0.
  subroutine lock_file(descriptor, status)
    integer, intent(in) :: descriptor
    integer, intent(out) :: status
    status = outcome(c_flock(descriptor, ior(lock_exclusive, lock_without_waiting)))
    if (status /= error_locked) status = 0
  end subroutine lock_file

  !> Whether `path` is the name of this open file itself, and not of a link to it.
  logical function is_file(path, descriptor) result(answer)
    character(len=*), intent(in) :: path
    integer, intent(in) :: descriptor
    type(file_status_t) :: named, opened
    answer = .false.
    if (c_lstat(path//c_null_char, named) /= 0) return
    if (c_fstat(descriptor, opened) /= 0) return
    answer = all(named%halves(:4) == opened%halves(:4))   ! device and number
  end function is_file

  !> Length of a file in bytes; negative if it does not exist.
  integer(c_long) function file_length(path) result(length)
    character(len=*), intent(in) :: path
    type(file_status_t) :: file
    length = -1
    if (c_stat(path//c_null_char, file) == 0) length = transfer(file%halves(13:14), length)
  end function file_length

  !> The kind of a file; 0 if it cannot be determined. The place of the mode depends on the processor: it is where the root folder
  !> is a folder.
  integer function kind_of(file, status) result(kind_bits)
    type(file_status_t), intent(in) :: file
    integer(c_int), intent(in) :: status   !! of the call that has filled `file`
    type(file_status_t) :: root
    kind_bits = 0
    if (status /= 0) return
    if (c_stat('/'//c_null_char, root) /= 0) return
    kind_bits = iand(file%halves(merge(5, 7, iand(root%halves(5), kind_mask) == kind_folder)), kind_mask)
  end function kind_of

  !> One call of read: `done` bytes of `buffer` are filled, 0 at the end of the file.
  subroutine read_bytes(descriptor, buffer, done, status)
    integer, intent(in) :: descriptor
    character(len=*), intent(out), target :: buffer
    integer, intent(out) :: done, status
    done = int(c_read(descriptor, c_loc(buffer), len(buffer, c_size_t)))
    status = outcome(done)
  end subroutine read_bytes

  !> The absolute path of an existing file; the path itself if it has none.
  function absolute_path(path) result(whole)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: whole
    character(len=4097) :: buffer   ! PATH_MAX and the terminating null
    whole = path
    if (c_associated(c_realpath(path//c_null_char, buffer))) whole = buffer(:index(buffer, c_null_char) - 1)
  end function absolute_path

  !> Wait until everything written to a file is on its disk. Does not wait if the file system does not offer it.
  subroutine synchronise_file(descriptor, status)
    integer, intent(in) :: descriptor
    integer, intent(out) :: status
    status = outcome(c_fsync(descriptor))
    if (any(status == [error_invalid, error_no_call, error_not_supported])) status = 0
  end subroutine synchronise_file

  !> Wait until the names in the folder of `path` are on its disk. Does not wait if the file system does not offer it, or if the
  !> folder may be written but not read.
  subroutine synchronise_folder(path, status)
    character(len=*), intent(in) :: path   !! path of a file in the folder
    integer, intent(out) :: status
    integer :: descriptor, ignored
    descriptor = c_open('./'(:merge(0, 2, index(path, '/') > 0))//path(:index(path, '/', back=.true.))//c_null_char, &
                        ior(read_only, o_cloexec), 0_c_int)
    status = outcome(descriptor)
    if (status == error_no_access) status = 0
    if (descriptor < 0) return
    call synchronise_file(descriptor, status)
    call close_file(descriptor, ignored)
  end subroutine synchronise_folder

  !> Reserve disk space for the first `length` bytes of an open file; no effect if the file system does not support it. `status` is
  !> `error_no_space` if there is not enough space.
  subroutine reserve_file(descriptor, length, status)
    integer, intent(in) :: descriptor
    integer(c_long), intent(in) :: length
    integer, intent(out) :: status
    integer(c_int), parameter :: keep_length = 1
    status = outcome(c_fallocate(descriptor, keep_length, 0_c_long, length))
    if (status /= error_no_space) status = 0
  end subroutine reserve_file

  !> Write a text in as many calls as necessary: `done` bytes of it before an error.
  subroutine write_all(descriptor, text, done, status)
    integer, intent(in) :: descriptor
    character(len=*), intent(in), target :: text
    integer, intent(out) :: done, status
    integer :: more
    done = 0
    status = 0
    do while (done < len(text))
      more = int(c_write(descriptor, c_loc(text(done + 1:)), len(text, c_size_t) - done))
      status = outcome(more)
      if (status == error_interrupted) cycle
      if (status /= 0) return
      done = done + more
    end do
  end subroutine write_all

  !> Truncate an open file to `length` bytes. The position for the next write does not change.
  subroutine truncate_file(descriptor, length, status)
    integer, intent(in) :: descriptor
    integer(c_long), intent(in) :: length
    integer, intent(out) :: status
    status = outcome(c_ftruncate(descriptor, length))
  end subroutine truncate_file

  subroutine close_file(descriptor, status)
    integer, intent(in) :: descriptor
    integer, intent(out) :: status
    status = outcome(c_close(descriptor))
  end subroutine close_file

  !> Rename a file, replacing an existing file.
  subroutine rename_file(from, to, status)
    character(len=*), intent(in) :: from, to
    integer, intent(out) :: status
    status = outcome(c_rename(from//c_null_char, to//c_null_char))
  end subroutine rename_file

  subroutine remove_file(path, status)
    character(len=*), intent(in) :: path
    integer, intent(out) :: status
    status = outcome(c_unlink(path//c_null_char))
  end subroutine remove_file

  !> Make a folder and all its parents; an existing folder is not an error.
  subroutine make_directory(path, status)
    character(len=*), intent(in) :: path
    integer, intent(out) :: status
    type(file_status_t) :: file
    integer :: i
    do i = 2, len(path)
      if (path(i:i) == '/') status = c_mkdir(path(:i - 1)//c_null_char, folder_mode)
    end do
    status = outcome(c_mkdir(path//c_null_char, folder_mode))
    if (status /= error_exists) return
    status = 0
    if (kind_of(file, c_stat(path//c_null_char, file)) /= kind_folder) status = error_not_directory
  end subroutine make_directory

  !> Remove a folder, if it is empty.
  subroutine remove_folder(path)
    character(len=*), intent(in) :: path
    integer(c_int) :: unused
    unused = c_rmdir(path//c_null_char)
  end subroutine remove_folder

  !> The names in a folder, in any order, padded with blanks; none if it cannot be read.
  subroutine list_folder(path, names)
    character(len=*), intent(in) :: path
    character(len=longest_name), allocatable, intent(out) :: names(:)
    integer, parameter :: before_name = 19   !! bytes before d_name in the struct dirent of 64-bit Linux
    character(kind=c_char), pointer :: entry(:)
    character(len=longest_name), allocatable :: found(:)
    character(len=longest_name) :: name
    type(c_ptr) :: folder, at
    integer(c_int) :: unused
    integer :: i, n
    allocate (found(64))
    n = 0
    folder = c_opendir(path//c_null_char)
    do while (c_associated(folder))
      at = c_readdir(folder)
      if (.not. c_associated(at)) exit
      call c_f_pointer(at, entry, [before_name + longest_name])
      name = ''
      do i = 1, longest_name
        if (entry(before_name + i) == c_null_char) exit
        name(i:i) = entry(before_name + i)
      end do
      if (name == '.' .or. name == '..') cycle
      if (n == size(found)) found = [found, found]   ! more room
      n = n + 1
      found(n) = name
    end do
    if (c_associated(folder)) unused = c_closedir(folder)
    call move_alloc(found, names)
    names = names(:n)
  end subroutine list_folder

  !> Whether a file descriptor (1 standard output, 2 standard error) is a terminal.
  logical function is_terminal(descriptor) result(answer)
    integer, intent(in) :: descriptor
    answer = c_isatty(descriptor) == 1
  end function is_terminal

  !> Wait for data to read, or for their end, at most for the given time in ms. `has_input` is true also if reading would fail.
  subroutine wait_for_input(descriptor, milliseconds, has_input)
    integer, intent(in) :: descriptor, milliseconds
    logical, intent(out) :: has_input
    integer(c_short), parameter :: is_readable = 1   !! POLLIN
    type(poll_t) :: file
    file = poll_t(descriptor, is_readable, 0_c_short)
    has_input = c_poll(file, 1_c_long, milliseconds) > 0
  end subroutine wait_for_input

  !> The system's text for an error number.
  function error_text(number) result(text)
    integer, intent(in) :: number
    character(len=:), allocatable :: text
    character(len=256) :: buffer
    if (number == error_not_regular) text = 'not a regular file'
    if (number == error_is_link) text = 'a symbolic link'
    if (number < 0) return
    text = 'unknown error'
    if (c_strerror_r(number, buffer, len(buffer, c_size_t)) == 0) text = buffer(:index(buffer, c_null_char) - 1)
  end function error_text

  !> If the program was started without standard input, output or error, open them on /dev/null. Otherwise the first result file
  !> would get one of their numbers, and text for standard output would go into it.
  subroutine fill_standard_descriptors()
    integer :: descriptor
    integer(c_int), parameter :: last_standard = 2
    integer(c_int) :: unused
    do
      descriptor = c_open('/dev/null'//c_null_char, read_and_write, 0_c_int)
      if (descriptor < 0 .or. descriptor > last_standard) exit
    end do
    if (descriptor > last_standard) unused = c_close(descriptor)
  end subroutine fill_standard_descriptors

  !> 0 after success, else the error number of the last call.
  integer function outcome(returned) result(status)
    integer, intent(in) :: returned
    integer(c_int), pointer :: number
    status = 0
    if (returned >= 0) return
    call c_f_pointer(c_errno_location(), number)
    status = number
  end function outcome
end module posix_files
