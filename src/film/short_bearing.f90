!> Ocvirk's film of a short bearing in closed form; only the positive part of the pressure acts.
module short_bearing
  use kinds, only: dp
  use constants, only: pi
  use film_law, only: film_motion_t, angles_of_film
  use finite_bearing, only: finite_bearing_t
  use root_search, only: bracket_t, next_abscissa, narrow
  implicit none
  private
  public :: short_bearing_t

  !> The variant `short` of the law of its parent.
  type, extends(finite_bearing_t) :: short_bearing_t
  contains
    procedure :: conflict
    procedure :: reduced_force
    procedure :: reduced_peak_and_flow
    procedure :: side_flow
    procedure :: pressure_field
  end type short_bearing_t

contains

  !> Report a condition of cavitation: the short bearing always uses the positive part of the pressure.
  pure subroutine conflict(self, key, wanted)
    class(short_bearing_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    if (self%cavitation /= 'none') return
    key = 'cavitation'
    wanted = 'none is for the variants table and direct: of the short bearing the positive pressure acts'
  end subroutine conflict

  !> P = 6 cos(phi - alpha) (lambda^2 - zeta^2)/H^3 where cos(phi - alpha) > 0, from phi = alpha - pi/2 to alpha + pi/2. The force
  !> consists of the integrals of cos^2 phi, cos phi sin phi and sin^2 phi over H^3 (Booker 1965). The second is 2 eps sin^3
  !> alpha/(1 - eps^2 sin^2 alpha)^2. The others are sums of integrals beyond an angle (`parts_beyond`): for a separating film on
  !> both sides of its thickest place; otherwise what remains of the full circle, (1 + 2 eps^2) pi/w^5 and pi/w^3, with w = sqrt(1 -
  !> eps^2). Nothing cancels near the wall, where the integrals of approach grow as w^-5 and those of separation stay bounded.
  pure subroutine reduced_force(self, eps_squared, b, t, radial, tangential)
    class(short_bearing_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: radial, tangential
    real(dp) :: eps, w2, gap, kappa, speed, c, s, parts(2), cc, cs, ss
    radial = 0
    tangential = 0
    speed = sqrt(b**2 + t**2)
    if (.not. speed > 0) return
    eps = sqrt(eps_squared)
    w2 = 1 - eps_squared
    gap = w2/(1 + eps)
    kappa = sqrt(w2)/(1 + eps)
    c = abs(b)/speed
    s = abs(t)/speed
    parts = parts_beyond(kappa*(1 + s), c, gap) + parts_beyond(kappa*c, 1 + s, gap)
    if (b > 0) parts = pi*[1 + 2*eps_squared, 1.0_dp] - parts
    cc = parts(1)/(w2**2*sqrt(w2))
    ss = parts(2)/(w2*sqrt(w2))
    cs = 2*eps*s**3/(w2 + eps_squared*c**2)**2
    radial = -4*self%half_length**2*(b*cc + abs(t)*cs)
    tangential = -4*self%half_length**2*(b*cs + abs(t)*ss)
    if (t < 0) tangential = -tangential
  end subroutine reduced_force

  !> The largest value of 6 lambda^2 cos(phi - alpha)/H^3, and 4 lambda, over V. At the maximum d ln P/dphi = 0, or (1 - eps cos
  !> phi) sin(phi - alpha) + 3 eps sin phi cos(phi - alpha) = 0, which has a solution between the end of the positive arc on the
  !> thick side of the thinnest film and that place, or alpha.
  pure subroutine reduced_peak_and_flow(self, eps_squared, b, t, most, flow)
    class(short_bearing_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: most, flow
    type(bracket_t) :: bracket
    real(dp) :: speed, eps, gap, alpha, lower, phi
    most = 0
    speed = sqrt(b**2 + t**2)
    flow = 4*self%half_length*speed
    if (.not. speed > 0) return
    eps = sqrt(eps_squared)
    gap = (1 - eps_squared)/(1 + eps)
    alpha = atan2(abs(t), b)
    lower = max(alpha - 0.5_dp*pi, 0.0_dp)
    bracket = bracket_t(lower, alpha, fall(lower), fall(alpha), 0, alpha - lower)
    do
      phi = next_abscissa(bracket)
      if (.not. (phi > bracket%a .and. phi < bracket%b)) exit
      call narrow(bracket, phi, fall(phi))
      if (.not. bracket%fb > 0) exit
    end do
    phi = bracket%b
    most = speed*6*self%half_length**2*cos(phi - alpha)/(gap + 2*eps*sin(0.5_dp*phi)**2)**3

  contains

    !> -H^4 dP/dphi over 6 lambda^2.
    pure real(dp) function fall(phi)
      real(dp), intent(in) :: phi
      fall = (gap + 2*eps*sin(0.5_dp*phi)**2)*sin(phi - alpha) + 3*eps*sin(phi)*cos(phi - alpha)
    end function fall
  end subroutine reduced_peak_and_flow

  !> Q = 2 R L |v*|.
  pure real(dp) function side_flow(self, motion) result(flow)
    class(short_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    associate (e => motion%eccentricity, v => motion%eccentricity_rate)
      flow = 4*self%half_length*self%pin_radius**2*norm2(v - 0.5_dp*motion%pin_speed*[-e(2), e(1)])
    end associate
  end function side_flow

  !> The positive part of the pressure p = 6 mu v*.r (L^2/4 - z^2)/h^3.
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

  !> The integrals of cos^2 phi/H^3 and sin^2 phi/H^3 from an angle phi to pi, times w^5 and w^3. With Sommerfeld's angle measured
  !> from the thickest film, tan(delta/2) = kappa cot(phi/2) = y/x, they are those of (2 sin^2(delta/2) - gap)^2 and sin^2(delta)
  !> from 0 to delta; below one radian power series are used, since the closed forms cancel there.
  pure function parts_beyond(y, x, gap) result(parts)
    real(dp), intent(in) :: y, x   !! >= 0, not both 0
    real(dp), intent(in) :: gap    !! 1 - eps
    real(dp) :: parts(2)
    integer, parameter :: terms = 13   !! of the series
    integer :: k
    real(dp), parameter :: ratio(2:terms) = [(1/real(2*k*(2*k + 1), dp), k=2, terms)]   !! of factorials of successive terms
    real(dp) :: delta, sine, both, square, fourth, term, power
    delta = 2*atan2(y, x)
    if (delta >= 1) then
      sine = 2*x*y/(x**2 + y**2)
      both = sine*(x + y)*(x - y)/(x**2 + y**2)
      square = delta - sine
      fourth = 1.5_dp*delta - 2*sine + 0.5_dp*both
      parts(2) = 0.5_dp*(delta - both)
    else   ! delta^(2k + 1)/(2k + 1)! times -1, 2^(2k - 1) - 2 and -2^(2k - 1), with alternating signs
      term = -delta**3/6
      power = 2
      square = -term
      fourth = 0
      parts(2) = -term*power
      do k = 2, terms
        term = -term*delta**2*ratio(k)
        power = 4*power
        square = square - term
        fourth = fourth + (power - 2)*term
        parts(2) = parts(2) - power*term
      end do
    end if
    parts(1) = fourth - 2*gap*square + gap**2*delta   ! of 4 sin^4, 2 sin^2 and 1
  end function parts_beyond
end module short_bearing
