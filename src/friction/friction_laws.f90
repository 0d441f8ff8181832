!> The friction laws that a case can name.
!> The submodule `friction_law_list` lists them. So a change of a law does not require the modules that use this one to be
!> compiled again.
module friction_laws
  use gudgeon_parameters, only: parameter_list_t
  implicit none
  private
  public :: offer_friction_laws, offer_speed_laws

  interface
    !> Declare all laws to a visitor, in the order of the template.
    module subroutine offer_friction_laws(list)
      class(parameter_list_t), intent(inout) :: list
    end subroutine offer_friction_laws

    !> Declare the laws in which friction depends on the sliding speed alone: without states and without sticking.
    module subroutine offer_speed_laws(list)
      class(parameter_list_t), intent(inout) :: list
    end subroutine offer_speed_laws
  end interface
end module friction_laws
