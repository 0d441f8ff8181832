!> Heat of the gas in a cylinder to its walls, h A (T - T_wall): the coefficient h is a law's, times a factor that is fitted.
!> A = pi b^2/2 + 4 V/b are the head, the crown of the piston and the liner down to it.
module wall_law
  use kinds, only: dp
  use constants, only: pi
  use model_parameters, only: law_t, parameter_list_t
  implicit none
  private
  public :: wall_law_t, chamber_t, hot_gas_t

  !> The cylinder, and the gas when it was closed in.
  type :: chamber_t
    real(dp) :: bore = 0                    !! b [m]
    real(dp) :: stroke = 0                  !! [m]
    real(dp) :: displacement = 0            !! [m^3]
    real(dp) :: gas_constant = 0            !! R_g [J/(kg K)]
    real(dp) :: heat_capacity_ratio = 0     !! [-]
    real(dp) :: closing_pressure = 0, closing_volume = 0, closing_temperature = 0   !! p_r [Pa], V_r [m^3], T_r [K]
  end type chamber_t

  !> The gas at an instant.
  type :: hot_gas_t
    real(dp) :: pressure = 0, temperature = 0, volume = 0   !! p [Pa], T [K], V [m^3]
    real(dp) :: piston_speed = 0                            !! mean speed S_p of the piston at the present crank speed [m/s]
  end type hot_gas_t

  type, abstract, extends(law_t) :: wall_law_t
    real(dp) :: wall_temperature = 0   !! T_wall [K]
    real(dp) :: factor = 1             !! on the coefficient [-]
  contains
    procedure :: add_walls
    procedure :: needs_engine => any_machine
    procedure, non_overridable :: heat_flow
    procedure(heat_transfer), deferred :: heat_transfer
  end type wall_law_t

  abstract interface
    !> The coefficient h [W/(m^2 K)].
    pure real(dp) function heat_transfer(self, chamber, gas)
      import :: wall_law_t, chamber_t, hot_gas_t, dp
      class(wall_law_t), intent(in) :: self
      type(chamber_t), intent(in) :: chamber
      type(hot_gas_t), intent(in) :: gas
    end function heat_transfer
  end interface

contains

  !> Declare what all laws have.
  subroutine add_walls(self, list)
    class(wall_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('wall_temperature', self%wall_temperature, 'mean temperature of head, piston crown and liner', 'K', '> 0', &
      example='450.0', usual='250 to 700')
    call list%add('factor', self%factor, 'factor on the coefficient, fitted to a measured heat; the laws differ by a factor of 2', &
      range='>= 0 and <= 100', default='1.0', usual='0.3 to 3')
  end subroutine add_walls

  !> Whether the law is of engines alone.
  pure logical function any_machine(self)
    class(wall_law_t), intent(in) :: self
    any_machine = .false.
  end function any_machine

  !> Heat to the walls [W].
  pure real(dp) function heat_flow(self, chamber, gas)
    class(wall_law_t), intent(in) :: self
    type(chamber_t), intent(in) :: chamber
    type(hot_gas_t), intent(in) :: gas
    heat_flow = self%factor*self%heat_transfer(chamber, gas)*(pi*chamber%bore**2/2 + 4*gas%volume/chamber%bore)* &
      (gas%temperature - self%wall_temperature)
  end function heat_flow
end module wall_law
