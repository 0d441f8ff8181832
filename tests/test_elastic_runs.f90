!> Whole runs with elastic members: impacts against finite elements, the limit of the rigid rod, energy, methods, the crankshaft.
module test_elastic_runs
  use kinds, only: dp
  use checks, only: checks_t
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use run_summary, only: summary_table
  use case_checks, only: summary_value
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_elastic_runs

  integer, parameter :: long = 60
  character(len=*), parameter :: dry = 'cases/elastic/dry_friction.nml', impact = 'cases/elastic/first_impact.nml'

contains

  subroutine run_test_elastic_runs(check)
    class(checks_t), intent(inout) :: check
    call impacts_are_those_of_finite_elements(check)
    call a_stiff_rod_is_rigid(check)
    call energy_is_kept(check)
    call methods_agree(check)
    call auto_tries_radau_again(check)
    call every_joint_and_law(check)
    call a_folded_rod_leaves_the_model(check)
    call summary_and_twin(check)
    call peaks_between_rows(check)
    call cases_that_cannot_be(check)
    call crankshaft_swings(check)
    call a_stiff_crankshaft_is_rigid(check)
    call a_held_flywheel_keeps_its_speed(check)
  end subroutine run_test_elastic_runs

  !> The first two contacts against 24 ANCF cable elements (Exudyn): times [s] and speeds [m/s]. With a rigid rod the pin leaves the
  !> first contact with 1.74 m/s.
  subroutine impacts_are_those_of_finite_elements(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: instants(4) = [0.2107e-3_dp, 0.3394e-3_dp, 0.6871e-3_dp, 0.8728e-3_dp]
    real(dp), parameter :: speeds(4) = [1.972_dp, -0.874_dp, 1.074_dp, -0.764_dp]
    type(trace_t) :: trace
    integer :: i
    trace = run_case(impact, [character(len=long) :: ])
    call check%that(size(trace%event) == 4, 'two contacts in a millisecond')
    if (size(trace%event) /= 4) return
    do i = 1, 4
      call check%close_to(trace%event(i)%time, instants(i), 1.5e-6_dp, 'times of the contacts of finite elements')
      call check%close_to(trace%event(i)%normal_speed, speeds(i), 0.035_dp, 'speeds of the contacts of finite elements')
    end do
    trace = run_case(impact, [character(len=long) :: 'elastic_rod=none'])
    call check%close_to(trace%event(2)%normal_speed, -1.738_dp, 1e-3_dp, 'speed after the first contact with a rigid rod')
  end subroutine impacts_are_those_of_finite_elements

  !> With Young's modulus ten times larger the first contact is ten times nearer to that of the rigid rod.
  subroutine a_stiff_rod_is_rigid(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: rigid, elastic
    real(dp) :: distance(2), before(2)
    character(len=long) :: overrides(7)
    character(len=7), parameter :: moduli(3) = ['2.07e13', '2.07e14', '2.07e15']
    integer :: i
    overrides = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=3e-4', 'elastic_rod.transverse_modes=1', &
      'elastic_rod.axial_shapes=1', 'integrator.relative_tolerance=1e-9', '', 'elastic_rod=none']
    rigid = run_case(dry, overrides([1, 2, 5, 7]))
    call check%that(size(rigid%event) >= 2, 'a rigid rod has a contact')
    before = 0
    do i = 1, size(moduli)
      overrides(6) = 'elastic_rod.youngs_modulus='//moduli(i)
      elastic = run_case(dry, overrides(:6))
      call check%that(size(elastic%event) >= 2, 'a stiff rod has a contact')
      if (size(elastic%event) < 2) return
      distance = abs(elastic%event(:2)%time - rigid%event(:2)%time)
      if (i > 1) call check%that(all(distance < before/7 .and. distance > before/14), &
        'difference is of first order in the compliance')
      before = distance
    end do
    call check%that(all(before < [1e-9_dp, 2e-8_dp]), 'a stiff rod converges to the rigid one')
  end subroutine a_stiff_rod_is_rigid

  !> Undamped Hertz contact, no damping in the rod, a free crank.
  subroutine energy_is_kept(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(dry, [character(len=long) :: 'friction=none', 'contact.law=hertz', 'drive.kind=free', &
      'elastic_rod.damping_ratio=0', 'elastic_rod.axial_damping_ratio=0', 'integrator.relative_tolerance=1e-11', &
      'integrator.revolutions=0', 'integrator.end_time=0.01', 'mechanism.gravity=9.81', 'mechanism.rod_com=0.055,0.003'])
    call check%equal_text(trace%report%status, 'done', 'an undamped rod')
    call check%that(size(trace%event) > 20, 'an undamped rod has many contacts')
    associate (f => trace%report%figures)
      call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-10_dp, 'an undamped rod: energy residual')
    end associate
  end subroutine energy_is_kept

  subroutine methods_agree(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: traces(3)
    character(len=long) :: overrides(5)
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    integer :: i, k
    do i = 1, 3
      overrides = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=8e-4', &
        'integrator.relative_tolerance=1e-10', 'output.interval=1e-5', '']
      overrides(5) = 'integrator.method='//methods(i)
      traces(i) = run_case(dry, overrides)
      call check%equal_text(traces(i)%report%status, 'done', 'elastic rod by '//methods(i))
    end do
    do i = 2, 3
      do k = 1, size(traces(1)%names)
        if (index(traces(1)%names(k), 'rod_') /= 1 .or. index(traces(1)%names(k), 'acceleration') > 0) cycle
        call check%close_to(maxval(abs(traces(i)%values(k, :) - traces(1)%values(k, :))), 0.0_dp, &
          1e-6_dp*maxval(abs(traces(1)%values(k, :))), 'all methods: '//traces(1)%names(k))
      end do
    end do
  end subroutine methods_agree

  !> At 1e-9 Adams follows the first waves along the rod of an engine with fewer evaluations than Radau, but needs a hundred times
  !> more for later waves; therefore `auto` must try Radau again soon enough. In half a revolution Adams alone takes 256 000
  !> evaluations, Radau 43 000, and `auto` took 140 000 when its trials became rarer without limit.
  subroutine auto_tries_radau_again(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/elastic/engine_rod.nml', [character(len=long) :: 'integrator.method=auto', &
      'integrator.revolutions=0.5', 'integrator.relative_tolerance=1e-9'])
    call check%equal_text(trace%report%status, 'done', 'half a revolution of an elastic rod')
    call check%that(trace%report%statistics%evaluations < 70000, 'auto tries Radau again')
  end subroutine auto_tries_radau_again

  !> The elastic rod with ideal pins, with clearance at either pin and at both, with sticking surfaces, with bristles and with
  !> films.
  subroutine every_joint_and_law(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: span(3) = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=2e-3', &
      'integrator.relative_tolerance=1e-9']
    character(len=long), parameter :: crank_pin(3) = [character(len=long) :: 'crank_pin.joint.kind=clearance', &
      'crank_pin.joint.clearance=1e-4', 'crank_pin.joint.bearing_radius=0.015']
    character(len=long), parameter :: bore(9) = [character(len=long) :: 'guide.kind=clearance', 'guide.bore_clearance=1e-4', &
      'guide.skirt_top=0.02', 'guide.skirt_bottom=0.02', 'guide.piston_radius=0.02', 'guide.piston_inertia=3e-5', &
      'guide.piston_com=0.002,0.001', 'guide.stiffness=1e8', 'guide.coefficient=0']
    character(len=long), parameter :: ideal(4) = [character(len=long) :: 'joint.kind=ideal', 'joint.clearance=0', &
      'contact=none', 'friction=none']
    call runs('ideal pins', dry, [span, ideal])
    call runs('ideal pins, free crank', dry, [character(len=long) :: span, ideal, 'drive.kind=free'])
    call runs('clearance at both pins', dry, [span, crank_pin])
    call runs('clearance at the crank pin', dry, [character(len=long) :: span, crank_pin, 'joint.kind=ideal', 'joint.clearance=0'])
    call runs('surfaces that stick', dry, [character(len=long) :: span, crank_pin, 'friction.law=coulomb', 'friction.v0=0', &
      'friction.v1=0', 'friction.coefficient=0.3', 'initial.crank_speed=50', 'mechanism.gravity=9.81'])
    call runs('bristles', dry, [character(len=long) :: span, 'friction.law=lugre', 'friction.stribeck_speed=0.01', &
      'friction.bristle_stiffness=2e4'])
    call runs('film', 'cases/elastic/engine_rod.nml', [character(len=long) :: span(:1), 'integrator.end_time=0.01', span(3)])
    call runs('friction on the guide', dry, [character(len=long) :: span, ideal, 'guide.kind=friction', 'guide.coefficient=0.05', &
      'guide.v0=0.001', 'guide.v1=0.01'])
    call runs('clearance in the bore', dry, [character(len=long) :: span, bore])
    call runs('clearance in the bore, ideal pins', dry, [character(len=long) :: span, ideal, bore])
    call runs('clearance everywhere', dry, [character(len=long) :: span, crank_pin, bore, 'crankshaft.flywheel_inertia=0.01', &
      'crankshaft.torsional_stiffness=2e4', 'mechanism.gravity=9.81', 'mechanism.gravity_angle_deg=90'])
    call runs('elastic crankshaft too', dry, [character(len=long) :: span, 'crankshaft.flywheel_inertia=0.01', &
      'crankshaft.torsional_stiffness=2e4'])

  contains

    subroutine runs(what, file, overrides)
      character(len=*), intent(in) :: what, file, overrides(:)
      real(dp) :: largest(4)
      type(trace_t) :: trace
      trace = run_case(file, overrides)
      call check%that(.not. allocated(trace%error), 'elastic rod: '//what//' can be built')
      if (.not. allocated(trace%names)) return
      call check%equal_text(trace%report%status, 'done', 'elastic rod: '//what)
      associate (f => trace%report%figures)
        call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-8_dp, 'elastic rod: '//what//', energy residual')
      end associate
      largest = elastic_extremes(trace)
      call check%that(all(largest([1, 4]) > 0), 'elastic rod: '//what//', the rod bends')
    end subroutine runs
  end subroutine every_joint_and_law

  !> A piston of ten tonnes on a rod of 1e-5 m^2 compresses the rod to less than the crank's length and folds it over the crank,
  !> where the coordinates are singular. The run ends before, when the rod has lost half of its length, and its energy residual is
  !> small until then.
  subroutine a_folded_rod_leaves_the_model(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    integer :: i
    do i = 1, 2
      trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: 'elastic_rod.youngs_modulus=1e13', &
        'elastic_rod.section_area=1e-5', 'elastic_rod.section_inertia=5e-8', 'elastic_rod.transverse_modes=1', &
        'elastic_rod.axial_shapes=1', 'elastic_rod.damping_ratio=0.999', 'mechanism.piston_mass=1e4', &
        'mechanism.crank_inertia=1e-6', 'initial.crank_angle_deg=90', 'joint.clearance=1.5e-8', 'guide.coefficient=2', &
        'guide.v0=0.001', 'guide.v1=0.98', 'integrator.revolutions=1', 'integrator.method='//merge('radau', 'auto ', i == 1)])
      call check%that(index(trace%report%status, 'the state left the range of the model') == 1, &
        'a run with a rod that is compressed too far stops')
      associate (f => trace%report%figures)
        call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-5_dp, 'a rod that is compressed: energy residual')
      end associate
    end do
  end subroutine a_folded_rod_leaves_the_model

  subroutine summary_and_twin(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, twin
    type(case_t) :: case
    type(error_t), allocatable :: error
    character(len=:), allocatable :: table
    character(len=long), parameter :: span(2) = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=1e-3']
    real(dp) :: largest
    trace = run_case(dry, span)
    call read_case(dry, span, case, error)
    table = summary_table(case, trace%report, 0.0_dp)
    call check%equal_text(summary_value(table, 'elastic_members'), 'rod', 'elastic members in the summary')
    largest = number_of(table, 'max_rod_mid_deflection')
    call check%that(largest >= maxval(abs(trace%values(column(trace, 'rod_mid_deflection[m]'), :)))*(1 - 1e-9_dp), &
      'largest deflection in the summary')
    call check%relative(number_of(table, 'rod_bending_frequency'), 843.2_dp, 1e-2_dp, 'bending frequency [Hz]')
    table = summary_table(case, trace%report, 0.0_dp, is_twin=.true.)
    call check%equal_text(summary_value(table, 'elastic_members'), 'none: the ideal twin is rigid', &
      'the summary of the ideal twin says that it is rigid')
    twin = run_case(dry, span, .true.)
    call check%that(column(twin, 'rod_mode_1[m]') == 0, 'the ideal twin has no column of a mode')
  end subroutine summary_and_twin

  !> Largest deflection, stretch, twist and energy of elastic members in the report of a run; 0 of those that it does not have.
  function elastic_extremes(trace) result(largest)
    type(trace_t), intent(in) :: trace
    real(dp) :: largest(4)
    character(len=*), parameter :: names(4) = [character(len=22) :: 'max_rod_mid_deflection', 'max_rod_stretch', &
      'max_crankshaft_twist', 'max_rod_strain_energy']
    integer :: i
    largest = 0
    do i = 1, size(trace%report%kept)
      where (names == trace%report%kept(i)%name) largest = trace%report%kept(i)%value
    end do
  end function elastic_extremes

  !> The largest values of elastic members do not depend on the rows, and are those of close rows.
  subroutine peaks_between_rows(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: names(3) = [character(len=21) :: 'rod_mid_deflection[m]', 'rod_stretch[m]', &
      'crankshaft_twist[rad]']
    character(len=*), parameter :: files(2) = [character(len=40) :: 'cases/elastic/engine_rod.nml', &
      'cases/elastic/engine_crankshaft.nml']
    character(len=long), parameter :: rows(2) = [character(len=long) :: 'output.samples_per_revolution=20', &
      'output.samples_per_revolution=20000']
    type(trace_t) :: far, near
    real(dp) :: largest(4), those_of_near(4), in_rows
    integer :: i, k
    do i = 1, size(files)
      far = run_case(trim(files(i)), [character(len=long) :: rows(1), 'integrator.revolutions=0.5'])
      near = run_case(trim(files(i)), [character(len=long) :: rows(2), 'integrator.revolutions=0.5'])
      largest = elastic_extremes(far)
      those_of_near = elastic_extremes(near)
      do k = 1, size(largest)
        call check%relative(largest(k), those_of_near(k), 1e-10_dp, 'largest values of elastic members do not depend on rows')
      end do
      do k = 1, size(names)
        if (column(near, names(k)) == 0) cycle
        in_rows = maxval(abs(near%values(column(near, names(k)), :)))
        call check%close_to(largest(k)/in_rows, 1 + 5e-6_dp, 5e-6_dp, 'largest '//trim(names(k))//' against close rows')
      end do
    end do
  end subroutine peaks_between_rows

  !> The value of a quantity of a summary.
  real(dp) function number_of(table, quantity)
    character(len=*), intent(in) :: table, quantity
    character(len=:), allocatable :: text
    text = summary_value(table, quantity)
    read (text, *) number_of
  end function number_of

  subroutine cases_that_cannot_be(check)
    class(checks_t), intent(inout) :: check
    call refused('mechanism.rod_com=0,0', '&mechanism rod_com(1) = 0: must be between the pins')
    call refused('elastic_rod.shank_mass=0.22', '&elastic_rod shank_mass = 0.22: must be <= 0.21')
    call refused('mechanism.rod_inertia=1e-6', '&mechanism rod_inertia = 1e-6: must be >')
    call refused('elastic_rod.transverse_modes=9', '&elastic_rod transverse_modes = 9: must be >= 0 and <= 8')
    call refused('mechanism.rod_com=0.06,0.05', '&elastic_rod transverse_modes = 8: mass matrix not positive definite', &
      [character(len=long) :: 'drive.kind=free', 'elastic_rod.transverse_modes=8', 'elastic_rod.axial_shapes=8'])
    call refused('elastic_rod.section_area=0', '&elastic_rod section_area = 0: must be > 0')

  contains

    subroutine refused(override, message, beside)
      character(len=*), intent(in) :: override, message
      character(len=*), intent(in), optional :: beside(:)   !! further overrides
      character(len=long), allocatable :: overrides(:)
      type(case_t) :: case
      type(error_t), allocatable :: error
      allocate (overrides(1))
      if (present(beside)) then
        deallocate (overrides)
        allocate (overrides(1 + size(beside)))
        overrides(2:) = beside
      end if
      overrides(1) = override
      call read_case(dry, overrides, case, error)
      call check%that(allocated(error), 'refused: '//override)
      if (.not. allocated(error)) return
      call check%that(index(error%message, message) > 0, 'message: '//error%message)
    end subroutine refused
  end subroutine cases_that_cannot_be

  !> A moment tau on the flywheel of a mechanism at rest: the twist is tau/(J_f omega^2) (1 - cos omega t) with
  !> omega^2 = k (1/J_f + 1/m). Here m is the moment of inertia of the mechanism, which at q = 0 is that of the crank and of a rod
  !> that rotates about the piston pin; the piston has no part in it.
  subroutine crankshaft_swings(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: flywheel = 0.02_dp, stiffness = 2e4_dp, tau = 10
    real(dp), parameter :: inertia = 1e-5_dp + 0.3_dp*0.025_dp**2 + 0.21_dp*0.05_dp**2*0.5_dp**2 + 2.5e-4_dp*(0.05_dp/0.12_dp)**2
    type(trace_t) :: trace
    type(case_t) :: case
    type(error_t), allocatable :: error
    real(dp), allocatable :: want(:)
    real(dp) :: omega, hertz
    character(len=long), parameter :: overrides(12) = [character(len=long) :: 'elastic_rod=none', 'friction=none', 'contact=none', &
      'joint.kind=ideal', 'joint.clearance=0', 'crankshaft.flywheel_inertia=0.02', 'crankshaft.torsional_stiffness=2e4', &
      'drive.kind=free', 'drive.torque=10', 'initial.crank_speed=0', 'integrator.revolutions=0', 'output.interval=1e-4']
    character(len=long), parameter :: accuracy(2) = [character(len=long) :: 'integrator.end_time=2e-3', &
      'integrator.relative_tolerance=1e-12']
    omega = sqrt(stiffness*(1/flywheel + 1/inertia))
    trace = run_case(dry, [overrides, accuracy])
    call check%equal_text(trace%report%status, 'done', 'a crankshaft under a moment')
    associate (t => trace%values(column(trace, 'time[s]'), :), twist => trace%values(column(trace, 'crankshaft_twist[rad]'), :))
      want = tau/(flywheel*omega**2)*(1 - cos(omega*t))
      call check%close_to(maxval(abs(twist - want))/maxval(want), 0.0_dp, 1e-5_dp, 'twist of a crankshaft under a moment')
    end associate
    call read_case(dry, [overrides, accuracy], case, error)
    hertz = number_of(summary_table(case, trace%report, 0.0_dp), 'crankshaft_frequency')
    omega = sqrt(stiffness*(1/flywheel + 1/mean_inertia()))
    call check%relative(hertz*8*atan(1.0_dp), omega, 1e-6_dp, 'frequency of a crankshaft')

  contains

    !> Mean over a turn of the inertia of crank, rod (its centre of mass half way) and piston, twice the kinetic energy at speed 1.
    real(dp) function mean_inertia() result(mean)
      integer, parameter :: n = 1000
      real(dp), parameter :: r = 0.05_dp, l = 0.12_dp
      real(dp) :: q, b, rate, along, half
      integer :: i
      mean = 0
      do i = 1, n
        q = 8*atan(1.0_dp)*i/n
        b = asin(-r*sin(q)/l)
        rate = -r*cos(q)/(l*cos(b))
        along = -r*sin(q) - l*sin(b)*rate
        half = -r*sin(q) - 0.5_dp*l*sin(b)*rate
        mean = mean + (1e-5_dp + 0.3_dp*0.025_dp**2 + 0.21_dp*(half**2 + (0.5_dp*r*cos(q))**2) + 2.5e-4_dp*rate**2 &
          + 0.14_dp*along**2)/n
      end do
    end function mean_inertia
  end subroutine crankshaft_swings

  !> In the limit without torsion the inertia of the crank includes that of the flywheel.
  subroutine a_stiff_crankshaft_is_rigid(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: rigid, elastic
    character(len=long) :: overrides(9)
    character(len=3), parameter :: stiffness(2) = ['1e6', '1e7']
    real(dp) :: distance(2)
    integer :: i
    overrides = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=0.05', &
      'integrator.relative_tolerance=1e-9', 'elastic_rod=none', 'mechanism.crank_inertia=0.026', '', '', '', 'drive.torque=3']
    rigid = run_case('cases/elastic/engine_rod.nml', overrides([1, 2, 3, 4, 5, 9]), .true.)
    overrides(5) = 'mechanism.crank_inertia=0.006'
    overrides(6) = 'crankshaft.flywheel_inertia=0.02'
    overrides(7) = 'crankshaft.torsional_damping=10'
    do i = 1, 2
      overrides(8) = 'crankshaft.torsional_stiffness='//stiffness(i)
      elastic = run_case('cases/elastic/engine_rod.nml', [character(len=long) :: overrides, 'joint.kind=ideal', 'contact=none', &
        'friction=none', 'lubrication=none', 'joint.clearance=0'])
      call check%that(.not. allocated(elastic%error), 'a run with a stiff crankshaft')
      if (.not. allocated(elastic%names)) return
      associate (a => elastic%values(column(elastic, 'crank_angle[rad]'), :), &
                 b => rigid%values(column(rigid, 'crank_angle[rad]'), :))
        distance(i) = maxval(abs(a - b))
      end associate
      call check%close_to(elastic%report%figures%max_energy_residual/elastic%report%figures%max_energy, 0.0_dp, 1e-8_dp, &
        'energy residual of a crankshaft')
    end do
    call check%that(distance(1) < 1e-3_dp .and. distance(2) < distance(1)/5, 'a stiff crankshaft converges to the rigid one')
  end subroutine a_stiff_crankshaft_is_rigid

  !> At constant speed the speed of the flywheel is constant; the crank oscillates, and the moment on the flywheel does all the
  !> work.
  subroutine a_held_flywheel_keeps_its_speed(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: crank(2), wheel(2)
    trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: 'crankshaft.flywheel_inertia=0.02', &
      'crankshaft.torsional_stiffness=2e4', 'crankshaft.torsional_damping=0.01', 'integrator.relative_tolerance=1e-10', &
      'integrator.method=auto'])
    call check%equal_text(trace%report%status, 'done', 'a run with constant speed of the flywheel')
    crank = spread_of('crank_speed[rad/s]')
    wheel = spread_of('flywheel_speed[rad/s]')
    call check%that(wheel(2) - wheel(1) <= 0, 'the flywheel''s speed is constant')
    call check%that(crank(2) - crank(1) > 1e-2_dp*crank(2), 'the crank''s speed is not constant')
    call check%close_to(trace%report%figures%max_energy_residual/trace%report%figures%max_energy, 0.0_dp, 1e-9_dp, &
      'energy residual at constant speed of the flywheel')

  contains

    function spread_of(name) result(ends)
      character(len=*), intent(in) :: name
      real(dp) :: ends(2)
      associate (values => trace%values(column(trace, name), :))
        ends = [minval(values), maxval(values)]
      end associate
    end function spread_of
  end subroutine a_held_flywheel_keeps_its_speed
end module test_elastic_runs
