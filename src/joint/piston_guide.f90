!> The guide of the piston in its bore, with friction or with clearance.
!>
!> With friction alone the piston stays on the cylinder's axis and F_x = mu(x') |N| - c x', where N is the force of the piston on
!> the guide. With clearance (piston slap) the piston also moves transversely and tilts, and the four corners of its skirt may touch
!> the bore, each with its own contact and friction. Corner i is at
!>
!>     r_i = (x, y) + Rot(b) (h_i - U_p, b_i),   h_i along the piston from the pin's bearing, b_i = +-R_p from its axis
!>
!> and its penetration into the wall of the bore is d_i = +-(y_i) - R_p - c; -d_i is its gap.
module piston_guide
  use kinds, only: dp
  use bearing_size, only: bearing_t, crossing_speed
  use state_layout, only: layout_t, coordinates_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, tilting_t
  use chain_loads, only: loads_t
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: piston_guide_t, guide_loads_t, corner_t, n_corners, corner_names

  integer, parameter :: n_corners = 4
  !> The corners: on the side of +y top and bottom, on the side of -y top and bottom.
  character(len=*), parameter :: corner_names(n_corners) = [character(len=7) :: 'guide_1', 'guide_2', 'guide_3', 'guide_4']

  !> A corner of the skirt at the wall of the bore.
  type :: corner_t
    real(dp) :: from_com(2)       !! the corner from the piston's centre of mass, along x and y [m]
    real(dp) :: depth             !! penetration [m], negative without contact
    real(dp) :: depth_rate        !! [m/s]
    real(dp) :: sliding_speed     !! of the corner along x [m/s]
    real(dp) :: normal_force      !! positive in compression [N]
    real(dp) :: friction_force    !! on the piston along x [N]
  end type corner_t

  !> Loads of the guide on the piston.
  type :: guide_loads_t
    real(dp) :: friction_force    !! along x [N]
    type(corner_t) :: corner(n_corners)   !! with clearance in the bore
  end type guide_loads_t

  type :: piston_guide_t
    logical :: is_loose = .false.         !! the piston has clearance in its bore
    class(friction_law_t), allocatable :: friction   !! not allocated: only viscous friction
    real(dp) :: viscous = 0               !! c [N s/m]
    class(contact_law_t), allocatable :: contact     !! of a corner with the bore
    real(dp) :: clearance = 0             !! radial clearance: half the difference of the diameters of bore and piston [m]
    real(dp) :: radius = 0                !! R_p, of the piston [m]
    real(dp) :: height(2) = 0             !! top and bottom of the skirt, measured from the centre of mass along the piston [m]
    type(coordinates_t) :: offset, tilt   !! their indices in the state
    logical :: touches(n_corners) = .false.
    logical :: force_is_lost(n_corners) = .false.   !! in contact, but the damper cancels the elastic force: none acts
    real(dp) :: impact_speed(n_corners) = 0   !! penetration rate at the beginning of the present contact [m/s]
    real(dp) :: start(2) = 0              !! offset [m] and tilt [rad] at t = 0
    real(dp) :: start_rate(2) = 0         !! [m/s], [rad/s]
  contains
    procedure :: prepare
    procedure :: claim
    procedure :: set_start
    procedure :: declare
    procedure :: read_state
    procedure :: place_corners
    procedure :: find_contact_state
    procedure :: admits
    procedure :: slide
    procedure :: friction_on_guide
    procedure :: set_rates
    procedure :: own_speed
  end type piston_guide_t

