!> The gas in the cylinder of a running machine: the cycle of an engine and its present part, the gas of a compressor and the state
!> of its valves, a measured pressure, or one that is set from outside. Its angle is the crank angle from the dead centre of the
!> mechanism.
module working_gas
  use kinds, only: dp
  use constants, only: degree
  use trace_row, only: trace_row_t
  use run_state, only: run_state_t
  use monotone_cubic, only: monotone_cubic_t
  use cylinder, only: cylinder_t
  use gas_cycle, only: gas_cycle_t
  use valve_gas, only: valve_gas_t, n_valve_events
  use cylinder_charge, only: charge_t, charge_motion_t, n_charge_sums, of_balance, moved
  use gas_cycle, only: part_open
  use flow_valve, only: suction, discharge
  use trace_row, only: least, largest, of_cycle
  implicit none
  private
  public :: working_gas_t

  !> Events of a cycle: the crank passes from one part to the next, forwards or backwards.
  integer, parameter :: n_cycle_events = 2

  !> At most one of cycle, valves and curve is allocated; without them the pressure is `held_pressure`. The second derivative of
  !> a measured pressure is discontinuous at its points. There are no events for this: the error control detects it and reduces the
  !> order of the method.
  type :: working_gas_t
    integer :: n_events = 0          !! number of event functions, set by `start`
    integer :: revolutions = 1       !! period of the pressure [revolutions]
    real(dp) :: sense = 1            !! 1 or -1: a cycle follows its angle times this
    integer :: part = 0              !! present part of the cycle
    real(dp) :: cycle_start = 0      !! that angle at which the present cycle began [rad]
    type(cylinder_t) :: cylinder
    real(dp) :: crankcase_pressure = 0   !! [Pa]
    real(dp) :: held_pressure = 0        !! constant until it is set anew [Pa]
    real(dp) :: scale = 1                !! factor on the pressure
    logical :: has_force = .true.        !! otherwise the piston is moved without gas
    type(gas_cycle_t), allocatable :: cycle
    type(valve_gas_t), allocatable :: valves
    type(monotone_cubic_t), allocatable :: curve   !! measured pressure [Pa] over the crank angle [rad]
    type(charge_t), allocatable :: charge          !! mass and temperature of the gas of a cycle; not allocated: not asked for
  contains
    procedure :: start
    procedure, non_overridable :: angle => gas_angle
    procedure :: declare
    procedure :: longest_turn
    procedure :: is_external
    procedure, non_overridable :: pressure
    procedure, non_overridable :: force
    procedure :: set_charge
    procedure :: find_charge
    procedure :: charge_totals
    procedure :: charge_residual
    procedure :: has_states
    procedure :: force_slope
    procedure :: events
    procedure :: pass
    procedure :: add_columns
  end type working_gas_t

