!> The lubricating films that a case can name. A new law needs a `use` line and a line with its name below. A type that
!> implements one variant of a law comes before that of the others.
module films
  use model_parameters, only: parameter_list_t
  use pinkus_sternlicht, only: pinkus_sternlicht_t
  use half_film, only: half_film_t
  use oscillating_film, only: oscillating_film_t
  use finite_bearing, only: finite_bearing_t
  use short_bearing, only: short_bearing_t
  implicit none
  private
  public :: offer_film_laws

contains

  !> Declare all laws to a visitor, in the order of the template.
  subroutine offer_film_laws(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('pinkus_sternlicht', half_film_t(), variant='half_film')
    call list%law('pinkus_sternlicht', pinkus_sternlicht_t())
    call list%law('oscillating_film', oscillating_film_t())
    call list%law('finite_bearing', short_bearing_t(), variant='short')
    call list%law('finite_bearing', finite_bearing_t())
  end subroutine offer_film_laws
end module films
