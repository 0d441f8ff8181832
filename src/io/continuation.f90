!> Looks for an earlier run of the same case for `--resume`: its complete results, or its checkpoint.
module continuation
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, status_case_file
  use gudgeon_checkpoint, only: checkpoint_t, restart_hint
  use gudgeon_posix, only: file_length
  use run_identity, only: compare_cases
  use gudgeon_summary, only: summary_value
  use text_file, only: read_whole
  use text_tools, only: printable
  implicit none
  private
  public :: continuation_t

  !> Where a run begins: at its start, unless one of the first two components is true.
  type :: continuation_t
    logical :: goes_on = .false.     !! continue from the checkpoint
    logical :: is_done = .false.     !! the run is complete already
    real(dp) :: interval = 0         !! between checkpoints [s]; 0: none
    type(checkpoint_t) :: checkpoint   !! its path, and identity and resolved case of the run; with `goes_on` all that it holds
  contains
    procedure :: look_for
  end type continuation_t

contains

  !> Look for complete results of the same run under BASE, or for its checkpoint. Errors: the checkpoint is damaged, or belongs to
  !> another case or program.
  subroutine look_for(self, base, file, with_case, with_events, error)
    class(continuation_t), intent(inout) :: self
    character(len=*), intent(in) :: base, file   !! path of the results without suffix; path of the case file
    logical, intent(in) :: with_case             !! the resolved case belongs to the results
    logical, intent(in) :: with_events           !! a list of events belongs to the results
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_t) :: stopped
    character(len=:), allocatable :: earlier, difference
    logical :: found
    integer :: status

    self%is_done = are_whole(base, self%checkpoint%identity, with_events)
    if (self%is_done .and. with_case) then
      call read_whole(base//'.resolved.nml', earlier, status)
      call compare_cases(self%checkpoint%case_text, earlier, difference)
      self%is_done = status == 0 .and. difference == ''
    end if
    if (self%is_done) return
    stopped%path = self%checkpoint%path
    call stopped%load(found, error)
    if (allocated(error) .or. .not. found) return
    call compare_cases(self%checkpoint%case_text, stopped%case_text, difference)
    self%goes_on = stopped%identity == self%checkpoint%identity
    if (difference /= '') then
      call fail(error, printable(file, 200)//': '//difference//restart_hint, status_case_file)
    else if (.not. self%goes_on) then
      call fail(error, printable(stopped%path, 200)//': written by another build of gudgeon, or on another kind of '// &
                'processor: the rounding may differ'//restart_hint, status_case_file)
    else
      self%checkpoint = stopped
    end if
  end subroutine look_for

  !> Whether the results BASE are complete and belong to a completed run of this identity: its summary says so, and the files have
  !> the lengths given there.
  logical function are_whole(base, identity, with_events) result(answer)
    character(len=*), intent(in) :: base, identity
    logical, intent(in) :: with_events
    character(len=:), allocatable :: table
    integer :: status
    call read_whole(base//'.summary.csv', table, status)
    answer = status == 0
    if (answer) answer = summary_value(table, 'identity') == identity
    if (answer) answer = summary_value(table, 'status') == '"done"'
    if (answer) answer = has_length(base//'.csv', summary_value(table, 'trace_bytes'))
    if (answer .and. with_events) answer = has_length(base//'.events.csv', summary_value(table, 'events_bytes'))
  end function are_whole

  !> Whether a file has the length given by a text of digits.
  logical function has_length(path, digits) result(answer)
    character(len=*), intent(in) :: path, digits
    integer(int64) :: length
    integer :: iostat
    read (digits, '(i20)', iostat=iostat) length
    answer = iostat == 0
    if (answer) answer = file_length(path) == length
  end function has_length
end module continuation
