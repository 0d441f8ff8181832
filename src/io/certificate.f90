!> How far the results of a run can be trusted: it is compared with a run at a hundredth of its tolerance, and with one more at that
!> tolerance with another method. The error of a row is its difference from the former, times a margin; not from the latter, which
!> may be the least accurate of the three. A run is certified up to the time at which the error of any coordinate or speed first
!> exceeds 1e-3 of its range, and not beyond the time at which the two others differ by that. Results of runs are compared too.
module certificate
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t, fail, status_integration
  use case_definition, only: case_t, output_case_t
  use trace_columns, only: column_list_t, choose_columns, column_name
  use simulation, only: run_t, run_report_t
  use run_summary, only: summary_table
  use summary_rows, only: summary_row_t, read_rows
  use film_files, only: provide_tables
  use joint_places, only: n_places
  use number_text, only: real_text, short_text
  use whole_run, only: go_to_end
  use row_store, only: row_store_t
  use text_tools, only: quoted
  implicit none
  private
  public :: certificate_t, make_certificate, certificate_table, certificate_summary, certificate_clause, is_state

  character(len=*), parameter :: newline = achar(10)
  real(dp), parameter :: limit = 1e-3_dp    !! error of a certified state, over its range
  real(dp), parameter :: margin = 2.5_dp    !! for the error of the closer run, at worst half as large, and errors between rows
  real(dp), parameter :: closer = 1e-2_dp   !! tolerance of the comparison runs, relative to that of the run
  real(dp), parameter :: finest_tolerance = 1e-13_dp, loosest_tolerance = 1e-3_dp   !! of the comparison runs, and a run's before
  real(dp), parameter :: finest_table = 9e-9_dp   !! tolerance at which the tables of films have their finest grid

  !> Results of the whole run that are compared, at any joint, besides those of the last whole cycle.
  character(len=*), parameter :: compared(*) = [character(len=21) :: 'max_pin_force', 'contact_time_fraction', &
    'min_film_thickness', 'mean_crank_speed', 'worn_volume_pin', 'worn_volume_bore', 'film_temperature', 'heat_in', 'heat_to_oil']
  !> Units of coordinates and speeds, and parts of names of other columns with these units. Of an elastic rod stretch and deflection
  !> midway count; a single shape may have a thousandth of their ranges. The deflection of bristles jumps as a force does.
  character(len=*), parameter :: of_states(*) = [character(len=7) :: '[m]', '[rad]', '[m/s]', '[rad/s]']
  character(len=*), parameter :: of_others(*) = [character(len=15) :: 'film_thickness', 'sliding_speed', 'closing_speed', &
    'half_angle', 'bristle', 'wall_deflection', 'rod_mode_', 'rod_axial_', '_gap']

  type :: certificate_t
    character(len=:), allocatable :: reason      !! reason for which no certificate could be made; else unallocated
    character(len=:), allocatable :: left_out    !! results that are not certified; else unallocated
    real(dp) :: until = 0                        !! end of the certified part [s]
    logical :: is_whole = .false.                !! the whole run is certified
    real(dp) :: digits = 0                       !! correct digits of the states in the certified part, median over time
    real(dp) :: state_error = 0                  !! largest error of the states in the certified part, relative to their ranges
    logical :: has_other_method = .false.        !! the run with the other method reached the end
    character(len=:), allocatable :: differences !! rows of the summary: differences of the results
    character(len=:), allocatable :: worst       !! result of the whole run with the largest relative difference
    real(dp) :: worst_difference = 0             !! that difference
    type(column_list_t) :: list
    real(dp), allocatable :: range(:), error(:)  !! of each column: range in the run, largest error in the certified part
  end type certificate_t

  type :: comparison_run_t   !! with nothing if it did not reach its end
    real(dp), allocatable :: values(:, :)        !! (columns, rows)
    type(summary_row_t), allocatable :: summary(:)
  end type comparison_run_t

