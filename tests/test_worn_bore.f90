!> The worn bore: its force against the closed form of a round one and against the gradient of an energy from another quadrature;
!> wear under a constant load against the table of an independent implementation; runs whose bore changes, and errors in cases.
module test_worn_bore
  use kinds, only: dp
  use constants, only: two_pi
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use archard_wear, only: worn_surface_t, of_bore
  use worn_bore, only: worn_bore_t, touching_cells_t
  use winkler, only: winkler_t
  use case_checks, only: expect, methods_agree
  use collecting_sink, only: trace_t, run_case, load_table, column
  implicit none
  private
  public :: run_test_worn_bore

  character(len=*), parameter :: file = 'cases/wear/worn_bore.nml'
  real(dp), parameter :: c = 1e-4_dp, radius = 10e-3_dp, length = 15e-3_dp, modulus = 1e13_dp   !! of the tables [m], [Pa/m]

contains

  subroutine run_test_worn_bore(check)
    class(checks_t), intent(inout) :: check
    call round_is_round(check)
    call force_is_gradient(check)
    call touches_on_two_arcs(check)
    call wears_under_constant_load(check)
    call bore_changes(check)
    call steps_are_limited(check)
    call methods_agree_when_worn(check)
    call last_change_counts(check)
    call refuses(check)
  end subroutine run_test_worn_bore

  type(worn_bore_t) function new_bore(bins) result(bore)
    integer, intent(in) :: bins
    call bore%prepare(bins, c, modulus*radius*length)
  end function new_bore

  !> A bore without wear has the force, the penetration and the energy of the foundation in closed form.
  subroutine round_is_round(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: depths(5) = c*[1e-4_dp, 1e-3_dp, 1e-2_dp, 0.1_dp, 1.0_dp]
    type(worn_bore_t) :: bore
    type(winkler_t) :: round
    real(dp) :: e(2), force(2), total, gap, gradient(2)
    integer :: i, k
    round%given_modulus = modulus
    call round%prepare(bearing_t(radius, length, c, 0.2_dp))
    bore = new_bore(360)
    do i = 1, size(depths)
      do k = 1, 7
        e = (c + depths(i))*[cos(0.9_dp*k), sin(0.9_dp*k)]
        call bore%press(e, force, total)
        call bore%find_gap(e, gap, gradient)
        call check%relative(norm2(force), round%elastic_force(depths(i)), 3e-6_dp, 'force in a round bore')
        if (i > 2) call check%relative(norm2(force), round%elastic_force(depths(i)), 4e-8_dp, 'force at a deeper penetration')
        call check%close_to(norm2(force/norm2(force) - e/norm2(e)), 0.0_dp, 2e-7_dp, 'its direction')
        call check%close_to(gap, depths(i), 4e-9_dp*c, 'penetration in a round bore')
        call check%close_to(norm2(gradient - e/norm2(e)), 0.0_dp, 1e-6_dp, 'gradient of the penetration')
        call check%relative(bore%energy(e), round%elastic_energy(depths(i)), 3e-6_dp, 'energy in a round bore')
      end do
    end do
    e = 0.999_dp*c*[0.6_dp, 0.8_dp]
    call bore%press(e, force, total)
    call bore%find_gap(e, gap, gradient)
    call check%close_to(norm2(force), 0.0_dp, 0.0_dp, 'no force inside the clearance')
    call check%close_to(gap, -0.001_dp*c, 4e-9_dp*c, 'gap inside the clearance')
  end subroutine round_is_round

  !> In a bore of any shape the force is the gradient of the energy of the foundation, which a trapezoidal rule with 400 points a
  !> bin gives.
  subroutine force_is_gradient(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: small = 1e-9_dp
    type(worn_bore_t) :: bore
    real(dp) :: e(2), force(2), total, numeric(2)
    integer :: k, i
    bore = new_bore(360)
    bore%depth = [(c*(0.2_dp*(1 + sin(3*two_pi*i/360)) + 0.1_dp*(1 + cos(8*two_pi*i/360))), i=1, 360)]
    do k = 1, 9
      e = 1.5_dp*c*[cos(0.7_dp*k), sin(0.7_dp*k)]
      call bore%press(e, force, total)
      do i = 1, 2
        numeric(i) = (energy_of(bore, e + small*unit(i)) - energy_of(bore, e - small*unit(i)))/(2*small)
      end do
      call check%close_to(norm2(force - numeric)/norm2(numeric), 0.0_dp, 2e-6_dp, 'force in a worn bore is the gradient')
      call check%relative(bore%energy(e), energy_of(bore, e), 2e-6_dp, 'energy in a worn bore')
    end do
  end subroutine force_is_gradient

  pure function unit(i) result(e)
    integer, intent(in) :: i
    real(dp) :: e(2)
    e = 0
    e(i) = 1
  end function unit

  !> k Rb L Int gap^2/2 dtheta, with the depth linear between the middles of the bins.
  pure real(dp) function energy_of(bore, e) result(energy)
    type(worn_bore_t), intent(in) :: bore
    real(dp), intent(in) :: e(2)
    integer, parameter :: points = 400
    real(dp) :: angle, gap, place
    integer :: i, n, bin
    n = size(bore%depth)
    energy = 0
    do i = 1, points*n
      angle = two_pi*i/(points*n)
      place = angle/two_pi*n + 0.5_dp
      bin = floor(place)
      gap = e(1)*cos(angle) + e(2)*sin(angle) - c - (1 - (place - bin))*bore%depth(modulo(bin - 1, n) + 1) &
        - (place - bin)*bore%depth(modulo(bin, n) + 1)
      energy = energy + 0.5_dp*max(gap, 0.0_dp)**2
    end do
    energy = energy*bore%bedding*two_pi/(points*n)
  end function energy_of

  !> A bore worn deepest in the middle of the load touches the pin on both sides of it.
  subroutine touches_on_two_arcs(check)
    class(checks_t), intent(inout) :: check
    type(worn_bore_t) :: bore
    type(touching_cells_t) :: touching
    real(dp) :: e(2), force(2), total, middles(3), from_cells
    integer :: i
    bore = new_bore(360)
    bore%depth = [(0.5_dp*c*exp(-((i - 180.5_dp)/10)**2), i=1, 360)]
    e = [-1.1_dp*c, 0.0_dp]
    call bore%press(e, force, total)
    call bore%cells(e, touching)
    from_cells = 0
    middles = 0
    do i = 1, touching%n
      associate (angle => 0.5_dp*sum(touching%ends(:, i)))
        from_cells = from_cells - touching%loads(i)*cos(angle)
        middles(1) = middles(1) + merge(1, 0, cos(angle) < -0.999_dp)
        middles(2:3) = middles(2:3) + merge(1, 0, [sin(angle), -sin(angle)] > 0)
      end associate
    end do
    call check%that(middles(1) < 1 .and. all(middles(2:) > 5), 'the pin touches on two arcs')
    call check%relative(from_cells, -force(1), 1e-5_dp, 'the cells carry the force')
    call check%relative(sum(touching%loads(:touching%n)), total, 1e-12_dp, 'the sum of their loads')
    call check%close_to(force(2)/force(1), 0.0_dp, 1e-12_dp, 'the force of symmetric arcs')
  end subroutine touches_on_two_arcs

  !> A pin pressed with 1 kN wears its bore: eccentricity, depth and volume after 10, 100 and 1000 m. The path is divided into steps
  !> that change the depth by 4 % of the penetration at most, by the midpoint rule.
  subroutine wears_under_constant_load(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: load = 1e3_dp, rate = 1e-14_dp
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: table(:, :)
    type(worn_bore_t) :: bore, half
    real(dp) :: path, step, e, growth(720)
    integer :: i
    call load_table('contact/wear_constant_load.csv', names, table)
    call check%that(size(table, 2) >= 3, 'the table of wear was read')
    bore = new_bore(720)
    path = 0
    do i = 1, 3
      do while (path < table(1, i)*(1 - 1e-12_dp))
        growth = growth_of(bore, load, rate, e)
        step = min(table(1, i) - path, 0.04_dp*(e - c - bore%depth(360))/maxval(growth))
        half = bore
        half%depth = bore%depth + 0.5_dp*step*growth
        growth = growth_of(half, load, rate, e)
        bore%depth = bore%depth + step*growth
        path = path + step
      end do
      growth = growth_of(bore, load, rate, e)
      call check%relative(e, table(2, i), 2e-5_dp, 'eccentricity of a worn bore')
      call check%relative((9*bore%depth(360) - bore%depth(359))/8, table(4, i), 1e-4_dp, 'depth of a worn bore')
      call check%relative(sum(bore%depth)*radius*length*two_pi/720, table(5, i), 3e-5_dp, 'volume of a worn bore')
      call check%relative(sum(growth)*radius*length*two_pi/720, table(6, i), 2e-4_dp, 'rate of the volume of a worn bore')
    end do
  end subroutine wears_under_constant_load

  !> Growth of the depth in each bin per sliding path [-], of a bore in which a load presses the pin in the direction of pi. e: its
  !> eccentricity [m].
  function growth_of(bore, load, rate, e) result(growth)
    type(worn_bore_t), intent(in) :: bore
    real(dp), intent(in) :: load, rate
    real(dp), intent(out) :: e
    real(dp) :: growth(size(bore%depth)), low, high, force(2), total
    type(touching_cells_t) :: touching
    type(worn_surface_t) :: surface
    integer :: i
    low = c
    high = 3*c
    do i = 1, 60
      e = 0.5_dp*(low + high)
      call bore%press([-e, 0.0_dp], force, total)
      if (-force(1) > load) then
        high = e
      else
        low = e
      end if
    end do
    call bore%cells([-e, 0.0_dp], touching)
    call surface%prepare(size(bore%depth))
    do i = 1, touching%n
      call surface%add(touching%ends(1, i), touching%ends(2, i), touching%loads(i))
    end do
    growth = rate*surface%load_path/(radius*length*surface%width())
  end function growth_of

  !> A run whose bore changes after every revolution: without extrapolation it wears as a round bore does, since the depths are far
  !> below the penetration; the turns and the volume grow with the extrapolation.
  subroutine bore_changes(check)
    class(checks_t), intent(inout) :: check
    character(len=28), parameter :: short = 'integrator.revolutions=2.5'
    type(trace_t) :: round, plain, more
    round = run_case(file, [character(len=28) :: short, 'wear.bore=round', 'wear.extrapolation=1'])
    plain = run_case(file, [character(len=28) :: short, 'wear.extrapolation=1'])
    more = run_case(file, [character(len=28) :: short, 'wear.extrapolation=1000'])
    call check%that(.not. (allocated(round%error) .or. allocated(plain%error) .or. allocated(more%error)), 'worn bores run')
    if (allocated(round%error) .or. allocated(plain%error) .or. allocated(more%error)) return
    associate (a => round%report%wear(1), b => plain%report%wear(1), d => more%report%wear(1))
      call check%relative(sum(b%volume(:, of_bore)), sum(a%volume(:, of_bore)), 1e-3_dp, 'a worn bore wears as a round one')
      call check%close_to(b%turns, 2.0_dp, 0.0_dp, 'turns of a worn bore')
      call check%close_to(d%turns, 2000.0_dp, 0.0_dp, 'turns with extrapolation')
      call check%that(sum(d%volume(:, of_bore)) > 500*sum(b%volume(:, of_bore)), 'extrapolated wear')
      call check%that(.not. a%bore_changes .and. b%bore_changes, 'which bores change')
    end associate
    associate (figures => more%report%figures)
      call check%that(figures%max_energy_residual < 1e-6_dp*figures%max_energy, 'energy with a bore that changes')
    end associate
  end subroutine bore_changes

  !> An extrapolation that is too large is reduced to the limit of the change of depth.
  subroutine steps_are_limited(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(file, [character(len=34) :: 'integrator.revolutions=2.5', 'wear.extrapolation=1e9', &
      'wear.greatest_step_ratio=0.01'])
    call check%that(.not. allocated(trace%error), 'a run with too much extrapolation')
    if (allocated(trace%error)) return
    call check%relative(trace%report%wear(1)%step_ratios(2), 0.02_dp, 1e-9_dp, 'change of depth over the mean penetration')
    call check%that(trace%report%wear(1)%step_ratios(1) < 0.01_dp, 'change of depth over the clearance')
    call check%that(trace%report%wear(1)%turns < 1e9_dp, 'extrapolation is reduced')
  end subroutine steps_are_limited

  !> How wear is distributed over the bins depends slightly on the steps, hence twice the tolerance of other joints.
  subroutine methods_agree_when_worn(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    call methods_agree(check, file, [character(len=40) :: 'integrator.revolutions=1.1', 'wear.rate=0.0,1e-9', &
      'wear.extrapolation=1'], 2*c, 'a worn bore', trace)
    if (.not. allocated(trace%report%wear)) return
    call check%that(maxval(trace%report%wear(1)%depth(:, of_bore)) > 1e-6_dp, 'the bore is worn deeper than it is pressed')
  end subroutine methods_agree_when_worn

  !> A change of shape is due at the end of runs of whole revolutions too, whatever rounding says of their last angle.
  subroutine last_change_counts(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, longer
    character(len=40) :: revolutions
    real(dp) :: volume
    integer :: n
    do n = 1, 7
      write (revolutions, '(a,i0)') 'integrator.revolutions=', n
      trace = run_case(file, [character(len=40) :: revolutions, 'wear.extrapolation=100'])
      call check%close_to(trace%report%wear(1)%turns, 100.0_dp*n, 0.0_dp, 'turns of a worn bore after whole revolutions')
      if (n /= 3) cycle
      longer = run_case(file, [character(len=40) :: 'integrator.revolutions=3.001', 'wear.extrapolation=100'])
      volume = sum(longer%report%wear(1)%volume)
      call check%relative(sum(trace%report%wear(1)%volume), volume, 1e-3_dp, 'volume of a worn bore after whole revolutions')
    end do
    trace = run_case(file, [character(len=40) :: 'integrator.revolutions=3', 'wear.extrapolation=100', 'wear.cycles_per_update=3'])
    call check%close_to(trace%report%wear(1)%turns, 300.0_dp, 0.0_dp, 'turns of a worn bore after one change')
  end subroutine last_change_counts

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: soft = '&contact geometry=''winkler'' bedding_modulus=1e13 / '
    call expect(check, soft//'&wear rate=0,1e-15 bore=''worn'' /', '', 'a worn bore')
    call expect(check, '&contact / &wear rate=0,1e-15 bore=''worn'' /', 'needs &contact geometry = ''winkler''', 'worn spheres')
    call expect(check, soft//'&wear rate=1e-15,0 bore=''worn'' /', '&wear rate', 'a worn bore that does not wear')
    call expect(check, soft//'&wear rate=0,1e-15 bore=''worn'' bins=20 /', '&wear bins = 20: must be >= 36', 'few bins')
    call expect(check, soft//'&lubrication viscosity=0.01 / &wear rate=0,1e-15 bore=''worn'' /', &
      '&wear bore = worn: must be round with lubrication', 'a worn bore with a film')
    call expect(check, soft//'&friction law=''coulomb'' coefficient=0.1 / &wear rate=0,1e-15 bore=''worn'' /', '&wear bore', &
      'a worn bore with surfaces that stick')
    call expect(check, soft//'&wear rate=0,1e-15 extrapolation=10 /', '&wear extrapolation = 10: is for bore', &
      'extrapolation without a worn bore')
  end subroutine refuses
end module test_worn_bore
