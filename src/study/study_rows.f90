!> Rows of the results of a study: one for each run, one for each revolution, one for each strobe. The header of each file is made
!> by the same procedure as the other rows, so that names and values of columns are defined in one place.
module study_rows
  use kinds, only: dp
  use constants, only: two_pi
  use joint_places, only: places, n_places, in_order, name_prefix
  use case_definition, only: case_t
  use trace_columns, only: column_list_t, column_name
  use cycle_statistics, only: cycle_t, cycle_statistics_t, skirt
  use cycle_watch, only: cycle_watch_t
  use study_statistics, only: statistic_t
  use simulation, only: run_report_t
  use result_notes, only: relative_residual
  use archard_wear, only: of_pin, of_bore
  use summary_quantities, only: study_columns, unit_of
  use number_text, only: number_writer_t
  use row_text, only: row_text_t
  implicit none
  private
  public :: study_row_t, run_header, cycle_header, strobe_header
  public :: add_run, add_cycles, add_strobes

  !> One or more rows.
  type, extends(row_text_t) :: study_row_t
    logical :: is_header = .false.       !! names of columns are written instead of values
    logical :: has_strobes = .false.     !! the study has strobes
    logical :: has_place(n_places) = .false.   !! the study has columns of the pin at each place
    logical :: has_guide = .false.       !! the study has columns of the piston in its bore
    logical :: has_wear = .false.        !! the study has columns of wear
    logical :: has_motion = .false.      !! the study has columns of the period or the Lyapunov exponent
    type(statistic_t), allocatable :: statistics(:)   !! of columns, in the rows of runs
    type(number_writer_t) :: numbers
    character(len=:), allocatable :: prefix   !! place of the joint whose columns are put
  contains
    procedure :: choose
    procedure, private :: add_named_real, add_named_whole
    generic :: add => add_named_real, add_named_whole
  end type study_row_t

