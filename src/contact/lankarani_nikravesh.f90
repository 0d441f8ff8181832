!> Lankarani-Nikravesh contact (4.7): Hertz contact with a hysteresis loss set by the restitution and the impact speed.
module lankarani_nikravesh
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: parameter_list_t
  use gudgeon_bearing, only: bearing_t
  use hertz, only: hertz_t
  implicit none
  private
  public :: lankarani_nikravesh_t, ratio_limit

  !> Upper bound of delta_dot/delta_dot_minus. In a free impact the ratio is 1 at most; it exceeds 1 only where a load
  !> drives the pin on, and would grow without bound as the impact becomes a grazing one.
  real(dp), parameter :: ratio_limit = 100

  !> F = K delta^n [1 + chi delta_dot/delta_dot_minus], chi = (3/4)(1 - e^2).
  type, extends(hertz_t) :: lankarani_nikravesh_t
    real(dp) :: restitution = 1            !! coefficient of restitution e of the case [-]
    real(dp) :: damping = 0                !! chi [-], 0 to 3/4
    real(dp) :: least_impact_speed = 1e-5_dp   !! slower impacts are damped as one of this speed [m/s], > 0
  contains
    procedure, nopass :: name
    procedure :: parameters
    procedure :: prepare
    procedure :: normal_force
    procedure :: normal_force_slopes
    procedure :: set_restitution
  end type lankarani_nikravesh_t

contains

  pure function name()
    character(len=:), allocatable :: name
    name = 'lankarani_nikravesh'
  end function name

  subroutine parameters(self, list)
    class(lankarani_nikravesh_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('restitution', self%restitution, 'coefficient of restitution', range='>= 0 and <= 1', default='0.9')
    call self%hertz_t%parameters(list)
    call list%add('least_impact_speed', self%least_impact_speed, 'slower impacts are damped as one of this speed', 'm/s', &
      '>= 1e-9 and <= 1', default='1.0e-5')
  end subroutine parameters

  subroutine prepare(self, bearing)
    class(lankarani_nikravesh_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    call self%hertz_t%prepare(bearing)
    call self%set_restitution(self%restitution)
  end subroutine prepare

  !> Set the loss from the coefficient of restitution e, 0 to 1. The law gives back somewhat more than e: with its own
  !> restitution e*, chi (1 + e*) = ln[(1 + chi)/(1 - chi e*)] exactly, whatever the mass, stiffness and exponent.
  pure subroutine set_restitution(self, restitution)
    class(lankarani_nikravesh_t), intent(inout) :: self
    real(dp), intent(in) :: restitution
    self%damping = 0.75_dp*(1 - restitution**2)
  end subroutine set_restitution

  !> (4.7), bounded on both sides: the force never pulls (it is 0 where the bracket is negative), and the ratio of the
  !> rates counts as `ratio_limit` where it is above. An impact slower than `least_impact_speed` counts as that fast in the
  !> ratio: without that the law becomes a switch as the impact speed vanishes, stiffer than any time scale of the contact.
  !> Such an impact loses less: the free impact of speed v comes back as from chi v/least_impact_speed, ever more
  !> elastic, as metals do. A pin that starts pressed into its bearing has the impact speed 0 and the
  !> damping of this speed, and comes to rest where the elastic force carries its load. The force beyond the elastic one has
  !> the sign of the rate: the law dissipates in every case. It is continuous in both arguments.
  pure function normal_force(self, penetration, penetration_rate, impact_speed) result(force)
    class(lankarani_nikravesh_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration, penetration_rate, impact_speed
    real(dp) :: force
    associate (speed => max(impact_speed, self%least_impact_speed))
      force = 0
      if (penetration > 0) force = self%elastic_force(penetration)* &
        max(0.0_dp, 1 + self%damping*min(penetration_rate/speed, ratio_limit))
    end associate
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
    associate (speed => max(impact_speed, self%least_impact_speed))
      if (penetration_rate <= ratio_limit*speed) damping = self%elastic_force(penetration)*self%damping/speed
    end associate
  end subroutine normal_force_slopes
end module lankarani_nikravesh
