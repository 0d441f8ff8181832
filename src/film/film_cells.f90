!> The cells of a film with memory: a uniform grid on the bore of a bearing, and which of its cells are in a groove or hole of the
!> supply.
!>
!> Cells lie round the bearing (i = 1 .. around, from x towards y) and along half of its length (j = 1 .. along, from the middle
!> plane, in which the film is symmetric) or, beside a circumferential groove, along one of two equal lands (from the groove).
!> Lengths along the axis are over the pin's radius R, film thicknesses over the radial clearance c.
module film_cells
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use error_handling, only: error_t, fail, status_case_file
  use bearing_size, only: bearing_t
  implicit none
  private
  public :: supply_t, film_cells_t, new_film_cells
  public :: supply_none, supply_grooves, supply_holes, supply_circumferential
  public :: ruptured, filled, supplied

  !> Kinds of supply.
  integer, parameter :: supply_none = 0, supply_grooves = 1, supply_holes = 2, supply_circumferential = 3

  !> Kinds of cells: void in part (the film has ruptured: p = 0, f < 1), full of oil (p > 0, f = 1), or in the supply (p given).
  integer, parameter :: ruptured = 0, filled = 1, supplied = 2

  !> Where oil is fed to a film. The middles of grooves and holes lie in the middle plane of the bearing.
  type :: supply_t
    integer :: kind = supply_none
    real(dp), allocatable :: position_deg(:)   !! angles of the middles, from x towards y [deg]
    real(dp) :: width_deg = 0                  !! arc of a groove [deg]
    real(dp) :: length = 0                     !! axial length of a groove [m]
    real(dp) :: diameter = 0                   !! of a hole [m]
    real(dp) :: groove_width = 0               !! of a circumferential groove [m]
    logical :: fixed_to_pin = .false.          !! grooves and holes are in the pin and turn with it
  end type supply_t

  type :: film_cells_t
    integer :: around = 0, along = 0
    real(dp) :: clearance = 0, pin_radius = 0  !! c, R [m]
    real(dp) :: turn = 0                       !! angle of a cell [rad]
    real(dp) :: width = 0                      !! axial width of a cell over R
    logical :: is_land = .false.               !! the cells lie beside a circumferential groove
    real(dp) :: share = 1                      !! part of the bearing's length that the cells and their mirror images cover
    type(supply_t) :: supply
    real(dp), allocatable :: angle(:)          !! of the middles of the cells (around) [rad]
    real(dp), allocatable :: face_angle(:)     !! of the face between cells i and i + 1 [rad]
    real(dp), allocatable :: bore(:), face_bore(:)  !! gap of a pin in the middle over c, at both: 1 for a round bore
    integer, allocatable :: next(:)            !! i + 1, round the ring
    integer, allocatable :: place(:)           !! of column i in the order of elimination: neighbours are at most two apart
    logical, allocatable :: is_supplied(:, :)  !! (along, around): the middle of the cell lies in the supply
  contains
    procedure :: turn_supply
    procedure :: cell_volume
  end type film_cells_t

contains

  !> The grid for a bearing, with the supply where it is at the beginning. Refused are a supply that lies in no cell, grooves that
  !> are longer than the bearing, and a circumferential groove in the pin.
  pure subroutine new_film_cells(bearing, supply, around, along, cells, error)
    type(bearing_t), intent(in) :: bearing
    type(supply_t), intent(in) :: supply
    integer, intent(in) :: around, along   !! numbers of cells, >= 24 and >= 2
    type(film_cells_t), intent(out) :: cells
    type(error_t), allocatable, intent(out) :: error
    integer :: i

    cells%around = around
    cells%along = along
    cells%clearance = bearing%clearance
    cells%pin_radius = bearing%pin_radius()
    cells%supply = supply
    cells%is_land = supply%kind == supply_circumferential
    if (cells%is_land) cells%share = 1 - supply%groove_width/bearing%length
    cells%turn = two_pi/around
    cells%width = 0.5_dp*cells%share*bearing%length/(along*cells%pin_radius)
    cells%angle = [((i - 0.5_dp)*cells%turn, i=1, around)]
    cells%face_angle = [(i*cells%turn, i=1, around)]
    cells%next = [(modulo(i, around) + 1, i=1, around)]
    cells%place = [(merge(2*i - 1, 2*(around - i + 1), 2*i <= around + 1), i=1, around)]
    allocate (cells%bore(around), cells%face_bore(around), source=1.0_dp)
    allocate (cells%is_supplied(along, around))
    call check_supply(cells, bearing%length, error)
    if (.not. allocated(error)) call cells%turn_supply(0.0_dp)
  end subroutine new_film_cells

  !> Report a supply that the bearing cannot have, or that is smaller than a cell.
  pure subroutine check_supply(cells, length, error)
    type(film_cells_t), intent(in) :: cells
    real(dp), intent(in) :: length   !! of the bearing [m]
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: cell_length, arc
    cell_length = cells%width*cells%pin_radius
    arc = cells%turn*cells%pin_radius
    associate (supply => cells%supply)
      select case (supply%kind)
      case (supply_grooves)
        if (supply%length > length*(1 + epsilon(length))) then
          call fail(error, 'a groove is longer than the bearing', status_case_file)
        else if (supply%width_deg*degree < cells%turn .or. supply%length < cell_length) then
          call fail(error, 'a groove is smaller than a cell of the film: use more cells', status_case_file)
        end if
      case (supply_holes)
        if (supply%diameter**2 < arc**2 + cell_length**2) &
          call fail(error, 'a hole is smaller than a cell of the film: use more cells', status_case_file)
      case (supply_circumferential)
        if (supply%fixed_to_pin) then
          call fail(error, 'a circumferential groove cannot be fixed to the pin', status_case_file)
        else if (.not. (cells%share > 0 .and. cells%share < 1)) then
          call fail(error, 'a circumferential groove must be narrower than the bearing', status_case_file)
        end if
      case default   ! no supply
      end select
    end associate
  end subroutine check_supply

  !> Find the cells of the supply when the pin has turned by an angle [rad] since the beginning.
  pure subroutine turn_supply(self, angle)
    class(film_cells_t), intent(inout) :: self
    real(dp), intent(in) :: angle
    real(dp) :: position, distance, from_middle
    integer :: i, j, k
    self%is_supplied = .false.
    if (self%supply%kind /= supply_grooves .and. self%supply%kind /= supply_holes) return
    do k = 1, size(self%supply%position_deg)
      position = self%supply%position_deg(k)*degree
      if (self%supply%fixed_to_pin) position = position + angle
      do i = 1, self%around
        distance = abs(modulo(self%angle(i) - position + pi, two_pi) - pi)
        do j = 1, self%along
          from_middle = (j - 0.5_dp)*self%width*self%pin_radius
          if (self%supply%kind == supply_grooves) then
            if (distance > 0.5_dp*self%supply%width_deg*degree .or. from_middle > 0.5_dp*self%supply%length) cycle
          else
            if ((distance*self%pin_radius)**2 + from_middle**2 > 0.25_dp*self%supply%diameter**2) cycle
          end if
          self%is_supplied(j, i) = .true.
        end do
      end do
    end do
  end subroutine turn_supply

  !> Volume of a cell and its mirror image in a gap of the thickness c [m^3].
  pure real(dp) function cell_volume(self)
    class(film_cells_t), intent(in) :: self
    cell_volume = 2*self%clearance*self%pin_radius**2*self%turn*self%width
  end function cell_volume
end module film_cells
