!> Events of the scene with clearance: contact begins and ends, set-valued friction changes, the crank passes a bound of the gas.
submodule (clearance_scene) clearance_events
  use ode_problem, only: step_admitted, step_too_deep, event_continue
  use scene, only: event_none, event_contact_begins, event_contact_ends, n_gas_events
  implicit none

  !> Event functions of the integrator.
  integer, parameter :: begins = 1, ends = 2, sliding_changes = 3

contains

  module procedure all_events
    real(dp) :: contact(2)
    integer :: n
    n = self%n_joint_events
    if (n > 0) then
      contact = penetration_and_rate(self, y)
      if (self%phase == phase_contact) then
        g(begins) = -1
        g_rate(begins) = 0
        g(ends) = -contact(1)
        g_rate(ends) = -contact(2)
      else
        g(begins) = contact(1)
        g_rate(begins) = contact(2)
        g(ends) = -1
        g_rate(ends) = 0
      end if
      if (n >= sliding_changes) call find_sliding_change(self, t, y, g(sliding_changes), g_rate(sliding_changes))
    end if
    if (.not. allocated(self%gas)) return
    if (self%drive%free_crank) then
      call self%gas_events(y(self%crank%position), y(self%crank%rate), g(n + 1:n + n_gas_events), g_rate(n + 1:n + n_gas_events))
    else
      call self%gas_events(self%start_angle + self%start_speed*t, self%start_speed, g(n + 1:n + n_gas_events), &
        g_rate(n + 1:n + n_gas_events))
    end if
  end procedure all_events

  !> Event function of set-valued friction: the pin slips that stuck, or the sliding speed passes zero.
  pure subroutine find_sliding_change(self, t, y, g, g_rate)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: g, g_rate
    type(evaluation_t) :: now
    logical :: inside

    g = -1
    g_rate = 0
    if (self%phase /= phase_contact) return
    call self%evaluate(t, y, now, inside)
    if (.not. inside) return
    if (self%sliding == 0) then
      g = abs(now%friction_force) - sticking_limit(self, now%normal_force)
    else
      g = -self%sliding*now%joint%sliding_speed
      g_rate = -self%sliding*sliding_acceleration(self, now)
    end if
  end subroutine find_sliding_change

  module procedure sliding_acceleration
    associate (joint => now%joint, n => now%joint%normal, a => now%accelerations)
      sliding_acceleration = (n(1)*a%eccentricity(2) - n(2)*a%eccentricity(1)) &
        - joint%tangential_rate*joint%penetration_rate/joint%distance - a%rod*self%joint%pin_radius
    end associate
  end procedure sliding_acceleration

  !> Largest friction force that a set-valued law can give [N].
  pure real(dp) function sticking_limit(self, normal_force)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: normal_force
    sticking_limit = abs(self%friction%friction_ratio(0.0_dp, 1))*normal_force
  end function sticking_limit

  module procedure judge_step
    real(dp) :: left(2), right(2), lower, upper, middle
    integer :: i
    integer, parameter :: scan = 16

    verdict = step_admitted
    fraction = 1
    if (self%phase == phase_contact) return
    left = penetration_and_rate(self, y_old)
    right = penetration_and_rate(self, y)
    left(2) = left(2)*(t - t_old)
    right(2) = right(2)*(t - t_old)
    if (right(1) >= 0 .and. right(1) <= self%max_penetration) return
    lower = 0
    do i = 1, scan
      upper = real(i, dp)/scan
      if (hermite(left, right, upper) > merge(0.0_dp, self%max_penetration, right(1) < 0 .and. i < scan)) exit
      lower = upper
    end do
    if (i > scan) return
    verdict = step_too_deep
    do i = 1, 40   ! land half way into the allowed depth
      middle = 0.5_dp*(lower + upper)
      if (hermite(left, right, middle) < 0.5_dp*self%max_penetration) then
        lower = middle
      else
        upper = middle
      end if
    end do
    fraction = max(upper, 1e-3_dp)
  end procedure judge_step

  pure function penetration_and_rate(self, y) result(values)
    class(clearance_scene_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp) :: values(2), distance
    associate (x => y(self%pin%position), x_rate => y(self%pin%rate), &
               across => y(self%pin%position + 1), across_rate => y(self%pin%rate + 1))
      distance = sqrt(x**2 + across**2)
      values(1) = distance - self%joint%clearance
      values(2) = 0
      if (distance > 0) values(2) = (x*x_rate + across*across_rate)/distance
    end associate
  end function penetration_and_rate

  !> The cubic on [0, 1] with given values and slopes at the ends.
  pure real(dp) function hermite(left, right, s)
    real(dp), intent(in) :: left(2), right(2), s
    hermite = (1 + 2*s)*(1 - s)**2*left(1) + s*(1 - s)**2*left(2) + s**2*(3 - 2*s)*right(1) - s**2*(1 - s)*right(2)
  end function hermite

  module procedure lands_on_step_end
    lands_on_step_end = self%refuses_steps .and. index == begins .and. index <= self%n_joint_events
  end procedure lands_on_step_end

  module procedure rough_time
    real(dp) :: distance, product
    rough_time = huge(rough_time)
    if (self%phase /= phase_contact) return
    associate (x => y(self%pin%position), x_rate => y(self%pin%rate), &
               across => y(self%pin%position + 1), across_rate => y(self%pin%rate + 1))
      product = x*x_rate + across*across_rate   ! e . e' = |e| |e|'
      if (.not. product < 0) return
      distance = sqrt(x**2 + across**2)
      if (distance > self%joint%clearance) rough_time = t - (distance - self%joint%clearance)*distance/product
    end associate
  end procedure rough_time

  module procedure handle_event
    real(dp) :: contact(2)

    action = event_continue
    self%smooth_in_root = .false.
    if (index > self%n_joint_events) then
      call self%pass_gas_bound(index - self%n_joint_events)
      return
    end if
    select case (index)
    case (begins)
      contact = penetration_and_rate(self, y)
      self%phase = phase_contact
      self%smooth_in_root = .true.   ! penetration grows like t, the force like its power 1.5
      self%impact_speed = max(contact(2), 0.0_dp)
      call choose_sliding(self, t, y, .true.)
    case (ends)
      self%phase = merge(phase_film, phase_free, allocated(self%film))
    case (sliding_changes)
      call choose_sliding(self, t, y, .false.)
    end select
    self%mode = self%phase
  end procedure handle_event

  !> Set-valued friction: where the sliding speed is not zero it tells the direction. At zero (where it `may_slide` at the
  !> beginning of a contact it is taken as it is) the pin sticks if friction can hold it and slides against it if not.
  subroutine choose_sliding(self, t, y, may_slide)
    class(clearance_scene_t), intent(inout) :: self
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: may_slide
    type(evaluation_t) :: now
    logical :: inside, was_sliding

    if (self%n_joint_events < sliding_changes) return
    was_sliding = self%sliding /= 0
    self%sliding = 0
    call self%evaluate(t, y, now, inside)
    if (.not. inside) return
    if (may_slide .and. abs(now%joint%sliding_speed) > 0) then
      self%sliding = nint(sign(1.0_dp, now%joint%sliding_speed))
    else if (abs(now%friction_force) > sticking_limit(self, now%normal_force) .or. &
             .not. (may_slide .or. was_sliding)) then
      self%sliding = -nint(sign(1.0_dp, now%friction_force))
    end if
  end subroutine choose_sliding

  module procedure reported_event
    reported_event = event_none
    if (index == begins) reported_event = event_contact_begins
    if (index == ends) reported_event = event_contact_ends
    if (index > self%n_joint_events) reported_event = event_none
  end procedure reported_event

  module procedure prepare_start
    real(dp) :: y(self%n), contact(2), onwards
    type(evaluation_t) :: now
    logical :: inside

    if (.not. allocated(self%contact)) return
    y = self%initial_state()
    contact = penetration_and_rate(self, y)
    if (contact(1) < 0) return
    self%phase = phase_contact
    self%impact_speed = max(contact(2), 0.0_dp)
    if (.not. contact(1) > 0) then
      onwards = contact(2)
      call self%evaluate(0.0_dp, y, now, inside)
      if (inside .and. .not. abs(onwards) > 0) onwards = outward_acceleration(now)
      if (onwards < 0) self%phase = merge(phase_film, phase_free, allocated(self%film))
      self%smooth_in_root = contact(2) > 0
    end if
    self%mode = self%phase
    if (self%phase == phase_contact) call choose_sliding(self, 0.0_dp, y, .true.)
  end procedure prepare_start

  !> d2|e|/dt2 [m/s^2].
  pure real(dp) function outward_acceleration(now)
    type(evaluation_t), intent(in) :: now
    outward_acceleration = dot_product(now%joint%normal, now%accelerations%eccentricity) &
      + now%joint%tangential_rate**2/now%joint%distance
  end function outward_acceleration
end submodule clearance_events
