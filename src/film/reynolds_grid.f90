!> Finite volumes for Reynolds' equation of a film of finite length, on one grid over half of the film, which is symmetric about its
!> middle plane.
!>
!> With the pressure P = p c^2/(mu V R^2), the angle phi from the thinnest film, zeta = z/R and H = 1 - eps cos phi,
!>
!>     d/dphi(H^3 dP/dphi) + d/dzeta(H^3 dP/dzeta) = -12 cos(phi - alpha),   P = 0 at zeta = L/(2R)
!>
!> (V, alpha: magnitude and direction of the velocity e' - (omega/2) z x e over c, measured from the direction of e.) The nodes are
!> uniform in a variable that resolves all length scales of the film from sqrt((1 - eps)/(1 + eps)) to 1, and dense at the end of
!> the bearing.
module reynolds_grid
  use kinds, only: dp
  use constants, only: pi
  implicit none
  private
  public :: reynolds_grid_t, new_reynolds_grid

  !> Nodes i = 1 .. n around the film, j = 1 .. m from its middle plane (j = 1) to the last ones before the end, where P = 0.
  type :: reynolds_grid_t
    integer :: n = 0, m = 0
    real(dp) :: half_length = 0             !! lambda = L/(2R)
    real(dp), allocatable :: angle(:)       !! phi of the nodes (n) [rad]
    real(dp), allocatable :: sine(:), cosine(:)   !! integrals of cos phi and of sin phi over the cells (n)
    real(dp), allocatable :: height_cubed(:)      !! integral of H^3 over the cells (n)
    real(dp), allocatable :: around(:)      !! conductance from node i to i + 1 around the film, per axial width of the cell (n)
    real(dp), allocatable :: along(:)       !! conductance from node j to j + 1 in axial direction, per integral of H^3 (m)
    real(dp), allocatable :: zeta(:)        !! axial positions of the nodes (m), 0 in the middle plane
    real(dp), allocatable :: width(:)       !! axial widths of the cells (m + 1); the last one, at the end, is a half cell
  end type reynolds_grid_t

  integer, parameter :: n_scales = 5
  real(dp), parameter :: share(n_scales) = [0.3_dp, 0.4_dp/3, 0.4_dp/3, 0.4_dp/3, 0.3_dp]   !! fraction of the nodes for each scale

contains

  !> The grid of n (even, >= 8) times m (>= 2) nodes for a film with the smallest thickness `gap` = 1 - eps (over c, 0 to 1). Its
  !> nodes around the film are shifted by the fraction `shift` (0 to 1) of their distance.
  pure function new_reynolds_grid(n, m, gap, half_length, shift) result(grid)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: gap, half_length, shift
    type(reynolds_grid_t) :: grid
    real(dp) :: faces(0:n), eps, kappa, scales(n_scales), angle, slope, dense, spread, x
    integer :: i, j

    grid%n = n
    grid%m = m
    grid%half_length = half_length
    allocate (grid%angle(n), grid%sine(n), grid%cosine(n), grid%height_cubed(n), grid%around(n), grid%along(m), grid%width(m + 1), &
      grid%zeta(m))
    eps = 1 - gap
    kappa = sqrt(gap/(1 + eps))
    do i = 1, n_scales
      scales(i) = kappa**(0.25_dp*(i - 1))
    end do
    do i = 1, n
      grid%angle(i) = angle_beyond(scales, -pi + 2*pi*(i - 1 + shift)/n)
      faces(i) = angle_beyond(scales, -pi + 2*pi*(i - 0.5_dp + shift)/n)
      slope = sum(share*scales/((scales*cos(0.5_dp*faces(i)))**2 + sin(0.5_dp*faces(i))**2))   ! ds/dphi
      grid%around(i) = height(gap, faces(i))**3*slope*n/(2*pi)
    end do
    faces(0) = faces(n) - 2*pi
    do i = 1, n
      angle = 0.5_dp*(faces(i) + faces(i - 1))
      slope = 0.5_dp*(faces(i) - faces(i - 1))
      grid%sine(i) = 2*cos(angle)*sin(slope)
      grid%cosine(i) = 2*sin(angle)*sin(slope)
      grid%height_cubed(i) = mean_cube(gap, angle, slope)*2*slope
    end do

    dense = max(kappa, 1e-3_dp)*half_length
    if (half_length >= 1) dense = min(half_length, max(kappa, 1e-3_dp))
    spread = asinh(half_length/dense)
    do j = 1, m
      x = (j - 0.5_dp)/m
      grid%along(j) = m/(dense*spread*cosh(spread*(1 - x)))
      grid%zeta(j) = half_length - dense*sinh(spread*(1 - (j - 1.0_dp)/m))
      grid%width(j) = half_length - dense*sinh(spread*(1 - x))
    end do
    grid%width(m + 1) = half_length
    grid%width(2:) = grid%width(2:) - grid%width(:m)
  end function new_reynolds_grid

  !> H at the angle phi, in a form without cancellation where the film is thin.
  pure real(dp) function height(gap, phi)
    real(dp), intent(in) :: gap, phi
    height = gap + 2*(1 - gap)*sin(0.5_dp*phi)**2
  end function height

  !> Mean of H^3 over a cell, by the Gauss-Legendre rule with four points.
  pure real(dp) function mean_cube(gap, middle, half)
    real(dp), intent(in) :: gap, middle, half
    real(dp), parameter :: at(2) = [0.33998104358485626_dp, 0.86113631159405258_dp]
    real(dp), parameter :: weight(2) = [0.65214515486254614_dp, 0.34785484513745386_dp]
    integer :: i
    mean_cube = 0
    do i = 1, 2
      mean_cube = mean_cube + 0.5_dp*weight(i)*(height(gap, middle - at(i)*half)**3 + height(gap, middle + at(i)*half)**3)
    end do
  end function mean_cube

  !> `angle_at` for an argument from -pi to 3 pi.
  pure real(dp) function angle_beyond(scales, s) result(phi)
    real(dp), intent(in) :: scales(n_scales), s
    if (s > pi) then
      phi = angle_at(scales, s - 2*pi) + 2*pi
    else
      phi = angle_at(scales, s)
    end if
  end function angle_beyond

  !> The angle phi at s, between -pi and pi: s is the sum of share times psi, where tan(psi/2) = tan(phi/2)/scale. Newton's method,
  !> safeguarded by bisection.
  pure real(dp) function angle_at(scales, s) result(phi)
    real(dp), intent(in) :: scales(n_scales), s
    real(dp) :: lower, upper, excess, slope, next
    integer :: i
    lower = -pi
    upper = pi
    phi = s
    do i = 1, 200
      excess = sum(share*2*atan2(sin(0.5_dp*phi), scales*cos(0.5_dp*phi))) - s
      slope = sum(share*scales/((scales*cos(0.5_dp*phi))**2 + sin(0.5_dp*phi)**2))
      if (excess > 0) upper = phi
      if (excess <= 0) lower = phi
      next = phi - excess/slope
      if (.not. (next > lower .and. next < upper)) next = 0.5_dp*(lower + upper)
      if (abs(next - phi) <= 4*epsilon(phi)*abs(next) .or. .not. abs(next - phi) > 0) return
      phi = next
    end do
  end function angle_at
end module reynolds_grid
