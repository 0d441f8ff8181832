!> Rows of a trace that one thread has found, on their way to another that writes them.
module row_queue
  use kinds, only: dp
  use thread, only: semaphore_t
  use trace_table, only: trace_table_t
  implicit none
  private
  public :: row_queue_t

  integer, parameter :: n_blocks = 3, rows_per_block = 128

  !> A ring of blocks of rows. The finder fills one while the writer writes another; who has none waits. There need not be a
  !> writer: until one serves, `offer` takes no row, and the finder writes them itself.
  type :: row_queue_t
    private
    type(trace_table_t), pointer :: table => null()
    real(dp), allocatable :: rows(:, :, :)     !! values of a row, rows, blocks
    integer :: length(0:n_blocks - 1) = 0      !! rows in each block; 0 is the end of all
    integer :: filling = 0                     !! the block that the finder fills
    logical :: is_served = .false.             !! by a writer
    logical :: is_used = .false.               !! rows have gone to the writer
    logical :: is_filling = .false.            !! some wait in the block that is being filled
    type(semaphore_t) :: filled, free          !! blocks
  contains
    procedure :: begin
    procedure :: set_table
    procedure :: offer
    procedure :: settle
    procedure :: end => end_queue
    procedure :: serve
  end type row_queue_t

contains

  !> Before there is a writer. The queue stays where it is from here on.
  subroutine begin(self)
    class(row_queue_t), intent(inout) :: self
    call self%filled%prepare(0)
    call self%free%prepare(n_blocks)
  end subroutine begin

  !> The finder: the table that rows of so many values are to be written to, before the first is offered.
  subroutine set_table(self, table, n_values)
    class(row_queue_t), intent(inout) :: self
    type(trace_table_t), intent(in), target :: table
    integer, intent(in) :: n_values
    self%table => table
    allocate (self%rows(n_values, rows_per_block, 0:n_blocks - 1))
  end subroutine set_table

  !> The finder: hand over a row, if there is a writer. From the first that is taken on, the table is the writer's.
  subroutine offer(self, row, is_taken)
    class(row_queue_t), intent(inout) :: self
    real(dp), intent(in), contiguous :: row(:)
    logical, intent(out) :: is_taken
    !$omp atomic read
    is_taken = self%is_served
    if (.not. is_taken) return
    if (.not. self%is_filling) call take_block(self)
    associate (length => self%length(self%filling))
      length = length + 1
      self%rows(:, length, self%filling) = row
      if (length == rows_per_block) call send_block(self)
    end associate
  end subroutine offer

  subroutine take_block(self)
    class(row_queue_t), intent(inout) :: self
    call self%free%take()
    self%length(self%filling) = 0
    self%is_filling = .true.
  end subroutine take_block

  subroutine send_block(self)
    class(row_queue_t), intent(inout) :: self
    self%filling = mod(self%filling + 1, n_blocks)
    self%is_filling = .false.
    self%is_used = .true.
    call self%filled%give()
  end subroutine send_block

  !> The finder: wait until all rows that were taken are in the table, which is the finder's again until the next `offer`.
  subroutine settle(self)
    class(row_queue_t), intent(inout) :: self
    integer :: i
    if (self%is_filling) call send_block(self)
    if (.not. self%is_used) return
    do i = 1, n_blocks
      call self%free%take()
    end do
    do i = 1, n_blocks
      call self%free%give()
    end do
  end subroutine settle

  !> The finder: no row comes any more. The writer, now or when it comes, is done with the last.
  subroutine end_queue(self)
    class(row_queue_t), intent(inout) :: self
    call self%settle()
    call take_block(self)
    call send_block(self)
  end subroutine end_queue

  !> The writer: write rows until there come no more. This makes no text.
  subroutine serve(self)
    class(row_queue_t), intent(inout) :: self
    integer :: block, i
    !$omp atomic write
    self%is_served = .true.
    block = 0
    do
      call self%filled%take()
      if (self%length(block) == 0) exit
      do i = 1, self%length(block)
        call self%table%put_row(self%rows(:, i, block))
      end do
      call self%free%give()
      block = mod(block + 1, n_blocks)
    end do
  end subroutine serve
end module row_queue
