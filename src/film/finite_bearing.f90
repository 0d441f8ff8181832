!> The film of a bearing of finite length: the quasi-static Reynolds equation, whose pressure is computed numerically
!> (`finite_film`), once for a table (`film_map`) or at every evaluation.
!>
!> Wedge and squeeze motion act together as one velocity, v* = e' - (omega/2) z x e (Booker 1965). The force is mu L R^3/c^2 |v*|/c
!> times a function of eps = |e|/c and of the direction of v*.
module finite_bearing
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use film_law, only: film_law_t, film_motion_t, table_watch_t, difference_derivatives, field_points, yes
  use film_direction, only: derivatives_in_components, least_ratio_of_derivatives
  use finite_film, only: film_answer_t, film_solver_t, cavitation_none, cavitation_gumbel, cavitation_reynolds
  use film_map, only: film_map_t, table_length
  use film_solution, only: solved_film
  implicit none
  private
  public :: finite_bearing_t

  real(dp), parameter :: least_gap = 1e-6_dp   !! smallest 1 - eps for which the equation is solved

  type, extends(film_law_t) :: finite_bearing_t
    character(len=:), allocatable :: variant, cavitation
    integer :: table_points = 0      !! number of table values in each direction; 0: chosen from the tolerance
    integer :: film_points = 0       !! number of grid nodes round the film; 0: chosen from the tolerance
    type(film_map_t) :: map = film_map_t()   !! of the variant `table`; empty: the equation is solved at every evaluation
    real(dp) :: half_length = 0      !! L/(2R)
    real(dp) :: pin_radius = 0       !! R [m]
    integer :: condition = 0         !! the cavitation condition, one of the constants of finite_film
  contains
    procedure :: conflict
    procedure :: parameters
    procedure :: prepare
    procedure :: film_force
    procedure :: force_derivatives
    procedure :: reduced_force
    procedure, nopass :: gives_pressure => yes
    procedure, nopass :: gives_side_flow => yes
    procedure :: longest_bearing
    procedure :: peak_and_flow
    procedure :: reduced_peak_and_flow
    procedure :: pressure_field
    procedure :: conserves_oil
    procedure :: table_key
    procedure :: make_table
    procedure :: table_numbers
    procedure :: restore_table
  end type finite_bearing_t

