!> The base case of a study with the values of one run. Everything is read and checked once; a run only converts its own values.
module study_case
  use kinds, only: dp
  use text_tools, only: integer_text
  use error_handling, only: error_t, fail, status_case_file
  use number_text, only: short_text
  use case_definition, only: case_t
  use model_parameters, only: integer_kind, word_kind
  use case_schema, only: key_t, find_group
  use case_values, only: case_values_t
  use case_file, only: complete_case
  use own_groups, only: enter_group
  use case_loader, only: load_case
  use case_rules, only: check_rules
  use case_notes, only: note_case
  use value_reader, only: read_value => convert, convert_list
  use namelist_reader, only: token_t
  implicit none
  private
  public :: study_case_t

  !> The values of the base case, modified for each run. Each process has its own copy.
  type :: study_case_t
    type(case_t) :: case                             !! case of the present run
    type(case_values_t) :: values                    !! its values, and all defaults
    integer, allocatable, private :: places(:)       !! indices of the parameters in the table of keys
    integer, allocatable, private :: elements(:)     !! numbers of lists that they are; 0: the whole key
    logical, allocatable, private :: groups(:)       !! groups that contain a parameter
    logical, allocatable :: is_number(:)             !! whether each parameter is one number, real or whole
    logical, allocatable :: is_whole(:)              !! whether each parameter is one whole number
    logical, private :: varies_words = .false.       !! a parameter is a word, which may name a law with keys of its own
  contains
    procedure :: prepare
    procedure :: set_values
    procedure :: set_number
    procedure :: load
    procedure :: remove_units
    procedure :: convert
    procedure, private :: key
    procedure :: check
  end type study_case_t

