!> Load element: a film between elastic walls, in its simplest form: the walls are a spring in series with the film.
!>
!> The film has its own eccentricity e_f, a state of the element. The rest of the pin's eccentricity, d = e - e_f, is the deflection
!> of the walls. Their force f(|d|) d/|d| is the load on the film; f is the elastic force of a contact geometry. The eccentricity
!> e_f changes with the velocity at which the film carries this load (`film_mobility`):
!>
!>     e_f' = v*(e_f, load) + (omega/2) z x e_f
!>
!> Nothing is singular where |e| exceeds the clearance, and no equation has to be solved for the force. The work on the joint is the
!> loss in the film, load . e_f', plus the change of the elastic energy of the walls. With `pressure_viscosity` the whole film has
!> the viscosity mu exp(alpha p) (Barus) at its mean pressure p = load/(2 R L).
module elastic_film
  use kinds, only: dp
  use trace_row, only: trace_row_t
  use contact_geometry, only: contact_geometry_t
  use film_law, only: film_motion_t
  use film_mobility, only: driven_velocity
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, most_element_states
  use load_element, only: n_slopes, n_motions, by_pin_speed, by_bearing_speed
  use film_figures, only: add_film_force, add_film_figures
  use oil_film, only: oil_film_t, film_motion_of, unit_drag
  implicit none
  private
  public :: elastic_film_t, wall_load, wall_deflection

  type, extends(oil_film_t) :: elastic_film_t
    real(dp) :: pressure_viscosity = 0     !! alpha [1/Pa]
    real(dp), private :: per_area = 0      !! 1/(2 R L) [1/m^2]
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: find_slopes
    procedure :: find_gap
    procedure :: add_columns
    procedure :: see_film
    procedure :: carry
    procedure :: velocity
  end type elastic_film_t

