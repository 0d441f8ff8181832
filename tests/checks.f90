!> The test harness: named checks, counted, failures printed as they happen.
module checks
  use, intrinsic :: iso_fortran_env, only: output_unit
  use kinds, only: dp
  implicit none
  private
  public :: checks_t

  !> Counts of one test run. A check prints only when it fails.
  type :: checks_t
    integer :: passed = 0
    integer :: failed = 0
  contains
    procedure :: that          !! a condition holds
    procedure :: close_to      !! |got - want| <= tolerance
    procedure :: relative      !! |got - want| <= tolerance*|want|
    procedure :: equal_text    !! two texts are the same
  end type checks_t

contains

  subroutine that(self, condition, name)
    class(checks_t), intent(inout) :: self
    logical, intent(in) :: condition
    character(len=*), intent(in) :: name
    if (condition) then
      self%passed = self%passed + 1
    else
      self%failed = self%failed + 1
      write (output_unit, '(2a)') 'FAILED: ', name
    end if
  end subroutine that

  !> A NaN never passes.
  subroutine close_to(self, got, want, tolerance, name)
    class(checks_t), intent(inout) :: self
    real(dp), intent(in) :: got, want, tolerance
    character(len=*), intent(in) :: name
    character(len=120) :: figures
    write (figures, '(a,es23.16,a,es23.16,a,es8.1)') ': got ', got, ', want ', want, ' within ', tolerance
    call self%that(abs(got - want) <= tolerance, name//trim(figures))
  end subroutine close_to

  subroutine relative(self, got, want, tolerance, name)
    class(checks_t), intent(inout) :: self
    real(dp), intent(in) :: got, want, tolerance
    character(len=*), intent(in) :: name
    call self%close_to(got, want, tolerance*abs(want), name)
  end subroutine relative

  subroutine equal_text(self, got, want, name)
    class(checks_t), intent(inout) :: self
    character(len=*), intent(in) :: got, want, name
    call self%that(got == want .and. len(got) == len(want), name//': got "'//got//'", want "'//want//'"')
  end subroutine equal_text
end module checks
