!> The temperature of a film, from the balance of what heats the oil and the metal that follows it, and what leaves them:
!>
!>     C T' = P + P_f - rho(T) c_p Q (T - T_in) - G (T - T_h)
!>
!> with the power P of the film, always with that of its shear, the power P_f of friction, and the side flow Q, which leaves at T
!> and is replaced at T_in. The viscosity is that of the oil at T. Heat capacity C and conductance G are those of the metal: the oil
!> in the clearance alone has some tenths of a joule per kelvin.
module film_heat
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use state_layout, only: layout_t, slice_t
  use run_state, only: run_state_t
  use oil_viscosity, only: oil_t, oil_curve_t
  implicit none
  private
  public :: heat_case_t, film_heat_t, heat_totals_t, coldest, hottest

  real(dp), parameter :: coldest = 200, hottest = 700   !! temperatures that a film may have [K]
  real(dp), parameter :: natural_size = 100             !! of a temperature [K]

  !> Indices of the integrals of a film's heat over time: heat that comes in, that leaves with the oil and to the housing [J],
  !> temperature [K s], and heat that leaves for each kelvin [J/K].
  integer, parameter, public :: heat_in = 1, heat_to_oil = 2, heat_to_housing = 3, temperature_sum = 4, uptake = 5, n_sums = 5

  !> The group &heat.
  type, extends(has_parameters_t) :: heat_case_t
    real(dp) :: heat_capacity = 0         !! C [J/K]
    real(dp) :: inlet_temperature = 0     !! T_in [K]
    real(dp) :: housing_temperature = 0   !! T_h; 0: that of the inlet [K]
    real(dp) :: conductance = 0           !! G [W/K]
    real(dp) :: specific_heat = 0         !! c_p [J/(kg K)]
    real(dp) :: side_flow = 0             !! Q; 0: that of the film [m^3/s]
  contains
    procedure :: parameters
    procedure :: around
  end type heat_case_t

  !> The heat of one film.
  type :: film_heat_t
    type(heat_case_t) :: given
    type(oil_curve_t) :: oil
    real(dp) :: start = 0           !! T at t = 0 [K]
    real(dp) :: viscosity = 0       !! then, for which the film law is prepared [Pa s]
    type(slice_t) :: at, sums       !! T and the integrals in the state vector
    integer :: jumps = 0            !! number of changes of T that stand for a time that was left out
    real(dp) :: jumped = 0          !! sum of these changes [K]
  contains
    procedure :: prepare
    procedure :: claim
    procedure :: declare
    procedure :: temperature
    procedure :: viscosity_ratio
    procedure :: set_rates
    procedure :: slopes
    procedure :: totals
  end type film_heat_t

  !> The heat of a film so far.
  type :: heat_totals_t
    logical :: is_known = .false.
    real(dp) :: temperature = 0         !! [K]
    real(dp) :: came_in = 0             !! [J]
    real(dp) :: to_oil = 0              !! [J]
    real(dp) :: to_housing = 0          !! [J]
    real(dp) :: stored = 0              !! C (T - T_0) [J]
    real(dp) :: extrapolated = 0        !! the part of it that stands for times that were left out [J]
    real(dp) :: residual = 0            !! heat that came in less what has left and is stored: the error of the integration [J]
    integer :: jumps = 0
    real(dp), private :: least = 0      !! heat of a hundredth of a kelvin [J]
  contains
    procedure :: relative_residual
  end type heat_totals_t

