!> A row of a trace. Each owner of a quantity passes name, value and meaning of its column in one call.
!>
!> The same calls are used in two passes. Before a run they collect names and meanings of the columns of a scene; for every row they
!> pass the values. Values that are expensive are computed only if the trace has a column for them (`wants`).
!>
!> What the results of a run keep of a column is said beside it, by `keep`: an extreme, over the run and over its last cycle. The
!> ledger of a run follows these columns (`result_ledger`).
module trace_row
  use kinds, only: dp
  implicit none
  private
  public :: trace_row_t, column_list_t, kept_t, name_length, most_columns
  public :: least, largest, largest_size, spread, mean, root_mean_square, integral, changes, reversed, reversed_angle, impacts
  public :: everywhere, of_run, of_cycle

  integer, parameter :: name_length = 48
  integer, parameter :: meaning_length = 160
  integer, parameter :: most_columns = 1400

  !> What is kept of a column: an extreme, that of its size, the spread, the mean, that of squares or the integral over the time;
  !> how often its sense changes, the largest value in the sense opposite to that of the largest size, and the crank angle in that
  !> sense; or the number of contacts.
  integer, parameter :: least = 1, largest = 2, largest_size = 3, mean = 4, integral = 5, changes = 6, reversed = 7, &
    reversed_angle = 8, impacts = 9, spread = 10, root_mean_square = 11

  integer, parameter :: everywhere = 0, of_run = 1, of_cycle = 2   !! where it is told: over the run and its last cycle, or over one

  !> A result that is kept of a column.
  type :: kept_t
    character(len=16) :: place = ''                !! prefix of its name
    character(len=name_length) :: name = ''        !! that over the run; with `cycle_` before it that over the last cycle
    character(len=meaning_length) :: meaning = ''
    integer :: what = 0                            !! least, largest, ...
    integer :: column = 0                          !! its index among all columns of the scene
    integer :: told = everywhere
    character(len=name_length) :: unit = ''        !! that of the column, unless `keep` gives it
    logical :: has_rate = .false.                  !! the rate of the column is known
    logical :: is_cubic = .false.                  !! inside a step it is the cubic through values and rates
    logical :: is_of_contact = .false.             !! it follows from the state alone, and events tell it of each contact
    logical :: is_sampled = .false.                !! it is found at the points of Gauss's rule of each step
    logical :: at_impacts = .false.                !! of its values where a contact at the place begins, alone
    logical :: has_angle = .false.                 !! of the last cycle, the crank angle of the extreme is told
  end type kept_t

  !> The columns of one trace.
  type :: column_list_t
    character(len=name_length), allocatable :: names(:)   !! of all columns of the scene, with units
    character(len=meaning_length), allocatable :: meanings(:)
    logical, allocatable :: on_request(:)                 !! columns that are not standard
    integer, allocatable :: id(:)                         !! columns of the trace, as indices into the names
    type(kept_t), allocatable :: kept(:)                  !! of the columns of the scene
    type(kept_t), allocatable :: asked(:)                 !! what a study asks to keep besides, if anything
  end type column_list_t

  !> A row, begun by `collect_names` or `choose`. No component has an initial value: with one, every new row would be filled by a
  !> copy of all components.
  type :: trace_row_t
    integer :: n                                !! number of columns so far
    integer :: last                             !! last column that is in the trace
    logical :: is_naming                        !! names are being collected
    character(len=16) :: place                  !! prefix of the following names, separated by an underscore
    logical :: wanted(most_columns)             !! columns whose values are in the trace
    real(dp) :: values(most_columns)            !! values of the columns so far
    real(dp) :: rates(most_columns)             !! their rates, where they are known
    character(len=name_length), allocatable :: names(:)   !! while names are collected
    character(len=meaning_length), allocatable :: meanings(:)   !! while names are collected
    logical, allocatable :: on_request(:)       !! while names are collected: columns that are not standard
    type(kept_t), allocatable :: kept(:)        !! while names are collected
  contains
    procedure, non_overridable :: keep
    procedure, non_overridable :: add
    procedure, non_overridable :: add_on_request
    procedure, non_overridable :: skip
    procedure, non_overridable :: wants
    procedure, non_overridable :: is_full
    procedure, non_overridable :: collect_names
    procedure, non_overridable :: choose
  end type trace_row_t

