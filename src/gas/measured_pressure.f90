!> Parameters of a cylinder whose pressure has been measured as a function of the crank angle.
module measured_pressure
  use kinds, only: dp
  use constants, only: degree
  use error_handling, only: error_t
  use text_tools, only: integer_text
  use model_parameters, only: parameter_list_t
  use measured_curve, only: measured_curve_t
  use monotone_cubic, only: new_periodic_cubic
  use cylinder, only: new_cylinder
  use gas_law, only: gas_law_t
  use working_gas, only: working_gas_t
  implicit none
  private
  public :: measured_pressure_t, measured_pressure_periods

  integer, parameter :: measured_pressure_periods(2) = [360, 720]   !! allowed periods [degrees]

  type, extends(gas_law_t) :: measured_pressure_t
    type(measured_curve_t) :: curve          !! crank angle [degrees], pressure [Pa], within one period
    integer :: period_deg = 720
    real(dp) :: offset_deg = 0               !! crank angle for angle 0 of the table [degrees]
    real(dp) :: compression_ratio = 0        !! ratio of largest to smallest volume; 0: unknown
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: revolutions
    procedure :: description
  end type measured_pressure_t

contains

  subroutine parameters(self, list)
    class(measured_pressure_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%curve%parameters(list, 'table', &
      'CSV file with columns crank_angle[deg],pressure[bar] (absolute), path relative to the case file', &
      example='pressure.csv')
    call list%add('period_deg', self%period_deg, &
      'period of the table: 720 (four-stroke) or 360 degrees', '>= 360 and <= 720', '720')
    call list%add('offset_deg', self%offset_deg, &
      'crank angle of the simulation at angle 0 of the table', 'degrees', '>= -1080 and <= 1080', '0.0', usual='0 to 1080')
    call self%add_bore(list)
    call list%add('compression_ratio', self%compression_ratio, &
      'largest over smallest volume, for the column cylinder_volume only; 0: it shows the swept volume', &
      range='> 1 and <= 1000', default='0.0', usual='2 to 30')
    call self%add_crankcase_pressure(list)
  end subroutine parameters

  subroutine prepare(self, crank_length, rod_length, tolerance, gas, error)
    class(measured_pressure_t), intent(in) :: self
    real(dp), intent(in) :: crank_length, rod_length   !! [m]
    real(dp), intent(in) :: tolerance
    type(working_gas_t), intent(out) :: gas
    type(error_t), allocatable, intent(out) :: error
    associate (unused => tolerance, never => allocated(error))
    end associate
    gas%cylinder = new_cylinder(self%bore, crank_length, rod_length, 2.0_dp)
    gas%cylinder%dead_volume = 0
    if (self%compression_ratio > 1) gas%cylinder%dead_volume = gas%cylinder%displacement/(self%compression_ratio - 1)
    gas%crankcase_pressure = self%crankcase_pressure
    gas%revolutions = self%revolutions()
    allocate (gas%curve, source=new_periodic_cubic((self%curve%x + self%offset_deg)*degree, self%curve%y, self%period_deg*degree))
  end subroutine prepare

  pure integer function revolutions(self)
    class(measured_pressure_t), intent(in) :: self
    revolutions = self%period_deg/360
  end function revolutions

  function description(self) result(text)
    class(measured_pressure_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = 'measured pressure, repeated every '//integer_text(self%period_deg)//' degrees'
  end function description
end module measured_pressure
