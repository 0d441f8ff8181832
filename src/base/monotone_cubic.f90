!> Interpolation of given points by cubics that neither overshoot the points nor oscillate between them (Steffen 1990, A simple
!> method for monotonic interpolation in one dimension, Astronomy and Astrophysics 239, 443-450).
!>
!> Value and first derivative are continuous; the second derivative is discontinuous at the points. Between two points the function
!> is monotone, so that its largest value is that of a point.
module monotone_cubic
  use kinds, only: dp
  implicit none
  private
  public :: monotone_cubic_t, new_monotone_cubic, new_periodic_cubic

  type :: monotone_cubic_t
    real(dp) :: period = 0                             !! 0: not periodic, and constant outside the range of the points
    real(dp), private :: first = 0, last = 0           !! first and last point
    real(dp), allocatable, private :: point(:)         !! (0:n), increasing
    real(dp), allocatable, private :: coefficient(:, :)  !! coefficients of powers of x - point(i) between points i and i + 1, (0:3,
                                                         !! 0:n - 1)
    integer, allocatable, private :: place(:)          !! (0:n): interval that contains the beginning of the k-th of n equal parts
    real(dp), private :: per_part = 0
  contains
    procedure :: value
    procedure :: slope
    procedure :: finest
  end type monotone_cubic_t

