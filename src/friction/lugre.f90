!> LuGre friction (Canudas de Wit, Olsson, Astrom & Lischinsky 1995, IEEE Trans. Autom. Control 40, 419).
module lugre
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use bristle_law, only: bristle_law_t
  implicit none
  private
  public :: lugre_t

  !> z' = v - s_0 |v| z/g(v), where g is the friction of steady sliding. Under an oscillating load below static friction the
  !> surfaces drift; with `elasto_plastic` they do not.
  type, extends(bristle_law_t) :: lugre_t
  contains
    procedure :: parameters
    procedure :: bristle_rate
    procedure :: rate_slopes
  end type lugre_t

contains

  subroutine parameters(self, list)
    class(lugre_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_common(list)
    call self%add_sliding(list)
  end subroutine parameters

  pure real(dp) function bristle_rate(self, v, z)
    class(lugre_t), intent(in) :: self
    real(dp), intent(in) :: v, z
    real(dp) :: g
    call self%steady_sliding(v, g)
    bristle_rate = v - self%bristle_stiffness*abs(v)*z/g
  end function bristle_rate

  pure subroutine rate_slopes(self, v, z, by_speed, by_deflection)
    class(lugre_t), intent(in) :: self
    real(dp), intent(in) :: v, z
    real(dp), intent(out) :: by_speed, by_deflection
    real(dp) :: g, g_slope
    call self%steady_sliding(v, g, g_slope)
    by_deflection = -self%bristle_stiffness*abs(v)/g
    by_speed = 1 - self%bristle_stiffness*z/g*(sign_of(v) - abs(v)*g_slope/g)
  end subroutine rate_slopes

  !> Sign of a number: -1, 0 or 1.
  pure real(dp) function sign_of(v)
    real(dp), intent(in) :: v
    sign_of = 0
    if (abs(v) > 0) sign_of = sign(1.0_dp, v)
  end function sign_of
end module lugre
