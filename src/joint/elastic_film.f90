!> A film between elastic walls, in its simplest form: the walls are a spring in series with the film.
!>
!> The film has its own eccentricity e_f, a state of the joint. The rest of the pin's eccentricity, d = e - e_f, is the deflection
!> of the walls. Their force f(|d|) d/|d| is the load on the film; f is the elastic force of a contact geometry. The eccentricity
!> e_f changes with the velocity at which the film carries this load (`film_mobility`):
!>
!>     e_f' = v*(e_f, load) + (omega/2) z x e_f
!>
!> Nothing is singular where |e| exceeds the clearance, and no equation has to be solved for the force. The work on the joint is the
!> loss in the film, load . e_f', plus the change of the elastic energy of the walls. With `pressure_viscosity` the whole film has
!> the viscosity mu exp(alpha p) (Barus) at its mean pressure p = load/(2 R L).
module elastic_film
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: has_parameters_t, parameter_list_t
  use gudgeon_bearing, only: bearing_t
  use contact_geometry, only: contact_geometry_t
  use film_law, only: film_law_t, film_motion_t
  use film_mobility, only: driven_velocity
  implicit none
  private
  public :: elastic_film_t, n_film_states

  integer, parameter :: n_film_states = 2   !! e_f

  type, extends(has_parameters_t) :: elastic_film_t
    logical :: is_wanted = .false.
    real(dp) :: pressure_viscosity = 0                     !! alpha [1/Pa]
    class(contact_geometry_t), allocatable :: walls        !! geometry of the group contact
    real(dp) :: per_area = 0                               !! 1/(2 R L) [1/m^2]
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: load
    procedure :: deflection
    procedure :: energy
    procedure :: thickening
    procedure :: velocity
    procedure :: moment
    procedure :: slopes
  end type elastic_film_t

