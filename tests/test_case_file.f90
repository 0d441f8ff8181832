!> Case files: which are accepted, which are refused and with which message, and that a resolved case gives the same case.
module test_case_file
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t, status_case_file
  use case_definition, only: case_t
  use case_file, only: read_case, parse_case, template
  use text_tools, only: path_beside, replaced, next_line
  use case_schema, only: key_table_t, case_schema_of
  use text_file, only: read_text_file
  use posix_files, only: make_directory, remove_file
  use result_file, only: result_file_t
  use checks, only: checks_t
  use laws, only: parameter_of
  use joint_places, only: crank_pin, piston_pin
  implicit none
  private
  public :: run_test_case_file

  character(len=*), parameter :: n = achar(10), two = ', or two, as in key(1:2)'
  character(len=*), parameter :: bodies = '&mechanism crank_length=0.05, crank_mass=0.3, crank_inertia=1d-5'//n// &
    'rod_length=0.12 rod_mass=.21 rod_inertia=2.5E-4'//n//'piston_mass=0.14 /'//n//'&initial crank_speed=100 /'//n
  character(len=*), parameter :: joint = '&joint kind=''clearance'' clearance=5e-4 bearing_radius=0.01 /'//n
  character(len=*), parameter :: contact = '&contact /'//n
  character(len=*), parameter :: run = '&integrator revolutions=2 /'//n
  character(len=*), parameter :: whole = bodies//joint//contact//run
  character(len=*), parameter :: all_groups = ' (allowed: case, mechanism, bearing_load, drive, initial, pin, joint, '// &
    'contact, friction, lubrication, asperities, wear, film_history, supply, bore, shape, heat, guide, ring, elastic_rod, '// &
    'crankshaft, damper, cylinder, combustion, cylinder_pressure, working_gas, valve, wall_heat, run, integrator, output)'
  character(len=*), parameter :: laws = 'lankarani_nikravesh, hertz, hunt_crossley, exact, flores, gonthier, carvalho_martins, '// &
    'herbert_mcwhannell, zhiying_qishao, impact'
  character(len=*), parameter :: no_speeds = n//'x.nml: &friction v0: required with law = ''ambrosio'' (m/s)'//n// &
    'x.nml: &friction v1: required with law = ''ambrosio'' (m/s)'
  character(len=*), parameter :: at_rest = n//'x.nml: &output interval: required with crank_speed = 0: the time between rows, '// &
    'such as interval = 1e-4 (s)'
  character(len=*), parameter :: joint_keys = ' (allowed: kind, clearance, bearing_radius, bearing_length, numbers, load_share)'

