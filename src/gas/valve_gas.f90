!> Gas in a cylinder with self-acting valves, as in a piston compressor.
!>
!> While both valves are closed the mass in the cylinder and p V^n are constant. The discharge valve opens when the pressure reaches
!> the discharge pressure; the displaced gas then leaves at this pressure, until the valve closes when the piston reverses. The
!> suction valve behaves correspondingly at the suction pressure. The state of the valves follows from the motion of the piston, for
!> either sense of rotation. At each opening and closing the derivative of the pressure is discontinuous. Crank angles q count from
!> the inner dead centre.
module valve_gas
  use kinds, only: dp
  use constants, only: two_pi
  use cylinder, only: cylinder_t
  use run_state, only: run_state_t
  implicit none
  private
  public :: valve_gas_t, n_valve_events

  integer, parameter :: n_valve_events = 2

  !> States of the valves.
  integer, parameter :: both_closed = 1, discharge_open = 2, suction_open = 3

  !> A valve opens at a volume beyond that of its pressure by this fraction, so that a valve that has just closed does not open at
  !> once.
  real(dp), parameter :: opening_margin = 1e-11_dp

  type :: valve_gas_t
    type(cylinder_t) :: cylinder
    real(dp) :: suction_pressure = 0, discharge_pressure = 0   !! [Pa]
    real(dp) :: exponent = 1          !! n [-]
    integer :: state = both_closed
    real(dp) :: held_pressure = 0, held_volume = 0             !! pressure [Pa] and volume [m^3] when the last valve closed
    real(dp) :: discharge_volume = 0, suction_volume = 0       !! volumes at which the valves open [m^3]
    real(dp) :: sense = 1             !! sense of rotation since a valve opened: 1 or -1
    real(dp) :: dead_centre = 0       !! angle at which that valve closes [rad]
  contains
    procedure :: find_state
    procedure :: declare
    procedure :: pressure
    procedure :: pressure_slope
    procedure :: events
    procedure :: pass
    procedure :: volumetric_efficiency
  end type valve_gas_t

