!> Results of films besides their force: side flow, largest pressure, power, moment. They are compared with tables of an independent
!> solver (data/film) and of Raimondi and Boyd, with scans and quadrature.
module test_film_figures
  use kinds, only: dp
  use constants, only: pi, degree
  use error_handling, only: error_t
  use checks, only: checks_t
  use film_law, only: film_law_t, film_motion_t
  use finite_film, only: film_answer_t, cavitation_gumbel, cavitation_reynolds
  use film_map, only: film_map_t
  use film_solution, only: solved_film
  use short_bearing, only: short_bearing_t
  use laws, only: film_law_of
  implicit none
  private
  public :: run_test_film_figures

  real(dp), parameter :: c = 20e-6_dp   !! clearance of the bearing in `laws` [m]

contains

  subroutine run_test_film_figures(check)
    class(checks_t), intent(inout) :: check
    call tables_of_the_solver(check)
    call raimondi_and_boyd(check)
    call short_bearing(check)
    call units(check)
    call long_bearing_by_scan(check)
    call table_meets_solver(check)
  end subroutine run_test_film_figures

  !> Flow and largest pressure of five bearings, every third row.
  subroutine tables_of_the_solver(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: bearings(5) = [character(len=4) :: '0.25', '0.5', '0.75', '1', '2']
    character(len=10) :: condition
    character(len=200) :: line
    real(dp) :: half_length, eps, alpha, force(2), flow, most, rest(2)
    type(film_answer_t) :: got
    integer :: i, unit, status, rows
    rows = 0
    do i = 1, size(bearings)
      open (newunit=unit, file='data/film/phi_LD'//trim(bearings(i))//'.csv', status='old', action='read')
      read (unit, '(a)') line
      do
        read (unit, '(a)', iostat=status) line
        if (status /= 0) exit
        read (line, *) half_length, condition, eps, alpha, force, flow, most, rest
        if (condition == 'full' .or. eps > 0.91_dp) cycle
        rows = rows + 1
        if (mod(rows, 3) /= 0) cycle
        call solved_film(96, half_length, merge(cavitation_gumbel, cavitation_reynolds, condition == 'gumbel'), 1 - eps, &
          alpha*degree, got)
        call check%relative(got%flow, flow, 6e-3_dp, 'flow of a '//trim(condition)//' film as tabulated')
        call check%relative(got%most, most, 8e-3_dp, 'pressure of a '//trim(condition)//' film as tabulated')
      end do
      close (unit)
    end do
    call check%that(rows > 250, 'the tables have their rows')
  end subroutine tables_of_the_solver

  !> Published tables of a journal that rotates under a steady load (1958): side flow Q_s/(R c N L), and mean pressure over the
  !> largest. Their film begins at the largest film thickness, ours where its pressure becomes positive.
  subroutine raimondi_and_boyd(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: printed(4, 9) = reshape([ &
      0.25_dp, 0.2_dp, 3.76_dp*0.330_dp, 0.489_dp, 0.25_dp, 0.4_dp, 4.37_dp*0.567_dp, 0.415_dp, 0.25_dp, 0.6_dp, 4.99_dp*0.746_dp, &
      0.334_dp, 0.25_dp, 0.8_dp, 5.60_dp*0.884_dp, 0.240_dp, 0.25_dp, 0.9_dp, 5.91_dp*0.945_dp, 0.180_dp, &
      0.5_dp, 0.4_dp, 4.29_dp*0.552_dp, 0.441_dp, 0.5_dp, 0.6_dp, 4.85_dp*0.730_dp, 0.365_dp, 0.5_dp, 0.8_dp, 5.41_dp*0.874_dp, &
      0.267_dp, 0.5_dp, 0.9_dp, 5.69_dp*0.939_dp, 0.206_dp], [4, 9])
    type(film_answer_t) :: film
    integer :: i
    do i = 1, size(printed, 2)
      associate (length => printed(1, i), eps => printed(2, i))
        call solved_film(128, length, cavitation_reynolds, 1 - eps, -0.5_dp*pi, film)
        call check%relative(0.5_dp*pi*eps*film%flow/length, printed(3, i), 3e-2_dp, 'side flow by Raimondi and Boyd')
        call check%relative(0.5_dp*norm2(film%force)/film%most, printed(4, i), 2.5e-2_dp, &
          'largest pressure by Raimondi and Boyd')
      end associate
    end do
  end subroutine raimondi_and_boyd

  !> Ocvirk's pressure 6 cos(phi - alpha) (lambda^2 - zeta^2)/H^3 scanned for its largest value; its flow -H^3/12 dP/dzeta at
  !> both ends summed over the arc where it is positive; and both against the solver for a bearing that is short.
  subroutine short_bearing(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 200000
    real(dp), parameter :: ratios(5) = [0.0_dp, 0.3_dp, 0.7_dp, 0.95_dp, 0.999_dp]
    type(short_bearing_t) :: film
    type(film_answer_t) :: solved
    real(dp) :: most, flow, want_most, want_flow, alpha, phi, gap
    integer :: i, j, k
    do i = 1, size(ratios)
      do j = -6, 6
        alpha = j*0.5_dp
        want_most = 0
        want_flow = 0
        do k = 0, points - 1
          phi = alpha - 0.5_dp*pi + pi*(k + 0.5_dp)/points
          gap = 1 - ratios(i)*cos(phi)
          want_most = max(want_most, 6*cos(phi - alpha)*0.6_dp**2/gap**3)
          want_flow = want_flow + 2*(gap**3/12)*(12*0.6_dp*cos(phi - alpha)/gap**3)*pi/points
        end do
        film%half_length = 0.6_dp
        call film%reduced_peak_and_flow(ratios(i)**2, 3*cos(alpha), 3*sin(alpha), most, flow)
        call check%relative(most, 3*want_most, 1e-6_dp, 'largest pressure of a short bearing')
        call check%relative(flow, 3*want_flow, 1e-9_dp, 'side flow of a short bearing')
        if (ratios(i) > 0.8_dp) cycle
        film%half_length = 0.005_dp
        call film%reduced_peak_and_flow(ratios(i)**2, cos(alpha), sin(alpha), most, flow)
        call solved_film(128, film%half_length, cavitation_gumbel, 1 - ratios(i), alpha, solved)
        call check%relative(solved%most, most, 2e-3_dp, 'largest pressure of the solver')
        call check%relative(solved%flow, flow, 5e-3_dp, 'side flow of the solver')
      end do
    end do
  end subroutine short_bearing

  !> The same with units: p = 6 mu v*.r (L^2/4 - z^2)/h^3, and the flow out of the arc where v*.r is positive, 2 R L |v*|.
  subroutine units(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 100000
    real(dp), parameter :: length = 15e-3_dp, radius = 10e-3_dp - c
    class(film_law_t), allocatable :: law
    type(error_t), allocatable :: error
    type(film_motion_t) :: motion
    real(dp) :: v(2), most, flow, want, r(2)
    integer :: i, k
    call film_law_of("law='finite_bearing' variant='short' viscosity=0.0117", 1e-6_dp, law, error)
    do k = 1, 10
      motion = random_motion(k)
      associate (e => motion%eccentricity)
        v = motion%eccentricity_rate - 0.5_dp*motion%pin_speed*[-e(2), e(1)]
        want = 0
        do i = 1, points
          r = [cos(2*pi*i/points), sin(2*pi*i/points)]
          want = max(want, 6*0.0117_dp*dot_product(v, r)*0.25_dp*length**2/(c - dot_product(e, r))**3)
        end do
      end associate
      call law%peak_and_flow(motion, most, flow)
      call check%relative(most, want, 1e-5_dp, 'largest pressure [Pa]')
      call check%relative(flow, 2*radius*length*norm2(v), 1e-9_dp, 'side flow [m3/s]')
    end do
  end subroutine units

  !> The pressure of the long film, scanned at close points.
  subroutine long_bearing_by_scan(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: points = 100000
    class(film_law_t), allocatable :: law
    type(error_t), allocatable :: error
    type(film_motion_t) :: motion
    real(dp) :: most, flow, want, angle
    integer :: i, k
    call film_law_of("variant='closed_form' viscosity=0.0117", 1e-6_dp, law, error)
    do k = 1, 30
      motion = random_motion(k)
      call law%peak_and_flow(motion, most, flow)
      want = 0
      do i = 0, points
        angle = pi*(2*real(i, dp)/points - 1)
        want = max(want, law%pressure(motion, angle), law%pressure(motion, 0.01_dp*angle))
      end do
      call check%relative(most, want, 1e-6_dp, 'largest pressure of a long bearing')
      call check%that(abs(flow) <= 0, 'a long bearing has no side flow')
    end do
  end subroutine long_bearing_by_scan

  subroutine table_meets_solver(check)
    class(checks_t), intent(inout) :: check
    type(film_map_t) :: map
    type(film_answer_t) :: film
    real(dp) :: eps, alpha, most, flow
    integer :: i
    call map%build(0.75_dp, cavitation_gumbel, 33, 64)
    do i = 1, 40
      eps = 0.985_dp*modulo(0.618_dp*i, 1.0_dp)
      alpha = pi*(2*modulo(0.414_dp*i, 1.0_dp) - 1)
      call solved_film(128, 0.75_dp, cavitation_gumbel, 1 - eps, alpha, film)
      call map%peak_and_flow(eps**2, 3*cos(alpha), 3*sin(alpha), most, flow)
      call check%relative(most, 3*film%most, 2e-2_dp, 'largest pressure of a table')
      call check%relative(flow, 3*film%flow, 2e-2_dp, 'flow of a table')
    end do
  end subroutine table_meets_solver

  pure function random_motion(k) result(motion)
    integer, intent(in) :: k
    type(film_motion_t) :: motion
    motion%eccentricity = c*(0.01_dp + modulo(0.618_dp*k, 0.985_dp))*[cos(0.37_dp*k), sin(0.37_dp*k)]
    motion%eccentricity_rate = 2e-3_dp*[cos(1.31_dp*k), sin(1.31_dp*k)]
    motion%pin_speed = 180*cos(2.1_dp*k)
    motion%turning_speed = motion%pin_speed
  end function random_motion
end module test_film_figures
