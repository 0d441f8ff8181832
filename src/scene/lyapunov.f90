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
!> In the first revolutions, which are not counted, the difference turns to the direction of largest growth. Where two directions of
!> a settled motion shrink at similar rates it turns very slowly. Therefore a third scene then follows a second direction, kept
!> orthogonal to the first. The change of both over one period is a 2 x 2 matrix; the measurement continues with its eigenvector of
!> the larger eigenvalue.
!>
!> All scenes are integrated with the tolerance 1e-11; differences are 1e-5 of the natural sizes of the state. Within a quarter
!> of a revolution some directions may grow a hundredfold while others shrink by 1e-8; errors of the integration that are not far
!> smaller than the difference would turn it and bias the mean. If a difference shrinks by more than a factor of about 1e5 in a
!> quarter of a revolution, it is lost in these errors: exponents below -45 are upper bounds.
module lyapunov
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t
  use case_definition, only: case_t
  use ode_method, only: ode_method_t
  use ode_problem, only: ode_problem_t
  use ode_methods, only: new_method
  use ode_solver, only: integration_t, silent_observer_t, integration_interrupted, integration_done, &
    integration_stopped
  use scene_problem, only: scene_t
  use scene_builder, only: settings_for
  use crank_passage, only: find_passage
  use stop_reason, only: reason, place
  use state_differences, only: differences_t, new_differences, most_directions, first_size
  implicit none
  private
  public :: exponent_t, measurement_t

  integer, parameter :: per_revolution = 4             !! measurements in one revolution
  real(dp), parameter :: tolerance = 1e-11_dp          !! relative, of all scenes
  real(dp), parameter :: smallest_growth = 1e-12_dp    !! smallest growth factor that is resolved
  real(dp), parameter :: longest_revolution = 100  !! longest time for one, relative to its time at the crank speed at which it
                                         !! begins

  !> Result of the measurement.
  type :: exponent_t
    logical :: is_known = .false.
    real(dp) :: mean = 0          !! per revolution
    real(dp) :: error = 0  !! standard error of the mean, from the scatter between periods or, without a period, between revolutions
    integer :: revolutions = 0    !! number of revolutions of which it is the mean
    character(len=:), allocatable :: reason   !! why it is not known
  end type exponent_t

  !> One of the scenes.
  type, extends(silent_observer_t) :: companion_t
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    real(dp) :: t = 0                        !! [s]
    real(dp), allocatable :: y(:)
    real(dp) :: target = 0, direction = 1    !! crank angle to which it runs [rad], and the sense of rotation
    logical :: has_arrived = .false.         !! otherwise t and y are where it has stopped
    integer :: status = 0                    !! of the integration
    type(integration_t), allocatable :: integration   !! while it is on its way
    type(scene_t), allocatable :: kept       !! the scene at that angle, before an event at the end of the last step
  contains
    procedure :: run_on
    procedure :: step_accepted
    procedure :: why_stopped
  end type companion_t

  !> A measurement under way.
  type :: measurement_t
    type(exponent_t) :: exponent
    logical :: is_over = .false.             !! measured, or a scene could not continue
    type(companion_t), private :: scenes(0:most_directions)   !! 0: the motion itself
    integer, private :: stopped = -1         !! the scene that could not go on; -1: none
    type(differences_t), private :: differences
    integer, private :: i = 0                !! number of the present revolution; those that are not counted have numbers <= 0
    integer, private :: quarters = 0         !! of it that have been measured
    integer, private :: running = -1         !! the scene that is on its way through the next quarter; -1: none
    integer, private :: block = 1            !! number of revolutions of a period
    integer, private :: blocks = 1           !! number of periods that are counted
    real(dp), private :: growth = 0, sum_of = 0, sum_of_squares = 0
  contains
    procedure :: begin
    procedure :: advance
    procedure :: explain
  end type measurement_t

