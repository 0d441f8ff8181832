!> A text that is put together from many pieces, without a copy of what there is for each of them.
module growing_text
  implicit none
  private
  public :: growing_text_t

  type :: growing_text_t
    private
    character(len=:), allocatable :: buffer   !! with room behind the text
    integer :: used = 0                       !! its length
  contains
    procedure :: append
    procedure :: take
  end type growing_text_t

contains

  !> Add a piece at the end.
  pure subroutine append(self, piece)
    class(growing_text_t), intent(inout) :: self
    character(len=*), intent(in) :: piece
    integer, parameter :: first_length = 4096
    character(len=:), allocatable :: longer
    integer :: needed
    needed = self%used + len(piece)
    if (.not. allocated(self%buffer)) allocate (character(len=max(first_length, needed)) :: self%buffer)
    if (needed > len(self%buffer)) then
      allocate (character(len=2*needed) :: longer)
      longer(:self%used) = self%buffer(:self%used)
      call move_alloc(longer, self%buffer)
    end if
    self%buffer(self%used + 1:needed) = piece
    self%used = needed
  end subroutine append

  !> The text, which is empty again afterwards.
  pure subroutine take(self, text)
    class(growing_text_t), intent(inout) :: self
    character(len=:), allocatable, intent(out) :: text
    text = ''
    if (allocated(self%buffer)) text = self%buffer(:self%used)
    self%used = 0
  end subroutine take
end module growing_text
