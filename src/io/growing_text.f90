!> A text that is assembled from many pieces without copying the existing text for each of them.
module growing_text
  implicit none
  private
  public :: growing_text_t

  type :: growing_text_t
    character(len=:), allocatable :: text   !! only its first `used` characters are valid
    integer :: used = 0
  contains
    procedure :: append
    procedure :: reserve
  end type growing_text_t

contains

  !> Append a piece.
  pure subroutine append(self, piece)
    class(growing_text_t), intent(inout) :: self
    character(len=*), intent(in) :: piece
    call self%reserve(len(piece))
    self%text(self%used + 1:self%used + len(piece)) = piece
    self%used = self%used + len(piece)
  end subroutine append

  !> Allocate memory for `more` additional characters.
  pure subroutine reserve(self, more)
    class(growing_text_t), intent(inout) :: self
    integer, intent(in) :: more
    integer, parameter :: first_length = 4096
    character(len=:), allocatable :: longer
    if (.not. allocated(self%text)) allocate (character(len=max(first_length, more)) :: self%text)
    if (self%used + more <= len(self%text)) return
    allocate (character(len=2*(self%used + more)) :: longer)
    longer(:self%used) = self%text(:self%used)
    call move_alloc(longer, self%text)
  end subroutine reserve
end module growing_text
