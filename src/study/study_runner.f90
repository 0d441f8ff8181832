!> A study from its file to its results.
module study_runner
  use, intrinsic :: iso_fortran_env, only: int64
  use omp_lib, only: omp_get_num_procs
  use kinds, only: dp
  use errors, only: error_t, fail, status_output, status_integration
  use text_tools, only: printable, integer_text
  use number_text, only: short_text
  use result_file, only: write_text
  use command_line, only: command_line_t
  use progress, only: rate_text
  use case_runner, only: tell_warning
  use posix, only: make_directory, error_text, interrupted
  use text_file, only: read_text_file
  use study_sweep, only: sweep_t, read_sweep, check_rows, study_checksum
  use study_worker, only: study_worker_t
  use study_rows, only: run_header, cycle_header, strobe_header
  implicit none
  private
  public :: run_study_file

  character(len=*), parameter :: newline = achar(10), checksum_label = '! checksum '

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
    call read_sweep(path, options, sweep, error)
    if (allocated(error)) return
    if (.not. options%quiet) call tell_warning(sweep%base%case)
    if (options%check) then
      call check_rows(sweep, error)
      if (.not. allocated(error)) line = path//': correct, '//integer_text(sweep%last - sweep%first + 1)//' runs'
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
