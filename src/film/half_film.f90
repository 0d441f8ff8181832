!> The Pinkus-Sternlicht film with its pressure (5.20) integrated exactly over the arc where it is positive. The closed form
!> (5.34-5.37) approximates this integral, well while the pin approaches the wall and poorly while it separates from it.
module half_film
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use film_law, only: film_motion_t, difference_derivatives
  use pinkus_sternlicht, only: pinkus_sternlicht_t, max_eccentricity_ratio
  implicit none
  private
  public :: half_film_t, first_guess, turn_between

  !> Coefficients of y, y x, y x^2, y x^3, y^3, y^3 x in the initial guess of the root t of `terms_at_zeros`: a least-squares fit
  !> over the disc |x + i y| <= 1, computed by tests/test_half_film_guess.f90. Its error is at most 3.1e-3.
  real(dp), parameter :: first_guess(6) = [-0.125016720340661_dp, 0.062511782496429_dp, -0.02863078399815_dp, &
    0.013439865718855_dp, 0.012887033929145_dp, -0.020353783206739_dp]

  !> The variant `half_film` of the law of its parent.
  type, extends(pinkus_sternlicht_t) :: half_film_t
    !> Sign of d at the two zeros of the pressure. A component, since a compiler that knows its values does not vectorise the loop.
    real(dp), private :: side(2) = [1, -1]
  contains
    procedure :: serves
    procedure :: film_force
    procedure :: force_derivatives
  end type half_film_t

