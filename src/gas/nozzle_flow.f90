!> Flow of an ideal gas through an orifice, without friction and heat: from pressure p_1 and temperature T_1 to p_2 <= p_1,
!>
!>     m' = A p_1/sqrt(R_g T_1) psi(p_2/p_1),    psi(r) = sqrt(2 g/(g - 1) (a^2 - a r)),    a = r^(1/g)
!>
!> and not more than at the critical ratio. Its slope has no bound at r = 1; from r = 1 - e on psi is the parabola through the value
!> there and 0 at r = 1 with the slope of a laminar flow, which changes the flow through an orifice by some 1e-5 of that of a valve.
module nozzle_flow
  use kinds, only: dp
  implicit none
  private
  public :: orifice_flow

  real(dp), parameter :: narrow = 1e-3_dp   !! e

contains

  !> Mass flow [kg/s] from side 1 to side 2; negative if it flows back.
  pure real(dp) function orifice_flow(area, gas_constant, ratio, pressure, temperature) result(flow)
    real(dp), intent(in) :: area                      !! effective area [m^2]
    real(dp), intent(in) :: gas_constant              !! R_g [J/(kg K)]
    real(dp), intent(in) :: ratio                     !! g, ratio of the heat capacities [-]
    real(dp), intent(in) :: pressure(2), temperature(2)   !! [Pa], [K]
    integer :: from
    flow = 0
    if (.not. area > 0) return
    from = merge(1, 2, pressure(1) >= pressure(2))
    flow = area*pressure(from)/sqrt(gas_constant*temperature(from))*flow_function(minval(pressure)/pressure(from), ratio)
    if (from == 2) flow = -flow
  end function orifice_flow

  !> psi at a ratio r of the pressures [-].
  pure real(dp) function flow_function(r, g) result(psi)
    real(dp), intent(in) :: r, g
    real(dp) :: y
    y = (1 - r)/narrow
    psi = smooth_flow(max(min(r, 1 - narrow), (2/(g + 1))**(g/(g - 1))), g)
    if (y < 1) psi = psi*y*(3 - y)/2
  end function flow_function

  !> sqrt(2 g/(g - 1) (a^2 - a r)).
  pure real(dp) function smooth_flow(r, g)
    real(dp), intent(in) :: r, g
    real(dp) :: a
    a = r**(1/g)
    smooth_flow = sqrt(2*g/(g - 1)*a*(a - r))
  end function smooth_flow
end module nozzle_flow
