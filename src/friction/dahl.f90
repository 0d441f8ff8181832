!> Dahl's friction (1968): bristles without damping, and static friction equal to sliding friction.
module dahl
  use model_parameters, only: parameter_list_t
  use lugre, only: lugre_t
  implicit none
  private
  public :: dahl_t

  !> z' = v - s_0 |v| z/c_f, F_T/F_N = -s_0 z: the LuGre law with c_s = c_f and s_1 = s_2 = 0. For sliding over a distance x in one
  !> direction, from z = 0, z = (c_f/s_0) (1 - exp(-s_0 x/c_f)).
  type, extends(lugre_t) :: dahl_t
  contains
    procedure :: parameters
  end type dahl_t

contains

  subroutine parameters(self, list)
    class(dahl_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_common(list)
  end subroutine parameters
end module dahl
