!> The Pinkus-Sternlicht film with its pressure (5.20) integrated exactly over the arc where it is positive. The closed
!> form (5.34-5.37) approximates this integral, well while the pin approaches the wall and poorly while it leaves.
module half_film
  use kinds, only: dp
  use constants, only: two_pi
  use film_law, only: film_motion_t, difference_derivatives
  use pinkus_sternlicht, only: pinkus_sternlicht_t, reduced_motion_t
  implicit none
  private
  public :: half_film_t

  !> To be made with `new_pinkus_sternlicht`.
  type, extends(pinkus_sternlicht_t) :: half_film_t
  contains
    procedure :: film_force
    procedure :: force_derivatives
  end type half_film_t

contains

  !> Integral of the positive pressure. In the angle a from the thickest place, z = exp(i a), u = 1 + eps cos a = h/c and
  !> A = eps W/2, B = eps_dot, the pressure is 6 mu (R/c)^2 Im[(A - iB)(4z + eps z^2)]/((2 + eps^2) u^2), positive on one
  !> arc. With Sommerfeld's angle g, exp(i g) = (cos a + eps + i sqrt(1-eps^2) sin a)/u, and c = cos a, s = sin a,
  !>
  !>     f_r = 6P/(2+eps^2) [-2A c^2/u + B (s(3 eps - 2(1-eps^2)c)/(u(1-eps^2)) - (2+eps^2) g/(1-eps^2)^1.5)]
  !>     f_t = 6P/(2+eps^2) [ 2A (g/sqrt(1-eps^2) - s c/u) + B c(2c - eps)/u ]
  !>
  !> between the arc's ends: Booker's integrals, arranged so that nothing cancels as eps -> 0. While the pin leaves the
  !> wall some digits cancel as eps -> 1: the relative error is about 1e-16/(1 - eps). No moment.
  pure subroutine film_force(self, motion, force, moment)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2)
    real(dp), intent(out) :: moment
    type(reduced_motion_t) :: state
    complex(dp) :: direction, sommerfeld
    complex(dp) :: ends(2)
    real(dp) :: strength, gap, root, u(2), arc, radial, tangential, scale, wedge
    force = 0
    moment = 0
    state = self%reduced(motion)
    wedge = state%wedge/2
    strength = sqrt(wedge**2 + state%ratio_rate**2)
    if (.not. strength > 0) return
    direction = cmplx(wedge, state%ratio_rate, dp)/strength
    associate (eps => state%ratio, eps_dot => state%ratio_rate, n => state%normal)
      gap = (1 - eps)*(1 + eps)
      root = sqrt(gap)
      ends = [pressure_zero(direction, eps), pressure_zero(-direction, eps)]
      u = thickness(ends, eps)
      associate (c => real(ends), s => aimag(ends))
        sommerfeld = cmplx(c(2) + eps, root*s(2), dp)*cmplx(c(1) + eps, -root*s(1), dp)
        arc = atan2(aimag(sommerfeld), real(sommerfeld))
        if (arc < 0) arc = arc + two_pi
        radial = -2*wedge*difference(c**2/u) &
          + eps_dot*(difference(s*(3*eps - 2*gap*c)/u) - (2 + eps**2)*arc/root)/gap
        tangential = 2*wedge*(arc/root - difference(s*c/u)) + eps_dot*difference(c*(2*c - eps)/u)
      end associate
      scale = 6*self%force_scale/(2 + eps**2)
      force = scale*(radial*n + tangential*[-n(2), n(1)])
    end associate
  end subroutine film_force

  pure function difference(values)
    real(dp), intent(in) :: values(2)
    real(dp) :: difference
    difference = values(2) - values(1)
  end function difference

  !> u = 1 + eps Re z, without cancellation where z -> -1 and eps -> 1.
  elemental function thickness(z, eps) result(u)
    complex(dp), intent(in) :: z   !! on the unit circle
    real(dp), intent(in) :: eps
    real(dp) :: u
    u = 1 + eps*real(z)
    if (real(z) < 0) u = 1 - eps + eps*aimag(z)**2/(1 - real(z))
  end function thickness

  !> The zero on the unit circle of Im[conj(d)(4z + eps z^2)] that is nearest to the unit vector d: the angle a of z solves
  !> an equation of Kepler's kind, a + arg(4 + eps z) = arg d. It lies within 0.26 rad of d; from the linear guess two
  !> Newton steps come closer than 1e-6, and the force feels the square of that, since the pressure is 0 there.
  pure function pressure_zero(d, eps) result(z)
    complex(dp), intent(in) :: d   !! on the unit circle
    real(dp), intent(in) :: eps
    complex(dp) :: z
    integer, parameter :: newton_steps = 2
    complex(dp) :: linear, quadratic
    real(dp) :: turn
    integer :: i
    z = rotated(d, -eps*aimag(d)/(4 + 2*eps*real(d)))
    do i = 1, newton_steps
      linear = conjg(d)*4*z
      quadratic = conjg(d)*eps*z**2
      turn = -(aimag(linear) + aimag(quadratic))/(real(linear) + 2*real(quadratic))
      z = rotated(z, turn)
    end do
  end function pressure_zero

  !> z turned by atan(tangent).
  pure function rotated(z, tangent)
    complex(dp), intent(in) :: z
    real(dp), intent(in) :: tangent
    complex(dp) :: rotated
    rotated = z*cmplx(1.0_dp, tangent, dp)/sqrt(1 + tangent**2)
  end function rotated

  !> By differences: not those of the closed form.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    call difference_derivatives(self, motion, derivatives)
  end subroutine force_derivatives
end module half_film
