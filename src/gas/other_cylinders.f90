!> The gas in the other cylinders of an engine than that of the mechanism. All have the same cycle, but perhaps
!> another heat, the same valves or measured pressure, a function of the crank angle from their own axis; each has its own part of
!> the cycle or its own state of the valves.
module other_cylinders
  use kinds, only: dp
  use text_tools, only: integer_text
  use run_state, only: run_state_t
  use valve_gas, only: valve_gas_t, n_valve_events
  use gas_cycle, only: gas_cycle_t
  use working_gas, only: working_gas_t
  use cylinder_charge, only: charge_motion_t
  use gas_cycle, only: part_open
  implicit none
  private
  public :: other_cylinders_t, n_other_events

  !> Events of all of them together: for cycles the nearest bound ahead and the nearest behind.
  integer, parameter :: n_other_events = 2

  !> Bounds of several cylinders that are this close are passed at the same instant [rad]: those of opposite cylinders differ by
  !> rounding.
  real(dp), parameter :: same_instant = 1e-12_dp

  type :: other_cylinders_t
    integer, allocatable :: number(:)            !! of each cylinder in the case
    real(dp), allocatable :: scale(:)            !! factor on the pressure
    logical, allocatable :: has_gas(:)           !! its gas has a force
    integer, allocatable :: part(:)              !! present part of the cycle
    real(dp), allocatable :: cycle_start(:)      !! angle at which the present cycle began [rad]
    type(valve_gas_t), allocatable :: valves(:)
    type(gas_cycle_t), allocatable :: cycles(:)  !! with different heats or states of the gas; else all have
                                                 !! that of the mechanism
  contains
    procedure :: start
    procedure :: declare
    procedure, non_overridable :: find_forces
    procedure :: set_charges
    procedure :: set_rates
    procedure, non_overridable :: find_charge
    procedure :: heat
    procedure :: n_events
    procedure :: events
    procedure :: pass
    procedure, nopass :: is_now
  end type other_cylinders_t

