!> Error control of the Adams method: error estimates, order and size of the next step, limits of the last step.
submodule (adams) adams_control
  use ode_method, only: limit_error, limit_stability, limit_max_step, limit_refusal
  use adams_coefficients, only: stability_limit
  use adams_differences, only: lanes, restore_differences
  use step_norms, only: square_of_sum
  implicit none

  !> Factor of the squared error at each order if the step is doubled or raised by a quarter.
  integer, parameter :: powers(highest_order) = 2*[2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13]
  real(dp), parameter :: doubled(highest_order) = 2.0_dp**powers, raised(highest_order) = 1.25_dp**powers

  real(dp), parameter :: per_limit_square(highest_order) = 1/stability_limit**2

contains

  module procedure weigh
    real(dp) :: square
    call weigh_components(self%n, self%settings%relative, self%settings%absolute, self%y, self%inverse_weight, square)
    self%rounding_square = epsilon(1.0_dp)**2*square
  end procedure weigh

  !> 1/(relative |y| + absolute), 0 where the denominator is zero, and the square of the norm of y with these weights.
  pure subroutine weigh_components(n, relative, absolute, y, inverse_weight, square)
    integer, intent(in) :: n
    real(dp), intent(in) :: relative(n), absolute(n), y(n)
    real(dp), intent(out) :: inverse_weight(n), square
    real(dp) :: weight
    integer :: i
    square = 0
    !GCC$ novector
    do i = 1, n
      weight = relative(i)*abs(y(i)) + absolute(i)
      if (weight > 0) weight = 1/weight
      inverse_weight(i) = weight
      square = square + (y(i)*weight)**2
    end do
  end subroutine weigh_components

  module procedure clock_step
    clock_step = dt
    if (self%rooted) clock_step = dt/(sqrt(self%x**2 + dt) + self%x)
  end procedure clock_step

  !> Duration of the next step.
  pure real(dp) function time_step(self)
    class(adams_t), intent(in) :: self
    time_step = merge(self%h*(2*self%x + self%h), self%h, self%rooted)
  end function time_step

  module procedure retreat
    real(dp) :: factor

    call restore_differences(lanes*self%blocks, self%k, self%coefficients%beta, self%coefficients%beta_next, self%phi)
    call self%coefficients%undo_update(self%h, self%k)
    self%opening = .false.
    factor = fraction
    select case (outcome)
    case (try_error)
      self%limit = limit_error
      self%statistics%rejected_error = self%statistics%rejected_error + 1
      self%failures = self%failures + 1
      factor = 0.5_dp
      if (self%failures > 3 .and. errors%same > 2**2) factor = (0.5_dp**2/errors%same)**0.25_dp
      self%k = merge(1, errors%order, self%failures >= 3)
    case (try_too_deep)
      self%limit = limit_refusal
      self%statistics%rejected_penetration = self%statistics%rejected_penetration + 1
    case (try_too_far)
      self%limit = limit_refusal
      self%statistics%rejected_error = self%statistics%rejected_error + 1
    case default
      self%limit = limit_refusal
      self%statistics%rejected_domain = self%statistics%rejected_domain + 1
      self%failures = self%failures + 1
      if (self%failures >= 3) self%k = 1
    end select
    self%h = factor*self%h
  end procedure retreat

  module procedure estimate_errors
    integer :: k

    k = self%k
    associate (g => self%coefficients%g, sigma => self%coefficients%sigma, gamma => self%moulton)
      errors%step = (self%h*(g(k) - g(k + 1)))**2*squares(1)
      errors%same = (self%h*sigma(k + 1)*gamma(k))**2*squares(1)
      errors%correction = (self%h*g(k + 1))**2*squares(1)
      errors%order = k
      if (k >= 2) errors%lower = (self%h*sigma(k)*gamma(k - 1))**2*squares(2)
      if (k >= 3) errors%lowest = (self%h*sigma(k - 1)*gamma(k - 2))**2*squares(3)
    end associate
    if (k == 2 .and. errors%lower <= 0.5_dp**2*errors%same) errors%order = k - 1
    if (k >= 3 .and. max(errors%lower, errors%lowest) <= errors%same) errors%order = k - 1
  end procedure estimate_errors

  module procedure shorten_before_kink
    real(dp), parameter :: share = 1/6.0_dp   !! largest fraction of the remaining time in one step
    real(dp) :: way
    if (.not. self%next_kink_time < huge(1.0_dp) .or. self%settings%fixed_step > 0) return
    if (time_step(self) <= share**2*(self%next_kink_time - self%t)) return   ! far from that instant; decided without a square root
    way = clock_step(self, self%next_kink_time - self%t)
    if (self%h > share*way .and. self%h < 2*way) self%h = max(share*way, 0.5_dp*self%h)
  end procedure shorten_before_kink

  module procedure count_limit
    real(dp), parameter :: noise = 100
    real(dp) :: reach, near, slow, path   ! all squared
    integer :: limit
    reach = 0
    if (errors%correction > max(noise**2*self%rounding_square, tiny(reach))) &
      reach = self%h**2*(errors%change/errors%correction)
    self%stiffness_done = sqrt(reach)
    near = reach*per_limit_square(self%k)
    limit = self%limit
    self%bound = .false.
    if (near > 0.3_dp**2) then
      slow = 0   ! norm below which the solution counts as not moving: five tolerances
      path = square_of_sum(self%n, self%y_new, -1.0_dp, self%y, self%inverse_weight)
      if (path >= 5**2) slow = self%h**2 &
        *square_of_sum(self%n, self%f_new, -1.0_dp, self%f, self%inverse_weight)/(path*reach)
      self%bound = slow < 0.6_dp**2
      if (limit == limit_error .and. near > 0.5_dp**2 .and. slow < 0.3_dp**2) limit = limit_stability
    end if
    self%limit_done = limit
    self%statistics%limited_by(limit) = self%statistics%limited_by(limit) + 1
  end procedure count_limit

  module procedure choose_order_and_step
    real(dp) :: error, higher   ! squared
    real(dp) :: factor
    integer :: k

    k = self%k
    error = errors%same
    if (self%settings%fixed_step > 0) then
      self%k = min(k + 1, self%settings%max_order)
      return
    end if
    if (errors%order < k .or. k >= self%settings%max_order) self%opening = .false.
    if (self%opening) then
      self%k = k + 1
      self%limit = limit_start
      factor = (0.1_dp**2/max(errors%same, tiny(1.0_dp)))**(0.5_dp/(k + 1))
      call grow(self, max(2.0_dp, min(64.0_dp, factor)))
      return
    end if
    if (errors%order < k) then
      self%k = k - 1
      error = errors%lower
    else if (self%higher_known) then
      higher = (self%h*self%coefficients%sigma_next*self%moulton(k + 1))**2 &
        *square_of_sum(self%n, self%phi(:, k + 2), 1.0_dp, self%owed, self%inverse_weight)
      if (k == 1) then
        if (higher < 0.5_dp**2*error .and. k < self%settings%max_order) self%k = 2
      else if (errors%lower <= min(error, higher)) then
        self%k = k - 1
        error = errors%lower
      else if (higher < error .and. k < self%settings%max_order) then
        self%k = k + 1
      end if
      if (self%k > k) error = higher
    end if

    if (0.5_dp**2 >= error*doubled(self%k)) then
      factor = 2
    else if (0.5_dp**2 >= error*raised(self%k) .and. self%coefficients%ns > 1) then
      factor = 1.25_dp
    else if (0.5_dp**2 >= error) then
      factor = 1
    else
      factor = max(0.5_dp, min(0.9_dp, (0.5_dp**2/error)**(0.5_dp/(self%k + 1))))
    end if
    self%limit = limit_error
    call grow(self, factor)
  end procedure choose_order_and_step

  !> Multiply the step size, within the limits of the settings.
  pure subroutine grow(self, factor)
    class(adams_t), intent(inout) :: self
    real(dp), intent(in) :: factor
    self%h = factor*self%h
    if (time_step(self) < self%settings%max_step) return
    self%h = clock_step(self, self%settings%max_step)
    self%limit = limit_max_step
  end subroutine grow
end submodule adams_control
