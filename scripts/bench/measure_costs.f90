!> Measures the cost of a scene: of an evaluation of the right-hand side, of an accepted Adams step without and with the values for
!> the summary, and of a row of the trace, for scenes that have one more model at a time. Run by scripts/bench/measure_costs.
!>
!>     measure_costs                       print a CSV table of times [ns], the shortest of many blocks, and of a sine and cosine
!>     measure_costs SCENE QUANTITY COUNT  perform it COUNT times, so that instructions can be counted
!>     measure_costs FILE integration N    print the shortest of N integrations of a case by method auto [ms], without output:
!>                                         of its scene, and of its ideal twin if the case asks for one
program measure_costs
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use adams, only: adams_t
  use ode_solver, only: integrate, observer_t, silent_observer_t, integration_done, step_limit_reached
  use scene_problem, only: scene_t, evaluation_t, phase_contact
  use scene_builder, only: build_scene, settings_for, simulated_time
  use trace_columns, only: column_list_t, choose_columns, row_values
  use ode_method, only: step_done
  use event_search, only: event_watch_t
  use run_recorder, only: recorder_t
  use trace_sink, only: trace_sink_t
  use measured_times, only: time_of_pairs, time_of_integration, no_difference
  use joint_places, only: piston_pin
  implicit none

  integer, parameter :: n_states = 64, blocks = 31, calls = 6400, steps_in_block = 2000
  integer, parameter :: name_length = 32, n_scenes = 46, n_quantities = 8
  character(len=name_length), parameter :: scenes(n_scenes) = [character(len=name_length) :: 'ideal', 'ideal+gas', 'free', &
    'free+gas', 'contact_hertz', 'contact', 'contact_johnson', 'contact_conformal', 'contact_wear', &
    'contact_conformal_wear', 'contact+quadrature', 'contact+ambrosio', &
    'contact+coulomb', 'contact+brown_mcphee', 'contact+stribeck', 'contact+lugre', 'contact+elasto_plastic', &
    'closed_form', 'closed_form+quadrature', 'closed_form+gas', 'as_printed', 'half_film', 'oscillating', &
    'oscillating_as_printed', 'finite_short', 'finite_table', 'finite_mixed', 'closed_form+rod_0_1', 'closed_form+rod_0_4', &
    'closed_form+rod_2_4', 'closed_form+rod_4_8', 'closed_form+shaft', 'closed_form+rubbing_guide', 'closed_form+loose_piston', &
    'closed_form+floating_pin', 'ideal+gas+lubricated_skirt', 'ideal+gas+ring', 'ideal+gas+ring_film', &
    'finite_table+heat', 'ideal+carried_short', 'ideal+carried_table', 'ideal+carried_table+heat', 'finite_table+gas', &
    'finite_table+gas+9_stations', 'finite_table+gas+6_cylinders', 'finite_table+gas+6_on_9_stations']
  character(len=name_length), parameter :: quantities(n_quantities) = [character(len=name_length) :: 'rhs', &
    'rhs_in_turn', 'step', 'events', 'step+figures', 'row', 'row_no_reactions', 'row_time_and_angle']
  character(len=name_length) :: scene_name, quantity, text
  integer :: i, j, count

  if (command_argument_count() == 3) then
    call get_command_argument(1, scene_name)
    call get_command_argument(2, quantity)
    call get_command_argument(3, text)
    read (text, *) count
    if (quantity == 'integration') then
      call integrate_case(count)
    else
      call do_once(trim(scene_name), trim(quantity), count)
    end if
  else
    print '(a)', 'scene,quantity,ns,pairs,evaluations'
    do i = 1, n_scenes
      do j = 1, n_quantities
        call measure(trim(scenes(i)), trim(quantities(j)))
      end do
    end do
  end if

