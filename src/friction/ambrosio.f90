!> Coulomb friction eased in over small sliding speeds, after Ambrosio (4.9, 4.10).
module ambrosio
  use kinds, only: dp
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: ambrosio_t, new_ambrosio

  !> F_T = -c_f c_d F_N sign(v_T), c_d rising from 0 at |v_T| = v0 to 1 at v1.
  type, extends(friction_law_t) :: ambrosio_t
    real(dp) :: coefficient = 0   !! c_f [-], >= 0
    real(dp) :: v0 = 0            !! no friction up to this sliding speed [m/s], >= 0
    real(dp) :: v1 = 0            !! full friction from this sliding speed on [m/s], >= v0 and > 0
  contains
    procedure :: friction_ratio
    procedure :: friction_ratio_slope
  end type ambrosio_t

contains

  pure subroutine new_ambrosio(law, coefficient, v0, v1)
    type(ambrosio_t), intent(out) :: law
    real(dp), intent(in) :: coefficient   !! c_f [-]
    real(dp), intent(in) :: v0, v1        !! the ramp's ends [m/s], 0 <= v0 <= v1, v1 > 0
    law%coefficient = coefficient
    law%v0 = v0
    law%v1 = v1
  end subroutine new_ambrosio

  !> (4.9) with (4.10). Continuous for v0 < v1; v0 = v1 is a jump of c_f at v1. `direction` is not asked.
  pure function friction_ratio(self, sliding_speed, direction) result(ratio)
    class(ambrosio_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    integer, value, intent(in) :: direction
    real(dp) :: ratio
    real(dp) :: speed
    associate (unused => direction)
    end associate
    speed = abs(sliding_speed)
    if (speed >= self%v1) then
      ratio = self%coefficient
    else if (speed <= self%v0) then
      ratio = 0
    else
      ratio = self%coefficient*(speed - self%v0)/(self%v1 - self%v0)
    end if
    ratio = -sign(ratio, sliding_speed)
  end function friction_ratio

  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(ambrosio_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    slope = 0
    if (abs(sliding_speed) > self%v0 .and. abs(sliding_speed) < self%v1) &
      slope = -self%coefficient/(self%v1 - self%v0)
  end function friction_ratio_slope
end module ambrosio
