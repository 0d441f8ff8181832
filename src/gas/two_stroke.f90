!> The two-stroke cycle with ports controlled by the piston: 360 degrees long, with the cylinder closed from `port_opens_deg` before
!> the firing dead centre to the same angle after it. Where the cylinder axis has an offset they close at the same height of the
!> piston, a few degrees beside that angle.
module two_stroke
  use kinds, only: dp
  use constants, only: two_pi, degree
  use model_parameters, only: parameter_list_t
  use ideal_linkage, only: linkage_t
  use gas_law, only: turning_forwards
  use wiebe_law, only: wiebe_law_t
  implicit none
  private
  public :: two_stroke_t

  type, extends(wiebe_law_t) :: two_stroke_t
    real(dp) :: port_opens_deg = 0   !! from the firing dead centre [degrees]
  contains
    procedure :: parameters
    procedure :: misfit
    procedure :: timing
  end type two_stroke_t

contains

  subroutine parameters(self, list)
    class(two_stroke_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%wiebe_parameters(list)
    call list%add('port_opens_deg', self%port_opens_deg, &
      'crank angle after the firing dead centre at which the ports open; they close at the same height of the piston before it', &
      'degrees', '> 0 and <= 180', example='105.0', usual='70 to 150')
  end subroutine parameters

  !> The ports must open before the piston is lowest.
  subroutine misfit(self, linkage, sense, key, wanted)
    class(two_stroke_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense
    character(len=:), allocatable, intent(out) :: key, wanted
    real(dp), parameter :: rounding = 1e-9_dp   ! [rad]
    real(dp) :: closes, opens
    call self%wiebe_misfit(linkage, sense, key, wanted)
    call self%timing(turning_forwards(linkage, sense), closes, opens)
    if (opens - closes <= two_pi + rounding) return
    key = 'port_opens_deg'
    wanted = 'must be below the angle of the bottom dead centre'
  end subroutine misfit

  !> The ports close at the height x of the piston at which they open: at 2 atan(d/x) - q, where that is at q.
  pure subroutine timing(self, linkage, closes, opens)
    class(two_stroke_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(out) :: closes, opens
    real(dp) :: after, height
    after = self%port_opens_deg*degree
    height = linkage%piston_position(linkage%top_angle() + after)
    opens = two_pi + after
    closes = two_pi - after + 2*(atan2(linkage%axis_offset, height) - linkage%top_angle())
  end subroutine timing
end module two_stroke
