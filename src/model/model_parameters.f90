!> The declaration of a model's parameters, in one place beside the components that hold them.
!>
!> A type with parameters has one procedure that passes each of them, with its key, unit, limits, default and meaning, to a visitor.
!> One visitor collects them for the reader, the template and the messages; another one sets them from the values of a case. A law
!> is selected from those that its family registers, by the names of the laws.
module model_parameters
  use kinds, only: dp
  implicit none
  private
  public :: parameter_list_t, has_parameters_t, law_t, key_t
  public :: any_angle, any_speed, real_kind, integer_kind, logical_kind, word_kind, text_kind

  character(len=*), parameter :: any_angle = '>= -1e6 and <= 1e6'   !! limits of an angle in degrees
  character(len=*), parameter :: any_speed = '>= -1e9 and <= 1e9'   !! of a speed in rad/s or m/s
  integer, parameter :: real_kind = 1, integer_kind = 2, logical_kind = 3, word_kind = 4, text_kind = 5

  !> The properties of a parameter. Ranges and words are texts, which are shown to the user unchanged. A default is allowed even
  !> outside its range, and then means "not given".
  type :: key_t
    character(len=32) :: group = ''          !! group of the case file, with its place as a prefix: crank_pin.contact
    character(len=32) :: name = ''
    integer :: kind = real_kind
    integer :: count = 1                     !! number of values
    logical :: is_list = .false.             !! reals of which one is enough; `count` of them at most
    logical :: required = .false.            !! must be given if its group is present, or if a law that has it is selected
    character(len=24) :: default = ''        !! value if it is not given, without quotes; for all elements of an array
    character(len=24) :: example = ''        !! value in the template, if the default is not suitable there
    character(len=12) :: unit = ''
    character(len=24) :: range = ''          !! '> 0', '>= 0 and <= 1'
    character(len=16) :: usual = ''          !! '1e-6 to 1e-3': sizes of a real in real machines, without its sign; 0 is never
                                             !! unusual
    character(len=:), allocatable :: words   !! allowed words, separated by a comma and a blank
    character(len=:), allocatable :: choice  !! key that names the laws with this parameter; not allocated: all laws have it
    character(len=:), allocatable :: laws    !! those laws, separated by a comma and a blank
    character(len=250) :: description = ''
    character(len=12) :: family = ''         !! keys of the group with the same family are alternatives, of which one may be given
    character(len=32) :: beside = ''         !! key of the family that may be given together with this one, as a bound
    logical :: is_path = .false.             !! a text that names a file, relative to the case file
    logical :: only_here = .false.           !! must not be given if the selected law does not have it
  end type key_t

  !> A visitor of parameters. A model calls `add`, `word` and `text`; a visitor must implement `visit`, and may implement the other
  !> procedures.
  type, abstract :: parameter_list_t
    class(law_t), allocatable :: chosen   !! law of the present group that the case names, with its parameters set
    logical :: sets = .false.             !! this visitor sets the parameters of the present group, and `chosen`
    logical :: is_present = .false.       !! while it sets them: the case has the present group
    logical :: passes = .false.           !! this visitor ignores the parameters of the present group
    logical :: repeats = .true.           !! a group that may be repeated is visited for every number, not for the first alone
    character(len=32), private :: amount = ''   !! see `make_optional`; empty: laws are not optional
  contains
    procedure(visit_parameter), deferred :: visit
    procedure :: group => pass_group
    procedure :: choice => pass_choice
    procedure :: law => pass_law
    procedure, private, non_overridable :: add_real, add_pair, add_integer, add_logical
    generic :: add => add_real, add_pair, add_integer, add_logical
    procedure, non_overridable :: list_of_reals
    procedure, non_overridable :: word
    procedure, non_overridable :: text
    procedure, non_overridable :: make_optional
    procedure, non_overridable :: is_absent
  end type parameter_list_t

  type, abstract :: has_parameters_t
  contains
    procedure(parameters_of), deferred :: parameters
  end type has_parameters_t

  !> A law: a member of a family of which a case names one.
  type, abstract, extends(has_parameters_t) :: law_t
    character(len=24) :: name = ''   !! in a case; set when a case selects the law
  contains
    procedure :: conflict => no_conflict
  end type law_t

  abstract interface
    !> Declare all parameters to the visitor.
    subroutine parameters_of(self, list)
      import :: has_parameters_t, parameter_list_t
      class(has_parameters_t), intent(inout) :: self
      class(parameter_list_t), intent(inout) :: list
    end subroutine parameters_of

    !> Visit a parameter; of the optional arguments the component of its kind is present.
    subroutine visit_parameter(self, key, reals, whole, switch, text)
      import :: parameter_list_t, key_t, dp
      class(parameter_list_t), intent(inout) :: self
      type(key_t), intent(in) :: key
      real(dp), intent(inout), optional :: reals(:)
      integer, intent(inout), optional :: whole
      logical, intent(inout), optional :: switch
      character(len=:), allocatable, intent(inout), optional :: text
    end subroutine visit_parameter
  end interface

