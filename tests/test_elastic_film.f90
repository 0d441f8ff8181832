!> A film between elastic walls: derivatives, energy, the limit of stiff walls, all methods, the initial state, the viscosity under
!> pressure, and errors in cases.
module test_elastic_film
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use chain_motion, only: piston_pin
  use scene_problem, only: scene_t, evaluation_t
  use elastic_film, only: elastic_film_t
  use scene_builder, only: build_scene
  use ode_problem, only: difference_jacobian
  use state_making, only: set_crank, set_pin
  use case_checks, only: expect, methods_agree
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_elastic_film

  character(len=*), parameter :: file = 'cases/film/elastic.nml'
  integer, parameter :: long = 60
  character(len=long), parameter :: plain(2) = [character(len=long) :: 'lubrication.law=pinkus_sternlicht', &
    'lubrication.variant=closed_form']
  real(dp), parameter :: c = 20e-6_dp

contains

  subroutine run_test_elastic_film(check)
    class(checks_t), intent(inout) :: check
    call derivatives(check)
    call energy_is_known(check)
    call stiff_walls_are_rigid(check)
    call methods_agree_on_it(check)
    call starts_on_loaded_walls(check)
    call goes_beyond_the_clearance(check)
    call oil_under_pressure(check)
    call refuses(check)
  end subroutine run_test_elastic_film

  !> The closed-form Jacobian against finite differences, with the moment of the film and an oil that thickens under pressure.
  subroutine derivatives(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(6)
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    real(dp), allocatable :: y(:), a_p(:, :), a_v(:, :), d_p(:, :), d_v(:, :)
    integer :: i, j, m, k
    do j = 1, 4
      set(1:2) = plain
      if (j == 2) set(2) = 'lubrication.variant=half_film'
      if (j == 3) set(1:2) = [character(len=long) :: 'lubrication.law=finite_bearing', 'lubrication.variant=short']
      set(3) = 'contact.geometry='//merge('conformal   ', 'hertz_sphere', j < 3)
      set(4) = 'drive.kind='//merge('constant_speed', 'free          ', j == 2)
      set(5) = 'lubrication.pressure_viscosity=2e-8'
      set(6) = 'lubrication.film_moment=T'
      call read_case(file, set, case, error)
      if (.not. allocated(error)) call build_scene(case, .false., scene, error)
      call check%that(.not. allocated(error), 'a scene')
      if (allocated(error)) return
      m = scene%n_positions
      k = m + scene%n_states()
      call check%that(scene%n_states() == 2, 'an elastic film has two states')
      if (allocated(a_p)) deallocate (a_p, a_v, d_p, d_v)
      allocate (a_p(k, m), a_v(k, k), d_p(k, m), d_v(k, k))
      do i = 1, 4
        y = scene%initial_state()
        call set_crank(scene, y, 0.3_dp*i, 250.0_dp)
        call set_pin(scene, y, 0.99_dp*c*[cos(1.3_dp*i), sin(1.3_dp*i)], [0.01_dp, 0.007_dp])
        associate (states => scene%joints(1)%slots(1)%element%states)
          y(states%first:states%last) = 0.9_dp*c*[cos(1.3_dp*i + 0.1_dp), sin(1.3_dp*i + 0.1_dp)]
        end associate
        call scene%jacobian(0.0_dp, y, a_p, a_v)
        call difference_jacobian(scene, 0.0_dp, y, d_p, d_v)
        call check%close_to(maxval(abs(a_p(:m, :) - d_p(:m, :))), 0.0_dp, 2e-4_dp*maxval(abs(d_p(:m, :))), &
          'derivatives with respect to positions')
        call check%close_to(maxval(abs(a_v(:m, :) - d_v(:m, :))), 0.0_dp, 2e-4_dp*maxval(abs(d_v(:m, :))), &
          'derivatives with respect to rates')
        call check%close_to(maxval(abs(a_p(m + 1:, :) - d_p(m + 1:, :))), 0.0_dp, 2e-4_dp*maxval(abs(d_p(m + 1:, :))), &
          'derivatives of the film states with respect to positions')
        call check%close_to(maxval(abs(a_v(m + 1:, m + 1:) - d_v(m + 1:, m + 1:))), 0.0_dp, &
          2e-4_dp*maxval(abs(d_v(m + 1:, m + 1:))), 'derivatives of the film states with respect to themselves')
        call check%close_to(maxval(abs(a_v(m + 1:, :m) - d_v(m + 1:, :m))), 0.0_dp, &
          1e-3_dp*maxval(abs(d_v(m + 1:, :m))) + 1e-12_dp, 'derivatives of the film states with respect to rates')
      end do
    end do
  end subroutine derivatives

  !> Without drive, the sum of the bodies' energy, the elastic energy of the walls and the loss in the film (the integral of a
  !> column that does not depend on the walls) is constant; the film never supplies energy.
  subroutine energy_is_known(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(9)
    type(trace_t) :: trace
    real(dp), allocatable :: t(:), power(:), energy(:), stored(:)
    real(dp) :: taken, worst
    integer :: i
    set(1:2) = plain
    set(3:9) = [character(len=long) :: 'lubrication.film_moment=T', 'integrator.revolutions=0.5', &
      'output.samples_per_revolution=40000', 'integrator.relative_tolerance=1e-9', 'output.columns=standard,film_power', &
      'lubrication.pressure_viscosity=2e-8', 'mechanism.gravity=0']
    trace = run_case(file, set)
    call check%that(.not. allocated(trace%error), 'a run without drive')
    if (allocated(trace%error)) return
    call check%that(trace%report%figures%max_energy_residual < 1e-8_dp*trace%report%figures%max_energy, &
      'a run without drive: energy residual')
    allocate (t, source=trace%values(column(trace, 'time[s]'), :))
    allocate (power, source=trace%values(column(trace, 'film_power[W]'), :))
    allocate (energy, source=trace%values(column(trace, 'energy[J]'), :))
    allocate (stored, source=trace%values(column(trace, 'wall_energy[J]'), :))
    taken = 0
    worst = 0
    do i = 2, size(t)
      taken = taken + 0.5_dp*(power(i) + power(i - 1))*(t(i) - t(i - 1))
      worst = max(worst, abs(energy(i) - energy(1) + stored(i) - stored(1) + taken))
    end do
    call check%that(taken > 10*maxval(stored) .and. maxval(stored) > 1e-4_dp, 'film and walls have a share of the energy')
    call check%close_to(worst, 0.0_dp, 2e-4_dp*maxval(stored), 'sum of the energies of bodies, walls and film')
    call check%that(all(power >= 0), 'the film never supplies energy')
  end subroutine energy_is_known

  !> With walls a thousand and a million times stiffer the film converges to that of rigid walls.
  subroutine stiff_walls_are_rigid(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(8)
    type(trace_t) :: rigid, stiff
    real(dp) :: off(2)
    integer :: i, at
    set(1:2) = plain
    set(3:8) = [character(len=long) :: 'contact=none', 'lubrication.elastic_film=F', 'integrator.revolutions=0.6', &
      'integrator.relative_tolerance=1e-8', 'lubrication.pressure_viscosity=0', 'integrator.method=radau']
    rigid = run_case(file, set)
    set(4) = 'lubrication.elastic_film=T'
    do i = 1, 2
      set(3) = 'contact.youngs_modulus='//merge('207e12,207e12', '207e15,207e15', i == 1)
      stiff = run_case(file, set)
      call check%that(.not. (allocated(rigid%error) .or. allocated(stiff%error)), 'runs with rigid and stiff walls')
      if (allocated(rigid%error) .or. allocated(stiff%error)) return
      at = column(rigid, 'film_thickness[m]')
      off(i) = maxval(abs(stiff%values(at, :) - rigid%values(at, :)))
    end do
    call check%that(off(1) < 1e-2_dp*c .and. off(2) < 2e-5_dp*c, 'stiff walls converge to rigid ones')
  end subroutine stiff_walls_are_rigid

  subroutine methods_agree_on_it(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: others(3) = [character(len=long) :: 'integrator.revolutions=0.3', &
      'lubrication.pressure_viscosity=1e-8', 'lubrication.film_moment=T']
    character(len=long), parameter :: short(2) = [character(len=long) :: 'lubrication.law=finite_bearing', &
      'lubrication.variant=short']
    type(trace_t) :: trace
    call methods_agree(check, file, [plain, others], c, 'an elastic film', trace)
    call methods_agree(check, file, [short, others], c, 'a short elastic film', trace)
  end subroutine methods_agree_on_it

  !> At t = 0 the walls carry the load of an ideal joint.
  subroutine starts_on_loaded_walls(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene, ideal
    type(evaluation_t) :: now, then
    logical :: in_domain
    call read_case(file, plain, case, error)
    call build_scene(case, .false., scene, error)
    call build_scene(case, .true., ideal, error)
    call scene%evaluate(0.0_dp, scene%initial_state(), now, in_domain)
    call ideal%evaluate(0.0_dp, ideal%initial_state(), then, in_domain)
    call check%that(norm2(then%loads%force(:, piston_pin)) > 100, 'an ideal joint has a load')
    call check%close_to(norm2(now%loads%force(:, piston_pin) - then%loads%force(:, piston_pin)), 0.0_dp, &
      1e-6_dp*norm2(then%loads%force(:, piston_pin)), 'walls carry the load of an ideal joint')
  end subroutine starts_on_loaded_walls

  !> At a high speed the eccentricity exceeds the clearance, and the film remains.
  subroutine goes_beyond_the_clearance(check)
    class(checks_t), intent(inout) :: check
    character(len=long) :: set(5)
    type(trace_t) :: trace
    set(1:2) = plain
    set(3:5) = [character(len=long) :: 'initial.crank_speed=700', 'joint.clearance=6e-6', 'integrator.revolutions=1']
    trace = run_case(file, set)
    call check%that(.not. allocated(trace%error), 'a run at high speed')
    if (allocated(trace%error)) return
    call check%that(maxval(trace%values(column(trace, 'eccentricity_ratio[-]'), :)) > 1.05_dp, 'the pin goes beyond the clearance')
    call check%that(minval(trace%values(column(trace, 'film_thickness[m]'), :)) > 0, 'a film remains beyond the clearance')
    call check%that(trace%report%figures%pin(piston_pin)%min_film_thickness > 0 .and. &
      trace%report%figures%pin(piston_pin)%min_film_thickness <= minval(trace%values(column(trace, 'film_thickness[m]'), :)), &
      'smallest film thickness in the summary')
  end subroutine goes_beyond_the_clearance

  !> Under 5 kN on 20 x 15 mm an oil with 2e-8 1/Pa is more viscous by exp(2e-8 * 16.7 MPa) = 1.396, and the film becomes thinner
  !> more slowly by this factor.
  subroutine oil_under_pressure(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: thin, thick
    real(dp), parameter :: load(2) = [3000.0_dp, -4000.0_dp], e(2) = [10e-6_dp, 5e-6_dp]
    real(dp) :: slow(2), fast(2)
    call read_case(file, [character(len=long) :: plain, 'lubrication.pressure_viscosity=0'], case, error)
    call build_scene(case, .false., thin, error)
    call read_case(file, [character(len=long) :: plain, 'lubrication.pressure_viscosity=2e-8'], case, error)
    call build_scene(case, .false., thick, error)
    fast = velocity_in(thin, e, load)
    slow = velocity_in(thick, e, load)
    call check%close_to(norm2(slow*exp(2e-8_dp*5000/(2*(10e-3_dp - c)*15e-3_dp)) - fast), 0.0_dp, 1e-12_dp*norm2(fast), &
      'an oil thickens under pressure')
  end subroutine oil_under_pressure

  !> Velocity of the film of a scene at an eccentricity under a load [m/s].
  function velocity_in(scene, e, load) result(velocity)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: e(2), load(2)
    real(dp) :: velocity(2)
    select type (element => scene%joints(1)%slots(1)%element)
    type is (elastic_film_t)
      velocity = element%velocity(e, load, 1.0_dp)
    class default
      error stop 'test_elastic_film: another element'
    end select
  end function velocity_in

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: contact = "&contact law='hertz' / "
    call expect(check, contact//'&lubrication viscosity=0.01 elastic_film=T /', '', 'an elastic film is accepted')
    call expect(check, '&lubrication viscosity=0.01 elastic_film=T /', &
      '&lubrication elastic_film = T: needs the group contact', 'walls without a stiffness')
    call expect(check, '&contact / &lubrication viscosity=0.01 elastic_film=T /', &
      '&contact law: must be hertz with elastic_film', 'walls with dissipation')
    call expect(check, contact//"&lubrication viscosity=0.01 law='oscillating_film' kinematic_viscosity=1e-5 elastic_film=T /", &
      '&lubrication elastic_film = T: is for films of wedge and squeeze', 'a film that does not depend on the velocity')
    call expect(check, contact//"&lubrication viscosity=0.01 variant='as_printed' elastic_film=T /", &
      '&lubrication elastic_film = T: is for films of wedge and squeeze', 'a misprinted film')
    call expect(check, contact//"&friction coefficient=0.1 law='coulomb' / &lubrication viscosity=0.01 elastic_film=T /", &
      '&lubrication elastic_film = T: cannot be combined with the group friction', 'friction on a film')
    call expect(check, contact//"&lubrication viscosity=0.01 elastic_film=T transition='weighted' transition_depth=1e-6 /", &
      '&lubrication elastic_film = T: cannot be combined with transition', 'a transition together with an elastic film')
    call expect(check, '&lubrication viscosity=0.01 pressure_viscosity=1e-8 /', &
      '&lubrication pressure_viscosity = 1e-8: needs elastic_film', 'pressure-viscosity between rigid walls')
    call expect(check, contact//'&lubrication viscosity=0.01 elastic_film=T / &asperities roughness=1e-7 /', &
      '&asperities roughness = 1e-7: cannot be combined with the group contact', 'rough elastic walls')
  end subroutine refuses
end module test_elastic_film
