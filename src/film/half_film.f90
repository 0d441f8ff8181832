!> The Pinkus-Sternlicht film with its pressure (5.20) integrated exactly over the arc where it is positive. The closed form
!> (5.34-5.37) approximates this integral, well while the pin approaches the wall and poorly while it separates from it.
module half_film
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi, two_pi
  use film_law, only: film_motion_t, difference_derivatives
  use pinkus_sternlicht, only: pinkus_sternlicht_t, max_eccentricity_ratio
  implicit none
  private
  public :: half_film_t, first_guess

  !> Coefficients of y, y x, y x^2, y x^3, y^3, y^3 x in the initial guess of the root t of `terms_at_zeros`: a least-squares fit
  !> over the disc |x + i y| <= 1, computed by tests/test_half_film_guess.f90. Its error is at most 3.1e-3.
  real(dp), parameter :: first_guess(6) = [-0.125016720340661_dp, 0.062511782496429_dp, -0.02863078399815_dp, &
    0.013439865718855_dp, 0.012887033929145_dp, -0.020353783206739_dp]

  !> The variant `half_film` of the law of its parent.
  type, extends(pinkus_sternlicht_t) :: half_film_t
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
  !> eccentricity is needed.
  pure subroutine film_force(self, motion, force, moment)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2)
    real(dp), intent(out) :: moment
    real(dp), parameter :: centred = 1e-60_dp    !! if eps^2 is smaller, the pin is treated as centred
    real(dp), parameter :: at_rest = 1e-200_dp   !! if (eps A)^2 + (eps B)^2 [1/s^2] is smaller, the force is 0
    real(dp), parameter :: held = max_eccentricity_ratio
    real(dp) :: e(2), v(2), square, gap, root, a, b, strength, per_strength, scale, radial, tangential, arc
    real(dp) :: cosine(2), sine(2), terms(2, 4)
    force = 0
    moment = 0
    if (self%film_moment) moment = self%shear_moment(self%force_scale, motion, force)
    e = motion%eccentricity*self%per_clearance
    v = motion%eccentricity_rate*self%per_clearance
    square = e(1)**2 + e(2)**2
    if (square < centred) then
      force(1) = -6*pi*self%force_scale*(v(1) + 0.5_dp*motion%pin_speed*e(2))
      force(2) = -6*pi*self%force_scale*(v(2) - 0.5_dp*motion%pin_speed*e(1))
      if (self%film_moment) moment = self%shear_moment(self%force_scale, motion, force)
      return
    end if
    if (square > held**2) then
      e = e*(held/sqrt(square))
      square = held**2
    end if
    gap = 1 - square
    root = sqrt(gap)
    scale = 6*self%force_scale/((2 + square)*square**2*gap*root)
    a = 0.5_dp*square*motion%pin_speed - (e(1)*v(2) - e(2)*v(1))   ! eps A
    b = e(1)*v(1) + e(2)*v(2)                                      ! eps B
    strength = a**2 + b**2
    if (.not. strength > at_rest) return
    per_strength = sqrt(square*strength)*(1/strength)   ! eps over its root: square root and reciprocal are computed independently
    call terms_at_zeros(a*per_strength, b*per_strength, square, gap, root, cosine, sine, terms)
    radial = -2*a*gap*(terms(2, 1) - terms(1, 1)) + b*(terms(2, 2) - terms(1, 2))
    tangential = -2*a*gap*(terms(2, 3) - terms(1, 3)) + b*gap*(terms(2, 4) - terms(1, 4))
    force(1) = scale*root*(radial*e(1) - tangential*e(2))
    force(2) = scale*root*(radial*e(2) + tangential*e(1))
    ! the terms with g, whose factors do not depend on it
    radial = -scale*b*square*(2 + square)
    tangential = scale*2*a*gap*square
    arc = atan2(sine(2)*cosine(1) - sine(1)*cosine(2), cosine(1)*cosine(2) + sine(1)*sine(2))
    if (arc < 0) arc = arc + two_pi
    force(1) = force(1) + (radial*e(1) - tangential*e(2))*arc
    force(2) = force(2) + (radial*e(2) + tangential*e(1))*arc
    if (self%film_moment) moment = self%shear_moment(self%force_scale, motion, force)
  end subroutine film_force

  !> The zeros of Im[conj(d)(4z + eps z^2)] on the unit circle, nearest to d and to -d, for eps d = x + i y, and the terms of the
  !> force at them. With z = d (1 + i t)/(1 - i t) the first zero is the small root, |t| < 0.13, of
  !>
  !>     f = y + (8 + 4x) t - 6 y t^2 + (8 - 4x) t^3 + y t^4 = 0,
  !>
  !> and the second one the same with -x, -y instead of x, y. From an initial guess within 3.1e-3 one step of a fourth-order
  !> iteration reaches 1e-10; its error enters the force squared, since the pressure is 0 there. At the zeros, `cosine` and `sine`
  !> are those of Sommerfeld's angle g times a positive factor; `terms` are c^2/u, s (3 eps - 2 (1 - eps^2) c)/u, s c/u and c (2c -
  !> eps)/u, times eps^2.
  !>
  !> The loop has no branches, so that the compiler can vectorise it over the two zeros; sums are arranged in pairs, since the
  !> latency of dependent operations determines the time.
  pure subroutine terms_at_zeros(x, y, square, gap, root, cosine, sine, terms)
    real(dp), value, intent(in) :: x, y
    real(dp), value, intent(in) :: square, gap, root   !! eps^2, 1 - eps^2 and its square root
    real(dp), intent(out) :: cosine(2), sine(2), terms(2, 4)
    real(dp) :: dx(2), dy(2), one, three, t, ty, tt, per_slope, miss, curve, twist, n, c, s, weight
    integer :: i
    dx = [x, -x]
    dy = [y, -y]
    do i = 1, 2
      one = 8 + 4*dx(i)
      three = 8 - 4*dx(i)
      t = dy(i)*((first_guess(1) + first_guess(2)*dx(i)) + dx(i)**2*(first_guess(3) + first_guess(4)*dx(i)) &
        + dy(i)**2*(first_guess(5) + first_guess(6)*dx(i)))
      ty = t*dy(i)
      tt = t**2
      per_slope = 1/((one - 12*ty) + tt*(3*three + 4*ty))                               ! 1/f'
      miss = ((dy(i) + t*one) + tt*((t*three - 6*dy(i)) + t*ty))*per_slope              ! f/f'
      curve = ((t*(3*three) - 6*dy(i)) + 6*t*ty)*per_slope                              ! f''/(2 f')
      twist = (three + 4*ty)*per_slope                                                  ! f'''/(6 f')
      t = (t - miss) - miss**2*(curve + miss*(2*curve**2 - twist))
      ! eps cos a = c/n, eps sin a = s/n
      tt = t**2
      n = 1 + tt
      c = (dx(i) - 2*dy(i)*t) - tt*dx(i)
      s = (dy(i) + 2*dx(i)*t) - tt*dy(i)
      weight = (n - c)/(n*(n**2*gap + s**2))   ! 1/(n^2 u); n + c would cancel in a thin film
      cosine(i) = ((dx(i) + square) - 2*dy(i)*t) + tt*(square - dx(i))
      sine(i) = root*s
      terms(i, 1) = c**2*weight
      terms(i, 2) = s*(3*square*n - 2*gap*c)*weight
      terms(i, 3) = s*c*weight
      terms(i, 4) = c*(2*c - square*n)*weight
    end do
  end subroutine terms_at_zeros

  !> Derivatives by differences; those of the closed form are not valid here.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    call difference_derivatives(self, motion, derivatives)
  end subroutine force_derivatives
end module half_film
