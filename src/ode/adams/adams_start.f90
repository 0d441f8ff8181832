!> Start of the Adams method: allocation, the first step of order 1, or a given history.
submodule (adams) adams_start
  use ode_method, only: start_outside, step_statistics_t
  use adams_coefficients, only: moulton_constants
  use adams_differences, only: lanes, differences_of
  use step_norms, only: norm
  implicit none
contains

  module procedure start
    logical :: in_domain

    if (first .or. .not. allocated(self%phi)) call prepare(self, problem)
    self%t = t
    self%t_old = t
    self%y = y
    self%y_old = y
    self%order = 0
    self%closed = .false.
    self%carry = 0
    self%rooted = problem%smooth_in_root .and. .not. self%goes_on
    self%t_origin = t
    self%x = merge(0.0_dp, t, self%rooted)
    self%x_old = self%x
    self%statistics%evaluations = self%statistics%evaluations + 1
    if (.not. first) self%statistics%restarts = self%statistics%restarts + 1
    call problem%derivatives(t, self%y, self%f_new, in_domain)
    status = merge(step_done, start_outside, in_domain)
    if (.not. in_domain) return

    self%k = 1
    self%k_old = 0
    self%h_old = 0
    self%opening = .true.
    self%rejected = .false.
    call self%coefficients%reset()
    self%phi = 0
    self%owed = 0
    self%f = 0
    if (.not. self%rooted) self%f = self%f_new
    self%phi(:self%n, 1) = self%f
    call weigh(self)
    call choose_first_step(self, problem)
    self%limit = limit_start
  end procedure start

  module procedure start_with_history
    integer :: m

    m = size(x)
    call self%start(problem, x(m), y, .true., status)
    if (status /= step_done) return
    call differences_of(x, f(:self%n, :), self%phi(:self%n, :m), self%coefficients%psi(:m - 1))
    self%k = m
    self%k_old = m - 1
    self%h_old = self%coefficients%psi(1)
    self%h = h
    self%opening = .false.
  end procedure start_with_history

  module procedure prepare
    integer :: n, width
    n = problem%n
    self%n = n
    self%blocks = (n + lanes - 1)/lanes
    width = lanes*self%blocks
    self%moulton = moulton_constants()
    self%statistics = step_statistics_t()
    if (allocated(self%phi)) deallocate (self%phi, self%owed, self%closing, self%slope, self%f, self%predicted, &
      self%f_predicted, self%f_new, self%y_new, self%inverse_weight, self%carry, self%carry_new, self%y, self%y_old)
    allocate (self%phi(width, highest_order + 2), self%owed(width), self%closing(width), self%slope(width), source=0.0_dp)
    allocate (self%f(n), self%predicted(n), self%f_predicted(n), self%f_new(n), self%y_new(n), self%inverse_weight(n), &
      self%carry(n), self%carry_new(n), self%y(n), self%y_old(n))
  end procedure prepare

  !> Choose the first step so that the error of order 1, h^2 |y''|/2, is a quarter of the tolerance. y'' is estimated by an Euler
  !> step that is short, but not shorter than the time resolves (Hairer, Norsett & Wanner 1993, II.4).
  subroutine choose_first_step(self, problem)
    class(adams_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    real(dp) :: longest, h, slope, curvature, resolution
    logical :: in_domain
    integer :: tries

    longest = min(self%settings%max_step, self%settings%first_step, self%settings%span)
    if (self%settings%fixed_step > 0) then
      self%h = self%settings%fixed_step
      return
    end if
    slope = norm(self%n, self%f_new, self%inverse_weight)
    h = longest*1e-3_dp
    if (slope*h > 1) h = 1/slope
    resolution = epsilon(h)*max(abs(self%t), 1e-9_dp*self%settings%span)
    if (h < 10*resolution) h = 1e4_dp*resolution
    do tries = 1, 60
      self%predicted = self%y + h*self%f_new
      self%statistics%evaluations = self%statistics%evaluations + 1
      call problem%derivatives(self%t + h, self%predicted, self%f_predicted, in_domain)
      if (in_domain) exit
      h = 0.1_dp*h
    end do
    curvature = 0
    if (in_domain .and. self%rooted) then   ! with respect to x, y'' is 2 f at the start
      curvature = 2*norm(self%n, self%f_predicted, self%inverse_weight)
    else if (in_domain) then
      self%f_predicted = self%f_predicted - self%f_new
      curvature = norm(self%n, self%f_predicted, self%inverse_weight)/h
    end if
    if (self%rooted) then
      longest = sqrt(longest)
      h = sqrt(h)
    end if
    if (curvature > 0) then
      self%h = min(sqrt(0.5_dp/curvature), 100*h, longest)
    else
      self%h = min(100*h, longest)
    end if
  end subroutine choose_first_step
end submodule adams_start
