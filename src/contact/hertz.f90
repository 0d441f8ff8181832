!> Hertz contact (4.1): an elastic force, without loss.
module hertz
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: parameter_list_t
  use gudgeon_bearing, only: bearing_t
  use contact_law, only: contact_law_t
  use contact_stiffness, only: hertz_stiffness, valid_impact_speed
  implicit none
  private
  public :: hertz_t

  !> F = K delta^n, a pure function of the penetration.
  type, extends(contact_law_t) :: hertz_t
    real(dp) :: stiffness = 0          !! K [N/m^n], > 0
    real(dp) :: exponent = 1.5_dp      !! n [-], >= 1
    logical :: is_three_halves = .true. !! n is 3/2, which a square root answers; set by `set_elastic_part`
    real(dp) :: given_stiffness = 0     !! of the case [N/m^n]; 0: Hertz's, from the materials and the bearing
    real(dp) :: youngs_modulus(2) = 0   !! of pin and bearing [Pa]
    real(dp) :: poissons_ratio(2) = 0   !! of pin and bearing [-]
    real(dp) :: density(2) = 0          !! of pin and bearing [kg/m^3]
  contains
    procedure, nopass :: name
    procedure :: parameters
    procedure :: prepare
    procedure :: fastest_impact
    procedure :: normal_force
    procedure :: normal_force_slopes
    procedure, non_overridable :: elastic_force
    procedure, non_overridable :: set_elastic_part
  end type hertz_t

contains

  pure function name()
    character(len=:), allocatable :: name
    name = 'hertz'
  end function name

  subroutine parameters(self, list)
    class(hertz_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('exponent', self%exponent, 'of the penetration', range='>= 1', default='1.5')
    call list%add('youngs_modulus', self%youngs_modulus, 'of pin and bearing', 'Pa', '> 0', default='207.0e9')
    call list%add('poissons_ratio', self%poissons_ratio, 'of pin and bearing', range='>= 0 and <= 0.5', default='0.3')
    call list%add('density', self%density, 'of pin and bearing, for the limit of validity', 'kg/m^3', '> 0', default='7850.0')
    call list%add('stiffness', self%given_stiffness, '0: from the materials', 'N/m^exponent', '> 0', default='0.0')
  end subroutine parameters

  !> The stiffness that the case gives, or else Hertz's (4.2).
  subroutine prepare(self, bearing)
    class(hertz_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp) :: stiffness
    stiffness = self%given_stiffness
    if (.not. stiffness > 0) &
      stiffness = hertz_stiffness(bearing%radius, bearing%clearance, self%youngs_modulus, self%poissons_ratio)
    call self%set_elastic_part(stiffness, self%exponent)
  end subroutine prepare

  !> The limit of the materials (remark after 4.7) [m/s].
  pure real(dp) function fastest_impact(self)
    class(hertz_t), intent(in) :: self
    fastest_impact = valid_impact_speed(self%youngs_modulus, self%density)
  end function fastest_impact

  pure subroutine set_elastic_part(self, stiffness, exponent)
    class(hertz_t), intent(inout) :: self
    real(dp), intent(in) :: stiffness   !! K [N/m^n]
    real(dp), intent(in) :: exponent    !! n [-]
    self%stiffness = stiffness
    self%exponent = exponent
    self%is_three_halves = abs(exponent - 1.5_dp) <= 0
  end subroutine set_elastic_part

  !> K delta^n [N], 0 where the pin does not penetrate.
  pure function elastic_force(self, penetration) result(force)
    class(hertz_t), intent(in) :: self
    real(dp), intent(in) :: penetration   !! delta [m]
    real(dp) :: force
    if (penetration <= 0) then
      force = 0
    else if (self%is_three_halves) then
      force = self%stiffness*penetration*sqrt(penetration)
    else
      force = self%stiffness*penetration**self%exponent
    end if
  end function elastic_force

  !> (4.1). Neither speed matters.
  pure function normal_force(self, penetration, penetration_rate, impact_speed) result(force)
    class(hertz_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration, penetration_rate, impact_speed
    real(dp) :: force
    associate (unused_rate => penetration_rate, unused_speed => impact_speed)
    end associate
    force = self%elastic_force(penetration)
  end function normal_force

  pure subroutine normal_force_slopes(self, penetration, penetration_rate, impact_speed, stiffness, damping)
    class(hertz_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate, impact_speed
    real(dp), intent(out) :: stiffness, damping
    associate (unused_rate => penetration_rate, unused_speed => impact_speed)
    end associate
    stiffness = 0
    if (penetration > 0) stiffness = self%exponent*self%elastic_force(penetration)/penetration
    damping = 0
  end subroutine normal_force_slopes
end module hertz
