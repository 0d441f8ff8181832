!> The chain: closed forms against the general assembly, and both against the energy of bodies whose velocities are computed from
!> their positions.
module test_chain
  use kinds, only: dp
  use constants, only: pi, degree
  use checks, only: checks_t
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, turn_crank, follow_rod, follow_piston
  use chain_bodies, only: bodies_t, crank_t, rod_t, piston_t, drive_t, new_bodies
  use chain_loads, only: loads_t, unloaded, bearing_moment
  use chain_reactions, only: reactions_t
  use mechanism_chain, only: chain_t
  use ideal_chain, only: ideal_motion
  use assembled_chain, only: accelerate_assembled
  use small_cholesky, only: factorise_cholesky, solve_cholesky
  use energy_of_bodies, only: energy_slope
  use random_numbers, only: random_numbers_t
  implicit none
  private
  public :: run_test_chain

  integer, parameter :: trials = 40
  character(len=28), parameter :: pieces(0:3) = [character(len=28) :: '{crank+rod+piston}', '{crank | rod+piston}', &
    '{crank+rod | piston}', '{crank | rod | piston}']

contains

  subroutine run_test_chain(check)
    class(checks_t), intent(inout) :: check
    call published_values(check)
    call pieces_equal_the_assembly(check)
    call energy_changes_by_the_power(check)
    call reactions_match_the_joints(check)
    call loads_respond_linearly(check)
    call ideal_is_the_centred_joint(check)
    call coordinates_agree(check)
    call joints_leave_angular_momentum(check)
    call cholesky_solves(check)
  end subroutine run_test_chain

  !> A chain of random dimensions at a random state under random loads. Piece 0 to 3 is the sum of 1 for clearance at the crank pin
  !> and 2 for clearance at the piston pin. Loads of ideal pins are 0.
  subroutine draw(random, piece, chain, motion, loads, z, z_rate)
    type(random_numbers_t), intent(inout) :: random
    integer, intent(in) :: piece
    type(chain_t), intent(out) :: chain
    type(motion_t), intent(out) :: motion
    type(loads_t), intent(out) :: loads
    real(dp), intent(out) :: z(5), z_rate(5)   !! (q, c, e)
    real(dp) :: r, l, tilt
    logical :: reachable
    integer :: pin

    r = between(random, 0.03_dp, 0.08_dp)
    l = r*between(random, 1.5_dp, 5.0_dp)
    tilt = between(random, -pi, pi)
    chain%bodies = new_bodies(crank_t(r, between(random, 0.3_dp, 2.0_dp), between(random, 1e-4_dp, 1e-2_dp), &
      [between(random, -0.5_dp, 1.0_dp), between(random, -0.5_dp, 0.5_dp)]*r), &
      rod_t(l, between(random, 0.2_dp, 2.0_dp), between(random, 1e-4_dp, 1e-2_dp), &
      [between(random, 0.2_dp, 0.7_dp), between(random, -0.2_dp, 0.2_dp)]*l), &
      piston_t(between(random, 0.1_dp, 1.0_dp), axis_offset=merge(-0.2_dp*r, 0.0_dp, tilt > 0)), &
      9.80665_dp*[-cos(tilt), -sin(tilt)])
    chain%drive = drive_t(between(random, 0.0_dp, 1.0_dp) < 0.5_dp, between(random, -20.0_dp, 20.0_dp), &
      between(random, 0.0_dp, 0.1_dp), 0.0_dp, 0.0_dp)
    chain%is_loose = [modulo(piece, 2) == 1, piece > 1]
    z(1) = between(random, -10.0_dp, 10.0_dp)
    z_rate(1) = between(random, -300.0_dp, 300.0_dp)
    loads%axial_force = between(random, -1e3_dp, 1e4_dp)
    loads = unloaded
    do pin = 1, 2
      z(2*pin:2*pin + 1) = merge(1, 0, chain%is_loose(pin))*1e-3_dp*[between(random, -1.0_dp, 1.0_dp), &
        between(random, -1.0_dp, 1.0_dp)]
      z_rate(2*pin:2*pin + 1) = merge(1, 0, chain%is_loose(pin))*[between(random, -2.0_dp, 2.0_dp), &
        between(random, -2.0_dp, 2.0_dp)]
      loads%force(:, pin) = merge(1, 0, chain%is_loose(pin))*[between(random, -1e4_dp, 1e4_dp), between(random, -1e4_dp, 1e4_dp)]
      loads%moment(pin) = merge(1, 0, chain%is_loose(pin))*between(random, -5.0_dp, 5.0_dp)
    end do
    call move(chain, z, z_rate, motion, reachable)
    if (.not. reachable) error stop 'test_chain: a chain that cannot be assembled'
  end subroutine draw

  real(dp) function between(random, low, high)
    type(random_numbers_t), intent(inout) :: random
    real(dp), intent(in) :: low, high
    real(dp) :: u
    call random%uniform(u)
    between = low + (high - low)*u
  end function between

  subroutine move(chain, z, z_rate, motion, reachable)
    type(chain_t), intent(in) :: chain
    real(dp), intent(in) :: z(5), z_rate(5)
    type(motion_t), intent(out) :: motion
    logical, intent(out) :: reachable
    associate (r => chain%bodies%crank%length, l => chain%bodies%rod%length)
      call turn_crank(motion, z(1), z_rate(1))
      motion%crank_pin = z(2:3)
      motion%crank_pin_rate = z_rate(2:3)
      motion%offset = z(2:3) + z(4:5)
      motion%offset_rate = z_rate(2:3) + z_rate(4:5)
      call follow_rod(r, 1/l, chain%bodies%piston%axis_offset, motion, reachable)
      if (reachable) call follow_piston(r, l, motion)
    end associate
  end subroutine move

  !> All accelerations, each divided by a typical value in the mechanism.
  pure function in_common_units(chain, a) result(values)
    type(chain_t), intent(in) :: chain
    type(accelerations_t), intent(in) :: a
    real(dp) :: values(7)
    values = [a%crank*chain%bodies%crank%length, a%rod*chain%bodies%rod%length, a%piston, a%pin(:, 1), a%pin(:, 2)]
  end function in_common_units

  !> Each closed form against the general equations from the velocity maps of the bodies.
  subroutine pieces_equal_the_assembly(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a, b
    real(dp) :: z(5), z_rate(5), moment, same, worst, worst_moment, largest(7)
    integer :: piece, i
    logical :: solvable

    call random%begin(16)
    do piece = 0, 3
      worst = 0
      worst_moment = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        found = loads
        call chain%accelerate(motion, found, a, moment, solvable)
        call accelerate_assembled(chain%bodies, chain%drive, chain%is_loose, loads, motion, b, same)
        largest = in_common_units(chain, b)
        worst = max(worst, maxval(abs(in_common_units(chain, a) - largest))/maxval(abs(largest)))
        worst_moment = max(worst_moment, abs(moment - same)/(abs(same) + maxval(abs(largest))*chain%bodies%rod_term &
          /chain%bodies%rod%length))
      end do
      call check%close_to(worst, 0.0_dp, 2e-12_dp, trim(pieces(piece))//' and the assembly: accelerations')
      call check%close_to(worst_moment, 0.0_dp, 2e-12_dp, trim(pieces(piece))//' and the assembly: moment on the crank')
    end do
  end subroutine pieces_equal_the_assembly

  !> dE/dt along the motion is the power of the drive, the gas and the joints with clearance.
  subroutine energy_changes_by_the_power(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a
    real(dp) :: z(5), z_rate(5), moment, power, terms(6), worst
    integer :: piece, i
    logical :: solvable

    call random%begin(17)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        found = loads
        call chain%accelerate(motion, found, a, moment, solvable)
        associate (q_rate => motion%crank_speed, rod_spin => -motion%rod_speed)
          terms = [(moment - chain%drive%damping*q_rate)*q_rate, -loads%axial_force*motion%piston_velocity, &
            dot_product(loads%force(:, crank_pin), z_rate(2:3)), dot_product(loads%force(:, piston_pin), z_rate(4:5)), &
            loads%moment(crank_pin)*q_rate, &
            (loads%moment(piston_pin) + bearing_moment(z(2:3), loads%force(:, crank_pin), loads%moment(crank_pin)))*rod_spin]
        end associate
        power = sum(terms)
        worst = max(worst, abs(energy_slope(chain%bodies, z, z_rate, [a%crank, a%pin(:, 1), a%pin(:, 2)]) - power) &
          /(maxval(abs(terms)) + chain%bodies%rod%mass*maxval(abs(in_common_units(chain, a)))))
      end do
      call check%close_to(worst, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': energy balance of the equations of motion')
    end do
  end subroutine energy_changes_by_the_power

  !> F5 = -F_x, F6 = -F_y, and with clearance at the crank pin F3 = -J_x, F4 = -J_y; the balance of moments of the crank with F3 and
  !> F4; the guide carries the piston's weight across the cylinder.
  subroutine reactions_match_the_joints(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(accelerations_t) :: a
    type(reactions_t) :: r
    real(dp) :: z(5), z_rate(5), moment, balance, size_of, worst(4)
    integer :: piece, i
    logical :: solvable

    call random%begin(18)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        call chain%accelerate(motion, loads, a, moment, solvable)
        r = chain%reactions(motion, a, loads)
        size_of = maxval(abs([r%pin, r%crankpin]))
        worst(1) = max(worst(1), maxval(abs(r%pin + loads%force(:, piston_pin)))/size_of)
        if (chain%is_loose(crank_pin)) worst(2) = max(worst(2), maxval(abs(r%crankpin + loads%force(:, crank_pin)))/size_of)
        associate (b => chain%bodies)
          balance = b%crank%length*(-r%crankpin(2)*motion%cos_crank + r%crankpin(1)*motion%sin_crank) + moment &
            - chain%drive%damping*motion%crank_speed + loads%moment(crank_pin) &
            + b%crank%mass*dot_product(b%gravity, [-b%crank%com(1)*motion%sin_crank - b%crank%com(2)*motion%cos_crank, &
            b%crank%com(1)*motion%cos_crank - b%crank%com(2)*motion%sin_crank]) &
            - (b%crank%inertia + b%crank%mass*sum(b%crank%com**2))*a%crank
          worst(3) = max(worst(3), abs(balance)/(size_of*b%crank%length))
          worst(4) = max(worst(4), abs(r%guide - r%pin(2) - b%piston%mass*b%gravity(2))/size_of)
        end associate
      end do
      call check%close_to(worst(1), 0.0_dp, 1e-11_dp, trim(pieces(piece))//': F5 = -F_x and F6 = -F_y')
      if (modulo(piece, 2) == 1) call check%close_to(worst(2), 0.0_dp, 1e-11_dp, trim(pieces(piece))//': F3 = -J_x and F4 = -J_y')
      call check%close_to(worst(3), 0.0_dp, 1e-11_dp, trim(pieces(piece))//': balance of moments of the crank with F3 and F4')
      call check%close_to(worst(4), 0.0_dp, 1e-14_dp, trim(pieces(piece))//': the guide carries the weight across the cylinder')
    end do
  end subroutine reactions_match_the_joints

  !> Accelerations with an additional load are those without it plus the response to the load; the loads of ideal pins agree with
  !> the accelerations.
  subroutine loads_respond_linearly(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, more, added, completed
    type(accelerations_t) :: a, b, difference
    real(dp) :: z(5), z_rate(5), moment, same, change, worst, worst_load, worst_moment
    integer :: piece, i
    logical :: solvable

    call random%begin(19)
    do piece = 0, 3
      worst = 0
      worst_load = 0
      worst_moment = 0
      do i = 1, trials
        call draw(random, piece, chain, motion, loads, z, z_rate)
        added = unloaded
        added%axial_force = 700
        added%force(:, :2) = merge(1, 0, spread(chain%is_loose, 1, 2))*reshape([500.0_dp, -300.0_dp, 200.0_dp, 900.0_dp], [2, 2])
        added%moment(:2) = merge(1, 0, chain%is_loose)*[3.0_dp, -2.0_dp]
        more = loads
        more%force = loads%force + added%force
        more%moment = loads%moment + added%moment
        more%axial_force = loads%axial_force + added%axial_force
        call chain%accelerate(motion, loads, a, moment, solvable)
        call chain%accelerate(motion, more, b, same, solvable)
        call chain%response(motion, added, difference, change)
        worst = max(worst, maxval(abs(in_common_units(chain, b) - in_common_units(chain, a) &
          - in_common_units(chain, difference))) &
          /maxval(abs(in_common_units(chain, b))))
        worst_moment = max(worst_moment, abs(same - moment - change)/(abs(moment) + abs(same) + 1))
        completed = more
        call chain%complete_loads(motion, b, completed)
        worst_load = max(worst_load, maxval(abs(completed%force(:, piston_pin) - more%force(:, piston_pin))) &
          /maxval(abs(completed%force)))
      end do
      call check%close_to(worst, 0.0_dp, 1e-11_dp, trim(pieces(piece))//': response to a load')
      call check%close_to(worst_moment, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': response of the moment on the crank')
      call check%close_to(worst_load, 0.0_dp, 1e-11_dp, trim(pieces(piece))//': load of the piston pin')
    end do
  end subroutine loads_respond_linearly

  !> The mechanism of appendix B (Flores) with constant crank speed.
  pure function flores() result(chain)
    type(chain_t) :: chain
    chain%bodies = new_bodies(crank_t(0.05_dp, 0.30_dp, 1e-5_dp, [0.025_dp, 0.0_dp]), &
      rod_t(0.12_dp, 0.21_dp, 2.5e-4_dp, [0.06_dp, 0.0_dp]), piston_t(0.14_dp), [0.0_dp, 0.0_dp])
    chain%drive%free_crank = .false.
  end function flores

  !> Slider acceleration at the dead centres and the largest crank moment of the ideal Flores mechanism at 5000 rpm; and a free
  !> crank under the moment that holds the speed does not accelerate.
  subroutine published_values(check)
    class(checks_t), intent(inout) :: check
    type(chain_t) :: chain
    type(accelerations_t) :: a
    type(loads_t) :: loads
    real(dp) :: moment, same
    logical :: solvable
    call accelerate_at(0.0_dp)
    call check%close_to(a%piston, -19419.360511_dp, 1e-6_dp, 'slider acceleration at the top')
    call accelerate_at(180.0_dp)
    call check%close_to(a%piston, 7996.207269_dp, 1e-6_dp, 'slider acceleration at the bottom')
    call accelerate_at(-34.974_dp)
    call check%close_to(abs(moment), 138.521666_dp, 1e-6_dp, 'crank moment at -34.974 deg')
    same = moment
    call accelerate_at(34.974_dp)
    call check%close_to(abs(moment), 138.521666_dp, 1e-6_dp, 'crank moment at 34.974 deg')
    call check%close_to(moment + same, 0.0_dp, 1e-9_dp, 'crank moment is odd')
    chain%drive = drive_t(.true., moment, 0.0_dp, 0.0_dp, 0.0_dp)
    call chain%accelerate(ideal_motion(chain%bodies, 34.974_dp*degree, 5000*pi/30), loads, a, same, solvable)
    call check%close_to(a%crank, 0.0_dp, 1e-8_dp, 'the crank does not accelerate under the moment for constant speed')

  contains

    subroutine accelerate_at(angle)
      real(dp), intent(in) :: angle
    logical :: solvable
      chain = flores()
      loads = unloaded
      call chain%accelerate(ideal_motion(chain%bodies, angle*degree, 5000*pi/30), loads, a, moment, solvable)
    end subroutine accelerate_at
  end subroutine published_values

  !> The force of the ideal piston pin, applied as a load to a pin with clearance, gives the same accelerations; so does that of the
  !> crank pin.
  subroutine ideal_is_the_centred_joint(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(accelerations_t) :: a, b
    real(dp) :: z(5), z_rate(5), moment, worst
    integer :: piece, i
    logical :: solvable

    call random%begin(20)
    do piece = 1, 3
      worst = 0
      do i = 1, trials
        call draw(random, 0, chain, motion, loads, z, z_rate)
        chain%drive%free_crank = .true.
        call chain%accelerate(motion, loads, a, moment, solvable)
        call chain%complete_loads(motion, a, loads)
        chain%is_loose = [modulo(piece, 2) == 1, piece > 1]
        call chain%accelerate(motion, loads, b, moment, solvable)
        worst = max(worst, maxval(abs(in_common_units(chain, a) - in_common_units(chain, b))) &
          /maxval(abs(in_common_units(chain, a))))
      end do
      call check%close_to(worst, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': accelerations under the forces of ideal pins')
    end do
  end subroutine ideal_is_the_centred_joint

  !> The eccentricities of the pins from the positions of the bodies.
  subroutine coordinates_agree(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads
    real(dp) :: z(5), z_rate(5), big_end(2), rate(2), rod, worst(2)
    logical :: reachable
    integer :: i

    call random%begin(21)
    worst = 0
    do i = 1, trials
      call draw(random, 3, chain, motion, loads, z, z_rate)
      rod = asin(motion%sin_rod)
      associate (r => chain%bodies%crank%length, l => chain%bodies%rod%length, x => motion%piston_position)
        big_end = [x + z(4) - l*cos(rod), chain%bodies%piston%axis_offset + z(5) + l*sin(rod)]
        worst(1) = max(worst(1), maxval(abs(r*[cos(z(1)), sin(z(1))] - big_end - z(2:3))))
        rate = [motion%piston_velocity + z_rate(4) + l*sin(rod)*motion%rod_speed, z_rate(5) + l*cos(rod)*motion%rod_speed]
        worst(2) = max(worst(2), maxval(abs(r*z_rate(1)*[-sin(z(1)), cos(z(1))] - rate - z_rate(2:3))))
      end associate
    end do
    call check%close_to(worst(1), 0.0_dp, 1e-15_dp, 'eccentricity of the crank pin [m]')
    call check%close_to(worst(2), 0.0_dp, 1e-13_dp, 'eccentricity rate of the crank pin [m/s]')
    call move(chain, [0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.5_dp], z_rate, motion, reachable)
    call check%that(.not. reachable, 'a pin farther away than the rod is long is refused')
  end subroutine coordinates_agree

  !> If pin and bearing rotate as one body, the force and moments of a joint do no work.
  subroutine joints_leave_angular_momentum(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: e(2) = [3e-5_dp, -4e-5_dp], force(2) = [700.0_dp, 300.0_dp], moment = 0.4_dp, spin = 90
    call check%close_to(dot_product(force, spin*[-e(2), e(1)]) + spin*(moment + bearing_moment(e, force, moment)), 0.0_dp, &
      1e-13_dp, 'a joint does no work on bodies that rotate as one [W]')
    ! friction F_T at the contact point, |e| + R_pin from the bearing's centre
    call check%close_to(bearing_moment([2e-4_dp, 0.0_dp], [-800.0_dp, 50.0_dp], 50*0.01_dp), -50*(2e-4_dp + 0.01_dp), 1e-15_dp, &
      'moment of friction on the bearing')
  end subroutine joints_leave_angular_momentum

  subroutine cholesky_solves(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n = 10
    type(random_numbers_t) :: random
    real(dp) :: root(n, n), matrix(n, n), factor(n, n), x(n), b(n)
    logical :: definite
    integer :: i, j

    call random%begin(22)
    do j = 1, n
      do i = 1, n
        root(i, j) = between(random, -1.0_dp, 1.0_dp)
      end do
      x(j) = between(random, -1.0_dp, 1.0_dp)
    end do
    matrix = matmul(root, transpose(root))
    do i = 1, n
      matrix(i, i) = matrix(i, i) + 0.1_dp
    end do
    b = matmul(matrix, x)
    factor = matrix
    call factorise_cholesky(n, factor, definite)
    call check%that(definite, 'A A^T + 0.1 is positive definite')
    call solve_cholesky(n, factor, b)
    call check%close_to(maxval(abs(b - x)), 0.0_dp, 1e-12_dp, 'solution of the equations with A A^T + 0.1')
    matrix(n, n) = -1
    call factorise_cholesky(n, matrix, definite)
    call check%that(.not. definite, 'a matrix with a negative diagonal is not positive definite')
  end subroutine cholesky_solves
end module test_chain
