!> The growth of a change of the state in a problem of the standard battery; it limits the accuracy of any integrator.
module conditioning
  use kinds, only: dp
  use adams, only: adams_t
  use ode_solver, only: integrate, silent_observer_t, integration_done
  use standard_problems, only: standard_problem_t, new_standard_problem, standard_settings
  use sampler, only: sampler_t
  implicit none
  private
  public :: condition_of

contains

  !> The condition of problem `number`: the largest factor by which a small change of y at time s has grown at a later time t. It is
  !> the largest row sum of |W(t) dy(t)/dy(s) W(s)^-1|, W = 1/(1 + |y|), by finite differences. s and t are among 23 equal parts of
  !> the span; no multiple of a period of any problem is near one of these.
  real(dp) function condition_of(number)
    integer, intent(in) :: number
    integer, parameter :: instants = 23
    type(standard_problem_t) :: problem
    real(dp), allocatable :: y(:), changed(:), plain(:, :), moved(:, :), growth(:, :)
    real(dp), parameter :: change = 1e-8_dp
    real(dp) :: t
    integer :: i, j

    condition_of = 1
    do j = 0, instants - 1
      call new_standard_problem(number, problem, y)
      t = problem%t_end*j/instants
      if (j > 0) call advance(problem, t, y)
      call samples_from(problem, t, y, instants, plain)
      if (allocated(growth)) deallocate (growth)
      allocate (growth(size(plain, 1), size(plain, 2)))
      growth = 0
      do i = 1, problem%n
        changed = y
        changed(i) = y(i) + change*(1 + abs(y(i)))
        call samples_from(problem, t, changed, instants, moved)
        growth = growth + abs(moved - plain)/(1 + abs(plain))/change
      end do
      condition_of = max(condition_of, maxval(growth))
    end do
  end function condition_of

  !> Integrate a new problem from 0 to t, including a discontinuity at t itself.
  subroutine advance(problem, t, y)
    type(standard_problem_t), intent(inout) :: problem
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    type(adams_t) :: method
    type(silent_observer_t) :: nobody
    real(dp) :: t_start
    integer :: status
    method%settings = standard_settings(problem, 1e-13_dp)
    t_start = 0
    call integrate(problem, method, t_start, y, t, 0, nobody, status)
    if (status /= integration_done) error stop 'a problem of the battery did not reach its end'
    if (problem%n_events > 0) problem%part = int(t/merge(10.0_dp, 1.0_dp, problem%name == 'F4') + 1e-9_dp)
  end subroutine advance

  subroutine samples_from(problem, t, y, instants, samples)
    type(standard_problem_t), intent(in) :: problem
    real(dp), intent(in) :: t, y(:)
    integer, intent(in) :: instants
    real(dp), allocatable, intent(out) :: samples(:, :)
    type(standard_problem_t) :: copy
    type(adams_t) :: method
    type(sampler_t) :: sampler
    real(dp) :: state(size(y)), t_start
    integer :: status
    copy = problem
    method%settings = standard_settings(copy, 1e-13_dp)
    sampler%interval = copy%t_end/instants
    sampler%taken = nint(t/sampler%interval)
    allocate (sampler%y(copy%n, instants), source=0.0_dp)
    state = y
    t_start = t
    call integrate(copy, method, t_start, state, copy%t_end, 0, sampler, status)
    if (status /= integration_done) error stop 'a problem of the battery did not reach its end'
    call move_alloc(sampler%y, samples)
  end subroutine samples_from
end module conditioning
