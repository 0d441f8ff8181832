!> Bristles between surfaces that oscillate, as a system of equations: y = (deflection, work of friction), F_N = 1 N.
module shaken_bristles
  use kinds, only: dp
  use ode_problem, only: ode_problem_t
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: shaken_t, new_shaken

  type, extends(ode_problem_t) :: shaken_t
    class(friction_law_t), allocatable :: law
    real(dp) :: reach = 0      !! amplitude of the motion x = reach sin(w t) [m]
    real(dp) :: frequency = 0  !! w [rad/s]; 0: sliding in one direction with the speed `reach` [m/s]
  contains
    procedure :: derivatives
    procedure :: speed
  end type shaken_t

contains

  subroutine new_shaken(law, reach, frequency, problem)
    class(friction_law_t), intent(in) :: law
    real(dp), intent(in) :: reach, frequency
    type(shaken_t), intent(out) :: problem
    allocate (problem%law, source=law)
    problem%reach = reach
    problem%frequency = frequency
    problem%n = 2
    problem%n_quadratures = 1
    problem%refuses_steps = .false.
  end subroutine new_shaken

  !> Sliding speed [m/s].
  pure real(dp) function speed(self, t)
    class(shaken_t), intent(in) :: self
    real(dp), intent(in) :: t
    speed = self%reach
    if (self%frequency > 0) speed = self%reach*self%frequency*cos(self%frequency*t)
  end function speed

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(shaken_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    real(dp) :: ratio
    in_domain = .true.
    call self%law%state_friction(self%speed(t), y(1:1), ratio, dydt(1:1))
    dydt(2) = ratio*self%speed(t)
  end subroutine derivatives
end module shaken_bristles
