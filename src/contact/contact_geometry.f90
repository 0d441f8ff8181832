!> What every contact geometry answers: the elastic force between pin and bearing, a function of the penetration alone.
module contact_geometry
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: law_t, parameter_list_t
  use gudgeon_bearing, only: bearing_t
  use contact_stiffness, only: valid_impact_speed
  implicit none
  private
  public :: contact_geometry_t

  !> The elastic part of a contact, with the materials that every geometry has.
  type, abstract, extends(law_t) :: contact_geometry_t
    real(dp) :: youngs_modulus(2) = 0   !! of pin and bearing [Pa]
    real(dp) :: poissons_ratio(2) = 0   !! of pin and bearing [-]
    real(dp) :: density(2) = 0          !! of pin and bearing [kg/m^3]
    real(dp) :: three_halves = 0        !! K [N/m^1.5] where the force is K delta^1.5, found by `prepare`; 0: it is not
  contains
    procedure(prepare), deferred :: prepare
    procedure(elastic_force), deferred :: elastic_force
    procedure(slope), deferred :: slope
    procedure, non_overridable :: material_parameters
    procedure, non_overridable :: fastest_impact
  end type contact_geometry_t

  abstract interface
    !> Find what follows from the parameters and the bearing, before the first force is asked for.
    subroutine prepare(self, bearing)
      import :: contact_geometry_t, bearing_t
      class(contact_geometry_t), intent(inout) :: self
      type(bearing_t), intent(in) :: bearing
    end subroutine prepare

    !> The elastic force [N], > 0.
    pure function elastic_force(self, penetration) result(force)
      import :: contact_geometry_t, dp
      class(contact_geometry_t), intent(in) :: self
      real(dp), value, intent(in) :: penetration   !! |e| - c [m], > 0
      real(dp) :: force
    end function elastic_force

    !> Derivative by the penetration [N/m] of a force that is in proportion to the elastic one and has this value. For
    !> the elastic force itself it is the stiffness of the contact.
    pure function slope(self, penetration, force)
      import :: contact_geometry_t, dp
      class(contact_geometry_t), intent(in) :: self
      real(dp), intent(in) :: penetration   !! [m], > 0
      real(dp), intent(in) :: force         !! [N]
      real(dp) :: slope
    end function slope
  end interface

contains

  !> The materials, for the `parameters` of a geometry.
  subroutine material_parameters(self, list)
    class(contact_geometry_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('youngs_modulus', self%youngs_modulus, 'of pin and bearing', 'Pa', '> 0', default='207.0e9')
    call list%add('poissons_ratio', self%poissons_ratio, 'of pin and bearing', range='>= 0 and <= 0.5', default='0.3')
    call list%add('density', self%density, 'of pin and bearing, for the limit of validity', 'kg/m^3', '> 0', default='7850.0')
  end subroutine material_parameters

  !> The fastest impact for which elastic contact of these materials is meant (remark after 4.7) [m/s].
  pure real(dp) function fastest_impact(self)
    class(contact_geometry_t), intent(in) :: self
    fastest_impact = valid_impact_speed(self%youngs_modulus, self%density)
  end function fastest_impact
end module contact_geometry
