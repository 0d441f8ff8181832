!> The impact of a free mass under a contact law, integrated and in closed form.
module free_impact
  use kinds, only: dp
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: speed_given_back, exact_restitution

contains

  !> Speed after over speed before the impact of a free mass, by the classical Runge-Kutta method with `steps` steps in
  !> 4 (m v^2/K)^(1/(n+1))/v, the approximate duration of the impact; at most `most_steps` steps.
  function speed_given_back(law, stiffness, exponent, speed, steps, most_steps) result(ratio)
    class(contact_law_t), intent(in) :: law
    real(dp), intent(in) :: stiffness, exponent, speed   !! [N/m^exponent], [-], [m/s]
    integer, intent(in) :: steps, most_steps
    real(dp) :: ratio
    real(dp), parameter :: mass = 1.3_dp
    real(dp) :: state(2), k(2, 4), step
    integer :: i
    step = 4*(mass*speed**2/stiffness)**(1/(exponent + 1))/speed/steps
    state = [0.0_dp, speed]
    do i = 1, most_steps
      k(:, 1) = rate(state)
      k(:, 2) = rate(state + step/2*k(:, 1))
      k(:, 3) = rate(state + step/2*k(:, 2))
      k(:, 4) = rate(state + step*k(:, 3))
      state = state + step/6*(k(:, 1) + 2*k(:, 2) + 2*k(:, 3) + k(:, 4))
      if (state(1) <= 0) exit
    end do
    ratio = -state(2)/speed
  contains
    pure function rate(y)
      real(dp), intent(in) :: y(2)
      real(dp) :: rate(2)
      rate = [y(2), -law%normal_force(y(1), y(2), speed)/mass]
    end function rate
  end function speed_given_back

  !> Restitution of an impact with the damping chi: root in (0,1] of chi (1 + x) = ln[(1 + chi)/(1 - chi x)].
  pure real(dp) function exact_restitution(chi) result(root)
    real(dp), intent(in) :: chi
    real(dp) :: low, high
    integer :: i
    root = 1 - 2*chi/3   ! first order, because the difference below would be rounding only
    if (chi < 1e-5_dp) return
    low = 0
    high = min(1.0_dp, 1/chi)
    do i = 1, 60
      root = (low + high)/2
      if (chi*(1 + root) > log((1 + chi)/max(1 - chi*root, 1e-200_dp))) then   ! 1 - chi*root may round to 0
        low = root
      else
        high = root
      end if
    end do
  end function exact_restitution
end module free_impact
