!> The polynomial through the stages of a Radau step.
submodule (collocation) collocation_polynomial
  implicit none
contains

  module procedure polynomial
    call interpolate(self%n, self%stages_done, self%formula(self%stages_done/2)%c, self%per_node(:, self%stages_done/2), x, &
      0.0_dp, self%z, self%n, change)
  end procedure polynomial

  !> With the products P of the distances before a node and Q of those behind it, (P Q)' = P' Q + P Q'.
  module procedure polynomial_slope
    real(dp) :: weights(most_stages), before(most_stages), before_slope(most_stages), product, product_slope, total
    integer :: i, r, s
    s = self%stages_done
    associate (node => self%formula(s/2)%c, per_node => self%per_node(1:, s/2))
      product = x
      product_slope = 1
      do i = 1, s
        before(i) = product
        before_slope(i) = product_slope
        product_slope = product_slope*(x - node(i)) + product
        product = product*(x - node(i))
      end do
      product = 1
      product_slope = 0
      do i = s, 1, -1
        weights(i) = (before_slope(i)*product + before(i)*product_slope)*per_node(i)
        product_slope = product_slope*(x - node(i)) + product
        product = product*(x - node(i))
      end do
    end associate
    do r = 1, size(slope)
      total = weights(1)*self%z(r, 1)
      do i = 2, s
        total = total + weights(i)*self%z(r, i)
      end do
      slope(r) = total
    end do
  end procedure polynomial_slope

  module procedure guess_stages
    real(dp) :: at_begin
    integer :: i

    at_begin = merge(1.0_dp, 0.0_dp, ahead)
    associate (formula => self%formula(self%level), done => self%stages_done)
      do i = 1, formula%stages
        call interpolate(self%k, done, self%formula(done/2)%c, self%per_node(:, done/2), &
          at_begin + formula%c(i)*self%h/self%h_done, at_begin, self%z(self%m + 1, 1), self%n, self%rates(:, i))
      end do
      call combine(self%k, formula%stages, 1.0_dp, formula%t_inverse, self%rates, self%k, self%w, self%k)
    end associate
  end procedure guess_stages

  !> Polynomials through 0 at 0 and the columns of z at the nodes, at x, less `last` times the last column. The Lagrange polynomials
  !> are products of the distances before and after each node, divided by those at the node itself, computed by `prepare`.
  pure subroutine interpolate(rows, stages, node, per_node, x, last, z, first_z, y)
    integer, value :: rows, stages, first_z
    real(dp), intent(in) :: node(stages), per_node(0:stages), x, last, z(first_z, *)
    real(dp), intent(out) :: y(rows)
    real(dp) :: weights(most_stages), product, total
    integer :: i, r
    product = x
    do i = 1, stages
      weights(i) = product*per_node(i)
      product = product*(x - node(i))
    end do
    product = 1
    do i = stages, 1, -1
      weights(i) = weights(i)*product
      product = product*(x - node(i))
    end do
    weights(stages) = weights(stages) - last
    do r = 1, rows
      total = weights(1)*z(r, 1)
      do i = 2, stages
        total = total + weights(i)*z(r, i)
      end do
      y(r) = total
    end do
  end subroutine interpolate
end submodule collocation_polynomial
