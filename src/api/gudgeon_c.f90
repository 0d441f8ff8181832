!> The C interface; src/api/gudgeon.h declares it and says what each function does. Nothing here prints, installs a handler, changes
!> a mask, a folder, a locale or the floating-point environment, or stops the host.
module gudgeon_c
  use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_int64_t, c_size_t, c_double, c_char, c_null_char, c_null_ptr, c_loc, &
    c_f_pointer, c_associated
  use error_handling, only: error_t
  use case_schema, only: key_table_t, case_schema_of, is_listed
  use case_file, only: template
  use json_schema, only: json_schema_text
  use case_templates, only: short_template, template_kinds
  use trace_columns, only: column_list_t, column_name
  use scene_problem, only: event_contact_begins
  use trace_sink, only: joint_names
  use scene_inputs, only: inputs
  use version_number, only: program_version
  use case_handle, only: case_handle_t
  use run_handle, only: run_handle_t, begin_run, copy_run
  use c_texts, only: out_of_turn, handle_t, get_text, get_bytes, put_text
  use text_lock, only: lock_texts, unlock_texts
  implicit none
  private

  character(len=*), parameter :: no_handle = 'no handle', no_summary = 'only a finished run has a summary'

  !> Group and key of the case file, as in gudgeon.h.
  type, bind(c) :: c_key_t
    integer(c_int) :: kind, count, required, is_path
    character(kind=c_char) :: group(32), name(32), unit(16), range(32), usual(32), default(32), example(32), choice(32)
    character(kind=c_char) :: words(512), laws(512), meaning(256)
  end type c_key_t

  type, bind(c) :: c_group_t
    integer(c_int) :: is_model
    character(kind=c_char) :: name(32), place(32), meaning(256)
  end type c_group_t

