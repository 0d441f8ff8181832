!> A scene with clearance in the coordinates (q, A, x) of its bodies, in which the eccentricity is a difference of numbers that are
!> ten thousand times larger. Tests compare the coordinates of scenes with these.
module absolute_coordinates
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use scene_problem, only: scene_t, evaluation_t
  use state_making, only: set_crank, set_pin
  implicit none
  private
  public :: absolute_coordinates_t, in_absolute_coordinates

  !> y = (q, A, x, q', A', x'). The scene within is that of a free crank without quadratures of the joint.
  type, extends(ode_problem_t) :: absolute_coordinates_t
    type(scene_t) :: scene
  contains
    procedure :: derivatives
    procedure :: eccentricity
  end type absolute_coordinates_t

contains

  !> A scene in these coordinates, and its initial state.
  subroutine in_absolute_coordinates(scene, problem, y)
    type(scene_t), intent(in) :: scene
    type(absolute_coordinates_t), intent(out) :: problem
    real(dp), intent(out) :: y(6)
    type(evaluation_t) :: now
    logical :: in_domain
    problem%scene = scene
    problem%n = 6
    call scene%evaluate(0.0_dp, scene%initial_state(), now, in_domain)
    associate (m => now%motion)
      y = [m%crank_angle, atan2(m%sin_rod, m%cos_rod), m%piston_position, m%crank_speed, m%rod_speed, m%piston_velocity]
    end associate
  end subroutine in_absolute_coordinates

  !> e = pin centre - bearing centre, and its rate [m, m/s].
  pure subroutine eccentricity(self, y, e, rate)
    class(absolute_coordinates_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: e(2), rate(2)
    associate (r => self%scene%chain%bodies%crank%length, l => self%scene%chain%bodies%rod%length)
      e = [r*cos(y(1)) + l*cos(y(2)) - y(3), r*sin(y(1)) - l*sin(y(2))]
      rate = [-r*sin(y(1))*y(4) - l*sin(y(2))*y(5) - y(6), r*cos(y(1))*y(4) - l*cos(y(2))*y(5)]
    end associate
  end subroutine eccentricity

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(absolute_coordinates_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    type(evaluation_t) :: now
    real(dp) :: e(2), rate(2), state(self%scene%n)
    call self%eccentricity(y, e, rate)
    state = 0
    call set_crank(self%scene, state, y(1), y(4))
    call set_pin(self%scene, state, e, rate)
    call self%scene%evaluate(t, state, now, in_domain)
    if (.not. in_domain) return
    dydt(:3) = y(4:6)
    dydt(4:6) = [now%accelerations%crank, now%accelerations%rod, now%accelerations%piston]
  end subroutine derivatives
end module absolute_coordinates
