!> The moment of a long film on its pin: against the shear stress integrated over the pin, its derivatives, its power, and the key
!> that requests it.
module test_film_moment
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t
  use checks, only: checks_t
  use film_law, only: film_law_t, film_motion_t, difference_derivatives
  use pinkus_sternlicht, only: pinkus_sternlicht_t
  use laws, only: film_law_of
  implicit none
  private
  public :: run_test_film_moment

  real(dp), parameter :: c = 20e-6_dp, radius = 10e-3_dp - c, length = 15e-3_dp, viscosity = 0.0117_dp   !! of `laws`

contains

  subroutine run_test_film_moment(check)
    class(checks_t), intent(inout) :: check
    call moment_is_the_shear(check)
    call derivatives(check)
    call power_is_lost(check)
    call key_has_a_default_by_law(check)
  end subroutine run_test_film_moment

  !> Integral over the pin of R times the stress -(mu U/h + h p'/2), p' = dp/(R dtheta), of the flow u = U y/h + y (y - h) p'/(2
  !> mu), with the pressure of the law by finite differences.
  subroutine moment_is_the_shear(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 40000
    class(film_law_t), allocatable :: law
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment, sum, theta, step, h, slope
    integer :: i, k
    call new_film(check, "variant='half_film' film_moment=.true.", law)
    step = 2*pi/points
    do k = 1, 8
      motion = random_motion(k)
      call law%film_force(motion, force, moment)
      sum = 0
      select type (law)
      class is (pinkus_sternlicht_t)
        do i = 1, points
          theta = i*step
          h = c - norm2(motion%eccentricity)*cos(theta)
          slope = (law%pressure(motion, theta + 0.5_dp*step) - law%pressure(motion, theta - 0.5_dp*step))/(step*radius)
          sum = sum - (viscosity*radius*motion%turning_speed/h + 0.5_dp*h*slope)
        end do
      end select
      call check%relative(moment, sum*step*radius**2*length, 1e-5_dp, 'the moment is that of the shear on the pin')
    end do
  end subroutine moment_is_the_shear

  !> The derivatives in closed form against finite differences.
  subroutine derivatives(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: law
    real(dp) :: closed(3, 5), differences(3, 5), bound
    integer :: k, i
    call new_film(check, 'film_moment=.true.', law)
    do k = 1, 20
      call law%force_derivatives(random_motion(k), closed)
      call difference_derivatives(law, random_motion(k), differences)
      do i = 1, 5
        bound = 1e-4_dp*abs(differences(3, i)) + 1e-8_dp*c*maxval(abs(closed(:, i)))
        call check%that(abs(closed(3, i) - differences(3, i)) <= bound, 'derivatives of the moment')
      end do
    end do
  end subroutine derivatives

  !> A half film dissipates energy in every motion if its shear acts; without the shear it supplies energy in many motions.
  subroutine power_is_lost(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: law
    type(film_motion_t) :: motion
    real(dp) :: force(2), moment
    integer :: k, gains, gains_without
    gains = 0
    gains_without = 0
    call new_film(check, "variant='half_film' film_moment=.true.", law)
    do k = 1, 200
      motion = random_motion(k)
      call law%film_force(motion, force, moment)
      if (dot_product(force, motion%eccentricity_rate) + moment*motion%turning_speed > 0) gains = gains + 1
      if (dot_product(force, motion%eccentricity_rate) > 0) gains_without = gains_without + 1
    end do
    call check%that(gains == 0, 'a film with shear always dissipates energy')
    call check%that(gains_without > 20, 'a film without shear may supply energy')
  end subroutine power_is_lost

  !> The default is .true. for finite_bearing and .false. for pinkus_sternlicht; a value in the case holds for both.
  subroutine key_has_a_default_by_law(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: law
    call new_film(check, '', law)
    call check%that(.not. law%film_moment, 'a long film acts by its pressure only')
    call new_film(check, "variant='half_film'", law)
    call check%that(.not. law%film_moment, 'a long film acts by its pressure only in every variant')
    call new_film(check, "law='finite_bearing' variant='short'", law)
    call check%that(law%film_moment, 'the shear of a film of finite length acts')
    call new_film(check, "law='finite_bearing' variant='short' film_moment=.false.", law)
    call check%that(.not. law%film_moment, 'the case can switch off the shear of a film of finite length')
    call new_film(check, 'film_moment=.true.', law)
    call check%that(law%film_moment, 'the case can switch on the shear of a long film')
  end subroutine key_has_a_default_by_law

  subroutine new_film(check, keys, law)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: keys
    class(film_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable :: error
    call film_law_of(keys//' viscosity=0.0117', 1e-6_dp, law, error)
    call check%that(.not. allocated(error), 'a film')
  end subroutine new_film

  !> Eccentricity ratios up to 0.93, rates of half a mm/s, rotation of the pin in both directions.
  pure function random_motion(k) result(motion)
    integer, intent(in) :: k
    type(film_motion_t) :: motion
    motion%eccentricity = c*(0.03_dp + modulo(0.618_dp*k, 0.9_dp))*[cos(0.37_dp*k), sin(0.37_dp*k)]
    motion%eccentricity_rate = 5e-4_dp*[cos(1.31_dp*k), sin(1.31_dp*k)]
    motion%pin_speed = 180*cos(2.1_dp*k)
    motion%turning_speed = motion%pin_speed
  end function random_motion
end module test_film_moment
