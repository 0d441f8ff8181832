!> The worn bore: its force against the closed form of a round one and against the gradient of an energy from another quadrature;
!> wear under a constant load against the table of an independent implementation.
module test_worn_bore
  use kinds, only: dp
  use constants, only: two_pi
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use archard_wear, only: worn_surface_t
  use worn_bore, only: worn_bore_t, touching_cells_t
  use winkler, only: winkler_t
  use data_tables, only: load_table
  implicit none
  private
  public :: run_test_worn_bore

  real(dp), parameter :: c = 1e-4_dp, radius = 10e-3_dp, length = 15e-3_dp, modulus = 1e13_dp   !! of the tables [m], [Pa/m]

contains

  subroutine run_test_worn_bore(check)
    class(checks_t), intent(inout) :: check
    call round_is_round(check)
    call force_is_gradient(check)
    call touches_on_two_arcs(check)
    call wears_under_constant_load(check)
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
end module test_worn_bore
