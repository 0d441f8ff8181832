!> Positions and speeds of the bodies of the chain, from the crank angle and the eccentricities of the pins (Reis 2013, 3.1-3.30 and
!> 3.70-3.72).
!>
!> The coordinates are the crank angle q and, for each pin with clearance, its eccentricity: c at the crank pin, e at the piston
!> pin. It is the vector from the centre of the bearing to the centre of the pin. An ideal pin has no
!> coordinate. With a piston pin that floats, e = e_b - e_s: its eccentricity in the piston minus that in the rod. With o = c + e
!> everything else follows in closed form:
!>
!>     sin A = (R sin q - d - o_y)/L,  A' = (R cos q q' - o_y')/(L cos A)
!>     x = R cos q + L cos A - o_x,  x' = -R sin q q' - L sin A A' - o_x'
!>
!> d is the offset of the cylinder axis, the line y = d, from the crank axis. It enters here alone, and where a closed form
!> expresses L sin A by the crank angle (`ideal_chain`, `ideal_cylinders`).
!>
!> In the coordinates (q, A, x) an eccentricity is the difference of numbers that are 10^4 times larger; here it has full precision.
!>
!> A piston with clearance in its bore has two more coordinates: y of its centre of mass and its tilt b. With p = Rot(b) (U_p, V_p),
!> the position of the centre of mass relative to the pin's bearing, that bearing has the offset y - p_y, and o = c + e + (0, y -
!> p_y). Both y are counted from the cylinder axis.
module chain_motion
  use kinds, only: dp
  use train_motion, only: train_motion_t, most_stations, most_rings
  implicit none
  private
  public :: motion_t, tilting_t, accelerations_t, crank_pin, piston_pin, small_end, n_pins, n_bearings, most_shapes
  public :: body_crank, body_big_end, body_small_end, body_piston, body_pin, body_frame, n_bodies, angular_acceleration
  public :: turn_crank, follow_rod, follow_piston

  !> The pins of the chain.
  integer, parameter :: crank_pin = 1    !! pin on the crank, bearing in the rod
  integer, parameter :: piston_pin = 2   !! pin on the rod, bearing in the piston
  integer, parameter :: n_pins = 2
  integer, parameter :: small_end = 3    !! bearing of a floating piston pin in the rod; that in the piston is `piston_pin`
  integer, parameter :: n_bearings = 3

  !> The bodies as they turn at the pins; an elastic rod turns differently at its two ends.
  integer, parameter :: body_crank = 1, body_big_end = 2, body_small_end = 3, body_piston = 4, body_pin = 5
  integer, parameter :: n_bodies = 5
  integer, parameter :: body_frame = 0   !! it does not turn

  integer, parameter :: most_shapes = 16   !! largest number of bending and axial shapes of an elastic rod

  !> Position and motion of a piston with clearance in its bore. All components follow from the two coordinates (see
  !> `loose_piston`).
  type :: tilting_t
    real(dp) :: offset              !! y of its centre of mass [m]
    real(dp) :: offset_rate         !! [m/s]
    real(dp) :: tilt                !! b, positive from x to y [rad]
    real(dp) :: tilt_rate           !! [rad/s]
    real(dp) :: com(2)              !! p, from the pin's bearing to the centre of mass, along x and y [m]
    real(dp) :: across              !! y of the pin's bearing [m]
    real(dp) :: across_rate         !! [m/s]
    real(dp) :: com_velocity        !! of the centre of mass along x [m/s]
  end type tilting_t

  !> Positions and speeds of the three bodies at one instant.
  type :: motion_t
    real(dp) :: crank_angle         !! q [rad]
    real(dp) :: sin_crank, cos_crank
    real(dp) :: sin_rod, cos_rod    !! of A; cos A > 0
    real(dp) :: crank_speed         !! dq/dt [rad/s]
    real(dp) :: held_acceleration   !! d2q/dt2 of a crank with prescribed speed during its run-up; not set otherwise [rad/s^2]
    real(dp) :: rod_speed           !! dA/dt [rad/s]
    real(dp) :: piston_position     !! x of the centre of the pin's bearing [m]
    real(dp) :: piston_velocity     !! [m/s]
    real(dp) :: crank_pin(2)        !! c, eccentricity at the crank pin [m]; 0 if it is ideal
    real(dp) :: crank_pin_rate(2)   !! [m/s]
    real(dp) :: offset(2)           !! o = c + e, plus the offset of the pin's bearing in the bore [m]
    real(dp) :: offset_rate(2)      !! [m/s]
    type(tilting_t) :: tilting      !! for a piston with clearance in its bore
    real(dp) :: small_end(2)        !! -e_s, from a floating pin to the centre of its bearing in the rod [m]; else not set
    real(dp) :: small_end_rate(2)   !! [m/s]
    real(dp) :: pin_angle           !! turn of a floating pin since the start; no load depends on it [rad]
    real(dp) :: turning(n_bodies)   !! angular speeds of the bodies, positive from x to y; 0 for a piston that does not tilt [rad/s]
    ! the following components are for elastic members only
    real(dp) :: chord                       !! distance between the pins of an elastic rod; the chord has the angle A [m]
    real(dp) :: chord_rate                  !! [m/s]
    real(dp) :: shape(most_shapes)          !! amplitude of each shape of an elastic rod [m]
    real(dp) :: shape_rate(most_shapes)     !! [m/s]
    real(dp) :: flywheel_angle              !! angle of the other end of an elastic crankshaft [rad]
    real(dp) :: flywheel_speed              !! [rad/s]
    type(train_motion_t) :: train           !! of the stations of a crankshaft with several cylinders
  end type motion_t

  !> Accelerations of the three bodies.
  type :: accelerations_t
    real(dp) :: crank               !! d2q/dt2 [rad/s^2]
    real(dp) :: rod                 !! d2A/dt2 [rad/s^2]
    real(dp) :: piston              !! [m/s^2]
    real(dp) :: pin(2, n_bearings)  !! (:, pin): of its eccentricity, and of -e_s of a floating pin [m/s^2]; 0 for an ideal pin
    real(dp) :: pin_turn            !! of a floating pin [rad/s^2]
    real(dp) :: offset, tilt        !! of a piston with clearance in its bore [m/s^2], [rad/s^2]
    real(dp) :: rod_end(n_pins)  !! of the rod's rotation at its ends, positive from x to y [rad/s^2]; needed if surfaces may stick
    real(dp) :: shape(most_shapes)  !! of the shapes of an elastic rod [m/s^2]
    real(dp) :: flywheel            !! of the other end of an elastic crankshaft [rad/s^2]
    real(dp) :: station(most_stations), ring(most_rings)   !! of a crankshaft with several cylinders [rad/s^2]
  end type accelerations_t

