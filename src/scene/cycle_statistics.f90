!> Results of each revolution of the crank, and statistics over all revolutions.
module cycle_statistics
  use kinds, only: dp
  use joint_places, only: n_spots
  use film_heat, only: n_sums
  use cylinder_charge, only: n_charge_sums
  implicit none
  private
  public :: cycle_t, cycle_statistics_t, skirt, most_parts

  integer, parameter :: skirt = n_spots + 1   !! the last place of contacts, after the pins: the skirt of a piston in its bore

  integer, parameter :: most_parts = 5 + 4*n_spots   !! largest number of parts of the work

  !> Results of one revolution at one place. Those of contact and film are 0 at a pin without clearance; an ideal crank pin has no
  !> results. Those of the skirt are over all corners, without film and integral. Peaks are searched also between the accepted
  !> points of the integration.
  type :: pin_cycle_t
    real(dp) :: min_film_thickness = huge(1.0_dp)     !! c - |e| [m]
    real(dp) :: max_penetration = 0                   !! [m]
    real(dp) :: contact_time = 0                      !! [s]
    integer :: impacts = 0                            !! number of contacts that began
    real(dp) :: max_force = 0                         !! [N]
    real(dp) :: force_integral = 0                    !! integral of the magnitude of the force over time [N s]
    real(dp) :: turning = 0                           !! angle that the pin turns through in its bearing, in either sense [rad]
    real(dp) :: heat(n_sums) = 0                      !! integrals of the heat of its film, see `film_heat`
  end type pin_cycle_t

  !> Results of one revolution.
  type :: cycle_t
    real(dp) :: duration = 0                          !! [s]
    real(dp) :: dissipated_energy = 0                 !! energy taken from the bodies by the joints [J]
    type(pin_cycle_t) :: pin(skirt) = pin_cycle_t()
    ! for the answers of a cycle
    real(dp) :: start = 0                             !! [s]
    real(dp) :: work(most_parts) = 0                  !! of the parts of the work on the bodies [J]
    real(dp) :: energy_change = 0                     !! of kinetic, potential and elastic energy [J]
    real(dp) :: max_pressure = -huge(1.0_dp)          !! of the gas in the cylinder [Pa]
    real(dp) :: max_pressure_angle = 0                !! crank angle then [rad]
    real(dp) :: pin_turn = 0                          !! of a floating pin [rad]
    real(dp) :: gas(n_charge_sums) = 0                !! changes of the integrals of the gas, see `totals` of `charge_t`
    real(dp) :: valve_speed(2) = 0                    !! largest at which a reed of a valve met its seat or stop [m/s]
    real(dp) :: opening_temperature = 0               !! of the gas when the cylinder last opened; 0: not yet [K]
  end type cycle_t

  !> Sums and extremes over the revolutions.
  type :: cycle_statistics_t
    integer :: cycles = 0
    type(cycle_t) :: total = cycle_t()   !! sums of times, counts and energies; extremes of the other quantities
    !> Sums of extremes, for means over the revolutions: the smallest film thickness [m] and the largest force [N] at each place.
    real(dp) :: film_sum(skirt) = 0, force_sum(skirt) = 0
  contains
    procedure :: add
  end type cycle_statistics_t

contains

  !> Add the results of one revolution.
  pure subroutine add(self, cycle)
    class(cycle_statistics_t), intent(inout) :: self
    type(cycle_t), intent(in) :: cycle
    integer :: i
    self%cycles = self%cycles + 1
    self%total%duration = self%total%duration + cycle%duration
    self%total%dissipated_energy = self%total%dissipated_energy + cycle%dissipated_energy
    associate (total => self%total, one => cycle)
      if (self%cycles == 1) total%start = one%start
      total%work = total%work + one%work
      total%energy_change = total%energy_change + one%energy_change
      if (one%max_pressure > total%max_pressure) total%max_pressure_angle = one%max_pressure_angle
      total%max_pressure = max(total%max_pressure, one%max_pressure)
      total%pin_turn = total%pin_turn + one%pin_turn
      total%gas = total%gas + one%gas
      total%valve_speed = max(total%valve_speed, one%valve_speed)
      total%opening_temperature = one%opening_temperature
    end associate
    associate (total => self%total%pin, one => cycle%pin)
      total%turning = total%turning + one%turning
      total%min_film_thickness = min(total%min_film_thickness, one%min_film_thickness)
      total%max_penetration = max(total%max_penetration, one%max_penetration)
      total%contact_time = total%contact_time + one%contact_time
      total%impacts = total%impacts + one%impacts
      total%max_force = max(total%max_force, one%max_force)
      total%force_integral = total%force_integral + one%force_integral
    end associate
    do i = 1, skirt
      self%total%pin(i)%heat = self%total%pin(i)%heat + cycle%pin(i)%heat
    end do
    where (cycle%pin%min_film_thickness < huge(1.0_dp)) self%film_sum = self%film_sum + cycle%pin%min_film_thickness
    self%force_sum = self%force_sum + cycle%pin%max_force
  end subroutine add
end module cycle_statistics
