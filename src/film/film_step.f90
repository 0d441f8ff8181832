!> One implicit step of a film with memory: which cells are full, their pressures or film fractions, the shape of the bore, and the
!> eccentricity that carries the load.
!>
!> A cell has one unknown: its pressure if it is full, its film fraction if not. In each round all balances are solved, then cells
!> whose pressure is not positive rupture, and those whose fraction is above 1 become full: Newton's method for min(q, 1 - f) = 0.
!> The amplitudes x of the gap's shapes border this system. Each has a column, the derivative of the balances, and a condition,
!>
!>     a_k - sum of C_kl p_l = 0 for the bore (p_l: harmonics of the pressure),   -pi R L p_1 + load = 0 for the eccentricity
!>
!> While no cell changes its kind the factors of a round serve for the next ones, which need a single right-hand side.
module film_step
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use banded_lu, only: decompose_band, solve_band
  use small_lu, only: decompose, solve
  use film_oil, only: film_oil_t
  use film_cells, only: film_cells_t, ruptured, filled, supplied
  use film_balance, only: film_conditions_t, film_state_t, film_gap_t, film_balance_t, film_shapes_t, find_gap, find_balance, &
    find_matrix, find_columns, find_excess
  use ring_compliance, only: elastic_bore_t, shape_value, shape_slope
  implicit none
  private
  public :: film_solver_t, new_film_solver

  integer, parameter :: most_rounds = 400
  integer, parameter :: free_rounds = 30          !! rounds after which cells change their kind one at a time
  real(dp), parameter :: shape_tolerance = 1e-10_dp   !! of the last change of an amplitude, over c
  real(dp), parameter :: film_tolerance = 1e-9_dp     !! of the last change of pressures over the largest one, and of fractions
  real(dp), parameter :: full_tolerance = 1e-12_dp    !! excess of a fraction over 1 that is rounding
  real(dp), parameter :: most_contraction = 0.3_dp    !! largest ratio of two changes with which the factors are kept
  real(dp), parameter :: most_closing = 0.6_dp    !! largest part of a gap that is lost in a round
  real(dp), parameter :: most_thickening = 0.7_dp !! largest part of the way to the largest reduced pressure in a round

  type :: film_solver_t
    type(film_cells_t) :: cells
    type(film_oil_t) :: oil                       !! in the unit of pressures of `film_balance`
    type(film_shapes_t) :: shapes
    real(dp) :: viscosity = 0                     !! mu_0 [Pa s]
    real(dp) :: pressure_unit = 0                 !! 12 mu_0 R^2/c^2 [Pa s]
    real(dp), allocatable :: compliance(:, :)     !! of the bore, over c, for pressures in that unit
    real(dp), allocatable :: weight(:, :)         !! of the harmonics of the pressure (around, number of shapes)
    type(film_gap_t) :: gap                       !! of the last round
    type(film_balance_t) :: balance               !! of the last round
    integer :: bore_shapes = 0                    !! number of shapes without those of the eccentricity
    integer :: rounds = 0, factorisations = 0     !! counted since the beginning
    real(dp), allocatable, private :: matrix(:, :)
    real(dp), allocatable, private :: columns(:, :, :)   !! solutions for the columns (along, around, number of shapes)
    real(dp), allocatable, private :: change(:, :)       !! of the film's unknowns (along, place)
    real(dp), allocatable, private :: slope(:, :)        !! dp/dq in the factors; 0 in cells that are not filled (along, place)
    real(dp), allocatable, private :: border(:, :)
    integer, allocatable, private :: pivot(:)
  contains
    procedure :: harmonics
    procedure :: solve_step
    procedure, private :: factorise
    procedure, private :: find_change
    procedure, private :: allowed_part
    procedure, private :: shift
  end type film_solver_t

