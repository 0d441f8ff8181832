!> Ocvirk's film of a short bearing, of whose pressure only the positive part acts, in closed form.
module short_bearing
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi, two_pi
  use gudgeon_bearing, only: bearing_t
  use film_law, only: film_motion_t, angles_of_film
  use finite_bearing, only: finite_bearing_t
  implicit none
  private
  public :: short_bearing_t

  !> The variant `short` of the law of its parent.
  type, extends(finite_bearing_t) :: short_bearing_t
  contains
    procedure :: serves
    procedure :: conflict
    procedure :: reduced_force
    procedure :: reduced_peak_and_flow
    procedure :: pressure_field
  end type short_bearing_t

contains

  pure logical function serves(self, variant)
    class(short_bearing_t), intent(in) :: self
    character(len=*), intent(in) :: variant
    associate (unused => self)
    end associate
    serves = variant == 'short'
  end function serves

  !> The positive part of its pressure alone acts, whatever the cavitation is called.
  pure subroutine conflict(self, key, wanted)
    class(short_bearing_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    if (self%cavitation /= 'none') return
    key = 'cavitation'
    wanted = 'none is for the variants table and direct: of the short bearing the positive pressure acts'
  end subroutine conflict

  !> P = 6 cos(phi - alpha) (lambda^2 - zeta^2)/H^3 where cos(phi - alpha) > 0. With a = phi + pi and Sommerfeld's angle g,
  !> exp(i g) = (cos a + eps + i w sin a)/(1 + eps cos a), w = sqrt(1 - eps^2), the integrals of cos^2 a, cos a sin a and sin^2 a over
  !> (1 + eps cos a)^3 are
  !>
  !>     w^-5 [g (1/2 + eps^2) + sin g cos g/2 - 2 eps sin g],  w^-4 [sin^2 g/2 + eps cos g],  w^-3 [g - sin g cos g]/2
  !>
  !> from a = alpha + pi/2 to alpha + 3 pi/2 (Booker 1965).
  pure subroutine reduced_force(self, eps_squared, b, t, radial, tangential)
    class(short_bearing_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: radial, tangential
    real(dp) :: eps, w, speed, to(3), from(3), cc, cs, ss
    radial = 0
    tangential = 0
    speed = sqrt(b**2 + t**2)
    if (.not. speed > 0) return
    eps = sqrt(eps_squared)
    w = sqrt(1 - eps_squared)
    from = primitives(eps, w, atan2(t, b), b/speed, t/speed, 0.5_dp*pi)
    to = primitives(eps, w, atan2(t, b), b/speed, t/speed, 1.5_dp*pi)
    cc = (to(1) - from(1))/w**5
    cs = (to(2) - from(2))/w**4
    ss = (to(3) - from(3))/w**3
    radial = -4*self%half_length**2*(b*cc + t*cs)
    tangential = -4*self%half_length**2*(b*cs + t*ss)
  end subroutine reduced_force

  !> The largest of 6 lambda^2 cos(phi - alpha)/H^3, and 4 lambda, over V. At the peak d ln P/dphi = 0, that is
  !> (1 - eps cos phi) sin(phi - alpha) + 3 eps sin phi cos(phi - alpha) = 0; between the end of the positive arc on the thick film's
  !> side of the thinnest place and that place, or alpha, there is one.
  pure subroutine reduced_peak_and_flow(self, eps_squared, b, t, most, flow)
    class(short_bearing_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: most, flow
    real(dp) :: speed, eps, alpha, lower, upper, phi
    integer :: i
    most = 0
    speed = sqrt(b**2 + t**2)
    flow = 4*self%half_length*speed
    if (.not. speed > 0) return
    eps = sqrt(eps_squared)
    alpha = atan2(abs(t), b)
    lower = max(alpha - 0.5_dp*pi, 0.0_dp)
    upper = alpha
    do i = 1, 200   ! halved until nothing is left between
      phi = 0.5_dp*(lower + upper)
      if (.not. (phi > lower .and. phi < upper)) exit
      if ((1 - eps*cos(phi))*sin(phi - alpha) + 3*eps*sin(phi)*cos(phi - alpha) < 0) then
        lower = phi
      else
        upper = phi
      end if
    end do
    most = speed*6*self%half_length**2*cos(phi - alpha)/(1 - eps + 2*eps*sin(0.5_dp*phi)**2)**3
  end subroutine reduced_peak_and_flow

  !> The pressure p = 6 mu v*.r (L^2/4 - z^2)/h^3, its positive part.
  pure subroutine pressure_field(self, motion, angles, places, field)
    class(short_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), allocatable, intent(out) :: angles(:), places(:), field(:, :)
    integer, parameter :: along = 12
    real(dp) :: v(2), r(2), middle, direction
    integer :: i
    associate (e => motion%eccentricity)
      v = motion%eccentricity_rate - 0.5_dp*motion%pin_speed*[-e(2), e(1)]
      direction = 0
      if (norm2(e) > 0) direction = atan2(e(2), e(1))
      angles = angles_of_film(motion, self%per_clearance)
      places = [(real(i, dp)/along, i=0, along)]
      allocate (field(size(angles), size(places)))
      do i = 1, size(angles)
        r = [cos(angles(i) + direction), sin(angles(i) + direction)]
        middle = 6*self%viscosity*max(dot_product(v, r), 0.0_dp)*(self%half_length*self%pin_radius)**2 &
          /max(self%clearance - dot_product(e, r), 1e-6_dp*self%clearance)**3
        field(i, :) = middle*(1 - places**2)
      end do
    end associate
  end subroutine pressure_field

  !> The brackets above at a = alpha + beyond, `beyond` being pi/2 or 3 pi/2.
  pure function primitives(eps, w, alpha, cos_alpha, sin_alpha, beyond) result(brackets)
    real(dp), intent(in) :: eps, w, alpha, cos_alpha, sin_alpha, beyond
    real(dp) :: brackets(3), cos_a, sin_a, g, cosine, sine, a
    a = alpha + beyond
    cos_a = merge(-sin_alpha, sin_alpha, beyond < pi)
    sin_a = merge(cos_alpha, -cos_alpha, beyond < pi)
    g = atan2(w*sin_a, cos_a + eps)
    g = g + two_pi*nint((a - g)/two_pi)   ! the branch next to a
    cosine = (cos_a + eps)/(1 + eps*cos_a)
    sine = w*sin_a/(1 + eps*cos_a)
    brackets = [g*(0.5_dp + eps**2) + 0.5_dp*sine*cosine - 2*eps*sine, 0.5_dp*sine**2 + eps*cosine, &
      0.5_dp*(g - sine*cosine)]
  end function primitives
end module short_bearing
