!> Scenes with clearance at both pins, built without case files.
module test_two_joints
  use kinds, only: dp
  use checks, only: checks_t
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use chain_motion, only: crank_pin, piston_pin
  use chain_loads, only: bearing_moment
  use clearance_joint, only: clearance_joint_t
  use state_layout, only: layout_t
  use chain_reactions, only: reactions_t
  use scene_problem, only: scene_t, evaluation_t, phase_contact
  use state_making, only: set_contact
  use ode_method, only: ode_method_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, integration_done
  use scene_builder, only: build_scene, settings_for
  use joint_watcher, only: joint_watcher_t
  implicit none
  private
  public :: run_test_two_joints

  integer, parameter :: long = 60

contains

  subroutine run_test_two_joints(check)
    class(checks_t), intent(inout) :: check
    call energy_of_two_dry_joints(check)
    call reactions_are_the_laws_forces(check)
    call methods_agree(check)
    call both_surfaces_stick(check)
    call both_touch_at_once(check)
    call one_of_each_at_either_pin(check)
  end subroutine run_test_two_joints

  !> The scene of a case with its joint at the given pins, with the same bearing and laws at each.
  subroutine make(file, overrides, places, case, scene)
    character(len=*), intent(in) :: file, overrides(:)
    integer, intent(in) :: places(:)
    type(case_t), intent(out) :: case
    type(scene_t), allocatable, intent(out) :: scene
    type(error_t), allocatable :: error
    type(clearance_joint_t), allocatable :: joints(:)
    integer :: i

    call read_case(file, overrides, case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) error stop 'test_two_joints: a case cannot be built'
    allocate (joints(size(places)))
    scene%chain%is_loose = .false.
    do i = 1, size(places)
      joints(i) = scene%joints(1)
      call joints(i)%set_place(places(i))
      scene%chain%is_loose(places(i)) = .true.
    end do
    call move_alloc(joints, scene%joints)
    scene%n_joints = size(places)
    scene%layout = layout_t()
    call scene%claim()
    call scene%prepare_start()
  end subroutine make

  !> Integrate to t_end.
  subroutine run(case, scene, method_name, t_end, y, watcher, status)
    type(case_t), intent(in) :: case
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: method_name
    real(dp), intent(in) :: t_end
    real(dp), intent(out) :: y(:)
    type(joint_watcher_t), intent(out) :: watcher
    integer, intent(out) :: status
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    real(dp) :: t
    call new_method(method_name, method, error)
    method%settings = settings_for(case, scene)
    y = scene%initial_state()
    t = 0
    call integrate(scene, method, t, y, t_end, 1000000, watcher, status)
  end subroutine run

  !> Energy minus its initial value minus the work of the forces, divided by the energy.
  real(dp) function energy_residual(scene, t, y)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now, start
    logical :: in_domain
    call scene%evaluate(0.0_dp, scene%initial_state(), start, in_domain)
    call scene%evaluate(t, y, now, in_domain)
    energy_residual = (scene%chain%energy(now%motion) - scene%chain%energy(start%motion) - scene%work(y)) &
      /scene%chain%energy(start%motion)
  end function energy_residual

  !> Flores's mechanism with a free crank, friction and losses at both pins, over one revolution.
  subroutine energy_of_two_dry_joints(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(joint_watcher_t) :: watcher
    real(dp), allocatable :: y(:)
    integer :: status
    call make('cases/flores/friction_050.nml', [character(len=long) :: 'drive.kind=free', &
      'integrator.relative_tolerance=1e-11', 'mechanism.gravity=9.81', 'mechanism.rod_com=0.05,0.004', &
      'mechanism.crank_com=0.01,-0.006'], [piston_pin, crank_pin], case, scene)
    allocate (y(scene%n))
    call run(case, scene, 'adams', 0.012_dp, y, watcher, status)
    call check%that(status == integration_done, 'a run with two dry joints')
    call check%that(watcher%begun(1) > 4 .and. watcher%begun(2) > 4, 'both pins have contacts')
    call check%that(all(abs(watcher%begun - watcher%ended) <= 1), 'contacts begin and end alternately')
    call check%that(scene%work(y) < -0.1_dp, 'two dry joints dissipate energy')
    call check%close_to(energy_residual(scene, 0.012_dp, y), 0.0_dp, 1e-11_dp, 'energy residual of two dry joints')
  end subroutine energy_of_two_dry_joints

  !> At the end of a run with two joints, the forces at the pins from the bodies' accelerations are those of the laws.
  subroutine reactions_are_the_laws_forces(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(evaluation_t) :: now
    type(reactions_t) :: r
    real(dp), allocatable :: y(:)
    logical :: in_domain
    integer :: i
    call make('cases/flores/friction_050.nml', [character(len=long) :: 'mechanism.gravity=9.81'], [piston_pin, crank_pin], &
      case, scene)
    y = scene%initial_state()
    do i = 1, 2
      scene%joints(i)%phase = phase_contact
      scene%joints(i)%impact_speed = 0.5_dp
      associate (at => scene%joints(i)%at)
        y(at%position:at%position + 1) = 1.01_dp*case%joints(piston_pin)%clearance*[cos(1.9_dp*i), sin(1.9_dp*i)]
        y(at%rate:at%rate + 1) = [0.2_dp, -0.3_dp]*i
      end associate
    end do
    call scene%evaluate(1e-3_dp, y, now, in_domain)
    call check%that(in_domain .and. now%joint(1)%normal_force > 10 .and. now%joint(2)%normal_force > 10, &
      'both pins have a normal force')
    r = scene%chain%reactions(now%motion, now%accelerations, now%loads)
    call check%close_to(maxval(abs(r%pin + now%joint(1)%contact))/norm2(r%pin), 0.0_dp, 1e-10_dp, 'F5, F6 with two joints')
    call check%close_to(maxval(abs(r%crankpin + now%joint(2)%contact))/norm2(r%crankpin), 0.0_dp, 1e-10_dp, &
      'F3, F4 with two joints')
    associate (j => now%joint(2))
      call check%relative(j%power, dot_product(j%contact, j%eccentricity_rate) + j%moment*now%motion%crank_speed &
        - bearing_moment(j%eccentricity, j%contact, j%moment)*now%motion%rod_speed, 1e-14_dp, 'power of the crank pin')
      call check%relative(j%power, j%friction_force*j%sliding_speed - j%normal_force*j%penetration_rate, 1e-12_dp, &
        'power of friction and contact at the crank pin')
    end associate
  end subroutine reactions_are_the_laws_forces

  !> Adams, and Radau, whose Jacobian is computed by finite differences here.
  subroutine methods_agree(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(joint_watcher_t) :: watcher
    real(dp), allocatable :: one(:), other(:), automatic(:)
    real(dp), parameter :: t_end = 2e-3_dp
    integer :: status(3)
    call make('cases/flores/friction_050.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-10'], &
      [piston_pin, crank_pin], case, scene)
    allocate (one(scene%n), other(scene%n), automatic(scene%n))
    call run(case, scene, 'adams', t_end, one, watcher, status(1))
    call check%that(minval(watcher%begun(:2)) > 0, 'both pins have contacts')
    call make('cases/flores/friction_050.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-10'], &
      [piston_pin, crank_pin], case, scene)
    call run(case, scene, 'radau', t_end, other, watcher, status(2))
    call make('cases/flores/friction_050.nml', [character(len=long) :: 'integrator.relative_tolerance=1e-10'], &
      [piston_pin, crank_pin], case, scene)
    call run(case, scene, 'auto', t_end, automatic, watcher, status(3))
    call check%that(all(status == integration_done), 'two joints with Adams, Radau and auto')
    call check%close_to(maxval(abs(one(:4) - other(:4)))/case%joints(piston_pin)%clearance, 0.0_dp, 1e-4_dp, &
      'eccentricities, Radau and Adams')
    call check%close_to(maxval(abs(one(:4) - automatic(:4)))/case%joints(piston_pin)%clearance, 0.0_dp, 1e-4_dp, &
      'eccentricities, auto and Adams')
  end subroutine methods_agree

  !> If set-valued friction holds both pins, neither sliding speed changes along the motion; with free crank and constant speed.
  subroutine both_surfaces_stick(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(evaluation_t) :: now, ahead, behind
    real(dp), allocatable :: y(:), f(:)
    real(dp), parameter :: dt = 1e-9_dp
    real(dp) :: worst
    logical :: in_domain
    integer :: i, k
    character(len=long) :: overrides(4)
    do k = 1, 2
      overrides = [character(len=long) :: 'friction.law=coulomb', 'friction.v0=0', 'friction.v1=0', 'drive.kind=constant_speed']
      if (k == 2) overrides(4) = 'drive.kind=free'
      call make('cases/flores/friction_100.nml', overrides, [piston_pin, crank_pin], case, scene)
      y = scene%initial_state()
      allocate (f(scene%n))
      do i = 1, 2
        call set_contact(scene%joints(i), 1.0_dp, 0)
        associate (at => scene%joints(i)%at)
          y(at%position:at%position + 1) = 1.02_dp*case%joints(piston_pin)%clearance*[cos(1.3_dp*i), sin(1.3_dp*i)]
          y(at%rate:at%rate + 1) = [0.4_dp*cos(2.1_dp*i), 0.3_dp*sin(1.7_dp*i)]
        end associate
      end do
      call scene%derivatives(1e-3_dp, y, f, in_domain)
      call scene%evaluate(1e-3_dp, y, now, in_domain)
      call scene%evaluate(1e-3_dp + dt, y + dt*f, ahead, in_domain)
      call scene%evaluate(1e-3_dp - dt, y - dt*f, behind, in_domain)
      worst = maxval(abs(ahead%joint(:2)%sliding_speed - behind%joint(:2)%sliding_speed))/(2*dt)
      call check%that(minval(abs(now%joint(:2)%friction_force)) > 1, 'both sticking pins have friction forces')
      call check%close_to(worst, 0.0_dp, 1e-2_dp, 'both pins stick: change of the sliding speeds [m/s2]')
      call check%relative(f(scene%work_at), now%power, 1e-14_dp, 'the power is that of the evaluation')
      call check%relative(now%power, sum(now%joint(:2)%power) + now%crank_moment*now%motion%crank_speed, 1e-12_dp, &
        'power of sticking pins and of the drive')
      deallocate (f)
    end do
  end subroutine both_surfaces_stick

  !> The crank is at rest along the cylinder and the rod moves along it: both pins reach their walls at the same time, and neither
  !> contact nor its end is lost.
  subroutine both_touch_at_once(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(joint_watcher_t) :: watcher
    real(dp), allocatable :: y(:)
    character(len=6), parameter :: methods(3) = [character(len=6) :: 'adams', 'radau', 'auto']
    integer :: i, status
    do i = 1, size(methods)
      call make('cases/flores/dry_0100um.nml', [character(len=long) :: 'initial.crank_speed=0', 'drive.kind=free', &
        'contact.law=hertz', 'initial.eccentricity_rate=0.5,0', 'integrator.revolutions=0', 'integrator.end_time=4e-4', &
        'integrator.relative_tolerance=1e-10', 'output.interval=1e-5'], [piston_pin, crank_pin], case, scene)
      scene%joints(2)%start_rate = [-0.5_dp, 0.0_dp]
      allocate (y(scene%n))
      call run(case, scene, trim(methods(i)), 4e-4_dp, y, watcher, status)
      call check%that(status == integration_done, 'contacts at both pins at once: '//methods(i))
      call check%that(all(watcher%begun(:2) >= 1), 'both contacts are found')
      call check%that(all(watcher%begun == watcher%ended), 'the ends of both contacts are found')
      call check%close_to(watcher%first_begin(1), watcher%first_begin(2), 1e-14_dp, 'both contacts begin at the same time [s]')
      call check%relative(watcher%first_begin(1), case%joints(piston_pin)%clearance/0.5_dp, 1e-9_dp, 'time of both contacts')
      call check%close_to(energy_residual(scene, 4e-4_dp, y), 0.0_dp, 1e-8_dp, 'contacts at both pins at once: energy residual')
      deallocate (y)
    end do
  end subroutine both_touch_at_once

  !> Clearance at either pin with the other pin ideal: energy, and the force of the ideal pin, which must agree with the motion of
  !> the bodies.
  subroutine one_of_each_at_either_pin(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(joint_watcher_t) :: watcher
    real(dp), allocatable :: y(:)
    integer :: status
    call make('cases/flores/friction_050.nml', [character(len=long) :: 'drive.kind=free', &
      'integrator.relative_tolerance=1e-11', 'mechanism.rod_com=0.05,0.004'], [crank_pin], case, scene)
    allocate (y(scene%n))
    call run(case, scene, 'adams', 0.012_dp, y, watcher, status)
    call check%that(status == integration_done .and. watcher%begun(1) > 4, 'clearance at the crank pin only')
    call check%close_to(energy_residual(scene, 0.012_dp, y), 0.0_dp, 1e-11_dp, 'clearance at the crank pin only: energy residual')
  end subroutine one_of_each_at_either_pin
end module test_two_joints
