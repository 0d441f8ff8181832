!> Parameters of an engine with Wiebe's heat release, for all cycles.
module wiebe_law
  use kinds, only: dp
  use constants, only: degree, two_pi
  use ideal_linkage, only: linkage_t
  use error_handling, only: error_t
  use number_text, only: short_text, quantity_text
  use model_parameters, only: parameter_list_t
  use cylinder, only: new_cylinder
  use gas_cycle, only: gas_cycle_t, heat_release_t, new_gas_cycle, released_share
  use gas_law, only: gas_law_t, turning_forwards
  use wall_law, only: chamber_t
  use cylinder_charge, only: charge_t
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
    procedure :: fill
    procedure :: heat_of_cycle
    procedure :: burns_abruptly
    procedure :: description
    procedure :: misfit => wiebe_misfit
    procedure, non_overridable :: wiebe_misfit
    procedure(timing), deferred :: timing
  end type wiebe_law_t

  abstract interface
    !> Angles at which the cylinder closes and opens, before and after the firing dead centre at 2 pi [rad].
    pure subroutine timing(self, linkage, closes, opens)
      import :: wiebe_law_t, linkage_t, dp
      class(wiebe_law_t), intent(in) :: self
      type(linkage_t), intent(in) :: linkage   !! of an engine that turns forwards
      real(dp), intent(out) :: closes, opens
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
    call list%add('heat', self%heat, 'heat of the fuel of each cycle, of which 1 - exp(-wiebe_efficiency) is released: '// &
      '99.3 % with 5, 86.5 % with 2', 'J', '>= 0 and <= 1e12', example='165.0', usual='0.1 to 1e7')
    call list%add('wiebe_efficiency', self%efficiency, &
      'parameter a of the Wiebe function: 1 - exp(-a) of the heat is released', range='> 0 and <= 1000', &
      example='5.0', usual='2 to 15')
    call list%add('wiebe_form', self%form, &
      'exponent n of the Wiebe function 1 - exp(-a z^n); most books write it as m + 1', range='>= 0.05 and <= 100', example='3.0', &
      usual='0.3 to 10')
    call list%add('start_deg', self%start_deg, 'crank angle from the dead centre at which combustion starts; firing is at 360', &
      'degrees', '>= 180 and < 540', example='340.0', usual='270 to 400')
    call list%add('duration_deg', self%duration_deg, 'duration of combustion; it must end before the cylinder opens', 'degrees', &
      '> 0 and <= 360', example='40.0', usual='10 to 150')
    call list%add('intake_pressure', self%intake_pressure, 'pressure in the open cylinder', 'Pa', '> 0', default='101325.0', &
      usual='2e4 to 1e6')
    call self%add_crankcase_pressure(list)
  end subroutine wiebe_parameters

  !> Integrate the cycle with these parameters; see `new_gas_cycle`.
  subroutine prepare(self, linkage, sense, tolerance, gas, error)
    class(wiebe_law_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense, tolerance
    type(working_gas_t), intent(out) :: gas
    type(error_t), allocatable, intent(out) :: error
    type(gas_cycle_t) :: cycle
    cycle%cylinder = new_cylinder(self%bore, turning_forwards(linkage, sense), self%compression_ratio)
    cycle%release = heat_release_t(self%heat, self%efficiency, self%form, self%start_deg*degree, self%duration_deg*degree)
    cycle%heat_capacity_ratio = self%heat_capacity_ratio
    cycle%intake_pressure = self%intake_pressure
    cycle%period = two_pi*self%revolutions()
    call self%timing(turning_forwards(linkage, sense), cycle%closes, cycle%opens)
    call new_gas_cycle(cycle, tolerance, error)
    allocate (gas%cycle, source=cycle)
    gas%cylinder = new_cylinder(self%bore, linkage, self%compression_ratio)
    gas%sense = sense
    gas%revolutions = self%revolutions()
    gas%crankcase_pressure = self%crankcase_pressure
  end subroutine prepare

  !> The gas as it was when the cylinder closed.
  subroutine fill(self, linkage, sense, gas, charge)
    class(wiebe_law_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense
    type(working_gas_t), intent(inout) :: gas
    type(charge_t), intent(inout) :: charge
    associate (cycle => gas%cycle)
      call charge%prepare(cycle%cylinder, chamber_t(bore=self%bore, stroke=linkage%stroke(), &
        heat_capacity_ratio=self%heat_capacity_ratio, closing_pressure=self%intake_pressure, &
        closing_volume=cycle%cylinder%volume(cycle%closes)), self%crankcase_pressure)
    end associate
  end subroutine fill

  !> Combustion must lie where the cylinder is closed.
  subroutine wiebe_misfit(self, linkage, sense, key, wanted)
    class(wiebe_law_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense
    character(len=:), allocatable, intent(out) :: key, wanted
    real(dp), parameter :: rounding = 1e-9_dp   ! [degrees]
    real(dp) :: closes, opens
    call self%timing(turning_forwards(linkage, sense), closes, opens)
    closes = closes/degree
    opens = opens/degree
    key = ''
    wanted = ''
    if (self%start_deg < closes - rounding) then
      key = 'start_deg'
      wanted = 'must be >= '//short_text(closes)//', where the cylinder closes'
    else if (self%start_deg + self%duration_deg > opens + rounding) then
      key = 'duration_deg'
      wanted = 'must be <= '//short_text(opens - self%start_deg)//': the cylinder opens at '//short_text(opens)
    end if
  end subroutine wiebe_misfit

  pure real(dp) function heat_of_cycle(self)
    class(wiebe_law_t), intent(in) :: self
    heat_of_cycle = self%heat
  end function heat_of_cycle

  pure logical function burns_abruptly(self)
    class(wiebe_law_t), intent(in) :: self
    burns_abruptly = self%form < 1
  end function burns_abruptly

  function description(self) result(text)
    class(wiebe_law_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = trim(self%name)//', compression ratio '//short_text(self%compression_ratio, 3)//', '// &
      quantity_text(self%heat, 'J')//' a cycle ('//quantity_text(self%heat*released_share(self%efficiency), 'J')// &
      ' released) from '//short_text(self%start_deg)//' to '//short_text(self%start_deg + self%duration_deg)//' degrees'
  end function description
end module wiebe_law
