!> Mixed lubrication: a film between rough surfaces in parallel with the contact of their asperities. There is no event at |e| = c.
module mixed_film
  use kinds, only: dp
  use film_law, only: film_law_t, film_motion_t, difference_steps, moved
  use asperities, only: asperities_t
  use film_mobility, only: driven_velocity
  use root_search, only: bracket_t, next_abscissa, narrow
  implicit none
  private
  public :: mixed_forces, mixed_derivatives, motion_in_gap, mixed_velocity

contains

  !> Forces of the film, which acts in the mean gap of the surfaces, and of the asperities, which press the pin towards the centre
  !> and cause friction.
  pure subroutine mixed_forces(film, rough, pin_radius, motion, viscosity_ratio, film_force, film_moment, pressing, friction)
    class(film_law_t), intent(in) :: film
    type(asperities_t), intent(in) :: rough
    real(dp), intent(in) :: pin_radius                 !! [m]
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: viscosity_ratio            !! of the film to that of its law [-]
    real(dp), intent(out) :: film_force(2), film_moment   !! of the film on the pin [N], [N m]
    real(dp), intent(out) :: pressing, friction           !! of the asperities: towards the centre, and along t [N]
    type(film_motion_t) :: seen
    real(dp) :: distance, tangential, pin_angular_speed, bearing_speed
    call see_gap(film, rough, motion, seen, distance, tangential)
    pin_angular_speed = 0.5_dp*(motion%pin_speed + motion%turning_speed)
    bearing_speed = 0.5_dp*(motion%pin_speed - motion%turning_speed)
    pressing = rough%force(distance)
    friction = rough%friction_force(tangential + pin_angular_speed*pin_radius - bearing_speed*(distance + pin_radius), pressing)
    call film%loads(seen, viscosity_ratio, film_force, film_moment)
  end subroutine mixed_forces

  !> The inverse of `mixed_forces`: the velocity e' with which film and asperities carry a load, at the eccentricity and with the
  !> angular speeds of `motion`, and the forces of the asperities.
  !>
  !> The film carries W - N n + f t. N depends on |e| alone; f depends on the tangential velocity u, which grows with f. So u -
  !> u(f(u)) increases strictly and has one root, between the velocities for f = -mu N and f = mu N. Mostly the surfaces slide so
  !> fast that one of these is the root.
  pure subroutine mixed_velocity(film, rough, pin_radius, motion, viscosity_ratio, load, velocity, pressing, friction)
    class(film_law_t), intent(in) :: film
    type(asperities_t), intent(in) :: rough
    real(dp), intent(in) :: pin_radius            !! [m]
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: viscosity_ratio       !! of the film to that of its law [-]
    real(dp), intent(in) :: load(2)               !! of the pin on its bearing [N]
    real(dp), intent(out) :: velocity(2)          !! [m/s]
    real(dp), intent(out) :: pressing, friction   !! as in `mixed_forces` [N]
    real(dp), parameter :: centred = 1e-3_dp      !! over the clearance; nearer to the centre no roughness is felt
    real(dp), parameter :: close_enough = 1e-13_dp
    real(dp), parameter :: flattest = 1e-100_dp   !! slope of the mean gap with which a velocity can still be computed
    type(bracket_t) :: bracket
    type(film_motion_t) :: seen
    real(dp) :: distance, n(2), t(2), gap, slope, ratio, sliding, limit, u, next, factor
    distance = norm2(motion%eccentricity)
    n = [1.0_dp, 0.0_dp]
    if (distance > 0) n = motion%eccentricity/distance
    t = [-n(2), n(1)]
    call rough%mean_gap(film%clearance - distance, gap, slope)
    ratio = slope
    if (distance > centred*film%clearance) ratio = max(film%clearance - gap, 0.0_dp)/distance
    seen = motion
    seen%eccentricity = ratio*motion%eccentricity
    factor = viscosity_ratio*film%thinning(seen)
    pressing = rough%force(distance)
    sliding = 0.5_dp*(motion%pin_speed + motion%turning_speed)*pin_radius &
      - 0.5_dp*(motion%pin_speed - motion%turning_speed)*(distance + pin_radius)   ! without the velocity of the centre
    limit = rough%coefficient*pressing
    friction = -sign(limit, sliding)
    call carry(friction, velocity)
    u = dot_product(t, velocity)
    if (abs(rough%friction_force(u + sliding, pressing) - friction) <= close_enough*limit) return
    call carry(-friction, velocity)   ! the velocities for both limits enclose the root
    bracket%a = min(u, dot_product(t, velocity))
    bracket%b = max(u, dot_product(t, velocity))
    bracket%width = bracket%b - bracket%a
    bracket%fa = residual(bracket%a)
    bracket%fb = residual(bracket%b)
    do while (bracket%fb > 0 .and. bracket%b - bracket%a > close_enough*abs(u + sliding))
      next = next_abscissa(bracket)
      if (.not. (next > bracket%a .and. next < bracket%b)) exit
      call narrow(bracket, next, residual(next))
    end do
    friction = rough%friction_force(bracket%b + sliding, pressing)
    call carry(friction, velocity)

  contains

    !> u less the tangential velocity with the friction at u [m/s].
    pure real(dp) function residual(u)
      real(dp), intent(in) :: u
      real(dp) :: v(2)
      call carry(rough%friction_force(u + sliding, pressing), v)
      residual = u - dot_product(t, v)
    end function residual

    !> The velocity with a given friction.
    pure subroutine carry(force, v)
      real(dp), intent(in) :: force
      real(dp), intent(out) :: v(2)
      real(dp) :: driven(2)
      call driven_velocity(film, ratio*motion%eccentricity, (load - pressing*n + force*t)/factor, driven)
      v = dot_product(n, driven)/max(slope, flattest)*n + (dot_product(t, driven)/ratio + 0.5_dp*motion%pin_speed*distance)*t
    end subroutine carry
  end subroutine mixed_velocity

  !> The motion on which the film between rough surfaces depends.
  pure type(film_motion_t) function motion_in_gap(film, rough, motion) result(seen)
    class(film_law_t), intent(in) :: film
    type(asperities_t), intent(in) :: rough
    type(film_motion_t), intent(in) :: motion
    real(dp) :: distance, tangential
    call see_gap(film, rough, motion, seen, distance, tangential)
  end function motion_in_gap

  !> The motion in the mean gap h_T of the surfaces: its eccentricity ratio is 1 - h_T/c, which approaches 1 while the smooth
  !> surfaces would touch and penetrate; its rotation is the actual one.
  pure subroutine see_gap(film, rough, motion, seen, distance, tangential)
    class(film_law_t), intent(in) :: film
    type(asperities_t), intent(in) :: rough
    type(film_motion_t), intent(in) :: motion
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: distance      !! |e| [m]
    real(dp), intent(out) :: tangential    !! component of e' perpendicular to the eccentricity [m/s]
    real(dp) :: n(2), gap, slope, ratio, radial
    seen = motion
    associate (e => motion%eccentricity, v => motion%eccentricity_rate)
      distance = sqrt(e(1)**2 + e(2)**2)
      n = [1.0_dp, 0.0_dp]
      if (distance > 0) n = e*(1/distance)
      radial = n(1)*v(1) + n(2)*v(2)
      tangential = n(1)*v(2) - n(2)*v(1)
      call rough%mean_gap(film%clearance - distance, gap, slope)
      ratio = slope
      if (distance > 0) ratio = max(film%clearance - gap, 0.0_dp)/distance
      seen%eccentricity = ratio*e
      seen%eccentricity_rate = slope*radial*n + ratio*tangential*[-n(2), n(1)]
    end associate
  end subroutine see_gap

  !> Derivatives of the total force and moment on the pin (rows F_x, F_y, moment) with respect to e_x, e_y, e_x', e_y' and the
  !> angular speeds of pin and bearing (columns), by central differences.
  pure subroutine mixed_derivatives(film, rough, pin_radius, motion, viscosity_ratio, derivatives)
    class(film_law_t), intent(in) :: film
    type(asperities_t), intent(in) :: rough
    real(dp), intent(in) :: pin_radius
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: viscosity_ratio
    real(dp), intent(out) :: derivatives(3, 6)
    real(dp) :: step(6), above(3), below(3)
    integer :: i
    step(:5) = difference_steps(film%clearance, max(film%clearance - norm2(motion%eccentricity), rough%roughness), motion)
    step(6) = step(5)
    do i = 1, size(step)
      call find_whole(moved(motion, i, step(i)), above)
      call find_whole(moved(motion, i, -step(i)), below)
      derivatives(:, i) = (above - below)/(2*step(i))
    end do

  contains

    pure subroutine find_whole(at, values)
      type(film_motion_t), intent(in) :: at
      real(dp), intent(out) :: values(3)
      real(dp) :: pressing, friction, distance, n(2)
      call mixed_forces(film, rough, pin_radius, at, viscosity_ratio, values(1:2), values(3), pressing, friction)
      distance = norm2(at%eccentricity)
      n = [1.0_dp, 0.0_dp]
      if (distance > 0) n = at%eccentricity/distance
      values(1:2) = values(1:2) - pressing*n + friction*[-n(2), n(1)]
      values(3) = values(3) + friction*pin_radius
    end subroutine find_whole
  end subroutine mixed_derivatives
end module mixed_film
