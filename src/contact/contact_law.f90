!> The normal force of a contact: the elastic force of the geometry, and the damping of the law.
module contact_law
  use kinds, only: dp
  use model_parameters, only: law_t
  use bearing_size, only: bearing_t
  use contact_geometry, only: contact_geometry_t
  implicit none
  private
  public :: contact_law_t, ratio_limit

  !> Upper limit of delta_dot/delta_dot_minus. In a free impact the ratio is at most 1. It exceeds 1 only if a load accelerates the
  !> pin into the wall, and would be unbounded for impact speeds near 0.
  real(dp), parameter :: ratio_limit = 100

  !> A compliant normal contact between pin and bearing, F = f(delta) [1 + chi delta_dot/delta_dot_minus]: f is given by the
  !> geometry; a law sets chi in `prepare`. With `has_own_damping` the force is f (1 + a delta_dot), where a is the `dissipation`,
  !> independent of the impact speed; a law with another form of damping overrides `damped_force` and its derivatives.
  type, abstract, extends(law_t) :: contact_law_t
    class(contact_geometry_t), allocatable :: geometry
    real(dp) :: damping = 0                    !! chi [-], >= 0
    real(dp) :: dissipation = 0                !! a [s/m], >= 0
    real(dp) :: least_impact_speed = 1e-5_dp   !! slower impacts are damped as if they had this speed [m/s], > 0
    logical :: has_own_damping = .false.
    logical :: may_lose_force = .false.        !! `damped_force` becomes negative where its force would pull; then none acts
    real(dp), private :: three_halves = 0      !! K [N/m^1.5] if f is K delta^1.5 and is damped by chi; otherwise 0
  contains
    procedure :: prepare
    procedure, non_overridable :: prepare_geometry
    procedure, non_overridable :: normal_force
    procedure, non_overridable :: damped_by
    procedure, non_overridable :: normal_force_slopes
    procedure :: damped_force
    procedure :: damped_force_slopes
    procedure :: find_share
    procedure :: remembers_impact => forgets_it
    procedure, non_overridable :: free_impact_speed
    procedure, nopass :: is_elastic => no
  end type contact_law_t

