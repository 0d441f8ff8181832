!> The values of one case, key by key in the order of the schema: taken from a file or an override, and checked for kind, count,
!> words and range.
module case_values
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: printable, integer_text, nearest_word, allowed
  use joint_places, only: places
  use case_schema, only: key_t, key_table_t, find_group, find_key, is_listed, shown_group, without_number, group_names, &
    real_kind, integer_kind, word_kind, text_kind
  use namelist_reader, only: entry_t, token_t, read_values
  use unit_hints, only: likely_unit
  use problem_list, only: problem_list_t, behind_file, missing_key
  use number_text, only: short_text
  use value_reader, only: value_t, set_to_default, n_values, convert, find_decimal_comma, is_default, unit_of, has_unit, &
    most_reals, is_within, read_bounds, read_integer
  implicit none
  private
  public :: case_values_t, value_t

  integer, parameter :: name_length = 32   !! of keys and groups

  type, extends(key_table_t) :: case_values_t
    character(len=:), allocatable :: file          !! name of the case file in messages
    logical, allocatable :: is_present(:)          !! for each group
    integer, allocatable :: line(:)                !! of the file on which each group begins
    type(value_t), allocatable :: values(:)        !! for each key
    type(problem_list_t) :: problems               !! errors found so far
  contains
    procedure :: set_defaults
    procedure :: find         !! index of a key, or an error
    procedure :: list_keys
    procedure :: count_as_given
    procedure :: place_of     !! index of a key
    procedure :: give         !! assign the values of an entry of the file
    procedure :: assign       !! give a key its values as written
    procedure :: assign_text  !! the same, from a text of the user, as an override
    procedure :: remove_group     !! remove a group, as if the file did not contain it
    procedure :: prefer_overrides   !! to other keys of the same family
    procedure :: prefer
    procedure :: check_family
    procedure :: is_said      !! a number that differs from its default
    procedure :: check        !! required keys and ranges
    procedure :: check_required
    procedure :: by_law       !! text that names the laws that have a key
    procedure :: is_replaced  !! whether another group stands in the place of a group
    procedure :: is_used      !! whether the selected law has this key
    procedure :: check_range  !! range of one key
    procedure :: refuse       !! note an error of a value
    procedure :: refuse_file  !! note an error of the file that a key names
    procedure, private :: named
    procedure :: refuse_group !! note that a group must not be given
    procedure, private :: at
    procedure :: forbid       !! the same if a condition holds
    procedure :: demand       !! the same for a value that is missing or 0
    procedure :: place_in_file   !! line of a value
    procedure :: is_given
    procedure :: law_group    !! group in which a law of a joint is given
  end type case_values_t

