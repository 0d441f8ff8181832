!> Derivatives of forces that are given along the eccentricity and perpendicular to it, with respect to components in x and y.
module film_direction
  use kinds, only: dp
  use film_law, only: film_law_t, film_motion_t
  implicit none
  private
  public :: derivatives_in_components, least_ratio_of_derivatives

  !> Smallest eps: below it n changes too rapidly with the eccentricity, and central differences of the force in x and y are better.
  real(dp), parameter :: least_ratio_of_derivatives = 1e-4_dp

contains

  !> Derivatives of force and moment on the pin with respect to e_x, e_y, e_x', e_y' and the pin speed (columns; rows F_x, F_y and
  !> M, 0 without `film_moment`), from the components of the force along n = e/|e| and t perpendicular to it (element 0) and their
  !> derivatives with respect to eps = |e|/c, B = v*.n/c and T = v*.t/c (elements 1 to 3), with v* = e' - (omega/2) z x e.
  pure function derivatives_in_components(film, motion, n, eps, b, radial, tangential) result(derivatives)
    class(film_law_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: n(2), eps, b                   !! for this motion [-, -, 1/s]; eps > 0
    real(dp), intent(in) :: radial(0:3), tangential(0:3)   !! [N]; with respect to eps [N], to B and T [N s]
    real(dp) :: derivatives(3, 5)
    real(dp) :: tangential_rate, per_clearance, per_eccentricity
    real(dp), dimension(2) :: along_n, along_t, by_n, by_t   !! components along n and t
    associate (v => motion%eccentricity_rate, c => film%clearance)
      per_clearance = 1/c
      per_eccentricity = 1/(eps*c)
      tangential_rate = (n(1)*v(2) - n(2)*v(1))*per_clearance
    end associate
    ! an eccentricity along n changes eps and T, one along t turns n, with it the force, and changes B and T
    along_n = [radial(1), tangential(1)]*per_clearance - (0.5_dp*motion%pin_speed*per_clearance)*[radial(3), tangential(3)]
    along_t = (tangential_rate*[radial(2), tangential(2)] - b*[radial(3), tangential(3)] + [-tangential(0), radial(0)]) &
      *per_eccentricity
    call turn(along_n, by_n)
    call turn(along_t, by_t)
    derivatives(:2, 1) = by_n*n(1) - by_t*n(2)
    derivatives(:2, 2) = by_n*n(2) + by_t*n(1)
    call turn([radial(2), tangential(2)]*per_clearance, by_n)
    call turn([radial(3), tangential(3)]*per_clearance, by_t)
    derivatives(:2, 3) = by_n*n(1) - by_t*n(2)
    derivatives(:2, 4) = by_n*n(2) + by_t*n(1)
    derivatives(:2, 5) = (-0.5_dp*eps*film%clearance)*by_t
    derivatives(3, :) = 0
    if (film%film_moment) derivatives(3, :) = film%shear_moment_slopes(motion, &
      [radial(0)*n(1) - tangential(0)*n(2), radial(0)*n(2) + tangential(0)*n(1)], derivatives)

  contains

    !> The components in x and y of a vector given by those along n and t.
    pure subroutine turn(polar, components)
      real(dp), intent(in) :: polar(2)
      real(dp), intent(out) :: components(2)
      components(1) = polar(1)*n(1) - polar(2)*n(2)
      components(2) = polar(1)*n(2) + polar(2)*n(1)
    end subroutine turn
  end function derivatives_in_components
end module film_direction
