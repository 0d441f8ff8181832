!> The initial guess of the zeros of the half film's pressure: its coefficients are computed again and its error is measured; and
!> the angle between the zeros.
module test_half_film_guess
  use, intrinsic :: iso_fortran_env, only: qp => real128
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use checks, only: checks_t
  use small_lu, only: decompose, solve
  use half_film, only: first_guess, turn_between
  implicit none
  private
  public :: run_test_half_film_guess

contains

  subroutine run_test_half_film_guess(check)
    class(checks_t), intent(inout) :: check
    call is_the_least_square(check)
    call is_close_enough(check)
    call turns_are_right(check)
  end subroutine run_test_half_film_guess

  !> The normal equations over the disc, by Gauss's rule on pieces of the radius and the midpoint rule in the angle.
  subroutine is_the_least_square(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: pieces = 24, angles = 200
    real(dp), parameter :: place(3) = 0.5_dp + sqrt(0.15_dp)*[-1, 0, 1], weight(3) = [5, 8, 5]/18.0_dp
    real(dp) :: matrix(6, 6), right(6), terms(6), radius, angle
    integer :: i, j, k, pivot(6)
    logical :: singular
    matrix = 0
    right = 0
    do i = 1, pieces
      do k = 1, 3
        radius = (i - 1 + place(k))/pieces
        do j = 1, angles
          angle = pi*(j - 0.5_dp)/angles
          terms = terms_at(radius*cos(angle), radius*sin(angle))
          matrix = matrix + weight(k)*radius*spread(terms, 2, 6)*spread(terms, 1, 6)
          right = right + weight(k)*radius*terms*root_at(radius*cos(angle), radius*sin(angle))
        end do
      end do
    end do
    call decompose(matrix, pivot, singular)
    call solve(matrix, pivot, right)
    call check%that(.not. singular .and. all(abs(first_guess - right) <= 1e-9_dp), &
      'coefficients of the guess are the least-squares solution')
  end subroutine is_the_least_square

  subroutine is_close_enough(check)
    class(checks_t), intent(inout) :: check
    real(dp) :: worst, radius, angle
    integer :: i, j
    worst = 0
    do i = 0, 100
      do j = 0, 400
        radius = i/100.0_dp
        angle = 2*pi*j/400
        associate (x => radius*cos(angle), y => radius*sin(angle))
          worst = max(worst, abs(dot_product(first_guess, terms_at(x, y)) - root_at(x, y)))
        end associate
      end do
    end do
    call check%relative(worst, 3.1e-3_dp, 0.01_dp, 'error of the guess is the stated one')
  end subroutine is_close_enough

  !> Against the arc tangent in quadruple precision, in every octant and on both sides of each boundary between two formulas.
  subroutine turns_are_right(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: parts = 4096, exponents = 300
    real(dp) :: angle, c, s, worst
    real(qp) :: exact
    integer :: i, j, edge
    worst = 0
    do i = 0, 16*parts - 1
      angle = 2*pi*(i + 0.37_dp)/(16*parts)
      worst = max(worst, off(3*cos(angle), 3*sin(angle)))
    end do
    do edge = 0, 15
      do j = 1, 60
        do i = -1, 1, 2
          angle = edge*pi/8 + i*0.5_dp**j
          worst = max(worst, off(0.7_dp*cos(angle), 0.7_dp*sin(angle)))
        end do
      end do
    end do
    do i = 1, exponents
      worst = max(worst, off(1.0_dp, 10.0_dp**(-i)), off(10.0_dp**(-i), 1.0_dp), off(-10.0_dp**(-i), -1.0_dp), &
        off(-1.0_dp, 10.0_dp**(-i)), off(-1.0_dp, -10.0_dp**(-i)), off(1.0_dp, -10.0_dp**(-i)))
    end do
    call check%that(worst <= 4e-16_dp, 'relative error of the angle between the zeros')
    worst = max(off(1.0_dp, 0.0_dp), off(0.0_dp, 1.0_dp), off(-1.0_dp, 0.0_dp), off(0.0_dp, -1.0_dp))
    call check%that(worst <= 2e-16_dp, 'error of the angle between the zeros in quadrants')

  contains

    real(dp) function off(cosine, sine)
      real(dp), intent(in) :: cosine, sine
      c = cosine
      s = sine
      exact = atan2(real(s, qp), real(c, qp))
      if (exact < 0) exact = exact + 2*acos(-1.0_qp)
      off = 0
      if (exact > 0) then
        off = real(abs(turn_between(c, s) - exact)/exact, dp)
      else if (abs(turn_between(c, s)) > 0) then
        off = 1
      end if
    end function off
  end subroutine turns_are_right

  pure function terms_at(x, y) result(terms)
    real(dp), intent(in) :: x, y
    real(dp) :: terms(6)
    terms = [y, y*x, y*x**2, y*x**3, y**3, y**3*x]
  end function terms_at

  !> The small root of y + (8 + 4x) t - 6 y t^2 + (8 - 4x) t^3 + y t^4, by bisection.
  pure real(dp) function root_at(x, y) result(t)
    real(dp), intent(in) :: x, y
    real(dp) :: lower, upper
    integer :: i
    lower = -0.2_dp
    upper = 0.2_dp
    do i = 1, 60
      t = 0.5_dp*(lower + upper)
      if (y + t*((8 + 4*x) + t*(-6*y + t*((8 - 4*x) + t*y))) > 0) then
        upper = t
      else
        lower = t
      end if
    end do
  end function root_at
end module test_half_film_guess
