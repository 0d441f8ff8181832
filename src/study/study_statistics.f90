!> Results that a study asks for by `statistics`: statistics of columns over the last cycle, and numbers of a summary.
module study_statistics
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: nearest_word, allowed, replaced, integer_text
  use joint_places, only: places, n_places, spot_prefix
  use case_definition, only: case_t
  use trace_row, only: column_list_t, kept_t, least, largest, largest_size, spread, mean, root_mean_square, of_run, of_cycle
  use trace_columns, only: all_columns, unit_in
  use cycle_answers, only: quantity_t, cycle_quantities
  use history_files, only: history_value
  use summary_quantities, only: quantities_of_runs
  use simulation, only: run_report_t
  implicit none
  private
  public :: statistic_t, read_statistics, keep_statistics, of_history

  character(len=7), parameter :: words(6) = [character(len=7) :: 'min', 'max', 'max abs', 'range', 'mean', 'rms']
  integer, parameter :: of_words(6) = [least, largest, largest_size, spread, mean, root_mean_square]

  !> One that is wanted.
  type :: statistic_t
    integer :: what = 0                !! that is kept of a column; 0: a number of the summary
    character(len=48) :: of = ''       !! the column with its unit, or the name of the number
    character(len=72) :: name = ''     !! of its column in the results, with its unit
  contains
    procedure :: value_in
  end type statistic_t