contains

  subroutine prepare(self, wanted, tolerance, makes_tables)
    class(elastic_film_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    call self%prepare_film(wanted, tolerance, makes_tables)
    allocate (self%walls, source=wanted%contact%geometry)
    call self%walls%prepare(self%bearing)
    self%pressure_viscosity = wanted%elastic%pressure_viscosity
    self%per_area = 1/(2*self%bearing%pin_radius()*self%bearing%length)
    self%is_unbounded = .false.
    self%has_own_gap = .true.
    self%n_states = 2   ! e_f
    self%state_name = 'film_eccentricity'
    self%state_unit = 'm'
    self%state_scale = self%bearing%clearance
    self%state_reach = self%bearing%clearance
  end subroutine prepare

  !> The force of the walls, and the rate of the film's eccentricity under this load.
  pure subroutine find_loads(self, y, joint)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    associate (e => y(self%states%first:self%states%last), drawn => 0.5_dp*(joint%pin_angular_speed + joint%bearing_speed))
      joint%film = -wall_load(self%walls, joint%eccentricity - e)
      joint%rates = self%velocity(e, -joint%film, joint%viscosity_ratio) + drawn*[-e(2), e(1)]
      joint%moment = 0
      if (self%film%film_moment) joint%moment = &
        moment(self, motion_of_film(self, joint, e), -joint%film, joint%viscosity_ratio)
    end associate
    joint%force = joint%film
  end subroutine find_loads

  !> The load is that of the walls, whose deflection follows from it; the film moves as between rigid walls. The rate of the
  !> deflection is left out of the rate of the eccentricity.
  pure subroutine carry(self, place, load, joint)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: place(2), load(2)
    type(joint_evaluation_t), intent(inout) :: joint
    joint%states = place
    joint%rates = self%velocity(place, load, joint%viscosity_ratio) &
      + 0.5_dp*(joint%pin_angular_speed + joint%bearing_speed)*[-place(2), place(1)]
    joint%eccentricity = place + wall_deflection(self%walls, load)
    joint%eccentricity_rate = joint%rates
    joint%film = -load
    joint%force = -load
    joint%moment = 0
    if (self%film%film_moment) joint%moment = moment(self, motion_of_film(self, joint, place), load, joint%viscosity_ratio)
  end subroutine carry

  !> The motion on which the force of the film depends: that of the place where the film is.
  pure type(film_motion_t) function motion_of_film(self, joint, e) result(seen)
    type(elastic_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: e(2)   !! e_f [m]
    seen = film_motion_of(self%film, joint)
    seen%eccentricity = e
    seen%eccentricity_rate = joint%rates
  end function motion_of_film

  !> The thickness of the film, which does not follow from the eccentricity of the pin. Its rate does not include the rotation of
  !> the film.
  pure subroutine find_gap(self, y, joint)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp) :: distance
    associate (e => y(self%states%first:self%states%last))
      distance = norm2(e)
      joint%penetration = distance - self%bearing%clearance
      joint%penetration_rate = 0
      if (distance > 0 .and. distance < self%bearing%clearance) joint%penetration_rate = &
        dot_product(e, self%velocity(e, wall_load(self%walls, joint%eccentricity - e), joint%viscosity_ratio))/distance
    end associate
  end subroutine find_gap

  !> Load on the film [N] at the deflection d [m] of the walls.
  pure function wall_load(walls, d) result(load)
    class(contact_geometry_t), intent(in) :: walls
    real(dp), intent(in) :: d(2)
    real(dp) :: load(2)
    real(dp) :: depth
    load = 0
    depth = sqrt(d(1)**2 + d(2)**2)
    if (depth > 0) load = walls%elastic_force(depth)/depth*d
  end function wall_load

  !> Deflection d [m] of the walls under a load [N], by bisection.
  pure function wall_deflection(walls, load) result(d)
    class(contact_geometry_t), intent(in) :: walls
    real(dp), intent(in) :: load(2)
    real(dp) :: d(2)
    real(dp) :: low, high, middle
    integer :: i
    d = 0
    if (.not. norm2(load) > 0) return
    low = 0
    high = 1e-9_dp
    do while (walls%elastic_force(high) < norm2(load) .and. high < 1)
      high = 2*high
    end do
    do i = 1, 60
      middle = 0.5_dp*(low + high)
      if (walls%elastic_force(middle) < norm2(load)) then
        low = middle
      else
        high = middle
      end if
    end do
    d = load*(high/norm2(load))
  end function wall_deflection

  !> Ratio of the viscosity under a load to that without pressure [-].
  pure real(dp) function thickening_of(self, load)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: load(2)   !! [N]
    thickening_of = 1
    if (self%pressure_viscosity > 0) thickening_of = exp(self%pressure_viscosity*self%per_area*norm2(load))
  end function thickening_of

  !> v* [m/s] at an eccentricity of the film under a load.
  pure function velocity(self, e, load, viscosity_ratio)
    class(elastic_film_t), intent(in) :: self
    real(dp), intent(in) :: e(2), load(2)     !! [m], [N]
    real(dp), intent(in) :: viscosity_ratio   !! without pressure, to that of the film law [-]
    real(dp) :: velocity(2)
    call driven_velocity(self%film, e, load/(thickening_of(self, load)*viscosity_ratio), velocity)
  end function velocity

  !> Moment of the film on the pin about the pin's centre [N m]. It equals that about the film's own centre, since the load passes
  !> through both.
  pure real(dp) function moment(self, seen, load, viscosity_ratio)
    type(elastic_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: seen
    real(dp), intent(in) :: load(2), viscosity_ratio
    real(dp) :: factor
    factor = thickening_of(self, load)*viscosity_ratio
    moment = factor*self%film%drag_moment(seen, -load/factor)
  end function moment

  !> The derivatives of the film's velocity follow from those of its force, which is opposite to the load at every instant.
  pure subroutine find_slopes(self, joint, of_loads, of_rates)
    class(elastic_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes)
    integer, parameter :: first = n_motions + 1, last = n_motions + 2
    real(dp) :: wall(2, 2), relieved(2, 2), of_film(3, by_pin_speed), pressing(2), factor, determinant, right(2, n_slopes), &
      drag, by_load(2), d(2)
    type(film_motion_t) :: seen
    seen = motion_of_film(self, joint, joint%states)
    d = joint%eccentricity - joint%states
    pressing = wall_load(self%walls, d)
    wall = wall_slopes(self, d)
    of_loads = 0
    of_loads(1:2, 1:2) = -wall
    of_loads(1:2, first:last) = wall
    factor = thickening_of(self, pressing)*joint%viscosity_ratio
    if (self%film%film_moment) then
      drag = factor*unit_drag(self%film, seen)
      by_load = 0.5_dp*[-seen%eccentricity(2), seen%eccentricity(1)] &
        + drag*seen%turning_speed*self%pressure_viscosity*self%per_area*pressing/max(norm2(pressing), tiny(1.0_dp))
      of_loads(3, 1:2) = matmul(by_load, wall)
      of_loads(3, by_pin_speed) = drag
      of_loads(3, by_bearing_speed) = -drag
      of_loads(3, first:last) = -of_loads(3, 1:2) + 0.5_dp*[pressing(2), -pressing(1)] &
        + drag*seen%turning_speed*seen%eccentricity/(self%bearing%clearance**2 - sum(seen%eccentricity**2))
    end if
    call self%film%force_derivatives(seen, of_film)
    relieved = wall
    if (self%pressure_viscosity > 0) relieved = relieved - self%pressure_viscosity*self%per_area/max(norm2(pressing), &
      tiny(1.0_dp))*spread(pressing, 2, 2)*spread(matmul(pressing, wall), 1, 2)
    relieved = relieved/factor
    right = 0
    right(:, 1:2) = -relieved
    right(:, by_pin_speed) = -of_film(1:2, by_pin_speed)
    right(:, by_bearing_speed) = -of_film(1:2, by_pin_speed)
    right(:, first:last) = relieved - of_film(1:2, 1:2)
    of_rates = 0
    determinant = of_film(1, 3)*of_film(2, 4) - of_film(1, 4)*of_film(2, 3)
    if (.not. abs(determinant) > 0) return
    of_rates(1, :) = (of_film(2, 4)*right(1, :) - of_film(1, 4)*right(2, :))/determinant
    of_rates(2, :) = (of_film(1, 3)*right(2, :) - of_film(2, 3)*right(1, :))/determinant
  end subroutine find_slopes

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

  pure subroutine add_columns(self, joint, row)
    class(elastic_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    real(dp) :: deflection, stored
    call add_film_force(joint, row)
    call row%add('film_eccentricity_x[m]', joint%states(1), &
      'eccentricity of the film between elastic walls, along x: eccentricity less wall deflection')
    call row%add('film_eccentricity_y[m]', joint%states(2), 'the same along y')
    deflection = norm2(joint%eccentricity - joint%states)
    call row%add('wall_deflection[m]', deflection, 'elastic deflection of the bearing walls under the film')
    stored = 0
    if (row%wants(1) .and. deflection > 0) stored = self%walls%elastic_energy(deflection)
    call row%add('wall_energy[J]', stored, 'elastic energy stored in the bearing walls')
    call add_film_figures(self, joint, row)
  end subroutine add_columns

  !> The elastic energy of the walls does not belong to the film.
  pure subroutine see_film(self, joint, seen, rate, share, thickening)
    class(elastic_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: rate(2), share, thickening
    seen = motion_of_film(self, joint, joint%states)
    rate = joint%rates
    share = 1
    thickening = thickening_of(self, wall_load(self%walls, joint%eccentricity - joint%states))*joint%viscosity_ratio
  end subroutine see_film
end module elastic_film
