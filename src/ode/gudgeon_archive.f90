!> The state of a run as a string of bytes, from which a run can be continued with identical results.
!>
!> Every type with a state has one procedure `exchange` that lists its components once. The archive either stores or returns them,
!> so that writing and reading cannot differ.
module gudgeon_archive
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: archive_t

  integer, parameter :: head = 5   !! length of an entry's header: its kind (one byte) and the number of its values

  !> Values in the order in which they were written. Reading an entry that does not exist, or has another kind or number of values,
  !> sets `failed` and does not change the component.
  type :: archive_t
    private
    logical, public :: is_reading = .false.
    logical, public :: failed = .false.
    character(len=:), allocatable :: bytes
    integer :: at = 0                        !! number of bytes written or read
  contains
    procedure :: begin_writing
    procedure :: begin_reading
    procedure :: contents
    procedure :: is_at_end
    procedure :: exchange_text
    procedure, private :: exchange_real, exchange_reals, exchange_matrix, exchange_integer, exchange_integers, exchange_long, &
      exchange_logical, exchange_logicals
    generic :: exchange => exchange_real, exchange_reals, exchange_matrix, exchange_integer, exchange_integers, exchange_long, &
      exchange_logical, exchange_logicals
  end type archive_t

contains

  !> Begin an empty archive for writing.
  subroutine begin_writing(self)
    class(archive_t), intent(inout) :: self
    self%is_reading = .false.
    self%failed = .false.
    self%at = 0
    if (.not. allocated(self%bytes)) allocate (character(len=4096) :: self%bytes)
  end subroutine begin_writing

  !> Begin reading an archive with the given contents.
  subroutine begin_reading(self, bytes)
    class(archive_t), intent(inout) :: self
    character(len=*), intent(in) :: bytes
    self%is_reading = .true.
    self%failed = .false.
    self%at = 0
    self%bytes = bytes
  end subroutine begin_reading

  !> The bytes written so far.
  pure subroutine contents(self, bytes)
    class(archive_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: bytes
    bytes = self%bytes(:self%at)
  end subroutine contents

  !> Whether everything has been read.
  pure logical function is_at_end(self)
    class(archive_t), intent(in) :: self
    is_at_end = self%at == len(self%bytes)
  end function is_at_end

  !> Write or read one entry.
  subroutine exchange_block(self, kind, number, block)
    class(archive_t), intent(inout) :: self
    character(len=1), intent(in) :: kind
    integer, intent(in) :: number
    character(len=*), intent(inout) :: block
    character(len=:), allocatable :: larger
    character(len=head) :: label
    integer :: first, last

    label = kind//transfer(number, label(2:))
    first = self%at + head + 1
    last = self%at + head + len(block)
    if (self%is_reading) then
      if (last > len(self%bytes)) self%failed = .true.
      if (self%failed) return
      if (self%bytes(self%at + 1:self%at + head) /= label) self%failed = .true.
      if (self%failed) return
      block = self%bytes(first:last)
    else
      if (last > len(self%bytes)) then
        allocate (character(len=2*last) :: larger)
        larger(:self%at) = self%bytes(:self%at)
        call move_alloc(larger, self%bytes)
      end if
      self%bytes(self%at + 1:last) = label//block
    end if
    self%at = last
  end subroutine exchange_block

  subroutine exchange_reals(self, values)
    class(archive_t), intent(inout) :: self
    real(dp), intent(inout) :: values(:)
    character(len=8*size(values)) :: block
    block = transfer(values, block)
    call exchange_block(self, 'r', size(values), block)
    if (self%is_reading) values = transfer(block, values)
  end subroutine exchange_reals

  subroutine exchange_integers(self, values)
    class(archive_t), intent(inout) :: self
    integer, intent(inout) :: values(:)
    character(len=4*size(values)) :: block
    block = transfer(values, block)
    call exchange_block(self, 'i', size(values), block)
    if (self%is_reading) values = transfer(block, values)
  end subroutine exchange_integers

  subroutine exchange_long(self, value)
    class(archive_t), intent(inout) :: self
    integer(int64), intent(inout) :: value
    character(len=8) :: block
    block = transfer(value, block)
    call exchange_block(self, 'w', 1, block)
    if (self%is_reading) value = transfer(block, value)
  end subroutine exchange_long

  subroutine exchange_matrix(self, values)
    class(archive_t), intent(inout) :: self
    real(dp), intent(inout) :: values(:, :)
    integer :: j
    do j = 1, size(values, 2)
      call self%exchange(values(:, j))
    end do
  end subroutine exchange_matrix

  !> One number or several, each as an entry of its own.
  recursive subroutine exchange_real(self, value, b, c, d, e, f)
    class(archive_t), intent(inout) :: self
    real(dp), intent(inout) :: value
    real(dp), intent(inout), optional :: b, c, d, e, f
    real(dp) :: values(1)
    values = value
    call self%exchange(values)
    value = values(1)
    if (present(b)) call self%exchange(b, c, d, e, f)
  end subroutine exchange_real

  !> One number or several, each as an entry of its own.
  recursive subroutine exchange_integer(self, value, b, c)
    class(archive_t), intent(inout) :: self
    integer, intent(inout) :: value
    integer, intent(inout), optional :: b, c
    integer :: values(1)
    values = value
    call self%exchange(values)
    value = values(1)
    if (present(b)) call self%exchange(b, c)
  end subroutine exchange_integer

  subroutine exchange_logicals(self, values)
    class(archive_t), intent(inout) :: self
    logical, intent(inout) :: values(:)
    integer :: numbers(size(values))
    numbers = merge(1, 0, values)
    call self%exchange(numbers)
    values = numbers /= 0
  end subroutine exchange_logicals

  subroutine exchange_logical(self, value)
    class(archive_t), intent(inout) :: self
    logical, intent(inout) :: value
    logical :: values(1)
    values = value
    call self%exchange(values)
    value = values(1)
  end subroutine exchange_logical

  !> A text of any length, preceded by its length.
  subroutine exchange_text(self, text)
    class(archive_t), intent(inout) :: self
    character(len=:), allocatable, intent(inout) :: text
    integer :: length
    length = -1
    if (.not. self%is_reading) length = len(text)
    call self%exchange(length)
    if (self%is_reading) then
      if (length < 0 .or. length > len(self%bytes) - self%at - head) self%failed = .true.
      if (self%failed) return
      if (allocated(text)) deallocate (text)
      allocate (character(len=length) :: text)
    end if
    call exchange_block(self, 'c', length, text)
  end subroutine exchange_text
end module gudgeon_archive
