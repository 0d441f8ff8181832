!> Notes on implausible values and results: the mistakes of people who build engines and compressors, each with the note that tells
!> it.
module test_notes
  use kinds, only: dp
  use error_handling, only: error_t
  use model_parameters, only: real_kind
  use bearing_size, only: bearing_t
  use chain_motion, only: piston_pin
  use case_definition, only: case_t
  use case_file, only: read_case
  use case_schema, only: key_table_t, case_schema_of
  use simulation, only: run_report_t
  use film_history, only: film_history_t, film_duty_t
  use result_notes, only: notes_on_results, history_remarks
  use run_line, only: lines_for_user
  use text_tools, only: next_line
  use value_reader, only: read_bounds, read_real
  use unit_hints, only: likely_unit
  use cycle_watch, only: cycle_watch_t
  use run_length, only: longest_period
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_notes

  character(len=*), parameter :: newline = achar(10)

  !> A mistake: changes of a shipped case, and what its only note contains.
  type :: mistake_t
    character(len=22) :: file = ''
    character(len=200) :: changes = ''   !! separated by blanks
    character(len=150) :: note = ''
  end type mistake_t

  type(mistake_t), parameter :: mistakes(*) = [ &
    mistake_t('sim_IV', 'mechanism.rod_com=50.8,0', 'rod_com = 50.8 m lies outside the rod of 0.2032 m: millimetres?'), &
    mistake_t('sim_IV', 'mechanism.piston_mass=910', 'piston_mass = 910 kg is 296 times as much as a solid piston of steel'), &
    mistake_t('sim_I', 'mechanism.piston_mass=910', 'usually 0.002 to 12: grams?'), &
    mistake_t('flores/dry_0500um', 'mechanism.piston_mass=140', 'usually 0.002 to 12: grams?'), &
    mistake_t('sim_IV', 'joint.clearance=2e-3', 'clearance = 2e-3 m is 0.2 of bearing_radius = 0.01 m, usually 0.0001 to 0.1'), &
    mistake_t('sim_IV', 'initial.crank_speed=2387', 'is a mean piston speed of 77.2 m/s, usually up to 40: revolutions/min?'), &
    mistake_t('gas/compressor', 'initial.crank_speed=1450', 'mean piston speed of 36.9 m/s, usually up to 12: revolutions/min?'), &
    mistake_t('sim_IV', 'lubrication.viscosity=11.7', 'viscosity = 11.7 Pa s: usually 1e-4 to 1: mPa s (cP)?'), &
    mistake_t('sim_IV', 'lubrication.viscosity=1.38e-5', 'viscosity = 1.38e-5 Pa s: usually 1e-4 to 1: kinematic viscosity?'), &
    mistake_t('sim_IV_oscillating', 'lubrication.kinematic_viscosity=13.8', 'usually 1e-7 to 1e-3: mm^2/s (cSt)?'), &
    mistake_t('sim_IV_oscillating', 'lubrication.kinematic_viscosity=0.0117', 'usually 1e-7 to 1e-3: dynamic viscosity?'), &
    mistake_t('sim_IV', 'lubrication.viscosity_law=walther lubrication.viscosity=0 lubrication.temperature=353 '// &
      'lubrication.known_temperatures=313.15,373.15 lubrication.known_viscosities=100,11 lubrication.density=870', &
      'known_viscosities = 100 m^2/s: usually 1e-7 to 1e-2: mm^2/s (cSt)?'), &
    mistake_t('sim_IV', 'contact.youngs_modulus=2*207', 'youngs_modulus = 207 Pa: usually 1e8 to 1e12: GPa?'), &
    mistake_t('sim_IV', 'contact.youngs_modulus=2*207000', 'youngs_modulus = 207000 Pa: usually 1e8 to 1e12: MPa?'), &
    mistake_t('elastic/engine_rod', 'elastic_rod.youngs_modulus=207', 'youngs_modulus = 207 Pa: usually 1e9 to 1e12: GPa?'), &
    mistake_t('elastic/engine_rod', 'elastic_rod.section_area=300', 'section_area = 300 m^2'), &
    mistake_t('elastic/engine_rod', 'elastic_rod.section_inertia=15000', 'usually 0.001 to 20: mm^4?'), &
    mistake_t('sim_IV', 'contact.density=2*7.85', 'density = 7.85 kg/m^3: usually 500 to 2.5e4: g/cm^3?'), &
    mistake_t('sim_IV', 'joint.bearing_radius=0.020', &
      'is 0.286 of bore = 0.07 m, usually 0.04 to 0.26: the diameter instead of the radius?'), &
    mistake_t('sim_IV', 'mechanism.crank_length=0.09 joint.bearing_radius=0.050', &   ! with a crosshead
      'is 0.714 of bore = 0.07 m, usually 0.04 to 0.65: the diameter instead of the radius?'), &
    mistake_t('sim_IV', 'joint.bearing_radius=10', 'bearing_radius = 10 m is 131 of the room beside crank and rod'), &
    mistake_t('sim_IV', 'joint.bearing_length=15', &
      'is 750 of the diameter of the bearing, 0.02 m, usually 0.1 to 3: millimetres?'), &
    mistake_t('sim_IV', 'joint.clearance=0.004', 'is 0.4 of bearing_radius = 0.01 m, usually 0.0001 to 0.1: millimetres?'), &
    mistake_t('sim_IV', 'mechanism.rod_inertia=10000', 'usually 0.02 to 1.25: kg mm^2?'), &
    mistake_t('sim_IV', 'mechanism.rod_inertia=100', 'usually 0.02 to 1.25: kg cm^2?'), &
    mistake_t('sim_IV', 'mechanism.crank_inertia=6000', 'is 2.91e6 of crank_mass crank_length^2 = 0.00206451 kg m^2'), &
    mistake_t('flores/dry_0500um', 'mechanism.rod_inertia=1.006e-3', 'is 1.33 times that of the same mass in two points at the '// &
      'pins (0.000756 kg m^2), usually 0.02 to 1.25: about a pin instead'), &
    mistake_t('flores/dry_0500um', 'mechanism.crank_length=0.1', &
      'is 0.833 of rod_length = 0.12 m, usually up to 0.5: the stroke instead of its half?'), &
    mistake_t('sim_IV', 'mechanism.rod_com=0.1524,0', 'is 0.75 of rod_length = 0.2032 m from the crank pin, usually up to 0.6: '// &
      'measured from the piston pin?'), &
    mistake_t('sim_IV', 'mechanism.crank_com=25,0', 'crank_com = 25 m lies outside the crank of 0.0508 m: millimetres?'), &
    mistake_t('sim_IV', 'mechanism.rod_mass=1360', 'is 20.6 times as much as a cube of steel as long as the rod'), &
    mistake_t('sim_IV', 'mechanism.crank_mass=800', &
      'is 352 times as much as rod and piston (2.27 kg), usually up to 100: grams?'), &
    mistake_t('sim_IV', 'mechanism.rod_length=203.2', &
      'rod_length = 203.2 m is 4000 times crank_length = 0.0508 m, usually up to 20: millimetres?'), &
    mistake_t('sim_IV', 'mechanism.gravity=9806.65', 'gravity = 9806.65 m/s^2: usually 0.1 to 30: mm/s^2?'), &
    mistake_t('sim_IV', 'drive.flywheel_inertia=20000', 'usually up to 3000: kg mm^2?'), &
    mistake_t('sim_IV', 'combustion.heat=0.165', &
      'is 0.000422 J for each cm^3 of displacement (391.003 cm^3), usually 0.03 to 10: kJ?'), &
    mistake_t('sim_IV', 'combustion.bore=70', 'bore = 70 m is 689 of the stroke of 0.1016 m, usually 0.2 to 5: millimetres?'), &
    mistake_t('sim_IV', 'combustion.intake_pressure=1.01325', 'intake_pressure = 1.01325 Pa: usually 2e4 to 1e6: bar?'), &
    mistake_t('sim_IV', 'combustion.intake_pressure=101.3', 'intake_pressure = 101.3 Pa: usually 2e4 to 1e6: kPa?'), &
    mistake_t('sim_IV', 'combustion.crankcase_pressure=5000', 'usually 2e4 to 3e6: gauge pressure?'), &
    mistake_t('sim_IV', 'combustion.duration_deg=0.698', 'duration_deg = 0.698 degrees: usually 10 to 150: radians?'), &
    mistake_t('sim_IV', 'combustion.start_deg=200', 'start_deg = 200 degrees: usually 270 to 400'), &
    mistake_t('gas/compressor', 'combustion.dead_space=5', 'dead_space = 5: usually 5e-3 to 0.5: per cent?'), &
    mistake_t('sim_IV', 'friction.coefficient=3', 'coefficient = 3: usually 1e-3 to 1: per cent?'), &
    mistake_t('sim_IV', 'friction.v1=10', 'v1 = 10 m/s: usually 1e-6 to 1: mm/s?'), &
    mistake_t('sim_I', 'initial.eccentricity=2e-4,0', 'eccentricity = 2e-4 m is 10 of clearance = 2e-5 m, usually up to 1.2'), &
    mistake_t('joints/piston_slap', 'guide.piston_inertia=500', 'usually 0.01 to 9: kg mm^2?'), &
    mistake_t('joints/rings', 'rings.asperities.roughness=5e-6', 'roughness = 5e-6 m is 1.67 of the least crown of the '// &
      'rings, 3e-6 m, usually up to 0.4'), &
    mistake_t('bearings/small_engine', 'joint.clearance=1.8e-5', &
      'is 0.002 of bearing_radius = 0.009009 m, usually 0.0001 to 0.0015: the diametral clearance?'), &
    mistake_t('bearings/small_engine', 'crank_pin.joint.bearing_radius=0.03003', &
      'is 1.33 of crank_length = 0.0225 m, usually up to 1: the diameter instead of the radius?'), &
    mistake_t('gas/compressor', 'combustion.suction_pressure=0.6e5', 'is below the crankcase_pressure of 101 kPa'), &
    mistake_t('sim_VI', 'combustion.bore=0.040 combustion.heat=1000', 'the radius instead of the diameter?'), &
    mistake_t('gas/measured', 'cylinder_pressure.offset_deg=180', 'has its largest pressure at 547 degrees, far from the dead '// &
      'centres at 0 and 360: offset_deg?'), &
    mistake_t('gas/measured', 'cylinder_pressure.pressure_offset=-2e4', 'is compressed with the exponent 1.49, usually 1.15 to '// &
      '1.45: pressure_offset, offset_deg, compression_ratio or unit?'), &
    mistake_t('gas/measured', 'initial.crank_speed=-250', 'crank_speed < 0 turns the engine backwards?'), &
    mistake_t('sim_IV', 'drive.kind=constant_speed drive.torque=1', '&drive torque has no effect with kind = ''constant_speed'''), &
    mistake_t('film/heat', 'integrator.end_time=0.01', 'end_time = 0.01 s has no effect with &run until = ''periodic'''), &
    mistake_t('sim_I', 'initial.crank_speed=0 output.interval=1e-4 integrator.end_time=0.1 mechanism.gravity=9.81 '// &
      'mechanism.gravity_angle_deg=90', '&initial eccentricity: the pin starts in the middle of its bearing, but at rest it '// &
      'lies on it; under the weight alone eccentricity = 0, 1.98e-5')]


