!> Power series in Q of the remainders of the oscillating film (see oscillating_response).
!>
!> B = 3 + sum b_k z^k and C = z/B = sum c_k z^k, with z = u^2 = i Q eta^2, follow from 2 z B' = z + 3 B - B^2 and 2 z C' = z - C -
!> C^2. The remainders are therefore series in i Q, whose coefficients are means of powers of eta = 1 - eps cos th: M_m = <eta^m>
!> and eps H_m = <eta^m cos th>, polynomials in eps^2 (Legendre's and, by integration by parts, Gegenbauer's):
!>
!>     (2k + 3) b_k = [k = 1] - sum b_j b_k-j,   (2k + 1) c_k = [k = 1] - sum c_j c_k-j,   j from 1 to k - 1
!>     (m + 1) M_m+1 = (2m + 1) M_m - m (1 - eps^2) M_m-1,                      M_0 = M_1 = 1
!>     (m + 2) H_m+1 = (m + 1) [(2m + 1)/m H_m - (1 - eps^2) H_m-1],            H_0 = 0, H_1 = -1/2
module inertia_series
  use kinds, only: dp
  implicit none
  private
  public :: inertia_series_t, remainder_t, new_inertia_series

  integer, parameter :: most_pairs = 8                 !! largest number of pairs of terms after the first
  integer, parameter :: most_terms = 1 + 2*most_pairs

  !> The parts of the means that have no closed form.
  type :: remainder_t
    complex(dp) :: n1, c2   !! of <B/eta^2>, without 3 <1/eta^2>; the same with cos th, over eps
    complex(dp) :: n2, c3   !! of <(B + u^2)/eta^3>, without 3 <1/eta^3> and 6/5 i Q <1/eta>; the same with cos th, over eps
    complex(dp) :: m1, mc   !! of <(1 + B + u^2/B)/eta>, without 4 <1/eta>; the same with cos th, over eps
  end type remainder_t

  type :: inertia_series_t
    real(dp) :: limit = -1                !! largest Q for which the series is used
    real(dp) :: limits(most_pairs) = -1   !! largest Q for each number of pairs of terms
    real(dp) :: b(most_terms) = 0         !! b_k, with the sign of the real or imaginary part of i^k
    real(dp) :: a(most_terms) = 0         !! b_k + c_k, with the same sign
    real(dp) :: up(2, 2*most_terms) = 0, down(2, 2*most_terms) = 0   !! X_m+1 = up_m X_m - down_m gap X_m-1 of (M, H)
  contains
    procedure, non_overridable :: remainders
  end type inertia_series_t

contains

  !> Prepare a series with the relative error `accuracy`, between 0 and 1. The first neglected term is largest at eps = 1, where M_m
  !> = (2m)!/(2^m m!^2); measured, the error of the response is at most a twelfth of it. Successive terms decrease by 4 Q/pi^2.
  pure subroutine new_inertia_series(series, accuracy)
    type(inertia_series_t), intent(out) :: series
    real(dp), intent(in) :: accuracy
    real(dp) :: b(most_terms + 1), c(most_terms + 1), mean
    integer :: j, k, m

    do k = 1, most_terms + 1
      b(k) = (merge(1, 0, k == 1) - sum(b(:k - 1)*b(k - 1:1:-1)))/(2*k + 3)
      c(k) = (merge(1, 0, k == 1) - sum(c(:k - 1)*c(k - 1:1:-1)))/(2*k + 1)
    end do
    series%b = b(:most_terms)
    series%a = b(:most_terms) + c(:most_terms)
    do k = 2, most_terms, 4   ! i^2 = -1, i^3 = -i
      series%b(k:k + 1) = -series%b(k:k + 1)
      series%a(k:k + 1) = -series%a(k:k + 1)
    end do
    mean = 2.5_dp   ! M_3 at eps = 1
    do j = 1, most_pairs
      k = 2*j + 2   ! first neglected term, with M_2k-1
      do m = 4*j, 4*j + 3
        mean = mean*(2*m - 1)/m
      end do
      series%limits(j) = (10*accuracy/(abs(b(k) + c(k))*mean))**(1.0_dp/k)
    end do
    series%limit = series%limits(most_pairs)
    do m = 1, size(series%up, 2)
      series%up(:, m) = [2*m + 1.0_dp, (m + 1)*(2*m + 1)/real(m, dp)]/[m + 1, m + 2]
      series%down(:, m) = [m, m + 1]/real([m + 1, m + 2], dp)
    end do
  end subroutine new_inertia_series

  !> Evaluate the series; Q must be at most `limit`.
  pure subroutine remainders(self, gap, q, rest)
    class(inertia_series_t), intent(in) :: self
    real(dp), value, intent(in) :: gap   !! 1 - eps^2
    real(dp), value, intent(in) :: q     !! Q
    type(remainder_t), intent(out) :: rest
    real(dp), dimension(2, 2) :: n1, n2, m1     !! (without, with cos th) of (real part, imaginary part)
    real(dp) :: even(2), odd(2), power
    integer :: j, k, m, part

    even = [1.0_dp, 0.0_dp]
    odd = [1.0_dp, -0.5_dp]
    n1 = 0
    n2 = 0
    m1 = 0
    n1(:, 2) = self%b(1)*q*even
    m1(:, 2) = self%a(1)*q*odd
    power = q
    do j = 1, most_pairs
      do part = 1, 2
        k = 2*j + part - 1
        m = 2*k - 3
        power = power*q
        n2(:, part) = n2(:, part) + self%b(k)*power*odd
        even = self%up(:, m)*odd - self%down(:, m)*gap*even
        n1(:, part) = n1(:, part) + self%b(k)*power*even
        odd = self%up(:, m + 1)*even - self%down(:, m + 1)*gap*odd
        m1(:, part) = m1(:, part) + self%a(k)*power*odd
      end do
      if (q <= self%limits(j)) exit
    end do
    rest%n1 = cmplx(n1(1, 1), n1(1, 2), dp)
    rest%c2 = cmplx(n1(2, 1), n1(2, 2), dp)
    rest%n2 = cmplx(n2(1, 1), n2(1, 2), dp)
    rest%c3 = cmplx(n2(2, 1), n2(2, 2), dp)
    rest%m1 = cmplx(m1(1, 1), m1(1, 2), dp)
    rest%mc = cmplx(m1(2, 1), m1(2, 2), dp)
  end subroutine remainders
end module inertia_series
