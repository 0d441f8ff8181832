!> A results file of a study. While the study runs the rows of each run are appended together, in the order in which runs end; at
!> the end the rows are sorted by run. A file left by a killed program or a power failure can be continued.
!>
!> The first field of a row is the number of its run. Only the positions of the rows in the file, and the rows that have not been
!> written, are kept in memory; the code that uses several files decides in which order they are written to the disk. All procedures
!> have no effect on a file for which `prepare` was not called.
module row_file
  use, intrinsic :: iso_fortran_env, only: int64
  use, intrinsic :: iso_c_binding, only: c_long
  use gudgeon_errors, only: error_t, fail, status_output, status_integration
  use text_tools, only: printable, whole_number
  use growing_text, only: growing_text_t
  use result_file, only: result_file_t, fail_with_file
  use gudgeon_posix, only: open_file, to_read, to_append, read_at, read_bytes, write_all, truncate_file, &
    synchronise_file, synchronise_folder, close_file, error_interrupted, error_no_entry, interrupted
  implicit none
  private
  public :: row_file_t

  character(len=*), parameter :: newline = achar(10), fresh = '; --fresh starts from the beginning'

  type :: row_file_t
    private
    character(len=:), allocatable :: path, header
    integer, allocatable :: columns(:)             !! the first column, and the columns whose whole numbers are kept
    integer :: fields = 0                          !! number of fields of a row
    integer :: descriptor = -1
    integer :: status = 0                          !! error number of the first write that failed
    integer(int64) :: written = 0                  !! length of the file on the disk [bytes]
    type(growing_text_t), public :: waiting        !! rows not yet written
    integer :: first = 1                           !! first run
    integer(int64), allocatable :: at(:)           !! position of the rows of each run in the file
    integer, allocatable, public :: length(:)      !! length of the rows of each run [bytes]; 0: there are none
    integer, allocatable, public :: rows(:)        !! number of rows of each run that were read back
    integer, allocatable, public :: numbers(:, :)  !! (columns, runs), from the last row of each run that was read back; 0 if there
                                                   !! is none
  contains
    procedure :: prepare
    procedure :: take_up
    procedure :: drop
    procedure :: begin
    procedure :: append
    procedure :: write => write_waiting
    procedure :: finish
  end type row_file_t

