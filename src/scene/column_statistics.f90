!> Statistics of columns of a trace over a run or over its last cycle, whether or not the columns are written. Means are integrated
!> over each step by Gauss's rule of three points; extremes are searched inside steps.
module column_statistics
  use kinds, only: dp
  use constants, only: gauss_points, gauss_weights
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: nearest_word, allowed, replaced
  use ode_method, only: ode_method_t
  use case_definition, only: case_t
  use scene_problem, only: scene_t, evaluation_t
  use inside_step, only: evaluate_inside
  use peak_search, only: sample_t, peak_search_t
  use trace_columns, only: column_list_t, all_columns, row_values
  use run_length, only: longest_period
  implicit none
  private
  public :: statistic_t, column_statistics_t, read_statistics, of_result

  integer, parameter :: of_min = 1, of_max = 2, of_max_abs = 3, of_range = 4, of_mean = 5, of_rms = 6, &
    of_result = 7   ! of the run, by its name in the summary: not followed here
  character(len=7), parameter :: kinds_of(6) = [character(len=7) :: 'min', 'max', 'max abs', 'range', 'mean', 'rms']

  !> One statistic that is wanted.
  type :: statistic_t
    integer :: kind = 0
    character(len=48) :: column = ''   !! with its unit, or the name of a result
    character(len=72) :: name = ''     !! of its column in the results, with its unit
  end type statistic_t

  !> Sums and extremes of each column over a time.
  type :: sums_t
    real(dp) :: duration = 0           !! [s]
    real(dp), allocatable :: low(:), high(:), sum(:), square(:)
  end type sums_t

  !> Follows one run. It can be used again for another run.
  type :: column_statistics_t
    type(statistic_t), allocatable :: wanted(:)           !! not allocated: none
    type(column_list_t), private :: list                  !! their columns, each once
    integer, allocatable, private :: at(:)                !! of each statistic in the list; 0: the scene does not have the column
    type(sums_t), private :: present, whole, recent(0:longest_period - 1)   !! revolution k in element mod(k, longest_period)
    integer, private :: ended = 0                         !! number of revolutions that have ended
    real(dp), private :: t = 0
  contains
    procedure :: is_on
    procedure :: prepare
    procedure :: begin
    procedure :: record
    procedure :: end_revolution
    procedure :: find
  end type column_statistics_t