contains

  subroutine run_test_notes(check)
    class(checks_t), intent(inout) :: check
    integer :: i
    do i = 1, size(mistakes)
      call tell_mistake(check, mistakes(i))
    end do
    call several_mistakes(check)
    call plausible_values(check)
    call every_key_is_usual(check)
    call units_of_errors(check)
    call implausible_results(check)
    call films_that_have_not_settled(check)
    call marches(check)
  end subroutine run_test_notes

  !> A film with memory is not marched if its run does not reach its end: there is nothing to say of it. A pin that is driven into
  !> its film at 100 m/s: the pressure is of the order of 6 mu v R^2/c^2 L^2/(4 R^2) = 5e12 Pa and more.
  subroutine marches(check)
    class(checks_t), intent(inout) :: check
    type(film_history_t) :: history
    type(film_duty_t) :: duty
    type(error_t), allocatable :: error
    call check%that(history_remarks(history) == '', 'a march that was not begun has no remarks')
    history%bearing = bearing_t(radius=12e-3_dp, length=6e-3_dp, clearance=10e-6_dp)
    history%viscosity = 0.1_dp
    history%around = 48
    history%along = 2
    history%most_cycles = 2
    duty%time = [0.0_dp, 1e-7_dp, 3e-7_dp, 4e-7_dp]
    duty%pin_speed = spread(100.0_dp, 1, 4)
    duty%eccentricity = reshape([0.0_dp, 0.0_dp, 5e-6_dp, 0.0_dp, -5e-6_dp, 0.0_dp, 0.0_dp, 0.0_dp], [2, 4])
    call history%march(duty, error)
    call check%that(index(history_remarks(history), 'larger than 5 GPa') > 0, 'a film that is crushed is noted')
  end subroutine marches

  !> A shipped case with changes.
  subroutine read_changed(file, changes, case, error)
    character(len=*), intent(in) :: file, changes   !! changes separated by blanks
    type(case_t), intent(out) :: case
    type(error_t), allocatable, intent(out) :: error
    character(len=80) :: overrides(10)
    integer :: n, first, last
    n = 0
    first = 1
    do while (first <= len_trim(changes))
      last = first + index(changes(first:)//' ', ' ') - 2
      n = n + 1
      overrides(n) = changes(first:last)
      first = last + 2
    end do
    call read_case('cases/'//trim(file)//'.nml', overrides(:n), case, error)
  end subroutine read_changed

  !> A mistake has the note that tells it, and no other one beside those of the case without it.
  subroutine tell_mistake(check, mistake)
    class(checks_t), intent(inout) :: check
    type(mistake_t), intent(in) :: mistake
    type(case_t) :: case
    type(error_t), allocatable :: error
    character(len=:), allocatable :: notes
    call read_changed(mistake%file, mistake%changes, case, error)
    call check%that(.not. allocated(error), trim(mistake%changes)//' is not refused')
    call check%that(allocated(case%notes), trim(mistake%changes)//' is noted')
    if (.not. allocated(case%notes)) return
    notes = new_notes(mistake%file, case%notes)
    call check%that(index(notes, trim(mistake%note)) > 0, trim(mistake%changes)//': '//notes)
    call check%that(index(notes, newline) == len(notes), trim(mistake%changes)//' has one note: '//notes)
  end subroutine tell_mistake

  !> Those of some notes that a shipped case does not have without changes, each with an end of line.
  function new_notes(file, notes) result(new)
    character(len=*), intent(in) :: file, notes
    character(len=:), allocatable :: new, line
    type(case_t) :: case
    type(error_t), allocatable :: error
    integer :: at
    call read_changed(file, '', case, error)
    new = ''
    at = 1
    do while (at <= len(notes))
      call next_line(notes, at, line)
      if (allocated(case%notes)) then
        if (index(newline//case%notes//newline, newline//line//newline) > 0) cycle
      end if
      new = new//line//newline
    end do
  end function new_notes

  !> All lengths in millimetres: a note for each of them, and none for masses that only seem too small.
  subroutine several_mistakes(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: keys(6) = [character(len=14) :: 'crank_length', 'rod_com', 'clearance', 'bearing_radius', &
      'bearing_length', 'bore']
    type(case_t) :: case
    type(error_t), allocatable :: error
    integer :: i
    call read_changed('sim_IV', 'mechanism.crank_length=50.8 mechanism.rod_length=203.2 mechanism.rod_com=50.8,0 '// &
      'joint.clearance=0.02 joint.bearing_radius=10 joint.bearing_length=15 combustion.bore=70', case, error)
    call check%that(allocated(case%notes), 'millimetres are noted')
    if (.not. allocated(case%notes)) return
    do i = 1, size(keys)
      call check%that(index(case%notes, ' '//trim(keys(i))//' = ') > 0, 'a note on millimetres of '//keys(i))
    end do
    call check%that(count([(case%notes(i:i) == newline, i=1, len(case%notes))]) == size(keys) - 1, 'no other notes: '//case%notes)
    call check%that(index(case%notes, 'mass') == 0, 'no note on masses')
    call check%that(count([(index(case%notes(i:), 'millimetres?') == 1, i=1, len(case%notes))]) == size(keys), 'their unit is told')
  end subroutine several_mistakes

  !> Machines of other sizes are not noted: a compressor of a refrigerator, an engine of a ship; nor is 0.
  subroutine plausible_values(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    call read_changed('gas/compressor', 'mechanism.crank_length=0.008 mechanism.rod_length=0.04 mechanism.rod_mass=0.02 '// &
      'mechanism.rod_inertia=4e-6 mechanism.rod_com=0.013,0 mechanism.piston_mass=0.035 mechanism.crank_mass=0.5', case, error)
    call check%that(.not. allocated(error), 'a small compressor is accepted')
    call read_changed('flores/dry_0500um', 'mechanism.crank_length=1.25 mechanism.rod_length=2.8 mechanism.rod_mass=3500 '// &
      'mechanism.rod_inertia=2500 mechanism.rod_com=1,0 mechanism.piston_mass=5000 mechanism.crank_mass=20000 '// &
      'mechanism.crank_inertia=30000 initial.crank_speed=10 joint.bearing_radius=0.3', case, error)
    call check%that(.not. (allocated(error) .or. allocated(case%notes)), 'the engine of a ship is not noted')
    call read_changed('sim_I', 'mechanism.gravity=0 friction.coefficient=0 initial.eccentricity=0,0', case, error)
    call check%that(.not. (allocated(error) .or. allocated(case%notes)), '0 is not noted')
  end subroutine plausible_values

  !> Every real has usual sizes, which include its default and its example.
  subroutine every_key_is_usual(check)
    class(checks_t), intent(inout) :: check
    type(key_table_t) :: table
    real(dp) :: least, most
    integer :: i
    call case_schema_of(table)
    do i = 1, size(table%keys)
      associate (key => table%keys(i))
        if (key%kind /= real_kind) cycle
        call check%that(key%usual /= '', trim(key%group)//' '//trim(key%name)//' has usual sizes')
        if (key%usual == '') cycle
        call read_bounds(trim(key%usual), least, most)
        call check%that(least < most, trim(key%name)//': usually from less to more')
        call check%that(is_inside(key%default) .and. is_inside(key%example), trim(key%name)//': default and example are usual')
      end associate
    end do

  contains

    logical function is_inside(text)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: wanted
      real(dp) :: value
      is_inside = text == ''
      if (is_inside) return
      call read_real(text(:index(text//',', ',') - 1), value, wanted)
      is_inside = .not. abs(value) > 0 .or. abs(value) >= least .and. abs(value) <= most
    end function is_inside
  end subroutine every_key_is_usual

  !> Errors guess the unit too.
  subroutine units_of_errors(check)
    class(checks_t), intent(inout) :: check
    call refused('sim_IV', 'joint.clearance=20', &
      '&joint clearance = 20: must be < bearing_radius = 0.01: the pin''s radius is the difference (m): micrometres?')
    call refused('sim_IV', 'joint.clearance=0.02', 'the pin''s radius is the difference (m): millimetres?')
    call refused('sim_IV', 'contact.restitution=90', '&contact restitution = 90: must be >= 0 and <= 1: per cent?')
    call refused('sim_IV', 'combustion.start_deg=5.93', '(degrees): radians?')
    call refused('sim_IV', 'combustion.start_deg=-20', '(degrees): from the dead centre at 360?')
    call refused('gas/compressor', 'combustion.discharge_pressure=8', 'must be > suction_pressure = 100000 (Pa): bar?')
    call refused('film/sim_IV_mixed', 'asperities.roughness=0.4', 'a centred pin may not touch (m): micrometres?')
    call refused('wear/flores', 'wear.rate=2*1e-5', '(m^2/N): mm^3/(N m)?')
    call refused('sim_IV', 'mechanism.crank_length=0.2032 mechanism.rod_length=0.0508', &
      '&mechanism rod_length = 0.0508: must be > crank_length = 0.2032 (m)')
    call refused('sim_IV', 'lubrication.viscosity_law=walther lubrication.viscosity=0 lubrication.temperature=80 '// &
      'lubrication.known_temperatures=40,100 lubrication.known_viscosities=100e-6,11e-6 lubrication.density=870', &
      'temperature = 80: must be >= 200 and <= 700 (K): degrees Celsius?')
    call check%equal_text(likely_unit('m', 20.0_dp, 1e-6_dp, 1e-3_dp), ': micrometres?', 'a length')
    call check%equal_text(likely_unit('m', 1e9_dp, 1e-6_dp, 1e-3_dp), '', 'a length that no unit explains')
    call check%equal_text(likely_unit('furlong', 20.0_dp, 1e-6_dp, 1e-3_dp), '', 'an unknown unit')

  contains

    subroutine refused(file, changes, message)
      character(len=*), intent(in) :: file, changes, message
      type(case_t) :: case
      type(error_t), allocatable :: error
      call read_changed(file, changes, case, error)
      call check%that(allocated(error), 'refused: '//changes)
      if (allocated(error)) call check%that(index(error%message, message) > 0, changes//': '//error%message)
    end subroutine refused
  end subroutine units_of_errors

  !> Notes on results, in the lines of the run: a thin film, pressures beyond every material, contacts beyond their theory.
  subroutine implausible_results(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    character(len=:), allocatable :: lines
    call read_changed('sim_IV', '', case, error)
    report%status = 'done'
    report%figures%time = 0.2_dp
    associate (pin => report%figures%pin(piston_pin))
      pin%min_film_thickness = 0.101e-6_dp
      pin%max_force = 1.49e6_dp   ! 2 R L 5 GPa = 1.5 MN
      call check%equal_text(notes_on_results(case, report), '', 'results that are possible')
      pin%min_film_thickness = 0.099e-6_dp
      call check%that(index(notes_on_results(case, report), 'a film of 99 nm is thinner than the roughness') > 0, 'a film too thin')
      pin%min_film_thickness = 4.5e-14_dp
      pin%max_force = 1.51e6_dp
      lines = lines_for_user(case, report, 1.0_dp, 'results/x', '')
      call check%that(index(lines, newline//'  note: piston pin: a film of 4.5e-14 m is thinner than 10 nm') > 0, 'a thin film')
      call check%that(index(lines, newline//'  note: piston pin: a mean pressure of 5.03 GPa is larger than 5 GPa') > 0, &
        'a large pressure')
      pin%max_force = 5.4e12_dp
      pin%min_film_thickness = -1e-5_dp
      pin%contacts = 7
      pin%impacts_beyond_validity = 5
      pin%contacts_beyond_validity = 2
      lines = lines_for_user(case, report, 1.0_dp, 'results/x', '')
      call check%that(index(lines, '7 contacts (5 faster and 2 deeper than the theory holds), penetration up to 10 um, pin '// &
        'force up to 5.4 TN') > 0, 'the line of the run: '//lines)
      call check%that(index(lines, 'a force of 5.4 TN is larger than E R L = 31 MN') > 0, 'a large force: '//lines)
      pin%impacts_beyond_validity = 0
      lines = lines_for_user(case, report, 1.0_dp, 'results/x', '')
      call check%that(index(lines, '7 contacts (2 deeper than the theory holds), ') > 0, 'deep contacts')
      pin%contacts_beyond_validity = 0
      lines = lines_for_user(case, report, 1.0_dp, 'results/x', '')
      call check%that(index(lines, '7 contacts, ') > 0, 'contacts to which the theory applies')
      call check%that(index(lines, 'thinner') == 0, 'no film is thin where surfaces touch')
    end associate
    report%energy_is_poor = .true.
    report%figures%max_energy = 1
    report%figures%max_energy_residual = 1e-3_dp
    call check%that(index(notes_on_results(case, report), 'the energy is conserved only to 0.001') > 0, 'energy that is lost')
    report%status = 'done'
    report%periods%is_on = .true.
    case%run%periodic_tolerance = 9*case%integrator%relative_tolerance
    call check%that(index(notes_on_results(case, report), &
      'no period was found, perhaps since errors of the integration hide it') > 0, 'periods told by a tolerance that is too small')
    report%periods%period = 2
    call check%that(index(notes_on_results(case, report), 'no period was found') == 0, 'a period that is found')
    report%periods%period = 0
    case%run%periodic_tolerance = 11*case%integrator%relative_tolerance
    call check%that(index(notes_on_results(case, report), 'no period was found') == 0, &
      'no period by a tolerance that is large enough')
  end subroutine implausible_results

  !> The change of a film from cycle to cycle, of thicknesses that are known, and the text about it on the line of a driven crank.
  subroutine films_that_have_not_settled(check)
    class(checks_t), intent(inout) :: check
    type(cycle_watch_t) :: watch
    type(case_t) :: case
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    integer :: k
    allocate (watch%recent(0:longest_period - 1))
    do k = 1, 6   ! three cycles of two revolutions, with 8, 4 and 2 in the second revolution of each
      watch%ended = k
      watch%followed = k
      watch%recent(k)%pin(piston_pin)%min_film_thickness = merge(9.0_dp, 0.5_dp**(k/2 - 4), mod(k, 2) == 1)
      if (k < 6) call check%that(abs(watch%film_change(piston_pin, 2)) <= 0, 'no change before the end of the third cycle')
    end do
    call check%relative(watch%film_change(piston_pin, 2), -0.5_dp, 1e-12_dp, 'change of the smallest film thickness')
    watch%recent(4)%pin(piston_pin)%min_film_thickness = -1
    call check%that(abs(watch%film_change(piston_pin, 2)) <= 0, 'no change where surfaces touch')

    call read_changed('gas/compressor', '', case, error)
    report%status = 'done'
    report%figures%time = 0.2_dp
    report%figures%pin(piston_pin)%min_film_thickness = 3e-6_dp
    report%figures%pin(piston_pin)%film_change = -0.12_dp
    call check%that(index(lines_for_user(case, report, 1.0_dp, 'x', ''), ', not settled: the film thickness still changes by '// &
      '12 % from cycle to cycle (--set run.until=periodic)') > 0, 'a film that has not settled')
    report%figures%pin(piston_pin)%film_change = -0.04_dp
    call check%that(index(lines_for_user(case, report, 1.0_dp, 'x', ''), 'settled') == 0, 'a film that has settled')
    call read_changed('sim_I', '', case, error)
    report%figures%pin(piston_pin)%film_change = -0.12_dp
    call check%that(index(lines_for_user(case, report, 1.0_dp, 'x', ''), 'settled') == 0, 'a crank that nothing drives')
  end subroutine films_that_have_not_settled
end module test_notes
