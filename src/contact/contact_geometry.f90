!> Interface of all contact geometries: the elastic force between pin and bearing as a function of the penetration.
module contact_geometry
  use kinds, only: dp
  use model_parameters, only: law_t, parameter_list_t
  use bearing_size, only: bearing_t
  use trace_row, only: trace_row_t
  implicit none
  private
  public :: contact_geometry_t

  !> The elastic part of a contact, with the materials, which all geometries have.
  type, abstract, extends(law_t) :: contact_geometry_t
    real(dp) :: youngs_modulus(2) = 0   !! of pin and bearing [Pa]
    real(dp) :: poissons_ratio(2) = 0   !! of pin and bearing [-]
    real(dp) :: density(2) = 0          !! of pin and bearing [kg/m^3]
    real(dp) :: three_halves = 0        !! K [N/m^1.5] if the force is K delta^1.5, set by `prepare`; otherwise 0
    real(dp) :: deepest = huge(1.0_dp)  !! largest penetration for which the geometry is valid [m]; `prepare` may set a limit
  contains
    procedure :: parameters => material_parameters
    procedure(prepare), deferred :: prepare
    procedure(elastic_force), deferred :: elastic_force
    procedure(slope), deferred :: slope
    procedure :: elastic_energy => integral_of_force
    procedure, nopass :: needs_length => needs_it
    procedure :: is_of_spheres => of_cylinders
    procedure :: bearing_conflict => fits_every_bearing
    procedure :: foundation => no_foundation
    procedure, nopass :: has_foundation => has_none
    procedure :: half_angle => line_contact
    procedure :: pressure => no_pressure
    procedure :: total_pressure => only_the_force
    procedure :: add_columns => no_columns
    procedure, non_overridable :: material_parameters
    procedure, non_overridable :: contact_modulus
    procedure, non_overridable :: fastest_impact
  end type contact_geometry_t

  abstract interface
    !> Prepare the geometry for a bearing, before the first evaluation of the force.
    subroutine prepare(self, bearing)
      import :: contact_geometry_t, bearing_t
      class(contact_geometry_t), intent(inout) :: self
      type(bearing_t), intent(in) :: bearing
    end subroutine prepare

    !> Elastic force [N], > 0.
    pure function elastic_force(self, penetration) result(force)
      import :: contact_geometry_t, dp
      class(contact_geometry_t), intent(in) :: self
      real(dp), value, intent(in) :: penetration   !! |e| - c [m], > 0
      real(dp) :: force
    end function elastic_force

    !> Derivative with respect to the penetration [N/m] of a force that is proportional to the elastic force and has the given
    !> value. For the elastic force itself this is the stiffness of the contact.
    pure function slope(self, penetration, force)
      import :: contact_geometry_t, dp
      class(contact_geometry_t), intent(in) :: self
      real(dp), intent(in) :: penetration   !! [m], > 0
      real(dp), intent(in) :: force         !! [N]
      real(dp) :: slope
    end function slope
  end interface