contains

  subroutine run_test_case_file(check)
    class(checks_t), intent(inout) :: check
    type(key_table_t) :: table
    call case_schema_of(table)
    call check%equal_text(table%difference, '', 'a key has the same meaning in all laws of a group')
    call test_values(check)
    call test_forms(check)
    call test_elements(check)
    call test_texts(check)
    call test_resolved(check)
    call test_syntax(check)
    call test_names(check)
    call test_numbers(check)
    call test_ranges(check)
    call test_bodies(check)
    call test_joint(check)
    call test_films(check)
    call test_places(check)
    call test_groups_of_one_joint(check)
    call test_runs(check)
    call test_ends_of_runs(check)
    call test_groups_taken_out(check)
    call test_decimal_commas(check)
    call test_typography(check)
    call test_hints(check)
    call test_several_errors(check)
    call test_likely_words(check)
    call test_files(check)
    call test_shipped_cases(check)
    call test_safe_messages(check)
  end subroutine run_test_case_file

  !> Number i of a pair.
  pure real(dp) function element(pair, i)
    real(dp), intent(in) :: pair(2)
    integer, intent(in) :: i
    element = pair(i)
  end function element

  !> Values are read, missing keys have their defaults, and groups that are left out are absent.
  subroutine test_values(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=40) :: none(0)
    call parse_case(whole, 'folder/x.nml', none, c, error)
    call check%that(.not. allocated(error), 'a plain case is read')
    call check%equal_text(c%name, 'x', 'name without folder and .nml')
    call check%equal_text(c%file, 'folder/x.nml', 'file as given')
    call check%relative(c%mechanism%crank_inertia, 1e-5_dp, 0.0_dp, 'd exponent')
    call check%relative(c%mechanism%gravity, 9.80665_dp, 0.0_dp, 'gravity by default')
    call check%that(allocated(c%joints(piston_pin)%contact) .and. .not. allocated(c%joints(piston_pin)%friction), &
      'presence of models')
    call check%that(c%joints(piston_pin)%contact%name == 'lankarani_nikravesh', 'law by default')
    call check%that(c%output%samples_per_revolution == 720 .and. c%output%columns == 'standard', 'output by default')
    call check%that(c%integrator%max_order == 12 .and. c%integrator%method == 'auto', 'integrator by default')
    call parse_case(whole, 'x.nml', [character(len=40) :: 'friction.coefficient=.1', 'friction.law=coulomb', &
                                     'contact.youngs_modulus=1e11,2e11', 'case.title=A, b ''c''', &
                                     'friction.coefficient=0.2'], c, error)
    call check%that(.not. allocated(error), 'overrides are taken')
    call check%that(allocated(c%joints(piston_pin)%friction), 'an override makes its group present')
    call check%relative(element(parameter_of(c%joints(piston_pin)%friction, 'coefficient'), 1), 0.2_dp, 0.0_dp, &
      'the last override of a key is used')
    call check%relative(element(parameter_of(c%joints(piston_pin)%contact%geometry, 'youngs_modulus'), 2), 2e11_dp, 0.0_dp, &
      'override of an array')
    call check%equal_text(c%title, 'A, b ''c''', 'text of an override without quotes')
  end subroutine test_values

  !> Every form of namelists that is allowed.
  subroutine test_forms(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=1) :: none(0)
    character(len=*), parameter :: bom = char(239)//char(187)//char(191), crlf = achar(13)//n
    call parse_case(bom//'! comment / & ="'//crlf//'&CASE TITLE="it''s ""so"" ! / &" &END'//crlf//bodies//joint// &
                    '&Contact'//achar(9)//'poissons_ratio=2*0.25, youngs_modulus(2)=1.5D+11'//crlf// &
                    ' restitution = 0.5, ! comment'//crlf//' Law=''HERTZ'','//crlf//'/ ! comment'//crlf// &
                    '&output every_step=T, ideal_twin=.TRUE., columns=''time'', ''rod_angle''/'//run(:len(run) - 1), &
                    'x', none, c, error)
    call check%that(.not. allocated(error), 'forms of namelists')
    if (allocated(error)) call check%equal_text(error%message, '', 'forms')
    call check%equal_text(c%title, 'it''s "so" ! / &', 'quotes, and comment characters inside them')
    call check%relative(element(parameter_of(c%joints(piston_pin)%contact%geometry, 'poissons_ratio'), 2), 0.25_dp, 0.0_dp, &
      'repeat count')
    call check%relative(element(parameter_of(c%joints(piston_pin)%contact%geometry, 'youngs_modulus'), 1), 207e9_dp, 0.0_dp, &
      'element by default')
    call check%relative(element(parameter_of(c%joints(piston_pin)%contact%geometry, 'youngs_modulus'), 2), 1.5e11_dp, 0.0_dp, &
      'element by index')
    call check%that(c%joints(piston_pin)%contact%name == 'hertz', 'words in upper or lower case')
    call check%that(c%output%every_step .and. c%output%ideal_twin, 'logicals')
    call check%equal_text(c%output%columns, 'time,rod_angle', 'list of texts')
    call parse_case(whole(:len(whole) - 1)//' end of the run ! = &'//n// &
                    '&crankshaft inertia(1:2)=1, 2 inertia(3)=3 stiffness=5 /'//n// &
                    '&output columns(1:2)=''time'', ''rod_angle'' /', 'x', none, c, error)
    call check%that(.not. allocated(error), 'ranges of indices, and text behind the end of a group')
    if (allocated(error)) call check%equal_text(error%message, '', 'forms')
    call check%equal_text(c%output%columns, 'time,rod_angle', 'a list of texts with its range')
    call check%that(c%shaft%n_inertia == 3, 'a list of numbers with its range, and a further one')
    call parse_case(whole//'&case title='''//repeat('x', 3000)//''' /', 'x', none, c, error)
    call check%that(len(c%title) == 3000, 'long lines')
  end subroutine test_forms

  !> One number of a list by its name, and what is none.
  subroutine test_elements(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: shaft = whole//'&crankshaft inertia = 1, 2, 3 stiffness = 5 /'//n, &
      given = bodies//joint//contact//'&integrator revolutions = 2 /'//n
    type(case_t) :: c
    type(error_t), allocatable :: error
    call resolves(check, given, [character(len=40) :: 'mechanism.rod_com[2]=1 mm', 'mechanism.crank_com(1)=0.002'], &
      'rod_com = 0.0, 0.001', 'crank_com = 0.002, 0.0')
    call resolves(check, shaft, [character(len=40) :: 'crankshaft.inertia[1]=4', 'crankshaft.inertia[2]=5'], &
      'inertia = 4.0, 5.0, 3.0', 'stiffness = 5.0')
    call resolves(check, shaft, [character(len=40) :: 'crankshaft.inertia=6, 7', 'crankshaft.inertia[3]=8'], &
      'inertia = 6.0, 7.0, 8.0', 'stiffness = 5.0')
    call refused_with(check, 'mechanism.rod_com[3]=1', &
      'x.nml: --set mechanism.rod_com[3]=1: &mechanism rod_com[3]: has the numbers rod_com[1] to rod_com[2]')
    call refused_with(check, 'mechanism.rod_com[2=1', &
      'x.nml: --set mechanism.rod_com[2=1: &mechanism rod_com[2: has the numbers rod_com[1] to rod_com[2]')
    call refused_with(check, 'mechanism.rod_com[=1', &
      'x.nml: --set mechanism.rod_com[=1: &mechanism rod_com[: has the numbers rod_com[1] to rod_com[2]')
    call refused_with(check, 'mechanism.rod_com[1]=1, 2', 'x.nml: --set mechanism.rod_com[1]=1, 2: takes 1 value, not 2')
    call refused_with(check, 'joint.clearance[1]=1', &
      'x.nml: --set joint.clearance[1]=1: &joint clearance[1]: clearance is no list of numbers')
    call refused_with(check, 'output.columns[1]=time', &
      'x.nml: --set output.columns[1]=time: &output columns[1]: columns is no list of numbers')
    call refused_with(check, 'mechanism.rod_com(3)=1', &
      'x.nml: --set mechanism.rod_com(3)=1: &mechanism rod_com(3): has the numbers rod_com[1] to rod_com[2]')
    call refused_with(check, 'ring.height=1e-3', &
      'x.nml: --set ring.height=1e-3: &ring: there may be several: ring_1.height is that of the first one')
    call refused_with(check, 'joint.clearance(1)=1', &
      'x.nml: --set joint.clearance(1)=1: &joint clearance(1): clearance is no list of numbers')
    call refused_with(check, 'contact.law(2)=hertz', &
      'x.nml: --set contact.law(2)=hertz: &contact law(2): law is no list of numbers')
    call parse_case(whole, 'x.nml', [character(len=30) :: 'mechanism.rod_com=0.05,0.001', 'mechanism.rod_com(2) = -0.7 mm'], &
      c, error)
    call check%that(.not. allocated(error), 'an index in an override')
    if (allocated(error)) return
    call check%that(all(abs(c%mechanism%rod_com - [0.05_dp, -0.7e-3_dp]) < 1e-15_dp), 'only the number with this index is set')
  end subroutine test_elements

  !> Paths of files that another file names, replaced parts of texts, and lines.
  subroutine test_texts(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: text = 'a'//n//n//'bc'
    character(len=:), allocatable :: line
    integer :: at
    call check%equal_text(path_beside('a/b/c.nml', 'd.csv'), 'a/b/d.csv', 'a path relative to a file')
    call check%equal_text(path_beside('c.nml', '../d.csv'), '../d.csv', 'a path relative to a file of the current folder')
    call check%equal_text(path_beside('a/c.nml', '/d.csv'), '/d.csv', 'an absolute path')
    call check%equal_text(path_beside('/dev/stdin', 'd.csv'), 'd.csv', 'a path relative to standard input')
    call check%equal_text(path_beside('a/c.nml', ''), '', 'no path')
    call check%equal_text(replaced('abcabca', 'ca', '.'), 'ab.b.', 'every occurrence is replaced')
    call check%equal_text(replaced('aaa', 'a', 'aa'), 'aaaaaa', 'what was put in is not replaced again')
    call check%equal_text(replaced('abc', 'x', ''), 'abc', 'nothing to replace')
    at = 1
    call next_line(text, at, line)
    call check%equal_text(line, 'a', 'the first line')
    call next_line(text, at, line)
    call check%equal_text(line, '', 'an empty line')
    call next_line(text, at, line)
    call check%equal_text(line, 'bc', 'the last line has no end')
    call check%that(at > len(text), 'there are no more lines')
  end subroutine test_texts

  !> A resolved case reads back as the same bits and the same text; so does the template.
  subroutine test_resolved(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: c, back
    type(error_t), allocatable :: error
    character(len=40) :: none(0)
    character(len=:), allocatable :: text, again
    call parse_case(whole, 'x', [character(len=40) :: 'mechanism.crank_length=0.03333333333333', &
                                 'joint.clearance=1.23456789012345e-5', 'case.title=it''s ''so'''], c, error, text)
    call check%that(.not. allocated(error), 'case to resolve')
    call parse_case(text, 'x', none, back, error, again)
    call check%that(.not. allocated(error), 'a resolved case is read')
    call check%equal_text(again, text, 'resolved again')
    call check%that(transfer(back%mechanism%crank_length, 1_int64) == transfer(c%mechanism%crank_length, 1_int64), &
      'bits of a length')
    call check%that(transfer(back%joints(piston_pin)%clearance, 1_int64) == &
      transfer(c%joints(piston_pin)%clearance, 1_int64), 'bits of the clearance')
    call check%that(index(text, '&lubrication') == 0 .and. index(text, '&contact') > 0, &
      'absent groups are not in the resolved case')
    call check%that(index(text, 'max_order = 12') > 0, 'defaults are in the resolved case')
    call parse_case(template(), 'x', none, c, error, text)
    call check%that(.not. allocated(error), 'the template is a case')
    call parse_case(text, 'x', none, back, error, again)
    call check%equal_text(again, text, 'the template resolved again')
    call check%that(allocated(c%combustion) .and. allocated(c%joints(piston_pin)%film), 'the template has all models')
    call parse_case(bodies//run, 'x', none, c, error, text)
    call parse_case(text, 'x', none, back, error, again)
    call check%that(.not. allocated(error), 'a resolved case with an ideal joint is read')
    if (allocated(error)) return
    call check%equal_text(again, text, 'ideal joint resolved again')
  end subroutine test_resolved

  subroutine test_syntax(check)
    class(checks_t), intent(inout) :: check
    call refused(check, '', 'x.nml: the file contains no group; gudgeon --template prints a case')
    call refused(check, n//' ! only a comment', 'x.nml: the file contains no group; gudgeon --template prints a case')
    call refused(check, 'words', 'x.nml:1: text outside a group: words')
    call refused(check, whole//'/', 'x.nml:8: text outside a group: /; &integrator ends in line 7')
    call refused(check, '&joint', 'x.nml:1: &joint: not closed: / is missing before the end of the file')
    call refused(check, '&joint'//n//' clearance=1 '//n//'&contact /', &
                 'x.nml:1: &joint: not closed: / is missing before &contact')
    call refused(check, n//'&joint kind=''a'//n//'/', 'x.nml:2: &joint kind: the string is not closed on its line: ''a')
    call refused(check, '&joint clearance 1 /', 'x.nml:1: &joint clearance: = is missing')
    call refused(check, '&joint clearance = /', 'x.nml:1: &joint clearance: a value is missing')
    call refused(check, '&contact density=1,,2 /', 'x.nml:1: &contact density: a value is missing before the comma')
    call refused(check, '&joint 5=3 /', 'x.nml:1: &joint: a key or / was expected, not 5=3 /')
    call refused(check, '&joint clearance=1=2 /', 'x.nml:1: &joint clearance: unexpected =2 /')
    call refused(check, '&end', 'x.nml:1: &end closes no group')
    call refused(check, '& /', 'x.nml:1: a group''s name must follow &')
    call refused(check, '&contact density(0)=1 /', &
                 'x.nml:1: &contact density: the index must be a whole number in parentheses, as in key(1)'//two)
    call refused(check, '&mechanism'//n//'rod_mass=1'//n//'rod_com(1,2)=1, 2 /', &
                 'x.nml:3: &mechanism rod_com: the index must be a whole number in parentheses, as in key(1)'//two)
    call refused(check, '&mechanism rod_mass=1 rod_com(2:1)=1 /', 'x.nml:1: &mechanism rod_com: the index must be '// &
                 'a whole number in parentheses, as in key(1)'//two)
    call refused(check, '&mechanism rod_mass=1'//n//'rod_com(1:2)='//n//'1 /', &
                 'x.nml:2: &mechanism rod_com: takes 2 values from 1 to 2, not 1')
    call refused(check, '&contact density=2*, /', 'x.nml:1: &contact density: a value is missing after the repeat count')
    call refused(check, '&contact density=99999*1 /', 'x.nml:1: &contact density: repeat count out of range: 99999*1')
    call refused(check, whole//'&output '//repeat('digits=9 ', 2000)//'/', 'x.nml:8: &output digits: given twice'//n// &
                 'x.nml:8: too many keys')
    call refused_with(check, 'joint.clearance', 'x.nml: --set joint.clearance: must have the form GROUP.KEY=VALUE '// &
                      'or GROUP=none')
    call refused_with(check, 'joint.clearance=1 /', 'x.nml: --set joint.clearance=1 /: unexpected /')
  end subroutine test_syntax

  subroutine test_names(check)
    class(checks_t), intent(inout) :: check
    call refused(check, '&jiont /', 'x.nml:1: &jiont: unknown group; did you mean joint?'//all_groups)
    call refused(check, '&joint /'//n//'&joint /', 'x.nml:2: &joint: this group is given twice')
    call refused(check, '&joint'//n//'clearnce=1 /', 'x.nml:2: &joint clearnce: unknown key; did you mean clearance?'//joint_keys)
    call refused(check, '&joint rod_length=1 /', &
                 'x.nml:1: &joint rod_length: unknown key of this group; it belongs to &mechanism'//joint_keys)
    call refused(check, '&joint clearance=1, clearance=2 /', 'x.nml:1: &joint clearance: given twice')
    call refused(check, '&crankshaft inertia(2)=1 /', 'x.nml:1: &crankshaft inertia: number 1 must be given before')
    call refused(check, '&output columns(2)=''time'' /', 'x.nml:1: &output columns: takes an index that begins with 1')
    call refused(check, '&mechanism rod_mass(1:1)=1 /', 'x.nml:1: &mechanism rod_mass: takes no index')
    call refused(check, '&contact density(1)=1 density=2*1 /', 'x.nml:1: &contact density: given twice')
    call refused_with(check, 'joint.clearnce=1', &
                      'x.nml: --set joint.clearnce=1: &joint clearnce: unknown key; did you mean clearance?'//joint_keys)
    call refused(check, '&joint kind=''fixed'' /', 'x.nml:1: &joint kind = fixed: must be one of ideal, clearance, quasi_static')
    call refused(check, '&integrator method=''euler'' /', 'x.nml:1: &integrator method = euler: must be one of auto, adams, radau')
    call refused(check, '&case /', 'x.nml: &mechanism: this group is required')
    call refused(check, '&mechanism /', 'x.nml: &mechanism crank_length: required (m)')
    call refused(check, whole//'&friction /', 'x.nml: &friction coefficient: required'//no_speeds)
  end subroutine test_names

  subroutine test_numbers(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: at = 'x.nml:1: &joint clearance = ', reach = ': must be 0 or of a size from 1e-30 to 1e30 (m)'
    call refused(check, '&joint clearance=abc /', at//'abc: must be a number (m)')
    call refused(check, '&joint clearance=1e /', at//'1e: must be a number (m)')
    call refused(check, '&joint clearance=1.2.3 /', at//'1.2.3: must be a number (m)')
    call refused(check, '&joint clearance=.5. bearing_radius=1 /', at//'.5.: must be a number (m)')
    call refused(check, '&joint clearance=. /', at//'.: must be a number (m)')
    call refused(check, '&joint clearance=''1'' /', at//'1: must be a number, without quotes (m)')
    call refused(check, '&joint clearance=NaN /', at//'NaN: must be a finite number (m)')
    call refused(check, '&joint clearance=-Infinity /', at//'-Infinity: must be a finite number (m)')
    call refused(check, '&joint clearance=1e400 /', at//'1e400'//reach)
    call refused(check, '&joint clearance=1e99999999999 /', at//'1e99999999999'//reach)
    call refused(check, '&joint clearance=1e-400 /', at//'1e-400'//reach)
    call refused(check, '&joint clearance=1'//repeat('0', 35)//' /', at//'1'//repeat('0', 35)//reach)
    call refused(check, '&joint clearance=1, 2 /', 'x.nml:1: &joint clearance: takes 1 value, not 2')
    call refused(check, '&contact density=3*1 /', 'x.nml:1: &contact density: takes 2 values, not 3')
    call refused(check, '&contact density=1 /', 'x.nml:1: &contact density: takes 2 values; as 2*1 where they are the same')
    call refused(check, '&contact density(3)=1 /', 'x.nml:1: &contact density: takes 2 values, not 3')
    call refused(check, '&integrator max_order=5.0 /', 'x.nml:1: &integrator max_order = 5.0: must be a whole number')
    call refused(check, '&integrator max_steps=2147483648 /', &
                 'x.nml:1: &integrator max_steps = 2147483648: must be a whole number up to 2147483647')
    call refused(check, '&integrator max_steps=99999999999999999999 /', &
                 'x.nml:1: &integrator max_steps = 99999999999999999999: must be a whole number up to 2147483647')
    call refused(check, '&output every_step=yes /', 'x.nml:1: &output every_step = yes: must be .true. or .false.')
  end subroutine test_numbers

  subroutine test_ranges(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: fire = '&combustion bore=.07 compression_ratio=9 heat_capacity_ratio=1.4 heat=165 '// &
      'wiebe_efficiency=5 wiebe_form=3 start_deg=340 duration_deg=40 /'
    call refused_with(check, 'joint.clearance=-1e-5', 'x.nml: &joint clearance = -1e-5: must be > 0 (m)')
    call refused_with(check, 'joint.clearance=0', 'x.nml: &joint clearance = 0: must be > 0 (m)')
    call refused_with(check, 'mechanism.crank_length=0', 'x.nml: &mechanism crank_length = 0: must be > 0 (m)')
    call refused_with(check, 'mechanism.piston_mass=0', 'x.nml: &mechanism piston_mass = 0: must be > 0 (kg)')
    call refused_with(check, 'mechanism.rod_inertia=-1', 'x.nml: &mechanism rod_inertia = -1: must be >= 0 (kg m^2)')
    call refused_with(check, 'contact.restitution=1.1', 'x.nml: &contact restitution = 1.1: must be >= 0 and <= 1')
    call refused_with(check, 'contact.exponent=.9', 'x.nml: &contact exponent = .9: must be >= 1')
    call refused_with(check, 'contact.youngs_modulus=1,0', 'x.nml: &contact youngs_modulus(2) = 0: must be > 0 (Pa)')
    call refused_with(check, 'contact.poissons_ratio=.6,0', &
                      'x.nml: &contact poissons_ratio(1) = .6: must be >= 0 and <= 0.5')
    call refused_with(check, 'contact.least_impact_speed=0', &
                      'x.nml: &contact least_impact_speed = 0: must be >= 1e-9 and <= 1 (m/s)')
    call refused_with(check, 'initial.eccentricity=1,0', 'x.nml: &initial eccentricity(1) = 1: must be shorter than '// &
                      'bearing_radius = 0.01: the pin would leave its bearing (m): millimetres?')
    call refused_with(check, 'initial.crank_pin_eccentricity=1e-5,0', &
                      'x.nml: &initial crank_pin_eccentricity(1) = 1e-5: must be 0 in an ideal joint (m)')
    call refused_with(check, 'initial.crank_pin_eccentricity_rate=0,1', &
                      'x.nml: &initial crank_pin_eccentricity_rate(1) = 0: must be 0 in an ideal joint (m/s)')
    call refused_with(check, 'initial.crank_speed=-2e9', &
                      'x.nml: &initial crank_speed = -2e9: must be >= -1e9 and <= 1e9 (rad/s)')
    call refused(check, '&mechanism gravity_angle_deg=down /', 'x.nml:1: &mechanism gravity_angle_deg = down: must be a '// &
                 'number (degrees)')
    call refused_with(check, 'integrator.max_evaluations_per_revolution=-1', &
                      'x.nml: &integrator max_evaluations_per_revolution = -1: must be > 0 and <= 2000000000')
    call refused_with(check, 'contact.stiffness=-1', 'x.nml: &contact stiffness = -1: must be > 0 (N/m^exponent)')
    call refused_with(check, 'integrator.relative_tolerance=0', &
                      'x.nml: &integrator relative_tolerance = 0: must be > 0 and <= 0.1')
    call refused_with(check, 'integrator.relative_tolerance=.2', &
                      'x.nml: &integrator relative_tolerance = .2: must be > 0 and <= 0.1')
    call refused_with(check, 'integrator.max_order=13', 'x.nml: &integrator max_order = 13: must be >= 1 and <= 12')
    call refused_with(check, 'integrator.max_order=0', 'x.nml: &integrator max_order = 0: must be >= 1 and <= 12')
    call refused_with(check, 'integrator.max_steps=-1', 'x.nml: &integrator max_steps = -1: must be > 0')
    call accepted(check, whole//fire, 'combustion')
    call refused_with(check, 'combustion.bore=0', 'x.nml: &combustion bore = 0: must be >= 1e-6 and <= 1e3 (m)', fire)
    call refused_with(check, 'combustion.compression_ratio=1', &
                      'x.nml: &combustion compression_ratio = 1: must be > 1 and <= 1000', fire)
    call refused_with(check, 'combustion.heat_capacity_ratio=1', &
                      'x.nml: &combustion heat_capacity_ratio = 1: must be > 1 and <= 10', fire)
    call refused_with(check, 'combustion.heat=-1', 'x.nml: &combustion heat = -1: must be >= 0 and <= 1e12 (J)', fire)
    call refused_with(check, 'combustion.duration_deg=1e9', &
                      'x.nml: &combustion duration_deg = 1e9: must be > 0 and <= 360 (degrees)', fire)
    call refused_with(check, 'combustion.wiebe_form=0', &
                      'x.nml: &combustion wiebe_form = 0: must be >= 0.05 and <= 100', fire)
    call refused_with(check, 'combustion.wiebe_efficiency=0', &
                      'x.nml: &combustion wiebe_efficiency = 0: must be > 0 and <= 1000', fire)
    call refused_with(check, 'combustion.start_deg=179', &
                      'x.nml: &combustion start_deg = 179: must be >= 180 and < 540 (degrees)', fire)
    call refused_with(check, 'combustion.duration_deg=0', &
                      'x.nml: &combustion duration_deg = 0: must be > 0 and <= 360 (degrees)', fire)
    call refused_with(check, 'combustion.duration_deg=201', 'x.nml: &combustion duration_deg = 201: '// &
                      'must be <= 200: the cylinder opens at 540 (degrees)', fire)
    call refused_with(check, 'combustion.cycle=two_stroke', 'x.nml: &combustion port_opens_deg: required with cycle = '// &
                      '''two_stroke'' (degrees)', fire)
    call refused_on(check, whole//fire, [character(len=40) :: 'combustion.cycle=two_stroke', 'combustion.port_opens_deg=19'], &
      'x.nml:8: &combustion start_deg = 340: must be >= 341, where the cylinder closes (degrees)')
    call refused_on(check, whole//fire, [character(len=40) :: 'combustion.cycle=two_stroke', 'combustion.port_opens_deg=20', &
      'combustion.duration_deg=41'], 'x.nml: &combustion duration_deg = 41: must be <= 40: '// &
      'the cylinder opens at 380 (degrees)')
    call refused_on(check, whole//fire, [character(len=40) :: 'combustion.cycle=compressor', 'combustion.dead_space=0.1', &
      'combustion.discharge_pressure=101325', 'combustion.polytropic_exponent=1.2'], &
      'x.nml: &combustion discharge_pressure = 101325: must be > suction_pressure = 101325 (Pa)')
    call refused(check, whole//'&drive kind=''free'''//n//'torque_table=''none.csv'' /', &
      'x.nml:9: &drive torque_table: none.csv: No such file or directory')
    call refused(check, replaced(whole, '&initial', '&initial from=''none.nml'''), &
      'x.nml:4: &initial from: none.nml: No such file or directory')
    call refused_with(check, 'drive.torque_table=none.csv', 'x.nml: &drive torque_table: none.csv: No such file or directory')
    call refused_with(check, 'cylinder_pressure.bore=0.1', 'x.nml: &cylinder_pressure table: required')
    call refused_with(check, 'cylinder_pressure.table=', 'x.nml: &cylinder_pressure table = : must be the name of a file', &
      '&cylinder_pressure bore=0.1 /')
    call refused_on(check, whole//fire, [character(len=40) :: 'run.until=periodic', 'run.period_revolutions=1'], &
      'x.nml: &run period_revolutions = 1: must be >= 2, what the gas or the load takes to repeat')
    call accepted(check, whole//fire, 'a two-stroke engine repeats after one revolution', [character(len=40) :: &
      'run.until=periodic', 'run.period_revolutions=1', 'combustion.cycle=two_stroke', 'combustion.port_opens_deg=100'])
    call accepted(check, whole//fire, 'a compressor repeats after one revolution', [character(len=40) :: &
      'run.until=periodic', 'run.period_revolutions=1', 'combustion.cycle=compressor', 'combustion.dead_space=0.1', &
      'combustion.discharge_pressure=5e5', 'combustion.polytropic_exponent=1.2'])
    call refused_with(check, 'combustion.intake_pressure=0', 'x.nml: &combustion intake_pressure = 0: must be > 0 (Pa)', fire)
  end subroutine test_ranges

  !> The rod reaches round, and the mass matrix is positive definite.
  subroutine test_bodies(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: crank = 'must be > 0 unless crank_mass is > 0 away from the axis, or '
    call refused_with(check, 'mechanism.rod_length=0.05', 'x.nml: &mechanism rod_length = 0.05: must be > crank_length = 0.05 (m)')
    call refused_with(check, 'mechanism.rod_length=0.0504', &
                      'x.nml: &mechanism rod_length = 0.0504: must be > crank_length + clearance = 0.0505 (m)')
    call refused_with(check, 'joint.clearance=20.0', 'x.nml: &joint clearance = 20.0: must be < bearing_radius = 0.01: '// &
                      'the pin''s radius is the difference (m): micrometres?')
    call refused_with(check, 'mechanism.rod_inertia=0', 'x.nml: &mechanism rod_inertia = 0: must be > 0 unless rod_mass '// &
                      'is > 0 away from the crank pin (kg m^2)')
    call refused_on(check, whole, [character(len=40) :: 'mechanism.crank_inertia=0', 'mechanism.rod_mass=0'], &
                    'x.nml: &mechanism crank_inertia = 0: '//crank//'rod_mass and rod_inertia are (kg m^2)')
    call refused_on(check, bodies//run, [character(len=40) :: 'mechanism.crank_inertia=0', 'mechanism.rod_inertia=0'], &
                    'x.nml: &mechanism crank_inertia = 0: '//crank//'rod_inertia is (kg m^2)')
    call accepted(check, whole, 'rod with its mass away from the pin', &
                  [character(len=40) :: 'mechanism.rod_inertia=0', 'mechanism.rod_com=0.06,0'])
    call accepted(check, whole, 'crank without inertia', [character(len=40) :: 'mechanism.crank_inertia=0'])
    call accepted(check, bodies//run, 'rod without mass in an ideal joint', &
                  [character(len=40) :: 'mechanism.rod_inertia=0', 'mechanism.rod_mass=0'])
  end subroutine test_bodies

  subroutine test_joint(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: no_play = 'must be clearance (or quasi_static) with contact, friction or lubrication: an '// &
      'ideal joint has no clearance; remove these groups, for example with --set contact=none'
    call refused_with(check, 'joint.kind=ideal', 'x.nml: &joint kind = ideal: '//no_play)
    call refused(check, bodies//run//contact, 'x.nml: &joint kind: '//no_play)
    call refused(check, bodies//run//'&lubrication viscosity=1 /', 'x.nml: &joint kind: '//no_play)
    call refused(check, bodies//run//'&joint clearance=1e-5 /', &
                 'x.nml:6: &joint clearance = 1e-5: needs kind = ''clearance''; the default is ideal (m)')
    call refused(check, bodies//run//'&joint kind=''clearance'' /'//contact, &
                 'x.nml: &joint clearance: required with kind = ''clearance'' (m)'//n// &
                 'x.nml: &joint bearing_radius: required with kind = ''clearance'' (m)')
    call refused(check, bodies//run//'&joint kind=''clearance'' clearance=1e-5 /'//contact, &
                 'x.nml: &joint bearing_radius: required with kind = ''clearance'' (m)')
    call refused(check, bodies//run//joint, &
                 'x.nml:6: &joint kind = clearance: needs contact or lubrication: without them no force would act on the pin')
    call refused_with(check, 'joint.bearing_radius=5e-4', &
                      'x.nml:5: &joint clearance = 5e-4: '// &
                      'must be < bearing_radius = 0.0005: the pin''s radius is the difference (m)')
    call refused(check, bodies//run//'&joint kind=''clearance'' clearance=1e-5 bearing_radius=0.01 bearing_length=21 /'// &
                 '&lubrication law=''finite_bearing'' viscosity=0.01 /', &
                 'x.nml:6: &joint bearing_length = 21: must be <= 1000 times the diameter with this film; that of a long '// &
                 'bearing is law = ''pinkus_sternlicht'' (m): millimetres?')
    call refused_with(check, 'friction.coefficient=0.1', no_speeds(len(n) + 1:))
    call refused_with(check, 'friction.v1=0.001', 'x.nml: &friction v1 = 0.001: must be >= v0 = 0.01 (m/s)', &
                      '&friction coefficient=0.1 v0=0.01 v1=1 /')
    call refused_with(check, 'friction.v0=-1', 'x.nml: &friction v0 = -1: must be >= 0 (m/s)', &
                      '&friction coefficient=0.1 v1=1 /')
    call refused_with(check, 'friction.coefficient=-1', 'x.nml: &friction coefficient = -1: must be >= 0', &
                      '&friction v0=0.1 v1=1 /')
    call refused(check, bodies//run//'&joint kind=''clearance'' clearance=1e-5 bearing_radius=.01 bearing_length=.01 /'// &
                 '&lubrication viscosity=1 / &friction coefficient=0 v0=0 v1=0 /', &
                 'x.nml: &friction law: needs the group contact: dry friction follows the normal force')
  end subroutine test_joint

  subroutine test_films(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: film = '&lubrication viscosity=0.01 /'
    character(len=*), parameter :: long = 'joint.bearing_length=0.015'
    call refused(check, whole//film, 'x.nml: &joint bearing_length: required with lubrication (m)')
    call accepted(check, whole//film, 'a film', [long])
    call refused_on(check, whole//film, [character(len=40) :: long, 'lubrication.viscosity=0'], &
                    'x.nml: &lubrication viscosity = 0: must be > 0 (Pa s)')
    call refused_on(check, whole//film, [character(len=40) :: long, 'lubrication.law=oscillating_film'], &
                    'x.nml: &lubrication kinematic_viscosity: required with law = ''oscillating_film'' (m^2/s)')
    call refused_on(check, whole//film, [character(len=40) :: long, 'lubrication.variant=bearing_frame'], &
                    'x.nml: &lubrication variant = bearing_frame: must be one of closed_form, as_printed, half_film for '// &
                    'pinkus_sternlicht')
    call refused_on(check, whole//film, [character(len=40) :: long, 'lubrication.law=oscillating_film', &
                    'lubrication.kinematic_viscosity=1', 'lubrication.variant=half_film'], &
                    'x.nml: &lubrication variant = half_film: must be one of bearing_frame, as_printed for oscillating_film')
  end subroutine test_films

  !> Groups for the crank pin: read, chosen, resolved, refused.
  subroutine test_places(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: second = '&joint place=''crank_pin'' kind=''clearance'' clearance=1e-4 '// &
      'bearing_radius=0.012 /'//n
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=40) :: none(0)
    character(len=:), allocatable :: text, again
    call parse_case(whole//second, 'x.nml', none, c, error, text)
    call check%that(.not. allocated(error), 'a second joint')
    if (allocated(error)) return
    call check%that(c%joints(piston_pin)%has_clearance() .and. c%joints(crank_pin)%has_clearance(), 'both have clearance')
    call check%relative(c%joints(piston_pin)%clearance, 5e-4_dp, 0.0_dp, 'clearance of the piston pin')
    call check%relative(c%joints(crank_pin)%clearance, 1e-4_dp, 0.0_dp, 'clearance of the crank pin')
    call check%equal_text(trim(c%joints(crank_pin)%contact%name), 'lankarani_nikravesh', &
      'a law without a place holds for every joint')
    call parse_case(text, 'x.nml', none, c, error, again)
    call check%equal_text(again, text, 'two joints resolved again')
    call parse_case(whole//second//'&contact place=''CRANK_PIN'' law=''hertz'' /', 'x.nml', none, c, error, text)
    call check%that(.not. allocated(error), 'a law of one joint is read')
    if (allocated(error)) return
    call check%equal_text(trim(c%joints(crank_pin)%contact%name), 'hertz', 'a law of the crank pin holds there')
    call check%equal_text(trim(c%joints(piston_pin)%contact%name), 'lankarani_nikravesh', &
      'a law of the crank pin does not hold at the piston pin')
    call parse_case(text, 'x.nml', none, c, error, again)
    call check%equal_text(again, text, 'two joints and laws resolved again')
    call parse_case(whole, 'x.nml', [character(len=40) :: 'crank_pin.joint.kind=clearance', &
                                     'crank_pin.joint.clearance=2e-5', 'crank_pin.joint.bearing_radius=0.01', &
                                     'crank_pin.contact.law=hertz'], c, error)
    call check%that(.not. allocated(error), 'a second joint by overrides')
    call check%relative(c%joints(crank_pin)%clearance, 2e-5_dp, 0.0_dp, 'clearance by an override')
    call parse_case(whole//second, 'x.nml', [character(len=40) :: 'crank_pin.joint=none'], c, error)
    call check%that(.not. allocated(error) .and. .not. c%joints(crank_pin)%has_clearance(), 'the second joint can be removed')
    call check%that(.not. allocated(c%joints(crank_pin)%contact), 'an ideal joint has no laws')
    call parse_case(whole//second, 'x.nml', [character(len=40) :: 'joint=none'], c, error)
    call check%that(.not. allocated(error) .and. .not. allocated(c%joints(piston_pin)%contact), &
      'a case with clearance at the crank pin only')
    call refused(check, whole//second//second, 'x.nml:9: &joint of crank_pin: this group is given twice')
    call refused(check, whole//'&joint place=''piston_pin'' kind=''ideal'' /', 'x.nml:8: &joint: this group is given twice')
    call refused(check, '&joint place=''wrist'' /', &
      'x.nml:1: &joint place = wrist: must be one of piston_pin, small_end, crank_pin, main_bearing')
    call refused(check, '&joint place=''crank_pin'' place=''crank_pin'' /', 'x.nml:1: &joint place = crank_pin: given twice')
    call refused(check, '&drive place=''crank_pin'' /', 'x.nml:1: &drive place: unknown key (allowed: kind, torque, damping, '// &
      'flywheel_inertia, torque_table, torque_table_digest, ramp_time, ramp_from)')
    call refused(check, whole//'&contact place=''crank_pin'' /', 'x.nml: &joint of crank_pin kind: must be clearance '// &
                 '(or quasi_static) with contact, friction or lubrication: an ideal joint has no clearance; remove these '// &
                 'groups, for '// &
                 'example with --set contact=none')
    call refused(check, whole//'&friction law=''coulomb'' coefficient=0.1 /'//n//'&joint place=''main_bearing'' '// &
      'kind=''clearance'' clearance=1e-4 bearing_radius=0.012 /', 'x.nml:9: &joint of main_bearing kind = clearance: must be '// &
      'ideal or quasi_static: the crank turns about a fixed axis')
    call refused(check, whole//'&joint place=''crank_pin'' kind=''clearance'' clearance=1e-4 /', &
                 'x.nml: &joint of crank_pin bearing_radius: required with kind = ''clearance'' (m)')
    call refused_on(check, whole//second, ['crank_pin.joint.clearance=0.2'], &
                    'x.nml: &joint of crank_pin clearance = 0.2: must be < bearing_radius = 0.012: the pin''s radius is the '// &
                    'difference (m): millimetres?')
    call refused_on(check, whole//second, ['mechanism.rod_inertia=0'], &
                    'x.nml: &mechanism rod_inertia = 0: must be > 0 with clearance at the crank pin (kg m^2)')
    call refused_on(check, whole//second, ['initial.crank_pin_eccentricity=0.012,0'], 'x.nml: &initial '// &
                    'crank_pin_eccentricity(1) = 0.012: must be shorter than bearing_radius = 0.012: the pin would '// &
                    'leave its bearing (m): millimetres?')
    call accepted(check, whole//second, 'a crank pin that starts in contact', ['initial.crank_pin_eccentricity=1.1e-4,0'])
    call refused_on(check, whole//second//'&lubrication viscosity=0.01 /', [character(len=40) :: 'joint.bearing_length=0.01'], &
                    'x.nml: &joint of crank_pin bearing_length: required with lubrication (m)')
    call refused_on(check, whole//second, ['crank_pin.contact=none'], 'x.nml: --set crank_pin.contact=none: no group of the '// &
                    'crank pin alone is given: the group contact is for all pins, and --set contact=none removes it from all')
    call accepted(check, whole//second, 'a group of the crank pin alone taken out', &
                  [character(len=40) :: 'crank_pin.contact.law=hertz', 'crank_pin.contact=none'])
    call refused_on(check, whole//second, [character(len=40) :: 'contact=none', 'crank_pin.contact.law=hertz'], &
                    'x.nml:5: &joint kind = clearance: needs contact or lubrication: without them no force would act on the pin')
  end subroutine test_places

  !> Overrides of a group that the case has for all joints or for single ones: the text of the case written out by hand is what
  !> they must give, and a key that would act elsewhere is refused.
  subroutine test_groups_of_one_joint(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: second = '&joint place=''crank_pin'' kind=''clearance'' clearance=1e-4 '// &
      'bearing_radius=0.012 bearing_length=0.02 /'//n, own = '&contact place=''crank_pin'' law=''hertz'' /'//n, &
      film = 'law=''finite_bearing'' variant=''short'' oil=''SAE 30'' temperature=', &
      length = 'joint.bearing_length=0.015', hot = 'crank_pin.lubrication.temperature=370'
    character(len=*), parameter :: alone = bodies//second//own//run
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text, written, again
    call refused_on(check, alone, ['contact.law=exact'], 'x.nml: --set contact.law=exact: &contact: the case has this group '// &
      'for crank_pin: write crank_pin.contact.law')
    call refused_on(check, alone, ['contact=none'], 'x.nml: --set contact=none: &contact: the case has this group for '// &
      'crank_pin: write crank_pin.contact=none')
    call refused_on(check, alone, ['joint.clearance=2e-5'], 'x.nml: --set joint.clearance=2e-5: &joint: the case has this '// &
      'group for crank_pin: write crank_pin.joint.clearance')
    call refused_on(check, whole//second//own//'&friction place=''piston_pin'' law=''coulomb'' coefficient=0.1 /'//n// &
      '&friction place=''crank_pin'' law=''coulomb'' coefficient=0.1 /', ['friction.coefficient=0'], &
      'x.nml: --set friction.coefficient=0: &friction: the case has this group for piston_pin and crank_pin: write '// &
      'piston_pin.friction.coefficient or crank_pin.friction.coefficient')
    call refused_on(check, whole, [character(len=40) :: 'piston_pin.contact.law=hertz', 'contact.restitution=0.5'], &
      'x.nml: --set contact.restitution=0.5: &contact: the case has this group for piston_pin: write '// &
      'piston_pin.contact.restitution')
    call accepted(check, whole//second//own, 'a law for all joints that one joint follows', ['contact.restitution=0.5'])
    call accepted(check, alone, 'a further joint', [character(len=40) :: 'joint.kind=clearance', 'joint.clearance=1e-5', &
      'joint.bearing_radius=0.01', 'piston_pin.contact.law=hertz'])
    call refused_on(check, bodies//run, ['joint.bearing_radius=0.01'], 'x.nml: &joint bearing_radius = 0.01: needs kind = '// &
      '''clearance''; the default is ideal (m)')
    call parse_case(whole//second//'&lubrication '//film//'355 /', 'x.nml', [character(len=40) :: length, hot], c, error, text)
    call check%that(.not. allocated(error), 'a key of one joint beside a group for all joints')
    call parse_case(whole//second//'&lubrication '//film//'355 /'//n//'&lubrication place=''crank_pin'' '//film//'370 /', 'x.nml', &
      [length], c, error, written)
    call check%equal_text(text, written, 'a group of one joint begins with the values for all joints')
    call parse_case(bodies//second//own//run//'&lubrication '//film//'355 /', 'x.nml', [hot], c, error, text)
    call check%that(.not. allocated(error), 'a group for all joints gives way to one that has its values')
    call parse_case(alone//'&lubrication place=''crank_pin'' '//film//'370 /', 'x.nml', ['output.digits=10'], c, error, written)
    call parse_case(text, 'x.nml', ['output.digits=10'], c, error, again)
    call check%equal_text(again, written, 'it is not in the resolved case, which is read back')
  end subroutine test_groups_of_one_joint

  subroutine test_runs(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: still = 'initial.crank_speed=0   ', ends = 'integrator.end_time=1   '
    call refused_with(check, 'integrator.revolutions=0', &
                      'x.nml: &integrator revolutions = 0: this or crank_revolutions or end_time is required, > 0')
    call refused_with(check, 'integrator.revolutions=-1', 'x.nml: &integrator revolutions = -1: must be > 0')
    call refused_with(check, still, 'x.nml:7: &integrator revolutions = 2: needs crank_speed other than 0; give end_time'// &
                      at_rest)
    call refused_on(check, bodies, [still, ends], at_rest(len(n) + 1:))
    call accepted(check, bodies, 'a run from rest', [still, ends, 'output.interval=0.01    '])
    call refused_on(check, bodies, [character(len=24) :: ends, 'output.start_time=1'], &
                    'x.nml: &output start_time = 1: must be before the end of the run at 1 (s)')
    call refused_with(check, 'output.start_time=1', &
                      'x.nml: &output start_time = 1: must be before the end of the run at 0.125664 (s)')
    call refused_on(check, bodies, [character(len=32) :: 'integrator.crank_revolutions=2', 'drive.kind=constant_speed', &
                    'output.start_time=1'], &
                    'x.nml: &output start_time = 1: must be before the end of the run at 0.125664 (s)')
    call accepted(check, bodies, 'rows from a time on that a free crank may reach', [character(len=32) :: &
                  'integrator.crank_revolutions=2', 'output.start_time=1'])
    call test_film_times(check)
    call refused_with(check, 'output.interval=1e-20', 'x.nml: &output interval = 1e-20: asks for 1.3e19 rows in 0.125664 s: '// &
                      'at most 1e9 are written (s)')
    call refused_with(check, 'output.digits=8', 'x.nml: &output digits = 8: must be >= 9 and <= 17')
    call refused_with(check, 'output.digits=18', 'x.nml: &output digits = 18: must be >= 9 and <= 17')
    call refused_with(check, 'output.columns=time[s]', 'x.nml: &output columns = time[s]: must be ''standard'' or names of '// &
                      'columns without their units')
    call refused_with(check, 'integrator.contact_entry=step_rejection', 'x.nml: &integrator max_penetration: must be > 0 '// &
                      'for contact_entry = ''step_rejection'' (m)')
  end subroutine test_runs

  !> The last override of a key for the end of a run is used, also in the resolved case; two such keys in one place are an error.
  subroutine test_ends_of_runs(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: both = '&integrator end_time = 1: must not be given together with revolutions = '
    character(len=*), parameter :: remedy = '; integrator.revolutions=0 takes that back'
    character(len=*), parameter :: timed = bodies//'&integrator end_time=0.5 /'
    call resolves(check, whole, ['integrator.end_time=1'], 'revolutions = 0.0', 'end_time = 1.0')
    call resolves(check, timed, ['integrator.revolutions=3'], 'revolutions = 3.0', 'end_time = 0.0')
    call resolves(check, timed, [character(len=30) :: 'integrator.revolutions=3', 'integrator.revolutions=0'], &
                  'revolutions = 0.0', 'end_time = 0.5')
    call resolves(check, timed, [character(len=40) :: 'integrator.revolutions=3', 'integrator.relative_tolerance=1e-5', &
                                 'integrator.revolutions=4'], 'revolutions = 4.0', 'end_time = 0.0')
    call resolves(check, whole, ['integrator.end_time=0'], 'revolutions = 2.0', 'end_time = 0.0')
    call resolves(check, bodies//'&integrator end_time=0.5 revolutions=2 /', ['integrator.end_time=0.25'], &
                  'revolutions = 0.0', 'end_time = 0.25')
    call resolves(check, bodies, [character(len=30) :: 'integrator.revolutions=3', 'integrator.end_time=1', &
                                  'integrator.revolutions=0'], 'revolutions = 0.0', 'end_time = 1.0')
    call refused_on(check, whole, [character(len=30) :: 'integrator.end_time=1', 'integrator.revolutions=1'], &
                    'x.nml: '//both//'1'//remedy)
    call refused_on(check, timed, [character(len=30) :: 'integrator.revolutions=7', 'integrator.end_time=1'], &
                    'x.nml: '//both//'7'//remedy)
    call refused(check, bodies//'&integrator revolutions=2.0 end_time=1 /', 'x.nml:5: '//both//'2.0'//remedy)
    call refused_with(check, 'integrator.end_time=-1', 'x.nml: &integrator end_time = -1: must be > 0 (s)')
    call refused_on(check, timed, [character(len=30) :: 'integrator.end_time=0'], &
                    'x.nml: &integrator revolutions: this or crank_revolutions or end_time is required, > 0')
    call test_turns(check)
    call test_sampling(check)
    call test_periods(check)
  end subroutine test_ends_of_runs

  !> Times of pressure fields: a list of numbers, or first:last:count, within the run.
  subroutine test_film_times(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: filmed = whole//'&lubrication viscosity=0.01 /', length = 'joint.bearing_length=0.01', &
      key = 'output.film_times=', message = 'x.nml: &output film_times = '
    character(len=12), parameter :: wrong(*) = [character(len=12) :: '1e-3 2e-3', ',1e-3', '1e-3,', '1e-3,,2e-3', '1-3', &
      '2e-3,1e-3', '0:1e-3:3:7', '0:1e-3:3 4', '0:1e-3:3,', '0::3', '0:1e-3:2.5', '0:1e-3:1', '1e-3:0:3', '-1e-3', &
      '1..e-3', '1e', '.', '2*1e-3']
    character(len=12), parameter :: right(*) = [character(len=12) :: '0', '.5e-3 , 1D-3', '+1.e-3', '0:1e-3:3', '0 : 1e-3 : 3', &
      '1q-3']
    integer :: i
    do i = 1, size(wrong)
      call refused_on(check, filmed, [character(len=32) :: length, key//wrong(i)], message//trim(wrong(i))// &
                      ': must be times >= 0 in rising order with commas, or from:to:count')
    end do
    do i = 1, size(right)
      call accepted(check, filmed, 'film_times = '//right(i), [character(len=32) :: length, key//right(i)])
    end do
    call refused_on(check, filmed, [character(len=32) :: length, key//'0,1'], message// &
                    '0,1: must not be after the end of the run at 0.125664 s')
    call refused_on(check, filmed, [character(len=32) :: length, key//'0:1:3'], message// &
                    '0:1:3: must not be after the end of the run at 0.125664 s')
  end subroutine test_film_times

  !> Runs until the motion repeats.
  subroutine test_periods(check)
    class(checks_t), intent(inout) :: check
    character(len=40), parameter :: until = 'run.until=periodic', window = 'output.window=last_period'
    call accepted(check, bodies, 'a run without another end than a periodic motion', [character(len=40) :: until])
    call refused_on(check, whole, [character(len=40) :: until, 'initial.crank_speed=0'], &
                    'x.nml: &run until = periodic: needs crank_speed other than 0'//at_rest)
    call refused_on(check, whole, [character(len=40) :: window], &
                    'x.nml: &output window = last_period: is for &run until = ''periodic'' alone')
    call refused_on(check, whole, [character(len=40) :: until, window, 'run.most_revolutions=16'], &
                    'x.nml: &run most_revolutions = 16: must be > period_revolutions with window = ''last_period''')
    call refused_on(check, whole, [character(len=40) :: until, window, 'output.start_time=1e-3'], &
                    'x.nml: &output start_time = 1e-3: must be 0 with window = ''last_period'' (s)')
    call refused_on(check, whole, [character(len=40) :: 'run.period_revolutions=17'], &
                    'x.nml: &run period_revolutions = 17: must be >= 1 and <= 16')
    call refused_on(check, whole, [character(len=40) :: 'run.periodic_tolerance=0'], &
                    'x.nml: &run periodic_tolerance = 0: must be > 0 and <= 0.1')
    call refused_on(check, bodies//'&integrator end_time=1 /', [character(len=40) :: 'run.lyapunov_revolutions=10', &
                    'drive.kind=constant_speed'], &
                    'x.nml: &run lyapunov_revolutions = 10: needs crank_speed other than 0, and clearance at a joint or a '// &
                    'free crank')
    call refused_on(check, whole, [character(len=40) :: until, 'run.most_revolutions=1000000', &
                    'output.samples_per_revolution=2000'], &
                    'x.nml: &output samples_per_revolution = 2000: asks for 2e9 rows in 62831.9 s: at most 1e9 are written')
  end subroutine test_periods

  !> Rows by crank angle.
  subroutine test_sampling(check)
    class(checks_t), intent(inout) :: check
    character(len=40), parameter :: by_angle = 'output.sampling=crank_angle'
    call accepted(check, whole, 'rows at crank angles', [character(len=40) :: by_angle, 'output.angle_origin_deg=-12.5'])
    call accepted(check, bodies//'&integrator end_time=1 /', 'rows at crank angles of a crank from rest', &
                  [character(len=40) :: by_angle, 'initial.crank_speed=0'])
    call refused_on(check, whole, [character(len=40) :: by_angle, 'output.interval=1e-3'], &
                    'x.nml: &output interval = 1e-3: must not be given with sampling = ''crank_angle'' (s)')
    call refused_on(check, whole, [character(len=40) :: by_angle, 'output.every_step=T'], &
                    'x.nml: &output every_step = T: must be .false. with sampling = ''crank_angle''')
    call refused_on(check, whole, [character(len=40) :: 'output.angle_origin_deg=3'], &
                    'x.nml: &output angle_origin_deg = 3: is for sampling = ''crank_angle'' alone (degrees)')
    call refused_on(check, whole, [character(len=40) :: 'output.sampling=angle'], &
                    'x.nml: --set output.sampling=angle: &output sampling = angle: must be one of time, crank_angle')
  end subroutine test_sampling

  !> End of a run after a number of revolutions: end_time is allowed together with crank_revolutions, revolutions is not. An
  !> override replaces another end in the file, unless the file gives both.
  subroutine test_turns(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: turned = bodies//'&integrator crank_revolutions=4 /', &
      bounded = bodies//'&integrator crank_revolutions=4 end_time=0.5 /', timed = bodies//'&integrator end_time=0.5 /', &
      still = 'initial.crank_speed=0', held = 'drive.kind=constant_speed'
    call resolves(check, whole, ['integrator.crank_revolutions=3'], 'revolutions = 0.0', 'crank_revolutions = 3.0')
    call resolves(check, turned, ['integrator.revolutions=3'], 'revolutions = 3.0', 'crank_revolutions = 0.0')
    call resolves(check, turned, ['integrator.end_time=2'], 'crank_revolutions = 0.0', 'end_time = 2.0')
    call resolves(check, timed, ['integrator.crank_revolutions=3'], 'crank_revolutions = 3.0', 'end_time = 0.0')
    call resolves(check, bounded, ['integrator.end_time=2'], 'crank_revolutions = 4.0', 'end_time = 2.0')
    call resolves(check, bounded, ['integrator.crank_revolutions=3'], 'crank_revolutions = 3.0', 'end_time = 0.5')
    call resolves(check, bounded, ['integrator.revolutions=3'], 'crank_revolutions = 0.0', 'end_time = 0.0')
    call resolves(check, timed, [character(len=40) :: 'integrator.crank_revolutions=3', 'integrator.end_time=1'], &
                  'crank_revolutions = 3.0', 'end_time = 1.0')
    call refused(check, bodies//'&integrator crank_revolutions=4 revolutions=4 /', &
                 'x.nml:5: &integrator crank_revolutions = 4: '// &
                 'must not be given together with revolutions = 4; integrator.revolutions=0 takes that back')
    call refused_on(check, turned, [character(len=40) :: still], 'x.nml:5: &integrator crank_revolutions = 4: needs end_time '// &
                    'beside it with crank_speed = 0: the latest end, should the crank not make them'//at_rest)
    call refused_on(check, bounded, [character(len=40) :: still, held], 'x.nml:5: &integrator crank_revolutions = 4: needs '// &
                    'crank_speed other than 0: the crank is held at rest'//at_rest)
    call refused_on(check, bounded, [character(len=40) :: held, 'initial.crank_speed=-10'], &
                    'x.nml:5: &integrator end_time = 0.5: must be >= 2.51327 s, when the held crank has made crank_revolutions (s)')
    call accepted(check, bounded, 'a free crank with end_time before the end of its revolutions', [character(len=40) :: &
                  'initial.crank_speed=10'])
    call refused_on(check, turned, [character(len=40) :: 'output.interval=1e-20'], 'x.nml: &output interval = 1e-20: asks for '// &
                    '2.5e19 rows in 0.251327 s: at most 1e9 are written (s)')
  end subroutine test_turns

  !> A case with overrides is accepted, and its resolved form begins with the two given lines.
  subroutine resolves(check, text, overrides, first, second)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: text, overrides(:), first, second
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=:), allocatable :: resolved
    call parse_case(text, 'x.nml', overrides, c, error, resolved)
    call check%that(.not. allocated(error), 'accepted with '//trim(overrides(1)))
    if (allocated(error)) return
    call check%that(index(resolved, n//'  '//first) > 0, first//' after '//trim(overrides(size(overrides))))
    call check%that(index(resolved, n//'  '//second) > 0, second//' after '//trim(overrides(size(overrides))))
  end subroutine resolves

  !> GROUP=none: the group is removed as if neither the file nor earlier overrides had it; later overrides begin with its defaults.
  subroutine test_groups_taken_out(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: film = '&lubrication viscosity=0.01 variant=''half_film'' /'//n// &
      '&friction law=''coulomb'' coefficient=0.3 /'//n//'&drive kind=''constant_speed'' /'
    character(len=*), parameter :: long = 'joint.bearing_length=0.015'
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=:), allocatable :: resolved
    call parse_case(whole//film, 'x.nml', [character(len=30) :: 'Lubrication = NONE', 'drive=none'], c, error, resolved)
    call check%that(.not. allocated(error), 'groups can be removed')
    call check%that(.not. allocated(c%joints(piston_pin)%film), 'the film is removed')
    call check%that(allocated(c%joints(piston_pin)%friction) .and. allocated(c%joints(piston_pin)%contact), &
      'no other group is removed')
    call check%equal_text(trim(c%drive%kind), 'free', 'a group that always exists gets its defaults')
    call check%that(index(resolved, 'lubrication') == 0, 'a removed group is not in the resolved case')
    call parse_case(whole//film, 'x.nml', [character(len=30) :: long, 'lubrication.variant=as_printed', 'lubrication=none', &
                                           'lubrication.viscosity=0.02'], c, error, resolved)
    call check%that(.not. allocated(error), 'a later override creates the group again')
    call check%relative(element(parameter_of(c%joints(piston_pin)%film, 'viscosity'), 1), 0.02_dp, 1e-15_dp, &
      'a group created again has the value of the override')
    call check%that(index(resolved, 'variant = ''closed_form''') > 0, 'a group created again has no earlier values')
    call parse_case(whole//film, 'x.nml', [character(len=30) :: 'joint=none', 'contact=none', 'friction=none', &
                                           'lubrication=none'], c, error)
    call check%that(.not. allocated(error), 'a case without a joint group is read')
    call check%equal_text(trim(c%joints(piston_pin)%kind), 'ideal', 'a case without a joint group has an ideal joint')
    call refused_with(check, 'joint=none', 'x.nml: &joint kind: must be clearance (or quasi_static) with contact, friction or '// &
                      'lubrication: an ideal joint has no clearance; remove these groups, for example with --set contact=none')
    call refused_with(check, 'contact=none', 'x.nml:5: &joint kind = clearance: needs contact or lubrication: without '// &
                      'them no force would act on the pin')
    call refused_on(check, whole//film, [character(len=40) :: long, 'friction.coefficient=0.1', 'friction=none', &
                                         'friction.v0=1'], &
                    'x.nml: &friction coefficient: required'//n//'x.nml: &friction v1: required with law = ''ambrosio'' (m/s)')
    call refused_with(check, 'mechanism=none', 'x.nml: &mechanism: this group is required')
    call refused_with(check, 'integrator=none', &
                      'x.nml: &integrator revolutions: this or crank_revolutions or end_time is required, > 0')
    call refused_with(check, 'contakt=none', &
                      'x.nml: --set contakt=none: &contakt: unknown group; did you mean contact?'//all_groups)
    call refused_with(check, 'contact=off', 'x.nml: --set contact=off: must have the form GROUP.KEY=VALUE or GROUP=none')
    call parse_case(whole, 'x.nml', ['contact.law=none'], c, error)
    call check%that(allocated(error), 'none is not the name of a law')
    if (allocated(error)) call check%that(index(error%message, '; --set contact=none takes the group out') > 0, &
      'a hint if none is given as a law')
  end subroutine test_groups_taken_out

  !> 0,05 instead of 0.05 is reported as a decimal comma, unless it is a pair of values.
  subroutine test_decimal_commas(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: c
    type(error_t), allocatable :: error
    call refused(check, '&joint clearance=0,05 /', 'x.nml:1: &joint clearance: 0,05 has a decimal comma: write 0.05')
    call refused(check, '&drive torque=-1,5D3 /', 'x.nml:1: &drive torque: -1,5D3 has a decimal comma: write -1.5D3')
    call refused(check, '&mechanism rod_com=0,06,0,01 /', 'x.nml:1: &mechanism rod_com: 0,06 has a decimal comma: write 0.06')
    call refused(check, '&mechanism rod_com=0,06 /', 'x.nml:1: &mechanism rod_com: 0,06 has a decimal comma: write 0.06')
    call refused_with(check, 'joint.clearance=0,00002', &
                      'x.nml: --set joint.clearance=0,00002: &joint clearance: 0,00002 has a decimal comma: write 0.00002')
    call refused(check, '&joint clearance=0, 05 /', 'x.nml:1: &joint clearance: takes 1 value, not 2')
    call refused(check, '&joint clearance=1.0,05 /', 'x.nml:1: &joint clearance: takes 1 value, not 2')
    call refused(check, '&mechanism rod_com=1,2,3 /', 'x.nml:1: &mechanism rod_com: takes 2 values, not 3')
    call parse_case(whole, 'x.nml', [character(len=30) :: 'mechanism.rod_com=0,5', 'mechanism.crank_com=1,0', &
                                     'contact.poissons_ratio=0,0.05'], c, error)
    call check%that(.not. allocated(error), 'two values with a comma')
    if (allocated(error)) return
    call check%that(abs(c%mechanism%rod_com(2) - 5) < 1e-15_dp .and. abs(c%mechanism%crank_com(1) - 1) < 1e-15_dp, &
      'two values with a comma are two values')
  end subroutine test_decimal_commas

  !> Characters of word processors and of other encodings are named; a value that cannot be read is refused once.
  subroutine test_typography(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: general = char(226)//char(128)
    call refused(check, '&joint kind='//general//char(152)//'ideal'//general//char(153)//' /', 'x.nml:1: &joint kind: '// &
      general//char(152)//'ideal'//general//char(153)//' has a typographic quotation mark: write '' or "')
    call refused(check, '&joint clearance=1e'//general//char(147)//'4 /', &
      'x.nml:1: &joint clearance: 1e'//general//char(147)//'4 has a dash: write -')
    call refused(check, '&drive torque='//char(226)//char(136)//char(146)//'4 /', &
      'x.nml:1: &drive torque: '//char(226)//char(136)//char(146)//'4 has a minus sign of typography: write -')
    call refused(check, '&joint clearance=20 '//char(181)//'m /', &
      'x.nml:1: &joint clearance: \xB5m: not UTF-8: save the file in this encoding')
    call refused_with(check, 'integrator.max_order=1.5', &
      'x.nml: --set integrator.max_order=1.5: &integrator max_order = 1.5: must be a whole number')
    call refused_with(check, 'mechanism.rod_mass=0,21', &
      'x.nml: --set mechanism.rod_mass=0,21: &mechanism rod_mass: 0,21 has a decimal comma: write 0.21')
  end subroutine test_typography

  !> A study file is not a case file; a torque without effect is reported.
  subroutine test_hints(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: c
    type(error_t), allocatable :: error
    call refused(check, n//'&study case=''y.nml'' /', 'x.nml:2: &study: a study, not a case: run it with gudgeon sweep x.nml')
    call refused(check, '&parameter key=''a.b'' /', 'x.nml:1: &parameter: a study, not a case: run it with gudgeon sweep x.nml')
    call parse_case(whole, 'x.nml', [character(len=30) :: 'drive.torque=1', 'drive.kind=constant_speed'], c, error)
    call check%that(allocated(c%notes), 'torque on a crank that is held')
    call parse_case(whole, 'x.nml', [character(len=30) :: 'drive.torque=1'], c, error)
    call check%that(.not. allocated(c%notes), 'torque on a free crank')
    call parse_case(whole, 'x.nml', [character(len=30) :: 'drive.kind=constant_speed', 'drive.damping=1'], c, error)
    call check%that(.not. allocated(c%notes), 'no torque on a crank that is held')
  end subroutine test_hints

  !> Every error of a case is reported, in the order of the file, and none that only follows from another one.
  subroutine test_several_errors(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: wrong = '&mechanism crank_length=0.05, crank_mass=0.3, crank_inertia=1d-5 rod_length=0.12'//n// &
      'rod_mass=-1 rod_inertia=2.5E-4 piston_mass=0.14 /'//n//'&initial crank_sped=100 /'//n//'&friction coefficient=abc v0=0 /'
    character(len=1) :: none(0)
    character(len=:), allocatable :: text
    type(case_t) :: c
    type(error_t), allocatable :: error
    integer :: i
    call refused_on(check, wrong, [character(len=40) :: 'joint.clearance=twenty', 'output.digits=99'], &
      'x.nml:2: &mechanism rod_mass = -1: must be >= 0 (kg)'//n// &
      'x.nml:3: &initial crank_sped: unknown key; did you mean crank_speed? (allowed: crank_angle_deg, crank_speed, '// &
      'eccentricity, '// &
      'eccentricity_rate, small_end_eccentricity, small_end_eccentricity_rate, crank_pin_eccentricity, '// &
      'crank_pin_eccentricity_rate, main_bearing_eccentricity, pin_speed, piston_offset, '// &
      'piston_offset_rate, piston_tilt, '// &
      'piston_tilt_rate, from, goes_on)'//n//'x.nml:4: &friction coefficient = abc: must be a number'//n// &
      'x.nml: --set joint.clearance=twenty: &joint clearance = twenty: must be a number (m)'//n// &
      'x.nml: &output digits = 99: must be >= 9 and <= 17'//n//'x.nml: &friction v1: required with law = ''ambrosio'' (m/s)')
    call refused_on(check, whole//'&friction coefficient=-1 v0=0 v1=1 /', &   ! values and rules
      [character(len=40) :: 'joint.clearance=20', 'mechanism.rod_length=0.05'], &
      'x.nml:8: &friction coefficient = -1: must be >= 0'//n// &
      'x.nml: &joint clearance = 20: must be < bearing_radius = 0.01: the pin''s radius is the difference (m): micrometres?'//n// &
      'x.nml: &mechanism rod_length = 0.05: must be > crank_length = 0.05 (m)')
    call refused(check, whole//'&output digits=5 /'//n//'&friction coefficient=,', &   ! a mistake in the syntax
      'x.nml:8: &output digits = 5: must be >= 9 and <= 17'//n// &
      'x.nml:9: &friction coefficient: a value is missing before the comma')
    call refused(check, whole//'&kontact / &lubrikation /', &
      'x.nml:8: &kontact: unknown group; did you mean contact?'//all_groups// &
      n//'x.nml:8: &lubrikation: unknown group; did you mean lubrication?'//all_groups)
    call refused(check, whole(:index(whole, 'rod_length') - 1)//'rod_lenght'//whole(index(whole, 'rod_length') + 10:), &
      'x.nml:2: &mechanism rod_lenght: unknown key; did you mean rod_length? (allowed: crank_length, crank_mass, '// &
      'crank_inertia, crank_com, rod_length, rod_mass, rod_inertia, rod_com, piston_mass, axis_offset, gravity, gravity_angle_deg)')
    text = whole//'&output '
    do i = 1, 30
      text = text//repeat('x', i)//'=1 '
    end do
    call parse_case(text//'/', 'x.nml', none, c, error)
    call check%that(index(error%message, n//'and 10 more errors') > 0, 'the number of further errors is reported')
  end subroutine test_several_errors

  !> Misspelt groups, places, keys, words and names of laws get a suggestion.
  subroutine test_likely_words(check)
    class(checks_t), intent(inout) :: check
    call refused_with(check, 'crankpin.joint.kind=ideal', 'x.nml: --set crankpin.joint.kind=ideal: &crankpin.joint: unknown '// &
      'group; did you mean crank_pin.joint?'//all_groups)
    call refused_with(check, 'contact.law=lankarani', 'x.nml: --set contact.law=lankarani: &contact law = lankarani: '// &
      'must be one of '//laws//'; did you mean lankarani_nikravesh?')
    call refused_with(check, 'contact.law=herz', 'x.nml: --set contact.law=herz: &contact law = herz: must be one of '//laws// &
      '; did you mean hertz?')
    call refused_with(check, 'drive.kind=constantspeed', 'x.nml: --set drive.kind=constantspeed: &drive kind = constantspeed: '// &
      'must be one of free, constant_speed; did you mean constant_speed?')
    call refused(check, whole//'&joint place=''crankpin'' /', 'x.nml:8: &joint place = crankpin: must be one of piston_pin, '// &
      'small_end, crank_pin, main_bearing; did you mean crank_pin?')
    call refused(check, whole//'&output tolerance=1 /', 'x.nml:8: &output tolerance: unknown key (allowed: sampling, '// &
      'samples_per_revolution, angle_origin_deg, interval, start_time, columns, digits, film_times, every_step, '// &
      'answers, ideal_twin, window)')
  end subroutine test_likely_words

  !> Paths that are not case files, and one that is.
  subroutine test_files(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: folder = 'build/test_case_file'
    type(result_file_t) :: file
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=1) :: none(0)
    integer :: status
    call make_directory(folder, status)
    call read_case(folder//'/none.nml', none, c, error)
    call expect(check, error, folder//'/none.nml: No such file or directory')
    call read_case(folder, none, c, error)
    call expect(check, error, folder//': Is a directory')
    call read_case('/dev/zero', none, c, error)
    call expect(check, error, '/dev/zero: not a regular file')
    call file%open(folder//'/large.nml', error)
    call file%append(repeat('!'//repeat(' ', 98)//achar(10), 10001))
    call file%close(error)
    call read_case(folder//'/large.nml', none, c, error)
    call expect(check, error, folder//'/large.nml: larger than 1 MB: not a case file')
    call remove_file(folder//'/large.nml', status)
    call file%open(folder//'/y.nml', error)
    call file%append(whole)
    call file%close(error)
    call read_case(folder//'/y.nml', none, c, error)
    call check%that(.not. allocated(error), 'a case file is read')
    if (.not. allocated(error)) call check%equal_text(c%name, 'y', 'name of a case file')
    call remove_file(folder//'/y.nml', status)
    call execute_command_line('rmdir '//folder, exitstat=status)
    call check%that(status == 0, 'scratch folder removed')
  end subroutine test_files

  !> The shipped cases are read, and their resolved forms give the same cases.
  subroutine test_shipped_cases(check)
    class(checks_t), intent(inout) :: check
    character(len=28), parameter :: names(23) = [character(len=28) :: 'sim_I', 'sim_II', 'sim_III', 'sim_IV', 'sim_V', &
      'sim_VI', 'sim_I_oscillating', 'sim_II_oscillating', 'sim_III_oscillating', 'sim_IV_oscillating', &
      'sim_V_oscillating', 'sim_VI_oscillating', 'flores/dry_0500um', 'flores/dry_0100um', 'flores/dry_0010um', &
      'flores/friction_010', 'flores/friction_050', 'flores/friction_100', 'flores/lubricated_400cP', 'flores/ideal', &
      'joints/both_pins', 'joints/crank_pin', 'joints/both_pins_lubricated']
    type(case_t) :: c, back
    type(error_t), allocatable :: error
    character(len=1) :: none(0)
    character(len=:), allocatable :: written, text, again
    integer :: i
    text = ''
    do i = 1, size(names)
      call read_text_file('cases/'//trim(names(i))//'.nml', 1, 'case file', written, error)
      if (.not. allocated(error)) call parse_case(written, trim(names(i)), none, c, error, text)
      call check%that(.not. allocated(error), 'cases/'//trim(names(i))//'.nml is read')
      if (allocated(error)) cycle
      call parse_case(text, 'x', none, back, error, again)
      call check%equal_text(again, text, trim(names(i))//' resolved')
    end do
  end subroutine test_shipped_cases

  !> Messages are one printable line of limited length, whatever the file contains.
  subroutine test_safe_messages(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=1) :: none(0)
    call refused(check, '&joint clearance='//achar(27)//'[31m /', 'x.nml:1: &joint clearance = \x1B[31m: must be a number (m)')
    call refused(check, '&case title=''a'//achar(7)//''' /', 'x.nml:1: &case title = a\x07: must not contain control '// &
                 'characters or bytes that are not UTF-8')
    call refused(check, achar(0)//char(255), 'x.nml:1: text outside a group: \x00\xFF')
    call parse_case('&joint '//repeat('k', 5000)//'=1 /', repeat('p', 5000)//n//achar(27), none, c, error)
    call check%that(allocated(error), 'long names are refused')
    if (.not. allocated(error)) return
    call check%that(index(error%message, n) < 500, 'messages are short')
    call check%that(scan(error%message, achar(27)) == 0, 'no control characters in messages')
    call refused(check, whole//char(239)//char(187)//char(191)//'&', 'x.nml:8: text outside a group: '// &
                 '\xEF\xBB\xBF&; &integrator ends in line 7')
    call refused(check, 'a'//char(194)//char(160)//char(226)//char(128)//char(174)//char(195)//char(169), &
                 'x.nml:1: text outside a group: a\xC2\xA0\xE2\x80\xAE'//char(195)//char(169))
  end subroutine test_safe_messages

  !> A case is refused with exactly this message.
  subroutine refused(check, text, message)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: text, message
    character(len=1) :: none(0)
    call refused_on(check, text, none, message)
  end subroutine refused

  !> The plain case, optionally with more groups, is refused with one override.
  subroutine refused_with(check, override, message, more)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: override, message
    character(len=*), intent(in), optional :: more
    if (present(more)) then
      call refused_on(check, whole//more, [override], message)
    else
      call refused_on(check, whole, [override], message)
    end if
  end subroutine refused_with

  subroutine refused_on(check, text, overrides, message)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: text, overrides(:), message
    type(case_t) :: c
    type(error_t), allocatable :: error
    call parse_case(text, 'x.nml', overrides, c, error)
    if (allocated(error) .and. index(text, '&mechanism crank') == 0) &   ! groups that are missing come after what is tested
      error%message = error%message(:index(error%message//n, n) - 1)
    call expect(check, error, message)
  end subroutine refused_on

  subroutine accepted(check, text, name, overrides)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: text, name
    character(len=*), intent(in), optional :: overrides(:)
    type(case_t) :: c
    type(error_t), allocatable :: error
    character(len=1) :: none(0)
    if (present(overrides)) then
      call parse_case(text, 'x.nml', overrides, c, error)
    else
      call parse_case(text, 'x.nml', none, c, error)
    end if
    if (allocated(error)) then
      call check%equal_text(error%message, '', name)
    else
      call check%that(.true., name)
    end if
  end subroutine accepted

  subroutine expect(check, error, message)
    class(checks_t), intent(inout) :: check
    type(error_t), allocatable, intent(in) :: error
    character(len=*), intent(in) :: message
    call check%that(allocated(error), 'refused: '//message)
    if (.not. allocated(error)) return
    call check%equal_text(error%message, message, 'message')
    call check%that(error%status == status_case_file, 'status of '//message)
  end subroutine expect
end module test_case_file
