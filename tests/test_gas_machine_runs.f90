!> Two-stroke engines and compressors in whole runs.
module test_gas_machine_runs
  use kinds, only: dp
  use constants, only: pi, degree
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, values_of
  implicit none
  private
  public :: run_test_gas_machine_runs

  integer, parameter :: long = 60

contains

  subroutine run_test_gas_machine_runs(check)
    class(checks_t), intent(inout) :: check
    call two_strokes_repeat(check)
    call compressor_gives_the_crank_its_work(check)
    call piston_that_swings(check)
  end subroutine run_test_gas_machine_runs

  !> The cycle of 360 degrees, in both directions of rotation, open between the port angles.
  subroutine two_strokes_repeat(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), allocatable :: pressure(:), angle(:)
    character(len=long), parameter :: settings(4) = [character(len=long) :: 'output.samples_per_revolution=360', &
      'integrator.revolutions=3', 'drive.kind=constant_speed', 'initial.crank_angle_deg=0.5']
    integer :: i
    trace = run_case('cases/gas/two_stroke.nml', settings, .true.)
    pressure = values_of(trace, 'cylinder_pressure[Pa]')
    angle = values_of(trace, 'crank_angle[rad]')
    call check%that(size(pressure) == 1081, 'three revolutions')
    call check%that(maxval(abs(pressure(361:720)/pressure(:360) - 1)) < 1e-8_dp, 'the pressure repeats after 360 degrees')
    do i = 1, 360
      if (abs(modulo(angle(i)/degree, 360.0_dp) - 180) < 75) call check%relative(pressure(i), 101325.0_dp, 1e-15_dp, 'open ports')
      if (abs(modulo(angle(i)/degree, 360.0_dp) - 180) > 76) call check%that(pressure(i) > 101325, 'closed ports')
    end do
  end subroutine two_strokes_repeat

  !> A free crank loses this work in each revolution, within 1e-8 of it, in both directions of rotation.
  subroutine compressor_gives_the_crank_its_work(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp) :: want, volume
    real(dp), allocatable :: energy(:)
    integer :: i
    real(dp), parameter :: n = 1.3_dp
    character(len=long) :: settings(8)
    settings = [character(len=long) :: 'drive.kind=free', 'mechanism.crank_inertia=1', 'mechanism.gravity=0', &
      'integrator.relative_tolerance=1e-12', 'integrator.crank_revolutions=2', 'initial.crank_angle_deg=150', &
      'initial.crank_speed=150', 'output.every_step=T']
    volume = 0.08_dp*pi*0.07_dp**2/4
    want = n/(n - 1)*1e5_dp*volume*(1.05_dp - 0.05_dp*5**(1/n))*(5**((n - 1)/n) - 1)
    do i = 1, 2
      if (i == 2) settings(7) = 'initial.crank_speed=-150'
      trace = run_case('cases/gas/compressor.nml', settings, .true.)
      call check%equal_text(trace%report%status, 'done', 'a compressor with a free crank completes its revolutions')
      energy = values_of(trace, 'energy[J]')
      call check%relative(energy(1) - energy(size(energy)), 2*want, 1e-8_dp, 'loss of a crank with a compressor in two revolutions')
      call check%that(trace%report%figures%max_energy_residual < 1e-8_dp*want, 'a compressor with a free crank: energy residual')
    end do
  end subroutine compressor_gives_the_crank_its_work

  !> A crank that is too slow to reach the discharge pressure swings back: the gas acts as a spring without loss.
  subroutine piston_that_swings(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    real(dp), allocatable :: speed(:), angle(:), pressure(:)
    integer :: i
    character(len=long), parameter :: settings(8) = [character(len=long) :: 'drive.kind=free', 'mechanism.gravity=0', &
      'integrator.relative_tolerance=1e-10', 'integrator.revolutions=0', 'integrator.end_time=0.5', &
      'initial.crank_angle_deg=180', 'initial.crank_speed=20', 'output.interval=1e-3']
    trace = run_case('cases/gas/compressor.nml', settings, .true.)
    call check%equal_text(trace%report%status, 'done', 'a run with a crank that swings against the gas')
    speed = values_of(trace, 'crank_speed[rad/s]')
    angle = values_of(trace, 'crank_angle[rad]')
    pressure = values_of(trace, 'cylinder_pressure[Pa]')
    call check%that(minval(speed) < -19 .and. maxval(pressure) < 5e5_dp, 'the crank turns back before the valve opens')
    i = minloc(abs(angle(2:) - pi) + merge(0.0_dp, 9.0_dp, speed(2:) < 0), 1) + 1
    call check%relative(speed(i), -20.0_dp, 0.02_dp, 'the crank returns with its initial speed')
    call check%that(trace%report%figures%max_energy_residual < 1e-7_dp*trace%report%figures%max_energy, &
      'a crank that swings against the gas: energy residual')
  end subroutine piston_that_swings
end module test_gas_machine_runs
