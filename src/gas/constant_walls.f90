!> A constant coefficient.
module constant_walls
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use wall_law, only: wall_law_t, chamber_t, hot_gas_t
  implicit none
  private
  public :: constant_walls_t

  type, extends(wall_law_t) :: constant_walls_t
    real(dp) :: coefficient = 0   !! h [W/(m^2 K)]
  contains
    procedure :: parameters
    procedure :: heat_transfer
  end type constant_walls_t

contains

  subroutine parameters(self, list)
    class(constant_walls_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_walls(list)
    call list%add('heat_transfer_coefficient', self%coefficient, 'heat to the walls for each area and kelvin', 'W/(m^2 K)', &
      '>= 0', example='300.0', usual='10 to 1e4')
  end subroutine parameters

  pure real(dp) function heat_transfer(self, chamber, gas) result(h)
    class(constant_walls_t), intent(in) :: self
    type(chamber_t), intent(in) :: chamber
    type(hot_gas_t), intent(in) :: gas
    h = self%coefficient
  end function heat_transfer
end module constant_walls
