!> One run of a case with its result files: of the scene itself, or of its ideal twin.
module case_run
  use kinds, only: dp
  use error_handling, only: error_t, fail, keep_first, status_output
  use case_definition, only: case_t
  use command_line, only: command_line_t
  use trace_columns, only: column_list_t
  use history_files, only: march_histories
  use report_files, only: result_suffixes, write_report_files
  use simulation, only: run_t, run_report_t
  use run_state, only: run_state_t
  use state_file, only: write_state, state_suffix, reached
  use whole_run, only: go_on
  use trace_files, only: trace_files_t
  use result_file, only: result_file_t, remove_result, write_text
  use certificate, only: certificate_t, make_certificate, certificate_table, certificate_summary, certificate_clause
  use run_summary, only: summary_table
  use run_line, only: lines_for_user
  use run_progress, only: progress_t, clock, tell
  use text_file, only: read_whole
  use posix_files, only: synchronise_folder, file_length, absolute_path, error_text
  use text_tools, only: printable, replaced
  implicit none
  private
  public :: case_run_t, name_file

  character(len=*), parameter :: newline = achar(10)
  real(dp), parameter :: between_states = 60       !! [s] of the clock, between two files of the state
  integer, parameter :: room_for_summary = 12288   !! [bytes], twice the length of the longest summaries

  !> A run. Call `prepare` first, then `go`. Its files are BASE.csv, with contacts BASE.events.csv, and BASE.summary.csv. Errors are
  !> collected in `error`.
  type :: case_run_t
    type(error_t), allocatable :: error
    character(len=:), allocatable :: line                !! the outcome, for the user
    character(len=:), allocatable :: base                !! path of the results without suffix
    type(case_t) :: case
    character(len=:), allocatable, private :: case_text  !! the resolved case
    logical, private :: certifies = .false.              !! make a certificate if the run is completed
    type(certificate_t), allocatable, private :: certificate
    logical, private :: is_twin = .false.                !! this is the run of the ideal twin
    type(column_list_t), private :: list
    logical, private :: shows_progress = .false., is_quiet = .false.
    type(progress_t), private :: progress
    real(dp), private :: began = 0                       !! time of `clock` [s]
    type(result_file_t), private :: summary
    type(run_report_t), private :: report
  contains
    procedure :: prepare
    procedure :: go
  end type case_run_t

