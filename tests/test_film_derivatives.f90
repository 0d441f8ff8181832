!> The derivatives of films for implicit integration: those of the table of a film of finite length against central differences of
!> its force.
module test_film_derivatives
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use film_law, only: film_law_t, film_motion_t, difference_derivatives
  use laws, only: film_law_of
  implicit none
  private
  public :: run_test_film_derivatives

  real(dp), parameter :: c = 20e-6_dp   !! [m]

contains

  subroutine run_test_film_derivatives(check)
    class(checks_t), intent(inout) :: check
    call derivatives_of_tables(check, 'reynolds')
    call derivatives_of_tables(check, 'gumbel')
    call derivatives_of_tables(check, 'none')
  end subroutine run_test_film_derivatives

  !> Motions from near the centre to beyond the last row of the table, approaching and leaving, with the pin rotating in both
  !> directions, with the moment; and motions in which one of the two velocities is 0.
  subroutine derivatives_of_tables(check, cavitation)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: cavitation
    real(dp), parameter :: gaps(6) = [0.9_dp, 0.7_dp, 0.1_dp, 1e-2_dp, 3e-4_dp, 2e-5_dp]
    class(film_law_t), allocatable :: law
    type(film_motion_t) :: motion
    integer :: i, j
    call new_film(check, cavitation, law)
    do i = 1, size(gaps)
      do j = 1, 12
        motion%eccentricity = c*(1 - gaps(i))*[cos(0.9_dp*j), sin(0.9_dp*j)]
        motion%eccentricity_rate = 5e-3_dp*[cos(2.3_dp*j), sin(2.3_dp*j)]
        motion%pin_speed = 180*cos(2.1_dp*j)
        motion%turning_speed = 150*cos(2.0_dp*j)
        call compare(check, law, motion, cavitation)
      end do
      motion%pin_speed = 0
      motion%eccentricity_rate = -4e-3_dp*motion%eccentricity/c
      call compare(check, law, motion, cavitation//', leaving radially')
      motion%eccentricity_rate = 4e-3_dp*motion%eccentricity/c
      call compare(check, law, motion, cavitation//', approaching radially')
    end do
  end subroutine derivatives_of_tables

  subroutine compare(check, law, motion, what)
    class(checks_t), intent(inout) :: check
    class(film_law_t), intent(in) :: law
    type(film_motion_t), intent(in) :: motion
    character(len=*), intent(in) :: what
    real(dp) :: exact(3, 5), differences(3, 5), force(2), moment, gap, size_of(3), speed
    integer :: i
    call law%force_derivatives(motion, exact)
    call difference_derivatives(law, motion, differences)
    call law%film_force(motion, force, moment)
    gap = 1 - norm2(motion%eccentricity)/c
    speed = norm2(motion%eccentricity_rate) + c*abs(motion%pin_speed)
    do i = 1, 5   ! finite differences of the force lose digits
      size_of = 1e-6_dp*[norm2(force), norm2(force), abs(moment) + c*norm2(force)]
      if (i <= 2) size_of = size_of/(gap*c)
      if (i == 3 .or. i == 4) size_of = size_of/(gap*speed)
      if (i == 5) size_of = size_of*c/(gap*speed)
      call check%that(all(abs(exact(:, i) - differences(:, i)) <= size_of + 1e-5_dp*maxval(abs(exact(:, i)))), &
        'derivatives of the table, '//what)
    end do
  end subroutine compare

  subroutine new_film(check, cavitation, law)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: cavitation
    class(film_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable :: error
    call film_law_of("law='finite_bearing' viscosity=0.0117 table_points=17 film_points=32 cavitation='"//cavitation//"'", &
      1e-4_dp, law, error)
    call check%that(.not. allocated(error), 'a film of finite length')
  end subroutine new_film
end module test_film_derivatives
