!> An observer that stores the states q, A, x, their rates and the eccentricity, and their largest magnitudes.
module state_watcher
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t
  use ode_solver, only: observer_t
  use scene_problem, only: scene_t, evaluation_t
  implicit none
  private
  public :: state_watcher_t, watched

  integer, parameter :: watched = 8   !! q, A, x, q', A', x', e_x, e_y

  type, extends(observer_t) :: state_watcher_t
    real(dp) :: values(watched) = 0
    real(dp) :: largest(watched) = 0
    real(dp) :: rebuilt = 0   !! largest |e - e rebuilt from q, A and x| [m]
    integer :: events = 0
  contains
    procedure :: step_accepted
    procedure :: event_accepted
    procedure :: look
  end type state_watcher_t

contains

  subroutine step_accepted(self, method, problem, t_to)
    class(state_watcher_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    if (t_to < method%t) return
    call self%look(problem, method%t, method%y)
  end subroutine step_accepted

  !> Take the values at (t, y).
  subroutine look(self, problem, t, y)
    class(state_watcher_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain
    select type (problem)
    class is (scene_t)
      call problem%evaluate(t, y, now, in_domain)
      associate (m => now%motion)
        self%values = [m%crank_angle, atan2(m%sin_rod, m%cos_rod), m%piston_position, m%crank_speed, m%rod_speed, &
          m%piston_velocity, m%offset]
      end associate
      self%largest = max(self%largest, abs(self%values))
      associate (r => problem%chain%bodies%crank%length, l => problem%chain%bodies%rod%length, v => self%values)
        self%rebuilt = max(self%rebuilt, abs(r*cos(v(1)) + l*cos(v(2)) - v(3) - v(7)), abs(r*sin(v(1)) - l*sin(v(2)) - v(8)))
      end associate
    end select
  end subroutine look

  subroutine event_accepted(self, problem, index, t, y)
    class(state_watcher_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    self%events = self%events + 1
  end subroutine event_accepted
end module state_watcher