contains

  !> Append a number, or the name of its column with its unit; an empty field if the scene does not have the quantity.
  pure subroutine add_named_real(self, name, value, is_known)
    class(study_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name   !! as it is declared in `study_columns`
    real(dp), intent(in) :: value
    logical, intent(in) :: is_known
    if (self%is_header) then
      call self%add_text(self%prefix//with_unit(name))
    else
      call self%add_number(self%numbers, value, is_known)
    end if
  end subroutine add_named_real

  pure subroutine add_named_whole(self, name, number, is_known)
    class(study_row_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: number
    logical, intent(in) :: is_known
    if (self%is_header) then
      call self%add_text(self%prefix//with_unit(name))
    else if (is_known) then
      call self%add_whole(number)
    else
      call self%add_text('')
    end if
  end subroutine add_named_whole

  !> The name of a column with its unit.
  pure function with_unit(name) result(text)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: text
    text = unit_of(study_columns, name)
    if (text /= '') text = '['//text//']'
    text = name//text
  end function with_unit

  !> Choose the columns that not all studies have: those of strobes, and those that the base case has or a parameter may add.
  pure subroutine choose(self, keys, base, has_strobes)
    class(study_row_t), intent(inout) :: self
    character(len=*), intent(in) :: keys(:)   !! keys of the parameters
    type(case_t), intent(in) :: base
    logical, intent(in) :: has_strobes
    integer :: i
    self%has_strobes = has_strobes
    self%has_place = [(base%joints(i)%has_bearing() .and. .not. base%has_numbers(i), i=1, n_places)]
    self%has_place(in_order(1)) = .true.
    self%has_guide = base%has_skirt_corners() .or. any(keys == 'guide.kind')
    self%has_wear = base%has_wear() .or. any(index(keys, 'wear.') > 0)
    do i = 1, n_places
      self%has_place(i) = self%has_place(i) .or. any(index(keys, trim(places(i)%name)//'.') == 1)
    end do
    self%has_motion = base%run%is_until_periodic() .or. base%run%lyapunov_revolutions > 0 .or. &
      any(keys == 'run.until') .or. any(keys == 'run.lyapunov_revolutions')
  end subroutine choose

  !> Header of NAME.runs.csv.
  function run_header(keys, base, has_strobes, statistics) result(text)
    character(len=*), intent(in) :: keys(:)
    type(case_t), intent(in) :: base
    logical, intent(in) :: has_strobes
    type(statistic_t), intent(in) :: statistics(:)
    character(len=:), allocatable :: text
    type(study_row_t) :: row
    type(cycle_watch_t) :: no_watch
    type(run_report_t) :: no_report
    type(case_t) :: no_case
    row%is_header = .true.
    call row%choose(keys, base, has_strobes)
    row%statistics = statistics
    call add_run(row, 0, keys, 'status', .false., 0, no_watch, no_report, no_case)
    text = row%text(:row%used)
  end function run_header

  !> Header of NAME.cycles.csv.
  function cycle_header(keys, base) result(text)
    character(len=*), intent(in) :: keys(:)
    type(case_t), intent(in) :: base
    character(len=:), allocatable :: text
    type(study_row_t) :: row
    type(case_t) :: no_case
    row%is_header = .true.
    call row%choose(keys, base, .false.)
    call add_cycle(row, 0, 0, cycle_t(duration=1.0_dp), 1.0_dp, no_case)
    text = row%text(:row%used)
  end function cycle_header

  !> Header of NAME.strobe.csv.
  function strobe_header(list) result(text)
    type(column_list_t), intent(in) :: list
    character(len=:), allocatable :: text
    integer :: i
    text = 'run,cycle'
    do i = 1, size(list%id)
      text = text//','//column_name(list, i)
    end do
    text = text//achar(10)
  end function strobe_header

  !> Append the row of a run: its outcome if it began, and its statistics if it is done and has at least one revolution. The columns
  !> of all studies are followed by the number of strobes, if the study has any, and by those of further pins.
  subroutine add_run(row, run, values, outcome, has_begun, notes, watch, report, case)
    class(study_row_t), intent(inout) :: row
    integer, intent(in) :: run
    character(len=*), intent(in) :: values(:)   !! values of the parameters; their keys in a header
    character(len=*), intent(in) :: outcome     !! done, or the reason of the failure
    logical, intent(in) :: has_begun
    integer, intent(in) :: notes                !! number of notes on values and results
    type(cycle_watch_t), intent(in) :: watch
    type(run_report_t), intent(in) :: report
    type(case_t), intent(in) :: case
    type(cycle_statistics_t) :: s
    logical :: is_done
    integer :: i

    is_done = outcome == 'done'
    s = watch%statistics
    if (.not. is_done) call s%add(cycle_t(duration=1.0_dp))   ! prevents divisions by 0
    call row%clear()
    row%prefix = ''
    call row%add('run', run, .true.)
    do i = 1, size(values)
      call row%add_text(values(i))
    end do
    call row%add_text(outcome)
    call row%add('cycles', s%cycles, is_done)
    call add_motion(row, s, watch%direction, case, is_done, .true.)
    call row%add('energy_residual', relative_residual(report), has_begun)
    call row%add('rhs_evaluations', report%statistics%evaluations, has_begun)
    call row%add('simulated_time', report%figures%time, has_begun)
    call row%add('notes', notes, has_begun)
    if (row%has_strobes) call row%add('strobes', watch%strobes, is_done)
    call add_further_joints(row, s, case, is_done, .true.)
    if (row%has_motion) then
      call row%add('period_revolutions', report%periods%period, is_done .and. report%periods%is_on)
      call row%add('lyapunov_exponent', report%exponent%mean, is_done .and. report%exponent%is_known)
      call row%add('lyapunov_exponent_error', report%exponent%error, is_done .and. report%exponent%is_known)
    end if
    do i = 1, n_places
      if (row%has_wear .and. row%has_place(in_order(i))) call add_wear(row, report, in_order(i), is_done)
    end do
    if (allocated(row%statistics)) call add_statistics(row, report)
    call row%end_row()
  end subroutine add_run

  !> Append the statistics of columns and results by name; a run that has reached its end has them, also without a whole revolution.
  subroutine add_statistics(row, report)
    class(study_row_t), intent(inout) :: row
    type(run_report_t), intent(in) :: report
    real(dp) :: value
    logical :: is_done, is_known
    integer :: i
    is_done = allocated(report%status)
    if (is_done) is_done = report%status == 'done'
    do i = 1, size(row%statistics)
      if (row%is_header) then
        call row%add_text(trim(row%statistics(i)%name))
        cycle
      end if
      call row%statistics(i)%value_in(report, i, value, is_known)
      call row%add_number(row%numbers, value, is_done .and. is_known)
    end do
  end subroutine add_statistics

  !> Append the columns of the worn surfaces of one joint: of the whole run, also of the revolutions that are not counted.
  subroutine add_wear(row, report, pin, is_done)
    class(study_row_t), intent(inout) :: row
    type(run_report_t), intent(in) :: report
    integer, intent(in) :: pin   !! index in `places`
    logical, intent(in) :: is_done
    real(dp) :: volume(2), depth(2)
    logical :: is_known
    integer :: i
    is_known = .false.
    volume = 0
    depth = 0
    if (allocated(report%wear)) then
      do i = 1, size(report%wear)
        if (report%wear(i)%place /= pin) cycle
        is_known = is_done
        volume = sum(report%wear(i)%volume, 1)
        depth = maxval(report%wear(i)%depth, 1)
      end do
    end if
    row%prefix = name_prefix(pin)
    call row%add('worn_volume_pin', volume(of_pin), is_known)
    call row%add('worn_volume_bore', volume(of_bore), is_known)
    call row%add('max_wear_depth_pin', depth(of_pin), is_known)
    call row%add('max_wear_depth_bore', depth(of_bore), is_known)
    row%prefix = ''
  end subroutine add_wear

  !> Append a row for each revolution counted.
  subroutine add_cycles(rows, run, watch, case)
    class(study_row_t), intent(inout) :: rows
    integer, intent(in) :: run
    type(cycle_watch_t), intent(in) :: watch
    type(case_t), intent(in) :: case
    integer :: i
    call rows%clear()
    do i = 1, watch%statistics%cycles
      call add_cycle(rows, run, watch%uncounted + i, watch%cycles(i), watch%direction, case)
    end do
  end subroutine add_cycles

  !> Append the row of one revolution; `number` counts from the start of the run.
  subroutine add_cycle(row, run, number, cycle, direction, case)
    class(study_row_t), intent(inout) :: row
    integer, intent(in) :: run, number
    type(cycle_t), intent(in) :: cycle
    real(dp), intent(in) :: direction   !! sense in which the crank turns: 1 or -1
    type(case_t), intent(in) :: case
    type(cycle_statistics_t) :: s
    call s%add(cycle)
    row%prefix = ''
    call row%add('run', run, .true.)
    call row%add('cycle', number, .true.)
    call row%add('duration', cycle%duration, .true.)
    call add_motion(row, s, direction, case, .true., .false.)
    call add_further_joints(row, s, case, .true., .false.)
    call row%end_row()
  end subroutine add_cycle

  !> Append the columns of the first pin and the motion that all studies have.
  subroutine add_motion(row, s, direction, case, is_known, with_means)
    class(study_row_t), intent(inout) :: row
    type(cycle_statistics_t), intent(in) :: s   !! of all revolutions of a run, or of one
    real(dp), intent(in) :: direction           !! sense in which the crank turns: 1 or -1
    type(case_t), intent(in) :: case
    logical, intent(in) :: is_known, with_means   !! the revolutions were made; means over several revolutions are wanted
    associate (first => in_order(1))
      call add_pin(row, s, first, is_known .and. case%joints(first)%has_bearing(), is_known, with_means)
    end associate
    call row%add('mean_crank_speed', direction*two_pi*s%cycles/s%total%duration, is_known)
    call row%add('dissipated_energy', s%total%dissipated_energy/s%cycles, is_known .and. case%has_play())
  end subroutine add_motion

  !> Append the columns of further pins and of the piston in its bore, if the study has them.
  subroutine add_further_joints(row, s, case, is_known, with_means)
    class(study_row_t), intent(inout) :: row
    type(cycle_statistics_t), intent(in) :: s
    type(case_t), intent(in) :: case
    logical, intent(in) :: is_known, with_means   !! see `add_motion`
    logical :: is_loose
    integer :: i
    do i = 2, n_places
      is_loose = is_known .and. case%joints(in_order(i))%has_bearing()
      if (row%has_place(in_order(i))) call add_pin(row, s, in_order(i), is_loose, is_loose, with_means)
    end do
    if (.not. row%has_guide) return
    is_loose = is_known .and. case%has_skirt_corners()
    row%prefix = 'guide_'
    associate (total => s%total%pin(skirt))
      call row%add('contact_time_fraction', total%contact_time/s%total%duration, is_loose)
      call add_impacts(row, total%impacts, s%cycles, is_loose, with_means)
      call row%add('max_penetration', total%max_penetration, is_loose)
      call row%add('max_force', total%max_force, is_loose)
      if (with_means) call row%add('max_force_mean', s%force_sum(skirt)/s%cycles, is_loose)
    end associate
    row%prefix = ''
  end subroutine add_further_joints

  subroutine add_pin(row, s, pin, has_clearance, has_force, with_means)
    class(study_row_t), intent(inout) :: row
    type(cycle_statistics_t), intent(in) :: s
    integer, intent(in) :: pin   !! index in `places`
    logical, intent(in) :: has_clearance, has_force, with_means
    row%prefix = name_prefix(pin)
    associate (total => s%total%pin(pin), duration => s%total%duration)
      call row%add('min_film_thickness', total%min_film_thickness, has_clearance)
      if (with_means) call row%add('min_film_thickness_mean', s%film_sum(pin)/s%cycles, has_clearance)
      call row%add('contact_time_fraction', total%contact_time/duration, has_clearance)
      call add_impacts(row, total%impacts, s%cycles, has_clearance, with_means)
      call row%add('max_penetration', total%max_penetration, has_clearance)
      call row%add('max_pin_force', total%max_force, has_force)
      if (with_means) call row%add('max_pin_force_mean', s%force_sum(pin)/s%cycles, has_force)
      call row%add('mean_pin_force', total%force_integral/duration, has_force)
    end associate
    row%prefix = ''
  end subroutine add_pin

  !> Append the number of impacts: the mean over the revolutions, or that of one revolution.
  subroutine add_impacts(row, impacts, cycles, is_known, as_mean)
    class(study_row_t), intent(inout) :: row
    integer, intent(in) :: impacts, cycles
    logical, intent(in) :: is_known, as_mean
    if (as_mean) call row%add('impacts', real(impacts, dp)/cycles, is_known)
    if (.not. as_mean) call row%add('impacts', impacts, is_known)
  end subroutine add_impacts

  !> Append a row for each strobe.
  subroutine add_strobes(rows, run, watch)
    class(study_row_t), intent(inout) :: rows
    integer, intent(in) :: run
    type(cycle_watch_t), intent(in) :: watch
    integer :: i, k
    call rows%clear()
    do i = 1, watch%strobes
      call rows%add_whole(run)
      call rows%add_whole(watch%uncounted + i)
      do k = 1, size(watch%strobe_list%id)
        call rows%add_number(rows%numbers, watch%strobe_values(k, i))
      end do
      call rows%end_row()
    end do
  end subroutine add_strobes
end module study_rows
