!> Common part of the friction laws in which static friction exceeds sliding friction.
module static_friction
  use kinds, only: dp
  use number_text, only: short_text
  use model_parameters, only: parameter_list_t
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: static_friction_t

  !> A law with a coefficient of static friction c_s in addition to that of sliding friction c_f, and an optional part proportional
  !> to the sliding speed.
  type, abstract, extends(friction_law_t) :: static_friction_t
    real(dp) :: static_coefficient = 0    !! c_s [-], >= c_f; 0: equal to c_f
    real(dp) :: viscous_coefficient = 0   !! s_2, ratio of friction to normal force, divided by the sliding speed [s/m], >= 0
    real(dp) :: static_part = 0           !! c_s - c_f [-], set by `find_static_part`
  contains
    procedure :: conflict => static_conflict
    procedure :: prepare => find_static_part
    procedure, non_overridable :: static_conflict
    procedure, non_overridable :: find_static_part
    procedure, non_overridable :: holding_coefficient
    procedure, non_overridable :: add_static
    procedure, non_overridable :: add_viscous
    procedure, nopass, non_overridable :: add_stribeck_speed
  end type static_friction_t

contains

  !> Effective coefficient of static friction: if the case gives none, 0, it is that of sliding.
  pure real(dp) function holding_coefficient(self)
    class(static_friction_t), intent(in) :: self
    holding_coefficient = self%coefficient
    if (self%static_coefficient > 0) holding_coefficient = self%static_coefficient
  end function holding_coefficient

  !> Report static friction that is smaller than sliding friction.
  pure subroutine static_conflict(self, key, wanted)
    class(static_friction_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'must be >= coefficient = '//short_text(self%coefficient)//', or 0: as coefficient'
    if (self%holding_coefficient() < self%coefficient) key = 'static_coefficient'
  end subroutine static_conflict

  !> Compute the difference between static and sliding friction.
  subroutine find_static_part(self)
    class(static_friction_t), intent(inout) :: self
    self%static_part = self%holding_coefficient() - self%coefficient
  end subroutine find_static_part

  !> Declare the coefficient of static friction.
  subroutine add_static(self, list)
    class(static_friction_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('static_coefficient', self%static_coefficient, 'coefficient of friction at rest; 0: equal to coefficient', &
      range='>= 0', default='0.0', usual='1e-3 to 1.5')
  end subroutine add_static

  !> Declare the viscous coefficient.
  subroutine add_viscous(self, list)
    class(static_friction_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('viscous_coefficient', self%viscous_coefficient, 'viscous part: friction over normal force per sliding speed', &
      's/m', '>= 0', default='0.0', usual='0 to 10')
  end subroutine add_viscous

  !> Declare the speed scale of the decrease from static to sliding friction.
  subroutine add_stribeck_speed(stribeck_speed, list)
    real(dp), intent(inout) :: stribeck_speed   !! [m/s]
    class(parameter_list_t), intent(inout) :: list
    call list%add('stribeck_speed', stribeck_speed, &
      'sliding speed at which the static part of the friction has mostly vanished (Stribeck)', 'm/s', '> 0', example='0.010', &
      usual='1e-6 to 1')
  end subroutine add_stribeck_speed
end module static_friction