contains

  !> Read the values of a base case, which must be valid by itself, and find the keys of the parameters. Messages name the lines of
  !> the file where these keys are given. A key of a model that the base case does not have adds the model.
  subroutine prepare(self, values, path, keys, error, file, lines)
    class(study_case_t), intent(inout) :: self
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: path, keys(:)
    type(error_t), allocatable, intent(out) :: error
    character(len=*), intent(in), optional :: file
    integer, intent(in), optional :: lines(:)   !! given with `file`
    character(len=:), allocatable :: key, at
    integer :: i, k, dot

    self%values = values
    call complete_case(self%values, path, self%case, error)
    if (allocated(error)) return
    allocate (self%groups(size(values%groups)), source=.false.)
    allocate (self%places(size(keys)), self%elements(size(keys)), self%is_number(size(keys)), self%is_whole(size(keys)))
    self%values%values%is_override = .false.   ! the base case takes the place of the file, the parameters that of the overrides
    do i = 1, size(keys)
      key = trim(keys(i))
      at = ''
      if (present(file)) at = file//':'//integer_text(lines(i))//': '
      dot = index(key, '.', back=.true.)
      call values%find(key(:dot - 1), key(dot + 1:), at, self%places(i), error, self%elements(i))
      do k = 1, merge(0, i - 1, allocated(error))
        if (self%places(k) /= self%places(i)) cycle
        if (self%elements(k) == self%elements(i) .or. self%elements(k)*self%elements(i) == 0) &
          call fail(error, at//key//': is varied twice, also as '//trim(keys(k)), status_case_file)
      end do
      if (.not. allocated(error)) call enter_group(self%values, key(:dot - 1), key(dot:), at, error)
      if (allocated(error)) return
      associate (schema => values%keys(self%places(i)))
        self%varies_words = self%varies_words .or. schema%kind == word_kind
        self%is_number(i) = schema%kind <= integer_kind .and. (schema%count == 1 .or. self%elements(i) > 0)
        self%is_whole(i) = self%is_number(i) .and. schema%kind == integer_kind
        self%groups(find_group(values%groups, trim(schema%group))) = .true.
      end associate
      associate (value => self%values%values(self%places(i)))
        value%replaces = self%values%is_said(self%places(i))
        value%given(max(1, self%elements(i))) = .true.
        value%is_override = .true.
      end associate
    end do
    do i = 1, size(keys)   ! a parameter replaces the base case's values of other keys of its family
      if (values%keys(self%places(i))%family /= '') call self%values%prefer(self%places(i))
    end do
    call load_case(self%values, self%case, self%groups)
    call self%values%problems%clear()   ! of parameters without values
    do i = 1, size(values%keys)   ! keys of models that the parameters add
      if (self%values%is_used(i)) call self%values%check_required(i)
    end do
    call self%values%problems%report(error)
  end subroutine prepare

  !> Set the values of a run, without checking ranges. Error: see `convert`.
  subroutine set_values(self, texts, error)
    class(study_case_t), intent(inout) :: self
    character(len=*), intent(in) :: texts(:)
    type(error_t), allocatable, intent(out) :: error
    integer :: i
    call self%values%problems%clear()
    do i = 1, size(texts)
      call self%convert(i, trim(texts(i)), error)
      if (allocated(error)) return
    end do
    call self%load()
  end subroutine set_values

  !> Set a number of parameter i; `load` puts the numbers set since the last call into the case.
  pure subroutine set_number(self, i, element, number)
    class(study_case_t), intent(inout) :: self
    integer, intent(in) :: i, element   !! element: of an array, from 1 on
    real(dp), intent(in) :: number      !! whole where the key is
    associate (value => self%values%values(self%places(i)))
      value%reals(element) = number
      if (self%values%keys(self%places(i))%is_list) then
        value%whole = max(value%whole, element)
      else
        value%whole = nint(number)
      end if
      value%given(element) = .true.
      value%written(element) = short_text(number)
    end associate
  end subroutine set_number

  !> Put the values into the case.
  subroutine load(self)
    class(study_case_t), intent(inout) :: self
    call self%values%problems%clear()
    call load_case(self%values, self%case, self%groups)
  end subroutine load

  !> Replace numbers with units by numbers in the units of their keys, as the rows of the results have them, in values that
  !> `convert` accepts.
  subroutine remove_units(self, texts)
    class(study_case_t), intent(in) :: self
    character(len=*), intent(inout) :: texts(:)   !! of the parameters
    character(len=:), allocatable :: text, wanted
    integer :: i
    do i = 1, size(texts)
      if (.not. self%is_number(i)) cycle
      text = trim(texts(i))
      call convert_list(text, self%key(i), wanted)
      texts(i) = text
    end do
  end subroutine remove_units

  !> Convert the value of parameter i, which `set_values` sets in the case. Error: a text that is not a value of its key; the
  !> message does not name the key.
  subroutine convert(self, i, text, error)
    class(study_case_t), intent(inout) :: self
    integer, intent(in) :: i
    character(len=*), intent(in) :: text
    type(error_t), allocatable, intent(out) :: error
    type(token_t) :: token
    character(len=:), allocatable :: wanted
    integer :: element
    element = max(1, self%elements(i))
    associate (value => self%values%values(self%places(i)))
      if (self%is_number(i)) then
        token%text = text
        call convert_list(token%text, self%key(i), wanted)
        if (allocated(wanted)) wanted = wanted(index(wanted, ': ') + 2:)   ! without the text itself
        if (.not. allocated(wanted)) call read_value(self%key(i), token, value, element, wanted)
        value%written(element) = text
        if (allocated(wanted)) call fail(error, wanted, status_case_file)
      else
        call self%values%assign_text(self%places(i), 0, text, .true., '', error)
      end if
    end associate
  end subroutine convert

  !> The key of parameter i; one number if it is that of a list.
  pure type(key_t) function key(self, i)
    class(study_case_t), intent(in) :: self
    integer, intent(in) :: i
    key = self%values%keys(self%places(i))
    if (self%elements(i) == 0) return
    key%count = 1
    key%is_list = .false.
  end function key

  !> Check the ranges of the values set last and the rules between them, and put the notes on them into the case. An error concerns
  !> this run, not the study: the first one.
  subroutine check(self, error)
    class(study_case_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    integer :: i
    do i = 1, size(self%places)
      if (self%values%is_used(self%places(i))) call self%values%check_range(self%places(i))
    end do
    if (self%varies_words) call self%values%check()
    if (self%values%problems%n == 0) call check_rules(self%case, self%values)
    call self%values%problems%report(error)
    if (.not. allocated(error)) call note_case(self%case, self%values)
    if (allocated(error)) error%message = error%message(:index(error%message//achar(10), achar(10)) - 1)
  end subroutine check
end module study_case
