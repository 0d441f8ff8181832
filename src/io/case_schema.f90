!> The table of all groups and keys of case files, with their kinds, defaults, limits and units. It is collected from the models,
!> each of which declares its parameters beside the components that hold them (`parameters`). Ranges and lists of words are texts,
!> which are shown to the user unchanged. The default of a key is allowed even outside its range, and then means "not given".
module case_schema
  use kinds, only: dp
  use model_parameters, only: parameter_list_t, law_t, key_t, real_kind, integer_kind, logical_kind, word_kind, text_kind
  use text_tools, only: integer_text
  use joint_places, only: places, in_order
  use case_definition, only: case_t, visit_case
  implicit none
  private
  public :: key_t, group_definition_t, key_table_t, schema_t, case_schema_of, find_key, find_group, is_listed, is_group_of_cases
  public :: group_names, shown_group, without_number, name_in_file, is_first_of_name, is_apart, real_kind, integer_kind, &
    logical_kind, word_kind, text_kind

  !> A group. The group of an optional model may be missing in a case; its model is then absent from the scene.
  type :: group_definition_t
    character(len=32) :: name = ''        !! with its place as a prefix unless it is the first place: crank_pin.contact
    character(len=12) :: place = ''       !! place of the joint to which it belongs
    logical :: is_law = .false.           !! group of a law, valid for every joint that has no such group of its own
    logical :: is_model = .false.
    character(len=24) :: instead_of = ''  !! group that a case cannot have together with this one
    character(len=250) :: description = ''
    integer :: number = 0                 !! of a group that may be repeated, and end of its name: cylinder_3; 0: it may not
    integer :: first = 1, last = 0        !! range of its keys in the table
  end type group_definition_t

  !> All groups and keys of a kind of file.
  type :: key_table_t
    type(group_definition_t), allocatable :: groups(:)
    type(key_t), allocatable :: keys(:)
    character(len=:), allocatable :: difference   !! a shared key that laws describe differently, which is a defect of the program
  end type key_table_t

  !> A visitor that collects groups and keys. Laws of one group may share a key, which must then have the same meaning in all of
  !> them.
  type, extends(parameter_list_t) :: schema_t
    private
    type(group_definition_t), allocatable :: groups(:)
    type(key_t), allocatable :: keys(:)
    integer :: n_groups = 0, n_keys = 0
    integer :: present_choice = 0              !! index of the key that names the law being collected; 0: none
    character(len=:), allocatable :: law_name, difference
  contains
    procedure :: begin
    procedure :: get_table
    procedure :: visit => collect
    procedure :: group => collect_group
    procedure :: choice => collect_choice
    procedure :: law => collect_law
  end type schema_t

