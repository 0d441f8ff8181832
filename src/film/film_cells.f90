!> The cells of a film with memory: a uniform grid on the bore of a bearing, and which of its cells are in a groove or hole of the
!> supply.
!>
!> Cells lie round the bearing (i = 1 .. around, from x towards y) and along half of its length (j = 1 .. along, from the middle
!> plane, in which the film is symmetric) or, beside a circumferential groove, along one of two equal lands (from the groove). Where
!> the pin is tilted they lie along the whole length.
!> Lengths along the axis are over the pin's radius R, film thicknesses over the radial clearance c.
module film_cells
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use error_handling, only: error_t, fail, status_case_file
  use bearing_size, only: bearing_t
  use bore_shape, only: bore_shape_t
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
    logical :: is_whole = .false.              !! they lie along the whole length: there are no mirror images
    real(dp) :: share = 1                      !! part of the bearing's length that the cells and their mirror images cover
    type(supply_t) :: supply
    real(dp), allocatable :: angle(:)          !! of the middles of the cells (around) [rad]
    real(dp), allocatable :: face_angle(:)     !! of the face between cells i and i + 1 [rad]
    real(dp), allocatable :: axial(:)          !! of the middles of the cells from that of the bearing (along) [m]
    real(dp), allocatable :: bore(:), face_bore(:)  !! gap of a pin in the middle over c, at both: 1 for a round bore
    real(dp), allocatable :: bore_slope(:)     !! its derivative with respect to the angle, at the cells
    logical :: varies_along = .false.          !! the gap varies along the axis, by the following parts of it over c
    real(dp), allocatable :: beyond(:, :), face_beyond(:, :)   !! at the cells and at the faces between cells i and i + 1
    real(dp), allocatable :: end_beyond(:, :)  !! at the faces between cells j and j + 1, and at both ends (0:along, around)
    real(dp), allocatable :: least_beyond(:), least_face_beyond(:)   !! smallest ones at each angle (around), of cells with ends
    integer, allocatable :: next(:)            !! i + 1, round the ring
    integer, allocatable :: place(:)           !! of column i in the order of elimination: neighbours are at most two apart
    logical, allocatable :: is_supplied(:, :)  !! (along, around): the middle of the cell lies in the supply
  contains
    procedure :: turn_supply
    procedure :: cell_volume
    procedure, private :: set_shape
  end type film_cells_t

contains

  !> The grid for a bearing, with the supply where it is at the beginning. Refused are a supply that lies in no cell, grooves that
  !> are longer than the bearing, and a circumferential groove in the pin.
  pure subroutine new_film_cells(bearing, supply, around, along, cells, error, shape)
    type(bearing_t), intent(in) :: bearing
    type(supply_t), intent(in) :: supply
    integer, intent(in) :: around, along   !! numbers of cells, >= 24 and >= 2
    type(film_cells_t), intent(out) :: cells
    type(error_t), allocatable, intent(out) :: error
    type(bore_shape_t), intent(in), optional :: shape   !! absent: a round bore in line with the pin
    integer :: i, j

    cells%around = around
    cells%along = along
    if (present(shape)) cells%is_whole = shape%is_tilted()
    if (cells%is_whole) cells%along = 2*along
    cells%clearance = bearing%clearance
    cells%pin_radius = bearing%pin_radius()
    cells%supply = supply
    cells%is_land = supply%kind == supply_circumferential
    if (cells%is_land) cells%share = 1 - supply%groove_width/bearing%length
    cells%turn = two_pi/around
    cells%width = 0.5_dp*cells%share*bearing%length/(along*cells%pin_radius)
    cells%axial = [((j - 0.5_dp)*cells%width*cells%pin_radius, j=1, cells%along)]
    if (cells%is_whole) cells%axial = cells%axial - 0.5_dp*bearing%length
    cells%angle = [((i - 0.5_dp)*cells%turn, i=1, around)]
    cells%face_angle = [(i*cells%turn, i=1, around)]
    cells%next = [(modulo(i, around) + 1, i=1, around)]
    cells%place = [(merge(2*i - 1, 2*(around - i + 1), 2*i <= around + 1), i=1, around)]
    allocate (cells%bore(around), cells%face_bore(around), source=1.0_dp)
    allocate (cells%bore_slope(around), cells%least_beyond(around), cells%least_face_beyond(around), source=0.0_dp)
    allocate (cells%beyond(cells%along, around), cells%face_beyond(cells%along, around), source=0.0_dp)
    allocate (cells%end_beyond(0:cells%along, around), source=0.0_dp)
    if (present(shape)) call cells%set_shape(shape, bearing%length)
    allocate (cells%is_supplied(cells%along, around))
    call check_supply(cells, bearing%length, error)
    if (.not. allocated(error)) call cells%turn_supply(0.0_dp)
  end subroutine new_film_cells

  !> Set the gap of a pin in the middle of a bore with a shape.
  pure subroutine set_shape(self, shape, length)
    class(film_cells_t), intent(inout) :: self
    type(bore_shape_t), intent(in) :: shape
    real(dp), intent(in) :: length   !! of the bearing [m]
    integer :: i, j, before
    self%bore = 1 + shape%deviation_at(self%angle)/self%clearance
    self%face_bore = 1 + shape%deviation_at(self%face_angle)/self%clearance
    do i = 1, self%around
      before = modulo(i - 2, self%around) + 1
      self%bore_slope(i) = (self%face_bore(i) - self%face_bore(before))/self%turn
    end do
    self%varies_along = self%is_whole .or. shape%barrel > 0
    if (.not. self%varies_along) return
    do i = 1, self%around
      do j = 1, self%along
        self%beyond(j, i) = beyond(self%axial(j), self%angle(i))
        self%face_beyond(j, i) = beyond(self%axial(j), self%face_angle(i))
        self%end_beyond(j, i) = beyond(self%axial(j) + 0.5_dp*self%width*self%pin_radius, self%angle(i))
      end do
      self%end_beyond(0, i) = beyond(self%axial(1) - 0.5_dp*self%width*self%pin_radius, self%angle(i))
    end do
    self%least_beyond = min(minval(self%beyond, 1), minval(self%end_beyond, 1))
    self%least_face_beyond = minval(self%face_beyond, 1)

  contains

    !> Part of the gap over c that varies along the axis, at z [m] and an angle [rad]; on a land z begins at the groove.
    pure real(dp) function beyond(z, angle)
      real(dp), intent(in) :: z, angle
      real(dp) :: from_middle
      from_middle = z
      if (self%is_land) from_middle = z + 0.5_dp*self%supply%groove_width
      beyond = (shape%barrel*(2*from_middle/length)**2 - from_middle*dot_product(shape%tilt, [cos(angle), sin(angle)]))/ &
        self%clearance
    end function beyond
  end subroutine set_shape

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
          from_middle = abs(self%axial(j))
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

  !> Volume of a cell, with its mirror image if it has one, in a gap of the thickness c [m^3].
  pure real(dp) function cell_volume(self)
    class(film_cells_t), intent(in) :: self
    cell_volume = 2*self%clearance*self%pin_radius**2*self%turn*self%width
    if (self%is_whole) cell_volume = 0.5_dp*cell_volume
  end function cell_volume
end module film_cells
