!> Parameters of the gas in the cylinder: one of the cycles that a case can name, or a measured pressure.
module gas_law
  use kinds, only: dp
  use error_handling, only: error_t
  use model_parameters, only: law_t, parameter_list_t
  use ideal_linkage, only: linkage_t
  use cylinder_charge, only: charge_t
  use working_gas, only: working_gas_t
  implicit none
  private
  public :: gas_law_t, turning_forwards

  type, abstract, extends(law_t) :: gas_law_t
    real(dp) :: bore = 0                        !! cylinder diameter [m]
    real(dp) :: crankcase_pressure = 101325     !! below the piston [Pa]
  contains
    procedure :: revolutions => one_revolution
    procedure :: fastest_piston
    procedure :: heat_of_cycle
    procedure :: filling_pressure
    procedure :: burns_abruptly => burns_smoothly
    procedure :: description
    procedure :: misfit => no_misfit
    procedure :: add_bore
    procedure :: add_crankcase_pressure
    procedure :: fill => cannot_fill
    procedure(prepare), deferred :: prepare
  end type gas_law_t

  abstract interface
    !> Prepare the gas of a running machine. Error: the cycle cannot be integrated.
    subroutine prepare(self, linkage, sense, tolerance, gas, error)
      import :: gas_law_t, linkage_t, working_gas_t, error_t, dp
      class(gas_law_t), intent(in) :: self
      type(linkage_t), intent(in) :: linkage
      real(dp), intent(in) :: sense       !! 1 or -1: that of the crank; an engine that turns backwards is a mirror image
      real(dp), intent(in) :: tolerance   !! allowed relative error of the pressure
      type(working_gas_t), intent(out) :: gas
      type(error_t), allocatable, intent(out) :: error
    end subroutine prepare
  end interface

contains

  !> Period of the pressure [revolutions].
  pure integer function one_revolution(self) result(revolutions)
    class(gas_law_t), intent(in) :: self
    revolutions = 1
  end function one_revolution

  !> Mean piston speed above which no such machine is built [m/s].
  pure real(dp) function fastest_piston(self)
    class(gas_law_t), intent(in) :: self
    fastest_piston = 40
  end function fastest_piston

  !> Heat released in a cycle [J]; 0: none is known.
  pure real(dp) function heat_of_cycle(self)
    class(gas_law_t), intent(in) :: self
    heat_of_cycle = 0
  end function heat_of_cycle

  !> Pressure at which a machine fills that takes gas in from a pipe [Pa]; 0: that is not known.
  pure real(dp) function filling_pressure(self)
    class(gas_law_t), intent(in) :: self
    filling_pressure = 0
  end function filling_pressure

  !> Whether heat begins to be released at an infinite rate.
  pure logical function burns_smoothly(self) result(burns_abruptly)
    class(gas_law_t), intent(in) :: self
    burns_abruptly = .false.
  end function burns_smoothly

  !> The gas in a few words, for the user.
  function description(self) result(text)
    class(gas_law_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = trim(self%name)
  end function description

  !> Prepare the gas that has a mass, for a gas that `prepare` has made. A measured pressure has none.
  subroutine cannot_fill(self, linkage, sense, gas, charge)
    class(gas_law_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense   !! see `prepare`
    type(working_gas_t), intent(inout) :: gas
    type(charge_t), intent(inout) :: charge
  end subroutine cannot_fill

  !> The mechanism, or its mirror image if the crank turns backwards.
  pure type(linkage_t) function turning_forwards(linkage, sense) result(forwards)
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense
    forwards = linkage
    forwards%axis_offset = sense*linkage%axis_offset
  end function turning_forwards

  !> A key whose angle does not suit the dead centres of the mechanism, and what it must be; empty if all do.
  subroutine no_misfit(self, linkage, sense, key, wanted)
    class(gas_law_t), intent(in) :: self
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: sense   !! see `prepare`
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = ''
  end subroutine no_misfit

  subroutine add_bore(self, list)
    class(gas_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('bore', self%bore, 'cylinder diameter', 'm', '>= 1e-6 and <= 1e3', example='0.070', usual='5e-3 to 1.5')
  end subroutine add_bore

  subroutine add_crankcase_pressure(self, list)
    class(gas_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('crankcase_pressure', self%crankcase_pressure, &
      'pressure on the crank side of the piston', 'Pa', '> 0', default='101325.0', usual='2e4 to 3e6')
  end subroutine add_crankcase_pressure
end module gas_law
