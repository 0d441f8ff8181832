!> The parts of the work on the bodies: gas, drive, damping, guide, elastic members, and the kinds of load in each joint.
submodule (scene_problem) scene_works
  use load_element, only: n_kinds, of_film
  implicit none

contains

  module procedure measure_works
    integer :: i, kind
    allocate (self%parts(0))
    if (allocated(self%gas)) call add(by_gas, 0)
    if (.not. allocated(self%given_load)) call add(by_drive, 0)
    if (self%chain%drive%damping > 0) call add(by_damping, 0)
    do i = 1, self%n_joints
      do kind = 1, n_kinds
        if (self%joints(i)%has_kind(kind)) call add(kind, i)
      end do
    end do
    if (allocated(self%guide)) call add(by_guide, 0)
    if (allocated(self%chain%elastic) .or. has_stations(self)) call add(by_elastic, 0)
    self%n_works = size(self%parts)
    do i = self%n_joints + 1, size(self%joints)
      do kind = 1, n_kinds
        if (self%joints(i)%has_kind(kind)) call add(kind, i)
      end do
    end do
    self%clears_loads = self%clears_loads .or. any([(self%joints(i)%shares_load(), i=1, self%n_joints)])
    call choose_other_part(self)
    do i = 1, size(self%parts)
      if (i == self%other_part .or. is_constant_torque(self) .and. self%parts(i)%what == by_drive) cycle
      call claim_quadrature(self, self%parts(i))
    end do
    self%has_more_rates = .true.
    call self%set_layout()

  contains

    subroutine add(what, joint)
      integer, intent(in) :: what, joint
      self%parts = [self%parts, work_part_t(what, joint)]
    end subroutine add
  end procedure measure_works

  !> The part that is not integrated itself: the film that comes first, whose power alone is not at hand without the others, or else
  !> the last part.
  subroutine choose_other_part(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i
    scene%other_part = 0
    if (scene%n_works > 1 .or. .not. is_constant_torque(scene)) scene%other_part = scene%n_works
    do i = scene%n_works, 1, -1
      if (scene%parts(i)%what == of_film) scene%other_part = i
    end do
  end subroutine choose_other_part

  !> Whether the crankshaft has several stations.
  pure logical function has_stations(scene)
    type(scene_t), intent(in) :: scene
    has_stations = .false.
    if (allocated(scene%chain%train)) has_stations = scene%chain%train%is_chain
  end function has_stations

  !> Whether the drive is a constant torque, whose work follows from the angle.
  pure logical function is_constant_torque(scene)
    type(scene_t), intent(in) :: scene
    is_constant_torque = scene%chain%drive%free_crank .and. .not. (allocated(scene%chain%varying) &
      .or. scene%chain%has_crankshaft() .or. has_stations(scene))
  end function is_constant_torque

  !> Claim the quadrature of a part. Where the mechanism has nothing but quadratures it takes part in the error control, since
  !> otherwise the steps would be too long for it.
  subroutine claim_quadrature(scene, part)
    type(scene_t), intent(inout) :: scene
    type(work_part_t), intent(inout) :: part
    type(slice_t) :: one
    call scene%layout%claim_quadratures(1, merge(0.0_dp, scene%energy_scale(), scene%n_positions > 0 .or. &
      part%joint > scene%n_joints), one)
    part%at = one%first
  end subroutine claim_quadrature

  module procedure set_work_rates
    real(dp) :: rates(n_kinds)
    integer :: i, joint
    joint = 0
    do i = 1, size(self%parts)
      associate (part => self%parts(i))
        if (part%at == 0) cycle
        if (part%joint > 0) then
          if (part%joint /= joint) rates = self%joints(part%joint)%work_rates(now%joint(part%joint), y)
          joint = part%joint
          dydt(part%at) = rates(part%what)
        else
          dydt(part%at) = power_by(self, part%what, now)
        end if
      end associate
    end do
  end procedure set_work_rates

  !> Power of what is not a load in a joint [W].
  pure real(dp) function power_by(scene, what, now) result(power)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: what
    type(evaluation_t), intent(in) :: now
    real(dp) :: speed
    power = 0
    select case (what)
    case (by_gas)
      speed = now%motion%piston_velocity
      if (scene%chain%bodies%piston%is_loose) speed = now%motion%tilting%com_velocity
      power = -scene%gas%force(now%cylinder_pressure)*speed
      if (allocated(scene%chain%train)) power = power + now%motion%train%gas_power
    case (by_guide)
      if (scene%guide%is_loose) then
        associate (at => now%motion%tilting)
          power = now%loads%bore_force*at%offset_rate + now%loads%bore_moment*at%tilt_rate + &
            now%guide%friction_force*at%com_velocity
        end associate
        if (scene%guide%filmed > 0) power = power + now%guide%spring_power
      else
        power = now%guide%friction_force*now%motion%piston_velocity
      end if
    case (by_elastic)
      if (allocated(scene%chain%elastic)) power = scene%chain%elastic%damping_power(now%motion)
      if (has_stations(scene)) power = power + now%motion%train%damping_power
    case default
      speed = scene%chain%driven_speed(now%motion)
      power = now%crank_moment*speed
      if (what == by_damping) power = -scene%chain%drive%damping*speed**2
    end select
  end function power_by

  module procedure works
    integer :: i
    works = 0
    do i = 1, size(self%parts)
      if (self%parts(i)%at > 0) then
        works(i) = y(self%parts(i)%at)
      else if (i /= self%other_part) then
        works(i) = self%work_of_torque(t, y)
      end if
    end do
    if (self%other_part > 0) works(self%other_part) = self%work(y) - sum(works(:self%n_works))
  end procedure works
end submodule scene_works
