!> The functions of FMI 2.0 for co-simulation. Those for model exchange, serialised states and derivatives only return an error, as
!> the description of the unit says.
module gudgeon_fmi2
  use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_int, c_size_t, c_double, c_char, c_null_ptr, c_null_char, c_loc, &
    c_f_pointer, c_f_procpointer, c_associated
  use kinds, only: dp
  use text_tools, only: replaced
  use c_texts, only: get_text
  use text_lock, only: lock_texts, unlock_texts
  use fmi_instance, only: fmi_instance_t, fmi_ok, fmi_discard, fmi_error, save_state, restore_state, &
    free_saved_state, decoded, real_kind, integer_kind
  implicit none
  private

  integer(c_int), parameter :: co_simulation = 1
  integer(c_int), parameter :: do_step_status = 0, last_successful_time = 2, terminated = 3

  character(kind=c_char), target :: version(4) = ['2', '.', '0', c_null_char]
  character(kind=c_char), target :: platform(8) = ['d', 'e', 'f', 'a', 'u', 'l', 't', c_null_char]

  type, bind(c) :: callbacks_t
    type(c_funptr) :: logger, allocate_memory, free_memory, step_finished
    type(c_ptr) :: environment
  end type callbacks_t

  type :: unit_t
    type(fmi_instance_t) :: instance
    type(callbacks_t) :: callbacks
    character(len=:), allocatable :: name
    integer :: status = fmi_ok   !! of the last step
  end type unit_t

  abstract interface
    !> The logger of the master, which in C has further arguments.
    subroutine logger(environment, name, status, category, message) bind(c)
      import :: c_ptr, c_int, c_char
      type(c_ptr), value :: environment
      character(kind=c_char), intent(in) :: name(*), category(*), message(*)
      integer(c_int), value :: status
    end subroutine logger
  end interface