contains

  !> Find the initial discrete states, at crank angles from the axes of the cylinders [rad] and a speed [rad/s].
  subroutine start(self, gas, angle, speed)
    class(other_cylinders_t), intent(inout) :: self
    type(working_gas_t), intent(in) :: gas   !! of the mechanism
    real(dp), intent(in) :: angle(:), speed
    integer :: i
    if (.not. allocated(self%part)) allocate (self%part(size(angle)), self%cycle_start(size(angle)))
    if (allocated(gas%valves) .and. .not. allocated(self%valves)) &
      allocate (self%valves(size(angle)), source=gas%valves)
    do i = 1, size(angle)
      if (allocated(gas%cycle)) then
        call gas%cycle%part_at(gas%sense*gas%angle(angle(i)), gas%sense*speed < 0, self%part(i), self%cycle_start(i))
      else if (allocated(gas%valves)) then
        call self%valves(i)%find_state(gas%angle(angle(i)), speed)
      end if
    end do
  end subroutine start

  !> Declare the states, from which those of a cycle follow by the angles.
  subroutine declare(self, list, gas, y, angle, speed)
    class(other_cylinders_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(working_gas_t), intent(inout) :: gas
    real(dp), intent(inout) :: y(:)
    real(dp), intent(in) :: angle(:), speed(:)
    integer :: i
    if (allocated(self%valves)) then
      do i = 1, size(angle)
        call self%valves(i)%declare(list, gas%angle(angle(i)), speed(i), 'cylinder_'//integer_text(self%number(i))//'_')
      end do
    else if (list%sets) then
      call self%start(gas, angle, speed(1))
    end if
    if (.not. gas%has_states()) return
    do i = 1, size(angle)
      call gas%charge%declare(list, i + 1, y, 'cylinder_'//integer_text(self%number(i))//'_')
    end do
  end subroutine declare

  !> Set the states of gas that has a mass at the start of a run, at crank angles from the axes of the cylinders [rad].
  pure subroutine set_charges(self, gas, angle, y)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    real(dp), intent(in) :: angle(:)
    real(dp), intent(inout) :: y(:)
    integer :: i
    do i = 1, size(angle)
      if (allocated(gas%cycle)) then
        call gas%charge%set_start(i + 1, gas%sense*gas%angle(angle(i)), self%cycles(i)%pressure(gas%sense*gas%angle(angle(i)), &
          self%part(i), self%cycle_start(i)), self%part(i) == part_open, y)
      else
        call gas%charge%set_start(i + 1, gas%sense*gas%angle(angle(i)), gas%charge%chamber%closing_pressure, .true., y)
      end if
    end do
  end subroutine set_charges

  !> Rates of these states, at crank angles [rad] and speeds [rad/s].
  pure subroutine set_rates(self, gas, angle, speed, y, dydt)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    real(dp), intent(in) :: angle(:), speed(:), y(:)
    real(dp), intent(inout) :: dydt(:)
    type(charge_motion_t) :: now
    integer :: i
    do i = 1, size(angle)
      call self%find_charge(gas, i, angle(i), speed(i), y, now)
      call gas%charge%set_rates(i + 1, now, y, dydt)
    end do
  end subroutine set_rates

  !> Mass and temperature of the gas of the i-th of them, where these are states, at a crank angle [rad] and a speed [rad/s].
  pure subroutine find_charge(self, gas, i, angle, speed, y, now)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    integer, intent(in) :: i
    real(dp), intent(in) :: angle, speed, y(:)
    type(charge_motion_t), intent(out) :: now
    real(dp) :: burning
    logical :: is_open
    burning = 0
    is_open = .false.
    if (allocated(gas%cycle)) then
      is_open = self%part(i) == part_open
      burning = self%cycles(i)%heat_slope(gas%sense*gas%angle(angle), self%part(i), self%cycle_start(i))*gas%sense*speed
    end if
    call gas%charge%move(i + 1, gas%sense*gas%angle(angle), gas%sense*speed, burning, is_open, y, now)
  end subroutine find_charge

  !> Forces of the gas on the pistons at crank angles from their axes [rad], towards the shaft [N]; unchanged where there is none.
  pure subroutine find_forces(self, gas, y, angle, force)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    real(dp), intent(in) :: y(:), angle(*)
    real(dp), intent(inout) :: force(*)
    real(dp) :: pressure
    integer :: i
    do i = 1, size(self%has_gas)
      if (.not. self%has_gas(i)) cycle
      if (gas%has_states()) then
        pressure = y(gas%charge%pressures%first + i)
        if (allocated(gas%cycle)) pressure = merge(gas%cycle%intake_pressure, pressure, self%part(i) == part_open)
      else if (allocated(self%cycles)) then
        pressure = self%cycles(i)%pressure(gas%sense*gas%angle(angle(i)), self%part(i), self%cycle_start(i))
      else if (allocated(gas%cycle)) then
        pressure = gas%cycle%pressure(gas%sense*gas%angle(angle(i)), self%part(i), self%cycle_start(i))
      else if (allocated(gas%valves)) then
        pressure = self%valves(i)%pressure(gas%angle(angle(i)))
      else if (allocated(gas%curve)) then
        pressure = gas%curve%value(gas%angle(angle(i)))
      else
        pressure = gas%held_pressure
      end if
      force(i) = (self%scale(i)*pressure - gas%crankcase_pressure)*gas%cylinder%area
    end do
  end subroutine find_forces

  !> Heat of all of them that have gas together in a cycle [J].
  pure real(dp) function heat(self, gas)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    heat = 0
    if (.not. allocated(gas%cycle)) return
    heat = count(self%has_gas)*gas%cycle%release%heat
    if (allocated(self%cycles)) heat = sum(self%cycles%release%heat, self%has_gas)
  end function heat

  !> Number of the event functions of all of them together.
  pure integer function n_events(self, gas)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    n_events = merge(n_other_events, 0, size(self%has_gas) > 0 .and. gas%n_events > 0)
  end function n_events

  !> The event functions: of those of all cylinders the largest.
  pure subroutine events(self, gas, angle, speed, g, g_rate)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    real(dp), intent(in) :: angle(:), speed(:)
    real(dp), intent(out) :: g(n_other_events), g_rate(n_other_events)
    real(dp) :: own(n_other_events), own_rate(n_other_events)
    integer :: i, k
    g = -huge(1.0_dp)
    g_rate = 0
    do i = 1, size(self%has_gas)
      call own_events(self, gas, i, angle(i), speed(i), own, own_rate)
      do k = 1, n_other_events
        if (own(k) <= g(k)) cycle
        g(k) = own(k)
        g_rate(k) = own_rate(k)
      end do
    end do
  end subroutine events

  !> The event functions of cylinder i.
  pure subroutine own_events(self, gas, i, angle, speed, g, g_rate)
    class(other_cylinders_t), intent(in) :: self
    type(working_gas_t), intent(in) :: gas
    integer, intent(in) :: i
    real(dp), intent(in) :: angle, speed
    real(dp), intent(out) :: g(n_valve_events), g_rate(n_valve_events)
    real(dp) :: along
    if (allocated(self%valves)) then
      call self%valves(i)%events(gas%angle(angle), speed, g, g_rate)
    else
      along = gas%sense*gas%angle(angle) - self%cycle_start(i)
      g = [along - gas%cycle%bound(self%part(i)), gas%cycle%bound(self%part(i) - 1) - along]
      g_rate = gas%sense*[speed, -speed]
    end if
  end subroutine own_events

  !> Handle an event: all cylinders of which it is one. With `is_own` at least one of them has it; otherwise it is one of the
  !> mechanism's cylinder.
  subroutine pass(self, gas, event, angle, speed, is_own, y)
    class(other_cylinders_t), intent(inout) :: self
    type(working_gas_t), intent(inout) :: gas
    integer, intent(in) :: event
    real(dp), intent(in) :: angle(:), speed(:)
    logical, intent(in) :: is_own
    real(dp), intent(inout) :: y(:)   !! state of the scene
    real(dp) :: g(n_valve_events, size(angle)), g_rate(n_valve_events), largest, along
    integer :: i, from
    do i = 1, size(angle)
      call own_events(self, gas, i, angle(i), speed(i), g(:, i), g_rate)
    end do
    largest = 0
    if (is_own) largest = min(largest, maxval(g(event, :)))
    do i = 1, size(angle)
      if (g(event, i) < largest) then
        if (allocated(self%valves) .or. .not. is_now(g(event, i), angle(i))) cycle
      end if
      if (allocated(self%valves)) then
        call self%valves(i)%pass(event, gas%angle(angle(i)), speed(i))
      else
        from = self%part(i)
        call gas%cycle%next_part(event == 1, self%part(i), self%cycle_start(i))
        if (.not. gas%has_states() .or. ((from == part_open) .eqv. (self%part(i) == part_open))) cycle
        along = gas%sense*gas%angle(angle(i))
        call gas%charge%exchange(i + 1, along, self%cycles(i)%pressure(along, self%part(i), self%cycle_start(i)), &
          self%part(i) == part_open, y)
      end if
    end do
  end subroutine pass

  !> Whether a bound at this distance [rad], negative before it, is passed at the present crank angle [rad] but for rounding.
  pure logical function is_now(distance, angle)
    real(dp), intent(in) :: distance, angle
    is_now = distance >= -max(same_instant, 8*spacing(angle))
  end function is_now
end module other_cylinders
