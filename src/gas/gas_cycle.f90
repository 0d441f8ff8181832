!> The gas pressure of an engine as a function of the crank angle (Reis 2013, appendix A): Wiebe heat release while the cylinder is
!> closed, intake pressure while it is open.
!>
!> Angles q count from the dead centre; firing is at 360 degrees. In a four-stroke cycle q = 0 is the gas-exchange dead centre, and
!> the cylinder is closed for a turn from the next bottom dead centre on; a two-stroke cycle repeats after 360 degrees.
!> A cycle has four smooth parts: compression, combustion, expansion, open. The pressure depends on the crank angle alone. It is
!> therefore integrated once, when the scene is built, and then interpolated; as a state it would require a power function and
!> stricter error control in every evaluation.
module gas_cycle
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t, fail, status_case_file
  use ode_problem, only: ode_problem_t
  use ode_method, only: ode_method_t
  use adams, only: adams_t
  use ode_solver, only: integrate, silent_observer_t, integration_done
  use cylinder, only: cylinder_t
  use hermite_table, only: hermite_table_t, new_hermite_table
  implicit none
  private
  public :: gas_cycle_t, heat_release_t, new_gas_cycle, released_share
  public :: n_parts, part_compression, part_combustion, part_expansion, part_open

  integer, parameter :: n_parts = 4
  integer, parameter :: part_compression = 1, part_combustion = 2, part_expansion = 3, part_open = 4
  integer, parameter :: fewest_intervals = 16, most_intervals = 16384

  !> Wiebe's heat release: x_b = 1 - exp(-a z^n), z = (q - start)/duration in [0, 1]; the remainder e^-a is not released.
  type :: heat_release_t
    real(dp) :: heat = 0         !! Q_in [J per cycle]
    real(dp) :: efficiency = 5   !! a [-]
    real(dp) :: form = 3         !! n [-]
    real(dp) :: start = 0        !! crank angle, while the cylinder is closed [rad]
    real(dp) :: duration = 0     !! [rad]
  end type heat_release_t

  type :: gas_cycle_t
    real(dp) :: period = 4*pi                     !! one cycle [rad]
    real(dp) :: closes = pi, opens = 3*pi         !! crank angles at which the cylinder closes and opens [rad]
    type(cylinder_t) :: cylinder
    type(heat_release_t) :: release
    real(dp) :: heat_capacity_ratio = 1.4_dp      !! gamma [-]
    real(dp) :: intake_pressure = 101325          !! [Pa]
    real(dp) :: bound(0:n_parts) = 0              !! crank angles between the parts, in the cycle that begins at 0 [rad]
    integer :: grading = 1                        !! z = xi^grading in the combustion table
    type(hermite_table_t) :: table(3)             !! pressure of the closed parts as a function of xi
  contains
    procedure :: pressure
    procedure :: pressure_slope
    procedure :: heat_slope
    procedure :: part_at
    procedure :: next_part
  end type gas_cycle_t

  !> Equation (A.9) as a function of xi, for one part; y is the pressure.
  type, extends(ode_problem_t) :: combustion_problem_t
    type(gas_cycle_t) :: gas
  contains
    procedure :: derivatives => pressure_derivative
  end type combustion_problem_t

  !> Observer that stores the solution at equidistant points.
  type, extends(silent_observer_t) :: point_keeper_t
    real(dp), allocatable :: value(:)   !! (0:n)
    integer :: next = 0
  contains
    procedure :: step_accepted
  end type point_keeper_t