contains

  !> Read statistics such as 'max abs piston_acceleration, mean film_power', and names of results. Errors: a statistic that there is
  !> not, or a column that the scene of the case does not have.
  subroutine read_statistics(text, case, wanted, error)
    character(len=*), intent(in) :: text
    type(case_t), intent(in) :: case
    type(statistic_t), allocatable, intent(out) :: wanted(:)
    type(error_t), allocatable, intent(out) :: error
    type(column_list_t) :: list
    type(statistic_t) :: one
    character(len=:), allocatable :: rest, part, word, column, near
    integer :: blank, i
    allocate (wanted(0))
    if (text == '') return
    call all_columns(case, .false., list)
    rest = text//','
    do while (rest /= '')
      part = trim(adjustl(rest(:index(rest, ',') - 1)))
      rest = rest(index(rest, ',') + 1:)
      blank = index(part, ' ', back=.true.)
      word = squeezed(part(:max(0, blank - 1)))
      column = part(blank + 1:)
      if (blank == 0 .and. part /= '') then
        call add(statistic_t(of_result, name=part))
        if (allocated(error)) return
        cycle
      end if
      one%kind = findloc(kinds_of == word, .true., 1)
      if (one%kind == 0) then
        near = nearest_word(word, kinds_of)
        if (near /= '') near = '; did you mean '//near//'?'
        call fail(error, ''''//part//''': must be a statistic and a column'//near//allowed(kinds_of), status_case_file)
        return
      end if
      do i = 1, size(list%names)
        if (column == bare(list%names(i)) .or. column == list%names(i)) exit
      end do
      if (i > size(list%names)) then
        near = nearest_word(column, bare(list%names))
        if (near /= '') near = '; did you mean '//near//'?'
        call fail(error, ''''//part//''': no such column in this scene'//near, status_case_file)
        return
      end if
      one%column = list%names(i)
      one%name = trim(bare(list%names(i)))//'_'//replaced(word, ' ', '_')//list%names(i)(scan(list%names(i), '['):)
      call add(one)
      if (allocated(error)) return
    end do

  contains

    subroutine add(one)
      type(statistic_t), intent(in) :: one
      if (any(wanted%name == one%name)) call fail(error, ''''//part//''': is given twice', status_case_file)
      wanted = [wanted, one]
    end subroutine add
  end subroutine read_statistics

  !> The name of a column without its unit.
  elemental function bare(name)
    character(len=*), intent(in) :: name
    character(len=len(name)) :: bare
    bare = name(:index(name//'[', '[') - 1)
  end function bare

  !> A text with single blanks.
  pure function squeezed(text)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: squeezed
    integer :: i
    squeezed = ''
    do i = 1, len(text)
      if (text(i:i) == ' ' .and. index(text(:i), '  ', back=.true.) == i - 1 .and. i > 1) cycle
      squeezed = squeezed//text(i:i)
    end do
    squeezed = trim(squeezed)
  end function squeezed

  !> Whether any statistic is wanted.
  pure logical function is_on(self)
    class(column_statistics_t), intent(in) :: self
    is_on = .false.
    if (allocated(self%wanted)) is_on = any(self%wanted%kind /= of_result)
  end function is_on

  !> Find the columns in the scene of the case that is run next.
  subroutine prepare(self, case)
    class(column_statistics_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    integer :: i
    if (.not. self%is_on()) return
    call all_columns(case, .false., self%list)
    self%list%id = pack([(i, i=1, size(self%list%names))], [(any(self%wanted%column == self%list%names(i)), &
      i=1, size(self%list%names))])
    self%at = [(findloc(self%list%names(self%list%id) == self%wanted(i)%column, .true., 1), i=1, size(self%wanted))]
  end subroutine prepare

  !> Begin a run at time t.
  subroutine begin(self, t, ended)
    class(column_statistics_t), intent(inout) :: self
    real(dp), intent(in) :: t
    integer, intent(in) :: ended   !! number of revolutions that have ended before
    if (.not. self%is_on()) return
    self%t = t
    self%ended = ended
    call clear(self%present, size(self%list%id))
    call clear(self%whole, size(self%list%id))
  end subroutine begin

  subroutine clear(sums, n)
    type(sums_t), intent(out) :: sums
    integer, intent(in) :: n
    allocate (sums%low(n), source=huge(1.0_dp))
    allocate (sums%high(n), source=-huge(1.0_dp))
    allocate (sums%sum(n), sums%square(n), source=0.0_dp)
  end subroutine clear

  !> Account for the time since the last call up to t, inside the last step of the method; for statistics that are on.
  subroutine record(self, method, scene, t, initial_energy, evaluations)
    class(column_statistics_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, initial_energy   !! [s], [J]
    integer, intent(inout) :: evaluations       !! of the scene
    integer, parameter :: n = 5                 !! points in an interval: its ends and those of Gauss
    real(dp), parameter :: place(n) = [0.0_dp, gauss_points, 1.0_dp], weight(n) = [0.0_dp, gauss_weights, 0.0_dp]
    real(dp) :: values(size(self%list%id), n), span
    logical :: is_good(n)
    integer :: i, k
    span = t - self%t
    if (.not. span > 0) return
    do i = 1, n
      call evaluate(self%t + place(i)*span, values(:, i), is_good(i))
      if (.not. is_good(i)) cycle
      associate (sums => self%present)
        sums%duration = sums%duration + weight(i)*span
        sums%sum = sums%sum + weight(i)*span*values(:, i)
        sums%square = sums%square + weight(i)*span*values(:, i)**2
        sums%low = min(sums%low, values(:, i))
        sums%high = max(sums%high, values(:, i))
      end associate
    end do
    if (all(is_good)) then
      do k = 1, size(self%list%id)
        call search(k, 1.0_dp, self%present%high(k))
        self%present%low(k) = -self%present%low(k)
        call search(k, -1.0_dp, self%present%low(k))
        self%present%low(k) = -self%present%low(k)
      end do
    end if
    self%t = t

  contains

    subroutine evaluate(time, row, in_domain)
      real(dp), intent(in) :: time
      real(dp), intent(out) :: row(:)
      logical, intent(out) :: in_domain
      type(evaluation_t) :: now
      real(dp) :: y(scene%n)
      call evaluate_inside(scene, method, time, y, now, in_domain, evaluations)
      row = 0
      if (in_domain) call row_values(self%list, scene, time, now, scene%work(y), initial_energy, row)
    end subroutine evaluate

    !> Raise the largest value of column k times a sign by a search between the points beside the largest of the interval, if the
    !> value may rise above it there. Of a largest value at an end a point close to it tells whether there is a peak inside.
    subroutine search(k, sense, most)
      integer, intent(in) :: k
      real(dp), intent(in) :: sense
      real(dp), intent(inout) :: most
      real(dp), parameter :: close = 0.02_dp
      type(peak_search_t) :: peak
      real(dp) :: v(n), times(n), row(size(self%list%id)), time
      logical :: in_domain, is_done
      integer :: best, before, after
      v = sense*values(k, :)
      times = self%t + place*span
      best = maxloc(v, 1)
      before = max(best - 1, 1)
      after = min(best + 1, n)
      if (.not. v(best) + max(v(best) - v(before), v(best) - v(after)) > most .or. .not. max(v(best) - v(before), &
        v(best) - v(after)) > 0) return
      call peak%begin(sample_t(times(before), v(before), 0.0_dp), sample_t(times(after), v(after), 0.0_dp))
      if (before == best .or. after == best) then
        time = times(best) + close*(times(after + before - best) - times(best))
        call evaluate(time, row, in_domain)
        if (.not. in_domain .or. .not. sense*row(k) > v(best)) return
        call peak%add_value(time, sense*row(k))
      else
        call peak%add_value(times(best), v(best))
      end if
      do
        call peak%next_time(time, is_done)
        if (is_done) exit
        call evaluate(time, row, in_domain)
        if (.not. in_domain) return
        call peak%add_value(time, sense*row(k))
      end do
      most = max(most, peak%value(1))
    end subroutine search
  end subroutine record

  !> End the present revolution.
  subroutine end_revolution(self)
    class(column_statistics_t), intent(inout) :: self
    if (.not. self%is_on()) return
    self%ended = self%ended + 1
    self%recent(mod(self%ended, longest_period)) = self%present
    call join(self%whole, self%present)
    call clear(self%present, size(self%list%id))
  end subroutine end_revolution

  !> Add the sums of another time.
  pure subroutine join(sums, other)
    type(sums_t), intent(inout) :: sums
    type(sums_t), intent(in) :: other
    sums%duration = sums%duration + other%duration
    sums%low = min(sums%low, other%low)
    sums%high = max(sums%high, other%high)
    sums%sum = sums%sum + other%sum
    sums%square = sums%square + other%square
  end subroutine join

  !> Statistic number i over the last `revolutions` whole revolutions; 0: over the whole run. `is_known` is false if the scene does
  !> not have the column, or there was no time.
  subroutine find(self, i, revolutions, value, is_known)
    class(column_statistics_t), intent(in) :: self
    integer, intent(in) :: i, revolutions
    real(dp), intent(out) :: value
    logical, intent(out) :: is_known
    type(sums_t) :: sums
    integer :: k
    value = 0
    is_known = .false.
    if (.not. allocated(self%at) .or. .not. allocated(self%present%low)) return
    k = self%at(i)
    if (k == 0) return
    call clear(sums, size(self%list%id))
    if (revolutions > 0) then
      call join_recent()
    else
      sums = self%whole
      call join(sums, self%present)
    end if
    is_known = sums%duration > 0
    if (.not. is_known) return
    select case (self%wanted(i)%kind)
    case (of_min)
      value = sums%low(k)
    case (of_max)
      value = sums%high(k)
    case (of_max_abs)
      value = max(abs(sums%low(k)), abs(sums%high(k)))
    case (of_range)
      value = sums%high(k) - sums%low(k)
    case (of_mean)
      value = sums%sum(k)/sums%duration
    case default   ! of_rms
      value = sqrt(sums%square(k)/sums%duration)
    end select

  contains

    subroutine join_recent()
      integer :: revolution
      do revolution = self%ended - revolutions + 1, self%ended
        call join(sums, self%recent(mod(revolution, longest_period)))
      end do
    end subroutine join_recent
  end subroutine find
end module column_statistics
