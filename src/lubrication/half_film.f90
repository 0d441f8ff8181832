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
    complex(dp) :: sommerfeld
    real(dp) :: strength, gap, root, c(2), s(2), per_u(2), arc, radial, tangential, scale, wedge
    force = 0
    moment = 0
    state = self%reduced(motion)
    wedge = state%wedge/2
    strength = sqrt(wedge**2 + state%ratio_rate**2)
    if (.not. strength > 0) return
    associate (eps => state%ratio, eps_dot => state%ratio_rate, n => state%normal)
      gap = (1 - eps)*(1 + eps)
      root = sqrt(gap)
      call pressure_zeros(wedge/strength, eps_dot/strength, eps, c, s)
      per_u = 1/thickness(c, s, eps)
      sommerfeld = cmplx(c(2) + eps, root*s(2), dp)*cmplx(c(1) + eps, -root*s(1), dp)
      arc = atan2(aimag(sommerfeld), real(sommerfeld))
      if (arc < 0) arc = arc + two_pi
      radial = -2*wedge*difference(c**2*per_u) &
        + eps_dot*(difference(s*(3*eps - 2*gap*c)*per_u) - (2 + eps**2)*arc/root)/gap
      tangential = 2*wedge*(arc/root - difference(s*c*per_u)) + eps_dot*difference(c*(2*c - eps)*per_u)
      scale = 6*self%force_scale/(2 + eps**2)
      force = scale*(radial*n + tangential*[-n(2), n(1)])
    end associate
  end subroutine film_force

  pure function difference(values)
    real(dp), intent(in) :: values(2)
    real(dp) :: difference
    difference = values(2) - values(1)
  end function difference

  !> u = 1 + eps c, without cancellation where c -> -1 and eps -> 1.
  elemental function thickness(c, s, eps) result(u)
    real(dp), intent(in) :: c, s   !! cosine and sine
    real(dp), intent(in) :: eps
    real(dp) :: u
    u = merge(1 + eps*c, 1 - eps + eps*s**2/(1 + abs(c)), c >= 0)
  end function thickness

  !> The zeros on the unit circle of Im[conj(d)(4z + eps z^2)], z = c + i s, nearest to d and to -d: the angle a of z solves
  !> an equation of Kepler's kind, a + arg(4 + eps z) = arg d. It lies within 0.26 rad of d; from the linear guess two
  !> Newton steps come closer than 1e-6, and the force feels the square of that, since the pressure is 0 there. Both zeros
  !> go side by side.
  pure subroutine pressure_zeros(d_real, d_imaginary, eps, c, s)
    real(dp), intent(in) :: d_real, d_imaginary   !! of d, on the unit circle
    real(dp), intent(in) :: eps
    real(dp), intent(out) :: c(2), s(2)
    integer, parameter :: newton_steps = 2
    real(dp) :: dx(2), dy(2), linear(2), slope(2), double_c(2), double_s(2)
    integer :: i
    dx = [d_real, -d_real]
    dy = [d_imaginary, -d_imaginary]
    c = dx
    s = dy
    call rotate(-eps*dy/(4 + 2*eps*dx), c, s)
    do i = 1, newton_steps
      double_c = (c - s)*(c + s)
      double_s = 2*c*s
      linear = 4*(dx*s - dy*c) + eps*(dx*double_s - dy*double_c)
      slope = 4*(dx*c + dy*s) + 2*eps*(dx*double_c + dy*double_s)
      call rotate(-linear/slope, c, s)
    end do
  end subroutine pressure_zeros

  !> (c, s) turned by atan(tangent).
  pure subroutine rotate(tangent, c, s)
    real(dp), intent(in) :: tangent(2)
    real(dp), intent(inout) :: c(2), s(2)
    real(dp) :: shrink(2), turned(2)
    shrink = 1/sqrt(1 + tangent**2)
    turned = (c - tangent*s)*shrink
    s = (s + tangent*c)*shrink
    c = turned
  end subroutine rotate

  !> By differences: not those of the closed form.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(half_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    call difference_derivatives(self, motion, derivatives)
  end subroutine force_derivatives
end module half_film
