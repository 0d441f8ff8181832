!> What a film with memory gives after a step: force and moment on the pin, flows, filling, extremes, and fields.
module film_results
  use kinds, only: dp
  use film_cells, only: supplied
  use film_balance, only: film_conditions_t, film_state_t
  use film_step, only: step_solver_t
  implicit none
  private
  public :: film_row_t, film_field_t, film_summary_t, find_row, find_field

  real(dp), parameter :: least_flow = 1e-6_dp   !! over the turnover: a flow that is small beside those inside the film

  !> The film at the end of a step.
  type :: film_row_t
    real(dp) :: time = 0                  !! [s]
    real(dp) :: eccentricity(2) = 0       !! of the pin's centre from the middle of the bore [m]
    real(dp) :: force(2) = 0              !! of the film on the pin [N]
    real(dp) :: moment = 0                !! of the film on the pin about its centre, x towards y [N m]
    real(dp) :: tilting_moment(2) = 0     !! of the film on the pin about x and y, of a tilted one [N m]
    real(dp) :: min_thickness = 0         !! [m]
    real(dp) :: max_pressure = 0          !! above the cavitation pressure [Pa]
    real(dp) :: fill = 0                  !! volume of the oil over that of the gap [-]
    real(dp) :: supply_flow = 0           !! out of the supply; negative where oil is pressed back into it [m^3/s]
    real(dp) :: side_flow = 0             !! out of both ends of the bearing [m^3/s]
    real(dp) :: bore_deflection = 0       !! largest change of the bore's radius, without a shift [m]
    real(dp) :: content_rate = 0          !! growth of the oil outside the supply [m^3/s]
    real(dp) :: turnover = 0              !! volume of the gap times the rates of the step and of the pin [m^3/s]
    real(dp) :: cells_per_gap = 0         !! number of cells in the length sqrt(h_min/h_max) R over which a thin film changes
  end type film_row_t

  !> Fields at one time over the cells (along, around), and where these are.
  type :: film_field_t
    real(dp) :: time = 0                  !! [s]
    real(dp), allocatable :: angle(:)     !! from x towards y (around) [rad]
    real(dp), allocatable :: axial(:)     !! distance from the middle of the bearing (along) [m]
    real(dp), allocatable :: thickness(:, :)   !! (along, around) [m]
    real(dp), allocatable :: pressure(:, :)    !! (along, around), above the cavitation pressure [Pa]
    real(dp), allocatable :: fraction(:, :)    !! film fraction (along, around) [-]
    logical, allocatable :: is_supplied(:, :)  !! cells in a groove or hole
  end type film_field_t

  !> Figures of the last cycle.
  type :: film_summary_t
    integer :: cycles = 0                   !! marched
    real(dp) :: content_change = 0          !! of the oil from the end of a cycle to that of the next, over the oil [-]
    real(dp) :: min_thickness = 0           !! [m]
    real(dp) :: max_pressure = 0            !! above the cavitation pressure [Pa]
    real(dp) :: mean_supply_flow = 0, mean_side_flow = 0   !! over time [m^3/s]
    real(dp) :: least_fill = 0              !! [-]
    real(dp) :: mass_residual = 0           !! largest growth of the oil less supply and side flow, over the largest flow [-]
    real(dp) :: cells_per_gap = 0           !! smallest
    real(dp) :: max_tilting_moment = 0      !! [N m]
    integer :: rounds = 0, factorisations = 0   !! of all steps
    real(dp) :: duration = 0                !! of the steps [s]
    real(dp), private :: largest_flow = 0
  contains
    procedure :: begin
    procedure :: add
    procedure :: finish
  end type film_summary_t

