!> The piston-pin joint with clearance (Reis 2013, 3.70-3.78): where pin and bearing are, and how the bodies move when
!> the eccentricity is the coordinate.
!>
!> The coordinates of the mechanism are (q, e_x, e_y) with e = pin centre - bearing centre. In (q, A, x) the eccentricity
!> is a difference of numbers 10^4 times larger; here it is known to full precision, and the rod angle follows
!> from sin A = (R sin q - e_y)/L without a trigonometric function.
module clearance_joint
  use kinds, only: dp
  use mechanism, only: mechanism_t, motion_t, accelerations_t
  implicit none
  private
  public :: joint_geometry_t, joint_motion_t, joint_motion, clearance_motion, eccentricity_acceleration

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
    real(dp) :: distance              !! |e| [m]
    real(dp) :: normal(2)             !! n = e/|e|, (1, 0) at e = 0; the tangent is t = (-n_y, n_x)
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
    joint%distance = sqrt(eccentricity(1)**2 + eccentricity(2)**2)
    if (joint%distance > 0) then
      joint%normal = eccentricity/joint%distance
    else
      joint%normal = [1.0_dp, 0.0_dp]
    end if
    joint%penetration = joint%distance - geometry%clearance
    joint%penetration_rate = joint%normal(1)*eccentricity_rate(1) + joint%normal(2)*eccentricity_rate(2)
    joint%tangential_rate = joint%normal(1)*eccentricity_rate(2) - joint%normal(2)*eccentricity_rate(1)
    joint%sliding_speed = joint%tangential_rate + pin_speed*geometry%pin_radius
  end function joint_motion

  !> Positions and speeds of the bodies at crank angle q [rad], crank speed [rad/s], eccentricity [m] and its rate.
  !> `reachable` is false where the pin cannot be: |R sin q - e_y| >= L.
  pure subroutine clearance_motion(mechanism, q, crank_speed, eccentricity, eccentricity_rate, motion, reachable)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed, eccentricity(2), eccentricity_rate(2)
    type(motion_t), intent(out) :: motion
    logical, intent(out) :: reachable
    associate (r => mechanism%crank_length, l => mechanism%rod_length)
      motion%crank_angle = q
      motion%sin_crank = sin(q)
      motion%cos_crank = cos(q)
      motion%sin_rod = (r*motion%sin_crank - eccentricity(2))/l
      reachable = abs(motion%sin_rod) < 1
      if (.not. reachable) return
      motion%cos_rod = sqrt((1 - motion%sin_rod)*(1 + motion%sin_rod))
      motion%crank_speed = crank_speed
      motion%rod_speed = (r*motion%cos_crank*crank_speed - eccentricity_rate(2))/(l*motion%cos_rod)
      motion%piston_position = r*motion%cos_crank + l*motion%cos_rod - eccentricity(1)
      motion%piston_velocity = -r*motion%sin_crank*crank_speed - l*motion%sin_rod*motion%rod_speed &
        - eccentricity_rate(1)
    end associate
  end subroutine clearance_motion

  !> e'' = acceleration of the pin - acceleration of the piston [m/s^2].
  pure function eccentricity_acceleration(mechanism, motion, accelerations) result(a)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2)
    a = mechanism%pin_acceleration(motion, accelerations)
    a(1) = a(1) - accelerations%piston
  end function eccentricity_acceleration
end module clearance_joint
