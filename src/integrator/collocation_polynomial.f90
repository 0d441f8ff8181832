!> The polynomial through the stages of a Radau step.
submodule (collocation) collocation_polynomial
  use bernstein, only: from_newton
  implicit none
contains

  module procedure polynomial
    real(dp) :: weights(0:most_stages)
    integer :: j
    call lagrange(self, self%stages_done, x, weights)
    change = 0
    do j = 1, self%stages_done
      change = change + weights(j)*self%z(:, j)
    end do
  end procedure polynomial

  module procedure bernstein_form
    real(dp) :: a(0:most_stages), node(0:most_stages), low(most_stages), high(most_stages)   ! factors x - node
    integer :: i, j, s
    s = self%stages_done
    node(0) = 0
    node(1:s) = self%formula(s/2)%c(:s)
    a(0) = 0
    a(1:s) = self%z(component, :s)
    do j = 1, s   ! divided differences
      do i = s, j, -1
        a(i) = (a(i) - a(i - 1))/(node(i) - node(i - j))
      end do
    end do
    low(:s) = -node(:s - 1)
    high(:s) = 1 - node(:s - 1)
    call from_newton(a(:s), low(:s), high(:s), coefficients(:s))
  end procedure bernstein_form

  module procedure guess_stages
    real(dp) :: weights(0:most_stages)
    integer :: i, j, l, s, m, k

    m = self%m
    k = self%k
    s = self%formula(self%level)%stages
    do i = 1, s
      call lagrange(self, self%stages_done, 1 + self%formula(self%level)%c(i)*self%h/self%h_done, weights)
      weights(self%stages_done) = weights(self%stages_done) - 1
      do l = 1, k
        self%rates(l, i) = 0
        do j = 1, self%stages_done
          self%rates(l, i) = self%rates(l, i) + weights(j)*self%z(m + l, j)
        end do
      end do
    end do
    call combine(k, s, 1.0_dp, self%formula(self%level)%t_inverse, self%rates, k, self%w, k)
  end procedure guess_stages

  !> Lagrange polynomials at x over the nodes 0, c_1, ..., c_s of a formula: products of the distances before and after
  !> each node, over those at the node itself, which `prepare` has found.
  pure subroutine lagrange(self, stages, x, weights)
    class(collocation_t), intent(in) :: self
    integer, intent(in) :: stages
    real(dp), intent(in) :: x
    real(dp), intent(out) :: weights(0:)
    real(dp) :: distance(0:most_stages), product
    integer :: i
    associate (formula => self%formula(stages/2))
      distance(0) = x
      do i = 1, stages
        distance(i) = x - formula%c(i)
      end do
      product = 1
      do i = 0, stages
        weights(i) = product*self%per_node(i, stages/2)
        product = product*distance(i)
      end do
      product = 1
      do i = stages, 0, -1
        weights(i) = weights(i)*product
        product = product*distance(i)
      end do
    end associate
  end subroutine lagrange
end submodule collocation_polynomial
