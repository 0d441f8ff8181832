!> The contact laws whose damping follows from a coefficient of restitution by one formula, chi(e). The three numbers after each
!> formula are the actual restitution of a free impact for e = 0.9, 0.5 and 0.1.
module restitution_laws
  use kinds, only: dp
  use restitution_law, only: restitution_law_t, one_percent
  implicit none
  private
  public :: lankarani_nikravesh_t, hunt_crossley_t, herbert_mcwhannell_t, gonthier_t, zhiying_qishao_t, flores_t, carvalho_martins_t

  !> Lankarani and Nikravesh 1990 (4.7): chi = (3/4)(1 - e^2). 0.913, 0.725, 0.665.
  type, extends(restitution_law_t) :: lankarani_nikravesh_t
  contains
    procedure, nopass :: damping_for => lankarani_nikravesh_damping
  end type lankarani_nikravesh_t

  !> Hunt and Crossley 1975: chi = (3/2)(1 - e), exact to first order for e near 1. 0.909, 0.663, 0.516.
  type, extends(restitution_law_t) :: hunt_crossley_t
  contains
    procedure, nopass :: damping_for => hunt_crossley_damping
  end type hunt_crossley_t

  !> Herbert and McWhannell 1977: chi = 6(1 - e)/[(2e - 1)^2 + 3], exact to second order for e near 1. 0.901, 0.594, 0.491.
  type, extends(restitution_law_t) :: herbert_mcwhannell_t
  contains
    procedure, nopass :: damping_for => herbert_mcwhannell_damping
  end type herbert_mcwhannell_t

  !> Gonthier and others 2004: chi = (1 - e^2)/e. 0.876, 0.488, 0.101.
  type, extends(restitution_law_t) :: gonthier_t
  contains
    procedure, nopass :: damping_for => gonthier_damping
    procedure, nopass :: least_restitution => one_percent
  end type gonthier_t

  !> Zhiying and Qishao 2006: chi = (3/4)(1 - e^2) exp(2(1 - e)). 0.896, 0.483, 0.217.
  type, extends(restitution_law_t) :: zhiying_qishao_t
  contains
    procedure, nopass :: damping_for => zhiying_qishao_damping
  end type zhiying_qishao_t

  !> Flores and others 2011: chi = 8(1 - e)/(5e). 0.894, 0.470, 0.069.
  type, extends(restitution_law_t) :: flores_t
  contains
    procedure, nopass :: damping_for => flores_damping
    procedure, nopass :: least_restitution => one_percent
  end type flores_t

  !> Carvalho and Martins 2019: chi = (3/2)(1 - e)(11 - e)/(1 + 9e) for e > 1/3, otherwise as Gonthier; both agree at 1/3. 0.900,
  !> 0.500, 0.101.
  type, extends(restitution_law_t) :: carvalho_martins_t
  contains
    procedure, nopass :: damping_for => carvalho_martins_damping
    procedure, nopass :: least_restitution => one_percent
  end type carvalho_martins_t

contains

  pure real(dp) function lankarani_nikravesh_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 0.75_dp*(1 - restitution**2)
  end function lankarani_nikravesh_damping

  pure real(dp) function hunt_crossley_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 1.5_dp*(1 - restitution)
  end function hunt_crossley_damping

  pure real(dp) function herbert_mcwhannell_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 6*(1 - restitution)/((2*restitution - 1)**2 + 3)
  end function herbert_mcwhannell_damping

  pure real(dp) function gonthier_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = (1 - restitution**2)/restitution
  end function gonthier_damping

  pure real(dp) function zhiying_qishao_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 0.75_dp*(1 - restitution**2)*exp(2*(1 - restitution))
  end function zhiying_qishao_damping

  pure real(dp) function flores_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 1.6_dp*(1 - restitution)/restitution
  end function flores_damping

  pure real(dp) function carvalho_martins_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    if (restitution > 1/3.0_dp) then
      damping = 1.5_dp*(1 - restitution)*(11 - restitution)/(1 + 9*restitution)
    else
      damping = gonthier_damping(restitution)
    end if
  end function carvalho_martins_damping
end module restitution_laws
