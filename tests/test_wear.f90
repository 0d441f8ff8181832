!> Wear: how load paths are spread over a surface; pressures along arcs of contact against their resultant.
module test_wear
  use kinds, only: dp
  use constants, only: pi, two_pi
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use archard_wear, only: worn_surface_t
  use contact_geometry, only: contact_geometry_t
  use conformal, only: conformal_t
  use winkler, only: winkler_t
  use johnson, only: johnson_t
  use hertz_sphere, only: hertz_sphere_t
  use asperities, only: asperities_t
  implicit none
  private
  public :: run_test_wear

  type(bearing_t), parameter :: bearing = bearing_t(10e-3_dp, 15e-3_dp, 1e-4_dp, 0.2_dp)

contains

  subroutine run_test_wear(check)
    class(checks_t), intent(inout) :: check
    call spreads_over_bins(check)
    call pressures_carry_the_load(check)
    call asperities_carry_the_load(check)
  end subroutine run_test_wear

  !> The sum is kept, each bin gets its share, and angles of any turn are those of one turn.
  subroutine spreads_over_bins(check)
    class(checks_t), intent(inout) :: check
    type(worn_surface_t) :: surface
    integer :: i
    call surface%prepare(8)
    call surface%add(-0.25_dp*pi, 0.125_dp*pi, 3.0_dp)
    call check%close_to(maxval(abs(surface%load_path - [1, 0, 0, 0, 0, 0, 0, 2])), 0.0_dp, 1e-14_dp, 'an arc across zero')
    call surface%prepare(8)
    call surface%add(6.625_dp*pi, 6.5_dp*pi, 2.0_dp)
    call check%close_to(maxval(abs(surface%load_path - [0, 0, 2, 0, 0, 0, 0, 0])), 0.0_dp, 1e-13_dp, 'an arc of another turn')
    call surface%add(0.3_dp, 0.3_dp, 5.0_dp)
    call check%close_to(surface%load_path(1), 5.0_dp, 0.0_dp, 'a point')
    call surface%prepare(360)
    do i = 1, 1000
      call surface%add(0.37_dp*i, 0.37_dp*i + 6.2_dp*modulo(i*0.618_dp, 1.0_dp), 1.0_dp)
    end do
    call check%relative(sum(surface%load_path), 1000.0_dp, 1e-13_dp, 'the sum of many arcs')
    call check%that(all(surface%load_path > 0), 'many arcs reach every bin')
    call surface%prepare(4)
    call surface%add(0.1_dp, 0.1_dp + two_pi, 4.0_dp)
    call check%close_to(maxval(abs(surface%load_path - 1)), 0.0_dp, 1e-14_dp, 'a whole turn')
  end subroutine spreads_over_bins

  !> The pressures of an arc, projected on the line of centres, make up the normal force, and are largest in its middle. Spheres and
  !> cylinders of Johnson touch along a line.
  subroutine pressures_carry_the_load(check)
    class(checks_t), intent(inout) :: check
    type(conformal_t) :: bore
    type(winkler_t) :: liner
    type(johnson_t) :: cylinder
    type(hertz_sphere_t) :: sphere
    real(dp) :: a
    integer :: i
    bore%compliance = 0.386294_dp
    bore%youngs_modulus = 207e9_dp
    bore%poissons_ratio = 0.3_dp
    call bore%prepare(bearing)
    liner%given_modulus = 1e13_dp
    call liner%prepare(bearing)
    do i = 1, 8
      a = 0.18_dp*i
      call check%relative(integral_over_arc(bore, a, .true.), 1.0_dp, 1e-9_dp, 'pressure of a conformal contact')
      call check%relative(integral_over_arc(liner, a, .true.), 1.0_dp, 1e-9_dp, 'pressure of a liner')
      call check%that(bore%pressure(a, 0.0_dp) > bore%pressure(a, 0.5_dp*a), 'the pressure falls along the arc')
    end do
    do i = 0, 20
      a = 1.45_dp*0.4_dp**i
      call check%relative(bore%total_pressure(a), integral_over_arc(bore, a, .false.), 1e-12_dp, 'total pressure, conformal')
      call check%relative(liner%total_pressure(a), integral_over_arc(liner, a, .false.), 1e-12_dp, 'total pressure, liner')
    end do
    call check%relative(liner%half_angle(1e-4_dp), pi/3, 1e-14_dp, 'half-angle of a liner')
    call check%close_to(cylinder%half_angle(1e-6_dp) + sphere%half_angle(1e-6_dp), 0.0_dp, 0.0_dp, 'half-angles of lines')
  end subroutine pressures_carry_the_load

  !> Int p dtheta over the arc by the midpoint rule in s with theta = a sin s, or `along` the line of centres Int p cos theta
  !> dtheta.
  real(dp) function integral_over_arc(geometry, a, along) result(total)
    class(contact_geometry_t), intent(in) :: geometry
    real(dp), intent(in) :: a
    logical, intent(in) :: along
    integer, parameter :: n = 4000
    real(dp) :: s
    integer :: i
    total = 0
    do i = 1, n
      s = pi*((i - 0.5_dp)/n - 0.5_dp)
      total = total + geometry%pressure(a, a*sin(s))*merge(cos(a*sin(s)), 1.0_dp, along)*a*cos(s)*pi/n
    end do
  end function integral_over_arc

  subroutine asperities_carry_the_load(check)
    class(checks_t), intent(inout) :: check
    type(asperities_t) :: rough
    real(dp) :: distance, total, step
    integer :: i, k
    integer, parameter :: n = 20000
    rough%integral = 'exact'
    rough%roughness = 0.4e-6_dp
    rough%density_product = 0.05_dp
    rough%sharpness = 1e-2_dp
    rough%youngs_modulus = 207e9_dp
    rough%poissons_ratio = 0.3_dp
    call rough%prepare(bearing)
    do k = 1, 3
      distance = bearing%clearance - (3 - 2*k)*rough%roughness
      step = rough%half_angle(distance)/n
      total = 0
      do i = 1, n
        total = total + 2*step*rough%pressure(distance, (i - 0.5_dp)*step)*cos((i - 0.5_dp)*step)
      end do
      call check%relative(rough%force(distance), total, 1e-5_dp, 'pressure of asperities')
    end do
    call check%close_to(rough%half_angle(0.9_dp*bearing%clearance), 0.0_dp, 0.0_dp, 'no arc where asperities do not touch')
  end subroutine asperities_carry_the_load
end module test_wear
