!> Relative motion of journal and bearing of a joint (Reis 2013, 3.70-3.78).
module joint_motion
  use gudgeon_kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin
  use friction_law, only: most_friction_states
  implicit none
  private
  public :: joint_motion_t, most_joint_states, find_polar, find_speeds, find_sliding, sliding_acceleration, outward_acceleration

  integer, parameter :: most_joint_states = max(most_friction_states, 2)   !! of the friction law, or of an elastic film

  !> Position and velocity of the journal in its bearing.
  type :: joint_motion_t
    real(dp) :: eccentricity(2)       !! e, from the centre of the bearing to the centre of the journal [m]
    real(dp) :: eccentricity_rate(2)  !! [m/s]
    real(dp) :: journal_speed         !! angular speeds of both bodies, positive from x to y [rad/s]
    real(dp) :: bearing_speed
    real(dp) :: normal(2)             !! n = e/|e|, (1, 0) at e = 0; the tangent is t = (-n_y, n_x)
    real(dp) :: distance              !! |e| [m]
    real(dp) :: penetration           !! |e| - c [m], negative without contact
    real(dp) :: penetration_rate      !! n . e' [m/s]
    real(dp) :: tangential_rate       !! t . e' [m/s]
    real(dp) :: sliding_speed         !! v_T, of the journal's surface relative to the bearing's [m/s]
    real(dp) :: friction_states(most_friction_states)   !! states of the friction law, if it has any
    real(dp) :: film_eccentricity(2)  !! e_f of an elastic film [m]
    real(dp) :: film_rate(2)          !! [m/s]
  end type joint_motion_t

contains

  !> Compute distance, normal, penetration and the components of the rate from the eccentricity and its rate.
  pure subroutine find_polar(clearance, joint)
    real(dp), intent(in) :: clearance   !! [m]
    type(joint_motion_t), intent(inout) :: joint
    associate (e => joint%eccentricity, rate => joint%eccentricity_rate, n => joint%normal)
      joint%distance = sqrt(e(1)**2 + e(2)**2)
      if (joint%distance > 0) then
        n = e*(1/joint%distance)
      else
        n = [1.0_dp, 0.0_dp]
      end if
      joint%penetration = joint%distance - clearance
      joint%penetration_rate = n(1)*rate(1) + n(2)*rate(2)
      joint%tangential_rate = n(1)*rate(2) - n(2)*rate(1)
    end associate
  end subroutine find_polar

  !> Angular speeds of the bodies on both sides of a pin of the chain.
  pure subroutine find_speeds(place, bearing_turns, motion, joint)
    integer, intent(in) :: place           !! crank_pin or piston_pin
    logical, intent(in) :: bearing_turns   !! the bearing of the piston pin rotates: the piston has clearance in its bore
    type(motion_t), intent(in) :: motion
    type(joint_motion_t), intent(inout) :: joint
    if (place == crank_pin) then
      joint%journal_speed = motion%crank_speed
      joint%bearing_speed = motion%rod_end_speed(crank_pin)
    else
      joint%journal_speed = motion%rod_end_speed(piston_pin)
      joint%bearing_speed = 0
      if (bearing_turns) joint%bearing_speed = motion%tilting%tilt_rate
    end if
  end subroutine find_speeds

  !> Sliding speed v_T = t . e' + omega_journal R - omega_bearing (|e| + R), with the journal's radius R: the relative velocity of
  !> the material points in contact. Equations (3.74)-(3.76) as printed let the contact points rotate with the eccentricity, so that
  !> no sliding remains.
  pure subroutine find_sliding(pin_radius, joint)
    real(dp), intent(in) :: pin_radius   !! [m]
    type(joint_motion_t), intent(inout) :: joint
    joint%sliding_speed = joint%tangential_rate + joint%journal_speed*pin_radius &
      - joint%bearing_speed*(joint%distance + pin_radius)
  end subroutine find_sliding

  !> Rate of the sliding speed, v_T' [m/s^2] = t . e'' - gamma' n . e' + omega_journal' R - omega_bearing' (|e| + R) - omega_bearing
  !> |e|', with gamma' = t . e'/|e|. With `at_rest` only the terms with accelerations are included.
  pure real(dp) function sliding_acceleration(place, bearing_turns, pin_radius, joint, accelerations, at_rest) result(a)
    integer, intent(in) :: place
    logical, intent(in) :: bearing_turns   !! the bearing of the piston pin rotates: the piston has clearance in its bore
    real(dp), intent(in) :: pin_radius
    type(joint_motion_t), intent(in) :: joint
    type(accelerations_t), intent(in) :: accelerations
    logical, intent(in) :: at_rest
    associate (n => joint%normal, pin => accelerations%pin(:, place))
      a = n(1)*pin(2) - n(2)*pin(1)
      if (.not. at_rest) a = a - joint%tangential_rate*joint%penetration_rate/joint%distance &
        - joint%bearing_speed*joint%penetration_rate
      if (place == crank_pin) then
        a = a + accelerations%crank*pin_radius - accelerations%rod_end(crank_pin)*(joint%distance + pin_radius)
      else
        a = a + accelerations%rod_end(piston_pin)*pin_radius
        if (bearing_turns) a = a - accelerations%tilt*(joint%distance + pin_radius)
      end if
    end associate
  end function sliding_acceleration

  !> d2|e|/dt2 [m/s^2].
  pure real(dp) function outward_acceleration(place, joint, accelerations)
    integer, intent(in) :: place
    type(joint_motion_t), intent(in) :: joint
    type(accelerations_t), intent(in) :: accelerations
    outward_acceleration = dot_product(joint%normal, accelerations%pin(:, place)) + joint%tangential_rate**2/joint%distance
  end function outward_acceleration
end module joint_motion
