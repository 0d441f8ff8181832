!> The lubricating films by name.
module films
  use kinds, only: dp
  use errors, only: error_t, fail, status_case_file
  use case_definition, only: lubrication_case_t
  use film_law, only: film_law_t
  use half_film, only: half_film_t
  use pinkus_sternlicht, only: pinkus_sternlicht_t, new_pinkus_sternlicht
  implicit none
  private
  public :: new_film_law

contains

  !> The film that a case asks for. Errors: an unknown law, a variant that the law does not have.
  subroutine new_film_law(definition, bearing_radius, bearing_length, clearance, relative_tolerance, film, error)
    type(lubrication_case_t), intent(in) :: definition
    real(dp), intent(in) :: bearing_radius, bearing_length   !! [m]
    real(dp), intent(in) :: clearance                        !! radial [m]
    real(dp), intent(in) :: relative_tolerance               !! of the run; a quadrature is to be finer
    class(film_law_t), allocatable, intent(out) :: film
    type(error_t), allocatable, intent(out) :: error
    type(pinkus_sternlicht_t), allocatable :: closed_form
    type(half_film_t), allocatable :: integrated

    associate (unused => relative_tolerance)
    end associate
    select case (definition%law)
    case ('pinkus_sternlicht')
      select case (definition%variant)
      case ('', 'closed_form', 'as_printed')
        allocate (closed_form)
        call new_pinkus_sternlicht(closed_form, bearing_radius, bearing_length, clearance, definition%viscosity, &
          definition%variant == 'as_printed')
        call move_alloc(closed_form, film)
      case ('half_film')
        allocate (integrated)
        call new_pinkus_sternlicht(integrated, bearing_radius, bearing_length, clearance, definition%viscosity, .false.)
        call move_alloc(integrated, film)
      case default
        call fail(error, "&lubrication variant = '"//trim(definition%variant)// &
          "': must be 'closed_form', 'as_printed' or 'half_film' for law 'pinkus_sternlicht'", status_case_file)
      end select
    case default
      call fail(error, "&lubrication law = '"//trim(definition%law)// &
        "': must be 'pinkus_sternlicht' or 'oscillating_film'", status_case_file)
    end select
  end subroutine new_film_law
end module films
