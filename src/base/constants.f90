!> Mathematical constants and unit factors.
module constants
  use kinds, only: dp
  implicit none
  private
  public :: pi, two_pi, degree

  real(dp), parameter :: pi = 3.141592653589793238462643383279502884_dp
  real(dp), parameter :: two_pi = 2*pi
  real(dp), parameter :: degree = pi/180   !! one degree in radians
end module constants
