!> One run of a case with its result files: of the scene itself, or of its ideal twin.
module case_run
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_funloc, c_funptr, c_loc, c_null_ptr, c_ptr
  use errors, only: error_t
  use case_definition, only: case_t
  use columns, only: column_list_t
  use scene_builder, only: simulated_time
  use simulation, only: simulate, run_report_t, interrupted_text
  use trace_sink, only: trace_sink_t
  use trace_files, only: trace_files_t
  use result_file, only: write_text
  use continuation, only: continuation_t
  use archive, only: archive_t
  use summary, only: summary_table, summary_line
  use stability_advice, only: advice
  use text_tools, only: printable
  use row_queue, only: row_queue_t
  use thread, only: thread_t
  implicit none
  private
  public :: case_run_t, go_beside, name_file

  !> A run is prepared, goes, alone or beside others, and is finished or given up. What goes wrong on the way is in `error`.
  type :: case_run_t
    type(error_t), allocatable :: error
    type(case_t), private :: case
    logical, private :: is_twin = .false.                !! the run of the ideal twin
    type(continuation_t), private :: start               !! where it begins: a twin always at its beginning
    type(column_list_t), private :: list
    character(len=:), allocatable, private :: base       !! path of the results without their endings
    logical, private :: show_progress = .false., quiet = .false.
    integer, private :: takers = 0                       !! who have come to let it go: only the first does
    type(thread_t), private :: thread                    !! in which it goes, if no other has taken it
    logical, private :: is_kept = .false.                !! what it has written there is to stay
    type(row_queue_t), pointer, private :: queue => null()   !! from a run to the thread of the one beside it
    class(trace_sink_t), allocatable, private :: sink    !! while the files are open
    type(run_report_t), private :: report
  contains
    procedure :: prepare
    procedure :: go
    procedure :: let_end
    procedure :: finish
    procedure :: give_up
    procedure :: was_interrupted
  end type case_run_t

