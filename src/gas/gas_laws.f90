!> The cycles of the gas that a case can name.
!> The submodule `gas_law_list` lists them. So a change of a law does not require the modules that use this one to be
!> compiled again.
module gas_laws
  use gudgeon_parameters, only: parameter_list_t
  implicit none
  private
  public :: offer_gas_cycles

  interface
    !> Declare all cycles to a visitor, in the order of the template.
    module subroutine offer_gas_cycles(list)
      class(parameter_list_t), intent(inout) :: list
    end subroutine offer_gas_cycles
  end interface
end module gas_laws
