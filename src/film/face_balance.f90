!> Balance of the flows in the film of one face, on a grid of n cells across half of it and m intervals along it: pressures of the
!> nodes by Reynolds' condition (no suction; a ruptured node into which oil flows is full again) or with suction left to cut off,
!> and what further sources do to them.
module face_balance
  use kinds, only: dp
  implicit none
  private
  public :: guess_full, balance, respond
  public :: pair_conductances, pair_nodes, refine, change_full, assemble, solve_symmetric, substitute, least_inflow, most_rounds

  real(dp), parameter :: least_inflow = 1e-13_dp  !! over the largest source, with which a ruptured node fills again
  integer, parameter :: sweeps = 3                !! of Gauss and Seidel over the guess of that part
  integer, parameter :: most_rounds = 60          !! of the search for the part that is full

contains

  !> Nodes that are probably full: from the pressures of a grid of half as many cells and intervals, with the same flows, after some
  !> sweeps over the nodes. All of them if that grid cannot be made.
  pure subroutine guess_full(n, m, along, round, source, full)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1)
    logical, intent(inout) :: full(n, m - 1)
    real(dp) :: along_pair(n/2, m/2), round_pair(0:n/2, m/2 - 1), source_pair(n/2, m/2 - 1), p(0:n/2 + 1, 0:m/2)
    logical :: full_pair(n/2, m/2 - 1)
    if (mod(n, 2) + mod(m, 2) > 0) return
    call pair_conductances(n, m, along, round, along_pair, round_pair)
    call pair_nodes(n, m, source, source_pair)
    full_pair = .true.
    call balance(n/2, m/2, along_pair, round_pair, source_pair, .false., full_pair, p)
    call refine(n, m, along, round, source, p, full)
  end subroutine guess_full

  !> The nodes that are full after some sweeps over them, from the pressures of the grid of half as many cells and intervals.
  pure subroutine refine(n, m, along, round, source, p, full)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1), p(0:n/2 + 1, 0:m/2)
    logical, intent(out) :: full(n, m - 1)
    real(dp) :: guess(0:n + 1, 0:m)
    integer :: i, j, pass
    guess = 0
    do j = 1, m/2
      do i = 1, n/2
        guess(2*i - 1:2*i, 2*j - 1) = 0.5_dp*(p(i, j - 1) + p(i, j))
        guess(2*i - 1:2*i, 2*j) = p(i, j)
      end do
    end do
    do pass = 1, sweeps
      do j = 1, m - 1
        do i = 1, n
          guess(i, j) = max(0.0_dp, (source(i, j) + along(i, j)*guess(i, j - 1) + along(i, j + 1)*guess(i, j + 1) + &
            round(i - 1, j)*guess(i - 1, j) + round(i, j)*guess(i + 1, j))/ &
            (along(i, j) + along(i, j + 1) + round(i - 1, j) + round(i, j)))
        end do
      end do
    end do
    full = guess(1:n, 1:m - 1) > 0
  end subroutine refine

  !> Conductances of the grid of half as many cells and intervals.
  pure subroutine pair_conductances(n, m, along, round, along_pair, round_pair)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1)
    real(dp), intent(out) :: along_pair(n/2, m/2), round_pair(0:n/2, m/2 - 1)
    integer :: i, j
    do j = 1, m/2
      do i = 1, n/2   ! two flows side by side, each through two conductances one after the other
        along_pair(i, j) = sum(along(2*i - 1:2*i, 2*j - 1)*along(2*i - 1:2*i, 2*j)/ &
          (along(2*i - 1:2*i, 2*j - 1) + along(2*i - 1:2*i, 2*j)))
      end do
    end do
    do j = 1, m/2 - 1
      round_pair(:, j) = 0.5_dp*(round(::2, 2*j) + 0.5_dp*(round(::2, 2*j - 1) + round(::2, 2*j + 1)))
    end do
  end subroutine pair_conductances

  !> Sums over the nodes of that grid of what the nodes have.
  pure subroutine pair_nodes(n, m, have, pair)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: have(n, m - 1)
    real(dp), intent(out) :: pair(n/2, m/2 - 1)
    integer :: i, j
    do j = 1, m/2 - 1
      do i = 1, n/2
        pair(i, j) = sum(have(2*i - 1:2*i, 2*j) + 0.5_dp*(have(2*i - 1:2*i, 2*j - 1) + have(2*i - 1:2*i, 2*j + 1)))
      end do
    end do
  end subroutine pair_nodes

  !> Pressures of the nodes for which the flows balance, by one of both conditions; for Reynolds' from a guess of the nodes that are
  !> full. Where suction is cut off all must be full, and it is left to cut.
  pure subroutine balance(n, m, along, round, source, cuts_suction, full, p)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1)
    logical, intent(in) :: cuts_suction
    logical, intent(inout) :: full(n, m - 1)
    real(dp), intent(out) :: p(0:n + 1, 0:m)
    real(dp) :: a(0:n + 1, n*m + 2), x(n*m + 2)
    integer :: number(n, m)   ! of a full node among them
    logical :: changes
    integer :: i, j, k, pass
    p = 0
    do pass = 1, most_rounds
      call assemble(n, m, along, round, full, k, number, a)
      x(:k + n + 2) = 0
      do j = 1, m - 1
        do i = 1, n
          if (full(i, j)) x(number(i, j)) = source(i, j)
        end do
      end do
      call solve_symmetric(k, n, a, x)
      do j = 1, m - 1
        do i = 1, n
          p(i, j) = 0
          if (full(i, j)) p(i, j) = x(number(i, j))
        end do
      end do
      if (cuts_suction) exit
      call change_full(n, m, along, round, source, p, least_inflow*maxval(abs(source)), 0.0_dp, .false., full, changes)
      if (.not. changes) exit
    end do
  end subroutine balance

  !> Find which nodes are full, from the pressures for which those balance that were.
  pure subroutine change_full(n, m, along, round, source, p, least, lowest, one_by_one, full, changes)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1), p(0:n + 1, 0:m)
    real(dp), intent(in) :: least    !! inflow with which a ruptured node fills again
    real(dp), intent(in) :: lowest   !! pressure of a full node [Pa]
    logical, intent(in) :: one_by_one   !! change the first of them alone
    logical, intent(inout) :: full(n, m - 1)
    logical, intent(out) :: changes
    real(dp) :: inflow
    logical :: is_full
    integer :: i, j
    changes = .false.
    do j = 1, m - 1
      do i = 1, n
        if (full(i, j)) then
          is_full = .not. p(i, j) < lowest
        else
          inflow = source(i, j) + along(i, j)*p(i, j - 1) + along(i, j + 1)*p(i, j + 1) + round(i - 1, j)*p(i - 1, j) + &
            round(i, j)*p(i + 1, j)
          is_full = inflow > least
        end if
        if (is_full .neqv. full(i, j)) changes = .true.
        full(i, j) = is_full
        if (changes .and. one_by_one) return
      end do
    end do
  end subroutine change_full

  !> The symmetric matrix of the balances of the full nodes, in the form of `solve_symmetric`.
  pure subroutine assemble(n, m, along, round, full, k, number, a)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1)
    logical, intent(in) :: full(n, m - 1)
    integer, intent(out) :: k              !! number of full nodes
    integer, intent(out) :: number(n, m)   !! of each of them; of others not set
    real(dp), intent(out) :: a(0:n + 1, n*m + 2)
    integer :: i, j
    k = 0
    do j = 1, m - 1
      do i = 1, n
        if (.not. full(i, j)) cycle
        k = k + 1
        number(i, j) = k
      end do
    end do
    a(:, :k + n + 2) = 0
    a(0, k + 1:k + n + 2) = 1
    do j = 1, m - 1
      do i = 1, n
        if (.not. full(i, j)) cycle
        associate (l => number(i, j))
          a(0, l) = along(i, j) + along(i, j + 1) + round(i - 1, j) + round(i, j)
          if (i < n) then
            if (full(i + 1, j)) a(1, l) = -round(i, j)
          end if
          if (j == m - 1) cycle
          if (full(i, j + 1)) a(number(i, j + 1) - l, l) = -along(i, j + 1)
        end associate
      end do
    end do
  end subroutine assemble

  !> Pressures that each of several sources has in the part that is full.
  pure subroutine respond(n, m, along, round, full, sources, p)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1)
    logical, intent(in) :: full(n, m - 1)
    real(dp), intent(in) :: sources(:, :, :)   !! (number, cell, node)
    real(dp), intent(out) :: p(:, :, :)        !! the same
    real(dp) :: a(0:n + 1, n*m + 2), unused(n*m + 2), x(size(sources, 1), n*m + 2)
    integer :: number(n, m)
    integer :: i, j, last
    call assemble(n, m, along, round, full, last, number, a)
    unused(:last + n + 2) = 0
    call solve_symmetric(last, n, a, unused)
    x(:, :last + n + 2) = 0
    do j = 1, m - 1
      do i = 1, n
        if (full(i, j)) x(:, number(i, j)) = sources(:, i, j)
      end do
    end do
    call substitute(size(x, 1), last, n, a, x)
    p = 0
    do j = 1, m - 1
      do i = 1, n
        if (full(i, j)) p(:, i, j) = x(:, number(i, j))
      end do
    end do
  end subroutine respond

  !> Solve the system for further right sides, with the matrix that `solve_symmetric` leaves.
  pure subroutine substitute(n_sides, n, band, a, x)
    integer, intent(in) :: n_sides, n, band
    real(dp), intent(in) :: a(0:band + 1, n + band + 2)
    real(dp), intent(inout) :: x(n_sides, n + band + 2)
    integer :: i, k
    do k = 1, n
      do i = 1, band
        x(:, k + i) = x(:, k + i) - a(i, k)*x(:, k)
      end do
    end do
    do k = n, 1, -1
      x(:, k) = x(:, k)/a(0, k)
      do i = 1, band
        x(:, k) = x(:, k) - a(i, k)*x(:, k + i)
      end do
    end do
  end subroutine substitute

  !> Solve a symmetric positive definite system of n equations, whose diagonals are 0 or more above the main one: a(i, k) is the
  !> element of row k + i and column k. Two columns are eliminated in each pass. Beyond the last equation a must be 0, but for
  !> ones on the main diagonal; beyond the last diagonal too.
  pure subroutine solve_symmetric(n, band, a, x)
    integer, intent(in) :: n, band
    real(dp), intent(inout) :: a(0:band + 1, n + band + 2), x(n + band + 2)
    real(dp) :: pivot(2), first, second
    integer :: i, k, l
    do k = 1, n, 2
      pivot(1) = 1/a(0, k)
      first = a(1, k)*pivot(1)
      a(0:band, k + 1) = a(0:band, k + 1) - first*a(1:band + 1, k)
      a(1, k) = first
      x(k + 1) = x(k + 1) - first*x(k)
      pivot(2) = 1/a(0, k + 1)
      do i = 2, band + 1
        first = a(i, k)*pivot(1)
        second = a(i - 1, k + 1)*pivot(2)
        if (.not. (abs(first) > 0 .or. abs(second) > 0)) cycle
        do l = i, band + 1
          a(l - i, k + i) = a(l - i, k + i) - first*a(l, k) - second*a(l - 1, k + 1)
        end do
        x(k + i) = x(k + i) - first*x(k) - second*x(k + 1)
        a(i, k) = first
        a(i - 1, k + 1) = second
      end do
      x(k:k + 1) = x(k:k + 1)*pivot
    end do
    do k = n, 1, -1
      do i = 1, band
        x(k) = x(k) - a(i, k)*x(k + i)
      end do
    end do
  end subroutine solve_symmetric
end module face_balance
