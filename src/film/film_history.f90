!> A film with memory over a cycle: marched with implicit Euler steps from row to row of a duty, until the oil in it repeats.
!>
!> The film begins full at the eccentricity of the first row (at 0.9 c, if that is c or more). A duty of one row is a steady state:
!> it is marched with steps that become longer until the content of the cells does not act any more. The memory may be left out
!> (Reynolds' condition), for comparison.
module film_history
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t, fail, status_integration
  use bearing_size, only: bearing_t
  use bore_shape, only: bore_shape_t
  use film_cells, only: film_cells_t, supply_t, new_film_cells, supply_none, filled, supplied
  use film_balance, only: film_conditions_t, film_state_t, new_state, find_gap
  use film_step, only: step_solver_t, new_step_solver, step_solved, step_closed, step_unbounded
  use film_law, only: table_watch_t
  use film_results, only: film_row_t, film_field_t, film_summary_t, find_row, find_field
  use ring_compliance, only: elastic_bore_t
  implicit none
  private
  public :: film_history_t, film_duty_t

  integer, parameter :: steady_steps = 23             !! towards a steady state, each longer than the last one by the root of ten
  real(dp), parameter :: steady_rate = 1e-10_dp       !! reciprocal of the last of them, over the rates of the film
  real(dp), parameter :: most_unsteady = 1e-3_dp      !! relative change of the smallest thickness in that step
  real(dp), parameter :: most_eccentric = 0.9_dp      !! eccentricity over c at which a film begins whose first row has no gap

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
    logical :: has_memory = .true.          !! .false.: Reynolds' condition; the mass residual is then the oil that it loses
    real(dp) :: viscosity = 0               !! mu_0 [Pa s]
    real(dp) :: pressure_viscosity = 0      !! alpha of Barus [1/Pa]
    real(dp) :: ambient_over_cavitation = 0 !! ambient pressure less cavitation pressure [Pa]; > 0: the ends are under oil
    type(supply_t) :: supply
    real(dp) :: supply_pressure = 0         !! above ambient [Pa]
    type(elastic_bore_t) :: bore            !! without shapes: rigid
    type(bore_shape_t) :: shape             !! of the bore, and how the pin lies in it
    integer :: around = 96, along = 8       !! cells round the bearing and along half of it
    integer :: substeps = 1                 !! steps between two rows of the duty
    integer :: most_cycles = 10
    real(dp) :: cycle_tolerance = 1e-3_dp   !! content change of a settled cycle
    real(dp), allocatable :: field_times(:) !! fields are kept at the ends of the steps next to these times of the last cycle [s]
    type(film_row_t), allocatable :: rows(:)       !! result: the ends of the intervals of the last cycle
    type(film_field_t), allocatable :: fields(:)   !! result
    type(film_summary_t) :: summary                !! result
    logical :: is_steady = .false.                 !! result: the duty had one row
    type(step_solver_t), private :: solver
    type(film_conditions_t), private :: conditions
    type(film_state_t), private :: state
    type(film_state_t), private :: earlier  !! before the last step
    real(dp), private :: last_rate = 0      !! reciprocal of the last step in time; 0 before the first step [1/s]
    real(dp), private :: load_before(2) = 0 !! of the last step, as in `conditions`; 0 for a steady state
    real(dp), private :: turned = 0         !! angle of the pin since the first row [rad]
    real(dp), private :: time = 0           !! end of the present step [s]
  contains
    procedure :: march
    procedure, private :: begin
    procedure, private :: begin_cycle
    procedure, private :: march_cycle
    procedure, private :: march_to
    procedure, private :: find_steady
    procedure, private :: set_conditions
    procedure, private :: set_supply
    procedure, private :: make_step
    procedure, private :: approach
    procedure, private :: reason_of
    procedure, private :: oil_volume
  end type film_history_t

contains

  !> March the film through the duty. `rows` has the last cycle, or after an error (a wrong supply, no convergence, no steady state)
  !> the rows of the present cycle until then. `watch` is told when a row is done, and may end the march with an error.
  subroutine march(self, duty, error, watch)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    type(error_t), allocatable, intent(out) :: error
    class(table_watch_t), intent(inout), optional :: watch
    real(dp) :: volume, before
    integer :: cycle_number

    call self%begin(duty, error)
    if (allocated(error)) return
    volume = self%oil_volume()
    do cycle_number = 1, merge(1, self%most_cycles, self%is_steady)
      before = volume
      call self%begin_cycle(duty, is_first=cycle_number == 1)
      call self%march_cycle(duty, error, watch)
      volume = self%oil_volume()
      self%summary%cycles = cycle_number
      self%summary%content_change = abs(volume - before)/max(volume, tiny(volume))
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
    real(dp) :: eccentricity(2)

    self%rows = [film_row_t ::]
    self%fields = [film_field_t ::]
    self%summary = film_summary_t()
    call new_film_cells(self%bearing, self%supply, self%around, self%along, cells, error, self%shape)
    if (allocated(error)) return
    call new_step_solver(cells, self%bore, self%viscosity, self%pressure_viscosity, allocated(duty%load), self%solver)
    self%solver%tilt = self%shape%tilt
    self%state = new_state(cells, self%bore%shapes() + 2)
    eccentricity = duty%eccentricity(:, 1)/cells%clearance
    if (norm2(eccentricity) >= 1) eccentricity = eccentricity*most_eccentric/norm2(eccentricity)
    self%state%amplitude(self%bore%shapes() + 1:) = -eccentricity
    call find_gap(cells, self%solver%shapes, self%state%amplitude, self%solver%gap)
    self%conditions%has_memory = self%has_memory
    self%conditions%content = spread(self%solver%gap%at_cells, 1, cells%along) + cells%beyond
    self%load_before = 0
    self%last_rate = 0
    self%is_steady = size(duty%time) == 1
    if (self%is_steady .and. self%solver%is_free .and. self%has_memory .and. self%supply%kind == supply_none .and. &
      .not. self%ambient_over_cavitation > 0) call fail(error, &
      'a film without supply, with ends in air, has no steady state under load', status_integration)
  end subroutine begin

  !> Return to the first row. If the eccentricity is given, the oil of each cell fills the same part of the gap there: an orbit that
  !> does not close would otherwise squeeze the film by the whole difference in one step.
  pure subroutine begin_cycle(self, duty, is_first)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    logical, intent(in) :: is_first
    integer :: i
    self%turned = 0
    self%time = duty%time(1)
    self%conditions%speed = duty%pin_speed(1)
    if (self%supply%fixed_to_pin) call self%solver%cells%turn_supply(self%turned)
    if (self%solver%is_free .or. is_first) return
    self%state%amplitude(self%solver%bore_shapes + 1:) = -duty%eccentricity(:, 1)/self%solver%cells%clearance
    call find_gap(self%solver%cells, self%solver%shapes, self%state%amplitude, self%solver%gap)
    do i = 1, self%around
      self%conditions%content(:, i) = self%state%fraction(:, i)* &
        max(self%solver%gap%at_cells(i) + self%solver%cells%beyond(:, i), 0.0_dp)
    end do
  end subroutine begin_cycle

  !> March from the first row to the last one.
  subroutine march_cycle(self, duty, error, watch)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    type(error_t), allocatable, intent(out) :: error
    class(table_watch_t), intent(inout), optional :: watch
    type(film_row_t) :: rows(size(duty%time))
    integer, allocatable :: field_rows(:)
    real(dp) :: before
    integer :: i, k, first

    allocate (field_rows(0))
    first = merge(1, 2, self%is_steady)
    if (allocated(self%field_times)) field_rows = [(minloc(abs(duty%time(first:) - self%field_times(k)), 1) + first - 1, &
      k=1, size(self%field_times))]
    if (allocated(self%fields)) deallocate (self%fields)
    allocate (self%fields(size(field_rows)))
    call self%summary%begin()
    before = self%oil_volume()
    do i = first, size(duty%time)
      if (self%is_steady) then
        call self%find_steady(duty, rows(i), error)
      else
        call self%march_to(duty, i, rows(i), error)
      end if
      if (present(watch)) then
        call watch%row_done(i, size(duty%time))
        if (watch%wants_to_stop) call fail(error, 'interrupted', status_integration)
      end if
      if (allocated(error)) exit
      do k = 1, size(field_rows)
        if (field_rows(k) == i) call find_field(self%solver, self%state, duty%time(i), self%fields(k))
      end do
    end do
    call self%summary%finish()
    self%rows = rows(first:i - 1)
    if (self%supply%fixed_to_pin .and. self%has_memory .and. i > first) &   ! the supply takes up and leaves oil while it turns
      self%summary%mean_supply_flow = self%summary%mean_side_flow + (self%oil_volume() - before)/self%summary%duration
  end subroutine march_cycle

  !> March from row i - 1 to row i.
  pure subroutine march_to(self, duty, i, row, error)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    integer, intent(in) :: i
    type(film_row_t), intent(out) :: row
    type(error_t), allocatable, intent(out) :: error
    integer :: s
    do s = 1, self%substeps
      call self%set_conditions(duty, i, real(s, dp)/self%substeps)
      self%conditions%rate = self%substeps/(duty%time(i) - duty%time(i - 1))
      call self%make_step(row, error)
      if (allocated(error)) return
      call self%summary%add(row, 1/self%conditions%rate)
      self%load_before = self%conditions%load
    end do
  end subroutine march_to

  !> Find the steady state of the only row, by steps that become longer; in one step if the gap is given.
  pure subroutine find_steady(self, duty, row, error)
    class(film_history_t), intent(inout) :: self
    type(film_duty_t), intent(in) :: duty
    type(film_row_t), intent(out) :: row
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: rate, thinnest
    integer :: s, first
    call self%set_conditions(duty, 1, 1.0_dp)
    rate = abs(self%conditions%speed) + self%conditions%supply + self%conditions%ends + norm2(self%conditions%load)
    if (.not. rate > 0) rate = 1
    first = merge(1, steady_steps, self%solver%is_free .or. self%solver%bore_shapes > 0)
    do s = first, steady_steps
      thinnest = row%min_thickness
      self%conditions%rate = steady_rate*rate*10**(0.5_dp*(steady_steps - s))
      call self%make_step(row, error)
      if (allocated(error)) return
    end do
    call self%summary%add(row, 1/self%conditions%rate)
    if (first < steady_steps .and. abs(thinnest - row%min_thickness) > most_unsteady*row%min_thickness) &
      call fail(error, 'the film has no steady state: its oil is squeezed out', status_integration)
  end subroutine find_steady

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
    real(dp) :: feed, speed_before, time_before, load_unit
    integer :: k

    associate (conditions => self%conditions, solver => self%solver, unit => self%solver%pressure_unit)
      speed_before = conditions%speed
      time_before = self%time
      self%time = at_row(duty%time, i, part)
      conditions%speed = at_row(duty%pin_speed, i, part)
      feed = self%supply_pressure
      if (allocated(duty%supply_pressure)) feed = at_row(duty%supply_pressure, i, part)
      conditions%supply = solver%oil%reduced((feed + self%ambient_over_cavitation)/unit)
      conditions%ends = solver%oil%reduced(self%ambient_over_cavitation/unit)
      load_unit = pi*solver%cells%pin_radius*solver%cells%share*self%bearing%length*unit
      do k = 1, 2
        if (solver%is_free) then
          conditions%load(k) = at_row(duty%load(k, :), i, part)/load_unit
        else
          conditions%eccentricity(k) = at_row(duty%eccentricity(k, :), i, part)/solver%cells%clearance
        end if
      end do
      if (i > 1) self%turned = self%turned + 0.5_dp*(speed_before + conditions%speed)*(self%time - time_before)
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

  !> Solve a step, from a film that changes as in the last step; if this fails, in parts from the present film.
  pure subroutine make_step(self, row, error)
    class(film_history_t), intent(inout) :: self
    type(film_row_t), intent(out) :: row
    type(error_t), allocatable, intent(out) :: error
    type(film_state_t) :: before
    integer :: outcome, i

    before = self%state
    if (self%last_rate > 0 .and. .not. self%is_steady) &
      call self%solver%predict(self%earlier, self%last_rate/self%conditions%rate, self%state)
    call self%solver%solve_step(self%conditions, self%state, outcome)
    if (outcome /= step_solved) then
      self%state = before
      call self%approach(outcome)
    end if
    self%earlier = before
    self%last_rate = self%conditions%rate
    if (outcome /= step_solved) then
      call fail(error, 'the film has no solution at '//text_of(self%time)//' s: '//self%reason_of(outcome), status_integration)
      return
    end if
    if (.not. self%has_memory) self%state%fraction = 1
    call find_row(self%solver, self%conditions, self%state, self%time, row)
    do i = 1, self%around
      self%conditions%content(:, i) = self%state%fraction(:, i)*(self%solver%gap%at_cells(i) + self%solver%cells%beyond(:, i))
    end do
  end subroutine make_step

  !> Solve a step while the load, or the eccentricity of a pin in an elastic bore, goes there from that of the last step, in parts
  !> that become larger after a solution and smaller without.
  pure subroutine approach(self, outcome)
    class(film_history_t), intent(inout) :: self
    integer, intent(inout) :: outcome
    real(dp), parameter :: first_part = 0.05_dp, least_part = 1e-3_dp, growth = 2.0_dp, shrinking = 0.25_dp
    type(film_state_t) :: solved
    type(film_conditions_t) :: whole
    real(dp) :: eccentricity(2), done, part

    if (self%solver%bore_shapes == 0 .and. .not. self%solver%is_free) return
    whole = self%conditions
    solved = self%state
    eccentricity = -solved%amplitude(self%solver%bore_shapes + 1:)
    done = 0
    part = first_part
    do
      associate (to => min(1.0_dp, done + part))
        self%conditions%load = self%load_before + to*(whole%load - self%load_before)
        self%conditions%eccentricity = eccentricity + to*(whole%eccentricity - eccentricity)
      end associate
      call self%solver%solve_step(self%conditions, self%state, outcome)
      if (outcome == step_solved) then
        done = done + part
        if (done >= 1) exit
        solved = self%state
        part = growth*part
      else
        self%state = solved
        part = shrinking*part
        if (part < least_part) exit
      end if
    end do
    self%conditions = whole
  end subroutine approach

  !> What an outcome means.
  pure function reason_of(self, outcome) result(reason)
    class(film_history_t), intent(in) :: self
    integer, intent(in) :: outcome
    character(len=:), allocatable :: reason
    select case (outcome)
    case (step_closed)
      reason = 'the eccentricity closes the gap'
      if (self%solver%is_free) reason = 'the gap closes (a heavy load needs more cells or more oil)'
    case (step_unbounded)
      reason = 'its pressure exceeds what pressure_viscosity allows'
    case default
      reason = 'the iteration does not end'
    end select
  end function reason_of

  pure function text_of(time) result(text)
    real(dp), intent(in) :: time
    character(len=:), allocatable :: text
    character(len=20) :: digits
    write (digits, '(es12.5)') time
    text = trim(adjustl(digits))
  end function text_of

  !> Volume of the oil outside the supply [m^3].
  pure real(dp) function oil_volume(self)
    class(film_history_t), intent(in) :: self
    oil_volume = sum(self%conditions%content, .not. self%solver%cells%is_supplied)*self%solver%cells%cell_volume()
  end function oil_volume
end module film_history
