!> Statistics of revolutions: they do not change a run, and they agree with fine quadratures of its trace.
module test_cycle_watch
  use kinds, only: dp
  use constants, only: two_pi
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use trace_columns, only: column_list_t, choose_columns
  use cycle_watch, only: cycle_watch_t
  use simulation, only: simulate, run_report_t
  use collecting_sink, only: collecting_sink_t, trace_t, run_case
  implicit none
  private
  public :: run_test_cycle_watch

  integer, parameter :: long = 60

contains

  subroutine run_test_cycle_watch(check)
    class(checks_t), intent(inout) :: check
    call watching_changes_nothing(check)
    call means_are_those_of_the_trace(check)
    call revolutions_follow_the_crank(check)
    call losses_are_the_same_however_found(check)
    call strobes_are_at_their_angle(check)
  end subroutine run_test_cycle_watch

  !> Run cases/FILE without rows, with statistics of revolutions.
  subroutine run_watched(file, overrides, strobe_columns, watch, report)
    character(len=*), intent(in) :: file, overrides(:), strobe_columns
    type(cycle_watch_t), allocatable, intent(inout) :: watch
    type(run_report_t), intent(out) :: report
    type(case_t) :: case
    type(column_list_t) :: no_rows
    type(collecting_sink_t) :: sink
    type(error_t), allocatable :: error
    call read_case(file, overrides, case, error)
    if (allocated(error)) error stop 'no such case'
    if (strobe_columns /= '') then
      case%output%columns = strobe_columns
      call choose_columns(case, .false., watch%strobe_list, error)
    end if
    allocate (no_rows%id(0))
    call simulate(case, .false., no_rows, sink, report, error, cycles=watch)
    if (allocated(error)) error stop 'the run failed'
    if (sink%rows > 0) error stop 'rows were computed'
  end subroutine run_watched

  !> With clearance the statistics do not influence the step size: every figure of the run is the same to the last bit.
  subroutine watching_changes_nothing(check)
    class(checks_t), intent(inout) :: check
    character(len=60), parameter :: files(2) = [character(len=60) :: 'cases/sim_I.nml', 'cases/flores/friction_050.nml']
    character(len=8), parameter :: methods(3) = [character(len=8) :: 'auto', 'adams', 'radau']
    character(len=long) :: overrides(3)
    type(cycle_watch_t), allocatable :: watch
    type(run_report_t) :: report
    type(trace_t) :: plain
    character(len=80) :: name
    integer :: i, k
    do i = 1, size(files)
      do k = 1, size(methods)
        overrides = [character(len=long) :: 'integrator.revolutions=0.25', 'output.samples_per_revolution=4', &
          'integrator.method='//methods(k)]
        plain = run_case(trim(files(i)), overrides)
        if (allocated(watch)) deallocate (watch)
        allocate (watch)
        call run_watched(trim(files(i)), overrides, '', watch, report)
        name = trim(files(i))//' '//methods(k)
        associate (a => plain%report%figures, b => report%figures)
          call check%that(plain%report%statistics%evaluations == report%statistics%evaluations, trim(name)//': evaluations')
          call check%relative(b%pin(piston_pin)%max_force, a%pin(piston_pin)%max_force, 0.0_dp, trim(name)//': force')
          call check%relative(b%max_energy_residual, a%max_energy_residual, 0.0_dp, trim(name)//': energy residual')
          call check%relative(b%pin(piston_pin)%min_film_thickness, a%pin(piston_pin)%min_film_thickness, 0.0_dp, &
            trim(name)//': film thickness')
        end associate
      end do
    end do
  end subroutine watching_changes_nothing

  !> Force and energy against the trapezoidal rule over a fine trace, and against the energy that the bodies have lost (no
  !> drive, no damping); peaks and contact time against the figures of the run.
  subroutine means_are_those_of_the_trace(check)
    class(checks_t), intent(inout) :: check
    character(len=60), parameter :: files(3) = [character(len=60) :: 'cases/sim_I.nml', 'cases/sim_II_oscillating.nml', &
      'cases/flores/friction_050.nml']
    character(len=8), parameter :: methods(3) = [character(len=8) :: 'auto', 'radau', 'adams']
    character(len=long), parameter :: tolerances(3) = [character(len=long) :: 'integrator.relative_tolerance=1e-10', &
      'integrator.relative_tolerance=1e-6', 'integrator.relative_tolerance=1e-6']   ! chaotic with contact
    real(dp), parameter :: force_within(3) = [2e-5_dp, 5e-5_dp, 2e-5_dp]   ! the second is chaotic: 1e-5 to 3e-5
    character(len=long) :: overrides(5)
    type(cycle_watch_t), allocatable :: watch
    type(run_report_t) :: report
    type(trace_t) :: trace
    real(dp), allocatable :: t(:), energy(:), force(:)
    character(len=80) :: name
    real(dp) :: lost
    integer :: i, n, m
    do i = 1, size(files)
      overrides = [character(len=long) :: 'integrator.revolutions=2', 'output.samples_per_revolution=50000', &
        'output.columns=time,pin_force_x,pin_force_y,energy', 'output.ideal_twin=F', 'integrator.method='//methods(i)]
      trace = run_case(trim(files(i)), [character(len=long) :: overrides, 'drive.kind=free', tolerances(i)])
      allocate (watch)
      watch%keeps_cycles = .true.
      call run_watched(trim(files(i)), [character(len=long) :: overrides, 'drive.kind=free'], '', watch, report)
      name = trim(files(i))
      n = size(trace%values, 2)
      allocate (t(n), energy(n), force(n))
      t(:) = trace%values(1, :)
      energy(:) = trace%values(4, :)
      force(:) = norm2(trace%values(2:3, :), 1)
      associate (s => watch%statistics)
        call check%that(s%cycles >= 1, trim(name)//': at least one revolution')
        m = count(t <= s%total%duration)   ! the rows of the counted revolutions
        lost = sum(0.5_dp*(force(2:m) + force(:m - 1))*(t(2:m) - t(:m - 1))) + force(m)*(s%total%duration - t(m))
        call check%relative(s%total%pin(piston_pin)%force_integral, lost, force_within(i), trim(name)//': integral of the force')
        lost = energy(1) - energy(m) - (energy(min(n, m + 1)) - energy(m))* &
          (s%total%duration - t(m))/max(t(min(n, m + 1)) - t(m), tiny(1.0_dp))
        call check%close_to(s%total%dissipated_energy, lost, 1e-5_dp*abs(lost), &
          trim(name)//': energy lost in the joint')
        call check%relative(sum(watch%cycles(:s%cycles)%pin(piston_pin)%force_integral), &
          s%total%pin(piston_pin)%force_integral, 1e-14_dp, &
          trim(name)//': revolutions add up')
      end associate
      deallocate (watch, t, energy, force)
    end do
  end subroutine means_are_those_of_the_trace

  !> At constant speed every revolution takes the same time, and the last one counts; all of them together have the figures
  !> of the run. Revolutions at the start can be left out, and a watch can be used for another run.
  subroutine revolutions_follow_the_crank(check)
    class(checks_t), intent(inout) :: check
    type(cycle_watch_t), allocatable :: watch, forwards
    type(run_report_t) :: report
    real(dp) :: late, travel
    integer :: i
    allocate (watch, forwards)
    watch%keeps_cycles = .true.
    call run_watched('cases/flores/dry_0500um.nml', [character(len=long) :: 'integrator.revolutions=3'], '', watch, report)
    associate (s => watch%statistics, f => report%figures)
      call check%that(s%cycles == 3, 'constant speed: three revolutions')
      call check%relative(s%total%duration, f%time, 1e-13_dp, 'duration')
      do i = 1, s%cycles
        call check%relative(watch%cycles(i)%duration, f%time/3, 1e-12_dp, 'duration of each revolution')
      end do
      call check%that(s%total%pin(piston_pin)%impacts == f%pin(piston_pin)%contacts, 'contacts')
      call check%relative(s%total%pin(piston_pin)%contact_time, f%pin(piston_pin)%contact_time, 1e-12_dp, 'contact time')
      call check%relative(s%total%pin(piston_pin)%max_force, f%pin(piston_pin)%max_force, 0.0_dp, 'largest force')
      call check%relative(s%total%pin(piston_pin)%max_penetration, f%pin(piston_pin)%max_penetration, 0.0_dp, 'deepest contact')
      call check%relative(s%total%pin(piston_pin)%min_film_thickness, f%pin(piston_pin)%min_film_thickness, 0.0_dp, 'thinnest film')
      call check%relative(s%force_sum(piston_pin)/s%cycles, sum(watch%cycles(:3)%pin(piston_pin)%max_force)/3, 1e-14_dp, &
        'mean of largest forces')
      call check%that(s%force_sum(piston_pin)/s%cycles < s%total%pin(piston_pin)%max_force, &
        'the mean force is smaller than the largest')
      call check%relative(s%film_sum(piston_pin)/s%cycles, sum(watch%cycles(:3)%pin(piston_pin)%min_film_thickness)/3, &
        1e-14_dp, 'mean of smallest film thicknesses')
      late = watch%cycles(3)%pin(piston_pin)%force_integral
    end associate
    watch%settle = 2
    call run_watched('cases/flores/dry_0500um.nml', [character(len=long) :: 'integrator.revolutions=3'], '', watch, report)
    call check%that(watch%statistics%cycles == 1, 'two revolutions are left out')
    call check%relative(watch%statistics%total%pin(piston_pin)%force_integral, late, 0.0_dp, 'the third revolution is counted')
    watch%settle = 0
    ! the mechanism of simulation I is its own mirror image
    call run_watched('cases/sim_I.nml', [character(len=long) :: 'integrator.revolutions=2.5', 'integrator.method=auto'], '', &
      forwards, report)
    travel = report%figures%crank_travel
    call run_watched('cases/sim_I.nml', [character(len=long) :: 'integrator.revolutions=2.5', 'integrator.method=auto', &
      'initial.crank_speed=-250'], '', watch, report)
    call check%that(watch%statistics%cycles == 2, 'revolutions of a crank that turns backwards')
    call check%relative(-report%figures%crank_travel, travel, 1e-6_dp, 'a crank turns equally far backwards and forwards')
    call check%relative(watch%statistics%total%pin(piston_pin)%force_integral, &
      forwards%statistics%total%pin(piston_pin)%force_integral, 1e-4_dp, 'force is the same backwards and forwards')
    call check%relative(watch%statistics%total%dissipated_energy, forwards%statistics%total%dissipated_energy, 1e-4_dp, &
      'loss is the same backwards and forwards')
    call run_watched('cases/flores/ideal.nml', [character(len=long) :: 'integrator.revolutions=2'], '', watch, report)
    call check%that(watch%statistics%cycles == 2, 'ideal joint: two revolutions')
    call check%that(watch%statistics%total%pin(piston_pin)%impacts == 0, 'ideal joint: no impact')
    late = watch%statistics%total%pin(piston_pin)%force_integral
    call run_watched('cases/flores/ideal.nml', [character(len=long) :: 'integrator.revolutions=2', &
      'integrator.relative_tolerance=1e-11'], '', watch, report)
    call check%relative(late, watch%statistics%total%pin(piston_pin)%force_integral, 2e-5_dp, 'ideal joint: integral of the force')
  end subroutine revolutions_follow_the_crank

  !> The loss of the joint from the work; integrated separately if a very small damping requires it; and the means at larger
  !> tolerances, for starting angles at which the force at the ends of revolutions is small or large.
  subroutine losses_are_the_same_however_found(check)
    class(checks_t), intent(inout) :: check
    type(cycle_watch_t), allocatable :: watch, loose
    type(run_report_t) :: report
    character(len=long) :: overrides(4)
    real(dp) :: loss, force
    integer :: i
    allocate (watch, loose)
    do i = 0, 2
      overrides = [character(len=long) :: 'integrator.method=auto', 'integrator.revolutions=2', &
        'integrator.relative_tolerance=1e-8', 'initial.crank_angle_deg=0']
      write (overrides(4)(len('initial.crank_angle_deg=') + 1:), '(i0)') 60*i
      call run_watched('cases/sim_I.nml', overrides, '', watch, report)
      loss = watch%statistics%total%dissipated_energy/watch%statistics%cycles
      force = watch%statistics%total%pin(piston_pin)%force_integral
      call run_watched('cases/sim_I.nml', [character(len=long) :: overrides, 'drive.damping=1e-20'], '', watch, report)
      call check%relative(watch%statistics%total%dissipated_energy/watch%statistics%cycles, loss, 1e-6_dp, &
        'loss of the joint integrated separately')
      overrides(3) = 'integrator.relative_tolerance=1e-4'
      call run_watched('cases/sim_I.nml', overrides, '', loose, report)
      call check%relative(loose%statistics%total%dissipated_energy/loose%statistics%cycles, loss, 1e-4_dp, &
        'loss at a large tolerance')
      call check%relative(loose%statistics%total%pin(piston_pin)%force_integral, force, 1e-4_dp, 'force at a large tolerance')
    end do
  end subroutine losses_are_the_same_however_found

  !> The crank angle of each strobe, and the pin's position against a trace at the same times.
  subroutine strobes_are_at_their_angle(check)
    class(checks_t), intent(inout) :: check
    type(cycle_watch_t), allocatable :: watch
    type(run_report_t) :: report
    type(trace_t) :: trace
    real(dp) :: angle
    integer :: i
    allocate (watch)
    watch%strobe_angle = 0.25_dp*two_pi
    call run_watched('cases/flores/lubricated_400cP.nml', [character(len=long) :: 'integrator.revolutions=3'], &
      'crank_angle, eccentricity_x', watch, report)
    call check%that(watch%strobes == 3, 'three strobes')
    trace = run_case('cases/flores/lubricated_400cP.nml', [character(len=long) :: 'integrator.revolutions=3', &
      'output.samples_per_revolution=4', 'output.columns=crank_angle,eccentricity_x', 'initial.crank_angle_deg=0'])
    do i = 1, min(3, watch%strobes)
      angle = watch%strobe_values(1, i)
      call check%close_to(angle, (i - 0.75_dp)*two_pi, 1e-8_dp, 'crank angle of a strobe')
      call check%relative(watch%strobe_values(2, i), trace%values(2, 4*i - 2), 1e-9_dp, 'eccentricity of a strobe')
    end do
    watch%most_strobes = 1
    watch%settle = 1
    watch%strobe_angle = 0
    call run_watched('cases/flores/lubricated_400cP.nml', [character(len=long) :: 'integrator.revolutions=3'], &
      'crank_angle, eccentricity_x', watch, report)
    call check%that(watch%strobes == 1, 'one strobe')
    call check%close_to(watch%strobe_values(1, 1), 2*two_pi, 1e-8_dp, 'strobe at the end of the second revolution')
  end subroutine strobes_are_at_their_angle
end module test_cycle_watch
