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
  use kinds, only: dp
  use constants, only: pi
  use banded_lu, only: decompose_band, solve_band
  use small_lu, only: decompose, solve
  use film_oil, only: film_oil_t
  use film_cells, only: film_cells_t, ruptured, filled, supplied
  use film_balance, only: film_conditions_t, film_state_t, film_gap_t, film_balance_t, film_shapes_t, find_gap, find_balance, &
    find_matrix, find_columns, find_excess
  use ring_compliance, only: elastic_bore_t, shape_value, shape_slope
  implicit none
  private
  public :: step_solver_t, new_step_solver
  public :: step_solved, step_unfinished, step_closed, step_unbounded

  !> Outcomes of a step: solved; the rounds do not end; a gap closes; the pressure has no bound under the law of the viscosity.
  integer, parameter :: step_solved = 0, step_unfinished = 1, step_closed = 2, step_unbounded = 3

  integer, parameter :: most_rounds = 200
  integer, parameter :: free_rounds = 60          !! rounds after which cells change their kind one at a time
  real(dp), parameter :: shape_tolerance = 1e-10_dp   !! of the last change of an amplitude, over c
  real(dp), parameter :: film_tolerance = 1e-9_dp     !! of the last change of pressures over the largest one, and of fractions
  real(dp), parameter :: small_part = 1e-4_dp         !! pressure over the rate of the step below which that change is not relative
  real(dp), parameter :: full_tolerance = 1e-12_dp    !! excess of a fraction over 1 that is rounding
  real(dp), parameter :: least_gap = 1e-7_dp, most_gap = 1e3_dp   !! gaps over c outside of which no solution is searched
  real(dp), parameter :: most_reduced = 1 - 1e-10_dp  !! alpha q beyond which none is searched
  real(dp), parameter :: most_contraction = 0.3_dp    !! largest ratio of two changes with which the factors are kept
  real(dp), parameter :: most_closing = 0.6_dp    !! largest part of a gap that is lost in a round
  real(dp), parameter :: most_predicted = 0.3_dp      !! largest part of a gap that a prediction may close
  real(dp), parameter :: most_thickening = 0.7_dp !! largest part of the way to the largest reduced pressure in a round

  type :: step_solver_t
    type(film_cells_t) :: cells
    type(film_oil_t) :: oil                       !! in the unit of pressures of `film_balance`
    type(film_shapes_t) :: shapes
    real(dp) :: viscosity = 0                     !! mu_0 [Pa s]
    real(dp) :: pressure_unit = 0                 !! 12 mu_0 R^2/c^2 [Pa s]
    real(dp), allocatable :: compliance(:, :)     !! of the bore, over c, for pressures in that unit
    real(dp), allocatable :: weight(:, :)         !! of the harmonics of the pressure (around, number of shapes)
    type(film_gap_t) :: gap                       !! of the last round
    type(film_balance_t) :: balance               !! of the last round
    logical :: is_free = .false.                  !! the load of the pin is given, not its eccentricity
    real(dp) :: tilt(2) = 0                       !! slope of the pin's axis towards x and y [rad]
    integer :: bore_shapes = 0                    !! number of shapes without those of the eccentricity
    integer, private :: unknowns = 0              !! number of amplitudes that are unknown
    integer :: rounds = 0, factorisations = 0     !! counted since the beginning
    real(dp), allocatable, private :: matrix(:, :)
    real(dp), allocatable, private :: columns(:, :, :)   !! solutions for the columns (along, around, number of shapes)
    real(dp), allocatable, private :: change(:, :)       !! of the film's unknowns (along, place)
    real(dp), allocatable, private :: slope(:, :)        !! dp/dq in the factors; 0 in cells that are not filled (along, place)
    real(dp), allocatable, private :: border(:, :)
    integer, allocatable, private :: pivot(:)
  contains
    procedure :: harmonics
    procedure :: predict
    procedure :: solve_step
    procedure, private :: obstacle
    procedure, private :: factorise
    procedure, private :: find_change
    procedure, private :: allowed_part
    procedure, private :: shift
  end type step_solver_t

