!> Runs a study from its file to its results.
!>
!> The runs are divided into chunks, which processes carry out one after the other. The results of a chunk get their names, in the
!> folder NAME.chunks, when all its runs have ended; a sweep that was stopped, or other sweeps of some of its rows, go on with the
!> chunks that are missing. When there are all, they are joined to NAME.runs.csv in the order of the runs, and removed.
module study_runner
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_output, status_integration
  use text_tools, only: printable, integer_text, counted, whole_number
  use number_text, only: short_text
  use result_file, only: result_file_t, write_text, fail_with_file
  use command_line, only: command_line_t
  use run_progress, only: progress_t, rate_text, clock
  use case_runner, only: tell_notes
  use process_pool, only: tasks_t, note_t, share, available_processors
  use posix_files, only: make_directory, remove_folder, list_folder, longest_name, remove_file, file_length, synchronise_folder, &
    wait_for_input, interrupted, signal_set_t, hold_interrupts, restore_interrupts
  use text_file, only: read_whole
  use study_sweep, only: sweep_t, read_sweep, check_rows, study_checksum
  use study_worker, only: study_worker_t
  use study_rows, only: run_header, cycle_header, strobe_header
  implicit none
  private
  public :: run_study_file

  character(len=*), parameter :: newline = achar(10), checksum_label = '! checksum '
  integer, parameter :: most_chunks = 200

  !> The files of results, in the order in which they get their names: the last one says that the others are there.
  integer, parameter :: n_kinds = 3, of_cycles = 1, of_strobes = 2, of_runs = 3
  character(len=*), parameter :: suffixes(n_kinds) = [character(len=11) :: '.cycles.csv', '.strobe.csv', '.runs.csv']

  !> Consecutive runs.
  type :: chunk_t
    integer :: first = 1, last = 0
  end type chunk_t

  !> A study that is being run: its tasks are the chunks that are missing.
  type, extends(tasks_t) :: study_tasks_t
    type(sweep_t) :: sweep
    type(chunk_t), allocatable :: missing(:)
    character(len=:), allocatable :: folder            !! of the chunks
    logical :: has_kind(n_kinds) = .false.
    type(study_worker_t), allocatable :: worker        !! of this process
    integer :: done = 0, began = 0                     !! number of runs done, now and at the start
    integer :: noted = 0                               !! number of runs of this sweep with notes on values or results
    type(progress_t) :: progress
    type(error_t), allocatable :: error
  contains
    procedure :: carry_out
    procedure :: record_note
    procedure :: lost
  end type study_tasks_t

