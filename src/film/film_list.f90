!> The lubricating films that a case can name. A new law needs a `use` line and a line in `offer_film_laws`.
submodule (films) film_list
  use pinkus_sternlicht, only: pinkus_sternlicht_t
  use half_film, only: half_film_t
  use oscillating_film, only: oscillating_film_t
  use finite_bearing, only: finite_bearing_t
  use short_bearing, only: short_bearing_t
  implicit none

contains

  module subroutine offer_film_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(pinkus_sternlicht_t())
    call list%law(half_film_t())
    call list%law(oscillating_film_t())
    call list%law(finite_bearing_t())
    call list%law(short_bearing_t())
  end subroutine offer_film_laws
end submodule film_list
