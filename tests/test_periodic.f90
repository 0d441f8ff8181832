!> Runs until the motion is periodic, and Lyapunov exponents of periodic and chaotic motions: compared with the traces of other
!> runs.
module test_periodic
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene
  use period_watch, only: period_watch_t
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, column, last_row_time
  implicit none
  private
  public :: run_test_periodic

  integer, parameter :: long = 60
  character(len=long), parameter :: until = 'run.until=periodic', window = 'output.window=last_period', auto = &
    'integrator.method=auto', exponent = 'run.lyapunov_revolutions=20'
  character(len=*), parameter :: dry = 'cases/flores/dry_0500um.nml', film = 'cases/flores/lubricated_400cP.nml'

contains

  subroutine run_test_periodic(check)
    class(checks_t), intent(inout) :: check
    call held_crank_with_film(check)
    call long_periods(check)
    call chaos(check)
    call skirt_in_the_window(check)
    call gas_takes_two_revolutions(check)
    call free_crank(check)
    call exponent_is_the_decay(check)
    call exponents_of_orbits(check)
    call shortest_period(check)
    call alternating_approach(check)
    call slow_behind_fast(check)
    call exponent_in_lasting_contact(check)
    call no_exponent(check)
    call exponents_of_machines(check)
    call exponent_is_the_growth(check, [character(len=long) ::], 16, 'chaos')
    call exponent_is_the_growth(check, [character(len=long) :: 'combustion.cycle=compressor', 'combustion.bore=0.05', &
      'combustion.dead_space=0.05', 'combustion.suction_pressure=1e5', 'combustion.discharge_pressure=3e5', &
      'combustion.polytropic_exponent=1.3'], 8, 'chaos, compressor')
    call exponent_is_the_growth(check, [character(len=long) :: 'cylinder_pressure.bore=0.02', 'drive.kind=free', &
      'cylinder_pressure.table=../../cases/gas/indicator.csv', 'drive.torque_table=../../cases/drive/motor.csv', &
      'drive.flywheel_inertia=0.05', 'initial.crank_speed=150', 'output.sampling=crank_angle'], 6, 'chaos, indicator and motor')
  end subroutine run_test_periodic

  !> With a film the motion becomes periodic within a revolution. The run ends at the right time with the rows of one revolution,
  !> and the state continues to repeat in a run that does not stop.
  subroutine held_crank_with_film(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: whole, last, plain
    real(dp) :: turn
    integer :: n
    turn = two_pi/523.5987755982989_dp
    whole = run_case(film, [character(len=long) :: until, auto])
    last = run_case(film, [character(len=long) :: until, auto, window, 'output.samples_per_revolution=90'])
    associate (a => whole%report%periods, b => last%report%periods)
      call check%that(whole%report%status == 'done' .and. a%period == 1, 'film: period of one revolution')
      call check%that(a%found_after >= 4 .and. a%found_after <= 6, 'film: the period is found soon')
      call check%close_to(last_row_time(whole), a%found_after*turn, 1e-12_dp, 'film: the run ends at the angle where it began')
      call check%close_to(whole%report%figures%time, a%found_after*turn, 1e-12_dp, 'film: the figures end there too')
      call check%relative(a%duration, turn, 1e-10_dp, 'film: duration of the period')
      call check%that(b%found_after == a%found_after .and. b%window_after == a%found_after, &
        'film: the window begins where the period is found')
      call check%close_to(last_row_time(last), (a%found_after + 1)*turn, 1e-12_dp, 'film: the window is one period')
      call check%that(size(last%values, 2) == 91, 'film: rows of one period')
      call check%close_to(last%values(1, 1), a%found_after*turn, 1e-12_dp, 'film: the window has its first row')
      call closes(check, last, 1, 91, 1e-4_dp, .true., 'film')
      plain = run_case(film, [character(len=long) :: auto, 'integrator.revolutions=20', 'output.samples_per_revolution=90', &
        'integrator.relative_tolerance=1e-9'])
      n = size(plain%values, 2)
      call closes(check, plain, a%found_after*90 + 1, n, 1e-4_dp, .true., 'film, 20 revolutions')
    end associate
  end subroutine held_crank_with_film

  !> Whether the coordinates and speeds of two rows agree within a share of their ranges.
  subroutine closes(check, trace, first, last, tolerance, wanted, what)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: trace
    integer, intent(in) :: first, last
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: wanted
    character(len=*), intent(in) :: what
    character(len=24), parameter :: names(4) = [character(len=24) :: 'piston_velocity[m/s]', 'eccentricity_x[m]', &
      'eccentricity_y[m]', 'rod_speed[rad/s]']
    real(dp) :: difference
    integer :: i, c
    difference = 0
    do i = 1, size(names)
      c = column(trace, trim(names(i)))
      difference = max(difference, abs(trace%values(c, last) - trace%values(c, first))/ &
        (maxval(trace%values(c, :)) - minval(trace%values(c, :))))
    end do
    call check%that((difference <= tolerance) .eqv. wanted, what//': rows a period apart')
  end subroutine closes

  !> A dry joint from the bifurcation diagram: periods of two and three revolutions, no shorter ones, and negative exponents.
  subroutine long_periods(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: clearances(2) = [character(len=7) :: '55e-6', '52.2e-6']
    integer, parameter :: periods(2) = [2, 3]
    type(trace_t) :: trace
    character(len=:), allocatable :: what
    integer :: i, k
    do i = 1, size(periods)
      what = 'dry, '//trim(clearances(i))//' m'
      trace = run_case(dry, [character(len=long) :: until, auto, window, 'joint.clearance='//clearances(i), &
        'run.most_revolutions=200', 'output.samples_per_revolution=20', exponent])
      call check%that(trace%report%periods%period == periods(i), what//': period')
      call check%that(size(trace%values, 2) == 20*periods(i) + 1, what//': number of rows in a period')
      if (size(trace%values, 2) /= 20*periods(i) + 1) cycle
      call closes(check, trace, 1, 20*periods(i) + 1, 2e-4_dp, .true., what//', a period')
      do k = 1, periods(i) - 1
        call closes(check, trace, 1, 20*k + 1, 2e-4_dp, .false., what//', less than a period')
      end do
      call check%that(trace%report%exponent%is_known .and. trace%report%exponent%mean < -0.1_dp, what//': negative exponent')
    end do
  end subroutine long_periods

  !> A piston with clearance in its bore: the events of the corners of its skirt too are those of the rows' revolutions alone.
  subroutine skirt_in_the_window(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, plain
    real(dp) :: turn
    turn = two_pi/261.79938779914943_dp
    trace = run_case('cases/joints/piston_slap.nml', [character(len=long) :: until, window, 'run.most_revolutions=4', &
      'run.period_revolutions=2', 'drive.kind=constant_speed', 'output.samples_per_revolution=20'])
    plain = run_case('cases/joints/piston_slap.nml', [character(len=long) :: 'integrator.revolutions=4', &
      'drive.kind=constant_speed', 'output.samples_per_revolution=20'])
    call check%that(count(plain%event%pin > 2 .and. plain%event%time >= 2*turn) > 4, 'piston slap: contacts of the skirt')
    call check%that(all(trace%event%time >= 2*turn) .and. size(trace%event) == count(plain%event%time >= 2*turn), &
      'piston slap: events of the last two revolutions')
  end subroutine skirt_in_the_window

  !> With 0.5 mm clearance the motion does not repeat; the run ends at most_revolutions, with the rows and events of the last of
  !> them.
  subroutine chaos(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, plain
    real(dp) :: turn
    turn = two_pi/523.5987755982989_dp
    trace = run_case(dry, [character(len=long) :: until, auto, window, 'run.most_revolutions=30', 'run.period_revolutions=2', &
      'output.samples_per_revolution=20'])
    plain = run_case(dry, [character(len=long) :: auto, 'integrator.revolutions=30', 'output.samples_per_revolution=20'])
    call check%that(trace%report%periods%period == 0 .and. trace%report%status == 'done', 'dry, 0.5 mm: no period')
    call check%relative(last_row_time(trace), 30*turn, 1e-12_dp, 'dry, 0.5 mm: the run ends at most_revolutions')
    call check%that(size(trace%values, 2) == 41, 'dry, 0.5 mm: rows of the last two revolutions')
    call check%that(size(trace%event) > 4 .and. all(trace%event%time >= 28*turn) .and. &
      size(trace%event) == count(plain%event%time >= 28*turn), 'dry, 0.5 mm: events of the last two revolutions')
    call check%that(trace%report%figures%pin(2)%contacts == plain%report%figures%pin(2)%contacts .or. &
      trace%report%statistics%evaluations == plain%report%statistics%evaluations, &
        'dry, 0.5 mm: the search for a period does not change the run')
  end subroutine chaos

  !> The four-stroke cycle has a period of two revolutions, and no shorter one although the dead centres are similar.
  subroutine gas_takes_two_revolutions(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_IV.nml', [character(len=long) :: until, auto, 'drive.kind=constant_speed', &
      'run.periodic_tolerance=1e-2'])
    call check%that(trace%report%periods%period == 2, 'gas: period of two revolutions')
  end subroutine gas_takes_two_revolutions

  !> A damped crank driven by the gas reaches a constant mean speed; a crank without drive and with a film decelerates for ever; for
  !> one that stops the message states how far it came.
  subroutine free_crank(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    integer :: n, speed
    trace = run_case('cases/sim_IV.nml', [character(len=long) :: until, auto, 'drive.damping=0.03', 'output.sampling=crank_angle', &
      'output.samples_per_revolution=4', window], ideal_joint=.true.)
    call check%that(trace%report%periods%period == 2, 'free crank: period of two revolutions')
    call check%that(trace%report%status == 'done', 'free crank: '//trace%report%status)
    n = size(trace%values, 2)
    speed = column(trace, 'crank_speed[rad/s]')
    call check%that(n == 9, 'free crank: rows of the period')
    call check%relative(trace%values(speed, n), trace%values(speed, 1), 1e-4_dp, 'free crank: the speed repeats')
    call check%relative(trace%report%periods%duration, trace%values(1, n) - trace%values(1, 1), 1e-3_dp, 'free crank: duration')
    trace = run_case('cases/sim_I.nml', [character(len=long) :: until, auto, 'run.most_revolutions=20', 'output.ideal_twin=F'])
    call check%that(trace%report%periods%period == 0, 'undriven crank: no period')
    call check%relative(abs(trace%report%figures%crank_travel), 20*two_pi, 1e-9_dp, &
      'undriven crank: the run ends at most_revolutions')
    trace = run_case('cases/sim_I.nml', [character(len=long) :: until, auto, 'drive.damping=1', 'output.sampling=crank_angle'])
    call check%that(index(trace%report%status, '&run most_revolutions') > 0, 'a crank that stops: '//trace%report%status)
  end subroutine free_crank

  !> A damped crank without clearance: its speed, the only state, converges to its mean at the rate damping over inertia, and so do
  !> neighbouring motions. The rate is measured from the differences of the speed between revolutions.
  subroutine exponent_is_the_decay(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: driven(6) = [character(len=long) :: auto, 'drive.damping=0.05', 'drive.torque=10', &
      'integrator.relative_tolerance=1e-11', 'output.sampling=crank_angle', 'output.samples_per_revolution=1']
    character(len=long), parameter :: ideal(4) = [character(len=long) :: 'joint.kind=ideal', 'lubrication=none', 'contact=none', &
      'friction=none']
    type(trace_t) :: trace
    real(dp) :: first, second
    integer :: n, speed
    trace = run_case('cases/sim_I.nml', [character(len=long) :: driven, 'integrator.crank_revolutions=40', exponent, ideal])
    call check%that(.not. allocated(trace%error), 'damped crank: a run')
    speed = column(trace, 'crank_speed[rad/s]')
    n = size(trace%values, 2)
    first = trace%values(speed, 21) - trace%values(speed, 20)
    second = trace%values(speed, 31) - trace%values(speed, 30)
    call check%that(trace%report%exponent%is_known, 'damped crank: an exponent')
    call check%close_to(trace%report%exponent%mean, log(second/first)/10, 0.02_dp*abs(log(second/first)/10), &
      'damped crank: the exponent is the rate of convergence of the speed')
  end subroutine exponent_is_the_decay

  !> Logarithms of the largest multipliers of orbits, from variational equations of an independent program; the means of twenty
  !> revolutions have errors of some 1e-5.
  subroutine exponents_of_orbits(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: until, exponent, 'initial.crank_speed=1000', &
      'output.samples_per_revolution=1', 'output.ideal_twin=F'])
    call check%close_to(trace%report%exponent%mean, log(0.186731491_dp), 1e-4_dp, 'exponent of an orbit with impacts')
    trace = run_case(film, [character(len=long) :: until, exponent, 'output.samples_per_revolution=1', 'output.ideal_twin=F'])
    call check%close_to(trace%report%exponent%mean, log(1.31831949e-4_dp), 1e-4_dp, 'exponent of an orbit with a film')
  end subroutine exponents_of_orbits

  !> States that approach an orbit of two revolutions with a multiplier of -0.95, and those of a true period of four, both with
  !> errors of a tenth of the tolerance: whatever the errors, the period is told.
  subroutine alternating_approach(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: periods(2) = [2, 4], seeds = 200
    real(dp), parameter :: tolerance = 1e-4_dp, error = 0.1_dp*tolerance, orbit(4, 2) = reshape([0.2_dp, -0.3_dp, 0.2_dp, -0.3_dp, &
      0.2_dp, -0.3_dp, 0.21_dp, -0.29_dp], [4, 2])
    type(period_watch_t) :: watch, fresh
    type(scene_t), allocatable :: scene
    type(case_t) :: case
    type(error_t), allocatable :: failure
    real(dp), allocatable :: y(:)
    real(dp) :: distance, random
    integer :: which, seed, k, wrong
    call read_case('cases/sim_I.nml', [character(len=long) :: until], case, failure)
    if (.not. allocated(failure)) call build_scene(case, .false., scene, failure)
    call check%that(.not. allocated(failure), 'alternating approach: a scene')
    if (allocated(failure)) return
    allocate (y(scene%n))
    do which = 1, 2
      wrong = 0
      do seed = 1, seeds
        watch = fresh
        watch%is_on = .true.
        watch%tolerance = tolerance
        random = seed/(seeds + 1.0_dp)
        distance = 0.1_dp
        y = 0
        call watch%begin(scene, 0.0_dp, y)
        do k = 1, 400
          if (mod(k, 2) == 0) distance = merge(-0.95_dp, 0.9_dp, which == 1)*distance
          random = modulo(997*random, 1.0_dp)
          call watch%record_point(y + 1, 0.0_dp)
          y = orbit(mod(k, 4) + 1, which) + distance + error*(2*random - 1)
          call watch%end_revolution(real(k, dp), y, 0.0_dp)
          if (watch%has_ended) exit
        end do
        if (watch%period /= periods(which)) wrong = wrong + 1
      end do
      call check%that(wrong == 0, 'alternating approach: the period')
    end do
  end subroutine alternating_approach

  !> States that approach their limit quickly, and one that does so slowly from revolution to revolution by less than the tolerance:
  !> the period is told when that one too has no more than the tolerance before it.
  subroutine slow_behind_fast(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: tolerance = 1e-4_dp
    type(period_watch_t) :: watch
    type(scene_t), allocatable :: scene
    type(case_t) :: case
    type(error_t), allocatable :: failure
    real(dp), allocatable :: y(:)
    real(dp) :: left
    integer, allocatable :: at(:)
    integer :: k
    call read_case('cases/sim_I.nml', [character(len=long) :: until], case, failure)
    if (.not. allocated(failure)) call build_scene(case, .false., scene, failure)
    call check%that(.not. allocated(failure), 'slow behind fast: a scene')
    if (allocated(failure)) return
    allocate (y(scene%n), source=0.0_dp)
    at = scene%compared_states()
    watch%is_on = .true.
    watch%tolerance = tolerance
    call watch%begin(scene, 0.0_dp, y)
    left = 0
    do k = 1, 1000
      call watch%record_point(y + 1, 0.0_dp)
      left = 10*tolerance*exp(-k/100.0_dp)
      y = 0.3_dp*0.5_dp**k
      y(at(1)) = left
      call watch%end_revolution(real(k, dp), y, 0.0_dp)
      if (watch%has_ended) exit
    end do
    call check%that(watch%period == 1, 'slow behind fast: the period')
    call check%that(left < 1.1_dp*tolerance, 'slow behind fast: not before the slow state has come')   ! 1: its ranges are 1
  end subroutine slow_behind_fast

  !> A motion with the multipliers 0.8405 and -0.6961 (from variational equations of its orbit of one revolution) approaches it from
  !> alternating sides: two revolutions repeat first.
  subroutine shortest_period(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/friction/lugre.nml', [character(len=long) :: until, 'output.samples_per_revolution=1', &
      'output.ideal_twin=F'])
    call check%that(trace%report%periods%period == 1, 'the shortest period is told')
    call check%that(trace%report%periods%found_after < 40, 'the shortest period is told soon')
    trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: until, 'output.samples_per_revolution=1', &
      'output.ideal_twin=F'])
    call check%that(trace%report%periods%period == 2, 'a doubled period is not told')
  end subroutine shortest_period

  !> A pin that comes to rest on its bearing keeps the impact speed of its last contact for ever. Whether this contact begins before
  !> the measurement or in its first revolutions, neighbouring motions converge.
  subroutine exponent_in_lasting_contact(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: pin(2) = [character(len=long) :: exponent, 'output.samples_per_revolution=1']
    type(trace_t) :: before, within
    within = run_case('cases/friction/brown_mcphee.nml', [character(len=long) :: pin, 'integrator.revolutions=3'])
    before = run_case('cases/friction/brown_mcphee.nml', [character(len=long) :: pin, 'integrator.revolutions=5'])
    call check%that(within%report%exponent%is_known .and. before%report%exponent%is_known, 'lasting contact: exponents')
    call check%that(before%report%exponent%mean < -1, 'lasting contact: neighbouring motions converge')
    call check%relative(within%report%exponent%mean, before%report%exponent%mean, 1e-2_dp, &
      'lasting contact: the impact speed of a contact that remains does not matter')
  end subroutine exponent_in_lasting_contact

  !> Where there is no exponent, the reason is stated: a crank that stops after the run.
  subroutine no_exponent(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_I.nml', [character(len=long) :: auto, 'drive.damping=0.1', 'integrator.revolutions=0', &
      'integrator.crank_revolutions=1', exponent, 'output.ideal_twin=F'])
    call check%that(trace%report%status == 'done' .and. .not. trace%report%exponent%is_known, 'a crank that stops: no exponent')
    if (.not. allocated(trace%report%exponent%reason)) trace%report%exponent%reason = ''
    call check%begins_with(trace%report%exponent%reason, 'the crank stops, turns back or takes too long for a quarter of a '// &
      'revolution at t = ', 'a crank that stops: the reason')
  end subroutine no_exponent

  !> Settling films: at constant speed after a ramp, in a compressor, and with a free crank under a measured pressure of two
  !> revolutions. Neighbouring motions converge at the same rate as the states one period apart. In the compressor two directions of
  !> the film converge by the factors 0.83 and 0.77 in a revolution.
  subroutine exponents_of_machines(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: short_one(2) = [character(len=long) :: auto, 'run.lyapunov_revolutions=10']
    call settles('cases/drive/start_up.nml', 'rod_speed[rad/s]', 'integrator.revolutions=6', &
      'output.interval=0.025132741228718345', 1, 'run-up')
    call settles('cases/gas/compressor.nml', 'rod_speed[rad/s]', 'integrator.revolutions=32', &
      'output.samples_per_revolution=1', 1, 'compressor')
    call settles('cases/gas/measured.nml', 'crank_speed[rad/s]', 'integrator.crank_revolutions=28', &
      'output.sampling=crank_angle', 2, 'measured pressure')

  contains

    !> `column_is`: the column that is examined once in a revolution; `period` in revolutions.
    subroutine settles(file, column_is, end_is, rows_are, period, what)
      character(len=*), intent(in) :: file, column_is, end_is, rows_are, what
      integer, intent(in) :: period
      character(len=long) :: settings(3)
      type(trace_t) :: run
      real(dp) :: first, last, rate
      integer :: c, n
      settings = [character(len=long) :: end_is, rows_are, 'output.samples_per_revolution=1']
      if (index(rows_are, 'interval') > 0) settings(3) = ''
      run = run_case(file, [character(len=long) :: short_one, settings(:count(settings /= ''))])
      rate = run%report%exponent%mean
      call check%that(run%report%exponent%is_known, what//': an exponent')
      run = run_case(file, [character(len=long) :: auto, 'integrator.relative_tolerance=1e-11', settings(:count(settings /= ''))])
      c = column(run, column_is)
      n = size(run%values, 2)
      if (c == 0 .or. n < 5) return
      associate (v => run%values(c, :))
        first = abs(v(n - period) - v(n - 2*period))
        last = abs(v(n) - v(n - period))
        call check%close_to(rate, log(last/first)/period, 0.1_dp*abs(rate), &
          what//': the exponent is the rate of convergence of the motion')
      end associate
    end subroutine settles
  end subroutine exponents_of_machines

  !> Two runs at 1e-12 whose pins differ by 1e-12 m: their difference grows according to the exponent if the motion is not
  !> periodic. Several initial states are used, because both are means over a chaotic motion.
  subroutine exponent_is_the_growth(check, machine, starts, what)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: machine(:), what   !! settings in addition to those of the dry joint, and their description
    integer, intent(in) :: starts                      !! number of initial states
    character(len=long), parameter :: close(4) = [character(len=long) :: auto, 'integrator.relative_tolerance=1e-12', &
      'integrator.crank_revolutions=4', 'output.samples_per_revolution=1']
    real(dp), parameter :: aside = 1e-12_dp, saturated = 1e-2_dp*500e-6_dp
    character(len=60) :: first, second, measured_over
    type(trace_t) :: one, other
    real(dp) :: difference, mean, error, growth, squares, last
    integer :: i, k, x, n
    write (measured_over, '(a,i0)') 'run.lyapunov_revolutions=', 8*starts
    one = run_case(dry, [character(len=long) :: auto, 'integrator.revolutions=12', measured_over, machine])
    mean = one%report%exponent%mean
    error = one%report%exponent%error
    growth = 0
    squares = 0
    n = 0
    do i = 1, starts
      write (first, '(a,es12.5,a)') 'initial.eccentricity=', i*2e-5_dp, ',1e-4'
      write (second, '(a,es22.15,a)') 'initial.eccentricity=', i*2e-5_dp + aside, ',1e-4'
      one = run_case(dry, [character(len=long) :: close, machine, first])
      other = run_case(dry, [character(len=long) :: close, machine, second])
      x = column(one, 'eccentricity_x[m]')
      last = aside
      do k = 2, 5
        difference = norm2(one%values(x:x + 1, k) - other%values(x:x + 1, k))
        if (last > saturated .or. .not. difference > 0) exit
        growth = growth + log(difference/last)
        squares = squares + log(difference/last)**2
        last = difference
        n = n + 1
      end do
    end do
    associate (measured => growth/n, scatter => sqrt(max(0.0_dp, squares/n - (growth/n)**2)/n))
      call check%that(mean > 3*error .and. n > 2*starts - 2, what//': positive exponent')
      call check%close_to(mean, measured, 3*(error + scatter), what//': the exponent is the growth of a difference')
    end associate
  end subroutine exponent_is_the_growth
end module test_periodic
