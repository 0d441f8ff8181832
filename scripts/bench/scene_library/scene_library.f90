!> A scene as a library that C and Python can call, for scripts/bench/compare_integrators: the program's own right-hand side in its
!> own coordinates, its event functions, and integrations by the program's own methods.
!>
!> States are passed without their quadratures, on which the right-hand side does not depend: y = (positions | their rates |
!> first-order states). Functions with a status return 0 on success.
module scene_library
  use, intrinsic :: iso_c_binding, only: c_ptr, c_loc, c_f_pointer, c_int, c_double, c_char, c_null_char, c_null_ptr
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t
  use ode_problem, only: event_stop
  use ode_method, only: ode_method_t, ode_settings_t, step_statistics_t
  use ode_methods, only: new_method
  use ode_solver, only: integrate, silent_observer_t
  use scene_problem, only: scene_t, event_none
  use case_definition, only: case_t
  use case_file, only: read_case
  use scene_builder, only: build_scene, settings_for, simulated_time
  use state_watcher, only: state_watcher_t, watched
  use event_watcher, only: event_watcher_t, most_instants
  implicit none
  private

  integer, parameter :: longest_text = 400
  real(dp), parameter :: tightest = 1e-13_dp   !! tolerance of tables and of the gas, the same in every run

  !> A scene, the case that it is built from and the settings of its integration.
  type :: handle_t
    type(case_t) :: case
    logical :: is_twin = .false.       !! whether it is the ideal twin, the same scene without clearance
    type(scene_t), allocatable :: scene
    type(ode_settings_t) :: settings   !! at the tolerance `tightest`
    integer :: n = 0                   !! states without quadratures
    real(dp), allocatable :: y(:), f(:)   !! state with quadratures, and its derivative
    type(state_watcher_t) :: states    !! largest values in the last integration by the program
    type(event_watcher_t) :: instants
  end type handle_t

