!> The two-stroke cycle with ports controlled by the piston: 360 degrees long, with the cylinder closed from `port_opens_deg` before
!> the firing dead centre to the same angle after it.
module two_stroke
  use kinds, only: dp
  use number_text, only: short_text
  use constants, only: two_pi, degree
  use model_parameters, only: parameter_list_t
  use wiebe_law, only: wiebe_law_t
  implicit none
  private
  public :: two_stroke_t

  type, extends(wiebe_law_t) :: two_stroke_t
    real(dp) :: port_opens_deg = 0   !! from the firing dead centre [degrees]
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: timing
  end type two_stroke_t

contains

  subroutine parameters(self, list)
    class(two_stroke_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%wiebe_parameters(list)
    call list%add('port_opens_deg', self%port_opens_deg, &
      'crank angle after the firing dead centre at which the ports open; they close as much before it', 'degrees', &
      '> 0 and <= 180', example='105.0', usual='70 to 150')
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(two_stroke_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = ''
    if (self%start_deg < 360 - self%port_opens_deg) then
      key = 'start_deg'
      wanted = 'must be >= 360 - port_opens_deg = '//short_text(360 - self%port_opens_deg)//', where the ports close'
    else if (self%start_deg + self%duration_deg > 360 + self%port_opens_deg) then
      key = 'duration_deg'
      wanted = 'must be <= 360 + port_opens_deg - start_deg = '//short_text(360 + self%port_opens_deg - self%start_deg)// &
        ', where the ports open'
    end if
  end subroutine conflict

  pure subroutine timing(self, period, half_closed)
    class(two_stroke_t), intent(in) :: self
    real(dp), intent(out) :: period, half_closed
    period = two_pi
    half_closed = self%port_opens_deg*degree
  end subroutine timing
end module two_stroke
