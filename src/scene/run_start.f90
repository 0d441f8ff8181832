!> Where a run begins: at t = 0 with the values of its case, or with the state that another run has reached.
module run_start
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use run_state, only: run_state_t
  use case_definition, only: case_t
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene, latest_end
  use run_recorder, only: recorder_t
  use trace_row, only: column_list_t
  implicit none
  private
  public :: find_start, try_start

contains

  !> Time and state at which a run of a case begins, in a scene that has just been built: those of the run from which it starts, or
  !> those that the case gives. Error: the state from which it starts does not fit (status_case_file); without the recorder its
  !> totals are not examined.
  subroutine find_start(case, ideal_joint, scene, t, y, error, recorder)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint   !! the run of the ideal twin, which starts as the case says
    type(scene_t), intent(inout) :: scene
    real(dp), intent(out) :: t
    real(dp), allocatable, intent(out) :: y(:)
    type(error_t), allocatable, intent(out) :: error
    type(recorder_t), intent(inout), optional :: recorder
    type(run_state_t) :: from
    t = 0
    allocate (y(scene%n), source=scene%initial_state())
    if (ideal_joint .or. .not. allocated(case%initial%state)) return
    from = case%initial%state
    from%sets = .true.
    from%goes_on = case%initial%goes_on .and. any(from%numbers%is_total)
    call scene%declare(from, t, y)
    if (present(recorder)) then
      call recorder%declare(from, scene)
      call from%find_unused()
    end if
    from%of_totals = .true.
    if (.not. t < latest_end(case)) call from%refuse('time', 'is not before the end of the run')
    if (allocated(scene%turns)) then
      if (scene%turns%made(scene%crank_angle(t, y)) >= scene%turns%wanted) &
        call from%refuse('crank_travel', 'the crank has made the revolutions that end the run')
    end if
    if (allocated(from%fault)) then
      call fail(error, from%file//': '//from%fault, status_case_file)
    else
      call scene%complete_state(t, y)
    end if
  end subroutine find_start

  !> Build the scene of a case with these columns and start it, without tables. Errors: see `begin`.
  subroutine try_start(case, list, error)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(in) :: list
    type(error_t), allocatable, intent(out) :: error
    type(scene_t), allocatable :: scene
    type(recorder_t) :: recorder
    real(dp), allocatable :: y(:)
    real(dp) :: t
    call build_scene(case, .false., scene, error, without_tables=.true.)
    if (allocated(error) .or. .not. allocated(case%initial%state)) return
    recorder%list = list
    recorder%list%id = [integer ::]
    call recorder%prepare(scene)
    call find_start(case, .false., scene, t, y, error, recorder)
  end subroutine try_start
end module run_start
