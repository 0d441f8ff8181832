!> What a scene costs: nanoseconds a right-hand side, an accepted step and a row of the trace, for scenes that grow by one
!> model at a time. Run by scripts/measure_costs.
!>
!>     measure_costs                       a CSV table of all, each against a sine and cosine of the same angles
!>     measure_costs NAME WHAT COUNT       does WHAT (rhs, step, row, pair) COUNT times: for counting instructions
program measure_costs
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use constants, only: pi
  use errors, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use adams, only: adams_t
  use ode_method, only: step_statistics_t
  use solver, only: integrate, silent_observer_t
  use scene, only: scene_t, evaluation_t, phase_contact
  use clearance_scene, only: clearance_scene_t
  use scene_builder, only: build_scene, settings_for
  implicit none

  integer, parameter :: n_states = 64, blocks = 41, calls = 20000
  integer, parameter :: n_scenes = 14
  character(len=24), parameter :: names(n_scenes) = [character(len=24) :: 'ideal', 'ideal+gas', 'free', 'free+gas', &
    'hertz', 'contact', 'contact+ambrosio', 'contact+coulomb', 'closed_form', 'closed_form+gas', 'as_printed', 'half_film', &
    'oscillating', 'oscillating_as_printed']
  character(len=24) :: name, what, count_text
  integer :: i, count

  if (command_argument_count() == 3) then
    call get_command_argument(1, name)
    call get_command_argument(2, what)
    call get_command_argument(3, count_text)
    read (count_text, *) count
    call do_once(trim(name), trim(what), count)
  else
    print '(a)', 'scene,quantity,ns,pairs'
    do i = 1, n_scenes
      call measure(trim(names(i)))
    end do
  end if

