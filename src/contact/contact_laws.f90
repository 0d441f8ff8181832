!> The contact laws by name.
module contact_laws
  use kinds, only: dp
  use errors, only: error_t, fail, status_case_file
  use case_definition, only: contact_case_t
  use contact_law, only: contact_law_t
  use contact_stiffness, only: hertz_stiffness
  use hertz, only: hertz_t
  use lankarani_nikravesh, only: lankarani_nikravesh_t
  implicit none
  private
  public :: new_contact_law

contains

  !> The contact law that a case asks for. A stiffness of 0 means Hertz's, from the materials and the radii.
  !> Error: an unknown law.
  subroutine new_contact_law(definition, bearing_radius, clearance, law, error)
    type(contact_case_t), intent(in) :: definition
    real(dp), intent(in) :: bearing_radius   !! [m]
    real(dp), intent(in) :: clearance        !! radial [m]
    class(contact_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(hertz_t), allocatable :: elastic
    type(lankarani_nikravesh_t), allocatable :: dissipative
    real(dp) :: stiffness

    stiffness = definition%stiffness
    if (.not. stiffness > 0) stiffness = hertz_stiffness(bearing_radius, clearance, definition%youngs_modulus, &
      definition%poissons_ratio)

    select case (definition%law)
    case ('hertz')
      allocate (elastic)
      call elastic%set_elastic_part(stiffness, definition%exponent)
      call move_alloc(elastic, law)
    case ('lankarani_nikravesh')
      allocate (dissipative)
      call dissipative%set_elastic_part(stiffness, definition%exponent)
      call dissipative%set_restitution(definition%restitution)
      dissipative%least_impact_speed = definition%least_impact_speed
      call move_alloc(dissipative, law)
    case default
      call fail(error, "&contact law = '"//trim(definition%law)//"': must be 'lankarani_nikravesh' or 'hertz'", &
        status_case_file)
    end select
  end subroutine new_contact_law
end module contact_laws
