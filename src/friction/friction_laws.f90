!> The friction laws that a case can name. A new law needs a `use` line and a line with its name in `offer_friction_laws`.
module friction_laws
  use model_parameters, only: parameter_list_t
  use ambrosio, only: ambrosio_t
  use coulomb, only: coulomb_t
  use threlfall, only: threlfall_t
  use brown_mcphee, only: brown_mcphee_t
  use stribeck, only: stribeck_t
  use lugre, only: lugre_t
  use dahl, only: dahl_t
  use elasto_plastic, only: elasto_plastic_t
  implicit none
  private
  public :: offer_friction_laws, offer_speed_laws

contains

  !> Declare all laws to a visitor, in the order of the template.
  subroutine offer_friction_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('ambrosio', ambrosio_t())
    call list%law('coulomb', coulomb_t())
    call list%law('threlfall', threlfall_t())
    call list%law('brown_mcphee', brown_mcphee_t())
    call list%law('stribeck', stribeck_t())
    call list%law('lugre', lugre_t())
    call list%law('dahl', dahl_t())
    call list%law('elasto_plastic', elasto_plastic_t())
  end subroutine offer_friction_laws

  !> Declare the laws in which friction depends on the sliding speed alone: without states and without sticking.
  subroutine offer_speed_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('ambrosio', ambrosio_t())
    call list%law('threlfall', threlfall_t())
    call list%law('brown_mcphee', brown_mcphee_t())
    call list%law('stribeck', stribeck_t())
  end subroutine offer_speed_laws
end module friction_laws
