!> The cylinder volume as a function of the crank angle (Reis 2013, A.10-A.11, the second corrected), also where the cylinder axis
!> is offset from the crank axis.
!>
!> With q = f + q_t, u = sin q - d/R, w = sqrt((L/R)^2 - u^2) and h = (1 + L/R) cos q_t - 1:
!>
!>     V = V_dead + V_R (1 - cos q + h - w),    V' = V_R (sin q + u cos q/w)
module cylinder
  use kinds, only: dp
  use constants, only: pi
  use ideal_linkage, only: linkage_t
  implicit none
  private
  public :: cylinder_t, new_cylinder

  !> A cylinder with the kinematics of the mechanism with ideal joints: the volume depends on the crank angle alone. All angles of a
  !> gas, f, count from the dead centre at which the volume is smallest.
  type :: cylinder_t
    real(dp) :: area = 0          !! pi b^2/4 [m^2]
    real(dp) :: displacement = 0  !! V_d, the stroke times the area [m^3]
    real(dp) :: dead_volume = 0   !! V_d/(r - 1) [m^3]
    real(dp) :: dead_centre = 0   !! q_t, crank angle at f = 0 [rad]
    real(dp) :: bottom = pi       !! f at the other dead centre [rad]
    real(dp), private :: radius_volume = 0    !! V_R, the crank length times the area [m^3]
    real(dp), private :: rod_ratio = 0        !! L/R [-]
    real(dp), private :: axis_offset = 0      !! d/R [-]
    real(dp), private :: height = 0           !! h; L/R without an offset [-]
    real(dp), private :: rise = 0             !! h^2 - (L/R)^2 [-]
  contains
    procedure :: volume
    procedure :: volume_at
    procedure :: volume_slope
    procedure :: volume_curvature
  end type cylinder_t

contains

  pure type(cylinder_t) function new_cylinder(bore, linkage, compression_ratio) result(cylinder)
    real(dp), intent(in) :: bore               !! b [m]
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: compression_ratio  !! r > 1 [-]
    real(dp) :: drop   ! 1 - cos q_t
    cylinder%area = pi*bore**2/4
    cylinder%displacement = linkage%stroke()*cylinder%area
    cylinder%dead_volume = cylinder%displacement/(compression_ratio - 1)
    cylinder%dead_centre = linkage%top_angle()
    cylinder%bottom = linkage%bottom_angle() - linkage%top_angle()
    cylinder%radius_volume = linkage%crank_length*cylinder%area
    cylinder%rod_ratio = linkage%rod_length/linkage%crank_length
    cylinder%axis_offset = linkage%axis_offset/linkage%crank_length
    drop = 2*sin(0.5_dp*cylinder%dead_centre)**2
    cylinder%height = cylinder%rod_ratio - (1 + cylinder%rod_ratio)*drop
    cylinder%rise = 2*(1 + cylinder%rod_ratio)*drop - cylinder%axis_offset**2
  end function new_cylinder

  !> V [m^3] at an angle f from the dead centre [rad].
  pure real(dp) function volume(self, f)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: f
    real(dp) :: q
    q = f + self%dead_centre
    volume = self%volume_at(sin(q), cos(q))
  end function volume

  !> V for known sine and cosine of the crank angle q; 1 - cos q and h - w are written without cancellation.
  pure real(dp) function volume_at(self, s, c)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: s, c   !! sin q, cos q
    real(dp) :: drop, u
    drop = 1 - c
    if (c > 0) drop = s**2/(1 + c)
    u = s - self%axis_offset
    volume_at = self%dead_volume + self%radius_volume*(drop + (u**2 + self%rise)/(self%height + root(self, u)))
  end function volume_at

  !> dV/df [m^3/rad] (A.11, corrected).
  pure real(dp) function volume_slope(self, f)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: f
    real(dp) :: s, ratio
    s = sin(f + self%dead_centre)
    ratio = cos(f + self%dead_centre)/root(self, s - self%axis_offset)
    volume_slope = self%radius_volume*s*(1 + ratio) - self%radius_volume*self%axis_offset*ratio
  end function volume_slope

  !> d2V/df2 [m^3/rad^2].
  pure real(dp) function volume_curvature(self, f)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: f
    real(dp) :: s, c, u, w
    s = sin(f + self%dead_centre)
    c = cos(f + self%dead_centre)
    u = s - self%axis_offset
    w = root(self, u)
    volume_curvature = self%radius_volume*(c + ((c - s)*(c + s) + self%axis_offset*s + (u*c/w)**2)/w)
  end function volume_curvature

  !> w = sqrt((L/R)^2 - u^2).
  pure real(dp) function root(self, u)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: u
    root = sqrt((self%rod_ratio - u)*(self%rod_ratio + u))
  end function root
end module cylinder
