!> The four-stroke cycle: 720 degrees long, with the cylinder closed from 180 to 540 degrees.
module four_stroke
  use kinds, only: dp
  use number_text, only: short_text
  use constants, only: pi
  use wiebe_law, only: wiebe_law_t
  implicit none
  private
  public :: four_stroke_t

  type, extends(wiebe_law_t) :: four_stroke_t
  contains
    procedure :: conflict
    procedure :: timing
  end type four_stroke_t

contains

  pure subroutine conflict(self, key, wanted)
    class(four_stroke_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'must be <= 540 - start_deg = '//short_text(540 - self%start_deg)//': the cylinder opens at 540'
    if (self%start_deg + self%duration_deg > 540) key = 'duration_deg'
  end subroutine conflict

  pure subroutine timing(self, period, half_closed)
    class(four_stroke_t), intent(in) :: self
    real(dp), intent(out) :: period, half_closed
    period = 4*pi
    half_closed = pi
  end subroutine timing
end module four_stroke
