!> Coordinates and scales for the table of the force of a film of finite length (`film_map`): with w = sqrt(1 - eps^2) and the
!> velocity (B, T) along n and t
!>
!>     M = sqrt(B^2 + w^2 T^2), u = (1 + B/M)/2, q = (u + w^2)/w^2,  S_t = M q,  S_r = M q^(3/2)
!>     tau = atan2(eps, w),  chi = atan2(|T| B (1 + w), B^2 - w T^2)/2 in [0, pi]
module film_coordinates
  use kinds, only: dp
  use constants, only: pi
  implicit none
  private
  public :: find_scales, scale_slopes, chi_of, chi_slopes, tau_of, gap_at, direction_at

contains

  !> Scales S_r and S_t for a velocity (B, A), A = |T|, not both 0; w2 = w^2. S_t is computed as M + P with P = M u/w^2.
  pure subroutine find_scales(b, a, w2, s_r, s_t)
    real(dp), intent(in) :: b, a, w2
    real(dp), intent(out) :: s_r, s_t
    real(dp) :: m
    m = sqrt(b**2 + w2*a**2)
    if (b >= 0) then
      s_t = m + 0.5_dp*(m + b)/w2
    else
      s_t = m + 0.5_dp*a**2/(m - b)
    end if
    s_r = s_t*sqrt(s_t/m)
  end subroutine find_scales

  !> Derivatives of these scales with respect to eps, B and A. Those of P are -P^2/M with respect to w^2, P/M to B and A/(2 M) to A.
  pure subroutine scale_slopes(eps, b, a, w2, s_r, s_t, of_s_r, of_s_t)
    real(dp), intent(in) :: eps, b, a, w2
    real(dp), intent(in) :: s_r, s_t   !! the results of `find_scales`
    real(dp), intent(out) :: of_s_r(3), of_s_t(3)
    real(dp) :: m, p, of_m(3)
    m = sqrt(b**2 + w2*a**2)
    p = s_t - m
    if (b < 0) p = 0.5_dp*a**2/(m - b)
    of_m = [-eps*a**2, b, w2*a]/m
    of_s_t = of_m + [2*eps*p**2, p, 0.5_dp*a]/m
    of_s_r = s_r*(1.5_dp*of_s_t/s_t - 0.5_dp*of_m/m)
  end subroutine scale_slopes

  !> chi of a velocity (B, A), A >= 0, in [0, pi].
  pure real(dp) function chi_of(b, a, w)
    real(dp), intent(in) :: b, a, w
    chi_of = 0.5_dp*atan2(a*b*(1 + w), b**2 - w*a**2)
    if (chi_of < 0 .or. (b < 0 .and. chi_of <= 0)) chi_of = chi_of + pi   ! also where b is a negative 0
  end function chi_of

  !> Derivatives of chi with respect to eps, B and A, not both B and A 0.
  pure function chi_slopes(eps, b, a, w) result(slopes)
    real(dp), intent(in) :: eps, b, a, w
    real(dp) :: slopes(3)
    real(dp) :: m2, turn
    m2 = b**2 + w**2*a**2
    turn = 0.5_dp*(1 + w)*(b**2 + w*a**2)/((b**2 + a**2)*m2)
    slopes = [-0.5_dp*a*b*eps/(w*m2), -a*turn, b*turn]
  end function chi_slopes

  !> tau of an eccentricity ratio.
  pure real(dp) function tau_of(gap)
    real(dp), intent(in) :: gap   !! 1 - eps
    tau_of = 0.5_dp*pi - 2*asin(sqrt(0.5_dp*gap))
  end function tau_of

  !> 1 - eps of a tau.
  pure real(dp) function gap_at(tau)
    real(dp), intent(in) :: tau
    gap_at = 2*sin(0.5_dp*(0.5_dp*pi - tau))**2
  end function gap_at

  !> The direction alpha of the velocity (B, A) = (cos alpha, sin alpha) that belongs to a chi, by bisection.
  pure real(dp) function direction_at(chi, w) result(alpha)
    real(dp), intent(in) :: chi, w
    real(dp) :: lower, upper
    integer :: i
    lower = 0
    upper = pi
    do i = 1, 60
      alpha = 0.5_dp*(lower + upper)
      if (chi_of(cos(alpha), sin(alpha), w) < chi) then
        lower = alpha
      else
        upper = alpha
      end if
    end do
    if (chi <= 0) alpha = 0
    if (chi >= pi) alpha = pi
  end function direction_at
end module film_coordinates
