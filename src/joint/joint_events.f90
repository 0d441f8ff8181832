!> Events of a joint with clearance: contact begins and ends, set-valued friction changes.
module joint_events
  use gudgeon_kinds, only: dp
  use ode_problem, only: step_admitted, step_too_deep, step_too_far
  use chain_motion, only: accelerations_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, phase_contact
  use chain_motion, only: motion_t
  use joint_motion, only: joint_motion_t, find_polar, find_speeds, find_sliding, sliding_acceleration, outward_acceleration
  implicit none
  private
  public :: n_events, may_stick, may_lose_force
  public :: contact_changes, sliding_changes, film_held_changes, film_gone_changes, force_changes
  public :: contact_event, sliding_event, force_event, force_share
  public :: may_pass_static, judge_entry, judge_reversal, rough_end, begin_contact, end_contact, choose_sliding
  public :: penetration_and_rate, transition_events, pass_kink

  !> The events of a joint, in this order. A joint without contact law has no events. The second event exists only for set-valued
  !> friction, the next two only for joints in which film and contact share the load, the last one only for a contact law whose
  !> damper may cancel the elastic force: there the forces have kinks.
  integer, parameter :: contact_changes = 1, sliding_changes = 2, film_held_changes = 3, film_gone_changes = 4, force_changes = 5

