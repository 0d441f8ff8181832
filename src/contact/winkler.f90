!> A foundation of independent springs around the bore: the contact of a bearing with a thin, soft liner.
module winkler
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use contact_geometry, only: contact_geometry_t
  implicit none
  private
  public :: winkler_t

  !> At the angle theta a rigid pin compresses the foundation by (c + delta) cos(theta) - c, up to the half-angle a with cos a =
  !> c/(c + delta): f = k Rb L [(c + delta)(a + sin a cos a) - 2 c sin a], which is k Rb L c [(1 + D) a - sin a] with D = delta/c.
  !> For a thin liner bonded to a stiff back k = E (1 - nu)/[(1 + nu)(1 - 2 nu) t].
  type, extends(contact_geometry_t) :: winkler_t
    real(dp) :: given_modulus = 0   !! k, given in the case [Pa/m]; 0: computed from the liner
    real(dp) :: liner_modulus = 0, liner_poissons_ratio = 0, liner_thickness = 0   !! E [Pa], nu [-], t [m]
    real(dp) :: clearance = 1       !! c [m]
    real(dp) :: bedding = 0         !! k Rb L [N/m^2]
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: prepare
    procedure :: elastic_force
    procedure :: slope
    procedure :: elastic_energy
    procedure :: foundation
    procedure, nopass :: has_foundation
    procedure :: half_angle
    procedure :: pressure
    procedure :: total_pressure
  end type winkler_t

contains

  subroutine parameters(self, list)
    class(winkler_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%material_parameters(list)
    call list%add('bedding_modulus', self%given_modulus, &
      'pressure per penetration depth; 0: from the data of the liner', 'Pa/m', '> 0', default='0.0', usual='1e9 to 1e16')
    call list%add('liner_modulus', self%liner_modulus, 'Young''s modulus of a thin liner', 'Pa', '> 0', default='0.0', &
      usual='1e8 to 1e12')
    call list%add('liner_poissons_ratio', self%liner_poissons_ratio, &
      'Poisson''s ratio of the liner', range='>= 0 and <= 0.49', default='0.0', usual='0.1 to 0.49')
    call list%add('liner_thickness', self%liner_thickness, 'thickness of the liner', 'm', '> 0', default='0.0', &
      usual='1e-5 to 1e-2')
  end subroutine parameters

  !> Report that neither the stiffness of the foundation nor the liner is given, or both.
  pure subroutine conflict(self, key, wanted)
    class(winkler_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    logical :: has_liner
    key = ''
    has_liner = self%liner_modulus > 0 .or. self%liner_thickness > 0
    wanted = 'required with geometry = ''winkler'', or liner_modulus and liner_thickness'
    if (self%given_modulus > 0 .and. has_liner) then
      key = 'bedding_modulus'
      wanted = 'must not be given together with liner_modulus or liner_thickness'
    else if (has_liner .and. .not. self%liner_modulus > 0) then
      key = 'liner_modulus'
      wanted = 'required with liner_thickness'
    else if (has_liner .and. .not. self%liner_thickness > 0) then
      key = 'liner_thickness'
      wanted = 'required with liner_modulus'
    else if (.not. (has_liner .or. self%given_modulus > 0)) then
      key = 'bedding_modulus'
    end if
  end subroutine conflict

  pure logical function has_foundation()
    has_foundation = .true.
  end function has_foundation

  subroutine prepare(self, bearing)
    class(winkler_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp) :: k
    k = self%given_modulus
    associate (nu => self%liner_poissons_ratio)
      if (.not. k > 0) k = self%liner_modulus*(1 - nu)/((1 + nu)*(1 - 2*nu)*self%liner_thickness)
    end associate
    self%clearance = bearing%clearance
    self%bedding = k*bearing%radius*bearing%length
    if (self%liner_thickness > 0) self%deepest = self%liner_thickness
  end subroutine prepare

  !> tan a = sqrt(D (2 + D)).
  pure real(dp) function tangent(self, penetration)
    class(winkler_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    associate (d => penetration/self%clearance)
      tangent = sqrt(d)*sqrt(2 + d)
    end associate
  end function tangent

  !> k Rb L c [D a + (a - sin a)].
  pure function elastic_force(self, penetration) result(force)
    class(winkler_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration
    real(dp) :: force, a
    a = atan(tangent(self, penetration))
    force = self%bedding*(penetration*a + self%clearance*excess_over_sine(a))
  end function elastic_force

  !> x - sin x, for small x from its series.
  pure real(dp) function excess_over_sine(x) result(excess)
    real(dp), intent(in) :: x
    real(dp) :: term
    integer :: k
    excess = x - sin(x)
    if (.not. x < 0.6_dp) return
    term = x**3/6
    excess = term
    do k = 2, 8
      term = -term*x**2/((2*k)*(2*k + 1))
      excess = excess + term
    end do
  end function excess_over_sine

  !> Stiffness k Rb L (a + sin a cos a).
  pure function slope(self, penetration, force)
    class(winkler_t), intent(in) :: self
    real(dp), intent(in) :: penetration, force
    real(dp) :: slope, t
    t = tangent(self, penetration)
    slope = force/self%elastic_force(penetration)*self%bedding*(atan(t) + t/(1 + t**2))
  end function slope

  !> Elastic energy k Rb L [(c + delta)^2 (a + sin a cos a)/2 - 2 (c + delta) c sin a + c^2 a], with t = tan a: k Rb L c^2 [(3 +
  !> t^2) a - 3 t]/2; for small t the series 2/15 t^5 - 4/35 t^7 + ...
  pure real(dp) function elastic_energy(self, penetration) result(energy)
    class(winkler_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    real(dp) :: t
    integer :: k
    t = tangent(self, penetration)
    if (t < 0.3_dp) then
      energy = 0
      do k = 20, 2, -1
        energy = 2*(k - 1)/(4*k**2 - 1.0_dp) - t**2*energy
      end do
      energy = energy*t**5
    else
      energy = ((3 + t**2)*atan(t) - 3*t)/2
    end if
    energy = energy*self%bedding*self%clearance**2
  end function elastic_energy

  pure real(dp) function foundation(self) result(stiffness)
    class(winkler_t), intent(in) :: self
    stiffness = self%bedding
  end function foundation

  !> a with cos a = c/(c + delta).
  pure real(dp) function half_angle(self, penetration)
    class(winkler_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    half_angle = atan(tangent(self, penetration))
  end function half_angle

  !> (cos theta - cos a)/(a - sin a cos a), with the first difference as a product of sines.
  pure real(dp) function pressure(self, half_angle, angle)
    class(winkler_t), intent(in) :: self
    real(dp), intent(in) :: half_angle, angle
    pressure = 4*sin(0.5_dp*(half_angle + angle))*sin(0.5_dp*(half_angle - angle))/excess_over_sine(2*half_angle)
  end function pressure

  !> 2 (sin a - a cos a)/(a - sin a cos a), with sin a - a cos a = 2 a sin^2(a/2) - (a - sin a).
  pure real(dp) function total_pressure(self, half_angle)
    class(winkler_t), intent(in) :: self
    real(dp), intent(in) :: half_angle
    associate (a => half_angle)
      total_pressure = 4*(2*a*sin(0.5_dp*a)**2 - excess_over_sine(a))/excess_over_sine(2*a)
    end associate
  end function total_pressure
end module winkler
