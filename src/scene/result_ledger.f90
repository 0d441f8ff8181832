!> The results of a run that are kept of columns (`keep` of `trace_row`): extremes over each revolution and over the run.
!>
!> The ledger follows the columns through every step. It has their values at the ends of intervals, which are steps or parts of them
!> that end at an event or at the end of a revolution. Where an extreme inside the interval may exceed that of the present
!> revolution, by the rates of the column or, where these are not known, by its values in three points, it is searched there.
module result_ledger
  use kinds, only: dp
  use run_state, only: run_state_t
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t, evaluation_t
  use inside_step, only: evaluate_inside
  use trace_columns, only: column_list_t, row_values, unit_in
  use trace_row, only: kept_t, least, largest, largest_size
  use peak_search, only: sample_t, peak_search_t, may_peak, may_exceed
  use run_length, only: longest_period
  implicit none
  private
  public :: ledger_t, kept_result_t

  !> A result over the run, or over its last cycle.
  type :: kept_result_t
    character(len=:), allocatable :: name, unit
    real(dp) :: value = 0
  end type kept_result_t

  type :: ledger_t
    type(kept_t), allocatable, private :: kept(:)
    type(column_list_t), private :: list                    !! the columns that are followed
    integer, allocatable, private :: at(:)                  !! of each result: its column among those
    logical, allocatable, private :: is_searched(:, :)      !! (1: for its largest, 2: for its smallest value; column)
    logical, allocatable, private :: has_rate(:)
    real(dp), allocatable, private :: present(:, :), whole(:, :)   !! largest values and negatives of the smallest ones, of the
                                                            !! present revolution and of the run; as is_searched
    real(dp), allocatable, private :: recent(:, :, :)       !! those of revolution k in element mod(k, longest_period)
    logical, private :: is_fresh = .true.                   !! since an event: values and rates of the last interval no longer hold
    logical, private :: has_before = .false.                !! the interval before is of the same phases
    real(dp), private :: t_before = 0, t = 0                !! beginning and end of the last interval [s]
    real(dp), allocatable, private :: before(:), last(:), last_rate(:)   !! values there, and rates at its end
    real(dp), allocatable, dimension(:), private :: values, rates, inside   !! at the end of the interval, and inside
  contains
    procedure :: prepare
    procedure :: declare
    procedure :: begin
    procedure :: follow
    procedure :: change_phases
    procedure :: end_revolution
    procedure :: results
    procedure :: of_cycle
  end type ledger_t

