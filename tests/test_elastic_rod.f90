!> The elastic rod alone and in the chain: its equations against sums over its points, closed forms against the general assembly,
!> reactions, natural frequencies and buckling.
module test_elastic_rod
  use kinds, only: dp
  use constants, only: pi
  use checks, only: checks_t
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, turn_crank
  use chain_bodies, only: crank_t, rod_t, piston_t, drive_t, new_bodies
  use chain_loads, only: loads_t, unloaded, bearing_moment
  use chain_reactions, only: reactions_t
  use mechanism_chain, only: chain_t
  use body_assembly, only: body_t
  use assembled_chain, only: accelerate_assembled
  use elastic_rod, only: elastic_rod_t, largest_shank
  use elastic_rod_body, only: set_own_equations, elastic_rod_energy
  use elastic_rod_field, only: field_t, new_field, lagrange_residual, energy_slope_of_field
  use random_numbers, only: random_numbers_t
  implicit none
  private
  public :: run_test_elastic_rod

  integer, parameter :: trials = 12
  character(len=28), parameter :: pieces(0:3) = [character(len=28) :: '{crank+rod+piston}', '{crank | rod+piston}', &
    '{crank+rod | piston}', '{crank | rod | piston}']

contains

  subroutine run_test_elastic_rod(check)
    class(checks_t), intent(inout) :: check
    call equations_are_those_of_its_points(check)
    call energy_changes_by_the_power(check)
    call closed_form_equals_the_assembly(check)
    call reactions_match_the_joints(check)
    call loads_respond_linearly(check)
    call without_shapes_it_is_rigid(check)
    call it_swings_at_its_frequencies(check)
    call it_buckles_at_eulers_load(check)
    call its_middle_is_where_the_sines_put_it(check)
  end subroutine run_test_elastic_rod

  !> A random chain with an elastic rod of n bending and na axial shapes, with clearance at the pins given by `piece`, in a random
  !> state under random loads. The coordinates are (q, c, e, eta, a).
  subroutine draw(random, piece, n, na, chain, motion, loads, z, z_rate)
    type(random_numbers_t), intent(inout) :: random
    integer, intent(in) :: piece, n, na
    type(chain_t), intent(out) :: chain
    type(motion_t), intent(out) :: motion
    type(loads_t), intent(out) :: loads
    real(dp), intent(out) :: z(:), z_rate(:)
    type(rod_t) :: rod
    real(dp) :: r, tilt, shank
    logical :: reachable
    integer :: i, pin

    r = between(random, 0.03_dp, 0.08_dp)
    rod%length = r*between(random, 2.0_dp, 5.0_dp)
    rod%mass = between(random, 0.2_dp, 2.0_dp)
    rod%com = [between(random, 0.3_dp, 0.7_dp), between(random, -0.02_dp, 0.02_dp)]*rod%length
    shank = between(random, 0.5_dp, 0.9_dp)*largest_shank(rod)
    ! inertia of shank and point masses about the centre of mass, and more
    rod%inertia = (rod%length**2*(rod%mass*rod%com(1)/rod%length - shank/6) - rod%mass*rod%com(1)**2) &
      *between(random, 1.0_dp, 1.3_dp)
    tilt = between(random, -pi, pi)
    chain%bodies = new_bodies(crank_t(r, between(random, 0.3_dp, 2.0_dp), between(random, 1e-4_dp, 1e-2_dp), &
      [between(random, -0.5_dp, 1.0_dp), between(random, -0.5_dp, 0.5_dp)]*r), rod, &
      piston_t(between(random, 0.1_dp, 1.0_dp), axis_offset=merge(-0.2_dp*r, 0.0_dp, tilt > 0)), &
      9.80665_dp*[-cos(tilt), -sin(tilt)])
    chain%drive = drive_t(between(random, 0.0_dp, 1.0_dp) < 0.5_dp, between(random, -20.0_dp, 20.0_dp), &
      between(random, 0.0_dp, 0.1_dp), 0.0_dp, 0.0_dp)
    chain%is_loose = [modulo(piece, 2) == 1, piece > 1]
    allocate (chain%elastic)
    allocate (chain%elastic%rod)
    chain%elastic%rod%youngs_modulus = between(random, 1e9_dp, 2e11_dp)
    chain%elastic%rod%section_area = between(random, 1e-4_dp, 1e-3_dp)
    chain%elastic%rod%section_inertia = between(random, 1e-10_dp, 1e-8_dp)
    chain%elastic%rod%n_bending = n
    chain%elastic%rod%n_axial = na
    chain%elastic%rod%damping_ratio = between(random, 0.0_dp, 0.1_dp)
    chain%elastic%rod%axial_damping_ratio = between(random, 0.0_dp, 0.1_dp)
    chain%elastic%rod%shank_mass = shank
    call chain%elastic%rod%prepare(rod)
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
    do i = 1, n + na
      z(5 + i) = 2e-3_dp*rod%length*between(random, -1.0_dp, 1.0_dp)/merge(i, i - n, i <= n)**2
      z_rate(5 + i) = between(random, -2.0_dp, 2.0_dp)
    end do
    call turn_crank(motion, z(1), z_rate(1))
    motion%crank_pin = z(2:3)
    motion%crank_pin_rate = z_rate(2:3)
    motion%offset = z(2:3) + z(4:5)
    motion%offset_rate = z_rate(2:3) + z_rate(4:5)
    motion%shape(:n + na) = z(6:5 + n + na)
    motion%shape_rate(:n + na) = z_rate(6:5 + n + na)
    call chain%move_rod(motion, reachable)
    if (.not. reachable) error stop 'test_elastic_rod: a chain that cannot be assembled'
    call chain%move_piston(motion)
  end subroutine draw

  real(dp) function between(random, low, high)
    type(random_numbers_t), intent(inout) :: random
    real(dp), intent(in) :: low, high
    real(dp) :: u
    call random%uniform(u)
    between = low + (high - low)*u
  end function between

  !> Mass matrix and loads of the rod alone against Lagrange's equations of its points, for any acceleration of any coordinate.
  subroutine equations_are_those_of_its_points(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, nothing
    type(field_t) :: field
    type(body_t) :: body
    integer, parameter :: n = 3, na = 4
    real(dp) :: z(5 + n + na), z_rate(5 + n + na), x(3 + n + na), v(3 + n + na), a(3 + n + na), want(3 + n + na), terms(3 + n + na)
    real(dp) :: worst
    integer :: i, k

    call random%begin(31)
    nothing%force = 0
    nothing%moment = 0
    nothing%axial_force = 0
    worst = 0
    do i = 1, trials
      call draw(random, 3, n, na, chain, motion, loads, z, z_rate)
      associate (rod => chain%elastic%rod)
        rod%damping = 0
        field = new_field(rod, chain%bodies)
        x = [chain%bodies%crank%length*[motion%cos_crank, motion%sin_crank] - motion%crank_pin, &
             atan2(motion%sin_rod, motion%cos_rod), z(6:)]
        v = [chain%bodies%crank%length*motion%crank_speed*[-motion%sin_crank, motion%cos_crank] - motion%crank_pin_rate, &
             motion%rod_speed, z_rate(6:)]
        do k = 1, size(a)
          a(k) = between(random, -1e4_dp, 1e4_dp)
        end do
        call body%begin(3 + n + na, 1)
        call set_own_equations(rod, chain%bodies, nothing, motion, body)
        want = lagrange_residual(field, chain%bodies%gravity, x, v, a)
        terms = matmul(abs(body%mass(:3 + n + na, :3 + n + na)), abs(a)) + abs(body%load(:3 + n + na))
        worst = max(worst, maxval(abs(matmul(body%mass(:3 + n + na, :3 + n + na), a) - body%load(:3 + n + na) - want)/terms))
      end associate
    end do
    call check%close_to(worst, 0.0_dp, 1e-13_dp, 'Lagrange''s equations of the rod''s points')
  end subroutine equations_are_those_of_its_points

  !> dE/dt along the motion, with E from the rod's points, is the power of drive, gas, joints with clearance and damping.
  subroutine energy_changes_by_the_power(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a
    integer, parameter :: n = 2, na = 3
    real(dp) :: z(5 + n + na), z_rate(5 + n + na), moment, terms(8), slope, worst
    logical :: solvable
    integer :: piece, i

    call random%begin(32)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, n, na, chain, motion, loads, z, z_rate)
        found = loads
        call chain%accelerate(motion, found, a, moment, solvable)
        call check%that(solvable, 'the equations can be solved')
        associate (q_rate => motion%crank_speed, rod => chain%elastic%rod)
          terms = [(moment - chain%drive%damping*q_rate)*q_rate, -loads%axial_force*motion%piston_velocity, &
            dot_product(loads%force(:, crank_pin), z_rate(2:3)), dot_product(loads%force(:, piston_pin), z_rate(4:5)), &
            loads%moment(crank_pin)*q_rate, &
            loads%moment(piston_pin)*(-motion%rod_speed + pi/rod%length*(-z_rate(6) + 2*z_rate(7))), &
            bearing_moment(z(2:3), loads%force(:, crank_pin), loads%moment(crank_pin))* &
            (-motion%rod_speed + pi/rod%length*(z_rate(6) + 2*z_rate(7))), chain%elastic%damping_power(motion)]
        end associate
        slope = energy_slope_of_field(new_field(chain%elastic%rod, chain%bodies), chain%bodies, z, z_rate, &
          [a%crank, a%pin(:, 1), a%pin(:, 2), a%shape(:n + na)])
        worst = max(worst, abs(slope - sum(terms))/(maxval(abs(terms)) &
          + maxval(abs(chain%elastic%rod%stiffness(:n + na)*z(6:)*z_rate(6:)))))
      end do
      call check%close_to(worst, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': energy balance of the equations of motion')
    end do
  end subroutine energy_changes_by_the_power

  !> With clearance at the piston pin: the shapes eliminated first, and all coordinates at once.
  subroutine closed_form_equals_the_assembly(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a, b
    integer, parameter :: shapes(2, 4) = reshape([2, 4, 8, 8, 3, 0, 0, 2], [2, 4])
    real(dp) :: z(21), z_rate(21), moment, same, worst, worst_moment, worst_end, one(7), other(7)
    logical :: solvable
    integer :: piece, i, k

    call random%begin(33)
    do piece = 2, 3
      do k = 1, size(shapes, 2)
        worst = 0
        worst_moment = 0
        worst_end = 0
        do i = 1, trials
          call draw(random, piece, shapes(1, k), shapes(2, k), chain, motion, loads, z, z_rate)
          found = loads
          call chain%accelerate(motion, found, a, moment, solvable)
          call check%that(solvable, 'the equations of many shapes can be solved')
          call accelerate_assembled(chain%bodies, chain%drive, chain%is_loose, loads, motion, b, same, chain%elastic%rod)
          associate (ns => sum(shapes(:, k)), l => chain%bodies%rod%length)
            one = [a%crank*l, a%rod*l, a%piston, a%pin(:, 1), a%pin(:, 2)]
            other = [b%crank*l, b%rod*l, b%piston, b%pin(:, 1), b%pin(:, 2)]
            worst = max(worst, maxval(abs(one - other))/maxval(abs(other)), &
              maxval(abs(a%shape(:ns) - b%shape(:ns)))/maxval(abs(b%shape(:ns))))
            worst_moment = max(worst_moment, abs(moment - same)/(abs(same) + maxval(abs(other))*chain%bodies%rod_term/l))
          end associate
        end do
        call check%close_to(worst, 0.0_dp, 2e-11_dp, trim(pieces(piece))//' and the assembly: accelerations')
        call check%close_to(worst_moment, 0.0_dp, 1e-11_dp, trim(pieces(piece))//' and the assembly: moment on the crank')
      end do
    end do
  end subroutine closed_form_equals_the_assembly

  !> F5 = -F_x, F6 = -F_y, with clearance at the crank pin F3 = -J_x and F4 = -J_y; and the balance of moments of the crank.
  subroutine reactions_match_the_joints(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(accelerations_t) :: a
    type(reactions_t) :: r
    real(dp) :: z(11), z_rate(11), moment, balance, size_of, worst(3)
    logical :: solvable
    integer :: piece, i

    call random%begin(34)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, 2, 4, chain, motion, loads, z, z_rate)
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
        end associate
      end do
      call check%close_to(worst(1), 0.0_dp, 1e-10_dp, trim(pieces(piece))//': F5 = -F_x and F6 = -F_y')
      if (modulo(piece, 2) == 1) call check%close_to(worst(2), 0.0_dp, 1e-10_dp, trim(pieces(piece))//': F3 = -J_x and F4 = -J_y')
      call check%close_to(worst(3), 0.0_dp, 1e-10_dp, trim(pieces(piece))//': balance of moments of the crank with F3 and F4')
    end do
  end subroutine reactions_match_the_joints

  !> The change of the accelerations by an additional load, including those of shapes and rod ends.
  subroutine loads_respond_linearly(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, more, added
    type(accelerations_t) :: a, b, c
    real(dp) :: z(11), z_rate(11), moment, same, change, worst
    logical :: solvable
    integer :: piece, i

    call random%begin(35)
    do piece = 1, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, 2, 4, chain, motion, loads, z, z_rate)
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
        call chain%response(motion, added, c, change)
        worst = max(worst, maxval(abs(b%pin(:, :2) - a%pin(:, :2) - c%pin(:, :2)))/maxval(abs(b%pin(:, :2))), &
          maxval(abs(b%shape(:6) - a%shape(:6) - c%shape(:6)))/maxval(abs(b%shape(:6))), &
          maxval(abs(b%rod_end - a%rod_end - c%rod_end))/maxval(abs(b%rod_end)), abs(same - moment - change)/(abs(same) + 10))
      end do
      call check%close_to(worst, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': response to a load')
    end do
  end subroutine loads_respond_linearly

  !> Without shapes the accelerations are those of the rigid rod.
  subroutine without_shapes_it_is_rigid(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads, found
    type(accelerations_t) :: a, b
    type(reactions_t) :: one, other
    real(dp) :: z(5), z_rate(5), moment, same, worst
    logical :: solvable
    integer :: piece, i

    call random%begin(36)
    do piece = 0, 3
      worst = 0
      do i = 1, trials
        call draw(random, piece, 0, 0, chain, motion, loads, z, z_rate)
        found = loads
        call chain%accelerate(motion, found, a, moment, solvable)
        one = chain%reactions(motion, a, found)
        worst = max(worst, abs(chain%elastic%rod%strain_energy(motion)))
        same = chain%energy(motion)
        deallocate (chain%elastic)
        call check%relative(same, chain%energy(motion), 1e-12_dp, 'energy of a rod without shapes')
        found = loads
        call chain%accelerate(motion, found, b, same, solvable)
        other = chain%reactions(motion, b, found)
        worst = max(worst, maxval(abs(a%pin(:, :2) - b%pin(:, :2))/(1 + maxval(abs(b%pin(:, :2))))), &
          abs(a%rod - b%rod)/abs(b%rod), &
          abs(a%piston - b%piston)/abs(b%piston), abs(moment - same)/(abs(same) + 100), &
          maxval(abs(one%frame - other%frame))/maxval(abs(other%crankpin)))
      end do
      call check%close_to(worst, 0.0_dp, 1e-10_dp, trim(pieces(piece))//': a rod without shapes is rigid')
    end do
  end subroutine without_shapes_it_is_rigid

  !> Bending on two pins: (k pi/L)^2 sqrt(E I L/m_b). Stretching with a mass m_p at the end: beta tan beta = m_b/m_p, with the
  !> frequency beta sqrt(E A/(m_b L)), to which the shapes converge from above.
  subroutine it_swings_at_its_frequencies(check)
    class(checks_t), intent(inout) :: check
    type(elastic_rod_t) :: rod
    real(dp), parameter :: m = 0.21_dp, l = 0.12_dp, e = 207e9_dp, area = 9.6e-5_dp, i_s = 5.12e-10_dp, piston = 0.14_dp
    real(dp), parameter :: excess(4) = [1.2e-2_dp, 8e-4_dp, 2e-4_dp, 7e-5_dp]
    real(dp) :: beta, exact
    integer :: k
    beta = 1
    do k = 1, 50
      beta = beta - (beta*tan(beta) - m/piston)/(tan(beta) + beta/cos(beta)**2)
    end do
    exact = beta*sqrt(e*area/(m*l))
    do k = 1, 4
      rod = elastic_rod_t(youngs_modulus=e, section_area=area, section_inertia=i_s, n_bending=k, n_axial=k)
      call rod%prepare(rod_t(l, m, 2.5e-4_dp, [0.06_dp, 0.0_dp]))
      call check%relative(rod%shank_mass, m, 1e-15_dp, 'the largest shank of a rod with its centre of mass half way')
      call check%relative(rod%natural_frequency(k), (k*pi/l)**2*sqrt(e*i_s*l/m), 1e-14_dp, 'frequency of bending on two pins')
      call check%that(rod%axial_frequency(piston) > exact, 'frequency of the shapes is above that of the rod')
      call check%close_to(rod%axial_frequency(piston)/exact - 1, excess(k), 0.15_dp*excess(k), &
        'frequency of stretching with a piston')
    end do
    rod = elastic_rod_t(youngs_modulus=e, section_area=area, section_inertia=i_s, n_bending=2, n_axial=2)
    call rod%prepare(rod_t(0.2032_dp, 1.36_dp, 0.01_dp, [0.0508_dp, 0.0_dp]))
    call check%relative(rod%shank_mass, 0.68_dp, 1e-14_dp, 'the largest shank of the dissertation''s rod')
    call check%relative(rod%end_mass + 1e-3_dp, 1e-3_dp, 1e-12_dp, 'no mass is left at the piston pin of the dissertation''s rod')
  end subroutine it_swings_at_its_frequencies

  !> Deflection half way between the pins: the sum of the sines there.
  subroutine its_middle_is_where_the_sines_put_it(check)
    class(checks_t), intent(inout) :: check
    type(elastic_rod_t) :: rod
    type(motion_t) :: motion
    real(dp), parameter :: amplitude(6) = [1e-4_dp, 3e-5_dp, 2e-5_dp, -4e-5_dp, 7e-6_dp, 5e-6_dp]
    integer :: k
    rod = elastic_rod_t(youngs_modulus=207e9_dp, section_area=9.6e-5_dp, section_inertia=5.12e-10_dp, n_bending=6, n_axial=1)
    call rod%prepare(rod_t(0.12_dp, 0.21_dp, 2.5e-4_dp, [0.06_dp, 0.0_dp]))
    motion%shape = 0
    motion%shape(:6) = amplitude
    call check%close_to(rod%mid_deflection(motion%shape), sum(amplitude*[(sin(0.5_dp*k*pi), k=1, 6)]), 1e-18_dp, &
      'deflection of the rod''s middle [m]')
  end subroutine its_middle_is_where_the_sines_put_it

  !> Under Euler's load along the chord no force acts against the first sine mode.
  subroutine it_buckles_at_eulers_load(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random
    type(chain_t) :: chain
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(body_t) :: body
    real(dp) :: z(8), z_rate(8), euler, load(2)
    logical :: reachable
    integer :: i
    call random%begin(37)
    call draw(random, 2, 2, 1, chain, motion, loads, z, z_rate)
    chain%bodies%gravity = 0
    call turn_crank(motion, 0.0_dp, 0.0_dp)
    motion%offset = 0
    motion%offset_rate = 0
    motion%crank_pin = 0
    motion%shape_rate = 0
    associate (rod => chain%elastic%rod)
      euler = pi**2*rod%youngs_modulus*rod%section_inertia/rod%length**2
      motion%shape(:3) = [1e-3_dp*rod%length, 0.0_dp, 0.0_dp]
      call chain%move_rod(motion, reachable)
      do i = 1, 2
        loads%force = 0
        loads%moment = 0
        loads%force(:, piston_pin) = -merge(euler, 0.0_dp, i == 2)*[motion%cos_rod, -motion%sin_rod]
        call body%begin(6, 1)
        call set_own_equations(rod, chain%bodies, loads, motion, body)
        load(i) = body%load(4)
      end do
    end associate
    call check%that(reachable .and. load(1) < 0, 'without a load the rod has a restoring force')
    call check%close_to(load(2)/load(1), 0.0_dp, 1e-14_dp, 'Euler''s load')
  end subroutine it_buckles_at_eulers_load
end module test_elastic_rod
