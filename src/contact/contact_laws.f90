!> The contact laws and geometries that a case can name.
!> The submodule `contact_law_list` lists them. So a change of a law does not require the modules that use this one to be
!> compiled again.
module contact_laws
  use gudgeon_parameters, only: parameter_list_t
  implicit none
  private
  public :: offer_contact_laws, offer_contact_geometries

  interface
    !> Declare all laws to a visitor, in the order of the template.
    module subroutine offer_contact_laws(list)
      class(parameter_list_t), intent(inout) :: list
    end subroutine offer_contact_laws

    !> Declare all geometries to a visitor, in the order of the template.
    module subroutine offer_contact_geometries(list)
      class(parameter_list_t), intent(inout) :: list
    end subroutine offer_contact_geometries
  end interface
end module contact_laws
