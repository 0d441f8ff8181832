!> A functional mock-up unit in the hands of a master, and the functions that FMI 2.0 and 3.0 share. Their names in FMI are in
!> scripts/python/build_library.py, with those of the functions that a unit does not offer.
module fmi_unit
  use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_int, c_char, c_null_ptr, c_null_char, c_loc, c_f_pointer, &
    c_f_procpointer, c_associated
  use text_tools, only: replaced
  use c_texts, only: get_text
  use text_lock, only: lock_texts, unlock_texts
  use fmi_instance, only: fmi_instance_t, fmi_ok, fmi_discard, fmi_error, save_state, restore_state, free_saved_state, decoded
  implicit none
  private
  public :: unit_t, open_unit, tell

  type :: unit_t
    type(fmi_instance_t) :: instance
    type(c_funptr) :: logger                   !! of the master
    type(c_ptr) :: environment                 !! of the logger
    character(len=:), allocatable :: name      !! its logger is that of FMI 2.0, which is told the name of the instance
    integer :: status = fmi_ok                 !! of the last step
  end type unit_t

  abstract interface
    !> The logger of a master of FMI 2.0, which in C has further arguments.
    subroutine logger_2(environment, name, status, category, message) bind(c)
      import :: c_ptr, c_int, c_char
      type(c_ptr), value :: environment
      character(kind=c_char), intent(in) :: name(*), category(*), message(*)
      integer(c_int), value :: status
    end subroutine logger_2

    subroutine logger_3(environment, status, category, message) bind(c)
      import :: c_ptr, c_int, c_char
      type(c_ptr), value :: environment
      character(kind=c_char), intent(in) :: category(*), message(*)
      integer(c_int), value :: status
    end subroutine logger_3
  end interface

contains

  !> Read the case of a new unit, unless it has a message already, and return the handle for the master. If there is a message then,
  !> the master is told, the unit is gone, and the handle is null.
  subroutine open_unit(unit, location, token, handle)
    type(unit_t), pointer, intent(inout) :: unit
    type(c_ptr), intent(in) :: location, token   !! path or URI of the resources; GUID or instantiation token
    type(c_ptr), intent(out) :: handle
    character(len=:), allocatable :: text, folder, identity
    logical :: is_right
    call lock_texts()
    call get_text(location, text)
    call decoded(text, folder)
    call get_text(token, identity)
    is_right = .not. allocated(unit%instance%message)
    if (is_right) call unit%instance%read(folder, identity, is_right)
    call unlock_texts()
    handle = c_loc(unit)
    if (is_right) return
    call tell(unit, fmi_error)
    deallocate (unit)
    handle = c_null_ptr
  end subroutine open_unit

  !> Tell the master what is wrong.
  subroutine tell(unit, status)
    type(unit_t), intent(in) :: unit
    integer, intent(in) :: status
    procedure(logger_2), pointer :: log_2
    procedure(logger_3), pointer :: log_3
    character(len=:), allocatable :: category, message
    if (status == fmi_ok .or. .not. c_associated(unit%logger)) return
    if (.not. allocated(unit%instance%message)) return
    call lock_texts()
    category = trim(merge('logStatusDiscard', 'logStatusError  ', status == fmi_discard))//c_null_char
    message = unit%instance%message//c_null_char
    if (allocated(unit%name)) message = replaced(message, '%', '%%')   ! a format of printf
    call unlock_texts()
    if (allocated(unit%name)) then
      call c_f_procpointer(unit%logger, log_2)
      call log_2(unit%environment, unit%name//c_null_char, int(status, c_int), category, message)
    else
      call c_f_procpointer(unit%logger, log_3)
      call log_3(unit%environment, int(status, c_int), category, message)
    end if
  end subroutine tell

  subroutine free_instance(handle) bind(c, name='fmi_free_instance')
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, unit)
    call unit%instance%forget()
    deallocate (unit)
  end subroutine free_instance

  integer(c_int) function exit_initialization(handle) bind(c, name='fmi_exit_initialization') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%build(status)
    unit%instance%is_running = status == fmi_ok
    call tell(unit, status)
  end function exit_initialization

  integer(c_int) function terminate(handle) bind(c, name='fmi_terminate') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    unit%instance%is_terminated = .true.
    status = fmi_ok
  end function terminate

  integer(c_int) function reset(handle) bind(c, name='fmi_reset') result(status)
    type(c_ptr), value :: handle
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call unit%instance%reset(status)
    call tell(unit, status)
  end function reset

  integer(c_int) function get_state(handle, state) bind(c, name='fmi_get_state') result(status)
    type(c_ptr), value :: handle
    type(c_ptr), intent(inout) :: state
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call save_state(unit%instance, state)
    status = fmi_ok
  end function get_state

  integer(c_int) function set_state(handle, state) bind(c, name='fmi_set_state') result(status)
    type(c_ptr), value :: handle, state
    type(unit_t), pointer :: unit
    call c_f_pointer(handle, unit)
    call restore_state(unit%instance, state, status)
    call tell(unit, status)
  end function set_state

  integer(c_int) function free_state(handle, state) bind(c, name='fmi_free_state') result(status)
    type(c_ptr), value :: handle
    type(c_ptr), intent(inout) :: state
    call free_saved_state(state)
    status = fmi_ok
  end function free_state

  !> What has no effect.
  integer(c_int) function accepted() bind(c, name='fmi_accepted')
    accepted = fmi_ok
  end function accepted

  !> What a unit does not offer; the arguments are ignored.
  integer(c_int) function refused() bind(c, name='fmi_refused')
    refused = fmi_error
  end function refused

  !> The handle of a kind of unit that this one is not.
  type(c_ptr) function no_instance() bind(c, name='fmi_no_instance')
    no_instance = c_null_ptr
  end function no_instance
end module fmi_unit
