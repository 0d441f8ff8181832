!> Coulomb friction with an exponential transition at small sliding speeds, after Threlfall.
module threlfall
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: threlfall_t

  !> F_T = -c_f F_N sign(v_T) (1 - exp(-3 |v_T|/v1)) for |v_T| <= v1; above v1 it is constant, 95 % of c_f F_N.
  type, extends(friction_law_t) :: threlfall_t
    real(dp) :: v1 = 0            !! sliding speed up to which the friction grows [m/s], > 0
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: sliding_ratio
    procedure :: friction_ratio_slope
  end type threlfall_t

contains

  subroutine parameters(self, list)
    class(threlfall_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_coefficient(list)
    call list%add('v1', self%v1, 'sliding speed above which friction is full', 'm/s', '>= 0', example='0.010', usual='1e-6 to 1')
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(threlfall_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'threlfall needs a speed: must be > 0'
    if (.not. self%v1 > 0) key = 'v1'
  end subroutine conflict

  !> Ratio of friction to normal force: continuous, with a kink at v1. 1 - e^-3x is 2 t/(1 + t) with t = tanh(3x/2), which keeps its
  !> digits at small speeds.
  pure function sliding_ratio(self, sliding_speed) result(ratio)
    class(threlfall_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    real(dp) :: ratio
    associate (t => tanh(1.5_dp*min(abs(sliding_speed)/self%v1, 1.0_dp)))
      ratio = -sign(self%coefficient*2*t/(1 + t), sliding_speed)
    end associate
  end function sliding_ratio

  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(threlfall_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    slope = 0
    if (abs(sliding_speed) < self%v1) slope = -3*self%coefficient/self%v1*exp(-3*abs(sliding_speed)/self%v1)
  end function friction_ratio_slope
end module threlfall
