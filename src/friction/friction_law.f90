!> What every dry friction law answers.
module friction_law
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: law_t
  implicit none
  private
  public :: friction_law_t, static_or_sliding, static_conflict

  !> Dry friction between pin and bearing surfaces.
  type, abstract, extends(law_t) :: friction_law_t
    logical :: set_valued = .false.   !! the law jumps at zero sliding speed: the scene must resolve sticking
  contains
    procedure :: prepare => nothing_to_prepare
    procedure(friction_ratio), deferred :: friction_ratio
    procedure :: friction_ratio_slope
    procedure :: holding_ratio
  end type friction_law_t

  abstract interface
    !> Friction force on the pin over the normal force [-], signed along the tangent t = (-n_y, n_x).
    pure function friction_ratio(self, sliding_speed, direction) result(ratio)
      import :: friction_law_t, dp
      class(friction_law_t), intent(in) :: self
      real(dp), value, intent(in) :: sliding_speed   !! material sliding speed of the pin surface along t [m/s]
      integer, value, intent(in) :: direction        !! sign of sliding of the current motion: -1 or +1 (used by set-valued laws only)
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

  !> Coefficient of friction at rest as it is meant: a case that gives none, 0, means that of sliding.
  pure real(dp) function static_or_sliding(static, sliding)
    real(dp), intent(in) :: static, sliding
    static_or_sliding = sliding
    if (static > 0) static_or_sliding = static
  end function static_or_sliding

  !> Refuse, in the way of `conflict`, friction at rest that is smaller than that of sliding.
  pure subroutine static_conflict(static, sliding, key, wanted)
    real(dp), intent(in) :: static, sliding
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'must be >= coefficient, or 0: as coefficient'
    if (static_or_sliding(static, sliding) < sliding) key = 'static_coefficient'
  end subroutine static_conflict
end module friction_law
