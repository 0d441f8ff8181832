!> The equations of a film on parts of its nodes, and the film with free edges, against their balances of flow: what flows out of a
!> cell through its four faces is its source.
module test_film_equations
  use kinds, only: dp
  use constants, only: pi
  use checks, only: checks_t
  use film_equations, only: film_equations_t
  use finite_film, only: film_solver_t, film_answer_t, cavitation_reynolds
  use reynolds_grid, only: reynolds_grid_t, new_reynolds_grid
  implicit none
  private
  public :: run_test_film_equations

contains

  subroutine run_test_film_equations(check)
    class(checks_t), intent(inout) :: check
    call flows_balance_at_active_nodes(check)
    call edges_are_free(check)
  end subroutine run_test_film_equations

  !> Parts of a grid: whole, without one node, without a whole line, two arcs, one with ragged edges, islands of single nodes, and
  !> at random with many and with few nodes.
  subroutine flows_balance_at_active_nodes(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: n = 24, m = 7
    type(film_equations_t) :: equations
    type(reynolds_grid_t) :: grid
    logical :: active(m, n)
    real(dp) :: source(n), pressure(m, n), worst
    integer :: i, j, k
    grid = new_reynolds_grid(n, m, 0.02_dp, 0.6_dp, 0.3_dp)
    call equations%begin(grid)
    source = [(sin(1.7_dp*i), i=1, n)]
    do k = 1, 40
      active = .true.
      if (k == 2) active(3, 5) = .false.
      if (k == 3) active(:, 9) = .false.
      if (k == 4) active(:, [1, 2, 12, 13, 14]) = .false.
      if (k == 5) active = reshape([((abs(i - 12) + mod(3*j, 4) < 9, j=1, m), i=1, n)], [m, n])
      if (k == 6) active = reshape([((mod(i + 3*j, 5) == 0, j=1, m), i=1, n)], [m, n])
      if (k > 6) active = reshape([((modulo(37.7_dp*sin(1.0_dp*(k + 11*i*j + i)), 1.0_dp) < 0.025_dp*k, j=1, m), i=1, n)], [m, n])
      call equations%solve(source, active, pressure)
      worst = 0
      do i = 1, n
        do j = 1, m
          if (active(j, i)) worst = max(worst, abs(outflow(grid, pressure, j, i)/(source(i)*grid%width(j)) - 1))
        end do
      end do
      call check%that(worst <= 1e-9_dp, 'the flow out of each active cell is its source')
      call check%that(all(active .or. .not. abs(pressure) > 0), 'the pressure is 0 at the other nodes')
    end do
  end subroutine flows_balance_at_active_nodes

  !> What flows out of a cell.
  pure real(dp) function outflow(grid, p, j, i)
    type(reynolds_grid_t), intent(in) :: grid
    real(dp), intent(in) :: p(:, :)
    integer, intent(in) :: j, i
    integer :: before, after
    before = modulo(i - 2, grid%n) + 1
    after = modulo(i, grid%n) + 1
    outflow = grid%width(j)*(grid%around(before)*(p(j, i) - p(j, before)) + grid%around(i)*(p(j, i) - p(j, after)))
    if (j == grid%m) outflow = outflow + grid%height_cubed(i)*grid%along(j)*p(j, i)
    if (j < grid%m) outflow = outflow + grid%height_cubed(i)*grid%along(j)*(p(j, i) - p(j + 1, i))
    if (j == 1) return
    outflow = outflow + grid%height_cubed(i)*grid%along(j - 1)*(p(j, i) - p(j - 1, i))
  end function outflow

  !> Reynolds' condition at every node: P >= 0, the flow out of the cell is not less than its source, and it equals the source where
  !> P > 0. The film found from the edge on a coarser grid is the same.
  subroutine edges_are_free(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: lengths(3) = [0.2_dp, 0.75_dp, 8.0_dp], gaps(4) = [0.95_dp, 0.5_dp, 0.05_dp, 5e-4_dp]
    type(film_solver_t) :: fine, coarse
    type(film_answer_t) :: answer, again
    integer :: i, j, k
    do i = 1, size(lengths)
      do j = 1, size(gaps)
        call fine%begin(64, 8, gaps(j), lengths(i))
        call coarse%begin(32, 4, gaps(j), lengths(i))
        do k = 0, 6
          call coarse%solve(k*pi/6, cavitation_reynolds, .false., answer)
          call fine%solve(k*pi/6, cavitation_reynolds, .false., answer)
          call compare(new_reynolds_grid(64, 8, gaps(j), lengths(i), 0.0_dp), k*pi/6)
          call fine%solve(k*pi/6, cavitation_reynolds, .true., again, coarse)
          call check%that(norm2(again%force - answer%force) <= 1e-12_dp*norm2(answer%force), &
            'the same film from the edge on a coarser grid')
        end do
      end do
    end do

  contains

    subroutine compare(grid, alpha)
      type(reynolds_grid_t), intent(in) :: grid
      real(dp), intent(in) :: alpha
      real(dp), allocatable :: angle(:), zeta(:), p(:, :)
      real(dp) :: excess(grid%m, grid%n), largest
      integer :: i, j
      call fine%pressure_at(angle, zeta, p)
      p = transpose(p)
      do i = 1, grid%n
        do j = 1, grid%m
          excess(j, i) = outflow(grid, p, j, i)/grid%width(j) - 12*(cos(alpha)*grid%sine(i) + sin(alpha)*grid%cosine(i))
        end do
      end do
      largest = 12*maxval(abs(cos(alpha)*grid%sine + sin(alpha)*grid%cosine))
      call check%that(minval(p) >= 0 .and. minval(excess) >= -1e-9_dp*largest, 'pressure and flow of a film with free edges')
      call check%that(all(.not. p > 0 .or. abs(excess) <= 1e-9_dp*largest), 'the flow out of each cell of a film is its source')
    end subroutine compare
  end subroutine edges_are_free
end module test_film_equations
