!> The largest Lyapunov exponent of the motion that a run has reached: the mean rate, per revolution of the crank, at which
!> neighbouring motions diverge (positive) or converge (negative).
!>
!> Two scenes continue from the end of the run, the second one with a slightly different state. Every quarter of a revolution their
!> difference is measured when the crank of each is at the same angle, and scaled back to its initial size without changing its
!> direction (Benettin, Galgani, Giorgilli and Strelcyn 1980, Meccanica 15, 9-20). The exponent is the mean of the logarithms of the
!> growth factors. Both scenes pass through every contact by themselves, so no derivative of an impact is needed. Comparing states
!> at equal crank angles excludes differences along the motion itself, which would keep the exponent of a periodic motion of a free
!> crank at 0.
!>
!> Both runs are integrated with the tolerance 1e-11; differences are 1e-7 of the natural sizes of the state. If a difference
!> shrinks by more than a factor of about 1e3 in a quarter of a revolution, it is lost in the errors of the integration: exponents
!> below -30 are upper bounds.
module lyapunov
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use gudgeon_errors, only: error_t
  use gudgeon_archive, only: archive_t
  use case_definition, only: case_t
  use ode_method, only: ode_method_t, ode_settings_t
  use ode_problem, only: ode_problem_t
  use gudgeon_methods, only: new_method
  use gudgeon_solver, only: integrate, observer_t, integration_interrupted
  use gudgeon_scene, only: scene_t
  use scene_builder, only: settings_for
  use crank_passage, only: find_passage
  use clearance_joint, only: most_joints
  use trace_sink, only: trace_sink_t
  implicit none
  private
  public :: exponent_t, measure_exponent

  integer, parameter :: per_revolution = 4             !! measurements in one revolution
  real(dp), parameter :: tolerance = 1e-11_dp          !! relative, of both runs
  real(dp), parameter :: first_size = 1e-7_dp          !! initial size of the difference, relative to the natural sizes
  real(dp), parameter :: smallest_growth = 1e-12_dp    !! smallest growth factor that is resolved
  real(dp), parameter :: patience = 100  !! longest time for one revolution, relative to its time at the crank speed at which it
                                         !! begins

  !> Result of the measurement.
  type :: exponent_t
    logical :: is_known = .false.
    real(dp) :: mean = 0          !! per revolution
    real(dp) :: error = 0  !! standard error of the mean, from the scatter between periods or, without a period, between revolutions
    integer :: revolutions = 0    !! number of revolutions of which it is the mean
  end type exponent_t

  !> One of the two scenes.
  type, extends(observer_t) :: companion_t
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    real(dp) :: t = 0                        !! [s]
    real(dp), allocatable :: y(:)
    real(dp) :: target = 0, direction = 1    !! crank angle to which it runs [rad], and the sense of rotation
    logical :: is_there = .false.
    type(archive_t) :: there                 !! its discrete state at that angle
    type(scene_t), allocatable :: kept       !! the scene at that angle, before an event at the end of the last step
  contains
    procedure :: run_to
    procedure :: step_taken
    procedure :: event_taken
  end type companion_t