contains

  !> Whether the force is elastic whatever the parameters. The default is no.
  pure logical function no()
    no = .false.
  end function no

  !> Whether the damping of a contact depends on the speed at which it began, for as long as it lasts. The default is no.
  pure logical function forgets_it(self)
    class(contact_law_t), intent(in) :: self
    forgets_it = .false.
  end function forgets_it

  !> Impact speed [m/s] of a contact that has not begun with an impact, since it is present at the start: that of the free impact
  !> which reaches this penetration. It loses its speed while m v^2 [chi - ln(1 + chi)]/chi^2 becomes the elastic energy; without
  !> damping m v^2/2. The mass is in the deceleration by the elastic force. The energy of a rate is added.
  pure real(dp) function free_impact_speed(self, penetration, penetration_rate, deceleration) result(speed)
    class(contact_law_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate   !! [m], > 0; [m/s]
    real(dp), intent(in) :: deceleration                    !! of the penetration by the elastic force [m/s^2]
    real(dp) :: share
    share = 0.5_dp - self%damping/3   ! two terms of the series, where the closed form cancels
    if (self%damping > 1e-4_dp) share = (self%damping - log(1 + self%damping))/self%damping**2
    speed = sqrt(penetration_rate**2 + max(0.0_dp, deceleration)/share* &
      self%geometry%elastic_energy(penetration)/self%geometry%elastic_force(penetration))
  end function free_impact_speed

  !> Prepare the law for a bearing, before the first evaluation of the force.
  subroutine prepare(self, bearing)
    class(contact_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    call self%prepare_geometry(bearing)
  end subroutine prepare

  !> Prepare the geometry. For the most common one its constant is stored, so that the force is computed without a call of the
  !> geometry in every right-hand side.
  subroutine prepare_geometry(self, bearing)
    class(contact_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    call self%geometry%prepare(bearing)
    self%three_halves = 0
    if (.not. self%has_own_damping) self%three_halves = self%geometry%three_halves
  end subroutine prepare_geometry

  !> The normal force [N] between pin and bearing, positive in compression.
  !>
  !> (4.7) with two limits: the force is never negative (it is 0 where the bracket is negative), and the ratio of the rates is at
  !> most `ratio_limit`. In this ratio an impact slower than `least_impact_speed` has that speed. Without this limit the damping
  !> would become a discontinuous switch as the impact speed vanishes, and the equations stiffer than any time scale of the contact.
  !> Such an impact loses less energy: a free impact of speed v has the restitution for chi v/least_impact_speed, and becomes more
  !> elastic as v decreases, as for metals. A pin that is in its bearing at t = 0 has the impact speed of `free_impact_speed`. The
  !> difference from the elastic force has the sign of the rate, so that the law always dissipates energy. The force is continuous
  !> in both arguments.
  pure function normal_force(self, penetration, penetration_rate, impact_speed) result(force)
    class(contact_law_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration       !! |e| - c [m]; the force is 0 if it is not positive
    real(dp), value, intent(in) :: penetration_rate  !! its rate [m/s], positive while the penetration increases
    real(dp), value, intent(in) :: impact_speed      !! penetration_rate at the beginning of the contact [m/s], >= 0
    real(dp) :: force
    if (self%three_halves > 0) then
      force = 0
      if (penetration > 0) force = self%three_halves*penetration*sqrt(penetration)*bracket(self, penetration_rate, impact_speed)
    else
      force = any_normal_force(self, penetration, penetration_rate, impact_speed)
    end if
  end function normal_force

  !> The normal force for any geometry and any damping.
  pure function any_normal_force(self, penetration, penetration_rate, impact_speed) result(force)
    class(contact_law_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration, penetration_rate, impact_speed
    real(dp) :: force
    force = 0
    if (penetration > 0) &
      force = self%damped_by(self%geometry%elastic_force(penetration), penetration, penetration_rate, impact_speed)
  end function any_normal_force

  !> The normal force for a given elastic force [N], > 0; other arguments as for `normal_force`.
  pure real(dp) function damped_by(self, elastic_force, penetration, penetration_rate, impact_speed) result(force)
    class(contact_law_t), intent(in) :: self
    real(dp), intent(in) :: elastic_force, penetration, penetration_rate, impact_speed
    if (self%has_own_damping) then
      force = self%damped_force(elastic_force, penetration, penetration_rate)
      if (self%may_lose_force) force = max(0.0_dp, force)
    else
      force = elastic_force*bracket(self, penetration_rate, impact_speed)
    end if
  end function damped_by

  !> 1 + chi delta_dot/delta_dot_minus, within its limits.
  pure real(dp) function bracket(self, penetration_rate, impact_speed)
    class(contact_law_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration_rate, impact_speed
    bracket = 1
    if (self%damping > 0) bracket = max(0.0_dp, 1 + self%damping*min(penetration_rate/ &
      max(impact_speed, self%least_impact_speed), ratio_limit))
  end function bracket

  !> Derivatives of the force with respect to the penetration [N/m] and its rate [N s/m], for implicit integration; arguments as for
  !> `normal_force`. Both are 0 where the force is 0.
  pure subroutine normal_force_slopes(self, penetration, penetration_rate, impact_speed, stiffness, damping)
    class(contact_law_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate, impact_speed
    real(dp), intent(out) :: stiffness, damping
    real(dp) :: force
    stiffness = 0
    damping = 0
    force = self%normal_force(penetration, penetration_rate, impact_speed)
    if (.not. force > 0) return
    if (self%has_own_damping) then
      call self%damped_force_slopes(penetration, penetration_rate, stiffness, damping)
      return
    end if
    stiffness = self%geometry%slope(penetration, force)
    if (.not. self%damping > 0) return
    associate (speed => max(impact_speed, self%least_impact_speed))
      if (penetration_rate <= ratio_limit*speed) damping = self%geometry%elastic_force(penetration)*self%damping/speed
    end associate
  end subroutine normal_force_slopes

  !> The damped over the elastic force of a law that may lose its force, without the limit 0, and its rate along the motion [1/s].
  !> It is 1 at the beginning and the end of a contact, where its rate may have no limit. Without contact it exceeds 1 and increases
  !> with the distance, so that a search sees it rise. Other laws do not override this.
  pure subroutine find_share(self, penetration, penetration_rate, penetration_acceleration, share, share_rate)
    class(contact_law_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate   !! [m], [m/s]
    real(dp), intent(in) :: penetration_acceleration        !! [m/s^2]
    real(dp), intent(out) :: share, share_rate
    share = 1
    share_rate = 0
  end subroutine find_share

  !> The normal force [N] of a law with `has_own_damping`; negative only if the law `may_lose_force`.
  pure function damped_force(self, elastic_force, penetration, penetration_rate) result(force)
    class(contact_law_t), intent(in) :: self
    real(dp), value, intent(in) :: elastic_force      !! [N], > 0
    real(dp), value, intent(in) :: penetration        !! [m], > 0
    real(dp), value, intent(in) :: penetration_rate   !! [m/s]
    real(dp) :: force
    force = elastic_force*max(0.0_dp, 1 + self%dissipation*penetration_rate)
  end function damped_force

  !> Derivatives of `damped_force` with respect to the penetration [N/m] and its rate [N s/m].
  pure subroutine damped_force_slopes(self, penetration, penetration_rate, stiffness, damping)
    class(contact_law_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate
    real(dp), intent(out) :: stiffness, damping
    real(dp) :: elastic
    elastic = self%geometry%elastic_force(penetration)
    stiffness = self%geometry%slope(penetration, self%damped_force(elastic, penetration, penetration_rate))
    damping = elastic*self%dissipation
  end subroutine damped_force_slopes
end module contact_law
