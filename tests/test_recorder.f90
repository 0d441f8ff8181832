!> The recorder of a run: what happens where the interpolant of a step leaves the model.
module test_recorder
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use adams, only: adams_t
  use ode_solver, only: integrate, integration_done, integration_interrupted
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene, settings_for
  use case_definition, only: case_t
  use case_file, only: read_case
  use trace_columns, only: choose_columns
  use run_recorder, only: recorder_t
  use collecting_sink, only: collecting_sink_t
  use trace_sink, only: trace_event_t
  implicit none
  private
  public :: run_test_recorder

  real(dp), parameter :: interval = 1e-6_dp, t_end = 5e-5_dp   !! [s]

  !> Adams, with an interpolant that puts the pin beyond the wall for some time.
  type, extends(adams_t) :: straying_adams_t
    real(dp) :: strays_from = huge(1.0_dp)   !! [s]
    real(dp) :: returns_at = huge(1.0_dp)    !! [s]
    integer :: position = 0                  !! index of the eccentricity in the state
    real(dp) :: beyond = 0                   !! eccentricity beyond the wall [m]
  contains
    procedure :: interpolate
  end type straying_adams_t

contains

  subroutine run_test_recorder(check)
    class(checks_t), intent(inout) :: check
    call no_row_is_lost(check)
    call starts_at_the_wall(check)
  end subroutine run_test_recorder

  pure subroutine interpolate(self, t, y)
    class(straying_adams_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    call self%adams_t%interpolate(t, y)
    if (t > self%strays_from .and. t < self%returns_at) y(self%position) = self%beyond
  end subroutine interpolate

  !> A row that cannot be written ends the run; the rows before it are there.
  subroutine no_row_is_lost(check)
    class(checks_t), intent(inout) :: check
    integer :: status
    logical :: has_left
    real(dp), allocatable :: times(:)
    real(dp) :: reached
    integer :: i
    call run(huge(1.0_dp), huge(1.0_dp), status, has_left, times, reached)
    call check%that(status == integration_done .and. .not. has_left, 'a run whose rows are all inside the model')
    call check%close_to(real(size(times), dp), t_end/interval + 1, 1e-6_dp, 'number of its rows')
    do i = 1, 2
      call run(1.5e-5_dp, merge(huge(1.0_dp), 1.65e-5_dp, i == 1), status, has_left, times, reached)
      call check%that(status == integration_interrupted .and. has_left, 'a row outside the model ends the run')
      call check%close_to(maxval(times), 1.5e-5_dp, 0.5_dp*interval, 'the last row before it')
      call check%close_to(real(size(times), dp), 16.0_dp, 0.0_dp, 'number of the rows before it')
      call check%that(reached >= maxval(times) .and. reached < maxval(times) + interval, 'the run ends before the next row')
    end do
  end subroutine no_row_is_lost

  !> Run simulation I for a short time with an interpolant that leaves the film at a time.
  subroutine run(strays_from, returns_at, status, has_left, times, reached)
    real(dp), intent(in) :: strays_from, returns_at
    integer, intent(out) :: status
    logical, intent(out) :: has_left
    real(dp), allocatable, intent(out) :: times(:)
    real(dp), intent(out) :: reached   !! time of the last point that the summary knows [s]
    type(case_t) :: case
    type(scene_t), allocatable :: scene
    type(error_t), allocatable :: error
    type(recorder_t) :: recorder
    type(collecting_sink_t), target :: sink
    type(straying_adams_t) :: method
    type(trace_event_t), allocatable :: event(:)
    real(dp), allocatable :: y(:), rows(:, :)
    real(dp) :: t
    call read_case('cases/sim_I.nml', [character(len=30) :: 'output.columns=time'], case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (.not. allocated(error)) call choose_columns(case, .false., recorder%list, error)
    if (allocated(error)) error stop 'test_recorder: no such scene'
    recorder%rows%interval = interval
    recorder%rows%end_time = t_end
    recorder%sink => sink
    method%settings = settings_for(case, scene)
    method%strays_from = strays_from
    method%returns_at = returns_at
    method%position = scene%joints(1)%at%position
    method%beyond = 1.001_dp*scene%joints(1)%bearing%clearance
    y = scene%initial_state()
    t = 0
    call recorder%prepare(scene)
    call recorder%begin(scene, 0.0_dp, y)
    call integrate(scene, method, t, y, t_end, 0, recorder, status)
    has_left = recorder%has_left
    call sink%hand_over(size(recorder%list%id), rows, event)
    times = rows(1, :)
    reached = recorder%extremes%figures%time
  end subroutine run

  !> Without contact a pin must not start at the wall, nor within rounding of it.
  subroutine starts_at_the_wall(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    character(len=20), parameter :: at(3) = [character(len=20) :: '19.99999e-6', '20.0e-6', '19.9999999999999e-6']
    integer :: i
    do i = 1, size(at)
      call read_case('cases/sim_I.nml', [character(len=50) :: 'contact=none', 'friction=none', &
        'initial.eccentricity=0.0,'//trim(at(i))], case, error)
      call check%that(allocated(error) .eqv. i > 1, 'a film without contact that begins at '//at(i))
      if (allocated(error)) call check%that(index(error%message, '&initial eccentricity') > 0, error%message)
    end do
  end subroutine starts_at_the_wall
end module test_recorder
