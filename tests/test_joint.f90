!> Motion in a joint with clearance.
module test_joint
  use kinds, only: dp
  use checks, only: checks_t
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, body_crank, body_big_end, body_small_end
  use clearance_joint, only: clearance_joint_t
  use joint_evaluation, only: joint_evaluation_t, find_polar, find_sliding, sliding_acceleration, outward_acceleration
  implicit none
  private
  public :: run_test_joint

contains

  subroutine run_test_joint(check)
    class(checks_t), intent(inout) :: check
    call polar_terms(check)
    call accelerations_in_the_joint(check)
  end subroutine run_test_joint

  subroutine polar_terms(check)
    class(checks_t), intent(inout) :: check
    type(joint_evaluation_t) :: joint
    joint%eccentricity = [3e-5_dp, -4e-5_dp]
    joint%eccentricity_rate = [0.2_dp, 0.1_dp]
    joint%pin_angular_speed = 10
    joint%bearing_speed = 0
    call find_polar(1e-4_dp, joint)
    call find_sliding(0.0099_dp, joint)
    call check%close_to(joint%distance, 5e-5_dp, 1e-19_dp, 'eccentricity')
    call check%close_to(joint%penetration, -5e-5_dp, 1e-19_dp, 'penetration')
    call check%close_to(joint%penetration_rate, 0.2_dp*0.6_dp - 0.1_dp*0.8_dp, 1e-15_dp, 'normal rate')
    call check%close_to(joint%sliding_speed, 0.2_dp*0.8_dp + 0.1_dp*0.6_dp + 10*0.0099_dp, 1e-15_dp, 'sliding speed')
    joint%bearing_speed = -30
    call find_sliding(0.0099_dp, joint)
    call check%close_to(joint%sliding_speed, 0.2_dp*0.8_dp + 0.1_dp*0.6_dp + 10*0.0099_dp + 30*(0.0099_dp + 5e-5_dp), 1e-15_dp, &
      'sliding speed with a rotating bearing')
    joint%eccentricity = 0
    call find_polar(1e-4_dp, joint)
    call check%close_to(norm2(joint%normal), 1.0_dp, 0.0_dp, 'the normal is a unit vector at the centre too')
  end subroutine polar_terms

  !> Rates of the sliding speed and of the penetration rate, at both pins, against their central differences along a motion.
  subroutine accelerations_in_the_joint(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: dt = 1e-7_dp, radius = 0.0099_dp
    type(joint_evaluation_t) :: before, now, after
    type(accelerations_t) :: a
    type(clearance_joint_t) :: joint
    integer :: place
    a%crank = 300
    a%rod_end = [700.0_dp, 600.0_dp]
    a%tilt = 0
    a%pin(:, :2) = reshape([4.0_dp, -7.0_dp, 9.0_dp, 3.0_dp], [2, 2])
    do place = crank_pin, piston_pin
      call joint%set_place(place)
      joint%bearing_turns = place == crank_pin
      before = joint_after(-dt)
      now = joint_after(0.0_dp)
      after = joint_after(dt)
      call check%close_to((after%sliding_speed - before%sliding_speed)/(2*dt), &
        sliding_acceleration(radius, now, joint%relative_rates(a), at_rest=.false.), 1e-3_dp, 'sliding acceleration [m/s2]')
      call check%close_to((after%penetration_rate - before%penetration_rate)/(2*dt), &
        outward_acceleration(now, joint%relative_rates(a)), 1e-3_dp, 'outward acceleration [m/s2]')
    end do

  contains

    type(joint_evaluation_t) function joint_after(t)
      real(dp), intent(in) :: t
      type(motion_t) :: motion
      motion%turning(body_crank) = 20 + a%crank*t
      motion%turning(body_big_end:body_small_end) = -40 + a%rod_end*t
      joint_after%eccentricity = [3e-4_dp, -4e-4_dp] + [0.02_dp, 0.01_dp]*t + 0.5_dp*a%pin(:, place)*t**2
      joint_after%eccentricity_rate = [0.02_dp, 0.01_dp] + a%pin(:, place)*t
      call joint%find_speeds(motion, joint_after)
      call find_polar(1e-4_dp, joint_after)
      call find_sliding(radius, joint_after)
    end function joint_after
  end subroutine accelerations_in_the_joint
end module test_joint
