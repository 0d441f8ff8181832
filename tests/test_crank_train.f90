!> Several cylinders on one crankshaft: natural frequencies against closed forms, ideal cylinders against their energies, and the
!> derivatives of the shaft against differences.
module test_crank_train
  use kinds, only: dp
  use constants, only: pi, two_pi
  use checks, only: checks_t
  use chain_motion, only: motion_t, turn_crank
  use chain_bodies, only: crank_t, rod_t, piston_t, drive_t, undriven, new_bodies
  use state_layout, only: coordinates_t
  use ideal_cylinders, only: ideal_cylinder_t, cylinder_forces_t, small_sine_cosine
  use torsional_modes, only: find_modes
  use crank_train, only: crank_train_t
  implicit none
  private
  public :: run_test_crank_train

contains

  subroutine run_test_crank_train(check)
    class(checks_t), intent(inout) :: check
    call knows_uniform_shafts(check)
    call knows_a_damper(check)
    call follows_its_energy(check)
    call knows_small_angles(check)
    call has_its_slopes(check)
  end subroutine run_test_crank_train

  !> A shaft of equal stations has the frequencies 2 sqrt(k/J) sin(i pi/(2 n)) free, 2 sqrt(k/J) sin((2 i - 1) pi/(4 n - 2)) with
  !> an end held.
  subroutine knows_uniform_shafts(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n = 7
    real(dp), allocatable :: frequency(:), shape(:, :)
    real(dp) :: inertia(n), stiffness(n - 1), nothing(0)
    integer :: none(0), i
    inertia = 0.3_dp
    stiffness = 2e5_dp
    call find_modes(inertia, stiffness, none, nothing, nothing, 0, frequency, shape)
    call check%that(size(frequency) == n - 1, 'a free shaft has a mode less than stations')
    call check%that(all(abs(frequency/[(2*sqrt(2e5_dp/0.3_dp)*sin(i*pi/(2*n)), i=1, n - 1)] - 1) < 1e-12_dp), &
      'frequencies of a free uniform shaft')
    call check%that(all(abs(maxval(abs(shape), 1) - 1) < 1e-14_dp), 'the largest element of a shape is 1')
    call check%that(all(abs(matmul(inertia, shape)) < 1e-13_dp), 'free shapes have no angular momentum')
    call find_modes(inertia, stiffness, none, nothing, nothing, n, frequency, shape)
    call check%that(all(abs(frequency/[(2*sqrt(2e5_dp/0.3_dp)*sin((2*i - 1)*pi/(4*n - 2)), i=1, n - 1)] - 1) < 1e-12_dp), &
      'frequencies of a uniform shaft held at its end')
    call check%that(all(abs(shape(n, :)) <= 0), 'a held station is at rest')
  end subroutine knows_uniform_shafts

  !> Two inertias on a spring, and a ring on one of them: the roots of the characteristic equation.
  subroutine knows_a_damper(check)
    class(checks_t), intent(inout) :: check
    real(dp), allocatable :: frequency(:), shape(:, :)
    real(dp) :: a, b, c, w(2)
    call find_modes([0.2_dp, 1.0_dp], [3e4_dp], [1], [0.05_dp], [4e3_dp], 2, frequency, shape)
    ! with the second station held: J1 J_r w^4 - (J1 k_r + J_r (k + k_r)) w^2 + k k_r = 0
    a = 0.2_dp*0.05_dp
    b = 0.2_dp*4e3_dp + 0.05_dp*(3e4_dp + 4e3_dp)
    c = 3e4_dp*4e3_dp
    w = sqrt((b + [-1, 1]*sqrt(b**2 - 4*a*c))/(2*a))
    call check%that(all(abs(frequency/w - 1) < 1e-12_dp), 'frequencies of a station with a ring')
  end subroutine knows_a_damper

  !> Inertia, its slope and the torque of weight and gas follow from the energy; the torque of the rod from the forces on its pin.
  subroutine follows_its_energy(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: h = 1e-5_dp, speed = 31.0_dp, gas = 850.0_dp, acceleration = 77.0_dp
    type(ideal_cylinder_t) :: cylinder, bare
    type(cylinder_forces_t) :: ahead, behind, forces
    real(dp) :: q, inertia, torque, still, unused, slope, off(4), lagrange
    integer :: i
    call cylinder%set_bodies(new_bodies(crank_t(0.04_dp, 1.2_dp, 0.0018_dp, [-0.004_dp, 0.003_dp]), &
      rod_t(0.135_dp, 0.55_dp, 0.0019_dp, [0.04_dp, 0.002_dp]), piston_t(0.42_dp, axis_offset=0.012_dp), &
      [-9.2_dp, 3.1_dp]))
    call bare%set_bodies(new_bodies(crank_t(0.04_dp, 0.0_dp, 0.0_dp, [0.0_dp, 0.0_dp]), cylinder%bodies%rod, &
      cylinder%bodies%piston, cylinder%bodies%gravity))
    off = 0
    do i = 1, 24
      q = two_pi*i/24 + 0.1_dp
      call row(cylinder, q, speed, gas, inertia, torque)
      call row(cylinder, q, 0.0_dp, gas, unused, still)
      off(1) = max(off(1), abs(inertia - 2*(cylinder%energy(q, 1.0_dp) - cylinder%energy(q, 0.0_dp)))/inertia)
      slope = (cylinder%inertia(q + h) - cylinder%inertia(q - h))/(2*h)
      off(2) = max(off(2), abs((still - torque) - 0.5_dp*slope*speed**2))
      ahead = cylinder%forces(q + h, 0.0_dp, 0.0_dp, gas)
      behind = cylinder%forces(q - h, 0.0_dp, 0.0_dp, gas)
      off(3) = max(off(3), abs(still + (cylinder%energy(q + h, 0.0_dp) - cylinder%energy(q - h, 0.0_dp) &
        + gas*(ahead%piston_position - behind%piston_position))/(2*h)))
      forces = bare%forces(q, speed, acceleration, gas)
      call row(bare, q, speed, gas, inertia, torque)
      lagrange = torque - inertia*acceleration
      off(4) = max(off(4), abs(forces%torque - lagrange))
    end do
    call check%that(off(1) < 1e-12_dp, 'inertia of an ideal cylinder from its energy')
    call check%that(off(2) < 1e-6_dp, 'torque of the speed from the slope of the inertia')
    call check%that(off(3) < 1e-6_dp, 'torque of weight and gas from their work')
    call check%that(off(4) < 1e-11_dp, 'torque of the rod by Lagrange and by Newton and Euler')
  contains

    subroutine row(one, angle, rate, force, inertia, torque)
      type(ideal_cylinder_t), intent(in) :: one
      real(dp), intent(in) :: angle, rate, force
      real(dp), intent(out) :: inertia, torque
      real(dp) :: half_slope, weight, piston_rate
      call one%find_terms(sin(angle), cos(angle), inertia, half_slope, weight, piston_rate)
      torque = weight - force*piston_rate - half_slope*rate**2
    end subroutine row
  end subroutine follows_its_energy

  subroutine knows_small_angles(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: angle, sine, cosine, off
    integer :: i
    off = 0
    do i = -60, 60
      angle = 1e-3_dp*i
      call small_sine_cosine(angle, sine, cosine)
      off = max(off, abs(sine - sin(angle)), abs(cosine - cos(angle)))
    end do
    call check%that(off < 3e-16_dp, 'sine and cosine of small angles')
  end subroutine knows_small_angles

  !> The derivatives of a free shaft with a rubber and a viscous ring against differences of its accelerations. Nothing else acts on
  !> the crank, whose own inertia is that of its station.
  subroutine has_its_slopes(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: m = 5   ! positions: the crank, three twists, a rubber ring
    type(crank_train_t) :: train
    type(coordinates_t) :: crank
    type(drive_t) :: drive
    real(dp) :: y(2*m + 1), f(2*m + 1), moved(2*m + 1), found(2*m + 1), a_p(m + 1, m), a_v(m + 1, m + 1), off, step
    integer :: i
    allocate (train%rings(2), train%cylinders(0))
    train%n = 4
    train%full = 2
    train%driven = 4
    train%is_chain = .true.
    train%inertia(:4) = [0.02_dp, 0.05_dp, 0.04_dp, 0.7_dp]
    train%stiffness(:3) = [2e4_dp, 3e4_dp, 5e4_dp]
    train%damping(:3) = [2.0_dp, 3.0_dp, 1.0_dp]
    train%drag(:4) = [0.1_dp, 0.2_dp, 0.3_dp, 0.4_dp]
    train%rings%station = [1, 2]
    train%rings%inertia = [0.01_dp, 0.03_dp]
    train%rings%stiffness = [4e3_dp, 0.0_dp]
    train%rings%damping = [1.5_dp, 2.5_dp]
    train%rings%is_viscous = [.false., .true.]
    crank = coordinates_t(1, 1, m + 1)
    train%at(1) = coordinates_t(1, 2, m + 2)
    train%at(3) = coordinates_t(1, 3, m + 3)
    train%at(4) = coordinates_t(1, 4, m + 4)
    train%rings(1)%at = coordinates_t(1, 5, m + 5)
    train%rings(2)%speed_at%first = 2*m + 1
    train%rings(2)%speed_at%last = 2*m + 1
    drive = undriven
    drive%damping = 0.6_dp
    y = [(sin(1.7_dp*i)*merge(1e-2_dp, 3.0_dp, i <= m), i=1, 2*m + 1)]
    a_p = 0
    a_v = 0
    call train%add_slopes(drive, train%inertia(:4), crank, [1], [1/train%inertia(2)], a_p, a_v)
    call rates(y, f)
    off = 0
    do i = 1, 2*m + 1
      step = 1e-4_dp
      moved = y
      moved(i) = y(i) + step
      call rates(moved, found)
      moved = (found - f)/step
      if (i <= m) off = max(off, maxval(abs(moved(m + 1:) - a_p(:, i))/(1 + abs(a_p(:, i)))))
      if (i > m) off = max(off, maxval(abs(moved(m + 1:) - a_v(:, i - m))/(1 + abs(a_v(:, i - m)))))
    end do
    call check%that(off < 1e-6_dp, 'derivatives of a shaft with dampers')

  contains

    subroutine rates(state, dydt)
      real(dp), intent(in) :: state(:)
      real(dp), intent(out) :: dydt(:)
      type(motion_t) :: motion
      real(dp) :: acceleration(4), ring(2), copy(size(state))
      integer :: j
      copy = state
      call turn_crank(motion, copy(1), copy(m + 1))
      call train%read_state(0.0_dp, copy, motion)
      call train%load_stations(motion)
      motion%train%torque(4) = motion%train%torque(4) - drive%damping*motion%train%speed(4)
      acceleration = motion%train%torque(:4)/motion%train%inertia(:4)
      ring = -[(train%ring_torque(motion, j)/train%rings(j)%inertia, j=1, 2)]
      dydt(:m) = copy(m + 1:2*m)
      dydt(m + 1) = acceleration(2)
      dydt(m + 2:m + 4) = acceleration([1, 3, 4]) - acceleration(2)
      dydt(m + 5) = ring(1) - acceleration(1)
      dydt(2*m + 1) = ring(2) - acceleration(2)
    end subroutine rates
  end subroutine has_its_slopes
end module test_crank_train
