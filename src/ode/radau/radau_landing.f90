!> Landing of Radau on an instant inside its last step.
submodule (radau) radau_landing
  use ode_method, only: start_again
  use collocation, only: guess_none, guess_within
  implicit none

contains

  module procedure land_on
    integer :: level, try, outcome

    call self%interpolate(t, y)
    landed = .true.
    if (self%stages%stages_done == 0 .or. .not. t > self%t_old) return
    level = self%stages%level
    self%stages%level = self%stages%stages_done/2
    call set_out(self, self%t_old, self%y_old, t - self%t_old)
    self%stages%goal = min(self%stages%goal, max(self%stages%rounding, & ! 3 % of the tolerance itself
      0.03_dp*self%nominal_tolerance()/self%inner_tolerance(self%stages%level)))
    do try = 1, 3
      call renew_jacobian(self, problem, try)
      call self%stages%solve_stages(problem, merge(guess_within, guess_none, try < 3), outcome)
      call collect(self)
      landed = .false.
      if (outcome == newton_converged) call check_landing(self, problem, t, landed)
      if (landed) exit
    end do
    if (landed) then
      call self%stages%keep()
      self%t = t
      self%y = self%y_old + self%stages%z(:, self%stages%stages())
      y = self%y
    end if
    self%stages%level = level
  end procedure land_on

  !> The Jacobian of a try to land: that of the last step, that at three quarters of the way, and that at its beginning.
  subroutine renew_jacobian(self, problem, try)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: try
    real(dp) :: t
    if (try == 1) return
    t = self%t_old
    self%y_try = self%y_old
    if (try == 2) then
      t = self%t_old + 0.75_dp*self%stages%h
      call self%interpolate(t, self%y_try)
    end if
    call problem%jacobian(t, self%y_try, self%stages%a_p, self%stages%a_v)
    self%statistics%jacobians = self%statistics%jacobians + 1
  end subroutine renew_jacobian

  !> Whether the error estimate of a trial that ends at t is within the tolerance.
  subroutine check_landing(self, problem, t, landed)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t
    logical, intent(out) :: landed
    real(dp) :: error
    self%y_try = self%y_old + self%stages%z_new(:, self%stages%stages())
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t, self%y_try, self%f_new, landed)
    if (.not. landed) return
    call self%stages%settle_quadratures(problem, self%f_new)
    call collect(self)
    call estimate_error(self, problem, self%t_old, self%y_old, self%f_old, .true., error)
    landed = error < 1
  end subroutine check_landing

  module procedure withdraw
    associate (count => self%statistics, level => self%stages%stages_done/2)
      count%accepted = count%accepted - 1
      count%stage_count(level) = count%stage_count(level) - 1
      count%rejected_convergence = count%rejected_convergence + 1
    end associate
    call start_again(self, problem, longest, status)
  end procedure withdraw
end submodule radau_landing