contains

  !> Measure the exponent over the given number of revolutions, extended to whole periods, after some revolutions in which the
  !> difference finds its direction. `sink` is asked whether to continue.
  subroutine measure_exponent(case, scene, t, y, period, sink, exponent)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: scene         !! at the end of the run
    real(dp), intent(in) :: t, y(:)            !! end of the run
    integer, intent(in) :: period              !! of the motion [revolutions]; 0: it is not periodic
    class(trace_sink_t), intent(inout) :: sink
    type(exponent_t), intent(out) :: exponent
    type(companion_t) :: one, other
    real(dp), allocatable :: difference(:), scale(:)
    integer, allocatable :: at(:)
    real(dp) :: growth, sum_of, sum_of_squares, angle
    integer :: revolutions, block, blocks, skipped, i, k

    block = max(1, period)
    blocks = (case%run%lyapunov_revolutions - 1)/block + 1
    revolutions = block*blocks
    call prepare(case, scene, t, y, one)
    call prepare(case, scene, t, y, other)
    call choose_components(scene, at, scale)
    difference = first_direction(size(at))*scale
    skipped = max(2, min(20, revolutions/5))
    sum_of = 0
    sum_of_squares = 0
    growth = 0
    do i = 1 - skipped, revolutions
      do k = 1, per_revolution
        call put_beside(one, other, at, difference*(first_size/size_of(difference, scale)))
        angle = one%scene%crank_angle(one%t, one%y) + one%direction*two_pi/per_revolution
        call one%run_to(angle)
        if (one%is_there) call other%run_to(angle)
        if (.not. (one%is_there .and. other%is_there)) return
        difference = other%y(at) - one%y(at)
        growth = growth + log(max(size_of(difference, scale)/first_size, smallest_growth))
        if (.not. size_of(difference, scale) > 0) difference = first_direction(size(at))*scale
      end do
      call sink%take_progress(t)
      if (sink%wants_to_stop) return
      if (i >= 1 .and. mod(i, block) == 0) then
        sum_of = sum_of + growth
        sum_of_squares = sum_of_squares + growth**2
      end if
      if (i < 1 .or. mod(i, block) == 0) growth = 0
    end do
    exponent%is_known = .true.
    exponent%revolutions = revolutions
    exponent%mean = sum_of/revolutions
    if (blocks > 1) exponent%error = sqrt(max(0.0_dp, sum_of_squares/blocks - (sum_of/blocks)**2)/(blocks - 1))/block
  end subroutine measure_exponent

  !> Prepare a scene that continues the run from its end.
  subroutine prepare(case, scene, t, y, companion)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(companion_t), intent(inout) :: companion
    type(case_t) :: close
    type(error_t), allocatable :: ignored
    close = case
    close%integrator%relative_tolerance = tolerance
    close%integrator%absolute_tolerance = 0
    allocate (companion%scene, source=scene)
    companion%scene%refuses_steps = .false.   ! contacts are entered at the root of the event function
    if (allocated(companion%scene%turns)) companion%scene%turns%wanted = 1e30_dp   ! never reached
    call new_method('auto', companion%method, ignored)
    companion%method%settings = settings_for(close, companion%scene)
    companion%method%settings%max_evaluations = 0
    companion%t = t
    companion%y = y
    companion%direction = sign(1.0_dp, companion%scene%crank_speed(t, y))
  end subroutine prepare

  !> The components of the state that are compared, all except the crank angle and the quadratures, and their natural sizes.
  subroutine choose_components(scene, at, scale)
    type(scene_t), intent(in) :: scene
    integer, allocatable, intent(out) :: at(:)
    real(dp), allocatable, intent(out) :: scale(:)
    real(dp) :: scales(scene%n)
    logical :: growing(scene%n)
    integer :: i, n
    n = scene%n - scene%n_quadratures
    call scene%layout%natural_scales(scales, growing)
    at = pack([(i, i=1, n)], [(i /= scene%crank%position, i=1, n)])
    scale = scales(at)
  end subroutine choose_components

  !> An initial direction that is not a special direction of the system: fractional parts of multiples of the golden ratio.
  pure function first_direction(n) result(direction)
    integer, intent(in) :: n
    real(dp) :: direction(n)
    integer :: i
    direction = [(modulo(i*0.6180339887498949_dp, 1.0_dp) - 0.45_dp, i=1, n)]
  end function first_direction

  !> Size of a difference relative to the natural sizes.
  pure real(dp) function size_of(difference, scale)
    real(dp), intent(in) :: difference(:), scale(:)
    size_of = norm2(difference/scale)
  end function size_of

  !> Set the state of the second scene to that of the first plus a scaled difference; its discrete state is copied too. If both are
  !> in contact, the difference of their impact speeds is scaled by the same factor.
  subroutine put_beside(one, other, at, difference)
    type(companion_t), intent(inout) :: one, other
    integer, intent(in) :: at(:)
    real(dp), intent(in) :: difference(:)
    real(dp) :: impact_speed(most_joints), factor
    integer :: phase(most_joints), i
    character(len=:), allocatable :: bytes
    do i = 1, one%scene%n_joints
      impact_speed(i) = other%scene%joints(i)%impact_speed - one%scene%joints(i)%impact_speed
      phase(i) = other%scene%joints(i)%phase
    end do
    factor = 0
    if (maxval(abs(other%y(at) - one%y(at))) > 0) factor = maxval(abs(difference))/maxval(abs(other%y(at) - one%y(at)))
    call one%there%begin_writing()
    call one%scene%exchange(one%there)
    call one%there%contents(bytes)
    call other%there%begin_reading(bytes)
    call other%scene%exchange(other%there)
    other%t = one%t
    other%y = one%y
    other%y(at) = one%y(at) + difference
    do i = 1, one%scene%n_joints
      if (phase(i) == one%scene%joints(i)%phase .and. factor > 0) other%scene%joints(i)%impact_speed = &
        max(0.0_dp, one%scene%joints(i)%impact_speed + factor*impact_speed(i))
    end do
  end subroutine put_beside

  !> Run until the crank is at an angle; `is_there` is false if it does not reach it.
  subroutine run_to(self, angle)
    class(companion_t), intent(inout) :: self
    real(dp), intent(in) :: angle   !! [rad]
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    real(dp), allocatable :: y(:)
    real(dp) :: t
    integer :: status
    self%target = angle
    self%is_there = .false.
    self%wants_to_stop = .false.
    call move_alloc(self%scene, scene)
    call move_alloc(self%method, method)
    t = self%t
    y = self%y
    call integrate(scene, method, t, y, self%t + patience*two_pi/scene%speed_scale(scene%span), 0, self, status)
    if (status /= integration_interrupted) self%is_there = .false.
    call move_alloc(scene, self%scene)
    call move_alloc(method, self%method)
    if (allocated(self%kept)) call move_alloc(self%kept, self%scene)
  end subroutine run_to

  subroutine step_taken(self, method, problem, t_to)
    class(companion_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    class(ode_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t_to
    real(dp) :: y(problem%n)
    select type (problem)
    type is (scene_t)
      call method%interpolate(t_to, y)
      if (self%direction*(problem%crank_angle(t_to, y) - self%target) < 0) return
      call find_passage(method, problem, self%target, self%direction, method%t_old, t_to, 0.0_dp, self%t, self%y)
      self%is_there = .true.
      self%wants_to_stop = .true.
      call keep(problem, self%kept)
    end select
  end subroutine step_taken

  subroutine keep(scene, kept)
    type(scene_t), intent(in) :: scene
    type(scene_t), allocatable, intent(out) :: kept
    allocate (kept, source=scene)
  end subroutine keep

  subroutine event_taken(self, problem, index, t, y)
    class(companion_t), intent(inout) :: self
    class(ode_problem_t), intent(in) :: problem
    integer, intent(in) :: index
    real(dp), intent(in) :: t, y(:)
    associate (unused_self => self, unused_problem => problem, unused_index => index, unused_t => t, unused_y => y)
    end associate
  end subroutine event_taken
end module lyapunov
