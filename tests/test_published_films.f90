!> The film of a journal that rotates under a steady load, against published tables: the Sommerfeld number S = mu N L D (R/c)^2/W
!> and the attitude angle. The published films begin at a groove; the solver therefore sets the pressure there to 0.
module test_published_films
  use kinds, only: dp
  use constants, only: pi, degree
  use checks, only: checks_t
  use finite_film, only: film_solver_t, film_answer_t, cavitation_reynolds
  implicit none
  private
  public :: run_test_published_films

contains

  subroutine run_test_published_films(check)
    class(checks_t), intent(inout) :: check
    call raimondi_and_boyd(check)
    call lund_and_thomsen(check)
    call someya(check)
  end subroutine run_test_published_films

  !> Raimondi and Boyd (1958), whose film begins at the largest film thickness: L/D, eps, S, attitude [deg]. (Their S for L/D 1 and
  !> eps 0.4, 0.264, is a misprint: Butenschoen has 0.2606.)
  subroutine raimondi_and_boyd(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: printed(4, 8) = reshape([1.0_dp, 0.1_dp, 1.33_dp, 79.50_dp, 1.0_dp, 0.2_dp, 0.631_dp, 74.02_dp, &
      1.0_dp, 0.6_dp, 0.121_dp, 50.58_dp, 1.0_dp, 0.8_dp, 0.0446_dp, 36.24_dp, 1.0_dp, 0.9_dp, 0.0188_dp, 26.45_dp, &
      0.5_dp, 0.1_dp, 4.31_dp, 81.62_dp, 0.5_dp, 0.4_dp, 0.779_dp, 61.45_dp, 0.5_dp, 0.8_dp, 0.0923_dp, 33.31_dp], [4, 8])
    call compare(check, printed, [pi], 0.0_dp, .false., 'Raimondi and Boyd')
  end subroutine raimondi_and_boyd

  !> Lund and Thomsen (1978), two grooves of 20 degrees at right angles to the load.
  subroutine lund_and_thomsen(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: printed(4, 6) = reshape([0.5_dp, 0.244_dp, 1.656_dp, 65.85_dp, 0.5_dp, 0.477_dp, 0.58_dp, 51.01_dp, &
      0.5_dp, 0.655_dp, 0.244_dp, 40.25_dp, 1.0_dp, 0.15_dp, 0.991_dp, 70.58_dp, 1.0_dp, 0.46_dp, 0.235_dp, 49.27_dp, &
      1.0_dp, 0.65_dp, 0.108_dp, 39.72_dp], [4, 6])
    call compare(check, printed, [-0.5_dp*pi, 0.5_dp*pi], 20*degree, .true., 'Lund and Thomsen')
  end subroutine lund_and_thomsen

  !> Someya's databook (1989), two grooves of 10 degrees at right angles to the load.
  subroutine someya(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: printed(4, 5) = reshape([0.5_dp, 0.3_dp, 1.24_dp, 64.10_dp, 0.5_dp, 0.7_dp, 0.187_dp, 38.20_dp, &
      0.5_dp, 0.9_dp, 0.0315_dp, 22.70_dp, 1.0_dp, 0.5_dp, 0.194_dp, 49.10_dp, 1.0_dp, 0.8_dp, 0.0469_dp, 32.10_dp], [4, 5])
    call compare(check, printed, [-0.5_dp*pi, 0.5_dp*pi], 10*degree, .true., 'Someya')
  end subroutine someya

  !> Sommerfeld numbers within 1.2 % and attitude angles within 0.6 degrees of a table; for the grooves see `find_pin`.
  subroutine compare(check, printed, grooves, width, from_load, source)
    class(checks_t), intent(inout) :: check
    real(dp), intent(in) :: printed(:, :)   !! columns of L/D, eps, S, attitude [deg]
    real(dp), intent(in) :: grooves(:), width
    logical, intent(in) :: from_load
    character(len=*), intent(in) :: source
    real(dp) :: found(2)
    integer :: i
    do i = 1, size(printed, 2)
      call find_pin(printed(1, i), printed(2, i), grooves, width, from_load, found)
      call check%relative(found(1), printed(3, i), 1.2e-2_dp, 'Sommerfeld number of '//source)
      call check%close_to(found(2), printed(4, i), 0.6_dp, 'attitude angle of '//source)
    end do
  end subroutine compare

  !> S and the attitude angle [deg] of a journal whose bearing has grooves of a `width` [rad] at given angles [rad]. These are
  !> measured from the smallest film thickness or, with `from_load`, from the direction of the load, which is found by iteration.
  subroutine find_pin(half_length, eps, grooves, width, from_load, found)
    real(dp), intent(in) :: half_length, eps, grooves(:), width
    logical, intent(in) :: from_load
    real(dp), intent(out) :: found(2)
    type(film_solver_t) :: solver
    type(film_answer_t) :: film
    real(dp) :: load
    integer :: i, k
    load = -50*degree
    do k = 1, merge(6, 1, from_load)
      call solver%begin(192, 8, 1 - eps, half_length)
      do i = 1, size(grooves)
        associate (middle => grooves(i) + merge(load, 0.0_dp, from_load))
          call solver%open_arc(middle - 0.5_dp*width, middle + 0.5_dp*width)
        end associate
      end do
      call solver%solve(-0.5_dp*pi, cavitation_reynolds, .false., film)
      load = atan2(-film%force(2), -film%force(1))
    end do
    found = [2/(pi*eps*norm2(film%force)), abs(load)/degree]
  end subroutine find_pin
end module test_published_films
