!> The data of one process that carries out runs of a study one after the other. Everything is allocated once; a run allocates only
!> what the simulation itself needs.
module study_worker
  use error_handling, only: error_t
  use run_state, only: run_state_t
  use constants, only: degree
  use trace_columns, only: column_list_t, all_columns, choose_columns
  use cycle_watch, only: cycle_watch_t
  use study_statistics, only: statistic_t, keep_statistics, of_history
  use film_files, only: provide_tables
  use history_files, only: march_histories
  use posix_files, only: interrupted
  use simulation, only: run_t, run_report_t
  use whole_run, only: go_to_end
  use trace_sink, only: trace_sink_t
  use trace_files, only: trace_files_t
  use study_definition, only: study_t
  use study_design, only: study_design_t
  use study_case, only: study_case_t
  use case_notes, only: count_lines
  use result_notes, only: notes_on_results
  use study_rows, only: study_row_t, add_run, add_cycles, add_strobes
  implicit none
  private
  public :: study_worker_t

  type :: study_worker_t
    type(study_row_t) :: run_row, cycle_rows, strobe_rows  !! rows of the last run
    logical :: is_done = .false.                           !! the last run reached its end
    integer :: notes = 0                                   !! number of notes on values and results of the last run
    logical :: was_interrupted = .false.                   !! the last run was abandoned, and has no row
    type(error_t), allocatable :: output_error             !! reason why its trace could not be written
    type(study_case_t), private :: base
    logical, private :: follows = .false.                  !! each run starts from the end of the one before it
    type(run_state_t), allocatable, private :: previous    !! that end
    type(cycle_watch_t), allocatable, private :: watch
    type(column_list_t), private :: no_columns
    character(len=:), allocatable, private :: values(:)
    character(len=:), allocatable, private :: trace_folder
    logical, private :: traces_all = .false., traces_failed = .false.
  contains
    procedure :: prepare
    procedure :: run
  end type study_worker_t

