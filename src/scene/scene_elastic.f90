!> The elastic members of a scene.
submodule (gudgeon_scene) scene_elastic
  use ideal_chain, only: ideal_motion
  implicit none

contains

  module procedure claim_elastic
    real(dp) :: own_speed
    integer :: i
    own_speed = 0
    do i = 1, self%n_joints
      own_speed = max(own_speed, self%joints(i)%own_speed(self%span))
    end do
    associate (elastic => self%chain%elastic)
      elastic%start_angle = self%start_angle
      elastic%start_speed = self%start_speed
      elastic%holds_flywheel = .not. self%chain%drive%free_crank
      call elastic%claim(self%layout, self%chain%bodies, self%speed_scale(self%span), own_speed)
    end associate
  end procedure claim_elastic

  module procedure twist_frequency
    associate (bodies => self%chain%bodies)
      twist_frequency = self%chain%elastic%crankshaft%natural_frequency(2*bodies%kinetic_energy(ideal_motion(bodies, &
        self%start_angle, 1.0_dp)), self%chain%elastic%holds_flywheel)
    end associate
  end procedure twist_frequency
end submodule scene_elastic
