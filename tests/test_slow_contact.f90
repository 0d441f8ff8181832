!> Contacts that begin slowly or exist at the start: the restitution of very slow impacts, a pin at rest in its bearing, the start
!> in contact and exactly at the wall.
module test_slow_contact
  use kinds, only: dp
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use bearing_size, only: bearing_t
  use hertz_sphere, only: hertz_sphere_t
  use free_impact, only: exact_restitution
  use scene_problem, only: event_contact_begins
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_slow_contact

  integer, parameter :: long = 70
  character(len=*), parameter :: dry = 'cases/flores/dry_0100um.nml'

  !> The crank hangs at rest, and the pin carries the piston.
  character(len=long), parameter :: hanging(6) = [character(len=long) :: 'initial.crank_angle_deg=180', &
    'initial.crank_speed=0', 'integrator.revolutions=0', 'output.interval=1e-3', 'mechanism.gravity=9.80665', 'drive.kind=free']

contains

  subroutine run_test_slow_contact(check)
    class(checks_t), intent(inout) :: check
    call pin_comes_to_rest(check)
    call start_in_contact(check)
    call released_spring(check)
    call released_skirt(check)
    call pressed_pump(check)
    call start_on_the_wall(check)
    call start_off_centre(check)
    call revolution_has_a_budget(check)
    call contacts_beyond_validity_count(check)
  end subroutine run_test_slow_contact

  !> Released in the centre the pin bounces, settles and carries the piston: K delta^1.5 = m g; for every restitution and
  !> method, with a limited number of contacts.
  subroutine pin_comes_to_rest(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=long), parameter :: settings(4) = [character(len=long) :: 'contact.restitution=0', &
      'contact.restitution=0.5', 'contact.restitution=0.5', 'contact.restitution=0.9']
    character(len=long), parameter :: methods(4) = [character(len=long) :: 'integrator.method=auto', &
      'integrator.method=auto', 'integrator.method=radau', 'integrator.method=adams']
    real(dp) :: depth
    integer :: i
    do i = 1, size(settings)
      trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=0.2', settings(i), methods(i)])
      call check%that(.not. allocated(trace%error), 'a pin that settles is simulated to the end')
      if (allocated(trace%error)) cycle
      depth = resting_depth()
      call check%relative(-last(trace, 'film_thickness[m]'), depth, 1e-4_dp, &
        'penetration of the pin at rest')
      call check%that(trace%report%figures%pin(piston_pin)%contacts < 60, 'number of bounces')
      call check%that(trace%report%figures%max_energy_residual < 1e-6_dp*trace%report%figures%max_energy, &
        'a pin that settles: energy residual')
    end do
  end subroutine pin_comes_to_rest

  !> A column in the first row, and in the last.
  pure real(dp) function first(trace, name)
    type(trace_t), intent(in) :: trace
    character(len=*), intent(in) :: name
    first = trace%values(column(trace, name), 1)
  end function first

  pure real(dp) function last(trace, name)
    type(trace_t), intent(in) :: trace
    character(len=*), intent(in) :: name
    last = trace%values(column(trace, name), size(trace%values, 2))
  end function last

  !> Speed and time at which a mass leaves a spring of the force k d^n (1 + chi d'/v) that releases it from rest at a depth; v is
  !> the speed of the free impact to this depth. In closed form; the time by the midpoint rule, over a power of the speed in which
  !> the integrand is smooth.
  subroutine release(mass, stiffness, exponent, chi, depth, speed, duration)
    real(dp), intent(in) :: mass, stiffness, exponent, chi, depth
    real(dp), intent(out) :: speed, duration
    integer, parameter :: n = 400
    real(dp) :: impact, back, s, u, remaining
    integer :: i
    impact = sqrt(stiffness*depth**(exponent + 1)/((exponent + 1)*mass*energy(0.0_dp)))
    back = exact_restitution(chi)
    speed = impact*back
    duration = 0
    do i = 1, n   ! u = d'/v from -e, where the force vanishes, to 0
      s = (i - 0.5_dp)/n
      u = -back*(1 - s**(exponent + 1))
      remaining = (energy(u)*mass*impact**2*(exponent + 1)/stiffness)**(1/(exponent + 1))
      duration = duration + mass*impact*back*(exponent + 1)*s**exponent/n/(stiffness*remaining**exponent*(1 + chi*u))
    end do

  contains

    !> Elastic energy over m v^2 at the speed u v.
    pure real(dp) function energy(u)
      real(dp), intent(in) :: u
      energy = (1 - u)/chi - log((1 + chi)/(1 + chi*u))/chi**2
    end function energy
  end subroutine release

  !> A pin released from rest in its bearing, without other forces, leaves it as in the second half of a free impact.
  subroutine released_spring(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: chi = 0.75_dp*(1 - 0.5_dp**2), depth = 5e-6_dp
    type(trace_t) :: trace
    type(hertz_sphere_t) :: steel
    real(dp) :: speed, duration
    steel%youngs_modulus = 207e9_dp
    steel%poissons_ratio = 0.3_dp
    call steel%prepare(bearing_t(radius=0.010_dp, clearance=1e-4_dp))
    call release(0.14_dp, steel%stiffness, 1.5_dp, chi, depth, speed, duration)
    trace = run_case(dry, [character(len=long) :: 'initial.crank_speed=0', 'integrator.revolutions=0', 'output.interval=1e-5', &
      'integrator.end_time=2e-4', 'contact.restitution=0.5', 'initial.eccentricity=1.05e-4,0', &
      'integrator.relative_tolerance=1e-9'])
    call check%that(size(trace%event) >= 2, 'a pin released in its bearing leaves it')
    if (size(trace%event) < 2) return
    call check%relative(-trace%event(2)%normal_speed, speed, 1e-6_dp, 'a pin released in its bearing: its speed')
    call check%relative(trace%event(2)%time, duration, 1e-5_dp, 'a pin released in its bearing: the time')
  end subroutine released_spring

  !> The same for both corners of a skirt that moves across its bore without tilting, with the rod about the crank pin.
  subroutine released_skirt(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: chi = 0.75_dp*(1 - 0.6_dp**2), mass = 0.14_dp + (2.5e-4_dp + 0.21_dp*0.06_dp**2)/0.12_dp**2
    type(trace_t) :: trace
    real(dp) :: speed, duration
    integer :: i
    call release(mass, 2e8_dp, 1.0_dp, chi, 4e-6_dp, speed, duration)
    trace = run_case('cases/joints/piston_slap.nml', [character(len=long) :: 'joint.kind=ideal', 'contact=none', 'friction=none', &
      'initial.crank_speed=0', 'integrator.revolutions=0', 'output.interval=1e-5', 'integrator.end_time=2e-4', &
      'guide.piston_com=0,0', 'guide.skirt_top=0.02', 'guide.viscous=0', 'guide.coefficient=0', 'initial.piston_offset=1.04e-4', &
      'integrator.relative_tolerance=1e-9', 'drive.kind=constant_speed'])
    call check%that(.not. allocated(trace%error) .and. size(trace%event) >= 4, 'a skirt released in its bore leaves it')
    if (allocated(trace%error) .or. size(trace%event) < 4) return
    do i = 3, 4   ! the skirt turns by less than 1e-7 rad
      call check%relative(-trace%event(i)%normal_speed, speed, 1e-4_dp, 'a skirt released in its bore: its speed')
      call check%relative(trace%event(i)%time, duration, 1e-4_dp, 'a skirt released in its bore: the time')
    end do
  end subroutine released_skirt

  !> A pump whose pin is pressed the same way all the time, started in the equilibrium of its first load: penetration by the force
  !> of the machine with an ideal joint. The pin's own vibration is a thousandth of it.
  subroutine pressed_pump(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: pump, ideal
    character(len=*), parameter :: file = 'tests/pressed_pump.nml'
    pump = run_case(file, [character(len=long) ::])
    ideal = run_case(file, [character(len=long) ::], ideal_joint=.true.)
    call check%that(.not. allocated(pump%error) .and. .not. allocated(ideal%error), 'a pressed pump')
    if (allocated(pump%error) .or. allocated(ideal%error)) return
    call check%relative(pump%report%figures%pin(piston_pin)%max_penetration, &
      (ideal%report%figures%pin(piston_pin)%max_force/1e11_dp)**(2/3.0_dp), 2e-3_dp, 'a pressed pump: penetration')
    call check%relative(pump%report%figures%pin(piston_pin)%longest_contact, pump%report%figures%time, 1e-9_dp, &
      'a pressed pump: one contact lasts')
  end subroutine pressed_pump

  !> Penetration at which the elastic force carries the piston of the dry case [m].
  real(dp) function resting_depth()
    type(hertz_sphere_t) :: steel
    steel%youngs_modulus = 207e9_dp
    steel%poissons_ratio = 0.3_dp
    call steel%prepare(bearing_t(radius=0.010_dp, clearance=1e-4_dp))
    resting_depth = (0.14_dp*9.80665_dp/steel%stiffness)**(2/3.0_dp)
  end function resting_depth

  !> A pin that starts at rest with a larger penetration than in equilibrium, but with less elastic energy (2/5 K delta^2.5) than
  !> its weight needs to leave (m g delta), remains in contact and reaches the equilibrium.
  subroutine start_in_contact(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=0.05', 'initial.eccentricity=1.0006e-4,0', &
      'contact.restitution=0.5'])
    call check%that(.not. allocated(trace%error), 'a start in contact is simulated')
    if (allocated(trace%error)) return
    call check%relative(-first(trace, 'film_thickness[m]'), 6e-8_dp, 1e-6_dp, 'the first row is the start')
    call check%that(nint(first(trace, 'phase[-]')) == 2, 'phase at a start in contact')
    call check%relative(-last(trace, 'film_thickness[m]'), resting_depth(), 1e-4_dp, 'penetration at the end is that at rest')
    call check%that(size(trace%event) == 1, 'a start in contact has one contact, which does not end')
    if (size(trace%event) == 0) return
    call check%that(trace%event(1)%kind == event_contact_begins .and. trace%event(1)%time <= 0, 'the contact begins at the start')
  end subroutine start_in_contact

  !> Start exactly at the clearance and at rest: if gravity presses the pin to the wall there is contact, otherwise free flight.
  subroutine start_on_the_wall(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=*), parameter :: rounded(6) = [character(len=44) :: '4.8496e-05,6.362497924557619e-05', &
      '8.592e-06,7.95372713638078e-05', '2.5136e-05,7.594854510785576e-05', '5.111200000000001e-05,6.154318366805539e-05', &
      '1.992e-06,7.997519575468384e-05', '5.616e-06,7.98026349439666e-05']
    integer :: i
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=0.05', 'initial.eccentricity=1e-4,0'])
    call check%that(size(trace%event) == 1, 'a pin pressed to the wall stays there')
    call check%relative(-last(trace, 'film_thickness[m]'), resting_depth(), 1e-3_dp, 'a pin pressed to the wall comes to rest')
    do i = 1, size(rounded)   ! x^2 + y^2 and the clearance squared differ by rounding
      trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=2e-3', 'joint.clearance=8e-5', &
        'initial.eccentricity='//rounded(i)])
      call check%that(size(trace%event) == 1, 'a pin pressed to the wall stays there, whatever the rounding of '//rounded(i))
      trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=2e-4', 'joint.clearance=8e-5', &
        'initial.eccentricity=-'//rounded(i)])
      call check%that(size(trace%event) == 0, 'a pin that gravity lifts off has no contact, whatever the rounding of '//rounded(i))
    end do
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=1e-3', 'initial.eccentricity=-1e-4,0'])
    call check%that(size(trace%event) == 0, 'a pin that gravity lifts off has no contact')
    call check%relative(last(trace, 'film_thickness[m]'), 0.5_dp*9.80665_dp*1e-6_dp, 1e-3_dp, &
      'a pin that gravity lifts off falls freely')
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=1e-3', 'initial.eccentricity=0,1e-4', &
      'initial.eccentricity_rate=0,0.1'])
    call check%that(size(trace%event) >= 1, 'a pin that moves towards the wall has a contact')
    if (size(trace%event) == 0) return
    call check%relative(trace%event(1)%normal_speed, 0.1_dp, 1e-12_dp, 'impact speed is the initial speed')
  end subroutine start_on_the_wall

  !> Free flight without gravity from an initial eccentricity and rate: a straight line to the wall.
  subroutine start_off_centre(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: hanging(:4), 'drive.kind=constant_speed', 'integrator.end_time=1e-3', &
      'initial.eccentricity=3e-5,0', 'initial.eccentricity_rate=0.5,0'])
    call check%that(size(trace%event) > 0, 'the pin reaches the wall')
    if (size(trace%event) == 0) return
    call check%relative(trace%event(1)%time, 7e-5_dp/0.5_dp, 1e-9_dp, 'time of the contact after free flight')
    call check%relative(trace%event(1)%normal_speed, 0.5_dp, 1e-9_dp, 'impact speed after free flight')
  end subroutine start_off_centre

  !> The limit of evaluations per revolution stops a run that the limit for the whole run would allow, and the message names
  !> the place.
  subroutine revolution_has_a_budget(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: 'integrator.max_evaluations_per_revolution=1000'])
    call check%that(allocated(trace%error), 'the limit per revolution stops a run')
    if (allocated(trace%error)) &
      call check%that(index(trace%error%message, 'limit of evaluations in one revolution reached') == 1, &
        'message about the limit per revolution')
    call check%that(trace%report%statistics%evaluations >= 1000 .and. trace%report%statistics%evaluations < 1100, 'soon')
    trace = run_case(dry, [character(len=long) :: 'integrator.max_evaluations_per_revolution=8000', &
      'integrator.revolutions=6'])
    call check%that(.not. allocated(trace%error), 'a run within the limit per revolution is finished')
    call check%that(trace%report%statistics%evaluations > 8000, 'the run exceeds the limit per revolution as a whole')
  end subroutine revolution_has_a_budget

  !> A contact that is deeper than its geometry is valid for is counted once.
  subroutine contacts_beyond_validity_count(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: geometry(4) = [character(len=30) :: 'contact.geometry=johnson', &
      'contact.geometry=conformal', 'contact.geometry=pereira', 'contact.geometry=hertz_sphere']
    type(trace_t) :: trace
    integer :: i, deep
    do i = 1, size(geometry)
      trace = run_case('cases/flores/dry_0100um.nml', [character(len=40) :: geometry(i), 'joint.bearing_length=0.002', &
        'integrator.revolutions=0.5'])
      call check%that(.not. allocated(trace%error), 'a run with '//geometry(i))
      if (allocated(trace%error)) return
      deep = count(trace%event%kind == 2 .and. trace%event%max_penetration > 0.3_dp*0.1e-3_dp)
      call check%that(deep > 0 .or. i == 4, 'contacts are deep with '//geometry(i))
      if (i > 1) deep = 0
      associate (pin => trace%report%figures%pin(piston_pin))
        call check%that(pin%contacts_beyond_validity == deep, 'contacts beyond validity with '//geometry(i))
        call check%that(pin%contacts > deep, 'contacts within validity with '//geometry(i))
      end associate
    end do
  end subroutine contacts_beyond_validity_count
end module test_slow_contact
