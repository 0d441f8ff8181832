!> The polynomial through the stages of a Radau step.
submodule (collocation) collocation_polynomial
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

  module procedure guess_stages
    real(dp) :: weights(0:most_stages)
    real(dp) :: begin
    integer :: i, j, l, s, m, k

    begin = merge(1.0_dp, 0.0_dp, ahead)
    m = self%m
    k = self%k
    s = self%formula(self%level)%stages
    do i = 1, s
      call lagrange(self, self%stages_done, begin + self%formula(self%level)%c(i)*self%h/self%h_done, weights)
      if (ahead) weights(self%stages_done) = weights(self%stages_done) - 1
      do l = 1, k
        self%rates(l, i) = 0
        do j = 1, self%stages_done
          self%rates(l, i) = self%rates(l, i) + weights(j)*self%z(m + l, j)
        end do
      end do
    end do
    call combine(k, s, 1.0_dp, self%formula(self%level)%t_inverse, self%rates, k, self%w, k)
  end procedure guess_stages

  !> Lagrange polynomials at x over the nodes 0, c_1, ..., c_s of a formula: products of the distances before and after each node,
  !> divided by those at the node itself, computed by `prepare`.
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