contains

  !> Number of event functions of a joint, with those before the last one that its laws need.
  pure integer function n_events(joint)
    type(clearance_joint_t), intent(in) :: joint
    n_events = 0
    if (allocated(joint%contact)) n_events = contact_changes
    if (may_stick(joint)) n_events = sliding_changes
    if (allocated(joint%transition)) n_events = film_gone_changes
    if (may_lose_force(joint)) n_events = force_changes
  end function n_events

  !> Whether the joint has set-valued friction.
  pure logical function may_stick(joint)
    type(clearance_joint_t), intent(in) :: joint
    may_stick = .false.
    if (allocated(joint%friction)) may_stick = joint%friction%set_valued
  end function may_stick

  !> Whether the damper of the contact law may cancel the elastic force.
  pure logical function may_lose_force(joint)
    type(clearance_joint_t), intent(in) :: joint
    may_lose_force = .false.
    if (allocated(joint%contact)) may_lose_force = joint%contact%may_lose_force
  end function may_lose_force

  !> Penetration [m] and its rate [m/s].
  pure function penetration_and_rate(joint, y) result(values)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(:)
    real(dp) :: values(2), distance, gradient(2)
    if (allocated(joint%worn)) then
      call joint%worn%find_gap(y(joint%at%position:joint%at%position + 1), values(1), gradient)
      values(2) = dot_product(gradient, y(joint%at%rate:joint%at%rate + 1))
      return
    end if
    associate (x => y(joint%at%position), x_rate => y(joint%at%rate), &
               across => y(joint%at%position + 1), across_rate => y(joint%at%rate + 1))
      distance = sqrt(x**2 + across**2)
      values(1) = distance - joint%bearing%clearance
      values(2) = 0
      if (distance > 0) values(2) = (x*x_rate + across*across_rate)/distance
    end associate
  end function penetration_and_rate

  !> Event function of the beginning or end of a contact, and its rate: (e . e - c^2)/2 [m^2] without contact, which is smooth in
  !> every state, and its negative in contact. In a worn bore the difference of the eccentricity from the clearance is the largest
  !> gap of its foundation, times the clearance.
  pure subroutine contact_event(joint, y, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: g, g_rate
    real(dp) :: worn(2)
    if (allocated(joint%worn)) then
      worn = sign(joint%bearing%clearance, merge(-1.0_dp, 1.0_dp, joint%phase == phase_contact))*penetration_and_rate(joint, y)
      g = worn(1)
      g_rate = worn(2)
      return
    end if
    call reach_event(joint, y, joint%bearing%clearance, joint%phase == phase_contact, g, g_rate)
  end subroutine contact_event

  !> Event functions of the kinks of a weighted transition, and their rates. (At the end of a smooth share only the curvature is
  !> discontinuous; the event costs no more evaluations than it saves.)
  pure subroutine transition_events(joint, y, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(*)
    real(dp), intent(out) :: g(2), g_rate(2)
    associate (kinks => joint%transition)
      call reach_event(joint, y, kinks%film_reach, kinks%film_is_held, g(1), g_rate(1))
      call reach_event(joint, y, kinks%contact_reach, kinks%film_is_gone, g(2), g_rate(2))
    end associate
  end subroutine transition_events

  !> Half the difference between e . e and its value at an eccentricity [m^2], and its rate, with the sign that makes the next
  !> passage one from negative to positive.
  pure subroutine reach_event(joint, y, reach, is_beyond, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: y(*), reach   !! [m]
    logical, intent(in) :: is_beyond      !! the eccentricity is the larger one
    real(dp), intent(out) :: g, g_rate
    associate (x => y(joint%at%position), x_rate => y(joint%at%rate), &
               across => y(joint%at%position + 1), across_rate => y(joint%at%rate + 1))
      g = 0.5_dp*(x**2 + across**2 - reach**2)
      g_rate = x*x_rate + across*across_rate
      if (.not. is_beyond) return
      g = -g
      g_rate = -g_rate
    end associate
  end subroutine reach_event

  !> The journal passes a kink of a weighted transition.
  pure subroutine pass_kink(joint, event)
    type(clearance_joint_t), intent(inout) :: joint
    integer, intent(in) :: event   !! film_held_changes or film_gone_changes
    associate (kinks => joint%transition)
      if (event == film_held_changes) then
        kinks%film_is_held = .not. kinks%film_is_held
      else
        kinks%film_is_gone = .not. kinks%film_is_gone
      end if
    end associate
  end subroutine pass_kink

  !> Event function of set-valued friction in contact: sticking surfaces begin to slide, or the sliding speed passes zero.
  pure subroutine sliding_event(joint, motion, own, accelerations, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: own
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: g, g_rate
    if (joint%sliding == 0) then
      g = abs(own%friction_force) - sticking_limit(joint, own%normal_force)
      g_rate = 0
    else
      g = -joint%sliding*motion%sliding_speed
      g_rate = -joint%sliding*sliding_acceleration(joint%place, joint%bearing_turns, joint%pin_radius, motion, &
        accelerations, at_rest=.false.)
    end if
  end subroutine sliding_event

  !> Event function of a law whose damper may cancel the elastic force: the contact loses its force, or the force acts again.
  pure subroutine force_event(joint, motion, accelerations, g, g_rate)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: g, g_rate
    call force_share(joint, motion, accelerations, g, g_rate)
    if (joint%force_is_lost) return
    g = -g
    g_rate = -g_rate
  end subroutine force_event

  !> The damped over the elastic force, without the limit 0, and its rate [1/s]. In a worn bore the rate is a difference over a
  !> short part of the motion.
  pure subroutine force_share(joint, motion, accelerations, share, share_rate)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: share, share_rate
    real(dp) :: onwards
    if (.not. (allocated(joint%worn) .and. motion%penetration > 0)) then
      call joint%contact%find_share(motion%penetration, motion%penetration_rate, &
        outward_acceleration(joint%place, motion, accelerations), share, share_rate)
      return
    end if
    associate (e => motion%eccentricity, rate => motion%eccentricity_rate)
      share = share_in_worn_bore(joint, e, rate)
      share_rate = 0
      if (.not. norm2(rate) > 0) return
      onwards = 1e-6_dp*motion%penetration/norm2(rate)
      share_rate = (share_in_worn_bore(joint, e + onwards*rate, rate + onwards*accelerations%pin(:, joint%place)) - share)/onwards
    end associate
  end subroutine force_share

  !> The share in a worn bore; 1 without contact.
  pure real(dp) function share_in_worn_bore(joint, e, rate) result(share)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: e(2), rate(2)   !! eccentricity and its rate [m], [m/s]
    real(dp) :: elastic(2), unused, pressing, penetration, gradient(2)
    share = 1
    call joint%worn%press(e, elastic, unused)
    pressing = norm2(elastic)
    call joint%worn%find_gap(e, penetration, gradient)
    if (pressing > 0 .and. penetration > 0) &
      share = joint%contact%damped_force(pressing, penetration, dot_product(elastic, rate)/pressing)/pressing
  end function share_in_worn_bore

  !> Largest friction force of a set-valued law while the surfaces stick [N].
  pure real(dp) function sticking_limit(joint, normal_force)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: normal_force
    sticking_limit = joint%friction%holding_ratio()*normal_force
  end function sticking_limit

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
    if (joint%phase == phase_contact .or. .not. allocated(joint%contact)) return
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

  !> Whether a step of this joint may pass over static friction: that of a law in which it depends on the sliding speed alone.
  pure logical function may_pass_static(joint)
    type(clearance_joint_t), intent(in) :: joint
    may_pass_static = .false.
    if (allocated(joint%contact) .and. allocated(joint%friction)) may_pass_static = joint%friction%static_speed() > 0
  end function may_pass_static

  !> Refuse a step in which a journal in contact reverses its sliding and passes over the static friction: at both ends the speed is
  !> beyond that of static friction, with opposite signs. No evaluation may show that the surfaces would stick in between. (Brown
  !> and McPhee's law, c_s = 10 c_f, v_t = 1e-5 m/s, simulation I with a softer pin, 1e-6: the motion of Coulomb's law with 33,000
  !> evaluations; without this verdict another motion from the first sticking on, with 73,000.) `fraction` leads to the reversal by
  !> the secant. It need not be closer than a billionth of the speed at the beginning.
  pure subroutine judge_reversal(joint, motion, y_old, now, verdict, fraction)
    type(clearance_joint_t), intent(in) :: joint
    type(motion_t), intent(in) :: motion               !! of the bodies at the end of the step
    real(dp), intent(in) :: y_old(:)                   !! state at its beginning
    type(joint_motion_t), intent(inout) :: now         !! eccentricity and rate at its end
    integer, intent(out) :: verdict
    real(dp), intent(out) :: fraction
    real(dp), parameter :: closest = 1e-9_dp
    type(joint_motion_t) :: old
    real(dp) :: before
    verdict = step_admitted
    fraction = 1
    call find_polar(joint%bearing%clearance, now)
    call find_speeds(joint%place, joint%bearing_turns, motion, now)
    call find_sliding(joint%pin_radius, now)
    associate (after => now%sliding_speed, static => joint%friction%static_speed())
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

  !> Predicted end of a contact, if the journal is moving out of the wall: near it the force varies with the power 1.5 of the
  !> penetration. Else the largest number.
  pure real(dp) function rough_end(joint, t, y)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: t, y(:)
    real(dp) :: distance, product, worn(2)
    rough_end = huge(rough_end)
    if (allocated(joint%worn)) then
      worn = penetration_and_rate(joint, y)
      if (worn(2) < 0 .and. worn(1) > 0) rough_end = t - worn(1)/worn(2)
      return
    end if
    associate (x => y(joint%at%position), x_rate => y(joint%at%rate), &
               across => y(joint%at%position + 1), across_rate => y(joint%at%rate + 1))
      product = x*x_rate + across*across_rate   ! e . e' = |e| |e|'
      if (.not. product < 0) return
      distance = sqrt(x**2 + across**2)
      if (distance > joint%bearing%clearance) rough_end = t - (distance - joint%bearing%clearance)*distance/product
    end associate
  end function rough_end

  !> Begin a contact with a penetration rate [m/s].
  pure subroutine begin_contact(joint, rate)
    type(clearance_joint_t), intent(inout) :: joint
    real(dp), intent(in) :: rate
    joint%phase = phase_contact
    joint%impact_speed = max(rate, 0.0_dp)
    joint%force_is_lost = .false.
  end subroutine begin_contact

  !> End a contact: the journal is free or carried by the film again, and its force is no longer lost.
  pure subroutine end_contact(joint)
    type(clearance_joint_t), intent(inout) :: joint
    joint%phase = joint%phase_apart()
    joint%force_is_lost = .false.
  end subroutine end_contact

  !> Choose the state of set-valued friction from an evaluation in which the surfaces are assumed to stick. A nonzero sliding speed
  !> gives the direction; at the beginning of a contact (`may_slide`) this holds for any value. At zero speed the surfaces stick if
  !> friction can hold them; otherwise they begin to slide in the direction of the force.
  pure subroutine choose_sliding(joint, motion, own, was_sliding, may_slide)
    type(clearance_joint_t), intent(inout) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: own
    logical, intent(in) :: was_sliding, may_slide
    if (may_slide .and. abs(motion%sliding_speed) > 0) then
      joint%sliding = nint(sign(1.0_dp, motion%sliding_speed))
    else if (abs(own%friction_force) > sticking_limit(joint, own%normal_force) .or. .not. (may_slide .or. was_sliding)) then
      joint%sliding = -nint(sign(1.0_dp, own%friction_force))
    end if
  end subroutine choose_sliding
end module joint_events
