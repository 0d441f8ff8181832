!> The parameters of the piston's guide in a case.
module guide_case
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  use piston_skirt, only: skirt_t
  use ring_case, only: ring_pack_t
  implicit none
  private
  public :: guide_case_t

  character(len=*), parameter :: guide_friction = 'friction', guide_clearance = 'clearance'   !! the kinds of guide

  type, extends(has_parameters_t) :: guide_case_t
    character(len=:), allocatable :: kind
    real(dp) :: viscous = 0
    real(dp) :: bore_clearance = 0, skirt_top = 0, skirt_bottom = 0, piston_radius = 0
    real(dp) :: piston_inertia = 0, piston_com(2) = 0
    real(dp) :: stiffness = 0, exponent = 1
    class(friction_law_t), allocatable :: friction
    class(contact_law_t), allocatable :: contact
    type(ring_pack_t) :: rings   !! those of the case, with the bore, set when the guide is built
    real(dp) :: bore = 0         !! of the cylinder [m]
  contains
    procedure :: parameters
    procedure :: lose_clearance
    procedure :: has_clearance
    procedure :: skirt
    procedure :: most_friction
  end type guide_case_t

contains

  !> Declare the parameters, except those of the laws.
  subroutine parameters(self, list)
    class(guide_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, guide_friction//', '//guide_clearance, guide_friction, &
      'friction: piston on the cylinder axis; clearance: piston moves across its bore and tilts (slap)')
    call list%add('viscous', self%viscous, &
      'viscous friction force per piston velocity, in addition to that of &ring', 'N s/m', '>= 0', default='0.0', usual='0 to 1e4')
    call list%add('bore_clearance', self%bore_clearance, &
      'half of bore diameter minus piston diameter; required with kind = ''clearance'', as the next five keys', &
      'm', '> 0', default='0.0', usual='1e-6 to 1e-3')
    call list%add('skirt_top', self%skirt_top, 'height of the upper corners of the skirt above the pin, along the piston', 'm', &
      '> 0', default='0.0', usual='1e-3 to 1')
    call list%add('skirt_bottom', self%skirt_bottom, &
      'depth of the lower corners of the skirt below the pin, along the piston', 'm', '> 0', default='0.0', usual='1e-3 to 1')
    call list%add('piston_radius', self%piston_radius, 'distance of the skirt corners from the piston axis', &
      'm', '> 0', default='0.0', usual='2e-3 to 1')
    call list%add('piston_inertia', self%piston_inertia, &
      'moment of inertia of the piston about its centre of mass', 'kg m^2', '> 0', default='0.0', usual='1e-9 to 1e4')
    call list%add('stiffness', self%stiffness, 'contact stiffness of a corner of the skirt', 'N/m^exponent', '> 0', default='0.0', &
      usual='1e5 to 1e13')
    call list%add('piston_com', self%piston_com, &
      'centre of mass of the piston from the pin, along and across the piston (pin offset)', 'm', default='0.0', usual='0 to 0.5')
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
    has_clearance = self%kind == guide_clearance
  end function has_clearance

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
