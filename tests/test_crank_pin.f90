!> Cases with clearance at the crank pin: results of each joint, end of a run, methods, limits; and gravity perpendicular to the
!> cylinder.
module test_crank_pin
  use kinds, only: dp
  use constants, only: degree
  use error_handling, only: error_t
  use chain_motion, only: crank_pin, piston_pin
  use case_definition, only: case_t
  use case_file, only: read_case
  use run_summary, only: summary_table
  use case_checks, only: summary_value
  use run_line, only: lines_for_user
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_crank_pin

  integer, parameter :: long = 60
  character(len=*), parameter :: both = 'cases/joints/both_pins.nml', alone = 'cases/joints/crank_pin.nml'
  character(len=*), parameter :: films = 'cases/joints/both_pins_lubricated.nml'

contains

  subroutine run_test_crank_pin(check)
    class(checks_t), intent(inout) :: check
    call summaries_have_each_joint(check)
    call reasons_name_the_joint(check)
    call starts_anywhere_in_its_bearing(check)
    call has_an_ideal_twin(check)
    call energy_and_reactions(check)
    call a_stiff_crank_pin_is_an_ideal_one(check)
    call methods_agree(check)
    call gravity_holds_still(check)
    call gravity_does_work(check)
  end subroutine run_test_crank_pin

  !> The summary has the piston pin under names without prefix, the crank pin under names with its prefix, and no values of an ideal
  !> pin.
  subroutine summaries_have_each_joint(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    type(case_t) :: case
    character(len=:), allocatable :: table

    call run_and_summarise(both, trace, case, table)
    associate (pins => trace%report%figures%pin, events => trace%event)
      call check%that(pins(piston_pin)%contacts > 5 .and. pins(crank_pin)%contacts > 5, 'both pins have contacts')
      call check%that(count(events%kind == 1 .and. events%pin == piston_pin) == pins(piston_pin)%contacts, &
        'contacts of the piston pin')
      call check%that(count(events%kind == 1 .and. events%pin == crank_pin) == pins(crank_pin)%contacts, &
        'contacts of the crank pin')
      call check%relative(value_of('contacts'), real(pins(piston_pin)%contacts, dp), 0.0_dp, 'contacts in the summary')
      call check%relative(value_of('crank_pin_contacts'), real(pins(crank_pin)%contacts, dp), 0.0_dp, 'both')
      call check%that(abs(value_of('crank_pin_max_pin_force') - value_of('max_pin_force')) > 1, &
        'the two pins have different forces')
      call check%relative(value_of('crank_pin_max_penetration'), maxval(events%max_penetration, events%pin == crank_pin), &
        1e-9_dp, 'deepest contact of the crank pin')
      call check%relative(value_of('max_penetration'), maxval(events%max_penetration, events%pin == piston_pin), &
        1e-9_dp, 'deepest contact of the piston pin')
      call check%relative(value_of('crank_pin_contact_time_fraction')*trace%report%figures%time, contact_time(crank_pin), &
        1e-9_dp, 'time in contact at the crank pin')
      call check%relative(value_of('contact_time_fraction')*trace%report%figures%time, contact_time(piston_pin), 1e-9_dp, &
        'time in contact at the piston pin')
    end associate
    call check%that(index(lines_for_user(case, trace%report, 0.0_dp, 'x', ''), new_line('a')//'  crank pin: ') > 0, &
      'the line of the run has the crank pin')

    call run_and_summarise(alone, trace, case, table)
    call check%that(all(trace%event%pin == crank_pin), 'all events are those of the crank pin')
    call check%equal_text(summary_value(table, 'contacts')//summary_value(table, 'min_film_thickness')// &
      summary_value(table, 'contact_time_fraction'), '', 'an ideal piston pin has no contacts')
    call check%that(value_of('max_pin_force') > 100, 'an ideal piston pin has a force')
    call check%that(value_of('crank_pin_contacts') > 0, 'the crank pin has contacts')
    call run_and_summarise('cases/flores/dry_0500um.nml', trace, case, table)
    call check%that(index(table, 'crank_pin') == 0, 'an ideal crank pin is not in the summary')
    call check%that(index(lines_for_user(case, trace%report, 0.0_dp, 'x', ''), 'crank pin') == 0, &
      'an ideal crank pin is not in the line of the run')

  contains

    subroutine run_and_summarise(file, trace, case, table)
      character(len=*), intent(in) :: file
      type(trace_t), intent(out) :: trace
      type(case_t), intent(out) :: case
      character(len=:), allocatable, intent(out) :: table
      character(len=long), parameter :: overrides(1) = ['integrator.revolutions=0.5']
      type(error_t), allocatable :: error
      call read_case(file, overrides, case, error)
      trace = run_case(file, overrides)
      table = summary_table(case, trace%report, 0.0_dp)
      call check%that(.not. allocated(trace%error), file//' runs')
    end subroutine run_and_summarise

    real(dp) function value_of(quantity)
      character(len=*), intent(in) :: quantity
      character(len=:), allocatable :: text
      text = summary_value(table, quantity)
      value_of = -1
      if (text /= '') read (text, *) value_of
    end function value_of

    !> Sum over the contacts; the last of them may continue at the end.
    real(dp) function contact_time(pin)
      integer, intent(in) :: pin
      integer :: i
      logical :: touches
      contact_time = 0
      touches = .false.
      do i = 1, size(trace%event)
        associate (e => trace%event(i))
          if (e%pin /= pin) cycle
          touches = e%kind == 1
          contact_time = contact_time + merge(-e%time, e%time, touches)
        end associate
      end do
      if (touches) contact_time = contact_time + trace%report%figures%time
    end function contact_time
  end subroutine summaries_have_each_joint

  !> The message of a run that stops names the phase of each pin, and the pin at which the model is not valid.
  subroutine reasons_name_the_joint(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(both, ['integrator.max_steps=5'])
    call says('phase free flight at the piston pin, free flight at the crank pin')
    trace = run_case(both, [character(len=long) :: 'integrator.max_steps=100', 'initial.crank_pin_eccentricity=1e-4,0', &
      'initial.crank_pin_eccentricity_rate=1,0'])
    call says('phase free flight at the piston pin, contact at the crank pin')
    trace = run_case(alone, ['integrator.max_steps=5'])
    call says('phase free flight at the crank pin')
    call check%that(index(trace%error%message, 'piston pin') == 0, 'the message does not name an ideal piston pin')
    trace = run_case(both, [character(len=long) :: 'crank_pin.contact.law=hertz', 'crank_pin.contact.youngs_modulus=1e6,1e6'])
    call says('the state left the range of the model (the crank pin left its bearing or its film)')
    trace = run_case(both, [character(len=long) :: 'contact.youngs_modulus=1e6,1e6', 'crank_pin.contact.law=hertz', &
      'crank_pin.contact.youngs_modulus=2e11,2e11'])
    call says('the state left the range of the model (the piston pin left its bearing or its film)')
    trace = run_case(films, [character(len=long) :: 'initial.crank_pin_eccentricity=2.02e-5,0', &
      'integrator.max_evaluations=300000'])
    call says('ill-posed: the film at the crank pin has almost no thickness')
    trace = run_case('cases/flores/dry_0500um.nml', ['integrator.max_steps=5'])
    call check%that(index(trace%error%message, ' at the ') == 0, 'the message does not name a joint that is the only one')

  contains

    subroutine says(text)
      character(len=*), intent(in) :: text
      call check%that(allocated(trace%error), 'the run stops: '//text)
      if (.not. allocated(trace%error)) return
      call check%that(index(trace%error%message, text) > 0, 'the message has "'//text//'", not "'//trace%error%message//'"')
    end subroutine says
  end subroutine reasons_name_the_joint

  !> A start in contact is an event of that pin; a pin that starts in free flight moves straight to the wall if no force acts.
  subroutine starts_anywhere_in_its_bearing(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(both, [character(len=long) :: 'initial.crank_pin_eccentricity=1.001e-4,0', 'integrator.revolutions=0.01'])
    call check%that(trace%event(1)%pin == crank_pin .and. .not. trace%event(1)%time > 0, 'a crank pin that starts in contact')
    call check%relative(trace%values(column(trace, 'crank_pin_film_thickness[m]'), 1), -1e-7_dp, 1e-9_dp, &
      'initial penetration of the crank pin')
    trace = run_case(both, [character(len=long) :: 'initial.crank_speed=0', 'mechanism.gravity=0', 'integrator.revolutions=0', &
      'integrator.end_time=1e-3', 'output.interval=1e-4', 'initial.crank_pin_eccentricity_rate=0.3,0.4'])
    call check%that(trace%event(1)%pin == crank_pin, 'a crank pin in free flight comes into contact')
    call check%relative(trace%event(1)%time, 2e-4_dp, 1e-4_dp, &
      'time of flight of the crank pin, except for the rotation of the rod')
    call check%relative(trace%event(1)%normal_speed, 0.5_dp, 2e-4_dp, 'impact speed of the crank pin is its initial speed')
  end subroutine starts_anywhere_in_its_bearing

  !> The ideal twin of a case with clearance at the crank pin only is the mechanism with ideal pins.
  subroutine has_an_ideal_twin(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: twin, ideal
    twin = run_case(alone, [character(len=long) :: 'integrator.revolutions=1'], ideal_joint=.true.)
    ideal = run_case(alone, [character(len=long) :: 'integrator.revolutions=1', 'crank_pin.joint=none', 'contact=none', &
      'friction=none'])
    call check%that(.not. allocated(ideal%error) .and. size(twin%event) == 0, 'a twin')
    call check%that(all(shape(twin%values) == shape(ideal%values)), 'the ideal twin has no columns of a joint')
    if (all(shape(twin%values) == shape(ideal%values))) &
      call check%that(all(abs(twin%values - ideal%values) <= 0), 'the ideal twin is the mechanism with ideal pins')
  end subroutine has_an_ideal_twin

  !> In every row the force at the crank pin that the motion of the rod requires is that of the laws, and the energy is conserved.
  subroutine energy_and_reactions(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    character(len=long), parameter :: files(3) = [character(len=long) :: both, alone, films]
    integer :: i
    do i = 1, size(files)
      trace = run_case(trim(files(i)), [character(len=long) :: 'drive.kind=free', 'integrator.relative_tolerance=1e-9', &
        'integrator.revolutions=1'])
      call check%that(.not. allocated(trace%error), trim(files(i))//' with a free crank')
      call check%close_to(trace%report%figures%max_energy_residual/trace%report%figures%max_energy, 0.0_dp, 1e-9_dp, &
        trim(files(i))//': energy')
      associate (force => hypot(of('crankpin_force_x[N]'), of('crankpin_force_y[N]')), &
                 contact => hypot(of('crank_pin_normal_force[N]'), of('crank_pin_friction_force[N]')), &
                 film => hypot(of('crank_pin_film_force_x[N]'), of('crank_pin_film_force_y[N]')))
        call check%close_to(maxval(abs(force - contact - film))/maxval(force), 0.0_dp, 1e-11_dp, &
          trim(files(i))//': F3, F4 are the forces of the laws')
        call check%that(any(force > 10), 'the joint forces are not zero')
      end associate
    end do

  contains

    !> A column; 0 if it does not exist.
    function of(name) result(values)
      character(len=*), intent(in) :: name
      real(dp) :: values(size(trace%values, 2))
      values = 0
      if (column(trace, name) > 0) values = trace%values(column(trace, name), :)
    end function of
  end subroutine energy_and_reactions

  !> With nearly no clearance, increasing contact stiffness and no loss, the motion converges to that of an ideal crank pin.
  subroutine a_stiff_crank_pin_is_an_ideal_one(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: common(6) = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=6e-4', &
      'output.interval=6e-5', 'friction=none', 'integrator.relative_tolerance=1e-9', 'crank_pin.contact.law=hertz']
    character(len=long), parameter :: stiffness(2) = [character(len=long) :: 'crank_pin.contact.stiffness=1e12', &
      'crank_pin.contact.stiffness=1e16']
    type(trace_t) :: ideal, loose
    real(dp) :: off(2)
    integer :: i
    ideal = run_case(both, [character(len=long) :: common(:5), 'crank_pin.joint=none'])
    call check%that(size(ideal%event) > 0 .and. all(ideal%event%pin == piston_pin), 'an ideal crank pin has no events')
    do i = 1, size(stiffness)
      loose = run_case(both, [character(len=long) :: common, 'crank_pin.joint.clearance=1e-7', stiffness(i)])
      call check%that(.not. allocated(loose%error), 'a run with a stiff crank pin')
      off(i) = maxval(abs(loose%values(column(loose, 'rod_angle[rad]'), :) - ideal%values(column(ideal, 'rod_angle[rad]'), :)))
    end do
    call check%that(off(2) < 0.3_dp*off(1), 'a stiffer crank pin is nearer to the ideal one')
    call check%close_to(off(2), 0.0_dp, 5e-6_dp, 'rod angle with a stiff crank pin [rad]')
  end subroutine a_stiff_crank_pin_is_an_ideal_one

  !> Two dry joints with friction; one or two with films, contact and friction; and two with films that carry the load: the results
  !> are the same by each method at two tolerances.
  subroutine methods_agree(check)
    class(checks_t), intent(inout) :: check
    character(len=5), parameter :: methods(3) = [character(len=5) :: 'adams', 'radau', 'auto']
    character(len=long), parameter :: files(4) = [character(len=long) :: both, alone, films, films]
    character(len=long), parameter :: spans(4) = [character(len=long) :: '4e-3', '6e-3', '8e-4', '4e-3']   ! before chaos
    character(len=4), parameter :: tolerances(2) = ['1e-6', '1e-9']
    real(dp), parameter :: within(2, 4) = reshape([5e-3_dp, 5e-6_dp, 1e-3_dp, 1e-5_dp, 0.1_dp, 1e-4_dp, 1e-5_dp, 1e-8_dp], [2, 4])
    type(trace_t) :: reference, trace
    character(len=long) :: common(8)
    integer :: i, k, m
    do i = 1, size(files)
      common = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time='//spans(i), 'output.interval=1e-5', &
        'output.digits=17', 'output.ideal_twin=F', 'output.columns=standard', 'integrator.relative_tolerance=1e-11', &
        'integrator.method=adams']
      if (i == 3) common(4:6) = [character(len=long) :: 'lubrication.law=oscillating_film', &
        'lubrication.kinematic_viscosity=1.38e-5', 'initial.crank_angle_deg=200']
      reference = run_case(trim(files(i)), common)
      call check%that(.not. allocated(reference%error), trim(files(i))//' by Adams at 1e-11')
      do k = 1, size(tolerances)
        do m = 1, size(methods)
          common(7:) = [character(len=long) :: 'integrator.relative_tolerance='//tolerances(k), 'integrator.method='//methods(m)]
          trace = run_case(trim(files(i)), common)
          call check%that(.not. allocated(trace%error), trim(files(i))//' by '//methods(m)//' at '//tolerances(k))
          call check%close_to(distance(), 0.0_dp, within(k, i), trim(files(i))//' by '//methods(m)//' at '//tolerances(k))
        end do
      end do
    end do

  contains

    !> Largest distance of an eccentricity, over its largest.
    real(dp) function distance()
      character(len=28), parameter :: names(4) = [character(len=28) :: 'eccentricity_x[m]', 'eccentricity_y[m]', &
        'crank_pin_eccentricity_x[m]', 'crank_pin_eccentricity_y[m]']
      integer :: j
      distance = 0
      do j = 1, size(names)
        if (column(trace, names(j)) == 0) cycle
        associate (one => trace%values(column(trace, names(j)), :), other => reference%values(column(reference, names(j)), :))
          distance = max(distance, maxval(abs(one - other))/maxval(abs(other)))
        end associate
      end do
    end function distance
  end subroutine methods_agree

  !> A crank held at rest: the frame carries the weights and the drive their moment, by virtual work, for any direction of gravity.
  subroutine gravity_holds_still(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: angles(4) = [0.0_dp, 30.0_dp, 90.0_dp, 215.0_dp], r = 0.05_dp, l = 0.12_dp, g = 9.81_dp
    real(dp), parameter :: q = 40*degree, h = 1e-5_dp, mass(3) = [0.3_dp, 0.21_dp, 0.14_dp]
    type(trace_t) :: trace
    character(len=long) :: overrides(9)
    integer :: i
    do i = 1, size(angles)
      overrides = [character(len=long) :: 'initial.crank_speed=0', 'integrator.revolutions=0', 'integrator.end_time=1e-4', &
        'output.interval=1e-4', 'mechanism.gravity=9.81', '', 'initial.crank_angle_deg=40', 'mechanism.rod_com=0.05,0.004', &
        'mechanism.crank_com=0.01,-0.006']
      write (overrides(6), '(a,f0.1)') 'mechanism.gravity_angle_deg=', angles(i)
      trace = run_case('cases/flores/ideal.nml', overrides)
      associate (a => angles(i)*degree)
        call check%close_to(of('frame_force_x[N]'), sum(mass)*g*cos(a), 1e-12_dp, &
          'the frame carries the weights along the cylinder')
        call check%close_to(of('frame_force_y[N]'), sum(mass)*g*sin(a), 1e-12_dp, &
          'the frame carries the weights across the cylinder')
        call check%close_to(of('crank_moment[N.m]'), (height(q + h, a) - height(q - h, a))/(2*h), 1e-9_dp, 'moment of the weights')
        call check%close_to(of('energy[J]'), height(q, a), 1e-13_dp, 'energy of the weights')
      end associate
    end do

  contains

    real(dp) function of(name)
      character(len=*), intent(in) :: name
      of = trace%values(column(trace, name), 2)
    end function of

    !> Potential energy with the crank at an angle [J].
    pure real(dp) function height(q, a)
      real(dp), intent(in) :: q, a
      real(dp) :: x(3), y(3), s, c
      s = r*sin(q)/l
      c = sqrt(1 - s**2)
      x = [0.01_dp*cos(q) + 0.006_dp*sin(q), r*cos(q) + 0.05_dp*c + 0.004_dp*s, r*cos(q) + l*c]
      y = [0.01_dp*sin(q) - 0.006_dp*cos(q), r*sin(q) - 0.05_dp*s + 0.004_dp*c, 0.0_dp]
      height = g*dot_product(mass, x*cos(a) + y*sin(a))
    end function height
  end subroutine gravity_holds_still

  !> Gravity turned by 180 degrees is gravity with the opposite sign; with gravity across the cylinder the energy residual is small.
  subroutine gravity_does_work(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: up, turned
    character(len=long), parameter :: common(3) = [character(len=long) :: 'drive.kind=free', 'integrator.revolutions=0.2', &
      'integrator.relative_tolerance=1e-10']
    character(len=long), parameter :: files(4) = [character(len=long) :: 'cases/flores/ideal.nml', both, alone, &
      'cases/flores/friction_050.nml']
    integer :: i
    do i = 1, size(files)
      up = run_case(trim(files(i)), [character(len=long) :: common, 'mechanism.gravity=-300'])
      turned = run_case(trim(files(i)), [character(len=long) :: common, 'mechanism.gravity=300', 'mechanism.gravity_angle_deg=180'])
      call check%close_to(maxval(abs(up%values(2, :) - turned%values(2, :))), 0.0_dp, 1e-8_dp, &
        trim(files(i))//': gravity turned by half a revolution')
      turned = run_case(trim(files(i)), [character(len=long) :: common, 'mechanism.gravity=300', 'mechanism.gravity_angle_deg=90'])
      call check%that(maxval(abs(up%values(2, :) - turned%values(2, :))) > 1e-4_dp, &
        'gravity turned by a quarter revolution changes the motion')
      call check%close_to(turned%report%figures%max_energy_residual/turned%report%figures%max_energy, 0.0_dp, 1e-10_dp, &
        trim(files(i))//': energy under gravity across the cylinder')
    end do
  end subroutine gravity_does_work
end module test_crank_pin
