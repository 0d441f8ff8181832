!> Points of Sobol's sequence with the direction numbers of S. Joe and F. Y. Kuo (SIAM J. Sci. Comput. 30, 2008, 2635-2654;
!> their file new-joe-kuo-6, first 21 dimensions), in the order of Antonov and Saleev (Gray code), 32 bits.
module sobol_points
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: sobol_points_t, most_dimensions

  integer, parameter :: most_dimensions = 21, bits = 32, most_initial = 7

  !> Degree and inner coefficients of the primitive polynomial of each dimension from the second on.
  integer, parameter :: degree(2:most_dimensions) = [1, 2, 3, 3, 4, 4, 5, 5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 7, 7]
  integer, parameter :: inner(2:most_dimensions) = [0, 1, 1, 2, 1, 4, 2, 4, 7, 11, 13, 14, 1, 13, 16, 19, 22, 25, 1, 4]
  integer, parameter :: initial(most_initial, 2:most_dimensions) = reshape([ &
    1, 0, 0, 0, 0, 0, 0,    1, 3, 0, 0, 0, 0, 0,    1, 3, 1, 0, 0, 0, 0,    1, 1, 1, 0, 0, 0, 0, &
    1, 1, 3, 3, 0, 0, 0,    1, 3, 5, 13, 0, 0, 0,   1, 1, 5, 5, 17, 0, 0,   1, 1, 5, 5, 5, 0, 0, &
    1, 1, 7, 11, 19, 0, 0,  1, 1, 5, 1, 1, 0, 0,    1, 1, 1, 3, 11, 0, 0,   1, 3, 5, 5, 31, 0, 0, &
    1, 3, 3, 9, 7, 49, 0,   1, 1, 1, 15, 21, 21, 0, 1, 3, 1, 13, 27, 49, 0, 1, 1, 1, 15, 7, 5, 0, &
    1, 3, 1, 15, 13, 25, 0, 1, 1, 5, 5, 19, 61, 0,  1, 3, 7, 11, 23, 15, 103, 1, 3, 7, 13, 13, 15, 69], &
    [most_initial, most_dimensions - 1])

  type :: sobol_points_t
    integer(int64), allocatable :: direction(:, :)   !! (bits, dimensions)
    integer(int64), allocatable :: shift(:)          !! digital shift of each dimension
  contains
    procedure :: prepare
    procedure :: coordinate
  end type sobol_points_t

contains

  !> Compute the direction numbers for 1 to most_dimensions dimensions.
  pure subroutine prepare(self, dimensions)
    class(sobol_points_t), intent(inout) :: self
    integer, intent(in) :: dimensions
    integer :: d, i, k, s
    integer(int64) :: v
    allocate (self%direction(bits, dimensions), self%shift(dimensions))
    self%shift = 0
    do i = 1, bits
      self%direction(i, 1) = shiftl(1_int64, bits - i)
    end do
    do d = 2, dimensions
      s = degree(d)
      do i = 1, s
        self%direction(i, d) = shiftl(int(initial(i, d), int64), bits - i)
      end do
      do i = s + 1, bits
        v = self%direction(i - s, d)
        v = ieor(v, shiftr(v, s))
        do k = 1, s - 1
          if (btest(inner(d), s - 1 - k)) v = ieor(v, self%direction(i - k, d))
        end do
        self%direction(i, d) = v
      end do
    end do
  end subroutine prepare

  !> Coordinate of point `index` (0, 1, ...) in one dimension, 0 <= u < 1.
  pure real(dp) function coordinate(self, index, dimension)
    class(sobol_points_t), intent(in) :: self
    integer, intent(in) :: index, dimension
    integer(int64) :: x
    integer :: gray, i
    gray = ieor(index, shiftr(index, 1))
    x = self%shift(dimension)
    do i = 0, bits - 2
      if (btest(gray, i)) x = ieor(x, self%direction(i + 1, dimension))
    end do
    coordinate = real(x, dp)*2.0_dp**(-bits)
  end function coordinate
end module sobol_points
