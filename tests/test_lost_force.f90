!> A contact law whose damper may cancel the elastic force: inside one contact the force may be lost and act again, and both are
!> events.
module test_lost_force
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene
  use case_definition, only: case_t
  use case_file, only: read_case
  use case_checks, only: methods_agree
  use collecting_sink, only: trace_t, run_case, values_of
  use joint_places, only: piston_pin
  implicit none
  private
  public :: run_test_lost_force

  integer, parameter :: long = 60
  real(dp), parameter :: c = 1e-4_dp   !! clearance of the case [m]
  character(len=*), parameter :: file = 'cases/contact/pereira_impact.nml'
  character(len=6), parameter :: methods(3) = [character(len=6) :: 'adams', 'radau', 'auto']

contains

  subroutine run_test_lost_force(check)
    class(checks_t), intent(inout) :: check
    call force_acts_again(check)
    call starts_on_the_kink(check)
    call rests_without_chatter(check)
    call acts_in_every_contact(check)
  end subroutine run_test_lost_force

  !> An impact whose force is lost and acts again before the contact ends: the motion is that of very short steps, which need no
  !> events.
  subroutine force_acts_again(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(5)
    type(trace_t) :: trace, reference
    integer :: i
    set(1:3) = [character(len=long) :: 'initial.crank_angle_deg=203.7479', 'integrator.revolutions=0.3', &
      'integrator.max_step=1e-7']
    set(4:5) = [character(len=long) :: 'integrator.method=adams', 'integrator.relative_tolerance=1e-12']
    reference = run_case(file, set)
    set(3) = 'integrator.relative_tolerance=1e-10'
    do i = 1, size(methods)
      set(4:5) = 'integrator.method='//methods(i)
      trace = run_case(file, set)
      call check%that(.not. (allocated(trace%error) .or. allocated(reference%error)), 'runs with lost forces')
      if (allocated(trace%error) .or. allocated(reference%error)) return
      call check%close_to(largest_distance(trace, reference), 0.0_dp, 1e-6_dp*c, &
        'the motion by '//methods(i)//' is that of short steps')
      call check%that(trace%report%statistics%restarts >= size(trace%event) + 2, &
        'lost forces are events in addition to those of the contact')
    end do
  end subroutine force_acts_again

  !> Largest distance between the pins of two traces with the same rows [m].
  real(dp) function largest_distance(a, b) result(distance)
    type(trace_t), intent(in) :: a, b
    distance = maxval(abs(values_of(a, 'eccentricity_x[m]') - values_of(b, 'eccentricity_x[m]')) &
      + abs(values_of(a, 'eccentricity_y[m]') - values_of(b, 'eccentricity_y[m]')))
  end function largest_distance

  !> A pin that begins where the damper just cancels the elastic force, on either side of it, within rounding: the motion is that of
  !> a pin that begins a little beside it.
  subroutine starts_on_the_kink(check)
    class(checks_t), intent(inout) :: check
    character(len=1) :: nothing(0)
    character(len=long) :: set(5)
    real(dp), parameter :: depths(3) = [2e-7_dp, 8e-7_dp, 3e-6_dp]
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(error_t), allocatable :: error
    type(trace_t) :: beside, here
    real(dp) :: share, unused, rate
    integer :: i, j
    call read_case(file, nothing, case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    call check%that(.not. allocated(error), 'a scene')
    if (allocated(error)) return
    set(1:2) = [character(len=long) :: 'integrator.revolutions=0.01', 'integrator.relative_tolerance=1e-10']
    do i = 1, size(depths)
      call case%joints(piston_pin)%contact%find_share(depths(i), -1.0_dp, 0.0_dp, share, unused)
      rate = -1/(1 - share)
      write (set(3), '(a,es23.16,a)') 'initial.eccentricity=', c + depths(i), ',0'
      do j = -2, 2
        set(4) = 'integrator.method='//methods(1 + modulo(j + i, 3))
        write (set(5), '(a,es23.16,a)') 'initial.eccentricity_rate=', rate*(1 + merge(1e-9_dp, j*1e-15_dp, j == -2)), ',0'
        here = run_case(file, set)
        call check%that(.not. allocated(here%error), 'a start where the force vanishes')
        if (allocated(here%error)) return
        if (j == -2) beside = here
        call check%close_to(largest_distance(here, beside), 0.0_dp, 1e-6_dp*c, 'the motion of a start where the force vanishes')
        call check%that(here%report%statistics%restarts <= beside%report%statistics%restarts + 2, &
          'a start where the force vanishes has no more than two events of its own')
      end do
    end do
  end subroutine starts_on_the_kink

  !> A strongly damped pin that gravity presses into its bearing until it rests: events do not repeat in place.
  subroutine rests_without_chatter(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(8)
    type(trace_t) :: trace
    integer :: i
    set(1:6) = [character(len=long) :: 'mechanism.gravity=9.80665', 'initial.crank_speed=0.5', 'integrator.revolutions=0.02', &
      'contact.full_damping_depth=1e-9', 'initial.eccentricity=0,1e-4', 'initial.crank_angle_deg=90']
    set(7) = 'contact.damping=1e7'
    do i = 1, size(methods)
      set(8) = 'integrator.method='//methods(i)
      if (i == 1) set(7) = 'contact.damping=1e5'   ! Adams would take steps that stability limits
      trace = run_case(file, set)
      call check%that(.not. allocated(trace%error), 'a pin comes to rest by '//methods(i))
      if (allocated(trace%error)) cycle
      call check%that(trace%report%statistics%restarts <= 40, 'a resting pin has few events by '//methods(i))
    end do
  end subroutine rests_without_chatter

  !> The law at both pins, with a film that shares the load, at the corners of a skirt and in a worn bore: all methods agree.
  subroutine acts_in_every_contact(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    call methods_agree(check, 'cases/joints/both_pins.nml', [character(len=long) :: 'integrator.revolutions=0.1', &
      'contact.law=impact', 'contact.damping=3e3', 'contact.full_damping_depth=2e-6'], 2e-4_dp, 'law impact at both pins', trace)
    call methods_agree(check, 'cases/joints/piston_slap.nml', [character(len=long) :: 'integrator.revolutions=0.05', &
      'guide.contact_law=impact', 'guide.damping=4e4', 'guide.full_damping_depth=4e-6'], 2e-4_dp, 'law impact at a skirt', trace)
    call methods_agree(check, 'cases/film/weighted.nml', [character(len=long) :: 'integrator.revolutions=0.3', &
      'contact.law=impact', 'contact.damping=2e4', 'contact.full_damping_depth=1e-7'], 1e-4_dp, 'law impact with a film', trace)
    call methods_agree(check, 'cases/wear/worn_bore.nml', [character(len=long) :: 'integrator.revolutions=0.1', &
      'contact.law=impact', 'contact.damping=3e3', 'contact.full_damping_depth=1e-6'], 1e-4_dp, 'law impact in a worn bore', trace)
  end subroutine acts_in_every_contact
end module test_lost_force