contains

  !> Read a study and run it, or only check it if `options` say so. `line` is the summary for the user. Errors: a wrong study,
  !> results that could not be written, or failed runs. While the study is read or checked, signals are handled as in `before`; they
  !> are held from the first result on.
  subroutine run_study_file(path, options, shows_progress, before, line, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: shows_progress
    type(signal_set_t), intent(in) :: before
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    type(study_tasks_t), allocatable :: tasks
    type(signal_set_t) :: again
    real(dp) :: began   ! [s]
    integer :: jobs

    call restore_interrupts(before)
    line = ''
    allocate (tasks)
    call read_sweep(path, options, tasks%sweep, error)
    if (.not. (allocated(error) .or. options%quiet)) call tell_notes(tasks%sweep%base%case)
    if (.not. allocated(error) .and. options%check) call check_rows(tasks%sweep, line, error)
    call hold_interrupts(again)
    if (allocated(error) .or. options%check) return
    call prepare_folder(options, tasks, error)
    if (allocated(error)) return
    began = clock()
    call tasks%progress%start(tasks%sweep%study%name, shows_progress)
    jobs = options%jobs
    if (jobs == 0) jobs = available_processors()
    call share(tasks, size(tasks%missing), jobs)
    call tasks%progress%finish()
    call conclude(tasks, clock() - began, line, error)
  end subroutine run_study_file

  !> Make the folders, and find out which chunks are missing. Error: the results of another study with the same name are there.
  subroutine prepare_folder(options, tasks, error)
    type(command_line_t), intent(in) :: options
    type(study_tasks_t), intent(inout) :: tasks
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: label, before
    integer :: status, kind, ignored
    associate (sweep => tasks%sweep)
      tasks%folder = sweep%path//'.chunks'
      tasks%has_kind = [sweep%study%cycles, sweep%has_strobes, .true.]
      call make_directory(options%out, status)
      if (status == 0 .and. sweep%study%traces /= 'none') call make_directory(sweep%path, status)
      if (status /= 0) then
        call fail_with_file(options%out, status, error)
        return
      end if
      label = checksum_label//study_checksum(sweep)//newline
      call read_whole(sweep%path//'.study.nml', before, status)
      if (options%fresh .or. status /= 0 .and. options%last_row == 0) then
        before = ''
        do kind = n_kinds, 1, -1
          call remove_file(sweep%path//trim(suffixes(kind)), ignored)
        end do
        call remove_chunks(tasks)
      end if
      if (before /= '' .and. index(before, label) /= 1) then
        call fail(error, printable(sweep%path, 200)// &
          '.runs.csv: belongs to another study, base case or program; --fresh replaces it', status_output)
        return
      end if
      if (before == '') call write_study(sweep, label, error)
      if (allocated(error)) return
      call synchronise_folder(sweep%path, ignored)
      call make_directory(tasks%folder, status)
      if (status /= 0) call fail_with_file(tasks%folder, status, error)
    end associate
    if (.not. allocated(error)) call find_missing(tasks)
  end subroutine prepare_folder

  !> Write the study with its checksum. Another sweep of its rows may do so at the same time.
  subroutine write_study(sweep, label, error)
    type(sweep_t), intent(in) :: sweep
    character(len=*), intent(in) :: label
    type(error_t), allocatable, intent(out) :: error
    integer, parameter :: most_tries = 20, timeout = 50   !! [ms]
    integer, parameter :: nothing = -1
    character(len=:), allocatable :: present
    logical :: unused
    integer :: try, status
    do try = 1, most_tries
      call write_text(sweep%path//'.study.nml', label//sweep%study%resolved, error)
      if (.not. allocated(error)) return
      call wait_for_input(nothing, timeout, unused)
      call read_whole(sweep%path//'.study.nml', present, status)
      if (index(present, label) /= 1) cycle
      deallocate (error)
      return
    end do
  end subroutine write_study

  !> Remove all chunks.
  subroutine remove_chunks(tasks)
    type(study_tasks_t), intent(in) :: tasks
    character(len=longest_name), allocatable :: names(:)
    integer :: i, ignored
    call list_folder(tasks%folder, names)
    do i = 1, size(names)
      call remove_file(tasks%folder//'/'//trim(names(i)), ignored)
    end do
    call remove_folder(tasks%folder)
  end subroutine remove_chunks

  !> Divide the runs that have no results into chunks.
  subroutine find_missing(tasks)
    type(study_tasks_t), intent(inout) :: tasks
    type(chunk_t), allocatable :: found(:)
    logical :: is_found(tasks%sweep%first:tasks%sweep%last)
    integer :: i, size_of
    associate (sweep => tasks%sweep)
      is_found(:) = is_whole(tasks, sweep%path, chunk_t(1, sweep%design%runs))
      call find_chunks(tasks, found)
      do i = 1, size(found)
        if (is_whole(tasks, base_of(tasks, found(i)), found(i))) &
          is_found(max(found(i)%first, sweep%first):min(found(i)%last, sweep%last)) = .true.
      end do
      tasks%began = count(is_found)
      tasks%done = tasks%began
      size_of = (sweep%design%runs - 1)/most_chunks + 1
      if (sweep%study%start == 'previous') size_of = sweep%design%runs   ! one process, one run after the other
      allocate (tasks%missing(0))
      do i = sweep%first, sweep%last
        if (is_found(i)) cycle
        if (i == sweep%first .or. mod(i - 1, size_of) == 0) then
          tasks%missing = [tasks%missing, chunk_t(i, i)]
        else if (is_found(i - 1)) then
          tasks%missing = [tasks%missing, chunk_t(i, i)]
        else
          tasks%missing(size(tasks%missing))%last = i
        end if
      end do
    end associate
  end subroutine find_missing

  !> Whether the results of a chunk, or of all runs, are there with every row: the row of a run says how many the other files have
  !> of it. (A power cut may take rows, or leave zeros in their place.) Otherwise its table of runs is removed: they are missing.
  logical function is_whole(tasks, base, chunk)
    type(study_tasks_t), intent(in) :: tasks
    character(len=*), intent(in) :: base   !! path of its results, without suffix
    type(chunk_t), intent(in) :: chunk
    character(len=:), allocatable :: text, header
    integer :: kind, rows, failed, status, ignored, wanted(n_kinds)
    wanted = 0
    is_whole = .true.
    do kind = n_kinds, 1, -1   ! runs first
      if (.not. (tasks%has_kind(kind) .and. is_whole)) cycle
      call read_whole(base//trim(suffixes(kind)), text, status)
      if (kind == of_runs) then
        call count_rows(tasks, text, chunk, rows, failed, wanted)
      else
        call count_rows(tasks, text, chunk, rows, failed)
      end if
      header = header_of(tasks%sweep, kind)
      is_whole = status == 0 .and. rows == wanted(kind) .and. index(text, header) == 1 .and. &
        index(text, newline, back=.true.) == len(text) .and. index(text, achar(0)) == 0
    end do
    if (.not. is_whole) call remove_file(base//trim(suffixes(of_runs)), ignored)
  end function is_whole

  !> The chunks whose results are there, in the order of their runs.
  subroutine find_chunks(tasks, found)
    type(study_tasks_t), intent(in) :: tasks
    type(chunk_t), allocatable, intent(out) :: found(:)
    character(len=longest_name), allocatable :: names(:)
    type(chunk_t) :: chunk
    integer :: i, at, dash, dot
    call list_folder(tasks%folder, names)
    allocate (found(0))
    do i = 1, size(names)
      dash = index(names(i), '-')
      dot = index(names(i), trim(suffixes(of_runs))//' ')
      if (dash < 2 .or. dash > 9 .or. dot < dash + 2 .or. dot > dash + 9) cycle
      if (verify(names(i)(:dash - 1)//names(i)(dash + 1:dot - 1), '0123456789') > 0) cycle
      chunk = chunk_t(int(whole_number(names(i)(:dash - 1))), int(whole_number(names(i)(dash + 1:dot - 1))))
      if (chunk%first < 1 .or. chunk%last > tasks%sweep%design%runs) cycle
      at = count(found%first < chunk%first)
      found = [found(:at), chunk, found(at + 1:)]
    end do
    do i = 2, size(found)   ! of two that overlap, which sweeps of different rows may leave, the first one counts
      if (found(i)%first <= maxval(found(:i - 1)%last)) found(i)%last = 0
    end do
    found = pack(found, found%last > 0)
  end subroutine find_chunks

  !> Path of the results of a chunk, without suffix.
  function base_of(tasks, chunk) result(path)
    class(study_tasks_t), intent(in) :: tasks
    type(chunk_t), intent(in) :: chunk
    character(len=:), allocatable :: path
    path = tasks%folder//'/'//integer_text(chunk%first)//'-'//integer_text(chunk%last)
  end function base_of

  !> First row of a file of results.
  function header_of(sweep, kind) result(text)
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: kind
    character(len=:), allocatable :: text
    if (kind == of_runs) text = run_header(sweep%design%keys, sweep%base%case, sweep%has_strobes, &
      sweep%statistics)
    if (kind == of_cycles) text = cycle_header(sweep%design%keys, sweep%base%case)
    if (kind == of_strobes) text = strobe_header(sweep%strobe_list)
  end function header_of

  !> Carry out the runs of a chunk, and write their results. If it is interrupted, or a file cannot be written, there are none.
  subroutine carry_out(self, task, note)
    class(study_tasks_t), intent(inout) :: self
    integer, intent(in) :: task
    type(note_t), intent(inout) :: note
    type(result_file_t) :: file(n_kinds)
    type(error_t), allocatable :: error
    logical :: is_whole
    integer :: kind, run
    is_whole = .not. interrupted()
    if (self%is_over .or. .not. is_whole) return
    if (.not. allocated(self%worker)) then
      allocate (self%worker)
      call self%worker%prepare(self%sweep%study, self%sweep%design, self%sweep%base, self%sweep%strobe_list, &
        self%sweep%statistics, self%sweep%path)
    end if
    associate (chunk => self%missing(task), worker => self%worker)
      do kind = 1, n_kinds
        if (self%has_kind(kind) .and. .not. allocated(error)) &
          call file(kind)%open(base_of(self, chunk)//trim(suffixes(kind)), error, whole_only=.true.)
        if (.not. allocated(error)) call file(kind)%append(header_of(self%sweep, kind))
      end do
      do run = chunk%first, chunk%last
        is_whole = .not. interrupted()
        if (.not. is_whole .or. allocated(error)) exit
        call worker%run(self%sweep%design, run)
        if (allocated(worker%output_error)) call move_alloc(worker%output_error, error)
        is_whole = .not. (worker%was_interrupted .or. allocated(error))
        if (.not. is_whole) exit
        call file(of_cycles)%append(worker%cycle_rows%text(:worker%cycle_rows%used))
        call file(of_strobes)%append(worker%strobe_rows%text(:worker%strobe_rows%used))
        call file(of_runs)%append(worker%run_row%text(:worker%run_row%used))
        if (worker%notes > 0) note%numbers(2) = note%numbers(2) + 1
      end do
      do kind = 1, n_kinds
        if (is_whole .and. .not. allocated(error)) call file(kind)%close(error)
        if (.not. is_whole .or. allocated(error)) call file(kind)%abandon()
      end do
      if (allocated(error)) note%text = error%message
      if (is_whole .and. .not. allocated(error)) note%numbers(1) = chunk%last - chunk%first + 1
    end associate
  end subroutine carry_out

  subroutine record_note(self, note)
    class(study_tasks_t), intent(inout) :: self
    type(note_t), intent(in) :: note
    self%done = self%done + note%numbers(1)
    if (note%numbers(1) > 0) self%noted = self%noted + note%numbers(2)
    if (note%text /= '' .and. .not. allocated(self%error)) call fail(self%error, trim(note%text), status_output)
    self%is_over = allocated(self%error)
    call self%progress%update_runs(self%done, self%sweep%last - self%sweep%first + 1, self%began)
  end subroutine record_note

  subroutine lost(self, task, signal)
    class(study_tasks_t), intent(inout) :: self
    integer, intent(in) :: task, signal
    associate (chunk => self%missing(task))
      if (.not. allocated(self%error)) call fail(self%error, printable(self%sweep%study%file, 200)// &
        ': the process of the runs '//integer_text(chunk%first)//' to '//integer_text(chunk%last)//' was killed by signal '// &
        integer_text(signal)//'; the results of other runs are kept, and the same command continues', status_integration)
    end associate
  end subroutine lost

  !> Join the results of all chunks, which are then removed. Error: a result cannot be written, or a chunk is damaged.
  subroutine join(tasks, error)
    type(study_tasks_t), intent(in) :: tasks
    type(error_t), allocatable, intent(out) :: error
    type(chunk_t), allocatable :: found(:)
    type(result_file_t) :: file
    character(len=:), allocatable :: path, text, header
    integer :: i, kind, status, ignored
    call find_chunks(tasks, found)
    do i = 1, size(found)
      path = base_of(tasks, found(i))
      if (is_whole(tasks, path, found(i))) cycle
      call fail(error, printable(path, 200)//trim(suffixes(of_runs))//': damaged; the same command runs its rows again', &
        status_output)
      return
    end do
    do kind = 1, n_kinds
      if (.not. tasks%has_kind(kind)) cycle
      header = header_of(tasks%sweep, kind)
      call file%open(tasks%sweep%path//trim(suffixes(kind)), error, whole_only=.true.)
      if (allocated(error)) return
      call file%append(header)
      do i = 1, size(found)
        path = base_of(tasks, found(i))
        call read_whole(path//trim(suffixes(kind)), text, status)
        call file%append(text(len(header) + 1:))
      end do
      call file%synchronise()
      call file%close(error)
      if (allocated(error)) return
    end do
    call synchronise_folder(tasks%sweep%path, ignored)
    call remove_chunks(tasks)
  end subroutine join

  !> Number of rows of the runs of a chunk in the text of a table of runs, how many of these runs failed, and how many rows the
  !> files of this chunk have.
  subroutine count_rows(tasks, text, chunk, rows, failed, wanted)
    type(study_tasks_t), intent(in) :: tasks
    character(len=*), intent(in) :: text
    type(chunk_t), intent(in) :: chunk
    integer, intent(out) :: rows, failed
    integer, intent(out), optional :: wanted(n_kinds)
    character(len=:), allocatable :: header
    integer :: at, length, run, first, last, fields(of_cycles:of_strobes), kind
    rows = 0
    failed = 0
    if (present(wanted)) then
      wanted = 0
      wanted(of_runs) = chunk%last - chunk%first + 1
      header = header_of(tasks%sweep, of_runs)
      at = index(header, ',strobes')
      fields = [size(tasks%sweep%design%keys) + 3, 1 + count([(header(run:run) == ',', run=1, at)])]
    end if
    at = index(text, newline) + 1
    do while (at <= len(text) .and. at > 1)
      length = index(text(at:), newline) - 1
      if (length < 0) exit
      associate (line => text(at:at + length - 1))
        call find_field(line, 1, first, last)
        run = 0
        if (last > 0 .and. last < 9 .and. verify(line(:last), '0123456789') == 0) run = int(whole_number(line(:last)))
        if (run >= chunk%first .and. run <= chunk%last) then
          rows = rows + 1
          call find_field(line, size(tasks%sweep%design%keys) + 2, first, last)
          if (line(first:last) /= 'done') failed = failed + 1
          if (present(wanted) .and. line(first:last) == 'done') then
            do kind = of_cycles, of_strobes
              call find_field(line, fields(kind), first, last)
              if (tasks%has_kind(kind) .and. verify(line(first:last), '0123456789') == 0 .and. last - first < 9) &
                wanted(kind) = wanted(kind) + int(whole_number(line(first:last)))
            end do
          end if
        end if
      end associate
      at = at + length + 1
    end do
  end subroutine count_rows

  !> First and last character of a field of a row. A comma between quotes is a part of a field.
  pure subroutine find_field(line, number, first, last)
    character(len=*), intent(in) :: line
    integer, intent(in) :: number
    integer, intent(out) :: first, last
    logical :: is_quoted
    integer :: fields
    is_quoted = .false.
    fields = 1
    first = 1
    do last = 1, len(line)
      if (line(last:last) == '"') is_quoted = .not. is_quoted
      if (line(last:last) /= ',' .or. is_quoted) cycle
      if (fields == number) exit
      fields = fields + 1
      first = last + 1
    end do
    last = last - 1
  end subroutine find_field

  !> Number of the runs of this sweep that failed, in the results that there are.
  integer function failures(tasks) result(number)
    type(study_tasks_t), intent(in) :: tasks
    type(chunk_t), allocatable :: found(:)
    character(len=:), allocatable :: text
    type(chunk_t) :: wanted
    integer :: i, rows, failed, status
    wanted = chunk_t(tasks%sweep%first, tasks%sweep%last)
    call find_chunks(tasks, found)
    call read_whole(tasks%sweep%path//trim(suffixes(of_runs)), text, status)
    call count_rows(tasks, text, wanted, rows, number)
    do i = 1, size(found)
      call read_whole(base_of(tasks, found(i))//trim(suffixes(of_runs)), text, status)
      call count_rows(tasks, text, wanted, rows, failed)
      number = number + failed
    end do
  end function failures

  !> Join the results if they are complete. The line for the user, and the error at the end of a study.
  subroutine conclude(tasks, wall_time, line, error)
    type(study_tasks_t), intent(inout) :: tasks
    real(dp), intent(in) :: wall_time   !! [s]
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    integer :: total, failed
    logical :: is_joined
    associate (sweep => tasks%sweep, done => tasks%done, began => tasks%began)
      total = sweep%last - sweep%first + 1
      line = printable(sweep%study%name, 200)//': '
      if (done < total) line = line//integer_text(done)//' of '
      line = line//counted(integer_text(total), 'run')
      if (began > 0) line = line//', '//integer_text(began)//' of them already done'
      if (done > began) line = line//'; '//short_text(wall_time, 3)//' s, '//rate_text((done - began)/max(wall_time, 1e-6_dp))
      if (tasks%noted > 0) line = line//'; '//integer_text(tasks%noted)//' with notes (column notes)'
      is_joined = file_length(sweep%path//trim(suffixes(of_runs))) >= 0
      if (total == sweep%design%runs .and. done == total .and. .not. is_joined) then
        call join(tasks, tasks%error)
        is_joined = .not. allocated(tasks%error)
      end if
      if (is_joined) then
        call remove_chunks(tasks)
        line = line//'; '//printable(sweep%path, 1000)//trim(suffixes(of_runs))
      else
        line = line//'; '//printable(tasks%folder, 1000)
      end if
      failed = failures(tasks)
      if (allocated(tasks%error)) then
        call move_alloc(tasks%error, error)
      else if (done < total) then
        call fail(error, printable(sweep%study%file, 200)//': interrupted after '//integer_text(done)//' of '// &
          integer_text(total)//' runs; the same command continues from there', status_integration)
      else if (failed > 0) then
        call fail(error, printable(sweep%study%file, 200)//': '//integer_text(failed)//' of '//integer_text(total)// &
          ' runs failed; '//line(index(line, '; ', back=.true.) + 2:)//' says why', status_integration)
      end if
    end associate
  end subroutine conclude
end module study_runner
