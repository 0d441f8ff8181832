!> The results of a run that are single numbers, most of them for its summary.
module run_figures
  use gudgeon_kinds, only: dp
  use joint_places, only: n_places
  use piston_guide, only: n_corners
  implicit none
  private
  public :: run_figures_t, pin_figures_t, elastic_figures_t

  !> Results at one pin, or at one corner of the skirt of a piston with clearance in its bore. A pin without clearance has only a
  !> force, an ideal crank pin has no results; a corner has contacts, their time, and the largest penetration and normal force.
  type :: pin_figures_t
    integer :: contacts = 0                   !! number of contacts that began
    integer :: impacts_beyond_validity = 0    !! number of impacts faster than the contact law is valid for
    integer :: contacts_beyond_validity = 0   !! number of contacts deeper than the contact geometry is valid for
    real(dp) :: contact_time = 0              !! [s]
    real(dp) :: max_penetration = 0           !! [m]
    real(dp) :: max_entry_penetration = 0     !! penetration at the first accepted point of a contact [m]
    real(dp) :: max_force = 0                 !! magnitude of the force of the joint on the pin [N]
    real(dp) :: min_film_thickness = huge(1.0_dp)  !! c - |e| [m]
    real(dp) :: film_energy_lost = 0  !! energy that the film takes from the bodies, if results of the film are requested [J]
    real(dp) :: neglected_shear_loss = 0  !! energy that shear which does not act would take [J]
    real(dp) :: film_volume = 0               !! volume of oil that has left the film at its ends [m^3]
    real(dp) :: max_film_pressure = 0         !! [Pa]
    real(dp) :: friction_work = huge(1.0_dp)  !! work of the friction forces on the bodies so far [J]; huge: not integrated
  contains
  end type pin_figures_t

  !> Results of the elastic members.
  type :: elastic_figures_t
    real(dp) :: mid_deflection = 0            !! deflection of the rod at mid-length, perpendicular to its chord [m]
    real(dp) :: stretch = 0                   !! largest magnitude of the change of the rod's length [m]
    real(dp) :: strain_energy = 0             !! of the rod [J]
    real(dp) :: twist = 0                     !! largest magnitude of the twist of the crankshaft [rad]
    real(dp) :: bending_frequency = 0         !! of the rod between two fixed pins [rad/s]
    real(dp) :: axial_frequency = 0           !! of the axial vibration of the rod with the piston [rad/s]
    real(dp) :: twist_frequency = 0           !! of the crankshaft at the starting angle [rad/s]
  end type elastic_figures_t

  type :: run_figures_t
    type(pin_figures_t) :: pin(n_places)        !! by place
    type(pin_figures_t) :: corner(n_corners)
    type(elastic_figures_t) :: elastic
    integer :: evaluations = 0                !! number of evaluations of the scene for rows, events and these results
    integer :: peak_evaluations = 0           !! number of those evaluations that search peaks between accepted points
    real(dp) :: max_energy = 0                !! largest |kinetic + potential energy| [J]
    real(dp) :: max_energy_residual = 0       !! largest |energy residual| at the ends of steps [J]
    real(dp) :: row_energy_residual = 0       !! the same in the rows of the trace, also inside the steps [J]
    real(dp) :: crank_travel = 0              !! crank angle turned through, signed [rad]
    real(dp) :: time = 0                      !! time simulated [s]
  end type run_figures_t
end module run_figures
