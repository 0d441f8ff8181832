!> Reads case files into cases, and writes cases as text. All errors have the exit status of case files and are one line: file, line
!> or group and key, value as written, and what is allowed.
module case_file
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: lowercase, printable, case_name, likely_word, integer_text
  use text_file, only: read_text_file
  use joint_places, only: places, n_places, in_order, joint_group
  use case_definition, only: case_t
  use case_schema, only: key_table_t, case_schema_of, find_group, shown_group, name_in_file, is_apart
  use case_values, only: case_values_t
  use case_loader, only: load_case
  use case_rules, only: check_rules
  use case_notes, only: note_case
  use case_text, only: template_text, resolved_text
  use namelist_reader, only: namelist_t, read_namelist
  use oil_values, only: replace_oils
  use own_groups, only: enter_group
  use problem_list, only: behind_file
  implicit none
  private
  public :: read_case, parse_case, read_case_values, parse_values, apply_override, complete_case, template

  integer, parameter :: largest_file = 1   !! MB; case files are a few kilobytes long

contains

  !> Read a case file, complete it with defaults, and check it. `overrides` have the form GROUP.KEY=VALUE and replace values of the
  !> file.
  subroutine read_case(path, overrides, this, error)
    character(len=*), intent(in) :: path, overrides(:)
    type(case_t), intent(out) :: this
    type(error_t), allocatable, intent(out) :: error
    type(case_values_t) :: values
    call read_case_values(path, overrides, values, error)
    if (.not. allocated(error)) call complete_case(values, path, this, error)
  end subroutine read_case

  !> Read a case from a text; `path` gives its name and is used in messages. `resolved` is the case with all defaults as text;
  !> reading that gives the same case, bit for bit.
  subroutine parse_case(text, path, overrides, this, error, resolved)
    character(len=*), intent(in) :: text, path, overrides(:)
    type(case_t), intent(out) :: this
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable, intent(out), optional :: resolved
    type(case_values_t) :: values
    call parse_values(text, path, overrides, values)
    call complete_case(values, path, this, error)
    if (present(resolved) .and. .not. allocated(error)) resolved = resolved_text(values)
  end subroutine parse_case

  !> Read the values of a case file and of the overrides, without checking them against each other. What is wrong is noted in the
  !> values. Error: the file cannot be read.
  subroutine read_case_values(path, overrides, values, error)
    character(len=*), intent(in) :: path, overrides(:)
    type(case_values_t), intent(out) :: values
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    call read_text_file(path, largest_file, 'case file', text, error)
    if (.not. allocated(error)) call parse_values(text, path, overrides, values)
  end subroutine read_case_values

  !> The values of a case file's text and of overrides; see `read_case_values`. `path` gives its name in messages. Groups that may
  !> be repeated have more than one number only if the case has such a group, or `all_groups` is present and true.
  subroutine parse_values(text, path, overrides, values, all_groups)
    character(len=*), intent(in) :: text, path, overrides(:)
    type(case_values_t), intent(out) :: values
    logical, intent(in), optional :: all_groups
    type(namelist_t) :: list
    type(error_t), allocatable :: syntax, error
    logical :: repeats
    integer :: i
    call read_namelist(text, path, list, syntax)
    repeats = .false.
    if (present(all_groups)) repeats = all_groups
    call case_schema_of(values%key_table_t, repeats)
    if (.not. repeats .and. repeats_groups(values%key_table_t, list, overrides)) call case_schema_of(values%key_table_t)
    call values%set_defaults(path)
    call set_from_file(values, list, syntax)
    do i = 1, size(overrides)
      call apply_override(values, trim(overrides(i)), behind_file + i, error)
      if (allocated(error)) values%problems%is_structural = .true.
      call values%problems%add_error(error, '--set', behind_file + i)
    end do
    call values%prefer_overrides()
  end subroutine parse_values

  pure logical function has_group(list, name)
    type(namelist_t), intent(in) :: list
    character(len=*), intent(in) :: name
    integer :: i
    has_group = .false.
    do i = 1, size(list%groups)
      has_group = has_group .or. list%groups(i)%name == name
    end do
  end function has_group

  !> Whether a file has a group that may be repeated, or an override may name one: its group is not in the table without them.
  logical function repeats_groups(table, list, overrides)
    type(key_table_t), intent(in) :: table
    type(namelist_t), intent(in) :: list
    character(len=*), intent(in) :: overrides(:)
    character(len=:), allocatable :: name
    integer :: i, dot
    repeats_groups = .false.
    do i = 1, size(table%groups)
      if (table%groups(i)%number > 0) repeats_groups = repeats_groups .or. has_group(list, name_in_file(table%groups(i)))
    end do
    do i = 1, size(overrides)
      name = lowercase(overrides(i)(:index(overrides(i)//'=', '=') - 1))
      dot = index(name, '.', back=.true.)
      if (dot > 0) name = name(:dot - 1)
      repeats_groups = repeats_groups .or. find_group(table%groups, trim(adjustl(name))) == 0
    end do
  end function repeats_groups

  !> Complete and check a case from its values; `path` gives its name. Defaults that depend on the selected laws are put into the
  !> values. The error has every problem of the values, but contradictions between them only if it is clear what is wanted.
  subroutine complete_case(values, path, this, error)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: path
    type(case_t), intent(out) :: this
    type(error_t), allocatable, intent(out) :: error
    integer :: i
    call values%check()
    this%file = path
    this%name = case_name(path)
    if (this%name == '') this%name = 'case'
    if (.not. (values%problems%is_structural .or. values%problems%concerns('mechanism') .or. &
               values%problems%concerns('initial') .or. any([(values%problems%concerns(joint_group(i)), i=1, n_places)]))) then
      call values%problems%settle()
      call load_case(values, this)
      call replace_oils(values)
      call check_rules(this, values)
    end if
    call values%problems%report(error)
    if (.not. allocated(error)) call note_case(this, values)
  end subroutine complete_case

  !> A complete case file with comments, which can be read back.
  function template() result(text)
    character(len=:), allocatable :: text
    type(key_table_t) :: table
    call case_schema_of(table)
    text = template_text('A case of gudgeon with every key there is. Keys marked required have no default.', table)
  end function template

  !> Set the values from the groups and keys of a file. `syntax` is the error with which it ends, if there is one.
  subroutine set_from_file(values, list, syntax)
    type(case_values_t), intent(inout) :: values
    type(namelist_t), intent(inout) :: list
    type(error_t), allocatable, intent(inout) :: syntax
    type(error_t), allocatable :: error
    logical, allocatable :: is_known(:)   !! for each group of the file
    integer :: i
    if (allocated(syntax)) values%problems%is_incomplete = .true.
    if (size(list%groups) == 0 .and. .not. allocated(syntax)) then
      call fail(syntax, values%file//': the file contains no group; gudgeon --template prints a case', status_case_file)
      values%problems%is_incomplete = .true.
    end if
    if (has_group(list, 'film_history') .and. .not. (has_group(list, 'mechanism') .or. has_group(list, 'bearing_load') .or. &
      allocated(syntax))) then
      call values%problems%add(values%file//': a bearing by itself is a case with &bearing_load now: table or load, &initial '// &
        'crank_speed, &joint kind = ''quasi_static''; &film_history table is gone (manual: A bearing by itself)', '', behind_file)
      values%problems%is_incomplete = .true.
      values%problems%is_structural = .true.
      return
    end if
    allocate (is_known(size(list%groups)), source=.false.)
    do i = 1, size(list%groups)
      associate (group => list%groups(i))
        call name_place(values, list, i, error)
        if (.not. allocated(error)) call begin_group(values, group%name, group%line, list%at(group%line), is_known(i), error)
        if (allocated(error)) values%problems%is_structural = .true.
        call values%problems%add_error(error, '', group%line)
        if (group%name == 'study' .or. group%name == 'parameter') then   ! not a case at all
          values%problems%is_incomplete = .true.
          return
        end if
      end associate
    end do
    do i = 1, size(list%entries)
      associate (entry => list%entries(i))
        if (.not. is_known(entry%group_number) .or. entry%key == 'place' .and. has_places(values, entry%group)) cycle
        if (entry%key == 'position_deg') entry%tokens%quoted = .true.   ! a list is kept as written
        call values%give(list%groups(entry%group_number)%name, entry, list%at(entry%line))
      end associate
    end do
    if (allocated(syntax)) values%problems%is_structural = .true.
    call values%problems%add_error(syntax, '', behind_file)
  end subroutine set_from_file

  !> Begin a group of the file. Error: an unknown group, or one that has begun before.
  subroutine begin_group(values, name, line, at, is_known, error)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: name   !! with its place
    integer, intent(in) :: line
    character(len=*), intent(in) :: at     !! file and line
    logical, intent(out) :: is_known
    type(error_t), allocatable, intent(out) :: error
    integer :: group, place
    group = find_group(values%groups, name)
    is_known = .false.
    if (name == 'study' .or. name == 'parameter') then
      call fail(error, at//'&'//name//': a study, not a case: run it with gudgeon sweep '//values%file, status_case_file)
    else if (group == 0) then
      call values%find(name, '', at, place, error)
    else if (values%is_present(group)) then
      call fail(error, at//shown_group(name)//': this group is given twice', status_case_file)
    else
      is_known = .true.
      values%is_present(group) = .true.
      values%line(group) = line
    end if
  end subroutine begin_group

  !> Write the place of a joint in front of the name of its group, crank_pin.joint, or the number of a group that may be repeated
  !> behind it, cylinder_3.
  subroutine name_place(values, list, number, error)
    type(case_values_t), intent(in) :: values
    type(namelist_t), intent(inout) :: list
    integer, intent(in) :: number   !! number of the group in the file
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: wanted, place, found
    character(len=100) :: allowed   ! places
    integer :: i
    if (find_group(values%groups, list%groups(number)%name//'_1') > 0) then
      call number_group(values, list, number, error)
      return
    end if
    if (.not. has_places(values, list%groups(number)%name)) return
    found = ''
    do i = 1, size(list%entries)
      associate (entry => list%entries(i))
        if (entry%group_number /= number .or. entry%key /= 'place') cycle
        wanted = 'takes 1 value'
        place = ''
        if (size(entry%tokens) == 1 .and. entry%index == 0) then
          wanted = ''
          place = lowercase(entry%tokens(1)%text)
          if (found /= '') wanted = 'given twice'
          if (.not. (any(places%name == place) .or. find_group(values%groups, place//'.'//list%groups(number)%name) > 0)) then
            allowed = places_of(values, list%groups(number)%name)
            wanted = 'must be one of '//trim(allowed)//likely_word(place, trim(allowed))
          end if
        end if
        if (wanted /= '') then
          call fail(error, list%at(entry%line)//'&'//entry%group//' place = '//printable(place, 48)//': '//wanted, &
                    status_case_file)
          return
        end if
        found = place
      end associate
    end do
    if (found == '' .or. found == places(in_order(1))%name .and. list%groups(number)%name == 'joint') return
    list%groups(number)%name = found//'.'//list%groups(number)%name
  end subroutine name_place

  !> Write its number behind the name of a group that may be repeated. Error: there are too many.
  subroutine number_group(values, list, at, error)
    type(case_values_t), intent(in) :: values
    type(namelist_t), intent(inout) :: list
    integer, intent(in) :: at   !! number of the group in the file
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    integer :: i, n
    name = list%groups(at)%name
    n = 1
    do i = 1, at - 1
      if (list%groups(i)%name == name//'_'//integer_text(n)) n = n + 1
    end do
    if (find_group(values%groups, name//'_'//integer_text(n)) > 0) then
      list%groups(at)%name = name//'_'//integer_text(n)
    else
      call fail(error, list%at(list%groups(at)%line)//'&'//name//': at most '//integer_text(n - 1)//' of these groups', &
        status_case_file)
    end if
  end subroutine number_group

  !> The places that a group may name, separated by a comma and a blank: those of joints, and those with keys of their own.
  pure function places_of(values, name) result(list)
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: list
    integer :: i
    list = trim(places(in_order(1))%name)
    do i = 2, size(in_order)
      list = list//', '//trim(places(in_order(i))%name)
    end do
    do i = 1, size(values%groups)
      if (is_apart(values%groups(i)) .and. name_in_file(values%groups(i)) == name) &
        list = list//', '//values%groups(i)%name(:index(values%groups(i)%name, '.') - 1)
    end do
  end function places_of

  !> Whether a group may appear once for each joint.
  pure logical function has_places(values, name)
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: name
    has_places = find_group(values%groups, trim(places(in_order(2))%name)//'.'//name) > 0
  end function has_places

  !> Apply an override GROUP.KEY=VALUE, or GROUP.KEY[2]=VALUE for a number of a list, to the values; texts need no quotes.
  !> GROUP=none removes everything that the file and earlier overrides have set in that group.
  subroutine apply_override(values, override, line, error)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: override
    integer, intent(in) :: line   !! for the order of messages
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: at, group, key, text
    integer :: dot, equals, place, element, i
    at = values%file//': --set '//printable(override, 60)//': '
    equals = index(override, '=')
    dot = index(override(:max(0, equals - 1)), '.', back=.true.)
    text = lowercase(trim(adjustl(override(equals + 1:))))
    group = trim(adjustl(lowercase(override(:max(0, equals - 1)))))
    if (equals > 1 .and. text == 'none' .and. (dot == 0 .or. find_group(values%groups, group) > 0)) then
      if (find_group(values%groups, group//'_1') > 0) then
        i = 1
        do while (find_group(values%groups, group//'_'//integer_text(i)) > 0)
          call values%remove_group(group//'_'//integer_text(i), at, error)
          i = i + 1
        end do
      else if (is_shared(values, group)) then
        call fail(error, at//'no group of the '//trim(places(findloc(places%name == group(:dot - 1), .true., 1))%title)// &
          ' alone is given: the group '//group(dot + 1:)//' is for all pins, and --set '//group(dot + 1:)// &
          '=none removes it from all', status_case_file)
      else
        if (find_group(values%groups, group) > 0) call enter_group(values, group, '=none', at, error)
        if (.not. allocated(error)) call values%remove_group(group, at, error)
      end if
      return
    else if (dot == 0) then
      call fail(error, at//'must have the form GROUP.KEY=VALUE or GROUP=none', status_case_file)
      return
    end if
    group = trim(adjustl(lowercase(override(:dot - 1))))
    key = trim(adjustl(lowercase(override(dot + 1:equals - 1))))
    call values%find(group, key, at, place, error, element)
    if (allocated(error)) return
    call enter_group(values, group, '.'//key, at, error)
    if (allocated(error)) return
    text = trim(adjustl(override(equals + 1:)))
    call values%assign_text(place, element, text, .false., at, error)
    values%values(place)%line = line
    if (allocated(error) .and. lowercase(text) == 'none') &
      error%message = error%message//'; --set '//group//'=none takes the group out'
  end subroutine apply_override

  !> Whether a further joint follows the group of this name for all joints, because it has none of its own.
  pure logical function is_shared(values, group)
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: group   !! crank_pin.NAME, or any other name
    integer :: own, common, dot
    is_shared = .false.
    dot = index(group, '.')
    if (.not. any(places(in_order(2:))%name == group(:dot - 1)) .or. group(dot + 1:) == 'joint') return
    own = find_group(values%groups, group)
    common = find_group(values%groups, group(dot + 1:))
    if (own > 0 .and. common > 0) is_shared = values%is_present(common) .and. .not. values%is_present(own)
  end function is_shared
end module case_file
