!> The results of a run that are kept of columns (`keep` of `trace_row`), over each revolution, the last cycle and the run.
!>
!> The ledger follows the columns through every step. It has their values at the ends of intervals, which are steps or parts of
!> them that end at an event or at the end of a revolution, and at the points of Gauss's rule inside where a mean is kept. Where an
!> extreme inside the interval may exceed that of the present revolution, or of the present contact, it is searched there.
module result_ledger
  use kinds, only: dp
  use constants, only: two_pi, degree
  use run_state, only: run_state_t
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t, evaluation_t
  use inside_step, only: evaluate_inside, inner_points_t, look_at_contacts
  use trace_columns, only: column_list_t, row_values
  use trace_row, only: name_length, kept_t, least, largest, mean, integral, of_run, of_cycle
  use column_fold, only: fold_t, found, set_found, is_searched, has_senses, sense_of
  use root_search, only: bracket_t, next_abscissa, narrow
  use peak_search, only: sample_t, peak_search_t, may_peak, may_exceed, top_of_cubic
  use run_length, only: longest_period
  implicit none
  private
  public :: ledger_t, kept_result_t, find_result, degrees_in_cycle

  !> A result over the run, or over its last cycle.
  type :: kept_result_t
    character(len=16) :: place = ''                    !! prefix of its name
    character(len=48) :: name = ''
    character(len=name_length) :: unit = ''
    logical :: is_of_cycle = .false.
    real(dp) :: value = 0
  end type kept_result_t

  type :: ledger_t
    type(kept_t), allocatable, private :: kept(:)
    type(column_list_t), private :: list               !! the columns that are followed
    type(column_list_t), private :: of_contact, cheap  !! those of contacts, and those that are not sampled
    type(column_list_t), private :: at_impacts         !! columns whose values count where a contact begins, one for each result
    integer, allocatable, private :: contact_at(:), cheap_at(:)   !! their places in the list
    integer, allocatable, private :: at(:)             !! of each result: its column in the list, or behind in that of impacts
    integer, allocatable, private :: in_row(:)         !! of each column: its place in a row of the trace, or 0
    logical, allocatable, private :: is_searched(:, :) !! (1: for its largest, 2: for its smallest value; column)
    logical, allocatable, dimension(:), private :: has_rate, is_cubic, is_of_contact, is_sampled, has_senses
    integer, allocatable, private :: sense(:)          !! of the last value of a column that was not 0
    logical, allocatable, private :: touches(:)        !! the surfaces of its contact touch
    type(fold_t), allocatable, dimension(:), private :: present, whole, episode   !! present revolution, run before it, contact
    type(fold_t), allocatable, private :: recent(:, :) !! of revolution k in element mod(k, longest_period)
    type(inner_points_t) :: inner                      !! inside the last interval
    logical, private :: needs_inner = .false.          !! a column is sampled
    logical, private :: is_fresh = .true.              !! since an event: values and rates of the last interval no longer hold
    logical, private :: has_before = .false.           !! the interval before is of the same phases
    logical, private :: has_slopes(2) = .false.        !! `last_rate` has the slopes of columns without rates: 1: of those of
                                                       !! contacts, 2: of the others
    real(dp), private :: t_before = 0, t = 0           !! beginning and end of the last interval [s]
    real(dp), private :: angle = 0                     !! crank angle at its end [rad]
    real(dp), private :: angle_inside = 0              !! of the values inside [rad]
    real(dp), private :: initial_energy = 0            !! of the run [J]
    real(dp), allocatable, private :: before(:), last(:), last_rate(:)   !! values there, and rates at its end
    real(dp), allocatable, dimension(:), private :: values, rates, inside   !! at the end of the interval, and inside
    real(dp), allocatable, private :: samples(:, :)    !! values at the points of Gauss's rule in the interval
    real(dp), allocatable, private :: row(:)           !! work space for some of the columns
  contains
    procedure :: prepare
    procedure :: declare
    procedure :: begin
    procedure :: follow
    procedure :: add_row
    procedure :: change_phases
    procedure :: begin_contact
    procedure :: end_contact
    procedure :: find_contact
    procedure :: end_revolution
    procedure :: results
    procedure :: of_revolution
    procedure :: of_whole_run
    procedure :: over_cycle
  end type ledger_t

