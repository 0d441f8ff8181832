!> Contact geometries: forces against tables of an independent implementation (data/contact), derivatives against finite
!> differences, energies against closed forms and quadrature, continuity, extreme values, requirements on the bearing.
module test_contact_geometries
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use contact_law, only: contact_law_t
  use laws, only: contact_law_of
  use trace_row, only: trace_row_t
  implicit none
  private
  public :: run_test_contact_geometries

  character(len=*), parameter :: geometries(7) = [character(len=100) :: "geometry='hertz_sphere'", &
    "geometry='hertz_sphere' exponent=1.3", "geometry='johnson'", "geometry='conformal'", &
    "geometry='conformal' housing_compliance=-0.5", "geometry='pereira'", &
    "geometry='winkler' liner_modulus=3e9 liner_poissons_ratio=0.35 liner_thickness=0.5e-3"]
  real(dp), parameter :: e_star = 207e9_dp/(2*(1 - 0.3_dp**2))

contains

  subroutine run_test_contact_geometries(check)
    class(checks_t), intent(inout) :: check
    call forces_of_the_table(check)
    call conformal_force_of_the_table(check)
    call conformal_arc_and_pressure(check)
    call slopes_and_energies(check)
    call johnson_goes_on_straight(check)
    call conformal_meets_johnson(check)
    call winkler_by_quadrature(check)
    call pereira_between_its_branches(check)
    call laws_slopes(check)
    call extremes(check)
  end subroutine run_test_contact_geometries

  subroutine new_law(check, keys, law, bearing)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: keys
    class(contact_law_t), allocatable, intent(out) :: law
    type(bearing_t), intent(in), optional :: bearing
    type(error_t), allocatable :: error
    call contact_law_of(keys, law, error, bearing)
    if (allocated(error)) call check%that(.false., 'law '//keys//': '//error%message)
  end subroutine new_law

  !> Forces of four bearings for penetrations from a ten-thousandth to half of the clearance.
  subroutine forces_of_the_table(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: sphere, johnson, pereira, winkler
    type(bearing_t) :: bearing
    character(len=300) :: line
    real(dp) :: row(12), depth
    integer :: unit, status, rows
    open (newunit=unit, file='data/contact/cylinder_force.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, *, iostat=status) row
      if (status /= 0) exit
      rows = rows + 1
      bearing = bearing_t(radius=row(3), length=row(2), clearance=row(1), rod_length=0.2_dp)
      depth = row(5)
      call new_law(check, trim(geometries(1)), sphere, bearing)
      call new_law(check, trim(geometries(3)), johnson, bearing)
      call new_law(check, trim(geometries(6)), pereira, bearing)
      call new_law(check, trim(geometries(7)), winkler, bearing)
      call check%relative(sphere%geometry%elastic_force(depth), row(6), 1e-9_dp, 'force of the spheres')
      call check%relative(pereira%geometry%elastic_force(depth), row(8), 1e-9_dp, 'force by Pereira')
      call check%relative(winkler%geometry%elastic_force(depth), row(11), 1e-9_dp, 'force of the Winkler foundation')
      call check%relative(winkler%geometry%elastic_energy(depth), row(12), 1e-7_dp, 'energy of the Winkler foundation')
      if (depth > 0.3001_dp*row(1)) cycle
      call check%relative(johnson%geometry%elastic_force(depth), row(7), 1e-9_dp, 'force by Johnson')
      call check%relative(johnson%geometry%slope(depth, johnson%geometry%elastic_force(depth)), row(9), 1e-9_dp, &
        'stiffness by Johnson')
      call check%relative(johnson%geometry%elastic_energy(depth), row(10), 1e-9_dp, 'energy by Johnson')
    end do
    close (unit)
    call check%that(rows == 28, 'the table of forces has 28 rows')
  end subroutine forces_of_the_table

  subroutine conformal_force_of_the_table(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    character(len=200) :: line
    real(dp) :: row(5)
    integer :: unit, status, rows
    open (newunit=unit, file='data/contact/conformal_force.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, *, iostat=status) row
      if (status /= 0) exit
      rows = rows + 1
      write (line, '(a,f11.9)') "geometry='conformal' housing_compliance=", row(3)
      call new_law(check, trim(line), law, bearing_t(radius=10e-3_dp, length=row(2), clearance=row(1), rod_length=0.2_dp))
      call check%relative(law%geometry%elastic_force(row(4)), row(5), 1e-9_dp, 'conformal force')
    end do
    close (unit)
    call check%that(rows == 42, 'the table of conformal forces has 42 rows')
  end subroutine conformal_force_of_the_table

  !> Half-angle, force and pressure from 1 to 83 degrees from a collocation of the exact problem: a penetration of g(x) + W x has
  !> the load x within the accuracy of the fit, and the columns of the trace have its angle and pressure.
  subroutine conformal_arc_and_pressure(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(trace_row_t) :: row
    character(len=200) :: line
    real(dp) :: angle, x, persson, g, pressure, force, depth
    real(dp), parameter :: c = 1e-4_dp, length = 0.02_dp, radius = 10e-3_dp
    integer :: unit, status, rows
    call new_law(check, "geometry='conformal' housing_compliance=0.7", law, &
      bearing_t(radius=radius, length=length, clearance=c, rod_length=0.2_dp))
    open (newunit=unit, file='data/contact/conformal.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, *, iostat=status) angle, x, persson, g, pressure
      if (status /= 0) exit
      rows = rows + 1
      depth = c*(g + 0.7_dp*x)
      force = law%geometry%elastic_force(depth)
      call check%relative(force, pi*e_star*length*c*x, 6e-5_dp, 'conformal force against the collocation')
      row%n = 0
      row%is_naming = .false.
      row%wanted = .true.
      call law%geometry%add_columns(depth, force, row)
      call check%relative(row%values(1), angle*pi/180, 4e-5_dp, 'contact half-angle against the collocation')
      call check%relative(row%values(2), pressure*e_star*c/radius, 6e-5_dp, 'pressure against the collocation')
      call law%geometry%add_columns(depth, 2*force, row)
      call check%relative(row%values(4), 2*row%values(2), 1e-14_dp, 'the pressure belongs to the whole normal force')
    end do
    close (unit)
    call check%that(rows == 21, 'the table of conformal contact has 21 rows')
    call law%geometry%add_columns(0.0_dp, 0.0_dp, row)
    call check%that(abs(row%values(5)) + abs(row%values(6)) <= 0, 'without contact there is neither arc nor pressure')
    call check%that(law%geometry%deepest > 15*c .and. law%geometry%deepest < 50*c, 'the fit ends beyond 83 degrees')
  end subroutine conformal_arc_and_pressure

  !> The derivative agrees with finite differences, the energy is the integral of the force, and a force multiplied by a factor has
  !> a derivative multiplied by it.
  subroutine slopes_and_energies(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    real(dp), parameter :: c = 20e-6_dp
    real(dp) :: depth, h, slope, force
    integer :: i, k
    do i = 1, size(geometries)
      call new_law(check, trim(geometries(i)), law)
      if (.not. allocated(law)) return
      associate (geometry => law%geometry)
        do k = -60, 20, 3
          depth = c*10.0_dp**(0.1_dp*k)
          h = 1e-3_dp*depth
          force = geometry%elastic_force(depth)
          slope = geometry%slope(depth, force)
          if (abs(depth/c - 0.3_dp) > 0.01_dp) call check%relative(slope, (8*(geometry%elastic_force(depth + h) &
            - geometry%elastic_force(depth - h)) - (geometry%elastic_force(depth + 2*h) - geometry%elastic_force(depth - 2*h))) &
            /(12*h), 1e-9_dp, 'slope of '//trim(geometries(i)))
          call check%relative((8*(geometry%elastic_energy(depth + h) - geometry%elastic_energy(depth - h)) &
            - (geometry%elastic_energy(depth + 2*h) - geometry%elastic_energy(depth - 2*h)))/(12*h), force, 1e-6_dp, &
            'force as the slope of the energy, '//trim(geometries(i)))
          call check%relative(geometry%slope(depth, 3*force), 3*slope, 1e-14_dp, 'slope of thrice the force')
        end do
      end associate
    end do
  end subroutine slopes_and_energies

  !> The law is continuous with its derivative at 0.3 c, and linear beyond.
  subroutine johnson_goes_on_straight(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    real(dp), parameter :: last = 0.3_dp*20e-6_dp, tiny_step = 1e-9_dp
    real(dp) :: below, above
    call new_law(check, "geometry='johnson'", law)
    associate (geometry => law%geometry)
      call check%relative(geometry%deepest, last, 1e-15_dp, 'the law holds up to 0.3 c')
      call check%relative(geometry%elastic_force(last), 12807.3566219_dp, 1e-11_dp, 'force at the end of the law')
      below = geometry%elastic_force(last*(1 - tiny_step))
      above = geometry%elastic_force(last*(1 + tiny_step))
      call check%relative(above, below, 4*tiny_step, 'the force is continuous at the end of the law')
      call check%relative(geometry%slope(last*(1 + tiny_step), above), geometry%slope(last*(1 - tiny_step), below), &
        10*tiny_step, 'the slope is continuous at the end of the law')
      call check%relative(geometry%slope(last*(1 + tiny_step), above), 3547319823.74_dp, 1e-8_dp, 'slope at the end of the law')
      call check%relative(geometry%elastic_force(3*last), 12807.3566219_dp + 2*last*3547319823.74_dp, 1e-10_dp, &
        'linear force beyond the law')
    end associate
  end subroutine johnson_goes_on_straight

  !> With W = ln 4 - 1 the conformal law is Johnson's at small loads.
  subroutine conformal_meets_johnson(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: johnson, conformal
    real(dp) :: depth
    integer :: i
    call new_law(check, "geometry='johnson'", johnson)
    call new_law(check, "geometry='conformal' housing_compliance=0.38629436112", conformal)
    do i = 3, 8
      depth = 20e-6_dp*10.0_dp**(-i)
      call check%relative(conformal%geometry%elastic_force(depth), johnson%geometry%elastic_force(depth), 4e-5_dp, &
        'conformal against Johnson at small loads')
    end do
  end subroutine conformal_meets_johnson

  !> The Winkler foundation as the sum of its springs.
  subroutine winkler_by_quadrature(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law, of_liner
    real(dp), parameter :: c = 20e-6_dp, k = 1e13_dp
    real(dp) :: depth, a, angle, overlap, force, energy
    integer :: i, j
    integer, parameter :: strips = 200000
    call new_law(check, "geometry='winkler' bedding_modulus=1e13", law)
    do i = -6, 1
      depth = c*10.0_dp**i
      a = atan(sqrt(depth/c*(2 + depth/c)))
      force = 0
      energy = 0
      do j = 1, strips
        angle = a*(j - 0.5_dp)/strips
        overlap = depth - 2*(c + depth)*sin(angle/2)**2
        force = force + k*overlap*cos(angle)
        energy = energy + k*overlap**2/2
      end do
      call check%relative(law%geometry%elastic_force(depth), force*2*a/strips*10e-3_dp*15e-3_dp, 1e-9_dp, &
        'force of the foundation as a sum of springs')
      call check%relative(law%geometry%elastic_energy(depth), energy*2*a/strips*10e-3_dp*15e-3_dp, 1e-9_dp, &
        'energy of the foundation as a sum of springs')
    end do
    call new_law(check, trim(geometries(7)), of_liner)
    call check%relative(of_liner%geometry%elastic_force(1e-6_dp)/law%geometry%elastic_force(1e-6_dp), &
      3e9_dp*0.65_dp/(1.35_dp*0.3_dp*0.5e-3_dp)/k, 1e-14_dp, 'foundation modulus of a liner')
    call check%relative(of_liner%geometry%deepest, 0.5e-3_dp, 1e-15_dp, 'the law of a liner holds up to its thickness')
    call check%that(law%geometry%deepest > 1e300_dp, 'a foundation has no limit')
  end subroutine winkler_by_quadrature

  !> The two branches of the exponent meet at c = 0.34954 mm.
  subroutine pereira_between_its_branches(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: below, above
    call new_law(check, "geometry='pereira'", below, bearing_t(10e-3_dp, 15e-3_dp, 0.349539e-3_dp, 0.2_dp))
    call new_law(check, "geometry='pereira'", above, bearing_t(10e-3_dp, 15e-3_dp, 0.349541e-3_dp, 0.2_dp))
    call check%relative(above%geometry%elastic_force(3e-6_dp), below%geometry%elastic_force(3e-6_dp), 1e-4_dp, &
      'Pereira''s branches are continuous')
  end subroutine pereira_between_its_branches

  !> Derivatives of the whole force with every kind of damping, against finite differences.
  subroutine laws_slopes(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: damping(5) = [character(len=50) :: "law='hertz'", "law='flores' restitution=0.6", &
      "law='exact' dissipation=0.3", "law='impact' damping=300 full_damping_depth=5e-6", "law='gonthier' restitution=0.01"]
    class(contact_law_t), allocatable :: law
    real(dp), parameter :: impact = 0.2_dp
    real(dp) :: depth, rate, h, stiffness, loss
    integer :: i, j, k
    do i = 1, size(geometries)
      do j = 1, size(damping)
        call new_law(check, trim(damping(j))//' '//trim(geometries(i)), law)
        if (.not. allocated(law)) return
        do k = -8, 8
          depth = 1e-6_dp*2.1_dp**(k/4)
          rate = 0.02_dp*k
          call law%normal_force_slopes(depth, rate, impact, stiffness, loss)
          if (law%normal_force(depth, rate - 1e-3_dp, impact) <= 0 .neqv. law%normal_force(depth, rate + 1e-3_dp, impact) <= 0) &
            cycle
          if (law%normal_force(depth*0.99_dp, rate, impact) <= 0 .neqv. law%normal_force(depth*1.01_dp, rate, impact) <= 0) cycle
          h = 1e-4_dp*depth
          call check%close_to(stiffness, (law%normal_force(depth + h, rate, impact) - law%normal_force(depth - h, rate, impact)) &
            /(2*h), 1e-6_dp*(abs(stiffness) + 1e6_dp), 'stiffness of '//trim(damping(j))//' '//trim(geometries(i)))
          call check%close_to(loss, (law%normal_force(depth, rate + 1e-4_dp, impact) &
            - law%normal_force(depth, rate - 1e-4_dp, impact))/2e-4_dp, 1e-6_dp*(abs(loss) + 1), &
            'damping of '//trim(damping(j))//' '//trim(geometries(i)))
        end do
      end do
    end do
  end subroutine laws_slopes

  !> The force is finite and never negative, for any state that an integrator may try, and at the ends of every parameter range.
  subroutine extremes(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: keys(14) = [character(len=100) :: "geometry='johnson' youngs_modulus=2*1e6", &
      "geometry='johnson' youngs_modulus=2*1e13 poissons_ratio=2*0.5", "geometry='johnson' poissons_ratio=0,0.5", &
      "geometry='conformal' housing_compliance=-0.5", "geometry='conformal' housing_compliance=100", &
      "geometry='conformal' housing_compliance=0 youngs_modulus=1e6,1e13", "geometry='pereira' youngs_modulus=2*1e13", &
      "geometry='winkler' bedding_modulus=1e5", "geometry='winkler' bedding_modulus=1e20", &
      "geometry='winkler' liner_modulus=1e6 liner_thickness=1e-6 liner_poissons_ratio=0.49", "law='exact' restitution=0.01", &
      "law='impact' damping=1e10 full_damping_depth=1e-12", "law='impact' damping=0 full_damping_depth=1", &
      "law='zhiying_qishao' dissipation=1e6"]
    real(dp), parameter :: sizes(8) = [1e-310_dp, 1e-300_dp, 1e-20_dp, 1e-6_dp, 6e-6_dp, 1.0_dp, 1e10_dp, 1e80_dp]
    class(contact_law_t), allocatable :: law
    real(dp) :: force, previous, stiffness, damping
    integer :: i, j, k, m, direction
    do i = 1, size(keys)
      call new_law(check, trim(keys(i)), law)
      if (.not. allocated(law)) return
      previous = 0
      do j = 1, size(sizes)
        force = law%geometry%elastic_force(sizes(j))
        call check%that(force >= previous .and. force <= huge(force), 'the elastic force grows and is finite: '//trim(keys(i)))
        previous = force
        do k = 1, size(sizes)
          do m = 1, size(sizes)
            do direction = -1, 1, 2
              force = law%normal_force(sizes(j), direction*sizes(k), sizes(m))
              call check%that(force >= 0 .and. force <= huge(force), 'finite for extreme inputs: '//trim(keys(i)))
            end do
          end do
        end do
      end do
      do j = 3, 6
        call law%normal_force_slopes(sizes(j), 0.1_dp, 0.2_dp, stiffness, damping)
        call check%that(stiffness >= 0 .and. stiffness <= huge(stiffness) .and. damping >= 0 .and. damping <= huge(damping), &
          'finite slopes: '//trim(keys(i)))
      end do
    end do
  end subroutine extremes
end module test_contact_geometries
