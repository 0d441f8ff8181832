!> Friction with a static peak and derivatives of all orders (Brown & McPhee 2016, J. Comput. Nonlinear Dynam. 11, 054502).
module brown_mcphee
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use static_friction, only: static_friction_t
  implicit none
  private
  public :: brown_mcphee_t

  !> F_T = -F_N [c_f tanh(4 u) + (c_s - c_f) u/(u^2/4 + 3/4)^2 + s_2 v_T], u = v_T/v_t. Without the viscous part the largest
  !> friction, about 0.9995 c_s, occurs at u = 1.00 to 1.02. At zero speed there is no friction: a loaded surface creeps.
  type, extends(static_friction_t) :: brown_mcphee_t
    real(dp) :: transition_speed = 0     !! v_t, sliding speed of the largest friction [m/s], > 0
  contains
    procedure :: parameters
    procedure :: sliding_ratio
    procedure :: friction_ratio_slope
    procedure :: static_speed
  end type brown_mcphee_t

contains

  subroutine parameters(self, list)
    class(brown_mcphee_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_coefficient(list)
    call self%add_static(list)
    call list%add('transition_speed', self%transition_speed, 'sliding speed over which friction changes its sign', 'm/s', '> 0', &
      example='0.010', usual='1e-6 to 1')
    call self%add_viscous(list)
  end subroutine parameters

  !> For u > 1 the static part is computed from 1/u, which does not overflow.
  pure function sliding_ratio(self, sliding_speed) result(ratio)
    class(brown_mcphee_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    real(dp) :: ratio
    real(dp) :: u, peak
    u = sliding_speed/self%transition_speed
    if (abs(u) < 1) then
      peak = u/(0.25_dp*u**2 + 0.75_dp)**2
    else
      peak = (1/u)**3/(0.25_dp + 0.75_dp*(1/u)**2)**2
    end if
    ratio = -(self%coefficient*tanh(4*u) + self%static_part*peak + self%viscous_coefficient*sliding_speed)
  end function sliding_ratio

  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(brown_mcphee_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    real(dp) :: u, peak_slope
    u = sliding_speed/self%transition_speed
    if (abs(u) < 1) then
      peak_slope = 0.75_dp*(1 - u**2)/(0.25_dp*u**2 + 0.75_dp)**3
    else
      peak_slope = 0.75_dp*((1/u)**2 - 1)*(1/u)**4/(0.25_dp + 0.75_dp*(1/u)**2)**3
    end if
    slope = -(self%coefficient*4*(1 - tanh(4*u)**2) + self%static_part*peak_slope)/self%transition_speed - self%viscous_coefficient
  end function friction_ratio_slope

  !> See `static_speed` of friction_law_t: that of the largest friction.
  pure real(dp) function static_speed(self)
    class(brown_mcphee_t), intent(in) :: self
    static_speed = merge(self%transition_speed, 0.0_dp, self%static_part > 0)
  end function static_speed
end module brown_mcphee
