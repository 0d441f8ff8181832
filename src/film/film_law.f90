!> What every lubricating film answers.
module film_law
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use gudgeon_parameters, only: law_t, parameter_list_t
  use gudgeon_bearing, only: bearing_t
  use gudgeon_archive, only: archive_t
  use reynolds_grid, only: reynolds_grid_t, new_reynolds_grid
  implicit none
  private
  public :: film_law_t, film_motion_t, table_watch_t, difference_derivatives, difference_steps, moved, angles_of_film, field_points

  integer, parameter :: field_points = 128   !! angles of a pressure field

  !> Somebody who waits for a table to be made.
  type, abstract :: table_watch_t
    logical :: wants_to_stop = .false.   !! the table is not to be made
  contains
    procedure(row_done), deferred :: row_done
  end type table_watch_t

  !> The motion of the pin in its bearing, as far as a film needs it.
  type :: film_motion_t
    real(dp) :: eccentricity(2)          !! e = pin centre - bearing centre [m], |e| < c
    real(dp) :: eccentricity_rate(2)     !! de/dt [m/s]
    real(dp) :: pin_speed                !! of both surfaces together, which draws the film along, x towards y [rad/s]
    real(dp) :: turning_speed = 0        !! angular velocity of the pin's surface against the bearing's [rad/s]
    real(dp) :: ideal_pin_speed = 0      !! the same of the ideal-joint mechanism at (q, qdot) [rad/s]
    real(dp) :: ideal_pin_acceleration = 0 !! its rate at constant crank speed [rad/s^2]
    real(dp) :: frequency = 0            !! |qdot|, oscillation frequency of the pin [rad/s]
  end type film_motion_t

  !> A film that carries the pin while it does not touch the bearing.
  type, abstract, extends(law_t) :: film_law_t
    real(dp) :: clearance = 1                 !! c, radial [m]
    real(dp) :: per_clearance = 1             !! 1/c [1/m]
    logical :: needs_ideal_motion = .false.   !! whether the ideal_* fields and the frequency are read
    logical :: film_moment = .false.          !! its shear acts on the pin
    real(dp) :: viscosity = 0                 !! mu, dynamic [Pa s], > 0
    real(dp) :: least_film_ratio = 0          !! the film is taken no thinner than this part of the clearance, where it is held [-]
    logical :: singular_at_wall = .true.      !! the force is infinite at |e| = c: the state may not reach it
    character(len=:), allocatable :: table_file   !! where the user wants the table, from the case's folder; or empty
    character(len=100) :: table_of = ''       !! the `table_key` of the table that the law has; empty: it has none
    real(dp) :: table_error = 0               !! of the force in it, relative: the largest measured when it was made [-]
    real(dp) :: table_mean_error = 0          !! root of the mean square of the same [-]
  contains
    procedure(prepare), deferred :: prepare
    procedure(film_force), deferred :: film_force
    procedure :: force_derivatives => difference_derivatives
    procedure, non_overridable :: add_viscosity
    procedure :: take_oil
    procedure, non_overridable :: add_least_film
    procedure, non_overridable :: shear_moment
    procedure, non_overridable :: shear_moment_slopes
    procedure :: is_quasi_static => no
    procedure :: gives_pressure => no
    procedure :: gives_side_flow => no
    procedure :: drag_moment => none
    procedure :: pressure => nowhere
    procedure :: peak_and_flow => peak_without_flow
    procedure :: pressure_field => long_field
    procedure :: table_key => no_key
    procedure :: make_table => no_table
    procedure :: exchange_table => nothing_to_exchange
  end type film_law_t

  abstract interface
    !> `done` of `rows` rows of the table are there. One thread calls at a time.
    subroutine row_done(self, done, rows)
      import :: table_watch_t
      class(table_watch_t), intent(inout) :: self
      integer, intent(in) :: done, rows
    end subroutine row_done

    !> Find what follows from the parameters and the bearing, before the first force is asked for. What the law sums or
    !> tabulates is to be finer than `tolerance`, the relative tolerance of the run.
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

  !> The viscosity, which every law has, unless an oil at a temperature gives it.
  subroutine add_viscosity(self, list)
    class(film_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('viscosity', self%viscosity, 'dynamic viscosity; required unless viscosity_law gives it', 'Pa s', '> 0', &
      default='0.0', example='0.0117')
  end subroutine add_viscosity

  !> The viscosity of an oil, before the law is prepared.
  subroutine take_oil(self, viscosity, kinematic_viscosity)
    class(film_law_t), intent(inout) :: self
    real(dp), intent(in) :: viscosity             !! [Pa s]
    real(dp), intent(in) :: kinematic_viscosity   !! [m^2/s]
    associate (unused => kinematic_viscosity)
    end associate
    self%viscosity = viscosity
  end subroutine take_oil

  !> The parameter that says where a film is held, with any law that can be.
  subroutine add_least_film(self, list)
    class(film_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('least_film_ratio', self%least_film_ratio, &
      'smallest thickness of an oscillating or weighted film, as a fraction of the clearance', range='>= 0.000001 and <= 0.5', &
      default='0.001')
  end subroutine add_least_film

  !> Moment of the film on the pin about its centre [N m] of the shear u = U y/h + y (y - h) p'/(2 mu) in a film whose pressure
  !> gives `force`: -2 pi mu omega R^3 L/(c sqrt(1 - eps^2)) - e x F/2. (The gap counts as full, where the film has ruptured too.)
  !> With it the power that a film of pressure takes is never negative.
  pure real(dp) function shear_moment(self, force_scale, motion, force) result(moment)
    class(film_law_t), intent(in) :: self
    real(dp), intent(in) :: force_scale   !! mu L R^3/c^2 [N s]
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(2)
    real(dp) :: square
    associate (e => motion%eccentricity)
      square = min((e(1)**2 + e(2)**2)*self%per_clearance**2, 1 - 2*epsilon(1.0_dp))
      moment = -two_pi*force_scale*self%clearance*motion%turning_speed/sqrt(1 - square) - 0.5_dp*(e(1)*force(2) - e(2)*force(1))
    end associate
  end function shear_moment

  !> Derivatives of `shear_moment` by e_x, e_y, e_x', e_y' and the pin speed, with those of the force (rows F_x, F_y).
  pure function shear_moment_slopes(self, force_scale, motion, force, force_slopes) result(slopes)
    class(film_law_t), intent(in) :: self
    real(dp), intent(in) :: force_scale   !! mu L R^3/c^2 [N s]
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(2), force_slopes(:, :)
    real(dp) :: slopes(5), gap, drag
    associate (e => motion%eccentricity)
      gap = 1 - min((e(1)**2 + e(2)**2)*self%per_clearance**2, 1 - 2*epsilon(1.0_dp))
      drag = -two_pi*force_scale*self%clearance/sqrt(gap)
      slopes = -0.5_dp*(e(1)*force_slopes(2, :5) - e(2)*force_slopes(1, :5))
      slopes(:2) = slopes(:2) + drag*motion%turning_speed*e*self%per_clearance**2/gap - 0.5_dp*[force(2), -force(1)]
      slopes(5) = slopes(5) + drag
    end associate
  end function shear_moment_slopes

  !> Whether the force is in proportion to v* = e' - (omega/2) z x e, depends on nothing else of the motion and is against it;
  !> whether the law has a pressure above that at the film's ends, and a flow out of these. The default is none of it.
  pure logical function no(self)
    class(film_law_t), intent(in) :: self
    associate (unused => self)
    end associate
    no = .false.
  end function no

  !> Moment of the film on the pin [N m] that the law leaves out of `film_force` where `film_moment` is .false.
  pure real(dp) function none(self, motion, force)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(2)   !! of the film on the pin [N]
    associate (unused => self, unused_too => motion, also_unused => force)
    end associate
    none = 0
  end function none

  !> Pressure in the middle of the film [Pa], where the law has it in closed form, at the angle theta [rad] from the thinnest place
  !> (the direction of the eccentricity), x towards y.
  pure real(dp) function nowhere(self, motion, theta)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta
    associate (unused => self, unused_too => motion, also_unused => theta)
    end associate
    nowhere = 0
  end function nowhere

  !> Largest pressure [Pa], and the flow out of both ends [m^3/s]. The default is the largest of `pressure`.
  pure subroutine peak_without_flow(self, motion, most, flow)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: most, flow
    real(dp) :: eps
    flow = 0
    eps = min(norm2(motion%eccentricity)*self%per_clearance, 1 - epsilon(1.0_dp))
    most = max(largest_pressure(self, motion, 1.0_dp), largest_pressure(self, motion, sqrt((1 - eps)/(1 + eps))))
  end subroutine peak_without_flow

  !> The pressure over half of the bearing [Pa], (angles, places): at angles [rad] from the direction of the eccentricity and places
  !> from the middle (0) to the end (1). The default is that of a long film, the same everywhere along it.
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

  !> Angles round a film [rad], dense where it is thin.
  pure function angles_of_film(motion, per_clearance) result(angles)
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: per_clearance   !! 1/c [1/m]
    real(dp), allocatable :: angles(:)
    real(dp), parameter :: least_gap = 1e-6_dp
    type(reynolds_grid_t) :: grid
    grid = new_reynolds_grid(field_points, 2, max(1 - norm2(motion%eccentricity)*per_clearance, least_gap), 1.0_dp, 0.0_dp)
    angles = grid%angle
  end function angles_of_film

  !> The largest of `pressure` at angles theta, tan(theta/2) = scale tan(s/2), uniform in s, and round the best of them.
  pure real(dp) function largest_pressure(self, motion, scale) result(most)
    class(film_law_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: scale
    integer, parameter :: first_places = 90, thirds = 40
    real(dp) :: at(0:3), value
    integer :: i, best
    most = -huge(most)
    best = 0
    do i = 1, first_places
      value = at_place(two_pi*i/first_places)
      if (value > most) best = i
      most = max(most, value)
    end do
    at(0) = two_pi*(best - 1)/first_places
    at(3) = two_pi*(best + 1)/first_places
    do i = 1, thirds
      at(1:2) = at(0) + (at(3) - at(0))*[1, 2]/3
      if (at_place(at(1)) > at_place(at(2))) then
        at(3) = at(2)
      else
        at(0) = at(1)
      end if
    end do
    most = max(most, at_place(at(1)))

  contains

    pure real(dp) function at_place(s)
      real(dp), intent(in) :: s
      at_place = self%pressure(motion, 2*atan2(scale*sin(0.5_dp*s), cos(0.5_dp*s)))
    end function at_place
  end function largest_pressure

  !> What the law's table is to be of, where it needs one that takes long to make: laws with the same key have the same table.
  !> Somebody may keep it (`exchange_table`) and put it there, with its key in `table_of`, before it is made.
  function no_key(self, bearing, tolerance) result(key)
    class(film_law_t), intent(in) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    character(len=:), allocatable :: key
    associate (unused => self, unused_too => bearing, also_unused => tolerance)
    end associate
    key = ''
  end function no_key

  !> Make the table where the law has none, or one of something else: its bearing may have changed since. Without a table the law
  !> does what it takes at every evaluation. If `watch` wants to stop, there is none.
  subroutine no_table(self, bearing, tolerance, watch)
    class(film_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    class(table_watch_t), intent(inout), optional :: watch
    associate (unused => self, unused_too => bearing, also_unused => tolerance, unused_as_well => watch)
    end associate
  end subroutine no_table

  !> The table, to or from an archive.
  subroutine nothing_to_exchange(self, archive)
    class(film_law_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    associate (unused => self, unused_too => archive)
    end associate
  end subroutine nothing_to_exchange

  !> Derivatives of the force and the moment (rows F_x, F_y, moment) by e_x, e_y, e_x', e_y' and the pin speed (columns), for
  !> implicit integration. The default is central differences; what else the law depends on is left out, since it
  !> changes with the crank, not with the film.
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

  !> Steps of central differences by e_x, e_y [m], e_x', e_y' [m/s] and the pin speed [rad/s].
  pure function difference_steps(clearance, room, motion) result(step)
    real(dp), intent(in) :: clearance   !! [m]
    real(dp), intent(in) :: room        !! over which the force changes [m]
    type(film_motion_t), intent(in) :: motion
    real(dp) :: step(5)
    real(dp) :: rate
    rate = norm2(motion%eccentricity_rate) + clearance*abs(motion%pin_speed) + tiny(1.0_dp)**0.25_dp
    step = 1e-5_dp*[room, room, rate*room/clearance, rate*room/clearance, rate/clearance]
  end function difference_steps

  !> A motion that differs in one of e_x, e_y, e_x', e_y' and the pin speed.
  pure type(film_motion_t) function moved(motion, which, by)
    type(film_motion_t), intent(in) :: motion
    integer, intent(in) :: which    !! of the five, 1 to 5
    real(dp), intent(in) :: by
    moved = motion
    select case (which)
    case (1, 2)
      moved%eccentricity(which) = moved%eccentricity(which) + by
    case (3, 4)
      moved%eccentricity_rate(which - 2) = moved%eccentricity_rate(which - 2) + by
    case default
      moved%pin_speed = moved%pin_speed + by
      moved%turning_speed = moved%turning_speed + by
    end select
  end function moved
end module film_law
