!> A scene in the coordinates (q, A, x) of its bodies, with the parts of the gas cycle as events.
module absolute_gas_engine
  use kinds, only: dp
  use ode_problem, only: event_continue
  use scene_problem, only: scene_t
  use absolute_coordinates, only: absolute_coordinates_t, in_absolute_coordinates
  implicit none
  private
  public :: absolute_gas_engine_t, new_absolute_gas_engine

  type, extends(absolute_coordinates_t) :: absolute_gas_engine_t
  contains
    procedure :: events
    procedure :: handle_event
  end type absolute_gas_engine_t

contains

  !> A scene in these coordinates, and its initial state.
  subroutine new_absolute_gas_engine(scene, engine, y)
    type(scene_t), intent(in) :: scene
    type(absolute_gas_engine_t), intent(out) :: engine
    real(dp), intent(out) :: y(6)
    call in_absolute_coordinates(scene, engine%absolute_coordinates_t, y)
    if (.not. allocated(engine%scene%gas)) return
    engine%n_events = engine%scene%gas%n_events
    call engine%scene%gas%start(y(1), y(4))
  end subroutine new_absolute_gas_engine

  pure subroutine events(self, t, y, g, g_rate)
    class(absolute_gas_engine_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    if (self%n_events > 0) call self%scene%gas%events(y(1), y(4), g, g_rate)
  end subroutine events

  subroutine handle_event(self, index, t, y, action)
    class(absolute_gas_engine_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    call self%scene%gas%pass(index, y(1), y(4))
    action = event_continue
  end subroutine handle_event
end module absolute_gas_engine
