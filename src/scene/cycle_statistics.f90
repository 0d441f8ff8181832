!> What a run does in each revolution of its crank, and over all of them.
module cycle_statistics
  use gudgeon_kinds, only: dp
  use chain_motion, only: n_pins
  implicit none
  private
  public :: cycle_t, cycle_statistics_t

  !> One revolution at one pin. What belongs to a joint with clearance is 0 without one, and an ideal crank pin has nothing. Peaks
  !> are searched between the accepted points of the integration too.
  type :: pin_cycle_t
    real(dp) :: min_film_thickness = huge(1.0_dp)     !! c - |e| [m]
    real(dp) :: max_penetration = 0                   !! [m]
    real(dp) :: contact_time = 0                      !! [s]
    integer :: impacts = 0                            !! contacts begun
    real(dp) :: max_force = 0                         !! [N]
    real(dp) :: force_integral = 0                    !! of the size of the force over time [N s]
  end type pin_cycle_t

  !> One revolution of a piston with clearance in its bore: of the corners of its skirt together.
  type :: skirt_cycle_t
    real(dp) :: contact_time = 0                      !! while one of them or more touch [s]
    integer :: impacts = 0                            !! contacts begun
    real(dp) :: max_penetration = 0                   !! of a corner [m]
    real(dp) :: max_force = 0                         !! on a corner [N]
  end type skirt_cycle_t

  !> One revolution.
  type :: cycle_t
    real(dp) :: duration = 0                          !! [s]
    real(dp) :: dissipated_energy = 0                 !! taken from the bodies by the joints [J]
    type(pin_cycle_t) :: pin(n_pins)
    type(skirt_cycle_t) :: skirt
  end type cycle_t

  !> Sums and extremes over revolutions.
  type :: cycle_statistics_t
    integer :: cycles = 0
    type(cycle_t) :: total                            !! sums; of extremes the extreme
    real(dp), private :: film_sum(n_pins) = 0, force_sum(n_pins) = 0, skirt_force_sum = 0
  contains
    procedure :: add
    procedure :: min_film_thickness_mean
    procedure :: max_force_mean
    procedure :: skirt_force_mean
    procedure :: impacts_mean
    procedure :: dissipated_energy_mean
  end type cycle_statistics_t

contains

  !> Count one more revolution.
  pure subroutine add(self, cycle)
    class(cycle_statistics_t), intent(inout) :: self
    type(cycle_t), intent(in) :: cycle
    self%cycles = self%cycles + 1
    self%total%duration = self%total%duration + cycle%duration
    self%total%dissipated_energy = self%total%dissipated_energy + cycle%dissipated_energy
    associate (total => self%total%pin, one => cycle%pin)
      total%min_film_thickness = min(total%min_film_thickness, one%min_film_thickness)
      total%max_penetration = max(total%max_penetration, one%max_penetration)
      total%contact_time = total%contact_time + one%contact_time
      total%impacts = total%impacts + one%impacts
      total%max_force = max(total%max_force, one%max_force)
      total%force_integral = total%force_integral + one%force_integral
    end associate
    associate (total => self%total%skirt, one => cycle%skirt)
      total%contact_time = total%contact_time + one%contact_time
      total%impacts = total%impacts + one%impacts
      total%max_penetration = max(total%max_penetration, one%max_penetration)
      total%max_force = max(total%max_force, one%max_force)
    end associate
    self%skirt_force_sum = self%skirt_force_sum + cycle%skirt%max_force
    where (cycle%pin%min_film_thickness < huge(1.0_dp)) self%film_sum = self%film_sum + cycle%pin%min_film_thickness
    self%force_sum = self%force_sum + cycle%pin%max_force
  end subroutine add

  !> Mean over the revolutions of the thinnest film of each at a pin [m]. Of these means all need a revolution to be there.
  pure real(dp) function min_film_thickness_mean(self, pin)
    class(cycle_statistics_t), intent(in) :: self
    integer, intent(in) :: pin
    min_film_thickness_mean = self%film_sum(pin)/self%cycles
  end function min_film_thickness_mean

  !> Mean of the largest force of each on a pin [N].
  pure real(dp) function max_force_mean(self, pin)
    class(cycle_statistics_t), intent(in) :: self
    integer, intent(in) :: pin
    max_force_mean = self%force_sum(pin)/self%cycles
  end function max_force_mean

  !> Mean of the largest force of each on a corner of the skirt [N].
  pure real(dp) function skirt_force_mean(self)
    class(cycle_statistics_t), intent(in) :: self
    skirt_force_mean = self%skirt_force_sum/self%cycles
  end function skirt_force_mean

  !> Contacts begun in a revolution at a pin.
  pure real(dp) function impacts_mean(self, pin)
    class(cycle_statistics_t), intent(in) :: self
    integer, intent(in) :: pin
    impacts_mean = real(self%total%pin(pin)%impacts, dp)/self%cycles
  end function impacts_mean

  !> Energy lost in a revolution [J].
  pure real(dp) function dissipated_energy_mean(self)
    class(cycle_statistics_t), intent(in) :: self
    dissipated_energy_mean = self%total%dissipated_energy/self%cycles
  end function dissipated_energy_mean
end module cycle_statistics