contains

  !> Prepare for the results that are kept of the columns of a scene.
  subroutine prepare(self, list, kept)
    class(ledger_t), intent(inout) :: self
    type(column_list_t), intent(in) :: list   !! the columns of a row
    type(kept_t), intent(in) :: kept(:)       !! what is kept of the columns of the scene
    integer :: i, n, m
    self%kept = kept
    self%list = list
    if (.not. allocated(list%names)) allocate (self%list%names(0))
    n = size(self%list%names)
    self%at_impacts = self%list
    self%list%id = pack([(i, i=1, n)], [(any(self%kept%column == i .and. .not. self%kept%at_impacts), i=1, n)])
    n = size(self%list%id)
    self%at_impacts%id = pack([(self%kept(i)%column, i=1, size(self%kept))], [(self%kept(i)%at_impacts, i=1, size(self%kept))])
    self%at = [(merge(n + count(self%kept(:i)%at_impacts), findloc(self%list%id, self%kept(i)%column, 1), &
      self%kept(i)%at_impacts), i=1, size(self%kept))]
    m = n + size(self%at_impacts%id)
    allocate (self%in_row(n), source=0)
    if (allocated(list%id)) self%in_row = [(findloc(list%id, self%list%id(i), 1), i=1, n)]
    allocate (self%is_searched(2, n), source=.false.)
    allocate (self%has_rate(n), self%is_cubic(n), self%is_of_contact(n), self%is_sampled(n), self%has_senses(n), source=.false.)
    allocate (self%touches(m), source=.false.)
    do i = 1, size(self%kept)
      associate (kept => self%kept(i), k => self%at(i))
        if (kept%at_impacts) cycle
        self%is_searched(:, k) = self%is_searched(:, k) .or. is_searched(kept)
        self%has_senses(k) = self%has_senses(k) .or. has_senses(kept)
        self%has_rate(k) = self%has_rate(k) .or. kept%has_rate
        self%is_cubic(k) = self%is_cubic(k) .or. kept%is_cubic
        self%is_of_contact(k) = self%is_of_contact(k) .or. kept%is_of_contact
        self%is_sampled(k) = self%is_sampled(k) .or. kept%is_sampled
      end associate
    end do
    self%needs_inner = any(self%is_sampled)
    self%contact_at = pack([(i, i=1, n)], self%is_of_contact)
    self%cheap_at = pack([(i, i=1, n)], .not. self%is_sampled)
    self%of_contact = self%list
    self%of_contact%id = self%list%id(self%contact_at)
    self%cheap = self%list
    self%cheap%id = self%list%id(self%cheap_at)
    allocate (self%present(m), self%whole(m), self%episode(m), self%recent(m, 0:longest_period - 1))
    allocate (self%before(n), self%last(n), self%last_rate(n), source=0.0_dp)
    allocate (self%values(n), self%rates(n), self%inside(n), self%row(m), self%samples(n, size(self%inner%t)))
    allocate (self%sense(n), source=0)
  end subroutine prepare

  !> Declare the results over the run so far, and what is known of the present contacts.
  subroutine declare(self, list)
    class(ledger_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(fold_t) :: run
    real(dp) :: value
    integer :: i
    logical :: is_set
    is_set = list%sets .and. list%goes_on
    do i = 1, size(self%kept)
      associate (kept => self%kept(i), whole => self%whole(self%at(i)), episode => self%episode(self%at(i)), &
        name => trim(self%kept(i)%place)//trim(self%kept(i)%name))
        if (kept%told /= of_cycle) then
          run = whole + self%present(self%at(i))
          if (kept%what == mean .or. kept%what == integral) then
            call list%add(name//'_integral', run%sum, trim(kept%unit)//' s', trim(kept%meaning)//': integral over time')
            call list%add(name//'_time', run%duration, 's', 'time of this integral')
            if (is_set) whole%sum = run%sum
            if (is_set) whole%duration = run%duration
          else
            value = found(kept, run)
            call list%add(name, value, trim(kept%unit), trim(kept%meaning))
            if (is_set) call set_found(kept, value, whole)
          end if
        end if
        if (.not. kept%is_of_contact) cycle
        value = found(kept, episode)
        call list%add(name//'_of_contact', value, trim(kept%unit), 'the same in the present contact, or in the last one')
        if (is_set) call set_found(kept, value, episode)
      end associate
    end do
  end subroutine declare

  !> Begin at t, where the scene has been evaluated.
  subroutine begin(self, scene, t, y, now, initial_energy)
    class(ledger_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t), intent(in) :: now
    real(dp), intent(in) :: initial_energy   !! of the run [J]
    self%initial_energy = initial_energy
    self%t = t
    self%inner%to = t
    self%is_fresh = .false.
    self%has_before = .false.
    self%has_slopes = .false.
    self%angle = now%motion%crank_angle
    call row_values(self%list, scene, t, now, scene%work(y), initial_energy, self%last, self%last_rate)
    call add_values(self, self%last, self%angle)
    self%sense = sense_of(self%last)
  end subroutine begin

  !> Loads have changed at an event.
  pure subroutine change_phases(self)
    class(ledger_t), intent(inout) :: self
    self%is_fresh = .true.
  end subroutine change_phases

  !> A contact begins at a place at time t, at which the scene has been evaluated before it begins; without a scene it goes on.
  pure subroutine begin_contact(self, place, scene, t, now)
    class(ledger_t), intent(inout) :: self
    character(len=*), intent(in) :: place    !! prefix of the names of its columns
    type(scene_t), intent(in), optional :: scene
    real(dp), intent(in), optional :: t
    type(evaluation_t), intent(in), optional :: now
    integer :: k, n
    n = size(self%last)
    if (present(scene) .and. size(self%at_impacts%id) > 0) &
      call row_values(self%at_impacts, scene, t, now, 0.0_dp, 0.0_dp, self%row(n + 1:))
    do k = 1, size(self%touches)
      if (.not. any(self%at == k .and. self%kept%place == place)) cycle
      if (k <= n) self%touches(k) = self%is_of_contact(k)
      if (.not. present(scene)) cycle
      self%episode(k) = fold_t()
      if (k <= n) cycle
      call self%present(k)%add(self%row(k), now%motion%crank_angle)
      self%present(k)%number = self%present(k)%number + 1
    end do
  end subroutine begin_contact

  !> The contact at a place has ended.
  pure subroutine end_contact(self, place)
    class(ledger_t), intent(inout) :: self
    character(len=*), intent(in) :: place
    where (self%kept%place == place) self%touches(self%at) = .false.
  end subroutine end_contact

  !> Largest penetration [m] and normal force [N] of the present or last contact at a place; 0 before the first one.
  pure subroutine find_contact(self, place, penetration, force)
    class(ledger_t), intent(in) :: self
    character(len=*), intent(in) :: place
    real(dp), intent(out) :: penetration, force
    integer :: i
    penetration = 0
    force = 0
    do i = 1, size(self%kept)
      associate (kept => self%kept(i), most => self%episode(self%at(i))%most)
        if (kept%place /= place .or. .not. kept%is_of_contact) cycle
        if (kept%what == least) penetration = max(penetration, most(2))
        if (kept%what == largest) force = max(force, most(1))
      end associate
    end do
  end subroutine find_contact

  !> Account for the values of the columns at one instant.
  pure subroutine add_values(self, values, angle)
    class(ledger_t), intent(inout) :: self
    real(dp), intent(in) :: values(:), angle
    integer :: k
    do k = 1, size(values)
      call add_value(self, k, values(k), angle)
    end do
  end subroutine add_values

  pure subroutine add_value(self, k, value, angle)
    class(ledger_t), intent(inout) :: self
    integer, intent(in) :: k
    real(dp), intent(in) :: value, angle
    call self%present(k)%add(value, angle)
    if (self%touches(k)) call self%episode(k)%add(value, angle)
  end subroutine add_value

  !> Account for the values of a row of the trace in the results of the run and of the present contact alone: those of a revolution
  !> must not depend on whether rows are written.
  pure subroutine add_row(self, row)
    class(ledger_t), intent(inout) :: self
    real(dp), intent(in) :: row(:)
    real(dp) :: most(2)
    integer :: k
    do k = 1, size(self%in_row)
      if (self%in_row(k) == 0) cycle
      most = [row(self%in_row(k)), -row(self%in_row(k))]
      self%whole(k)%most = max(self%whole(k)%most, most)
      if (self%touches(k)) self%episode(k)%most = max(self%episode(k)%most, most)
    end do
  end subroutine add_row

  !> Follow the columns from the end of the last interval to t, inside the last step of the method or at its end, where the scene
  !> has been evaluated.
  subroutine follow(self, method, scene, t, y, now, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t), intent(in) :: now
    integer, intent(inout) :: evaluations    !! of the scene so far
    logical :: has_slopes(2), has_samples   ! has_slopes: as above, at both ends of this interval
    real(dp) :: angle   ! at the beginning of the interval
    integer :: k
    if (size(self%last) == 0 .or. .not. t > self%t) return
    if (self%is_fresh) call begin_anew(self, method, scene, evaluations)
    call row_values(self%list, scene, t, now, scene%work(y), self%initial_energy, self%values, self%rates)
    angle = self%angle
    self%angle = now%motion%crank_angle
    call add_values(self, self%values, self%angle)
    has_samples = .false.
    if (self%needs_inner) call take_samples(self, method, scene, t, has_samples, evaluations)
    has_slopes = .false.
    do k = 1, size(self%values)
      if (self%is_searched(1, k)) call search(1, 1.0_dp)
      if (self%is_searched(2, k)) call search(2, -1.0_dp)
      if (self%has_senses(k)) call follow_sense(k)
    end do
    self%before = self%last
    self%t_before = self%t
    self%has_before = .true.
    self%last = self%values
    self%last_rate = self%rates
    self%has_slopes = has_slopes
    self%t = t

  contains

    !> Search the largest value of column k times a sign inside the interval, if it may exceed that of the present revolution.
    subroutine search(i, sense)
      integer, intent(in) :: i
      real(dp), intent(in) :: sense
      type(sample_t) :: left, right
      real(dp) :: known, top
      logical :: is_bounded
      integer :: group
      known = self%present(k)%most(i)
      if (self%touches(k)) known = min(known, self%episode(k)%most(i))
      if (self%has_senses(k)) known = max(known, 0.0_dp)   ! below 0 it is not in this sense
      if (.not. self%has_rate(k)) then
        if (has_samples) then
          call search_samples(k, sense, known)
          return
        end if
        if (.not. may_exceed(self%t, sense*self%last(k), t, sense*self%values(k), known, self%has_before, self%t_before, &
          sense*self%before(k))) return
        group = merge(1, 2, self%is_of_contact(k))
        if (.not. has_slopes(group)) call find_slopes(self, method, scene, t, k, now, self%has_slopes(group), evaluations)
        has_slopes(group) = .true.
      end if
      left = sample_t(self%t, sense*self%last(k), sense*self%last_rate(k))
      right = sample_t(t, sense*self%values(k), sense*self%rates(k))
      if (self%is_cubic(k)) then
        call top_of_cubic(left, right, top, is_bounded)
        if (is_bounded) call add_value(self, k, sense*top, self%angle)
        return
      end if
      if (.not. may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, known)) return
      call climb(k, sense, left, right)
    end subroutine search

    !> Search the peak between two points, perhaps from a value inside.
    subroutine climb(k, sense, left, right, inside)
      integer, intent(in) :: k
      real(dp), intent(in) :: sense
      type(sample_t), intent(in) :: left, right
      type(sample_t), intent(in), optional :: inside
      type(peak_search_t) :: peak
      real(dp) :: time
      logical :: is_done
      call peak%begin(left, right)
      if (present(inside)) call peak%add_value(inside%t, inside%value)
      do
        call peak%next_time(time, is_done)
        if (is_done) exit
        call look(self, method, scene, time, k, now, evaluations)
        call peak%add_value(time, sense*self%inside(k))
      end do
    end subroutine climb

    !> Search the peak of column k between the neighbours of its largest value of the interval, if it may exceed what is known. At
    !> an end of the interval, unless the three points there show that the column falls from it, the value a little inside decides
    !> whether there is one.
    subroutine search_samples(k, sense, known)
      integer, intent(in) :: k
      real(dp), intent(in) :: sense, known
      real(dp), parameter :: short = 1e-3_dp     !! part of the way to the neighbour
      real(dp) :: times(size(self%inner%t) + 2), v(size(self%inner%t) + 2), time, chord, bend
      type(sample_t) :: inside
      integer :: best, before, after, way   ! way: into the interval
      times = [self%t, self%inner%t, t]
      v = sense*[self%last(k), self%samples(k, :), self%values(k)]
      best = maxloc(v, 1)
      before = max(best - 1, 1)
      after = min(best + 1, size(v))
      if (.not. v(best) + max(v(best) - v(before), v(best) - v(after)) > known) return
      inside = sample_t(times(best), v(best), 0.0_dp)
      if (best == before .or. best == after) then
        way = after + before - 2*best
        chord = (v(best + way) - v(best))/(times(best + way) - times(best))
        bend = (v(best + 2*way) - v(best + way))/(times(best + 2*way) - times(best + way)) - chord
        if (way*(chord - bend*(times(best + way) - times(best))/(times(best + 2*way) - times(best))) < -abs(bend)) return
        time = times(best) + short*(times(best + way) - times(best))
        call look(self, method, scene, time, k, now, evaluations)
        inside = sample_t(time, sense*self%inside(k), 0.0_dp)
        if (.not. inside%value > v(best)) return
      end if
      call climb(k, sense, sample_t(times(before), v(before), 0.0_dp), sample_t(times(after), v(after), 0.0_dp), inside)
    end subroutine search_samples

    !> Account for the senses of column k in the interval, which it changes at most once inside.
    subroutine follow_sense(k)
      integer, intent(in) :: k
      integer :: first, last
      real(dp) :: root
      first = sense_of(self%last(k))
      last = sense_of(self%values(k))
      root = angle
      if (first*last < 0) root = angle_of_root(k, last)
      if (last == 0) root = self%angle
      call add_turn(k, first, abs(root - angle))
      call add_turn(k, last, abs(self%angle - root))
    end subroutine follow_sense

    subroutine add_turn(k, sense, turn)
      integer, intent(in) :: k, sense
      real(dp), intent(in) :: turn   !! of the crank under this sense [rad]
      if (sense == 0) return
      associate (known => self%present(k), i => merge(1, 2, sense > 0))
        if (self%sense(k)*sense < 0) known%number = known%number + 1
        known%turned(i) = known%turned(i) + turn
      end associate
      self%sense(k) = sense
    end subroutine add_turn

    !> Crank angle at which column k changes to a sense in the interval [rad].
    real(dp) function angle_of_root(k, sense) result(root)
      integer, intent(in) :: k, sense
      real(dp), parameter :: narrow_enough = 1e-2_dp   !! part of the interval: between these points the column is a straight line
      type(bracket_t) :: bracket
      real(dp) :: time, angles(2)
      bracket = bracket_t(self%t, t, sense*self%last(k), sense*self%values(k), width=t - self%t)
      angles = [angle, self%angle]
      do while (bracket%b - bracket%a > narrow_enough*(t - self%t))
        time = next_abscissa(bracket)
        if (.not. (time > bracket%a .and. time < bracket%b)) exit
        call look(self, method, scene, time, k, now, evaluations)
        angles(merge(1, 2, sense*self%inside(k) < 0)) = self%angle_inside
        call narrow(bracket, time, sense*self%inside(k))
      end do
      root = angles(1) + (angles(2) - angles(1))*bracket%fa/(bracket%fa - bracket%fb)
    end function angle_of_root
  end subroutine follow

  !> Evaluate the scene at the points of Gauss's rule, for means; `is_whole` is false if it is not defined in one.
  subroutine take_samples(self, method, scene, t, is_whole, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    logical, intent(out) :: is_whole
    integer, intent(inout) :: evaluations
    integer :: i
    call self%inner%evaluate(scene, method, t, evaluations)
    is_whole = self%inner%n > 0
    do i = 1, self%inner%n
      is_whole = is_whole .and. self%inner%in_domain(i)
      if (.not. self%inner%in_domain(i)) cycle
      call row_values(self%list, scene, self%inner%t(i), self%inner%now(i), self%inner%work(i), self%initial_energy, &
        self%samples(:, i))
      call add_values(self, self%samples(:, i), self%inner%now(i)%motion%crank_angle)
      associate (known => self%present(:size(self%is_sampled)), weight => self%inner%weight(i))
        where (self%is_sampled)
          known%sum = known%sum + weight*self%samples(:, i)
          known%square = known%square + weight*self%samples(:, i)**2
          known%duration = known%duration + weight
        end where
      end associate
    end do
  end subroutine take_samples

  !> Begin an interval at the beginning of the step, after an event at which rates have jumped.
  subroutine begin_anew(self, method, scene, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(in) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(inout) :: evaluations
    type(evaluation_t) :: now
    logical :: in_domain
    self%has_before = .false.
    self%has_slopes = .false.
    self%is_fresh = .false.
    evaluations = evaluations + 1
    call scene%evaluate(method%t_old, method%y_old, now, in_domain)
    if (.not. in_domain) return
    call row_values(self%list, scene, method%t_old, now, scene%work(method%y_old), self%initial_energy, self%last, self%last_rate)
    call add_values(self, self%last, now%motion%crank_angle)
  end subroutine begin_anew

  !> Slopes at both ends of the interval up to t of column k and of the others of contacts, or of no contact, whose rates are not
  !> known, from values a little inside.
  subroutine find_slopes(self, method, scene, t, k, now, has_left, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    integer, intent(in) :: k
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: has_left        !! those at its beginning are known, from the interval before
    integer, intent(inout) :: evaluations
    real(dp), parameter :: short = 3e-3_dp   !! part of the interval over which a slope is taken: over much less, the difference of
                                             !! the interpolant from the value at the end of a step would hide it
    real(dp) :: step
    logical :: is_looked_at(size(self%has_rate))
    step = short*(t - self%t)
    is_looked_at = .not. self%has_rate .and. (self%is_of_contact .eqv. self%is_of_contact(k))
    if (.not. has_left) then
      call look(self, method, scene, self%t + step, k, now, evaluations)
      where (is_looked_at) self%last_rate = (self%inside - self%last)/step
    end if
    call look(self, method, scene, t - step, k, now, evaluations)
    where (is_looked_at) self%rates = (self%values - self%inside)/step
  end subroutine find_slopes

  !> Find the values of column k at a time inside the step, and those of others that cost no more; outside the model they are those
  !> at the end of the interval. Values of contacts follow from the state alone.
  subroutine look(self, method, scene, time, k, at_end, evaluations)
    class(ledger_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: time
    integer, intent(in) :: k
    type(evaluation_t), intent(in) :: at_end     !! of the interval
    integer, intent(inout) :: evaluations
    type(evaluation_t) :: there
    real(dp) :: y(scene%n)
    logical :: in_domain
    integer :: i
    self%inside = self%values
    self%angle_inside = at_end%motion%crank_angle
    if (self%is_of_contact(k)) then
      there = at_end
      call look_at_contacts(scene, method, time, there)
      call take(self%of_contact, self%contact_at, 0.0_dp)
    else
      call evaluate_inside(scene, method, time, y, there, in_domain, evaluations)
      if (.not. in_domain) return
      if (self%is_sampled(k)) then
        call take(self%list, [(i, i=1, size(self%last))], scene%work(y))
      else
        call take(self%cheap, self%cheap_at, scene%work(y))
      end if
    end if

  contains

    subroutine take(list, at, work)
      type(column_list_t), intent(in) :: list
      integer, intent(in) :: at(:)
      real(dp), intent(in) :: work
      call row_values(list, scene, time, there, work, self%initial_energy, self%row(:size(at)))
      self%angle_inside = there%motion%crank_angle
      do i = 1, size(at)
        self%inside(at(i)) = self%row(i)
        call add_value(self, at(i), self%row(i), self%angle_inside)
      end do
    end subroutine take
  end subroutine look

  !> End the present revolution; the next one begins with the values at its end.
  pure subroutine end_revolution(self, number)
    class(ledger_t), intent(inout) :: self
    integer, intent(in) :: number   !! of the revolution that ends
    self%recent(:, mod(number, longest_period)) = self%present
    self%whole = self%whole + self%present
    self%present = fold_t()
    call add_values(self, self%last, self%angle)
  end subroutine end_revolution

  !> The results over the run, and over its last cycle of some revolutions up to one with a number; 0 revolutions: it has none.
  function results(self, number, revolutions) result(list)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: number, revolutions
    type(kept_result_t), allocatable :: list(:)
    type(fold_t) :: known(size(self%present))
    integer :: i, n
    allocate (list(3*size(self%kept)))
    n = 0
    known = self%whole + self%present
    do i = 1, size(self%kept)
      if (self%kept(i)%told /= of_cycle) call add('')
    end do
    if (revolutions > 0) known = cycle_of(self, number, revolutions)
    do i = 1, size(self%kept)
      if (revolutions > 0 .and. self%kept(i)%told /= of_run) call add('cycle_')
    end do
    list = list(:n)

  contains

    subroutine add(prefix)
      character(len=*), intent(in) :: prefix
      associate (kept => self%kept(i))
        if (.not. (known(self%at(i))%most(1) > -huge(1.0_dp) .or. kept%at_impacts)) return   ! the run had no state in the model
        n = n + 1
        list(n) = kept_result_t(kept%place, prefix//trim(kept%name), kept%unit, prefix /= '', found(kept, known(self%at(i))))
        if (prefix == '' .or. .not. kept%has_angle .or. kept%at_impacts .and. known(self%at(i))%number == 0) return
        n = n + 1
        list(n) = kept_result_t(kept%place, prefix//trim(kept%name)//'_angle', 'deg', .true., &
          degrees_in_cycle(known(self%at(i))%angle(merge(2, 1, kept%what == least)), revolutions))
      end associate
    end subroutine add
  end function results

  !> A result of a list; 0 and not known if the list does not have it.
  pure subroutine find_result(list, name, value, is_known)
    type(kept_result_t), intent(in) :: list(:)
    character(len=*), intent(in) :: name   !! with the prefix of its place
    real(dp), intent(out) :: value
    logical, intent(out) :: is_known
    integer :: i
    value = 0
    is_known = .false.
    do i = 1, size(list)
      if (trim(list(i)%place)//list(i)%name /= name) cycle
      value = list(i)%value
      is_known = .true.
      return
    end do
  end subroutine find_result

  !> A crank angle [rad] in degrees, from 0 to the length of a cycle of some revolutions.
  pure real(dp) function degrees_in_cycle(angle, revolutions)
    real(dp), intent(in) :: angle
    integer, intent(in) :: revolutions
    degrees_in_cycle = modulo(angle, two_pi*revolutions)/degree
  end function degrees_in_cycle

  !> Index of a result; 0 if the scene does not have it.
  pure integer function index_of(self, name)
    class(ledger_t), intent(in) :: self
    character(len=*), intent(in) :: name   !! with the prefix of its place, without `cycle_`
    do index_of = size(self%kept), 1, -1
      if (trim(self%kept(index_of)%place)//self%kept(index_of)%name == name) return
    end do
  end function index_of

  !> A result of the present revolution; 0 if the scene does not have it.
  pure real(dp) function of_revolution(self, name) result(value)
    class(ledger_t), intent(in) :: self
    character(len=*), intent(in) :: name   !! see `index_of`
    integer :: i
    i = index_of(self, name)
    value = 0
    if (i > 0) value = found(self%kept(i), self%present(self%at(i)))
  end function of_revolution

  !> A result of the run so far; 0 if the scene does not have it.
  pure real(dp) function of_whole_run(self, name) result(value)
    class(ledger_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer :: i
    i = index_of(self, name)
    value = 0
    if (i > 0) value = found(self%kept(i), self%whole(self%at(i)) + self%present(self%at(i)))
  end function of_whole_run

  !> A result of the last cycle of some revolutions up to one with a number; 0 if the scene does not have it.
  pure real(dp) function over_cycle(self, name, number, revolutions) result(value)
    class(ledger_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: number, revolutions
    type(fold_t) :: known(size(self%present))
    integer :: i
    i = index_of(self, name)
    value = 0
    if (i == 0) return
    known = cycle_of(self, number, revolutions)
    value = found(self%kept(i), known(self%at(i)))
  end function over_cycle

  !> What is known of the columns in a cycle of some revolutions up to one with a number.
  pure function cycle_of(self, number, revolutions) result(known)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: number, revolutions
    type(fold_t) :: known(size(self%present))
    integer :: k
    known = fold_t()
    do k = number - revolutions + 1, number
      known = known + self%recent(:, mod(k, longest_period))
    end do
  end function cycle_of
end module result_ledger
