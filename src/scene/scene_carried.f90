!> The carried bearings of a scene: their loads are the forces in the chain, which they do not change, or follow from a table.
submodule (scene_problem) scene_carried
  use joint_places, only: main_bearing, place_of, number_of
  use chain_motion, only: body_piston
  use engine_forces, only: engine_forces_t
  use chain_reactions, only: reactions_t
  implicit none

contains

  module procedure look_at_carried
    type(reactions_t) :: full
    type(engine_forces_t) :: engine
    real(dp) :: load(2)
    logical :: inside
    integer :: i
    in_domain = .true.
    if (self%has_numbers) then
      full = self%chain%reactions(now%motion, now%accelerations, now%loads)
      engine%throw(:, 1) = full%crank_bearing   ! of one cylinder
      if (allocated(self%chain%train)) call engine%find(self%chain%train, now%motion, now%accelerations, full)
    end if
    do i = 1, size(self%carried)
      associate (bearing => self%carried(i), joint => self%joints(self%carried(i)%joint), it => now%joint(self%carried(i)%joint))
        call joint%find_speeds(now%motion, it)
        if (joint%spot > n_places) then
          call look_at_numbered(self, joint%spot, now%motion, full, engine, it, load)
        else
          load = load_at(self, joint%place, now)*bearing%load_share
        end if
        call bearing%look(joint, load, [it%pin_angular_speed, it%bearing_speed], y, it, inside)
        in_domain = in_domain .and. inside
      end associate
    end do
  end procedure look_at_carried

  module procedure move_without_mechanism
    associate (motion => now%motion)
      call self%read_crank(t, y, motion)
      motion%offset = 0
      motion%offset_rate = 0
      call follow_rod(self%given_load%crank_to_rod, 1.0_dp, 0.0_dp, motion, in_domain)
      motion%turning(body_piston) = 0
      motion%tilting%tilt = 0
      motion%piston_position = 0
      motion%piston_velocity = 0
    end associate
    now%accelerations%crank = 0
    now%accelerations%rod = 0
    now%accelerations%piston = 0
    now%loads%axial_force = 0
    now%crank_moment = 0
    now%power = 0
  end procedure move_without_mechanism

  !> Angles, speeds and load (force of the pin on its bearing) of a numbered bearing: of a main bearing in the axes of the full
  !> cylinder, of a big end in those of its own. Speeds must be those of the mechanism.
  pure subroutine look_at_numbered(scene, spot, motion, full, engine, it, load)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: spot
    type(motion_t), intent(in) :: motion
    type(reactions_t), intent(in) :: full          !! of the mechanism
    type(engine_forces_t), intent(in) :: engine
    type(joint_evaluation_t), intent(inout) :: it
    real(dp), intent(out) :: load(2)               !! [N]
    integer :: number, other
    number = number_of(spot)
    it%pin_angle = motion%crank_angle
    if (place_of(spot) == main_bearing) then
      it%rod = [1, 0]
      if (allocated(scene%chain%train)) then
        load = -engine%on_shaft(number, scene%chain%train%n_throws)
        call scene%chain%train%find_journal(motion, number, it%pin_angle, it%pin_angular_speed)
        it%pin_angle = it%pin_angle + motion%crank_angle
      else
        load = -engine%on_shaft(number, 1)
      end if
      return
    end if
    load = full%crankpin
    it%rod = [motion%cos_rod, motion%sin_rod]
    if (.not. allocated(scene%chain%train)) return
    associate (train => scene%chain%train)
      if (number == train%full_number) return
      other = merge(number, number - 1, number < train%full_number)
      load = engine%cylinder(other)%reactions%crankpin
      it%rod = engine%cylinder(other)%rod
      it%pin_angle = motion%train%angle(other)
      it%pin_angular_speed = motion%train%speed(train%cylinders(other)%station)
      it%bearing_speed = -engine%cylinder(other)%rod_speed
    end associate
  end subroutine look_at_numbered

  module procedure turned
    associate (it => self%joints(joint))
      if (it%spot > n_places) then
        turned = [now%joint(joint)%pin_angle, -atan2(now%joint(joint)%rod(2), now%joint(joint)%rod(1))]
      else
        turned = [self%chain%body_angle(now%motion, it%site%pin_body), 0.0_dp]
        if (it%bearing_turns) turned(2) = self%chain%body_angle(now%motion, it%site%bearing)
      end if
    end associate
  end procedure turned

  !> Force of the pin on its bearing at a place [N].
  pure function load_at(scene, place, now) result(load)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: place   !! index in `places`
    type(evaluation_t), intent(in) :: now
    real(dp) :: load(2)
    type(reactions_t) :: reactions
    if (allocated(scene%given_load)) then
      load = given_load(scene%given_load, now%motion)
      return
    end if
    load = -now%loads%force(:, piston_pin)
    if (place == small_end) load = -load   ! the pin belongs to the piston
    if (any(place == [piston_pin, small_end])) return
    reactions = scene%chain%reactions(now%motion, now%accelerations, now%loads)
    load = reactions%crankpin
    if (place == main_bearing) load = -reactions%crank_bearing
  end function load_at

  !> The load of a table at a motion of crank and rod, in fixed axes [N].
  pure function given_load(table, motion) result(load)
    type(bearing_load_t), intent(in) :: table
    type(motion_t), intent(in) :: motion
    real(dp) :: load(2)
    real(dp) :: along(2)   ! the axis x of the frame
    load = table%at(motion%crank_angle)
    select case (table%frame)
    case ('crank')
      along = [motion%cos_crank, motion%sin_crank]
    case ('rod')
      along = [motion%cos_rod, -motion%sin_rod]
    case default
      return
    end select
    load = [along(1)*load(1) - along(2)*load(2), along(2)*load(1) + along(1)*load(2)]
  end function given_load
end submodule scene_carried
