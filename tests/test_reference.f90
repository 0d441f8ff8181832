!> Whole runs against the reference curves in data/ (an independent implementation, see data/README.md).
module test_reference
  use kinds, only: dp
  use checks, only: checks_t
  use ode_method, only: limit_stability
  use collecting_sink, only: trace_t, run_case, load_trace, column
  implicit none
  private
  public :: run_test_reference

  character(len=20), parameter :: states(6) = [character(len=20) :: 'crank_angle[rad]', 'rod_angle[rad]', &
    'piston_position[m]', 'crank_speed[rad/s]', 'rod_speed[rad/s]', 'piston_velocity[m/s]']

contains

  subroutine run_test_reference(check)
    class(checks_t), intent(inout) :: check
    call stiffness_is_recognised(check)
    call compare_states(check, 'cases/sim_I.nml', 'sim_I', '1e-9', 1e-5_dp)
    call compare_states(check, 'cases/sim_II.nml', 'sim_II', '1e-9', 1e-5_dp)
    call compare_states(check, 'cases/sim_III.nml', 'sim_III', '1e-9', 1e-5_dp)
    call compare_states(check, 'cases/sim_IV.nml', 'sim_IV', '1e-9', 1e-5_dp)
    call compare_states(check, 'cases/sim_V.nml', 'sim_V', '1e-9', 1e-5_dp)
    call compare_states(check, 'cases/sim_VI.nml', 'sim_VI', '1e-9', 1e-5_dp)
    call compare_states(check, 'cases/flores/lubricated_400cP.nml', 'flores_lubricated_400cP', '1e-9', 1e-5_dp)
    call compare_events(check, 'cases/flores/dry_0500um.nml', 'flores_dry_0500um', '1e-10', 20, 1e-8_dp)
    call compare_events(check, 'cases/flores/dry_0500um.nml', 'flores_dry_0500um', '1e-13', 20, 1e-8_dp)
    call compare_events(check, 'cases/flores/dry_0100um.nml', 'flores_dry_0100um', '1e-10', 100, 1e-6_dp)
    call compare_events(check, 'cases/flores/dry_0010um.nml', 'flores_dry_0010um', '1e-10', 100, 1e-6_dp)
    call compare_columns(check, 'cases/joints/both_pins.nml', 'both_pins', 1e-5_dp, 6e-5_dp)
    call compare_events(check, 'cases/joints/both_pins.nml', 'both_pins', '1e-11', 67, 4e-8_dp)
    call compare_columns(check, 'cases/contact/flores_brown_mcphee.nml', 'flores_brown_mcphee', 2.3e-7_dp, 4.4e-6_dp)
    call compare_events(check, 'cases/contact/flores_brown_mcphee.nml', 'flores_brown_mcphee', '1e-11', 7, 2e-10_dp)
    call compare_columns(check, 'cases/contact/conformal_lugre.nml', 'conformal_lugre', 8.7e-9_dp, 2.4e-7_dp)
    call compare_events(check, 'cases/contact/conformal_lugre.nml', 'conformal_lugre', '1e-11', 5, 2.5e-12_dp)
    call compare_columns(check, 'cases/elastic/dry_friction.nml', 'elastic_rod_dry', 1.3e-9_dp, 7.7e-9_dp)
    call compare_events(check, 'cases/elastic/dry_friction.nml', 'elastic_rod_dry', '1e-11', 15, 1.3e-12_dp)
    call compare_events(check, 'cases/flores/friction_010.nml', 'flores_friction_010', '1e-10', 100, 1e-6_dp)
    call compare_events(check, 'cases/flores/friction_050.nml', 'flores_friction_050', '1e-10', 100, 1e-6_dp)
    call compare_events(check, 'cases/flores/friction_100.nml', 'flores_friction_100', '1e-10', 100, 1e-6_dp)
  end subroutine run_test_reference

  !> The steps of simulation I are limited by stability; the integral of the spectral radius of its numerical Jacobian, from 8000
  !> points in 80 bits, is 2.14e5.
  subroutine stiffness_is_recognised(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: got
    character(len=60) :: overrides(2)
    integer :: i
    overrides(2) = 'integrator.method=adams'
    do i = 4, 10, 2
      write (overrides(1), '(a,i2.2)') 'integrator.relative_tolerance=1e-', i
      got = run_case('cases/sim_I.nml', overrides)
      associate (s => got%report%statistics)
        call check%that(s%limited_by(limit_stability) > 0.9_dp*s%accepted, 'the film is recognised as stiff'//overrides(1)(30:))
        call check%relative(s%stiffness, 2.14e5_dp, 0.02_dp, 'integral of the rate of the fastest mode'//overrides(1)(30:))
        call check%that(s%evaluations < 285000, 'evaluations of simulation I'//overrides(1)(30:))
      end associate
    end do
  end subroutine stiffness_is_recognised

  !> Every state over the whole span of the reference, relative to its largest value.
  subroutine compare_states(check, file, name, tolerance, allowed)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, name, tolerance
    real(dp), intent(in) :: allowed
    type(trace_t) :: want, got
    real(dp) :: error
    character(len=200) :: overrides(4)
    integer :: i, rows

    want = load_trace(name)
    rows = size(want%values, 2)
    overrides(1) = 'integrator.relative_tolerance='//tolerance
    overrides(2) = 'integrator.revolutions=0'
    write (overrides(3), '(a,es23.16)') 'integrator.end_time=', want%values(1, rows)
    write (overrides(4), '(a,es23.16)') 'output.interval=', want%values(1, rows)/(rows - 1)
    got = run_case(file, overrides)
    call check%that(.not. allocated(got%error), name//' runs')
    call check%that(size(got%values, 2) == rows, name//' has every row')
    if (size(got%values, 2) /= rows) return
    do i = 1, size(states)
      associate (g => got%values(column(got, states(i)), :), w => want%values(column(want, states(i)), :))
        error = maxval(abs(g - w))/maxval(abs(w))
        call check%close_to(error, 0.0_dp, allowed, name//' '//trim(states(i)))
      end associate
    end do
    call check%close_to(got%report%figures%max_energy_residual/got%report%figures%max_energy, 0.0_dp, 1e-7_dp, &
      name//' energy residual')
  end subroutine compare_states

  !> Every column of a reference, relative to its largest value.
  subroutine compare_columns(check, file, name, in_states, in_others)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, name
    real(dp), intent(in) :: in_states, in_others   !! allowed errors
    type(trace_t) :: want, got
    real(dp) :: error, size_of
    character(len=60) :: overrides(4)
    integer :: i, k, rows
    want = load_trace(name)
    rows = size(want%values, 2)
    overrides = [character(len=60) :: 'integrator.relative_tolerance=1e-11', 'integrator.revolutions=0', '', '']
    write (overrides(3), '(a,es23.16)') 'integrator.end_time=', want%values(1, rows)
    write (overrides(4), '(a,es23.16)') 'output.interval=', want%values(1, 2)
    got = run_case(file, overrides)
    call check%that(.not. allocated(got%error), name//' runs')
    call check%that(size(got%values, 2) == rows, name//' has every row')
    if (size(got%values, 2) /= rows) return
    do i = 1, size(want%names)
      k = column(got, want%names(i))
      call check%that(k > 0, name//' has the column '//want%names(i))
      if (k == 0) cycle
      error = maxval(abs(got%values(k, :) - want%values(i, :)))
      size_of = maxval(abs(want%values(i, :)))
      call check%that(error <= merge(in_states, in_others, any(want%names(i) == states))*size_of, name//': '//want%names(i))
    end do
  end subroutine compare_columns

  !> The first contact times of the reference, at most `most` of them.
  subroutine compare_events(check, file, name, tolerance, most, allowed)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, name, tolerance
    integer, intent(in) :: most
    real(dp), intent(in) :: allowed
    type(trace_t) :: want, got
    integer :: n
    character(len=200) :: overrides(1)

    want = load_trace(name)
    overrides(1) = 'integrator.relative_tolerance='//tolerance
    got = run_case(file, overrides)
    n = min(most, size(want%event))
    call check%that(.not. allocated(got%error), name//' runs')
    call check%that(size(got%event) >= n, name//' has the events')
    n = min(n, size(got%event))
    call check%that(all(got%event(:n)%kind == want%event(:n)%kind), name//' has events of the same kinds')
    call check%that(all(got%event(:n)%pin == want%event(:n)%pin), name//' has events of the same joints')
    call check%close_to(maxval(abs(got%event(:n)%time - want%event(:n)%time)), 0.0_dp, allowed, &
      name//' contact times [s]')
  end subroutine compare_events
end module test_reference
