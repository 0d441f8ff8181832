!> A results file of a study. While the study goes on, every run adds its rows in one piece, in the order in which runs end;
!> what a killed program left can be taken up again; at the end the rows stand in the order of the runs.
!>
!> The first field of a row is the number of its run. Only where each run's rows stand in the file is kept in memory.
module row_file
  use, intrinsic :: iso_fortran_env, only: int64
  use, intrinsic :: iso_c_binding, only: c_long
  use errors, only: error_t, fail, status_output
  use text_tools, only: printable
  use result_file, only: result_file_t
  use posix, only: open_for_reading, open_for_appending, read_at, read_bytes, write_bytes, truncate_file, close_file, &
    error_text, error_interrupted, error_no_entry
  implicit none
  private
  public :: row_file_t

  character(len=*), parameter :: newline = achar(10)

  type :: row_file_t
    private
    character(len=:), allocatable :: path, header
    integer :: descriptor = -1
    integer(int64) :: size = 0                     !! of the file [bytes]
    integer :: first = 1                           !! run
    integer(int64), allocatable :: at(:), length(:) !! where the rows of each run begin, and their bytes
    character(len=:), allocatable :: mark          !! text looked for in the rows taken up
    logical, allocatable :: marked(:)              !! it was found
  contains
    procedure :: open => open_rows
    procedure :: has
    procedure :: is_marked
    procedure :: append
    procedure :: finish
    procedure, private :: take_up
    procedure, private :: take_line
    procedure, private :: rewrite
  end type row_file_t

