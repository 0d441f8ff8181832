!> Lankarani-Nikravesh contact (4.7): Hertz contact with a hysteresis loss set by the restitution and the impact speed.
module lankarani_nikravesh
  use kinds, only: dp
  use hertz, only: hertz_t
  implicit none
  private
  public :: lankarani_nikravesh_t, ratio_limit

  !> Upper bound of delta_dot/delta_dot_minus. In a free impact the ratio is 1 at most; it exceeds 1 only where a load
  !> drives the pin on, and would grow without bound as the impact becomes a grazing one.
  real(dp), parameter :: ratio_limit = 100

  !> F = K delta^n [1 + chi delta_dot/delta_dot_minus], chi = (3/4)(1 - e^2).
  type, extends(hertz_t) :: lankarani_nikravesh_t
    real(dp) :: damping = 0   !! chi [-], 0 to 3/4
  contains
    procedure :: normal_force
    procedure :: normal_force_slopes
    procedure :: set_restitution
  end type lankarani_nikravesh_t

contains

  !> Set the loss from the coefficient of restitution e, 0 to 1. The law gives back somewhat more than e: with its own
  !> restitution e*, chi (1 + e*) = ln[(1 + chi)/(1 - chi e*)] exactly, whatever the mass, stiffness and exponent.
  pure subroutine set_restitution(self, restitution)
    class(lankarani_nikravesh_t), intent(inout) :: self
    real(dp), intent(in) :: restitution
    self%damping = 0.75_dp*(1 - restitution**2)
  end subroutine set_restitution

  !> (4.7), bounded on both sides: the force never pulls (it is 0 where the bracket is negative), and the ratio of the
  !> rates counts as `ratio_limit` where it is above. At an impact speed of 0 the ratio is therefore `ratio_limit`
  !> while the pin goes deeper, 0 at rest, and the force is 0 while the pin withdraws; the law dissipates in every
  !> case. The force is continuous in the penetration always, and in its rate except where the impact speed is 0.
  pure function normal_force(self, penetration, penetration_rate, impact_speed) result(force)
    class(lankarani_nikravesh_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration, penetration_rate, impact_speed
    real(dp) :: force
    force = 0
    if (penetration <= 0) return
    if (self%damping*penetration_rate < -impact_speed) return
    force = self%elastic_force(penetration)
    if (penetration_rate > ratio_limit*impact_speed) then
      force = force*(1 + self%damping*ratio_limit)
    else if (impact_speed > 0) then
      force = force*max(0.0_dp, 1 + self%damping*(penetration_rate/impact_speed))
    end if
  end function normal_force

  pure subroutine normal_force_slopes(self, penetration, penetration_rate, impact_speed, stiffness, damping)
    class(lankarani_nikravesh_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate, impact_speed
    real(dp), intent(out) :: stiffness, damping
    real(dp) :: force
    stiffness = 0
    damping = 0
    force = self%normal_force(penetration, penetration_rate, impact_speed)
    if (.not. force > 0) return
    stiffness = self%exponent*force/penetration
    if (penetration_rate <= ratio_limit*impact_speed .and. impact_speed > 0) &
      damping = self%elastic_force(penetration)*self%damping/impact_speed
  end subroutine normal_force_slopes
end module lankarani_nikravesh
