!> The elements of the guide. A new kind needs a `use` line and a line in `build_guide`.
module guide_elements
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t
  use piston_guide, only: piston_guide_t
  use bore_friction, only: bore_friction_t
  use skirt_corners, only: skirt_corners_t
  use ring_friction, only: ring_friction_t
  use skirt_film, only: skirt_film_t
  implicit none
  private
  public :: build_guide

contains

  !> Build the guide of a case, with the elements for the laws that it names. Its initial state is set elsewhere.
  subroutine build_guide(wanted, guide)
    type(guide_case_t), intent(in) :: wanted
    type(piston_guide_t), intent(out) :: guide
    guide%skirt_t = wanted%skirt()
    call add(bore_friction_t())
    if (wanted%has_corners()) call add(skirt_corners_t())
    if (wanted%is_lubricated()) call add(skirt_film_t())
    if (wanted%is_lubricated()) guide%filmed = guide%n_elements
    if (allocated(wanted%rings%rings)) call add(ring_friction_t())

  contains

    subroutine add(element)
      class(guide_element_t), intent(in) :: element
      class(guide_element_t), allocatable :: prepared
      allocate (prepared, source=element)
      call prepared%prepare(wanted)
      call guide%add(prepared)
    end subroutine add
  end subroutine build_guide
end module guide_elements
