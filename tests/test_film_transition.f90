!> Transition from film to contact over a range of penetrations: kinks, derivatives, a whole mechanism against an independent
!> program, all methods, and errors in cases.
module test_film_transition
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use chain_motion, only: piston_pin
  use scene_problem, only: scene_t, evaluation_t
  use scene_builder, only: build_scene
  use ode_problem, only: difference_jacobian
  use state_making, only: set_crank, set_pin, set_contact
  use case_checks, only: expect, methods_agree
  use collecting_sink, only: trace_t, run_case, column, values_of
  implicit none
  private
  public :: run_test_film_transition

  character(len=*), parameter :: file = 'cases/film/weighted.nml'
  integer, parameter :: long = 60
  real(dp), parameter :: c = 0.2e-3_dp, q = 0.03_dp, depth = 3e-6_dp   !! values of the case

contains

  subroutine run_test_film_transition(check)
    class(checks_t), intent(inout) :: check
    call forces_have_no_jumps(check)
    call derivatives(check)
    call meets_the_reference(check)
    call methods_agree_on_it(check)
    call moment_has_its_share(check)
    call kinks_are_events(check)
    call starts_anywhere(check)
    call film_is_let_go(check)
    call sticks(check)
    call refuses(check)
  end subroutine run_test_film_transition

  !> The loads on the pin are the same on both sides of each kink and of the clearance.
  subroutine forces_have_no_jumps(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: kinks(3) = [c*(1 - q), c, c + depth]
    character(len=*), parameter :: names(3) = [character(len=20) :: 'at the film limit', 'at the clearance', 'at the end of film']
    character(len=long) :: shape(1)
    real(dp) :: inner(3), outer(3)
    integer :: i, k
    do k = 1, 2
      shape(1) = 'lubrication.transition_shape='//merge('linear', 'smooth', k == 1)
      do i = 1, 3
        inner = loads_at(shape, kinks(i)*(1 - 1e-13_dp))
        outer = loads_at(shape, kinks(i)*(1 + 1e-13_dp))
        call check%close_to(norm2(outer - inner), 0.0_dp, 1e-8_dp*norm2(outer), 'no jump '//trim(names(i)))
      end do
      ! at half of the depth the loads are the sum of the weighted loads in the columns
      call check%relative(pressing_at(shape, c + 0.5_dp*depth), 0.5_dp*hertz(0.5_dp*depth), 1e-6_dp, &
        'half of Hertz''s force at half of the depth')
    end do

  contains

    !> Hertz's force of steel spheres of 10 mm and 9.8 mm [N].
    pure real(dp) function hertz(d)
      real(dp), intent(in) :: d
      hertz = 4.0_dp/3*207e9_dp/(2*(1 - 0.3_dp**2))*sqrt(10e-3_dp*9.8e-3_dp/c)*d**1.5_dp
    end function hertz
  end subroutine forces_have_no_jumps

  !> Force and moment on the pin at an eccentricity, with some motion.
  function loads_at(overrides, distance) result(loads)
    character(len=*), intent(in) :: overrides(:)
    real(dp), intent(in) :: distance
    real(dp) :: loads(3)
    type(evaluation_t) :: now
    call evaluate_at(overrides, distance, [0.06_dp, 0.17_dp], now)
    loads = [now%loads%force(:, piston_pin), now%loads%moment(piston_pin)]
  end function loads_at

  !> The normal force at a constant eccentricity [N].
  real(dp) function pressing_at(overrides, distance)
    character(len=*), intent(in) :: overrides(:)
    real(dp), intent(in) :: distance
    type(evaluation_t) :: now
    call evaluate_at(overrides, distance, [-0.08_dp, 0.06_dp], now)
    pressing_at = now%joint(1)%normal_force
  end function pressing_at

  subroutine evaluate_at(overrides, distance, rate, now)
    character(len=*), intent(in) :: overrides(:)
    real(dp), intent(in) :: distance, rate(2)
    type(evaluation_t), intent(out) :: now
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:)
    logical :: inside
    call make_scene(overrides, distance, scene)
    y = scene%initial_state()
    call set_crank(scene, y, 0.3_dp, 520.0_dp)
    call set_pin(scene, y, distance*[0.6_dp, 0.8_dp], rate)
    call scene%evaluate(0.0_dp, y, now, inside)
  end subroutine evaluate_at

  !> The scene of the case, with its pin in the zone that belongs to an eccentricity.
  subroutine make_scene(overrides, distance, scene)
    character(len=*), intent(in) :: overrides(:)
    real(dp), intent(in) :: distance
    type(scene_t), allocatable, intent(out) :: scene
    type(case_t) :: case
    type(error_t), allocatable :: error
    call read_case(file, overrides, case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) error stop 'test_film_transition: the case cannot be built'
    call set_contact(scene%joints(1), 0.4_dp, 1)
    if (distance <= c) call scene%joints(1)%end_contact()
    call scene%joints(1)%begin_at(distance, 0.0_dp)
  end subroutine make_scene

  !> The closed-form Jacobian against finite differences, in each zone, for each film.
  subroutine derivatives(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: films(4) = [character(len=long) :: 'lubrication.variant=closed_form', &
      'lubrication.variant=half_film', 'lubrication.law=oscillating_film', 'lubrication.law=finite_bearing']
    character(len=long), parameter :: others(4) = [character(len=long) :: 'friction.law=brown_mcphee', 'friction.law=ambrosio', &
      'friction.law=brown_mcphee', 'friction.law=lugre']
    real(dp), parameter :: distances(4) = [0.9_dp*c, 0.985_dp*c, c + 0.4_dp*depth, c + 1.5_dp*depth]
    character(len=long) :: set(12)
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), d_p(:, :), d_v(:, :)
    integer :: i, j, m, k
    do i = 1, size(films)
      set = [character(len=long) :: films(i), others(i), 'drive.kind='//merge('constant_speed', 'free          ', i == 3), &
        'lubrication.kinematic_viscosity=1e-5', &
        'friction.static_coefficient=0.08', 'friction.transition_speed=0.3', 'friction.stribeck_speed=0.4', &
        'friction.bristle_stiffness=2e4', 'lubrication.transition_shape='//merge('linear', 'smooth', mod(i, 2) == 0), &
        'friction.damping_speed=0.3', 'friction.bristle_damping=0.1', '']
      set(12) = merge('lubrication.variant=short', 'lubrication.film_points=0', i == 4)
      do j = 1, size(distances)
        call make_scene(set, distances(j), scene)
        y = scene%initial_state()
        m = scene%n_positions
        k = m + scene%n_states()
        if (allocated(a_p)) deallocate (a_p, a_v, d_p, d_v)
        allocate (a_p(k, m), a_v(k, k), d_p(k, m), d_v(k, k))
        call set_crank(scene, y, 0.3_dp, 520.0_dp)
        call set_pin(scene, y, distances(j)*[cos(1.3_dp*j), sin(1.3_dp*j)], [0.11_dp, 0.07_dp])
        call scene%jacobian(0.0_dp, y, a_p, a_v)
        call difference_jacobian(scene, 0.0_dp, y, d_p, d_v)
        call check%close_to(maxval(abs(a_p - d_p)), 0.0_dp, 2e-4_dp*maxval(abs(d_p)), &
          'derivatives with respect to positions: '//films(i))
        call check%close_to(maxval(abs(a_v - d_v)), 0.0_dp, 2e-4_dp*maxval(abs(d_v)), &
          'derivatives with respect to rates: '//films(i))
      end do
    end do
  end subroutine derivatives

  !> Times and speeds of contacts by an independent program (Python, SciPy's DOP853 with events by root finding), with an accuracy
  !> of 3.1e-11 s.
  subroutine meets_the_reference(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: instants(5) = [0.000771425953518_dp, 0.00267020412613_dp, 0.00414047530389_dp, 0.0096517489615_dp, &
      0.0109421795383_dp]
    real(dp), parameter :: speeds(5) = [0.0203970365_dp, -0.0974650053_dp, 0.011820603_dp, -0.111840953_dp, 0.0177224925_dp]
    type(trace_t) :: trace
    integer :: i
    trace = run_case(file, [character(len=long) :: 'integrator.relative_tolerance=1e-10', 'integrator.revolutions=1'])
    call check%that(.not. allocated(trace%error), 'a run with a weighted transition')
    if (allocated(trace%error)) return
    call check%that(size(trace%event) == 5, 'the number of contacts')
    if (size(trace%event) /= 5) return
    do i = 1, 5
      call check%close_to(trace%event(i)%time, instants(i), 3e-10_dp, 'time at which a contact begins or ends')
      call check%relative(trace%event(i)%normal_speed, speeds(i), 1e-6_dp, 'speed at which a contact begins or ends')
    end do
  end subroutine meets_the_reference

  subroutine methods_agree_on_it(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=long) :: settings(2)
    integer :: k
    do k = 1, 2
      settings(1) = 'integrator.revolutions=0.7'
      settings(2) = 'lubrication.transition_shape='//merge('linear', 'smooth', k == 1)
      call methods_agree(check, file, settings, c, 'a weighted transition', trace)
      if (allocated(trace%error)) return
      call share_of_columns(check, trace)
    end do
  end subroutine methods_agree_on_it

  !> Rows in which film and contact carry load together have the share of their penetration; rows beyond the depth have no film.
  subroutine share_of_columns(check, trace)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: trace
    real(dp), dimension(size(trace%values, 2)) :: w, penetration, film, pressing
    w = trace%values(column(trace, 'contact_weight[-]'), :)
    penetration = -trace%values(column(trace, 'film_thickness[m]'), :)
    film = abs(trace%values(column(trace, 'film_force_x[N]'), :))
    pressing = trace%values(column(trace, 'normal_force[N]'), :)
    call check%that(any(w > 0 .and. w < 1 .and. film > 0 .and. pressing > 0), 'film and contact carry load together')
    call check%that(all((w > 0) .eqv. (penetration > 0)), 'the contact has a share if there is penetration')
    call check%that(all(film <= 0 .or. penetration < depth), 'no film beyond the depth')
    call check%that(any(penetration > depth .and. pressing > 0 .and. w >= 1), 'beyond the depth the contact carries the whole load')
  end subroutine share_of_columns

  !> The moment of the film on the pin is that of the limited film times its share.
  subroutine moment_has_its_share(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), dimension(:), allocatable :: w, moment
    trace = run_case(file, [character(len=long) :: 'lubrication.film_moment=T', 'integrator.revolutions=0.5', &
      'output.samples_per_revolution=20000'])
    call check%that(.not. allocated(trace%error), 'a run with the moment of the film')
    if (allocated(trace%error)) return
    allocate (w, source=trace%values(column(trace, 'contact_weight[-]'), :))
    allocate (moment, source=abs(trace%values(column(trace, 'film_moment[N.m]'), :)))
    call check%that(all(moment <= 0 .or. w < 1) .and. any(moment > 0 .and. w > 0.9_dp), &
      'the moment of a film vanishes with its share')
    call check%that(maxval(moment, mask=w <= 0) > maxval(moment, mask=w > 0.5_dp), &
      'the moment of a film is largest without contact')
    associate (power => trace%report%figures)
      call check%that(power%max_energy_residual < 1e-6_dp*power%max_energy, 'the work of the moment is in the energy')
    end associate
  end subroutine moment_has_its_share

  !> The pin passes the first kink before each contact, the second at full contact, and both on the way back: each is a restart.
  subroutine kinks_are_events(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(file, [character(len=long) :: 'integrator.method=adams', 'integrator.relative_tolerance=1e-7', &
      'integrator.revolutions=0.7'])
    call check%that(.not. allocated(trace%error), 'a run')
    if (allocated(trace%error)) return
    call check%that(trace%report%statistics%restarts >= size(trace%event) + 4, &
      'kinks are events in addition to those of the contact')
  end subroutine kinks_are_events

  !> Starts in each zone, on each kink, at rest and moving to either side.
  subroutine starts_anywhere(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: starts(6) = [0.98_dp*c, 0.97_dp*c, c, c + 0.5_dp*depth, c + depth, c + 2*depth]
    character(len=long) :: set(5)
    type(trace_t) :: trace
    integer :: i, j
    do i = 1, size(starts)
      do j = -1, 1
        set(1:3) = [character(len=long) :: 'integrator.revolutions=0.02', 'lubrication.transition_shape=linear', &
          'integrator.relative_tolerance=1e-8']
        write (set(4), '(a,es23.16,a)') 'initial.eccentricity=', starts(i), ',0'
        write (set(5), '(a,es23.16,a)') 'initial.eccentricity_rate=', 0.05_dp*j, ',0.01'
        trace = run_case(file, set)
        call check%that(.not. allocated(trace%error), 'a run that starts at '//set(4)//set(5))
        if (allocated(trace%error)) cycle
        associate (figures => trace%report%figures)
          call check%that(figures%max_energy_residual < 1e-6_dp*figures%max_energy, &
            'energy residual of a start at '//set(4)//set(5))
        end associate
      end do
    end do
  end subroutine starts_anywhere

  !> A pin at rest exactly where the film begins to be held, on each side of its bearing: on one of them it moves inward, and the
  !> film must not be held. The same motion begins a billionth further inside, where there is no doubt.
  subroutine film_is_let_go(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(5)
    type(trace_t) :: here, inside
    real(dp), allocatable :: x(:), y(:)
    integer :: side
    set(1:4) = [character(len=long) :: 'integrator.revolutions=0.02', 'lubrication.least_film_ratio=0.5', &
      'integrator.relative_tolerance=1e-9', 'initial.eccentricity_rate=0,0']
    do side = -1, 1, 2
      write (set(5), '(a,es23.16,a)') 'initial.eccentricity=', side*0.5_dp*c, ',0'
      here = run_case(file, set)
      write (set(5), '(a,es23.16,a)') 'initial.eccentricity=', side*0.5_dp*c*(1 - 1e-9_dp), ',0'
      inside = run_case(file, set)
      x = values_of(here, 'eccentricity_x[m]') - values_of(inside, 'eccentricity_x[m]')
      y = values_of(here, 'eccentricity_y[m]') - values_of(inside, 'eccentricity_y[m]')
      call check%close_to(maxval(abs(x) + abs(y)), 0.0_dp, 1e-7_dp*c, 'the film is held only beyond its reach: '//trim(set(5)))
    end do
  end subroutine film_is_let_go

  !> Set-valued friction sticks and slides with the contact's share of the load, and the energy residual is small.
  subroutine sticks(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(file, [character(len=long) :: 'friction.law=coulomb', 'friction.coefficient=0.1', &
      'integrator.revolutions=0.6', 'integrator.relative_tolerance=1e-8', 'initial.crank_speed=100', 'lubrication.viscosity=0.002'])
    call check%that(.not. allocated(trace%error), 'set-valued friction with a weighted transition')
    if (allocated(trace%error)) return
    associate (figures => trace%report%figures)
      call check%that(figures%max_energy_residual < 1e-6_dp*figures%max_energy, &
        'set-valued friction with a weighted transition: energy residual')
    end associate
    associate (friction => trace%values(column(trace, 'friction_force[N]'), :), &
               pressing => trace%values(column(trace, 'normal_force[N]'), :))
      call check%that(maxval(abs(friction) - 0.1_dp*pressing) < 1e-6_dp*maxval(pressing), 'set-valued friction is within its limit')
    end associate
  end subroutine sticks

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: weighted = "&lubrication viscosity=0.01 transition='weighted' transition_depth=1e-6 / "
    call expect(check, weighted, '&lubrication transition = weighted: needs the group contact', &
      'a weighted transition without contact')
    call expect(check, weighted//"&asperities roughness=1e-7 /", &
      '&lubrication transition = weighted: must be switch with asperities', 'asperities together with a weighted transition')
    call expect(check, "&contact / &lubrication viscosity=0.01 transition='weighted' /", &
      '&lubrication transition_depth: required with transition = ''weighted''', 'a transition without a depth')
    call expect(check, "&contact / &lubrication viscosity=0.01 transition='weighted' transition_depth=1e-3 /", &
      '&lubrication transition_depth = 1e-3: must be <= clearance', 'a transition deeper than the clearance')
    call expect(check, "&contact / &lubrication viscosity=0.01 transition_depth=1e-6 /", &
      '&lubrication transition_depth = 1e-6: needs transition = ''weighted''', 'a depth with a switch')
    call expect(check, "&contact / &lubrication viscosity=0.01 transition='weighted' transition_depth=-1e-6 /", &
      '&lubrication transition_depth = -1e-6: must be > 0', 'a negative depth')
    call expect(check, "&contact / "//weighted//" &friction law='coulomb' coefficient=0.1 /", '', 'a valid case')
  end subroutine refuses
end module test_film_transition
