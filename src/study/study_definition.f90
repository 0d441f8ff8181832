!> The data of a parameter study: a base case, the parameters that are varied, and the results that are wanted.
module study_definition
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use case_schema, only: schema_t, key_table_t
  implicit none
  private
  public :: study_t, parameter_t, text_t, study_schema_of

  !> A text with a length of its own.
  type :: text_t
    character(len=:), allocatable :: text
  end type text_t

  !> One key that is varied, over a range or a list.
  type, extends(has_parameters_t) :: parameter_t
    character(len=:), allocatable :: key      !! GROUP.KEY
    real(dp) :: from = 0, to = 0
    integer :: count = 0                      !! number of values of the range in a grid
    character(len=:), allocatable :: scale    !! spacing of the values: linear, log
    character(len=:), allocatable :: values   !! list of values, separated by commas
    type(text_t), allocatable :: list(:)      !! the values of that list; empty: a range
    integer :: key_line = 0, values_line = 0  !! of the file
  contains
    procedure :: parameters => parameters_of_parameter
    procedure :: levels
  end type parameter_t

  type, extends(has_parameters_t) :: study_t
    character(len=:), allocatable :: name, file     !! NAME of its results; path as given by the user
    character(len=:), allocatable :: title
    character(len=:), allocatable :: case           !! path of the base case
    character(len=:), allocatable :: table          !! path of a table of runs; empty: a grid over parameters
    integer :: settle_cycles = 0                    !! number of revolutions at the start that are left out of the statistics
    character(len=:), allocatable :: start          !! of each run: 'case', or 'previous'
    character(len=:), allocatable :: traces
    logical :: cycles = .false.                     !! write the statistics of every revolution too
    real(dp) :: strobe_angle_deg = 0
    character(len=:), allocatable :: strobe_columns !! columns sampled once per revolution; empty: none
    character(len=:), allocatable :: statistics     !! of columns, and results by name, separated by commas; empty: none
    integer :: strobe_cycles = 0                    !! number of samples in a run; 0: no limit
    type(parameter_t), allocatable :: varied(:)
    character(len=:), allocatable :: resolved       !! study file with all defaults, which gives the same study
    character(len=:), allocatable :: identity       !! the same without title and paths
  contains
    procedure :: parameters => parameters_of_study
  end type study_t

contains

  !> Groups and keys of a study file.
  subroutine study_schema_of(table)
    type(key_table_t), intent(out) :: table
    type(schema_t) :: schema
    type(study_t) :: study
    type(parameter_t) :: parameter
    call schema%begin()
    call schema%group('study', 'A base case that is run many times. The case itself must be correct', .true.)
    call study%parameters(schema)
    call schema%group('parameter', &
      'One key that is varied. Give one group for each key; the runs are a grid, in which the last one changes fastest', .true.)
    call parameter%parameters(schema)
    call schema%get_table(table)
  end subroutine study_schema_of

  subroutine parameters_of_study(self, list)
    class(study_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%text('title', self%title, 'title of the study', '')
    call list%text('case', self%case, 'base case, path relative to the study file', example='sim_I.nml')
    call list%text('table', self%table, &
      'CSV file with a column for each key and a row for each run, instead of &parameter; path relative to the study file', '')
    call list%add('settle_cycles', self%settle_cycles, &
      'crank revolutions at the start that are left out of the statistics', '>= 0', '0')
    call list%word('start', self%start, 'case, previous', 'case', &
      'case: each run starts as its case says; previous: with the motion at the end of the run before it, at t = 0')
    call list%word('traces', self%traces, 'none, all, failed', 'none', 'runs whose trace is written to NAME/RUN.csv')
    call list%add('cycles', self%cycles, 'also write the statistics of each revolution to NAME.cycles.csv', '.false.')
    call list%text('statistics', self%statistics, &
      'statistics of any columns over the last cycle: min, max, max abs, range, mean or rms; and numbers of a summary by name; '// &
      'e.g. ''max abs guide_force, cycle_slap_speed''', &
      '', .true.)
    call list%add('strobe_angle_deg', self%strobe_angle_deg, &
      'crank angle at which the strobe columns are recorded, once in each revolution', 'degrees', default='0.0')
    call list%text('strobe_columns', self%strobe_columns, 'columns of NAME.strobe.csv; empty: the file is not written', '', .true.)
    call list%add('strobe_cycles', self%strobe_cycles, &
      'number of strobe rows of a run, after settle_cycles; 0: until its end', '>= 0', '0')
  end subroutine parameters_of_study

  !> Number of values in a grid.
  pure integer function levels(self)
    class(parameter_t), intent(in) :: self
    levels = merge(size(self%list), self%count, size(self%list) > 0)
  end function levels

  subroutine parameters_of_parameter(self, list)
    class(parameter_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%text('key', self%key, 'GROUP.KEY that is varied', example='joint.clearance')
    call list%add('from', self%from, 'first value of the range', default='0.0', example='1.0e-5')
    call list%add('to', self%to, 'last value of the range', default='0.0', example='5.0e-5')
    call list%add('count', self%count, 'number of values', '>= 2 and <= 10000000', '0', '5')
    call list%word('scale', self%scale, 'linear, log', 'linear', 'scale in which the values are equidistant')
    call list%text('values', self%values, 'list of values separated by commas, instead of from, to and count', '', .true.)
  end subroutine parameters_of_parameter
end module study_definition
