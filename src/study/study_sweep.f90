!> A study that has been read and checked.
module study_sweep
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t, fail, status_command_line, status_case_file, status_integration
  use text_tools, only: printable, integer_text, counted, lowercase
  use checksums, only: checksum_t
  use number_text, only: short_text
  use scene_builder, only: simulated_time
  use version_number, only: program_version
  use study_statistics, only: statistic_t, read_statistics
  use trace_columns, only: column_list_t, choose_columns
  use case_definition, only: case_t
  use case_file, only: read_case_values
  use case_text, only: resolved_text
  use case_values, only: case_values_t
  use case_schema, only: without_number
  use accuracy_presets, only: with_preset
  use command_line, only: command_line_t
  use study_definition, only: study_t
  use study_file, only: read_study
  use study_design, only: study_design_t, new_design
  use study_case, only: study_case_t
  use posix_files, only: absolute_path
  implicit none
  private
  public :: sweep_t, read_sweep, check_rows, study_checksum

  real(dp), parameter :: rounding = 1e-6_dp      !! of a number of revolutions that end_time gives
  integer, parameter :: most_checked = 100000   !! largest number of runs of a design that a check tests

  !> A study with its design and its base case.
  type :: sweep_t
    type(study_t) :: study
    type(study_design_t) :: design
    type(study_case_t) :: base
    type(column_list_t) :: strobe_list
    type(statistic_t), allocatable :: statistics(:)
    character(len=:), allocatable :: path          !! of the results, without suffix
    integer :: first = 1, last = 0                 !! range of runs that are to be carried out
    logical :: has_strobes = .false.
  end type sweep_t

