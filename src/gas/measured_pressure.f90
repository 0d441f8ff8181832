!> Parameters of a cylinder whose pressure has been measured as a function of the crank angle, or is set from outside during a
!> run.
module measured_pressure
  use kinds, only: dp
  use constants, only: degree
  use error_handling, only: error_t
  use text_tools, only: integer_text
  use model_parameters, only: parameter_list_t
  use measured_curve, only: measured_curve_t
  use monotone_cubic, only: new_periodic_cubic
  use ideal_linkage, only: linkage_t
  use cylinder, only: new_cylinder
  use gas_law, only: gas_law_t
  use working_gas, only: working_gas_t
  implicit none
  private
  public :: measured_pressure_t, measured_pressure_periods

  integer, parameter :: measured_pressure_periods(2) = [360, 720]   !! allowed periods [degrees]

  type, extends(gas_law_t) :: measured_pressure_t
    character(len=:), allocatable :: kind    !! 'table' or 'external'
    real(dp) :: pressure = 0                 !! of kind external at the start [Pa]
    type(measured_curve_t) :: curve          !! crank angle [degrees], pressure [Pa], within one period
    integer :: period_deg = 720
    real(dp) :: offset_deg = 0               !! crank angle for angle 0 of the table [degrees]
    real(dp) :: pressure_offset = 0          !! added to the pressures of the table [Pa]
    real(dp) :: compression_ratio = 0        !! ratio of largest to smallest volume; 0: unknown
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: revolutions
    procedure :: is_external
    procedure :: description
  end type measured_pressure_t

contains

  subroutine parameters(self, list)
    class(measured_pressure_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, 'table, external', 'table', &
      'external: the pressure is an input, which a program that embeds this one sets during the run')
    call list%add('pressure', self%pressure, 'pressure (absolute) at the start, for kind = ''external'' alone', 'Pa', &
      '> 0 and <= 1e10', default='101325.0', usual='1e4 to 3e7')
    call self%curve%parameters(list, 'table', &
      'CSV file with columns crank_angle[deg],pressure[bar] (absolute), path relative to the case file', '', &
      example='pressure.csv')
    call list%add('period_deg', self%period_deg, &
      'period of the table: 720 (four-stroke) or 360 degrees', '>= 360 and <= 720', '720')
    call list%add('offset_deg', self%offset_deg, &
      'crank angle from the dead centre at angle 0 of the table; also corrects the dead centre of an encoder: 1 degree is '// &
      'some 10 % of the mean effective pressure', 'degrees', '>= -1080 and <= 1080', '0.0', usual='0 to 1080')
    call list%add('pressure_offset', self%pressure_offset, &
      'added to the pressures of the table (pegging), which must then be > 0', 'Pa', '>= -1e7 and <= 1e7', '0.0', &
      usual='1e2 to 5e5')
    call self%add_bore(list)
    call list%add('compression_ratio', self%compression_ratio, &
      'largest over smallest volume, for the column cylinder_volume only; 0: it shows the swept volume', &
      range='> 1 and <= 1000', default='0.0', usual='2 to 30')
    call self%add_crankcase_pressure(list)
  end subroutine parameters

  subroutine prepare(self, linkage, sense, tolerance, gas, error)
    class(measured_pressure_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense, tolerance
    type(working_gas_t), intent(out) :: gas
    type(error_t), allocatable, intent(out) :: error
    gas%cylinder = new_cylinder(self%bore, linkage, 2.0_dp)
    gas%sense = sense
    gas%cylinder%dead_volume = 0
    if (self%compression_ratio > 1) gas%cylinder%dead_volume = gas%cylinder%displacement/(self%compression_ratio - 1)
    gas%crankcase_pressure = self%crankcase_pressure
    gas%held_pressure = self%pressure
    if (self%is_external()) return
    gas%revolutions = self%revolutions()
    allocate (gas%curve, source=new_periodic_cubic((self%curve%x + self%offset_deg)*degree, self%curve%y + self%pressure_offset, &
      self%period_deg*degree))
  end subroutine prepare

  pure integer function revolutions(self)
    class(measured_pressure_t), intent(in) :: self
    revolutions = self%period_deg/360
    if (self%is_external()) revolutions = 1
  end function revolutions

  !> Whether the pressure is an input.
  pure logical function is_external(self)
    class(measured_pressure_t), intent(in) :: self
    is_external = .false.
    if (allocated(self%kind)) is_external = self%kind == 'external'
  end function is_external

  function description(self) result(text)
    class(measured_pressure_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = 'pressure set from outside'
    if (.not. self%is_external()) text = 'measured pressure, repeated every '//integer_text(self%period_deg)//' degrees'
  end function description
end module measured_pressure
