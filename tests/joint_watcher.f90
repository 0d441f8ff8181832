!> An observer that counts the contacts of each joint.
module joint_watcher
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_solver, only: silent_observer_t
  use clearance_joint, only: most_joints
  use scene_problem, only: scene_t, event_none, event_contact_begins
  implicit none
  private
  public :: joint_watcher_t

  type, extends(silent_observer_t) :: joint_watcher_t
    integer :: begun(most_joints) = 0, ended(most_joints) = 0
    real(dp) :: first_begin(most_joints) = huge(1.0_dp)   !! [s]
  contains
    procedure :: event_accepted
  end type joint_watcher_t

contains

  subroutine event_accepted(self, problem, index, t, y)
    class(joint_watcher_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    integer :: joint
    select type (problem)
    class is (scene_t)
      if (problem%reported_event(index) == event_none) return
      joint = problem%event_of(index)%joint
      if (problem%reported_event(index) == event_contact_begins) then
        self%begun(joint) = self%begun(joint) + 1
        self%first_begin(joint) = min(self%first_begin(joint), t)
      else
        self%ended(joint) = self%ended(joint) + 1
      end if
    end select
  end subroutine event_accepted
end module joint_watcher
