!> Files and folders by the calls of POSIX that Fortran does not offer; see posix.c. Error numbers are returned, not stored, so that
!> they are safe in several threads.
module posix_files
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_null_char, c_ptr, c_size_t, c_loc, c_f_pointer, c_associated
  use posix_signals, only: signal_set_t, hold_interrupts, restore_interrupts, interrupted, ignore_write_signals
  implicit none
  private
  public :: open_file, to_read, to_append, open_standard_input, open_for_writing, file_length, absolute_path, &
    read_bytes, write_all, truncate_file, reserve_file, synchronise_file, synchronise_folder, close_file, rename_file, &
    remove_file, make_directory, remove_folder, list_folder, longest_name, is_terminal, wait_for_input, error_text, signal_set_t, &
    hold_interrupts, restore_interrupts, interrupted, fill_standard_descriptors, ignore_write_signals
  public :: error_no_entry, error_interrupted, error_locked, error_is_directory, error_no_space, &
    error_broken_pipe, error_not_regular, error_is_link

  !> Error numbers that are the same on every system, and three of this module: the file is neither a regular file nor a folder, a
  !> symbolic link that must not be followed, and a file that another run is writing.
  integer, parameter :: error_no_entry = 2, error_interrupted = 4, error_no_access = 13, error_exists = 17, &
    error_not_directory = 20, error_is_directory = 21, error_no_space = 28, error_broken_pipe = 32, &
    error_not_regular = -1, error_is_link = -2, error_locked = -3

  !> Ways of opening, and kinds of files: see posix.c.
  integer, parameter :: to_read_as_is = 0, to_read = 1, to_append = 2, to_create = 3, to_read_and_write = 4
  integer, parameter :: kind_regular = 1, kind_folder = 2

  integer, parameter :: longest_name = 255   !! bytes of a name in a folder
  integer(c_int), parameter :: folder_mode = 511   !! rwxrwxrwx, before the umask

  interface
    integer(c_int) function c_error() bind(c, name='system_error') result(number)
      import :: c_int
    end function c_error
    subroutine c_error_text(number, text, size) bind(c, name='system_error_text')
      import :: c_int, c_char, c_size_t
      integer(c_int), value :: number
      character(kind=c_char), intent(out) :: text(*)
      integer(c_size_t), value :: size
    end subroutine c_error_text
    integer(c_int) function c_open(path, way) bind(c, name='system_open') result(descriptor)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: way
    end function c_open
    integer(c_int) function c_kind(descriptor, path) bind(c, name='system_kind') result(kind_of)
      import :: c_char, c_int
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: path(*)
    end function c_kind
    integer(c_int) function c_is_name(path, descriptor) bind(c, name='system_is_name') result(answer)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: descriptor
    end function c_is_name
    integer(c_int) function c_lock(descriptor) bind(c, name='system_lock') result(answer)
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_lock
    integer(c_int) function c_synchronise(descriptor) bind(c, name='system_synchronise') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_synchronise
    integer(c_int) function c_has_input(descriptor, milliseconds) bind(c, name='system_has_input') result(answer)
      import :: c_int
      integer(c_int), value :: descriptor, milliseconds
    end function c_has_input
    type(c_ptr) function c_next_name(folder) bind(c, name='system_next_name') result(name)
      import :: c_ptr
      type(c_ptr), value :: folder
    end function c_next_name
    type(c_ptr) function c_opendir(path) bind(c, name='opendir') result(folder)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
    end function c_opendir
    integer(c_int) function c_closedir(folder) bind(c, name='closedir') result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: folder
    end function c_closedir
    integer(c_long) function c_read(descriptor, buffer, count) bind(c, name='read') result(done)
      import :: c_int, c_ptr, c_size_t, c_long
      integer(c_int), value :: descriptor
      type(c_ptr), value :: buffer
      integer(c_size_t), value :: count
    end function c_read
    integer(c_long) function c_write(descriptor, buffer, count) bind(c, name='write') result(done)
      import :: c_int, c_ptr, c_size_t, c_long
      integer(c_int), value :: descriptor
      type(c_ptr), value :: buffer
      integer(c_size_t), value :: count
    end function c_write
    integer(c_long) function c_seek(descriptor, offset, from) bind(c, name='lseek') result(place)
      import :: c_int, c_long
      integer(c_int), value :: descriptor, from
      integer(c_long), value :: offset
    end function c_seek
    integer(c_int) function c_truncate(descriptor, length) bind(c, name='ftruncate') result(status)
      import :: c_int, c_long
      integer(c_int), value :: descriptor
      integer(c_long), value :: length
    end function c_truncate
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
    integer(c_int) function c_isatty(descriptor) bind(c, name='isatty') result(answer)
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_isatty
    type(c_ptr) function c_realpath(path, resolved) bind(c, name='realpath') result(answer)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(out) :: resolved(*)
    end function c_realpath
  end interface