contains

  !> The scene of a name, from simulation I with what it needs and nothing else.
  subroutine make(name, case, scene)
    character(len=*), intent(in) :: name
    type(case_t), intent(out) :: case
    class(scene_t), allocatable, intent(out) :: scene
    type(error_t), allocatable :: error
    character(len=1) :: nothing(0)

    call read_case('cases/sim_IV.nml', nothing, case, error)
    if (allocated(error)) error stop 'cases/sim_IV.nml cannot be read'
    case%integrator%relative_tolerance = 1e-6_dp
    case%combustion%is_present = index(name, '+gas') > 0
    case%contact%is_present = .not. (index(name, 'ideal') == 1 .or. index(name, 'free') == 1)
    case%lubrication%is_present = .false.
    case%friction%is_present = .false.
    case%joint%kind = 'clearance'
    select case (name)
    case ('ideal', 'ideal+gas')
      case%joint%kind = 'ideal'
    case ('free', 'free+gas')
    case ('hertz')
      case%contact%law = 'hertz'
    case ('contact')
    case ('contact+ambrosio', 'contact+coulomb')
      case%friction%is_present = .true.
      case%friction%law = name(9:)
    case default
      case%lubrication%is_present = .true.
      case%lubrication%variant = name
      if (index(name, '+') > 0) case%lubrication%variant = name(:index(name, '+') - 1)
      if (index(name, 'oscillating') == 1) then
        case%lubrication%law = 'oscillating_film'
        case%lubrication%variant = 'bearing_frame'
        case%lubrication%kinematic_viscosity = 1.38e-5_dp
        if (index(name, 'as_printed') > 0) case%lubrication%variant = 'as_printed'
      end if
    end select
    call build_scene(case, .false., scene, error)
    if (allocated(error)) error stop 'a scene cannot be built'
    if (allocated(scene%gas)) call scene%set_gas_part(1.5_dp*pi, 250.0_dp)
    select type (scene)
    class is (clearance_scene_t)
      if (index(name, 'contact') == 1 .or. name == 'hertz') then
        scene%phase = phase_contact
        scene%impact_speed = 0.1_dp
        scene%sliding = 1
      end if
    end select
  end subroutine make

  !> States along one compression stroke, the pin in the film, or touching where the scene does.
  subroutine make_states(scene, y)
    class(scene_t), intent(in) :: scene
    real(dp), allocatable, intent(out) :: y(:, :)
    real(dp) :: part, turn, reach
    integer :: i, n

    n = scene%n
    allocate (y(n, n_states), source=0.0_dp)
    do i = 1, n_states
      part = (i - 0.5_dp)/n_states
      y(1, i) = pi*(1.05_dp + 0.8_dp*part)
      y(n/2 + 1, i) = 250
      if (n < 7) cycle
      turn = 40*part
      reach = 20e-6_dp*(0.1_dp + 0.8_dp*part)
      if (scene%phase == phase_contact) reach = 20e-6_dp + 1e-6_dp*part
      y(2:3, i) = reach*[cos(turn), sin(turn)]
      y(5:6, i) = 2e-3_dp*[cos(3*turn), sin(5*turn)]
    end do
  end subroutine make_states

  !> All that is measured of one scene: medians over blocks that alternate with blocks of the pair.
  subroutine measure(name)
    character(len=*), intent(in) :: name
    type(case_t) :: case
    class(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:, :)
    real(dp) :: rhs(blocks), pair(blocks), step(blocks), a_pair
    integer :: i, evaluations, steps

    call make(name, case, scene)
    call make_states(scene, y)
    do i = 1, blocks
      pair(i) = time_of_pairs(y(1, :), calls)
      rhs(i) = time_of_evaluations(scene, y, calls)
    end do
    a_pair = minval(pair)
    print '(a,2(",",a,",",f0.1,",",f0.2))', name, 'rhs', minval(rhs), minval(rhs)/a_pair
    if (scene%phase == phase_contact) return
    do i = 1, blocks
      step(i) = time_of_steps(case, scene, 300, evaluations, steps)
    end do
    print '(a,(",",a,",",f0.1,",",f0.2),2(a,f0.2))', name, 'step', minval(step), minval(step)/a_pair, ',evals/step', &
      real(evaluations, dp)/steps, ',overhead/rhs', (minval(step) - minval(rhs)*evaluations/steps)/minval(rhs)
  end subroutine measure

  real(dp) function time_of_pairs(angles, count) result(ns)
    real(dp), intent(in) :: angles(:)
    integer, intent(in) :: count
    integer(int64) :: before, after, rate
    real(dp) :: total
    integer :: i, j
    call system_clock(before, rate)
    total = 0
    do i = 1, count/n_states
      do j = 1, n_states
        total = total + sine_and_cosine(angles(j))
      end do
    end do
    call system_clock(after)
    ns = 1e9_dp*real(after - before, dp)/rate/(count/n_states*n_states)
    if (total > huge(total)) print *, total
  end function time_of_pairs

  real(dp) function sine_and_cosine(x)
    real(dp), intent(in) :: x
    sine_and_cosine = sin(x) + cos(x)
  end function sine_and_cosine

  real(dp) function time_of_evaluations(scene, y, count) result(ns)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:, :)
    integer, intent(in) :: count
    integer(int64) :: before, after, rate
    real(dp) :: f(size(y, 1)), total
    logical :: inside
    integer :: i, j
    call system_clock(before, rate)
    total = 0
    do i = 1, count/n_states
      do j = 1, n_states
        call scene%derivatives(0.0_dp, y(:, j), f, inside)
        total = total + f(2)
      end do
    end do
    call system_clock(after)
    ns = 1e9_dp*real(after - before, dp)/rate/(count/n_states*n_states)
    if (total > huge(total) .or. .not. inside) print *, total, inside
  end function time_of_evaluations

  real(dp) function time_of_steps(case, template, count, evaluations, steps) result(ns)
    type(case_t), intent(in) :: case
    class(scene_t), intent(in) :: template
    integer, intent(in) :: count
    integer, intent(out) :: evaluations, steps
    class(scene_t), allocatable :: scene
    type(adams_t) :: method
    type(silent_observer_t) :: nobody
    integer(int64) :: before, after, rate
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: status
    allocate (scene, source=template)
    if (allocated(scene%gas)) call scene%set_gas_part(scene%start_angle, scene%start_speed)
    method%settings = settings_for(case, scene)
    allocate (y(scene%n), source=scene%initial_state())
    t = 0
    call system_clock(before, rate)
    call integrate(scene, method, t, y, 10.0_dp, count, nobody, status)
    call system_clock(after)
    steps = method%statistics%accepted
    evaluations = method%statistics%evaluations
    ns = 1e9_dp*real(after - before, dp)/rate/steps
  end function time_of_steps

  subroutine do_once(name, what, count)
    character(len=*), intent(in) :: name, what
    integer, intent(in) :: count
    type(case_t) :: case
    class(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:, :)
    real(dp) :: ns
    integer :: evaluations, steps
    call make(name, case, scene)
    call make_states(scene, y)
    select case (what)
    case ('pair')
      ns = time_of_pairs(y(1, :), count)
    case ('rhs')
      ns = time_of_evaluations(scene, y, count)
    case ('step')
      ns = time_of_steps(case, scene, count, evaluations, steps)
      print '(i0,1x,i0)', steps, evaluations
    end select
  end subroutine do_once

  real(dp) function median(values)
    real(dp), intent(in) :: values(:)
    real(dp) :: sorted(size(values)), held
    integer :: i, j
    sorted = values
    do i = 2, size(sorted)
      held = sorted(i)
      j = i - 1
      do while (j >= 1)
        if (sorted(j) <= held) exit
        sorted(j + 1) = sorted(j)
        j = j - 1
      end do
      sorted(j + 1) = held
    end do
    median = sorted((size(sorted) + 1)/2)
  end function median
end program measure_costs
