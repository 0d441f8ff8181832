!> Powers of ten to 90 bits, with which binary numbers become decimal ones.
module powers_of_ten
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private
  public :: power_of_ten_t, make_powers, first_power, last_power, last_exact_power, limb_bits, &
    floor_log

  integer, parameter :: first_power = -308, last_power = 340   !! enough for 1 to 17 digits of any real(dp)
  integer, parameter :: last_exact_power = 38   !! 5**38 < 2**90: 10**0 to 10**38 lose nothing
  integer, parameter :: limb_bits = 30          !! products of two limbs can be added up in an int64

  !> 10**k = (high 2**60 + middle 2**30 + low) 2**exponent. Its first bit is 1; what follows the 90 bits is cut off, so it
  !> is too small by less than 1.000001 of its last place.
  type :: power_of_ten_t
    integer(int64) :: low = 0, middle = 0, high = 0
    integer(int64) :: exponent = 0
  end type power_of_ten_t

  integer, parameter :: n_limbs = 6   !! 180 bits in the making: what a chain of 340 steps cuts off stays below 2**-160
  integer(int64), parameter :: base = 2_int64**limb_bits

contains

  !> floor(log10(2**exponent)); |exponent| < 1200.
  pure integer function floor_log(exponent)
    integer, intent(in) :: exponent
    floor_log = shifta(exponent*78913, 18)
  end function floor_log

  !> All powers, in some 20 microseconds.
  pure subroutine make_powers(powers)
    type(power_of_ten_t), intent(out) :: powers(first_power:last_power)
    integer(int64), parameter :: one(n_limbs) = [0_int64, 0_int64, 0_int64, 0_int64, 0_int64, base/2]
    integer(int64) :: limbs(n_limbs), exponent
    integer :: k

    limbs = one
    exponent = 1 - 3*limb_bits
    do k = 0, last_power
      powers(k) = power_of_ten_t(limbs(4), limbs(5), limbs(6), exponent)
      call scale(limbs, exponent, 5, 4)   ! 10 = 5/4 2**3
      exponent = exponent + 3
    end do
    limbs = one
    exponent = 1 - 3*limb_bits
    do k = -1, first_power, -1
      call scale(limbs, exponent, 8, 5)   ! 1/10 = 8/5 2**(-4)
      exponent = exponent - 4
      powers(k) = power_of_ten_t(limbs(4), limbs(5), limbs(6), exponent)
    end do
  end subroutine make_powers

  !> Multiply a number with its first bit set, lowest limb first, by a fraction between 1 and 2, so that it is again one.
  pure subroutine scale(limbs, exponent, numerator, denominator)
    integer(int64), intent(inout) :: limbs(n_limbs), exponent
    integer, intent(in) :: numerator, denominator
    integer :: i
    limbs = limbs*numerator
    do i = 1, n_limbs - 1
      limbs(i + 1) = limbs(i + 1) + limbs(i)/base
      limbs(i) = mod(limbs(i), base)
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
      dividend = mod(dividend, int(denominator, int64))*base + limbs(i - 1)
    end do
    limbs(1) = dividend/denominator
  end subroutine divide
end module powers_of_ten
