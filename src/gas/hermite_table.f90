!> A function on [0, 1] as quintic polynomials between equidistant points, from values and two derivatives at the points.
module hermite_table
  use kinds, only: dp
  implicit none
  private
  public :: hermite_table_t, new_hermite_table

  !> Twice continuously differentiable. Beyond its ends the last polynomial continues over the same length again, so that a trial
  !> step beyond a part is smooth.
  type :: hermite_table_t
    integer :: n = 0                          !! number of intervals
    real(dp), allocatable :: coefficient(:, :) !! of (x - x_i) n, (0:5, n)
  contains
    procedure :: value
    procedure :: slope
  end type hermite_table_t

contains

  !> The table from values, first and second derivatives at i/n, i = 0..n: arrays of size n+1.
  pure type(hermite_table_t) function new_hermite_table(f, slope, curvature) result(table)
    real(dp), intent(in) :: f(0:), slope(0:), curvature(0:)
    real(dp) :: h, d, left(2), right(2)
    integer :: i, n
    n = ubound(f, 1)
    h = 1.0_dp/n
    table%n = n
    allocate (table%coefficient(0:5, n))
    do i = 1, n
      left = [slope(i - 1)*h, 0.5_dp*curvature(i - 1)*h**2]
      right = [slope(i)*h, 0.5_dp*curvature(i)*h**2]
      d = f(i) - f(i - 1)
      table%coefficient(:, i) = [f(i - 1), left(1), left(2), &
        10*d - 6*left(1) - 4*right(1) - 3*left(2) + right(2), &
        -15*d + 8*left(1) + 7*right(1) + 3*left(2) - 2*right(2), &
        6*d - 3*left(1) - 3*right(1) - left(2) + right(2)]
    end do
  end function new_hermite_table

  pure real(dp) function value(self, x)
    class(hermite_table_t), intent(in) :: self
    real(dp), intent(in) :: x
    real(dp) :: s
    integer :: i
    s = min(max(x, -1.0_dp), 2.0_dp)*self%n
    i = min(max(int(s), 0), self%n - 1)
    s = s - i
    associate (c => self%coefficient(:, i + 1))
      value = c(1) + s*(c(2) + s*(c(3) + s*(c(4) + s*(c(5) + s*c(6)))))
    end associate
  end function value

  !> Derivative of `value` with respect to x.
  pure real(dp) function slope(self, x)
    class(hermite_table_t), intent(in) :: self
    real(dp), intent(in) :: x
    real(dp) :: s
    integer :: i
    s = min(max(x, -1.0_dp), 2.0_dp)*self%n
    i = min(max(int(s), 0), self%n - 1)
    s = s - i
    associate (c => self%coefficient(:, i + 1))
      slope = self%n*(c(2) + s*(2*c(3) + s*(3*c(4) + s*(4*c(5) + s*5*c(6)))))
    end associate
  end function slope
end module hermite_table
