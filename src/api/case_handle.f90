!> A case that another program holds and changes, key by key. It is completed and checked when a run or its text is asked for.
module case_handle
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use checksums, only: checksum_t
  use text_tools, only: replaced, lowercase, integer_text
  use number_text, only: short_text
  use case_definition, only: case_t
  use case_schema, only: find_group, real_kind, integer_kind
  use case_values, only: case_values_t
  use run_state, only: run_state_t
  use value_reader, only: set_to_default
  use own_groups, only: enter_group
  use case_file, only: parse_values, apply_override, complete_case
  use case_text, only: resolved_text, value_text
  use accuracy_presets, only: with_preset, accuracy_levels
  use case_schema, only: is_listed
  use problem_list, only: behind_file
  use posix_files, only: absolute_path
  use trace_columns, only: column_list_t, choose_columns
  use study_case, only: study_case_t
  use c_texts, only: handle_t
  implicit none
  private
  public :: case_handle_t

  type, extends(handle_t) :: case_handle_t
    character(len=:), allocatable :: path          !! folder and name of the case, also in messages
    character(len=:), allocatable :: folder        !! files that the case names are in it; '': it may name none; '/': any
    type(case_values_t) :: values                  !! as given
    type(case_t) :: case                           !! complete, once `check` has found no error
    type(column_list_t) :: list                    !! its columns
    character(len=:), allocatable :: cache         !! see case_t
    type(run_state_t), allocatable :: start        !! motion with which runs begin; not allocated: as the case says
    logical, private :: is_checked = .false.
    integer, private :: status = 0                 !! of the last check
    character(len=:), allocatable, private :: reason   !! message of the last check
    type(case_values_t), private :: resolved       !! with all defaults, unless `varied` has them
    integer, allocatable, private :: numbers(:)    !! keys that have been set as numbers since the last change by a text
    type(study_case_t), allocatable, private :: varied   !! the case, which is complete but for the values of these keys
  contains
    procedure :: read
    procedure :: set
    procedure :: set_number
    procedure :: set_accuracy
    procedure :: check
    procedure :: get
    procedure :: number
    procedure :: is_given
    procedure :: text
    procedure :: set_cache
    procedure :: find_state
    procedure :: fingerprint
  end type case_handle_t

