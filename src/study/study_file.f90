!> Reads study files and checks their values. Errors have the form of those of case files.
module study_file
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: printable, case_name, lowercase, path_beside
  use value_reader, only: convert_list
  use text_file, only: read_text_file
  use posix_files, only: absolute_path
  use namelist_reader, only: namelist_t, read_namelist
  use case_values, only: case_values_t
  use case_schema, only: key_t, key_table_t, case_schema_of, find_group, find_key, without_number, &
    is_group_of_cases, text_kind
  use case_loader, only: load_model
  use case_text, only: resolved_text
  use problem_list, only: problem_list_t, behind_file
  use study_definition, only: study_t, parameter_t, text_t, study_schema_of
  implicit none
  private
  public :: read_study

contains

  !> Read and check a study file. Paths in it are converted to paths relative to the current folder.
  subroutine read_study(path, study, error)
    character(len=*), intent(in) :: path
    type(study_t), intent(out) :: study
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    type(namelist_t) :: list

    call read_text_file(path, 1, 'study file', text, error)
    if (allocated(error)) return
    call read_namelist(text, path, list, error)
    if (allocated(error)) return
    study%file = path
    study%name = case_name(path)
    call fill_study(list, study, error)
  end subroutine read_study

  !> Set a study from the groups of its file.
  subroutine fill_study(list, study, error)
    type(namelist_t), intent(inout) :: list
    type(study_t), intent(inout) :: study
    type(error_t), allocatable, intent(out) :: error
    type(case_values_t), allocatable :: groups(:)
    call read_groups(study%file, list, groups, error)
    if (allocated(error)) return
    call set_study(groups(1), study)
    call check_study(groups(1), study, size(groups) - 1, error)
    if (allocated(error)) return
    call set_parameters(groups(2:), study, error)
  end subroutine fill_study

  !> The values of each group of the file: first those of &study, then those of each &parameter.
  subroutine read_groups(path, list, groups, error)
    character(len=*), intent(in) :: path
    type(namelist_t), intent(inout) :: list
    type(case_values_t), allocatable, intent(out) :: groups(:)
    type(error_t), allocatable, intent(out) :: error
    type(key_table_t) :: table
    type(problem_list_t) :: problems
    character(len=:), allocatable :: at
    type(error_t), allocatable :: unit_error
    integer :: place(size(list%groups)), i, n, key

    call study_schema_of(table)
    allocate (groups(count([(list%groups(i)%name == 'parameter', i=1, size(list%groups))]) + 1))
    do i = 1, size(groups)
      groups(i)%key_table_t = table
      call groups(i)%set_defaults(path)
    end do
    n = 1
    place = 0
    do i = 1, size(list%groups)
      at = list%at(list%groups(i)%line)
      select case (list%groups(i)%name)
      case ('study')
        if (groups(1)%is_present(1)) call fail(error, at//'&study: this group is given twice', status_case_file)
        place(i) = 1
        groups(1)%is_present(1) = .true.
        groups(1)%line(1) = list%groups(i)%line
      case ('parameter')
        n = n + 1
        place(i) = n
        groups(n)%is_present(2) = .true.
        groups(n)%line(2) = list%groups(i)%line
      case default
        if (is_group_of_cases(list%groups(i)%name)) then
          call fail(error, at//'&'//list%groups(i)%name//': a case, not a study: run it with gudgeon '//list%file// &
            ', without sweep', status_case_file)
          return
        else
          call groups(1)%find(list%groups(i)%name, '', at, key, error)
        end if
      end select
      call problems%add_error(error, '', list%groups(i)%line)
    end do
    if (.not. (groups(1)%is_present(1) .or. problems%concerns(''))) &
      call problems%add(list%file//': &study: this group is required', 'study', behind_file)
    do i = 1, size(list%entries)
      associate (entry => list%entries(i))
        if (place(entry%group_number) == 0) cycle
        if (any(entry%key == [character(len=6) :: 'values', 'from', 'to'])) then
          call take_units(list, i, unit_error)
          call problems%add_error(unit_error, '', entry%line)
        end if
        if (entry%key == 'values') entry%tokens%quoted = .true.   ! a list is kept as written, numbers and words alike
        call groups(place(entry%group_number))%give(entry%group, entry, list%at(entry%line))
      end associate
    end do
    do i = 1, size(groups)
      call groups(i)%check()
      call problems%absorb(groups(i)%problems)
    end do
    call problems%report(error)
  end subroutine read_groups

  !> Replace the numbers with units in an entry of &parameter by numbers in the unit of the key that it varies.
  subroutine take_units(list, number, error)
    type(namelist_t), intent(inout) :: list
    integer, intent(in) :: number   !! of the entry
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: wanted
    type(key_t) :: key
    integer :: i
    do i = 1, size(list%entries)
      if (list%entries(i)%group_number == list%entries(number)%group_number .and. list%entries(i)%key == 'key') &
        key = key_of_case(lowercase(list%entries(i)%tokens(1)%text))
    end do
    associate (entry => list%entries(number))
      do i = 1, size(entry%tokens)
        if (entry%key /= 'values' .and. entry%tokens(i)%quoted) cycle   ! refused below
        call convert_list(entry%tokens(i)%text, key, wanted)
        if (.not. allocated(wanted)) cycle
        call fail(error, list%at(entry%line)//'&parameter '//entry%key//' = '//wanted, status_case_file)
        entry%tokens(i)%text = '0'   ! not refused again
      end do
    end associate
  end subroutine take_units

  !> A key of cases, given as GROUP.KEY, or a number of a list, as GROUP.KEY[2]; a key of texts if there is none.
  type(key_t) function key_of_case(name) result(key)
    character(len=*), intent(in) :: name
    type(key_table_t) :: table
    integer :: dot, group, place
    key%kind = text_kind
    call case_schema_of(table)
    dot = index(name, '.', back=.true.)
    group = find_group(table%groups, name(:max(0, dot - 1)))
    if (group == 0) return
    place = find_key(table%keys, table%groups(group), without_number(name(dot + 1:)))
    if (place > 0) key = table%keys(place)
    if (scan(name, '[(') > 0) key%count = 1
  end function key_of_case

  !> Set the values of &study.
  subroutine set_study(values, study)
    type(case_values_t), intent(inout) :: values
    type(study_t), intent(inout) :: study
    call load_model(values, 'study', study)
    study%case = path_beside(study%file, study%case)
    study%table = path_beside(study%file, study%table)
    study%resolved = resolved_with(absolute_path(study%case), absolute_path(study%table), study%title)
    study%identity = resolved_with('', '', '')

  contains

    !> The text of the group with other paths.
    function resolved_with(case, table, title)
      character(len=*), intent(in) :: case, table, title
      character(len=:), allocatable :: resolved_with
      type(case_values_t) :: changed
      integer :: place
      changed = values
      place = values%place_of('study', 'case')
      changed%values(place)%text = case
      place = values%place_of('study', 'table')
      changed%values(place)%text = table
      place = values%place_of('study', 'title')
      changed%values(place)%text = title
      resolved_with = resolved_text(changed)
    end function resolved_with
  end subroutine set_study

  !> Check that the values of &study fit together and fit the number of parameters.
  subroutine check_study(values, study, n_parameters, error)
    type(case_values_t), intent(inout) :: values
    type(study_t), intent(in) :: study
    integer, intent(in) :: n_parameters
    type(error_t), allocatable, intent(out) :: error
    call forbid(study%case == '', 'case', 'must name a case file')
    call forbid(study%table /= '' .and. n_parameters > 0, 'table', 'must not be given together with &parameter')
    call forbid(study%table == '' .and. n_parameters == 0, 'table', 'this or &parameter is required')
    call values%problems%report(error)

  contains

    subroutine forbid(is_wrong, key, wanted)
      logical, intent(in) :: is_wrong
      character(len=*), intent(in) :: key, wanted
      call values%forbid(is_wrong, 'study', key, wanted)
    end subroutine forbid
  end subroutine check_study

  !> Set the values of all &parameter groups.
  subroutine set_parameters(groups, study, error)
    type(case_values_t), intent(inout) :: groups(:)
    type(study_t), intent(inout) :: study
    type(error_t), allocatable, intent(out) :: error
    type(problem_list_t) :: problems
    integer :: i, k
    allocate (study%varied(size(groups)))
    do i = 1, size(groups)
      associate (p => study%varied(i))
        call load_model(groups(i), 'parameter', p)
        p%key = lowercase(p%key)
        p%key_line = groups(i)%values(groups(i)%place_of('parameter', 'key'))%line
        p%values_line = groups(i)%values(groups(i)%place_of('parameter', 'values'))%line
        call split(p%values, p%list)
      end associate
      call check_parameter(groups(i), study%varied(i))
      do k = 1, i - 1
        if (study%varied(k)%key == study%varied(i)%key) call groups(i)%refuse('parameter', 'key', 'is varied twice')
      end do
      call problems%absorb(groups(i)%problems)
      study%resolved = study%resolved//resolved_text(groups(i))
      study%identity = study%identity//resolved_text(groups(i))
    end do
    call problems%report(error)
  end subroutine set_parameters

  !> Check that a parameter has either a range or a list.
  subroutine check_parameter(values, p)
    type(case_values_t), intent(inout) :: values
    type(parameter_t), intent(in) :: p
    logical :: has_from, has_to
    has_from = values%is_given('parameter', 'from')
    has_to = values%is_given('parameter', 'to')
    if (size(p%list) > 0) then
      call forbid(has_from .or. has_to .or. p%count > 0, 'values', 'must not be given together with from, to or count')
      return
    end if
    call forbid(.not. has_from, 'from', 'from and to, or values, are required')
    call forbid(has_from .and. .not. has_to, 'to', 'required with from')
    call forbid(p%scale == 'log' .and. .not. (p%from > 0 .and. p%to > 0), 'scale', 'from and to must be > 0 for scale = ''log''')
    call forbid(p%count == 0, 'count', 'required with from and to')

  contains

    subroutine forbid(is_wrong, key, wanted)
      logical, intent(in) :: is_wrong
      character(len=*), intent(in) :: key, wanted
      call values%forbid(is_wrong, 'parameter', key, wanted//'; &parameter key = '''//printable(p%key, 60)//'''')
    end subroutine forbid
  end subroutine check_parameter

  !> The fields of a list separated by commas, without surrounding blanks.
  pure subroutine split(list, fields)
    character(len=*), intent(in) :: list
    type(text_t), allocatable, intent(out) :: fields(:)
    integer :: i, first, next, n
    n = 0
    if (list /= '') n = count([(list(i:i) == ',', i=1, len(list))]) + 1
    allocate (fields(n))
    first = 1
    do i = 1, n
      next = index(list(first:)//',', ',')
      fields(i)%text = trim(adjustl(list(first:first + next - 2)))
      first = first + next
    end do
  end subroutine split
end module study_file