contains

  !> Prepare for the results that are kept of the columns of a scene.
  subroutine prepare(self, list)
    class(ledger_t), intent(inout) :: self
    type(column_list_t), intent(in) :: list
    integer :: i, n
    allocate (self%kept(0))
    if (allocated(list%kept)) self%kept = list%kept
    self%list = list
    if (.not. allocated(list%names)) allocate (self%list%names(0))
    n = size(self%list%names)
    self%list%id = pack([(i, i=1, n)], [(any(self%kept%column == i), i=1, n)])
    n = size(self%list%id)
    self%at = [(findloc(self%list%id, self%kept(i)%column, 1), i=1, size(self%kept))]
    allocate (self%is_searched(2, n), self%has_rate(n), source=.false.)
    do i = 1, size(self%kept)
      associate (kept => self%kept(i), k => self%at(i))
        if (kept%what /= least) self%is_searched(1, k) = .true.
        if (kept%what /= largest) self%is_searched(2, k) = .true.
        self%has_rate(k) = self%has_rate(k) .or. kept%has_rate
      end associate
    end do
    allocate (self%present(2, n), self%whole(2, n), source=-huge(1.0_dp))
    allocate (self%recent(2, n, 0:longest_period - 1), source=-huge(1.0_dp))
    allocate (self%before(n), self%last(n), self%last_rate(n), source=0.0_dp)
    allocate (self%values(n), self%rates(n), self%inside(n))
  end subroutine prepare

  !> Declare the results over the run so far.
  subroutine declare(self, list)
    class(ledger_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp) :: value
    integer :: i
    do i = 1, size(self%kept)
      associate (kept => self%kept(i), extremes => self%whole(:, self%at(i)))
        value = found(kept%what, max(extremes, self%present(:, self%at(i))))
        call list%add(trim(kept%name), value, unit_in(self%list%names(kept%column)), trim(kept%meaning))
        if (.not. list%sets .or. .not. list%goes_on) cycle
        if (kept%what /= least) extremes(1) = value
        if (kept%what /= largest) extremes(2) = merge(-value, value, kept%what == least)
      end associate
    end do
  end subroutine declare

  !> The result of the extremes of a column.
  pure real(dp) function found(what, extremes)
    integer, intent(in) :: what
    real(dp), intent(in) :: extremes(2)
    found = extremes(1)
    if (what == least) found = -extremes(2)
    if (what == largest_size) found = maxval(extremes)
  end function found

  !> Begin at t, where the scene has been evaluated.
  subroutine begin(self, scene, t, now)
    class(ledger_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    self%t = t
    self%is_fresh = .false.
    self%has_before = .false.
    call row_values(self%list, scene, t, now, 0.0_dp, 0.0_dp, self%last, self%last_rate)
    call add_values(self, self%last)
  end subroutine begin

  !> Loads have changed at an event.
  pure subroutine change_phases(self)
    class(ledger_t), intent(inout) :: self
    self%is_fresh = .true.
  end subroutine change_phases

  !> Account for the values of the columns at one instant.
  pure subroutine add_values(self, values)
    class(ledger_t), intent(inout) :: self
    real(dp), intent(in) :: values(:)
    self%present(1, :) = max(self%present(1, :), values)
    self%present(2, :) = max(self%present(2, :), -values)
  end subroutine add_values

  !> Follow the columns from the end of the last interval to t, inside the last step of the method or at its end, where the scene
  !> has been evaluated.
  subroutine follow(self, method, scene, t, now, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    integer, intent(inout) :: evaluations    !! of the scene so far
    logical :: has_slopes
    integer :: k
    if (size(self%last) == 0 .or. .not. t > self%t) return
    if (self%is_fresh) call begin_anew(self, method, scene, evaluations)
    call row_values(self%list, scene, t, now, 0.0_dp, 0.0_dp, self%values, self%rates)
    call add_values(self, self%values)
    has_slopes = .false.
    do k = 1, size(self%values)
      if (self%is_searched(1, k)) call search(1, 1.0_dp)
      if (self%is_searched(2, k)) call search(2, -1.0_dp)
    end do
    self%before = self%last
    self%t_before = self%t
    self%has_before = .true.
    self%last = self%values
    self%last_rate = self%rates
    self%t = t

  contains

    !> Search the largest value of column k times a sign inside the interval, if it may exceed that of the present revolution.
    subroutine search(i, sense)
      integer, intent(in) :: i
      real(dp), intent(in) :: sense
      type(peak_search_t) :: peak
      type(sample_t) :: left, right
      real(dp) :: time
      logical :: is_done
      if (.not. self%has_rate(k)) then
        if (.not. may_exceed(self%t, sense*self%last(k), t, sense*self%values(k), self%present(i, k), self%has_before, &
          self%t_before, sense*self%before(k))) return
        if (.not. has_slopes) call find_slopes(self, method, scene, t, evaluations)
        has_slopes = .true.
      end if
      left = sample_t(self%t, sense*self%last(k), sense*self%last_rate(k))
      right = sample_t(t, sense*self%values(k), sense*self%rates(k))
      if (.not. may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, self%present(i, k))) return
      call peak%begin(left, right)
      do
        call peak%next_time(time, is_done)
        if (is_done) exit
        call look(self, method, scene, time, evaluations)
        call peak%add_value(time, sense*self%inside(k))
        call add_values(self, self%inside)
      end do
    end subroutine search
  end subroutine follow

  !> Begin an interval at the beginning of the step, after an event at which rates have jumped.
  subroutine begin_anew(self, method, scene, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(in) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(inout) :: evaluations
    type(evaluation_t) :: now
    logical :: in_domain
    self%has_before = .false.
    self%is_fresh = .false.
    evaluations = evaluations + 1
    call scene%evaluate(method%t_old, method%y_old, now, in_domain)
    if (.not. in_domain) return
    call row_values(self%list, scene, method%t_old, now, 0.0_dp, 0.0_dp, self%last, self%last_rate)
    call add_values(self, self%last)
  end subroutine begin_anew

  !> Slopes at both ends of the interval up to t of the columns whose rates are not known, from values a little inside.
  subroutine find_slopes(self, method, scene, t, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    integer, intent(inout) :: evaluations
    real(dp), parameter :: short = 1e-4_dp   !! part of the interval over which a slope is taken
    real(dp) :: step
    step = short*(t - self%t)
    call look(self, method, scene, self%t + step, evaluations)
    where (.not. self%has_rate) self%last_rate = (self%inside - self%last)/step
    call look(self, method, scene, t - step, evaluations)
    where (.not. self%has_rate) self%rates = (self%values - self%inside)/step
  end subroutine find_slopes

  !> Find the values at a time inside the step; outside the model they are those at the end of the interval.
  subroutine look(self, method, scene, time, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: time
    integer, intent(inout) :: evaluations
    type(evaluation_t) :: there
    real(dp) :: y(scene%n)
    logical :: in_domain
    self%inside = self%values
    call evaluate_inside(scene, method, time, y, there, in_domain, evaluations)
    if (in_domain) call row_values(self%list, scene, time, there, 0.0_dp, 0.0_dp, self%inside)
  end subroutine look

  !> End the present revolution; the next one begins with the values at its end.
  pure subroutine end_revolution(self, number)
    class(ledger_t), intent(inout) :: self
    integer, intent(in) :: number   !! of the revolution that ends
    self%recent(:, :, mod(number, longest_period)) = self%present
    self%whole = max(self%whole, self%present)
    self%present = -huge(1.0_dp)
    call add_values(self, self%last)
  end subroutine end_revolution

  !> The results over the run, and over its last cycle of some revolutions up to one with a number; 0 revolutions: it has none.
  function results(self, number, revolutions) result(list)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: number, revolutions
    type(kept_result_t), allocatable :: list(:)
    integer :: i
    allocate (list(0))
    call add('', max(self%whole, self%present))
    if (revolutions > 0) call add('cycle_', extremes_of_cycle(self, number, revolutions))

  contains

    subroutine add(prefix, extremes)
      character(len=*), intent(in) :: prefix
      real(dp), intent(in) :: extremes(:, :)
      do i = 1, size(self%kept)
        associate (kept => self%kept(i))
          list = [list, kept_result_t(prefix//trim(kept%name), unit_in(self%list%names(kept%column)), &
            found(kept%what, extremes(:, self%at(i))))]
        end associate
      end do
    end subroutine add
  end function results

  !> A result of the last cycle of some revolutions up to one with a number; 0 if the scene does not have it.
  pure real(dp) function of_cycle(self, name, number, revolutions) result(value)
    class(ledger_t), intent(in) :: self
    character(len=*), intent(in) :: name   !! without `cycle_`
    integer, intent(in) :: number, revolutions
    real(dp) :: extremes(2, size(self%last))
    integer :: i
    value = 0
    extremes = extremes_of_cycle(self, number, revolutions)
    do i = 1, size(self%kept)
      if (self%kept(i)%name == name) value = found(self%kept(i)%what, extremes(:, self%at(i)))
    end do
  end function of_cycle

  !> Largest values of the columns and negatives of their smallest ones in the last cycle.
  pure function extremes_of_cycle(self, number, revolutions) result(extremes)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: number, revolutions
    real(dp) :: extremes(2, size(self%last))
    integer :: k
    extremes = self%recent(:, :, mod(number, longest_period))
    do k = number - revolutions + 1, number - 1
      extremes = max(extremes, self%recent(:, :, mod(k, longest_period)))
    end do
  end function extremes_of_cycle
end module result_ledger
