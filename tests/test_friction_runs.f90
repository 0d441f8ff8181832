!> Friction laws in the whole mechanism.
module test_friction_runs
  use gudgeon_kinds, only: dp
  use checks, only: checks_t
  use gudgeon_errors, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use ode_problem, only: difference_jacobian
  use gudgeon_scene, only: scene_t, phase_contact
  use scene_builder, only: build_scene
  use collecting_sink, only: trace_t, run_case, column
  use state_making, only: put_crank, put_pin
  implicit none
  private
  public :: run_test_friction_runs

  integer, parameter :: long = 120
  character(len=*), parameter :: coulomb_static = 'cases/friction/coulomb_static.nml'

contains

  subroutine run_test_friction_runs(check)
    class(checks_t), intent(inout) :: check
    call surfaces_stick_above_the_sliding_friction(check)
    call coulomb_is_the_limit_of_smooth_curves(check)
    call closed_jacobian(check)
  end subroutine run_test_friction_runs

  !> While the surfaces slide, the friction is that of sliding; while they stick it may be larger, up to that of rest.
  subroutine surfaces_stick_above_the_sliding_friction(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), parameter :: at_rest = 1e-6_dp   !! [m/s]
    integer :: i, above
    trace = run_case(coulomb_static, [character(len=long) :: 'integrator.relative_tolerance=1e-9', &
      'output.samples_per_revolution=5000'])
    above = 0
    associate (normal => trace%values(column(trace, 'normal_force[N]'), :), &
               friction => trace%values(column(trace, 'friction_force[N]'), :), &
               v => trace%values(column(trace, 'sliding_speed[m/s]'), :))
      do i = 1, size(v)
        if (.not. normal(i) > 0) cycle
        if (abs(v(i)) > at_rest) then
          call check%close_to(friction(i), -sign(0.10_dp*normal(i), v(i)), 1e-12_dp*normal(i), 'friction of surfaces that slide')
        else
          call check%that(abs(friction(i)) < 0.15_dp*(1 + 1e-6_dp)*normal(i), 'friction of surfaces that stick')
          if (abs(friction(i)) > 0.101_dp*normal(i)) above = above + 1
        end if
      end do
    end associate
    call check%that(above > 10, 'surfaces stick by more than the friction of sliding')
    associate (f => trace%report%figures)
      call check%close_to(f%max_energy_residual/f%max_energy, 0.0_dp, 1e-7_dp, 'energy with static friction')
    end associate
  end subroutine surfaces_stick_above_the_sliding_friction

  !> Stribeck's curve, steeper and steeper: the contacts come to those of Coulomb's law with static friction.
  subroutine coulomb_is_the_limit_of_smooth_curves(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: coulomb, smooth
    real(dp) :: error(3)
    integer :: i, n
    character(len=long), parameter :: speeds(3) = [character(len=long) :: 'friction.stribeck_speed=1e-2', &
      'friction.stribeck_speed=1e-3', 'friction.stribeck_speed=1e-4']
    character(len=long), parameter :: slopes(3) = [character(len=long) :: 'friction.transition_speed=1e-3', &
      'friction.transition_speed=1e-4', 'friction.transition_speed=1e-5']
    coulomb = run_case(coulomb_static, [character(len=long) :: 'integrator.relative_tolerance=1e-10', 'integrator.revolutions=0.7'])
    do i = 1, 3
      smooth = run_case(coulomb_static, [character(len=long) :: 'integrator.relative_tolerance=1e-10', &
        'integrator.revolutions=0.7', 'integrator.method=auto', 'friction.law=stribeck', speeds(i), slopes(i)])
      n = min(size(smooth%event), size(coulomb%event), 14)
      call check%that(n == 14, 'there are contacts')
      error(i) = maxval(abs(smooth%event(:n)%time - coulomb%event(:n)%time))
    end do
    call check%that(error(2) < 0.3_dp*error(1) .and. error(3) < 0.3_dp*error(2), 'Stribeck''s curve converges to static friction')
  end subroutine coulomb_is_the_limit_of_smooth_curves

  !> The closed form of the Jacobian against differences, for every law, crank held and free.
  subroutine closed_jacobian(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: laws(3) = [character(len=long) :: 'friction.law=threlfall', 'friction.law=brown_mcphee', &
      'friction.law=stribeck']
    character(len=long), parameter :: drives(2) = [character(len=long) :: 'drive.kind=constant_speed', 'drive.kind=free']
    integer :: i, j
    do i = 1, size(laws)
      do j = 1, size(drives)
        call compare_jacobians(check, [character(len=long) :: laws(i), drives(j), 'friction.v1=0.5', &
          'friction.transition_speed=0.3', 'friction.stribeck_speed=0.4', 'friction.viscous_coefficient=0.01'])
      end do
    end do
  end subroutine closed_jacobian

  subroutine compare_jacobians(check, overrides)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: overrides(:)
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), d_p(:, :), d_v(:, :)
    integer :: i, m, k
    call read_case(coulomb_static, overrides, case, error)
    call check%that(.not. allocated(error), 'the case of '//overrides(1))
    if (allocated(error)) return
    call build_scene(case, .false., scene, error)
    m = scene%n_positions
    k = m + scene%n_states()
    allocate (a_p(k, m), a_v(k, k), d_p(k, m), d_v(k, k))
    do i = 1, 4
      y = scene%initial_state()
      call put_crank(scene, y, 0.3_dp*i, 520.0_dp)
      call put_pin(scene, y, 1.03_dp*case%joint%clearance*[cos(1.3_dp*i), sin(1.3_dp*i)], &
        [0.4_dp*cos(2.1_dp*i), 2*sin(1.7_dp*i)])
      scene%joints(1)%phase = phase_contact
      scene%joints(1)%impact_speed = 1
      scene%joints(1)%sliding = 1
      call scene%jacobian(1e-3_dp*i, y, a_p, a_v)
      call difference_jacobian(scene, 1e-3_dp*i, y, d_p, d_v)
      call check%close_to(maxval(abs(a_p - d_p)), 0.0_dp, 1e-5_dp*maxval(abs(d_p)), 'slopes by positions: '//overrides(1))
      call check%close_to(maxval(abs(a_v - d_v)), 0.0_dp, 1e-5_dp*maxval(abs(d_v)), 'slopes by rates: '//overrides(1))
    end do
  end subroutine compare_jacobians
end module test_friction_runs
