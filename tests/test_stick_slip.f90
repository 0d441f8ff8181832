!> A mass pulled over a dry floor by a spring: stick-slip under every friction law, by the program's integrators.
module test_stick_slip
  use kinds, only: dp
  use checks, only: checks_t
  use error_handling, only: error_t
  use friction_law, only: friction_law_t
  use bristle_law, only: bristle_law_t
  use ode_method, only: ode_method_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, silent_observer_t, integration_done
  use laws, only: friction_law_of
  use belt_problem, only: belt_t, new_belt, mass, spring, draw_speed, load
  use data_tables, only: load_table
  implicit none
  private
  public :: run_test_stick_slip

  real(dp), parameter :: sliding = 0.10_dp, static = 0.15_dp   !! coefficients of friction
  character(len=*), parameter :: bristles = ' bristle_stiffness=1e4 stribeck_speed=1e-3'
  real(dp), parameter :: bristle_damping = sqrt(1e5_dp)/load   !! [s/m], with damping_speed 0; a case would be refused with it
  real(dp), parameter :: speed_scale = 0.467423461_dp          !! largest speed with Coulomb friction [m/s]

contains

  subroutine run_test_stick_slip(check)
    class(checks_t), intent(inout) :: check
    call coulomb_by_its_closed_form(check)
    call against_the_table(check, "law='coulomb'", 'coulomb', 'adams', 2e-9_dp)
    call against_the_table(check, "law='brown_mcphee' transition_speed=1e-3", 'brown_mcphee', 'radau', 1e-6_dp)
    call against_the_table(check, "law='brown_mcphee' transition_speed=1e-3", 'brown_mcphee', 'auto', 1e-6_dp)
    call against_the_table(check, "law='stribeck' stribeck_speed=1e-3 transition_speed=1e-4", &
      'stribeck_tanh', 'radau', 1e-6_dp)
    call against_the_table(check, "law='lugre'"//bristles, 'lugre', 'radau', 1e-6_dp)
    call against_the_table(check, "law='lugre'"//bristles, 'lugre', 'auto', 1e-6_dp)
    call against_the_table(check, "law='lugre'"//bristles, 'lugre', 'adams', 1e-6_dp)
    call against_the_table(check, "law='elasto_plastic'"//bristles, 'elasto_plastic', 'radau', 1e-6_dp)
  end subroutine run_test_stick_slip

  !> A belt under a law, at t = 0.
  subroutine prepare(keys, method_name, tolerance, belt, method)
    character(len=*), intent(in) :: keys, method_name
    real(dp), intent(in) :: tolerance
    type(belt_t), intent(out) :: belt
    class(ode_method_t), allocatable, intent(out) :: method
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    call friction_law_of(keys//' coefficient=0.10 static_coefficient=0.15 viscous_coefficient=0.04', law, error)
    select type (law)
    class is (bristle_law_t)
      law%bristle_damping = bristle_damping
    end select
    call new_belt(law, belt)
    call new_method(method_name, method, error)
    allocate (method%settings%relative(belt%n), method%settings%absolute(belt%n), source=tolerance)
    method%settings%relative(belt%n) = 0
    if (law%n_states > 0) method%settings%absolute(3) = tolerance*law%state_scale
    method%settings%span = 40
  end subroutine prepare

  !> With D = (mu_s - mu_d) N/k and w = sqrt(k/m), the first slip begins at mu_s N/(k V), a slip lasts (2/w) (pi - atan(w D/V)), and
  !> the mass then sticks for 2 D/V; a slip dissipates mu_d N times its length.
  subroutine coulomb_by_its_closed_form(check)
    class(checks_t), intent(inout) :: check
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    class(ode_method_t), allocatable :: method
    type(silent_observer_t) :: observer
    type(belt_t) :: belt
    real(dp) :: t, y(3), d, w, slip, stick, start
    integer :: status, i, k
    d = (static - sliding)*load/spring
    w = sqrt(spring/mass)
    slip = 2/w*(4*atan(1.0_dp) - atan(w*d/draw_speed))
    stick = 2*d/draw_speed
    call check%relative(slip, 2.6112592541_dp, 1e-10_dp, 'duration of a slip')
    do i = 1, size(methods)
      call prepare("law='coulomb'", trim(methods(i)), 1e-12_dp, belt, method)
      t = 0
      y = 0
      call integrate(belt, method, t, y, 40.0_dp, 0, observer, status)
      call check%that(status == integration_done, 'Coulomb friction on the belt by '//methods(i))
      call check%that(belt%n_changes == 9, 'four slips and the beginning of the fifth by '//methods(i))
      if (belt%n_changes /= 9) cycle
      do k = 0, 4
        start = static*load/(spring*draw_speed) + k*(slip + stick)
        call check%close_to(belt%change(2*k + 1), start, 1e-9_dp*start, 'time at which the mass slips by '//methods(i))
        if (k < 4) call check%close_to(belt%change(2*k + 2), start + slip, 1e-9_dp*start, &
          'time at which the mass sticks again by '//methods(i))
      end do
      call prepare("law='coulomb'", trim(methods(i)), 1e-12_dp, belt, method)
      t = 0
      y = 0
      call integrate(belt, method, t, y, 33.0_dp, 0, observer, status)
      call check%relative(y(1), 4*(draw_speed*slip + 2*d), 1e-9_dp, 'length of four slips by '//methods(i))
      call check%relative(y(3), -sliding*load*y(1), 1e-9_dp, 'dissipation of four slips by '//methods(i))
    end do
  end subroutine coulomb_by_its_closed_form

  !> States every tenth of a second up to 40 s: states that agree within 1e-6 have the same periods within 1e-6.
  subroutine against_the_table(check, keys, name, method_name, allowed)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: keys, name, method_name
    real(dp), intent(in) :: allowed
    class(ode_method_t), allocatable :: method
    type(silent_observer_t) :: observer
    type(belt_t) :: belt
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: table(:, :)
    real(dp) :: t, far, fast, work
    real(dp), allocatable :: y(:)
    integer :: status, row
    call load_table('friction/belt.csv', names, table)
    call prepare(keys, method_name, 1e-11_dp, belt, method)
    t = 0
    allocate (y(belt%n), source=0.0_dp)
    far = 0
    fast = 0
    work = 0
    do row = 2, size(table, 2)
      call integrate(belt, method, t, y, table(1, row), 0, observer, status)
      if (status /= integration_done) exit
      far = max(far, abs(y(1) - table(at(' x[m]'), row)))
      fast = max(fast, abs(y(2) - table(at(' v[m/s]'), row)))
      if (at(' friction work[J]') > 0) work = max(work, abs(y(belt%n) - table(at(' friction work[J]'), row)))
    end do
    call check%that(status == integration_done .and. row == 402, name//' on the belt by '//method_name)
    call check%close_to(far, 0.0_dp, allowed*maxval(table(at(' x[m]'), :)), 'position of the mass: '//name//' by '//method_name)
    call check%close_to(fast, 0.0_dp, allowed*speed_scale, 'speed of the mass: '//name//' by '//method_name)
    call check%close_to(work, 0.0_dp, allowed*4, 'work of friction: '//name//' by '//method_name)

  contains

    !> Column of the law in the table.
    integer function at(quantity)
      character(len=*), intent(in) :: quantity
      integer :: i
      at = 0
      do i = 1, size(names)
        if (names(i) == name//quantity) at = i
      end do
    end function at
  end subroutine against_the_table
end module test_stick_slip
