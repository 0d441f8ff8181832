!> What is known of a column of the trace over a time: the numbers from which its results follow.
module column_fold
  use kinds, only: dp
  use constants, only: degree
  use trace_row, only: kept_t, least, largest, largest_size, spread, root_mean_square, integral, changes, reversed, &
    reversed_angle, impacts
  implicit none
  private
  public :: fold_t, found, set_found, is_searched, has_senses, sense_of

  type :: fold_t
    real(dp) :: most(2) = -huge(1.0_dp)                !! largest value, and negative of the smallest one
    real(dp) :: angle(2) = 0                           !! crank angles of these [rad]
    real(dp) :: sum = 0, square = 0                    !! integrals over time of values and of their squares, where sampled
    real(dp) :: duration = 0                           !! that time [s]
    integer :: number = 0                              !! of changes of the sense, or of contacts that began
    real(dp) :: turned(2) = 0                          !! crank angle with values above 0, and below [rad]
  contains
    procedure :: add
    procedure :: joined
    generic :: operator(+) => joined
  end type fold_t

contains

  !> Account for a value at a crank angle [rad].
  elemental subroutine add(self, value, angle)
    class(fold_t), intent(inout) :: self
    real(dp), intent(in) :: value, angle
    if (value > self%most(1)) self%angle(1) = angle
    if (-value > self%most(2)) self%angle(2) = angle
    self%most = max(self%most, [value, -value])
  end subroutine add

  !> What is known of two times together, the first one first. Of extremes that differ by rounding alone the angle is that of the
  !> first.
  elemental type(fold_t) function joined(one, other) result(both)
    class(fold_t), intent(in) :: one
    type(fold_t), intent(in) :: other
    real(dp), parameter :: rounding = 1e-9_dp
    both%most = max(one%most, other%most)
    both%angle = merge(other%angle, one%angle, other%most > one%most + rounding*abs(one%most))
    both%sum = one%sum + other%sum
    both%square = one%square + other%square
    both%duration = one%duration + other%duration
    both%number = one%number + other%number
    both%turned = one%turned + other%turned
  end function joined

  !> The result that is kept of a column, from what is known of it, in the unit of the result.
  pure real(dp) function found(kept, known)
    type(kept_t), intent(in) :: kept
    type(fold_t), intent(in) :: known
    select case (kept%what)
    case (least)
      found = -known%most(2)
    case (largest)
      found = known%most(1)
      if (kept%at_impacts) found = max(0.0_dp, found)   ! 0: no contact began
    case (largest_size)
      found = maxval(known%most)
    case (spread)
      found = sum(known%most)
    case (integral)
      found = known%sum
    case (root_mean_square)
      found = sqrt(known%square/max(known%duration, tiny(1.0_dp)))
    case (changes, impacts)
      found = known%number
    case (reversed)
      found = max(0.0_dp, minval(known%most))
    case (reversed_angle)
      found = known%turned(minloc(known%most, 1))/degree
    case default   ! mean
      found = known%sum/max(known%duration, tiny(1.0_dp))
    end select
  end function found

  !> Set what is known so that an extreme has a value.
  pure subroutine set_found(kept, value, known)
    type(kept_t), intent(in) :: kept
    real(dp), intent(in) :: value
    type(fold_t), intent(inout) :: known
    if (kept%what /= least) known%most(1) = value
    if (kept%what /= largest) known%most(2) = merge(-value, value, kept%what == least)
  end subroutine set_found

  !> Whether a result needs the true largest value of its column, and the true smallest one.
  pure function is_searched(kept)
    type(kept_t), intent(in) :: kept
    logical :: is_searched(2)
    is_searched(1) = any(kept%what == [largest, largest_size, spread]) .or. has_senses(kept)
    is_searched(2) = any(kept%what == [least, largest_size, spread]) .or. has_senses(kept)
  end function is_searched

  !> Whether a result needs the senses of its column.
  elemental logical function has_senses(kept)
    type(kept_t), intent(in) :: kept
    has_senses = any(kept%what == [changes, reversed, reversed_angle])
  end function has_senses

  !> 1: above 0, -1: below, 0: neither.
  elemental integer function sense_of(value)
    real(dp), intent(in) :: value
    sense_of = merge(nint(sign(1.0_dp, value)), 0, abs(value) > 0)
  end function sense_of
end module column_fold
