!> The indices of the owners' components in the state vector.
module test_state_layout
  use kinds, only: dp
  use checks, only: checks_t
  use state_layout, only: layout_t, coordinates_t, slice_t
  implicit none
  private
  public :: run_test_state_layout

contains

  !> Two owners of positions, one of states, two of quadratures, and one quadrature claimed after the layout is complete: no two
  !> share a component, and every component has the scale that its owner gave it.
  subroutine run_test_state_layout(check)
    class(checks_t), intent(inout) :: check
    type(layout_t) :: layout
    type(coordinates_t) :: crank, pin
    type(slice_t) :: bristle, work, late
    real(dp) :: scale(11)
    logical :: grows(11)
    integer :: pass

    do pass = 1, 2
      if (pass == 2) call layout%count_again()
      call layout%claim_quadratures(1, 5.0_dp, work)
      call layout%claim_positions(1, 1.0_dp, 2.0_dp, crank, grows=.true.)
      call layout%claim_states(3, 7.0_dp, bristle)
      call layout%claim_positions(2, 3.0_dp, 4.0_dp, pin, grows=.false.)
    end do
    call check%that(layout%n() == 10, 'length of the state')
    call check%that(all([crank%position, pin%position, crank%rate, pin%rate, bristle%first, bristle%last, work%first, work%last] &
      == [1, 2, 4, 5, 7, 9, 10, 10]), 'positions, their rates, states, quadratures')
    call layout%claim_quadratures(1, 0.0_dp, late)
    call check%that(late%first == 11 .and. late%last == 11 .and. layout%n() == 11, 'a later quadrature comes last')
    call layout%natural_scales(scale, grows)
    call check%that(all(nint(scale) == [1, 3, 3, 2, 4, 4, 7, 7, 7, 5, 0]), 'scales of the components')
    call check%that(all(grows .eqv. [.true., spread(.false., 1, 8), .true., .true.]), 'an angle and quadratures grow without bound')
  end subroutine run_test_state_layout
end module test_state_layout
