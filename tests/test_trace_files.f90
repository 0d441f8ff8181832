!> The files of a running case: what is written is what was handed over.
module test_trace_files
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use errors, only: error_t
  use columns, only: column_list_t
  use trace_files, only: trace_files_t
  use row_queue, only: row_queue_t
  use trace_sink, only: trace_event_t
  use scene, only: event_contact_begins, event_contact_ends
  use posix, only: make_directory, remove_directory, remove_file
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_trace_files

  character(len=*), parameter :: folder = 'build/test_trace_files'

contains

  subroutine run_test_trace_files(check)
    class(checks_t), intent(inout) :: check
    integer :: status
    call make_directory(folder, status)
    call test_text(check)
    call test_exact(check)
    call test_queue(check)
    call remove_file(folder//'/a.csv', status)
    call remove_file(folder//'/a.events.csv', status)
    call remove_directory(folder, status)
    call check%that(status == 0, 'nothing is left in the scratch folder')
  end subroutine run_test_trace_files

  subroutine test_text(check)
    class(checks_t), intent(inout) :: check
    type(trace_files_t) :: files
    type(error_t), allocatable :: error
    type(trace_event_t) :: event
    call files%open(folder//'/a', column_list_t(id=[1, 27, 35]), 12, .true., error)
    call check%that(.not. allocated(error), 'a trace is opened')
    call files%take_row([1e-3_dp, 2.0_dp, -0.0_dp])
    event = trace_event_t(event_contact_begins, 0.5_dp, -1.0_dp, 0.25_dp, 9.0_dp, 9.0_dp, 9.0_dp)
    call files%take_event(event)
    event%kind = event_contact_ends
    call files%take_event(event)
    call files%close(error)
    call check%that(.not. allocated(error), 'a trace is closed')
    call expect_line(check, 'a.csv', 1, 'time[s],phase[-],gas_force[N]')
    call expect_line(check, 'a.csv', 2, '1.00000000000E-03,2,0.00000000000E+00')
    call expect_line(check, 'a.events.csv', 2, '5.00000000000E-01,-1.00000000000E+00,contact_begins,2.50000000000E-01,,,')
    call expect_line(check, 'a.events.csv', 3, '5.00000000000E-01,-1.00000000000E+00,contact_ends,2.50000000000E-01,'// &
                     '9.00000000000E+00,9.00000000000E+00,9.00000000000E+00')
  end subroutine test_text

  !> Rows that another thread writes, from some row on, are those that the finder would have written, in order; when they are
  !> settled all are in the file.
  subroutine test_queue(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n_rows = 3000, served_from = 700
    type(trace_files_t), target :: files
    type(row_queue_t), target :: queue
    type(error_t), allocatable :: error, settle_error
    real(dp) :: back(2)
    integer :: i, unit, wrong, settled, status
    logical :: may_serve, is_served
    call queue%begin()
    call files%open(folder//'/a', column_list_t(id=[1, 23]), 17, .false., error)
    call files%share_rows(queue, 2)
    may_serve = .false.
    settled = 0
    !$omp parallel sections num_threads(2) default(shared) private(is_served, i)
    !$omp section
    do i = 1, n_rows
      if (i == served_from) then
        !$omp atomic write
        may_serve = .true.
        do   ! until the writer is there
          call queue%offer([real(i, dp), 1/real(i, dp)], is_served)
          if (is_served) exit
        end do
        cycle
      end if
      call files%take_row([real(i, dp), 1/real(i, dp)])
      if (i /= 2000) cycle
      call queue%settle()
      call files%trace%synchronise(settle_error)
      open (newunit=unit, file=folder//'/a.csv.part', action='read', status='old', recl=1000)
      read (unit, *)
      do
        read (unit, *, iostat=status) back
        if (status /= 0) exit
        settled = settled + 1
      end do
      close (unit)
    end do
    call queue%end()
    !$omp section
    do
      !$omp atomic read
      is_served = may_serve
      if (is_served) exit
    end do
    call queue%serve()
    !$omp end parallel sections
    call files%close(error)
    call check%that(settled == 2000, 'rows that are settled are in the file')
    wrong = 0
    open (newunit=unit, file=folder//'/a.csv', action='read', status='old', recl=1000)
    read (unit, *)
    do i = 1, n_rows
      read (unit, *, iostat=status) back
      if (status /= 0 .or. abs(back(1) - i) > 0 .or. abs(back(2) - 1/real(i, dp)) > 0) wrong = wrong + 1
    end do
    read (unit, *, iostat=status) back
    close (unit)
    call check%that(wrong == 0 .and. status /= 0, 'rows by way of another thread')
  end subroutine test_queue

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
    call files%open(folder//'/a', column_list_t(id=[(j, j=1, fields)]), 17, .false., error)
    do i = 1, rows
      call files%take_row(values(:, i))
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
    call check%that(wrong == 0, 'a trace of 17 digits reads back')
  end subroutine test_exact

  !> A line of a file is this.
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
