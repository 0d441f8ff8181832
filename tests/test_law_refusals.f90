!> Laws that a case names wrongly, and keys of laws that are missing, out of their limits or contradict each other.
module test_law_refusals
  use error_handling, only: error_t
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: parse_case
  use case_checks, only: expect
  implicit none
  private
  public :: run_test_law_refusals

contains

  subroutine run_test_law_refusals(check)
    class(checks_t), intent(inout) :: check
    call frictions_and_films(check)
    call test_refusals(check)
  end subroutine run_test_law_refusals

  !> Names, required keys, limits and contradictions of friction laws and films.
  subroutine frictions_and_films(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: bristles = ' coefficient=0.1 stribeck_speed=1e-2 bristle_stiffness=1e4'
    character(len=*), parameter :: less = 'static_coefficient = 0.05: must be >= coefficient = 0.1, or 0'
    character(len=*), parameter :: of_finite = " law='finite_bearing' "
    call expect(check, "&contact law='velcro' /", '&contact law = velcro: must be one of lankarani_nikravesh, hertz', 'contact law')
    call friction("law='glue' coefficient=0.1", 'law = glue: must be one of ambrosio, coulomb, threlfall, brown_mcphee, '// &
      'stribeck, lugre, dahl, elasto_plastic')
    call friction("law='coulomb' coefficient=0.1 static_coefficient=0.05", less//': as coefficient')
    call friction("law='brown_mcphee' coefficient=0.1 static_coefficient=0.05 transition_speed=1", less//': as coefficient')
    call friction("law='stribeck' coefficient=0.1 static_coefficient=0.05 transition_speed=1 stribeck_speed=1", &
      less//': as coefficient')
    call friction("law='threlfall' coefficient=0.1 v1=0", 'v1 = 0: threlfall needs a speed: must be > 0 (m/s)')
    call friction("law='brown_mcphee' coefficient=0.1 transition_speed=0", 'transition_speed = 0: must be > 0 (m/s)')
    call friction("law='stribeck' coefficient=0.1 stribeck_speed=-1 transition_speed=1", 'stribeck_speed = -1: must be > 0 (m/s)')
    call friction("law='stribeck' coefficient=0.1 stribeck_speed=1 transition_speed=1 stribeck_exponent=0", &
      'stribeck_exponent = 0: must be >= 0.1 and <= 10')
    call friction("law='brown_mcphee' coefficient=0.1", 'transition_speed: required')
    call friction("law='lugre' static_coefficient=0.05"//bristles, less)
    call friction("law='elasto_plastic' static_coefficient=0.05"//bristles, less)
    call friction("law='dahl' coefficient=0 bristle_stiffness=1", 'coefficient = 0: must be > 0 for a law with bristles')
    call friction("law='dahl' coefficient=0.1 bristle_stiffness=0", 'bristle_stiffness = 0: must be > 0 (1/m)')
    call friction("law='lugre' coefficient=0.1 bristle_stiffness=1", 'stribeck_speed: required')
    call friction("law='dahl' coefficient=0.1", 'bristle_stiffness: required')
    call friction("law='elasto_plastic' breakaway_ratio=1"//bristles, 'breakaway_ratio = 1: must be >= 0 and < 1')
    call friction("law='lugre' bristle_damping=-1"//bristles, 'bristle_damping = -1: must be >= 0 (s/m)')
    call friction("law='lugre' bristle_damping=1 damping_speed=0.3"//bristles, &
      'damping_speed = 0.3: bristle_damping gives more than the static friction at touch-down: must be < ')
    call friction("law='lugre' bristle_damping=1"//bristles, 'damping_speed: a constant bristle_damping')
    call film("law='honey'", 'law = honey: must be one of pinkus_sternlicht, oscillating_film, finite_bearing')
    call film("variant='thick'", 'variant = thick: must be one of closed_form')
    call film("law='oscillating_film' kinematic_viscosity=1.38e-5 variant='closed_form'", &
      'variant = closed_form: must be one of bearing_frame, as_printed for oscillating_film')
    call film(of_finite//'film_points=66', 'film_points = 66: ')
    call film(of_finite//'table_points=5', 'table_points = 5: ')
    call film(of_finite//"variant='short' cavitation='none'", 'cavitation = none: ')

  contains

    subroutine friction(keys, wanted)
      character(len=*), intent(in) :: keys, wanted
      call expect(check, '&contact / &friction '//keys//' /', '&friction '//wanted, keys)
    end subroutine friction

    subroutine film(keys, wanted)
      character(len=*), intent(in) :: keys, wanted
      call expect(check, '&lubrication viscosity=0.01 '//keys//' /', '&lubrication '//wanted, keys)
    end subroutine film
  end subroutine frictions_and_films

  !> Each invalid combination is refused with one line.
  subroutine test_refusals(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: joint = "kind='clearance' clearance=20e-6 bearing_radius=10e-3"
    character(len=*), parameter :: whole = joint//' bearing_length=15e-3'
    call refused(joint, "geometry='johnson'", "&joint bearing_length: required with contact geometry = 'johnson' (m)")
    call refused(joint//' bearing_length=0', "geometry='winkler' bedding_modulus=1e13", &
      '&joint bearing_length = 0: must be > 0 (m)')
    call refused("kind='clearance' clearance=4.9e-6 bearing_radius=10e-3 bearing_length=15e-3", "geometry='pereira'", &
      "&joint clearance = 4.9e-6: must be >= 5e-6 and <= 1e-2 with contact geometry = 'pereira' (m)")
    call refused(whole, "geometry='sphere'", '&contact geometry = sphere: must be one of hertz_sphere, johnson, conformal, '// &
      'pereira, winkler', is_list=.true.)
    call refused(whole, "geometry='conformal' stiffness=1e9", "&contact stiffness = 1e9: is for geometry = 'hertz_sphere' "// &
      "alone and must not be given with 'conformal' (N/m^exponent)")
    call refused(whole, "geometry='johnson' exponent=1.4", "&contact exponent = 1.4: is for geometry = 'hertz_sphere' alone "// &
      "and must not be given with 'johnson'")
    call refused(whole, "geometry='johnson' exponent=1.5 stiffness=0", '')
    call refused(whole, "geometry='conformal' housing_compliance=-0.6", '&contact housing_compliance = -0.6: must be >= -0.5')
    call refused(whole, "geometry='winkler'", "&contact bedding_modulus: required with geometry = 'winkler', or "// &
      'liner_modulus and liner_thickness (Pa/m)')
    call refused(whole, "geometry='winkler' liner_modulus=3e9", '&contact liner_thickness: required with liner_modulus (m)')
    call refused(whole, "geometry='winkler' liner_thickness=1e-3", '&contact liner_modulus: required with liner_thickness (Pa)')
    call refused(whole, "geometry='winkler' bedding_modulus=1e13 liner_modulus=3e9 liner_thickness=1e-3", &
      '&contact bedding_modulus = 1e13: must not be given together with liner_modulus or liner_thickness (Pa/m)')
    call refused(whole, "geometry='winkler' liner_modulus=3e9 liner_thickness=1e-3 liner_poissons_ratio=0.5", &
      '&contact liner_poissons_ratio = 0.5: must be >= 0 and <= 0.49')
    call refused(whole, "law='exact' restitution=0.009", "&contact restitution = 0.009: must be >= 0.01 with law = 'exact'")
    call refused(whole, "law='gonthier' restitution=0", "&contact restitution = 0: must be >= 0.01 with law = 'gonthier'")
    call refused(whole, "law='zhiying_qishao' restitution=0", '')
    call refused(whole, "law='flores' restitution=0.5 dissipation=0.3", '&contact dissipation = 0.3: must not be given '// &
      'together with restitution = 0.5; contact.restitution=0.9 takes that back')
    call refused(whole, "dissipation=-1", '&contact dissipation = -1: must be > 0 (s/m)')
    call refused(whole, "law='impact' damping=10", "&contact full_damping_depth: required with law = 'impact' (m)")
    call refused(whole, "law='impact' damping=-1 full_damping_depth=1e-6", '&contact damping = -1: must be >= 0 (N s/m)')

  contains

    !> The case is refused with this message, with a line number where a value is given; '': it is accepted. `is_list`: it ends with
    !> a list of names that may be longer.
    subroutine refused(joint_keys, contact_keys, message, is_list)
      character(len=*), intent(in) :: joint_keys, contact_keys, message
      logical, intent(in), optional :: is_list
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: got, wanted
      character(len=1) :: nothing(0)
      call parse_case('&mechanism crank_length=0.05 crank_mass=1 crank_inertia=1 rod_length=0.2 rod_mass=1 rod_inertia=1 '// &
        'piston_mass=1 / &initial crank_speed=100 / &integrator revolutions=1 / &joint '//joint_keys//' / &contact '// &
        contact_keys//' /', 'x.nml', nothing, case, error)
      got = ''
      if (allocated(error)) got = error%message
      wanted = 'x.nml: '//message
      if (index(message(:index(message, ':')), ' = ') > 0) wanted = 'x.nml:1: '//message
      if (message == '') then
        call check%equal_text(got, '', 'taken: '//contact_keys)
      else if (present(is_list)) then
        call check%begins_with(got, wanted, 'refused: '//contact_keys)
      else
        call check%equal_text(got, wanted, 'refused: '//contact_keys)
      end if
    end subroutine refused
  end subroutine test_refusals
end module test_law_refusals
