!> A sink that stores rows and events in memory, and a procedure that runs a case file with it.
module collecting_sink
  use kinds, only: dp
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use trace_columns, only: column_list_t, choose_columns, column_name
  use simulation, only: simulate, run_report_t
  use row_store, only: row_store_t
  use trace_sink, only: trace_event_t
  use joint_places, only: places
  use data_tables, only: load_table
  implicit none
  private
  public :: collecting_sink_t, trace_t, run_case, load_trace, column, values_of, last_row_time

  type, extends(row_store_t) :: collecting_sink_t
  end type collecting_sink_t

  !> A trace with the names of its columns.
  type :: trace_t
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: values(:, :)           !! (columns, rows)
    type(trace_event_t), allocatable :: event(:)
    type(run_report_t) :: report
    type(error_t), allocatable :: error
  end type trace_t

contains

  !> Run cases/FILE with overrides.
  function run_case(file, overrides, ideal_joint) result(trace)
    character(len=*), intent(in) :: file, overrides(:)
    logical, intent(in), optional :: ideal_joint
    type(trace_t) :: trace
    type(case_t) :: case
    type(column_list_t) :: list
    type(collecting_sink_t) :: sink
    type(error_t), allocatable :: error
    logical :: ideal
    integer :: i

    ideal = .false.
    if (present(ideal_joint)) ideal = ideal_joint
    call read_case(file, overrides, case, error)
    if (.not. allocated(error)) call choose_columns(case, ideal, list, error)
    if (allocated(error)) then
      call move_alloc(error, trace%error)
      return
    end if
    call simulate(case, ideal, list, sink, trace%report, trace%error)
    allocate (trace%names(size(list%id)))
    do i = 1, size(list%id)
      trace%names(i) = column_name(list, i)
    end do
    call sink%hand_over(size(list%id), trace%values, trace%event)
  end function run_case

  !> Read a reference curve and its events.
  function load_trace(name) result(trace)
    character(len=*), intent(in) :: name
    type(trace_t) :: trace
    character(len=2000) :: line
    character(len=40) :: label, joint
    integer :: unit, status, rows

    call load_table(name//'.csv', trace%names, trace%values)
    open (newunit=unit, file='data/'//name//'.events.csv', status='old', action='read')
    read (unit, '(a)') line
    allocate (trace%event(1000))
    rows = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      line = trim(line)//',piston_pin'   ! if the file has no column for the joint
      read (line, *) trace%event(rows + 1)%time, label, trace%event(rows + 1)%normal_speed, joint
      rows = rows + 1
      trace%event(rows)%kind = merge(1, 2, label == 'contact_begins')
      trace%event(rows)%pin = findloc(places%name, joint, 1)
    end do
    close (unit)
    trace%event = trace%event(:rows)
  end function load_trace

  !> The position of a named column, 0 if it does not exist.
  pure integer function column(trace, name)
    type(trace_t), intent(in) :: trace
    character(len=*), intent(in) :: name
    integer :: i
    column = 0
    do i = 1, size(trace%names)
      if (trace%names(i) == name) column = i
    end do
  end function column

  !> Values of a column of a trace.
  pure function values_of(trace, name) result(values)
    type(trace_t), intent(in) :: trace
    character(len=*), intent(in) :: name   !! with its unit
    real(dp) :: values(size(trace%values, 2))
    values = trace%values(column(trace, name), :)
  end function values_of

  pure real(dp) function last_row_time(trace)
    type(trace_t), intent(in) :: trace
    last_row_time = trace%values(1, size(trace%values, 2))
  end function last_row_time
end module collecting_sink
