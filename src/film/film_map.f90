!> Table of the force of a film of finite length. Only its interpolation is approximate: since the pressure at the ends and in the
!> ruptured film is the same, the force is V times a function of the eccentricity ratio eps and of the direction of the velocity V.
!>
!> The velocity is v* = e' - (omega/2) z x e; divided by the clearance it has the components (B, T) along n = e/|e| and t [1/s]. The
!> force along n and t is mu L R^3/c^2 (V Phi_r, V Phi_t). Near the wall the forces grow as w^-3 if the pin approaches, w = sqrt(1 -
!> eps^2), as w^-2 and w^-1 if it rotates, and stay bounded if it withdraws; the transition between approach and withdrawal becomes
!> as narrow as w. With the scales and coordinates
!>
!>     M = sqrt(B^2 + w^2 T^2), u = (1 + B/M)/2, q = (u + w^2)/w^2,  V Phi_r = M q^(3/2) G_r,  V Phi_t = sign(T) M q G_t
!>     tau = atan2(eps, w),  chi = atan2(|T| B (1 + w), B^2 - w T^2)/2 in [0, pi]
!>
!> G_r and G_t are smooth and bounded functions of tau and chi, G_r even and G_t odd about chi = 0 and pi. They are interpolated by
!> splines of the fifth degree and depend on L/(2R) and on the cavitation condition only, as do two more functions, both even: the
!> largest pressure over mu R^2/c^2 is M q^2 G_p, and the side flow out of both ends over c R^2 is V G_q. The force of a film
!> without cavitation is linear in B and T, V Phi_r = B w^-3 G_r and V Phi_t = T w^-1 G_t, with G_r and G_t functions of tau alone.
!>
!> A table is made for one of the values of L/(2R) that `table_length` gives, each 0.5 % longer than the one before, and moved to
!> that of the bearing (`move_to`) with the slopes of G with respect to ln L/(2R): all bearings of a study of the clearance have one
!> or two tables. The slopes are differences of two small tables.
module film_map
  use kinds, only: dp
  use constants, only: pi
  use film_law, only: table_watch_t
  use finite_film, only: film_answer_t, cavitation_none
  use film_solution, only: film_solution_t
  use film_coordinates, only: find_scales, scale_slopes, chi_of, chi_slopes, tau_of, gap_at, direction_at
  use uniform_spline, only: spline_weights, spline_slopes, through_values, through_mirrored, before, after
  implicit none
  private
  public :: film_map_t, table_length

  type :: film_map_t
    real(dp) :: half_length = 0            !! L/(2R) for which the table is
    integer :: cavitation = 0              !! the cavitation condition, one of the constants of `finite_film`
    integer :: film_points = 0             !! number of grid nodes round the film; Richardson's extrapolation uses half as many too
    integer :: points = 0                  !! number of values in each direction; 0: the table is empty
    real(dp) :: largest_error = 0          !! largest relative error of the force, against solutions between the values of the table
    real(dp) :: mean_error = 0             !! root-mean-square of that error, evenly over tau and chi
    real(dp), private :: per_tau = 0, per_chi = 0   !! intervals per radian
    real(dp), allocatable, private :: c(:, :, :)    !! spline coefficients of G_r and G_t: (function, chi, tau)
    real(dp), allocatable, private :: more(:, :, :) !! spline coefficients of G_p and G_q
    real(dp), allocatable, private :: c_slope(:, :, :), more_slope(:, :, :)   !! their derivatives with respect to ln L/(2R)
  contains
    procedure :: build
    procedure :: move_to
    procedure :: force
    procedure :: force_slopes
    procedure :: peak_and_flow
    procedure :: numbers
    procedure :: restore
  end type film_map_t

  !> A position in the table, between the third and the fourth of six rows, and of six columns, of coefficients.
  type :: place_t
    integer :: row = 0             !! first of the six rows
    integer :: column = 0          !! column before the first of the six columns
    real(dp) :: in_row = 0         !! distance from the third row, in intervals
    real(dp) :: in_column = 0      !! distance from the third column, in intervals
  end type place_t

  real(dp), parameter :: last_gap = 1e-4_dp     !! 1 - eps of the last row; beyond it the functions G keep their values
  integer, parameter :: even_rows = 16, thin_rows = 6           !! rows of the sample over all eccentricities, and in thin gaps
  integer, parameter :: sample_rows = even_rows + thin_rows, sample_directions = 12   !! points at which the error is measured
  real(dp), parameter :: thin_gap = 7e-3_dp                     !! 1 - eps below which a gap of the sample is thin

