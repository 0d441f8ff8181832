!> Hohenberg's coefficient.
module hohenberg
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use wall_law, only: wall_law_t, chamber_t, hot_gas_t
  implicit none
  private
  public :: hohenberg_t

  !> h = 130 V^-0.06 (p/bar)^0.8 T^-0.4 (S_p + 1.4)^0.8, V in m^3. The constants are those of public codes.
  type, extends(wall_law_t) :: hohenberg_t
  contains
    procedure :: parameters
    procedure :: heat_transfer
  end type hohenberg_t

contains

  subroutine parameters(self, list)
    class(hohenberg_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_walls(list)
  end subroutine parameters

  pure real(dp) function heat_transfer(self, chamber, gas) result(h)
    class(hohenberg_t), intent(in) :: self
    type(chamber_t), intent(in) :: chamber
    type(hot_gas_t), intent(in) :: gas
    h = 130*gas%volume**(-0.06_dp)*(1e-5_dp*gas%pressure*(gas%piston_speed + 1.4_dp))**0.8_dp*gas%temperature**(-0.4_dp)
  end function heat_transfer
end module hohenberg
