!> Friction laws in the whole mechanism.
module test_friction_runs
  use kinds, only: dp
  use checks, only: checks_t
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use ode_problem, only: difference_jacobian
  use scene_problem, only: scene_t, phase_contact
  use chain_motion, only: piston_pin, crank_pin
  use scene_builder, only: build_scene
  use collecting_sink, only: trace_t, run_case, column
  use state_making, only: set_crank, set_pin, set_contact
  implicit none
  private
  public :: run_test_friction_runs

  integer, parameter :: long = 120
  character(len=*), parameter :: coulomb_static = 'cases/friction/coulomb_static.nml', lugre = 'cases/friction/lugre.nml'

contains

  subroutine run_test_friction_runs(check)
    class(checks_t), intent(inout) :: check
    call surfaces_stick_above_the_sliding_friction(check)
    call coulomb_is_the_limit_of_smooth_curves(check)
    call static_friction_is_not_passed_over(check)
    call closed_jacobian(check)
    call methods_agree(check)
    call bristles_live_in_contact(check)
    call work_of_friction(check)
    call stiff_bristles_are_found(check)
    call bristles_at_both_pins(check)
  end subroutine run_test_friction_runs

  !> While the surfaces slide, the friction is sliding friction; while they stick it may be larger, up to static friction.
  subroutine surfaces_stick_above_the_sliding_friction(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), parameter :: at_rest = 1e-6_dp   !! [m/s]
    integer :: i, above
    trace = run_case(coulomb_static, [character(len=long) :: 'integrator.relative_tolerance=1e-9', &
      'output.samples_per_revolution=5000'])
    above = 0
    associate (normal => trace%values(column(trace, 'normal_force[N]'), :), &
               friction => trace%values(column(trace, 'friction_force[N]'), :), &
               v => trace%values(column(trace, 'sliding_speed[m/s]'), :))
      do i = 1, size(v)
        if (.not. normal(i) > 0) cycle
        if (abs(v(i)) > at_rest) then
          call check%close_to(friction(i), -sign(0.10_dp*normal(i), v(i)), 1e-12_dp*normal(i), 'friction of surfaces that slide')
        else
          call check%that(abs(friction(i)) < 0.15_dp*(1 + 1e-6_dp)*normal(i), 'friction of surfaces that stick')
          if (abs(friction(i)) > 0.101_dp*normal(i)) above = above + 1
        end if
      end do
    end associate
    call check%that(above > 10, 'sticking surfaces have more than sliding friction')
    associate (f => trace%report%figures)
      call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-7_dp, 'energy residual with static friction')
    end associate
  end subroutine surfaces_stick_above_the_sliding_friction

  !> Stribeck's curve with decreasing transition speed: the contacts converge to those of Coulomb's law with static friction.
  subroutine coulomb_is_the_limit_of_smooth_curves(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: coulomb, smooth
    real(dp) :: error(3)
    integer :: i, n
    character(len=long), parameter :: speeds(3) = [character(len=long) :: 'friction.stribeck_speed=1e-2', &
      'friction.stribeck_speed=1e-3', 'friction.stribeck_speed=1e-4']
    character(len=long), parameter :: slopes(3) = [character(len=long) :: 'friction.transition_speed=1e-3', &
      'friction.transition_speed=1e-4', 'friction.transition_speed=1e-5']
    coulomb = run_case(coulomb_static, [character(len=long) :: 'integrator.relative_tolerance=1e-10', 'integrator.revolutions=0.7'])
    do i = 1, 3
      smooth = run_case(coulomb_static, [character(len=long) :: 'integrator.relative_tolerance=1e-10', &
        'integrator.revolutions=0.7', 'integrator.method=auto', 'friction.law=stribeck', speeds(i), slopes(i)])
      n = min(size(smooth%event), size(coulomb%event), 14)
      call check%that(n == 14, 'number of contacts')
      error(i) = maxval(abs(smooth%event(:n)%time - coulomb%event(:n)%time))
    end do
    call check%that(error(2) < 0.3_dp*error(1) .and. error(3) < 0.3_dp*error(2), 'Stribeck''s curve converges to static friction')
  end subroutine coulomb_is_the_limit_of_smooth_curves

  !> Static friction in a narrow range of speeds, over which a step could pass: the surfaces stick, as with Coulomb's law, where
  !> sticking is an event.
  subroutine static_friction_is_not_passed_over(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: file = 'cases/sim_I_oscillating.nml'
    character(len=long), parameter :: common(5) = [character(len=long) :: 'integrator.revolutions=0.33', &
      'contact.youngs_modulus=2771028467,272870190852', 'friction.coefficient=0.1', 'friction.static_coefficient=1.0', &
      'friction.v0=0']
    character(len=long), parameter :: laws(3) = [character(len=long) :: 'friction.law=brown_mcphee', 'friction.law=brown_mcphee', &
      'friction.law=stribeck']
    character(len=long), parameter :: methods(3) = [character(len=long) :: 'integrator.method=auto', 'integrator.method=radau', &
      'integrator.method=radau']
    ! speeds known to 1e-6 of some m/s may pass over a range of 1e-7 m/s
    character(len=long), parameter :: tolerances(3) = [character(len=long) :: 'integrator.relative_tolerance=1e-6', &
      'integrator.relative_tolerance=1e-6', 'integrator.relative_tolerance=1e-8']
    character(len=long), parameter :: speeds(3) = [character(len=long) :: 'friction.transition_speed=1e-5', &
      'friction.transition_speed=1e-5', 'friction.transition_speed=1e-7']
    type(trace_t) :: coulomb, narrow
    real(dp) :: error
    integer :: i
    coulomb = run_case(file, [character(len=long) :: common, 'integrator.relative_tolerance=1e-9', 'friction.law=coulomb', &
      'friction.v1=0'])
    call check%that(size(coulomb%event) >= 6, 'contacts with static friction')
    do i = 1, size(laws)
      narrow = run_case(file, [character(len=long) :: common, tolerances(i), methods(i), laws(i), speeds(i), &
        'friction.stribeck_speed=1e-5', 'friction.viscous_coefficient=0'])
      error = huge(error)
      if (all(shape(narrow%values) == shape(coulomb%values))) error = maxval(abs( &
        narrow%values(column(narrow, 'eccentricity_ratio[-]'), :) - coulomb%values(column(coulomb, 'eccentricity_ratio[-]'), :)))
      call check%close_to(error, 0.0_dp, 0.02_dp, 'motion with narrow static friction: '//trim(laws(i))//', '//trim(methods(i)))
    end do
  end subroutine static_friction_is_not_passed_over

  !> The closed form of the Jacobian against finite differences, for every law, at constant crank speed and with a free crank.
  subroutine closed_jacobian(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: laws(3) = [character(len=long) :: 'friction.law=threlfall', 'friction.law=brown_mcphee', &
      'friction.law=stribeck']
    character(len=long), parameter :: drives(2) = [character(len=long) :: 'drive.kind=constant_speed', 'drive.kind=free']
    character(len=long), parameter :: bristles(3) = [character(len=long) :: 'friction.law=lugre', 'friction.law=dahl', &
      'friction.law=elasto_plastic']
    integer :: i, j
    do j = 1, size(drives)
      do i = 1, size(laws)
        call compare_jacobians(check, coulomb_static, [character(len=long) :: laws(i), drives(j), 'friction.v1=0.5', &
          'friction.transition_speed=0.3', 'friction.stribeck_speed=0.4', 'friction.viscous_coefficient=0.01'])
      end do
      do i = 1, size(bristles)
        call compare_jacobians(check, lugre, [character(len=long) :: bristles(i), drives(j), 'friction.stribeck_speed=0.4', &
          'friction.damping_speed=0.3', 'friction.bristle_damping=0.1'])
      end do
    end do
  end subroutine closed_jacobian

  subroutine compare_jacobians(check, file, overrides)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, overrides(:)
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), d_p(:, :), d_v(:, :)
    integer :: i, m, k
    call read_case(file, overrides, case, error)
    call check%that(.not. allocated(error), 'the case of '//overrides(1))
    if (allocated(error)) return
    call build_scene(case, .false., scene, error)
    m = scene%n_positions
    k = m + scene%n_states()
    allocate (a_p(k, m), a_v(k, k), d_p(k, m), d_v(k, k))
    do i = 1, 4
      y = scene%initial_state()
      call set_crank(scene, y, 0.3_dp*i, 520.0_dp)
      call set_pin(scene, y, 1.03_dp*case%joints(piston_pin)%clearance*[cos(1.3_dp*i), sin(1.3_dp*i)], &
        [0.4_dp*cos(2.1_dp*i), 2*sin(1.7_dp*i)])
      call set_contact(scene%joints(1), 1.0_dp, 1)
      if (scene%n_states() > 0) y(scene%joints(1)%slots(1)%element%states%first) = 1.4e-6_dp*(2*i - 5)
      call scene%jacobian(1e-3_dp*i, y, a_p, a_v)
      call difference_jacobian(scene, 1e-3_dp*i, y, d_p, d_v)
      call check%close_to(maxval(abs(a_p - d_p)), 0.0_dp, 1e-5_dp*maxval(abs(d_p)), &
        'derivatives with respect to positions: '//overrides(1))
      call check%close_to(maxval(abs(a_v - d_v)), 0.0_dp, 1e-5_dp*maxval(abs(d_v)), &
        'derivatives with respect to rates: '//overrides(1))
      if (k == m) cycle
      call check%close_to(maxval(abs(a_p(k, :) - d_p(k, :))), 0.0_dp, 1e-5_dp*maxval(abs(d_p(k, :))) + 2e-4_dp, &
        'derivatives of the bristles with respect to positions: '//overrides(1))
      call check%close_to(maxval(abs(a_v(k, :m) - d_v(k, :m))), 0.0_dp, 1e-5_dp*maxval(abs(d_v(k, :m))), &
        'derivatives of the bristles with respect to rates: '//overrides(1))
      call check%close_to(a_v(k, k), d_v(k, k), 1e-5_dp*(1 + abs(d_v(k, k))), &
        'derivative of the bristles with respect to themselves: '//overrides(1))
      call check%close_to(maxval(abs(a_v(:m, k) - d_v(:m, k))), 0.0_dp, 1e-5_dp*maxval(abs(d_v(:m, k))), &
        'derivatives with respect to the bristles: '//overrides(1))
    end do
  end subroutine compare_jacobians

  !> A law with bristles by three methods: the same contacts and the same motion.
  subroutine methods_agree(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: laws(2) = [character(len=long) :: 'friction.law=lugre', 'friction.law=elasto_plastic']
    character(len=long), parameter :: methods(3) = [character(len=long) :: 'integrator.method=adams', 'integrator.method=radau', &
      'integrator.method=auto']
    type(trace_t) :: trace(3)
    integer :: i, k, n, pin
    do k = 1, size(laws)
      do i = 1, size(methods)
        trace(i) = run_case(lugre, [character(len=long) :: laws(k), methods(i), 'integrator.relative_tolerance=3e-11', &
          'integrator.revolutions=0.5'])
        call check%that(.not. allocated(trace(i)%error), 'bristles run with '//methods(i))
        associate (f => trace(i)%report%figures)
          call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-9_dp, 'energy residual with bristles')
        end associate
      end do
      n = size(trace(1)%event)
      call check%that(n > 8, 'number of contacts with bristles')
      pin = column(trace(1), 'piston_position[m]')
      do i = 2, 3
        call check%that(size(trace(i)%event) == n, 'number of contacts by '//methods(i))
        if (size(trace(i)%event) /= n) cycle
        call check%close_to(maxval(abs(trace(i)%event%time - trace(1)%event%time)), 0.0_dp, 1e-9_dp, &
          'contact times by Adams and by '//methods(i))
        call check%close_to(maxval(abs(trace(i)%values(pin, :) - trace(1)%values(pin, :))), 0.0_dp, 1e-10_dp, &
          'piston position by Adams and by '//methods(i))
      end do
    end do
  end subroutine methods_agree

  !> The bristle deflection is 0 in free flight and at the beginning of a contact, and never larger than that under static friction.
  subroutine bristles_live_in_contact(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: most
    integer :: i, k
    trace = run_case(lugre, [character(len=long) :: 'integrator.relative_tolerance=1e-9', 'output.samples_per_revolution=20000', &
      'integrator.revolutions=0.5'])
    k = 1
    most = 0
    associate (t => trace%values(1, :), z => trace%values(column(trace, 'bristle[m]'), :), &
               phase => trace%values(column(trace, 'phase[-]'), :), normal => trace%values(column(trace, 'normal_force[N]'), :), &
               friction => trace%values(column(trace, 'friction_force[N]'), :))
      do i = 1, size(t)
        do while (k < size(trace%event))
          if (trace%event(k + 1)%time > t(i)) exit
          k = k + 1
        end do
        most = max(most, abs(z(i)))
        if (nint(phase(i)) /= phase_contact) then
          call check%close_to(z(i), 0.0_dp, 0.0_dp, 'no bristle deflection in free flight')
        else if (t(i) > trace%event(k)%time) then
          call check%that(abs(z(i)) < 10*(t(i) - trace%event(k)%time), 'bristle deflection at the beginning of every contact')
          call check%that(abs(friction(i)) <= 0.17_dp*normal(i), 'friction does not exceed static friction and damping')
        end if
      end do
    end associate
    call check%that(most < 0.15_dp/2e4_dp*(1 + 1e-6_dp) .and. most > 0.099_dp/2e4_dp, 'bristles reach the break-away deflection')
  end subroutine bristles_live_in_contact

  !> The work of friction against Simpson's rule over a fine trace; and requesting it does not change a run.
  subroutine work_of_friction(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, quiet
    character(len=long), parameter :: laws(3) = [character(len=long) :: 'friction.law=coulomb', 'friction.law=stribeck', &
      'friction.law=elasto_plastic']
    character(len=long) :: overrides(6)
    real(dp) :: work
    integer :: k, i, n
    do k = 1, size(laws)
      overrides = [character(len=long) :: laws(k), 'friction.report_work=T', 'integrator.revolutions=0.3', &
        'output.samples_per_revolution=200000', 'integrator.relative_tolerance=1e-9', 'friction.transition_speed=1e-2']
      trace = run_case(lugre, overrides)
      overrides(2) = 'friction.report_work=F'
      quiet = run_case(lugre, overrides)
      associate (t => trace%values(1, :), power => trace%values(column(trace, 'friction_force[N]'), :)* &
                 trace%values(column(trace, 'sliding_speed[m/s]'), :), found => trace%report%figures%pin(piston_pin)%friction_work)
        n = size(t)
        work = 0
        do i = 1, n - 2, 2
          work = work + (t(i + 2) - t(i))*(power(i) + 4*power(i + 1) + power(i + 2))/6
        end do
        if (mod(n, 2) == 0) work = work + (t(n) - t(n - 1))*(power(n) + power(n - 1))/2
        call check%that(found < -0.1_dp, 'friction dissipates work: '//laws(k))
        call check%relative(found, work, 1e-5_dp, 'work of friction is the integral of force times speed: '//laws(k))
      end associate
      call check%that(maxval(abs(trace%values - quiet%values)) <= 0, 'a request of the friction work does not change a run')
      call check%that((quiet%report%figures%pin(piston_pin)%friction_work < 0) .eqv. k == 3, &
        'laws with bristles always have the friction work')
    end do
  end subroutine work_of_friction

  !> Stiff bristles: auto uses Radau in contact, and needs a small part of the evaluations of Adams.
  subroutine stiff_bristles_are_found(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: adams, auto
    integer, parameter :: with_radau = 2
    character(len=long), parameter :: stiff = 'friction.bristle_stiffness=1e7'
    adams = run_case(lugre, [character(len=long) :: stiff, 'integrator.revolutions=0.1', 'integrator.method=adams'])
    auto = run_case(lugre, [character(len=long) :: stiff, 'integrator.revolutions=0.1', 'integrator.method=auto'])
    associate (time => auto%report%time_with(:, 2))   ! times by method in contact
      call check%that(time(with_radau) > 0.9_dp*sum(time), 'auto uses Radau for stiff bristles')
    end associate
    call check%that(auto%report%statistics%evaluations < 0.2_dp*adams%report%statistics%evaluations, &
      'auto needs a small part of the evaluations of Adams')
  end subroutine stiff_bristles_are_found

  !> Bristles at both pins, with a state at each: two methods give the same contacts, and each pin has separate bristles and work.
  subroutine bristles_at_both_pins(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace(2)
    character(len=long) :: overrides(8)
    integer :: i, n
    overrides = [character(len=long) :: 'friction.law=elasto_plastic', 'friction.coefficient=0.1', &
      'friction.static_coefficient=0.15', 'friction.bristle_stiffness=2e4', 'friction.stribeck_speed=1e-2', &
      'integrator.relative_tolerance=1e-10', 'integrator.revolutions=0.15', 'integrator.method=adams']
    trace(1) = run_case('cases/joints/both_pins.nml', overrides)
    overrides(8) = 'integrator.method=radau'
    trace(2) = run_case('cases/joints/both_pins.nml', overrides)
    call check%that(.not. (allocated(trace(1)%error) .or. allocated(trace(2)%error)), 'runs with bristles at both pins')
    if (allocated(trace(1)%error) .or. allocated(trace(2)%error)) return
    n = size(trace(1)%event)
    call check%that(n > 8 .and. size(trace(2)%event) == n, 'bristles at both pins: number of contacts by both methods')
    if (size(trace(2)%event) == n) call check%close_to(maxval(abs(trace(2)%event%time - trace(1)%event%time)), 0.0_dp, 1e-8_dp, &
      'bristles at both pins: contact times by both methods')
    do i = 1, 2
      associate (z => trace(i)%values(column(trace(i), 'bristle[m]'), :), &
                 z_crank => trace(i)%values(column(trace(i), 'crank_pin_bristle[m]'), :), f => trace(i)%report%figures)
        call check%that(maxval(abs(z)) > 1e-6_dp .and. maxval(abs(z_crank)) > 1e-6_dp, 'bristles bend at both pins')
        call check%that(maxval(abs(z - z_crank)) > 1e-6_dp, 'each pin has separate bristles')
        call check%that(f%pin(piston_pin)%friction_work < 0 .and. f%pin(crank_pin)%friction_work < 0, &
          'each pin has its own friction work')
        call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-8_dp, 'energy residual with bristles at both pins')
      end associate
    end do
  end subroutine bristles_at_both_pins
end module test_friction_runs
