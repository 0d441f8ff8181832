!> Results of a run: the time spent with each method, and peaks between steps.
module test_run_figures
  use kinds, only: dp
  use joint_places, only: piston_pin, n_places, name_prefix
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use trace_columns, only: column_list_t
  use constants, only: two_pi
  use cycle_watch, only: cycle_watch_t
  use error_handling, only: error_t
  use simulation, only: simulate, run_report_t
  use collecting_sink, only: collecting_sink_t, trace_t, run_case, column, values_of
  implicit none
  private
  public :: run_test_run_figures

  integer, parameter :: long = 60

contains

  subroutine run_test_run_figures(check)
    class(checks_t), intent(inout) :: check
    call all_time_is_counted_once(check, 'cases/sim_IV.nml', '0.95')
    call all_time_is_counted_once(check, 'cases/sim_IV_oscillating.nml', '0.95')
    call all_time_is_counted_once(check, 'cases/wiebe/wiebe_320.nml', '1.9')
    call all_time_is_counted_once(check, 'cases/flores/dry_0500um.nml', '0.7')
    call hertz_in_closed_form(check)
    call a_film_begins_at_its_highest(check)
    call no_row_is_above_a_peak(check)
    call revolutions_have_their_peaks(check)
  end subroutine run_test_run_figures

  !> Steps are shortened by contacts, by boundaries of the gas cycle and by the end of the run: the times by method add up to the
  !> simulated time, which is that of the given number of revolutions.
  subroutine all_time_is_counted_once(check, file, revolutions)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, revolutions
    type(trace_t) :: trace
    real(dp), parameter :: rounding = 1e-12_dp
    trace = run_case(file, [character(len=long) :: 'integrator.method=auto', 'integrator.revolutions='//revolutions])
    call check%that(.not. allocated(trace%error), file//' runs with auto')
    associate (s => trace%report%statistics, time => trace%report%figures%time)
      call check%that(s%restarts > 0, file//': some steps are cut by events')
      call check%relative(sum(trace%report%time_with), time, rounding, file//': times by method and phase')
      call check%that(sum(trace%report%time_with/time) <= 1 + rounding, file//': their fractions sum to no more than 1')
      call check%that(all(trace%report%time_with >= 0), file//': no time by method is negative')
    end associate
  end subroutine all_time_is_counted_once

  !> A pin that moves freely along the cylinder, with the crank at rest in its dead centre: only the piston's mass takes part, and
  !> no other force acts. With the force K delta^1.5 the energy m v^2/2 = 2/5 K delta^2.5 gives the largest penetration.
  subroutine hertz_in_closed_form(check)
    class(checks_t), intent(inout) :: check
    character(len=6) :: speeds(5)
    character(len=8), parameter :: methods(2) = [character(len=8) :: 'adams', 'radau']
    real(dp), parameter :: stiffness = 1e10_dp, mass = 0.14_dp
    character(len=long) :: overrides(13)
    type(trace_t) :: trace
    real(dp), parameter :: within = 1e-9_dp
    real(dp) :: speed, depth
    integer :: i, k
    speeds = [character(len=6) :: '0.01', '-0.05', '0.2', '-1.0', '3.0']
    do i = 1, size(speeds)
      do k = 1, size(methods)
        overrides = [character(len=long) :: 'drive.kind=constant_speed', 'initial.crank_speed=0', 'mechanism.gravity=0', &
          'contact.law=hertz', 'contact.stiffness=1e10', 'integrator.revolutions=0', 'output.interval=1', &
          'integrator.relative_tolerance=1e-12', 'mechanism.piston_mass=0.14', 'initial.eccentricity_rate='//speeds(i)//',0', &
          'integrator.method='//methods(k), 'output.ideal_twin=F', 'integrator.end_time=']
        read (speeds(i), *) speed
        depth = (1.25_dp*mass*speed**2/stiffness)**0.4_dp
        ! 1e-4 m of flight, then 2.95 depth/speed of contact
        write (overrides(13)(21:), '(es12.5)') (1.5e-4_dp + 3.2_dp*depth)/abs(speed)
        trace = run_case('cases/flores/dry_0100um.nml', overrides)
        call check%that(.not. allocated(trace%error), 'a run with a free impact')
        if (size(trace%event) < 2) then
          call check%that(.false., 'a free impact has one contact')
          cycle
        end if
        associate (figures => trace%report%figures, contact => trace%event(2))
          call check%relative(figures%pin(piston_pin)%max_penetration, depth, within, &
            'deepest penetration at '//speeds(i)//methods(k))
          call check%relative(contact%max_penetration, depth, within, 'penetration of the contact at '//speeds(i)//methods(k))
          call check%relative(-figures%pin(piston_pin)%min_film_thickness, depth, within, &
            'film thickness at '//speeds(i)//methods(k))
          call check%relative(contact%max_normal_force, stiffness*depth*sqrt(depth), 1.5_dp*within, &
            'largest normal force at '//speeds(i)//methods(k))
          call check%relative(figures%pin(piston_pin)%max_force, stiffness*depth*sqrt(depth), 1.5_dp*within, &
            'largest force on the pin at '//speeds(i)//methods(k))
        end associate
      end do
    end do
  end subroutine hertz_in_closed_form

  !> A contact that ends at once, with the crank at 60 degrees: the force of the film decreases from its beginning. Its first
  !> value is the linear extrapolation of the rows to that time.
  subroutine a_film_begins_at_its_highest(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: interval = 1e-9_dp
    type(trace_t) :: trace
    real(dp) :: force(2:3), first
    trace = run_case('cases/sim_I_oscillating.nml', [character(len=long) :: 'initial.crank_angle_deg=60', &
      'initial.eccentricity=2.0000001e-5,0', 'initial.eccentricity_rate=-0.5,0', 'integrator.revolutions=0', &
      'integrator.end_time=2e-5', 'output.interval=1e-9', 'output.ideal_twin=F'])
    call check%that(size(trace%event) == 2 .and. trace%event(2)%time < interval, 'a contact that ends at once')
    force = hypot(trace%values(column(trace, 'pin_force_x[N]'), 2:3), trace%values(column(trace, 'pin_force_y[N]'), 2:3))
    call check%that(force(2) > force(3), 'the force of the film decreases')
    first = force(2) + (force(2) - force(3))*(interval - trace%event(2)%time)/interval
    call check%relative(trace%report%figures%pin(piston_pin)%max_force, first, 1e-9_dp, &
      'largest force at the beginning of the film')
  end subroutine a_film_begins_at_its_highest

  !> Figures and contacts include times between rows: those of a run with few rows are compared with close rows of another run with
  !> the same steps. No row may be larger, and the parabola through the three largest must agree within a `resolution`.
  subroutine no_row_is_above_a_peak(check)
    class(checks_t), intent(inout) :: check
    character(len=30), parameter :: files(11) = [character(len=30) :: 'flores/ideal', 'flores/dry_0500um', 'flores/friction_100', &
      'flores/lubricated_400cP', 'wiebe/wiebe_340', 'sim_I', 'sim_III_oscillating', 'sim_IV_oscillating', 'joints/both_pins', &
      'joints/crank_pin', 'joints/both_pins_lubricated']
    character(len=8), parameter :: methods(2) = [character(len=8) :: 'auto', 'adams']
    real(dp), parameter :: rounding = 1e-12_dp
    character(len=long) :: common(4)
    type(trace_t) :: rows, plain
    character(len=:), allocatable :: name, prefix
    integer :: i, k, pin
    do i = 1, size(files)
      do k = 1, size(methods)
        if (methods(k) == 'adams' .and. any(files(i) == [character(len=30) :: 'sim_I', 'joints/both_pins_lubricated'])) &
          cycle   ! 10^5 steps
        common = [character(len=long) :: 'integrator.revolutions='//merge('1.0', '0.4', i > 10), &
          'integrator.method='//methods(k), 'output.ideal_twin=F', 'output.samples_per_revolution=1']
        name = trim(files(i))//' '//trim(methods(k))
        plain = run_case('cases/'//trim(files(i))//'.nml', common)
        common(4) = 'output.samples_per_revolution=200000'
        rows = run_case('cases/'//trim(files(i))//'.nml', common)
        call check%that(plain%report%statistics%evaluations == rows%report%statistics%evaluations, name//': the same steps')
        associate (figures => plain%report%figures)
          do pin = 1, n_places
            prefix = name_prefix(pin)
            if (pin /= piston_pin .and. column(rows, prefix//'phase[-]') == 0) cycle
            call is_peak_of(check, figures%pin(pin)%max_force, force_in_rows(rows, pin), rounding, &
              name//prefix//': force on the pin')
            if (column(rows, prefix//'film_thickness[m]') > 0) call is_peak_of(check, -figures%pin(pin)%min_film_thickness, &
              -rows%values(column(rows, prefix//'film_thickness[m]'), :), rounding, name//prefix//': film thickness')
            call check_contacts()
          end do
          call check%that(100*figures%peak_evaluations <= 12*(plain%report%statistics%evaluations + 720) .or. i == 5, &
            name//': extremes need less than 12 % of the evaluations')
        end associate
      end do
    end do

  contains

    !> Each contact of the pin against the rows between its ends.
    subroutine check_contacts()
      integer :: j
      if (column(rows, prefix//'normal_force[N]') == 0) return
      call check%that(size(plain%event) == size(rows%event), name//': the same contacts')
      call check%that(count(plain%event%kind == 1 .and. plain%event%pin == pin) == plain%report%figures%pin(pin)%contacts, &
        name//prefix//': number of contacts')
      do j = 1, min(size(plain%event), size(rows%event))
        associate (t => rows%values(1, :), e => plain%event(j))
          if (e%pin /= pin .or. e%kind /= 2) cycle
          if (count(t > e%time - e%duration .and. t < e%time) < 100) cycle
          call is_peak_of(check, e%max_penetration, pack(-values_of(rows, prefix//'film_thickness[m]'), &
            t > e%time - e%duration .and. t < e%time), rounding, name//prefix//': penetration in a contact')
          call is_peak_of(check, e%max_normal_force, pack(values_of(rows, prefix//'normal_force[N]'), &
            t > e%time - e%duration .and. t < e%time), rounding, name//prefix//': normal force in a contact')
        end associate
      end do
    end subroutine check_contacts
  end subroutine no_row_is_above_a_peak

  !> Magnitude of the force on a pin in each row; for a crank pin with clearance that of its contact and its film.
  function force_in_rows(rows, pin) result(force)
    type(trace_t), intent(in) :: rows
    integer, intent(in) :: pin
    real(dp), allocatable :: force(:)
    if (pin == piston_pin) then
      force = hypot(rows%values(column(rows, 'pin_force_x[N]'), :), rows%values(column(rows, 'pin_force_y[N]'), :))
      return
    end if
    force = hypot(rows%values(column(rows, 'crank_pin_normal_force[N]'), :), &
      rows%values(column(rows, 'crank_pin_friction_force[N]'), :))
    if (column(rows, 'crank_pin_film_force_x[N]') > 0) force = max(force, hypot(rows%values(column(rows, &
      'crank_pin_film_force_x[N]'), :), rows%values(column(rows, 'crank_pin_film_force_y[N]'), :)))
  end function force_in_rows

  !> The same for each revolution, by the crank angle, in a run without rows.
  subroutine revolutions_have_their_peaks(check)
    class(checks_t), intent(inout) :: check
    character(len=30), parameter :: files(6) = [character(len=30) :: 'flores/ideal', 'flores/dry_0500um', 'sim_I', &
      'sim_II_oscillating', 'wiebe/wiebe_360', 'joints/both_pins']
    real(dp) :: rounding
    character(len=long) :: common(4)
    type(cycle_watch_t), allocatable :: watch
    type(trace_t) :: rows
    type(case_t) :: case
    type(column_list_t) :: no_rows
    type(collecting_sink_t) :: sink
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    real(dp), allocatable :: turned(:)
    character(len=:), allocatable :: prefix
    integer :: i, k, pin
    allocate (no_rows%id(0))
    do i = 1, size(files)
      common = [character(len=long) :: 'integrator.crank_revolutions=2.01', 'integrator.method=auto', 'output.ideal_twin=F', &
        'output.samples_per_revolution=50000']
      if (i == 6) common(4) = 'output.samples_per_revolution=200000'   ! its contacts are half as long
      rows = run_case('cases/'//trim(files(i))//'.nml', common)
      call read_case('cases/'//trim(files(i))//'.nml', common, case, error)
      allocate (watch)
      watch%keeps_cycles = .true.
      call simulate(case, .false., no_rows, sink, report, error, cycles=watch)
      call check%that(watch%statistics%cycles >= 2, trim(files(i))//': revolutions')
      allocate (turned(size(rows%values, 2)))
      turned(:) = (rows%values(2, :) - rows%values(2, 1))/two_pi
      rounding = 1e-12_dp
      if (case%joints(piston_pin)%kind == 'ideal') rounding = 1e-6_dp   ! the statistics of an ideal joint change its steps
      do k = 1, watch%statistics%cycles
        do pin = 1, n_places
          prefix = name_prefix(pin)
          if (pin /= piston_pin .and. column(rows, prefix//'phase[-]') == 0) cycle
          associate (c => watch%cycles(k)%pin(pin))
            call is_peak_of(check, c%max_force, pack(force_in_rows(rows, pin), turned >= k - 1 .and. turned <= k), rounding, &
              trim(files(i))//prefix//': force on the pin in a revolution')
            if (column(rows, prefix//'film_thickness[m]') == 0) cycle
            call is_peak_of(check, -c%min_film_thickness, pack(-values_of(rows, prefix//'film_thickness[m]'), &
              turned >= k - 1 .and. turned <= k), rounding, trim(files(i))//prefix//': film thickness in a revolution')
            call check%close_to(c%max_penetration, max(0.0_dp, -c%min_film_thickness), 0.0_dp, prefix//'penetration')
          end associate
        end do
      end do
      deallocate (watch, turned)
    end do
  end subroutine revolutions_have_their_peaks

  !> An extreme is not below any of the close rows, except for rounding, and agrees with the parabola through the three largest.
  subroutine is_peak_of(check, peak, rows, rounding, what)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: peak, rows(:), rounding
    character(len=*), intent(in) :: what
    real(dp), parameter :: resolution = 1e-6_dp
    real(dp) :: top
    integer :: i
    i = maxloc(rows, 1)
    top = rows(i)
    if (i > 1 .and. i < size(rows)) then
      if (2*rows(i) > rows(i - 1) + rows(i + 1)) &
        top = rows(i) + (rows(i + 1) - rows(i - 1))**2/(8*(2*rows(i) - rows(i - 1) - rows(i + 1)))
    end if
    call check%that(peak >= rows(i) - rounding*abs(rows(i)), what//': no row is larger')
    call check%relative(peak, top, resolution, what)
  end subroutine is_peak_of
end module test_run_figures
