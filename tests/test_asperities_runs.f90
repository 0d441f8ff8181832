!> Mixed lubrication in runs by all methods, and errors in cases.
module test_asperities_runs
  use kinds, only: dp
  use checks, only: checks_t
  use case_checks, only: expect
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_asperities_runs

  real(dp), parameter :: c = 20e-6_dp

contains

  subroutine run_test_asperities_runs(check)
    class(checks_t), intent(inout) :: check
    call methods_agree(check)
    call goes_beyond_the_clearance(check)
    call refuses(check)
  end subroutine run_test_asperities_runs

  !> A piston pin on a thin oil film between rough surfaces, by each method.
  subroutine methods_agree(check)
    class(checks_t), intent(inout) :: check
    character(len=60) :: set(7)
    character(len=6), parameter :: methods(3) = [character(len=6) :: 'adams', 'radau', 'auto']
    type(trace_t) :: trace, first
    integer :: at
    integer :: i
    do i = 1, 3
      set = [character(len=60) :: 'integrator.method='//methods(i), 'lubrication.law=pinkus_sternlicht', &
        'lubrication.variant=closed_form', 'integrator.revolutions=0.4', 'integrator.relative_tolerance=1e-9', &
        'initial.crank_angle_deg=330', 'lubrication.viscosity=0.002']
      trace = run_case('cases/film/sim_IV_mixed.nml', set)
      call check%that(.not. allocated(trace%error), 'mixed lubrication runs by '//methods(i))
      if (allocated(trace%error)) return
      call check%that(trace%report%figures%max_energy_residual < 1e-8_dp*trace%report%figures%max_energy, &
        'mixed lubrication: energy residual')
      at = column(trace, 'film_thickness[m]')
      if (i == 1) first = trace
      call check%close_to(maxval(abs(trace%values(at, :) - first%values(at, :))), 0.0_dp, 1e-6_dp*c, &
        'mixed lubrication: all methods give the same film thickness')
    end do
    call check%that(maxval(trace%values(column(trace, 'asperity_force[N]'), :)) > 100, &
      'mixed lubrication: the asperities carry load')
  end subroutine methods_agree

  !> A pin that starts beyond the clearance is pushed back.
  subroutine goes_beyond_the_clearance(check)
    class(checks_t), intent(inout) :: check
    character(len=60) :: set(6)
    type(trace_t) :: trace
    integer :: at
    set = [character(len=60) :: 'lubrication.law=pinkus_sternlicht', 'lubrication.variant=closed_form', &
      'initial.eccentricity=20.1e-6,0', 'integrator.revolutions=0.05', 'integrator.relative_tolerance=1e-8', &
      'initial.crank_speed=100']
    trace = run_case('cases/film/sim_IV_mixed.nml', set)
    call check%that(.not. allocated(trace%error), 'a start beyond the clearance is integrated')
    if (allocated(trace%error)) return
    at = column(trace, 'film_thickness[m]')
    call check%that(trace%values(at, 1) < 0 .and. trace%values(at, size(trace%values, 2)) > trace%values(at, 1), &
      'a pin that starts beyond the clearance is pushed back')
    call check%that(trace%report%figures%max_energy_residual < 1e-7_dp*trace%report%figures%max_energy, &
      'a start beyond the clearance: energy residual')
  end subroutine goes_beyond_the_clearance

  subroutine refuses(check)
    class(checks_t), intent(inout) :: check
    call expect(check, "&lubrication viscosity=0.01 / &contact / &asperities roughness=1e-7 /", &
      '&asperities roughness = 1e-7: cannot be combined with the group contact', 'asperities together with a contact law')
    call expect(check, "&contact / &asperities roughness=1e-7 /", &
      '&asperities roughness = 1e-7: needs the group lubrication', 'asperities without a film')
    call expect(check, "&lubrication viscosity=0.01 / &asperities roughness=1e-5 /", &
      '&asperities roughness = 1e-5: must be <= clearance/8', 'surfaces as rough as the clearance is wide')
    call expect(check, "&lubrication viscosity=0.01 / &asperities /", '&asperities roughness', 'asperities without roughness')
  end subroutine refuses
end module test_asperities_runs
