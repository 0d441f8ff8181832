!> Shows progress on standard error, in one line for each case that is overwritten. Each line is written in one call, so that the
!> lines of several cases do not mix.
module run_progress
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use text_tools, only: printable, integer_text, replaced
  use number_text, only: short_text
  use error_handling, only: status_output
  use posix_files, only: is_terminal, write_all, error_text, error_broken_pipe
  implicit none
  private
  public :: progress_t, progress_wanted, clock, tell, say, rate_text

  integer, parameter :: standard_output = 1, standard_error = 2   !! file descriptors
  real(dp), parameter :: least_interval = 0.2_dp   !! shortest time between two lines [s]

  !> The progress of one case.
  type :: progress_t
    private
    logical :: is_on = .false.
    logical :: has_shown = .false.
    logical :: rewrites = .false.                  !! on a terminal: the line is overwritten
    character(len=:), allocatable :: name
    real(dp) :: began = 0, shown = 0               !! times of `clock` [s]
  contains
    procedure :: start
    procedure :: update
    procedure :: update_runs
    procedure :: finish
  end type progress_t

contains

  !> Whether progress is shown: `when` is auto (on a terminal), always or never.
  logical function progress_wanted(when) result(wanted)
    character(len=*), intent(in) :: when
    wanted = when == 'always'
    if (when == 'auto') wanted = is_terminal(standard_error)
  end function progress_wanted

  !> Time since an arbitrary instant [s].
  real(dp) function clock()
    integer(int64) :: ticks, rate
    call system_clock(ticks, rate)
    clock = real(ticks, dp)/real(rate, dp)
  end function clock

  !> Begin a case; if `is_on` is false, the other procedures have no effect.
  subroutine start(self, name, is_on)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    logical, intent(in) :: is_on
    self%is_on = is_on
    self%has_shown = .false.
    self%rewrites = is_terminal(standard_error)
    self%name = printable(name, 60)
    self%began = clock()
    self%shown = self%began
  end subroutine start

  !> Report that a `fraction` of the run, or of other work without a `time`, is done. May be called as often as desired.
  subroutine update(self, fraction, time)
    class(progress_t), intent(inout) :: self
    real(dp), intent(in) :: fraction
    real(dp), intent(in), optional :: time   !! simulated time [s]
    real(dp) :: elapsed
    logical :: is_due
    character(len=:), allocatable :: line
    call look_at_clock(self, elapsed, is_due)
    if (.not. is_due) return
    line = self%name//': '//integer_text(int(100*min(1.0_dp, max(0.0_dp, fraction))))//' %'
    if (present(time)) line = line//', t = '//short_text(time)//' s'
    if (fraction > 1e-6_dp) line = line//', '//duration_text(elapsed*max(0.0_dp, 1/fraction - 1))//' left'
    call show(self, line)
  end subroutine update

  !> Report that `done` of `total` runs have ended, `began` of them before this program was started. May be called as often as
  !> desired.
  subroutine update_runs(self, done, total, began)
    class(progress_t), intent(inout) :: self
    integer, intent(in) :: done, total, began
    real(dp) :: elapsed, speed
    logical :: is_due
    character(len=:), allocatable :: line
    call look_at_clock(self, elapsed, is_due)
    if (.not. is_due) return
    speed = (done - began)/elapsed
    line = self%name//': '//integer_text(done)//' of '//integer_text(total)//' runs'
    if (done > began) line = line//', '//rate_text(speed)//', '//duration_text((total - done)/speed)//' left'
    call show(self, line)
  end subroutine update_runs

  !> Whether a line is due, and the time since the beginning [s].
  subroutine look_at_clock(self, elapsed, is_due)
    class(progress_t), intent(inout) :: self
    real(dp), intent(out) :: elapsed
    logical, intent(out) :: is_due
    elapsed = 0
    is_due = self%is_on
    if (.not. is_due) return
    elapsed = clock() - self%began
    is_due = elapsed >= self%shown - self%began + least_interval
    if (is_due) self%shown = self%began + elapsed
  end subroutine look_at_clock

  !> End the reports, and clear the line, if one is shown.
  subroutine finish(self)
    class(progress_t), intent(inout) :: self
    call clear_line(self)
    self%is_on = .false.
    self%has_shown = .false.
  end subroutine finish

  !> Write one or more lines to standard error, in one call.
  subroutine tell(lines)
    character(len=*), intent(in) :: lines
    character(len=*), parameter :: newline = achar(10), name = 'gudgeon: '
    integer :: done, ignored
    call write_all(standard_error, name//replaced(lines, newline, newline//name)//newline, done, ignored)
  end subroutine tell

  !> Print one line on standard output. If that fails, `status` is raised, unless the reader has closed the pipe.
  subroutine say(line, status)
    character(len=*), intent(in) :: line
    integer, intent(inout) :: status
    integer :: done, problem
    call write_all(standard_output, line//achar(10), done, problem)
    if (problem == 0 .or. problem == error_broken_pipe) return
    call tell('standard output: '//error_text(problem))
    status = max(status, status_output)
  end subroutine say

  subroutine clear_line(self)
    class(progress_t), intent(inout) :: self
    if (self%has_shown .and. self%rewrites) call show(self, '')
  end subroutine clear_line

  !> Replace the line on a terminal, or add a line to a file.
  subroutine show(self, line)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: line
    integer :: done, ignored
    self%has_shown = .true.
    if (self%rewrites) then
      call write_all(standard_error, achar(13)//line//achar(27)//'[K', done, ignored)
    else
      call write_all(standard_error, line//achar(10), done, ignored)
    end if
  end subroutine show

  !> Number of runs per time for the user: 640 runs/s, 12 runs/min.
  function rate_text(per_second) result(text)
    real(dp), intent(in) :: per_second
    character(len=:), allocatable :: text
    if (per_second >= 10) then
      text = integer_text(nint(per_second))//' runs/s'
    else
      text = short_text(nint(600*per_second)/10.0_dp)//' runs/min'
    end if
  end function rate_text

  !> A time span for the user: 42 s, 3 min 5 s, 2 h 7 min.
  pure function duration_text(seconds) result(text)
    real(dp), intent(in) :: seconds
    character(len=:), allocatable :: text
    integer :: whole
    whole = nint(min(seconds, 3.6e8_dp))
    if (whole < 60) then
      text = integer_text(whole)//' s'
    else if (whole < 3600) then
      text = integer_text(whole/60)//' min '//integer_text(mod(whole, 60))//' s'
    else
      text = integer_text(whole/3600)//' h '//integer_text(mod(whole/60, 60))//' min'
    end if
  end function duration_text
end module run_progress
