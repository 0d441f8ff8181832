!> What is written of a run of a study: its row among all runs, one for each of its revolutions, one for each strobe.
module study_rows
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use chain_motion, only: piston_pin
  use gudgeon_columns, only: column_list_t, column_name
  use cycle_statistics, only: cycle_t
  use cycle_watch, only: cycle_watch_t
  use gudgeon_simulation, only: run_report_t
  use gudgeon_summary, only: relative_residual
  use number_writer, only: number_writer_t
  use row_text, only: row_text_t
  implicit none
  private
  public :: run_header, cycle_header, strobe_header, cycles_column, strobes_column
  public :: write_run, write_failure, write_cycles, write_strobes

  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: statistics_columns = 11   !! of a run, from the cycles to the dissipated energy
  integer, parameter :: work_columns = 3          !! behind them

contains

  !> First row of NAME.runs.csv. How many strobes were taken stands last, where there are any to take.
  function run_header(keys, has_strobes) result(text)
    character(len=*), intent(in) :: keys(:)
    logical, intent(in) :: has_strobes
    character(len=:), allocatable :: text
    type(row_text_t) :: row
    integer :: i
    call row%add_text('run')
    do i = 1, size(keys)
      call row%add_text(keys(i))
    end do
    text = row%text(:row%used)//',status,cycles[-],min_film_thickness[m],min_film_thickness_mean[m],contact_time_fraction[-],'// &
      'impacts[-],max_penetration[m],max_pin_force[N],max_pin_force_mean[N],mean_pin_force[N],mean_crank_speed[rad/s],'// &
      'dissipated_energy[J],energy_residual[-],rhs_evaluations[-],simulated_time[s]'
    if (has_strobes) text = text//',strobes[-]'
    text = text//newline
  end function run_header

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
  function cycle_header() result(text)
    character(len=:), allocatable :: text
    text = 'run,cycle,duration[s],min_film_thickness[m],contact_time_fraction[-],impacts[-],max_penetration[m],'// &
      'max_pin_force[N],mean_pin_force[N],mean_crank_speed[rad/s],dissipated_energy[J]'//newline
  end function cycle_header

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
  subroutine write_run(row, numbers, run, values, watch, report, has_clearance)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    character(len=*), intent(in) :: values(:)
    type(cycle_watch_t), intent(in) :: watch
    type(run_report_t), intent(in) :: report
    logical, intent(in) :: has_clearance
    call begin_row(row, run, values)
    call row%add_text('done')
    associate (s => watch%statistics, total => watch%statistics%total)
      call row%add_whole(s%cycles)
      call add(row, numbers, total%pin(piston_pin)%min_film_thickness, has_clearance)
      call add(row, numbers, s%min_film_thickness_mean(piston_pin), has_clearance)
      call add(row, numbers, total%pin(piston_pin)%contact_time/total%duration, has_clearance)
      call add(row, numbers, s%impacts_mean(piston_pin), has_clearance)
      call add(row, numbers, total%pin(piston_pin)%max_penetration, has_clearance)
      call row%add_number(numbers, total%pin(piston_pin)%max_force)
      call row%add_number(numbers, s%max_force_mean(piston_pin))
      call row%add_number(numbers, total%pin(piston_pin)%force_integral/total%duration)
      call row%add_number(numbers, watch%direction*two_pi*s%cycles/total%duration)
      call add(row, numbers, s%dissipated_energy_mean(), has_clearance)
    end associate
    call add_work(row, numbers, report)
    if (size(watch%strobe_list%id) > 0) call row%add_whole(watch%strobes)
    call row%end_row()
  end subroutine write_run

  !> The row of a run that is not done: why, and what it came to if it began.
  subroutine write_failure(row, numbers, run, values, reason, has_begun, has_strobes, report)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    character(len=*), intent(in) :: values(:), reason
    logical, intent(in) :: has_begun, has_strobes
    type(run_report_t), intent(in) :: report
    integer :: i
    call begin_row(row, run, values)
    call row%add_text(reason)
    do i = 1, statistics_columns
      call row%add_text('')
    end do
    if (has_begun) then
      call add_work(row, numbers, report)
    else
      do i = 1, work_columns
        call row%add_text('')
      end do
    end if
    if (has_strobes) call row%add_text('')
    call row%end_row()
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
  subroutine write_cycles(row, numbers, run, watch, has_clearance)
    type(row_text_t), intent(inout) :: row
    type(number_writer_t), intent(in) :: numbers
    integer, intent(in) :: run
    type(cycle_watch_t), intent(in) :: watch
    logical, intent(in) :: has_clearance
    integer :: i
    call row%clear()
    do i = 1, watch%statistics%cycles
      associate (c => watch%cycles(i))
        call row%add_whole(run)
        call row%add_whole(watch%settle + i)
        call row%add_number(numbers, c%duration)
        call add(row, numbers, c%pin(piston_pin)%min_film_thickness, has_clearance)
        call add(row, numbers, c%pin(piston_pin)%contact_time/c%duration, has_clearance)
        if (has_clearance) call row%add_whole(c%pin(piston_pin)%impacts)
        if (.not. has_clearance) call row%add_text('')
        call add(row, numbers, c%pin(piston_pin)%max_penetration, has_clearance)
        call row%add_number(numbers, c%pin(piston_pin)%max_force)
        call row%add_number(numbers, c%pin(piston_pin)%force_integral/c%duration)
        call row%add_number(numbers, watch%direction*two_pi/c%duration)
        call add(row, numbers, c%dissipated_energy, has_clearance)
        call row%end_row()
      end associate
    end do
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
