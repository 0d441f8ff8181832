!> Measures the integrator: evaluations, steps and error over tolerance on four scenes and on the standard battery of non-stiff
!> problems. Run by scripts/bench/compare_adams.sh.
!>
!>     integrator_battery reference       prints a reference for every scene; intended for a build in extended precision
!>     integrator_battery scenes FILE     prints the table, with errors against the references in FILE
!>     integrator_battery coordinates     prints the accuracy of the eccentricity in (q, e) and in (q, A, x)
!>     integrator_battery standard_reference, integrator_battery standard FILE: the same for the standard battery
program integrator_battery
  use kinds, only: dp
  use ode_method, only: step_statistics_t, limit_stability
  use adams, only: adams_t
  use ode_solver, only: integrate, integration_done, observer_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use error_handling, only: error_t
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene, settings_for
  use standard_problems, only: standard_problem_t, new_standard_problem, standard_settings, n_standard_problems, names
  use conditioning, only: condition_of
  use local_errors, only: local_error_watcher_t
  use sampler, only: sampler_t
  use coordinate_errors, only: eccentricity_error, own_coordinates, absolute_by_clearance
  use state_watcher, only: state_watcher_t, watched
  implicit none

  integer, parameter :: n_scenes = 4, n_tolerances = 4, n_samples = 20
  character(len=40), parameter :: files(n_scenes) = [character(len=40) :: 'cases/flores/lubricated_400cP.nml', &
    'cases/flores/dry_0500um.nml', 'cases/sim_I.nml', 'cases/sim_IV.nml']
  character(len=24), parameter :: spans(n_scenes) = [character(len=24) :: 'end_time=0.024', 'end_time=0.010', &
    'revolutions=4', 'revolutions=2']
  character(len=40), parameter :: titles(n_scenes) = [character(len=40) :: 'flores lubricated, 24 ms', &
    'flores dry 0.5 mm, 10 ms', 'simulation I, 4 revolutions', 'simulation IV, 720 degrees']
  !> Evaluations and errors of a published Shampine-Gordon code at 1e-6, 1e-8, 1e-10 and 1e-12; 0: not known (1e-4).
  integer, parameter :: published(0:n_tolerances, n_scenes) = reshape([0, 14261, 15203, 17014, 19569, 0, 3177, 5278, 8291, 12837, &
    0, 284712, 286777, 289212, 310134, 0, 3010000, 3300000, 3320000, 3350000], [n_tolerances + 1, n_scenes])
  real(dp), parameter :: published_error(0:n_tolerances, n_scenes) = reshape([0.0_dp, 4e-8_dp, 1e-9_dp, 2e-11_dp, 5e-13_dp, &
    0.0_dp, 5e-3_dp, 2e-4_dp, 3e-6_dp, 5e-8_dp, 0.0_dp, 1e-6_dp, 6e-10_dp, 2e-10_dp, 3e-12_dp, 0.0_dp, 1e-6_dp, 5e-9_dp, 9e-10_dp, &
    1e-12_dp], [n_tolerances + 1, n_scenes])

  !> Result of one run.
  type :: result_t
    real(dp) :: final(watched) = 0, largest(watched) = 0
    integer :: status = 0
    real(dp) :: seconds = 0
    real(dp) :: rebuilt = 0   !! largest |e - e rebuilt from (q, A, x)| [m]
    type(adams_t) :: method
  end type result_t

  character(len=200) :: mode, file
  call get_command_argument(1, mode)
  call get_command_argument(2, file)
  select case (mode)
  case ('reference')
    call print_references()
  case ('standard_reference')
    call print_standard_references()
  case ('standard')
    call print_standard(trim(file))
  case ('scenes')
    call print_scenes(trim(file))
  case ('coordinates')
    call print_coordinates()
  case default
    error stop 'integrator_battery reference | scenes FILE | coordinates | standard_reference | standard FILE'
  end select

