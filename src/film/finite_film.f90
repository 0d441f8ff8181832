!> Solver for the pressure of a film of finite length and its results. The table of the law `finite_bearing` is computed with it.
module finite_film
  use kinds, only: dp
  use constants, only: pi
  use reynolds_grid, only: reynolds_grid_t, new_reynolds_grid
  use film_equations, only: film_equations_t
  implicit none
  private
  public :: film_answer_t, film_solver_t
  public :: cavitation_none, cavitation_gumbel, cavitation_reynolds

  !> Treatment of negative pressures: none (Sommerfeld); they are set to 0 (Gumbel); the film ruptures where the pressure and its
  !> gradient are 0 (Swift and Stieber: P >= 0, r = div(H^3 grad P) + 12 cos(phi - alpha) <= 0, P r = 0).
  integer, parameter :: cavitation_none = 1, cavitation_gumbel = 2, cavitation_reynolds = 3

  !> Force along n and t over mu V L R^3/c^2, side flow out of both ends over V c R^2, and largest pressure over mu V R^2/c^2.
  type :: film_answer_t
    real(dp) :: force(2) = 0, flow = 0, most = 0
  end type film_answer_t

  !> A solver for one eccentricity and any direction of the velocity. Pressures and other values at nodes are (axial node, node
  !> around the film).
  type :: film_solver_t
    private
    type(film_equations_t) :: equations
    real(dp), allocatable :: linear(:, :, :)   !! solutions for the sources cos phi and sin phi
    real(dp), allocatable :: pressure(:, :)    !! of the last solution
    logical, allocatable :: active(:, :)       !! nodes at which it was positive; the next solution starts from them
    logical, allocatable :: open(:, :)         !! nodes in a groove, where the pressure is 0
  contains
    procedure :: begin
    procedure :: open_arc
    procedure :: solve
    procedure :: pressure_at
  end type film_solver_t

