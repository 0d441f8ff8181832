!> The lubricating films by name.
module films
  use kinds, only: dp
  use errors, only: error_t, fail, status_case_file, status_internal
  use case_definition, only: lubrication_case_t
  use film_law, only: film_law_t
  use oscillating_film, only: oscillating_film_t, new_oscillating_film
  use oscillating_response, only: oscillating_response_t, new_oscillating_response
  use half_film, only: half_film_t
  use pinkus_sternlicht, only: pinkus_sternlicht_t, new_pinkus_sternlicht
  implicit none
  private
  public :: new_film_law

  !> Error allowed to means over the film, over the run's relative tolerance, and at most.
  real(dp), parameter :: mean_margin = 1e-4_dp
  real(dp), parameter :: coarsest_mean = 1e-8_dp

contains

  !> The film that a case asks for. Errors: an unknown law, a variant that the law does not have. The oscillating film's
  !> means are finer than the run by `mean_margin`.
  subroutine new_film_law(definition, bearing_radius, bearing_length, clearance, relative_tolerance, film, error, &
    rod_length)
    type(lubrication_case_t), intent(in) :: definition
    real(dp), intent(in) :: bearing_radius, bearing_length   !! [m]
    real(dp), intent(in) :: clearance                        !! radial [m]
    real(dp), intent(in) :: relative_tolerance               !! of the run
    class(film_law_t), allocatable, intent(out) :: film
    type(error_t), allocatable, intent(out) :: error
    real(dp), intent(in), optional :: rod_length             !! [m]; needed by the oscillating film as printed
    type(pinkus_sternlicht_t), allocatable :: closed_form
    type(half_film_t), allocatable :: integrated

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
        call refuse_variant("'closed_form', 'as_printed' or 'half_film'")
      end select
    case ('oscillating_film')
      select case (definition%variant)
      case ('', 'bearing_frame')
        call make_oscillating(0.0_dp)
      case ('as_printed')
        if (present(rod_length)) then
          call make_oscillating(rod_length)
        else
          call fail(error, "the oscillating film as printed needs the rod's length", status_internal)
        end if
      case default
        call refuse_variant("'bearing_frame' or 'as_printed'")
      end select
    case default
      call fail(error, "&lubrication law = '"//trim(definition%law)// &
        "': must be 'pinkus_sternlicht' or 'oscillating_film'", status_case_file)
    end select

  contains

    !> The oscillating film: as printed if there is an arm.
    subroutine make_oscillating(arm_length)
      real(dp), intent(in) :: arm_length
      type(oscillating_film_t), allocatable :: oscillating
      type(oscillating_response_t) :: response
      real(dp) :: accuracy
      accuracy = min(max(mean_margin*relative_tolerance, epsilon(1.0_dp)), coarsest_mean)
      call new_oscillating_response(response, accuracy, definition%quadrature_points, arm_length > 0)
      allocate (oscillating)
      call new_oscillating_film(oscillating, response, bearing_radius, bearing_length, clearance, definition%viscosity, &
        definition%kinematic_viscosity)
      oscillating%arm_length = arm_length
      oscillating%largest_ratio = 1 - definition%least_film_ratio
      call move_alloc(oscillating, film)
    end subroutine make_oscillating

    subroutine refuse_variant(allowed)
      character(len=*), intent(in) :: allowed
      call fail(error, "&lubrication variant = '"//trim(definition%variant)//"': must be "//allowed//" for law '"// &
        trim(definition%law)//"'", status_case_file)
    end subroutine refuse_variant
  end subroutine new_film_law
end module films
