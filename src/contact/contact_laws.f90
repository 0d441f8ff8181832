!> The contact laws and geometries that a case can name. A new one takes its `use` line and its line here.
module contact_laws
  use gudgeon_parameters, only: parameter_list_t
  use hertz, only: hertz_t
  use restitution_laws, only: lankarani_nikravesh_t, hunt_crossley_t
  use hertz_sphere, only: hertz_sphere_t
  implicit none
  private
  public :: offer_contact_laws, offer_contact_geometries

contains

  !> Hand every law to a visitor, in the order in which the template names them.
  subroutine offer_contact_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(lankarani_nikravesh_t())
    call list%law(hertz_t())
    call list%law(hunt_crossley_t())
  end subroutine offer_contact_laws

  !> The same for geometries.
  subroutine offer_contact_geometries(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(hertz_sphere_t())
  end subroutine offer_contact_geometries
end module contact_laws
