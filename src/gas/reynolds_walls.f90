!> A coefficient as a power of the Reynolds number of the piston's mean speed, as Annand's without radiation.
module reynolds_walls
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use wall_law, only: wall_law_t, chamber_t, hot_gas_t
  implicit none
  private
  public :: reynolds_walls_t

  !> h = c k/b (rho S_p b/mu)^n, rho = p/(R_g T), with viscosity mu and conductivity k at the mean temperature of the gas.
  type, extends(wall_law_t) :: reynolds_walls_t
    real(dp) :: coefficient = 0    !! c [-]
    real(dp) :: exponent = 0       !! n [-]
    real(dp) :: viscosity = 0      !! mu [Pa s]
    real(dp) :: conductivity = 0   !! k [W/(m K)]
  contains
    procedure :: parameters
    procedure :: heat_transfer
  end type reynolds_walls_t

contains

  subroutine parameters(self, list)
    class(reynolds_walls_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_walls(list)
    call list%add('coefficient', self%coefficient, 'Nusselt number over the power of the Reynolds number: 0.35 to 0.8 of '// &
      'engines (Annand), some 0.045 of compressors, with 0.8', range='> 0 and <= 1000', example='0.49', usual='0.02 to 1')
    call list%add('exponent', self%exponent, 'exponent of the Reynolds number: 0.7 of engines, 0.8 of compressors', &
      range='> 0 and <= 2', default='0.7', usual='0.5 to 0.9')
    call list%add('viscosity', self%viscosity, 'dynamic viscosity of the gas at its mean temperature; air of 1000 K: 4.5e-5, '// &
      'R600a of 350 K: 9e-6', 'Pa s', '> 0', example='4.5e-5', usual='5e-6 to 1e-4')
    call list%add('conductivity', self%conductivity, 'thermal conductivity of the gas at its mean temperature; air of 1000 K: '// &
      '0.075, R600a of 350 K: 0.022', 'W/(m K)', '> 0', example='0.075', usual='5e-3 to 0.3')
  end subroutine parameters

  pure real(dp) function heat_transfer(self, chamber, gas) result(h)
    class(reynolds_walls_t), intent(in) :: self
    type(chamber_t), intent(in) :: chamber
    type(hot_gas_t), intent(in) :: gas
    real(dp) :: reynolds
    reynolds = gas%pressure*gas%piston_speed*chamber%bore/(chamber%gas_constant*gas%temperature*self%viscosity)
    h = self%coefficient*self%conductivity/chamber%bore*reynolds**self%exponent
  end function heat_transfer
end module reynolds_walls