contains

  !> The half length L/(2R) of the table that serves a bearing of this one: the nearest of a series, 0.25 % away at most.
  pure elemental real(dp) function table_length(half_length)
    real(dp), intent(in) :: half_length   !! > 0
    integer, parameter :: per_unit = 200   !! of ln L/(2R)
    table_length = exp(real(nint(per_unit*log(half_length)), dp)/per_unit)
  end function table_length

  !> Compute the table for one half length, its slopes, and its error against solutions between its values. Rows are computed in
  !> parallel. If `watch` stops the computation, the table stays empty.
  subroutine build(self, half_length, cavitation, points, film_points, watch)
    class(film_map_t), intent(inout) :: self
    real(dp), intent(in) :: half_length
    integer, intent(in) :: cavitation, points, film_points   !! points >= 8, film_points >= 32
    class(table_watch_t), intent(inout), optional :: watch
    real(dp), parameter :: step = 0.05_dp   !! of ln L/(2R), from the table to the small ones on both sides
    integer, parameter :: small_points = 33, small_film_points = 64
    type(film_map_t) :: small(2)
    real(dp), allocatable :: g(:, :, :), of_small(:, :, :, :), beside(:, :, :, :), between(:, :, :)
    integer :: i, k, rows, done, n
    logical :: stops

    call set_size(self, half_length, cavitation, points, film_points)
    n = min(points, small_points)
    call set_size(small(1), half_length*exp(-step), cavitation, n, min(film_points, small_film_points))
    call set_size(small(2), half_length*exp(step), cavitation, n, min(film_points, small_film_points))
    allocate (g(points, points, 4), of_small(n, n, 4, 2), between(2, sample_directions, sample_rows))   ! by chi, tau
    allocate (beside(points, points, 4, 2))
    rows = 2*n + points + sample_rows
    done = 0
    stops = .false.
    if (present(watch)) call watch%begins()
    !$omp parallel do schedule(dynamic) private(k)
    do i = rows, 1, -1   ! the longest first
      if (stops) cycle
      k = i - 2*n
      if (k > points) then
        call solve_sample(self, k - points, between(:, :, k - points))
      else if (k > 0) then
        call solve_row(self, (k - 1)/self%per_tau, g(:, k, :))
      else
        k = merge(1, 2, i <= n)
        call solve_row(small(k), (i - 1 - (k - 1)*n)/small(k)%per_tau, of_small(:, i - (k - 1)*n, :, k))
      end if
      !$omp critical (film_rows)
      done = done + 1
      if (present(watch)) then
        call watch%row_done(done, rows)
        stops = watch%wants_to_stop
      end if
      !$omp end critical (film_rows)
    end do
    if (present(watch)) call watch%ends()
    if (stops) self%points = 0
    if (stops) return
    call find_coefficients(g, cavitation, self%c, self%more)
    call find_errors(self, between)
    do k = 1, 2
      call find_coefficients(of_small(:, :, :, k), cavitation, small(k)%c, small(k)%more)
      call find_values(small(k), self, beside(:, :, :, k))
    end do
    call find_coefficients((beside(:, :, :, 2) - beside(:, :, :, 1))/(2*step), cavitation, self%c_slope, self%more_slope)
  end subroutine build

  pure subroutine set_size(self, half_length, cavitation, points, film_points)
    class(film_map_t), intent(inout) :: self
    real(dp), intent(in) :: half_length
    integer, intent(in) :: cavitation, points, film_points
    self%half_length = half_length
    self%cavitation = cavitation
    self%points = points
    self%film_points = film_points
    self%per_tau = (points - 1)/tau_of(last_gap)
    self%per_chi = (points - 1)/pi
  end subroutine set_size

  !> Spline coefficients of the functions G, given at all points of a table (chi, tau, function).
  pure subroutine find_coefficients(g, cavitation, c, more)
    real(dp), intent(in) :: g(:, :, :)
    integer, intent(in) :: cavitation
    real(dp), allocatable, intent(out) :: c(:, :, :), more(:, :, :)
    real(dp), allocatable :: by_chi(:, :)
    integer :: k
    associate (first => 1 - before, last => size(g, 1) + after)
      allocate (c(2, first:last, first:last), more(2, first:last, first:last))
    end associate
    do k = 1, 4
      by_chi = through_mirrored(g(:, :, k), merge(-1, 1, k == 2 .and. cavitation /= cavitation_none))
      by_chi = transpose(through_values(transpose(by_chi)))
      if (k <= 2) c(k, :, :) = by_chi
      if (k > 2) more(k - 2, :, :) = by_chi
    end do
  end subroutine find_coefficients

  !> The functions G of a table at the points of another one, (chi, tau, function).
  pure subroutine find_values(self, other, g)
    class(film_map_t), intent(in) :: self, other
    real(dp), intent(out) :: g(:, :, :)
    type(place_t) :: place
    real(dp) :: by_chi(6), by_tau(6), values(2)
    integer :: i, j
    do i = 1, other%points
      do j = 1, other%points
        place = place_at(self, self%per_tau*((i - 1)/other%per_tau), self%per_chi*((j - 1)/other%per_chi))
        by_chi = spline_weights(place%in_column)
        by_tau = spline_weights(place%in_row)
        call weigh(self%c(1, 1 - before, place%row), self%points, place%column, by_chi, by_tau, values)
        g(j, i, :2) = values
        call weigh(self%more(1, 1 - before, place%row), self%points, place%column, by_chi, by_tau, values)
        g(j, i, 3:) = values
      end do
    end do
  end subroutine find_values

  !> Move the table to another half length, at most some 1 % from its own.
  pure subroutine move_to(self, half_length)
    class(film_map_t), intent(inout) :: self
    real(dp), intent(in) :: half_length
    real(dp) :: by
    by = log(half_length/self%half_length)
    self%c = self%c + by*self%c_slope
    self%more = self%more + by*self%more_slope
    self%half_length = half_length
  end subroutine move_to

  !> G_r, G_t, G_p and G_q of one row (tau), for all chi.
  subroutine solve_row(self, tau, g)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: tau
    real(dp), intent(out) :: g(:, :)
    type(film_solution_t) :: solution
    type(film_answer_t) :: film
    real(dp) :: gap, w, alpha, s_r, s_t
    integer :: j

    gap = gap_at(tau)
    w = cos(tau)
    call solution%begin(self%film_points, self%half_length, self%cavitation, gap)
    if (gap >= 1) call solution%solve(0.0_dp, .false., film)
    do j = 1, self%points
      alpha = direction_at((j - 1)/self%per_chi, w)
      if (gap >= 1) then   ! concentric pin: the force is the same in all directions
        g(j, :2) = film%force(1)*[cos(alpha), sin(alpha)]
      else
        call solution%solve(alpha, j > 1, film)
        g(j, :2) = film%force
      end if
      call find_scales(cos(alpha), sin(alpha), w**2, s_r, s_t)
      g(j, :2) = g(j, :2)/[s_r, s_t]
      g(j, 3) = film%most/(s_r**2/s_t)
      g(j, 4) = film%flow
    end do
    if (self%cavitation == cavitation_none) then
      call solution%solve(0.0_dp, .false., film)
      g(:, 1) = film%force(1)*w**3
      call solution%solve(0.5_dp*pi, .false., film)
      g(:, 2) = film%force(2)*w
    else
      g([1, self%points], 2) = 0
    end if
  end subroutine solve_row

  !> Position of a sample point, at which the table is compared with a solution. It does not depend on the size of the table: tau
  !> and chi are distributed by the golden section, so that they are nodes of no table. In thin gaps, the last twentieth of tau, the
  !> errors are largest: rows of their own are there, evenly in the logarithm of the gap down to the last row of the table. Their
  !> directions are those of withdrawal, in which the force is smallest.
  pure subroutine place_sample(i, j, gap, alpha)
    integer, intent(in) :: i, j   !! number of the row (of one eccentricity ratio), and of the direction
    real(dp), intent(out) :: gap  !! 1 - eps
    real(dp), intent(out) :: alpha
    real(dp), parameter :: golden = 0.61803398874989485_dp
    real(dp) :: tau, chi
    chi = (j - 1 + modulo(golden*golden*i, 1.0_dp))/sample_directions
    if (i <= even_rows) then
      tau = modulo(golden*i, 1.0_dp)*tau_of(last_gap)
      gap = gap_at(tau)
    else
      gap = thin_gap*(last_gap/thin_gap)**((i - even_rows - 0.25_dp)/thin_rows)
      tau = tau_of(gap)
      chi = 0.5_dp*(1 + chi)
    end if
    alpha = direction_at(pi*chi, cos(tau))
  end subroutine place_sample

  !> The forces along n and t for all directions of a row of the sample, from the solver.
  subroutine solve_sample(self, i, force)
    class(film_map_t), intent(in) :: self
    integer, intent(in) :: i
    real(dp), intent(out) :: force(:, :)
    type(film_solution_t) :: solution
    type(film_answer_t) :: film
    real(dp) :: gap, alpha
    integer :: j
    do j = 1, sample_directions
      call place_sample(i, j, gap, alpha)
      if (j == 1) call solution%begin(self%film_points, self%half_length, self%cavitation, gap)
      call solution%solve(alpha, j > 1, film)
      force(:, j) = film%force
    end do
  end subroutine solve_sample

  !> Find the errors of the table against the forces of the sample.
  subroutine find_errors(self, solved)
    class(film_map_t), intent(inout) :: self
    real(dp), intent(in) :: solved(:, :, :)   !! (component of the force, direction, row)
    real(dp) :: gap, alpha, force(2), errors(sample_directions, sample_rows)
    integer :: i, j
    do i = 1, sample_rows
      do j = 1, sample_directions
        call place_sample(i, j, gap, alpha)
        call self%force((1 - gap)**2, cos(alpha), sin(alpha), force(1), force(2))
        errors(j, i) = norm2(force - solved(:, j, i))/norm2(solved(:, j, i))
      end do
    end do
    self%largest_error = maxval(errors)
    self%mean_error = sqrt(sum(errors(:, :even_rows)**2)/(even_rows*sample_directions))
  end subroutine find_errors

  !> V Phi_r and V Phi_t [1/s] for a velocity (B, T) [1/s] and a given eps^2 (< 1).
  pure subroutine force(self, eps_squared, b, t, radial, tangential)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: radial, tangential
    real(dp) :: w2, w, a, s_r, s_t, g(2)
    type(place_t) :: place
    radial = 0
    tangential = 0
    a = abs(t)
    if (.not. (a > 0 .or. abs(b) > 0)) return
    w2 = 1 - eps_squared
    w = sqrt(w2)
    if (self%cavitation == cavitation_none) then
      s_r = b/(w2*w)
      s_t = a/w
    else
      call find_scales(b, a, w2, s_r, s_t)
    end if
    call find_place(self, sqrt(eps_squared), w, b, a, place)
    call weigh(self%c(1, 1 - before, place%row), self%points, place%column, spline_weights(place%in_column), &
      spline_weights(place%in_row), g)
    radial = s_r*g(1)
    tangential = s_t*g(2)
    if (t < 0) tangential = -tangential
  end subroutine force

  !> V Phi_r and V Phi_t [1/s] (element 0) and their derivatives with respect to eps, B and T (elements 1 to 3), for 0 < eps < 1 and
  !> B and T not both 0.
  pure subroutine force_slopes(self, eps, b, t, radial, tangential)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: eps, b, t
    real(dp), intent(out) :: radial(0:3), tangential(0:3)
    real(dp) :: w2, w, a, s_r(0:3), s_t(0:3), g(2), by_chi(2), by_tau(2), weights(6, 2), of_chi(3), change(2)
    type(place_t) :: place
    integer :: i
    a = abs(t)
    w2 = (1 - eps)*(1 + eps)
    w = sqrt(w2)
    if (self%cavitation == cavitation_none) then
      s_r = [b, 3*b*eps/w2, 1.0_dp, 0.0_dp]/(w2*w)
      s_t = [a, a*eps/w2, 0.0_dp, 1.0_dp]/w
    else
      call find_scales(b, a, w2, s_r(0), s_t(0))
      call scale_slopes(eps, b, a, w2, s_r(0), s_t(0), s_r(1:), s_t(1:))
    end if
    call find_place(self, eps, w, b, a, place)
    weights(:, 1) = spline_weights(place%in_column)
    weights(:, 2) = spline_weights(place%in_row)
    associate (n => self%points, j => place%column, i => place%row)
      call weigh(self%c(1, 1 - before, i), n, j, weights(:, 1), weights(:, 2), g)
      call weigh(self%c(1, 1 - before, i), n, j, spline_slopes(place%in_column), weights(:, 2), by_chi)
      call weigh(self%c(1, 1 - before, i), n, j, weights(:, 1), spline_slopes(place%in_row), by_tau)
    end associate
    of_chi = chi_slopes(eps, b, a, w)*self%per_chi
    radial(0) = s_r(0)*g(1)
    tangential(0) = s_t(0)*g(2)
    do i = 1, 3
      change = by_chi*of_chi(i)
      if (i == 1 .and. place%in_row < 1) change = change + by_tau*self%per_tau/w   ! beyond the last row G is constant
      radial(i) = s_r(i)*g(1) + s_r(0)*change(1)
      tangential(i) = s_t(i)*g(2) + s_t(0)*change(2)
    end do
    if (t < 0) then
      radial(3) = -radial(3)
      tangential(:2) = -tangential(:2)
    end if
  end subroutine force_slopes

  !> Largest pressure over mu R^2/c^2 and side flow out of both ends over c R^2 [1/s], with the arguments of `force`.
  pure subroutine peak_and_flow(self, eps_squared, b, t, most, flow)
    class(film_map_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: most, flow
    real(dp) :: w, s_r, s_t, g(2)
    type(place_t) :: place
    most = 0
    flow = 0
    if (.not. (abs(t) > 0 .or. abs(b) > 0)) return
    w = sqrt(1 - eps_squared)
    call find_scales(b, abs(t), w**2, s_r, s_t)
    call find_place(self, sqrt(eps_squared), w, b, abs(t), place)
    call weigh(self%more(1, 1 - before, place%row), self%points, place%column, spline_weights(place%in_column), &
      spline_weights(place%in_row), g)
    most = g(1)*s_r**2/s_t
    flow = g(2)*sqrt(b**2 + t**2)
  end subroutine peak_and_flow

  !> Position in the table of the coordinates that belong to (eps, B, A), A = |T|.
  pure subroutine find_place(self, eps, w, b, a, place)
    type(film_map_t), intent(in) :: self
    real(dp), intent(in) :: eps, w, b, a
    type(place_t), intent(out) :: place
    place = place_at(self, atan2(eps, w)*self%per_tau, chi_of(b, a, w)*self%per_chi)
  end subroutine find_place

  !> Position in the table at `x` rows and `y` columns from its beginning.
  pure type(place_t) function place_at(self, x, y) result(place)
    type(film_map_t), intent(in) :: self
    real(dp), intent(in) :: x, y
    real(dp) :: row
    integer :: i, j
    row = min(x, real(self%points - 1, dp))
    i = max(0, min(int(row), self%points - 2))   ! within the table also if x or y is not a number
    j = max(0, min(int(y), self%points - 2))
    place = place_t(i + 1 - before, j, row - i, y - j)
  end function place_at

  !> Interpolate: sums of coefficients times their weights, over the first six rows of `c` and six columns.
  pure subroutine weigh(c, points, column, by_chi, by_tau, g)
    integer, intent(in) :: points, column   !! column before the first one
    real(dp), intent(in) :: c(2, points + before + after, 6), by_chi(6), by_tau(6)
    real(dp), intent(out) :: g(2)
    real(dp) :: line(2)
    integer :: k, l
    g = 0
    do k = 1, 6
      line = 0
      do l = 1, 6
        line = line + by_chi(l)*c(:, column + l, k)
      end do
      g = g + by_tau(k)*line
    end do
  end subroutine weigh

  !> The whole table as numbers, to be stored.
  pure function numbers(self)
    class(film_map_t), intent(in) :: self
    real(dp), allocatable :: numbers(:)
    numbers = [self%half_length, real([self%cavitation, self%film_points, self%points], dp), self%largest_error, self%mean_error]
    if (self%points == 0) return
    associate (n => size(self%c))
      numbers = [numbers, reshape(self%c, [n]), reshape(self%more, [n]), reshape(self%c_slope, [n]), reshape(self%more_slope, [n])]
    end associate
  end function numbers

  !> Restore a table from its numbers; `fits` is false, and there is no table, if they are not those of one.
  pure subroutine restore(self, numbers, fits)
    class(film_map_t), intent(inout) :: self
    real(dp), intent(in) :: numbers(:)
    logical, intent(out) :: fits
    integer, parameter :: head = 6
    integer :: n
    self%points = 0
    fits = size(numbers) >= head
    if (fits) fits = numbers(4) >= 8 .and. numbers(4) <= 1e4_dp
    if (.not. fits) return
    n = 2*(nint(numbers(4)) + before + after)**2
    fits = size(numbers) == head + 4*n
    if (.not. fits) return
    call set_size(self, numbers(1), nint(numbers(2)), nint(numbers(4)), nint(numbers(3)))
    self%largest_error = numbers(5)
    self%mean_error = numbers(6)
    call take(1, self%c)
    call take(2, self%more)
    call take(3, self%c_slope)
    call take(4, self%more_slope)

  contains

    pure subroutine take(k, c)
      integer, intent(in) :: k
      real(dp), allocatable, intent(out) :: c(:, :, :)
      associate (first => 1 - before, last => self%points + after)
        allocate (c(2, first:last, first:last))
      end associate
      c = reshape(numbers(head + (k - 1)*n + 1:head + k*n), shape(c))
    end subroutine take
  end subroutine restore
end module film_map