contains

  !> Begin to collect names.
  subroutine collect_names(self)
    class(trace_row_t), intent(inout) :: self
    self%n = 0
    self%is_naming = .true.
    self%last = most_columns
    self%place = ''
    self%wanted = .false.
    allocate (self%names(most_columns), self%meanings(most_columns))
    allocate (self%on_request(most_columns), source=.false.)
    allocate (self%kept(0))
  end subroutine collect_names

  !> Begin a row of the trace.
  pure subroutine choose(self, list)
    class(trace_row_t), intent(inout) :: self
    type(column_list_t), intent(in) :: list
    integer :: i
    self%n = 0
    self%is_naming = .false.
    self%place = ''
    self%last = maxval(list%id)
    self%wanted(:size(list%names)) = .false.
    do i = 1, size(list%id)
      self%wanted(list%id(i)) = .true.
    end do
  end subroutine choose

  !> Add the next column.
  pure subroutine add(self, name, value, says)
    class(trace_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name    !! with its unit: normal_force[N]
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: says    !! meaning and sign, for the manual
    self%n = self%n + 1
    if (self%is_naming) then
      self%names(self%n) = trim(self%place)//name
      self%meanings(self%n) = says
    else
      self%values(self%n) = value
    end if
  end subroutine add

  !> Add the next column, which a trace has only if the case names it.
  pure subroutine add_on_request(self, name, value, says)
    class(trace_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    real(dp), intent(in) :: value
    call self%add(name, value, says)
    if (self%is_naming) self%on_request(self%n) = .true.
  end subroutine add_on_request

  !> Keep a result of the column that was just added. With its rate, which must be that of the column at every instant, and 0
  !> while names are collected, peaks inside a step are searched with fewer evaluations, and with `is_cubic` with none.
  pure subroutine keep(self, name, what, says, rate, told, unit, is_cubic, is_of_contact, is_sampled, at_impacts, has_angle)
    class(trace_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name   !! of the result
    integer, intent(in) :: what            !! least, largest, ...
    character(len=*), intent(in) :: says   !! its meaning
    real(dp), intent(in), optional :: rate
    integer, intent(in), optional :: told  !! everywhere, of_run or of_cycle
    character(len=*), intent(in), optional :: unit   !! of a result that does not have that of its column
    logical, intent(in), optional :: is_cubic, is_of_contact, is_sampled, at_impacts, has_angle   !! see `kept_t`
    if (.not. self%is_naming) then   ! of a row, which makes no record: there are many
      if (present(rate)) self%rates(self%n) = rate
      return
    end if
    self%kept = [self%kept, kept_t(self%place, name, says, what, self%n)]
    associate (kept => self%kept(size(self%kept)), column => self%names(self%n))
      kept%unit = column(index(column, '[') + 1:index(column, ']') - 1)
      if (kept%unit == '-') kept%unit = '1'
      if (present(unit)) kept%unit = unit
      if (present(told)) kept%told = told
      kept%has_rate = present(rate)
      if (present(is_cubic)) kept%is_cubic = is_cubic
      if (present(is_of_contact)) kept%is_of_contact = is_of_contact
      if (present(is_sampled)) kept%is_sampled = is_sampled
      if (present(at_impacts)) kept%at_impacts = at_impacts
      if (present(has_angle)) kept%has_angle = has_angle
    end associate
  end subroutine keep

  !> Whether no further column is in the trace.
  pure logical function is_full(self)
    class(trace_row_t), intent(in) :: self
    is_full = self%n >= self%last
  end function is_full

  !> Skip the next `count` columns, none of which is in the trace. Must not be called while names are collected.
  pure subroutine skip(self, count)
    class(trace_row_t), intent(inout) :: self
    integer, intent(in) :: count
    self%n = self%n + count
  end subroutine skip

  !> Whether one of the next `count` columns is in the trace; false while names are collected.
  pure logical function wants(self, count)
    class(trace_row_t), intent(in) :: self
    integer, intent(in) :: count
    wants = any(self%wanted(self%n + 1:self%n + count))
  end function wants
end module trace_row
