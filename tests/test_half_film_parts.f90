!> Parts of the half film against quadruple precision: the root of the cubic that determines the zeros of its pressure, and the
!> increase of Sommerfeld's angle between them.
module test_half_film_parts
  use, intrinsic :: iso_fortran_env, only: qp => real128
  use kinds, only: dp
  use checks, only: checks_t
  use half_film, only: cubic_scale, cubic_share, turn_between
  implicit none
  private
  public :: run_test_half_film_parts

contains

  subroutine run_test_half_film_parts(check)
    class(checks_t), intent(inout) :: check
    call roots_are_right(check)
    call turns_are_right(check)
    call turns_at_the_limits(check)
  end subroutine run_test_half_film_parts

  !> v (1 + v)^2 = c/p^3 up to its largest value 16/27, that of eps = 1 and a squeeze without wedge, solved by Newton's iteration.
  subroutine roots_are_right(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 20000
    real(qp) :: v, right, t, worst
    integer :: i, j
    worst = abs(cubic_share(0.0_dp) - real(cubic_scale, qp)/4)/(cubic_scale/4)
    do i = 1, points
      right = 16*real(i, qp)/(27*points)
      t = real(real(4*right/(4*right + real(cubic_scale, qp)), dp), qp)
      right = real(cubic_scale, qp)/4*t/(1 - t)
      v = right
      do j = 1, 12
        v = v - (v*(1 + v)**2 - right)/((1 + v)*(1 + 3*v))
      end do
      worst = max(worst, abs(t*cubic_share(real(t, dp)) - v)/v)
    end do
    call check%that(worst <= 5e-16_qp, 'relative error of the root of the cubic')
  end subroutine roots_are_right

  !> Against the arc tangent, for both signs and on both sides of |T| = 1, where the formula changes.
  subroutine turns_are_right(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 3000
    real(dp) :: worst, tangent
    integer :: i
    worst = 0
    do i = -points, points
      tangent = exp(0.01_dp*i)
      worst = max(worst, off(tangent, 1.0_dp, 1.0_dp), off(tangent, 1.0_dp, -1.0_dp), off(1e-30_dp*tangent, 1e-30_dp, -1.0_dp))
      tangent = 1 + 1e-3_dp*i/points
      worst = max(worst, off(tangent, 1.0_dp, 1.0_dp), off(tangent, 1.0_dp, -1.0_dp))
    end do
    call check%that(worst <= 7e-16_dp, 'relative error of the angle between the zeros')
  end subroutine turns_are_right

  !> Relative error of the angle for T^2 = rise/reach and the sign of T.
  real(dp) function off(rise, reach, direction)
    real(dp), intent(in) :: rise, reach, direction
    real(qp) :: exact
    exact = 2*atan2(sqrt(real(reach, qp)), -sign(1.0_dp, direction)*sqrt(real(rise, qp)))
    off = real(abs(turn_between(rise, reach, direction) - exact)/exact, dp)
  end function off

  subroutine turns_at_the_limits(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: pi = acos(-1.0_dp)
    call check%close_to(turn_between(0.0_dp, 1.0_dp, 0.0_dp), pi, 1e-15_dp, 'half a turn if the pin only rotates')
    call check%close_to(turn_between(1.0_dp, 1e-300_dp, 1.0_dp), 2*pi, 1e-15_dp, 'a whole turn if the pin approaches the wall')
    call check%close_to(turn_between(1.0_dp, 1e-300_dp, -1.0_dp), 0.0_dp, 1e-140_dp, 'no turn if it leaves the wall')
  end subroutine turns_at_the_limits
end module test_half_film_parts
