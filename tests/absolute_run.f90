!> Runs a case in the coordinates (q, A, x) of its bodies with the numerical settings of the dissertation: one tolerance for
!> relative and absolute error, and a largest step.
!>
!>     absolute_run CASE.nml REVOLUTIONS SAMPLES TOLERANCE MAX_STEP
!>
!> Prints time [s], crank acceleration [rad/s^2] and eccentricity over clearance as CSV, SAMPLES times in the duration of a
!> revolution at the starting speed. The right-hand side is that of the program. If the pin comes into contact with the bearing, the
!> run ends with exit status 1.
program absolute_run
  use, intrinsic :: iso_fortran_env, only: error_unit
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use adams, only: adams_t
  use ode_solver, only: integrate, integration_done
  use scene_problem, only: scene_t
  use scene_builder, only: build_scene
  use absolute_gas_engine, only: absolute_gas_engine_t, new_absolute_gas_engine
  use sampler, only: sampler_t
  implicit none
  type(case_t) :: case
  type(error_t), allocatable :: error
  type(scene_t), allocatable :: scene
  type(absolute_gas_engine_t) :: engine
  type(adams_t) :: method
  type(sampler_t) :: sampler
  real(dp) :: y(6), t, revolutions, tolerance, max_step, span
  character(len=400) :: file
  character(len=1) :: overrides(0)
  integer :: samples, status

  if (command_argument_count() /= 5) then
    write (error_unit, '(a)') 'usage: absolute_run CASE.nml REVOLUTIONS SAMPLES TOLERANCE MAX_STEP'
    stop 2
  end if
  call get_command_argument(1, file)
  revolutions = argument(2)
  samples = nint(argument(3))
  tolerance = argument(4)
  max_step = argument(5)
  call read_case(trim(file), overrides, case, error)
  if (.not. allocated(error)) call build_scene(case, .false., scene, error)
  if (allocated(error)) then
    write (error_unit, '(a)') 'absolute_run: '//trim(file)//' cannot be run'
    stop 3
  end if
  span = revolutions*two_pi/abs(case%initial%crank_speed)
  sampler%interval = span/(revolutions*samples)
  allocate (sampler%y(6, nint(revolutions*samples)))
  allocate (method%settings%relative(6), method%settings%absolute(6), source=tolerance)
  method%settings%span = span
  method%settings%max_step = max_step
  call new_absolute_gas_engine(scene, engine, y)
  t = 0
  call integrate(engine, method, t, y, span, huge(1), sampler, status)
  call print_rows(engine, scene%joints(1)%bearing%clearance)
  write (error_unit, '(i0,a,i0,a)') method%statistics%accepted, ' steps, ', method%statistics%evaluations, ' evaluations'
  if (status /= integration_done) stop 1

contains

  real(dp) function argument(place)
    integer, intent(in) :: place
    character(len=40) :: text
    call get_command_argument(place, text)
    read (text, *) argument
  end function argument

  !> The samples. The gas has its state at the end of the run; since its part of the cycle does not influence earlier rows, these
  !> are sampled with the accelerations of the sampled states.
  subroutine print_rows(engine, clearance)
    type(absolute_gas_engine_t), intent(inout) :: engine
    real(dp), intent(in) :: clearance   !! [m]
    real(dp) :: e(2), rate(2), slope(6)
    logical :: in_domain
    integer :: i
    print '(a)', 'time[s],crank_acceleration[rad/s2],eccentricity_ratio[-]'
    do i = 1, sampler%taken
      if (allocated(engine%scene%gas)) call engine%scene%gas%start(sampler%y(1, i), sampler%y(4, i))
      call engine%derivatives(i*sampler%interval, sampler%y(:, i), slope, in_domain)
      if (.not. in_domain) exit
      call engine%eccentricity(sampler%y(:, i), e, rate)
      print '(es23.16,2(",",es23.16))', i*sampler%interval, slope(4), norm2(e)/clearance
    end do
  end subroutine print_rows
end program absolute_run
