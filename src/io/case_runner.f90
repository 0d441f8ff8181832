!> Runs a case from its file to its results: the scene and, if requested, its ideal twin.
module case_runner
  use gudgeon_errors, only: error_t, fail, keep_first, status_command_line, status_output, status_integration
  use case_definition, only: case_t
  use accuracy_presets, only: with_preset
  use case_file, only: read_case_values, complete_case
  use case_text, only: resolved_text
  use case_values, only: case_values_t
  use case_rules, only: case_warning
  use command_line, only: command_line_t
  use gudgeon_columns, only: column_list_t, choose_columns
  use gudgeon_scene, only: scene_t
  use scene_builder, only: build_scene
  use case_run, only: case_run_t, name_file
  use result_file, only: result_file_t, fail_with_file
  use run_identity, only: identity_length, identity_of
  use case_lock, only: case_lock_t
  use gudgeon_posix, only: absolute_path, make_directory, synchronise_folder, file_length, interrupted, error_text
  use gudgeon_progress, only: tell
  use measured_curve, only: measured_curve_t
  use text_tools, only: printable
  implicit none
  private
  public :: case_job_t, tell_warning

  !> A case. After `prepare` its two runs may be carried out by any threads, in any order.
  type :: case_job_t
    type(error_t), allocatable :: error               !! error in the case or in the folder of its results
    type(case_run_t) :: run, twin
    character(len=:), allocatable, private :: path    !! path of the case file
    logical :: has_twin = .false.                     !! the ideal twin is run too
    logical, private :: has_place = .false.           !! the folder of the results has been prepared, or an error was reported
    integer, private :: to_come = 2                   !! number of runs that have not ended
    type(case_lock_t), private :: lock
    type(result_file_t), private :: resolved          !! file of the resolved case
    logical, private :: has_removed = .false.         !! earlier results were removed
  contains
    procedure :: prepare
    procedure :: go
    procedure :: tell_outcome
  end type case_job_t

