!> The functions of FMI 2.0 for co-simulation, beside those in `fmi_unit`. Where FMI 3.0 has the same with other arguments, that is
!> called.
module gudgeon_fmi2
  use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_int, c_size_t, c_double, c_bool, c_char, c_null_char, c_loc, c_f_pointer
  use c_texts, only: get_text
  use text_lock, only: lock_texts, unlock_texts
  use fmi_instance, only: fmi_ok, fmi_discard
  use fmi_unit, only: unit_t, open_unit, tell
  use gudgeon_fmi3, only: enter_initialization, get_reals, get_integers, set_reals, set_integers
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

contains

  type(c_ptr) function get_platform() bind(c, name='fmi2GetTypesPlatform') result(text)
    text = c_loc(platform)
  end function get_platform

  type(c_ptr) function get_version() bind(c, name='fmi2GetVersion') result(text)
    text = c_loc(version)
  end function get_version

  type(c_ptr) function instantiate(name, kind, guid, location, callbacks, visible, logging) bind(c, name='fmi2Instantiate') &
    result(handle)
    type(c_ptr), value :: name, guid, location
    integer(c_int), value :: kind, visible, logging
    type(callbacks_t), intent(in) :: callbacks
    type(unit_t), pointer :: unit
    allocate (unit)
    unit%logger = callbacks%logger
    unit%environment = callbacks%environment
    call lock_texts()
    call get_text(name, unit%name)
    if (kind /= co_simulation) unit%instance%message = 'this unit is for co-simulation'
    call unlock_texts()
    call open_unit(unit, location, guid, handle)
  end function instantiate

  integer(c_int) function setup(handle, has_tolerance, tolerance, start, has_stop, stop) bind(c, name='fmi2SetupExperiment') &
    result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: has_tolerance, has_stop
    real(c_double), value :: tolerance, start, stop
    status = enter_initialization(handle, logical(has_tolerance /= 0, c_bool), tolerance, start, &
      logical(has_stop /= 0, c_bool), stop)
  end function setup

  integer(c_int) function get_real(handle, references, n, values) bind(c, name='fmi2GetReal') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n)
    real(c_double), intent(inout) :: values(n)
    status = get_reals(handle, references, n, values, n)
  end function get_real

  integer(c_int) function get_integer(handle, references, n, values) bind(c, name='fmi2GetInteger') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n)
    integer(c_int), intent(inout) :: values(n)
    status = get_integers(handle, references, n, values, n)
  end function get_integer

  integer(c_int) function set_real(handle, references, n, values) bind(c, name='fmi2SetReal') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n)
    real(c_double), intent(in) :: values(n)
    status = set_reals(handle, references, n, values, n)
  end function set_real

  integer(c_int) function set_integer(handle, references, n, values) bind(c, name='fmi2SetInteger') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n
    integer(c_int), intent(in) :: references(n), values(n)
    status = set_integers(handle, references, n, values, n)
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
end module gudgeon_fmi2
