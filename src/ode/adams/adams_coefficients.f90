!> Coefficients of the variable-step Adams formulas in modified divided differences (Shampine & Gordon 1975, ch. 5).
module adams_coefficients
  use kinds, only: dp
  use ode_method, only: highest_order
  implicit none
  private
  public :: adams_coefficients_t, moulton_constants, interpolation_weights, stability_limit

  !> Largest stable h |lambda| of the method at each order, for a negative real lambda and constant step size.
  real(dp), parameter :: stability_limit(highest_order) = [2.00_dp, 2.40_dp, 1.93_dp, 1.41_dp, 1.04_dp, 0.77_dp, 0.58_dp, &
    0.44_dp, 0.34_dp, 0.26_dp, 0.21_dp, 0.17_dp]

  !> i, and 1/(i (i+1)), the i-fold integral of the first basis polynomial divided by (i-1)!.
  real(dp), parameter :: ordinal(highest_order) = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]
  real(dp), parameter :: first_column(highest_order) = 1/(ordinal*(ordinal + 1))

  !> Coefficients of the step from t_n to t_n+1 = t_n + h at order k, in the notation of Shampine & Gordon.
  type :: adams_coefficients_t
    real(dp) :: psi(highest_order) = 0        !! psi_i = t_n+1 - t_n+1-i
    real(dp) :: alpha(highest_order) = 0      !! alpha_i = h/psi_i
    real(dp) :: beta(highest_order) = 0       !! beta_i = product over j < i of psi_j(n+1)/psi_j(n)
    real(dp) :: sigma(highest_order + 1) = 0  !! sigma_i = (i-1)! product over j < i of alpha_j
    real(dp) :: g(highest_order + 1) = 0      !! g_i = integral of the i-th Newton basis polynomial over the step, divided by h
    real(dp) :: v(highest_order) = 0          !! column of the recurrence for g, kept between steps
    real(dp) :: beta_next = 1, sigma_next = 1 !! beta_k+1 and sigma_k+2, if the difference of order k is known
    real(dp) :: psi_before = 0                !! psi_k before the step, used by `undo_update`
    integer :: ns = 0                         !! number of steps with the present step size, including this one
  contains
    procedure :: reset
    procedure :: update
    procedure :: undo_update
  end type adams_coefficients_t

