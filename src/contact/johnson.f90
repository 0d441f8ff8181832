!> Johnson's contact of a cylinder in a cylindrical bore (Contact Mechanics, 1985), in which both are treated as half-spaces near
!> the contact.
module johnson
  use kinds, only: dp
  use constants, only: pi
  use bearing_size, only: bearing_t
  use contact_geometry, only: contact_geometry_t
  implicit none
  private
  public :: johnson_t

  !> D = x [ln(4/x) - 1], with D = delta/c and x = f/(pi E* L c). There is no solution for D > 4/e^2 = 0.541, and the stiffness
  !> grows without bound as D approaches this value; therefore the force continues linearly from D = 0.3, beyond the validity of the
  !> law.
  type, extends(contact_geometry_t) :: johnson_t
    real(dp) :: clearance = 1    !! c [m]
    real(dp) :: modulus = 0      !! pi E* L [N/m]
    real(dp) :: last_v = 2       !! v (see below) at the largest penetration of the law
  contains
    procedure :: prepare
    procedure :: elastic_force
    procedure :: slope
    procedure :: elastic_energy
  end type johnson_t

  real(dp), parameter :: last = 0.3_dp   !! largest D for which the law is used

contains

  subroutine prepare(self, bearing)
    class(johnson_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    self%clearance = bearing%clearance
    self%modulus = pi*self%contact_modulus()*bearing%length
    self%last_v = log_term(last)
    self%deepest = last*self%clearance   ! there the linear part begins
  end subroutine prepare

  !> v = ln(4/x) - 1 = D/x, > 1: the root of v - ln v = -ln(e D/4), which is -W(-(e/4) D) with the lower branch of Lambert's
  !> function. Newton's method from an initial guess within a few percent.
  pure real(dp) function log_term(d) result(v)
    real(dp), intent(in) :: d   !! D [-], > 0 and <= 0.3
    real(dp) :: m, correction
    integer :: i
    m = log(4.0_dp) - 1 - log(d)
    v = m + log(m + log(m + 1))
    do i = 1, 20
      correction = (v - log(v) - m)*v/(v - 1)
      v = v - correction
      if (abs(correction) <= 1e-15_dp*v) exit
    end do
  end function log_term

  pure function elastic_force(self, penetration) result(force)
    class(johnson_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration
    real(dp) :: force
    if (penetration <= self%deepest) then
      force = self%modulus*penetration/log_term(penetration/self%clearance)
    else
      force = self%modulus*(self%deepest/self%last_v + (penetration - self%deepest)/(self%last_v - 1))
    end if
  end function elastic_force

  !> Stiffness pi E* L/(v - 1).
  pure function slope(self, penetration, force)
    class(johnson_t), intent(in) :: self
    real(dp), intent(in) :: penetration, force
    real(dp) :: slope, v
    if (penetration <= self%deepest) then
      v = log_term(penetration/self%clearance)
      slope = force/penetration*(v/(v - 1))
    else
      slope = force/self%elastic_force(penetration)*(self%modulus/(self%last_v - 1))
    end if
  end function slope

  !> Elastic energy pi E* L c^2 [x^2 (v - 1)/2 + x^2/4].
  pure real(dp) function elastic_energy(self, penetration) result(energy)
    class(johnson_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    real(dp) :: depth, v
    depth = min(penetration, self%deepest)
    v = log_term(depth/self%clearance)
    energy = self%modulus*(depth/v)**2*(v/2 - 0.25_dp)
    if (penetration > depth) energy = energy + (penetration - depth)*(self%elastic_force(depth) &
      + self%elastic_force(penetration))/2
  end function elastic_energy
end module johnson
