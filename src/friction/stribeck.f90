!> Friction that falls from a static to a sliding value with the sliding speed (Stribeck), eased in over small speeds.
module stribeck
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: parameter_list_t
  use friction_law, only: friction_law_t, static_or_sliding, static_conflict
  implicit none
  private
  public :: stribeck_t

  !> F_T = -F_N {[c_f + (c_s - c_f) exp(-(|v_T|/v_s)^p)] tanh(v_T/v_t) + s_2 v_T}. At rest there is none: a load at rest creeps.
  type, extends(friction_law_t) :: stribeck_t
    real(dp) :: coefficient = 0          !! c_f of sliding [-], >= 0
    real(dp) :: static_coefficient = 0   !! c_s [-], >= c_f; 0: as c_f
    real(dp) :: stribeck_speed = 0       !! v_s, over which the static part falls [m/s], > 0
    real(dp) :: stribeck_exponent = 2    !! p [-], 0.1 to 10
    real(dp) :: transition_speed = 0     !! v_t, over which the friction is eased in [m/s], > 0
    real(dp) :: viscous_coefficient = 0  !! s_2 [s/m], >= 0
    real(dp), private :: static_part = 0 !! c_s - c_f [-]
  contains
    procedure, nopass :: name
    procedure :: parameters
    procedure :: conflict
    procedure :: prepare
    procedure :: friction_ratio
    procedure :: friction_ratio_slope
  end type stribeck_t

contains

  pure function name()
    character(len=:), allocatable :: name
    name = 'stribeck'
  end function name

  subroutine parameters(self, list)
    class(stribeck_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('coefficient', self%coefficient, 'of sliding friction', range='>= 0', example='0.03')
    call list%add('static_coefficient', self%static_coefficient, 'of friction at rest; 0: as coefficient', range='>= 0', &
      default='0.0')
    call list%add('stribeck_speed', self%stribeck_speed, 'sliding speed over which the static part of the friction falls', 'm/s', &
      '> 0', example='0.010')
    call list%add('stribeck_exponent', self%stribeck_exponent, 'of the fall', '', '>= 0.1 and <= 10', '2.0')
    call list%add('transition_speed', self%transition_speed, 'sliding speed that turns the friction round', 'm/s', '> 0', &
      example='0.010')
    call list%add('viscous_coefficient', self%viscous_coefficient, 'friction over normal force that grows with the sliding speed', &
      's/m', '>= 0', default='0.0')
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(stribeck_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    call static_conflict(self%static_coefficient, self%coefficient, key, wanted)
  end subroutine conflict

  subroutine prepare(self)
    class(stribeck_t), intent(inout) :: self
    self%static_part = static_or_sliding(self%static_coefficient, self%coefficient) - self%coefficient
  end subroutine prepare

  pure function friction_ratio(self, sliding_speed, direction) result(ratio)
    class(stribeck_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    integer, value, intent(in) :: direction
    real(dp) :: ratio
    associate (unused => direction)
    end associate
    ratio = -((self%coefficient + self%static_part*exp(-(abs(sliding_speed)/self%stribeck_speed)**self%stribeck_exponent))* &
      tanh(sliding_speed/self%transition_speed) + self%viscous_coefficient*sliding_speed)
  end function friction_ratio

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
end module stribeck
