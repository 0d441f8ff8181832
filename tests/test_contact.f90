!> The contact laws: stiffness, restitution, loss, limits, a force that is lost.
module test_contact
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use contact_law, only: contact_law_t, ratio_limit
  use laws, only: contact_law_of
  use bearing_size, only: bearing_t
  use hertz_sphere, only: hertz_sphere_t
  use free_impact, only: speed_given_back, exact_restitution
  use winkler, only: winkler_t
  use adams_impact, only: adams_impact_t
  implicit none
  private
  public :: run_test_contact

  real(dp), parameter :: bearing_radius = 10e-3_dp, clearance = 20e-6_dp
  real(dp), parameter :: c = 1e-4_dp   !! clearance of the case [m]

contains

  subroutine run_test_contact(check)
    class(checks_t), intent(inout) :: check
    call test_stiffness(check)
    call test_restitution(check)
    call test_hertz(check)
    call test_dissipation(check)
    call test_extremes(check)
    call share_and_rate(check)
  end subroutine run_test_contact

  subroutine test_stiffness(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: clearances(5) = [0.5e-3_dp, 0.1e-3_dp, 0.01e-3_dp, 40e-6_dp, 20e-6_dp]
    real(dp), parameter :: expected(5) = [6.610198e10_dp, 1.508882e11_dp, 4.793144e11_dp, 2.392971e11_dp, 3.387568e11_dp]
    real(dp), parameter :: steel(2) = 207e9_dp, ratio(2) = 0.3_dp
    type(hertz_sphere_t) :: pair
    integer :: i
    do i = 1, size(clearances)
      call check%relative(hertz_stiffness(bearing_radius, clearances(i), steel, ratio), expected(i), 2e-7_dp, &
        'Hertz stiffness of steel')
    end do
    call check%relative(hertz_stiffness(10e-3_dp, 0.5e-3_dp, [1e9_dp, 3e9_dp], [0.0_dp, 0.5_dp]), &
      4/(3*(1/1e9_dp + 0.75_dp/3e9_dp))*sqrt(10e-3_dp*9.5e-3_dp/0.5e-3_dp), 1e-14_dp, 'Hertz stiffness of two materials')
    pair%youngs_modulus = [207e9_dp, 100e9_dp]
    pair%density = [7850.0_dp, 2500.0_dp]
    call check%relative(pair%fastest_impact(), 0.05135117_dp, 1e-6_dp, &
      'limit of the impact speed is that of the slower material')
    pair%youngs_modulus(2) = 70e9_dp
    pair%density(2) = 8000
    call check%relative(pair%fastest_impact(), 0.0295804_dp, 1e-6_dp, 'limit of the impact speed with the materials exchanged')

  contains

    !> Stiffness of a pin in a bearing [N/m^1.5].
    real(dp) function hertz_stiffness(radius, clearance, youngs_modulus, poissons_ratio)
      real(dp), intent(in) :: radius, clearance, youngs_modulus(2), poissons_ratio(2)
      type(hertz_sphere_t) :: geometry
      geometry%youngs_modulus = youngs_modulus
      geometry%poissons_ratio = poissons_ratio
      call geometry%prepare(bearing_t(radius=radius, clearance=clearance))
      hertz_stiffness = geometry%stiffness
    end function hertz_stiffness
  end subroutine test_stiffness

  !> A free impact has the restitution of the exact solution of the law.
  subroutine test_restitution(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: e(4) = [0.9_dp, 0.7_dp, 0.5_dp, 0.3_dp]
    real(dp), parameter :: expected(4) = [0.913176677806_dp, 0.795972595365_dp, 0.725241114010_dp, 0.684224605749_dp]
    !> Values from an independent integration with 13 digits.
    real(dp), parameter :: hunt_crossley(4) = [0.9090157413492_dp, 0.76799978907848_dp, 0.66296220000155_dp, 0.58128804180857_dp]
    integer :: i
    real(dp) :: exact
    do i = 1, size(e)
      exact = exact_restitution(chi_of(e(i)))
      call check%close_to(exact, expected(i), 1e-11_dp, 'root of the restitution equation')
      call check%close_to(impact_restitution('lankarani_nikravesh', e(i), 1.5_dp), exact, 1e-6_dp, 'free impact')
    end do
    do i = 1, size(e)
      exact = exact_restitution(1.5_dp*(1 - e(i)))
      call check%close_to(exact, hunt_crossley(i), 1e-11_dp, 'root of the restitution equation, Hunt and Crossley')
      call check%close_to(impact_restitution('hunt_crossley', e(i), 1.5_dp), hunt_crossley(i), 1e-6_dp, &
        'free impact, Hunt and Crossley')
    end do
    call check%close_to(impact_restitution('lankarani_nikravesh', 0.5_dp, 1.2_dp), exact_restitution(chi_of(0.5_dp)), 1e-6_dp, &
      'free impact, exponent 1.2')
    call check%close_to(impact_restitution('hertz', 0.5_dp, 1.5_dp), 1.0_dp, 1e-6_dp, 'free Hertz impact is elastic')
  end subroutine test_restitution

  !> The damping of Lankarani and Nikravesh for a coefficient of restitution.
  pure real(dp) function chi_of(restitution)
    real(dp), intent(in) :: restitution
    chi_of = 0.75_dp*(1 - restitution**2)
  end function chi_of

  !> Restitution of a free impact at 0.4 m/s under a law from the factory.
  function impact_restitution(name, restitution, exponent) result(ratio)
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: restitution, exponent
    real(dp) :: ratio
    class(contact_law_t), allocatable :: law
    type(error_t), allocatable :: error
    character(len=100) :: keys
    write (keys, '(3a,f4.2,a,f4.2)') "law='", name, "' stiffness=1e9 restitution=", restitution, ' exponent=', exponent
    call contact_law_of(trim(keys), law, error)
    ratio = speed_given_back(law, 1e9_dp, exponent, 0.4_dp, 20000, 80000)
  end function impact_restitution

  subroutine test_hertz(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: hertz, lossless, linear
    type(error_t), allocatable :: error
    real(dp) :: rates(5)
    integer :: i
    rates = [-1.0_dp, -0.01_dp, 0.0_dp, 0.01_dp, 1.0_dp]
    call contact_law_of("law='hertz'", hertz, error)
    call contact_law_of("law='lankarani_nikravesh' restitution=1.0", lossless, error)
    call contact_law_of("law='hertz' exponent=1.0 stiffness=2e6", linear, error)
    call check%relative(hertz%normal_force(1e-6_dp, 0.1_dp, 0.2_dp), 338.7568_dp, 1e-6_dp, 'Hertz force at 1 um')
    call check%relative(linear%normal_force(1e-6_dp, 0.1_dp, 0.2_dp), 2.0_dp, 1e-14_dp, 'linear force at 1 um')
    do i = 1, size(rates)
      call check%relative(lossless%normal_force(3e-6_dp, rates(i), 0.1_dp), hertz%normal_force(3e-6_dp, rates(i), 0.1_dp), &
        1e-15_dp, 'Lankarani-Nikravesh with e = 1 is Hertz')
      call check%relative(lossless%normal_force(3e-6_dp, rates(i), 0.0_dp), hertz%normal_force(3e-6_dp, rates(i), 0.0_dp), &
        1e-15_dp, 'Lankarani-Nikravesh with e = 1 is Hertz after an impact at zero speed')
    end do
    call check%that(abs(hertz%normal_force(-1e-6_dp, 0.1_dp, 0.2_dp)) <= 0, 'no Hertz force at a distance')
    call check%that(abs(hertz%normal_force(0.0_dp, 0.1_dp, 0.2_dp)) <= 0, 'no Hertz force at the beginning of contact')
  end subroutine test_hertz

  !> The law never pulls; its force is at least the elastic force during compression and at most the elastic force during
  !> restitution.
  subroutine test_dissipation(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law, elastic
    type(error_t), allocatable :: error
    real(dp) :: impact, rate, force, reference, previous
    integer :: i, j
    call contact_law_of('restitution=0.3', law, error)
    call contact_law_of("law='hertz'", elastic, error)
    reference = elastic%normal_force(2e-6_dp, 0.0_dp, 0.0_dp)
    do i = 0, 12
      impact = 0.1_dp**i
      if (i == 12) impact = 0
      previous = 0
      do j = -400, 400
        rate = 0.01_dp*j
        force = law%normal_force(2e-6_dp, rate, impact)
        call check%that(force >= 0, 'the contact force never pulls')
        call check%that((force - reference)*rate >= 0, 'the contact dissipates')
        call check%that(force >= previous, 'the force grows with the rate')
        call check%that(force <= reference*(1 + ratio_limit), 'the force has an upper limit')
        previous = force
      end do
      call check%relative(law%normal_force(2e-6_dp, 0.0_dp, impact), reference, 1e-15_dp, &
        'the force without penetration rate is elastic')
    end do
    call check%relative(law%normal_force(2e-6_dp, 0.03_dp, 0.1_dp), reference*(1 + 0.75_dp*0.91_dp*0.3_dp), 1e-14_dp, &
      'the printed law inside its bounds')
    call check%relative(law%normal_force(2e-6_dp, 0.99_dp*ratio_limit*0.01_dp, 0.01_dp), &
      reference*(1 + 0.75_dp*0.91_dp*0.99_dp*ratio_limit), 1e-14_dp, 'the printed law just inside the limit')
    call check%that(abs(law%normal_force(2e-6_dp, -0.2_dp, 0.1_dp)) <= 0, 'no adhesion')
    call check%that(abs(law%normal_force(2e-6_dp, -1e-4_dp, 0.0_dp)) <= 0, &
      'no force during restitution after an impact at zero speed')
    call check%relative(law%normal_force(2e-6_dp, 0.01_dp, 0.0_dp), reference*(1 + 0.75_dp*0.91_dp*ratio_limit), 1e-14_dp, &
      'the limit of the force during compression after an impact at zero speed')
    call check%that(abs(law%normal_force(0.0_dp, 0.1_dp, 0.1_dp)) <= 0, 'no force at the beginning of contact')
    call check%that(abs(law%normal_force(-1e-6_dp, 0.1_dp, 0.1_dp)) <= 0, 'no force at a distance')
  end subroutine test_dissipation

  subroutine test_extremes(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp), parameter :: sizes(8) = [0.0_dp, 1e-310_dp, 1e-300_dp, 1e-20_dp, 1e-6_dp, 1.0_dp, 1e10_dp, 1e100_dp]
    real(dp) :: force
    integer :: i, j, k, direction
    call contact_law_of('', law, error)
    do i = 1, size(sizes)
      do j = 1, size(sizes)
        do k = 1, size(sizes)
          do direction = -1, 1, 2
            force = law%normal_force(sizes(i), direction*sizes(j), sizes(k))
            call check%that(force >= 0 .and. force <= huge(force), 'finite for extreme inputs')
          end do
        end do
      end do
    end do
  end subroutine test_extremes

  !> The share is the force over the elastic force, and its rate the derivative along the motion. It is 1 where the contact ends.
  subroutine share_and_rate(check)
    class(checks_t), intent(inout) :: check
    type(adams_impact_t) :: law
    real(dp), parameter :: depth(3) = [1e-7_dp, 9e-7_dp, 3e-6_dp], speed = -0.02_dp, acceleration = 3e4_dp, dt = 1e-9_dp
    real(dp) :: share, rate, before, after, unused, elastic
    integer :: i
    law = adams_impact_t(full_damping=5e3_dp, full_damping_depth=1e-6_dp)
    allocate (law%geometry, source=winkler_t(given_modulus=1e13_dp))
    call law%prepare(bearing_t(0.01_dp, 0.04_dp, c, 0.2_dp))
    do i = 1, size(depth)
      call law%find_share(depth(i), speed, acceleration, share, rate)
      elastic = law%geometry%elastic_force(depth(i))
      call check%relative(max(0.0_dp, share)*elastic, law%normal_force(depth(i), speed, 1.0_dp), 1e-12_dp, 'share of the force')
      call law%find_share(depth(i) - speed*dt, speed - acceleration*dt, acceleration, before, unused)
      call law%find_share(depth(i) + speed*dt, speed + acceleration*dt, acceleration, after, unused)
      call check%relative((after - before)/(2*dt), rate, 1e-5_dp, 'its rate')
    end do
    call law%find_share(-1e-12_dp, speed, acceleration, share, rate)
    call check%that(share > 1 .and. share < 1 + 1e-5_dp .and. rate > 0, 'the share increases beyond 1 after the contact')
    call check%that(abs(law%normal_force(1e-6_dp, -1e3_dp, 1.0_dp)) <= 0, 'a contact never pulls')
  end subroutine share_and_rate
end module test_contact
