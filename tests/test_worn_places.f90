!> Where a pin and its bore wear: volumes in the bins against quadratures over the rows of traces of every kind of joint, with their
!> arcs of contact and in the frames of bodies that turn, bend and tilt; and the motion, by all methods, with and without wear.
module test_worn_places
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use constants, only: pi, two_pi
  use bearing_size, only: bearing_t
  use error_handling, only: error_t
  use checks, only: checks_t
  use archard_wear, only: of_pin, of_bore
  use contact_law, only: contact_law_t
  use laws, only: contact_law_of
  use joint_places, only: crank_pin, piston_pin, name_prefix
  use wear_record, only: wear_profile_t
  use collecting_sink, only: trace_t, run_case, column, values_of
  implicit none
  private
  public :: run_test_worn_places

  integer, parameter :: long = 60
  real(dp), parameter :: usual(2) = [1e-15_dp, 2e-15_dp]   !! wear rates of most cases [m^2/N]
  character(len=*), parameter :: flores = 'cases/wear/flores.nml', liner = 'cases/wear/worn_bore.nml'
  character(len=*), parameter :: round(2) = [character(len=24) :: 'wear.bore=round', 'wear.extrapolation=1']

contains

  subroutine run_test_worn_places(check)
    class(checks_t), intent(inout) :: check
    call line_contacts(check)
    call wide_arcs(check)
    call conformal_arcs(check)
    call films(check)
    call both_joints(check)
    call elastic_rod(check)
    call loose_piston(check)
    call motion_is_the_same(check)
  end subroutine run_test_worn_places

  !> Int p over the arc of contact, over the normal force, by Simpson's rule in an angle s with theta = a sin(s).
  real(dp) function pressed(law, a)
    class(contact_law_t), intent(in) :: law
    real(dp), intent(in) :: a   !! half-angle [rad]
    integer, parameter :: n = 2000
    real(dp) :: s
    integer :: i
    pressed = 0
    do i = 1, n - 1
      s = pi*(i/real(n, dp) - 0.5_dp)
      pressed = pressed + (2 + 2*mod(i, 2))*pi/(3*n)*a*cos(s)*law%geometry%pressure(a, a*sin(s))
    end do
  end function pressed

  subroutine new_law(check, keys, clearance, law)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: keys
    real(dp), intent(in) :: clearance
    class(contact_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable :: error
    call contact_law_of(keys, law, error, bearing_t(10e-3_dp, 15e-3_dp, clearance, 0.2_dp))
    if (allocated(error)) call check%that(.false., 'law '//keys//': '//error%message)
  end subroutine new_law

  !> Contacts along a line: the volume is k Int F |v| dt, from rows that resolve each impact, for each geometry and each friction.
  subroutine line_contacts(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: fine(3) = [character(len=long) :: 'integrator.revolutions=0.25', 'output.interval=1e-7', &
      'wear.rate=2e-14,3e-15']
    type(trace_t) :: trace
    trace = run_case(flores, fine)
    call wears(check, trace, 'spheres', piston_pin, [2e-14_dp, 3e-15_dp], 2e-6_dp, is_line=.true.)
    call stands_around(check, trace, 'spheres', piston_pin, turn_of_rod(trace), 0*turn_of_rod(trace))
    trace = run_case(flores, [character(len=long) :: fine, 'contact.geometry=johnson', 'friction.law=coulomb'])
    call wears(check, trace, 'johnson, coulomb', piston_pin, [2e-14_dp, 3e-15_dp], 2e-6_dp, is_line=.true.)
    trace = run_case(flores, [character(len=long) :: fine, 'contact.geometry=pereira', 'friction=none'])
    call wears(check, trace, 'pereira without friction', piston_pin, [2e-14_dp, 3e-15_dp], 2e-6_dp, is_line=.true.)
    trace = run_case('cases/friction/lugre.nml', [character(len=long) :: fine, 'integrator.revolutions=0.1', &
      'joint.bearing_length=0.04'])
    call wears(check, trace, 'lugre', piston_pin, [2e-14_dp, 3e-15_dp], 2e-6_dp, is_line=.true.)
  end subroutine line_contacts

  !> A liner on which the arc is wide: the volume from the closed form of all pressing forces, and its place from the exact integral
  !> of the pressure over each bin.
  subroutine wide_arcs(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: bins = 90
    type(trace_t) :: trace
    real(dp), allocatable :: a(:), rate(:), middle(:, :)
    real(dp) :: volume(bins), total, low, high, part
    integer :: i, j, k
    trace = run_case(liner, [character(len=long) :: round, 'integrator.revolutions=0.3', 'output.interval=1e-5', 'wear.bins=90', &
      'wear.rate=1e-15,3e-15', 'contact.bedding_modulus=2e11', 'integrator.relative_tolerance=1e-8'])
    call wears(check, trace, 'liner', piston_pin, [1e-15_dp, 3e-15_dp], 2e-6_dp, is_line=.false.)
    if (allocated(trace%error)) return
    a = acos(1/(1 + max(0.0_dp, -values_of(trace, 'film_thickness[m]')/1e-4_dp)))
    rate = values_of(trace, 'normal_force[N]')*abs(values_of(trace, 'sliding_speed[m/s]'))
    call check%that(maxval(a) > 0.5_dp, 'the arc is wide')
    do j = 1, size(a)
      if (a(j) > 0.1_dp .and. rate(j) > 0) call check%relative(trace%values(column(trace, 'bore_wear_rate[m3/s]'), j)/rate(j), &
        3e-15_dp*2*(sin(a(j)) - a(j)*cos(a(j)))/(a(j) - sin(a(j))*cos(a(j))), 1e-3_dp, 'rate of wear on a wide arc')
    end do
    allocate (middle(size(a), 2))
    middle(:, of_bore) = line_of_centres(trace, piston_pin)
    middle(:, of_pin) = middle(:, of_bore) - turn_of_rod(trace)
    do k = of_pin, of_bore
      volume = 0
      do j = 2, size(a) - 1
        if (.not. (rate(j) > 0 .and. a(j) > 0)) cycle
        do i = -bins, 2*bins - 1
          low = max(-a(j), i*two_pi/bins - modulo(middle(j, k), two_pi))
          high = min(a(j), (i + 1)*two_pi/bins - modulo(middle(j, k), two_pi))
          if (high <= low) cycle
          part = (sin(high) - sin(low) - (high - low)*cos(a(j)))/(a(j) - sin(a(j))*cos(a(j)))
          volume(modulo(i, bins) + 1) = volume(modulo(i, bins) + 1) + 1e-5_dp*rate(j)*part*merge(1e-15_dp, 3e-15_dp, k == of_pin)
        end do
      end do
      total = sum(volume)
      associate (got => trace%report%wear(1)%volume(:, k))
        call check%that(maxval(volume)*bins > 3*total, 'wear on a wide arc is not even')
        call check%close_to(maxval(abs(got - volume))/total, 0.0_dp, 5e-4_dp, 'wear in each bin on a wide arc')
      end associate
    end do
  end subroutine wide_arcs

  !> A conformal contact wears more than k F |v|, as its columns of angle and force say: the pressing forces of the law, integrated
  !> independently.
  subroutine conformal_arcs(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    class(contact_law_t), allocatable :: law
    real(dp), allocatable :: rate(:), a(:)
    integer :: j, judged
    trace = run_case('cases/contact/conformal_exact.nml', [character(len=long) :: 'integrator.revolutions=0.15', &
      'output.interval=1e-7', 'wear.rate=1e-15,1e-14'])
    call wears(check, trace, 'conformal', piston_pin, [1e-15_dp, 1e-14_dp], 2e-6_dp, is_line=.false.)
    if (allocated(trace%error)) return
    call new_law(check, "geometry='conformal'", 150e-6_dp, law)
    rate = values_of(trace, 'normal_force[N]')*abs(values_of(trace, 'sliding_speed[m/s]'))*1e-15_dp
    a = values_of(trace, 'contact_half_angle[rad]')
    judged = 0
    do j = 1, size(rate), 20
      if (.not. (rate(j) > 1e-3_dp*maxval(rate))) cycle
      judged = judged + 1
      call check%relative(trace%values(column(trace, 'pin_wear_rate[m3/s]'), j), rate(j)*pressed(law, a(j)), 1e-3_dp, &
        'rate of wear of a conformal contact')
    end do
    call check%that(judged > 10, 'rows with a conformal contact')
  end subroutine conformal_arcs

  !> Surfaces with a film: asperities wear, film and contact that share the load, and a film that breaks in contact.
  subroutine films(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/film/sim_IV_mixed.nml', [character(len=long) :: 'lubrication.law=pinkus_sternlicht', &
      'lubrication.variant=closed_form', 'lubrication.viscosity=0.002', 'integrator.revolutions=0.4', 'output.interval=1e-6', &
      'initial.crank_angle_deg=330', 'wear.rate=1e-15,2e-15'])
    call wears(check, trace, 'asperities', piston_pin, usual, 1e-5_dp, is_line=.false.)
    trace = run_case('cases/film/weighted.nml', [character(len=long) :: 'integrator.revolutions=0.25', 'output.interval=1e-7', &
      'wear.rate=1e-15,2e-15'])
    call wears(check, trace, 'weighted transition', piston_pin, usual, 2e-6_dp, is_line=.true.)
    trace = run_case('cases/sim_I_oscillating.nml', [character(len=long) :: 'integrator.revolutions=0.2', &
      'output.interval=1e-7', 'wear.rate=1e-15,2e-15'])
    call wears(check, trace, 'film that switches', piston_pin, usual, 2e-6_dp, is_line=.true.)
  end subroutine films

  !> Each joint has its own wear; the crank turns the crank pin, and the rod turns the bore around it.
  subroutine both_joints(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/joints/both_pins.nml', [character(len=long) :: 'integrator.revolutions=0.15', 'output.interval=1e-7', &
      'wear.rate=1e-15,2e-15', 'joint.bearing_length=0.04', 'crank_pin.joint.bearing_length=0.03', &
      'integrator.relative_tolerance=1e-8'])
    call check%that(.not. allocated(trace%error), 'both joints wear')
    if (allocated(trace%error)) return
    call check%that(size(trace%report%wear) == 2, 'two worn joints')
    call wears(check, trace, 'piston pin of two', piston_pin, usual, 2e-6_dp, is_line=.true.)
    call wears(check, trace, 'crank pin of two', crank_pin, usual, 2e-6_dp, is_line=.true.)
    call stands_around(check, trace, 'piston pin of two', piston_pin, turn_of_rod(trace), 0*turn_of_rod(trace))
    call stands_around(check, trace, 'crank pin of two', crank_pin, values_of(trace, 'crank_angle[rad]'), turn_of_rod(trace))
    trace = run_case('cases/joints/both_pins.nml', [character(len=long) :: 'integrator.revolutions=0.15', 'output.interval=1e-6', &
      'crank_pin.wear.rate=1e-15,0', 'crank_pin.joint.bearing_length=0.03'])
    call check%that(.not. allocated(trace%error), 'the crank pin alone wears')
    if (allocated(trace%error)) return
    call check%that(size(trace%report%wear) == 1 .and. trace%report%wear(1)%place == crank_pin, 'the worn joint is the crank pin')
    call check%close_to(sum(trace%report%wear(1)%volume(:, of_bore)), 0.0_dp, 0.0_dp, 'a bore without a rate does not wear')
  end subroutine both_joints

  !> The pin turns with the end of an elastic rod: the chord, and the slopes of its sines.
  subroutine elastic_rod(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), allocatable :: bending(:)
    trace = run_case('cases/elastic/dry_friction.nml', [character(len=long) :: 'integrator.revolutions=0.25', &
      'output.interval=1e-7', 'wear.rate=1e-15,2e-15', 'joint.bearing_length=0.04', 'output.ideal_twin=F', &
      'elastic_rod.youngs_modulus=5e9', 'elastic_rod.section_inertia=1e-10'])
    call wears(check, trace, 'elastic rod', piston_pin, usual, 2e-6_dp, is_line=.true.)
    if (allocated(trace%error)) return
    bending = pi/0.12_dp*(2*values_of(trace, 'rod_mode_2[m]') - values_of(trace, 'rod_mode_1[m]'))
    call check%that(maxval(abs(bending)) > 0.02_dp, 'the rod bends')
    call stands_around(check, trace, 'elastic rod', piston_pin, turn_of_rod(trace) + bending, 0*turn_of_rod(trace))
  end subroutine elastic_rod

  !> The bore turns with a piston that tilts.
  subroutine loose_piston(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/joints/piston_slap.nml', [character(len=long) :: 'integrator.revolutions=0.1', 'output.interval=1e-7', &
      'wear.rate=1e-15,2e-15', 'joint.bearing_length=0.04', 'guide.bore_clearance=2e-3', 'wear.bins=3600', &
      'guide.skirt_top=0.008', 'guide.skirt_bottom=0.008', 'initial.piston_tilt=0.1'])
    call wears(check, trace, 'loose piston', piston_pin, usual, 2e-6_dp, is_line=.true.)
    if (allocated(trace%error)) return
    call check%that(maxval(abs(values_of(trace, 'piston_tilt[rad]'))) > 0.05_dp, 'the piston tilts')
    call stands_around(check, trace, 'loose piston', piston_pin, turn_of_rod(trace), values_of(trace, 'piston_tilt[rad]'))
  end subroutine loose_piston

  !> Rows and events are the same, to the last bit, whether wear is counted or not.
  subroutine motion_is_the_same(check)
    class(checks_t), intent(inout) :: check
    character(len=6), parameter :: methods(3) = [character(len=6) :: 'adams', 'radau', 'auto']
    character(len=*), parameter :: files(4) = [character(len=34) :: 'cases/flores/friction_100.nml', &
      'cases/joints/both_pins.nml', 'cases/friction/lugre.nml', 'cases/film/weighted.nml']
    character(len=long) :: settings(6)
    type(trace_t) :: with, without
    integer :: i, k, j, at
    logical :: same
    do i = 1, size(files)
      do k = 1, size(methods)
        settings = [character(len=long) :: 'integrator.revolutions=0.1', 'integrator.method='//methods(k), &
          'joint.bearing_length=0.04', 'integrator.max_steps=1000000', 'initial.crank_angle_deg=0', 'wear=none']
        if (i == 4) settings(3) = 'integrator.max_steps=2000000'
        if (i == 2) settings(4) = 'crank_pin.joint.bearing_length=0.04'
        without = run_case(trim(files(i)), settings(:5))
        settings(6) = 'wear.rate=1e-15,1e-15'
        with = run_case(trim(files(i)), settings)
        call check%that(.not. (allocated(with%error) .or. allocated(without%error)), 'with and without wear: '//files(i))
        if (allocated(with%error) .or. allocated(without%error)) return
        same = size(with%values, 2) == size(without%values, 2) .and. size(with%event) == size(without%event)
        if (same) then
          do j = 1, size(without%names)
            at = column(with, without%names(j))
            same = same .and. at > 0
            if (at > 0) same = same .and. all(transfer(with%values(at, :), [0_int64]) == transfer(without%values(j, :), [0_int64]))
          end do
        end if
        if (same) same = all(transfer(with%event%time, [0_int64]) == transfer(without%event%time, [0_int64]))
        call check%that(same, 'wear does not change the motion, '//trim(methods(k))//', '//files(i))
        call check%that(with%report%wear(1)%volume(1, 1) >= 0 .and. sum(with%report%wear(1)%volume) > 0, &
          'this motion wears, '//trim(methods(k))//', '//files(i))
      end do
    end do
  end subroutine motion_is_the_same

  !> A run wore: volumes of pin and bore are the integrals of their columns, by the trapezoidal rule over rows at equal times, which
  !> for contacts along a line are k F |v|; the depths are those of the volumes.
  subroutine wears(check, trace, name, place, rates, tolerance, is_line)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: trace
    character(len=*), intent(in) :: name
    integer, intent(in) :: place
    real(dp), intent(in) :: rates(2)        !! wear rates of pin and bore [m^2/N]
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: is_line          !! contact along a line
    type(wear_profile_t) :: worn
    real(dp), allocatable :: power(:)
    integer :: k
    if (allocated(trace%error)) then
      call check%that(.false., name//' runs: '//trace%error%message)
      return
    end if
    worn = worn_at(trace, place)
    call check%relative(sum(worn%volume(:, of_pin))*rates(of_bore), sum(worn%volume(:, of_bore))*rates(of_pin), 1e-12_dp, &
      name//': volumes of pin and bore')
    do k = of_pin, of_bore
      call check%relative(sum(worn%volume(:, k)), integral(trace, wear_of(trace, place, k)), tolerance, &
        name//': volume is the integral of the rate')
      call check%that(sum(worn%volume(:, k)) > 0 .and. all(worn%volume(:, k) >= 0), name//' wears')
    end do
    power = work_of_load(trace, place)
    call check%that(integral(trace, wear_of(trace, place, of_bore)) > (1 - 1e-9_dp)*rates(of_bore)*integral(trace, power), &
      name//': at least k Int F |v| dt wears')
    if (is_line) call check%relative(sum(worn%volume(:, of_pin)), rates(of_pin)*integral(trace, power), tolerance, &
      name//': volume is k Int F |v| dt')
  end subroutine wears

  !> Wear along lines of contact stands where the lines were in the frames of pin and bore, which turn by these angles [rad]: sums
  !> of the volumes up to the end of each bin from the rows of the trace, over the whole.
  subroutine stands_around(check, trace, name, place, pin_turns, bore_turns)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: trace
    character(len=*), intent(in) :: name
    integer, intent(in) :: place
    real(dp), intent(in) :: pin_turns(:), bore_turns(:)
    type(wear_profile_t) :: worn
    real(dp), allocatable :: power(:), line(:), volume(:)
    real(dp) :: largest
    integer :: j, k, n, bin
    if (allocated(trace%error)) return
    worn = worn_at(trace, place)
    power = work_of_load(trace, place)
    n = size(worn%volume, 1)
    allocate (volume(n))
    do k = of_pin, of_bore
      line = line_of_centres(trace, place) - merge(pin_turns, bore_turns, k == of_pin)
      volume = 0
      do j = 1, size(power)
        bin = 1 + min(n - 1, floor(modulo(line(j), two_pi)/two_pi*n))
        volume(bin) = volume(bin) + power(j)
      end do
      largest = 0
      do j = 1, n
        largest = max(largest, abs(sum(volume(:j))/sum(volume) - sum(worn%volume(:j, k))/sum(worn%volume(:, k))))
      end do
      call check%close_to(largest, 0.0_dp, 2e-3_dp, name//': place of the wear')
    end do
  end subroutine stands_around

  function worn_at(trace, place) result(worn)
    type(trace_t), intent(in) :: trace
    integer, intent(in) :: place
    type(wear_profile_t) :: worn
    worn = trace%report%wear(findloc(trace%report%wear%place, place, dim=1))
  end function worn_at

  !> Integral of a column over rows at equal times, and from the last row to the end of the run.
  pure real(dp) function integral(trace, values)
    type(trace_t), intent(in) :: trace
    real(dp), intent(in) :: values(:)
    integer :: n
    n = size(values)
    integral = (trace%values(1, n) - trace%values(1, 1))/(n - 1)*(sum(values) - 0.5_dp*(values(1) + values(n))) &
      + (trace%report%figures%time - trace%values(1, n))*values(n)
  end function integral

  !> Column of the wear of a pin or bore.
  pure function wear_of(trace, place, surface) result(values)
    type(trace_t), intent(in) :: trace
    integer, intent(in) :: place, surface
    real(dp) :: values(size(trace%values, 2))
    values = values_of(trace, name_prefix(place)//trim(merge('pin ', 'bore', surface == of_pin))//'_wear_rate[m3/s]')
  end function wear_of

  !> F |v| [W], of a contact or of asperities.
  pure function work_of_load(trace, place) result(values)
    type(trace_t), intent(in) :: trace
    integer, intent(in) :: place
    real(dp) :: values(size(trace%values, 2))
    character(len=:), allocatable :: force
    force = name_prefix(place)//'normal_force[N]'
    if (column(trace, force) == 0) force = name_prefix(place)//'asperity_force[N]'
    values = values_of(trace, force)*abs(values_of(trace, name_prefix(place)//'sliding_speed[m/s]'))
  end function work_of_load

  !> Angle of the line of centres, from x to y [rad].
  pure function line_of_centres(trace, place) result(angles)
    type(trace_t), intent(in) :: trace
    integer, intent(in) :: place
    real(dp) :: angles(size(trace%values, 2))
    angles = atan2(values_of(trace, name_prefix(place)//'eccentricity_y[m]'), &
      values_of(trace, name_prefix(place)//'eccentricity_x[m]'))
  end function line_of_centres

  !> Angle of the rod, from x to y [rad].
  pure function turn_of_rod(trace) result(angles)
    type(trace_t), intent(in) :: trace
    real(dp) :: angles(size(trace%values, 2))
    angles = -values_of(trace, 'rod_angle[rad]')
  end function turn_of_rod
end module test_worn_places
