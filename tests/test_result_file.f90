!> Result files, and the system calls that they use.
module test_result_file
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: dp
  use error_handling, only: error_t, status_output
  use posix_processes, only: fork_worker, wait_for_worker, leave_worker
  use posix_files, only: make_directory, remove_file, open_file, to_read, to_append, read_bytes, close_file, error_text, &
    ignore_write_signals, synchronise_folder, file_length, error_no_entry, error_no_space, &
    error_is_directory, error_is_link, error_not_regular
  use result_file, only: result_file_t, remove_result
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_result_file

  interface
    function c_getrlimit(resource, limits) bind(c, name='getrlimit') result(status)
      import :: c_int, c_long
      integer(c_int), value :: resource
      integer(c_long), intent(out) :: limits(2)
      integer(c_int) :: status
    end function c_getrlimit
    function c_setrlimit(resource, limits) bind(c, name='setrlimit') result(status)
      import :: c_int, c_long
      integer(c_int), value :: resource
      integer(c_long), intent(in) :: limits(2)
      integer(c_int) :: status
    end function c_setrlimit
  end interface

  character(len=*), parameter :: n = achar(10), folder = 'build/test_result_file/deep'

contains

  subroutine run_test_result_file(check)
    class(checks_t), intent(inout) :: check
    integer :: status
    call make_directory(folder, status)
    call check%that(status == 0, 'folders are made')
    call make_directory(folder, status)
    call check%that(status == 0, 'a folder that exists is no error')
    call test_writing(check)
    call test_two_writers(check)
    call test_failures(check)
    call test_planted(check)
    call execute_command_line('rmdir '//folder, exitstat=status)
    call check%that(status == 0, 'nothing is left in the scratch folder')
    call execute_command_line('rmdir '//'build/test_result_file', exitstat=status)
  end subroutine run_test_result_file

  subroutine test_writing(check)
    class(checks_t), intent(inout) :: check
    type(result_file_t) :: file
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    integer :: i, status
    call file%open(folder//'/a.csv', error)
    call check%that(.not. allocated(error), 'a result is opened')
    do i = 1, 40000
      call file%append('0123456789'//n)
    end do
    call read_back(folder//'/a.csv', text, status)
    call check%that(status == error_no_entry, 'no file under the final name before it is closed')
    call read_back(folder//'/a.csv.part', text, status)
    call check%that(status == 0 .and. len(text) > 0, 'rows are written when the buffer is full')
    call check%that(mod(len(text), 11) == 0, 'only complete rows are written')
    call file%append(repeat('x', 300000)//n)
    call file%close(error)
    call check%that(.not. allocated(error), 'a result is closed')
    call read_back(folder//'/a.csv', text, status)
    call check%that(status == 0, 'the file has its final name')
    call check%that(text == repeat('0123456789'//n, 40000)//repeat('x', 300000)//n, 'all rows are there in order')
    call read_back(folder//'/a.csv.part', text, status)
    call check%that(status == error_no_entry, 'the temporary name is removed')
    call file%open(folder//'/a.csv', error)
    call file%append('new'//n)
    call file%close(error)
    call read_back(folder//'/a.csv', text, status)
    call check%equal_text(text, 'new'//n, 'a file is replaced')
    call file%open(folder//'/a.csv', error)
    call file%append('newer'//n)
    call file%abandon()
    call read_back(folder//'/a.csv', text, status)
    call check%equal_text(text, 'new'//n, 'an abandoned file does not replace the old one')
    call remove_file(folder//'/a.csv', status)
  end subroutine test_writing

  !> A file that is being written is not written by another run of this program or of another one; what a killed program has left
  !> is no obstacle.
  subroutine test_two_writers(check)
    class(checks_t), intent(inout) :: check
    type(result_file_t) :: one, other
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    integer :: status, process
    call execute_command_line('echo old > '//folder//'/a.csv.part')
    call one%open(folder//'/a.csv', error)
    call check%that(.not. allocated(error), 'a file left by a killed program is replaced')
    call one%append('one'//n)
    call one%flush()
    call other%open(folder//'/a.csv', error)
    call expect(check, error, folder//'/a.csv: another run is writing it; wait for it or choose another folder with --out')
    call other%append('other'//n)
    call other%close(error)
    call fork_worker(process)
    if (process == 0) then   ! the other program
      call other%open(folder//'/a.csv', error)
      if (allocated(error)) call execute_command_line('echo "'//error%message//'" > '//folder//'/said')
      call other%append('other'//n)
      call other%close(error)
      call leave_worker()
    end if
    status = wait_for_worker(process)
    call check%that(process > 0 .and. status == 0, 'another program')
    call read_back(folder//'/said', text, status)
    call check%equal_text(text, folder//'/a.csv: another run is writing it; wait for it or choose another folder with --out'//n, &
      'it is told')
    call one%close(error)
    call read_back(folder//'/a.csv', text, status)
    call check%equal_text(text, 'one'//n, 'the rows of the first one')
    call remove_file(folder//'/a.csv', status)
    call remove_file(folder//'/said', status)
  end subroutine test_two_writers

  subroutine test_failures(check)
    class(checks_t), intent(inout) :: check
    type(result_file_t) :: file
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    integer :: status
    call file%open(folder//'/none/a.csv', error)
    call expect(check, error, folder//'/none/a.csv: No such file or directory')
    call file%append('x'//n)
    call file%close(error)
    call check%that(.not. allocated(error), 'a file never opened is closed without an error')
    call limit_files(20, status)
    call file%open(folder//'/full.csv', error)
    call check%that(status == 0 .and. .not. allocated(error), 'a full disk opens')
    call file%append('whole row'//n//'row that does not fit'//n)
    call check%that(.not. file%has_failed(), 'a full disk is not detected while rows are in the buffer')
    call file%flush()
    call check%that(file%has_failed(), 'a full disk is detected')
    call file%close(error)
    call limit_files(-1, status)
    call expect(check, error, folder//'/full.csv: File too large')
    call read_back(folder//'/full.csv', text, status)
    call check%equal_text(text, 'whole row'//n, 'complete rows are kept')
    call remove_file(folder//'/full.csv', status)
    call check%equal_text(error_text(error_no_space), 'No space left on device', 'error text of the system')
    call make_directory('/dev/null/x', status)
    call check%that(status /= 0, 'no folder under a file')
    call make_directory('/dev/null', status)
    call check%that(status /= 0, 'a file is no folder')
  end subroutine test_failures

  !> Links and pipes in the place of a file to be written: links are neither followed nor emptied, and the program does not wait for
  !> the other end of a pipe.
  subroutine test_planted(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: victim = folder//'/victim', link = folder//'/link', pipe = folder//'/pipe'
    type(result_file_t) :: file
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    integer :: descriptor, status
    logical :: was_there
    call file%open(victim, error)
    call file%append('kept'//n)
    call file%close(error)
    call execute_command_line('ln -s victim '//link//' && ln -s victim '//folder//'/a.csv.part && mkfifo '//pipe, exitstat=status)
    call check%that(status == 0, 'links and a pipe are made')
    call file%open(folder//'/a.csv', error)
    call file%append('mine'//n)
    call file%close(error)
    call read_back(folder//'/a.csv', text, status)
    call check%equal_text(text, 'mine'//n, 'a link under the temporary name is replaced')
    call open_file(link, to_append, descriptor, status)
    call check%that(status == error_is_link, 'a link is not opened to add rows: '//error_text(status))
    call execute_command_line('ln -s nowhere '//folder//'/b.csv.part && mkfifo '//folder//'/c.csv.part')
    call file%open(folder//'/b.csv', error)
    call file%close(error)
    call check%that(.not. allocated(error), 'a link without a target is replaced')
    call check%that(file_length(folder//'/nowhere') < 0, 'the target of a link was not made')
    call file%open(folder//'/c.csv', error)
    call file%close(error)
    call check%that(.not. allocated(error), 'a pipe under the temporary name is replaced')
    call remove_file(folder//'/b.csv', status)
    call remove_file(folder//'/c.csv', status)
    call open_file(pipe, to_read, descriptor, status)
    call check%that(status == error_not_regular, 'a pipe is not read: '//error_text(status))
    call open_file(pipe, to_append, descriptor, status)
    call check%that(status /= 0, 'a pipe is not opened to add rows: '//error_text(status))
    call open_file(folder, to_read, descriptor, status)
    call check%that(status == error_is_directory, 'a folder is not read: '//error_text(status))
    call open_file(link, to_read, descriptor, status)
    call check%that(status == 0, 'reading follows a link')
    if (status == 0) call close_file(descriptor, status)
    call read_back(victim, text, status)
    call check%equal_text(text, 'kept'//n, 'the targets of the links are unchanged')
    call synchronise_folder(victim, status)
    call check%that(status == 0, 'a folder is flushed to the disk: '//error_text(status))
    was_there = .false.
    call remove_result(folder//'/none', was_there, status, .false.)
    call check%that(status == 0 .and. .not. was_there, 'a file that does not exist need not be removed')
    call remove_result(folder//'/a.csv', was_there, status, .false.)
    call check%that(file_length(folder//'/a.csv') < 0, 'a result is removed')
    call check%that(status == 0 .and. was_there, 'the removal of a result is reported')
    call remove_file(victim, status)
    call remove_file(link, status)
    call remove_file(pipe, status)
  end subroutine test_planted

  !> From here on no file may be longer than the given number of bytes; below 0: than was allowed at first.
  subroutine limit_files(bytes, status)
    integer, intent(in) :: bytes
    integer, intent(out) :: status
    integer(c_int), parameter :: largest_file = 1   ! RLIMIT_FSIZE of Linux
    integer(c_long) :: limits(2)                    ! a struct rlimit: now, at most
    call ignore_write_signals()
    status = c_getrlimit(largest_file, limits)
    limits(1) = bytes
    if (bytes < 0) limits(1) = limits(2)
    if (status == 0) status = c_setrlimit(largest_file, limits)
  end subroutine limit_files

  subroutine expect(check, error, message)
    class(checks_t), intent(inout) :: check
    type(error_t), allocatable, intent(in) :: error
    character(len=*), intent(in) :: message
    call check%that(allocated(error), 'error: '//message)
    if (.not. allocated(error)) return
    call check%equal_text(error%message, message, 'message')
    call check%that(error%status == status_output, 'status of '//message)
  end subroutine expect

  !> The content of a file, or the error number.
  subroutine read_back(path, text, status)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: text
    integer, intent(out) :: status
    character(len=:), allocatable :: buffer
    integer :: descriptor, done, ignored
    text = ''
    allocate (character(len=65536) :: buffer)
    call open_file(path, to_read, descriptor, status)
    if (status /= 0) return
    do
      call read_bytes(descriptor, buffer, done, status)
      if (status /= 0 .or. done == 0) exit
      text = text//buffer(:done)
    end do
    call close_file(descriptor, ignored)
  end subroutine read_back
end module test_result_file
