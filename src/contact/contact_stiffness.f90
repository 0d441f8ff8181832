!> Properties of a contact that follow from materials and radii of pin and bearing: its stiffness, and the largest impact speed for
!> which an elastic law is valid.
module contact_stiffness
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: hertz_stiffness, contact_modulus, valid_impact_speed

contains

  !> Hertz stiffness of a pin in a bearing [N/m^1.5], from (4.2) and (4.3), both corrected: K = 4/(3(sigma_i + sigma_j)) sqrt(Rb
  !> Rj/(Rb - Rj)), sigma = (1 - nu^2)/E. The printed (4.2) has Rb + Rj, as for two convex surfaces; the printed (4.3) has one
  !> radius too many. Rb - Rj is the radial clearance and is an argument, since computing it would cancel digits. Limits: 0 <
  !> clearance < bearing_radius, E > 0, |nu| < 1.
  pure function hertz_stiffness(bearing_radius, clearance, youngs_modulus, poissons_ratio) result(stiffness)
    real(dp), intent(in) :: bearing_radius     !! Rb [m]
    real(dp), intent(in) :: clearance          !! radial clearance c = Rb - Rj [m]
    real(dp), intent(in) :: youngs_modulus(2)  !! of pin and bearing [Pa]
    real(dp), intent(in) :: poissons_ratio(2)  !! of pin and bearing [-]
    real(dp) :: stiffness
    real(dp) :: compliance
    compliance = sum((1 - poissons_ratio**2)/youngs_modulus)
    stiffness = 4/(3*compliance)*sqrt(bearing_radius*(bearing_radius - clearance)/clearance)
  end function hertz_stiffness

  !> E* [Pa] of two materials: 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j.
  pure real(dp) function contact_modulus(youngs_modulus, poissons_ratio)
    real(dp), intent(in) :: youngs_modulus(2)  !! of pin and bearing [Pa]
    real(dp), intent(in) :: poissons_ratio(2)  !! of pin and bearing [-]
    contact_modulus = 1/sum((1 - poissons_ratio**2)/youngs_modulus)
  end function contact_modulus

  !> Largest impact speed [m/s] for which the contact laws are valid: 1e-5 sqrt(E/rho) (remark after 4.7), the smaller value of the
  !> two materials.
  pure function valid_impact_speed(youngs_modulus, density) result(speed)
    real(dp), intent(in) :: youngs_modulus(2)  !! of pin and bearing [Pa]
    real(dp), intent(in) :: density(2)         !! of pin and bearing [kg/m^3]
    real(dp) :: speed
    speed = 1e-5_dp*sqrt(minval(youngs_modulus/density))
  end function valid_impact_speed
end module contact_stiffness
