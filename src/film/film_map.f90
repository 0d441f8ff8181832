!> The force of a film of finite length as a table: exact but for its interpolation, since with one pressure at the ends and in the
!> ruptured film the force is V times a function of the eccentricity ratio eps and of the direction alpha of the velocity V alone.
!>
!> The velocity is v* = e' - (omega/2) z x e, over the clearance (B, T) along n = e/|e| and t [1/s]; the force along n and t is
!> mu L R^3/c^2 (V Phi_r, V Phi_t). Next to the wall the forces of approach grow as w^-3, w = sqrt(1 - eps^2), those of rotation
!> as w^-2 and w^-1, those of withdrawal not at all, and the change from one to the other narrows as w. The scales and coordinates
!>
!>     M = sqrt(B^2 + w^2 T^2), u = (1 + B/M)/2, q = (u + w^2)/w^2,  V Phi_r = M q^(3/2) G_r,  V Phi_t = sign(T) M q G_t
!>     tau = atan2(eps, w),  chi = atan2(|T| B (1 + w), B^2 - w T^2)/2 in [0, pi]
!>
!> leave two smooth and bounded functions G of tau and chi, even and odd about chi = 0 and pi, which are splines of the fifth
!> degree here. They depend on L/(2R) and on the cavitation. So do two more, even both: the largest pressure over mu R^2/c^2 is
!> M q^2 G_p, the flow out of both ends over c R^2 is V G_q.
module film_map
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use gudgeon_archive, only: archive_t
  use film_law, only: table_watch_t
  use finite_film, only: film_solver_t, film_answer_t, cavitation_reynolds
  use uniform_spline, only: spline_weights, through_values, through_mirrored, before, after
  implicit none
  private
  public :: film_map_t, solved_force, solved_film

  type :: film_map_t
    real(dp) :: half_length = 0            !! L/(2R) of the table
    integer :: cavitation = 0              !! as in `finite_film`
    integer :: film_points = 0             !! nodes round the film where it was solved; Richardson's extrapolation from half as many
    integer :: points = 0                  !! values of the table in each direction; 0: there is none
    real(dp), private :: per_tau = 0, per_chi = 0   !! intervals per radian
    real(dp), allocatable, private :: c(:, :, :)    !! coefficients: of G_r and G_t, by chi, by tau
    real(dp), allocatable, private :: more(:, :, :) !! the same of G_p and G_q
  contains
    procedure :: build
    procedure :: force
    procedure :: peak_and_flow
    procedure :: exchange
  end type film_map_t

  type :: solver_pair_t
    type(film_solver_t) :: fine, coarse
  end type solver_pair_t

  real(dp), parameter :: last_gap = 1e-4_dp     !! 1 - eps of the last row; beyond it G is held
  integer, parameter :: nodes_along = 10        !! nodes round the film for one along half of it

