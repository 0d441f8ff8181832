!> Units of numbers in case files, settings, studies and the heads of tables: SI and what engineers write beside it.
module physical_units
  use kinds, only: dp
  use constants, only: pi
  use text_tools, only: lowercase, nearest_word, replaced, integer_text, whole_number
  implicit none
  private
  public :: unit_t, split_number, find_unit, find_head_unit, head_units, shifted, no_break_space

  !> A number x in this unit is 10**power factor (x + offset) in the unit of the key.
  type :: unit_t
    character(len=12) :: of = ''     !! unit of the keys that may have it, as they declare it
    character(len=8) :: name = ''
    integer :: power = 0
    real(dp) :: factor = 1, offset = 0
    logical :: of_heads = .false.    !! in the heads of tables alone
  end type unit_t

  !> What a unit of keys measures, with its article.
  type :: dimension_t
    character(len=12) :: unit
    character(len=24) :: says
  end type dimension_t

  real(dp), parameter :: turn = pi/30   !! [rad/s], one revolution in a minute

  type(unit_t), parameter :: units_of_bodies(*) = [ &
    unit_t('m', 'm'), unit_t('m', 'km', 3), unit_t('m', 'cm', -2), unit_t('m', 'mm', -3), unit_t('m', 'um', -6), &
    unit_t('m', 'nm', -9), unit_t('m', 'in', 0, 0.0254_dp), unit_t('m^2', 'm2'), unit_t('m^2', 'cm2', -4), &
    unit_t('m^2', 'mm2', -6), unit_t('m^4', 'm4'), unit_t('m^4', 'cm4', -8), unit_t('m^4', 'mm4', -12), &
    unit_t('kg', 'kg'), unit_t('kg', 'g', -3), unit_t('kg', 'mg', -6), unit_t('kg', 't', 3), &
    unit_t('kg', 'lb', 0, 0.45359237_dp), unit_t('kg m^2', 'kg.m2'), unit_t('kg m^2', 'kg.cm2', -4), &
    unit_t('kg m^2', 'kg.mm2', -6), unit_t('kg m^2', 'g.mm2', -9), unit_t('kg/m^3', 'kg/m3'), unit_t('kg/m^3', 'g/cm3', 3), &
    unit_t('kg/m^3', 'kg/l', 3), unit_t('s', 's'), unit_t('s', 'ms', -3), unit_t('s', 'us', -6), &
    unit_t('s', 'min', 0, 60.0_dp), unit_t('s', 'h', 0, 3600.0_dp), unit_t('m/s', 'm/s'), unit_t('m/s', 'mm/s', -3), &
    unit_t('m/s', 'um/s', -6), unit_t('m/s', 'm/h', 0, 1/3600.0_dp), unit_t('rad/s', 'rad/s'), unit_t('rad/s', 'rpm', 0, turn), &
    unit_t('rad/s', '1/min', 0, turn), unit_t('rad/s', 'deg/s', 0, pi/180), unit_t('rad/s', 'r/min', 0, turn, of_heads=.true.), &
    unit_t('rad/s', 'min^-1', 0, turn, of_heads=.true.), unit_t('rad/s', '1/s', 0, 2*pi, of_heads=.true.), &
    unit_t('degrees', 'deg'), unit_t('degrees', 'degrees', of_heads=.true.), unit_t('degrees', 'degCA', of_heads=.true.), &
    unit_t('degrees', 'rad', 0, 180/pi), unit_t('rad', 'rad'), unit_t('rad', 'deg', 0, pi/180)]

  type(unit_t), parameter :: units_of_forces(*) = [ &
    unit_t('N', 'N'), unit_t('N', 'kN', 3), unit_t('N', 'MN', 6), unit_t('N', 'mN', -3), &
    unit_t('N', 'lbf', 0, 4.4482216152605_dp), unit_t('Pa', 'Pa'), unit_t('Pa', 'hPa', 2), unit_t('Pa', 'kPa', 3), &
    unit_t('Pa', 'MPa', 6), unit_t('Pa', 'GPa', 9), unit_t('Pa', 'mbar', 2), unit_t('Pa', 'bar', 5), &
    unit_t('Pa', 'atm', 0, 101325.0_dp), unit_t('Pa', 'psi', 0, 6894.757293168361_dp), unit_t('1/Pa', '1/Pa'), &
    unit_t('1/Pa', '1/MPa', -6), unit_t('1/Pa', '1/GPa', -9), unit_t('N m', 'N.m'), unit_t('N m', 'mN.m', -3), &
    unit_t('N m', 'kN.m', 3), unit_t('J', 'J'), unit_t('J', 'mJ', -3), unit_t('J', 'kJ', 3), unit_t('J', 'MJ', 6), &
    unit_t('m^2/N', 'm2/N'), unit_t('m^2/N', 'mm3/N/m', -9)]

  type(unit_t), parameter :: units_of_oils(*) = [ &
    unit_t('Pa s', 'Pa.s'), unit_t('Pa s', 'mPa.s', -3), unit_t('Pa s', 'cP', -3), unit_t('Pa s', 'P', -1), &
    unit_t('m^2/s', 'm2/s'), unit_t('m^2/s', 'mm2/s', -6), unit_t('m^2/s', 'cSt', -6), unit_t('m^2/s', 'St', -4), &
    unit_t('K', 'K'), unit_t('K', 'degC', 0, offset=273.15_dp), unit_t('K', 'degF', 0, 5/9.0_dp, 459.67_dp), &
    unit_t('m^3/s', 'm3/s'), unit_t('m^3/s', 'l/min', -3, 1/60.0_dp), unit_t('m^3/s', 'ml/min', -6, 1/60.0_dp), &
    unit_t('m^3/s', 'mm3/s', -9), unit_t('W/K', 'W/K'), unit_t('W/K', 'mW/K', -3), unit_t('J/K', 'J/K'), &
    unit_t('J/K', 'kJ/K', 3), unit_t('J/(kg K)', 'J/kg/K'), unit_t('J/(kg K)', 'kJ/kg/K', 3), unit_t('W/(m K)', 'W/m/K'), &
    unit_t('W/(m K)', 'mW/m/K', -3), unit_t('W/(m^2 K)', 'W/m2/K'), unit_t('W/(m^2 K)', 'kW/m2/K', 3)]

  type(unit_t), parameter :: all_units(*) = [units_of_bodies, units_of_forces, units_of_oils]

  type(dimension_t), parameter :: dimensions(*) = [ &
    dimension_t('m', 'a length'), dimension_t('m^2', 'an area'), dimension_t('m^4', 'a second moment of area'), &
    dimension_t('kg', 'a mass'), dimension_t('kg m^2', 'a moment of inertia'), dimension_t('kg/m^3', 'a density'), &
    dimension_t('s', 'a time'), dimension_t('m/s', 'a speed'), dimension_t('rad/s', 'a turning speed'), &
    dimension_t('degrees', 'an angle'), dimension_t('rad', 'an angle'), dimension_t('N', 'a force'), &
    dimension_t('Pa', 'a pressure'), dimension_t('1/Pa', 'an inverse pressure'), dimension_t('N m', 'a moment'), &
    dimension_t('J', 'an energy'), dimension_t('m^2/N', 'a wear rate'), dimension_t('Pa s', 'a viscosity'), &
    dimension_t('m^2/s', 'a kinematic viscosity'), dimension_t('K', 'a temperature'), dimension_t('m^3/s', 'a flow'), &
    dimension_t('W/K', 'a conductance'), dimension_t('J/K', 'a heat capacity'), dimension_t('J/(kg K)', 'a specific heat'), &
    dimension_t('W/(m K)', 'a thermal conductivity'), dimension_t('W/(m^2 K)', 'a heat transfer')]

  character(len=*), parameter :: digits = '0123456789', letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
  character(len=*), parameter :: no_break_space = char(194)//char(160)   !! U+00A0
  character(len=*), parameter :: first_bytes = char(194)//char(206)   !! of the degree sign and of the micro signs

