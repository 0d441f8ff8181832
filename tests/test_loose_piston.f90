!> A piston with clearance in its bore: Newton's and Euler's laws for every body, the energy of bodies whose velocities are computed
!> from their positions, and agreement of the two ways to compute accelerations.
module test_loose_piston
  use kinds, only: dp
  use constants, only: pi
  use checks, only: checks_t
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, turn_crank
  use chain_bodies, only: crank_t, rod_t, piston_t, drive_t, new_bodies
  use chain_loads, only: loads_t, unloaded, bearing_moment
  use chain_reactions, only: reactions_t
  use mechanism_chain, only: chain_t
  use assembled_chain, only: accelerate_assembled
  use loose_piston, only: place_piston, move_centre, centre_acceleration
  use energy_of_bodies, only: energy_slope
  use random_numbers, only: random_numbers_t
  implicit none
  private
  public :: run_test_loose_piston

  integer, parameter :: trials = 40
  character(len=28), parameter :: pieces(0:3) = [character(len=28) :: 'ideal pins', 'clearance at the crank pin', &
    'clearance at the piston pin', 'clearance at both pins']

contains

  subroutine run_test_loose_piston(check)
    class(checks_t), intent(inout) :: check
    call both_ways_agree(check)
    call energy_changes_by_the_power(check)
    call newton_and_euler_hold(check)
    call loads_respond_linearly(check)
  end subroutine run_test_loose_piston

  !> A chain of random dimensions at a random state under random loads. Piece 0 to 3 is the sum of 1 for clearance at the crank
  !> pin and 2 for clearance at the piston pin.
  subroutine draw(random, piece, chain, motion, loads, z, z_rate)
    type(random_numbers_t), intent(inout) :: random
    integer, intent(in) :: piece
    type(chain_t), intent(out) :: chain
    type(motion_t), intent(out) :: motion
    type(loads_t), intent(out) :: loads
    real(dp), intent(out) :: z(7), z_rate(7)   !! (q, c, e, offset, tilt)
    logical :: reachable
    integer :: pin, i
    chain%bodies = new_bodies(crank_t(0.05_dp*(1 + u()), 0.5_dp + u(), 1e-3_dp*(1 + u()), 0.02_dp*[u(), u()]), &
      rod_t(0.2_dp*(1 + u()), 0.5_dp + u(), 1e-3_dp*(1 + u()), [0.1_dp*u(), 0.02_dp*u()]), &
      piston_t(0.5_dp + u(), .true., 1e-3_dp*(1 + u()), [0.03_dp*u() - 0.01_dp, 0.01_dp*u() - 0.005_dp], 0.01_dp), &
      9.80665_dp*[-cos(6*u()), -sin(6*u())])
    chain%drive = drive_t(u() < 0.5_dp, 40*u() - 20, 0.1_dp*u(), 0.0_dp, 0.0_dp)
    chain%is_loose = [modulo(piece, 2) == 1, piece > 1]
    z = [10*u(), (1e-3_dp*(2*u() - 1), i=1, 5), 0.1_dp*(2*u() - 1)]
    z_rate = [600*u() - 300, (4*u() - 2, i=1, 5), 100*u() - 50]
    loads%axial_force = 1e4_dp*u()
    loads%bore_force = 1e4_dp*(2*u() - 1)
    loads%bore_moment = 100*(2*u() - 1)
    loads = unloaded
    do pin = 1, 2
      loads%force(:, pin) = merge(1, 0, chain%is_loose(pin))*1e4_dp*[2*u() - 1, 2*u() - 1]
      loads%moment(pin) = merge(1, 0, chain%is_loose(pin))*(10*u() - 5)
      if (chain%is_loose(pin)) cycle
      z(2*pin:2*pin + 1) = 0
      z_rate(2*pin:2*pin + 1) = 0
    end do
    call turn_crank(motion, z(1), z_rate(1))
    motion%crank_pin = z(2:3)
    motion%crank_pin_rate = z_rate(2:3)
    motion%offset = z(2:3) + z(4:5)
    motion%offset_rate = z_rate(2:3) + z_rate(4:5)
    motion%tilting%offset = z(6)
    motion%tilting%offset_rate = z_rate(6)
    motion%tilting%tilt = z(7)
    motion%tilting%tilt_rate = z_rate(7)
    call place_piston(chain%bodies%piston, motion)
    call chain%move_rod(motion, reachable)
    if (.not. reachable) error stop 'test_loose_piston: a chain that cannot be assembled'
    call chain%move_piston(motion)
    call move_centre(motion)

  contains

    real(dp) function u()
      call random%uniform(u)
    end function u
  end subroutine draw

  !> All accelerations, each divided by a typical value in the mechanism.
  pure function in_common_units(chain, a) result(values)
    type(chain_t), intent(in) :: chain
    type(accelerations_t), intent(in) :: a
    real(dp) :: values(9)
    values = [a%crank*chain%bodies%crank%length, a%rod*chain%bodies%rod%length, a%piston, a%pin(:, 1), a%pin(:, 2), a%offset, &
      0.05_dp*a%tilt]
  end function in_common_units

  !> The closed forms of a chain with clearance at the piston pin against the general equations of all bodies.
  subroutine both_ways_agree(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a, b
    real(dp) :: z(7), z_rate(7), moment, same, worst
    integer :: piece, i
    logical :: solvable
    call random%begin(31)
    do piece = 2, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        found = loads
        call chain%accelerate(motion, found, a, moment, solvable)
        call accelerate_assembled(chain%bodies, chain%drive, chain%is_loose, loads, motion, b, same)
        worst = max(worst, maxval(abs(in_common_units(chain, a) - in_common_units(chain, b))) &
          /maxval(abs(in_common_units(chain, b))))
        worst = max(worst, abs(moment - same)/(abs(same) + maxval(abs(loads%force))*chain%bodies%crank%length))
      end do
      call check%close_to(worst, 0.0_dp, 3e-12_dp, trim(pieces(piece))//': closed form and general equations')
    end do
  end subroutine both_ways_agree

  !> dE/dt along the motion is the power of the drive, of the gas, of the bore and of joints with clearance.
  subroutine energy_changes_by_the_power(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a
    real(dp) :: z(7), z_rate(7), moment, terms(8), worst, slope
    integer :: piece, i
    logical :: solvable
    call random%begin(32)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        found = loads
        call chain%accelerate(motion, found, a, moment, solvable)
        terms = [(moment - chain%drive%damping*motion%crank_speed)*motion%crank_speed, &
          -loads%axial_force*motion%tilting%com_velocity, loads%bore_force*z_rate(6) + loads%bore_moment*z_rate(7), &
          dot_product(loads%force(:, crank_pin), z_rate(2:3)), dot_product(loads%force(:, piston_pin), z_rate(4:5)), &
          loads%moment(crank_pin)*motion%crank_speed, (loads%moment(piston_pin) + bearing_moment(z(2:3), &
          loads%force(:, crank_pin), loads%moment(crank_pin)))*(-motion%rod_speed), &
          bearing_moment(z(4:5), loads%force(:, piston_pin), loads%moment(piston_pin))*z_rate(7)]
        slope = energy_slope(chain%bodies, z, z_rate, [a%crank, a%pin(:, 1), a%pin(:, 2), a%offset, a%tilt])
        worst = max(worst, abs(slope - sum(terms))/(maxval(abs(terms)) + chain%bodies%rod%mass &
          *maxval(abs(in_common_units(chain, a)))))
      end do
      call check%close_to(worst, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': energy balance of the equations of motion')
    end do
  end subroutine energy_changes_by_the_power

  !> Forces found from the motion of the rod alone agree with those that follow for the piston (Newton and Euler about its centre of
  !> mass) and from the joints' laws; the guide receives the reaction of the bore.
  subroutine newton_and_euler_hold(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(accelerations_t) :: a
    type(reactions_t) :: r
    real(dp) :: z(7), z_rate(7), moment, force, euler, com(2), worst(4), size_of
    integer :: piece, i
    logical :: solvable
    call random%begin(33)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        call chain%accelerate(motion, loads, a, moment, solvable)
        r = chain%reactions(motion, a, loads)
        size_of = maxval(abs([r%pin, r%crankpin])) + 1e4_dp
        worst(1) = max(worst(1), maxval(abs(r%pin + loads%force(:, piston_pin)))/size_of)
        if (chain%is_loose(crank_pin)) &
          worst(2) = max(worst(2), maxval(abs(r%crankpin + loads%force(:, crank_pin)))/size_of)
        worst(3) = max(worst(3), abs(r%guide + loads%bore_force)/size_of)
        com = chain%bodies%piston%com(1)*[cos(z(7)), sin(z(7))] + chain%bodies%piston%com(2)*[-sin(z(7)), cos(z(7))]
        force = r%pin(1)*com(2) - r%pin(2)*com(1)   ! moment of the force at -com
        euler = force + loads%bore_moment - (loads%moment(piston_pin) - (z(4)*r%pin(2) - z(5)*r%pin(1))) &
          - chain%bodies%piston%inertia*a%tilt
        worst(4) = max(worst(4), abs(euler)/(size_of*0.05_dp))
      end do
      call check%close_to(worst(1), 0.0_dp, 2e-11_dp, trim(pieces(piece))//': force at the piston pin')
      call check%close_to(worst(2), 0.0_dp, 2e-11_dp, trim(pieces(piece))//': force at the crank pin')
      call check%close_to(worst(3), 0.0_dp, 2e-11_dp, trim(pieces(piece))//': force on the guide')
      call check%close_to(worst(4), 0.0_dp, 2e-11_dp, trim(pieces(piece))//': balance of moments of the piston')
    end do
  end subroutine newton_and_euler_hold

  !> The response to a load is the change of the accelerations by it.
  subroutine loads_respond_linearly(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, more, added
    type(accelerations_t) :: a, b, difference
    real(dp) :: z(7), z_rate(7), moment, same, change, worst
    integer :: piece, i
    logical :: solvable
    call random%begin(34)
    do piece = 2, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        added = unloaded
        added%force(:, piston_pin) = [500.0_dp, -300.0_dp]
        added%moment(piston_pin) = 3
        more = loads
        more%force = loads%force + added%force
        more%moment = loads%moment + added%moment
        call chain%accelerate(motion, loads, a, moment, solvable)
        call chain%accelerate(motion, more, b, same, solvable)
        call chain%response(motion, added, difference, change)
        worst = max(worst, maxval(abs(in_common_units(chain, b) - in_common_units(chain, a) &
          - in_common_units(chain, difference)))/maxval(abs(in_common_units(chain, b))))
      end do
      call check%close_to(worst, 0.0_dp, 1e-11_dp, trim(pieces(piece))//': response to a load')
    end do
  end subroutine loads_respond_linearly
end module test_loose_piston