contains

  !> Certify a completed run, or say why it cannot be certified. Error: the user interrupted (status_integration).
  subroutine make_certificate(case, report, announces, certificate, error)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    logical, intent(in) :: announces   !! tell the user that a film table is computed
    type(certificate_t), intent(out) :: certificate
    type(error_t), allocatable, intent(out) :: error
    type(case_t) :: plain
    type(comparison_run_t) :: runs(3)   ! own, closer, closer with another method
    character(len=:), allocatable :: keys
    integer :: i
    if (case%integrator%relative_tolerance < 10*finest_tolerance) then
      certificate%reason = 'not certified: no tolerance ten times smaller is possible'
      return
    end if
    if (allocated(report%histories)) certificate%left_out = 'not certified: film_history; its error is that of cells and steps '// &
      '(compare along, around, substeps twice as fine)'
    call prepare(case, report, plain)
    call choose_columns(plain, .false., certificate%list, error)
    do i = 1, size(runs)
      associate (settings => plain%integrator, own => case%integrator)
        if (i == 2) then
          settings%relative_tolerance = max(finest_tolerance, closer*min(own%relative_tolerance, loosest_tolerance))
          keys = table_keys(case)
          if (table_keys(plain) == keys .and. keys /= '') settings%relative_tolerance = &
            min(settings%relative_tolerance, finest_table)
          if (own%absolute_tolerance > 0) settings%absolute_tolerance = max(finest_tolerance, closer*own%absolute_tolerance)
        else if (i == 3) then   ! a method that is not suitable would need hundreds of times as many evaluations
          settings%method = merge('auto ', 'radau', own%method == 'radau')
          settings%max_evaluations = int(min(4*real(report%statistics%evaluations, dp) + 40000, real(own%max_evaluations, dp)))
        end if
      end associate
      if (.not. allocated(error)) call provide_tables(plain, announces, .false., error)
      if (.not. allocated(error)) call run(plain, certificate%list, runs(i), error)
      if (allocated(error)) return
    end do
    if (.not. (allocated(runs(1)%values) .and. allocated(runs(2)%values))) then
      certificate%reason = 'not certified: the run at a hundredth of the tolerance could not continue'
      return
    end if
    certificate%has_other_method = allocated(runs(3)%values)
    if (.not. certificate%has_other_method) runs(3) = runs(2)   ! which then differs from itself in nothing
    call compare_rows(certificate, runs(1)%values, runs(2)%values, runs(3)%values)
    if (certificate%is_whole) certificate%until = report%figures%time
    call compare_results(certificate, runs, report%periods%is_on)
  end subroutine make_certificate

  !> The case in the form in which all three runs carry it out: all columns, rows of its own, and the end of the run.
  subroutine prepare(case, report, plain)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    type(case_t), intent(out) :: plain
    real(dp) :: turns
    integer :: i
    plain = case
    turns = max(abs(case%initial%crank_speed)*report%figures%time, abs(report%figures%crank_travel))/two_pi
    plain%output = output_case_t(sampling='time', interval=report%figures%time/min(60000.0_dp, max(2000.0_dp, 10000*turns)), &
      columns='standard', film_times='', digits=17, window='all', answers=case%output%answers)
    plain%run%lyapunov_revolutions = 0
    if (report%periods%is_on) then
      plain%run%until = 'end'
      plain%integrator%revolutions = 0
      plain%integrator%crank_revolutions = 0
      plain%integrator%end_time = report%figures%time
    end if
    do i = 1, n_places   ! the files that the user names are not written again
      if (allocated(plain%joints(i)%film)) plain%joints(i)%film%table_file = ''
    end do
  end subroutine prepare

  !> The marks of the tables that the films of a case need; empty if they need none.
  function table_keys(case) result(keys)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: keys
    integer :: i
    keys = ''
    do i = 1, n_places
      associate (joint => case%joints(i))
        if (allocated(joint%film) .and. joint%has_bearing()) keys = keys// &
          joint%film%table_key(joint%bearing(case%mechanism%rod_length), case%integrator%relative_tolerance)
      end associate
    end do
  end function table_keys

  !> Run a case, whose films have their tables.
  subroutine run(case, list, own, error)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(in) :: list
    type(comparison_run_t), intent(out) :: own
    type(error_t), allocatable, intent(out) :: error   !! the user interrupted
    type(error_t), allocatable :: failure
    type(run_t) :: motion
    type(run_report_t) :: report
    type(row_store_t) :: rows
    logical :: was_interrupted
    call motion%begin(case, .false., list, rows, failure)
    if (allocated(failure)) return
    call go_to_end(motion, was_interrupted)
    if (was_interrupted) call fail(error, 'interrupted before it was certified', status_integration)
    call motion%finish(report, failure)
    if (allocated(failure)) return
    call read_rows(summary_table(case, report, 0.0_dp), own%summary)
    own%values = rows%values(:, :rows%rows)
  end subroutine run

  !> Find the time up to which the error of the states is within the limit, the number of correct digits up to there, and the errors
  !> of every column, from the rows (columns, rows) of the run, of the closer run and of that with the other method.
  subroutine compare_rows(self, own, close, other)
    type(certificate_t), intent(inout) :: self
    real(dp), intent(in) :: own(:, :), close(:, :), other(:, :)
    logical :: state(size(own, 1))   ! columns that are coordinates or speeds and change
    real(dp) :: errors(size(own, 2)), difference(size(own, 1))
    integer :: i, last
    self%range = maxval(own, 2) - minval(own, 2)
    state = [(is_state(column_name(self%list, i)) .and. self%range(i) > 0, i=1, size(own, 1))]
    allocate (self%error(size(own, 1)), source=0.0_dp)
    do last = 0, min(size(own, 2), size(close, 2), size(other, 2)) - 1
      i = last + 1
      difference = margin*abs(own(:, i) - close(:, i))
      errors(i) = maxval([0.0_dp, pack(difference, state)/pack(self%range, state)])
      if (errors(i) > limit .or. any(state .and. abs(other(:, i) - close(:, i)) > limit*self%range)) exit
      self%error = max(self%error, difference)
    end do
    if (last == 0) return
    self%until = own(1, last)
    self%is_whole = i == last .and. last >= size(own, 2) - 1   ! the ends of the runs differ by rounding
    self%state_error = maxval(errors(:last))
    do i = 157, 0, -1   ! tenths of a digit, from rounding on
      self%digits = 0.1_dp*i
      if (2*count(errors(:last) <= 10**(-self%digits)) >= last) exit
    end do
  end subroutine compare_rows

  !> Compare the results in the summaries of the run, of the closer run and of that with the other method.
  subroutine compare_results(self, runs, ends_with_period)
    type(certificate_t), intent(inout) :: self
    type(comparison_run_t), intent(in) :: runs(:)
    logical, intent(in) :: ends_with_period   !! the last cycle of the user's run, and perhaps its wear, are of another time
    real(dp) :: results(size(runs)), difference
    logical :: of_cycle
    integer :: k, i
    self%differences = ''
    do k = 1, size(runs(1)%summary)
      associate (row => runs(1)%summary(k))
        of_cycle = index(row%name, 'cycle_') > 0
        if (row%unit == '' .or. ends_with_period .and. (of_cycle .or. index(row%name, 'worn_') > 0)) cycle
        if (.not. (of_cycle .or. any([(index('_'//row%name//' ', '_'//trim(compared(i))//' ') > 0, i=1, size(compared))]))) cycle
        results = [(value_of(runs(i)%summary, row%name), i=1, size(runs))]
        difference = maxval(abs(results - results(1)))
        self%differences = self%differences//row%name//'_difference,'//real_text(difference)//','//row%unit//newline
        difference = difference/max(maxval(abs(results)), tiny(difference))
        if (of_cycle .or. allocated(self%worst) .and. .not. difference > self%worst_difference) cycle
        self%worst = row%name
        self%worst_difference = difference
      end associate
    end do
  end subroutine compare_results

  !> The value of a quantity; 0 where a run does not have it.
  pure real(dp) function value_of(rows, name) result(value)
    type(summary_row_t), intent(in) :: rows(:)
    character(len=*), intent(in) :: name
    integer :: i
    value = 0
    do i = 1, size(rows)
      if (rows(i)%name == name) value = rows(i)%value
    end do
  end function value_of

  !> NAME.certificate.csv: the largest error of each column in the certified part, also over its range in the run, and whether it is
  !> a coordinate or speed, by whose errors the certified part is found.
  function certificate_table(self) result(text)
    type(certificate_t), intent(in) :: self
    character(len=:), allocatable :: text, name
    integer :: i
    text = 'column,largest_error,relative_error,is_state'//newline
    do i = 1, size(self%error)
      name = column_name(self%list, i)
      if (index(name, 'phase[') > 0) cycle   ! not a quantity with a unit
      text = text//name//','//real_text(self%error(i))//','
      if (self%range(i) > 0) text = text//real_text(self%error(i)/self%range(i))
      text = text//','//trim(merge('yes', 'no ', is_state(name)))//newline
    end do
  end function certificate_table

  !> Rows `quantity,value,unit` of the summary.
  function certificate_summary(self) result(text)
    type(certificate_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = 'certified_until,'//real_text(self%until)//',s'//newline//'certified_digits,'//short_text(self%digits)//',1'//newline// &
      'state_error,'//real_text(self%state_error)//',1'//newline//'certified_with_other_method,'// &
      trim(merge('yes', 'no ', self%has_other_method))//','//newline
    if (allocated(self%differences)) text = text//self%differences
    if (allocated(self%left_out)) text = text//'certificate_note,'//quoted(self%left_out, '"')//','//newline
    if (allocated(self%reason)) text = 'certificate,'//quoted(self%reason, '"')//','//newline
  end function certificate_summary

  !> The part of the line for the user.
  function certificate_clause(self) result(text)
    type(certificate_t), intent(in) :: self
    character(len=:), allocatable :: text
    text = short_text(self%digits)//' digits to '
    if (allocated(self%reason)) then
      text = self%reason
    else if (self%is_whole) then
      text = text//'the end'
    else
      text = text//short_text(self%until)//' s, then results of the whole run within '// &
        short_text(100*self%worst_difference, 2)//' % ('//self%worst//')'
    end if
  end function certificate_clause

  !> Whether a column is a coordinate or a speed, and not one that follows from others.
  pure logical function is_state(name)
    character(len=*), intent(in) :: name   !! with its unit
    integer :: i
    is_state = any(name(max(1, index(name, '[')):) == of_states) .and. &
      .not. any([(index(name, trim(of_others(i))) > 0, i=1, size(of_others))])
  end function is_state
end module certificate
