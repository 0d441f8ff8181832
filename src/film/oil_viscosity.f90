!> The viscosity of an oil at the temperature of the film, from the viscosities at two temperatures in its data sheet.
!>
!> walther (ASTM D341): lg lg Z = A - B lg T, Z = nu + 0.7 + exp(-1.47 - 1.84 nu - 0.51 nu^2), with nu in mm^2/s and T in K, for nu
!> >= 0.21 mm^2/s. vogel: nu = a exp(b/(T - T0)), T0 = 178.15 K (-95 degrees C) by default (Cameron 1966). The density varies with
!> the temperature as for lubricating oils (ASTM D1250, table 54D): rho = rho_15 exp(-k (1 + 0.8 k)), k = 0.6278 (T - 288.15)/rho_15
!> in kg/m^3.
module oil_viscosity
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use named_oils, only: named_oil_t, oil_temperatures => known_temperatures, find_oil, unknown_oil
  implicit none
  private
  public :: oil_t, oil_curve_t

  type, extends(has_parameters_t) :: oil_t
    character(len=:), allocatable :: name     !! of a named oil, which sets the law, the known values and the density; else empty
    character(len=:), allocatable :: law      !! given, walther or vogel
    real(dp) :: temperature = 0               !! T, of the film [K]
    real(dp) :: known_temperatures(2) = 0     !! [K]
    real(dp) :: known_viscosities(2) = 0      !! kinematic, at these temperatures [m^2/s]
    real(dp) :: density = 0                   !! rho_15, at 288.15 K [kg/m^3]
    real(dp) :: vogel_temperature = 0         !! T0 [K]
    real(dp) :: thinning_ratio = 1            !! viscosity at a large shear rate over that at rest; 1: no shear thinning [-]
    real(dp) :: thinning_rate = 0             !! shear rate that takes half of the difference [1/s]
  contains
    procedure :: parameters
    procedure :: read_name
    procedure :: has_name
    procedure :: is_known
    procedure :: conflict
    procedure :: kinematic_viscosity
    procedure :: density_at
    procedure :: dynamic_viscosity
    procedure :: curve
  end type oil_t

  !> Viscosity and density of an oil over its temperature.
  type :: oil_curve_t
    private
    logical :: is_walther = .true.
    real(dp) :: vogel_temperature = 0     !! T0 [K]
    real(dp) :: density = 0               !! rho_15 [kg/m^3]
    real(dp) :: x = 0, y = 0, slope = 0   !! of the straight line of the law, through its first known viscosity
  contains
    procedure :: kinematic
    procedure :: rho
    procedure :: relative_slope
    procedure :: expansion_at
  end type oil_curve_t

  real(dp), parameter :: mm2 = 1e-6_dp   !! [m^2]
  real(dp), parameter :: density_temperature = 288.15_dp   !! 15 degrees C [K]
  real(dp), parameter :: expansion = 0.6278_dp   !! coefficient of the density times the density [kg/(m^3 K)]