contains

  pure logical function serves(self, variant)
    class(half_film_t), intent(in) :: self
    character(len=*), intent(in) :: variant
    associate (unused => self)
    end associate
    serves = variant == 'half_film'
  end function serves

  !> Force of the positive pressure. With the angle a from the thickest film, z = exp(i a), u = 1 + eps cos a = h/c, A = eps W/2 and
  !> B = eps_dot, the pressure is 6 mu (R/c)^2 Im[(A - iB)(4z + eps z^2)]/((2 + eps^2) u^2), which is positive on one arc. With
  !> Sommerfeld's angle g, exp(i g) = (cos a + eps + i sqrt(1-eps^2) sin a)/u, and c = cos a, s = sin a, the force is
  !>
  !>     f_r = 6P/(2+eps^2) [-2A c^2/u + B (s(3 eps - 2(1-eps^2)c)/(u(1-eps^2)) - (2+eps^2) g/(1-eps^2)^1.5)]
  !>     f_t = 6P/(2+eps^2) [ 2A (g/sqrt(1-eps^2) - s c/u) + B c(2c - eps)/u ]
  !>
  !> between the ends of the arc. These are Booker's integrals in a form in which no terms cancel as eps -> 0. While the pin
  !> separates from the wall some digits cancel as eps -> 1: the relative error is about 1e-15/(1 - eps).
  !>
  !> Multiplied by eps^3, the brackets contain only eps^2, eps A, eps B, eps c and eps s, and n is e/(c eps): no square root of the
  !> eccentricity is needed. A^2 + B^2 is the square of w, the velocity of the pin in clearances relative to axes that rotate at
  !> half the pin speed.
  pure subroutine film_force(self, motion, force, moment)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2)
    real(dp), intent(out) :: moment
    real(dp), parameter :: centred = 1e-60_dp    !! if eps^2 is smaller, the pin is treated as centred
    real(dp), parameter :: at_rest = 1e-100_dp   !! if |w| [1/s] is smaller, the force is 0
    real(dp), parameter :: held = max_eccentricity_ratio
    real(dp) :: e(2), w(2), square, gap, root, a, b, speed, scale, radial, tangential, turn
    real(dp), dimension(2) :: cosine, sine, radials, tangentials
    force = 0
    moment = 0
    e = motion%eccentricity*self%per_clearance
    square = e(1)**2 + e(2)**2
    if (square > held**2) then
      e = e*(held/sqrt(square))
      square = held**2
    end if
    w(1) = motion%eccentricity_rate(1)*self%per_clearance + 0.5_dp*motion%pin_speed*e(2)
    w(2) = motion%eccentricity_rate(2)*self%per_clearance - 0.5_dp*motion%pin_speed*e(1)
    speed = sqrt(w(1)**2 + w(2)**2)
    if (square < centred) then
      force(1) = -6*pi*self%force_scale*w(1)
      force(2) = -6*pi*self%force_scale*w(2)
    else if (speed > at_rest) then
      gap = 1 - square
      root = sqrt(gap)
      scale = 6*self%force_scale/((2 + square)*square**2*gap*root)
      a = e(2)*w(1) - e(1)*w(2)   ! eps A
      b = e(1)*w(1) + e(2)*w(2)   ! eps B
      call terms_at_zeros(self%side, a, b, 1/speed, square, gap, root, cosine, sine, radials, tangentials)
      turn = square*turn_between(cosine(1)*cosine(2) + sine(1)*sine(2), sine(2)*cosine(1) - sine(1)*cosine(2))
      radial = scale*(root*(radials(2) - radials(1)) - (b*(2 + square))*turn)
      tangential = scale*(root*(tangentials(2) - tangentials(1)) + (2*a*gap)*turn)
      force(1) = radial*e(1) - tangential*e(2)
      force(2) = radial*e(2) + tangential*e(1)
    end if
    if (self%film_moment) moment = self%shear_moment(motion, force)
  end subroutine film_force

  !> The zeros of Im[conj(d)(4z + eps z^2)] on the unit circle, nearest to d and to -d, for eps d = x + i y, and the terms of the
  !> force at them. With z = d (1 + i t)/(1 - i t) the first zero is the small root, |t| < 0.13, of
  !>
  !>     f = y + (8 + 4x) t - 6 y t^2 + (8 - 4x) t^3 + y t^4 = 0,
  !>
  !> and the second one the same with -x, -y instead of x, y. From an initial guess within 3.1e-3 one step of a fourth-order
  !> iteration reaches 1e-10; its error enters the force squared, since the pressure is 0 there. At the zeros, `cosine` and `sine`
  !> are those of Sommerfeld's angle g times a positive factor; `radial` and `tangential` are the brackets of the force without the
  !> terms in g, times (1 - eps^2) eps^3.
  !>
  !> The loop has no branches and the directive makes the compiler vectorise it over the two zeros; sums are arranged in pairs,
  !> since the latency of dependent operations determines the time.
  pure subroutine terms_at_zeros(side, a, b, per_speed, square, gap, root, cosine, sine, radial, tangential)
    real(dp), intent(in) :: side(2)
    real(dp), value, intent(in) :: a, b, per_speed     !! eps A, eps B, and 1/|(A, B)|
    real(dp), value, intent(in) :: square, gap, root   !! eps^2, 1 - eps^2 and its square root
    real(dp), intent(out) :: cosine(2), sine(2), radial(2), tangential(2)
    real(dp) :: x, y, one, three, t, ty, tt, per_slope, miss, curve, twist, n, c, s, weight
    integer :: i
    !GCC$ vector
    do i = 1, 2
      x = side(i)*(a*per_speed)
      y = side(i)*(b*per_speed)
      one = 8 + 4*x
      three = 8 - 4*x
      t = y*((first_guess(1) + first_guess(2)*x) + x**2*(first_guess(3) + first_guess(4)*x) &
        + y**2*(first_guess(5) + first_guess(6)*x))
      ty = t*y
      tt = t**2
      per_slope = 1/((one - 12*ty) + tt*(3*three + 4*ty))             ! 1/f'
      miss = ((y + t*one) + tt*((t*three - 6*y) + t*ty))*per_slope    ! f/f'
      curve = ((t*(3*three) - 6*y) + 6*t*ty)*per_slope                ! f''/(2 f')
      twist = (three + 4*ty)*per_slope                                ! f'''/(6 f')
      t = (t - miss) - miss**2*(curve + miss*(2*curve**2 - twist))
      ! eps cos a = c/n, eps sin a = s/n
      tt = t**2
      n = 1 + tt
      c = (x - 2*y*t) - tt*x
      s = (y + 2*x*t) - tt*y
      weight = (n - c)/(n*(n**2*gap + s**2))   ! 1/(n^2 u): n + c would cancel in the thin film
      cosine(i) = ((x + square) - 2*y*t) + tt*(square - x)
      sine(i) = root*s
      radial(i) = weight*(b*(s*(3*square*n - 2*gap*c)) - (2*a*gap)*c**2)
      tangential(i) = (weight*gap)*(c*(b*(2*c - square*n) - (2*a)*s))
    end do
  end subroutine terms_at_zeros

  !> The angle in [0, 2 pi] with the given cosine and sine, both times the same positive factor: what the intrinsic atan2 gives, in
  !> half of its instructions and with a relative error of at most 4e-16. With q = min(|cosine|, |sine|)/max(|cosine|, |sine|),
  !> atan q is atan r with r = q where q <= tan(pi/8), and pi/4 + atan r with r = (q - 1)/(q + 1) above.
  pure real(dp) function turn_between(cosine, sine) result(turn)
    real(dp), value, intent(in) :: cosine, sine
    real(dp), parameter :: tangent = 0.41421356237309503_dp   !! tan(pi/8)
    real(dp), parameter :: start(0:15) = 0.25_dp*pi*[0, 1, 2, 1, 4, 3, 2, 3, 8, 7, 6, 7, 4, 5, 6, 5]
    real(dp), parameter :: way(0:7) = [1, -1, -1, 1, -1, 1, 1, -1]
    !> Coefficients of (atan r - r)/r^3 in powers of r^2 for r <= tan(pi/8), by interpolation at Chebyshev's points; with them the
    !> relative error of atan r is at most 5.5e-18, but for rounding
    real(dp), parameter :: k(0:10) = [-0.3333333333333333016_dp, 0.19999999999995520678_dp, -0.14285714284666542922_dp, &
      0.11111111015256361727_dp, -0.090909045781239018905_dp, 0.076921831908260865637_dp, -0.066645114473819480001_dp, &
      0.058581489128022098816_dp, -0.050854497379402598613_dp, 0.039231658295587191303_dp, -0.019176887119062258989_dp]
    real(dp) :: larger, smaller, one, r, r2, r4, r8
    integer :: part, half
    larger = max(abs(cosine), abs(sine))
    smaller = min(abs(cosine), abs(sine))
    half = merge(1, 0, smaller > tangent*larger)
    part = merge(1, 0, abs(sine) > abs(cosine)) + merge(2, 0, cosine < 0) + merge(4, 0, sine < 0)
    one = half
    r = (smaller - one*larger)/(larger + one*smaller)
    r2 = r**2
    r4 = r2**2
    r8 = r4**2
    r = r + r*(r2*(((k(0) + k(1)*r2) + r4*(k(2) + k(3)*r2)) &
      + r8*(((k(4) + k(5)*r2) + r4*(k(6) + k(7)*r2)) + r8*((k(8) + k(9)*r2) + r4*k(10)))))
    turn = start(2*part + half) + way(part)*r
  end function turn_between

  !> Derivatives by differences; those of the closed form are not valid here.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    call difference_derivatives(self, motion, derivatives)
  end subroutine force_derivatives
end module half_film
