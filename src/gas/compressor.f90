!> A piston compressor: suction and discharge at given pressures through self-acting valves, polytropic compression, and
!> re-expansion of the gas in the dead space.
module compressor
  use kinds, only: dp
  use number_text, only: short_text
  use error_handling, only: error_t
  use model_parameters, only: parameter_list_t
  use ideal_linkage, only: linkage_t
  use cylinder, only: cylinder_t, new_cylinder
  use gas_law, only: gas_law_t, turning_forwards
  use wall_law, only: chamber_t
  use cylinder_charge, only: charge_t
  use valve_gas, only: valve_gas_t
  use working_gas, only: working_gas_t
  implicit none
  private
  public :: compressor_t

  type, extends(gas_law_t) :: compressor_t
    real(dp) :: dead_space = 0             !! smallest volume over displacement [-]
    real(dp) :: suction_pressure = 101325  !! [Pa]
    real(dp) :: discharge_pressure = 0     !! [Pa]
    real(dp) :: polytropic_exponent = 0    !! n in p V^n = const [-]
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: prepare
    procedure :: fill
    procedure :: fastest_piston
    procedure :: filling_pressure
    procedure :: description
  end type compressor_t

contains

  subroutine parameters(self, list)
    class(compressor_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_bore(list)
    call list%add('dead_space', self%dead_space, 'clearance volume over displacement', range='>= 1e-4 and <= 100', example='0.05', &
      usual='5e-3 to 0.5')
    call list%add('suction_pressure', self%suction_pressure, &
      'pressure while the suction valve is open', 'Pa', '> 0', default='101325.0', usual='2e4 to 1e7')
    call list%add('discharge_pressure', self%discharge_pressure, 'pressure while the discharge valve is open', 'Pa', '> 0', &
      example='4.0e5', usual='5e4 to 1e8')
    call list%add('polytropic_exponent', self%polytropic_exponent, 'exponent n of p V^n = const. while both valves are '// &
      'closed; not with &valve, where it follows from the heat', range='>= 0 and <= 10', default='0.0', usual='1 to 1.67')
    call self%add_crankcase_pressure(list)
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(compressor_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'must be > suction_pressure = '//short_text(self%suction_pressure)
    if (self%discharge_pressure <= self%suction_pressure) key = 'discharge_pressure'
  end subroutine conflict

  subroutine prepare(self, linkage, sense, tolerance, gas, error)
    class(compressor_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense, tolerance
    type(working_gas_t), intent(out) :: gas
    type(error_t), allocatable, intent(out) :: error
    type(valve_gas_t) :: valves
    valves%cylinder = new_cylinder(self%bore, linkage, 1 + 1/self%dead_space)
    valves%suction_pressure = self%suction_pressure
    valves%discharge_pressure = self%discharge_pressure
    valves%exponent = self%polytropic_exponent
    allocate (gas%valves, source=valves)
    gas%cylinder = valves%cylinder
    gas%sense = sense
    gas%crankcase_pressure = self%crankcase_pressure
  end subroutine prepare

  !> Gas with a mass; valves with losses take the place of the ideal ones.
  subroutine fill(self, linkage, sense, gas, charge)
    class(compressor_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense
    type(working_gas_t), intent(inout) :: gas
    type(charge_t), intent(inout) :: charge
    type(cylinder_t) :: cylinder
    cylinder = new_cylinder(self%bore, turning_forwards(linkage, sense), 1 + 1/self%dead_space)
    call charge%prepare(cylinder, chamber_t(bore=self%bore, stroke=linkage%stroke(), closing_pressure=self%suction_pressure, &
      closing_volume=cylinder%dead_volume + cylinder%displacement), self%crankcase_pressure)
    call charge%set_discharge(self%discharge_pressure)
    if (allocated(charge%valves)) deallocate (gas%valves)
  end subroutine fill

  pure real(dp) function fastest_piston(self)
    class(compressor_t), intent(in) :: self
    fastest_piston = 12
  end function fastest_piston

  pure real(dp) function filling_pressure(self)
    class(compressor_t), intent(in) :: self
    filling_pressure = self%suction_pressure
  end function filling_pressure

  function description(self) result(text)
    class(compressor_t), intent(in) :: self
    character(len=:), allocatable :: text
    real(dp), parameter :: bar = 1e5_dp   !! [Pa]
    text = trim(self%name)//', '//short_text(self%suction_pressure/bar, 4)//' to '//short_text(self%discharge_pressure/bar, 4)// &
      ' bar, dead space '//short_text(100*self%dead_space, 3)//' %'
  end function description
end module compressor
