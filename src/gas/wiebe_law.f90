!> Parameters of an engine with Wiebe's heat release, for all cycles.
module wiebe_law
  use kinds, only: dp
  use constants, only: degree, two_pi
  use error_handling, only: error_t
  use number_text, only: short_text, quantity_text
  use model_parameters, only: parameter_list_t
  use cylinder, only: new_cylinder
  use gas_cycle, only: gas_cycle_t, heat_release_t, new_gas_cycle, released_share
  use gas_law, only: gas_law_t
  use working_gas, only: working_gas_t
  implicit none
  private
  public :: wiebe_law_t

  type, abstract, extends(gas_law_t) :: wiebe_law_t
    real(dp) :: compression_ratio = 0             !! ratio of largest to smallest volume [-]
    real(dp) :: heat_capacity_ratio = 1.4_dp      !! gamma [-]
    real(dp) :: heat = 0                          !! Q_in [J per cycle]
    real(dp) :: efficiency = 5, form = 3          !! a and n of the Wiebe function [-]
    real(dp) :: start_deg = 0, duration_deg = 0   !! combustion: start and duration [degrees]
    real(dp) :: intake_pressure = 101325          !! pressure while the cylinder is open [Pa]
  contains
    procedure :: parameters => wiebe_parameters
    procedure, non_overridable :: wiebe_parameters
    procedure :: prepare
    procedure :: revolutions
    procedure :: heat_of_cycle
    procedure :: description
    procedure(timing), deferred :: timing
  end type wiebe_law_t

  abstract interface
    !> Angles of the cycle [rad]: that after which it repeats, and that for which the cylinder is closed before the firing dead
    !> centre and again after it.
    pure subroutine timing(self, period, half_closed)
      import :: wiebe_law_t, dp
      class(wiebe_law_t), intent(in) :: self
      real(dp), intent(out) :: period, half_closed
    end subroutine timing
  end interface

contains

  subroutine wiebe_parameters(self, list)
    class(wiebe_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_bore(list)
    call list%add('compression_ratio', self%compression_ratio, 'largest over smallest volume', range='> 1 and <= 1000', &
      example='9.0', usual='2 to 30')
    call list%add('heat_capacity_ratio', self%heat_capacity_ratio, &
      'ratio of the heat capacities of the gas', range='> 1 and <= 10', example='1.4', usual='1.05 to 1.67')
    call list%add('heat', self%heat, 'heat of each cycle, of which 1 - exp(-wiebe_efficiency) is released', 'J', &
      '>= 0 and <= 1e12', example='165.0', usual='0.1 to 1e7')
    call list%add('wiebe_efficiency', self%efficiency, &
      'parameter a of the Wiebe function: 1 - exp(-a) of the heat is released', range='> 0 and <= 1000', &
      example='5.0', usual='2 to 15')
    call list%add('wiebe_form', self%form, &
      'exponent n of the Wiebe function 1 - exp(-a z^n); most books write it as m + 1', range='>= 0.05 and <= 100', example='3.0', &
      usual='0.3 to 10')
    call list%add('start_deg', self%start_deg, 'crank angle at which combustion starts; the firing dead centre is 360', 'degrees', &
      '>= 180 and < 540', example='340.0', usual='270 to 400')
    call list%add('duration_deg', self%duration_deg, 'duration of combustion; it must end before the cylinder opens', 'degrees', &
      '> 0 and <= 360', example='40.0', usual='10 to 150')
    call list%add('intake_pressure', self%intake_pressure, 'pressure in the open cylinder', 'Pa', '> 0', default='101325.0', &
      usual='2e4 to 1e6')
    call self%add_crankcase_pressure(list)
  end subroutine wiebe_parameters

  !> Integrate the cycle with these parameters; see `new_gas_cycle`.
  subroutine prepare(self, crank_length, rod_length, tolerance, gas, error)
    class(wiebe_law_t), intent(in) :: self
    real(dp), intent(in) :: crank_length, rod_length   !! [m]
    real(dp), intent(in) :: tolerance
    type(working_gas_t), intent(out) :: gas
    type(error_t), allocatable, intent(out) :: error
    type(gas_cycle_t) :: cycle
    real(dp) :: half_closed
    cycle%cylinder = new_cylinder(self%bore, crank_length, rod_length, self%compression_ratio)
    cycle%release = heat_release_t(self%heat, self%efficiency, self%form, self%start_deg*degree, self%duration_deg*degree)
    cycle%heat_capacity_ratio = self%heat_capacity_ratio
    cycle%intake_pressure = self%intake_pressure
    call self%timing(cycle%period, half_closed)
    cycle%closes = two_pi - half_closed
    cycle%opens = two_pi + half_closed
    call new_gas_cycle(cycle, tolerance, error)
    allocate (gas%cycle, source=cycle)
    gas%cylinder = cycle%cylinder
    gas%revolutions = self%revolutions()
    gas%crankcase_pressure = self%crankcase_pressure
  end subroutine prepare

  pure integer function revolutions(self)
    class(wiebe_law_t), intent(in) :: self
    real(dp) :: period, half_closed
    call self%timing(period, half_closed)
    revolutions = nint(period/two_pi)
  end function revolutions

  pure real(dp) function heat_of_cycle(self)
    class(wiebe_law_t), intent(in) :: self
    heat_of_cycle = self%heat
  end function heat_of_cycle

  function description(self) result(text)
    class(wiebe_law_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = trim(self%name)//', compression ratio '//short_text(self%compression_ratio, 3)//', '// &
      quantity_text(self%heat, 'J')//' a cycle ('//quantity_text(self%heat*released_share(self%efficiency), 'J')// &
      ' released) from '//short_text(self%start_deg)//' to '//short_text(self%start_deg + self%duration_deg)//' degrees'
  end function description
end module wiebe_law
