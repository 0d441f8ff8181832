!> The friction laws without memory: values, derivatives, continuity, signs.
module test_friction
  use kinds, only: dp
  use error_handling, only: error_t
  use checks, only: checks_t
  use friction_law, only: friction_law_t
  use laws, only: friction_law_of
  use data_tables, only: load_table
  implicit none
  private
  public :: run_test_friction

  character(len=*), parameter :: brown_mcphee_keys = &
    "law='brown_mcphee' coefficient=0.08 static_coefficient=0.12 transition_speed=0.01 viscous_coefficient=2e-3"
  character(len=*), parameter :: stribeck_keys = "law='stribeck' coefficient=0.08 static_coefficient=0.12 "// &
    "stribeck_speed=0.02 transition_speed=1e-3 viscous_coefficient=2e-3"

contains

  subroutine run_test_friction(check)
    class(checks_t), intent(inout) :: check
    call test_ramp(check)
    call test_jump(check)
    call test_coulomb(check)
    call test_curves(check)
    call test_peaks(check)
    call test_slopes(check)
    call test_extremes(check)
    call test_static_coulomb(check)
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
    call check%close_to(law%friction_ratio(5.5e-3_dp, 1), -0.025_dp, 1e-17_dp, 'half of the friction at the middle of the ramp')
    call check%close_to(law%friction_ratio(-5.5e-3_dp, 1), 0.025_dp, 1e-17_dp, 'friction opposes sliding')
    call check%close_to(law%friction_ratio(3.25e-3_dp, -1), -0.0125_dp, 1e-17_dp, &
      'a quarter of the friction at a quarter of the ramp')
    call check%close_to(law%friction_ratio(1e-2_dp, 1), -0.05_dp, 0.0_dp, 'full friction at v1')
    call check%close_to(law%friction_ratio(-1e300_dp, 1), 0.05_dp, 0.0_dp, 'full friction beyond v1')
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
      call check%close_to(law%friction_ratio(0.0_dp, -1), 0.03_dp, 0.0_dp, 'friction at rest has the given direction')
    end do
  end subroutine test_coulomb

  !> The table of an independent implementation (data/README.md), and some of its numbers with 12 digits.
  subroutine test_curves(check)
    class(checks_t), intent(inout) :: check
    character(len=130), parameter :: keys(5) = [character(len=130) :: "law='coulomb' coefficient=0.08", &
      "law='ambrosio' coefficient=0.08 v0=1e-3 v1=1e-2", "law='threlfall' coefficient=0.08 v1=1e-2", brown_mcphee_keys, &
      stribeck_keys]
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: table(:, :)
    integer :: i, row
    call load_table('friction/curves.csv', names, table)
    call check%that(size(table, 2) == 27, 'the table of friction curves has all rows')
    do i = 1, size(keys)
      call friction_law_of(trim(keys(i)), law, error)
      do row = 1, size(table, 2)
        associate (v => table(1, row))
          if (law%set_valued .and. .not. abs(v) > 0) cycle
          call check%close_to(law%friction_ratio(v, nint(sign(1.0_dp, v))), table(i + 1, row), 2e-12_dp, &
            'curve of '//trim(law%name))
        end associate
      end do
      if (law%name == 'threlfall') call check%relative(law%friction_ratio(5e-3_dp, 1), -0.0621495871881_dp, 1e-11_dp, &
        'threlfall at half v1')
      if (law%name == 'threlfall') call check%relative(law%friction_ratio(1e-15_dp, 1), -2.4e-14_dp, 1e-12_dp, &
        'threlfall at 1e-13 of v1')
      if (law%name == 'brown_mcphee') call check%relative(law%friction_ratio(-0.05_dp, 1), 0.0841816326531_dp, 1e-11_dp, &
        'brown_mcphee at five transition speeds')
      if (law%name == 'stribeck') call check%relative(law%friction_ratio(0.01_dp, 1), -0.111172030865_dp, 1e-11_dp, &
        'stribeck at half the Stribeck speed')
    end do
  end subroutine test_curves

  !> The largest friction of Brown and McPhee's law is 0.9994 to 0.9998 c_s, at 1.001 to 1.016 transition speeds.
  subroutine test_peaks(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp) :: ratio, peak, at
    integer :: i
    call friction_law_of("law='brown_mcphee' coefficient=0.08 static_coefficient=0.12 transition_speed=0.01", law, error)
    peak = 0
    at = 0
    do i = 1, 40000
      ratio = -law%friction_ratio(1e-6_dp*i, 1)
      if (ratio > peak) at = 1e-6_dp*i
      peak = max(peak, ratio)
    end do
    call check%that(peak > 0.9994_dp*0.12_dp .and. peak < 0.9998_dp*0.12_dp, 'largest friction is the static friction')
    call check%that(at > 1.001e-2_dp .and. at < 1.016e-2_dp, 'largest friction is at the transition speed')
    call check%relative(-law%friction_ratio(10.0_dp, 1), 0.08_dp, 1e-7_dp, 'friction at high speeds is sliding friction')
  end subroutine test_peaks

  !> The analytical derivatives against central differences.
  subroutine test_slopes(check)
    class(checks_t), intent(inout) :: check
    character(len=130), parameter :: keys(5) = [character(len=130) :: "law='ambrosio' coefficient=0.08 v0=1e-3 v1=1e-2", &
      "law='threlfall' coefficient=0.08 v1=1e-2", brown_mcphee_keys, stribeck_keys, "law='stribeck' coefficient=0.08 "// &
      "static_coefficient=0.12 stribeck_speed=0.02 transition_speed=1e-3 stribeck_exponent=0.5"]
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp) :: v, step
    integer :: i, j
    do i = 1, size(keys)
      call friction_law_of(trim(keys(i)), law, error)
      do j = -40, 40
        v = sign(1e-6_dp*1.5_dp**abs(j), real(j, dp))
        if (j == 0) v = 0
        step = max(1e-5_dp*abs(v), 1e-11_dp)
        if (j == 0 .and. i == 5) cycle   ! its second derivative is unbounded there
        call check%close_to(law%friction_ratio_slope(v), (law%friction_ratio(v + step, 1) - law%friction_ratio(v - step, 1)) &
          /(2*step), 1e-5_dp*abs(law%friction_ratio_slope(v)) + 1e-10_dp/step*1e-5_dp, 'slope of '//trim(law%name))
      end do
    end do
  end subroutine test_slopes

  !> At the ends of every range friction opposes sliding, is an odd function and is finite; so is its derivative.
  subroutine test_extremes(check)
    class(checks_t), intent(inout) :: check
    character(len=130), parameter :: keys(8) = [character(len=130) :: "law='threlfall' coefficient=2 v1=1e-9", &
      "law='threlfall' coefficient=0 v1=1e3", &
      "law='brown_mcphee' coefficient=0 static_coefficient=1 transition_speed=1e-9", &
      "law='brown_mcphee' coefficient=0.1 static_coefficient=0.1 transition_speed=1e3 viscous_coefficient=1", &
      "law='brown_mcphee' coefficient=0.1 transition_speed=1e-3", &
      "law='stribeck' coefficient=0.1 static_coefficient=0.2 stribeck_speed=1e-9 transition_speed=1e-9 stribeck_exponent=10", &
      "law='stribeck' coefficient=0.1 static_coefficient=0.2 stribeck_speed=1e3 transition_speed=1e-9 stribeck_exponent=0.1", &
      "law='stribeck' coefficient=0.1 stribeck_speed=1e-3 transition_speed=10 viscous_coefficient=1"]
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    real(dp) :: v, ratio
    integer :: i, j
    do i = 1, size(keys)
      call friction_law_of(trim(keys(i)), law, error)
      do j = -30, 12
        v = 10.0_dp**j
        ratio = law%friction_ratio(v, 1)
        call check%that(ratio <= 0 .and. ratio >= -2 - v, 'friction opposes sliding: '//trim(law%name))
        call check%that(.not. abs(ratio + law%friction_ratio(-v, -1)) > 0, 'friction is an odd function: '//trim(law%name))
        call check%that(abs(law%friction_ratio_slope(v)) < 1e12_dp, 'derivative of the friction is finite: '//trim(law%name))
      end do
      call check%that(.not. abs(law%friction_ratio(0.0_dp, 1)) > 0, 'no friction at rest: '//trim(law%name))
    end do
  end subroutine test_extremes

  subroutine test_static_coulomb(check)
    class(checks_t), intent(inout) :: check
    class(friction_law_t), allocatable :: law
    type(error_t), allocatable :: error
    call friction_law_of("law='coulomb' coefficient=0.1 static_coefficient=0.15", law, error)
    call check%close_to(law%friction_ratio(0.2_dp, 1), -0.1_dp, 0.0_dp, 'coefficient of friction of sliding surfaces')
    call check%close_to(law%holding_ratio(), 0.15_dp, 0.0_dp, 'coefficient of friction of sticking surfaces')
    call friction_law_of("law='coulomb' coefficient=0.1", law, error)
    call check%close_to(law%holding_ratio(), 0.1_dp, 0.0_dp, 'static friction is sliding friction by default')
  end subroutine test_static_coulomb
end module test_friction