contains

  !> Find the initial discrete state: for a cycle, the part that contains the crank angle or is about to be entered.
  subroutine start(self, crank_angle, crank_speed)
    class(working_gas_t), intent(inout) :: self
    real(dp), intent(in) :: crank_angle, crank_speed   !! [rad], [rad/s]
    if (allocated(self%cycle)) then
      self%n_events = n_cycle_events
      call self%cycle%part_at(self%sense*self%angle(crank_angle), self%sense*crank_speed < 0, self%part, self%cycle_start)
    else if (allocated(self%valves)) then
      self%n_events = n_valve_events
      call self%valves%find_state(self%angle(crank_angle), crank_speed)
    end if
  end subroutine start

  !> The angle that the gas counts, from the dead centre at which its volume is smallest [rad].
  pure elemental real(dp) function gas_angle(self, crank_angle)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! from the axis of the cylinder [rad]
    gas_angle = crank_angle - self%cylinder%dead_centre
  end function gas_angle

  !> Declare the state of the gas at the angle and the speed of the crank, from which that of a cycle follows.
  subroutine declare(self, list, y, crank_angle, crank_speed)
    class(working_gas_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: crank_angle, crank_speed   !! [rad], [rad/s]
    if (allocated(self%valves)) then
      call self%valves%declare(list, self%angle(crank_angle), crank_speed, '')
    else if (list%sets) then
      call self%start(crank_angle, crank_speed)
    end if
    if (.not. self%has_states()) return
    call self%charge%declare(list, 1, y, '')
    if (list%sets .and. .not. list%goes_on) &
      y(self%charge%sums%first) = self%charge%energy(self%sense*self%angle(crank_angle), y)
  end subroutine declare

  !> Whether pressure and mass are states.
  pure logical function has_states(self)
    class(working_gas_t), intent(in) :: self
    has_states = .false.
    if (allocated(self%charge)) has_states = self%charge%is_state
  end function has_states

  !> Set the states at the start of a run.
  pure subroutine set_charge(self, crank_angle, y)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp), intent(inout) :: y(:)
    associate (angle => self%sense*self%angle(crank_angle))
      if (allocated(self%cycle)) then
        call self%charge%set_start(1, angle, self%cycle%pressure(angle, self%part, self%cycle_start), self%part == part_open, y)
      else
        call self%charge%set_start(1, angle, self%charge%chamber%closing_pressure, .true., y)
      end if
    end associate
  end subroutine set_charge

  !> Mass and temperature of the gas at an angle [rad] and a speed [rad/s] of the crank.
  pure subroutine find_charge(self, crank_angle, crank_speed, y, now)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, crank_speed, y(:)
    type(charge_motion_t), intent(out) :: now
    associate (angle => self%sense*self%angle(crank_angle), speed => self%sense*crank_speed)
      if (allocated(self%valves)) then
        call self%charge%move_polytropic(angle, speed, self%valves%pressure(self%angle(crank_angle)), &
          self%sense*self%valves%pressure_slope(self%angle(crank_angle)), self%valves%exponent, now)
      else if (.not. allocated(self%cycle)) then
        call self%charge%move(1, angle, speed, 0.0_dp, .false., y, now)
      else if (self%charge%is_state) then
        call self%charge%move(1, angle, speed, self%cycle%heat_slope(angle, self%part, self%cycle_start)*speed, &
          self%part == part_open, y, now)
      else
        call self%charge%move_adiabatic(angle, speed, self%cycle%pressure(angle, self%part, self%cycle_start), &
          self%cycle%pressure_slope(angle, self%part, self%cycle_start), self%part == part_open, now)
      end if
    end associate
  end subroutine find_charge

  !> See `totals` of `charge_t`; 0 without states.
  pure function charge_totals(self, crank_angle, y) result(totals)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, y(:)
    real(dp) :: totals(n_charge_sums)
    totals = 0
    if (self%has_states()) totals = self%charge%totals(self%sense*self%angle(crank_angle), y)
  end function charge_totals

  !> Size of the error of the gas's energy over that of its work, or over the energy if that is larger [-].
  pure real(dp) function charge_residual(self, crank_angle, y) result(residual)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, y(:)
    real(dp) :: totals(n_charge_sums)
    totals = self%charge_totals(crank_angle, y)
    residual = abs(totals(of_balance))/max(totals(moved), &
      self%charge%energy(self%sense*self%angle(crank_angle), y))
  end function charge_residual

  !> Largest crank angle in a step, so that no step passes over a peak [rad]; 0: no limit. A cycle needs no limit, since events
  !> divide it into smooth parts. For a measured pressure it is the smallest distance of its points, but at least 0.25 and at most 5
  !> degrees.
  pure real(dp) function longest_turn(self)
    class(working_gas_t), intent(in) :: self
    longest_turn = 0
    if (allocated(self%curve)) longest_turn = min(max(self%curve%finest(), 0.25_dp*degree), 5*degree)
  end function longest_turn

  !> Whether the pressure is set from outside.
  pure logical function is_external(self)
    class(working_gas_t), intent(in) :: self
    is_external = .not. (allocated(self%cycle) .or. allocated(self%valves) .or. allocated(self%curve) .or. self%has_states())
  end function is_external

  !> Pressure at a crank angle [Pa].
  pure real(dp) function pressure(self, crank_angle)
    class(working_gas_t), intent(in) :: self
    real(dp), value, intent(in) :: crank_angle
    if (allocated(self%cycle)) then
      pressure = self%cycle%pressure(self%sense*self%angle(crank_angle), self%part, self%cycle_start)
    else if (allocated(self%valves)) then
      pressure = self%valves%pressure(self%angle(crank_angle))
    else if (allocated(self%curve)) then
      pressure = self%curve%value(self%angle(crank_angle))
    else
      pressure = self%held_pressure
    end if
    pressure = self%scale*pressure
  end function pressure

  !> Force on the piston along -x [N] at a pressure [Pa]: (p - p_crankcase) pi b^2/4.
  pure real(dp) function force(self, pressure)
    class(working_gas_t), intent(in) :: self
    real(dp), value, intent(in) :: pressure
    force = 0
    if (self%has_force) force = (pressure - self%crankcase_pressure)*self%cylinder%area
  end function force

  !> Add pressure [Pa], force and volume at a crank angle with this sine and cosine to a row; nothing of a gas that does not act.
  pure subroutine add_columns(self, sin_crank, cos_crank, pressure, charge, row)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: sin_crank, cos_crank, pressure
    type(charge_motion_t), intent(in) :: charge
    type(trace_row_t), intent(inout) :: row
    real(dp) :: volume
    if (.not. self%has_force) return
    call row%add('cylinder_pressure[Pa]', pressure, 'absolute pressure of the gas in the cylinder')
    if (self%has_states()) call row%keep('max_cylinder_pressure', largest, 'largest pressure of the gas in the cylinder', &
      rate=charge%pressure_rate, told=of_cycle, has_angle=.true.)
    if (self%has_states()) call row%keep('min_cylinder_pressure', least, 'smallest pressure of the gas in the cylinder', &
      rate=charge%pressure_rate, told=of_cycle)
    volume = 0
    if (row%wants(1)) volume = self%cylinder%volume_at(sin_crank, cos_crank)
    call row%add('cylinder_volume[m3]', volume, 'volume of the gas in the cylinder')
    call row%add('gas_force[N]', self%force(pressure), &
      'force of the gas on the piston along -x: pressure difference to the crankcase times bore area')
    if (.not. allocated(self%charge)) return
    call row%add('gas_temperature[K]', charge%temperature, 'temperature of the gas in the cylinder')
    call row%keep('max_gas_temperature', largest, 'largest temperature of the gas in the cylinder', rate=charge%temperature_rate)
    call row%keep('min_gas_temperature', least, 'smallest temperature of the gas in the cylinder', rate=charge%temperature_rate)
    call row%add('gas_mass[kg]', charge%mass, 'mass of the gas in the cylinder')
    call row%add_on_request('wall_heat_flow[W]', charge%heat_flow, 'heat of the gas to the walls of the cylinder')
    call row%add_on_request('leak_flow[kg/s]', charge%leak_flow, 'flow of gas past the rings, positive out of the cylinder')
    if (.not. allocated(self%charge%valves)) return
    call row%add_on_request('suction_flow[kg/s]', charge%valve_flow(suction), 'flow of gas through the suction valve')
    call row%add_on_request('discharge_flow[kg/s]', charge%valve_flow(discharge), 'flow of gas through the discharge valve')
    call add_lift(row, suction, 'suction_valve_lift[m]', 'lift of the suction valve', 'max_suction_valve_lift', &
      'min_suction_valve_lift', 'suction_valve_speed[m/s]')
    call add_lift(row, discharge, 'discharge_valve_lift[m]', 'lift of the discharge valve', 'max_discharge_valve_lift', &
      'min_discharge_valve_lift', 'discharge_valve_speed[m/s]')

  contains

    !> The lift of a valve, with its extremes and its rate if the valve has a mass.
    pure subroutine add_lift(row, port, name, says, most, fewest, speed)
      type(trace_row_t), intent(inout) :: row
      integer, intent(in) :: port
      character(len=*), intent(in) :: name, says, most, fewest, speed   !! of its columns and its extremes
      associate (valve => self%charge%valves(port))
        call row%add_on_request(name, min(max(charge%valve_lift(port), 0.0_dp), valve%lift), says)
        if (.not. valve%mass > 0) return
        call row%keep(most, largest, 'largest lift of this valve', rate=charge%valve_speed(port), told=of_cycle)
        call row%keep(fewest, least, 'smallest lift of this valve', rate=charge%valve_speed(port), told=of_cycle)
        call row%add_on_request(speed, charge%valve_speed(port), 'rate of this lift')
      end associate
    end subroutine add_lift
  end subroutine add_columns

  !> Derivative of the force with respect to the crank angle, of gas without states [N/rad].
  pure real(dp) function force_slope(self, crank_angle)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle
    if (allocated(self%cycle)) then
      force_slope = self%sense*self%cycle%pressure_slope(self%sense*self%angle(crank_angle), self%part, self%cycle_start)
    else if (allocated(self%valves)) then
      force_slope = self%valves%pressure_slope(self%angle(crank_angle))
    else if (allocated(self%curve)) then
      force_slope = self%curve%slope(self%angle(crank_angle))
    else
      force_slope = 0
    end if
    force_slope = self%scale*self%cylinder%area*force_slope
    if (.not. self%has_force) force_slope = 0
  end function force_slope

  !> Event functions: for a cycle the bounds of the present part, for valves see valve_gas.
  pure subroutine events(self, crank_angle, crank_speed, g, g_rate)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, crank_speed
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    real(dp) :: angle
    if (allocated(self%cycle)) then
      angle = self%sense*self%angle(crank_angle) - self%cycle_start
      g = [angle - self%cycle%bound(self%part), self%cycle%bound(self%part - 1) - angle]
      g_rate = self%sense*[crank_speed, -crank_speed]
    else if (allocated(self%valves)) then
      call self%valves%events(self%angle(crank_angle), crank_speed, g, g_rate)
    end if
  end subroutine events

  !> Handle an event: the crank enters the next part of the cycle, or a valve opens or closes.
  subroutine pass(self, event, crank_angle, crank_speed, y)
    class(working_gas_t), intent(inout) :: self
    integer, intent(in) :: event
    real(dp), intent(in) :: crank_angle, crank_speed
    real(dp), intent(inout), optional :: y(:)   !! state of the scene, where the gas has a mass
    type(charge_motion_t) :: before
    integer :: from
    if (allocated(self%cycle)) then
      from = self%part
      if (allocated(self%charge)) call self%find_charge(crank_angle, crank_speed, y, before)
      call self%cycle%next_part(event == 1, self%part, self%cycle_start)
      if (.not. allocated(self%charge)) return
      if (event == 1 .and. self%part == part_open) self%charge%opening_temperature = before%temperature
      if ((from == part_open) .eqv. (self%part == part_open)) return
      associate (angle => self%sense*self%angle(crank_angle))
        call self%charge%exchange(1, angle, self%cycle%pressure(angle, self%part, self%cycle_start), self%part == part_open, y)
      end associate
    else if (allocated(self%valves)) then
      call self%valves%pass(event, self%angle(crank_angle), crank_speed)
    end if
  end subroutine pass
end module working_gas
