!> Units in case files: their values against decimals computed elsewhere, what the syntax allows, what is refused and how, and that
!> a case with units is the case in SI.
module test_units
  use kinds, only: dp
  use error_handling, only: error_t
  use model_parameters, only: key_t, real_kind
  use joint_places, only: n_places
  use case_definition, only: case_t
  use case_file, only: parse_case
  use checks, only: checks_t
  use namelist_reader, only: token_t, read_values
  use value_reader, only: value_t, convert
  implicit none
  private
  public :: run_test_units, field_of

  character(len=*), parameter :: n = achar(10), micro = char(194)//char(181), no_break = char(194)//char(160)
  integer, parameter :: long = 60
  character(len=*), parameter :: in_si = '&mechanism crank_length=0.05, crank_mass=0.3, crank_inertia=1e-5 rod_length=0.12'//n// &
    'rod_mass=0.21 rod_inertia=2.5e-4 rod_com=0.045, 0.001 piston_mass=0.14 /'//n//'&initial crank_angle_deg=90 '// &
    'crank_speed=100 /'//n//'&drive kind=''free'' torque=2.5 /'//n// &
    '&joint kind=''clearance'' bearing_radius=0.01 clearance=1.5e-5 bearing_length=0.02 /'//n// &
    '&contact youngs_modulus=2*207e9 /'//n//'&lubrication viscosity_law=''vogel'' temperature=353.15 '// &
    'known_temperatures=313.15,373.15 known_viscosities=1e-4,1.14e-5 density=885 /'//n//'&wear rate=2*1e-15 /'//n// &
    '&integrator end_time=2e-3 /'//n