contains

  !> The following parameters belong to this group. The group of an optional model may be missing in a case; its model is then
  !> absent from the scene. A group with a place may appear once for each place; one that may be repeated is declared once for each
  !> number, from 1 on.
  subroutine pass_group(self, name, says, is_model, place, instead_of, number)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    logical, intent(in) :: is_model
    character(len=*), intent(in), optional :: place
    character(len=*), intent(in), optional :: instead_of   !! group that a case cannot have together with this one
    integer, intent(in), optional :: number
  end subroutine pass_group

  !> The key of the present group that names a law; the laws follow.
  subroutine pass_choice(self, key, default, says)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, default, says
  end subroutine pass_choice

  !> A law that can be selected by the last choice under this name, with arbitrary values of its parameters. If only one `variant`
  !> of that law is implemented by this type, it comes before the type of the others.
  subroutine pass_law(self, name, law, variant)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    class(law_t), intent(in) :: law
    character(len=*), intent(in), optional :: variant
  end subroutine pass_law

  !> Declare a real. It is required if it has no default.
  subroutine add_real(self, key, value, says, unit, range, default, example, family, beside, only_here, usual)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, says                               !! key and short description
    real(dp), intent(inout) :: value
    character(len=*), intent(in), optional :: unit, range, default, example
    character(len=*), intent(in), optional :: family   !! alternative keys of which only one may be given
    character(len=*), intent(in), optional :: beside   !! exception to that
    logical, intent(in), optional :: only_here         !! must not be given if the selected law does not have it
    character(len=*), intent(in), optional :: usual    !! usual sizes
    type(key_t) :: new
    real(dp) :: values(1)
    if (self%passes) return
    values = value
    new = described(key, real_kind, says, unit, range, default, example, usual)
    if (self%amount /= '' .and. new%required) then
      new%required = .false.
      new%default = new%example
      if (key == self%amount) new%default = '0.0'
    end if
    if (present(family)) new%family = family
    if (present(beside)) new%beside = beside
    if (present(only_here)) new%only_here = only_here
    call self%visit(new, reals=values)
    value = values(1)
  end subroutine add_real

  !> Declare two reals; a default is that of both, and so is an example without a comma.
  subroutine add_pair(self, key, value, says, unit, range, default, example, usual)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, says
    real(dp), intent(inout) :: value(2)
    character(len=*), intent(in), optional :: unit, range, default, example, usual
    type(key_t) :: new
    if (self%passes) return
    new = described(key, real_kind, says, unit, range, default, example, usual)
    new%count = size(value)
    call self%visit(new, reals=value)
  end subroutine add_pair

  !> Declare a list of reals, `n` of them; a default is the only one. It is required if it has no default.
  subroutine list_of_reals(self, key, values, n, says, unit, range, default, example, usual)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, says
    real(dp), intent(inout) :: values(:)
    integer, intent(inout) :: n
    character(len=*), intent(in), optional :: unit, range, default, example, usual
    type(key_t) :: new
    if (self%passes) return
    new = described(key, real_kind, says, unit, range, default, example, usual)
    new%count = size(values)
    new%is_list = .true.
    call self%visit(new, reals=values, whole=n)
  end subroutine list_of_reals

  !> Declare an integer.
  subroutine add_integer(self, key, value, says, range, default, example)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, says
    integer, intent(inout) :: value
    character(len=*), intent(in), optional :: range, default, example
    if (self%passes) return
    call self%visit(described(key, integer_kind, says, range=range, default=default, example=example), whole=value)
  end subroutine add_integer

  !> Declare a switch, .true. or .false. If laws of one group have different defaults for it, the first one must have an example.
  subroutine add_logical(self, key, value, says, default, example)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, says, default
    logical, intent(inout) :: value
    character(len=*), intent(in), optional :: example
    if (self%passes) return
    call self%visit(described(key, logical_kind, says, default=default, example=example), switch=value)
  end subroutine add_logical

  !> Declare a choice of words, separated by a comma and a blank.
  subroutine word(self, key, value, words, default, says, example)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, words, default, says
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in), optional :: example
    type(key_t) :: new
    if (self%passes) return
    new = described(key, word_kind, says, default=default, example=example)
    new%words = words
    call self%visit(new, text=value)
  end subroutine word

  !> Declare a text; with `many`, several texts are joined by commas. It is required if it has no default.
  subroutine text(self, key, value, says, default, many, example, is_path)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: key, says
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in), optional :: default, example
    logical, intent(in), optional :: many, is_path   !! is_path: the name of a file
    type(key_t) :: new
    if (self%passes) return
    new = described(key, text_kind, says, default=default, example=example)
    if (present(many)) new%count = merge(1000, 1, many)
    if (present(is_path)) new%is_path = is_path
    call self%visit(new, text=value)
  end subroutine text

  !> The following laws are optional: if a case gives none of their parameters, the key `amount`, which scales their effect, is 0,
  !> and other required parameters take the values of their examples. An empty key ends this.
  subroutine make_optional(self, amount)
    class(parameter_list_t), intent(inout) :: self
    character(len=*), intent(in) :: amount
    self%amount = amount
  end subroutine make_optional

  !> Whether the case that this visitor sets does not have the present group.
  pure logical function is_absent(self)
    class(parameter_list_t), intent(in) :: self
    is_absent = self%sets .and. .not. self%is_present
  end function is_absent

  pure type(key_t) function described(name, kind, says, unit, range, default, example, usual) result(key)
    character(len=*), intent(in) :: name, says
    integer, intent(in) :: kind
    character(len=*), intent(in), optional :: unit, range, default, example, usual
    key%name = name
    key%kind = kind
    key%description = says
    key%required = .not. present(default)
    if (present(unit)) key%unit = unit
    if (present(range)) key%range = range
    if (present(default)) key%default = default
    if (present(example)) key%example = example
    if (present(usual)) key%usual = usual
  end function described

  !> Find a contradiction between the parameters: the key of the wrong one, and what is required of it. An empty key means that
  !> there is none, which is the default.
  pure subroutine no_conflict(self, key, wanted)
    class(law_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = ''
  end subroutine no_conflict
end module model_parameters
