!> Whether the film of a joint has settled: its smallest thickness in each cycle against that in the cycle before.
module settling
  use kinds, only: dp
  use constants, only: two_pi
  implicit none
  private
  public :: settling_t

  !> Follows one joint. Thicknesses are those at the accepted points, c - |e| [m].
  type :: settling_t
    integer :: revolutions = 1       !! in a cycle
    integer, private :: cycles = 0   !! number of cycles that have ended
    real(dp), private :: start = huge(1.0_dp)   !! crank travel at the first point [rad]
    real(dp), private :: least(0:2) = huge(1.0_dp)   !! in the present cycle, in the last one and in the one before that
  contains
    procedure :: record
    procedure :: change
  end type settling_t

contains

  !> Account for an accepted point.
  pure subroutine record(self, crank_travel, thickness)
    class(settling_t), intent(inout) :: self
    real(dp), intent(in) :: crank_travel   !! crank angle turned through, signed [rad]
    real(dp), intent(in) :: thickness      !! [m]
    if (self%start >= huge(self%start)) self%start = crank_travel
    if (abs(crank_travel - self%start) >= two_pi*self%revolutions*(self%cycles + 1)) then
      self%cycles = self%cycles + 1
      self%least = [huge(1.0_dp), self%least(:1)]
    end if
    self%least(0) = min(self%least(0), thickness)
  end subroutine record

  !> Change of the smallest thickness from the last cycle but one to the last, relative to the former [-]; 0 before the end of the
  !> third cycle, since the first one begins anywhere, and where the surfaces touch.
  pure real(dp) function change(self)
    class(settling_t), intent(in) :: self
    change = 0
    if (self%cycles > 2 .and. all(self%least(1:) > 0)) change = (self%least(1) - self%least(2))/self%least(2)
  end function change
end module settling
