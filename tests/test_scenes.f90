!> Contact and friction in whole scenes: contact entry by step rejection, sticking, energy, columns and components as needed.
module test_scenes
  use kinds, only: dp
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use scene_problem, only: scene_t, evaluation_t, phase_contact, event_contact_begins, event_contact_ends
  use state_making, only: set_crank, set_pin, set_contact
  use ode_method, only: ode_settings_t, step_too_small
  use scene_builder, only: build_scene, settings_for
  use stop_reason, only: reason
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_scenes

  integer, parameter :: long = 60

contains

  subroutine run_test_scenes(check)
    class(checks_t), intent(inout) :: check
    call step_rejection_limits_entry(check)
    call rejected_steps_are_not_counted(check)
    call sticking_is_the_limit_of_ramps(check)
    call sticking_keeps_the_sliding_speed(check)
    call energy_is_accounted_for(check)
    call outside_the_pin_is_known(check)
    call contact_events_are_consistent(check)
    call columns_are_those_asked_for(check)
    call failures_name_their_place(check)
    call event_at_the_end(check)
    call ideal_scene_runs(check)
  end subroutine run_test_scenes

  !> The entry is no deeper than allowed, no impact is missed, and the times converge to those by roots as the allowed depth
  !> decreases.
  subroutine step_rejection_limits_entry(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: root, coarse, fine
    character(len=long) :: settings(2)
    real(dp) :: error(2)

    settings = [character(len=long) :: 'integrator.relative_tolerance=1e-9', 'integrator.revolutions=0.4']
    root = run_case('cases/flores/dry_0100um.nml', settings)
    coarse = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: settings, &
      'integrator.contact_entry=step_rejection', 'integrator.max_penetration=1e-8'])
    fine = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: settings, &
      'integrator.contact_entry=step_rejection', 'integrator.max_penetration=1e-10'])
    call check%that(size(root%event) >= 20, 'number of contacts')
    call check%that(root%report%figures%pin(piston_pin)%max_entry_penetration < 1e-14_dp, 'a root enters without penetration')
    call check%that(coarse%report%figures%pin(piston_pin)%max_entry_penetration <= 1e-8_dp, 'entry within 1e-8 m')
    call check%that(fine%report%figures%pin(piston_pin)%max_entry_penetration <= 1e-10_dp, 'entry within 1e-10 m')
    call check%that(coarse%report%statistics%rejected_penetration > 0, 'steps were rejected for their depth')
    call check%that(root%report%statistics%rejected_penetration == 0, 'no step is rejected for its depth with roots')
    call check%that(size(coarse%event) == size(root%event) .and. size(fine%event) == size(root%event), &
      'step rejection misses no contact')
    if (size(coarse%event) /= size(root%event) .or. size(fine%event) /= size(root%event)) return
    error(1) = maxval(abs(coarse%event(:10)%time - root%event(:10)%time))
    error(2) = maxval(abs(fine%event(:10)%time - root%event(:10)%time))
    call check%that(error(1) < 1e-6_dp .and. error(2) < 0.05_dp*error(1), 'contact times converge with the allowed depth')
  end subroutine step_rejection_limits_entry

  !> Hundreds of steps are rejected, by the error and for their depth. Contacts and extremes are those of the accepted steps: every
  !> accepted step is a row, every contact begins and ends once, and extremes are those of rows so close that none is missed.
  subroutine rejected_steps_are_not_counted(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, fine
    character(len=long) :: settings(5)
    integer :: i, begun, wrong

    settings = [character(len=long) :: 'integrator.relative_tolerance=1e-7', 'integrator.revolutions=0.4', &
      'integrator.contact_entry=step_rejection', 'integrator.max_penetration=1e-9', 'output.samples_per_revolution=500000']
    fine = run_case('cases/flores/dry_0100um.nml', settings)
    trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: settings, 'output.every_step=T'])
    associate (s => trace%report%statistics, figures => trace%report%figures, e => trace%event)
      call check%that(s%rejected_error > 50 .and. s%rejected_penetration > 10, 'enough steps are rejected')
      begun = 0
      wrong = 0
      do i = 1, size(e)
        if (e(i)%kind /= merge(event_contact_begins, event_contact_ends, mod(i, 2) == 1)) wrong = wrong + 1
        if (e(i)%kind == event_contact_begins) begun = begun + 1
      end do
      call check%that(wrong == 0 .and. begun == figures%pin(piston_pin)%contacts, &
        'contacts begin and end alternately, each counted once')
      call check%that(s%restarts == size(e), 'one restart for each event')
      call check%that(size(trace%values, 2) - s%accepted >= 1 .and. size(trace%values, 2) - s%accepted <= 1 + size(e), &
        'a row for every accepted step, none for the others')
      call check%that(figures%evaluations == size(trace%values, 2) + size(e) + figures%peak_evaluations, &
        'number of evaluations for rows, figures, events and extremes')
      call check%relative(figures%pin(piston_pin)%max_penetration, maxval(-fine%values(column(fine, 'film_thickness[m]'), :)), &
        1e-6_dp, &
        'the largest penetration is that of the accepted steps')
      call check%relative(figures%pin(piston_pin)%max_force, maxval(hypot(fine%values(column(fine, 'pin_force_x[N]'), :), &
        fine%values(column(fine, 'pin_force_y[N]'), :))), 1e-6_dp, 'the largest force is that of the accepted steps')
    end associate
  end subroutine rejected_steps_are_not_counted

  !> Coulomb friction with sticking found by events, against Ambrosio's ramps of increasing slope.
  subroutine sticking_is_the_limit_of_ramps(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: coulomb, ramp
    character(len=long) :: settings(2)
    real(dp) :: error(3)
    integer :: i, n
    character(len=long), parameter :: speeds(3) = [character(len=long) :: 'friction.v1=1e-2', 'friction.v1=1e-3', &
      'friction.v1=1e-4']

    settings = [character(len=long) :: 'integrator.relative_tolerance=1e-9', 'integrator.revolutions=0.5']
    coulomb = run_case('cases/flores/friction_100.nml', [character(len=long) :: settings, 'friction.law=coulomb', &
      'friction.v0=0', 'friction.v1=0'])
    call check%that(.not. allocated(coulomb%error), 'a run with Coulomb friction')
    do i = 1, 3
      ramp = run_case('cases/flores/friction_100.nml', [character(len=long) :: settings, 'friction.v0=0', speeds(i)])
      n = min(size(ramp%event), size(coulomb%event), 10)
      call check%that(n == 10, 'number of contacts with Coulomb friction')
      error(i) = maxval(abs(ramp%event(:n)%time - coulomb%event(:n)%time))
    end do
    call check%that(error(2) < 0.3_dp*error(1) .and. error(3) < 0.3_dp*error(2), 'ramps converge to Coulomb friction')
    call check%close_to(coulomb%report%figures%max_energy_residual/coulomb%report%figures%max_energy, 0.0_dp, 1e-7_dp, &
      'energy residual with Coulomb friction')
  end subroutine sticking_is_the_limit_of_ramps

  !> With the friction force of a sticking pin the sliding speed does not change along the motion: central differences
  !> along the right-hand side, at constant crank speed and with a free crank.
  subroutine sticking_keeps_the_sliding_speed(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    type(evaluation_t) :: now, ahead, behind
    real(dp), allocatable :: y(:), f(:)
    real(dp) :: t, dt
    logical :: in_domain
    integer :: i
    character(len=long) :: overrides(4)

    dt = 1e-9_dp
    do i = 1, 6
      overrides = [character(len=long) :: 'friction.law=coulomb', 'friction.v0=0', 'friction.v1=0', &
        'drive.kind=constant_speed']
      if (i > 3) overrides(4) = 'drive.kind=free'
      call read_case('cases/flores/friction_100.nml', overrides, case, error)
      call build_scene(case, .false., scene, error)
      allocate (y(scene%n), f(scene%n))
      y = scene%initial_state()
      call set_pin(scene, y, 1.02_dp*case%joints(piston_pin)%clearance*[cos(1.3_dp*i), sin(1.3_dp*i)], &
        [0.4_dp*cos(2.1_dp*i), 0.3_dp*sin(1.7_dp*i)])
      call set_contact(scene%joints(1), 1.0_dp, 0)
      t = 1e-3_dp*i
      call scene%derivatives(t, y, f, in_domain)
      call scene%evaluate(t, y, now, in_domain)
      call scene%evaluate(t + dt, y + dt*f(:scene%n), ahead, in_domain)
      call scene%evaluate(t - dt, y - dt*f(:scene%n), behind, in_domain)
      call check%that(abs(now%joint(1)%friction_force) > 1, 'a sticking pin has a friction force')
      call check%close_to((ahead%joint(1)%sliding_speed - behind%joint(1)%sliding_speed)/(2*dt), 0.0_dp, 1e-2_dp, &
        'rate of the sliding speed of a sticking pin [m/s2]')
      deallocate (y, f)
    end do
  end subroutine sticking_keeps_the_sliding_speed

  !> Where a film is not defined, an evaluation still gives the crank angle and the position of the pin; also if the rod is too
  !> short.
  subroutine outside_the_pin_is_known(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    type(evaluation_t) :: now
    real(dp), allocatable :: y(:)
    logical :: in_domain
    character(len=1) :: none(0)
    call read_case('cases/sim_I.nml', none, case, error)
    call build_scene(case, .false., scene, error)
    allocate (y(scene%n), source=0.0_dp)
    call set_crank(scene, y, 0.4_dp, 250.0_dp)
    call set_pin(scene, y, [3e-5_dp, 4e-5_dp], [0.3_dp, 0.4_dp])
    call scene%evaluate(0.0_dp, y, now, in_domain)
    call check%that(.not. in_domain, 'the film is not defined beyond the wall')
    call check%relative(now%motion%crank_angle, 0.4_dp, 1e-15_dp, 'the crank angle is known beyond the wall')
    call check%relative(now%joint(1)%penetration, 5e-5_dp - case%joints(piston_pin)%clearance, 1e-12_dp, &
      'the penetration is known beyond the wall')
    call check%relative(now%joint(1)%penetration_rate, 0.5_dp, 1e-12_dp, 'the penetration rate is known beyond the wall')
    call set_pin(scene, y, [0.0_dp, -1.0_dp], [0.0_dp, 0.0_dp])
    call scene%evaluate(0.0_dp, y, now, in_domain)
    call check%that(.not. in_domain, 'the state is not defined if the rod is too short')
    call check%relative(now%motion%crank_angle, 0.4_dp, 1e-15_dp, 'the crank angle is known if the rod is too short')
  end subroutine outside_the_pin_is_known

  !> Energy residual relative to the largest energy.
  subroutine energy_is_accounted_for(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=40), parameter :: files(4) = [character(len=40) :: 'cases/sim_I.nml', 'cases/flores/dry_0500um.nml', &
      'cases/flores/friction_050.nml', 'cases/flores/lubricated_400cP.nml']
    integer :: i
    do i = 1, size(files)
      trace = run_case(trim(files(i)), [character(len=long) :: 'integrator.relative_tolerance=1e-9', &
        'integrator.revolutions=1', 'integrator.method=adams'])
      call check%close_to(trace%report%figures%max_energy_residual/trace%report%figures%max_energy, 0.0_dp, 1e-7_dp, &
        'energy residual of '//trim(files(i)))
      associate (r => trace%values(column(trace, 'energy_residual[J]'), :))
        call check%that(maxval(abs(r)) <= trace%report%figures%max_energy_residual*(1 + 1e-6_dp) + 1e-9_dp, &
          'rows do not exceed the extremes of the steps')
      end associate
    end do
  end subroutine energy_is_accounted_for

  subroutine contact_events_are_consistent(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    integer :: i
    real(dp) :: contact_time, total

    trace = run_case('cases/flores/dry_0500um.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-9', &
      'integrator.revolutions=1'])
    contact_time = 0
    do i = 1, size(trace%event)
      call check%that(trace%event(i)%kind == merge(1, 2, mod(i, 2) == 1), 'contacts begin and end alternately')
      if (i > 1) call check%that(trace%event(i)%time > trace%event(i - 1)%time, 'events are in the order of time')
      if (trace%event(i)%kind == 1) then
        call check%that(trace%event(i)%normal_speed > 0, 'the pin moves outwards at the beginning of a contact')
      else
        call check%that(trace%event(i)%normal_speed < 0, 'the pin moves inwards at the end of a contact')
        call check%relative(trace%event(i)%duration, trace%event(i)%time - trace%event(i - 1)%time, 1e-12_dp, 'duration')
        call check%that(trace%event(i)%max_penetration > 0 .and. trace%event(i)%max_normal_force > 0, 'largest values of a contact')
        contact_time = contact_time + trace%event(i)%duration
      end if
    end do
    total = trace%report%figures%pin(piston_pin)%contact_time
    if (mod(size(trace%event), 2) == 1) contact_time = contact_time + &
      (trace%values(1, size(trace%values, 2)) - trace%event(size(trace%event))%time)   ! the last contact does not end
    call check%relative(total, contact_time, 1e-9_dp, 'contact time')
    call check%that(trace%report%figures%pin(piston_pin)%max_entry_penetration < 1e-14_dp, 'contact begins at zero penetration')
    associate (f => trace%values(column(trace, 'normal_force[N]'), :), h => trace%values(column(trace, 'film_thickness[m]'), :))
      call check%that(all(f >= 0), 'the contact force never pulls')
      call check%that(all(f > 0 .eqv. h < -1e-15_dp), 'there is a contact force exactly where there is penetration')
    end associate
    associate (fx => trace%values(column(trace, 'pin_force_x[N]'), :), &
               ax => trace%values(column(trace, 'piston_acceleration[m/s2]'), :))
      call check%close_to(maxval(abs(fx + 0.14_dp*ax)), 0.0_dp, 1e-9_dp, 'force and acceleration of the piston in every row')
    end associate
  end subroutine contact_events_are_consistent

  subroutine columns_are_those_asked_for(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/flores/dry_0500um.nml', [character(len=long) :: 'integrator.revolutions=0.1', &
      'output.columns=time, phase, crank_angle', 'output.samples_per_revolution=100'])
    call check%that(size(trace%names) == 3 .and. size(trace%values, 2) == 11, 'three columns, eleven rows')
    call check%that(trace%names(2) == 'crank_angle[rad]', 'columns have a fixed order')
    trace = run_case('cases/flores/dry_0500um.nml', [character(len=long) :: 'output.columns=time, cylinder_pressure'])
    call check%that(allocated(trace%error), 'a column that the scene lacks is refused')
    trace = run_case('cases/sim_IV.nml', [character(len=long) :: 'integrator.revolutions=0.02'])
    associate (v => trace%values(column(trace, 'cylinder_volume[m3]'), :))
      call check%that(abs(v(1)*8/(0.07_dp**2*atan(1.0_dp)*0.1016_dp) - 1) < 1e-12_dp .and. v(size(v)) > v(1), &
        'the cylinder volume starts at the dead volume, V_d/8, and grows')
    end associate
    trace = run_case('cases/sim_I.nml', [character(len=long) :: 'integrator.revolutions=0.02'])
    call check%that(column(trace, 'film_force_x[N]') > 0 .and. column(trace, 'cylinder_pressure[Pa]') == 0, &
      'a scene has the columns of its models')
  end subroutine columns_are_those_asked_for

  subroutine failures_name_their_place(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_I.nml', [character(len=long) :: 'integrator.max_steps=100'])
    call check%that(allocated(trace%error), 'too many steps end a run')
    if (.not. allocated(trace%error)) return
    call check%that(index(trace%error%message, 'max_steps') > 0 .and. index(trace%error%message, 'crank angle') > 0 &
      .and. index(trace%error%message, 'phase film') > 0, 'the message names the reason, the angle and the phase')
    call check%that(size(trace%values, 2) > 1 .and. trace%report%statistics%accepted == 100, 'rows of a run that stops are kept')
    trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: 'contact.youngs_modulus=1e6, 1e6'])
    call check%that(allocated(trace%error), 'a pin that leaves its bearing ends a run')
    if (.not. allocated(trace%error)) return
    call check%that(index(trace%error%message, 'left the range of the model') > 0 .and. index(trace%error%message, 'contact') > 0, &
      'the message says that the state left the model')
    trace = run_case('cases/sim_I.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-16'])
    call check%that(allocated(trace%error), 'a tolerance below rounding is refused')
    call ends_with(check, 'cases/sim_I_oscillating.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-15', &
      'integrator.method=auto'], 'tolerance below the rounding of the')
    call ends_with(check, 'cases/sim_I.nml', [character(len=long) :: 'initial.eccentricity=-2.02e-5,0', &
      'integrator.method=auto'], 'ill-posed: the film')
    call small_steps_have_causes(check)
  end subroutine failures_name_their_place

  !> A pin pressed deep into its bearing: late in a run the rounding of the time alone changes the state by more than a tolerance.
  subroutine small_steps_have_causes(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    type(ode_settings_t) :: settings
    real(dp), allocatable :: y(:)
    call read_case('cases/flores/dry_0100um.nml', [character(len=long) :: 'initial.eccentricity=1e-3,0'], case, error)
    call build_scene(case, .false., scene, error)
    call check%that(scene%joints(1)%phase == phase_contact, 'the pin starts in contact')
    settings = settings_for(case, scene)
    allocate (y(scene%n))
    y = scene%initial_state()
    call check%equal_text(reason(step_too_small, scene, settings, 1e3_dp, y), &
      'too stiff: in the smallest representable time step the state changes by more than the tolerance', 'reason late in the run')
    call check%equal_text(reason(step_too_small, scene, settings, 1e-6_dp, y), 'the step size became too small', &
      'reason early in the run')
  end subroutine small_steps_have_causes

  !> A run ends with a reason.
  subroutine ends_with(check, file, overrides, wanted)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, overrides(:), wanted
    type(trace_t) :: trace
    trace = run_case(file, overrides)
    call check%that(allocated(trace%error), 'ends: '//wanted)
    if (allocated(trace%error)) call check%equal_text(trace%error%message(:min(len(wanted), len(trace%error%message))), wanted, &
      'reason')
  end subroutine ends_with

  !> The cylinder opens at the end of the run within rounding: no step fits between.
  subroutine event_at_the_end(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_V.nml', [character(len=long) :: 'initial.crank_angle_deg=180', 'drive.kind=constant_speed', &
      'integrator.revolutions=1', 'integrator.method=radau'])
    call check%that(.not. allocated(trace%error), 'an event at the end of a run is its end')
    call check%that(size(trace%values, 2) == 721, 'a run with an event at its end has all rows')
  end subroutine event_at_the_end

  !> A free ideal mechanism without losses has constant energy; at constant speed the change of energy is the work of the moment.
  subroutine ideal_scene_runs(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_I.nml', [character(len=40) :: 'integrator.relative_tolerance=1e-10'], .true.)
    call check%that(.not. allocated(trace%error), 'the ideal twin of simulation I runs')
    associate (e => trace%values(column(trace, 'energy[J]'), :), r => trace%values(column(trace, 'energy_residual[J]'), :))
      call check%close_to(maxval(abs(r))/e(1), 0.0_dp, 1e-8_dp, 'energy of the ideal twin is conserved')
    end associate
    call check%that(column(trace, 'film_thickness[m]') == 0, 'an ideal joint has no film column')
    trace = run_case('cases/flores/ideal.nml', [character(len=40) :: ])
    associate (r => trace%values(column(trace, 'energy_residual[J]'), :), e => trace%values(column(trace, 'energy[J]'), :))
      call check%close_to(maxval(abs(r))/maxval(e), 0.0_dp, 1e-5_dp, 'work of the moment at constant speed')
      call check%that(maxval(e) - minval(e) > 0.1_dp*maxval(e), 'energy changes at constant speed')
    end associate
  end subroutine ideal_scene_runs
end module test_scenes
