!> The oil on the wall of the bore in a case: that of piston rings, or of the film of a skirt.
module wall_oil
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use oil_viscosity, only: oil_t
  implicit none
  private
  public :: wall_oil_t

  type, extends(has_parameters_t) :: wall_oil_t
    character(len=:), allocatable :: law
    type(oil_t) :: oil
    real(dp) :: given_viscosity = 0        !! [Pa s]
  contains
    procedure :: parameters => oil_parameters
    procedure :: viscosity
  end type wall_oil_t

contains

  subroutine oil_parameters(self, list)
    class(wall_oil_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('law', self%law, 'reynolds', 'reynolds', 'film: Reynolds'' equation')
    call self%oil%parameters(list)
    call list%add('viscosity', self%given_viscosity, 'dynamic viscosity; required unless viscosity_law gives it', 'Pa s', '> 0', &
      default='0.0', example='0.008', usual='1e-4 to 1')
  end subroutine oil_parameters

  !> Viscosity of the oil [Pa s].
  real(dp) function viscosity(self)
    class(wall_oil_t), intent(in) :: self
    viscosity = self%given_viscosity
    if (self%oil%is_known()) viscosity = self%oil%dynamic_viscosity()
  end function viscosity
end module wall_oil