contains

  !> Begin to measure the exponent over the given number of revolutions, extended to whole periods, after some revolutions in which
  !> the difference finds its direction.
  subroutine begin(self, case, scene, t, y, period)
    class(measurement_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: scene         !! at the end of the run
    real(dp), intent(in) :: t, y(:)            !! end of the run
    integer, intent(in) :: period              !! of the motion [revolutions]; 0: it is not periodic
    integer :: revolutions, d
    self%block = max(1, period)
    self%blocks = (case%run%lyapunov_revolutions - 1)/self%block + 1
    revolutions = self%block*self%blocks
    self%i = 1 - self%block*((max(2, min(20, revolutions/5)) - 1)/self%block + 1)
    self%differences = new_differences(scene)
    self%differences%most_lasts = per_revolution*max(2, self%block)   ! no cycle of a gas is longer than two revolutions
    do d = 0, size(self%differences%state, 2)
      call prepare(case, scene, t, y, self%scenes(d))
    end do
  end subroutine begin

  !> Let one scene go on, through at most so many trials of a step (0: no limit), and measure when all have reached the end of a
  !> quarter of a revolution.
  subroutine advance(self, most_steps)
    class(measurement_t), intent(inout) :: self
    integer, intent(in) :: most_steps
    real(dp) :: factors(most_directions, most_directions)
    logical :: has_stopped
    associate (i => self%i, block => self%block, blocks => self%blocks, exponent => self%exponent)
      if (self%running < 0) then
        if (i == 1 - block .and. self%quarters == 0) call self%differences%begin_period()
        call set_out(self)
      end if
      call self%scenes(self%running)%run_on(most_steps, has_stopped)
      if (.not. has_stopped) return
      self%is_over = .not. self%scenes(self%running)%has_arrived
      if (self%is_over) self%stopped = self%running
      if (self%is_over) return
      associate (one => self%scenes(0), it => self%scenes(self%running))
        if (self%running > 0) call self%differences%measure(self%running, one%scene, one%y, it%scene, it%y)
      end associate
      self%running = self%running + 1
      if (self%running <= size(self%differences%state, 2)) return
      self%running = -1
      call self%differences%straighten(factors)
      self%growth = self%growth + log(max(factors(1, 1), smallest_growth))
      self%quarters = mod(self%quarters + 1, per_revolution)
      if (self%quarters > 0) return
      if (i == 0) call self%differences%choose_one()
      if (i >= 1 .and. mod(i, block) == 0) then
        self%sum_of = self%sum_of + self%growth
        self%sum_of_squares = self%sum_of_squares + self%growth**2
      end if
      if (i < 1 .or. mod(i, block) == 0) self%growth = 0
      self%is_over = i == block*blocks
      i = i + 1
      if (.not. self%is_over) return
      exponent%is_known = .true.
      exponent%revolutions = block*blocks
      exponent%mean = self%sum_of/exponent%revolutions
      if (blocks > 1) exponent%error = &
        sqrt(max(0.0_dp, self%sum_of_squares/blocks - (self%sum_of/blocks)**2)/(blocks - 1))/block
    end associate
  end subroutine advance

  !> Say why the exponent is not known, if a scene could not go on.
  subroutine explain(self)
    class(measurement_t), intent(inout) :: self
    if (self%stopped >= 0) call self%scenes(self%stopped)%why_stopped(self%exponent%reason)
  end subroutine explain

  !> Set all scenes out for a quarter of a revolution.
  subroutine set_out(self)
    class(measurement_t), intent(inout) :: self
    integer :: d
    self%running = 0
    associate (one => self%scenes(0), differences => self%differences)
      one%target = one%scene%crank_angle(one%t, one%y) + one%direction*two_pi/per_revolution
      do d = 1, size(differences%state, 2)
        call set_beside(one, self%scenes(d), differences%at, first_size*differences%state(:, d), &
          first_size*differences%impact_speed(:, d))
        self%scenes(d)%target = one%target
      end do
    end associate
  end subroutine set_out

  !> Prepare a scene that continues the run from its end.
  subroutine prepare(case, scene, t, y, companion)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(companion_t), intent(inout) :: companion
    type(case_t) :: tight
    type(error_t), allocatable :: ignored
    tight = case
    tight%integrator%relative_tolerance = tolerance
    tight%integrator%absolute_tolerance = 0
    allocate (companion%scene, source=scene)
    companion%scene%enters_at_step_end = .false.   ! contacts are entered at the root of the event function
    if (allocated(companion%scene%turns)) companion%scene%turns%wanted = 1e30_dp   ! never reached
    call new_method('auto', companion%method, ignored)
    companion%method%settings = settings_for(tight, companion%scene)
    companion%t = t
    companion%y = y
    companion%direction = sign(1.0_dp, companion%scene%crank_speed(t, y))
  end subroutine prepare

  !> Set another scene to the first one; its state differs by a difference, and the impact speeds of its contacts as given.
  subroutine set_beside(one, other, at, difference, impact_speed)
    type(companion_t), intent(inout) :: one, other
    integer, intent(in) :: at(:)
    real(dp), intent(in) :: difference(:), impact_speed(:)   !! of the state, of the speeds [m/s]
    integer :: i
    other%scene = one%scene
    other%t = one%t
    other%y = one%y
    other%y(at) = one%y(at) + difference
    do i = 1, one%scene%n_joints
      other%scene%joints(i)%impact_speed = max(0.0_dp, one%scene%joints(i)%impact_speed + impact_speed(i))
    end do
  end subroutine set_beside

  !> Run on through so many trials of a step (0: no limit), at most until the crank is at the target angle. It stops there, or
  !> because it cannot reach that; `has_arrived` is then false.
  subroutine run_on(self, most_steps, has_stopped)
    class(companion_t), intent(inout) :: self
    integer, intent(in) :: most_steps
    logical, intent(out) :: has_stopped
    type(scene_t), allocatable :: scene
    class(ode_method_t), allocatable :: method
    type(integration_t), allocatable :: integration
    call move_alloc(self%scene, scene)
    call move_alloc(self%method, method)
    call move_alloc(self%integration, integration)
    if (.not. allocated(integration)) then
      self%has_arrived = .false.
      self%wants_to_stop = .false.
      allocate (integration)
      call integration%begin(scene, method, self%t, self%y, self%t + longest_revolution*two_pi/scene%speed_scale(), 0)
    end if
    call integration%go_to(scene, method, self, huge(1.0_dp), most_steps)
    has_stopped = integration%is_over
    if (has_stopped) call integration%finish(method)
    call move_alloc(scene, self%scene)
    call move_alloc(method, self%method)
    if (.not. has_stopped) then
      call move_alloc(integration, self%integration)
      return
    end if
    self%status = integration%status
    if (self%status /= integration_interrupted) self%has_arrived = .false.
    if (.not. self%has_arrived) then
      self%t = integration%t
      self%y = integration%y
    else if (allocated(self%kept)) then
      call move_alloc(self%kept, self%scene)
    end if
  end subroutine run_on

  !> Why and where a scene has stopped before it was at the angle.
  subroutine why_stopped(self, text)
    class(companion_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: text
    text = 'the crank stops, turns back or takes too long for a quarter of a revolution'
    if (all(self%status /= [integration_done, integration_stopped])) &
      text = reason(self%status, self%scene, self%method%settings, self%t, self%y)
    text = text//' at '//place(self%scene, self%t, self%y)
  end subroutine why_stopped

  subroutine step_accepted(self, method, problem, t_to)
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
      self%has_arrived = .true.
      self%wants_to_stop = .true.
      if (allocated(self%kept)) deallocate (self%kept)
      allocate (self%kept, source=problem)
    end select
  end subroutine step_accepted
end module lyapunov