contains

  !> Read statistics such as 'max abs piston_acceleration, mean film_power, cycle_fmep'. Errors: a statistic that there is not, a
  !> column or a number that runs of the case do not have, one that is given twice.
  subroutine read_statistics(text, case, wanted, error)
    character(len=*), intent(in) :: text
    type(case_t), intent(in) :: case
    type(statistic_t), allocatable, intent(out) :: wanted(:)
    type(error_t), allocatable, intent(out) :: error
    type(column_list_t) :: list
    type(quantity_t), allocatable :: numbers(:)
    type(statistic_t) :: one
    character(len=:), allocatable :: rest, part, word
    integer :: blank
    allocate (wanted(0))
    if (text == '') return
    call all_columns(case, .false., list)
    call find_numbers(case, list, numbers)
    rest = text//','
    do while (rest /= '')
      part = trim(adjustl(rest(:index(rest, ',') - 1)))
      rest = rest(index(rest, ',') + 1:)
      blank = index(part, ' ', back=.true.)
      if (blank == 0 .and. part /= '') then
        call read_number()
      else
        word = squeezed(part(:max(0, blank - 1)))
        call read_statistic(part(blank + 1:))
      end if
      if (allocated(error)) return
      if (any(wanted%name == one%name)) then
        call fail(error, ''''//part//''': is given twice', status_case_file)
        return
      end if
      wanted = [wanted, one]
    end do

  contains

    subroutine read_statistic(column)
      character(len=*), intent(in) :: column
      integer :: kind, i
      kind = findloc(words == word, .true., 1)
      if (kind == 0) then
        call fail(error, ''''//part//''': must be a statistic and a column'//hint(word, words)//allowed(words), status_case_file)
        return
      end if
      i = findloc(bare(list%names) == column .or. list%names == column, .true., 1)
      if (i == 0) then
        call fail(error, ''''//part//''': no such column in this scene'//hint(column, bare(list%names)), status_case_file)
        return
      end if
      one = statistic_t(of_words(kind), list%names(i), trim(bare(list%names(i)))//'_'//replaced(word, ' ', '_')// &
        list%names(i)(scan(list%names(i), '['):))
    end subroutine read_statistic

    subroutine read_number()
      character(len=:), allocatable :: unit
      integer :: i
      i = findloc(numbers%name == part, .true., 1)
      if (i == 0) then
        call fail(error, ''''//part//''': must be a statistic and a column, or a number of the summary of this case'// &
          hint(part, numbers%name), status_case_file)
        return
      end if
      unit = trim(numbers(i)%unit)
      if (unit == '1') unit = '-'
      one = statistic_t(0, part, part//'['//unit//']')
    end subroutine read_number
  end subroutine read_statistics

  function hint(word, known) result(text)
    character(len=*), intent(in) :: word, known(:)
    character(len=:), allocatable :: text
    text = nearest_word(word, known)
    if (text /= '') text = '; did you mean '//text//'?'
  end function hint

  !> Let a run keep the statistics of its columns, as far as its scene has them.
  subroutine keep_statistics(wanted, list)
    type(statistic_t), intent(in) :: wanted(:)
    type(column_list_t), intent(inout) :: list   !! the columns of the run
    integer :: i, column
    allocate (list%asked(0))
    do i = 1, size(wanted)
      column = findloc(list%names == wanted(i)%of, .true., 1)
      if (wanted(i)%what > 0 .and. column > 0) list%asked = [list%asked, kept_t(name='statistic_'//integer_text(i), &
        what=wanted(i)%what, column=column, unit=unit_in(list%names(column)), is_sampled=.true.)]
    end do
  end subroutine keep_statistics

  !> The value in a run, number i of the statistics: of its last cycle, or of the whole run if it has none.
  subroutine value_in(self, report, i, value, is_known)
    class(statistic_t), intent(in) :: self
    type(run_report_t), intent(in) :: report
    integer, intent(in) :: i
    real(dp), intent(out) :: value
    logical, intent(out) :: is_known
    if (self%what == 0) then
      call report%value_of(trim(self%of), value, is_known)
      if (of_history(self%of) .and. allocated(report%histories)) &
        call history_value(report%histories, trim(self%of), value, is_known)
    else
      call report%value_of('cycle_statistic_'//integer_text(i), value, is_known)
      if (.not. is_known) call report%value_of('statistic_'//integer_text(i), value, is_known)
    end if
  end subroutine value_in

  !> Whether a number is one of a film with memory, which is marched for it.
  elemental logical function of_history(name)
    character(len=*), intent(in) :: name
    of_history = index(name, 'film_history_') > 0
  end function of_history

  !> The name of a column without its unit.
  elemental function bare(name)
    character(len=*), intent(in) :: name
    character(len=len(name)) :: bare
    bare = name(:index(name//'[', '[') - 1)
  end function bare

  !> A text with single blanks.
  pure function squeezed(text)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: squeezed
    integer :: i
    squeezed = ''
    do i = 1, len(text)
      if (text(i:i) == ' ' .and. index(text(:i), '  ', back=.true.) == i - 1 .and. i > 1) cycle
      squeezed = squeezed//text(i:i)
    end do
    squeezed = trim(squeezed)
  end function squeezed

  !> The numbers of summaries that runs of a case may have: those that are kept of its columns, the answers of a cycle, and
  !> those of films with memory.
  subroutine find_numbers(case, list, known)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(in) :: list
    type(quantity_t), allocatable, intent(out) :: known(:)
    integer, allocatable :: spots(:)
    integer :: i, k, place
    allocate (known(0))
    do i = 1, size(list%kept)
      associate (kept => list%kept(i))
        if (kept%told /= of_cycle) call add(trim(kept%place)//kept%name, kept%unit)
        if (kept%told /= of_run) call add(trim(kept%place)//'cycle_'//kept%name, kept%unit)
        if (kept%told /= of_run .and. kept%has_angle) call add(trim(kept%place)//'cycle_'//trim(kept%name)//'_angle', 'deg')
      end associate
    end do
    do i = 1, size(cycle_quantities)
      if (cycle_quantities(i)%unit == '') cycle
      call add(cycle_quantities(i)%name, cycle_quantities(i)%unit)
      do place = 1, n_places
        if (places(place)%prefix == '' .or. .not. case%joints(place)%has_bearing()) cycle
        spots = case%spots(place)
        do k = 1, size(spots)
          call add(trim(spot_prefix(spots(k)))//cycle_quantities(i)%name, cycle_quantities(i)%unit)
        end do
      end do
    end do
    do place = 1, n_places
      if (.not. allocated(case%joints(place)%history%march)) cycle
      spots = case%spots(place)
      do k = 1, size(spots)
        do i = 1, size(quantities_of_runs)
          associate (name => trim(spot_prefix(spots(k)))//trim(quantities_of_runs(i)%name))
            if (of_history(name) .and. len(name) <= len(quantities_of_runs%name)) call add(name, quantities_of_runs(i)%unit)
          end associate
        end do
      end do
    end do

  contains

    subroutine add(name, unit)
      character(len=*), intent(in) :: name, unit
      known = [known, quantity_t(name, unit)]
    end subroutine add
  end subroutine find_numbers
end module study_statistics
