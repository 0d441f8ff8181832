!> The skirt of a piston with clearance in its bore: its corners, and which of them touch the bore.
!>
!> The piston moves transversely and tilts. Corner i is at
!>
!>     r_i = (x, y) + Rot(b) (h_i - U_p, b_i),   h_i along the piston from the pin's bearing, b_i = +-R_p from its axis
!>
!> and its penetration into the wall of the bore is d_i = +-(y_i) - R_p - c; -d_i is its gap.
module piston_skirt
  use kinds, only: dp
  use state_layout, only: coordinates_t
  use chain_motion, only: tilting_t
  implicit none
  private
  public :: skirt_t, corner_t, n_corners, corner_names

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

  type :: skirt_t
    logical :: is_loose = .false.         !! the piston has clearance in its bore; else the other components are not used
    real(dp) :: clearance = 0             !! radial clearance: half the difference of the diameters of bore and piston [m]
    real(dp) :: radius = 0                !! R_p, of the piston [m]
    real(dp) :: height(2) = 0             !! top and bottom of the skirt, measured from the centre of mass along the piston [m]
    type(coordinates_t) :: offset, tilt   !! their indices in the state
    logical :: touches(n_corners) = .false.
    logical :: force_is_lost(n_corners) = .false.   !! in contact, but the damper cancels the elastic force: none acts
    real(dp) :: impact_speed(n_corners) = 0   !! penetration rate at the beginning of the present contact [m/s]
  contains
    procedure, non_overridable :: read_state
    procedure, non_overridable :: place_corners
    procedure, non_overridable :: admits
    procedure, non_overridable :: reached
  end type skirt_t

contains

  !> Read offset and tilt, and their rates, from the state vector.
  pure subroutine read_state(self, y, tilting)
    class(skirt_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(inout) :: tilting
    tilting%offset = y(self%offset%position)
    tilting%offset_rate = y(self%offset%rate)
    tilting%tilt = y(self%tilt%position)
    tilting%tilt_rate = y(self%tilt%rate)
  end subroutine read_state

  !> Positions, penetrations and penetration rates of the corners, without sliding speeds and forces.
  pure subroutine place_corners(self, tilting, corners)
    class(skirt_t), intent(in) :: self
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

  !> Whether the position of the piston is admissible.
  pure logical function admits(self, tilting)
    class(skirt_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    admits = self%reached(tilting) < 1
  end function admits

  !> Offset or tilt of the piston over its limit, the larger one: the clearance and the piston's radius, by which corners may then
  !> penetrate the wall, and 1 rad.
  pure real(dp) function reached(self, tilting)
    class(skirt_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    reached = max(abs(tilting%offset)/(self%clearance + self%radius), abs(tilting%tilt))
  end function reached
end module piston_skirt
