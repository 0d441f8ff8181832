!> The eccentricity of the pin: the scenes' coordinates (q, e) against (q, A, x), with the pin in films of 20 and 40 um.
module test_coordinates
  use kinds, only: dp
  use checks, only: checks_t
  use coordinate_errors, only: eccentricity_error, own_coordinates, absolute_by_size, absolute_by_clearance
  implicit none
  private
  public :: run_test_coordinates

contains

  subroutine run_test_coordinates(check)
    class(checks_t), intent(inout) :: check
    integer :: i
    real(dp) :: error(3)
    integer :: evaluations(3)
    character(len=6) :: label
    do i = 4, 6
      write (label, '(a,i0)') '1e-', i
      call eccentricity_error('cases/sim_II.nml', 0.5_dp, own_coordinates, 10.0_dp**(-i), error(1), evaluations(1))
      call eccentricity_error('cases/sim_II.nml', 0.5_dp, absolute_by_size, 10.0_dp**(-i), error(2), evaluations(2))
      call eccentricity_error('cases/sim_II.nml', 0.5_dp, absolute_by_clearance, 10.0_dp**(-i), error(3), evaluations(3))
      call check%that(error(1) <= 10.0_dp**(-i), 'error of the eccentricity in (q, e) at '//label)
      call check%that(error(2) > 1000*error(1), 'error in (q, A, x) is a thousand times larger at '//label)
      call check%that(error(2) > 50*10.0_dp**(-i), 'error in (q, A, x) is far above the tolerance at '//label)
      call check%that(error(3) < 100*error(1), 'tolerances from the clearance reduce the error in (q, A, x) at '//label)
      call check%that(evaluations(1) < evaluations(3), 'tolerances from the clearance need more evaluations at '//label)
    end do
  end subroutine run_test_coordinates
end module test_coordinates
