!> Derivatives of forces that are given along the eccentricity and perpendicular to it, with respect to components in x and y.
module film_direction
  use gudgeon_kinds, only: dp
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
    real(dp) :: tangential_rate, changes(3, 5), turn(5)
    integer :: i
    associate (v => motion%eccentricity_rate, c => film%clearance)
      tangential_rate = (n(1)*v(2) - n(2)*v(1))/c
      turn = [-n(2), n(1), 0.0_dp, 0.0_dp, 0.0_dp]/(eps*c)   ! of the direction of n
      changes(1, :) = [n(1), n(2), 0.0_dp, 0.0_dp, 0.0_dp]/c
      changes(2, :) = turn*tangential_rate + [0.0_dp, 0.0_dp, n(1), n(2), 0.0_dp]/c
      changes(3, :) = -0.5_dp*changes(1, :)*motion%pin_speed - turn*b + [0.0_dp, 0.0_dp, -n(2)/c, n(1)/c, -0.5_dp*eps]
    end associate
    do i = 1, 5
      associate (f_r => dot_product(radial(1:), changes(:, i)) - tangential(0)*turn(i), &
                 f_t => dot_product(tangential(1:), changes(:, i)) + radial(0)*turn(i))
        derivatives(:, i) = [f_r*n(1) - f_t*n(2), f_r*n(2) + f_t*n(1), 0.0_dp]
      end associate
    end do
    if (film%film_moment) derivatives(3, :) = film%shear_moment_slopes(motion, &
      [radial(0)*n(1) - tangential(0)*n(2), radial(0)*n(2) + tangential(0)*n(1)], derivatives)
  end function derivatives_in_components
end module film_direction
