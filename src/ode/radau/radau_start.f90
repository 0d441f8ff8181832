!> Start of Radau: allocation, first formula and first step.
submodule (radau) radau_start
  use ode_method, only: start_outside, step_statistics_t
  implicit none
contains

  module procedure start
    logical :: inside

    if (first .or. .not. allocated(self%error)) call prepare(self, problem)
    if (first) self%statistics = step_statistics_t()
    self%t = t
    self%t_old = t
    self%y = y
    self%y_old = y
    self%order = 0
    self%statistics%evaluations = self%statistics%evaluations + 1
    if (.not. first) self%statistics%restarts = self%statistics%restarts + 1
    call problem%derivatives(t, self%y, self%f, inside)
    status = merge(step_done, start_outside, inside)
    if (.not. inside) return
    self%stages%stages_done = 0
    self%first = .true.
    self%failed = .false.
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
    n = problem%n
    self%highest = 1
    if (self%settings%max_order >= 9) self%highest = 2
    if (self%settings%max_order >= 12) self%highest = 3
    if (allocated(self%error)) deallocate (self%y_try, self%y_new, self%f_new, self%error, self%y, self%y_old, self%f, self%f_old)
    allocate (self%y_try(n), self%y_new(n), self%f_new(n), self%error(n), self%y(n), self%y_old(n), self%f(n), self%f_old(n))
  end procedure prepare

  module procedure exchange
    if (archive%is_reading) call prepare(self, problem)
    call self%exchange_solution(problem, archive)
    call archive%exchange(self%f)
    call self%stages%exchange(archive)
    call archive%exchange(self%h)
    call archive%exchange(self%h_last)
    call archive%exchange(self%error_done)
    call archive%exchange(self%since_change)
    call archive%exchange(self%fresh_jacobian)
    call archive%exchange(self%failed)
    call archive%exchange(self%cautious)
    call archive%exchange(self%first)
  end procedure exchange

  module procedure first_level
    real(dp) :: tolerance
    tolerance = working_tolerance(self)
    first_level = 2
    if (tolerance > 1e-4_dp) first_level = 1
    if (tolerance < tight_tolerance) first_level = 3
    first_level = min(first_level, self%highest)
  end procedure first_level

  module procedure working_tolerance
    real(dp), parameter :: loosest = 1e-3_dp
    working_tolerance = min(self%nominal_tolerance(), loosest)
  end procedure working_tolerance

  module procedure inner_tolerance
    real(dp) :: tolerance, exponent_of
    integer :: stages
    tolerance = working_tolerance(self)
    stages = self%stages%stages()
    exponent_of = (stages + 1)/(2.0_dp*stages)
    if (tolerance < tight_tolerance) exponent_of = max(exponent_of, 0.75_dp)
    inner_tolerance = 0.1_dp*tolerance**exponent_of
  end procedure inner_tolerance

  !> First step from the norms of y, y' and y'' (Hairer, Norsett & Wanner 1993, II.4).
  subroutine choose_first_step(self, problem)
    class(radau_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp) :: longest, h, size_y, slope, curvature
    logical :: inside
    integer :: tries, order

    order = self%stages%stages()
    longest = min(self%settings%max_step, self%settings%first_step, self%settings%span)
    size_y = min(scaled_norm(self, self%y), 1/inner_tolerance(self))  ! without unbounded components
    slope = scaled_norm(self, self%f(:size(self%y)))
    h = 1e-6_dp*longest
    if (slope > 0 .and. size_y > 0) h = min(0.01_dp*size_y/slope, longest)
    do tries = 1, 60
      self%y_try = self%y + h*self%f(:size(self%y))
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + h, self%y_try, self%f_new, inside)
      if (inside) exit
      h = 0.1_dp*h
    end do
    curvature = 0
    if (inside) curvature = scaled_norm(self, self%f_new(:size(self%y)) - self%f(:size(self%y)))/h
    self%h = 100*h
    if (max(slope, curvature) > 0) self%h = min(self%h, (0.01_dp/max(slope, curvature))**(1.0_dp/(order + 1)))
    self%h = min(self%h, longest)
  end subroutine choose_first_step
end submodule radau_start
