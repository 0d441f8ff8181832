!> Notes on values of a valid case that are not of the sizes of real machines: units that were mixed up, diameters for radii, a
!> speed in revolutions per minute. A note refuses nothing. Each key declares its usual sizes; the relations between keys are here.
module case_notes
  use kinds, only: dp
  use constants, only: pi
  use case_definition, only: case_t
  use ideal_linkage, only: linkage_t
  use joint_case, only: joint_case_t
  use joint_places, only: places, n_places, in_order, name_prefix, joint_group, crank_pin
  use chain_motion, only: body_piston
  use case_values, only: case_values_t
  use case_remarks, only: remarks_t
  use gas_figures, only: gas_figures_t, find_gas_figures, highest_peak
  use train_case, only: order_cylinders
  use number_text, only: short_text, quantity_text
  use text_tools, only: integer_text
  use unit_hints, only: likely_unit
  implicit none
  private
  public :: note_case, count_lines

  real(dp), parameter :: steel = 7850   !! density [kg/m^3]
  real(dp), parameter :: highest_imep = 3.5e6_dp   !! [Pa]

contains

  !> Add the notes on a valid case to it. Only keys that the user has set are noted, each of them once.
  subroutine note_case(c, values)
    type(case_t), intent(inout) :: c
    type(case_values_t), intent(in), target :: values
    type(remarks_t) :: to
    integer :: i
    call to%begin(values)
    call note_lengths(c, to)
    call note_masses(c, to)
    call note_inertias(c, to)
    call note_speed(c, to)
    do i = 1, n_places
      call note_joint(c, c%joints(in_order(i)), joint_group(in_order(i)), in_order(i), to)
      call note_defaults(c, c%joints(in_order(i)), in_order(i), to)
    end do
    call note_guide(c, to)
    call note_rings(c, to)
    call note_gas(c, to)
    call note_firing(c, to)
    call note_rod(c, to)
    call to%note_sizes()
    call note_drive(c, to)
    call note_end(c, to)
    do i = 1, n_places
      call note_rest(c, in_order(i), to)
    end do
    if (allocated(c%notes)) deallocate (c%notes)
    if (to%notes /= '') c%notes = to%notes(:len(to%notes) - 1)
  end subroutine note_case

  !> A torque that does nothing.
  subroutine note_drive(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    if (c%drive%kind == 'constant_speed' .and. abs(c%drive%torque) > 0) call to%add_line('&drive torque has no effect with '// &
      'kind = ''constant_speed'': the drive supplies the moment that holds the speed (crank_moment); with kind = ''free'' '// &
      'the torque acts')
  end subroutine note_drive

  !> A new end of the run that the file's `until` overrules.
  subroutine note_end(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    character(len=*), parameter :: ends(3) = [character(len=17) :: 'revolutions', 'crank_revolutions', 'end_time']
    integer :: i, place
    if (.not. c%run%is_until_periodic()) return
    do i = 1, size(ends)
      place = to%values%place_of('integrator', trim(ends(i)))
      if (.not. to%values%values(place)%is_override) cycle
      if (.not. to%values%is_said(place)) cycle
      call to%remark('integrator', trim(ends(i)), &
        'has no effect with &run until = ''periodic'', which ends the run when the motion repeats: --set run.until=end', '')
    end do
  end subroutine note_end

  !> A pin that floats in the middle of its bearing though nothing moves yet.
  subroutine note_rest(c, place, to)
    type(case_t), intent(in) :: c
    integer, intent(in) :: place   !! index in `places`
    type(remarks_t), intent(inout) :: to
    real(dp), parameter :: resting = 0.99_dp   !! of the clearance: a film has no thickness 0
    character(len=:), allocatable :: name
    real(dp) :: speed, angle, at(2)
    speed = c%initial%crank_speed
    if (c%drive%ramp_time > 0) speed = c%drive%ramp_from
    name = name_prefix(place)//'eccentricity'
    if (abs(speed) > 0 .or. c%initial%from /= '' .or. .not. c%joints(place)%has_clearance()) return
    if (to%is_given('initial', name) .or. .not. abs(c%mechanism%gravity) > 0) return
    angle = c%mechanism%gravity_angle_deg*pi/180
    at = resting*c%joints(place)%clearance*places(place)%sense*[cos(angle), sin(angle)]
    where (abs(at) < 1e-12_dp*maxval(abs(at))) at = 0
    call to%add_line('&initial '//name//': the pin starts in the middle of its bearing, but at rest it lies on it; '// &
      'under the weight alone '//name//' = '//short_text(at(1))//', '//short_text(at(2)))
  end subroutine note_rest

  !> Bore of the cylinder [m]; 0: not known.
  pure real(dp) function bore_of(c)
    type(case_t), intent(in) :: c
    bore_of = 0
    if (allocated(c%combustion)) bore_of = c%combustion%bore
    if (allocated(c%measured)) bore_of = c%measured%bore
  end function bore_of

  !> Stroke of the piston [m]; 0: a bearing by itself.
  pure real(dp) function stroke_of(c)
    type(case_t), intent(in) :: c
    type(linkage_t) :: linkage
    stroke_of = 0
    linkage = c%mechanism%linkage()
    if (linkage%crank_length > 0) stroke_of = linkage%stroke()
  end function stroke_of

  !> Whether the stroke is longer than that of any trunk piston: the pin is then that of a crosshead, as wide as the bore.
  pure logical function has_crosshead(c)
    type(case_t), intent(in) :: c
    real(dp), parameter :: longest = 2.5_dp   ! stroke of a trunk piston over its bore
    has_crosshead = bore_of(c) > 0 .and. stroke_of(c) > longest*bore_of(c)
  end function has_crosshead

  !> Lengths of the machine. Centres of mass lie within their bodies; that of the rod is nearer to the crank pin, where its end is
  !> larger.
  subroutine note_lengths(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    real(dp), parameter :: widest = 0.5_dp   !! over the length of the rod
    associate (m => c%mechanism, length => c%mechanism%rod_length)
      if (allocated(c%combustion)) call to%expect('combustion', 'bore', bore_of(c), stroke_of(c), 0.2_dp, 5.0_dp, &
        'is # of the stroke of @ m', 'mechanism.crank_length')
      call to%expect('mechanism', 'crank_length', m%crank_length, length, 0.0_dp, 0.5_dp, 'is # of rod_length = @ m', &
        'mechanism.rod_length', 'the stroke instead of its half')
      if (.not. is_endless(c)) call to%expect('mechanism', 'rod_length', length, m%crank_length, 0.0_dp, 20.0_dp, &
        'is # times crank_length = @ m', 'mechanism.crank_length')
      if (norm2(m%crank_com) > m%crank_length) call to%remark('mechanism', 'crank_com', 'lies outside the crank of '// &
        short_text(m%crank_length)//' m'//likely_unit('m', norm2(m%crank_com), 0.0_dp, m%crank_length), 'mechanism.crank_length')
      if (m%rod_com(1) < 0 .or. m%rod_com(1) > length .or. abs(m%rod_com(2)) > widest*length) &
        call to%remark('mechanism', 'rod_com', 'lies outside the rod of '//short_text(length)//' m'// &
        likely_unit('m', norm2(m%rod_com), 0.0_dp, length), 'mechanism.rod_length')
      call to%expect('mechanism', 'rod_com', m%rod_com(1), length, 0.0_dp, 0.6_dp, 'is # of rod_length = @ m from the crank pin', &
        'mechanism.rod_length', 'measured from the piston pin')
      call to%expect('mechanism', 'axis_offset', m%axis_offset, m%crank_length, 0.0_dp, 0.3_dp, 'is # of crank_length = @ m', &
        'mechanism.crank_length')
      if (is_engine(c) .and. m%axis_offset*c%initial%crank_speed < 0) call to%remark('mechanism', 'axis_offset', &
        'is on the side that makes the side force of the working stroke larger', 'initial.crank_speed')
    end associate
  end subroutine note_lengths

  !> Whether the rod is so long that it stands for an infinite one, which moves the piston harmonically.
  pure logical function is_endless(c)
    type(case_t), intent(in) :: c
    is_endless = c%mechanism%rod_length > 6e3_dp*c%mechanism%crank_length
  end function is_endless

  !> Masses against those of blocks of steel of the size of the machine.
  subroutine note_masses(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    real(dp) :: piston   !! mass of a piston without a hollow [kg]
    associate (m => c%mechanism)
      piston = steel*stroke_of(c)*(0.25_dp*m%rod_length)**2
      if (bore_of(c) > 0) piston = steel*stroke_of(c)*pi/4*bore_of(c)**2
      if (bore_of(c) > 0 .or. .not. is_endless(c)) call to%expect('mechanism', 'piston_mass', m%piston_mass, piston, &
        2e-3_dp, 12.0_dp, 'is # times as much as a solid piston of steel for this machine (@ kg)', &
        'mechanism.crank_length mechanism.rod_length combustion.bore cylinder_pressure.bore')
      if (.not. is_endless(c)) call to%expect('mechanism', 'rod_mass', m%rod_mass, steel*m%rod_length**3, 1e-4_dp, 0.5_dp, &
        'is # times as much as a cube of steel as long as the rod (@ kg)', &
        'mechanism.rod_length mechanism.crank_length')
      call to%expect('mechanism', 'crank_mass', m%crank_mass, m%rod_mass + m%piston_mass, 0.0_dp, 100.0_dp, &
        'is # times as much as rod and piston (@ kg)', 'mechanism.rod_mass mechanism.piston_mass')
    end associate
  end subroutine note_masses

  !> Moments of inertia against those of point masses.
  subroutine note_inertias(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    associate (m => c%mechanism, com => c%mechanism%rod_com(1))
      if (com > 0 .and. com < m%rod_length) call to%expect('mechanism', 'rod_inertia', m%rod_inertia, &
        m%rod_mass*com*(m%rod_length - com), 0.02_dp, 1.25_dp, &
        'is # times that of the same mass in two points at the pins (@ kg m^2)', &
        'mechanism.rod_length mechanism.crank_length mechanism.rod_mass mechanism.rod_com', &
        'about a pin instead of the centre of mass')
      if (.not. is_endless(c)) call to%expect('mechanism', 'rod_inertia', m%rod_inertia, m%rod_mass*m%rod_length**2, &
        0.003_dp, 0.4_dp, 'is # of rod_mass rod_length^2 = @ kg m^2', &
        'mechanism.rod_length mechanism.crank_length mechanism.rod_mass')
      call to%expect('mechanism', 'crank_inertia', m%crank_inertia, m%crank_mass*m%crank_length**2, 4e-4_dp, 400.0_dp, &
        'is # of crank_mass crank_length^2 = @ kg m^2', 'mechanism.crank_mass mechanism.crank_length')
      call to%expect('drive', 'flywheel_inertia', c%drive%flywheel_inertia, (m%rod_mass + m%piston_mass)*m%crank_length**2, &
        0.0_dp, 3e3_dp, 'is # of (rod_mass + piston_mass) crank_length^2 = @ kg m^2', &
        'mechanism.rod_mass mechanism.piston_mass mechanism.crank_length')
    end associate
  end subroutine note_inertias

  !> Mean speed of the piston.
  subroutine note_speed(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    real(dp) :: most   !! [m/s]
    if (.not. stroke_of(c) > 0) return   ! a bearing by itself
    most = 40
    if (allocated(c%combustion)) most = c%combustion%fastest_piston()
    call to%expect('initial', 'crank_speed', c%initial%crank_speed, pi/stroke_of(c), 0.0_dp, most, &
      'is a mean piston speed of # m/s', 'mechanism.crank_length')
  end subroutine note_speed

  !> Clearance and size of a bearing.
  subroutine note_joint(c, joint, group, place, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: group
    integer, intent(in) :: place   !! index in `places`
    logical :: at_piston
    real(dp) :: room   !! [m]
    if (.not. joint%has_bearing()) return
    at_piston = places(place)%bearing == body_piston
    associate (r => joint%bearing_radius, length => c%mechanism%crank_length)
      call to%expect(group, 'clearance', joint%clearance, r, 1e-4_dp, 0.1_dp, 'is # of bearing_radius = @ m', &
        group//'.bearing_radius')
      if (is_engine(c) .and. allocated(joint%film)) call to%expect(group, 'clearance', joint%clearance, r, 1e-4_dp, 1.5e-3_dp, &
        'is # of bearing_radius = @ m', group//'.bearing_radius', 'the diametral clearance')
      room = max(length, 0.5_dp*(c%mechanism%rod_length - length))
      call to%expect(group, 'bearing_radius', r, room, 0.0_dp, merge(1.0_dp, 3.0_dp, at_piston), &   ! 3: an eccentric shaft
        'is # of the room beside crank and rod (@ m)', 'mechanism.crank_length mechanism.rod_length')
      if (at_piston) call to%expect(group, 'bearing_radius', r, bore_of(c), 0.04_dp, merge(0.65_dp, 0.26_dp, has_crosshead(c)), &
        'is # of bore = @ m', &
        'combustion.bore cylinder_pressure.bore', 'the diameter instead of the radius')
      if (is_engine(c) .and. .not. at_piston) then
        call to%expect(group, 'bearing_radius', r, length, 0.0_dp, 1.0_dp, 'is # of crank_length = @ m', 'mechanism.crank_length', &
          'the diameter instead of the radius')
        call to%expect(group, 'bearing_radius', r, bore_of(c), 0.0_dp, merge(0.75_dp, 0.45_dp, has_crosshead(c)), &
          'is # of bore = @ m', &
          'combustion.bore cylinder_pressure.bore', 'the diameter instead of the radius')
      end if
      call to%expect(group, 'bearing_length', joint%bearing_length, 2*r, 0.1_dp, 3.0_dp, &
        'is # of the diameter of the bearing, @ m', group//'.bearing_radius')
    end associate
    call to%expect('initial', name_prefix(place)//'eccentricity', norm2(c%initial%eccentricity(:, place)), joint%clearance, &
      0.0_dp, 1.2_dp, 'is # of clearance = @ m', group//'.clearance')
  end subroutine note_joint

  !> Laws that a joint has by default, though the manual advises against them.
  subroutine note_defaults(c, joint, place, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    type(joint_case_t), intent(in) :: joint
    integer, intent(in) :: place   !! index in `places`
    if (.not. joint%has_bearing()) return
    if (joint%is_carried() .and. place == crank_pin .and. c%n_bearings(place) > 1 .and. .not. c%has_numbers(place)) &
      call to%remark(joint_group(place), 'kind', 'computes the big end of one cylinder alone: numbers = ''all'' computes those '// &
      'of the other cylinders', '')
    if (joint%is_too_short_for_its_film() .and. .not. to%is_given(to%values%law_group('lubrication', place), 'law')) &
      call to%remark(joint_group(place), 'bearing_length', 'is less than two diameters, and the film by default that of a '// &
      'long bearing, which is too thick here: &lubrication law = ''finite_bearing''', joint_group(place)//'.bearing_radius')
    if (.not. joint%can_touch()) return
    if (joint%contact%geometry%is_of_spheres() .and. .not. to%is_given(to%values%law_group('contact', place), 'geometry')) &
      call to%remark(to%values%law_group('contact', place), 'youngs_modulus', 'gives by default the contact of two spheres, '// &
      'far too soft for a pin in its bearing: geometry = ''conformal''', '')
  end subroutine note_defaults

  !> Whether the gas drives the machine.
  pure logical function is_engine(c)
    type(case_t), intent(in) :: c
    is_engine = allocated(c%measured)
    if (allocated(c%combustion)) is_engine = c%combustion%heat_of_cycle() > 0
  end function is_engine

  !> The piston in its bore.
  subroutine note_guide(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    if (.not. c%has_loose_guide()) return
    associate (g => c%guide, r => c%guide%piston_radius)
      call to%expect('guide', 'bore_clearance', g%bore_clearance, r, 1e-4_dp, 0.05_dp, 'is # of piston_radius = @ m', &
        'guide.piston_radius')
      call to%expect('guide', 'piston_radius', r, bore_of(c), 0.4_dp, 0.51_dp, 'is # of bore = @ m', &
        'combustion.bore cylinder_pressure.bore', 'the diameter instead of the radius')
      call to%expect('guide', 'skirt_top', g%skirt_top, r, 0.0_dp, 6.0_dp, 'is # of piston_radius = @ m', 'guide.piston_radius')
      call to%expect('guide', 'skirt_bottom', g%skirt_bottom, r, 0.0_dp, 6.0_dp, 'is # of piston_radius = @ m', &
        'guide.piston_radius')
      call to%expect('guide', 'piston_inertia', g%piston_inertia, c%mechanism%piston_mass*r**2, 0.01_dp, 9.0_dp, &
        'is # of piston_mass piston_radius^2 = @ kg m^2', 'guide.piston_radius mechanism.piston_mass')
      call to%expect('guide', 'piston_com', norm2(g%piston_com), r, 0.0_dp, 2.0_dp, 'is # of piston_radius = @ m', &
        'guide.piston_radius')
    end associate
  end subroutine note_guide

  !> Surfaces so rough that rings run on them for the whole stroke; rings of one cylinder of several.
  subroutine note_rings(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    if (.not. allocated(c%rings%rings)) return
    if (allocated(c%rings%asperities)) call to%expect('rings.asperities', 'roughness', c%rings%asperities%roughness, &
      minval(c%rings%rings%crown), 0.0_dp, 0.4_dp, 'is # of the least crown of the rings, @ m', '')
    if (.not. allocated(c%cylinders)) return
    if (size(c%cylinders) > 1) call to%add_line('&ring: these are the rings of the full cylinder; the others have none, so '// &
      'that FMEP has the rings of one cylinder over the displacement of all')
  end subroutine note_rings

  !> Heat for the volume of the cylinder, and pressures and work of a cycle.
  subroutine note_gas(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    type(gas_figures_t) :: gas
    character(len=*), parameter :: of_hermetic = ': in a hermetic compressor both are equal'
    if (allocated(c%measured)) then
      call find_gas_figures(c%measured, c%mechanism%linkage(), c%initial%crank_speed, gas)
      if (gas%is_known) call note_table(c, gas, to)
    end if
    if (.not. allocated(c%combustion)) return
    call note_heat(c, to)
    call note_valves(c, to)
    associate (suction => c%combustion%filling_pressure(), crankcase => c%combustion%crankcase_pressure)
      if (suction > 0 .and. crankcase > 1.05_dp*suction) then
        call to%remark('combustion', 'suction_pressure', 'is below the crankcase_pressure of '//quantity_text(crankcase, 'Pa')// &
          ', which is on the other side of the piston'//of_hermetic, 'combustion.crankcase_pressure')
        call to%remark('combustion', 'crankcase_pressure', 'is above the suction_pressure of '//quantity_text(suction, 'Pa'), &
          'combustion.suction_pressure')
      else if (crankcase < 0.95_dp*suction .and. .not. to%is_given('combustion', 'crankcase_pressure')) then
        call to%remark('combustion', 'suction_pressure', 'is above the crankcase_pressure of '//quantity_text(crankcase, 'Pa')// &
          ' that is the default'//of_hermetic, '')
      end if
    end associate
    if (to%any_in('combustion') .or. .not. is_engine(c) .or. &
      to%any_remarkable('mechanism.crank_length mechanism.rod_length')) return
    call find_gas_figures(c%combustion, c%mechanism%linkage(), c%initial%crank_speed, gas)
    if (.not. gas%is_known) return
    if (gas%peak > highest_peak) then
      call to%remark('combustion', 'heat', 'gives a largest pressure of '//quantity_text(gas%peak, 'Pa')// &
        ', usually up to 50 MPa', '')
    else if (gas%imep > highest_imep) then
      call to%remark('combustion', 'bore', 'gives a mean effective pressure of '//quantity_text(gas%imep, 'Pa')//' with this '// &
        'heat, usually up to 3.5 MPa: the radius instead of the diameter?', '')
    end if
  end subroutine note_gas

  !> Mean speed of the gas in the valves of a compressor, and valves that are slow beside its turns.
  subroutine note_valves(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    real(dp), parameter :: slowest = 5, fastest = 120   ! [m/s]
    real(dp), parameter :: least_tuning = 3   ! of a reed, its natural frequency over that of the turns
    real(dp) :: flow   ! of volume behind the piston [m^3/s]
    real(dp) :: tuning
    integer :: i
    if (.not. allocated(c%valves)) return
    flow = pi/4*bore_of(c)**2*stroke_of(c)*abs(c%initial%crank_speed)/pi
    do i = 1, size(c%valves)
      if (flow < slowest*c%valves(i)%area .or. flow > fastest*c%valves(i)%area) call to%remark('valve_'//integer_text(i), 'area', &
        'makes a mean speed of the gas of '//short_text(flow/c%valves(i)%area, 3)//' m/s, usually 5 to 120', '')
      if (.not. (c%valves(i)%mass > 0 .and. c%valves(i)%stiffness > 0 .and. abs(c%initial%crank_speed) > 0)) cycle
      tuning = sqrt(c%valves(i)%stiffness/c%valves(i)%mass)/abs(c%initial%crank_speed)
      if (tuning < least_tuning) call to%remark('valve_'//integer_text(i), 'mass', 'makes a natural frequency of only '// &
        short_text(tuning, 3)//' times the turns of the crank, usually 4 to 20: more stiffness', '')
    end do
  end subroutine note_valves

  !> A measured pressure.
  subroutine note_table(c, gas, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    type(gas_figures_t), intent(in) :: gas
    character(len=*), parameter :: group = 'cylinder_pressure', key = 'table'
    character(len=:), allocatable :: hint
    real(dp), parameter :: far = 60, engine_ratio = 20   ! [degrees]; no stage of a compressor has a larger ratio of pressures
    if (.not. gas%are_usual()) then
      call to%remark(group, key, 'has pressures from '//quantity_text(gas%least, 'Pa')//' to '//quantity_text(gas%peak, 'Pa')// &
        ', usually a least one of 2e4 to 1e6 Pa and a largest of 1e5 to 5e7 Pa'//gas%likely_unit(), '')
    else if (gas%peak > 2*gas%least .and. abs(modulo(gas%peak_angle + 180, 360.0_dp) - 180) > far) then
      call to%remark(group, key, 'has its largest pressure at '//short_text(gas%peak_angle, 4)//' degrees, far from the dead '// &
        'centres at 0 and 360: offset_deg?', '')
    else if (gas%imep < 0 .and. (c%measured%period_deg == 720 .or. gas%peak > engine_ratio*gas%least)) then
      hint = ': offset_deg, or not fired?'
      if (c%initial%crank_speed < 0) hint = ': crank_speed < 0 turns the engine backwards?'
      call to%remark(group, key, 'takes power instead of giving it: IMEP '//quantity_text(gas%imep, 'Pa')//hint, '')
    else if (abs(gas%exponent) > 0 .and. (gas%exponent < 1.15_dp .or. gas%exponent > 1.45_dp)) then
      call to%remark(group, key, 'is compressed with the exponent '//short_text(gas%exponent, 3)// &
        ', usually 1.15 to 1.45: pressure_offset, offset_deg, compression_ratio or unit?', '')
    end if
  end subroutine note_table

  !> Several cylinders that fire at the same instant.
  subroutine note_firing(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    character(len=:), allocatable :: order
    real(dp), allocatable :: gaps(:)
    if (.not. (allocated(c%cylinders) .and. is_engine(c))) return
    allocate (gaps(size(c%cylinders)))
    call order_cylinders(c%delays(), 360.0_dp*c%forced_revolutions(), order, gaps)
    if (index(order, '+') > 0) call to%add_line('&cylinder: those with a plus between them fire at the same instant: '//order// &
      ': phase_deg and bank_deg?')
  end subroutine note_firing

  !> Heat for the volume of the cylinder.
  subroutine note_heat(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    call to%expect('combustion', 'heat', c%combustion%heat_of_cycle(), 1e6_dp*pi/4*bore_of(c)**2*stroke_of(c), 0.03_dp, 10.0_dp, &
      'is # J for each cm^3 of displacement (@ cm^3)', 'mechanism.crank_length combustion.bore')
  end subroutine note_heat

  !> Section of an elastic rod.
  subroutine note_rod(c, to)
    type(case_t), intent(in) :: c
    type(remarks_t), intent(inout) :: to
    if (.not. allocated(c%elastic_rod)) return
    associate (rod => c%elastic_rod)
      call to%expect('elastic_rod', 'section_area', rod%section_area, c%mechanism%rod_length**2, 1e-5_dp, 0.2_dp, &
        'is # of rod_length^2 = @ m^2', 'mechanism.rod_length')
      call to%expect('elastic_rod', 'section_inertia', rod%section_inertia, rod%section_area**2, 1e-3_dp, 20.0_dp, &
        'is # of section_area^2 = @ m^4', 'elastic_rod.section_area')
    end associate
  end subroutine note_rod

  !> Number of lines of a text; 0 if it is empty.
  pure integer function count_lines(text)
    character(len=*), intent(in) :: text
    integer :: i
    count_lines = 0
    if (text /= '') count_lines = 1 + count([(text(i:i) == achar(10), i=1, len(text))])
  end function count_lines
end module case_notes
