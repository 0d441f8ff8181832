!> The cells of a film with memory: where the supply is, their balance and its derivatives, and films with exact solutions.
module test_film_cells
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t, status_case_file
  use bearing_size, only: bearing_t
  use checks, only: checks_t
  use film_oil, only: film_oil_t
  use film_cells, only: film_cells_t, supply_t, new_film_cells, supply_none, supply_grooves, supply_holes, supply_circumferential, &
    ruptured, filled, supplied
  use film_balance, only: film_conditions_t, film_state_t, film_balance_t, new_state, find_gap, find_balance, find_matrix, &
    find_columns, find_excess
  use film_step, only: step_solver_t, new_step_solver, step_solved
  use ring_compliance, only: elastic_bore_t, new_ring
  implicit none
  private
  public :: run_test_film_cells

contains

  subroutine run_test_film_cells(check)
    class(checks_t), intent(inout) :: check
    call oil_under_pressure(check)
    call grid(check)
    call cells_of_the_supply(check)
    call refuses(check)
    call derivatives(check)
    call fowell_pocket(check)
    call two_lands(check)
  end subroutine run_test_film_cells

  !> q(p) and p(q) are inverse to each other, with the slope of the thickening, down to a constant viscosity.
  subroutine oil_under_pressure(check)
    class(checks_t), intent(inout) :: check
    type(film_oil_t) :: oil
    real(dp), parameter :: pressures(5) = [1e-3_dp, 0.04_dp, 0.06_dp, 1.0_dp, 200.0_dp]
    real(dp) :: p, q
    integer :: i
    oil%coefficient = 0.02_dp
    do i = 1, size(pressures)
      p = pressures(i)
      q = oil%reduced(p)
      call check%relative(q, (1 - exp(-0.02_dp*p))/0.02_dp, 1e-10_dp, 'reduced pressure')
      call check%relative(oil%pressure(q), p, 1e-13_dp, 'pressure of a reduced pressure')
      call check%relative(oil%thickening(q), exp(0.02_dp*p), 1e-13_dp, 'viscosity under pressure')
    end do
    call check%relative(oil%reduced(0.05_dp*(1 + 1e-9_dp)), oil%reduced(0.05_dp*(1 - 1e-9_dp)), 3e-9_dp, &
      'the reduced pressure is continuous')
    call check%relative(oil%pressure(0.05_dp*(1 + 1e-9_dp)), oil%pressure(0.05_dp*(1 - 1e-9_dp)), 3e-9_dp, &
      'the pressure is continuous')
    oil%coefficient = 0
    call check%close_to(oil%reduced(3.0_dp), 3.0_dp, 0.0_dp, 'reduced pressure of a constant viscosity')
    call check%close_to(oil%pressure(3.0_dp), 3.0_dp, 0.0_dp, 'pressure of a constant viscosity')
  end subroutine oil_under_pressure

  !> Cells cover the bearing, and neighbours are at most two apart in the order of elimination, also for an odd number.
  subroutine grid(check)
    class(checks_t), intent(inout) :: check
    type(film_cells_t) :: cells
    type(supply_t) :: supply
    type(error_t), allocatable :: error
    integer :: n
    do n = 24, 25
      call new_film_cells(bearing(), supply, n, 3, cells, error)
      call check%that(.not. allocated(error), 'a bearing without supply')
      call check%relative(cells%cell_volume()*n*3, 2*pi*30e-6_dp*(0.02483_dp - 30e-6_dp)*0.03_dp, 1e-14_dp, 'volume of the cells')
      call check%that(maxval(abs(cells%place - cells%place(cells%next))) <= 2, 'neighbours in the order of elimination')
      call check%that(sum(cells%place) == n*(n + 1)/2 .and. maxval(cells%place) == n, 'each column has its place')
      call check%relative(cells%face_angle(n), 2*pi, 1e-15_dp, 'the ring of cells is closed')
    end do
    supply%kind = supply_circumferential
    supply%groove_width = 0.006_dp
    call new_film_cells(bearing(), supply, 24, 3, cells, error)
    call check%relative(cells%cell_volume()*24*3, 2*pi*30e-6_dp*(0.02483_dp - 30e-6_dp)*0.024_dp, 1e-14_dp, 'volume of the lands')
  end subroutine grid

  !> Grooves and holes whose edges lie on faces, fixed to the bearing or the pin.
  subroutine cells_of_the_supply(check)
    class(checks_t), intent(inout) :: check
    type(film_cells_t) :: cells
    type(supply_t) :: supply
    type(error_t), allocatable :: error
    real(dp) :: area
    integer :: i
    supply%kind = supply_grooves
    supply%position_deg = [0.0_dp, 90.0_dp]
    supply%width_deg = 30
    supply%length = 0.015_dp
    call new_film_cells(bearing(), supply, 24, 4, cells, error)   ! cells of 15 degrees and 3.75 mm
    call check%that(all(any(cells%is_supplied, 1) .eqv. [(any([1, 6, 7, 24] == i), i=1, 24)]), 'columns of two grooves')
    call check%that(all(count(cells%is_supplied, 1) == [(merge(2, 0, any([1, 6, 7, 24] == i)), i=1, 24)]), 'length of two grooves')
    call cells%turn_supply(15*pi/180)
    call check%that(all(any(cells%is_supplied, 1) .eqv. [(any([1, 6, 7, 24] == i), i=1, 24)]), 'a groove of the bearing stays')
    supply%fixed_to_pin = .true.
    call new_film_cells(bearing(), supply, 24, 4, cells, error)
    call cells%turn_supply(-15*pi/180)
    call check%that(all(any(cells%is_supplied, 1) .eqv. [(any([5, 6, 23, 24] == i), i=1, 24)]), 'a groove of the pin turns')
    supply = supply_t(kind=supply_holes, position_deg=[200.0_dp], diameter=0.010_dp)
    call new_film_cells(bearing(), supply, 720, 60, cells, error)
    area = count(cells%is_supplied)*cells%cell_volume()/30e-6_dp
    call check%relative(area, 0.25_dp*pi*0.010_dp**2, 1e-2_dp, 'area of a hole')
    call check%relative(sum(cells%angle, any(cells%is_supplied, 1))/count(any(cells%is_supplied, 1)), 200*pi/180, 1e-6_dp, &
      'middle of a hole')
  end subroutine cells_of_the_supply

  !> A supply that the bearing cannot have, or that no cell resolves.
  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    call refused(supply_t(supply_grooves, [0.0_dp], 30.0_dp, 0.031_dp), 'a groove is longer')
    call refused(supply_t(supply_grooves, [0.0_dp], 14.0_dp, 0.015_dp), 'a groove is smaller than a cell')
    call refused(supply_t(supply_grooves, [0.0_dp], 30.0_dp, 0.003_dp), 'a groove is smaller than a cell')
    call refused(supply_t(supply_holes, [0.0_dp], diameter=0.007_dp), 'a hole is smaller than a cell')
    call refused(supply_t(supply_circumferential, groove_width=0.03_dp), 'a circumferential groove must be narrower')
    call refused(supply_t(supply_circumferential, groove_width=0.0_dp), 'a circumferential groove must be narrower')
    call refused(supply_t(supply_circumferential, groove_width=0.003_dp, fixed_to_pin=.true.), 'a circumferential groove cannot')

  contains

    subroutine refused(supply, message)
      type(supply_t), intent(in) :: supply
      character(len=*), intent(in) :: message
      type(film_cells_t) :: cells
      type(error_t), allocatable :: error
      call new_film_cells(bearing(), supply, 24, 4, cells, error)
      call check%that(allocated(error), 'a wrong supply is refused: '//message)
      if (.not. allocated(error)) return
      call check%begins_with(error%message, message, 'message of a wrong supply')
      call check%that(error%status == status_case_file, 'status of a wrong supply')
    end subroutine refused
  end subroutine refuses

  !> The matrix and the columns of the gap's shapes are the derivatives of the balances, for both directions of the speed, with and
  !> without a circumferential groove; the columns of the matrix are dominant.
  subroutine derivatives(check)
    class(checks_t), intent(inout) :: check
    integer :: k
    do k = 1, 4
      call differentiate(check, merge(300.0_dp, -300.0_dp, mod(k, 2) == 0), k > 2)
    end do
  end subroutine derivatives

  subroutine differentiate(check, speed, is_land)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: speed
    logical, intent(in) :: is_land
    integer, parameter :: n = 25, m = 3, band = 2*m
    real(dp), parameter :: step = 1e-4_dp
    type(step_solver_t) :: solver
    type(film_conditions_t) :: conditions
    type(film_state_t) :: state
    type(supply_t) :: supply
    type(film_cells_t) :: cells
    type(error_t), allocatable :: error
    real(dp) :: matrix(-band:band, n*m), columns(m, n, 6), slope(m, n), worst, least, most, others
    integer :: i, j, k, l

    supply%kind = supply_grooves
    supply%position_deg = [100.0_dp]
    supply%width_deg = 40
    supply%length = 0.02_dp
    if (is_land) supply = supply_t(supply_circumferential, groove_width=0.006_dp)
    call new_film_cells(bearing(), supply, n, m, cells, error)
    call new_step_solver(cells, new_ring(0.02483_dp, 0.04_dp, 207e9_dp, 0.3_dp, 3), 0.012_dp, 1e-8_dp, .true., solver)
    conditions = film_conditions_t(rate=2e3_dp, speed=speed, supply=40.0_dp, ends=3.0_dp)
    allocate (conditions%content(m, n), source=0.8_dp)
    state = new_state(solver%cells, 7)
    state%amplitude = [0.05_dp, 0.1_dp, -0.05_dp, 0.02_dp, 0.03_dp, -0.5_dp, 0.2_dp]
    do i = 1, n
      do j = 1, m
        state%kind(j, i) = merge(ruptured, filled, mod(3*i + j, 5) < 2)
        if (solver%cells%is_supplied(j, i)) state%kind(j, i) = supplied
        if (state%kind(j, i) == filled) state%pressure(j, i) = 20 + 10*sin(real(i*j, dp))
        if (state%kind(j, i) == supplied) state%pressure(j, i) = conditions%supply
        if (state%kind(j, i) == ruptured) state%fraction(j, i) = 0.5_dp + 0.3_dp*cos(real(i + j, dp))
      end do
    end do
    call evaluate(slope)
    call find_matrix(solver%cells, conditions, state%kind, solver%gap, band, matrix)
    call find_columns(solver%cells, conditions, state, solver%balance, solver%shapes, columns)

    most = maxval(abs(matrix))
    worst = 0
    do i = 1, n
      do j = 1, m
        if (state%kind(j, i) == supplied) cycle
        if (state%kind(j, i) == filled) call central(state%pressure(j, i), slope)
        if (state%kind(j, i) == ruptured) call central(state%fraction(j, i), slope)
        k = (solver%cells%place(i) - 1)*m + j
        do l = max(1, k - band), min(n*m, k + band)
          worst = max(worst, abs(matrix(l - k, k) + slope(mod(l - 1, m) + 1, (l - 1)/m + 1)))
        end do
      end do
    end do
    call check%close_to(worst/most, 0.0_dp, 1e-9_dp, 'matrix of the balances')
    worst = 0
    do l = 1, size(columns, 3)
      call central(state%amplitude(l), slope)
      worst = max(worst, maxval(abs(columns(:, :, l) + slope))/maxval(abs(slope)))
    end do
    call check%close_to(worst, 0.0_dp, 1e-6_dp, 'columns of the shapes')
    least = huge(least)
    do k = 1, n*m
      others = sum(abs(matrix(:, k))) - matrix(0, k)
      least = min(least, (matrix(0, k) - others)/matrix(0, k))
    end do
    call check%that(least > -1e-14_dp, 'columns of the balances are dominant')

  contains

    !> (content - f h)*rate - outflow, in the order of elimination.
    subroutine evaluate(excess)
      real(dp), intent(out) :: excess(:, :)
      call find_gap(solver%cells, solver%shapes, state%amplitude, solver%gap)
      call find_balance(solver%cells, conditions, state, solver%gap, solver%balance)
      call find_excess(solver%cells, conditions, state, solver%gap, solver%balance, excess)
    end subroutine evaluate

    !> Central difference of the excess with respect to a variable.
    subroutine central(variable, slope)
      real(dp), intent(inout) :: variable
      real(dp), intent(out) :: slope(:, :)
      real(dp) :: middle, below(m, n)
      middle = variable
      variable = middle - step
      call evaluate(below)
      variable = middle + step
      call evaluate(slope)
      variable = middle
      slope = (slope - below)/(2*step)
    end subroutine central
  end subroutine differentiate

  !> Fowell, Olver, Gosman, Spikes and Pegg (2007): a slider, 10 mm, whose gap falls from 1.05 to 1.00 um, with a pocket 1 um deep
  !> from 2 to 5 mm, under 1 bar at both ends. The film ruptures at the beginning of the pocket, which draws in oil, and is full
  !> again inside it. A ring with one cell of supply is such a slider; the pocket's edges lie on faces, whose error is of first
  !> order.
  subroutine fowell_pocket(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: exact(2), found(2, 2)
    integer :: k
    call slider_in_closed_form(exact)
    call check%relative(exact(1), 5.229635e-7_dp, 1e-6_dp, 'flow of the slider in closed form')
    call check%relative(exact(2), 9.80882e6_dp, 1e-6_dp, 'pressure at the end of its pocket in closed form')
    do k = 1, 2
      call solve_slider(100*k, found(:, k))
      call check%relative(found(1, k), exact(1), 1.6e-4_dp/k, 'flow of the slider')
      call check%relative(found(2, k), exact(2), 8.5e-2_dp/k, 'pressure at the end of its pocket')
    end do
    call check%relative(2*found(1, 2) - found(1, 1), exact(1), 4e-6_dp, 'flow of the slider, extrapolated')
    call check%relative(2*found(2, 2) - found(2, 1), exact(2), 1e-3_dp, 'pressure at the end of its pocket, extrapolated')
  end subroutine fowell_pocket

  !> Thickness of the slider without its pocket [m].
  pure real(dp) function slider_gap(x)
    real(dp), intent(in) :: x
    slider_gap = 1.05e-6_dp - 5e-6_dp*x
  end function slider_gap

  !> Flow [m2/s] and pressure at the end of the pocket [Pa]. With p' = 12 mu (U h/2 - flow)/h^3 the flow is that for which the
  !> pressure falls from 1 bar to 0 before the pocket, and the pressure at its end that from which it falls to 1 bar behind.
  subroutine slider_in_closed_form(exact)
    real(dp), intent(out) :: exact(2)
    real(dp), parameter :: viscosity = 0.01_dp, speed = 1, ambient = 1e5_dp
    real(dp) :: squares, cubes
    squares = (1/slider_gap(2e-3_dp) - 1/slider_gap(0.0_dp))/5e-6_dp
    cubes = (1/slider_gap(2e-3_dp)**2 - 1/slider_gap(0.0_dp)**2)/10e-6_dp
    exact(1) = (ambient/(12*viscosity) + 0.5_dp*speed*squares)/cubes
    squares = (1/slider_gap(10e-3_dp) - 1/slider_gap(5e-3_dp))/5e-6_dp
    cubes = (1/slider_gap(10e-3_dp)**2 - 1/slider_gap(5e-3_dp)**2)/10e-6_dp
    exact(2) = ambient - 12*viscosity*(0.5_dp*speed*squares - exact(1)*cubes)
  end subroutine slider_in_closed_form

  !> The slider on a number of cells, a multiple of ten.
  subroutine solve_slider(number, found)
    integer, intent(in) :: number
    real(dp), intent(out) :: found(2)
    type(step_solver_t) :: solver
    type(film_conditions_t) :: conditions
    type(film_state_t) :: state
    type(film_cells_t) :: cells
    type(supply_t) :: supply
    type(error_t), allocatable :: error
    type(elastic_bore_t) :: rigid
    real(dp) :: radius, x, width
    integer :: i, outcome
    radius = 10e-3_dp*(number + 1)/(number*2*pi)
    call new_film_cells(bearing_t(radius=radius + 1e-6_dp, clearance=1e-6_dp, length=1e3_dp), supply, number + 1, 2, cells, error)
    cells%is_supplied(:, 1) = .true.
    width = 10e-3_dp/number
    do i = 1, number + 1   ! face i lies between cells i and i + 1, cell 1 before the slider
      x = (i - 1)*width
      cells%face_bore(i) = slider_gap(x)*1e6_dp
      cells%bore(i) = slider_gap(x - 0.5_dp*width)*1e6_dp
      if (x > 2e-3_dp + 1e-9_dp .and. x < 5e-3_dp + 1e-9_dp) cells%bore(i) = cells%bore(i) + 1
      if (x > 2e-3_dp - 1e-9_dp .and. x < 5e-3_dp + 1e-9_dp) cells%face_bore(i) = cells%face_bore(i) + 1
      if (min(abs(x - 2e-3_dp), abs(x - 5e-3_dp)) < 1e-9_dp) cells%face_bore(i) = cells%face_bore(i) - 0.5_dp
    end do
    call new_step_solver(cells, rigid, 0.01_dp, 0.0_dp, .false., solver)
    conditions%speed = 1/radius
    conditions%rate = 1e-10_dp*conditions%speed
    conditions%supply = 1e5_dp/solver%pressure_unit
    conditions%content = spread(cells%bore, 1, 2)
    state = new_state(cells, 2)
    state%kind(:, 1) = supplied
    state%pressure(:, 1) = conditions%supply
    call solver%solve_step(conditions, state, outcome)
    found = 0
    if (outcome /= step_solved) return
    ! into the slider, between the supply and its first cell
    found(1) = solver%gap%at_faces(1)**3*2*(conditions%supply - state%pressure(1, 2))/cells%turn + 0.5_dp*conditions%speed* &
      solver%gap%at_faces(1)
    found(1) = found(1)*1e-6_dp*radius
    found(2) = state%pressure(1, number/2 + 1)*solver%pressure_unit
  end subroutine solve_slider

  !> Two lands without motion, full of oil: Q = pi R c^3 p (1 + 1.5 eps^2)/(3 mu l), l the length of a land.
  subroutine two_lands(check)
    class(checks_t), intent(inout) :: check
    type(step_solver_t) :: solver
    type(film_conditions_t) :: conditions
    type(film_state_t) :: state
    type(film_cells_t) :: cells
    type(error_t), allocatable :: error
    type(elastic_bore_t) :: rigid
    real(dp) :: exact, volume
    integer :: k, outcome
    call new_film_cells(bearing(), supply_t(supply_circumferential, groove_width=0.006_dp), 24, 4, cells, error)
    call new_step_solver(cells, rigid, 0.012_dp, 0.0_dp, .false., solver)
    do k = 0, 9, 3
      state = new_state(cells, 2)
      conditions%rate = 1e-9_dp
      conditions%supply = 3e5_dp/solver%pressure_unit
      conditions%eccentricity = 0.1_dp*k*[0.8_dp, -0.6_dp]
      associate (e => conditions%eccentricity)
        conditions%content = spread(1 - e(1)*cos(cells%angle) - e(2)*sin(cells%angle), 1, 4)
      end associate
      call solver%solve_step(conditions, state, outcome)
      exact = pi*(0.02483_dp - 30e-6_dp)*(30e-6_dp)**3*3e5_dp*(1 + 1.5_dp*(0.1_dp*k)**2)/(3*0.012_dp*0.012_dp)
      volume = cells%cell_volume()
      call check%that(outcome == step_solved, 'two lands are solved')
      call check%relative(solver%balance%inlet*volume, exact, 1e-13_dp, 'flow from a circumferential groove')
      call check%relative(solver%balance%side*volume, exact, 1e-13_dp, 'flow out of two lands')
    end do
  end subroutine two_lands

  !> The bearing of most films here.
  pure type(bearing_t) function bearing()
    bearing = bearing_t(radius=0.02483_dp, clearance=30e-6_dp, length=0.03_dp)
  end function bearing
end module test_film_cells
