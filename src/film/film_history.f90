!> A film with memory over a cycle: marched with implicit Euler steps from row to row of a duty, until the oil in it repeats.
!>
!> The film begins full at the eccentricity of the first row. A duty of one row is a steady state: one step, so long that the
!> content of the cells does not act any more.
module film_history
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use gudgeon_errors, only: error_t, fail, status_integration
  use gudgeon_bearing, only: bearing_t
  use film_cells, only: film_cells_t, supply_t, new_film_cells, supply_none, filled, supplied
  use film_balance, only: film_conditions_t, film_state_t, new_state, find_gap
  use film_step, only: film_solver_t, new_film_solver
  use film_results, only: film_row_t, film_field_t, film_summary_t, find_row, find_field
  use ring_compliance, only: elastic_bore_t
  implicit none
  private
  public :: film_history_t, film_duty_t

  real(dp), parameter :: steady_rate = 1e-10_dp      !! reciprocal of the time of a steady step, over the rates of the film
  real(dp), parameter :: most_predicted = 0.3_dp     !! largest part of a gap that a prediction may close

  !> What the bearing is given over a cycle, in rows; the last of several rows is the first one of the next cycle.
  type :: film_duty_t
    real(dp), allocatable :: time(:)               !! increasing [s]
    real(dp), allocatable :: pin_speed(:)          !! of the pin relative to the bearing, x towards y [rad/s]
    real(dp), allocatable :: eccentricity(:, :)    !! (2, rows); with a load only that of the first row is used [m]
    real(dp), allocatable :: load(:, :)            !! on the pin (2, rows); unallocated: the eccentricity is given [N]
    real(dp), allocatable :: supply_pressure(:)    !! above ambient; unallocated: `supply_pressure` of the history [Pa]
  end type film_duty_t

  type :: film_history_t
    type(bearing_t) :: bearing
    real(dp) :: viscosity = 0               !! mu_0 [Pa s]
    real(dp) :: pressure_viscosity = 0      !! alpha of Barus [1/Pa]
    real(dp) :: ambient_over_cavitation = 0 !! ambient pressure less cavitation pressure [Pa]; > 0: the ends are under oil
    type(supply_t) :: supply
    real(dp) :: supply_pressure = 0         !! above ambient [Pa]
    type(elastic_bore_t) :: bore            !! without shapes: rigid
    integer :: around = 96, along = 8       !! cells round the bearing and along half of it
    integer :: substeps = 1                 !! steps between two rows of the duty
    integer :: most_cycles = 10
    real(dp) :: cycle_tolerance = 1e-3_dp   !! content change of a settled cycle
    real(dp), allocatable :: field_times(:) !! fields are kept at the ends of the steps next to these times of the last cycle [s]
    type(film_row_t), allocatable :: rows(:)       !! result: the ends of the intervals of the last cycle
    type(film_field_t), allocatable :: fields(:)   !! result
    type(film_summary_t) :: summary                !! result
    type(film_solver_t), private :: solver
    type(film_conditions_t), private :: conditions
    type(film_state_t), private :: state
    real(dp), allocatable, private :: shape_rate(:)      !! mean rate of the amplitudes in the last step [1/s]
    real(dp), private :: load_before(2) = 0 !! of the last step, as in `conditions`
    real(dp), private :: turned = 0         !! angle of the pin since the first row [rad]
    real(dp), private :: time = 0           !! end of the present step [s]
    logical, private :: is_steady = .false. !! the duty has one row
  contains
    procedure :: march
    procedure, private :: begin
    procedure, private :: begin_cycle
    procedure, private :: march_cycle
    procedure, private :: set_conditions
    procedure, private :: set_supply
    procedure, private :: make_step
    procedure, private :: raise_load
    procedure, private :: oil_content
  end type film_history_t

