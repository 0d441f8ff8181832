!> The friction laws: values, continuity, signs, factory.
module test_friction
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, status_case_file
  use checks, only: checks_t
  use friction_law, only: friction_law_t
  use laws, only: friction_law_of
  implicit none
  private
  public :: run_test_friction

contains

  subroutine run_test_friction(check)
    class(checks_t), intent(inout) :: check
    call test_ramp(check)
    call test_jump(check)
    call test_coulomb(check)
    call test_factory(check)
  end subroutine run_test_friction

  subroutine test_ramp(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp) :: speed, ratio, previous
    integer :: i
    call friction_law_of("law='ambrosio' coefficient=0.05 v0=1e-3 v1=1e-2", law, error)
    call check%that(.not. law%set_valued, 'the ramp is single-valued')
    call check%close_to(law%friction_ratio(0.0_dp, 1), 0.0_dp, 0.0_dp, 'no friction at rest')
    call check%close_to(law%friction_ratio(0.9e-3_dp, 1), 0.0_dp, 0.0_dp, 'no friction below v0')
    call check%close_to(law%friction_ratio(5.5e-3_dp, 1), -0.025_dp, 1e-17_dp, 'half the friction half way')
    call check%close_to(law%friction_ratio(-5.5e-3_dp, 1), 0.025_dp, 1e-17_dp, 'friction opposes sliding')
    call check%close_to(law%friction_ratio(3.25e-3_dp, -1), -0.0125_dp, 1e-17_dp, 'a quarter, whatever the direction')
    call check%close_to(law%friction_ratio(1e-2_dp, 1), -0.05_dp, 0.0_dp, 'full friction at v1')
    call check%close_to(law%friction_ratio(-1e300_dp, 1), 0.05_dp, 0.0_dp, 'full friction beyond')
    previous = law%friction_ratio(-2e-2_dp, 1)
    do i = -1999, 2000
      speed = 1e-5_dp*i
      ratio = law%friction_ratio(speed, 1)
      call check%that(ratio*speed <= 0, 'friction dissipates')
      call check%that(abs(ratio - previous) <= 0.05_dp*1e-5_dp/9e-3_dp*1.001_dp, 'the ramp is continuous')
      previous = ratio
    end do
  end subroutine test_ramp

  subroutine test_jump(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    call friction_law_of("law='ambrosio' coefficient=0.1 v0=1e-3 v1=1e-3", law, error)
    call check%close_to(law%friction_ratio(0.999e-3_dp, 1), 0.0_dp, 0.0_dp, 'below the jump')
    call check%close_to(law%friction_ratio(1.001e-3_dp, 1), -0.1_dp, 0.0_dp, 'above the jump')
    call check%close_to(law%friction_ratio(-1.001e-3_dp, 1), 0.1_dp, 0.0_dp, 'above the jump, backwards')
    call friction_law_of("law='ambrosio' coefficient=0.1 v0=0 v1=1e-3", law, error)
    call check%close_to(law%friction_ratio(0.5e-3_dp, 1), -0.05_dp, 1e-17_dp, 'a ramp from rest')
  end subroutine test_jump

  subroutine test_coulomb(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    integer :: i
    character(len=8), parameter :: names(2) = ['coulomb ', 'ambrosio']
    do i = 1, 2
      call friction_law_of('law='''//trim(names(i))//''' coefficient=0.03 v0=0 v1=0', law, error)
      call check%that(law%set_valued, 'Coulomb friction is set-valued')
      call check%close_to(law%friction_ratio(0.2_dp, 1), -0.03_dp, 0.0_dp, 'sliding forwards')
      call check%close_to(law%friction_ratio(-0.2_dp, -1), 0.03_dp, 0.0_dp, 'sliding backwards')
      call check%close_to(law%friction_ratio(0.0_dp, -1), 0.03_dp, 0.0_dp, 'the direction decides at rest')
    end do
  end subroutine test_coulomb

  subroutine test_factory(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    call friction_law_of("law='glue' coefficient=0.1", law, error)
    call check%that(allocated(error) .and. .not. allocated(law), 'an unknown friction law is refused')
    if (.not. allocated(error)) return
    call check%equal_text(error%message, "x.nml:1: &friction law = glue: must be one of ambrosio, coulomb", &
      'the refusal names the laws')
    call check%that(error%status == status_case_file, 'the refusal is a case file error')
  end subroutine test_factory
end module test_friction
