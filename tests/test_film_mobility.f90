!> The inverse of the force of a film: the velocity that a force drives.
module test_film_mobility
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use film_law, only: film_law_t, film_motion_t
  use film_mobility, only: driven_velocity
  use laws, only: film_law_of
  implicit none
  private
  public :: run_test_film_mobility

  real(dp), parameter :: c = 20e-6_dp

contains

  subroutine run_test_film_mobility(check)
    class(checks_t), intent(inout) :: check
    call inverse_of_the_force(check)
    call centred_film(check)
  end subroutine run_test_film_mobility

  !> The force at the velocity that is found is opposite to the load and equal in size, for every film, position and direction.
  subroutine inverse_of_the_force(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: keys(6) = [character(len=100) :: "variant='closed_form'", "variant='half_film'", &
      "law='finite_bearing' variant='short'", "law='finite_bearing' table_points=33 film_points=32", &
      "law='finite_bearing' table_points=33 film_points=32 cavitation='gumbel'", &
      "law='finite_bearing' table_points=33 film_points=32 cavitation='none'"]
    real(dp), parameter :: ratios(6) = [1e-12_dp, 0.05_dp, 0.5_dp, 0.9_dp, 0.99_dp, 0.999_dp]
    class(film_law_t), allocatable :: film
    type(error_t), allocatable :: error
    type(film_motion_t) :: motion
    real(dp) :: load(2), velocity(2), force(2), moment, worst
    integer :: i, j, k
    do i = 1, size(keys)
      call film_law_of('viscosity=0.0117 '//trim(keys(i)), 1e-6_dp, film, error)
      call check%that(.not. allocated(error), 'a film of '//keys(i))
      if (allocated(error)) cycle
      call check%that(film%is_quasi_static(), 'a film between elastic walls is quasi-static')
      do j = 1, size(ratios)
        worst = 0
        do k = 0, 24
          motion%eccentricity = ratios(j)*c*[cos(2.2_dp), sin(2.2_dp)]
          load = 1e3_dp*[cos(2.2_dp + 0.26179938779914941_dp*k), sin(2.2_dp + 0.26179938779914941_dp*k)]
          call driven_velocity(film, motion%eccentricity, load, velocity)
          motion%eccentricity_rate = velocity
          motion%pin_speed = 0
          motion%turning_speed = 0
          call film%film_force(motion, force, moment)
          worst = max(worst, norm2(force + load)/norm2(load))
          call check%that(dot_product(velocity, load) >= 0, 'the pin moves in the direction of the load')
        end do
        call check%close_to(worst, 0.0_dp, merge(1e-7_dp, 1e-9_dp, ratios(j) > 0.99_dp), &
          'the force is opposite to the load: '//keys(i))
      end do
    end do
    call film_law_of("viscosity=0.0117 variant='as_printed'", 1e-6_dp, film, error)
    call check%that(.not. film%is_quasi_static(), 'the misprinted film is not quasi-static')
    call driven_velocity(film, [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], velocity)
    call check%that(all(abs(velocity) <= 0), 'no load, no velocity')
  end subroutine inverse_of_the_force

  !> The load is carried by half of Sommerfeld's long centred film, 12 pi mu L R^3/c^3.
  subroutine centred_film(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(error_t), allocatable :: error
    real(dp) :: velocity(2)
    call film_law_of("viscosity=0.0117 variant='half_film'", 1e-6_dp, film, error)
    call driven_velocity(film, [0.0_dp, 0.0_dp], [300.0_dp, -400.0_dp], velocity)
    call check%relative(norm2(velocity), 500/(6*acos(-1.0_dp)*0.0117_dp*15e-3_dp*(10e-3_dp - c)**3/c**3), 1e-12_dp, &
      'velocity of a centred film')
    call check%relative(velocity(1)/velocity(2), -0.75_dp, 1e-12_dp, 'velocity of a centred film is in the direction of the load')
  end subroutine centred_film
end module test_film_mobility
