!> The load elements of a joint. A new kind needs a `use` line and a line in `add_elements`.
module load_elements
  use kinds, only: dp
  use joint_case, only: joint_case_t
  use load_element, only: load_element_t
  use clearance_joint, only: clearance_joint_t, phase_film, phase_contact
  use dry_contact, only: dry_contact_t
  use worn_contact, only: worn_contact_t
  use weighted_contact, only: weighted_contact_t
  use oil_film, only: oil_film_t
  use rough_film, only: rough_film_t
  use elastic_film, only: elastic_film_t
  implicit none
  private
  public :: add_elements

contains

  !> Add the elements for the laws that a case names to a joint, each with the phases in which it acts: see load_element_t.
  subroutine add_elements(wanted, tolerance, makes_tables, joint)
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    type(clearance_joint_t), intent(inout) :: joint
    if (wanted%has_weighted_film()) then
      call add(weighted_contact_t(), [phase_film, phase_contact])
      return
    end if
    if (wanted%has_worn_bore()) then
      call add(worn_contact_t(), [phase_contact])
    else if (wanted%can_touch()) then
      call add(dry_contact_t(), [phase_contact])
    end if
    if (wanted%has_elastic_film()) then
      call add(elastic_film_t(), [phase_film])
    else if (allocated(wanted%asperities)) then
      call add(rough_film_t(), [phase_film])
    else if (allocated(wanted%film)) then
      call add(oil_film_t(), [phase_film])
    end if

  contains

    subroutine add(element, phases)
      class(load_element_t), intent(in) :: element
      integer, intent(in) :: phases(:)
      class(load_element_t), allocatable :: prepared
      allocate (prepared, source=element)
      prepared%bearing = joint%bearing
      prepared%pin_radius = joint%pin_radius
      call prepared%prepare(wanted, tolerance, makes_tables)
      call joint%add(prepared, phases)
    end subroutine add
  end subroutine add_elements
end module load_elements
