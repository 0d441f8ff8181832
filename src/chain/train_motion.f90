!> Motion of the stations of a crankshaft with several cylinders, and of the rings of its dampers.
module train_motion
  use kinds, only: dp
  implicit none
  private
  public :: train_motion_t, train_rows_t, most_stations, most_cylinders, most_rings

  integer, parameter :: most_stations = 16, most_cylinders = 16, most_rings = 4

  !> Position and motion at one instant; not set in a chain without train. Cylinders are the others than that of the mechanism.
  type :: train_motion_t
    real(dp) :: twist(most_stations)        !! angle of each station minus the crank angle [rad]
    real(dp) :: speed(most_stations)        !! of each station [rad/s]
    real(dp) :: ring_twist(most_rings)      !! angle of a rubber ring minus that of its station [rad]
    real(dp) :: ring_speed(most_rings)      !! of each ring [rad/s]
    real(dp) :: angle(most_cylinders)       !! crank angle of each cylinder from its own axis [rad]
    real(dp) :: sine(most_cylinders), cosine(most_cylinders)   !! of that
    real(dp) :: sin_rod(most_cylinders), cos_rod(most_cylinders)   !! of the angle of each rod from that axis
    real(dp) :: per_arm(most_cylinders)     !! 1/(rod length . cos_rod) [1/m]
    real(dp) :: gas_force(most_cylinders)   !! on each piston, along its axis towards the shaft [N]
  end type train_motion_t
  !> Inertia [kg m^2] and torque [N m] of each station, without the mechanism and without the damping of the drive.
  type :: train_rows_t
    real(dp) :: inertia(most_stations)
    real(dp) :: torque(most_stations)
  end type train_rows_t
end module train_motion
