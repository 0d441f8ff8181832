!> The results of a run that are single numbers, most of them for its summary.
module run_figures
  use kinds, only: dp
  use run_state, only: run_state_t
  use joint_places, only: n_spots
  use piston_guide, only: n_corners
  use film_heat, only: heat_totals_t
  implicit none
  private
  public :: run_figures_t, pin_figures_t, elastic_figures_t, floating_figures_t

  !> Results at one pin, or at one corner of the skirt of a piston with clearance in its bore. A pin without clearance has only a
  !> force, an ideal crank pin has no results; a corner has contacts, their time, and the largest penetration and normal force.
  type :: pin_figures_t
    integer :: contacts = 0                   !! number of contacts that began
    integer :: impacts_beyond_validity = 0    !! number of impacts faster than the contact law is valid for
    integer :: contacts_beyond_validity = 0   !! number of contacts deeper than the contact geometry is valid for
    real(dp) :: contact_time = 0              !! [s]
    real(dp) :: longest_contact = 0           !! longest time for which one contact has lasted [s]
    real(dp) :: max_penetration = 0           !! [m]
    real(dp) :: max_entry_penetration = 0     !! penetration at the first accepted point of a contact [m]
    real(dp) :: max_force = 0                 !! magnitude of the force of the joint on the pin [N]
    real(dp) :: min_film_thickness = huge(1.0_dp)  !! c - |e| [m]
    real(dp) :: film_change = 0               !! of the smallest film thickness from cycle to cycle at the end [-]
    real(dp) :: max_film_pressure = 0         !! [Pa]
    real(dp) :: friction_work = huge(1.0_dp)  !! work of the friction forces on the bodies so far [J]; huge: not integrated
    type(heat_totals_t) :: heat               !! of its film
    real(dp) :: turning = 0                   !! angle that a floating pin has turned through in this bearing, in either sense [rad]
  contains
    procedure :: declare => declare_pin
  end type pin_figures_t

  !> Results of the turn of a floating pin.
  type :: floating_figures_t
    logical :: is_present = .false.
    real(dp) :: turn = 0                      !! angle since the start [rad]
    integer :: revolutions = 0                !! whole revolutions of the crank in this run
    real(dp) :: drift = 0                     !! mean turn in one of these [rad]
    real(dp) :: swing = 0                     !! largest less smallest angle in the last cycle [rad]
  end type floating_figures_t

  !> Natural frequencies of the elastic members.
  type :: elastic_figures_t
    real(dp) :: bending_frequency = 0         !! of the rod between two fixed pins [rad/s]
    real(dp) :: axial_frequency = 0           !! of the axial vibration of the rod with the piston [rad/s]
    real(dp) :: twist_frequency = 0           !! of the crankshaft, with the mean inertia of a turn [rad/s]
  end type elastic_figures_t

  type :: run_figures_t
    type(pin_figures_t) :: pin(n_spots)         !! by spot, see `joint_places`
    type(pin_figures_t) :: corner(n_corners)
    type(elastic_figures_t) :: elastic
    type(floating_figures_t) :: floating
    integer :: evaluations = 0                !! number of evaluations of the scene for rows, events and these results
    integer :: peak_evaluations = 0           !! number of those evaluations that search peaks between accepted points
    real(dp) :: max_energy = 0                !! largest |kinetic + potential energy| [J]
    real(dp) :: max_energy_residual = 0       !! largest |energy residual| at the ends of steps [J]
    real(dp) :: row_energy_residual = 0       !! the same in the rows of the trace, also inside the steps [J]
    real(dp) :: gas_residual = -1             !! error of the energy of the gas, relative; negative: not known [-]
    real(dp) :: crank_travel = 0              !! crank angle turned through, signed [rad]
    real(dp) :: time = 0                      !! time simulated [s]
    real(dp) :: driven_speeds(2) = [huge(1.0_dp), -huge(1.0_dp)]   !! least and largest speed of the driven part, of a drive that
                                                                   !! varies [rad/s]
  contains
    procedure :: declare
    procedure :: heat_residual
  end type run_figures_t

contains

  !> Declare the totals that do not belong to a pin, a corner or an elastic member.
  subroutine declare(self, list)
    class(run_figures_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    call list%add('crank_travel', self%crank_travel, 'rad', 'crank angle turned through')
    call list%add('max_energy', self%max_energy, 'J', 'largest energy of the bodies')
    call list%add('max_energy_residual', self%max_energy_residual, 'J', 'largest energy residual at the ends of steps')
    call list%add('row_energy_residual', self%row_energy_residual, 'J', 'largest energy residual of a row')
  end subroutine declare

  !> Largest residual of the heat of a film, over the heat that it turned over [-].
  pure real(dp) function heat_residual(self)
    class(run_figures_t), intent(in) :: self
    heat_residual = maxval(self%pin%heat%relative_residual())
  end function heat_residual

  !> Declare the totals of the contacts of a pin or corner, with a prefix.
  subroutine declare_pin(self, pre, list)
    class(pin_figures_t), intent(inout) :: self
    character(len=*), intent(in) :: pre
    type(run_state_t), intent(inout) :: list
    call list%add(pre//'contacts', self%contacts, 'contacts that began')
    call list%add(pre//'impacts_beyond_validity', self%impacts_beyond_validity, 'impacts too fast for the contact law')
    call list%add(pre//'contacts_beyond_validity', self%contacts_beyond_validity, 'contacts too deep for the contact geometry')
    call list%add(pre//'contact_time', self%contact_time, 's', 'time in contact')
    call list%add(pre//'max_entry_penetration', self%max_entry_penetration, 'm', 'largest penetration at a beginning of contact')
  end subroutine declare_pin
end module run_figures