contains

  subroutine run_test_units(check)
    class(checks_t), intent(inout) :: check
    call decimals(check)
    call same_case(check)
    call forms(check)
    call refusals(check)
  end subroutine run_test_units

  !> Every unit: data/units.csv.
  subroutine decimals(check)
    class(checks_t), intent(inout) :: check
    type(key_t) :: key
    type(value_t) :: value
    type(token_t), allocatable :: tokens(:)
    character(len=:), allocatable :: message, what
    character(len=100) :: line
    real(dp) :: expected
    integer :: unit, status, rows
    open (newunit=unit, file='data/units.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      rows = rows + 1
      read (line(index(line, field_of(line, 4)//','):), *) expected
      key%kind = real_kind
      key%name = 'quantity'
      key%unit = field_of(line, 2)
      if (key%unit == 'J/kg/K') key%unit = 'J/(kg K)'
      what = field_of(line, 3)//' in '//trim(key%unit)
      call read_values(field_of(line, 3), tokens, message)
      if (.not. allocated(message)) call convert(key, tokens(1), value, 1, message)
      if (allocated(message)) then
        call check%equal_text(message, '', what)
      else if (field_of(line, 5) == 'same bits') then
        call check%that(.not. abs(value%reals(1) - expected) > 0, what//': the same bits')
      else
        call check%that(abs(value%reals(1) - expected) <= spacing(expected), what//': within 1 ulp')
      end if
    end do
    close (unit)
    call check%that(rows > 200, 'rows of data/units.csv')
  end subroutine decimals

  !> Field i of a line of a table.
  pure function field_of(line, i) result(field)
    character(len=*), intent(in) :: line
    integer, intent(in) :: i
    character(len=:), allocatable :: field
    integer :: first, k
    first = 1
    do k = 2, i
      first = first + index(line(first:), ',')
    end do
    field = trim(line(first:first + index(trim(line(first:))//',', ',') - 2))
  end function field_of

  !> A case with units, in its file or in overrides, has the resolved form of the case in SI, which has no units.
  subroutine same_case(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: with_units = '&mechanism crank_length=50mm, crank_mass=300 g, crank_inertia=0.1 kg cm^2 '// &
      'rod_length=12 cm'//n//'rod_mass=210g rod_inertia=2.5 kg*cm^2 rod_com=45 mm, 1 mm piston_mass=0.14 kg /'//n// &
      '&initial crank_angle_deg=90 deg crank_speed=100 rad/s/'//n//'&drive kind=''free'' torque=2500 mN m / as measured'//n// &
      '&joint kind=''clearance'' clearance=15 '//micro//'m bearing_radius=1cm bearing_length=20 mm! of the pin'//n//'/'//n// &
      '&contact youngs_modulus=2*207 GPa /'//n//'&lubrication viscosity_law=''vogel'' temperature=80 '//no_break//'degC '// &
      'known_temperatures=40 deg C 100degC'//no_break//'known_viscosities(1:2)'//no_break//'= 100 cSt,'// &
      '11.4 mm2/s density=0.885 kg/l /'//n// &
      '&wear rate=2*1e-6 mm^3/(N m) /'//n//'&integrator end_time=2 ms/'//n
    character(len=long), parameter :: overrides(3) = [character(len=long) :: 'joint.clearance=15um', &
      'initial.crank_speed=100 rad/s', 'contact.youngs_modulus=207 GPa, 207 GPa']
    character(len=long) :: none(0)
    character(len=:), allocatable :: resolved, other
    call resolve(check, in_si, none, resolved)
    call resolve(check, with_units, none, other)
    call check%equal_text(other, resolved, 'units in a file')
    call resolve(check, in_si, overrides, other)
    call check%equal_text(other, resolved, 'units in overrides')
    call resolve(check, resolved, none, other)
    call check%equal_text(other, resolved, 'the resolved case')
    call check%that(index(resolved, 'clearance = 1.5e-5  ! m') > 0, 'the resolved case is in SI')
  end subroutine same_case

  subroutine resolve(check, text, overrides, resolved)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: text, overrides(:)
    character(len=:), allocatable, intent(out) :: resolved
    type(case_t) :: c
    type(error_t), allocatable :: error
    call parse_case(text, 'x.nml', overrides, c, error, resolved)
    if (.not. allocated(resolved)) resolved = ''
    if (allocated(error)) call check%equal_text(error%message, '', 'a case with units is accepted')
  end subroutine resolve

  !> A number is the longest beginning that is one; a word behind it is its unit unless it is a key; no note guesses the unit of a
  !> number that has one.
  subroutine forms(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: written(9) = [character(len=26) :: '15 um', '15um', '15.um', '1.5e1um', '1.5d-2 mm', &
      '+15 um', '.015 mm', '15    um ! mm', '15 um'//achar(9)//'! m']
    character(len=long) :: none(0)
    type(case_t) :: c
    type(error_t), allocatable :: error
    integer :: i, k
    do i = 1, size(written)
      call parse_case(with_joint('bearing_length=0.02 clearance='//trim(written(i))//n//'/'), 'x.nml', none, c, error)
      call check%that(.not. allocated(error), trim(written(i))//' is accepted')
      if (allocated(error)) cycle
      call check%that(any([(.not. abs(c%joints(k)%clearance - 15e-6_dp) > 0, k=1, n_places)]), trim(written(i))//' is 15 um')
    end do
    call parse_case(with_joint('clearance=1e-2 mm m=5 /'), 'x.nml', none, c, error)
    call check%that(allocated(error), 'a key follows a unit')
    if (allocated(error)) call check%that(index(error%message, '&joint m: unknown key') > 0, 'the key is found: '//error%message)
    call parse_case(with_joint('clearance=20 nm bearing_length=20 mm /'), 'x.nml', none, c, error)
    call check%that(.not. allocated(error), 'a tiny clearance')
    if (allocated(error)) return
    if (.not. allocated(c%notes)) c%notes = ''
    call check%that(index(c%notes, '&joint clearance = 20 nm (2e-8)') > 0, 'its note: '//c%notes)
    call check%that(index(c%notes, '?') == 0, 'no unit is guessed: '//c%notes)
  end subroutine forms

  !> A case whose joint is described by the given keys.
  function with_joint(keys) result(text)
    character(len=*), intent(in) :: keys
    character(len=:), allocatable :: text
    text = in_si(:index(in_si, ' clearance=1.5e-5'))//keys//in_si(index(in_si, n//'&contact'):)
  end function with_joint

  subroutine refusals(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: length = 'clearance is a length (m, km, cm, mm, um, nm, in)'
    call refused('joint.clearance', '15 K', '15 K: K is a temperature; '//length)
    call refused('joint.clearance', '15 MM', '15 MM: unknown unit; did you mean mm?')
    call refused('joint.clearance', '15 furlong', '15 furlong: unknown unit; '//length)
    call refused('joint.clearance', '15 u', '15 u: unknown unit; '//length)
    call refused('joint.clearance', '5d', '5d: must be a number (m)')
    call refused('joint.clearance', '1e', '1e: must be a number (m)')
    call refused('joint.clearance', '1/mm', '1/mm: must be a number (m)')
    call refused('joint.clearance', '''15 um''', '15 um: must be a number, without quotes (m)')
    call refused('joint.clearance', '1e-28 um', '1e-28 um: must be 0 or of a size from 1e-30 to 1e30')
    call refused('contact.restitution', '0.9 m', '0.9 m: restitution has no unit')
    call refused('contact.youngs_modulus', '207 GPa, 207', '207 GPa, 207: a unit for both numbers or for neither')
    call refused('lubrication.temperature', '80 C', '80 C: write degC')
    call refused('initial.crank_speed', '60 Hz', '60 Hz: turns or radians? Write rpm or rad/s')
    call refused('drive.damping', '1 N', '1 N: N is a force; damping is in N.m.s/rad')
    call refused('integrator.max_steps', '5 mm', '5 mm: must be a whole number')
    call refused('joint.clearance', '15 u m', '15 u m: unknown unit; did you mean um?')
    call refused('joint.clearance', '15 m m', '15 m m: unknown unit; did you mean mm?')
    call refused('joint.clearance', '5 N m', '5 N m: N m is a moment; '//length)
    call refused('joint.clearance', '5 J/(kg K)', '5 J/(kg K): J/(kg K) is a specific heat; '//length)
    call refused('drive.torque', '5 N s', '5 N s: unknown unit; torque is a moment (N.m, mN.m, kN.m)')
    call refused('drive.torque', '5 M N', '5 M N: unknown unit; torque is a moment (N.m, mN.m, kN.m)')
    call refused('drive.damping', '5 N m', '5 N m: N m is a moment; damping is in N.m.s/rad')
    call refused_by_syntax('15 um bearing_mass 5', 'clearance: 15 um: unexpected bearing_mass')
    call refused_by_syntax('0,05 mm', 'clearance: 0,05 mm has a decimal comma: write 0.05 mm')
    call refused_by_syntax('15 mm', 'clearance = 15 mm (0.015): must be < bearing_radius = 0.01')
    call refused_by_syntax('15 um /mm', 'a key or / was expected, not /mm')
    call refused_by_syntax('15 / mm', 'text outside a group: /; &joint ends in line ')
    call refused_by_syntax('15 um / bearing_mass = 5', 'text outside a group: bearing_mass = 5; &joint ends in line ')
    call refused_by_syntax('15 um / end of &joint', 'text outside a group: end of &joint; &joint ends in line ')
    call refused_by_syntax('15 um / 2', 'text outside a group: 2; &joint ends in line ')

  contains

    subroutine refused(key, text, wanted)
      character(len=*), intent(in) :: key, text, wanted
      type(case_t) :: c
      type(error_t), allocatable :: error
      call parse_case(in_si, 'x.nml', [key//'='//text], c, error)
      call check%that(allocated(error), key//' = '//text//' is refused')
      if (allocated(error)) call check%equal_text(error%message(index(error%message, ' = ') + 3:), wanted, 'message')
    end subroutine refused

    subroutine refused_by_syntax(text, wanted)
      character(len=*), intent(in) :: text, wanted
      type(case_t) :: c
      type(error_t), allocatable :: error
      character(len=1) :: none(0)
      call parse_case(with_joint('bearing_length=0.02 clearance='//text//n//'/'), 'x.nml', none, c, error)
      call check%that(allocated(error), text//' is refused')
      if (allocated(error)) call check%that(index(error%message, wanted) > 0, text//', message: '//error%message)
    end subroutine refused_by_syntax
  end subroutine refusals
end module test_units
