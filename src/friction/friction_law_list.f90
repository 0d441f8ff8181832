!> The friction laws that a case can name. A new law needs a `use` line and a line in `offer_friction_laws`.
submodule (friction_laws) friction_law_list
  use ambrosio, only: ambrosio_t
  use coulomb, only: coulomb_t
  use threlfall, only: threlfall_t
  use brown_mcphee, only: brown_mcphee_t
  use stribeck, only: stribeck_t
  use lugre, only: lugre_t
  use dahl, only: dahl_t
  use elasto_plastic, only: elasto_plastic_t
  implicit none

contains

  module subroutine offer_friction_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(ambrosio_t())
    call list%law(coulomb_t())
    call list%law(threlfall_t())
    call list%law(brown_mcphee_t())
    call list%law(stribeck_t())
    call list%law(lugre_t())
    call list%law(dahl_t())
    call list%law(elasto_plastic_t())
  end subroutine offer_friction_laws

  module subroutine offer_speed_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(ambrosio_t())
    call list%law(threlfall_t())
    call list%law(brown_mcphee_t())
    call list%law(stribeck_t())
  end subroutine offer_speed_laws
end submodule friction_law_list
