!> The discrete state in which a scene starts, from its case or from the state of another run: which pins and corners are in
!> contact, with which impact speeds, and which contacts have no force.
submodule (scene_problem:scene_events) scene_start
  use joint_events, only: may_lose_force, find_lost_force
  use elastic_film, only: wall_load, wall_deflection
  use joint_evaluation, only: outward_acceleration
  use guide_events, only: find_lost_corner_forces, begin_corner_contact, contact_has_kink, inward_acceleration
  use piston_guide, only: corner_t
  implicit none

  real(dp), parameter :: rounding = 4*epsilon(1.0_dp)   !! relative distance from the wall that is treated as none

contains

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
end submodule scene_start
