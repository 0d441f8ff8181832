!> What every lubricating film answers.
module film_law
  use kinds, only: dp
  implicit none
  private
  public :: film_law_t, film_motion_t

  !> The motion of the pin in its bearing, as far as a film needs it.
  type :: film_motion_t
    real(dp) :: eccentricity(2)          !! e = pin centre - bearing centre [m], |e| < c
    real(dp) :: eccentricity_rate(2)     !! de/dt [m/s]
    real(dp) :: pin_speed                !! angular velocity of the pin relative to the bearing, x towards y [rad/s]
    real(dp) :: ideal_pin_speed = 0      !! the same of the ideal-joint mechanism at (q, qdot) [rad/s]
    real(dp) :: ideal_pin_acceleration = 0 !! its rate at constant crank speed [rad/s^2]
    real(dp) :: frequency = 0            !! |qdot|, oscillation frequency of the pin [rad/s]
  end type film_motion_t

  !> A film that carries the pin while it does not touch the bearing.
  type, abstract :: film_law_t
    logical :: needs_ideal_motion = .false.   !! whether the ideal_* fields and the frequency are read
    logical :: singular_at_wall = .true.      !! the force is infinite at |e| = c: the state may not reach it
  contains
    procedure(film_force), deferred :: film_force
  end type film_law_t

  abstract interface
    !> Force of the film on the pin [N] in x and y, and its moment on the pin about the pin centre [N m], x towards y.
    pure subroutine film_force(self, motion, force, moment)
      import :: film_law_t, film_motion_t, dp
      class(film_law_t), intent(in) :: self
      type(film_motion_t), intent(in) :: motion
      real(dp), intent(out) :: force(2)
      real(dp), intent(out) :: moment
    end subroutine film_force
  end interface
end module film_law
