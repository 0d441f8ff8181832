!> The geometry of the journal bearing of a joint with clearance, for contact, friction and film laws.
module bearing_size
  use kinds, only: dp
  implicit none
  private
  public :: bearing_t, crossing_speed

  type :: bearing_t
    real(dp) :: radius = 0       !! of the bore, R_b [m]
    real(dp) :: length = 0       !! axial length of the bearing [m]; 0 if it is not given
    real(dp) :: clearance = 0    !! radial, c = R_b - R_j [m]
    real(dp) :: rod_length = 0   !! length of the rod that carries the pin [m]
  contains
    procedure :: pin_radius
  end type bearing_t

contains

  !> Radius of the pin, R_j [m].
  pure real(dp) function pin_radius(self)
    class(bearing_t), intent(in) :: self
    pin_radius = self%radius - self%clearance
  end function pin_radius

  !> Speed that crosses a clearance in the time simulated, at most 1 m/s [m/s].
  pure real(dp) function crossing_speed(clearance, span)
    real(dp), intent(in) :: clearance, span   !! [m], [s]
    crossing_speed = min(clearance/span, 1.0_dp)
  end function crossing_speed
end module bearing_size
