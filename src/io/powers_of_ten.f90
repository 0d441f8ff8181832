!> Powers of ten to 90 bits, with which binary numbers become decimal ones.
module powers_of_ten
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: power_of_ten_t, power_of_ten, make_powers, first_power, last_power, last_exact_power, limb_bits, &
    floor_log

  integer, parameter :: first_power = -308, last_power = 340   !! enough for 1 to 17 digits of any real(dp)
  integer, parameter :: last_exact_power = 38   !! 5**38 < 2**90: 10**0 to 10**38 lose nothing
  integer, parameter :: limb_bits = 30          !! products of two limbs can be added up in an int64

  !> 10**k = (high 2**60 + middle 2**30 + low) 2**exponent. Its first bit is 1; what follows the 90 bits is cut off, so it
  !> is too small by less than 1.000001 of its last place.
  type :: power_of_ten_t
    integer(int64) :: low, middle, high
    integer(int64) :: exponent
  end type power_of_ten_t

  integer, parameter :: n_limbs = 3, wide_bits = 60   !! 180 bits in the making: what 340 steps cut off stays below 2**-160
  integer(int64), parameter :: base = 2_int64**wide_bits

contains

  !> floor(log10(2**exponent)); |exponent| < 1200.
  pure integer function floor_log(exponent)
    integer, intent(in) :: exponent
    floor_log = shifta(exponent*78913, 18)
  end function floor_log

  !> The powers from `first` to `last`, first_power <= first < 0 <= last <= last_power; all of them in some 5 microseconds.
  pure subroutine make_powers(first, last, powers)
    integer, intent(in) :: first, last
    type(power_of_ten_t), intent(out) :: powers(first:last)
    integer(int64) :: limbs(n_limbs), exponent
    integer :: k

    call begin(limbs, exponent)
    do k = 0, last
      powers(k) = highest_bits(limbs, exponent)
      call multiply_by_ten(limbs, exponent)
    end do
    call begin(limbs, exponent)
    do k = -1, first, -1
      call divide_by_ten(limbs, exponent)
      powers(k) = highest_bits(limbs, exponent)
    end do
  end subroutine make_powers

  !> One of them.
  pure type(power_of_ten_t) function power_of_ten(k)
    integer, intent(in) :: k   !! first_power to last_power
    integer(int64) :: limbs(n_limbs), exponent
    integer :: i
    call begin(limbs, exponent)
    do i = 1, k
      call multiply_by_ten(limbs, exponent)
    end do
    do i = -1, k, -1
      call divide_by_ten(limbs, exponent)
    end do
    power_of_ten = highest_bits(limbs, exponent)
  end function power_of_ten

  !> The number 1, which the chains of powers begin with.
  pure subroutine begin(limbs, exponent)
    integer(int64), intent(out) :: limbs(n_limbs), exponent
    limbs = [0_int64, 0_int64, base/2]
    exponent = 1 - 3*limb_bits
  end subroutine begin

  pure subroutine multiply_by_ten(limbs, exponent)
    integer(int64), intent(inout) :: limbs(n_limbs), exponent
    call scale(limbs, exponent, 5, 4)   ! 10 = 5/4 2**3
    exponent = exponent + 3
  end subroutine multiply_by_ten

  pure subroutine divide_by_ten(limbs, exponent)
    integer(int64), intent(inout) :: limbs(n_limbs), exponent
    call scale(limbs, exponent, 8, 5)   ! 1/10 = 8/5 2**(-4)
    exponent = exponent - 4
  end subroutine divide_by_ten

  !> The 90 bits that are kept.
  pure type(power_of_ten_t) function highest_bits(limbs, exponent) result(power)
    integer(int64), intent(in) :: limbs(n_limbs), exponent
    power%low = shiftr(limbs(2), limb_bits)
    power%middle = ibits(limbs(3), 0, limb_bits)
    power%high = shiftr(limbs(3), limb_bits)
    power%exponent = exponent
  end function highest_bits

  !> Multiply a number with its first bit set, lowest limb first, by a fraction between 1 and 2, so that it is again one. Neither
  !> of its numbers is above 8, with which nothing here overflows.
  pure subroutine scale(limbs, exponent, numerator, denominator)
    integer(int64), intent(inout) :: limbs(n_limbs), exponent
    integer, intent(in) :: numerator, denominator
    integer :: i
    limbs = limbs*numerator
    do i = 1, n_limbs - 1
      limbs(i + 1) = limbs(i + 1) + shiftr(limbs(i), wide_bits)
      limbs(i) = iand(limbs(i), base - 1)
    end do
    call divide(limbs, denominator)
    if (limbs(n_limbs) < base) return
    call divide(limbs, 2)
    exponent = exponent + 1
  end subroutine scale

  !> Divide, from the highest limb down; the rest is dropped.
  pure subroutine divide(limbs, denominator)
    integer(int64), intent(inout) :: limbs(n_limbs)
    integer, intent(in) :: denominator
    integer(int64) :: dividend
    integer :: i
    dividend = limbs(n_limbs)
    do i = n_limbs, 2, -1
      limbs(i) = dividend/denominator
      dividend = (dividend - limbs(i)*denominator)*base + limbs(i - 1)
    end do
    limbs(1) = dividend/denominator
  end subroutine divide
end module powers_of_ten