contains

  type(c_ptr) function case_new(text, length, name, folder) bind(c, name='gudgeon_case_new') result(handle)
    type(c_ptr), value :: text, name, folder
    integer(c_size_t), value :: length
    type(case_handle_t), pointer :: new
    character(len=:), allocatable :: words, title, place
    call lock_texts()
    allocate (new)
    call get_bytes(text, length, words)
    call get_text(name, title)
    call get_text(folder, place)
    call new%read(words, title, place)
    handle = c_loc(new)
    call unlock_texts()
  end function case_new

  type(c_ptr) function case_copy(handle) bind(c, name='gudgeon_case_copy') result(copy)
    type(c_ptr), value :: handle
    type(case_handle_t), pointer :: old, new
    copy = c_null_ptr
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, old)
    allocate (new)
    new = old
    copy = c_loc(new)
  end function case_copy

  subroutine case_free(handle) bind(c, name='gudgeon_case_free')
    type(c_ptr), value :: handle
    type(case_handle_t), pointer :: old
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, old)
    deallocate (old)
  end subroutine case_free

  integer(c_int) function case_set(handle, key, value) bind(c, name='gudgeon_case_set') result(status)
    type(c_ptr), value :: handle, key, value
    type(case_handle_t), pointer :: it
    character(len=:), allocatable :: name, text
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call get_text(key, name)
    call get_text(value, text)
    call it%set(name, text, c_associated(value), status)
    call unlock_texts()
  end function case_set

  integer(c_int) function case_set_number(handle, key, element, value) bind(c, name='gudgeon_case_set_number') result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: key, element
    real(c_double), value :: value
    type(case_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%set_number(key + 1, element + 1, value, status)
    call unlock_texts()
  end function case_set_number

  integer(c_int) function case_accuracy(handle, level) bind(c, name='gudgeon_case_accuracy') result(status)
    type(c_ptr), value :: handle, level
    type(case_handle_t), pointer :: it
    character(len=:), allocatable :: name
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call get_text(level, name)
    call it%set_accuracy(name, status)
    call unlock_texts()
  end function case_accuracy

  integer(c_int) function case_check(handle) bind(c, name='gudgeon_case_check') result(status)
    type(c_ptr), value :: handle
    type(case_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%check(status)
    call unlock_texts()
  end function case_check

  integer(c_size_t) function case_get(handle, key, text, size) bind(c, name='gudgeon_case_get') result(length)
    type(c_ptr), value :: handle, key, text
    integer(c_size_t), value :: size
    type(case_handle_t), pointer :: it
    character(len=:), allocatable :: name, value
    integer :: status
    length = 0
    call put_text('', text, size)
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call get_text(key, name)
    call it%get(name, value, status)
    call put_text(value, text, size)
    length = len(value)
    call unlock_texts()
  end function case_get

  integer(c_int) function case_given(handle, key) bind(c, name='gudgeon_case_given') result(given)
    type(c_ptr), value :: handle
    integer(c_int), value :: key
    type(case_handle_t), pointer :: it
    given = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    given = merge(1, 0, it%is_given(key + 1))
  end function case_given

  integer(c_size_t) function case_text(handle, text, size) bind(c, name='gudgeon_case_text') result(length)
    type(c_ptr), value :: handle, text
    integer(c_size_t), value :: size
    type(case_handle_t), pointer :: it
    character(len=:), allocatable :: all
    length = 0
    call put_text('', text, size)
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%text(all)
    call put_text(all, text, size)
    length = len(all)
    call unlock_texts()
  end function case_text

  integer(c_size_t) function case_notes(handle, text, size) bind(c, name='gudgeon_case_notes') result(length)
    type(c_ptr), value :: handle, text
    integer(c_size_t), value :: size
    type(case_handle_t), pointer :: it
    integer :: status
    length = 0
    call put_text('', text, size)
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%check(status)
    length = 0
    if (status == 0 .and. allocated(it%case%notes)) then
      call put_text(it%case%notes, text, size)
      length = len(it%case%notes)
    else
      call put_text('', text, size)
    end if
    call unlock_texts()
  end function case_notes

  integer(c_int) function case_cache(handle, folder) bind(c, name='gudgeon_case_cache') result(status)
    type(c_ptr), value :: handle, folder
    type(case_handle_t), pointer :: it
    character(len=:), allocatable :: name
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call get_text(folder, name)
    call it%set_cache(name)
    call unlock_texts()
    status = 0
  end function case_cache

  integer(c_int) function case_columns(handle) bind(c, name='gudgeon_case_columns') result(n)
    type(c_ptr), value :: handle
    type(case_handle_t), pointer :: it
    integer :: status
    n = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%check(status)
    if (status == 0) n = size(it%list%id)
    call unlock_texts()
  end function case_columns

  integer(c_int) function case_column(handle, i, name, name_size, unit, unit_size, meaning, meaning_size) &
    bind(c, name='gudgeon_case_column') result(status)
    type(c_ptr), value :: handle, name, unit, meaning
    integer(c_int), value :: i
    integer(c_size_t), value :: name_size, unit_size, meaning_size
    type(case_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call put_column(it, it%list, i, name, name_size, unit, unit_size, meaning, meaning_size, status)
  end function case_column

  !> Put name, unit and meaning of column i, from 0 on.
  subroutine put_column(of, list, i, name, name_size, unit, unit_size, meaning, meaning_size, status)
    class(handle_t), intent(inout) :: of
    type(column_list_t), intent(in) :: list
    integer(c_int), intent(in) :: i
    type(c_ptr), intent(in) :: name, unit, meaning
    integer(c_size_t), intent(in) :: name_size, unit_size, meaning_size
    integer(c_int), intent(out) :: status
    integer :: bracket, n
    n = 0
    if (allocated(list%id)) n = size(list%id)
    call check_index(of, int(i, c_int64_t), int(n, c_int64_t), 'column', status)
    if (status /= 0) return
    associate (all => list%names(list%id(i + 1)))
      bracket = index(all, '[')
      call put_text(all(:bracket - 1), name, name_size)
      call put_text(all(bracket + 1:len_trim(all) - 1), unit, unit_size)
    end associate
    call put_text(list%meanings(list%id(i + 1))(:len_trim(list%meanings(list%id(i + 1)))), meaning, meaning_size)
  end subroutine put_column

  !> Refuse an index that is not one of the n from 0 on.
  subroutine check_index(of, i, n, what, status)
    class(handle_t), intent(inout) :: of
    integer(c_int64_t), intent(in) :: i, n
    character(len=*), intent(in) :: what   !! in the message
    integer(c_int), intent(out) :: status
    character(len=40) :: numbers
    status = 0
    if (i >= 0 .and. i < n) return
    write (numbers, '(i0, a, i0)') i, ' of ', n
    call of%refuse('there is no '//what//' '//trim(numbers)//', counted from 0', status)
  end subroutine check_index

  type(c_ptr) function run_new(handle, ideal_twin, end_time, without_rows) bind(c, name='gudgeon_run_new') result(run)
    type(c_ptr), value :: handle
    integer(c_int), value :: ideal_twin, without_rows
    real(c_double), value :: end_time
    type(case_handle_t), pointer :: it
    type(run_handle_t), pointer :: new
    integer :: status
    run = c_null_ptr
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call begin_run(it, ideal_twin /= 0, end_time, without_rows /= 0, new, status)
    call unlock_texts()
    if (associated(new)) run = c_loc(new)
  end function run_new

  integer(c_int) function case_start(handle, from) bind(c, name='gudgeon_case_start') result(status)
    type(c_ptr), value :: handle, from
    type(case_handle_t), pointer :: it
    type(run_handle_t), pointer :: run
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    status = 0
    if (allocated(it%start)) deallocate (it%start)
    if (.not. c_associated(from)) return
    call c_f_pointer(from, run)
    allocate (it%start)
    call lock_texts()
    call run%state(it%start)
    it%start%file = 'the start of the case'
    call unlock_texts()
  end function case_start

  integer(c_int) function states(handle) bind(c, name='gudgeon_states') result(n)
    type(c_ptr), value :: handle
    type(case_handle_t), pointer :: it
    integer :: i
    n = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    if (allocated(it%start)) n = sum([(size(it%start%numbers(i)%values), i=1, size(it%start%numbers))])
  end function states

  integer(c_int) function state(handle, i, value, name, name_size, unit, unit_size, meaning, meaning_size, kind) &
    bind(c, name='gudgeon_state') result(status)
    type(c_ptr), value :: handle, name, unit, meaning
    integer(c_int), value :: i
    real(c_double), intent(out) :: value
    integer(c_size_t), value :: name_size, unit_size, meaning_size
    integer(c_int), intent(out) :: kind
    type(case_handle_t), pointer :: it
    integer :: number, element
    value = 0
    kind = 0
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call it%find_state(i, number, element, status)
    if (status /= 0) return
    associate (its => it%start%numbers(number))
      value = its%values(element)
      kind = merge(2, merge(1, 0, its%is_whole), its%is_total)
      call put_text(its%name(:len_trim(its%name)), name, name_size)
      call put_text(its%unit(:len_trim(its%unit)), unit, unit_size)
      call put_text(its%says, meaning, meaning_size)
    end associate
  end function state

  integer(c_int) function state_set(handle, i, value) bind(c, name='gudgeon_state_set') result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: i
    real(c_double), value :: value
    type(case_handle_t), pointer :: it
    integer :: number, element
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call it%find_state(i, number, element, status)
    if (status /= 0) return
    if (abs(value) <= huge(value)) then
      it%start%numbers(number)%values(element) = value
    else
      call it%refuse('a state must be a finite number', status)
    end if
  end function state_set

  integer(c_int) function run_advance(handle, to, most_steps) bind(c, name='gudgeon_run_advance') result(status)
    type(c_ptr), value :: handle
    real(c_double), value :: to
    integer(c_int64_t), value :: most_steps
    type(run_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    if (.not. abs(to) <= huge(to) .or. most_steps < 0) then
      call it%refuse('the time must be a finite number, and the steps must not be negative', status)
    else
      call it%advance(to, int(min(most_steps, int(huge(0), c_int64_t))), status)
    end if
  end function run_advance

  integer(c_int) function run_finish(handle) bind(c, name='gudgeon_run_finish') result(status)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%finish(status)
    call unlock_texts()
  end function run_finish

  integer(c_int) function run_certify(handle) bind(c, name='gudgeon_run_certify') result(status)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%certify(status)
    call unlock_texts()
  end function run_certify

  integer(c_int) function run_save(handle, path) bind(c, name='gudgeon_run_save') result(status)
    type(c_ptr), value :: handle, path
    type(run_handle_t), pointer :: it
    character(len=:), allocatable :: name
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call get_text(path, name)
    call it%save(name, status)
    call unlock_texts()
  end function run_save

  subroutine run_free(handle) bind(c, name='gudgeon_run_free')
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    deallocate (it)
  end subroutine run_free

  type(c_ptr) function run_copy(handle) bind(c, name='gudgeon_run_copy') result(copy)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: old, new
    copy = c_null_ptr
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, old)
    allocate (new)
    call copy_run(old, new)
    copy = c_loc(new)
  end function run_copy

  integer(c_int) function run_assign(to, from) bind(c, name='gudgeon_run_assign') result(status)
    type(c_ptr), value :: to, from
    type(run_handle_t), pointer :: old, new
    status = out_of_turn
    if (.not. c_associated(to)) return
    call c_f_pointer(to, new)
    if (.not. c_associated(from)) then
      call new%refuse(no_handle, status)
      return
    end if
    call c_f_pointer(from, old)
    if (old%origin /= new%origin) then
      call new%refuse('the saved state is that of a run of another case', status)
    else
      call copy_run(old, new)
      status = 0
    end if
  end function run_assign

  real(c_double) function run_time(handle) bind(c, name='gudgeon_run_time') result(time)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    time = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    time = it%run%t
  end function run_time

  real(c_double) function run_end(handle) bind(c, name='gudgeon_run_end') result(time)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    time = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    time = it%run%expected_end()
  end function run_end

  integer(c_int) function run_inputs(handle) bind(c, name='gudgeon_inputs') result(n)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    n = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    n = size(it%run%inputs)
  end function run_inputs

  integer(c_int) function run_input(handle, i, value, name, name_size, unit, unit_size) bind(c, name='gudgeon_input') &
    result(status)
    type(c_ptr), value :: handle, name, unit
    integer(c_int), value :: i
    real(c_double), intent(out) :: value
    integer(c_size_t), value :: name_size, unit_size
    type(run_handle_t), pointer :: it
    value = 0
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call check_index(it, int(i, c_int64_t), size(it%run%inputs, kind=c_int64_t), 'input', status)
    if (status /= 0) return
    value = it%run%wanted_input(i + 1)
    associate (input => inputs(it%run%inputs(i + 1)))
      call put_text(input%name(:len_trim(input%name)), name, name_size)
      call put_text(input%unit(:len_trim(input%unit)), unit, unit_size)
    end associate
  end function run_input

  integer(c_int) function input_set(handle, i, value) bind(c, name='gudgeon_input_set') result(status)
    type(c_ptr), value :: handle
    integer(c_int), value :: i
    real(c_double), value :: value
    type(run_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call check_index(it, int(i, c_int64_t), size(it%run%inputs, kind=c_int64_t), 'input', status)
    if (status /= 0) return
    if (abs(value) <= huge(value)) then
      call it%set_input(i + 1, value)
    else
      call it%refuse('an input must be a finite number', status)
    end if
  end function input_set

  integer(c_int) function run_columns(handle) bind(c, name='gudgeon_columns') result(n)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    n = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    n = size(it%list%id)
  end function run_columns

  integer(c_int) function run_column(handle, i, name, name_size, unit, unit_size, meaning, meaning_size) &
    bind(c, name='gudgeon_column') result(status)
    type(c_ptr), value :: handle, name, unit, meaning
    integer(c_int), value :: i
    integer(c_size_t), value :: name_size, unit_size, meaning_size
    type(run_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call put_column(it, it%list, i, name, name_size, unit, unit_size, meaning, meaning_size, status)
  end function run_column

  type(c_ptr) function run_rows(handle, rows) bind(c, name='gudgeon_rows') result(values)
    type(c_ptr), value :: handle
    integer(c_int64_t), intent(out) :: rows
    type(run_handle_t), pointer :: it
    values = c_null_ptr
    rows = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    rows = it%rows%rows
    if (rows > 0) values = c_loc(it%rows%values)
  end function run_rows

  integer(c_int) function run_values(handle, now) bind(c, name='gudgeon_values') result(status)
    type(c_ptr), value :: handle
    real(c_double), intent(out) :: now(*)
    type(run_handle_t), pointer :: it
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call it%look(status)
    if (status == 0) now(:size(it%now)) = it%now
  end function run_values

  integer(c_int64_t) function run_events(handle) bind(c, name='gudgeon_events') result(n)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    n = -1
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    if (it%has_events()) n = it%rows%events
  end function run_events

  integer(c_int) function run_event(handle, i, values, ends, place, place_size) bind(c, name='gudgeon_event') result(status)
    type(c_ptr), value :: handle, place
    integer(c_int64_t), value :: i
    real(c_double), intent(out) :: values(6)
    integer(c_int), intent(out) :: ends
    integer(c_size_t), value :: place_size
    type(run_handle_t), pointer :: it
    values = 0
    ends = 0
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call check_index(it, i, int(it%rows%events, c_int64_t), 'event', status)
    if (status /= 0) return
    associate (event => it%rows%event(i + 1))
      values = [event%time, event%crank_angle, event%normal_speed, event%duration, event%max_penetration, event%max_normal_force]
      ends = merge(0, 1, event%kind == event_contact_begins)
      call put_text(joint_names(event%pin)(:len_trim(joint_names(event%pin))), place, place_size)
    end associate
  end function run_event

  integer(c_int) function run_quantities(handle) bind(c, name='gudgeon_quantities') result(n)
    type(c_ptr), value :: handle
    type(run_handle_t), pointer :: it
    integer :: status
    n = 0
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    call lock_texts()
    call it%read_summary()
    call unlock_texts()
    if (allocated(it%summary)) then
      n = size(it%summary)
    else
      call it%refuse(no_summary, status)
    end if
  end function run_quantities

  integer(c_int) function run_quantity(handle, i, value, name, name_size, unit, unit_size, text, text_size) &
    bind(c, name='gudgeon_quantity') result(status)
    type(c_ptr), value :: handle, name, unit, text
    integer(c_int), value :: i
    real(c_double), intent(out) :: value
    integer(c_size_t), value :: name_size, unit_size, text_size
    type(run_handle_t), pointer :: it
    integer :: n
    value = 0
    status = out_of_turn
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    n = 0
    if (allocated(it%summary)) n = size(it%summary)
    call check_index(it, int(i, c_int64_t), int(n, c_int64_t), 'quantity (gudgeon_quantities counts them)', status)
    if (status /= 0) return
    associate (row => it%summary(i + 1))
      value = row%value
      call put_text(row%name, name, name_size)
      call put_text(row%unit, unit, unit_size)
      call put_text(row%text, text, text_size)
    end associate
  end function run_quantity

  integer(c_size_t) function run_summary_text(handle, text, size) bind(c, name='gudgeon_summary') result(length)
    type(c_ptr), value :: handle, text
    integer(c_size_t), value :: size
    type(run_handle_t), pointer :: it
    integer :: status
    length = 0
    call put_text('', text, size)
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, it)
    if (.not. allocated(it%table)) then
      call it%refuse(no_summary, status)
      return
    end if
    call put_text(it%table, text, size)
    length = len(it%table)
  end function run_summary_text

  integer(c_int) function all_keys() bind(c, name='gudgeon_keys') result(n)
    type(key_table_t) :: table
    call lock_texts()
    call case_schema_of(table)
    n = size(table%keys)
    call unlock_texts()
  end function all_keys

  integer(c_int) function describe_keys(first, count, into) bind(c, name='gudgeon_key') result(status)
    integer(c_int), value :: first, count
    type(c_key_t), intent(out) :: into(*)
    type(key_table_t) :: table
    integer :: i
    call lock_texts()
    call case_schema_of(table)
    call unlock_texts()
    status = out_of_turn
    if (first < 0 .or. count < 0 .or. int(first, c_int64_t) + count > size(table%keys)) return
    status = 0
    do i = 1, count
      associate (key => table%keys(first + i), it => into(i))
        it%kind = key%kind
        it%count = key%count
        it%required = merge(1, 0, key%required)
        it%is_path = merge(1, 0, key%is_path)
        call put_field(key%group, it%group)
        call put_field(key%name, it%name)
        call put_field(key%unit, it%unit)
        call put_field(key%range, it%range)
        call put_field(key%usual, it%usual)
        call put_field(key%default, it%default)
        call put_field(key%example, it%example)
        call put_optional(key%choice, it%choice)
        call put_optional(key%words, it%words)
        call put_optional(key%laws, it%laws)
        call put_field(key%description, it%meaning)
      end associate
    end do
  end function describe_keys

  integer(c_int) function describe_groups(count, into) bind(c, name='gudgeon_groups') result(n)
    integer(c_int), value :: count
    type(c_group_t), intent(out) :: into(*)
    type(key_table_t) :: table
    integer :: i
    call lock_texts()
    call case_schema_of(table)
    call unlock_texts()
    n = size(table%groups)
    do i = 1, min(count, n)
      into(i)%is_model = merge(1, 0, table%groups(i)%is_model)
      call put_field(table%groups(i)%name, into(i)%name)
      call put_field(table%groups(i)%place, into(i)%place)
      call put_field(table%groups(i)%description, into(i)%meaning)
    end do
  end function describe_groups

  pure subroutine put_optional(text, field)
    character(len=:), allocatable, intent(in) :: text
    character(kind=c_char), intent(out) :: field(:)
    field = c_null_char
    if (allocated(text)) call put_field(text, field)
  end subroutine put_optional

  pure subroutine put_field(text, field)
    character(len=*), intent(in) :: text
    character(kind=c_char), intent(out) :: field(:)
    integer :: i
    field = c_null_char
    do i = 1, min(len_trim(text), size(field) - 1)
      field(i) = text(i:i)
    end do
  end subroutine put_field

  integer(c_size_t) function template_of(kind, text, size) bind(c, name='gudgeon_template') result(length)
    type(c_ptr), value :: kind, text
    integer(c_size_t), value :: size
    character(len=:), allocatable :: name, all
    call lock_texts()
    call get_text(kind, name)
    all = ''
    if (name == 'complete') then
      all = template()
    else if (is_listed(name, template_kinds)) then
      all = short_template(name)
    end if
    call put_text(all, text, size)
    length = len(all)
    call unlock_texts()
  end function template_of

  integer(c_size_t) function schema(text, size) bind(c, name='gudgeon_schema') result(length)
    type(c_ptr), value :: text
    integer(c_size_t), value :: size
    type(key_table_t) :: table
    character(len=:), allocatable :: all
    call lock_texts()
    call case_schema_of(table)
    all = json_schema_text(table)
    call put_text(all, text, size)
    length = len(all)
    call unlock_texts()
  end function schema

  integer(c_size_t) function message_of(handle, text, size) bind(c, name='gudgeon_message') result(length)
    type(c_ptr), value :: handle, text
    integer(c_size_t), value :: size
    type(handle_t), pointer :: it
    length = 0
    if (.not. c_associated(handle)) then
      call put_text(no_handle, text, size)
      length = len(no_handle)
      return
    end if
    call c_f_pointer(handle, it)
    if (allocated(it%message)) then
      call put_text(it%message, text, size)
      length = len(it%message)
    else
      call put_text('', text, size)
    end if
  end function message_of

  integer(c_size_t) function version(text, size) bind(c, name='gudgeon_version') result(length)
    type(c_ptr), value :: text
    integer(c_size_t), value :: size
    call put_text(program_version, text, size)
    length = len(program_version)
  end function version
end module gudgeon_c
