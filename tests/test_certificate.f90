!> Certificates against runs at 1e-13: they must not claim more accuracy than there is, nor far less.
module test_certificate
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use certificate, only: certificate_t, make_certificate, certificate_table, certificate_summary, certificate_clause, is_state
  use trace_columns, only: column_list_t, choose_columns, column_name
  use chain_motion, only: piston_pin
  use case_checks, only: summary_value
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_certificate

  integer, parameter :: long = 60

contains

  subroutine run_test_certificate(check)
    class(checks_t), intent(inout) :: check
    call holds(check, 'cases/flores/dry_0500um.nml', 'adams', .false., 'chaotic')
    call holds(check, 'cases/flores/dry_0500um.nml', 'radau', .false., 'chaotic, Radau')
    call holds(check, 'cases/flores/lubricated_400cP.nml', 'auto', .true., 'film')
    call holds(check, 'cases/sim_I_oscillating.nml', 'auto', .false., 'free crank')
    call holds(check, 'cases/sim_I.nml', 'auto', .true., 'free crank, film')
    call holds(check, 'cases/joints/crank_pin.nml', 'adams', .false., 'crank pin', [character(len=long) :: &
      'integrator.relative_tolerance=5.348e-7', 'initial.crank_angle_deg=170.5576'])
    call holds(check, 'cases/elastic/engine_crankshaft.nml', 'auto', .true., 'twist', [character(len=long) :: &
      'integrator.revolutions=0.6'])
    call refuses_what_cannot_be_told(check)
    call has_every_impact(check)
    call knows_coordinates_and_speeds(check)
  end subroutine run_test_certificate

  !> The coordinates and speeds of some scenes are found, and no others.
  subroutine knows_coordinates_and_speeds(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: files(5) = [character(len=40) :: 'cases/joints/piston_slap.nml', &
      'cases/joints/both_pins_lubricated.nml', 'cases/film/elastic.nml', 'cases/elastic/engine_crankshaft.nml', &
      'cases/elastic/engine_rod.nml']
    character(len=*), parameter :: states(*) = [character(len=29) :: 'crank_angle', 'rod_angle', 'piston_position', 'crank_speed', &
      'rod_speed', 'piston_velocity', 'eccentricity_x', 'eccentricity_y', 'crank_pin_eccentricity_x', 'crank_pin_eccentricity_y', &
      'crank_pin_eccentricity_rate_x', 'crank_pin_eccentricity_rate_y', 'film_eccentricity_x', 'film_eccentricity_y', &
      'piston_offset', 'piston_tilt', 'piston_offset_rate', 'piston_tilt_rate', 'rod_stretch', 'rod_mid_deflection', &
      'crankshaft_twist', 'flywheel_speed']
    character(len=1) :: nothing(0)
    type(case_t) :: case
    type(column_list_t) :: list
    type(error_t), allocatable :: error
    character(len=:), allocatable :: name
    integer :: i, j
    do i = 1, size(files)
      call read_case(trim(files(i)), nothing, case, error)
      if (.not. allocated(error)) call choose_columns(case, .false., list, error)
      call check%that(.not. allocated(error), 'columns of '//files(i))
      if (allocated(error)) cycle
      do j = 1, size(list%id)
        name = column_name(list, j)
        call check%that(is_state(name) .eqv. any(states == name(:index(name, '[') - 1)), &
          name//' of '//trim(files(i))//': a coordinate or speed, or not')
      end do
    end do
  end subroutine knows_coordinates_and_speeds

  !> Compare the certificate of a case with the true errors of its run.
  subroutine holds(check, file, method, to_the_end, what, settings)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, method, what
    logical, intent(in) :: to_the_end
    character(len=long), intent(in), optional :: settings(:)   !! others than those of every case
    character(len=long), allocatable :: common(:)
    type(certificate_t) :: certificate
    type(error_t), allocatable :: error
    type(case_t) :: case
    type(trace_t) :: run, truth
    real(dp), allocatable :: errors(:)
    real(dp) :: true_end, true_decade
    integer :: n, c

    allocate (common, source=[character(len=long) :: 'integrator.method='//method, 'integrator.revolutions=2.5', &
      'output.samples_per_revolution=12000'])
    if (present(settings)) common = [common, settings]
    call read_case(file, common, case, error)
    run = run_case(file, common)
    truth = run_case(file, [character(len=long) :: common, 'integrator.relative_tolerance=1e-13'])
    call make_certificate(case, run%report, .false., certificate, error)
    call check%that(.not. (allocated(error) .or. allocated(certificate%reason)), what//': a certificate is made')
    if (allocated(error) .or. allocated(certificate%reason)) return
    n = min(size(run%values, 2), size(truth%values, 2))
    allocate (errors(n), source=0.0_dp)
    do c = 1, size(run%names)
      if (.not. is_state(run%names(c))) cycle
      if (.not. maxval(run%values(c, :)) > minval(run%values(c, :))) cycle
      errors = max(errors, abs(run%values(c, :n) - truth%values(c, :n))/(maxval(run%values(c, :)) - minval(run%values(c, :))))
    end do
    true_end = end_of(errors, run%values(1, :n), 1e-3_dp)
    true_decade = end_of(errors, run%values(1, :n), 1e-4_dp)
    call check%that(certificate%until <= true_end*(1 + 1e-12_dp), what//': the certified time is not too long')
    call check%that(certificate%until >= min(0.95_dp*true_end, true_decade)*(1 - 1e-12_dp), &
      what//': the certified time is not far too short')
    call check%that(certificate%is_whole .eqv. to_the_end, what//': the whole run is certified or not')
    call check%that(certificate%state_error <= 20*maxval(errors, mask=run%values(1, :n) <= certificate%until), &
      what//': the certified error is not far above the true error')
    call check%that(certificate%state_error >= maxval(errors, mask=run%values(1, :n) <= certificate%until), &
      what//': the certified error is not below the true error')
    call check%that(impacts(run, certificate%until) == impacts(truth, certificate%until), what//': impacts in the certified time')
    call check%that((index(certificate_clause(certificate), 'results of the whole run within') > 0) .eqv. .not. to_the_end, &
      what//': the line tells how far results beyond the certified time can be trusted')
    call results_hold(check, run, truth, certificate, what)
    call columns_hold(check, run, truth, certificate, what)
    call check%that(index(certificate_clause(certificate), ' digits to ') > 0, what//': '//certificate_clause(certificate))
    call check%that(index(certificate_table(certificate), 'pin_force_x[N],') > 0, what//': table')
    call check%that(index(certificate_summary(certificate), 'certified_until,') == 1, what//': summary')
  end subroutine holds

  !> The errors of the forces in the certified part are those of the certificate, except for peaks between its rows.
  subroutine columns_hold(check, run, truth, certificate, what)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: run, truth
    type(certificate_t), intent(in) :: certificate
    character(len=*), intent(in) :: what
    character(len=32), parameter :: names(3) = [character(len=32) :: 'pin_force_x[N]', 'piston_acceleration[m/s2]', &
      'eccentricity_ratio[-]']
    real(dp) :: largest
    integer :: i, k, c, n
    n = count(run%values(1, :min(size(run%values, 2), size(truth%values, 2))) <= certificate%until)
    do i = 1, size(names)
      if (what == 'free crank' .and. i < 3) cycle   ! its forces jump between film and contact
      c = column(run, trim(names(i)))
      if (c == 0) cycle
      largest = maxval(abs(run%values(c, :n) - truth%values(c, :n)))
      do k = 1, size(certificate%list%id)
        if (column_name(certificate%list, k) /= trim(names(i))) cycle
        call check%that(certificate%error(k) >= 0.5_dp*largest, what//': certified error is not too small: '//trim(names(i)))
        call check%that(certificate%error(k) <= 20*largest, what//': certified error is not far too large: '//trim(names(i)))
      end do
    end do
  end subroutine columns_hold

  !> The differences of results of the whole run are not below the true ones, but for the error of the closer runs.
  subroutine results_hold(check, run, truth, certificate, what)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: run, truth
    type(certificate_t), intent(in) :: certificate
    character(len=*), intent(in) :: what
    character(len=*), parameter :: names(3) = [character(len=18) :: 'max_pin_force', 'mean_crank_speed', 'min_film_thickness']
    character(len=:), allocatable :: claim
    real(dp) :: claimed, own, true
    integer :: i
    do i = 1, size(names)
      claim = summary_value(achar(10)//certificate_summary(certificate), trim(names(i))//'_difference')
      if (what == 'crank pin' .and. i == 3) cycle   ! of the other pin
      call check%that(claim /= '', what//': difference of '//names(i))
      if (claim == '') cycle
      read (claim, *) claimed
      own = result_of(run, i)
      true = result_of(truth, i)
      call check%that(abs(own - true) <= 2*claimed + 1e-6_dp*abs(true), what//': the difference is not too small: '//names(i))
    end do
  end subroutine results_hold

  pure real(dp) function result_of(trace, i)
    type(trace_t), intent(in) :: trace
    integer, intent(in) :: i
    associate (f => trace%report%figures)
      associate (values => [f%pin(piston_pin)%max_force, f%crank_travel/f%time, f%pin(piston_pin)%min_film_thickness])
        result_of = values(i)
      end associate
    end associate
  end function result_of

  !> A piston in its bore: impacts at four edges of the skirt, some almost at the same time. The more accurate run has each of those
  !> in the certified time at the same time.
  subroutine has_every_impact(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: file = 'cases/joints/piston_slap.nml'
    character(len=long), parameter :: own(1) = [character(len=long) :: 'integrator.relative_tolerance=1e-8']
    character(len=long), parameter :: close(1) = [character(len=long) :: 'integrator.relative_tolerance=1e-10']
    type(certificate_t) :: certificate
    type(error_t), allocatable :: error
    type(case_t) :: case
    type(trace_t) :: run, truth
    integer :: i, there
    call read_case(file, own, case, error)
    run = run_case(file, own)
    truth = run_case(file, close)
    call make_certificate(case, run%report, .false., certificate, error)
    there = 0
    do i = 1, size(run%event)
      if (run%event(i)%kind /= 1 .or. run%event(i)%time > certificate%until) cycle
      if (any(truth%event%kind == 1 .and. truth%event%pin == run%event(i)%pin .and. &
              abs(truth%event%time - run%event(i)%time) < 1e-3_dp*run%event(i)%time)) there = there + 1
    end do
    ! two runs by Adams and Radau part after 4 to 21 ms, depending on rounding: 38 to 71 impacts
    call check%that(impacts(run, certificate%until) > 20, 'piston: number of impacts in the certified time')
    call check%that(impacts(run, certificate%until) - there <= 1, 'piston: the more accurate run has these impacts')
  end subroutine has_every_impact

  !> Number of contacts that begin up to a time.
  pure integer function impacts(run, until)
    type(trace_t), intent(in) :: run
    real(dp), intent(in) :: until
    impacts = count(run%event%time <= until .and. run%event%kind == 1)
  end function impacts

  !> The last time up to which no error exceeds a limit.
  pure real(dp) function end_of(errors, times, limit)
    real(dp), intent(in) :: errors(:), times(:), limit
    integer :: i
    end_of = 0
    do i = 1, size(errors)
      if (errors(i) > limit) exit
      end_of = times(i)
    end do
  end function end_of

  !> No reference is more accurate than a run at 1e-13.
  subroutine refuses_what_cannot_be_told(check)
    class(checks_t), intent(inout) :: check
    type(certificate_t) :: certificate
    type(error_t), allocatable :: error
    type(case_t) :: case
    type(trace_t) :: run
    character(len=long), parameter :: tight(2) = [character(len=long) :: 'integrator.relative_tolerance=1e-13', &
      'integrator.revolutions=0.1']
    call read_case('cases/flores/lubricated_400cP.nml', tight, case, error)
    run = run_case('cases/flores/lubricated_400cP.nml', tight)
    call make_certificate(case, run%report, .false., certificate, error)
    call check%that(allocated(certificate%reason) .and. .not. allocated(error), 'no certificate for a run at 1e-13')
    call check%that(index(certificate_clause(certificate), 'not certified: ') == 1, &
      'the line of the run says that it is not certified')
    call check%that(index(certificate_summary(certificate), 'certificate,"not certified: ') == 1, &
      'the summary says that it is not certified')
  end subroutine refuses_what_cannot_be_told
end module test_certificate