contains

  !> Begin the file of the runs first .. last, or take up what is there. `header` is its first row. Of what is there only
  !> whole rows of runs in `kept` stay. `mark` is a text to look for in them.
  subroutine open_rows(self, path, header, first, last, resumes, error, kept, mark)
    class(row_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path, header
    integer, intent(in) :: first, last
    logical, intent(in) :: resumes
    type(error_t), allocatable, intent(out) :: error
    class(row_file_t), intent(in), optional :: kept
    character(len=*), intent(in), optional :: mark
    integer :: status, run
    self%path = path
    self%header = header
    self%first = first
    allocate (self%at(first:last), self%length(first:last), source=0_int64)
    allocate (self%marked(first:last), source=.false.)
    self%mark = ''
    if (present(mark)) self%mark = mark
    if (resumes) call self%take_up(error)
    if (allocated(error)) return
    if (present(kept)) then
      do run = first, last
        if (.not. kept%has(run)) self%length(run) = 0
      end do
    end if
    call self%rewrite(error)
    if (allocated(error)) return
    call open_for_appending(path, self%descriptor, status)
    if (status /= 0) call report(self, status, error)
  end subroutine open_rows

  !> Whether the rows of a run are there.
  pure logical function has(self, run)
    class(row_file_t), intent(in) :: self
    integer, intent(in) :: run
    has = self%length(run) > 0
  end function has

  !> Whether the rows of a run that were taken up hold the mark.
  pure logical function is_marked(self, run)
    class(row_file_t), intent(in) :: self
    integer, intent(in) :: run
    is_marked = self%marked(run)
  end function is_marked

  !> Add all rows of a run. An error leaves the file as it was.
  subroutine append(self, run, text, error)
    class(row_file_t), intent(inout) :: self
    integer, intent(in) :: run
    character(len=*), intent(in) :: text   !! ends with an end of line
    type(error_t), allocatable, intent(out) :: error
    integer :: written, done, status, ignored
    written = 0
    do while (written < len(text))
      call write_bytes(self%descriptor, text(written + 1:), done, status)
      if (status == error_interrupted) cycle
      if (status /= 0) then
        call report(self, status, error)
        call truncate_file(self%descriptor, int(self%size, c_long), ignored)
        return
      end if
      written = written + done
    end do
    self%at(run) = self%size
    self%length(run) = len(text)
    self%size = self%size + len(text)
  end subroutine append

  !> Close the file; where the study is `complete`, with its rows in order.
  subroutine finish(self, complete, error)
    class(row_file_t), intent(inout) :: self
    logical, intent(in) :: complete
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    if (self%descriptor < 0) return
    call close_file(self%descriptor, status)
    self%descriptor = -1
    if (status /= 0 .and. status /= error_interrupted) then
      call report(self, status, error)
    else if (complete) then
      call self%rewrite(error)
    end if
  end subroutine finish

  !> Find the whole rows in the file, if there is one.
  subroutine take_up(self, error)
    class(row_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: buffer, line
    integer :: descriptor, status, done, ignored, first, next, previous
    integer(int64) :: at
    call open_for_reading(self%path, descriptor, status)
    if (status == error_no_entry) return
    if (status /= 0) then
      call report(self, status, error)
      return
    end if
    allocate (character(len=65536) :: buffer)
    line = ''
    at = 0
    previous = self%first - 1
    do
      call read_bytes(descriptor, buffer, done, status)
      if (status == error_interrupted) cycle
      if (status /= 0 .or. done == 0) exit
      first = 1
      do
        next = index(buffer(first:done), newline)
        if (next == 0) exit
        call self%take_line(line//buffer(first:first + next - 1), at, previous, error)
        if (allocated(error)) exit
        at = at + len(line) + next
        line = ''
        first = first + next
      end do
      if (allocated(error)) exit
      line = line//buffer(first:done)
    end do
    call close_file(descriptor, ignored)
    if (status /= 0 .and. .not. allocated(error)) call report(self, status, error)
  end subroutine take_up

  !> One whole line that begins at a place in the file. `previous` is the run of the line before.
  subroutine take_line(self, line, at, previous, error)
    class(row_file_t), intent(inout) :: self
    character(len=*), intent(in) :: line
    integer(int64), intent(in) :: at
    integer, intent(inout) :: previous
    type(error_t), allocatable, intent(out) :: error
    integer :: run, iostat, comma
    if (at == 0) then
      if (line == self%header .and. len(line) == len(self%header)) return
      call fail(error, printable(self%path, 200)//': its first row is not that of this study; --fresh begins anew', status_output)
      return
    end if
    comma = index(line, ',')
    run = self%first - 1
    iostat = 1
    if (comma > 1 .and. comma < 10) then
      if (verify(line(:comma - 1), '0123456789') == 0) read (line(:comma - 1), *, iostat=iostat) run
    end if
    if (iostat /= 0 .or. run < self%first .or. run > ubound(self%at, 1)) then
      call fail(error, printable(self%path, 200)//': a row does not begin with the number of a run; --fresh begins anew', &
                status_output)
      return
    end if
    if (run /= previous) then
      self%at(run) = at
      self%length(run) = 0
    end if
    self%length(run) = self%length(run) + len(line)
    self%marked(run) = index(line, self%mark) > 0
    previous = run
  end subroutine take_line

  !> The file anew, rows in the order of the runs, under its name when it is whole.
  subroutine rewrite(self, error)
    class(row_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(result_file_t) :: file
    character(len=:), allocatable :: buffer
    integer :: descriptor, status, done, run, ignored
    integer(int64) :: at
    descriptor = -1
    status = 0
    if (any(self%length > 0)) call open_for_reading(self%path, descriptor, status)
    if (status == 0) call file%open(self%path, error)
    if (allocated(error)) return
    call file%put(self%header)
    at = len(self%header)
    allocate (character(len=max(1_int64, maxval(self%length))) :: buffer)
    do run = self%first, ubound(self%at, 1)
      if (self%length(run) == 0 .or. status /= 0) cycle
      associate (rows => buffer(:self%length(run)))
        call read_at(descriptor, int(self%at(run), c_long), rows, done, status)
        if (done < len(rows)) exit
        call file%put(rows)
      end associate
      self%at(run) = at
      at = at + self%length(run)
    end do
    if (descriptor >= 0) call close_file(descriptor, ignored)
    if (run <= ubound(self%at, 1)) then
      call file%abandon()
      call report(self, status, error)
    else
      call file%close(error, whole_only=.true.)
    end if
    self%size = at
  end subroutine rewrite

  !> The error for an error number of the system.
  subroutine report(self, status, error)
    class(row_file_t), intent(in) :: self
    integer, intent(in) :: status
    type(error_t), allocatable, intent(out) :: error
    call fail(error, printable(self%path, 200)//': '//error_text(status), status_output)
  end subroutine report
end module row_file
