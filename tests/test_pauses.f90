!> A run that pauses has the rows, events and steps of one that does not, bit for bit, wherever it pauses; the values at a pause are
!> those of a row; a run that is copied goes on in the same way; and a step can be ended at a pause.
module test_pauses
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t
  use ode_methods, only: new_method
  use ode_solver, only: integration_t, silent_observer_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use trace_columns, only: column_list_t, choose_columns
  use simulation, only: simulate, run_t, run_report_t
  use row_store, only: row_store_t
  use trace_sink, only: trace_event_t
  use checks, only: checks_t
  use joint_places, only: piston_pin
  implicit none
  private
  public :: run_test_pauses

  integer, parameter :: long = 60, pauses = 300

  !> p'' = -stiffness p, y = (p, p').
  type, extends(ode_problem_t) :: spring_t
    real(dp) :: stiffness = 1
  contains
    procedure :: derivatives
  end type spring_t

  !> A run in memory.
  type :: trace_t
    real(dp), allocatable :: values(:, :)           !! (columns, rows)
    type(trace_event_t), allocatable :: event(:)
    type(run_report_t) :: report
  end type trace_t

contains

  subroutine run_test_pauses(check)
    class(checks_t), intent(inout) :: check
    call shipped_cases(check)
    call copies(check)
    call values_at_pauses(check)
    call cuts(check)
  end subroutine run_test_pauses

  !> Every shipped case, up to a limit of steps that a few of them reach before their end, at random times and numbers of steps.
  subroutine shipped_cases(check)
    class(checks_t), intent(inout) :: check
    character(len=100) :: file
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(trace_t) :: whole, parts
    integer :: unit, status, cases
    call execute_command_line('find cases -name "*.nml" -not -path "cases/studies/*" | sort > build/cases.txt')
    open (newunit=unit, file='build/cases.txt', status='old', action='read')
    cases = 0
    do
      read (unit, '(a)', iostat=status) file
      if (status /= 0) exit
      call read_case(trim(file), [character(len=long) :: 'integrator.max_steps=600'], case, error)
      if (.not. allocated(error)) call shorten(case)
      if (allocated(error)) exit
      call go(case, 0, whole)
      call go(case, pauses, parts)
      call check%that(are_equal(whole, parts), trim(file)//': 300 pauses change nothing')
      cases = cases + 1
    end do
    close (unit, status='delete')
    call check%that(cases > 60 .and. .not. allocated(error), 'all shipped cases are run')
  end subroutine shipped_cases

  !> Make the tables of films small, and let a run that does not reach its period have rows.
  subroutine shorten(case)
    type(case_t), intent(inout) :: case
    type(error_t), allocatable :: error
    type(case_t) :: small
    case%output%window = 'all'
    if (.not. allocated(case%joints(piston_pin)%film)) return
    if (case%joints(piston_pin)%film%name /= 'finite_bearing') return
    call read_case(case%file, [character(len=long) :: 'integrator.max_steps=600', 'lubrication.table_points=17', &
      'lubrication.film_points=32'], small, error)
    case = small
  end subroutine shorten

  !> Run a case with a number of pauses: at times of Lehmer's random numbers, each followed by a random number of steps up to 20.
  subroutine go(case, n, trace)
    type(case_t), intent(in) :: case
    integer, intent(in) :: n
    type(trace_t), intent(out) :: trace
    type(column_list_t) :: list
    type(row_store_t) :: sink
    type(run_t) :: run
    type(error_t), allocatable :: error
    integer :: i
    integer(int64) :: seed
    seed = 1
    call choose_columns(case, .false., list, error)
    call run%begin(case, .false., list, sink, error)
    if (allocated(error)) return
    do i = 1, n
      seed = mod(48271*seed, 2147483647_int64)
      call run%advance(run%t + (run%expected_end() - run%t)*(real(seed, dp)/2147483647.0_dp)**2/(0.02_dp*n), 0)
      call run%advance(huge(1.0_dp), int(mod(seed, 20_int64)))
    end do
    call run%advance(huge(1.0_dp), 0)
    call run%finish(trace%report, error)
    call sink%hand_over(size(list%id), trace%values, trace%event)
  end subroutine go

  logical function are_equal(one, other)
    type(trace_t), intent(in) :: one, other
    are_equal = all(shape(one%values) == shape(other%values)) .and. size(one%event) == size(other%event) .and. &
      one%report%status == other%report%status .and. one%report%statistics%evaluations == other%report%statistics%evaluations
    if (.not. are_equal) return
    are_equal = size(one%values) > 0 .and. all(transfer(one%values, [0_int64]) == transfer(other%values, [0_int64])) .and. &
      all(transfer(one%event%time, [0_int64]) == transfer(other%event%time, [0_int64]))
  end function are_equal

  !> A copy goes on like the run itself, also when the run has gone on before it.
  subroutine copies(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: files(5) = [character(len=long) :: 'cases/sim_II.nml', 'cases/flores/friction_100.nml', &
      'cases/gas/compressor.nml', 'cases/joints/piston_slap.nml', 'data/gas/air_reeds.nml']
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    type(case_t) :: case
    type(column_list_t) :: list
    type(row_store_t), target :: sink, other_sink
    type(run_t) :: run, other
    type(run_report_t) :: report
    type(error_t), allocatable :: error
    type(trace_t) :: one, two
    integer :: i, j
    do i = 1, size(files)
      do j = 1, size(methods)
        call read_case(trim(files(i)), [character(len=long) :: 'integrator.max_steps=800', 'integrator.method='//methods(j)], &
          case, error)
        call choose_columns(case, .false., list, error)
        sink = row_store_t()
        call start(run)
        call run%begin(case, .false., list, sink, error)
        call run%advance(0.3_dp*run%expected_end(), 0)
        other = run
        other_sink = sink
        other%recorder%sink => other_sink
        call run%advance(huge(1.0_dp), 0)
        call other%advance(huge(1.0_dp), 0)
        call run%finish(one%report, error)
        call other%finish(two%report, error)
        call sink%hand_over(size(list%id), one%values, one%event)
        call other_sink%hand_over(size(list%id), two%values, two%event)
        report = one%report
        call check%that(are_equal(one, two), trim(files(i))//', '//methods(j)//': a copy goes on like the run')
      end do
    end do

  contains

    subroutine start(run)
      type(run_t), intent(out) :: run
      run%t = 0
    end subroutine start
  end subroutine copies

  !> At a pause at the time of a row, also inside a contact or a film, the values are those of the row, bit for bit.
  subroutine values_at_pauses(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: files(5) = [character(len=long) :: 'cases/sim_I.nml', 'cases/flores/friction_100.nml', &
      'cases/friction/lugre.nml', 'cases/elastic/engine_rod.nml', 'cases/joints/both_pins.nml']
    type(case_t) :: case
    type(column_list_t) :: list
    type(trace_t) :: whole
    type(error_t), allocatable :: error
    integer :: i
    do i = 1, size(files)
      call read_case(trim(files(i)), [character(len=long) :: 'integrator.revolutions=0.2', 'integrator.method=auto'], case, error)
      call choose_columns(case, .false., list, error)
      call go(case, 0, whole)
      call check%that(rows_seen(case, list, whole%values), trim(files(i))//': the values at a pause are those of a row')
    end do
  end subroutine values_at_pauses

  !> Whether the values at the times of all rows are the rows.
  logical function rows_seen(case, list, rows)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(in) :: list
    real(dp), intent(in) :: rows(:, :)
    type(row_store_t) :: sink
    type(run_t) :: run
    type(error_t), allocatable :: error
    real(dp) :: values(size(rows, 1))
    logical :: in_domain
    integer :: i
    call run%begin(case, .false., list, sink, error)
    rows_seen = .not. allocated(error)
    do i = 1, size(rows, 2) - 1
      call run%advance(rows(1, i), 0)
      call run%evaluate_row(values, in_domain)
      rows_seen = rows_seen .and. in_domain
      if (in_domain) rows_seen = rows_seen .and. all(transfer(values, [0_int64]) == transfer(rows(:, i), [0_int64]))
    end do
  end function rows_seen

  !> A spring whose stiffness is quadrupled at t = 1, in the middle of a step: p = cos(1) cos(2 (t - 1)) - sin(1) sin(2 (t - 1))/2.
  subroutine cuts(check)
    class(checks_t), intent(inout) :: check
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    class(ode_method_t), allocatable :: method
    type(integration_t) :: integration
    type(silent_observer_t) :: nobody
    type(error_t), allocatable :: error
    type(spring_t) :: spring
    real(dp) :: y(2)
    integer :: i
    do i = 1, size(methods)
      call new_method(trim(methods(i)), method, error)
      method%settings%relative = [1e-9_dp, 1e-9_dp]
      method%settings%absolute = [1e-9_dp, 1e-9_dp]
      spring = spring_t()
      spring%n = 2
      spring%n_positions = 1
      call integration%begin(spring, method, 0.0_dp, [1.0_dp, 0.0_dp], 3.0_dp, 0)
      call integration%go_to(spring, method, nobody, 1.0_dp, 0)
      call check%that(integration%is_kept .and. integration%t > 1, 'a step that reaches beyond the pause is kept: '//methods(i))
      call integration%cut(spring, method, nobody, 1.0_dp)
      spring%stiffness = 4
      call integration%restart(spring, method)
      call integration%go_to(spring, method, nobody, 3.0_dp*(97/97.0_dp), 0)
      call integration%finish(method)
      y = integration%y
      call check%that(integration%is_over .and. .not. abs(integration%t - 3) > 0, 'a cut integration ends: '//methods(i))
      call check%close_to(y(1), cos(1.0_dp)*cos(4.0_dp) - 0.5_dp*sin(1.0_dp)*sin(4.0_dp), 2e-7_dp, &
        'a step ended where the problem changes: '//methods(i))
    end do
  end subroutine cuts

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(spring_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    in_domain = .true.
    dydt = [y(2), -self%stiffness*y(1)]
  end subroutine derivatives
end module test_pauses
