!> The load elements of a joint: their slopes against differences, with a bearing that turns, the powers of the kinds of load, and a
!> joint whose pin belongs to the body farther from the crank.
module test_load_elements
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use chain_motion, only: body_piston, body_small_end
  use joint_evaluation, only: joint_evaluation_t, most_element_states, find_polar, find_sliding, clear_loads
  use load_element, only: load_element_t, power_of, n_motions, n_slopes, n_kinds, of_contact, of_friction, of_film, of_asperities
  use clearance_joint, only: clearance_joint_t, phase_contact
  use scene_problem, only: scene_t, evaluation_t
  use scene_builder, only: build_scene
  use state_making, only: set_pin, set_crank, set_contact
  implicit none
  private
  public :: run_test_load_elements

  !> A kind of element, by a case, settings of it, an eccentricity over the clearance, and the kinds of load that it has.
  type :: kind_t
    character(len=24) :: file
    character(len=120) :: settings
    logical :: touches
    real(dp) :: ratio
    logical :: has(n_kinds)
  end type kind_t

  logical, parameter :: yes = .true., no = .false.
  character(len=*), parameter :: sheared = 'lubrication.film_moment=T'
  type(kind_t), parameter :: element_kinds(9) = [ &
    kind_t('friction/lugre', '', yes, 1.02_dp, [yes, yes, no, no]), &
    kind_t('flores/friction_050', 'friction.v1=2', yes, 1.01_dp, [yes, yes, no, no]), &
    kind_t('flores/dry_0500um', '', yes, 1.01_dp, [yes, no, no, no]), &
    kind_t('wear/worn_bore', '', yes, 1.01_dp, [yes, yes, no, no]), &
    kind_t('sim_IV', sheared, no, 0.7_dp, [no, no, yes, no]), &
    kind_t('film/weighted', sheared, no, 0.985_dp, [no, no, yes, no]), &
    kind_t('film/weighted', sheared//' friction.v1=2', yes, 1.006_dp, [yes, yes, yes, no]), &
    kind_t('film/sim_IV_mixed', sheared//' lubrication.variant=short lubrication.film_points=0', no, 0.99_dp, [no, no, yes, yes]), &
    kind_t('film/elastic', sheared//' lubrication.variant=short lubrication.film_points=0', no, 0.9_dp, [yes, no, yes, no])]

contains

  subroutine run_test_load_elements(check)
    class(checks_t), intent(inout) :: check
    type(scene_t), allocatable :: scene
    integer :: i
    do i = 1, size(element_kinds)
      call make_scene(check, element_kinds(i), scene)
      if (.not. allocated(scene)) cycle
      call slopes_are_those_of_the_loads(check, element_kinds(i), scene%joints(1))
      call powers_add_up(check, element_kinds(i), scene%joints(1))
    end do
    call pin_on_the_other_body(check)
  end subroutine run_test_load_elements

  subroutine make_scene(check, kind, scene)
    class(checks_t), intent(inout) :: check
    type(kind_t), intent(in) :: kind
    type(scene_t), allocatable, intent(out) :: scene
    type(case_t) :: case
    type(error_t), allocatable :: error
    character(len=60), allocatable :: settings(:)
    character(len=:), allocatable :: rest
    integer :: blank
    allocate (settings(0))
    rest = trim(kind%settings)
    do while (rest /= '')
      blank = index(rest//' ', ' ')
      settings = [character(len=60) :: settings, rest(:blank - 1)]
      rest = trim(rest(min(blank + 1, len(rest) + 1):))
    end do
    call read_case('cases/'//trim(kind%file)//'.nml', settings, case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    call check%that(.not. allocated(error), 'the scene of '//kind%file)
    if (allocated(error)) return
    if (kind%touches) call set_contact(scene%joints(1), 0.6_dp, 1)
    call scene%joints(1)%begin_at(kind%ratio*scene%joints(1)%bearing%clearance, 0.0_dp)
  end subroutine make_scene

  !> An evaluation of a joint alone, at values of e, e', both angular speeds and the states of its element.
  subroutine evaluate(joint, values, now)
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(in) :: values(n_slopes)
    type(joint_evaluation_t), intent(out) :: now
    real(dp) :: y(200)
    associate (element => joint%slots(joint%acting(joint%phase))%element)
      y = 0
      y(joint%at%position:joint%at%position + 1) = values(1:2)
      y(joint%at%rate:joint%at%rate + 1) = values(3:4)
      y(element%states%first:element%states%last) = values(n_motions + 1:n_motions + element%n_states)
      call clear_loads(now)
      call joint%read_state(y, now)
      now%pin_angular_speed = values(5)
      now%bearing_speed = values(6)
      call find_polar(joint%bearing%clearance, now)
      call find_sliding(joint%pin_radius, now)
      now%states(:element%n_states) = values(n_motions + 1:n_motions + element%n_states)
      call element%find_loads(y, now)
    end associate
  end subroutine evaluate

  !> Values for `evaluate`, and natural sizes of their changes.
  subroutine some_values(kind, joint, values, sizes)
    type(kind_t), intent(in) :: kind
    type(clearance_joint_t), intent(in) :: joint
    real(dp), intent(out) :: values(n_slopes), sizes(n_slopes)
    associate (c => joint%bearing%clearance, element => joint%slots(joint%acting(joint%phase))%element)
      values(1:2) = kind%ratio*c*[cos(0.7_dp), sin(0.7_dp)]
      values(3:4) = c*[140.0_dp, -230.0_dp]
      values(5:6) = [75.0_dp, -31.0_dp]
      values(n_motions + 1:) = 0
      if (kind%file == 'film/elastic') values(n_motions + 1:) = values(1:2) - [4e-8_dp, 7e-8_dp]
      if (kind%file == 'friction/lugre') values(n_motions + 1) = 2e-7_dp
      sizes(1:2) = 1e-6_dp*c
      sizes(3:4) = c
      sizes(5:6) = 1e-2_dp
      sizes(n_motions + 1:) = 1e-5_dp*element%state_scale
    end associate
  end subroutine some_values

  subroutine slopes_are_those_of_the_loads(check, kind, joint)
    class(checks_t), intent(inout) :: check
    type(kind_t), intent(in) :: kind
    type(clearance_joint_t), intent(in) :: joint
    type(joint_evaluation_t) :: now
    real(dp) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes), values(n_slopes), sizes(n_slopes), above(n_slopes)
    real(dp) :: want(3 + most_element_states), got(3 + most_element_states), natural(3 + most_element_states)
    integer :: i, n
    associate (element => joint%slots(joint%acting(joint%phase))%element)
      if (.not. element%has_slopes) return
      call some_values(kind, joint, values, sizes)
      call evaluate(joint, values, now)
      call element%find_slopes(now, of_loads, of_rates)
      natural = [norm2(now%force), norm2(now%force), abs(now%moment), abs(now%rates)]
      n = element%n_states
      do i = 1, n_motions + n
        above = values
        above(i) = values(i) + sizes(i)
        call evaluate(joint, above, now)
        want = [now%force, now%moment, now%rates]
        above(i) = values(i) - sizes(i)
        call evaluate(joint, above, now)
        want = want - [now%force, now%moment, now%rates]
        got = 2*sizes(i)*[of_loads(:, i), of_rates(:, i)]
        call check%that(all(abs(got(:3 + n) - want(:3 + n)) <= 2e-4_dp*maxval(abs(want(:2))) &
          *merge([1.0_dp, 1.0_dp, joint%pin_radius, 1.0_dp, 1.0_dp], 0.0_dp, [1, 2, 3, 4, 5] <= 3) + 1e-4_dp*abs(want(:3 + n)) &
          + 1e-11_dp*natural(:3 + n)), trim(kind%file)//': slopes of loads and rates')
      end do
    end associate
  end subroutine slopes_are_those_of_the_loads

  !> The powers of the kinds add up to that of force and moment, and a kind that the element does not have has none.
  subroutine powers_add_up(check, kind, joint)
    class(checks_t), intent(inout) :: check
    type(kind_t), intent(in) :: kind
    type(clearance_joint_t), intent(in) :: joint
    type(joint_evaluation_t) :: now
    real(dp) :: values(n_slopes), sizes(n_slopes), powers(n_kinds)
    call some_values(kind, joint, values, sizes)
    if (kind%file == 'wear/worn_bore') values(6) = 0   ! its bearing does not turn
    call evaluate(joint, values, now)
    powers = joint%powers(now)
    call check%relative(sum(powers), power_of(now, now%force, now%eccentricity_rate, now%moment), 1e-11_dp, &
      trim(kind%file)//': powers of all kinds')
    call check%that(all(abs(powers) > 0 .eqv. kind%has), trim(kind%file)//': kinds of load')
    call check%that(all(powers([of_friction, of_film, of_asperities]) <= 0) .or. kind%touches .or. powers(of_contact) < 0, &
      trim(kind%file)//': friction and film take power')
  end subroutine powers_add_up

  !> With a film and its shear, which see only the relative motion, nothing tells whether the pin is held by the rod or by the
  !> piston: a pin on the piston at the opposite eccentricity gives the bodies the same accelerations.
  subroutine pin_on_the_other_body(check)
    class(checks_t), intent(inout) :: check
    type(scene_t), allocatable :: scene
    type(evaluation_t) :: now(2)
    real(dp), allocatable :: y(:), f(:, :)
    real(dp) :: e(2), rate(2)
    logical :: in_domain
    integer :: i
    call make_scene(check, element_kinds(5), scene)
    if (.not. allocated(scene)) return
    allocate (f(scene%n, 2))
    do i = 1, 2
      y = scene%initial_state()
      call set_crank(scene, y, 0.8_dp, 250.0_dp)
      e = 0.8_dp*scene%joints(1)%bearing%clearance*[0.6_dp, -0.8_dp]
      rate = [2e-3_dp, 1e-3_dp]
      if (i == 2) then
        associate (site => scene%joints(1)%site)
          site%sense = -1
          site%pin_body = body_piston
          site%bearing = body_small_end
        end associate
        scene%joints(1)%bearing_turns = .true.
        e = -e
        rate = -rate
      end if
      call set_pin(scene, y, e, rate)
      call scene%derivatives(0.0_dp, y, f(:, i), in_domain)
      call scene%evaluate(0.0_dp, y, now(i), in_domain)
    end do
    associate (a => now(1)%accelerations, b => now(2)%accelerations, at => scene%joints(1)%at)
      call check%relative(b%crank, a%crank, 1e-12_dp, 'acceleration of the crank with the pin in the piston')
      call check%relative(b%rod, a%rod, 1e-12_dp, 'acceleration of the rod with the pin in the piston')
      call check%relative(b%piston, a%piston, 1e-12_dp, 'acceleration of the piston with the pin in the piston')
      call check%close_to(maxval(abs(f(at%rate:at%rate + 1, 1) + f(at%rate:at%rate + 1, 2))), 0.0_dp, &
        1e-12_dp*norm2(f(at%rate:at%rate + 1, 1)), 'the eccentricity accelerates the other way')
      call check%relative(f(scene%work_at, 2), f(scene%work_at, 1), 1e-12_dp, 'power with the pin in the piston')
    end associate
  end subroutine pin_on_the_other_body
end module test_load_elements
