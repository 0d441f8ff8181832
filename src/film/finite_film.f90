!> Solver for the pressure of a film of finite length and its results. The table of the law `finite_bearing` is computed with it.
module finite_film
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use reynolds_grid, only: reynolds_grid_t, new_reynolds_grid
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

  !> A solver for one eccentricity and any direction of the velocity. The unknowns are the pressures at the nodes of the grid, first
  !> in axial direction, then around the film in the order of the ring. The matrix, minus div(H^3 grad), is symmetric with half
  !> bandwidth 2m; its inverse has no negative elements.
  type :: film_solver_t
    private
    type(reynolds_grid_t) :: grid
    integer :: n = 0, band = 0
    integer, allocatable :: node(:)            !! node of the ring at each place of the order
    real(dp), allocatable :: matrix(:, :)      !! (0:band, n): element (i, l) is row l + i, column l of the matrix
    real(dp), allocatable :: linear(:, :)      !! solutions for the sources cos phi and sin phi
    real(dp), allocatable :: pressure(:)       !! of the last solution
    logical, allocatable :: active(:)          !! nodes at which it was positive; the next solution starts from them
    logical, allocatable :: open(:)            !! nodes in a groove, where the pressure is 0
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
    real(dp), allocatable :: factor(:, :)
    real(dp) :: turned
    integer :: i, j, k, next

    turned = 0
    if (present(shift)) turned = shift
    self%grid = new_reynolds_grid(n, m, gap, half_length, turned)
    self%n = n*m
    self%band = 2*m
    if (allocated(self%matrix)) deallocate (self%matrix, self%linear, self%pressure, self%active, self%open, self%node)
    allocate (self%matrix(0:self%band, self%n), self%linear(self%n, 2), self%pressure(self%n), self%active(self%n), self%node(n))
    allocate (self%open(self%n), source=.false.)
    self%matrix = 0
    do i = 1, n
      self%node(self%grid%place(i)) = i
    end do
    associate (g => self%grid, a => self%matrix)
      do i = 1, n
        next = modulo(i, n) + 1
        do j = 1, m
          k = (g%place(i) - 1)*m + j
          call connect(a, k, (g%place(next) - 1)*m + j, g%around(i)*g%width(j))
          if (j < m) then
            call connect(a, k, k + 1, g%along(j)*g%height_cubed(i))
          else
            a(0, k) = a(0, k) + g%along(m)*g%height_cubed(i)
          end if
        end do
      end do
    end associate
    factor = self%matrix
    call decompose(self%n, self%band, factor)
    call put_source(self, 1.0_dp, 0.0_dp, self%linear(:, 1))
    call put_source(self, 0.0_dp, 1.0_dp, self%linear(:, 2))
    call substitute(self%n, self%band, factor, self%linear(:, 1))
    call substitute(self%n, self%band, factor, self%linear(:, 2))
    self%active = .true.
    self%pressure = 0
  end subroutine begin

  !> Keep the pressure at 0 over an arc of angles phi [rad], from < to, until the next `begin`: an axial groove open to the ambient.
  !> Only Reynolds' condition takes it into account. The published tables of journal bearings are for bearings with grooves; films
  !> of the program have none.
  pure subroutine open_arc(self, from, to)
    class(film_solver_t), intent(inout) :: self
    real(dp), intent(in) :: from, to
    real(dp), parameter :: tiny_angle = 1e-9_dp   !! so that a node at the end of the arc belongs to it
    integer :: i, first
    do i = 1, self%grid%n
      if (modulo(self%grid%angle(i) - from + tiny_angle, 2*pi) > to - from + 2*tiny_angle) cycle
      first = (self%grid%place(i) - 1)*self%grid%m + 1
      self%open(first:first + self%grid%m - 1) = .true.
    end do
  end subroutine open_arc

  !> Add a conductance between two unknowns to the matrix.
  pure subroutine connect(a, k, l, conductance)
    real(dp), intent(inout) :: a(0:, :)
    integer, intent(in) :: k, l
    real(dp), intent(in) :: conductance
    a(0, k) = a(0, k) + conductance
    a(0, l) = a(0, l) + conductance
    a(abs(k - l), min(k, l)) = a(abs(k - l), min(k, l)) - conductance
  end subroutine connect

  !> The source 12 cos(phi - alpha), integrated exactly over the cells.
  pure subroutine put_source(self, cos_alpha, sin_alpha, source)
    class(film_solver_t), intent(in) :: self
    real(dp), intent(in) :: cos_alpha, sin_alpha
    real(dp), intent(out) :: source(:)
    integer :: i, m
    m = self%grid%m
    do i = 1, self%grid%n
      associate (node => self%node(i))
        source((i - 1)*m + 1:i*m) = 12*(cos_alpha*self%grid%sine(node) + sin_alpha*self%grid%cosine(node))*self%grid%width(:m)
      end associate
    end do
  end subroutine put_source

  !> Solve for a velocity in the direction alpha from n to t. `warm`: start from the previous solution.
  pure subroutine solve(self, alpha, cavitation, warm, answer)
    class(film_solver_t), intent(inout) :: self
    real(dp), intent(in) :: alpha   !! [rad]
    integer, intent(in) :: cavitation
    logical, intent(in) :: warm
    type(film_answer_t), intent(out) :: answer
    real(dp) :: source(self%n)
    call put_source(self, cos(alpha), sin(alpha), source)
    if (cavitation /= cavitation_reynolds .or. .not. warm) then
      self%pressure = cos(alpha)*self%linear(:, 1) + sin(alpha)*self%linear(:, 2)
      self%active = self%pressure > 0
    end if
    if (cavitation == cavitation_reynolds) call find_film(self, source)
    call sum_up(self, cavitation, alpha, answer)
  end subroutine solve

  !> Solve the film with free edges, a linear complementarity problem, by the primal-dual active set method: P = 0 outside the
  !> active set, the equation holds inside. A node remains in the set while P > 0, and enters it where its residual requires a
  !> positive pressure.
  pure subroutine find_film(self, source)
    class(film_solver_t), intent(inout) :: self
    real(dp), intent(in) :: source(:)
    integer, parameter :: most_rounds = 100
    real(dp), allocatable :: factor(:, :)
    real(dp) :: product(self%n), threshold
    logical :: active(self%n)
    integer :: round

    threshold = 1e-13_dp*maxval(abs(source))
    self%active = self%active .and. .not. self%open
    allocate (factor(0:self%band, self%n))
    do round = 1, most_rounds
      call restrict(self%n, self%band, self%matrix, self%active, factor)
      call decompose(self%n, self%band, factor)
      self%pressure = merge(source, 0.0_dp, self%active)
      call substitute(self%n, self%band, factor, self%pressure)
      call multiply(self%n, self%band, self%matrix, self%pressure, product)
      active = merge(self%pressure > 0, source - product > threshold, self%active) .and. .not. self%open
      if (all(active .eqv. self%active)) exit
      self%active = active
    end do
    self%pressure = max(self%pressure, 0.0_dp)
  end subroutine find_film

  !> The matrix for the active unknowns: rows and columns of the others are those of the unit matrix.
  pure subroutine restrict(n, band, matrix, active, part)
    integer, intent(in) :: n, band
    real(dp), intent(in) :: matrix(0:band, n)
    logical, intent(in) :: active(n)
    real(dp), intent(out) :: part(0:band, n)
    integer :: l, i
    do l = 1, n
      part(:, l) = 0
      part(0, l) = 1
      if (.not. active(l)) cycle
      part(0, l) = matrix(0, l)
      do i = 1, min(band, n - l)
        if (active(l + i)) part(i, l) = matrix(i, l)
      end do
    end do
  end subroutine restrict

  !> Cholesky factorisation of a band matrix, in place.
  pure subroutine decompose(n, band, a)
    integer, intent(in) :: n, band
    real(dp), intent(inout) :: a(0:band, n)
    real(dp) :: factor
    integer :: l, i, k, last
    do l = 1, n
      last = min(band, n - l)
      a(0, l) = sqrt(a(0, l))
      a(1:last, l) = a(1:last, l)*(1/a(0, l))
      do i = 1, last
        factor = a(i, l)
        if (.not. abs(factor) > 0) cycle
        !$omp simd
        do k = 0, last - i
          a(k, l + i) = a(k, l + i) - factor*a(i + k, l)
        end do
      end do
    end do
  end subroutine decompose

  !> Solve a system with such a factor.
  pure subroutine substitute(n, band, a, x)
    integer, intent(in) :: n, band
    real(dp), intent(in) :: a(0:band, n)
    real(dp), intent(inout) :: x(n)
    integer :: l, last
    do l = 1, n
      last = min(band, n - l)
      x(l) = x(l)/a(0, l)
      x(l + 1:l + last) = x(l + 1:l + last) - x(l)*a(1:last, l)
    end do
    do l = n, 1, -1
      last = min(band, n - l)
      x(l) = (x(l) - dot_product(a(1:last, l), x(l + 1:l + last)))/a(0, l)
    end do
  end subroutine substitute

  !> Product of the symmetric band matrix with x.
  pure subroutine multiply(n, band, a, x, y)
    integer, intent(in) :: n, band
    real(dp), intent(in) :: a(0:band, n), x(n)
    real(dp), intent(out) :: y(n)
    integer :: l, i
    y = a(0, :)*x
    do l = 1, n
      do i = 1, min(band, n - l)
        if (.not. abs(a(i, l)) > 0) cycle
        y(l + i) = y(l + i) + a(i, l)*x(l)
        y(l) = y(l) + a(i, l)*x(l + i)
      end do
    end do
  end subroutine multiply

  !> Force, side flow and largest pressure of the last solution.
  pure subroutine sum_up(self, cavitation, alpha, answer)
    class(film_solver_t), intent(in) :: self
    integer, intent(in) :: cavitation
    real(dp), intent(in) :: alpha
    type(film_answer_t), intent(out) :: answer
    real(dp) :: line(self%grid%n), out
    integer :: i, j

    associate (g => self%grid)
      do j = 1, g%m
        do i = 1, g%n
          line(i) = self%pressure((g%place(i) - 1)*g%m + j)
        end do
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
    end associate
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
    integer :: i
    angle = self%grid%angle
    zeta = self%grid%zeta
    allocate (pressure(self%grid%n, self%grid%m))
    do i = 1, self%grid%n
      pressure(i, :) = self%pressure((self%grid%place(i) - 1)*self%grid%m + 1:self%grid%place(i)*self%grid%m)
    end do
    pressure = max(pressure, 0.0_dp)
  end subroutine pressure_at
end module finite_film
