!> Runs in which the worn shape of the bore acts, and errors in cases.
module test_worn_bore_runs
  use kinds, only: dp
  use checks, only: checks_t
  use archard_wear, only: of_bore
  use case_checks, only: expect, methods_agree
  use collecting_sink, only: trace_t, run_case
  implicit none
  private
  public :: run_test_worn_bore_runs

  character(len=*), parameter :: file = 'cases/wear/worn_bore.nml'
  real(dp), parameter :: c = 1e-4_dp, radius = 10e-3_dp, length = 15e-3_dp, modulus = 1e13_dp   !! of the tables [m], [Pa/m]

contains

  subroutine run_test_worn_bore_runs(check)
    class(checks_t), intent(inout) :: check
    call bore_changes(check)
    call steps_are_limited(check)
    call methods_agree_when_worn(check)
    call last_change_counts(check)
    call refuses(check)
  end subroutine run_test_worn_bore_runs

  !> A run whose bore changes after every revolution: without extrapolation it wears as a round bore does, since the depths are far
  !> below the penetration; the turns and the volume grow with the extrapolation.
  subroutine bore_changes(check)
    class(checks_t), intent(inout) :: check
    character(len=28), parameter :: short = 'integrator.revolutions=2.5'
    type(trace_t) :: round, plain, more
    round = run_case(file, [character(len=28) :: short, 'wear.bore=round', 'wear.extrapolation=1'])
    plain = run_case(file, [character(len=28) :: short, 'wear.extrapolation=1'])
    more = run_case(file, [character(len=28) :: short, 'wear.extrapolation=1000'])
    call check%that(.not. (allocated(round%error) .or. allocated(plain%error) .or. allocated(more%error)), 'worn bores run')
    if (allocated(round%error) .or. allocated(plain%error) .or. allocated(more%error)) return
    associate (a => round%report%wear(1), b => plain%report%wear(1), d => more%report%wear(1))
      call check%relative(sum(b%volume(:, of_bore)), sum(a%volume(:, of_bore)), 1e-3_dp, 'a worn bore wears as a round one')
      call check%close_to(b%turns, 2.0_dp, 0.0_dp, 'turns of a worn bore')
      call check%close_to(d%turns, 2000.0_dp, 0.0_dp, 'turns with extrapolation')
      call check%that(sum(d%volume(:, of_bore)) > 500*sum(b%volume(:, of_bore)), 'extrapolated wear')
      call check%that(.not. a%bore_changes .and. b%bore_changes, 'which bores change')
    end associate
    associate (figures => more%report%figures)
      call check%that(figures%max_energy_residual < 1e-6_dp*figures%max_energy, 'energy with a bore that changes')
    end associate
  end subroutine bore_changes

  !> An extrapolation that is too large is reduced to the limit of the change of depth.
  subroutine steps_are_limited(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    trace = run_case(file, [character(len=34) :: 'integrator.revolutions=2.5', 'wear.extrapolation=1e9', &
      'wear.greatest_step_ratio=0.01'])
    call check%that(.not. allocated(trace%error), 'a run with too much extrapolation')
    if (allocated(trace%error)) return
    call check%relative(trace%report%wear(1)%step_ratios(2), 0.02_dp, 1e-9_dp, 'change of depth over the mean penetration')
    call check%that(trace%report%wear(1)%step_ratios(1) < 0.01_dp, 'change of depth over the clearance')
    call check%that(trace%report%wear(1)%turns < 1e9_dp, 'extrapolation is reduced')
  end subroutine steps_are_limited

  !> How wear is distributed over the bins depends slightly on the steps, hence twice the tolerance of other joints.
  subroutine methods_agree_when_worn(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    call methods_agree(check, file, [character(len=40) :: 'integrator.revolutions=1.1', 'wear.rate=0.0,1e-9', &
      'wear.extrapolation=1'], 2*c, 'a worn bore', trace)
    if (.not. allocated(trace%report%wear)) return
    call check%that(maxval(trace%report%wear(1)%depth(:, of_bore)) > 1e-6_dp, 'the bore is worn deeper than it is pressed')
  end subroutine methods_agree_when_worn

  !> A change of shape is due at the end of runs of whole revolutions too, whatever rounding says of their last angle.
  subroutine last_change_counts(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace, longer
    character(len=40) :: revolutions
    character(len=40), parameter :: coarse(3) = [character(len=40) :: 'wear.extrapolation=100', &
      'integrator.relative_tolerance=1e-4', 'output.samples_per_revolution=10']
    real(dp) :: volume
    integer, parameter :: numbers(4) = [1, 2, 3, 5]
    integer :: i, n
    do i = 1, size(numbers)
      n = numbers(i)
      write (revolutions, '(a,i0)') 'integrator.revolutions=', n
      trace = run_case(file, [revolutions, coarse])
      call check%close_to(trace%report%wear(1)%turns, 100.0_dp*n, 0.0_dp, 'turns of a worn bore after whole revolutions')
      if (n /= 3) cycle
      longer = run_case(file, [character(len=40) :: 'integrator.revolutions=3.001', coarse])
      volume = sum(longer%report%wear(1)%volume)
      call check%relative(sum(trace%report%wear(1)%volume), volume, 1e-3_dp, 'volume of a worn bore after whole revolutions')
    end do
    trace = run_case(file, [character(len=40) :: 'integrator.revolutions=3', 'wear.cycles_per_update=3', coarse])
    call check%close_to(trace%report%wear(1)%turns, 300.0_dp, 0.0_dp, 'turns of a worn bore after one change')
  end subroutine last_change_counts

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: soft = '&contact geometry=''winkler'' bedding_modulus=1e13 / '
    call expect(check, soft//'&wear rate=0,1e-15 bore=''worn'' /', '', 'a worn bore')
    call expect(check, '&contact / &wear rate=0,1e-15 bore=''worn'' /', 'needs &contact geometry = ''winkler''', 'worn spheres')
    call expect(check, soft//'&wear rate=1e-15,0 bore=''worn'' /', '&wear rate', 'a worn bore that does not wear')
    call expect(check, soft//'&wear rate=0,1e-15 bore=''worn'' bins=20 /', '&wear bins = 20: must be >= 36', 'few bins')
    call expect(check, soft//'&lubrication viscosity=0.01 / &wear rate=0,1e-15 bore=''worn'' /', &
      '&wear bore = worn: must be round with lubrication', 'a worn bore with a film')
    call expect(check, soft//'&friction law=''coulomb'' coefficient=0.1 / &wear rate=0,1e-15 bore=''worn'' /', '&wear bore', &
      'a worn bore with surfaces that stick')
    call expect(check, soft//'&wear rate=0,1e-15 extrapolation=10 /', '&wear extrapolation = 10: is for bore', &
      'extrapolation without a worn bore')
  end subroutine refuses
end module test_worn_bore_runs
