!> One run of a case with its result files: of the scene itself, or of its ideal twin.
module case_run
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_errors, only: error_t, fail, keep_first, status_output
  use case_definition, only: case_t
  use command_line, only: command_line_t
  use gudgeon_columns, only: column_list_t
  use film_files, only: provide_tables, write_film_file
  use wear_file, only: write_wear_file
  use gudgeon_simulation, only: simulate, run_report_t
  use trace_files, only: trace_files_t
  use result_file, only: result_file_t, remove_result, write_text
  use gudgeon_checkpoint, only: continuation_t
  use run_identity, only: identity_length
  use certificate, only: certificate_t, make_certificate
  use certificate_text, only: certificate_table, certificate_summary, certificate_clause
  use gudgeon_archive, only: archive_t
  use gudgeon_summary, only: summary_table, summary_line, summary_value
  use stability_advice, only: advice
  use gudgeon_posix, only: synchronise_folder, remove_file, error_text, file_length
  use text_file, only: read_whole
  use text_tools, only: printable
  implicit none
  private
  public :: case_run_t, name_file

  integer, parameter :: room_for_summary = 12288   !! [bytes], twice the length of the longest summaries

  !> A run. Call `prepare` first, then `go`; it begins where `start` says. Its files are BASE.csv, with contacts BASE.events.csv,
  !> BASE.summary.csv and BASE.checkpoint. Errors are collected in `error`.
  type :: case_run_t
    type(error_t), allocatable :: error
    character(len=:), allocatable :: line, notice        !! texts for the user: the outcome, and remarks
    type(continuation_t) :: start
    character(len=:), allocatable :: base                !! path of the results without suffix
    logical, private :: certifies = .false.              !! make a certificate if the run is completed
    type(certificate_t), allocatable, private :: certificate
    type(case_t), private :: case
    logical, private :: is_twin = .false.                !! this is the run of the ideal twin
    type(column_list_t), private :: list
    logical, private :: show_progress = .false., quiet = .false.
    type(result_file_t), private :: summary
    type(run_report_t), private :: report
  contains
    procedure :: prepare
    procedure :: look_for_earlier
    procedure :: disown
    procedure :: clear
    procedure :: make_ready
    procedure :: go
  end type case_run_t

