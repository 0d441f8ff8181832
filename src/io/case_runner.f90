!> A case from its file to its results.
module case_runner
  use errors, only: error_t, fail, status_output
  use case_definition, only: case_t
  use accuracy_presets, only: with_preset
  use case_file, only: read_case_values, complete_case
  use case_text, only: resolved_text
  use case_values, only: case_values_t
  use case_rules, only: case_warning
  use command_line, only: command_line_t
  use columns, only: column_list_t, choose_columns
  use scene, only: scene_t
  use scene_builder, only: build_scene
  use case_run, only: case_run_t, go_beside, name_file
  use result_file, only: write_text, remove_unfinished
  use row_queue, only: row_queue_t
  use case_lock, only: case_lock_t
  use continuation, only: continuation_t
  use posix, only: make_directory, error_text
  use progress, only: tell
  use text_tools, only: printable
  implicit none
  private
  public :: run_case_file, tell_warning

contains

  !> Read a case, and unless only a check is asked for run it and write its results; with two threads the ideal twin goes
  !> beside it. `line` is the summary for people, `notice` what they should know besides.
  !> An error's message begins with the case file's name; a case that is wrong writes nothing.
  subroutine run_case_file(path, options, show_progress, threads, line, notice, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    integer, intent(in) :: threads   !! for this case
    character(len=:), allocatable, intent(out) :: line, notice
    type(error_t), allocatable, intent(out) :: error
    type(case_values_t) :: values
    type(case_t) :: case
    type(column_list_t) :: list, ideal_list
    type(case_lock_t) :: lock
    type(continuation_t) :: start
    character(len=:), allocatable :: base

    !$omp critical (texts)
    line = ''
    notice = ''
    base = ''
    call prepare(path, options, values, case, list, ideal_list, base, error)
    if (.not. allocated(error) .and. .not. options%check) call take_place(path, options, values, base, lock, start, error)
    if (.not. allocated(error)) then
      if (options%check) line = path//': correct'
      if (start%is_done) line = path//': done already; '//base//'.csv'
    end if
    !$omp end critical (texts)
    if (.not. (allocated(error) .or. options%check)) &
      call run_case(case, start, list, ideal_list, base, show_progress, options%quiet, threads, line, notice, error)
    call lock%release()
  end subroutine run_case_file

  !> Run a case and then, or beside it, its ideal twin if it asks for one; of a run that was interrupted there is no twin. The
  !> error is the first of the two.
  subroutine run_case(case, start, list, ideal_list, base, show_progress, quiet, threads, line, notice, error)
    type(case_t), intent(in) :: case
    type(continuation_t), intent(in) :: start
    type(column_list_t), intent(in) :: list, ideal_list
    character(len=*), intent(in) :: base
    logical, intent(in) :: show_progress, quiet
    integer, intent(in) :: threads
    character(len=:), allocatable, intent(inout) :: line, notice
    type(error_t), allocatable, intent(out) :: error
    type(case_run_t), target :: run, twin
    type(row_queue_t), target :: queue
    logical :: has_twin

    has_twin = case%output%ideal_twin .and. case%has_clearance()
    call run%prepare(case, .false., start, list, base, show_progress, quiet)
    call twin%prepare(case, .true., start, ideal_list, base, show_progress .and. threads == 1, quiet)
    if (has_twin .and. threads > 1) call go_beside(twin, run, queue)
    if (.not. start%is_done) call run%go()
    call twin%let_end(is_kept=.not. run%was_interrupted())
    call run%finish(line, notice)
    if (run%was_interrupted()) then
      call twin%give_up()
    else if (has_twin) then
      call twin%go()
      call twin%finish(line, notice)
    end if
    if (allocated(run%error)) then
      call move_alloc(run%error, error)
    else if (allocated(twin%error)) then
      call move_alloc(twin%error, error)
    end if
  end subroutine run_case

  !> Read and check a case. `base` is the path of its results without their endings.
  subroutine prepare(path, options, values, case, list, ideal_list, base, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    type(case_values_t), intent(out) :: values
    type(case_t), intent(out) :: case
    type(column_list_t), intent(out) :: list, ideal_list
    character(len=:), allocatable, intent(inout) :: base
    type(error_t), allocatable, intent(out) :: error
    class(scene_t), allocatable :: scene

    call read_case_values(path, with_preset(options%accuracy, options%overrides), values, error)
    if (.not. allocated(error)) call complete_case(values, path, case, error)
    if (allocated(error)) return
    base = options%out//'/'//case%name
    call choose_columns(case, .false., list, error)
    if (.not. allocated(error)) call choose_columns(case, .true., ideal_list, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) call name_file(path, error)
    if (.not. (allocated(error) .or. options%quiet)) call tell_warning(case)
  end subroutine prepare

  !> Tell what in a case is right but has no effect.
  subroutine tell_warning(case)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: warning
    warning = case_warning(case)
    if (warning /= '') call tell(printable(case%file, 200)//': '//warning)
  end subroutine tell_warning

  !> Make the folder for the results, lock them, look for what is there where the run is to go on, write the resolved case.
  subroutine take_place(path, options, values, base, lock, start, error)
    character(len=*), intent(in) :: path, base
    type(command_line_t), intent(in) :: options
    type(case_values_t), intent(in) :: values   !! of the case
    type(case_lock_t), intent(inout) :: lock
    type(continuation_t), intent(inout) :: start
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: case_text
    integer :: status

    call make_directory(options%out, status)
    if (status /= 0) then
      call fail(error, printable(options%out, 200)//': '//error_text(status), status_output)
    else
      call lock%take(base, error)
    end if
    if (allocated(error)) return
    case_text = resolved_text(values)
    start%checkpoint%path = base//'.checkpoint'
    start%interval = options%checkpoint_interval
    if (options%resume) then
      call start%look_for(base, path, case_text, error)
      if (allocated(error) .or. start%is_done) return
      if (.not. start%goes_on .and. .not. options%quiet) &
        call tell(printable(path, 200)//': no checkpoint in '//printable(options%out, 200)//': starts from the beginning')
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
end module case_runner
