!> A run that another program advances: with its rows and events in memory, and its summary.
module run_handle
  use kinds, only: dp
  use, intrinsic :: iso_fortran_env, only: int64
  use error_handling, only: error_t, fail, status_integration, status_output
  use case_definition, only: case_t
  use trace_columns, only: column_list_t, choose_columns
  use film_files, only: provide_tables, progress_watch_t
  use text_lock, only: lock_texts, unlock_texts
  use history_files, only: march_histories
  use report_files, only: write_report_files
  use result_file, only: write_text
  use trace_files, only: trace_files_t
  use simulation, only: run_t, run_report_t
  use scene_inputs, only: input_t, inputs
  use run_summary, only: summary_table
  use summary_rows, only: summary_row_t, read_rows
  use certificate, only: certificate_t, make_certificate, certificate_summary, certificate_table
  use run_progress, only: clock
  use row_store, only: row_store_t
  use run_state, only: run_state_t
  use state_file, only: write_state
  use case_handle, only: case_handle_t
  use c_texts, only: handle_t
  implicit none
  private
  public :: run_handle_t, begin_run, copy_run

  type, extends(handle_t) :: run_handle_t
    type(run_t) :: run
    type(row_store_t) :: rows
    type(column_list_t) :: list
    character(len=:), allocatable :: table           !! NAME.summary.csv; allocated when the run is finished
    type(summary_row_t), allocatable :: summary(:)   !! its rows, once `read_summary` has read them
    integer :: status = 0                            !! of the finished run
    real(dp), allocatable :: now(:)                  !! all columns at the time `seen`
    real(dp) :: seen = -huge(1.0_dp)                 !! [s]
    integer(int64) :: origin = 0                     !! checksum of the case: states of equal cases may replace each other
    type(case_t), private :: case
    logical, private :: is_twin = .false.
    real(dp), private :: began = 0                   !! time of `clock` [s]
    type(run_report_t), private :: report
    character(len=:), allocatable, private :: certificate_table   !! NAME.certificate.csv
  contains
    procedure :: advance
    procedure :: advance_to_event
    procedure :: look
    procedure :: set_input
    procedure :: finish
    procedure :: read_summary
    procedure :: certify
    procedure :: save
    procedure :: state
    procedure :: has_events
  end type run_handle_t

  !> While a table of a film is computed, other threads may work with texts.
  type, extends(progress_watch_t) :: unlocked_t
  contains
    procedure :: begins => leave_texts
    procedure :: ends => take_texts
  end type unlocked_t

