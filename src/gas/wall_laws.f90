!> The laws of the heat to the walls that a case can name. A new one needs a `use` line and a line with its name below.
module wall_laws
  use model_parameters, only: parameter_list_t
  use woschni, only: woschni_t
  use hohenberg, only: hohenberg_t
  use reynolds_walls, only: reynolds_walls_t
  use constant_walls, only: constant_walls_t
  implicit none
  private
  public :: offer_wall_laws

contains

  !> Declare all laws to a visitor, in the order of the template.
  subroutine offer_wall_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('woschni', woschni_t())
    call list%law('hohenberg', hohenberg_t())
    call list%law('reynolds', reynolds_walls_t())
    call list%law('constant', constant_walls_t())
  end subroutine offer_wall_laws
end module wall_laws
