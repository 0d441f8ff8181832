!> Hertz's contact of two spheres (4.1), for a pin in a bearing; their lengths are not used.
module hertz_sphere
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use contact_geometry, only: contact_geometry_t
  implicit none
  private
  public :: hertz_sphere_t

  !> f = K delta^n.
  type, extends(contact_geometry_t) :: hertz_sphere_t
    real(dp) :: stiffness = 0         !! K [N/m^n], > 0
    real(dp) :: exponent = 1.5_dp     !! n [-], >= 1
    real(dp) :: given_stiffness = 0   !! stiffness given in the case [N/m^n]; 0: Hertz's, from the materials and the bearing
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: elastic_force
    procedure :: slope
    procedure :: elastic_energy
    procedure, nopass :: needs_length
    procedure :: is_of_spheres
  end type hertz_sphere_t

contains

  subroutine parameters(self, list)
    class(hertz_sphere_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('exponent', self%exponent, 'exponent of the penetration', range='>= 1', default='1.5', only_here=.true., &
      usual='1 to 2')
    call self%material_parameters(list)
    call list%add('stiffness', self%given_stiffness, 'contact stiffness; 0: from geometry and materials', 'N/m^exponent', '> 0', &
      default='0.0', only_here=.true., usual='1e5 to 1e14')
  end subroutine parameters

  !> The stiffness given in the case, or Hertz's from (4.2) and (4.3), both corrected: K = 4/(3(sigma_i + sigma_j)) sqrt(Rb Rj/(Rb -
  !> Rj)), sigma = (1 - nu^2)/E. The printed (4.2) has Rb + Rj, as for two convex surfaces; the printed (4.3) has one radius too
  !> many. For Rb - Rj the radial clearance is used, since computing it would cancel digits. Limits: 0 < clearance < radius of the
  !> bearing, E > 0, |nu| < 1.
  subroutine prepare(self, bearing)
    class(hertz_sphere_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    self%stiffness = self%given_stiffness
    if (.not. self%stiffness > 0) self%stiffness = 4/(3*sum((1 - self%poissons_ratio**2)/self%youngs_modulus)) &
      *sqrt(bearing%radius*(bearing%radius - bearing%clearance)/bearing%clearance)
    self%three_halves = 0
    if (abs(self%exponent - 1.5_dp) <= 0) self%three_halves = self%stiffness
  end subroutine prepare

  pure function elastic_force(self, penetration) result(force)
    class(hertz_sphere_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration
    real(dp) :: force
    if (self%three_halves > 0) then
      force = self%stiffness*penetration*sqrt(penetration)
    else
      force = self%stiffness*penetration**self%exponent
    end if
  end function elastic_force

  pure function slope(self, penetration, force)
    class(hertz_sphere_t), intent(in) :: self
    real(dp), intent(in) :: penetration, force
    real(dp) :: slope
    slope = self%exponent*force/penetration
  end function slope

  pure real(dp) function elastic_energy(self, penetration)
    class(hertz_sphere_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    elastic_energy = self%elastic_force(penetration)*penetration/(self%exponent + 1)
  end function elastic_energy

  !> Whether the stiffness is Hertz's, and not given.
  pure logical function is_of_spheres(self)
    class(hertz_sphere_t), intent(in) :: self
    is_of_spheres = .not. self%given_stiffness > 0
  end function is_of_spheres

  !> The force does not depend on the length of the bearing.
  pure logical function needs_length()
    needs_length = .false.
  end function needs_length
end module hertz_sphere
