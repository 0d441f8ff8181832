!> Motion of the stations of a crankshaft with several cylinders, and of the rings of its dampers.
module train_motion
  use kinds, only: dp
  implicit none
  private
  public :: train_motion_t, most_stations, most_cylinders, most_rings

  integer, parameter :: most_stations = 16, most_cylinders = 16, most_rings = 4

  !> Position, motion and loads at one instant; not set in a chain without train. Cylinders are the others than that of the
  !> mechanism.
  type :: train_motion_t
    real(dp) :: twist(most_stations)        !! angle of each station minus the crank angle [rad]
    real(dp) :: speed(most_stations)        !! of each station [rad/s]
    real(dp) :: ring_twist(most_rings)      !! angle of a rubber ring minus that of its station [rad]
    real(dp) :: ring_speed(most_rings)      !! of each ring [rad/s]
    real(dp) :: angle(most_cylinders)       !! crank angle of each cylinder from its own axis [rad]
    real(dp) :: gas_force(most_cylinders)   !! on each piston, along its axis towards the shaft [N]
    ! the following components are set by `load_stations`
    real(dp) :: inertia(most_stations)      !! of each station, without the mechanism [kg m^2]
    real(dp) :: torque(most_stations)       !! on each station, without mechanism and drive [N m]
    real(dp) :: gas_power                   !! of the gas on the pistons [W]
    real(dp) :: damping_power               !! of segments, rings and stations [W]
  end type train_motion_t
end module train_motion