contains

  !> Declare the material parameters. A geometry with others declares both.
  subroutine material_parameters(self, list)
    class(contact_geometry_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('youngs_modulus', self%youngs_modulus, 'Young''s moduli of pin and bearing', 'Pa', '> 0', default='207.0e9', &
      usual='1e8 to 1e12')
    call list%add('poissons_ratio', self%poissons_ratio, &
      'Poisson''s ratios of pin and bearing', range='>= 0 and <= 0.5', default='0.3', usual='0.1 to 0.5')
    call list%add('density', self%density, &
      'densities of pin and bearing; only for the limit of validity of the contact law', 'kg/m^3', '> 0', default='7850.0', &
      usual='500 to 2.5e4')
  end subroutine material_parameters

  !> Elastic energy of the contact at a penetration [J]: the integral of the elastic force by Gauss's formula with 16 points over
  !> the square root of the penetration, in which the force is smooth. Geometries with a closed form override this.
  pure real(dp) function integral_of_force(self, penetration) result(energy)
    class(contact_geometry_t), intent(in) :: self
    real(dp), intent(in) :: penetration   !! [m], > 0
    real(dp), parameter :: points(8) = [0.0950125098376374402_dp, 0.2816035507792589133_dp, 0.4580167776572273863_dp, &
      0.6178762444026437484_dp, 0.7554044083550030339_dp, 0.8656312023878317439_dp, 0.9445750230732325761_dp, &
      0.9894009349916499326_dp]
    real(dp), parameter :: weights(8) = [0.1894506104550684963_dp, 0.1826034150449235889_dp, 0.1691565193950025382_dp, &
      0.1495959888165767321_dp, 0.1246289712555338720_dp, 0.0951585116824927848_dp, 0.0622535239386478929_dp, &
      0.0271524594117540949_dp]
    integer :: i
    energy = 0
    do i = 1, size(points)
      energy = energy + weights(i)*(share((1 + points(i))/2) + share((1 - points(i))/2))
    end do

  contains

    pure real(dp) function share(root)
      real(dp), intent(in) :: root
      share = penetration*root*self%elastic_force(penetration*root**2)
    end function share
  end function integral_of_force

  !> Whether the elastic force is that of two spheres, which are softer than a pin in its bearing. The default is no.
  pure logical function of_cylinders(self)
    class(contact_geometry_t), intent(in) :: self
    of_cylinders = .false.
  end function of_cylinders

  !> Whether the force is proportional to the length of the bearing. The default is yes.
  pure logical function needs_it()
    needs_it = .true.
  end function needs_it

  !> Find a property of the bearing for which the geometry is not valid: the key of the wrong value, and what is required of it. An
  !> empty key means that there is none.
  pure subroutine fits_every_bearing(self, bearing, key, wanted)
    class(contact_geometry_t), intent(in) :: self
    type(bearing_t), intent(in) :: bearing
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = ''
  end subroutine fits_every_bearing

  !> Stiffness k Rb L of a foundation of springs [N/m^2]; 0, the default, if the geometry is another one.
  pure real(dp) function no_foundation(self) result(stiffness)
    class(contact_geometry_t), intent(in) :: self
    stiffness = 0
  end function no_foundation

  !> Whether the geometry is a foundation of springs. The default is no.
  pure logical function has_none()
    has_none = .false.
  end function has_none

  !> Half-angle of the arc on which pin and bore touch [rad]; 0, the default, if the geometry does not say it: the surfaces touch
  !> along a line.
  pure real(dp) function line_contact(self, penetration) result(half_angle)
    class(contact_geometry_t), intent(in) :: self
    real(dp), intent(in) :: penetration   !! [m], > 0
    half_angle = 0
  end function line_contact

  !> Pressure times radius and length of the bore over the normal force [1/rad], at an angle from the line of centres that is
  !> smaller than the half-angle of the arc. A geometry with an arc must override this.
  pure real(dp) function no_pressure(self, half_angle, angle) result(pressure)
    class(contact_geometry_t), intent(in) :: self
    real(dp), intent(in) :: half_angle, angle   !! [rad]
    pressure = 0
  end function no_pressure

  !> Integral of the pressure along an arc, times radius and length of the bore, over the normal force [-]. It exceeds 1, since only
  !> the component in the direction of the line of centres makes up the force. A geometry with an arc must override this.
  pure real(dp) function only_the_force(self, half_angle) result(total)
    class(contact_geometry_t), intent(in) :: self
    real(dp), intent(in) :: half_angle   !! a [rad]
    total = 1
  end function only_the_force

  !> Add columns that only this geometry has to a row. The default is none.
  pure subroutine no_columns(self, penetration, normal_force, row)
    class(contact_geometry_t), intent(in) :: self
    real(dp), intent(in) :: penetration    !! [m]; 0 without contact
    real(dp), intent(in) :: normal_force   !! including the damping of the law
    type(trace_row_t), intent(inout) :: row
  end subroutine no_columns

  !> E* [Pa] of the two materials: 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j.
  pure real(dp) function contact_modulus(self)
    class(contact_geometry_t), intent(in) :: self
    contact_modulus = 1/sum((1 - self%poissons_ratio**2)/self%youngs_modulus)
  end function contact_modulus

  !> Largest impact speed for which elastic contact of these materials is valid [m/s]: 1e-5 sqrt(E/rho), the smaller value of the
  !> two (remark after 4.7).
  pure real(dp) function fastest_impact(self)
    class(contact_geometry_t), intent(in) :: self
    fastest_impact = 1e-5_dp*sqrt(minval(self%youngs_modulus/self%density))
  end function fastest_impact
end module contact_geometry
