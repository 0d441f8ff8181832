!> Oil whose viscosity grows with the pressure, mu = mu_0 exp(alpha p) (Barus 1893), by the reduced pressure
!>
!>     q(p) = integral of mu_0/mu from 0 to p = (1 - exp(-alpha p))/alpha,   p = -ln(1 - alpha q)/alpha
!>
!> Since grad p/mu = grad q/mu_0, the equation of the film in q is that of a constant viscosity. It has no solution beyond
!> alpha q = 1. Pressures are in any one unit, alpha in its reciprocal.
module film_oil
  use kinds, only: dp
  implicit none
  private
  public :: film_oil_t

  type :: film_oil_t
    real(dp) :: coefficient = 0   !! alpha; 0: constant viscosity
  contains
    procedure :: reduced
    procedure :: pressure
    procedure :: thickening
  end type film_oil_t

contains

  !> q of p.
  elemental real(dp) function reduced(self, p)
    class(film_oil_t), intent(in) :: self
    real(dp), intent(in) :: p
    real(dp) :: x
    x = self%coefficient*p
    if (abs(x) < 1e-3_dp) then
      reduced = p*(1 - x*(1/2.0_dp - x*(1/6.0_dp - x*(1/24.0_dp - x*(1/120.0_dp - x/720)))))
    else
      reduced = (1 - exp(-x))/self%coefficient
    end if
  end function reduced

  !> p of q, alpha q < 1.
  elemental real(dp) function pressure(self, q)
    class(film_oil_t), intent(in) :: self
    real(dp), intent(in) :: q
    real(dp) :: x
    x = self%coefficient*q
    if (abs(x) < 1e-3_dp) then
      pressure = q*(1 + x*(1/2.0_dp + x*(1/3.0_dp + x*(1/4.0_dp + x*(1/5.0_dp + x/6)))))
    else
      pressure = -log(1 - x)/self%coefficient
    end if
  end function pressure

  !> mu/mu_0 = dp/dq at q.
  elemental real(dp) function thickening(self, q)
    class(film_oil_t), intent(in) :: self
    real(dp), intent(in) :: q
    thickening = 1/(1 - self%coefficient*q)
  end function thickening
end module film_oil
