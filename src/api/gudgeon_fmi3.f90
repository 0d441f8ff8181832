!> The functions of FMI 3.0 for co-simulation, beside those in `fmi_unit`.
module gudgeon_fmi3
  use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_int, c_int32_t, c_bool, c_size_t, c_double, c_char, c_null_char, &
    c_loc, c_f_pointer
  use kinds, only: dp
  use fmi_instance, only: fmi_discard, real_kind, integer_kind, logical_kind
  use fmi_unit, only: unit_t, open_unit, tell
  implicit none
  private
  public :: enter_initialization, get_reals, get_integers, set_reals, set_integers

  character(kind=c_char), target :: version(4) = ['3', '.', '0', c_null_char]

contains

  type(c_ptr) function get_version() bind(c, name='fmi3GetVersion') result(text)
    text = c_loc(version)
  end function get_version

  type(c_ptr) function instantiate(name, token, path, visible, logging, event_mode, early_return, needed, n_needed, environment, &
    log, intermediate) bind(c, name='fmi3InstantiateCoSimulation') result(handle)
    type(c_ptr), value :: name, token, path, needed, environment
    logical(c_bool), value :: visible, logging, event_mode, early_return
    integer(c_size_t), value :: n_needed
    type(c_funptr), value :: log, intermediate
    type(unit_t), pointer :: unit
    allocate (unit)
    unit%logger = log
    unit%environment = environment
    unit%instance%may_return_early = early_return
    call open_unit(unit, path, token, handle)
  end function instantiate

  integer(c_int) function enter_initialization(handle, has_tolerance, tolerance, start, has_stop, stop) &
    bind(c, name='fmi3EnterInitializationMode') result(status)
    type(c_ptr), value :: handle
    logical(c_bool), value :: has_tolerance, has_stop
    real(c_double), value :: tolerance, start, stop
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%setup(start, merge(stop, start, logical(has_stop)), merge(tolerance, 0.0_dp, logical(has_tolerance)), status)
    call tell(unit, status)
  end function enter_initialization

  integer(c_int) function get_reals(handle, references, n, values, n_values) bind(c, name='fmi3GetFloat64') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n, n_values
    integer(c_int32_t), intent(in) :: references(n)
    real(c_double), intent(inout) :: values(n_values)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%get_values(references, real_kind, values, status)
    call tell(unit, status)
  end function get_reals

  integer(c_int) function get_integers(handle, references, n, values, n_values) bind(c, name='fmi3GetInt32') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n, n_values
    integer(c_int32_t), intent(in) :: references(n)
    integer(c_int32_t), intent(inout) :: values(n_values)
    type(unit_t), pointer :: unit
    real(dp) :: reals(n_values)
    call c_f_pointer(handle, unit)
    reals = values
    call unit%instance%get_values(references, integer_kind, reals, status)
    values = nint(reals)
    call tell(unit, status)
  end function get_integers

  integer(c_int) function set_reals(handle, references, n, values, n_values) bind(c, name='fmi3SetFloat64') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n, n_values
    integer(c_int32_t), intent(in) :: references(n)
    real(c_double), intent(in) :: values(n_values)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%set_values(references, real_kind, values, status)
    call tell(unit, status)
  end function set_reals

  integer(c_int) function set_integers(handle, references, n, values, n_values) bind(c, name='fmi3SetInt32') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n, n_values
    integer(c_int32_t), intent(in) :: references(n), values(n_values)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%set_values(references, integer_kind, real(values, dp), status)
    call tell(unit, status)
  end function set_integers

  integer(c_int) function get_booleans(handle, references, n, values, n_values) bind(c, name='fmi3GetBoolean') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n, n_values
    integer(c_int32_t), intent(in) :: references(n)
    logical(c_bool), intent(inout) :: values(n_values)
    type(unit_t), pointer :: unit
    real(dp) :: reals(n_values)
    call c_f_pointer(handle, unit)
    reals = merge(1.0_dp, 0.0_dp, logical(values))
    call unit%instance%get_values(references, logical_kind, reals, status)
    values = abs(reals) > 0
    call tell(unit, status)
  end function get_booleans

  integer(c_int) function set_booleans(handle, references, n, values, n_values) bind(c, name='fmi3SetBoolean') result(status)
    type(c_ptr), value :: handle
    integer(c_size_t), value :: n, n_values
    integer(c_int32_t), intent(in) :: references(n)
    logical(c_bool), intent(in) :: values(n_values)
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%set_values(references, logical_kind, merge(1.0_dp, 0.0_dp, logical(values)), status)
    call tell(unit, status)
  end function set_booleans

  integer(c_int) function do_step(handle, from, by, no_return, needs_event, terminates, returned_early, last) &
    bind(c, name='fmi3DoStep') result(status)
    type(c_ptr), value :: handle
    real(c_double), value :: from, by
    logical(c_bool), value :: no_return
    logical(c_bool), intent(out) :: needs_event, terminates, returned_early
    real(c_double), intent(out) :: last
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%step(from, by, status)
    needs_event = .false.
    terminates = status == fmi_discard
    returned_early = unit%instance%has_returned_early
    last = unit%instance%last
    call tell(unit, status)
  end function do_step
end module gudgeon_fmi3
