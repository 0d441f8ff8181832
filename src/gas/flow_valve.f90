!> A self-acting valve of a compressor with a spring. Without mass the difference of the pressures, in the sense in which it opens,
!> lifts it against its spring,
!>
!>     x = l min(1, max(0, (dp A_f - F_0)/(k l))),    flow area A x/l,
!>
!> with the area A_f on which dp presses, preload F_0, stiffness k, and the area A at the full lift l. Without a spring it is fully
!> open as soon as dp > 0. It lets no gas back. With a mass its lift is a state (`valve_reeds`), and gas flows both ways.
module flow_valve
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  implicit none
  private
  public :: flow_valve_t, suction, discharge

  integer, parameter :: suction = 1, discharge = 2

  type, extends(has_parameters_t) :: flow_valve_t
    character(len=:), allocatable :: port
    real(dp) :: area = 0         !! A, with the discharge coefficient [m^2]
    real(dp) :: lift = 0         !! l [m]
    real(dp) :: force_area = 0   !! A_f [m^2]
    real(dp) :: stiffness = 0    !! k [N/m]
    real(dp) :: preload = 0      !! F_0 [N]
    real(dp) :: mass = 0         !! M of the moving part; 0: it follows at once [kg]
    real(dp) :: damping = 0      !! d, of its speed [N s/m]
  contains
    procedure :: parameters
    procedure, non_overridable :: open_share
    procedure, non_overridable :: opening_force
    procedure, non_overridable :: full_force
  end type flow_valve_t

contains

  subroutine parameters(self, list)
    class(flow_valve_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('port', self%port, 'both, suction, discharge', 'both', 'which valve; both: one group for both')
    call list%add('area', self%area, 'effective area of the flow at full lift, discharge coefficient included', 'm^2', '> 0', &
      example='2.0e-4', usual='1e-7 to 0.1')
    call list%add('lift', self%lift, 'full lift', 'm', '> 0', example='1.0e-3', usual='1e-4 to 5e-3')
    call list%add('force_area', self%force_area, 'area on which the difference of the pressures presses', 'm^2', '>= 0', &
      default='0.0', usual='1e-7 to 0.1')
    call list%add('stiffness', self%stiffness, 'stiffness of its spring; 0: fully open as soon as the pressure opens it', 'N/m', &
      '>= 0', default='0.0', usual='10 to 1e5')
    call list%add('preload', self%preload, 'force of the spring on the closed valve', 'N', '>= 0', default='0.0', &
      usual='0.01 to 1e3')
    call list%add('mass', self%mass, 'moving mass of its reed or plate; 0: the lift follows the pressures at once', 'kg', '>= 0', &
      default='0.0', usual='1e-5 to 0.2')
    call list%add('damping', self%damping, 'force against the speed of this mass, over the speed', 'N s/m', '>= 0', default='0.0', &
      usual='0.01 to 100')
  end subroutine parameters

  !> Lift over full lift at a difference of the pressures [Pa], positive where it opens [-].
  pure real(dp) function open_share(self, difference)
    class(flow_valve_t), intent(in) :: self
    real(dp), intent(in) :: difference
    if (self%stiffness > 0) then
      open_share = min(1.0_dp, max(0.0_dp, (difference*self%force_area - self%preload)/(self%stiffness*self%lift)))
    else
      open_share = merge(1.0_dp, 0.0_dp, difference > 0)
    end if
  end function open_share

  !> dp A_f - F_0 [N].
  pure real(dp) function opening_force(self, difference)
    class(flow_valve_t), intent(in) :: self
    real(dp), intent(in) :: difference   !! dp [Pa]
    opening_force = difference*self%force_area - self%preload
  end function opening_force

  !> Force of the spring at full lift, F_0 + k l [N].
  pure real(dp) function full_force(self)
    class(flow_valve_t), intent(in) :: self
    full_force = self%preload + self%stiffness*self%lift
  end function full_force
end module flow_valve