contains

  !> Read a case from its text. What is wrong is told by `check`.
  subroutine read(self, text, name, folder)
    class(case_handle_t), intent(inout) :: self
    character(len=*), intent(in) :: text, name, folder
    self%folder = folder
    self%path = name//'.nml'
    if (folder /= '') self%path = folder//'/'//self%path
    allocate (self%numbers(0))
    call parse_values(text, self%path, [character(len=1) ::], self%values, all_groups=.true.)
  end subroutine read

  !> Set GROUP.KEY, or a number GROUP.KEY[2] of it, to a value as a case file has it. Without a value, a key has its default again.
  !> GROUP alone is added, or removed if the value is 'none'. Error: no such key, or a text that is no value of it; the case is then
  !> unchanged.
  subroutine set(self, key, value, has_value, status)
    class(case_handle_t), intent(inout) :: self
    character(len=*), intent(in) :: key, value
    logical, intent(in) :: has_value
    integer, intent(out) :: status
    type(case_values_t) :: before
    type(error_t), allocatable :: error
    integer :: group, place, dot
    before = self%values
    group = find_group(self%values%groups, lowercase(key))
    dot = index(key, '.', back=.true.)
    if (group > 0 .and. value /= 'none') then
      call enter_group(self%values, lowercase(key), '', '', error)
    else if (has_value) then
      call apply_override(self%values, key//'='//value, behind_file, error)
      call settle(self%values)
    else
      call self%values%find(lowercase(key(:max(0, dot - 1))), lowercase(key(dot + 1:)), '', place, error)
      if (.not. allocated(error)) call set_to_default(self%values%keys(place), self%values%values(place))
    end if
    if (allocated(error)) then
      self%values = before
      error%message = replaced(error%message, '--set ', '')
    else
      call forget(self)
    end if
    call self%keep(error, status)
  end subroutine set

  !> Let values set last replace others of their family, and count as those of the file from then on.
  subroutine settle(values)
    type(case_values_t), intent(inout) :: values
    call values%prefer_overrides()
    values%values%is_override = .false.
    values%values%replaces = .false.
  end subroutine settle

  !> The case has changed by a text.
  subroutine forget(self)
    class(case_handle_t), intent(inout) :: self
    self%is_checked = .false.
    self%numbers = [integer ::]
    if (allocated(self%varied)) deallocate (self%varied)
  end subroutine forget

  !> Set a number without a text: the key by its index in the table, an element of it from 1 on. Error: a wrong index, or a number
  !> that is no value of it.
  subroutine set_number(self, key, element, value, status)
    class(case_handle_t), intent(inout) :: self
    integer, intent(in) :: key, element
    real(dp), intent(in) :: value
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    if (key < 1 .or. key > size(self%values%keys)) then
      call self%refuse('there is no key '//integer_text(key - 1)//', counted from 0', status)
      return
    end if
    associate (schema => self%values%keys(key), given => self%values%values(key))
      if (schema%kind > integer_kind .or. element < 1 .or. element > schema%count) then
        call self%refuse(trim(schema%group)//'.'//trim(schema%name)//' has no number '//integer_text(element - 1)// &
          ', counted from 0', status)
        return
      end if
      if (schema%is_list .and. element > 1) then
        if (.not. given%given(element - 1)) then
          call self%refuse(trim(schema%group)//'.'//trim(schema%name)//': number '//integer_text(element - 1)// &
            ' must be given before', status)
          return
        end if
      end if
      if (.not. is_allowed(value, schema%kind)) then
        call fail(error, trim(schema%group)//'.'//trim(schema%name)//' = '//short_text(value)// &
          trim(merge(': must be 0 or of a size from 1e-30 to 1e30', ': must be a whole number                   ', &
          schema%kind == real_kind)), status_case_file)
      end if
      if (.not. allocated(error)) call enter_group(self%values, trim(schema%group), '.'//trim(schema%name), '', error)
      call self%keep(error, status)
      if (allocated(error)) return
      given%reals(element) = value
      if (schema%kind == integer_kind) given%whole = nint(value)
      if (schema%is_list) given%whole = max(given%whole, element)
      given%given(element) = .true.
      given%written(element) = short_text(value)
      if (schema%family /= '') call self%values%prefer(key)
    end associate
    self%is_checked = .false.
    if (any(self%numbers == key)) then
      if (allocated(self%varied)) call self%varied%set_number(findloc(self%numbers, key, 1), element, value)
    else
      self%numbers = [self%numbers, key]
      if (allocated(self%varied)) deallocate (self%varied)
    end if
  end subroutine set_number

  !> Whether a number may be that of a key of this kind, as in a case file.
  pure logical function is_allowed(value, kind)
    real(dp), intent(in) :: value
    integer, intent(in) :: kind
    is_allowed = ieee_is_finite(value)
    if (.not. is_allowed) return
    if (kind == real_kind) then
      is_allowed = .not. abs(value) > 0 .or. abs(value) >= 1e-30_dp .and. abs(value) < 1e30_dp
    else
      is_allowed = abs(value) < huge(1) .and. .not. abs(value - anint(value)) > 0
    end if
  end function is_allowed

  !> Set the keys of an accuracy level of the command line.
  subroutine set_accuracy(self, level, status)
    class(case_handle_t), intent(inout) :: self
    character(len=*), intent(in) :: level
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    if (.not. is_listed(level, accuracy_levels)) then
      call fail(error, 'accuracy must be one of '//accuracy_levels, status_case_file)
      call self%keep(error, status)
      return
    end if
    call set_all(with_preset(level, [character(len=1) ::]))

  contains

    subroutine set_all(keys)
      character(len=*), intent(in) :: keys(:)   !! GROUP.KEY=VALUE
      integer :: i, equals
      do i = 1, size(keys)
        equals = index(keys(i), '=')
        call self%set(keys(i)(:equals - 1), trim(keys(i)(equals + 1:)), .true., status)
      end do
    end subroutine set_all
  end subroutine set_accuracy

  !> Complete and check the case, unless that has been done since its last change.
  subroutine check(self, status)
    class(case_handle_t), intent(inout) :: self
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    if (.not. self%is_checked) then
      if (allocated(self%varied)) then
        call self%varied%load()
        call self%varied%check(error)
        self%case = self%varied%case
      else if (size(self%numbers) > 0) then
        call vary(self, error)
      else
        call complete(self, error)
      end if
      if (allocated(self%cache)) self%case%cache = self%cache
      if (.not. allocated(error)) call find_columns(self%case, self%list, error)
      call self%keep(error, self%status)
      self%is_checked = .true.
      if (self%status /= 0) self%reason = self%message
    end if
    status = self%status
    if (status /= 0) self%message = self%reason
  end subroutine check

  !> The columns of a run; none if the case asks for 'none'.
  subroutine find_columns(case, list, error)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(inout) :: list
    type(error_t), allocatable, intent(out) :: error
    if (case%output%columns == 'none') then
      if (allocated(list%id)) deallocate (list%id)
      allocate (list%id(0))
    else
      call choose_columns(case, .false., list, error)
    end if
  end subroutine find_columns

  !> Complete the case as a whole.
  subroutine complete(self, error)
    class(case_handle_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    self%resolved = self%values
    call refuse_files(self, self%resolved)
    call self%resolved%problems%report(error)
    if (.not. allocated(error)) call complete_case(self%resolved, self%path, self%case, error)
  end subroutine complete

  !> Complete the case such that further values of the same numbers cost less.
  subroutine vary(self, error)
    class(case_handle_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    character(len=64) :: keys(size(self%numbers))
    integer :: i
    call complete(self, error)   ! tells everything that is wrong
    if (allocated(error)) return
    do i = 1, size(keys)
      associate (key => self%values%keys(self%numbers(i)))
        keys(i) = trim(key%group)//'.'//trim(key%name)
      end associate
    end do
    allocate (self%varied)
    call self%varied%prepare(self%values, self%path, keys, error)
    if (allocated(error)) deallocate (self%varied)
  end subroutine vary

  !> Note the files that a case must not name: those that are not in its folder, even if a link in it leads to them.
  subroutine refuse_files(self, values)
    class(case_handle_t), intent(in) :: self
    type(case_values_t), intent(inout) :: values
    integer :: i, first
    logical :: outside
    if (self%folder == '/') return
    do i = 1, size(values%keys)
      associate (key => values%keys(i), file => values%values(i)%text)
        if (.not. key%is_path .or. file == '') cycle
        first = 1
        if (index(file, self%folder//'/') == 1) first = len(self%folder) + 2
        outside = index(file(first:), '/') == 1 .or. index('/'//file//'/', '/../') > 0
        if (.not. outside) outside = leads_out()
        if (self%folder == '') then
          call values%refuse(trim(key%group), trim(key%name), 'must not be given: the case has no folder')
        else if (outside) then
          call values%refuse(trim(key%group), trim(key%name), 'must be a file in the folder of the case')
        end if
      end associate
    end do

  contains

    !> Whether the file, which is in the folder by its name, is outside it once links are followed.
    logical function leads_out()
      character(len=:), allocatable :: path, whole, folder
      path = self%folder//'/'//values%values(i)%text(first:)
      whole = absolute_path(path)
      folder = absolute_path(self%folder)//'/'
      leads_out = whole /= path .and. index(whole, folder) /= 1   ! it is the path if there is no file
    end function leads_out
  end subroutine refuse_files

  !> The value of GROUP.KEY, or of GROUP.KEY[2], as a case has it: with the defaults of the selected laws if the case is valid,
  !> otherwise as given. For a GROUP, 'present' or 'none'.
  subroutine get(self, key, value, status)
    class(case_handle_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    character(len=:), allocatable, intent(out) :: value
    integer, intent(out) :: status
    type(error_t), allocatable :: error
    integer :: group, place, element, dot
    value = ''
    group = find_group(self%values%groups, lowercase(key))
    if (group > 0) then
      value = trim(merge('present', 'none   ', self%values%is_present(group)))
      status = 0
      return
    end if
    dot = index(key, '.', back=.true.)
    call self%values%find(lowercase(key(:max(0, dot - 1))), lowercase(key(dot + 1:)), '', place, error, element)
    call self%keep(error, status)
    if (allocated(error)) return
    call self%check(status)
    if (status /= 0) then
      value = value_text(self%values%keys(place), self%values%values(place), element)
    else if (allocated(self%varied)) then
      value = value_text(self%values%keys(place), self%varied%values%values(place), element)
    else
      value = value_text(self%values%keys(place), self%resolved%values(place), element)
    end if
    status = 0
  end subroutine get

  !> The number of an element of a key, by its index in the table, as given. Error: there is none.
  subroutine number(self, key, element, value, status)
    class(case_handle_t), intent(inout) :: self
    integer, intent(in) :: key, element   !! from 1 on
    real(dp), intent(out) :: value
    integer, intent(out) :: status
    value = 0
    status = status_case_file
    if (key < 1 .or. key > size(self%values%keys)) return
    associate (schema => self%values%keys(key), at => self%values%values(key))
      if (schema%kind > integer_kind .or. element > schema%count) return
      status = 0
      value = merge(at%reals(element), real(at%whole, dp), schema%kind == real_kind)
    end associate
  end subroutine number

  !> Whether the case gives a key, by its index in the table.
  pure logical function is_given(self, key)
    class(case_handle_t), intent(in) :: self
    integer, intent(in) :: key
    is_given = .false.
    if (key >= 1 .and. key <= size(self%values%keys)) is_given = any(self%values%values(key)%given) .and. &
      self%values%is_present(find_group(self%values%groups, trim(self%values%keys(key)%group)))
  end function is_given

  !> The resolved case; empty if it is wrong.
  subroutine text(self, all)
    class(case_handle_t), intent(inout) :: self
    character(len=:), allocatable, intent(out) :: all
    integer :: status
    all = ''
    call self%check(status)
    if (status /= 0) return
    if (allocated(self%varied)) then
      all = resolved_text(self%varied%values)
    else
      all = resolved_text(self%resolved)
    end if
  end subroutine text

  !> A checksum of everything that the case says, and of where its files are.
  pure integer(int64) function fingerprint(self)
    class(case_handle_t), intent(in) :: self
    type(checksum_t) :: sum
    integer :: i
    call sum%add(self%folder)
    do i = 1, size(self%values%groups)
      call sum%add(merge('+', '-', self%values%is_present(i)))
    end do
    do i = 1, size(self%values%keys)
      associate (it => self%values%values(i), n => min(self%values%keys(i)%count, size(self%values%values(i)%reals)))
        call sum%add(merge('+', '-', it%switch)//it%text//transfer([real(it%whole, dp), it%reals(:n)], repeat(' ', 8*(n + 1))))
      end associate
    end do
    fingerprint = sum%sum
  end function fingerprint

  !> The number of the start, and its element, that has an index from 0 on. Error: there is none.
  subroutine find_state(self, i, number, element, status)
    class(case_handle_t), intent(inout) :: self
    integer, intent(in) :: i
    integer, intent(out) :: number, element, status
    element = i + 1
    if (allocated(self%start) .and. i >= 0) then
      status = 0
      do number = 1, size(self%start%numbers)
        if (element <= size(self%start%numbers(number)%values)) return
        element = element - size(self%start%numbers(number)%values)
      end do
    end if
    call self%refuse('there is no state '//integer_text(i)//', counted from 0', status)
  end subroutine find_state

  !> Keep film tables in a folder; with an empty name nowhere.
  subroutine set_cache(self, folder)
    class(case_handle_t), intent(inout) :: self
    character(len=*), intent(in) :: folder
    self%cache = folder
    if (self%is_checked) self%case%cache = folder
  end subroutine set_cache
end module case_handle
