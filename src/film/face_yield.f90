!> Balance of the flows in the film of a face on two springs, which gives way: that takes oil in, and the rates of the springs
!> follow with the pressures that load them.
module face_yield
  use kinds, only: dp
  use face_balance, only: pair_conductances, pair_nodes, refine, change_full, assemble, solve_symmetric, substitute, least_inflow, &
    most_rounds
  implicit none
  private
  public :: guess_yielding, balance_yielding

  real(dp), parameter :: lowest_suction = 1e-14_dp   !! of a full node, over the largest pressure before the rates take it away
  real(dp), parameter :: most_missed = 1e-9_dp    !! by the springs, over what loads them: far above rounding, below any tolerance
  integer, parameter :: most_single = 300         !! further rounds of the search for the part that is full, in which one node
                                                  !! changes: it hardly ever runs in circles then; 170 were seen
  integer, parameter :: most_repeats = 10         !! of the search for the rates; 3 were seen
  integer, parameter :: most_plain = 10           !! steps of Newton's method
  integer, parameter :: most_turns = 20           !! of the path to the balance, over the number of nodes; 3 were seen

contains

  !> `guess_full` of a face that gives way, see `balance_yielding`.
  pure subroutine guess_yielding(n, m, along, round, source, by_rate, weight, load, drag, full)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1)
    real(dp), intent(in) :: by_rate(n, m - 1, 2), weight(n, m - 1, 2), load(2), drag
    logical, intent(inout) :: full(n, m - 1)
    real(dp) :: along_pair(n/2, m/2), round_pair(0:n/2, m/2 - 1), source_pair(n/2, m/2 - 1), p(0:n/2 + 1, 0:m/2), rate(2)
    real(dp), dimension(n/2, m/2 - 1, 2) :: by_rate_pair, weight_pair
    logical :: full_pair(n/2, m/2 - 1), found
    integer :: k
    if (mod(n, 2) + mod(m, 2) > 0) return
    call pair_conductances(n, m, along, round, along_pair, round_pair)
    call pair_nodes(n, m, source, source_pair)
    do k = 1, 2
      call pair_nodes(n, m, by_rate(:, :, k), by_rate_pair(:, :, k))
      call pair_nodes(n, m, weight(:, :, k), weight_pair(:, :, k))
    end do
    full_pair = .true.
    call balance_yielding(n/2, m/2, along_pair, round_pair, source_pair, by_rate_pair, weight_pair, load, drag, .false., &
      full_pair, rate, p, found)
    call refine(n, m, along, round, source + rate(1)*by_rate(:, :, 1) + rate(2)*by_rate(:, :, 2), p, full)
  end subroutine guess_yielding

  !> `balance` of a face that gives way on two springs, with the rates v of these: the sources are those of a face at rest and v
  !> times those of the rates, and each spring, whose own force is in its load, resists with a drag,
  !>
  !>     drag v_k = load_k + sum of weight_k p
  !>
  !> Pressures are linear in v while the part that is full stays, or that which is cut off. Where they are rounding of much larger
  !> pressures that v takes away, the springs miss their balance: v is then found once more, from the sources at these rates.
  !> `found`: the springs balance, and all nodes meet their condition.
  pure subroutine balance_yielding(n, m, along, round, source, by_rate, weight, load, drag, cuts_suction, full, rate, p, found)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1)
    real(dp), intent(in) :: by_rate(n, m - 1, 2)   !! sources over the rate of each spring [m^2]
    real(dp), intent(in) :: weight(n, m - 1, 2)    !! load of each spring over the pressure [m^2]
    real(dp), intent(in) :: load(2)                !! of each spring without the pressures [N]
    real(dp), intent(in) :: drag                   !! [N s/m]
    logical, intent(in) :: cuts_suction
    logical, intent(inout) :: full(n, m - 1)
    real(dp), intent(out) :: rate(2)               !! [m/s]
    real(dp), intent(out) :: p(0:n + 1, 0:m)
    logical, intent(out) :: found
    real(dp) :: part(3, n, m - 1)   ! pressures at the rates so far, and over further ones
    real(dp), dimension(n, m - 1) :: here, further   ! sources at the rates so far, and by further ones
    real(dp) :: so_far(2), change(2)
    logical :: changes
    integer :: pass, repeats
    p = 0
    so_far = 0
    repeats = 0
    do pass = 1, most_rounds + most_single
      here = source + so_far(1)*by_rate(:, :, 1) + so_far(2)*by_rate(:, :, 2)
      call find_parts(n, m, along, round, here, by_rate, full, part)
      found = .true.
      if (cuts_suction) then
        call cut_rate(n*(m - 1), weight, part, load - drag*so_far, drag, change, found)
      else
        change = balanced_rate(n*(m - 1), weight, part, full, load - drag*so_far, drag)
      end if
      rate = so_far + change
      p(1:n, 1:m - 1) = part(1, :, :) + change(1)*part(2, :, :) + change(2)*part(3, :, :)
      if (.not. found) exit
      if (.not. cuts_suction) then
        further = change(1)*by_rate(:, :, 1) + change(2)*by_rate(:, :, 2)
        call change_full(n, m, along, round, here + further, p, least_inflow*maxval(abs(here) + abs(further)), &
          -lowest_suction*maxval(abs(part(1, :, :))), pass > most_rounds, full, changes)
        found = .not. changes
        if (changes) cycle
      end if
      found = springs_balance(n, m, weight, p, load, drag, rate)
      if (found .or. repeats == most_repeats) exit
      repeats = repeats + 1
      so_far = rate
    end do
  end subroutine balance_yielding

  !> Whether the springs balance, but for a small part of what loads them.
  pure logical function springs_balance(n, m, weight, p, load, drag, rate)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: weight(n, m - 1, 2), p(0:n + 1, 0:m), load(2), drag, rate(2)
    real(dp) :: pressed(2)
    integer :: k
    do k = 1, 2
      pressed(k) = sum(weight(:, :, k)*max(p(1:n, 1:m - 1), 0.0_dp))
    end do
    springs_balance = maxval(abs(load - drag*rate + pressed)) <= most_missed*maxval(abs(load) + drag*abs(rate) + pressed)
  end function springs_balance

  !> Pressures of the full nodes of a face at rest, and those over the rate of each spring; 0 at others.
  pure subroutine find_parts(n, m, along, round, source, by_rate, full, part)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1), by_rate(n, m - 1, 2)
    logical, intent(in) :: full(n, m - 1)
    real(dp), intent(out) :: part(3, n, m - 1)
    real(dp) :: a(0:n + 1, n*m + 2), x(n*m + 2), over_rate(2, n*m + 2)
    integer :: number(n, m)
    integer :: i, j, k
    call assemble(n, m, along, round, full, k, number, a)
    x(:k + n + 2) = 0
    over_rate(:, :k + n + 2) = 0
    do j = 1, m - 1
      do i = 1, n
        if (.not. full(i, j)) cycle
        x(number(i, j)) = source(i, j)
        over_rate(:, number(i, j)) = by_rate(i, j, :)
      end do
    end do
    call solve_symmetric(k, n, a, x)
    call substitute(2, k, n, a, over_rate)
    part = 0
    do j = 1, m - 1
      do i = 1, n
        if (.not. full(i, j)) cycle
        part(1, i, j) = x(number(i, j))
        part(2:, i, j) = over_rate(:, number(i, j))
      end do
    end do
  end subroutine find_parts

  !> The rates for which the springs balance, with the pressures of the nodes that count. Where the springs almost share their load
  !> Cramer's rule misses by rounding of its products, hence once more with what it misses.
  pure function balanced_rate(n, weight, part, counts, load, drag) result(rate)
    integer, intent(in) :: n
    real(dp), intent(in) :: weight(n, 2), part(3, n), load(2), drag
    logical, intent(in) :: counts(n)
    real(dp) :: rate(2), a(2, 2), b(2), determinant
    integer :: pass
    call find_balance(n, weight, part, counts, load, drag, a, b)
    determinant = a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1)
    rate = 0
    do pass = 1, 2
      rate = rate + [a(2, 2)*b(1) - a(1, 2)*b(2), a(1, 1)*b(2) - a(2, 1)*b(1)]/determinant
      b = [b(1) - a(1, 1)*rate(1) - a(1, 2)*rate(2), b(2) - a(2, 1)*rate(1) - a(2, 2)*rate(2)]
    end do
  end function balanced_rate

  !> The rates for which the springs balance where suction is cut off, by Newton's method: that is linear while the nodes without
  !> suction stay. Where it runs in circles a path leads there.
  pure subroutine cut_rate(n, weight, part, load, drag, rate, found)
    integer, intent(in) :: n
    real(dp), intent(in) :: weight(n, 2), part(3, n), load(2), drag
    real(dp), intent(out) :: rate(2)
    logical, intent(out) :: found
    real(dp) :: pressure(n), nothing
    logical :: counts(n)
    integer :: pass
    nothing = lowest_suction*maxval(abs(part(1, :)))
    counts = part(1, :) > 0
    do pass = 1, most_plain
      rate = balanced_rate(n, weight, part, counts, load, drag)
      pressure = part(1, :) + rate(1)*part(2, :) + rate(2)*part(3, :)
      found = .not. any(abs(pressure) > nothing .and. ((pressure > 0) .neqv. counts))
      if (found) return
      counts = pressure > 0
    end do
    call follow_balance(n, weight, part, load, drag, rate, found)
  end subroutine cut_rate

  !> The same along the path on which the springs miss a falling share of what they miss at rates so large that there is suction
  !> everywhere. Every pressure falls with both rates: there the path has one beginning, it stays within bounds, and so it ends
  !> where the springs balance. It turns at each node whose pressure passes 0 (Katzenelson 1965), and the share rises again for a
  !> while where the determinant is negative (Chien and Kuh 1977).
  pure subroutine follow_balance(n, weight, part, load, drag, rate, found)
    integer, intent(in) :: n
    real(dp), intent(in) :: weight(n, 2), part(3, n), load(2), drag
    real(dp), intent(out) :: rate(2)
    logical, intent(out) :: found
    real(dp) :: pressure(n), change(n), a(2, 2), b(2), missed(2), along_path(2), share, determinant, step, reach
    logical :: counts(n)
    integer :: pass, i, first
    rate = 0
    do i = 1, n
      if (part(1, i) > 0 .and. part(2, i) + part(3, i) < 0) rate = max(rate, -part(1, i)/(part(2, i) + part(3, i)))
    end do
    rate = rate*[1.01_dp, 1.1_dp]
    missed = load - drag*rate
    share = 1
    pressure = part(1, :) + rate(1)*part(2, :) + rate(2)*part(3, :)
    counts = pressure > 0
    do pass = 1, most_turns*n
      call find_balance(n, weight, part, counts, load, drag, a, b)
      determinant = a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1)
      along_path = [a(2, 2)*missed(1) - a(1, 2)*missed(2), a(1, 1)*missed(2) - a(2, 1)*missed(1)]
      change = along_path(1)*part(2, :) + along_path(2)*part(3, :)
      step = huge(step)
      if (determinant > 0) step = share/determinant
      first = 0
      do i = 1, n
        if (.not. abs(change(i)) > 0 .or. ((change(i) > 0) .eqv. counts(i))) cycle
        reach = max(-pressure(i)/change(i), 0.0_dp)
        if (.not. reach < step) cycle
        step = reach
        first = i
      end do
      found = first == 0
      if (found) exit
      share = share - step*determinant
      pressure = pressure + step*change
      pressure(first) = 0
      counts(first) = .not. counts(first)
    end do
    rate = balanced_rate(n, weight, part, counts, load, drag)
  end subroutine follow_balance

  !> The linear equations a v = b of the rates, with the pressures of the nodes that count.
  pure subroutine find_balance(n, weight, part, counts, load, drag, a, b)
    integer, intent(in) :: n
    real(dp), intent(in) :: weight(n, 2), part(3, n), load(2), drag
    logical, intent(in) :: counts(n)
    real(dp), intent(out) :: a(2, 2), b(2)
    integer :: i, k
    a = reshape([drag, 0.0_dp, 0.0_dp, drag], [2, 2])
    b = load
    do i = 1, n
      if (.not. counts(i)) cycle
      do k = 1, 2
        b(k) = b(k) + weight(i, k)*part(1, i)
        a(k, :) = a(k, :) - weight(i, k)*part(2:, i)
      end do
    end do
  end subroutine find_balance
end module face_yield
