!> Frictionless contact of a pin in a bore of nearly equal radius, in plane strain, for contact angles of any size.
module conformal
  use kinds, only: dp
  use constants, only: pi
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use trace_row, only: trace_row_t
  use contact_geometry, only: contact_geometry_t
  implicit none
  private
  public :: conformal_t

  !> D = g(x) + W x, with D = delta/c, x = f/(pi E* L c), and g(x) = x [P(y) - ln y], y = x/(1 + x). The polynomial P fits the exact
  !> solution for an elastic disk in a hole of an elastic plate within 4.5e-5, up to a contact half-angle of 83.5 degrees. W
  !> describes the deformation away from the contact, which depends on the support of the pin and on the thickness of the housing. W
  !> = ln 4 - 1 gives Johnson's law at small loads; a ring supported at 2, 3, 5 or 10 times the radius of the bore has -0.32, 0.26,
  !> 0.74, 1.19.
  !>
  !> Limits: the clearance must be small compared with the radius, the materials similar; friction does not influence the pressure.
  type, extends(contact_geometry_t) :: conformal_t
    real(dp) :: compliance = 0   !! W [-], >= -0.5, so that D increases with x
    real(dp) :: clearance = 1    !! c [m]
    real(dp) :: modulus = 0      !! pi E* L [N/m]
    real(dp) :: area = 1         !! L Rb [m^2]
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: elastic_force
    procedure :: slope
    procedure :: half_angle
    procedure :: pressure
    procedure :: total_pressure
    procedure :: add_columns
  end type conformal_t

  !> Coefficients of P, beginning with the constant.
  real(dp), parameter :: fit(0:6) = [2.26404928e-5_dp, 1.74709353_dp, -1.52090276_dp, 1.79797044_dp, -1.78288296_dp, &
    1.09851009_dp, -0.295968247_dp]

  real(dp), parameter :: widest = 0.892534_dp   !! b at the largest angle of the fit, tan(83.5 degrees/2)

