!> The figures of a run, most of them for its summary.
module run_figures
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  use chain_motion, only: n_pins
  use piston_guide, only: n_corners
  implicit none
  private
  public :: run_figures_t, pin_figures_t, corner_figures_t, elastic_figures_t

  !> Those of one pin. Without clearance there is no more than the force, and of an ideal crank pin not even that.
  type :: pin_figures_t
    integer :: contacts = 0                   !! contacts begun
    integer :: impacts_beyond_validity = 0    !! of them faster than the contact law is meant for
    integer :: contacts_beyond_validity = 0   !! and deeper than its geometry is meant for
    real(dp) :: contact_time = 0              !! [s]
    real(dp) :: max_penetration = 0           !! [m]
    real(dp) :: max_entry_penetration = 0     !! penetration at the beginning of a contact [m]
    real(dp) :: max_force = 0                 !! size of the joint's force on the pin [N]
    real(dp) :: min_film_thickness = huge(1.0_dp)  !! c - |e| [m]
    real(dp) :: film_energy_lost = 0          !! of the bodies, by a film whose figures are asked for [J]
    real(dp) :: film_volume = 0               !! that has left it at its ends [m^3]
    real(dp) :: max_film_pressure = 0         !! [Pa]
    real(dp) :: friction_work = huge(1.0_dp)  !! of friction on the bodies so far [J]; huge: it is not integrated
  contains
    procedure :: exchange => exchange_pin
  end type pin_figures_t

  !> Those of a corner of the skirt, where the piston has clearance in its bore.
  type :: corner_figures_t
    integer :: contacts = 0                   !! contacts begun
    real(dp) :: contact_time = 0              !! [s]
    real(dp) :: max_penetration = 0           !! [m]
    real(dp) :: max_force = 0                 !! normal to the wall [N]
  end type corner_figures_t

  !> Those of elastic members: largest values of steps and rows.
  type :: elastic_figures_t
    real(dp) :: mid_deflection = 0            !! of the rod, across its chord [m]
    real(dp) :: stretch = 0                   !! largest |change of its length| along its axis [m]
    real(dp) :: strain_energy = 0             !! of the rod [J]
    real(dp) :: twist = 0                     !! largest |twist| of the crankshaft [rad]
    real(dp) :: bending_frequency = 0         !! of the rod on two pins that do not move [rad/s]
    real(dp) :: axial_frequency = 0           !! of its stretch with the piston on it [rad/s]
    real(dp) :: twist_frequency = 0           !! of the crankshaft, at the starting angle [rad/s]
  contains
    procedure :: exchange => exchange_elastic
  end type elastic_figures_t

  type :: run_figures_t
    type(pin_figures_t) :: pin(n_pins)        !! crank_pin, piston_pin
    type(corner_figures_t) :: corner(n_corners)
    type(elastic_figures_t) :: elastic
    integer :: evaluations = 0                !! of the scene for rows, events and these figures
    integer :: peak_evaluations = 0           !! of them for peaks between accepted points
    real(dp) :: max_energy = 0                !! largest |kinetic + potential energy| [J]
    real(dp) :: max_energy_residual = 0       !! largest |energy residual| [J]
    real(dp) :: crank_travel = 0              !! crank angle turned through, signed [rad]
    real(dp) :: time = 0                      !! simulated [s]
  contains
    procedure :: exchange => exchange_figures
  end type run_figures_t

contains

  !> The figures to or from an archive.
  subroutine exchange_figures(self, archive)
    class(run_figures_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    integer :: pin, i
    do pin = 1, n_pins
      call self%pin(pin)%exchange(archive)
    end do
    do i = 1, n_corners
      call archive%exchange(self%corner(i)%contacts)
      call archive%exchange(self%corner(i)%contact_time)
      call archive%exchange(self%corner(i)%max_penetration)
      call archive%exchange(self%corner(i)%max_force)
    end do
    call self%elastic%exchange(archive)
    call archive%exchange(self%evaluations)
    call archive%exchange(self%peak_evaluations)
    call archive%exchange(self%max_energy)
    call archive%exchange(self%max_energy_residual)
    call archive%exchange(self%crank_travel)
    call archive%exchange(self%time)
  end subroutine exchange_figures

  !> Those of elastic members; not what a scene has from its beginning.
  subroutine exchange_elastic(self, archive)
    class(elastic_figures_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%mid_deflection)
    call archive%exchange(self%stretch)
    call archive%exchange(self%strain_energy)
    call archive%exchange(self%twist)
  end subroutine exchange_elastic

  !> Those of a pin.
  subroutine exchange_pin(self, archive)
    class(pin_figures_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%contacts)
    call archive%exchange(self%impacts_beyond_validity)
    call archive%exchange(self%contacts_beyond_validity)
    call archive%exchange(self%contact_time)
    call archive%exchange(self%max_penetration)
    call archive%exchange(self%max_entry_penetration)
    call archive%exchange(self%max_force)
    call archive%exchange(self%min_film_thickness)
    call archive%exchange(self%friction_work)
    call archive%exchange(self%film_energy_lost)
    call archive%exchange(self%film_volume)
    call archive%exchange(self%max_film_pressure)
  end subroutine exchange_pin
end module run_figures
