!> The events of a scene. Each event belongs to a joint, to the gas, to the guide or to the turns of the crank.
submodule (scene_problem) scene_events
  use ode_problem, only: step_admitted, event_continue
  use joint_events, only: contact_changes, find_joint_events, find_joint_force_events, has_force_events, &
    pass_joint_event, choose_sliding, may_touch, static_speed, judge_entry, judge_reversal, contact_kink_time
  use sticking, only: find_released
  use clearance_joint, only: most_joints
  use guide_events, only: n_guide_events, find_guide_events, corners_may_lose_force, corner_force_events, pass_guide_event, &
    corner_kink_time
  use piston_guide, only: n_corners
  use crank_turns, only: n_turn_events
  use valve_reeds, only: n_reed_events
  implicit none

contains

  !> Number the event functions.
  subroutine number_events(scene)
    class(scene_t), intent(inout) :: scene
    integer :: i
    scene%n_events = 0
    scene%events_of = slice_t()
    scene%may_stick = .false.
    do i = 1, size(scene%joints)
      if (may_touch(scene%joints(i))) &
        scene%may_stick = scene%may_stick .or. scene%joints(i)%slots(scene%joints(i)%acting(phase_contact))%element%may_stick
      call number(i, scene%joints(i)%n_events)
    end do
    if (allocated(scene%gas)) call number(of_gas, scene%gas%n_events)
    if (allocated(scene%other_gas)) call number(of_other_gas, scene%other_gas%n_events(scene%gas))
    if (allocated(scene%turns)) call number(of_turns, n_turn_events)
    if (allocated(scene%wear_cycle)) call number(of_wear, 1)
    if (allocated(scene%guide)) call number(of_guide, n_guide_events(scene%guide))
    if (allocated(scene%given_load)) call number(of_load, scene%given_load%n_events())
    if (has_reeds(scene)) call number(of_reeds, n_reed_events)

  contains

    !> Number those of one owner.
    subroutine number(owner, n)
      integer, intent(in) :: owner, n
      integer :: j
      do j = 1, n
        scene%event_of(scene%n_events + j) = event_owner_t(owner, j)
      end do
      scene%events_of(owner) = slice_t(scene%n_events + 1, scene%n_events + n)
      scene%n_events = scene%n_events + n
    end subroutine number
  end subroutine number_events

  module procedure all_events
    integer :: i
    real(dp) :: angle, speed                                         ! of the crank
    real(dp) :: angles(most_cylinders), speeds(most_cylinders)       ! of the other cylinders
    angle = self%crank_angle(t, y)
    speed = self%crank_speed(t, y)
    do i = 1, self%n_joints
      associate (at => self%events_of(i))
        if (at%last >= at%first) call find_joint_events(self%joints(i), y, g(at%first:at%last), g_rate(at%first:at%last))
      end associate
    end do
    associate (at => self%events_of(of_gas))
      if (at%last >= at%first) call self%gas%events(angle, speed, g(at%first:at%last), g_rate(at%first:at%last))
    end associate
    associate (at => self%events_of(of_other_gas))
      if (at%last >= at%first) then
        call other_cranks(self, t, y, angles, speeds)
        call self%other_gas%events(self%gas, angles, speeds, g(at%first:at%last), g_rate(at%first:at%last))
      end if
    end associate
    associate (at => self%events_of(of_turns))
      if (at%last >= at%first) call self%turns%events(angle, speed, g(at%first:at%last), g_rate(at%first:at%last))
    end associate
    associate (at => self%events_of(of_wear))
      if (at%last >= at%first) call self%wear_cycle%event(angle, speed, g(at%first), g_rate(at%first))
    end associate
    associate (at => self%events_of(of_guide))
      if (at%last >= at%first) call find_guide_events(self%guide, y, g(at%first:at%last), g_rate(at%first:at%last))
    end associate
    associate (at => self%events_of(of_load))
      if (at%last >= at%first) call self%given_load%event(angle, speed, g(at%first), g_rate(at%first))
    end associate
    associate (at => self%events_of(of_reeds))
      if (at%last >= at%first) call find_reed_events(self, t, y, g(at%first:at%last), g_rate(at%first:at%last))
    end associate
    if (needs_forces(self)) call find_force_events(self, t, y, g, g_rate)
  end procedure all_events

  !> Whether a valve of a compressor has a mass.
  pure logical function has_reeds(scene)
    class(scene_t), intent(in) :: scene
    has_reeds = .false.
    if (scene%has_charge) has_reeds = allocated(scene%gas%charge%reeds)
  end function has_reeds

  !> Event functions of the valves that have a mass: of those of a port in all cylinders the largest.
  pure subroutine find_reed_events(scene, t, y, g, g_rate)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: g(n_reed_events), g_rate(n_reed_events)
    type(charge_motion_t) :: now(most_cylinders + 1)
    real(dp) :: own(n_reed_events), own_rate(n_reed_events)
    integer :: i, k, n
    g = -1
    g_rate = 0
    if (.not. scene%gas%charge%admits(y)) return
    call find_charges(scene, t, y, n, now)
    do i = 1, n
      call scene%gas%charge%reed_events(i, now(i), y, own, own_rate)
      do k = 1, n_reed_events
        if (i > 1 .and. own(k) <= g(k)) cycle
        g(k) = own(k)
        g_rate(k) = own_rate(k)
      end do
    end do
  end subroutine find_reed_events

  !> The gas of all cylinders, that of the mechanism first, where its mass is a state.
  pure subroutine find_charges(scene, t, y, n, now)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    integer, intent(out) :: n   !! number of cylinders
    type(charge_motion_t), intent(out) :: now(most_cylinders + 1)
    real(dp) :: angles(most_cylinders), speeds(most_cylinders)
    integer :: i
    n = 1
    call scene%gas%find_charge(scene%crank_angle(t, y), scene%crank_speed(t, y), y, now(1))
    if (.not. allocated(scene%other_gas)) return
    n = 1 + size(scene%chain%train%cylinders)
    call other_cranks(scene, t, y, angles, speeds)
    do i = 1, n - 1
      call scene%other_gas%find_charge(scene%gas, i, angles(i), speeds(i), y, now(i + 1))
    end do
  end subroutine find_charges

  !> Pass an event of the valves of a port that have a mass, in all cylinders that have it; with `is_event` at least one of them
  !> has.
  subroutine pass_reeds(scene, port, is_event, t, y)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: port
    logical, intent(in) :: is_event
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    type(charge_motion_t) :: now(most_cylinders + 1)
    real(dp) :: g(n_reed_events, most_cylinders + 1), g_rate(n_reed_events), largest
    integer :: i, n
    call find_charges(scene, t, y, n, now)
    do i = 1, n
      call scene%gas%charge%reed_events(i, now(i), y, g(:, i), g_rate)
    end do
    largest = 0
    if (is_event) largest = min(largest, maxval(g(port, :n)))
    do i = 1, n
      if (g(port, i) >= largest) call scene%gas%charge%pass_reed(i, port, now(i), y)
    end do
  end subroutine pass_reeds

  !> Whether some event functions need the forces at present.
  pure logical function needs_forces(scene)
    class(scene_t), intent(in) :: scene
    integer :: i
    needs_forces = .false.
    do i = 1, scene%n_joints
      needs_forces = needs_forces .or. has_force_events(scene%joints(i))
    end do
    if (allocated(scene%guide)) needs_forces = needs_forces .or. corners_may_lose_force(scene%guide)
  end function needs_forces

  !> The event functions that depend on the accelerations: those of set-valued friction and of contacts whose forces may be lost.
  pure subroutine find_force_events(scene, t, y, g, g_rate)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout) :: g(:), g_rate(:)   !! those of all events
    type(evaluation_t) :: now
    logical :: in_domain
    integer :: i
    call scene%evaluate(t, y, now, in_domain)
    if (.not. in_domain) return
    do i = 1, scene%n_joints
      associate (joint => scene%joints(i), at => scene%events_of(i))
        if (has_force_events(joint)) call find_joint_force_events(joint, now%joint(i), &
          joint%relative_rates(now%accelerations), g(at%first:at%last), g_rate(at%first:at%last))
      end associate
    end do
    if (.not. allocated(scene%guide)) return
    associate (at => scene%events_of(of_guide))
      if (corners_may_lose_force(scene%guide)) call corner_force_events(scene%guide, now%guide%corner, now%motion, &
        now%accelerations, g(at%first:at%last), g_rate(at%first:at%last))
    end associate
  end subroutine find_force_events

  module procedure handle_event
    real(dp) :: contact(2)
    logical :: slides, enters
    action = event_continue
    associate (i => self%event_of(index)%joint, event => self%event_of(index)%event)
      if (i == of_gas) then
        if (allocated(self%other_gas)) call pass_others(self, event, t, y, .false.)
        call self%gas%pass(event, self%crank_angle(t, y), self%crank_speed(t, y), y)
      else if (i == of_other_gas) then
        call pass_others(self, event, t, y, .true.)
      else if (i == of_reeds) then
        call pass_reeds(self, event, .true., t, y)
      else if (i == of_turns) then
        call self%turns%pass(event, self%crank_angle(t, y), action)
      else if (i == of_load) then
        call self%given_load%pass(self%crank_speed(t, y))
      else if (i == of_wear) then
        self%wear_cycle%begin = self%crank_angle(t, y)
      else if (i == of_guide) then
        call pass_guide_event(self%guide, event, y, enters)
        if (enters) self%entry_time = t
      else if (event > contact_changes) then
        call pass_joint_event(self%joints(i), event, slides)
        if (slides) call find_sliding_direction(self, i, t, y, .false.)
      else if (self%joints(i)%phase == phase_contact) then
        call self%joints(i)%reset_states(y)
        call self%joints(i)%end_contact()
      else
        call self%joints(i)%reset_states(y)
        contact = penetration_and_rate(self%joints(i), y)
        call self%joints(i)%begin_contact(contact(2))
        self%entry_time = t
        call find_sliding_direction(self, i, t, y, .true.)
      end if
    end associate
    self%smooth_in_root = .not. t > self%entry_time   ! the penetration varies as t, the force as its power 1.5
    self%mode = mode_of(self)
  end procedure handle_event

  !> Handle an event of the gas in the other cylinders, or in that of the mechanism, for those that pass a bound of the cycle with
  !> it.
  subroutine pass_others(scene, event, t, y, is_own)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: event
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    logical, intent(in) :: is_own   !! the event is that of the other cylinders
    real(dp) :: angles(most_cylinders), speeds(most_cylinders), g(scene%gas%n_events), g_rate(scene%gas%n_events)
    integer :: n
    n = size(scene%chain%train%cylinders)
    call other_cranks(scene, t, y, angles, speeds)
    if (is_own .or. allocated(scene%gas%cycle)) call scene%other_gas%pass(scene%gas, event, angles(:n), speeds(:n), is_own, y)
    if (.not. (is_own .and. allocated(scene%gas%cycle))) return
    call scene%gas%events(scene%crank_angle(t, y), scene%crank_speed(t, y), g, g_rate)
    if (scene%other_gas%is_now(g(event), scene%crank_angle(t, y))) &
      call scene%gas%pass(event, scene%crank_angle(t, y), scene%crank_speed(t, y), y)
  end subroutine pass_others

  !> The discrete state, for the choice of the integration method.
  pure integer function mode_of(scene)
    class(scene_t), intent(in) :: scene
    integer :: i
    mode_of = 0
    do i = 1, scene%n_joints
      mode_of = mode_of + scene%joints(i)%phase*n_phases**(i - 1)
    end do
    if (.not. allocated(scene%guide)) return
    if (any(scene%guide%touches)) mode_of = mode_of + n_phases**scene%n_joints
  end function mode_of

  !> Choose the state of set-valued friction of one joint: its direction of sliding, or sticking; and of the other joints that
  !> stick, which this may release in the same instant.
  subroutine find_sliding_direction(scene, i, t, y, may_slide)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: i
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: may_slide
    type(evaluation_t) :: now
    logical :: in_domain, was_sliding
    associate (element => scene%joints(i)%slots(scene%joints(i)%acting(phase_contact))%element)
      if (.not. element%may_stick) return
      was_sliding = element%sliding /= 0
      element%sliding = 0
      call scene%evaluate(t, y, now, in_domain)
      if (.not. in_domain) return
      call choose_sliding(element, now%joint(i), was_sliding, may_slide)
      if (count(now%joint(:scene%n_joints)%sticks) == 1) return
      if (was_sliding .and. .not. may_slide) element%sliding = 0   ! all together
      if (element%sliding /= 0) call scene%evaluate(t, y, now, in_domain)
    end associate
    if (in_domain) call release_surfaces(scene, t, y, now)
  end subroutine find_sliding_direction

  !> Let surfaces slide that stick in an evaluation but that friction cannot hold, until the others hold: sliding friction may be
  !> less than static friction.
  subroutine release_surfaces(scene, t, y, now)
    class(scene_t), intent(inout) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t), intent(inout) :: now
    integer :: sense(most_joints), i
    logical :: in_domain
    do
      sense = find_released(scene%chain, scene%joints(:scene%n_joints), now%motion, now%joint)
      if (all(sense == 0)) return
      do i = 1, scene%n_joints
        if (sense(i) /= 0) scene%joints(i)%slots(scene%joints(i)%acting(phase_contact))%element%sliding = sense(i)
      end do
      call scene%evaluate(t, y, now, in_domain)
      if (.not. (in_domain .and. any(now%joint(:scene%n_joints)%sticks))) return
    end do
  end subroutine release_surfaces

  module procedure reported_event
    reported_event = event_none
    associate (i => self%event_of(index)%joint)
      if (i == of_guide) then
        if (self%event_of(index)%event <= n_corners) &
          reported_event = merge(event_contact_ends, event_contact_begins, self%guide%touches(self%event_of(index)%event))
        return
      end if
      if (i <= 0 .or. self%event_of(index)%event /= contact_changes) return
      reported_event = merge(event_contact_ends, event_contact_begins, self%joints(i)%phase == phase_contact)
    end associate
  end procedure reported_event

  module procedure judge_step
    type(evaluation_t) :: now
    real(dp) :: part
    integer :: i, judged
    logical :: in_domain
    verdict = step_admitted
    fraction = 1
    do i = 1, merge(self%n_joints, 0, self%enters_at_step_end)
      call judge_entry(self%joints(i), t_old, y_old, t, y, judged, part)
      verdict = max(verdict, judged)
      fraction = min(fraction, part)
    end do
    if (verdict /= step_admitted .or. .not. any(static_speed(self%joints) > 0)) return
    call move_bodies(self, self%joints, t, y, now, in_domain)
    do i = 1, merge(self%n_joints, 0, in_domain)
      if (.not. static_speed(self%joints(i)) > 0) cycle
      call judge_reversal(self%joints(i), now%motion, y_old, now%joint(i), judged, part)
      verdict = max(verdict, judged)
      fraction = min(fraction, part)
    end do
  end procedure judge_step

  module procedure lands_on_step_end
    lands_on_step_end = self%enters_at_step_end .and. self%event_of(index)%joint > 0 .and. &
      self%reported_event(index) == event_contact_begins
  end procedure lands_on_step_end

  module procedure next_kink_time
    integer :: i
    next_kink_time = huge(next_kink_time)
    do i = 1, self%n_joints
      if (self%joints(i)%phase == phase_contact) next_kink_time = min(next_kink_time, contact_kink_time(self%joints(i), t, y))
    end do
    if (allocated(self%guide)) next_kink_time = min(next_kink_time, corner_kink_time(self%guide, t, y))
  end procedure next_kink_time
end submodule scene_events
