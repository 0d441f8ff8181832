!> Films with memory: their march after a run, their files and their rows of the summary.
!>
!> NAME.film_history.csv has a row for each row of the last cycle, and NAME.film.csv the fields at the times that the case asks for.
!> If several joints of a case have such a film, the names of the former carry the place: NAME.crank_pin.film_history.csv.
module history_files
  use kinds, only: dp
  use error_handling, only: error_t
  use case_definition, only: case_t
  use film_files, only: progress_watch_t
  use film_history, only: film_history_t, film_duty_t
  use film_results, only: film_field_t
  use growing_text, only: growing_text_t
  use history_record, only: history_record_t
  use joint_places, only: name_prefix, spot_name
  use number_text, only: real_text
  use result_file, only: write_text
  use result_table, only: result_table_t
  use simulation, only: run_report_t
  use summary_rows, only: summary_row_t, read_rows
  use constants, only: degree
  implicit none
  private
  public :: march_histories, write_histories, add_histories, history_value

  character(len=*), parameter :: newline = achar(10)
  character(len=*), parameter :: field_columns = 'angle[rad],film_thickness[m],place[m],pressure[Pa],film_fraction[-]'

contains

  !> March the films with memory of a run that is done. The first error ends this, and is the status of the run; films keep the rows
  !> that they have.
  subroutine march_histories(case, shows_progress, report, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: shows_progress
    type(run_report_t), intent(inout) :: report
    type(error_t), allocatable, intent(inout) :: error
    type(progress_watch_t) :: watch
    integer :: i
    if (.not. allocated(report%histories)) return
    if (report%status /= 'done') then
      deallocate (report%histories)
      return
    end if
    do i = 1, size(report%histories)
      call watch%progress%start(case%name//': film with memory', shows_progress)
      call report%histories(i)%march(watch, error)
      call watch%progress%finish()
      if (.not. allocated(error)) cycle
      report%status = error%message
      return
    end do
  end subroutine march_histories

  !> Write the files of the films with memory of a run. Error: a file cannot be written (status_output).
  subroutine write_histories(base, case, histories, error)
    character(len=*), intent(in) :: base
    type(case_t), intent(in) :: case
    type(history_record_t), intent(in) :: histories(:)
    type(error_t), allocatable, intent(out) :: error
    type(growing_text_t) :: fields
    character(len=:), allocatable :: path
    integer :: i, k
    call fields%append('time[s],crank_angle[rad],joint,'//field_columns//newline)
    do i = 1, size(histories)
      path = base
      if (size(histories) > 1) path = base//'.'//spot_name(histories(i)%spot)
      associate (of => histories(i))
        if (.not. allocated(of%history%rows)) cycle
        call write_rows(path, of, case%output%digits, error)
        if (allocated(error)) return
        if (.not. allocated(of%history%fields)) cycle
        do k = 1, size(of%history%fields)
          associate (field => of%history%fields(k))
            call append_field(fields, field, real_text(field%time, case%output%digits)//','//real_text(of%angle( &
              max(1, minloc(abs(of%history%rows%time - field%time), 1))), case%output%digits)//','//spot_name(of%spot), &
              case%output%digits)
          end associate
        end do
      end associate
    end do
    if (case%output%film_times /= '') call write_text(base//'.film.csv', fields%text(:fields%used), error)
  end subroutine write_histories

  !> Write the rows of one film, beside them those of the film of the run.
  subroutine write_rows(base, of, digits, error)
    character(len=*), intent(in) :: base
    type(history_record_t), intent(in) :: of
    integer, intent(in) :: digits
    type(error_t), allocatable, intent(out) :: error
    type(growing_text_t) :: file
    real(dp), allocatable :: numbers(:)
    integer :: i
    logical :: has_bore
    has_bore = of%history%bore%shapes() > 0
    call file%append('time[s],eccentricity_x[m],eccentricity_y[m],film_force_x[N],film_force_y[N],min_film_thickness[m],'// &
      'max_film_pressure[Pa],film_fill[-],supply_flow[m3/s],side_flow[m3/s],film_moment[N.m]')
    if (has_bore) call file%append(',bore_deflection[m]')
    if (of%history%shape%is_tilted()) call file%append(',film_tilting_moment_x[N.m],film_tilting_moment_y[N.m]')
    call file%append(',crank_angle[rad],quick_film_thickness[m],quick_film_pressure[Pa]'//newline)
    do i = 1, size(of%history%rows)
      associate (row => of%history%rows(i))
        numbers = [row%time, row%eccentricity, row%force, row%min_thickness, row%max_pressure, row%fill, row%supply_flow, &
          row%side_flow, row%moment]
        if (has_bore) numbers = [numbers, row%bore_deflection]
        if (of%history%shape%is_tilted()) numbers = [numbers, row%tilting_moment]
      end associate
      call append_numbers(file, [numbers, of%angle(i), of%quick_thickness(i), of%quick_pressure(i)], digits)
    end do
    call write_text(base//'.film_history.csv', file%text(:file%used), error)
  end subroutine write_rows

  !> Append one row for each cell on half of the bearing; that on the other half is the same, unless the pin is tilted.
  subroutine append_field(file, field, head, digits)
    type(growing_text_t), intent(inout) :: file
    type(film_field_t), intent(in) :: field
    character(len=*), intent(in) :: head   !! first columns of each row
    integer, intent(in) :: digits
    integer :: j, k
    do j = 1, size(field%angle)
      do k = 1, size(field%axial)
        call file%append(head//',')
        call append_numbers(file, &
          [field%angle(j), field%thickness(k, j), field%axial(k), field%pressure(k, j), field%fraction(k, j)], digits)
      end do
    end do
  end subroutine append_field

  subroutine append_numbers(file, numbers, digits)
    type(growing_text_t), intent(inout) :: file
    real(dp), intent(in) :: numbers(:)
    integer, intent(in) :: digits
    integer :: k
    call file%append(real_text(numbers(1), digits))
    do k = 2, size(numbers)
      call file%append(','//real_text(numbers(k), digits))
    end do
    call file%append(newline)
  end subroutine append_numbers

  !> Rows of the summary for the films with memory of a run.
  subroutine add_histories(table, histories)
    type(result_table_t), intent(inout) :: table
    type(history_record_t), intent(in) :: histories(:)
    integer :: i
    do i = 1, size(histories)
      if (allocated(histories(i)%history%rows)) call add_history(table, histories(i), name_prefix(histories(i)%spot))
    end do
  end subroutine add_histories

  !> The value of one of these rows; `is_known` is false if there is none.
  subroutine history_value(histories, name, value, is_known)
    type(history_record_t), intent(in) :: histories(:)
    character(len=*), intent(in) :: name   !! with the prefix of its place
    real(dp), intent(inout) :: value
    logical, intent(out) :: is_known
    type(result_table_t) :: table
    type(summary_row_t), allocatable :: rows(:)
    integer :: i
    call table%clear()
    table%digits = 17   ! every bit
    call add_histories(table, histories)
    call read_rows(table%text(:table%used), rows)
    is_known = .false.
    do i = 1, size(rows)
      if (rows(i)%name /= name) cycle
      value = rows(i)%value
      is_known = .true.
    end do
  end subroutine history_value

  !> Rows of the summary for one film with memory, and for that of the run beside it.
  subroutine add_history(table, of, prefix)
    type(result_table_t), intent(inout) :: table
    type(history_record_t), intent(in) :: of
    character(len=*), intent(in) :: prefix
    integer :: k
    associate (found => of%history%summary, rows => of%history%rows, shape => of%history%shape)
      call table%add('film_history_cycles', found%cycles, prefix)
      if (size(rows) == 0) return
      call table%add('film_history_cycle_change', found%content_change, prefix)
      call table%add('film_history_min_film_thickness', found%min_thickness, prefix)
      call table%add('film_history_max_film_pressure', found%max_pressure, prefix)
      call table%add('film_history_mean_supply_flow', found%mean_supply_flow, prefix)
      call table%add('film_history_mean_side_flow', found%mean_side_flow, prefix)
      call table%add('film_history_least_fill', found%least_fill, prefix)
      call table%add('film_history_mean_power_loss', mean_loss(of%history, of%duty), prefix)
      call table%add('film_history_mass_residual', found%mass_residual, prefix)
      call table%add('film_history_cells_per_gap', found%cells_per_gap, prefix)
      if (shape%is_tilted()) call table%add('film_history_max_tilting_moment', found%max_tilting_moment, prefix)
      if (shape%is_there()) call table%add('film_history_shape_depth', shape%depth(), prefix)
      k = minloc(rows%min_thickness, 1)
      call table%add('film_history_min_film_thickness_angle', modulo(of%angle(k), of%cycle)/degree, prefix)
      call table%add('film_history_quick_min_film_thickness', minval(of%quick_thickness), prefix)
      call table%add('film_history_quick_max_film_pressure', maxval(of%quick_pressure), prefix)
      if (.not. all(of%quick_thickness > 0)) return   ! the surfaces touch in the run
      k = maxloc(abs(log(rows%min_thickness/of%quick_thickness(:size(rows)))), 1)
      call table%add('film_history_thickness_ratio', rows(k)%min_thickness/of%quick_thickness(k), prefix)
      call table%add('film_history_thickness_ratio_time', rows(k)%time, prefix)
    end associate
  end subroutine add_history

  !> Mean of the power that the shear of the film takes from the pin, over the time of the last cycle [W].
  pure real(dp) function mean_loss(history, duty)
    type(film_history_t), intent(in) :: history
    type(film_duty_t), intent(in) :: duty
    real(dp) :: taken
    integer :: i
    associate (rows => history%rows)
      if (size(duty%time) == 1) then
        mean_loss = -rows(1)%moment*duty%pin_speed(1)
        return
      end if
      taken = 0
      do i = 1, size(rows)
        taken = taken - rows(i)%moment*duty%pin_speed(i + 1)*(duty%time(i + 1) - duty%time(i))
      end do
      mean_loss = taken/(duty%time(size(rows) + 1) - duty%time(1))
    end associate
  end function mean_loss
end module history_files
