!> gudgeon: the slider-crank mechanism with clearance in its piston-pin joint. Reads the command line and runs the cases.
program gudgeon
  use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
  use omp_lib, only: omp_get_num_procs
  use errors, only: error_t, status_ok
  use command_line, only: command_line_t, parse_command_line, program_arguments, help_text
  use case_file, only: template
  use case_runner, only: run_case_file
  use progress, only: progress_wanted
  use posix, only: hold_interrupts, ignore_write_signals, quit
  use version, only: program_version
  implicit none
  type(command_line_t) :: options
  type(error_t), allocatable :: error
  integer :: status

  call ignore_write_signals()
  call parse_command_line(program_arguments(), options, error)
  if (allocated(error)) then
    call complain(error)
    status = error%status
  else if (options%help) then
    call say(help_text())
    status = status_ok
  else if (options%version) then
    call say('gudgeon '//program_version)
    status = status_ok
  else if (options%template) then
    call say(template())
    status = status_ok
  else
    call run_all(options, status)
  end if
  call quit(status)

contains

  !> Run every case, several side by side; the highest exit status wins.
  subroutine run_all(options, status)
    type(command_line_t), intent(in) :: options
    integer, intent(out) :: status
    logical :: show_progress
    integer :: i, jobs

    call hold_interrupts()
    status = status_ok
    jobs = options%jobs
    if (jobs == 0) jobs = omp_get_num_procs()
    jobs = min(jobs, size(options%cases))
    show_progress = progress_wanted(options%progress) .and. .not. options%quiet
    !$omp parallel do schedule(dynamic) num_threads(jobs) reduction(max: status)
    do i = 1, size(options%cases)
      call run_one(trim(options%cases(i)), options, show_progress, status)
    end do
    !$omp end parallel do
  end subroutine run_all

  !> Run one case and say how it went; `status` rises to that of an error.
  subroutine run_one(path, options, show_progress, status)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    integer, intent(inout) :: status
    character(len=:), allocatable :: line, notice
    type(error_t), allocatable :: error
    call run_case_file(path, options, show_progress, line, notice, error)
    !$omp critical (messages)
    if (allocated(error)) then
      call complain(error)
      status = max(status, error%status)
    else if (.not. options%quiet) then
      call say(line)
      if (notice /= '') call notify(notice)
    end if
    !$omp end critical (messages)
  end subroutine run_one

  !> One line on standard output.
  subroutine say(line)
    character(len=*), intent(in) :: line
    integer :: unimportant
    write (output_unit, '(a)', iostat=unimportant) line
    flush (output_unit, iostat=unimportant)
  end subroutine say

  !> One line on standard error.
  subroutine notify(line)
    character(len=*), intent(in) :: line
    integer :: unimportant
    write (error_unit, '(2a)', iostat=unimportant) 'gudgeon: ', line
  end subroutine notify

  subroutine complain(error)
    type(error_t), intent(in) :: error
    call notify(error%message)
  end subroutine complain
end program gudgeon
