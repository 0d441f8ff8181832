!> The groups and keys of case files as a JSON Schema (2020-12), for a case as JSON, TOML or f90nml has it: an object of groups,
!> each an object of keys. A group that a case may have several times is one object or an array of objects.
module json_schema
  use text_tools, only: replaced, integer_text
  use case_schema, only: key_t, group_definition_t, key_table_t, find_group, name_in_file, is_first_of_name, is_apart, &
    real_kind, integer_kind, logical_kind, word_kind
  use joint_places, only: places, in_order
  implicit none
  private
  public :: json_schema_text

  character(len=*), parameter :: n = achar(10)

contains

  !> The schema of the groups of a table.
  function json_schema_text(table) result(text)
    type(key_table_t), intent(in) :: table
    character(len=:), allocatable :: text, required
    integer :: group
    text = '{'//n//'"$schema": "https://json-schema.org/draft/2020-12/schema",'//n//'"title": "Case of gudgeon",'//n// &
      '"type": "object",'//n//'"additionalProperties": false,'//n//'"properties": {'//n
    required = ''
    do group = 1, size(table%groups)
      associate (it => table%groups(group))
        if (.not. is_first_of_name(it)) cycle
        if (group > 1) text = text//','//n
        text = text//string(name_in_file(it))//': '//group_schema(table, it)
        if (.not. it%is_model .and. it%place == '' .and. any(table%keys(it%first:it%last)%required)) &
          required = required//', '//string(trim(it%name))
      end associate
    end do
    text = text//n//'},'//n//'"required": ['//required(3:)//']'//n//'}'//n
  end function json_schema_text

  recursive function group_schema(table, group) result(text)
    type(key_table_t), intent(in) :: table
    type(group_definition_t), intent(in) :: group
    character(len=:), allocatable :: text, required
    integer :: i
    text = '{"type": "object", "description": '//string(trim(group%description))//', "additionalProperties": false,'//n// &
      '"properties": {'//n
    required = ''
    do i = group%first, group%last
      associate (key => table%keys(i))
        text = text//'  '//string(trim(key%name))//': '//key_schema(key)
        if (i < group%last .or. has_places(table, group) .or. is_apart(group)) text = text//','
        text = text//n
        if (key%required .and. .not. (allocated(key%laws) .or. group%is_model)) required = required//', '//string(trim(key%name))
      end associate
    end do
    if (has_places(table, group)) text = text//'  "place": {"enum": ['//place_names()//']}'//n
    if (is_apart(group)) text = text//'  "place": {"const": '//string(group%name(:index(group%name, '.') - 1))//'}'//n
    text = text//'}'
    if (required /= '') text = text//', "required": ['//required(3:)//']'
    text = text//'}'
    if (has_places(table, group)) then
      do i = 1, size(table%groups)
        if (is_apart(table%groups(i)) .and. name_in_file(table%groups(i)) == group%name) &
          text = text//','//n//group_schema(table, table%groups(i))
      end do
    end if
    if (has_places(table, group) .or. group%number > 0) &
      text = '{"anyOf": ['//text//','//n//'{"type": "array", "items": {"type": "object"}}]}'
  end function group_schema

  !> Names of the places of joints, in quotes, separated by commas.
  function place_names() result(names)
    character(len=:), allocatable :: names
    integer :: i
    names = ''
    do i = 1, size(places)
      names = names//string(trim(places(in_order(i))%name))//trim(merge(', ', '  ', i < size(places)))
    end do
  end function place_names

  !> Whether a group may appear once for each joint.
  logical function has_places(table, group)
    type(key_table_t), intent(in) :: table
    type(group_definition_t), intent(in) :: group
    has_places = find_group(table%groups, trim(places(in_order(2))%name)//'.'//trim(group%name)) > 0
  end function has_places

  function key_schema(key) result(text)
    type(key_t), intent(in) :: key
    character(len=:), allocatable :: text
    select case (key%kind)
    case (real_kind)
      text = number_schema('number', key)
      if (key%is_list) then   ! one value or several
        text = '{"anyOf": ['//text//', {"type": "array", "items": '//text//', "minItems": 1, "maxItems": '// &
          integer_text(key%count)//'}]}'
      else if (key%count > 1) then
        text = '{"type": "array", "items": '//text//', "minItems": '//integer_text(key%count)//', "maxItems": '// &
          integer_text(key%count)//'}'
      end if
    case (integer_kind)
      text = number_schema('integer', key)
    case (logical_kind)
      text = '{"type": "boolean"}'
    case (word_kind)
      text = '{"enum": ['//string(replaced(key%words, ', ', '", "'))//']}'
      if (key%default /= '' .and. index(', '//key%words//',', ', '//trim(key%default)//',') == 0) &
        text = text(:len(text) - 2)//', '//string(trim(key%default))//']}'
    case default
      text = '{"type": "string"}'
    end select
    text = text(:len(text) - 1)
    if (key%unit /= '') text = text//', "x-unit": '//string(trim(key%unit))
    if (key%usual /= '') text = text//', "x-usual": '//string(trim(key%usual))
    if (allocated(key%laws)) text = text//', "x-laws": '//string(key%laws)
    if (key%default /= '') text = text//', "x-default": '//string(trim(key%default))
    text = text//', "description": '//string(trim(key%description))//'}'
  end function key_schema

  !> A number within its limits, or the default, which may be outside them and then means "not given".
  function number_schema(kind, key) result(text)
    character(len=*), intent(in) :: kind
    type(key_t), intent(in) :: key
    character(len=:), allocatable :: text
    text = '{"type": "'//kind//'"'
    if (key%range == '') then
      text = text//'}'
    else if (key%default == '') then
      text = text//limits(trim(key%range))//'}'
    else
      text = text//', "anyOf": [{'
      text = text//replaced('@'//limits(trim(key%range)), '@, ', '')//'}, {"const": '//trim(key%default)//'}]}'
    end if
  end function number_schema

  !> `, "exclusiveMinimum": 0, "maximum": 1` for `> 0 and <= 1`.
  pure recursive function limits(range) result(text)
    character(len=*), intent(in) :: range
    character(len=:), allocatable :: text
    character(len=*), parameter :: signs(4) = [character(len=2) :: '>', '>=', '<', '<=']
    character(len=*), parameter :: words(4) = [character(len=16) :: 'exclusiveMinimum', 'minimum', 'exclusiveMaximum', 'maximum']
    integer :: length, blank
    length = index(range//' and ', ' and ') - 1
    blank = index(range, ' ')
    text = ', "'//trim(words(findloc(signs == range(:blank - 1), .true., 1)))//'": '//range(blank + 1:length)
    if (len(range) > length + 5) text = text//limits(range(length + 6:))
  end function limits

  pure function string(text) result(json)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: json
    json = '"'//replaced(replaced(text, '\', '\\'), '"', '\"')//'"'
    json = replaced(json, '\", \"', '", "')   ! between the words of a list
  end function string
end module json_schema
