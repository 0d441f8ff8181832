!> A contact law whose restitution in a free impact equals the coefficient of restitution.
module exact_restitution
  use kinds, only: dp
  use restitution_law, only: restitution_law_t, one_percent
  implicit none
  private
  public :: exact_restitution_t

  !> chi is the root of chi (1 + e) = ln[(1 + chi)/(1 - chi e)]; the restitution of a free impact is then e (Zhang and Sharf 2009).
  type, extends(restitution_law_t) :: exact_restitution_t
  contains
    procedure, nopass :: damping_for
    procedure, nopass :: least_restitution => one_percent
  end type exact_restitution_t

contains

  !> With d = chi e and y = -ln(1 - d) the equation is d (1 + 1/e) - ln(1 + d/e) - y = 0, which is solved by bisection. For e near
  !> 1, where its terms cancel, two terms of the series of chi are more accurate.
  pure real(dp) function damping_for(restitution) result(damping)
    real(dp), intent(in) :: restitution
    real(dp) :: low, high, y, d
    integer :: i
    associate (e => restitution)
      damping = 1.5_dp*(1 - e)*(2 - e)
      if (e > 1 - 1e-4_dp) return
      low = -log(1 - (1 - e)/2)
      high = 2 + 2/e
      do i = 1, 200
        y = (low + high)/2
        if (.not. (y > low .and. y < high)) exit
        d = one_minus_exp(y)
        if (d*(1 + 1/e) - log_of_one_plus(d/e) > y) then
          low = y
        else
          high = y
        end if
      end do
      damping = one_minus_exp(y)/e
    end associate
  end function damping_for

  !> 1 - exp(-y), accurate also for small y (Kahan).
  pure real(dp) function one_minus_exp(y)
    real(dp), intent(in) :: y
    associate (u => exp(-y))
      one_minus_exp = y
      if (u < 1) one_minus_exp = (1 - u)*(y/(-log(u)))
    end associate
  end function one_minus_exp

  !> ln(1 + x), accurate also for small x (Kahan).
  pure real(dp) function log_of_one_plus(x)
    real(dp), intent(in) :: x
    associate (u => 1 + x)
      log_of_one_plus = x
      if (u > 1) log_of_one_plus = log(u)*(x/(u - 1))
    end associate
  end function log_of_one_plus
end module exact_restitution
