!> An instance of a functional mock-up unit, as FMI 2.0 and 3.0 see it. Its case is in the folder of its resources. Value
!> references: outputs have the indices of the columns from 0 on (0 is the time), inputs 1000 and their index in `inputs` from 0 on,
!> 5000 whether a step ends at a contact, parameters 10000 + 16 k + e for number e of key k, both from 0 on (`most_reals` is 16).
!> The run is built when the first output is asked for or the initialisation ends, and again if a parameter changes before that.
module fmi_instance
  use, intrinsic :: iso_c_binding, only: c_ptr, c_null_ptr, c_loc, c_f_pointer, c_associated
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: status_integration
  use text_file, only: read_whole
  use case_schema, only: real_kind, integer_kind
  use model_parameters, only: logical_kind
  use scene_inputs, only: inputs
  use value_reader, only: most_reals
  use case_handle, only: case_handle_t
  use run_handle, only: run_handle_t, begin_run, copy_run
  use text_lock, only: lock_texts, unlock_texts
  implicit none
  private
  public :: fmi_instance_t, fmi_ok, fmi_discard, fmi_error, save_state, restore_state, free_saved_state, decoded
  public :: real_kind, integer_kind, logical_kind

  integer, parameter :: fmi_ok = 0, fmi_discard = 2, fmi_error = 3   !! statuses of FMI
  integer, parameter :: of_inputs = 1000, at_contacts = 5000, of_parameters = 10000     !! first value references

  type :: fmi_instance_t
    character(len=:), allocatable :: message       !! of the last error
    type(case_handle_t) :: case
    character(len=:), allocatable :: folder        !! resources
    character(len=:), allocatable :: identity      !! GUID or instantiation token
    type(run_handle_t), pointer :: run => null()
    real(dp) :: start = 0, stop = 0                !! times of the master [s]; stop 0: the case's end
    real(dp) :: last = 0                           !! last time that was reached [s]
    logical :: is_running = .false.                !! initialisation is over
    logical :: is_terminated = .false.
    logical :: may_return_early = .false.          !! the master allows a step to end early
    logical :: has_returned_early = .false.        !! the last step
    logical, private :: returns_at_contacts = .false.   !! it is wanted where a contact begins or ends
    real(dp), private :: held(size(inputs)) = 0    !! values of inputs set before there was a run
    logical, private :: is_held(size(inputs)) = .false.
  contains
    procedure :: read
    procedure :: setup
    procedure :: build
    procedure :: forget
    procedure :: reset
    procedure :: get
    procedure :: get_values
    procedure :: set
    procedure :: set_values
    procedure :: step
    procedure :: assign
  end type fmi_instance_t

