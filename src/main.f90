!> gudgeon: simulation of the slider-crank mechanism with clearance in its joints. Reads the command line and runs the cases.
program gudgeon
  use, intrinsic :: iso_fortran_env, only: compiler_options
  use gudgeon_kinds, only: dp
  use omp_lib, only: omp_get_num_procs
  use gudgeon_errors, only: error_t, fail, status_ok, status_integration, status_output
  use command_line, only: command_line_t, parse_command_line, program_arguments, help_text
  use case_file, only: template
  use case_runner, only: case_job_t
  use study_runner, only: run_study_file
  use study_definition, only: study_schema_of
  use case_schema, only: key_table_t, case_schema_of
  use case_text, only: template_text
  use reference_pages, only: keys_reference, results_reference
  use gudgeon_progress, only: progress_wanted, clock, tell
  use gudgeon_summary, only: build_advice
  use text_tools, only: printable
  use run_identity, only: identity_length, program_identity
  use gudgeon_posix, only: fill_standard_descriptors, signal_set_t, hold_interrupts, interrupted, ignore_write_signals, &
    write_all, error_text, error_broken_pipe
  use posix_calls, only: c_exit
  use gudgeon_version, only: program_version
  implicit none
  type(command_line_t) :: options
  type(error_t), allocatable :: error
  integer, parameter :: standard_output = 1   !! file descriptor
  integer :: status

  status = status_ok
  call fill_standard_descriptors()
  call ignore_write_signals()
  call parse_command_line(program_arguments(), options, error)
  if (allocated(error)) then
    call tell(error%message)
    status = error%status
  else if (options%help) then
    call say(help_text(), status)
  else if (options%version) then
    call say('gudgeon '//program_version, status)
  else if (options%template .or. options%reference /= '') then
    call say_page(options, status)
  else if (options%sweep) then
    call run_studies(options, status)
  else
    call run_all(options, status)
  end if
  call c_exit(status)   ! without output

contains

  !> Print a template or a page of the manual.
  subroutine say_page(options, status)
    type(command_line_t), intent(in) :: options
    integer, intent(inout) :: status
    type(key_table_t) :: table
    if (options%template .and. options%sweep) then
      call study_schema_of(table)
      call say(template_text('A parameter study of gudgeon with every key there is. Keys marked required have no default.', &
        table), status)
    else if (options%template) then
      call say(template(), status)
    else if (options%reference == 'results') then
      call say(results_reference(), status)
    else
      if (options%reference == 'case') call case_schema_of(table)
      if (options%reference == 'study') call study_schema_of(table)
      call say(keys_reference(table), status)
    end if
  end subroutine say_page

  !> Run all cases and their ideal twins, several at the same time; the largest exit status is returned.
  subroutine run_all(options, status)
    type(command_line_t), intent(in) :: options
    integer, intent(out) :: status
    type(case_job_t), allocatable :: cases(:)
    character(len=identity_length) :: program
    logical :: show_progress, is_last
    character(len=:), allocatable :: advice
    real(dp) :: began   ! [s]
    integer :: i, run, jobs

    call hold_interrupts()
    began = clock()
    status = status_ok
    show_progress = progress_wanted(options%progress) .and. .not. options%quiet
    program = program_identity()
    allocate (cases(size(options%cases)))
    do i = 1, size(cases)
      call cases(i)%prepare(trim(options%cases(i)), options, program, show_progress)
      if (options%check) call say_outcome(cases(i), options, status)
    end do
    if (options%check) return
    do i = 1, size(cases)
      if (.not. allocated(cases(i)%error)) call cases(i)%run%make_ready()   ! uses all processors
    end do
    jobs = options%jobs
    if (jobs == 0) jobs = omp_get_num_procs()
    jobs = min(jobs, size(cases) + count(cases%has_twin))
    !$omp parallel do schedule(dynamic) num_threads(jobs) reduction(max: status) private(is_last)
    do run = 1, 2*size(cases)   ! each case, then its twin
      call cases((run + 1)/2)%go(mod(run, 2) == 0, options, is_last)
      if (is_last) call say_outcome(cases((run + 1)/2), options, status)
    end do
    !$omp end parallel do
    advice = build_advice(compiler_options(), clock() - began)
    if (advice /= '' .and. .not. options%quiet) call tell(advice)
  end subroutine run_all

  !> Run all studies, one after the other; the largest exit status is returned.
  subroutine run_studies(options, status)
    type(command_line_t), intent(in) :: options
    integer, intent(out) :: status
    character(len=:), allocatable :: line
    type(error_t), allocatable :: error
    type(signal_set_t) :: before
    logical :: show_progress
    integer :: i
    call hold_interrupts(before)
    status = status_ok
    show_progress = progress_wanted(options%progress) .and. .not. options%quiet
    do i = 1, size(options%cases)
      if (interrupted()) then
        line = ''
        call fail(error, printable(trim(options%cases(i)), 200)//': interrupted before it began', status_integration)
      else
        call run_study_file(trim(options%cases(i)), options, show_progress, before, line, error)
      end if
      if (line /= '' .and. .not. options%quiet) call say(line, status)
      if (.not. allocated(error)) cycle
      call tell(error%message)
      status = max(status, error%status)
    end do
  end subroutine run_studies

  !> Print the outcome of a case, or that it is valid; `status` is raised to that of an error.
  subroutine say_outcome(case, options, status)
    type(case_job_t), intent(inout) :: case
    type(command_line_t), intent(in) :: options
    integer, intent(inout) :: status
    character(len=:), allocatable :: line, notice
    type(error_t), allocatable :: error
    !$omp critical (messages)
    call case%tell_outcome(line, notice, error)
    if (allocated(error)) then
      call tell(error%message)
      status = max(status, error%status)
    else if (.not. options%quiet) then
      call say(line, status)
      if (notice /= '') call tell(notice)
    end if
    !$omp end critical (messages)
  end subroutine say_outcome

  !> Print one line on standard output. If that fails, `status` is raised, unless the reader has closed the pipe.
  subroutine say(line, status)
    character(len=*), intent(in) :: line
    integer, intent(inout) :: status
    integer :: done, problem
    call write_all(standard_output, line//achar(10), done, problem)
    if (problem == 0 .or. problem == error_broken_pipe) return
    call tell('standard output: '//error_text(problem))
    status = max(status, status_output)
  end subroutine say
end program gudgeon