contains

  !> Set what is to be run, and where its results are written.
  subroutine prepare(self, case, case_text, is_twin, list, base, options, shows_progress)
    class(case_run_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: case_text            !! the resolved case
    logical, intent(in) :: is_twin
    type(column_list_t), intent(in) :: list
    character(len=*), intent(in) :: base
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: shows_progress
    self%case = case
    self%case_text = case_text
    self%is_twin = is_twin
    self%list = list
    self%base = base
    self%shows_progress = shows_progress
    self%is_quiet = options%quiet
    self%certifies = options%certify .and. .not. is_twin
  end subroutine prepare

  !> Integrate, and write the results and the summary to the disk. The order is such that incomplete results never have their final
  !> names without a summary that says so, whatever happens. The temporary file of the summary also keeps a second run from writing
  !> the same results.
  subroutine go(self)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t) :: files
    self%began = clock()
    call self%summary%open(self%base//'.summary.csv', self%error, whole_only=.true.)
    if (.not. allocated(self%error)) call self%summary%reserve(room_for_summary, self%error)
    if (.not. allocated(self%error)) call remove_earlier(self)
    if (.not. (allocated(self%error) .or. self%is_twin)) call write_text(self%base//'.resolved.nml', self%case_text, self%error)
    if (.not. allocated(self%error)) &
      call files%open(self%base, self%list, self%case%output%digits, has_events(self), self%error)
    if (allocated(self%error)) then
      call self%summary%abandon()
      return
    end if
    call carry_out(self, files)
    if (self%certifies .and. self%report%status == 'done') then
      allocate (self%certificate)
      call make_certificate(self%case, self%report, .not. self%is_quiet, self%certificate, self%error)
      if (allocated(self%error)) self%certificate%reason = self%error%message
    end if
    call close_files(self, files)
  end subroutine go

  !> Remove earlier results of this name: first the summaries, so that they never stand beside new results. Files with the names of
  !> a twin's results that have a resolved case of their own do not belong to a twin and are kept.
  subroutine remove_earlier(self)
    class(case_run_t), intent(inout) :: self
    logical :: was_there, keeps_twin
    integer :: i, status, ignored
    if (.not. self%is_twin) call remove_state(self)
    was_there = .false.
    status = 0
    keeps_twin = file_length(self%base//'.ideal.resolved.nml') >= 0
    if (self%is_twin) keeps_twin = .true.
    do i = 1, size(result_suffixes)
      if (status /= 0 .or. keeps_twin .and. index(result_suffixes(i), '.ideal') == 1) cycle
      call remove_result(self%base//trim(result_suffixes(i)), was_there, status, keeps_part=i == 1)
      if (i == 2 .and. was_there) call synchronise_folder(self%base, ignored)
    end do
    if (status /= 0) call fail(self%error, printable(self%base, 200)//': earlier results cannot be removed: '// &
      error_text(status), status_output)
  end subroutine remove_earlier

  !> Remove the state of an earlier run of this name, unless this run starts from it. The user is told what is discarded if that run
  !> was stopped, or if this one goes on from it.
  subroutine remove_state(self)
    class(case_run_t), intent(in) :: self
    character(len=:), allocatable :: summary, path, what
    logical :: unused, starts_from_it
    integer :: status, ignored
    path = self%base//state_suffix
    starts_from_it = .false.
    if (allocated(self%case%initial%state)) starts_from_it = self%case%initial%state%file == absolute_path(path)
    call read_whole(self%base//'.summary.csv', summary, status)
    what = ''
    if (starts_from_it .and. status == 0) then
      what = 'replaces the results of the run from which it goes on; another folder with --out keeps both'
    else if (file_length(self%base//'.csv.part') >= 0 .or. status == 0 .and. index(summary, newline//'status,done,') == 0) then
      what = 'discards the results of an earlier run that was stopped'//reached(path)
    end if
    if (what /= '' .and. .not. self%is_quiet) call tell(printable(self%case%file, 200)//': '//what)
    status = 0
    if (.not. starts_from_it) call remove_result(path, unused, ignored, keeps_part=.false.)
  end subroutine remove_state

  !> Run the case to its end, unless the user interrupts or a file cannot be written.
  subroutine carry_out(self, files)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), target, intent(inout) :: files
    type(run_t) :: run
    type(error_t), allocatable :: state_error
    real(dp) :: now, last   !! of the last file of the state [s]
    integer :: steps
    logical :: was_interrupted
    call self%progress%start(self%case%name, self%shows_progress)
    call run%begin(self%case, self%is_twin, self%list, files, self%error)
    if (.not. allocated(self%error)) then
      last = self%began
      steps = 1
      do while (.not. run%is_over)
        call go_on(run, steps, was_interrupted)
        call self%progress%update(run%t/run%expected_end(), run%t)
        if (any(files%file%has_failed())) call run%stop()
        now = clock()
        if (now - last < between_states) cycle
        call keep_state(self, run, state_error)
        last = now
      end do
      call keep_state(self, run, state_error)
      call run%finish(self%report, self%error)
      if (.not. allocated(self%error)) call march_histories(self%case, self%shows_progress, self%report, self%error)
      if (allocated(state_error)) call move_alloc(state_error, self%error)
    end if
    call self%progress%finish()
    if (.not. allocated(self%report%status)) self%report%status = self%error%message
  end subroutine carry_out

  !> Write the state that the run has reached. The ideal twin has none: it starts as its case says.
  subroutine keep_state(self, run, error)
    class(case_run_t), intent(in) :: self
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(run_state_t) :: state
    if (self%is_twin) return
    call run%state(state)
    call write_state(state, self%case%file, self%base, error)
  end subroutine keep_state

  !> Close the files of a run that has ended. If the run is done, the trace gets its final name before the summary, which reports it
  !> as done. Otherwise the summary is written first; if that fails, the trace keeps its temporary name.
  subroutine close_files(self, files)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), intent(inout) :: files
    type(error_t), allocatable :: file_error
    logical :: is_whole
    integer :: folder_status
    call files%file%synchronise()
    is_whole = self%report%status == 'done'
    if (any(files%file%has_failed())) is_whole = .false.
    if (is_whole) call files%file%conclude()
    call write_report_files(self%base, self%case, self%report, file_error)
    call keep_first(file_error, self%error)
    call write_summary(self, files)
    call self%summary%synchronise()
    call self%summary%conclude()
    if (self%summary%has_failed()) call files%file%leave()   ! no effect on files that have their final names
    call files%file%conclude()
    call synchronise_folder(self%base, folder_status)
    call collect_errors(self, files, folder_status)
  end subroutine close_files

  !> Write the summary into its file, and its lines for the user into `line`.
  subroutine write_summary(self, files)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), intent(inout) :: files
    type(error_t), allocatable :: error
    type(case_t) :: case
    character(len=:), allocatable :: remark
    real(dp) :: wall_time   ! [s]
    call files%tell_error(error)
    if (allocated(error)) self%report%status = 'stopped: '//error%message
    case = self%case
    if (self%is_twin) call case%become_ideal()
    remark = ''
    if (allocated(self%certificate)) then
      if (.not. allocated(self%certificate%reason)) then
        call write_text(self%base//'.certificate.csv', certificate_table(self%certificate), error)
        call keep_first(error, self%error)
      end if
      remark = certificate_clause(self%certificate)
    end if
    wall_time = clock() - self%began
    self%line = lines_for_user(case, self%report, wall_time, self%base, remark)
    if (allocated(self%certificate)) then
      if (allocated(self%certificate%left_out)) self%line = self%line//newline//'  note: '//self%certificate%left_out
    end if
    call self%summary%append(summary_table(case, self%report, wall_time, self%is_twin))
    if (allocated(self%certificate)) call self%summary%append(certificate_summary(self%certificate))
  end subroutine write_summary

  !> Collect the errors of the run: an error of the output takes precedence over one of the integration.
  subroutine collect_errors(self, files, folder_status)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), intent(inout) :: files
    integer, intent(in) :: folder_status
    type(error_t), allocatable :: output_error, summary_error
    if (allocated(self%error)) then
      if (self%is_twin) self%error%message = 'ideal twin: '//self%error%message
      call name_file(self%case%file, self%error)
    end if
    call files%close(output_error)
    call self%summary%close(summary_error)
    call keep_first(summary_error, output_error)
    if (folder_status /= 0 .and. .not. allocated(output_error)) &
      call fail(output_error, printable(self%base, 200)//'.csv: '//error_text(folder_status), status_output)
    if (allocated(output_error)) call move_alloc(output_error, self%error)
  end subroutine collect_errors

  !> Whether the run writes a list of events.
  pure logical function has_events(self)
    class(case_run_t), intent(in) :: self
    has_events = self%case%has_contact() .and. .not. self%is_twin
  end function has_events

  !> Write the name of the case file in front of each line of an error message that does not contain it.
  subroutine name_file(path, error)
    character(len=*), intent(in) :: path
    type(error_t), intent(inout) :: error
    character(len=:), allocatable :: head
    head = printable(path, 200)//': '
    error%message = head//replaced(error%message, achar(10), achar(10)//head)
  end subroutine name_file
end module case_run
