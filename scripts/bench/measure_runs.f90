!> Measures the time of the runs of a study alone: `measure_runs STUDY.nml [watched]` simulates them one after the other in one
!> process. The cases are built before the measurement; there are no files and no rows. With `watched` the statistics of revolutions
!> are computed. Prints the number of runs, the evaluations, and the seconds of processor time and of wall time.
program measure_runs
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_values, only: case_values_t
  use case_file, only: read_case_values
  use trace_columns, only: column_list_t
  use cycle_watch, only: cycle_watch_t
  use simulation, only: simulate, run_report_t
  use trace_sink, only: trace_sink_t
  use study_definition, only: study_t
  use study_file, only: read_study
  use study_design, only: study_design_t, new_design
  use study_case, only: study_case_t
  implicit none
  type(study_t) :: study
  type(study_design_t) :: design
  type(study_case_t) :: base
  type(case_values_t) :: values
  type(case_t), allocatable :: cases(:)
  type(error_t), allocatable :: error
  type(column_list_t) :: no_rows
  type(trace_sink_t) :: sink   ! ignores everything
  type(cycle_watch_t), allocatable :: watch
  type(run_report_t) :: report
  character(len=400) :: argument
  integer(int64) :: began, ended, rate, evaluations
  real(dp) :: cpu_began, cpu_ended
  character(len=60) :: overrides(2)
  logical :: is_watched
  integer :: i

  call get_command_argument(1, argument)
  call read_study(trim(argument), study, error)
  overrides = [character(len=60) :: 'integrator.method=auto', 'integrator.relative_tolerance=1e-4']
  if (.not. allocated(error)) call read_case_values(study%case, overrides, values, error)
  if (.not. allocated(error)) call new_design(study, 10, design, error)
  if (.not. allocated(error)) call base%prepare(values, study%case, design%keys, error)
  if (allocated(error)) error stop 'measure_runs: no such study'
  allocate (cases(design%runs))
  call make_cases(design, base, cases)
  call get_command_argument(2, argument)
  is_watched = argument == 'watched'
  allocate (no_rows%id(0))
  allocate (watch)
  evaluations = 0
  call system_clock(began, rate)
  call cpu_time(cpu_began)
  do i = 1, design%runs
    if (is_watched) then
      call simulate(cases(i), .false., no_rows, sink, report, error, cycles=watch)
    else
      call simulate(cases(i), .false., no_rows, sink, report, error)
    end if
    evaluations = evaluations + report%statistics%evaluations
  end do
  call cpu_time(cpu_ended)
  call system_clock(ended)
  print '(a)', 'runs,evaluations,cpu_seconds,seconds'
  print '(i0,a,i0,a,f0.4,a,f0.4)', design%runs, ',', evaluations, ',', cpu_ended - cpu_began, ',', &
    real(ended - began, dp)/real(rate, dp)

contains

  !> The case of every run.
  subroutine make_cases(design, base, cases)
    type(study_design_t), intent(in) :: design
    type(study_case_t), intent(inout) :: base
    type(case_t), intent(out) :: cases(:)
    character(len=design%text_length) :: texts(size(design%keys))
    type(error_t), allocatable :: error
    integer :: run
    do run = 1, design%runs
      call design%get_values(run, texts)
      call base%set_values(texts, error)
      if (.not. allocated(error)) call base%check(error)
      if (allocated(error)) error stop 'measure_runs: a run is not valid'
      cases(run) = base%case
    end do
  end subroutine make_cases
end program measure_runs
