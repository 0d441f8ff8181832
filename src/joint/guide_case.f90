!> The parameters of the piston's guide in a case.
module guide_case
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  use piston_skirt, only: skirt_t
  use ring_case, only: ring_pack_t
  use skirt_film_case, only: skirt_film_case_t
  use measured_curve, only: measured_curve_t
  implicit none
  private
  public :: guide_case_t

  character(len=*), parameter :: guide_friction = 'friction', guide_clearance = 'clearance', &
    guide_lubricated = 'lubricated'   !! the kinds of guide

  type, extends(has_parameters_t) :: guide_case_t
    character(len=:), allocatable :: kind
    real(dp) :: viscous = 0
    real(dp) :: bore_clearance = 0, skirt_top = 0, skirt_bottom = 0, piston_radius = 0
    real(dp) :: piston_inertia = 0, piston_com(2) = 0
    real(dp) :: stiffness = 0, exponent = 1
    class(friction_law_t), allocatable :: friction
    class(contact_law_t), allocatable :: contact
    real(dp) :: half_angle_deg = 0, barrel = 0, barrel_height = 0, ovality = 0
    type(measured_curve_t) :: profile   !! height above the pin [m], relief [m]
    type(skirt_film_case_t) :: film   !! of a lubricated skirt, as the following set when the guide is built
    type(ring_pack_t) :: rings   !! those of the case
    real(dp) :: bore = 0         !! of the cylinder [m]
  contains
    procedure :: parameters
    procedure :: lose_clearance
    procedure :: has_clearance
    procedure :: has_corners
    procedure :: is_lubricated
    procedure :: widest_height
    procedure :: skirt
    procedure :: most_friction
  end type guide_case_t

contains

  !> Declare the parameters, except those of the laws.
  subroutine parameters(self, list)
    class(guide_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, guide_friction//', '//guide_clearance//', '//guide_lubricated, guide_friction, &
      'friction: piston on the cylinder axis; clearance: piston moves across its bore and tilts (slap), with dry corners; '// &
      'lubricated: with a film between skirt and bore')
    call list%add('viscous', self%viscous, &
      'viscous friction force per piston velocity, in addition to that of &ring', 'N s/m', '>= 0', default='0.0', usual='0 to 1e4')
    call list%add('bore_clearance', self%bore_clearance, &
      'half of bore diameter minus piston diameter; required with clearance, as the next five keys', &
      'm', '> 0', default='0.0', usual='1e-6 to 1e-3')
    call list%add('skirt_top', self%skirt_top, 'height of the upper corners of the skirt above the pin, along the piston', 'm', &
      '> 0', default='0.0', usual='1e-3 to 1')
    call list%add('skirt_bottom', self%skirt_bottom, &
      'depth of the lower corners of the skirt below the pin, along the piston', 'm', '> 0', default='0.0', usual='1e-3 to 1')
    call list%add('piston_radius', self%piston_radius, 'distance of the skirt corners from the piston axis', &
      'm', '> 0', default='0.0', usual='2e-3 to 1')
    call list%add('piston_inertia', self%piston_inertia, &
      'moment of inertia of the piston about its centre of mass', 'kg m^2', '> 0', default='0.0', usual='1e-9 to 1e4')
    call list%add('stiffness', self%stiffness, 'contact stiffness of a corner of the skirt, > 0; lubricated: of the '// &
      'spring at each end of each face, in N/m; 0: rigid faces', 'N/m^exponent', '>= 0', default='0.0', usual='1e5 to 1e13')
    call list%add('piston_com', self%piston_com, &
      'centre of mass of the piston from the pin, along and across the piston; across > 0: pin offset towards -y, the side '// &
      'that is pressed after firing where crank_speed is > 0', 'm', default='0.0', usual='0 to 0.5')
    call list%add('half_angle_deg', self%half_angle_deg, 'lubricated: half width of each face of the skirt around the piston', &
      'degrees', '> 5 and <= 85', default='45.0', usual='30 to 60')
    call list%add('barrel', self%barrel, 'lubricated: relief of the skirt at half its length from its widest place', 'm', '>= 0', &
      default='0.0', usual='1e-6 to 2e-4')
    call list%add('barrel_height', self%barrel_height, 'lubricated: widest place above the pin, along the piston; 10: the middle', &
      'm', '>= -2 and <= 2', default='10.0', usual='1e-4 to 1')
    call self%profile%parameters(list, 'profile_table', 'lubricated: CSV table with the columns height[mm] above the pin and '// &
      'relief[um], instead of barrel; '''': none', default='')
    call list%add('ovality', self%ovality, 'lubricated: relief of the radius at 90 degrees from the thrust axis', 'm', '>= 0', &
      default='0.0', usual='1e-6 to 5e-4')
    call list%add('exponent', self%exponent, 'exponent of the penetration', range='>= 1', default='1.0', usual='1 to 2')
  end subroutine parameters

  !> Largest ratio of friction to normal force [-] at sliding speeds up to a given one [m/s], within 2 %: the law is evaluated at
  !> speeds that differ by a tenth.
  real(dp) function most_friction(self, highest_speed)
    class(guide_case_t), intent(in) :: self
    real(dp), intent(in) :: highest_speed
    real(dp), parameter :: lowest = 1e-12_dp
    class(friction_law_t), allocatable :: law
    real(dp) :: speed
    most_friction = 0
    if (.not. allocated(self%friction)) return
    allocate (law, source=self%friction)
    call law%prepare()
    speed = highest_speed
    do while (speed > lowest)
      most_friction = max(most_friction, abs(law%friction_ratio(speed, 1)))
      speed = speed/1.1_dp
    end do
  end function most_friction

  !> Become an ideal guide, except for the rings, if the piston has clearance in its bore or nothing is known of the guide.
  subroutine lose_clearance(self)
    class(guide_case_t), intent(inout) :: self
    if (.not. allocated(self%kind)) self%kind = guide_clearance
    if (.not. self%has_clearance()) return
    self%kind = guide_friction
    self%viscous = 0
    if (allocated(self%friction)) deallocate (self%friction)
  end subroutine lose_clearance

  !> Whether the piston has clearance in its bore.
  pure logical function has_clearance(self)
    class(guide_case_t), intent(in) :: self
    has_clearance = any(self%kind == [character(len=10) :: guide_clearance, guide_lubricated])
  end function has_clearance

  !> Whether dry corners of the skirt meet the bore.
  pure logical function has_corners(self)
    class(guide_case_t), intent(in) :: self
    has_corners = self%kind == guide_clearance
  end function has_corners

  !> Whether there is a film between skirt and bore.
  pure logical function is_lubricated(self)
    class(guide_case_t), intent(in) :: self
    is_lubricated = self%kind == guide_lubricated
  end function is_lubricated

  !> Height of the widest place of the skirt above the pin [m].
  pure real(dp) function widest_height(self)
    class(guide_case_t), intent(in) :: self
    widest_height = self%barrel_height
    if (widest_height > 2) widest_height = 0.5_dp*(self%skirt_top - self%skirt_bottom)   ! not given
  end function widest_height

  !> The skirt in its bore, at first without contact.
  pure type(skirt_t) function skirt(self)
    class(guide_case_t), intent(in) :: self
    skirt%is_loose = self%has_clearance()
    if (.not. skirt%is_loose) return
    skirt%clearance = self%bore_clearance
    skirt%radius = self%piston_radius
    skirt%height = [self%skirt_top, -self%skirt_bottom] - self%piston_com(1)
  end function skirt
end module guide_case