contains

  !> Set what is to be run, and where its results are written.
  subroutine prepare(self, case, case_text, identity, is_twin, list, base, options, show_progress)
    class(case_run_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: case_text            !! the resolved case
    character(len=identity_length), intent(in) :: identity
    logical, intent(in) :: is_twin
    type(column_list_t), intent(in) :: list
    character(len=*), intent(in) :: base
    type(command_line_t), intent(in) :: options
    logical, intent(in) :: show_progress
    self%line = case%file//': correct'
    self%case = case
    self%is_twin = is_twin
    self%list = list
    self%base = base
    self%show_progress = show_progress
    self%quiet = options%quiet
    self%certifies = options%certify .and. .not. is_twin
    self%notice = ''
    associate (start => self%start)
      start%interval = options%checkpoint_interval
      start%checkpoint%path = base//'.checkpoint'
      start%checkpoint%identity = identity
      start%checkpoint%case_text = case_text
    end associate
  end subroutine prepare

  !> Look for an earlier, incomplete run of the same case. A run that lacks a result which is wanted now, such as a certificate, is
  !> not done. Errors: see `look_for` of continuation_t.
  subroutine look_for_earlier(self, error)
    class(case_run_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    call self%start%look_for(self%base, self%case%file, .not. self%is_twin, has_events(self), error)
    if (self%start%is_done) self%start%is_done = has_other_results(self)
    if (self%start%is_done) self%line = self%case%file//': done already; '//self%base//'.csv'
  end subroutine look_for_earlier

  !> Unless the run continues or is done, remove the files of earlier results that mark them as complete or resumable. This must
  !> happen first, so that these files never stand beside new results. No text function is used here or in `clear`, since other
  !> threads may use one.
  subroutine disown(self, was_there, status)
    class(case_run_t), intent(in) :: self
    logical, intent(inout) :: was_there   !! becomes true if something was removed
    integer, intent(inout) :: status      !! set to the number of the first error
    if (self%start%goes_on) return
    if (.not. self%start%is_done) call remove_result(self%base//'.summary.csv', was_there, status)
    call remove_result(self%base//'.checkpoint', was_there, status)
  end subroutine disown

  !> Unless the run continues or is done, remove the other files of earlier results.
  subroutine clear(self, was_there, status)
    class(case_run_t), intent(in) :: self
    logical, intent(inout) :: was_there
    integer, intent(inout) :: status
    if (self%start%goes_on .or. self%start%is_done) return
    call remove_result(self%base//'.csv', was_there, status)
    call remove_result(self%base//'.events.csv', was_there, status)
    call remove_result(self%base//'.film.csv', was_there, status)
    call remove_result(self%base//'.wear.csv', was_there, status)
    call remove_result(self%base//'.certificate.csv', was_there, status)
    if (.not. self%is_twin) call remove_result(self%base//'.resolved.nml', was_there, status)
  end subroutine clear

  !> Compute the film tables of the scene, while no other run needs the processors. Error in `error`: the user interrupted.
  subroutine make_ready(self)
    class(case_run_t), intent(inout) :: self
    call provide_tables(self%case, .not. self%quiet, self%show_progress, self%error)
    if (allocated(self%error)) call name_file(self%case%file, self%error)
  end subroutine make_ready

  !> Integrate, and write the results and the summary to the disk. The order is such that incomplete results never have their final
  !> names without a summary that says so, whatever happens.
  subroutine go(self)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t) :: files
    type(archive_t), allocatable :: archive

    if (self%start%is_done .or. allocated(self%error)) return
    !$omp critical (texts)
    call open_files(self, files)
    !$omp end critical (texts)
    if (allocated(self%error)) return
    if (self%start%goes_on) then
      allocate (archive)
      call archive%begin_reading(self%start%checkpoint%state)
    end if
    call simulate(self%case, self%is_twin, self%list, files, self%report, self%error, archive)   ! absent if not allocated
    if (.not. allocated(self%report%status)) self%report%status = self%error%message
    if (self%certifies .and. self%report%status == 'done') then
      allocate (self%certificate)
      call make_certificate(self%case, self%report, .not. self%quiet, self%certificate, self%error)
      if (allocated(self%error)) self%certificate%reason = self%error%message
    end if
    call close_files(self, files)
  end subroutine go

  !> Open the summary, with space reserved on the disk, and the traces.
  subroutine open_files(self, files)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), intent(out) :: files
    associate (case => self%case, start => self%start, base => self%base, list => self%list)
      call self%summary%open(base//'.summary.csv', self%error, whole_only=.true.)
      if (.not. allocated(self%error)) call self%summary%reserve(room_for_summary, self%error)
      if (allocated(self%error)) then
        continue
      else if (start%goes_on) then
        call files%reopen(base, list, case%output%digits, has_events(self), start%checkpoint, self%error)
      else
        call files%open(base, list, case%output%digits, has_events(self), self%error)
      end if
      if (allocated(self%error)) then
        call self%summary%abandon()
        return
      end if
      call files%keep_checkpoints(start%checkpoint, start%interval)
      call files%progress%start(case%name, self%show_progress)
      if (.not. (self%is_twin .or. self%quiet)) files%advice%case = case
    end associate
  end subroutine open_files

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
    !$omp critical (texts)
    if (self%start%goes_on .and. .not. self%is_twin) then   ! its limits may be others than those of the stopped run
      call write_text(self%base//'.resolved.nml', self%start%checkpoint%case_text, file_error)
      call keep_first(file_error, self%error)
    end if
    if (allocated(self%report%films)) then
      call write_film_file(self%base//'.film.csv', self%report%films, file_error)
      call keep_first(file_error, self%error)
    end if
    if (allocated(self%report%wear)) then
      if (size(self%report%wear) > 0) call write_wear_file(self%base//'.wear.csv', self%report%wear, file_error)
      call keep_first(file_error, self%error)
    end if
    call put_summary(self, files)
    !$omp end critical (texts)
    call self%summary%synchronise()
    call self%summary%conclude()
    if (self%summary%has_failed()) call files%file%leave()   ! no effect on files that have their final names
    call files%file%conclude()
    call synchronise_folder(self%base, folder_status)
    !$omp critical (texts)
    call collect_errors(self, files, folder_status)
    !$omp end critical (texts)
  end subroutine close_files

  !> Write the summary into its file, and its lines for the user into `line` and `notice`.
  subroutine put_summary(self, files)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), intent(inout) :: files
    type(error_t), allocatable :: error
    type(case_t) :: case
    character(len=:), allocatable :: remark
    call files%tell_error(error)
    if (allocated(error)) self%report%status = 'stopped: '//error%message
    case = self%case
    if (self%is_twin) case%joint%kind = 'ideal'
    if (self%is_twin) case%crank_pin%kind = 'ideal'
    remark = ''
    if (allocated(self%certificate)) then
      if (self%certificate%is_made) then
        call write_text(self%base//'.certificate.csv', certificate_table(self%certificate), error)
        call keep_first(error, self%error)
      end if
      remark = certificate_clause(self%certificate)
    end if
    self%line = summary_line(case, self%report, files%wall_time(), self%base, remark)
    if (.not. files%advice%was_given) self%notice = advice(self%report%auto_saves)
    if (self%notice /= '') self%notice = printable(case%file, 200)//': '//self%notice
    call self%summary%put(summary_table(case, self%report, files%wall_time(), self%start%checkpoint%identity, &
                                        int(files%file(1)%written, int64), int(files%file(2)%written, int64), self%is_twin))
    if (allocated(self%certificate)) call self%summary%put(certificate_summary(self%certificate))
  end subroutine put_summary

  !> Collect the errors of the run: an error of the output takes precedence over one of the integration. The checkpoint is removed
  !> after everything else is complete.
  subroutine collect_errors(self, files, folder_status)
    class(case_run_t), intent(inout) :: self
    type(trace_files_t), intent(inout) :: files
    integer, intent(in) :: folder_status
    type(error_t), allocatable :: output_error, summary_error
    integer :: ignored
    if (allocated(self%error)) then
      if (self%report%can_go_on) call tell_how_to_go_on(files, self%error)
      if (self%is_twin) self%error%message = 'ideal twin: '//self%error%message
      call name_file(self%case%file, self%error)
    end if
    call files%close(output_error)
    call self%summary%close(summary_error)
    call keep_first(summary_error, output_error)
    if (folder_status /= 0 .and. .not. allocated(output_error)) &
      call fail(output_error, printable(self%base, 200)//'.csv: '//error_text(folder_status), status_output)
    if (.not. (self%report%can_go_on .or. allocated(output_error))) call remove_file(files%checkpoint%path, ignored)
    if (allocated(output_error)) call move_alloc(output_error, self%error)
  end subroutine collect_errors

  !> Whether the run writes a list of events.
  pure logical function has_events(self)
    class(case_run_t), intent(in) :: self
    has_events = self%case%has_contact() .and. .not. self%is_twin
  end function has_events

  !> Whether the results of a completed run include the files that only some runs have, besides the events.
  logical function has_other_results(self)
    class(case_run_t), intent(in) :: self
    character(len=:), allocatable :: table
    integer :: status
    has_other_results = .true.
    if (self%is_twin) return
    if (self%case%output%film_times /= '') call demand('.film.csv')
    if (allocated(self%case%joint%wear) .or. allocated(self%case%crank_pin%wear)) call demand('.wear.csv')
    if (.not. self%certifies) return
    call read_whole(self%base//'.summary.csv', table, status)
    if (status /= 0) table = ''
    if (summary_value(table, 'certificate') /= '') return   ! no certificate can be made
    call demand('.certificate.csv')
    if (summary_value(table, 'certified_until') == '') has_other_results = .false.

  contains

    subroutine demand(suffix)
      character(len=*), intent(in) :: suffix
      if (file_length(self%base//suffix) < 0) has_other_results = .false.
    end subroutine demand
  end function has_other_results

  !> Add to the message of a run that was stopped how it can be continued.
  subroutine tell_how_to_go_on(files, error)
    type(trace_files_t), intent(in) :: files
    type(error_t), intent(inout) :: error
    if (.not. files%keeps_archives) return
    if (allocated(files%checkpoint_error)) then
      error%message = error%message//'; no checkpoint: '//files%checkpoint_error%message
    else
      error%message = error%message//'; --resume continues from there'
    end if
  end subroutine tell_how_to_go_on

  !> Put the name of the case file in front of an error message that does not contain it.
  subroutine name_file(path, error)
    character(len=*), intent(in) :: path
    type(error_t), intent(inout) :: error
    error%message = printable(path, 200)//': '//error%message
  end subroutine name_file
end module case_run
