!> A case from its file to its results.
module case_runner
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use errors, only: error_t, fail, status_output, status_integration
  use case_definition, only: case_t
  use case_file, only: read_case, write_resolved
  use command_line, only: command_line_t
  use columns, only: column_list_t, choose_columns
  use scene, only: scene_t
  use scene_builder, only: build_scene, simulated_time
  use simulation, only: simulate, run_report_t, interrupted_text
  use trace_sink, only: trace_sink_t
  use trace_files, only: trace_files_t
  use result_file, only: result_file_t
  use summary, only: summary_table, summary_line
  use posix, only: make_directory, error_text
  use text_tools, only: printable
  implicit none
  private
  public :: run_case_file

contains

  !> Read a case, and unless only a check is asked for run it and write its results. `line` is the summary for people.
  !> An error's message begins with the case file's name; a case that is wrong writes nothing.
  subroutine run_case_file(path, options, show_progress, line, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    type(case_t) :: case
    type(column_list_t) :: list, ideal_list
    class(scene_t), allocatable :: scene
    type(error_t), allocatable :: ideal_error
    character(len=:), allocatable :: base
    integer :: status

    line = ''
    call read_case(path, with_accuracy(options), case, error)
    if (allocated(error)) return
    call choose_columns(case, .false., list, error)
    if (.not. allocated(error)) call choose_columns(case, .true., ideal_list, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) then
      call name_file(path, error)
      return
    end if
    if (options%check) then
      line = path//': correct'
      return
    end if
    call make_directory(options%out, status)
    if (status /= 0) then
      call fail(error, printable(options%out, 200)//': '//error_text(status), status_output)
      return
    end if
    base = options%out//'/'//case%name
    call write_text(base//'.resolved.nml', write_resolved(case), error)
    if (allocated(error)) return
    call run_one(case, .false., list, base, show_progress, line, error)
    if (case%output%ideal_twin .and. case%joint%kind /= 'ideal') then
      if (allocated(error)) then
        if (index(error%message, interrupted_text) > 0) return
      end if
      call run_one(case, .true., ideal_list, base//'.ideal', show_progress, line, ideal_error)
      if (allocated(ideal_error) .and. .not. allocated(error)) call move_alloc(ideal_error, error)
    end if
  end subroutine run_case_file

  !> The overrides of the command line, those of an accuracy preset first.
  function with_accuracy(options) result(overrides)
    type(command_line_t), intent(in) :: options
    character(len=:), allocatable :: overrides(:)
    character(len=:), allocatable :: tolerance
    integer :: i
    select case (options%accuracy)
    case ('draft')
      tolerance = 'integrator.relative_tolerance=1e-4'
    case ('standard')
      tolerance = 'integrator.relative_tolerance=1e-6'
    case ('reference')
      tolerance = 'integrator.relative_tolerance=1e-9'
    case default
      allocate (character(len=len(options%overrides)) :: overrides(size(options%overrides)))
      overrides(:) = options%overrides
      return
    end select
    allocate (character(len=max(len(tolerance), len(options%overrides))) :: overrides(size(options%overrides) + 1))
    overrides(1) = tolerance
    do i = 1, size(options%overrides)
      overrides(i + 1) = options%overrides(i)
    end do
  end function with_accuracy

  !> Run a case or its ideal twin, and write BASE.csv and what belongs to it.
  subroutine run_one(case, ideal_joint, list, base, show_progress, line, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(column_list_t), intent(in) :: list
    character(len=*), intent(in) :: base
    logical, intent(in) :: show_progress
    character(len=:), allocatable, intent(inout) :: line
    type(error_t), allocatable, intent(out) :: error
    class(trace_sink_t), allocatable :: sink
    type(trace_files_t), allocatable :: files
    type(run_report_t) :: report
    type(error_t), allocatable :: output_error
    integer(int64) :: began, ended, rate
    real(dp) :: wall_time

    allocate (files)
    call files%open(base, list, case%contact%is_present .and. .not. ideal_joint, error)
    if (allocated(error)) return
    files%end_time = simulated_time(case)
    call files%progress%start(case%name, show_progress)
    call system_clock(began, rate)
    call move_alloc(files, sink)
    call simulate(case, ideal_joint, list, sink, report, error)
    call system_clock(ended)
    wall_time = real(ended - began, dp)/real(rate, dp)
    select type (sink)
    type is (trace_files_t)
      call sink%close(output_error)
    end select
    if (allocated(output_error)) then
      report%status = 'stopped: '//output_error%message
    else if (.not. ideal_joint) then
      line = summary_line(case, report, wall_time, base)
    end if
    if (.not. ideal_joint .and. .not. allocated(output_error)) &
      call write_text(base//'.summary.csv', summary_table(case, report, wall_time), output_error)
    if (allocated(error)) call name_file(case%file, error)
    if (allocated(output_error)) call move_alloc(output_error, error)
  end subroutine run_one

  !> A small file, written whole or not at all.
  subroutine write_text(path, text, error)
    character(len=*), intent(in) :: path, text
    type(error_t), allocatable, intent(out) :: error
    type(result_file_t) :: file
    call file%open(path, error)
    if (allocated(error)) return
    call file%put(text)
    call file%close(error)
  end subroutine write_text

  !> Put the case file's name before an error that does not have it.
  subroutine name_file(path, error)
    character(len=*), intent(in) :: path
    type(error_t), intent(inout) :: error
    error%message = printable(path, 200)//': '//error%message
  end subroutine name_file
end module case_runner
