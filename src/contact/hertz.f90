!> Contact without damping (4.1).
module hertz
  use model_parameters, only: parameter_list_t
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: hertz_t

  !> The elastic force alone, independent of all speeds.
  type, extends(contact_law_t) :: hertz_t
  contains
    procedure :: parameters
    procedure, nopass :: is_elastic
  end type hertz_t

contains

  subroutine parameters(self, list)
    class(hertz_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
  end subroutine parameters

  pure logical function is_elastic()
    is_elastic = .true.
  end function is_elastic
end module hertz
