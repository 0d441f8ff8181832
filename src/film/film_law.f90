!> Interface of all lubricating films.
module film_law
  use kinds, only: dp
  use constants, only: two_pi
  use model_parameters, only: law_t, parameter_list_t
  use bearing_size, only: bearing_t
  use reynolds_grid, only: reynolds_grid_t, new_reynolds_grid
  implicit none
  private
  public :: film_law_t, film_motion_t, table_watch_t, difference_derivatives, difference_steps, moved, angles_of_film, &
    field_points, yes

  integer, parameter :: field_points = 128   !! number of angles of a pressure field

  !> Receiver of the progress of a table, which can stop its computation.
  type, abstract :: table_watch_t
    logical :: wants_to_stop = .false.   !! stop the computation
  contains
    procedure :: begins => nothing   !! the computation begins, in which no text is touched until it `ends`
    procedure(row_done), deferred :: row_done
    procedure :: ends => nothing
  end type table_watch_t

  !> The motion of the pin in its bearing on which film forces depend.
  type :: film_motion_t
    real(dp) :: eccentricity(2)          !! e = pin centre - bearing centre [m], |e| < c
    real(dp) :: eccentricity_rate(2)     !! de/dt [m/s]
    real(dp) :: pin_speed  !! sum of the angular speeds of both surfaces, which entrains the film, positive from x to y [rad/s]
    real(dp) :: turning_speed = 0        !! angular speed of the pin relative to the bearing [rad/s]
    real(dp) :: ideal_pin_speed = 0      !! pin_speed of the mechanism with ideal joints at (q, qdot) [rad/s]
    real(dp) :: ideal_pin_acceleration = 0 !! its rate at constant crank speed [rad/s^2]
    real(dp) :: frequency = 0            !! |qdot|, oscillation frequency of the pin [rad/s]
  end type film_motion_t

  !> A film that carries the pin while it is not in contact with the bearing.
  type, abstract, extends(law_t) :: film_law_t
    real(dp) :: clearance = 1                 !! c, radial [m]
    real(dp) :: per_clearance = 1             !! 1/c [1/m]
    real(dp) :: force_scale = 0               !! mu L R^3/c^2 of a law with a pressure [N s]
    logical :: needs_ideal_motion = .false.   !! the law uses the ideal_* components and the frequency
    logical :: film_moment = .false.          !! the shear of the film acts on the pin
    real(dp) :: viscosity = 0                 !! mu, dynamic [Pa s], > 0
    real(dp) :: kinematic_viscosity = 0       !! nu, of a law with inertia [m^2/s], > 0
    real(dp) :: thinning_ratio = 1            !! viscosity at a large shear rate over that at rest; 1: no shear thinning [-]
    real(dp) :: thinning_speed = 0            !! turning speed of a centred pin that loses half of the difference [rad/s]
    real(dp) :: least_film_ratio = 0          !! smallest film thickness over clearance of a law that limits it [-]
    logical :: singular_at_wall = .true.      !! the force has no bound at |e| = c, which the state must not reach
    character(len=:), allocatable :: table_file  !! file for the table chosen by the user, relative to the folder of the case; or
                                                 !! empty
    character(len=100) :: table_of = ''       !! `table_key` of the present table; empty if there is none
    real(dp) :: table_error = 0               !! largest relative error of the force found when the table was made [-]
    real(dp) :: table_mean_error = 0          !! root-mean-square of that error [-]
    real(dp) :: table_time = 0                !! time that it took to compute the table, or to read it [s]
  contains
    procedure(prepare), deferred :: prepare
    procedure(film_force), deferred :: film_force
    procedure :: force_derivatives => difference_derivatives
    procedure, non_overridable :: thinning
    procedure, non_overridable :: thinning_slopes
    procedure, non_overridable :: loads
    procedure, non_overridable :: load_slopes
    procedure, non_overridable :: add_viscosity
    procedure, non_overridable :: add_least_film
    procedure, non_overridable :: shear_moment
    procedure, non_overridable :: shear_moment_slopes
    procedure :: is_quasi_static
    procedure, nopass :: gives_pressure => no
    procedure, nopass :: is_of_long_bearings => no
    procedure :: conserves_oil
    procedure, nopass :: gives_side_flow => no
    procedure :: longest_bearing => of_any_length
    procedure, non_overridable :: drag_moment
    procedure, non_overridable :: neglects_shear
    procedure :: pressure => nowhere
    procedure :: peak_and_flow => no_peak
    procedure :: side_flow => flow_beside_peak
    procedure :: pressure_field => long_field
    procedure :: table_key => no_key
    procedure :: make_table => no_table
    procedure :: table_numbers => no_numbers
    procedure :: restore_table => no_restored_table
  end type film_law_t

  abstract interface
    !> `done` of `rows` rows of the table are complete. Only one thread calls at a time.
    subroutine row_done(self, done, rows)
      import :: table_watch_t
      class(table_watch_t), intent(inout) :: self
      integer, intent(in) :: done, rows
    end subroutine row_done

    !> Prepare the law for a bearing, before the first evaluation of the force. Sums and tables of the law are made more accurate
    !> than `tolerance`, the relative tolerance of the run.
    subroutine prepare(self, bearing, tolerance)
      import :: film_law_t, bearing_t, dp
      class(film_law_t), intent(inout) :: self
      type(bearing_t), intent(in) :: bearing
      real(dp), intent(in) :: tolerance
    end subroutine prepare

    !> Force of the film on the pin [N] in x and y, and its moment on the pin about the pin centre [N m], x towards y.
    pure subroutine film_force(self, motion, force, moment)
      import :: film_law_t, film_motion_t, dp
      class(film_law_t), intent(in) :: self
      type(film_motion_t), intent(in) :: motion
      real(dp), intent(out) :: force(2)
      real(dp), intent(out) :: moment
    end subroutine film_force
  end interface