contains

  subroutine parameters(self, list)
    class(finite_bearing_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('variant', self%variant, 'table, direct, short', 'table', &
      'form of the film force; finite_bearing: table (computed once), direct (solved each time), short (Ocvirk)', example='table')
    call list%word('cavitation', self%cavitation, 'reynolds, gumbel, none, mass_conserving', 'reynolds', &
      'negative pressures; reynolds: film ruptures with zero pressure and slope; gumbel: they are set to 0; mass_conserving: '// &
      'the film of film_history balances its oil, that of the run is as with reynolds')
    call self%add_viscosity(list)
    call list%add('film_moment', self%film_moment, &
      'the oil shear acts on the pin with a moment; default .true. for finite_bearing, else .false.', &
      '.true.')
    call list%add('table_points', self%table_points, &
      'points of the table in each direction; 0: 33 for tolerances above 3e-5, else 65 with reynolds, 97 without', &
      '>= 17 and <= 513', '0')
    call list%add('film_points', self%film_points, &
      'grid points round the film, a multiple of 4; 0: by the tolerance 64 (above 3e-5), 128, 192 (below 1e-8)', &
      '>= 32 and <= 1024', '0')
    call list%text('table_file', self%table_file, &
      'file that keeps the table, path relative to the case file; '''': in the cache of the user', '', is_path=.true.)
    call self%add_least_film(list)
  end subroutine parameters

  !> Reports a number of nodes that cannot be divided by four.
  pure subroutine conflict(self, key, wanted)
    class(finite_bearing_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    if (mod(self%film_points, 4) == 0) return
    key = 'film_points'
    wanted = 'must be divisible by 4'
  end subroutine conflict

  !> Set the scales and the number of nodes, and move the table, if there is one, to this bearing.
  subroutine prepare(self, bearing, tolerance)
    class(finite_bearing_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    integer :: table_points, film_points
    call set_scales(self, bearing)
    call choose_points(self, tolerance, table_points, film_points)
    self%film_points = film_points
    if (self%map%points > 0) call self%map%move_to(self%half_length)
  end subroutine prepare

  subroutine set_scales(self, bearing)
    class(finite_bearing_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    associate (c => bearing%clearance, r => bearing%pin_radius())
      self%clearance = c
      self%per_clearance = 1/c
      self%half_length = 0.5_dp*bearing%length/r
      self%pin_radius = r
      self%force_scale = self%viscosity*bearing%length*r**3/c**2
    end associate
    self%condition = cavitation_reynolds
    if (self%cavitation == 'gumbel') self%condition = cavitation_gumbel
    if (self%cavitation == 'none') self%condition = cavitation_none
  end subroutine set_scales

  !> Numbers of table values in each direction and of grid nodes round the film, given in the case or chosen from the tolerance.
  !> With Reynolds' condition the solver takes long, and more than 65 values would mainly interpolate its error.
  pure subroutine choose_points(self, tolerance, table_points, film_points)
    class(finite_bearing_t), intent(in) :: self
    real(dp), intent(in) :: tolerance
    integer, intent(out) :: table_points, film_points
    table_points = merge(65, 97, condition_of_run(self) == 'reynolds')
    if (tolerance > 3e-5_dp) table_points = 33
    if (self%table_points > 0) table_points = self%table_points
    film_points = 128
    if (tolerance > 3e-5_dp) film_points = 64
    if (tolerance < 1e-8_dp) film_points = 192
    if (self%film_points > 0) film_points = self%film_points
  end subroutine choose_points

  !> In longer bearings the flow along the axis is lost in the rounding of that round the film.
  pure real(dp) function longest_bearing(self)
    class(finite_bearing_t), intent(in) :: self
    longest_bearing = merge(huge(longest_bearing), 1e3_dp, self%variant == 'short')
  end function longest_bearing

  pure logical function conserves_oil(self)
    class(finite_bearing_t), intent(in) :: self
    conserves_oil = self%cavitation == 'mass_conserving'
  end function conserves_oil

  !> The condition of cavitation in the run: one that conserves the oil is for the film that is marched afterwards.
  pure function condition_of_run(self) result(condition)
    class(finite_bearing_t), intent(in) :: self
    character(len=len('mass_conserving')) :: condition
    condition = self%cavitation
    if (self%conserves_oil()) condition = 'reynolds'
  end function condition_of_run

  !> Identifies the contents of a table: laws with the same key have the same table. Empty if the variant needs none.
  function table_key(self, bearing, tolerance) result(key)
    class(finite_bearing_t), intent(in) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    character(len=:), allocatable :: key
    character(len=len(self%table_of)) :: text
    integer :: table_points, film_points
    key = ''
    if (self%variant /= 'table') return
    call choose_points(self, tolerance, table_points, film_points)
    write (text, '(a,es24.16e3,a,i0,a,i0)') 'finite_bearing 7 '//trim(condition_of_run(self))//' ', &
      table_length(0.5_dp*bearing%length/bearing%pin_radius()), ' ', table_points, ' ', film_points
    key = trim(text)
  end function table_key

  subroutine make_table(self, bearing, tolerance, watch)
    class(finite_bearing_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    class(table_watch_t), intent(inout), optional :: watch
    character(len=:), allocatable :: key
    integer :: table_points, film_points
    key = self%table_key(bearing, tolerance)
    if (key == self%table_of) return
    call set_scales(self, bearing)
    call choose_points(self, tolerance, table_points, film_points)
    call self%map%build(table_length(self%half_length), self%condition, table_points, film_points, watch)
    call tell_errors(self)
    self%table_of = ''
    if (self%map%points > 0) self%table_of = key
  end subroutine make_table

  !> Make the errors of the table known as those of the law.
  subroutine tell_errors(self)
    class(finite_bearing_t), intent(inout) :: self
    self%table_error = self%map%largest_error
    self%table_mean_error = self%map%mean_error
  end subroutine tell_errors

  pure function table_numbers(self) result(numbers)
    class(finite_bearing_t), intent(in) :: self
    real(dp), allocatable :: numbers(:)
    numbers = self%map%numbers()
  end function table_numbers

  subroutine restore_table(self, numbers, fits)
    class(finite_bearing_t), intent(inout) :: self
    real(dp), intent(in) :: numbers(:)
    logical, intent(out) :: fits
    call self%map%restore(numbers, fits)
    call tell_errors(self)
  end subroutine restore_table

  !> Force of the pressure, and moment of the shear if it acts on the pin.
  pure subroutine film_force(self, motion, force, moment)
    class(finite_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2), moment
    real(dp) :: n(2), square, b, t, radial, tangential
    call reduce(self, motion, n, square, b, t)
    call self%reduced_force(square, b, t, radial, tangential)
    radial = self%force_scale*radial
    tangential = self%force_scale*tangential
    force = [radial*n(1) - tangential*n(2), radial*n(2) + tangential*n(1)]
    moment = 0
    if (self%film_moment) moment = self%shear_moment(motion, force)
  end subroutine film_force

  !> Derivatives of `film_force`, for implicit integration: those of the table, transformed to x and y. Central differences are used
  !> without a table, next to the wall, at rest, and close to the centre, where the direction of the eccentricity changes rapidly.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(finite_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    real(dp) :: n(2), square, eps, b, t, radial(0:3), tangential(0:3)
    call reduce(self, motion, n, square, b, t)
    eps = sqrt(square)
    if (self%map%points == 0 .or. eps < least_ratio_of_derivatives .or. 1 - eps < least_gap &
      .or. .not. (abs(b) > 0 .or. abs(t) > 0)) then
      call difference_derivatives(self, motion, derivatives)
      return
    end if
    call self%map%force_slopes(eps, b, t, radial, tangential)
    radial = self%force_scale*radial
    tangential = self%force_scale*tangential
    derivatives = derivatives_in_components(self, motion, n, eps, b, radial, tangential)
  end subroutine force_derivatives

  !> The direction n of the eccentricity, the square of the eccentricity ratio (< 1), and the components of v*/c along n and
  !> perpendicular to it [1/s].
  pure subroutine reduce(self, motion, n, square, b, t)
    class(finite_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: n(2), square, b, t
    real(dp), parameter :: centred = 1e-200_dp          !! eps^2 below which n is set to the direction of x
    real(dp), parameter :: largest_square = 1 - 2*epsilon(1.0_dp)
    real(dp) :: e(2), v(2)
    e = motion%eccentricity*self%per_clearance
    v = motion%eccentricity_rate*self%per_clearance
    v = [v(1) + 0.5_dp*motion%pin_speed*e(2), v(2) - 0.5_dp*motion%pin_speed*e(1)]   ! v*/c
    square = e(1)**2 + e(2)**2
    n = [1.0_dp, 0.0_dp]
    if (square > centred) n = e/sqrt(square)
    square = min(square, largest_square)
    b = n(1)*v(1) + n(2)*v(2)
    t = n(1)*v(2) - n(2)*v(1)
  end subroutine reduce

  !> Force over mu L R^3/c^2 along n and t [1/s] for the velocity (B, T) = v*/c [1/s] and a given eps^2.
  pure subroutine reduced_force(self, eps_squared, b, t, radial, tangential)
    class(finite_bearing_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: radial, tangential
    type(film_answer_t) :: film
    real(dp) :: v
    if (self%map%points > 0) then
      call self%map%force(eps_squared, b, t, radial, tangential)
      return
    end if
    radial = 0
    tangential = 0
    v = sqrt(b**2 + t**2)
    if (.not. v > 0) return
    call solved_film(self%film_points, self%half_length, self%condition, gap_of(eps_squared), atan2(t, b), film)
    radial = v*film%force(1)
    tangential = v*film%force(2)
  end subroutine reduced_force

  !> Largest pressure [Pa], and side flow out of both ends [m^3/s].
  pure subroutine peak_and_flow(self, motion, most, flow)
    class(finite_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: most, flow
    real(dp) :: n(2), square, b, t
    call reduce(self, motion, n, square, b, t)
    call self%reduced_peak_and_flow(square, b, t, most, flow)
    most = self%force_scale/(2*self%half_length*self%pin_radius**2)*most
    flow = self%clearance*self%pin_radius**2*flow
  end subroutine peak_and_flow

  !> Largest pressure over mu R^2/c^2 and side flow over c R^2 [1/s], with the arguments of `reduced_force`.
  pure subroutine reduced_peak_and_flow(self, eps_squared, b, t, most, flow)
    class(finite_bearing_t), intent(in) :: self
    real(dp), intent(in) :: eps_squared, b, t
    real(dp), intent(out) :: most, flow
    type(film_answer_t) :: film
    real(dp) :: v
    if (self%map%points > 0) then
      call self%map%peak_and_flow(eps_squared, b, t, most, flow)
      return
    end if
    most = 0
    flow = 0
    v = sqrt(b**2 + t**2)
    if (.not. v > 0) return
    call solved_film(self%film_points, self%half_length, self%condition, gap_of(eps_squared), atan2(t, b), film)
    most = v*film%most
    flow = v*film%flow
  end subroutine reduced_peak_and_flow

  !> The pressure over half of the bearing [Pa], computed from the Reynolds equation for both variants.
  pure subroutine pressure_field(self, motion, angles, places, field)
    class(finite_bearing_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), allocatable, intent(out) :: angles(:), places(:), field(:, :)
    integer, parameter :: along = 12
    type(film_solver_t) :: solver
    type(film_answer_t) :: answer
    real(dp), allocatable :: inside(:, :)
    real(dp) :: n(2), square, b, t, scale
    call reduce(self, motion, n, square, b, t)
    call solver%begin(field_points, along, gap_of(square), self%half_length)
    call solver%solve(atan2(t, b), self%condition, .false., answer)
    call solver%pressure_at(angles, places, inside)
    scale = self%force_scale/(2*self%half_length*self%pin_radius**2)*sqrt(b**2 + t**2)
    places = [places/self%half_length, 1.0_dp]
    allocate (field(size(angles), size(places)), source=0.0_dp)
    field(:, :along) = scale*inside
  end subroutine pressure_field

  !> 1 - eps, limited to the range in which the equation is solved.
  pure real(dp) function gap_of(eps_squared)
    real(dp), intent(in) :: eps_squared
    gap_of = max((1 - eps_squared)/(1 + sqrt(eps_squared)), least_gap)
  end function gap_of
end module finite_bearing
