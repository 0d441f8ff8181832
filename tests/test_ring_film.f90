!> The film between a piston ring and its bore: closed forms of a parabolic face, the film at which a ring settles, mirror image, a
!> ring whose asperities carry more than its load.
module test_ring_film
  use kinds, only: dp
  use checks, only: checks_t
  use ring_film, only: ring_face_t, ring_loads_t
  implicit none
  private
  public :: run_test_ring_film

  real(dp), parameter :: half = 1e-3_dp, mu = 0.01_dp, film = 2e-6_dp, speed = 7   !! L [m], [Pa s], h [m], [m/s]
  real(dp), parameter :: no_gas(2) = 0
  !> Of a parabolic face with crowns of so many films, by integrals in closed form with Reynolds' condition: load over
  !> 6 mu U L^2/h^2, friction of a full face over mu U L/h, load of a squeeze at the speed V over 12 mu V L^3/h^3.
  real(dp), parameter :: crown(4) = [0.1_dp, 1.0_dp, 5.0_dp, 10.0_dp], &
    load(4) = [0.0120001325295_dp, 0.0421218110261_dp, 0.0265285719526_dp, 0.0162521081081_dp], &
    friction(4) = [1.93992889562_dp, 1.66463978413_dp, 1.26533435766_dp, 1.04465722465_dp], &
    squeeze(4) = [0.56183107362_dp, 0.196349540849_dp, 0.0312761956051_dp, 0.0118564042586_dp]

