!> Times that several measuring programs need: that of a sine and cosine, with which other times are compared, and of an
!> integration.
module measured_times
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use constants, only: pi
  use error_handling, only: error_t
  use case_definition, only: case_t
  use ode_methods, only: new_method
  use scene_problem, only: scene_t
  use ode_solver, only: integrate, silent_observer_t
  use ode_method, only: ode_method_t
  use scene_builder, only: build_scene, settings_for, simulated_time
  implicit none
  private
  public :: time_of_pairs, time_of_integration, no_difference

  integer, parameter :: n_angles = 64
  real(dp), parameter :: no_difference = 1e-200_dp   !! a result times this is added to an angle or a state and does not change it

contains

  !> Mean time of a sine and a cosine [ns]. A processor computes several at a time, unless they are computed `in_turn`: each of
  !> them begins when the one before is known.
  real(dp) function time_of_pairs(count, in_turn) result(ns)
    integer, intent(in) :: count   !! number of pairs, a multiple of 64
    logical, intent(in) :: in_turn
    integer(int64) :: before, after, rate
    real(dp) :: total, angle(n_angles)
    integer :: i, j
    angle = [(pi*(1.05_dp + 0.8_dp*j/n_angles), j=1, n_angles)]
    total = 0
    call system_clock(before, rate)
    if (in_turn) then
      do i = 1, count/n_angles
        do j = 1, n_angles
          total = sine_and_cosine(angle(j) + no_difference*total)
        end do
      end do
    else
      do i = 1, count/n_angles
        do j = 1, n_angles
          total = total + sine_and_cosine(angle(j))
        end do
      end do
    end if
    call system_clock(after)
    ns = 1e9_dp*real(after - before, dp)/real(rate, dp)/(count/n_angles*n_angles)
    if (total > huge(total)) print *, total
  end function time_of_pairs

  real(dp) function sine_and_cosine(x)
    real(dp), intent(in) :: x
    sine_and_cosine = sin(x) + cos(x)
  end function sine_and_cosine

  !> Time of the integration of a case, or of its ideal twin, by method auto without any output [ms]. The case must have a scene.
  real(dp) function time_of_integration(case, ideal_joint) result(ms)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    type(silent_observer_t) :: nobody
    integer(int64) :: before, after, rate
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: status
    call build_scene(case, ideal_joint, scene, error)
    if (.not. allocated(error)) call new_method('auto', method, error)
    if (allocated(error)) error stop 'measured_times: the case has no scene'
    method%settings = settings_for(case, scene)
    allocate (y(scene%n), source=scene%initial_state())
    t = 0
    call system_clock(before, rate)
    call integrate(scene, method, t, y, simulated_time(case), 0, nobody, status)
    call system_clock(after)
    ms = 1e3_dp*real(after - before, dp)/real(rate, dp)
  end function time_of_integration
end module measured_times
