!> The events of a scene. Each event belongs to a joint, to the gas, to the guide or to the turns of the crank.
submodule (scene_problem) scene_events
  use ode_problem, only: step_admitted, event_continue
  use joint_events, only: contact_changes, find_joint_events, find_joint_force_events, has_force_events, &
    pass_joint_event, choose_sliding, may_touch, static_speed, judge_entry, judge_reversal, contact_kink_time, may_lose_force, &
    find_lost_force
  use sticking, only: find_released
  use clearance_joint, only: most_joints
  use elastic_film, only: wall_load, wall_deflection
  use joint_evaluation, only: outward_acceleration
  use guide_events, only: n_guide_events, find_guide_events, corners_may_lose_force, corner_force_events, pass_guide_event, &
    find_lost_corner_forces, begin_corner_contact, contact_has_kink, corner_kink_time, inward_acceleration
  use piston_guide, only: corner_t, n_corners
  use crank_turns, only: n_turn_events
  use valve_reeds, only: n_reed_events
  implicit none

  real(dp), parameter :: rounding = 4*epsilon(1.0_dp)   !! relative distance from the wall that is treated as none

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

  module procedure prepare_start
    real(dp) :: y(self%n), contact(2)
    integer :: i

    call number_events(self)
    call load_walls(self)
    y = self%initial_state()
    do i = 1, self%n_joints
      self%joints(i)%phase = self%joints(i)%phase_apart()
      contact = penetration_and_rate(self%joints(i), y)
      call self%joints(i)%begin_at(contact(1) + self%joints(i)%bearing%clearance, contact(2))
      if (.not. may_touch(self%joints(i))) cycle
      if (contact(1) >= -rounding*self%joints(i)%bearing%clearance) call self%joints(i)%begin_contact(contact(2))
    end do
    do i = self%n_joints + 1, size(self%joints)
      self%joints(i)%phase = self%joints(i)%phase_apart()
    end do
    if (allocated(self%given_load)) call self%given_load%start(self%crank_angle(0.0_dp, y), self%start_speed)
    if (allocated(self%guide)) call prepare_corners(self, y)
    do i = 1, self%n_joints
      if (self%joints(i)%phase == phase_contact) call decide_at_wall(self, i, y)
      call decide_at_kink(self, i, y)
      call find_impact_speed(self, i, 0.0_dp, y)
    end do
    call find_lost_forces(self, 0.0_dp, y)
    self%smooth_in_root = .not. self%entry_time < 0
    self%mode = mode_of(self)
    do i = 1, self%n_joints
      if (self%joints(i)%phase == phase_contact) call find_sliding_direction(self, i, 0.0_dp, y, .true.)
    end do
  end procedure prepare_start

  module procedure complete_state
    real(dp) :: contact(2), state(self%n)
    logical :: begins(self%n_joints)
    integer :: i
    if (allocated(self%guide)) then
      if (.not. any(self%guide%touches)) call prepare_corners(self, y)
      call find_corner_speeds(self, t, y, self%guide%touches .and. .not. self%guide%impact_speed > 0)
    end if
    if (allocated(self%given_load)) call self%given_load%start(self%crank_angle(t, y), self%start_speed)
    state = y   ! of which nothing changes
    do i = 1, merge(n_reed_events, 0, has_reeds(self))   ! valves with another force than in the run from which the state is
      call pass_reeds(self, i, .false., t, state)
    end do
    begins = .false.
    do i = 1, self%n_joints   ! in a bearing of another shape a pin may be in contact that was not
      if (.not. may_touch(self%joints(i))) cycle
      contact = penetration_and_rate(self%joints(i), y)
      begins(i) = self%joints(i)%phase /= phase_contact .and. contact(1) > rounding*self%joints(i)%bearing%clearance
      if (begins(i)) call self%joints(i)%begin_contact(contact(2))
    end do
    do i = 1, self%n_joints
      if (begins(i) .or. .not. self%joints(i)%impact_speed > 0) call find_impact_speed(self, i, t, y)
    end do
    call find_lost_forces(self, t, y)
    self%mode = mode_of(self)
    do i = 1, self%n_joints
      if (begins(i)) call find_sliding_direction(self, i, t, y, .true.)
    end do
  end procedure complete_state

  !> Find the impact speed of a pin that is in its bearing at the start and has not struck it: that of a free impact to this depth.
  subroutine find_impact_speed(scene, i, t, y)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: i
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    real(dp) :: contact(2), without
    logical :: in_domain
    if (scene%joints(i)%phase /= phase_contact) return
    contact = penetration_and_rate(scene%joints(i), y)
    if (contact(1) <= rounding*scene%joints(i)%bearing%clearance) return
    associate (joint => scene%joints(i), element => scene%joints(i)%slots(scene%joints(i)%acting(phase_contact))%element, &
               before => scene%joints(i)%impact_speed)
      element%force_is_lost = .true.
      call scene%evaluate(t, y, now, in_domain)
      without = outward_acceleration(now%joint(i), joint%relative_rates(now%accelerations))
      element%force_is_lost = .false.
      before = huge(before)   ! an elastic force
      if (in_domain) call scene%evaluate(t, y, now, in_domain)
      before = max(contact(2), 0.0_dp)
      if (in_domain) before = element%free_impact_speed(now%joint(i), &
        without - outward_acceleration(now%joint(i), joint%relative_rates(now%accelerations)))
    end associate
  end subroutine find_impact_speed

  !> The same for corners of the skirt. The forces of all that are in contact act together.
  subroutine find_corner_speeds(scene, t, y, wanted)
    class(scene_t), intent(inout) :: scene
    real(dp), intent(in) :: t, y(:)
    logical, intent(in) :: wanted(n_corners)
    type(evaluation_t) :: free, pressed
    logical :: in_domain
    integer :: i
    if (.not. any(wanted)) return
    associate (guide => scene%guide)
      guide%force_is_lost = guide%touches
      call scene%evaluate(t, y, free, in_domain)
      guide%force_is_lost = .false.
      if (.not. in_domain) return
      where (wanted) guide%impact_speed = huge(guide%impact_speed)   ! elastic forces
      call scene%evaluate(t, y, pressed, in_domain)
      do i = 1, n_corners
        associate (corner => pressed%guide%corner(i), contact => guide%slots(guide%touching)%element%contact)
          if (.not. wanted(i)) cycle
          guide%impact_speed(i) = max(corner%depth_rate, 0.0_dp)
          if (corner%depth > 0) guide%impact_speed(i) = contact%free_impact_speed(corner%depth, corner%depth_rate, &
            inward_acceleration(i, corner, free%motion, free%accelerations) - &
            inward_acceleration(i, corner, pressed%motion, pressed%accelerations))
        end associate
      end do
    end associate
  end subroutine find_corner_speeds

  !> Find the contacts that have no force at the start, since their pins or corners move out too fast.
  subroutine find_lost_forces(scene, t, y)
    class(scene_t), intent(inout) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain, has_corners
    integer :: i
    has_corners = .false.
    if (allocated(scene%guide)) has_corners = n_guide_events(scene%guide) > n_corners
    if (.not. (has_corners .or. any(may_lose_force(scene%joints)))) return
    call scene%evaluate(t, y, now, in_domain)
    if (.not. in_domain) return
    do i = 1, scene%n_joints
      if (may_lose_force(scene%joints(i))) call &
        find_lost_force(scene%joints(i), now%joint(i), scene%joints(i)%relative_rates(now%accelerations))
    end do
    if (has_corners) call find_lost_corner_forces(scene%guide, now%guide%corner, now%motion, now%accelerations)
  end subroutine find_lost_forces

  !> Start of a pin at the wall, within rounding: if it moves away from the wall or, at rest, is drawn away from it, there is no
  !> contact. The start is then moved by a few units of rounding to the side of the wall that is decided on: otherwise the event
  !> functions, which are rounded differently, may find a contact that begins or ends at t = 0.
  subroutine decide_at_wall(scene, i, y)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: i
    real(dp), intent(in) :: y(:)
    real(dp) :: contact(2), onwards
    associate (joint => scene%joints(i))
      contact = penetration_and_rate(joint, y)
      if (contact(1) > rounding*joint%bearing%clearance) return
      onwards = motion_outward(scene, i, y)
      if (onwards < 0) call joint%end_contact()
      if (contact(2) > 0) scene%entry_time = 0
      joint%start_eccentricity = joint%start_eccentricity*(1 + sign(rounding, onwards))
    end associate
  end subroutine decide_at_wall

  !> Start of a pin at a kink of the transition from film to contact, within rounding: its motion or, at rest, its acceleration
  !> decides on which side it begins, and the start is moved there by a few units of rounding. Otherwise the event function of the
  !> wrong side may never become negative, and the film stays held.
  subroutine decide_at_kink(scene, i, y)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: i
    real(dp), intent(in) :: y(:)
    real(dp) :: distance, onwards, moved
    associate (joint => scene%joints(i))
      distance = norm2(y(joint%at%position:joint%at%position + 1))
      if (.not. is_at_kink(joint, distance, rounding*distance)) return
      onwards = motion_outward(scene, i, y)
      moved = 1 + sign(4*rounding, onwards)
      joint%start_eccentricity = joint%start_eccentricity*moved
      call joint%begin_at(distance*moved, onwards)
    end associate
  end subroutine decide_at_kink

  !> Whether an eccentricity [m] is at a kink of an element's loads, within a margin.
  pure logical function is_at_kink(joint, distance, margin)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: distance, margin
    integer :: k
    is_at_kink = .false.
    do k = 1, joint%n_elements
      associate (kinks => joint%slots(k)%element%kinks)
        is_at_kink = is_at_kink .or. any(kinks > 0 .and. abs(distance - kinks) <= margin)
      end associate
    end do
  end function is_at_kink

  !> Rate of a pin's eccentricity at t = 0 [m/s] or, where it is only rounding, its acceleration [m/s^2].
  real(dp) function motion_outward(scene, i, y)
    class(scene_t), intent(in) :: scene
    integer, intent(in) :: i
    real(dp), intent(in) :: y(:)
    type(evaluation_t) :: now
    real(dp) :: contact(2)
    logical :: in_domain
    associate (joint => scene%joints(i))
      contact = penetration_and_rate(joint, y)
      motion_outward = contact(2)
      if (abs(motion_outward) > rounding*norm2(y(joint%at%rate:joint%at%rate + 1))) return
      call scene%evaluate(0.0_dp, y, now, in_domain)
      if (in_domain) motion_outward = &
        outward_acceleration(now%joint(i), joint%relative_rates(now%accelerations))
    end associate
  end function motion_outward

  !> Find the corners of the skirt that are in contact at t = 0: corners beyond the wall, and corners exactly at the wall that move
  !> into it or, at rest, are pressed into it.
  subroutine prepare_corners(scene, y)
    class(scene_t), intent(inout) :: scene
    real(dp), intent(in) :: y(:)
    type(corner_t) :: corner(n_corners)
    type(evaluation_t) :: now
    real(dp) :: onwards
    logical :: in_domain
    integer :: i
    scene%guide%touches = .false.
    if (scene%guide%touching == 0) return
    call scene%guide%find_contact_state(y, corner)
    call scene%evaluate(0.0_dp, y, now, in_domain)
    do i = 1, n_corners
      if (corner(i)%depth < 0) cycle
      onwards = corner(i)%depth_rate
      if (in_domain .and. .not. abs(onwards) > 0) onwards = inward_acceleration(i, corner(i), now%motion, now%accelerations)
      if (corner(i)%depth > 0 .or. onwards >= 0) call begin_corner_contact(scene%guide, i, corner(i)%depth_rate)
      if (.not. corner(i)%depth > 0 .and. corner(i)%depth_rate > 0 .and. contact_has_kink(scene%guide)) scene%entry_time = 0
    end do
    call find_corner_speeds(scene, 0.0_dp, y, scene%guide%touches)
  end subroutine prepare_corners

  !> Give the walls of elastic films the initial deflection at which the pin has no acceleration in its bearing, as in an ideal
  !> joint. A pin on walls without load would start to bounce. At least a tenth of the film thickness is kept.
  subroutine load_walls(scene)
    class(scene_t), intent(inout) :: scene
    real(dp), parameter :: trial = 1e-8_dp   !! [m]
    real(dp), parameter :: closest = 0.9_dp  !! largest eccentricity of the film over the clearance
    real(dp) :: at_rest(2), by_load(2, 2), load(2), along(2), d(2)
    integer :: i, k
    logical :: in_domain
    do i = 1, scene%n_joints
      if (scene%joints(i)%acting(phase_film) == 0) cycle
      associate (element => scene%joints(i)%slots(scene%joints(i)%acting(phase_film))%element, start => &
                 scene%joints(i)%start_eccentricity, clearance => scene%joints(i)%bearing%clearance)
        if (.not. allocated(element%walls)) cycle
        along = 0
        element%start = start
        call pin_acceleration(scene, i, at_rest, in_domain)
        do k = 1, 2
          d = 0
          d(k) = trial
          element%start = start - d
          if (in_domain) call pin_acceleration(scene, i, along, in_domain)
          by_load(:, k) = (along - at_rest)/norm2(wall_load(element%walls, d))
        end do
        element%start = start
        if (.not. in_domain) cycle
        load = -[by_load(2, 2)*at_rest(1) - by_load(1, 2)*at_rest(2), by_load(1, 1)*at_rest(2) - by_load(2, 1)*at_rest(1)] &
          /(by_load(1, 1)*by_load(2, 2) - by_load(1, 2)*by_load(2, 1))
        d = wall_deflection(element%walls, load)
        do while (norm2(start - d) >= max(closest*clearance, norm2(start)) .and. norm2(d) > 0)
          d = 0.5_dp*d
          if (norm2(d) < trial) d = 0
        end do
        element%start = start - d
      end associate
    end do
  end subroutine load_walls

  !> Acceleration of a pin in its bearing at t = 0 [m/s^2].
  subroutine pin_acceleration(scene, i, acceleration, in_domain)
    class(scene_t), intent(inout) :: scene
    integer, intent(in) :: i
    real(dp), intent(out) :: acceleration(2)
    logical, intent(out) :: in_domain
    type(evaluation_t) :: now
    scene%joints(i)%phase = scene%joints(i)%phase_apart()
    call scene%evaluate(0.0_dp, scene%initial_state(), now, in_domain)
    acceleration = 0
    if (in_domain) acceleration = now%accelerations%pin(:, scene%joints(i)%site%pin)
  end subroutine pin_acceleration
end submodule scene_events