contains

  !> The row of a solved step.
  pure subroutine find_row(solver, conditions, state, time, row)
    type(step_solver_t), intent(in) :: solver
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    real(dp), intent(in) :: time   !! [s]
    type(film_row_t), intent(out) :: row
    real(dp) :: pressure(solver%cells%along, solver%cells%around), harmonics(size(state%amplitude)), area, lever(2)
    integer :: k

    k = solver%bore_shapes
    row%time = time
    pressure = solver%oil%pressure(state%pressure)
    harmonics = solver%harmonics(pressure)
    associate (cells => solver%cells, h => solver%gap%at_cells, volume => solver%cells%cell_volume(), c => solver%cells%clearance, &
      unit => solver%pressure_unit)
      area = volume/c*cells%around*cells%along   ! 2 pi R L
      row%eccentricity = -state%amplitude(k + 1:)*c
      row%force = -0.5_dp*area*unit*harmonics(k + 1:)
      row%min_thickness = minval(h + cells%least_beyond)*c
      row%max_pressure = maxval(pressure)*unit
      row%cells_per_gap = sqrt(minval(h + cells%least_beyond)/maxval(h))/cells%turn
      row%fill = dot_product(sum(state%fraction, 1), h)/(sum(h)*cells%along)
      if (cells%varies_along) row%fill = (dot_product(sum(state%fraction, 1), h) + sum(state%fraction*cells%beyond))/ &
        (sum(h)*cells%along + sum(cells%beyond))
      row%side_flow = solver%balance%side*volume
      row%supply_flow = (solver%balance%inlet + sum(solver%balance%outflow, state%kind == supplied))*volume
      row%turnover = sum(h)*cells%along*volume*(conditions%rate + abs(conditions%speed))
      row%content_rate = content_change(solver, conditions, state)*volume
      row%moment = -solver%viscosity*conditions%speed*cells%pin_radius**2*volume/c**2*shear_of(solver, state) &
        - 0.5_dp*(row%eccentricity(1)*row%force(2) - row%eccentricity(2)*row%force(1))
      row%moment = row%moment + 0.5_dp*unit*volume*dot_product(sum(pressure, 1), cells%bore_slope)
      if (cells%is_whole) then
        lever = -volume/c*unit*matmul(transpose(solver%shapes%at_cells(:, k + 1:)), matmul(cells%axial, pressure))   ! Int z dF
        row%moment = row%moment - 0.5_dp*(solver%tilt(1)*lever(2) - solver%tilt(2)*lever(1))
        row%tilting_moment = [-lever(2), lever(1)]
      end if
      if (k == 0) return
      associate (amplitude => state%amplitude(:k))
        row%bore_deflection = maxval(abs(matmul(solver%shapes%at_cells(:, :k), amplitude)))*c
        row%moment = row%moment + 0.5_dp*unit*volume*dot_product(sum(pressure, 1), matmul(solver%shapes%slopes(:, :k), amplitude))
      end associate
    end associate
  end subroutine find_row

  !> Growth of the content f h outside the supply, the sum over the cells [1/s].
  pure real(dp) function content_change(solver, conditions, state) result(growth)
    type(step_solver_t), intent(in) :: solver
    type(film_conditions_t), intent(in) :: conditions
    type(film_state_t), intent(in) :: state
    integer :: i
    growth = 0
    do i = 1, solver%cells%around
      growth = growth + sum(state%fraction(:, i)*(solver%gap%at_cells(i) + solver%cells%beyond(:, i)) - conditions%content(:, i), &
        state%kind(:, i) /= supplied)
    end do
    growth = growth*conditions%rate
  end function content_change

  !> Sum of (mu/mu_0) f/h over the cells outside the supply, for the shear of a film that is striated where it has ruptured.
  pure real(dp) function shear_of(solver, state) result(shear)
    type(step_solver_t), intent(in) :: solver
    type(film_state_t), intent(in) :: state
    integer :: i
    shear = 0
    do i = 1, solver%cells%around
      if (solver%cells%varies_along) then
        shear = shear + sum(state%fraction(:, i)*solver%oil%thickening(state%pressure(:, i))/ &
          (solver%gap%at_cells(i) + solver%cells%beyond(:, i)), state%kind(:, i) /= supplied)
      else
        shear = shear + sum(state%fraction(:, i)*solver%oil%thickening(state%pressure(:, i)), state%kind(:, i) /= supplied) &
          /solver%gap%at_cells(i)
      end if
    end do
  end function shear_of

  !> The fields of a solved step.
  pure subroutine find_field(solver, state, time, field)
    type(step_solver_t), intent(in) :: solver
    type(film_state_t), intent(in) :: state
    real(dp), intent(in) :: time   !! [s]
    type(film_field_t), intent(out) :: field
    field%time = time
    associate (cells => solver%cells)
      field%angle = cells%angle
      field%axial = cells%axial
      if (cells%is_land) field%axial = field%axial + 0.5_dp*cells%supply%groove_width
    end associate
    field%pressure = solver%oil%pressure(state%pressure)*solver%pressure_unit
    field%thickness = (spread(solver%gap%at_cells, 1, solver%cells%along) + solver%cells%beyond)*solver%cells%clearance
    field%fraction = state%fraction
    field%is_supplied = state%kind == supplied
  end subroutine find_field

  !> Begin a cycle.
  pure subroutine begin(self)
    class(film_summary_t), intent(inout) :: self
    self%duration = 0
    self%largest_flow = 0
    self%mean_supply_flow = 0
    self%mean_side_flow = 0
    self%mass_residual = 0
    self%min_thickness = huge(1.0_dp)
    self%max_pressure = 0
    self%least_fill = 1
    self%cells_per_gap = huge(1.0_dp)
    self%max_tilting_moment = 0
  end subroutine begin

  !> Add a step that has taken a time [s].
  pure subroutine add(self, row, time)
    class(film_summary_t), intent(inout) :: self
    type(film_row_t), intent(in) :: row
    real(dp), intent(in) :: time
    self%duration = self%duration + time
    self%largest_flow = max(self%largest_flow, abs(row%supply_flow), abs(row%side_flow), abs(row%content_rate), &
      least_flow*row%turnover)
    self%mean_supply_flow = self%mean_supply_flow + row%supply_flow*time
    self%mean_side_flow = self%mean_side_flow + row%side_flow*time
    self%mass_residual = max(self%mass_residual, abs(row%content_rate - row%supply_flow + row%side_flow))
    self%min_thickness = min(self%min_thickness, row%min_thickness)
    self%max_pressure = max(self%max_pressure, row%max_pressure)
    self%least_fill = min(self%least_fill, row%fill)
    self%cells_per_gap = min(self%cells_per_gap, row%cells_per_gap)
    self%max_tilting_moment = max(self%max_tilting_moment, norm2(row%tilting_moment))
  end subroutine add

  !> End a cycle: means over its time, the residual over the largest flow.
  pure subroutine finish(self)
    class(film_summary_t), intent(inout) :: self
    if (self%duration > 0) then
      self%mean_supply_flow = self%mean_supply_flow/self%duration
      self%mean_side_flow = self%mean_side_flow/self%duration
    end if
    if (self%largest_flow > 0) self%mass_residual = self%mass_residual/self%largest_flow
  end subroutine finish
end module film_results
