!> The first passage of an event function through zero within a step where the function is a known polynomial in the state:
!> found, or proven absent, from the polynomial that the method itself interpolates with.
module event_proof
  use kinds, only: dp
  use ode_problem, only: event_form_t
  use ode_method, only: ode_method_t
  use bernstein, only: add_product, first_rise, rise_between, highest_degree
  implicit none
  private
  public :: stays_negative_for_certain, isolate_passage

contains

  !> Whether the function is certainly negative all along the last step, but perhaps zero at its beginning, from a bound of how
  !> far each component of the state strays from the straight line between its values at both ends, the largest number if
  !> there is no bound. Along the straight lines,
  !> x being the share of the step, the function is a parabola; what the straying adds is below 4 x (1 - x) times a
  !> constant. Both together have the Bernstein coefficients a, m, b and are below zero between the ends where a and b are
  !> not above it and m < sqrt(a b), or m < 0.
  pure logical function stays_negative_for_certain(form, method, straying) result(negative)
    type(event_form_t), intent(in) :: form
    class(ode_method_t), intent(in) :: method
    real(dp), intent(in) :: straying(2)
    real(dp) :: at_start, at_middle, at_end, a, b, slope_a, slope_b
    integer :: j
    negative = max(straying(1), straying(2)) < huge(straying)
    if (.not. negative) return
    at_start = form%constant
    at_middle = form%constant
    at_end = form%constant
    do j = 1, 2
      a = method%y_old(form%first - 1 + j)
      b = method%y(form%first - 1 + j)
      associate (linear => form%linear(j), square => form%square(j))
        slope_a = linear + 2*square*a
        slope_b = linear + 2*square*b
        at_start = at_start + (linear + square*a)*a
        at_middle = at_middle + 0.5_dp*(linear*a + slope_a*b) &
          + 2*(max(abs(slope_a), abs(slope_b)) + abs(square)*straying(j))*straying(j)
        at_end = at_end + (linear + square*b)*b
      end associate
    end do
    negative = at_start <= 0 .and. at_end < 0 .and. (at_middle < 0 .or. at_middle**2 < at_start*at_end)
  end function stays_negative_for_certain

  !> The part lower < x <= upper of the last step, by the method's own clock, in which a function that is negative at the
  !> beginning of the step first becomes not negative, and where in it that is, but for rounding (`likely`). `known` is false
  !> where the method cannot tell.
  pure subroutine isolate_passage(form, method, known, found, lower, upper, likely)
    type(event_form_t), intent(in) :: form
    class(ode_method_t), intent(inout) :: method
    logical, intent(out) :: known, found
    real(dp), intent(out) :: lower, upper, likely
    real(dp) :: component(0:highest_degree/2, 2), one(0:highest_degree/2), g(0:highest_degree), most
    integer :: j, degree

    found = .false.
    known = .true.
    lower = 0
    upper = 1
    likely = 0
    most = form%constant   ! what the function can reach with each component at the end of its range that suits it best
    degree = 1
    do j = 1, 2
      if (.not. (abs(form%linear(j)) > 0 .or. abs(form%square(j)) > 0)) cycle
      call method%bernstein_form(form%first - 1 + j, component(:, j), degree)
      known = degree > 0 .and. degree <= highest_degree/2
      if (.not. known) return
      associate (least => minval(component(:degree, j)), largest => maxval(component(:degree, j)))
        most = most + max(form%linear(j)*least, form%linear(j)*largest) + max(form%square(j), 0.0_dp)*max(least**2, largest**2)
      end associate
    end do
    if (most < 0) return
    one = 1
    g = form%constant
    do j = 1, 2
      if (abs(form%linear(j)) > 0) call add_product(form%linear(j), component(:degree, j), one(:degree), g(:2*degree))
      if (abs(form%square(j)) > 0) call add_product(form%square(j), component(:degree, j), component(:degree, j), g(:2*degree))
    end do
    call first_rise(g(:2*degree), found, lower, upper)
    if (found) likely = rise_between(g(:2*degree), lower, upper)
  end subroutine isolate_passage
end module event_proof
