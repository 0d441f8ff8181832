!> Interface of all dry friction laws.
module friction_law
  use kinds, only: dp
  use model_parameters, only: law_t, parameter_list_t
  use trace_row, only: trace_row_t
  implicit none
  private
  public :: friction_law_t, most_friction_states

  integer, parameter :: most_friction_states = 1   !! largest number of states of a law

  !> Dry friction between the surfaces of pin and bearing. A law may have first-order states of its own, which are used in contact
  !> only and are 0 at its beginning. Such a law implements `state_friction`; its `friction_ratio` is that of steady sliding.
  type, abstract, extends(law_t) :: friction_law_t
    real(dp) :: coefficient = 0       !! coefficient of sliding friction c_f [-], >= 0
    logical :: set_valued = .false.  !! the law is discontinuous at zero sliding speed: the scene must determine whether the
                                     !! surfaces stick
    integer :: n_states = 0           !! number of states, 0 to most_friction_states; set by `prepare`
    real(dp) :: state_scale = 1       !! natural size of the states, for the error control; set by `prepare`
  contains
    procedure :: prepare => nothing_to_prepare
    procedure, non_overridable :: friction_ratio
    procedure(sliding_ratio), deferred :: sliding_ratio
    procedure :: friction_ratio_slope
    procedure :: static_speed => no_static_speed
    procedure :: holding_ratio
    procedure :: touch_down_limit => no_limit
    procedure :: state_friction => steady_friction
    procedure :: state_slopes => steady_slopes
    procedure :: add_columns => no_columns
    procedure, non_overridable :: add_coefficient
  end type friction_law_t

  abstract interface
    !> `friction_ratio` of a law that is not set-valued.
    pure function sliding_ratio(self, sliding_speed) result(ratio)
      import :: friction_law_t, dp
      class(friction_law_t), intent(in) :: self
      real(dp), value, intent(in) :: sliding_speed
      real(dp) :: ratio
    end function sliding_ratio
  end interface

contains

  !> Prepare the law before the first evaluation of the force. The default does nothing.
  subroutine nothing_to_prepare(self)
    class(friction_law_t), intent(inout) :: self
  end subroutine nothing_to_prepare

  !> Friction force on the pin divided by the normal force [-], positive along the tangent t = (-n_y, n_x). That of a set-valued
  !> law (4.8) depends only on the direction, which the scene changes at reversals of sliding, so that the force is smooth within a
  !> step.
  pure function friction_ratio(self, sliding_speed, direction) result(ratio)
    class(friction_law_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed   !! velocity of the pin's surface relative to the bearing's along t [m/s]
    integer, value, intent(in) :: direction        !! present direction of sliding: -1 or +1 (for set-valued laws)
    real(dp) :: ratio
    if (self%set_valued) then
      ratio = -self%coefficient*direction
    else
      ratio = self%sliding_ratio(sliding_speed)
    end if
  end function friction_ratio

  !> Sliding speed up to which the friction of a law that depends on the speed alone clearly exceeds that of faster sliding [m/s].
  !> The default, 0, is for laws without such static friction.
  pure real(dp) function no_static_speed(self)
    class(friction_law_t), intent(in) :: self
    no_static_speed = 0
  end function no_static_speed

  !> Derivative of the ratio with respect to the sliding speed [s/m], for implicit integration. The default, 0, is for laws that do
  !> not depend on the magnitude of the speed.
  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    slope = 0
  end function friction_ratio_slope

  !> Largest ratio of friction to normal force [-] of a set-valued law while the surfaces stick. The default is that of sliding.
  pure real(dp) function holding_ratio(self)
    class(friction_law_t), intent(in) :: self
    holding_ratio = abs(self%friction_ratio(0.0_dp, 1))
  end function holding_ratio

  !> Largest sliding speed [m/s] at which friction at the beginning of a contact does not exceed static friction. The default is no
  !> limit.
  pure real(dp) function no_limit(self)
    class(friction_law_t), intent(in) :: self
    no_limit = huge(no_limit)
  end function no_limit

  !> Friction force divided by the normal force [-], with the sign of `friction_ratio`, for a law with states, and the rates of the
  !> states. The default is for laws without states.
  pure subroutine steady_friction(self, sliding_speed, states, ratio, rates)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed            !! [m/s]
    real(dp), intent(in) :: states(self%n_states)
    real(dp), intent(out) :: ratio
    real(dp), intent(out) :: rates(self%n_states)
    ratio = self%friction_ratio(sliding_speed, nint(sign(1.0_dp, sliding_speed)))
    rates = states
  end subroutine steady_friction

  !> Derivatives of the ratio (row 1) and of the rates (following rows) with respect to the sliding speed (column 1) and the states
  !> (following columns), for implicit integration.
  pure subroutine steady_slopes(self, sliding_speed, states, slopes)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp), intent(in) :: states(self%n_states)
    real(dp), intent(out) :: slopes(1 + self%n_states, 1 + self%n_states)
    slopes = 0
    slopes(1, 1) = self%friction_ratio_slope(sliding_speed)
  end subroutine steady_slopes

  !> Add the columns of the states to a row.
  pure subroutine no_columns(self, states, row)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: states(:)           !! (most_friction_states); 0 without contact
    type(trace_row_t), intent(inout) :: row
  end subroutine no_columns

  !> Declare the coefficient of sliding friction.
  subroutine add_coefficient(self, list)
    class(friction_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('coefficient', self%coefficient, 'coefficient of sliding friction', range='>= 0', example='0.03', &
      usual='1e-3 to 1')
  end subroutine add_coefficient
end module friction_law
