!> Polynomials on [0, 1] in Bernstein form: value = sum over j of b_j C(m, j) x^j (1 - x)^(m - j). A polynomial lies between its
!> smallest and its largest coefficient, and has no more roots than its coefficients have changes of sign.
module bernstein
  use kinds, only: dp
  use roots, only: bracket_t, next_abscissa, narrow
  implicit none
  private
  public :: from_newton, integrate_polynomial, add_product, first_rise, rise_between, highest_degree

  integer, parameter :: highest_degree = 28   !! of a product
  integer, parameter :: most_halvings = 48    !! an interval of [0, 1] is not divided further

contains

  !> The polynomial a_1 + F_1 (a_2 + F_2 (a_3 + ...)) with the linear factors F_i that are low_i at 0 and high_i at 1; a has
  !> one element more than they, b as many as a.
  pure subroutine from_newton(a, low, high, b)
    real(dp), intent(in) :: a(:), low(:), high(:)
    real(dp), intent(out) :: b(0:)
    real(dp) :: longer(0:highest_degree)
    integer :: i, j, m
    b(0) = a(size(a))
    do i = size(a) - 1, 1, -1
      m = size(a) - i   ! the degree becomes m
      longer(0) = low(i)*b(0)
      do j = 1, m - 1
        longer(j) = ((m - j)*low(i)*b(j) + j*high(i)*b(j - 1))/m
      end do
      longer(m) = high(i)*b(m - 1)
      b(:m) = longer(:m) + a(i)
    end do
  end subroutine from_newton

  !> first + the integral of scale * b from 0 on: `sum` is of one degree more.
  pure subroutine integrate_polynomial(first, scale, b, sum)
    real(dp), intent(in) :: first, scale, b(0:)
    real(dp), intent(out) :: sum(0:)
    integer :: j
    sum(0) = first
    do j = 1, size(b)
      sum(j) = sum(j - 1) + scale*b(j - 1)/size(b)
    end do
  end subroutine integrate_polynomial

  !> Add factor * a * b, a and b of the degree m, to a sum of the degree 2 m <= highest_degree.
  pure subroutine add_product(factor, a, b, sum)
    real(dp), intent(in) :: factor, a(0:), b(0:)
    real(dp), intent(inout) :: sum(0:)
    real(dp) :: scaled_a(0:highest_degree/2), scaled_b(0:highest_degree/2), product(0:highest_degree)
    integer :: i, m
    real(dp), parameter :: binomial(0:highest_degree, 0:highest_degree) = reshape([ &
      ((anint(gamma(m + 1.0_dp)/(gamma(i + 1.0_dp)*gamma(max(m - i, 0) + 1.0_dp))), i=0, highest_degree), m=0, highest_degree)], &
      [highest_degree + 1, highest_degree + 1])   !! C(m, i) in (i <= m, m)
    m = size(a) - 1
    scaled_a(:m) = factor*binomial(:m, m)*a   ! with their binomials coefficients multiply like those of powers
    scaled_b(:m) = binomial(:m, m)*b
    product(:2*m) = 0
    do i = 0, m
      product(i:i + m) = product(i:i + m) + scaled_a(i)*scaled_b(:m)
    end do
    sum = sum + product(:2*m)/binomial(:2*m, 2*m)
  end subroutine add_product

  !> Where a polynomial that is negative at 0 first becomes not negative: an interval lower < x <= upper at whose beginning it
  !> is negative, at whose end it is not, with one root. `found` is false where there is none in [0, 1]: that is proven
  !> by the coefficients, up to their rounding, but for a touch that lasts less than 2^-48.
  pure subroutine first_rise(b, found, lower, upper)
    real(dp), intent(in) :: b(0:)
    logical, intent(out) :: found
    real(dp), intent(out) :: lower, upper
    call search_between(b, 0.0_dp, 1.0_dp, 0, found, lower, upper)
  end subroutine first_rise

  !> The same between x = from and from + width, b being the polynomial there.
  pure recursive subroutine search_between(b, from, width, halvings, found, lower, upper)
    real(dp), intent(in) :: b(0:), from, width
    integer, intent(in) :: halvings
    logical, intent(out) :: found
    real(dp), intent(out) :: lower, upper
    real(dp) :: left(0:highest_degree), right(0:highest_degree)
    integer :: m
    m = size(b) - 1
    lower = from
    upper = from + width
    found = .false.
    if (maxval(b) < 0) return
    found = b(m) >= 0 .and. (count((b(:m - 1) < 0) .neqv. (b(1:) < 0)) == 1 .or. halvings == most_halvings)
    if (found .or. halvings == most_halvings) return
    call halve(b, left(:m), right(:m))
    call search_between(left(:m), from, 0.5_dp*width, halvings + 1, found, lower, upper)
    if (.not. found) call search_between(right(:m), from + 0.5_dp*width, 0.5_dp*width, halvings + 1, found, lower, upper)
  end subroutine search_between

  !> The root of a polynomial that is negative at lower and not at upper, from above and to 1e-12, as far as rounding lets it.
  pure real(dp) function rise_between(b, lower, upper)
    real(dp), intent(in) :: b(0:), lower, upper
    real(dp), parameter :: narrow_enough = 1e-12_dp
    type(bracket_t) :: bracket
    real(dp) :: terms(0:highest_degree), choices, x
    integer :: j, m
    m = size(b) - 1
    choices = 1
    do j = 0, m
      terms(j) = choices*b(j)
      choices = choices*(m - j)/(j + 1)
    end do
    bracket = bracket_t(lower, upper, value(lower), value(upper), 0, upper - lower)
    do while (bracket%b - bracket%a > narrow_enough)
      x = next_abscissa(bracket)
      if (.not. (x > bracket%a .and. x < bracket%b)) exit
      call narrow(bracket, x, value(x))
    end do
    rise_between = bracket%b

  contains

    !> Of the polynomial, in the manner of Horner.
    pure real(dp) function value(x)
      real(dp), intent(in) :: x
      real(dp) :: power
      integer :: j
      power = 1
      value = terms(0)
      do j = 1, m
        power = power*x
        value = value*(1 - x) + power*terms(j)
      end do
    end function value
  end function rise_between

  !> The polynomial on both halves of [0, 1], each again on [0, 1] (de Casteljau).
  pure subroutine halve(b, left, right)
    real(dp), intent(in) :: b(0:)
    real(dp), intent(out) :: left(0:), right(0:)
    integer :: i, m
    m = size(b) - 1
    right = b
    do i = 0, m
      left(i) = right(0)
      right(:m - i - 1) = 0.5_dp*(right(:m - i - 1) + right(1:m - i))
    end do
  end subroutine halve
end module bernstein
