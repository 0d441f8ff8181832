!> A case from its file to its results.
module case_runner
  use errors, only: error_t, fail, status_output, status_integration
  use case_definition, only: case_t
  use accuracy_presets, only: with_preset
  use case_file, only: read_case, write_resolved
  use command_line, only: command_line_t
  use columns, only: column_list_t, choose_columns
  use scene, only: scene_t
  use scene_builder, only: build_scene, simulated_time
  use simulation, only: simulate, run_report_t, interrupted_text
  use trace_sink, only: trace_sink_t
  use trace_files, only: trace_files_t
  use result_file, only: result_file_t, remove_unfinished
  use case_lock, only: case_lock_t
  use continuation, only: continuation_t
  use archive, only: archive_t
  use summary, only: summary_table, summary_line, advice
  use posix, only: make_directory, write_bytes, error_text
  use text_tools, only: printable
  implicit none
  private
  public :: run_case_file, write_text

contains

  !> Read a case, and unless only a check is asked for run it and write its results. `line` is the summary for people, `notice` what
  !> they should know besides.
  !> An error's message begins with the case file's name; a case that is wrong writes nothing.
  subroutine run_case_file(path, options, show_progress, line, notice, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    character(len=:), allocatable, intent(out) :: line, notice
    type(error_t), allocatable, intent(out) :: error
    type(case_t) :: case
    type(column_list_t) :: list, ideal_list
    type(case_lock_t) :: lock
    type(continuation_t) :: start
    character(len=:), allocatable :: base

    !$omp critical (texts)
    line = ''
    notice = ''
    base = ''
    call prepare(path, options, case, list, ideal_list, base, error)
    if (.not. allocated(error) .and. .not. options%check) call take_place(path, options, case, base, lock, start, error)
    if (.not. allocated(error) .and. options%check) line = path//': correct'
    !$omp end critical (texts)
    if (.not. allocated(error) .and. .not. options%check) then
      if (start%is_done) then
        line = path//': done already; '//base//'.csv'
      else
        call run_one(case, .false., start, list, base, show_progress, line, notice, error)
      end if
      call run_twin(case, start, ideal_list, base, show_progress, line, notice, error)
    end if
    call lock%release()
  end subroutine run_case_file

  !> Run the ideal twin of a case that asks for one, unless the run itself was interrupted.
  subroutine run_twin(case, start, ideal_list, base, show_progress, line, notice, error)
    type(case_t), intent(in) :: case
    type(continuation_t), intent(in) :: start
    type(column_list_t), intent(in) :: ideal_list
    character(len=*), intent(in) :: base
    logical, intent(in) :: show_progress
    character(len=:), allocatable, intent(inout) :: line, notice
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: ideal_error

    if (.not. case%output%ideal_twin .or. case%joint%kind == 'ideal') return
    if (allocated(error)) then
      if (index(error%message, interrupted_text) > 0) return
    end if
    call run_one(case, .true., start, ideal_list, base, show_progress, line, notice, ideal_error)
    if (allocated(ideal_error) .and. .not. allocated(error)) call move_alloc(ideal_error, error)
  end subroutine run_twin

  !> Read and check a case. `base` is the path of its results without their endings.
  subroutine prepare(path, options, case, list, ideal_list, base, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    type(case_t), intent(out) :: case
    type(column_list_t), intent(out) :: list, ideal_list
    character(len=:), allocatable, intent(inout) :: base
    type(error_t), allocatable, intent(out) :: error
    class(scene_t), allocatable :: scene

    call read_case(path, with_preset(options%accuracy, options%overrides), case, error)
    if (allocated(error)) return
    base = options%out//'/'//case%name
    call choose_columns(case, .false., list, error)
    if (.not. allocated(error)) call choose_columns(case, .true., ideal_list, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) call name_file(path, error)
  end subroutine prepare

  !> Make the folder for the results, lock them, look for what is there where the run is to go on, write the resolved case.
  subroutine take_place(path, options, case, base, lock, start, error)
    character(len=*), intent(in) :: path, base
    type(command_line_t), intent(in) :: options
    type(case_t), intent(in) :: case
    type(case_lock_t), intent(inout) :: lock
    type(continuation_t), intent(inout) :: start
    type(error_t), allocatable, intent(out) :: error
    integer, parameter :: standard_error = 2
    character(len=:), allocatable :: case_text
    integer :: status, done

    call make_directory(options%out, status)
    if (status /= 0) then
      call fail(error, printable(options%out, 200)//': '//error_text(status), status_output)
    else
      call lock%take(base, error)
    end if
    if (allocated(error)) return
    case_text = write_resolved(case)
    start%checkpoint%path = base//'.checkpoint'
    start%interval = options%checkpoint_interval
    if (options%resume) then
      call start%look_for(base, path, case_text, error)
      if (allocated(error) .or. start%is_done) return
      if (.not. start%goes_on .and. .not. options%quiet) call write_bytes(standard_error, &
        'gudgeon: '//printable(path, 200)//': no checkpoint in '//printable(options%out, 200)//': starts from the beginning'// &
        achar(10), done, status)
    end if
    start%checkpoint%case_text = case_text
    if (start%goes_on) return
    call start%checkpoint%remove()   ! the files that it belongs to are written anew
    call remove_leftovers(base)
    call write_text(base//'.resolved.nml', case_text, error)
  end subroutine take_place

  !> Remove what a run that was killed has left under temporary names.
  subroutine remove_leftovers(base)
    character(len=*), intent(in) :: base
    character(len=13), parameter :: endings(5) = [character(len=13) :: '.csv', '.events.csv', '.summary.csv', '.ideal.csv', &
      '.resolved.nml']
    integer :: i
    do i = 1, size(endings)
      call remove_unfinished(base//trim(endings(i)))
    end do
  end subroutine remove_leftovers

  !> Run a case and write BASE.csv, events and summary, or its ideal twin and write BASE.ideal.csv. `start` tells
  !> where the run begins; the twin always does at its beginning.
  subroutine run_one(case, ideal_joint, start, list, base, show_progress, line, notice, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(continuation_t), intent(in) :: start
    type(column_list_t), intent(in) :: list
    character(len=*), intent(in) :: base
    logical, intent(in) :: show_progress
    character(len=:), allocatable, intent(inout) :: line, notice
    type(error_t), allocatable, intent(out) :: error
    class(trace_sink_t), allocatable :: sink
    type(run_report_t) :: report
    type(archive_t) :: archive

    !$omp critical (texts)
    call open_files(case, ideal_joint, start, list, base, show_progress, sink, error)
    !$omp end critical (texts)
    if (allocated(error)) return
    if (start%goes_on .and. .not. ideal_joint) then
      call archive%begin_reading(start%checkpoint%state)
      call simulate(case, ideal_joint, list, sink, report, error, archive)
    else
      call simulate(case, ideal_joint, list, sink, report, error)
    end if
    !$omp critical (texts)
    call close_files(case, ideal_joint, base, sink, report, line, notice, error)
    !$omp end critical (texts)
  end subroutine run_one

  subroutine open_files(case, ideal_joint, start, list, base, show_progress, sink, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(continuation_t), intent(in) :: start
    type(column_list_t), intent(in) :: list
    character(len=*), intent(in) :: base
    logical, intent(in) :: show_progress
    class(trace_sink_t), allocatable, intent(out) :: sink
    type(error_t), allocatable, intent(out) :: error
    type(trace_files_t), allocatable :: files

    allocate (files)
    if (ideal_joint) then
      call files%open(base//'.ideal', list, case%output%digits, .false., error)
    else if (start%goes_on) then
      call files%reopen(base, list, case%output%digits, case%contact%is_present, start%checkpoint, error)
      if (.not. allocated(error)) call write_text(base//'.resolved.nml', start%checkpoint%case_text, error)
    else
      call files%open(base, list, case%output%digits, case%contact%is_present, error)
    end if
    if (allocated(error)) return
    if (.not. ideal_joint) call files%keep_checkpoints(start%checkpoint%path, start%checkpoint%case_text, start%interval)
    files%end_time = simulated_time(case)
    call files%progress%start(case%name, show_progress)
    call move_alloc(files, sink)
  end subroutine open_files

  !> Close the files and write the summary. An error of the output goes before one of the integration.
  subroutine close_files(case, ideal_joint, base, sink, report, line, notice, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    character(len=*), intent(in) :: base
    class(trace_sink_t), allocatable, intent(inout) :: sink
    type(run_report_t), intent(inout) :: report
    character(len=:), allocatable, intent(inout) :: line, notice
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: trace_error, summary_error

    if (allocated(error)) call name_file(case%file, error)
    select type (sink)
    type is (trace_files_t)
      call sink%close(trace_error)
      if (allocated(trace_error)) report%status = 'stopped: '//trace_error%message
      if (.not. ideal_joint) then
        line = summary_line(case, report, sink%wall_time(), base)
        notice = advice(report)
        if (notice /= '') notice = printable(case%file, 200)//': '//notice
        call write_text(base//'.summary.csv', summary_table(case, report, sink%wall_time()), summary_error)
        if (.not. (report%can_go_on .or. allocated(trace_error) .or. allocated(summary_error))) call sink%checkpoint%remove()
        if (allocated(error) .and. report%can_go_on) call tell_how_to_go_on(sink, error)
      end if
    end select
    if (allocated(trace_error)) then
      call move_alloc(trace_error, error)
    else if (allocated(summary_error)) then
      call move_alloc(summary_error, error)
    end if
  end subroutine close_files

  !> Add to the message of a run that was stopped how it can go on.
  subroutine tell_how_to_go_on(files, error)
    type(trace_files_t), intent(in) :: files
    type(error_t), intent(inout) :: error
    if (.not. files%keeps_archives) return
    if (allocated(files%checkpoint_error)) then
      error%message = error%message//'; no checkpoint: '//files%checkpoint_error%message
    else
      error%message = error%message//'; --resume goes on from there'
    end if
  end subroutine tell_how_to_go_on

  !> A small file, written whole or not at all.
  subroutine write_text(path, text, error)
    character(len=*), intent(in) :: path, text
    type(error_t), allocatable, intent(out) :: error
    type(result_file_t) :: file
    call file%open(path, error)
    if (allocated(error)) return
    call file%put(text)
    call file%close(error, whole_only=.true.)
  end subroutine write_text

  !> Put the case file's name before an error that does not have it.
  subroutine name_file(path, error)
    character(len=*), intent(in) :: path
    type(error_t), intent(inout) :: error
    error%message = printable(path, 200)//': '//error%message
  end subroutine name_file
end module case_runner