contains

  !> Split a number with a unit, glued or apart: the number is the longest beginning that is one. A text without a unit behind a
  !> number is returned whole.
  pure subroutine split_number(text, number, unit)
    character(len=*), intent(in) :: text
    character(len=:), allocatable, intent(out) :: number, unit   !! unit: empty if there is none
    integer :: at, exponent
    number = text
    unit = ''
    at = 1
    if (scan(text, '+-') == 1) at = 2
    at = at + span(text(at:), digits)
    if (at <= len(text)) then
      if (text(at:at) == '.') at = at + 1 + span(text(at + 1:), digits)
    end if
    if (scan(text(:at - 1), digits) == 0) return
    if (scan(text(at:), 'eEdDqQ') == 1) then
      exponent = at + 1
      if (scan(text(exponent:), '+-') == 1) exponent = exponent + 1
      if (span(text(exponent:), digits) > 0) at = exponent + span(text(exponent:), digits)
      if (at < exponent .and. verify(text(exponent:), '+- ') == 0) return   ! the exponent is missing
    end if
    unit = trim(adjustl(text(at:)))
    if (begins_unit(unit)) then
      number = text(:at - 1)
    else
      unit = ''
    end if
  end subroutine split_number

  !> Whether a text begins as a unit does: with a letter, a degree or micro sign, or 1/ and a letter.
  pure logical function begins_unit(text)
    character(len=*), intent(in) :: text
    begins_unit = scan(text, letters//first_bytes) == 1
    if (index(text, '1/') == 1) begins_unit = scan(text(3:), letters) == 1
  end function begins_unit

  !> Number of characters of a set at the beginning of a text.
  pure integer function span(text, set)
    character(len=*), intent(in) :: text, set
    span = verify(text, set) - 1
    if (span < 0) span = len(text)
  end function span

  !> Find the unit that a user wrote behind a number. If it does not belong to the key, `wanted` says what does.
  pure subroutine find_unit(written, of, key, found, wanted)
    character(len=*), intent(in) :: written
    character(len=*), intent(in) :: of, key   !! unit and name of the key
    type(unit_t), intent(out) :: found
    character(len=:), allocatable, intent(out) :: wanted
    character(len=len(all_units%name)), allocatable :: own(:)
    character(len=:), allocatable :: near
    integer :: i
    do i = 1, size(all_units)
      found = all_units(i)
      if (found%of == of .and. is_same(written, found%name) .and. .not. found%of_heads) return
    end do
    found = unit_t(of=of)
    if (of /= '' .and. is_same(written, of)) return
    allocate (own, source=pack(all_units%name, all_units%of == of .and. .not. all_units%of_heads))
    near = ''
    if (len(written) > 1) near = nearest_word(written, own)
    do i = 1, size(own)
      if (lowercase(trim(own(i))) == lowercase(written)) near = trim(own(i))
    end do
    if (of == '' .or. index(of, 'exponent') > 0) then
      wanted = key//' has no unit'
      if (of /= '') wanted = key//' takes no unit: it is in '//of
    else if (of == 'K' .and. (written == 'C' .or. written == 'F')) then
      wanted = 'write deg'//written
    else if (of == 'rad/s' .and. written == 'Hz') then
      wanted = 'turns or radians? Write rpm or rad/s'
    else if (measured_by(written) /= '') then
      wanted = written//' is '//measured_by(written)//'; '//description(of, key)
    else if (near /= '') then
      wanted = 'unknown unit; did you mean '//near//'?'
    else
      wanted = 'unknown unit; '//description(of, key)
    end if
  end subroutine find_unit

  !> What a unit of keys of another kind measures; empty if there is no such unit.
  pure function measured_by(written) result(text)
    character(len=*), intent(in) :: written
    character(len=:), allocatable :: text
    integer :: i
    text = ''
    do i = 1, size(all_units)
      if (is_same(written, all_units(i)%name) .and. .not. all_units(i)%of_heads) &
        text = trim(dimensions(findloc(dimensions%unit, all_units(i)%of, 1))%says)
    end do
  end function measured_by

  !> `clearance is a length (m, km, cm)`
  pure function description(of, key) result(text)
    character(len=*), intent(in) :: of, key
    character(len=:), allocatable :: text
    integer :: i
    i = findloc(dimensions%unit == of, .true., 1)
    text = key//' is in '//replaced(of, ' ', '.')
    if (i > 0) text = key//' is '//trim(dimensions(i)%says)//' ('//listed(all_units%of == of .and. .not. all_units%of_heads)//')'
  end function description

  !> Names of some units, separated by commas.
  pure function listed(those) result(text)
    logical, intent(in) :: those(:)   !! for each unit
    character(len=:), allocatable :: text
    integer :: i
    text = ''
    do i = 1, size(all_units)
      if (those(i)) text = text//', '//trim(all_units(i)%name)
    end do
    text = text(3:)
  end function listed

  !> Find a unit in the head of a column of a table; its factor is then that of numbers, with the power of ten. 0: there is none.
  pure real(dp) function find_head_unit(written, of) result(factor)
    character(len=*), intent(in) :: written, of
    integer :: i
    factor = 0
    do i = 1, size(all_units)
      if (all_units(i)%of == of .and. is_same(written, all_units(i)%name)) &
        factor = 10.0_dp**all_units(i)%power*all_units(i)%factor
    end do
  end function find_head_unit

  !> Units that the head of a column may have.
  pure function head_units(of) result(text)
    character(len=*), intent(in) :: of
    character(len=:), allocatable :: text
    text = listed(all_units%of == of)
  end function head_units

  !> Whether a unit as written is this one: N.m, N m, N*m and Nm are the same, but m.m is not mm.
  pure logical function is_same(written, unit)
    character(len=*), intent(in) :: written, unit
    is_same = plain(written) == plain(unit) .or. plain(written) == replaced(plain(unit), '.', '')
  end function is_same

  !> A unit with points for blanks and signs of multiplication, without signs of power, with a slash before each factor of a
  !> denominator in parentheses, and with letters for the degree sign and the micro signs.
  pure function plain(unit)
    character(len=*), intent(in) :: unit
    character(len=:), allocatable :: plain
    integer :: first, last
    plain = trim(adjustl(replaced(unit, no_break_space, ' ')))
    plain = replaced(replaced(plain, char(194)//char(176), 'deg'), char(194)//char(183), '.')
    plain = replaced(replaced(plain, char(194)//char(181), 'u'), char(206)//char(188), 'u')
    plain = replaced(replaced(replaced(replaced(plain, '**', ''), '^', ''), '*', '.'), ' ', '.')
    do while (index(plain, '..') > 0)
      plain = replaced(plain, '..', '.')
    end do
    plain = replaced(replaced(replaced(plain, './', '/'), '/.', '/'), 'deg.', 'deg')
    first = index(plain, '/(')
    last = index(plain, ')', back=.true.)
    if (first > 0 .and. last == len(plain)) plain = plain(:first)//replaced(plain(first + 2:last - 1), '.', '/')
  end function plain

  !> A number times a power of ten, exactly: its exponent is changed as text.
  pure function shifted(number, power) result(text)
    character(len=*), intent(in) :: number
    integer, intent(in) :: power
    character(len=:), allocatable :: text
    integer :: letter
    text = number
    if (power == 0) return
    letter = scan(number, 'eEdDqQ')
    if (letter == 0) then
      text = number//'e'//integer_text(power)
    else if (len(number) - letter <= 8) then   ! a longer exponent is out of reach
      text = number(:letter)//integer_text(whole_number(number(letter + 1:)) + power)
    end if
  end function shifted
end module physical_units