contains

  subroutine run(scene_number, tolerance, max_order, got)
    integer, intent(in) :: scene_number, max_order
    real(dp), intent(in) :: tolerance
    type(result_t), intent(out) :: got
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    type(state_watcher_t) :: watcher
    character(len=60) :: overrides(3)
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: before, after, rate

    overrides = [character(len=60) :: 'integrator.relative_tolerance=1e-13', 'integrator.revolutions=0', &
      'integrator.'//spans(scene_number)]   ! tables of models are equally accurate at every tolerance
    if (index(spans(scene_number), 'revolutions') > 0) overrides(2) = overrides(3)
    call read_case(trim(files(scene_number)), overrides, case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) then
      print '(a)', error%message
      error stop 1
    end if
    case%integrator%relative_tolerance = tolerance
    got%method%settings = settings_for(case, scene)
    got%method%settings%max_order = max_order
    y = scene%initial_state()
    t = 0
    call system_clock(before, rate)
    call integrate(scene, got%method, t, y, got%method%settings%span, 0, watcher, got%status)
    call system_clock(after)
    call watcher%look(scene, t, y)
    got%final = watcher%values
    got%largest = watcher%largest
    got%rebuilt = watcher%rebuilt
    got%seconds = real(after - before, dp)/rate
  end subroutine run

  !> Print for each scene the final values, their largest magnitudes, and the difference of a run with a larger tolerance and lower
  !> order.
  subroutine print_references()
    type(result_t) :: best, other
    integer :: i
    do i = 1, n_scenes
      call run(i, max(1e-16_dp, 8*epsilon(1.0_dp)), 12, best)
      call run(i, max(4e-16_dp, 32*epsilon(1.0_dp)), 9, other)
      if (best%status /= integration_done .or. other%status /= integration_done) error stop 'a reference did not reach its end'
      print '(i0,*(1x,es28.20))', i, best%final, best%largest, &
        maxval(abs(best%final(:6) - other%final(:6))/best%largest(:6))
    end do
  end subroutine print_references

  subroutine print_scenes(reference_file)
    character(len=*), intent(in) :: reference_file
    type(result_t) :: got
    real(dp) :: final(watched), largest(watched), spread, tolerance, clearance
    integer :: unit, i, j, number

    open (newunit=unit, file=reference_file, status='old', action='read')
    do i = 1, n_scenes
      read (unit, *) number, final, largest, spread
      clearance = merge(500e-6_dp, 20e-6_dp, i <= 2)
      print '(/,2a,es8.1)', trim(titles(i)), '; reference known to', spread
      print '(a)', '  rtol   evaluations     error  error of e/c | published     error | ratio |' &
        //' accepted rejected restarts stability-bound mean h rho order time s'
      do j = 0, n_tolerances
        tolerance = 10.0_dp**(-4 - 2*j)
        call run(i, tolerance, 12, got)
        associate (s => got%method%statistics)
          print '(es7.0,i12,es12.1,es12.1,a,i11,es11.1,a,f6.2,a,3i9,f12.3,f12.2,f10.1,f7.2)', tolerance, s%evaluations, &
            maxval(abs(got%final(:6) - final(:6))/largest(:6)), maxval(abs(got%final(7:) - final(7:)))/clearance, '   |', &
            published(j, i), published_error(j, i), ' |', &
            merge(real(s%evaluations, dp)/max(1, published(j, i)), 0.0_dp, j > 0), ' |', s%accepted, &
            s%rejected_error + s%rejected_domain + s%rejected_penetration, s%restarts, &
            bound_fraction(s), s%stiffness/max(1, s%accepted), mean_order(s%order_count), &
            got%seconds
        end associate
        if (got%status /= integration_done) print '(a,i0)', '  status ', got%status
      end do
      print '(a,es8.1)', '  rounding of e/c if it is computed from (q, A, x):', got%rebuilt/clearance
    end do
    close (unit)
  end subroutine print_scenes

  !> Integrate one problem of the standard battery with an observer.
  subroutine run_standard(number, tolerance, max_order, method, observer, status)
    integer, intent(in) :: number, max_order
    real(dp), intent(in) :: tolerance
    type(adams_t), intent(out) :: method
    class(observer_t), intent(inout) :: observer
    integer, intent(out) :: status
    type(standard_problem_t) :: problem
    real(dp), allocatable :: y(:)
    real(dp) :: t

    call new_standard_problem(number, problem, y)
    method%settings = standard_settings(problem, tolerance)
    method%settings%max_order = max_order
    t = 0
    call integrate(problem, method, t, y, problem%t_end, 1000000, observer, status)
  end subroutine run_standard

  !> The same, sampled at 20 equal intervals.
  subroutine sample_standard(number, tolerance, max_order, method, samples, status)
    integer, intent(in) :: number, max_order
    real(dp), intent(in) :: tolerance
    type(adams_t), intent(out) :: method
    real(dp), allocatable, intent(out) :: samples(:, :)
    integer, intent(out) :: status
    type(standard_problem_t) :: problem
    type(sampler_t) :: sampler
    real(dp), allocatable :: y(:)
    call new_standard_problem(number, problem, y)
    sampler%interval = problem%t_end/n_samples
    allocate (sampler%y(problem%n, n_samples))
    call run_standard(number, tolerance, max_order, method, sampler, status)
    call move_alloc(sampler%y, samples)
  end subroutine sample_standard

  subroutine print_standard_references()
    type(adams_t) :: method
    real(dp), allocatable :: samples(:, :), other(:, :)
    integer :: i, status
    do i = 1, n_standard_problems
      call sample_standard(i, 1e-16_dp, 12, method, samples, status)
      if (status /= integration_done) error stop 'a reference did not reach its end'
      call sample_standard(i, 4e-16_dp, 10, method, other, status)
      print '(i0,1x,es10.2,*(1x,es28.20))', i, maxval(abs(samples - other)/(1 + abs(samples))), samples
    end do
  end subroutine print_standard_references

  !> Error: the largest |difference|/(1 + |y|) at 20 times, divided by the tolerance; and this divided by the problem's condition,
  !> the growth of a change of its state. Local errors, each of one step, in the weights and the norm of the step control and
  !> divided by the tolerance: the largest of a step, the largest per unit of time, and the share of the steps in which it is above
  !> 1.
  subroutine print_standard(reference_file)
    character(len=*), intent(in) :: reference_file
    type(adams_t) :: method
    real(dp), allocatable :: samples(:, :), exact(:, :), y(:)
    type(standard_problem_t) :: problem
    type(local_error_watcher_t) :: local
    real(dp) :: tolerance, spread, condition, largest, error(3:12)
    integer :: unit, i, j, number, status, evaluations, all_evaluations(3:12)

    all_evaluations = 0
    open (newunit=unit, file=reference_file, status='old', action='read', recl=200000)
    do i = 1, n_standard_problems
      call new_standard_problem(i, problem, y)
      if (allocated(exact)) deallocate (exact)
      allocate (exact(problem%n, n_samples))
      read (unit, *) number, spread, exact
      condition = condition_of(i)
      print '(/,2a,es8.1,a,es8.1)', trim(names(i)), ': reference known to', spread, ', condition', condition
      print '(2a)', 'tolerance   error/tol   by condition | local: step per unit time deceived |', &
        ' evaluations accepted rejected restarts stability-bound mean h rho'
      do j = 3, 12
        tolerance = 10.0_dp**(-j)
        local = local_error_watcher_t()
        call run_standard(i, tolerance, 12, method, local, status)
        call sample_standard(i, tolerance, 12, method, samples, status)
        error(j) = maxval(abs(samples - exact)/(1 + abs(exact)))
        evaluations = method%statistics%evaluations
        all_evaluations(j) = all_evaluations(j) + evaluations
        print '(es9.0,f12.3,f15.5,a,f12.3,es14.1,f9.3,a,i12,3i9,f13.3,f12.2,a)', tolerance, error(j)/tolerance, &
          error(j)/tolerance/condition, ' |', local%largest, local%largest_per_unit, &
          real(local%deceived, dp)/max(1, local%steps), ' |', evaluations, method%statistics%accepted, &
          method%statistics%rejected_error, method%statistics%restarts, &
          bound_fraction(method%statistics), method%statistics%stiffness/method%statistics%accepted, &
          merge('   failed', '         ', status /= 0)
      end do
      largest = maxval([(error(j)*10.0_dp**j, j=3, 12)])
      print '(a,f6.3,a,f9.1,a,f9.3)', 'slope of log error on log tolerance', slope(error), ', largest error/tolerance', largest, &
        ', by condition', largest/condition
    end do
    print '(/,a,10i8)', 'evaluations of the whole battery at 1e-3 ... 1e-12:', all_evaluations
    close (unit)
  end subroutine print_standard

  !> Half a revolution of simulations I, II and V: the largest error of e/c at 100 instants.
  subroutine print_coordinates()
    character(len=20), parameter :: files(3) = [character(len=20) :: 'cases/sim_I.nml', 'cases/sim_II.nml', 'cases/sim_V.nml']
    real(dp) :: error(own_coordinates:absolute_by_clearance)
    integer :: evaluations(own_coordinates:absolute_by_clearance), i, j, way
    do i = 1, size(files)
      print '(/,2a)', trim(files(i)), ': error of e/c and evaluations'
      print '(a)', '  rtol          (q, e)       (q, A, x), tolerances by size     by the clearance'
      do j = 4, 10, 2
        do way = own_coordinates, absolute_by_clearance
          call eccentricity_error(trim(files(i)), 0.5_dp, way, 10.0_dp**(-j), error(way), evaluations(way))
        end do
        print '(es7.0,3(es14.1,i8))', 10.0_dp**(-j), (error(way), evaluations(way), way=own_coordinates, absolute_by_clearance)
      end do
    end do
  end subroutine print_coordinates

  pure real(dp) function slope(error)
    real(dp), intent(in) :: error(3:12)
    real(dp) :: x(3:12), y(3:12)
    integer :: j
    x = [(-real(j, dp), j=3, 12)]
    y = log10(max(error, 1e-17_dp))
    slope = sum((x - sum(x)/10)*(y - sum(y)/10))/sum((x - sum(x)/10)**2)
  end function slope

  !> Share of the steps that were limited by stability.
  pure real(dp) function bound_fraction(statistics)
    type(step_statistics_t), intent(in) :: statistics
    bound_fraction = real(statistics%limited_by(limit_stability), dp)/max(1, statistics%accepted)
  end function bound_fraction

  pure real(dp) function mean_order(counts)
    integer, intent(in) :: counts(:)
    integer :: i
    mean_order = real(sum([(i*counts(i), i=1, size(counts))]), dp)/max(1, sum(counts))
  end function mean_order
end program integrator_battery
