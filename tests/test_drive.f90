!> Drives that vary: a prescribed speed with a ramp, a torque that depends on the speed, a flywheel.
module test_drive
  use kinds, only: dp
  use ode_problem, only: difference_jacobian
  use case_definition, only: case_t
  use case_file, only: read_case
  use error_handling, only: error_t
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_drive

  integer, parameter :: long = 60
  character(len=long), parameter :: alone(4) = [character(len=long) :: 'joint.kind=ideal', 'joint.clearance=0', 'contact=none', &
    'lubrication=none']
  character(len=*), parameter :: ramp = 'cases/drive/start_up.nml', motor = 'cases/drive/motor.nml'

contains

  subroutine run_test_drive(check)
    class(checks_t), intent(inout) :: check
    call moment_of_an_ideal_ramp(check)
    call ramp_with_play(check, ['piston_pin'], 0)
    call ramp_with_play(check, ['crank_pin '], 1)
    call ramp_with_play(check, ['both      '], 2)
    call beginning_of_a_slow_ramp(check)
    call ramp_with_elastic_rod(check)
    call ramp_with_crankshaft(check)
    call loose_joints_on_a_ramp_of_the_shaft(check)
    call run_up_on_a_line(check)
    call slopes_of_a_torque(check)
    call a_flywheel_is_inertia(check)
    call what_does_not_fit(check)
  end subroutine run_test_drive

  !> A crank, a massless rod and a piston with a ramp of the speed, without gravity: the moment is I q'' + m x'' dx/dq with the
  !> textbook formulas for x(q) and its derivatives.
  subroutine moment_of_an_ideal_ramp(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=long), parameter :: settings(6) = [character(len=long) :: 'mechanism.rod_mass=0', 'mechanism.rod_inertia=0', &
      'mechanism.gravity=0', 'mechanism.piston_mass=0.5', 'drive.flywheel_inertia=0.03', 'integrator.relative_tolerance=1e-9']
    real(dp) :: q, w, a, s, root, first, second, want, inertia
    integer :: i
    real(dp), parameter :: r = 0.0508_dp, l = 0.2032_dp, m = 0.5_dp
    trace = run_case(ramp, [settings, alone], .true.)
    call check%equal_text(outcome(trace), 'done', 'a ramp of an ideal mechanism')
    if (allocated(trace%error)) return
    inertia = 0.006_dp + 0.03_dp
    do i = 1, size(trace%values, 2)
      q = trace%values(column(trace, 'crank_angle[rad]'), i)
      w = trace%values(column(trace, 'crank_speed[rad/s]'), i)
      a = trace%values(column(trace, 'crank_acceleration[rad/s2]'), i)
      s = min(trace%values(1, i)/0.1_dp, 1.0_dp)
      call check%close_to(w, 250*(10*s**3 - 15*s**4 + 6*s**5), 1e-9_dp, 'speed of the ramp')
      call check%close_to(a, 2500*(30*s**2 - 60*s**3 + 30*s**4), 1e-7_dp, 'acceleration of the ramp')
      root = sqrt(l**2 - (r*sin(q))**2)
      first = -r*sin(q) - r**2*sin(q)*cos(q)/root
      second = -r*cos(q) - r**2*(cos(2*q)/root + (r*sin(q)*cos(q))**2/root**3)
      want = inertia*a + m*(first*a + second*w**2)*first
      call check%close_to(trace%values(column(trace, 'crank_moment[N.m]'), i), want, 1e-7_dp, 'driving moment of the ramp')
    end do
    call check%that(trace%report%figures%max_energy_residual < 1e-8_dp*trace%report%figures%max_energy, &
      'energy of the ideal ramp is the work of the drive')
  end subroutine moment_of_an_ideal_ramp

  !> With clearance the work of the driving moment agrees with the energy, for the closed form of each chain.
  subroutine ramp_with_play(check, place, kind)
    class(checks_t), intent(inout) :: check
    character(len=10), intent(in) :: place(1)
    integer, intent(in) :: kind   !! 0: at the piston pin, 1: at the crank pin, 2: both
    type(trace_t) :: trace
    character(len=long), parameter :: run(5) = [character(len=long) :: 'drive.kind=constant_speed', 'drive.ramp_time=4e-3', &
      'drive.ramp_from=20', 'integrator.relative_tolerance=1e-8', 'integrator.revolutions=0.4']
    if (kind == 0) then
      trace = run_case('cases/flores/dry_0500um.nml', run)
    else if (kind == 1) then
      trace = run_case('cases/joints/crank_pin.nml', run)
    else
      trace = run_case('cases/joints/both_pins.nml', run)
    end if
    call check%equal_text(outcome(trace), 'done', 'a ramp with clearance: '//place(1))
    if (allocated(trace%error)) return
    call check%that(trace%report%figures%max_energy_residual < 1e-6_dp*trace%report%figures%max_energy, &
      'energy of a ramp is the work of the drive: '//place(1))
    call check%that(maxval(trace%values(column(trace, 'crank_acceleration[rad/s2]'), :)) > 1e4_dp, 'the crank is accelerated')
  end subroutine ramp_with_play

  !> A run that ends in the first hundredth of a run-up keeps the energy that it reaches, 4e-9 J, not only a small part of that of
  !> the full speed; so does its ideal twin.
  subroutine beginning_of_a_slow_ramp(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    integer :: i, twin
    character(len=long), parameter :: settings(6) = [character(len=long) :: 'drive.ramp_time=50', 'drive.ramp_from=0', &
      'integrator.revolutions=0', 'integrator.end_time=0.5', 'output.interval=1e-2', 'integrator.method=auto']
    character(len=*), parameter :: tolerances(3) = ['1e-4 ', '1e-6 ', '1e-10']
    do i = 1, size(tolerances)
      do twin = 0, 1
        trace = run_case('cases/flores/dry_0100um.nml', [settings, [character(len=long) :: &
          'integrator.relative_tolerance='//tolerances(i)]], twin == 1)
        call check%equal_text(outcome(trace), 'done', 'beginning of a slow ramp: '//tolerances(i))
        if (allocated(trace%error)) cycle
        call check%that(trace%report%figures%max_energy_residual < 1e-5_dp*trace%report%figures%max_energy, &
          'energy at the beginning of a slow ramp is the work of the drive: '//tolerances(i))
      end do
    end do
  end subroutine beginning_of_a_slow_ramp

  !> With an elastic rod, with ideal pins and with clearance: the moment accelerates the crank against the force at the crank pin
  !> that follows from Newton's law of the rod, and its work agrees with the energy.
  subroutine ramp_with_elastic_rod(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: r = 0.05_dp, inertia = 1.0e-5_dp + 0.30_dp*0.025_dp**2
    character(len=long), parameter :: run(7) = [character(len=long) :: 'drive.kind=constant_speed', 'drive.ramp_time=4e-3', &
      'drive.ramp_from=20', 'integrator.relative_tolerance=1e-8', 'integrator.revolutions=0.4', 'elastic_rod.section_area=9.6e-5', &
      'elastic_rod.section_inertia=5.12e-10']
    character(len=*), parameter :: files(4) = [character(len=32) :: 'cases/flores/ideal.nml', 'cases/flores/dry_0500um.nml', &
      'cases/joints/crank_pin.nml', 'cases/joints/both_pins.nml']
    type(trace_t) :: trace
    real(dp), allocatable :: turning(:)
    integer :: i
    do i = 1, size(files)
      trace = run_case(trim(files(i)), [run, [character(len=long) :: 'mechanism.gravity=0', 'drive.damping=0', &
        'mechanism.crank_length=0.05', 'mechanism.crank_mass=0.30', 'mechanism.crank_inertia=1e-5', 'mechanism.crank_com=0.025,0']])
      call check%equal_text(outcome(trace), 'done', 'a ramp with an elastic rod: '//trim(files(i)))
      if (allocated(trace%error)) cycle
      associate (q => values_of('crank_angle[rad]'))
        turning = inertia*values_of('crank_acceleration[rad/s2]') &
          + r*(values_of('crankpin_force_y[N]')*cos(q) - values_of('crankpin_force_x[N]')*sin(q))
      end associate
      call check%that(trace%report%figures%max_energy_residual < 1e-6_dp*trace%report%figures%max_energy, &
        'energy of a ramp is the work of the drive: '//trim(files(i)))
      call check%that(maxval(values_of('crank_acceleration[rad/s2]')) > 1e4_dp, 'the crank is accelerated')
      if (i > 2) cycle   ! with clearance at the crank pin friction also acts on the crank
      call check%close_to(maxval(abs(values_of('crank_moment[N.m]') - turning)), 0.0_dp, 1e-9_dp*maxval(abs(turning)), &
        'Euler''s equation of the crank: '//trim(files(i)))
    end do

  contains

    function values_of(name) result(values)
      character(len=*), intent(in) :: name
      real(dp) :: values(size(trace%values, 2))
      values = trace%values(column(trace, name), :)
    end function values_of
  end subroutine ramp_with_elastic_rod

  !> An inertia I on an elastic shaft whose other end is run up: I q'' = k (q_f - q) + c (q_f' - q'), solved here by the classical
  !> Runge-Kutta method with the angle of the ramp as a polynomial; the drive moves the flywheel too.
  subroutine ramp_with_crankshaft(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: inertia = 0.02_dp, flywheel = 0.05_dp, k = 2.0e3_dp, c = 0.5_dp, duration = 0.03_dp, low = 20, high = 120
    integer, parameter :: steps = 20000
    character(len=long), parameter :: settings(16) = [character(len=long) :: 'drive.kind=constant_speed', 'drive.ramp_time=0.03', &
      'drive.ramp_from=20', 'drive.damping=0', 'initial.crank_speed=120', 'initial.crank_angle_deg=0', 'mechanism.rod_mass=0', &
      'mechanism.rod_inertia=0', 'mechanism.gravity=0', 'mechanism.piston_mass=1e-12', 'mechanism.crank_mass=0', &
      'mechanism.crank_inertia=0.02', 'crankshaft.flywheel_inertia=0.05', 'crankshaft.torsional_stiffness=2e3', &
      'crankshaft.torsional_damping=0.5', 'integrator.relative_tolerance=1e-10']
    character(len=long), parameter :: span(3) = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=0.05', &
      'output.interval=0.01']
    type(trace_t) :: trace
    real(dp) :: y(2), a(2), b(2), d(2), e(2), h, t, s
    integer :: i, row
    trace = run_case('cases/flores/ideal.nml', [settings, span])
    call check%equal_text(outcome(trace), 'done', 'an elastic crankshaft is run up')
    if (allocated(trace%error)) return
    y = [0.0_dp, low]
    h = 0.05_dp/steps
    row = 1
    do i = 0, steps
      t = i*h
      if (modulo(i, steps/5) == 0) then
        s = min(t/duration, 1.0_dp)
        call check%close_to(value('crank_speed[rad/s]'), y(2), 1e-7_dp*high, 'the crank swings behind the ramp')
        call check%close_to(value('flywheel_speed[rad/s]'), low + (high - low)*s**3*(10 - 15*s + 6*s**2), 1e-9_dp, &
          'the flywheel follows the ramp')
        call check%close_to(value('crank_moment[N.m]') - value('crankshaft_moment[N.m]'), &
          flywheel*(high - low)/duration*30*(s*(1 - s))**2, 1e-6_dp, 'the drive accelerates the flywheel too')
        row = row + 1
      end if
      a = rate(t, y)
      b = rate(t + h/2, y + h/2*a)
      d = rate(t + h/2, y + h/2*b)
      e = rate(t + h, y + h*d)
      y = y + h/6*(a + 2*b + 2*d + e)
    end do
    call check%that(trace%report%figures%max_energy_residual < 1e-8_dp*trace%report%figures%max_energy, &
      'the energy is the work of the drive')

  contains

    real(dp) function value(name)
      character(len=*), intent(in) :: name
      value = trace%values(column(trace, name), row)
    end function value

    function rate(time, state) result(f)
      real(dp), intent(in) :: time, state(2)
      real(dp) :: f(2), x, angle, speed
      x = min(time/duration, 1.0_dp)
      angle = low*time + (high - low)*(duration*(2.5_dp*x**4 - 3*x**5 + x**6) + max(time - duration, 0.0_dp))
      speed = low + (high - low)*(10*x**3 - 15*x**4 + 6*x**5)
      f = [state(2), (k*(angle - state(1)) + c*(speed - state(2)))/inertia]
    end function rate
  end subroutine ramp_with_crankshaft

  !> The same with clearance at the joints: the energy is the work of the drive.
  subroutine loose_joints_on_a_ramp_of_the_shaft(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: settings(7) = [character(len=long) :: 'drive.kind=constant_speed', 'drive.ramp_time=4e-3', &
      'drive.ramp_from=20', 'integrator.relative_tolerance=1e-8', 'integrator.revolutions=0.4', &
      'crankshaft.flywheel_inertia=1e-3', 'crankshaft.torsional_stiffness=500']
    character(len=*), parameter :: files(2) = [character(len=32) :: 'cases/flores/dry_0500um.nml', 'cases/joints/both_pins.nml']
    type(trace_t) :: trace
    integer :: i
    do i = 1, size(files)
      trace = run_case(trim(files(i)), settings)
      call check%equal_text(outcome(trace), 'done', 'a run-up of an elastic crankshaft: '//trim(files(i)))
      if (allocated(trace%error)) cycle
      call check%that(trace%report%figures%max_energy_residual < 1e-6_dp*trace%report%figures%max_energy, &
        'the energy is the work of the drive: '//trim(files(i)))
      call check%close_to(trace%values(column(trace, 'crank_speed[rad/s]'), 1), 20.0_dp, 1e-12_dp, 'the crank starts with the ramp')
    end do
  end subroutine loose_joints_on_a_ramp_of_the_shaft

  !> An inertia J driven by a motor with M = M0 (1 - w/w0): w = w0 (1 - exp(-M0 t/(J w0))).
  subroutine run_up_on_a_line(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=long), parameter :: settings(9) = [character(len=long) :: 'mechanism.rod_mass=0', 'mechanism.rod_inertia=0', &
      'mechanism.gravity=0', 'mechanism.piston_mass=1e-12', 'mechanism.crank_inertia=0.02', 'drive.flywheel_inertia=0.08', &
      'drive.damping=0', 'drive.torque=0', 'integrator.relative_tolerance=1e-10']
    integer :: i
    real(dp) :: t
    trace = run_case(motor, [settings, alone], .true.)
    call check%equal_text(outcome(trace), 'done', 'a motor accelerates an inertia')
    if (allocated(trace%error)) return
    do i = 1, size(trace%values, 2)
      t = trace%values(1, i)
      call check%close_to(trace%values(column(trace, 'crank_speed[rad/s]'), i), 200*(1 - exp(-30*t/(0.1_dp*200))), 1e-6_dp, &
        'exponential approach to the final speed')
      call check%close_to(trace%values(column(trace, 'crank_moment[N.m]'), i), 30*exp(-30*t/(0.1_dp*200)), 1e-6_dp, &
        'the motor''s torque')
    end do
    call check%that(trace%report%figures%max_energy_residual < 1e-8_dp*trace%report%figures%max_energy, &
      'energy of the inertia is the work of the motor')
  end subroutine run_up_on_a_line

  !> The closed form of the Jacobian includes the derivative of the torque and the acceleration of a prescribed speed.
  subroutine slopes_of_a_torque(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(error_t), allocatable :: error
    real(dp), allocatable :: y(:), by_p(:, :), by_v(:, :), want_p(:, :), want_v(:, :)
    character(len=long) :: settings(1)
    integer :: i, n
    do i = 1, 2
      settings(1) = 'output.ideal_twin=F'
      if (i == 1) call read_case(motor, settings, case, error)
      if (i == 2) call read_case(ramp, settings, case, error)
      call check%that(.not. allocated(error), 'a case to differentiate')
      if (allocated(error)) return
      call build_scene(case, .false., scene, error)
      n = scene%n_positions
      y = scene%initial_state()
      if (i == 1) y(scene%crank%position) = 0.7_dp
      if (i == 1) y(scene%crank%rate) = 90
      y(scene%joints(1)%at%position:scene%joints(1)%at%position + 1) = [3e-6_dp, -5e-6_dp]
      y(scene%joints(1)%at%rate:scene%joints(1)%at%rate + 1) = [1e-3_dp, 2e-3_dp]
      allocate (by_p(n, n), by_v(n, n), want_p(n, n), want_v(n, n), source=0.0_dp)
      call scene%jacobian(0.05_dp, y, by_p, by_v)
      call difference_jacobian(scene, 0.05_dp, y, want_p, want_v)
      call check%that(maxval(abs(by_v - want_v)) < 1e-4_dp*maxval(abs(want_v)), 'derivatives with respect to the rates')
      call check%that(maxval(abs(by_p - want_p)) < 1e-4_dp*maxval(abs(want_p)), 'derivatives with respect to the positions')
      if (i == 1) call check%relative(by_v(1, 1), want_v(1, 1), 1e-4_dp, &
        'derivative of the crank acceleration with respect to its speed')
      deallocate (by_p, by_v, want_p, want_v)
    end do
  end subroutine slopes_of_a_torque

  !> A flywheel on the crank equals additional inertia of the crank, and is the limit of a stiff crankshaft with its own flywheel.
  subroutine a_flywheel_is_inertia(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: flywheel, inertia, shaft
    character(len=long), parameter :: run(3) = [character(len=long) :: 'integrator.revolutions=1', &
      'integrator.relative_tolerance=1e-9', &
      'output.ideal_twin=F']
    real(dp), allocatable :: one(:), two(:)
    flywheel = run_case('cases/flores/ideal.nml', [run, [character(len=long) :: 'drive.kind=free', 'drive.flywheel_inertia=2e-3']])
    inertia = run_case('cases/flores/ideal.nml', [run, [character(len=long) :: 'drive.kind=free', &
      'mechanism.crank_inertia=2.01e-3']])
    shaft = run_case('cases/flores/ideal.nml', [run, [character(len=long) :: 'drive.kind=free', &
      'crankshaft.flywheel_inertia=2e-3', &
      'crankshaft.torsional_stiffness=1e6', 'crankshaft.torsional_damping=20']])
    call check%equal_text(outcome(flywheel)//outcome(inertia)//outcome(shaft), 'donedonedone', 'three runs with a flywheel')
    if (allocated(flywheel%error) .or. allocated(inertia%error) .or. allocated(shaft%error)) return
    one = speeds(flywheel)
    two = speeds(inertia)
    call check%that(maxval(abs(one/two - 1)) < 1e-12_dp, 'a flywheel adds its inertia')
    two = speeds(shaft)
    call check%that(maxval(abs(one/two - 1)) < 1e-3_dp, 'a flywheel on a stiff shaft adds its inertia')
  end subroutine a_flywheel_is_inertia

  !> How a run ended, or the reason why it did not begin.
  function outcome(trace) result(text)
    type(trace_t), intent(in) :: trace
    character(len=:), allocatable :: text
    text = ''
    if (allocated(trace%error)) text = trace%error%message
    if (allocated(trace%report%status)) text = trace%report%status
  end function outcome

  pure function speeds(trace) result(values)
    type(trace_t), intent(in) :: trace
    real(dp) :: values(size(trace%values, 2))
    values = trace%values(column(trace, 'crank_speed[rad/s]'), :)
  end function speeds

  subroutine what_does_not_fit(check)
    class(checks_t), intent(inout) :: check
    call refused(motor, 'drive.ramp_time=1', 'ramp_time = 1: needs kind = ''constant_speed''')
    call refused(motor, 'drive.kind=constant_speed', 'torque_table')
    call refused(ramp, 'drive.kind=free', 'ramp_time = 0.1: needs kind = ''constant_speed''')
    call refused(ramp, 'drive.ramp_time=-1', 'ramp_time = -1: must be > 0')
    call refused('cases/flores/ideal.nml', 'drive.ramp_from=3', 'ramp_from = 3: needs ramp_time')
    call refused('cases/flores/ideal.nml', 'drive.flywheel_inertia=-1', 'flywheel_inertia = -1: must be >= 0')
    call refused('cases/flores/ideal.nml', 'drive.torque_table=no.csv', 'torque_table: cases/flores/no.csv: No such file')
    call refused(ramp, 'drive.torque_table=../gas/indicator.csv', 'indicator.csv:2: crank_angle[deg]: the header must name')

  contains

    subroutine refused(file, setting, wanted)
      character(len=*), intent(in) :: file, setting, wanted
      type(case_t) :: case
      type(error_t), allocatable :: error
      call read_case(file, [setting], case, error)
      call check%that(allocated(error), 'refused: '//setting)
      if (allocated(error)) call check%that(index(error%message, wanted) > 0, 'message for '//setting)
    end subroutine refused
  end subroutine what_does_not_fit
end module test_drive
