!> Runs cases from their files to their results: each scene and, if requested, its ideal twin.
module case_runner
  use, intrinsic :: iso_fortran_env, only: compiler_options
  use kinds, only: dp
  use error_handling, only: error_t, fail, keep_first, status_ok, status_command_line, status_integration
  use case_definition, only: case_t
  use accuracy_presets, only: with_preset
  use case_description, only: description
  use case_file, only: read_case_values, complete_case
  use case_text, only: resolved_text
  use case_values, only: case_values_t
  use command_line, only: command_line_t
  use film_files, only: provide_tables, tell_tables
  use joint_places, only: n_places
  use trace_columns, only: column_list_t, choose_columns
  use run_summary, only: build_advice
  use report_files, only: result_suffixes
  use run_start, only: try_start
  use case_run, only: case_run_t, name_file
  use state_file, only: state_suffix
  use result_file, only: fail_with_file
  use posix_files, only: absolute_path, make_directory, interrupted
  use run_progress, only: tell, say, clock, progress_wanted
  use portuguese, only: in_language
  use measured_curve, only: measured_curve_t
  use process_pool, only: tasks_t, note_t, share, available_processors
  use text_tools, only: printable, integer_text, path_beside, replaced
  implicit none
  private
  public :: run_cases, tell_notes

  !> A case with its results.
  type :: case_job_t
    type(error_t), allocatable :: error               !! error in the case or in the folder of its results
    type(case_run_t) :: run, twin
    character(len=:), allocatable :: path             !! path of the case file
    logical :: has_twin = .false.                     !! the ideal twin is run too
  end type case_job_t

  !> All cases of a command.
  type, extends(tasks_t) :: case_jobs_t
    type(case_job_t), allocatable :: job(:)
    type(command_line_t), pointer :: options => null()
    integer :: status = status_ok                     !! largest exit status so far
  contains
    procedure :: carry_out
    procedure :: record_note
    procedure :: lost
  end type case_jobs_t

