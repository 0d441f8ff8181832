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
  public :: joint_geometry_t, joint_motion_t, find_joint_motion, sliding_speed, find_rod, find_piston

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

  !> Motion of the pin in the bearing, for a given eccentricity and its rate: all but the sliding speed.
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

  !> v_T [m/s], which needs the speed of the pin, omega_rod = -A' [rad/s], besides the tangential rate [m/s]. It is the material
  !> one: (3.74)-(3.76) as printed turn the contact points with the eccentricity, which leaves no sliding.
  pure real(dp) function sliding_speed(geometry, tangential_rate, pin_speed)
    type(joint_geometry_t), intent(in) :: geometry
    real(dp), value, intent(in) :: tangential_rate, pin_speed
    sliding_speed = tangential_rate + pin_speed*geometry%pin_radius
  end function sliding_speed

  !> The rod of a motion whose crank is known, with its sine and cosine, at an eccentricity [m] and its rate. `reachable` is false
  !> where the pin cannot be, |R sin q - e_y| >= L.
  pure subroutine find_rod(mechanism, eccentricity, eccentricity_rate, motion, reachable)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: eccentricity(2), eccentricity_rate(2)
    type(motion_t), intent(inout) :: motion
    logical, intent(out) :: reachable
    real(dp) :: gap
    associate (r => mechanism%crank_length)
      motion%sin_rod = (r*motion%sin_crank - eccentricity(2))*mechanism%per_rod_length
      gap = (1 - motion%sin_rod)*(1 + motion%sin_rod)
      reachable = gap > 0
      if (.not. reachable) return
      motion%cos_rod = sqrt(gap)
      ! over cos A = cos A/gap: the division need not wait for the root
      motion%rod_speed = (r*motion%cos_crank*motion%crank_speed - eccentricity_rate(2))*mechanism%per_rod_length/gap &
        *motion%cos_rod
    end associate
  end subroutine find_rod

  !> The piston of a motion whose crank and rod are known.
  pure subroutine find_piston(mechanism, eccentricity, eccentricity_rate, motion)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: eccentricity(2), eccentricity_rate(2)
    type(motion_t), intent(inout) :: motion
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      motion%piston_position = r*motion%cos_crank + l*motion%cos_rod - eccentricity(1)
      motion%piston_velocity = -r*motion%sin_crank*motion%crank_speed - l*motion%sin_rod*motion%rod_speed &
        - eccentricity_rate(1)
    end associate
  end subroutine find_piston
end module clearance_joint
