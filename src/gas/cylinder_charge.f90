!> The gas in the cylinders of an engine or a compressor as a mass with a temperature: m and p V = m R_g T. While it is not open
!>
!>     m' = m_s - m_d - m_l,    p' = ((g - 1)(Q_b' - Q_w' + H_s' - H_d' - H_l') - g p V')/V
!>
!> with the heat Q_b' of combustion, Q_w' to the walls, the flows m_s and m_d through the valves of a compressor and m_l past the
!> rings to the crankcase, and their enthalpies H' = c_p T m, where gas that comes in has the temperature of the fresh charge. While
!> the cylinder of an engine is open its pressure is that of the intake and its temperature that of the fresh charge. In an engine
!> without walls and leak the mass is constant and the pressure follows from the crank angle alone (`gas_cycle`); else p and m are
!> states.
module cylinder_charge
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use state_layout, only: layout_t, slice_t
  use run_state, only: run_state_t
  use cylinder, only: cylinder_t
  use flow_valve, only: flow_valve_t, suction, discharge
  use wall_law, only: wall_law_t, chamber_t, hot_gas_t
  use valve_reeds, only: reeds_t
  use nozzle_flow, only: orifice_flow
  implicit none
  private
  public :: charge_case_t, charge_t, charge_motion_t, n_charge_sums
  public :: of_balance, to_walls, leaked, leaked_enthalpy, moved, delivered, delivered_heat, suction_loss, discharge_loss
  public :: work_on_gas

  !> Integrals over time, of the mechanism's cylinder: energy that the gas has received by heat, work and flow, with its energy at
  !> the start, so that it is that of the gas but for errors of the integration [J]; heat to the walls [J], mass lost [kg] with its
  !> enthalpy [J], and the size of the work [J]; with valves the mass delivered [kg], its temperature times it [kg K], the work lost
  !> in both valves and that on the gas [J].
  integer, parameter :: of_balance = 1, to_walls = 2, leaked = 3, leaked_enthalpy = 4, moved = 5, delivered = 6, &
    delivered_heat = 7, suction_loss = 8, discharge_loss = 9, work_on_gas = 10, n_charge_sums = 10
  integer, parameter :: n_closed_sums = 5   !! without valves

  !> The group &working_gas.
  type, extends(has_parameters_t) :: charge_case_t
    real(dp) :: gas_constant = 0   !! R_g [J/(kg K)]
    real(dp) :: temperature = 0    !! of the charge when the cylinder closes [K]
    real(dp) :: leak_area = 0      !! [m^2]
    real(dp) :: heat_capacity_ratio = 0   !! g of a compressor; an engine has it with its cycle [-]
  contains
    procedure :: parameters
  end type charge_case_t

  !> The gas of one cylinder at an instant.
  type :: charge_motion_t
    real(dp) :: pressure, mass, temperature                  !! [Pa], [kg], [K]
    real(dp) :: pressure_rate, mass_rate, temperature_rate   !! [Pa/s], [kg/s], [K/s]
    real(dp) :: heat_flow                                    !! Q_w', to the walls [W]
    real(dp) :: leak_flow                                    !! m_l, out of the cylinder [kg/s]
    real(dp) :: valve_flow(2), valve_lift(2)                 !! m_s and m_d in their senses [kg/s]; lifts [m]
    real(dp) :: valve_heat(2)                                !! these flows times their temperatures [kg K/s]
    real(dp) :: valve_speed(2), valve_acceleration(2)        !! of valves with a mass [m/s], [m/s^2]
    real(dp) :: rates(n_charge_sums)                         !! of the integrals
  end type charge_motion_t

  !> What all cylinders share.
  type :: charge_t
    type(charge_case_t) :: given
    class(wall_law_t), allocatable :: walls     !! not allocated: no heat to the walls
    type(flow_valve_t), allocatable :: valves(:)   !! of a compressor: suction and discharge; not allocated: an engine
    type(reeds_t), allocatable :: reeds         !! of valves with a mass
    logical :: is_state = .false.               !! p and m are states
    type(cylinder_t), private :: cylinder
    type(chamber_t) :: chamber
    real(dp), private :: crankcase_pressure = 0 !! [Pa]
    real(dp) :: discharge_pressure = 0          !! of a compressor [Pa]
    real(dp), private :: returning_temperature = 0   !! of gas that flows back from the discharge chamber [K]
    real(dp) :: closed_mass = 0                 !! m when the cylinder closes [kg]
    real(dp) :: opening_temperature = 0         !! T when the mechanism's cylinder last opened; 0: it has not [K]
    type(slice_t) :: pressures, masses          !! of all cylinders in the state vector, the mechanism's first
    type(slice_t) :: sums                       !! the integrals
  contains
    procedure :: set_case
    procedure :: prepare
    procedure :: set_discharge
    procedure :: claim
    procedure :: declare
    procedure :: set_start
    procedure, non_overridable :: set_rates
    procedure :: reed_events
    procedure :: pass_reed
    procedure :: admits
    procedure, non_overridable :: move
    procedure :: move_adiabatic
    procedure :: move_polytropic
    procedure :: fresh_mass
    procedure :: delivery_temperature
    procedure :: energy
    procedure :: totals
    procedure :: exchange
    procedure :: loses_gas
  end type charge_t

contains

  subroutine parameters(self, list)
    class(charge_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('gas_constant', self%gas_constant, &
      'specific gas constant; air 287, R134a 81.5, R290 189, R600a 143, nitrogen 297', &
      'J/(kg K)', '> 0', example='287.0', usual='50 to 4200')
    call list%add('temperature', self%temperature, 'temperature of the fresh gas: of an engine where its cylinder closes, of a '// &
      'compressor in the suction chamber', 'K', '> 0', example='350.0', usual='230 to 500')
    call list%add('leak_area', self%leak_area, 'effective area of the gap past the rings to the crankcase', 'm^2', '>= 0', &
      default='0.0', usual='1e-9 to 1e-4')
    call list%add('heat_capacity_ratio', self%heat_capacity_ratio, &
      'ratio of the heat capacities of the gas of a compressor with &valve; air 1.4, R134a 1.11, R290 1.13, R600a 1.09', &
      range='>= 0 and <= 10', default='0.0', usual='1.05 to 1.67')
  end subroutine parameters

  !> Take over the groups of a case.
  subroutine set_case(self, given, walls, valves, tolerance)
    class(charge_t), intent(inout) :: self
    type(charge_case_t), intent(in) :: given
    class(wall_law_t), allocatable, intent(in) :: walls
    type(flow_valve_t), allocatable, intent(in) :: valves(:)   !! one for both, or one for each port
    real(dp), intent(in) :: tolerance                      !! relative, of the integration
    integer :: i
    self%given = given
    if (allocated(walls)) allocate (self%walls, source=walls)
    self%is_state = allocated(walls) .or. allocated(valves) .or. given%leak_area > 0
    if (.not. allocated(valves)) return
    allocate (self%valves(2), source=valves(1))
    do i = 1, size(valves)
      if (valves(i)%port == 'suction') self%valves(suction) = valves(i)
      if (valves(i)%port == 'discharge') self%valves(discharge) = valves(i)
    end do
    if (.not. any(self%valves%mass > 0)) return
    allocate (self%reeds)
    self%reeds%margin = tolerance
  end subroutine set_case

  !> Prepare for a cylinder, in which the gas was closed in at a volume [m^3].
  subroutine prepare(self, cylinder, chamber, crankcase_pressure)
    class(charge_t), intent(inout) :: self
    type(cylinder_t), intent(in) :: cylinder
    type(chamber_t), intent(in) :: chamber        !! but for what the group of the gas gives
    real(dp), intent(in) :: crankcase_pressure    !! [Pa]
    self%cylinder = cylinder
    self%chamber = chamber
    associate (c => self%chamber)
      c%displacement = cylinder%displacement
      c%gas_constant = self%given%gas_constant
      c%closing_temperature = self%given%temperature
      if (self%given%heat_capacity_ratio > 0) c%heat_capacity_ratio = self%given%heat_capacity_ratio
      self%closed_mass = c%closing_pressure*c%closing_volume/(c%gas_constant*c%closing_temperature)
    end associate
    self%crankcase_pressure = crankcase_pressure
  end subroutine prepare

  !> Set the pressure behind the discharge valve of a compressor [Pa].
  subroutine set_discharge(self, pressure)
    class(charge_t), intent(inout) :: self
    real(dp), intent(in) :: pressure
    self%discharge_pressure = pressure
    self%returning_temperature = self%delivery_temperature(pressure, self%chamber%heat_capacity_ratio)
  end subroutine set_discharge

  !> Claim pressures and masses of a number of cylinders, and the integrals. The balance takes part in the error control, since the
  !> heat to walls that conduct well is that of small differences, and so do the losses of valves, whose rates have kinks where the
  !> pressures are equal; the others have no influence on the steps.
  subroutine claim(self, layout, cylinders)
    class(charge_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    integer, intent(in) :: cylinders
    type(slice_t) :: more
    real(dp) :: work   !! natural size [J]
    call layout%claim_states(cylinders, self%chamber%closing_pressure, self%pressures)
    call layout%claim_states(cylinders, self%closed_mass, self%masses)
    if (allocated(self%reeds)) call self%reeds%claim(layout, self%valves, cylinders)
    work = self%chamber%closing_pressure*self%chamber%displacement
    call layout%claim_quadratures(of_balance, work, self%sums)
    if (allocated(self%valves)) then
      call layout%claim_quadratures(suction_loss - of_balance - 1, 0.0_dp, more)
      call layout%claim_quadratures(discharge_loss - suction_loss + 1, work, more)
      call layout%claim_quadratures(n_charge_sums - discharge_loss, 0.0_dp, more)
    else
      call layout%claim_quadratures(n_closed_sums - of_balance, 0.0_dp, more)
    end if
    self%sums%last = more%last
  end subroutine claim

  !> Declare the states of cylinder i, with a prefix for their names, and with the first one the integrals.
  subroutine declare(self, list, i, y, prefix)
    class(charge_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    integer, intent(in) :: i
    real(dp), intent(inout) :: y(:)
    character(len=*), intent(in) :: prefix
    call list%add(prefix//'gas_pressure', y(self%pressures%first + i - 1), 'Pa', 'pressure of the gas in the cylinder')
    call list%add(prefix//'gas_mass', y(self%masses%first + i - 1), 'kg', 'its mass')
    if (allocated(self%reeds)) call self%reeds%declare(list, self%valves, i, y, prefix)
    if (i > 1) return
    list%of_totals = .true.
    call list%add('gas_sums', y(self%sums%first:self%sums%last), '', &
      'integrals over time: energy of the gas, heat to the walls [J], mass lost [kg], its enthalpy, size of the work [J]; of a '// &
      'compressor also mass delivered [kg], that times its temperature [kg K], losses of both valves, work on the gas [J]')
    call list%add('opening_temperature', self%opening_temperature, 'K', 'temperature of the gas when the cylinder last opened')
    list%of_totals = .false.
  end subroutine declare

  !> Set the states of cylinder i at an angle of its cycle [rad] and a pressure [Pa]: fresh gas if it is open, else all that was
  !> closed in.
  pure subroutine set_start(self, i, angle, pressure, is_open, y)
    class(charge_t), intent(in) :: self
    integer, intent(in) :: i
    real(dp), intent(in) :: angle, pressure
    logical, intent(in) :: is_open
    real(dp), intent(inout) :: y(:)
    associate (p => y(self%pressures%first + i - 1), m => y(self%masses%first + i - 1))
      p = pressure
      m = self%closed_mass
      if (is_open) m = fresh_mass(self, self%cylinder%volume(angle))
    end associate
    if (i == 1) y(self%sums%first) = self%energy(angle, y)
  end subroutine set_start

  !> Set the rates of the states of cylinder i.
  pure subroutine set_rates(self, i, now, y, dydt)
    class(charge_t), intent(in) :: self
    integer, intent(in) :: i
    type(charge_motion_t), intent(in) :: now
    real(dp), intent(in) :: y(:)
    real(dp), intent(inout) :: dydt(:)
    integer :: k
    dydt(self%pressures%first + i - 1) = now%pressure_rate
    dydt(self%masses%first + i - 1) = now%mass_rate
    if (.not. allocated(self%reeds)) return
    do k = suction, discharge
      associate (at => self%reeds%at(k))
        if (at%n == 0) cycle
        dydt(at%position + i - 1) = y(at%rate + i - 1)
        dydt(at%rate + i - 1) = now%valve_acceleration(k)
      end associate
    end do
  end subroutine set_rates

  !> Event functions of the valves of cylinder i that have a mass, and their rates.
  pure subroutine reed_events(self, i, now, y, g, g_rate)
    class(charge_t), intent(in) :: self
    integer, intent(in) :: i
    type(charge_motion_t), intent(in) :: now
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: g(2), g_rate(2)
    real(dp) :: excess(2)
    integer :: k
    excess = opening_difference(self, now%pressure)
    do k = suction, discharge
      call self%reeds%events(self%valves(k), k, i, excess(k), merge(-1, 1, k == suction)*now%pressure_rate, y, g(k), g_rate(k))
    end do
  end subroutine reed_events

  !> Pass the event of a valve of cylinder i that has a mass.
  pure subroutine pass_reed(self, i, port, now, y)
    class(charge_t), intent(inout) :: self
    integer, intent(in) :: i, port
    type(charge_motion_t), intent(in) :: now
    real(dp), intent(inout) :: y(:)
    real(dp) :: excess(2)
    excess = opening_difference(self, now%pressure)
    call self%reeds%pass(self%valves(port), port, i, excess(port), y)
  end subroutine pass_reed

  !> By how much the pressure before each valve is above that behind it, at a pressure in the cylinder [Pa].
  pure function opening_difference(self, pressure) result(excess)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: pressure
    real(dp) :: excess(2)
    excess = [self%chamber%closing_pressure - pressure, pressure - self%discharge_pressure]
  end function opening_difference

  !> Mass of the fresh charge in a volume [kg].
  pure real(dp) function fresh_mass(self, volume)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: volume
    fresh_mass = self%chamber%closing_pressure*volume/(self%chamber%gas_constant*self%chamber%closing_temperature)
  end function fresh_mass

  !> Whether the pressures and masses of a state are possible.
  pure logical function admits(self, y)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    admits = all(y(self%pressures%first:self%pressures%last) > 0) .and. all(y(self%masses%first:self%masses%last) > 0)
  end function admits

  !> The gas of cylinder i at an angle [rad] and a speed [rad/s] of its cycle, with the heat that burns [W].
  pure subroutine move(self, i, angle, speed, burning, is_open, y, now)
    class(charge_t), intent(in) :: self
    integer, intent(in) :: i
    real(dp), intent(in) :: angle, speed, burning, y(:)
    logical, intent(in) :: is_open
    type(charge_motion_t), intent(out) :: now
    real(dp), parameter :: per_turn = 0.318309886183790672_dp   ! 1/pi: two strokes a turn [1/rad]
    real(dp) :: volume, rate, heat_capacity, enthalpy, leak_enthalpy
    volume = self%cylinder%volume(angle)
    rate = self%cylinder%volume_slope(angle)*speed
    associate (g => self%chamber%heat_capacity_ratio, constant => self%chamber%gas_constant)
      now%heat_flow = 0
      now%leak_flow = 0
      now%valve_flow = 0
      now%valve_lift = 0
      now%rates = 0
      if (is_open) then
        now%pressure = self%chamber%closing_pressure
        now%temperature = self%chamber%closing_temperature
        now%mass = fresh_mass(self, volume)
        now%mass_rate = fresh_mass(self, rate)
        now%pressure_rate = 0
        now%temperature_rate = 0
        now%rates(of_balance) = now%pressure*rate/(g - 1)
        return
      end if
      now%pressure = y(self%pressures%first + i - 1)
      now%mass = y(self%masses%first + i - 1)
      now%temperature = now%pressure*volume/(now%mass*constant)
      if (allocated(self%walls)) now%heat_flow = self%walls%heat_flow(self%chamber, &
        hot_gas_t(now%pressure, now%temperature, volume, self%chamber%stroke*abs(speed)*per_turn))
      now%leak_flow = orifice_flow(self%given%leak_area, constant, g, [now%pressure, self%crankcase_pressure], &
        [now%temperature, self%given%temperature])
      heat_capacity = g*constant/(g - 1)
      leak_enthalpy = heat_capacity*now%leak_flow*merge(now%temperature, self%given%temperature, now%leak_flow > 0)
      enthalpy = leak_enthalpy
      now%mass_rate = -now%leak_flow
      if (allocated(self%valves)) then
        call move_valves(self, i, rate, y, now)
        enthalpy = enthalpy + heat_capacity*(now%valve_heat(discharge) - now%valve_heat(suction))
        now%mass_rate = now%mass_rate + now%valve_flow(suction) - now%valve_flow(discharge)
      end if
      now%pressure_rate = ((g - 1)*(burning - now%heat_flow - enthalpy) - g*now%pressure*rate)/volume
      now%temperature_rate = now%temperature*(now%pressure_rate/now%pressure + rate/volume - now%mass_rate/now%mass)
      now%rates(:n_closed_sums) = [burning - now%heat_flow - enthalpy - now%pressure*rate, now%heat_flow, now%leak_flow, &
        leak_enthalpy, abs(now%pressure*rate)]
    end associate
  end subroutine move

  !> Flows through the valves of cylinder i, and the work that is lost there, at a rate of the volume [m^3/s].
  pure subroutine move_valves(self, i, rate, y, now)
    class(charge_t), intent(in) :: self
    integer, intent(in) :: i
    real(dp), intent(in) :: rate, y(:)
    type(charge_motion_t), intent(inout) :: now
    real(dp) :: share, reed(2)
    real(dp) :: pressure(2, 2), temperature(2, 2), excess(2)   ! (before, behind; valve), which opens it [Pa], [K]
    integer :: k
    pressure(:, suction) = [self%chamber%closing_pressure, now%pressure]
    pressure(:, discharge) = [now%pressure, self%discharge_pressure]
    temperature(:, suction) = [self%given%temperature, now%temperature]
    temperature(:, discharge) = [now%temperature, self%returning_temperature]
    excess = opening_difference(self, now%pressure)
    do k = suction, discharge
      associate (valve => self%valves(k))
        if (valve%mass > 0) then   ! behind a bound, in a trial step, the flow goes on smoothly
          reed = self%reeds%lift_and_speed(valve, k, i, y)
          now%valve_lift(k) = reed(1)
          now%valve_speed(k) = reed(2)
          now%valve_acceleration(k) = self%reeds%acceleration(valve, k, i, excess(k), y)
          now%valve_flow(k) = now%valve_lift(k)/valve%lift*orifice_flow(valve%area, self%chamber%gas_constant, &
            self%chamber%heat_capacity_ratio, pressure(:, k), temperature(:, k))
        else
          share = valve%open_share(excess(k))
          now%valve_lift(k) = valve%lift*share
          now%valve_flow(k) = orifice_flow(valve%area*share, self%chamber%gas_constant, self%chamber%heat_capacity_ratio, &
            pressure(:, k), temperature(:, k))
        end if
      end associate
      now%valve_heat(k) = now%valve_flow(k)*temperature(merge(1, 2, excess(k) >= 0), k)
    end do
    now%rates(delivered) = now%valve_flow(discharge)
    now%rates(delivered_heat) = now%valve_heat(discharge)
    now%rates(suction_loss) = max(excess(suction), 0.0_dp)*rate
    now%rates(discharge_loss) = -max(excess(discharge), 0.0_dp)*rate
    now%rates(work_on_gas) = -now%pressure*rate
  end subroutine move_valves

  !> The gas of an engine where it has no states, at a pressure [Pa] with its slope over the angle [Pa/rad].
  pure subroutine move_adiabatic(self, angle, speed, pressure, slope, is_open, now)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: angle, speed, pressure, slope
    logical, intent(in) :: is_open
    type(charge_motion_t), intent(out) :: now
    real(dp) :: volume, rate
    volume = self%cylinder%volume(angle)
    rate = self%cylinder%volume_slope(angle)*speed
    now%pressure = pressure
    now%pressure_rate = slope*speed
    now%mass = self%closed_mass
    now%mass_rate = 0
    if (is_open) now%mass = fresh_mass(self, volume)
    if (is_open) now%mass_rate = fresh_mass(self, rate)
    now%temperature = now%pressure*volume/(now%mass*self%chamber%gas_constant)
    now%temperature_rate = now%temperature*(now%pressure_rate/now%pressure + rate/volume - now%mass_rate/now%mass)
    now%heat_flow = 0
    now%leak_flow = 0
    now%valve_flow = 0
    now%valve_lift = 0
    now%rates = 0
  end subroutine move_adiabatic

  !> The gas between the ideal valves of a compressor, at a pressure [Pa] with its slope over the angle [Pa/rad]. Compressed with an
  !> exponent n, delivered without a change of its state and expanded again it always has T = T_s (p/p_s)^((n - 1)/n).
  pure subroutine move_polytropic(self, angle, speed, pressure, slope, exponent, now)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: angle, speed, pressure, slope, exponent
    type(charge_motion_t), intent(out) :: now
    real(dp) :: volume
    call self%move_adiabatic(angle, speed, pressure, slope, .false., now)
    volume = self%cylinder%volume(angle)
    now%temperature = self%delivery_temperature(pressure, exponent)
    now%temperature_rate = (exponent - 1)/exponent*now%temperature*now%pressure_rate/pressure
    now%mass = pressure*volume/(self%chamber%gas_constant*now%temperature)
    now%mass_rate = now%mass*(now%pressure_rate/pressure + self%cylinder%volume_slope(angle)*speed/volume - &
      now%temperature_rate/now%temperature)
  end subroutine move_polytropic

  !> Temperature of gas from the suction chamber that is compressed to a pressure [Pa] with an exponent [K].
  pure real(dp) function delivery_temperature(self, pressure, exponent)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: pressure, exponent
    delivery_temperature = self%chamber%closing_temperature*(pressure/self%chamber%closing_pressure)**((exponent - 1)/exponent)
  end function delivery_temperature

  !> Energy of the gas in the mechanism's cylinder, p V/(g - 1), at an angle of its cycle [rad] [J].
  pure real(dp) function energy(self, angle, y)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: angle, y(:)
    energy = y(self%pressures%first)*self%cylinder%volume(angle)/(self%chamber%heat_capacity_ratio - 1)
  end function energy

  !> The integrals so far; in the place of the balance its error, energy of the gas less what it has received [J].
  pure function totals(self, angle, y)
    class(charge_t), intent(in) :: self
    real(dp), intent(in) :: angle, y(:)
    real(dp) :: totals(n_charge_sums)
    totals = 0
    totals(:self%sums%last - self%sums%first + 1) = y(self%sums%first:self%sums%last)
    totals(of_balance) = self%energy(angle, y) - totals(of_balance)
  end function totals

  !> Cylinder i opens or closes, and its gas is exchanged.
  pure subroutine exchange(self, i, angle, pressure, is_open, y)
    class(charge_t), intent(inout) :: self
    integer, intent(in) :: i
    real(dp), intent(in) :: angle, pressure
    logical, intent(in) :: is_open
    real(dp), intent(inout) :: y(:)
    real(dp) :: before
    if (.not. self%is_state) return
    before = y(self%sums%first)
    if (i == 1) before = before - self%energy(angle, y)
    call self%set_start(i, angle, pressure, is_open, y)
    if (i == 1) y(self%sums%first) = before + self%energy(angle, y)
  end subroutine exchange

  !> Whether gas leaves the closed cylinder.
  pure logical function loses_gas(self)
    class(charge_t), intent(in) :: self
    loses_gas = self%given%leak_area > 0
  end function loses_gas
end module cylinder_charge