contains

  !> Prepare the laws before the first evaluation of a force.
  subroutine prepare(self)
    class(piston_guide_t), intent(inout) :: self
    if (allocated(self%friction)) call self%friction%prepare()
    if (allocated(self%contact)) call self%contact%prepare(bearing_t())
  end subroutine prepare

  !> Claim offset and tilt in the state vector. The scale of the offset is the clearance, that of its rate as for a pin in its
  !> bearing; the scale of the tilt is the angle at which top and bottom of the skirt touch opposite walls.
  subroutine claim(self, layout, crank_speed, span)
    class(piston_guide_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    real(dp), intent(in) :: crank_speed   !! natural size of the crank speed [rad/s]
    real(dp), intent(in) :: span          !! duration of the simulation [s]
    real(dp) :: speed, arm
    if (.not. self%is_loose) return
    arm = 0.5_dp*(self%height(1) - self%height(2))
    speed = max(self%clearance*crank_speed, abs(self%start_rate(1)), arm*abs(self%start_rate(2)), &
      0.01_dp*crossing_speed(self%clearance, span))
    call layout%claim_positions(1, self%clearance, speed, self%offset, grows=.false.)
    call layout%claim_positions(1, self%clearance/arm, speed/arm, self%tilt, grows=.false.)
  end subroutine claim

  !> Natural size of the piston's transverse speed where it does not follow from the crank speed [m/s]; 0 without clearance.
  pure real(dp) function own_speed(self, span)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: span   !! [s]
    own_speed = 0
    if (self%is_loose) own_speed = max(abs(self%start_rate(1)), maxval(abs(self%height))*abs(self%start_rate(2)), &
      crossing_speed(self%clearance, span))
  end function own_speed

  !> Set the initial offset and tilt in the state vector.
  pure subroutine set_start(self, y)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    if (.not. self%is_loose) return
    y([self%offset%position, self%tilt%position]) = self%start
    y([self%offset%rate, self%tilt%rate]) = self%start_rate
  end subroutine set_start

  !> Declare the state of a piston with clearance in its bore. In a bore of another clearance it keeps its ratio to the clearance.
  subroutine declare(self, list, y)
    class(piston_guide_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    real(dp) :: clearance
    integer :: touches(n_corners), i
    if (.not. self%is_loose) return
    clearance = self%clearance
    touches = merge(1, 0, self%touches)
    call list%add('bore_clearance', clearance, 'm', 'clearance of this position of the piston')
    call list%add('piston_offset', y(self%offset%position), 'm', 'centre of mass of the piston from the cylinder axis')
    call list%add('piston_offset_rate', y(self%offset%rate), 'm/s', 'its rate')
    call list%add('piston_tilt', y(self%tilt%position), 'rad', 'tilt of the piston')
    call list%add('piston_tilt_rate', y(self%tilt%rate), 'rad/s', 'its rate')
    do i = 1, n_corners
      call list%add(trim(corner_names(i))//'_contact', touches(i), '1: this corner of the skirt is in contact')
    end do
    call list%add('guide_impact_speed', self%impact_speed, 'm/s', 'speeds at which their present or last contacts began')
    if (.not. list%sets) return
    self%touches = touches > 0
    if (abs(clearance - self%clearance) > 0) then
      y([self%offset%position, self%tilt%position]) = self%clearance/clearance*y([self%offset%position, self%tilt%position])
      self%touches = .false.   ! `complete_state` of the scene finds them
    end if
  end subroutine declare

  !> Read offset and tilt, and their rates, from the state vector.
  pure subroutine read_state(self, y, tilting)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(inout) :: tilting
    tilting%offset = y(self%offset%position)
    tilting%offset_rate = y(self%offset%rate)
    tilting%tilt = y(self%tilt%position)
    tilting%tilt_rate = y(self%tilt%rate)
  end subroutine read_state

  !> Positions, penetrations and penetration rates of the corners, without sliding speeds and forces.
  pure subroutine place_corners(self, tilting, corners)
    class(piston_guide_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    type(corner_t), intent(inout) :: corners(n_corners)
    real(dp) :: sine, cosine, side, narrowing
    integer :: i
    sine = sin(tilting%tilt)
    cosine = cos(tilting%tilt)
    narrowing = 2*self%radius*sin(0.5_dp*tilting%tilt)**2   ! R_p (1 - cos b)
    do i = 1, n_corners
      side = merge(1, -1, i <= 2)
      associate (h => self%height(2 - modulo(i, 2)), corner => corners(i))
        corner%from_com = [h*cosine - side*self%radius*sine, h*sine + side*self%radius*cosine]
        corner%depth = side*(tilting%offset + h*sine) - narrowing - self%clearance
        corner%depth_rate = side*(tilting%offset_rate + corner%from_com(1)*tilting%tilt_rate)
      end associate
    end do
  end subroutine place_corners

  !> Penetrations of the corners, their rates and normal forces: all that follows from the state without the motion of the bodies.
  pure subroutine find_contact_state(self, y, corners)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    type(corner_t), intent(inout) :: corners(n_corners)
    type(tilting_t) :: tilting
    integer :: i
    call self%read_state(y, tilting)
    call self%place_corners(tilting, corners)
    do i = 1, n_corners
      corners(i)%normal_force = normal_force(self, i, corners(i))
    end do
  end subroutine find_contact_state

  !> Normal force of a corner [N]; 0 without contact.
  pure real(dp) function normal_force(guide, i, corner)
    type(piston_guide_t), intent(in) :: guide
    integer, intent(in) :: i
    type(corner_t), intent(in) :: corner
    normal_force = 0
    if (guide%touches(i) .and. .not. guide%force_is_lost(i)) &
      normal_force = guide%contact%normal_force(corner%depth, corner%depth_rate, guide%impact_speed(i))
  end function normal_force

  !> Whether the position of the piston is admissible: no corner penetrates the wall by more than the piston's radius, and the tilt
  !> is less than 1 rad.
  pure logical function admits(self, tilting)
    class(piston_guide_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    admits = abs(tilting%offset) < self%clearance + self%radius .and. abs(tilting%tilt) < 1
  end function admits

  !> Loads of the bore on a piston with clearance; they are also added to the loads of the chain.
  pure subroutine slide(self, motion, own, all)
    class(piston_guide_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(guide_loads_t), intent(inout) :: own
    type(loads_t), intent(inout) :: all
    real(dp) :: side
    integer :: i
    call self%place_corners(motion%tilting, own%corner)
    own%friction_force = -self%viscous*motion%tilting%com_velocity
    all%bore_force = 0
    all%bore_moment = 0
    do i = 1, n_corners
      associate (corner => own%corner(i))
        corner%sliding_speed = motion%tilting%com_velocity - corner%from_com(2)*motion%tilting%tilt_rate
        corner%normal_force = 0
        corner%friction_force = 0
        if (.not. self%touches(i)) cycle
        corner%normal_force = normal_force(self, i, corner)
        corner%friction_force = corner%normal_force*friction_ratio(self, corner%sliding_speed)
        side = merge(1, -1, i <= 2)
        own%friction_force = own%friction_force + corner%friction_force
        all%bore_force = all%bore_force - side*corner%normal_force
        all%bore_moment = all%bore_moment - side*corner%from_com(1)*corner%normal_force - corner%from_com(2)*corner%friction_force
      end associate
    end do
    all%axial_force = all%axial_force - own%friction_force
  end subroutine slide

  !> Ratio of the friction force along x to the normal force [-].
  pure real(dp) function friction_ratio(guide, speed)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: speed   !! [m/s]
    friction_ratio = 0
    if (allocated(guide%friction)) friction_ratio = guide%friction%friction_ratio(speed, nint(sign(1.0_dp, speed)))
  end function friction_ratio

  !> Friction of an ideal guide on the piston at the speed x' [m/s]: the ratio of the part that depends on the normal force to that
  !> force, and the remaining force [N].
  pure subroutine friction_on_guide(self, speed, ratio, rest)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: speed
    real(dp), intent(out) :: ratio   !! mu [-], opposite in sign to the speed
    real(dp), intent(out) :: rest
    ratio = friction_ratio(self, speed)
    rest = -self%viscous*speed
  end subroutine friction_on_guide

  !> Rates of the guide's states.
  pure subroutine set_rates(self, tilting, offset_acceleration, tilt_acceleration, dydt)
    class(piston_guide_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    real(dp), intent(in) :: offset_acceleration, tilt_acceleration   !! [m/s^2], [rad/s^2]
    real(dp), intent(inout) :: dydt(*)
    if (.not. self%is_loose) return
    dydt(self%offset%position) = tilting%offset_rate
    dydt(self%offset%rate) = offset_acceleration
    dydt(self%tilt%position) = tilting%tilt_rate
    dydt(self%tilt%rate) = tilt_acceleration
  end subroutine set_rates
end module piston_guide
