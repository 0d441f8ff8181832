!> Checks of cases used by several tests of joints: a short case with additional groups is accepted, or refused with the expected
!> message; all methods give the same result for a case.
module case_checks
  use kinds, only: dp
  use error_handling, only: error_t, status_case_file
  use checks, only: checks_t
  use case_definition, only: case_t
  use case_file, only: parse_case
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: expect, methods_agree, bodies, summary_value

  !> Bodies and a run, with a bearing of 10 mm and a clearance of 20 um.
  character(len=*), parameter :: bodies = '&mechanism crank_length=0.05 crank_mass=1 crank_inertia=1 rod_length=0.2 '// &
    'rod_mass=1 rod_inertia=1 piston_mass=1 / &initial crank_speed=100 / &integrator revolutions=1 / '// &
    '&joint kind=''clearance'' clearance=20e-6 bearing_radius=10e-3 bearing_length=15e-3 / '

contains

  !> The bodies with these groups are refused with a message that contains `wanted`, or accepted if `wanted` is empty.
  subroutine expect(check, groups, wanted, name)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: groups, wanted, name
    character(len=1) :: nothing(0)
    type(case_t) :: case
    type(error_t), allocatable :: error
    call parse_case(bodies//groups, 'x.nml', nothing, case, error)
    call check%that(allocated(error) .neqv. wanted == '', name//' is accepted or refused as expected')
    if (.not. allocated(error)) return
    call check%that(index(error%message, wanted) > 0, name//', message: '//error%message)
    call check%that(error%status == status_case_file, name//' is refused as an error of a case file')
  end subroutine expect

  !> A case with these settings runs with each method, its energy residual is small, and the film thickness is the same within 1e-6
  !> of the clearance. `trace` is that of the last method.
  subroutine methods_agree(check, file, settings, clearance, name, trace)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, settings(:), name
    real(dp), intent(in) :: clearance   !! [m]
    type(trace_t), intent(out) :: trace
    character(len=6), parameter :: methods(3) = [character(len=6) :: 'adams', 'radau', 'auto']
    integer, parameter :: long = 60
    character(len=long) :: all(size(settings) + 2)
    type(trace_t) :: first
    integer :: i, at
    all(:size(settings)) = settings
    all(size(all)) = 'integrator.relative_tolerance=1e-9'
    do i = 1, size(methods)
      all(size(all) - 1) = 'integrator.method='//methods(i)
      trace = run_case(file, all)
      call check%that(.not. allocated(trace%error), name//' runs by '//methods(i))
      if (allocated(trace%error)) return
      associate (figures => trace%report%figures)
        call check%that(figures%max_energy_residual < 1e-8_dp*figures%max_energy, name//': energy residual')
      end associate
      if (i == 1) first = trace
      at = column(trace, 'film_thickness[m]')
      call check%close_to(maxval(abs(trace%values(at, :) - first%values(at, :))), 0.0_dp, 1e-6_dp*clearance, &
        name//': all methods give the same film thickness')
    end do
  end subroutine methods_agree

  !> The value of a quantity in the text of a summary; empty if it is not there.
  function summary_value(table, quantity) result(text)
    character(len=*), intent(in) :: table, quantity
    character(len=:), allocatable :: text
    character(len=*), parameter :: newline = achar(10)
    integer :: first
    text = ''
    first = index(table, newline//quantity//',')
    if (first == 0) return
    first = first + len(newline//quantity//',')
    text = table(first:first + index(table(first:)//newline, newline) - 2)
    text = text(:index(text, ',', back=.true.) - 1)
  end function summary_value
end module case_checks