contains

  subroutine parameters(self, list)
    class(elastic_film_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('elastic_film', self%is_wanted, &
      'elastic walls in series with the film; &contact with law = ''hertz'' gives their stiffness', '.false.')
    call list%add('pressure_viscosity', self%pressure_viscosity, &
      'elastic_film: exponential growth of the viscosity with the mean pressure (Barus)', &
      '1/Pa', '>= 0 and <= 1e-6', default='0.0', usual='1e-9 to 1e-7')
  end subroutine parameters

  subroutine prepare(self, bearing)
    class(elastic_film_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    call self%walls%prepare(bearing)
    self%per_area = 1/(2*bearing%pin_radius()*bearing%length)
  end subroutine prepare

  !> Load on the film [N] at the deflection d [m] of the walls.
  pure function load(self, d)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: d(2)
    real(dp) :: load(2)
    real(dp) :: depth
    load = 0
    depth = sqrt(d(1)**2 + d(2)**2)
    if (depth > 0) load = self%walls%elastic_force(depth)/depth*d
  end function load

  !> Deflection d [m] of the walls under a load [N], by bisection.
  pure function deflection(self, load) result(d)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: load(2)
    real(dp) :: d(2)
    real(dp) :: low, high, middle
    integer :: i
    d = 0
    if (.not. norm2(load) > 0) return
    low = 0
    high = 1e-9_dp
    do while (self%walls%elastic_force(high) < norm2(load) .and. high < 1)
      high = 2*high
    end do
    do i = 1, 60
      middle = 0.5_dp*(low + high)
      if (self%walls%elastic_force(middle) < norm2(load)) then
        low = middle
      else
        high = middle
      end if
    end do
    d = load*(high/norm2(load))
  end function deflection

  !> Elastic energy of the walls [J].
  pure real(dp) function energy(self, d)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: d(2)
    energy = 0
    if (norm2(d) > 0) energy = self%walls%elastic_energy(norm2(d))
  end function energy

  !> Ratio of the viscosity under a load to that without pressure [-].
  pure real(dp) function thickening(self, load)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: load(2)   !! [N]
    thickening = 1
    if (self%pressure_viscosity > 0) thickening = exp(self%pressure_viscosity*self%per_area*norm2(load))
  end function thickening

  !> v* [m/s] at an eccentricity of the film under a load.
  pure function velocity(self, film, film_eccentricity, load)
    class(elastic_film_t), intent(in) :: self
    class(film_law_t), intent(in) :: film
    real(dp), intent(in) :: film_eccentricity(2), load(2)
    real(dp) :: velocity(2)
    call driven_velocity(film, film_eccentricity, load/self%thickening(load), velocity)
  end function velocity

  !> Moment of the film on the pin about the pin's centre [N m]. It equals that about the film's own centre, since the load passes
  !> through both.
  pure real(dp) function moment(self, film, motion, load)
    class(elastic_film_t), intent(in) :: self
    class(film_law_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion   !! with the film's own eccentricity
    real(dp), intent(in) :: load(2)
    real(dp) :: factor
    factor = self%thickening(load)
    moment = factor*film%drag_moment(motion, -load/factor)
  end function moment

  !> Derivatives with respect to e, e', the angular speed of the journal and e_f (columns), for implicit integration: of force and
  !> moment on the pin (rows of `of_loads`) and of e_f' (rows of `of_rates`). The derivatives of the film's velocity follow from
  !> those of its force, which is opposite to the load at every instant.
  pure subroutine slopes(self, film, motion, d, has_moment, of_loads, of_rates)
    class(elastic_film_t), intent(in) :: self
    class(film_law_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion   !! with the film's own eccentricity
    real(dp), intent(in) :: d(2)
    logical, intent(in) :: has_moment
    real(dp), intent(out) :: of_loads(3, 7), of_rates(2, 7)
    real(dp) :: wall(2, 2), relieved(2, 2), of_film(3, 5), pressing(2), factor, determinant, right(2, 7), drag, by_load(2)
    type(film_motion_t) :: turning
    pressing = self%load(d)
    wall = wall_slopes(self, d)
    of_loads = 0
    of_loads(1:2, 1:2) = -wall
    of_loads(1:2, 6:7) = wall
    factor = self%thickening(pressing)
    if (has_moment) then
      turning = motion
      turning%turning_speed = 1
      drag = factor*film%drag_moment(turning, [0.0_dp, 0.0_dp])   ! at unit angular speed
      by_load = 0.5_dp*[-motion%eccentricity(2), motion%eccentricity(1)] &
        + drag*motion%turning_speed*self%pressure_viscosity*self%per_area*pressing/max(norm2(pressing), tiny(1.0_dp))
      of_loads(3, 1:2) = matmul(by_load, wall)
      of_loads(3, 5) = drag
      of_loads(3, 6:7) = -of_loads(3, 1:2) + 0.5_dp*[pressing(2), -pressing(1)] + drag*motion%turning_speed*motion%eccentricity &
        /(film%clearance**2 - sum(motion%eccentricity**2))
    end if
    call film%force_derivatives(motion, of_film)
    relieved = wall
    if (self%pressure_viscosity > 0) relieved = relieved - self%pressure_viscosity*self%per_area/max(norm2(pressing), &
      tiny(1.0_dp))*spread(pressing, 2, 2)*spread(matmul(pressing, wall), 1, 2)
    relieved = relieved/factor
    right = 0
    right(:, 1:2) = -relieved
    right(:, 5) = -of_film(1:2, 5)
    right(:, 6:7) = relieved - of_film(1:2, 1:2)
    of_rates = 0
    determinant = of_film(1, 3)*of_film(2, 4) - of_film(1, 4)*of_film(2, 3)
    if (.not. abs(determinant) > 0) return
    of_rates(1, :) = (of_film(2, 4)*right(1, :) - of_film(1, 4)*right(2, :))/determinant
    of_rates(2, :) = (of_film(1, 3)*right(2, :) - of_film(2, 3)*right(1, :))/determinant
  end subroutine slopes

  !> Derivatives of the load with respect to d [N/m].
  pure function wall_slopes(self, d) result(slopes)
    type(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: d(2)
    real(dp) :: slopes(2, 2)
    real(dp) :: depth, force, n(2), across
    slopes = 0
    depth = norm2(d)
    if (.not. depth > 0) return
    n = d/depth
    force = self%walls%elastic_force(depth)
    across = force/depth
    slopes = (self%walls%slope(depth, force) - across)*spread(n, 2, 2)*spread(n, 1, 2)
    slopes(1, 1) = slopes(1, 1) + across
    slopes(2, 2) = slopes(2, 2) + across
  end function wall_slopes
end module elastic_film
