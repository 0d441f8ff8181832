!> Runs with a piston guide with friction, or with clearance of the piston in its bore.
module test_guide
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use text_tools, only: replaced
  use checks, only: checks_t
  use number_text, only: short_text
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use collecting_sink, only: trace_t, run_case, column, values_of
  use chain_motion, only: tilting_t
  use joint_places, only: n_places
  use chain_motion, only: motion_t, accelerations_t
  use chain_loads, only: loads_t, unloaded
  use contact_laws, only: new_power_geometry
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t
  use guide_elements, only: build_guide
  use piston_skirt, only: skirt_t
  use run_state, only: run_state_t
  use state_layout, only: layout_t, slice_t
  use guide_events, only: inward_acceleration
  use piston_guide, only: piston_guide_t, guide_loads_t, corner_t, n_corners
  use laws, only: contact_law_of, friction_law_of
  use case_checks, only: expect
  use data_tables, only: load_table
  implicit none
  private
  public :: run_test_guide

  integer, parameter :: long = 60
  !> An element with a state, which another kind of element may have: a thickness that a flow fills and that friction empties.
  type, extends(guide_element_t) :: filling_film_t
  contains
    procedure :: prepare => prepare_film
    procedure :: find_loads => find_film_loads
  end type filling_film_t

  character(len=*), parameter :: slap = 'cases/joints/slider_clearance.nml', ideal = 'cases/flores/ideal.nml'