contains

  !> Find the table. Rows are solved in parallel. If somebody stops it there is none.
  subroutine build(self, half_length, cavitation, points, film_points, watch)
    class(film_map_t), intent(inout) :: self
    real(dp), intent(in) :: half_length
    integer, intent(in) :: cavitation, points, film_points   !! points >= 8, film_points >= 32
    class(table_watch_t), intent(inout), optional :: watch
    real(dp), allocatable :: g(:, :, :), by_chi(:, :)
    integer :: i, k, done
    logical :: stops

    self%half_length = half_length
    self%cavitation = cavitation
    self%points = points
    self%film_points = film_points
    self%per_tau = (points - 1)/tau_of(last_gap)
    self%per_chi = (points - 1)/pi
    allocate (g(points, points, 4))   ! by chi, tau
    done = 0
    stops = .false.
    !$omp parallel do schedule(dynamic)
    do i = points, 1, -1   ! the longest first
      if (stops) cycle
      call solve_row(self, (i - 1)/self%per_tau, g(:, i, :))
      !$omp critical (film_rows)
      done = done + 1
      if (present(watch)) then
        call watch%row_done(done, points)
        stops = watch%wants_to_stop
      end if
      !$omp end critical (film_rows)
    end do
    if (stops) self%points = 0
    if (stops) return
    call make_room(self)
    do k = 1, 4
      by_chi = through_mirrored(g(:, :, k), merge(-1, 1, k == 2))
      by_chi = transpose(through_values(transpose(by_chi)))
      if (k <= 2) self%c(k, :, :) = by_chi
      if (k > 2) self%more(k - 2, :, :) = by_chi
    end do
  end subroutine build

  subroutine make_room(self)
    class(film_map_t), intent(inout) :: self
    if (allocated(self%c)) deallocate (self%c, self%more)
    associate (first => 1 - before, last => self%points + after)
      allocate (self%c(2, first:last, first:last), self%more(2, first:last, first:last))
    end associate
  end subroutine make_room

  pure real(dp) function tau_of(gap)
    real(dp), intent(in) :: gap   !! 1 - eps
    tau_of = 0.5_dp*pi - 2*asin(sqrt(0.5_dp*gap))
  end function tau_of

  !> G_r, G_t, G_p and G_q at one tau, for every chi.
  subroutine solve_row(self, tau, g)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: tau
    real(dp), intent(out) :: g(:, :)
    type(solver_pair_t), allocatable :: pairs(:)
    type(film_answer_t) :: film
    real(dp) :: gap, w, alpha, s_r, s_t
    integer :: j, grids

    gap = 2*sin(0.5_dp*(0.5_dp*pi - tau))**2
    w = cos(tau)
    grids = grids_for(self%film_points, self%cavitation)
    call begin_pairs(grids, nodes_at(self%film_points, grids, gap), gap, self%half_length, pairs)
    if (gap >= 1) call extrapolated(pairs, 0.0_dp, self%cavitation, .false., film)
    do j = 1, self%points
      alpha = direction_at((j - 1)/self%per_chi, w)
      if (gap >= 1) then   ! a centred film: alike in every direction
        g(j, :2) = film%force(1)*[cos(alpha), sin(alpha)]
      else
        call extrapolated(pairs, alpha, self%cavitation, j > 1, film)
        g(j, :2) = film%force
      end if
      call find_scales(cos(alpha), sin(alpha), w**2, s_r, s_t)
      g(j, :2) = g(j, :2)/[s_r, s_t]
      g(j, 3) = film%most/(s_r**2/s_t)
      g(j, 4) = film%flow
    end do
    g([1, self%points], 2) = 0
  end subroutine solve_row

  !> Nodes round the film at a thickness: more where it is thin, since the edge of a film that is left moves from node to node. The mean
  !> of several grids does without.
  pure integer function nodes_at(film_points, grids, gap)
    integer, intent(in) :: film_points, grids
    real(dp), intent(in) :: gap
    integer, parameter :: enough = 200
    nodes_at = film_points
    if (grids > 1) return
    if (gap < 0.05_dp) nodes_at = 4*((3*film_points)/8)
    if (gap < 0.012_dp .and. film_points < enough) nodes_at = 2*film_points
  end function nodes_at

  !> Grids whose mean is taken. Where the film ruptures at a free edge the force has an error that changes with the place of the edge
  !> between two nodes, and that Richardson's extrapolation leaves: the mean of grids a quarter of this distance apart is five to ten
  !> times closer. Coarse films have larger errors than this one.
  pure integer function grids_for(film_points, cavitation)
    integer, intent(in) :: film_points, cavitation
    integer, parameter :: fine_film = 160
    grids_for = merge(4, 1, cavitation == cavitation_reynolds .and. film_points >= fine_film)
  end function grids_for

  !> Pairs of solvers, one of each with half as many nodes in each direction, on shifted grids.
  pure subroutine begin_pairs(grids, nodes, gap, half_length, pairs)
    integer, intent(in) :: grids
    integer, intent(in) :: nodes   !! round the film, divisible by 4
    real(dp), intent(in) :: gap, half_length
    type(solver_pair_t), allocatable, intent(out) :: pairs(:)
    integer :: along, i
    along = 2*max(3, nodes/(2*nodes_along))
    allocate (pairs(grids))
    do i = 1, grids
      call pairs(i)%fine%begin(nodes, along, gap, half_length, real(i - 1, dp)/grids)
      call pairs(i)%coarse%begin(nodes/2, along/2, gap, half_length, real(i - 1, dp)/grids)
    end do
  end subroutine begin_pairs

  !> The film from all of them: in a pair errors of the second order cancel.
  pure subroutine extrapolated(pairs, alpha, cavitation, warm, film)
    type(solver_pair_t), intent(inout) :: pairs(:)
    real(dp), intent(in) :: alpha
    integer, intent(in) :: cavitation
    logical, intent(in) :: warm
    type(film_answer_t), intent(out) :: film
    type(film_answer_t) :: fine, coarse
    integer :: i
    do i = 1, size(pairs)
      call pairs(i)%fine%solve(alpha, cavitation, warm, fine)
      call pairs(i)%coarse%solve(alpha, cavitation, warm, coarse)
      film%force = film%force + (4*fine%force - coarse%force)/3
      film%flow = film%flow + (4*fine%flow - coarse%flow)/3
      film%most = film%most + (4*fine%most - coarse%most)/3
    end do
    film%force = film%force/size(pairs)
    film%flow = film%flow/size(pairs)
    film%most = film%most/size(pairs)
  end subroutine extrapolated

  !> The same without a table, for one eccentricity ratio and direction [rad].
  pure subroutine solved_film(film_points, half_length, cavitation, gap, alpha, film)
    integer, intent(in) :: film_points, cavitation
    real(dp), intent(in) :: half_length, gap, alpha
    type(film_answer_t), intent(out) :: film
    type(solver_pair_t), allocatable :: pairs(:)
    call begin_pairs(grids_for(film_points, cavitation), film_points, gap, half_length, pairs)
    call extrapolated(pairs, alpha, cavitation, .false., film)
  end subroutine solved_film

  !> Its force alone, over mu V L R^3/c^2.
  pure subroutine solved_force(film_points, half_length, cavitation, gap, alpha, force)
    integer, intent(in) :: film_points, cavitation
    real(dp), intent(in) :: half_length, gap, alpha
    real(dp), intent(out) :: force(2)
    type(film_answer_t) :: film
    call solved_film(film_points, half_length, cavitation, gap, alpha, film)
    force = film%force
  end subroutine solved_force

  !> Scales of the radial and of the tangential force for the velocity (B, A), A >= 0, not both 0; w2 = 1 - eps^2.
  pure subroutine find_scales(b, a, w2, s_r, s_t)
    real(dp), intent(in) :: b, a, w2
    real(dp), intent(out) :: s_r, s_t
    real(dp) :: m, u, q
    m = sqrt(b**2 + w2*a**2)
    if (b >= 0) then
      u = 0.5_dp*(1 + b/m)
    else
      u = 0.5_dp*w2*a**2/(m*(m - b))
    end if
    q = (u + w2)/w2
    s_t = m*q
    s_r = s_t*sqrt(q)
  end subroutine find_scales

  !> chi of the velocity (B, A), A >= 0, in [0, pi].
  pure real(dp) function chi_of(b, a, w)
    real(dp), intent(in) :: b, a, w
    chi_of = 0.5_dp*atan2(a*b*(1 + w), b**2 - w*a**2)
    if (b < 0 .and. chi_of <= 0) chi_of = chi_of + pi
  end function chi_of

  !> The direction alpha that has a chi, by bisection.
  pure real(dp) function direction_at(chi, w) result(alpha)
    real(dp), intent(in) :: chi, w
    real(dp) :: lower, upper
    integer :: i
    lower = 0
    upper = pi
    do i = 1, 60
      alpha = 0.5_dp*(lower + upper)
      if (chi_of(cos(alpha), sin(alpha), w) < chi) then
        lower = alpha
      else
        upper = alpha
      end if
    end do
    if (chi <= 0) alpha = 0
    if (chi >= pi) alpha = pi
  end function direction_at

  !> V Phi_r and V Phi_t [1/s] for a velocity (B, T) [1/s] at eps^2 (< 1).
  pure subroutine force(self, eps_squared, b, t, radial, tangential)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: radial, tangential
    real(dp) :: w2, w, a, s_r, s_t, x, y, by_tau(6), by_chi(6), g_r, g_t, line_r, line_t
    integer :: i, j, k, l

    radial = 0
    tangential = 0
    a = abs(t)
    if (.not. (a > 0 .or. abs(b) > 0)) return
    w2 = 1 - eps_squared
    w = sqrt(w2)
    call find_scales(b, a, w2, s_r, s_t)
    x = min(atan2(sqrt(eps_squared), w)*self%per_tau, real(self%points - 1, dp))
    y = chi_of(b, a, w)*self%per_chi
    i = min(int(x), self%points - 2)
    j = min(int(y), self%points - 2)
    by_tau = spline_weights(x - i)
    by_chi = spline_weights(y - j)
    g_r = 0
    g_t = 0
    do k = 1, 6
      line_r = 0
      line_t = 0
      do l = 1, 6
        line_r = line_r + by_chi(l)*self%c(1, j + l - before, i + k - before)
        line_t = line_t + by_chi(l)*self%c(2, j + l - before, i + k - before)
      end do
      g_r = g_r + by_tau(k)*line_r
      g_t = g_t + by_tau(k)*line_t
    end do
    radial = s_r*g_r
    tangential = s_t*g_t
    if (t < 0) tangential = -tangential
  end subroutine force

  !> Largest pressure over mu R^2/c^2 and flow out of both ends over c R^2 [1/s], as `force`.
  pure subroutine peak_and_flow(self, eps_squared, b, t, most, flow)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: most, flow
    real(dp) :: w, s_r, s_t, x, y, by_tau(6), line(2, 6), g(2)
    integer :: i, j, k
    most = 0
    flow = 0
    if (.not. (abs(t) > 0 .or. abs(b) > 0)) return
    w = sqrt(1 - eps_squared)
    call find_scales(b, abs(t), w**2, s_r, s_t)
    x = min(atan2(sqrt(eps_squared), w)*self%per_tau, real(self%points - 1, dp))
    y = chi_of(b, abs(t), w)*self%per_chi
    i = min(int(x), self%points - 2)
    j = min(int(y), self%points - 2)
    by_tau = spline_weights(x - i)
    do k = 1, 6
      line(:, k) = matmul(self%more(:, j + k - before, i + 1 - before:i + 6 - before), by_tau)
    end do
    g = matmul(line, spline_weights(y - j))
    most = g(1)*s_r**2/s_t
    flow = g(2)*sqrt(b**2 + t**2)
  end subroutine peak_and_flow

  !> The table, to or from an archive.
  subroutine exchange(self, archive)
    class(film_map_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    integer :: i
    call archive%exchange(self%half_length)
    call archive%exchange(self%cavitation)
    call archive%exchange(self%film_points)
    call archive%exchange(self%points)
    if (archive%failed .or. self%points < 8) return
    self%per_tau = (self%points - 1)/tau_of(last_gap)
    self%per_chi = (self%points - 1)/pi
    if (archive%is_reading) call make_room(self)
    do i = lbound(self%c, 3), ubound(self%c, 3)
      call archive%exchange(self%c(:, :, i))
      call archive%exchange(self%more(:, :, i))
    end do
  end subroutine exchange
end module film_map
