!> The contact laws and geometries that a case can name. A new one needs a `use` line and a line in one of the procedures below.
submodule (contact_laws) contact_law_list
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

contains

  module subroutine offer_contact_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(lankarani_nikravesh_t())
    call list%law(hertz_t())
    call list%law(hunt_crossley_t())
    call list%law(exact_restitution_t())
    call list%law(flores_t())
    call list%law(gonthier_t())
    call list%law(carvalho_martins_t())
    call list%law(herbert_mcwhannell_t())
    call list%law(zhiying_qishao_t())
    call list%law(adams_impact_t())
  end subroutine offer_contact_laws

  module subroutine offer_contact_geometries(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(hertz_sphere_t())
    call list%law(johnson_t())
    call list%law(conformal_t())
    call list%law(pereira_t())
    call list%law(winkler_t())
  end subroutine offer_contact_geometries
end submodule contact_law_list