contains

  !> The solver for a bearing and its oil.
  pure subroutine new_step_solver(cells, bore, viscosity, pressure_viscosity, is_free, solver)
    type(film_cells_t), intent(in) :: cells
    type(elastic_bore_t), intent(in) :: bore
    real(dp), intent(in) :: viscosity            !! mu_0 [Pa s]
    real(dp), intent(in) :: pressure_viscosity   !! [1/Pa]
    logical, intent(in) :: is_free               !! the load of the pin is given, not its eccentricity
    type(step_solver_t), intent(out) :: solver
    integer :: k, n, m, shapes

    solver%cells = cells
    solver%viscosity = viscosity
    solver%pressure_unit = 12*viscosity*(cells%pin_radius/cells%clearance)**2
    solver%oil%coefficient = pressure_viscosity*solver%pressure_unit
    n = cells%around
    m = cells%along
    solver%bore_shapes = bore%shapes()
    shapes = solver%bore_shapes + 2
    solver%is_free = is_free
    solver%unknowns = merge(shapes, solver%bore_shapes, is_free)
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
    allocate (solver%matrix(-2*m:2*m, n*m), solver%columns(m, n, solver%unknowns), solver%change(m, n), solver%slope(m, n))
    allocate (solver%border(solver%unknowns, solver%unknowns), solver%pivot(solver%unknowns))
  end subroutine new_step_solver

  !> Amplitudes of the shapes of the pressure p averaged over the length of the cells: sum over j and i of weight times p.
  pure function harmonics(self, pressure)
    class(step_solver_t), intent(in) :: self
    real(dp), intent(in) :: pressure(:, :)   !! (along, around)
    real(dp) :: harmonics(size(self%weight, 2))
    harmonics = matmul(sum(pressure, 1), self%weight)
  end function harmonics

  !> Change a state as it has changed from an earlier one, times a ratio of steps in time: a guess for the next step. Nothing is
  !> changed if a gap would close by much.
  pure subroutine predict(self, earlier, ratio, state)
    class(step_solver_t), intent(in) :: self
    type(film_state_t), intent(in) :: earlier
    real(dp), intent(in) :: ratio
    type(film_state_t), intent(inout) :: state
    real(dp) :: change(size(state%amplitude)), rise
    integer :: i, j, changed
    change = ratio*(state%amplitude - earlier%amplitude)
    if (.not. all(matmul(self%shapes%at_cells, change) > -most_predicted*(self%gap%at_cells + self%cells%least_beyond))) return
    state%amplitude = state%amplitude + change
    do i = 1, self%cells%around
      do j = 1, self%cells%along
        associate (q => state%pressure(j, i), f => state%fraction(j, i), kind => state%kind(j, i), alpha => self%oil%coefficient)
          if (kind /= earlier%kind(j, i) .or. kind == supplied) cycle
          if (kind == filled) then
            rise = ratio*(q - earlier%pressure(j, i))
            if (alpha*rise > most_thickening*(1 - alpha*q)) rise = most_thickening*(1/alpha - q)
            q = q + rise
          else
            f = f + ratio*(f - earlier%fraction(j, i))
          end if
        end associate
      end do
    end do
    call change_kinds(state, .false., changed)
  end subroutine predict

  !> Solve a step, from `state` as a guess (cells of the supply are set).
  pure subroutine solve_step(self, conditions, state, outcome)
    class(step_solver_t), intent(inout) :: self
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(inout) :: state
    integer, intent(out) :: outcome
    real(dp) :: shape_change(size(state%amplitude)), part, film_change, size_before, size_now
    logical :: is_factorised, is_singular, has_converged
    integer :: round, changed

    if (.not. self%is_free) state%amplitude(self%bore_shapes + 1:) = -conditions%eccentricity
    is_factorised = .false.
    has_converged = .false.
    size_before = huge(size_before)
    do round = 0, most_rounds
      call find_gap(self%cells, self%shapes, state%amplitude, self%gap)
      outcome = self%obstacle(state)
      if (outcome /= step_solved) return
      call find_balance(self%cells, conditions, state, self%gap, self%balance)
      if (has_converged) return
      self%rounds = self%rounds + 1
      if (.not. is_factorised) then
        call self%factorise(conditions, state, is_singular)
        if (is_singular) exit
      end if
      call self%find_change(conditions, state, shape_change)
      part = self%allowed_part(state, shape_change)
      part = min(part, longest_change(round)/max(tiny(part), maxval(abs(shape_change))))
      call self%shift(part, small_part*conditions%rate, state, film_change)
      call change_kinds(state, round > free_rounds, changed)
      state%amplitude = state%amplitude + part*shape_change
      size_now = maxval(abs(shape_change))
      is_factorised = changed == 0 .and. part >= 1 .and. size_now < most_contraction*size_before
      has_converged = changed == 0 .and. part >= 1 .and. size_now < shape_tolerance .and. &
        (film_change < film_tolerance .or. self%unknowns == 0)
      size_before = size_now
    end do
    outcome = step_unfinished
  end subroutine solve_step

  !> Whether a state is beyond those among which a solution is searched.
  pure integer function obstacle(self, state)
    class(step_solver_t), intent(in) :: self
    type(film_state_t), intent(in) :: state
    obstacle = step_solved
    if (self%oil%coefficient*maxval(state%pressure) > most_reduced) obstacle = step_unbounded
    if (min(minval(self%gap%at_cells + self%cells%least_beyond), minval(self%gap%at_faces + self%cells%least_face_beyond)) &
      < least_gap .or. maxval(self%gap%at_cells) > most_gap) obstacle = step_closed
  end function obstacle

  !> Factorise the film's matrix and that of the border.
  pure subroutine factorise(self, conditions, state, is_singular)
    class(step_solver_t), intent(inout) :: self
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    logical, intent(out) :: is_singular
    real(dp) :: response(size(self%weight, 2))
    integer :: i, k, l, m, n
    m = self%cells%along
    n = m*self%cells%around
    self%factorisations = self%factorisations + 1
    call find_matrix(self%cells, conditions, state%kind, self%gap, 2*m, self%matrix)
    call decompose_band(n, 2*m, self%matrix, is_singular)
    if (is_singular .or. self%unknowns == 0) return
    call find_columns(self%cells, conditions, state, self%balance, self%shapes, self%columns)
    call solve_band(n, 2*m, self%matrix, self%unknowns, self%columns)
    do i = 1, self%cells%around
      self%slope(:, self%cells%place(i)) = merge(self%oil%thickening(state%pressure(:, i)), 0.0_dp, state%kind(:, i) == filled)
    end do
    self%border = 0
    do l = 1, self%unknowns
      response = pressure_response(self, self%columns(:, :, l))
      associate (k => self%bore_shapes)
        self%border(:k, l) = matmul(self%compliance, response(:k))
        if (self%is_free) self%border(k + 1:, l) = response(k + 1:)
      end associate
    end do
    do k = 1, self%bore_shapes
      self%border(k, k) = self%border(k, k) + 1
    end do
    do k = self%bore_shapes + 1, self%unknowns
      self%border(k, k) = self%border(k, k) + least_pressure(conditions)
    end do
    call decompose(self%unknowns, self%border, self%pivot, is_singular)
  end subroutine factorise

  !> Harmonics of the change of the pressure for a change of the film's unknowns (along, place), with p(q) made linear.
  pure function pressure_response(self, change) result(response)
    type(step_solver_t), intent(in) :: self
    real(dp), intent(in) :: change(:, :)
    real(dp) :: response(size(self%weight, 2)), line(self%cells%around)
    integer :: i
    do i = 1, self%cells%around
      line(i) = dot_product(change(:, self%cells%place(i)), self%slope(:, self%cells%place(i)))
    end do
    response = matmul(line, self%weight)
  end function pressure_response

  !> The change of all unknowns: of the film's, and of the amplitudes (0 for those that are given).
  pure subroutine find_change(self, conditions, state, shape_change)
    class(step_solver_t), intent(inout) :: self
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    real(dp), intent(out) :: shape_change(:)
    real(dp) :: pressures(size(self%weight, 2))
    integer :: l, m
    m = self%cells%along
    shape_change = 0
    call find_excess(self%cells, conditions, state, self%gap, self%balance, self%change)
    call solve_band(m*self%cells%around, 2*m, self%matrix, 1, self%change)
    if (self%unknowns == 0) return
    pressures = self%harmonics(self%oil%pressure(state%pressure)) + pressure_response(self, self%change)
    associate (k => self%bore_shapes)
      shape_change(:k) = matmul(self%compliance, pressures(:k)) - state%amplitude(:k)
      if (self%is_free) shape_change(k + 1:) = pressures(k + 1:) - conditions%load
    end associate
    call solve(self%unknowns, self%border, self%pivot, shape_change)
    do l = 1, self%unknowns
      self%change = self%change - shape_change(l)*self%columns(:, :, l)
    end do
  end subroutine find_change

  !> The part of a change that is made in this round: no gap and no way to the largest pressure becomes too much smaller.
  pure real(dp) function allowed_part(self, state, shape_change) result(part)
    class(step_solver_t), intent(in) :: self
    type(film_state_t), intent(in) :: state
    real(dp), intent(in) :: shape_change(:)
    real(dp) :: closing(self%cells%around)
    integer :: i, j
    part = 1
    if (any(abs(shape_change) > 0)) then
      closing = -matmul(self%shapes%at_cells, shape_change)/(self%gap%at_cells + self%cells%least_beyond)
      part = most_closing/max(most_closing, maxval(closing))
      closing = -matmul(self%shapes%at_faces, shape_change)/(self%gap%at_faces + self%cells%least_face_beyond)
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

  !> Largest change of an amplitude over c in a round: it becomes smaller while the rounds do not end.
  pure real(dp) function longest_change(round)
    integer, intent(in) :: round
    longest_change = 1/(1 + 0.1_dp*max(0, round - 8)**2)
  end function longest_change

  !> A pressure that is small beside that of any film that acts, added to the stiffness: a film may carry nothing and have none.
  pure real(dp) function least_pressure(conditions)
    type(film_conditions_t), intent(in) :: conditions
    least_pressure = 1e-6_dp*norm2(conditions%load) + 1e-9_dp*conditions%rate
  end function least_pressure

  !> Change the film's unknowns by a part of `change`. `film_change`: the largest change of a fraction, or of a pressure over the
  !> largest one, `floor` at least.
  pure subroutine shift(self, part, floor, state, film_change)
    class(step_solver_t), intent(in) :: self
    real(dp), intent(in) :: part, floor
    type(film_state_t), intent(inout) :: state
    real(dp), intent(out) :: film_change
    real(dp) :: pressure_change
    integer :: i, j
    film_change = 0
    pressure_change = 0
    do i = 1, self%cells%around
      do j = 1, self%cells%along
        associate (change => part*self%change(j, self%cells%place(i)))
          if (state%kind(j, i) == filled) then
            state%pressure(j, i) = state%pressure(j, i) + change
            pressure_change = max(pressure_change, abs(change))
          else if (state%kind(j, i) == ruptured) then
            state%fraction(j, i) = state%fraction(j, i) + change
            film_change = max(film_change, abs(change))
          end if
        end associate
      end do
    end do
    film_change = max(film_change, pressure_change/max(floor, maxval(state%pressure)))
  end subroutine shift

  !> Let filled cells without pressure rupture, and make cells full whose fraction is above 1. `changed`: number of such cells. With
  !> `singly` only the first of them changes: since each set of kinds has one solution, this order cannot repeat a set (Murty 1974).
  pure subroutine change_kinds(state, singly, changed)
    type(film_state_t), intent(inout) :: state
    logical, intent(in) :: singly
    integer, intent(out) :: changed
    integer :: i, j
    changed = 0
    do i = 1, size(state%kind, 2)
      do j = 1, size(state%kind, 1)
        associate (q => state%pressure(j, i), f => state%fraction(j, i), kind => state%kind(j, i))
          if (.not. (kind == filled .and. q <= 0 .or. kind == ruptured .and. f > 1 + full_tolerance)) cycle
          changed = changed + 1
          if (singly .and. changed > 1) cycle
          kind = merge(ruptured, filled, kind == filled)
          q = 0
          f = 1
        end associate
      end do
    end do
  end subroutine change_kinds
end module film_step
