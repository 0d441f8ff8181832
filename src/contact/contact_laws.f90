!> The contact laws and geometries that a case can name. A new one needs a `use` line and a line with its name in one of the
!> procedures below.
module contact_laws
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use contact_geometry, only: contact_geometry_t
  use hertz, only: hertz_t
  use restitution_laws, only: lankarani_nikravesh_t, hunt_crossley_t, herbert_mcwhannell_t, gonthier_t, zhiying_qishao_t, &
    flores_t, carvalho_martins_t
  use exact_restitution, only: exact_restitution_t
  use adams_impact, only: adams_impact_t
  use hertz_sphere, only: hertz_sphere_t
  use johnson, only: johnson_t
  use conformal, only: conformal_t
  use pereira, only: pereira_t
  use winkler, only: winkler_t
  implicit none
  private
  public :: offer_contact_laws, offer_contact_geometries, new_power_geometry

contains

  !> Declare all laws to a visitor, in the order of the template.
  subroutine offer_contact_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('lankarani_nikravesh', lankarani_nikravesh_t())
    call list%law('hertz', hertz_t())
    call list%law('hunt_crossley', hunt_crossley_t())
    call list%law('exact', exact_restitution_t())
    call list%law('flores', flores_t())
    call list%law('gonthier', gonthier_t())
    call list%law('carvalho_martins', carvalho_martins_t())
    call list%law('herbert_mcwhannell', herbert_mcwhannell_t())
    call list%law('zhiying_qishao', zhiying_qishao_t())
    call list%law('impact', adams_impact_t())
  end subroutine offer_contact_laws

  !> Declare all geometries to a visitor, in the order of the template.
  subroutine offer_contact_geometries(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('hertz_sphere', hertz_sphere_t())
    call list%law('johnson', johnson_t())
    call list%law('conformal', conformal_t())
    call list%law('pereira', pereira_t())
    call list%law('winkler', winkler_t())
  end subroutine offer_contact_geometries

  !> The geometry whose elastic force is a stiffness [N/m^exponent] times a power of the penetration.
  subroutine new_power_geometry(stiffness, exponent, geometry)
    real(dp), intent(in) :: stiffness, exponent
    class(contact_geometry_t), allocatable, intent(out) :: geometry
    allocate (geometry, source=hertz_sphere_t(given_stiffness=stiffness, exponent=exponent))
  end subroutine new_power_geometry
end module contact_laws
