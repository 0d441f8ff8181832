!> Elasto-plastic friction (Dupont, Hayward, Armstrong & Altpeter 2002, IEEE Trans. Autom. Control 47, 787): bristles that slip only
!> above a break-away deflection, so that sticking surfaces do not drift.
module elasto_plastic
  use kinds, only: dp
  use constants, only: pi
  use model_parameters, only: parameter_list_t
  use bristle_law, only: bristle_law_t
  implicit none
  private
  public :: elasto_plastic_t

  !> z' = v [1 - a(z, v) z sign(v)/z_ss], z_ss = g(v)/s_0. The plastic share a is 0 for |z| <= z_ba = k c_f/s_0 and while the
  !> deflection decreases (v z <= 0), 1 for |z| >= z_ss, and half a period of a sine in between.
  type, extends(bristle_law_t) :: elasto_plastic_t
    real(dp) :: breakaway_ratio = 0.7_dp   !! k [-], 0 to less than 1
  contains
    procedure :: parameters
    procedure :: bristle_rate
    procedure :: rate_slopes
  end type elasto_plastic_t

contains

  subroutine parameters(self, list)
    class(elasto_plastic_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_common(list)
    call self%add_sliding(list)
    call list%add('breakaway_ratio', self%breakaway_ratio, &
      'break-away deflection of the bristles over their deflection in steady sliding', range='>= 0 and < 1', default='0.7', &
      usual='0.1 to 1')
  end subroutine parameters

  pure real(dp) function bristle_rate(self, v, z)
    class(elasto_plastic_t), intent(in) :: self
    real(dp), intent(in) :: v, z
    real(dp) :: g, share
    bristle_rate = v
    if (.not. v*z > 0) return
    call self%steady_sliding(v, g)
    call find_share(abs(z), g/self%bristle_stiffness, elastic_limit(self), share)
    bristle_rate = v*(1 - share*abs(z)*self%bristle_stiffness/g)
  end function bristle_rate

  pure subroutine rate_slopes(self, v, z, by_speed, by_deflection)
    class(elasto_plastic_t), intent(in) :: self
    real(dp), intent(in) :: v, z
    real(dp), intent(out) :: by_speed, by_deflection
    real(dp) :: g, g_slope, share, by_size, by_steady, steady_slope
    by_speed = 1
    by_deflection = 0
    if (.not. v*z > 0) return
    call self%steady_sliding(v, g, g_slope)
    associate (size => abs(z), steady => g/self%bristle_stiffness)
      call find_share(size, steady, elastic_limit(self), share, by_size, by_steady)
      steady_slope = g_slope/self%bristle_stiffness
      by_deflection = -abs(v)*(share + size*by_size)/steady
      by_speed = 1 - share*size/steady - v*steady_slope*(by_steady*size/steady - share*size/steady**2)
    end associate
  end subroutine rate_slopes

  !> Break-away deflection z_ba [m].
  pure real(dp) function elastic_limit(self)
    class(elasto_plastic_t), intent(in) :: self
    elastic_limit = self%breakaway_ratio*self%coefficient/self%bristle_stiffness
  end function elastic_limit

  !> Plastic share a as a function of |z|, z_ss and z_ba, with its derivatives with respect to the first two [1/m]. It and its
  !> derivatives are continuous.
  pure subroutine find_share(size, steady, limit, share, by_size, by_steady)
    real(dp), intent(in) :: size, steady, limit   !! [m]
    real(dp), intent(out) :: share
    real(dp), intent(out), optional :: by_size, by_steady
    real(dp) :: part, slope
    part = min(max((size - limit)/(steady - limit), 0.0_dp), 1.0_dp)
    share = 0.5_dp*(1 - cos(pi*part))
    if (.not. present(by_size)) return
    slope = 0.5_dp*pi*sin(pi*part)/(steady - limit)
    by_size = slope
    by_steady = -slope*part
  end subroutine find_share
end module elasto_plastic
