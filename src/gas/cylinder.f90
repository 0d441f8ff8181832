!> The cylinder volume as a function of the crank angle (Reis 2013, A.10-A.11, the second corrected).
module cylinder
  use kinds, only: dp
  use constants, only: pi
  implicit none
  private
  public :: cylinder_t, new_cylinder

  !> A cylinder with the kinematics of the mechanism with ideal joints: the volume depends on the crank angle alone.
  type :: cylinder_t
    real(dp) :: area = 0          !! pi b^2/4 [m^2]
    real(dp) :: displacement = 0  !! V_d = 2 R pi b^2/4 [m^3]
    real(dp) :: dead_volume = 0   !! V_d/(r - 1) [m^3]
    real(dp) :: rod_ratio = 0     !! L/R [-]
  contains
    procedure :: volume
    procedure :: volume_at
    procedure :: volume_slope
    procedure :: volume_curvature
  end type cylinder_t

contains

  pure type(cylinder_t) function new_cylinder(bore, crank_length, rod_length, compression_ratio) result(cylinder)
    real(dp), intent(in) :: bore               !! b [m]
    real(dp), intent(in) :: crank_length       !! R [m]
    real(dp), intent(in) :: rod_length         !! L [m], > R
    real(dp), intent(in) :: compression_ratio  !! r > 1 [-]
    cylinder%area = pi*bore**2/4
    cylinder%displacement = 2*crank_length*cylinder%area
    cylinder%dead_volume = cylinder%displacement/(compression_ratio - 1)
    cylinder%rod_ratio = rod_length/crank_length
  end function new_cylinder

  !> V(q) [m^3], q in rad from a top dead centre.
  pure real(dp) function volume(self, q)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: q
    volume = self%volume_at(sin(q), cos(q))
  end function volume

  !> V for known sine and cosine of q; with r = L/R, 1 - cos q and r - sqrt(r^2 - sin^2 q) are written without cancellation.
  pure real(dp) function volume_at(self, s, c)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: s, c   !! sin q, cos q
    real(dp) :: drop
    drop = 1 - c
    if (c > 0) drop = s**2/(1 + c)
    volume_at = self%dead_volume + 0.5_dp*self%displacement*(drop + s**2/(self%rod_ratio + root(self, s)))
  end function volume_at

  !> dV/dq [m^3/rad] (A.11, corrected).
  pure real(dp) function volume_slope(self, q)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: q
    real(dp) :: s
    s = sin(q)
    volume_slope = 0.5_dp*self%displacement*s*(1 + cos(q)/root(self, s))
  end function volume_slope

  !> d2V/dq2 [m^3/rad^2].
  pure real(dp) function volume_curvature(self, q)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: q
    real(dp) :: s, c, w
    s = sin(q)
    c = cos(q)
    w = root(self, s)
    volume_curvature = 0.5_dp*self%displacement*(c + ((c - s)*(c + s) + (s*c/w)**2)/w)
  end function volume_curvature

  !> sqrt((L/R)^2 - sin^2 q).
  pure real(dp) function root(self, s)
    class(cylinder_t), intent(in) :: self
    real(dp), intent(in) :: s
    root = sqrt((self%rod_ratio - s)*(self%rod_ratio + s))
  end function root
end module cylinder
