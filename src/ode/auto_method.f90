!> Adams where the problem is not stiff, Radau where it is, chosen while integrating.
!>
!> Every phase of the problem (its `mode`) begins with the method that it ended with the last time, at first with Adams
!> unless the damping in the Jacobian promises that it would be bound by its stability. A
!> phase in which Adams is bound by its stability for a number of steps goes on with Radau from the same point. What
!> Radau costs in a mode is then held against what Adams would have cost, its price per time while it was bound carried on in
!> proportion to the stiffness: where Radau turns out dearer on the whole, the phase goes back and asks for more
!> patience the next time.
module auto_method
  use gudgeon_kinds, only: dp
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t, step_statistics_t, step_done, limit_stability, with_adams, with_radau
  use adams, only: adams_t
  use radau, only: radau_t
  use gudgeon_archive, only: archive_t
  implicit none
  private
  public :: auto_t

  integer, parameter :: first_patience = 40    !! steps bound by stability, more than not, before Radau takes over
  integer, parameter :: trial_steps = 30       !! of Radau, before its cost is judged
  real(dp), parameter :: fair_trial = 1.5_dp   !! it is too dear above this factor: what Adams would cost is an estimate
  integer, parameter :: bad_trial_steps = 12   !! after so many steps it is judged too,
  real(dp), parameter :: bad_trial = 3         !! by this factor
  integer, parameter :: most_patience = 400    !! each change that did not pay doubles the patience up to this
  real(dp), parameter :: stiff_start = 250.0_dp  !! damping rate times the span from which Radau begins at once, and
  real(dp), parameter :: start_price = 1.3_dp  !! what Adams is then taken to cost, in evaluations per 1/damping rate
  real(dp), parameter :: step_overhead = 5     !! of a Radau step, Jacobian and algebra, in evaluations

  type, extends(ode_method_t) :: auto_t
    private
    type(adams_t) :: adams
    type(radau_t) :: radau
    logical :: stiff = .false.                 !! Radau is at work
    logical, allocatable :: stiff_in(:)        !! the mode ended with Radau; this and what follows (0:highest mode)
    logical, allocatable :: known(:)           !! the mode has begun before
    integer :: mode = 0                        !! of the present phase
    integer :: bound = 0                       !! steps of Adams bound by stability, more than not
    integer, allocatable :: patience(:)
    real(dp) :: adams_price = 0                !! evaluations per time of Adams while it was bound
    real(dp) :: stiffness_then = 0             !! bound of the fastest mode's rate at that time; the price goes with it
    integer :: evaluations_then = 0            !! evaluations when Adams came to be bound, and
    real(dp) :: time_then = 0                  !! when that was
    integer, allocatable :: trial(:)           !! steps of Radau in each mode since it took over
    real(dp), allocatable :: spent(:)          !! what it has cost in each mode, in evaluations
    real(dp), allocatable :: saved(:)          !! what Adams would have cost instead
  contains
    procedure :: start
    procedure :: step
    procedure :: interpolate
    procedure :: land_on
    procedure :: count_time
    procedure :: totals
    procedure :: exchange
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
      call forget_modes(self, problem%highest_mode)
      self%stiff = .false.
      self%adams%settings = self%settings
      self%radau%settings = self%settings
      call self%radau%prepare(problem)
      call self%adams%prepare(problem)
    end if
    self%mode = problem%mode
    if (.not. self%known(self%mode)) call look_ahead(self, problem, t, y)
    call begin_with(self, problem, self%stiff_in(self%mode), t, y, first, status)
  end subroutine start

  !> Nothing is known of any mode.
  pure subroutine forget_modes(self, highest)
    class(auto_t), intent(inout) :: self
    integer, intent(in) :: highest
    if (allocated(self%known)) deallocate (self%stiff_in, self%known, self%patience, self%trial, self%spent, self%saved, &
      self%time_with)
    allocate (self%stiff_in(0:highest), self%known(0:highest), source=.false.)
    allocate (self%patience(0:highest), source=first_patience)
    allocate (self%trial(0:highest), source=0)
    allocate (self%spent(0:highest), self%saved(0:highest), source=0.0_dp)
    allocate (self%time_with(2, 0:highest), source=0.0_dp)
  end subroutine forget_modes

  !> Both methods and the account that is kept of them.
  subroutine exchange(self, problem, archive)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    type(archive_t), intent(inout) :: archive
    self%adams%settings = self%settings
    self%radau%settings = self%settings
    if (archive%is_reading) call forget_modes(self, problem%highest_mode)
    call self%exchange_solution(problem, archive)
    call self%adams%exchange(problem, archive)
    call self%radau%exchange(problem, archive)
    call archive%exchange(self%stiff)
    call archive%exchange(self%stiff_in)
    call archive%exchange(self%known)
    call archive%exchange(self%mode)
    call archive%exchange(self%bound)
    call archive%exchange(self%patience)
    call archive%exchange(self%adams_price)
    call archive%exchange(self%stiffness_then)
    call archive%exchange(self%evaluations_then)
    call archive%exchange(self%time_then)
    call archive%exchange(self%trial)
    call archive%exchange(self%spent)
    call archive%exchange(self%saved)
    call archive%exchange(self%time_with)
  end subroutine exchange

  !> A mode that begins for the first time: whether it is stiff beyond doubt.
  subroutine look_ahead(self, problem, t, y)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    real(dp) :: rate
    self%known(self%mode) = .true.
    if (problem%n_positions + problem%n_states() == 0) return
    call self%radau%damping_rate(problem, t, y, rate)
    self%stiff_in(self%mode) = rate*self%settings%span > stiff_start
    self%adams_price = start_price*rate
    self%stiffness_then = rate
  end subroutine look_ahead

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
    integer :: bound_before, evaluations_before

    status = step_done
    if (self%stiff) then
      if (radau_is_dearer(self)) then
        self%patience(self%mode) = min(2*self%patience(self%mode), most_patience)
        call change_over(self, problem, .false., status)
      end if
    else if (self%bound >= self%patience(self%mode)) then
      self%adams_price = (self%adams%statistics%evaluations - self%evaluations_then) &
        /max(self%t - self%time_then, tiny(1.0_dp))
      self%stiffness_then = 0
      self%trial(self%mode) = 0
      call change_over(self, problem, .true., status)
    end if
    if (status /= step_done) return

    if (self%stiff) then
      evaluations_before = self%radau%statistics%evaluations
      call self%radau%step(problem, status)
      if (status /= step_done) return
      call take_over(self, self%radau)
      call keep_account(self, self%radau%statistics%evaluations - evaluations_before)
    else
      bound_before = self%adams%statistics%limited_by(limit_stability)
      self%adams%rough_time = self%rough_time
      call self%adams%step(problem, status)
      if (status == step_done) call take_over(self, self%adams)
      if (self%adams%statistics%limited_by(limit_stability) > bound_before) then
        if (self%bound == 0) then
          self%evaluations_then = self%adams%statistics%evaluations
          self%time_then = self%t
        end if
        self%bound = self%bound + 1
      else
        self%bound = max(0, self%bound - 1)
      end if
    end if
  end subroutine step

  !> Enter a step of Radau into the account of its mode.
  subroutine keep_account(self, evaluations)
    class(auto_t), intent(inout) :: self
    integer, intent(in) :: evaluations
    real(dp) :: stiffness
    stiffness = self%radau%spectral_bound()
    if (.not. self%stiffness_then > 0) self%stiffness_then = stiffness
    associate (mode => self%mode)
      self%trial(mode) = self%trial(mode) + 1
      self%spent(mode) = self%spent(mode) + evaluations + step_overhead
      if (self%stiffness_then > 0) self%saved(mode) = self%saved(mode) &
        + self%adams_price*(stiffness/self%stiffness_then)*(self%t - self%t_old)
    end associate
  end subroutine keep_account

  !> Whether Radau has cost more in the present mode than Adams would have; not asked before a number of steps, a smaller
  !> number where it is much more.
  pure logical function radau_is_dearer(self)
    class(auto_t), intent(in) :: self
    associate (mode => self%mode)
      radau_is_dearer = self%trial(mode) >= trial_steps .and. self%spent(mode) > fair_trial*self%saved(mode) &
        .or. self%trial(mode) >= bad_trial_steps .and. self%spent(mode) > bad_trial*self%saved(mode)
    end associate
  end function radau_is_dearer

  !> Go on with the other method from where we are.
  subroutine change_over(self, problem, stiff, status)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    logical, intent(in) :: stiff
    integer, intent(out) :: status
    type(step_statistics_t) :: so_far
    self%stiff_in(self%mode) = stiff
    self%adams%goes_on = .true.
    call begin_with(self, problem, stiff, self%t, self%y, .false., status)
    self%adams%goes_on = .false.
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
    class(ode_method_t), intent(in) :: method
    self%t = method%t
    self%t_old = method%t_old
    self%order = method%order
    self%y = method%y
    self%y_old = method%y_old
    self%statistics%accepted = method%statistics%accepted
    self%statistics%evaluations = method%statistics%evaluations
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

  subroutine land_on(self, problem, t, y)
    class(auto_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    if (self%stiff) then
      call self%radau%land_on(problem, t, y)
    else
      call self%adams%land_on(problem, t, y)
    end if
  end subroutine land_on

  !> The time of the last step goes to the method that took it, in the mode in which it was taken.
  subroutine count_time(self, t_to)
    class(auto_t), intent(inout) :: self
    real(dp), intent(in) :: t_to
    integer :: which
    which = merge(with_radau, with_adams, self%stiff)
    self%time_with(which, self%mode) = self%time_with(which, self%mode) + (t_to - self%t_old)
    if (self%stiff) then
      call self%radau%count_time(t_to)
    else
      call self%adams%count_time(t_to)
    end if
  end subroutine count_time

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
