!> Transition from film to contact over a range of penetrations: weights, and a film that is held at the wall.
module test_film_weights
  use kinds, only: dp
  use error_handling, only: error_t
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use film_transition, only: film_transition_t
  use film_law, only: film_law_t, film_motion_t
  use laws, only: film_law_of
  implicit none
  private
  public :: run_test_film_weights

  real(dp), parameter :: c = 0.2e-3_dp, q = 0.03_dp, depth = 3e-6_dp   !! values of the case

contains

  subroutine run_test_film_weights(check)
    class(checks_t), intent(inout) :: check
    call shares(check)
    call film_is_held(check)
  end subroutine run_test_film_weights

  !> Values and slopes of both shapes; beyond the depth the contact carries the whole load.
  subroutine shares(check)
    class(checks_t), intent(inout) :: check
    type(film_transition_t) :: transition
    real(dp) :: w, slope
    transition = new_transition('linear')
    call transition%weight(0.25_dp*depth, .false., w, slope)
    call check%relative(w, 0.25_dp, 1e-12_dp, 'linear share')
    call check%relative(slope, 1/depth, 1e-12_dp, 'linear slope')
    transition = new_transition('smooth')
    call transition%weight(0.25_dp*depth, .false., w, slope)
    call check%relative(w, 0.15625_dp, 1e-12_dp, 'smooth share')
    call check%relative(slope, 1.125_dp/depth, 1e-12_dp, 'smooth slope')
    call transition%weight(-depth, .false., w, slope)
    call check%that(abs(w) + abs(slope) <= 0, 'the contact has no share without penetration')
    call transition%weight(2*depth, .true., w, slope)
    call check%that(abs(w - 1) + abs(slope) <= 0, 'the contact has the whole share beyond the depth')
  end subroutine shares

  !> Beyond the eccentricity ratio 1 - q the film force is that at 1 - q with the same direction, rate and speeds.
  subroutine film_is_held(check)
    class(checks_t), intent(inout) :: check
    class(film_law_t), allocatable :: film
    type(error_t), allocatable :: error
    type(film_transition_t) :: transition
    type(film_motion_t) :: motion
    real(dp) :: want(2), force(2), moment, want_moment, n(2)
    integer :: i
    call film_law_of("law='finite_bearing' variant='short' viscosity=0.02", 1e-6_dp, film, error)
    call check%that(.not. allocated(error), 'a film')
    call transition%prepare(bearing_t(1e-2_dp, 2e-2_dp, 20e-6_dp, 0.12_dp), q)
    do i = 1, 3
      n = [cos(1.1_dp*i), sin(1.1_dp*i)]
      motion%eccentricity_rate = [3e-3_dp, -2e-3_dp]*i
      motion%pin_speed = 80
      motion%turning_speed = 80
      motion%eccentricity = 0.97_dp*20e-6_dp*n
      call film%film_force(motion, want, want_moment)
      motion%eccentricity = (0.95_dp + 0.03_dp*i)*20e-6_dp*n
      call film%film_force(transition%held_motion(motion, .true.), force, moment)
      call check%close_to(norm2(force - want), 0.0_dp, 1e-11_dp*norm2(want), 'force of a limited film')
      call check%relative(moment, want_moment, 1e-11_dp, 'moment of a limited film')
    end do
    motion%eccentricity = 0.5_dp*20e-6_dp*n
    call film%film_force(motion, want, want_moment)
    call film%film_force(transition%held_motion(motion, .false.), force, moment)
    call check%that(all(abs(force - want) <= 0), 'a film that is not limited is that of the law')
  end subroutine film_is_held

  function new_transition(shape) result(transition)
    character(len=*), intent(in) :: shape
    type(film_transition_t) :: transition
    transition%depth = depth
    transition%shape = shape
    call transition%prepare(bearing_t(1e-2_dp, 2e-2_dp, c, 0.12_dp), q)
  end function new_transition
end module test_film_weights