contains

  !> Open a case or, if `twin` is not 0, its ideal twin without clearance; `options` are lines of GROUP.KEY=VALUE.
  integer(c_int) function scene_open(file, options, twin, handle) bind(c)
    character(kind=c_char), intent(in) :: file(*), options(*)
    integer(c_int), intent(in), value :: twin
    type(c_ptr), intent(out) :: handle
    type(handle_t), pointer :: self
    type(error_t), allocatable :: error
    character(len=longest_text) :: overrides(8)
    integer :: n

    handle = c_null_ptr
    scene_open = 1
    allocate (self)
    self%is_twin = twin /= 0
    call split_lines(text_of(options), overrides, n)
    n = n + 1
    write (overrides(n), '(a,es9.1)') 'integrator.relative_tolerance=', tightest
    call read_case(trim(text_of(file)), overrides(:n), self%case, error)
    if (.not. allocated(error)) call build_scene(self%case, self%is_twin, self%scene, error)
    if (allocated(error)) then
      deallocate (self)
      return
    end if
    self%settings = settings_for(self%case, self%scene)
    self%n = self%scene%n - self%scene%n_quadratures
    allocate (self%y(self%scene%n), self%f(self%scene%n), source=0.0_dp)
    handle = c_loc(self)
    scene_open = 0
  end function scene_open

  subroutine scene_close(handle) bind(c)
    type(c_ptr), intent(in), value :: handle
    type(handle_t), pointer :: self
    call c_f_pointer(handle, self)
    deallocate (self)
  end subroutine scene_close

  !> Number of states without and with quadratures, and number of event functions.
  subroutine scene_sizes(handle, sizes) bind(c)
    type(c_ptr), intent(in), value :: handle
    integer(c_int), intent(out) :: sizes(3)
    type(handle_t), pointer :: self
    call c_f_pointer(handle, self)
    sizes = [self%n, self%scene%n, self%scene%n_events]
  end subroutine scene_sizes

  !> Set the scene to its start, and return state, end time, and the relative and absolute error weights of each state at tolerance
  !> 1.
  integer(c_int) function scene_start(handle, y, t_end, relative, absolute) bind(c)
    type(c_ptr), intent(in), value :: handle
    real(c_double), intent(out) :: y(*), t_end, relative(*), absolute(*)
    type(handle_t), pointer :: self
    type(error_t), allocatable :: error
    call c_f_pointer(handle, self)
    call build_scene(self%case, self%is_twin, self%scene, error)
    scene_start = merge(1_c_int, 0_c_int, allocated(error))
    if (allocated(error)) return
    self%y = self%scene%initial_state()
    y(:self%n) = self%y(:self%n)
    t_end = simulated_time(self%case)
    relative(:self%n) = self%settings%relative(:self%n)/self%settings%tolerance
    absolute(:self%n) = self%settings%absolute(:self%n)/self%settings%tolerance
  end function scene_start

  !> f(t, y); returns 1 if the model is not defined at y. (y has no quadratures, which the right-hand side does not read. It is not
  !> copied: a copy of numbers that have just been written waits for them, which makes an evaluation 15 % longer.)
  integer(c_int) function scene_rates(handle, t, y, f) bind(c)
    type(c_ptr), intent(in), value :: handle
    real(c_double), intent(in), value :: t
    real(c_double), intent(in) :: y(*)
    real(c_double), intent(out) :: f(*)
    type(handle_t), pointer :: self
    logical :: in_domain
    call c_f_pointer(handle, self)
    call self%scene%derivatives(t, y, self%f, in_domain)
    f(:self%n) = self%f(:self%n)
    scene_rates = merge(0_c_int, 1_c_int, in_domain)
  end function scene_rates

  !> The event functions and their rates; an event is a change of sign from negative to not negative.
  integer(c_int) function scene_events(handle, t, y, g, rate) bind(c)
    type(c_ptr), intent(in), value :: handle
    real(c_double), intent(in), value :: t
    real(c_double), intent(in) :: y(*)
    real(c_double), intent(out) :: g(*), rate(*)
    type(handle_t), pointer :: self
    call c_f_pointer(handle, self)
    self%y(:self%n) = y(:self%n)
    call self%scene%events(t, self%y, g(:self%scene%n_events), rate(:self%scene%n_events))
    scene_events = 0
  end function scene_events

  !> Handle event `index` (from 1) at (t, y). Returns 1 if it ends the run. `is_contact`: it is an event whose time is compared.
  integer(c_int) function scene_handle_event(handle, index, t, y, is_contact) bind(c)
    type(c_ptr), intent(in), value :: handle
    integer(c_int), intent(in), value :: index
    real(c_double), intent(in), value :: t
    real(c_double), intent(inout) :: y(*)
    integer(c_int), intent(out) :: is_contact
    type(handle_t), pointer :: self
    integer :: action
    call c_f_pointer(handle, self)
    self%y(:self%n) = y(:self%n)
    is_contact = merge(0_c_int, 1_c_int, self%scene%reported_event(int(index)) == event_none)
    call self%scene%handle_event(int(index), t, self%y, action)
    y(:self%n) = self%y(:self%n)
    scene_handle_event = merge(1_c_int, 0_c_int, action == event_stop)
  end function scene_handle_event

  !> q, A, x, q', A', x', e_x, e_y at (t, y), the quantities in which errors are measured.
  subroutine scene_look(handle, t, y, values) bind(c)
    type(c_ptr), intent(in), value :: handle
    real(c_double), intent(in), value :: t
    real(c_double), intent(in) :: y(*)
    real(c_double), intent(out) :: values(watched)
    type(handle_t), pointer :: self
    type(state_watcher_t) :: look
    call c_f_pointer(handle, self)
    self%y(:self%n) = y(:self%n)
    call look%look(self%scene, t, self%y)
    values = look%values
  end subroutine scene_look

  !> Integrate to the end by one of the program's own methods, and return the status of the integration. `seconds`: processor time,
  !> without that of the observation. `counts`: evaluations, Jacobians, accepted steps, contact events. `watches`: not 0 to record
  !> the largest values during the run, 0 to record the events only.
  integer(c_int) function scene_integrate(handle, method_name, tolerance, watches, y, seconds, counts) bind(c)
    type(c_ptr), intent(in), value :: handle
    character(kind=c_char), intent(in) :: method_name(*)
    real(c_double), intent(in), value :: tolerance
    integer(c_int), intent(in), value :: watches
    real(c_double), intent(out) :: y(*), seconds
    integer(c_int), intent(out) :: counts(4)
    type(handle_t), pointer :: self
    class(ode_method_t), allocatable :: method
    type(error_t), allocatable :: error
    type(step_statistics_t) :: statistics
    real(dp) :: t, part, before, after
    integer :: status

    call c_f_pointer(handle, self)
    scene_integrate = 99
    call build_scene(self%case, self%is_twin, self%scene, error)
    if (.not. allocated(error)) call new_method(text_of(method_name), method, error)
    if (allocated(error)) return
    method%settings = self%settings
    part = tolerance/self%settings%tolerance
    method%settings%tolerance = tolerance
    method%settings%relative = part*self%settings%relative
    method%settings%absolute = part*self%settings%absolute
    self%y = self%scene%initial_state()
    self%states = state_watcher_t()
    self%instants = event_watcher_t()
    t = 0
    call cpu_time(before)
    if (watches /= 0) then
      call integrate(self%scene, method, t, self%y, simulated_time(self%case), 0, self%states, status)
    else
      call integrate(self%scene, method, t, self%y, simulated_time(self%case), 0, self%instants, status)
    end if
    call cpu_time(after)
    seconds = after - before
    statistics = method%totals()
    counts = int([statistics%evaluations, statistics%jacobians, statistics%accepted, self%instants%n], c_int)
    y(:self%n) = self%y(:self%n)
    scene_integrate = int(status, c_int)
  end function scene_integrate

  !> Largest magnitudes of the values of `scene_look` in the last integration with `watches`.
  subroutine scene_largest(handle, values) bind(c)
    type(c_ptr), intent(in), value :: handle
    real(c_double), intent(out) :: values(watched)
    type(handle_t), pointer :: self
    call c_f_pointer(handle, self)
    values = self%states%largest
  end subroutine scene_largest

  !> Times of the first `n` contact events in the last integration without `watches` [s].
  subroutine scene_instants(handle, n, instants) bind(c)
    type(c_ptr), intent(in), value :: handle
    integer(c_int), intent(in), value :: n
    real(c_double), intent(out) :: instants(n)
    type(handle_t), pointer :: self
    call c_f_pointer(handle, self)
    instants = 0
    instants(:min(n, most_instants)) = self%instants%instant(:min(n, most_instants))
  end subroutine scene_instants

  !> Time of one evaluation [s] in a sequence in which each depends on the result of the one before: the shortest of some blocks.
  real(c_double) function scene_seconds_in_turn(handle, t, y) bind(c)
    type(c_ptr), intent(in), value :: handle
    real(c_double), intent(in), value :: t
    real(c_double), intent(in) :: y(*)
    integer, parameter :: blocks = 8, calls = 1000
    real(dp), parameter :: no_difference = 1e-200_dp   !! a rate times this is added to a state and does not change it
    type(handle_t), pointer :: self
    logical :: in_domain
    integer :: i, j
    integer(int64) :: before, after, rate
    call c_f_pointer(handle, self)
    self%y(:self%n) = y(:self%n)
    scene_seconds_in_turn = huge(1.0_dp)
    do i = 1, blocks
      call system_clock(before, rate)
      do j = 1, calls
        call self%scene%derivatives(t, self%y, self%f, in_domain)
        self%y = self%y + no_difference*self%f
      end do
      call system_clock(after)
      scene_seconds_in_turn = min(scene_seconds_in_turn, real(after - before, dp)/(real(rate, dp)*calls))
    end do
  end function scene_seconds_in_turn

  pure function text_of(c_text) result(text)
    character(kind=c_char), intent(in) :: c_text(*)
    character(len=:), allocatable :: text
    integer :: i, n
    n = 0
    do while (c_text(n + 1) /= c_null_char)
      n = n + 1
    end do
    allocate (character(len=n) :: text)
    do i = 1, n
      text(i:i) = c_text(i)
    end do
  end function text_of

  pure subroutine split_lines(text, lines, n)
    character(len=*), intent(in) :: text
    character(len=*), intent(out) :: lines(:)
    integer, intent(out) :: n
    integer :: first, length
    n = 0
    first = 1
    lines = ''
    do while (first <= len(text))
      length = index(text(first:), new_line('a')) - 1
      if (length < 0) length = len(text) - first + 1
      n = n + 1
      lines(n) = text(first:first + length - 1)
      first = first + length + 1
    end do
  end subroutine split_lines
end module scene_library