contains

  !> Integrate the cycle with a relative error of at most `tolerance`, or rounding. Error: the integration fails.
  subroutine new_gas_cycle(gas, tolerance, error)
    class(gas_cycle_t), intent(inout) :: gas   !! with cylinder, release, pressures and heat_capacity_ratio set
    real(dp), intent(in) :: tolerance
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: goal, p
    integer :: part

    goal = max(tolerance, 1e-13_dp)
    associate (release => gas%release)
      gas%bound = [gas%closes, release%start, release%start + release%duration, gas%opens, gas%closes + gas%period]
      gas%bound(1) = max(gas%bound(1), gas%closes)
      gas%bound(2) = min(gas%bound(2), gas%opens)
      gas%grading = 1
      if (abs(release%form - nint(release%form)) > 0 .and. release%form < 8) gas%grading = ceiling(8/release%form)
    end associate
    p = gas%intake_pressure
    do part = part_compression, part_expansion
      call tabulate(gas, part, goal, p, error)
      if (allocated(error)) return
    end do
  end subroutine new_gas_cycle

  !> Share of its heat that Wiebe's function has released when it ends, 1 - exp(-a).
  pure real(dp) function released_share(efficiency) result(share)
    real(dp), intent(in) :: efficiency   !! a [-]
    share = 1 - exp(-efficiency)
  end function released_share

  !> Compute the table of one closed part that begins at pressure p; on return p is the pressure at its end. The number of intervals
  !> is doubled until the table agrees with the solution half way between its points.
  subroutine tabulate(gas, part, goal, p, error)
    type(gas_cycle_t), intent(inout) :: gas
    integer, intent(in) :: part
    real(dp), intent(in) :: goal
    real(dp), intent(inout) :: p
    type(error_t), allocatable, intent(out) :: error
    real(dp), allocatable :: values(:), slope(:), curvature(:)
    real(dp) :: miss
    integer :: n, i

    n = fewest_intervals
    do
      call solve_part(gas, part, goal, p, 2*n, values, error)
      if (allocated(error)) return
      allocate (slope(0:n), curvature(0:n))
      do i = 0, n
        call pressure_slopes(gas, part, real(i, dp)/n, values(2*i), slope(i), curvature(i))
      end do
      gas%table(part) = new_hermite_table(values(0:2*n:2), slope, curvature)
      miss = 0
      do i = 1, 2*n - 1, 2
        miss = max(miss, abs(gas%table(part)%value(0.5_dp*i/n)/values(i) - 1))
      end do
      if (miss <= goal .or. n >= most_intervals) exit
      deallocate (slope, curvature)
      n = 2*n
    end do
    p = values(2*n)
  end subroutine tabulate

  !> The pressure of one part at i/n, i = 0..n: in closed form without heat release, otherwise by the Adams method.
  subroutine solve_part(gas, part, goal, p, n, values, error)
    type(gas_cycle_t), intent(in) :: gas
    integer, intent(in) :: part, n
    real(dp), intent(in) :: goal, p
    real(dp), allocatable, intent(out) :: values(:)
    type(error_t), allocatable, intent(out) :: error
    type(combustion_problem_t) :: problem
    type(adams_t) :: method
    type(point_keeper_t) :: keeper
    real(dp) :: xi, y(1), volume
    integer :: i, status

    allocate (values(0:n))
    if (part /= part_combustion) then
      volume = gas%cylinder%volume(gas%bound(part - 1))
      do i = 0, n
        values(i) = p*(volume/gas%cylinder%volume(angle_in(gas, part, real(i, dp)/n)))**gas%heat_capacity_ratio
      end do
      return
    end if
    problem%gas = gas
    problem%n = 1
    allocate (keeper%value(0:n))
    keeper%value(0) = p
    keeper%next = 1
    method%settings%relative = [max(0.01_dp*goal, 1e-14_dp)]
    method%settings%absolute = [0.0_dp]
    method%settings%max_step = 2/(gas%grading*gas%release%form)   ! a release with a large exponent is short: no step passes over it
    xi = 0
    y = p
    call integrate(problem, method, xi, y, 1.0_dp, 100000, keeper, status)
    if (status /= integration_done) then
      call fail(error, '&combustion: the heat release cannot be integrated with these values', status_case_file)
      return
    end if
    keeper%value(n) = y(1)
    values = keeper%value
  end subroutine solve_part

  !> Crank angle for xi in a part [rad].
  pure real(dp) function angle_in(gas, part, xi)
    type(gas_cycle_t), intent(in) :: gas
    integer, intent(in) :: part
    real(dp), intent(in) :: xi
    real(dp) :: z
    z = xi
    if (part == part_combustion) z = xi**gas%grading
    angle_in = gas%bound(part - 1) + z*(gas%bound(part) - gas%bound(part - 1))
  end function angle_in

  !> dp/dxi and d2p/dxi2 from (A.9), dp/dq = -gamma p/V dV/dq + (gamma-1)/V dQ/dq, and its derivative.
  pure subroutine pressure_slopes(gas, part, xi, p, slope, curvature)
    type(gas_cycle_t), intent(in) :: gas
    integer, intent(in) :: part
    real(dp), intent(in) :: xi, p
    real(dp), intent(out) :: slope, curvature
    real(dp) :: q, reach, v, v1, v2, heat1, heat2, q1, q2, g

    g = 1
    if (part == part_combustion) g = gas%grading
    q = angle_in(gas, part, xi)
    reach = gas%bound(part) - gas%bound(part - 1)
    q1 = reach*g*power(xi, g - 1)
    q2 = reach*g*(g - 1)*power(xi, g - 2)
    v = gas%cylinder%volume(q)
    v1 = gas%cylinder%volume_slope(q)*q1
    v2 = gas%cylinder%volume_curvature(q)*q1**2 + gas%cylinder%volume_slope(q)*q2
    heat1 = 0
    heat2 = 0
    if (part == part_combustion) call heat_slopes(gas%release, g, xi, heat1, heat2)
    associate (gamma => gas%heat_capacity_ratio)
      slope = (-gamma*p*v1 + (gamma - 1)*heat1)/v
      curvature = (-gamma*(slope*v1 + p*v2) + (gamma - 1)*heat2 - slope*v1)/v
    end associate
  end subroutine pressure_slopes

  !> dQ/dxi and d2Q/dxi2 of Wiebe's release with z = xi^g (A.2, with corrected exponent).
  pure subroutine heat_slopes(release, g, xi, first, second)
    type(heat_release_t), intent(in) :: release
    real(dp), intent(in) :: g, xi
    real(dp), intent(out) :: first, second
    real(dp) :: m, rest
    m = g*release%form
    rest = release%heat*release%efficiency*m*exp(-release%efficiency*power(xi, m))
    first = rest*power(xi, m - 1)
    second = rest*((m - 1)*power(xi, m - 2) - release%efficiency*m*power(xi, 2*m - 2))
  end subroutine heat_slopes

  !> x^m with 0^0 = 1, and with 0 for a negative power of 0, which occurs only with a vanishing factor.
  pure real(dp) function power(x, m)
    real(dp), intent(in) :: x, m
    if (x > 0) then
      power = x**m
    else
      power = merge(1.0_dp, 0.0_dp, abs(m) <= 0)
    end if
  end function power

  pure subroutine pressure_derivative(self, t, y, dydt, in_domain)
    class(combustion_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    real(dp) :: unused_curvature
    call pressure_slopes(self%gas, part_combustion, t, y(1), dydt(1), unused_curvature)
    in_domain = .true.
  end subroutine pressure_derivative

  subroutine step_accepted(self, method, problem, t_to)
    class(point_keeper_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: y(1), t
    do while (self%next < ubound(self%value, 1))
      t = real(self%next, dp)/ubound(self%value, 1)
      if (t > t_to) exit
      call method%interpolate(t, y)
      self%value(self%next) = y(1)
      self%next = self%next + 1
    end do
  end subroutine step_accepted

  !> The part of the cycle at crank angle q, and the angle at which its cycle began, a multiple of the period. At a bound between
  !> parts it is the part after the bound or, if the crank turns `backwards`, the part before it; empty parts are skipped.
  pure subroutine part_at(self, q, backwards, part, cycle_start)
    class(gas_cycle_t), intent(in) :: self
    real(dp), intent(in) :: q
    logical, intent(in) :: backwards
    integer, intent(out) :: part
    real(dp), intent(out) :: cycle_start
    real(dp) :: angle
    cycle_start = self%period*floor((q - self%closes)/self%period)
    angle = q - cycle_start
    if (backwards .and. angle <= self%closes) then
      part = part_open
      cycle_start = cycle_start - self%period
      return
    end if
    do part = 1, n_parts - 1
      if (angle < self%bound(part) .or. backwards .and. angle <= self%bound(part)) exit
    end do
  end subroutine part_at

  !> Enter the next part of the cycle that is not empty, forwards or backwards.
  pure subroutine next_part(self, forwards, part, cycle_start)
    class(gas_cycle_t), intent(in) :: self
    logical, intent(in) :: forwards
    integer, intent(inout) :: part
    real(dp), intent(inout) :: cycle_start   !! angle at which the present cycle began [rad]
    integer :: way
    way = merge(1, -1, forwards)
    do
      part = part + way
      if (part > n_parts .or. part < 1) then
        part = merge(1, n_parts, forwards)
        cycle_start = cycle_start + way*self%period
      end if
      if (self%bound(part) > self%bound(part - 1)) exit
    end do
  end subroutine next_part

  !> Cylinder pressure [Pa] at the crank angle q [rad] in a part of the cycle that began at cycle_start [rad]. Near its bounds a
  !> part is continued smoothly for trial states.
  pure real(dp) function pressure(self, q, part, cycle_start)
    class(gas_cycle_t), intent(in) :: self
    real(dp), intent(in) :: q
    integer, intent(in) :: part
    real(dp), intent(in) :: cycle_start
    real(dp) :: xi
    pressure = self%intake_pressure
    if (part == part_open) return
    xi = (q - cycle_start - self%bound(part - 1))/(self%bound(part) - self%bound(part - 1))
    if (part == part_combustion .and. self%grading > 1) xi = max(xi, 0.0_dp)**(1.0_dp/self%grading)
    pressure = self%table(part)%value(xi)
  end function pressure

  !> Heat that is released for each angle of the crank, at an angle q in a part of the cycle [J/rad].
  pure real(dp) function heat_slope(self, q, part, cycle_start)
    class(gas_cycle_t), intent(in) :: self
    real(dp), intent(in) :: q
    integer, intent(in) :: part
    real(dp), intent(in) :: cycle_start
    real(dp) :: unused
    heat_slope = 0
    if (part /= part_combustion) return
    associate (reach => self%bound(part) - self%bound(part - 1))
      call heat_slopes(self%release, 1.0_dp, (q - cycle_start - self%bound(part - 1))/reach, heat_slope, unused)
      heat_slope = heat_slope/reach
    end associate
  end function heat_slope

  !> Derivative of the pressure with respect to the crank angle [Pa/rad]. Where the combustion table is graded it is (A.9) at the
  !> pressure of the table, since the slope of the table over that of the grading is 0/0 at the start of combustion.
  pure real(dp) function pressure_slope(self, q, part, cycle_start)
    class(gas_cycle_t), intent(in) :: self
    real(dp), intent(in) :: q
    integer, intent(in) :: part
    real(dp), intent(in) :: cycle_start
    real(dp) :: reach, z, heat, unused
    pressure_slope = 0
    if (part == part_open) return
    reach = self%bound(part) - self%bound(part - 1)
    z = (q - cycle_start - self%bound(part - 1))/reach
    if (part == part_combustion .and. self%grading > 1) then
      call heat_slopes(self%release, 1.0_dp, z, heat, unused)
      associate (gamma => self%heat_capacity_ratio, at => q - cycle_start)
        pressure_slope = ((gamma - 1)*heat/reach - gamma*self%pressure(q, part, cycle_start)*self%cylinder%volume_slope(at)) &
          /self%cylinder%volume(at)
      end associate
    else
      pressure_slope = self%table(part)%slope(z)/reach
    end if
  end function pressure_slope
end module gas_cycle
