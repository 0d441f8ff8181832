!> Cases as text: the template with every key and its default, and the resolved case.
module case_text
  use kinds, only: dp
  use text_tools, only: integer_text, quoted
  use number_text, only: exact_text
  use model_parameters, only: key_t, real_kind, integer_kind, logical_kind
  use case_schema, only: group_definition_t, key_table_t, find_key, is_listed, name_in_file, is_first_of_name, is_apart
  use value_reader, only: n_values
  use case_values, only: case_values_t, value_t
  implicit none
  private
  public :: template_text, resolved_text, value_text

  character(len=*), parameter :: newline = achar(10)

contains

  !> A complete case file: every group and key, with unit, range, allowed words and default as comments.
  function template_text(first_line, table) result(text)
    character(len=*), intent(in) :: first_line   !! without the !
    type(key_table_t), intent(in) :: table
    character(len=:), allocatable :: text
    character(len=:), allocatable :: out
    integer :: group, i
    text = '! '//first_line//newline
    do group = 1, size(table%groups)
      associate (it => table%groups(group))
        if (.not. (is_first_of_name(it) .or. is_apart(it))) cycle
        out = ''
        text = text//newline//'! '//trim(it%description)//newline
        if (it%instead_of /= '') then
          text = text//'! (cannot be combined with &'//trim(it%instead_of)//', therefore commented out here)'//newline
          out = '! '
        end if
        if (it%number > 0) then
          text = text//'! (a group for each one, therefore commented out here)'//newline
          out = '! '
        end if
        if (is_apart(it)) then
          text = text//'! (beside another group of this name, therefore commented out here)'//newline
          out = '! '
        end if
        text = text//out//'&'//name_in_file(it)//newline
        if (is_apart(it)) text = text//out//'  place = '''//it%name(:index(it%name, '.') - 1)//''''//newline
        if (it%place /= '' .or. it%is_law) text = text//'  ! place = ''crank_pin''                   '// &
          'in a second group of this name: '//trim(merge('the joint of crank and rod', 'laws for that joint alone ', &
          it%place /= ''))//newline
        do i = it%first, it%last
          text = text//out//template_line(table%keys, it, table%keys(i))//newline
        end do
        text = text//out//'/'//newline
      end associate
    end do
  end function template_text

  !> `  key = value   ! unit, range, usual sizes, default: description`
  function template_line(keys, group, key) result(line)
    type(key_t), intent(in) :: keys(:)   !! of the schema
    type(group_definition_t), intent(in) :: group
    type(key_t), intent(in) :: key       !! one of its keys
    character(len=:), allocatable :: line, value, note
    value = trim(key%default)
    if (key%example /= '') value = trim(key%example)
    if (key%kind > logical_kind) value = quoted(value, '''')
    if (key%kind == real_kind .and. .not. key%is_list .and. index(value, ',') == 0) &
      value = value//repeat(', '//value, key%count - 1)
    line = '  '//trim(key%name)//' = '//value
    line = line//repeat(' ', max(1, 42 - len(line)))//'! '
    note = ''
    if (key%unit /= '') note = note//', '//trim(key%unit)
    if (key%range /= '') note = note//', '//trim(key%range)
    if (key%usual /= '') note = note//', usually '//trim(key%usual)
    if (allocated(key%words)) note = note//', one of '//key%words
    if (key%required) note = note//', required'
    if (.not. key%required .and. key%example /= '' .and. key%default /= '') note = note//', default '//trim(key%default)
    if (note /= '') line = line//note(3:)//': '
    line = line//trim(key%description)
    if (.not. allocated(key%laws)) return
    associate (all_laws => keys(find_key(keys, group, key%choice))%words)
      if (key%laws == all_laws) return
      note = 'not '//others(all_laws, key%laws)
      if (len(note) >= len(key%laws)) note = key%laws   ! the shorter of both
      line = line//' ('//note//')'
    end associate
  end function template_line

  !> The words of one list of laws that another list does not contain.
  pure function others(all_laws, some) result(list)
    character(len=*), intent(in) :: all_laws, some   !! separated by a comma and a blank
    character(len=:), allocatable :: list
    integer :: first, length
    list = ''
    first = 1
    do while (first <= len(all_laws))
      length = index(all_laws(first:)//',', ',') - 1
      if (.not. is_listed(all_laws(first:first + length - 1), some)) list = list//', '//all_laws(first:first + length - 1)
      first = first + length + 2
    end do
    list = list(3:)
  end function others

  !> A case file with all keys of the models of the case, in every group that is present. Reals have as many digits as read
  !> back exactly.
  function resolved_text(values) result(text)
    type(case_values_t), intent(in) :: values
    character(len=:), allocatable :: text
    integer :: group, i, dot
    text = ''
    do group = 1, size(values%groups)
      if (values%groups(group)%is_model .and. .not. values%is_present(group) .or. values%is_replaced(group)) cycle
      dot = index(values%groups(group)%name, '.')
      text = text//'&'//name_in_file(values%groups(group))//newline
      if (dot > 0) text = text//'  place = '''//values%groups(group)%name(:dot - 1)//''''//newline
      do i = values%groups(group)%first, values%groups(group)%last
        if (values%is_used(i)) text = text//resolved_line(values%keys(i), values%values(i))//newline
      end do
      text = text//'/'//newline
    end do
  end function resolved_text

  !> `  key = value  ! unit`
  function resolved_line(key, value) result(line)
    type(key_t), intent(in) :: key
    type(value_t), intent(in) :: value
    character(len=:), allocatable :: line
    line = '  '//trim(key%name)//' = '//value_text(key, value)
    if (key%unit /= '') line = line//'  ! '//trim(key%unit)
  end function resolved_line

  !> The value of a key as it is written in a case, or one number of a list.
  function value_text(key, value, element) result(text)
    type(key_t), intent(in) :: key
    type(value_t), intent(in) :: value
    integer, intent(in), optional :: element   !! 0: all
    character(len=:), allocatable :: text
    integer :: first, last, i
    select case (key%kind)
    case (real_kind)
      first = 1
      last = n_values(key, value)
      if (present(element)) then
        if (element > 0) first = element
        if (element > 0) last = element
      end if
      text = real_literal(value%reals(first))
      do i = first + 1, last
        text = text//', '//real_literal(value%reals(i))
      end do
    case (integer_kind)
      text = integer_text(value%whole)
    case (logical_kind)
      text = trim(merge('.true. ', '.false.', value%switch))
    case default
      text = quoted(value%text, '''')
    end select
  end function value_text

  !> A real that cannot be taken for a whole number: 0.0508, 250.0, 2e-5.
  pure function real_literal(value) result(text)
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    text = exact_text(value)
    if (scan(text, '.e') == 0) text = text//'.0'
  end function real_literal
end module case_text
