!> A study from its file to its results.
module study_runner
  use, intrinsic :: iso_fortran_env, only: int64
  use omp_lib, only: omp_get_num_procs
  use kinds, only: dp
  use errors, only: error_t, fail, status_output, status_integration, status_case_file
  use text_tools, only: printable, integer_text
  use number_text, only: short_text
  use checksum, only: checksum_t
  use version, only: program_version
  use columns, only: column_list_t, choose_columns
  use case_definition, only: case_t
  use case_file, only: read_case_values, write_resolved
  use case_values, only: case_values_t
  use case_schema, only: find_key
  use accuracy_presets, only: with_preset
  use case_runner, only: write_text
  use command_line, only: command_line_t
  use progress, only: progress_t, rate_text
  use posix, only: make_directory, error_text, interrupted
  use text_file, only: read_text_file
  use study_definition, only: study_t
  use study_file, only: read_study
  use study_design, only: study_design_t, new_design
  use study_case, only: study_case_t
  use study_worker, only: study_worker_t
  use study_rows, only: run_header, cycle_header, strobe_header
  use row_file, only: row_file_t
  use case_lock, only: case_lock_t
  implicit none
  private
  public :: run_study_file

  character(len=*), parameter :: newline = achar(10), checksum_label = '! checksum '

  !> A study under way, shared by the threads that run it.
  type :: sweep_t
    type(study_t) :: study
    type(study_design_t) :: design
    type(study_case_t) :: base
    type(column_list_t) :: strobe_list
    character(len=:), allocatable :: path          !! of the results, without their endings
    integer :: first = 1, last = 0                 !! runs to run
    type(row_file_t) :: runs, cycles, strobes
    type(progress_t) :: progress
    type(case_lock_t) :: lock
    integer :: began = 0, done = 0, failed = 0     !! rows: there at the start, there now; of them those that failed
    logical :: is_over = .false.                   !! interrupted, or nothing more can be written
    type(error_t), allocatable :: error
  end type sweep_t

