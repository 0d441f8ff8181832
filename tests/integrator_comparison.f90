!> The integration methods side by side on the shipped scenes: cost against error. Run by scripts/compare_integrators.sh.
!>
!>     integrator_comparison          prints a CSV table, a row for each scene, method and tolerance
!>
!> Smooth scenes: error = largest |difference| of q, A, x or their rates at the end, over the largest |value| that it takes,
!> against Adams at 1e-13; the same of the eccentricity apart. Scenes with impacts: the contact instants that match those of the reference one by one,
!> and the largest time error among the first `compared` of them over the time of one radian.
program integrator_comparison
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use ode_method, only: ode_method_t, step_statistics_t
  use gudgeon_methods, only: new_method
  use gudgeon_solver, only: integrate, silent_observer_t
  use gudgeon_scene, only: scene_t
  use scene_builder, only: build_scene, settings_for, simulated_time
  use state_watcher, only: state_watcher_t, watched
  use event_watcher, only: event_watcher_t, most_instants
  implicit none

  integer, parameter :: n_scenes = 9, n_methods = 3, tightest = 12
  character(len=32), parameter :: files(n_scenes) = [character(len=32) :: 'sim_I', 'sim_II', 'sim_III', 'sim_IV', 'sim_V', &
    'sim_VI', 'flores/lubricated_400cP', 'flores/dry_0500um', 'flores/friction_050']
  character(len=40), parameter :: spans(n_scenes) = [character(len=40) :: 'integrator.revolutions=4', &
    'integrator.revolutions=4', 'integrator.revolutions=4', 'integrator.revolutions=2', 'integrator.revolutions=2', &
    'integrator.revolutions=2', 'integrator.revolutions=2', 'integrator.revolutions=0.8333', &
    'integrator.revolutions=1.5']
  integer, parameter :: compared(n_scenes) = [0, 0, 0, 0, 0, 0, 0, 40, 40]   !! contact instants, 0: the state at the end
  character(len=5), parameter :: names(n_methods) = ['adams', 'radau', 'auto ']

  !> What one run leaves.
  type :: outcome_t
    integer :: status = 0
    real(dp) :: seconds = 0                      !! median of several, where it is short
    type(step_statistics_t) :: statistics
    real(dp) :: final(watched) = 0, largest(watched) = 0
    real(dp) :: instant(most_instants) = 0       !! of contact events [s]
    integer :: instants = 0
    real(dp) :: radian = 1                       !! time of one radian at the start speed [s]
  end type outcome_t

  type(outcome_t) :: reference, got
  integer :: scene_number, method_number, tolerance

  print '(a)', 'scene,method,tolerance,evaluations,jacobians,steps,seconds,error,eccentricity_error,matched_instants,status'
  do scene_number = 1, n_scenes
    call run(scene_number, 'adams', 1e-13_dp, 1, reference)
    do method_number = 1, n_methods
      do tolerance = 3, tightest
        call run(scene_number, names(method_number), 10.0_dp**(-tolerance), 5, got)
        call print_row(scene_number, names(method_number), tolerance, got, reference)
      end do
    end do
  end do

contains

  subroutine run(scene_number, name, tolerance, repeats, got)
    integer, intent(in) :: scene_number, repeats
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: tolerance
    type(outcome_t), intent(out) :: got
    type(case_t) :: case
    type(error_t), allocatable :: error
    character(len=48) :: overrides(2)
    real(dp) :: seconds(repeats)
    integer :: i

    overrides(1) = spans(scene_number)
    overrides(2) = 'integrator.relative_tolerance=1e-13'   ! the models' own accuracy is the same at every tolerance
    call read_case('cases/'//trim(files(scene_number))//'.nml', overrides, case, error)
    if (allocated(error)) error stop 'a case cannot be read'
    do i = 1, repeats
      call run_once(case, name, tolerance, compared(scene_number) > 0, repeats == 1, got)
      seconds(i) = got%seconds
      if (got%seconds > 0.3_dp) exit   ! long enough to be measured once
    end do
    call sort(seconds(:min(i, repeats)))
    got%seconds = seconds((min(i, repeats) + 1)/2)
  end subroutine run

  !> Only the reference is watched, at the cost of an evaluation a step, for the largest values.
  subroutine run_once(case, name, tolerance, by_events, watches, got)
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: by_events, watches
    type(outcome_t), intent(out) :: got
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    type(state_watcher_t) :: states
    type(silent_observer_t) :: nobody
    type(event_watcher_t) :: instants
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer(int64) :: before, after, rate

    call build_scene(case, .false., scene, error)
    if (.not. allocated(error)) call new_method(trim(name), method, error)
    if (allocated(error)) error stop 'a scene cannot be built'
    method%settings = settings_for(case, scene)
    method%settings%tolerance = tolerance
    method%settings%relative = method%settings%relative*(tolerance/case%integrator%relative_tolerance)
    method%settings%absolute = method%settings%absolute*(tolerance/case%integrator%relative_tolerance)
    allocate (y(scene%n), source=scene%initial_state())
    t = 0
    if (by_events) then
      call system_clock(before, rate)
      call integrate(scene, method, t, y, simulated_time(case), 0, instants, got%status)
      call system_clock(after)
      got%instant = instants%instant
      got%instants = instants%n
    else
      call system_clock(before, rate)
      if (watches) then
        call integrate(scene, method, t, y, simulated_time(case), 0, states, got%status)
      else
        call integrate(scene, method, t, y, simulated_time(case), 0, nobody, got%status)
      end if
      call system_clock(after)
      call states%look(scene, t, y)
      got%final = states%values
      got%largest = states%largest
    end if
    got%seconds = real(after - before, dp)/real(rate, dp)
    got%statistics = method%totals()
    got%radian = 1/abs(case%initial%crank_speed)
  end subroutine run_once

  subroutine print_row(scene_number, name, tolerance, got, reference)
    integer, intent(in) :: scene_number, tolerance
    character(len=*), intent(in) :: name
    type(outcome_t), intent(in) :: got, reference
    real(dp) :: error, off(watched)
    integer :: matched
    matched = 0
    off = 0
    if (compared(scene_number) > 0) then
      do while (matched < min(got%instants, reference%instants))
        if (abs(got%instant(matched + 1) - reference%instant(matched + 1)) > 1e-3_dp*reference%radian) exit
        matched = matched + 1
      end do
      associate (n => min(compared(scene_number), reference%instants))
        error = 1
        if (matched >= n) error = maxval(abs(got%instant(:n) - reference%instant(:n)))/reference%radian
      end associate
    else
      off = abs(got%final - reference%final)/max(reference%largest, tiny(1.0_dp))
      error = maxval(off(:6))   ! q, A, x and their rates
    end if
    print '(a,",",a,",1e-",i0,",",i0,",",i0,",",i0,",",es10.3,",",es9.2,",",es9.2,",",i0,",",i0)', trim(files(scene_number)), &
      trim(name), tolerance, got%statistics%evaluations, got%statistics%jacobians, got%statistics%accepted, got%seconds, &
      error, maxval(off(7:)), matched, got%status
  end subroutine print_row

  pure subroutine sort(values)
    real(dp), intent(inout) :: values(:)
    real(dp) :: swap
    integer :: i, j
    do i = 2, size(values)
      do j = i, 2, -1
        if (values(j) >= values(j - 1)) exit
        swap = values(j)
        values(j) = values(j - 1)
        values(j - 1) = swap
      end do
    end do
  end subroutine sort
end program integrator_comparison