contains

  !> Angular acceleration of a body, positive from x to y [rad/s^2].
  pure real(dp) function angular_acceleration(accelerations, body) result(acceleration)
    type(accelerations_t), intent(in) :: accelerations
    integer, intent(in) :: body
    select case (body)
    case (body_crank)
      acceleration = accelerations%crank
    case (body_big_end)
      acceleration = accelerations%rod_end(crank_pin)
    case (body_small_end)
      acceleration = accelerations%rod_end(piston_pin)
    case (body_pin)
      acceleration = accelerations%pin_turn
    case default
      acceleration = accelerations%tilt
    end select
  end function angular_acceleration

  !> Set the crank of a motion: its angle [rad] with sine and cosine, and its speed [rad/s].
  pure subroutine turn_crank(motion, crank_angle, crank_speed)
    type(motion_t), intent(inout) :: motion
    real(dp), value, intent(in) :: crank_angle, crank_speed
    motion%crank_angle = crank_angle
    motion%sin_crank = sin(crank_angle)
    motion%cos_crank = cos(crank_angle)
    motion%crank_speed = crank_speed
    motion%turning(body_crank) = crank_speed
    motion%turning(body_piston) = 0
  end subroutine turn_crank

  !> Set the rod of a motion whose crank and offset are known. `reachable` is false if there is no rod angle, where |R sin q - d -
  !> o_y| >= L.
  pure subroutine follow_rod(crank_length, per_rod_length, axis_offset, motion, reachable)
    real(dp), intent(in) :: crank_length, per_rod_length   !! R [m], 1/L [1/m]
    real(dp), intent(in) :: axis_offset                    !! d [m]
    type(motion_t), intent(inout) :: motion
    logical, intent(out) :: reachable
    real(dp) :: gap
    motion%sin_rod = (crank_length*motion%sin_crank - axis_offset - motion%offset(2))*per_rod_length
    gap = (1 - motion%sin_rod)*(1 + motion%sin_rod)
    reachable = gap > 0
    if (.not. reachable) return
    motion%cos_rod = sqrt(gap)
    ! over cos A = cos A/gap: this division is independent of the square root
    motion%rod_speed = (crank_length*motion%cos_crank*motion%crank_speed - motion%offset_rate(2))*per_rod_length/gap &
      *motion%cos_rod
    motion%turning(body_big_end:body_small_end) = -motion%rod_speed
  end subroutine follow_rod

  !> Set the piston of a motion whose crank and rod are known.
  pure subroutine follow_piston(crank_length, rod_length, motion)
    real(dp), intent(in) :: crank_length, rod_length       !! R, L [m]
    type(motion_t), intent(inout) :: motion
    motion%piston_position = crank_length*motion%cos_crank + rod_length*motion%cos_rod - motion%offset(1)
    motion%piston_velocity = -crank_length*motion%sin_crank*motion%crank_speed - rod_length*motion%sin_rod*motion%rod_speed &
      - motion%offset_rate(1)
  end subroutine follow_piston
end module chain_motion
