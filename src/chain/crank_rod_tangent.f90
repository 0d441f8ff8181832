!> Derivatives of the equations of motion of crank with rod and piston with respect to the state, for implicit integration: the
!> tangent of `follow_rod` and of `accelerate_crank_rod`.
module crank_rod_tangent
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, piston_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  implicit none
  private
  public :: rod_slopes, acceleration_slopes, torque_slopes

contains

  !> Derivatives of A and A' with respect to q and e_y. Those of A are also the derivatives of A' with respect to q' and e_y'.
  pure subroutine rod_slopes(bodies, motion, angle, speed)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: angle(2), speed(2)
    associate (r => bodies%crank%length)
      angle = [r*motion%cos_crank, -1.0_dp]/(bodies%rod%length*motion%cos_rod)
      speed = motion%rod_speed*(motion%sin_rod/motion%cos_rod)*angle
      speed(1) = speed(1) - r*motion%sin_crank*motion%crank_speed/(bodies%rod%length*motion%cos_rod)
    end associate
  end subroutine rod_slopes

  !> Derivatives of q'', e_x'' and e_y'' with respect to q, A, q' and A', as if these were independent, and to force and moment on
  !> the piston pin.
  pure subroutine acceleration_slopes(bodies, drive, loads, motion, accelerations, by_motion, by_loads)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: by_motion(3, 4), by_loads(3, 3)
    real(dp) :: m12, slope, on_crank(7), on_rod(7), per_determinant, per_rod_term, changes(3, 7), crank, rod
    integer :: i

    call bodies%coupling(motion, m12, slope)
    associate (f => loads%force(:, piston_pin), r => bodies%crank%length, l => bodies%rod%length, m22 => bodies%rod_term, &
               sq => motion%sin_crank, cq => motion%cos_crank, sa => motion%sin_rod, ca => motion%cos_rod, &
               qd => motion%crank_speed, ad => motion%rod_speed, qdd => accelerations%crank, add => accelerations%rod)
      ! the right-hand sides of the equations for q'' and A'', and the changes of e_x'' and e_y'' for given q'' and A''
      on_crank(2) = m12*ad**2 - slope*add
      on_rod(1) = m12*qd**2 - slope*qdd
      on_crank(1) = on_crank(2) + bodies%crank_weight(1)*cq - bodies%crank_weight(2)*sq - r*(f(2)*sq + f(1)*cq)
      on_rod(2) = on_rod(1) + bodies%rod_weight(1)*ca + bodies%rod_weight(2)*sa - l*(f(1)*ca - f(2)*sa)
      on_crank(3:) = [-drive%damping, -2*slope*ad, -r*sq, r*cq, 0.0_dp]
      on_rod(3:) = [-2*slope*qd, 0.0_dp, -l*sa, -l*ca, -1.0_dp]
      changes(2, :) = [r*(sq*qd**2 - cq*qdd), l*(sa*ad**2 - ca*add), -2*r*cq*qd, -2*l*ca*ad, bodies%per_piston_mass, 0.0_dp, 0.0_dp]
      changes(3, :) = [-r*(cq*qd**2 + sq*qdd), l*(ca*ad**2 + sa*add), -2*r*sq*qd, 2*l*sa*ad, 0.0_dp, 0.0_dp, 0.0_dp]
      per_determinant = 0
      if (drive%free_crank) per_determinant = 1/(drive%inertia*m22 + (bodies%inertia_product - m12**2))
      per_rod_term = 1/m22
      do i = 1, 7
        crank = (on_crank(i)*m22 - on_rod(i)*m12)*per_determinant
        rod = (on_rod(i) - m12*crank)*per_rod_term
        changes(:, i) = [crank, changes(2, i) - r*sq*crank - l*sa*rod, changes(3, i) + r*cq*crank - l*ca*rod]
      end do
    end associate
    by_motion = changes(:, :4)
    by_loads = changes(:, 5:)
  end subroutine acceleration_slopes

  !> Derivatives of q'', e_x'' and e_y'' with respect to a torque on the crank.
  pure subroutine torque_slopes(bodies, drive, motion, by_torque)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: by_torque(3)
    real(dp) :: m12, slope, rod
    by_torque = 0
    if (.not. drive%free_crank) return
    call bodies%coupling(motion, m12, slope)
    associate (r => bodies%crank%length, l => bodies%rod%length, m22 => bodies%rod_term, crank => by_torque(1))
      crank = m22/(drive%inertia*m22 + (bodies%inertia_product - m12**2))
      rod = -m12*crank/m22
      by_torque(2) = -r*motion%sin_crank*crank - l*motion%sin_rod*rod
      by_torque(3) = r*motion%cos_crank*crank - l*motion%cos_rod*rod
    end associate
  end subroutine torque_slopes
end module crank_rod_tangent
