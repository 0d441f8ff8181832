!> Guesses in which unit a value was probably meant that is not of a usual size in the unit of its key.
module unit_hints
  use kinds, only: dp
  use constants, only: degree, pi
  implicit none
  private
  public :: likely_unit

  !> A value x of this unit is factor x + offset in the unit of the key.
  type :: unit_t
    character(len=12) :: of = ''      !! unit of the key; empty: none
    character(len=28) :: name = ''
    real(dp) :: factor = 1, offset = 0
  end type unit_t

  real(dp), parameter :: oil = 870   !! density [kg/m^3]

  !> Units that people use, more likely ones first.
  type(unit_t), parameter :: units(*) = [ &
    unit_t('m', 'millimetres', 1e-3_dp), unit_t('m', 'micrometres', 1e-6_dp), unit_t('m', 'centimetres', 1e-2_dp), &
    unit_t('m', 'inches', 0.0254_dp), unit_t('m^2', 'mm^2', 1e-6_dp), unit_t('m^2', 'cm^2', 1e-4_dp), &
    unit_t('m^4', 'mm^4', 1e-12_dp), unit_t('m^4', 'cm^4', 1e-8_dp), &
    unit_t('kg', 'grams', 1e-3_dp), unit_t('kg', 'tonnes', 1e3_dp), &
    unit_t('kg m^2', 'kg mm^2', 1e-6_dp), unit_t('kg m^2', 'kg cm^2', 1e-4_dp), unit_t('kg m^2', 'g mm^2', 1e-9_dp), &
    unit_t('kg m^2', 'g cm^2', 1e-7_dp), unit_t('kg/m^3', 'g/cm^3', 1e3_dp), &
    unit_t('rad/s', 'revolutions/min', pi/30), unit_t('rad/s', 'revolutions/s', 2*pi), unit_t('m/s', 'mm/s', 1e-3_dp), &
    unit_t('m/s^2', 'mm/s^2', 1e-3_dp), &
    unit_t('s', 'milliseconds', 1e-3_dp), unit_t('s', 'microseconds', 1e-6_dp), &
    unit_t('Pa', 'bar', 1e5_dp), unit_t('Pa', 'bar gauge', 1e5_dp, 101325.0_dp), unit_t('Pa', 'kPa', 1e3_dp), &
    unit_t('Pa', 'MPa', 1e6_dp), unit_t('Pa', 'gauge pressure', 1.0_dp, 101325.0_dp), &
    unit_t('modulus', 'GPa', 1e9_dp), unit_t('modulus', 'MPa', 1e6_dp), unit_t('modulus', 'kPa', 1e3_dp), &
    unit_t('Pa/m', 'GPa/mm', 1e12_dp), unit_t('Pa/m', 'MPa/mm', 1e9_dp), unit_t('1/Pa', '1/GPa', 1e-9_dp), &
    unit_t('Pa s', 'mPa s (cP)', 1e-3_dp), unit_t('Pa s', 'kinematic viscosity', oil), &
    unit_t('m^2/s', 'mm^2/s (cSt)', 1e-6_dp), unit_t('m^2/s', 'dynamic viscosity', 1/oil), &
    unit_t('K', 'degrees Celsius', 1.0_dp, 273.15_dp), unit_t('J', 'kJ', 1e3_dp), &
    unit_t('rad', 'degrees', degree), unit_t('degrees', 'radians', 1/degree), &
    unit_t('degrees', 'from the dead centre at 360', 1.0_dp, 360.0_dp), &
    unit_t('N m', 'N mm', 1e-3_dp), unit_t('N m', 'kN m', 1e3_dp), unit_t('N m/rad', 'kN m/rad', 1e3_dp), &
    unit_t('N m s/rad', 'N mm s/rad', 1e-3_dp), unit_t('N/m^exponent', 'N/mm', 1e3_dp), &
    unit_t('m^2/N', 'mm^3/(N m)', 1e-9_dp), unit_t('1/m', '1/mm', 1e3_dp), unit_t('', 'per cent', 1e-2_dp)]

contains

  !> `: millimetres?` if a value that is not from `least` to `most` is in this unit; empty if no unit makes it so.
  pure function likely_unit(unit, value, least, most) result(text)
    character(len=*), intent(in) :: unit             !! of the key
    real(dp), intent(in) :: value, least, most       !! the limits are those of the size
    character(len=:), allocatable :: text
    real(dp), parameter :: largest_pressure = 1e7_dp   !! usual moduli are larger
    character(len=len(units%of)) :: of
    real(dp) :: meant
    integer :: i
    of = unit
    if (unit == 'Pa' .and. least > largest_pressure) of = 'modulus'
    text = ''
    if (unit == '' .and. (abs(value) < 2 .or. least >= 1)) return   ! not meant in per cent
    do i = 1, size(units)
      if (units(i)%of /= of) cycle
      meant = abs(value)*units(i)%factor + units(i)%offset
      if (meant < least .or. meant > most) cycle
      text = ': '//trim(units(i)%name)//'?'
      return
    end do
  end function likely_unit
end module unit_hints