contains

  subroutine leave_texts(self)
    class(unlocked_t), intent(inout) :: self
    call unlock_texts()
  end subroutine leave_texts

  subroutine take_texts(self)
    class(unlocked_t), intent(inout) :: self
    call lock_texts()
  end subroutine take_texts

  !> Begin the run of a case, which ends at a time [s], or as its case says if that is not above 0. Error: a time that is not a
  !> finite number, a wrong case, or one whose scene cannot be built; the handle of the case keeps the message.
  subroutine begin_run(of, is_twin, end_time, without_rows, new, status)
    type(case_handle_t), intent(inout) :: of
    logical, intent(in) :: is_twin
    real(dp), intent(in) :: end_time
    logical, intent(in) :: without_rows    !! values are asked for at pauses, and no rows are kept
    type(run_handle_t), pointer, intent(out) :: new
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    nullify (new)
    if (.not. abs(end_time) <= huge(end_time)) then
      call of%refuse('the end of a run must be a finite number', status)
      return
    end if
    call of%check(status)
    if (status /= 0) return
    allocate (new)
    new%began = clock()
    new%is_twin = is_twin
    new%case = of%case
    if (allocated(of%start)) then
      new%case%initial%state = of%start
      new%case%initial%goes_on = .false.
    end if
    new%list = of%list
    new%origin = of%fingerprint()
    if (is_twin) new%origin = not(new%origin)
    if (end_time > 0) then
      new%case%integrator%revolutions = 0
      new%case%integrator%crank_revolutions = 0
      new%case%integrator%end_time = end_time
      if (new%case%run%is_until_periodic()) new%case%run%until = 'end'
    end if
    if (without_rows) new%case%output%start_time = huge(1.0_dp)
    if (is_twin .and. size(of%list%id) > 0) call choose_columns(of%case, .true., new%list, error)
    if (.not. allocated(error)) call provide_tables(new%case, .false., .false., error, unlocked_t())
    if (.not. allocated(error)) call new%run%begin(new%case, is_twin, new%list, new%rows, error)
    call of%keep(error, status)
    if (status == 0) then
      allocate (new%now(size(new%list%id)))
    else
      deallocate (new)
    end if
  end subroutine begin_run

  !> Make a run a copy of another one; both then go on independently of each other.
  subroutine copy_run(from, to)
    type(run_handle_t), intent(in) :: from
    type(run_handle_t), target, intent(inout) :: to
    to = from
    to%run%recorder%sink => to%rows
  end subroutine copy_run

  !> The state that the run has reached, also inside a step, from which others may start.
  subroutine state(self, list)
    class(run_handle_t), intent(inout) :: self
    type(run_state_t), intent(out) :: list
    type(run_handle_t), allocatable, target :: ended
    if (self%run%is_over) then
      call self%run%state(list)
    else
      allocate (ended)
      call copy_run(self, ended)
      call ended%run%stop()
      call ended%run%state(list)
    end if
  end subroutine state

  !> Go on to a time [s], or through a number of steps (0: no limit). `status` is -1 at a pause, 0 at the end of the run, 4 if it
  !> cannot go on. No function with a result of deferred length is called.
  subroutine advance(self, to, most_steps, status)
    class(run_handle_t), intent(inout) :: self
    real(dp), intent(in) :: to
    integer, intent(in) :: most_steps
    integer, intent(out) :: status
    if (.not. (self%run%is_over .or. allocated(self%table))) call self%run%advance(max(to, self%run%t), most_steps)
    self%seen = -huge(1.0_dp)
    status = -1
    if (self%run%is_over) status = merge(0, status_integration, self%run%is_complete())
    if (status == status_integration) self%message = 'the integration cannot go on; finish the run for the reason'
  end subroutine advance

  !> Go on to a time [s], or until a contact begins or ends, if that comes first.
  subroutine advance_to_event(self, to, status)
    class(run_handle_t), intent(inout) :: self
    real(dp), intent(in) :: to
    integer, intent(out) :: status   !! see `advance`
    integer :: events
    events = self%rows%events
    do
      call self%advance(to, 1, status)
      if (status /= -1 .or. self%rows%events > events .or. .not. self%run%t < to) exit
    end do
  end subroutine advance_to_event

  !> Evaluate all columns at the present time, once for each time. Error: the state is outside the model.
  subroutine look(self, status)
    class(run_handle_t), intent(inout) :: self
    integer, intent(out) :: status
    logical :: in_domain
    status = 0
    if (.not. abs(self%seen - self%run%t) > 0) return
    call self%run%evaluate_row(self%now, in_domain)
    if (in_domain) self%seen = self%run%t
    if (in_domain) return
    self%message = 'the state is outside the model'
    status = status_integration
  end subroutine look

  !> Set an input of the run.
  subroutine set_input(self, i, value)
    class(run_handle_t), intent(inout) :: self
    integer, intent(in) :: i
    real(dp), intent(in) :: value
    call self%run%set_input(i, value)
  end subroutine set_input

  !> End the run here, unless it has reached its end, and make its summary.
  subroutine finish(self, status)
    class(run_handle_t), intent(inout) :: self
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    type(case_t) :: case
    if (.not. allocated(self%table)) then
      call self%run%finish(self%report, error)
      if (.not. allocated(error)) call march_histories(self%case, .false., self%report, error)
      case = self%case
      if (self%is_twin) call case%become_ideal()
      self%table = summary_table(case, self%report, clock() - self%began, self%is_twin)
      call self%keep(error, self%status)
    end if
    status = self%status
  end subroutine finish

  !> Read the rows of the summary of a finished run, unless that has been done.
  subroutine read_summary(self)
    class(run_handle_t), intent(inout) :: self
    if (allocated(self%table) .and. .not. allocated(self%summary)) call read_rows(self%table, self%summary)
  end subroutine read_summary

  !> Estimate the accuracy of a finished run, as --certify does; the summary has its rows afterwards. Error: the run is not done.
  subroutine certify(self, status)
    class(run_handle_t), intent(inout) :: self
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    type(certificate_t) :: certificate
    if (.not. allocated(self%table) .or. self%is_twin .or. allocated(self%certificate_table)) then
      call self%refuse('only a finished run can be certified, once', status)
      return
    end if
    status = self%status
    if (status /= 0) return
    call make_certificate(self%case, self%report, .false., certificate, error)
    if (allocated(error)) certificate%reason = error%message
    self%certificate_table = ''
    if (.not. allocated(certificate%reason)) self%certificate_table = certificate_table(certificate)
    self%table = self%table//certificate_summary(certificate)
    if (allocated(self%summary)) deallocate (self%summary)
    call self%keep(error, status)
  end subroutine certify

  !> Whether the command line would write a list of events.
  pure logical function has_events(self)
    class(run_handle_t), intent(in) :: self
    has_events = self%case%has_contact() .and. .not. self%is_twin
  end function has_events

  !> Write the files of the command line for a finished run, except those of its case: PATH.csv, PATH.state.nml, ...
  !> Error: a file cannot be written.
  subroutine save(self, path, status)
    class(run_handle_t), intent(inout) :: self
    character(len=*), intent(in) :: path   !! folder and name
    integer, intent(out) :: status
    type(trace_files_t) :: files
    type(error_t), allocatable :: error
    type(run_state_t) :: state
    integer :: i
    if (.not. allocated(self%table)) then
      call self%refuse('only a finished run can be saved', status)
      return
    else if (path == '') then
      self%message = 'a path is needed to save a run'
      status = status_output
      return
    end if
    call files%open(path, self%list, self%case%output%digits, self%has_events(), error)
    if (.not. allocated(error)) then
      do i = 1, self%rows%rows
        call files%accept_row(self%rows%values(:, i))
      end do
      do i = 1, self%rows%events
        call files%accept_event(self%rows%event(i))
      end do
      call files%file%conclude()
      call files%close(error)
    end if
    if (.not. allocated(error)) call write_report_files(path, self%case, self%report, error)
    if (.not. (allocated(error) .or. self%is_twin)) then
      call self%run%state(state)
      call write_state(state, self%case%file, path, error)
    end if
    if (.not. allocated(error) .and. allocated(self%certificate_table)) then
      if (self%certificate_table /= '') call write_text(path//'.certificate.csv', self%certificate_table, error)
    end if
    if (.not. allocated(error)) call write_text(path//'.summary.csv', self%table, error)
    call self%keep(error, status)
  end subroutine save
end module run_handle