contains

  subroutine parameters(self, list)
    class(conformal_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%material_parameters(list)
    call list%add('housing_compliance', self%compliance, &
      'compliance of pin and housing outside the contact; the default agrees with Johnson at small loads', &
      range='>= -0.5', default='0.386294', usual='0 to 10')
  end subroutine parameters

  subroutine prepare(self, bearing)
    class(conformal_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp) :: d, d_slope
    self%clearance = bearing%clearance
    self%modulus = pi*self%contact_modulus()*bearing%length
    self%area = bearing%length*bearing%radius
    call depth(load_of_arc(widest), self%compliance, d, d_slope)   ! at the end of the fit
    self%deepest = d*self%clearance
  end subroutine prepare

  pure function elastic_force(self, penetration) result(force)
    class(conformal_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration
    real(dp) :: force
    force = self%modulus*self%clearance*load(penetration/self%clearance, self%compliance)
  end function elastic_force

  !> Stiffness pi E* L/(g' + W).
  pure function slope(self, penetration, force)
    class(conformal_t), intent(in) :: self
    real(dp), intent(in) :: penetration, force
    real(dp) :: slope, x, d, d_slope
    x = load(penetration/self%clearance, self%compliance)
    call depth(x, self%compliance, d, d_slope)
    slope = force/(x*d_slope*self%clearance)
  end function slope

  !> x for a value of D, by Newton's method with bounds. D(x) is concave for small x, so that iterates from below remain below.
  pure real(dp) function load(d, compliance) result(x)
    real(dp), intent(in) :: d            !! [-], > 0
    real(dp), intent(in) :: compliance   !! W
    real(dp) :: low, high, next, reached, reached_slope
    integer :: i
    low = 0
    high = huge(high)
    x = d/(max(compliance + 1.05_dp, 0.5_dp) + max(0.0_dp, -log(d)))
    do i = 1, 200
      call depth(x, compliance, reached, reached_slope)
      if (reached > d) then
        high = x
      else
        low = x
      end if
      next = x - (reached - d)/reached_slope
      if (.not. (next >= low .and. next <= high)) next = merge(2*x, (low + high)/2, high >= huge(high))
      if (abs(next - x) <= 1e-15_dp*x) exit
      x = next
    end do
    x = next
  end function load

  !> D(x) and its derivative.
  pure subroutine depth(x, compliance, d, d_slope)
    real(dp), intent(in) :: x, compliance
    real(dp), intent(out) :: d, d_slope
    real(dp) :: y, p, p_slope
    integer :: i
    y = x/(1 + x)
    p = fit(6)
    p_slope = 0
    do i = 5, 0, -1
      p_slope = p_slope*y + p
      p = p*y + fit(i)
    end do
    p = p - log(y) + compliance
    d = x*p
    d_slope = p + (y*p_slope - 1)/(1 + x)
  end subroutine depth

  !> Persson's relation (1964) between load and contact half-angle a, b = tan(a/2), with the modulus of one body.
  pure real(dp) function load_of_arc(b) result(x)
    real(dp), intent(in) :: b
    x = 2*b**2*(b**2 + 1)/(2 - log(b**2 + 1) - 2*b**4)
  end function load_of_arc

  !> b = tan(a/2) for a load, by Newton's method for b^2, in which the difference of both sides is convex: from the right all
  !> iterates stay there.
  pure real(dp) function arc_of_load(x) result(b)
    real(dp), intent(in) :: x
    real(dp) :: u, change
    integer :: i
    u = min(1.0_dp, x)
    do i = 1, 60
      change = (2*u*(u + 1) - x*(2 - log(u + 1) - 2*u**2))/(4*u + 2 + x*(1/(u + 1) + 4*u))
      u = u - change
      if (change <= epsilon(u)*u) exit
    end do
    b = sqrt(u)
  end function arc_of_load

  !> Half-angle of the contact.
  pure real(dp) function half_angle(self, penetration)
    class(conformal_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    half_angle = 2*atan(arc_of_load(load(penetration/self%clearance, self%compliance)))
  end function half_angle

  !> Pressure along the arc, p Rb L/F = (2/pi) r/[q (1 + y^2)] + arsinh(r/sqrt(1 + y^2))/[pi b^2 q^2] with b = tan(a/2), y =
  !> tan(theta/2), r^2 = b^2 - y^2 and q^2 = b^2 + 1 (Persson 1964).
  pure real(dp) function pressure(self, half_angle, angle)
    class(conformal_t), intent(in) :: self
    real(dp), intent(in) :: half_angle, angle
    real(dp) :: b, y, r
    b = tan(0.5_dp*half_angle)
    y = tan(0.5_dp*angle)
    r = sqrt(max(0.0_dp, (b - y)*(b + y)))
    pressure = (2*r/(sqrt(b**2 + 1)*(1 + y**2)) + asinh(r/sqrt(1 + y**2))/(b**2*(b**2 + 1)))/pi
  end function pressure

  !> Int p Rb L/F dtheta = [2 b^4 + ln(1 + b^2)]/[b^2 (1 + b^2)], b = tan(a/2): the integral of Persson's pressure. For small arcs
  !> ln(1 + u) = 2 artanh[u/(2 + u)] keeps its digits.
  pure real(dp) function total_pressure(self, half_angle)
    class(conformal_t), intent(in) :: self
    real(dp), intent(in) :: half_angle
    real(dp) :: u
    u = tan(0.5_dp*half_angle)**2
    total_pressure = 2*(u + atanh(u/(2 + u))/u)/(1 + u)
  end function total_pressure

  !> Add the half-angle of the contact to a row, which follows from the penetration, and the pressure in its middle, which follows
  !> from the normal force.
  pure subroutine add_columns(self, penetration, normal_force, row)
    class(conformal_t), intent(in) :: self
    real(dp), intent(in) :: penetration, normal_force
    type(trace_row_t), intent(inout) :: row
    real(dp) :: half_angle, peak
    half_angle = 0
    peak = 0
    if (row%wants(2) .and. penetration > 0) then
      half_angle = self%half_angle(penetration)
      peak = normal_force/self%area*self%pressure(half_angle, 0.0_dp)
    end if
    call row%add('contact_half_angle[rad]', half_angle, 'half-angle of the arc on which pin and bearing touch; 0 without contact')
    call row%add('peak_pressure[Pa]', peak, 'largest contact pressure; 0 without contact')
  end subroutine add_columns
end module conformal
