!> The arc on which pin and bore of a joint press on each other, and the pressure along it, for the wear of their surfaces.
module contact_arc
  use kinds, only: dp
  use constants, only: pi
  implicit none
  private
  public :: contact_arc_t

  !> The arc, divided into cells. Angles are measured from the line of centres.
  type :: contact_arc_t
    integer :: n = 0                         !! number of cells; 0: the surfaces touch along a line
    real(dp), allocatable :: ends(:, :)      !! angles at which each cell begins and ends, (2, n) [rad]
    real(dp), allocatable :: middles(:)      !! an angle in the middle of each cell [rad]
    real(dp), allocatable :: loads(:)        !! Int p R L dtheta over each cell, relative to that of the others
  contains
    procedure :: divide
    procedure :: allocate_cells
  end type contact_arc_t

contains

  !> Divide an arc into cells that are not much wider than `width` [rad]; none if its half-angle a [rad] is not positive. With theta
  !> = a sin s the cells have equal ranges of s. `loads` are set to their widths, a cos s ds, without the constant factor.
  pure subroutine divide(self, half_angle, width)
    class(contact_arc_t), intent(inout) :: self
    real(dp), intent(in) :: half_angle, width
    integer, parameter :: least_cells = 16
    real(dp) :: step, edge, s
    integer :: i
    self%n = 0
    if (.not. half_angle > 0) return
    call self%allocate_cells(max(least_cells, ceiling(2*half_angle/width)))
    step = pi/self%n
    edge = -half_angle
    do i = 1, self%n
      s = (i - 0.5_dp)*step - pi/2
      self%ends(1, i) = edge
      edge = half_angle*sin(s + step/2)
      self%ends(2, i) = edge
      self%middles(i) = half_angle*sin(s)
      self%loads(i) = cos(s)
    end do
  end subroutine divide

  !> Make room for n cells.
  pure subroutine allocate_cells(self, n)
    class(contact_arc_t), intent(inout) :: self
    integer, intent(in) :: n
    self%n = n
    if (allocated(self%loads)) then
      if (size(self%loads) >= n) return
      deallocate (self%ends, self%middles, self%loads)
    end if
    allocate (self%ends(2, n), self%middles(n), self%loads(n))
  end subroutine allocate_cells
end module contact_arc
