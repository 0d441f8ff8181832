!> An observer that samples the solution at equal intervals by the interpolant of the method.
module sampler
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t
  use ode_solver, only: silent_observer_t
  implicit none
  private
  public :: sampler_t

  type, extends(silent_observer_t) :: sampler_t
    real(dp) :: interval = 1
    integer :: taken = 0
    real(dp), allocatable :: y(:, :)   !! (n, samples): y at interval, 2*interval, ...
  contains
    procedure :: step_accepted
  end type sampler_t

contains

  subroutine step_accepted(self, method, problem, t_to)
    class(sampler_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: t
    do while (self%taken < size(self%y, 2))
      t = (self%taken + 1)*self%interval
      if (t > t_to + 1e-12_dp*self%interval) exit
      self%taken = self%taken + 1
      call method%interpolate(min(t, t_to), self%y(:, self%taken))
    end do
  end subroutine step_accepted
end module sampler