contains

  subroutine run_test_guide(check)
    class(checks_t), intent(inout) :: check
    call massless_rod_with_friction(check)
    call friction_of_an_ideal_guide(check)
    call friction_follows_the_law_of_the_pin(check)
    call corners_are_where_they_are(check)
    call forces_turn_the_piston(check)
    call elements_have_states(check)
    call corners_accelerate(check)
    call one_impact_gives_back_its_share(check)
    call energy_of_elastic_corners(check)
    call energy_with_all_losses(check)
    call energy_with_elastic_members(check)
    call no_event_is_lost(check)
    call methods_agree(check)
    call strong_damping_ends(check)
    call narrow_bore_is_an_ideal_guide(check)
    call compare_with_siconos(check)
    call follow_siconos(check)
    call rings_shear_their_film(check)
    call ring_refusals(check)
    call refusals(check)
    call what_leaves_is_named(check)
  end subroutine run_test_guide

  !> The friction of a smooth ring against the exact one of a parabolic face full of oil with Reynolds' condition: load over
  !> 6 mu U L^2/h^2 and friction over mu U L/h, with L half of the height and h the film, for crowns c h; by integrals in closed
  !> form. The constant coefficient of the ring is within 5 % of them.
  subroutine rings_shear_their_film(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: crown(3) = [1, 5, 10], load(3) = [0.0421218110261_dp, 0.0265285719526_dp, 0.0162521081081_dp], &
      friction(3) = [1.66463978413_dp, 1.26533435766_dp, 1.04465722465_dp]
    real(dp), parameter :: bore = 0.08_dp, mu = 0.01_dp, speed = 7, half = 1e-3_dp, film = 2e-6_dp
    real(dp) :: exact, tension
    integer :: i
    do i = 1, size(crown)
      exact = -pi*bore*mu*speed*half/film*friction(i)
      tension = 0.5_dp*bore*6*mu*speed*half**2/film**2*load(i)
      call check%close_to(friction_of(crown(i)*film, tension, 0.0_dp, speed), exact, 0.05_dp*abs(exact), 'ring: its friction')
      call check%close_to(friction_of(crown(i)*film, tension, 0.0_dp, -speed), -exact, 0.05_dp*abs(exact), 'ring: on the way back')
      call check%close_to(friction_of(crown(i)*film, 0.5_dp*tension, 0.25_dp*tension*pi*bore/half, speed), exact, &
        0.05_dp*abs(exact), 'ring: half of its load by gas above and behind')
    end do

  contains

    !> Friction of a ring with this crown [m] and tension [N] under this force of the gas on the piston [N].
    real(dp) function friction_of(height_of_crown, pull, gas, u)
      real(dp), intent(in) :: height_of_crown, pull, gas, u
      type(guide_case_t) :: wanted
      type(piston_guide_t) :: guide
      type(motion_t) :: motion
      type(guide_loads_t) :: now
      type(loads_t) :: all
      real(dp) :: y(1)
      wanted%kind = 'friction'
      wanted%bore = bore
      wanted%rings%oil%given_viscosity = mu
      allocate (wanted%rings%rings(1))
      wanted%rings%rings(1)%height = 2*half
      wanted%rings%rings(1)%crown = height_of_crown
      wanted%rings%rings(1)%tension = pull
      wanted%rings%rings(1)%gas_above = 1
      wanted%rings%rings(1)%gas_behind = 1
      call build_guide(wanted, guide)
      y = 0
      motion%piston_velocity = u
      all%axial_force = gas
      call guide%find_loads(motion, y, now, all)
      friction_of = now%friction_force
    end function friction_of
  end subroutine rings_shear_their_film

  !> Rings without oil or bore, and gas whose pressure rises from ring to ring, are refused.
  subroutine ring_refusals(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: ring = '&ring height=1e-3 crown=5e-6 tension=8 ', oil = '&lubrication place=''rings'' ', &
      gas = '&combustion bore=0.08 compression_ratio=9 heat_capacity_ratio=1.4 heat=100 wiebe_efficiency=5 wiebe_form=3 '// &
      'start_deg=340 duration_deg=40 / &lubrication viscosity=0.01 /'
    call expect(check, ring//'/ '//oil//'viscosity=0.01 / '//gas, '', 'a ring with oil')
    call expect(check, ring//'/ '//gas, '&ring_1: needs the group lubrication with place = ''rings'', its oil', &
      'a ring without oil')
    call expect(check, ring//'/ '//oil//'/ '//gas, '&lubrication of rings viscosity: required', 'oil without viscosity')
    call expect(check, ring//'/ '//oil//'oil=''SAE 30'' temperature=380 / '//gas, '', 'a named oil')
    call expect(check, ring//'/ '//oil//'oil=''SAE 30'' temperature=380 thinning_ratio=0.5 thinning_rate=1e5 / '//gas, &
      'thinning_ratio = 0.5: must be 1 in the oil of piston rings', 'shear thinning')
    call expect(check, ring//'/ '//oil//'viscosity=0.01 / &lubrication viscosity=0.01 /', &
      '&ring_1: needs the bore of &combustion or &cylinder_pressure', 'a ring without a bore')
    call expect(check, oil//'viscosity=0.01 / '//gas, '&lubrication of rings: needs the group ring', 'oil without a ring')
    call expect(check, '&asperities place=''rings'' roughness=1e-6 / '//gas, '&asperities of rings: needs the group ring', &
      'roughness without a ring')
    call expect(check, ring//'gas_behind=0.5 gas_below=0.6 / '//oil//'viscosity=0.01 / '//gas, &
      'gas_below = 0.6: must be <= gas_behind = 0.5', 'gas that rises below the ring')
    call expect(check, ring//'gas_above=0.5 / '//oil//'viscosity=0.01 / '//gas, 'gas_behind: must be <= gas_above = 0.5', &
      'gas that rises behind the ring')
    call expect(check, ring//'gas_below=0.1 / '//ring//'gas_above=0.2 / '//oil//'viscosity=0.01 / '//gas, &
      '&ring_2 gas_above = 0.2: must be <= gas_below of the ring above it = 0.1', 'gas that rises from ring to ring')
    call expect(check, repeat(ring//'/ ', 7)//oil//'viscosity=0.01 / '//gas, '&ring: at most 6 of these groups', 'seven rings')
    call expect(check, ring//'/ '//oil//'law=''pinkus_sternlicht'' viscosity=0.01 / '//gas, 'must be one of reynolds', &
      'a film of a joint')
    call expect(check, ring//'/ &lubrication place=''ring'' viscosity=0.01 / '//gas, 'did you mean rings?', 'a misspelt place')
  end subroutine ring_refusals

  !> A rod without mass is a bar with a force S along it. With friction mu |N| against the motion and N = S sin A, the equation of
  !> the piston is m x'' = S cos A - mu |S sin A| sign x'. The crank speed is constant, so that x'' is known.
  subroutine massless_rod_with_friction(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: r = 0.05_dp, l = 0.12_dp, m = 0.14_dp, speed = 200, mu = 0.3_dp
    type(trace_t) :: got
    real(dp), allocatable :: q(:), guide(:), friction(:)
    real(dp) :: sine, cosine, x_rate, x_acceleration, bar, rate, worst, s_over_n
    integer :: i
    got = run_case(ideal, [character(len=long) :: 'mechanism.rod_mass=0', 'mechanism.rod_inertia=0', 'mechanism.gravity=0', &
      'initial.crank_speed=200', 'guide.coefficient=0.3', 'guide.v0=0', 'guide.v1=1e-6', 'integrator.revolutions=1', &
      'output.samples_per_revolution=360'])
    q = values_of(got, 'crank_angle[rad]')
    guide = values_of(got, 'guide_force[N]')
    friction = values_of(got, 'guide_friction_force[N]')
    worst = 0
    do i = 1, size(q)
      sine = r*sin(q(i))/l
      cosine = sqrt(1 - sine**2)
      rate = r*cos(q(i))*speed/(l*cosine)
      x_rate = -r*sin(q(i))*speed - l*sine*rate
      if (abs(x_rate) < 1e-3_dp) cycle
      x_acceleration = -r*cos(q(i))*speed**2 - l*cosine*rate**2 - l*sine*(l*sine*rate**2 - r*sin(q(i))*speed**2)/(l*cosine)
      bar = m*x_acceleration/(cosine - mu*sign(1.0_dp, x_rate)*abs(sine)*sign(1.0_dp, x_acceleration))
      s_over_n = -sine   ! the rod is inclined towards -y and presses the piston to that side
      worst = max(worst, abs(guide(i) - bar*s_over_n), abs(friction(i) + mu*abs(bar*sine)*sign(1.0_dp, x_rate)))
    end do
    call check%that(size(q) == 361 .and. maxval(abs(friction)) > 20, 'a run with a massless rod has friction')
    call check%close_to(worst, 0.0_dp, 1e-9_dp, 'normal force and friction of a massless rod [N]')
  end subroutine massless_rod_with_friction

  !> With ideal pins, a free crank, gravity and heavy bodies: in every row the friction law holds for the guide force from Newton's
  !> law, the piston obeys Newton's law, the energy residual is small, and friction dissipates energy.
  subroutine friction_of_an_ideal_guide(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got, without
    real(dp), allocatable :: v(:), friction(:), normal(:), ramp(:)
    character(len=long), parameter :: common(5) = [character(len=long) :: 'drive.kind=free', 'mechanism.gravity=50', &
      'mechanism.gravity_angle_deg=40', 'integrator.relative_tolerance=1e-11', 'mechanism.crank_inertia=1e-3']
    got = run_case(ideal, [common, [character(len=long) :: 'guide.coefficient=0.2', 'guide.v0=0.01', 'guide.v1=0.5', &
      'guide.viscous=3']])
    without = run_case(ideal, common)
    v = values_of(got, 'piston_velocity[m/s]')
    normal = values_of(got, 'guide_force[N]')
    friction = values_of(got, 'guide_friction_force[N]')
    ramp = min(1.0_dp, max(0.0_dp, (abs(v) - 0.01_dp)/0.49_dp))
    call check%close_to(maxval(abs(friction + sign(0.2_dp*ramp*abs(normal), v) + 3*v)), 0.0_dp, 1e-9_dp, &
      'friction by law and normal force [N]')
    call check%close_to(maxval(abs(0.14_dp*(values_of(got, 'piston_acceleration[m/s2]') + 50*cos(40*degree)) &
      + values_of(got, 'pin_force_x[N]') - friction)), 0.0_dp, 1e-9_dp, 'Newton along the cylinder [N]')
    call check%close_to(maxval(abs(values_of(got, 'frame_force_x[N]') - values_of(got, 'crank_bearing_force_x[N]') - friction)), &
      0.0_dp, 1e-9_dp, 'force on the frame includes the friction [N]')
    call check%close_to(got%report%figures%max_energy_residual/got%report%figures%max_energy, 0.0_dp, 1e-10_dp, &
      'energy residual of friction on an ideal guide')
    associate (speed => column(got, 'crank_speed[rad/s]'), last => size(got%values, 2))
      call check%that(got%values(speed, last) < 0.99_dp*without%values(speed, last), 'friction slows the crank')
    end associate
  end subroutine friction_of_an_ideal_guide

  !> With clearance at the piston pin the normal force is the lateral pin force, also if the surfaces of the pin stick; if those of
  !> the crank pin stick, it is that of an ideal piston pin.
  subroutine friction_follows_the_law_of_the_pin(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: settings(8) = [character(len=long) :: 'drive.kind=free', 'mechanism.gravity_angle_deg=70', &
      'mechanism.gravity=30', 'integrator.revolutions=0.5', 'guide.law=threlfall', 'guide.coefficient=0.1', 'guide.v1=0.1', &
      'integrator.relative_tolerance=1e-10']
    call friction_by_law('cases/flores/friction_050.nml', settings)
    call friction_by_law('cases/friction/coulomb_static.nml', settings)
    call friction_by_law('cases/joints/both_pins.nml', settings)
    call friction_by_law('cases/joints/crank_pin.nml', [character(len=long) :: settings, 'crank_pin.friction.law=coulomb', &
      'crank_pin.friction.coefficient=0.15', 'crank_pin.friction.static_coefficient=0.25'])

  contains

    subroutine friction_by_law(case, settings)
      character(len=*), intent(in) :: case
      character(len=*), intent(in) :: settings(:)
      type(trace_t) :: got
      got = run_case(case, settings)
      associate (normal => values_of(got, 'guide_force[N]'), v => values_of(got, 'piston_velocity[m/s]'))
        call check%close_to(maxval(abs(values_of(got, 'guide_friction_force[N]') + 0.1_dp*(1 - exp(-3*min(1.0_dp, abs(v)/0.1_dp))) &
          *sign(abs(normal), v)))/maxval(abs(normal)), 0.0_dp, 1e-9_dp, case//': friction by law and normal force')
      end associate
      call check%close_to(got%report%figures%max_energy_residual/got%report%figures%max_energy, 0.0_dp, 1e-8_dp, &
        case//': energy residual with friction on the guide')
    end subroutine friction_by_law
  end subroutine friction_follows_the_law_of_the_pin

  !> Corners of a rotated rectangle, their gaps from the distance to the wall, and the rates of the gaps by finite differences.
  subroutine corners_are_where_they_are(check)
    class(checks_t), intent(inout) :: check
    type(piston_guide_t) :: guide
    type(corner_t) :: now(n_corners), later(n_corners)
    type(tilting_t) :: at
    real(dp) :: y, h(4), b(4), worst
    real(dp), parameter :: tilt = 0.03_dp, offset = 2e-4_dp, dt = 1e-6_dp
    integer :: i
    guide%clearance = 1e-3_dp
    guide%radius = 0.025_dp
    guide%height = [0.05_dp, -0.04_dp]
    at%offset = offset
    at%tilt = tilt
    at%offset_rate = 0.7_dp
    at%tilt_rate = -3
    call guide%place_corners(at, now)
    h = [0.05_dp, -0.04_dp, 0.05_dp, -0.04_dp]
    b = [0.025_dp, 0.025_dp, -0.025_dp, -0.025_dp]
    worst = 0
    do i = 1, 4
      y = offset + h(i)*sin(tilt) + b(i)*cos(tilt)
      worst = max(worst, abs((0.026_dp - sign(y, y*b(i))) + now(i)%depth))
    end do
    call check%close_to(worst, 0.0_dp, 1e-16_dp, 'gaps of the corners [m]')
    at%offset = offset + at%offset_rate*dt
    at%tilt = tilt + at%tilt_rate*dt
    call guide%place_corners(at, later)
    call check%close_to(maxval(abs((later%depth - now%depth)/dt - now%depth_rate)), 0.0_dp, 1e-5_dp, 'rates of the gaps [m/s]')
  end subroutine corners_are_where_they_are

  !> Forces at the corners of a tilted piston, all in the wall: their sum along and across the bore, and their moment about the
  !> centre of mass as the cross product of each corner's place with its force. Friction is mu N against the velocity of each
  !> corner; here the corners of one side move the other way than those of the other side.
  subroutine forces_turn_the_piston(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: tilt = 0.02_dp, h(4) = [0.05_dp, -0.04_dp, 0.05_dp, -0.04_dp], mu = 0.3_dp, c = 7
    real(dp), parameter :: b(4) = [0.025_dp, 0.025_dp, -0.025_dp, -0.025_dp]
    type(guide_case_t) :: wanted
    type(piston_guide_t) :: guide
    type(guide_loads_t) :: own
    type(motion_t) :: motion
    type(loads_t) :: all
    type(error_t), allocatable :: error
    real(dp) :: place(2), force(2), total(2), moment
    integer :: i
    wanted%kind = 'clearance'
    wanted%viscous = c
    call contact_law_of("law='lankarani_nikravesh'", wanted%contact, error)
    if (.not. allocated(error)) &
      call friction_law_of("law='ambrosio' coefficient=0.3 v0=0 v1=1e-9", wanted%friction, error)
    call check%that(.not. allocated(error), 'laws of a corner')
    if (allocated(error)) return
    call new_power_geometry(1e8_dp, 1.5_dp, wanted%contact%geometry)
    call build_guide(wanted, guide)
    guide%clearance = -2e-3_dp   ! in a bore too narrow for it every corner is in the wall
    guide%radius = 0.025_dp
    guide%height = h(:2)
    guide%touches = .true.
    guide%impact_speed = 1
    motion%tilting%offset = 1e-4_dp
    motion%tilting%offset_rate = 0
    motion%tilting%tilt = tilt
    motion%tilting%tilt_rate = 40
    motion%tilting%com_velocity = 0.3_dp
    motion%piston_velocity = 0
    all = unloaded
    call guide%find_loads(motion, [real(dp) ::], own, all)
    total = [-c*0.3_dp, 0.0_dp]
    moment = 0
    do i = 1, 4
      place = [h(i)*cos(tilt) - b(i)*sin(tilt), h(i)*sin(tilt) + b(i)*cos(tilt)]
      force = own%corner(i)%normal_force*[-mu*sign(1.0_dp, 0.3_dp - 40*place(2)), -sign(1.0_dp, b(i))]
      call check%that(own%corner(i)%normal_force > 0, 'a corner in the wall is pressed')
      total = total + force
      moment = moment + place(1)*force(2) - place(2)*force(1)
    end do
    call check%close_to(own%friction_force, total(1), 1e-12_dp*norm2(total), 'friction of four corners and of the rings [N]')
    call check%close_to(all%bore_force, total(2), 1e-12_dp*norm2(total), 'force of the bore across it [N]')
    call check%close_to(all%bore_moment, moment, 1e-12_dp*norm2(total), 'its moment about the centre of mass [N m]')
  end subroutine forces_turn_the_piston

  !> Two elements with a state each in an ideal guide beside its viscous friction: their states stand one after the other in the
  !> state vector, start, are declared and have rates; forces add up.
  subroutine elements_have_states(check)
    class(checks_t), intent(inout) :: check
    class(guide_element_t), allocatable :: film
    type(guide_case_t) :: wanted
    type(piston_guide_t) :: guide
    type(guide_loads_t) :: own
    type(layout_t) :: layout
    type(slice_t) :: before
    type(run_state_t) :: list
    type(motion_t) :: motion
    type(loads_t) :: all
    real(dp) :: y(3), dydt(3)
    integer :: i
    wanted%kind = 'friction'
    wanted%viscous = 7
    call build_guide(wanted, guide)
    do i = 1, 2
      allocate (filling_film_t :: film)
      call film%prepare(wanted)
      film%start = i*1e-6_dp
      call guide%add(film)
    end do
    do i = 1, 2
      call layout%claim_states(1, 1.0_dp, before)
      call guide%claim(layout, 100.0_dp, 1.0_dp)
      if (i == 1) call layout%count_again()
    end do
    call check%that(layout%n() == 3, 'states of two elements behind another one')
    y = [5.0_dp, 0.0_dp, 0.0_dp]
    call guide%set_start(y)
    call check%close_to(norm2(y - [5.0_dp, 1e-6_dp, 2e-6_dp]), 0.0_dp, 0.0_dp, 'states of elements at the start')
    call guide%declare(list, y)
    call check%that(size(list%numbers) == 2, 'numbers that they declare')
    call check%close_to(list%numbers(2)%values(1), 2e-6_dp, 0.0_dp, 'state of the second one')
    motion%piston_velocity = -3
    all = unloaded
    all%axial_force = 11
    call guide%find_loads(motion, y, own, all)
    call check%close_to(own%friction_force, 3*(7 + 3e-6_dp), 1e-14_dp, 'sum of the frictions of three elements [N]')
    dydt = 0
    call guide%set_rates(motion%tilting, 0.0_dp, 0.0_dp, own, dydt)
    call check%close_to(norm2(dydt - [0.0_dp, 11 - 3e-6_dp, 11 - 6e-6_dp]), 0.0_dp, 1e-14_dp, 'rates of their states')
  end subroutine elements_have_states

  subroutine prepare_film(self, wanted)
    class(filling_film_t), intent(inout) :: self
    type(guide_case_t), intent(in) :: wanted
    self%n_states = 1
    self%state_name = 'film'
    self%state_unit = 'm'
  end subroutine prepare_film

  pure subroutine find_film_loads(self, skirt, motion, y, now)
    class(filling_film_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)
    type(guide_loads_t), intent(inout) :: now
    associate (thickness => y(self%states%first))
      now%friction_force = now%friction_force - thickness*now%speed
      now%rates(self%rates%first) = now%gas_force - thickness*abs(now%speed)
    end associate
  end subroutine find_film_loads

  !> Second derivative of the penetration of every corner, by differences of its rate along a motion with constant accelerations.
  subroutine corners_accelerate(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: dt = 1e-6_dp
    type(piston_guide_t) :: guide
    type(corner_t) :: before(n_corners), now(n_corners), after(n_corners)
    type(motion_t) :: motion
    type(accelerations_t) :: accelerations
    integer :: i
    guide%clearance = 1e-3_dp
    guide%radius = 0.025_dp
    guide%height = [0.05_dp, -0.04_dp]
    accelerations%offset = 300
    accelerations%tilt = -2000
    call place(-dt, before)
    call place(dt, after)
    call place(0.0_dp, now)
    do i = 1, n_corners
      call check%close_to(inward_acceleration(i, now(i), motion, accelerations), &
        (after(i)%depth_rate - before(i)%depth_rate)/(2*dt), 1e-5_dp, 'acceleration of a corner into the wall [m/s^2]')
    end do

  contains

    subroutine place(t, corners)
      real(dp), intent(in) :: t
      type(corner_t), intent(inout) :: corners(n_corners)
      motion%tilting%offset = 2e-4_dp + 0.7_dp*t + 150*t**2
      motion%tilting%offset_rate = 0.7_dp + 300*t
      motion%tilting%tilt = 0.3_dp - 60*t - 1000*t**2
      motion%tilting%tilt_rate = -60 - 2000*t
      call guide%place_corners(motion%tilting, corners)
    end subroutine place
  end subroutine corners_accelerate

  !> A single corner hits the wall with the coefficient of restitution. The error decreases with increasing stiffness: the duration
  !> of the contact, in which other forces act as well, is inversely proportional to the root of the stiffness.
  subroutine one_impact_gives_back_its_share(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got
    character(len=long) :: stiffness
    real(dp) :: miss(4)
    integer :: i, k
    do k = 1, 4
      write (stiffness, '(a,i0)') 'guide.stiffness=1e', 4 + 2*k
      got = run_case(slap, [character(len=long) :: stiffness, 'initial.piston_tilt=0.015', 'initial.piston_tilt_rate=0', &
        'integrator.relative_tolerance=1e-10', 'integrator.end_time=0.004', 'guide.coefficient=0'])
      miss(k) = huge(1.0_dp)
      do i = 1, size(got%event) - 1
        if (got%event(i)%kind /= 1) cycle
        miss(k) = abs(-got%event(i + 1)%normal_speed/got%event(i)%normal_speed - 0.4_dp)
        call check%that(got%event(i + 1)%kind == 2 .and. got%event(i + 1)%pin == got%event(i)%pin, 'one corner is in contact alone')
        call check%that(got%event(i)%pin == n_places + 1, 'the corner at the top, towards +y')
        exit
      end do
    end do
    call check%that(miss(4) < 1e-3_dp, 'restitution of a stiff corner')
    do k = 2, 4
      call check%relative(miss(k)/miss(k - 1), 0.1_dp, 0.35_dp, 'error of the restitution over the root of the stiffness')
    end do
  end subroutine one_impact_gives_back_its_share

  !> Energy with corners without loss: clearance at the piston pin, pin offset, gravity across the cylinder, hundreds of events.
  subroutine energy_of_elastic_corners(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got
    real(dp) :: drift(2)
    integer :: i
    character(len=long), parameter :: tolerance(2) = [character(len=long) :: 'integrator.relative_tolerance=1e-8', &
      'integrator.relative_tolerance=1e-10']
    do i = 1, 2
      got = run_case('cases/joints/piston_slap.nml', [character(len=long) :: tolerance(i), 'contact.law=hertz', &
        'friction=none', 'guide.contact_law=hertz', 'guide.coefficient=0', 'guide.exponent=1.5', 'guide.stiffness=1e10', &
        'integrator.method=adams', 'drive.kind=free', 'guide.viscous=0'])
      call check%that(size(got%event) > 200, 'elastic corners have many contacts')
      drift(i) = got%report%figures%max_energy_residual/got%report%figures%max_energy
    end do
    call check%close_to(drift(1), 0.0_dp, 3e-7_dp, 'energy drift of elastic corners at 1e-8')
    call check%close_to(drift(2), 0.0_dp, 3e-9_dp, 'energy drift of elastic corners at 1e-10')
  end subroutine energy_of_elastic_corners

  !> With friction and losses at the pin and at the corners, and friction of the rings: the energy lost is the work of all these
  !> forces.
  subroutine energy_with_all_losses(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got
    integer :: i
    character(len=long), parameter :: scenes(4) = [character(len=long) :: 'integrator.method=adams', 'integrator.method=radau', &
      'contact.restitution=0.5', 'joint.clearance=5e-4']
    do i = 1, size(scenes)
      got = run_case('cases/joints/piston_slap.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-11', scenes(i), &
        'drive.kind=free', 'integrator.revolutions=0.5'])
      associate (energy => values_of(got, 'energy[J]'))
        call check%that(energy(1) - energy(size(energy)) > 0.02_dp*energy(1), 'energy decreases by the losses')
      end associate
      call check%close_to(got%report%figures%max_energy_residual/got%report%figures%max_energy, 0.0_dp, 2e-9_dp, &
        'energy lost is the work of all forces: '//trim(scenes(i)))
    end do
  end subroutine energy_with_all_losses

  !> The same with an elastic rod and an elastic crankshaft: with clearance at the pin, with ideal pins and clearance in the bore,
  !> and with friction on the guide only.
  subroutine energy_with_elastic_members(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: ideal_pin(3) = [character(len=long) :: 'joint=none', 'contact=none', 'friction=none']
    character(len=*), parameter :: elastic(7) = [character(len=long) :: 'elastic_rod.youngs_modulus=207e9', &
      'elastic_rod.section_area=9.6e-5', 'elastic_rod.section_inertia=5.12e-10', 'crankshaft.flywheel_inertia=0.002', &
      'crankshaft.torsional_stiffness=2e4', 'integrator.relative_tolerance=1e-8', 'integrator.revolutions=0.1']
    call runs([character(len=long) :: elastic, 'drive.kind=free'], 'clearance at the pin')
    call runs([character(len=long) :: elastic, ideal_pin], 'ideal pins')
    call runs([character(len=long) :: elastic, ideal_pin, 'guide.kind=friction'], 'friction only')

  contains

    subroutine runs(overrides, what)
      character(len=*), intent(in) :: overrides(:), what
      type(trace_t) :: got
      got = run_case('cases/joints/piston_slap.nml', overrides)
      call check%that(got%report%status == 'done', 'run with elastic rod and shaft in a bore: '//what)
      call check%close_to(got%report%figures%max_energy_residual/got%report%figures%max_energy, 0.0_dp, 1e-9_dp, &
        'energy residual with elastic rod and shaft: '//what)
      associate (reached => maxval(abs(values_of(got, 'guide_friction_force[N]'))))
        call check%that(reached > 5, 'the guide has friction: '//what)
      end associate
    end subroutine runs
  end subroutine energy_with_elastic_members

  !> Every row with a corner in the wall belongs to a contact of this corner, contacts of a corner begin and end alternately, and
  !> they begin and end at the wall; two corners that hit the wall at the same time have two contacts.
  subroutine no_event_is_lost(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got
    character(len=7) :: name
    integer :: i, pin, kind
    got = run_case('cases/joints/piston_slap.nml', [character(len=long) :: 'output.every_step=T', &
      'guide.contact_law=hertz'])
    do pin = n_places + 1, n_places + n_corners
      kind = 2
      do i = 1, size(got%event)
        if (got%event(i)%pin /= pin) cycle
        call check%that(got%event(i)%kind /= kind, 'contacts of a corner begin and end alternately')
        kind = got%event(i)%kind
      end do
      write (name, '(a,i0)') 'guide_', pin - n_places
      associate (gap => values_of(got, name//'_gap[m]'), force => values_of(got, name//'_force[N]'), &
          f => got%report%figures%corner(pin - n_places))
        call check%that(.not. any(gap < -1e-9_dp .and. .not. abs(force) > 0), 'a corner in the wall has a force')
        call check%that(.not. any(gap > 1e-12_dp .and. abs(force) > 0), 'a corner apart from the wall has no force')
        call check%that(count(got%event%pin == pin .and. got%event%kind == 1) == f%contacts, 'number of contacts of a corner')
        call check%that(f%contacts > 0, 'every corner has contacts')
        call check%that(f%max_force >= maxval(force) .and. f%max_penetration >= maxval(-gap), 'no row exceeds the extremes')
        call check%relative(f%max_penetration, maxval(got%event%max_penetration, got%event%pin == pin), 1e-12_dp, &
          'largest penetration of a corner')
      end associate
    end do
    got = run_case(slap, [character(len=long) :: 'initial.piston_tilt_rate=0', 'integrator.end_time=0.003', &
      'guide.coefficient=0'])
    call check%that(got%event(1)%pin + got%event(2)%pin == 2*n_places + 3 .and. all(got%event(:2)%kind == 1), &
      'both ends have a contact')
    call check%close_to(got%event(2)%time - got%event(1)%time, 0.0_dp, 1e-12_dp, 'contacts of both ends begin at the same time [s]')
    call check%relative(got%event(3)%max_normal_force, got%event(4)%max_normal_force, 1e-6_dp, &
      'contacts of both ends have the same force')
    call check%close_to(got%event(3)%normal_speed/got%event(1)%normal_speed, -0.4_dp, 4e-3_dp, &
      'restitution of simultaneous contacts')
  end subroutine no_event_is_lost

  !> Both methods give the same motion, with ideal pins and with clearance.
  subroutine methods_agree(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: one, other
    character(len=*), parameter :: common(1) = [character(len=long) :: 'integrator.relative_tolerance=1e-10']
    integer :: i
    character(len=*), parameter :: files(2) = [character(len=long) :: slap, 'cases/joints/piston_slap.nml']
    character(len=*), parameter :: short(2) = [character(len=long) :: 'integrator.end_time=0.004', 'integrator.revolutions=0.1']
    do i = 1, 2
      one = run_case(trim(files(i)), [character(len=long) :: common, short(i), 'integrator.method=adams'])
      other = run_case(trim(files(i)), [character(len=long) :: common, short(i), 'integrator.method=radau'])
      associate (a => values_of(one, 'piston_offset[m]'), b => values_of(other, 'piston_offset[m]'))
        call check%that(size(one%event) > 3 .and. size(one%event) == size(other%event), 'both methods find the same events')
        call check%close_to(maxval(abs(a - b)), 0.0_dp, 1e-4_dp*maxval(abs(a)), trim(files(i))//': Adams and Radau [m]')
      end associate
    end do
  end subroutine methods_agree

  !> A piston that is pressed into the wall by a corner far from its centre of mass and one at it, without load, with the damping
  !> of a restitution of 0.01 at this speed: chi = 100 over it. The damping brings both corners to -0.01 of the speed of the impact
  !> within 1e-5 s, where the force ends, since it never pulls: the piston then does not turn. Radau must notice that the stiffness
  !> with which a step was begun is gone. 40 tolerances are allowed; the error was 90 to 2000 while Newton's steps alone were the
  !> measure of its convergence.
  subroutine strong_damping_ends(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: speed = 6.86e-4_dp, tolerance = 7e-8_dp, offsets(4) = [8.47e-6_dp, 8.3e-6_dp, 9e-6_dp, 8e-6_dp]
    character(len=long), parameter :: still(20) = [character(len=long) :: 'initial.crank_speed=0', 'drive.kind=constant_speed', &
      'integrator.revolutions=0', 'integrator.end_time=7e-5', 'output.interval=7e-6', 'guide.kind=clearance', &
      'guide.contact_law=exact', 'guide.dissipation=1.45772595e5', 'guide.exponent=1.0', 'guide.stiffness=1.4e7', &
      'guide.bore_clearance=7.7e-6', 'guide.piston_radius=0.017', 'guide.piston_inertia=1.2e-5', 'guide.skirt_top=0.2', &
      'guide.skirt_bottom=0.001', 'initial.piston_offset_rate=6.86e-4', 'mechanism.gravity=0', 'initial.crank_angle_deg=0', &
      'integrator.method=radau', 'integrator.relative_tolerance=1e-5']
    type(trace_t) :: run
    real(dp), allocatable :: turning(:), leaving(:)
    character(len=long) :: offset
    integer :: i
    do i = 1, size(offsets)
      write (offset, '(a, es9.2)') 'initial.piston_offset=', offsets(i)
      run = run_case(ideal, [still, offset])
      turning = values_of(run, 'piston_tilt_rate[rad/s]')
      leaving = values_of(run, 'piston_offset_rate[m/s]')
      associate (last => size(turning))
        call check%close_to(turning(last), 0.0_dp, 40*tolerance, 'the piston does not turn, '//trim(offset))
        call check%close_to(leaving(last), -0.01_dp*speed, 0.02_dp*speed, 'speed of the separation, '//trim(offset))
      end associate
    end do
  end subroutine strong_damping_ends

  !> In the limit of no clearance in the bore the guide is ideal.
  subroutine narrow_bore_is_an_ideal_guide(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got, want
    integer :: i
    real(dp) :: miss(2)
    character(len=long), parameter :: narrow(2) = [character(len=long) :: 'guide.bore_clearance=1e-5', 'guide.bore_clearance=1e-6']
    character(len=long), parameter :: common(4) = [character(len=long) :: 'guide.coefficient=0', 'integrator.end_time=0.02', &
      'initial.piston_tilt_rate=0', 'guide.stiffness=1e10']
    want = run_case(slap, [character(len=long) :: 'guide=none', 'integrator.end_time=0.02', 'initial.piston_tilt_rate=0', &
      'integrator.relative_tolerance=1e-10'])
    do i = 1, 2
      got = run_case(slap, [common, narrow(i)])
      associate (a => column(got, 'crank_angle[rad]'), b => column(want, 'crank_angle[rad]'))
        miss(i) = maxval(abs(got%values(a, :) - want%values(b, :)))
      end associate
    end do
    call check%that(miss(1) < 2e-3_dp .and. miss(2) < 2e-4_dp, 'a narrow bore is nearly an ideal guide')
  end subroutine narrow_bore_is_an_ideal_guide

  !> The benchmark of Flores, Leine and Glocker (2010) against Siconos, whose walls are rigid: the same motion up to the first
  !> impact, and nearly the same after it.
  subroutine compare_with_siconos(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: want(:, :)
    character(len=*), parameter :: methods(2) = [character(len=long) :: 'integrator.method=auto', &
      'integrator.relative_tolerance=1e-8']
    integer :: i, before, early
    call load_table('siconos_guide_clearance.csv', names, want)
    do i = 1, size(methods)
      got = run_case(slap, [methods(i)])
      call check%that(size(got%values, 2) == size(want, 2), 'number of rows of Siconos')
      before = count(want(1, :) <= got%event(1)%time)
      early = count(want(1, :) <= 0.04_dp)
      call check%that(before > 12, 'rows before the first impact')
      associate (across => values_of(got, 'piston_offset[m]')/1e-3_dp, angle => values_of(got, 'rod_angle[rad]'), &
          revolutions => values_of(got, 'crank_angle[rad]')/two_pi)
        call check%close_to(maxval(abs(across(:before) - want(8, :before))), 0.0_dp, 5e-4_dp, 'y/c before the first impact')
        call check%close_to(maxval(abs(angle(2:before) + want(4, 2:before))), 0.0_dp, 2e-6_dp, &
          'rod angle before the first impact [rad]')
        call check%close_to(maxval(abs(revolutions - want(2, :))), 0.0_dp, 0.005_dp, 'crank angle over 0.2 s [revolutions]')
        call check%close_to(sum(abs(across(:early) - want(8, :early)))/early, 0.0_dp, 0.1_dp, 'y/c over 40 ms, on average')
      end associate
    end do
  end subroutine compare_with_siconos

  !> Runs from Siconos's state just after this impact, in which both ends of the slider hit nearly at once: they converge to rigid
  !> walls with increasing stiffness, until both ends hit again at 26 ms. The softest one is followed to the end.
  subroutine follow_siconos(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: stiffness(3) = [character(len=5) :: '1e8', '1e9', '1e10']
    real(dp), parameter :: near(3) = [5e-4_dp, 3e-4_dp, 1e-4_dp]   ! allowed error up to 20 ms, in clearances
    real(dp), parameter :: until(3) = [0.1972_dp, 0.0402_dp, 0.0402_dp]   ! [s] after the impact
    type(trace_t) :: got
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: want(:, :)
    character(len=long) :: settings(3)
    integer :: i, first, n, m, last
    call load_table('siconos_guide_clearance.csv', names, want)
    first = count(want(1, :) < 2.8e-3_dp - 1e-9_dp)
    do i = 1, size(stiffness)
      settings = 'integrator.relative_tolerance=1e-9'
      settings(1:2) = [character(len=long) :: 'guide.stiffness='//stiffness(i), &
        'integrator.end_time='//short_text(until(i))]
      got = run_case('cases/joints/slider_after_impact.nml', settings)
      last = first + size(got%values, 2)
      call check%that(last == count(want(1, :) < 2.8e-3_dp + until(i) + 1e-9_dp), &
        'number of rows of Siconos after the first impact')
      associate (across => abs(values_of(got, 'piston_offset[m]')/1e-3_dp - want(8, first + 1:last)), &
          turned => abs(values_of(got, 'crank_angle[rad]')/two_pi - want(2, first + 1:last)))
        n = count(want(1, first + 1:) < 0.0201_dp)
        m = count(want(1, first + 1:) < 0.0401_dp)
        call check%close_to(sum(across(:n))/n, 0.0_dp, near(i), 'y/c to 20 ms, on average, '//stiffness(i)//' N/m')
        call check%close_to(sum(across(:m))/m, 0.0_dp, 0.01_dp, 'y/c to 40 ms, on average, '//stiffness(i)//' N/m')
        call check%close_to(maxval(turned), 0.0_dp, 0.005_dp, 'crank angle to the end, '//stiffness(i)//' N/m [revolutions]')
      end associate
    end do
  end subroutine follow_siconos

  !> A run that ends because a body leaves the range of its model names this body: the piston in a soft bore, alone and beside a
  !> loose pin, this pin in a soft bearing, and an elastic rod between ideal pins.
  subroutine what_leaves_is_named(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: both = 'cases/joints/piston_slap.nml'
    type(trace_t) :: run
    call ends_with(slap, ['guide.stiffness=1e2'], 'the piston left its bore')
    call check%that(index(run%report%status, ' phase') == 0, 'ideal pins have no phase')
    call ends_with(both, ['guide.stiffness=1e3'], 'the piston left its bore')
    call ends_with(both, ['contact.youngs_modulus=1e6,1e6'], 'the pin left its bearing or its film')
    call ends_with(ideal, [character(len=long) :: 'elastic_rod.youngs_modulus=1e13', 'elastic_rod.section_area=1e-5', &
      'elastic_rod.section_inertia=5e-8', 'elastic_rod.transverse_modes=1', 'elastic_rod.axial_shapes=1', &
      'elastic_rod.damping_ratio=0.999', 'mechanism.piston_mass=1e4', 'mechanism.crank_inertia=1e-6', &
      'initial.crank_angle_deg=90', 'guide.coefficient=2', 'guide.v0=0.001', 'guide.v1=0.98', 'integrator.method=auto'], &
      'the elastic rod bent or stretched beyond the validity of its equations')

  contains

    subroutine ends_with(file, overrides, wanted)
      character(len=*), intent(in) :: file, overrides(:), wanted
      run = run_case(file, overrides)
      call check%that(index(run%report%status, 'the state left the range of the model ('//wanted//') at t = ') == 1, wanted)
    end subroutine ends_with
  end subroutine what_leaves_is_named

  subroutine refusals(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: lost = ': must be > 0', needs = ': required with kind = ''clearance'''
    call refused(slap, 'guide.stiffness=0', 'slider_clearance.nml: &guide stiffness = 0'//lost//' (N/m^exponent)')
    call refused(slap, 'guide.skirt_top=-1', 'slider_clearance.nml: &guide skirt_top = -1'//lost//' (m)')
    call refused(ideal, 'guide.kind=clearance', 'ideal.nml: &guide bore_clearance'//needs//' (m)'//achar(10)// &
      'ideal.nml: &guide skirt_top'//needs//' (m)'//achar(10)//'ideal.nml: &guide skirt_bottom'//needs//' (m)'//achar(10)// &
      'ideal.nml: &guide piston_radius'//needs//' (m)'//achar(10)//'ideal.nml: &guide piston_inertia'//needs//' (kg m^2)'// &
      achar(10)//'ideal.nml: &guide stiffness'//needs//' (N/m^exponent)')
    call refused(ideal, 'guide.bore_clearance=1e-4', 'ideal.nml: &guide bore_clearance = 1e-4: needs kind = ''clearance''; the '// &
      'default is friction (m)')
    call refused(ideal, 'guide.v1=0 guide.coefficient=0.1 guide.v0=0', 'ideal.nml: &guide v1 = 0: must be > 0: friction on the '// &
      'guide is a function of the speed (m/s)')
    call refused(ideal, 'guide.coefficient=2.2', 'ideal.nml: &guide coefficient = 2.2: friction over normal force must stay < '// &
      '2.18174, the least cotangent of the rod angle: more would jam the piston: per cent?')
    call refused(ideal, 'initial.piston_tilt=0.1', 'ideal.nml: &initial piston_tilt = 0.1: must be 0 without clearance in the '// &
      'bore (&guide kind = ''clearance'') (rad)')
    call refused(slap, 'initial.piston_tilt=2', 'slider_clearance.nml: &initial piston_tilt = 2: must be > -1 and < 1 (rad): '// &
      'degrees?')
    call refused(slap, 'initial.piston_offset=0.03', 'slider_clearance.nml: &initial piston_offset = 0.03: must be shorter '// &
      'than bore_clearance + piston_radius = 0.026 (m): millimetres?')
    call refused(slap, 'initial.piston_tilt=0.9', 'slider_clearance.nml: &initial piston_tilt = 0.9: must not put a corner of '// &
      'the skirt into the bore''s wall by more than piston_radius = 0.025 (rad): degrees?')
    call refused(ideal, 'guide.law=coulomb', 'ideal.nml: --set guide.law=coulomb: &guide law = coulomb: must be one of '// &
      'ambrosio, threlfall, brown_mcphee, stribeck')

  contains

    !> A case with overrides, separated by blanks, is refused with this message.
    subroutine refused(file, overrides, message)
      character(len=*), intent(in) :: file, overrides, message
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=long) :: words(3)
      integer :: n, first, last
      n = 0
      first = 1
      do while (first <= len(overrides))
        last = first + index(overrides(first:)//' ', ' ') - 2
        n = n + 1
        words(n) = overrides(first:last)
        first = last + 2
      end do
      call read_case(file, words(:n), case, error)
      call check%that(allocated(error), 'refused: '//overrides)
      if (.not. allocated(error)) return
      error%message = replaced(error%message, file(:index(file, '/', back=.true.)), '')
      call check%equal_text(error%message, message, 'message')
    end subroutine refused
  end subroutine refusals
end module test_guide
