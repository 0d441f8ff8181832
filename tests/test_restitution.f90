!> The restitution of contact laws: free impacts, integrated by the program, under every law in every geometry, against tables of
!> an independent implementation (data/contact) and closed forms.
module test_restitution
  use kinds, only: dp
  use error_handling, only: error_t
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use contact_law, only: contact_law_t
  use laws, only: contact_law_of
  use free_impact, only: speed_given_back, exact_restitution
  use impact_problem, only: impact_t, run_impact
  implicit none
  private
  public :: run_test_restitution

  character(len=*), parameter :: geometries(5) = [character(len=100) :: "geometry='hertz_sphere'", "geometry='johnson'", &
    "geometry='conformal'", "geometry='pereira'", &
    "geometry='winkler' liner_modulus=3e9 liner_poissons_ratio=0.35 liner_thickness=0.5e-3"]
  real(dp), parameter :: mass = 0.14_dp, speed = 0.5_dp, lasts = 4e-5_dp

contains

  subroutine run_test_restitution(check)
    class(checks_t), intent(inout) :: check
    call restitution_by_the_table(check)
    call impacts_by_the_table(check)
    call exact_gives_back_what_it_says(check)
    call energy_at_the_deepest_point(check)
    call dissipation_in_place_of_restitution(check)
    call impact_force(check)
    call slow_impacts_lose_less(check)
  end subroutine run_test_restitution

  !> Pin and bearing of the table of impacts.
  pure type(bearing_t) function bearing()
    bearing = bearing_t(radius=10e-3_dp, length=15e-3_dp, clearance=0.1e-3_dp, rod_length=0.2_dp)
  end function bearing

  subroutine new_law(check, keys, law)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: keys
    class(contact_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable :: error
    call contact_law_of(keys, law, error, bearing())
    if (allocated(error)) call check%that(.false., 'law '//keys//': '//error%message)
  end subroutine new_law

  !> chi and the restitution of an impact, for e from 0.1 to 0.99, in any geometry.
  subroutine restitution_by_the_table(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(impact_t) :: impact
    character(len=30) :: name
    character(len=60) :: loss
    character(len=200) :: line
    real(dp) :: e, chi, back, depth, force, duration
    integer :: unit, status, rows, i
    character(len=5), parameter :: methods(3) = ['adams', 'radau', 'auto ']
    open (newunit=unit, file='data/contact/restitution.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, *, iostat=status) name, e, chi, back, depth, force, duration
      if (status /= 0) exit
      rows = rows + 1
      if (name == 'carvalho_martins' .and. e < 1/3.0_dp) cycle   ! there the table has the formula nevertheless
      write (loss, '(3a,f5.3)') "law='", trim(name), "' restitution=", e
      do i = 1, size(geometries)
        call new_law(check, trim(loss)//' '//trim(geometries(i)), law)
        if (.not. allocated(law)) return
        call check%relative(law%damping, chi, 1e-10_dp, 'damping of '//trim(name))
        impact = run_impact(law, mass, speed, lasts, trim(methods(modulo(i + rows, 3) + 1)), 1e-10_dp)
        call check%close_to(impact%restitution, back, 1e-8_dp, 'restitution of '//trim(name)//', '//trim(geometries(i)(10:22)))
      end do
      call new_law(check, trim(loss)//' exponent=1.5 stiffness=1', law)   ! scaled: mass, speed and stiffness 1
      impact = run_impact(law, 1.0_dp, 1.0_dp, 3.0_dp, 'adams', 1e-10_dp)
      call check%close_to(impact%depth, depth, 1e-8_dp, 'depth under '//trim(name))
      call check%close_to(law%geometry%elastic_force(impact%depth), force, 3e-8_dp, 'elastic force under '//trim(name))
      call check%relative(impact%duration, duration, 1e-8_dp, 'duration under '//trim(name))
    end do
    close (unit)
    call check%that(rows == 88, 'the table of restitution has eight laws and eleven coefficients')
  end subroutine restitution_by_the_table

  !> Depth, force and duration of one impact in four geometries under three laws.
  subroutine impacts_by_the_table(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(impact_t) :: impact
    character(len=30) :: geometry, name
    character(len=200) :: line
    real(dp) :: e, m, v, back, depth, force, duration
    integer :: unit, status, rows, i
    open (newunit=unit, file='data/contact/impacts.csv', status='old', action='read')
    read (unit, '(a)') line
    rows = 0
    do
      read (unit, *, iostat=status) geometry, name, e, m, v, back, depth, force, duration
      if (status /= 0) exit
      rows = rows + 1
      do i = 1, size(geometries)
        if (index(geometries(i), "geometry='"//trim(geometry)//"'") /= 1) cycle
        write (line, '(3a,f5.3,2a)') "law='", trim(name), "' restitution=", e, ' ', trim(geometries(i))
        call new_law(check, trim(line), law)
        if (.not. allocated(law)) return
        impact = run_impact(law, m, v, lasts, 'adams', 1e-11_dp)
        call check%close_to(impact%restitution, back, 1e-9_dp, 'restitution in '//trim(geometry))
        call check%relative(impact%depth, depth, 1e-9_dp, 'depth in '//trim(geometry))
        call check%relative(law%geometry%elastic_force(impact%depth), force, 1e-9_dp, 'force at the deepest point in '// &
          trim(geometry))
        call check%relative(impact%duration, duration, 1e-8_dp, 'duration in '//trim(geometry))
      end do
    end do
    close (unit)
    call check%that(rows == 12, 'the table of impacts has twelve rows')
  end subroutine impacts_by_the_table

  !> Law `exact` from 0.01 to nearly 1, by the closed form of a free impact; includes the range in which the series of chi is used.
  subroutine exact_gives_back_what_it_says(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    real(dp), parameter :: e(9) = [0.01_dp, 0.02_dp, 0.05_dp, 0.5_dp, 0.9_dp, 0.999_dp, 0.9998_dp, 0.99991_dp, 1.0_dp]
    character(len=60) :: keys
    integer :: i
    do i = 1, size(e)
      write (keys, '(a,f8.6)') "law='exact' restitution=", e(i)
      call new_law(check, trim(keys), law)
      call check%close_to(exact_restitution(law%damping), e(i), merge(1e-11_dp, 3e-8_dp, e(i) < 0.99_dp), &
        'root of the restitution equation under exact')
    end do
    call new_law(check, "law='exact' restitution=0.9998", law)
    call check%relative(law%damping, 1.5_dp*2e-4_dp*1.0002_dp, 1e-7_dp, 'chi of exact next to 1')
    call new_law(check, "law='exact' restitution=0.5", law)
    call check%relative(law%damping, 1.43275053_dp, 1e-8_dp, 'chi of exact for one half')
    call new_law(check, "law='carvalho_martins' restitution=0.2", law)
    call check%relative(law%damping, 4.8_dp, 1e-14_dp, 'chi of Carvalho and Martins below a third is that of Gonthier')
    call new_law(check, "law='carvalho_martins' restitution=0.33333333333", law)
    call check%relative(law%damping, 8/3.0_dp, 1e-9_dp, 'chi of Carvalho and Martins at the boundary')
    call new_law(check, "law='carvalho_martins' restitution=0.33333333334", law)
    call check%relative(law%damping, 8/3.0_dp, 1e-9_dp, 'chi of Carvalho and Martins above the boundary')
  end subroutine exact_gives_back_what_it_says

  !> U(delta_max) = m v^2 J, J = 1/chi - ln(1 + chi)/chi^2, in every geometry.
  subroutine energy_at_the_deepest_point(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(impact_t) :: impact
    real(dp) :: chi
    integer :: i
    do i = 1, size(geometries)
      call new_law(check, "law='gonthier' restitution=0.4 "//trim(geometries(i)), law)
      if (.not. allocated(law)) return
      chi = (1 - 0.4_dp**2)/0.4_dp
      impact = run_impact(law, mass, speed, lasts, 'adams', 1e-11_dp)
      call check%relative(law%geometry%elastic_energy(impact%depth), mass*speed**2*(1/chi - log(1 + chi)/chi**2), &
        merge(3e-6_dp, 1e-8_dp, index(geometries(i), 'conformal') > 0), 'elastic energy at the deepest point, '// &
        trim(geometries(i)(10:22)))
      call new_law(check, "law='hertz' "//trim(geometries(i)), law)
      impact = run_impact(law, mass, speed, lasts, 'adams', 1e-11_dp)
      call check%close_to(impact%restitution, 1.0_dp, 1e-9_dp, 'an elastic impact, '//trim(geometries(i)(10:22)))
    end do
  end subroutine energy_at_the_deepest_point

  !> f (1 + a rate): a free impact at v is that of chi = a v, for any law and any speed.
  subroutine dissipation_in_place_of_restitution(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(impact_t) :: impact
    real(dp), parameter :: speeds(3) = [2.0_dp, 0.1_dp, 1e-6_dp]
    integer :: i
    call new_law(check, "law='flores' dissipation=1.25", law)
    do i = 1, size(speeds)
      impact = run_impact(law, mass, speeds(i), 5e-5_dp*speeds(i)**(-0.2_dp), 'adams', 1e-10_dp)
      call check%close_to(impact%restitution, exact_restitution(1.25_dp*speeds(i)), 1e-8_dp, 'restitution of a dissipation')
    end do
    call check%relative(law%normal_force(1e-6_dp, -0.4_dp, 0.0_dp), 0.5_dp*law%geometry%elastic_force(1e-6_dp), 1e-15_dp, &
      'the force with a dissipation does not depend on the impact speed')
    call check%that(abs(law%normal_force(1e-6_dp, -0.9_dp, 0.0_dp)) <= 0, 'the force with a dissipation never pulls')
  end subroutine dissipation_in_place_of_restitution

  !> F = max(0, f + c step(delta) rate).
  subroutine impact_force(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(impact_t) :: impact
    real(dp) :: elastic, previous
    integer :: i
    call new_law(check, "law='impact' damping=200 full_damping_depth=4e-6 stiffness=1e8 exponent=1", law)
    elastic = 1e8_dp*1e-6_dp
    call check%relative(law%normal_force(1e-6_dp, 0.5_dp, 0.1_dp), elastic + 200*(3/16.0_dp - 2/64.0_dp)*0.5_dp, 1e-14_dp, &
      'damping at a quarter of the depth of full damping')
    call check%relative(law%normal_force(4e-6_dp, 0.5_dp, 0.1_dp), 4*elastic + 100, 1e-14_dp, 'full damping')
    call check%relative(law%normal_force(8e-6_dp, 0.5_dp, 0.1_dp), 8*elastic + 100, 1e-14_dp, 'full damping beyond its depth')
    call check%that(abs(law%normal_force(4e-6_dp, -3.0_dp, 0.1_dp)) <= 0, 'the force of law impact never pulls')
    ! With full damping from the beginning and a linear spring: a damped oscillator, released where the force is 0.
    call new_law(check, "law='impact' damping=400 full_damping_depth=1e-12 stiffness=1e8 exponent=1", law)
    impact = run_impact(law, mass, speed, 1e-4_dp, 'radau', 1e-10_dp)
    call check%close_to(impact%restitution, oscillator(400.0_dp, 1e8_dp), 1e-6_dp, 'a damped oscillator')
    previous = 1
    do i = 1, 5
      impact = run_impact(law, mass*3.0_dp**(2 - i), speed, 1e-4_dp, 'auto', 1e-9_dp)
      call check%that(impact%restitution > 0 .and. impact%restitution < previous, 'restitution decreases with the mass')
      previous = impact%restitution
    end do

  contains

    !> exp(-zeta t*) of the damped oscillator at the time at which its force becomes 0; the mass then moves freely.
    real(dp) function oscillator(c, k) result(back)
      real(dp), intent(in) :: c, k
      real(dp) :: decay, w, angle
      decay = c/(2*mass)
      w = sqrt(k/mass - decay**2)
      angle = 2*atan2(w, decay)   ! w t where k x + c x' = 0
      back = -exp(-decay*angle/w)*(cos(angle) - decay/w*sin(angle))
    end function oscillator
  end subroutine impact_force

  !> From 1e-3 to 1e-15 m/s the restitution of a free impact is that of the exact solution of the law for chi v/least_impact_speed:
  !> never above 1, and larger for slower impacts.
  subroutine slow_impacts_lose_less(check)
    class(checks_t), intent(inout) :: check
    class(contact_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp), parameter :: restitution(4) = [0.0_dp, 0.5_dp, 0.9_dp, 1.0_dp]
    real(dp) :: speed, back, previous
    character(len=40) :: keys
    integer :: i, power
    do i = 1, size(restitution)
      write (keys, '(a,f3.1)') 'stiffness=1e9 restitution=', restitution(i)
      call contact_law_of(trim(keys), law, error)
      previous = 0
      do power = 3, 15
        speed = 10.0_dp**(-power)
        back = speed_given_back(law, 1e9_dp, 1.5_dp, speed, 4000, 40000)
        call check%that(back > 0 .and. back <= 1 + 1e-9_dp, 'restitution of a slow impact is at most 1')
        call check%that(back >= previous - 1e-7_dp, 'restitution is larger for slower impacts')
        call check%close_to(back, exact_restitution(law%damping*min(1.0_dp, speed/law%least_impact_speed)), 1e-6_dp, &
          'slow free impact')
        previous = back
      end do
      call check%close_to(previous, 1.0_dp, 1e-6_dp, 'restitution of the slowest impact')
    end do
  end subroutine slow_impacts_lose_less
end module test_restitution