contains

  !> Ratio of the viscosity to that at rest, of an oil that shear thins (Cross 1965 with the exponent 1): r + (1 - r)/(1 + g/g_c),
  !> with the mean rate g = |omega| R/(c sqrt(1 - eps^2)) of the shear that the turning of the pin makes. It is the same in the
  !> whole film; the shear of the pressure flow, and of the squeeze motion, is left out.
  pure real(dp) function thinning(self, motion)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    thinning = 1
    if (self%thinning_ratio < 1) thinning = self%thinning_ratio + (1 - self%thinning_ratio)/(1 + shear_of(self, motion))
  end function thinning

  !> g/g_c, see `thinning` [-].
  pure real(dp) function shear_of(self, motion) result(shear)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    shear = abs(motion%turning_speed)/(self%thinning_speed*sqrt(gap_of(self, motion)))
  end function shear_of

  !> 1 - eps^2, > 0.
  pure real(dp) function gap_of(self, motion) result(gap)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    gap = 1 - min(sum(motion%eccentricity**2)*self%per_clearance**2, 1 - 2*epsilon(1.0_dp))
  end function gap_of

  !> Derivatives of `thinning` with respect to e_x, e_y [1/m] and the turning speed [s].
  pure function thinning_slopes(self, motion) result(slopes)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp) :: slopes(3), shear, by_shear
    slopes = 0
    if (.not. self%thinning_ratio < 1) return
    shear = shear_of(self, motion)
    by_shear = -(1 - self%thinning_ratio)/(1 + shear)**2
    slopes(:2) = by_shear*shear*motion%eccentricity*self%per_clearance**2/gap_of(self, motion)
    slopes(3) = by_shear*sign(1/(self%thinning_speed*sqrt(gap_of(self, motion))), motion%turning_speed)
  end function thinning_slopes

  !> Force and moment of the film, as `film_force`, for a viscosity that is `ratio` times that of the law and thins with the shear.
  pure subroutine loads(self, motion, ratio, force, moment)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: ratio
    real(dp), intent(out) :: force(2), moment
    real(dp) :: factor
    call self%film_force(motion, force, moment)
    factor = ratio*self%thinning(motion)
    force = factor*force
    moment = factor*moment
  end subroutine loads

  !> Make the derivatives of force and moment (rows F_x, F_y, moment) with respect to e_x, e_y, e_x', e_y' and the angular speeds of
  !> pin and bearing (columns) from those of the law those of `loads`.
  pure subroutine load_slopes(self, motion, ratio, slopes)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: ratio
    real(dp), intent(inout) :: slopes(3, 6)
    real(dp) :: whole(3), thin(3)
    slopes = ratio*self%thinning(motion)*slopes
    if (.not. self%thinning_ratio < 1) return
    call self%film_force(motion, whole(:2), whole(3))
    whole = ratio*whole
    thin = self%thinning_slopes(motion)
    slopes(:, 1) = slopes(:, 1) + whole*thin(1)
    slopes(:, 2) = slopes(:, 2) + whole*thin(2)
    slopes(:, 5) = slopes(:, 5) + whole*thin(3)
    slopes(:, 6) = slopes(:, 6) - whole*thin(3)
  end subroutine load_slopes

  !> Declare the parameter viscosity, which all laws have. It is not required if the viscosity is that of an oil at a temperature.
  subroutine add_viscosity(self, list)
    class(film_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('viscosity', self%viscosity, 'dynamic viscosity; required unless viscosity_law gives it', 'Pa s', '> 0', &
      default='0.0', example='0.0117', usual='1e-4 to 1')
  end subroutine add_viscosity

  !> Declare the parameter that limits the film thickness, for all laws that can do so.
  subroutine add_least_film(self, list)
    class(film_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('least_film_ratio', self%least_film_ratio, &
      'smallest thickness of an oscillating or weighted film, as a fraction of the clearance', range='>= 0.000001 and <= 0.5', &
      default='0.001', usual='1e-5 to 0.1')
  end subroutine add_least_film

  !> Moment of the film on the pin about the pin's centre [N m] from the shear u = U y/h + y (y - h) p'/(2 mu) of a film whose
  !> pressure gives `force`: -2 pi mu omega R^3 L/(c sqrt(1 - eps^2)) - e x F/2. (The gap is assumed to be full of oil even where
  !> the film has ruptured.) With this moment the power dissipated by a film with pressure is never negative.
  pure real(dp) function shear_moment(self, motion, force) result(moment)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(2)
    real(dp) :: square
    associate (e => motion%eccentricity)
      square = min((e(1)**2 + e(2)**2)*self%per_clearance**2, 1 - 2*epsilon(1.0_dp))
      moment = -two_pi*self%force_scale*self%clearance*motion%turning_speed/sqrt(1 - square) &
        - 0.5_dp*(e(1)*force(2) - e(2)*force(1))
    end associate
  end function shear_moment

  !> Derivatives of `shear_moment` with respect to e_x, e_y, e_x', e_y' and the pin speed, from those of the force (rows F_x, F_y).
  pure function shear_moment_slopes(self, motion, force, force_slopes) result(slopes)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(2), force_slopes(:, :)
    real(dp) :: slopes(5), gap, drag
    associate (e => motion%eccentricity)
      gap = 1 - min((e(1)**2 + e(2)**2)*self%per_clearance**2, 1 - 2*epsilon(1.0_dp))
      drag = -two_pi*self%force_scale*self%clearance/sqrt(gap)
      slopes = -0.5_dp*(e(1)*force_slopes(2, :5) - e(2)*force_slopes(1, :5))
      slopes(:2) = slopes(:2) + drag*motion%turning_speed*e*self%per_clearance**2/gap - 0.5_dp*[force(2), -force(1)]
      slopes(5) = slopes(5) + drag
    end associate
  end function shear_moment_slopes

  !> Whether the force is proportional to v* = e' - (omega/2) z x e, opposes it and depends on no other motion. By default this
  !> holds for the laws that give a pressure.
  pure logical function is_quasi_static(self)
    class(film_law_t), intent(in) :: self
    is_quasi_static = self%gives_pressure()
  end function is_quasi_static

  !> Whether the film that is marched after a run balances its oil, or else ruptures by Reynolds' condition, for comparison.
  pure logical function conserves_oil(self)
    class(film_law_t), intent(in) :: self
    conserves_oil = .true.
  end function conserves_oil

  !> Properties of a law: whether it gives a pressure relative to that at the ends of the film, and a side flow. The default is
  !> `no`.
  pure logical function no()
    no = .false.
  end function no

  pure logical function yes()
    yes = .true.
  end function yes

  !> Largest length over diameter of a bearing for which the equation of the law can be solved.
  pure real(dp) function of_any_length(self)
    class(film_law_t), intent(in) :: self
    of_any_length = huge(of_any_length)
  end function of_any_length

  !> Whether the shear of a film with a pressure has a moment that the case neglects.
  pure logical function neglects_shear(self)
    class(film_law_t), intent(in) :: self
    neglects_shear = self%gives_pressure() .and. .not. self%film_moment
  end function neglects_shear

  !> Moment of the film on the pin [N m] that `film_force` does not include if `film_moment` is .false.: that of the shear of a film
  !> with a pressure.
  pure real(dp) function drag_moment(self, motion, force)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(2)   !! of the film on the pin [N]
    drag_moment = 0
    if (self%gives_pressure()) drag_moment = self%shear_moment(motion, force)
  end function drag_moment

  !> Pressure in the middle plane of the film [Pa], for laws with a closed form, at the angle theta [rad] from the thinnest film
  !> (the direction of the eccentricity), positive from x to y.
  pure real(dp) function nowhere(self, motion, theta)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta
    nowhere = 0
  end function nowhere

  !> Largest pressure [Pa], and side flow out of both ends [m^3/s]: none of laws that do not give a pressure.
  pure subroutine no_peak(self, motion, most, flow)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: most, flow
    most = 0
    flow = 0
  end subroutine no_peak

  !> Side flow out of both ends [m^3/s], 0 for laws that do not give it.
  pure real(dp) function flow_beside_peak(self, motion) result(flow)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp) :: most
    flow = 0
    if (self%gives_side_flow()) call self%peak_and_flow(motion, most, flow)
  end function flow_beside_peak

  !> The pressure over half of the bearing [Pa], (angles, places): at angles [rad] from the direction of the eccentricity, and axial
  !> positions from the middle (0) to the end (1). The default is a long film, whose pressure is constant along the axis.
  pure subroutine long_field(self, motion, angles, places, field)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), allocatable, intent(out) :: angles(:), places(:), field(:, :)
    integer :: i
    places = [0.0_dp, 1.0_dp]
    angles = angles_of_film(motion, self%per_clearance)
    allocate (field(size(angles), size(places)))
    do i = 1, size(angles)
      field(i, :) = self%pressure(motion, angles(i))
    end do
  end subroutine long_field

  !> Angles around a film [rad], denser where the film is thin.
  pure function angles_of_film(motion, per_clearance) result(angles)
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: per_clearance   !! 1/c [1/m]
    real(dp), allocatable :: angles(:)
    real(dp), parameter :: least_gap = 1e-6_dp
    type(reynolds_grid_t) :: grid
    grid = new_reynolds_grid(field_points, 2, max(1 - norm2(motion%eccentricity)*per_clearance, least_gap), 1.0_dp, 0.0_dp)
    angles = grid%angle
  end function angles_of_film

  !> What a watch does at the beginning and the end of a computation, unless it says otherwise.
  subroutine nothing(self)
    class(table_watch_t), intent(inout) :: self
  end subroutine nothing

  !> Key of the law's table, for laws whose table takes long to compute: laws with equal keys have equal tables. A stored table may
  !> be set (`restore_table`), together with its key in `table_of`, before `make_table` is called.
  function no_key(self, bearing, tolerance) result(key)
    class(film_law_t), intent(in) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    character(len=:), allocatable :: key
    key = ''
  end function no_key

  !> Compute the table if the law has none, or one with another key since its bearing has changed. Without a table the law computes
  !> its force at every evaluation. If `watch` asks to stop, there is no table.
  subroutine no_table(self, bearing, tolerance, watch)
    class(film_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    class(table_watch_t), intent(inout), optional :: watch
  end subroutine no_table

  !> The table as numbers, to be stored.
  pure function no_numbers(self) result(numbers)
    class(film_law_t), intent(in) :: self
    real(dp), allocatable :: numbers(:)
    allocate (numbers(0))
  end function no_numbers

  !> Restore a stored table; `fits` is false if the numbers are not those of a table of this law.
  subroutine no_restored_table(self, numbers, fits)
    class(film_law_t), intent(inout) :: self
    real(dp), intent(in) :: numbers(:)
    logical, intent(out) :: fits
    fits = .false.
  end subroutine no_restored_table

  !> Derivatives of the force and the moment (rows F_x, F_y, moment) with respect to e_x, e_y, e_x', e_y' and the pin speed
  !> (columns), for implicit integration. The default is central differences. Other dependencies are left out, since they change
  !> with the crank angle and not with the film.
  pure subroutine difference_derivatives(self, motion, derivatives)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    type(film_motion_t) :: other
    real(dp) :: step(5), above(3), below(3)
    integer :: i

    step = difference_steps(self%clearance, max(self%clearance - norm2(motion%eccentricity), 1e-6_dp*self%clearance), motion)
    do i = 1, 5
      other = moved(motion, i, step(i))
      call self%film_force(other, above(1:2), above(3))
      other = moved(motion, i, -step(i))
      call self%film_force(other, below(1:2), below(3))
      derivatives(:, i) = (above - below)/(2*step(i))
    end do
  end subroutine difference_derivatives

  !> Increments of central differences for e_x, e_y [m], e_x', e_y' [m/s] and the pin speed [rad/s].
  pure function difference_steps(clearance, room, motion) result(step)
    real(dp), intent(in) :: clearance   !! [m]
    real(dp), intent(in) :: room        !! length over which the force changes [m]
    type(film_motion_t), intent(in) :: motion
    real(dp) :: step(5)
    real(dp) :: rate
    rate = norm2(motion%eccentricity_rate) + clearance*abs(motion%pin_speed) + tiny(1.0_dp)**0.25_dp
    step = 1e-5_dp*[room, room, rate*room/clearance, rate*room/clearance, rate/clearance]
  end function difference_steps

  !> The motion with a change of one of e_x, e_y, e_x', e_y' and the angular speeds of pin and bearing.
  pure type(film_motion_t) function moved(motion, which, by)
    type(film_motion_t), intent(in) :: motion
    integer, intent(in) :: which    !! number of the changed quantity, 1 to 6
    real(dp), intent(in) :: by
    moved = motion
    select case (which)
    case (1, 2)
      moved%eccentricity(which) = moved%eccentricity(which) + by
    case (3, 4)
      moved%eccentricity_rate(which - 2) = moved%eccentricity_rate(which - 2) + by
    case default
      moved%pin_speed = moved%pin_speed + by
      moved%turning_speed = moved%turning_speed + merge(by, -by, which == 5)
    end select
  end function moved
end module film_law
