!> Interpolating splines of the fifth degree through equidistant values, as sums of B-splines. Their fourth derivative is
!> continuous.
module uniform_spline
  use kinds, only: dp
  use small_lu, only: decompose, solve
  implicit none
  private
  public :: spline_weights, spline_slopes, through_values, through_mirrored, before, after

  !> Numbers of coefficients before the first value and after the last one.
  integer, parameter :: before = 2, after = 2

contains

  !> Weights of the six coefficients on which a spline depends in an interval, from the second one before its left end on. u is the
  !> distance from this end, in intervals.
  pure function spline_weights(u) result(w)
    real(dp), intent(in) :: u
    real(dp) :: w(6), v, a, b
    v = 1 - u
    a = u*u
    b = v*v
    w(1) = b*b*v/120
    w(6) = a*a*u/120
    w(2) = (26 + u*(-50 + u*(20 + u*(20 + u*(-20 + 5*u)))))/120
    w(5) = (26 + v*(-50 + v*(20 + v*(20 + v*(-20 + 5*v)))))/120
    w(3) = (66 + a*(-60 + a*(30 - 10*u)))/120
    w(4) = (66 + b*(-60 + b*(30 - 10*v)))/120
  end function spline_weights

  !> Derivatives of `spline_weights` with respect to u.
  pure function spline_slopes(u) result(w)
    real(dp), intent(in) :: u
    real(dp) :: w(6), v, a, b
    v = 1 - u
    a = u*u
    b = v*v
    w(1) = -b*b/24
    w(6) = a*a/24
    w(2) = (-10 + u*(8 + u*(12 + u*(-16 + 5*u))))/24
    w(5) = (10 - v*(8 + v*(12 + v*(-16 + 5*v))))/24
    w(3) = u*(-12 + a*(12 - 5*u))/12
    w(4) = v*(12 - b*(12 - 5*v))/12
  end function spline_slopes

  !> Coefficients (1-before : n+after, m) of m splines through values (n, m), n >= 8. At the two values next to each end the fifth
  !> derivative is continuous too (not-a-knot condition).
  pure function through_values(values) result(c)
    real(dp), intent(in) :: values(:, :)
    real(dp) :: c(1 - before:size(values, 1) + after, size(values, 2))
    real(dp), parameter :: jump(7) = [1.0_dp, -6.0_dp, 15.0_dp, -20.0_dp, 15.0_dp, -6.0_dp, 1.0_dp]
    real(dp) :: a(size(values, 1) + 4, size(values, 1) + 4), x(size(values, 1) + 4)
    integer :: pivot(size(values, 1) + 4), i, n
    logical :: singular

    n = size(values, 1)
    a = 0
    a(1, 1:7) = jump
    a(2, 2:8) = jump
    do i = 1, n
      a(i + 2, i:i + 4) = knots()
    end do
    a(n + 3, n - 3:n + 3) = jump
    a(n + 4, n - 2:n + 4) = jump
    call decompose(size(x), a, pivot, singular)
    do i = 1, size(values, 2)
      x = 0
      x(3:n + 2) = values(:, i)
      call solve(size(x), a, pivot, x)
      c(:, i) = x
    end do
  end function through_values

  !> Coefficients, in the form of `through_values`, of splines that are even (parity 1) or odd (-1) about the first and the last
  !> value.
  pure function through_mirrored(values, parity) result(c)
    real(dp), intent(in) :: values(:, :)
    integer, intent(in) :: parity
    real(dp) :: c(1 - before:size(values, 1) + after, size(values, 2))
    real(dp) :: a(size(values, 1), size(values, 1)), x(size(values, 1)), weights(5)
    integer :: pivot(size(values, 1)), i, k, n, sign_of
    logical :: singular

    n = size(values, 1)
    weights = knots()
    a = 0
    do i = 1, n
      do k = -2, 2
        sign_of = merge(parity, 1, i + k < 1 .or. i + k > n)
        a(i, mirrored(i + k)) = a(i, mirrored(i + k)) + sign_of*weights(k + 3)
      end do
    end do
    if (parity < 0) then   ! an odd spline is 0 there
      a(1, :) = 0
      a(n, :) = 0
      a(1, 1) = 1
      a(n, n) = 1
    end if
    call decompose(size(x), a, pivot, singular)
    do i = 1, size(values, 2)
      x = values(:, i)
      if (parity < 0) x([1, n]) = 0
      call solve(size(x), a, pivot, x)
      do k = 1 - before, n + after
        c(k, i) = merge(parity, 1, k < 1 .or. k > n)*x(mirrored(k))
      end do
    end do

  contains

    pure integer function mirrored(k)
      integer, intent(in) :: k
      mirrored = k
      if (k < 1) mirrored = 2 - k
      if (k > n) mirrored = 2*n - k
    end function mirrored
  end function through_mirrored

  !> Weights of the five coefficients around a value, at this value.
  pure function knots() result(weights)
    real(dp) :: weights(5)
    weights = [1.0_dp, 26.0_dp, 66.0_dp, 26.0_dp, 1.0_dp]/120
  end function knots
end module uniform_spline
