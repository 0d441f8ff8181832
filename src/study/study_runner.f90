!> Runs a study from its file to its results.
module study_runner
  use omp_lib, only: omp_get_num_procs
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, keep_first, status_output, status_integration
  use text_tools, only: printable, integer_text
  use number_text, only: short_text
  use result_file, only: write_text, fail_with_file
  use command_line, only: command_line_t
  use gudgeon_progress, only: rate_text, clock
  use case_runner, only: tell_warning
  use gudgeon_posix, only: make_directory, synchronise_folder, interrupted, signal_set_t, hold_interrupts, restore_interrupts
  use text_file, only: read_text_file
  use study_sweep, only: sweep_t, read_sweep, check_rows, study_checksum, file_cycles, file_strobes, file_runs
  use study_worker, only: study_worker_t
  use study_rows, only: run_header, cycle_header, strobe_header
  implicit none
  private
  public :: run_study_file

  character(len=*), parameter :: newline = achar(10), checksum_label = '! checksum '

  !> Rows are collected in memory so that writing them to the disk takes a small part of the time: a fiftieth, unless the longest
  !> interval is exceeded.
  real(dp), parameter :: least_interval = 0.25_dp, most_interval = 5   !! between two writes [s]
  real(dp), parameter :: intervals = 50                                !! ratio of the interval to the duration of the last write
  integer, parameter :: most_waiting = 16000000                        !! bytes of rows of revolutions and strobes

