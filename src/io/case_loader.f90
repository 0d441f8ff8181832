!> Builds a case from the values of a case file: a visitor that sets every parameter and selects the laws that the case names.
module case_loader
  use kinds, only: dp
  use text_tools, only: integer_text
  use model_parameters, only: parameter_list_t, has_parameters_t, law_t, key_t, word_kind
  use case_definition, only: case_t, visit_case
  use case_schema, only: find_group, find_key, is_listed
  use value_reader, only: set_to_default, read_times
  use case_values, only: case_values_t
  use history_rules, only: read_positions
  use joint_places, only: n_places, in_order
  use train_case, only: number_throws, most_cylinders
  use case_curves, only: provide_curves
  use state_file, only: provide_state
  use pin_rules, only: provide_film_moments
  implicit none
  private
  public :: load_case, load_model

  type, extends(parameter_list_t) :: loader_t
    type(case_values_t), pointer :: values => null()
    logical, allocatable :: only(:)               !! groups to be set, by index in the table
    integer :: at = 0                             !! index of the group being visited in the table
    character(len=:), allocatable :: law_name     !! law that the case names in this group
  contains
    procedure :: visit => load_parameter
    procedure :: group => load_group
    procedure :: choice => load_choice
    procedure :: law => load_law
  end type loader_t

