!> Wear in whole runs: volumes and their distribution against an independent program and against quadratures of the trace; other
!> joints, films and members; the motion with and without wear.
module test_wear_runs
  use kinds, only: dp
  use constants, only: two_pi
  use checks, only: checks_t
  use joint_places, only: name_prefix
  use archard_wear, only: of_pin, of_bore
  use case_checks, only: expect
  use collecting_sink, only: trace_t, run_case, column
  use data_tables, only: load_table
  implicit none
  private
  public :: run_test_wear_runs

  integer, parameter :: long = 60
  character(len=*), parameter :: flores = 'cases/wear/flores.nml'

contains

  subroutine run_test_wear_runs(check)
    class(checks_t), intent(inout) :: check
    call wears_as_another_program(check)
    call wears_as_the_trace_says(check)
    call wears_where_the_trace_says(check)
    call motion_is_the_same(check)
    call wide_arcs_wear_more(check)
    call narrow_bins(check)
    call wears_at_both_pins(check)
    call wears_through_a_film(check)
    call refuses(check)
  end subroutine run_test_wear_runs

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
        call check%relative(sum(worn), volume, 5e-6_dp, 'worn volume of another program')   ! 1.2e-6 with other sines and powers
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

  !> Each bin of the bore wears as the rows say whose line of centres points to it, also where this line turns back inside a long
  !> step.
  subroutine wears_where_the_trace_says(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: bins = 360
    type(trace_t) :: trace
    real(dp) :: path(bins), angle
    integer :: i, bin
    trace = run_case(flores, [character(len=long) :: 'contact.restitution=0.1', 'joint.clearance=2e-5', &
      'initial.crank_speed=60', 'integrator.revolutions=2', 'integrator.method=radau', 'integrator.relative_tolerance=1e-5', &
      'wear.rate=0,1e-14', 'output.samples_per_revolution=200000', 'output.ideal_twin=F'])
    call check%that(.not. allocated(trace%error), 'a run with long steps')
    if (allocated(trace%error)) return
    path = 0
    associate (values => trace%values, x => column(trace, 'eccentricity_x[m]'), y => column(trace, 'eccentricity_y[m]'), &
               force => column(trace, 'normal_force[N]'), speed => column(trace, 'sliding_speed[m/s]'))
      do i = 2, size(values, 2)
        angle = modulo(atan2(values(y, i), values(x, i)), two_pi)
        bin = min(bins, 1 + int(angle/two_pi*bins))
        path(bin) = path(bin) + abs(values(force, i)*values(speed, i))*(values(1, i) - values(1, i - 1))
      end do
    end associate
    associate (worn => trace%report%wear(1)%volume(:, of_bore))
      ! a part that has its turning point inside reaches beyond it: 1.8 % of the deepest bin, which is 0.3 % less deep
      call check%that(maxval(abs(worn - 1e-14_dp*path)) < 0.04_dp*maxval(worn), 'wear of each bin')
      call check%relative(maxval(worn), 1e-14_dp*maxval(path), 0.02_dp, 'wear of the deepest bin')
    end associate
  end subroutine wears_where_the_trace_says

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
      if (same) then
        do j = 1, size(without%names)
          at = column(with, trim(without%names(j)))
          same = same .and. at > 0
          if (same) same = all(abs(with%values(at, :) - without%values(j, :)) <= 0)
        end do
      end if
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
end module test_wear_runs