contains

  !> Read a study and run it, or only check it if `options` say so. `line` is the summary for the user. Errors: a wrong study,
  !> results that could not be written, or failed runs. While the study is read or checked, signals are handled as in `before`; they
  !> are held from the first result on.
  subroutine run_study_file(path, options, show_progress, before, line, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    type(signal_set_t), intent(in) :: before
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    type(sweep_t), allocatable :: sweep
    real(dp) :: began   ! [s]

    call restore_interrupts(before)
    line = ''
    allocate (sweep)
    call read_sweep(path, options, sweep, error)
    if (.not. (allocated(error) .or. options%quiet)) call tell_warning(sweep%base%case)
    if (.not. allocated(error) .and. options%check) call check_rows(sweep, line, error)
    call hold_interrupts()
    if (allocated(error) .or. options%check) return
    call open_files(options, sweep, error)
    if (allocated(error)) then
      call sweep%lock%release()
      return
    end if
    began = clock()
    call sweep%progress%start(sweep%study%name, show_progress)
    call run_rows(options%jobs, sweep)
    call sweep%progress%finish()
    call close_files(sweep)
    call sweep%lock%release()
    call conclude(sweep, clock() - began, line, error)
  end subroutine run_study_file

  !> Continue the results of the same study, or start from the beginning. Results of another study with the same name are not
  !> changed.
  subroutine open_files(options, sweep, error)
    type(command_line_t), intent(in) :: options
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: label, before
    type(error_t), allocatable :: nothing_there
    logical :: resumes
    integer :: status, i

    call make_directory(options%out, status)
    if (status == 0 .and. sweep%study%traces /= 'none') call make_directory(sweep%path, status)
    if (status /= 0) then
      call fail_with_file(options%out, status, error)
      return
    end if
    call sweep%lock%take(sweep%path, error)
    if (allocated(error)) return
    label = checksum_label//study_checksum(sweep)//newline
    call read_text_file(sweep%path//'.study.nml', 100, 'study', before, nothing_there)
    resumes = .not. options%fresh .and. .not. allocated(nothing_there)
    if (resumes .and. index(before, label) /= 1) then
      call fail(error, printable(sweep%path, 200)// &
        '.runs.csv: belongs to another study, base case or program; --fresh replaces it', &
                status_output)
      return
    end if
    call prepare_files(sweep)
    if (resumes) call take_up(sweep, error)
    do i = size(sweep%files), 1, -1
      if (.not. allocated(error)) call sweep%files(i)%begin(error)
    end do
    if (allocated(error)) return
    call write_text(sweep%path//'.study.nml', label//sweep%study%resolved, error)
    if (.not. allocated(error)) call synchronise_folder(sweep%path, status)
  end subroutine open_files

  subroutine prepare_files(sweep)
    type(sweep_t), intent(inout) :: sweep
    character(len=*), parameter :: none(0) = [character(len=1) ::]
    associate (first => sweep%first, last => sweep%last, keys => sweep%design%keys)
      call sweep%files(file_runs)%prepare(sweep%path//'.runs.csv', run_header(keys, sweep%base%case, sweep%has_strobes), first, &
        last, ['cycles[-] ', 'strobes[-]'])   ! cycles are empty for a failed run
      if (sweep%study%cycles) &
        call sweep%files(file_cycles)%prepare(sweep%path//'.cycles.csv', cycle_header(keys, sweep%base%case), first, last, none)
      if (sweep%has_strobes) &
        call sweep%files(file_strobes)%prepare(sweep%path//'.strobe.csv', strobe_header(sweep%strobe_list), first, last, none)
    end associate
  end subroutine prepare_files

  !> Find the runs that are complete: their row exists, and as many revolutions, strobes and traces as that row says. The rows of
  !> other runs are discarded, and these runs are repeated.
  subroutine take_up(sweep, error)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    integer :: run, cycles, strobes, i
    logical :: fits
    do i = size(sweep%files), 1, -1
      call sweep%files(i)%take_up(error)
      if (allocated(error)) return
    end do
    do run = sweep%first, sweep%last
      fits = sweep%files(file_runs)%length(run) > 0
      if (fits) then
        cycles = sweep%files(file_runs)%numbers(1, run)   ! empty for a run that failed
        strobes = sweep%files(file_runs)%numbers(2, run)
        if (sweep%study%cycles) fits = sweep%files(file_cycles)%rows(run) == cycles
        if (sweep%has_strobes) fits = fits .and. sweep%files(file_strobes)%rows(run) == strobes
        if (fits .and. cycles > 0 .and. sweep%study%traces == 'all') &
          inquire (file=sweep%path//'/'//integer_text(run)//'.csv', exist=fits)
        if (.not. fits) sweep%incomplete = sweep%incomplete + 1
      end if
      if (fits) then
        sweep%began = sweep%began + 1
        if (cycles == 0) sweep%failed = sweep%failed + 1
      else
        do i = 1, size(sweep%files)
          call sweep%files(i)%drop(run)
        end do
      end if
    end do
    sweep%done = sweep%began
  end subroutine take_up

  !> Carry out all runs that have no row yet, with `jobs` threads (0: number of processor cores).
  subroutine run_rows(jobs, sweep)
    integer, intent(in) :: jobs
    type(sweep_t), intent(inout) :: sweep
    integer :: threads
    threads = jobs
    if (threads == 0) threads = omp_get_num_procs()
    threads = max(1, min(threads, sweep%last - sweep%first + 1 - sweep%began))
    sweep%next = sweep%first
    !$omp parallel num_threads(threads)
    call work(sweep)
    !$omp end parallel
  end subroutine run_rows

  !> Work of one thread: carry out the next run until there is none.
  subroutine work(sweep)
    type(sweep_t), intent(inout) :: sweep
    type(study_worker_t), allocatable :: worker
    logical :: is_over
    integer :: run
    allocate (worker)
    call worker%prepare(sweep%study, sweep%design, sweep%base, sweep%strobe_list, sweep%path)
    do
      !$omp atomic capture
      run = sweep%next
      sweep%next = sweep%next + 1
      !$omp end atomic
      !$omp atomic read
      is_over = sweep%is_over
      if (is_over .or. run > sweep%last) exit
      if (sweep%files(file_runs)%length(run) > 0) cycle
      call worker%run(sweep%design, run)
      !$omp critical (study_results)
      call take_results(sweep, worker, run)
      !$omp end critical (study_results)
    end do
  end subroutine work

  !> Add the rows of a run to those not yet written, and write them if it is time.
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
      call sweep%files(file_cycles)%append(run, worker%cycle_rows%text(:worker%cycle_rows%used))
      call sweep%files(file_strobes)%append(run, worker%strobe_rows%text(:worker%strobe_rows%used))
      call sweep%files(file_runs)%append(run, worker%run_row%text(:worker%run_row%used))
      sweep%done = sweep%done + 1
      if (.not. worker%is_done) sweep%failed = sweep%failed + 1
      if (clock() > sweep%next_write .or. &
          sweep%files(file_cycles)%waiting%used + sweep%files(file_strobes)%waiting%used > most_waiting) &
        call write_rows(sweep, sweep%error)
      call sweep%progress%update_runs(sweep%done, sweep%last - sweep%first + 1, sweep%began)
      !$omp end critical (texts)
    end if
    if (allocated(sweep%error)) is_over = .true.
    if (.not. is_over) return
    !$omp atomic write
    sweep%is_over = .true.
  end subroutine take_results

  !> Write the rows not yet written. The row of a run is written after its revolutions, strobes and trace are on the disk, so that a
  !> row always implies these, even after a power failure. The next write is scheduled from the duration of this one.
  subroutine write_rows(sweep, error)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(inout) :: error
    real(dp) :: began, ended
    integer :: unimportant, i
    began = clock()
    if (sweep%study%traces /= 'none') call synchronise_folder(sweep%path//'/', unimportant)
    do i = 1, size(sweep%files)
      if (.not. allocated(error)) call sweep%files(i)%write(error)
    end do
    ended = clock()
    sweep%next_write = ended + min(most_interval, max(least_interval, intervals*(ended - began)))
  end subroutine write_rows

  !> Close the files, sorted if every run has its row. The first error is kept.
  subroutine close_files(sweep)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable :: error
    logical :: complete
    integer :: i
    call write_rows(sweep, error)
    call keep_first(error, sweep%error)
    complete = sweep%done == sweep%last - sweep%first + 1 .and. .not. allocated(sweep%error)
    do i = 1, size(sweep%files)
      call sweep%files(i)%finish(complete, error)
      call keep_first(error, sweep%error)
    end do
  end subroutine close_files

  !> The line for the user and the error at the end of a study.
  subroutine conclude(sweep, wall_time, line, error)
    type(sweep_t), intent(inout) :: sweep
    real(dp), intent(in) :: wall_time   !! [s]
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    integer :: total
    total = sweep%last - sweep%first + 1
    line = sweep%study%name//': '//integer_text(total)//' runs'
    if (sweep%began > 0) line = line//', '//integer_text(sweep%began)//' of them already done'
    if (sweep%incomplete > 0) line = line//', '//integer_text(sweep%incomplete)//' incomplete and run again'
    if (sweep%done > sweep%began) line = line//'; '//short_text(wall_time)//' s, '// &
      rate_text((sweep%done - sweep%began)/max(wall_time, 1e-6_dp))
    line = line//'; '//sweep%path//'.runs.csv'
    if (allocated(sweep%error)) then
      call move_alloc(sweep%error, error)
    else if (sweep%done < total) then
      call fail(error, printable(sweep%study%file, 200)//': interrupted after '//integer_text(sweep%done)//' of '// &
                integer_text(total)//' runs; the same command continues from there', status_integration)
    else if (sweep%failed > 0) then
      call fail(error, printable(sweep%study%file, 200)//': '//integer_text(sweep%failed)//' of '//integer_text(total)// &
                ' runs failed; '//sweep%path//'.runs.csv says why', status_integration)
    end if
  end subroutine conclude
end module study_runner