contains

  !> Set every key of the schema to its default, and every group to absent.
  subroutine set_defaults(self, file)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: file
    integer :: i
    self%file = printable(file, 200)
    allocate (self%is_present(size(self%groups)), source=.false.)
    allocate (self%line(size(self%groups)), source=behind_file)
    allocate (self%values(size(self%keys)))
    do i = 1, size(self%keys)
      call set_to_default(self%keys(i), self%values(i))
    end do
  end subroutine set_defaults

  !> Remove a group and all values given for it so far, as if the file did not contain it. `at` names the origin of the request in
  !> messages.
  subroutine remove_group(self, name, at, error)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: name, at
    type(error_t), allocatable, intent(out) :: error
    integer :: group, i
    group = find_group(self%groups, name)
    if (group == 0) then
      call self%find(name, '', at, i, error)
      return
    end if
    self%is_present(group) = .false.
    do i = 1, size(self%keys)
      if (self%keys(i)%group == name) call set_to_default(self%keys(i), self%values(i))
    end do
  end subroutine remove_group

  !> Let keys set by overrides replace keys of the same family that the file sets.
  subroutine prefer_overrides(self)
    class(case_values_t), intent(inout) :: self
    integer :: i
    do i = 1, size(self%keys)
      if (self%keys(i)%family == '' .or. .not. self%values(i)%is_override) cycle
      if (self%is_said(i)) call self%prefer(i)
    end do
  end subroutine prefer_overrides

  !> Let the key at `place` replace those of its family that no override sets. A key that is allowed beside it is kept if the file
  !> sets both.
  subroutine prefer(self, place)
    class(case_values_t), intent(inout) :: self
    integer, intent(in) :: place
    integer :: i
    do i = 1, size(self%keys)
      if (i == place .or. self%values(i)%is_override .or. .not. is_relative(self%keys(i), self%keys(place))) cycle
      if (self%values(place)%replaces .and. may_stand_beside(self%keys(i), self%keys(place))) cycle
      call set_to_default(self%keys(i), self%values(i))
    end do
  end subroutine prefer

  !> Check that exactly one key of the family of this key is given, or two that are allowed together. A key set to its default, 0,
  !> counts as not given.
  subroutine check_family(self, group, name)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    character(len=:), allocatable :: others, earlier
    integer :: place, i, k, first, last
    logical :: is_ended
    place = self%place_of(group, name)
    is_ended = .false.
    others = 'this'
    associate (range => self%groups(find_group(self%groups, group)))
      first = range%first
      last = range%last
    end associate
    do i = first, last
      if (.not. is_relative(self%keys(i), self%keys(place))) cycle
      if (i /= place) others = others//' or '//trim(self%keys(i)%name)
      if (.not. self%is_said(i)) cycle
      is_ended = .true.
      do k = first, i - 1
        if (.not. is_relative(self%keys(k), self%keys(i)) .or. may_stand_beside(self%keys(k), self%keys(i))) cycle
        if (.not. self%is_said(k)) cycle
        earlier = trim(self%keys(k)%name)
        call self%refuse(group, trim(self%keys(i)%name), 'must not be given together with '//earlier//' = '// &
          trim(self%values(k)%written(1))//'; '//group//'.'//earlier//'='//short_default(self%keys(k))//' takes that back', &
          unit='')
        return
      end do
    end do
    if (.not. is_ended) call self%refuse(group, name, others//' is required, > 0')
  end subroutine check_family

  !> A default as a user would write it: 0 for 0.0.
  pure function short_default(key) result(text)
    type(key_t), intent(in) :: key
    character(len=:), allocatable :: text
    text = trim(key%default)
    if (text == '0.0') text = '0'
  end function short_default

  !> Whether two keys belong to one family, or are the same key.
  pure logical function is_relative(key, other)
    type(key_t), intent(in) :: key, other
    is_relative = key%family == other%family .and. key%family /= '' .and. key%group == other%group
  end function is_relative

  !> Whether two keys of a family are allowed together.
  pure logical function may_stand_beside(key, other)
    type(key_t), intent(in) :: key, other
    may_stand_beside = key%beside == other%name .or. other%beside == key%name
  end function may_stand_beside

  !> Whether a number is given that differs from the default of its key.
  logical function is_said(self, place)
    class(case_values_t), intent(in) :: self
    integer, intent(in) :: place
    integer :: element
    is_said = .false.
    do element = 1, most_reals
      if (.not. self%values(place)%given(element)) cycle
      is_said = .not. is_default(self%keys(place), self%values(place), element)
      if (is_said) return
    end do
  end function is_said

  !> Index of a key in the table; 0 if there is none.
  pure integer function place_of(self, group, key)
    class(case_values_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer :: at
    at = find_group(self%groups, group)
    place_of = 0
    if (at > 0) place_of = find_key(self%keys, self%groups(at), key)
  end function place_of

  !> The index of a key, or an error that lists what exists instead. `at` names file and line. With `element` the name may be that
  !> of a number of a list, KEY[2] or KEY(2): its index, 0 without one.
  subroutine find(self, group, key, at, place, error, element)
    class(case_values_t), intent(in) :: self
    character(len=*), intent(in) :: group, key, at
    integer, intent(out) :: place
    type(error_t), allocatable, intent(out) :: error
    integer, intent(out), optional :: element
    character(len=name_length), allocatable :: names(:)
    character(len=:), allocatable :: name, text, near
    integer :: i
    near = ''
    name = key
    if (present(element)) then
      element = 0
      name = without_number(key)
    end if
    place = self%place_of(group, trim(name))
    if (place > 0) then
      if (len(name) < len(key)) call find_element(self%keys(place), key(len(name) + 1:), element, text)
      if (allocated(text)) call fail(error, at//shown_group(group)//' '//printable(key, 40)//': '//text, status_case_file)
      return
    end if
    if (find_group(self%groups, group//'_1') > 0) then
      call fail(error, at//'&'//group//': there may be several: '//group//'_1.'//trim(printable(key, 40))// &
        ' is that of the first one', status_case_file)
      return
    end if
    if (find_group(self%groups, group) == 0) then
      names = [character(len=name_length) :: (self%groups(i)%name, i=1, size(self%groups))]
      near = nearest_word(group, names)
      if (near /= '') near = '; did you mean '//near//'?'
      call fail(error, at//'&'//printable(group, 40)//': unknown group'//near// &
        allowed(group_names(self%groups)), status_case_file)
      return
    end if
    text = shown_group(group)//' '//printable(key, 40)//': unknown key'
    i = findloc(self%keys%name == key, .true., 1)
    if (i > 0) text = text//' of this group; it belongs to '//shown_group(trim(self%keys(i)%group))
    call self%list_keys(group, names)
    near = nearest_word(key, names)
    if (near /= '' .and. i == 0) text = text//'; did you mean '//near//'?'
    call fail(error, at//text//allowed(names), status_case_file)
  end subroutine find

  !> The index of a number of a list from its brackets, such as `[2]`; `wanted` says what is allowed instead.
  pure subroutine find_element(key, text, element, wanted)
    type(key_t), intent(in) :: key
    character(len=*), intent(in) :: text
    integer, intent(out) :: element
    character(len=:), allocatable, intent(out) :: wanted
    call read_integer(text(2:len(text) - 1), element, wanted)
    if (allocated(wanted) .or. verify(text(len(text):), ')]') > 0 .or. element < 1 .or. element > key%count) &
      wanted = 'has the numbers '//trim(key%name)//'[1] to '//trim(key%name)//'['//integer_text(key%count)//']'
    if (key%kind /= real_kind .or. key%count == 1) wanted = trim(key%name)//' is no list of numbers'
  end subroutine find_element

  !> The names of the keys of a group.
  pure subroutine list_keys(self, group, names)
    class(case_values_t), intent(in) :: self
    character(len=*), intent(in) :: group   !! a group of the table
    character(len=name_length), allocatable, intent(out) :: names(:)
    integer :: i
    associate (range => self%groups(find_group(self%groups, group)))
      allocate (names(range%last - range%first + 1))
      do i = 1, size(names)
        names(i) = self%keys(range%first + i - 1)%name
      end do
    end associate
  end subroutine list_keys

  !> Count the key of a group that a misspelt name probably means as given, so that it is not demanded too.
  subroutine count_as_given(self, group, misspelt)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: group, misspelt
    character(len=name_length), allocatable :: names(:)
    integer :: place
    if (find_group(self%groups, group) == 0) return
    call self%list_keys(group, names)
    place = self%place_of(group, nearest_word(misspelt, names))
    if (place > 0) self%values(place)%given = .true.
  end subroutine count_as_given

  !> Give a key of a group the values of an entry of the file; `at` names file and line. What is wrong is noted.
  subroutine give(self, group, entry, at)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: group, at   !! group with its place
    type(entry_t), intent(in) :: entry
    type(error_t), allocatable :: error
    integer :: place
    call self%find(group, entry%key, at, place, error)
    if (allocated(error)) then
      call self%count_as_given(group, entry%key)
    else
      call self%assign(place, entry%index, entry%tokens, at, .false., error)
      self%values(place)%line = entry%line
      if (allocated(error) .and. self%keys(place)%kind == word_kind) self%problems%is_structural = .true.
    end if
    call self%problems%add_error(error, group, entry%line)
  end subroutine give

  !> Give the key at `place` its values as written, from element `index` on; 0 means all elements. An override replaces the value of
  !> the file; within the file an element may be given once. `at` names file and line.
  subroutine assign(self, place, index, tokens, at, is_override, error)
    class(case_values_t), intent(inout) :: self
    integer, intent(in) :: place, index
    type(token_t), intent(in) :: tokens(:)
    character(len=*), intent(in) :: at
    logical, intent(in) :: is_override
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: wanted, name
    integer :: i, k, element, total, first, before
    first = max(1, index)
    associate (key => self%keys(place), value => self%values(place))
      name = at//shown_group(trim(key%group))//' '//trim(key%name)
      total = sum([(tokens(i)%repeat, i=1, size(tokens))]) + first - 1
      if (total > key%count) wanted = 'takes '//integer_text(key%count)//' value'//trim(merge('s', ' ', key%count > 1))// &
        ', not '//integer_text(total)
      if (total < key%count .and. index == 0 .and. key%kind == real_kind .and. .not. key%is_list) wanted = 'takes '// &
        integer_text(key%count)//' values; as '//integer_text(key%count)//'*'//printable(tokens(1)%text, 40)// &
        ' where they are the same'
      if (index > 0 .and. key%count == 1) wanted = 'takes no index'
      if (index > 1 .and. key%kind == text_kind) wanted = 'takes an index that begins with 1'
      if (index > 1 .and. key%is_list .and. .not. allocated(wanted)) then
        if (.not. value%given(index - 1)) wanted = 'number '//integer_text(index - 1)//' must be given before'
      end if
      if (key%kind == real_kind) call find_decimal_comma(tokens, merge(size(tokens), key%count, key%is_list), wanted)
      if (key%kind == real_kind .and. .not. allocated(wanted)) call compare_units(tokens, name, wanted)
      if (allocated(wanted)) then
        value%given = .true.   ! but unreadable: it is not demanded too
        call fail(error, name//': '//wanted, status_case_file)
        return
      end if
      element = first
      before = merge(value%whole, 0, index > 0)
      if (is_override .and. .not. value%is_override) value%replaces = self%is_said(place)
      if (key%count > most_reals) value%text = ''
      do i = 1, size(tokens)
        do k = 1, tokens(i)%repeat
          if (value%given(min(element, most_reals)) .and. .not. is_override .and. element <= most_reals) then
            call fail(error, name//': given twice', status_case_file)
            return
          end if
          call convert(key, tokens(i), value, element, wanted)
          if (allocated(wanted)) then
            value%given = .true.   ! but unreadable: it is not demanded too
            call fail(error, name//' = '//printable(tokens(i)%text, 48)//': '//wanted, status_case_file)
            return
          end if
          value%given(min(element, most_reals)) = .true.
          value%written(min(element, most_reals)) = printable(tokens(i)%text, 45)
          if (value%has_unit) value%written(element) = trim(value%written(element))//' ('//short_text(value%reals(element))//')'
          value%is_override = is_override
          element = element + 1
        end do
      end do
      if (key%is_list) value%whole = max(value%whole, before)   ! a list keeps the numbers behind this one
    end associate
  end subroutine assign

  !> Demand a unit for each number of a list or for none.
  subroutine compare_units(tokens, name, wanted)
    type(token_t), intent(in) :: tokens(:)
    character(len=:), allocatable, intent(inout) :: name     !! followed by the list, if that is wrong
    character(len=:), allocatable, intent(inout) :: wanted
    character(len=:), allocatable :: list
    integer :: i
    if (size(tokens) < 2) return
    if (all([(has_unit(tokens(i)%text), i=1, size(tokens))] .eqv. has_unit(tokens(1)%text))) return
    list = printable(tokens(1)%text, 20)
    do i = 2, size(tokens)
      list = list//', '//printable(tokens(i)%text, 20)
    end do
    name = name//' = '//list
    wanted = 'a unit for '//trim(merge('both numbers or for neither', 'all numbers or for none    ', size(tokens) == 2))
  end subroutine compare_units

  !> Give the key at `place` the values in a text, or its number `element` one value, as an override. A key that is a text takes it
  !> unchanged; without `is_plain` it may also be in quotes.
  subroutine assign_text(self, place, element, text, is_plain, at, error)
    class(case_values_t), intent(inout) :: self
    integer, intent(in) :: place, element   !! element: 0: all
    character(len=*), intent(in) :: text, at
    logical, intent(in) :: is_plain
    type(error_t), allocatable, intent(out) :: error
    type(token_t), allocatable :: tokens(:)
    character(len=:), allocatable :: message
    if (self%keys(place)%kind == text_kind .and. (is_plain .or. verify(text//' ', '''"') == 1)) then
      allocate (tokens(1))
      tokens(1)%text = text
    else
      call read_values(text, tokens, message)
    end if
    if (element > 0 .and. .not. allocated(message)) then
      if (sum(tokens%repeat) > 1) message = 'takes 1 value, not '//integer_text(sum(tokens%repeat))
    end if
    if (allocated(message)) then
      call fail(error, at//message, status_case_file)
    else
      call self%assign(place, element, tokens, at, .true., error)
    end if
  end subroutine assign_text

  !> Check that required keys are given, that all numbers are in their ranges, and that no key is given that only another law has.
  subroutine check(self)
    class(case_values_t), intent(inout) :: self
    integer :: i, group
    do i = 1, size(self%keys)
      group = find_group(self%groups, trim(self%keys(i)%group))
      if (self%groups(group)%is_model .and. .not. self%is_present(group)) cycle
      if (self%is_used(i)) then
        if (.not. self%problems%is_incomplete) call self%check_required(i)
        call self%check_range(i)
      else if (self%keys(i)%only_here) then   ! other keys of the group may belong to other laws
        associate (key => self%keys(i))
          if (self%is_said(i)) call self%refuse(trim(key%group), trim(key%name), 'is for '//key%choice//' = '''//key%laws// &
            ''' alone and must not be given with '''//self%values(self%place_of(trim(key%group), key%choice))%text//'''')
        end associate
      end if
    end do
  end subroutine check

  !> Check that the key at `place` is given if its group is present and requires it.
  subroutine check_required(self, place)
    class(case_values_t), intent(inout) :: self
    integer, intent(in) :: place
    integer :: group
    associate (key => self%keys(place))
      if (.not. key%required .or. self%values(place)%given(1)) return
      group = find_group(self%groups, trim(key%group))
      if (self%is_replaced(group)) return
      if (self%is_present(group)) then
        call self%refuse(trim(key%group), trim(key%name), 'required'//self%by_law(key))
      else if (.not. (self%groups(group)%is_model .or. self%problems%concerns(''))) then
        call self%problems%add(self%file//': '//shown_group(trim(key%group))//': this group is required', trim(key%group), &
          missing_key)
      end if
    end associate
  end subroutine check_required

  !> Whether the case has another group instead of this required one.
  pure logical function is_replaced(self, group)
    class(case_values_t), intent(in) :: self
    integer, intent(in) :: group   !! index in the table
    is_replaced = .not. self%groups(group)%is_model .and. &
      any(self%is_present .and. self%groups%instead_of == self%groups(group)%name)
  end function is_replaced

  !> Whether the selected model has the key at `place`; a group may also contain keys of other laws.
  pure logical function is_used(self, place)
    class(case_values_t), intent(in) :: self
    integer, intent(in) :: place
    is_used = .true.
    associate (key => self%keys(place))
      if (allocated(key%laws)) is_used = is_listed(self%values(self%place_of(trim(key%group), key%choice))%text, key%laws)
    end associate
  end function is_used

  !> Text that names the laws that have a key which not all laws of its group have.
  pure function by_law(self, key) result(text)
    class(case_values_t), intent(in) :: self
    type(key_t), intent(in) :: key
    character(len=:), allocatable :: text
    text = ''
    if (.not. allocated(key%laws)) return
    associate (choice => self%place_of(trim(key%group), key%choice))
      if (key%laws /= self%keys(choice)%words) text = ' with '//key%choice//' = '''//self%values(choice)%text//''''
    end associate
  end function by_law

  !> Check that the numbers of the key at `place` are in its range, or equal its default.
  subroutine check_range(self, place)
    class(case_values_t), intent(inout) :: self
    integer, intent(in) :: place
    integer :: element
    associate (key => self%keys(place), value => self%values(place))
      if (key%kind > integer_kind .or. key%required .and. value%written(1) == '') return   ! not given, or unreadable
      do element = 1, n_values(key, value)
        if (value%given(element) .and. value%written(element) == '') cycle   ! unreadable
        if (is_within(merge(value%reals(element), real(value%whole, dp), key%kind == real_kind), key%range)) cycle
        if (is_default(key, value, element)) cycle
        call self%refuse(trim(key%group), trim(key%name), 'must be '//trim(key%range), element)
        return
      end do
    end associate
  end subroutine check_range

  !> Text that guesses the unit of a real that is not of a usual size.
  pure function meant(key, value) result(text)
    type(key_t), intent(in) :: key
    real(dp), intent(in) :: value
    character(len=:), allocatable :: text
    real(dp) :: least, most
    text = ''
    if (key%usual == '' .or. .not. abs(value) > 0 .or. value < 0 .and. key%unit /= 'degrees') return
    call read_bounds(trim(key%usual), least, most)
    if (abs(value) < least .or. abs(value) > most) text = likely_unit(trim(key%unit), value, least, most)
  end function meant

  !> Note an error of a value: file, line if it is given there, group, key, value as written, allowed values, unit.
  subroutine refuse(self, group, name, wanted, element, unit)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name, wanted
    integer, intent(in), optional :: element
    character(len=*), intent(in), optional :: unit   !! instead of the unit of the key in parentheses
    character(len=:), allocatable :: text
    integer :: place, shown
    place = self%place_of(group, name)
    shown = 1
    if (present(element)) shown = element
    text = self%named(group, name)
    if (self%keys(place)%count > 1 .and. self%keys(place)%kind == real_kind) text = text//'('//integer_text(shown)//')'
    if (self%values(place)%given(shown)) text = text//' = '//trim(self%values(place)%written(shown))
    text = text//': '//wanted
    if (present(unit)) then
      text = text//unit
    else
      text = text//unit_of(self%keys(place))
      if (.not. self%values(place)%has_unit) &
        text = text//meant(self%keys(place), self%values(place)%reals(min(shown, most_reals)))
    end if
    call self%problems%add(text, group, merge(missing_key, self%place_in_file(place), index(wanted, 'required') == 1))
  end subroutine refuse

  !> Note an error of the file that a key names; the error is then deallocated.
  subroutine refuse_file(self, group, name, error)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    type(error_t), allocatable, intent(inout) :: error
    error%message = self%named(group, name)//': '//error%message
    call self%problems%add_error(error, group, self%place_in_file(self%place_of(group, name)))
  end subroutine refuse_file

  !> `file:line: &group key`, or `file: &group key` for a key that the file does not give.
  pure function named(self, group, name) result(text)
    class(case_values_t), intent(in) :: self
    character(len=*), intent(in) :: group, name
    character(len=:), allocatable :: text
    text = self%at(self%values(self%place_of(group, name))%line)//shown_group(group)//' '//name
  end function named

  !> Note that a group must not be given.
  subroutine refuse_group(self, name, why)
    class(case_values_t), intent(inout) :: self
    character(len=*), intent(in) :: name, why
    integer :: line
    line = self%line(find_group(self%groups, name))
    call self%problems%add(self%at(line)//shown_group(name)//': '//why, name, line)
  end subroutine refuse_group

  !> `file:line: `, or `file: ` for what is not in the file.
  pure function at(self, line)
    class(case_values_t), intent(in) :: self
    integer, intent(in) :: line
    character(len=:), allocatable :: at
    at = self%file//': '
    if (line > 0 .and. line < behind_file) at = self%file//':'//integer_text(line)//': '
  end function at

  !> Line of the file on which the key at `place` is given, or else on which its group begins.
  pure integer function place_in_file(self, place)
    class(case_values_t), intent(in) :: self
    integer, intent(in) :: place
    place_in_file = self%values(place)%line
    if (place_in_file == 0) place_in_file = self%line(find_group(self%groups, trim(self%keys(place)%group)))
  end function place_in_file

  !> Note an error of a value if it is wrong.
  subroutine forbid(self, is_wrong, group, name, wanted)
    class(case_values_t), intent(inout) :: self
    logical, intent(in) :: is_wrong
    character(len=*), intent(in) :: group, name, wanted
    if (is_wrong) call self%refuse(group, name, wanted)
  end subroutine forbid

  !> Note an error of a number that is missing, or given as 0. `why` says when it is required.
  subroutine demand(self, is_met, group, name, why)
    class(case_values_t), intent(inout) :: self
    logical, intent(in) :: is_met
    character(len=*), intent(in) :: group, name, why
    if (is_met) return
    if (self%is_given(group, name)) then
      call self%refuse(group, name, 'must be > 0')
    else
      call self%refuse(group, name, trim('required '//why))
    end if
  end subroutine demand

  !> Whether a key is set in the file or by an override.
  pure logical function is_given(self, group, name) result(given)
    class(case_values_t), intent(in) :: self
    character(len=*), intent(in) :: group, name
    given = any(self%values(self%place_of(group, name))%given)
  end function is_given

  !> Name of the group in which a law of the joint at a place is given.
  function law_group(self, name, place) result(group)
    class(case_values_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: place   !! index in `places`
    character(len=:), allocatable :: group
    group = trim(places(place)%name)//'.'//name
    if (.not. self%is_present(find_group(self%groups, group))) group = name
  end function law_group
end module case_values