contains

  !> Tell the master what is wrong.
  subroutine tell(unit, status)
    type(unit_t), intent(in) :: unit
    integer, intent(in) :: status
    procedure(logger), pointer :: log
    character(len=:), allocatable :: message
    if (status == fmi_ok .or. .not. c_associated(unit%callbacks%logger)) return
    if (.not. allocated(unit%instance%message)) return
    call c_f_procpointer(unit%callbacks%logger, log)
    call lock_texts()
    message = replaced(unit%instance%message, '%', '%%')//c_null_char   ! a format of printf
    call unlock_texts()
    call log(unit%callbacks%environment, unit%name//c_null_char, int(status, c_int), &
      trim(merge('logStatusDiscard', 'logStatusError  ', status == fmi_discard))//c_null_char, message)
  end subroutine tell

  type(c_ptr) function get_platform() bind(c, name='fmi2GetTypesPlatform') result(text)
    text = c_loc(platform)
  end function get_platform

  type(c_ptr) function get_version() bind(c, name='fmi2GetVersion') result(text)
    text = c_loc(version)
  end function get_version

  integer(c_int) function set_logging(handle, on, n, categories) bind(c, name='fmi2SetDebugLogging') result(status)
    type(c_ptr), value :: handle, categories
    integer(c_int), value :: on
    integer(c_size_t), value :: n
    status = fmi_ok
  end function set_logging

  type(c_ptr) function instantiate(name, kind, guid, location, callbacks, visible, logging) bind(c, name='fmi2Instantiate') &
    result(handle)
    type(c_ptr), value :: name, guid, location
    integer(c_int), value :: kind, visible, logging
    type(callbacks_t), intent(in) :: callbacks
    type(unit_t), pointer :: unit
    character(len=:), allocatable :: text, folder, identity
    logical :: is_right
    allocate (unit)
    unit%callbacks = callbacks
    call lock_texts()
    call get_text(name, unit%name)
    call get_text(location, text)
    call decoded(text, folder)
    call get_text(guid, identity)
    is_right = kind == co_simulation
    if (is_right) then
      call unit%instance%read(folder, identity, is_right)
    else
      unit%instance%message = 'this unit is for co-simulation'
    end if
    call unlock_texts()
    handle = c_loc(unit)
    if (is_right) return
    call tell(unit, fmi_error)
    deallocate (unit)
    handle = c_null_ptr
  end function instantiate

  subroutine free_instance(handle) bind(c, name='fmi2FreeInstance')
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, unit)
    call unit%instance%forget()
    deallocate (unit)
  end subroutine free_instance

  integer(c_int) function setup(handle, has_tolerance, tolerance, start, has_stop, stop) bind(c, name='fmi2SetupExperiment') &
    result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: has_tolerance, has_stop
    real(c_double), value :: tolerance, start, stop
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%setup(start, merge(stop, start, has_stop /= 0), merge(tolerance, 0.0_dp, has_tolerance /= 0), status)
    call tell(unit, status)
  end function setup

  integer(c_int) function enter_initialization(handle) bind(c, name='fmi2EnterInitializationMode') result(status)
    type(c_ptr), value :: handle
    status = fmi_ok
  end function enter_initialization

  integer(c_int) function exit_initialization(handle) bind(c, name='fmi2ExitInitializationMode') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%build(status)
    unit%instance%is_running = status == fmi_ok
    call tell(unit, status)
  end function exit_initialization

  integer(c_int) function terminate(handle) bind(c, name='fmi2Terminate') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    unit%instance%is_terminated = .true.
    status = fmi_ok
  end function terminate

  integer(c_int) function reset(handle) bind(c, name='fmi2Reset') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%reset(status)
    call tell(unit, status)
  end function reset

  integer(c_int) function get_real(handle, references, n, values) bind(c, name='fmi2GetReal') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n)
    real(c_double), intent(inout) :: values(n)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%get_values(references, real_kind, values, status)
    call tell(unit, status)
  end function get_real

  integer(c_int) function get_integer(handle, references, n, values) bind(c, name='fmi2GetInteger') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n)
    integer(c_int), intent(inout) :: values(n)
    type(unit_t), pointer :: unit
    real(dp) :: reals(n)
    call c_f_pointer(handle, unit)
    reals = values
    call unit%instance%get_values(references, integer_kind, reals, status)
    values = nint(reals)
    call tell(unit, status)
  end function get_integer

  integer(c_int) function set_real(handle, references, n, values) bind(c, name='fmi2SetReal') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n)
    real(c_double), intent(in) :: values(n)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%set_values(references, real_kind, values, status)
    call tell(unit, status)
  end function set_real

  integer(c_int) function set_integer(handle, references, n, values) bind(c, name='fmi2SetInteger') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n), values(n)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%set_values(references, integer_kind, real(values, dp), status)
    call tell(unit, status)
  end function set_integer

  integer(c_int) function do_step(handle, from, by, no_return) bind(c, name='fmi2DoStep') result(status)
    type(c_ptr), value :: handle
    real(c_double), value :: from, by
    integer(c_int), value :: no_return
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%step(from, by, status)
    unit%status = status
    call tell(unit, status)
  end function do_step

  integer(c_int) function get_status(handle, kind, value) bind(c, name='fmi2GetStatus') result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: kind
    integer(c_int), intent(out) :: value
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    value = unit%status
    status = merge(fmi_ok, fmi_discard, kind == do_step_status)
  end function get_status

  integer(c_int) function get_real_status(handle, kind, value) bind(c, name='fmi2GetRealStatus') result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: kind
    real(c_double), intent(out) :: value
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    value = unit%instance%last
    status = merge(fmi_ok, fmi_discard, kind == last_successful_time)
  end function get_real_status

  integer(c_int) function get_boolean_status(handle, kind, value) bind(c, name='fmi2GetBooleanStatus') result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: kind
    integer(c_int), intent(out) :: value
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    value = merge(1, 0, unit%status == fmi_discard)
    status = merge(fmi_ok, fmi_discard, kind == terminated)
  end function get_boolean_status

  integer(c_int) function get_state(handle, state) bind(c, name='fmi2GetFMUstate') result(status)
    type(c_ptr), value :: handle
    type(c_ptr), intent(inout) :: state
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call save_state(unit%instance, state)
    status = fmi_ok
  end function get_state

  integer(c_int) function set_state(handle, state) bind(c, name='fmi2SetFMUstate') result(status)
    type(c_ptr), value :: handle, state
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call restore_state(unit%instance, state, status)
    call tell(unit, status)
  end function set_state

  integer(c_int) function free_state(handle, state) bind(c, name='fmi2FreeFMUstate') result(status)
    type(c_ptr), value :: handle
    type(c_ptr), intent(inout) :: state
    call free_saved_state(state)
    status = fmi_ok
  end function free_state

  ! What this unit does not offer; the arguments are ignored.

  integer(c_int) function get_boolean() bind(c, name='fmi2GetBoolean') result(no)
    no = fmi_error
  end function get_boolean

  integer(c_int) function get_string() bind(c, name='fmi2GetString') result(no)
    no = fmi_error
  end function get_string

  integer(c_int) function set_boolean() bind(c, name='fmi2SetBoolean') result(no)
    no = fmi_error
  end function set_boolean

  integer(c_int) function set_string() bind(c, name='fmi2SetString') result(no)
    no = fmi_error
  end function set_string

  integer(c_int) function serialized_state_size() bind(c, name='fmi2SerializedFMUstateSize') result(no)
    no = fmi_error
  end function serialized_state_size

  integer(c_int) function serialize_state() bind(c, name='fmi2SerializeFMUstate') result(no)
    no = fmi_error
  end function serialize_state

  integer(c_int) function deserialize_state() bind(c, name='fmi2DeSerializeFMUstate') result(no)
    no = fmi_error
  end function deserialize_state

  integer(c_int) function get_directional_derivative() bind(c, name='fmi2GetDirectionalDerivative') result(no)
    no = fmi_error
  end function get_directional_derivative

  integer(c_int) function enter_event_mode() bind(c, name='fmi2EnterEventMode') result(no)
    no = fmi_error
  end function enter_event_mode

  integer(c_int) function new_discrete_states() bind(c, name='fmi2NewDiscreteStates') result(no)
    no = fmi_error
  end function new_discrete_states

  integer(c_int) function enter_continuous_time_mode() bind(c, name='fmi2EnterContinuousTimeMode') result(no)
    no = fmi_error
  end function enter_continuous_time_mode

  integer(c_int) function completed_integrator_step() bind(c, name='fmi2CompletedIntegratorStep') result(no)
    no = fmi_error
  end function completed_integrator_step

  integer(c_int) function set_time() bind(c, name='fmi2SetTime') result(no)
    no = fmi_error
  end function set_time

  integer(c_int) function set_continuous_states() bind(c, name='fmi2SetContinuousStates') result(no)
    no = fmi_error
  end function set_continuous_states

  integer(c_int) function get_derivatives() bind(c, name='fmi2GetDerivatives') result(no)
    no = fmi_error
  end function get_derivatives

  integer(c_int) function get_event_indicators() bind(c, name='fmi2GetEventIndicators') result(no)
    no = fmi_error
  end function get_event_indicators

  integer(c_int) function get_continuous_states() bind(c, name='fmi2GetContinuousStates') result(no)
    no = fmi_error
  end function get_continuous_states

  integer(c_int) function get_nominals_of_continuous_states() bind(c, name='fmi2GetNominalsOfContinuousStates') result(no)
    no = fmi_error
  end function get_nominals_of_continuous_states

  integer(c_int) function set_real_input_derivatives() bind(c, name='fmi2SetRealInputDerivatives') result(no)
    no = fmi_error
  end function set_real_input_derivatives

  integer(c_int) function get_real_output_derivatives() bind(c, name='fmi2GetRealOutputDerivatives') result(no)
    no = fmi_error
  end function get_real_output_derivatives

  integer(c_int) function cancel_step() bind(c, name='fmi2CancelStep') result(no)
    no = fmi_error
  end function cancel_step

  integer(c_int) function get_integer_status() bind(c, name='fmi2GetIntegerStatus') result(no)
    no = fmi_error
  end function get_integer_status

  integer(c_int) function get_string_status() bind(c, name='fmi2GetStringStatus') result(no)
    no = fmi_error
  end function get_string_status
end module gudgeon_fmi2
