!> Friction laws with bristles, without a mechanism, by the program's integrators.
module test_bristles
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t
  use checks, only: checks_t
  use friction_law, only: friction_law_t
  use ode_method, only: ode_method_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, silent_observer_t, integration_done
  use laws, only: friction_law_of
  use shaken_bristles, only: shaken_t, new_shaken
  use data_tables, only: load_table
  implicit none
  private
  public :: run_test_bristles

  character(len=*), parameter :: shared = ' coefficient=0.10 static_coefficient=0.15 stribeck_speed=1e-3 bristle_stiffness=1e4 '// &
    'bristle_damping=0.3 viscous_coefficient=0.02'
  character(len=14), parameter :: names(4) = [character(len=14) :: 'lugre', 'lugre_damped', 'dahl', 'elasto_plastic']
  character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']

contains

  subroutine run_test_bristles(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: presliding(4) = [-6.02134e-8_dp, 0.0_dp, -8.328176e-8_dp, -1.0106e-9_dp]
    real(dp), parameter :: sliding(4) = [-4.000224e-4_dp, 0.0_dp, -3.96e-4_dp, -3.998848e-4_dp]
    call against_the_table(check, 'presliding', 4e-6_dp, presliding)
    call against_the_table(check, 'sliding', 1e-3_dp, sliding)
    call closed_form_of_dahl(check)
    call steady_sliding(check)
    call stiffness_in_stick(check)
    call slopes(check)
    call extremes(check)
  end subroutine run_test_bristles

  subroutine make(name, law)
    character(len=*), intent(in) :: name
    class(friction_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable :: error
    if (name == 'lugre_damped') then
      call friction_law_of("law='lugre' damping_speed=2e-3"//shared, law, error)
    else
      call friction_law_of("law='"//trim(name)//"'"//shared, law, error)
    end if
  end subroutine make

  subroutine prepare(method_name, law, span, method)
    character(len=*), intent(in) :: method_name
    class(friction_law_t), intent(in) :: law
    real(dp), intent(in) :: span
    class(ode_method_t), allocatable, intent(out) :: method
    type(error_t), allocatable :: error
    real(dp), parameter :: tolerance = 1e-12_dp
    call new_method(method_name, method, error)
    method%settings%relative = [tolerance, 0.0_dp]
    method%settings%absolute = tolerance*[law%state_scale, 0.15_dp*law%state_scale]
    method%settings%span = span
  end subroutine prepare

  !> Deflection, friction and work at every hundredth of the time, and the work of a closed cycle, which is negative.
  subroutine against_the_table(check, table_name, reach, cycle_work)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: table_name
    real(dp), intent(in) :: reach, cycle_work(:)
    class(friction_law_t), allocatable :: law
    class(ode_method_t), allocatable :: method
    type(silent_observer_t) :: observer
    type(shaken_t) :: problem
    character(len=40), allocatable :: labels(:)
    real(dp), allocatable :: table(:, :)
    real(dp) :: t, y(2), ratio, rates(1), off(3), work
    integer :: i, j, row, first, status
    call load_table('friction/'//table_name//'.csv', labels, table)
    call check%that(size(table, 2) == 101, 'the table has all rows: '//table_name)
    do i = 1, size(names)
      first = 4 + 3*(i - 1)   ! first column of the law
      call check%equal_text(trim(labels(first)), trim(names(i))//' z[m]', 'columns of the table')
      do j = 1, size(methods)
        call make(names(i), law)
        call new_shaken(law, reach, 10*two_pi, problem)
        call prepare(methods(j), law, 0.25_dp, method)
        t = 0
        y = 0
        off = 0
        work = 0
        do row = 1, size(table, 2)
          if (row > 1) call integrate(problem, method, t, y, table(1, row), 0, observer, status)
          call law%state_friction(problem%speed(t), y(1:1), ratio, rates)
          off = max(off, abs([y(1), ratio, y(2)] - table(first:first + 2, row)))
          if (row == 51) work = -y(2)
          if (row == 91) work = work + y(2)
        end do
        off = off/[law%state_scale, 0.15_dp, maxval(abs(table(first + 2, :)))]
        call check%close_to(maxval(off), 0.0_dp, 2e-8_dp, trim(table_name)//' of '//trim(names(i))//' by '//methods(j))
        call check%that(work < 0, 'work of a closed cycle is negative: '//names(i)//table_name)
        if (abs(cycle_work(i)) > 0) call check%relative(work, cycle_work(i), 1e-4_dp, &
          'work of a closed cycle is that of the table: '//names(i))
      end do
    end do
  end subroutine against_the_table

  !> Sliding in one direction from rest over x: z = (c_f/s_0) (1 - exp(-s_0 x/c_f)).
  subroutine closed_form_of_dahl(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    class(ode_method_t), allocatable :: method
    type(silent_observer_t) :: observer
    type(shaken_t) :: problem
    real(dp) :: t, y(2), want
    integer :: j, k, status
    do j = 1, size(methods)
      do k = -1, 1, 2
        call make('dahl', law)
        call new_shaken(law, 2e-3_dp*k, 0.0_dp, problem)
        call prepare(methods(j), law, 0.01_dp, method)
        t = 0
        y = 0
        call integrate(problem, method, t, y, 0.01_dp, 0, observer, status)
        want = 1e-5_dp*(1 - exp(-1e5_dp*2e-3_dp*t))*k
        call check%that(status == integration_done, 'Dahl''s bristles')
        call check%relative(y(1), want, 1e-10_dp, 'Dahl''s bristles in closed form by '//methods(j))
      end do
    end do
  end subroutine closed_form_of_dahl

  !> Bristles in equilibrium give the friction of steady sliding, -(g(v) sign(v) + s_2 v).
  subroutine steady_sliding(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    real(dp) :: v, g, ratio, rates(1), viscous
    integer :: i, j
    do i = 1, size(names)
      call make(names(i), law)
      do j = -6, 2
        v = sign(2.0_dp*10.0_dp**j, -1.0_dp)
        g = 0.10_dp
        viscous = 0
        if (names(i) /= 'dahl') then
          g = g + 0.05_dp*exp(-(v/1e-3_dp)**2)
          viscous = 0.02_dp*v
        end if
        call law%state_friction(v, [-g/1e4_dp], ratio, rates)
        call check%close_to(rates(1), 0.0_dp, 1e-13_dp*abs(v), 'equilibrium deflection of the bristles is g/s_0: '//names(i))
        call check%close_to(ratio, g - viscous, 1e-12_dp*(1 + abs(v)), 'friction of bristles in equilibrium: '//names(i))
        call check%close_to(law%friction_ratio(v, -1), g - viscous, 1e-15_dp*(1 + abs(v)), 'friction of steady sliding: '//names(i))
      end do
    end do
  end subroutine steady_sliding

  !> Sticking surfaces are springs of stiffness s_0 F_N with the damping s_1 F_N; elasto-plastic ones up to the break-away.
  subroutine stiffness_in_stick(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    real(dp) :: ratio, rates(1), z
    integer :: i
    do i = 1, size(names)
      call make(names(i), law)
      z = 1e-7_dp
      call law%state_friction(0.0_dp, [z], ratio, rates)
      call check%close_to(ratio, -1e4_dp*z, 1e-18_dp, 'a spring: '//names(i))
      call check%close_to(rates(1), 0.0_dp, 0.0_dp, 'bristles at rest have no rate: '//names(i))
      call law%state_friction(1e-9_dp, [0.0_dp], ratio, rates)
      call check%relative(rates(1), 1e-9_dp, 1e-12_dp, 'bristles follow the surfaces: '//names(i))
      if (names(i) /= 'dahl') call check%relative(ratio, -0.32e-9_dp, 1e-6_dp, &
        'bristles damp the motion of the surfaces: '//names(i))
    end do
    call make('elasto_plastic', law)
    call law%state_friction(1e-3_dp, [0.69e-5_dp], ratio, rates)
    call check%relative(rates(1), 1e-3_dp, 1e-15_dp, 'elasto-plastic bristles are elastic up to the break-away')
    call law%state_friction(1e-3_dp, [0.75e-5_dp], ratio, rates)
    call check%that(rates(1) < 1e-3_dp, 'elasto-plastic bristles slip beyond the break-away')
    call law%state_friction(-1e-3_dp, [0.75e-5_dp], ratio, rates)
    call check%relative(rates(1), -1e-3_dp, 1e-15_dp, 'elasto-plastic bristles are elastic while they unbend')
  end subroutine stiffness_in_stick

  !> Analytical derivatives against central differences.
  subroutine slopes(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    real(dp) :: v, z, found(2, 2), ahead(2), behind(2), wanted(2, 2), dv, dz
    integer :: i, j, k
    do i = 1, size(names)
      call make(names(i), law)
      do j = -5, 1
        do k = -9, 9
          v = 1.3_dp*10.0_dp**j
          z = 1.47e-6_dp*k
          dv = 1e-5_dp*v
          dz = 1e-11_dp
          call law%state_slopes(v, [z], found)
          call law%state_friction(v + dv, [z], ahead(1), ahead(2:))
          call law%state_friction(v - dv, [z], behind(1), behind(2:))
          wanted(:, 1) = (ahead - behind)/(2*dv)
          call law%state_friction(v, [z + dz], ahead(1), ahead(2:))
          call law%state_friction(v, [z - dz], behind(1), behind(2:))
          wanted(:, 2) = (ahead - behind)/(2*dz)
          call check%close_to(maxval(abs(found(:, 1) - wanted(:, 1))), 0.0_dp, 1e-5_dp*maxval(abs(wanted(:, 1))), &
            'derivative with respect to the sliding speed: '//names(i))
          call check%close_to(maxval(abs(found(:, 2) - wanted(:, 2))), 0.0_dp, 1e-5_dp*maxval(abs(wanted(:, 2))) + 1e-9_dp, &
            'derivative with respect to the deflection: '//names(i))
        end do
      end do
    end do
  end subroutine slopes

  !> At the ends of the ranges: the bristles stay within their bounds for any motion, and all values are finite.
  subroutine extremes(check)
    class(checks_t), intent(inout) :: check
    character(len=200), parameter :: keys(5) = [character(len=200) :: &
      "law='lugre' coefficient=1e-6 static_coefficient=2 stribeck_speed=1e-9 bristle_stiffness=1e9", &
      "law='lugre' coefficient=2 stribeck_speed=1e3 bristle_stiffness=1 bristle_damping=1e-3 damping_speed=1e-9", &
      "law='elasto_plastic' coefficient=0.1 stribeck_speed=1 bristle_stiffness=1e4 breakaway_ratio=0.999999999", &
      "law='elasto_plastic' coefficient=0.1 static_coefficient=0.2 stribeck_speed=1 bristle_stiffness=1e4 breakaway_ratio=0", &
      "law='dahl' coefficient=0.1 bristle_stiffness=1e9"]
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp) :: v, ratio, rates(1), found(2, 2), bound
    integer :: i, j, k
    do i = 1, size(keys)
      call friction_law_of(trim(keys(i)), law, error)
      call check%that(.not. allocated(error), 'bristles at the ends of the ranges')
      if (allocated(error)) cycle
      bound = law%state_scale
      do j = -30, 4
        v = 10.0_dp**j
        call law%state_friction(v, [bound], ratio, rates)
        call check%that(rates(1) <= 1e-15_dp*v, 'bristles at their bound do not bend further: '//trim(keys(i)))
        call law%state_friction(-v, [-bound], ratio, rates)
        call check%that(rates(1) >= -1e-15_dp*v, 'bristles at their lower bound do not bend further')
        do k = -2, 2
          call law%state_friction(v, [0.5_dp*k*bound], ratio, rates)
          call law%state_slopes(v, [0.5_dp*k*bound], found)
          call check%that(abs(ratio) < 1e9_dp .and. maxval(abs(found)) < 1e20_dp, 'friction and its derivatives are finite')
        end do
      end do
    end do
  end subroutine extremes
end module test_bristles
