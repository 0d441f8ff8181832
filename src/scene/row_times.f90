!> When the rows of a trace are due: at equally spaced times, at equally spaced crank angles, or at every accepted step.
module row_times
  use kinds, only: dp
  use constants, only: degree
  use ode_method, only: ode_method_t
  use case_definition, only: case_t
  use scene_problem, only: scene_t
  use scene_builder, only: latest_end, sample_interval
  use angle_grid, only: angle_grid_t
  use crank_passage, only: find_turning
  implicit none
  private
  public :: row_times_t

  type :: row_times_t
    real(dp) :: first_sample = 0      !! time of the first row [s]
    real(dp) :: interval = 0          !! time between rows [s]
    type(angle_grid_t) :: angles      !! crank angles of the rows, if rows are spaced by crank angle
    real(dp) :: end_time = 0          !! latest end of the run [s]
    logical :: every_step = .false.   !! a row at every accepted step
    integer, private :: next_row = 0
    real(dp), private :: t = 0, ends(2) = 0   !! of the step: time reached; times at which the crank turns back, and at its end [s]
    integer, private :: part = 1
  contains
    procedure :: choose
    procedure :: begin
    procedure :: enter_step
    procedure :: find_next
    procedure :: find_last
  end type row_times_t

contains

  !> The rows that a case asks for.
  subroutine choose(self, case)
    class(row_times_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    if (case%output%sampling == 'crank_angle') then
      self%angles%per_revolution = case%output%samples_per_revolution
      self%angles%origin = case%output%angle_origin_deg*degree
    else
      self%interval = sample_interval(case)
    end if
    self%first_sample = case%output%start_time
    self%every_step = case%output%every_step
    self%end_time = latest_end(case)
  end subroutine choose

  !> Find out whether a row is due at the start, at a time and a crank angle [rad], and which one comes next.
  subroutine begin(self, t, crank_angle, is_due)
    class(row_times_t), intent(inout) :: self
    real(dp), intent(in) :: t, crank_angle
    logical, intent(out) :: is_due
    real(dp), parameter :: same = 1e-9_dp   !! share of an interval that counts as rounding
    real(dp) :: intervals
    is_due = .true.
    if (self%angles%per_revolution > 0) then
      call self%angles%begin(crank_angle, is_due)
    else if (self%interval > 0 .and. self%first_sample <= t .and. .not. self%every_step) then
      intervals = (t - self%first_sample)/self%interval
      self%next_row = ceiling(intervals - same)
      is_due = self%next_row <= intervals + same
      if (is_due) self%next_row = self%next_row + 1
    end if
    is_due = is_due .and. self%first_sample <= t
  end subroutine begin

  !> Enter the last step of the method, which is final up to t_to.
  subroutine enter_step(self, method, scene, t_to, y)
    class(row_times_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to      !! [s]
    real(dp), intent(inout) :: y(:)   !! work space for a state
    logical :: turns
    self%t = method%t_old
    self%ends = t_to
    self%part = 1
    if (self%angles%per_revolution > 0 .and. scene%crank_moves) &
      call find_turning(method, scene, method%t_old, t_to, turns, self%ends(1), y)
  end subroutine enter_step

  !> Find the next row that is due in that step.
  subroutine find_next(self, method, scene, y, t, is_found)
    class(row_times_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(inout) :: y(:)   !! work space for a state
    real(dp), intent(out) :: t        !! [s]
    logical, intent(out) :: is_found
    is_found = .false.
    if (self%angles%per_revolution > 0) then
      do while (self%part <= 2)
        call self%angles%next_passage(method, scene, self%t, self%ends(self%part), t, y, is_found)
        self%t = t
        if (is_found .and. t >= self%first_sample) return
        if (is_found) cycle
        self%t = self%ends(self%part)
        self%part = self%part + 1
      end do
    else if (.not. self%every_step) then
      t = self%first_sample + self%next_row*self%interval
      is_found = t <= self%ends(2) .and. t <= self%end_time*(1 + 4*epsilon(t))
      if (is_found) self%next_row = self%next_row + 1
    end if
  end subroutine find_next

  !> Whether rounding has left out a row at the end of the run, at a time and a crank angle [rad]; `crank_angle` is then moved to
  !> that of the row.
  subroutine find_last(self, t, crank_angle, is_due)
    class(row_times_t), intent(in) :: self
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: crank_angle
    logical, intent(out) :: is_due
    real(dp), parameter :: same = 1e-9_dp   !! tolerance of the final crank angle [rad], share of an interval
    real(dp) :: angle
    is_due = .false.
    if (self%every_step) return
    if (self%angles%per_revolution > 0) then
      call self%angles%is_due(crank_angle, same, is_due, angle)
      is_due = is_due .and. t >= self%first_sample
      if (is_due) crank_angle = angle
    else
      is_due = abs(self%first_sample + self%next_row*self%interval - t) <= same*self%interval
    end if
  end subroutine find_last
end module row_times