contains

  !> Run all cases, several at the same time, or only check them if the options say so; the largest exit status is returned. The
  !> outcome of each case is printed.
  subroutine run_cases(options, status)
    type(command_line_t), intent(in), target :: options
    integer, intent(out) :: status
    type(case_jobs_t) :: cases
    character(len=:), allocatable :: advice
    logical :: shows_progress
    real(dp) :: began   ! [s]
    integer :: i, jobs
    began = clock()
    cases%options => options
    shows_progress = progress_wanted(options%progress) .and. .not. options%quiet
    allocate (cases%job(size(options%cases)))
    do i = 1, size(cases%job)
      call prepare(cases%job(i), trim(options%cases(i)), options, shows_progress)
      if (options%check) call say_outcome(cases%job(i), options, cases%status)
    end do
    if (.not. options%check) then
      do i = 1, size(cases%job)   ! uses all processors
        if (.not. allocated(cases%job(i)%error)) call provide_films(cases%job(i), options%quiet, shows_progress)
      end do
      jobs = options%jobs
      if (jobs == 0) jobs = available_processors()
      call share(cases, size(cases%job), jobs)
      advice = build_advice(compiler_options(), clock() - began)
      if (advice /= '' .and. .not. options%quiet) call tell(advice)
    end if
    status = cases%status
  end subroutine run_cases

  !> Read and check a case. Messages of errors begin with the name of the case file; no file is written for a case with an error.
  subroutine prepare(job, path, options, shows_progress)
    type(case_job_t), intent(inout) :: job
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: shows_progress
    type(case_values_t) :: values
    type(case_t) :: case
    type(column_list_t) :: list, ideal_list
    character(len=:), allocatable :: base, text, tables

    job%path = path
    if (interrupted()) then
      call not_begun(path, '', job%error)
      return
    end if
    call read_case_values(path, settings_of(options), values, job%error)
    if (.not. allocated(job%error)) call complete_case(values, path, case, job%error)
    if (allocated(job%error)) return
    if (options%name /= '') case%name = options%name
    call choose_columns(case, .false., list, job%error)
    if (.not. allocated(job%error)) call choose_columns(case, .true., ideal_list, job%error)
    if (.not. allocated(job%error)) call try_start(case, list, job%error)
    if (allocated(job%error)) then
      call name_file(path, job%error)
      return
    end if
    if (.not. options%quiet) call tell_notes(case)
    base = options%out//'/'//case%name
    call keep_tables(case, base, job%error)
    if (allocated(job%error)) return
    text = resolved_text(values)
    job%has_twin = case%output%ideal_twin .and. (case%has_clearance() .or. case%is_elastic() .or. &
      allocated(case%shaft))
    call job%run%prepare(case, text, .false., list, base, options, shows_progress)
    if (job%has_twin) call job%twin%prepare(case, text, .true., ideal_list, base//'.ideal', options, shows_progress)
    if (options%resolved) job%run%line = text(:len(text) - 1)
    if (options%resolved .or. .not. options%check) return
    call tell_tables(case, tables)
    job%run%line = description(case, size(list%id), job%has_twin, base, tables)
  end subroutine prepare

  !> The overrides of the command line, with those for which an option stands.
  function settings_of(options) result(settings)
    type(command_line_t), intent(in) :: options
    character(len=:), allocatable :: settings(:)
    integer, parameter :: longest_path = 4096
    character(len=max(len(options%overrides), longest_path + len(options%from))) :: given(size(options%overrides) + 1)
    integer :: n
    n = size(options%overrides)
    given(:n) = options%overrides
    given(n + 1) = 'initial.from='//path_beside(absolute_path('.')//'/', options%from)
    if (options%from /= '') n = n + 1
    allocate (settings, source=with_preset(options%accuracy, given(:n)))
  end function settings_of

  !> Give the films of a case their tables, before the work is shared among processes. Error: the user interrupted.
  subroutine provide_films(job, is_quiet, shows_progress)
    type(case_job_t), intent(inout) :: job
    logical, intent(in) :: is_quiet, shows_progress
    call provide_tables(job%run%case, .not. is_quiet, shows_progress, job%error)
    if (allocated(job%error)) call name_file(job%path, job%error)
  end subroutine provide_films

  !> Check that the results do not replace a table that the case reads, such as motor.csv beside motor.nml, or its own file.
  subroutine keep_tables(case, base, error)
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: base
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: written
    integer :: i, k
    do i = 1, size(result_suffixes)
      written = absolute_path(base//trim(result_suffixes(i)))
      call refuse_table('&drive torque_table', case%drive%table)
      if (.not. allocated(error) .and. allocated(case%measured)) call refuse_table('&cylinder_pressure table', case%measured%curve)
      if (.not. allocated(error) .and. allocated(case%guide)) call refuse_table('&guide profile_table', case%guide%profile)
      if (.not. allocated(error) .and. allocated(case%load)) call refuse_table('&bearing_load table', case%load%curve)
      do k = 1, n_places
        if (.not. allocated(error) .and. allocated(case%joints(k)%history%shape)) &
          call refuse_table('&shape table', case%joints(k)%history%shape%table)
      end do
      if (allocated(error)) return
    end do
    if (all(absolute_path(case%file) /= [character(len=4096) :: absolute_path(base//'.resolved.nml'), &
      absolute_path(base//state_suffix)])) return
    call fail(error, printable(case%file, 200)//': would be replaced by the results: give another folder with '// &
      '--out, or another name with --name', status_command_line)

  contains

    subroutine refuse_table(key, table)
      character(len=*), intent(in) :: key
      type(measured_curve_t), intent(in) :: table
      if (.not. allocated(table%path)) return
      if (table%path == written) call fail(error, printable(case%file, 200)//': '//key//': '//printable(base, 200)// &
        trim(result_suffixes(i))//' would be replaced by the results: give another folder with --out, or the table another name', &
        status_command_line)
    end subroutine refuse_table
  end subroutine keep_tables

  !> Tell the notes on a case.
  subroutine tell_notes(case)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: head
    head = printable(case%file, 200)//': note: '
    if (allocated(case%notes)) call tell(head//replaced(case%notes, achar(10), achar(10)//head))
  end subroutine tell_notes

  !> Run a case and its ideal twin, and print the outcome.
  subroutine carry_out(self, task, note)
    class(case_jobs_t), intent(inout) :: self
    integer, intent(in) :: task
    type(note_t), intent(inout) :: note
    integer :: status
    logical :: is_interrupted
    associate (job => self%job(task), options => self%options)
      if (.not. allocated(job%error)) then
        call make_directory(options%out, status)
        if (status /= 0) call fail_with_file(options%out, status, job%error)
      end if
      if (.not. allocated(job%error)) then
        if (interrupted()) call not_begun(job%path, '', job%error)
      end if
      if (.not. allocated(job%error)) then
        call job%run%go()
        if (job%has_twin) then
          is_interrupted = interrupted()
          if (.not. is_interrupted) call job%twin%go()
          if (is_interrupted .and. .not. allocated(job%run%error)) call not_begun(job%path, 'ideal twin: ', job%twin%error)
        end if
      end if
      call say_outcome(job, options, note%numbers(1))
    end associate
  end subroutine carry_out

  subroutine record_note(self, note)
    class(case_jobs_t), intent(inout) :: self
    type(note_t), intent(in) :: note
    self%status = max(self%status, note%numbers(1))
  end subroutine record_note

  subroutine lost(self, task, signal)
    class(case_jobs_t), intent(inout) :: self
    integer, intent(in) :: task, signal
    call tell(printable(self%job(task)%path, 200)//': the process that ran it was killed by signal '//integer_text(signal))
    self%status = max(self%status, status_integration)
  end subroutine lost

  !> The error of a run that was interrupted before it began.
  subroutine not_begun(path, what, error)
    character(len=*), intent(in) :: path, what
    type(error_t), allocatable, intent(out) :: error
    call fail(error, printable(path, 200)//': '//what//'interrupted before it began', status_integration)
  end subroutine not_begun

  !> Print the outcome of a case, or that it is valid; `status` is raised to that of an error.
  subroutine say_outcome(job, options, status)
    type(case_job_t), intent(inout) :: job
    type(command_line_t), intent(in) :: options
    integer, intent(inout) :: status
    type(error_t), allocatable :: error
    call keep_first(job%error, error)
    call keep_first(job%run%error, error)
    call keep_first(job%twin%error, error)
    if (allocated(job%run%line) .and. .not. options%quiet) then
      if (.not. options%resolved) job%run%line = in_language(job%run%line, options%language, &
        job%run%case%file//achar(10)//job%run%case%name//achar(10)//job%run%base)
      call say(job%run%line, status)
    end if
    if (.not. allocated(error)) return
    call tell(error%message)
    status = max(status, error%status)
  end subroutine say_outcome
end module case_runner
