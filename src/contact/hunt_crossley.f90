!> Hunt and Crossley's contact (1975): that of Lankarani and Nikravesh with another relation between loss and restitution.
module hunt_crossley
  use gudgeon_kinds, only: dp
  use lankarani_nikravesh, only: lankarani_nikravesh_t
  implicit none
  private
  public :: hunt_crossley_t

  type, extends(lankarani_nikravesh_t) :: hunt_crossley_t
  contains
    procedure, nopass :: name
    procedure :: set_restitution
  end type hunt_crossley_t

contains

  pure function name()
    character(len=:), allocatable :: name
    name = 'hunt_crossley'
  end function name

  !> chi = (3/2)(1 - e), exact to first order for e near 1. A free impact gives back more than e: 0.909 for 0.9, 0.663 for 0.5.
  pure subroutine set_restitution(self, restitution)
    class(hunt_crossley_t), intent(inout) :: self
    real(dp), intent(in) :: restitution   !! e, 0 to 1
    self%damping = 1.5_dp*(1 - restitution)
  end subroutine set_restitution
end module hunt_crossley
