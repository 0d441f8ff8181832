!> The balance of oil in the cells of a film with memory, and its derivatives.
!>
!>     d(f h)/dt + (omega/2) d(f h)/dtheta = div(h^3/(12 mu_0) grad q),   q >= 0,  f <= 1,  q (1 - f) = 0
!>
!> (f: film fraction, q: reduced pressure of `film_oil`; Jakobsson, Floberg and Olsson's conditions as a complementarity), by finite
!> volumes and an implicit Euler step. Film thicknesses are over the clearance c, lengths over the pin's radius R, pressures over
!> 12 mu_0 R^2/c^2, so that pressures and balances are rates [1/s].
!>
!> Without memory (Reynolds' condition) the film is full everywhere; a ruptured cell, where q = 0, lacks oil in its balance. The
!> unknown f of such a cell is then 1 less this lack over a rate.
module film_balance
  use kinds, only: dp
  use film_cells, only: film_cells_t, ruptured, filled, supplied
  implicit none
  private
  public :: film_conditions_t, film_state_t, film_gap_t, film_balance_t, film_shapes_t
  public :: new_state, find_gap, find_balance, find_matrix, find_columns, find_excess

  !> What is given in a step.
  type :: film_conditions_t
    logical :: has_memory = .true.           !! .false.: Reynolds' condition
    real(dp) :: rate = 0                     !! reciprocal of the step in time [1/s]
    real(dp) :: speed = 0                    !! omega, of the pin relative to the bearing, x towards y [rad/s]
    real(dp) :: supply = 0, ends = 0         !! reduced pressures in the supply and at the ends of the bearing
    real(dp) :: load(2) = 0                  !! on a free pin, over pi R L (L: length of the cells and their images), a pressure
    real(dp) :: eccentricity(2) = 0          !! of a guided pin, over c
    real(dp), allocatable :: content(:, :)   !! f h before the step (along, around)
  end type film_conditions_t

  !> The film at one time.
  type :: film_state_t
    integer, allocatable :: kind(:, :)       !! of each cell (along, around): ruptured, filled or supplied
    real(dp), allocatable :: pressure(:, :)  !! reduced; 0 in ruptured cells
    real(dp), allocatable :: fraction(:, :)  !! f; 1 in the other cells
    real(dp), allocatable :: amplitude(:)    !! of the shapes of the gap: those of the bore, and -e_x, -e_y, over c
  end type film_state_t

  !> The shapes of the gap: h = bore + sum of amplitude times shape. The last two are cos theta and sin theta, for the eccentricity.
  type :: film_shapes_t
    real(dp), allocatable :: at_cells(:, :), at_faces(:, :)   !! (around, number of shapes)
    real(dp), allocatable :: slopes(:, :)   !! derivatives with respect to theta, at the cells
  end type film_shapes_t

  !> Film thickness at the middles of the cells and at the faces between cells i and i + 1, without what varies along the axis.
  type :: film_gap_t
    real(dp), allocatable :: at_cells(:), at_faces(:)   !! (around)
  end type film_gap_t

  !> Flows of all cells, over the area of a cell.
  type :: film_balance_t
    real(dp), allocatable :: outflow(:, :)     !! net flow out of each cell (along, around)
    real(dp), allocatable :: cell_slope(:, :)  !! its derivative with respect to the thickness at the cell
    real(dp), allocatable :: face_slope(:, :)  !! derivative of the flow from cell i to i + 1 with respect to the thickness there
    real(dp) :: side = 0                       !! sum of the flows out of the end of the bearing
    real(dp) :: inlet = 0                      !! sum of the flows from a circumferential groove
  end type film_balance_t

contains

  !> A full film without pressure. `shapes`: number of shapes of the gap, those of the eccentricity included.
  pure type(film_state_t) function new_state(cells, shapes) result(state)
    type(film_cells_t), intent(in) :: cells
    integer, intent(in) :: shapes
    allocate (state%kind(cells%along, cells%around), source=filled)
    allocate (state%pressure(cells%along, cells%around), source=0.0_dp)
    allocate (state%fraction(cells%along, cells%around), source=1.0_dp)
    allocate (state%amplitude(shapes), source=0.0_dp)
  end function new_state

  !> The film thickness for the amplitudes of the shapes.
  pure subroutine find_gap(cells, shapes, amplitude, gap)
    type(film_cells_t), intent(in) :: cells
    type(film_shapes_t), intent(in) :: shapes
    real(dp), intent(in) :: amplitude(:)
    type(film_gap_t), intent(inout) :: gap
    gap%at_cells = cells%bore + matmul(shapes%at_cells, amplitude)
    gap%at_faces = cells%face_bore + matmul(shapes%at_faces, amplitude)
  end subroutine find_gap

  !> Conductance of a face over the square of the distance of two cells' middles: twice that of the film beside a supply, whose edge
  !> is half a cell away, and none inside a supply.
  elemental real(dp) function conductance(kind, other, thickness_cubed_per_square)
    integer, intent(in) :: kind, other
    real(dp), intent(in) :: thickness_cubed_per_square
    conductance = thickness_cubed_per_square
    if (kind == supplied .or. other == supplied) conductance = 2*conductance
    if (kind == supplied .and. other == supplied) conductance = 0
  end function conductance

  !> The net flows out of the cells, in balance with the change of their content: (f h - content)*rate + outflow = 0 outside the
  !> supply. `balance` has its arrays allocated.
  pure subroutine find_balance(cells, conditions, state, gap, balance)
    type(film_cells_t), intent(in) :: cells
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    type(film_gap_t), intent(in) :: gap
    type(film_balance_t), intent(inout) :: balance
    real(dp) :: along_axis, drag, cubed, flow, fall, drained, face, before
    integer :: i, j, e, m

    m = cells%along
    balance%outflow = 0
    balance%side = 0
    balance%inlet = 0
    associate (q => state%pressure, f => state%fraction, kind => state%kind, out => balance%outflow)
      do i = 1, cells%around
        e = cells%next(i)
        drag = 0.5_dp*conditions%speed/cells%turn
        face = gap%at_faces(i)
        cubed = gap%at_faces(i)**3/cells%turn**2
        do j = 1, m
          balance%face_slope(j, i) = 0
          if (kind(j, i) == supplied .and. kind(j, e) == supplied) cycle
          if (cells%varies_along) then
            face = gap%at_faces(i) + cells%face_beyond(j, i)
            cubed = face**3/cells%turn**2
          end if
          fall = conductance(kind(j, i), kind(j, e), cubed)*(q(j, i) - q(j, e))
          flow = drag
          if (conditions%has_memory) flow = drag*merge(f(j, i), f(j, e), conditions%speed > 0)
          balance%face_slope(j, i) = flow + 3*fall/face
          flow = flow*face + fall
          out(j, i) = out(j, i) + flow
          out(j, e) = out(j, e) - flow
        end do
      end do
      do i = 1, cells%around
        face = gap%at_cells(i)   ! at the end of the cell
        before = face            ! at its beginning
        along_axis = gap%at_cells(i)**3/cells%width**2
        drained = 0   ! through the face before cell j
        if (cells%is_whole .and. kind(1, i) /= supplied) then
          before = face + cells%end_beyond(0, i)
          drained = 2*before**3/cells%width**2*(conditions%ends - q(1, i))
          balance%side = balance%side - drained
        end if
        do j = 1, m
          flow = 0
          if (cells%varies_along) then
            before = gap%at_cells(i) + cells%end_beyond(j - 1, i)
            face = gap%at_cells(i) + cells%end_beyond(j, i)
            along_axis = face**3/cells%width**2
          end if
          if (j < m) flow = conductance(kind(j, i), kind(j + 1, i), along_axis)*(q(j, i) - q(j + 1, i))
          if (j == 1 .and. cells%is_land) then
            drained = 2*before**3/cells%width**2*(conditions%supply - q(1, i))
            balance%inlet = balance%inlet + drained
          end if
          if (j == m .and. kind(m, i) /= supplied) then
            flow = 2*along_axis*(q(m, i) - conditions%ends)
            balance%side = balance%side + flow
          end if
          out(j, i) = out(j, i) + flow - drained
          balance%cell_slope(j, i) = 3*(flow - drained)/gap%at_cells(i)
          if (cells%varies_along) balance%cell_slope(j, i) = 3*(flow/face - drained/before)
          drained = flow
        end do
      end do
    end associate
  end subroutine find_balance

  !> The matrix of the derivatives of the balances with respect to the unknowns, the pressure of a filled cell and the fraction of a
  !> ruptured one, for `banded_lu`; the cells are in the order j first, then place. Its columns are diagonally dominant, since what
  !> leaves a cell enters another one or is lost.
  pure subroutine find_matrix(cells, conditions, kind, gap, band, matrix)
    type(film_cells_t), intent(in) :: cells
    type(film_conditions_t), intent(in) :: conditions
    integer, intent(in) :: kind(:, :)
    type(film_gap_t), intent(in) :: gap
    integer, intent(in) :: band   !! 2 along
    real(dp), intent(inout) :: matrix(-band:band, cells%along*cells%around)
    real(dp) :: along_axis, cubed, drag, first
    integer :: i, j, k, e, m, other

    m = cells%along
    matrix = 0
    do i = 1, cells%around
      e = cells%next(i)
      drag = 0.5_dp*conditions%speed*gap%at_faces(i)/cells%turn
      cubed = gap%at_faces(i)**3/cells%turn**2
      along_axis = gap%at_cells(i)**3/cells%width**2
      first = along_axis   ! at the beginning of the first cell
      if (cells%varies_along) first = (gap%at_cells(i) + cells%end_beyond(0, i))**3/cells%width**2
      do j = 1, m
        if (cells%varies_along) then
          drag = 0.5_dp*conditions%speed*(gap%at_faces(i) + cells%face_beyond(j, i))/cells%turn
          cubed = (gap%at_faces(i) + cells%face_beyond(j, i))**3/cells%turn**2
          along_axis = (gap%at_cells(i) + cells%end_beyond(j, i))**3/cells%width**2
        end if
        k = (cells%place(i) - 1)*m + j
        other = (cells%place(e) - 1)*m + j
        call connect(band, matrix, kind(j, i), kind(j, e), k, other, conductance(kind(j, i), kind(j, e), cubed))
        if (conditions%has_memory .and. conditions%speed > 0) call carry(band, matrix, kind(j, i), kind(j, e), k, other, drag)
        if (conditions%has_memory .and. conditions%speed < 0) call carry(band, matrix, kind(j, e), kind(j, i), other, k, -drag)
        if (j < m) call connect(band, matrix, kind(j, i), kind(j + 1, i), k, k + 1, &
          conductance(kind(j, i), kind(j + 1, i), along_axis))
        select case (kind(j, i))
        case (filled)
          if (j == m) matrix(0, k) = matrix(0, k) + 2*along_axis
          if (j == 1 .and. (cells%is_land .or. cells%is_whole)) matrix(0, k) = matrix(0, k) + 2*first
        case (ruptured)
          matrix(0, k) = matrix(0, k) + merge(conditions%rate*(gap%at_cells(i) + cells%beyond(j, i)), &
            lack_rate(conditions), conditions%has_memory)
        case default
          matrix(0, k) = 1
        end select
      end do
    end do
  end subroutine find_matrix

  !> The flow between two cells by the difference of their pressures.
  pure subroutine connect(band, matrix, kind_k, kind_l, k, l, conductance)
    integer, intent(in) :: band
    real(dp), intent(inout) :: matrix(-band:, :)
    integer, intent(in) :: kind_k, kind_l, k, l
    real(dp), intent(in) :: conductance
    if (kind_k == filled) then
      matrix(0, k) = matrix(0, k) + conductance
      if (kind_l /= supplied) matrix(l - k, k) = matrix(l - k, k) - conductance
    end if
    if (kind_l == filled) then
      matrix(0, l) = matrix(0, l) + conductance
      if (kind_k /= supplied) matrix(k - l, l) = matrix(k - l, l) - conductance
    end if
  end subroutine connect

  !> The flow that the pin drags from a ruptured cell k into cell l.
  pure subroutine carry(band, matrix, kind_k, kind_l, k, l, drag)
    integer, intent(in) :: band
    real(dp), intent(inout) :: matrix(-band:, :)
    integer, intent(in) :: kind_k, kind_l, k, l
    real(dp), intent(in) :: drag
    if (kind_k /= ruptured) return
    matrix(0, k) = matrix(0, k) + drag
    if (kind_l /= supplied) matrix(l - k, k) = matrix(l - k, k) - drag
  end subroutine carry

  !> The derivatives of the balances with respect to the amplitudes of the shapes, in the order of `find_matrix`.
  pure subroutine find_columns(cells, conditions, state, balance, shapes, columns)
    type(film_cells_t), intent(in) :: cells
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    type(film_balance_t), intent(in) :: balance
    type(film_shapes_t), intent(in) :: shapes
    real(dp), intent(inout) :: columns(:, :, :)   !! (along, around, number of the first shapes that are wanted, or more)
    real(dp) :: own, east, west, stored
    integer :: i, j, l, before
    do l = 1, min(size(columns, 3), size(shapes%at_cells, 2))
      do i = 1, cells%around
        before = modulo(i - 2, cells%around) + 1
        associate (p => cells%place(i))
          own = shapes%at_cells(i, l)
          east = shapes%at_faces(i, l)
          west = shapes%at_faces(before, l)
          do j = 1, cells%along
            stored = merge(state%fraction(j, i), 1.0_dp, conditions%has_memory)
            columns(j, p, l) = own*(conditions%rate*stored + balance%cell_slope(j, i)) + east*balance%face_slope(j, i) &
              - west*balance%face_slope(j, before)
            if (state%kind(j, i) == supplied) columns(j, p, l) = 0
          end do
        end associate
      end do
    end do
  end subroutine find_columns

  !> The rate over which the lack of oil in a film without memory is measured.
  pure real(dp) function lack_rate(conditions)
    type(film_conditions_t), intent(in) :: conditions
    lack_rate = conditions%rate + abs(conditions%speed)
  end function lack_rate

  !> The balances with the opposite sign, (content - f h)*rate - outflow, in the same order; 0 in the supply.
  pure subroutine find_excess(cells, conditions, state, gap, balance, excess)
    type(film_cells_t), intent(in) :: cells
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    type(film_gap_t), intent(in) :: gap
    type(film_balance_t), intent(in) :: balance
    real(dp), intent(out) :: excess(:, :)   !! (along, around)
    integer :: i
    do i = 1, cells%around
      associate (p => cells%place(i))
        if (conditions%has_memory) then
          excess(:, p) = conditions%rate*(conditions%content(:, i) - state%fraction(:, i)*(gap%at_cells(i) + cells%beyond(:, i))) &
            - balance%outflow(:, i)
        else
          excess(:, p) = conditions%rate*(conditions%content(:, i) - (gap%at_cells(i) + cells%beyond(:, i))) &
            - balance%outflow(:, i) + lack_rate(conditions)*(1 - state%fraction(:, i))
        end if
        where (state%kind(:, i) == supplied) excess(:, p) = 0
      end associate
    end do
  end subroutine find_excess
end module film_balance
