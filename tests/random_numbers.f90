!> Random numbers that are the same on every machine: the combined multiple recursive generator MRG32k3a of P. L'Ecuyer
!> (Operations Research 47, 1999, 159-164), in 64-bit integers without overflow. Period 2^191.
module random_numbers
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  implicit none
  private
  public :: random_numbers_t

  integer(int64), parameter :: m1 = 4294967087_int64, m2 = 4294944443_int64
  integer(int64), parameter :: a12 = 1403580, a13 = 810728, a21 = 527612, a23 = 1370589

  type :: random_numbers_t
    integer(int64) :: first(3) = 12345, second(3) = 12345   !! the last three numbers of both recursions
  contains
    procedure :: begin
    procedure :: uniform
  end type random_numbers_t

contains

  !> Begin the sequence for a seed >= 0: the state is filled by Lehmer's generator (48271, 2^31 - 1).
  pure subroutine begin(self, seed)
    class(random_numbers_t), intent(inout) :: self
    integer, intent(in) :: seed
    integer(int64), parameter :: multiplier = 48271, modulus = 2147483647
    integer(int64) :: state(0:6)
    integer :: i
    state(0) = mod(int(seed, int64), modulus - 1) + 1
    do i = 1, 6
      state(i) = mod(multiplier*state(i - 1), modulus)
    end do
    self%first = state(1:3)
    self%second = state(4:6)
  end subroutine begin

  !> The next number, 0 < u < 1.
  subroutine uniform(self, u)
    class(random_numbers_t), intent(inout) :: self
    real(dp), intent(out) :: u
    integer(int64) :: p1, p2
    p1 = modulo(a12*self%first(2) - a13*self%first(1), m1)
    self%first = [self%first(2:3), p1]
    p2 = modulo(a21*self%second(3) - a23*self%second(1), m2)
    self%second = [self%second(2:3), p2]
    p1 = modulo(p1 - p2, m1)
    if (p1 == 0) p1 = m1
    u = p1*(1/real(m1 + 1, dp))
  end subroutine uniform
end module random_numbers
