!> The guide of the piston: the bore, where it has friction or the piston has clearance in it.
!>
!> With friction alone the piston stays on the cylinder's axis and F_x = mu(x') |N| - c x', N being the force of the piston on the
!> guide. With clearance (slap) the piston moves across and tilts, and the four corners of its skirt may touch the bore, each in
!> a contact and with friction of its own. Corner i is at
!>
!>     r_i = (x, y) + Rot(b) (h_i - U_p, b_i),   h_i along the piston from the pin's bearing, b_i = +-R_p from its axis
!>
!> and the depth to which it is in the bore's wall is d_i = +-(y_i) - R_p - c, with -d_i its gap.
module piston_guide
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  use gudgeon_bearing, only: bearing_t
  use state_layout, only: layout_t, coordinates_t
  use chain_motion, only: motion_t, tilting_t
  use chain_bodies, only: piston_t
  use chain_loads, only: loads_t
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: piston_guide_t, guide_loads_t, corner_t, n_corners, corner_names

  integer, parameter :: n_corners = 4
  !> Towards +y: top, bottom; towards -y: top, bottom.
  character(len=*), parameter :: corner_names(n_corners) = [character(len=7) :: 'guide_1', 'guide_2', 'guide_3', 'guide_4']

  !> A corner of the skirt at the wall of the bore.
  type :: corner_t
    real(dp) :: from_com(2)       !! the corner from the piston's centre of mass, along x and y [m]
    real(dp) :: depth             !! in the wall [m], negative while apart
    real(dp) :: depth_rate        !! [m/s]
    real(dp) :: sliding_speed     !! of the corner along x [m/s]
    real(dp) :: normal_force      !! pressing [N]
    real(dp) :: friction_force    !! on the piston along x [N]
  end type corner_t

  !> What the guide does to the piston.
  type :: guide_loads_t
    real(dp) :: friction_force    !! along x [N]
    type(corner_t) :: corner(n_corners)   !! where there is clearance
  end type guide_loads_t

  type :: piston_guide_t
    logical :: is_loose = .false.         !! the piston has clearance in its bore
    class(friction_law_t), allocatable :: friction   !! not allocated: none but the viscous one
    real(dp) :: viscous = 0               !! c [N s/m]
    class(contact_law_t), allocatable :: contact     !! of a corner with the bore
    real(dp) :: clearance = 0             !! half of the bore's diameter less the piston's [m]
    real(dp) :: radius = 0                !! R_p, of the piston [m]
    real(dp) :: height(2) = 0             !! top and bottom of the skirt from the centre of mass, along the piston [m]
    type(coordinates_t) :: offset, tilt   !! where they stand in the state
    logical :: touches(n_corners) = .false.
    real(dp) :: impact_speed(n_corners) = 0   !! rate of the depth at which the present contact began [m/s]
    real(dp) :: start(2) = 0              !! offset [m] and tilt [rad] at t = 0
    real(dp) :: start_rate(2) = 0         !! [m/s], [rad/s]
  contains
    procedure :: prepare
    procedure :: claim
    procedure :: settle
    procedure :: put_start
    procedure :: read_state
    procedure :: place_corners
    procedure :: look
    procedure :: admits
    procedure :: slide
    procedure :: friction_on_guide
    procedure :: put_rates
    procedure :: own_speed
    procedure :: exchange
  end type piston_guide_t

