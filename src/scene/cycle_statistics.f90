!> What a run does in each revolution of its crank, and over all of them.
module cycle_statistics
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: cycle_t, cycle_statistics_t

  !> One revolution. What belongs to a joint with clearance is 0 without one. Peaks are searched between the accepted points of
  !> the integration too.
  type :: cycle_t
    real(dp) :: duration = 0                          !! [s]
    real(dp) :: min_film_thickness = huge(1.0_dp)     !! c - |e| [m]
    real(dp) :: max_penetration = 0                   !! [m]
    real(dp) :: contact_time = 0                      !! [s]
    integer :: impacts = 0                            !! contacts begun
    real(dp) :: max_pin_force = 0                     !! [N]
    real(dp) :: pin_force_integral = 0                !! of the size of the force over time [N s]
    real(dp) :: dissipated_energy = 0                 !! taken from the bodies by the joint [J]
  end type cycle_t

  !> Sums and extremes over revolutions.
  type :: cycle_statistics_t
    integer :: cycles = 0
    type(cycle_t) :: total                            !! sums; of extremes the extreme
    real(dp), private :: film_sum = 0, force_sum = 0
  contains
    procedure :: add
    procedure :: min_film_thickness_mean
    procedure :: max_pin_force_mean
    procedure :: impacts_mean
    procedure :: dissipated_energy_mean
  end type cycle_statistics_t

contains

  !> Count one more revolution.
  pure subroutine add(self, cycle)
    class(cycle_statistics_t), intent(inout) :: self
    type(cycle_t), intent(in) :: cycle
    self%cycles = self%cycles + 1
    associate (total => self%total)
      total%duration = total%duration + cycle%duration
      total%min_film_thickness = min(total%min_film_thickness, cycle%min_film_thickness)
      total%max_penetration = max(total%max_penetration, cycle%max_penetration)
      total%contact_time = total%contact_time + cycle%contact_time
      total%impacts = total%impacts + cycle%impacts
      total%max_pin_force = max(total%max_pin_force, cycle%max_pin_force)
      total%pin_force_integral = total%pin_force_integral + cycle%pin_force_integral
      total%dissipated_energy = total%dissipated_energy + cycle%dissipated_energy
    end associate
    self%film_sum = self%film_sum + cycle%min_film_thickness
    self%force_sum = self%force_sum + cycle%max_pin_force
  end subroutine add

  !> Mean over the revolutions of the thinnest film of each [m]. Of these means all need a revolution to be there.
  pure real(dp) function min_film_thickness_mean(self)
    class(cycle_statistics_t), intent(in) :: self
    min_film_thickness_mean = self%film_sum/self%cycles
  end function min_film_thickness_mean

  !> Mean of the largest force of each [N].
  pure real(dp) function max_pin_force_mean(self)
    class(cycle_statistics_t), intent(in) :: self
    max_pin_force_mean = self%force_sum/self%cycles
  end function max_pin_force_mean

  !> Contacts begun in a revolution.
  pure real(dp) function impacts_mean(self)
    class(cycle_statistics_t), intent(in) :: self
    impacts_mean = real(self%total%impacts, dp)/self%cycles
  end function impacts_mean

  !> Energy lost in a revolution [J].
  pure real(dp) function dissipated_energy_mean(self)
    class(cycle_statistics_t), intent(in) :: self
    dissipated_energy_mean = self%total%dissipated_energy/self%cycles
  end function dissipated_energy_mean
end module cycle_statistics