contains

  !> Build the scene of a name: simulation IV with the models of the name and no others. Steps of the dry scenes are those of
  !> Flores's benchmark with 0.5 mm clearance, in contact and in free flight. Every scene integrates the work of its forces, for the
  !> energy residual; `+quadrature` adds one integral, of the magnitude of the joint's force.
  subroutine make(name, quantity, case, scene)
    character(len=*), intent(in) :: name, quantity
    type(case_t), intent(out) :: case
    type(scene_t), allocatable, intent(out) :: scene
    type(error_t), allocatable :: error
    character(len=*), parameter :: oscillating(2) = [character(len=40) :: 'lubrication.law=oscillating_film', &
      'lubrication.kinematic_viscosity=1.38e-5']
    ! the size of a table does not influence the cost of an evaluation
    character(len=*), parameter :: small_table(3) = [character(len=40) :: 'lubrication.cavitation=gumbel', &
      'lubrication.table_points=17', 'lubrication.film_points=32']
    character(len=*), parameter :: friction(3) = [character(len=40) :: &
      'friction.transition_speed=1e-3', 'friction.stribeck_speed=1e-2', 'friction.bristle_stiffness=2e4']
    character(len=40) :: law, friction_law, at_rest, wear
    logical :: dry
    integer :: i

    law = 'contact.law=lankarani_nikravesh'
    if (index(name, 'hertz') > 0) law = 'contact.law=hertz'
    friction_law = 'friction.law=ambrosio'
    if (index(name, 'contact+') == 1 .and. index(name, 'quadrature') == 0) friction_law = 'friction.law='//name(9:)
    at_rest = 'friction.static_coefficient=0.1'
    if (index(name, 'coulomb') > 0) at_rest = 'friction.static_coefficient=0.0'
    if (index(name, 'as_printed') > 0) law = 'lubrication.variant=as_printed'
    if (index(name, 'half_film') > 0) law = 'lubrication.variant=half_film'
    if (index(name, 'johnson') > 0) law = 'contact.geometry=johnson'
    if (index(name, 'conformal') > 0) law = 'contact.geometry=conformal'
    if (index(name, 'finite') == 1 .or. index(name, 'carried') > 0) law = 'lubrication.variant=table'
    if (index(name, 'short') > 0) law = 'lubrication.variant=short'
    wear = 'wear=none'
    if (index(name, 'wear') > 0) wear = 'wear.rate=1e-15,1e-15'
    dry = index(name, 'contact') == 1
    if (dry .and. along_case(quantity)) then
      call read_case('cases/flores/friction_050.nml', [character(len=40) :: law, friction_law, at_rest, friction, &
        'joint.bearing_length=0.04', wear], case, error)
    else if (index(name, 'finite') == 1 .or. index(name, 'carried') > 0) then
      call read_case('cases/film/sim_IV_'//trim(merge('mixed ', 'finite', index(name, 'mixed') > 0))//'.nml', &
        [character(len=40) :: law, small_table, member(name)], case, error)
    else if (index(name, 'oscillating') == 1) then
      call read_case('cases/sim_IV.nml', [law, oscillating], case, error)
    else
      call read_case('cases/sim_IV.nml', [law, friction_law, at_rest, friction, member(name), wear], case, error)
    end if
    if (allocated(error)) error stop 'measure_costs: run it from the top of the checkout'
    if (index(name, '+gas') == 0 .and. allocated(case%combustion)) deallocate (case%combustion)
    if (index(name, 'contact+') /= 1 .or. index(name, 'quadrature') > 0) then
      do i = 1, size(case%joints)
        if (allocated(case%joints(i)%friction)) deallocate (case%joints(i)%friction)
      end do
    end if
    if (dry .or. index(name, 'free') == 1 .or. index(name, 'ideal') == 1 .and. index(name, 'carried') == 0) then
      if (allocated(case%joints(piston_pin)%film)) deallocate (case%joints(piston_pin)%film)
    end if
    if (index(name, 'ideal') == 1 .or. index(name, 'free') == 1) then
      if (allocated(case%joints(piston_pin)%contact)) deallocate (case%joints(piston_pin)%contact)
    end if
    if (index(name, 'ideal') == 1 .and. index(name, 'carried') == 0) case%joints(piston_pin)%kind = 'ideal'
    call build_scene(case, .false., scene, error)
    if (allocated(error)) error stop 'measure_costs: no such scene'
    if (index(name, '+quadrature') > 0) call scene%measure_joint()
  end subroutine make

  !> Settings that make a member of simulation IV elastic or give it clearance, heat a film, or add cylinders and stations. The name
  !> of a rod ends with its numbers of modes and shapes.
  function member(name) result(settings)
    character(len=*), intent(in) :: name
    character(len=40) :: settings(20)
    integer :: i
    settings = 'case.title=x'   ! the same in every scene
    if (index(name, '+rod') > 0) settings(:4) = [character(len=40) :: 'elastic_rod.section_area=426e-6', &
      'elastic_rod.section_inertia=3e-8', 'elastic_rod.transverse_modes='//name(len(name) - 2:len(name) - 2), &
      'elastic_rod.axial_shapes='//name(len(name):)]
    if (index(name, '+shaft') > 0) settings(:2) = [character(len=40) :: 'crankshaft.flywheel_inertia=0.004', &
      'crankshaft.torsional_stiffness=2e4']
    if (index(name, '+rubbing_guide') > 0) settings(:3) = [character(len=40) :: 'guide.coefficient=0.1', 'guide.v0=1e-3', &
      'guide.v1=1e-2']
    if (index(name, '+loose_piston') > 0) settings(:7) = [character(len=40) :: 'guide.kind=clearance', &
      'guide.bore_clearance=1e-4', 'guide.skirt_top=0.03', 'guide.skirt_bottom=0.03', 'guide.piston_radius=0.035', &
      'guide.piston_inertia=1e-3', 'guide.stiffness=1e8']
    if (index(name, '+lubricated_skirt') > 0) settings(:9) = [character(len=40) :: 'guide.kind=lubricated', &
      'guide.bore_clearance=35e-6', 'guide.skirt_top=0.012', 'guide.skirt_bottom=0.033', 'guide.piston_radius=0.035', &
      'guide.piston_inertia=4.5e-4', 'guide.barrel=30e-6', 'guide.lubrication.viscosity=0.008', &
      'guide.asperities.roughness=1e-6']
    if (index(name, '+ring') > 0) settings(:5) = [character(len=40) :: 'ring_1.height=1.2e-3', 'ring_1.crown=6e-6', &
      'ring_1.tension=8.0', 'rings.lubrication.viscosity=0.008', 'rings.asperities.roughness=0.4e-6']
    if (index(name, '+ring_film') > 0) settings(6) = 'ring_1.model=film'
    if (index(name, '+floating_pin') > 0) settings(:7) = [character(len=40) :: 'pin.kind=floating', 'pin.mass=0.1', &
      'pin.inertia=6e-6', 'small_end.joint.kind=clearance', 'small_end.joint.clearance=20e-6', &
      'small_end.joint.bearing_radius=0.01', 'small_end.joint.bearing_length=0.015']
    if (index(name, '+carried') > 0) settings(1) = 'joint.kind=quasi_static'
    if (index(name, '+heat') > 0) settings(2:6) = [character(len=40) :: 'heat.heat_capacity=60.0', 'heat.inlet_temperature=350', &
      'lubrication.viscosity=0.0', 'lubrication.oil=SAE 30', 'lubrication.temperature=350']
    if (index(name, '+6_') > 0) then
      do i = 1, 6
        write (settings(i), '(a, i0, a, f0.1)') 'cylinder_', i, '.phase_deg=', -120.0*modulo(7*i, 6)
        if (index(name, '9_stations') > 0) write (settings(i + 6), '(a, i0, a, i0)') 'cylinder_', i, '.station=', i + 2
      end do
    end if
    if (index(name, '+9_stations') > 0) settings(7) = 'cylinder_1.station=3'
    if (index(name, '9_stations') > 0) settings(13:16) = [character(len=40) :: 'crankshaft.inertia=9*0.03', &
      'crankshaft.stiffness=1.2e6', 'crankshaft.damping=2.0', 'crankshaft.absolute_damping=0.1']
  end function member

  !> States along one compression stroke, with the pin in the film, or in contact if the scene has contact.
  subroutine make_states(name, scene, y)
    character(len=*), intent(in) :: name
    type(scene_t), intent(inout) :: scene
    real(dp), allocatable, intent(out) :: y(:, :)
    real(dp) :: part, turn, reach
    integer :: i

    if (allocated(scene%gas)) call scene%gas%start(1.5_dp*pi, 250.0_dp)
    if (allocated(scene%other_gas)) &
      call scene%other_gas%start(scene%gas, 1.5_dp*pi + scene%chain%train%cylinders%shift, 250.0_dp)
    if (index(name, 'contact') == 1) then
      call scene%joints(1)%begin_contact(0.1_dp)
      scene%joints(1)%slots(scene%joints(1)%acting(phase_contact))%element%sliding = 1
    end if
    allocate (y(scene%n, n_states))
    do i = 1, n_states
      y(:, i) = scene%initial_state()
      part = (i - 0.5_dp)/n_states
      y(scene%crank%position, i) = pi*(1.05_dp + 0.8_dp*part)
      y(scene%crank%rate, i) = 250
      if (size(scene%joints) == 0) cycle
      turn = 40*part
      reach = 20e-6_dp*(0.1_dp + 0.8_dp*part)
      if (scene%joints(1)%phase == phase_contact) reach = 20e-6_dp + 1e-6_dp*part
      associate (at => scene%joints(1)%at)
        y(at%position:at%position + 1, i) = reach*[cos(turn), sin(turn)]
        if (scene%n_joints > 0) y(at%rate:at%rate + 1, i) = 2e-3_dp*[cos(3*turn), sin(5*turn)]
        if (scene%n_states() > 0 .and. index(name, 'contact') == 1) y(2*scene%n_positions + 1, i) = 1e-6_dp*cos(7*turn)
      end associate
    end do
  end subroutine make_states

  !> The shortest of many blocks, measured alternately with blocks of sines and cosines.
  subroutine measure(name, quantity)
    character(len=*), intent(in) :: name, quantity
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:, :)
    real(dp) :: ns(blocks), pair(blocks), evaluations
    integer :: i

    if (name(:4) == 'free' .and. along_case(quantity)) return   ! no law would limit the motion of the pin
    call make(name, quantity, case, scene)
    if (.not. along_case(quantity)) call make_states(name, scene, y)
    evaluations = 1
    do i = 1, blocks
      pair(i) = time_of_pairs(calls, quantity == 'rhs_in_turn')
      select case (quantity)
      case ('rhs', 'rhs_in_turn')
        ns(i) = time_of_evaluations(scene, y, calls, quantity == 'rhs_in_turn')
      case ('step', 'step+figures')
        call run_steps(case, scene, quantity == 'step+figures', steps_in_block, ns(i), evaluations)
      case ('events')
        ns(i) = time_of_events(case, scene, steps_in_block)
      case default
        ns(i) = time_of_rows(case, scene, y, quantity, calls)
      end select
    end do
    if (quantity == 'events') ns = max(0.0_dp, median(ns))
    print '(3a,",",f0.1,2(",",f0.2))', name, ',', quantity, minval(ns), minval(ns)/minval(pair), evaluations
  end subroutine measure

  !> Evaluations of the right-hand side, independent of each other or, as in an integration, `in_turn`: each at a state that depends
  !> on all results of the evaluation before.
  real(dp) function time_of_evaluations(scene, y, count, in_turn) result(ns)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:, :)
    integer, intent(in) :: count
    logical, intent(in) :: in_turn
    integer(int64) :: before, after, rate
    real(dp) :: state(size(y, 1)), f(size(y, 1)), total
    logical :: in_domain
    integer :: i, j
    f = 0
    total = 0
    call system_clock(before, rate)
    do i = 1, count/n_states
      do j = 1, n_states
        if (in_turn) then
          state = y(:, j) + no_difference*sum(f)
          call scene%derivatives(0.0_dp, state, f, in_domain)
        else
          call scene%derivatives(0.0_dp, y(:, j), f, in_domain)
        end if
        if (.not. in_domain) error stop 'measure_costs: a state outside the model'
        total = total + f(2)
      end do
    end do
    call system_clock(after)
    ns = 1e9_dp*real(after - before, dp)/real(rate, dp)/(count/n_states*n_states)
    if (total > huge(total)) print *, total
  end function time_of_evaluations

  !> An evaluation for the trace, and the values of its row without their conversion to text.
  real(dp) function time_of_rows(case, scene, y, quantity, count) result(ns)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:, :)
    character(len=*), intent(in) :: quantity
    integer, intent(in) :: count
    type(case_t) :: asked
    type(column_list_t) :: list
    type(error_t), allocatable :: error
    type(evaluation_t) :: now
    integer(int64) :: before, after, rate
    real(dp), allocatable :: values(:)
    real(dp) :: total
    logical :: in_domain
    integer :: i, j

    asked = case
    asked%output%columns = 'standard'
    if (quantity == 'row_no_reactions') asked%output%columns = 'time,crank_angle,rod_angle,piston_position,crank_speed,'// &
      'rod_speed,piston_velocity,crank_acceleration,rod_acceleration,piston_acceleration,energy,energy_residual'
    if (quantity == 'row_time_and_angle') asked%output%columns = 'time,crank_angle'
    call choose_columns(asked, .false., list, error)
    if (allocated(error)) error stop 'measure_costs: no such columns'
    allocate (values(size(list%id)))
    total = 0
    call system_clock(before, rate)
    do i = 1, count/n_states
      do j = 1, n_states
        call scene%evaluate(0.0_dp, y(:, j), now, in_domain)
        call row_values(list, scene, 0.0_dp, now, 1.0_dp, 1.0_dp, values)
        total = total + values(2)
      end do
    end do
    call system_clock(after)
    ns = 1e9_dp*real(after - before, dp)/real(rate, dp)/(count/n_states*n_states)
    if (total > huge(total)) print *, total
  end function time_of_rows

  !> Accepted Adams steps along the case, repeatedly from its start to its end, and the evaluations of a step; starts and events are
  !> included.
  subroutine run_steps(case, template, with_figures, count, ns, evaluations)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: template
    logical, intent(in) :: with_figures
    integer, intent(in) :: count
    real(dp), intent(out) :: ns, evaluations
    type(scene_t), allocatable :: scene
    type(adams_t) :: method
    type(silent_observer_t) :: nobody
    type(recorder_t) :: recorder
    integer(int64) :: before, after, rate
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: status, steps

    method%settings = settings_for(case, template)
    call prepare_recorder(case, recorder)
    if (with_figures) call recorder%prepare(template)
    ns = 0
    evaluations = 0
    steps = 0
    do while (steps < count)
      scene = template
      y = scene%initial_state()
      t = 0
      if (with_figures) call recorder%begin(scene, 0.0_dp, y)
      call system_clock(before, rate)
      if (with_figures) then
        call integrate(scene, method, t, y, simulated_time(case), count - steps, recorder, status)
      else
        call integrate(scene, method, t, y, simulated_time(case), count - steps, nobody, status)
      end if
      call system_clock(after)
      if (status /= step_limit_reached .and. status /= integration_done) error stop 'measure_costs: a run failed'
      ns = ns + 1e9_dp*real(after - before, dp)/real(rate, dp)
      steps = steps + method%statistics%accepted
      evaluations = evaluations + method%statistics%evaluations
    end do
    ns = ns/steps
    evaluations = evaluations/steps
  end subroutine run_steps

  !> Time that a step needs for the search for events, including those that are found: the increase of a step's time if its events
  !> are searched for twice.
  real(dp) function time_of_events(case, template, count) result(ns)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: template
    integer, intent(in) :: count
    ns = time_of_searching(case, template, count, 2) - time_of_searching(case, template, count, 1)
  end function time_of_events

  !> Time of a step of `integrate` [ns] without an observer, if its events are searched for `searches` times.
  real(dp) function time_of_searching(case, template, count, searches) result(ns)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: template
    integer, intent(in) :: count, searches
    type(scene_t), allocatable :: scene
    type(adams_t) :: method
    type(event_watch_t) :: watches(searches)
    integer(int64) :: before, after, rate
    real(dp), allocatable :: y(:)
    real(dp) :: t, t_end
    integer :: status, steps, event, action, i

    method%settings = settings_for(case, template)
    t_end = simulated_time(case)
    ns = 0
    steps = 0
    do while (steps < count)
      scene = template
      y = scene%initial_state()
      call system_clock(before, rate)
      call method%start(scene, 0.0_dp, y, .true., status)
      call begin_all(watches, scene, 0.0_dp, y, 0)
      do while (method%t < t_end .and. steps + method%statistics%accepted < count)
        do i = 1, searches
          method%next_kink_time = scene%next_kink_time(method%t, method%y)
        end do
        call method%step(scene, status)
        if (status /= step_done) error stop 'measure_costs: a run failed'
        do i = 1, searches
          call watches(i)%search(method, scene, t_end, event, t)
        end do
        if (event == 0) cycle
        call method%interpolate(t, y)
        call scene%handle_event(event, t, y, action)
        call method%start(scene, t, y, .false., status)
        call begin_all(watches, scene, t, y, event)
      end do
      call system_clock(after)
      ns = ns + 1e9_dp*real(after - before, dp)/real(rate, dp)
      steps = steps + method%statistics%accepted
    end do
    ns = ns/steps
  end function time_of_searching

  subroutine begin_all(watches, scene, t, y, last_event)
    type(event_watch_t), intent(inout) :: watches(:)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    integer, intent(in) :: last_event
    integer :: i
    do i = 1, size(watches)
      call watches(i)%begin(scene, t, y, last_event, .false.)
    end do
  end subroutine begin_all

  !> Whether a quantity is measured along a case; otherwise it is measured at given states.
  pure logical function along_case(quantity)
    character(len=*), intent(in) :: quantity
    along_case = index(quantity, 'step') == 1 .or. quantity == 'events'
  end function along_case

  !> The median of an odd number of values.
  pure real(dp) function median(values)
    intrinsic :: count
    real(dp), intent(in) :: values(:)
    integer :: i
    do i = 1, size(values)
      median = values(i)
      if (2*count(values < median) < size(values) .and. 2*count(values > median) < size(values)) return
    end do
  end function median

  !> Prepare a recorder that never has to write a row.
  subroutine prepare_recorder(case, recorder)
    type(case_t), intent(in) :: case
    type(recorder_t), intent(inout) :: recorder
    type(error_t), allocatable :: error
    call choose_columns(case, .false., recorder%list, error)
    recorder%rows%first_sample = 1e9_dp
    recorder%rows%interval = 1
    recorder%rows%end_time = 1e10_dp
    allocate (recorder%sink)   ! ignores everything
  end subroutine prepare_recorder

  subroutine do_once(name, quantity, count)
    character(len=*), intent(in) :: name, quantity
    integer, intent(in) :: count
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:, :)
    real(dp) :: ns, evaluations

    if (quantity == 'pair') then
      ns = time_of_pairs(count, .false.)
      return
    end if
    call make(name, quantity, case, scene)
    if (.not. along_case(quantity)) call make_states(name, scene, y)
    select case (quantity)
    case ('rhs', 'rhs_in_turn')
      ns = time_of_evaluations(scene, y, count, quantity == 'rhs_in_turn')
    case ('step', 'step+figures')
      call run_steps(case, scene, quantity == 'step+figures', count, ns, evaluations)
    case default
      ns = time_of_rows(case, scene, y, quantity, count)
    end select
  end subroutine do_once
  !> Integrate the case file of the first argument, repeatedly.
  subroutine integrate_case(count)
    integer, intent(in) :: count
    character(len=500) :: path
    type(case_t) :: case
    type(error_t), allocatable :: error
    real(dp) :: best, ms
    integer :: i
    call get_command_argument(1, path)
    call read_case(trim(path), ['integrator.method=auto'], case, error)
    if (allocated(error)) error stop 'measure_costs: no such case'
    best = huge(best)
    do i = 1, count
      ms = time_of_integration(case, .false.)
      if (case%output%ideal_twin) ms = ms + time_of_integration(case, .true.)
      best = min(best, ms)
    end do
    print '(f0.4)', best
  end subroutine integrate_case
end program measure_costs