contains

  subroutine parameters(self, list)
    class(heat_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    character(len=*), parameter :: temperatures = '>= 200 and <= 700'
    call list%add('heat_capacity', self%heat_capacity, &
      'heat capacity of the film and of the metal that follows its temperature, which is that of the oil at the outlet', &
      'J/K', '> 0', example='60.0', usual='1 to 1e4')
    call list%add('inlet_temperature', self%inlet_temperature, 'temperature of the oil that replaces the side flow', 'K', &
      temperatures, example='363.15', usual='250 to 450')
    call list%add('housing_temperature', self%housing_temperature, 'temperature of the housing; 0: inlet_temperature', 'K', &
      temperatures, default='0.0', usual='250 to 450')
    call list%add('conductance', self%conductance, 'heat that flows to the housing in a second for each kelvin', 'W/K', '>= 0', &
      default='0.0', usual='1e-2 to 1e3')
    call list%add('specific_heat', self%specific_heat, 'specific heat of the oil', 'J/(kg K)', '> 0', default='2000.0', &
      usual='1000 to 5000')
    call list%add('side_flow', self%side_flow, &
      'oil flow that carries heat out of the bearing; 0: the side flow of the film', 'm^3/s', '>= 0', default='0.0', &
      usual='1e-9 to 1e-3')
  end subroutine parameters

  !> Temperature of the housing [K].
  pure real(dp) function around(self)
    class(heat_case_t), intent(in) :: self
    around = self%inlet_temperature
    if (self%housing_temperature > 0) around = self%housing_temperature
  end function around

  subroutine prepare(self, given, oil)
    class(film_heat_t), intent(inout) :: self
    type(heat_case_t), intent(in) :: given
    type(oil_t), intent(in) :: oil
    self%given = given
    self%oil = oil%curve()
    self%start = oil%temperature
    self%viscosity = oil%dynamic_viscosity()
  end subroutine prepare

  !> Claim the temperature and the integrals, which have no influence on the steps.
  subroutine claim(self, layout)
    class(film_heat_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    call layout%claim_states(1, natural_size, self%at)
    call layout%claim_quadratures(n_sums, 0.0_dp, self%sums)
  end subroutine claim

  !> Declare the state, with a prefix of its names.
  subroutine declare(self, pre, list, y)
    class(film_heat_t), intent(inout) :: self
    character(len=*), intent(in) :: pre
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    call list%add(pre//'film_temperature', y(self%at%first), 'K', 'temperature of the film')
    list%of_totals = .true.
    call list%add(pre//'heat', y(self%sums%first:self%sums%last), '', &
      'integrals over time: heat in, to the oil, to the housing [J], temperature [K s], heat for each kelvin [J/K]')
    call list%add(pre//'first_temperature', self%start, 'K', 'temperature of the film at the start of the run')
    call list%add(pre//'temperature_jumps', self%jumps, 'changes of the temperature that stand for a time that was left out')
    call list%add(pre//'temperature_jumped', self%jumped, 'K', 'sum of these changes')
    list%of_totals = .false.
  end subroutine declare

  !> T [K].
  pure real(dp) function temperature(self, y)
    class(film_heat_t), intent(in) :: self
    real(dp), intent(in) :: y(*)   !! the whole state vector
    temperature = y(self%at%first)
  end function temperature

  !> Viscosity at T over that for which the film law is prepared [-].
  pure real(dp) function viscosity_ratio(self, t) result(ratio)
    class(film_heat_t), intent(in) :: self
    real(dp), intent(in) :: t   !! T [K]
    ratio = self%oil%rho(t)*self%oil%kinematic(t)/self%viscosity
  end function viscosity_ratio

  !> Rates of the temperature and of the integrals.
  pure subroutine set_rates(self, power, film_flow, y, dydt)
    class(film_heat_t), intent(in) :: self
    real(dp), intent(in) :: power       !! P + P_f [W]
    real(dp), intent(in) :: film_flow   !! side flow of the film [m^3/s]
    real(dp), intent(in) :: y(*)
    real(dp), intent(inout) :: dydt(*)
    real(dp) :: by_oil, to_oil, to_housing
    associate (t => y(self%at%first), given => self%given)
      by_oil = self%oil%rho(t)*given%specific_heat*merge(given%side_flow, film_flow, given%side_flow > 0)
      to_oil = by_oil*(t - given%inlet_temperature)
      to_housing = given%conductance*(t - given%around())
      dydt(self%at%first) = (power - to_oil - to_housing)/given%heat_capacity
      associate (sums => dydt(self%sums%first:self%sums%last))
        sums(heat_in) = power
        sums(heat_to_oil) = to_oil
        sums(heat_to_housing) = to_housing
        sums(temperature_sum) = t
        sums(uptake) = by_oil + given%conductance
      end associate
    end associate
  end subroutine set_rates

  !> Derivative of the viscosity with respect to T over itself, and of T' where the power of the film is proportional to the
  !> viscosity and its flow does not depend on it [1/K], [1/s].
  pure subroutine slopes(self, t, film_power, film_flow, of_viscosity, of_rate)
    class(film_heat_t), intent(in) :: self
    real(dp), intent(in) :: t, film_power, film_flow   !! T [K], P [W], side flow of the film [m^3/s]
    real(dp), intent(out) :: of_viscosity, of_rate
    of_viscosity = self%oil%relative_slope(t)
    associate (given => self%given)
      of_rate = (film_power*of_viscosity - given%conductance - self%oil%rho(t)*given%specific_heat* &
        merge(given%side_flow, film_flow, given%side_flow > 0)*(1 + self%oil%expansion_at(t)*(t - given%inlet_temperature)))/ &
        given%heat_capacity
    end associate
  end subroutine slopes

  !> The heat so far.
  pure type(heat_totals_t) function totals(self, y)
    class(film_heat_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    totals%is_known = .true.
    totals%temperature = y(self%at%first)
    associate (sums => y(self%sums%first:self%sums%last))
      totals%came_in = sums(heat_in)
      totals%to_oil = sums(heat_to_oil)
      totals%to_housing = sums(heat_to_housing)
    end associate
    totals%stored = self%given%heat_capacity*(totals%temperature - self%start)
    totals%extrapolated = self%given%heat_capacity*self%jumped
    totals%residual = totals%came_in - totals%to_oil - totals%to_housing - (totals%stored - totals%extrapolated)
    totals%jumps = self%jumps
    totals%least = 1e-2_dp*self%given%heat_capacity
  end function totals

  !> Size of the residual over the heat that came in, left or was stored, whichever is largest [-]; at least over the heat of a
  !> hundredth of a kelvin, below which rounding would be judged.
  elemental real(dp) function relative_residual(self)
    class(heat_totals_t), intent(in) :: self
    relative_residual = 0
    if (self%is_known) relative_residual = abs(self%residual)/ &
      max(abs(self%came_in), abs(self%to_oil) + abs(self%to_housing), abs(self%stored), self%least)
  end function relative_residual
end module film_heat
