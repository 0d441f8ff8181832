!> The lubricating films that a case can name.
!> The submodule `film_list` lists them. So a change of a law does not require the modules that use this one to be
!> compiled again.
module films
  use gudgeon_parameters, only: parameter_list_t
  implicit none
  private
  public :: offer_film_laws

  interface
    !> Declare all laws to a visitor, in the order of the template.
    module subroutine offer_film_laws(list)
      class(parameter_list_t), intent(inout) :: list
    end subroutine offer_film_laws
  end interface
end module films