contains


  !> Open the standard input of the program, which may be a pipe or a terminal: see `wait_for_input`.
  subroutine open_standard_input(descriptor, status)
    integer, intent(out) :: descriptor, status
    descriptor = c_open('/dev/stdin'//c_null_char, to_read_as_is)
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
          if (c_is_name(path//c_null_char, descriptor) == 1) return
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
    descriptor = c_open(path//c_null_char, to_create)
    status = outcome(descriptor)
  end subroutine create_file

  !> Open an existing regular file in the way `to_read` or `to_append`, without waiting for the other end of a pipe; only
  !> for reading a symbolic link is followed. `status` is 0 or the error number.
  subroutine open_file(path, way, descriptor, status)
    character(len=*), intent(in) :: path
    integer, intent(in) :: way
    integer, intent(out) :: descriptor, status
    integer, parameter :: is_none = 0, is_link = 2
    integer :: ignored
    descriptor = c_open(path//c_null_char, way)
    status = outcome(descriptor)
    if (status /= 0) return
    select case (c_kind(descriptor, c_null_char))
    case (kind_regular)
      if (way == to_read) return
      select case (c_is_name(path//c_null_char, descriptor))
      case (is_none)
        status = error_no_entry
      case (is_link)
        status = error_is_link
      case default
        return
      end select
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
    status = merge(error_locked, 0, c_lock(descriptor) == 1)
  end subroutine lock_file

  !> Length of a file in bytes; negative if it does not exist.
  integer(c_long) function file_length(path) result(length)
    character(len=*), intent(in) :: path
    logical :: exists
    inquire (file=path, exist=exists, size=length)
    if (.not. exists) length = -1
  end function file_length

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
    status = outcome(c_synchronise(descriptor))
  end subroutine synchronise_file

  !> Wait until the names in the folder of `path` are on its disk. Does not wait if the file system does not offer it, or if the
  !> folder may be written but not read.
  subroutine synchronise_folder(path, status)
    character(len=*), intent(in) :: path   !! path of a file in the folder
    integer, intent(out) :: status
    integer :: descriptor, ignored
    descriptor = c_open('./'(:merge(0, 2, index(path, '/') > 0))//path(:index(path, '/', back=.true.))//c_null_char, to_read_as_is)
    status = outcome(descriptor)
    if (status == error_no_access) status = 0
    if (descriptor < 0) return
    call synchronise_file(descriptor, status)
    call close_file(descriptor, ignored)
  end subroutine synchronise_folder

  !> Reserve disk space for the first `length` bytes of an empty open file: blanks, which what is written next replaces.
  subroutine reserve_file(descriptor, length, status)
    integer, intent(in) :: descriptor
    integer, intent(in) :: length
    integer, intent(out) :: status
    integer(c_int), parameter :: from_start = 0
    integer :: done
    call write_all(descriptor, repeat(' ', length), done, status)
    if (c_seek(descriptor, 0_c_long, from_start) /= 0 .and. status == 0) status = error_not_regular
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
    status = outcome(c_truncate(descriptor, length))
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
    integer :: i
    do i = 2, len(path)
      if (path(i:i) == '/') status = c_mkdir(path(:i - 1)//c_null_char, folder_mode)
    end do
    status = outcome(c_mkdir(path//c_null_char, folder_mode))
    if (status /= error_exists) return
    status = merge(0, error_not_directory, c_kind(-1_c_int, path//c_null_char) == kind_folder)
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
      at = c_next_name(folder)
      if (.not. c_associated(at)) exit
      call c_f_pointer(at, entry, [longest_name])
      name = ''
      do i = 1, longest_name
        if (entry(i) == c_null_char) exit
        name(i:i) = entry(i)
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
    has_input = c_has_input(descriptor, milliseconds) == 1
  end subroutine wait_for_input

  !> The system's text for an error number.
  function error_text(number) result(text)
    integer, intent(in) :: number
    character(len=:), allocatable :: text
    character(len=256) :: buffer
    if (number == error_not_regular) text = 'not a regular file'
    if (number == error_is_link) text = 'a symbolic link'
    if (number < 0) return
    call c_error_text(number, buffer, len(buffer, c_size_t))
    text = buffer(:index(buffer, c_null_char) - 1)
  end function error_text

  !> If the program was started without standard input, output or error, open them on /dev/null. Otherwise the first result file
  !> would get one of their numbers, and text for standard output would go into it.
  subroutine fill_standard_descriptors()
    integer :: descriptor
    integer(c_int), parameter :: last_standard = 2
    integer(c_int) :: unused
    do
      descriptor = c_open('/dev/null'//c_null_char, to_read_and_write)
      if (descriptor < 0 .or. descriptor > last_standard) exit
    end do
    if (descriptor > last_standard) unused = c_close(descriptor)
  end subroutine fill_standard_descriptors

  !> 0 after success, else the error number of the last call.
  integer function outcome(returned) result(status)
    integer, intent(in) :: returned
    status = 0
    if (returned < 0) status = c_error()
  end function outcome
end module posix_files