contains

  subroutine parameters(self, list)
    class(oil_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    character(len=*), parameter :: temperatures = '>= 200 and <= 700'
    call list%text('oil', self%name, 'named oil, such as SAE 30 or ISO VG 46 (gudgeon --reference oils), for viscosity_law '// &
      'walther, known viscosities and density', '')
    call list%word('viscosity_law', self%law, 'given, walther, vogel', 'given', &
      'given: by the key viscosity; walther (ASTM D341), vogel: at the temperature of the film')
    call list%add('temperature', self%temperature, 'temperature of the film', 'K', temperatures, default='0.0', usual='250 to 450')
    call list%add('known_temperatures', self%known_temperatures, &
      'two temperatures at which the viscosity of the oil is known, such as 313.15, 373.15', 'K', &
      temperatures, default='0.0', usual='250 to 450')
    call list%add('known_viscosities', self%known_viscosities, 'kinematic viscosities at these two temperatures', 'm^2/s', '> 0', &
      default='0.0', usual='1e-7 to 1e-2')
    call list%add('density', self%density, &
      'density of the oil at 288.15 K (15 degrees C)', 'kg/m^3', '>= 500 and <= 2000', default='0.0', usual='600 to 1500')
    call list%add('vogel_temperature', self%vogel_temperature, &
      'vogel: temperature at which the law has infinite viscosity', 'K', '>= 0', &
      default='178.15', usual='100 to 250')
    call list%add('thinning_ratio', self%thinning_ratio, &
      'shear thinning: viscosity at a large shear rate over that at rest; 1: none', range='> 0 and <= 1', default='1.0', &
      usual='0.2 to 1')
    call list%add('thinning_rate', self%thinning_rate, 'shear rate at which half of this reduction is reached', '1/s', '> 0', &
      default='0.0', usual='1e4 to 1e8')
  end subroutine parameters

  !> Set the parameters that a named oil gives. A name that no oil has is found by `conflict`.
  subroutine read_name(self)
    class(oil_t), intent(inout) :: self
    type(named_oil_t) :: oil
    if (.not. self%has_name()) return
    self%law = 'walther'
    oil = find_oil(self%name)
    self%known_temperatures = oil_temperatures
    self%known_viscosities = oil%viscosities
    self%density = oil%density
    if (oil%name /= '') self%name = trim(oil%name)
  end subroutine read_name

  pure logical function has_name(self)
    class(oil_t), intent(in) :: self
    has_name = .false.
    if (allocated(self%name)) has_name = self%name /= ''
  end function has_name

  !> Whether the viscosity is computed from an oil and a temperature.
  pure logical function is_known(self)
    class(oil_t), intent(in) :: self
    is_known = .false.
    if (allocated(self%law)) is_known = self%law /= 'given'
  end function is_known

  !> Find a contradiction between the parameters of an oil: the key of the wrong parameter, and what is required of it. An empty key
  !> means that there is none.
  pure subroutine conflict(self, key, wanted)
    class(oil_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    real(dp), parameter :: thinnest = 0.21_dp*mm2
    key = ''
    wanted = 'required with viscosity_law = '''//self%law//''''
    if (self%has_name()) wanted = 'required with oil = '''//self%name//''''
    if (self%has_name() .and. .not. self%density > 0) then
      key = 'oil'
      wanted = unknown_oil(self%name)
    else if (.not. self%temperature > 0) then
      key = 'temperature'
    else if (.not. minval(self%known_temperatures) > 0) then
      key = 'known_temperatures'
    else if (.not. minval(self%known_viscosities) > 0) then
      key = 'known_viscosities'
    else if (.not. self%density > 0) then
      key = 'density'
    else if (.not. abs(self%known_temperatures(2) - self%known_temperatures(1)) >= 1) then
      key = 'known_temperatures'
      wanted = 'must be 1 K apart or more'
    else if (.not. (self%known_viscosities(2) - self%known_viscosities(1)) &
             *(self%known_temperatures(2) - self%known_temperatures(1)) < 0) then
      key = 'known_viscosities'
      wanted = 'must be smaller at the higher temperature'
    else if (self%law == 'walther' .and. minval(self%known_viscosities) < thinnest) then
      key = 'known_viscosities'
      wanted = 'must be >= 2.1e-7 with viscosity_law = ''walther'''
    else if (self%law == 'vogel' .and. &
             self%vogel_temperature > min(minval(self%known_temperatures), self%temperature) - 10) then
      key = 'vogel_temperature'
      wanted = 'must be 10 K or more below temperature and known_temperatures'
    end if
  end subroutine conflict

  !> nu at the temperature of the film [m^2/s].
  pure real(dp) function kinematic_viscosity(self) result(nu)
    class(oil_t), intent(in) :: self
    type(oil_curve_t) :: curve
    curve = self%curve()
    nu = curve%kinematic(self%temperature)
  end function kinematic_viscosity

  !> The viscosity of the oil over its temperature, whatever that of the film is.
  pure type(oil_curve_t) function curve(self)
    class(oil_t), intent(in) :: self
    real(dp) :: x(2), y(2)
    curve%is_walther = self%law == 'walther'
    curve%vogel_temperature = self%vogel_temperature
    curve%density = self%density
    if (curve%is_walther) then
      x = log(self%known_temperatures)
      y = [log(log(z_of(self%known_viscosities(1)/mm2))), log(log(z_of(self%known_viscosities(2)/mm2)))]
      curve%slope = (y(2) - y(1))/(x(2) - x(1))
      curve%y = y(1)
    else
      x = 1/(self%known_temperatures - self%vogel_temperature)
      curve%slope = log(self%known_viscosities(2)/self%known_viscosities(1))/(x(2) - x(1))
      curve%y = self%known_viscosities(1)
    end if
    curve%x = x(1)
  end function curve

  !> nu at a temperature [m^2/s].
  pure real(dp) function kinematic(self, temperature) result(nu)
    class(oil_curve_t), intent(in) :: self
    real(dp), intent(in) :: temperature   !! [K]
    if (self%is_walther) then
      nu = mm2*viscosity_of(exp(exp(self%y + self%slope*(log(temperature) - self%x))))
    else
      nu = self%y*exp(self%slope*(1/(temperature - self%vogel_temperature) - self%x))
    end if
  end function kinematic

  !> Density at a temperature [kg/m^3].
  pure real(dp) function rho(self, temperature)
    class(oil_curve_t), intent(in) :: self
    real(dp), intent(in) :: temperature   !! [K]
    real(dp) :: k
    k = expansion/self%density*(temperature - density_temperature)
    rho = self%density*exp(-k*(1 + 0.8_dp*k))
  end function rho

  !> Derivative of the dynamic viscosity with respect to the temperature, over this viscosity [1/K].
  pure real(dp) function relative_slope(self, temperature) result(slope)
    class(oil_curve_t), intent(in) :: self
    real(dp), intent(in) :: temperature   !! [K]
    real(dp) :: nu, rest, z
    if (self%is_walther) then
      nu = self%kinematic(temperature)/mm2
      rest = exp(-1.47_dp - 1.84_dp*nu - 0.51_dp*nu**2)
      z = nu + 0.7_dp + rest
      slope = z*log(z)*self%slope/(temperature*nu*(1 - (1.84_dp + 1.02_dp*nu)*rest))
    else
      slope = -self%slope/(temperature - self%vogel_temperature)**2
    end if
    slope = slope + self%expansion_at(temperature)
  end function relative_slope

  !> Derivative of the density with respect to the temperature, over the density [1/K].
  pure real(dp) function expansion_at(self, temperature) result(slope)
    class(oil_curve_t), intent(in) :: self
    real(dp), intent(in) :: temperature   !! [K]
    slope = -expansion/self%density*(1 + 1.6_dp*expansion/self%density*(temperature - density_temperature))
  end function expansion_at

  !> Z for a viscosity in mm^2/s.
  pure real(dp) function z_of(nu)
    real(dp), intent(in) :: nu
    z_of = nu + 0.7_dp + exp(-1.47_dp - 1.84_dp*nu - 0.51_dp*nu**2)
  end function z_of

  !> The viscosity in mm^2/s for a value of Z > 1, by Newton's method; Z is a monotonic function of it.
  pure real(dp) function viscosity_of(z) result(nu)
    real(dp), intent(in) :: z
    real(dp) :: rest, step
    integer :: i
    nu = max(z - 0.7_dp, 0.1_dp)
    do i = 1, 30
      rest = exp(-1.47_dp - 1.84_dp*nu - 0.51_dp*nu**2)
      step = (nu + 0.7_dp + rest - z)/(1 - (1.84_dp + 1.02_dp*nu)*rest)
      nu = nu - step
      if (.not. abs(step) > 0) exit
    end do
  end function viscosity_of

  !> Density at the temperature of the film [kg/m^3].
  pure real(dp) function density_at(self)
    class(oil_t), intent(in) :: self
    type(oil_curve_t) :: curve
    curve = self%curve()
    density_at = curve%rho(self%temperature)
  end function density_at

  !> mu = rho nu at the temperature of the film [Pa s].
  pure real(dp) function dynamic_viscosity(self)
    class(oil_t), intent(in) :: self
    dynamic_viscosity = self%density_at()*self%kinematic_viscosity()
  end function dynamic_viscosity
end module oil_viscosity
