!> The functions of FMI 3.0 for co-simulation. Binaries, clocks, event mode, derivatives, serialised states, model exchange and
!> scheduled execution only return an error, as the description of the unit says.
module gudgeon_fmi3
  use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_int, c_int32_t, c_bool, c_size_t, c_double, c_char, c_null_ptr, &
    c_null_char, c_loc, c_f_pointer, c_f_procpointer, c_associated
  use kinds, only: dp
  use c_texts, only: get_text
  use text_lock, only: lock_texts, unlock_texts
  use fmi_instance, only: fmi_instance_t, fmi_ok, fmi_discard, fmi_error, save_state, restore_state, &
    free_saved_state, decoded, real_kind, integer_kind, logical_kind
  implicit none
  private

  character(kind=c_char), target :: version(4) = ['3', '.', '0', c_null_char]

  type :: unit_t
    type(fmi_instance_t) :: instance
    type(c_funptr) :: logger
    type(c_ptr) :: environment
  end type unit_t

  abstract interface
    subroutine logger(environment, status, category, message) bind(c)
      import :: c_ptr, c_int, c_char
      type(c_ptr), value :: environment
      character(kind=c_char), intent(in) :: category(*), message(*)
      integer(c_int), value :: status
    end subroutine logger
  end interface

contains

  !> Tell the master what is wrong.
  subroutine tell(unit, status)
    type(unit_t), intent(in) :: unit
    integer, intent(in) :: status
    procedure(logger), pointer :: log
    if (status == fmi_ok .or. .not. c_associated(unit%logger)) return
    if (.not. allocated(unit%instance%message)) return
    call c_f_procpointer(unit%logger, log)
    call log(unit%environment, int(status, c_int), &
      trim(merge('logStatusDiscard', 'logStatusError  ', status == fmi_discard))//c_null_char, &
      unit%instance%message//c_null_char)
  end subroutine tell

  type(c_ptr) function get_version() bind(c, name='fmi3GetVersion') result(text)
    text = c_loc(version)
  end function get_version

  integer(c_int) function set_logging(handle, on, n, categories) bind(c, name='fmi3SetDebugLogging') result(status)
    type(c_ptr), value :: handle, categories
    logical(c_bool), value :: on
    integer(c_size_t), value :: n
    status = fmi_ok
  end function set_logging

  type(c_ptr) function instantiate(name, token, path, visible, logging, event_mode, early_return, needed, n_needed, environment, &
    log, intermediate) bind(c, name='fmi3InstantiateCoSimulation') result(handle)
    type(c_ptr), value :: name, token, path, needed, environment
    logical(c_bool), value :: visible, logging, event_mode, early_return
    integer(c_size_t), value :: n_needed
    type(c_funptr), value :: log, intermediate
    type(unit_t), pointer :: unit
    character(len=:), allocatable :: text, folder, identity
    logical :: is_right
    allocate (unit)
    unit%environment = environment
    unit%instance%may_return_early = early_return
    unit%logger = log
    call lock_texts()
    call get_text(path, text)
    call decoded(text, folder)
    call get_text(token, identity)
    call unit%instance%read(folder, identity, is_right)
    call unlock_texts()
    handle = c_loc(unit)
    if (is_right) return
    call tell(unit, fmi_error)
    deallocate (unit)
    handle = c_null_ptr
  end function instantiate

  subroutine free_instance(handle) bind(c, name='fmi3FreeInstance')
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, unit)
    call unit%instance%forget()
    deallocate (unit)
  end subroutine free_instance

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

  integer(c_int) function exit_initialization(handle) bind(c, name='fmi3ExitInitializationMode') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%build(status)
    unit%instance%is_running = status == fmi_ok
    call tell(unit, status)
  end function exit_initialization

  integer(c_int) function terminate(handle) bind(c, name='fmi3Terminate') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    unit%instance%is_terminated = .true.
    status = fmi_ok
  end function terminate

  integer(c_int) function reset(handle) bind(c, name='fmi3Reset') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%reset(status)
    call tell(unit, status)
  end function reset

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

  integer(c_int) function get_state(handle, state) bind(c, name='fmi3GetFMUState') result(status)
    type(c_ptr), value :: handle
    type(c_ptr), intent(inout) :: state
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call save_state(unit%instance, state)
    status = fmi_ok
  end function get_state

  integer(c_int) function set_state(handle, state) bind(c, name='fmi3SetFMUState') result(status)
    type(c_ptr), value :: handle, state
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call restore_state(unit%instance, state, status)
    call tell(unit, status)
  end function set_state

  integer(c_int) function free_state(handle, state) bind(c, name='fmi3FreeFMUState') result(status)
    type(c_ptr), value :: handle
    type(c_ptr), intent(inout) :: state
    call free_saved_state(state)
    status = fmi_ok
  end function free_state

  type(c_ptr) function model_exchange() bind(c, name='fmi3InstantiateModelExchange') result(no)
    no = c_null_ptr
  end function model_exchange

  type(c_ptr) function scheduled_execution() bind(c, name='fmi3InstantiateScheduledExecution') result(no)
    no = c_null_ptr
  end function scheduled_execution
end module gudgeon_fmi3