contains

  !> Find what the laws need to know before the first force is asked for.
  subroutine prepare(self)
    class(piston_guide_t), intent(inout) :: self
    if (allocated(self%friction)) call self%friction%prepare()
    if (allocated(self%contact)) call self%contact%prepare(bearing_t())
  end subroutine prepare

  !> Claim offset and tilt. The offset is measured by the clearance, its rate as that of a pin in its bearing; the tilt by the angle
  !> at which top and bottom of the skirt touch opposite walls.
  subroutine claim(self, layout, crank_speed, span)
    class(piston_guide_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    real(dp), intent(in) :: crank_speed   !! natural size of it [rad/s]
    real(dp), intent(in) :: span          !! of the simulation [s]
    real(dp) :: speed, arm
    if (.not. self%is_loose) return
    arm = 0.5_dp*(self%height(1) - self%height(2))
    speed = max(self%clearance*crank_speed, abs(self%start_rate(1)), arm*abs(self%start_rate(2)), &
      0.01_dp*crossing_speed(self, span))
    call layout%claim_positions(1, self%clearance, speed, self%offset, grows=.false.)
    call layout%claim_positions(1, self%clearance/arm, speed/arm, self%tilt, grows=.false.)
  end subroutine claim

  !> Speed that crosses the clearance in the time simulated, at most 1 m/s.
  pure real(dp) function crossing_speed(guide, span)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: span   !! [s]
    crossing_speed = min(guide%clearance/span, 1.0_dp)
  end function crossing_speed

  !> Natural size of the piston's speed across its bore where the crank does not give it [m/s]; 0 without clearance.
  pure real(dp) function own_speed(self, span)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: span   !! [s]
    own_speed = 0
    if (self%is_loose) own_speed = max(abs(self%start_rate(1)), maxval(abs(self%height))*abs(self%start_rate(2)), &
      crossing_speed(self, span))
  end function own_speed

  subroutine settle(self, layout)
    class(piston_guide_t), intent(inout) :: self
    type(layout_t), intent(in) :: layout
    if (.not. self%is_loose) return
    call layout%settle(self%offset)
    call layout%settle(self%tilt)
  end subroutine settle

  !> Its part of the state at t = 0.
  pure subroutine put_start(self, y)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    if (.not. self%is_loose) return
    y([self%offset%position, self%tilt%position]) = self%start
    y([self%offset%rate, self%tilt%rate]) = self%start_rate
  end subroutine put_start

  !> Offset and tilt, and their rates.
  pure subroutine read_state(self, y, tilting)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(inout) :: tilting
    tilting%offset = y(self%offset%position)
    tilting%offset_rate = y(self%offset%rate)
    tilting%tilt = y(self%tilt%position)
    tilting%tilt_rate = y(self%tilt%rate)
  end subroutine read_state

  !> Where the corners are: all but their sliding speeds and forces.
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

  !> Depths of the corners, their rates and normal forces: all that a state tells without the motion of the bodies.
  pure subroutine look(self, y, corners)
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
  end subroutine look

  !> Pressing force of a corner [N]; 0 while it is apart.
  pure real(dp) function normal_force(guide, i, corner)
    type(piston_guide_t), intent(in) :: guide
    integer, intent(in) :: i
    type(corner_t), intent(in) :: corner
    normal_force = 0
    if (guide%touches(i)) normal_force = guide%contact%normal_force(corner%depth, corner%depth_rate, guide%impact_speed(i))
  end function normal_force

  !> Whether the piston may be there: no corner through the wall by more than the piston's radius, and not turned round.
  pure logical function admits(self, tilting)
    class(piston_guide_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    admits = abs(tilting%offset) < self%clearance + self%radius .and. abs(tilting%tilt) < 1
  end function admits

  !> What the bore does to a piston with clearance in it, also among the loads of the chain.
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

  !> Friction over normal force [-] along x.
  pure real(dp) function friction_ratio(guide, speed)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: speed   !! [m/s]
    friction_ratio = 0
    if (allocated(guide%friction)) friction_ratio = guide%friction%friction_ratio(speed, nint(sign(1.0_dp, speed)))
  end function friction_ratio

  !> Friction of an ideal guide on the piston at its speed x' [m/s]: what depends on the normal force, over it, and the rest [N].
  pure subroutine friction_on_guide(self, speed, ratio, rest)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: speed
    real(dp), intent(out) :: ratio   !! mu [-], of the other sign than the speed
    real(dp), intent(out) :: rest
    ratio = friction_ratio(self, speed)
    rest = -self%viscous*speed
  end subroutine friction_on_guide

  !> Rates of what it claimed.
  pure subroutine put_rates(self, tilting, offset_acceleration, tilt_acceleration, dydt)
    class(piston_guide_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    real(dp), intent(in) :: offset_acceleration, tilt_acceleration   !! [m/s^2], [rad/s^2]
    real(dp), intent(inout) :: dydt(*)
    if (.not. self%is_loose) return
    dydt(self%offset%position) = tilting%offset_rate
    dydt(self%offset%rate) = offset_acceleration
    dydt(self%tilt%position) = tilting%tilt_rate
    dydt(self%tilt%rate) = tilt_acceleration
  end subroutine put_rates

  !> The discrete state, to or from an archive.
  subroutine exchange(self, archive)
    class(piston_guide_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    integer :: i
    do i = 1, n_corners
      call archive%exchange(self%touches(i))
      call archive%exchange(self%impact_speed(i))
    end do
  end subroutine exchange
end module piston_guide
