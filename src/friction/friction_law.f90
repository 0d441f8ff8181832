!> What every dry friction law answers.
module friction_law
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: law_t, parameter_list_t
  use trace_row, only: trace_row_t
  implicit none
  private
  public :: friction_law_t, most_friction_states

  integer, parameter :: most_friction_states = 1   !! of a law

  !> Dry friction between pin and bearing surfaces. A law may have first-order states of its own, which live in contact
  !> only: they are 0 when a contact begins. Such a law answers `state_friction`; its `friction_ratio` is that of steady sliding.
  type, abstract, extends(law_t) :: friction_law_t
    real(dp) :: coefficient = 0       !! c_f of sliding [-], >= 0
    logical :: set_valued = .false.   !! the law jumps at zero sliding speed: the scene must resolve sticking
    integer :: n_states = 0           !! of its own, 0 to most_friction_states; set by `prepare`
  contains
    procedure :: prepare => nothing_to_prepare
    procedure(friction_ratio), deferred :: friction_ratio
    procedure :: friction_ratio_slope
    procedure :: holding_ratio
    procedure :: touch_down_limit => no_limit
    procedure :: state_scale => unit_scale
    procedure :: state_friction => steady_friction
    procedure :: state_slopes => steady_slopes
    procedure :: put_columns => no_columns
    procedure, non_overridable :: add_coefficient
  end type friction_law_t

  abstract interface
    !> Friction force on the pin over the normal force [-], signed along the tangent t = (-n_y, n_x).
    pure function friction_ratio(self, sliding_speed, direction) result(ratio)
      import :: friction_law_t, dp
      class(friction_law_t), intent(in) :: self
      real(dp), value, intent(in) :: sliding_speed   !! material sliding speed of the pin surface along t [m/s]
      integer, value, intent(in) :: direction        !! sign of sliding of the current motion: -1 or +1 (for set-valued laws)
      real(dp) :: ratio
    end function friction_ratio
  end interface

contains

  !> Find what follows from the parameters, before the first force is asked for. The default has nothing to find.
  subroutine nothing_to_prepare(self)
    class(friction_law_t), intent(inout) :: self
    associate (unused_self => self)
    end associate
  end subroutine nothing_to_prepare

  !> Derivative of the ratio by the sliding speed [s/m], for implicit integration. The default is that of a law that does not
  !> depend on the size of the speed: 0.
  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    associate (unused_self => self, unused_speed => sliding_speed)
    end associate
    slope = 0
  end function friction_ratio_slope

  !> Largest friction over normal force [-] that a set-valued law has for surfaces that stick. The default is that of sliding.
  pure real(dp) function holding_ratio(self)
    class(friction_law_t), intent(in) :: self
    holding_ratio = abs(self%friction_ratio(0.0_dp, 1))
  end function holding_ratio

  !> Sliding speed [m/s] up to which friction at touch-down is not above that at rest. The default is a law that never is.
  pure real(dp) function no_limit(self)
    class(friction_law_t), intent(in) :: self
    associate (unused_self => self)
    end associate
    no_limit = huge(no_limit)
  end function no_limit

  !> Natural size of the states, for the error of steps. The default is for laws without states.
  pure real(dp) function unit_scale(self)
    class(friction_law_t), intent(in) :: self
    associate (unused_self => self)
    end associate
    unit_scale = 1
  end function unit_scale

  !> Friction force over normal force [-], as `friction_ratio`, of a law with states, and their rates. The default has none.
  pure subroutine steady_friction(self, sliding_speed, states, ratio, rates)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed            !! [m/s]
    real(dp), intent(in) :: states(self%n_states)
    real(dp), intent(out) :: ratio
    real(dp), intent(out) :: rates(self%n_states)
    ratio = self%friction_ratio(sliding_speed, nint(sign(1.0_dp, sliding_speed)))
    rates = states
  end subroutine steady_friction

  !> Derivatives of the ratio (row 1) and of the rates (rows behind) by the sliding speed (column 1) and the states (columns
  !> behind), for implicit integration.
  pure subroutine steady_slopes(self, sliding_speed, states, slopes)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp), intent(in) :: states(self%n_states)
    real(dp), intent(out) :: slopes(1 + self%n_states, 1 + self%n_states)
    associate (unused => states)
    end associate
    slopes = 0
    slopes(1, 1) = self%friction_ratio_slope(sliding_speed)
  end subroutine steady_slopes

  !> The columns of a law's states.
  pure subroutine no_columns(self, states, row)
    class(friction_law_t), intent(in) :: self
    real(dp), intent(in) :: states(:)           !! (most_friction_states); 0 while the surfaces are apart
    type(trace_row_t), intent(inout) :: row
    associate (unused_self => self, unused_states => states, unused_row => row)
    end associate
  end subroutine no_columns

  !> The key of the coefficient of sliding.
  subroutine add_coefficient(self, list)
    class(friction_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('coefficient', self%coefficient, 'coefficient of sliding friction', range='>= 0', example='0.03')
  end subroutine add_coefficient
end module friction_law