contains

  !> Prepare a worker. `strobe_list` has no columns if there are no strobes; traces are written into `trace_folder`.
  subroutine prepare(self, study, design, base, strobe_list, statistics, trace_folder)
    class(study_worker_t), intent(inout) :: self
    type(study_t), intent(in) :: study
    type(study_design_t), intent(in) :: design
    type(study_case_t), intent(in) :: base
    type(column_list_t), intent(in) :: strobe_list
    type(statistic_t), intent(in) :: statistics(:)
    character(len=*), intent(in) :: trace_folder
    self%base = base
    call self%run_row%choose(design%keys, base%case, size(strobe_list%id) > 0)
    self%run_row%statistics = statistics
    call self%run_row%numbers%prepare(base%case%output%digits)
    self%cycle_rows = self%run_row
    self%strobe_rows = self%run_row
    self%trace_folder = trace_folder
    self%follows = study%start == 'previous'
    self%traces_all = study%traces == 'all'
    self%traces_failed = study%traces == 'failed'
    allocate (self%watch)
    self%watch%settle = study%settle_cycles
    self%watch%keeps_cycles = study%cycles
    self%watch%strobe_list = strobe_list
    self%watch%wants_answers = any(statistics%what == 0)
    self%watch%strobe_angle = study%strobe_angle_deg*degree
    self%watch%most_strobes = study%strobe_cycles
    allocate (self%no_columns%id(0))
    allocate (character(len=design%text_length) :: self%values(size(design%keys)))
  end subroutine prepare

  !> Carry out one run; its rows are stored in the worker.
  subroutine run(self, design, number)
    class(study_worker_t), intent(inout) :: self
    type(study_design_t), intent(in) :: design
    integer, intent(in) :: number
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    type(trace_sink_t) :: nowhere
    character(len=:), allocatable :: outcome
    logical :: has_begun

    self%is_done = .false.
    self%was_interrupted = .false.
    has_begun = .false.
    call design%get_values(number, self%values)
    call self%base%remove_units(self%values)
    call self%base%set_values(self%values, error)
    if (.not. allocated(error)) call self%base%check(error)
    if (.not. allocated(error)) then
      has_begun = .true.
      call provide_tables(self%base%case, .false., .false., error)
      self%was_interrupted = allocated(error)
      if (self%was_interrupted) return
      if (self%traces_all) then
        call run_with_trace(self, number, report, error)
      else
        call carry_out(self, self%no_columns, nowhere, report, error)
        if (allocated(error) .and. self%traces_failed .and. .not. self%was_interrupted) &
          call run_with_trace(self, number, report, error)
      end if
    end if
    if (self%was_interrupted .or. allocated(self%output_error)) return
    call self%cycle_rows%clear()
    call self%strobe_rows%clear()
    outcome = 'done'
    if (allocated(error)) then
      outcome = reason_of(error%message)
    else if (self%watch%statistics%cycles == 0) then
      outcome = 'no whole revolution after settle_cycles'
    end if
    self%is_done = outcome == 'done'
    self%notes = 0
    if (has_begun) then
      self%notes = count_lines(notes_on_results(self%base%case, report))
      if (allocated(self%base%case%notes)) self%notes = self%notes + count_lines(self%base%case%notes)
    end if
    call add_run(self%run_row, number, self%values, outcome, has_begun, self%notes, self%watch, report, self%base%case)
    if (.not. self%is_done) return
    if (self%watch%keeps_cycles) call add_cycles(self%cycle_rows, number, self%watch, self%base%case)
    call add_strobes(self%strobe_rows, number, self%watch)
  end subroutine run

  !> Carry out the run whose values have been set. If the user interrupts it, it is abandoned.
  subroutine carry_out(self, list, sink, report, error)
    class(study_worker_t), intent(inout) :: self
    type(column_list_t), intent(in) :: list
    class(trace_sink_t), target, intent(inout) :: sink
    type(run_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(run_t) :: run
    type(column_list_t) :: followed
    if (allocated(self%previous)) then
      self%base%case%initial%state = self%previous
      self%base%case%initial%goes_on = .false.
    end if
    followed = list
    if (size(self%run_row%statistics) > 0) then
      if (.not. allocated(list%names)) call all_columns(self%base%case, .false., followed)
      call keep_statistics(self%run_row%statistics, followed)
    end if
    call run%begin(self%base%case, .false., followed, sink, error, self%watch)
    if (allocated(error)) return
    call go_to_end(run, self%was_interrupted)
    call run%finish(report, error, self%watch)
    if (.not. allocated(error) .and. any(of_history(self%run_row%statistics%of))) then
      call march_histories(self%base%case, .false., report, error)
      if (allocated(error)) self%was_interrupted = interrupted()
    end if
    if (.not. self%follows .or. allocated(error)) return
    if (.not. allocated(self%previous)) allocate (self%previous)
    call run%state(self%previous)
    self%previous%file = 'the run before'
  end subroutine carry_out

  !> Carry out the run whose values have been set, with a trace NAME/RUN.csv and its events.
  subroutine run_with_trace(self, number, report, error)
    class(study_worker_t), intent(inout) :: self
    integer, intent(in) :: number
    type(run_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(trace_files_t) :: files
    type(column_list_t) :: list
    character(len=12) :: name
    write (name, '(i0)') number
    call choose_columns(self%base%case, .false., list, error)
    if (.not. allocated(error)) call files%open(self%trace_folder//'/'//trim(name), list, self%base%case%output%digits, &
      self%base%case%has_contact(), self%output_error)
    if (allocated(error) .or. allocated(self%output_error)) return
    call carry_out(self, list, files, report, error)
    call files%file%synchronise()   ! before the row that reports the run as done
    call files%close(self%output_error)
  end subroutine run_with_trace

  !> A message without the file name before its group.
  pure function reason_of(message) result(reason)
    character(len=*), intent(in) :: message
    character(len=len(message)) :: reason
    reason = message
    if (index(message, ': &') > 0) reason = message(index(message, ': &') + 2:)
  end function reason_of
end module study_worker
