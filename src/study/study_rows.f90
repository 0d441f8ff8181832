!> What is written of a run of a study: its row among all runs, one for each of its revolutions, one for each strobe.
module study_rows
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use chain_motion, only: crank_pin, piston_pin, name_prefix
  use case_definition, only: case_t, crank_pin_place
  use gudgeon_columns, only: column_list_t, column_name
  use cycle_statistics, only: cycle_t, cycle_statistics_t
  use cycle_watch, only: cycle_watch_t
  use gudgeon_simulation, only: run_report_t
  use gudgeon_summary, only: relative_residual
  use number_writer, only: number_writer_t
  use row_text, only: row_text_t
  implicit none
  private
  public :: run_header, cycle_header, strobe_header, cycles_column, strobes_column, may_have_crank_pin
  public :: write_run, write_failure, write_cycles, write_strobes

  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: statistics_columns = 11   !! of a run, from the cycles to the dissipated energy
  integer, parameter :: work_columns = 3          !! behind them
  integer, parameter :: pin_columns = 8           !! of one pin among them

contains

  !> Whether runs of a study may have clearance at the crank pin, and so its columns: those of the base case do, or a parameter is of
  !> that joint.
  pure logical function may_have_crank_pin(keys, base)
    character(len=*), intent(in) :: keys(:)   !! of the parameters
    type(case_t), intent(in) :: base
    may_have_crank_pin = base%crank_pin%has_clearance() .or. any(index(keys, crank_pin_place//'.') == 1)
  end function may_have_crank_pin

  !> First row of NAME.runs.csv. Behind what every study has stand how many strobes were taken, where there are any to take, and the
  !> crank pin.
  function run_header(keys, has_strobes, has_crank_pin) result(text)
    character(len=*), intent(in) :: keys(:)
    logical, intent(in) :: has_strobes, has_crank_pin
    character(len=:), allocatable :: text
    type(row_text_t) :: row
    integer :: i
    call row%add_text('run')
    do i = 1, size(keys)
      call row%add_text(keys(i))
    end do
    text = row%text(:row%used)//',status,cycles[-]'//run_columns('')//',mean_crank_speed[rad/s],'// &
      'dissipated_energy[J],energy_residual[-],rhs_evaluations[-],simulated_time[s]'
    if (has_strobes) text = text//',strobes[-]'
    if (has_crank_pin) text = text//run_columns(name_prefix(crank_pin))
    text = text//newline
  end function run_header

  !> The columns of one pin there.
  pure function run_columns(prefix) result(text)
    character(len=*), intent(in) :: prefix
    character(len=:), allocatable :: text
    text = ','//prefix//'min_film_thickness[m],'//prefix//'min_film_thickness_mean[m],'//prefix//'contact_time_fraction[-],'// &
      prefix//'impacts[-],'//prefix//'max_penetration[m],'//prefix//'max_pin_force[N],'//prefix//'max_pin_force_mean[N],'// &
      prefix//'mean_pin_force[N]'
  end function run_columns

  !> The column of cycles[-] in NAME.runs.csv: empty where a run has failed.
  pure integer function cycles_column(keys)
    character(len=*), intent(in) :: keys(:)
    cycles_column = size(keys) + 3
  end function cycles_column

  !> The column of strobes[-], where there is one.
  pure integer function strobes_column(keys)
    character(len=*), intent(in) :: keys(:)
    strobes_column = cycles_column(keys) + statistics_columns + work_columns
  end function strobes_column

  !> First row of NAME.cycles.csv.
  function cycle_header(has_crank_pin) result(text)
    logical, intent(in) :: has_crank_pin
    character(len=:), allocatable :: text
    text = 'run,cycle,duration[s]'//cycle_columns('')//',mean_crank_speed[rad/s],dissipated_energy[J]'
    if (has_crank_pin) text = text//cycle_columns(name_prefix(crank_pin))
    text = text//newline
  end function cycle_header

  !> The columns of one pin there.
  pure function cycle_columns(prefix) result(text)
    character(len=*), intent(in) :: prefix
    character(len=:), allocatable :: text
    text = ','//prefix//'min_film_thickness[m],'//prefix//'contact_time_fraction[-],'//prefix//'impacts[-],'// &
      prefix//'max_penetration[m],'//prefix//'max_pin_force[N],'//prefix//'mean_pin_force[N]'
  end function cycle_columns

  !> First row of NAME.strobe.csv.
  function strobe_header(list) result(text)
    type(column_list_t), intent(in) :: list
    character(len=:), allocatable :: text
    integer :: i
    text = 'run,cycle'
    do i = 1, size(list%id)
      text = text//','//column_name(list, i)
    end do
    text = text//newline
  end function strobe_header

  !> The row of a run that is done, with at least one revolution.
  subroutine write_run(row, numbers, run, values, watch, report, case, has_crank_pin)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    character(len=*), intent(in) :: values(:)
    type(cycle_watch_t), intent(in) :: watch
    type(run_report_t), intent(in) :: report
    type(case_t), intent(in) :: case
    logical, intent(in) :: has_crank_pin   !! the columns
    call begin_row(row, run, values)
    call row%add_text('done')
    associate (s => watch%statistics, total => watch%statistics%total)
      call row%add_whole(s%cycles)
      call add_run_columns(row, numbers, s, piston_pin, case%joint%has_clearance(), .true.)
      call row%add_number(numbers, watch%direction*two_pi*s%cycles/total%duration)
      call add(row, numbers, s%dissipated_energy_mean(), case%has_play())
    end associate
    call add_work(row, numbers, report)
    if (size(watch%strobe_list%id) > 0) call row%add_whole(watch%strobes)
    if (has_crank_pin) call add_run_columns(row, numbers, watch%statistics, crank_pin, case%crank_pin%has_clearance(), &
      case%crank_pin%has_clearance())
    call row%end_row()
  end subroutine write_run

  !> What `run_columns` names.
  subroutine add_run_columns(row, numbers, statistics, pin, has_clearance, has_force)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    type(cycle_statistics_t), intent(in) :: statistics
    integer, intent(in) :: pin
    logical, intent(in) :: has_clearance, has_force
    associate (total => statistics%total%pin(pin), duration => statistics%total%duration)
      call add(row, numbers, total%min_film_thickness, has_clearance)
      call add(row, numbers, statistics%min_film_thickness_mean(pin), has_clearance)
      call add(row, numbers, total%contact_time/duration, has_clearance)
      call add(row, numbers, statistics%impacts_mean(pin), has_clearance)
      call add(row, numbers, total%max_penetration, has_clearance)
      call add(row, numbers, total%max_force, has_force)
      call add(row, numbers, statistics%max_force_mean(pin), has_force)
      call add(row, numbers, total%force_integral/duration, has_force)
    end associate
  end subroutine add_run_columns

  !> The row of a run that is not done: why, and what it came to if it began.
  subroutine write_failure(row, numbers, run, values, reason, has_begun, has_strobes, has_crank_pin, report)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    character(len=*), intent(in) :: values(:), reason
    logical, intent(in) :: has_begun, has_strobes, has_crank_pin
    type(run_report_t), intent(in) :: report
    integer :: i
    call begin_row(row, run, values)
    call row%add_text(reason)
    call leave_out(statistics_columns)
    if (has_begun) then
      call add_work(row, numbers, report)
    else
      call leave_out(work_columns)
    end if
    if (has_strobes) call leave_out(1)
    if (has_crank_pin) call leave_out(pin_columns)
    call row%end_row()

  contains

    subroutine leave_out(n)
      integer, intent(in) :: n
      do i = 1, n
        call row%add_text('')
      end do
    end subroutine leave_out
  end subroutine write_failure

  subroutine begin_row(row, run, values)
    type(row_text_t), intent(inout) :: row
    integer, intent(in) :: run
    character(len=*), intent(in) :: values(:)
    integer :: i
    call row%clear()
    call row%add_whole(run)
    do i = 1, size(values)
      call row%add_text(values(i))
    end do
  end subroutine begin_row

  !> A number that the scene may not have.
  subroutine add(row, numbers, value, is_there)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    real(dp), intent(in) :: value
    logical, intent(in) :: is_there
    if (is_there) then
      call row%add_number(numbers, value)
    else
      call row%add_text('')
    end if
  end subroutine add

  !> Energy residual, evaluations, simulated time.
  subroutine add_work(row, numbers, report)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    type(run_report_t), intent(in) :: report
    call row%add_number(numbers, relative_residual(report))
    call row%add_whole(report%statistics%evaluations)
    call row%add_number(numbers, report%figures%time)
  end subroutine add_work

  !> A row for each revolution counted.
  subroutine write_cycles(row, numbers, run, watch, case, has_crank_pin)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    type(cycle_watch_t), intent(in) :: watch
    type(case_t), intent(in) :: case
    logical, intent(in) :: has_crank_pin   !! the columns
    integer :: i
    call row%clear()
    do i = 1, watch%statistics%cycles
      associate (c => watch%cycles(i))
        call row%add_whole(run)
        call row%add_whole(watch%settle + i)
        call row%add_number(numbers, c%duration)
        call add_cycle_columns(piston_pin, case%joint%has_clearance(), .true.)
        call row%add_number(numbers, watch%direction*two_pi/c%duration)
        call add(row, numbers, c%dissipated_energy, case%has_play())
        if (has_crank_pin) call add_cycle_columns(crank_pin, case%crank_pin%has_clearance(), case%crank_pin%has_clearance())
        call row%end_row()
      end associate
    end do

  contains

    !> What `cycle_columns` names.
    subroutine add_cycle_columns(pin, has_clearance, has_force)
      integer, intent(in) :: pin
      logical, intent(in) :: has_clearance, has_force
      associate (c => watch%cycles(i)%pin(pin), duration => watch%cycles(i)%duration)
        call add(row, numbers, c%min_film_thickness, has_clearance)
        call add(row, numbers, c%contact_time/duration, has_clearance)
        if (has_clearance) call row%add_whole(c%impacts)
        if (.not. has_clearance) call row%add_text('')
        call add(row, numbers, c%max_penetration, has_clearance)
        call add(row, numbers, c%max_force, has_force)
        call add(row, numbers, c%force_integral/duration, has_force)
      end associate
    end subroutine add_cycle_columns
  end subroutine write_cycles

  !> A row for each strobe.
  subroutine write_strobes(row, numbers, run, watch)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    type(cycle_watch_t), intent(in) :: watch
    integer :: i, k
    call row%clear()
    do i = 1, watch%strobes
      call row%add_whole(run)
      call row%add_whole(watch%settle + i)
      do k = 1, size(watch%strobe_list%id)
        call row%add_number(numbers, watch%strobe_values(k, i))
      end do
      call row%end_row()
    end do
  end subroutine write_strobes
end module study_rows
