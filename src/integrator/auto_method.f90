!> Adams where the problem is not stiff, Radau where it is, chosen while integrating.
!>
!> Every phase of the problem (its `mode`) begins with the method that it ended with the last time, at first with Adams. A
!> phase in which Adams is bound by its stability for a number of steps goes on with Radau from the same point; one in
!> which Radau's steps are so short that Adams would need fewer evaluations goes back.
module auto_method
  use kinds, only: dp
  use ode_problem, only: ode_problem_t, max_modes
  use ode_method, only: ode_method_t, step_statistics_t, step_done, limit_stability, with_adams, with_radau
  use adams, only: adams_t
  use radau, only: radau_t
  implicit none
  private
  public :: auto_t

  integer, parameter :: patience = 15          !! steps bound by stability, more than not, before Radau takes over
  integer, parameter :: patience_back = 8      !! steps in a row that Adams would do cheaper before it takes over again
  real(dp), parameter :: adams_reach = 1.5_dp  !! h rho that an Adams step reaches at its stability limit
  real(dp), parameter :: adams_cost = 2.1_dp   !! its evaluations
  real(dp), parameter :: radau_cost = 15       !! evaluations of a Radau step, its Jacobian and algebra included

  type, extends(ode_method_t) :: auto_t
    private
    type(adams_t) :: adams
    type(radau_t) :: radau
    logical :: stiff = .false.                 !! Radau is at work
    logical :: stiff_in(0:max_modes) = .false. !! the mode ended with Radau
    integer :: mode = 0                        !! of the present phase
    integer :: bound = 0                       !! steps bound by stability (Adams), or too short for Radau
  contains
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: totals
  end type auto_t

contains

  subroutine start(self, problem, t, y, first, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: first
    integer, intent(out) :: status

    if (first) then
      self%statistics = step_statistics_t()
      self%stiff_in = .false.
      self%stiff = .false.
      self%adams%settings = self%settings
      self%radau%settings = self%settings
      call self%radau%prepare(problem)
    end if
    self%mode = problem%mode
    call begin_with(self, problem, self%stiff_in(self%mode), t, y, first, status)
  end subroutine start

  !> Start a method at (t, y); the statistics go with it.
  subroutine begin_with(self, problem, stiff, t, y, first, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(in) :: stiff, first
    real(dp), intent(in) :: t, y(:)
    integer, intent(out) :: status
    type(step_statistics_t) :: so_far

    so_far = self%totals()
    self%stiff = stiff
    self%bound = 0
    if (stiff) then
      self%radau%statistics = so_far
      call self%radau%start(problem, t, y, first, status)
    else
      self%adams%statistics = so_far
      call self%adams%start(problem, t, y, first, status)
    end if
    self%t = t
    self%t_old = t
    self%y = y
    self%y_old = y
  end subroutine begin_with

  subroutine step(self, problem, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    integer :: bound_before

    if (self%stiff) then
      if (self%bound >= patience_back) call change_over(self, problem, .false., status)
    else
      if (self%bound >= patience) call change_over(self, problem, .true., status)
    end if
    if (self%stiff) then
      call self%radau%step(problem, status)
      if (status == step_done) call take_over(self, self%radau)
      if (adams_would_do(self%radau)) then
        self%bound = self%bound + 1
      else
        self%bound = 0
      end if
    else
      bound_before = self%adams%statistics%limited_by(limit_stability)
      call self%adams%step(problem, status)
      if (status == step_done) call take_over(self, self%adams)
      if (self%adams%statistics%limited_by(limit_stability) > bound_before) then
        self%bound = self%bound + 1
      else
        self%bound = max(0, self%bound - 1)
      end if
    end if
  end subroutine step

  !> Whether Adams would need fewer evaluations for a step as long as Radau's last one.
  pure logical function adams_would_do(radau)
    type(radau_t), intent(in) :: radau
    adams_would_do = adams_cost*(radau%t - radau%t_old)*radau%spectral_bound() < adams_reach*radau_cost
  end function adams_would_do

  !> Go on with the other method from where we are.
  subroutine change_over(self, problem, stiff, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(in) :: stiff
    integer, intent(out) :: status
    type(step_statistics_t) :: so_far
    self%stiff_in(self%mode) = stiff
    call begin_with(self, problem, stiff, self%t, self%y, .false., status)
    so_far = self%totals()
    so_far%restarts = so_far%restarts - 1   ! not one that the problem asked for
    so_far%switches = so_far%switches + 1
    if (stiff) then
      self%radau%statistics = so_far
    else
      self%adams%statistics = so_far
    end if
  end subroutine change_over

  !> The last step of the method at work is ours.
  subroutine take_over(self, method)
    class(auto_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    integer :: which
    which = merge(with_radau, with_adams, self%stiff)
    associate (time => method%statistics%time_with(which, self%mode))
      time = time + (method%t - method%t_old)
    end associate
    self%t = method%t
    self%t_old = method%t_old
    self%order = method%order
    self%y = method%y
    self%y_old = method%y_old
    self%f = method%f
    self%statistics%accepted = method%statistics%accepted
  end subroutine take_over

  pure subroutine interpolate(self, t, y)
    class(auto_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    if (self%stiff) then
      call self%radau%interpolate(t, y)
    else
      call self%adams%interpolate(t, y)
    end if
  end subroutine interpolate

  !> The counts of both methods together.
  pure function totals(self) result(statistics)
    class(auto_t), intent(in) :: self
    type(step_statistics_t) :: statistics
    if (self%stiff) then
      statistics = self%radau%statistics
    else
      statistics = self%adams%statistics
    end if
  end function totals
end module auto_method
