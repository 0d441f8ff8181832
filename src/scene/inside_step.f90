!> Evaluates a scene inside the last step of its integration, for output.
module inside_step
  use kinds, only: dp
  use constants, only: gauss_points, gauss_weights
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t, evaluation_t
  implicit none
  private
  public :: evaluate_inside, look_at_contacts, inner_points_t

  integer, parameter :: n_inner = size(gauss_points)

  !> The scene at the points of Gauss's rule inside an interval, for integrals over the time. They are evaluated once for all
  !> results that need them.
  type :: inner_points_t
    real(dp) :: from = 0, to = 0             !! the interval [s]
    integer :: n = 0                         !! number of points: none in an interval of no length
    real(dp) :: t(n_inner) = 0               !! [s]
    real(dp) :: weight(n_inner) = 0          !! of a value in the integral [s]
    logical :: in_domain(n_inner) = .false.  !! the scene is defined there
    real(dp) :: work(n_inner) = 0            !! of the non-conservative forces so far [J]
    type(evaluation_t) :: now(n_inner)
  contains
    procedure :: evaluate
  end type inner_points_t

contains

  !> Evaluate the scene inside the interval from the end of the last one to a time inside the last step.
  subroutine evaluate(self, scene, method, to, evaluations)
    class(inner_points_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: to
    integer, intent(inout) :: evaluations
    real(dp) :: y(scene%n), span
    integer :: i
    self%from = self%to
    self%to = to
    span = to - self%from
    self%n = 0
    if (.not. span > 0) return
    self%n = n_inner
    self%t = self%from + gauss_points*span
    self%weight = gauss_weights*span
    do i = 1, n_inner
      call evaluate_inside(scene, method, self%t(i), y, self%now(i), self%in_domain(i), evaluations)
      self%work(i) = scene%work(y)
    end do
  end subroutine evaluate

  !> State at a time inside the last step, and the evaluation of the scene there. Where the method can improve its interpolant, the
  !> forces are otherwise less accurate than at the ends of steps, in a stiff film by orders of magnitude. It is improved again
  !> while it changes by more than a tenth of a tolerance: after a jump of the load's rate of change, the first improvement takes
  !> off no more than four fifths of an error of several tolerances. `in_domain` is false if a model is not defined there.
  subroutine evaluate_inside(scene, method, t, y, now, in_domain, evaluations)
    type(scene_t), intent(in) :: scene
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(scene%n)
    type(evaluation_t), intent(out) :: now
    logical, intent(out) :: in_domain
    integer, intent(inout) :: evaluations   !! number of evaluations, to which those made here are added
    integer, parameter :: most_passes = 5
    real(dp), parameter :: small = 0.1_dp   !! [tolerances]
    real(dp), dimension(scene%n) :: better, next, rates
    real(dp) :: change, last_change
    integer :: pass
    call method%interpolate(t, y)
    better = y
    last_change = huge(last_change)
    if (method%may_improve(t)) then
      do pass = 1, most_passes
        call scene%derivatives(t, better, rates, in_domain)
        evaluations = evaluations + 1
        if (.not. in_domain) better = y
        if (.not. in_domain) exit
        next = better
        call method%improve(t, rates, next, change)
        if (.not. change < last_change) exit
        better = next
        if (.not. change > small) exit
        last_change = change
      end do
    end if
    call scene%evaluate(t, better, now, in_domain)
    evaluations = evaluations + 1
    if (in_domain) then
      y = better
    else if (any(abs(better - y) > 0)) then
      call scene%evaluate(t, y, now, in_domain)
      evaluations = evaluations + 1
    end if
  end subroutine evaluate_inside

  !> Set what contacts do by the state alone, at a time inside the last step: gaps, their rates and normal forces, at pins and at
  !> the corners of the skirt; and the crank angle.
  subroutine look_at_contacts(scene, method, t, now)
    type(scene_t), intent(in) :: scene
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: t
    type(evaluation_t), intent(inout) :: now
    real(dp) :: y(scene%n), normal_force
    integer :: i
    call method%interpolate(t, y)
    now%motion%crank_angle = scene%crank_angle(t, y)
    do i = 1, size(scene%joints)
      call scene%joints(i)%find_contact_state(y, now%joint(i), normal_force)
      now%joint(i)%normal_force = normal_force
    end do
    if (.not. allocated(scene%guide)) return
    if (scene%guide%is_loose) call scene%guide%find_contact_state(y, now%guide%corner)
  end subroutine look_at_contacts
end module inside_step
