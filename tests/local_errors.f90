!> An observer that measures the local error of each accepted step, as in DETEST (Enright & Pryce 1987): the difference from the
!> local solution, which starts at the beginning of the step and is integrated by an independent method.
module local_errors
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t
  use ode_solver, only: silent_observer_t
  implicit none
  private
  public :: local_error_watcher_t, local_solution

  !> Errors are in the method's own weights and norm: 1 is the tolerance.
  type, extends(silent_observer_t) :: local_error_watcher_t
    integer :: steps = 0
    integer :: unsure = 0          !! steps whose local solution is too uncertain; not in the other counts
    integer :: deceived = 0        !! steps whose error is above the tolerance
    real(dp) :: largest = 0        !! largest error of a step
    real(dp) :: largest_per_unit = 0   !! largest error minus the rounding of y, divided by the length of the step
  contains
    procedure :: step_accepted
  end type local_error_watcher_t

contains

  subroutine step_accepted(self, method, problem, t_to)
    class(local_error_watcher_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: y(problem%n), exact(problem%n), weight(problem%n), error, doubt
    call method%interpolate(t_to, y)
    call local_solution(problem, method%t_old, method%y_old, t_to, exact, doubt)
    weight = method%settings%relative*abs(method%y_old) + method%settings%absolute
    error = norm2((y - exact)/weight)
    self%steps = self%steps + 1
    if (doubt/minval(weight) > 0.3_dp*max(error, 1.0_dp)) then
      self%unsure = self%unsure + 1
      return
    end if
    if (error > 1) self%deceived = self%deceived + 1
    self%largest = max(self%largest, error)
    error = error - 8*epsilon(1.0_dp)*norm2(y/weight)
    self%largest_per_unit = max(self%largest_per_unit, error/(t_to - method%t_old))
  end subroutine step_accepted

  !> The solution through (t, y) at t_to by Gragg's extrapolated midpoint rule in several pieces. The independent variable is one
  !> whose rate vanishes at both ends, so that square roots of the time in f at the ends do not reduce the accuracy. `doubt` is the
  !> last change of the result.
  subroutine local_solution(problem, t, y, t_to, y_to, doubt)
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:), t_to
    real(dp), intent(out) :: y_to(:), doubt
    integer, parameter :: columns = 9
    real(dp) :: before(size(y)), piece(size(y)), change
    integer :: pieces, i
    pieces = 1
    y_to = y
    do
      before = y_to
      piece = y
      doubt = 0
      do i = 1, pieces
        call extrapolated_midpoint(problem, t, t_to, (i - 1.0_dp)/pieces, 1.0_dp/pieces, columns, piece, change)
        doubt = max(doubt, change)
      end do
      y_to = piece
      if (doubt <= 30*epsilon(1.0_dp)*maxval(1 + abs(y)) .or. pieces >= 64) exit
      pieces = 2*pieces
    end do
    if (pieces > 1) doubt = min(doubt, maxval(abs(y_to - before)))
  end subroutine local_solution

  !> Advance y over start <= s <= start + length; `change` is the difference of the last two columns of the extrapolation.
  subroutine extrapolated_midpoint(problem, t_from, t_to, start, length, columns, y, change)
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_from, t_to, start, length
    integer, intent(in) :: columns
    real(dp), intent(inout) :: y(:)
    real(dp), intent(out) :: change
    real(dp) :: table(size(y), columns), older(size(y)), old(size(y)), new(size(y)), f(size(y)), h
    integer :: i, j, n
    do i = 1, columns
      n = 2*i
      h = length/n
      old = y
      call slope(start, y, f)
      new = y + h*f
      do j = 1, n - 1
        older = old
        old = new
        call slope(start + j*h, old, f)
        new = older + 2*h*f
      end do
      call slope(start + length, new, f)
      table(:, i) = 0.5_dp*(new + old + h*f)
      do j = i - 1, 1, -1   ! in powers of h^2; table(:, j) becomes the polynomial through rows j..i
        table(:, j) = table(:, j + 1) + (table(:, j + 1) - table(:, j))/((real(i, dp)/j)**2 - 1)
      end do
    end do
    change = maxval(abs(table(:, 1) - table(:, 2)))
    y = table(:, 1)
  contains
    !> dy/ds, with t = t_from + (t_to - t_from) (10 s^3 - 15 s^4 + 6 s^5).
    subroutine slope(s, y, dyds)
      real(dp), intent(in) :: s, y(:)
      real(dp), intent(out) :: dyds(:)
      logical :: in_domain
      call problem%derivatives(t_from + (t_to - t_from)*s**3*(10 - 15*s + 6*s**2), y, dyds, in_domain)
      dyds = dyds*((t_to - t_from)*30*s**2*(1 - s)**2)
    end subroutine slope
  end subroutine extrapolated_midpoint
end module local_errors
