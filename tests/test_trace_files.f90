!> The files of a running case: they contain exactly what the run has passed to them.
module test_trace_files
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t
  use trace_row, only: column_list_t, name_length
  use trace_files, only: trace_files_t
  use trace_sink, only: trace_event_t
  use scene_problem, only: event_contact_begins, event_contact_ends
  use posix_files, only: make_directory, remove_file
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_trace_files

  character(len=*), parameter :: folder = 'build/test_trace_files'

  character(len=name_length), parameter :: names(4) = [character(len=name_length) :: 'time[s]', 'phase[-]', 'energy[J]', &
    'gas_force[N]']

contains

  subroutine run_test_trace_files(check)
    class(checks_t), intent(inout) :: check
    integer :: status
    call make_directory(folder, status)
    call test_text(check)
    call test_exact(check)
    call remove_file(folder//'/a.csv', status)
    call remove_file(folder//'/a.events.csv', status)
    call execute_command_line('rmdir '//folder, exitstat=status)
    call check%that(status == 0, 'nothing is left in the scratch folder')
  end subroutine run_test_trace_files

  subroutine test_text(check)
    class(checks_t), intent(inout) :: check
    type(trace_files_t) :: files
    type(error_t), allocatable :: error
    type(trace_event_t) :: event
    call files%open(folder//'/a', column_list_t(id=[1, 2, 4], names=names), 12, .true., error)
    call check%that(.not. allocated(error), 'a trace is opened')
    call files%accept_row([1e-3_dp, 2.0_dp, -0.0_dp])
    event = trace_event_t(event_contact_begins, 0.5_dp, -1.0_dp, 0.25_dp, 9.0_dp, 9.0_dp, 9.0_dp)
    call files%accept_event(event)
    event%kind = event_contact_ends
    call files%accept_event(event)
    call files%close(error)
    call check%that(.not. allocated(error), 'a trace is closed')
    call expect_line(check, 'a.csv', 1, 'time[s],phase[-],gas_force[N]')
    call expect_line(check, 'a.csv', 2, '1.00000000000E-03,2,0.00000000000E+00')
    call expect_line(check, 'a.events.csv', 2, '5.00000000000E-01,-1.00000000000E+00,contact_begins,'// &
                     '2.50000000000E-01,,,,piston_pin')
    call expect_line(check, 'a.events.csv', 3, '5.00000000000E-01,-1.00000000000E+00,contact_ends,2.50000000000E-01,'// &
                     '9.00000000000E+00,9.00000000000E+00,9.00000000000E+00,piston_pin')
  end subroutine test_text

  !> With 17 digits a trace reads back to the last bit.
  subroutine test_exact(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: rows = 200, fields = 22
    type(trace_files_t) :: files
    type(error_t), allocatable :: error
    real(dp) :: values(fields, rows), back(fields)
    integer :: i, j, unit, wrong
    do i = 1, rows
      do j = 1, fields
        values(j, i) = sin(real(i*j, dp))*10.0_dp**(3*(j - 11))
      end do
    end do
    call files%open(folder//'/a', column_list_t(id=[(j, j=1, fields)], names=[(names(1), j=1, fields)]), 17, .false., error)
    do i = 1, rows
      call files%accept_row(values(:, i))
    end do
    call files%close(error)
    wrong = 0
    open (newunit=unit, file=folder//'/a.csv', action='read', status='old', recl=1000)
    read (unit, *)
    do i = 1, rows
      read (unit, *) back
      wrong = wrong + count(transfer(back, [0_int64]) /= transfer(values(:, i), [0_int64]))
    end do
    close (unit)
    call check%that(wrong == 0, 'a trace with 17 digits is read back')
  end subroutine test_exact

  !> A line of a file is the given one.
  subroutine expect_line(check, name, number, line)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: name, line
    integer, intent(in) :: number
    character(len=200) :: found
    integer :: unit, i
    open (newunit=unit, file=folder//'/'//name, action='read', status='old')
    do i = 1, number
      read (unit, '(a)') found
    end do
    close (unit)
    call check%equal_text(trim(found), line, name)
  end subroutine expect_line
end module test_trace_files
