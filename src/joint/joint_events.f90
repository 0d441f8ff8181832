!> Events of a joint with clearance: contact begins and ends, and the events of its elements.
module joint_events
  use kinds, only: dp
  use ode_problem, only: step_admitted, step_too_deep, step_too_far
  use chain_motion, only: motion_t
  use joint_evaluation, only: joint_evaluation_t, joint_rates_t, find_polar, find_sliding, sliding_acceleration, reach_event
  use load_element, only: load_element_t, sliding_changes, first_kink, force_changes
  use clearance_joint, only: clearance_joint_t, phase_contact, contact_changes
  implicit none
  private
  public :: contact_changes, find_joint_events, has_force_events, find_joint_force_events, pass_joint_event
  public :: sliding_event, choose_sliding
  public :: may_touch, may_pass_static, may_lose_force, find_lost_force, static_speed
  public :: penetration_and_rate, judge_entry, judge_reversal, contact_kink_time

contains

  !> Whether the joint has a contact law.
  pure logical function may_touch(joint)
    type(clearance_joint_t), intent(in) :: joint
    may_touch = joint%acting(phase_contact) > 0
  end function may_touch

  !> Event functions of a joint and their rates. Those that need the forces are -1 and 0 here.
  pure subroutine find_joint_events(joint, y, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: g(joint%n_events), g_rate(joint%n_events)
    type(joint_evaluation_t) :: now
    integer :: i, k
    call joint%read_state(y, now)
    if (may_touch(joint)) call contact_event(joint, y, now, g(contact_changes), g_rate(contact_changes))
    if (joint%n_events <= contact_changes) return
    g(contact_changes + 1:) = -1
    g_rate(contact_changes + 1:) = 0
    do k = 1, joint%n_elements
      associate (element => joint%slots(k)%element)
        if (.not. element%kinks(1) > 0) cycle
        do i = 1, size(element%kinks)
          associate (at => element%events%first + first_kink + i - 2)
            call reach_event(now, element%kinks(i), element%is_beyond(i), g(at), g_rate(at))
          end associate
        end do
      end associate
    end do
  end subroutine find_joint_events

  !> Whether some event functions need the forces in the present phase.
  pure logical function has_force_events(joint)
    type(clearance_joint_t), intent(in) :: joint
    has_force_events = joint%phase == phase_contact
    if (.not. has_force_events) return
    associate (element => joint%slots(joint%acting(phase_contact))%element)
      has_force_events = element%may_stick .or. element%may_lose_force
    end associate
  end function has_force_events

  !> Event functions that need the forces, of a joint that has such events in its present phase.
  pure subroutine find_joint_force_events(joint, now, rates, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_evaluation_t), intent(in) :: now
    type(joint_rates_t), intent(in) :: rates
    real(dp), intent(inout) :: g(joint%n_events), g_rate(joint%n_events)
    associate (element => joint%slots(joint%acting(phase_contact))%element)
      associate (before => element%events%first - 1)
        if (element%may_stick) &
          call sliding_event(element, now, rates, g(before + sliding_changes), g_rate(before + sliding_changes))
        if (.not. element%may_lose_force) return
        call element%find_share(now, rates, g(before + force_changes), g_rate(before + force_changes))
        if (element%force_is_lost) return
        g(before + force_changes) = -g(before + force_changes)
        g_rate(before + force_changes) = -g_rate(before + force_changes)
      end associate
    end associate
  end subroutine find_joint_force_events

  !> Event function of set-valued friction in contact: sticking surfaces begin to slide, or the sliding speed passes zero.
  pure subroutine sliding_event(element, now, rates, g, g_rate)
    class(load_element_t), intent(in) :: element
    type(joint_evaluation_t), intent(in) :: now
    type(joint_rates_t), intent(in) :: rates
    real(dp), intent(out) :: g, g_rate
    if (element%sliding == 0) then
      g = abs(now%friction_force) - element%holding_ratio*now%normal_force
      g_rate = 0
    else
      g = -element%sliding*now%sliding_speed
      g_rate = -element%sliding*sliding_acceleration(element%pin_radius, now, rates, at_rest=.false.)
    end if
  end subroutine sliding_event

  !> Choose the state of set-valued friction from an evaluation in which the surfaces are assumed to stick. A nonzero sliding speed
  !> gives the direction; at the beginning of a contact (`may_slide`) this holds for any value. At zero speed the surfaces stick if
  !> friction can hold them; otherwise they begin to slide in the direction of the force.
  pure subroutine choose_sliding(element, now, was_sliding, may_slide)
    class(load_element_t), intent(inout) :: element
    type(joint_evaluation_t), intent(in) :: now
    logical, intent(in) :: was_sliding, may_slide
    if (may_slide .and. abs(now%sliding_speed) > 0) then
      element%sliding = nint(sign(1.0_dp, now%sliding_speed))
    else if (abs(now%friction_force) > element%holding_ratio*now%normal_force .or. .not. (may_slide .or. was_sliding)) then
      element%sliding = -nint(sign(1.0_dp, now%friction_force))
    end if
  end subroutine choose_sliding

  !> Pass an event of an element. `asks`: the scene is to choose whether the surfaces slide.
  pure subroutine pass_joint_event(joint, event, asks)
    type(clearance_joint_t), intent(inout) :: joint
    integer, intent(in) :: event    !! > contact_changes
    logical, intent(out) :: asks
    integer :: k
    asks = .false.
    do k = 1, joint%n_elements
      associate (element => joint%slots(k)%element)
        if (event < element%events%first .or. event > element%events%last) cycle
        select case (event - element%events%first + 1)
        case (sliding_changes)
          asks = .true.
        case (force_changes)
          element%force_is_lost = .not. element%force_is_lost
        case default
          associate (is_beyond => element%is_beyond(event - element%events%first - first_kink + 2))
            is_beyond = .not. is_beyond
          end associate
        end select
      end associate
    end do
    call joint%find_reach()
  end subroutine pass_joint_event

  !> Whether the present contact may lose its force.
  elemental logical function may_lose_force(joint)
    type(clearance_joint_t), intent(in) :: joint
    may_lose_force = joint%phase == phase_contact
    if (may_lose_force) may_lose_force = joint%slots(joint%acting(phase_contact))%element%may_lose_force
  end function may_lose_force

  !> Find whether a contact that may lose its force has lost it.
  pure subroutine find_lost_force(joint, now, rates)
    type(clearance_joint_t), intent(inout) :: joint
    type(joint_evaluation_t), intent(in) :: now
    type(joint_rates_t), intent(in) :: rates
    real(dp) :: share, share_rate
    associate (element => joint%slots(joint%acting(phase_contact))%element)
      call element%find_share(now, rates, share, share_rate)
      element%force_is_lost = share < 0
    end associate
  end subroutine find_lost_force

  !> Whether a step of this joint may pass over static friction: that of a law in which it depends on the sliding speed alone.
  pure logical function may_pass_static(joint)
    type(clearance_joint_t), intent(in) :: joint
    may_pass_static = .false.
    if (may_touch(joint)) may_pass_static = joint%slots(joint%acting(phase_contact))%element%static_speed > 0
  end function may_pass_static

  !> Sliding speed up to which the friction of the present contact clearly exceeds that of faster sliding [m/s]; 0: there is none.
  elemental real(dp) function static_speed(joint)
    type(clearance_joint_t), intent(in) :: joint
    static_speed = 0
    if (joint%phase == phase_contact) static_speed = joint%slots(joint%acting(phase_contact))%element%static_speed
  end function static_speed

  !> Penetration [m] and its rate [m/s].
  pure function penetration_and_rate(joint, y) result(values)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(:)
    real(dp) :: values(2), distance
    type(joint_evaluation_t) :: motion
    call joint%read_state(y, motion)
    if (joint%has_own_gap .and. may_touch(joint)) then
      call joint%find_gap(y, motion)
      values = [motion%penetration, motion%penetration_rate]
      return
    end if
    associate (e => motion%eccentricity, rate => motion%eccentricity_rate)
      distance = sqrt(e(1)**2 + e(2)**2)
      values(1) = distance - joint%bearing%clearance
      values(2) = 0
      if (distance > 0) values(2) = (e(1)*rate(1) + e(2)*rate(2))/distance
    end associate
  end function penetration_and_rate

  !> Event function of the beginning or end of a contact, and its rate: (e . e - c^2)/2 [m^2] without contact, and its negative in
  !> contact. For an element with a gap of its own the difference of the eccentricity from the clearance is that gap, times the
  !> clearance.
  pure subroutine contact_event(joint, y, motion, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(:)
    type(joint_evaluation_t), intent(in) :: motion   !! eccentricity and its rate
    real(dp), intent(out) :: g, g_rate
    real(dp) :: gap(2)
    if (joint%has_own_gap) then
      gap = sign(joint%bearing%clearance, merge(-1.0_dp, 1.0_dp, motion%touches))*penetration_and_rate(joint, y)
      g = gap(1)
      g_rate = gap(2)
    else
      call reach_event(motion, joint%bearing%clearance, motion%touches, g, g_rate)
    end if
  end subroutine contact_event

  !> Judge a step that begins without contact: at its end the penetration must be at most `max_penetration` (4.12-4.13), and the
  !> step must not pass through a contact. The penetration inside the step is approximated by the cubic through its values and rates
  !> at both ends. If the penetration is too large, a step shortened by `fraction` ends at half of the largest penetration.
  pure subroutine judge_entry(joint, t_old, y_old, t, y, verdict, fraction)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: t_old, y_old(:), t, y(:)
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    real(dp) :: left(2), right(2), lower, upper, middle
    integer :: i
    integer, parameter :: scan = 16

    verdict = step_admitted
    fraction = 1
    if (joint%phase == phase_contact .or. .not. may_touch(joint)) return
    left = penetration_and_rate(joint, y_old)
    right = penetration_and_rate(joint, y)
    left(2) = left(2)*(t - t_old)
    right(2) = right(2)*(t - t_old)
    if (right(1) >= 0 .and. right(1) <= joint%max_penetration) return
    lower = 0
    do i = 1, scan
      upper = real(i, dp)/scan
      if (hermite(left, right, upper) > merge(0.0_dp, joint%max_penetration, right(1) < 0 .and. i < scan)) exit
      lower = upper
    end do
    if (i > scan) return
    verdict = step_too_deep
    do i = 1, 40
      middle = 0.5_dp*(lower + upper)
      if (hermite(left, right, middle) < 0.5_dp*joint%max_penetration) then
        lower = middle
      else
        upper = middle
      end if
    end do
    fraction = max(upper, 1e-3_dp)
  end subroutine judge_entry

  !> Refuse a step in which a pin in contact reverses its sliding and passes over the static friction: at both ends the speed is
  !> beyond that of static friction, with opposite signs. No evaluation may show that the surfaces would stick in between. (Brown
  !> and McPhee's law, c_s = 10 c_f, v_t = 1e-5 m/s, simulation I with a softer pin, 1e-6: the motion of Coulomb's law with 33,000
  !> evaluations; without this verdict another motion from the first sticking on, with 73,000.) `fraction` leads to the reversal by
  !> the secant. It need not be closer than a billionth of the speed at the beginning.
  pure subroutine judge_reversal(joint, motion, y_old, now, verdict, fraction)
    type(clearance_joint_t), intent(in) :: joint
    type(motion_t), intent(in) :: motion               !! of the bodies at the end of the step
    real(dp), intent(in) :: y_old(:)                   !! state at its beginning
    type(joint_evaluation_t), intent(inout) :: now         !! eccentricity and rate at its end
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    real(dp), parameter :: closest = 1e-9_dp
    type(joint_evaluation_t) :: old
    real(dp) :: before
    verdict = step_admitted
    fraction = 1
    call find_polar(joint%bearing%clearance, now)
    call joint%find_speeds(motion, now)
    call find_sliding(joint%pin_radius, now)
    associate (after => now%sliding_speed, static => static_speed(joint))
      if (abs(after) <= static) return
      call joint%read_state(y_old, old)
      call find_polar(joint%bearing%clearance, old)
      before = old%tangential_rate + (after - now%tangential_rate)   ! the angular speeds hardly change in a step
      if (.not. before*after < 0 .or. abs(before) <= static .or. abs(after) < closest*abs(before)) return
      verdict = step_too_far
      fraction = max(abs(before)/(abs(before) + abs(after)), 1e-3_dp)
    end associate
  end subroutine judge_reversal

  !> The cubic on [0, 1] with given values and slopes at the ends.
  pure real(dp) function hermite(left, right, s)
    real(dp), intent(in) :: left(2), right(2), s
    hermite = (1 + 2*s)*(1 - s)**2*left(1) + s*(1 - s)**2*left(2) + s**2*(3 - 2*s)*right(1) - s**2*(1 - s)*right(2)
  end function hermite

  !> Predicted end of a contact, if the pin is moving out of the wall: near it the force varies with the power 1.5 of the
  !> penetration. Else the largest number.
  pure real(dp) function contact_kink_time(joint, t, y)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: t, y(:)
    real(dp) :: distance, product, gap(2)
    contact_kink_time = huge(contact_kink_time)
    if (joint%has_own_gap) then
      gap = penetration_and_rate(joint, y)
      if (gap(2) < 0 .and. gap(1) > 0) contact_kink_time = t - gap(1)/gap(2)
      return
    end if
    associate (x => y(joint%at%position), x_rate => y(joint%at%rate), &
               across => y(joint%at%position + 1), across_rate => y(joint%at%rate + 1))
      product = x*x_rate + across*across_rate   ! e . e' = |e| |e|'
      if (.not. product < 0) return
      distance = sqrt(x**2 + across**2)
      if (distance > joint%bearing%clearance) contact_kink_time = t - (distance - joint%bearing%clearance)*distance/product
    end associate
  end function contact_kink_time
end module joint_events
