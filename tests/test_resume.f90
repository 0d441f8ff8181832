!> A run that is stopped between any two steps and continued ends with results identical to an uninterrupted run.
module test_resume
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t
  use gudgeon_archive, only: archive_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use gudgeon_columns, only: column_list_t, choose_columns
  use gudgeon_simulation, only: simulate, run_report_t
  use collecting_sink, only: collecting_sink_t
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_resume

  integer, parameter :: long = 60, most_pieces = 5000

  !> Keeps the last state that it was given, and the number of rows at that time.
  type, extends(collecting_sink_t) :: keeping_sink_t
    character(len=:), allocatable :: state
    integer :: rows_then = 0, events_then = 0
  contains
    procedure :: take_archive => keep
  end type keeping_sink_t

contains

  subroutine run_test_resume(check)
    class(checks_t), intent(inout) :: check
    call archives_give_back_what_they_took(check)
    call archives_refuse_what_does_not_fit(check)
    call split(check, 'cases/flores/friction_100.nml', 'revolutions=0.2', 'adams', 'drive.kind=constant_speed')
    call split(check, 'cases/flores/friction_100.nml', 'revolutions=0.4', 'auto', 'drive.kind=free')
    call split(check, 'cases/flores/friction_100.nml', 'revolutions=0.2', 'adams', 'friction.law=coulomb')
    call split(check, 'cases/friction/lugre.nml', 'revolutions=0.1', 'radau', 'drive.kind=constant_speed')
    call split(check, 'cases/friction/lugre.nml', 'revolutions=0.1', 'auto', 'friction.law=elasto_plastic')
    call split(check, 'cases/friction/lugre.nml', 'revolutions=0.05', 'adams', 'friction.law=dahl')
    call split(check, 'cases/friction/brown_mcphee.nml', 'revolutions=0.1', 'auto', 'friction.report_work=T')
    call split(check, 'cases/flores/dry_0100um.nml', 'revolutions=0.1', 'adams', 'integrator.contact_entry=step_rejection')
    call split(check, 'cases/flores/dry_0500um.nml', 'revolutions=0.2', 'radau', 'output.every_step=T')
    call split(check, 'cases/flores/lubricated_400cP.nml', 'revolutions=0.2', 'adams', 'integrator.max_step=1e-4')
    call split(check, 'cases/flores/lubricated_400cP.nml', 'revolutions=0.5', 'auto', 'drive.kind=constant_speed')
    call split(check, 'cases/sim_II.nml', 'revolutions=1', 'radau', 'integrator.relative_tolerance=1e-8')
    call split(check, 'cases/sim_I.nml', 'revolutions=0.8', 'radau', 'integrator.relative_tolerance=1e-10')
    call split(check, 'cases/sim_II.nml', 'revolutions=0.4', 'auto', 'output.digits=17')
    call split(check, 'cases/sim_V_oscillating.nml', 'revolutions=0.1', 'auto', 'output.start_time=1e-3')
    call split(check, 'cases/sim_IV.nml', 'revolutions=0.2', 'auto', 'initial.crank_angle_deg=330')
    call split(check, 'cases/sim_IV.nml', 'revolutions=2', 'adams', 'initial.crank_angle_deg=10', .true.)
    call split(check, 'cases/flores/ideal.nml', 'revolutions=1', 'auto', 'drive.kind=constant_speed', .true.)
    call split(check, 'cases/flores/ideal.nml', 'crank_revolutions=1', 'adams', 'drive.damping=0.1', .true.)
    call split(check, 'cases/sim_IV.nml', 'crank_revolutions=1', 'auto', 'initial.crank_angle_deg=330')
    call split(check, 'cases/sim_I.nml', 'crank_revolutions=0.1', 'auto', 'drive.torque=100', from_rest=.true.)
    call split(check, 'cases/sim_I_oscillating.nml', 'revolutions=0.2', 'auto', 'output.sampling=crank_angle')
    call split(check, 'cases/flores/dry_0500um.nml', 'revolutions=0.2', 'adams', 'output.sampling=crank_angle')
    call split(check, 'cases/film/elastic.nml', 'revolutions=0.1', 'auto', 'lubrication.variant=short')
    call split(check, 'cases/film/weighted.nml', 'revolutions=0.4', 'auto', 'lubrication.transition_shape=linear')
    call split(check, 'cases/flores/lubricated_400cP.nml', 'revolutions=1', 'auto', 'run.until=periodic')
    call split(check, 'cases/joints/both_pins.nml', 'revolutions=0.1', 'auto', 'drive.kind=free')
    call split(check, 'cases/joints/both_pins.nml', 'revolutions=0.05', 'radau', 'friction.law=coulomb')
    call split(check, 'cases/joints/piston_slap.nml', 'revolutions=0.1', 'auto', 'guide.exponent=1.5')
    call split(check, 'cases/joints/piston_slap.nml', 'revolutions=0.05', 'radau', 'guide.contact_law=hertz')
    call split(check, 'cases/flores/ideal.nml', 'revolutions=1', 'adams', 'guide.coefficient=0.1')
    call split(check, 'cases/joints/crank_pin.nml', 'revolutions=0.2', 'adams', 'crank_pin.joint.clearance=5e-5')
    call split(check, 'cases/joints/both_pins_lubricated.nml', 'revolutions=0.2', 'auto', 'mechanism.gravity_angle_deg=30')
    call split(check, 'cases/contact/pereira_impact.nml', 'revolutions=0.05', 'radau', 'initial.crank_angle_deg=203.7479')
    call split(check, 'cases/joints/piston_slap.nml', 'revolutions=0.05', 'adams', 'guide.contact_law=impact', &
      more=[character(len=long) :: 'guide.damping=4e4', 'guide.full_damping_depth=4e-6'])
    call split(check, 'cases/wear/flores.nml', 'revolutions=0.2', 'auto', 'wear.bins=36')
    call split(check, 'cases/wear/worn_bore.nml', 'revolutions=1.02', 'adams', 'initial.crank_speed=1000')
    call split(check, 'cases/film/weighted.nml', 'revolutions=0.4', 'radau', 'wear.rate=1e-15,1e-15')
    call split(check, 'cases/film/sim_IV_mixed.nml', 'revolutions=0.1', 'auto', 'lubrication.variant=short')
    call split(check, 'cases/elastic/engine_rod.nml', 'revolutions=0.05', 'radau', 'elastic_rod.axial_shapes=1')
    call split(check, 'cases/elastic/dry_friction.nml', 'revolutions=0.01', 'auto', 'elastic_rod.transverse_modes=2')
    call split(check, 'cases/elastic/engine_crankshaft.nml', 'revolutions=0.1', 'auto', 'crankshaft.torsional_damping=1')
    call split(check, 'cases/gas/compressor.nml', 'revolutions=1.2', 'auto', 'drive.kind=constant_speed')
    call split(check, 'cases/gas/compressor.nml', 'revolutions=1.2', 'adams', 'drive.kind=free', .true.)
    call split(check, 'cases/gas/two_stroke.nml', 'revolutions=1.2', 'adams', 'drive.kind=constant_speed', .true.)
    call split(check, 'cases/gas/measured.nml', 'revolutions=0.3', 'auto', 'drive.kind=constant_speed')
    call split(check, 'cases/joints/guide_friction.nml', 'revolutions=0.3', 'auto', 'guide.coefficient=0.1')
    call split(check, 'cases/flores/ideal.nml', 'revolutions=4', 'adams', 'integrator.max_evaluations_per_revolution=200', .true.)
  end subroutine run_test_resume

  !> One scene: uninterrupted, stopped and continued after every step, and after every few steps.
  subroutine split(check, file, revolutions, method, change, ideal_joint, from_rest, more)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: file, revolutions, method, change
    logical, intent(in), optional :: ideal_joint, from_rest
    character(len=*), intent(in), optional :: more(:)
    type(case_t) :: case
    type(column_list_t) :: list
    type(error_t), allocatable :: error
    type(keeping_sink_t) :: whole, parts
    type(run_report_t) :: report, other
    character(len=long) :: overrides(7)
    character(len=:), allocatable :: what
    integer :: stride, pieces
    logical :: ideal

    ideal = present(ideal_joint)
    overrides(1) = 'integrator.'//revolutions
    overrides(2) = 'integrator.method='//method
    overrides(3) = change
    overrides(4:) = 'integrator.max_penetration=1e-8'
    if (present(from_rest)) overrides(5:) = [character(len=long) :: 'initial.crank_speed=0', 'integrator.end_time=1', &
                                             'output.interval=1e-4']
    if (present(more)) overrides(5:4 + size(more)) = more
    call read_case(file, overrides, case, error)
    if (.not. allocated(error)) call choose_columns(case, ideal, list, error)
    what = file//', '//method//', '//change//': '
    call check%that(.not. allocated(error), what//'a correct case')
    if (allocated(error)) return
    call run_in_parts(case, ideal, list, 0, whole, report, pieces)
    call check%that(report%status == 'done' .and. pieces == 1, what//report%status)
    do stride = 1, 23, 11
      call run_in_parts(case, ideal, list, stride, parts, other, pieces)
      call check%that(pieces >= report%statistics%accepted/stride, what//'one part for each step')
      call check%that(same_rows(whole, parts) .and. same_events(whole, parts) .and. text_of(report) == text_of(other) &
        .and. same_wear(report, other), &
        what//'a run in parts is not the uninterrupted run, bit for bit: a component that is kept between steps is missing in '// &
        'the `exchange` of its type (ode_problem_t, ode_method_t, event_watch_t, observer_t and types that extend them)')
    end do
  end subroutine split

  !> Run a case, stopping after every `stride` steps (0: never) and continuing with new objects, except for the sink.
  subroutine run_in_parts(case, ideal, list, stride, kept, report, pieces)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: stride
    type(keeping_sink_t), intent(out) :: kept
    type(run_report_t), intent(out) :: report
    integer, intent(out) :: pieces
    type(error_t), allocatable :: error
    type(archive_t) :: archive
    type(case_t) :: limited

    limited = case
    kept%keeps_archives = stride > 0
    kept%wants_to_stop = stride == 1   ! after one step
    if (stride > 1) limited%integrator%max_steps = stride
    call simulate(limited, ideal, list, kept, report, error)
    pieces = 1
    do while (index(report%status, trim(merge('interrupted   ', 'too many steps', stride == 1))) == 1 .and. pieces < most_pieces)
      if (.not. allocated(kept%state)) exit
      kept%rows = kept%rows_then
      kept%events = kept%events_then
      call archive%begin_reading(kept%state)
      if (stride > 1) limited%integrator%max_steps = limited%integrator%max_steps + stride
      call soil_memory()
      call simulate(limited, ideal, list, kept, report, error, archive)
      pieces = pieces + 1
    end do
  end subroutine run_in_parts

  !> Fill free memory of the heap with arbitrary numbers: an array that is allocated again but not restored
  !> must not have its old values by accident.
  subroutine soil_memory()
    integer, parameter :: blocks = 12, largest = 400
    type :: block_t
      real(dp), allocatable :: values(:)
    end type block_t
    type(block_t) :: block(blocks)
    integer :: length, i
    do length = 1, largest
      do i = 1, blocks
        allocate (block(i)%values(length), source=-3e33_dp)
      end do
      do i = 1, blocks
        deallocate (block(i)%values)
      end do
    end do
  end subroutine soil_memory

  subroutine keep(self, archive)
    class(keeping_sink_t), intent(inout) :: self
    type(archive_t), intent(in) :: archive
    call archive%contents(self%state)
    self%rows_then = self%rows
    self%events_then = self%events
  end subroutine keep

  pure logical function same_rows(a, b)
    type(keeping_sink_t), intent(in) :: a, b
    same_rows = a%rows == b%rows
    if (same_rows .and. a%rows > 0) same_rows = all(transfer(a%values(:, :a%rows), [0_int64]) == &
                                                    transfer(b%values(:, :b%rows), [0_int64]))
  end function same_rows

  logical function same_events(a, b)
    type(keeping_sink_t), intent(in) :: a, b
    character(len=1000) :: one, other
    integer :: i
    same_events = a%events == b%events
    do i = 1, merge(a%events, 0, same_events)
      write (one, *) a%event(i)
      write (other, *) b%event(i)
      same_events = same_events .and. one == other
    end do
  end function same_events

  !> Whether the same volumes wear from each bin, bit for bit, and the same numbers describe a worn bore.
  pure logical function same_wear(a, b)
    type(run_report_t), intent(in) :: a, b
    integer :: i
    same_wear = size(a%wear) == size(b%wear)
    do i = 1, merge(size(a%wear), 0, same_wear)
      same_wear = same_wear .and. all(transfer([a%wear(i)%volume, a%wear(i)%depth], [0_int64]) == &
                                      transfer([b%wear(i)%volume, b%wear(i)%depth], [0_int64])) &
        .and. all(transfer([a%wear(i)%turns, a%wear(i)%step_ratios], [0_int64]) == &
                  transfer([b%wear(i)%turns, b%wear(i)%step_ratios], [0_int64]))
    end do
  end function same_wear

  !> Statistics and figures, every component to its last digit.
  function text_of(report) result(text)
    type(run_report_t), intent(in) :: report
    character(len=4000) :: text
    write (text, *) report%statistics, report%figures
    if (allocated(report%time_with)) write (text(3000:), *) report%time_with
  end function text_of

  subroutine archives_give_back_what_they_took(check)
    class(checks_t), intent(inout) :: check
    type(archive_t) :: archive
    character(len=:), allocatable :: bytes, text
    real(dp) :: number, numbers(3), matrix(2, 2)
    integer(int64) :: long_number
    integer :: whole, wholes(2)
    logical :: truth, truths(2)

    number = 0.1_dp
    numbers = [-0.0_dp, tiny(1.0_dp)/8, huge(1.0_dp)]
    matrix = reshape([1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp], [2, 2])
    whole = -7
    wholes = [huge(1), -huge(1)]
    long_number = 2_int64**40
    truth = .true.
    truths = [.false., .true.]
    text = ''
    call archive%begin_writing()
    call exchange_everything()
    call archive%contents(bytes)
    number = 0
    numbers = 0
    matrix = 0
    whole = 0
    wholes = 0
    long_number = 0
    truth = .false.
    truths = .false.
    text = 'else'
    call archive%begin_reading(bytes)
    call exchange_everything()
    call check%that(archive%is_at_end() .and. .not. archive%failed, 'an archive is read to its end')
    call check%that(.not. abs(number - 0.1_dp) > 0 .and. all(wholes == [huge(1), -huge(1)]) .and. whole == -7 .and. truth &
      .and. long_number == 2_int64**40 .and. all(truths .eqv. [.false., .true.]) .and. text == '', 'an archive restores its values')
    call check%that(all(transfer(numbers, [0_int64]) == transfer([-0.0_dp, tiny(1.0_dp)/8, huge(1.0_dp)], [0_int64])) &
      .and. .not. abs(matrix(2, 1) - 2) > 0, 'an archive restores numbers to the last bit')

  contains

    subroutine exchange_everything()
      call archive%exchange(number)
      call archive%exchange(numbers)
      call archive%exchange(matrix)
      call archive%exchange(whole)
      call archive%exchange(wholes)
      call archive%exchange(long_number)
      call archive%exchange(truth)
      call archive%exchange(truths)
      call archive%exchange_text(text)
    end subroutine exchange_everything
  end subroutine archives_give_back_what_they_took

  subroutine archives_refuse_what_does_not_fit(check)
    class(checks_t), intent(inout) :: check
    type(archive_t) :: archive
    character(len=:), allocatable :: bytes, text
    real(dp) :: numbers(3)
    integer :: whole
    numbers = 1
    call archive%begin_writing()
    call archive%exchange(numbers)
    call archive%contents(bytes)
    call archive%begin_reading(bytes)
    whole = 5
    call archive%exchange(whole)
    call check%that(archive%failed .and. whole == 5, 'a number of another kind is refused')
    call archive%begin_reading(bytes)
    call archive%exchange(numbers(:2))
    call check%that(archive%failed, 'another number of values is refused')
    call archive%begin_reading(bytes(:len(bytes) - 1))
    call archive%exchange(numbers)
    call check%that(archive%failed, 'an archive that ends too early is refused')
    call archive%begin_reading(bytes)
    call archive%exchange_text(text)
    call check%that(archive%failed, 'numbers in place of a text are refused')
    call archive%begin_reading(bytes)
    call check%that(.not. archive%is_at_end(), 'values left over in an archive are detected')
  end subroutine archives_refuse_what_does_not_fit
end module test_resume
