!> Error control of Radau: weights, error estimate, size and formula of the next step.
submodule (radau) radau_control
  use collocation, only: most_iterations
  implicit none
contains

  module procedure weigh
    real(dp) :: factor, weight
    integer :: i
    factor = self%inner_tolerance(self%stages%level)/self%nominal_tolerance()
    self%weighted = 0
    do i = 1, size(self%y)
      weight = factor*(self%settings%relative(i)*abs(self%y(i)) + self%settings%absolute(i))
      self%stages%inverse_weight(i) = 0
      if (.not. weight > 0) cycle
      self%stages%inverse_weight(i) = 1/weight
      self%weighted = self%weighted + 1
    end do
    self%weighted = max(1, self%weighted)
  end procedure weigh

  module procedure scaled_norm
    scaled_norm = sqrt(sum((x*self%stages%inverse_weight)**2)/self%weighted)
  end procedure scaled_norm

  module procedure set_out
    self%stages%t = t
    self%stages%base = y
    self%stages%h = h
    self%stages%rounding = 10*epsilon(1.0_dp)/self%inner_tolerance(self%stages%level)
    self%stages%goal = max(self%stages%rounding, self%newton_goal(self%stages%level))
  end procedure set_out

  module procedure collect
    self%statistics%evaluations = self%statistics%evaluations + self%stages%evaluations
    self%stages%evaluations = 0
  end procedure collect

  module procedure estimate_error
    real(dp), parameter :: farthest = 1e30_dp   !! largest state for which the right-hand side is evaluated, in tolerances
    logical :: in_domain

    call self%stages%filtered_error(f, self%error)
    error = scaled_norm(self, self%error)
    if (error < 1 .or. .not. may_repeat .or. .not. error < farthest) return
    self%y_try = y + self%error
    self%statistics%evaluations = self%statistics%evaluations + 1
    call problem%derivatives(t, self%y_try, self%f_new, in_domain)
    if (.not. in_domain) return
    call self%stages%filtered_error(self%f_new, self%error)
    error = scaled_norm(self, self%error)
  end procedure estimate_error

  module procedure retreat
    real(dp) :: factor

    factor = 0.5_dp
    select case (outcome)
    case (try_error)
      self%statistics%rejected_error = self%statistics%rejected_error + 1
      factor = step_factor(self, error)
      if (self%first) factor = 0.1_dp
    case (try_too_deep)
      self%statistics%rejected_penetration = self%statistics%rejected_penetration + 1
      factor = fraction
    case (try_too_far)
      self%statistics%rejected_error = self%statistics%rejected_error + 1
      factor = fraction
    case (try_outside)
      self%statistics%rejected_domain = self%statistics%rejected_domain + 1
    case default
      self%statistics%rejected_convergence = self%statistics%rejected_convergence + 1
      self%since_change = 0
      if (self%stages%contraction > 0.8_dp .and. .not. self%first) self%stages%level = max(1, self%stages%level - 1)
    end select
    if (all(outcome /= [try_error, try_too_deep, try_too_far])) self%cautious = cautious_steps
    self%rejected = .true.
    self%h = factor*self%h
    call weigh(self)
  end procedure retreat

  !> Factor of the step size from the error, reduced if Newton's method needed many iterations.
  pure real(dp) function step_factor(self, error)
    class(radau_t), intent(in) :: self
    real(dp), intent(in) :: error
    real(dp) :: margin
    integer :: s
    s = self%stages%stages()
    margin = safety*min(1.0_dp, (2*most_iterations + 1.0_dp)/(2*most_iterations + self%stages%iterations))
    step_factor = margin/root(max(error, 1e-30_dp), s + 1)
    step_factor = min(largest_growth, max(1/largest_cut, step_factor))
  end function step_factor

  !> x**(1/n); for n = 4 by square roots, which cost less than a power.
  pure real(dp) function root(x, n)
    real(dp), intent(in) :: x
    integer, intent(in) :: n
    if (n == 4) then
      root = sqrt(sqrt(x))
    else
      root = x**(1.0_dp/n)
    end if
  end function root

  module procedure choose_step
    real(dp) :: factor, predicted
    integer :: s

    s = self%stages%stages()
    factor = step_factor(self, error)
    if (.not. self%first .and. error > 0) then
      predicted = safety*(self%h/self%h_last)*root(self%error_done/error**2, s + 1)
      factor = min(factor, max(1/largest_cut, predicted))
    end if
    if (self%rejected) factor = min(factor, 1.0_dp)
    if (self%cautious > 0) factor = min(factor, cautious_growth)
    self%cautious = max(0, self%cautious - 1)
    self%h_last = self%h
    self%error_done = max(error, 1e-2_dp)
    self%first = .false.
    self%rejected = .false.
    self%h = min(factor*self%h, self%settings%max_step)
  end procedure choose_step

  module procedure choose_formula
    real(dp), parameter :: raise_below = 2e-3_dp, lower_above = 0.8_dp
    integer, parameter :: steps_between_changes = 10

    self%since_change = self%since_change + 1
    if (self%since_change < steps_between_changes) return
    if (self%stages%contraction < raise_below .and. self%stages%level < first_level(self)) then
      self%stages%level = self%stages%level + 1
    else if (self%stages%contraction > lower_above .and. self%stages%level > 1) then
      self%stages%level = self%stages%level - 1
    else
      return
    end if
    self%since_change = 0
  end procedure choose_formula
end submodule radau_control
