!> The IMPACT force of Adams and MotionSolve: a damper in parallel with the elastic force, whose coefficient rises with the
!> penetration.
module adams_impact
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: adams_impact_t

  !> F = max(0, f(delta) + c s^2 (3 - 2s) delta_dot), s = min(1, delta/d). The effective restitution depends on the impact speed and
  !> on the masses. While the pin moves out, the damper may cancel the elastic force, and later, at a smaller penetration, the force
  !> may act again.
  type, extends(contact_law_t) :: adams_impact_t
    real(dp) :: full_damping = 0        !! c [N s/m], >= 0
    real(dp) :: full_damping_depth = 1  !! d [m], > 0
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: damped_force
    procedure :: damped_force_slopes
    procedure :: find_share
  end type adams_impact_t

contains

  subroutine parameters(self, list)
    class(adams_impact_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('damping', self%full_damping, &
      'coefficient of the damper that acts beside the elastic force', 'N s/m', '>= 0', example='100.0', usual='0 to 1e7')
    call list%add('full_damping_depth', self%full_damping_depth, 'penetration above which the damper acts fully', 'm', '> 0', &
      example='1.0e-6', usual='1e-9 to 1e-3')
  end subroutine parameters

  subroutine prepare(self, bearing)
    class(adams_impact_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    self%has_own_damping = .true.
    self%may_lose_force = self%full_damping > 0
    call self%prepare_geometry(bearing)
  end subroutine prepare

  pure function damped_force(self, elastic_force, penetration, penetration_rate) result(force)
    class(adams_impact_t), intent(in) :: self
    real(dp), value, intent(in) :: elastic_force, penetration, penetration_rate
    real(dp) :: force, s
    s = min(1.0_dp, penetration/self%full_damping_depth)
    force = elastic_force + self%full_damping*s**2*(3 - 2*s)*penetration_rate
  end function damped_force

  pure subroutine damped_force_slopes(self, penetration, penetration_rate, stiffness, damping)
    class(adams_impact_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate
    real(dp), intent(out) :: stiffness, damping
    real(dp) :: s
    s = min(1.0_dp, penetration/self%full_damping_depth)
    damping = self%full_damping*s**2*(3 - 2*s)
    stiffness = self%geometry%slope(penetration, self%geometry%elastic_force(penetration)) &
      + self%full_damping*6*s*(1 - s)/self%full_damping_depth*penetration_rate
  end subroutine damped_force_slopes

  pure subroutine find_share(self, penetration, penetration_rate, penetration_acceleration, share, share_rate)
    class(adams_impact_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate, penetration_acceleration
    real(dp), intent(out) :: share, share_rate
    real(dp) :: elastic, stiffness, damping
    share = 1 - penetration/self%full_damping_depth
    share_rate = -penetration_rate/self%full_damping_depth
    if (.not. penetration > 0) return
    elastic = self%geometry%elastic_force(penetration)
    if (.not. elastic > 0) return   ! the smallest numbers
    share = self%damped_force(elastic, penetration, penetration_rate)/elastic
    call self%damped_force_slopes(penetration, penetration_rate, stiffness, damping)
    share_rate = ((stiffness - share*self%geometry%slope(penetration, elastic))*penetration_rate &
      + damping*penetration_acceleration)/elastic
  end subroutine find_share
end module adams_impact
