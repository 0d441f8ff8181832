!> Derivatives of the equations of motion of crank with rod and piston with respect to the state, for implicit integration: the
!> tangent of `follow_rod` and of `accelerate_crank_rod`, one direction at a time.
module crank_rod_tangent
  use gudgeon_kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, piston_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  implicit none
  private
  public :: motion_change_t, load_change_t, motion_change, acceleration_change

  !> A small change of the motion, per unit change of the state.
  type :: motion_change_t
    real(dp) :: crank_angle = 0, rod_angle = 0
    real(dp) :: crank_speed = 0, rod_speed = 0
  end type motion_change_t

  !> A small change of the loads.
  type :: load_change_t
    real(dp) :: force(2) = 0    !! on the piston pin
    real(dp) :: moment = 0      !! on the piston pin
    real(dp) :: axial_force = 0   !! on the piston along -x
  end type load_change_t

contains

  !> Change of the motion for changes of q, q', e_y, e_y' (e_x and e_x' change the piston's motion only).
  pure type(motion_change_t) function motion_change(bodies, motion, crank_angle, crank_speed, e_y, e_y_rate) result(change)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: crank_angle, crank_speed, e_y, e_y_rate
    associate (r => bodies%crank%length, arm => bodies%rod%length*motion%cos_rod)
      change%crank_angle = crank_angle
      change%crank_speed = crank_speed
      change%rod_angle = (r*motion%cos_crank*crank_angle - e_y)/arm
      change%rod_speed = (r*(motion%cos_crank*crank_speed - motion%sin_crank*motion%crank_speed*crank_angle) - e_y_rate)/arm &
        + motion%rod_speed*(motion%sin_rod/motion%cos_rod)*change%rod_angle
    end associate
  end function motion_change

  !> Changes of q'', e_x'', e_y'' for a change of the motion and of the loads.
  pure function acceleration_change(bodies, drive, loads, motion, accelerations, change, load_change) result(a)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(motion_change_t), intent(in) :: change
    type(load_change_t), intent(in) :: load_change
    real(dp) :: a(3)
    real(dp) :: m11, m12, m22, slope, sum_angle, on_crank, on_rod, crank, rod, weight_c, weight_r(2)

    call bodies%coupling(motion, m12, slope)
    m11 = bodies%crank_term
    m22 = bodies%rod_term
    weight_c = bodies%crank_weight(1)*motion%cos_crank - bodies%crank_weight(2)*motion%sin_crank
    weight_r = bodies%rod_weight
    sum_angle = change%crank_angle + change%rod_angle
    associate (f => loads%force(:, piston_pin), df => load_change%force, r => bodies%crank%length, l => bodies%rod%length, &
               sq => motion%sin_crank, cq => motion%cos_crank, sa => motion%sin_rod, ca => motion%cos_rod, &
               qd => motion%crank_speed, ad => motion%rod_speed)
      on_crank = weight_c*change%crank_angle + m12*sum_angle*ad**2 - 2*slope*ad*change%rod_speed &
        - drive%damping*change%crank_speed + r*(df(2)*cq - df(1)*sq - (f(2)*sq + f(1)*cq)*change%crank_angle) &
        - slope*sum_angle*accelerations%rod
      on_rod = (weight_r(1)*ca + weight_r(2)*sa)*change%rod_angle + m12*sum_angle*qd**2 - 2*slope*qd*change%crank_speed &
        - load_change%moment - l*(df(1)*sa + df(2)*ca + (f(1)*ca - f(2)*sa)*change%rod_angle) &
        - slope*sum_angle*accelerations%crank
      crank = 0
      if (drive%free_crank) crank = (on_crank*m22 - on_rod*m12)/(m11*m22 - m12**2)
      rod = (on_rod - m12*crank)/m22
      a(1) = crank
      a(2) = r*(sq*qd**2 - cq*accelerations%crank)*change%crank_angle - 2*r*cq*qd*change%crank_speed - r*sq*crank &
        + l*(sa*ad**2 - ca*accelerations%rod)*change%rod_angle - 2*l*ca*ad*change%rod_speed - l*sa*rod &
        + (load_change%axial_force + df(1))/bodies%piston%mass
      a(3) = -r*(cq*qd**2 + sq*accelerations%crank)*change%crank_angle - 2*r*sq*qd*change%crank_speed + r*cq*crank &
        + l*(ca*ad**2 + sa*accelerations%rod)*change%rod_angle + 2*l*sa*ad*change%rod_speed - l*ca*rod
    end associate
  end function acceleration_change
end module crank_rod_tangent