contains

  !> Set all parameters of a case, or those of some groups. Defaults that depend on the selected law are put into the values too.
  !> Problems are noted there: parameters of a law that contradict each other, a measured curve that cannot be read.
  subroutine load_case(values, into, only)
    type(case_values_t), intent(inout), target :: values   !! already checked against their limits
    type(case_t), intent(inout) :: into
    logical, intent(in), optional :: only(:)  !! groups to be set. A group of a joint may change the laws of the other joint; if one
                                              !! such group changes, set all groups of joints.
    type(loader_t) :: loader
    integer :: i
    loader%values => values
    allocate (loader%only(size(values%groups)), source=.true.)
    if (present(only)) then
      loader%only = only
      where (values%groups%place /= '' .or. values%groups%is_law) loader%only = any(only .and. (values%groups%place /= '' .or. &
        values%groups%is_law .or. values%groups%name == 'pin'))
      where (values%groups%number > 0) loader%only = any(only .and. (values%groups%number > 0 .or. &
        values%groups%name == 'mechanism'))
    end if
    loader%repeats = any(values%groups%number > 1)
    call visit_case(into, loader)
    call provide_bodies(values, into)
    call provide_film_moments(values, into)
    if (allocated(into%load)) call complete_load(values, into)
    call read_times(into%output%film_times, into%output%snapshot_times)
    do i = 1, n_places
      call read_positions(into%joints(i)%history)
    end do
    call provide_curves(values, into)
    call provide_state(values, into)
  end subroutine load_case

  !> Give each cylinder the bodies of the mechanism as far as the case does not say its own, also in the values. The crank of a
  !> throw belongs to one of its cylinders.
  subroutine provide_bodies(values, into)
    type(case_values_t), intent(inout) :: values
    type(case_t), intent(inout) :: into
    character(len=*), parameter :: keys(7) = [character(len=13) :: 'piston_mass', 'rod_mass', 'rod_inertia', 'rod_com', &
      'crank_mass', 'crank_inertia', 'crank_com']
    logical, allocatable :: has_crank(:)
    integer, allocatable :: throw(:)
    character(len=:), allocatable :: group
    integer :: i, k, n
    if (.not. allocated(into%cylinders)) return
    allocate (throw(size(into%cylinders)), has_crank(size(into%cylinders)))
    call number_throws(into%cylinders, throw, has_crank)
    i = 0
    do n = 1, most_cylinders
      group = 'cylinder_'//integer_text(n)
      if (find_group(values%groups, group) == 0) exit
      if (.not. values%is_present(find_group(values%groups, group))) cycle
      i = i + 1
      do k = 1, size(keys)
        associate (own => values%values(values%place_of(group, trim(keys(k)))), &
                   shared => values%values(values%place_of('mechanism', trim(keys(k)))))
          where (.not. own%given) own%reals = merge(0.0_dp, shared%reals, index(keys(k), 'crank_') == 1 .and. .not. has_crank(i))
        end associate
      end do
      call load_model(values, group, into%cylinders(i))
    end do
  end subroutine provide_bodies

  !> The crank of a bearing by itself has a prescribed speed, and its film with memory a cycle of the period of the load, which the
  !> case need not say.
  subroutine complete_load(values, into)
    type(case_values_t), intent(inout) :: values
    type(case_t), intent(inout) :: into
    integer :: place
    place = values%place_of('drive', 'kind')
    if (.not. values%values(place)%given(1)) then
      into%drive%kind = 'constant_speed'
      values%values(place)%text = into%drive%kind
    end if
    associate (history => into%joints(in_order(1))%history)
      if (.not. allocated(history%march) .or. mod(into%load%period_deg, 360) /= 0) return   ! the latter is refused by the rules
      place = values%place_of(values%law_group('film_history', in_order(1)), 'cycle_deg')
      if (values%values(place)%given(1)) return
      history%march%cycle_deg = into%load%period_deg
      values%values(place)%whole = history%march%cycle_deg
    end associate
  end subroutine complete_load

  !> Set the parameters of one model, which are the keys of one group.
  subroutine load_model(values, group, model)
    type(case_values_t), intent(inout), target :: values
    character(len=*), intent(in) :: group
    class(has_parameters_t), intent(inout) :: model
    type(loader_t) :: loader
    loader%values => values
    allocate (loader%only(size(values%groups)), source=.true.)
    call loader%group(group, '', .true.)
    call model%parameters(loader)
  end subroutine load_model

  !> Visit a group. For a joint, the group with its place is used or else, for laws, the group without a place. Laws of an ideal
  !> joint are not set.
  subroutine load_group(self, name, says, is_model, place, instead_of, number)
    class(loader_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    logical, intent(in) :: is_model
    character(len=*), intent(in), optional :: place, instead_of
    integer, intent(in), optional :: number
    integer :: of_place
    if (present(number)) then
      self%at = find_group(self%values%groups, name//'_'//integer_text(number))
    else
      self%at = find_group(self%values%groups, name)
    end if
    if (present(place)) then
      of_place = find_group(self%values%groups, place//'.'//name)
      if (of_place > 0) then
        if (.not. is_model .or. self%values%is_present(of_place)) self%at = of_place
      end if
    end if
    self%law_name = ''
    self%sets = self%only(self%at)
    self%passes = .not. self%sets
    self%is_present = self%values%is_present(self%at)
    if (allocated(self%chosen)) deallocate (self%chosen)
  end subroutine load_group

  subroutine load_choice(self, key, default, says)
    class(loader_t), intent(inout) :: self
    character(len=*), intent(in) :: key, default, says
    if (self%sets) self%law_name = self%values%values(place_of(self, key))%text
    if (allocated(self%chosen)) deallocate (self%chosen)
  end subroutine load_choice

  !> Allocate a law if the case names it.
  subroutine load_law(self, name, law, variant)
    class(loader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    class(law_t), intent(in) :: law
    character(len=*), intent(in), optional :: variant
    character(len=:), allocatable :: key, wanted
    if (.not. (self%sets .and. self%is_present) .or. allocated(self%chosen)) return
    if (name /= self%law_name) return
    if (present(variant)) then
      if (self%values%values(place_of(self, 'variant'))%text /= variant) return
    end if
    allocate (self%chosen, source=law)
    self%chosen%name = name
    call self%chosen%parameters(self)
    call self%chosen%conflict(key, wanted)
    if (key /= '') call self%values%forbid(.true., trim(self%values%groups(self%at)%name), key, wanted)
  end subroutine load_law

  !> Index of a key of the present group in the table; 0 if there is none.
  pure integer function place_of(self, key)
    class(loader_t), intent(in) :: self
    character(len=*), intent(in) :: key
    place_of = find_key(self%values%keys, self%values%groups(self%at), key)
  end function place_of

  !> Set one parameter. A word, text or switch that is not given takes the default of the law, which is put into the values too.
  subroutine load_parameter(self, key, reals, whole, switch, text)
    class(loader_t), intent(inout) :: self
    type(key_t), intent(in) :: key
    real(dp), intent(inout), optional :: reals(:)
    integer, intent(inout), optional :: whole
    logical, intent(inout), optional :: switch
    character(len=:), allocatable, intent(inout), optional :: text
    integer :: place
    if (.not. self%sets) return
    place = place_of(self, trim(key%name))
    associate (value => self%values%values(place))
      if (present(reals)) reals = value%reals(:size(reals))
      if (present(whole)) whole = value%whole
      if (present(switch)) then
        if (.not. value%given(1)) call set_to_default(key, value)
        switch = value%switch
      end if
      if (.not. present(text)) return
      if (.not. value%given(1) .or. key%kind == word_kind .and. value%text == '') value%text = trim(key%default)
      text = value%text
    end associate
    if (key%kind /= word_kind .or. .not. allocated(self%chosen)) return
    call self%values%forbid(.not. is_listed(text, key%words), trim(self%values%groups(self%at)%name), trim(key%name), &
      'must be one of '//key%words//' for '//self%law_name)
  end subroutine load_parameter
end module case_loader
