!> Woschni's coefficient for the closed cylinder of an engine.
module woschni
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use wall_law, only: wall_law_t, chamber_t, hot_gas_t
  implicit none
  private
  public :: woschni_t

  !> h = 3.26 b^-0.2 (p/kPa)^0.8 T^-0.53 u^0.8, u = 2.28 S_p + 3.24e-3 V_d T_r/(p_r V_r) (p - p_m), where the motored pressure
  !> p_m = p_r (V_r/V)^g is that of the gas without combustion, and p - p_m never negative. The constants are those of public codes;
  !> other prints have T^-0.55, which is 13 % less at 1000 K.
  type, extends(wall_law_t) :: woschni_t
  contains
    procedure :: parameters
    procedure :: needs_engine
    procedure :: heat_transfer
  end type woschni_t

contains

  subroutine parameters(self, list)
    class(woschni_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_walls(list)
  end subroutine parameters

  pure logical function needs_engine(self)
    class(woschni_t), intent(in) :: self
    needs_engine = .true.
  end function needs_engine

  pure real(dp) function heat_transfer(self, chamber, gas) result(h)
    class(woschni_t), intent(in) :: self
    type(chamber_t), intent(in) :: chamber
    type(hot_gas_t), intent(in) :: gas
    real(dp) :: motored, speed
    associate (c => chamber)
      motored = c%closing_pressure*(c%closing_volume/gas%volume)**c%heat_capacity_ratio
      speed = 2.28_dp*gas%piston_speed + 3.24e-3_dp*c%displacement*c%closing_temperature/(c%closing_pressure*c%closing_volume)* &
        max(0.0_dp, gas%pressure - motored)
      h = 3.26_dp*c%bore**(-0.2_dp)*(1e-3_dp*gas%pressure*speed)**0.8_dp*gas%temperature**(-0.53_dp)
    end associate
  end function heat_transfer
end module woschni
