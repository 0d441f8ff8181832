!> Runs that end after a number of revolutions of the crank: closed forms, all kinds of scenes, cranks that do not reach that
!> number.
module test_crank_turns
  use kinds, only: dp
  use constants, only: two_pi
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use trace_columns, only: column_list_t
  use cycle_watch, only: cycle_watch_t
  use error_handling, only: error_t, status_integration
  use simulation, only: simulate, run_t, run_report_t
  use collecting_sink, only: collecting_sink_t, trace_t, run_case, column
  implicit none
  private
  public :: run_test_crank_turns

  integer, parameter :: long = 60
  character(len=8), parameter :: methods(3) = [character(len=8) :: 'adams', 'radau', 'auto']

  !> A crank with the inertia 0.02 kg m^2; the mass of the piston is negligible.
  real(dp), parameter :: inertia = 0.02_dp
  character(len=long), parameter :: crank_alone(9) = [character(len=long) :: 'mechanism.crank_inertia=0.02', &
    'mechanism.crank_mass=0', 'mechanism.rod_mass=0', 'mechanism.rod_inertia=0', 'mechanism.piston_mass=1e-12', &
    'mechanism.gravity=0', 'drive.kind=free', 'output.interval=0.01', 'integrator.relative_tolerance=1e-10']

contains

  subroutine run_test_crank_turns(check)
    class(checks_t), intent(inout) :: check
    call cranks_in_closed_form(check)
    call cranks_that_do_not_get_there(check)
    call cranks_that_creep(check)
    call held_cranks_turn_as_before(check)
    call all_scenes_end_at_their_turns(check)
    call revolutions_are_whole(check)
    call the_end_is_expected(check)
  end subroutine run_test_crank_turns

  !> With a torque tau the angle is w t + tau t^2/(2 I): forwards, backwards, from rest, and with deceleration until the end; with a
  !> damping D it is w I/D (1 - exp(-D t/I)).
  subroutine cranks_in_closed_form(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: way = 3.25_dp*two_pi
    integer :: k
    do k = 1, size(methods)
      call ends_at(check, k, '30', 'drive.torque=2', root(30.0_dp, 2.0_dp))
      call ends_at(check, k, '30', 'drive.torque=-0.4', root(30.0_dp, -0.4_dp))
      call ends_at(check, k, '-30', 'drive.torque=-2', root(30.0_dp, 2.0_dp))
      call ends_at(check, k, '0', 'drive.torque=2', root(0.0_dp, 2.0_dp))
      call ends_at(check, k, '0', 'drive.torque=-2', root(0.0_dp, 2.0_dp))
      call ends_at(check, k, '30', 'drive.damping=0.028', -inertia/0.028_dp*log(1 - way*0.028_dp/(30*inertia)))
    end do

  contains

    pure real(dp) function root(speed, torque)
      real(dp), intent(in) :: speed, torque
      root = 2*way/(speed + sqrt(speed**2 + 2*way*torque/inertia))
    end function root
  end subroutine cranks_in_closed_form

  !> Three and a quarter revolutions from 100 degrees end at the given time and exactly at the angle.
  subroutine ends_at(check, method, speed, force, time)
    class(checks_t), intent(inout) :: check
    integer, intent(in) :: method
    character(len=*), intent(in) :: speed, force
    real(dp), intent(in) :: time
    type(trace_t) :: trace
    trace = run_case('cases/flores/ideal.nml', [character(len=long) :: crank_alone, 'initial.crank_speed='//speed, force, &
      'initial.crank_angle_deg=100', 'integrator.crank_revolutions=3.25', 'integrator.end_time=3', &
      'integrator.method='//methods(method)])
    associate (name => 'crank at '//speed//', '//force//', '//methods(method), f => trace%report%figures)
      call check%that(.not. allocated(trace%error), name//': done')
      call check%relative(f%time, time, 1e-8_dp, name//': time')
      call check%close_to(abs(f%crank_travel), 3.25_dp*two_pi, 1e-9_dp, name//': way')
      call check%that(trace%values(1, size(trace%values, 2)) <= f%time, name//': no row after the end')
      call check%that(trace%values(1, size(trace%values, 2)) > f%time - 0.01_dp*(1 + 1e-9_dp), &
        name//': no row before the end is missing')
    end associate
  end subroutine ends_at

  !> A torque against the rotation turns the crank back after I w^2/(2 tau); a pendulum released at 90 degrees swings to 270;
  !> damping stops a crank after I w/D, within the tolerance; end_time may be reached first; and a crank may be at rest without
  !> loads.
  subroutine cranks_that_do_not_get_there(check)
    class(checks_t), intent(inout) :: check
    integer :: k
    do k = 1, size(methods)
      call fails(check, k, [character(len=long) :: 'drive.torque=-1.5'], &
        'the crank stopped or turned back after 0.9549 of 2 revolutions', inertia*30**2/3.0_dp)
      call fails(check, k, [character(len=long) :: 'drive.torque=1.5', 'initial.crank_speed=-30'], &
        'the crank stopped or turned back after 0.9549 of 2 revolutions', inertia*30**2/3.0_dp)
      call fails(check, k, [character(len=long) :: 'initial.crank_speed=0', 'mechanism.crank_mass=1', 'mechanism.gravity=9.81', &
        'mechanism.crank_com=0.05,0', 'initial.crank_angle_deg=90', 'integrator.end_time=10'], &
        'the crank stopped or turned back after 0.5 of 2 revolutions', 0.5_dp*two_pi)
      call fails(check, k, [character(len=long) :: 'drive.damping=0.1'], 'the crank stopped or turned back after 0.9549 of 2 '// &
        'revolutions', inertia*30/0.1_dp)
      call fails(check, k, [character(len=long) :: 'drive.damping=0.1', 'integrator.end_time=0.1'], &
        'the crank has made only 0.3757 of 2 revolutions', inertia*30/0.1_dp*(1 - exp(-0.1_dp*0.1_dp/inertia)))
      call fails(check, k, [character(len=long) :: 'initial.crank_speed=0', 'integrator.end_time=0.1'], &
        'the crank has made only 0 of 2 revolutions', 0.0_dp)
    end do
  end subroutine cranks_that_do_not_get_there

  !> A damping leaves the crank with the speed tau/D. The run ends when a revolution takes as long as a hundred at the starting
  !> speed, except if it has an end_time.
  subroutine cranks_that_creep(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: slow(4) = [character(len=long) :: 'initial.crank_speed=30', 'drive.torque=0.001', &
      'output.sampling=crank_angle', 'output.samples_per_revolution=36']
    character(len=long) :: end_of_run
    character(len=40) :: key
    type(trace_t) :: trace
    real(dp) :: damping, ends
    integer :: k, turns, ending
    do k = 1, size(methods)
      do turns = 0, 2, 2      ! whole revolutions before the crank is so slow
        do ending = 1, 2
          end_of_run = merge('integrator.crank_revolutions=1000', 'run.until=periodic               ', ending == 1)
          key = merge(' of 1000 revolutions (&integrator crank_', ' of 1000 revolutions (&run most_revoluti', ending == 1)
          damping = merge(0.1_dp, 0.04_dp, turns == 0)
          trace = run_case('cases/flores/ideal.nml', [character(len=long) :: crank_alone(:7), crank_alone(9), slow, end_of_run, &
            'integrator.method='//methods(k), 'drive.damping='//merge('0.10', '0.04', turns == 0)])
          associate (t => trace%report%figures%time, status => trace%report%status)
            call check%that(allocated(trace%error), trim(methods(k))//': a crank that creeps')
            if (.not. allocated(trace%error)) cycle
            call check%that(trace%error%status == status_integration .and. index(status, 'the crank creeps: ') == 1 .and. &
              index(status, trim(key)) > 0, status)
            ends = 100*two_pi/30
            if (turns > 0) ends = ends - inertia/damping*log(1 - turns*two_pi*damping/(30*inertia))
            call check%relative(t, ends, 5e-3_dp, trim(methods(k))//': time at which a run with a creeping crank ends')
            call check%close_to(abs(trace%report%figures%crank_travel), way_at(t, damping), 1e-6_dp, 'angle of a creeping crank')
          end associate
        end do
      end do
      trace = run_case('cases/flores/ideal.nml', [character(len=long) :: crank_alone(:7), crank_alone(9), slow, &
        'integrator.method='//methods(k), 'drive.damping=0.1', 'integrator.crank_revolutions=2', 'integrator.end_time=40'])
      call check%relative(trace%report%figures%time, 40.0_dp, 1e-12_dp, 'a run with a creeping crank continues until end_time')
    end do

  contains

    !> Angle long after the start [rad].
    pure real(dp) function way_at(t, damping)
      real(dp), intent(in) :: t, damping
      way_at = inertia*(30 - 1e-3_dp/damping)/damping + 1e-3_dp/damping*t
    end function way_at
  end subroutine cranks_that_creep

  !> A run of two revolutions that ends earlier, with exit status 4.
  subroutine fails(check, method, overrides, status, way)
    class(checks_t), intent(inout) :: check
    integer, intent(in) :: method
    character(len=*), intent(in) :: overrides(:), status
    real(dp), intent(in) :: way   !! [rad]
    type(trace_t) :: trace
    trace = run_case('cases/flores/ideal.nml', [character(len=long) :: crank_alone, 'initial.crank_speed=30', &
      'initial.crank_angle_deg=100', 'integrator.crank_revolutions=2', 'integrator.method='//methods(method), overrides])
    call check%that(allocated(trace%error), trim(methods(method))//': '//status)
    if (.not. allocated(trace%error)) return
    call check%that(trace%error%status == status_integration, 'exit status 4: '//status)
    call check%that(index(trace%report%status, status) == 1, trace%report%status//' begins with '//status)
    call check%close_to(abs(trace%report%figures%crank_travel), way, 1e-7_dp, status//': way')
    call check%that(.not. trace%report%can_go_on .and. size(trace%values, 2) > 0, &
      status//': the run cannot go on and its rows are kept')
  end subroutine fails

  !> At constant speed the crank makes its revolutions in the time given by `revolutions`: both keys give the same run.
  subroutine held_cranks_turn_as_before(check)
    class(checks_t), intent(inout) :: check
    character(len=30), parameter :: files(3) = [character(len=30) :: 'flores/dry_0500um', 'wiebe/wiebe_340', 'flores/ideal']
    type(trace_t) :: one, other
    integer :: i
    do i = 1, size(files)
      one = run_case('cases/'//trim(files(i))//'.nml', [character(len=long) :: 'drive.kind=constant_speed', &
        'integrator.revolutions=1.5'])
      other = run_case('cases/'//trim(files(i))//'.nml', [character(len=long) :: 'drive.kind=constant_speed', &
        'integrator.crank_revolutions=1.5', 'integrator.end_time=9'])
      call check%that(.not. (allocated(one%error) .or. allocated(other%error)), trim(files(i))//', held: done')
      call check%that(one%report%statistics%evaluations == other%report%statistics%evaluations, &
        trim(files(i))//', constant speed: the same run')
      call check%that(size(one%values, 2) == size(other%values, 2) .and. size(one%values, 2) > 1000, trim(files(i))//', held: rows')
      call check%close_to(abs(other%report%figures%crank_travel), 1.5_dp*two_pi, 1e-11_dp, trim(files(i))//', held: way')
    end do
  end subroutine held_cranks_turn_as_before

  !> Scenes with film, contact, friction and gas, where 720 degrees is also a boundary of the gas cycle, and the ideal twin: the run
  !> ends exactly at the number of revolutions, at the time at which the trace has that angle.
  subroutine all_scenes_end_at_their_turns(check)
    class(checks_t), intent(inout) :: check
    character(len=30), parameter :: files(6) = [character(len=30) :: 'sim_I', 'sim_IV', 'sim_II_oscillating', &
      'flores/friction_050', 'flores/lubricated_400cP', 'sim_V_oscillating']
    character(len=8), parameter :: turns(3) = [character(len=8) :: '1', '2', '0.3']
    real(dp), parameter :: ways(3) = [1.0_dp, 2.0_dp, 0.3_dp]
    type(trace_t) :: trace
    character(len=:), allocatable :: name
    real(dp) :: wanted
    integer :: i, k
    do i = 1, size(files)
      do k = 1, size(turns)
        name = trim(files(i))//', '//trim(turns(k))//' turns'
        wanted = ways(k)*two_pi
        trace = run_case('cases/'//trim(files(i))//'.nml', [character(len=long) :: 'drive.kind=free', &
          'integrator.crank_revolutions='//turns(k), 'integrator.method=auto'], ideal_joint=.false.)
        call judge(name)
        trace = run_case('cases/'//trim(files(i))//'.nml', [character(len=long) :: 'drive.kind=free', &
          'integrator.crank_revolutions='//turns(k), 'integrator.method=auto'], ideal_joint=.true.)
        call judge(name//', ideal twin')
      end do
    end do
  contains
    subroutine judge(what)
      character(len=*), intent(in) :: what
      real(dp) :: before
      integer :: last
      call check%that(.not. allocated(trace%error), what//': done')
      associate (f => trace%report%figures, angle => trace%values(column(trace, 'crank_angle[rad]'), :), &
                 speed => trace%values(column(trace, 'crank_speed[rad/s]'), :), t => trace%values(1, :))
        call check%close_to(f%crank_travel, wanted, 1e-10_dp, what//': way')
        last = size(t)
        before = t(last) + (wanted - (angle(last) - angle(1)))/speed(last)   ! by the speed in the last row
        call check%close_to(f%time, before, 1e-3_dp*(t(2) - t(1)), what//': time')
        call check%that(t(last) <= f%time .and. f%time < t(last) + (t(2) - t(1))*(1 + 1e-9_dp), what//': rows up to the end')
      end associate
    end subroutine judge
  end subroutine all_scenes_end_at_their_turns

  !> The statistics of a sweep include every revolution, also the last one.
  subroutine revolutions_are_whole(check)
    class(checks_t), intent(inout) :: check
    character(len=30), parameter :: files(3) = [character(len=30) :: 'sim_I', 'sim_IV_oscillating', 'flores/ideal']
    type(cycle_watch_t), allocatable :: watch
    type(case_t) :: case
    type(column_list_t) :: no_rows
    type(collecting_sink_t) :: sink
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    integer :: i
    allocate (no_rows%id(0))
    do i = 1, size(files)
      call read_case('cases/'//trim(files(i))//'.nml', [character(len=long) :: 'integrator.crank_revolutions=3', &
        'integrator.method=auto', 'drive.kind=free'], case, error)
      allocate (watch)
      call simulate(case, .false., no_rows, sink, report, error, cycles=watch)
      call check%that(.not. allocated(error) .and. watch%statistics%cycles == 3, trim(files(i))//': three revolutions')
      call check%relative(watch%statistics%total%duration, report%figures%time, 1e-12_dp, &
        trim(files(i))//': revolutions add up to the whole run')
      deallocate (watch)
    end do
  end subroutine revolutions_are_whole

  !> While a crank decelerates, the expected time of the end is near the actual time.
  subroutine the_end_is_expected(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(column_list_t) :: no_rows
    type(collecting_sink_t) :: sink
    type(run_t) :: run
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    real(dp) :: earliest, latest
    integer :: reports
    allocate (no_rows%id(0))
    call read_case('cases/sim_I.nml', [character(len=long) :: 'integrator.crank_revolutions=0.7', 'integrator.method=adams'], &
      case, error)
    call run%begin(case, .false., no_rows, sink, error)
    reports = 0
    earliest = huge(earliest)
    latest = 0
    do while (.not. run%is_over)
      call run%advance(huge(1.0_dp), 2000)
      reports = reports + 1
      earliest = min(earliest, run%expected_end())
      latest = max(latest, run%expected_end())
    end do
    call run%finish(report, error)
    call check%that(.not. allocated(error), 'a long run of a number of revolutions')
    associate (time => report%figures%time)
      call check%that(reports > 5, 'the end is expected several times')
      call check%that(earliest > 0.8_dp*time .and. latest < 1.1_dp*time, 'expected time of the end is within 20 %')
      call check%relative(run%expected_end(), time, 1e-9_dp, 'at the end it is that time')
    end associate
  end subroutine the_end_is_expected
end module test_crank_turns