contains

  !> The curve through (x, y), at least two points, x increasing; constant before the first and after the last point.
  pure type(monotone_cubic_t) function new_monotone_cubic(x, y) result(curve)
    real(dp), intent(in) :: x(0:), y(0:)
    real(dp) :: slope(0:ubound(x, 1)), secant(ubound(x, 1)), width(ubound(x, 1))
    integer :: i, n
    n = ubound(x, 1)
    width = x(1:n) - x(0:n - 1)
    secant = (y(1:n) - y(0:n - 1))/width
    do i = 1, n - 1
      slope(i) = inner_slope(width(i), width(i + 1), secant(i), secant(i + 1))
    end do
    if (n == 1) then
      slope = secant(1)
    else
      slope(0) = end_slope(width(1), width(2), secant(1), secant(2))
      slope(n) = end_slope(width(n), width(n - 1), secant(n), secant(n - 1))
    end if
    call set_points(curve, x, y, slope)
  end function new_monotone_cubic

  !> The periodic curve through (x, y), at least two points within less than a period, x increasing; y(x + period) = y(x).
  pure type(monotone_cubic_t) function new_periodic_cubic(x, y, period) result(curve)
    real(dp), intent(in) :: x(0:), y(0:)
    real(dp), intent(in) :: period
    real(dp) :: slope(0:size(x)), secant(0:size(x)), width(0:size(x))
    integer :: i, n
    n = size(x)   ! the first point is repeated at the end
    width(1:n) = [x(1:n - 1), x(0) + period] - x(0:n - 1)
    secant(1:n) = ([y(1:n - 1), y(0)] - y(0:n - 1))/width(1:n)
    width(0) = width(n)
    secant(0) = secant(n)
    do i = 0, n - 1
      slope(i) = inner_slope(width(i), width(i + 1), secant(i), secant(i + 1))
    end do
    slope(n) = slope(0)
    call set_points(curve, [x, x(0) + period], [y, y(0)], slope)
    curve%period = period
  end function new_periodic_cubic

  !> Slope at a point between two intervals with these widths and secants.
  pure real(dp) function inner_slope(width, next_width, secant, next_secant) result(slope)
    real(dp), intent(in) :: width, next_width, secant, next_secant
    real(dp) :: parabola
    slope = 0
    if (.not. (secant > 0 .and. next_secant > 0 .or. secant < 0 .and. next_secant < 0)) return
    parabola = (secant*next_width + next_secant*width)/(width + next_width)
    slope = sign(min(abs(secant), abs(next_secant), 0.5_dp*abs(parabola))*2, secant)
  end function inner_slope

  !> Slope at an end point, from its interval and the next one.
  pure real(dp) function end_slope(width, next_width, secant, next_secant) result(slope)
    real(dp), intent(in) :: width, next_width, secant, next_secant
    real(dp) :: share
    share = width/(width + next_width)
    slope = secant*(1 + share) - next_secant*share
    if (slope*secant <= 0) slope = 0
    if (abs(slope) > 2*abs(secant)) slope = 2*secant
  end function end_slope

  pure subroutine set_points(curve, x, y, slope)
    type(monotone_cubic_t), intent(out) :: curve
    real(dp), intent(in) :: x(0:), y(0:), slope(0:)
    real(dp) :: width, secant
    integer :: i, k, n
    n = ubound(x, 1)
    allocate (curve%point(0:n), curve%coefficient(0:3, 0:n - 1), curve%place(0:n))
    curve%point = x
    curve%first = x(0)
    curve%last = x(n)
    curve%per_part = n/(x(n) - x(0))
    do i = 0, n - 1
      width = x(i + 1) - x(i)
      secant = (y(i + 1) - y(i))/width
      curve%coefficient(:, i) = [y(i), slope(i), (3*secant - 2*slope(i) - slope(i + 1))/width, &
        (slope(i) + slope(i + 1) - 2*secant)/width**2]
    end do
    i = 0
    do k = 0, n
      do while (i < n - 1 .and. part_of(curve, x(min(i + 1, n))) < k)
        i = i + 1
      end do
      curve%place(k) = i
    end do
  end subroutine set_points

  !> Number of the equal part that contains x.
  pure integer function part_of(curve, x)
    type(monotone_cubic_t), intent(in) :: curve
    real(dp), intent(in) :: x
    part_of = min(max(int((x - curve%first)*curve%per_part), 0), ubound(curve%place, 1))
  end function part_of

  !> The interval of x, and the distance of x from its beginning.
  pure subroutine find(self, x, i, along)
    class(monotone_cubic_t), intent(in) :: self
    real(dp), intent(in) :: x
    integer, intent(out) :: i
    real(dp), intent(out) :: along
    real(dp) :: position
    integer :: k, last, middle
    position = x
    if (self%period > 0) position = x - self%period*floor((x - self%first)/self%period)
    position = min(max(position, self%first), self%last)
    k = part_of(self, position)
    i = self%place(k)
    last = self%place(min(k + 1, ubound(self%place, 1)))
    do while (i < last)
      middle = (i + last + 1)/2
      if (self%point(middle) <= position) then
        i = middle
      else
        last = middle - 1
      end if
    end do
    along = position - self%point(i)
  end subroutine find

  !> Value at x: on a periodic curve anywhere, otherwise beyond the ends that at the nearer end.
  pure real(dp) function value(self, x)
    class(monotone_cubic_t), intent(in) :: self
    real(dp), intent(in) :: x
    real(dp) :: s
    integer :: i
    call find(self, x, i, s)
    associate (c => self%coefficient)
      value = c(0, i) + s*(c(1, i) + s*(c(2, i) + s*c(3, i)))
    end associate
  end function value

  !> Derivative of `value` with respect to x.
  pure real(dp) function slope(self, x)
    class(monotone_cubic_t), intent(in) :: self
    real(dp), intent(in) :: x
    real(dp) :: s
    integer :: i
    slope = 0
    if (.not. self%period > 0 .and. (x < self%first .or. x > self%last)) return
    call find(self, x, i, s)
    associate (c => self%coefficient)
      slope = c(1, i) + s*(2*c(2, i) + s*3*c(3, i))
    end associate
  end function slope

  !> The smallest distance between two points.
  pure real(dp) function finest(self)
    class(monotone_cubic_t), intent(in) :: self
    associate (n => ubound(self%point, 1))
      finest = minval(self%point(1:) - self%point(:n - 1))
    end associate
  end function finest
end module monotone_cubic
