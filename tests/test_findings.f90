!> Statements of chapter 6 of the dissertation (Reis 2013), checked with the shipped cases.
module test_findings
  use kinds, only: dp
  use chain_motion, only: piston_pin
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_findings

  integer, parameter :: long = 60
  character(len=3), parameter :: simulations(6) = [character(len=3) :: 'I', 'II', 'III', 'IV', 'V', 'VI']

contains

  subroutine run_test_findings(check)
    class(checks_t), intent(inout) :: check
    call the_journal_film_never_touches(check)
    call the_oscillating_film_touches(check)
    call engines_settle_at_their_speed(check, 'IV', '6', 251.0_dp)
    call engines_settle_at_their_speed(check, 'V', '6', 251.0_dp)
    call engines_settle_at_their_speed(check, 'VI', '2', 990.0_dp)
    call benchmark_keeps_its_energy(check)
  end subroutine run_test_findings

  !> Simulations I to VI with the Pinkus-Sternlicht film: no contact, and more dissipation in II than in I.
  subroutine the_journal_film_never_touches(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: lost(6)
    integer :: i
    do i = 1, 6
      trace = run_case('cases/sim_'//trim(simulations(i))//'.nml', [character(len=long) :: 'integrator.method=radau', &
        'integrator.relative_tolerance=1e-8'])
      call check%that(.not. allocated(trace%error), 'Pinkus-Sternlicht '//simulations(i)//' runs')
      call check%that(size(trace%event) == 0 .and. trace%report%figures%pin(piston_pin)%min_film_thickness > 0, &
        'Pinkus-Sternlicht '//simulations(i)//' has no contact')
      associate (e => trace%values(column(trace, 'energy[J]'), :))
        lost(i) = e(1) - e(size(e))
      end associate
    end do
    call check%that(lost(1) > 0 .and. lost(2) > lost(1), 'dissipation grows from I to II')
  end subroutine the_journal_film_never_touches

  !> With the oscillating film there is contact in all six simulations, and most of the time in III and VI.
  subroutine the_oscillating_film_touches(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: fraction
    integer :: i
    do i = 1, 6
      trace = run_case('cases/sim_'//trim(simulations(i))//'_oscillating.nml', [character(len=long) :: &
        'integrator.relative_tolerance=1e-9'])
      call check%that(.not. allocated(trace%error), 'oscillating film '//simulations(i)//' runs')
      call check%that(trace%report%figures%pin(piston_pin)%contacts > 0, 'oscillating film '//simulations(i)//' has contacts')
      fraction = trace%report%figures%pin(piston_pin)%contact_time/trace%report%figures%time
      if (mod(i, 3) == 0) call check%that(fraction > 0.5_dp, 'oscillating film '//simulations(i)//' is in contact most of the time')
      call check%close_to(trace%report%figures%max_energy_residual/trace%report%figures%max_energy, 0.0_dp, 1e-7_dp, &
        'energy residual of the oscillating film '//simulations(i))
    end do
  end subroutine the_oscillating_film_touches

  !> Mean crank speed over the last quarter of a long run, within 2 % [rad/s].
  subroutine engines_settle_at_their_speed(check, simulation, seconds, speed)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: simulation, seconds
    real(dp), intent(in) :: speed
    type(trace_t) :: trace
    character(len=long) :: overrides(5)
    integer :: first, last
    overrides = [character(len=long) :: 'integrator.method=radau', 'integrator.revolutions=0', '', &
      'output.interval=0.001', 'output.columns=time, crank_angle']
    overrides(3) = 'integrator.end_time='//seconds
    trace = run_case('cases/sim_'//simulation//'.nml', overrides)
    call check%that(.not. allocated(trace%error), 'long run of '//simulation)
    last = size(trace%values, 2)
    first = (3*last)/4
    call check%relative((trace%values(2, last) - trace%values(2, first))/(trace%values(1, last) - trace%values(1, first)), &
      speed, 0.02_dp, 'mean speed of '//simulation)
  end subroutine engines_settle_at_their_speed

  !> Energy residual of every Flores case at a relative tolerance of 1e-9.
  subroutine benchmark_keeps_its_energy(check)
    class(checks_t), intent(inout) :: check
    character(len=20), parameter :: files(8) = [character(len=20) :: 'ideal', 'dry_0500um', 'dry_0100um', 'dry_0010um', &
      'friction_010', 'friction_050', 'friction_100', 'lubricated_400cP']
    type(trace_t) :: trace
    integer :: i
    do i = 1, size(files)
      trace = run_case('cases/flores/'//trim(files(i))//'.nml', [character(len=long) :: &
        'integrator.relative_tolerance=1e-9'])
      call check%that(.not. allocated(trace%error), trim(files(i))//' runs')
      call check%close_to(trace%report%figures%max_energy_residual/trace%report%figures%max_energy, 0.0_dp, 1e-7_dp, &
        'energy residual of '//trim(files(i)))
    end do
  end subroutine benchmark_keeps_its_energy
end module test_findings