contains

  !> What is to be run, and where its results go.
  subroutine prepare(self, case, is_twin, start, list, base, show_progress, quiet)
    class(case_run_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    logical, intent(in) :: is_twin
    type(continuation_t), intent(in) :: start
    type(column_list_t), intent(in) :: list
    character(len=*), intent(in) :: base
    logical, intent(in) :: show_progress, quiet
    self%case = case
    self%is_twin = is_twin
    if (.not. is_twin) self%start = start
    self%list = list
    self%base = base
    self%show_progress = show_progress
    self%quiet = quiet
  end subroutine prepare

  !> Let a run go in a thread of its own, where the system gives one, beside another one that is still to go. When it has come
  !> to its end it writes rows for the other, and waits with the last names of its files, until `let_end`. It must stay
  !> where it is until it is finished or given up, and so must the other and the queue between them.
  subroutine go_beside(run, other, queue)
    type(case_run_t), intent(inout), target :: run
    type(case_run_t), intent(inout) :: other
    type(row_queue_t), intent(inout), target :: queue
    type(c_funptr) :: routine
    logical :: has_started
    call queue%begin()
    run%queue => queue
    routine = c_funloc(run_in_thread)   ! gfortran 12.2, optimising across modules, loses it where it is not a variable
    call run%thread%start(routine, c_loc(run), has_started)
    if (has_started) then
      other%queue => queue
    else
      run%queue => null()
    end if
  end subroutine go_beside

  !> What the thread does.
  function run_in_thread(argument) bind(c, name='gudgeon_run_in_thread') result(nothing)
    type(c_ptr), value :: argument
    type(c_ptr) :: nothing
    type(case_run_t), pointer :: run
    logical :: is_mine
    call c_f_pointer(argument, run)
    call take(run, is_mine)
    if (is_mine) call integrate_into_files(run)
    call run%queue%serve()
    if (is_mine .and. run%is_kept) call conclude_files(run)
    nothing = c_null_ptr
  end function run_in_thread

  !> Whether this thread is to let the run go.
  subroutine take(run, is_mine)
    type(case_run_t), intent(inout) :: run
    logical, intent(out) :: is_mine
    integer :: earlier
    !$omp atomic capture
    earlier = run%takers
    run%takers = run%takers + 1
    !$omp end atomic
    is_mine = earlier == 0
  end subroutine take

  !> Integrate into BASE.csv and events, or BASE.ideal.csv; of a run that goes in a thread wait for the end. (The system may
  !> start a thread so late that the run is taken before.)
  subroutine go(self)
    class(case_run_t), intent(inout) :: self
    logical :: is_mine
    call take(self, is_mine)
    if (is_mine) call integrate_into_files(self)
    call self%thread%join()
  end subroutine go

  !> The other one has come to its end, too: of a run that goes in a thread beside it. Afterwards all rows of the other are
  !> written; the files of this one get their last names in its own time, if they are to be kept.
  subroutine let_end(self, is_kept)
    class(case_run_t), intent(inout) :: self
    logical, intent(in) :: is_kept
    if (.not. associated(self%queue)) return
    self%is_kept = is_kept
    call self%queue%end()
  end subroutine let_end

  subroutine integrate_into_files(self)
    class(case_run_t), intent(inout) :: self
    type(archive_t) :: archive
    !$omp critical (texts)
    call open_files(self)
    !$omp end critical (texts)
    if (.not. allocated(self%sink)) return
    if (self%start%goes_on) then
      call archive%begin_reading(self%start%checkpoint%state)
      call simulate(self%case, self%is_twin, self%list, self%sink, self%report, self%error, archive)
    else
      call simulate(self%case, self%is_twin, self%list, self%sink, self%report, self%error)
    end if
  end subroutine integrate_into_files

  subroutine open_files(self)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), allocatable, target :: files
    allocate (files)
    associate (case => self%case, start => self%start, base => self%base, list => self%list)
      if (self%is_twin) then
        call files%open(base//'.ideal', list, case%output%digits, .false., self%error)
      else if (start%goes_on) then
        call files%reopen(base, list, case%output%digits, allocated(case%contact), start%checkpoint, self%error)
        if (.not. allocated(self%error)) call write_text(base//'.resolved.nml', start%checkpoint%case_text, self%error)
      else
        call files%open(base, list, case%output%digits, allocated(case%contact), self%error)
      end if
      if (allocated(self%error)) return
      if (associated(self%queue) .and. .not. self%is_twin) call files%share_rows(self%queue, size(list%id))
      if (.not. self%is_twin) call files%keep_checkpoints(start%checkpoint%path, start%checkpoint%case_text, start%interval)
      files%end_time = simulated_time(case)
      call files%progress%start(case%name, self%show_progress)
      if (.not. (self%is_twin .or. self%quiet)) files%advice%case = case
    end associate
    call move_alloc(files, self%sink)
  end subroutine open_files

  !> Give the files their last names. This makes no text.
  subroutine conclude_files(self)
    class(case_run_t), intent(inout) :: self
    if (.not. allocated(self%sink)) return
    select type (sink => self%sink)
    type is (trace_files_t)
      call sink%conclude()
    end select
  end subroutine conclude_files

  !> Close the files; but for a twin, write the summary and tell it in `line` and `notice`. An error of the output goes
  !> before one of the integration.
  subroutine finish(self, line, notice)
    class(case_run_t), intent(inout) :: self
    character(len=:), allocatable, intent(inout) :: line, notice
    if (.not. allocated(self%sink)) return
    call conclude_files(self)
    !$omp critical (texts)
    call close_files(self, self%case, self%base, line, notice)
    !$omp end critical (texts)
    deallocate (self%sink)
  end subroutine finish

  subroutine close_files(self, case, base, line, notice)
    class(case_run_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: base
    character(len=:), allocatable, intent(inout) :: line, notice
    type(error_t), allocatable :: trace_error, summary_error

    if (allocated(self%error)) call name_file(case%file, self%error)
    select type (sink => self%sink)
    type is (trace_files_t)
      call sink%close(trace_error)
      if (allocated(trace_error)) self%report%status = 'stopped: '//trace_error%message
      if (.not. self%is_twin) then
        line = summary_line(case, self%report, sink%wall_time(), base)
        if (.not. sink%advice%was_given) notice = advice(self%report%auto_saves)
        if (notice /= '') notice = printable(case%file, 200)//': '//notice
        call write_text(base//'.summary.csv', summary_table(case, self%report, sink%wall_time()), summary_error)
        if (.not. (self%report%can_go_on .or. allocated(trace_error) .or. allocated(summary_error))) call sink%checkpoint%remove()
        if (allocated(self%error) .and. self%report%can_go_on) call tell_how_to_go_on(sink, self%error)
      end if
    end select
    if (allocated(trace_error)) then
      call move_alloc(trace_error, self%error)
    else if (allocated(summary_error)) then
      call move_alloc(summary_error, self%error)
    end if
  end subroutine close_files

  !> Nothing stays of what the run has written, if it has gone.
  subroutine give_up(self)
    class(case_run_t), intent(inout) :: self
    logical :: is_mine
    call take(self, is_mine)
    call self%thread%join()
    if (.not. allocated(self%sink)) return
    select type (sink => self%sink)
    type is (trace_files_t)
      call sink%abandon()
    end select
    deallocate (self%sink)
  end subroutine give_up

  !> Whether the user has stopped the run.
  pure logical function was_interrupted(self)
    class(case_run_t), intent(in) :: self
    was_interrupted = .false.
    if (allocated(self%error)) was_interrupted = index(self%error%message, interrupted_text) > 0
  end function was_interrupted

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

  !> Put the case file's name before an error that does not have it.
  subroutine name_file(path, error)
    character(len=*), intent(in) :: path
    type(error_t), intent(inout) :: error
    error%message = printable(path, 200)//': '//error%message
  end subroutine name_file
end module case_run
