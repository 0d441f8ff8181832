!> Wear: how load paths are spread over a surface; pressures along arcs of contact against their resultant; the volumes and their
!> distribution of a run against an independent program and against quadratures of its trace; runs with other joints, films and
!> members; the motion with and without wear.
module test_wear
  use kinds, only: dp
  use constants, only: pi, two_pi
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use joint_places, only: name_prefix
  use archard_wear, only: worn_surface_t, of_pin, of_bore
  use contact_geometry, only: contact_geometry_t
  use conformal, only: conformal_t
  use winkler, only: winkler_t
  use johnson, only: johnson_t
  use hertz_sphere, only: hertz_sphere_t
  use asperities, only: asperities_t
  use case_checks, only: expect
  use collecting_sink, only: trace_t, run_case, load_table, column
  implicit none
  private
  public :: run_test_wear

  integer, parameter :: long = 60
  character(len=*), parameter :: flores = 'cases/wear/flores.nml'
  type(bearing_t), parameter :: bearing = bearing_t(10e-3_dp, 15e-3_dp, 1e-4_dp, 0.2_dp)

contains

  subroutine run_test_wear(check)
    class(checks_t), intent(inout) :: check
    call spreads_over_bins(check)
    call pressures_carry_the_load(check)
    call asperities_carry_the_load(check)
    call wears_as_another_program(check)
    call wears_as_the_trace_says(check)
    call motion_is_the_same(check)
    call wide_arcs_wear_more(check)
    call narrow_bins(check)
    call wears_at_both_pins(check)
    call wears_through_a_film(check)
    call refuses(check)
  end subroutine run_test_wear

  !> The sum is kept, each bin gets its share, and angles of any turn are those of one turn.
  subroutine spreads_over_bins(check)
    class(checks_t), intent(inout) :: check
    type(worn_surface_t) :: surface
    integer :: i
    call surface%prepare(8)
    call surface%add(-0.25_dp*pi, 0.125_dp*pi, 3.0_dp)
    call check%close_to(maxval(abs(surface%load_path - [1, 0, 0, 0, 0, 0, 0, 2])), 0.0_dp, 1e-14_dp, 'an arc across zero')
    call surface%prepare(8)
    call surface%add(6.625_dp*pi, 6.5_dp*pi, 2.0_dp)
    call check%close_to(maxval(abs(surface%load_path - [0, 0, 2, 0, 0, 0, 0, 0])), 0.0_dp, 1e-13_dp, 'an arc of another turn')
    call surface%add(0.3_dp, 0.3_dp, 5.0_dp)
    call check%close_to(surface%load_path(1), 5.0_dp, 0.0_dp, 'a point')
    call surface%prepare(360)
    do i = 1, 1000
      call surface%add(0.37_dp*i, 0.37_dp*i + 6.2_dp*modulo(i*0.618_dp, 1.0_dp), 1.0_dp)
    end do
    call check%relative(sum(surface%load_path), 1000.0_dp, 1e-13_dp, 'the sum of many arcs')
    call check%that(all(surface%load_path > 0), 'many arcs reach every bin')
    call surface%prepare(4)
    call surface%add(0.1_dp, 0.1_dp + two_pi, 4.0_dp)
    call check%close_to(maxval(abs(surface%load_path - 1)), 0.0_dp, 1e-14_dp, 'a whole turn')
  end subroutine spreads_over_bins

  !> The pressures of an arc, projected on the line of centres, make up the normal force, and are largest in its middle. Spheres and
  !> cylinders of Johnson touch along a line.
  subroutine pressures_carry_the_load(check)
    class(checks_t), intent(inout) :: check
    type(conformal_t) :: bore
    type(winkler_t) :: liner
    type(johnson_t) :: cylinder
    type(hertz_sphere_t) :: sphere
    real(dp) :: a
    integer :: i
    bore%compliance = 0.386294_dp
    bore%youngs_modulus = 207e9_dp
    bore%poissons_ratio = 0.3_dp
    call bore%prepare(bearing)
    liner%given_modulus = 1e13_dp
    call liner%prepare(bearing)
    do i = 1, 8
      a = 0.18_dp*i
      call check%relative(integral_over_arc(bore, a, .true.), 1.0_dp, 1e-9_dp, 'pressure of a conformal contact')
      call check%relative(integral_over_arc(liner, a, .true.), 1.0_dp, 1e-9_dp, 'pressure of a liner')
      call check%that(bore%pressure(a, 0.0_dp) > bore%pressure(a, 0.5_dp*a), 'the pressure falls along the arc')
    end do
    do i = 0, 20
      a = 1.45_dp*0.4_dp**i
      call check%relative(bore%total_pressure(a), integral_over_arc(bore, a, .false.), 1e-12_dp, 'total pressure, conformal')
      call check%relative(liner%total_pressure(a), integral_over_arc(liner, a, .false.), 1e-12_dp, 'total pressure, liner')
    end do
    call check%relative(liner%half_angle(1e-4_dp), pi/3, 1e-14_dp, 'half-angle of a liner')
    call check%close_to(cylinder%half_angle(1e-6_dp) + sphere%half_angle(1e-6_dp), 0.0_dp, 0.0_dp, 'half-angles of lines')
  end subroutine pressures_carry_the_load

  !> Int p dtheta over the arc by the midpoint rule in s with theta = a sin s, or `along` the line of centres Int p cos theta
  !> dtheta.
  real(dp) function integral_over_arc(geometry, a, along) result(total)
    class(contact_geometry_t), intent(in) :: geometry
    real(dp), intent(in) :: a
    logical, intent(in) :: along
    integer, parameter :: n = 4000
    real(dp) :: s
    integer :: i
    total = 0
    do i = 1, n
      s = pi*((i - 0.5_dp)/n - 0.5_dp)
      total = total + geometry%pressure(a, a*sin(s))*merge(cos(a*sin(s)), 1.0_dp, along)*a*cos(s)*pi/n
    end do
  end function integral_over_arc

  subroutine asperities_carry_the_load(check)
    class(checks_t), intent(inout) :: check
    type(asperities_t) :: rough
    real(dp) :: distance, total, step
    integer :: i, k
    integer, parameter :: n = 20000
    rough%integral = 'exact'
    rough%roughness = 0.4e-6_dp
    rough%density_product = 0.05_dp
    rough%sharpness = 1e-2_dp
    rough%youngs_modulus = 207e9_dp
    rough%poissons_ratio = 0.3_dp
    call rough%prepare(bearing)
    do k = 1, 3
      distance = bearing%clearance - (3 - 2*k)*rough%roughness
      step = rough%half_angle(distance)/n
      total = 0
      do i = 1, n
        total = total + 2*step*rough%pressure(distance, (i - 0.5_dp)*step)*cos((i - 0.5_dp)*step)
      end do
      call check%relative(rough%force(distance), total, 1e-5_dp, 'pressure of asperities')
    end do
    call check%close_to(rough%half_angle(0.9_dp*bearing%clearance), 0.0_dp, 0.0_dp, 'no arc where asperities do not touch')
  end subroutine asperities_carry_the_load

  !> One revolution of Flores's mechanism: the volume, and how it is distributed over bore and pin, of an independent program.
  subroutine wears_as_another_program(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: volume = 3.610935e-13_dp
    type(trace_t) :: trace
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: table(:, :)
    integer :: i, surface
    trace = run_case(flores, [character(len=long) :: 'integrator.revolutions=1', 'integrator.relative_tolerance=1e-10'])
    call check%that(.not. allocated(trace%error), 'a run with wear')
    if (allocated(trace%error)) return
    call load_table('contact/wear_flores.csv', names, table)
    call check%that(size(table, 2) == 90, 'the table of the distribution was read')
    do surface = of_pin, of_bore
      associate (worn => trace%report%wear(1)%volume(:, surface), cumulative => table(merge(3, 2, surface == of_pin), :))
        call check%relative(sum(worn), volume, 1e-6_dp, 'worn volume of another program')
        do i = 1, size(table, 2)
          call check%close_to(sum(worn(:nint(table(1, i)))), cumulative(i), 1e-3_dp*volume, 'distribution of another program')
        end do
      end associate
    end do
    associate (worn => trace%report%wear(1))
      call check%relative(worn%depth(100, of_pin)*9.5e-3_dp*0.04_dp*two_pi/360, worn%volume(100, of_pin), 1e-13_dp, &
        'depth of a bin')
      call check%relative(worn%depth(100, of_bore)*10e-3_dp*0.04_dp*two_pi/360, worn%volume(100, of_bore), 1e-13_dp, &
        'depth of a bin of the bore')
    end associate
  end subroutine wears_as_another_program

  !> The volumes are the wear rates times the integral of normal force and sliding speed, and the integral of the columns; work of
  !> friction is that integral times the coefficient, but for the little time at speeds below v1.
  subroutine wears_as_the_trace_says(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: integral, from_columns(2)
    trace = run_case(flores, [character(len=long) :: 'integrator.revolutions=0.2', 'output.samples_per_revolution=1000000', &
      'wear.rate=1e-15,3e-14'])
    call check%that(.not. allocated(trace%error), 'a run with many rows')
    if (allocated(trace%error)) return
    integral = sum_of(trace, abs(trace%values(column(trace, 'normal_force[N]'), :)* &
      trace%values(column(trace, 'sliding_speed[m/s]'), :)))
    from_columns(of_pin) = sum_of(trace, trace%values(column(trace, 'pin_wear_rate[m3/s]'), :))
    from_columns(of_bore) = sum_of(trace, trace%values(column(trace, 'bore_wear_rate[m3/s]'), :))
    associate (volumes => sum(trace%report%wear(1)%volume, 1))
      call check%relative(volumes(of_pin), 1e-15_dp*integral, 1e-6_dp, 'volume from forces and speeds')
      call check%relative(volumes(of_bore), 3e-14_dp*integral, 1e-6_dp, 'volume of the bore from forces and speeds')
      call check%relative(from_columns(of_pin), volumes(of_pin), 1e-6_dp, 'volume from the rates of the trace')
      call check%relative(from_columns(of_bore), volumes(of_bore), 1e-6_dp, 'volume of the bore from the rates of the trace')
    end associate
    call check%relative(-trace%report%figures%pin(2)%friction_work, 0.05_dp*integral, 1e-3_dp, 'work of friction')
  end subroutine wears_as_the_trace_says

  !> Integral of a column over time, by the trapezoidal rule.
  pure real(dp) function sum_of(trace, values)
    type(trace_t), intent(in) :: trace
    real(dp), intent(in) :: values(:)
    integer :: n
    n = size(values)
    sum_of = sum(0.5_dp*(values(2:) + values(:n - 1))*(trace%values(1, 2:) - trace%values(1, :n - 1)))
  end function sum_of

  !> Wear is counted beside the motion: all columns that a run without wear has too are equal to the last bit.
  subroutine motion_is_the_same(check)
    class(checks_t), intent(inout) :: check
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    type(trace_t) :: with, without
    integer :: i, j, at
    logical :: same
    do i = 1, size(methods)
      with = run_case(flores, [character(len=long) :: 'integrator.revolutions=0.3', 'integrator.method='//methods(i)])
      without = run_case(flores, [character(len=long) :: 'integrator.revolutions=0.3', 'integrator.method='//methods(i), &
        'wear=none'])
      call check%that(.not. (allocated(with%error) .or. allocated(without%error)), 'runs with and without wear')
      if (allocated(with%error) .or. allocated(without%error)) cycle
      same = size(with%values, 2) == size(without%values, 2)
      do j = 1, merge(size(without%names), 0, same)
        at = column(with, trim(without%names(j)))
        same = same .and. at > 0
        if (same) same = all(abs(with%values(at, :) - without%values(j, :)) <= 0)
      end do
      call check%that(same, 'the motion does not depend on the count of wear, '//methods(i))
      call check%that(size(without%report%wear) == 0, 'no wear without the group')
    end do
  end subroutine motion_is_the_same

  !> On a wide arc more volume wears than force times path, by the ratio of Int p to the force, for a liner 2 (sin a - a cos a)/(a -
  !> sin a cos a).
  subroutine wide_arcs_wear_more(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), allocatable :: half_angle(:), load(:), ratio(:)
    trace = run_case('cases/contact/liner_carvalho_martins.nml', [character(len=long) :: 'integrator.revolutions=0.3', &
      'contact.liner_modulus=1e8', 'output.samples_per_revolution=1000000', 'wear.rate=0,1e-14'])
    call check%that(.not. allocated(trace%error), 'a run with a soft liner')
    if (allocated(trace%error)) return
    associate (force => trace%values(column(trace, 'normal_force[N]'), :), &
               speed => trace%values(column(trace, 'sliding_speed[m/s]'), :), &
               ratio_of_eccentricity => trace%values(column(trace, 'eccentricity_ratio[-]'), :))
      half_angle = acos(min(1.0_dp, 1/max(ratio_of_eccentricity, 1e-3_dp)))
      load = abs(force*speed)
      ratio = merge(2*(sin(half_angle) - half_angle*cos(half_angle))/max(half_angle - sin(half_angle)*cos(half_angle), 1e-30_dp), &
        1.0_dp, half_angle > 0.02_dp)
    end associate
    associate (volume => sum(trace%report%wear(1)%volume(:, of_bore)))
      call check%relative(volume, 1e-14_dp*sum_of(trace, load*ratio), 1e-5_dp, 'volume on a wide arc')
      call check%that(volume > 1.01_dp*1e-14_dp*sum_of(trace, load), 'more than force times path')
    end associate
    call check%close_to(sum(trace%report%wear(1)%volume(:, of_pin)), 0.0_dp, 0.0_dp, 'a pin without a wear rate')
  end subroutine wide_arcs_wear_more

  !> On a wide arc, bins that are much narrower than it take few evaluations more than wide ones, and wear as these do.
  subroutine narrow_bins(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: wide, narrow
    character(len=long), parameter :: soft(4) = [character(len=long) :: 'integrator.revolutions=0.3', 'contact.liner_modulus=1e8', &
      'integrator.relative_tolerance=1e-8', 'wear.rate=0,1e-14']
    integer :: i
    wide = run_case('cases/contact/liner_carvalho_martins.nml', [soft, [character(len=long) :: 'wear.bins=90']])
    narrow = run_case('cases/contact/liner_carvalho_martins.nml', [soft, [character(len=long) :: 'wear.bins=3600']])
    call check%that(.not. (allocated(wide%error) .or. allocated(narrow%error)), 'runs with wide and narrow bins')
    if (allocated(wide%error) .or. allocated(narrow%error)) return
    associate (in_wide => wide%report%wear(1)%volume(:, of_bore), in_narrow => narrow%report%wear(1)%volume(:, of_bore))
      call check%relative(sum(in_narrow), sum(in_wide), 1e-8_dp, 'volume in narrow bins')
      do i = 1, size(in_wide)
        call check%close_to(sum(in_narrow(40*i - 39:40*i)), in_wide(i), 2e-3_dp*maxval(in_wide), 'volumes of forty narrow bins')
      end do
    end associate
    call check%that(narrow%report%figures%evaluations < 2*wide%report%figures%evaluations, 'evaluations for narrow bins')
  end subroutine narrow_bins

  !> Both pins wear, each by its own law, with an elastic rod too; and in a piston that tilts.
  subroutine wears_at_both_pins(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=:), allocatable :: prefix
    real(dp) :: integral
    integer :: i
    trace = run_case('cases/joints/both_pins.nml', [character(len=long) :: 'integrator.revolutions=0.2', &
      'joint.bearing_length=0.02', 'crank_pin.joint.bearing_length=0.02', 'wear.rate=1e-15,1e-15', 'crank_pin.wear.rate=2e-15,0', &
      'output.samples_per_revolution=300000'])
    call check%that(.not. allocated(trace%error), 'a run with wear at both pins')
    if (allocated(trace%error)) return
    call check%that(size(trace%report%wear) == 2, 'two worn joints')
    do i = 1, size(trace%report%wear)
      prefix = name_prefix(trace%report%wear(i)%place)
      associate (worn => trace%report%wear(i))
        integral = sum_of(trace, abs(trace%values(column(trace, prefix//'normal_force[N]'), :)* &
          trace%values(column(trace, prefix//'sliding_speed[m/s]'), :)))
        call check%relative(sum(worn%volume(:, of_pin)), merge(2, 1, prefix /= '')*1e-15_dp*integral, 1e-5_dp, &
          'volume of a pin of two')
        call check%that((sum(worn%volume(:, of_bore)) > 0) .eqv. prefix == '', 'volume of a bore of two')
      end associate
    end do
    trace = run_case('cases/joints/both_pins.nml', [character(len=long) :: 'integrator.revolutions=0.05', &
      'joint.bearing_length=0.02', 'crank_pin.joint.bearing_length=0.02', 'wear.rate=1e-15,1e-15', &
      'elastic_rod.section_area=3e-4', 'elastic_rod.section_inertia=1.5e-8', 'integrator.relative_tolerance=1e-4'])
    call check%that(.not. allocated(trace%error), 'wear of an elastic rod')
    if (.not. allocated(trace%error)) call check%that(sum(trace%report%wear(1)%volume) > 0, 'an elastic rod wears its pins')
  end subroutine wears_at_both_pins

  !> Asperities that touch through a film wear both surfaces, on an arc. With window = 'last_period' only this period is counted.
  subroutine wears_through_a_film(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: integral
    trace = run_case('cases/film/sim_IV_mixed.nml', [character(len=long) :: 'drive.kind=constant_speed', &
      'lubrication.variant=short', 'lubrication.viscosity=0.002', 'wear.rate=1e-16,1e-16', 'run.until=periodic', &
      'run.period_revolutions=2', 'output.window=last_period', 'run.most_revolutions=20', 'output.samples_per_revolution=50000'])
    call check%that(.not. allocated(trace%error), 'a mixed film with wear')
    if (allocated(trace%error)) return
    call check%that(trace%report%periods%period == 2 .and. trace%values(1, 1) > 0, 'its motion is periodic')
    integral = sum_of(trace, abs(trace%values(column(trace, 'asperity_force[N]'), :)* &
      trace%values(column(trace, 'sliding_speed[m/s]'), :)))
    associate (worn => trace%report%wear(1)%volume)
      call check%that(sum(worn(:, of_bore)) > 1e-16_dp*integral .and. sum(worn(:, of_bore)) < 1.01e-16_dp*integral, &
        'volume worn through a film in one period')
      call check%relative(sum_of(trace, trace%values(column(trace, 'bore_wear_rate[m3/s]'), :)), sum(worn(:, of_bore)), 1e-4_dp, &
        'the rates of a mixed film')
      call check%relative(sum(worn(:, of_pin)), sum(worn(:, of_bore)), 1e-12_dp, 'pin and bore wear alike')
    end associate
  end subroutine wears_through_a_film

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    call expect(check, '&contact / &wear rate=1e-15,0 /', '', 'wear of the pin')
    call expect(check, '&contact / &wear /', '&wear rate', 'wear without a rate')
    call expect(check, '&contact / &wear rate=-1e-15,1e-15 /', '&wear rate', 'a negative rate')
    call expect(check, '&contact / &wear rate=1e-15,0 bins=3 /', '&wear bins = 3', 'three bins')
    call expect(check, '&lubrication viscosity=0.01 / &wear rate=1e-15,0 /', '&wear rate', 'wear of surfaces that never touch')
    call expect(check, '&lubrication viscosity=0.01 elastic_film=T / &contact law=''hertz'' / &wear rate=1e-15,0 /', '&wear rate', &
      'wear of the walls of a film')
  end subroutine refuses
end module test_wear
