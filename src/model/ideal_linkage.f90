!> The lengths of crank and rod and the place of the cylinder axis, from which strokes, dead centres and positions of an ideal
!> mechanism follow.
!>
!>     top: q_t = asin(d/(L + R)), x_t = (L + R) cos q_t;    bottom: q_b = pi + asin(d/(L - R)), x_b = -(L - R) cos q_b
module ideal_linkage
  use kinds, only: dp
  use constants, only: pi
  implicit none
  private
  public :: linkage_t

  type :: linkage_t
    real(dp) :: crank_length         !! R [m]
    real(dp) :: rod_length           !! L [m], > R
    real(dp) :: axis_offset = 0      !! d: the cylinder axis is the line y = d, the crank axis x = y = 0; |d| < L - R [m]
  contains
    procedure :: top_angle
    procedure :: bottom_angle
    procedure :: stroke
    procedure :: piston_position
  end type linkage_t

contains

  !> Crank angle q_t at which the piston is highest [rad].
  pure real(dp) function top_angle(self)
    class(linkage_t), intent(in) :: self
    top_angle = asin(self%axis_offset/(self%rod_length + self%crank_length))
  end function top_angle

  !> Crank angle q_b at which the piston is lowest [rad].
  pure real(dp) function bottom_angle(self)
    class(linkage_t), intent(in) :: self
    bottom_angle = pi + asin(self%axis_offset/(self%rod_length - self%crank_length))
  end function bottom_angle

  !> x_t - x_b, without cancellation [m].
  pure real(dp) function stroke(self)
    class(linkage_t), intent(in) :: self
    associate (r => self%crank_length, l => self%rod_length)
      stroke = 2*r - 2*((l + r)*sin(0.5_dp*self%top_angle())**2 - (l - r)*sin(0.5_dp*(self%bottom_angle() - pi))**2)
    end associate
  end function stroke

  !> Height of the piston pin above the crank axis at a crank angle q [rad], x [m].
  pure real(dp) function piston_position(self, q)
    class(linkage_t), intent(in) :: self
    real(dp), intent(in) :: q
    real(dp) :: across
    across = self%crank_length*sin(q) - self%axis_offset
    piston_position = self%crank_length*cos(q) + sqrt((self%rod_length - across)*(self%rod_length + across))
  end function piston_position
end module ideal_linkage
