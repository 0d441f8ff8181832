!> The root of an event function on the interpolant of a step.
module root_search
  use kinds, only: dp
  implicit none
  private
  public :: bracket_t, next_abscissa, narrow, abscissa_by_rates

  !> A sign change from negative (at a) to non-negative (at b), reduced by the ITP method (Oliveira & Takahashi 2020): at most one
  !> evaluation more than bisection, and superlinear for smooth functions. a < b or a > b.
  type :: bracket_t
    real(dp) :: a, b         !! ends of the bracket
    real(dp) :: fa, fb       !! values at the ends: fa < 0 <= fb
    integer :: steps = 0     !! number of evaluations so far
    real(dp) :: width = 0    !! initial |b - a|
  end type bracket_t

contains

  !> Where to evaluate next; equal to an end if the bracket cannot be divided further.
  pure real(dp) function next_abscissa(bracket) result(x)
    type(bracket_t), intent(in) :: bracket
    real(dp) :: middle, secant, truncated, sigma, radius, resolution
    integer, parameter :: slack = 1

    associate (a => bracket%a, b => bracket%b)
      middle = a + 0.5_dp*(b - a)
      x = middle
      if (.not. (bracket%fb > bracket%fa)) return
      resolution = spacing(max(abs(a), abs(b)))
      secant = a - bracket%fa*((b - a)/(bracket%fb - bracket%fa))
      sigma = sign(1.0_dp, middle - secant)
      truncated = min(0.2_dp*(b - a)**2/max(bracket%width, resolution), abs(middle - secant))
      truncated = secant + sigma*max(truncated, min(resolution, abs(middle - secant)))
      radius = 0.5_dp*bracket%width*2.0_dp**(slack - bracket%steps) - 0.5_dp*abs(b - a)
      radius = max(radius, 0.0_dp)
      if (abs(truncated - middle) <= radius) then
        x = truncated
      else
        x = middle - sigma*radius
      end if
    end associate
  end function next_abscissa

  !> Estimate of the root between a < b, where the function is negative at a, not negative at b, and rises at both with known rates:
  !> the cubic through both ends that gives the abscissa as a function of the value. The estimate is at least one spacing of numbers
  !> inside the interval, so that evaluations on both sides of the root soon enclose it.
  pure real(dp) function abscissa_by_rates(a, b, fa, fb, rate_a, rate_b) result(x)
    real(dp), intent(in) :: a, b, fa, fb, rate_a, rate_b
    real(dp) :: share, rest, resolution
    share = fa/(fa - fb)
    rest = 1 - share
    x = a + share*((fb - fa)*rest*(rest/rate_a - share/rate_b) + (b - a)*share*(3 - 2*share))
    resolution = spacing(max(abs(a), abs(b)))
    x = max(a + resolution, min(b - resolution, x))
  end function abscissa_by_rates

  !> Replace the end of the bracket at which the sign is that of the value at x.
  pure subroutine narrow(bracket, x, value)
    type(bracket_t), intent(inout) :: bracket
    real(dp), intent(in) :: x, value
    bracket%steps = bracket%steps + 1
    if (value < 0) then
      bracket%a = x
      bracket%fa = value
    else
      bracket%b = x
      bracket%fb = value
    end if
  end subroutine narrow
end module root_search