contains

  !> Constants |gamma*_i| of the Adams-Moulton formulas for constant step size, i = 1..highest_order+1 (1/2, 1/12, 1/24, 19/720,
  !> ...), from their recurrence: the sum over j of gamma*_(i-j)/(j+1) is zero, with gamma*_0 = 1.
  pure function moulton_constants() result(constants)
    real(dp) :: constants(highest_order + 1)
    real(dp) :: gamma(0:highest_order + 1)
    integer :: i, j
    gamma(0) = 1
    do i = 1, highest_order + 1
      gamma(i) = 0
      do j = 1, i
        gamma(i) = gamma(i) - gamma(i - j)/(j + 1)
      end do
    end do
    constants = abs(gamma(1:))
  end function moulton_constants

  !> Discard the history: the next step is the first one.
  pure subroutine reset(self)
    class(adams_coefficients_t), intent(inout) :: self
    self%ns = 0
    self%g(1) = 1
    self%g(2) = 0.5_dp
    self%sigma(1) = 1
  end subroutine reset

  !> Coefficients for a step of size h at order k after one of size h_old at order k_old. Coefficients that do not change at
  !> constant step size are not computed again.
  pure subroutine update(self, h, h_old, k, k_old)
    class(adams_coefficients_t), intent(inout) :: self
    real(dp), intent(in) :: h, h_old
    integer, intent(in) :: k, k_old
    real(dp) :: reach, previous, next, inverse
    integer :: i, ns

    self%psi_before = self%psi(k)
    if (abs(h - h_old) > 0) self%ns = 0
    if (self%ns <= k_old) self%ns = self%ns + 1
    ns = self%ns
    self%beta_next = 1
    self%sigma_next = 1
    if (k < ns) return

    self%beta(ns) = 1
    self%alpha(ns) = 1.0_dp/ns
    reach = h*ns
    self%sigma(ns + 1) = 1
    do i = ns + 1, k   ! h/psi_i and psi_i-1(n+1)/psi_i-1(n) with one division, whose latency determines the time
      previous = self%psi(i - 1)
      self%psi(i - 1) = reach
      next = previous + h
      inverse = 1/(previous*next)
      self%beta(i) = self%beta(i - 1)*((reach*next)*inverse)
      self%alpha(i) = (h*previous)*inverse
      reach = next
      self%sigma(i + 1) = (ordinal(i)*self%alpha(i))*self%sigma(i)
    end do
    if (k_old >= k) then
      previous = self%psi(k)
      self%beta_next = self%beta(k)*(reach/previous)
      self%sigma_next = (k + 1)*(h/(previous + h))*self%sigma(k + 1)
    end if
    self%psi(k) = reach
    call update_g(self, k, k_old)
  end subroutine update

  !> The integrals g(ns+1..k+1) by their recurrence in v and w.
  pure subroutine update_g(self, k, k_old)
    class(adams_coefficients_t), intent(inout) :: self
    integer, intent(in) :: k, k_old
    real(dp) :: w(highest_order), left, right, alpha
    integer :: i, j, ns

    ns = self%ns
    if (ns == 1) then
      self%v = first_column   ! only k elements are needed, but a copy of fixed length is faster
      w = first_column
    else
      if (k > k_old) then   ! the order was raised: extend the column
        self%v(k) = first_column(k)
        do j = 1, ns - 2
          i = k - j
          self%v(i) = self%v(i) - self%alpha(j + 1)*self%v(i + 1)
        end do
      end if
      do i = 1, k + 1 - ns
        self%v(i) = self%v(i) - self%alpha(ns)*self%v(i + 1)
        w(i) = self%v(i)
      end do
      self%g(ns + 1) = w(1)
    end if
    do i = ns + 2, k + 1
      alpha = self%alpha(i - 1)
      left = w(1)
      do j = 1, k + 2 - i
        right = w(j + 1)
        w(j) = left - alpha*right
        left = right
      end do
      self%g(i) = w(1)
    end do
  end subroutine update_g

  !> Undo the change of psi by a rejected step of size h at order k.
  pure subroutine undo_update(self, h, k)
    class(adams_coefficients_t), intent(inout) :: self
    real(dp), intent(in) :: h
    integer, intent(in) :: k
    integer :: i
    do i = 2, k
      self%psi(i - 1) = self%psi(i) - h
    end do
    self%psi(k) = self%psi_before
    self%ns = 0
  end subroutine undo_update

  !> Newton basis polynomials integrated from t_n+1 to t_n+1 + s (-h <= s <= 0) and divided by s. With them y(t_n+1 + s) = y_n+1 + s
  !> sum_i weights(i) phi_i, i = 1..k+2. The last basis polynomial vanishes at all k+1 points t_n+1..t_n+1-k, so that its
  !> coefficient can be chosen to match y at t_n.
  pure subroutine interpolation_weights(self, k, s, weights)
    class(adams_coefficients_t), intent(in) :: self
    integer, intent(in) :: k
    real(dp), intent(in) :: s
    real(dp), intent(out) :: weights(:)   !! at least k+2 elements
    real(dp) :: w(highest_order + 2), gamma, eta, scale, term
    integer :: i, j, last

    last = k + 2
    do i = 1, last
      w(i) = 1.0_dp/i
    end do
    weights(1) = 1
    term = 0
    do j = 2, last
      scale = self%psi(min(j - 1, k))
      gamma = (s + term)/scale
      eta = s/scale
      do i = 1, last + 1 - j
        w(i) = gamma*w(i) - eta*w(i + 1)
      end do
      weights(j) = w(1)
      term = scale
    end do
  end subroutine interpolation_weights
end module adams_coefficients
