!> The accuracy of the eccentricity in several coordinates and at several tolerances.
module coordinate_errors
  use kinds, only: dp
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use ode_problem, only: ode_problem_t
  use adams, only: adams_t
  use ode_solver, only: integrate, integration_done
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene
  use state_making, only: pin_of
  use absolute_coordinates, only: absolute_coordinates_t, in_absolute_coordinates
  use sampler, only: sampler_t
  implicit none
  private
  public :: eccentricity_error
  public :: own_coordinates, absolute_by_size, absolute_by_clearance

  !> (q, e); (q, A, x) with tolerances relative to the magnitudes of q, A and x; (q, A, x) with tolerances for which the errors of
  !> q, A and x change the eccentricity by equal parts of the clearance.
  integer, parameter :: own_coordinates = 1, absolute_by_size = 2, absolute_by_clearance = 3

  integer, parameter :: samples = 100

contains

  !> The largest error of e/c at 100 times of cases/FILE, over `revolutions`; huge if the run does not reach its end.
  subroutine eccentricity_error(file, revolutions, way, tolerance, error, evaluations)
    character(len=*), intent(in) :: file
    integer, intent(in) :: way
    real(dp), intent(in) :: revolutions, tolerance
    real(dp), intent(out) :: error
    integer, intent(out) :: evaluations
    real(dp) :: exact(2, samples), got(2, samples)
    logical :: done
    integer :: ignored
    call places(file, revolutions, own_coordinates, 1e-12_dp, exact, ignored, done)
    if (.not. done) error stop 'a reference did not reach its end'
    call places(file, revolutions, way, tolerance, got, evaluations, done)
    error = huge(error)
    if (done) error = maxval(abs(got - exact))
  end subroutine eccentricity_error

  !> e/c, (2, samples).
  subroutine places(file, revolutions, way, tolerance, e, evaluations, done)
    character(len=*), intent(in) :: file
    integer, intent(in) :: way
    real(dp), intent(in) :: revolutions, tolerance
    real(dp), intent(out) :: e(:, :)
    integer, intent(out) :: evaluations
    logical, intent(out) :: done
    type(case_t) :: case
    type(error_t), allocatable :: error
    type(scene_t), allocatable :: scene
    type(absolute_coordinates_t) :: absolute
    type(adams_t) :: method
    type(sampler_t) :: sampler
    real(dp) :: start(6), span, rate(2)
    logical :: growing(100)
    integer :: status, i
    character(len=60) :: overrides(1)

    overrides(1) = 'integrator.relative_tolerance=1e-13'   ! tables of models are always equally accurate
    call read_case(file, overrides, case, error)
    if (.not. allocated(error)) call build_scene(case, .false., scene, error)
    if (allocated(error)) error stop 'a case cannot be read'
    span = revolutions*8*atan(1.0_dp)/case%initial%crank_speed
    sampler%interval = span/samples
    method%settings%span = span
    if (way == own_coordinates) then
      allocate (method%settings%absolute(scene%n), method%settings%relative(scene%n), source=tolerance)
      call scene%layout%natural_scales(method%settings%absolute, growing(:scene%n))
      method%settings%absolute = tolerance*method%settings%absolute
      allocate (sampler%y(scene%n, samples))
      call run(scene, method, scene%initial_state(), span, sampler, status)
      do i = 1, samples
        e(:, i) = pin_of(scene, sampler%y(:, i))
      end do
    else
      call in_absolute_coordinates(scene, absolute, start)
      allocate (method%settings%absolute(6), method%settings%relative(6), source=tolerance)
      method%settings%absolute = tolerance*[0.1_dp, 0.1_dp, 1e-4_dp, 100.0_dp, 100.0_dp, 1.0_dp]
      if (way == absolute_by_clearance) then
        method%settings%relative = 0
        method%settings%absolute(:3) = tolerance*scene%joints(1)%bearing%clearance &
          /[scene%chain%bodies%crank%length, scene%chain%bodies%rod%length, 1.0_dp]
        method%settings%absolute(4:) = method%settings%absolute(:3)*case%initial%crank_speed
      end if
      allocate (sampler%y(6, samples))
      call run(absolute, method, start, span, sampler, status)
      do i = 1, samples
        call absolute%eccentricity(sampler%y(:, i), e(:, i), rate)
      end do
    end if
    e = e/scene%joints(1)%bearing%clearance
    evaluations = method%statistics%evaluations
    done = status == integration_done
  end subroutine places

  subroutine run(problem, method, start, span, sampler, status)
    class(ode_problem_t), intent(inout) :: problem
    type(adams_t), intent(inout) :: method
    real(dp), intent(in) :: start(:), span
    type(sampler_t), intent(inout) :: sampler
    integer, intent(out) :: status
    real(dp) :: t, y(size(start))
    t = 0
    y = start
    call integrate(problem, method, t, y, span, 1000000, sampler, status)
  end subroutine run
end module coordinate_errors