contains

  !> Read the case. Error: `message` is set; an identity other than that of the unit, or a case that cannot be read.
  subroutine read(self, folder, identity, is_right)
    class(fmi_instance_t), intent(inout) :: self
    character(len=*), intent(in) :: folder, identity
    logical, intent(out) :: is_right
    character(len=:), allocatable :: text
    integer :: status
    is_right = .false.
    self%folder = folder
    self%identity = identity
    call read_whole(folder//'/identity', text, status)
    if (status == 0 .and. text /= identity) status = -1
    if (status /= 0) then
      self%message = 'the identity is not that of this unit, or its resources are missing: '//folder
      return
    end if
    call read_whole(folder//'/case.nml', text, status)
    self%case = case_handle_t()
    call self%case%read(text, 'case', folder)
    call self%case%set_cache(folder)
    call self%case%check(status)
    is_right = status == 0
    if (.not. is_right) self%message = self%case%message
  end subroutine read

  !> Become an instance that has just been read. Error: see `read`; the instance is then unchanged.
  subroutine reset(self, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(out) :: status
    type(fmi_instance_t) :: new
    logical :: is_right
    call lock_texts()
    call new%read(self%folder, self%identity, is_right)
    call unlock_texts()
    if (.not. is_right) then
      call move_alloc(new%message, self%message)
      status = fmi_error
      return
    end if
    call self%assign(new)
    status = fmi_ok
  end subroutine reset

  !> Times of the experiment, and the tolerance where the master gives one (0: it does not). A stop at the start: the case's end.
  !> Error: a stop before the start, or what is not a finite number.
  subroutine setup(self, start, stop, tolerance, status)
    class(fmi_instance_t), intent(inout) :: self
    real(dp), intent(in) :: start, stop, tolerance
    integer, intent(out) :: status
    integer :: key
    if (.not. (all(abs([start, stop, tolerance]) <= huge(start)) .and. stop >= start .and. tolerance >= 0)) then
      self%message = 'start, stop and tolerance must be finite numbers, and the stop must not be before the start'
      status = fmi_error
      return
    end if
    status = fmi_ok
    self%start = start
    self%last = start
    self%stop = stop
    if (tolerance > 0) then
      key = self%case%values%place_of('integrator', 'relative_tolerance')
      call lock_texts()
      call self%case%set_number(key, 1, tolerance, status)
      call unlock_texts()
      if (status /= 0) self%message = self%case%message
      if (status /= 0) status = fmi_error
    end if
    call self%forget()
  end subroutine setup

  !> Build the run, unless there is one.
  subroutine build(self, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(out) :: status
    integer :: i
    status = fmi_ok
    if (associated(self%run)) return
    call lock_texts()
    call begin_run(self%case, .false., merge(self%stop - self%start, 0.0_dp, self%stop > self%start), .true., self%run, status)
    call unlock_texts()
    if (status /= 0) then
      self%message = self%case%message
      status = fmi_error
      return
    end if
    do i = 1, size(self%run%run%inputs)
      if (self%is_held(self%run%run%inputs(i))) call self%run%set_input(i, self%held(self%run%run%inputs(i)))
    end do
  end subroutine build

  !> The run is no longer that of the case.
  subroutine forget(self)
    class(fmi_instance_t), intent(inout) :: self
    if (associated(self%run)) deallocate (self%run)
    nullify (self%run)
    self%is_running = .false.
  end subroutine forget

  !> The value of a reference.
  subroutine get(self, reference, value, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(in) :: reference
    real(dp), intent(out) :: value
    integer, intent(out) :: status
    integer :: place, key
    value = 0
    status = fmi_ok
    if (reference >= of_parameters) then
      key = (reference - of_parameters)/most_reals + 1
      call self%case%number(key, mod(reference - of_parameters, most_reals) + 1, value, status)
      if (status /= 0) call refuse(self, reference, status)
      return
    else if (reference == at_contacts) then
      value = merge(1.0_dp, 0.0_dp, self%returns_at_contacts)
      return
    end if
    call self%build(status)
    if (status /= fmi_ok) return
    if (reference >= of_inputs) then
      place = findloc(self%run%run%inputs, reference - of_inputs + 1, 1)
      if (place == 0) call refuse(self, reference, status)
      if (place > 0) value = self%run%run%wanted_input(place)
    else if (reference >= 0 .and. reference < size(self%run%now)) then
      call self%run%look(status)
      if (status /= 0) self%message = 'the state is outside the model'
      if (status /= 0) status = fmi_error
      value = self%run%now(reference + 1)
      if (reference == 0) value = value + self%start
    else
      call refuse(self, reference, status)
    end if
  end subroutine get

  !> The values of several references to variables of a kind, up to the first that is refused.
  subroutine get_values(self, references, kind, values, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(in) :: references(:)
    integer, intent(in) :: kind   !! real_kind, integer_kind or logical_kind
    real(dp), intent(inout) :: values(:)
    integer, intent(out) :: status
    integer :: i
    call compare_sizes(self, references, values, status)
    do i = 1, size(references)
      if (status == fmi_ok .and. kind_of(self, references(i)) /= kind) call refuse(self, references(i), status)
      if (status == fmi_ok) call self%get(references(i), values(i), status)
    end do
  end subroutine get_values

  !> Refuse a list of values that has not one for each reference.
  subroutine compare_sizes(self, references, values, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(in) :: references(:)
    real(dp), intent(in) :: values(:)
    integer, intent(out) :: status
    status = fmi_ok
    if (size(references) == size(values)) return
    self%message = 'there must be one value for each reference'
    status = fmi_error
  end subroutine compare_sizes

  !> The kind of the variable of a reference.
  pure integer function kind_of(self, reference)
    class(fmi_instance_t), intent(in) :: self
    integer, intent(in) :: reference
    integer :: key
    kind_of = real_kind
    if (reference == at_contacts) kind_of = logical_kind
    key = (reference - of_parameters)/most_reals + 1
    if (reference >= of_parameters .and. key <= size(self%case%values%keys)) kind_of = self%case%values%keys(key)%kind
  end function kind_of

  subroutine refuse(self, reference, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(in) :: reference
    integer, intent(out) :: status
    character(len=11) :: number
    status = fmi_error
    write (number, '(i0)') iand(int(reference, int64), int(z'FFFFFFFF', int64))   ! references have no sign
    self%message = 'the value reference '//trim(number)//' cannot be used here'
  end subroutine refuse

  !> Set an input, or a parameter before the end of the initialisation.
  subroutine set(self, reference, value, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(in) :: reference
    real(dp), intent(in) :: value
    integer, intent(out) :: status
    integer :: place, key
    status = fmi_ok
    if (reference >= of_parameters .and. .not. self%is_running) then
      key = (reference - of_parameters)/most_reals + 1
      call lock_texts()
      call self%case%set_number(key, mod(reference - of_parameters, most_reals) + 1, value, status)
      call unlock_texts()
      if (status /= 0) self%message = self%case%message
      if (status /= 0) status = fmi_error
      call self%forget()
    else if (reference == at_contacts .and. .not. self%is_running) then
      self%returns_at_contacts = abs(value) > 0
    else if (reference >= of_inputs .and. reference < of_inputs + size(inputs) .and. abs(value) <= huge(value)) then
      place = reference - of_inputs + 1
      self%held(place) = value
      self%is_held(place) = .true.
      if (.not. associated(self%run)) return
      place = findloc(self%run%run%inputs, place, 1)
      if (place > 0) call self%run%set_input(place, value)
      if (place == 0) call refuse(self, reference, status)
    else
      call refuse(self, reference, status)
    end if
  end subroutine set

  !> Set several inputs or parameters of a kind, up to the first that is refused.
  subroutine set_values(self, references, kind, values, status)
    class(fmi_instance_t), intent(inout) :: self
    integer, intent(in) :: references(:)
    integer, intent(in) :: kind   !! real_kind, integer_kind or logical_kind
    real(dp), intent(in) :: values(:)
    integer, intent(out) :: status
    integer :: i
    call compare_sizes(self, references, values, status)
    do i = 1, size(references)
      if (status == fmi_ok .and. kind_of(self, references(i)) /= kind) call refuse(self, references(i), status)
      if (status == fmi_ok) call self%set(references(i), values(i), status)
    end do
  end subroutine set_values

  !> Go on from a time by a step, or until a contact begins or ends, where that is wanted and allowed. `status` is fmi_discard if
  !> the run ends before, or cannot go on; `last` is the time reached. Error: another time, or one that is not a finite number, or
  !> a unit that is not running.
  subroutine step(self, from, by, status)
    class(fmi_instance_t), intent(inout) :: self
    real(dp), intent(in) :: from, by   !! [s]
    integer, intent(out) :: status
    real(dp), parameter :: rounding = 1e-9_dp
    status = fmi_error
    if (self%is_terminated .or. .not. self%is_running) then
      self%message = 'the unit is not running'
      return
    else if (.not. (by >= 0 .and. abs(from + by) <= huge(by) .and. &
      abs(from - self%last) <= rounding*max(by, abs(from)*1e-3_dp))) then
      self%message = 'a step must begin where the last one has ended, and end at a later time'
      return
    end if
    if (self%may_return_early .and. self%returns_at_contacts) then
      call self%run%advance_to_event(from + by - self%start, status)
    else
      call self%run%advance(from + by - self%start, 0, status)
    end if
    self%has_returned_early = status == -1 .and. self%run%run%t + self%start < from + by - rounding*by
    self%last = from + by
    if (status == status_integration) then
      call lock_texts()
      call self%run%finish(status)
      call unlock_texts()
      self%message = self%run%message
      status = fmi_discard
    else if (self%has_returned_early) then
      status = fmi_ok
    else if (self%run%run%t + self%start < from + by - rounding*by) then
      self%message = 'the run has reached its end'
      status = fmi_discard
    else
      status = fmi_ok
    end if
    if (status == fmi_discard .or. self%has_returned_early) self%last = self%run%run%t + self%start
  end subroutine step

  !> Become a copy of another instance.
  subroutine assign(self, from)
    class(fmi_instance_t), intent(inout) :: self
    type(fmi_instance_t), intent(in) :: from
    self%case = from%case
    self%start = from%start
    self%stop = from%stop
    self%last = from%last
    self%held = from%held
    self%is_held = from%is_held
    self%returns_at_contacts = from%returns_at_contacts
    if (.not. associated(from%run)) then
      call self%forget()
    else
      if (.not. associated(self%run)) allocate (self%run)
      call copy_run(from%run, self%run)
    end if
    self%is_running = from%is_running
    self%is_terminated = from%is_terminated
  end subroutine assign

  !> Save a copy of an instance at an address, where there is one from an earlier call, or else a new one.
  subroutine save_state(instance, state)
    type(fmi_instance_t), intent(in) :: instance
    type(c_ptr), intent(inout) :: state
    type(fmi_instance_t), pointer :: saved
    if (c_associated(state)) then
      call c_f_pointer(state, saved)
    else
      allocate (saved)
      state = c_loc(saved)
    end if
    call saved%assign(instance)
    saved%identity = instance%identity
  end subroutine save_state

  !> Put a saved copy back. Error: there is none, or it is that of another unit.
  subroutine restore_state(instance, state, status)
    type(fmi_instance_t), intent(inout) :: instance
    type(c_ptr), intent(in) :: state
    integer, intent(out) :: status
    type(fmi_instance_t), pointer :: saved
    status = fmi_error
    instance%message = 'this is no saved state of this unit'
    if (.not. c_associated(state)) return
    call c_f_pointer(state, saved)
    if (saved%identity /= instance%identity) return
    call instance%assign(saved)
    status = fmi_ok
  end subroutine restore_state

  !> Free a saved copy, if there is one.
  subroutine free_saved_state(state)
    type(c_ptr), intent(inout) :: state
    type(fmi_instance_t), pointer :: saved
    if (.not. c_associated(state)) return
    call c_f_pointer(state, saved)
    call saved%forget()
    deallocate (saved)
    state = c_null_ptr
  end subroutine free_saved_state

  !> The path of a URI file:///path or file:/path, with %20 and the like decoded; any other text is a path itself.
  subroutine decoded(uri, path)
    character(len=*), intent(in) :: uri
    character(len=:), allocatable, intent(out) :: path
    character(len=*), parameter :: digits = '0123456789abcdef', capitals = '0123456789ABCDEF'
    integer :: i, high, low
    if (index(uri, 'file:') /= 1) then
      path = uri
    else
      path = ''
      i = 6
      if (index(uri, 'file://') == 1) i = 8
      do while (i <= len(uri))
        high = 0
        low = 0
        if (uri(i:i) == '%' .and. i + 2 <= len(uri)) then
          high = max(index(digits, uri(i + 1:i + 1)), index(capitals, uri(i + 1:i + 1)))
          low = max(index(digits, uri(i + 2:i + 2)), index(capitals, uri(i + 2:i + 2)))
        end if
        if (high*low > 0) then
          path = path//achar(16*(high - 1) + low - 1)
          i = i + 3
        else
          path = path//uri(i:i)
          i = i + 1
        end if
      end do
    end if
    i = len(path)
    do while (i > 1)
      if (path(i:i) /= '/') exit
      i = i - 1
    end do
    path = path(:i)
  end subroutine decoded
end module fmi_instance