contains

  !> March the film through the duty. `rows` has the last cycle, or after an error (a wrong supply, no convergence, no steady state)
  !> the rows of the present cycle until then.
  pure subroutine march(self, duty, error)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: content, before
    integer :: cycle_number

    call self%begin(duty, error)
    if (allocated(error)) return
    content = self%oil_content()
    do cycle_number = 1, merge(1, self%most_cycles, self%is_steady)
      before = content
      call self%begin_cycle(duty)
      call self%march_cycle(duty, error)
      content = self%oil_content()
      self%summary%cycles = cycle_number
      self%summary%content_change = abs(content - before)/content
      self%summary%rounds = self%solver%rounds
      self%summary%factorisations = self%solver%factorisations
      if (allocated(error) .or. self%summary%content_change < self%cycle_tolerance) return
    end do
  end subroutine march

  !> A full film at the eccentricity of the first row.
  pure subroutine begin(self, duty, error)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    type(error_t), allocatable, intent(out) :: error
    type(film_cells_t) :: cells

    self%rows = [film_row_t ::]
    self%fields = [film_field_t ::]
    self%summary = film_summary_t()
    call new_film_cells(self%bearing, self%supply, self%around, self%along, cells, error)
    if (allocated(error)) return
    call new_film_solver(cells, self%bore, self%viscosity, self%pressure_viscosity, self%solver)
    self%state = new_state(cells, self%bore%shapes() + 2)
    self%state%amplitude(self%bore%shapes() + 1:) = -duty%eccentricity(:, 1)/cells%clearance
    self%shape_rate = 0*self%state%amplitude
    call find_gap(cells, self%solver%shapes, self%state%amplitude, self%solver%gap)
    self%conditions%content = spread(self%solver%gap%at_cells, 1, cells%along)
    self%conditions%is_free = allocated(duty%load)
    self%load_before = 0
    self%is_steady = size(duty%time) == 1
    if (self%is_steady .and. self%conditions%is_free .and. self%supply%kind == supply_none .and. &
      .not. self%ambient_over_cavitation > 0) call fail(error, &
      'a film without supply, with ends in air, has no steady state under load', status_integration)
  end subroutine begin

  !> Return to the first row. If the eccentricity is given, the oil of each cell fills the same part of the gap there: an orbit that
  !> does not close would otherwise squeeze the film by the whole difference in one step.
  pure subroutine begin_cycle(self, duty)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    integer :: i
    self%turned = 0
    self%conditions%speed = duty%pin_speed(1)
    if (self%conditions%is_free) return
    self%state%amplitude(self%solver%bore_shapes + 1:) = -duty%eccentricity(:, 1)/self%solver%cells%clearance
    call find_gap(self%solver%cells, self%solver%shapes, self%state%amplitude, self%solver%gap)
    do i = 1, self%around
      self%conditions%content(:, i) = self%state%fraction(:, i)*self%solver%gap%at_cells(i)
    end do
  end subroutine begin_cycle

  !> March from the first row to the last one.
  pure subroutine march_cycle(self, duty, error)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    type(error_t), allocatable, intent(out) :: error
    type(film_row_t) :: rows(size(duty%time)), row
    integer, allocatable :: field_rows(:)
    integer :: i, k, s, steps, first

    allocate (field_rows(0))
    first = merge(1, 2, self%is_steady)
    if (allocated(self%field_times)) field_rows = [(minloc(abs(duty%time(first:) - self%field_times(k)), 1) + first - 1, &
      k=1, size(self%field_times))]
    if (allocated(self%fields)) deallocate (self%fields)
    allocate (self%fields(size(field_rows)))
    call self%summary%begin()
    steps = merge(1, self%substeps, self%is_steady)
    do i = first, size(duty%time)
      do s = 1, steps
        call self%set_conditions(duty, i, real(s, dp)/steps)
        call self%make_step(error)
        if (allocated(error)) exit
        call find_row(self%solver, self%conditions, self%state, self%time, row)
        call self%summary%add(row, 1/self%conditions%rate)
        do k = 1, self%around
          self%conditions%content(:, k) = self%state%fraction(:, k)*self%solver%gap%at_cells(k)
        end do
      end do
      if (allocated(error)) exit
      rows(i) = row
      do k = 1, size(field_rows)
        if (field_rows(k) == i) call find_field(self%solver, self%state, row%time, self%fields(k))
      end do
    end do
    call self%summary%finish()
    self%rows = rows(first:i - 1)
  end subroutine march_cycle

  !> A value between those of row i - 1 (part 0) and row i (part 1), linear; in a steady state that of the first row.
  pure real(dp) function at_row(values, i, part)
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: i
    real(dp), intent(in) :: part
    at_row = values(i)
    if (i > 1 .and. part < 1) at_row = values(i - 1) + part*(values(i) - values(i - 1))
  end function at_row

  !> What is given at the end of a step.
  pure subroutine set_conditions(self, duty, i, part)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    integer, intent(in) :: i
    real(dp), intent(in) :: part   !! of the interval from row i - 1 to row i
    real(dp) :: feed, speed_before, rate, load_unit
    integer :: k

    associate (conditions => self%conditions, solver => self%solver, unit => self%solver%pressure_unit)
      speed_before = conditions%speed
      self%time = at_row(duty%time, i, part)
      conditions%speed = at_row(duty%pin_speed, i, part)
      feed = self%supply_pressure
      if (allocated(duty%supply_pressure)) feed = at_row(duty%supply_pressure, i, part)
      conditions%supply = solver%oil%reduced((feed + self%ambient_over_cavitation)/unit)
      conditions%ends = solver%oil%reduced(self%ambient_over_cavitation/unit)
      load_unit = pi*solver%cells%pin_radius*solver%cells%share*self%bearing%length*unit
      do k = 1, 2
        if (conditions%is_free) then
          conditions%load(k) = at_row(duty%load(k, :), i, part)/load_unit
        else
          self%state%amplitude(solver%bore_shapes + k) = -at_row(duty%eccentricity(k, :), i, part)/solver%cells%clearance
        end if
      end do
      if (i > 1) then
        conditions%rate = self%substeps/(duty%time(i) - duty%time(i - 1))
        self%turned = self%turned + 0.5_dp*(speed_before + conditions%speed)/conditions%rate
      else
        rate = abs(conditions%speed) + conditions%supply + conditions%ends + norm2(conditions%load)
        conditions%rate = steady_rate*merge(rate, 1.0_dp, rate > 0)
      end if
    end associate
    call self%set_supply()
  end subroutine set_conditions

  !> Set the cells of the supply, which move with the pin if it is fixed there. Cells that it leaves are full.
  pure subroutine set_supply(self)
    class(film_history_t), intent(inout) :: self
    if (self%supply%fixed_to_pin) call self%solver%cells%turn_supply(self%turned)
    associate (kind => self%state%kind, is_supplied => self%solver%cells%is_supplied)
      where (is_supplied)
        kind = supplied
        self%state%pressure = self%conditions%supply
        self%state%fraction = 1
      elsewhere
        kind = merge(filled, kind, kind == supplied)
      end where
    end associate
  end subroutine set_supply

  !> Solve a step, from amplitudes that change as in the last step. If this fails, and for a steady state at once, the load is raised
  !> in parts from the last one.
  pure subroutine make_step(self, error)
    class(film_history_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(film_state_t) :: before
    real(dp) :: change(size(self%shape_rate))
    character(len=20) :: time
    logical :: has_converged

    before = self%state
    has_converged = .false.
    if (.not. (self%is_steady .and. self%conditions%is_free)) then
      change = self%shape_rate/self%conditions%rate
      if (all(matmul(self%solver%shapes%at_cells, change) > -most_predicted*self%solver%gap%at_cells)) &
        self%state%amplitude = before%amplitude + change
      call self%solver%solve_step(self%conditions, self%state, has_converged)
    end if
    if (.not. has_converged) then
      self%state = before
      call self%raise_load(has_converged)
    end if
    self%shape_rate = (self%state%amplitude - before%amplitude)*self%conditions%rate
    self%load_before = self%conditions%load
    if (has_converged) return
    write (time, '(es12.5)') self%time
    call fail(error, 'the film does not converge at '//trim(adjustl(time))//' s', status_integration)
  end subroutine make_step

  !> Solve a step with 5 to 100 % of the change of the load.
  pure subroutine raise_load(self, has_converged)
    class(film_history_t), intent(inout) :: self
    logical, intent(out) :: has_converged
    real(dp), parameter :: parts(8) = [0.05_dp, 0.1_dp, 0.2_dp, 0.35_dp, 0.5_dp, 0.7_dp, 0.85_dp, 1.0_dp]
    real(dp) :: load(2)
    integer :: k
    load = self%conditions%load
    do k = 1, size(parts)
      self%conditions%load = self%load_before + parts(k)*(load - self%load_before)
      call self%solver%solve_step(self%conditions, self%state, has_converged)
      if (.not. has_converged) exit
    end do
    self%conditions%load = load
  end subroutine raise_load

  !> Sum of the content f h of the cells.
  pure real(dp) function oil_content(self)
    class(film_history_t), intent(in) :: self
    oil_content = sum(matmul(self%state%fraction, self%solver%gap%at_cells))
  end function oil_content
end module film_history
