!> Result files, and the calls of the system under them.
module test_result_file
  use kinds, only: dp
  use errors, only: error_t, status_output
  use posix, only: make_directory, remove_directory, remove_file, open_for_reading, read_bytes, close_file, error_text, &
    error_no_entry, error_no_space
  use result_file, only: result_file_t
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_result_file

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
    call test_failures(check)
    call remove_directory(folder, status)
    call check%that(status == 0, 'nothing is left in the scratch folder')
    call remove_directory('build/test_result_file', status)
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
      call file%put('0123456789'//n)
    end do
    call read_back(folder//'/a.csv', text, status)
    call check%that(status == error_no_entry, 'no file under the final name before it is closed')
    call read_back(folder//'/a.csv.part', text, status)
    call check%that(status == 0 .and. len(text) > 0, 'rows go out when the buffer is full')
    call check%that(mod(len(text), 11) == 0, 'only whole rows go out')
    call file%put(repeat('x', 300000)//n)
    call file%close(error)
    call check%that(.not. allocated(error), 'a result is closed')
    call read_back(folder//'/a.csv', text, status)
    call check%that(status == 0, 'the file has its final name')
    call check%that(text == repeat('0123456789'//n, 40000)//repeat('x', 300000)//n, 'all rows are there in order')
    call read_back(folder//'/a.csv.part', text, status)
    call check%that(status == error_no_entry, 'the first name is gone')
    call file%open(folder//'/a.csv', error)
    call file%put('new'//n)
    call file%close(error)
    call read_back(folder//'/a.csv', text, status)
    call check%equal_text(text, 'new'//n, 'a file is replaced')
    call file%open(folder//'/a.csv', error)
    call file%put('newer'//n)
    call file%abandon()
    call read_back(folder//'/a.csv', text, status)
    call check%equal_text(text, 'new'//n, 'an abandoned file leaves the old one')
    call remove_file(folder//'/a.csv', status)
  end subroutine test_writing

  subroutine test_failures(check)
    class(checks_t), intent(inout) :: check
    type(result_file_t) :: file
    type(error_t), allocatable :: error
    integer :: status
    call file%open(folder//'/none/a.csv', error)
    call expect(check, error, folder//'/none/a.csv: No such file or directory')
    call file%put('x'//n)
    call file%close(error)
    call check%that(.not. allocated(error), 'a file never opened is closed without an error')
    call execute_command_line('ln -s /dev/full '//folder//'/full.csv.part', exitstat=status)
    call file%open(folder//'/full.csv', error)
    call check%that(.not. allocated(error), 'a full disk opens')
    call file%put('x'//n)
    call check%that(.not. file%has_failed(), 'a full disk goes unseen while rows wait')
    call file%flush()
    call check%that(file%has_failed(), 'a full disk is seen')
    call file%close(error)
    call expect(check, error, folder//'/full.csv: No space left on device')
    call remove_file(folder//'/full.csv', status)
    call check%equal_text(error_text(error_no_space), 'No space left on device', 'words of the system')
    call make_directory('/dev/null/x', status)
    call check%that(status /= 0, 'no folder under a file')
    call make_directory('/dev/null', status)
    call check%that(status /= 0, 'a file is no folder')
  end subroutine test_failures

  subroutine expect(check, error, message)
    class(checks_t), intent(inout) :: check
    type(error_t), allocatable, intent(in) :: error
    character(len=*), intent(in) :: message
    call check%that(allocated(error), 'error: '//message)
    if (.not. allocated(error)) return
    call check%equal_text(error%message, message, 'message')
    call check%that(error%status == status_output, 'status of '//message)
  end subroutine expect

  !> All of a file, or the error number.
  subroutine read_back(path, text, status)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: text
    integer, intent(out) :: status
    character(len=:), allocatable :: buffer
    integer :: descriptor, done, ignored
    text = ''
    allocate (character(len=65536) :: buffer)
    call open_for_reading(path, descriptor, status)
    if (status /= 0) return
    do
      call read_bytes(descriptor, buffer, done, status)
      if (status /= 0 .or. done == 0) exit
      text = text//buffer(:done)
    end do
    call close_file(descriptor, ignored)
  end subroutine read_back
end module test_result_file
