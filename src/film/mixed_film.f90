!> Mixed lubrication: a film between rough surfaces in parallel with the contact of their asperities. There is no event at |e| = c.
module mixed_film
  use kinds, only: dp
  use film_law, only: film_law_t, film_motion_t, difference_steps, moved
  use asperities, only: asperities_t
  implicit none
  private
  public :: mixed_forces, mixed_derivatives, motion_in_gap

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