contains

  !> Prepare the file at `path` for the runs `first` to `last`. `header` is its first row. The whole numbers in the columns of these
  !> names, not the first one, are kept of rows that are read back.
  subroutine prepare(self, path, header, first, last, columns)
    class(row_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path, header, columns(:)
    integer, intent(in) :: first, last
    integer :: i, k, at
    self%path = path
    self%header = header
    self%first = first
    allocate (self%columns(0:size(columns)))
    self%columns = 1
    do i = 1, size(columns)
      at = index(header, ','//trim(columns(i)))   ! 0 if there is no such column
      self%columns(i) = count([(header(k:k) == ',', k=1, at)]) + min(at, 1)
    end do
    allocate (self%at(first:last), source=0_int64)
    allocate (self%length(first:last), self%rows(first:last), source=0)
    allocate (self%numbers(size(columns), first:last), source=0)
    call read_fields(header, self%columns(:0), self%rows(first:first), self%fields)
    self%rows(first) = 0
  end subroutine prepare

  !> Discard the rows of a run that were read back.
  pure subroutine drop(self, run)
    class(row_file_t), intent(inout) :: self
    integer, intent(in) :: run
    if (.not. allocated(self%length)) return
    self%length(run) = 0
    self%rows(run) = 0
  end subroutine drop

  !> Read the rows of an existing file. An incomplete row is ignored. Errors: the file cannot be read, or belongs to another study;
  !> an interruption.
  subroutine take_up(self, error)
    class(row_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: buffer, line
    integer :: descriptor, status, done, ignored, first, next, previous
    if (.not. allocated(self%path)) return
    call open_file(self%path, to_read, descriptor, status)
    if (status == error_no_entry) return
    if (status /= 0) then
      call fail_with_file(self%path, status, error)
      return
    end if
    allocate (character(len=65536) :: buffer)
    line = ''
    previous = self%first - 1
    do while (.not. allocated(error))
      call read_bytes(descriptor, buffer, done, status)
      if (status == error_interrupted) cycle
      if (status /= 0 .or. done == 0) exit
      first = 1
      do
        next = index(buffer(first:done), newline)
        if (next == 0) exit
        call take_line(self, line//buffer(first:first + next - 1), previous, error)
        if (allocated(error)) exit
        self%written = self%written + len(line) + next
        line = ''
        first = first + next
      end do
      line = line//buffer(first:done)
      if (interrupted()) call fail(error, printable(self%path, 200)//': interrupted while it was read', status_integration)
    end do
    self%written = self%written + len(line)
    call close_file(descriptor, ignored)
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine take_up

  !> Process one complete line at the end of the text read so far. `previous` is the run of the line before.
  subroutine take_line(self, line, previous, error)
    class(row_file_t), intent(inout) :: self
    character(len=*), intent(in) :: line
    integer, intent(inout) :: previous
    type(error_t), allocatable, intent(out) :: error
    integer :: fields, numbers(0:ubound(self%columns, 1))
    if (self%written == 0) then
      if (line == self%header .and. len(line) == len(self%header)) return
      call fail(error, printable(self%path, 200)//': its first row is not that of this study'//fresh, status_output)
      return
    end if
    call read_fields(line, self%columns, numbers, fields)
    associate (run => numbers(0))
      if (fields /= self%fields .or. run == 0) then   ! left by a power failure
        previous = self%first - 1
        return
      else if (run < self%first .or. run > ubound(self%at, 1)) then
        call fail(error, printable(self%path, 200)//': holds a run that this study does not have'//fresh, status_output)
        return
      end if
      if (run /= previous) then
        self%at(run) = self%written
        call self%drop(run)
      end if
      self%length(run) = self%length(run) + len(line)
      self%rows(run) = self%rows(run) + 1
      self%numbers(:, run) = numbers(1:)
      previous = run
    end associate
  end subroutine take_line

  !> The whole numbers in some columns of a row, 0 where there is none, and the number of its fields; 0 fields if it contains a
  !> control character, which no valid row does.
  pure subroutine read_fields(line, columns, numbers, fields)
    character(len=*), intent(in) :: line   !! with an end of line
    integer, intent(in) :: columns(:)
    integer, intent(out) :: numbers(:), fields
    logical :: is_quoted
    integer :: i, k, from
    is_quoted = .false.
    fields = 0
    from = 1
    numbers = 0
    do i = 1, len(line)
      if (line(i:i) == '"') is_quoted = .not. is_quoted
      if (iachar(line(i:i)) < 32 .and. i < len(line)) then
        fields = 0
        return
      end if
      if ((line(i:i) /= ',' .or. is_quoted) .and. i < len(line)) cycle
      fields = fields + 1
      do k = 1, size(columns)
        if (columns(k) /= fields .or. i == from .or. i - from > 9 .or. verify(line(from:i - 1), '0123456789') > 0) cycle
        numbers(k) = int(whole_number(line(from:i - 1)))
      end do
      from = i + 1
    end do
  end subroutine read_fields

  !> Prepare for appending rows: to the existing file if it contains exactly the rows that were read back, otherwise to a file
  !> written again.
  subroutine begin(self, error)
    class(row_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    if (.not. allocated(self%path)) return
    status = error_no_entry
    if (self%written == len(self%header) + sum(int(self%length, int64))) &
      call open_file(self%path, to_append, self%descriptor, status)
    if (status == 0) return
    call rewrite(self, error)
    if (allocated(error)) return
    call open_file(self%path, to_append, self%descriptor, status)
    if (status /= 0) call fail_with_file(self%path, status, error)
  end subroutine begin

  !> Add all rows of a run to those not yet written.
  subroutine append(self, run, text)
    class(row_file_t), intent(inout) :: self
    integer, intent(in) :: run
    character(len=*), intent(in) :: text   !! with an end of line
    if (self%descriptor < 0 .or. len(text) == 0) return
    self%at(run) = self%written + self%waiting%used
    self%length(run) = len(text)
    call self%waiting%append(text)
  end subroutine append

  !> Write the rows not yet written, and wait until they are on the disk. After an error the file has its previous content, and
  !> every further call returns the error.
  subroutine write_waiting(self, error)
    class(row_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    integer :: done, ignored
    if (self%descriptor < 0) return
    call self%waiting%make_room(0)
    done = 0
    if (self%status == 0) call write_all(self%descriptor, self%waiting%text(:self%waiting%used), done, self%status)
    self%waiting%used = 0
    if (self%status == 0) then
      self%written = self%written + done
      call synchronise_file(self%descriptor, self%status)
    else if (done > 0) then
      call truncate_file(self%descriptor, int(self%written, c_long), ignored)
    end if
    if (self%status /= 0) call fail_with_file(self%path, self%status, error)
  end subroutine write_waiting

  !> Close the file; if the study is `complete`, sort its rows.
  subroutine finish(self, complete, error)
    class(row_file_t), intent(inout) :: self
    logical, intent(in) :: complete
    type(error_t), allocatable, intent(out) :: error
    integer :: status
    if (self%descriptor < 0) return
    call close_file(self%descriptor, status)
    self%descriptor = -1
    if (status /= 0 .and. status /= error_interrupted) then
      call fail_with_file(self%path, status, error)
    else if (complete .and. .not. is_in_order(self)) then
      call rewrite(self, error)
    end if
  end subroutine finish

  !> Whether the rows in the file are in the order of the runs.
  pure logical function is_in_order(self)
    class(row_file_t), intent(in) :: self
    integer(int64) :: at
    integer :: run
    is_in_order = .false.
    at = len(self%header)
    do run = self%first, ubound(self%at, 1)
      if (self%length(run) == 0) cycle
      if (self%at(run) /= at) return
      at = at + self%length(run)
    end do
    is_in_order = .true.
  end function is_in_order

  !> Write the file again with its rows in the order of the runs; it replaces the old file when it is complete and on the disk.
  subroutine rewrite(self, error)
    class(row_file_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(result_file_t) :: file
    character(len=:), allocatable :: buffer
    integer :: descriptor, status, done, run, ignored
    integer(int64) :: at
    descriptor = -1
    status = 0
    if (any(self%length > 0)) call open_file(self%path, to_read, descriptor, status)
    if (status == 0) call file%open(self%path, error, whole_only=.true.)
    if (status /= 0) call fail_with_file(self%path, status, error)
    if (.not. allocated(error)) call file%put(self%header)
    at = len(self%header)
    allocate (character(len=max(1, maxval(self%length))) :: buffer)
    do run = self%first, ubound(self%at, 1)
      if (allocated(error)) exit
      if (self%length(run) == 0) cycle
      associate (rows => buffer(:self%length(run)))
        call read_at(descriptor, int(self%at(run), c_long), rows, done, status)
        if (done == len(rows)) call file%put(rows)
        if (done < len(rows)) call fail(error, printable(self%path, 200)//': changed while it was written', status_output)
        if (status /= 0) call fail_with_file(self%path, status, error)
      end associate
      if (mod(run, 1000) == 0) then
        if (interrupted()) call fail(error, printable(self%path, 200)//': interrupted while its rows were sorted; the '// &
                                     'same command continues from there', status_integration)
      end if
      if (allocated(error)) exit
      self%at(run) = at
      at = at + self%length(run)
    end do
    if (descriptor >= 0) call close_file(descriptor, ignored)
    if (allocated(error)) then
      call file%abandon()
    else
      call file%synchronise()
      call file%close(error)
      call synchronise_folder(self%path, status)
      if (status /= 0 .and. .not. allocated(error)) call fail_with_file(self%path, status, error)
    end if
    self%written = at
  end subroutine rewrite
end module row_file