contains

  !> Groups and keys of a case file, in the order of the template and of the resolved case. Without `repeats` only the first of
  !> groups that may be repeated.
  subroutine case_schema_of(table, repeats)
    type(key_table_t), intent(out) :: table
    logical, intent(in), optional :: repeats
    type(schema_t) :: schema
    type(case_t) :: case
    call schema%begin()
    if (present(repeats)) schema%repeats = repeats
    call visit_case(case, schema)
    call add_laws_of_one_joint(schema)
    call schema%get_table(table)
  end subroutine case_schema_of

  !> Initialise the visitor.
  subroutine begin(self)
    class(schema_t), intent(inout) :: self
    allocate (self%groups(110), self%keys(1500))
    self%law_name = ''
    self%difference = ''
  end subroutine begin

  !> Return the collected groups and keys.
  subroutine get_table(self, table)
    class(schema_t), intent(in) :: self
    type(key_table_t), intent(out) :: table
    table%groups = self%groups(:self%n_groups)
    table%keys = self%keys(:self%n_keys)
    table%difference = self%difference
  end subroutine get_table

  !> Whether case files have a group of this name.
  logical function is_group_of_cases(name)
    character(len=*), intent(in) :: name
    type(key_table_t) :: table
    call case_schema_of(table)
    is_group_of_cases = find_group(table%groups, name) > 0
  end function is_group_of_cases

  !> Add the groups of laws that are valid for the first joint alone: copies of the groups that are valid for every joint.
  subroutine add_laws_of_one_joint(schema)
    type(schema_t), intent(inout) :: schema
    type(key_t) :: key
    integer :: i, j, n_groups
    n_groups = schema%n_groups
    do i = 1, n_groups
      if (schema%groups(i)%place /= places(in_order(1))%name .or. .not. schema%groups(i)%is_model) cycle
      schema%n_groups = schema%n_groups + 1
      associate (shared => schema%groups(i), own => schema%groups(schema%n_groups))
        own = shared
        own%name = trim(places(in_order(1))%name)//'.'//trim(shared%name)
        own%first = schema%n_keys + 1
        own%last = schema%n_keys + 1 + shared%last - shared%first
        shared%place = ''
        shared%is_law = .true.
        do j = shared%first, shared%last
          key = schema%keys(j)
          call add_key(schema, key, own%name)
        end do
      end associate
    end do
  end subroutine add_laws_of_one_joint

  !> The name of a group in messages: &contact, or &contact of crank_pin.
  pure function shown_group(name) result(text)
    character(len=*), intent(in) :: name   !! as in the table
    character(len=:), allocatable :: text
    integer :: dot
    dot = index(name, '.')
    text = '&'//trim(name(dot + 1:))
    if (dot > 0) text = text//' of '//name(:dot - 1)
  end function shown_group

  !> The name of a key, or of the key of a number of a list: KEY of KEY[2] or KEY(2).
  pure function without_number(name) result(key)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: key
    key = name(:scan(name//'[', '[(') - 1)
  end function without_number

  !> The name of a group in a case file, without place or number.
  pure function name_in_file(group) result(name)
    type(group_definition_t), intent(in) :: group
    character(len=:), allocatable :: name
    name = trim(group%name(index(group%name, '.') + 1:))
    if (group%number > 0) name = name(:index(name, '_', back=.true.) - 1)
  end function name_in_file

  !> Whether no group before this one has its name in a case file.
  pure logical function is_first_of_name(group)
    type(group_definition_t), intent(in) :: group
    is_first_of_name = index(group%name, '.') == 0 .and. group%number <= 1
  end function is_first_of_name

  !> Whether a group has the name of another one but keys of its own: it belongs to a place that is no joint, rings.lubrication.
  pure logical function is_apart(group)
    type(group_definition_t), intent(in) :: group
    is_apart = group%place == '' .and. index(group%name, '.') > 0
  end function is_apart

  !> The names of groups as in a case file, each once.
  pure function group_names(groups) result(names)
    type(group_definition_t), intent(in) :: groups(:)
    character(len=len(groups%name)), allocatable :: names(:)
    integer :: i
    names = [character(len=len(names)) :: (name_in_file(groups(i)), i=1, size(groups))]
    names = pack(names, [(is_first_of_name(groups(i)), i=1, size(groups))])
  end function group_names

  !> Collect a group. The groups of the second joint are separate groups, all of them optional.
  subroutine collect_group(self, name, says, is_model, place, instead_of, number)
    class(schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    logical, intent(in) :: is_model
    character(len=*), intent(in), optional :: place, instead_of
    integer, intent(in), optional :: number
    self%n_groups = self%n_groups + 1
    associate (group => self%groups(self%n_groups))
      group = group_definition_t(name=name, is_model=is_model, description=says, first=self%n_keys + 1, last=self%n_keys)
      if (present(instead_of)) group%instead_of = instead_of
      if (present(place)) then
        group%place = place
        if (place /= places(in_order(1))%name) then
          group%name = place//'.'//name
          group%is_model = .true.
        end if
      end if
      if (present(number)) then
        group%number = number
        group%name = name//'_'//integer_text(number)
      end if
    end associate
    self%present_choice = 0
    self%law_name = ''
  end subroutine collect_group

  subroutine collect_choice(self, key, default, says)
    class(schema_t), intent(inout) :: self
    character(len=*), intent(in) :: key, default, says
    self%law_name = ''
    call self%visit(key_t(name=key, kind=word_kind, description=says, default=default, words=''))
    self%present_choice = self%n_keys
  end subroutine collect_choice

  !> Add the name of a law to the words of its choice, and collect its keys.
  subroutine collect_law(self, name, law, variant)
    class(schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    class(law_t), intent(in) :: law
    character(len=*), intent(in), optional :: variant
    class(law_t), allocatable :: copy
    self%law_name = name
    call add_word(self%keys(self%present_choice)%words, self%law_name)
    allocate (copy, source=law)
    call copy%parameters(self)
  end subroutine collect_law

  !> Collect a key. If an earlier law of the group has the same key, only the present law is added to it.
  subroutine collect(self, key, reals, whole, switch, text)
    class(schema_t), intent(inout) :: self
    type(key_t), intent(in) :: key
    real(dp), intent(inout), optional :: reals(:)
    integer, intent(inout), optional :: whole
    logical, intent(inout), optional :: switch
    character(len=:), allocatable, intent(inout), optional :: text
    integer :: place
    place = find_key(self%keys, self%groups(self%n_groups), trim(key%name))
    if (place == 0) then
      call add_key(self, key, self%groups(self%n_groups)%name)
      place = self%n_keys
      self%groups(self%n_groups)%last = place
      if (self%law_name /= '') then
        self%keys(place)%choice = trim(self%keys(self%present_choice)%name)
        self%keys(place)%laws = ''
      end if
    else if (.not. same_meaning(self%keys(place), key)) then
      self%difference = trim(self%keys(place)%group)//'.'//trim(key%name)
    end if
    if (self%law_name == '') return
    call add_word(self%keys(place)%laws, self%law_name)
    if (self%keys(place)%default /= key%default) self%keys(place)%default = ''   ! the default depends on the law
    if (key%kind /= word_kind) return
    call add_words(self%keys(place)%words, key%words)
  end subroutine collect

  !> Add a key of a group to the table, which is enlarged if it is full.
  subroutine add_key(self, key, group)
    class(schema_t), intent(inout) :: self
    type(key_t), intent(in) :: key
    character(len=*), intent(in) :: group
    if (self%n_keys == size(self%keys)) self%keys = [self%keys, self%keys]   ! more room
    self%n_keys = self%n_keys + 1
    self%keys(self%n_keys) = key
    self%keys(self%n_keys)%group = group
  end subroutine add_key

  !> Whether two laws give a key the same meaning. Its words and its default may differ for words, its default for switches.
  pure logical function same_meaning(a, b)
    type(key_t), intent(in) :: a, b
    same_meaning = a%kind == b%kind .and. a%count == b%count .and. (a%is_list .eqv. b%is_list) .and. &
      (a%required .eqv. b%required) .and. a%unit == b%unit .and. &
      a%range == b%range .and. a%usual == b%usual .and. &
      (a%default == b%default .or. a%kind == word_kind .or. a%kind == logical_kind)
  end function same_meaning

  !> Add the words of a list to another list.
  pure subroutine add_words(list, words)
    character(len=:), allocatable, intent(inout) :: list
    character(len=*), intent(in) :: words
    integer :: first, length
    first = 1
    do while (first <= len(words))
      length = index(words(first:)//',', ',') - 1
      call add_word(list, words(first:first + length - 1))
      first = first + length + 2
    end do
  end subroutine add_words

  !> Add a word to a list that does not contain it yet.
  pure subroutine add_word(list, word)
    character(len=:), allocatable, intent(inout) :: list
    character(len=*), intent(in) :: word
    if (list == '') then
      list = word
    else if (.not. is_listed(word, list)) then
      list = list//', '//word
    end if
  end subroutine add_word

  !> Whether a word is in a list whose words are separated by a comma and a blank.
  pure logical function is_listed(word, list)
    character(len=*), intent(in) :: word, list
    is_listed = word /= '' .and. scan(word, ' ,') == 0 .and. index(', '//list//',', ', '//word//',') > 0
  end function is_listed

  !> Index of a key of a group in the table; 0 if there is none.
  pure integer function find_key(keys, group, name) result(place)
    type(key_t), intent(in) :: keys(:)
    type(group_definition_t), intent(in) :: group
    character(len=*), intent(in) :: name
    character(len=1) :: letter
    letter = name
    do place = group%first, group%last
      if (keys(place)%name(1:1) /= letter) cycle   ! a fast test that excludes most of them
      if (is_named(keys(place)%name, name)) return
    end do
    place = 0
  end function find_key

  !> Index of a group in the table; 0 if there is none.
  pure integer function find_group(groups, name) result(place)
    type(group_definition_t), intent(in) :: groups(:)
    character(len=*), intent(in) :: name
    character(len=1) :: letter
    letter = name
    do place = size(groups), 1, -1
      if (groups(place)%name(1:1) /= letter) cycle
      if (is_named(groups(place)%name, name)) return
    end do
  end function find_group

  !> Whether a word, filled up with blanks, is `name`: several times as fast as the comparison of texts of different lengths.
  pure logical function is_named(word, name)
    character(len=*), intent(in) :: word, name
    if (len(name) >= len(word)) then
      is_named = word == name
    else
      is_named = word(:len(name)) == name
      if (is_named) is_named = word(len(name) + 1:len(name) + 1) == ' '
    end if
  end function is_named
end module case_schema