contains

  !> Read and check a case. Messages of errors begin with the name of the case file; no file is written for a case with an error.
  subroutine prepare(self, path, options, program, show_progress)
    class(case_job_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    character(len=identity_length), intent(in) :: program   !! identity of the running program
    logical, intent(in) :: show_progress
    type(case_values_t) :: values
    type(case_t) :: case
    type(column_list_t) :: list, ideal_list
    type(scene_t), allocatable :: scene
    character(len=:), allocatable :: base, text
    character(len=identity_length) :: identity

    self%path = path
    if (interrupted()) then
      call not_begun(path, '', self%error)
      return
    end if
    call read_case_values(path, with_preset(options%accuracy, options%overrides), values, self%error)
    if (.not. allocated(self%error)) call complete_case(values, path, case, self%error)
    if (allocated(self%error)) return
    call choose_columns(case, .false., list, self%error)
    if (.not. allocated(self%error)) call choose_columns(case, .true., ideal_list, self%error)
    if (.not. allocated(self%error)) call build_scene(case, .false., scene, self%error, without_tables=.true.)
    if (allocated(self%error)) then
      call name_file(path, self%error)
      return
    end if
    if (.not. options%quiet) call tell_warning(case)
    base = options%out//'/'//case%name
    call keep_tables(case, base, self%error)
    if (allocated(self%error)) return
    text = resolved_text(values)
    self%has_twin = case%output%ideal_twin .and. (case%has_clearance() .or. case%is_elastic())
    identity = identity_of(text, program)
    call self%run%prepare(case, text, identity, .false., list, base, options, show_progress)
    self%twin%base = base//'.ideal'
    if (self%has_twin) call self%twin%prepare(case, text, identity_of('ideal twin', identity), .true., ideal_list, self%twin%base, &
      options, show_progress .and. options%jobs == 1)
  end subroutine prepare

  !> Check that the results do not replace a table that the case reads, such as motor.csv beside motor.nml.
  subroutine keep_tables(case, base, error)
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: base
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: suffixes(*) = [character(len=18) :: '.csv', '.events.csv', '.film.csv', '.wear.csv', &
      '.summary.csv', '.certificate.csv', '.ideal.csv', '.ideal.summary.csv', '.ideal.events.csv']
    character(len=:), allocatable :: written
    integer :: i
    do i = 1, size(suffixes)
      written = absolute_path(base//trim(suffixes(i)))
      call refuse_table('&drive torque_table', case%drive%table)
      if (.not. allocated(error) .and. allocated(case%measured)) call refuse_table('&cylinder_pressure table', case%measured%curve)
      if (allocated(error)) return
    end do

  contains

    subroutine refuse_table(key, table)
      character(len=*), intent(in) :: key
      type(measured_curve_t), intent(in) :: table
      if (.not. allocated(table%path)) return
      if (table%path == written) call fail(error, printable(case%file, 200)//': '//key//': '//printable(base, 200)// &
        trim(suffixes(i))//' would be replaced by the results: give another folder with --out, or the table another name', &
        status_command_line)
    end subroutine refuse_table
  end subroutine keep_tables

  !> Warn about values of a case that are valid but have no effect.
  subroutine tell_warning(case)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: warning
    warning = case_warning(case)
    if (warning /= '') call tell(printable(case%file, 200)//': '//warning)
  end subroutine tell_warning

  !> Carry out one of the two runs. The first to begin prepares the folder for both, the last one releases it.
  subroutine go(self, is_twin, options, is_last)
    class(case_job_t), intent(inout) :: self
    logical, intent(in) :: is_twin
    type(command_line_t), intent(in) :: options
    logical, intent(out) :: is_last   !! both runs have ended
    logical :: may_go, is_first, is_over
    integer :: left

    !$omp critical (texts)
    is_over = interrupted()
    if (is_over .and. .not. (allocated(self%error) .or. allocated(self%run%error))) then
      if (is_twin .and. self%has_twin) call not_begun(self%path, 'ideal twin: ', self%twin%error)
      if (.not. is_twin) call not_begun(self%path, '', self%run%error)
    end if
    may_go = .not. (allocated(self%error) .or. is_over) .and. (self%has_twin .or. .not. is_twin)
    is_first = may_go .and. .not. self%has_place
    if (is_first) call take_place(self, options)
    !$omp end critical (texts)
    if (is_first) call secure_place(self, may_go)
    if (may_go .and. is_twin) then
      call self%twin%go()
    else if (may_go) then
      call self%run%go()
    end if
    !$omp atomic capture
    self%to_come = self%to_come - 1
    left = self%to_come
    !$omp end atomic
    is_last = left == 0
    if (is_last) call self%lock%release()
  end subroutine go

  !> The error of a run that was interrupted before it began.
  subroutine not_begun(path, what, error)
    character(len=*), intent(in) :: path, what
    type(error_t), allocatable, intent(out) :: error
    call fail(error, printable(path, 200)//': '//what//'interrupted before it began', status_integration)
  end subroutine not_begun

  !> Make the folder for the results, lock the results, look for results that can be continued, remove those of other runs, and
  !> begin the file of the resolved case, unless the run continues.
  subroutine take_place(self, options)
    class(case_job_t), intent(inout) :: self
    type(command_line_t), intent(in) :: options
    integer :: status

    self%has_place = .true.
    call make_directory(options%out, status)
    if (status /= 0) then
      call fail_with_file(options%out, status, self%error)
    else
      call self%lock%take(self%run%base, self%error)
    end if
    if (options%resume .and. .not. allocated(self%error)) then
      call self%run%look_for_earlier(self%error)
      if (self%has_twin .and. .not. allocated(self%error)) call self%twin%look_for_earlier(self%error)
      if (.not. (allocated(self%error) .or. self%run%start%is_done .or. self%run%start%goes_on .or. options%quiet)) call tell( &
        printable(self%path, 200)//': no checkpoint in '//printable(options%out, 200)//': starts from the beginning')
    end if
    if (.not. allocated(self%error)) call make_room(self)
    if (allocated(self%error) .or. self%run%start%is_done .or. self%run%start%goes_on) return
    call self%resolved%open(self%run%base//'.resolved.nml', self%error, whole_only=.true.)
    call self%resolved%put(self%run%start%checkpoint%case_text)
  end subroutine take_place

  !> Wait until the changes of `take_place` are on the disk. (Other threads may use text functions meanwhile.)
  subroutine secure_place(self, is_secure)
    class(case_job_t), intent(inout) :: self
    logical, intent(out) :: is_secure
    integer :: ignored
    if (self%has_removed) call synchronise_folder(self%run%base, ignored)
    call self%resolved%synchronise()
    call self%resolved%conclude()
    !$omp critical (texts)
    if (self%resolved%has_failed()) call self%resolved%tell_error(self%error)
    is_secure = .not. allocated(self%error)
    !$omp end critical (texts)
  end subroutine secure_place

  !> Remove the results of other runs. Files that mark results as complete or resumable are removed first, so that they never stand
  !> beside results of this run. Files with the names of a twin's results that have a resolved case of their own do not belong to a
  !> twin and are kept.
  subroutine make_room(self)
    class(case_job_t), intent(inout) :: self
    logical :: may_clear_twin
    integer :: status
    may_clear_twin = file_length(self%twin%base//'.resolved.nml') < 0
    if (self%has_twin) may_clear_twin = .true.
    status = 0
    call self%run%disown(self%has_removed, status)
    if (may_clear_twin) call self%twin%disown(self%has_removed, status)
    if (status == 0) call self%run%clear(self%has_removed, status)
    if (status == 0 .and. may_clear_twin) call self%twin%clear(self%has_removed, status)
    if (status /= 0) call fail(self%error, printable(self%run%base, 200)//': earlier results cannot be removed: '// &
                               error_text(status), status_output)
  end subroutine make_room

  !> After both runs, or after a check: the texts for the user, or the first error.
  subroutine tell_outcome(self, line, notice, error)
    class(case_job_t), intent(inout) :: self
    character(len=:), allocatable, intent(out) :: line, notice
    type(error_t), allocatable, intent(out) :: error
    call keep_first(self%error, error)
    call keep_first(self%run%error, error)
    call keep_first(self%twin%error, error)
    if (allocated(error)) return
    line = self%run%line
    notice = self%run%notice
  end subroutine tell_outcome
end module case_runner