contains

  !> Read a study, and unless only a check is asked for run it. `line` is the summary for people; an error tells of a wrong
  !> study, of results that could not be written, or that runs failed.
  subroutine run_study_file(path, options, show_progress, line, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    type(sweep_t), allocatable :: sweep
    integer(int64) :: began, ended, rate

    line = ''
    allocate (sweep)
    call read_all(path, options, sweep, error)
    if (allocated(error)) return
    if (options%check) then
      call check_rows(sweep, error)
      line = path//': correct, '//integer_text(sweep%last - sweep%first + 1)//' runs'
      return
    end if
    call open_files(options, sweep, error)
    if (allocated(error)) then
      call sweep%lock%release()
      return
    end if
    call system_clock(began, rate)
    call sweep%progress%start(sweep%study%name, show_progress)
    call run_rows(options%jobs, sweep)
    call sweep%progress%finish()
    call close_files(sweep)
    call sweep%lock%release()
    call system_clock(ended)
    call conclude(sweep, real(ended - began, dp)/real(rate, dp), line, error)
  end subroutine run_study_file

  !> Study, base case and design, checked against each other.
  subroutine read_all(path, options, sweep, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    type(case_values_t) :: values
    type(case_t) :: case
    character(len=:), allocatable :: at
    integer :: i

    call read_study(path, sweep%study, error)
    if (allocated(error)) return
    call read_case_values(sweep%study%case, with_preset(options%accuracy, options%overrides), values, error)
    if (allocated(error)) return
    sweep%path = options%out//'/'//sweep%study%name
    associate (study => sweep%study, design => sweep%design)
      call new_design(study, values%values(find_key(values%keys, 'output', 'digits'))%whole, design, error)
      if (allocated(error)) return
      at = printable(path, 200)//': '
      if (study%table /= '') at = printable(study%table, 200)//':1: '
      call sweep%base%prepare(values, study%case, design%keys, at, error)
      if (allocated(error)) return
      do i = 1, size(design%keys)
        if (sweep%base%takes_whole_numbers(i)) call design%set_whole(i)
        if (.not. design%is_range(i) .or. sweep%base%takes_numbers(i)) cycle
        call fail(error, at//'&parameter key = '''//trim(design%keys(i))//''': has no range; give values', status_case_file)
        return
      end do
      call check_values(sweep, error)
      if (allocated(error)) return
      sweep%last = design%runs
      if (options%last_row > 0) then
        sweep%first = options%first_row
        sweep%last = options%last_row
        sweep%path = sweep%path//'.'//integer_text(sweep%first)//'-'//integer_text(sweep%last)
        if (sweep%last > design%runs) call fail(error, at//'--rows '//integer_text(sweep%first)//':'// &
          integer_text(sweep%last)//': the study has '//integer_text(design%runs)//' runs', status_case_file)
        if (allocated(error)) return
      end if
      if (study%strobe_columns == '') then
        allocate (sweep%strobe_list%id(0))
      else
        case = sweep%base%case
        case%output%columns = study%strobe_columns
        call choose_columns(case, .false., sweep%strobe_list, error)
        if (allocated(error)) error%message = at//'strobe_columns: '//error%message
      end if
    end associate
  end subroutine read_all

  !> Every text of a table or list is a value of its key.
  subroutine check_values(sweep, error)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    integer :: i, k
    associate (study => sweep%study, table => sweep%design%table)
      do k = 1, sweep%design%runs
        if (study%table == '') exit
        do i = 1, size(table%keys)
          call sweep%base%put_one(i, trim(table%fields(i, k)), error)
          if (.not. allocated(error)) cycle
          error%message = printable(study%table, 200)//':'//integer_text(table%lines(k))//': column '//integer_text(i)//', '// &
            trim(table%keys(i))//' = '//printable(trim(table%fields(i, k)), 48)//': '//error%message
          return
        end do
      end do
      do i = 1, size(study%parameters)
        do k = 1, size(study%parameters(i)%list)
          call sweep%base%put_one(i, study%parameters(i)%list(k)%text, error)
          if (.not. allocated(error)) cycle
          error%message = printable(study%file, 200)//': &parameter key = '''//study%parameters(i)%key//''', values = '// &
            printable(study%parameters(i)%list(k)%text, 48)//': '//error%message
          return
        end do
      end do
    end associate
  end subroutine check_values

  !> Whether every run can be, as far as its values tell.
  subroutine check_rows(sweep, error)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    character(len=sweep%design%text_length) :: values(size(sweep%design%keys))
    integer :: run
    do run = sweep%first, sweep%last
      call sweep%design%get_values(run, values)
      call sweep%base%put(values, error)
      if (.not. allocated(error)) call sweep%base%check(error)
      if (.not. allocated(error)) cycle
      error%message = printable(sweep%study%file, 200)//': run '//integer_text(run)//': '//error%message
      return
    end do
  end subroutine check_rows

  !> Take up the results of the same study, or begin anew. Results of another study of that name are not touched.
  subroutine open_files(options, sweep, error)
    type(command_line_t), intent(in) :: options
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: label, before
    type(error_t), allocatable :: nothing_there
    logical :: resumes
    integer :: status, run

    call make_directory(options%out, status)
    if (status == 0 .and. sweep%study%traces /= 'none') call make_directory(sweep%path, status)
    if (status /= 0) then
      call fail(error, printable(options%out, 200)//': '//error_text(status), status_output)
      return
    end if
    call sweep%lock%take(sweep%path, error)
    if (allocated(error)) return
    label = checksum_label//study_checksum(sweep)//newline
    call read_text_file(sweep%path//'.study.nml', 100, 'study', before, nothing_there)
    resumes = .not. options%fresh .and. .not. allocated(nothing_there)
    if (resumes .and. index(before, label) /= 1) then
      call fail(error, printable(sweep%path, 200)//'.runs.csv: holds another study, base case or program; --fresh replaces it', &
                status_output)
      return
    end if
    associate (first => sweep%first, last => sweep%last)
      call sweep%runs%open(sweep%path//'.runs.csv', run_header(sweep%design%keys), first, last, resumes, error, mark=',done,')
      if (allocated(error)) return
      if (sweep%study%cycles) &
        call sweep%cycles%open(sweep%path//'.cycles.csv', cycle_header(), first, last, resumes, error, kept=sweep%runs)
      if (.not. allocated(error) .and. size(sweep%strobe_list%id) > 0) call sweep%strobes%open(sweep%path//'.strobe.csv', &
        strobe_header(sweep%strobe_list), first, last, resumes, error, kept=sweep%runs)
    end associate
    if (.not. allocated(error)) call write_text(sweep%path//'.study.nml', label//sweep%study%resolved, error)
    do run = sweep%first, sweep%last
      if (sweep%runs%has(run)) sweep%began = sweep%began + 1
      if (sweep%runs%has(run) .and. .not. sweep%runs%is_marked(run)) sweep%failed = sweep%failed + 1
    end do
    sweep%done = sweep%began
  end subroutine open_files

  !> Tells apart studies whose rows would differ.
  function study_checksum(sweep) result(text)
    type(sweep_t), intent(in) :: sweep
    character(len=16) :: text
    type(checksum_t) :: checksum
    integer :: i, run
    call checksum%add(program_version//newline//write_resolved(sweep%base%case)//sweep%study%identity)
    if (sweep%study%table /= '') then
      do i = 1, size(sweep%design%keys)
        call checksum%add(sweep%design%keys(i)//',')
      end do
      do run = 1, sweep%design%runs
        do i = 1, size(sweep%design%keys)
          call checksum%add(sweep%design%table%fields(i, run)//',')
        end do
      end do
    end if
    text = checksum%hexadecimal()
  end function study_checksum

  !> All runs that have no row yet, by so many threads (0: as many as there are cores).
  subroutine run_rows(jobs, sweep)
    integer, intent(in) :: jobs
    type(sweep_t), intent(inout) :: sweep
    integer :: threads
    threads = jobs
    if (threads == 0) threads = omp_get_num_procs()
    threads = max(1, min(threads, sweep%last - sweep%first + 1 - sweep%began))
    !$omp parallel num_threads(threads)
    call work(sweep)
    !$omp end parallel
  end subroutine run_rows

  !> The share of one thread.
  subroutine work(sweep)
    type(sweep_t), intent(inout) :: sweep
    type(study_worker_t), allocatable :: worker
    logical :: is_over
    integer :: run
    allocate (worker)
    call worker%prepare(sweep%study, sweep%design, sweep%base, sweep%strobe_list, sweep%path)
    !$omp do schedule(dynamic)
    do run = sweep%first, sweep%last
      !$omp atomic read
      is_over = sweep%is_over
      if (is_over .or. sweep%runs%has(run)) cycle
      call worker%run(sweep%design, run)
      !$omp critical (study_results)
      call take_results(sweep, worker, run)
      !$omp end critical (study_results)
    end do
    !$omp end do
  end subroutine work

  !> Add the rows of a run to the files, its row among the runs last: with it the run is done.
  subroutine take_results(sweep, worker, run)
    type(sweep_t), intent(inout) :: sweep
    type(study_worker_t), intent(inout) :: worker
    integer, intent(in) :: run
    logical :: is_over
    is_over = interrupted()
    if (worker%was_interrupted) is_over = .true.
    if (allocated(worker%output_error) .and. .not. allocated(sweep%error)) call move_alloc(worker%output_error, sweep%error)
    if (.not. (worker%was_interrupted .or. allocated(sweep%error))) then
      !$omp critical (texts)
      if (sweep%study%cycles .and. worker%cycle_rows%used > 0) &
        call sweep%cycles%append(run, worker%cycle_rows%text(:worker%cycle_rows%used), sweep%error)
      if (size(sweep%strobe_list%id) > 0 .and. worker%strobe_rows%used > 0 .and. .not. allocated(sweep%error)) &
        call sweep%strobes%append(run, worker%strobe_rows%text(:worker%strobe_rows%used), sweep%error)
      if (.not. allocated(sweep%error)) &
        call sweep%runs%append(run, worker%run_row%text(:worker%run_row%used), sweep%error)
      sweep%done = sweep%done + 1
      if (.not. worker%is_done) sweep%failed = sweep%failed + 1
      call sweep%progress%update_runs(sweep%done, sweep%last - sweep%first + 1, sweep%began)
      !$omp end critical (texts)
    end if
    if (allocated(sweep%error)) is_over = .true.
    if (.not. is_over) return
    !$omp atomic write
    sweep%is_over = .true.
  end subroutine take_results

  !> Close the files, sorted if every run has its row. The first error counts.
  subroutine close_files(sweep)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable :: error
    logical :: complete
    complete = sweep%done == sweep%last - sweep%first + 1 .and. .not. allocated(sweep%error)
    call sweep%cycles%finish(complete, error)
    if (allocated(error) .and. .not. allocated(sweep%error)) call move_alloc(error, sweep%error)
    call sweep%strobes%finish(complete, error)
    if (allocated(error) .and. .not. allocated(sweep%error)) call move_alloc(error, sweep%error)
    call sweep%runs%finish(complete, error)
    if (allocated(error) .and. .not. allocated(sweep%error)) call move_alloc(error, sweep%error)
  end subroutine close_files

  !> What there is to say at the end.
  subroutine conclude(sweep, wall_time, line, error)
    type(sweep_t), intent(inout) :: sweep
    real(dp), intent(in) :: wall_time   !! [s]
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    integer :: total
    total = sweep%last - sweep%first + 1
    line = sweep%study%name//': '//integer_text(total)//' runs'
    if (sweep%began > 0) line = line//', '//integer_text(sweep%began)//' of them there already'
    if (sweep%done > sweep%began) line = line//'; '//short_text(wall_time)//' s, '// &
      rate_text((sweep%done - sweep%began)/max(wall_time, 1e-6_dp))
    line = line//'; '//sweep%path//'.runs.csv'
    if (allocated(sweep%error)) then
      call move_alloc(sweep%error, error)
    else if (sweep%done < total) then
      call fail(error, printable(sweep%study%file, 200)//': interrupted after '//integer_text(sweep%done)//' of '// &
                integer_text(total)//' runs; the same command goes on from there', status_integration)
    else if (sweep%failed > 0) then
      call fail(error, printable(sweep%study%file, 200)//': '//integer_text(sweep%failed)//' of '//integer_text(total)// &
                ' runs failed; '//sweep%path//'.runs.csv says why', status_integration)
    end if
  end subroutine conclude
end module study_runner
