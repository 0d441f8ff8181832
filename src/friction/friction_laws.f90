!> The friction laws by name.
module friction_laws
  use errors, only: error_t, fail, status_case_file
  use case_definition, only: friction_case_t
  use friction_law, only: friction_law_t
  use ambrosio, only: ambrosio_t, new_ambrosio
  use coulomb, only: coulomb_t, new_coulomb
  implicit none
  private
  public :: new_friction_law

contains

  !> The friction law that a case asks for. Ambrosio's with v0 = v1 = 0 is Coulomb's. Error: an unknown law.
  subroutine new_friction_law(definition, law, error)
    type(friction_case_t), intent(in) :: definition
    class(friction_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(ambrosio_t), allocatable :: ramped
    type(coulomb_t), allocatable :: sharp

    select case (definition%law)
    case ('ambrosio')
      if (definition%v1 > 0) then
        allocate (ramped)
        call new_ambrosio(ramped, definition%coefficient, definition%v0, definition%v1)
        call move_alloc(ramped, law)
      else
        allocate (sharp)
        call new_coulomb(sharp, definition%coefficient)
        call move_alloc(sharp, law)
      end if
    case ('coulomb')
      allocate (sharp)
      call new_coulomb(sharp, definition%coefficient)
      call move_alloc(sharp, law)
    case default
      call fail(error, "&friction law = '"//trim(definition%law)//"': must be 'ambrosio' or 'coulomb'", &
        status_case_file)
    end select
  end subroutine new_friction_law
end module friction_laws
