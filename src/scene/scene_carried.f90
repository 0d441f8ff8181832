!> The carried bearings of a scene: their loads are the forces in the chain, which they do not change.
submodule (scene_problem) scene_carried
  use joint_places, only: main_bearing
  use chain_reactions, only: reactions_t
  implicit none

contains

  module procedure look_at_carried
    real(dp) :: load(2)
    logical :: inside
    integer :: i
    in_domain = .true.
    do i = 1, size(self%carried)
      associate (bearing => self%carried(i), joint => self%joints(self%carried(i)%joint), it => now%joint(self%carried(i)%joint))
        call joint%find_speeds(now%motion, it)
        load = load_at(self, joint%place, now)*bearing%load_share
        call bearing%look(joint, load, [it%pin_angular_speed, it%bearing_speed], y, it, inside)
        in_domain = in_domain .and. inside
      end associate
    end do
  end procedure look_at_carried

  !> Force of the pin on its bearing at a place [N].
  pure function load_at(scene, place, now) result(load)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: place   !! index in `places`
    type(evaluation_t), intent(in) :: now
    real(dp) :: load(2)
    type(reactions_t) :: reactions
    load = -now%loads%force(:, piston_pin)
    if (place == piston_pin) return
    reactions = scene%chain%reactions(now%motion, now%accelerations, now%loads)
    load = reactions%crankpin
    if (place == main_bearing) load = -reactions%crank_bearing
  end function load_at
end submodule scene_carried
