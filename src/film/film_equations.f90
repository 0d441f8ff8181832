!> The equations of finite volumes of a film (`reynolds_grid`) for a pressure that is 0 outside a set of active nodes.
!>
!> In axial direction the equations of all lines of nodes are the same but for a factor, the integral of H^3. In neighbouring
!> lines whose nodes are all active, the pressure is therefore a sum of modes V, with K V = W V diag(rate) and V^T W V = 1 (K:
!> conductances along a line, W: widths of its cells), and each mode has a tridiagonal system of its own around the film. These
!> lines are eliminated. A small system remains, for the active nodes of the other lines, which are at the edges of the film.
module film_equations
  use kinds, only: dp
  use reynolds_grid, only: reynolds_grid_t
  implicit none
  private
  public :: film_equations_t

  !> A grid and its axial modes.
  type :: film_equations_t
    type(reynolds_grid_t) :: grid
    real(dp), allocatable, private :: mode(:, :)      !! V: (node of the line, mode)
    real(dp), allocatable, private :: weighed(:, :)   !! W V, transposed: (mode, node of the line)
    real(dp), allocatable, private :: rate(:)
  contains
    procedure :: begin
    procedure :: solve
  end type film_equations_t

  !> The equations of the active nodes that are not eliminated: a symmetric, positive definite system. Each row of its matrix is
  !> stored from the first element that may differ from 0 to the diagonal.
  type :: system_t
    integer, allocatable :: number(:, :)     !! of the unknown of each node; 0: none
    integer, allocatable :: first(:)         !! first column of each row
    integer, allocatable :: start(:)         !! column k of row i is element(start(i) + k)
    real(dp), allocatable :: element(:)
    real(dp), allocatable :: side(:)         !! right-hand side, later the solution
  end type system_t

  !> Consecutive lines that are eliminated, with the lines before and after them, and the amplitudes of the modes (mode, line):
  !> those of the source, and those of a unit amplitude in the line before, and in the line after.
  type :: whole_lines_t
    integer, allocatable :: line(:)
    real(dp), allocatable, dimension(:, :) :: of_source, of_before, of_after
  end type whole_lines_t

