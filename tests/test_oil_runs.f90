!> Oils at a temperature in runs, and errors in cases.
module test_oil_runs
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use run_summary, only: summary_table
  use number_text, only: real_text
  use case_checks, only: expect, summary_value
  use collecting_sink, only: trace_t, run_case
  implicit none
  private
  public :: run_test_oil_runs

  integer, parameter :: long = 60
  character(len=*), parameter :: vg32 = ' known_temperatures=313.15,373.15 known_viscosities=32e-6,5.4e-6 density=865 '

contains

  subroutine run_test_oil_runs(check)
    class(checks_t), intent(inout) :: check
    call every_film(check)
    call refuses(check)
  end subroutine run_test_oil_runs

  !> A run with an oil equals the run with the resulting viscosities, for every film, but for rounding, which the oscillating film
  !> between close surfaces amplifies to some 1e-6; the summary contains the viscosity.
  subroutine every_film(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: films(5) = [character(len=long) :: 'lubrication.variant=closed_form', &
      'lubrication.variant=half_film', 'lubrication.law=oscillating_film', 'lubrication.variant=short', 'lubrication.variant=table']
    character(len=long) :: oil(13), plain(13), table
    type(trace_t) :: by_oil, by_hand
    type(case_t) :: case
    type(error_t), allocatable :: error
    integer :: i
    oil = ''
    oil(1:10) = [character(len=long) :: 'lubrication.viscosity=0', 'lubrication.viscosity_law=walther', &
      'lubrication.temperature=353.15', 'lubrication.known_temperatures=313.15,373.15', 'lubrication.density=865', &
      'lubrication.known_viscosities=32e-6,5.4e-6', 'integrator.revolutions=0.05', 'lubrication.film_points=32', &
      'lubrication.table_points=17', 'integrator.relative_tolerance=1e-10']
    oil(13) = 'integrator.method=auto'
    plain = oil
    plain(1:6) = [character(len=long) :: 'lubrication.viscosity=7.0285767E-3', 'output.digits=17', 'joint.kind=clearance', &
      'joint.clearance=20e-6', 'lubrication.kinematic_viscosity=8.53321469154105e-6', 'initial.crank_angle_deg=0']
    write (plain(1), '(a,es23.16)') 'lubrication.viscosity=', 823.67278491013_dp*8.53321469154105e-6_dp
    do i = 1, size(films)
      oil(11) = merge('lubrication.law=finite_bearing   ', 'lubrication.law=pinkus_sternlicht', i >= 4)
      oil(12) = films(i)
      if (i == 3) oil(11) = 'lubrication.kinematic_viscosity=0'
      plain(11:12) = oil(11:12)
      if (i == 3) plain(11) = 'mechanism.gravity_angle_deg=0'
      by_oil = run_case('cases/sim_I.nml', oil)
      by_hand = run_case('cases/sim_I.nml', plain)
      call check%that(.not. (allocated(by_oil%error) .or. allocated(by_hand%error)), 'runs with an oil: '//films(i))
      if (allocated(by_oil%error) .or. allocated(by_hand%error)) cycle
      call check%close_to(maxval(abs(by_oil%values - by_hand%values)/(1 + abs(by_hand%values))), 0.0_dp, 1e-4_dp, &
        'film thickness with an oil and with its viscosity: '//films(i))
      if (i > 1) cycle
      call read_case('cases/sim_I.nml', oil, case, error)
      table = summary_value(summary_table(case, by_oil%report, 0.0_dp), 'viscosity')
      call check%equal_text(trim(table), real_text(823.67278491013_dp*8.53321469154105e-6_dp, 10), 'viscosity in the summary')
      call read_case('cases/sim_I.nml', plain, case, error)
      table = summary_value(summary_table(case, by_hand%report, 0.0_dp), 'viscosity')
      call check%equal_text(trim(table), '', 'no viscosity in the summary if the case gives it')
    end do
  end subroutine every_film

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: warm = " viscosity_law='walther' temperature=353.15 "
    call expect_oil(check, vg32//warm, '', 'an oil is accepted')
    call expect_oil(check, '', 'viscosity: required (Pa s)', 'no viscosity')
    call expect_oil(check, 'viscosity=0', 'viscosity = 0: must be > 0 (Pa s)', 'a viscosity of 0')
    call expect_oil(check, "law='oscillating_film' viscosity=1", &
      "kinematic_viscosity: required with law = 'oscillating_film' (m^2/s)", 'no kinematic viscosity')
    call expect_oil(check, vg32//warm//'viscosity=0.01', &
      "viscosity = 0.01: must not be given: viscosity_law = 'walther' computes it", 'two viscosities')
    call expect_oil(check, vg32//"viscosity_law='vogel'", "temperature: required with viscosity_law = 'vogel' (K)", &
      'no temperature')
    call expect_oil(check, warm//'density=865 known_viscosities=2e-5,1e-5', 'known_temperatures(1): required', 'no temperatures')
    call expect_oil(check, warm//'density=865 known_temperatures=313.15,373.15', 'known_viscosities(1): required', 'no points')
    call expect_oil(check, warm//'known_temperatures=313.15,373.15 known_viscosities=2e-5,1e-5', 'density: required', 'no density')
    call expect_oil(check, warm//'density=865 known_temperatures=313.15,313.2 known_viscosities=2e-5,1e-5', &
      'known_temperatures(1) = 313.15: must be 1 K apart', 'one point twice')
    call expect_oil(check, warm//'density=865 known_temperatures=313.15,373.15 known_viscosities=1e-5,2e-5', &
      'known_viscosities(1) = 1e-5: must be smaller at the higher temperature', 'an oil that thickens')
    call expect_oil(check, warm//'density=865 known_temperatures=313.15,373.15 known_viscosities=1e-6,1e-7', &
      'known_viscosities(1) = 1e-6: must be >= 2.1e-7', 'a viscosity below the range of the standard')
    call expect_oil(check, vg32//"viscosity_law='walther' temperature=90", &
      'temperature = 90: must be >= 200 and <= 700 (K)', 'a temperature in degrees Celsius')
    call expect_oil(check, vg32//"viscosity_law='vogel' temperature=353.15 vogel_temperature=310", &
      'vogel_temperature = 310: must be 10 K or more below', 'a pole too near to the points')
    call expect_oil(check, 'viscosity=0.01 temperature=353.15', &
      "temperature = 353.15: needs an oil, or viscosity_law = 'walther' or 'vogel'", &
      'a temperature without a law')
    call expect_oil(check, warm//"viscosity_law='reynolds'", 'viscosity_law', 'an unknown law')
  end subroutine refuses

  !> A case with these keys of its film is accepted, or refused.
  subroutine expect_oil(check, keys, wanted, name)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: keys, wanted, name
    if (wanted == '') then
      call expect(check, '&lubrication '//keys//' /', '', name)
    else
      call expect(check, '&lubrication '//keys//' /', '&lubrication '//wanted, name)
    end if
  end subroutine expect_oil
end module test_oil_runs
