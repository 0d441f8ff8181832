!> The contact laws that a case can name. A new law takes its `use` line and its line here.
module contact_laws
  use gudgeon_parameters, only: parameter_list_t
  use hertz, only: hertz_t
  use lankarani_nikravesh, only: lankarani_nikravesh_t
  use hunt_crossley, only: hunt_crossley_t
  implicit none
  private
  public :: offer_contact_laws

contains

  !> Hand every law to a visitor, in the order in which the template names them.
  subroutine offer_contact_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(lankarani_nikravesh_t())
    call list%law(hertz_t())
    call list%law(hunt_crossley_t())
  end subroutine offer_contact_laws
end module contact_laws
