!> Named oils: against data sheets in data/oils.csv, windows of their grades, spellings, and cases with names.
module test_oil_names
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use oil_viscosity, only: oil_t
  use case_definition, only: case_t
  use case_file, only: parse_case
  use chain_motion, only: piston_pin
  use test_units, only: field_of
  use number_text, only: real_text
  use text_tools, only: replaced
  use case_checks, only: expect, bodies
  implicit none
  private
  public :: run_test_oil_names

  integer, parameter :: long = 60

contains

  subroutine run_test_oil_names(check)
    class(checks_t), intent(inout) :: check
    call named(check)
    call names_in_cases(check)
  end subroutine run_test_oil_names

  !> Named oils: their viscosities at four temperatures against data/oils.csv; grades of ISO 3448, and windows of SAE J300 (2015) at
  !> 100 degrees C.
  subroutine named(check)
    class(checks_t), intent(inout) :: check
    character(len=6), parameter :: grades(13) = [character(len=6) :: '10W', '20', '30', '40', '50', '60', '0W-20', '5W-20', &
      '0W-30', '5W-30', '10W-30', '5W-40', '20W-50']
    real(dp), parameter :: least(13) = [4.1_dp, 6.9_dp, 9.3_dp, 12.5_dp, 16.3_dp, 21.9_dp, 6.9_dp, 6.9_dp, 9.3_dp, 9.3_dp, 9.3_dp, &
      12.5_dp, 16.3_dp], most(13) = [99.0_dp, 9.3_dp, 12.5_dp, 16.3_dp, 21.9_dp, 26.1_dp, 9.3_dp, 9.3_dp, 12.5_dp, 12.5_dp, &
      12.5_dp, 16.3_dp, 21.9_dp]
    real(dp), parameter :: temperatures(4) = [313.15_dp, 353.15_dp, 373.15_dp, 393.15_dp]
    type(oil_t) :: oil
    character(len=200) :: line
    character(len=:), allocatable :: name
    integer :: unit, status, rows, i
    open (newunit=unit, file='data/oils.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      rows = rows + 1
      name = field_of(line, 1)
      oil%name = name
      call oil%read_name()
      call check%relative(oil%density, number(4), 1e-15_dp, name//': density')
      call check%relative(1e6_dp*oil%known_viscosities(2), number(3), 1e-15_dp, name//': at 100 degrees C')
      do i = 1, size(temperatures)
        oil%temperature = temperatures(i)
        call check%relative(oil%dynamic_viscosity(), number(5 + i), 1e-9_dp, name//': viscosity')
      end do
      if (index(name, 'ISO VG ') == 1) then
        line = name(8:)//','
        call check%relative(1e6_dp*oil%known_viscosities(1), number(1), 1e-12_dp, name//': its grade')
      end if
      do i = 1, size(grades)
        if (name == 'SAE '//grades(i)) call check%that(1e6_dp*oil%known_viscosities(2) >= least(i) .and. &
          1e6_dp*oil%known_viscosities(2) < most(i), name//': in the window of its grade')
      end do
    end do
    close (unit)
    call check%that(rows == 27, 'rows of data/oils.csv')

  contains

    real(dp) function number(i)
      integer, intent(in) :: i
      character(len=:), allocatable :: field
      field = field_of(line, i)
      read (field, *) number
    end function number
  end subroutine named

  !> Spellings of names; a case with a name is the case with the oil's data, which its resolved form has too; refusals.
  subroutine names_in_cases(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: film = '&lubrication temperature=353.15 oil='
    character(len=12), parameter :: spellings(6) = [character(len=12) :: 'SAE 10W-40', 'sae10w40', '10W-40', '10w40', &
      'SAE 10w 40', 'Sae-10W-40']
    type(oil_t) :: oil
    integer :: i
    do i = 1, size(spellings)
      oil%name = trim(spellings(i))
      call oil%read_name()
      call check%equal_text(oil%name, 'SAE 10W-40', 'spelling '//spellings(i))
    end do
    oil%name = 'vg46'
    call oil%read_name()
    call check%equal_text(oil%name, 'ISO VG 46', 'spelling vg46')
    call expect(check, film//'''SAE 30'' /', '', 'a named oil')
    call expect(check, film//'''SAE 35'' /', 'oil = SAE 35: unknown oil; one of ISO VG 10 to 680', 'an unknown oil')
    call expect(check, film//'''SAE 35'' /', '; did you mean SAE 30?', 'a similar oil')
    call expect(check, film//'''30'' /', 'oil = 30: unknown oil', 'a number alone')
    call expect(check, film//'''SAE 30'' density=900 /', 'density = 900: must not be given: oil = ''SAE 30'' gives it', &
      'its density')
    call expect(check, film//'''SAE 30'' viscosity_law=''vogel'' /', 'viscosity_law', 'another law')
    call expect(check, film//'''SAE 30'' viscosity=0.01 /', 'viscosity = 0.01: must not be given', 'viscosity too')
    call expect(check, '&lubrication oil=''SAE 30'' /', 'temperature: required with oil = ''SAE 30''', 'no temperature')
    call resolves(check, film)
  end subroutine names_in_cases

  !> The resolved form of a case with a named oil is that of the case with the oil's data, with the name, and is read back.
  subroutine resolves(check, film)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: film
    character(len=long), parameter :: by_hand(4) = [character(len=long) :: 'lubrication.viscosity_law=walther', &
      'lubrication.known_temperatures=313.15,373.15', 'lubrication.known_viscosities=100e-6,11.4e-6', 'lubrication.density=885']
    character(len=long) :: none(0)
    character(len=:), allocatable :: resolved, other
    type(case_t) :: case
    type(error_t), allocatable :: error
    call parse_case(bodies//film//'''SAE 30'' /', 'x.nml', none, case, error, resolved)
    call check%that(allocated(resolved), 'a named oil is accepted')
    if (.not. allocated(resolved)) return
    call check%equal_text(case%joints(piston_pin)%oil%name, 'SAE 30', 'the case has the name')
    call check%that(index(resolved, 'oil = ''SAE 30''') > 0, 'so has the resolved form')
    call parse_case(resolved, 'x.nml', none, case, error, other)
    if (allocated(error)) other = error%message
    call check%equal_text(other, resolved, 'the resolved form is read back')
    call parse_case(bodies//film//''''' /', 'x.nml', by_hand, case, error, other)
    if (allocated(error)) other = error%message
    call check%equal_text(other, replaced(resolved, 'SAE 30', ''), 'resolved form of a named oil')
  end subroutine resolves
end module test_oil_names
