!> Contacts that begin slowly or exist at the start: the restitution of very slow impacts, a pin at rest on its bearing, the start
!> in contact and exactly at the wall.
module test_slow_contact
  use gudgeon_kinds, only: dp
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use contact_stiffness, only: hertz_stiffness
  use gudgeon_errors, only: error_t
  use contact_law, only: contact_law_t
  use laws, only: contact_law_of
  use gudgeon_scene, only: event_contact_begins
  use free_impact, only: speed_given_back, exact_restitution
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_slow_contact

  integer, parameter :: long = 60
  character(len=*), parameter :: dry = 'cases/flores/dry_0100um.nml'

  !> The crank hangs at rest, and the piston rests on the pin.
  character(len=long), parameter :: hanging(6) = [character(len=long) :: 'initial.crank_angle_deg=180', &
    'initial.crank_speed=0', 'integrator.revolutions=0', 'output.interval=1e-3', 'mechanism.gravity=9.80665', 'drive.kind=free']

contains

  subroutine run_test_slow_contact(check)
    class(checks_t), intent(inout) :: check
    call slow_impacts_lose_less(check)
    call pin_comes_to_rest(check)
    call start_in_contact(check)
    call start_on_the_wall(check)
    call start_off_centre(check)
    call revolution_has_a_budget(check)
  end subroutine run_test_slow_contact

  !> From 1e-3 to 1e-15 m/s the restitution of a free impact is that of the law's exact solution for chi v/least_impact_speed: never
  !> above 1, and larger for slower impacts.
  subroutine slow_impacts_lose_less(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp), parameter :: restitution(4) = [0.0_dp, 0.5_dp, 0.9_dp, 1.0_dp]
    real(dp) :: speed, back, previous
    character(len=40) :: keys
    integer :: i, power
    do i = 1, size(restitution)
      write (keys, '(a,f3.1)') 'stiffness=1e9 restitution=', restitution(i)
      call contact_law_of(trim(keys), law, error)
      previous = 0
      do power = 3, 15
        speed = 10.0_dp**(-power)
        back = speed_given_back(law, 1e9_dp, 1.5_dp, speed, 4000, 40000)
        call check%that(back > 0 .and. back <= 1 + 1e-9_dp, 'a slow impact gives back no more than it had')
        call check%that(back >= previous - 1e-7_dp, 'the slower, the more')
        call check%close_to(back, exact_restitution(law%damping*min(1.0_dp, speed/law%least_impact_speed)), 1e-6_dp, &
          'slow free impact')
        previous = back
      end do
      call check%close_to(previous, 1.0_dp, 1e-6_dp, 'in the end all')
    end do
  end subroutine slow_impacts_lose_less

  !> Dropped from the centre the pin bounces, settles and carries the piston: K delta^1.5 = m g; with every restitution and
  !> method, in a number of contacts that does not grow without bound.
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
        'the pin rests where the elastic force carries the piston')
      call check%that(trace%report%figures%pin(piston_pin)%contacts < 60, 'after a number of bounces')
      call check%that(trace%report%figures%max_energy_residual < 1e-6_dp*trace%report%figures%max_energy, 'and keeps its energy')
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

  !> Depth at which the elastic force carries the piston of the dry case [m].
  real(dp) function resting_depth()
    resting_depth = (0.14_dp*9.80665_dp/hertz_stiffness(0.010_dp, 1e-4_dp, [207e9_dp, 207e9_dp], [0.3_dp, 0.3_dp]))**(2/3.0_dp)
  end function resting_depth

  !> Started at rest with a larger penetration than in equilibrium, the pin remains in contact and reaches the equilibrium.
  subroutine start_in_contact(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=0.05', 'initial.eccentricity=1.001e-4,0', &
      'contact.restitution=0.5'])
    call check%that(.not. allocated(trace%error), 'a start in contact is simulated')
    if (allocated(trace%error)) return
    call check%relative(-first(trace, 'film_thickness[m]'), 1e-7_dp, 1e-6_dp, 'the first row is the start')
    call check%that(nint(first(trace, 'phase[-]')) == 2, 'in contact')
    call check%relative(-last(trace, 'film_thickness[m]'), resting_depth(), 1e-4_dp, 'the end is at rest')
    call check%that(size(trace%event) == 1, 'one contact, which does not end')
    if (size(trace%event) == 0) return
    call check%that(trace%event(1)%kind == event_contact_begins .and. trace%event(1)%time <= 0, 'told of at the start')
  end subroutine start_in_contact

  !> Exactly at the clearance and at rest: where gravity presses the pin on it touches, where gravity lifts it off it flies.
  subroutine start_on_the_wall(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=0.05', 'initial.eccentricity=1e-4,0'])
    call check%that(size(trace%event) == 1, 'pressed on, it stays')
    call check%relative(-last(trace, 'film_thickness[m]'), resting_depth(), 1e-3_dp, 'and rests')
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=1e-3', 'initial.eccentricity=-1e-4,0'])
    call check%that(size(trace%event) == 0, 'lifted off, it flies')
    call check%relative(last(trace, 'film_thickness[m]'), 0.5_dp*9.80665_dp*1e-6_dp, 1e-3_dp, 'falling freely')
    trace = run_case(dry, [character(len=long) :: hanging, 'integrator.end_time=1e-3', 'initial.eccentricity=0,1e-4', &
      'initial.eccentricity_rate=0,0.1'])
    call check%that(size(trace%event) >= 1, 'driven on, it touches')
    if (size(trace%event) == 0) return
    call check%relative(trace%event(1)%normal_speed, 0.1_dp, 1e-12_dp, 'with the speed that it was given')
  end subroutine start_on_the_wall

  !> Free flight with a start in eccentricity and rate, no gravity: a straight line to the wall.
  subroutine start_off_centre(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: hanging(:4), 'drive.kind=constant_speed', 'integrator.end_time=1e-3', &
      'initial.eccentricity=3e-5,0', 'initial.eccentricity_rate=0.5,0'])
    call check%that(size(trace%event) > 0, 'the pin reaches the wall')
    if (size(trace%event) == 0) return
    call check%relative(trace%event(1)%time, 7e-5_dp/0.5_dp, 1e-9_dp, 'when it should')
    call check%relative(trace%event(1)%normal_speed, 0.5_dp, 1e-9_dp, 'as fast as it was')
  end subroutine start_off_centre

  !> A limit of evaluations per revolution stops a run that the limit for the whole run would let continue, and the message gives
  !> the place.
  subroutine revolution_has_a_budget(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: 'integrator.max_evaluations_per_revolution=1000'])
    call check%that(allocated(trace%error), 'the run stops')
    if (allocated(trace%error)) &
      call check%that(index(trace%error%message, 'limit of evaluations in one revolution reached') == 1, 'by name')
    call check%that(trace%report%statistics%evaluations >= 1000 .and. trace%report%statistics%evaluations < 1100, 'soon')
    trace = run_case(dry, [character(len=long) :: 'integrator.max_evaluations_per_revolution=8000', &
      'integrator.revolutions=6'])
    call check%that(.not. allocated(trace%error), 'a budget that each revolution keeps is no limit')
    call check%that(trace%report%statistics%evaluations > 8000, 'on the whole')
  end subroutine revolution_has_a_budget
end module test_slow_contact
