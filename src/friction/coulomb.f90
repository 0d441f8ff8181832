!> Coulomb friction (4.8).
module coulomb
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use static_friction, only: static_friction_t
  implicit none
  private
  public :: coulomb_t

  !> F_T = -c_f F_N sign(v_T), set-valued at v_T = 0: surfaces stick while |F_T| <= c_s F_N.
  type, extends(static_friction_t) :: coulomb_t
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: sliding_ratio
    procedure :: holding_ratio
  end type coulomb_t

contains

  subroutine parameters(self, list)
    class(coulomb_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_coefficient(list)
    call self%add_static(list)
  end subroutine parameters

  subroutine prepare(self)
    class(coulomb_t), intent(inout) :: self
    self%set_valued = .true.
  end subroutine prepare

  !> (4.8), for a speed other than 0.
  pure function sliding_ratio(self, sliding_speed) result(ratio)
    class(coulomb_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    real(dp) :: ratio
    ratio = -sign(self%coefficient, sliding_speed)
  end function sliding_ratio

  pure real(dp) function holding_ratio(self)
    class(coulomb_t), intent(in) :: self
    holding_ratio = self%holding_coefficient()
  end function holding_ratio
end module coulomb
