!> The shape of a bearing that is not a round bore in line with its pin: a deviation of the bore over the angle, a barrel along the
!> axis, and a tilt of the pin's axis.
!>
!>     h = c - (e + z tau).r(theta) + s(theta) + b (2 z/L)^2,   r = (cos theta, sin theta),   z = 0 in the middle
module bore_shape
  use kinds, only: dp
  use constants, only: two_pi
  implicit none
  private
  public :: bore_shape_t

  type :: bore_shape_t
    real(dp), allocatable :: angle(:)       !! of the rows of the deviation, from x towards y of the bearing, increasing [rad]
    real(dp), allocatable :: deviation(:)   !! s, radial, > 0 outwards; not allocated: round [m]
    real(dp) :: barrel = 0                  !! b [m]
    real(dp) :: tilt(2) = 0                 !! tau: slope of the pin's axis along z, towards x and y [rad]
  contains
    procedure :: deviation_at
    procedure :: depth
    procedure :: is_there
    procedure :: is_tilted
  end type bore_shape_t

contains

  !> s at an angle [rad]: linear between the rows, periodic [m].
  elemental real(dp) function deviation_at(self, angle) result(s)
    class(bore_shape_t), intent(in) :: self
    real(dp), intent(in) :: angle
    real(dp) :: at, next
    integer :: i, n
    s = 0
    if (.not. allocated(self%deviation)) return
    n = size(self%angle)
    at = self%angle(1) + modulo(angle - self%angle(1), two_pi)
    i = count(self%angle <= at)
    next = self%angle(1) + two_pi
    if (i < n) next = self%angle(i + 1)
    s = self%deviation(i) + (at - self%angle(i))/(next - self%angle(i))*(self%deviation(mod(i, n) + 1) - self%deviation(i))
  end function deviation_at

  !> Largest less smallest deviation [m].
  pure real(dp) function depth(self)
    class(bore_shape_t), intent(in) :: self
    depth = 0
    if (allocated(self%deviation)) depth = maxval(self%deviation) - minval(self%deviation)
  end function depth

  !> Whether there is any shape.
  pure logical function is_there(self)
    class(bore_shape_t), intent(in) :: self
    is_there = allocated(self%deviation) .or. self%barrel > 0 .or. self%is_tilted()
  end function is_there

  !> Whether the film has no mirror plane in the middle of the bearing.
  pure logical function is_tilted(self)
    class(bore_shape_t), intent(in) :: self
    is_tilted = any(abs(self%tilt) > 0)
  end function is_tilted
end module bore_shape
