!> The inverse of a film's force: the velocity of the pin under a given load (mobility method, Booker 1965).
!>
!> The force of a quasi-static film depends only on the velocity v* = e' - (omega/2) z x e and is proportional to its magnitude. The
!> direction of v* is therefore the one in which the film's force is opposite to the load, and its magnitude is the load divided by
!> the force of a unit velocity.
module film_mobility
  use kinds, only: dp
  use constants, only: pi
  use film_law, only: film_law_t, film_motion_t
  implicit none
  private
  public :: driven_velocity

contains

  !> v* [m/s] at an eccentricity e, |e| < c, such that the film's force balances a load on the pin [N]. The direction is described
  !> by beta, v* = (w cos beta, sin beta) with w = sqrt(1 - eps^2); the direction of the load then varies evenly with beta up to the
  !> wall. Beta is found between 0 and pi by regula falsi in the form of Anderson and Björck; a last secant, between two close
  !> trials, gives beta and the force up to rounding. For a load in the opposite sense the problem is mirrored.
  pure subroutine driven_velocity(film, e, load, velocity)
    class(film_law_t), intent(in) :: film
    real(dp), intent(in) :: e(2)          !! [m]
    real(dp), intent(in) :: load(2)       !! [N]
    real(dp), intent(out) :: velocity(2)
    integer, parameter :: most_trials = 60
    real(dp), parameter :: narrow = 1e-14_dp, close = 1e-9_dp   !! [rad]; the trial before a close one is some 1e-5 away
    real(dp) :: size_of_load, distance, n(2), t(2), w, target(2), beta, strength, last_strength, part
    real(dp) :: end, f_end, last, f_last, f   ! of the bracket: the end that is kept, and the last trial
    integer :: i
    velocity = 0
    size_of_load = sqrt(load(1)**2 + load(2)**2)
    if (.not. size_of_load > tiny(1.0_dp)**0.25_dp) return
    distance = sqrt(e(1)**2 + e(2)**2)
    n = load/size_of_load   ! a centred film is the same in all directions
    if (distance > 1e-100_dp*film%clearance) n = e/distance
    t = [-n(2), n(1)]
    w = sqrt(max(1 - (distance*film%per_clearance)**2, 4*epsilon(1.0_dp)))
    target = [dot_product(n, load), dot_product(t, load)]/size_of_load
    if (target(2) < 0) then
      t = -t
      target(2) = -target(2)
    end if
    end = 0
    f_end = -atan2(target(2), target(1))
    last = pi
    f_last = pi + f_end
    last_strength = 0
    do i = 1, most_trials
      beta = last - f_last*(last - end)/(f_last - f_end)
      call try(beta, f, strength)
      if (abs(f) <= close .or. abs(last - end) <= narrow) exit
      if (f > 0 .neqv. f_last > 0) then
        end = last
        f_end = f_last
      else
        f_end = f_end*share(f, f_last)
      end if
      last = beta
      f_last = f
      last_strength = strength
    end do
    if (last_strength > 0 .and. abs(f) <= close .and. abs(f - f_last) > 0) then
      part = f/(f - f_last)
      beta = beta - part*(beta - last)
      strength = strength - part*(strength - last_strength)
    end if
    velocity = size_of_load/strength*unit_velocity(beta)

  contains

    !> Factor by which the value at the end that is kept is reduced.
    pure real(dp) function share(now, before)
      real(dp), intent(in) :: now, before
      share = 0.5_dp
      if (abs(now) < abs(before)) share = 1 - now/before
    end function share

    !> A velocity of about one clearance per second.
    pure function unit_velocity(beta) result(v)
      real(dp), intent(in) :: beta
      real(dp) :: v(2)
      v = film%clearance*(w*cos(beta)*n + sin(beta)*t)
    end function unit_velocity

    !> Twice the tangent of half the angle between the load for a direction and the given load, and magnitude of the former.
    pure subroutine try(beta, f, strength)
      real(dp), intent(in) :: beta
      real(dp), intent(out) :: f, strength
      type(film_motion_t) :: motion
      real(dp) :: force(2), moment, along, across
      motion%eccentricity = e
      motion%eccentricity_rate = unit_velocity(beta)
      motion%pin_speed = 0
      call film%film_force(motion, force, moment)
      along = -dot_product(n, force)
      across = -dot_product(t, force)
      strength = sqrt(along**2 + across**2)
      f = 2*(across*target(1) - along*target(2))/max(strength + along*target(1) + across*target(2), epsilon(1.0_dp)*strength)
    end subroutine try
  end subroutine driven_velocity
end module film_mobility