contains

  !> Initial state: that of a machine that has been running for a long time. At rest the cylinder is filled at suction pressure.
  subroutine find_state(self, q, crank_speed)
    class(valve_gas_t), intent(inout) :: self
    real(dp), intent(in) :: q, crank_speed   !! crank angle [rad] and crank speed [rad/s]
    real(dp) :: volume, largest, least, most
    volume = self%cylinder%volume(q)
    if (.not. abs(crank_speed) > 0) then
      call close_valves(self, self%suction_pressure, volume)
      return
    end if
    largest = self%cylinder%dead_volume + self%cylinder%displacement
    least = self%cylinder%dead_volume
    most = min(self%discharge_pressure, self%suction_pressure*(largest/least)**self%exponent)   ! pressure at the inner dead centre
    if (self%cylinder%volume_slope(q)*crank_speed < 0 .or. volume >= largest) then
      call close_valves(self, self%suction_pressure, largest)
      if (volume <= self%discharge_volume) call open_valve(self, discharge_open, q, crank_speed)
    else
      call close_valves(self, most, least)
      if (volume >= self%suction_volume) call open_valve(self, suction_open, q, crank_speed)
    end if
  end subroutine find_state

  !> Declare the state of the valves, with a prefix for its names.
  subroutine declare(self, list, q, crank_speed, prefix)
    class(valve_gas_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(in) :: q, crank_speed   !! crank angle [rad] and crank speed [rad/s]
    character(len=*), intent(in) :: prefix
    integer :: state
    state = self%state
    call list%add(prefix//'valve', state, '1: both valves are closed, 2: the discharge valve is open, 3: the suction valve is open')
    call list%add(prefix//'held_pressure', self%held_pressure, 'Pa', 'pressure of the gas when the last valve closed')
    call list%add(prefix//'held_volume', self%held_volume, 'm3', 'volume of the gas when the last valve closed')
    if (.not. list%sets) return
    call close_valves(self, self%held_pressure, self%held_volume)
    if (all(state /= [both_closed, discharge_open, suction_open])) call list%refuse(prefix//'valve', 'must be 1, 2 or 3')
    if (state /= both_closed) call open_valve(self, state, q, crank_speed)
  end subroutine declare

  !> p [Pa] at crank angle q [rad].
  pure real(dp) function pressure(self, q)
    class(valve_gas_t), intent(in) :: self
    real(dp), intent(in) :: q
    select case (self%state)
    case (discharge_open)
      pressure = self%discharge_pressure
    case (suction_open)
      pressure = self%suction_pressure
    case default
      pressure = self%held_pressure*(self%held_volume/self%cylinder%volume(q))**self%exponent
    end select
  end function pressure

  !> dp/dq [Pa/rad].
  pure real(dp) function pressure_slope(self, q)
    class(valve_gas_t), intent(in) :: self
    real(dp), intent(in) :: q
    pressure_slope = 0
    if (self%state == both_closed) pressure_slope = &
      -self%exponent*self%pressure(q)*self%cylinder%volume_slope(q)/self%cylinder%volume(q)
  end function pressure_slope

  !> Event functions: the discharge valve or the suction valve opens; or the open valve closes, at the dead centre or because the
  !> crank turns back. The rate of the last one would need an evaluation and is not given; the search for events therefore samples
  !> steps in which the speed changes fourfold.
  pure subroutine events(self, q, crank_speed, g, g_rate)
    class(valve_gas_t), intent(in) :: self
    real(dp), intent(in) :: q, crank_speed
    real(dp), intent(out) :: g(n_valve_events), g_rate(n_valve_events)
    real(dp) :: volume, rate
    if (self%state == both_closed) then
      volume = self%cylinder%volume(q)
      rate = self%cylinder%volume_slope(q)*crank_speed
      g = [self%discharge_volume - volume, volume - self%suction_volume]
      g_rate = [-rate, rate]
    else
      g = self%sense*[q - self%dead_centre, -crank_speed]
      g_rate = [self%sense*crank_speed, 0.0_dp]
    end if
  end subroutine events

  !> Handle the opening or closing of a valve.
  subroutine pass(self, event, q, crank_speed)
    class(valve_gas_t), intent(inout) :: self
    integer, intent(in) :: event
    real(dp), intent(in) :: q, crank_speed
    if (self%state == both_closed) then
      call open_valve(self, merge(discharge_open, suction_open, event == 1), q, crank_speed)
    else
      call close_valves(self, self%pressure(q), self%cylinder%volume(q))
    end if
  end subroutine pass

  !> Gas that is delivered in a revolution over that of the displacement at suction: 1 + c - c (p_d/p_s)^(1/n), c the dead space; 0
  !> where the discharge pressure is not reached.
  pure real(dp) function volumetric_efficiency(self) result(efficiency)
    class(valve_gas_t), intent(in) :: self
    associate (dead_space => self%cylinder%dead_volume/self%cylinder%displacement)
      efficiency = max(0.0_dp, 1 + dead_space - dead_space*(self%discharge_pressure/self%suction_pressure)**(1/self%exponent))
    end associate
  end function volumetric_efficiency

  !> Set both valves to closed, with gas of this pressure [Pa] and volume [m^3].
  subroutine close_valves(self, pressure, volume)
    class(valve_gas_t), intent(inout) :: self
    real(dp), intent(in) :: pressure, volume
    self%state = both_closed
    self%held_pressure = pressure
    self%held_volume = volume
    self%discharge_volume = volume*(pressure/self%discharge_pressure)**(1/self%exponent)*(1 - opening_margin)
    self%suction_volume = volume*(pressure/self%suction_pressure)**(1/self%exponent)*(1 + opening_margin)
  end subroutine close_valves

  !> Open a valve until the next dead centre at which the volume is smallest (discharge) or largest (suction).
  subroutine open_valve(self, state, q, crank_speed)
    class(valve_gas_t), intent(inout) :: self
    integer, intent(in) :: state
    real(dp), intent(in) :: q, crank_speed
    real(dp) :: first
    first = merge(0.0_dp, self%cylinder%bottom, state == discharge_open)
    self%state = state
    self%sense = sign(1.0_dp, crank_speed)
    self%dead_centre = first + self%sense*two_pi*ceiling(self%sense*(q - first)/two_pi)
  end subroutine open_valve
end module valve_gas
