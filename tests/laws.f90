!> Laws for tests of single models: selected and set from a text of keys, without a case file. Keys are declared by the laws
!> themselves, as for the reader of cases; keys that are not given take their defaults. Limits are not checked.
module laws
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_internal
  use bearing_size, only: bearing_t
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  use film_law, only: film_law_t
  use model_parameters, only: has_parameters_t, parameter_list_t, law_t, key_t
  use joint_case, only: joint_case_t, visit_joint
  implicit none
  private
  public :: contact_law_of, friction_law_of, film_law_of, parameter_of

  !> The bearing of `case_checks`.
  type(bearing_t), parameter :: small_bearing = bearing_t(10e-3_dp, 15e-3_dp, 20e-6_dp, 0.2_dp)

  !> Sets the parameters of one group from a text such as `law='hertz' exponent=1.5`.
  type, extends(parameter_list_t) :: setter_t
    character(len=:), allocatable :: only        !! the group
    character(len=:), allocatable :: keys
    character(len=:), allocatable :: law_name    !! law that the keys name
    character(len=:), allocatable :: missing     !! required key that is not given
  contains
    procedure :: visit => set_parameter
    procedure :: group => begin_group
    procedure :: choice => select_name
    procedure :: law => select_law
  end type setter_t

  !> Reads one parameter, a number, of a model.
  type, extends(parameter_list_t) :: look_up_t
    character(len=:), allocatable :: key
    real(dp) :: found(2) = huge(1.0_dp)
  contains
    procedure :: visit => look_up
  end type look_up_t

contains

  !> The contact law of a group &contact with these keys, in a bearing of 10 mm with a clearance of 20 um or in another one.
  subroutine contact_law_of(keys, law, error, bearing)
    character(len=*), intent(in) :: keys
    class(contact_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(bearing_t), intent(in), optional :: bearing
    type(joint_case_t) :: joint
    call set_group('contact', keys, joint, error)
    if (.not. allocated(joint%contact)) return
    allocate (law, source=joint%contact)
    if (present(bearing)) then
      call law%prepare(bearing)
    else
      call law%prepare(small_bearing)
    end if
  end subroutine contact_law_of

  !> The friction law of a group &friction with these keys.
  subroutine friction_law_of(keys, law, error)
    character(len=*), intent(in) :: keys
    class(friction_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(joint_case_t) :: joint
    call set_group('friction', keys, joint, error)
    if (.not. allocated(joint%friction)) return
    allocate (law, source=joint%friction)
    call law%prepare()
  end subroutine friction_law_of

  !> The film of a group &lubrication with these keys.
  subroutine film_law_of(keys, tolerance, law, error)
    character(len=*), intent(in) :: keys
    real(dp), intent(in) :: tolerance   !! relative, of the run
    class(film_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(joint_case_t) :: joint
    call set_group('lubrication', keys, joint, error)
    if (.not. allocated(joint%film)) return
    allocate (law, source=joint%film)
    call law%make_table(small_bearing, tolerance)
    call law%prepare(small_bearing, tolerance)
  end subroutine film_law_of

  !> Set the laws of one group. An error names a law that does not exist, or a required key that is not given.
  subroutine set_group(group, keys, joint, error)
    character(len=*), intent(in) :: group, keys
    type(joint_case_t), intent(out) :: joint
    type(error_t), allocatable, intent(out) :: error
    type(setter_t) :: setter
    setter%only = group
    setter%keys = ' '//keys
    setter%missing = ''
    call visit_joint(joint, 'piston_pin', .false., setter)
    if (.not. (allocated(joint%contact) .or. allocated(joint%friction) .or. allocated(joint%film))) &
      setter%missing = 'law '//setter%law_name
    if (setter%missing /= '') call fail(error, 'tests/laws.f90: no '//setter%missing//' in'//setter%keys, status_internal)
  end subroutine set_group

  subroutine begin_group(self, name, says, is_model, place, instead_of, number)
    class(setter_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    logical, intent(in) :: is_model
    character(len=*), intent(in), optional :: place, instead_of
    integer, intent(in), optional :: number
    self%sets = name == self%only
    self%is_present = self%sets
    self%passes = .not. self%sets
  end subroutine begin_group

  subroutine select_name(self, key, default, says)
    class(setter_t), intent(inout) :: self
    character(len=*), intent(in) :: key, default, says
    if (.not. self%sets) return
    self%law_name = given(self, key)
    if (self%law_name == '') self%law_name = default
    if (allocated(self%chosen)) deallocate (self%chosen)
  end subroutine select_name

  subroutine select_law(self, name, law, variant)
    class(setter_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    class(law_t), intent(in) :: law
    character(len=*), intent(in), optional :: variant
    if (.not. self%sets .or. allocated(self%chosen)) return
    if (name /= self%law_name) return
    if (present(variant)) then
      if (given(self, 'variant') /= variant) return
    end if
    allocate (self%chosen, source=law)
    self%chosen%name = name
    call self%chosen%parameters(self)
  end subroutine select_law

  subroutine set_parameter(self, key, reals, whole, switch, text)
    class(setter_t), intent(inout) :: self
    type(key_t), intent(in) :: key
    real(dp), intent(inout), optional :: reals(:)
    integer, intent(inout), optional :: whole
    logical, intent(inout), optional :: switch
    character(len=:), allocatable, intent(inout), optional :: text
    character(len=:), allocatable :: value
    if (.not. self%sets) return
    value = given(self, trim(key%name))
    if (value == '' .and. key%required) self%missing = trim(key%name)
    if (value == '') value = trim(key%default)
    if (present(text)) text = value
    if (value == '') return
    if (present(reals)) then
      if (scan(value, ',') == 0) value = value//','//value
      read (value, *) reals
    end if
    if (present(whole)) read (value, *) whole
    if (present(switch)) read (value, *) switch
  end subroutine set_parameter

  !> The value of a key, without quotes; empty if the key is not given.
  pure function given(self, key) result(value)
    class(setter_t), intent(in) :: self
    character(len=*), intent(in) :: key
    character(len=:), allocatable :: value
    integer :: first
    value = ''
    first = index(self%keys, ' '//key//'=')
    if (first == 0) return
    value = self%keys(first + len(key) + 2:)//' '
    value = value(:scan(value, ' ') - 1)
    if (value(1:1) == "'") value = value(2:len(value) - 1)
  end function given

  !> The value of a model's key; huge if the model has no such key.
  function parameter_of(model, key) result(values)
    class(has_parameters_t), intent(inout) :: model
    character(len=*), intent(in) :: key
    real(dp) :: values(2)
    type(look_up_t) :: list
    list%key = key
    call model%parameters(list)
    values = list%found
  end function parameter_of

  subroutine look_up(self, key, reals, whole, switch, text)
    class(look_up_t), intent(inout) :: self
    type(key_t), intent(in) :: key
    real(dp), intent(inout), optional :: reals(:)
    integer, intent(inout), optional :: whole
    logical, intent(inout), optional :: switch
    character(len=:), allocatable, intent(inout), optional :: text
    if (key%name /= self%key) return
    if (present(reals)) self%found = reals([1, size(reals)])
    if (present(whole)) self%found = whole
  end subroutine look_up
end module laws