contains

  !> Find the modes of a grid.
  pure subroutine begin(self, grid)
    class(film_equations_t), intent(inout) :: self
    type(reynolds_grid_t), intent(in) :: grid
    real(dp) :: scaled(grid%m, grid%m), vectors(grid%m, grid%m), root(grid%m)
    integer :: j
    self%grid = grid
    root = sqrt(grid%width(:grid%m))
    scaled = 0
    do j = 1, grid%m
      scaled(j, j) = axial_sum(grid, j)/root(j)**2
      if (j == grid%m) exit
      scaled(j, j + 1) = -grid%along(j)/(root(j)*root(j + 1))
      scaled(j + 1, j) = scaled(j, j + 1)
    end do
    call diagonalise(scaled, vectors)
    self%rate = [(scaled(j, j), j=1, grid%m)]
    self%mode = vectors/spread(root, 2, grid%m)
    self%weighed = transpose(vectors*spread(root, 2, grid%m))
  end subroutine begin

  !> Sum of the conductances of a node in axial direction, per integral of H^3.
  pure real(dp) function axial_sum(grid, j)
    type(reynolds_grid_t), intent(in) :: grid
    integer, intent(in) :: j
    axial_sum = grid%along(j)
    if (j > 1) axial_sum = axial_sum + grid%along(j - 1)
  end function axial_sum

  !> Diagonalise a symmetric, positive definite matrix by Jacobi's rotations, which find small eigenvalues as exactly as large ones.
  !> Its eigenvectors are the columns of `vectors`.
  pure subroutine diagonalise(a, vectors)
    real(dp), intent(inout) :: a(:, :)
    real(dp), intent(out) :: vectors(:, :)
    integer, parameter :: most_sweeps = 50
    real(dp) :: t, c, s
    integer :: i, j, sweep
    logical :: turned
    vectors = 0
    do i = 1, size(a, 1)
      vectors(i, i) = 1
    end do
    do sweep = 1, most_sweeps
      turned = .false.
      do j = 2, size(a, 1)
        do i = 1, j - 1
          if (abs(a(i, j)) <= epsilon(t)*sqrt(a(i, i)*a(j, j))) cycle
          turned = .true.
          t = (a(j, j) - a(i, i))/(2*a(i, j))
          t = sign(1.0_dp, t)/(abs(t) + sqrt(1 + t**2))
          c = 1/sqrt(1 + t**2)
          s = c*t
          call rotate(a(:, i), a(:, j))
          call rotate(a(i, :), a(j, :))
          call rotate(vectors(:, i), vectors(:, j))
        end do
      end do
      if (.not. turned) exit
    end do

  contains

    pure subroutine rotate(x, y)
      real(dp), intent(inout) :: x(:), y(:)
      real(dp) :: old(size(x))
      old = x
      x = c*old - s*y
      y = s*old + c*y
    end subroutine rotate
  end subroutine diagonalise

  !> The pressure P (m, n) with -div(H^3 grad P) = source at the active nodes and 0 elsewhere.
  pure subroutine solve(self, source, active, pressure)
    class(film_equations_t), intent(in) :: self
    real(dp), intent(in) :: source(:)        !! (n), per axial width of the cells
    logical, intent(in) :: active(:, :)      !! (m, n)
    real(dp), intent(out) :: pressure(:, :)
    type(system_t) :: system
    type(whole_lines_t), allocatable :: parts(:)
    integer :: i, j
    call divide(active, system, parts)
    call connect_nodes(self%grid, source, system)
    do i = 1, size(parts)
      call eliminate(self, source, parts(i))
      call connect_ends(self, parts(i), system)
    end do
    call solve_system(system)
    pressure = 0
    do i = 1, self%grid%n
      do j = 1, self%grid%m
        if (system%number(j, i) > 0) pressure(j, i) = system%side(system%number(j, i))
      end do
    end do
    do i = 1, size(parts)
      call add_modes(self, parts(i), pressure)
    end do
  end subroutine solve

  !> Divide the lines into those that are eliminated and the others, and prepare the system of these. It begins with a line that is
  !> not eliminated, if possible one without active nodes. Lines are connected to the ones before and after them, unless one without
  !> active nodes is between them.
  pure subroutine divide(active, system, parts)
    logical, intent(in) :: active(:, :)
    type(system_t), intent(out) :: system
    type(whole_lines_t), allocatable, intent(out) :: parts(:)
    integer :: nodes(size(active, 2)), line(0:size(active, 2))
    logical :: is_whole(0:size(active, 2))
    integer :: m, n, first, latest, unknowns, i, j, k

    m = size(active, 1)
    n = size(active, 2)
    nodes = count(active, 1)
    k = minloc(nodes, 1)
    line = [(modulo(k + i - 1, n) + 1, i=0, n)]
    is_whole = nodes(line) == m
    is_whole([0, n]) = .false.
    allocate (system%number(m, n), source=0)
    unknowns = sum(nodes) - m*count(is_whole)
    allocate (system%first(unknowns), system%start(unknowns), system%side(unknowns))
    unknowns = 0
    first = 1
    latest = 1
    do k = 0, n - 1
      if (nodes(line(k)) == 0) first = unknowns + 1
      if (nodes(line(k)) == 0 .or. is_whole(k)) cycle
      latest = unknowns + 1
      do j = 1, m
        if (.not. active(j, line(k))) cycle
        unknowns = unknowns + 1
        system%number(j, line(k)) = unknowns
        system%first(unknowns) = first
      end do
      first = latest
    end do
    if (nodes(line(0)) > 0) system%first(latest:) = 1   ! the last line is connected to the first one
    k = 0
    do i = 1, unknowns
      system%start(i) = k - system%first(i) + 1
      k = system%start(i) + i
    end do
    allocate (system%element(k), source=0.0_dp)

    allocate (parts(count(is_whole(1:) .and. .not. is_whole(:n - 1))))
    k = 0
    do i = 1, size(parts)
      first = k + findloc(is_whole(k:), .true., 1) - 1
      k = first + findloc(is_whole(first:), .false., 1) - 1
      parts(i)%line = line(first - 1:k)
    end do
  end subroutine divide

  !> Conductances between the unknowns, and their sources.
  pure subroutine connect_nodes(grid, source, system)
    type(reynolds_grid_t), intent(in) :: grid
    real(dp), intent(in) :: source(:)
    type(system_t), intent(inout) :: system
    integer :: i, j, before, after
    do i = 1, grid%n
      before = modulo(i - 2, grid%n) + 1
      after = modulo(i, grid%n) + 1
      do j = 1, grid%m
        associate (k => system%number(j, i))
          if (k == 0) cycle
          call add(system, k, k, (grid%around(before) + grid%around(i))*grid%width(j) + grid%height_cubed(i)*axial_sum(grid, j))
          if (j < grid%m) call add(system, k, system%number(j + 1, i), -grid%height_cubed(i)*grid%along(j))
          call add(system, k, system%number(j, after), -grid%around(i)*grid%width(j))
          system%side(k) = source(i)*grid%width(j)
        end associate
      end do
    end do
  end subroutine connect_nodes

  !> Add to the element in a row and a column, or to its equal on the other side of the diagonal; without effect for the number 0.
  pure subroutine add(system, i, k, value)
    type(system_t), intent(inout) :: system
    integer, intent(in) :: i, k
    real(dp), intent(in) :: value
    if (i == 0 .or. k == 0) return
    associate (element => system%element(system%start(max(i, k)) + min(i, k)))
      element = element + value
    end associate
  end subroutine add

  !> Solve the tridiagonal systems of the modes, of all modes at once.
  pure subroutine eliminate(self, source, part)
    type(film_equations_t), intent(in) :: self
    real(dp), intent(in) :: source(:)
    type(whole_lines_t), intent(inout) :: part
    real(dp) :: ratio(self%grid%m, size(part%line))   ! of the amplitude in a line to that in the next one
    real(dp) :: lost(self%grid%m)                     ! 1 - ratio of the line before
    real(dp) :: rest, pivot, total(self%grid%m)
    integer :: j, k
    associate (m => self%grid%m, last => size(part%line) - 1)
      allocate (part%of_source(m, last + 1), source=0.0_dp)
      allocate (part%of_before(m, last + 1), part%of_after(m, last + 1), source=part%of_source)
      part%of_before(:, 1) = 1
      part%of_after(:, last + 1) = 1
      total = sum(self%weighed, 2)
      lost = 1
      do k = 2, last
        associate (before => self%grid%around(part%line(k - 1)), after => self%grid%around(part%line(k)), &
                   cubed => self%grid%height_cubed(part%line(k)), flow => source(part%line(k)))
          !$omp simd private(rest, pivot)
          do j = 1, m
            rest = before*lost(j) + cubed*self%rate(j)
            pivot = 1/(rest + after)
            lost(j) = rest*pivot
            ratio(j, k) = after*pivot
            part%of_source(j, k) = (flow*total(j) + before*part%of_source(j, k - 1))*pivot
            part%of_before(j, k) = before*part%of_before(j, k - 1)*pivot
          end do
        end associate
      end do
      do k = last, 2, -1
        !$omp simd
        do j = 1, m
          part%of_source(j, k) = part%of_source(j, k) + ratio(j, k)*part%of_source(j, k + 1)
          part%of_before(j, k) = part%of_before(j, k) + ratio(j, k)*part%of_before(j, k + 1)
          part%of_after(j, k) = ratio(j, k)*part%of_after(j, k + 1)
        end do
      end do
    end associate
  end subroutine eliminate

  !> Add to the equations of the lines before and after eliminated lines what flows from and to these.
  pure subroutine connect_ends(self, part, system)
    type(film_equations_t), intent(in) :: self
    type(whole_lines_t), intent(in) :: part
    type(system_t), intent(inout) :: system
    associate (last => size(part%line) - 1, before => part%line(1), after => part%line(size(part%line)))
      associate (from_before => self%grid%around(before), to_after => self%grid%around(part%line(last)))
        call connect_lines(self, before, before, from_before*part%of_before(:, 2), system)
        call connect_lines(self, after, after, to_after*part%of_after(:, last), system)
        call connect_lines(self, after, before, merge(2.0_dp, 1.0_dp, after == before)*from_before*part%of_after(:, 2), system)
        call add_source(self, before, from_before*part%of_source(:, 2), system)
        call add_source(self, after, to_after*part%of_source(:, last), system)
      end associate
    end associate
  end subroutine connect_ends

  !> Conductances between the nodes of two lines, or of one, by conductances of the modes.
  pure subroutine connect_lines(self, line, other, conductance, system)
    type(film_equations_t), intent(in) :: self
    integer, intent(in) :: line, other
    real(dp), intent(in) :: conductance(:)
    type(system_t), intent(inout) :: system
    real(dp) :: flow(self%grid%m)
    integer :: j, k
    do j = 1, self%grid%m
      if (system%number(j, line) == 0) cycle
      flow = conductance*self%weighed(:, j)
      do k = 1, merge(j, self%grid%m, line == other)
        if (system%number(k, other) > 0) &
          call add(system, system%number(j, line), system%number(k, other), -product_of(flow, self%weighed(:, k)))
      end do
    end do
  end subroutine connect_lines

  !> Sources of the nodes of a line, by those of the modes.
  pure subroutine add_source(self, line, source, system)
    type(film_equations_t), intent(in) :: self
    integer, intent(in) :: line
    real(dp), intent(in) :: source(:)
    type(system_t), intent(inout) :: system
    integer :: j
    do j = 1, self%grid%m
      associate (k => system%number(j, line))
        if (k > 0) system%side(k) = system%side(k) + product_of(source, self%weighed(:, j))
      end associate
    end do
  end subroutine add_source

  !> Solve the system by Cholesky's method.
  pure subroutine solve_system(system)
    type(system_t), intent(inout) :: system
    integer :: i, k, begins
    associate (a => system%element, x => system%side)
      do i = 1, size(x)
        associate (first => system%first(i), row => system%start(i))
          do k = first, i - 1
            begins = max(first, system%first(k))
            associate (other => system%start(k))
              a(row + k) = (a(row + k) - product_of(a(row + begins:row + k - 1), a(other + begins:other + k - 1)))/a(other + k)
            end associate
          end do
          a(row + i) = sqrt(a(row + i) - product_of(a(row + first:row + i - 1), a(row + first:row + i - 1)))
          x(i) = (x(i) - product_of(a(row + first:row + i - 1), x(first:i - 1)))/a(row + i)
        end associate
      end do
      do i = size(x), 1, -1
        associate (first => system%first(i), row => system%start(i))
          x(i) = x(i)/a(row + i)
          x(first:i - 1) = x(first:i - 1) - x(i)*a(row + first:row + i - 1)
        end associate
      end do
    end associate
  end subroutine solve_system

  !> The pressure of eliminated lines, from that in the lines before and after them.
  pure subroutine add_modes(self, part, pressure)
    type(film_equations_t), intent(in) :: self
    type(whole_lines_t), intent(in) :: part
    real(dp), intent(inout) :: pressure(:, :)
    real(dp), dimension(self%grid%m) :: before, after, amplitude
    integer :: i, j, k
    before = matmul(self%weighed, pressure(:, part%line(1)))
    after = matmul(self%weighed, pressure(:, part%line(size(part%line))))
    do k = 2, size(part%line) - 1
      amplitude = part%of_source(:, k) + part%of_before(:, k)*before + part%of_after(:, k)*after
      do i = 1, self%grid%m
        !$omp simd
        do j = 1, self%grid%m
          pressure(j, part%line(k)) = pressure(j, part%line(k)) + self%mode(j, i)*amplitude(i)
        end do
      end do
    end do
  end subroutine add_modes

  !> Sum of products, in an order that is written down and not left to the compiler: all builds of the program make the same table.
  pure real(dp) function product_of(x, y) result(total)
    real(dp), intent(in) :: x(:), y(:)
    real(dp) :: a, b, c, d
    integer :: i, whole
    a = 0
    b = 0
    c = 0
    d = 0
    whole = size(x) - mod(size(x), 4)
    do i = 1, whole, 4
      a = a + x(i)*y(i)
      b = b + x(i + 1)*y(i + 1)
      c = c + x(i + 2)*y(i + 2)
      d = d + x(i + 3)*y(i + 3)
    end do
    do i = whole + 1, size(x)
      a = a + x(i)*y(i)
    end do
    total = (a + b) + (c + d)
  end function product_of
end module film_equations