contains

  subroutine run_test_ring_film(check)
    class(checks_t), intent(inout) :: check
    call faces_in_closed_form(check)
    call a_ring_settles(check)
    call mirror_image(check)
    call a_pressed_ring_leaves(check)
  end subroutine run_test_ring_film

  !> A face with a crown of so many films.
  type(ring_face_t) function face(crowns, roughness, intervals)
    real(dp), intent(in) :: crowns, roughness   !! [-], [m]
    integer, intent(in) :: intervals
    face%height = 2*half
    face%crown = crowns*film
    face%viscosity = mu
    face%intervals = intervals
    associate (rough => face%asperities)
      rough%roughness = roughness
      rough%density_product = 0.05_dp
      rough%sharpness = 0.01_dp
      rough%integral = 'exact'
      rough%youngs_modulus = 1e11_dp
      rough%poissons_ratio = 0.3_dp
      rough%coefficient = 0.1_dp
      rough%transition_speed = 0.01_dp
    end associate
    call face%prepare()
  end function face

  !> Under the load of the closed form a ring stays where it is, in both directions, and has the friction of the closed form. The
  !> error of the load is the speed at which the ring is squeezed over the one at which its whole load would squeeze it. Errors fall
  !> with the square of the intervals: of the load of a face that is nearly cut by its edges (crown 10) 0.6 % with 20, that is 1e-4
  !> with 160.
  subroutine faces_in_closed_form(check)
    class(checks_t), intent(inout) :: check
    type(ring_face_t) :: ring
    type(ring_loads_t) :: loads
    real(dp) :: at_load, sinking
    integer :: i, way
    do i = 1, size(crown)
      at_load = 6*mu*speed*half**2/film**2*load(i)
      sinking = at_load/(12*mu*half**3/film**3*squeeze(i))
      ring = face(crown(i), 1e-12_dp, 160)
      do way = -1, 1, 2
        call ring%find_loads(film, way*speed, at_load, no_gas, loads)
        call check%close_to(loads%rate/sinking, 0.0_dp, 3e-4_dp, 'ring with a film: its load')
        call check%close_to(-way*loads%friction/(mu*speed*half/film), friction(i), 1e-5_dp*friction(i), &
          'ring with a film: its friction')
      end do
      call ring%find_loads(film, 0.0_dp, at_load, no_gas, loads)
      call check%close_to(-loads%rate/sinking, 1.0_dp, 3e-5_dp, 'ring with a film: its squeeze')
    end do
  end subroutine faces_in_closed_form

  !> A ring that starts far from the wall and moves at a constant speed settles at the film that carries its load, within half of
  !> the error of the load.
  subroutine a_ring_settles(check)
    class(checks_t), intent(inout) :: check
    type(ring_face_t) :: ring
    type(ring_loads_t) :: loads
    real(dp) :: gap, at_load, step
    integer :: i
    ring = face(crown(3), 1e-12_dp, 80)
    at_load = 6*mu*speed*half**2/film**2*load(3)
    step = 0.05_dp*film/(at_load/(12*mu*half**3/film**3*squeeze(3)))
    gap = 3*film
    do i = 1, 2000
      call ring%find_loads(gap, speed, at_load, no_gas, loads)
      gap = gap + step*loads%rate
    end do
    call check%close_to(loads%rate*step/film, 0.0_dp, 1e-10_dp, 'ring with a film: it is at rest')
    call check%close_to(gap/film, 1.0_dp, 5e-4_dp, 'ring with a film: where it settles')
  end subroutine a_ring_settles

  !> The mirror image of a rough ring, whose crown, gas and speed are reversed.
  subroutine mirror_image(check)
    class(checks_t), intent(inout) :: check
    type(ring_face_t) :: ring, other
    type(ring_loads_t) :: loads, mirrored
    real(dp), parameter :: gas(2) = [1e5_dp, 2e6_dp], at_load = 2e3_dp
    ring = face(3.0_dp, 0.5e-6_dp, 20)
    other = face(3.0_dp, 0.5e-6_dp, 20)
    ring%crown_offset = 0.2_dp*half
    other%crown_offset = -0.2_dp*half
    call again(ring)
    call again(other)
    call ring%find_loads(0.6e-6_dp, speed, at_load, gas, loads)
    call other%find_loads(0.6e-6_dp, -speed, at_load, gas([2, 1]), mirrored)
    call check%close_to(mirrored%rate, loads%rate, 1e-11_dp*abs(loads%rate), 'ring with a film: rate of its mirror image')
    call check%close_to(mirrored%friction, -loads%friction, 1e-11_dp*abs(loads%friction), &
      'ring with a film: friction of its mirror image')
    call check%close_to(mirrored%asperities, loads%asperities, 1e-11_dp*loads%asperities, &
      'ring with a film: asperities of its mirror image')
    call other%find_loads(0.6e-6_dp, -speed, at_load, gas, mirrored)
    call check%that(abs(mirrored%rate - loads%rate) > 1e-3_dp*abs(loads%rate), 'ring with a film: the side of the gas counts')

  contains

    subroutine again(one)
      type(ring_face_t), intent(inout) :: one
      type(ring_face_t) :: fresh
      fresh%height = one%height
      fresh%crown = one%crown
      fresh%crown_offset = one%crown_offset
      fresh%viscosity = one%viscosity
      fresh%intervals = one%intervals
      fresh%asperities = one%asperities
      call fresh%prepare()
      one = fresh
    end subroutine again
  end subroutine mirror_image

  !> A film cannot pull: where asperities carry more than the load, no pressure is left, and the ring leaves the wall faster the
  !> more they carry; where they carry less it is squeezed.
  subroutine a_pressed_ring_leaves(check)
    class(checks_t), intent(inout) :: check
    type(ring_face_t) :: ring
    type(ring_loads_t) :: loads
    real(dp) :: by_load(3)
    integer :: i
    ring = face(3.0_dp, 0.5e-6_dp, 20)
    call ring%find_loads(0.3e-6_dp, 0.0_dp, 1.0_dp, no_gas, loads)
    do i = 1, 3
      call ring%find_loads(0.3e-6_dp, 0.0_dp, 0.5_dp*i*loads%asperities, no_gas, loads)
      by_load(i) = loads%rate
    end do
    call check%that(by_load(1) > 0 .and. by_load(3) < 0, 'ring with a film: asperities against its load')
    call check%close_to(by_load(2)/by_load(3), 0.0_dp, 1e-9_dp, 'ring with a film: asperities that carry the load')
    call check%that(by_load(1) > -1e3_dp*by_load(3), 'ring with a film: no suction holds it')
  end subroutine a_pressed_ring_leaves
end module test_ring_film
