!> Start of Radau: allocation, first formula and first step.
submodule (radau) radau_start
  use ode_method, only: start_outside, step_statistics_t
  implicit none
contains

  module procedure start
    logical :: in_domain

    if (first .or. .not. allocated(self%error)) call prepare(self, problem)
    if (first) self%statistics = step_statistics_t()
    self%t = t
    self%t_old = t
    self%y = y
    self%y_old = y
    self%order = 0
    self%statistics%evaluations = self%statistics%evaluations + 1
    if (.not. first) self%statistics%restarts = self%statistics%restarts + 1
    call problem%derivatives(t, self%y, self%f, in_domain)
    status = merge(step_done, start_outside, in_domain)
    if (.not. in_domain) return
    self%stages%stages_done = 0
    self%first = .true.
    self%rejected = .false.
    self%fresh_jacobian = .false.
    self%since_change = 0
    self%cautious = 0
    self%stages%level = first_level(self)
    call weigh(self)
    call choose_first_step(self, problem)
  end procedure start

  module procedure prepare
    integer :: n

    call self%stages%prepare(problem)
    call set_tolerances(self)
    n = problem%n
    self%highest = 1
    if (self%settings%max_order >= 9) self%highest = 2
    if (self%settings%max_order >= 12) self%highest = 3
    if (allocated(self%error)) deallocate (self%y_try, self%y_new, self%f_new, self%error, self%y, self%y_old, self%f, self%f_old)
    allocate (self%y_try(n), self%y_new(n), self%f_new(n), self%error(n), self%y(n), self%y_old(n), self%f(n), self%f_old(n))
  end procedure prepare

  module procedure first_level
    real(dp) :: tolerance
    tolerance = working_tolerance(self)
    first_level = 2
    if (tolerance > 1e-4_dp) first_level = 1
    if (tolerance < tight_tolerance) first_level = 3
    first_level = min(first_level, self%highest)
  end procedure first_level

  !> The tolerance used: at most `loosest`. With larger ones the errors of the stages make Newton's method alternate between both
  !> sides of a kink of a film's force, and the cost increases (data/manual/choices.md).
  pure real(dp) function working_tolerance(self)
    class(radau_t), intent(in) :: self
    real(dp), parameter :: loosest = 1e-3_dp
    working_tolerance = min(self%nominal_tolerance(), loosest)
  end function working_tolerance

  !> Tolerances of each formula. For s stages the error estimate is of order s and the formula of order 2s-1; the tolerance of the
  !> estimate is therefore 0.1 tolerance^((s+1)/2s) (Hairer & Wanner). In a stiff film this order is not reached, which matters at
  !> tight tolerances: there the exponent is at least 3/4, which keeps the error of the smooth simulations near the tolerance. The
  !> required remainder of Newton's iteration is six times that of Hairer & Wanner, who estimate it from the steps alone
  !> (data/manual/choices.md).
  pure subroutine set_tolerances(self)
    class(radau_t), intent(inout) :: self
    real(dp) :: tolerance, exponent_of, s
    integer :: i
    tolerance = working_tolerance(self)
    do i = 1, n_formulas
      s = self%stages%formula(i)%stages
      exponent_of = (s + 1)/(2*s)
      if (tolerance < tight_tolerance) exponent_of = max(exponent_of, 0.75_dp)
      self%inner_tolerance(i) = 0.1_dp*tolerance**exponent_of
      self%newton_goal(i) = min(0.1_dp, 6*self%inner_tolerance(i)**(2*s/(s + 1) - 1))
    end do
  end subroutine set_tolerances

  !> First step from the norms of y, y' and y'' (Hairer, Norsett & Wanner 1993, II.4).
  subroutine choose_first_step(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp) :: longest, h, size_y, slope, curvature
    logical :: in_domain
    integer :: tries, order

    order = self%stages%stages()
    longest = min(self%settings%max_step, self%settings%first_step, self%settings%span)
    size_y = min(scaled_norm(self, self%y), 1/self%inner_tolerance(self%stages%level))  ! without unbounded components
    slope = scaled_norm(self, self%f(:size(self%y)))
    h = 1e-6_dp*longest
    if (slope > 0 .and. size_y > 0) h = min(0.01_dp*size_y/slope, longest)
    do tries = 1, 60
      self%y_try = self%y + h*self%f(:size(self%y))
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + h, self%y_try, self%f_new, in_domain)
      if (in_domain) exit
      h = 0.1_dp*h
    end do
    curvature = 0
    if (in_domain) curvature = scaled_norm(self, self%f_new(:size(self%y)) - self%f(:size(self%y)))/h
    self%h = 100*h
    if (max(slope, curvature) > 0) self%h = min(self%h, (0.01_dp/max(slope, curvature))**(1.0_dp/(order + 1)))
    self%h = min(self%h, longest)
  end subroutine choose_first_step
end submodule radau_start