contains

  !> Prepare for one thickness `gap` = 1 - eps (> 0, <= 1) and the half length L/(2R) on n times m nodes; those around the film are
  !> shifted by a fraction of their distance.
  pure subroutine begin(self, n, m, gap, half_length, shift)
    class(film_solver_t), intent(inout) :: self
    integer, intent(in) :: n, m
    real(dp), intent(in) :: gap, half_length
    real(dp), intent(in), optional :: shift
    real(dp) :: turned
    turned = 0
    if (present(shift)) turned = shift
    call self%equations%begin(new_reynolds_grid(n, m, gap, half_length, turned))
    if (allocated(self%linear)) deallocate (self%linear, self%pressure, self%active, self%open)
    allocate (self%linear(m, n, 2), self%pressure(m, n), self%active(m, n))
    allocate (self%open(m, n), source=.false.)
    self%active = .true.
    call self%equations%solve(source_of(self%equations%grid, 0.0_dp), self%active, self%linear(:, :, 1))
    call self%equations%solve(source_of(self%equations%grid, 0.5_dp*pi), self%active, self%linear(:, :, 2))
    self%pressure = 0
  end subroutine begin

  !> Keep the pressure at 0 over an arc of angles phi [rad], from < to, until the next `begin`: an axial groove open to the ambient.
  !> Only Reynolds' condition takes it into account. The published tables of journal bearings are for bearings with grooves; films
  !> of the program have none.
  pure subroutine open_arc(self, from, to)
    class(film_solver_t), intent(inout) :: self
    real(dp), intent(in) :: from, to
    real(dp), parameter :: tiny_angle = 1e-9_dp   !! so that a node at the end of the arc belongs to it
    integer :: i
    associate (angle => self%equations%grid%angle)
      do i = 1, size(angle)
        if (modulo(angle(i) - from + tiny_angle, 2*pi) <= to - from + 2*tiny_angle) self%open(:, i) = .true.
      end do
    end associate
  end subroutine open_arc

  !> The source 12 cos(phi - alpha), integrated exactly over the cells, per axial width.
  pure function source_of(grid, alpha) result(source)
    type(reynolds_grid_t), intent(in) :: grid
    real(dp), intent(in) :: alpha
    real(dp) :: source(grid%n)
    source = 12*(cos(alpha)*grid%sine + sin(alpha)*grid%cosine)
  end function source_of

  !> Solve for a velocity in the direction alpha from n to t. `warm`: start from the previous solution; `coarse`: start from the
  !> solution of the same film on the grid of half as many nodes in each direction.
  pure subroutine solve(self, alpha, cavitation, warm, answer, coarse)
    class(film_solver_t), intent(inout) :: self
    real(dp), intent(in) :: alpha   !! [rad]
    integer, intent(in) :: cavitation
    logical, intent(in) :: warm
    type(film_answer_t), intent(out) :: answer
    class(film_solver_t), intent(in), optional :: coarse
    if (cavitation /= cavitation_reynolds .or. .not. warm) then
      self%pressure = cos(alpha)*self%linear(:, :, 1) + sin(alpha)*self%linear(:, :, 2)
      self%active = self%pressure > 0
    end if
    if (cavitation == cavitation_reynolds) then
      if (present(coarse)) call refine(coarse%active, self%active)
      call find_film(self, source_of(self%equations%grid, alpha))
    end if
    call sum_up(self%equations%grid, self%pressure, cavitation, alpha, answer)
  end subroutine solve

  !> The nodes of a grid that are active on the grid of half as many nodes, or between two nodes of which one is.
  pure subroutine refine(coarse, fine)
    logical, intent(in) :: coarse(:, :)
    logical, intent(out) :: fine(:, :)
    fine(1::2, 1::2) = coarse
    fine(1::2, 2::2) = coarse .or. cshift(coarse, 1, 2)
    fine(2::2, :) = fine(1::2, :) .or. eoshift(fine(1::2, :), 1)
  end subroutine refine

  !> Solve the film with free edges, a linear complementarity problem, by the primal-dual active set method: P = 0 outside the
  !> active set, the equation holds inside. A node remains in the set while P > 0, and enters it where more flows in than out.
  pure subroutine find_film(self, source)
    class(film_solver_t), intent(inout) :: self
    real(dp), intent(in) :: source(:)
    integer, parameter :: most_rounds = 100
    logical :: active(size(self%active, 1), size(self%active, 2))
    integer :: round
    self%active = self%active .and. .not. self%open
    do round = 1, most_rounds
      call self%equations%solve(source, self%active, self%pressure)
      active = (self%pressure > 0 .or. flows_in(self%equations%grid, source, self%active, self%pressure)) .and. .not. self%open
      if (all(active .eqv. self%active)) exit
      self%active = active
    end do
    self%pressure = max(self%pressure, 0.0_dp)
  end subroutine find_film

  !> The nodes that are not active into whose cells more flows than out of them, beyond rounding.
  pure function flows_in(grid, source, active, pressure) result(inside)
    type(reynolds_grid_t), intent(in) :: grid
    real(dp), intent(in) :: source(:), pressure(:, :)
    logical, intent(in) :: active(:, :)
    logical :: inside(grid%m, grid%n)
    real(dp) :: flow(grid%m), rounding
    integer :: i, m
    m = grid%m
    rounding = 1e-13_dp*maxval(abs(source))*maxval(grid%width(:m))
    inside = .false.
    do i = 1, grid%n
      if (all(active(:, i))) cycle
      associate (before => modulo(i - 2, grid%n) + 1, after => modulo(i, grid%n) + 1)
        flow = (grid%around(before)*pressure(:, before) + grid%around(i)*pressure(:, after) + source(i))*grid%width(:m)
      end associate
      flow(2:) = flow(2:) + grid%height_cubed(i)*grid%along(:m - 1)*pressure(:m - 1, i)
      flow(:m - 1) = flow(:m - 1) + grid%height_cubed(i)*grid%along(:m - 1)*pressure(2:, i)
      inside(:, i) = flow > rounding .and. .not. active(:, i)
    end do
  end function flows_in

  !> Force, side flow and largest pressure of a solution.
  pure subroutine sum_up(g, pressure, cavitation, alpha, answer)
    type(reynolds_grid_t), intent(in) :: g
    real(dp), intent(in) :: pressure(:, :)
    integer, intent(in) :: cavitation
    real(dp), intent(in) :: alpha
    type(film_answer_t), intent(out) :: answer
    real(dp) :: line(g%n), out
    integer :: i, j

    do j = 1, g%m
      line = pressure(j, :)
      if (cavitation == cavitation_gumbel) then
        answer%force = answer%force - g%width(j)*positive_force(g%angle, line)
      else
        answer%force(1) = answer%force(1) - g%width(j)*sum(line*g%sine)
        answer%force(2) = answer%force(2) - g%width(j)*sum(line*g%cosine)
      end if
      answer%most = max(answer%most, peak_of(g%angle, line))
    end do
    answer%force = answer%force/g%half_length
    do i = 1, g%n   ! `line` is the last one before the end of the film
      out = g%along(g%m)*g%height_cubed(i)*line(i) &
        + 12*(cos(alpha)*g%sine(i) + sin(alpha)*g%cosine(i))*g%width(g%m + 1)
      if (cavitation == cavitation_none .or. line(i) > 0) answer%flow = answer%flow + out/6
    end do
  end subroutine sum_up

  !> Largest value of a pressure around the film: the maximum of the parabola through the largest node and its neighbours.
  pure real(dp) function peak_of(angle, pressure) result(peak)
    real(dp), intent(in) :: angle(:), pressure(:)
    real(dp) :: left, right, rise, fall, slope, bend
    integer :: i, n
    n = size(angle)
    i = maxloc(pressure, 1)
    peak = pressure(i)
    left = modulo(angle(i) - angle(modulo(i - 2, n) + 1), 2*pi)
    right = modulo(angle(modulo(i, n) + 1) - angle(i), 2*pi)
    rise = (peak - pressure(modulo(i - 2, n) + 1))/left
    fall = (peak - pressure(modulo(i, n) + 1))/right
    bend = (rise + fall)/(left + right)
    if (.not. bend > 0) return
    slope = (rise*right - fall*left)/(left + right)
    peak = peak + slope**2/(4*bend)
  end function peak_of

  !> Integrals of the positive part of a pressure that is linear between the nodes of the ring, times cos phi and sin phi.
  pure function positive_force(angle, pressure) result(force)
    real(dp), intent(in) :: angle(:), pressure(:)
    real(dp) :: force(2), left, right, from, to
    integer :: i, next, n
    n = size(angle)
    force = 0
    do i = 1, n
      next = modulo(i, n) + 1
      left = pressure(i)
      right = pressure(next)
      if (left <= 0 .and. right <= 0) cycle
      from = angle(i)
      to = merge(angle(1) + 8*atan(1.0_dp), angle(next), i == n)
      if (left < 0) from = from + (to - from)*left/(left - right)
      if (right < 0) to = to - (to - from)*right/(right - left)
      force = force + linear_integrals(from, to, max(left, 0.0_dp), max(right, 0.0_dp))
    end do
  end function positive_force

  !> Integrals from a to b of a linear function times cosine and sine.
  pure function linear_integrals(a, b, left, right) result(sums)
    real(dp), intent(in) :: a, b, left, right
    real(dp) :: sums(2), half, middle, even, odd
    middle = 0.5_dp*(a + b)
    half = 0.5_dp*(b - a)
    even = (left + right)*sin(half)
    odd = 0   ! (right - left)/(2 half) times the integral of x sin x from -half to half
    if (half > 1e-2_dp) then
      odd = (right - left)*(sin(half)/half - cos(half))
    else
      odd = (right - left)*half**2*(1/3.0_dp - half**2/30*(1 - half**2/28))
    end if
    sums = [cos(middle)*even - sin(middle)*odd, sin(middle)*even + cos(middle)*odd]
  end function linear_integrals

  !> Pressure of the last solution at the nodes over mu V R^2/c^2, (i, j) as in the grid, with the angles [rad] and axial positions
  !> over R of the nodes.
  pure subroutine pressure_at(self, angle, zeta, pressure)
    class(film_solver_t), intent(in) :: self
    real(dp), allocatable, intent(out) :: angle(:), zeta(:), pressure(:, :)
    angle = self%equations%grid%angle
    zeta = self%equations%grid%zeta
    pressure = max(transpose(self%pressure), 0.0_dp)
  end subroutine pressure_at
end module finite_film
