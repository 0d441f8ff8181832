!> The four-stroke cycle: 720 degrees long, with the cylinder closed from 180 to 540 degrees.
module four_stroke
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use gudgeon_parameters, only: parameter_list_t
  use wiebe_law, only: wiebe_law_t
  implicit none
  private
  public :: four_stroke_t

  type, extends(wiebe_law_t) :: four_stroke_t
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: closes
    procedure :: opens
    procedure :: period
  end type four_stroke_t

contains

  subroutine parameters(self, list)
    class(four_stroke_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%wiebe_parameters(list)
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(four_stroke_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'start_deg + duration_deg must be <= 540, where the cylinder opens'
    if (self%start_deg + self%duration_deg > 540) key = 'duration_deg'
  end subroutine conflict

  pure real(dp) function closes(self)
    class(four_stroke_t), intent(in) :: self
    associate (unused => self)
    end associate
    closes = pi
  end function closes

  pure real(dp) function opens(self)
    class(four_stroke_t), intent(in) :: self
    associate (unused => self)
    end associate
    opens = 3*pi
  end function opens

  pure real(dp) function period(self)
    class(four_stroke_t), intent(in) :: self
    associate (unused => self)
    end associate
    period = 4*pi
  end function period
end module four_stroke
