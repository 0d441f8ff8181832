!> The moving parts of self-acting valves that have a mass, reeds or plates:
!>
!>     M x'' = f - k x - d x',    f = dp A_f - F_0,    0 <= x <= l
!>
!> with the difference dp of the pressures in the sense in which the valve opens and the quantities of `flow_valve`. A reed on its
!> seat leaves it when f > 0, one at its stop when f < k l; it meets both without rebound, and stays in flight there if the force
!> points away. The gas does not feel the work that it does on a reed, nor the volume behind it.
module valve_reeds
  use kinds, only: dp
  use state_layout, only: layout_t, coordinates_t
  use run_state, only: run_state_t
  use flow_valve, only: flow_valve_t
  implicit none
  private
  public :: reeds_t, ports, n_reed_events, in_flight

  character(len=9), parameter :: ports(2) = [character(len=9) :: 'suction', 'discharge']
  integer, parameter :: n_reed_events = size(ports)   !! one for the valves of each port of all cylinders

  !> Where a reed is.
  integer, parameter :: seated = 1, in_flight = 2, at_stop = 3

  !> A reed leaves a bound at a force larger by this share of that at the full lift: at equal pressures no event function is 0.
  real(dp), parameter :: force_margin = 1e-12_dp

  real(dp), parameter :: nearby = 1e-9_dp   !! of the lift: at a bound but for rounding
  real(dp), parameter :: beyond = 1e-2_dp   !! of the lift: behind a bound by more than any margin

  type :: reeds_t
    type(coordinates_t) :: at(size(ports))   !! lifts and speeds of all cylinders, the mechanism's first; none: a valve without mass
    integer, allocatable :: place(:, :)      !! (port, cylinder)
    real(dp) :: margin = 0   !! a reed meets a bound this share of its lift behind it: the tolerance, within which it may seem to do
                             !! so while it leaves the bound
  contains
    procedure :: claim
    procedure :: declare
    procedure :: lift_and_speed
    procedure :: acceleration
    procedure :: events
    procedure :: pass
    procedure :: impact_speed
  end type reeds_t

