!> The compliance of a bearing's bore: a ring against collocation of the equations of elasticity (data/film/engine) and its limits;
!> tables of compliances.
module test_ring
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t, status_case_file
  use checks, only: checks_t
  use ring_compliance, only: elastic_bore_t, new_ring, new_compliance, ring_compliance_of, shape_value, shape_slope
  implicit none
  private
  public :: run_test_ring

contains

  subroutine run_test_ring(check)
    class(checks_t), intent(inout) :: check
    call collocation(check)
    call thin_ring(check)
    call half_plane(check)
    call ring_in_metres(check)
    call shapes(check)
    call table_of_a_ring(check)
    call refuses(check)
  end subroutine run_test_ring

  !> C_n E/a of six rings, nine harmonics, in plane stress; and in plane strain, which is plane stress with E/(1 - nu^2) and
  !> nu/(1 - nu).
  subroutine collocation(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: nu = 0.3_dp
    real(dp) :: ratio, stress, strain
    integer :: n, rows, status, unit
    open (newunit=unit, file='data/film/engine/ring_compliance.csv', status='old', action='read')
    read (unit, *)
    rows = 0
    do
      read (unit, *, iostat=status) ratio, n, stress, strain
      if (status /= 0) exit
      rows = rows + 1
      call check%relative(ring_compliance_of(n, ratio, nu), stress, 2e-7_dp, 'ring in plane stress')
      call check%relative(ring_compliance_of(n, ratio, nu/(1 - nu))*(1 - nu**2), strain, 2e-7_dp, 'ring in plane strain')
    end do
    close (unit)
    call check%that(rows == 54, 'the table of rings has its rows')
  end subroutine collocation

  !> A thin ring bends: R^4/(E I (n^2 - 1)^2), R its middle radius, for the pressure per length on that radius.
  subroutine thin_ring(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: thickness = 0.01_dp
    real(dp) :: middle, bending
    integer :: n
    middle = 1 + 0.5_dp*thickness
    do n = 2, 4
      bending = 12*middle**3/(thickness**3*real(n**2 - 1, dp)**2)   ! the load p a is carried at the middle radius
      call check%relative(ring_compliance_of(n, 1 + thickness, 0.3_dp), bending, 5e-3_dp, 'a thin ring bends')
    end do
    call check%relative(ring_compliance_of(0, 1 + 1e-4_dp, 0.3_dp), 1e4_dp, 1e-3_dp, 'a thin ring under uniform pressure')
  end subroutine thin_ring

  !> Short waves on a thick ring, as on a half plane: 2/(E n). The largest harmonic on a very thick ring has no rounding.
  subroutine half_plane(check)
    class(checks_t), intent(inout) :: check
    call check%relative(ring_compliance_of(40, 2.5_dp, 0.3_dp), 2/40.0_dp, 1e-2_dp, 'a short wave on a half plane')
    call check%relative(ring_compliance_of(32, 1e6_dp, 0.3_dp), ring_compliance_of(32, 20.0_dp, 0.3_dp), 1e-12_dp, &
      'a short wave on a very thick ring')
  end subroutine half_plane

  !> The sizes of a steel ring, a = 10 mm, b/a = 1.5: 1.143 um/MPa for n = 2.
  subroutine ring_in_metres(check)
    class(checks_t), intent(inout) :: check
    type(elastic_bore_t) :: bore
    bore = new_ring(0.010_dp, 0.015_dp, 207e9_dp, 0.3_dp, 8)
    call check%that(bore%shapes() == 15, 'shapes of a ring')
    call check%relative(bore%compliance(2, 2), 1.1434e-12_dp, 1e-4_dp, 'compliance of a steel ring')
    call check%close_to(bore%compliance(2, 2), bore%compliance(3, 3), 0.0_dp, 'cosine and sine of a ring')
    call check%close_to(maxval(abs(bore%compliance(2, 3:))), 0.0_dp, 0.0_dp, 'shapes of a ring are independent')
  end subroutine ring_in_metres

  subroutine shapes(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: step = 1e-6_dp
    real(dp) :: difference
    logical :: is_sine
    integer :: n
    do n = 0, 3
      is_sine = mod(n, 2) == 1
      difference = (shape_value(n, is_sine, 0.7_dp + step) - shape_value(n, is_sine, 0.7_dp - step))/(2*step)
      call check%close_to(shape_slope(n, is_sine, 0.7_dp), difference, 1e-8_dp, 'slope of a shape')
    end do
    call check%close_to(shape_value(3, .true., pi/6), 1.0_dp, 1e-15_dp, 'the shape sin 3 theta')
  end subroutine shapes

  !> A table with the compliances of a ring, in any order, gives its bore.
  subroutine table_of_a_ring(check)
    class(checks_t), intent(inout) :: check
    type(elastic_bore_t) :: ring, bore
    type(error_t), allocatable :: error
    character(len=2), parameter :: names(5) = ['3s', '2c', '0 ', '3c', '2s']
    integer, parameter :: place(5) = [5, 2, 1, 4, 3]
    integer :: k
    ring = new_ring(0.010_dp, 0.015_dp, 207e9_dp, 0.3_dp, 3)
    call new_compliance(names, names, [(ring%compliance(place(k), place(k)), k=1, 5)], bore, error)
    call check%that(.not. allocated(error), 'a table of a ring is accepted')
    if (allocated(error)) return
    call check%that(all(bore%harmonic == ring%harmonic) .and. all(bore%is_sine .eqv. ring%is_sine), 'shapes of a table')
    call check%close_to(maxval(abs(bore%compliance - ring%compliance)), 0.0_dp, 0.0_dp, 'compliances of a table')
    call new_compliance(['0 ', '2c', '0 ', '2c'], ['0 ', '2c', '2c', '0 '], [1.0_dp, 1.0_dp, 0.2_dp, 0.1_dp], bore, error)
    call check%that(.not. allocated(error), 'the work of the shape 0 counts twice')
  end subroutine table_of_a_ring

  !> Each fault with its message.
  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    call refused(['1c'], ['1c'], [1e-12_dp], 'compliance 1c,1c: shapes are')
    call refused(['2x'], ['2c'], [1e-12_dp], 'compliance 2x,2c: shapes are')
    call refused(['33'], ['2c'], [1e-12_dp], 'compliance 33,2c: shapes are')
    call refused(['2c', '2c'], ['2c', '2c'], [1e-12_dp, 1e-12_dp], 'compliance 2c,2c is given twice')
    call refused(['2c', '2s', '2c'], ['2c', '2s', '2s'], [2e-12_dp, 2e-12_dp, 1e-12_dp], 'compliances of the shapes 2c and 2s')
    call refused(['2c'], ['2c'], [-1e-12_dp], 'compliances of the shapes 2c and 2c')

  contains

    subroutine refused(loads, shapes, values, message)
      character(len=*), intent(in) :: loads(:), shapes(:), message
      real(dp), intent(in) :: values(:)
      type(elastic_bore_t) :: bore
      type(error_t), allocatable :: error
      call new_compliance(loads, shapes, values, bore, error)
      call check%that(allocated(error), 'a wrong table of compliances is refused: '//message)
      if (.not. allocated(error)) return
      call check%begins_with(error%message, message, 'message of a wrong table of compliances')
      call check%that(error%status == status_case_file, 'status of a wrong table of compliances')
    end subroutine refused
  end subroutine refuses
end module test_ring
