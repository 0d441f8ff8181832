!> The Pinkus-Sternlicht film with its pressure (5.20) integrated exactly over the arc where it is positive. The closed form
!> (5.34-5.37) approximates this integral, well while the pin approaches the wall and poorly while it separates from it.
module half_film
  use kinds, only: dp
  use constants, only: pi
  use film_law, only: film_motion_t, difference_derivatives
  use pinkus_sternlicht, only: pinkus_sternlicht_t, max_eccentricity_ratio
  implicit none
  private
  public :: half_film_t, cubic_scale, cubic_share, turn_between

  real(dp), parameter :: cubic_scale = 2.08_dp   !! constant in the argument of `cubic_share`
  real(dp), parameter :: turn_scale = 2.4_dp     !! constant in the argument of `turn_share`

  !> The variant `half_film` of the law of its parent.
  type, extends(pinkus_sternlicht_t) :: half_film_t
  contains
    procedure :: film_force
    procedure :: force_derivatives
  end type half_film_t

contains

  !> Force of the positive pressure. With the angle a from the thickest film, z = exp(i a), u = 1 + eps cos a = h/c, A = eps W/2,
  !> B = eps_dot and V^2 = A^2 + B^2, the pressure is 6 mu (R/c)^2 Im[(A - iB)(4z + eps z^2)]/((2 + eps^2) u^2). It is positive on
  !> one arc, whose ends are two of the four roots of this quartic in z. The resolvent cubic of the quartic has one positive root s:
  !>
  !>     s (p + s)^2 = (eps B/V)^2/4,   p = 1 - eps^2/4 .
  !>
  !> With k = p + s, m^2 = 1 + s (1 + k) and r^2 = 2 + 2m + s, Booker's integrals between the two ends are
  !>
  !>     f_r = -6P/((2+eps^2)(1-eps^2)^1.5) [ (2+eps^2) B g + 2 (eps^2 (1+m) + 2s) V j/eps ]
  !>     f_t = 6P/((2+eps^2)(1-eps^2)^0.5) [ 2 A g + eps A B j/(k m V) ]
  !>
  !> where j = r sqrt(1-eps^2)/(1 + m + s), and g is the increase of Sommerfeld's angle over the arc,
  !>
  !>     g = pi + 2 arctan T,   T = sqrt(s) (1 + 2k + 2m)/(r sqrt(1-eps^2)) with the sign of B.
  !>
  !> No terms cancel as eps -> 0. While the pin separates from the wall, those of f_r cancel as eps -> 1: the relative error is
  !> about 1e-15/(1 - eps).
  !>
  !> Multiplied by eps, the brackets contain only eps^2, eps A and eps B, and n is e/(c eps): no square root of the eccentricity is
  !> needed. Of these only eps A depends on the speed of the pin, which is known last. Since the latency of dependent operations
  !> determines the time, sums are arranged in pairs, and g is multiplied last: its factors are computed at the same time as g.
  pure subroutine film_force(self, motion, force, moment)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2)
    real(dp), intent(out) :: moment
    real(dp), parameter :: centred = 1e-60_dp    !! if eps^2 is smaller, the pin is treated as centred
    real(dp), parameter :: at_rest = 1e-250_dp   !! if (eps V)^2 [1/s^2] is smaller, the force is 0
    real(dp), parameter :: held = max_eccentricity_ratio
    real(dp) :: e(2), rate(2), square, gap, scale, a, b, speed, p, cube, t, s, k, twice_m, reach, rise, product, turn
    real(dp) :: m4, radial, tangential, radial_turn, tangential_turn
    force = 0
    moment = 0
    e = motion%eccentricity*self%per_clearance
    rate = motion%eccentricity_rate*self%per_clearance
    square = e(1)**2 + e(2)**2
    if (square > held**2) then
      e = e*(held/sqrt(square))
      square = held**2
    end if
    b = e(1)*rate(1) + e(2)*rate(2)                                         ! eps B
    a = (e(2)*rate(1) - e(1)*rate(2)) + (0.5_dp*square)*motion%pin_speed    ! eps A
    speed = a**2 + b**2                                                     ! (eps V)^2
    if (square < centred) then
      force(1) = -6*pi*self%force_scale*(rate(1) + (0.5_dp*e(2))*motion%pin_speed)
      force(2) = -6*pi*self%force_scale*(rate(2) - (0.5_dp*e(1))*motion%pin_speed)
    else if (speed > at_rest) then
      gap = 1 - square
      scale = 6*self%force_scale/((2 + square)*square*(gap*sqrt(gap)))
      p = 1 - 0.25_dp*square
      cube = cubic_scale*p**3
      t = (square*b**2)/((square*b**2 + cube*b**2) + cube*a**2)
      s = (p*t)*cubic_share(t)
      k = p + s
      m4 = (4 + (4*(1 + p))*s) + (2*s)**2                                     ! 4 m^2
      twice_m = sqrt(m4)
      rise = s*(m4 + (1 + 2*k)**2) + (2*s*(1 + 2*k))*twice_m     ! T^2 r^2 (1 - eps^2)
      reach = gap*((2 + s) + twice_m)       ! r^2 (1 - eps^2)
      turn = turn_between(rise, reach, b)
      speed = speed*(1/square)              ! V^2
      product = 4*sqrt(reach*speed)*(1/((speed*k)*(twice_m*((2 + 2*s) + twice_m))))   ! j/(k m V)
      radial = -scale*((square*(2 + twice_m) + 4*s)*(0.5_dp*(speed*k)*twice_m)*product)
      tangential = (scale*gap)*((a*b)*product)
      radial_turn = -scale*(b*(2 + square))
      tangential_turn = (scale*gap)*(2*a)
      force(1) = (radial*e(1) - tangential*e(2)) + (radial_turn*e(1) - tangential_turn*e(2))*turn
      force(2) = (radial*e(2) + tangential*e(1)) + (radial_turn*e(2) + tangential_turn*e(1))*turn
    end if
    if (self%film_moment) moment = self%shear_moment(motion, force)
  end subroutine film_force

  !> The root s of the cubic s (p + s)^2 = c, 0 <= c <= 16 p^3/27, divided by p t, t = 4c/(4c + cubic_scale p^3). With s = p v it is
  !> v (1 + v)^2 = c/p^3, so this is a function of t alone: here the polynomial of degree 20 that interpolates it at Chebyshev's
  !> points, with a relative error of at most 1e-16, but for rounding. The value of `cubic_scale` makes the error small.
  pure real(dp) function cubic_share(t)
    real(dp), value, intent(in) :: t
    real(dp), parameter :: c(0:20) = [ &
      0.5199999999999999917_dp, -0.020799999999986129019_dp, 0.4226559999960014769_dp, -0.34311679952670640361_dp, &
      0.92531442707345073254_dp, -1.4847023131190706702_dp, 3.2131110718866081475_dp, -6.3575181118005078089_dp, &
      13.581002508142581614_dp, -28.792089078916102848_dp, 62.071938551855746433_dp, -131.7411336052516668_dp, &
      269.37585463016706731_dp, -509.50133696413986442_dp, 855.43365665038724409_dp, -1219.5097941285956276_dp, &
      1411.668000772503663_dp, -1259.7626741829618328_dp, 808.19586026505665465_dp, -330.77740314047136352_dp, &
      65.086740804764229019_dp]
    real(dp) :: t2, t4, t8
    t2 = t**2
    t4 = t2**2
    t8 = t4**2
    cubic_share = (((c(0) + c(1)*t) + t2*(c(2) + c(3)*t)) + t4*((c(4) + c(5)*t) + t2*(c(6) + c(7)*t))) &
      + t8*((((c(8) + c(9)*t) + t2*(c(10) + c(11)*t)) + t4*((c(12) + c(13)*t) + t2*(c(14) + c(15)*t))) &
      + t8*(((c(16) + c(17)*t) + t2*(c(18) + c(19)*t)) + t4*c(20)))
  end function cubic_share

  !> pi + 2 arctan T for T^2 = rise/reach and the sign of `direction`. With q = |T| or, if that is larger than 1, q = 1/|T|, the arc
  !> tangent of q is q `turn_share`(t), t = q^2/(q^2 + turn_scale).
  pure real(dp) function turn_between(rise, reach, direction) result(turn)
    real(dp), value, intent(in) :: rise, reach, direction
    real(dp), parameter :: start(0:3) = pi*[0, 1, 2, 1], way(0:3) = [2, -2, -2, 2]
    real(dp) :: smaller, larger, t
    integer :: part
    smaller = min(rise, reach)
    larger = max(rise, reach)
    part = merge(1, 0, rise < reach) + merge(2, 0, direction > 0)
    t = smaller/max(rise + turn_scale*reach, reach + turn_scale*rise)
    turn = start(part) + (way(part)*sqrt(smaller/larger))*turn_share(t)
  end function turn_between

  !> arctan(q)/q, 0 <= q <= 1, for t = q^2/(q^2 + turn_scale): the polynomial of degree 13 that interpolates it at Chebyshev's
  !> points, with a relative error of at most 1e-16, but for rounding.
  pure real(dp) function turn_share(t)
    real(dp), value, intent(in) :: t
    real(dp), parameter :: c(0:13) = [ &
      0.99999999999999991249_dp, -0.7999999999998832264_dp, 0.35199999997403818726_dp, -0.47085714057238887368_dp, &
      0.41782846592506281424_dp, -0.53428901055120460489_dp, 0.5818586174189887825_dp, -0.73852946142620156303_dp, &
      0.87355448803575160714_dp, -1.0861259582313950614_dp, 1.2249879475361968516_dp, -1.2179073026471973945_dp, &
      0.85681781734741698837_dp, -0.33306767151108949248_dp]
    real(dp) :: t2, t4, t8
    t2 = t**2
    t4 = t2**2
    t8 = t4**2
    turn_share = (((c(0) + c(1)*t) + t2*(c(2) + c(3)*t)) + t4*((c(4) + c(5)*t) + t2*(c(6) + c(7)*t))) &
      + t8*(((c(8) + c(9)*t) + t2*(c(10) + c(11)*t)) + t4*(c(12) + c(13)*t))
  end function turn_share

  !> Derivatives by differences; those of the closed form are not valid here.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    call difference_derivatives(self, motion, derivatives)
  end subroutine force_derivatives
end module half_film