contains

  !> Read study, base case and design, and check them against each other.
  subroutine read_sweep(path, options, sweep, error)
    character(len=*), intent(in) :: path
    type(command_line_t), intent(in) :: options
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    type(case_values_t) :: values
    type(case_t) :: case
    character(len=:), allocatable :: at
    integer, allocatable :: lines(:)   ! of the keys that are varied
    integer :: i

    call read_study(path, sweep%study, error)
    if (allocated(error)) return
    call read_case_values(sweep%study%case, with_preset(options%accuracy, options%overrides), values, error)
    if (.not. allocated(error)) call values%problems%report(error)
    if (allocated(error)) then
      error%message = printable(path, 200)//': &study case: '//error%message
      return
    end if
    sweep%path = options%out//'/'//sweep%study%name
    associate (study => sweep%study, design => sweep%design)
      call new_design(study, values%values(values%place_of('output', 'digits'))%whole, design, error)
      if (allocated(error)) return
      call refuse_varied(with_preset(options%accuracy, options%overrides), options, values, design%keys, error)
      if (allocated(error)) return
      at = printable(path, 200)//': '
      if (study%table == '') then
        lines = study%varied%key_line
        call sweep%base%prepare(values, study%case, design%keys, error, printable(path, 200), lines)
      else
        lines = [(1, i=1, size(design%keys))]
        call sweep%base%prepare(values, study%case, design%keys, error, printable(study%table, 200), lines)
      end if
      if (allocated(error)) return
      if (study%traces == 'none') then   ! no run writes what these ask for; a run may end before them
        sweep%base%case%output%start_time = 0
        sweep%base%case%output%film_times = ''
      end if
      design%is_whole = sweep%base%is_whole
      do i = 1, size(study%varied)
        if (size(study%varied(i)%list) > 0 .or. sweep%base%is_number(i)) cycle
        call fail(error, printable(path, 200)//':'//integer_text(lines(i))//': &parameter key = '''//trim(design%keys(i))// &
          ''': has no range; give values', status_case_file)
        return
      end do
      call check_values(sweep, error)
      if (.not. allocated(error)) call refuse_too_short(sweep, error)
      if (allocated(error)) return
      call choose_rows(options, at, sweep, error)
      if (allocated(error)) return
      if (study%strobe_columns == '') then
        allocate (sweep%strobe_list%id(0))
      else
        case = sweep%base%case
        case%output%columns = study%strobe_columns
        call choose_columns(case, .false., sweep%strobe_list, error)
        if (allocated(error)) error%message = at//'strobe_columns: '//error%message
      end if
      if (allocated(error)) return
      call read_statistics(study%statistics, sweep%base%case, sweep%statistics, error)
      if (allocated(error)) error%message = at//'&study statistics = '//error%message
      if (.not. allocated(error)) call keep_inputs(sweep, error)
      sweep%has_strobes = study%strobe_columns /= ''
    end associate
  end subroutine read_sweep

  !> Refuse a study whose runs all end before their statistics begin: the crank is held at its speed, no parameter changes that or
  !> the length of a run, and `settle_cycles` leaves no whole revolution of it.
  subroutine refuse_too_short(sweep, error)
    type(sweep_t), intent(in) :: sweep
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: groups(*) = [character(len=11) :: 'integrator.', 'initial.', 'drive.', 'run.']
    real(dp) :: revolutions
    integer :: i, k
    associate (case => sweep%base%case, settle => sweep%study%settle_cycles)
      if (case%drive%kind /= 'constant_speed') return
      do i = 1, size(groups)
        if (any([(index(sweep%design%keys(k), trim(groups(i))) == 1, k=1, size(sweep%design%keys))])) return
      end do
      revolutions = simulated_time(case)*abs(case%initial%crank_speed)/two_pi
      if (revolutions > settle + 1 - rounding .or. settle == 0) return
      call fail(error, printable(sweep%study%file, 200)//': &study settle_cycles = '//integer_text(settle)//': the case makes '// &
        short_text(revolutions)//' revolutions, no whole one is left: more &integrator revolutions in '// &
        printable(sweep%study%case, 200), status_case_file)
    end associate
  end subroutine refuse_too_short

  !> The runs that are wanted: all, or those of --rows.
  subroutine choose_rows(options, at, sweep, error)
    type(command_line_t), intent(in) :: options
    character(len=*), intent(in) :: at   !! place of a problem
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    sweep%last = sweep%design%runs
    if (options%last_row == 0) return
    if (options%last_row > sweep%last) then
      call fail(error, at//'--rows '//integer_text(options%first_row)//':'//integer_text(options%last_row)// &
                ': the study has '//integer_text(sweep%last)//' runs', status_case_file)
    else if (sweep%study%start == 'previous') then
      call fail(error, at//'--rows: with &study start = ''previous'' each run follows the one before it', status_case_file)
    end if
    sweep%first = options%first_row
    sweep%last = options%last_row
  end subroutine choose_rows

  !> Check that the results do not replace a file that the study reads, such as the table x.runs.csv of the study x.nml.
  subroutine keep_inputs(sweep, error)
    type(sweep_t), intent(in) :: sweep
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: suffixes(*) = [character(len=11) :: '.runs.csv', '.cycles.csv', '.strobe.csv', '.study.nml']
    character(len=:), allocatable :: written
    integer :: i
    do i = 1, size(suffixes)
      written = absolute_path(sweep%path//trim(suffixes(i)))
      call refuse('&study case', absolute_path(sweep%study%case))
      call refuse('&study table', absolute_path(sweep%study%table))
      associate (case => sweep%base%case)
        if (allocated(case%drive%table%path)) call refuse('&drive torque_table', case%drive%table%path)
        if (allocated(case%measured)) call refuse('&cylinder_pressure table', case%measured%curve%path)
        if (allocated(case%load)) then
          if (allocated(case%load%curve%path)) call refuse('&bearing_load table', case%load%curve%path)
        end if
        if (allocated(case%guide)) then
          if (allocated(case%guide%profile%path)) call refuse('&guide profile_table', case%guide%profile%path)
        end if
      end associate
    end do

  contains

    subroutine refuse(key, path)
      character(len=*), intent(in) :: key, path
      if (path /= written .or. allocated(error)) return
      call fail(error, printable(sweep%study%file, 200)//': '//key//': '//printable(sweep%path, 200)//trim(suffixes(i))// &
        ' would be replaced by the results: give another folder with --out, or that file another name', status_command_line)
    end subroutine refuse
  end subroutine keep_inputs

  !> Refuse overrides and accuracy levels that set a key which the study varies, or remove its group: they would have no effect on
  !> it.
  subroutine refuse_varied(settings, options, values, keys, error)
    character(len=*), intent(in) :: settings(:)   !! those of the accuracy level, followed by the overrides
    type(command_line_t), intent(in) :: options
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: keys(:)
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: said, name
    integer :: i, k, dot, place
    do i = 1, size(settings)
      name = lowercase(settings(i)(:scan(settings(i), '=[(') - 1))
      dot = index(name, '.', back=.true.)
      place = 0
      if (dot > 0) place = values%place_of(trim(adjustl(name(:dot - 1))), trim(adjustl(name(dot + 1:))))
      if (dot == 0) then   ! a group is removed
        call refuse_removed(trim(adjustl(name)))
        if (allocated(error)) return
      end if
      if (place == 0) cycle
      associate (key => values%keys(place))
        name = trim(key%group)//'.'//trim(key%name)
      end associate
      if (.not. any([(lowercase(without_number(keys(k))) == name, k=1, size(keys))])) cycle
      said = '--accuracy '//options%accuracy
      if (i > size(settings) - size(options%overrides)) said = '--set '//printable(trim(settings(i)), 60)
      call fail(error, said//': the study varies '//name, status_command_line)
      return
    end do

  contains

    !> Refuse the removal of a group with a varied key, unless a later override begins the group again.
    subroutine refuse_removed(group)
      character(len=*), intent(in) :: group
      do k = i + 1, size(settings)
        if (index(lowercase(adjustl(settings(k))), group//'.') == 1) return
      end do
      do k = 1, size(keys)
        if (index(lowercase(keys(k)), group//'.') /= 1) cycle
        call fail(error, '--set '//printable(trim(settings(i)), 60)//': the study varies '//trim(keys(k)), status_command_line)
        return
      end do
    end subroutine refuse_removed
  end subroutine refuse_varied

  !> Check that every text of a table or list is a value of its key.
  subroutine check_values(sweep, error)
    type(sweep_t), intent(inout) :: sweep
    type(error_t), allocatable, intent(out) :: error
    integer :: i, k
    associate (study => sweep%study, table => sweep%design%table)
      do k = 1, sweep%design%runs
        if (study%table == '') exit
        do i = 1, size(table%keys)
          call sweep%base%convert(i, trim(table%field(i, k)), error)
          if (.not. allocated(error)) cycle
          error%message = printable(study%table, 200)//':'//integer_text(table%lines(k))//': column '//integer_text(i)//', '// &
            trim(table%keys(i))//' = '//printable(trim(table%field(i, k)), 48)//': '//error%message
          return
        end do
      end do
      do i = 1, size(study%varied)
        do k = 1, size(study%varied(i)%list)
          call sweep%base%convert(i, study%varied(i)%list(k)%text, error)
          if (.not. allocated(error)) cycle
          error%message = printable(study%file, 200)//':'//integer_text(study%varied(i)%values_line)// &
            ': &parameter key = '''//study%varied(i)%key//''', values = '// &
            printable(study%varied(i)%list(k)%text, 48)//': '//error%message
          return
        end do
      end do
    end associate
  end subroutine check_values

  !> Check whether the runs are possible, as far as their values tell: all runs of a table and of a grid of moderate size. Of a
  !> larger grid, runs spread over it are checked, and those with the last value of each parameter. `line` says how many runs there
  !> are. The error names the first run that would fail, and has the status of a sweep with failed runs.
  subroutine check_rows(sweep, line, error)
    type(sweep_t), intent(inout) :: sweep
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    real(dp), parameter :: golden = 0.61803398874989485_dp   !! its multiples are spread evenly, and follow no period of a grid
    integer :: i, total, failed, noted
    total = sweep%last - sweep%first + 1
    failed = 0
    noted = 0
    line = printable(sweep%study%file, 200)//': '
    if (total <= most_checked .or. sweep%study%table /= '') then
      do i = sweep%first, sweep%last
        call check_run(i)
      end do
    else
      do i = 1, size(sweep%design%keys)
        call check_run(min(sweep%last, max(sweep%first, sweep%design%outermost(i))))
      end do
      call check_run(sweep%first)
      call check_run(sweep%last)
      do i = 1, most_checked
        call check_run(sweep%first + int(total*modulo(golden*i, 1.0_dp)))
      end do
    end if
    if (.not. allocated(error)) line = line//'correct, '
    line = line//counted(integer_text(total), 'run')
    if (total > most_checked .and. sweep%study%table == '') &
      line = line//' ('//integer_text(most_checked)//' of them checked)'
    if (failed > 0) line = line//', '//integer_text(failed)//' would fail'
    if (noted > 0) line = line//', '//integer_text(noted)//' with notes'

  contains

    subroutine check_run(run)
      integer, intent(in) :: run
      character(len=sweep%design%text_length) :: values(size(sweep%design%keys))
      type(error_t), allocatable :: problem
      call sweep%design%get_values(run, values)
      call sweep%base%set_values(values, problem)
      if (.not. allocated(problem)) call sweep%base%check(problem)
      if (.not. allocated(problem)) then
        if (allocated(sweep%base%case%notes)) noted = noted + 1
        return
      end if
      failed = failed + 1
      if (allocated(error)) return
      call fail(error, printable(sweep%study%file, 200)//': run '//integer_text(run)//': '//problem%message, status_integration)
    end subroutine check_run
  end subroutine check_rows

  !> A checksum that differs between studies whose rows would differ.
  function study_checksum(sweep) result(text)
    type(sweep_t), intent(in) :: sweep
    character(len=16) :: text
    type(checksum_t) :: checksum
    integer :: i, run
    call checksum%add(program_version//achar(10)//resolved_text(sweep%base%values)//sweep%study%identity)
    if (sweep%study%table /= '') then
      do i = 1, size(sweep%design%keys)
        call checksum%add(trim(sweep%design%keys(i))//',')
      end do
      do run = 1, sweep%design%runs
        do i = 1, size(sweep%design%keys)
          call checksum%add(trim(sweep%design%table%field(i, run))//',')
        end do
      end do
    end if
    text = checksum%hexadecimal()
  end function study_checksum
end module study_sweep
