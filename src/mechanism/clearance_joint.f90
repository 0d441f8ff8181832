!> The piston-pin joint with clearance (Reis 2013, 3.70-3.78): where pin and bearing are, and how the bodies move when
!> the eccentricity is the coordinate.
!>
!> The coordinates of the mechanism are (q, e_x, e_y) with e = pin centre - bearing centre. In (q, A, x) the eccentricity
!> is a difference of numbers 10^4 times larger; here it is known to full precision, and the rod angle follows
!> from sin A = (R sin q - e_y)/L without a trigonometric function.
module clearance_joint
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t
  implicit none
  private
  public :: joint_geometry_t, joint_motion_t, joint_motion, find_joint_motion, sliding_speed, &
    clearance_motion

  !> Constants of the joint.
  type :: joint_geometry_t
    real(dp) :: clearance = 0        !! c = bearing radius - pin radius [m]
    real(dp) :: bearing_radius = 0   !! [m]
    real(dp) :: pin_radius = 0       !! [m]
  end type joint_geometry_t

  !> Where the pin is in its bearing, and how it moves there.
  type :: joint_motion_t
    real(dp) :: eccentricity(2)       !! e [m]
    real(dp) :: eccentricity_rate(2)  !! [m/s]
    real(dp) :: normal(2)             !! n = e/|e|, (1, 0) at e = 0; the tangent is t = (-n_y, n_x)
    real(dp) :: distance              !! |e| [m]
    real(dp) :: penetration           !! |e| - c [m], negative while apart
    real(dp) :: penetration_rate      !! n . e' [m/s]
    real(dp) :: tangential_rate       !! t . e' [m/s]
    real(dp) :: sliding_speed         !! v_T = t . e' + omega_rod R_pin, of the pin surface on the bearing [m/s]
  end type joint_motion_t

contains

  !> Motion of the pin in the bearing. `pin_speed` is omega_rod = -A' [rad/s]. The sliding speed is the material one:
  !> (3.74)-(3.76) as printed turn the contact points with the eccentricity, which leaves no sliding.
  pure function joint_motion(geometry, eccentricity, eccentricity_rate, pin_speed) result(joint)
    type(joint_geometry_t), intent(in) :: geometry
    real(dp), intent(in) :: eccentricity(2), eccentricity_rate(2), pin_speed
    type(joint_motion_t) :: joint
    joint%eccentricity = eccentricity
    joint%eccentricity_rate = eccentricity_rate
    call find_joint_motion(geometry, joint)
    joint%sliding_speed = sliding_speed(geometry, joint%tangential_rate, pin_speed)
  end function joint_motion

  !> The same in place, for a given eccentricity and its rate: all but the sliding speed.
  pure subroutine find_joint_motion(geometry, joint)
    type(joint_geometry_t), intent(in) :: geometry
    type(joint_motion_t), intent(inout) :: joint
    associate (e => joint%eccentricity, rate => joint%eccentricity_rate, n => joint%normal)
      joint%distance = sqrt(e(1)**2 + e(2)**2)
      if (joint%distance > 0) then
        n = e*(1/joint%distance)
      else
        n = [1.0_dp, 0.0_dp]
      end if
      joint%penetration = joint%distance - geometry%clearance
      joint%penetration_rate = n(1)*rate(1) + n(2)*rate(2)
      joint%tangential_rate = n(1)*rate(2) - n(2)*rate(1)
    end associate
  end subroutine find_joint_motion

  !> v_T [m/s], which needs the speed of the pin [rad/s] besides the tangential rate [m/s].
  pure real(dp) function sliding_speed(geometry, tangential_rate, pin_speed)
    type(joint_geometry_t), intent(in) :: geometry
    real(dp), value, intent(in) :: tangential_rate, pin_speed
    sliding_speed = tangential_rate + pin_speed*geometry%pin_radius
  end function sliding_speed

  !> Positions and speeds of the bodies at crank angle q [rad], crank speed [rad/s], eccentricity [m] and its rate.
  !> `reachable` is false where the pin cannot be, |R sin q - e_y| >= L: then only the crank angle is set.
  pure subroutine clearance_motion(mechanism, q, crank_speed, eccentricity, eccentricity_rate, motion, reachable)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed, eccentricity(2), eccentricity_rate(2)
    type(motion_t), intent(out) :: motion
    logical, intent(out) :: reachable
    real(dp) :: sin_q, cos_q, sin_a, cos_a, gap, rod_speed
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      motion%crank_angle = q
      sin_q = sin(q)
      cos_q = cos(q)
      sin_a = (r*sin_q - eccentricity(2))*mechanism%per_rod_length
      gap = (1 - sin_a)*(1 + sin_a)
      reachable = gap > 0
      if (.not. reachable) return
      cos_a = sqrt(gap)
      ! over cos A = cos A/gap: the division need not wait for the root
      rod_speed = (r*cos_q*crank_speed - eccentricity_rate(2))*mechanism%per_rod_length/gap*cos_a
      motion%sin_crank = sin_q
      motion%cos_crank = cos_q
      motion%sin_rod = sin_a
      motion%cos_rod = cos_a
      motion%crank_speed = crank_speed
      motion%rod_speed = rod_speed
      motion%piston_position = r*cos_q + l*cos_a - eccentricity(1)
      motion%piston_velocity = -r*sin_q*crank_speed - l*sin_a*rod_speed - eccentricity_rate(1)
    end associate
  end subroutine clearance_motion
end module clearance_joint
