!> Chooses between Adams for non-stiff and Radau for stiff parts of the problem during the integration.
!>
!> Every phase of the problem (its `mode`) begins with the method with which the last phase of this mode ended, at first with Adams.
!> If Adams is limited by stability for a number of steps, Radau continues from the same point. The evaluations that Radau then uses
!> in this mode are compared with those that Adams would need, which are proportional to the rate of the fastest mode. If Radau uses
!> more, Adams continues, and the number of steps required for the next change is increased.
!>
!> At loose tolerances a fast mode without damping, such as the axial vibration of a rod, never seems to have decayed: the errors
!> that Adams itself may make at the limit of its stability keep it in motion, and the error estimate limits every step. There Radau
!> also takes over after many steps near this limit, whatever limited them, and may lose more until this vibration has decayed.
module auto_method
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_method, only: step_statistics_t, step_done, step_rejected, limit_stability, with_adams, with_radau
  use adams, only: adams_t
  use adams_coefficients, only: stability_limit
  use radau, only: radau_t
  implicit none
  private
  public :: auto_t

  integer, parameter :: first_excess = 40    !! excess of steps limited by stability over other steps after which Radau takes over
  integer, parameter :: largest_excess = 2560   !! largest such excess after repeated changes back to Adams: a motion whose start
                                               !! Adams follows at less cost may be stiff later
  integer, parameter :: first_near = 400     !! the same of steps near the limit of stability, at loose tolerances
  real(dp), parameter :: near_limit = 0.4_dp !! h times the rate of the fastest mode in such a step, over the limit of its order
  real(dp), parameter :: loose = 1.5e-5_dp   !! relative tolerance
  real(dp), parameter :: adams_price = 1.3_dp  !! evaluations of Adams limited by stability, per 1/rate of the fastest mode
  real(dp), parameter :: step_overhead = 5     !! cost of Jacobian and linear algebra of a Radau step, in evaluations

  !> Adams, with Radau at its side. While Radau is in use, its solution is copied after every step; Adams itself costs no more than
  !> without this choice.
  type, extends(adams_t) :: auto_t
    private
    type(radau_t) :: radau
    logical :: stiff = .false.            !! Radau is in use
    logical, allocatable :: stiff_in(:)   !! the last phase of this mode ended with Radau, (0:highest mode)
    integer :: mode = 0                   !! mode of the present phase
    integer :: excess = 0                 !! excess of Adams steps limited by stability over other steps
    integer :: near = 0                   !! the same of steps near the limit of stability, whatever limited them
    logical :: decays = .false.           !! Radau has taken over for these: a vibration must decay first
    integer, allocatable :: required_excess(:), required_near(:)   !! numbers of such steps required, for each mode
    integer :: evaluations_before = 0     !! number before the present step of Radau
    real(dp), allocatable :: loss(:)      !! evaluations by Radau minus those that Adams would have needed, for each mode
  contains
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: may_improve
    procedure :: improve
    procedure :: land_on
    procedure :: withdraw
    procedure :: count_time
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
      call forget_modes(self, problem%highest_mode)
      self%stiff = .false.
      self%radau%settings = self%settings
      call self%radau%prepare(problem)
      call self%prepare(problem)
    end if
    self%mode = problem%mode
    self%near = 0
    call begin_with(self, problem, self%stiff_in(self%mode), t, y, first, status)
  end subroutine start

  !> Largest number of additional evaluations by Radau in a mode before Adams takes over again. It is larger at tight tolerances,
  !> where the steps of Radau's highest formula grow slowly after a start, and where a vibration must decay (see the manual).
  pure real(dp) function most_loss(self)
    class(auto_t), intent(in) :: self
    real(dp), parameter :: tight = 5e-9_dp   !! relative tolerance
    most_loss = merge(320, 80, self%nominal_tolerance() < tight)
    if (self%decays) most_loss = 640
  end function most_loss

  !> Discard what is known about the modes.
  pure subroutine forget_modes(self, highest)
    class(auto_t), intent(inout) :: self
    integer, intent(in) :: highest
    if (allocated(self%stiff_in)) deallocate (self%stiff_in, self%required_excess, self%required_near, self%loss, self%time_with)
    allocate (self%stiff_in(0:highest), source=.false.)
    allocate (self%required_excess(0:highest), source=first_excess)
    allocate (self%required_near(0:highest), source=first_near)
    allocate (self%loss(0:highest), source=0.0_dp)
    allocate (self%time_with(2, 0:highest), source=0.0_dp)
  end subroutine forget_modes

  !> Start a method at (t, y), continuing the statistics.
  subroutine begin_with(self, problem, stiff, t, y, first, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(in) :: stiff, first
    real(dp), intent(in) :: t, y(:)
    integer, intent(out) :: status

    if (stiff .and. .not. self%stiff) self%radau%statistics = self%statistics
    if (self%stiff .and. .not. stiff) self%statistics = self%radau%statistics
    self%stiff = stiff
    self%excess = 0
    self%rejected = .false.
    if (stiff) then
      call self%radau%start(problem, t, y, first, status)
      call copy_solution(self)
    else
      call self%adams_t%start(problem, t, y, first, status)
    end if
  end subroutine begin_with

  subroutine step(self, problem, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status

    if (.not. self%rejected) then
      call choose_method(self, problem, status)
      if (status /= step_done) return
      self%evaluations_before = self%radau%statistics%evaluations
    end if
    if (self%stiff) then
      call self%radau%step(problem, status)
      self%rejected = status == step_rejected
      call copy_solution(self)
      if (status == step_done) self%loss(self%mode) = self%loss(self%mode) + self%radau%statistics%evaluations &
        - self%evaluations_before + step_overhead - adams_price*self%radau%fastest_rate()*(self%t - self%t_old)
      return
    end if
    call self%adams_t%step(problem, status)
    if (status == step_rejected) return
    if (self%limit_done == limit_stability) then
      self%excess = self%excess + 1
    else
      self%excess = max(0, self%excess - 1)
    end if
    if (self%nominal_tolerance() < loose) return
    self%near = max(0, self%near + merge(1, -1, self%stiffness_done > near_limit*stability_limit(self%order)))
  end subroutine step

  !> Change to the other method before a step if the one in use has been dearer for long enough.
  subroutine choose_method(self, problem, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(out) :: status
    status = step_done
    associate (mode => self%mode)
      if (self%stiff .and. self%loss(mode) > most_loss(self)) then
        if (self%decays) then
          self%required_near(mode) = 4*self%required_near(mode)
        else
          self%required_excess(mode) = min(4*self%required_excess(mode), largest_excess)
        end if
        call change_over(self, problem, .false., status)
      else if (.not. self%stiff .and. (self%excess >= self%required_excess(mode) .or. &
        self%near >= self%required_near(mode))) then
        self%decays = self%near >= self%required_near(mode)
        self%loss(mode) = 0
        call change_over(self, problem, .true., status)
      end if
    end associate
  end subroutine choose_method

  !> Continue with the other method from the present point.
  subroutine change_over(self, problem, stiff, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(in) :: stiff
    integer, intent(out) :: status
    real(dp) :: t, y(size(self%y))
    self%stiff_in(self%mode) = stiff
    t = self%t
    y = self%y
    self%goes_on = .true.
    call begin_with(self, problem, stiff, t, y, .false., status)
    self%goes_on = .false.
    if (stiff) then
      call count_change(self%radau%statistics)
    else
      call count_change(self%statistics)
    end if
  end subroutine change_over

  !> Count a change of method, which is not a restart requested by the problem.
  pure subroutine count_change(statistics)
    type(step_statistics_t), intent(inout) :: statistics
    statistics%restarts = statistics%restarts - 1
    statistics%switches = statistics%switches + 1
  end subroutine count_change

  !> Copy Radau's solution at both ends of its last step.
  pure subroutine copy_solution(self)
    class(auto_t), intent(inout) :: self
    self%t = self%radau%t
    self%t_old = self%radau%t_old
    self%y = self%radau%y
    self%y_old = self%radau%y_old
    self%order = self%radau%order
    self%statistics%accepted = self%radau%statistics%accepted
    self%statistics%evaluations = self%radau%statistics%evaluations
  end subroutine copy_solution

  pure subroutine interpolate(self, t, y)
    class(auto_t), intent(inout) :: self
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(:)
    if (self%stiff) then
      call self%radau%interpolate(t, y)
    else
      call self%adams_t%interpolate(t, y)
    end if
  end subroutine interpolate

  pure logical function may_improve(self, t)
    class(auto_t), intent(in) :: self
    real(dp), intent(in) :: t
    may_improve = .false.
    if (self%stiff) may_improve = self%radau%may_improve(t)
  end function may_improve

  pure subroutine improve(self, t, f, y, change)
    class(auto_t), intent(inout) :: self
    real(dp), intent(in) :: t, f(:)
    real(dp), intent(inout) :: y(:)
    real(dp), intent(out) :: change
    call self%radau%improve(t, f, y, change)
  end subroutine improve

  subroutine land_on(self, problem, t, y, landed)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    logical, intent(out) :: landed
    if (self%stiff) then
      call self%radau%land_on(problem, t, y, landed)
    else
      call self%adams_t%land_on(problem, t, y, landed)
    end if
  end subroutine land_on

  subroutine withdraw(self, problem, longest, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: longest
    integer, intent(out) :: status
    if (self%stiff) then
      call self%radau%withdraw(problem, longest, status)
      call copy_solution(self)
    else
      call self%adams_t%withdraw(problem, longest, status)
    end if
  end subroutine withdraw

  !> Add the time of the last step to the total of the method and the mode with which it was made.
  subroutine count_time(self, t_to)
    class(auto_t), intent(inout) :: self
    real(dp), intent(in) :: t_to
    integer :: which
    which = merge(with_radau, with_adams, self%stiff)
    self%time_with(which, self%mode) = self%time_with(which, self%mode) + (t_to - self%t_old)
    if (self%stiff) then
      call self%radau%count_time(t_to)
    else
      call self%adams_t%count_time(t_to)
    end if
  end subroutine count_time

  !> Statistics of the whole integration so far, which the method in use continues from those of the other.
  pure type(step_statistics_t) function totals(self) result(statistics)
    class(auto_t), intent(in) :: self
    statistics = self%statistics
    if (self%stiff) statistics = self%radau%statistics
  end function totals
end module auto_method
