!> Rules that the values of a case must obey together: valid inertias, models that match their joint, a run that ends.
module case_rules
  use kinds, only: dp
  use constants, only: two_pi
  use number_text, only: short_text
  use text_tools, only: integer_text
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use measured_pressure, only: measured_pressure_periods
  use case_schema, only: find_group
  use case_values, only: case_values_t
  use train_rules, only: check_train
  use pin_rules, only: check_piston_pin
  use joint_rules, only: check_joints
  use train_builder, only: inertia_beside
  use body_rules, only: check_guide, check_rings, check_elastic, bore_reach
  use chain_motion, only: crank_pin, piston_pin, n_pins
  use joint_places, only: n_places, in_order, name_prefix, joint_group
  implicit none
  private
  public :: check_rules

  real(dp), parameter :: most_samples = 1e9_dp   !! largest number of rows that a run may ask for
  real(dp), parameter :: rounding = 1e-12_dp     !! relative difference of two times or lengths that counts as none

contains

  !> Note the errors of a case of which no scene can be built; `values` tells which keys the user has set.
  subroutine check_rules(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    if (allocated(c%load)) then
      call check_load(c, values)
    else
      call check_train(c, values)
      if (has_train_problem(values)) return
      call check_bodies(c, values)
      call check_piston_pin(c, values)
    end if
    call check_joints(c, values)
    call check_start(c, values)
    if (.not. allocated(c%load)) then
      call check_guide(c, values)
      call check_rings(c, values)
      call check_elastic(c, values)
      call check_gas(c, values)
      call check_drive(c, values)
    end if
    call check_periods(c, values)
    call check_run(c, values)
    call check_output(c, values)
  end subroutine check_rules

  !> Whether the crank turns at the start.
  pure logical function turns(c)
    type(case_t), intent(in) :: c
    turns = abs(c%initial%crank_speed) > 0
  end function turns

  !> Whether cylinders or crankshaft are wrong.
  logical function has_train_problem(values)
    type(case_values_t), intent(in) :: values
    integer :: k
    has_train_problem = values%problems%concerns('crankshaft')
    do k = 1, size(values%groups)
      if (values%groups(k)%number > 0) has_train_problem = has_train_problem .or. &
        values%problems%concerns(trim(values%groups(k)%name))
    end do
  end function has_train_problem

  !> Check that the rod is long enough, and that the mass matrix of crank and rod is positive definite at every crank angle. With
  !> A = I_c + m_c |com_c|^2 and B = I_r + m_r |com_r|^2 its smallest determinant is A B + m_r R^2 I_r.
  subroutine check_bodies(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: away = 'must be > 0 unless crank_mass is > 0 away from the axis'
    character(len=:), allocatable :: key
    real(dp) :: play, room, crank, rod   ! room: of the rod at the bottom dead centre [m]
    logical :: is_loose(n_pins)
    associate (m => c%mechanism)
      play = sum(play_of(c%joints))
      room = m%rod_length - m%crank_length - play
      if (m%rod_length <= m%crank_length) then
        call values%refuse('mechanism', 'rod_length', 'must be > crank_length = '//short_text(m%crank_length))
      else if (m%rod_length <= m%crank_length + play) then
        call values%refuse('mechanism', 'rod_length', 'must be > crank_length + clearance = '//short_text(m%crank_length + play))
      else if (abs(m%axis_offset) >= room) then
        call values%refuse('mechanism', 'axis_offset', 'must be shorter than rod_length - crank_length, less clearances, = '// &
          short_text(room)//': the crank could not turn')
      else if (m%rod_length <= m%crank_length + play + abs(m%axis_offset) + bore_reach(c)) then
        key = trim(merge('bore_clearance', 'piston_com    ', c%guide%bore_clearance > abs(c%guide%piston_com(2))))
        call values%refuse('guide', key, 'lets the pin move '//short_text(bore_reach(c))//' m off the cylinder''s axis: must '// &
          'be less than rod_length - crank_length - clearance - axis_offset = '//short_text(room - abs(m%axis_offset)))
      end if
      crank = m%crank_inertia + c%drive%flywheel_inertia + m%crank_mass*sum(m%crank_com**2) + inertia_beside(c)
      rod = m%rod_inertia + m%rod_mass*sum(m%rod_com**2)
      is_loose = c%loose_pins()
      if (is_loose(crank_pin)) then
        call values%forbid(crank <= 0, 'mechanism', 'crank_inertia', away)
        call values%forbid(m%rod_mass <= 0, 'mechanism', 'rod_mass', 'must be > 0 with clearance at the crank pin')
        call values%forbid(m%rod_inertia <= 0, 'mechanism', 'rod_inertia', 'must be > 0 with clearance at the crank pin')
      else if (is_loose(piston_pin)) then
        call values%forbid(rod <= 0, 'mechanism', 'rod_inertia', 'must be > 0 unless rod_mass is > 0 away from the crank pin')
        call values%forbid(rod > 0 .and. crank*rod + m%rod_mass*m%crank_length**2*m%rod_inertia <= 0, 'mechanism', &
          'crank_inertia', &
          away//', or rod_mass and rod_inertia are')
      else
        call values%forbid(crank + m%rod_inertia <= 0, 'mechanism', 'crank_inertia', away//', or rod_inertia is')
      end if
    end associate
  end subroutine check_bodies

  !> Check a bearing by itself: that there is no part of a mechanism, that its joint is carried, and that its bodies are known.
  subroutine check_load(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: only = 'is for a mechanism; this case has &bearing_load', &
      groups(11) = [character(len=17) :: 'mechanism', 'pin', 'guide', 'elastic_rod', 'crankshaft', 'combustion', &
      'cylinder_pressure', 'rings.lubrication', 'rings.asperities', 'working_gas', 'wall_heat'], &
      of_drive(4) = [character(len=16) :: 'torque', 'damping', 'flywheel_inertia', 'torque_table'], &
      of_initial(5) = [character(len=18) :: 'pin_speed', 'piston_offset', 'piston_offset_rate', 'piston_tilt', &
      'piston_tilt_rate']
    character(len=:), allocatable :: group
    integer :: k
    do k = 1, size(groups)
      if (values%is_present(find_group(values%groups, trim(groups(k))))) call values%refuse_group(trim(groups(k)), only)
    end do
    do k = 1, size(values%groups)
      if (values%groups(k)%number > 0 .and. values%is_present(k)) call values%refuse_group(trim(values%groups(k)%name), only)
    end do
    do k = 2, n_places
      group = joint_group(in_order(k))
      if (values%is_present(find_group(values%groups, group))) call values%refuse_group(group, only)
    end do
    do k = 1, size(of_drive)
      call values%forbid(values%is_said(values%place_of('drive', trim(of_drive(k)))), 'drive', trim(of_drive(k)), only)
    end do
    call values%forbid(c%drive%kind == 'free' .and. values%is_given('drive', 'kind'), 'drive', 'kind', &
      'must be constant_speed with &bearing_load')
    do k = 1, size(of_initial)
      call values%forbid(values%is_said(values%place_of('initial', trim(of_initial(k)))), 'initial', trim(of_initial(k)), only)
    end do
    call values%forbid(.not. c%joints(in_order(1))%is_carried(), 'joint', 'kind', 'must be quasi_static with &bearing_load')
    call values%forbid(.not. (c%load%curve%is_wanted() .or. any(abs(c%load%load) > 0)), 'bearing_load', 'table', &
      'required without load')
    call values%forbid(c%load%curve%is_wanted() .and. any(abs(c%load%load) > 0), 'bearing_load', 'load', &
      'cannot be combined with table: the load is constant or has a table')
    call values%forbid(mod(c%load%period_deg, 360) /= 0, 'bearing_load', 'period_deg', 'must be a multiple of 360')
    call values%demand(c%load%crank_to_rod > 0 .or. .not. c%load%needs_rod(), 'bearing_load', 'crank_to_rod', &
      'where frame, journal or bearing is rod')
  end subroutine check_load

  !> The clearance of a joint, unless it is wrong by itself [m].
  elemental real(dp) function play_of(joint)
    type(joint_case_t), intent(in) :: joint
    play_of = 0
    if (joint%has_clearance() .and. joint%clearance < joint%bearing_radius) play_of = joint%clearance
  end function play_of

  !> Check that the initial positions of the pins are admissible.
  subroutine check_start(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    real(dp) :: distance(n_places), room
    integer :: place
    associate (start => c%initial, m => c%mechanism)
      distance = norm2(start%eccentricity, 1)
      do place = 1, n_places
        call check_pin(c%joints(in_order(place)), joint_group(in_order(place)), name_prefix(in_order(place)), &
          distance(in_order(place)), start%eccentricity_rate(:, in_order(place)), values)
      end do
      if (values%problems%concerns('mechanism') .or. values%problems%concerns('initial') .or. allocated(c%load)) return
      place = in_order(max(1, findloc(distance(in_order) > 0, .true., 1)))
      room = m%rod_length - m%crank_length - abs(m%axis_offset)
      call values%forbid(sum(distance, c%joints%has_clearance()) >= room, 'initial', name_prefix(place)//'eccentricity', &
        'must be shorter than rod_length - crank_length - axis_offset = '//short_text(room))
    end associate
  end subroutine check_start

  !> Check that a pin starts inside its bearing, or, with a contact law, in its wall but not beyond it.
  subroutine check_pin(joint, group, prefix, distance, rate, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: group    !! group of the joint
    character(len=*), intent(in) :: prefix   !! prefix of the keys
    real(dp), intent(in) :: distance, rate(2)
    type(case_values_t), intent(inout) :: values
    associate (key => prefix//'eccentricity')
      if (joint%has_bearing()) then
        if (values%problems%concerns(group)) return
        if (distance >= joint%bearing_radius) then
          call values%refuse('initial', key, 'must be shorter than bearing_radius = '//short_text(joint%bearing_radius)// &
            ': the pin would leave its bearing')
        else if (.not. (joint%can_touch() .or. allocated(joint%asperities)) .and. distance >= joint%clearance*(1 - rounding)) then
          call values%refuse('initial', key, 'must be shorter than the clearance, '//short_text(joint%clearance)// &
            ', where there is no contact')
        end if
        call values%forbid(joint%is_carried() .and. norm2(rate) > 0, 'initial', key//'_rate', &
          'must be 0 with kind = ''quasi_static'': it follows from the load')
      else
        call values%forbid(distance > 0, 'initial', key, 'must be 0 in an ideal joint')
        call values%forbid(norm2(rate) > 0, 'initial', key//'_rate', 'must be 0 in an ideal joint')
      end if
    end associate
  end subroutine check_pin

  !> Check that pressure fields are requested only of films with a pressure.
  subroutine check_film_times(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    logical :: has_film
    integer :: place
    if (c%output%film_times == '') return
    has_film = .false.
    if (allocated(c%guide)) has_film = c%guide%is_lubricated()
    do place = 1, n_places
      if (allocated(c%joints(place)%film)) has_film = has_film .or. c%joints(place)%film%gives_pressure() .or. &
        allocated(c%joints(place)%history%march)
    end do
    call values%forbid(.not. allocated(c%output%snapshot_times), 'output', 'film_times', &
      'must be times >= 0 in rising order with commas, or from:to:count')
    call values%forbid(.not. has_film, 'output', 'film_times', 'needs a film with a pressure: '// &
      'pinkus_sternlicht, finite_bearing or that of a lubricated skirt')
    if (.not. allocated(c%output%snapshot_times)) return
    if (maxval(c%output%snapshot_times) > known_end(c)*(1 + rounding)) call values%forbid(.true., 'output', 'film_times', &
      'must not be after the end of the run at '//short_text(known_end(c))//' s')
  end subroutine check_film_times

  !> Check that there is one gas model at most, with angles that suit the mechanism and an allowed period.
  subroutine check_gas(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=:), allocatable :: key, wanted
    if (allocated(c%combustion) .and. .not. (values%problems%concerns('combustion') .or. &
      values%problems%concerns('mechanism'))) then
      call c%combustion%misfit(c%mechanism%linkage(), sign(1.0_dp, c%initial%crank_speed), key, wanted)
      if (key /= '') call values%refuse('combustion', key, wanted)
    end if
    if (allocated(c%combustion)) then
      if (c%combustion%filling_pressure() > 0 .and. .not. allocated(c%valves)) then
        call values%demand(exponent_of(values) > 0, 'combustion', 'polytropic_exponent', 'with ideal valves')
        call values%forbid(exponent_of(values) > 0 .and. exponent_of(values) < 0.1_dp, 'combustion', 'polytropic_exponent', &
          'must be >= 0.1')
      end if
    end if
    call check_charge(c, values)
    if (.not. allocated(c%measured)) return
    call values%forbid(allocated(c%combustion), 'cylinder_pressure', 'table', &
      'cannot be combined with the group combustion: one pressure acts on the piston')
    call values%forbid(c%measured%is_external() .and. c%measured%curve%is_wanted(), 'cylinder_pressure', 'table', &
      'must not be given with kind = ''external''')
    call values%forbid(c%measured%is_external() .and. c%run%is_until_periodic(), 'cylinder_pressure', 'kind', &
      'must be table with &run until = ''periodic'': a pressure from outside need not repeat')
    call values%forbid(all(c%measured%period_deg /= measured_pressure_periods), 'cylinder_pressure', 'period_deg', &
      'must be 360 or 720')
    call values%forbid(c%measured%is_external() .and. abs(c%measured%pressure_offset) > 0, 'cylinder_pressure', &
      'pressure_offset', 'is for a table alone')
    if (values%problems%concerns('cylinder_pressure') .or. .not. allocated(c%measured%curve%y)) return
    call values%forbid(.not. minval(c%measured%curve%y) + c%measured%pressure_offset > 0, 'cylinder_pressure', &
      'pressure_offset', 'must be > '//short_text(-minval(c%measured%curve%y))//': the pressures of the table are absolute with it')
  end subroutine check_gas

  !> Check that gas with a mass is that of an engine, whose heat the equations can follow.
  subroutine check_charge(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    logical :: is_engine
    if (allocated(c%walls) .and. .not. allocated(c%charge)) &
      call values%refuse_group('wall_heat', 'needs &working_gas, which gives the gas its temperature')
    if (allocated(c%valves) .and. .not. allocated(c%charge)) &
      call values%refuse_group('valve_1', 'needs &working_gas, whose mass flows through it')
    if (.not. allocated(c%charge)) return
    if (.not. allocated(c%combustion)) then
      call values%refuse_group('working_gas', 'needs a cycle in &combustion')
      return
    end if
    is_engine = .not. c%combustion%filling_pressure() > 0
    if (.not. is_engine) call check_compressor(c, values)
    if (.not. is_engine) return
    if (allocated(c%valves)) call values%refuse_group('valve_1', &
      'is of cycle = ''compressor'' alone; the valves of an engine open at fixed angles')
    call values%forbid(c%charge%heat_capacity_ratio > 0, 'working_gas', 'heat_capacity_ratio', &
      'is that of &combustion in an engine')
    if (.not. (allocated(c%walls) .or. c%charge%leak_area > 0)) return
    call values%forbid(c%combustion%burns_abruptly(), 'combustion', 'wiebe_form', &
      'must be >= 1 with &wall_heat or leak_area: the rate of its heat would begin without a bound')
  end subroutine check_charge

  !> The exponent of a compressor with ideal valves; 0 if it is not given.
  pure real(dp) function exponent_of(values) result(exponent)
    type(case_values_t), intent(in) :: values
    integer :: place
    place = values%place_of('combustion', 'polytropic_exponent')
    exponent = values%values(place)%reals(1)
  end function exponent_of

  !> Check that a compressor whose gas has a mass has valves with losses and no exponent.
  subroutine check_compressor(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    integer :: i
    if (.not. allocated(c%valves)) then
      call values%forbid(c%charge%leak_area > 0, 'working_gas', 'leak_area', &
        'needs &valve: a compressor with ideal valves has no leak')
      if (allocated(c%walls)) call values%refuse_group('wall_heat', &
        'needs &valve in a compressor: between ideal valves the heat is that of polytropic_exponent')
      call values%forbid(c%charge%heat_capacity_ratio > 0, 'working_gas', 'heat_capacity_ratio', &
        'is for &valve: with ideal valves the exponent is &combustion polytropic_exponent')
      return
    end if
    call values%forbid(exponent_of(values) > 0, 'combustion', 'polytropic_exponent', &
      'follows from the heat with &valve: leave it out, and give heat_capacity_ratio in &working_gas')
    call values%demand(c%charge%heat_capacity_ratio > 0, 'working_gas', 'heat_capacity_ratio', 'with &valve')
    call values%forbid(c%charge%heat_capacity_ratio > 0 .and. .not. c%charge%heat_capacity_ratio > 1, 'working_gas', &
      'heat_capacity_ratio', 'must be > 1')
    if (allocated(c%walls)) then
      if (c%walls%needs_engine()) call values%refuse('wall_heat', 'law', 'is of engines: constant, hohenberg or reynolds')
    end if
    if (size(c%valves) == 2) then
      call values%forbid(c%valves(1)%port == c%valves(2)%port .or. c%valves(1)%port == 'both' .or. c%valves(2)%port == 'both', &
        'valve_2', 'port', 'with two groups one has port = ''suction'', the other ''discharge'': the first has '''// &
        c%valves(1)%port//'''')
    else
      call values%forbid(c%valves(1)%port /= 'both', 'valve_1', 'port', 'is one of two: give the other valve too, or both')
    end if
    do i = 1, size(c%valves)
      associate (it => c%valves(i), group => 'valve_'//integer_text(i))
        if (it%mass > 0) then
          call values%demand(it%force_area > 0, group, 'force_area', 'with mass')
          call values%forbid(.not. it%full_force() > 0, group, 'mass', 'needs stiffness or preload, which shut the valve')
          cycle
        end if
        call values%demand(it%force_area > 0 .or. .not. it%stiffness > 0, group, 'force_area', 'with stiffness')
        call values%forbid(it%preload > 0 .and. .not. it%stiffness > 0, group, 'preload', 'needs stiffness')
        call values%forbid(it%damping > 0, group, 'damping', 'needs mass: without it the valve follows the pressures at once')
      end associate
    end do
  end subroutine check_compressor

  !> Check that the keys of a variable drive match its kind, and that there is one flywheel at most.
  subroutine check_drive(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    associate (drive => c%drive)
      call values%forbid(drive%table%is_wanted() .and. drive%kind /= 'free', 'drive', 'torque_table', &
        'needs kind = ''free'': at constant speed the drive supplies whatever torque is needed')
      call values%forbid(drive%ramp_time > 0 .and. drive%kind /= 'constant_speed', 'drive', 'ramp_time', &
        'needs kind = ''constant_speed'': the loads make the speed of a free crank')
      call values%forbid(abs(drive%ramp_from) > 0 .and. .not. drive%ramp_time > 0, 'drive', 'ramp_from', &
        'needs ramp_time, the time in which the speed rises from here to crank_speed')
      call values%forbid(drive%ramp_time > 0 .and. c%integrator%crank_revolutions > 0, 'drive', 'ramp_time', &
        'needs revolutions or end_time instead of crank_revolutions')
      call values%forbid(drive%flywheel_inertia > 0 .and. allocated(c%crankshaft), 'drive', 'flywheel_inertia', &
        'must be 0 with the group crankshaft, which has its own flywheel_inertia')
    end associate
  end subroutine check_drive

  !> Check that the end of the run is given once and is reached.
  subroutine check_run(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    real(dp) :: held_end   ! time in which a held crank makes crank_revolutions [s]
    associate (run => c%integrator, is_held => c%drive%kind == 'constant_speed')
      if (.not. c%run%is_until_periodic()) call values%check_family('integrator', 'revolutions')
      call values%forbid(run%revolutions > 0 .and. .not. (turns(c) .or. c%run%is_until_periodic()), 'integrator', 'revolutions', &
        'needs crank_speed other than 0; give end_time')
      call values%forbid(run%crank_revolutions > 0 .and. .not. turns(c) .and. is_held, 'integrator', 'crank_revolutions', &
        'needs crank_speed other than 0: the crank is held at rest')
      call values%forbid(run%crank_revolutions > 0 .and. .not. turns(c) .and. run%end_time <= 0, 'integrator', &
        'crank_revolutions', &
        'needs end_time beside it with crank_speed = 0: the latest end, should the crank not make them')
      if (is_held .and. turns(c)) then
        held_end = run%crank_revolutions*two_pi/abs(c%initial%crank_speed)
        if (run%end_time > 0 .and. run%end_time < held_end) call values%forbid(.true., 'integrator', 'end_time', &
          'must be >= '//short_text(held_end)//' s, when the held crank has made crank_revolutions')
      end if
      call values%forbid(run%contact_entry == 'step_rejection' .and. run%max_penetration <= 0, 'integrator', 'max_penetration', &
        'must be > 0 for contact_entry = ''step_rejection''')
    end associate
  end subroutine check_run

  !> Check that in a run until the motion is periodic the crank turns, and that enough revolutions are allowed.
  subroutine check_periods(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    associate (run => c%run, is_cut => c%output%window == 'last_period')
      call values%forbid(run%lyapunov_revolutions > 0 .and. .not. (turns(c) .and. (c%has_play() .or. c%drive%kind == 'free')), &
        'run', &
        'lyapunov_revolutions', 'needs crank_speed other than 0, and clearance at a joint or a free crank')
      if (.not. run%is_until_periodic()) then
        call values%forbid(is_cut, 'output', 'window', 'is for &run until = ''periodic'' alone')
        return
      end if
      call values%forbid(.not. turns(c), 'run', 'until', 'needs crank_speed other than 0')
      call values%forbid(run%period_revolutions < c%forced_revolutions(), 'run', 'period_revolutions', &
        'must be >= '//integer_text(c%forced_revolutions())//', what the gas or the load takes to repeat')
      call values%forbid(is_cut .and. c%output%start_time > 0, 'output', 'start_time', 'must be 0 with window = ''last_period''')
      call values%forbid(is_cut .and. run%most_revolutions <= run%period_revolutions, 'run', 'most_revolutions', &
        'must be > period_revolutions with window = ''last_period''')
    end associate
  end subroutine check_periods

  !> The end of the run, or its latest end, if the case says it [s]; the largest number if it depends on the motion.
  pure real(dp) function known_end(c)
    type(case_t), intent(in) :: c
    known_end = huge(known_end)
    if (c%run%is_until_periodic()) return
    if (c%integrator%end_time > 0) known_end = c%integrator%end_time
    if (.not. turns(c)) return
    if (c%integrator%revolutions > 0) known_end = min(known_end, c%integrator%revolutions*two_pi/abs(c%initial%crank_speed))
    if (c%integrator%crank_revolutions > 0 .and. c%drive%kind == 'constant_speed') known_end = &
      min(known_end, c%integrator%crank_revolutions*two_pi/abs(c%initial%crank_speed))
  end function known_end

  !> Check that the spacing of the rows is given, and that there are not too many rows.
  subroutine check_output(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    real(dp) :: samples, speed, end_time
    character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz0123456789_, '
    associate (output => c%output)
      if (output%sampling == 'crank_angle') then
        call values%forbid(output%interval > 0, 'output', 'interval', 'must not be given with sampling = ''crank_angle''')
        call values%forbid(output%every_step, 'output', 'every_step', 'must be .false. with sampling = ''crank_angle''')
      else
        call values%forbid(abs(output%angle_origin_deg) > 0, 'output', 'angle_origin_deg', &
          'is for sampling = ''crank_angle'' alone')
        call values%forbid(output%interval <= 0 .and. .not. turns(c), 'output', 'interval', &
          'required with crank_speed = 0: the time between rows, such as interval = 1e-4')
      end if
      if (output%start_time >= known_end(c)) call values%forbid(.true., 'output', 'start_time', &
        'must be before the end of the run at '//short_text(known_end(c)))
      call values%forbid(verify(output%columns, letters) > 0 .or. output%columns == '', 'output', 'columns', &
        'must be ''standard'' or names of columns without their units')
      call check_film_times(c, values)
      speed = abs(c%initial%crank_speed)
      end_time = c%integrator%end_time
      if (turns(c)) end_time = max(end_time, max(c%integrator%revolutions, c%integrator%crank_revolutions)*two_pi/speed)
      if (c%run%is_until_periodic() .and. turns(c)) end_time = c%run%most_revolutions*two_pi/speed
      if (output%window == 'last_period' .and. turns(c)) end_time = c%run%period_revolutions*two_pi/speed
      samples = end_time*speed/two_pi*output%samples_per_revolution
      if (output%interval > 0) samples = end_time/output%interval
      if (samples > most_samples) call values%refuse('output', &
        trim(merge('interval              ', 'samples_per_revolution', output%interval > 0)), 'asks for '// &
        short_text(samples, 2)//' rows in '//short_text(end_time)//' s: at most '//short_text(most_samples)//' are written')
    end associate
  end subroutine check_output
end module case_rules
