!> A row of a trace: who has a quantity gives its column, name, value and meaning, in one call.
!>
!> The same calls serve two passes. Before a run they collect the names and meanings of the columns that a scene has; in every row
!> they give the values. Values that take work are computed only where the trace has a column that needs them (`wants`).
module trace_row
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: trace_row_t, column_list_t, name_length, meaning_length, most_columns

  integer, parameter :: name_length = 40
  integer, parameter :: meaning_length = 160
  integer, parameter :: most_columns = 160

  !> The columns of one trace.
  type :: column_list_t
    character(len=name_length), allocatable :: names(:)   !! of all that the scene has, with their units
    character(len=meaning_length), allocatable :: meanings(:)
    logical, allocatable :: on_request(:)                 !! columns that are not standard
    integer, allocatable :: id(:)                         !! those of the trace, as positions among the names
  end type column_list_t

  type :: trace_row_t
    integer :: n = 0                            !! columns so far
    logical :: is_naming = .false.              !! this pass collects names
    character(len=12) :: place = ''             !! in front of the names that follow, with an underscore behind
    logical :: wanted(most_columns)             !! columns whose values the trace has
    real(dp) :: values(most_columns)            !! of the columns so far (without an initial value, which every row would pay for)
    character(len=name_length), allocatable :: names(:)   !! in the pass that collects them
    character(len=meaning_length), allocatable :: meanings(:)   !! in that pass
    logical, allocatable :: on_request(:)       !! in that pass: columns that are not standard
  contains
    procedure, non_overridable :: put
    procedure, non_overridable :: put_on_request
    procedure, non_overridable :: skip
    procedure, non_overridable :: wants
    procedure, non_overridable :: collect_names
    procedure, non_overridable :: choose
  end type trace_row_t

contains

  !> Begin the pass that collects names.
  subroutine collect_names(self)
    class(trace_row_t), intent(inout) :: self
    self%n = 0
    self%is_naming = .true.
    self%wanted = .false.
    allocate (self%names(most_columns), self%meanings(most_columns))
    allocate (self%on_request(most_columns), source=.false.)
  end subroutine collect_names

  !> Begin a row of the trace.
  pure subroutine choose(self, list)
    class(trace_row_t), intent(inout) :: self
    type(column_list_t), intent(in) :: list
    integer :: i
    self%n = 0
    self%wanted = .false.
    do i = 1, size(list%id)
      self%wanted(list%id(i)) = .true.
    end do
  end subroutine choose

  !> The next column.
  pure subroutine put(self, name, value, says)
    class(trace_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name    !! with its unit: normal_force[N]
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: says    !! its meaning and sign, as the manual gives them
    self%n = self%n + 1
    if (self%is_naming) then
      self%names(self%n) = trim(self%place)//name
      self%meanings(self%n) = says
    else
      self%values(self%n) = value
    end if
  end subroutine put

  !> The next column, which a trace has only if the case names it.
  pure subroutine put_on_request(self, name, value, says)
    class(trace_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    real(dp), intent(in) :: value
    call self%put(name, value, says)
    if (self%is_naming) self%on_request(self%n) = .true.
  end subroutine put_on_request

  !> Pass over the next `count` columns, none of which is in the trace. Not while names are collected.
  pure subroutine skip(self, count)
    class(trace_row_t), intent(inout) :: self
    integer, intent(in) :: count
    self%n = self%n + count
  end subroutine skip

  !> Whether one of the next `count` columns is in the trace. While names are collected none is.
  pure logical function wants(self, count)
    class(trace_row_t), intent(in) :: self
    integer, intent(in) :: count
    wants = any(self%wanted(self%n + 1:self%n + count))
  end function wants
end module trace_row
