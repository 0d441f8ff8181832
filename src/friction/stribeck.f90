!> Friction that decreases from a static to a sliding value with the sliding speed (Stribeck), with a smooth transition through zero
!> speed.
module stribeck
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use static_friction, only: static_friction_t
  implicit none
  private
  public :: stribeck_t

  !> F_T = -F_N {[c_f + (c_s - c_f) exp(-(|v_T|/v_s)^p)] tanh(v_T/v_t) + s_2 v_T}. At zero speed there is no friction: a loaded
  !> surface creeps.
  type, extends(static_friction_t) :: stribeck_t
    real(dp) :: stribeck_speed = 0       !! v_s, speed scale of the decrease of the static part [m/s], > 0
    real(dp) :: stribeck_exponent = 2    !! p [-], 0.1 to 10
    real(dp) :: transition_speed = 0     !! v_t, speed scale of the transition through zero [m/s], > 0
  contains
    procedure :: parameters
    procedure :: sliding_ratio
    procedure :: friction_ratio_slope
    procedure :: static_speed
  end type stribeck_t

contains

  subroutine parameters(self, list)
    class(stribeck_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_coefficient(list)
    call self%add_static(list)
    call self%add_stribeck_speed(self%stribeck_speed, list)
    call list%add('stribeck_exponent', self%stribeck_exponent, 'exponent of the Stribeck curve', '', '>= 0.1 and <= 10', '2.0', &
      usual='0.5 to 3')
    call list%add('transition_speed', self%transition_speed, 'sliding speed over which friction changes its sign', 'm/s', '> 0', &
      example='0.010', usual='1e-6 to 1')
    call self%add_viscous(list)
  end subroutine parameters

  pure function sliding_ratio(self, sliding_speed) result(ratio)
    class(stribeck_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    real(dp) :: ratio
    ratio = -((self%coefficient + self%static_part*exp(-(abs(sliding_speed)/self%stribeck_speed)**self%stribeck_exponent))* &
      tanh(sliding_speed/self%transition_speed) + self%viscous_coefficient*sliding_speed)
  end function sliding_ratio

  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(stribeck_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    real(dp) :: fall, eased, power
    eased = tanh(sliding_speed/self%transition_speed)
    fall = self%static_part
    slope = 0
    if (abs(sliding_speed) > 0) then
      power = (abs(sliding_speed)/self%stribeck_speed)**self%stribeck_exponent
      fall = self%static_part*exp(-power)
      slope = fall*self%stribeck_exponent*power/sliding_speed*eased
    end if
    slope = slope - (self%coefficient + fall)*(1 - eased**2)/self%transition_speed - self%viscous_coefficient
  end function friction_ratio_slope

  !> See `static_speed` of friction_law_t: that at which the static part has fallen to 1/e.
  pure real(dp) function static_speed(self)
    class(stribeck_t), intent(in) :: self
    static_speed = merge(self%stribeck_speed, 0.0_dp, self%static_part > 0)
  end function static_speed
end module stribeck
