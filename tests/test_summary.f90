!> Texts of the summary.
module test_summary
  use kinds, only: dp
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use run_summary, only: build_advice, summary_table
  use case_checks, only: summary_value
  use case_definition, only: case_t
  use simulation, only: run_report_t
  use text_tools, only: integer_text
  use joint_places, only: crank_pin
  implicit none
  private
  public :: run_test_summary

contains

  subroutine run_test_summary(check)
    class(checks_t), intent(inout) :: check
    call a_status_is_one_field(check, 'done', 'done')
    call a_status_is_one_field(check, '"a","b', '"""a"",""b"')
    call a_status_is_one_field(check, 'a""', '"a"""""')
    call times_by_method_stand_under_their_phases(check)
    call slow_builds_are_told(check)
  end subroutine run_test_summary

  !> As in RFC 4180, quotes within a field are doubled.
  subroutine a_status_is_one_field(check, status, field)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: status, field
    type(case_t) :: case
    type(run_report_t) :: report
    character(len=:), allocatable :: table
    report%status = status
    case%output%digits = 10
    table = summary_table(case, report, 0.0_dp)
    call check%that(index(table, achar(10)//'status,'//field//','//achar(10)) > 0, 'a status in a table: '//status)
    call check%equal_text(summary_value(table, 'status'), field, 'a status is read back')
    call check%equal_text(summary_value(table, 'friction_work'), '', 'no value of a quantity that is not there')
    call check%equal_text(summary_value('', 'status'), '', 'an empty table has no status')
  end subroutine a_status_is_one_field

  !> A tenth of the time is spent in a film with Radau, the rest in contact with Adams; with two joints, the phases of both.
  subroutine times_by_method_stand_under_their_phases(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    type(run_report_t) :: report
    report%status = 'done'
    report%figures%time = 2
    report%figures%pin(piston_pin)%min_film_thickness = 0
    case%output%digits = 10
    allocate (report%time_with(2, 0:2), source=0.0_dp)
    report%time_with(2, 1) = 0.2_dp
    report%time_with(1, 2) = 1.8_dp
    call has(case, report, 'film_time_fraction_with_radau,1.000000000E-01,1')
    call has(case, report, 'contact_time_fraction_with_adams,9.000000000E-01,1')
    deallocate (report%time_with)
    allocate (report%time_with(2, 0:8), source=0.0_dp)
    report%time_with(1, [0, 2 + 3*1]) = 1
    case%joints(piston_pin)%kind = 'clearance'
    case%joints(crank_pin)%kind = 'clearance'
    call has(case, report, 'contact_film_time_fraction_with_adams,5.000000000E-01,1')
    deallocate (report%time_with)
    allocate (report%time_with(2, 0:2), source=0.0_dp)
    report%time_with(2, 1) = 0.2_dp
    report%time_with(1, 2) = 1.8_dp
    case%joints(piston_pin)%kind = 'ideal'
    call has(case, report, 'crank_pin_film_time_fraction_with_radau,1.000000000E-01,1')

  contains

    subroutine has(case, report, row)
      type(case_t), intent(in) :: case
      type(run_report_t), intent(in) :: report
      character(len=*), intent(in) :: row
      character(len=:), allocatable :: table
      table = summary_table(case, report, 0.0_dp)
      call check%that(index(table, achar(10)//row//achar(10)) > 0, 'a time by method: '//row)
      call check%that(index(table(index(table, row) + len(row):), '_time_fraction_with_') == 0 .or. &
        index(row, 'film_time') > 0, 'no other times by method')   ! contact follows film
    end subroutine has
  end subroutine times_by_method_stand_under_their_phases

  !> The line about a debug build is printed only after some time, and only if the compiler has not optimised.
  subroutine slow_builds_are_told(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: debug = '-g -fcheck=bounds -fbacktrace -J build/-O3/x'
    call check%that(index(build_advice(debug, 2.5_dp), 'scripts/install.sh') > 0, 'a long run of a debug build')
    call check%equal_text(build_advice(debug, 1.9_dp), '', 'a short run of a debug build')
    call check%that(index(build_advice('-O1 -g', 60.0_dp), 'install.sh') > 0, 'a build with little optimisation')
    call check%equal_text(build_advice('-g -O2 -fPIC', 60.0_dp), '', 'an optimised build')
    call check%equal_text(build_advice('-mtune=generic -O3 -funroll-loops', 60.0_dp), '', 'the release build')
    call check%equal_text(build_advice('-Ofast', 60.0_dp), '', 'a build with -Ofast')
    call check%equal_text(integer_text(0)//integer_text(-7)//integer_text(1203), '0-71203', 'whole numbers')
    call check%equal_text(integer_text(huge(1))//integer_text(-huge(1)), '2147483647-2147483647', &
      'largest and smallest whole number')
  end subroutine slow_builds_are_told
end module test_summary
