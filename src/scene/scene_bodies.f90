!> Parts of a scene other than rigid bodies and an ideal guide: elastic members, a guide with friction, a piston with clearance in
!> its bore.
submodule (scene_problem) scene_bodies
  use constants, only: two_pi
  use chain_loads, only: unloaded
  use ideal_chain, only: inertia_at
  use loose_piston, only: place_piston, move_centre
  implicit none

contains

  module procedure find_general_accelerations
    logical :: solvable
    if (allocated(self%given_load)) then
      call move_without_mechanism(self, t, y, now, in_domain)
      return
    end if
    call move_bodies(self, joints, t, y, now, in_domain)
    if (.not. in_domain) return
    call self%find_loads(self%n_joints, joints, y, now)
    if (allocated(self%gas)) call self%load_gas(y, now, in_domain)
    if (.not. in_domain) return
    if (allocated(self%chain%train)) call load_train(self, y, now)
    call load_guide(self, y, now, in_domain)
    if (.not. in_domain) return
    call self%chain%accelerate(now%motion, now%loads, now%accelerations, now%crank_moment, solvable)
    if (solvable) call add_guide_friction(self, joints, now, solvable)
    in_domain = solvable
    if (.not. in_domain) return
    if (self%may_stick) call hold_surfaces(self%chain, joints, now%motion, now%joint, now%loads, now%accelerations, &
      now%crank_moment, now%power)
    call add_power(self, now)
  end procedure find_general_accelerations

  module procedure move_bodies
    call self%read_crank(t, y, now%motion)
    call self%place_pins(self%n_joints, joints, y, now, in_domain)
    if (self%has_heat) call self%read_temperatures(self%n_joints, joints, y, now, in_domain)
    if (in_domain) call place_more_bodies(self, t, y, now, in_domain)
    if (in_domain) call self%chain%move_rod(now%motion, in_domain)
  end procedure move_bodies

  !> Set the position of a piston with clearance in its bore, of the shapes of the rod and of the flywheel. `in_domain` is false if
  !> they are not admissible.
  pure subroutine place_more_bodies(self, t, y, now, in_domain)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: in_domain
    if (.not. self%chain%is_loose(crank_pin)) then   ! not every closed form reads it
      now%motion%crank_pin = 0
      now%motion%crank_pin_rate = 0
    end if
    in_domain = .true.
    if (allocated(self%guide)) then
      if (self%guide%is_loose) call self%guide%read_state(y, now%motion%tilting)
      in_domain = self%guide%admits_state(y, now%motion%tilting)
      if (in_domain .and. self%guide%is_loose) call place_piston(self%chain%bodies%piston, now%motion)
    end if
    if (allocated(self%chain%floating)) then
      associate (joint => self%joints(self%joint_at(small_end)), relative => now%joint(self%joint_at(small_end)))
        now%motion%small_end = joint%site%sense*relative%eccentricity
        now%motion%small_end_rate = joint%site%sense*relative%eccentricity_rate
      end associate
      call self%chain%floating%read_state(y, now%motion)
    end if
    if (allocated(self%chain%elastic)) call self%chain%elastic%read_state(t, y, now%motion)
    if (allocated(self%chain%train)) call self%chain%train%read_state(t, y, now%motion)
  end subroutine place_more_bodies

  !> Set the forces of the gas in the other cylinders, and the loads of the stations.
  pure subroutine load_train(self, y, now)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(self%n)
    type(evaluation_t), intent(inout) :: now
    associate (train => self%chain%train, at => now%motion%train)
      at%gas_force(:size(train%cylinders)) = 0
      if (allocated(self%gas)) call self%other_gas%find_forces(self%gas, y, at%angle, at%gas_force)
      call train%load_stations(now%motion)
    end associate
  end subroutine load_train

  !> Add the loads of the guide to those of joints and gas; the friction force only if it follows from the loads of the piston pin
  !> known so far. `in_domain` is false if the springs of elastic faces do not balance.
  pure subroutine load_guide(self, y, now, in_domain)
    class(scene_t), intent(in) :: self
    real(dp), intent(in) :: y(self%n)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: in_domain
    in_domain = .true.
    if (.not. allocated(self%guide)) return
    call self%chain%move_piston(now%motion)
    if (self%guide%is_loose) call move_centre(now%motion)
    call self%guide%find_loads(now%motion, y, now%guide, now%loads)
    in_domain = now%guide%springs_balance
    associate (friction => now%guide%friction_force)
      if (.not. self%guide%is_loose .and. normal_is_known(self)) &
        friction = friction + now%guide%friction_ratio*abs(normal_force(self, now))
      now%loads%axial_force = now%loads%axial_force - friction
    end associate
  end subroutine load_guide

  !> Add the friction of an ideal guide that depends on the accelerations, which it changes itself. The accelerations without it
  !> and without the friction of sticking surfaces must be known. `in_domain` is false if it would jam the piston.
  !>
  !> F = mu |N|, where N = N_0 + N_1 F depends on the accelerations, and everything is linear in these: N_0 is the
  !> normal force without F, N_1 follows from a trial force, and N = N_0/(1 - mu N_1 sign N_0). If |mu N_1| < 1 this is the only
  !> solution; otherwise the piston would jam.
  pure subroutine add_guide_friction(self, joints, now, in_domain)
    class(scene_t), intent(in) :: self
    type(clearance_joint_t), intent(in) :: joints(:)
    type(evaluation_t), intent(inout) :: now
    logical, intent(out) :: in_domain
    type(loads_t) :: unit
    type(accelerations_t) :: change
    real(dp) :: normal, probe, slope, moment
    in_domain = .true.
    if (.not. allocated(self%guide)) return
    if (self%guide%is_loose .or. normal_is_known(self)) return
    if (.not. abs(now%guide%friction_ratio) > 0) return
    unit = unloaded
    unit%axial_force = -1
    call self%chain%response(now%motion, unit, change, moment)
    normal = normal_force(self, now)
    if (self%may_stick) normal = normal_with(self, joints, now, 0.0_dp, change, moment)
    probe = max(abs(normal), 1.0_dp)
    slope = (normal_with(self, joints, now, probe, change, moment) - normal)/probe
    associate (ratio => now%guide%friction_ratio)
      in_domain = abs(ratio*slope) < 1
      if (in_domain) call add_friction(self, ratio*abs(normal/(1 - ratio*slope*sign(1.0_dp, normal))), change, moment, now)
    end associate
  end subroutine add_guide_friction

  !> Whether the force between an ideal guide and the piston does not depend on the accelerations: if the piston pin has clearance
  !> and its surfaces do not stick.
  pure logical function normal_is_known(scene)
    class(scene_t), intent(in) :: scene
    normal_is_known = scene%chain%is_loose(piston_pin) .and. .not. scene%may_stick
  end function normal_is_known

  !> Normal force N with a friction force in addition to the present loads [N].
  pure real(dp) function normal_with(scene, joints, now, friction, change, moment) result(normal)
    class(scene_t), intent(in) :: scene
    type(clearance_joint_t), intent(in) :: joints(:)
    type(evaluation_t), intent(in) :: now
    real(dp), intent(in) :: friction
    type(accelerations_t), intent(in) :: change   !! change of the accelerations by 1 N
    real(dp), intent(in) :: moment                !! change of the moment on the crank by 1 N [m]
    type(evaluation_t) :: trial
    trial%motion = now%motion
    trial%accelerations = now%accelerations
    trial%loads = now%loads
    trial%joint(:scene%n_joints) = now%joint(:scene%n_joints)
    trial%guide = now%guide
    trial%crank_moment = now%crank_moment
    trial%power = now%power
    call add_friction(scene, friction, change, moment, trial)
    if (scene%may_stick) call hold_surfaces(scene%chain, joints, trial%motion, trial%joint, trial%loads, &
      trial%accelerations, trial%crank_moment, trial%power)
    normal = normal_force(scene, trial)
  end function normal_with

  !> Add a friction force of the guide on the piston, along x [N], to the loads, and correct everything that depends on it.
  pure subroutine add_friction(scene, friction, change, moment, now)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: friction
    type(accelerations_t), intent(in) :: change
    real(dp), intent(in) :: moment
    type(evaluation_t), intent(inout) :: now
    now%guide%friction_force = now%guide%friction_force + friction
    now%loads%axial_force = now%loads%axial_force - friction
    call scene%chain%add_response(friction, change, now%accelerations)
    now%crank_moment = now%crank_moment + friction*moment
    if (.not. scene%chain%is_loose(piston_pin)) call scene%chain%complete_loads(now%motion, now%accelerations, now%loads)
  end subroutine add_friction

  !> Add the power of drive, gas, guide and elastic members to that of the joints.
  pure subroutine add_power(self, now)
    class(scene_t), intent(in) :: self
    type(evaluation_t), intent(inout) :: now
    associate (chain => self%chain, motion => now%motion, loads => now%loads)
      if (allocated(chain%train)) then
        associate (speed => chain%driven_speed(motion))
          now%power = now%power + (now%crank_moment - chain%drive%damping*speed)*speed + (motion%train%damping_power &
            + motion%train%gas_power)
        end associate
        if (allocated(chain%elastic)) now%power = now%power + chain%elastic%damping_power(motion)
      else if (allocated(chain%elastic)) then
        now%power = now%power + chain%elastic%power(motion, now%crank_moment, chain%drive%damping)
      else
        now%power = (now%crank_moment - chain%drive%damping*motion%crank_speed)*motion%crank_speed + now%power
      end if
      if (.not. allocated(self%guide)) then
        if (.not. allocated(self%gas)) return
        call chain%move_piston(motion)
        now%power = now%power - loads%axial_force*motion%piston_velocity
      else if (self%guide%is_loose) then
        associate (at => motion%tilting)
          now%power = now%power + (loads%bore_force*at%offset_rate + loads%bore_moment*at%tilt_rate) &
            - loads%axial_force*at%com_velocity
        end associate
        if (self%guide%filmed > 0) now%power = now%power + now%guide%spring_power
      else
        now%power = now%power - loads%axial_force*motion%piston_velocity
      end if
    end associate
  end subroutine add_power

  module procedure other_cranks
    type(motion_t) :: motion
    integer :: i
    associate (train => self%chain%train)
      call self%read_crank(t, y, motion)
      call train%read_state(t, y, motion)
      do i = 1, size(train%cylinders)
        angle(i) = motion%train%angle(i)
        speed(i) = motion%train%speed(train%cylinders(i)%station)
      end do
    end associate
  end procedure other_cranks

  module procedure twist_frequency
    integer, parameter :: angles = 256
    real(dp) :: inertia   ! of the crank with rod and piston, mean over a turn [kg m^2]
    integer :: k
    inertia = sum([(inertia_at(self%chain%bodies, two_pi*k/angles), k=1, angles)])/angles
    twist_frequency = self%chain%elastic%crankshaft%natural_frequency(inertia, self%chain%elastic%holds_flywheel)
  end procedure twist_frequency

  !> Normal force of the piston on an ideal guide, from the force of the joint of the pin [N].
  pure real(dp) function normal_force(scene, now)
    class(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    normal_force = scene%chain%bodies%piston%mass*scene%chain%bodies%gravity(2) - now%loads%force(2, piston_pin)
  end function normal_force
end submodule scene_bodies
