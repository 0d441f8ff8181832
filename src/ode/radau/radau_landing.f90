!> Landing of Radau on an instant inside its last step.
submodule (radau) radau_landing
  use ode_method, only: start_again
  use collocation, only: guess_none, guess_within
  implicit none

  !> Largest defect of a landing, in tolerances. Newton's method leaves one of h lambda times its own remainder (lambda: rate of the
  !> fastest mode), in stiff films up to ten tolerances. Where the Jacobian is far stiffer than the force (friction that gives way
  !> within a narrow range of speeds), Newton steps are small although the equations are not solved: the defect is then hundreds
  !> of tolerances.
  real(dp), parameter :: largest_defect = 10
contains

  module procedure land_on
    integer :: level, try, outcome

    call self%interpolate(t, y)
    landed = .true.
    if (self%stages%stages_done == 0 .or. .not. t > self%t_old) return
    level = self%stages%level
    self%stages%level = self%stages%stages_done/2
    call set_out(self, self%t_old, self%y_old, t - self%t_old)
    self%stages%goal = landing_goal(self)
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

  module procedure landing_goal   ! 3 % of the tolerance itself
    landing_goal = min(newton_goal(self), max(10*epsilon(1.0_dp), 0.03_dp*self%nominal_tolerance())/inner(self))
  end procedure landing_goal

  !> Tolerance of the error estimate.
  pure real(dp) function inner(self)
    class(radau_t), intent(in) :: self
    inner = inner_tolerance(working_tolerance(self), self%stages%stages())
  end function inner

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

  !> Whether the stages of a trial that ends at t solve the equations, and its error estimate is within the tolerance.
  subroutine check_landing(self, problem, t, landed)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t
    logical, intent(out) :: landed
    real(dp) :: error
    self%y_try = self%y_old + self%stages%z_new(:, self%stages%stages())
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t, self%y_try, self%f_new, landed)
    if (landed) landed = solves_equations(self)
    if (.not. landed) return
    call self%stages%settle_quadratures(problem, self%f_new)
    call collect(self)
    call estimate_error(self, problem, self%t_old, self%y_old, self%f_old, .true., error)
    landed = error < 1
  end subroutine check_landing

  module procedure solves_equations
    call self%stages%end_defect(self%f_new, self%error)
    solves_equations = scaled_norm(self, self%error)*inner(self) <= largest_defect*self%nominal_tolerance()
  end procedure solves_equations

  module procedure withdraw
    associate (count => self%statistics, level => self%stages%stages_done/2)
      count%accepted = count%accepted - 1
      count%stage_count(level) = count%stage_count(level) - 1
      count%rejected_convergence = count%rejected_convergence + 1
    end associate
    call start_again(self, problem, longest, status)
    self%careful_until = self%t + 4*longest
  end procedure withdraw
end submodule radau_landing
