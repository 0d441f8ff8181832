!> Result files, the numbers in them, and the calls of the system under them.
module test_result_file
  use kinds, only: dp
  use errors, only: error_t, status_output
  use number_text, only: real_text, exact_text, short_text
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
    call test_numbers(check)
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

  subroutine test_numbers(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: back
    character(len=:), allocatable :: text
    integer :: i
    call check%equal_text(real_text(1.23456789e-5_dp), '1.234567890E-05', 'real')
    call check%equal_text(real_text(-2.0_dp), '-2.000000000E+00', 'negative')
    call check%equal_text(real_text(0.0_dp), '0.000000000E+00', 'zero')
    call check%equal_text(real_text(1e-120_dp), '1.000000000E-120', 'small')
    call check%equal_text(real_text(-1e150_dp), '-1.000000000E+150', 'large')
    call check%equal_text(short_text(0.5_dp), '0.5', 'short')
    call check%equal_text(short_text(4.0_dp), '4', 'short, whole')
    call check%equal_text(short_text(-123456.4_dp), '-123456', 'short, six digits before the point')
    call check%equal_text(short_text(9.9999996_dp), '10', 'short, rounded up to the next power')
    call check%equal_text(short_text(1.23e6_dp), '1.23E+06', 'short, large')
    call check%equal_text(short_text(1.25e-4_dp), '0.000125', 'short, small')
    call check%equal_text(short_text(1e-5_dp), '1E-05', 'short, smaller')
    call check%equal_text(short_text(0.0_dp), '0', 'short, zero')
    do i = -30, 30
      text = exact_text(0.1_dp*3.0_dp**i)
      read (text, *) back
      call check%relative(back, 0.1_dp*3.0_dp**i, 0.0_dp, 'exact text reads back')
    end do
  end subroutine test_numbers

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