contains

  !> Claim lifts and speeds of a number of cylinders. At the start all valves are shut.
  subroutine claim(self, layout, valves, cylinders)
    class(reeds_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    type(flow_valve_t), intent(in) :: valves(size(ports))
    integer, intent(in) :: cylinders
    integer :: k
    do k = 1, size(ports)
      associate (it => valves(k))
        if (it%mass > 0) call layout%claim_positions(cylinders, it%lift, sqrt(it%full_force()*it%lift/it%mass), self%at(k), &
          grows=.false.)
      end associate
    end do
    self%place = spread([(seated, k=1, size(ports))], 2, cylinders)
  end subroutine claim

  !> Declare the states of cylinder i, with a prefix for their names.
  subroutine declare(self, list, valves, i, y, prefix)
    class(reeds_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(flow_valve_t), intent(in) :: valves(size(ports))
    integer, intent(in) :: i
    real(dp), intent(inout) :: y(:)
    character(len=*), intent(in) :: prefix
    character(len=:), allocatable :: name
    integer :: k
    do k = 1, size(ports)
      if (self%at(k)%n == 0) cycle
      name = prefix//trim(ports(k))//'_valve_'
      associate (place => self%place(k, i), x => y(self%at(k)%position + i - 1), speed => y(self%at(k)%rate + i - 1))
        call list%add(name//'place', place, '1: the '//trim(ports(k))//' valve is on its seat, 2: in flight, 3: at its stop')
        call list%add(name//'lift', x, 'm', 'lift of the '//trim(ports(k))//' valve')
        call list%add(name//'speed', speed, 'm/s', 'rate of its lift')
        if (.not. list%sets) cycle
        if (all(place /= [seated, in_flight, at_stop])) call list%refuse(name//'place', 'must be 1, 2 or 3')
        if (abs(x - valves(k)%lift/2) > (1 + beyond)*valves(k)%lift/2) &
          call list%refuse(name//'lift', 'must be from 0 to the full lift')
        if (place == in_flight) cycle
        x = merge(0.0_dp, valves(k)%lift, place == seated)
        speed = 0
      end associate
    end do
  end subroutine declare

  !> Lift [m] and speed [m/s] of the reed of a port of cylinder i; at a bound those there, to which an implicit method adds
  !> rounding.
  pure function lift_and_speed(self, valve, port, i, y) result(found)
    class(reeds_t), intent(in) :: self
    type(flow_valve_t), intent(in) :: valve
    integer, intent(in) :: port, i
    real(dp), intent(in) :: y(:)
    real(dp) :: found(2)
    found = 0
    if (self%place(port, i) == at_stop) found(1) = valve%lift
    if (self%place(port, i) == in_flight) found = y([self%at(port)%position, self%at(port)%rate] + i - 1)
  end function lift_and_speed

  !> Acceleration of the reed of a port of cylinder i under a difference of the pressures [Pa] [m/s^2].
  pure real(dp) function acceleration(self, valve, port, i, difference, y)
    class(reeds_t), intent(in) :: self
    type(flow_valve_t), intent(in) :: valve
    integer, intent(in) :: port, i
    real(dp), intent(in) :: difference, y(:)
    acceleration = 0
    if (self%place(port, i) == in_flight) acceleration = (valve%opening_force(difference) - &
      valve%stiffness*y(self%at(port)%position + i - 1) - valve%damping*y(self%at(port)%rate + i - 1))/valve%mass
  end function acceleration

  !> Event function of the reed of a port of cylinder i and its rate, under a difference of the pressures [Pa] with its rate [Pa/s]:
  !> of a reed in flight the distance behind the nearer bound over the lift, else the force away from the bound over that at full
  !> lift.
  pure subroutine events(self, valve, port, i, difference, rate, y, g, g_rate)
    class(reeds_t), intent(in) :: self
    type(flow_valve_t), intent(in) :: valve
    integer, intent(in) :: port, i
    real(dp), intent(in) :: difference, rate, y(:)
    real(dp), intent(out) :: g, g_rate
    g = -1
    g_rate = 0
    if (self%at(port)%n == 0) return
    select case (self%place(port, i))
    case (in_flight)
      associate (share => y(self%at(port)%position + i - 1)/valve%lift)
        g = abs(share - 0.5_dp) - 0.5_dp - self%margin
        g_rate = sign(1.0_dp, share - 0.5_dp)*y(self%at(port)%rate + i - 1)/valve%lift
      end associate
    case (seated)
      g = valve%opening_force(difference)/valve%full_force() - force_margin
      g_rate = rate*valve%force_area/valve%full_force()
    case default
      g = (valve%stiffness*valve%lift - valve%opening_force(difference))/valve%full_force() - force_margin
      g_rate = -rate*valve%force_area/valve%full_force()
    end select
  end subroutine events

  !> Pass the event: the reed leaves its bound, or meets one and stays there unless the force points away.
  pure subroutine pass(self, valve, port, i, difference, y)
    class(reeds_t), intent(inout) :: self
    type(flow_valve_t), intent(in) :: valve
    integer, intent(in) :: port, i
    real(dp), intent(in) :: difference
    real(dp), intent(inout) :: y(:)
    real(dp) :: g, unused
    logical :: leaves
    associate (x => y(self%at(port)%position + i - 1), place => self%place(port, i))
      leaves = place /= in_flight
      place = merge(seated, at_stop, x < valve%lift/2)
      x = merge(0.0_dp, valve%lift, place == seated)
      y(self%at(port)%rate + i - 1) = 0
      if (.not. leaves) then
        call self%events(valve, port, i, difference, 0.0_dp, y, g, unused)
        leaves = .not. g < 0
      end if
      if (leaves) place = in_flight
    end associate
  end subroutine pass

  !> Speed at which the reed of a port of the mechanism's cylinder meets a bound, before that event; 0 if it does not [m/s].
  pure real(dp) function impact_speed(self, valve, port, y)
    class(reeds_t), intent(in) :: self
    type(flow_valve_t), intent(in) :: valve
    integer, intent(in) :: port
    real(dp), intent(in) :: y(:)
    real(dp) :: g, g_rate
    impact_speed = 0
    if (self%at(port)%n == 0) return
    if (self%place(port, 1) /= in_flight) return
    call self%events(valve, port, 1, 0.0_dp, 0.0_dp, y, g, g_rate)
    if (g > -nearby) impact_speed = abs(y(self%at(port)%rate))
  end function impact_speed
end module valve_reeds
