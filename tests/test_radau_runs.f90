!> The Radau method and the automatic choice in scenes: Jacobians, whole runs, rows inside steps.
module test_radau_runs
  use kinds, only: dp
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use ode_problem, only: difference_jacobian
  use scene_problem, only: scene_t, phase_contact
  use state_making, only: set_crank, set_pin
  use valve_reeds, only: in_flight
  use scene_builder, only: build_scene
  use collecting_sink, only: trace_t, run_case, values_of
  implicit none
  private
  public :: run_test_radau_runs

  integer, parameter :: long = 60

contains

  subroutine run_test_radau_runs(check)
    class(checks_t), intent(inout) :: check
    call jacobians_of_scenes(check)
    call jacobian_of_heat(check)
    call jacobian_of_gas(check)
    call no_jacobian_outside(check)
    call radau_agrees_with_adams(check)
    call loose_tolerances_survive(check)
    call impacts_with_radau(check)
    call landing_is_exact(check)
    call auto_chooses(check)
    call films_are_cheap(check)
    call rows_inside_steps(check)
  end subroutine run_test_radau_runs

  !> The closed-form Jacobian of whole scenes against finite differences, in film and in contact, with free crank and constant
  !> speed.
  subroutine jacobians_of_scenes(check)
    class(checks_t), intent(inout) :: check
    character(len=40), parameter :: files(5) = [character(len=40) :: 'cases/sim_I.nml', 'cases/sim_IV.nml', &
      'cases/sim_IV.nml', 'cases/flores/friction_050.nml', 'cases/flores/lubricated_400cP.nml']
    logical, parameter :: touches(5) = [.false., .false., .true., .true., .false.]
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), b_p(:, :), b_v(:, :), scale(:, :)
    real(dp) :: c
    integer :: i, m, trial

    do i = 1, size(files)
      call read_case(trim(files(i)), [character(len=1) ::], case, error)
      call build_scene(case, .false., scene, error)
      m = scene%n_positions
      c = case%joints(piston_pin)%clearance
      y = scene%initial_state()
      allocate (a_p(m, m), a_v(m, m), b_p(m, m), b_v(m, m), scale(m, m))
      if (touches(i)) scene%joints(1)%phase = phase_contact
      scene%joints(1)%impact_speed = 0.8_dp
      do trial = 1, 6
        call set_pin(scene, y, merge(1.1_dp, 0.55_dp, touches(i))*c*[cos(1.0_dp*trial), sin(1.0_dp*trial)], &
          [0.03_dp*cos(2.3_dp*trial), 0.02_dp*sin(3.1_dp*trial)])
        call set_crank(scene, y, 6.4_dp + 0.02_dp*trial, case%initial%crank_speed)
        call scene%jacobian(1e-3_dp*trial, y, a_p, a_v)
        call difference_jacobian(scene, 1e-3_dp*trial, y, b_p, b_v)
        scale = maxval(abs(b_p))*1e-4_dp + abs(b_p)
        call check%close_to(maxval(abs(a_p - b_p)/scale), 0.0_dp, 1e-2_dp, 'Jacobian with respect to positions, '//trim(files(i)))
        scale = maxval(abs(b_v))*1e-4_dp + abs(b_v)
        call check%close_to(maxval(abs(a_v - b_v)/scale), 0.0_dp, 1e-2_dp, 'Jacobian with respect to rates, '//trim(files(i)))
      end do
      deallocate (a_p, a_v, b_p, b_v, scale)
    end do
  end subroutine jacobians_of_scenes

  !> The same for gas with a mass: of an engine, open, compressed and burning, and of a compressor whose valves are shut or open,
  !> without a mass and with one, half open.
  subroutine jacobian_of_gas(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: files(3) = [character(len=40) :: 'cases/gas/engine_walls.nml', &
      'cases/gas/compressor_valves.nml', 'cases/gas/compressor_valves.nml']
    character(len=*), parameter :: reeds(2) = [character(len=20) :: 'valve_1.mass=1e-3', 'valve_1.damping=0.5']
    real(dp), parameter :: pressures(4, 3) = reshape([1.0e5_dp, 4.0e5_dp, 2.5e6_dp, 6.0e5_dp, &
      0.7e5_dp, 2.0e5_dp, 5.3e5_dp, 7.0e5_dp, 0.7e5_dp, 2.0e5_dp, 5.3e5_dp, 7.0e5_dp], [4, 3])   ! [Pa]
    real(dp), parameter :: angles(4) = [0.5_dp, 4.0_dp, 6.2_dp, 7.0_dp]
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), b_p(:, :), b_v(:, :), scale(:, :)
    integer :: i, k, m, trial
    do i = 1, size(files)
      call read_case(trim(files(i)), reeds(:merge(2, 0, i == 3)), case, error)
      call build_scene(case, .false., scene, error)
      m = scene%n_positions
      k = m + 2
      y = scene%initial_state()
      if (i == 3) then
        scene%gas%charge%reeds%place = in_flight
        y(scene%gas%charge%reeds%at%position) = [3e-4_dp, 6e-4_dp]
        y(scene%gas%charge%reeds%at%rate) = [-0.3_dp, 0.2_dp]
      end if
      allocate (a_p(k, m), a_v(k, k), b_p(k, m), b_v(k, k))
      do trial = 1, size(angles)
        call set_pin(scene, y, 0.55_dp*case%joints(piston_pin)%clearance*[cos(1.0_dp*trial), sin(1.0_dp*trial)], &
          [0.03_dp*cos(2.3_dp*trial), 0.02_dp*sin(3.1_dp*trial)])
        call set_crank(scene, y, angles(trial), case%initial%crank_speed)
        call scene%gas%start(angles(trial), case%initial%crank_speed)
        y(scene%gas%charge%pressures%first) = pressures(trial, i)
        call scene%jacobian(angles(trial)/case%initial%crank_speed, y, a_p, a_v)
        call difference_jacobian(scene, angles(trial)/case%initial%crank_speed, y, b_p, b_v)
        scale = spread(maxval(abs(b_p), 2) + tiny(1.0_dp), 2, m)
        call check%close_to(maxval(abs(a_p - b_p)/scale), 0.0_dp, 1e-3_dp, 'Jacobian of gas by positions, '//trim(files(i)))
        scale = spread(maxval(abs(b_v), 1) + tiny(1.0_dp), 1, k)   ! of each state: pascals, kilograms and metres
        call check%close_to(maxval(abs(a_v - b_v)/scale), 0.0_dp, 1e-3_dp, 'Jacobian of gas by rates, pressure and mass, '// &
          trim(files(i)))
      end do
      deallocate (a_p, a_v, b_p, b_v)
    end do
  end subroutine jacobian_of_gas

  !> The same for a film that heats up and thins with the shear, smooth and between rough surfaces, with a side flow of its own.
  subroutine jacobian_of_heat(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: hot(10) = [character(len=60) :: 'lubrication.viscosity_law=walther', &
      'lubrication.known_temperatures=313.15,373.15', 'lubrication.known_viscosities=1e-4,1.14e-5', 'lubrication.density=884', &
      'lubrication.temperature=363.15', 'heat.heat_capacity=0.05', 'heat.inlet_temperature=350', 'heat.side_flow=1e-6', &
      'lubrication.variant=short', 'lubrication.viscosity=0']
    character(len=*), parameter :: thin(2) = [character(len=60) :: 'lubrication.thinning_ratio=0.6', &
      'lubrication.thinning_rate=1e5']
    character(len=*), parameter :: rough(1) = [character(len=60) :: 'asperities.roughness=1e-6']
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), b_p(:, :), b_v(:, :), scale(:, :)
    integer :: i, k, m, trial
    do i = 1, 3
      if (i == 1) call read_case('cases/film/sim_I_finite.nml', hot, case, error)
      if (i == 2) call read_case('cases/film/sim_I_finite.nml', [hot, thin], case, error)
      if (i == 3) call read_case('cases/film/sim_I_finite.nml', [hot, thin, rough], case, error)
      call check%that(.not. allocated(error), 'a hot film is read')
      if (allocated(error)) return
      call build_scene(case, .false., scene, error)
      m = scene%n_positions
      k = m + 1
      y = scene%initial_state()
      allocate (a_p(k, m), a_v(k, k), b_p(k, m), b_v(k, k))
      do trial = 1, 6
        call set_pin(scene, y, 0.55_dp*2e-5_dp*[cos(1.0_dp*trial), sin(1.0_dp*trial)], &
          [0.03_dp*cos(2.3_dp*trial), 0.02_dp*sin(3.1_dp*trial)])
        call set_crank(scene, y, 6.4_dp + 0.02_dp*trial, case%initial%crank_speed)
        y(scene%joints(1)%heat%at%first) = 365 + 3.0_dp*trial
        call scene%jacobian(1e-3_dp*trial, y, a_p, a_v)
        call difference_jacobian(scene, 1e-3_dp*trial, y, b_p, b_v)
        scale = spread(maxval(abs(b_p), 2), 2, m)
        call check%close_to(maxval(abs(a_p - b_p)/scale), 0.0_dp, 1e-2_dp, 'Jacobian of a hot film by positions')
        scale = spread(maxval(abs(b_v), 2), 2, k)
        call check%close_to(maxval(abs(a_v - b_v)/scale), 0.0_dp, 1e-2_dp, 'Jacobian of a hot film by rates and temperature')
        call check%close_to(maxval(abs(a_v(:, k)/b_v(:, k) - 1), abs(b_v(:, k)) > 1e-3_dp*maxval(abs(b_v(:, k)))), 0.0_dp, &
          1e-3_dp, 'Jacobian of a hot film by its temperature')
      end do
      deallocate (a_p, a_v, b_p, b_v, scale)
    end do
  end subroutine jacobian_of_heat

  !> Where a film has no force, with the pin on the wall and beyond it, its derivatives are zero and are computed without the
  !> undefined force.
  subroutine no_jacobian_outside(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    class(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:)
    real(dp) :: a_p(3, 3), a_v(3, 3)
    character(len=1) :: none(0)
    integer :: i
    call read_case('cases/sim_I.nml', none, case, error)
    call build_scene(case, .false., scene, error)
    allocate (y(scene%n), source=0.0_dp)
    call set_crank(scene, y, 0.4_dp, 250.0_dp)
    do i = 0, 1
      call set_pin(scene, y, [2e-5_dp + i*1e-7_dp, 0.0_dp], [0.0_dp, 0.0_dp])
      call scene%jacobian(0.0_dp, y, a_p, a_v)
      call check%that(.not. any(abs(a_p) > 0) .and. .not. any(abs(a_v) > 0), 'no derivatives outside the film')
    end do
  end subroutine no_jacobian_outside

  !> Two methods that have only the scene in common.
  subroutine radau_agrees_with_adams(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: one, other
    character(len=40), parameter :: files(3) = [character(len=40) :: 'cases/sim_I.nml', 'cases/sim_VI.nml', &
      'cases/flores/lubricated_400cP.nml']
    integer :: i, j
    do i = 1, 3
      one = run_case(trim(files(i)), [character(len=long) :: 'integrator.method=adams', 'integrator.revolutions=2', &
        'integrator.relative_tolerance=1e-10'])
      other = run_case(trim(files(i)), [character(len=long) :: 'integrator.method=radau', 'integrator.revolutions=2', &
        'integrator.relative_tolerance=1e-10'])
      do j = 2, 7
        call check%close_to(maxval(abs(one%values(j, :) - other%values(j, :)))/maxval(abs(one%values(j, :))), 0.0_dp, &
          1e-8_dp, trim(files(i))//' '//one%names(j))
      end do
    end do
    one = run_case('cases/sim_I.nml', [character(len=long) :: 'integrator.method=radau'])
    call check%that(one%report%statistics%evaluations <= 6000, 'simulation I at 1e-6 in at most 6,000 evaluations')
  end subroutine radau_agrees_with_adams

  subroutine loose_tolerances_survive(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, tighter
    character(len=40), parameter :: files(8) = [character(len=40) :: 'sim_I', 'sim_II', 'sim_III', 'sim_IV', 'sim_V', &
      'sim_VI', 'flores/lubricated_400cP', 'sim_II_oscillating']
    character(len=long), parameter :: methods(2) = [character(len=long) :: 'integrator.method=radau', &
      'integrator.method=auto']
    character(len=long) :: overrides(2)
    integer :: i, k
    do i = 1, size(files)
      do k = 1, 2
        overrides = methods(k)
        overrides(2) = 'integrator.relative_tolerance=1e-2'
        trace = run_case('cases/'//trim(files(i))//'.nml', overrides)
        call check%that(.not. allocated(trace%error), trim(files(i))//' at 1e-2, '//trim(methods(k)))
        if (i > 7) cycle   ! chaotic: the cost depends on the motion
        call check%that(trace%report%figures%pin(piston_pin)%min_film_thickness > 0, trim(files(i))//': no contact')
        overrides(2) = 'integrator.relative_tolerance=1e-4'
        tighter = run_case('cases/'//trim(files(i))//'.nml', overrides)
        call check%that(trace%report%statistics%evaluations <= tighter%report%statistics%evaluations, &
          trim(files(i))//': 1e-2 needs no more evaluations than 1e-4, '//trim(methods(k)))
      end do
    end do
  end subroutine loose_tolerances_survive

  subroutine impacts_with_radau(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: one, other
    integer :: n
    one = run_case('cases/flores/friction_100.nml', [character(len=long) :: 'integrator.method=adams', &
      'integrator.revolutions=1', 'integrator.relative_tolerance=1e-10'])
    other = run_case('cases/flores/friction_100.nml', [character(len=long) :: 'integrator.method=radau', &
      'integrator.revolutions=1', 'integrator.relative_tolerance=1e-10'])
    n = min(size(one%event), size(other%event))
    call check%that(n > 20 .and. size(one%event) == size(other%event), 'the same contacts with both methods')
    call check%close_to(maxval(abs(one%event(:n)%time - other%event(:n)%time)), 0.0_dp, 1e-7_dp, 'contact times of both methods')
  end subroutine impacts_with_radau

  !> A piston that sticks in its guide, by friction with a transition speed of 2.4e-7 m/s, until the pin comes into contact. A step
  !> goes far beyond the wall, and Newton's iteration for the part up to the wall does not converge, or converges only apparently;
  !> the piston must not slide at the beginning of the contact. The expected normal speed is that of Adams, 0.5632487 m/s.
  subroutine landing_is_exact(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: common(7) = [character(len=long) :: 'integrator.revolutions=0.006', 'guide.kind=friction', &
      'guide.law=brown_mcphee', 'guide.coefficient=0.8', 'guide.static_coefficient=1.2', 'guide.transition_speed=2.35e-7', &
      'guide.stribeck_speed=0.0465']
    character(len=*), parameter :: tolerances(3) = ['1e-6', '1e-7', '1e-8']
    character(len=*), parameter :: methods(3) = ['radau', 'radau', 'auto ']
    character(len=long) :: chosen(2)
    type(trace_t) :: run, exact
    integer :: i
    exact = run_case('cases/sim_V_oscillating.nml', [common, [character(len=long) :: 'integrator.method=adams', &
      'integrator.relative_tolerance=1e-10']])
    call check%close_to(exact%event(1)%normal_speed, 0.5632487_dp, 1e-6_dp, 'speed of the pin at the wall')
    do i = 1, size(tolerances)
      chosen(1) = 'integrator.method='//methods(i)
      chosen(2) = 'integrator.relative_tolerance='//tolerances(i)
      run = run_case('cases/sim_V_oscillating.nml', [common, chosen])
      call check%close_to(run%event(1)%normal_speed, exact%event(1)%normal_speed, 1e-6_dp, &
        'Radau finds the speed at the wall: '//trim(methods(i))//' at '//tolerances(i))
    end do
  end subroutine landing_is_exact

  !> `auto` uses Radau in films, and Adams in contact and free flight, at the cost of the better method.
  subroutine auto_chooses(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: auto, radau, adams
    auto = run_case('cases/sim_IV.nml', [character(len=long) :: 'integrator.method=auto'])
    radau = run_case('cases/sim_IV.nml', [character(len=long) :: 'integrator.method=radau'])
    call check%that(auto%report%statistics%evaluations < 1.1_dp*radau%report%statistics%evaluations + 200, &
      'evaluations of auto in a film')
    call check%that(sum(auto%report%time_with(2, :)) > 0.9_dp*auto%report%figures%time, 'auto uses Radau in a film')
    auto = run_case('cases/flores/friction_050.nml', [character(len=long) :: 'integrator.method=auto'])
    adams = run_case('cases/flores/friction_050.nml', [character(len=long) :: 'integrator.method=adams'])
    call check%that(auto%report%statistics%evaluations < 1.1_dp*adams%report%statistics%evaluations, &
      'evaluations of auto in a dry joint')
    call check%that(sum(auto%report%time_with(1, :)) > 0.9_dp*auto%report%figures%time, 'auto uses Adams in a dry joint')
  end subroutine auto_chooses

  !> The Jacobian is that inside the step: with that at the beginning of the step the runs took 5478 and 3978 evaluations, now 3619
  !> and 2479.
  subroutine films_are_cheap(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: run
    integer, parameter :: most(2) = [4300, 3000]
    character(len=*), parameter :: files(2) = ['sim_I', 'sim_V']
    character(len=*), parameter :: spans(2) = [character(len=long) :: 'integrator.revolutions=4', 'integrator.revolutions=2']
    integer :: i
    do i = 1, size(files)
      run = run_case('cases/'//trim(files(i))//'.nml', [character(len=long) :: 'integrator.method=radau', spans(i), &
        'integrator.relative_tolerance=1e-6'])
      call check%that(run%report%statistics%evaluations <= most(i), trim(files(i))//': Newton''s method needs few iterations')
    end do
  end subroutine films_are_cheap

  !> Accelerations and forces in rows inside the steps. Where the exhaust opens, at 540 degrees, accelerations were off by 1 % of
  !> their range. After the start of a combustion whose rate has no second derivative, the light piston's acceleration was off by
  !> nine times its range, and the force by which the gas presses on the rod by .4 %.
  subroutine rows_inside_steps(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: name = 'piston_acceleration[m/s2]'
    type(trace_t) :: run, exact
    character(len=long), parameter :: light(8) = [character(len=long) :: 'integrator.method=radau', 'integrator.revolutions=1', &
      'combustion.wiebe_form=0.46', 'drive.kind=constant_speed', 'mechanism.rod_length=50.05', 'mechanism.piston_mass=0.03', &
      'mechanism.crank_length=0.05', 'initial.crank_speed=28.1']
    real(dp), allocatable :: values(:)
    exact = run_case('cases/sim_IV.nml', [character(len=long) :: 'integrator.method=radau', 'integrator.revolutions=1.7', &
      'integrator.relative_tolerance=1e-10'])
    run = run_case('cases/sim_IV.nml', [character(len=long) :: 'integrator.method=radau', 'integrator.revolutions=1.7', &
      'integrator.relative_tolerance=1e-6'])
    values = values_of(exact, name)
    call check%close_to(maxval(abs(values_of(run, name) - values))/(maxval(values) - minval(values)), 0.0_dp, 1e-4_dp, &
      'accelerations inside the steps of Radau')
    exact = run_case('cases/sim_V.nml', [character(len=long) :: light, 'integrator.relative_tolerance=1e-10'])
    run = run_case('cases/sim_V.nml', [character(len=long) :: light, 'integrator.relative_tolerance=1e-6'])
    values = values_of(exact, 'crankpin_force_y[N]')
    call check%close_to(maxval(abs(values_of(run, 'crankpin_force_y[N]') - values))/(maxval(values) - minval(values)), 0.0_dp, &
      5e-4_dp, 'forces inside the steps of Radau, light piston')
  end subroutine rows_inside_steps
end module test_radau_runs
