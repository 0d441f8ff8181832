!> Two-stroke engines and compressors: the work of a cycle against closed forms, and the valves for both senses of rotation.
module test_gas_machines
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use error_handling, only: error_t
  use ideal_linkage, only: linkage_t
  use two_stroke, only: two_stroke_t
  use compressor, only: compressor_t
  use working_gas, only: working_gas_t
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_gas_machines

  real(dp), parameter :: crank = 0.04_dp, rod = 0.13_dp, bore = 0.07_dp
  real(dp), parameter :: displacement = 2*crank*pi*bore**2/4

contains

  subroutine run_test_gas_machines(check)
    class(checks_t), intent(inout) :: check
    call otto_cycle_with_ports(check)
    call compressor_work(check, 5e5_dp, 1.3_dp, 0.05_dp)
    call compressor_work(check, 1.5e5_dp, 1.0_dp, 0.2_dp)
    call compressor_work(check, 1e8_dp, 1.4_dp, 0.1_dp)
    call piston_that_turns_back(check)
  end subroutine run_test_gas_machines

  !> Distance of the piston from its top position, from the geometry of the mechanism, as swept volume [m^3].
  pure real(dp) function volume_at(q, dead)
    real(dp), intent(in) :: q, dead
    volume_at = dead + pi*bore**2/4*(crank + rod - crank*cos(q) - sqrt(rod**2 - (crank*sin(q))**2))
  end function volume_at

  !> Work of the gas from q1 to q2 without events between [J], by Gauss's rule of five points on 400 pieces.
  real(dp) function work_between(gas, q1, q2) result(work)
    type(working_gas_t), intent(in) :: gas
    real(dp), intent(in) :: q1, q2
    real(dp), parameter :: x(5) = [-0.906179845938663993_dp, -0.538469310105683091_dp, 0.0_dp, 0.538469310105683091_dp, &
      0.906179845938663993_dp]
    real(dp), parameter :: w(5) = [0.236926885056189088_dp, 0.478628670499366468_dp, 0.568888888888888889_dp, &
      0.478628670499366468_dp, 0.236926885056189088_dp]
    real(dp) :: h, q, slope
    integer :: i, k
    integer, parameter :: pieces = 400
    work = 0
    h = (q2 - q1)/pieces
    do i = 1, pieces
      do k = 1, 5
        q = q1 + h*(i - 0.5_dp + 0.5_dp*x(k))
        slope = pi*bore**2/4*crank*sin(q)*(1 + crank*cos(q)/sqrt(rod**2 - (crank*sin(q))**2))
        work = work + 0.5_dp*h*w(k)*gas%pressure(q)*slope
      end do
    end do
  end function work_between

  !> If all heat is released at the dead centre, the cycle is the Otto cycle: W = Q (1 - r^(1-gamma)), r from the volume at which
  !> the ports close.
  subroutine otto_cycle_with_ports(check)
    class(checks_t), intent(inout) :: check
    type(two_stroke_t) :: engine
    type(working_gas_t) :: gas
    type(error_t), allocatable :: error
    real(dp) :: dead, ratio, work, bounds(0:4), peak
    integer :: i
    real(dp), parameter :: gamma = 1.33_dp, burn = 1e-5_dp
    engine%bore = bore
    engine%compression_ratio = 9
    engine%heat_capacity_ratio = gamma
    engine%heat = 250
    engine%efficiency = 100   ! the unburnt share is e^-100
    engine%form = 2
    engine%start_deg = 360 - 0.5_dp*burn
    engine%duration_deg = burn
    engine%port_opens_deg = 105
    call engine%prepare(linkage_t(crank, rod), 1.0_dp, 1e-12_dp, gas, error)
    dead = displacement/8
    bounds = [255.0_dp, engine%start_deg, engine%start_deg + burn, 465.0_dp, 615.0_dp]*degree
    work = 0
    do i = 1, 4
      call gas%start(0.5_dp*(bounds(i - 1) + bounds(i)), 1.0_dp)
      work = work + work_between(gas, bounds(i - 1), bounds(i))
      if (i == 3) peak = gas%pressure(bounds(2))
    end do
    ratio = volume_at(105*degree, dead)/dead
    call check%relative(work, 250*(1 - ratio**(1 - gamma)), 1e-8_dp, 'Otto cycle of a two-stroke engine: work')
    call check%that(gas%revolutions == 1, 'a two-stroke engine repeats after one revolution')
    call check%relative(peak, 101325*ratio**gamma + (gamma - 1)*250/dead, 1e-6_dp, &
      'Otto cycle of a two-stroke engine: peak pressure')
    call gas%start(0.0_dp, 1.0_dp)
    call check%that(gas%pressure(255*degree - two_pi) < 101326, 'ports that close at 255 degrees close at -105 too')
  end subroutine otto_cycle_with_ports

  !> W = n/(n-1) p1 (V1 - V4) ((p2/p1)^((n-1)/n) - 1), with V4 = V0 (p2/p1)^(1/n) at the beginning of suction; for n = 1: p1 (V1 -
  !> V4) ln(p2/p1). If the pressure does not reach the discharge pressure, no gas flows and the work is 0.
  subroutine compressor_work(check, discharge, n, dead_space)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: discharge, n, dead_space
    type(working_gas_t) :: gas
    real(dp) :: opens, sucks, dead, work, want, ratio, bounds(0:4), way
    integer :: i, turn
    real(dp), parameter :: suction = 1e5_dp
    gas = compressor_of(discharge, n, dead_space)
    dead = dead_space*displacement
    ratio = discharge/suction
    opens = pi
    sucks = two_pi
    want = 0
    if (ratio < ((displacement + dead)/dead)**n) then
      opens = two_pi - angle_of((displacement + dead)*ratio**(-1/n), dead)
      sucks = two_pi + angle_of(dead*ratio**(1/n), dead)
      want = log(ratio)
      if (abs(n - 1) > 0) want = n/(n - 1)*(ratio**((n - 1)/n) - 1)
      want = -suction*(displacement + dead - dead*ratio**(1/n))*want
    end if
    do turn = 1, 2   ! forwards and backwards
      way = merge(1.0_dp, -1.0_dp, turn == 1)
      bounds = [pi, opens, two_pi, sucks, 3*pi]
      if (turn == 2) bounds = two_pi - bounds
      work = 0
      do i = 1, 4
        if (abs(bounds(i) - bounds(i - 1)) <= 0) cycle
        call gas%start(0.5_dp*(bounds(i - 1) + bounds(i)), way)
        work = work + work_between(gas, bounds(i - 1), bounds(i))
      end do
      call check%close_to(work/(suction*displacement), want/(suction*displacement), 1e-10_dp, &
        'work of a compressor in a revolution')
    end do

  contains

    !> Crank angle from the inner dead centre at which the cylinder has this volume, by bisection.
    real(dp) function angle_of(volume, dead)
      real(dp), intent(in) :: volume, dead
      real(dp) :: low, high
      integer :: k
      low = 0
      high = pi
      do k = 1, 60
        angle_of = 0.5_dp*(low + high)
        if (volume_at(angle_of, dead) < volume) then
          low = angle_of
        else
          high = angle_of
        end if
      end do
    end function angle_of
  end subroutine compressor_work

  type(working_gas_t) function compressor_of(discharge, n, dead_space) result(gas)
    real(dp), intent(in) :: discharge, n, dead_space
    type(compressor_t) :: machine
    type(error_t), allocatable :: error
    machine%bore = bore
    machine%dead_space = dead_space
    machine%suction_pressure = 1e5_dp
    machine%discharge_pressure = discharge
    machine%polytropic_exponent = n
    call machine%prepare(linkage_t(crank, rod), 1.0_dp, 1e-10_dp, gas, error)
  end function compressor_of

  !> If the piston turns back during discharge, the gas in the cylinder expands from there; the valves do not depend on the crank
  !> angle.
  subroutine piston_that_turns_back(check)
    class(checks_t), intent(inout) :: check
    type(working_gas_t) :: gas
    real(dp) :: g(2), g_rate(2), turned
    real(dp), parameter :: n = 1.3_dp, dead = 0.05_dp*displacement
    gas = compressor_of(5e5_dp, n, 0.05_dp)
    turned = 340*degree
    call gas%start(turned, 1.0_dp)
    call check%relative(gas%pressure(turned), 5e5_dp, 1e-15_dp, 'discharge at 340 degrees')
    call gas%events(turned, -1e-9_dp, g, g_rate)
    call check%that(g(1) < 0 .and. g(2) > 0, 'the crank turns back')
    call gas%pass(2, turned, -1e-9_dp)
    call check%relative(gas%pressure(turned), 5e5_dp, 1e-12_dp, 'the pressure does not jump when the crank turns back')
    call check%relative(gas%pressure(300*degree), 5e5_dp*(volume_at(turned, dead)/volume_at(300*degree, dead))**n, 1e-12_dp, &
      'the gas in the cylinder expands')
    call gas%events(turned, -1.0_dp, g, g_rate)
    call check%that(all(g < 0), 'no valve opens when the crank turns back')
    call gas%start(200*degree, 0.0_dp)
    call check%relative(gas%pressure(200*degree), 1e5_dp, 1e-15_dp, 'a machine at rest is filled at the suction pressure')
  end subroutine piston_that_turns_back
end module test_gas_machines
