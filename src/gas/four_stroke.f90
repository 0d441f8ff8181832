!> The four-stroke cycle: 720 degrees long, with the cylinder closed for a turn from the first bottom dead centre on, at 180 degrees
!> without an offset of its axis.
module four_stroke
  use kinds, only: dp
  use constants, only: two_pi
  use ideal_linkage, only: linkage_t
  use wiebe_law, only: wiebe_law_t
  implicit none
  private
  public :: four_stroke_t

  type, extends(wiebe_law_t) :: four_stroke_t
  contains
    procedure :: revolutions
    procedure :: timing
  end type four_stroke_t

contains

  pure integer function revolutions(self)
    class(four_stroke_t), intent(in) :: self
    revolutions = 2
  end function revolutions

  pure subroutine timing(self, linkage, closes, opens)
    class(four_stroke_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(out) :: closes, opens
    closes = linkage%bottom_angle() - linkage%top_angle()
    opens = two_pi + closes
  end subroutine timing
end module four_stroke
