!> Mathematical constants, unit factors, and the points of a rule of integration.
module constants
  use kinds, only: dp
  implicit none
  private
  public :: pi, two_pi, degree, gauss_points, gauss_weights

  real(dp), parameter :: pi = 3.141592653589793238462643383279502884_dp
  real(dp), parameter :: two_pi = 2*pi
  real(dp), parameter :: degree = pi/180   !! one degree in radians

  !> Gauss's rule of three points, from 0 to 1.
  real(dp), parameter :: gauss_points(3) = 0.5_dp + sqrt(0.15_dp)*[-1, 0, 1], gauss_weights(3) = [5, 8, 5]/18.0_dp
end module constants
