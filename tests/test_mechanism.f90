!> Bodies, ideal joint and scenes against closed forms and identities.
module test_mechanism
  use kinds, only: dp
  use constants, only: pi, degree
  use checks, only: checks_t
  use mechanism, only: mechanism_t, motion_t, accelerations_t, turn_crank
  use dynamics, only: drive_t, loads_t, accelerations_under
  use ideal_joint, only: ideal_motion, ideal_accelerations
  use clearance_joint, only: find_rod, find_piston, find_joint_motion, sliding_speed, joint_motion_t, joint_geometry_t
  use reactions, only: reactions_t, reactions_of
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_mechanism

contains

  subroutine run_test_mechanism(check)
    class(checks_t), intent(inout) :: check
    call published_values(check)
    call held_and_free_crank_agree(check)
    call lagrange_is_energy_consistent(check)
    call reactions_match_the_joint(check)
    call coordinates_agree(check)
    call ideal_is_the_centred_joint(check)
    call ideal_scene_runs(check)
  end subroutine run_test_mechanism

  !> The mechanism of appendix B (Flores).
  pure function flores() result(m)
    type(mechanism_t) :: m
    m = mechanism_t(0.05_dp, 0.30_dp, 1e-5_dp, [0.025_dp, 0.0_dp], 0.12_dp, 0.21_dp, 2.5e-4_dp, [0.06_dp, 0.0_dp], &
      0.14_dp, 0.0_dp)
  end function flores

  !> A mechanism without symmetries: centres of mass off the axes, gravity.
  pure function crooked() result(m)
    type(mechanism_t) :: m
    m = mechanism_t(0.05_dp, 0.8_dp, 0.006_dp, [0.012_dp, -0.007_dp], 0.2_dp, 1.3_dp, 0.01_dp, [0.06_dp, 0.009_dp], &
      0.9_dp, 9.80665_dp)
  end function crooked

  !> Slider acceleration at the dead centres and the largest crank moment of the ideal Flores mechanism at 5000 rpm.
  subroutine published_values(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: speed = 5000*pi/30
    call check%close_to(acceleration_at(0.0_dp), -19419.360511_dp, 1e-6_dp, 'slider acceleration at the top')
    call check%close_to(acceleration_at(180.0_dp), 7996.207269_dp, 1e-6_dp, 'slider acceleration at the bottom')
    call check%close_to(abs(moment_at(34.974_dp)), 138.521666_dp, 1e-6_dp, 'crank moment at 34.974 deg')
    call check%close_to(abs(moment_at(-34.974_dp)), 138.521666_dp, 1e-6_dp, 'crank moment at -34.974 deg')
    call check%close_to(moment_at(34.974_dp) + moment_at(-34.974_dp), 0.0_dp, 1e-9_dp, 'crank moment is odd')

  contains

    real(dp) function acceleration_at(angle)
      real(dp), intent(in) :: angle
      type(accelerations_t) :: a
      type(loads_t) :: loads
      real(dp) :: moment
      loads%gas_force = 0
      call ideal_accelerations(flores(), drive_t(.false.), ideal_motion(flores(), angle*degree, speed), loads, a, moment)
      acceleration_at = a%piston
    end function acceleration_at

    real(dp) function moment_at(angle)
      real(dp), intent(in) :: angle
      type(accelerations_t) :: a
      type(loads_t) :: loads
      loads%gas_force = 0
      call ideal_accelerations(flores(), drive_t(.false.), ideal_motion(flores(), angle*degree, speed), loads, a, moment_at)
    end function moment_at
  end subroutine published_values

  !> A free crank under the moment that holds the speed does not accelerate, with either joint.
  subroutine held_and_free_crank_agree(check)
    class(checks_t), intent(inout) :: check
    type(loads_t) :: loads
    type(accelerations_t) :: held, free
    type(motion_t) :: motion
    real(dp) :: moment, same
    motion = ideal_motion(crooked(), 0.7_dp, 120.0_dp)
    loads%gas_force = 321
    call ideal_accelerations(crooked(), drive_t(.false., 0.0_dp, 0.1_dp), motion, loads, held, moment)
    call ideal_accelerations(crooked(), drive_t(.true., moment, 0.1_dp), motion, loads, free, same)
    call check%close_to(free%crank, 0.0_dp, 1e-8_dp, 'ideal: the holding moment holds')
    call check%relative(free%piston, held%piston, 1e-12_dp, 'ideal: and the piston does not notice')
    loads = loads_t([300.0_dp, -200.0_dp], 3.0_dp, 50.0_dp)
    call accelerations_under(crooked(), drive_t(.false., 0.0_dp, 0.1_dp), loads, motion, held, moment)
    call accelerations_under(crooked(), drive_t(.true., moment, 0.1_dp), loads, motion, free, same)
    call check%close_to(free%crank, 0.0_dp, 1e-8_dp, 'clearance: the holding moment holds')
    call check%relative(free%rod, held%rod, 1e-12_dp, 'clearance: and the rod does not notice')
  end subroutine held_and_free_crank_agree

  !> dE/dt by central differences along the motion equals the power of the loads: tests every term of Lagrange's equations.
  subroutine lagrange_is_energy_consistent(check)
    class(checks_t), intent(inout) :: check
    type(mechanism_t) :: m
    type(motion_t) :: motion
    type(accelerations_t) :: a
    type(loads_t) :: loads
    type(drive_t) :: drive
    real(dp) :: q, rod, qd, rodd, xd, moment, power, slope, dt, bend(2)
    integer :: i

    m = crooked()
    drive = drive_t(.true., 4.0_dp, 0.02_dp)
    loads = loads_t([800.0_dp, -350.0_dp], 2.5_dp, 900.0_dp)
    dt = 1e-6_dp
    a = accelerations_t(0.0_dp, 0.0_dp, 0.0_dp, [0.0_dp, 0.0_dp])
    do i = 1, 12
      q = 0.55_dp*i
      rod = 0.2_dp*sin(1.3_dp*i)
      qd = 90
      rodd = -25 + 7*i
      xd = 3.0_dp - 0.4_dp*i
      motion = state_of(0.0_dp)
      call accelerations_under(m, drive, loads, motion, a, moment)
      slope = (energy_after(dt) - energy_after(-dt))/(2*dt)
      associate (v => [-m%crank_length*motion%sin_crank*qd - m%rod_length*motion%sin_rod*rodd, &
                       m%crank_length*motion%cos_crank*qd - m%rod_length*motion%cos_rod*rodd])
        power = dot_product(loads%pin_force, v) - loads%pin_moment*rodd - (loads%pin_force(1) + loads%gas_force)*xd &
          + (drive%torque - drive%damping*qd)*qd
      end associate
      call check%close_to(slope, power, 1e-6_dp*max(1e4_dp, abs(power)), 'energy balance of the equations of motion')
      bend = (eccentricity_after(dt) - 2*eccentricity_after(0.0_dp) + eccentricity_after(-dt))/dt**2
      call check%close_to(norm2(a%eccentricity - bend), 0.0_dp, 1e-2_dp, 'acceleration of the eccentricity [m/s2]')
    end do

  contains

    type(motion_t) function state_of(t)
      real(dp), intent(in) :: t
      real(dp) :: qt, rt
      qt = q + qd*t + 0.5_dp*a%crank*t**2
      rt = rod + rodd*t + 0.5_dp*a%rod*t**2
      state_of = motion_t(qt, sin(qt), cos(qt), sin(rt), cos(rt), qd + a%crank*t, rodd + a%rod*t, &
        0.3_dp + xd*t + 0.5_dp*a%piston*t**2, xd + a%piston*t)
    end function state_of

    real(dp) function energy_after(t)
      real(dp), intent(in) :: t
      energy_after = m%kinetic_energy(state_of(t)) + m%potential_energy(state_of(t))
    end function energy_after

    !> Pin on the rod - piston.
    function eccentricity_after(t) result(e)
      real(dp), intent(in) :: t
      real(dp) :: e(2)
      type(motion_t) :: there
      there = state_of(t)
      e = [m%crank_length*there%cos_crank + m%rod_length*there%cos_rod - there%piston_position, &
        m%crank_length*there%sin_crank - m%rod_length*there%sin_rod]
    end function eccentricity_after
  end subroutine lagrange_is_energy_consistent

  !> The whole mechanism at (q, e) and their rates.
  pure subroutine clearance_motion(mechanism, q, crank_speed, eccentricity, eccentricity_rate, motion, reachable)
    type(mechanism_t), intent(in) :: mechanism
    real(dp), intent(in) :: q, crank_speed, eccentricity(2), eccentricity_rate(2)
    type(motion_t), intent(out) :: motion
    logical, intent(out) :: reachable
    call turn_crank(motion, q, crank_speed)
    call find_rod(mechanism, eccentricity, eccentricity_rate, motion, reachable)
    if (reachable) call find_piston(mechanism, eccentricity, eccentricity_rate, motion)
  end subroutine clearance_motion

  !> The whole joint.
  pure function joint_motion(geometry, eccentricity, eccentricity_rate, pin_speed) result(joint)
    type(joint_geometry_t), intent(in) :: geometry
    real(dp), intent(in) :: eccentricity(2), eccentricity_rate(2), pin_speed
    type(joint_motion_t) :: joint
    joint%eccentricity = eccentricity
    joint%eccentricity_rate = eccentricity_rate
    call find_joint_motion(geometry, joint)
    joint%sliding_speed = sliding_speed(geometry, joint%tangential_rate, pin_speed)
  end function joint_motion

  !> F5 = -F_x and F6 = -F_y to rounding, and the crank equation balances with F3, F4 at the crank pin.
  subroutine reactions_match_the_joint(check)
    class(checks_t), intent(inout) :: check
    type(mechanism_t) :: m
    type(motion_t) :: motion
    type(accelerations_t) :: a
    type(reactions_t) :: r
    type(loads_t) :: loads
    real(dp) :: moment, balance
    logical :: reachable
    integer :: i

    m = crooked()
    do i = 1, 20
      call clearance_motion(m, 0.33_dp*i, 150.0_dp, [1e-4_dp*sin(1.0_dp*i), 1e-4_dp*cos(2.0_dp*i)], &
        [0.3_dp*cos(3.0_dp*i), 0.2_dp*sin(5.0_dp*i)], motion, reachable)
      loads = loads_t([900*sin(0.7_dp*i), 500*cos(1.1_dp*i)], 2*sin(2.0_dp*i), 400*cos(0.2_dp*i))
      call accelerations_under(m, drive_t(.true., 3.0_dp, 0.05_dp), loads, motion, a, moment)
      r = reactions_of(m, loads, motion, a)
      call check%close_to(r%pin(1), -loads%pin_force(1), 1e-9_dp, 'F5 = -F_x')
      call check%close_to(r%pin(2), -loads%pin_force(2), 1e-9_dp, 'F6 = -F_y')
      ! moments on the crank about its bearing: the rod's force (-F3, -F4) at the pin, gravity, drive, damping
      balance = m%crank_length*(-r%crankpin(2)*motion%cos_crank + r%crankpin(1)*motion%sin_crank) + moment &
        - 0.05_dp*motion%crank_speed + m%crank_mass*m%gravity*(m%crank_com(1)*motion%sin_crank &
        + m%crank_com(2)*motion%cos_crank) - (m%crank_inertia + m%crank_mass*sum(m%crank_com**2))*a%crank
      call check%close_to(balance, 0.0_dp, 1e-9_dp, 'moments on the crank with F3 and F4')
    end do
  end subroutine reactions_match_the_joint

  !> (q, e) and (q, A, x) describe the same motion, and the sliding speed is the material one.
  subroutine coordinates_agree(check)
    class(checks_t), intent(inout) :: check
    type(mechanism_t) :: m
    type(motion_t) :: motion
    type(joint_motion_t) :: joint
    real(dp) :: pin(2), rate(2), rod
    logical :: reachable

    m = crooked()
    call clearance_motion(m, 1.1_dp, 80.0_dp, [3e-5_dp, -4e-5_dp], [0.2_dp, 0.1_dp], motion, reachable)
    rod = asin(motion%sin_rod)
    pin = [m%crank_length*cos(1.1_dp) + m%rod_length*cos(rod), m%crank_length*sin(1.1_dp) - m%rod_length*sin(rod)]
    rate = [-m%crank_length*sin(1.1_dp)*80 - m%rod_length*sin(rod)*motion%rod_speed, &
      m%crank_length*cos(1.1_dp)*80 - m%rod_length*cos(rod)*motion%rod_speed]
    call check%that(reachable, 'the pin can be there')
    call check%close_to(pin(1) - motion%piston_position, 3e-5_dp, 1e-16_dp, 'e_x from the positions')
    call check%close_to(pin(2), -4e-5_dp, 1e-16_dp, 'e_y from the positions')
    call check%close_to(rate(1) - motion%piston_velocity, 0.2_dp, 1e-14_dp, 'e_x rate from the speeds')
    call check%close_to(rate(2), 0.1_dp, 1e-14_dp, 'e_y rate from the speeds')
    joint = joint_motion(joint_geometry_t(1e-4_dp, 0.01_dp, 0.0099_dp), [3e-5_dp, -4e-5_dp], [0.2_dp, 0.1_dp], 10.0_dp)
    call check%close_to(joint%distance, 5e-5_dp, 1e-19_dp, 'eccentricity')
    call check%close_to(joint%penetration_rate, 0.2_dp*0.6_dp - 0.1_dp*0.8_dp, 1e-15_dp, 'normal rate')
    call check%close_to(joint%sliding_speed, 0.2_dp*0.8_dp + 0.1_dp*0.6_dp + 10*0.0099_dp, 1e-15_dp, 'sliding speed')
    joint = joint_motion(joint_geometry_t(1e-4_dp, 0.01_dp, 0.0099_dp), [0.0_dp, 0.0_dp], [0.2_dp, 0.1_dp], 10.0_dp)
    call check%close_to(norm2(joint%normal), 1.0_dp, 0.0_dp, 'a direction at the centre too')
    call clearance_motion(m, 0.0_dp, 80.0_dp, [0.0_dp, 0.3_dp], [0.0_dp, 0.0_dp], motion, reachable)
    call check%that(.not. reachable, 'a pin farther off than the rod is long is refused')
  end subroutine coordinates_agree

  !> The force of the ideal joint, put on the bodies as a load, gives the accelerations of the ideal joint.
  subroutine ideal_is_the_centred_joint(check)
    class(checks_t), intent(inout) :: check
    type(mechanism_t) :: m
    type(drive_t) :: drive
    type(motion_t) :: ideal, centred
    type(loads_t) :: loads
    type(accelerations_t) :: a, b
    real(dp) :: moment
    logical :: reachable
    integer :: i

    m = crooked()
    drive = drive_t(.true., 7.0_dp, 0.03_dp)
    do i = 1, 12
      ideal = ideal_motion(m, 0.6_dp*i, 200.0_dp)
      call clearance_motion(m, 0.6_dp*i, 200.0_dp, [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], centred, reachable)
      call check%relative(centred%rod_speed, ideal%rod_speed, 1e-14_dp, 'rod speed of the centred pin')
      loads%gas_force = 500
      call ideal_accelerations(m, drive, ideal, loads, a, moment)
      call accelerations_under(m, drive, loads, centred, b, moment)
      call check%relative(b%crank, a%crank, 1e-10_dp, 'crank acceleration of the ideal joint')
      call check%relative(b%rod, a%rod, 1e-10_dp, 'rod acceleration of the ideal joint')
      call check%relative(b%piston, a%piston, 1e-10_dp, 'piston acceleration of the ideal joint')
    end do
  end subroutine ideal_is_the_centred_joint

  !> A free ideal mechanism without losses keeps its energy; the held one's work is that of the moment.
  subroutine ideal_scene_runs(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case('cases/sim_I.nml', [character(len=40) :: 'integrator.relative_tolerance=1e-10'], .true.)
    call check%that(.not. allocated(trace%error), 'the ideal twin of simulation I runs')
    associate (e => trace%values(column(trace, 'energy[J]'), :), r => trace%values(column(trace, 'energy_residual[J]'), :))
      call check%close_to(maxval(abs(r))/e(1), 0.0_dp, 1e-8_dp, 'its energy is conserved')
    end associate
    call check%that(column(trace, 'film_thickness[m]') == 0, 'an ideal joint has no film column')
    trace = run_case('cases/flores/ideal.nml', [character(len=40) :: ])
    associate (r => trace%values(column(trace, 'energy_residual[J]'), :), e => trace%values(column(trace, 'energy[J]'), :))
      call check%close_to(maxval(abs(r))/maxval(e), 0.0_dp, 1e-5_dp, 'work of the holding moment')
      call check%that(maxval(e) - minval(e) > 0.1_dp*maxval(e), 'which is not nothing')
    end associate
  end subroutine ideal_scene_runs
end module test_mechanism