contains

  !> The solver for a bearing and its oil.
  pure subroutine new_film_solver(cells, bore, viscosity, pressure_viscosity, solver)
    type(film_cells_t), intent(in) :: cells
    type(elastic_bore_t), intent(in) :: bore
    real(dp), intent(in) :: viscosity            !! mu_0 [Pa s]
    real(dp), intent(in) :: pressure_viscosity   !! [1/Pa]
    type(film_solver_t), intent(out) :: solver
    integer :: k, n, m, shapes

    solver%cells = cells
    solver%viscosity = viscosity
    solver%pressure_unit = 12*viscosity*(cells%pin_radius/cells%clearance)**2
    solver%oil%coefficient = pressure_viscosity*solver%pressure_unit
    n = cells%around
    m = cells%along
    solver%bore_shapes = bore%shapes()
    shapes = solver%bore_shapes + 2
    allocate (solver%compliance(solver%bore_shapes, solver%bore_shapes))
    if (solver%bore_shapes > 0) solver%compliance = bore%compliance*solver%pressure_unit/cells%clearance
    allocate (solver%shapes%at_cells(n, shapes), solver%shapes%at_faces(n, shapes), solver%weight(n, shapes))
    allocate (solver%shapes%slopes(n, shapes))
    do k = 1, solver%bore_shapes
      solver%shapes%at_cells(:, k) = shape_value(bore%harmonic(k), bore%is_sine(k), cells%angle)
      solver%shapes%at_faces(:, k) = shape_value(bore%harmonic(k), bore%is_sine(k), cells%face_angle)
      solver%shapes%slopes(:, k) = shape_slope(bore%harmonic(k), bore%is_sine(k), cells%angle)
    end do
    do k = 1, 2
      solver%shapes%at_cells(:, solver%bore_shapes + k) = shape_value(1, k == 2, cells%angle)
      solver%shapes%at_faces(:, solver%bore_shapes + k) = shape_value(1, k == 2, cells%face_angle)
      solver%shapes%slopes(:, solver%bore_shapes + k) = shape_slope(1, k == 2, cells%angle)
    end do
    solver%weight = solver%shapes%at_cells*cells%turn/(pi*m)
    do k = 1, solver%bore_shapes
      if (bore%harmonic(k) == 0) solver%weight(:, k) = 0.5_dp*solver%weight(:, k)
    end do
    allocate (solver%gap%at_cells(n), solver%gap%at_faces(n))
    allocate (solver%balance%outflow(m, n), solver%balance%cell_slope(m, n), solver%balance%face_slope(m, n))
    allocate (solver%matrix(-2*m:2*m, n*m), solver%columns(m, n, shapes), solver%change(m, n), solver%slope(m, n))
    allocate (solver%border(shapes, shapes), solver%pivot(shapes))
  end subroutine new_film_solver

  !> Amplitudes of the shapes of the pressure p averaged over the length of the cells: sum over j and i of weight times p.
  pure function harmonics(self, pressure)
    class(film_solver_t), intent(in) :: self
    real(dp), intent(in) :: pressure(:, :)   !! (along, around)
    real(dp) :: harmonics(size(self%weight, 2))
    harmonics = matmul(sum(pressure, 1), self%weight)
  end function harmonics

  !> Solve a step, from `state` as a guess (cells of the supply are set). `has_converged` is false if the rounds do not end.
  pure subroutine solve_step(self, conditions, state, has_converged)
    class(film_solver_t), intent(inout) :: self
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(inout) :: state
    logical, intent(out) :: has_converged
    real(dp) :: shape_change(size(state%amplitude)), part, film_change, size_before, size_now
    logical :: is_factorised, is_singular
    integer :: round, changed, unknowns

    unknowns = self%bore_shapes + merge(2, 0, conditions%is_free)
    is_factorised = .false.
    has_converged = .false.
    size_before = huge(size_before)
    do round = 0, most_rounds
      call find_gap(self%cells, self%shapes, state%amplitude, self%gap)
      call find_balance(self%cells, conditions, state, self%gap, self%balance)
      if (has_converged) return
      self%rounds = self%rounds + 1
      if (.not. is_factorised) then
        call self%factorise(conditions, state, unknowns, is_singular)
        if (is_singular) return
      end if
      call self%find_change(conditions, state, unknowns, shape_change)
      part = self%allowed_part(state, shape_change)
      call self%shift(state, part, round > free_rounds, film_change, changed)
      state%amplitude = state%amplitude + part*shape_change
      size_now = maxval(abs(shape_change))
      is_factorised = changed == 0 .and. part >= 1 .and. size_now < most_contraction*size_before
      has_converged = changed == 0 .and. part >= 1 .and. size_now < shape_tolerance .and. &
        (film_change < film_tolerance .or. unknowns == 0)
      size_before = size_now
    end do
  end subroutine solve_step

  !> Factorise the film's matrix and that of the border.
  pure subroutine factorise(self, conditions, state, unknowns, is_singular)
    class(film_solver_t), intent(inout) :: self
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    integer, intent(in) :: unknowns
    logical, intent(out) :: is_singular
    real(dp) :: response(size(self%weight, 2))
    integer :: i, k, l, m, n
    m = self%cells%along
    n = m*self%cells%around
    self%factorisations = self%factorisations + 1
    call find_matrix(self%cells, conditions, state%kind, self%gap, 2*m, self%matrix)
    call decompose_band(n, 2*m, self%matrix, is_singular)
    if (is_singular .or. unknowns == 0) return
    call find_columns(self%cells, conditions, state, self%balance, self%shapes, self%columns(:, :, :unknowns))
    call solve_band(n, 2*m, self%matrix, unknowns, self%columns)
    do i = 1, self%cells%around
      self%slope(:, self%cells%place(i)) = merge(self%oil%thickening(state%pressure(:, i)), 0.0_dp, state%kind(:, i) == filled)
    end do
    self%border = 0
    do l = 1, unknowns
      response = pressure_response(self, self%columns(:, :, l))
      associate (k => self%bore_shapes)
        self%border(:k, l) = matmul(self%compliance, response(:k))
        self%border(k + 1:, l) = response(k + 1:)
      end associate
    end do
    do k = 1, self%bore_shapes
      self%border(k, k) = self%border(k, k) + 1
    end do
    do k = self%bore_shapes + 1, unknowns
      self%border(k, k) = self%border(k, k) + 1e-6_dp*max(norm2(conditions%load), sqrt(tiny(1.0_dp)))
    end do
    associate (part => self%border(:unknowns, :unknowns))
      call decompose(unknowns, part, self%pivot(:unknowns), is_singular)
    end associate
  end subroutine factorise

  !> Harmonics of the change of the pressure for a change of the film's unknowns (along, place), with p(q) made linear.
  pure function pressure_response(self, change) result(response)
    type(film_solver_t), intent(in) :: self
    real(dp), intent(in) :: change(:, :)
    real(dp) :: response(size(self%weight, 2)), line(self%cells%around)
    integer :: i
    do i = 1, self%cells%around
      line(i) = dot_product(change(:, self%cells%place(i)), self%slope(:, self%cells%place(i)))
    end do
    response = matmul(line, self%weight)
  end function pressure_response

  !> The change of all unknowns: of the film's, and of the amplitudes (0 for those that are given).
  pure subroutine find_change(self, conditions, state, unknowns, shape_change)
    class(film_solver_t), intent(inout) :: self
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    integer, intent(in) :: unknowns
    real(dp), intent(out) :: shape_change(:)
    real(dp) :: pressures(size(self%weight, 2))
    integer :: l, m
    m = self%cells%along
    shape_change = 0
    call find_excess(self%cells, conditions, state, self%gap, self%balance, self%change)
    call solve_band(m*self%cells%around, 2*m, self%matrix, 1, self%change)
    if (unknowns == 0) return
    pressures = self%harmonics(self%oil%pressure(state%pressure)) + pressure_response(self, self%change)
    associate (k => self%bore_shapes)
      shape_change(:k) = matmul(self%compliance, pressures(:k)) - state%amplitude(:k)
      if (conditions%is_free) shape_change(k + 1:) = pressures(k + 1:) - conditions%load
    end associate
    call solve(unknowns, self%border(:unknowns, :unknowns), self%pivot, shape_change)
    do l = 1, unknowns
      self%change = self%change - shape_change(l)*self%columns(:, :, l)
    end do
  end subroutine find_change

  !> The part of a change that is made in this round: no gap and no way to the largest pressure becomes too much smaller.
  pure real(dp) function allowed_part(self, state, shape_change) result(part)
    class(film_solver_t), intent(in) :: self
    type(film_state_t), intent(in) :: state
    real(dp), intent(in) :: shape_change(:)
    real(dp) :: closing(self%cells%around)
    integer :: i, j
    part = 1
    if (any(abs(shape_change) > 0)) then
      closing = -matmul(self%shapes%at_cells, shape_change)/self%gap%at_cells
      part = most_closing/max(most_closing, maxval(closing))
      closing = -matmul(self%shapes%at_faces, shape_change)/self%gap%at_faces
      part = min(part, most_closing/max(most_closing, maxval(closing)))
    end if
    if (.not. self%oil%coefficient > 0) return
    do i = 1, self%cells%around
      do j = 1, self%cells%along
        if (state%kind(j, i) /= filled) cycle
        associate (rise => self%oil%coefficient*self%change(j, self%cells%place(i)), &
          room => most_thickening*(1 - self%oil%coefficient*state%pressure(j, i)))
          if (rise > room) part = min(part, room/rise)
        end associate
      end do
    end do
  end function allowed_part

  !> Change the film's unknowns by a part of `change`, and the kinds of the cells with them. `film_change`: largest change of a
  !> fraction, or of a pressure over the largest one; `changed`: number of cells that should have another kind. With `singly` only
  !> the first of them gets it: since each set of kinds has one solution, this order cannot repeat a set (Murty 1974).
  pure subroutine shift(self, state, part, singly, film_change, changed)
    class(film_solver_t), intent(in) :: self
    type(film_state_t), intent(inout) :: state
    real(dp), intent(in) :: part
    logical, intent(in) :: singly
    real(dp), intent(out) :: film_change
    integer, intent(out) :: changed
    real(dp) :: pressure_change
    integer :: i, j
    changed = 0
    film_change = 0
    pressure_change = 0
    do i = 1, self%cells%around
      do j = 1, self%cells%along
        associate (q => state%pressure(j, i), f => state%fraction(j, i), kind => state%kind(j, i), &
          change => self%change(j, self%cells%place(i)))
          if (kind == filled) then
            q = q + part*change
            pressure_change = max(pressure_change, abs(change))
            if (q > 0) cycle
          else if (kind == ruptured) then
            f = f + part*change
            film_change = max(film_change, abs(change))
            if (f <= 1 + full_tolerance) cycle
          else
            cycle
          end if
          changed = changed + 1
          if (singly .and. changed > 1) cycle
          kind = merge(ruptured, filled, kind == filled)
          q = 0
          f = 1
        end associate
      end do
    end do
    if (pressure_change > 0) film_change = max(film_change, pressure_change/max(pressure_change, maxval(state%pressure)))
  end subroutine shift
end module film_step
