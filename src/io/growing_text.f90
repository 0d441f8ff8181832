!> A text that is put together from many pieces, without a copy of what there is for each of them.
module growing_text
  implicit none
  private
  public :: growing_text_t

  type :: growing_text_t
    character(len=:), allocatable :: text   !! its first `used` characters count
    integer :: used = 0
  contains
    procedure :: append
    procedure :: make_room
  end type growing_text_t

contains

  !> Add a piece at the end.
  pure subroutine append(self, piece)
    class(growing_text_t), intent(inout) :: self
    character(len=*), intent(in) :: piece
    call self%make_room(len(piece))
    self%text(self%used + 1:self%used + len(piece)) = piece
    self%used = self%used + len(piece)
  end subroutine append

  !> Room for so many characters more.
  pure subroutine make_room(self, more)
    class(growing_text_t), intent(inout) :: self
    integer, intent(in) :: more
    integer, parameter :: first_length = 4096
    character(len=:), allocatable :: longer
    if (.not. allocated(self%text)) allocate (character(len=max(first_length, more)) :: self%text)
    if (self%used + more <= len(self%text)) return
    allocate (character(len=2*(self%used + more)) :: longer)
    longer(:self%used) = self%text(:self%used)
    call move_alloc(longer, self%text)
  end subroutine make_room
end module growing_text
