!> An observer that stores the times of contact events.
module event_watcher
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_solver, only: silent_observer_t
  use scene_problem, only: scene_t, event_none
  implicit none
  private
  public :: event_watcher_t, most_instants

  integer, parameter :: most_instants = 1000

  type, extends(silent_observer_t) :: event_watcher_t
    real(dp) :: instant(most_instants) = 0   !! [s]
    integer :: n = 0
  contains
    procedure :: event_accepted
  end type event_watcher_t

contains

  subroutine event_accepted(self, problem, index, t, y)
    class(event_watcher_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    select type (problem)
    class is (scene_t)
      if (problem%reported_event(index) == event_none .or. self%n >= most_instants) return
      self%n = self%n + 1
      self%instant(self%n) = t
    end select
  end subroutine event_accepted
end module event_watcher
