!> Laws for tests, built in the same way as from a case file: read, checked and prepared for a bearing.
module laws
  use kinds, only: dp
  use error_handling, only: error_t
  use bearing_size, only: bearing_t
  use case_definition, only: case_t
  use case_file, only: parse_case
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t
  use film_law, only: film_law_t
  use case_checks, only: bodies
  use model_parameters, only: has_parameters_t, parameter_list_t, key_t
  use joint_places, only: piston_pin
  implicit none
  private
  public :: contact_law_of, friction_law_of, film_law_of, parameter_of

  !> Reads one parameter, a number, of a model.
  type, extends(parameter_list_t) :: look_up_t
    character(len=:), allocatable :: key
    real(dp) :: found(2) = huge(1.0_dp)
  contains
    procedure :: visit
  end type look_up_t

contains

  !> The contact law of a group &contact with these keys, in the bearing of the case or in another one.
  subroutine contact_law_of(keys, law, error, bearing)
    character(len=*), intent(in) :: keys
    class(contact_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(bearing_t), intent(in), optional :: bearing
    type(case_t) :: case
    call read_keys('&contact '//keys//' /', case, error)
    if (allocated(error)) return
    allocate (law, source=case%joints(piston_pin)%contact)
    if (present(bearing)) then
      call law%prepare(bearing)
    else
      call law%prepare(case%joints(piston_pin)%bearing(case%mechanism%rod_length))
    end if
  end subroutine contact_law_of

  !> The friction law of a group &friction with these keys.
  subroutine friction_law_of(keys, law, error)
    character(len=*), intent(in) :: keys
    class(friction_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(case_t) :: case
    call read_keys('&contact / &friction '//keys//' /', case, error)
    if (allocated(error)) return
    allocate (law, source=case%joints(piston_pin)%friction)
    call law%prepare()
  end subroutine friction_law_of

  !> The film of a group &lubrication with these keys.
  subroutine film_law_of(keys, tolerance, law, error)
    character(len=*), intent(in) :: keys
    real(dp), intent(in) :: tolerance   !! relative, of the run
    class(film_law_t), allocatable, intent(out) :: law
    type(error_t), allocatable, intent(out) :: error
    type(case_t) :: case
    call read_keys('&lubrication '//keys//' /', case, error)
    if (allocated(error)) return
    allocate (law, source=case%joints(piston_pin)%film)
    call law%prepare(case%joints(piston_pin)%bearing(case%mechanism%rod_length), tolerance)
    call law%make_table(case%joints(piston_pin)%bearing(case%mechanism%rod_length), tolerance)
  end subroutine film_law_of

  subroutine read_keys(groups, case, error)
    character(len=*), intent(in) :: groups
    type(case_t), intent(out) :: case
    type(error_t), allocatable, intent(out) :: error
    character(len=1) :: nothing(0)
    call parse_case(bodies//groups, 'x.nml', nothing, case, error)
  end subroutine read_keys

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

  subroutine visit(self, key, reals, whole, switch, text)
    class(look_up_t), intent(inout) :: self
    type(key_t), intent(in) :: key
    real(dp), intent(inout), optional :: reals(:)
    integer, intent(inout), optional :: whole
    logical, intent(inout), optional :: switch
    character(len=:), allocatable, intent(inout), optional :: text
    associate (unused => present(switch) .or. present(text))
    end associate
    if (key%name /= self%key) return
    if (present(reals)) self%found = reals([1, size(reals)])
    if (present(whole)) self%found = whole
  end subroutine visit
end module laws
