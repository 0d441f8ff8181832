!> What every dry friction law answers.
module friction_law
  use kinds, only: dp
  implicit none
  private
  public :: friction_law_t

  !> Dry friction between pin and bearing surfaces.
  type, abstract :: friction_law_t
    logical :: set_valued = .false.   !! the law jumps at zero sliding speed: the scene must resolve sticking
  contains
    procedure(friction_ratio), deferred :: friction_ratio
  end type friction_law_t

  abstract interface
    !> Friction force on the pin over the normal force [-], signed along the tangent t = (-n_y, n_x).
    pure function friction_ratio(self, sliding_speed, direction) result(ratio)
      import :: friction_law_t, dp
      class(friction_law_t), intent(in) :: self
      real(dp), intent(in) :: sliding_speed   !! material sliding speed of the pin surface along t [m/s]
      integer, intent(in) :: direction        !! sign of sliding of the current motion: -1 or +1 (used by set-valued laws only)
      real(dp) :: ratio
    end function friction_ratio
  end interface
end module friction_law
